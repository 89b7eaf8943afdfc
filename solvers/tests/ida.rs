//! IDA of SUNDIALS: it follows its tolerance on constrained systems of every kind, and behaves in the loop.
#![cfg(feature = "sundials")]

use crate::problems::*;
use allocation_counter::measure;
use grashof_solvers::{Control, Counts, Engine, Integration, Method, Node, Progress, Scheme, Settings, State, System, schemes};

const TOLERANCES: [f64; 7] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

fn settings(tolerance: f64) -> Settings {
    Settings { method: Method::Ida, control: Control::Tolerance(tolerance), ..Settings::default() }
}

/// Runs to `end`; `see` is shown every node.
fn run(system: &mut dyn System, settings: Settings, start: &State, end: f64, mut see: impl FnMut(&Node)) -> Counts {
    let mut run = Integration::new(system, settings, start).unwrap();
    while run.advance(system, end).unwrap() != Progress::End {
        see(run.node());
    }
    see(run.node());
    assert_eq!(run.node().state.t, end);
    run.engine.counts
}

/// A scheme without the loop, which would bridge what it takes for a singular position.
struct Alone {
    scheme: Box<dyn Scheme>,
    engine: Engine,
    node: Node,
    next: Node,
}

impl Alone {
    fn new(system: &mut dyn System, start: &State, tolerance: f64, first: f64) -> Self {
        let mut scheme = schemes::new(Method::Ida, settings(tolerance), system);
        let mut engine = Engine::new(system, Control::Tolerance(tolerance));
        let mut node = Node { state: start.clone(), ..Node::new(system.dims()) };
        engine.settle(system, &mut node).unwrap();
        scheme.restart(system, &mut engine, &node, first).unwrap();
        Self { scheme, engine, next: node.clone(), node }
    }

    fn step(&mut self, system: &mut dyn System, end: f64) {
        let left = end - self.node.state.t;
        self.scheme.attempt(system, &mut self.engine, &self.node, left, &mut self.next).unwrap();
        self.scheme.accept(&mut self.engine, &self.node, &self.next);
        std::mem::swap(&mut self.node, &mut self.next);
    }
}

fn largest(x: &[f64], y: &[f64]) -> f64 {
    assert_eq!(x.len(), y.len());
    x.iter().zip(y).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

#[test]
fn a_pendulum_follows_the_tolerance_in_coordinates_velocities_and_multiplier() {
    for tolerance in TOLERANCES {
        let mut system = Pendulum::new();
        let start = system.start();
        let mut worst = [0.0_f64; 4];
        run(&mut system, settings(tolerance), &start, 10.0, |node| {
            let ([x, y, vx, vy], s) = (Pendulum::exact(node.state.t), &node.state);
            let errors = [largest(&[x, y], &s.q), largest(&[vx, vy], &s.v), (Pendulum::exact_lambda(s.t) - node.lambda[0]).abs()];
            let closed = (s.q[0].hypot(s.q[1]) - 1.0).abs();
            worst.iter_mut().zip(errors.into_iter().chain([closed])).for_each(|(w, e)| *w = w.max(e));
        });
        // velocities reach 4.4 m/s, the multiplier 29 N
        assert!(worst[0] < 100.0 * tolerance && worst[1] < 500.0 * tolerance && worst[2] < 3000.0 * tolerance, "{tolerance}: {worst:?}");
        assert!(worst[3] < 1e-14, "{tolerance}: {worst:?}");
    }
}

#[test]
fn andrews_mechanism_follows_the_tolerance_to_ten_digits() {
    for tolerance in TOLERANCES.into_iter().chain([1e-12]) {
        let mut system = Andrews::new();
        let start = system.start();
        let mut alone = Alone::new(&mut system, &start, tolerance, 1e-5);
        while alone.node.state.t < 0.03 {
            alone.step(&mut system, 0.03);
        }
        let q = &alone.node.state.q;
        let error = largest(&Andrews::Q_03, q);
        assert!(error < 100.0 * tolerance || tolerance < 1e-11, "{tolerance}: {error}");
        if tolerance < 1e-11 {
            let digits = q.iter().zip(Andrews::Q_03).fold(f64::INFINITY, |m, (x, y)| f64::min(m, -((x - y) / y).abs().log10()));
            assert!(digits > 10.0, "{digits}");
        }
        // in the loop, where explicit steps may take over
        let mut end = start.clone();
        run(&mut system, settings(tolerance), &start, 0.03, |node| end.copy_from(&node.state));
        let error = largest(&Andrews::Q_03, &end.q);
        assert!(error < 100.0 * tolerance.max(1e-11), "{tolerance}: {error}");
    }
}

#[test]
fn quaternions_are_vectors_with_and_without_rows() {
    let (t, centre, _) = HeavyTop::OUTPUTS[4];
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let mut end = Vec::new();
        let mut top = HeavyTop::cusp();
        let start = top.start();
        run(&mut top, settings(tolerance), &start, t, |node| end = HeavyTop::centre(&node.state.q).to_vec());
        assert!(largest(&centre, &end) < 100.0 * tolerance, "{tolerance}: {end:?}");

        let mut top = HeavyTopCartesian::cusp();
        let start = top.start();
        run(&mut top, settings(tolerance), &start, t, |node| end = node.state.q[..3].to_vec());
        assert!(largest(&centre, &end) < 100.0 * tolerance, "{tolerance}: {end:?}");

        let mut body = FreeBody::new();
        let start = body.start();
        let (t, omega, _) = FreeBody::OUTPUTS[0];
        run(&mut body, settings(tolerance), &start, t, |node| end = node.state.v.clone());
        assert!(largest(&omega, &end) < 100.0 * tolerance, "{tolerance}: {end:?}");
    }
}

#[test]
fn first_order_states_and_velocity_rows_follow_the_tolerance() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let mut motor = InductanceMotor::new();
        let (start, exact) = (motor.start(), motor.clone());
        run(&mut motor, settings(tolerance), &start, 2.0, |node| {
            let s = &node.state;
            let error = largest(&exact.exact(s.t), &[s.q[0], s.v[0], s.z[0]]);
            // up to 60 rad/s
            assert!(error < 500.0 * tolerance, "{tolerance}: {error} at {}", s.t);
        });

        let mut skate = Skate::new();
        let start = skate.start();
        run(&mut skate, settings(tolerance), &start, 2.0, |node| {
            let error = largest(&Skate::exact(node.state.t), &node.state.q);
            assert!(error < 100.0 * tolerance, "{tolerance}: {error} at {}", node.state.t);
        });
    }
}

#[test]
fn other_schemes_come_to_the_same() {
    let ends = [Method::Ida, Method::Dop853, Method::Radau5].map(|method| {
        let crank: &mut dyn Problem = &mut SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0);
        [crank, &mut CarAxis::new()].map(|problem| {
            let start = problem.start();
            let mut end = start.clone();
            run(problem, Settings { method, ..settings(1e-9) }, &start, 2.0, |node| end.copy_from(&node.state));
            end
        })
    });
    for [crank, axle] in &ends[1..] {
        // the crank turns by twenty radians, and nothing holds its phase
        assert!(largest(&ends[0][0].q, &crank.q) < 1000.0 * 1e-9);
        assert!(largest(&ends[0][1].q, &axle.q) < 100.0 * 1e-9);
    }
}

#[test]
fn the_continuous_solution_is_as_good_as_the_nodes() {
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let mut system = Pendulum::new();
        let start = system.start();
        let mut run = Integration::new(&mut system, settings(tolerance), &start).unwrap();
        let (mut nodes, mut inside, mut state) = (0.0_f64, 0.0_f64, start.clone());
        let mut end = false;
        while !end {
            end = run.advance(&mut system, 2.0).unwrap() == Progress::End;
            let (a, b) = (run.last().state.t, run.node().state.t);
            for k in 1..=8 {
                let t = a + (b - a) * f64::from(k) / 8.0;
                run.dense(&mut system).unwrap().evaluate(t, &mut state);
                let error = largest(&Pendulum::exact(t), &[state.q[0], state.q[1], state.v[0], state.v[1]]);
                if k == 8 {
                    nodes = nodes.max(error);
                } else {
                    inside = inside.max(error);
                }
            }
        }
        assert!(inside < 1.1 * nodes, "{tolerance}: {inside} inside, {nodes} at nodes");
    }
}

#[test]
fn events_are_met_and_the_run_goes_on_behind_them() {
    let mut ball = BouncingBall::new(1.0, 0.5);
    let (start, exact) = (ball.start(), ball.clone());
    let counts = run(&mut ball, settings(1e-8), &start, 1.1, |node| {
        let error = (node.state.q[0] - exact.exact(node.state.t)[0]).abs();
        assert!(error < 1e-7, "{error} at {}", node.state.t);
    });
    assert!(counts.events >= 2);

    let mut spring = KinkedSpring::new(1.0, 9.0);
    let (start, exact) = (spring.start(), spring.clone());
    let counts = run(&mut spring, settings(1e-8), &start, 10.0, |node| {
        let error = largest(&exact.exact(node.state.t), &[node.state.q[0], node.state.v[0]]);
        assert!(error < 1e-5, "{error} at {}", node.state.t);
    });
    assert!(counts.events >= 4);
}

#[test]
fn singular_positions_are_crossed() {
    for (tolerance, sizes) in [(1e-8, &[1, 2, 6, 10][..]), (1e-10, &[1])] {
        for &n in sizes {
            let mut system = NFourBar::new(n, 1e-15);
            let (start, links) = (system.start(), system.clone());
            let energy = system.energy(&start);
            let counts = run(&mut system, settings(tolerance), &start, 4.0, |node| {
                let s = &node.state;
                let exact = NFourBar::exact(n, s.t)[0];
                let error = links.angles(&s.q).into_iter().fold(0.0, |m, phi| f64::max(m, (phi - exact).abs()));
                // two turns and four bridges
                assert!(error < 1e4 * tolerance, "{tolerance}, {n}: {error} at {}", s.t);
                let drift = (links.energy(s) - energy).abs() / energy;
                assert!(drift < 1e4 * tolerance, "{tolerance}, {n}: {drift} at {}", s.t);
            });
            assert!(counts.bridges > 0, "{counts:?}");
        }
    }
}

#[test]
fn given_steps_are_the_longest() {
    let mut system = Pendulum::new();
    let start = system.start();
    let mut last = 0.0;
    let settings = Settings { control: Control::Steps([1e-2, 1e-2]), ..settings(1e-8) };
    run(&mut system, settings, &start, 1.0, |node| {
        assert!(node.state.t - last < 1.0001e-2);
        assert!(largest(&Pendulum::exact(node.state.t)[..2], &node.state.q) < 1e-9);
        last = node.state.t;
    });
}

#[test]
fn steps_allocate_nothing() {
    let mut system = HeavyTopCartesian::cusp();
    let start = system.start();
    let mut alone = Alone::new(&mut system, &start, 1e-8, 1e-5);
    let info = measure(|| (0..200).for_each(|_| alone.step(&mut system, 1.0)));
    assert_eq!(info.count_total, 0);
    assert!(alone.engine.counts.factorisations > 0 && alone.engine.counts.iterations > 100);
}
