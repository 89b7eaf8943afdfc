//! Closing constraints and held start values at a position.

use super::metric::{joint_metric, norm};
use super::rotation;
use super::rotation::spin;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Mechanism, Step};
use crate::numerics::least_squares::{Rows, step};
use grashof_solvers::kkt::ROUND_OFF;
use nalgebra::Matrix3;
use std::f64::consts::TAU;

/// Turns of an angle that are counted; a start beyond them is not met, which is told.
const MOST_TURNS: f64 = 1e8;

/// Residuals of the rows that a start must satisfy: constraints, then exact values.
pub(super) struct System<'a, G: Space<S = f64>> {
    pub(super) dynamics: Dynamics<'a, G>,
    pub(super) modes: Vec<i32>,
    /// Rows asked at position level: those not anchored by the start.
    pub(super) rows: Vec<usize>,
    /// Values that rows are held at instead of 0, in rad and sizes (rows, or none).
    pub(super) ahead: Vec<f64>,
    /// Which start values must hold.
    pub(super) held: Held,
    /// Bodies that are held as they are drawn, in a search for a nearer assembly.
    pub(super) upright: Vec<Drawn>,
    /// What the start values are held at.
    pub(super) targets: Vec<Target>,
    pub(super) size: f64,
    /// Metric of the search (nv).
    pub(super) metric: Vec<f64>,
    /// What names each coordinate, by its velocity column (nv).
    pub(super) named: Vec<Option<Named>>,
}

/// Which values of `start` are rows of a closing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Held {
    Nothing,
    Exact,
    All,
}

/// What names a coordinate that needs no search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Named {
    /// Exact values.
    Exactly,
    /// Guesses, alone or beside exact values.
    ByGuess,
}

/// A body, and how it is drawn in the world.
pub(super) type Drawn = (usize, Matrix3<f64>);

/// Where a start value is to be held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    Value(f64),
    Rotation(Matrix3<f64>),
}

/// Size of residuals, in rad and sizes, at which a position is closed.
pub(super) const CONVERGED: f64 = 1e-12;

impl<'a, G: Space<S = f64>> System<'a, G> {
    pub(super) fn new(mechanism: &'a Mechanism<G>) -> Self {
        let mut dynamics = Dynamics::without_mass(mechanism);
        let mut modes = mechanism.modes();
        dynamics.follow_time(0.0, &mut modes);
        let rows = (0..mechanism.rows.len()).filter(|r| !mechanism.rows[*r].anchored).collect();
        let target = |asked: Asked, value: f64| match asked {
            Asked::Orientation(k) => Target::Rotation(Matrix3::from_fn(|i, j| mechanism.orientations[k].matrix[i][j])),
            _ => Target::Value(value),
        };
        let targets = mechanism.starts.iter().map(|s| target(s.asked, s.value)).collect();
        let (size, metric) = (mechanism.start_size(), joint_metric(mechanism));
        let named = vec![None; mechanism.nv];
        Self { dynamics, modes, rows, ahead: Vec::new(), held: Held::Exact, upright: Vec::new(), targets, size, metric, named }
    }

    pub(super) fn evaluate(&mut self, q: &[f64]) {
        let zeros = vec![0.0; self.dynamics.mechanism.nv];
        self.dynamics.position(q, &self.modes);
        self.dynamics.take_signs(q, &mut self.modes);
        self.dynamics.follow_position(&mut self.modes);
        self.dynamics.velocity(&zeros, &self.modes);
        self.dynamics.watch(q, &zeros, &self.modes);
        self.wind();
    }

    /// Turns of cut hinges are counted so that angles come nearest to what is asked of them.
    fn wind(&mut self) {
        let m = self.dynamics.mechanism;
        for start in &m.starts {
            let Asked::Gauge { gauge, order: 0 } = start.asked else { continue };
            let Measured::Turn { winding, .. } = m.gauges[gauge].measured else { continue };
            let turns = ((start.value - self.dynamics.work.readings[gauge].x) / TAU).round();
            if turns.abs() > MOST_TURNS {
                continue;
            }
            self.modes[m.switches + winding] += 2 * turns as i32;
            self.dynamics.work.readings[gauge].x += turns * TAU;
        }
    }

    /// Residual and Jacobian of constraints and held values.
    pub(super) fn hard(&self, r: &mut Vec<f64>, jacobian: &mut Rows) {
        let w = &self.dynamics.work;
        r.clear();
        jacobian.clear();
        for &row in &self.rows {
            let scale = self.row_scale(row);
            r.push(w.phi[row] * scale - self.ahead.get(row).copied().unwrap_or(0.0));
            jacobian.push(w.g.line(row).entries().map(|(k, x)| (k, x * scale)));
        }
        if self.held != Held::Nothing {
            self.asked(self.held == Held::Exact, r, Some(jacobian));
        }
        self.upright(r, jacobian);
    }

    /// Residual of start values at position level, exact ones alone or all, and its Jacobian, if that is wanted: along a chain of n
    /// bodies whose angles are asked it has n²/2 entries.
    pub(super) fn asked(&self, exact_only: bool, r: &mut Vec<f64>, mut jacobian: Option<&mut Rows>) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        for (start, target) in m.starts.iter().zip(&self.targets).filter(|(s, _)| !(exact_only && s.guess)) {
            match (start.asked, target) {
                (Asked::Gauge { gauge, order: 0 }, Target::Value(value)) => {
                    let scale = self.gauge_scale(gauge);
                    r.push((w.readings[gauge].x - value) * scale);
                    if let Some(jacobian) = &mut jacobian {
                        jacobian.push(self.slopes(gauge, scale));
                    }
                }
                (Asked::Orientation(k), Target::Rotation(wanted)) => {
                    let body = m.orientations[k].body;
                    let found = rotation::matrix::<G>(w.places[body].r);
                    let theta = rotation::vector(&(wanted.transpose() * found));
                    let slope = rotation::slope(&theta) * found.transpose();
                    r.extend(theta.iter());
                    let Some(jacobian) = &mut jacobian else { continue };
                    for i in 0..3 {
                        jacobian.push(m.road(m.bodies[body].column).map(|k| (k, (slope * spin(&w.columns[k]))[i])));
                    }
                }
                _ => {}
            }
        }
    }

    /// Slopes of a gauge by the velocities, times a scale.
    pub(super) fn slopes(&self, gauge: usize, scale: f64) -> Vec<(usize, f64)> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let mut slopes = Vec::new();
        m.gauges[gauge].project(&w.readings[gauge], &w.columns, |k, x| slopes.push((k, x * scale)));
        slopes
    }

    pub(super) fn row_scale(&self, row: usize) -> f64 {
        if self.dynamics.mechanism.rows[row].angular { 1.0 } else { 1.0 / self.size }
    }

    /// Lengths are measured by the size of the mechanism, angles by themselves.
    pub(super) fn gauge_scale(&self, gauge: usize) -> f64 {
        if self.dynamics.mechanism.gauges[gauge].turns() { 1.0 } else { 1.0 / self.size }
    }

    /// Size of the rows of `hard`, before their entries cancel, in the metric: singular values below 1e-11 of it are round-off.
    pub(super) fn round_off(&self) -> f64 {
        let m = self.dynamics.mechanism;
        let scale = |row: usize| if m.rows[row].angular { 1.0 } else { 1.0 / self.size };
        let natural = self.dynamics.natural_length(&self.metric);
        ROUND_OFF * self.rows.iter().map(|&row| natural[row] * scale(row)).fold(0.0, f64::max)
    }

    /// Closes constraints and held values; false if they stay open.
    pub(super) fn close(&mut self, q: &mut Vec<f64>) -> bool {
        let (mut r, mut jacobian) = (Vec::new(), Rows::default());
        let mut damping = 0.0;
        self.evaluate(q);
        self.hard(&mut r, &mut jacobian);
        let mut size = norm(&r);
        for _ in 0..200 {
            if size == 0.0 {
                return true;
            }
            let b: Vec<f64> = r.iter().map(|r| -r).collect();
            if size < CONVERGED.max(self.rounding(q)) {
                // one more step takes the last digits
                self.dynamics.mechanism.retract(q, &step(self.round_off(), &jacobian, &b, &self.metric, 0.0));
                self.evaluate(q);
                return true;
            }
            let delta = self.bounded(step(self.round_off(), &jacobian, &b, &self.metric, damping));
            let mut trial = q.clone();
            self.dynamics.mechanism.retract(&mut trial, &delta);
            self.evaluate(&trial);
            let (mut r_trial, mut jacobian_trial) = (Vec::new(), Rows::default());
            self.hard(&mut r_trial, &mut jacobian_trial);
            let size_trial = norm(&r_trial);
            if size_trial < size {
                // a step that gains less than a part in 10⁶ has found the smallest gap
                let stuck = size_trial > size * (1.0 - 1e-6) && size > 1e-6;
                (*q, r, jacobian, size) = (trial, r_trial, jacobian_trial, size_trial);
                damping = if damping > 1e-9 { damping / 10.0 } else { 0.0 };
                if stuck {
                    return false;
                }
            } else {
                damping = if damping == 0.0 { 1e-6 } else { damping * 10.0 };
                if damping > 1e6 {
                    return false;
                }
            }
        }
        false
    }

    /// Rounding of coordinates, in rad and sizes: after many turns it is all that counts.
    fn rounding(&self, q: &[f64]) -> f64 {
        let largest = |step: &Step<G>| match *step {
            Step::Axis { q: k, v, .. } => q[k].abs() * self.metric[v].sqrt(),
            Step::Ball { .. } => 1.0,
        };
        8.0 * f64::EPSILON * self.dynamics.mechanism.steps.iter().map(largest).fold(0.0, f64::max)
    }

    /// A step of at most half a radian or half the size of the mechanism beside a common shift of bodies, which may be as far as it likes.
    pub(super) fn bounded(&self, mut delta: Vec<f64>) -> Vec<f64> {
        let left = self.dynamics.mechanism.without_shift(&delta);
        let largest = left.iter().zip(&self.metric).map(|(d, metric)| 2.0 * d.abs() * metric.sqrt()).fold(0.0, f64::max);
        if largest > 1.0 {
            delta.iter_mut().for_each(|d| *d /= largest);
        }
        delta
    }

    /// Whether cut joints keep their axes the right way round.
    pub(super) fn faces(&self) -> bool {
        self.wrong_way().is_none()
    }

    pub(super) fn wrong_way(&self) -> Option<usize> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        m.joints.iter().position(|j| {
            j.tree.is_none()
                && j.facing.iter().any(|&(u, f)| G::dot(G::rotate(w.places[j.a.0].r, u), G::rotate(w.places[j.b.0].r, f)) < 0.0)
        })
    }
}
