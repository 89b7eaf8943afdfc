//! Joints: each kind is a product of unit axes on the tree, or a few gauges that stay at their targets off it.
//!
//! With the joint point p_a and axes in the first body, p_b in the second and R₀ the smallest rotation that takes `to` to
//! `axis`, the second body stands in the first at T(p_a) · exp(ξ₁ q₁) ⋯ exp(ξ_n q_n) · R₀ · T(−p_b). Cut off the tree, the
//! same joint is a set of rows: slides of p_b against p_a along directions of a, and cosines between directions of both.
//! This file is the only one that knows kinds of joints.

use super::gauge::Measured;
use crate::geometry::{Pose, Space};
use crate::model::JointKind;
use crate::scalar::Scalar;
use std::ops::Range;

/// A joint as it is realised.
#[derive(Clone, Debug)]
pub struct Joint<G: Space> {
    /// Its name.
    pub name: String,
    /// Its kind as written in the file.
    pub kind: &'static str,
    /// First body and the joint's point in it.
    pub a: (usize, G::Vector),
    /// Second body and the joint's point in it.
    pub b: (usize, G::Vector),
    /// Unit axis in the first body, for drawings.
    pub axis: [f64; 3],
    /// Of a universal joint its unit axis in the second body, for drawings.
    pub second: Option<[f64; 3]>,
    /// How the second body stands in the first as drawn, by rows, for drawings.
    pub drawn: [[f64; 3]; 3],
    /// What its first coordinate is as drawn, rad or m.
    pub zero: f64,
    /// The tree node that it carries, and whether its first body is the child.
    pub tree: Option<(usize, bool)>,
    /// Gauges of its coordinates, in the order of its slots.
    pub slots: Vec<usize>,
    /// Its constraint rows, if it is cut.
    pub rows: Range<usize>,
    /// Degrees of freedom that it leaves.
    pub freedom: usize,
    /// Directions of a and b that a cut joint must keep within a right angle: cosine rows alone also allow the opposite.
    pub facing: Vec<(G::Vector, G::Vector)>,
    /// How the second body stands in the first as drawn, if the joint leaves all rotations: they are no coordinates of their own.
    pub turns: Option<G::Rotation>,
}

impl<G: Space> Joint<G> {
    pub(super) fn lift<D: Scalar>(&self) -> Joint<G::Lift<D>> {
        Joint {
            name: String::new(),
            kind: self.kind,
            a: (self.a.0, G::lift_vector::<D>(self.a.1)),
            b: (self.b.0, G::lift_vector::<D>(self.b.1)),
            axis: self.axis,
            second: self.second,
            drawn: self.drawn,
            zero: self.zero,
            tree: self.tree,
            slots: Vec::new(),
            rows: self.rows.clone(),
            freedom: self.freedom,
            facing: Vec::new(),
            turns: None,
        }
    }
}

/// One unit axis of a joint, in the first body's frame at the joint point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    /// Turns about a unit direction.
    Hinge([f64; 3]),
    /// Slides along a unit direction.
    Slide([f64; 3]),
    /// Turns about a unit direction and moves along it, m per rad.
    Screw([f64; 3], f64),
    /// Turns freely: quaternion.
    Ball,
}

impl Axis {
    /// Numbers of coordinates and velocities.
    pub(super) fn sizes(self) -> (usize, usize) {
        if self == Self::Ball { (4, 3) } else { (1, 1) }
    }
    /// True if its coordinate is an angle.
    pub(super) fn turns(self) -> bool {
        !matches!(self, Self::Slide(_))
    }
}

/// Geometry of a joint, as numbers.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) kind: JointKind,
    /// Joint points in the bodies.
    pub(super) pa: [f64; 3],
    pub(super) pb: [f64; 3],
    /// Right-handed unit triad in a; the last is the axis (planar: the first is the axis, the last z).
    pub(super) triad: [[f64; 3]; 3],
    /// R₀ as a matrix.
    pub(super) align: [[f64; 3]; 3],
    /// Second axis of a universal joint, unit, in b.
    pub(super) second: [f64; 3],
    /// Metres per radian of a screw.
    pub(super) pitch: f64,
    /// Held distance.
    pub(super) length: f64,
    /// `zero`.
    pub(super) zero: f64,
}

/// What a cut joint asks of a gauge.
pub(super) struct Asked<G: Space> {
    pub(super) measured: Measured<G>,
    pub(super) target: f64,
    pub(super) label: &'static str,
    pub(super) angular: bool,
}

impl Shape {
    /// Word of the kind in the model file.
    pub(super) fn word(&self) -> &'static str {
        match self.kind {
            JointKind::Revolute => "revolute",
            JointKind::Slider => "slider",
            JointKind::PinInSlot => "pin-in-slot",
            JointKind::Fixed => "fixed",
            JointKind::Distance { .. } => "distance",
            JointKind::Cylindrical => "cylindrical",
            JointKind::Planar => "planar",
            JointKind::Screw { .. } => "screw",
            JointKind::Universal { .. } => "universal",
            JointKind::Spherical => "spherical",
            JointKind::Free => "free",
            JointKind::Particle => "point",
        }
    }

    /// The axes from the first body to the second; none for a distance, which is always a row.
    pub(super) fn axes(&self, planar: bool) -> Vec<Axis> {
        let [e1, e2, n] = self.triad;
        let along = if planar { e1 } else { n };
        let z = [0.0, 0.0, 1.0];
        match self.kind {
            JointKind::Revolute => vec![Axis::Hinge(n)],
            JointKind::Slider => vec![Axis::Slide(along)],
            JointKind::PinInSlot => vec![Axis::Slide(along), Axis::Hinge(z)],
            JointKind::Fixed | JointKind::Distance { .. } => vec![],
            JointKind::Cylindrical => vec![Axis::Hinge(n), Axis::Slide(n)],
            JointKind::Planar => vec![Axis::Slide(e1), Axis::Slide(e2), Axis::Hinge(n)],
            JointKind::Screw { .. } => vec![Axis::Screw(n, self.pitch)],
            JointKind::Universal { .. } => vec![Axis::Hinge(n), Axis::Hinge(apply(&self.align, self.second))],
            JointKind::Spherical => vec![Axis::Ball],
            JointKind::Particle if planar => vec![Axis::Slide([1.0, 0.0, 0.0]), Axis::Slide([0.0, 1.0, 0.0])],
            JointKind::Particle => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], z].map(Axis::Slide).to_vec(),
            JointKind::Free if planar => vec![Axis::Slide([1.0, 0.0, 0.0]), Axis::Slide([0.0, 1.0, 0.0]), Axis::Hinge(z)],
            JointKind::Free => {
                vec![Axis::Slide([1.0, 0.0, 0.0]), Axis::Slide([0.0, 1.0, 0.0]), Axis::Slide([0.0, 0.0, 1.0]), Axis::Ball]
            }
        }
    }

    /// Whether the joint can carry a tree branch.
    pub(super) fn spans(&self) -> bool {
        !matches!(self.kind, JointKind::Distance { .. })
    }

    /// R₀ · T(−p_b), with the drawn position shifted by `zero` along the one axis.
    pub(super) fn after<G: Space>(&self, planar: bool) -> Pose<G> {
        let align = Pose { r: G::rotation(&self.align, 0.0), p: G::Vector::default() };
        let back = Pose::translation(-G::vector(&self.pb));
        let zero = match self.axes(planar)[..] {
            [Axis::Hinge(u), ..] if self.zero != 0.0 => {
                Pose { r: G::hinge(G::spin(u), G::S::constant(-self.zero)), p: G::Vector::default() }
            }
            [Axis::Slide(d)] => Pose::translation(G::vector(&d.map(|x| -x * self.zero))),
            [Axis::Screw(u, pitch)] if self.zero != 0.0 => {
                Pose { r: G::hinge(G::spin(u), G::S::constant(-self.zero)), p: G::vector(&u.map(|x| -x * pitch * self.zero)) }
            }
            _ => Pose::identity(),
        };
        zero * align * back
    }

    /// The gauges of the joint's coordinates when it is cut, in the order of its slots; `winding` hands out winding numbers.
    pub(super) fn slots<G: Space>(&self, planar: bool, mut winding: impl FnMut() -> usize) -> Vec<Measured<G>> {
        let v = |x: [f64; 3]| G::vector(&x);
        let (pa, pb) = (v(self.pa), v(self.pb));
        let [e1, e2, n] = self.triad;
        let slide = |d: [f64; 3]| Measured::Slide { pa, n: v(d), pb };
        let mut turn = |e1: [f64; 3], e2: [f64; 3], f: [f64; 3]| {
            if planar { Measured::Angle } else { Measured::Turn { e1: v(e1), e2: v(e2), f: v(f), winding: winding() } }
        };
        let back = |x: [f64; 3]| apply(&transpose(&self.align), x);
        match self.kind {
            JointKind::Revolute | JointKind::Screw { .. } => vec![turn(e1, e2, back(e1))],
            JointKind::Slider => vec![slide(if planar { e1 } else { n })],
            JointKind::PinInSlot => vec![slide(e1), Measured::Angle],
            JointKind::Cylindrical => vec![turn(e1, e2, back(e1)), slide(n)],
            JointKind::Planar => vec![slide(e1), slide(e2), turn(e1, e2, back(e1))],
            JointKind::Universal { .. } => {
                // the second axis seen from a turns with the first angle; the first axis seen from b turns back by the second
                let (w, first) = (apply(&self.align, self.second), back(n));
                vec![turn(w, cross(n, w), self.second), turn(first, cross(first, self.second), n)]
            }
            JointKind::Free if planar => vec![slide([1.0, 0.0, 0.0]), slide([0.0, 1.0, 0.0]), Measured::Angle],
            JointKind::Particle if planar => vec![slide([1.0, 0.0, 0.0]), slide([0.0, 1.0, 0.0])],
            JointKind::Free | JointKind::Particle => vec![slide([1.0, 0.0, 0.0]), slide([0.0, 1.0, 0.0]), slide([0.0, 0.0, 1.0])],
            JointKind::Fixed | JointKind::Spherical => vec![],
            JointKind::Distance { .. } => vec![Measured::Distance { pa, pb }],
        }
    }

    /// Whether a coordinate of the cut joint is measured from the second body to the first.
    pub(super) fn seen_from_second(&self, slot: usize) -> bool {
        matches!(self.kind, JointKind::Universal { .. }) && slot == 1
    }

    /// The rows of the joint when it is cut, apart from a screw's relation of angle and advance.
    pub(super) fn rows<G: Space>(&self, planar: bool) -> Vec<Asked<G>> {
        let v = |x: [f64; 3]| G::vector(&x);
        let (pa, pb) = (v(self.pa), v(self.pb));
        let [e1, e2, n] = self.triad;
        let back = |x: [f64; 3]| apply(&transpose(&self.align), x);
        let slide = |d: [f64; 3], label| Asked { measured: Measured::Slide { pa, n: v(d), pb }, target: 0.0, label, angular: false };
        let dot =
            |u: [f64; 3], w: [f64; 3], label| Asked { measured: Measured::Dot { u: v(u), w: v(w) }, target: 0.0, label, angular: true };
        let angle = || Asked { measured: Measured::Angle, target: 0.0, label: "angle", angular: true };
        if planar {
            return match self.kind {
                JointKind::Revolute => vec![slide([1.0, 0.0, 0.0], "x"), slide([0.0, 1.0, 0.0], "y")],
                JointKind::Slider => vec![slide(e2, "across the axis"), angle()],
                JointKind::PinInSlot => vec![slide(e2, "across the slot")],
                JointKind::Fixed => vec![slide([1.0, 0.0, 0.0], "x"), slide([0.0, 1.0, 0.0], "y"), angle()],
                JointKind::Distance { .. } => vec![self.distance(pa, pb)],
                _ => vec![],
            };
        }
        let point = || vec![slide(e1, "first across"), slide(e2, "second across"), slide(n, "along the axis")];
        let tilt = || vec![dot(e1, back(n), "first tilt"), dot(e2, back(n), "second tilt")];
        match self.kind {
            JointKind::Revolute => [point(), tilt()].into_iter().flatten().collect(),
            JointKind::Cylindrical | JointKind::Screw { .. } => {
                vec![slide(e1, "first across"), slide(e2, "second across")].into_iter().chain(tilt()).collect()
            }
            JointKind::Slider => vec![slide(e1, "first across"), slide(e2, "second across")]
                .into_iter()
                .chain(tilt())
                .chain([dot(e1, back(e2), "twist")])
                .collect(),
            JointKind::Planar => vec![slide(n, "along the normal")].into_iter().chain(tilt()).collect(),
            JointKind::Universal { .. } => point().into_iter().chain([dot(n, self.second, "angle of the axes")]).collect(),
            JointKind::Spherical => point(),
            JointKind::Fixed => point().into_iter().chain(tilt()).chain([dot(e1, back(e2), "twist")]).collect(),
            JointKind::Distance { .. } => vec![self.distance(pa, pb)],
            _ => vec![],
        }
    }

    /// Pairs of directions that a cut joint must keep within a right angle.
    pub(super) fn facing<G: Space>(&self, planar: bool) -> Vec<(G::Vector, G::Vector)> {
        let [e1, _, n] = self.triad;
        let pair = |x: [f64; 3]| (G::vector(&x), G::vector(&apply(&transpose(&self.align), x)));
        match self.kind {
            _ if planar => vec![],
            JointKind::Revolute | JointKind::Cylindrical | JointKind::Screw { .. } | JointKind::Planar => vec![pair(n)],
            JointKind::Slider | JointKind::Fixed => vec![pair(n), pair(e1)],
            _ => vec![],
        }
    }

    /// R₀, if all rotations are free.
    pub(super) fn turns<G: Space>(&self, planar: bool) -> Option<G::Rotation> {
        self.axes(planar).contains(&Axis::Ball).then(|| G::rotation(&self.align, 0.0))
    }

    fn distance<G: Space>(&self, pa: G::Vector, pb: G::Vector) -> Asked<G> {
        Asked { measured: Measured::Distance { pa, pb }, target: self.length, label: "distance", angular: false }
    }

    /// Degrees of freedom that the joint leaves.
    pub(super) fn freedom(&self, planar: bool) -> usize {
        match self.kind {
            JointKind::Distance { .. } => {
                if planar {
                    2
                } else {
                    5
                }
            }
            _ => self.axes(planar).iter().map(|a| a.sizes().1).sum(),
        }
    }
}

/// An axis of a planar joint within this of the first body's x axis, rad, leaves no direction in the plane to be told by that.
const ALONG: f64 = 1e-6;

/// The triad of a planar joint of the normal `n`: its first direction is x made normal to that, or y where `n` is along x.
pub(super) fn plane(n: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y] = [0, 1].map(|i| {
        let mut e = n.map(|x| -n[i] * x);
        e[i] += 1.0;
        e
    });
    let e1 = unit(if dot(x, x) > ALONG * ALONG { x } else { y });
    [e1, cross(n, e1), n]
}

/// The right-handed triad whose last direction is the unit vector `n`.
pub(super) fn triad(n: [f64; 3]) -> [[f64; 3]; 3] {
    // the world axis least aligned with n; for n = z that is x, so that e1 = x and e2 = y
    let least = (0..3).min_by(|&i, &k| n[i].abs().total_cmp(&n[k].abs())).unwrap_or(0);
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let along = dot(e, n);
    let e1 = unit([e[0] - along * n[0], e[1] - along * n[1], e[2] - along * n[2]]);
    [e1, cross(n, e1), n]
}

/// The smallest rotation that takes the unit vector `from` to the unit vector `to`, as a matrix.
#[must_use]
pub fn axis_rotation(from: [f64; 3], to: [f64; 3]) -> [[f64; 3]; 3] {
    let (c, k) = (dot(from, to), cross(from, to));
    // opposite vectors: half a turn about any normal
    let (k, scale) = if c > -1.0 + 1e-12 { (k, 1.0 / (1.0 + c)) } else { (triad(from)[0], 2.0) };
    let c = if scale == 2.0 { -1.0 } else { c };
    let s = if scale == 2.0 { [0.0; 3] } else { k };
    let mut r = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            // R = c E + k~ + k kᵀ/(1 + c)
            r[i][j] = k[i] * k[j] * scale + if i == j { c } else { 0.0 };
        }
    }
    for (i, j, l) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        r[i][j] -= s[l];
        r[j][i] += s[l];
    }
    r
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
pub(super) fn unit(a: [f64; 3]) -> [f64; 3] {
    let n = dot(a, a).sqrt();
    a.map(|x| x / n)
}
pub(super) fn apply(r: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| dot(r[i], x))
}
/// A B.
pub(super) fn multiply(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let b = transpose(b);
    std::array::from_fn(|i| std::array::from_fn(|k| dot(a[i], b[k])))
}
pub(super) fn transpose(r: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smallest_rotation_takes_one_axis_to_the_other() {
        for (from, to) in
            [([1.0, 0.0, 0.0], unit([0.3, -0.5, 0.8])), ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), (unit([1.0, 1.0, 0.2]), unit([1.0, 1.0, 0.2]))]
        {
            let r = axis_rotation(from, to);
            let moved = apply(&r, from);
            assert!((0..3).all(|i| (moved[i] - to[i]).abs() < 1e-14), "{moved:?} {to:?}");
            let det = dot(r[0], cross(r[1], r[2]));
            assert!((det - 1.0).abs() < 1e-14);
        }
    }
}
