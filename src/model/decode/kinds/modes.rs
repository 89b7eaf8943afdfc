//! `modes`: vibrations about a held pose.

use super::contract::{Declared, Features, POSE, Pose};
use crate::expression::Dimension;
use crate::model::fields::{Shape, Size};
use crate::model::keys::{Words, keys};
use crate::model::study::{Eigensolver, Kind, Modes};

/// Frequencies that have a name: `frequency_1`, ...
const NAMED: usize = 12;
/// Most modes that may be asked for.
const MOST: u64 = 100_000;

keys! {
    /// `modes`.
    TABLE = ModesKeys "a modes study" [] {
        at: may POSE, "The pose.";
        damped: may Shape::Flag, "Whether damping counts.";
        lowest: may Shape::Count(1, MOST), "Number of modes, the lowest ones; all if omitted, of 100 bodies and more 12.";
        methods: may Shape::List(&Shape::Word(Eigensolver::WORDS), Size::AtLeast(1)), "Eigensolvers that are compared.";
    }
}

pub(super) const MODES: Declared = Declared::new("modes", &TABLE, "Eigenvalues and shapes about a pose.", |_, node, _| {
    let keys = ModesKeys::of(node);
    let mut methods = Vec::new();
    for method in keys.methods.items().iter().filter_map(|item| Eigensolver::named(item.as_str()?)) {
        if !methods.contains(&method) {
            methods.push(method);
        }
    }
    let results = (1..=NAMED).map(|i| (format!("frequency_{i}"), Dimension::ANGULAR_SPEED)).collect();
    let lowest = keys.lowest.count();
    let modes = Modes { at_equilibrium: keys.at.word() == Some(Pose::Statics), damped: keys.damped.flag(), lowest, methods };
    // the table of the study is that of its modes
    Some((Kind::Modes(modes), Features { columns: false, results, ..Features::WHOLE }))
});
