//! Units as a reader of figures wants them: powers as superscripts, a prefix or a power of ten where numbers would be long.

/// A unit to show numbers in.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shown {
    /// The unit to be printed, with prefix or power of ten.
    pub(super) unit: String,
    /// From the unit as it is to what the ticks say.
    pub(super) factor: f64,
}

/// The unit without prefix.
pub(super) fn plain(unit: &str) -> Shown {
    Shown { unit: pretty(unit), factor: 1.0 }
}

/// The unit for numbers up to `largest`, the same for all of an axis: `kN m` for 25 000 N m, `mm` for 10 mm, `10⁻⁶ kg m²` where no prefix fits.
pub(super) fn scaled(unit: &str, largest: f64) -> Shown {
    let plain = plain(unit);
    // 0.010 m are 10 mm; a power of ten is no gain there
    let least = if prefix(&plain.unit, -3).is_some() { 0.1 } else { 1e-2 };
    if unit == "deg" && largest >= 1e-2 || (least..1e4).contains(&largest) || largest == 0.0 || !largest.is_finite() {
        return plain;
    }
    // Shown numbers reach from 0.5 to 500: 0.9e-6 is better read as 0.9 µ than as 900 n.
    let power = ((largest.log10() + 0.3) / 3.0).floor() as i32 * 3;
    let factor = 10f64.powi(-power);
    match prefix(&plain.unit, power) {
        Some(prefix) => Shown { unit: format!("{prefix}{}", plain.unit), factor },
        None => Shown { unit: format!("10{} {}", superscript(power), plain.unit).trim_end().into(), factor },
    }
}

/// The SI prefix for `power`, if the unit begins with a plain symbol that can take one.
fn prefix(unit: &str, power: i32) -> Option<char> {
    let symbol: String = unit.chars().take_while(|c| c.is_alphabetic()).collect();
    // m² would take the prefix squared; kg has one already; kilometres and kiloseconds are not how machines are measured.
    let squared = unit[symbol.len()..].starts_with(['²', '³', '⁻', '^']);
    let fits = match symbol.as_str() {
        "N" | "J" | "W" | "Pa" | "Hz" => true,
        "m" | "s" => power < 0,
        _ => false,
    };
    if squared || !fits {
        return None;
    }
    [(-9, 'n'), (-6, 'µ'), (-3, 'm'), (3, 'k'), (6, 'M'), (9, 'G')].into_iter().find_map(|(known, c)| (known == power).then_some(c))
}

/// `kg m^2/s` as `kg m²/s`, `N*m` as `N m`.
pub(super) fn pretty(unit: &str) -> String {
    let mut text = String::with_capacity(unit.len());
    let mut chars = unit.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '*' | '·' => text.push(' '),
            '^' => {
                while let Some(&digit) = chars.peek().filter(|c| c.is_ascii_digit() || **c == '-') {
                    text.push(raised(digit));
                    chars.next();
                }
            }
            c => text.push(c),
        }
    }
    text
}

/// A whole number as superscript.
pub(super) fn superscript(n: i32) -> String {
    n.to_string().chars().map(raised).collect()
}

fn raised(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32(0x2070 + (c as u32 - '0' as u32)).unwrap_or(c),
        c => c,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_take_a_prefix_or_a_power_of_ten() {
        assert_eq!(scaled("N m", 25e3).unit, "kN m");
        assert_eq!(scaled("N m", 25.0).unit, "N m");
        assert_eq!(scaled("kg m^2", 3e-6).unit, "10⁻⁶ kg m²");
        assert_eq!(scaled("m^2", 1e-5).unit, "10⁻⁶ m²");
        assert_eq!(scaled("m", 2e-3).unit, "mm");
        assert_eq!([scaled("m", 0.05).unit, scaled("s", 0.02).unit, scaled("N", 0.04).unit], ["mm", "ms", "mN"]);
        assert_eq!([scaled("m", 0.3).unit, scaled("m/s", 0.05).unit, scaled("", 0.05).unit], ["m", "mm/s", ""]);
        assert_eq!(scaled("m", 2e5).unit, "10³ m");
        assert_eq!(scaled("", 2e-13).unit, "10⁻¹⁵");
        assert_eq!(scaled("deg", 4e5).unit, "deg");
        assert_eq!(scaled("deg", 1e-3).unit, "10⁻³ deg");
        assert_eq!(scaled("rad/s", 6.0).unit, "rad/s");
        assert_eq!(pretty("m/s^2"), "m/s²");
        assert_eq!(pretty("N*s^-1"), "N s⁻¹");
    }
}
