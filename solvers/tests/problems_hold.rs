//! The test problems are what they claim to be: consistent, differentiated right, in balance, and equal to their references.

#[path = "problems/references.rs"]
mod references;

use crate::problems::*;
use grashof_solvers::{At, Block, Control, Dims, Effect, Engine, Span, Stage, State, Tangent, Terms};

/// Step of the differences, as a part of the scale: 4e-21 of the seventh derivative lost, 1e-13 of round-off.
const H: f64 = 4e-4;
/// Of the largest number in a comparison with differences.
const DIFFERENCE: f64 = 1e-9;

/// df/de at 0 of f(e, out), by Richardson's extrapolation of central differences (order 6).
fn slope(h: f64, n: usize, mut f: impl FnMut(f64, &mut [f64])) -> Vec<f64> {
    let mut difference = |k: f64| -> Vec<f64> {
        let (mut high, mut low) = (vec![0.0; n], vec![0.0; n]);
        f(k * h, &mut high);
        f(-k * h, &mut low);
        high.iter().zip(&low).map(|(x, y)| (x - y) / (2.0 * k * h)).collect()
    };
    let (one, two, three) = (difference(1.0), difference(2.0), difference(3.0));
    (0..n).map(|i| 1.5 * one[i] - 0.6 * two[i] + 0.1 * three[i]).collect()
}

/// max |x|; infinite if an entry is not a number.
fn largest(x: &[f64]) -> f64 {
    x.iter().map(|x| if x.is_nan() { f64::INFINITY } else { x.abs() }).fold(0.0, f64::max)
}

fn distance(x: &[f64], y: &[f64]) -> f64 {
    assert_eq!(x.len(), y.len());
    largest(&minus(x, y))
}

#[track_caller]
fn close(what: &str, actual: &[f64], expected: &[f64], tolerance: f64) {
    let scale = largest(expected).max(largest(actual));
    let error = distance(actual, expected);
    assert!(error <= tolerance * scale, "{what}: {error:e} of {scale:e}\n{actual:?}\n{expected:?}");
}

fn minus(x: &[f64], y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x - y).collect()
}

/// Pseudo-random numbers in [−1, 1).
fn random(n: usize, seed: usize) -> Vec<f64> {
    (0..n).map(|i| noise(seed as f64, &[], i)).collect()
}

/// A problem in a state away from its start, with accelerations and multipliers that belong to nothing.
struct Probe {
    problem: Box<dyn Problem>,
    /// The same again, for its coordinates while `problem` is at work.
    chart: Box<dyn Problem>,
    state: State,
    a: Vec<f64>,
    lambda: Vec<f64>,
    /// Step of differences over time (s).
    h: f64,
}

/// Every problem, three states each.
fn probes() -> impl Iterator<Item = Probe> {
    (1..4).flat_map(|seed| all().into_iter().zip(all()).map(move |(problem, chart)| probe(problem, chart, seed)))
}

fn probe(mut problem: Box<dyn Problem>, chart: Box<dyn Problem>, seed: usize) -> Probe {
    // the links of the squeezer are so light that unit accelerations would vanish beside its spring
    let fast = if problem.name().contains("Andrews") { 1e3 } else { 1.0 };
    let (dims, mut state) = (problem.dims(), problem.start());
    state.t = 0.37;
    problem.retract(Span::at(state.t), &mut state.q, &random(dims.v, seed).iter().map(|x| 0.3 * x).collect::<Vec<_>>());
    state.v.iter_mut().zip(random(dims.v, seed + 10)).for_each(|(v, x)| *v += fast * x);
    state.z = random(dims.z, seed + 20);
    let mut modes = state.modes.clone();
    problem.modes(state.at(), &mut modes);
    state.modes = modes;
    let a = random(dims.v, seed + 30).iter().map(|x| fast * fast * x).collect();
    let h = H / (1.0 + largest(&state.v));
    Probe { problem, chart, state, a, lambda: random(dims.rows(), seed + 40), h }
}

impl Probe {
    fn dims(&self) -> Dims {
        self.problem.dims()
    }

    /// The state a little later by constant velocities and the given accelerations.
    fn later(&self, e: f64, a: &[f64], zdot: &[f64]) -> State {
        let mut state = self.state.clone();
        let delta: Vec<f64> = self.state.v.iter().map(|v| e * v).collect();
        self.problem.retract(Span::at(state.t), &mut state.q, &delta);
        state.t += e;
        state.v.iter_mut().zip(a).for_each(|(v, a)| *v += e * a);
        state.z.iter_mut().zip(zdot).for_each(|(z, d)| *z += e * d);
        state
    }

    /// The terms at a state.
    fn terms(&mut self, state: &State) -> Terms {
        let mut terms = Terms::new(self.dims(), self.problem.pattern());
        self.problem.terms(state.at(), Stage::Dynamics, &mut terms);
        terms
    }

    /// G x.
    fn along(&self, terms: &Terms, x: &[f64]) -> Vec<f64> {
        terms.g.lines().map(|row| row.dot(x)).collect()
    }
}

#[test]
fn starts_are_consistent() {
    for mut problem in all() {
        let (start, dims) = (problem.start(), problem.dims());
        let mut terms = Terms::new(dims, problem.pattern());
        problem.terms(start.at(), Stage::Dynamics, &mut terms);
        let rates: Vec<f64> = terms.g.lines().map(|row| row.dot(&start.v)).collect();
        assert!(largest(&terms.phi) < 1e-14, "{}: {:?}", problem.name(), terms.phi);
        assert!(distance(&rates, &terms.nu) < 1e-12, "{}: {rates:?}", problem.name());
        let mut modes = start.modes.clone();
        problem.modes(start.at(), &mut modes);
        assert_eq!(modes, start.modes, "{}", problem.name());
        let sizes = [start.q.len(), start.v.len(), start.z.len(), start.modes.len(), start.live.len(), start.work.len()];
        assert_eq!(sizes, [dims.q, dims.v, dims.z, dims.modes, dims.live, dims.work], "{}", problem.name());
        let (metric, scale) = (&problem.pattern().metric, &problem.pattern().g_scale);
        assert!(metric.iter().chain(scale).all(|x| *x > 0.0) && metric.len() == dims.v && scale.len() == dims.rows());
    }
}

#[test]
fn motion_by_a_displacement_has_the_rate_of_the_velocity() {
    for p in probes() {
        let mut rate = vec![0.0; p.dims().q];
        p.problem.rate(p.state.t, &p.state.q, &p.state.v, &mut rate);
        let moved = slope(p.h, p.dims().q, |e, q| q.copy_from_slice(&p.later(e, &[], &[]).q));
        close(p.problem.name(), &moved, &rate, DIFFERENCE);
    }
}

#[test]
fn an_implicit_displacement_solves_its_equation() {
    for p in probes() {
        let u = random(p.dims().v, 5);
        let (mut q, mut step) = (p.state.q.clone(), vec![0.0; p.dims().q]);
        p.problem.displace(Span::at(p.state.t), &mut q, &u);
        p.problem.rate(p.state.t, &q, &u, &mut step);
        close(p.problem.name(), &minus(&q, &step), &p.state.q, 1e-15);
    }
}

#[test]
fn rows_are_the_rates_of_what_they_constrain() {
    for mut p in probes() {
        let (n, rows) = (p.dims().holonomic, p.dims().rows());
        let now = p.state.clone();
        let terms = p.terms(&now);
        let speed = minus(&p.along(&terms, &now.v), &terms.nu);
        let phi = slope(p.h, n, |e, out| out.copy_from_slice(&p.terms(&p.later(e, &[], &[])).phi));
        close(p.problem.name(), &phi, &speed[..n], DIFFERENCE);
        let a = p.a.clone();
        let acceleration = minus(&p.along(&terms, &a), &terms.gamma);
        let rate = slope(p.h, rows, |e, out| {
            let later = p.later(e, &a, &[]);
            let terms = p.terms(&later);
            out.copy_from_slice(&minus(&p.along(&terms, &later.v), &terms.nu));
        });
        close(p.problem.name(), &rate, &acceleration, DIFFERENCE);
    }
}

/// Column j of a matrix.
fn column(matrix: &Block, j: usize) -> Vec<f64> {
    (0..matrix.pattern().rows()).map(|i| matrix.at(i, j)).collect()
}

#[test]
fn tangents_are_the_derivatives_of_the_residual() {
    for mut p in probes() {
        let (dims, now) = (p.dims(), p.state.clone());
        let (a, lambda, name) = (p.a.clone(), p.lambda.clone(), p.problem.name());
        let mut tangent = Tangent::new(p.problem.pattern());
        for block in [&mut tangent.k, &mut tangent.c, &mut tangent.r_z, &mut tangent.r_lambda] {
            block.values_mut().fill(f64::NAN);
        }
        p.problem.tangent(now.at(), &a, &lambda, &mut tangent);
        // r and ż at a state, one after the other
        let mut both = |state: &State, out: &mut [f64]| {
            p.problem.residual(state.at(), &a, &lambda, &mut out[..dims.v]);
            let mut terms = Terms::new(dims, p.problem.pattern());
            p.problem.terms(state.at(), Stage::Dynamics, &mut terms);
            out[dims.v..].copy_from_slice(&terms.zdot);
        };
        let mut check = |block: &Block, z_block: &Block, columns: usize, h: f64, change: &dyn Fn(&mut State, usize, f64)| {
            for j in 0..columns {
                let numeric = slope(h, dims.v + dims.z, |e, out| {
                    let mut state = now.clone();
                    change(&mut state, j, e);
                    both(&state, out);
                });
                let exact = [column(block, j), column(z_block, j)].concat();
                let scale = largest(block.values()).max(largest(z_block.values())).max(1e-3);
                assert!(distance(&numeric, &exact) <= DIFFERENCE * scale, "{name}, column {j}: {numeric:?} {exact:?}");
            }
        };
        check(&tangent.k, &tangent.z_q, dims.v, H, &|state, j, e| {
            let mut delta = vec![0.0; dims.v];
            delta[j] = e;
            p.chart.retract(Span::at(state.t), &mut state.q, &delta);
        });
        check(&tangent.c, &tangent.z_v, dims.v, H * (1.0 + largest(&now.v)), &|state, j, e| state.v[j] += e);
        check(&tangent.r_z, &tangent.z_z, dims.z, H, &|state, j, e| state.z[j] += e);
        assert!(tangent.r_lambda.values().iter().all(|x| *x == 0.0), "{name}");
    }
}

#[test]
fn energy_changes_by_the_powers() {
    for mut p in probes() {
        let mut solver = Explicit::new(p.problem.as_mut());
        solver.project_velocity(p.problem.as_mut(), &mut p.state);
        solver.accelerate(p.problem.as_mut(), p.state.at());
        let now = p.state.clone();
        let (terms, mut power) = (p.terms(&now), vec![0.0; p.dims().work]);
        p.problem.power(now.at(), &solver.a, &solver.lambda, &mut power);
        let h = H / (1.0 + largest(&now.v));
        let rate = slope(h, 1, |e, out| out[0] = p.problem.energy(&p.later(e, &solver.a, &terms.zdot)))[0];
        let forces: f64 = terms.force.iter().zip(&now.v).map(|(f, v)| (f * v).abs()).sum();
        let scale = forces + largest(&power) + p.problem.energy(&now).abs();
        let error = (rate - power.iter().sum::<f64>()).abs();
        assert!(error < 1e-9 * scale, "{}: {rate} {power:?} of {scale}", p.problem.name());
    }
}

/// Terms filled with a number that no evaluation gives.
fn dirty(problem: &dyn Problem) -> Terms {
    let mut terms = Terms::new(problem.dims(), problem.pattern());
    let Terms { mass, force, phi, g, nu, gamma, zdot, position: _ } = &mut terms;
    for values in [mass.values_mut(), force, phi, g.values_mut(), nu, gamma, zdot] {
        values.fill(-77.5);
    }
    terms
}

#[test]
fn evaluations_overwrite_their_stage_and_depend_on_nothing_else() {
    for mut p in probes() {
        let (now, name) = (p.state.clone(), p.problem.name());
        let first = p.terms(&now);
        let start = p.problem.start();
        p.terms(&start);
        let mut again = dirty(p.problem.as_ref());
        p.problem.terms(now.at(), Stage::Position, &mut again);
        assert_eq!((&again.mass, &again.g, &again.phi), (&first.mass, &first.g, &first.phi), "{name}");
        assert!(again.nu.iter().chain(&again.gamma).chain(&again.force).chain(&again.zdot).all(|x| *x == -77.5), "{name}");
        p.problem.terms(now.at(), Stage::Velocity, &mut again);
        assert_eq!((&again.nu, &again.gamma), (&first.nu, &first.gamma), "{name}");
        assert!(again.force.iter().chain(&again.zdot).all(|x| *x == -77.5), "{name}");
        p.problem.terms(now.at(), Stage::Dynamics, &mut again);
        assert_eq!(again, first, "{name}");
    }
}

#[test]
fn noise_is_small_pure_and_different_everywhere() {
    let amplitude = 1e-15;
    let pairs: [(Box<dyn Problem>, Box<dyn Problem>); 2] = [
        (Box::new(NFourBar::new(2, amplitude)), Box::new(NFourBar::new(2, 0.0))),
        (Box::new(SliderCrank::equal_arms(amplitude)), Box::new(SliderCrank::equal_arms(0.0))),
    ];
    for (mut noisy, mut clean) in pairs {
        let mut state = clean.start();
        let terms = |problem: &mut dyn Problem, at: At<'_>| {
            let mut terms = dirty(problem);
            problem.terms(at, Stage::Dynamics, &mut terms);
            terms
        };
        let (with, without) = (terms(noisy.as_mut(), state.at()), terms(clean.as_mut(), state.at()));
        // of the order of its amplitude, once the rounding of γ itself is allowed for
        assert!(distance(&with.phi, &without.phi) > 0.1 * amplitude && distance(&with.phi, &without.phi) < 2.0 * amplitude);
        assert!(distance(&with.gamma, &without.gamma) > 0.1 * amplitude && distance(&with.gamma, &without.gamma) < 3.0 * amplitude);
        assert_eq!(Terms { phi: without.phi.clone(), gamma: without.gamma.clone(), ..with.clone() }, without);
        assert_eq!(terms(noisy.as_mut(), state.at()), with);
        state.t += 1e-9;
        assert_ne!(terms(noisy.as_mut(), state.at()).phi, with.phi);
    }
    let sample: Vec<f64> = (0..4000).map(|i| noise(i as f64, &[1.0], 0)).collect();
    let mean = sample.iter().sum::<f64>() / 4000.0;
    let square = sample.iter().map(|x| x * x).sum::<f64>() / 4000.0;
    assert!(mean.abs() < 0.03 && (square - 1.0 / 3.0).abs() < 0.02 && largest(&sample) < 1.0, "{mean} {square}");
}

#[test]
fn roots_are_positive_inside_of_their_mode() {
    for mut p in probes().filter(|p| p.dims().roots > 0) {
        let (mut roots, name) = (vec![0.0; p.dims().roots], p.problem.name());
        let now = p.state.clone();
        p.problem.roots(now.at(), &p.a, &p.lambda, &mut roots);
        assert!(roots.iter().all(|g| *g > 0.0), "{name}: {roots:?}");
        // and a little after the start
        let (mut solver, mut state) = (Explicit::new(p.problem.as_mut()), p.problem.start());
        solver.run(p.problem.as_mut(), &mut state, 1e-6, 1);
        p.problem.roots(state.at(), &solver.a, &solver.lambda, &mut roots);
        assert!(roots.iter().all(|g| *g > 0.0), "{name}: {roots:?}");
    }
}

#[test]
fn a_crossing_leads_to_the_mode_of_the_other_side() {
    let mut dry = DryOscillator::new(1.0);
    let mut state = State { q: vec![-0.5], v: vec![1e-12], modes: vec![-1], ..dry.start() };
    assert_eq!(crossed(&mut dry, &mut state), (Effect::Restart, vec![1]));
    let mut state = State { q: vec![0.02], v: vec![1e-12], modes: vec![-1], ..dry.start() };
    assert_eq!(crossed(&mut dry, &mut state), (Effect::Restart, vec![0]));
    assert_eq!(state.v, [0.0]);
    let mut kinked = KinkedSpring::new(1.0, 9.0);
    let mut state = kinked.start();
    assert_eq!(crossed(&mut kinked, &mut state), (Effect::Restart, vec![-1]));
    let mut state = RecordAt::new(0.5).start();
    assert_eq!(crossed(&mut RecordAt::new(0.5), &mut state), (Effect::Record, vec![-1]));
    assert_eq!(crossed(&mut StopAt::new(0.5), &mut state).0, Effect::Stop);
    let mut row = [0.0];
    let mut ball = BouncingBall::new(1.0, 0.5);
    let mut state = ball.start();
    assert_eq!(grashof_solvers::System::cross(&mut ball, 0, &mut state, &mut row), Effect::Impulse { restitution: 0.5, stops: false });
    assert_eq!(row, [1.0]);
}

/// The effect of the crossing of the first root, and the modes after it.
fn crossed(problem: &mut dyn Problem, state: &mut State) -> (Effect, Vec<i32>) {
    let effect = problem.cross(0, state, &mut [0.0]);
    (effect, state.modes.clone())
}

#[test]
fn a_state_is_near_the_constraints_if_its_position_and_velocity_are() {
    let mut pendulum = Pendulum::new();
    let mut engine = Engine::new(&pendulum, Control::Tolerance(1e-8));
    let start = pendulum.start();
    let mut is_near = |q: f64, v: f64| {
        let mut state = start.clone();
        state.q.iter_mut().for_each(|x| *x *= 1.0 + q);
        // along the rod, whose length must not change
        state.v.iter_mut().zip(&start.q).for_each(|(u, x)| *u += v * x);
        engine.is_near(&mut pendulum, &state, 1e-6)
    };
    assert!(is_near(0.0, 0.0) && is_near(1e-8, 1e-8));
    assert!(!is_near(1e-4, 0.0));
    assert!(!is_near(0.0, 1e-4));
}
