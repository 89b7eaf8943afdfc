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
}
