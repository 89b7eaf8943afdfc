//! The linearised motion: against differences of accelerations, closed forms, and small motions in time.

mod inputs;

use crate::common::{Noise, State, accelerate, assembled, close, mechanism, model, slope, study};
use grashof::dynamics::{Differentiable, Dynamics, Linearizer, Point};
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::assemble::Assembled;
use grashof::kinematics::linear::{Linear, Reduced};
use grashof::kinematics::partition::preferred;
use grashof::mechanism::{Coordinates, Step};
use grashof::results::LinearSystem;
use grashof::studies::common::outcome::Outcome;
use nalgebra::{DMatrix, DVector};

const PLANAR: &str = include_str!("common/planar.yaml");
const SPATIAL: &str = include_str!("common/spatial.yaml");
const H: f64 = 4e-4;

/// A four-bar with springs, a damped joint, a force that follows the coupler, a state, and a speed; two more rows than it needs in space.
fn four_bar(space: &str, gravity: &str, axis: &str, start: &str) -> String {
    format!(
        "grashof: 1
name: four-bar
space: {space}
gravity: {gravity}
ground: {{ O: [0, 0], C: [0.9, 0.1] }}
bodies:
  crank: {{ bar: {{ length: 0.3, mass: 2, width: 1e-9, height: 1e-9 }} }}
  coupler: {{ bar: {{ length: 0.8, mass: 3, width: 1e-9, height: 1e-9 }}, points: {{ p: [0.3, 0.2] }} }}
  rocker: {{ bar: {{ length: 0.6, mass: 1.5, width: 1e-9, height: 1e-9 }} }}
joints:
  O: {{ revolute: [ground.O, crank.start]{axis}, damping: 0.3 }}
  A: {{ revolute: [crank.end, coupler.start]{axis} }}
  B: {{ revolute: [coupler.end, rocker.end]{axis} }}
  C: {{ revolute: [ground.C, rocker.start]{axis}, damping: 0.2 }}
springs:
  strut: {{ between: [ground.C, coupler.p], stiffness: 60, length: 0.4, damping: 2 }}
  hinge: {{ joint: A, stiffness: 3, rest: 0.2 }}
loads:
  follower: {{ at: coupler.p, force: [4 N + 0.5 N*heat, 1], frame: coupler }}
states:
  heat: {{ rate: 0.7*O.omega - 0.4 rad/s*heat + 0.3 rad/s*sin(C.angle), start: 0.2 }}
start: {{ {start} }}
"
    )
    .replace(", width: 1e-9, height: 1e-9", if space == "planar" { "" } else { ", width: 1e-9, height: 1e-9" })
}

fn planar() -> String {
    four_bar("planar", "[0.4, -9.81]", "", "O.angle: 50 deg, O.omega: 2, A.angle: ~-30 deg, C.angle: ~80 deg")
}

fn spatial() -> String {
    four_bar("spatial", "[0.4, -9.81, 0]", ", axis: [0, 0, 1]", "O.angle: 50 deg, O.omega: 2, A.angle: ~-30 deg, C.angle: ~80 deg")
        .replace("0.5 N*heat, 1]", "0.5 N*heat, 1, 0]")
        .replace("[0, 0]", "[0, 0, 0]")
        .replace("[0.9, 0.1]", "[0.9, 0.1, 0]")
        .replace("[0.3, 0.2]", "[0.3, 0.2, 0]")
}

/// A body on a ball joint with a bar that closes a loop to the ground, turning; its independent turns do not commute.
const TOP: &str = "grashof: 1
name: top with a link
space: spatial
gravity: [0, 0, -9.81]
ground: { O: [0, 0, 0], P: [0.9, 0.2, 0.1] }
bodies:
  top: { mass: 2, inertia: [0.2, 0.3, 0.15, 0.01, -0.02, 0.03], com: [0.1, 0.05, 0.4], points: { tip: [0.2, 0.1, 0.5] } }
  link: { bar: { length: 0.7, mass: 0.8, width: 0.05, height: 0.05 } }
joints:
  ball: { spherical: [ground.O, top.origin] }
  A: { spherical: [top.tip, link.start] }
  B: { universal: [ground.P, link.end], axes: [[0, 0, 1], [0, 1, 0]], cut: true }
springs:
  rope: { between: [ground.P, top.tip], stiffness: 40, length: 0.5, damping: 1 }
start: { top.wx: ~1.3, top.wy: ~-0.7, top.wz: ~2.1 }
";

/// The top without its link: three independent turns.
fn alone() -> String {
    let keep = |line: &&str| !["  link:", "  A:", "  B:"].iter().any(|start| line.starts_with(start));
    TOP.lines().filter(keep).map(|line| format!("{line}\n")).collect()
}

/// A mechanism in its assembled start, with its accelerations.
struct Base<G: Space<S = f64>> {
    mechanism: Differentiable<G>,
    start: Assembled,
    z: Vec<f64>,
    a: Vec<f64>,
    lambda: Vec<f64>,
}

impl<G> Base<G>
where
    G: Space<S = f64>,
{
    fn new(text: &str) -> Self {
        let (mechanism, start) = assembled::<G>(text, Coordinates::Joint);
        let z = mechanism.state_starts.clone();
        let (a, lambda) = {
            let mut d = Dynamics::new(&mechanism);
            d.work.z.copy_from_slice(&z);
            d.terms(0.0, &start.q, &start.v, &start.modes);
            accelerate(&d)
        };
        Self { mechanism: Differentiable::new(mechanism), start, z, a, lambda }
    }

    fn reduced(&self) -> Reduced {
        let s = &self.start;
        let at = Point { t: 0.0, q: &s.q, v: &s.v, z: &self.z, a: &self.a, lambda: &self.lambda, modes: &s.modes };
        let linear = Linear::new(&self.mechanism, &mut Linearizer::new(&self.mechanism), &at, &s.metric).expect("regular");
        linear.reduce(&preferred(&self.mechanism)).expect("regular")
    }

    /// The position with independent coordinates moved by x, its constraints closed by singular values.
    fn closed(&self, reduced: &Reduced, x: &[f64]) -> Vec<f64> {
        let m = &self.mechanism;
        let mut q = self.start.q.clone();
        let delta = &reduced.partition.p * DVector::from_column_slice(x);
        m.retract(&mut q, delta.as_slice());
        for _ in 0..30 {
            let mut d = Dynamics::new(m);
            d.time(0.0, &self.start.modes);
            d.position(&q, &self.start.modes);
            let step = self.dependent(reduced, &d.work.g.to_dense(), &d.work.phi);
            m.retract(&mut q, &step);
        }
        q
    }

    /// −G_d⁺ y, 0 on the independent velocities.
    fn dependent(&self, reduced: &Reduced, g: &[f64], y: &[f64]) -> Vec<f64> {
        let m = &self.mechanism;
        let columns = DMatrix::from_row_slice(m.rows.len(), m.nv, g).select_columns(&reduced.partition.dependent);
        let mut out = vec![0.0; m.nv];
        if !columns.is_empty() {
            let x = columns.svd(true, true).solve(&DVector::from_column_slice(y), 1e-10).expect("singular vectors");
            reduced.partition.dependent.iter().zip(x.iter()).for_each(|(&d, x)| out[d] = -x);
        }
        out
    }

    /// u̇ and ż at (x, u, z) on the constraints.
    fn rates(&self, reduced: &Reduced, state: &[f64]) -> Vec<f64> {
        let m = &self.mechanism;
        let n = reduced.partition.independent.len();
        let q = self.closed(reduced, &state[..n]);
        let mut d = Dynamics::new(m);
        d.work.z.copy_from_slice(&state[2 * n..]);
        d.time(0.0, &self.start.modes);
        d.position(&q, &self.start.modes);
        d.velocity(&vec![0.0; m.nv], &self.start.modes);
        let mut v = vec![0.0; m.nv];
        reduced.partition.independent.iter().zip(&state[n..]).for_each(|(&i, u)| v[i] = *u);
        let y: Vec<f64> = (0..m.rows.len()).map(|r| (0..m.nv).map(|k| d.work.g.at(r, k) * v[k]).sum::<f64>() - d.work.nu[r]).collect();
        let rest = self.dependent(reduced, &d.work.g.to_dense(), &y);
        v.iter_mut().zip(rest).for_each(|(v, x)| *v += x);
        d.terms(0.0, &q, &v, &self.start.modes);
        d.rates(&self.start.modes);
        let (a, _) = accelerate(&d);
        reduced.partition.independent.iter().map(|&i| a[i]).chain(d.work.zdot.iter().copied()).collect()
    }

    fn check(&self, freedom: usize) {
        let reduced = self.reduced();
        let n = reduced.partition.independent.len();
        assert_eq!(n, freedom);
        let order = 2 * n + self.z.len();
        let own = |x: &[f64]| reduced.partition.independent.iter().map(|&i| x[i]).collect::<Vec<_>>();
        let base = [vec![0.0; n], own(&self.start.v), self.z.clone()].concat();
        close("u̇", &self.rates(&reduced, &base)[..n], &own(&self.a), 1e-9);
        for j in 0..order {
            let found: Vec<f64> = (n..order).map(|i| reduced.a[(i, j)]).collect();
            let right = slope(H, |e| {
                let mut state = base.clone();
                state[j] += e;
                self.rates(&reduced, &state)
            });
            close(&format!("column {j} of A"), &found, &right, 2e-8);
        }
    }
}

#[test]
fn reduced_motion_is_the_derivative_of_accelerations_on_the_constraints() {
    Base::<Planar<f64>>::new(&planar()).check(1);
    // in space with 2·3 rows too many, the same
    let flat = Base::<Spatial<f64>>::new(&spatial());
    assert!(flat.mechanism.rows.len() > flat.mechanism.nv);
    flat.check(1);
    Base::<Spatial<f64>>::new(TOP).check(2);
    Base::<Spatial<f64>>::new(&alone()).check(3);
}

#[test]
fn planar_and_spatial_give_the_same_matrix() {
    let (a, b) = (Base::<Planar<f64>>::new(&planar()).reduced().a, Base::<Spatial<f64>>::new(&spatial()).reduced().a);
    close("A", a.as_slice(), b.as_slice(), 1e-10);
}

#[test]
fn matrix_on_all_coordinates_is_the_derivative_of_accelerations() {
    fn check<G>(text: &str, coordinates: Coordinates)
    where
        G: Space<S = f64>,
    {
        let mut m = mechanism::<G>(text, coordinates);
        // as many rows as leave some freedom; they need not hold in the state
        m.rows.truncate(m.nv / 2);
        let rows = m.rows.len();
        m.drives.retain(|d| d.row < rows);
        let m = Differentiable::new(m);
        for seed in 1..3 {
            let s = State::random(&m, seed);
            let mut d = Dynamics::new(&m);
            s.evaluate(&mut d);
            let (a, lambda) = accelerate(&d);
            let metric: Vec<f64> = (0..m.nv).map(|i| d.work.mass.at(i, i)).collect();
            let at = Point { t: s.t, q: &s.q, v: &s.v, z: &[], a: &a, lambda: &lambda, modes: &s.modes };
            let matrix = Linear::new(&m, &mut Linearizer::new(&m), &at, &metric).expect("regular").state_matrix();
            for j in 0..2 * m.nv {
                let right = slope(H, |e| {
                    let mut next = s.clone();
                    if j < m.nv {
                        let mut delta = vec![0.0; m.nv];
                        delta[j] = e;
                        m.retract(&mut next.q, &delta);
                    } else {
                        next.v[j - m.nv] += e;
                    }
                    let mut d = Dynamics::new(&m);
                    next.evaluate(&mut d);
                    accelerate(&d).0
                });
                let found: Vec<f64> = (m.nv..2 * m.nv).map(|i| matrix[(i, j)]).collect();
                close(&format!("column {j}"), &found, &right, 1e-6);
            }
        }
    }
    check::<Planar<f64>>(PLANAR, Coordinates::Joint);
    check::<Spatial<f64>>(SPATIAL, Coordinates::Joint);
    check::<Planar<f64>>(PLANAR, Coordinates::Cartesian);
}

#[test]
fn deviations_of_a_turning_body_drift_as_its_velocities_do_not_commute() {
    drift(&Base::new(TOP));
    drift(&Base::new(&alone()));
}

fn drift(base: &Base<Spatial<f64>>) {
    let reduced = base.reduced();
    let m = &base.mechanism;
    let n = reduced.partition.independent.len();
    let Some(&Step::Ball { q: k, .. }) = m.steps.first() else { panic!("a ball joint first") };
    // the deviation of one motion from another after a time e, in the turned frame of the other
    let mut noise = Noise(5);
    let (x, u) = (noise.vector(n), noise.vector(n));
    let size = 1e-5;
    let along = |e: f64, sign: f64| -> Vec<f64> {
        let mut q = base.closed(&reduced, &x.iter().map(|x| sign * size * x).collect::<Vec<_>>());
        let (xv, uv) = (DVector::from_column_slice(&x), DVector::from_column_slice(&u));
        let dv = (&reduced.partition.p * uv + &reduced.w * xv) * (sign * size);
        let v: Vec<f64> = base.start.v.iter().zip(dv.iter()).map(|(v, d)| e * (v + d)).collect();
        m.retract(&mut q, &v);
        q[k..k + 4].to_vec()
    };
    let turn = |from: &[f64], to: &[f64]| -> Vec<f64> {
        let unit = |q: &[f64]| nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
        (unit(from).inverse() * unit(to)).scaled_axis().as_slice().to_vec()
    };
    let deviation = |e: f64| -> Vec<f64> { turn(&along(e, -1.0), &along(e, 1.0)).iter().map(|d| d / (2.0 * size)).collect() };
    let right = slope(1e-3, deviation);
    let state = DVector::from_vec([x.clone(), u.clone()].concat());
    let rates = reduced.a.rows(0, n) * state;
    let turns: Vec<usize> = (0..n).filter(|&i| reduced.partition.independent[i] < 3).collect();
    assert!(!turns.is_empty());
    for i in turns {
        close("δ̇ of the ball joint", &[rates[i]], &[right[reduced.partition.independent[i]]], 1e-6);
    }
}

fn linear(outcome: &Outcome) -> &LinearSystem {
    outcome.linear.as_ref().expect("a linear system")
}

fn matrix(system: &LinearSystem, name: &str) -> DMatrix<f64> {
    let (_, rows) = system.matrices.iter().find(|(n, _)| n == name).expect("the matrix");
    let columns = rows.first().map_or(0, Vec::len);
    DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j])
}

const OSCILLATOR: &str = "grashof: 1
name: oscillator
space: planar
gravity: none
parameters: { f: 0 N, k: 50 N/m }
ground: { O: [0, 0] }
bodies: { block: { mass: 2 kg } }
joints: { O: { slider: [ground.O, block.origin], axis: [1, 0], damping: 3 } }
springs: { s: { joint: O, stiffness: k, rest: 0.1 m } }
loads: { push: { at: block.origin, force: [f, 0] } }
start: { O.position: 0.3 m, O.velocity: 0.5 m/s }
studies:
  plain: { linearize: { inputs: [f, k] } }
  outputs: { linearize: { at: start, inputs: [f], write: [json, csv, mat] }, columns: [block.x, block.ax, energy.kinetic, O.fx] }
";

#[test]
fn oscillator_has_its_textbook_matrices() {
    let outcome = study(OSCILLATOR, "plain", Coordinates::Joint);
    let system = linear(&outcome);
    assert_eq!(system.states, ["O.position", "O.velocity"]);
    assert_eq!((system.inputs.join(" "), system.outputs.join(" ")), ("f k".into(), "O.position O.velocity".into()));
    close("A", matrix(system, "A").as_slice(), &[0.0, -25.0, 1.0, -1.5], 1e-13);
    // by the force 1/m, by the stiffness −(x − rest)/m
    close("B", matrix(system, "B").as_slice(), &[0.0, 0.5, 0.0, -0.1], 1e-12);
    close("C", matrix(system, "C").as_slice(), &[1.0, 0.0, 0.0, 1.0], 1e-15);
    close("D", matrix(system, "D").as_slice(), &[0.0; 4], 1e-15);
    close("ẋ", &system.values[1], &[0.5, (-50.0 * 0.2 - 3.0 * 0.5) / 2.0], 1e-13);
    close("mass", matrix(system, "mass").as_slice(), &[2.0], 1e-15);
    assert!(outcome.findings.iter().any(|f| f.code == "not-at-rest"), "{:?}", outcome.findings);

    let outcome = study(OSCILLATOR, "outputs", Coordinates::Joint);
    let system = linear(&outcome);
    // x; ẍ; ½ m v² by v is m v; the guide bears nothing along itself
    close("C", matrix(system, "C").as_slice(), &[1.0, -25.0, 0.0, 0.0, 0.0, -1.5, 1.0, 0.0], 1e-10);
    close("D", matrix(system, "D").as_slice(), &[0.0, 0.5, 0.0, 0.0], 1e-10);
}

#[test]
fn inputs_of_any_size_have_their_slope() {
    for (law, slope) in [
        ("1e-12 N m^2/(1 um - u)^2", 2e6),
        ("1e-6 N m^2/(1 mm - u)^2", 2e3),
        ("1 N*sin(u/0.1 mm)", 1e4),
        ("1 N*sin(u/1 mm)", 1e3),
        ("3 N/m*u", 3.0),
        ("1 N/m^2*u*abs(u)", 0.0),
    ] {
        let text = format!(
            "grashof: 1
name: gap
space: planar
gravity: none
parameters: {{ u: 0 m }}
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
loads: {{ f: {{ joint: A, force: {law} }} }}
studies: {{ l: {{ linearize: {{ inputs: [u] }}, columns: [A.acceleration] }} }}
"
        );
        let outcome = study(&text, "l", Coordinates::Joint);
        let b = matrix(linear(&outcome), "B")[1];
        assert!((b - slope).abs() < 1e-8 * slope.abs().max(1.0), "{law}: {b}");
        assert!(outcome.findings.iter().all(|f| f.code != "rough-differences"), "{law}: {:?}", outcome.findings);
    }
}

const CART: &str = "grashof: 1
name: pendulum on a cart
space: planar
gravity: [0, -9.81]
parameters: { push: 0 N, m_cart: 3 kg, m_bob: 1.2 kg, l: 0.8 m }
ground: { O: [0, 0] }
bodies:
  cart: { mass: m_cart }
  bob: { mass: m_bob, com: [l, 0], points: { end: [l, 0] } }
joints:
  O: { slider: [ground.O, cart.origin], axis: [1, 0] }
  P: { revolute: [cart.origin, bob.origin] }
loads: { u: { at: cart.origin, force: [push, 0] } }
start: { O.position: 0, P.angle: 90 deg }
studies:
  upright: { linearize: { inputs: [push] }, columns: [bob.end.x] }
";

#[test]
fn pendulum_on_a_cart_has_its_textbook_matrices() {
    let outcome = study(CART, "upright", Coordinates::Joint);
    let system = linear(&outcome);
    assert_eq!(system.states, ["O.position", "P.angle", "O.velocity", "P.omega"]);
    let (cart, m, l, g) = (3.0, 1.2, 0.8, 9.81);
    // about the upright bob: M = [[M + m, −m l], [−m l, m l²]], K = diag(0, −m g l)
    close("mass", matrix(system, "mass").as_slice(), &[cart + m, -m * l, -m * l, m * l * l], 1e-12);
    close("stiffness", matrix(system, "stiffness").as_slice(), &[0.0, 0.0, 0.0, -m * g * l], 1e-12);
    let a = matrix(system, "A");
    close("A", &[a[(2, 1)], a[(3, 1)]], &[m * g / cart, (cart + m) * g / (cart * l)], 1e-12);
    close("B", matrix(system, "B").as_slice(), &[0.0, 0.0, 1.0 / cart, 1.0 / (cart * l)], 1e-12);
    // the bob's end moves by x − l sin
    close("C", matrix(system, "C").as_slice(), &[1.0, -l, 0.0, 0.0], 1e-11);
}

/// A loop of four bars on springs, at its equilibrium by construction of the hinge's rest, pushed by u.
const PUSHED: &str = "grashof: 1
name: pushed four-bar
space: planar
gravity: none
parameters: { u: 0 N, l2: 0.8 m }
ground: { O: [0, 0], C: [0.9, 0.1] }
bodies:
  crank: { bar: { length: 0.3, mass: 2 } }
  coupler: { bar: { length: l2, mass: 3 }, points: { p: [0.3, 0.2] } }
  rocker: { bar: { length: 0.6, mass: 1.5 } }
joints:
  O: { revolute: [ground.O, crank.start], damping: 0.3 }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start], damping: 0.2 }
springs: { hinge: { joint: O, stiffness: 30, rest: 50 deg } }
loads: { push: { at: coupler.p, force: [u, -2*u] } }
start: { O.angle: 50 deg, A.angle: ~-30 deg, C.angle: ~80 deg }
studies:
  linear: { linearize: { inputs: [u, l2] }, columns: [O.angle, rocker.angle, coupler.p.x, rocker.alpha] }
  step: { set: { u: 0.001 N }, dynamics: { until: 0.4 s, every: 0.1 s, tolerance: 1e-12 }, columns: [O.angle, rocker.angle, coupler.p.x, rocker.alpha] }
  rest: { dynamics: { until: 0.1 s, every: 0.1 s }, columns: [O.angle, rocker.angle, coupler.p.x, rocker.alpha] }
";

#[test]
fn a_small_step_is_answered_as_the_linear_system_says() {
    let (outcome, step, rest) =
        (study(PUSHED, "linear", Coordinates::Joint), study(PUSHED, "step", Coordinates::Joint), study(PUSHED, "rest", Coordinates::Joint));
    let system = linear(&outcome);
    assert!(outcome.findings.is_empty(), "{:?}", outcome.findings);
    let (a, b, c, d) = (matrix(system, "A"), matrix(system, "B"), matrix(system, "C"), matrix(system, "D"));
    let n = a.nrows();
    let u = 1e-3;
    for (t, row) in step.places.iter().zip(&step.rows) {
        // exp of [A b; 0 0] t holds the answer to a constant input in its last column
        let mut whole = DMatrix::zeros(n + 1, n + 1);
        whole.view_mut((0, 0), (n, n)).copy_from(&(&a * *t));
        whole.view_mut((0, n), (n, 1)).copy_from(&(b.column(0) * (u * *t)));
        let x = whole.exp().column(n).rows(0, n).into_owned();
        let y = &c * x + d.column(0) * u;
        for (k, linear) in y.iter().enumerate() {
            let moved = row[k] - rest.rows[0][k];
            // the square of the motion, whose parts are up to 1e-3 of it
            assert!((moved - linear).abs() < 2e-3 * y.amax().max(1e-5), "t = {t}, output {k}: {moved:e} and {linear:e}");
        }
    }
    // a longer coupler moves the rocker at once, by the geometry of the loop
    let longer = |l: f64| {
        let text = PUSHED.replace("l2: 0.8 m", &format!("l2: {l} m"));
        study(&text, "rest", Coordinates::Joint).rows[0][1]
    };
    close("D by the length", &[d[(1, 1)]], &[(longer(0.8005) - longer(0.7995)) / 1e-3], 1e-5);
}

#[test]
fn what_cannot_be_asked_is_refused_with_its_place() {
    let refused = |studies: &str| {
        let text = OSCILLATOR.split("studies:").next().expect("a model").to_string() + "studies: { s: { " + studies + " } }\n";
        let document = grashof::model::Document::read(&text, "test.yaml").expect("YAML");
        let report = document.check_all(&grashof::model::Selection::default());
        let found: Vec<String> = report.diagnostics.iter().map(|d| format!("{}: {} at {}", d.code, d.message, d.place)).collect();
        found.join("; ")
    };
    assert_eq!(refused("linearize: { inputs: [g] }"), "unknown-parameter: unknown parameter `g` at studies.s.linearize.inputs[0]");
    assert_eq!(refused("linearize: { inputs: [f, f] }"), "duplicate-name: `f` is an input already at studies.s.linearize.inputs[1]");
    assert_eq!(refused("linearize: { write: [xml] }"), "unknown-word: `xml` is not known here at studies.s.linearize.write[0]");
    assert_eq!(refused("modes: {}, columns: [O.position]"), "wrong-key: a study of the kind `modes` has no columns at studies.s.columns");
    assert_eq!(refused("modes: { at: rest }"), "unknown-word: `rest` is not known here at studies.s.modes.at");
}

#[test]
fn preferred_coordinates_are_those_of_the_start() {
    let m = model(&planar(), None);
    let base = Base::<Planar<f64>>::new(&planar());
    let names = grashof::kinematics::coordinates::coordinates(&m, &base.mechanism);
    let own: Vec<&str> = base.reduced().partition.independent.iter().map(|&i| names[i].name.as_str()).collect();
    assert_eq!(own, ["O.angle"]);
}

/// A reaction that is zero but for round-off has no kink, nor has it an uncertain slope.
#[test]
fn an_output_that_stays_zero_is_no_kink() {
    let text = "\
grashof: 1
name: universal joint
space: spatial
gravity: [0, 0, -9.81 m/s^2]
parameters: { u: 0 N m }
bodies:
  a: { mass: 1 kg, com: [0, 0.1, 0.2], inertia: [0.01, 0.01, 0.01] }
  b: { mass: 1 kg, com: [0.1, 0, 0.2], inertia: [0.01, 0.012, 0.01] }
joints:
  P: { revolute: [ground, a.origin], axis: [1, 0, 0] }
  Q: { revolute: [a.origin, b.origin], axis: [0, 1, 0] }
loads: { m: { at: a.com, torque: [u, 0, 0] } }
start: { P.angle: 0.3 rad, Q.angle: 0.2 rad, P.omega: 2 rad/s, Q.omega: 1 rad/s }
studies: { free: { linearize: { inputs: [u] }, columns: [P.mx] } }
";
    let outcome = study(text, "free", Coordinates::Joint);
    assert!(outcome.findings.iter().all(|f| f.code != "rough-differences"), "{:?}", outcome.findings);
}
