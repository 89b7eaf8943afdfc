//! A solution on the path of a driven motion.

use super::driven::Driven;
use crate::geometry::Space;
use crate::mechanism::Measured;
use std::f64::consts::{PI, TAU};

/// A solution on the path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathPoint {
    /// Time, s.
    pub t: f64,
    /// Coordinates (nq).
    pub q: Vec<f64>,
    /// Velocities (nv).
    pub v: Vec<f64>,
    /// Accelerations (nv).
    pub a: Vec<f64>,
    /// Unwrapped angles of cut hinges, by winding number.
    pub turns: Vec<f64>,
    /// How regular the constraints are: [`Driven::regularity`].
    pub regularity: f64,
    /// Sign of det G, which changes in singular positions alone; 0 where rows are redundant.
    pub side: f64,
    /// Whether the path needs the node to keep to its branch: a longer step would lead to another one.
    pub narrow: bool,
    /// Whether a change point lies between the node before and this one.
    pub crosses: bool,
}

/// Pivot ratio below which a position counts as singular: rates would keep fewer than half of their digits.
pub const SINGULAR: f64 = 1e-7;

impl<G: Space<S = f64>> Driven<'_, G> {
    /// The solution found last as a node.
    #[must_use]
    pub fn node(&mut self, t: f64, modes: &[i32]) -> PathPoint {
        let mut turns = vec![0.0; self.dynamics.mechanism.windings];
        if !turns.is_empty() {
            self.dynamics.watch(&self.q, &self.v, modes);
            for (gauge, reading) in self.dynamics.mechanism.gauges.iter().zip(&self.dynamics.work.readings) {
                if let Measured::Turn { winding, .. } = gauge.measured {
                    turns[winding] = reading.x;
                }
            }
        }
        let (regularity, side) = (self.regularity(), self.side());
        PathPoint { t, q: self.q.clone(), v: self.v.clone(), a: self.a.clone(), turns, regularity, side, narrow: false, crosses: false }
    }

    /// Counts half turns of cut hinges at `self.q` so that their angles come nearest to `expected`, and are smooth there: those of the half
    /// turns counted jump half a turn beside them.
    pub fn wind(&mut self, modes: &mut [i32], expected: &[f64]) {
        if expected.is_empty() {
            return;
        }
        let m = self.dynamics.mechanism;
        self.dynamics.position(&self.q, modes);
        self.dynamics.watch(&self.q, &self.v, modes);
        for (gauge, reading) in m.gauges.iter().zip(&self.dynamics.work.readings) {
            if let Measured::Turn { winding, .. } = gauge.measured {
                let off = (expected[winding] - reading.x) / TAU;
                modes[m.switches + winding] = ((reading.x + TAU * off.round() - gauge.shift) / PI).round() as i32;
            }
        }
    }
}
