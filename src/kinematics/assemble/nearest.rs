//! What constraints, exact values and guesses leave open: the position as near to the drawn pose, and the rates as near to zero, as
//! can be, in least squares over the coordinates of all joints, those off the tree included; 1 rad counts as much as the size of the
//! mechanism. Joints that leave all rotations count by the angle of theirs, bodies without a road to the ground against the ground.
//! Whole turns do not count: a pose does not know of them.
//!
//! The least squares are found by Gauss-Newton steps within the motions that the rows leave, with Levenberg's damping where a step
//! does not help; after each step the rows are closed again.

use super::close::{CONVERGED, Held, System, Target};
use super::metric::norm;
use super::rotation;
use super::rotation::spin;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Step};
use crate::numerics::least_squares::{left_open, shortest};
use std::f64::consts::TAU;

/// What a position is to be near to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Near {
    Guesses,
    Drawn,
}

/// Most steps of one search.
const STEPS: usize = 200;

impl<G: Space<S = f64>> System<'_, G> {
    /// Moves a closed position on its branch as near to the guesses as can be, and among such positions to the drawn pose.
    pub(super) fn settle(&mut self, q: &mut Vec<f64>) {
        if self.guesses() {
            if self.miss(q) > CONVERGED {
                self.approach(q, Near::Guesses);
            }
            self.hold(q);
        }
        self.approach(q, Near::Drawn);
        self.held = Held::Exact;
    }

    /// Moves a closed position as near to all asked values as can be where none of them is held.
    pub(super) fn near_asked(&mut self, q: &mut Vec<f64>) {
        self.approach(q, Near::Guesses);
        self.evaluate(q);
    }

    /// Holds the guesses at what they have come to.
    fn hold(&mut self, q: &[f64]) {
        self.evaluate(q);
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        for (start, target) in m.starts.iter().zip(&mut self.targets).filter(|(s, _)| s.guess) {
            match start.asked {
                Asked::Gauge { gauge, order: 0 } => *target = Target::Value(w.readings[gauge].x),
                Asked::Orientation(k) => *target = Target::Rotation(rotation::matrix::<G>(w.places[m.orientations[k].body].r)),
                _ => {}
            }
        }
        self.held = Held::All;
    }

    /// Moves a closed position to where the residuals are least; it stays closed and its axes the right way round.
    fn approach(&mut self, q: &mut Vec<f64>, near: Near) {
        let nv = self.dynamics.mechanism.nv;
        let mut damping = 0.0;
        let (mut r, mut jacobian) = self.off(q, near);
        for _ in 0..STEPS {
            if norm(&self.slope(&r, &jacobian)) < CONVERGED {
                return;
            }
            let (mut open, mut rows) = (Vec::new(), Vec::new());
            self.hard(&mut open, &mut rows);
            // n columns of motions that the rows leave, orthonormal in the metric
            let basis = left_open(self.round_off(), &rows, &self.metric);
            let n = basis.ncols();
            let along: Vec<f64> = jacobian
                .chunks_exact(nv)
                .flat_map(|row| basis.column_iter().map(move |way| row.iter().zip(way.iter()).map(|(a, b)| a * b).sum::<f64>()))
                .collect();
            let b: Vec<f64> = r.iter().map(|r| -r).collect();
            let gradient: Vec<f64> = (0..n).map(|k| r.iter().enumerate().map(|(i, r)| r * along[i * n + k]).sum()).collect();
            if norm(&gradient) < CONVERGED * (1.0 + norm(&r)) {
                return;
            }
            let size = norm(&r);
            loop {
                let way = shortest(&along, &b, &vec![1.0; n], damping);
                let step: Vec<f64> = (0..nv).map(|i| way.iter().enumerate().map(|(k, x)| basis[(i, k)] * x).sum()).collect();
                let mut trial = q.clone();
                self.dynamics.mechanism.retract(&mut trial, &self.bounded(step));
                if self.close(&mut trial) && self.faces() {
                    let (other, slopes) = self.off(&trial, near);
                    if norm(&other) < size {
                        (*q, r, jacobian) = (trial, other, slopes);
                        damping = if damping > 1e-9 { damping / 10.0 } else { 0.0 };
                        break;
                    }
                }
                damping = if damping == 0.0 { 1e-4 } else { damping * 10.0 };
                if damping > 1e6 {
                    self.evaluate(q);
                    return;
                }
            }
            if norm(&r) > size * (1.0 - 1e-15) {
                return;
            }
        }
    }

    /// Jᵀr over the coordinates that no exact value fixes.
    fn slope(&self, r: &[f64], jacobian: &[f64]) -> Vec<f64> {
        let m = self.dynamics.mechanism;
        let mut sum = vec![0.0; m.nv];
        for (r, row) in r.iter().zip(jacobian.chunks_exact(m.nv.max(1))) {
            sum.iter_mut().zip(row).for_each(|(s, x)| *s += r * x);
        }
        let held = |guess: bool| self.held == Held::All || self.held == Held::Exact && !guess;
        for start in m.starts.iter().filter(|s| held(s.guess)) {
            if let Asked::Gauge { gauge, order: 0 } = start.asked
                && let Measured::Coordinate { along, .. } = m.gauges[gauge].measured
            {
                sum[along.v] = 0.0;
            }
        }
        sum
    }

    /// Residual and Jacobian of what a position is to be near to.
    fn off(&mut self, q: &[f64], near: Near) -> (Vec<f64>, Vec<f64>) {
        self.evaluate(q);
        let (mut r, mut jacobian) = (Vec::new(), Vec::new());
        match near {
            Near::Guesses => self.asked(false, &mut r, &mut jacobian),
            Near::Drawn => self.joints(q, false, &mut r, &mut jacobian),
        }
        (r, jacobian)
    }

    /// Coordinates of all joints with their slopes by δ (q ⊕ δ); with `rates` the slopes of their rates by v instead.
    pub(super) fn joints(&self, q: &[f64], rates: bool, r: &mut Vec<f64>, jacobian: &mut Vec<f64>) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let turned = |x: f64| x - TAU * (x / TAU).round();
        let mut row = |x: f64, entries: &mut dyn FnMut(&mut [f64])| {
            r.push(x);
            let first = jacobian.len();
            jacobian.resize(first + m.nv, 0.0);
            entries(&mut jacobian[first..]);
        };
        for step in &m.steps {
            match *step {
                Step::Axis { turns, q: k, v, .. } => {
                    let scale = if turns { 1.0 } else { 1.0 / self.size };
                    row(if turns { turned(q[k]) } else { q[k] * scale }, &mut |out| out[v] = scale);
                }
                Step::Ball { q: k, v, .. } => {
                    let unit = nalgebra::Quaternion::new(q[k], q[k + 1], q[k + 2], q[k + 3]);
                    let theta = nalgebra::UnitQuaternion::from_quaternion(unit).scaled_axis();
                    let slope = if rates { nalgebra::Matrix3::identity() } else { rotation::slope(&theta) };
                    (0..3).for_each(|i| row(theta[i], &mut |out| (0..3).for_each(|j| out[v + j] = slope[(i, j)])));
                }
            }
        }
        for joint in m.joints.iter().filter(|j| j.tree.is_none()) {
            for &gauge in &joint.slots {
                let (gauge, reading) = (&m.gauges[gauge], &w.readings[gauge]);
                if matches!(gauge.measured, Measured::Distance { .. }) {
                    continue;
                }
                let scale = if gauge.turns() { 1.0 } else { 1.0 / self.size };
                let x = if gauge.turns() { turned(reading.x) } else { reading.x * scale };
                row(x, &mut |out| gauge.project(reading, &w.columns, |k, x| out[k] = x * scale));
            }
            let Some(drawn) = joint.turns else { continue };
            let (a, b) = (joint.a.0, joint.b.0);
            let [ra, rb, r0] = [w.places[a].r, w.places[b].r, drawn].map(rotation::matrix::<G>);
            let theta = rotation::vector(&(ra.transpose() * rb * r0.transpose()));
            // turned from the left: J⁻¹(−θ)
            let slope = if rates { nalgebra::Matrix3::identity() } else { rotation::slope(&-theta) } * ra.transpose();
            for i in 0..3 {
                row(theta[i], &mut |out| {
                    for (body, sign) in [(b, 1.0), (a, -1.0)] {
                        for &k in &m.bodies[body].path {
                            out[k] += sign * (slope * spin(&w.columns[k]))[i];
                        }
                    }
                });
            }
        }
    }
}
