//! The unit behind a number, and what to say when something else stands there.

use super::lexer::{NO_TEMPERATURE, Token};
use super::parser::{Expr, Kind, Parser, SyntaxError};
use super::units::{Dimension, nearest_unit, unit};
use std::f64::consts::TAU;

/// Largest exponent of a unit.
const MAX_EXPONENT: f64 = 9.0;

impl Parser<'_> {
    /// `NUMBER [UNIT]`, the number being read already: names side by side, `/` or `*` before a name, `^n` behind one.
    ///
    /// No names are known here. Directly behind a number or a unit, and behind `/`, nothing but a unit makes sense; a word behind
    /// `*` is handed on, since it may be a name of the file.
    pub(super) fn quantity(&mut self, number: f64) -> Result<Expr, SyntaxError> {
        let start = self.last().at.start;
        if self.unit_at(0).is_none() {
            self.refuse_false_unit(number)?;
            return Ok(Expr { at: start..self.last().at.end, kind: Kind::Number(number) });
        }
        let (mut factors, mut power, mut dimension) = (1.0, 0, Dimension::NONE);
        let (mut divided, mut below, mut starred) = (false, false, Vec::new());
        while let Some((factor, word_dimension)) = self.unit_at(0) {
            self.advance();
            let n = self.exponent()?;
            let n = if below { -n } else { n };
            match decade(factor) {
                Some(decade) => power += decade * n,
                None => factors *= factor.powi(n),
            }
            dimension = dimension.mul(word_dimension.pow(n));
            below = false;
            match self.peek() {
                Token::Sign(sign @ ("/" | "*")) if self.unit_at(1).is_some() => {
                    self.advance();
                    below = sign == "/";
                    divided |= below;
                    if !below {
                        starred.push(self.here());
                    }
                }
                _ if divided && self.unit_at(0).is_some() => {
                    let word = self.found();
                    let help = Some(format!("write `/{0}` to divide by {0} too, or put it in front of the slash", word.trim_matches('`')));
                    return Err(SyntaxError { at: self.here(), found: word, expected: "`/` before the unit".to_owned(), help });
                }
                _ => {}
            }
        }
        let at = start..self.last().at.end;
        let size = shifted(number, power) * factors;
        if size.is_finite() && (size != 0.0 || number == 0.0) {
            return Ok(Expr { at, kind: Kind::Quantity(size, dimension, starred) });
        }
        Err(SyntaxError { found: format!("`{}`", self.slice(&at)), at, expected: "a finite number in SI units".to_owned(), help: None })
    }

    /// Size and dimension of the unit word `ahead` tokens ahead. `min(` is the function, `m(` could be a table.
    fn unit_at(&self, ahead: usize) -> Option<(f64, Dimension)> {
        match self.token(ahead) {
            Token::Word(_) if self.token(ahead + 1) == Token::Sign("(") => None,
            Token::Word(word) => unit(word),
            Token::Sign("%") => unit("%"),
            _ => None,
        }
    }

    /// The exponent behind a unit word, 1 if there is none.
    fn exponent(&mut self) -> Result<i32, SyntaxError> {
        if self.peek() != Token::Sign("^") {
            return Ok(1);
        }
        self.advance();
        let start = self.here().start;
        let negative = self.peek() == Token::Sign("-");
        if matches!(self.peek(), Token::Sign("-" | "+")) {
            self.advance();
        }
        match self.peek() {
            Token::Number(n) if n.fract() == 0.0 && n <= MAX_EXPONENT => {
                self.advance();
                Ok(if negative { -(n as i32) } else { n as i32 })
            }
            _ => {
                let help = "`^n` belongs to the unit; for a power of the quantity write `(2 m)^k`".to_owned();
                let at = start..self.here().end;
                let expected = "a whole number from -9 to 9 as the unit's exponent".to_owned();
                Err(SyntaxError { at, found: self.found(), expected, help: Some(help) })
            }
        }
    }

    /// A word behind a number that is no unit: `4 Hz`, `4 Nm`, `2 k`.
    fn refuse_false_unit(&self, number: f64) -> Result<(), SyntaxError> {
        let Token::Word(word) = self.peek() else { return Ok(()) };
        if matches!(word, "and" | "or") {
            return Ok(());
        }
        let at = self.here();
        let text = self.slice(&self.last().at);
        let error = |expected: &str, help: String| {
            Err(SyntaxError { at, found: format!("`{word}`"), expected: expected.to_owned(), help: Some(help) })
        };
        if matches!(word, "Hz" | "kHz" | "MHz") {
            let hertz = number
                * if word == "Hz" {
                    1.0
                } else if word == "kHz" {
                    1e3
                } else {
                    1e6
                };
            let radians = format!("{:.2e}", hertz * TAU).parse().unwrap_or(hertz * TAU);
            return error("turn/s or rad/s", format!("write `{hertz} turn/s` or `{radians} rad/s`"));
        }
        if matches!(word, "K" | "degC" | "degF" | "celsius" | "kelvin") {
            return error("a unit or an operator", NO_TEMPERATURE.to_owned());
        }
        if matches!(word, "kph" | "kmh" | "kmph") {
            return error("a unit or an operator", format!("write `{text} km/(60 min)`"));
        }
        if let Some(word) = ["and", "or"].into_iter().find(|known| known.eq_ignore_ascii_case(word)) {
            return error("a unit or an operator", format!("write `{word}`"));
        }
        // `60 U/min`, `60 rev/s`
        if let ("U" | "r" | "rev" | "revs" | "turns", Token::Sign("/"), Token::Word(time @ ("min" | "s"))) =
            (word, self.token(1), self.token(2))
        {
            return error("a unit or an operator", format!("write `{text} {}`", if time == "min" { "rpm" } else { "turn/s" }));
        }
        // the factor of a power is another one
        if !matches!(self.token(1), Token::Sign("(" | "^"))
            && let Some((power, times, known, name)) = multiple(word)
        {
            let meant = format!("{} {known}", shifted(number * times, power));
            return error(
                "a unit or an operator",
                match name {
                    Some(name) => format!("for {name} write `{meant}`, for a product `{text}*{word}`"),
                    None => format!("write `{meant}`"),
                },
            );
        }
        if self.token(1) != Token::Sign("(")
            && let Some(units) = meant(word)
        {
            let power = match (self.token(1), self.token(2)) {
                (Token::Sign("^"), Token::Number(power)) => format!("^{power}"),
                _ => String::new(),
            };
            return error("a unit or an operator", format!("write `{text} {units}{power}`"));
        }
        let call = if self.token(1) == Token::Sign("(") { "(..)" } else { "" };
        let near = nearest_unit(word).filter(|_| call.is_empty());
        let near = near.map_or_else(String::new, |near| format!("did you mean `{text} {near}`? "));
        error("a unit or an operator", format!("{near}a product is written with a star: `{text}*{word}{call}`").replace("? a", "? A"))
    }
}

/// What is meant by a word that is a multiple of a known unit and no unit of the format: the power of ten, a factor, the unit, and what it
/// is called where the word might be a name as well.
fn multiple(word: &str) -> Option<(i32, f64, &'static str, Option<&'static str>)> {
    const PREFIXES: [(&str, i32); 10] =
        [("da", 1), ("d", -1), ("c", -2), ("h", 2), ("m", -3), ("u", -6), ("n", -9), ("k", 3), ("M", 6), ("G", 9)];
    const OF: [&str; 12] = ["m", "g", "s", "rad", "N", "J", "W", "Pa", "bar", "V", "A", "ohm"];
    match word {
        "t" => return Some((3, 1.0, "kg", Some("tonnes"))),
        "tonne" | "tonnes" => return Some((3, 1.0, "kg", None)),
        "h" => return Some((0, 60.0, "min", Some("hours"))),
        "hr" | "hrs" | "hour" | "hours" => return Some((0, 60.0, "min", None)),
        _ => {}
    }
    PREFIXES.into_iter().find_map(|(prefix, power)| {
        let of = OF.into_iter().find(|of| word.strip_prefix(prefix) == Some(of))?;
        Some((power, 1.0, of, None))
    })
}

/// What to write for a name that is none, but a unit, or hours.
pub(crate) fn unit_hint(word: &str) -> Option<String> {
    if unit(word).is_some() {
        return Some(format!("`{word}` is a unit and follows its number: `1 {word}`"));
    }
    if matches!(word, "h" | "hr" | "hour" | "hours") {
        return Some("hours are no unit: write `60 min` for one, as in `5 km/(60 min)`".to_owned());
    }
    None
}

/// What to write for a name that is none, but near to a unit.
pub(super) fn near_unit_hint(word: &str) -> Option<String> {
    let near = meant(word).or_else(|| nearest_unit(word).map(str::to_owned))?;
    Some(format!("did you mean the unit `{near}`? It follows its number: `1 {near}`"))
}

/// What to write for a word behind a slash, where a unit may stand, that is meant as one: `mm2` in `3 N/mm2`.
pub(super) fn unit_below(before: &str, word: &str) -> Option<String> {
    let above = before.trim_end().strip_suffix('/')?;
    if matches!(word, "h" | "hr" | "hour" | "hours") {
        return unit_hint(word);
    }
    let (start, _) = above.char_indices().rev().take_while(|(_, c)| c.is_alphanumeric() || "^. ".contains(*c)).last()?;
    let above = above[start..].trim();
    let quantity = above.starts_with(|c: char| c.is_ascii_digit()) && above.ends_with(|c: char| c.is_alphanumeric());
    meant(word).filter(|_| quantity).map(|units| format!("write `{above}/{}`", units.replace(' ', "/")))
}

/// The power of ten that a factor is, if it is one.
fn decade(factor: f64) -> Option<i32> {
    let power = factor.log10().round() as i32;
    (format!("1e{power}").parse() == Ok(factor)).then_some(power)
}

/// number · 10^power as if the decimal point were moved in the text: 77.85 mm is the same double as 0.07785, which neither
/// a product nor a quotient gives for all numbers.
fn shifted(number: f64, power: i32) -> f64 {
    let text = format!("{number:e}");
    let moved = text.split_once('e').and_then(|(mantissa, e)| Some(format!("{mantissa}e{}", e.parse::<i32>().ok()? + power)));
    moved.and_then(|text| text.parse().ok()).unwrap_or(f64::NAN)
}

/// The units that a word probably means: `Nm` is `N m`, `KG` is `kg`, `mm2` is `mm^2`.
pub(super) fn meant(word: &str) -> Option<String> {
    const LONG: [(&str, &str); 27] = [
        ("rps", "turn/s"),
        ("RPS", "turn/s"),
        ("mps", "m/s"),
        ("degree", "deg"),
        ("degrees", "deg"),
        ("radian", "rad"),
        ("radians", "rad"),
        ("meter", "m"),
        ("metre", "m"),
        ("meters", "m"),
        ("metres", "m"),
        ("lbs", "lb"),
        ("pound", "lb"),
        ("pounds", "lb"),
        ("inches", "in"),
        ("feet", "ft"),
        ("second", "s"),
        ("seconds", "s"),
        ("sec", "s"),
        ("turns", "turn"),
        ("rev", "turn"),
        ("inch", "in"),
        ("newton", "N"),
        ("watt", "W"),
        ("percent", "%"),
        ("RPM", "rpm"),
        ("Ohm", "ohm"),
    ];
    if let Some((_, short)) = LONG.into_iter().find(|(long, _)| *long == word) {
        return Some(short.to_owned());
    }
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    let power = match &word[letters.len()..] {
        "" => String::new(),
        n @ ("2" | "3" | "4") => format!("^{n}"),
        _ => return None,
    };
    if !power.is_empty() && unit(letters).is_some() {
        return Some(letters.to_owned() + &power);
    }
    let lower = letters.to_ascii_lowercase();
    if lower != word && letters.len() > 1 && unit(&lower).is_some() {
        return Some(lower + &power);
    }
    // torques are what people glue together
    (1..letters.len()).rev().find_map(|i| {
        let (first, rest) = letters.split_at(i);
        let [one, other] = [first, rest].map(|word| unit(word).map(|(_, dimension)| dimension));
        let grams = first == "g" && matches!(rest, "cm" | "mm");
        (grams || matches!(first, "N" | "kN" | "MN" | "kg" | "W" | "V" | "A") && other.is_some() && one != other)
            .then(|| format!("{first} {rest}{power}"))
    })
}

#[cfg(test)]
mod tests {
    use super::super::parser::parse;
    use super::*;
    use std::f64::consts::PI;

    fn quantity(text: &str) -> (f64, Dimension) {
        match parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}")).kind {
            Kind::Quantity(x, dimension, _) => (x, dimension),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn units_of_the_format() {
        assert_eq!(quantity("15 cm"), (0.15, Dimension::LENGTH));
        assert_eq!(quantity("77.85mm"), (0.07785, Dimension::LENGTH));
        assert_eq!(quantity("2 m^2"), (2.0, Dimension::AREA));
        assert_eq!(quantity("4.26 N m s/rad"), (4.26, Dimension::ANGULAR_DAMPING));
        assert_eq!(quantity("3 N*m*s"), (3.0, Dimension::ANGULAR_DAMPING));
        assert_eq!(quantity("9.81 m/s^2"), (9.81, Dimension::ACCELERATION));
        assert_eq!(quantity("9.81 m s^-2"), (9.81, Dimension::ACCELERATION));
        assert_eq!(quantity("3 N/m/s"), (3.0, Dimension::STIFFNESS.div(Dimension::TIME)));
        assert!((quantity("240 rpm").0 - 8.0 * PI).abs() < 1e-14);
        assert_eq!((quantity("0.3 mm").0, quantity("4530 kN/mm").0, quantity("0 mm").0), (0.0003, 4.53e9, 0.0));
        assert_eq!(quantity("50%"), (0.5, Dimension::NONE));
        assert_eq!(quantity("1 in/min").1, Dimension::SPEED);
        assert_eq!(quantity("4 mm^2"), (4e-6, Dimension::AREA));
    }

    #[test]
    fn hertz_is_a_choice() {
        let error = parse("4 Hz").unwrap_err();
        assert_eq!(error.help.as_deref(), Some("write `4 turn/s` or `25.1 rad/s`"));
        assert_eq!(error.at, 2..4);
    }

    #[test]
    fn words_that_look_like_units() {
        for (text, help) in [
            ("4 Nm", "write `4 N m`"),
            ("4 Nms", "write `4 N ms`"),
            ("0.015 kgm^2", "write `0.015 kg m^2`"),
            ("0.015 kgm2", "write `0.015 kg m^2`"),
            ("3 gcm^2", "write `3 g cm^2`"),
            ("2 KG", "write `2 kg`"),
            ("2 mm2", "write `2 mm^2`"),
            ("30 degrees", "write `30 deg`"),
            ("5 cms", "did you mean `5 cm`? A product is written with a star: `5*cms`"),
            ("0.5 lbs", "write `0.5 lb`"),
            ("2 rps", "write `2 turn/s`"),
            ("50 kph", "write `50 km/(60 min)`"),
            ("20 degC", "there are no temperatures: write the number without a unit"),
            ("20 °C", "there are no temperatures: write the number without a unit"),
            ("293 K", "there are no temperatures: write the number without a unit"),
            ("120 1/min", "write `120 min^-1`, or `120 turn/min` for turns"),
            ("5 % 3", "a remainder is `mod(5, 3)`"),
            ("a % b", "a remainder is `mod(a, b)`"),
            ("a AND b", "write `and`"),
            ("a > 1 Or b > 2", "write `or`"),
            ("NOT a", "write `not`"),
            ("sin 3", "write `sin(3)`"),
            ("2*cos x", "write `cos(x)`"),
            ("if t > 1 s", "write `if(condition, then, else)`"),
            ("5 t", "for tonnes write `5000 kg`, for a product `5*t`"),
            ("2.5 tonnes", "write `2500 kg`"),
            ("2 h", "for hours write `120 min`, for a product `2*h`"),
            ("5 mN", "write `0.005 N`"),
            ("3 dm", "write `0.3 m`"),
            ("60 U/min", "write `60 rpm`"),
            ("1 rev/s", "write `1 turn/s`"),
            ("2π", "write `2*pi`"),
            ("2πr", "write `2*pi*r`"),
            ("π/2", "write `pi`"),
            ("2 m²", "write `^2`"),
            ("5 µm", "write `u`, as in `um`"),
            ("3,5 m/s", "a decimal point: `3.5 m/s`"),
            ("2 k", "a product is written with a star: `2*k`"),
            ("2 f(a)", "a product is written with a star: `2*f(..)`"),
        ] {
            assert_eq!(parse(text).unwrap_err().help.as_deref(), Some(help), "{text}");
        }
    }

    #[test]
    fn after_a_slash_every_unit_needs_its_own() {
        let error = parse("2 N/m s").unwrap_err();
        assert_eq!(error.at, 6..7);
        assert!(error.help.unwrap().contains("`/s`"));
        for text in ["2 m^k", "2 m^2.5", "2 m^", "2 m^10", "1e300 km^9", "1e-300 mm^9", "2 m^(1/2)"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
