//! Blows: jumps of velocities along rows.
//!
//! ```text
//! [ M   Gᵀ ] [ y_i ]   [ rowᵢᵀ ]
//! [ G  −E  ] [  Λ  ] = [   0   ],     v⁺ = v + Σ p_i y_i,     Σ_k (rowᵢ·y_k) p_k = −(1 + e_i) rowᵢ·v
//! ```
//!
//! so that each of several stops that are hit at one instant is left with its own restitution, and nothing depends on their order.

use super::{Engine, Why};
use crate::{Stage, State, System};
use nalgebra::{DMatrix, DVector};

/// Part of the largest pivot below which blows of one instant are along dependent rows.
const DEPENDENT: f64 = 1e-9;

/// Part of its mobility without constraints below which a joint cannot give way to a blow.
const HELD: f64 = 1e-6;

/// A blow that is to come.
#[derive(Clone, Debug)]
pub(crate) struct Blow {
    /// The root that was crossed.
    pub(crate) root: usize,
    /// The direction along which velocities jump (nv).
    pub(crate) row: Vec<f64>,
    /// Coefficient of restitution.
    pub(crate) restitution: f64,
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

impl Engine {
    /// The velocities behind an impulse along `row` (nv): row·v⁺ = −restitution row·v⁻.
    ///
    /// False if the constraints hold row·v, as a driver does, so that no impulse changes it.
    ///
    /// # Errors
    /// If the KKT matrix is singular.
    pub fn impulse(&mut self, system: &mut dyn System, state: &mut State, row: &[f64], restitution: f64) -> Result<bool, Why> {
        self.evaluate(system, state.at(), Stage::Dynamics);
        self.factor()?;
        if !self.responds(row) {
            return Ok(false);
        }
        let p = -(1.0 + restitution) * dot(row, &state.v) / dot(row, &self.delta);
        if !p.is_finite() {
            return Err(Why::Singular);
        }
        state.v.iter_mut().zip(&self.delta).for_each(|(v, d)| *v += p * d);
        Ok(true)
    }

    /// The velocities behind all blows of one instant. Where one of them would pull, or two are the same blow, they come one after the
    /// other, without those that have been thrown back by the ones before.
    ///
    /// Returns the root of a blow that the constraints hold, as in [`Engine::impulse`].
    ///
    /// # Errors
    /// If the KKT matrix is singular.
    pub(crate) fn impulses(&mut self, system: &mut dyn System, state: &mut State, blows: &[Blow]) -> Result<Option<usize>, Why> {
        if blows.len() > 1 && self.together(system, state, blows)? {
            return Ok(None);
        }
        let before: Vec<f64> = blows.iter().map(|blow| dot(&blow.row, &state.v)).collect();
        for (blow, before) in blows.iter().zip(before) {
            if dot(&blow.row, &state.v) * before >= 0.0 && !self.impulse(system, state, &blow.row, blow.restitution)? {
                return Ok(Some(blow.root));
            }
        }
        Ok(None)
    }

    /// Blows of one instant that determine each other; whether they do.
    fn together(&mut self, system: &mut dyn System, state: &mut State, blows: &[Blow]) -> Result<bool, Why> {
        self.evaluate(system, state.at(), Stage::Dynamics);
        self.factor()?;
        let mut responses = Vec::with_capacity(blows.len());
        for blow in blows {
            if !self.responds(&blow.row) {
                return Ok(false);
            }
            responses.push(self.delta.clone());
        }
        let changes = DMatrix::from_fn(blows.len(), blows.len(), |i, k| dot(&blows[i].row, &responses[k]));
        let wanted = DVector::from_iterator(blows.len(), blows.iter().map(|blow| -(1.0 + blow.restitution) * dot(&blow.row, &state.v)));
        let lu = changes.full_piv_lu();
        let pivots = lu.u().diagonal();
        if pivots.amin() < DEPENDENT * pivots.amax() {
            return Ok(false);
        }
        let Some(impulses) = lu.solve(&wanted) else { return Ok(false) };
        if impulses.iter().zip(&wanted).any(|(p, wanted)| !p.is_finite() || p * wanted < 0.0) {
            return Ok(false);
        }
        for (y, p) in responses.iter().zip(&impulses) {
            state.v.iter_mut().zip(y).for_each(|(v, y)| *v += p * y);
        }
        Ok(true)
    }

    /// The response to a unit impulse along a row, into `delta`; whether the constraints leave it one.
    fn responds(&mut self, row: &[f64]) -> bool {
        self.rhs.fill(0.0);
        self.kkt.solve(row, &self.rhs, &mut self.delta, &mut self.mu);
        let free = |(i, r): (usize, &f64)| match self.terms.mass.at(i, i) {
            m if m > 0.0 => r * r / m,
            _ => 0.0,
        };
        let free: f64 = row.iter().enumerate().map(free).sum();
        dot(row, &self.delta) >= HELD * free
    }
}
