//! What lowering asks of its surroundings and what it gives back.

use super::pool::{Id, Pool};
use super::unit_text::PER_ANGLE;
use super::units::Dimension;
use std::ops::Range;

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its node.
    pub id: Id,
    /// Its dimension.
    pub dimension: Dimension,
}

/// Why a name or a functional cannot stand here; becomes a [`Fault`] at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unknown {
    /// What stands there: ``"`crnk.angle`"``.
    pub found: String,
    /// What could: `"a parameter: l1, l2"`.
    pub expected: String,
    /// One remedy: ``"did you mean `crank.angle`?"``.
    pub help: Option<String>,
}

/// An error of meaning in an expression, with the bytes of the text that it concerns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Bytes of the expression's text.
    pub at: Range<usize>,
    /// What stands there.
    pub found: String,
    /// What was expected instead.
    pub expected: String,
    /// One remedy.
    pub help: Option<String>,
    /// The dimension that was expected, where one was.
    pub wanted: Option<Dimension>,
}

/// A lowered expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lowered {
    /// Its node.
    pub id: Id,
    /// Its dimension.
    pub dimension: Dimension,
    /// A literal 0 (or a product with one): fits every dimension.
    pub any: bool,
    /// Made of plain number literals (and `pi`) only: takes the dimension that its field wants.
    pub bare: bool,
    /// A condition: its value is 0 or 1.
    pub boolean: bool,
}

impl Lowered {
    /// Whether the value may stand where `wanted` is asked for; the error is the text for `found`.
    ///
    /// # Errors
    /// The name of the dimension that was found, if it is another one.
    pub fn expect(&self, wanted: Dimension) -> Result<(), String> {
        match self.any || self.bare || self.dimension == wanted {
            true if wanted.is_angle() && self.dimension.is_per_angle() => Err(PER_ANGLE.to_owned()),
            true => Ok(()),
            false => Err(self.dimension.name()),
        }
    }
}

/// The names that an expression may use: the model's, seen from one field.
pub trait Scope {
    /// The node and dimension of a dotted path such as `crank.angle`.
    ///
    /// # Errors
    /// What to say about a name that does not exist, or may not be used here.
    fn name(&mut self, pool: &mut Pool, path: &str) -> Result<Symbol, Unknown>;

    /// Whether a word alone is the name of a value, though it may not be used here.
    fn has_value(&self, word: &str) -> bool;

    /// Number of the table of this name, with the dimensions of x and y.
    fn table(&mut self, _name: &str) -> Option<(u32, Dimension, Dimension)> {
        None
    }

    /// Number of the external function of this name.
    fn external(&mut self, _name: &str) -> Option<u32> {
        None
    }

    /// The node that is the time rate of an input leaf; `None` if it has none.
    fn rate(&mut self, _pool: &mut Pool, _input: u32) -> Option<Id> {
        None
    }

    /// Called before the first argument of `mean integral max min last value first` is lowered: from here on it may name columns.
    ///
    /// # Errors
    /// What to say where functionals are not allowed; then neither argument is lowered nor `leave_functional` called.
    fn enter_functional(&mut self, name: &str) -> Result<(), Unknown>;

    /// Called after the first argument of a functional was lowered, with or without faults.
    fn leave_functional(&mut self) {}

    /// The functional `name` over a whole study of the quantity `of` (for `first`: a condition), `at` only for `value`.
    /// `text` is the call as written.
    ///
    /// # Errors
    /// What to say about a functional that cannot be.
    fn functional(&mut self, pool: &mut Pool, name: &str, of: Lowered, at: Option<Lowered>, text: &str) -> Result<Symbol, Unknown>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_and_bare_numbers_fit_every_field() {
        let mut pool = Pool::new();
        let id = pool.constant(0.0);
        let zero = Lowered { id, dimension: Dimension::NONE, any: true, bare: true, boolean: false };
        let bare = Lowered { any: false, ..zero };
        let number = Lowered { bare: false, ..bare };
        assert_eq!(zero.expect(Dimension::LENGTH), Ok(()));
        assert_eq!(bare.expect(Dimension::LENGTH), Ok(()));
        assert_eq!(number.expect(Dimension::NONE), Ok(()));
        assert_eq!(number.expect(Dimension::LENGTH), Err("a number".to_owned()));
    }
}
