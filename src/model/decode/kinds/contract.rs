//! What a kind of study declares of itself.

use crate::expression::Dimension;
use crate::model::decode::decoder::Decoder;
use crate::model::fault::At;
use crate::model::fields::{Field, Record, Shape, may};
use crate::model::keys::{Words, words};
use crate::model::merge::Node;
use crate::model::study::Kind;

/// Reads the value of a kind's key; `None` if it is faulty, which was reported then.
pub(super) type Reader = for<'n> fn(&mut Decoder<'n>, Node<'n>, &At<'_, 'n>) -> Option<(Kind, Features)>;

/// A kind of study, as the format has it.
pub(crate) struct Declared {
    /// Its key in a study, the table of its own keys, what it is.
    pub(crate) field: Field,
    /// Its reader.
    pub(super) read: Reader,
}

/// What a kind of study offers.
pub(crate) struct Features {
    /// Dimension of the independent variable; none: the study has one state.
    pub(crate) independent: Option<Dimension>,
    /// The independent variable as a path, if it is not the time.
    pub(crate) first: Option<String>,
    /// Whether it has a motion over the independent variable.
    pub(crate) moves: bool,
    /// Whether it has the columns that a study asks for.
    pub(crate) columns: bool,
    /// Whether reactions are found.
    pub(crate) reactions: bool,
    /// Whether first-order states are followed.
    pub(crate) states: bool,
    /// Whether works of drivers, loads and dampers are known.
    pub(crate) works: bool,
    /// Results with their dimensions.
    pub(crate) results: Vec<(String, Dimension)>,
}

impl Features {
    /// Of a study in time, or in one state, that finds all: the others change what differs.
    pub(super) const WHOLE: Self = Self {
        independent: None,
        first: None,
        moves: true,
        columns: true,
        reactions: true,
        states: true,
        works: false,
        results: Vec::new(),
    };

    /// Of a study whose kind is faulty, so that the rest of it is still read.
    pub(crate) fn faulty() -> Self {
        Self { independent: Some(Dimension::NONE), ..Self::WHOLE }
    }
}

impl Declared {
    pub(super) const fn new(key: &'static str, keys: &'static Record, about: &'static str, read: Reader) -> Self {
        Self { field: may(key, Shape::Map(keys), about), read }
    }
}

words! {
    /// The state about which a study looks.
    pub(super) enum Pose {
        /// The start.
        Start = "start",
        /// The equilibrium that is found from it.
        Statics = "statics",
    }
}

/// What `at` takes.
pub(super) const POSE: Shape = Shape::Word(Pose::WORDS);
