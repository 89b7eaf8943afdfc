//! The crank-rocker O-A-B-C with a loaded tip D on the line C-B, its crank at constant speed.
//!
//! Unit vectors u1, u2, u3 along the crank O-A, the coupler A-B and the rocker C-B; n = u turned by a quarter; ωr = ψ' is the
//! rocker's rate, counter-clockwise. The loop l1 u1 + l2 u2 = l e_x + l3 u3 and its two derivatives,
//!
//!     l1 ω n1 + l2 ω2 n2 = l3 ωr n3
//!     l2 α2 n2 − l1 ω² u1 − l2 ω2² u2 = l3 αr n3 − l3 ωr² u3,
//!
//! give ω2, α2 when multiplied by u3 and ωr, αr when multiplied by u2. The force b of the coupler on the rocker follows from
//! the moments of the rocker about C and of the coupler about A, two equations in its parts along u2 and u3:
//!
//!     l3 u3 × b = R3 = I3 αr + S3 (g e_y)·n3 + load · radius      (the load acts along −n3)
//!     l2 u2 × b = R2 = −(I2 α2 + (l2/2) m2 u2 × (a2 + g e_y))
//!
//! and the others from the sums of forces. φ3 = 90° − ψ is clockwise from the vertical.

use super::plane::{Vector, add, cross, dot, normal, scale, size, sub};
use std::f64::consts::FRAC_PI_2;

/// What the model file calls its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parameters {
    pub(crate) l1: f64,
    pub(crate) l2: f64,
    pub(crate) l3: f64,
    pub(crate) l_tip: f64,
    pub(crate) l: f64,
    pub(crate) m1: f64,
    pub(crate) m2: f64,
    pub(crate) m3: f64,
    pub(crate) m_tip: f64,
    pub(crate) g_earth: f64,
    pub(crate) speed: f64,
    pub(crate) load_max: f64,
    pub(crate) load_angle: f64,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            l1: 0.15,
            l2: 1.0,
            l3: 0.55,
            l_tip: 0.15,
            l: 1.0,
            m1: 30.0,
            m2: 60.0,
            m3: 60.0,
            m_tip: 90.0,
            g_earth: 9.81,
            speed: 240.0 * std::f64::consts::TAU / 60.0,
            load_max: 3000.0,
            load_angle: (-10.0_f64).to_radians(),
        }
    }
}

/// Whether the tip load acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Load {
    /// As φ3 and its rate say.
    ByState,
    /// As on the side of a switch where it acts.
    On,
    /// As on the side where it does not.
    Off,
}

/// Positions, velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) u1: Vector,
    pub(crate) u2: Vector,
    pub(crate) u3: Vector,
    pub(crate) phi2: f64,
    pub(crate) phi3: f64,
    pub(crate) omega2: f64,
    pub(crate) omega3: f64,
    pub(crate) alpha2: f64,
    pub(crate) alpha3: f64,
}

/// Forces at the joints, each on the later body of the chain by the earlier one, and what drives the crank.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forces {
    pub(crate) tip_force: f64,
    pub(crate) o: Vector,
    pub(crate) a: Vector,
    pub(crate) b: Vector,
    pub(crate) c: Vector,
    pub(crate) torque: f64,
}

/// Names of the columns of [`CrankRocker::row`].
pub(crate) const COLUMNS: [&str; 41] = [
    "theta",
    "time",
    "phi2",
    "phi3",
    "omega2",
    "omega3",
    "alpha2",
    "alpha3",
    "det_J",
    "tip_speed",
    "tip_acc_tangential",
    "tip_acc_centripetal",
    "tip_acc",
    "com.x",
    "com.y",
    "com.vx",
    "com.vy",
    "com.ax",
    "com.ay",
    "inertia_eq",
    "inertia_eq_slope",
    "O.fx",
    "O.fy",
    "O.f",
    "A.fx",
    "A.fy",
    "A.f",
    "B.fx",
    "B.fy",
    "B.f",
    "C.fx",
    "C.fy",
    "C.f",
    "drive.torque",
    "drive.power",
    "shaking.fx",
    "shaking.fy",
    "shaking.f",
    "frame.fx",
    "frame.fy",
    "tip_force",
];

/// One crank-rocker with what does not change while it turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrankRocker {
    pub(crate) p: Parameters,
    /// +1: B above the line A-C (seen from A to C, on the left); −1: below.
    pub(crate) side: f64,
    /// C-D, m.
    pub(crate) radius: f64,
    /// Rear extreme of φ3; for lengths that cannot turn the clamped figure of the model.
    pub(crate) phi3_min: f64,
    /// N/rad.
    load_slope: f64,
    /// Of the coupler about its middle, kg m².
    i2: f64,
    /// Of the rocker with the tip mass about C, kg m².
    i3: f64,
    /// First moment of the rocker with the tip mass about C, kg m.
    s3: f64,
    /// l2² − l3².
    difference: f64,
    l2_squared: f64,
    inverse_l2: f64,
    inverse_l3: f64,
    speed_squared: f64,
}

impl CrankRocker {
    pub(crate) fn new(p: Parameters) -> Self {
        let radius = p.l3 + p.l_tip;
        let cosine = (p.l * p.l + p.l3 * p.l3 - (p.l2 - p.l1) * (p.l2 - p.l1)) / (2.0 * p.l * p.l3);
        let phi3_min = cosine.clamp(-1.0, 1.0).acos() - FRAC_PI_2;
        Self {
            p,
            side: 1.0,
            radius,
            phi3_min,
            load_slope: p.load_max / (phi3_min - p.load_angle),
            i2: p.m2 * p.l2 * p.l2 / 12.0,
            i3: (p.m3 / 3.0 + p.m_tip) * radius * radius,
            s3: (0.5 * p.m3 + p.m_tip) * radius,
            difference: p.l2 * p.l2 - p.l3 * p.l3,
            l2_squared: p.l2 * p.l2,
            inverse_l2: 1.0 / p.l2,
            inverse_l3: 1.0 / p.l3,
            speed_squared: p.speed * p.speed,
        }
    }

    /// Position, velocity and acceleration at the crank angle `theta`; NaN where the loop does not close.
    #[inline]
    pub(crate) fn motion(&self, theta: f64) -> Motion {
        let p = &self.p;
        let (sin, cos) = theta.sin_cos();
        let u1 = [cos, sin];
        // B lies x A-C + y n(A-C) from A
        let ac = [p.l - p.l1 * cos, -p.l1 * sin];
        let inverse = 1.0 / dot(ac, ac);
        let x = 0.5 + 0.5 * self.difference * inverse;
        let y = self.side * (self.l2_squared * inverse - x * x).sqrt();
        let ab = [x * ac[0] - y * ac[1], x * ac[1] + y * ac[0]];
        let u2 = scale(ab, self.inverse_l2);
        let u3 = scale(sub(ab, ac), self.inverse_l3);

        let (c12, c13, c23) = (cross(u1, u2), cross(u1, u3), cross(u2, u3));
        let (d12, d13, d23) = (dot(u1, u2), dot(u1, u3), dot(u2, u3));
        let inverse = 1.0 / c23;
        let v1 = p.l1 * p.speed;
        let l2_omega2 = -v1 * c13 * inverse;
        let l3_omega_r = -v1 * c12 * inverse;
        let (omega2, omega_r) = (l2_omega2 * self.inverse_l2, l3_omega_r * self.inverse_l3);
        let (a1, a2, a3) = (p.l1 * self.speed_squared, l2_omega2 * omega2, l3_omega_r * omega_r);
        let alpha2 = (a1 * d13 + a2 * d23 - a3) * inverse * self.inverse_l2;
        let alpha_r = (a1 * d12 + a2 - a3 * d23) * inverse * self.inverse_l3;
        Motion { u1, u2, u3, phi2: u2[1].atan2(u2[0]), phi3: u3[0].atan2(u3[1]), omega2, omega3: -omega_r, alpha2, alpha3: -alpha_r }
    }

    /// Size of the tip load.
    #[inline]
    pub(crate) fn tip_force(&self, m: &Motion, load: Load) -> f64 {
        let acts = match load {
            Load::ByState => m.phi3 <= self.p.load_angle && m.omega3 <= 0.0,
            Load::On => true,
            Load::Off => false,
        };
        if acts { self.load_slope * (m.phi3 - self.p.load_angle) } else { 0.0 }
    }

    /// All joint forces and the driving torque.
    #[inline]
    pub(crate) fn forces(&self, m: &Motion, load: Load) -> Forces {
        let p = &self.p;
        let tip_force = self.tip_force(m, load);
        let (n2, n3) = (normal(m.u2), normal(m.u3));
        // accelerations less gravity
        let at_a = scale(m.u1, -p.l1 * self.speed_squared);
        let half = 0.5 * p.l2;
        let w2 = m.omega2 * m.omega2;
        let a1 = [0.5 * at_a[0], 0.5 * at_a[1] + p.g_earth];
        let a2 = [at_a[0] + half * (m.alpha2 * n2[0] - w2 * m.u2[0]), at_a[1] + half * (m.alpha2 * n2[1] - w2 * m.u2[1]) + p.g_earth];
        // moments of the rocker about C and of the coupler about A
        let r3 = self.i3 * -m.alpha3 + self.s3 * p.g_earth * n3[1] + tip_force * self.radius;
        let r2 = -(self.i2 * m.alpha2 + half * p.m2 * cross(m.u2, a2));
        let inverse = 1.0 / cross(m.u2, m.u3);
        let along2 = -r3 * self.inverse_l3 * inverse;
        let along3 = r2 * self.inverse_l2 * inverse;
        let b = [along2 * m.u2[0] + along3 * m.u3[0], along2 * m.u2[1] + along3 * m.u3[1]];
        let a = [p.m2 * a2[0] + b[0], p.m2 * a2[1] + b[1]];
        let o = [p.m1 * a1[0] + a[0], p.m1 * a1[1] + a[1]];
        let w3 = m.omega3 * m.omega3;
        let weight = (p.m3 + p.m_tip) * p.g_earth;
        let c = [
            self.s3 * (-m.alpha3 * n3[0] - w3 * m.u3[0]) + tip_force * n3[0] - b[0],
            self.s3 * (-m.alpha3 * n3[1] - w3 * m.u3[1]) + weight + tip_force * n3[1] - b[1],
        ];
        let torque = p.l1 * cross(m.u1, a) + 0.5 * p.l1 * p.m1 * p.g_earth * m.u1[0];
        Forces { tip_force, o, a, b, c, torque }
    }

    /// Position, velocity, acceleration, all reactions and the torque: one sample.
    #[inline]
    pub(crate) fn sample(&self, theta: f64, load: Load) -> (Motion, Forces) {
        let motion = self.motion(theta);
        (motion, self.forces(&motion, load))
    }

    /// Force of the load on the tip.
    pub(crate) fn tip_load(&self, m: &Motion, load: Load) -> Vector {
        scale(normal(m.u3), -self.tip_force(m, load))
    }

    /// Centre of mass: position, velocity, acceleration.
    pub(crate) fn centre(&self, m: &Motion) -> [Vector; 3] {
        let p = &self.p;
        let total = self.mass();
        let (omega_r, alpha_r) = (-m.omega3, -m.alpha3);
        // first moments along u1, u2 and u3; the coupler's origin rides on A
        let (s1, s2, s3) = ((0.5 * p.m1 + p.m2) * p.l1, 0.5 * p.m2 * p.l2, self.s3);
        let at = |k: [f64; 3], [a, b, c]: [Vector; 3]| scale(add(add(scale(a, k[0]), scale(b, k[1])), scale(c, k[2])), 1.0 / total);
        let radial = [m.u1, m.u2, m.u3];
        let tangential = [normal(m.u1), normal(m.u2), normal(m.u3)];
        let position = add(at([s1, s2, s3], radial), [(p.m3 + p.m_tip) * p.l / total, 0.0]);
        let velocity = at([s1 * p.speed, s2 * m.omega2, s3 * omega_r], tangential);
        let acceleration = add(
            at([0.0, s2 * m.alpha2, s3 * alpha_r], tangential),
            at([-s1 * self.speed_squared, -s2 * m.omega2 * m.omega2, -s3 * omega_r * omega_r], radial),
        );
        [position, velocity, acceleration]
    }

    /// All that moves, kg.
    pub(crate) fn mass(&self) -> f64 {
        self.p.m1 + self.p.m2 + self.p.m3 + self.p.m_tip
    }

    /// 2T/ω² and its derivative by the crank angle: T' ω = Σ m v·a + I ω α at constant speed.
    pub(crate) fn inertia(&self, m: &Motion) -> [f64; 2] {
        let p = &self.p;
        let (n1, n2) = (normal(m.u1), normal(m.u2));
        let half = 0.5 * p.l2;
        let velocity = add(scale(n1, p.l1 * p.speed), scale(n2, half * m.omega2));
        let acceleration =
            add(scale(m.u1, -p.l1 * self.speed_squared), sub(scale(n2, half * m.alpha2), scale(m.u2, half * m.omega2 * m.omega2)));
        let crank = p.m1 * p.l1 * p.l1 / 3.0 * self.speed_squared;
        let coupler = p.m2 * dot(velocity, velocity) + self.i2 * m.omega2 * m.omega2;
        let rocker = self.i3 * m.omega3 * m.omega3;
        let power = p.m2 * dot(velocity, acceleration) + self.i2 * m.omega2 * m.alpha2 + self.i3 * m.omega3 * m.alpha3;
        [(crank + coupler + rocker) / self.speed_squared, 2.0 * power / (self.speed_squared * p.speed)]
    }

    /// Everything of [`COLUMNS`]; time from θ = 0, angles as `atan2` gives them.
    pub(crate) fn row(&self, theta: f64, load: Load) -> [f64; COLUMNS.len()] {
        let (m, f) = self.sample(theta, load);
        let [position, velocity, acceleration] = self.centre(&m);
        let [inertia, slope] = self.inertia(&m);
        let (tangential, centripetal) = (self.radius * m.alpha3, self.radius * m.omega3 * m.omega3);
        let shaking = scale(acceleration, self.mass());
        [
            theta,
            theta / self.p.speed,
            m.phi2,
            m.phi3,
            m.omega2,
            m.omega3,
            m.alpha2,
            m.alpha3,
            self.p.l2 * self.p.l3 * cross(m.u2, m.u3),
            self.radius * m.omega3,
            tangential,
            centripetal,
            size([tangential, centripetal]),
            position[0],
            position[1],
            velocity[0],
            velocity[1],
            acceleration[0],
            acceleration[1],
            inertia,
            slope,
            f.o[0],
            f.o[1],
            size(f.o),
            f.a[0],
            f.a[1],
            size(f.a),
            f.b[0],
            f.b[1],
            size(f.b),
            f.c[0],
            f.c[1],
            size(f.c),
            f.torque,
            f.torque * self.p.speed,
            shaking[0],
            shaking[1],
            size(shaking),
            -(f.o[0] + f.c[0]),
            -(f.o[1] + f.c[1]),
            f.tip_force,
        ]
    }

    /// The crank angles in [from, from + 2π) where the load may begin or end, ascending: φ3 passes the load's angle, or turns.
    ///
    /// With B where φ3 is the load's angle, |A-B| = l2 says that B · A = (l1² + |B|² − l2²)/2. φ3 turns where crank and coupler
    /// are in one line: |O-B| = l2 ± l1.
    pub(crate) fn switches(&self, from: f64) -> Vec<f64> {
        let p = &self.p;
        let mut found = Vec::new();
        let mut put = |theta: f64| {
            if theta.is_finite() {
                found.push(from + (theta - from).rem_euclid(std::f64::consts::TAU));
            }
        };
        let (sin, cos) = p.load_angle.sin_cos();
        let b = [p.l + p.l3 * sin, p.l3 * cos];
        let direction = b[1].atan2(b[0]);
        let spread = ((p.l1 * p.l1 + dot(b, b) - p.l2 * p.l2) / (2.0 * p.l1 * size(b))).acos();
        put(direction + spread);
        put(direction - spread);
        for (reach, turn) in [(p.l2 + p.l1, 0.0), (p.l2 - p.l1, std::f64::consts::PI)] {
            // direction of B from O in the triangle O-C-B
            let angle = ((p.l * p.l + reach * reach - p.l3 * p.l3) / (2.0 * p.l * reach)).acos();
            put(angle + turn);
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// The crank angles nearest to `start`, below and above, where the crank cannot go further; none where it turns fully.
    ///
    /// Coupler and rocker are in one line where |A-C| = l2 + l3 or |l2 − l3|.
    pub(crate) fn reach(&self, start: f64) -> Option<[f64; 2]> {
        let p = &self.p;
        let (mut below, mut above) = (f64::NEG_INFINITY, f64::INFINITY);
        for distance in [p.l2 + p.l3, p.l2 - p.l3] {
            let cosine = (p.l * p.l + p.l1 * p.l1 - distance * distance) / (2.0 * p.l * p.l1);
            // at ±1 itself the crank passes a change point
            if cosine.abs() >= 1.0 - 1e-12 {
                continue;
            }
            for limit in [cosine.acos(), -cosine.acos()] {
                let ahead = (limit - start).rem_euclid(std::f64::consts::TAU);
                above = above.min(start + ahead);
                below = below.max(start + ahead - std::f64::consts::TAU);
            }
        }
        above.is_finite().then_some([below, above])
    }

    /// Work of the driver in one turn: what the load takes, which rises linearly from its angle to the rear extreme. For lengths
    /// whose crank turns while the rocker swings.
    pub(crate) fn work_per_turn(&self) -> f64 {
        let p = &self.p;
        let reach = p.l2 + p.l1;
        let phi3_max = ((p.l * p.l + p.l3 * p.l3 - reach * reach) / (2.0 * p.l * p.l3)).acos() - FRAC_PI_2;
        let from = p.load_angle.min(phi3_max);
        if from <= self.phi3_min {
            return 0.0;
        }
        let force = |phi3: f64| self.load_slope * (phi3 - p.load_angle);
        0.5 * (force(from) + force(self.phi3_min)) * (from - self.phi3_min) * self.radius
    }

    /// Signed distances of counterweights of `kappa` kg on the crank and `lambda` kg on the rocker that hold the centre of mass,
    /// and where they hold it.
    pub(crate) fn balance(&self, kappa: f64, lambda: f64) -> ([f64; 2], Vector) {
        let p = &self.p;
        // the loop turns the coupler's share into halves at A and B
        let crank = -0.5 * (p.m1 + p.m2) * p.l1 / kappa;
        let rocker = -(0.5 * p.m2 * p.l3 + self.s3) / lambda;
        let x = (0.5 * p.m2 + p.m3 + p.m_tip + lambda) * p.l / (self.mass() + kappa + lambda);
        ([crank, rocker], [x, 0.0])
    }
}
