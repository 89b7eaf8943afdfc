//! First-order states that rest in one position alone: an integrating controller moves the mechanism until its state does not change.
//!
//! Where ż does not depend on z enough to vanish in every position, position and states are sought together, by Newton's method on
//! (symbols of `pose`)
//!
//! ```text
//! | Pᵀ K P   Pᵀ R_z | | y  |   |  h |
//! | Z_q P    Z_z    | | δz | = | −ż |
//! ```
//!
//! of the states that act on a force, by themselves or through others; what only records, or counts on, need not rest.

use super::pose::Pose;
use super::rest::{Rest, norm};
use super::search::{CLOSE, LONGEST, STEPS};
use crate::geometry::Space;
use crate::numerics::least_squares::shortest;
use grashof_solvers::System;
use nalgebra::{DMatrix, DVector};

/// A rate below which a state rests, in its unit per second.
pub(super) const RESTS: f64 = 1e-9;
/// Halvings of a step.
const HALVINGS: i32 = 8;

/// The linear equations of position and states at a pose, each divided by its largest coefficient.
struct Together {
    /// States that act, by index.
    states: Vec<usize>,
    /// Coefficients, row after row, and right sides.
    rows: Vec<f64>,
    right: Vec<f64>,
    /// What each row was divided by, and the largest one, 0 where nothing moves it.
    sizes: Vec<f64>,
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// The equilibrium near a pose in which the states that act on a force rest as well; none if there is no such, or the pose is it.
    pub(super) fn with_states(&mut self, from: &Pose) -> Option<Pose> {
        if from.position.drift.iter().all(|rate| rate.abs() <= RESTS) {
            return None;
        }
        let mut pose = from.clone();
        for _ in 0..STEPS {
            let at = self.together(&pose)?;
            if at.states.iter().all(|&i| pose.position.drift[i].abs() <= RESTS) && self.is_balanced(&pose).ok()? {
                return self.polish(pose).ok();
            }
            let step = at.step(&pose);
            let (y, dz) = step.split_at(pose.force.len());
            let y = DVector::from_column_slice(y);
            let long = (self.measure(&(&pose.basis * &y)) / LONGEST).max(1.0);
            let before = at.left(&pose);
            let shorter = (0..HALVINGS).find_map(|halves| {
                let part = 0.5_f64.powi(halves) / long;
                let next = self.beside(&pose, &(&y * part), &at.states, dz, part)?;
                (at.left(&next) < before).then_some(next)
            });
            match shorter {
                Some(next) => pose = next,
                // at round-off
                None if before <= CLOSE => return Some(pose),
                None => return None,
            }
        }
        None
    }

    /// The pose behind a part of a step of position and states.
    fn beside(&mut self, pose: &Pose, y: &DVector<f64>, states: &[usize], dz: &[f64], part: f64) -> Option<Pose> {
        let mut from = pose.clone();
        for (&i, dz) in states.iter().zip(dz) {
            from.position.z[i] += part * dz;
        }
        let delta = &pose.basis * y;
        self.moved(&from, delta.as_slice()).ok()
    }

    /// The equations at a pose; none if no state acts.
    fn together(&mut self, pose: &Pose) -> Option<Together> {
        self.stand_at(&pose.position);
        self.system.tangent(self.state.at(), &self.zeros, &pose.position.lambda, &mut self.tangent);
        let (nv, nz) = (self.zeros.len(), pose.position.z.len());
        let block = |rows, columns, values: Vec<f64>| DMatrix::from_row_slice(rows, columns, &values);
        let (k, r_z) = (block(nv, nv, self.tangent.k.to_dense()), block(nv, nz, self.tangent.r_z.to_dense()));
        let (z_q, z_z) = (block(nz, nv, self.tangent.z_q.to_dense()), block(nz, nz, self.tangent.z_z.to_dense()));
        let transposed = pose.basis.transpose();
        let (stiffness, forces, rates) = (&transposed * k * &pose.basis, transposed * r_z, z_q * &pose.basis);
        let mut acts: Vec<bool> = (0..nz).map(|j| forces.column(j).iter().any(|x| *x != 0.0)).collect();
        // what acts on a state that acts
        for _ in 0..nz {
            for j in 0..nz {
                acts[j] = acts[j] || (0..nz).any(|i| acts[i] && z_z[(i, j)] != 0.0);
            }
        }
        let states: Vec<usize> = (0..nz).filter(|&j| acts[j]).collect();
        if states.is_empty() {
            return None;
        }
        let n = pose.force.len();
        let mut at = Together { states, rows: Vec::new(), right: Vec::new(), sizes: Vec::new() };
        for i in 0..n {
            let row = stiffness.row(i).iter().copied().chain(at.states.iter().map(|&j| forces[(i, j)])).collect();
            at.add(row, pose.force[i]);
        }
        for i in at.states.clone() {
            let row = rates.row(i).iter().copied().chain(at.states.iter().map(|&j| z_z[(i, j)])).collect();
            at.add(row, -pose.position.drift[i]);
        }
        Some(at)
    }
}

impl Together {
    fn add(&mut self, row: Vec<f64>, right: f64) {
        let size = row.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
        let by = if size > 0.0 { size } else { 1.0 };
        self.rows.extend(row.iter().map(|x| x / by));
        self.right.push(if size > 0.0 { right / by } else { 0.0 });
        self.sizes.push(size);
    }

    /// Newton's step: y, then the changes of the states that act.
    fn step(&self, pose: &Pose) -> Vec<f64> {
        let states = self.states.iter().map(|&i| (1.0 + pose.position.z[i].abs()).powi(-2));
        let metric: Vec<f64> = std::iter::repeat_n(1.0, pose.force.len()).chain(states).collect();
        shortest(&self.rows, &self.right, &metric, 0.0)
    }

    /// What is left of the equations at a pose, in the units of these rows.
    fn left(&self, pose: &Pose) -> f64 {
        let rates = self.states.iter().map(|&i| pose.position.drift[i]);
        let all = pose.force.iter().copied().chain(rates).zip(&self.sizes);
        norm(&all.map(|(left, size)| if *size > 0.0 { left / size } else { 0.0 }).collect::<Vec<f64>>())
    }
}
