//! Quantities, values and what has no value, in the words of the model file.

use crate::expression::{Cause, Dimension};

/// A number of seven digits with its unit.
#[must_use]
pub fn with_unit(x: f64, dimension: Dimension) -> String {
    in_unit(x, &dimension.si())
}

/// A number of seven digits and a unit.
pub fn in_unit(x: f64, unit: &str) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    let number = if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") };
    format!("{number} {unit}").trim_end().to_string()
}

/// Why a value of parameters alone is undefined.
pub(crate) fn why_undefined(cause: Cause) -> String {
    let plain = |x: f64| with_unit(x, Dimension::NONE);
    match cause {
        Cause::Function(name, x) => format!("{name} of {}", plain(x)),
        Cause::Zero => "a division by 0".into(),
        Cause::Power(base, exponent) => format!("{} to the power {}", plain(base), plain(exponent)),
        Cause::TooLarge => "a number beyond 1.8e308".into(),
        Cause::Table { .. } | Cause::External { .. } | Cause::Input(_) => "what it is made of is not defined".into(),
    }
}
