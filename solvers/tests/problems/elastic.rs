//! A pendulum whose rod is a stiff spring with a damper: stiff in a direction that turns.

use super::base::{Base, Problem, clear, diagonal, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};

/// Gravity (m/s²).
const GRAVITY: f64 = 9.81;

/// A mass of 1 kg at a spring of 1 m.
#[derive(Clone, Debug)]
pub(crate) struct ElasticPendulum {
    base: Base,
    /// k (N/m).
    pub(crate) stiffness: f64,
    /// d (N·s/m).
    pub(crate) damping: f64,
}

impl ElasticPendulum {
    /// Of a stiffness (N/m) and a damping (N·s/m).
    pub(crate) fn new(stiffness: f64, damping: f64) -> Self {
        let dims = Dims { q: 2, v: 2, work: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims), stiffness, damping }, |p| &mut p.base, &[1, 1])
    }

    /// Length, its rate, and the direction of the spring.
    fn spring(&self, at: At<'_>) -> (f64, f64, [f64; 2]) {
        let length = at.q[0].hypot(at.q[1]);
        let e = [at.q[0] / length, at.q[1] / length];
        (length, e[0] * at.v[0] + e[1] * at.v[1], e)
    }
}

impl System for ElasticPendulum {
    stored!();
    vectors!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        diagonal(&mut out.mass, [1.0, 1.0]);
        if stage >= Stage::Dynamics {
            let (length, rate, e) = self.spring(at);
            let pull = self.stiffness * (length - 1.0) + self.damping * rate;
            out.force.copy_from_slice(&[-pull * e[0], -pull * e[1] - GRAVITY]);
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        let (length, rate, e) = self.spring(at);
        let pull = self.stiffness * (length - 1.0) + self.damping * rate;
        for i in 0..2 {
            for j in 0..2 {
                let across = f64::from(u8::from(i == j)) - e[i] * e[j];
                let turning = self.damping * e[i] * (at.v[j] - rate * e[j]) / length;
                out.k.values_mut()[2 * i + j] = self.stiffness * e[i] * e[j] + pull * across / length + turning;
                out.c.values_mut()[2 * i + j] = self.damping * e[i] * e[j];
            }
        }
    }

    /// Of the damper.
    fn power(&mut self, at: At<'_>, _: &[f64], _: &[f64], w: &mut [f64]) {
        let (_, rate, _) = self.spring(at);
        w[0] = -self.damping * rate * rate;
    }
}

impl Problem for ElasticPendulum {
    /// Level, at rest, the spring without force.
    fn start(&self) -> State {
        State { q: vec![1.0, 0.0], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let stretch = state.q[0].hypot(state.q[1]) - 1.0;
        let squares = state.v[0] * state.v[0] + state.v[1] * state.v[1];
        0.5 * squares + GRAVITY * state.q[1] + 0.5 * self.stiffness * stretch * stretch
    }
}
