//! Functions from outside: known by their values alone, given by the program that uses the library.
//!
//! Their derivatives are functions too where they are given, else differences by Ridders' method (C. J. F. Ridders, *Accurate computation
//! of F'(x) and F'(x) F''(x)*, Advances in Engineering Software 4, 1982, 75-76): central differences over steps in a ratio, extrapolated
//! to the step 0 until their spread grows again.

use super::parser::parse;
use super::unit_text::parse_unit;
use super::units::Dimension;
use crate::scalar::Scalar;
use std::fmt;
use std::sync::Arc;

/// What computes a value of the arguments.
type Law = dyn Fn(&[f64]) -> f64 + Send + Sync;

/// Most arguments of an external function, its sides among them.
pub(super) const MOST_ARGUMENTS: usize = 24;

/// By which of its arguments a call is differentiated, counted from 1 and rising; 0 behind them.
pub(super) type By = [u8; 4];

/// A function that expressions may call, `gas(crank.angle)`, and that is computed outside of the program.
///
/// Its arguments are in SI, as is its value: a plain number that takes the dimension of its field, unless [`Self::unit`] says another.
/// It must be a function, with the same value for the same arguments, and smooth but for its switches. For each of these it has one
/// argument more, behind the others: 1 where the condition holds, else 0. It has to compute that side's formula beyond the switch as
/// well, since a step that crosses one is cut there only when it is found.
#[derive(Clone)]
pub struct ExternalFunction {
    name: String,
    arguments: Vec<String>,
    law: Arc<Law>,
    slopes: Vec<Option<Arc<Law>>>,
    unit: Option<String>,
    switches: Option<Vec<(String, String)>>,
}

impl ExternalFunction {
    /// A function by its name and those of its arguments, whose switches are not known.
    #[must_use]
    pub fn new(name: &str, arguments: &[&str], law: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Self {
        Self {
            name: name.into(),
            arguments: arguments.iter().map(|&argument| argument.into()).collect(),
            law: Arc::new(law),
            slopes: vec![None; arguments.len()],
            unit: None,
            switches: None,
        }
    }

    /// With its derivative by an argument, which else is found by differences. One by an argument that it does not have is ignored.
    #[must_use]
    pub fn slope(mut self, argument: &str, slope: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Self {
        if let Some(i) = self.arguments.iter().position(|known| known == argument) {
            self.slopes[i] = Some(Arc::new(slope));
        }
        self
    }

    /// With the unit of its value, as in the model file: `N m`.
    #[must_use]
    pub fn unit(mut self, unit: &str) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// With all its switches: names, and conditions on its arguments as in the model file, `("late", "angle > 213 deg")`. None of them
    /// says that it is smooth everywhere.
    #[must_use]
    pub fn switches(mut self, switches: &[(&str, &str)]) -> Self {
        self.switches = Some(switches.iter().map(|&(name, condition)| (name.into(), condition.into())).collect());
        self
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether its switches are known.
    #[must_use]
    pub fn is_declared(&self) -> bool {
        self.switches.is_some()
    }

    /// Names of its arguments, and of its switches.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.arguments.iter().map(String::as_str).chain(self.sides().iter().map(|(name, _)| name.as_str()))
    }

    /// What is wrong with its arguments, unit or switches themselves, and the remedy.
    #[must_use]
    pub fn fault(&self) -> Option<(String, String)> {
        let name = &self.name;
        if self.arguments.is_empty() {
            return Some((
                format!("the external function `{name}` has no argument"),
                "a number that does not change is a parameter".into(),
            ));
        }
        if self.names().count() > MOST_ARGUMENTS {
            let message = format!("the external function `{name}` has more than {MOST_ARGUMENTS} arguments and switches");
            return Some((message, "make two functions of it".into()));
        }
        if let Some(unit) = self.unit.as_deref().filter(|unit| parse_unit(unit).is_none()) {
            return Some((
                format!("`{unit}`, the unit of the external function `{name}`, is none"),
                "write it as in a model file: `N m`".into(),
            ));
        }
        self.sides().iter().find_map(|(_, condition)| {
            let why = parse(condition).err()?;
            Some((format!("the switch `{condition}` of the external function `{name}`: {}", why.found), format!("write {}", why.expected)))
        })
    }

    /// How it is called, for messages.
    pub(super) fn usage(&self) -> String {
        format!("{}({})", self.name, self.arguments.join(", "))
    }

    /// Names of its arguments without sides.
    pub(super) fn arguments(&self) -> &[String] {
        &self.arguments
    }

    /// Size and dimension of its unit, if it has one.
    pub(super) fn size(&self) -> Option<(f64, Dimension)> {
        self.unit.as_deref().and_then(parse_unit)
    }

    /// Names and conditions of its switches.
    pub(super) fn sides(&self) -> &[(String, String)] {
        self.switches.as_deref().unwrap_or_default()
    }

    /// Its value, or a derivative of it.
    pub(super) fn value(&self, arguments: &[f64], mut by: By) -> f64 {
        let mut at = [0.0; MOST_ARGUMENTS];
        let Some(at) = at.get_mut(..arguments.len()) else { return f64::NAN };
        at.copy_from_slice(arguments);
        // a derivative that is known needs one difference less
        let slope = |i: u8| self.slopes.get(usize::from(i.checked_sub(1)?))?.as_deref();
        match by.iter().position(|i| slope(*i).is_some()) {
            Some(k) => {
                let law = slope(by[k]).unwrap_or(&*self.law);
                by[k..].rotate_left(1);
                derivative(law, at, &by[..by.len() - 1])
            }
            None => derivative(&*self.law, at, &by),
        }
    }

    /// Its value, or a derivative of it, on any scalar.
    #[inline(never)]
    pub(super) fn call<S: Scalar>(&self, arguments: &[S], by: By) -> S {
        let mut at = [0.0; MOST_ARGUMENTS];
        let Some(at) = at.get_mut(..arguments.len()) else { return S::constant(f64::NAN) };
        for (at, x) in at.iter_mut().zip(arguments) {
            *at = x.value();
        }
        if at.iter().any(|x| !x.is_finite()) {
            return S::constant(f64::NAN);
        }
        let mut result = S::constant(self.value(at, by));
        if S::DERIVATIVES {
            for (i, x) in arguments.iter().enumerate().take(self.arguments.len()) {
                let change = *x - S::constant(x.value());
                if let Some(by) = and_by(by, i).filter(|_| !change.is_zero()) {
                    result += change.scale(self.value(at, by));
                }
            }
        }
        result
    }
}

impl fmt::Debug for ExternalFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ExternalFunction").field("name", &self.name).field("arguments", &self.arguments).finish_non_exhaustive()
    }
}

/// The same if all is, and the law is the same object.
impl PartialEq for ExternalFunction {
    fn eq(&self, other: &Self) -> bool {
        let texts = |f: &Self| (f.name.clone(), f.arguments.clone(), f.unit.clone(), f.switches.clone());
        Arc::ptr_eq(&self.law, &other.law) && texts(self) == texts(other)
    }
}

impl Eq for ExternalFunction {}

/// One derivative more, by argument i; none if there are as many as can be.
pub(super) fn and_by(mut by: By, i: usize) -> Option<By> {
    *by.iter_mut().find(|slot| **slot == 0)? = i as u8 + 1;
    // the order of differentiation does not matter: one derivative, one node
    by.sort_unstable_by_key(|slot| if *slot == 0 { u8::MAX } else { *slot });
    Some(by)
}

/// The derivative by some arguments, counted from 1 and with 0 behind them, by differences.
fn derivative(law: &Law, at: &mut [f64], by: &[u8]) -> f64 {
    let Some((&number, rest)) = by.split_first().filter(|(number, _)| **number > 0) else { return law(at) };
    let i = usize::from(number) - 1;
    let x = at[i];
    let slope = ridders(x, &mut |x| {
        at[i] = x;
        derivative(law, at, rest)
    });
    at[i] = x;
    slope
}

/// The derivative of a function at x; not a number where there is none on both sides.
fn ridders(x: f64, f: &mut dyn FnMut(f64) -> f64) -> f64 {
    const ROWS: usize = 15;
    let mut step = 0.02 * x.abs().max(1.0);
    let (mut best, mut error) = (f64::NAN, f64::INFINITY);
    let (mut last, mut rows) = ([f64::NAN; ROWS], 0);
    for _ in 0..ROWS {
        let mut row = [f64::NAN; ROWS];
        row[0] = (f(x + step) - f(x - step)) / ((x + step) - (x - step));
        step *= 0.5;
        if !row[0].is_finite() {
            // it is defined nearer to x only
            rows = 0;
            continue;
        }
        let mut factor = 1.0;
        for k in 1..=rows {
            factor *= 4.0;
            row[k] = row[k - 1] + (row[k - 1] - last[k - 1]) / (factor - 1.0);
            let spread = (row[k] - row[k - 1]).abs().max((row[k] - last[k - 1]).abs());
            if spread <= error {
                (best, error) = (row[k], spread);
            }
        }
        // wide steps over a fast function may agree by chance
        if rows > 0 && error <= 1e-6 * best.abs() && (row[rows] - last[rows - 1]).abs() >= 2.0 * error {
            break;
        }
        (last, rows) = (row, rows + 1);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_find_their_step() {
        // at a scale of its own, and beside the end of what is defined
        assert!((ridders(1.0, &mut |x| (x * 500.0).sin()) - 500.0 * 500.0_f64.cos()).abs() < 1e-6);
        assert!((ridders(1e-3, &mut f64::sqrt) - 0.5 / 1e-3_f64.sqrt()).abs() < 1e-8);
        assert_eq!(ridders(3.0, &mut |_| 7.0), 0.0);
        assert!(ridders(-1.0, &mut f64::sqrt).is_nan());
    }
}
