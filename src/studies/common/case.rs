//! What one run computes: a study of a model at values of its parameters.

use crate::expression::Id;
use crate::model::{Model, Study};
use crate::results::Sink;
use crate::studies::integrators::OwnIntegrator;

/// A study of a model at values of its parameters.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its study.
    pub study: &'a Study,
    /// Values of the parameters, in file order, SI.
    pub parameters: &'a [f64],
    /// The integrator of a motion in time, if it is not the one that the study names.
    pub integrator: Option<&'a OwnIntegrator>,
    /// Where rows go as they are computed; none: they are all kept.
    pub rows: Option<Streamed<'a>>,
    /// Whether its drawings are wanted, whose frames take time.
    pub drawn: bool,
}

/// Who takes the rows of a motion as they are computed, and what is kept of them.
#[derive(Clone, Copy)]
pub struct Streamed<'a> {
    /// Takes them.
    pub sink: &'a dyn Sink,
    /// How many numbers are to be kept, about: more rows are thinned to those that figures need. With 0 none is kept.
    pub keep: usize,
}

impl<'a> Case<'a> {
    /// A study of a model at values of its parameters, by the integrator that it names, with its drawings.
    #[must_use]
    pub fn new(model: &'a Model, study: &'a Study, parameters: &'a [f64]) -> Self {
        Case { model, study, parameters, integrator: None, rows: None, drawn: true }
    }

    /// The same without drawings.
    #[must_use]
    pub fn undrawn(self) -> Self {
        Case { drawn: false, ..self }
    }

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
