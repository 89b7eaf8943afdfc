//! Units as text: `kg m^2/s`.

use super::parser::{Kind, parse};
use super::quantity::meant;
use super::units::{Dimension, nearest_unit, unit, unit_words};

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

/// What to write instead of a text that is no unit: what its first unknown word probably means, else the words of the format.
#[must_use]
pub fn meant_unit(text: &str) -> String {
    let mut words = text.split(|c: char| !c.is_alphanumeric() && c != '%').filter(|word| !word.is_empty());
    let unknown = words.find(|word| unit(word).is_none() && word.parse::<u8>().is_err());
    let near = unknown.and_then(|word| Some((word, meant(word).or_else(|| nearest_unit(word).map(str::to_owned))?)));
    match near.map(|(word, near)| text.replacen(word, &near, 1)).filter(|text| parse_unit(text).is_some()) {
        Some(text) => format!("did you mean `{text}`?"),
        None => {
            let words: Vec<&str> = unit_words().collect();
            format!("known: {}; products, quotients and powers of them are written `N m`, `rad/s`, `s^-1`", words.join(" "))
        }
    }
}

/// What is found where an angle is wanted and a number is divided by one.
pub(super) const PER_ANGLE: &str = "a number divided by an angle";

/// What to write instead of a text in which a number is divided by an angle, where an angle is wanted.
#[must_use]
pub fn angle_instead(text: &str) -> String {
    meant_fraction(text)
        .unwrap_or_else(|| "write half a turn as `0.5 turn`, and divide by `1 rad` where a plain number is meant".to_owned())
}

/// What was meant by a fraction of a unit, `1/2 turn`, which is 1/(2 turn); none if a text is something else.
#[must_use]
pub fn meant_fraction(text: &str) -> Option<String> {
    let text = text.trim_start_matches('~').trim();
    let (above, rest) = text.split_once('/')?;
    let (below, unit) = rest.trim().split_once(' ')?;
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let quotient = number(above)? / number(below)?;
    parse_unit(unit)?;
    let short = quotient.to_string();
    let written = if short.len() <= 6 { format!("{short} {unit}") } else { format!("({}/{below})*1 {unit}", above.trim()) };
    Some(format!("a number and its unit are taken first: `{text}` is {}/({below} {unit}); write `{written}`", above.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_is_no_unit_has_a_remedy() {
        for (text, near) in [("Nm", "N m"), ("metres/s", "m/s"), ("rad/sec", "rad/s"), ("cms", "cm"), ("KG", "kg"), ("N mm2", "N mm^2")] {
            assert_eq!(meant_unit(text), format!("did you mean `{near}`?"), "{text}");
        }
        for text in ["", "3", "1/s", "furlong", "Nm + 2", "°C"] {
            let help = meant_unit(text);
            assert!(help.starts_with("known: m km ") && help.contains(" ohm "), "{text}: {help}");
        }
    }

    #[test]
    fn fractions_of_a_unit_are_told_as_they_are_written() {
        for (text, written) in
            [("1/2 turn", "0.5 turn"), ("~1/4 turn", "0.25 turn"), ("1 / 3 N m", "(1/3)*1 N m"), ("3/2 rad/s", "1.5 rad/s")]
        {
            assert!(meant_fraction(text).unwrap().ends_with(&format!("write `{written}`")), "{text}: {:?}", meant_fraction(text));
        }
        for text in ["1/2", "0.5 turn", "a/2 turn", "1/x turn", "1/2 turns", "1/(2 turn)", "1/2 turn + 3 deg"] {
            assert_eq!(meant_fraction(text), None, "{text}");
        }
    }
}
