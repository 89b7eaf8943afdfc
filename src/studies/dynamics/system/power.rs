//! Powers that change the energy of a mechanism, by what puts them in or takes them.

use super::Mechanical;
use crate::geometry::Space;
use crate::mechanism::EffortLaw;
use grashof_solvers::At;

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Power of drivers and of all else that moves with time, −λᵀν for rows; of loads and motors; of dampers; of end stops beside what
    /// they store: what changes the energy, W.
    pub(super) fn powers(&mut self, at: &At<'_>, lambda: &[f64], w: &mut [f64]) {
        self.motion(at);
        self.loads(at);
        self.dynamics.apply_friction(lambda);
        let m = self.dynamics.mechanism;
        self.modes.copy_from_slice(&at.modes[..m.switches + m.windings]);
        let by_springs: f64 = (0..m.stretches.len()).map(|spring| self.dynamics.spring_power(spring, &self.modes)).sum();
        let work = &self.dynamics.work;
        w[0] = by_springs - work.nu.iter().zip(lambda).map(|(nu, l)| nu * l).sum::<f64>();
        w[1..].fill(0.0);
        // what is applied to bodies is gravity and loads at points
        for node in m.nodes.iter().filter(|_| !m.point_loads.is_empty()) {
            let gravity = G::dot(m.gravity, work.twists[node.body].v) * work.inertias[node.body].m
                + G::dot(m.gravity, G::turn(work.twists[node.body].w, work.inertias[node.body].h));
            w[1] += work.applied[node.body].power(work.twists[node.body]) - gravity;
        }
        w[1] -= self.dynamics.field_power();
        for (i, (effort, size)) in m.efforts.iter().zip(&work.efforts).enumerate() {
            let rate = self.dynamics.extent_rate(effort.along);
            match effort.law {
                EffortLaw::Drive { .. } if m.buffers.iter().any(|buffer| buffer.effort == i) => {}
                EffortLaw::Linear { damping, .. } => w[2] -= damping * rate * rate,
                EffortLaw::Law { spring, output, .. } => {
                    w[2] -= work.force_outputs[output + 1] * self.dynamics.stretch_rate(spring).powi(2)
                }
                EffortLaw::Drive { .. } => w[1] += size * rate,
                EffortLaw::Friction { .. } => w[2] += size * rate,
            }
        }
        for [done, stored] in self.dynamics.buffer_powers() {
            w[3] += done + stored;
        }
    }
}
