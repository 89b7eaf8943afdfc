//! A gauge: a scalar x that is measured between two bodies a and b, and the unit wrench that works on it.
//!
//! Everything that constrains, drives or pulls does so through gauges: a joint row is a gauge that stays at its target, a
//! driver one that follows a function of time, a spring one with a force. With twists V and accelerations A of the bodies,
//!
//! ```text
//! ẋ = W · (V_b − V_a),      ẍ = W · (A_b − A_a) + c,
//! ```
//!
//! where W is the unit wrench on b (−W acts on a: every gauge's force is a pair in one line), all about the reference point of the
//! group that a and b belong to (`group.rs`), places being measured from there, and the drift c collects
//! what the velocities alone contribute. With points p, d = p_b − p_a, directions carried by their bodies, ṗ = v + ω×p and
//! p̈ = v̇ + ω̇×p + ω×ṗ:
//!
//! | gauge | x | W on b (moment, force) | c |
//! |---|---|---|---|
//! | slide | n·d, n in a | (p_b×n, n) | n·(ω_b×ṗ_b − ω_a×ṗ_a) + 2ṅ·ḋ + (ω_a×ṅ)·d |
//! | distance | \|d\| | (p_b×n, n), n = d/\|d\| | n·(ω_b×ṗ_b − ω_a×ṗ_a) + (ḋ² − (n·ḋ)²)/\|d\| |
//! | dot | u·w, u in a, w in b | (w×u, 0) | (ω_a×u̇)·w + 2u̇·ẇ + u·(ω_b×ẇ) |
//! | angle (planar) | difference of angles | (1, 0) | 0 |
//! | turn (spatial) | atan2(f·e₂, f·e₁) + 2πk, e in a, f in b | of both dots | of both dots |
//! | quaternion (spatial) | a component of the body's unit quaternion Q | that of ½ (0, ω) ∘ Q | −¼ \|ω\|² x |
//! | coordinate | a tree coordinate q_k | that of its axis | 0 |

use crate::geometry::{Force, Motion, Pose, Quaternion, Space};
use crate::scalar::Scalar;

/// A coordinate axis of a tree joint: which coordinate, and whether it turns or slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Index in q.
    pub q: usize,
    /// Index in v.
    pub v: usize,
    /// True if the coordinate is an angle.
    pub turns: bool,
    /// −1 if the child of the tree is the joint's first body, so that the column moves the child the other way.
    pub sign: f64,
}

/// What a gauge measures; points and directions in the frame of the body named.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measured<G: Space> {
    /// Component of p_b − p_a along n, all of a but p_b.
    Slide {
        /// Point of a.
        pa: G::Vector,
        /// Unit direction in a.
        n: G::Vector,
        /// Point of b.
        pb: G::Vector,
    },
    /// Distance of two points, m.
    Distance {
        /// Point of a.
        pa: G::Vector,
        /// Point of b.
        pb: G::Vector,
    },
    /// Cosine between a direction of a and one of b.
    Dot {
        /// Unit direction in a.
        u: G::Vector,
        /// Unit direction in b.
        w: G::Vector,
    },
    /// Planar: unwrapped angle of b relative to a, rad.
    Angle,
    /// Spatial: angle of the direction f of b in the plane (e₁, e₂) of a, rad; `winding` is the mode that counts half turns.
    Turn {
        /// First direction in a.
        e1: G::Vector,
        /// Second direction in a, the axis being e₁ × e₂.
        e2: G::Vector,
        /// Direction in b.
        f: G::Vector,
        /// Index of its winding number.
        winding: usize,
    },
    /// Spatial: a component (w, x, y, z) of the unit quaternion of b in the world; `sign` is the mode that tells which of the two it is.
    Quaternion {
        /// Which component.
        component: usize,
        /// Index of its sign among the winding numbers, one for each body.
        sign: usize,
    },
    /// A coordinate of the tree, with the joint's point of b.
    Coordinate {
        /// Which, and how it moves.
        along: Along,
        /// Point of b where a sliding axis is worked on.
        pb: G::Vector,
    },
}

/// A gauge between two bodies.
#[derive(Clone, Debug)]
pub struct Gauge<G: Space> {
    /// First body; 0 is the ground.
    pub a: usize,
    /// Second body.
    pub b: usize,
    /// What is measured.
    pub measured: Measured<G>,
    /// Added to a geometric value (not to a coordinate, whose joint frames hold it): the joint's `zero`.
    pub shift: f64,
    /// Velocity columns it depends on, with +1 for those that move b and −1 for those that move a; common ones cancel.
    pub columns: Vec<(usize, f64)>,
    /// Whether it is a slide between the points of the slide before it, which has moved them already: a pin off the tree is two or three
    /// slides between two points.
    pub same_points: bool,
}

/// How two points move against each other: what slides between them share.
#[derive(Clone, Copy, Debug, Default)]
pub struct Relative<G: Space> {
    /// ω_a.
    turn: G::Spin,
    /// d.
    apart: G::Vector,
    /// ḋ.
    rate: G::Vector,
    /// ω_b×ṗ_b − ω_a×ṗ_a.
    whirl: G::Vector,
    /// V_b − V_a.
    twist: Motion<G>,
    /// The same of their biases.
    bias: Motion<G>,
}

impl<G: Space> Relative<G> {
    #[inline(always)]
    fn of([pa, pb]: [G::Vector; 2], [va, vb]: [Motion<G>; 2], [bias_a, bias_b]: [Motion<G>; 2]) -> Self {
        let (da, db) = (va.at(pa), vb.at(pb));
        Self {
            turn: va.w,
            apart: pb - pa,
            rate: db - da,
            whirl: G::turn(vb.w, db) - G::turn(va.w, da),
            twist: vb - va,
            bias: bias_b - bias_a,
        }
    }
}

/// Value and wrench of a gauge, and from the velocity stage on its rate and drift.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading<G: Space> {
    /// x.
    pub x: G::S,
    /// Unit wrench on b.
    pub wrench: Force<G>,
    /// Points of a and b from the reference point, where the gauge has them.
    pub points: [G::Vector; 2],
    /// ẋ.
    pub rate: G::S,
    /// ẍ at a = 0: c and what the bias of the bodies adds.
    pub drift: G::S,
}

impl<G: Space> Reading<G> {
    /// ẋ and ẍ at a = 0 from V_b − V_a, from the bias of b against a, with which the bodies accelerate even at a = 0, and from c.
    #[inline(always)]
    fn moves(&mut self, twist: Motion<G>, bias: Motion<G>, c: G::S) {
        (self.rate, self.drift) = (self.wrench.power(twist), c + self.wrench.power(bias));
    }
}

/// Where the bodies of a mechanism are, as gauges see them.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a, G: Space> {
    /// Pose of each body, from the reference point of its group.
    pub places: &'a [Pose<G>],
    /// Unit quaternion of each body, if a gauge needs them.
    pub quaternions: &'a [Quaternion<G::S>],
    /// Tree coordinates (nq).
    pub q: &'a [G::S],
    /// Columns (nv).
    pub columns: &'a [Motion<G>],
    /// Winding numbers.
    pub windings: &'a [i32],
}

impl<G: Space> Gauge<G> {
    /// Whether it counts in rad; else in m. Cosines and components of quaternions count as angles.
    pub fn turns(&self) -> bool {
        match self.measured {
            Measured::Coordinate { along, .. } => along.turns,
            Measured::Slide { .. } | Measured::Distance { .. } => false,
            Measured::Dot { .. } | Measured::Angle | Measured::Turn { .. } | Measured::Quaternion { .. } => true,
        }
    }

    /// x and W from where the bodies are, about the `reference` point of the group; `points` are those of the gauge before, and of this one
    /// behind it.
    #[inline(always)]
    pub fn position(&self, placed: Placed<'_, G>, reference: &G::Vector, points: &mut [G::Vector; 2], out: &mut Reading<G>) {
        let Placed { places, quaternions, q, columns: s, windings } = placed;
        let turned = |body: usize| if body == 0 { G::identity() } else { places[body].r };
        let point = |body: usize, r: G::Vector| if body == 0 { r - *reference } else { places[body].point(r) };
        let shift = G::S::constant(self.shift);
        match self.measured {
            Measured::Coordinate { along, pb } => {
                out.x = q[along.q];
                let column = s[along.v] * G::S::constant(along.sign);
                // a turning axis is worked on by a moment about it, a sliding one by a force along it at the second point
                out.wrench = if along.turns { Force::couple(column.w) } else { Force::at(column.v, point(self.b, pb)) };
            }
            Measured::Slide { pa, n, pb } => {
                if !self.same_points {
                    *points = [point(self.a, pa), point(self.b, pb)];
                }
                let ([pa, pb], n) = (*points, G::rotate(turned(self.a), n));
                out.x = G::dot(n, pb - pa) + shift;
                out.wrench = Force::at(n, pb);
                out.points = *points;
            }
            Measured::Distance { pa, pb } => {
                let (pa, pb) = (point(self.a, pa), point(self.b, pb));
                let d = pb - pa;
                out.x = G::dot(d, d).sqrt();
                // coinciding points have no line of action: no force rather than no number
                let k = if out.x.value() == 0.0 { G::S::default() } else { G::S::constant(1.0) / out.x };
                out.wrench = Force::at(d * k, pb);
                out.points = [pa, pb];
            }
            Measured::Dot { u, w } => {
                let (u, w) = (G::rotate(turned(self.a), u), G::rotate(turned(self.b), w));
                out.x = G::dot(u, w);
                out.wrench = Force::couple(G::moment(w, u));
            }
            Measured::Angle => {
                out.x = G::angle(turned(self.b)) - G::angle(turned(self.a)) + shift;
                out.wrench = Force::couple(G::spin([0.0, 0.0, 1.0]));
            }
            Measured::Turn { e1, e2, f, winding } => {
                let r = turned(self.a);
                let (e1, e2, f) = (G::rotate(r, e1), G::rotate(r, e2), G::rotate(turned(self.b), f));
                let (c, s) = (G::dot(f, e1), G::dot(f, e2));
                // measured from the half turn counted, so that the value is smooth a quarter turn beyond it on either side
                let half = windings[winding];
                let sign = if half & 1 == 0 { 1.0 } else { -1.0 };
                out.x = s.scale(sign).atan2(c.scale(sign)) + G::S::constant(self.shift + std::f64::consts::PI * f64::from(half));
                // θ̇ = (c ṡ − s ċ)/(c² + s²)
                let k = G::S::constant(1.0) / (c * c + s * s);
                out.wrench = Force::couple((G::moment(f, e2) * c - G::moment(f, e1) * s) * k);
            }
            Measured::Quaternion { component, sign } => {
                let unit = quaternions[self.b].signed(windings[sign]);
                out.x = unit.0[component];
                let slope = unit.slope(component);
                let axis = |k: usize| G::spin(std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 })) * slope[k];
                out.wrench = Force::couple(axis(0) + axis(1) + axis(2));
            }
        }
    }

    /// ẋ and c from the twists and biases of the bodies; after [`Gauge::position`]. `relative` is of the gauge before, and of this one
    /// behind it.
    #[inline(always)]
    pub fn velocity(
        &self,
        places: &[Pose<G>],
        [twists, bias]: [&[Motion<G>]; 2],
        v: &[G::S],
        relative: &mut Relative<G>,
        out: &mut Reading<G>,
    ) {
        let two = G::S::constant(2.0);
        let of = |motions: &[Motion<G>]| [motions[self.a], motions[self.b]];
        let spins = || (twists[self.a].w, twists[self.b].w);
        let c = match self.measured {
            Measured::Coordinate { along, .. } => {
                out.rate = v[along.v];
                out.drift = G::S::default();
                return;
            }
            Measured::Slide { .. } => {
                if !self.same_points {
                    *relative = Relative::of(out.points, of(twists), of(bias));
                }
                let n = out.wrench.f;
                let dn = G::turn(relative.turn, n);
                let c = G::dot(n, relative.whirl) + two * G::dot(dn, relative.rate) + G::dot(G::turn(relative.turn, dn), relative.apart);
                return out.moves(relative.twist, relative.bias, c);
            }
            Measured::Distance { .. } => {
                let between = Relative::of(out.points, of(twists), of(bias));
                let (n, rate) = (out.wrench.f, between.rate);
                let along = G::dot(n, rate);
                let across = G::dot(rate, rate) - along * along;
                let turning = if out.x.value() == 0.0 { G::S::default() } else { across / out.x };
                return out.moves(between.twist, between.bias, G::dot(n, between.whirl) + turning);
            }
            Measured::Angle => G::S::default(),
            Measured::Dot { u, w } => {
                let (u, w) = (G::rotate(places[self.a].r, u), G::rotate(places[self.b].r, w));
                dot_rates::<G>(spins(), u, w).1
            }
            Measured::Turn { e1, e2, f, .. } => {
                let (r, f) = (places[self.a].r, G::rotate(places[self.b].r, f));
                let (e1, e2) = (G::rotate(r, e1), G::rotate(r, e2));
                let (c, s) = (G::dot(f, e1), G::dot(f, e2));
                let ((dc, ddc), (ds, dds)) = (dot_rates::<G>(spins(), e1, f), dot_rates::<G>(spins(), e2, f));
                let k = G::S::constant(1.0) / (c * c + s * s);
                let rate = (c * ds - s * dc) * k;
                // θ̈ = (c s̈ − s c̈)/r² − 2 θ̇ (c ċ + s ṡ)/r²
                (c * dds - s * ddc) * k - two * rate * (c * dc + s * ds) * k
            }
            // Q̈ = ½ (0, α) ∘ Q + ½ (0, ω) ∘ Q̇ and (0, ω) ∘ (0, ω) = −|ω|²
            Measured::Quaternion { .. } => {
                let spin = twists[self.b].w;
                -(G::dot_spin(spin, spin) * out.x).scale(0.25)
            }
        };
        // what turns is worked on by a couple
        let couple = |motions: &[Motion<G>]| G::dot_spin(out.wrench.n, motions[self.b].w - motions[self.a].w);
        (out.rate, out.drift) = (couple(twists), c + couple(bias));
    }

    /// ẍ from the accelerations a (nv); after [`Gauge::velocity`].
    #[must_use]
    pub fn acceleration(&self, reading: &Reading<G>, s: &[Motion<G>], a: &[G::S]) -> G::S {
        let mut sum = reading.drift;
        self.project(reading, s, |k, x| sum += x * a[k]);
        sum
    }

    /// ∂ẋ/∂v_k for the columns of the gauge, written by `put(k, value)`.
    #[inline(always)]
    pub fn project(&self, reading: &Reading<G>, s: &[Motion<G>], mut put: impl FnMut(usize, G::S)) {
        if let Measured::Coordinate { along, .. } = self.measured {
            put(along.v, G::S::constant(1.0));
            return;
        }
        for &(k, sign) in &self.columns {
            put(k, reading.wrench.power(s[k]).scale(sign));
        }
    }

    /// The same gauge on another scalar.
    #[must_use]
    pub fn lift<D: Scalar>(&self) -> Gauge<G::Lift<D>> {
        let v = |x| G::lift_vector::<D>(x);
        let measured = match self.measured {
            Measured::Slide { pa, n, pb } => Measured::Slide { pa: v(pa), n: v(n), pb: v(pb) },
            Measured::Distance { pa, pb } => Measured::Distance { pa: v(pa), pb: v(pb) },
            Measured::Dot { u, w } => Measured::Dot { u: v(u), w: v(w) },
            Measured::Angle => Measured::Angle,
            Measured::Turn { e1, e2, f, winding } => Measured::Turn { e1: v(e1), e2: v(e2), f: v(f), winding },
            Measured::Quaternion { component, sign } => Measured::Quaternion { component, sign },
            Measured::Coordinate { along, pb } => Measured::Coordinate { along, pb: v(pb) },
        };
        Gauge { a: self.a, b: self.b, measured, shift: self.shift, columns: self.columns.clone(), same_points: self.same_points }
    }
}

/// d/dt (u·w) and its drift for u carried by a and w by b.
#[inline]
fn dot_rates<G: Space>((wa, wb): (G::Spin, G::Spin), u: G::Vector, w: G::Vector) -> (G::S, G::S) {
    let (du, dw) = (G::turn(wa, u), G::turn(wb, w));
    let rate = G::dot(du, w) + G::dot(u, dw);
    let drift = G::dot(G::turn(wa, du), w) + G::S::constant(2.0) * G::dot(du, dw) + G::dot(u, G::turn(wb, dw));
    (rate, drift)
}
