//! `statics`: equilibrium.

use super::contract::{Declared, Features};
use crate::expression::Dimension;
use crate::model::fields::{Record, Shape, need};
use crate::model::study::Kind;

/// `statics`; what `from` may be is all that it says.
static TABLE: Record =
    Record { what: "a statics study", choices: &[], fields: &[need("from", Shape::Word(&["start"]), "Where the search begins.")] };

pub(super) const STATICS: Declared = Declared::new("statics", &TABLE, "Equilibrium.", |_, _, _| {
    let results = vec![("stable".to_owned(), Dimension::NONE)];
    Some((Kind::Statics, Features { independent: Some(Dimension::TIME), moves: false, results, ..Features::WHOLE }))
});
