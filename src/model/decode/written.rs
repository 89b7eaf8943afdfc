//! The unit in which a value is written.

use crate::expression::parse_unit;
use crate::model::merge::Node;

/// The unit of the number at the beginning of a text, and its size in SI: `rpm` of `600 rpm, 900 rpm`; none without a unit.
pub(super) fn unit_of(text: &str) -> Option<(String, f64)> {
    let first = text.split([',', ';']).next().unwrap_or_default();
    let first = first.split("..").next().unwrap_or_default();
    let inner = ["normal(", "uniform("].into_iter().find_map(|word| first.trim_start().strip_prefix(word));
    let first = inner.unwrap_or(first).trim();
    let is_number = |end: &usize| first.is_char_boundary(*end) && first[..*end].trim_end().parse::<f64>().is_ok_and(f64::is_finite);
    let unit = first[(1..=first.len()).rev().find(is_number)?..].trim();
    parse_unit(unit).map(|(size, _)| (unit.to_owned(), size))
}

/// The unit in which the first of the values at a node of the file is written.
pub(super) fn unit_in(node: Node<'_>) -> Option<(String, f64)> {
    unit_of(node.text().or_else(|| node.items().first()?.as_str())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_what_stands_behind_the_number() {
        for (text, unit) in [("600 rpm, 900 rpm", "rpm"), ("-3e2 mm", "mm"), ("5 N m..7 N m:3", "N m"), ("normal(5 cm, 1 mm)", "cm")] {
            assert_eq!(unit_of(text).map(|found| found.0).as_deref(), Some(unit), "{text}");
        }
        for text in ["0.3, 0.4", "l1/2", "2*l1", "nan m", ""] {
            assert!(unit_of(text).is_none(), "{text}");
        }
        assert_eq!(unit_of("10 cm").map(|found| found.1), Some(0.01));
    }
}
