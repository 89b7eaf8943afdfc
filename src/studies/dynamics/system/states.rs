//! Sizes of first-order states, in which their errors count: a charge of a microcoulomb is no error of the amperes beside it.

use super::Mechanical;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use grashof_solvers::{At, Stage, System, Tangent, Terms};

/// Time in which a state shows its size by its rate, s.
const SHOWN: f64 = 1.0;
/// Part of what the motion changes a state by in that time that round-off may be, with room for a small tolerance.
const NOISE: f64 = 1e-6;
/// What is smaller in SI units is round-off where nothing else is known.
const LEAST: f64 = 1e-18;

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Sizes of the states (nz): by where they start and how fast they change there, but no larger than 1 in SI units, and large enough for
    /// the round-off of what they follow.
    pub(super) fn sizes_of_states(&mut self, start: &Assembled) -> Vec<f64> {
        let m = self.dynamics.mechanism;
        let (starts, zeros) = (m.state_starts.clone(), vec![0.0; self.dims.v]);
        let (lambda, live) = (vec![0.0; self.dims.rows()], vec![0.0; self.dims.live]);
        let mut modes = vec![0; self.dims.modes];
        modes[..start.modes.len()].copy_from_slice(&start.modes);
        let at = At { t: 0.0, q: &start.q, v: &start.v, z: &starts, modes: &modes, live: &live };
        let (mut terms, mut tangent) = (Terms::new(self.dims, &self.pattern), Tangent::new(&self.pattern));
        self.terms(at, Stage::Dynamics, &mut terms);
        self.tangent(at, &zeros, &lambda, &mut tangent);
        let follows = |i: usize| -> f64 {
            let motion = |k: usize| {
                let size = self.pattern.size_v[k];
                (tangent.z_q.at(i, k) * size).abs() + (tangent.z_v.at(i, k) * (size + start.v[k].abs())).abs()
            };
            let states = starts.iter().enumerate().filter(|(j, _)| *j != i).map(|(j, z)| (tangent.z_z.at(i, j) * z).abs());
            (0..self.dims.v).map(motion).sum::<f64>() + states.sum::<f64>()
        };
        let size = |(i, z): (usize, &f64)| {
            let shown = z.abs().max(SHOWN * terms.zdot[i].abs());
            let size = shown.max(NOISE * SHOWN * follows(i));
            if shown > LEAST && size < 1.0 { size } else { 1.0 }
        };
        starts.iter().enumerate().map(size).collect()
    }
}
