//! What constraints, exact values and guesses leave open: the position as near to the drawn pose, and the rates as near to zero, as
//! can be, in least squares over the coordinates of all joints, those off the tree included; 1 rad counts as much as the size of the
//! mechanism. Joints that leave all rotations count by the angle of theirs, bodies without a road to the ground against the ground.
//! Whole turns do not count: a pose does not know of them.
//!
//! The least squares are found by Gauss-Newton steps within the motions that the rows leave, with Levenberg's damping where a step
//! does not help; after each step the rows are closed again. A closing keeps to one assembly, so that others are looked for from the
//! mirrored position and from places around the drawn one.

use super::close::{CONVERGED, Held, System, Target};
use super::metric::norm;
use super::rotation;
use super::rotation::spin;
use super::shake::Shake;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, RowOwner, Step};
use crate::numerics::least_squares::{Rows, Within, left_open};
use std::f64::consts::{PI, TAU};

/// What a position is to be near to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Near {
    Guesses,
    Drawn,
}

/// Most steps of one search.
const STEPS: usize = 200;

/// Distance from the drawn pose, rad and sizes, from which on other assemblies are looked for.
const FAR: f64 = 0.1;

/// Part by which another assembly must be nearer to count.
const NEARER: f64 = 1e-3;

/// Residual of a closed position, rad and sizes, from which whole turns have been taken, and what guesses may be missed by that are met.
const CLOSED: f64 = 1e-9;

/// Places from which other assemblies are looked for.
const LOOKS: u32 = 16;

/// Coordinates up to which positions are looked for all around.
pub(super) const MOST: usize = 300;

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

    /// Looks for an assembly that misses the guesses as little as the settled position `q`, and is nearer to the drawn pose; `from` is where
    /// the search began, `targets` what is asked for. Where exact values name all coordinates there is no other one; where each loop has a
    /// guess, beside those that only say where free motions stand, it has been chosen.
    pub(super) fn look_nearer(&mut self, from: &[f64], targets: &[Target], q: &mut Vec<f64>) {
        let m = self.dynamics.mechanism;
        let guessed = self.guessed();
        if m.nv > MOST || self.all_named_exactly() || guessed >= self.closings() && guessed > self.free(q) {
            return;
        }
        let settled = std::mem::replace(&mut self.targets, targets.to_vec());
        let missed = self.miss(q);
        let mut best = (norm(&self.off(q, Near::Drawn).0), q.clone(), settled, self.modes.clone());
        let mut shake = Shake(5);
        for look in 0..LOOKS {
            if best.0 < FAR {
                break;
            }
            let mut trial = if look == 0 { self.mirrored(q) } else { from.to_vec() };
            if look > 0 {
                let way = self.shaken(&mut shake, PI);
                m.retract(&mut trial, &way);
            }
            self.held = Held::Exact;
            self.targets.copy_from_slice(targets);
            if !(self.close(&mut trial) && self.faces()) {
                continue;
            }
            self.settle(&mut trial);
            let turned_more = self.unwind(&mut trial, &best.1);
            let settled = std::mem::replace(&mut self.targets, targets.to_vec());
            if turned_more {
                continue;
            }
            let distance = norm(&self.off(&trial, Near::Drawn).0);
            if self.miss(&trial) <= missed + CLOSED && distance < (1.0 - NEARER) * best.0 {
                best = (distance, trial, settled, self.modes.clone());
            }
        }
        (*q, self.targets, self.modes) = (best.1, best.2, best.3);
        self.evaluate(q);
    }

    /// Takes whole turns from the hinges of a closed position where that keeps it closed, in the plane so that bodies stand within half a
    /// turn of how they are drawn; whether it is left with more of them than another one.
    fn unwind(&mut self, q: &mut [f64], other: &[f64]) -> bool {
        let m = self.dynamics.mechanism;
        let turns = |x: f64| (x / TAU).round();
        let mut more = false;
        let mut angles = vec![0.0; m.bodies.len()];
        for node in &m.nodes {
            angles[node.body] = angles[node.parent];
            for step in &m.steps[node.steps.clone()] {
                let Step::Axis { u, turns: true, slides: false, q: k, v, .. } = *step else { continue };
                let (sense, parent) = if G::SPIN == 1 { (G::spin_component(u, 2).signum(), angles[node.body]) } else { (1.0, 0.0) };
                let whole = turns(parent + sense * q[k]);
                if whole != 0.0 && !self.is_named(v) {
                    let wound = q[k];
                    q[k] -= sense * whole * TAU;
                    if self.gap(q) > CLOSED {
                        q[k] = wound;
                        more |= turns(wound).abs() > turns(other[k]).abs();
                    }
                }
                angles[node.body] += sense * q[k];
            }
        }
        more
    }

    /// How many motions constraints and exact values leave at a position.
    fn free(&mut self, q: &[f64]) -> usize {
        self.evaluate(q);
        self.held = Held::Exact;
        let (mut open, mut rows) = (Vec::new(), Rows::default());
        self.hard(&mut open, &mut rows);
        left_open(self.round_off(), &rows.to_dense(self.metric.len()), &self.metric).ncols()
    }

    /// Loops and couplings, of which each may have several assemblies.
    fn closings(&self) -> usize {
        let m = self.dynamics.mechanism;
        let couplings = m.rows.iter().filter(|row| row.owner == RowOwner::Coupling);
        m.joints.iter().filter(|joint| joint.tree.is_none()).count() + couplings.count()
    }

    /// A position with its axes on the other side of how they are drawn.
    fn mirrored(&self, q: &[f64]) -> Vec<f64> {
        let mut mirrored = q.to_vec();
        for step in &self.dynamics.mechanism.steps {
            match *step {
                Step::Axis { q: k, .. } => mirrored[k] = -mirrored[k],
                Step::Ball { q: k, .. } => mirrored[k + 1..k + 4].iter_mut().for_each(|x| *x = -*x),
            }
        }
        mirrored
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
        let mut damping = 0.0;
        let metric = self.metric.clone();
        let (mut r, mut jacobian) = self.off(q, near);
        for _ in 0..STEPS {
            if norm(&self.slope(&r, &jacobian)) < CONVERGED {
                return;
            }
            let (mut open, mut rows) = (Vec::new(), Rows::default());
            self.hard(&mut open, &mut rows);
            let within = Within::new(&rows, self.round_off(), &jacobian, &r, &metric);
            if within.slope() < CONVERGED * (1.0 + norm(&r)) {
                return;
            }
            let size = norm(&r);
            let found = loop {
                let Some(step) = within.step(damping) else {
                    self.evaluate(q);
                    return;
                };
                let mut trial = q.clone();
                self.dynamics.mechanism.retract(&mut trial, &self.bounded(step));
                if self.close(&mut trial) && self.faces() {
                    let (other, slopes) = self.off(&trial, near);
                    if norm(&other) < size {
                        damping = if damping > 1e-9 { damping / 10.0 } else { 0.0 };
                        break (trial, other, slopes);
                    }
                }
                damping = if damping == 0.0 { 1e-4 } else { damping * 10.0 };
                if damping > 1e6 {
                    self.evaluate(q);
                    return;
                }
            };
            (*q, r, jacobian) = found;
            if norm(&r) > size * (1.0 - 1e-15) {
                return;
            }
        }
    }

    /// Jᵀr over the coordinates that nothing held names.
    fn slope(&self, r: &[f64], jacobian: &Rows) -> Vec<f64> {
        let m = self.dynamics.mechanism;
        let mut sum = vec![0.0; m.nv];
        for (r, row) in r.iter().zip(jacobian.lines()) {
            row.iter().for_each(|&(k, x)| sum[k] += r * x);
        }
        sum.iter_mut().enumerate().filter(|(k, _)| self.is_named(*k)).for_each(|(_, sum)| *sum = 0.0);
        sum
    }

    /// Residual and Jacobian of what a position is to be near to.
    fn off(&mut self, q: &[f64], near: Near) -> (Vec<f64>, Rows) {
        self.evaluate(q);
        let (mut r, mut jacobian) = (Vec::new(), Rows::default());
        match near {
            Near::Guesses => self.asked(false, &mut r, Some(&mut jacobian)),
            Near::Drawn => self.joints(q, false, &mut r, &mut jacobian),
        }
        (r, jacobian)
    }

    /// Coordinates of all joints with their slopes by δ (q ⊕ δ); with `rates` the slopes of their rates by v instead.
    pub(super) fn joints(&self, q: &[f64], rates: bool, r: &mut Vec<f64>, jacobian: &mut Rows) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let turned = |x: f64| x - TAU * (x / TAU).round();
        let mut row = |x: f64, entries: &mut dyn Iterator<Item = (usize, f64)>| {
            r.push(x);
            jacobian.push(entries);
        };
        for step in &m.steps {
            match *step {
                Step::Axis { turns, q: k, v, .. } => {
                    let scale = if turns { 1.0 } else { 1.0 / self.size };
                    row(if turns { turned(q[k]) } else { q[k] * scale }, &mut std::iter::once((v, scale)));
                }
                Step::Ball { q: k, v, .. } => {
                    let unit = nalgebra::Quaternion::new(q[k], q[k + 1], q[k + 2], q[k + 3]);
                    let theta = nalgebra::UnitQuaternion::from_quaternion(unit).scaled_axis();
                    let slope = if rates { nalgebra::Matrix3::identity() } else { rotation::slope(&theta) };
                    (0..3).for_each(|i| row(theta[i], &mut (0..3).map(|j| (v + j, slope[(i, j)]))));
                }
            }
        }
        for joint in m.joints.iter().filter(|j| j.tree.is_none()) {
            for &slot in &joint.slots {
                let (gauge, reading) = (&m.gauges[slot], &w.readings[slot]);
                if matches!(gauge.measured, Measured::Distance { .. }) {
                    continue;
                }
                let scale = if gauge.turns() { 1.0 } else { 1.0 / self.size };
                let x = if gauge.turns() { turned(reading.x) } else { reading.x * scale };
                row(x, &mut self.slopes(slot, scale).into_iter());
            }
            let Some(drawn) = joint.turns else { continue };
            let (a, b) = (joint.a.0, joint.b.0);
            let [ra, rb, r0] = [w.places[a].r, w.places[b].r, drawn].map(rotation::matrix::<G>);
            let theta = rotation::vector(&(ra.transpose() * rb * r0.transpose()));
            // turned from the left: J⁻¹(−θ)
            let slope = if rates { nalgebra::Matrix3::identity() } else { rotation::slope(&-theta) } * ra.transpose();
            for i in 0..3 {
                let of_body =
                    |(body, sign): (usize, f64)| m.road(m.bodies[body].column).map(move |k| (k, sign * (slope * spin(&w.columns[k]))[i]));
                row(theta[i], &mut [(b, 1.0), (a, -1.0)].into_iter().flat_map(of_body));
            }
        }
    }
}
