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
//! of the states that act on a force, by themselves or through others; what only records, or counts on, need not rest. Sums of states
//! that no motion changes stay as they are: δz = B w, with the columns of B those of Z_q P and Z_z, and w is what is sought.

use super::pose::Pose;
use super::rest::{Position, Rest, norm};
use super::search::{CLOSE, LONGEST, STEPS};
use crate::geometry::Space;
use crate::numerics::least_squares::shortest;
use grashof_solvers::System;
use nalgebra::{DMatrix, DVector};

/// Part of a state by which it may change in a second and still rest, and round-off of a rate in what it is made of.
const RESTS: f64 = 1e-9;
const ROUND_OFF: f64 = 1e-11;
/// Halvings of a step.
const HALVINGS: i32 = 8;

/// The linear equations of position and states at a pose, each divided by its largest coefficient.
struct Together {
    /// States that act, by index, and the ways on which motions lead them (states × ways).
    states: Vec<usize>,
    ways: DMatrix<f64>,
    /// Coefficients, row after row, and right sides.
    rows: Vec<f64>,
    right: Vec<f64>,
    /// Largest coefficient of each row, by which it was divided; 0 where nothing moves what it holds.
    sizes: Vec<f64>,
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Which states rest in a position.
    pub(super) fn rests(&mut self, position: &Position) -> Vec<bool> {
        self.stand_at(position);
        self.system.tangent(self.state.at(), &self.zeros, &position.lambda, &mut self.tangent);
        let Self { tangent, unit, .. } = self;
        let made_of = |i: usize| {
            let by_states: f64 = position.z.iter().enumerate().map(|(j, z)| (tangent.z_z.at(i, j) * z).abs()).sum();
            by_states + unit.iter().enumerate().map(|(j, unit)| (tangent.z_q.at(i, j) * unit).abs()).sum::<f64>()
        };
        let rests = |(i, (rate, z)): (usize, (&f64, &f64))| rate.abs() <= f64::max(RESTS * z.abs().min(1.0), ROUND_OFF * made_of(i));
        position.drift.iter().zip(&position.z).enumerate().map(rests).collect()
    }

    /// The equilibrium near a pose in which the states that act on a force rest as well; none if there is no such, or the pose is it.
    pub(super) fn with_states(&mut self, from: &Pose) -> Option<Pose> {
        if from.position.z.is_empty() || self.rests(&from.position).iter().all(|rests| *rests) {
            return None;
        }
        let mut pose = from.clone();
        for _ in 0..STEPS {
            let at = self.together(&pose)?;
            let rests = self.rests(&pose.position);
            if at.states.iter().all(|&i| rests[i]) && self.is_balanced(&pose).ok()? {
                return self.polish(pose).ok();
            }
            let step = at.step();
            let (y, ways) = step.split_at(pose.force.len());
            let (y, dz) = (DVector::from_column_slice(y), &at.ways * DVector::from_column_slice(ways));
            let long = (self.measure(&(&pose.basis * &y)) / LONGEST).max(1.0);
            let before = at.left(&pose);
            let shorter = (0..HALVINGS).find_map(|halves| {
                let part = 0.5_f64.powi(halves) / long;
                let next = self.beside(&pose, &(&y * part), &at.states, dz.as_slice(), part)?;
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
        let pick = |of: &DMatrix<f64>| of.select_rows(&states);
        // of a length of 1 each, since states have units of all sizes
        let mut ways: Vec<DVector<f64>> = pick(&rates).column_iter().chain(pick(&z_z).column_iter()).map(|way| way.into_owned()).collect();
        ways.retain(|way| way.norm() > 0.0);
        ways.iter_mut().for_each(|way| *way /= way.norm());
        let ways = if ways.is_empty() { DMatrix::zeros(states.len(), 0) } else { DMatrix::from_columns(&ways) };
        let by_ways = |of: &DMatrix<f64>| of.select_columns(&states) * &ways;
        let (forces, slopes) = (by_ways(&forces), by_ways(&z_z));
        let mut at = Together { states, ways, rows: Vec::new(), right: Vec::new(), sizes: Vec::new() };
        for i in 0..n {
            at.add(stiffness.row(i).iter().chain(forces.row(i).iter()).copied().collect(), pose.force[i]);
        }
        for i in at.states.clone() {
            at.add(rates.row(i).iter().chain(slopes.row(i).iter()).copied().collect(), -pose.position.drift[i]);
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

    /// Newton's step: y, then the lengths of the ways of the states.
    fn step(&self) -> Vec<f64> {
        let unknowns = self.rows.len() / self.right.len();
        shortest(&self.rows, &self.right, &vec![1.0; unknowns], 0.0)
    }

    /// What is left of the equations at a pose, in the units of these rows.
    fn left(&self, pose: &Pose) -> f64 {
        let rates = self.states.iter().map(|&i| pose.position.drift[i]);
        let all = pose.force.iter().copied().chain(rates).zip(&self.sizes);
        norm(&all.map(|(left, size)| if *size > 0.0 { left / size } else { 0.0 }).collect::<Vec<f64>>())
    }
}
