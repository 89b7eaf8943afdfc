//! What the unbalanced force and the stiffness of a position are made of, before they cancel: measures of their round-off.

use super::rest::{Rest, norm};
use crate::geometry::{Motion, Space};
use crate::mechanism::{EffortLaw, Step, StretchOf};
use grashof_solvers::System;

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Sizes of the forces and of the stiffnesses that act at the state evaluated last, each before anything cancels, in the metric: of all
    /// forces together, and of the stiffest velocity.
    pub(super) fn sizes(&self) -> (f64, f64) {
        let root: Vec<f64> = self.system.pattern().metric.iter().map(|d| d.sqrt()).collect();
        let (m, w) = (self.system.dynamics.mechanism, &self.system.dynamics.work);
        let mut grains = self.pulls(&root);
        let mut stiff = vec![G::dot(m.gravity, m.gravity).sqrt() / self.size; root.len()];
        // of each effort the velocities along it are few
        let (mut along, mut touched) = (vec![0.0; root.len()], Vec::new());
        for (i, effort) in m.efforts.iter().enumerate() {
            let mut add = |gauge: usize, slope: f64| {
                m.gauges[gauge].project(&w.readings[gauge], &w.columns, |k, x| {
                    along[k] += slope * x / root[k];
                    touched.push(k);
                });
            };
            match effort.along {
                StretchOf::Gauge(gauge) => add(gauge, 1.0),
                StretchOf::Function(f) => {
                    let function = &m.functions[f];
                    function.gauges.iter().enumerate().for_each(|(i, &gauge)| add(gauge, w.functions[function.value + 1 + i]));
                }
            }
            touched.sort_unstable();
            touched.dedup();
            if let EffortLaw::Linear { stiffness: k, .. } = effort.law {
                touched.iter().for_each(|&i| stiff[i] += k.abs() * along[i] * along[i]);
            }
            let size = self.system.dynamics.effort_parts(i);
            for k in touched.drain(..) {
                grains[k] += size * along[k].abs();
                along[k] = 0.0;
            }
        }
        (norm(&grains), stiff.iter().fold(0.0, |m: f64, k| m.max(*k)))
    }

    /// Sizes of the forces on bodies along each velocity (nv); `root` is D^½.
    fn pulls(&self, root: &[f64]) -> Vec<f64> {
        let (m, w) = (self.system.dynamics.mechanism, &self.system.dynamics.work);
        // a moment is the difference of larger ones, about as large as the force at the body's own distance and size; places that
        // coordinates give are rounded by these
        let far = m.steps.iter().fold(self.size, |far, step| match *step {
            Step::Axis { turns: false, q, .. } => far.max(self.state.q[q].abs()),
            _ => far,
        });
        let mut pulls = self.system.dynamics.pulls();
        for ([moment, size], place) in pulls.iter_mut().zip(&w.places) {
            *moment += *size * (G::dot(place.p, place.p).sqrt() + far);
        }
        let mut grains = vec![0.0; root.len()];
        for node in m.nodes.iter().rev() {
            let [n, f] = pulls[node.body];
            for k in node.columns.clone() {
                let Motion { w, v } = w.columns[k];
                grains[k] = (n * G::dot_spin(w, w).sqrt() + f * G::dot(v, v).sqrt()) / root[k];
            }
            let parent = &mut pulls[node.parent];
            *parent = [parent[0] + n, parent[1] + f];
        }
        grains
    }
}
