//! Units as text: `kg m^2/s`.

use super::parser::{Kind, parse};
use super::units::Dimension;

/// Size in SI and dimension of a composite unit such as `N m s/rad`, by the rules of the format.
#[must_use]
pub fn parse_unit(text: &str) -> Option<(f64, Dimension)> {
    let first = text.trim_start();
    // a quantity of size one is the unit; the first word must be one, else `1` would stand alone
    if !first.starts_with(|c: char| c.is_ascii_alphabetic() || c == '%') {
        return None;
    }
    match parse(&format!("1 {first}")).ok()?.kind {
        Kind::Quantity(size, dimension, _) => Some((size, dimension)),
        _ => None,
    }
}
