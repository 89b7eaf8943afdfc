//! The state whose kinematics stand in the evaluator, so that nothing is evaluated there again.

use grashof_solvers::{At, Position};
use std::sync::atomic::{AtomicU64, Ordering};

/// Positions that one evaluator may count before its numbers could be those of the next one.
const NUMBERS: u64 = 1 << 40;

/// Numbers of positions begin anew with every evaluator.
static FIRST: AtomicU64 = AtomicU64::new(1);

/// What was evaluated last.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    modes: Vec<i32>,
    live: Vec<f64>,
    placed: bool,
    moving: bool,
    /// Whether G is there as well: terms take it away.
    rows: bool,
    /// Whether forces are there as well: whatever else is asked for takes them away.
    loads: bool,
    z: Vec<f64>,
    /// The number of the position.
    number: u64,
}

impl Seen {
    /// Nothing yet.
    pub(super) fn nothing() -> Self {
        Self { number: FIRST.fetch_add(NUMBERS, Ordering::Relaxed), ..Self::default() }
    }

    /// Whether terms that hold M, Φ and G of a numbered position hold those of a state.
    pub(super) fn is_in(&self, position: Position, at: &At<'_>) -> bool {
        position.0 == self.number && self.is_placed(at, false)
    }

    /// The number of the position.
    pub(super) fn number(&self) -> Position {
        Position(self.number)
    }

    /// Whether positions are those of a state, with G if that is asked for.
    pub(super) fn is_placed(&self, at: &At<'_>, rows: bool) -> bool {
        self.placed && (self.rows || !rows) && self.t == at.t && self.q == at.q && self.modes == at.modes && self.live == at.live
    }

    /// Whether velocities are those of a state whose positions are there.
    pub(super) fn is_moving(&self, at: &At<'_>) -> bool {
        self.moving && self.v == at.v
    }

    /// Positions and G have been evaluated.
    pub(super) fn place(&mut self, at: &At<'_>) {
        self.t = at.t;
        copy(&mut self.q, at.q);
        copy(&mut self.modes, at.modes);
        copy(&mut self.live, at.live);
        self.number += 1;
        (self.placed, self.rows, self.moving, self.loads) = (true, true, false, false);
    }

    /// Velocities have been evaluated.
    pub(super) fn moves(&mut self, at: &At<'_>) {
        copy(&mut self.v, at.v);
        (self.moving, self.loads) = (true, false);
    }

    /// Forces have been evaluated where positions and velocities are.
    pub(super) fn loads(&mut self, at: &At<'_>) {
        copy(&mut self.z, at.z);
        self.loads = true;
    }

    /// Whether forces are those of a state whose positions and velocities are there. Whoever asks may change them, so that they are not
    /// taken for those of a state again.
    pub(super) fn takes_loads(&mut self, at: &At<'_>) -> bool {
        std::mem::take(&mut self.loads) && self.z == at.z
    }

    /// G was taken away.
    pub(super) fn without_rows(&mut self) {
        self.rows = false;
    }
}

/// Makes a list equal to another one; the first time allocates.
fn copy<T: Copy>(out: &mut Vec<T>, from: &[T]) {
    if out.len() == from.len() {
        out.copy_from_slice(from);
    } else {
        *out = from.to_vec();
    }
}
