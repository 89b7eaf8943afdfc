//! Roots of the inner system that are crossed.

use super::loops::Loops;
use super::{combine, congruent, times};
use crate::{Effect, State, System};
use nalgebra::{DMatrix, DVector};

/// Part of the largest velocity that time prescribes by which another is no rounding.
const KINK: f64 = 1e-12;

impl<S: System> Loops<S> {
    /// Crosses a root of the inner system after [`Loops::reach`] at a state in minimal coordinates, which takes what has changed; the row
    /// of a blow is `full`.
    pub(super) fn cross(&mut self, root: usize, state: &mut State) -> Effect {
        self.state.work.copy_from_slice(&state.work);
        let Self { inner, state: whole, full, .. } = self;
        let effect = inner.cross(root, whole, full);
        let (modes, _) = state.modes.split_at_mut(whole.modes.len());
        modes.copy_from_slice(&whole.modes);
        state.q.copy_from_slice(&whole.q);
        state.z.copy_from_slice(&whole.z);
        state.live.copy_from_slice(&whole.live);
        state.v.iter_mut().zip(&self.independent).for_each(|(v, &i)| *v = whole.v[i]);
        if effect == Effect::Restart {
            self.turn(state);
        }
        self.forget();
        effect
    }

    /// Velocities behind a kink of what time prescribes, as of the law of a driver: only the rows have impulses there, so that of all
    /// v = P v_i + p₀ with the new p₀ it is the one nearest to the velocities before in the metric of the mass,
    ///
    /// ```text
    /// PᵀM P v_i = PᵀM (v − p₀)
    /// ```
    ///
    /// Where p₀ does not jump, and where a motion has no inertia, v_i stays as it is.
    fn turn(&mut self, state: &mut State) {
        let (before, v) = (self.drift.clone(), self.state.v.clone());
        self.forget();
        if !self.reach(state.at()) {
            return;
        }
        let largest = before.iter().chain(&self.drift).fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if self.drift.iter().zip(&before).all(|(now, before)| (now - before).abs() <= KINK * largest) {
            return;
        }
        let (n, nv) = (state.v.len(), v.len());
        let apart: Vec<f64> = v.iter().zip(&self.drift).map(|(v, p)| v - p).collect();
        let (mut momenta, mut product, mut mass, mut of_independent) =
            (vec![0.0; nv], vec![0.0; nv * n], vec![0.0; n * n], DVector::zeros(n));
        times(self.terms.mass.lines(), &apart, &mut momenta);
        combine(&momenta, &self.p, of_independent.as_mut_slice());
        congruent(&self.terms.mass, &self.p, n, &mut product, &mut mass);
        if let Some(factors) = DMatrix::from_vec(n, n, mass).cholesky() {
            state.v.copy_from_slice(factors.solve(&of_independent).as_slice());
        }
    }
}
