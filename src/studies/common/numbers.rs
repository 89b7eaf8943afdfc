//! The numbers of a study: scalars and expectations from functionals and results.

use super::case::Case;
use super::named::shown_in;
use crate::expression::{Cause, Id, LookupTable, Program};
use crate::model::{Expectation, FunctionalKind, Model, Quantity, Tolerance};
use crate::results::{Checked, Finding, Undefined};
use std::sync::Arc;

/// Scalars and expectations of a run.
pub(crate) struct Numbers {
    /// Values of `study.scalars`, in their order.
    pub(crate) scalars: Vec<f64>,
    /// Expectations; none if the run is not complete.
    pub(crate) expectations: Vec<Checked>,
    /// Scalars that have no value because the motion gives them none.
    pub(crate) findings: Vec<Finding>,
    /// The first that has no value by the fault of its own expression.
    pub(crate) undefined: Option<Undefined>,
}

/// What numbers are made of.
pub(crate) struct Sources<'a> {
    pub(crate) case: Case<'a>,
    pub(crate) tables: &'a Arc<[LookupTable]>,
    /// Values of `study.functionals`, in their order.
    pub(crate) functionals: &'a [f64],
    /// Values of `study.results`, in their order.
    pub(crate) results: &'a [f64],
    /// Works of a motion in time, J; else none.
    pub(crate) works: &'a [f64],
}

impl Sources<'_> {
    /// The numbers of a run; one that has stopped on its way is not measured by what was expected of the whole.
    pub(crate) fn numbers(&self, complete: bool) -> Numbers {
        let (mut findings, mut undefined) = (Vec::new(), None);
        let mut missing = |name: &str, place: &str, cause: Cause| match self.given(cause) {
            Some(why) => findings.push(Finding {
                code: "undefined-scalar".into(),
                message: format!("`{name}` is not defined: {why}"),
                path: place.to_owned(),
            }),
            None => {
                let why = || Undefined {
                    message: format!("`{name}` is not defined: {}", self.case.model.why_undefined(cause)),
                    place: place.to_owned(),
                    help: "look at the numbers that it is made of; `if(condition, a, b)` chooses between formulas".into(),
                };
                undefined.get_or_insert_with(why);
            }
        };
        let mut scalars = Vec::with_capacity(self.case.study.scalars.len());
        for scalar in &self.case.study.scalars {
            let (x, causes) = self.evaluate(&[scalar.value]);
            if let Some(cause) = causes[0] {
                missing(&scalar.name, &scalar.place, cause);
            }
            scalars.push(x[0]);
        }
        let mut expectations = Vec::new();
        for e in self.case.study.expect.iter().filter(|_| complete) {
            let tolerance_id = match e.tolerance {
                Tolerance::Within(id) | Tolerance::Relative(id) => id,
            };
            let (x, causes) = self.evaluate(&[e.value, e.is, tolerance_id]);
            if let Some(cause) = causes[0] {
                missing(&e.text, &e.place, cause);
            }
            let open = causes[1..].iter().flatten().next().map(|cause| self.case.model.why_undefined(*cause));
            let tolerance = match e.tolerance {
                Tolerance::Within(_) => x[2],
                Tolerance::Relative(_) => x[2] * x[1].abs(),
            };
            let met = (x[0] - x[1]).abs() <= tolerance;
            let message = match open {
                Some(why) => format!("what `{}` is expected to be is not defined: {why}", e.text),
                None if met => String::new(),
                None => unmet(self.case.model, e, [x[0], x[1], tolerance]),
            };
            let (text, place) = (e.text.clone(), e.place.clone());
            expectations.push(Checked { text, found: x[0], wanted: x[1], tolerance, met, message, place });
        }
        if undefined.is_some() {
            expectations.clear();
        }
        Numbers { scalars, expectations, findings, undefined }
    }

    /// Values of expressions, and why those without one have none.
    fn evaluate(&self, ids: &[Id]) -> (Vec<f64>, Vec<Option<Cause>>) {
        let program: Program = self.case.model.pool.program(ids, self.case.parameters, self.tables);
        let mut inputs = vec![f64::NAN; self.case.model.inputs.len()];
        for &i in program.inputs() {
            inputs[i as usize] = match self.case.model.inputs[i as usize] {
                Quantity::Functional(k) => self.functionals.get(k).copied().unwrap_or(f64::NAN),
                Quantity::Result(k) => self.results.get(k).copied().unwrap_or(f64::NAN),
                Quantity::Work(k) => self.works.get(k).copied().unwrap_or(f64::NAN),
                _ => f64::NAN,
            };
        }
        let mut modes = vec![0; self.case.model.pool.switches().len()];
        let mut registers = vec![0.0; program.registers()];
        let mut out = vec![0.0; ids.len()];
        program.set_modes(&inputs, &mut registers, &mut modes);
        program.eval(&inputs, &modes, &mut registers, &mut out);
        let causes = (0..ids.len()).map(|k| program.cause(k, &inputs, &modes)).collect();
        (out, causes)
    }

    /// Why the motion gives no value, if it is the motion that gives none.
    fn given(&self, cause: Cause) -> Option<String> {
        let Cause::Input(input) = cause else { return None };
        match self.case.model.inputs.get(input as usize) {
            Some(Quantity::Functional(k)) => self.case.study.functionals.get(*k).map(|f| match f.kind {
                FunctionalKind::First => format!("the condition of `{}` never holds", f.text),
                FunctionalKind::Value => format!("the study does not reach the place of `{}`", f.text),
                _ => format!("`{}` is taken of what is not defined everywhere", f.text),
            }),
            _ => Some(self.case.model.why_undefined(cause)),
        }
    }
}

/// That a value is not the one expected.
fn unmet(model: &Model, e: &Expectation, [found, wanted, tolerance]: [f64; 3]) -> String {
    let (unit, size) = shown_in(model, e.dimension).map_or_else(|| (e.dimension.si(), 1.0), |asked| (asked.unit, asked.size));
    let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
    // as many digits as tell the two apart: numbers divided by a unit end in noise
    let rounded = |x: f64, digits: usize| format!("{:.digits$e}", x / size).parse::<f64>().unwrap_or(x / size);
    let digits = (9..16).find(|&digits| rounded(found, digits) != rounded(wanted, digits)).unwrap_or(16);
    let shown = |x: f64| rounded(x, digits);
    if found.is_nan() {
        return format!("`{}` is not defined; expected was {}{unit}", e.text, shown(wanted));
    }
    format!("`{}` is {}{unit}, not {}{unit} within {:e}{unit}", e.text, shown(found), shown(wanted), rounded(tolerance, 3))
}
