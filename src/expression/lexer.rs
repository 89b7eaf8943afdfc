//! Text → lexemes. Numbers are narrower than in YAML: what another reader could take for something else is refused.

use super::syntax::SyntaxError;
use std::ops::Range;

/// A word or sign of an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// An unsigned number.
    Number(f64),
    /// A name without dots: also `and`, `or`, `not`, functions and units.
    Word(&'a str),
    /// Names joined by dots.
    Path(&'a str),
    /// An operator, a parenthesis, a comma or `%`.
    Sign(&'static str),
    /// After the last.
    End,
}

/// A token and its bytes.
#[derive(Clone, Debug)]
pub(super) struct Lexeme<'a> {
    pub(super) token: Token<'a>,
    pub(super) at: Range<usize>,
}

/// Longer signs first.
const SIGNS: [&str; 15] = ["<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "^", "(", ")", ",", "%"];

/// What to write of a temperature.
pub(super) const NO_TEMPERATURE: &str = "there are no temperatures: write the number without a unit";

/// Signs of other languages, and what to write instead.
const FOREIGN: [(&str, &str); 24] = [
    ("**", "write `^` for a power"),
    ("&&", "write `and`"),
    ("&", "write `and`"),
    ("||", "write `or`"),
    ("|", "write `or`, or `abs(..)` for a magnitude"),
    ("!", "write `not`"),
    ("=", "write `==` to compare"),
    ("≤", "write `<=`"),
    ("≥", "write `>=`"),
    ("≠", "write `!=`"),
    ("·", "write `*`"),
    ("×", "write `*`"),
    ("°C", NO_TEMPERATURE),
    ("°F", NO_TEMPERATURE),
    ("°", "write `deg`"),
    ("π", "write `pi`"),
    ("²", "write `^2`"),
    ("³", "write `^3`"),
    ("\u{b5}", "write `u`, as in `um`"),
    ("\u{3bc}", "write `u`, as in `um`"),
    ("Ω", "write `ohm`"),
    ("\u{2212}", "write `-`"),
    ("√", "write `sqrt(..)`"),
    ("~", "`~` may only precede a whole value of `start`"),
];

fn is_name_start(c: u8) -> bool {
    c.is_ascii_alphabetic()
}

fn is_name_part(c: u8) -> bool {
    c.is_ascii_alphanumeric() || c == b'_'
}

/// The lexemes of `text`, with an `End` behind them.
pub(super) fn lexemes(text: &str) -> Result<Vec<Lexeme<'_>>, SyntaxError> {
    let bytes = text.as_bytes();
    let mut all = Vec::new();
    let mut i = 0;
    while let Some(&c) = bytes.get(i) {
        let digit_next = bytes.get(i + 1).is_some_and(u8::is_ascii_digit);
        let end = if c.is_ascii_whitespace() {
            i += 1;
            continue;
        } else if c.is_ascii_digit() || (c == b'.' && digit_next) {
            let end = number_end(bytes, i);
            all.push(Lexeme { token: Token::Number(number(text, i, end)?), at: i..end });
            end
        } else if is_name_start(c) {
            let (end, dotted) = path_end(text, i)?;
            let token = if dotted { Token::Path(&text[i..end]) } else { Token::Word(&text[i..end]) };
            all.push(Lexeme { token, at: i..end });
            end
        } else {
            let foreign = text[i..].starts_with("**");
            let Some(sign) = SIGNS.into_iter().find(|sign| !foreign && text[i..].starts_with(sign)) else {
                return Err(match all.last() {
                    Some(Lexeme { token: Token::Number(_), at }) if text[i..].starts_with('π') => times_pi(text, &text[at.clone()], i),
                    _ => stranger(text, i),
                });
            };
            all.push(Lexeme { token: Token::Sign(sign), at: i..i + sign.len() });
            i + sign.len()
        };
        i = end;
    }
    all.push(Lexeme { token: Token::End, at: text.len()..text.len() });
    Ok(all)
}

/// End of a number that begins at `start`, generously: what only looks like a number is judged by [`number`].
fn number_end(bytes: &[u8], start: usize) -> usize {
    let run = |mut i: usize| {
        while bytes.get(i).is_some_and(|c| c.is_ascii_digit() || *c == b'_') {
            i += 1;
        }
        i
    };
    let mut end = run(start);
    if bytes.get(end) == Some(&b'.') {
        end = run(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let digits = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if bytes.get(digits).is_some_and(u8::is_ascii_digit) {
            end = run(digits);
        }
    }
    end
}

fn number(text: &str, start: usize, end: usize) -> Result<f64, SyntaxError> {
    let (word, bytes) = (&text[start..end], text.as_bytes());
    let wrong = |end: usize, help: String| {
        let found = format!("`{}`", &text[start..end]);
        Err(SyntaxError { at: start..end, found, expected: "a number such as `0.5`, `12` or `1e-3`".to_owned(), help: Some(help) })
    };
    // how far a word that is glued to the number reaches: 12:30, 0x1F
    let glued = |mut end: usize| {
        while bytes.get(end).is_some_and(|c| is_name_part(*c) || *c == b':') {
            end += 1;
        }
        end
    };
    let next = bytes.get(end).copied();
    if next == Some(b':') {
        return wrong(glued(end), "times and ratios are not written with a colon; write seconds, or a quotient".to_owned());
    }
    if word == "0" && matches!(next, Some(b'x' | b'o' | b'b')) && bytes.get(end + 1).is_some_and(u8::is_ascii_hexdigit) {
        return wrong(glued(end), "write the number with decimal digits".to_owned());
    }
    if word.contains('_') {
        return wrong(end, format!("write `{}`", word.replace('_', "")));
    }
    if word.ends_with('.') && next.is_some_and(is_name_part) {
        return wrong(glued(end), "a name begins with a letter; a number goes on with a digit after its point".to_owned());
    }
    let digits = word.as_bytes();
    if digits.len() > 1 && digits[0] == b'0' && digits[1].is_ascii_digit() {
        let rest = word.trim_start_matches('0');
        let rest = if rest.starts_with(|c: char| c.is_ascii_digit()) { rest.to_owned() } else { format!("0{rest}") };
        return wrong(end, format!("a leading 0 means octal elsewhere; write `{rest}`"));
    }
    let zero = word.split(['e', 'E']).next().is_some_and(|mantissa| mantissa.bytes().all(|c| c == b'0' || c == b'.'));
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() && (value != 0.0 || zero) => Ok(value),
        _ => wrong(end, "the size of a number lies between 1e-308 and 1e308".to_owned()),
    }
}

/// End of a path that begins at `start`, and whether it has a dot.
fn path_end(text: &str, start: usize) -> Result<(usize, bool), SyntaxError> {
    let bytes = text.as_bytes();
    let (mut end, mut dotted) = (start, false);
    loop {
        while bytes.get(end).is_some_and(|c| is_name_part(*c)) {
            end += 1;
        }
        if bytes.get(end) != Some(&b'.') {
            return Ok((end, dotted));
        }
        if !bytes.get(end + 1).is_some_and(|c| is_name_start(*c)) {
            let found = format!("`{}`", &text[start..=end]);
            let help = Some("a dot joins two names, as in `crank.angle`".to_owned());
            return Err(SyntaxError { at: start..end + 1, found, expected: "a name after the dot".to_owned(), help });
        }
        dotted = true;
        end += 1;
    }
}

/// `2π` and `2πr`.
fn times_pi(text: &str, number: &str, i: usize) -> SyntaxError {
    let behind = &text[i + 'π'.len_utf8()..];
    let name = &behind[..behind.bytes().take_while(|c| is_name_part(*c)).count()];
    let times = if name.is_empty() { "" } else { "*" };
    SyntaxError { help: Some(format!("write `{number}*pi{times}{name}`")), ..stranger(text, i) }
}

fn stranger(text: &str, i: usize) -> SyntaxError {
    let rest = &text[i..];
    let expected = "a number, a name or an operator".to_owned();
    if let Some((sign, help)) = FOREIGN.into_iter().find(|(sign, _)| rest.starts_with(sign)) {
        return SyntaxError { at: i..i + sign.len(), found: format!("`{sign}`"), expected, help: Some(help.to_owned()) };
    }
    let c = rest.chars().next().unwrap_or(' ');
    let help = match c {
        '.' if rest[1..].starts_with(|c: char| c.is_ascii_alphabetic()) => {
            let end = i + 1 + rest[1..].bytes().take_while(|c| is_name_part(*c)).count();
            let help = Some("a value is a finite number; leave out what has none".to_owned());
            return SyntaxError { at: i..end, found: format!("`{}`", &text[i..end]), expected, help };
        }
        c if c.is_alphabetic() || c == '_' => {
            Some("names begin with a letter a-z or A-Z and go on with letters, digits and `_`".to_owned())
        }
        '"' | '\'' => Some("an expression has no quotes inside".to_owned()),
        _ => None,
    };
    SyntaxError { at: i..i + c.len_utf8(), found: format!("`{}`", c.escape_debug()), expected, help }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<Token<'_>> {
        lexemes(text).unwrap().into_iter().map(|l| l.token).collect()
    }

    #[test]
    fn numbers_words_paths_and_signs() {
        use Token::*;
        assert_eq!(tokens("1.5e-3*a.b<=t"), [Number(1.5e-3), Sign("*"), Path("a.b"), Sign("<="), Word("t"), End]);
        assert_eq!(tokens(".5 5. 0 0.0e9 2 e"), [Number(0.5), Number(5.0), Number(0.0), Number(0.0), Number(2.0), Word("e"), End]);
        assert_eq!(tokens("15cm 3e3m"), [Number(15.0), Word("cm"), Number(3e3), Word("m"), End]);
    }

    #[test]
    fn numbers_that_yaml_readers_disagree_about_are_refused() {
        for (text, found, help) in [
            ("010", "`010`", "write `10`"),
            ("00.5", "`00.5`", "write `0.5`"),
            ("1_000", "`1_000`", "write `1000`"),
            ("1e400", "`1e400`", "between"),
            ("1e-400", "`1e-400`", "between"),
            ("12:30", "`12:30`", "colon"),
            (".nan", "`.nan`", "finite"),
            (".inf", "`.inf`", "finite"),
            ("0x1F", "`0x1F`", "decimal"),
            ("1.angle", "`1.angle`", "begins with a letter"),
        ] {
            let error = lexemes(text).unwrap_err();
            assert_eq!(error.found, found);
            assert_eq!(error.at, 0..text.len(), "{text}");
            assert!(error.help.as_ref().is_some_and(|h| h.contains(help)), "{text}: {error:?}");
        }
    }

    #[test]
    fn signs_of_other_languages_have_a_remedy() {
        for (text, help) in [
            ("a ** 2", "^"),
            ("a && b", "and"),
            ("a = b", "=="),
            ("30°", "deg"),
            ("φ", "names begin"),
            ("_a", "names begin"),
            ("a.", "joins"),
        ] {
            let error = lexemes(text).unwrap_err();
            assert!(error.help.is_some_and(|h| h.contains(help)), "{text}");
            assert!(text.get(error.at).is_some(), "{text}");
        }
    }
}
