//! Lexemes → syntax tree, by recursive descent on the grammar of `FORMAT.md` section 3.
//!
//! ```text
//! or:  and {"or" and}      and: not {"and" not}      not: ["not"] cmp      cmp: sum [("<"|"<="|">"|">="|"=="|"!=") sum]
//! sum: term {("+"|"-") term}   term: sign {("*"|"/") sign}   sign: ["-"|"+"] sign | power   power: atom ["^" sign]
//! atom: NUMBER [UNIT] | PATH | NAME "(" expr {"," expr} ")" | "(" expr ")"
//! ```
//!
//! Chains are lists, not left-leaning trees, so the height of the tree is bounded by the nesting and no walk over it can
//! exhaust the stack.

use super::lexer::{Lexeme, Token, lexemes};
use super::switch::Compare;
pub(super) use super::syntax::SyntaxError;
use super::units::{Dimension, unit};
use std::ops::Range;

/// Deepest nesting of parentheses, signs and powers.
const MAX_DEPTH: usize = 64;
/// Longest text, bytes.
const MAX_LENGTH: usize = 64 * 1024;

/// A node of the syntax tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// Its bytes in the text.
    pub at: Range<usize>,
    /// What it is.
    pub kind: Kind,
}

/// The kinds of syntax.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A number without a unit.
    Number(f64),
    /// A number with a unit, in SI; bytes of the words of the unit that stand behind a `*`, which a name may claim.
    Quantity(f64, Dimension, Vec<Range<usize>>),
    /// A name, or names joined by dots.
    Path(String),
    /// A function's name, its bytes, its arguments.
    Call(String, Range<usize>, Vec<Expr>),
    /// −a.
    Negate(Box<Expr>),
    /// `not a`.
    Not(Box<Expr>),
    /// First term, then terms that are added (false) or subtracted (true).
    Sum(Box<Expr>, Vec<(bool, Expr)>),
    /// First factor, then factors that multiply (false) or divide (true).
    Product(Box<Expr>, Vec<(bool, Expr)>),
    /// Base and exponent.
    Power(Box<Expr>, Box<Expr>),
    /// A comparison.
    Compare(Compare, Box<Expr>, Box<Expr>),
    /// Conditions joined by `and`.
    And(Vec<Expr>),
    /// Conditions joined by `or`.
    Or(Vec<Expr>),
}

impl Expr {
    /// The value of a literal: a number without a unit, perhaps with a minus in front.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match &self.kind {
            Kind::Number(x) => Some(*x),
            Kind::Negate(a) => a.number().map(|x| -x),
            _ => None,
        }
    }

    /// Whether this is [`Self::number`].
    #[must_use]
    pub fn is_number(&self) -> bool {
        self.number().is_some()
    }

    /// The path of an expression that is one name or dotted path.
    #[must_use]
    pub fn path(&self) -> Option<&str> {
        match &self.kind {
            Kind::Path(path) => Some(path),
            _ => None,
        }
    }
}

/// The syntax tree of an expression.
///
/// # Errors
/// The first place where the text leaves the grammar.
pub fn parse(text: &str) -> Result<Expr, SyntaxError> {
    if text.len() > MAX_LENGTH {
        let found = format!("{} bytes", text.len());
        let help = Some("give parts of it names under `measures` or `parameters`".to_owned());
        return Err(SyntaxError { at: 0..0, found, expected: format!("an expression of at most {MAX_LENGTH} bytes"), help });
    }
    let mut parser = Parser { text, lexemes: lexemes(text)?, next: 0, depth: 0, open: 0 };
    let expr = parser.or()?;
    match parser.peek() {
        Token::End => Ok(expr),
        _ => Err(parser.unexpected("an operator or the end")),
    }
}

/// What a word or sign that joins two operands is.
const COMPARISONS: [(&str, Compare); 6] = [
    ("<", Compare::Less),
    ("<=", Compare::LessEqual),
    (">", Compare::Greater),
    (">=", Compare::GreaterEqual),
    ("==", Compare::Equal),
    ("!=", Compare::NotEqual),
];

/// Functions of one argument, whose parentheses another language may leave out.
const OF_ONE: [&str; 18] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "log10", "sinh", "cosh", "tanh", "floor", "ceil", "round", "sqrt", "abs",
    "sign",
];

/// The word that joins or turns conditions and that stands there in capitals.
fn word_of(word: &str) -> Option<&'static str> {
    ["and", "or", "not"].into_iter().find(|known| *known != word && known.eq_ignore_ascii_case(word))
}

/// Position in the lexemes of a text.
pub(super) struct Parser<'a> {
    text: &'a str,
    lexemes: Vec<Lexeme<'a>>,
    next: usize,
    depth: usize,
    /// Parentheses that are open.
    open: usize,
}

impl<'a> Parser<'a> {
    /// The token `ahead` tokens ahead.
    pub(super) fn token(&self, ahead: usize) -> Token<'a> {
        self.lexemes.get(self.next + ahead).map_or(Token::End, |l| l.token)
    }

    pub(super) fn peek(&self) -> Token<'a> {
        self.token(0)
    }

    pub(super) fn advance(&mut self) {
        self.next += 1;
    }

    /// The lexeme before the present one (the first at the start).
    pub(super) fn last(&self) -> &Lexeme<'a> {
        &self.lexemes[self.next.saturating_sub(1).min(self.lexemes.len() - 1)]
    }

    /// Bytes of the present lexeme.
    pub(super) fn here(&self) -> Range<usize> {
        self.lexemes.get(self.next).map_or(self.text.len()..self.text.len(), |l| l.at.clone())
    }

    pub(super) fn slice(&self, at: &Range<usize>) -> &'a str {
        self.text.get(at.clone()).unwrap_or_default()
    }

    /// The present lexeme for a message.
    pub(super) fn found(&self) -> String {
        match self.peek() {
            Token::End if self.text.trim().is_empty() => "nothing".to_owned(),
            Token::End => "the end of the expression".to_owned(),
            _ => format!("`{}`", self.slice(&self.here())),
        }
    }

    fn take(&mut self, sign: &str) -> bool {
        let taken = matches!(self.peek(), Token::Sign(s) if s == sign);
        self.next += usize::from(taken);
        taken
    }

    fn take_word(&mut self, word: &str) -> bool {
        let taken = matches!(self.peek(), Token::Word(w) if w == word);
        self.next += usize::from(taken);
        taken
    }

    /// An error at the present lexeme, with the remedy that the surroundings suggest.
    fn unexpected(&self, expected: &str) -> SyntaxError {
        const TRAP: &str = "inside `{ }` and `[ ]` a comma ends the value: quote the expression, or put it on a line of its own";
        let before = self.slice(&self.last().at);
        let behind_operand = self.next > 0
            && match self.last().token {
                Token::Number(_) | Token::Path(_) => true,
                Token::Word(word) => !matches!(word, "and" | "or" | "not"),
                Token::Sign(sign) => matches!(sign, ")" | "%"),
                Token::End => false,
            };
        let help = self.of_other_languages().or_else(|| match self.peek() {
            Token::End if self.open > 0 => Some(format!("a parenthesis is not closed; {TRAP}")),
            Token::Sign(")") if self.open == 0 => Some(format!("no parenthesis is open here; {TRAP}")),
            Token::Sign(",") if self.open == 0 => Some(match (self.last().token, self.token(1)) {
                (Token::Number(_), Token::Number(_)) => {
                    let behind = &self.text[self.lexemes[self.next + 1].at.start..];
                    let end = behind.bytes().take_while(|c| c.is_ascii_alphanumeric() || b" ./^".contains(c)).count();
                    format!("a decimal point: `{before}.{}`", behind[..end].trim_end())
                }
                _ => "commas only separate the arguments of a function".to_owned(),
            }),
            Token::Sign("%") => Some("a unit directly follows a number".to_owned()),
            Token::Sign("(") | Token::Number(_) | Token::Word(_) | Token::Path(_) if behind_operand => {
                let there = if self.peek() == Token::Sign("(") { "(..)" } else { self.slice(&self.here()) };
                let left = if before == ")" { "(..)" } else { before };
                Some(format!("a product is written with a star: `{left}*{there}`"))
            }
            _ => None,
        });
        SyntaxError { at: self.here(), found: self.found(), expected: expected.to_owned(), help }
    }

    /// What to write where two operands meet as they may in another language: `5 % 3`, `a AND b`, `sin 3`, `120 1/min`.
    fn of_other_languages(&self) -> Option<String> {
        let begins = |token: Token<'_>| matches!(token, Token::Number(_) | Token::Word(_) | Token::Path(_) | Token::Sign("("));
        let operand =
            |at: usize| self.lexemes.get(at).map(|l| if matches!(l.token, Token::Sign("(" | ")")) { "(..)" } else { self.slice(&l.at) });
        let before = self.next.checked_sub(1)?;
        match (self.last().token, self.peek()) {
            (_, Token::Sign("%")) if begins(self.token(1)) => {
                Some(format!("a remainder is `mod({}, {})`", operand(before)?, operand(self.next + 1)?))
            }
            (Token::Sign("%"), next) if begins(next) => {
                Some(format!("a remainder is `mod({}, {})`", operand(before.checked_sub(1)?)?, operand(self.next)?))
            }
            (Token::Number(_), Token::Number(1.0)) if self.token(1) == Token::Sign("/") => {
                let (number, unit) = (operand(before)?, operand(self.next + 2).filter(|word| unit(word).is_some())?);
                let turns = matches!(unit, "min" | "s").then(|| format!(", or `{number} turn/{unit}` for turns"));
                Some(format!("write `{number} {unit}^-1`{}", turns.unwrap_or_default()))
            }
            (_, Token::Word(word)) if word_of(word).is_some() => Some(format!("write `{}`", word_of(word)?)),
            (Token::Word(word), next) if word_of(word).is_some() && begins(next) => Some(format!("write `{}`", word_of(word)?)),
            (Token::Word("if"), next) if begins(next) && next != Token::Sign("(") => Some("write `if(condition, then, else)`".to_owned()),
            (Token::Word(word), next) if OF_ONE.contains(&word) && begins(next) && next != Token::Sign("(") => {
                Some(format!("write `{word}({})`", operand(self.next)?))
            }
            _ => None,
        }
    }

    /// Runs `rule` one level deeper.
    fn nested<T>(&mut self, rule: impl FnOnce(&mut Self) -> Result<T, SyntaxError>) -> Result<T, SyntaxError> {
        if self.depth >= MAX_DEPTH {
            let help = Some("give parts of it names under `measures` or `parameters`".to_owned());
            let expected = format!("at most {MAX_DEPTH} levels of nesting");
            return Err(SyntaxError { at: self.here(), found: "a deeper level".to_owned(), expected, help });
        }
        self.depth += 1;
        let result = rule(self);
        self.depth -= 1;
        result
    }

    /// `rule {word rule}`.
    fn joined(
        &mut self,
        word: &str,
        rule: fn(&mut Self) -> Result<Expr, SyntaxError>,
        kind: fn(Vec<Expr>) -> Kind,
    ) -> Result<Expr, SyntaxError> {
        let first = rule(self)?;
        if self.peek() != Token::Word(word) {
            return Ok(first);
        }
        let start = first.at.start;
        let mut all = vec![first];
        while self.take_word(word) {
            all.push(rule(self)?);
        }
        Ok(Expr { at: start..self.last().at.end, kind: kind(all) })
    }

    fn or(&mut self) -> Result<Expr, SyntaxError> {
        self.joined("or", Self::and, Kind::Or)
    }

    fn and(&mut self) -> Result<Expr, SyntaxError> {
        self.joined("and", Self::not, Kind::And)
    }

    fn not(&mut self) -> Result<Expr, SyntaxError> {
        let start = self.here().start;
        if !self.take_word("not") {
            return self.comparison();
        }
        let a = self.comparison()?;
        Ok(Expr { at: start..a.at.end, kind: Kind::Not(Box::new(a)) })
    }

    fn compare_sign(&self) -> Option<Compare> {
        let Token::Sign(sign) = self.peek() else { return None };
        COMPARISONS.into_iter().find(|(text, _)| *text == sign).map(|(_, op)| op)
    }

    fn comparison(&mut self) -> Result<Expr, SyntaxError> {
        let a = self.sum()?;
        let Some(op) = self.compare_sign() else { return Ok(a) };
        self.advance();
        let b = self.sum()?;
        if self.compare_sign().is_some() {
            let error = self.unexpected("`and`, `or` or the end");
            return Err(SyntaxError { help: Some("comparisons do not chain: write `a < b and b < c`".to_owned()), ..error });
        }
        Ok(Expr { at: a.at.start..b.at.end, kind: Kind::Compare(op, Box::new(a), Box::new(b)) })
    }

    /// `rule {(plus|minus) rule}`.
    fn chain(
        &mut self,
        [plus, minus]: [&str; 2],
        rule: fn(&mut Self) -> Result<Expr, SyntaxError>,
        kind: fn(Box<Expr>, Vec<(bool, Expr)>) -> Kind,
    ) -> Result<Expr, SyntaxError> {
        let first = rule(self)?;
        let mut rest = Vec::new();
        loop {
            let inverse = self.take(minus);
            if !inverse && !self.take(plus) {
                break;
            }
            rest.push((inverse, rule(self)?));
        }
        if rest.is_empty() {
            return Ok(first);
        }
        Ok(Expr { at: first.at.start..self.last().at.end, kind: kind(Box::new(first), rest) })
    }

    fn sum(&mut self) -> Result<Expr, SyntaxError> {
        self.chain(["+", "-"], Self::term, Kind::Sum)
    }

    fn term(&mut self) -> Result<Expr, SyntaxError> {
        self.chain(["*", "/"], Self::sign, Kind::Product)
    }

    fn sign(&mut self) -> Result<Expr, SyntaxError> {
        let start = self.here().start;
        if self.take("-") {
            let a = self.nested(Self::sign)?;
            return Ok(Expr { at: start..a.at.end, kind: Kind::Negate(Box::new(a)) });
        }
        if self.take("+") {
            return self.nested(Self::sign);
        }
        self.power()
    }

    fn power(&mut self) -> Result<Expr, SyntaxError> {
        let base = self.atom()?;
        if !self.take("^") {
            return Ok(base);
        }
        let exponent = self.nested(Self::sign)?;
        Ok(Expr { at: base.at.start..exponent.at.end, kind: Kind::Power(Box::new(base), Box::new(exponent)) })
    }

    fn atom(&mut self) -> Result<Expr, SyntaxError> {
        let at = self.here();
        match self.peek() {
            Token::Number(x) => {
                self.advance();
                self.quantity(x)
            }
            Token::Word(word @ ("and" | "or" | "not")) => {
                let error = self.unexpected("a number, a name or `(`");
                let help = if word == "not" {
                    "`not` applies to a whole comparison; use parentheses: `(not a)`"
                } else {
                    "a condition is missing before it"
                };
                Err(SyntaxError { help: Some(help.to_owned()), ..error })
            }
            Token::Word(word) => {
                self.advance();
                if !self.take("(") {
                    return Ok(Expr { at, kind: Kind::Path(word.to_owned()) });
                }
                let arguments = self.arguments()?;
                Ok(Expr { at: at.start..self.last().at.end, kind: Kind::Call(word.to_owned(), at, arguments) })
            }
            Token::Path(path) => {
                self.advance();
                Ok(Expr { at, kind: Kind::Path(path.to_owned()) })
            }
            Token::Sign("(") => {
                self.advance();
                self.open += 1;
                let inner = self.nested(Self::or)?;
                self.close("an operator or `)`")?;
                // the parentheses belong to it, so that a caret or a quotation covers them
                Ok(Expr { at: at.start..self.last().at.end, kind: inner.kind })
            }
            _ => Err(self.unexpected("a number, a name or `(`")),
        }
    }

    /// The arguments of a call whose parenthesis was opened just now.
    fn arguments(&mut self) -> Result<Vec<Expr>, SyntaxError> {
        self.open += 1;
        let mut arguments = Vec::new();
        if self.peek() != Token::Sign(")") {
            loop {
                arguments.push(self.nested(Self::or)?);
                if !self.take(",") {
                    break;
                }
            }
        }
        self.close("an operator, `,` or `)`")?;
        Ok(arguments)
    }

    fn close(&mut self, expected: &str) -> Result<(), SyntaxError> {
        if !self.take(")") {
            return Err(self.unexpected(expected));
        }
        self.open -= 1;
        Ok(())
    }
}

#[cfg(test)]
#[path = "parser_tests.rs"]
mod tests;
