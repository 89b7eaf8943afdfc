//! Numbers that stand in the text of a file as such: the values of parameters and of the start that are one number with a unit,
//! and where their digits are.

use super::document::Document;
use super::reading::BYTE_ORDER;
use super::spans::Spans;
use std::ops::Range;

/// A value of `parameters` or `start` that is one number, as `15 cm` or `~25 deg`.
#[derive(Clone, Debug, PartialEq)]
pub struct Literal {
    /// Section and name: `parameters.l1`, `start.O.angle`.
    pub place: String,
    /// Its name.
    pub name: String,
    /// Whether it is a start value.
    pub start: bool,
    /// The number as written, in its unit.
    pub number: f64,
    /// The unit as written; empty if there is none.
    pub unit: String,
    /// Bytes of the number in the text.
    pub digits: Range<usize>,
}

impl Document {
    /// The literals of the file itself, in file order; what it includes is not its text.
    #[must_use]
    pub fn literals(&self) -> Vec<Literal> {
        let spans = Spans::new(self.text());
        let of = |section: &'static str| {
            let text = self.text();
            let spans = &spans;
            self.named(section).into_iter().filter_map(move |(name, _)| {
                let place = format!("{section}.{name}");
                let span = spans.has(&place).then(|| spans.value(&place)).flatten()?;
                let (number, digits, unit) = number_in(text.get(span.clone())?)?;
                let digits = span.start + digits.start..span.start + digits.end;
                Some(Literal { place, name: name.to_owned(), start: section == "start", number, unit: unit.to_owned(), digits })
            })
        };
        of("parameters").chain(of("start")).collect()
    }
}

/// The text with other numbers in the places of literals; all other bytes stay. Literals must not overlap and rise in the text, in which a
/// sign of the byte order in front does not count.
#[must_use]
pub fn replaced(text: &str, numbers: &[(&Literal, f64)]) -> String {
    let mut sorted: Vec<_> = numbers.iter().collect();
    sorted.sort_by_key(|(literal, _)| literal.digits.start);
    let mut out = String::with_capacity(text.len() + 16);
    let text = text.strip_prefix(BYTE_ORDER).inspect(|_| out.push(BYTE_ORDER)).unwrap_or(text);
    let mut last = 0;
    for (literal, number) in sorted {
        out.push_str(text.get(last..literal.digits.start).unwrap_or_default());
        out.push_str(&written(*number));
        last = literal.digits.end;
    }
    out.push_str(text.get(last..).unwrap_or_default());
    out
}

/// A number in the fewest digits that read back as it.
fn written(number: f64) -> String {
    let size = number.abs();
    if size != 0.0 && !(1e-4..1e9).contains(&size) { format!("{number:e}") } else { format!("{number}") }
}

/// The one number of a scalar's text, its bytes, and the unit behind it.
fn number_in(text: &str) -> Option<(f64, Range<usize>, &str)> {
    let quote = text.chars().next().filter(|c| ['"', '\''].contains(c));
    let inner = match quote {
        Some(quote) => text.strip_prefix(quote)?.strip_suffix(quote)?,
        None => text,
    };
    let behind = inner.strip_prefix('~').unwrap_or(inner).trim_start();
    let start = usize::from(quote.is_some()) + inner.len() - behind.len();
    let length = number_length(behind.as_bytes());
    let number: f64 = behind.get(..length)?.parse().ok()?;
    let unit = behind[length..].trim();
    (number.is_finite() && is_unit(unit)).then_some((number, start..start + length, unit))
}

/// Bytes of the number at the beginning of a text; 0 if there is none.
fn number_length(text: &[u8]) -> usize {
    let digits = |from: usize| text[from.min(text.len())..].iter().take_while(|c| c.is_ascii_digit()).count();
    let at = |i: usize| text.get(i).copied();
    let sign = usize::from(matches!(at(0), Some(b'+' | b'-')));
    let mut end = sign + digits(sign);
    if at(end) == Some(b'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(at(end), Some(b'e' | b'E')) {
        let exponent = end + 1 + usize::from(matches!(at(end + 1), Some(b'+' | b'-')));
        let count = digits(exponent);
        if count > 0 {
            end = exponent + count;
        }
    }
    end
}

/// Whether what stands behind a number can be a unit and nothing else: `N m/rad`, `m/s^2`.
fn is_unit(text: &str) -> bool {
    let mut before = ' ';
    let begins = text.chars().next().is_none_or(|c| c.is_alphabetic() || matches!(c, '°' | '%'));
    begins
        && text.chars().all(|c| {
            let signed = c == '-' && before == '^';
            before = c;
            signed || c.is_alphanumeric() || matches!(c, ' ' | '/' | '^' | '°' | '%' | '_')
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
grashof: 1
parameters:
  l1: 15 cm # ü, a comment
  ratio: 73/12
  k: '6012.1 N m/rad'
  sum: 1 m + 2 cm
  count: -1.5e-3
start: { O.angle: 90 deg, coupler.angle: ~ 25 deg, rocker.angle: tilt }
";

    #[test]
    fn numbers_are_found_and_replaced() {
        let document = Document::read(TEXT, "a.yaml").unwrap();
        let literals = document.literals();
        let shown: Vec<_> = literals.iter().map(|l| (l.place.as_str(), l.number, l.unit.as_str(), &TEXT[l.digits.clone()])).collect();
        assert_eq!(
            shown,
            [
                ("parameters.l1", 15.0, "cm", "15"),
                ("parameters.k", 6012.1, "N m/rad", "6012.1"),
                ("parameters.count", -1.5e-3, "", "-1.5e-3"),
                ("start.O.angle", 90.0, "deg", "90"),
                ("start.coupler.angle", 25.0, "deg", "25"),
            ]
        );
        let changed = replaced(TEXT, &[(&literals[4], 33.25), (&literals[0], 17.0), (&literals[2], 2e-7)]);
        assert_eq!(changed, TEXT.replace("15 cm", "17 cm").replace("~ 25", "~ 33.25").replace("-1.5e-3", "2e-7"));

        // places count from behind the sign of a byte order
        let marked = format!("\u{feff}{TEXT}");
        let literals = Document::from_bytes(marked.as_bytes(), "a.yaml").unwrap().literals();
        assert_eq!(replaced(&marked, &[(&literals[0], 17.0)]), marked.replace("15 cm", "17 cm"));
    }
}
