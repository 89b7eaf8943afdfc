//! What a system has: its sizes, its state, and a borrowed view of that state.

/// Sizes of a system, fixed for its life.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dims {
    /// Coordinates, nq ≥ nv (a quaternion has four for three rates).
    pub q: usize,
    /// Velocities, nv.
    pub v: usize,
    /// First-order states, nz.
    pub z: usize,
    /// Holonomic constraint rows, Φ(t, q) = 0; the first rows of G.
    pub holonomic: usize,
    /// Velocity-level rows, Ψ v = ψ; the last rows of G.
    pub nonholonomic: usize,
    /// Switches; each has one mode.
    pub modes: usize,
    /// Parameters that an event may change.
    pub live: usize,
    /// Root functions.
    pub roots: usize,
    /// Integrated powers.
    pub work: usize,
}

impl Dims {
    /// Rows of G and length of λ, m = holonomic + nonholonomic.
    pub fn rows(&self) -> usize {
        self.holonomic + self.nonholonomic
    }
}

/// Everything that determines the future of a system: a clone is a restart point, or the way back from a rejected step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Time (s).
    pub t: f64,
    /// Coordinates (nq).
    pub q: Vec<f64>,
    /// Velocities (nv), q̇ = N(q) v.
    pub v: Vec<f64>,
    /// First-order states (nz).
    pub z: Vec<f64>,
    /// Branch of every switch; fixed inside a step, changed only at an event.
    pub modes: Vec<i32>,
    /// Parameters that an event may change.
    pub live: Vec<f64>,
    /// ∫ power dt (J); integrated beside the motion, never in Newton or in the error test.
    pub work: Vec<f64>,
}

impl State {
    /// A state of zeros.
    pub fn new(dims: Dims) -> Self {
        Self {
            t: 0.0,
            q: vec![0.0; dims.q],
            v: vec![0.0; dims.v],
            z: vec![0.0; dims.z],
            modes: vec![0; dims.modes],
            live: vec![0.0; dims.live],
            work: vec![0.0; dims.work],
        }
    }

    /// The view of this state that a system is evaluated at.
    pub fn at(&self) -> At<'_> {
        At { t: self.t, q: &self.q, v: &self.v, z: &self.z, modes: &self.modes, live: &self.live }
    }

    /// Copies another state of the same sizes into this one without allocating.
    pub fn copy_from(&mut self, other: &State) {
        self.t = other.t;
        self.q.copy_from_slice(&other.q);
        self.v.copy_from_slice(&other.v);
        self.z.copy_from_slice(&other.z);
        self.modes.copy_from_slice(&other.modes);
        self.live.copy_from_slice(&other.live);
        self.work.copy_from_slice(&other.work);
    }
}

/// A borrowed [`State`] without its integrals: the only argument of every evaluation.
///
/// Each field may come from elsewhere than the others (a stage of a scheme, a predictor).
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// Time (s).
    pub t: f64,
    /// Coordinates (nq).
    pub q: &'a [f64],
    /// Velocities (nv).
    pub v: &'a [f64],
    /// First-order states (nz).
    pub z: &'a [f64],
    /// Branch of every switch.
    pub modes: &'a [i32],
    /// Parameters that an event may change.
    pub live: &'a [f64],
}

/// The time that a displacement takes. Positions that rows prescribe by time move on their own in it, and are those of its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Its end, s.
    pub end: f64,
    /// Its length, s.
    pub length: f64,
}

impl Span {
    /// No time at all: a displacement to a neighbour at the same time, s.
    pub fn at(t: f64) -> Self {
        Self { end: t, length: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_a_rollback() {
        let dims = Dims { q: 2, v: 2, z: 1, modes: 1, live: 1, work: 1, ..Dims::default() };
        let start = State { t: 1.0, q: vec![1.0, 2.0], ..State::new(dims) };
        let mut state = start.clone();
        (state.t, state.q[0], state.modes[0]) = (2.0, 9.0, 3);
        assert_ne!(state, start);
        state.copy_from(&start);
        assert_eq!(state, start);
        assert_eq!(state.at().q, [1.0, 2.0]);
    }
}
