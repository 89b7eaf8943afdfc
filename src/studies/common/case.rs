//! What one run computes: a study of a model at values of its parameters.

use crate::expression::Id;
use crate::model::{Model, Study};

/// A study of a model at values of its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its study.
    pub study: &'a Study,
    /// Values of the parameters, in file order, SI.
    pub parameters: &'a [f64],
}

impl<'a> Case<'a> {
    /// The value of an expression of parameters, SI.
    #[must_use]
    pub fn value(&self, id: Id) -> f64 {
        self.model.pool.value(id, self.parameters)
    }

    /// The parameters by name.
    #[must_use]
    pub fn named(&self) -> Vec<(String, f64)> {
        self.model.parameters.iter().zip(self.parameters).map(|(p, x)| (p.name.clone(), *x)).collect()
    }

    /// The same study at other values of the parameters.
    #[must_use]
    pub fn at<'b>(&self, parameters: &'b [f64]) -> Case<'b>
    where
        'a: 'b,
    {
        Case { parameters, ..*self }
    }
}

/// Parameters of a model as numbers, in file order.
#[must_use]
pub fn parameters(model: &Model) -> Vec<f64> {
    model.pool.resolve_parameters(&model.parameters.iter().map(|p| p.value).collect::<Vec<_>>())
}

/// Parameters with some of them set to numbers; those that depend on them follow.
#[must_use]
pub fn parameters_with(model: &Model, set: &[(usize, f64)]) -> Vec<f64> {
    let mut pool = model.pool.clone();
    let mut values: Vec<_> = model.parameters.iter().map(|p| p.value).collect();
    for &(i, x) in set {
        values[i] = pool.constant(x);
    }
    pool.resolve_parameters(&values)
}
