//! Central differences: the textbook's numbers, order, constraints.

use crate::problems::*;
use grashof_solvers::{
    At, Control, Dims, Effect, Integration, Method, Pattern, Progress, Settings, Span, Stage, State, System, Tangent, Terms,
};

fn settings(h: f64, other: f64) -> Settings {
    Settings { method: Method::CentralDifference, control: Control::Steps([h, other]), ..Settings::default() }
}

/// A slider-crank driven by a motor: M(φ) φ̈ + ½ M′(φ) φ̇² = T₀ (1 − φ̇/Ω) − c φ̇ + m g r cos φ.
#[derive(Clone)]
struct Driven {
    pattern: Pattern,
}

/// One velocity.
const ONE: Dims = Dims { q: 1, v: 1, z: 0, holonomic: 0, nonholonomic: 0, modes: 0, live: 0, roots: 0, work: 0 };

/// Crank radius (m), slider mass (kg), crank inertia (kg·m²).
const RADIUS: f64 = 0.1;
const MASS: f64 = 2.0;
const INERTIA: f64 = 0.05;

/// M = J + m (r sin φ)², M′ and the weight.
fn inertia(phi: f64) -> [f64; 3] {
    let (s, c) = phi.sin_cos();
    let m = MASS * RADIUS * RADIUS;
    [INERTIA + m * s * s, 2.0 * m * s * c, -MASS * 9.81 * RADIUS * c]
}

/// Motor and damper: force and its slope by the speed.
fn drive(speed: f64) -> [f64; 2] {
    [3.0 * (1.0 - speed / 20.0) - 0.02 * speed * speed.abs(), -0.15 - 0.04 * speed.abs()]
}

impl System for Driven {
    fn dims(&self) -> Dims {
        ONE
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn terms(&mut self, at: At<'_>, _: Stage, out: &mut Terms) {
        let [m, slope, weight] = inertia(at.q[0]);
        out.mass.values_mut()[0] = m;
        out.force[0] = drive(at.v[0])[0] - 0.5 * slope * at.v[0] * at.v[0] + weight;
    }

    fn residual(&mut self, at: At<'_>, a: &[f64], _: &[f64], r: &mut [f64]) {
        let [m, slope, weight] = inertia(at.q[0]);
        r[0] = m * a[0] - drive(at.v[0])[0] + 0.5 * slope * at.v[0] * at.v[0] - weight;
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        out.k.values_mut()[0] = 0.0;
        out.c.values_mut()[0] = inertia(at.q[0])[1] * at.v[0] - drive(at.v[0])[1];
    }

    fn rate(&self, _: f64, _: &[f64], v: &[f64], qdot: &mut [f64]) {
        qdot[0] = v[0];
    }

    fn retract(&self, _: Span, q: &mut [f64], delta: &[f64]) {
        q[0] += delta[0];
    }

    fn displace(&self, _: Span, q: &mut [f64], u: &[f64]) {
        q[0] += u[0];
    }

    fn power(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn modes(&mut self, _: At<'_>, _: &mut [i32]) {}

    fn roots(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn cross(&mut self, _: usize, _: &mut State, _: &mut [f64]) -> Effect {
        Effect::Record
    }
}

/// The textbook's loop over positions: v_n and a_n from q_{n−1}, q_n and the unknown q_{n+1}.
fn textbook(start: f64, h: f64, steps: usize) -> Vec<[f64; 3]> {
    let unbalance = |q: f64, v: f64, a: f64| {
        let [m, slope, weight] = inertia(q);
        (m * a + 0.5 * slope * v * v - drive(v)[0] - weight, m, slope * v - drive(v)[1])
    };
    // at rest the force does not depend on the speed
    let mut last = start + 0.5 * h * h * -unbalance(start, 0.0, 0.0).0 / inertia(start)[0];
    let (mut q, mut rows) = (start, Vec::new());
    for _ in 0..=steps {
        let mut next = 2.0 * q - last;
        let central = |next: f64| [q, (next - last) / (2.0 * h), (next - 2.0 * q + last) / (h * h)];
        for _ in 0..20 {
            let [q, v, a] = central(next);
            let (r, m, c) = unbalance(q, v, a);
            next -= r / (m / (h * h) + c / (2.0 * h));
        }
        rows.push(central(next));
        (last, q) = (q, next);
    }
    rows
}

#[test]
fn values_are_those_of_the_textbook() {
    let mut pattern = Pattern::dense(ONE);
    pattern.metric[0] = INERTIA;
    let (mut system, h, steps) = (Driven { pattern }, 1e-3, 2000);
    let start = State { q: vec![0.3], ..State::new(ONE) };
    let mut run = Integration::new(&mut system, settings(h, h), &start).unwrap();
    let rows = textbook(0.3, h, steps);
    // a second difference has ε q/h² of noise, and φ̇ what that is over the run
    for row in &rows {
        let node = run.node();
        let distance = [node.state.q[0] - row[0], node.state.v[0] - row[1], node.a[0] - row[2]].map(f64::abs);
        assert!(distance[0] < 1e-11 && distance[1] < 1e-10 && distance[2] < 1e-7, "{} {distance:?}", node.state.t);
        run.advance(&mut system, h * steps as f64).unwrap();
    }
    assert!(rows[steps][1] > 5.0);
}

/// Errors of q, v and λ of the pendulum in the maximum norm.
fn pendulum(h: f64, ratio: f64) -> [f64; 3] {
    let mut system = Pendulum::new();
    let start = system.start();
    let mut run = Integration::new(&mut system, settings(h, ratio * h), &start).unwrap();
    let mut worst = [0.0_f64; 3];
    while run.advance(&mut system, 2.0).unwrap() != Progress::End {
        let (s, x) = (&run.node().state, Pendulum::exact(run.node().state.t));
        (0..2).for_each(|i| worst[0] = worst[0].max((s.q[i] - x[i]).abs()));
        (0..2).for_each(|i| worst[1] = worst[1].max((s.v[i] - x[i + 2]).abs()));
        worst[2] = worst[2].max((run.node().lambda[0] - Pendulum::exact_lambda(s.t)).abs());
        assert!((s.q[0].hypot(s.q[1]) - 1.0).abs() < 1e-14 && (s.q[0] * s.v[0] + s.q[1] * s.v[1]).abs() < 1e-13);
    }
    worst
}

#[test]
fn constraints_hold_and_leave_second_order() {
    for ratio in [1.0, 1.5] {
        let (coarse, fine) = (pendulum(2e-3, ratio), pendulum(1e-3, ratio));
        let orders = [0, 1, 2].map(|i| (coarse[i] / fine[i]).log2());
        assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.1), "{ratio}: {orders:?} {fine:?}");
    }
}

/// Errors at the end of a run with steps h.
fn error(mut system: impl Problem, h: f64, end: f64, of: impl Fn(&State) -> f64) -> f64 {
    let start = system.start();
    let mut run = Integration::new(&mut system, settings(h, h), &start).unwrap();
    while run.advance(&mut system, end).unwrap() != Progress::End {}
    of(&run.node().state)
}

fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

#[test]
fn attitudes_states_and_blades_are_of_second_order() {
    let order = |errors: [f64; 2]| (errors[0] / errors[1]).log2();
    let (_, omega, _) = FreeBody::OUTPUTS[1];
    let free = [0.02, 0.01].map(|h| error(FreeBody::new(), h, 10.0, |s| distance(&s.v, &omega)));
    let (_, centre, _) = HeavyTop::OUTPUTS[3];
    let top = [2e-4, 1e-4].map(|h| error(HeavyTop::cusp(), h, 0.3, |s| distance(&HeavyTop::centre(&s.q), &centre)));
    let cartesian = [2e-4, 1e-4].map(|h| error(HeavyTopCartesian::cusp(), h, 0.3, |s| distance(&s.q[..3], &centre)));
    let skate = [0.01, 0.005].map(|h| error(Skate::new(), h, 2.0, |s| distance(&s.q, &Skate::exact(2.0))));
    let motor = InductanceMotor::new().exact(0.5);
    let motor = [4e-3, 2e-3].map(|h| error(InductanceMotor::new(), h, 0.5, |s| distance(&[s.q[0], s.v[0], s.z[0]], &motor)));
    let orders = [free, top, cartesian, skate, motor].map(order);
    assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.15), "{orders:?} {free:?} {top:?} {cartesian:?} {skate:?} {motor:?}");
}

#[test]
fn energy_of_a_mechanism_stays() {
    let mut system = SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0);
    let (start, probe) = (system.start(), system.clone());
    let mut run = Integration::new(&mut system, settings(1e-3, 1e-3), &start).unwrap();
    let (before, mut worst) = (probe.energy(&start), 0.0_f64);
    while run.advance(&mut system, 20.0).unwrap() != Progress::End {
        worst = worst.max((probe.energy(&run.node().state) / before - 1.0).abs());
    }
    // it swings with h² and does not drift
    assert!(worst < 2e-3, "{worst:e}");
}

#[test]
fn a_tolerance_is_refused() {
    let mut system = Pendulum::new();
    let start = system.start();
    let settings = Settings { control: Control::Tolerance(1e-6), ..settings(0.0, 0.0) };
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    assert!(run.advance(&mut system, 1.0).is_err());
}
