//! The kinds of studies, a file each: its keys, and how they are read. [`KINDS`] is the list.

mod balance;
mod contract;
mod dynamics;
mod linearize;
mod modes;
mod periodic;
mod range;
mod statics;

pub(crate) use contract::Features;

use super::decoder::Decoder;
use crate::model::fault::At;
use crate::model::fields::Field;
use crate::model::merge::Node;
use crate::model::study::Kind;
use contract::Declared;

/// All kinds, in the order in which the format lists them.
pub(crate) const KINDS: [Declared; 8] = [
    range::KINEMATICS,
    range::INVERSE,
    dynamics::DYNAMICS,
    statics::STATICS,
    modes::MODES,
    linearize::LINEARIZE,
    periodic::PERIODIC,
    balance::BALANCE,
];

/// What they declare.
pub(crate) const OF_KINDS: [Field; KINDS.len()] = {
    let mut fields = [KINDS[0].field; KINDS.len()];
    let mut i = 0;
    while i < fields.len() {
        fields[i] = KINDS[i].field;
        i += 1;
    }
    fields
};

impl<'n> Decoder<'n> {
    /// The key of the kind of a study, and what stands there, if it is sound.
    pub(super) fn kind(&mut self, study: Node<'n>, at: &At<'_, 'n>) -> (&'static str, Option<(Kind, Features)>) {
        let given = KINDS.iter().find_map(|kind| Some((kind, study.get(kind.field.key)?)));
        // a study without a kind was reported
        let Some((kind, node)) = given else { return ("study", None) };
        (kind.field.key, (kind.read)(self, node, &at.key(kind.field.key)))
    }
}
