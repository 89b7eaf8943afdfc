//! Backward differences: orders, errors that follow the tolerance, singular positions, attitudes, events.

use crate::problems::*;
use allocation_counter::measure;
use grashof_solvers::{Control, Counts, Integration, Level, Method, Node, Progress, Settings, State, System, Why};

const LEVELS: [Level; 4] = [Level::Stabilized, Level::Position, Level::Velocity, Level::Acceleration];

fn settings(level: Level, order: Option<usize>, control: Control) -> Settings {
    Settings { method: Method::Bdf { order }, level, control, ..Settings::default() }
}

fn adaptive(tolerance: f64) -> Settings {
    settings(Level::Stabilized, None, Control::Tolerance(tolerance))
}

/// Runs to `end`; `see` is shown every node.
fn run(system: &mut dyn System, start: &State, settings: Settings, end: f64, mut see: impl FnMut(&Node)) -> Counts {
    let mut run = Integration::new(system, settings, start).unwrap();
    while run.advance(system, end).unwrap() != Progress::End {
        see(run.node());
    }
    see(run.node());
    assert_eq!(run.node().state.t, end);
    run.engine.counts
}

/// The last node of a run, and what it took.
fn last(problem: &mut dyn Problem, settings: Settings, end: f64) -> (Node, Counts) {
    let (start, mut node) = (problem.start(), Node::new(problem.dims()));
    let counts = run(problem, &start, settings, end, |n| node.copy_from(n));
    (node, counts)
}

/// Largest difference.
fn distance<const N: usize>(x: [f64; N], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |worst, (x, y)| f64::max(worst, (x - y).abs()))
}

/// Observed orders from the errors at a step and at its half.
fn orders<const N: usize>(errors: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (coarse, fine) = (errors(1.0), errors(0.5));
    std::array::from_fn(|i| (coarse[i] / fine[i]).log2())
}

/// Two steps whose sum is 2h, in the ratio 1 : `ratio`.
fn steps(h: f64, ratio: f64) -> [f64; 2] {
    [2.0 * h / (1.0 + ratio), 2.0 * h * ratio / (1.0 + ratio)]
}

#[test]
fn orders_1_to_5_hold_in_positions_velocities_and_multipliers_at_every_level() {
    for level in LEVELS {
        for (order, h) in [(1, 0.8e-3), (2, 1.6e-3), (3, 3.2e-3), (4, 3.2e-3), (5, 3.2e-3)] {
            for ratio in [1.0, 1.5] {
                let measured = orders(|scale| {
                    let mut system = Pendulum::new();
                    let (start, mut worst) = (system.start(), [0.0; 3]);
                    let given = settings(level, Some(order), Control::Steps(steps(scale * h, ratio)));
                    run(&mut system, &start, given, 1.0, |node| {
                        let (s, x) = (&node.state, Pendulum::exact(node.state.t));
                        let lambda = distance([Pendulum::exact_lambda(s.t)], &node.lambda);
                        let errors = [distance([x[0], x[1]], &s.q), distance([x[2], x[3]], &s.v), lambda];
                        worst = std::array::from_fn(|i| f64::max(worst[i], errors[i]));
                    });
                    worst
                });
                for x in measured {
                    assert!((x - order as f64).abs() < 0.1, "{level:?}, order {order}, 1 : {ratio}: {measured:?}");
                }
            }
        }
    }
}

#[test]
fn orders_1_to_5_hold_for_quaternions_with_and_without_rows() {
    for (order, h) in [(1, 2.5e-5), (2, 1e-4), (3, 2.5e-4), (4, 2.5e-4), (5, 2.5e-4)] {
        for ratio in [1.0, 1.5] {
            let measured = orders(|scale| {
                let given = |h: f64| settings(Level::Stabilized, Some(order), Control::Steps(steps(scale * h, ratio)));
                let (top, _) = last(&mut HeavyTopCartesian::cusp(), given(h), 0.2);
                let (body, _) = last(&mut FreeBody::new(), given(if order < 3 { 200.0 * h } else { 100.0 * h }), 5.0);
                let (_, omega, _) = FreeBody::OUTPUTS[0];
                [distance(HeavyTop::OUTPUTS[2].1, &top.state.q), distance(omega, &body.state.v)]
            });
            for x in measured {
                assert!((x - order as f64).abs() < 0.15, "order {order}, 1 : {ratio}: {measured:?}");
            }
        }
    }
}

#[test]
fn the_error_of_andrews_mechanism_follows_the_tolerance() {
    for e in 4..=10 {
        let tolerance = 10.0_f64.powi(-e);
        let (node, counts) = last(&mut Andrews::new(), adaptive(tolerance), 0.03);
        let error = distance(Andrews::Q_03, &node.state.q) / tolerance;
        println!("{tolerance:.0e}: {error:.0} tolerances, {counts:?}");
        assert!((0.01..100.0).contains(&error), "{tolerance:.0e}: {error}");
    }
}

#[test]
fn andrews_mechanism_has_ten_digits() {
    // 1e-12 is the strictest tolerance that counts: below it there is round-off
    for (tolerance, most) in [(1e-12, 1e-10), (1e-13, 1e-9), (1e-14, 1e-9)] {
        let (node, counts) = last(&mut Andrews::new(), adaptive(tolerance), 0.03);
        let error = distance(Andrews::Q_03, &node.state.q);
        println!("{tolerance:.0e}: {error:.1e}, {counts:?}");
        assert!(error < most && counts.bridges == 0, "{tolerance:.0e}: {error} {counts:?}");
        // every angle by itself
        assert!(node.state.q.iter().zip(Andrews::Q_03).all(|(x, y)| (x - y).abs() < 1e-10 * y.abs()), "{:?}", node.state.q);
    }
}

/// Largest drift of the energy in 10 s with the state at the end, projected as it is reported.
fn drift<P: Problem + Clone>(problem: &P, tolerance: f64) -> (f64, Node, Counts) {
    let (mut system, start, mut end) = (problem.clone(), problem.start(), Node::new(problem.dims()));
    let (e0, mut worst) = (problem.energy(&start), 0.0_f64);
    let mut run = Integration::new(&mut system, adaptive(tolerance), &start).unwrap();
    while run.advance(&mut system, 10.0).unwrap() != Progress::End {
        worst = worst.max((problem.energy(&run.node().state) - e0).abs());
    }
    worst = worst.max((problem.energy(&run.node().state) - e0).abs());
    run.at(&mut system, 10.0, &mut end).unwrap();
    (worst, end, run.engine.counts)
}

/// N four-bars through their flat positions, beside their equation of one freedom.
///
/// Ten flat positions make ten bridges. Links are compared at the end: in a flat position itself Φ does not tell parallel links
/// from others.
fn four_bars(n: usize, tolerance: f64) {
    let (reference, ..) = drift(&FourBarTwin::new(n), tolerance);
    // kinetic energy of the linkage at φ̇ = 1 by that of its twin
    let reference = reference * (4 * n + 1) as f64 / 3.0;
    let system = NFourBar::new(n, 1e-15);
    let (energy, end, counts) = drift(&system, tolerance);
    let angles = system.angles(&end.state.q);
    let parallel = angles.iter().fold(0.0, |worst, x| f64::max(worst, (x - angles[0]).abs()));
    assert!(
        (10..12).contains(&counts.bridges) && energy <= 10.0 * reference,
        "{n} at {tolerance:.0e}: {energy} J, twin {reference} J, {counts:?}"
    );
    assert!(parallel < 1e-12, "{n} at {tolerance:.0e}: {parallel}");
}

#[test]
fn one_four_bar_crosses_its_flat_positions() {
    four_bars(1, 1e-8);
    four_bars(1, 1e-10);
}

#[test]
fn two_four_bars_cross_their_flat_positions() {
    four_bars(2, 1e-8);
    four_bars(2, 1e-10);
}

#[test]
fn six_four_bars_cross_their_flat_positions() {
    four_bars(6, 1e-8);
    four_bars(6, 1e-10);
}

#[test]
fn ten_four_bars_cross_their_flat_positions() {
    four_bars(10, 1e-8);
    four_bars(10, 1e-10);
}

#[test]
fn equal_arms_cross_their_singular_position() {
    for tolerance in [1e-8, 1e-10] {
        let (energy, end, counts) = drift(&SliderCrank::equal_arms(1e-15), tolerance);
        let parallel = (end.state.q[2] + end.state.q[5]).abs();
        println!("{tolerance:.0e}: {energy:.1e} J, parallel {parallel:.1e}, {counts:?}");
        assert!(counts.bridges > 0 && energy < 2e3 * tolerance && parallel < 1e-12, "{tolerance:.0e}: {energy} {parallel} {counts:?}");
    }
}

#[test]
fn attitudes_states_and_rows_of_velocities_follow_the_tolerance() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let end = |problem: &mut dyn Problem, t: f64| last(problem, adaptive(tolerance), t).0.state;
        let top = distance(HeavyTop::OUTPUTS[5].1, &HeavyTop::centre(&end(&mut HeavyTop::cusp(), 1.0).q));
        let cartesian = distance(HeavyTop::OUTPUTS[5].1, &end(&mut HeavyTopCartesian::cusp(), 1.0).q);
        let (t, omega, _) = FreeBody::OUTPUTS[6];
        let body = distance(omega, &end(&mut FreeBody::new(), t).v);
        let skate = distance(Skate::exact(5.0), &end(&mut Skate::new(), 5.0).q);
        let motor = InductanceMotor::new();
        let s = end(&mut motor.clone(), 2.0);
        let motor = distance(motor.exact(2.0), &[s.q[0], s.v[0], s.z[0]]);
        let axle = distance(CarAxis::Q_3, &end(&mut CarAxis::new(), 3.0).q);
        let errors = [top, cartesian, body, skate, motor, axle].map(|error| error / tolerance);
        println!("{tolerance:.0e}: {errors:.1?}");
        assert!(errors.iter().all(|error| *error < 100.0), "{tolerance:.0e}: {errors:?}");
    }
}

#[test]
fn a_stiff_spring_does_not_shorten_the_steps() {
    let mut pair = StiffPair::new(1e6, 2e3);
    let exact = pair.exact(10.0);
    let (node, counts) = last(&mut pair, adaptive(1e-6), 10.0);
    assert!(distance([exact[0], exact[1]], &node.state.q) < 1e-4, "{:?}", node.state.q);
    assert!(counts.steps < 400 && counts.rejected < 10, "{counts:?}");
}

#[test]
fn every_level_runs_by_the_error() {
    for level in LEVELS {
        let (node, counts) = last(&mut Pendulum::new(), settings(level, None, Control::Tolerance(1e-8)), 2.0);
        let exact = Pendulum::exact(2.0);
        let error = distance([exact[0], exact[1]], &node.state.q);
        println!("{level:?}: {error:.1e} {counts:?}");
        assert!(error < 1e-6 && counts.steps < 800, "{level:?}: {error} {counts:?}");
    }
}

/// Nodes of a run through events against a closed form of the first coordinate.
fn through_events(problem: &mut dyn Problem, settings: Settings, end: f64, exact: &dyn Fn(f64) -> [f64; 2]) -> (f64, Counts) {
    let (start, mut worst) = (problem.start(), 0.0);
    let counts = run(problem, &start, settings, end, |node| worst = f64::max(worst, distance([exact(node.state.t)[0]], &node.state.q)));
    (worst, counts)
}

#[test]
fn events_are_no_loss_of_accuracy() {
    let (ball, dry, kinked) = (BouncingBall::new(1.0, 0.5), DryOscillator::new(1.0), KinkedSpring::new(1.0, 9.0));
    let (a, counts) = through_events(&mut ball.clone(), adaptive(1e-8), 1.2, &|t| ball.exact(t));
    assert!(a < 1e-6 && counts.events >= 3, "{a} {counts:?}");
    let (b, counts) = through_events(&mut dry.clone(), adaptive(1e-8), 5.0, &|t| dry.exact(t));
    assert!(b < 1e-6 && counts.events >= 10, "{b} {counts:?}");
    let (c, counts) = through_events(&mut kinked.clone(), adaptive(1e-8), 10.0, &|t| kinked.exact(t));
    println!("{a:.1e} {b:.1e} {c:.1e} {counts:?}");
    assert!(c < 1e-6 && counts.events >= 4, "{c} {counts:?}");
    let given = settings(Level::Stabilized, Some(4), Control::Steps([0.01, 0.01]));
    let (d, _) = through_events(&mut kinked.clone(), given, 10.0, &|t| kinked.exact(t));
    assert!(d < 1e-5, "{d}");
}

#[test]
fn a_scheme_may_march_across_switches() {
    let kinked = KinkedSpring::new(1.0, 9.0);
    let across = Settings { locate: false, ..adaptive(1e-6) };
    let (error, counts) = through_events(&mut kinked.clone(), across, 10.0, &|t| kinked.exact(t));
    assert!(error < 1e-3 && counts.events == 0 && counts.stepped_over >= 4, "{error} {counts:?}");
}

#[test]
fn the_continuous_solution_meets_both_ends_and_is_as_good_as_they_are() {
    for (order, tolerance) in [(None, 1e-4), (None, 1e-8), (Some(1), 1e-3), (Some(2), 1e-5), (Some(3), 1e-6)] {
        let mut system = Pendulum::new();
        let start = system.start();
        let mut run = Integration::new(&mut system, settings(Level::Stabilized, order, Control::Tolerance(tolerance)), &start).unwrap();
        let (mut nodes, mut inside) = (0.0_f64, 0.0_f64);
        let mut s = start.clone();
        while run.advance(&mut system, 2.0).unwrap() != Progress::End {
            let (from, to) = (run.last().clone(), run.node().clone());
            let error = |s: &State| {
                let x = Pendulum::exact(s.t);
                distance([x[0], x[1], x[2], x[3]], &[s.q.as_slice(), &s.v].concat())
            };
            nodes = nodes.max(error(&to.state));
            for k in 0..=10 {
                run.dense(&mut system).unwrap().evaluate(from.state.t + (to.state.t - from.state.t) * f64::from(k) / 10.0, &mut s);
                inside = inside.max(error(&s));
            }
            assert!(to.state.q.iter().zip(&s.q).all(|(x, y)| (x - y).abs() < 1e-13), "{to:?} {s:?}");
        }
        assert!(inside < 1.1 * nodes, "{order:?} {tolerance:.0e}: nodes {nodes}, inside {inside}");
    }
}

#[test]
fn short_ends_of_spans_do_no_harm() {
    let mut system = Pendulum::new();
    let start = system.start();
    let mut run = Integration::new(&mut system, settings(Level::Stabilized, Some(5), Control::Steps([0.01, 0.01])), &start).unwrap();
    let mut worst = 0.0_f64;
    // spans that end a little behind a step, and between steps
    for end in [0.200_000_1, 0.413, 0.7, 0.700_001, 1.0] {
        while run.advance(&mut system, end).unwrap() != Progress::End {}
        let x = Pendulum::exact(end);
        worst = worst.max(distance([x[0], x[1]], &run.node().state.q));
    }
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn steps_allocate_nothing() {
    let problems: [Box<dyn Problem>; 4] =
        [Box::new(Andrews::new()), Box::new(HeavyTopCartesian::cusp()), Box::new(DryOscillator::new(1.0)), Box::new(NFourBar::new(1, 0.0))];
    for mut system in problems {
        let start = system.start();
        let end = if system.dims().v == 7 { 0.01 } else { 1.0 };
        let mut run = Integration::new(system.as_mut(), adaptive(1e-8), &start).unwrap();
        run.advance(system.as_mut(), end).unwrap();
        let info = measure(|| while run.advance(system.as_mut(), end).unwrap() != Progress::End {});
        assert_eq!(info.count_total, 0, "{}", system.name());
    }
}

#[test]
fn steps_that_shrink_as_newtons_method_fails_are_told_so() {
    for method in [Method::Bdf { order: None }, Method::Radau5] {
        let mut system = Wavering::new();
        let start = system.start();
        let given = Settings { method, ..adaptive(1e-6) };
        let mut run = Integration::new(&mut system, given, &start).unwrap();
        let halt = loop {
            match run.advance(&mut system, 2.0) {
                Ok(Progress::End) => panic!("{method:?} passes"),
                Ok(_) => {}
                Err(halt) => break halt,
            }
        };
        assert!(halt.why == Why::Newton && (halt.t - 0.5).abs() < 1e-9, "{method:?}: {halt:?}");
    }
}
