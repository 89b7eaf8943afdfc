//! Numbers with units, without names: what `at` and `rpy` of a robot with a free link are.

use crate::expression::{Dimension, Lowered, Pool, Scope, Symbol, Unknown, lower, parse};
use serde_yaml::Value;

/// A reader of numbers.
pub(super) struct Constant {
    /// Whether they are angles; else lengths.
    pub(super) angle: bool,
}

impl Constant {
    /// Three numbers, rad or m; the error says what stands there instead.
    pub(super) fn vector(&self, value: &Value) -> Result<[f64; 3], String> {
        let items = value.as_sequence().map(Vec::as_slice).unwrap_or_default();
        let numbers = items.iter().map(|item| self.number(item)).collect::<Result<Vec<f64>, String>>()?;
        <[f64; 3]>::try_from(numbers).map_err(|numbers| format!("{} numbers", numbers.len()))
    }

    fn number(&self, value: &Value) -> Result<f64, String> {
        let Some(text) = value.as_str() else { return value.as_f64().ok_or_else(|| "no number".to_owned()) };
        let expr = parse(text).map_err(|error| format!("found {}", error.found))?;
        let mut pool = Pool::new();
        let found =
            |faults: Vec<crate::expression::Fault>| faults.into_iter().map(|fault| format!("found {}", fault.found)).collect::<Vec<_>>();
        let lowered = lower(&mut pool, &expr, text, &mut Nothing).map_err(|faults| found(faults).join(", "))?;
        lowered.expect(if self.angle { Dimension::NONE } else { Dimension::LENGTH }).map_err(|found| format!("found {found}"))?;
        let x = pool.value(lowered.id, &[]);
        if x.is_finite() { Ok(x) } else { Err(format!("the value is {x}")) }
    }
}

/// A scope without names.
struct Nothing;

impl Nothing {
    fn refused(name: &str) -> Unknown {
        Unknown { found: format!("`{name}`"), expected: "numbers with units".to_owned(), help: None }
    }
}

impl Scope for Nothing {
    fn name(&mut self, _: &mut Pool, path: &str) -> Result<Symbol, Unknown> {
        Err(Self::refused(path))
    }
    fn has_value(&self, _: &str) -> bool {
        false
    }
    fn enter_functional(&mut self, name: &str) -> Result<(), Unknown> {
        Err(Self::refused(name))
    }
    fn functional(&mut self, _: &mut Pool, name: &str, _: Lowered, _: Option<Lowered>, _: &str) -> Result<Symbol, Unknown> {
        Err(Self::refused(name))
    }
}
