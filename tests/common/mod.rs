//! What the tests of the mechanics share: models from text, noise, random states, dense linear algebra, differences.

use grashof::dynamics::{Dynamics, Reactions};
use grashof::geometry::{Pose, Space};
use grashof::kinematics::assemble::{Assembled, assemble};
use grashof::mechanism::{Coordinates, Mechanism, Step, build};
use grashof::model::{Document, Model, Selection};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run_in;
use nalgebra::{DMatrix, DVector};

/// A fixed sequence in (−1, 1).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// The model of a text, with its study if one is named.
pub(crate) fn model(text: &str, study: Option<&str>) -> Model {
    let document = Document::read(text, "test.yaml").unwrap_or_else(|report| panic!("{report:?}"));
    document.model(&Selection { study, ..Selection::default() }).unwrap_or_else(|report| panic!("{report:?}"))
}

/// The mechanism of a text in the given coordinates.
pub(crate) fn mechanism<G: Space<S = f64>>(text: &str, coordinates: Coordinates) -> Mechanism<G> {
    let model = model(text, None);
    build::<G>(&model, &parameters(&model), coordinates).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// The mechanism of a text in the given coordinates with its start.
pub(crate) fn assembled<G: Space<S = f64>>(text: &str, coordinates: Coordinates) -> (Mechanism<G>, Assembled) {
    let model = model(text, None);
    assemble::<G>(&model, &parameters(&model), coordinates).unwrap_or_else(|f| panic!("{}", f.reason()))
}

/// A study of a text, run to its end.
pub(crate) fn study(text: &str, name: &str, coordinates: Coordinates) -> Outcome {
    let outcome = as_far_as_it_goes(text, name, coordinates);
    assert_eq!(outcome.stopped, None, "{name} stopped");
    outcome
}

/// A study of a text that may stop on its way.
pub(crate) fn as_far_as_it_goes(text: &str, name: &str, coordinates: Coordinates) -> Outcome {
    let model = model(text, Some(name));
    let study = model.study.clone().expect("the study");
    run_in(Case::new(&model, &study, &parameters(&model)), coordinates, &|| false).unwrap_or_else(|f| panic!("{name}: {}", f.reason()))
}

/// Names of a study's columns.
pub(crate) fn columns(text: &str, name: &str) -> Vec<String> {
    model(text, Some(name)).study.expect("the study").columns.into_iter().map(|c| c.name).collect()
}

/// A state with accelerations and multipliers.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) t: f64,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) a: Vec<f64>,
    pub(crate) lambda: Vec<f64>,
    pub(crate) modes: Vec<i32>,
}

impl State {
    /// Anywhere within about a radian of the drawing; quaternions keep their length of 1.
    pub(crate) fn random<G: Space>(m: &Mechanism<G>, seed: u64) -> Self {
        let mut noise = Noise(seed);
        let mut q = m.drawn();
        m.retract(&mut q, &noise.vector(m.nv));
        Self { t: 0.37, q, v: noise.vector(m.nv), a: noise.vector(m.nv), lambda: noise.vector(m.rows.len()), modes: m.modes() }
    }

    /// The state after a time e of the motion with velocity v and acceleration a, to first order.
    pub(crate) fn after<G: Space>(&self, m: &Mechanism<G>, e: f64) -> Self {
        let mut next = self.clone();
        m.retract(&mut next.q, &self.v.iter().map(|v| e * v).collect::<Vec<_>>());
        next.v = self.v.iter().zip(&self.a).map(|(v, a)| v + e * a).collect();
        next.t += e;
        next
    }

    /// Evaluates everything up to M, f, Φ, G, ν, γ and the gauges that are only watched.
    pub(crate) fn evaluate<G: Space<S = f64>>(&self, d: &mut Dynamics<'_, G>) {
        d.terms(self.t, &self.q, &self.v, &self.modes);
        d.watch(&self.q, &self.v, &self.modes);
    }
}

/// Derivative at 0 by central differences of sixth order.
pub(crate) fn slope(h: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let mut sum = Vec::new();
    for (k, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
        let (plus, minus) = (f(k * h), f(-k * h));
        sum.resize(plus.len(), 0.0);
        for ((s, p), m) in sum.iter_mut().zip(plus).zip(minus) {
            *s += weight * (p - m) / (60.0 * h);
        }
    }
    sum
}

/// Equal to `tolerance` of the larger of 1 and the largest number of both.
#[track_caller]
pub(crate) fn close(what: &str, found: &[f64], right: &[f64], tolerance: f64) {
    assert_eq!(found.len(), right.len(), "{what}: numbers of values");
    let size = found.iter().chain(right).fold(1.0_f64, |m, x| m.max(x.abs()));
    for (i, (f, r)) in found.iter().zip(right).enumerate() {
        let off = (f - r).abs();
        assert!(off <= tolerance * size, "{what}, value {i}: found {f:e}, right is {r:e}, off by {off:e} of {size:e}");
    }
}

/// Components of a vector and of a spin.
pub(crate) fn vector<G: Space<S = f64>>(v: G::Vector) -> Vec<f64> {
    (0..G::VECTOR).map(|i| G::component(v, i)).collect()
}
pub(crate) fn spin<G: Space<S = f64>>(w: G::Spin) -> Vec<f64> {
    (if G::SPIN == 1 { 2..3 } else { 0..3 }).map(|i| G::spin_component(w, i)).collect()
}
/// Moment and force.
pub(crate) fn wrench<G: Space<S = f64>>(f: grashof::geometry::Force<G>) -> Vec<f64> {
    [spin::<G>(f.n), vector::<G>(f.f)].concat()
}
/// Spin and velocity at the origin.
pub(crate) fn twist<G: Space<S = f64>>(m: grashof::geometry::Motion<G>) -> Vec<f64> {
    [spin::<G>(m.w), vector::<G>(m.v)].concat()
}

/// a and λ of M a + Gᵀλ = f, G a = γ; the λ of least size where rows depend on each other.
pub(crate) fn accelerate<G: Space<S = f64>>(d: &Dynamics<'_, G>) -> (Vec<f64>, Vec<f64>) {
    let (n, m) = (d.mechanism.nv, d.mechanism.rows.len());
    let w = &d.work;
    let mut kkt = DMatrix::zeros(n + m, n + m);
    for i in 0..n {
        for k in 0..n {
            kkt[(i, k)] = w.mass.at(i, k);
        }
        for r in 0..m {
            kkt[(i, n + r)] = w.g.at(r, i);
            kkt[(n + r, i)] = w.g.at(r, i);
        }
    }
    let b = DVector::from_iterator(n + m, w.force.iter().chain(&w.gamma).copied());
    let svd = kkt.clone().svd(true, true);
    let cut = 1e-11 * svd.singular_values[0];
    let mut x = svd.solve(&b, cut).expect("a solution");
    // one step of refinement takes the last digits
    x += svd.solve(&(&b - &kkt * &x), cut).expect("a solution");
    (x.as_slice()[..n].to_vec(), x.as_slice()[n..].to_vec())
}

/// What follows from a and λ at the state evaluated last.
pub(crate) fn react<G: Space<S = f64>>(d: &mut Dynamics<'_, G>, a: &[f64], lambda: &[f64]) -> Reactions<G> {
    let mut r = d.reactions();
    let mut lacking = vec![0.0; d.mechanism.nv];
    d.accelerate(a, &mut r.accelerations);
    d.unbalanced(a, &r.accelerations, &mut lacking);
    d.react(a, lambda, &mut r);
    r
}

/// The coordinates and velocities of the star tree at which its bodies are where those of another tree are.
pub(crate) fn star_state<G: Space<S = f64>>(star: &Mechanism<G>, at: &Dynamics<'_, G>) -> (Vec<f64>, Vec<f64>) {
    let (mut q, mut v) = (star.drawn(), vec![0.0; star.nv]);
    for node in &star.nodes {
        let (pose, twist): (Pose<G>, _) = (at.pose(node.body), at.work.twists[node.body]);
        let mut axis = 0;
        for step in &star.steps[node.steps.clone()] {
            match *step {
                Step::Axis { turns: false, q: i, v: k, .. } => {
                    q[i] = G::component(pose.p - node.before.p, axis);
                    v[k] = G::component(twist.at(at.place(at.mechanism.group_of[node.body], node.body, G::Vector::default())), axis);
                    axis += 1;
                }
                Step::Axis { q: i, v: k, .. } => {
                    q[i] = G::angle(pose.r);
                    v[k] = G::spin_component(twist.w, 2);
                }
                Step::Ball { q: i, v: k, .. } => {
                    let matrix = nalgebra::Matrix3::from_fn(|i, k| G::entry(pose.r, i, k));
                    let unit = nalgebra::UnitQuaternion::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(matrix));
                    q[i..i + 4].copy_from_slice(&[unit.w, unit.i, unit.j, unit.k]);
                    let w = G::rotate_spin(G::inverse(pose.r), twist.w);
                    for axis in 0..3 {
                        v[k + axis] = G::spin_component(w, axis);
                    }
                }
            }
        }
    }
    (q, v)
}
