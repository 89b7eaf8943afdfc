//! Motions that a position leaves to second order: where rows lose rank, a direction that they leave need not begin a motion.
//!
//! With l the combinations of rows that vanish, lᵀG = 0, a velocity v with G v = 0 has an acceleration only where lᵀγ(v) = 0. γ is
//! quadratic, so that these v make a cone (Lerbet & Hao, Mechanism and Machine Theory 34 (1999) 1055-1069: the tangent cone of second
//! order). Its parts are the branches of the motion: lines where one freedom is left, 2^N of them in a row of N four-bars, else spaces,
//! or one cone that is curved. Where rows are redundant everywhere lᵀγ(v) = 0 says nothing.
//!
//! Parts are found by Newton's method from places on the unit sphere that are made by a fixed rule, until many more have found
//! nothing new.

use super::close::System;
use super::shake::Shake;
use crate::geometry::Space;
use crate::numerics::least_squares::{Redundant, Rows, are_independent, left_open};
use grashof_solvers::svd::Svd;
use nalgebra::{DMatrix, DVector};

/// Equations of second order below this part of a rotation's own say nothing.
const NOTHING: f64 = 1e-7;

/// What is left of a row that depends on others, and phases of the velocities that say whether it does so everywhere.
const VANISHING: f64 = 1e-9;
const PHASES: [f64; 3] = [0.0, 1.0, 2.0];

/// Most parts that are looked for: those of a row of six four-bars.
pub(super) const MOST: usize = 64;

/// Trials without a new part before the search ends, and how many more for each part.
const TRIALS: [usize; 2] = [40, 20];

/// Velocities of the rows but those of drivers, to second order.
pub(super) struct Cone {
    /// Velocities that the rows leave (nv × k), orthonormal in the metric.
    pub(super) open: DMatrix<f64>,
    /// F of xᵀF x = 0 with v = open·x (k × k each), orthonormal.
    forms: Vec<DMatrix<f64>>,
}

/// A part of a cone.
pub(super) enum Part {
    /// Velocities (nv × f, orthonormal in the metric) all of whose combinations are possible.
    Flat(DMatrix<f64>),
    /// Part of a cone that is no space.
    Curved,
}

impl<G: Space<S = f64>> System<'_, G> {
    /// The cone at the position evaluated last, if there equations of second order hold that do not hold everywhere.
    pub(super) fn cone(&mut self, q: &[f64]) -> Option<Cone> {
        let m = self.dynamics.mechanism;
        let rows = self.undriven();
        let mut at = |v: &[f64]| {
            let gamma = self.gamma(q, v);
            DVector::from_iterator(rows.len(), rows.iter().map(|&r| gamma[r]))
        };
        // constraints that depend on time are no cone
        let still = at(&vec![0.0; m.nv]).amax();
        if rows.is_empty() || still > 0.0 || rows.iter().any(|&r| self.dynamics.work.nu[r] != 0.0) {
            return None;
        }
        let (a, round_off) = self.scaled(&rows);
        // no combination of rows vanishes
        if are_independent(&a, &self.metric, round_off) {
            return None;
        }
        if self.are_redundant_everywhere(q, &rows, &a, round_off) {
            return None;
        }
        let a = a.to_dense(m.nv);
        let root: Vec<f64> = self.metric.iter().map(|d| d.sqrt()).collect();
        let open = left_open(round_off, &a, &self.metric);
        let transposed: Vec<f64> =
            (0..m.nv).flat_map(|k| (0..rows.len()).map(move |i| (i, k))).map(|(i, k)| a[i * m.nv + k] / root[k]).collect();
        let vanishing = left_open(round_off, &transposed, &vec![1.0; rows.len()]);
        let k = open.ncols();
        if k == 0 || vanishing.ncols() == 0 {
            return None;
        }
        let mut at = |v: &[f64]| {
            let gamma = self.gamma(q, v);
            vanishing.transpose() * DVector::from_iterator(rows.len(), rows.iter().map(|&r| gamma[r]))
        };
        let column = |i: usize| open.column(i).into_owned();
        let single: Vec<DVector<f64>> = (0..k).map(|i| at(column(i).as_slice())).collect();
        // one row for each entry of the forms, those beside the diagonal counted for both
        let mut entries = DMatrix::zeros(vanishing.ncols(), k * (k + 1) / 2);
        for (e, (i, j)) in pairs(k).enumerate() {
            let value = if i == j { single[i].clone() } else { (at((column(i) + column(j)).as_slice()) - &single[i] - &single[j]) * 0.5 };
            entries.set_column(e, &(value * if i == j { 1.0 } else { std::f64::consts::SQRT_2 }));
        }
        let svd = Svd::new(&entries);
        let form = |s: usize| {
            let mut form = DMatrix::zeros(k, k);
            for (e, (i, j)) in pairs(k).enumerate() {
                form[(i, j)] = svd.v[(e, s)] * if i == j { 1.0 } else { std::f64::consts::FRAC_1_SQRT_2 };
                form[(j, i)] = form[(i, j)];
            }
            form
        };
        let forms: Vec<DMatrix<f64>> = (0..svd.values.len()).filter(|&s| svd.values[s] > NOTHING).map(form).collect();
        (!forms.is_empty()).then_some(Cone { open, forms })
    }

    /// Whether the rows A that depend on others say nothing to second order, of many velocities: none of lᵀγ has a value at velocities in
    /// no special direction. False where that cannot be told so.
    fn are_redundant_everywhere(&mut self, q: &[f64], rows: &[usize], a: &Rows, round_off: f64) -> bool {
        let Some(redundant) = Redundant::new(a, &self.metric, VANISHING) else { return false };
        are_independent(redundant.independent(), &self.metric, round_off)
            && PHASES.into_iter().all(|phase| {
                let Some(v) = redundant.motion(phase) else { return true };
                let gamma = self.gamma(q, &v);
                let of_rows: Vec<f64> = rows.iter().map(|&r| gamma[r]).collect();
                redundant.largest(&of_rows) <= NOTHING
            })
    }

    /// Rows that time does not move.
    pub(super) fn undriven(&self) -> Vec<usize> {
        let m = self.dynamics.mechanism;
        (0..m.rows.len()).filter(|&r| !m.is_moved(&m.rows[r])).collect()
    }

    /// Rows in rad and sizes, and the singular value below which they are round-off.
    pub(super) fn scaled(&self, rows: &[usize]) -> (Rows, f64) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let scale = |row: usize| if m.rows[row].angular { 1.0 } else { 1.0 / self.size };
        let natural = self.dynamics.natural_length(&self.metric);
        let mut a = Rows::default();
        rows.iter().for_each(|&r| a.push(w.g.line(r).entries().map(|(k, x)| (k, x * scale(r)))));
        (a, grashof_solvers::kkt::ROUND_OFF * rows.iter().map(|&r| natural[r] * scale(r)).fold(0.0, f64::max))
    }

    /// γ in rad and sizes at a velocity.
    pub(super) fn gamma(&mut self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let modes = self.modes.clone();
        self.dynamics.velocity(v, &modes);
        self.dynamics.watch(q, v, &modes);
        let rows = self.dynamics.mechanism.rows.iter().zip(&self.dynamics.work.gamma);
        rows.map(|(row, gamma)| if row.angular { *gamma } else { gamma / self.size }).collect()
    }
}

impl Cone {
    /// Values xᵀF x and their slopes (forms × k).
    pub(super) fn values(&self, x: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let mut slopes = DMatrix::zeros(self.forms.len(), x.len());
        for (i, form) in self.forms.iter().enumerate() {
            slopes.set_row(i, &(form * x * 2.0).transpose());
        }
        (&slopes * x * 0.5, slopes)
    }

    /// The parts of the cone; none if there is no motion, or branches touch, which the second order does not tell.
    pub(super) fn parts(&self) -> Vec<Part> {
        let k = self.open.ncols();
        let mut shake = Shake(5);
        let mut found: Vec<DMatrix<f64>> = Vec::new();
        let (mut curved, mut idle) = (false, 0);
        while idle < TRIALS[0] + TRIALS[1] * found.len() && found.len() < MOST {
            idle += 1;
            let x = DVector::from_fn(k, |_, _| shake.next());
            let Some(space) = self.part_at(x.normalize()) else { continue };
            let flat = (0..4).all(|_| {
                let x = (&space * DVector::from_fn(space.ncols(), |_, _| shake.next())).normalize();
                self.values(&x).0.amax() < 1e-8
            });
            let projector = &space * space.transpose();
            if !flat {
                curved = true;
            } else if found.iter().all(|other| (other * other.transpose() - &projector).amax() > 1e-5) {
                found.push(space);
                idle = 0;
            }
        }
        let flat = found.iter().map(|space| Part::Flat(&self.open * space));
        flat.chain(curved.then_some(Part::Curved)).collect()
    }

    /// The directions (k × f) in which the cone goes on from the place next to x, if Newton's method finds one at its own speed.
    fn part_at(&self, mut x: DVector<f64>) -> Option<DMatrix<f64>> {
        for _ in 0..25 {
            let (values, slopes) = self.values(&x);
            let svd = Svd::new(&slopes);
            if values.amax() < 1e-15 {
                let padded = Svd::new(&slopes.resize_vertically(self.forms.len().max(x.len()), 0.0));
                let open: Vec<usize> = (0..padded.values.len()).filter(|&i| padded.values[i] < 1e-6).collect();
                return (open.len() < x.len()).then(|| DMatrix::from_fn(x.len(), open.len(), |i, k| padded.v[(i, open[k])]));
            }
            let least = 1e-9 * svd.largest();
            let way = DVector::from_vec(svd.solve(values.as_slice(), |s| if s > least { 1.0 / s } else { 0.0 }));
            let length = way.norm();
            x = (x - way * if length > 0.5 { 0.5 / length } else { 1.0 }).normalize();
        }
        None
    }
}

/// Pairs i ≤ j of k.
fn pairs(k: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..k).flat_map(move |i| (i..k).map(move |j| (i, j)))
}
