//! Blows: jumps of velocities along rows.
//!
//! ```text
//! [ M   Gᵀ ] [ y_i ]   [ rowᵢᵀ ]
//! [ G  −E  ] [  Λ  ] = [   0   ],     v⁺ = v + Σ p_i y_i,     Σ_k (rowᵢ·y_k) p_k = −(1 + e_i) rowᵢ·v
//! ```
//!
//! so that each of several stops that are hit at one instant is left with its own restitution, and nothing depends on their order.
//!
//! A rate u that never becomes negative, as the slip of a one-way clutch, does not do so within a blow either. A blow takes a short time;
//! in each part of it stops and such rates only push, along a rate u of theirs with the impulse dp, so that
//!
//! ```text
//! u = u⁻ + A p,   A_ik = rowᵢ·y_k,   dp ≥ 0,   clutch: u ≥ 0,  u dp = 0
//! ```
//!
//! Stops are compressed until they are approached no more: p_c ≥ 0, u_c = u⁻ + A p_c ≥ 0, u_cᵀp_c = 0, which are the velocities nearest to
//! those before, in the metric M. Then each gives back e_i p_c,i (Poisson), while what a clutch has to carry, with a restitution of
//! zero, follows from u ≥ 0 once more:
//!
//! ```text
//! p = (I + E) p_c + p_r,   p_r ≥ 0,   u⁺ = u_c + A (E p_c + p_r) ≥ 0,   u⁺ᵀp_r = 0
//! ```
//!
//! (Pfeiffer and Glocker, Multibody Dynamics with Unilateral Contacts, 1996, chapter 8). A clutch that is closed before (u⁻ = 0) and carries
//! is a rigid link at the blow: both phases have the same ratio of impulses, and u⁺ = −e u⁻ of the stop. One that carries nothing changes
//! nothing. No energy is gained: p_cᵀu_c = 0, so that the compression takes ½ p_cᵀA p_c, and with the largest restitution e at most e² of
//! it comes back, since p_r leaves the least kinetic energy that any p_r ≥ 0 leaves, and (e − E) p_c is one of these. [Rejected: Newton's
//! u⁺ = −e u⁻ for stops beside a clutch that is open before: a heavy side of a clutch at rest would be thrown as fast as the light one
//! that strikes, which gains energy. One blow after the other: where a closed clutch presses on a stop they follow without end.]

use super::{Engine, Why};
use crate::{Stage, State, System};
use nalgebra::{DMatrix, DVector};

/// Part of the largest pivot below which blows of one instant are along dependent rows.
const DEPENDENT: f64 = 1e-9;

/// Part of its mobility without constraints below which a joint cannot give way to a blow.
const HELD: f64 = 1e-6;

/// Part of the speeds of a blow that counts as none.
const ROUNDED: f64 = 1e-12;

/// A blow that is to come.
#[derive(Clone, Debug)]
pub struct Blow {
    /// The root that was crossed.
    pub root: usize,
    /// The direction along which velocities jump (nv).
    pub row: Vec<f64>,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// The part of the rate that time prescribes, if it is one that does not become negative; else the blow is that of a stop.
    pub closing: Option<f64>,
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
    pub fn impulses(&mut self, system: &mut dyn System, state: &mut State, blows: &[Blow]) -> Result<Option<usize>, Why> {
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

    /// The velocities behind blows of stops together with rates that do not become negative.
    ///
    /// Returns the root of a blow that the constraints hold.
    ///
    /// # Errors
    /// If the KKT matrix is singular.
    pub(crate) fn pass_on(&mut self, system: &mut dyn System, state: &mut State, blows: &[Blow]) -> Result<Option<usize>, Why> {
        self.evaluate(system, state.at(), Stage::Dynamics);
        self.factor()?;
        let n = blows.len();
        let (mut responses, mut senses, mut rates) = (Vec::with_capacity(n), Vec::with_capacity(n), DVector::zeros(n));
        for (i, blow) in blows.iter().enumerate() {
            let swept = dot(&blow.row, &state.v);
            senses.push(if blow.closing.is_none() && swept > 0.0 { -1.0 } else { 1.0 });
            rates[i] = senses[i] * (swept + blow.closing.unwrap_or(0.0));
            if !self.responds(&blow.row) {
                if blow.closing.is_none() {
                    return Ok(Some(blow.root));
                }
                // nothing changes it
                rates[i] = 0.0;
                self.delta.fill(0.0);
            }
            responses.push(self.delta.clone());
        }
        let changes = DMatrix::from_fn(n, n, |i, k| senses[i] * senses[k] * dot(&blows[i].row, &responses[k]));
        let restitution = |blow: &Blow| if blow.closing.is_some() { 0.0 } else { blow.restitution };
        let restitutions = DVector::from_iterator(n, blows.iter().map(restitution));
        // no impulses keep all rates from being negative
        let Some(impulses) = both_phases(&changes, &rates, &restitutions) else { return Ok(blows.first().map(|blow| blow.root)) };
        for ((y, sense), p) in responses.iter().zip(&senses).zip(&impulses) {
            state.v.iter_mut().zip(y).for_each(|(v, y)| *v += sense * p * y);
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

/// The impulses of compression and restitution along rates u⁻ that change by A p; none where they cannot all stop being negative.
fn both_phases(a: &DMatrix<f64>, u: &DVector<f64>, restitutions: &DVector<f64>) -> Option<DVector<f64>> {
    let compression = complementary(a, u)?;
    let pushed = compression.component_mul(restitutions) + compression;
    Some(complementary(a, &(u + a * &pushed))? + pushed)
}

/// p ≥ 0 with u = A p + b ≥ 0 and uᵀp = 0 for a symmetric, positive semidefinite A, by active sets (Lawson & Hanson 1974, chapter 23);
/// none where there is none. What pushes stays independent, so that dependent rates need nothing added to A. [Rejected: boxes, as friction
/// needs them, with principal pivoting, which leaves dependent impulses to a diagonal that is larger by 1e-7.]
fn complementary(a: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    let n = b.len();
    // rates of the same kinetic energy are comparable
    let root = |i: usize| a[(i, i)].sqrt();
    let speed = (0..n).filter(|i| a[(*i, *i)] > 0.0).map(|i| b[i].abs() / root(i)).fold(0.0, f64::max);
    let (mut p, mut pushing): (DVector<f64>, Vec<usize>) = (DVector::zeros(n), Vec::new());
    for _ in 0..10 * n {
        let u = a * &p + b;
        let negative = (0..n).filter(|i| !pushing.contains(i) && u[*i] < -ROUNDED * speed * root(*i));
        let Some(worst) = negative.min_by(|i, k| (u[*i] / root(*i)).total_cmp(&(u[*k] / root(*k)))) else { return Some(p) };
        pushing.push(worst);
        loop {
            let lu = DMatrix::from_fn(pushing.len(), pushing.len(), |i, k| a[(pushing[i], pushing[k])]).full_piv_lu();
            let pivots = lu.u().diagonal();
            if pivots.amin() < DEPENDENT * pivots.amax() {
                return None;
            }
            let to = lu.solve(&DVector::from_iterator(pushing.len(), pushing.iter().map(|i| -b[*i])))?;
            let part = pushing.iter().zip(&to).filter(|(_, to)| **to <= 0.0).map(|(i, to)| p[*i] / (p[*i] - to)).fold(1.0, f64::min);
            pushing.iter().zip(&to).for_each(|(i, to)| p[*i] += part * (to - p[*i]));
            if part == 1.0 {
                break;
            }
            let least = pushing.iter().copied().min_by(|i, k| p[*i].total_cmp(&p[*k]))?;
            p[least] = 0.0;
            pushing.retain(|i| *i != least);
            if pushing.is_empty() {
                break;
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impulses_push_and_leave_no_negative_rate_and_gain_no_energy() {
        let mut seed = 3_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        for case in 0..2000 {
            // rates u = W v of a system with M = 1
            let (n, nv) = (1 + case % 6, 6);
            let w = DMatrix::from_fn(n, nv, |_, _| random());
            let (a, v) = (&w * w.transpose(), DVector::from_fn(nv, |_, _| random()));
            let u = &w * &v;
            let p = complementary(&a, &u).unwrap_or_else(|| panic!("case {case}"));
            let compressed = &u + &a * &p;
            for (p, u) in p.iter().zip(&compressed) {
                assert!(*p >= 0.0 && *u > -1e-9 && (p * u).abs() < 1e-9, "case {case}: {p} {u}");
            }
            let e = DVector::from_fn(n, |i, _| if i % 2 == 0 { 0.5 + 0.5 * random() } else { 0.0 });
            let p = both_phases(&a, &u, &e).unwrap_or_else(|| panic!("case {case}"));
            let after = &v + w.transpose() * &p;
            assert!(p.min() >= 0.0 && (&w * &after).min() > -1e-9 && after.norm() < v.norm() * (1.0 + 1e-12), "case {case}: {p}");
        }
    }

    #[test]
    fn dependent_rates_have_impulses_unless_they_contradict_each_other() {
        let a = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, 1.0]);
        assert_eq!(complementary(&a, &DVector::from_row_slice(&[-1.0, -2.0])), Some(DVector::from_row_slice(&[0.0, 2.0])));
        let a = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
        assert_eq!(complementary(&a, &DVector::from_row_slice(&[-1.0, 0.5])), None);
    }
}
