//! Poses, twists, wrenches and inertias, written once over [`Space`].
//!
//! With V = (ω, v) the twist at the reference point, from which places are measured, the body-fixed point at r moves with
//! v + ω × r; with F = (n, f) the power is n·ω + f·v. The momentum of a body is I V = (J ω + h × v, m v + ω × h), h = m c the first moment, J about that point.
//! In world coordinates d/dt of a body-fixed twist m is V × m and of a wrench f is V ×* f (Featherstone 2008, section 2.9).

use super::Space;
use crate::scalar::Scalar;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A pose x_wb: maps coordinates in b to coordinates in w by R r + p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<G: Space> {
    /// Rotation.
    pub r: G::Rotation,
    /// Position of the origin, m.
    pub p: G::Vector,
}

impl<G: Space> Pose<G> {
    /// No displacement.
    #[must_use]
    pub fn identity() -> Self {
        Self { r: G::identity(), p: G::Vector::default() }
    }
    /// Displacement without rotation.
    #[must_use]
    pub fn translation(p: G::Vector) -> Self {
        Self { r: G::identity(), p }
    }
    /// Coordinates of a point: R r + p.
    #[inline(always)]
    #[must_use]
    pub fn point(self, r: G::Vector) -> G::Vector {
        self.p + G::rotate(self.r, r)
    }
    /// `self * b`, without the product of rotations if b has none (`turned` false).
    #[inline(always)]
    #[must_use]
    pub fn shifted(self, b: Self, turned: bool) -> Self {
        Self { r: if turned { G::multiply(self.r, b.r) } else { self.r }, p: self.point(b.p) }
    }
    /// The inverse pose x_bw.
    #[must_use]
    pub fn inverse(self) -> Self {
        let r = G::inverse(self.r);
        Self { r, p: -G::rotate(r, self.p) }
    }
    /// The same numbers on another scalar.
    #[must_use]
    pub fn lift<D: Scalar>(self) -> Pose<G::Lift<D>> {
        Pose { r: G::lift_rotation::<D>(self.r), p: G::lift_vector::<D>(self.p) }
    }
}

impl<G: Space> Mul for Pose<G> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self { r: G::multiply(self.r, b.r), p: self.point(b.p) }
    }
}

/// A twist: angular velocity, rad/s, and velocity of the body-fixed point at the reference point, m/s (or their rates).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<G: Space> {
    /// ω.
    pub w: G::Spin,
    /// v at the reference point.
    pub v: G::Vector,
}

/// A wrench: moment about the reference point, N m, and force, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force<G: Space> {
    /// Moment about the reference point.
    pub n: G::Spin,
    /// Force.
    pub f: G::Vector,
}

macro_rules! linear {
    ($type:ident, $a:ident, $b:ident) => {
        impl<G: Space> Add for $type<G> {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                Self { $a: self.$a + o.$a, $b: self.$b + o.$b }
            }
        }
        impl<G: Space> Sub for $type<G> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                Self { $a: self.$a - o.$a, $b: self.$b - o.$b }
            }
        }
        impl<G: Space> Neg for $type<G> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self { $a: -self.$a, $b: -self.$b }
            }
        }
        impl<G: Space> Mul<G::S> for $type<G> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, k: G::S) -> Self {
                Self { $a: self.$a * k, $b: self.$b * k }
            }
        }
        impl<G: Space> AddAssign for $type<G> {
            #[inline(always)]
            fn add_assign(&mut self, o: Self) {
                *self = *self + o;
            }
        }
        impl<G: Space> SubAssign for $type<G> {
            #[inline(always)]
            fn sub_assign(&mut self, o: Self) {
                *self = *self - o;
            }
        }
    };
}
linear!(Motion, w, v);
linear!(Force, n, f);

impl<G: Space> Motion<G> {
    /// The twist of a unit rotation about the axis `u` through the point `p`.
    #[inline(always)]
    #[must_use]
    pub fn about(u: G::Spin, p: G::Vector) -> Self {
        Self { w: u, v: -G::turn(u, p) }
    }
    /// Velocity of the body-fixed point that is at `r` now: v + ω × r.
    #[inline(always)]
    #[must_use]
    pub fn at(self, r: G::Vector) -> G::Vector {
        self.v + G::turn(self.w, r)
    }
    /// V × m.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, m: Self) -> Self {
        Self { w: G::cross_spin(self.w, m.w), v: G::turn(self.w, m.v) - G::turn(m.w, self.v) }
    }
    /// V ×* f.
    #[inline(always)]
    #[must_use]
    pub fn cross_force(self, f: Force<G>) -> Force<G> {
        Force { n: G::cross_spin(self.w, f.n) + G::moment(self.v, f.f), f: G::turn(self.w, f.f) }
    }
}

impl<G: Space> Force<G> {
    /// The wrench of a force that acts at the point `p`.
    #[inline(always)]
    #[must_use]
    pub fn at(f: G::Vector, p: G::Vector) -> Self {
        Self { n: G::moment(p, f), f }
    }
    /// The wrench of a moment.
    #[inline(always)]
    #[must_use]
    pub fn couple(n: G::Spin) -> Self {
        Self { n, f: G::Vector::default() }
    }
    /// Power on a body with twist `m`, W.
    #[inline(always)]
    #[must_use]
    pub fn power(self, m: Motion<G>) -> G::S {
        G::dot_spin(self.n, m.w) + G::dot(self.f, m.v)
    }
    /// The same wrench about the origin of the world, with the reference point that it is about.
    #[inline(always)]
    #[must_use]
    pub fn about_origin(self, reference: G::Vector) -> Self {
        Self { n: self.n + G::moment(reference, self.f), f: self.f }
    }
    /// Moment about the point `p` instead of the reference point.
    #[must_use]
    pub fn moment_about(self, p: G::Vector) -> G::Spin {
        self.n - G::moment(p, self.f)
    }
}

/// Mass, centre of mass and inertia about it in the body frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassProperties<G: Space> {
    /// Mass, kg.
    pub mass: G::S,
    /// Centre of mass in the body frame, m.
    pub com: G::Vector,
    /// Inertia about the centre of mass, body axes, kg m².
    pub inertia: G::Tensor,
}

impl<G: Space> MassProperties<G> {
    /// Two rigidly joined masses as one (Steiner).
    #[must_use]
    pub fn join(self, o: Self) -> Self {
        let mass = self.mass + o.mass;
        if mass.value() == 0.0 {
            return Self { mass, com: self.com, inertia: self.inertia + o.inertia };
        }
        let com = (self.com * self.mass + o.com * o.mass) * (G::S::constant(1.0) / mass);
        let inertia = self.inertia + o.inertia + G::steiner(self.mass, self.com - com) + G::steiner(o.mass, o.com - com);
        Self { mass, com, inertia }
    }
    /// About the point from which the place of the pose is measured, in world axes.
    #[inline]
    #[must_use]
    pub fn in_world(self, x_wb: Pose<G>) -> Inertia<G> {
        let c = x_wb.point(self.com);
        Inertia { m: self.mass, h: c * self.mass, j: G::carry(x_wb.r, self.inertia) + G::steiner(self.mass, c) }
    }
    /// The same numbers on another scalar.
    #[must_use]
    pub fn lift<D: Scalar>(self) -> MassProperties<G::Lift<D>> {
        MassProperties {
            mass: D::constant(self.mass.value()),
            com: G::lift_vector::<D>(self.com),
            inertia: G::lift_tensor::<D>(self.inertia),
        }
    }
}

/// An inertia about the reference point in world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertia<G: Space> {
    /// Mass, kg.
    pub m: G::S,
    /// First moment m c, kg m.
    pub h: G::Vector,
    /// Second moment about the reference point, kg m².
    pub j: G::Tensor,
}

impl<G: Space> AddAssign for Inertia<G> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        self.m += o.m;
        self.h += o.h;
        self.j += o.j;
    }
}

impl<G: Space> Inertia<G> {
    /// d/dt (I V) = I A + V ×* I V of a body with the twist `v` and its rate `a`.
    ///
    /// With ẍ = A.v + ω × V.v, the acceleration of the body-fixed point at the reference point, it is
    /// (J ω̇ + h × ẍ + ω × J ω, m ẍ + ω̇ × h + ω × (ω × h)): without V.v × m V.v, which is 0 but for the rounding of its parts, so
    /// that a body which travels fast turns as one at rest.
    #[inline(always)]
    #[must_use]
    pub fn momentum_rate(self, a: Motion<G>, v: Motion<G>) -> Force<G> {
        let point = a.v + G::turn(v.w, v.v);
        Force {
            n: G::apply(self.j, a.w) + G::moment(self.h, point) + G::cross_spin(v.w, G::apply(self.j, v.w)),
            f: point * self.m + G::turn(a.w, self.h) + G::turn(v.w, G::turn(v.w, self.h)),
        }
    }
}

impl<G: Space> Mul<Motion<G>> for Inertia<G> {
    type Output = Force<G>;
    /// I V = (J ω + h × v, m v + ω × h).
    #[inline(always)]
    fn mul(self, m: Motion<G>) -> Force<G> {
        Force { n: G::apply(self.j, m.w) + G::moment(self.h, m.v), f: m.v * self.m + G::turn(m.w, self.h) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Planar, Spatial};
    use super::*;

    type E3 = Spatial<f64>;

    fn pose(seed: f64) -> Pose<E3> {
        let q = [0.7 + seed, 0.3 - seed, seed, 0.5];
        Pose { r: E3::quaternion(q), p: E3::vector(&[seed, 1.0 - seed, 0.3]) }
    }
    fn motion(seed: f64) -> Motion<E3> {
        Motion { w: E3::spin([seed, -0.4, 0.9]), v: E3::vector(&[0.2, seed, -1.1]) }
    }

    #[test]
    fn poses_form_a_group() {
        let (a, b, c) = (pose(0.1), pose(0.4), pose(-0.7));
        let (left, right) = ((a * b) * c, a * (b * c));
        assert!((left.r - right.r).norm() + (left.p - right.p).norm() < 1e-14);
        let e = a * a.inverse();
        assert!((e.r - E3::identity()).norm() + e.p.norm() < 1e-14);
    }

    #[test]
    fn power_is_invariant_so_cross_and_cross_force_are_dual() {
        let (v, m) = (motion(0.3), motion(-0.8));
        let f = Force::<E3> { n: E3::spin([1.0, 2.0, -0.5]), f: E3::vector(&[0.3, -2.0, 1.4]) };
        // d/dt (f · m) = 0 for wrench and twist carried along: (V ×* f)·m + f·(V × m) = 0
        assert!((v.cross_force(f).power(m) + f.power(v.cross(m))).abs() < 1e-13);
    }

    #[test]
    fn kinetic_energy_is_that_of_the_particles() {
        let body =
            MassProperties::<E3> { mass: 2.0, com: E3::vector(&[0.1, 0.2, -0.3]), inertia: E3::tensor([0.4, 0.5, 0.3, 0.02, -0.01, 0.03]) };
        let other = MassProperties::<E3> { mass: 3.0, com: E3::vector(&[-0.5, 0.1, 0.2]), inertia: E3::tensor([0.0; 6]) };
        let (x, v) = (pose(0.2), motion(0.6));
        let joined = body.join(other).in_world(x);
        let mut sum = body.in_world(x);
        sum += other.in_world(x);
        assert!(((joined * v).power(v) - (sum * v).power(v)).abs() < 1e-13);
        let particle = other.in_world(x);
        let speed = v.at(x.point(other.com));
        assert!(((particle * v).power(v) - 3.0 * speed.norm_squared()).abs() < 1e-13);
    }

    #[test]
    fn the_rate_of_momentum_is_that_of_the_product() {
        let body =
            MassProperties::<E3> { mass: 2.0, com: E3::vector(&[0.1, 0.2, -0.3]), inertia: E3::tensor([0.4, 0.5, 0.3, 0.02, -0.01, 0.03]) };
        let (i, v, a) = (body.in_world(pose(0.2)), motion(0.6), motion(-1.7));
        let (rate, product) = (i.momentum_rate(a, v), i * a + v.cross_force(i * v));
        assert!((rate.n - product.n).norm() + (rate.f - product.f).norm() < 1e-14);
    }

    #[test]
    fn a_body_that_travels_fast_turns_as_one_at_rest() {
        let body = MassProperties::<E3> { mass: 2.0, com: E3::vector(&[0.0; 3]), inertia: E3::tensor([0.4, 0.5, 0.3, 0.0, 0.0, 0.0]) };
        let inertia = body.in_world(Pose { p: E3::vector(&[0.0; 3]), ..pose(0.2) });
        let still = Motion::<E3> { v: E3::vector(&[0.0; 3]), ..motion(0.6) };
        let travels = E3::vector(&[1e6, -3e5, 7e5]);
        let fast = inertia.momentum_rate(Motion { w: still.w, v: -E3::turn(still.w, travels) }, Motion { v: travels, ..still });
        assert!((fast.n - inertia.momentum_rate(Motion { w: still.w, v: still.v }, still).n).norm() < 1e-14);
    }

    #[test]
    fn planar_is_spatial_about_z() {
        type E2 = Planar<f64>;
        let (a2, a3) = (E2::hinge(1.0, 0.7), E3::hinge(E3::spin([0.0, 0.0, 1.0]), 0.7));
        let (p2, p3) = (E2::vector(&[0.3, -0.2]), E3::vector(&[0.3, -0.2, 0.0]));
        let (x2, x3) = (Pose::<E2> { r: a2, p: p2 }, Pose::<E3> { r: a3, p: p3 });
        let b2 = MassProperties::<E2> { mass: 2.0, com: E2::vector(&[0.5, 0.1]), inertia: 0.3 };
        let b3 = MassProperties::<E3> { mass: 2.0, com: E3::vector(&[0.5, 0.1]), inertia: E3::tensor([0.1, 0.2, 0.3, 0.0, 0.0, 0.0]) };
        let (v2, v3) = (
            Motion::<E2> { w: 1.3, v: E2::vector(&[0.4, -0.9]) },
            Motion::<E3> { w: E3::spin([0.0, 0.0, 1.3]), v: E3::vector(&[0.4, -0.9]) },
        );
        let (f2, f3) = (v2.cross_force(b2.in_world(x2) * v2), v3.cross_force(b3.in_world(x3) * v3));
        assert!((f2.n - f3.n.z).abs() + (f2.f.x - f3.f.x).abs() + (f2.f.y - f3.f.y).abs() < 1e-14);
    }
}
