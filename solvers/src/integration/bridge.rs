//! Bridges over singular positions: explicit steps where implicit ones cannot go.
//!
//! Where rows lose rank, noise ε of the constraints becomes noise εω/σ² of implicit velocities, and a shorter step makes it worse.
//! Explicit steps with the regularised KKT system and projection after each pass such a place; σ is the smallest singular value of
//! diag(G D⁻¹ Gᵀ)^−½ G D^−½ that is not zero all along ([`Sigma`]) and counts in parts of the largest one that the run has seen.

use super::{Integration, REMEMBERED};
use crate::engine::Why;
use crate::{Sigma, System};

impl Integration {
    /// How near the rows are to dependence at the node: σ in parts of the largest one seen, and the rows that have the greatest
    /// part in it, the greatest first. For messages: this costs a factorisation.
    pub fn dependence(&mut self, system: &mut dyn System) -> (f64, Vec<usize>) {
        let mut weakest = Sigma::new(self.engine.dims.rows());
        weakest.restart(&self.engine);
        let there = self.engine.accelerate(system, &mut self.node).is_ok();
        let sigma = if there { weakest.follow(&mut self.engine, 4) } else { f64::INFINITY };
        let part = weakest.row(&self.engine);
        let largest = part.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
        let mut rows: Vec<usize> = (0..part.len()).filter(|&i| part[i].abs() > 0.02 * largest).collect();
        rows.sort_by(|&i, &j| part[j].abs().total_cmp(&part[i].abs()));
        (sigma / self.largest_sigma, rows)
    }

    /// σ below which implicit steps are no longer trusted: noise ε of the constraints becomes noise εω/σ² in the velocities.
    pub(super) fn bridge_at(&self) -> f64 {
        (1e-6 / self.engine.tolerance().sqrt()).clamp(1e-3, 0.1) * self.largest_sigma
    }

    /// Hands over to explicit steps, which cross a singular position by the regularised KKT system; false if they are at work.
    pub(super) fn begins_bridge(&mut self, system: &mut dyn System, h: f64, near: bool) -> Result<bool, Why> {
        let Some(bridge) = &mut self.bridge else { return Ok(false) };
        if !near || self.bridging.is_some() {
            return Ok(false);
        }
        self.engine.counts.bridges += 1;
        if self.bridged.len() < REMEMBERED {
            self.bridged.push(self.node.state.t);
        }
        bridge.restart(system, &mut self.engine, &self.node, 4.0 * h)?;
        let enough = (2.0 * self.sigma).clamp(self.bridge_at(), 0.2 * self.largest_sigma);
        self.bridging = Some((self.node.state.t + h, enough));
        self.h = 4.0 * h;
        Ok(true)
    }

    /// Ends a bridge behind the singular position.
    pub(super) fn end_bridge(&mut self, system: &mut dyn System) -> Result<(), Why> {
        if let Some((beyond, sigma)) = self.bridging
            && self.node.state.t >= beyond
            && self.sigma > sigma
        {
            self.interpolate(system)?;
            self.bridging = None;
            self.scheme.restart(system, &mut self.engine, &self.node, self.h)?;
        }
        Ok(())
    }
}
