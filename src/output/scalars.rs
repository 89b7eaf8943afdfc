//! The table of scalars for the terminal: `name   value   unit`, numbers aligned on the decimal point.

use crate::results::{Scalar, number};
/// Longer names stand on a line of their own, so that one of them does not push all values to the right.
const LONGEST_NAME: usize = 32;

/// The aligned table, each line indented by two and ended by a line end; empty for no scalars.
pub(super) fn table(scalars: &[&Scalar]) -> String {
    let shown: Vec<_> = scalars.iter().map(|scalar| scalar.shown()).collect();
    let texts: Vec<_> = shown.iter().map(|(value, _)| significant(*value, 10)).collect();
    // The first part of a value ends before its point (or exponent): there the column is aligned.
    let parts: Vec<_> = texts.iter().map(|text| text.split_at(text.find(['.', 'e']).unwrap_or(text.len()))).collect();
    let count = |text: &str| text.chars().count();
    let names = scalars.iter().map(|scalar| count(&scalar.name)).filter(|&length| length <= LONGEST_NAME).max().unwrap_or(0);
    let whole = parts.iter().map(|(whole, _)| count(whole)).max().unwrap_or(0);
    let rest = parts.iter().map(|(_, rest)| count(rest)).max().unwrap_or(0);

    let mut table = String::new();
    for ((scalar, (_, unit)), (before, after)) in scalars.iter().zip(&shown).zip(&parts) {
        let mut name = scalar.name.as_str();
        if count(name) > LONGEST_NAME {
            table.push_str(&format!("  {name}\n"));
            name = "";
        }
        let line = format!("  {name:<names$}  {before:>whole$}{after:<rest$}  {unit}");
        table.push_str(line.trim_end());
        table.push('\n');
    }
    table
}

/// `x` with `digits` significant digits, without trailing zeros; with an exponent where the plain form would be long.
pub(super) fn significant(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return "–".into();
    }
    if x == 0.0 {
        return "0".into();
    }
    let text = format!("{x:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    if (-5..digits as i32).contains(&power) {
        let decimals = usize::try_from(digits as i32 - 1 - power).unwrap_or(0);
        return without_zeros(&format!("{x:.decimals$}")).to_owned();
    }
    format!("{}e{power}", without_zeros(mantissa))
}

/// Ten significant digits, without trailing zeros.
pub fn ten_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    number(rounded)
}

/// Six significant digits.
pub(super) fn six_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    number(rounded)
}

fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_significant_digits_and_no_more() {
        assert_eq!(significant(1599.5898578312, 10), "1599.589858");
        assert_eq!(significant(0.1 + 0.2, 10), "0.3");
        assert_eq!(significant(-9.9999999999999, 10), "-10");
        assert_eq!(significant(1.5e-9, 10), "1.5e-9");
        assert_eq!(significant(2.0e12, 10), "2e12");
        assert_eq!(significant(f64::NAN, 10), "–");
    }

    #[test]
    fn points_stand_below_each_other() {
        let scalar = |name: &str, value, unit: &str| Scalar { name: name.into(), value, unit: unit.into(), ..Scalar::default() };
        let long = "a_name_that_is_too_long_for_the_column";
        let all = [scalar("mean_power", 1599.58985783, "W"), scalar("delta", -0.01, ""), scalar(long, 12.0, "s")];
        let text = table(&all.iter().collect::<Vec<_>>());
        assert_eq!(
            text,
            "  mean_power  1599.589858  W\n  delta         -0.01\n  a_name_that_is_too_long_for_the_column\n                12         s\n"
        );
        assert_eq!(table(&[]), "");
    }
}
