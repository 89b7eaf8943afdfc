//! Sizes of what acts, whatever of it cancels: what the round-off of forces in balance is a part of.

use super::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{EffortLaw, StretchOf};

impl<G: Space<S = f64>> Dynamics<'_, G> {
    /// Moment about the reference point, N m, and force, N, of the weight of each body and the loads on it, each by its size; after
    /// [`Dynamics::forces`]. Allocates.
    #[must_use]
    pub fn pulls(&self) -> Vec<[f64; 2]> {
        let (m, w) = (self.mechanism, &self.work);
        let mut pulls = vec![[0.0; 2]; m.bodies.len()];
        for node in &m.nodes {
            let (inertia, n) = (w.inertias[node.body], G::moment(w.inertias[node.body].h, m.gravity));
            pulls[node.body] = [G::dot_spin(n, n).sqrt(), G::dot(m.gravity, m.gravity).sqrt() * inertia.m];
        }
        let length = |outputs: &[usize]| outputs.iter().map(|k| w.force_outputs[*k].powi(2)).sum::<f64>().sqrt();
        for load in &m.point_loads {
            let (at, force) = (w.places[load.body].point(load.at), length(&load.force));
            pulls[load.body][0] += force * G::dot(at, at).sqrt() + length(&load.torque);
            pulls[load.body][1] += force;
        }
        pulls
    }

    /// What an effort is the sum of, N or N m; after [`Dynamics::forces`].
    #[must_use]
    pub fn effort_parts(&self, effort: usize) -> f64 {
        let (of, size) = (&self.mechanism.efforts[effort], self.work.efforts[effort].abs());
        match of.law {
            EffortLaw::Linear { stiffness, rest, .. } => size + stiffness.abs() * (self.extent(of.along).abs() + rest.abs()),
            _ => size,
        }
    }

    /// Work of all weights, loads and efforts on whole ways, 1 rad or `size`, m: J; after [`Dynamics::forces`].
    #[must_use]
    pub fn acting(&self, size: f64) -> f64 {
        let m = self.mechanism;
        let way = |gauge: usize| if m.gauges[gauge].turns() { 1.0 } else { size };
        let ways = |along: StretchOf| match along {
            StretchOf::Gauge(gauge) => way(gauge),
            StretchOf::Function(f) => {
                let slopes = &self.work.functions[m.functions[f].value + 1..];
                m.functions[f].gauges.iter().zip(slopes).map(|(gauge, slope)| slope.abs() * way(*gauge)).sum()
            }
        };
        let efforts = m.efforts.iter().enumerate().map(|(i, effort)| self.effort_parts(i) * ways(effort.along));
        let loads = self.pulls().into_iter().map(|[_, force]| force * size);
        let torques = m.point_loads.iter().flat_map(|load| &load.torque).map(|k| self.work.force_outputs[*k].abs());
        efforts.chain(loads).chain(torques).sum()
    }
}
