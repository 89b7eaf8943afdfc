//! Steps of the spanning tree: from one body to the next along one axis, or by a ball.

use super::joint::Axis;
use crate::geometry::Space;
use crate::scalar::Scalar;

/// A moving step of a tree joint, applied in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step<G: Space> {
    /// A unit axis: turns about `u`, moves along `d` per unit of its coordinate; both in the frame before the step.
    Axis {
        /// Axis of rotation, or 0.
        u: G::Spin,
        /// Direction of motion, or 0.
        d: G::Vector,
        /// True if u is not 0.
        turns: bool,
        /// True if d is not 0.
        slides: bool,
        /// Index in q.
        q: usize,
        /// Index in v.
        v: usize,
    },
    /// A quaternion (4 coordinates) whose 3 velocities are ω in the frame after the step; reversed: the inverse rotation.
    Ball {
        /// First index in q.
        q: usize,
        /// First index in v.
        v: usize,
        /// True if the child is the joint's first body.
        reversed: bool,
    },
}

impl<G: Space> Step<G> {
    /// The step of a joint axis.
    pub(super) fn new(axis: Axis, reversed: bool, q: usize, v: usize) -> Self {
        let sign = if reversed { -1.0 } else { 1.0 };
        let spin = |u: [f64; 3]| G::spin(u.map(|x| sign * x));
        let vector = |d: [f64; 3], k: f64| G::vector(&d.map(|x| sign * k * x));
        match axis {
            Axis::Hinge(u) => Self::Axis { u: spin(u), d: G::Vector::default(), turns: true, slides: false, q, v },
            Axis::Slide(d) => Self::Axis { u: G::Spin::default(), d: vector(d, 1.0), turns: false, slides: true, q, v },
            Axis::Screw(u, pitch) => Self::Axis { u: spin(u), d: vector(u, pitch), turns: true, slides: true, q, v },
            Axis::Ball => Self::Ball { q, v, reversed },
        }
    }

    pub(super) fn lift<D: Scalar>(&self) -> Step<G::Lift<D>> {
        match *self {
            Self::Axis { u, d, turns, slides, q, v } => {
                Step::Axis { u: G::lift_spin::<D>(u), d: G::lift_vector::<D>(d), turns, slides, q, v }
            }
            Self::Ball { q, v, reversed } => Step::Ball { q, v, reversed },
        }
    }

    /// q̇ of the coordinates that it moves, by the unit velocity `k`, which is one of its own: 1 for an axis, ½ q∘(0, e) for a
    /// quaternion; written by `put(index in q, rate)`.
    pub fn unit_rate(&self, q: &[f64], k: usize, mut put: impl FnMut(usize, f64)) {
        match *self {
            Self::Axis { q: i, .. } => put(i, 1.0),
            Self::Ball { q: i, v, .. } => {
                let mut unit = [0.0; 4];
                unit[1 + k - v] = 1.0;
                let turned = multiply_quaternion([q[i], q[i + 1], q[i + 2], q[i + 3]], unit);
                turned.iter().enumerate().for_each(|(j, x)| put(i + j, 0.5 * x));
            }
        }
    }
}

/// Hamilton's product, (w, x, y, z).
pub(super) fn multiply_quaternion(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}
