//! Ball joints in space that nobody has named: how they stand before a start is closed.
//!
//! A ball has no position of its own, and begins as it is drawn. Where guesses turn what carries it far from how that is drawn, a joint
//! that closes a loop behind it then stands far from closed though only the ball is wrong, and the search, which moves everything, may
//! end on another assembly: a leg between a universal joint and a ball half a turn about its own length off.

use super::close::System;
use super::rotation;
use crate::geometry::Space;
use crate::mechanism::Step;
use nalgebra::Matrix3;

/// Angle, rad, from which on a joint stands far from closed.
const FAR: f64 = 0.1;

/// Kinds of joints that leave no rotation, or one about an axis, of what they join.
const HOLDING: [&str; 4] = ["fixed", "revolute", "slider", "cylindrical"];

impl<G: Space<S = f64>> System<'_, G> {
    /// Turns a ball that nobody named, and that alone turns one side of a joint that closes a loop, so that this joint is turned as it
    /// is drawn, if less stands open then.
    pub(super) fn turn_balls(&mut self, q: &mut Vec<f64>) {
        let m = self.dynamics.mechanism;
        let mut balls = vec![false; m.nv];
        for step in &m.steps {
            if let Step::Ball { v, .. } = *step {
                balls[v] = true;
            }
        }
        for asked in &m.orientations {
            m.road(m.bodies[asked.body].column).for_each(|k| balls[k] = false);
        }
        if !balls.contains(&true) {
            return;
        }
        self.evaluate(q);
        for joint in m.joints.iter().filter(|joint| joint.tree.is_none() && HOLDING.contains(&joint.kind)) {
            let sides = [joint.a.0, joint.b.0];
            let of = |side: usize| m.road(m.bodies[sides[side]].column).filter(|k| balls[*k]).collect::<Vec<usize>>();
            let of = [of(0), of(1)];
            let own = |side: usize| of[side].iter().copied().filter(|k| !of[1 - side].contains(k)).collect::<Vec<usize>>();
            let (ball, of_second) = match (&own(0)[..], &own(1)[..]) {
                (&[ball], []) => (ball, false),
                ([], &[ball]) => (ball, true),
                _ => continue,
            };
            let w = &self.dynamics.work;
            let [a, b] = sides.map(|body| rotation::matrix::<G>(w.places[body].r));
            let drawn = Matrix3::from_fn(|i, k| joint.drawn[i][k]);
            // in the frame of the ground, what turns the ball's side to a⁻¹ b = drawn
            let turn = if of_second { a * drawn * b.transpose() } else { b * drawn.transpose() * a.transpose() };
            let turn = rotation::vector(&turn);
            let axes = Matrix3::from_fn(|i, k| rotation::spin(&w.columns[ball + k])[i]);
            let (true, Some(inverse)) = (turn.norm() > FAR, axes.try_inverse()) else { continue };
            let mut delta = vec![0.0; m.nv];
            delta[ball..ball + 3].copy_from_slice((inverse * turn).as_slice());
            let mut trial = q.clone();
            m.retract(&mut trial, &delta);
            let open = self.gap(q);
            if self.gap(&trial) < open {
                *q = trial;
            } else {
                self.evaluate(q);
            }
        }
    }
}
