//! Where the roots of a system come from, and what was met at them.

use crate::model::Crossing;

/// Where a root comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Root {
    /// Switch number `k` of program `program` of the mechanism.
    Force { program: usize, k: usize },
    /// Switch number `k` of the observer's program.
    Column { k: usize },
    /// Winding number, of a gauge.
    Winding { gauge: usize, winding: usize },
    /// Side on which a joint presses: number among the places with a side, and its mode.
    Side { place: usize, mode: usize },
    /// A rigid stop that may be reached.
    Stop(usize),
    /// A rigid stop that was left just now.
    Clear(usize),
    /// A row that holds a joint on a stop.
    Rest { row: usize, stop: usize },
    /// A contact that slides in the sense of its mode, or rests without a row of its own.
    Slides(usize),
    /// A row that holds a contact, which gives way where what holds it reaches its largest value in a sense, −1 or 1.
    Holds { contact: usize, row: usize, sense: i32 },
    /// An event of the model.
    Event(usize),
}

/// What an event of the model does where its function crosses zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Watched {
    /// Output of the observer's program that crosses.
    pub(crate) output: usize,
    /// Direction that counts.
    pub(crate) crossing: Crossing,
    /// Whether the run stops there, or pauses for its parameters to change.
    pub(crate) stops: bool,
    /// Output of the observer's program that is the restitution of an impact.
    pub(crate) impact: Option<usize>,
}

/// A contact that stopped, or gave way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Met {
    /// The contact.
    pub(crate) contact: usize,
    /// The sense of its row's multiplier in which it gave way, −1 or 1; 0 if it stopped.
    pub(crate) sense: i32,
}

/// What was met at switches of couplings: a corner that was passed, with the work there, and a step, over which no rigid body goes, with its
/// height; each by its row.
#[derive(Clone, Debug, Default)]
pub(super) struct Corners {
    pub(super) passed: Option<(usize, f64)>,
    pub(super) step: Option<(usize, f64)>,
}
