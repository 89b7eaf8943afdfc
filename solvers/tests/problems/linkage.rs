//! Planar linkages of rigid bodies in absolute coordinates: position of the mass centre and angle of each body.
//!
//! A point s of a body lies at p = c + R(θ) s, with R s = (rx, ry):
//!
//! ```text
//! ∂p/∂(c, θ) = [1 0 −ry; 0 1 rx],   p̈ = c̈ + θ̈ (−ry, rx) − θ̇² (rx, ry),   ∂(Gᵀλ)_θ/∂θ = −(λx rx + λy ry)
//! ```

use super::base::{Base, Problem, add, add_noise, clear, diagonal, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Sparsity, Stage, State, System, Tangent, Terms};

/// A point of a body: number, local coordinates (m).
pub(crate) type Point = (usize, [f64; 2]);

/// Two constraint rows.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Joint {
    /// Two points coincide: first minus second.
    Pin(Point, Point),
    /// A point stays in place.
    Ground(Point, [f64; 2]),
    /// The mass centre stays on the x axis and the body does not turn: y, θ.
    Slide(usize),
}

/// Bodies, joints, gravity in −y.
#[derive(Clone, Debug)]
pub(crate) struct Linkage {
    base: Base,
    /// Mass (kg) and inertia about the mass centre (kg·m²).
    bodies: Vec<[f64; 2]>,
    joints: Vec<Joint>,
    gravity: f64,
    noise: f64,
    start: State,
}

impl Linkage {
    /// A linkage with the coordinates `q` and velocities `v` (x, y, θ of body after body) at t = 0.
    ///
    /// `noise` is the amplitude of what is added to Φ and γ: a pure function of (t, q).
    pub(crate) fn new(bodies: Vec<[f64; 2]>, joints: Vec<Joint>, gravity: f64, noise: f64, q: Vec<f64>, v: Vec<f64>) -> Self {
        let n = 3 * bodies.len();
        let dims = Dims { q: n, v: n, holonomic: 2 * joints.len(), ..Dims::default() };
        let mut base = Base::new(dims);
        base.pattern = Pattern { g: jacobian_pattern(&joints, n), ..base.pattern };
        base.pattern.mass = Sparsity::new(n, n, (0..n).map(|i| (i, i)));
        base.pattern.k = Sparsity::new(n, n, (2..n).step_by(3).map(|i| (i, i)));
        base.pattern.c = Sparsity::empty(n, n);
        base.pattern.r_lambda = Sparsity::empty(n, dims.holonomic);
        let unit: Vec<usize> = (0..n).map(|i| if i % 3 == 2 { 0 } else { 1 }).collect();
        let start = State { q, v, ..State::new(dims) };
        scaled(Self { base, bodies, joints, gravity, noise, start }, |p| &mut p.base, &unit)
    }

    /// Adds a pin's end with its sign to the two rows of a joint.
    fn add_point(&self, at: At<'_>, stage: Stage, row: usize, sign: f64, point: Point, out: &mut Terms) {
        let ([rx, ry], [x, y], i) = located(at.q, point);
        out.phi[row] += sign * x;
        out.phi[row + 1] += sign * y;
        add(&mut out.g, row, i, sign);
        add(&mut out.g, row, i + 2, -sign * ry);
        add(&mut out.g, row + 1, i + 1, sign);
        add(&mut out.g, row + 1, i + 2, sign * rx);
        if stage >= Stage::Velocity {
            let square = at.v[i + 2] * at.v[i + 2];
            out.gamma[row] += sign * square * rx;
            out.gamma[row + 1] += sign * square * ry;
        }
    }
}

/// R s, c + R s, and the index of the body's first coordinate.
fn located(q: &[f64], (body, s): Point) -> ([f64; 2], [f64; 2], usize) {
    let i = 3 * body;
    let (sin, cos) = q[i + 2].sin_cos();
    let r = [cos * s[0] - sin * s[1], sin * s[0] + cos * s[1]];
    (r, [q[i] + r[0], q[i + 1] + r[1]], i)
}

/// Entries of G.
fn jacobian_pattern(joints: &[Joint], n: usize) -> Sparsity {
    let mut entries = Vec::new();
    for (k, joint) in joints.iter().enumerate() {
        let (row, mut point) = (2 * k, |i: usize, row: usize| entries.extend([(row, i), (row, i + 2), (row + 1, i + 1), (row + 1, i + 2)]));
        match *joint {
            Joint::Pin((i, _), (j, _)) => {
                point(3 * i, row);
                point(3 * j, row);
            }
            Joint::Ground((i, _), _) => point(3 * i, row),
            Joint::Slide(i) => entries.extend([(row, 3 * i + 1), (row + 1, 3 * i + 2)]),
        }
    }
    Sparsity::new(2 * joints.len(), n, entries)
}

impl System for Linkage {
    stored!();
    vectors!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        diagonal(&mut out.mass, self.bodies.iter().flat_map(|&[m, inertia]| [m, m, inertia]));
        out.phi.fill(0.0);
        out.g.values_mut().fill(0.0);
        if stage >= Stage::Velocity {
            out.nu.fill(0.0);
            out.gamma.fill(0.0);
        }
        for (k, joint) in self.joints.iter().enumerate() {
            let row = 2 * k;
            match *joint {
                Joint::Pin(first, second) => {
                    self.add_point(at, stage, row, 1.0, first, out);
                    self.add_point(at, stage, row, -1.0, second, out);
                }
                Joint::Ground(point, place) => {
                    self.add_point(at, stage, row, 1.0, point, out);
                    out.phi[row] -= place[0];
                    out.phi[row + 1] -= place[1];
                }
                Joint::Slide(body) => {
                    out.phi[row..row + 2].copy_from_slice(&at.q[3 * body + 1..3 * body + 3]);
                    out.g.set(row, 3 * body + 1, 1.0);
                    out.g.set(row + 1, 3 * body + 2, 1.0);
                }
            }
        }
        add_noise(self.noise, at.t, at.q, 0, &mut out.phi);
        if stage >= Stage::Velocity {
            add_noise(self.noise, at.t, at.q, 1, &mut out.gamma);
        }
        if stage >= Stage::Dynamics {
            out.force.fill(0.0);
            self.bodies.iter().enumerate().for_each(|(i, body)| out.force[3 * i + 1] = -body[0] * self.gravity);
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        let mut bend = |row: usize, sign: f64, point: Point| {
            let ([rx, ry], _, i) = located(at.q, point);
            add(&mut out.k, i + 2, i + 2, -sign * (lambda[row] * rx + lambda[row + 1] * ry));
        };
        for (k, joint) in self.joints.iter().enumerate() {
            match *joint {
                Joint::Pin(first, second) => {
                    bend(2 * k, 1.0, first);
                    bend(2 * k, -1.0, second);
                }
                Joint::Ground(point, _) => bend(2 * k, 1.0, point),
                Joint::Slide(_) => {}
            }
        }
    }
}

impl Problem for Linkage {
    fn start(&self) -> State {
        self.start.clone()
    }

    fn energy(&self, state: &State) -> f64 {
        let body = |(i, &[m, inertia]): (usize, &[f64; 2])| {
            let (v, y) = (&state.v[3 * i..], state.q[3 * i + 1]);
            0.5 * (m * (v[0] * v[0] + v[1] * v[1]) + inertia * v[2] * v[2]) + m * self.gravity * y
        };
        self.bodies.iter().enumerate().map(body).sum()
    }
}
