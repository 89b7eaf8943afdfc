//! Minimal coordinates: pure, consistent with the system inside, of full order with every kind of scheme.

use crate::problems::*;
use grashof_solvers::{Control, Integration, Method, Minimal, Node, Progress, Settings, Span, Stage, State, System, Tangent, Terms};

const TRAPEZOIDAL: Method = Method::Newmark { displacement: 0.25, velocity: 0.5 };
/// The linear acceleration method, which the positions of constraints would make unstable.
const LINEAR: Method = Method::Newmark { displacement: 1.0 / 6.0, velocity: 0.5 };

/// The problem in minimal coordinates and its start there.
fn minimal<P: Problem>(problem: P, independent: &[usize]) -> (Minimal<P>, State) {
    let start = problem.start();
    let minimal = Minimal::new(problem, &start, independent).unwrap();
    let reduced = minimal.reduced(&start);
    (minimal, reduced)
}

/// A run; every node of the system inside is handed to `see`.
fn run<P: Problem>(problem: P, independent: &[usize], settings: Settings, end: f64, mut see: impl FnMut(&Node)) -> Integration {
    let mut whole = Node::new(problem.dims());
    let (mut system, start) = minimal(problem, independent);
    if settings.method != Method::Rk4 && matches!(settings.control, Control::Steps(_)) {
        system.change_chart_at(0.3);
    }
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    loop {
        let progress = run.advance(&mut system, end).unwrap();
        system.whole(run.node(), &mut whole).unwrap();
        see(&whole);
        if progress == Progress::End {
            return run;
        }
    }
}

fn distance(x: &[f64], y: &[f64]) -> f64 {
    assert_eq!(x.len(), y.len());
    x.iter().zip(y).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

fn steps(method: Method, h: f64) -> Settings {
    Settings { method, control: Control::Steps([h, h]), ..Settings::default() }
}

fn tolerance(method: Method, tolerance: f64) -> Settings {
    Settings { method, control: Control::Tolerance(tolerance), ..Settings::default() }
}

/// Accelerations and multipliers of the system inside agree with those by its own KKT system, and its laws hold.
fn agrees(problem: impl Problem + Clone, independent: &[usize]) {
    let name = problem.name();
    let mut own = problem.clone();
    let (mut system, mut start) = minimal(problem, independent);
    start.v.iter_mut().enumerate().for_each(|(i, v)| *v += 0.3 + 0.1 * i as f64);
    let mut node = Node { state: start.clone(), ..Node::new(system.dims()) };
    let mut engine = grashof_solvers::Engine::new(&system, Control::Tolerance(1e-10));
    engine.settle(&mut system, &mut node).unwrap();
    let mut whole = Node::new(own.dims());
    system.whole(&node, &mut whole).unwrap();
    let mut engine = grashof_solvers::Engine::new(&own, Control::Tolerance(1e-10));
    let mut reference = whole.clone();
    engine.accelerate(&mut own, &mut reference).unwrap();
    assert!(engine.position_residual() < 1e-12 && engine.velocity_residual(&whole.state.v) < 1e-12, "{name}");
    let size = |x: &[f64]| 1.0 + x.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
    assert!(distance(&whole.a, &reference.a) < 1e-9 * size(&reference.a), "{name} {:?} {:?}", whole.a, reference.a);
    assert!(
        distance(&whole.lambda, &reference.lambda) < 1e-9 * size(&reference.lambda),
        "{name} {:?} {:?}",
        whole.lambda,
        reference.lambda
    );
    // the same bits again after calls elsewhere
    let mut terms = Terms::new(system.dims(), system.pattern());
    system.terms(node.state.at(), Stage::Dynamics, &mut terms);
    let (mut elsewhere, mut again) = (node.state.clone(), Terms::new(system.dims(), system.pattern()));
    system.retract(Span::at(elsewhere.t), &mut elsewhere.q, &vec![0.01; node.state.v.len()]);
    elsewhere.t += 0.02;
    system.terms(elsewhere.at(), Stage::Dynamics, &mut again);
    system.terms(node.state.at(), Stage::Dynamics, &mut again);
    assert_eq!(terms, again, "{name}");
}

#[test]
fn what_is_inside_agrees() {
    agrees(Pendulum::new(), &[]);
    agrees(Andrews::new(), &[]);
    agrees(Andrews::new(), &[0]);
    agrees(CarAxis::new(), &[]);
    agrees(SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0), &[2]);
    agrees(HeavyTopCartesian::cusp(), &[]);
    agrees(Skate::new(), &[]);
    agrees(RodChain::new(4), &[]);
    agrees(NFourBar::new(2, 0.0), &[]);
}

#[test]
fn impossible_choices_are_refused() {
    let pendulum = Pendulum::new();
    let start = pendulum.start();
    // at (−1, 0) x cannot move
    assert!(Minimal::new(pendulum.clone(), &start, &[0]).is_err());
    assert!(Minimal::new(pendulum.clone(), &start, &[0, 1]).is_err());
    assert!(Minimal::new(pendulum, &start, &[1]).is_ok());
}

#[test]
fn the_tangent_is_that_of_the_residual_at_rest() {
    // without velocities only the slope of ṗ and of P a is missing: none of them at a = 0
    let (mut system, start) = minimal(SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 0.0), &[2]);
    let mut tangent = Tangent::new(system.pattern());
    system.tangent(start.at(), &[0.0], &[], &mut tangent);
    let mut side = |sign: f64| {
        let (mut s, mut r) = (start.clone(), [0.0]);
        system.retract(Span::at(s.t), &mut s.q, &[sign * 1e-5]);
        system.residual(s.at(), &[0.0], &[], &mut r);
        r[0]
    };
    let slope = (side(1.0) - side(-1.0)) / 2e-5;
    assert!((slope - tangent.k.values()[0]).abs() < 1e-7, "{slope} {}", tangent.k.values()[0]);
}

#[test]
fn newmark_is_of_second_order() {
    for method in [TRAPEZOIDAL, LINEAR, Method::GeneralizedAlpha { rho: 0.8 }, Method::CentralDifference] {
        let errors = [4e-3, 2e-3].map(|h| {
            let mut worst = [0.0_f64; 3];
            // the chart changes twice in a swing
            let ended = run(Pendulum::new(), &[], steps(method, h), 2.0, |node| {
                let (s, x) = (&node.state, Pendulum::exact(node.state.t));
                let lambda = Pendulum::exact_lambda(s.t);
                let now = [distance(&s.q, &x[..2]), distance(&s.v, &x[2..]), (node.lambda[0] - lambda).abs()];
                worst.iter_mut().zip(now).for_each(|(w, e)| *w = w.max(e));
            });
            assert!(ended.engine.counts.events >= 2);
            worst
        });
        let orders = [0, 1, 2].map(|i| (errors[0][i] / errors[1][i]).log2());
        assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.2), "{method:?} {orders:?} {errors:?}");
    }
}

/// Largest error of the pendulum in its angle, which has no chart to change.
fn by_angle(settings: Settings, end: f64) -> f64 {
    let (mut system, mut worst) = (PendulumAngle::new(), 0.0_f64);
    let start = system.start();
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    while run.advance(&mut system, end).unwrap() != Progress::End {
        let (s, x) = (&run.node().state, PendulumAngle::exact(run.node().state.t));
        worst = worst.max((s.q[0] - x[0]).abs()).max((s.v[0] - x[1]).abs());
    }
    worst
}

#[test]
fn charts_change_where_they_degenerate() {
    // with a margin, and at the last moment
    for (method, tol, part) in [
        (Method::Dop853, 1e-10, 0.1),
        (Method::Dop853, 1e-10, 1e-3),
        (TRAPEZOIDAL, 1e-5, 0.3),
        (TRAPEZOIDAL, 1e-5, 0.1),
        (Method::Rk4, 1e-8, 0.1),
    ] {
        let settings = tolerance(method, tol);
        let (mut system, start) = minimal(Pendulum::new(), &[]);
        system.change_chart_at(part);
        let mut whole = Node::new(Pendulum::new().dims());
        let mut run = Integration::new(&mut system, settings, &start).unwrap();
        let (mut worst, mut open) = (0.0_f64, 0.0_f64);
        while run.advance(&mut system, 2.5).unwrap() != Progress::End {
            system.whole(run.node(), &mut whole).unwrap();
            let (q, x) = (&whole.state.q, Pendulum::exact(whole.state.t));
            worst = worst.max(distance(q, &x[..2])).max(distance(&whole.state.v, &x[2..]));
            open = open.max((q[0].hypot(q[1]) - 1.0).abs());
        }
        let (counts, twin) = (run.engine.counts, by_angle(settings, 2.5));
        // an error e of y is one of e y/x in x, and of e y vx/x² in vx: divided by the square of the chart's quality; dop853 holds
        // the dependent coordinates to the tolerance as well
        let least = if part < 0.1 { 1e-7 } else { 2.0 * twin / (part * part) };
        assert!(worst < least && open < 1e-12 && counts.events >= 2, "{method:?} {part} {worst:e} {twin:e} {open:e} {counts:?}");
    }
}

#[test]
fn events_of_the_system_inside_happen() {
    let crossings = |system: &mut dyn System, start: &State| {
        let mut times = Vec::new();
        let mut run = Integration::new(system, tolerance(Method::Dop853, 1e-10), start).unwrap();
        loop {
            match run.advance(system, 1.1).unwrap() {
                Progress::Event => times.push(run.node().state.t),
                Progress::End => return (times, run.node().state.q.clone()),
                _ => {}
            }
        }
    };
    let (mut plain, (mut wrapped, start)) = (BouncingBall::new(1.0, 0.5), minimal(BouncingBall::new(1.0, 0.5), &[]));
    let origin = plain.start();
    let (a, b) = (crossings(&mut plain, &origin), crossings(&mut wrapped, &start));
    assert!(a.0.len() > 1 && distance(&a.0, &b.0) < 1e-9 && distance(&a.1, &b.1) < 1e-9, "{a:?} {b:?}");
}

#[test]
fn rows_that_depend_on_time_are_closed_at_their_time() {
    for method in [TRAPEZOIDAL, Method::CentralDifference, Method::Rk4] {
        let errors = [2e-3, 1e-3].map(|h| {
            let mut last = [0.0; 2];
            run(CarAxis::new(), &[], steps(method, h), 3.0, |node| {
                last = [distance(&node.state.q[..4], &CarAxis::Q_3), distance(&node.state.v[..4], &CarAxis::V_3)];
            });
            last
        });
        if method == Method::Rk4 {
            assert!(errors[1][0] < 1e-7 && errors[0][0] > 12.0 * errors[1][0], "{errors:?}");
        } else {
            assert!(errors[1][0] < 1e-3 && errors[0][0] > 3.0 * errors[1][0], "{method:?} {errors:?}");
        }
    }
}

#[test]
fn schemes_of_all_kinds_run() {
    for (method, tol, least) in
        [(Method::Rk4, 1e-9, 1e-6), (TRAPEZOIDAL, 1e-5, 1e-3), (Method::Dop853, 1e-10, 1e-7), (Method::Bdf { order: None }, 1e-9, 1e-4)]
    {
        let mut q = Vec::new();
        run(Andrews::new(), &[], tolerance(method, tol), 0.03, |node| q.clone_from(&node.state.q));
        let error = distance(&q, &Andrews::Q_03);
        assert!(error < least, "{method:?} {error:e}");
    }
}

#[test]
fn attitudes_and_blades_work() {
    let (_, centre, force) = HeavyTop::OUTPUTS[3];
    for (method, h, least) in [(Method::Rk4, 5e-4, 1e-6), (TRAPEZOIDAL, 1e-4, 5e-4)] {
        let mut last = Node::new(HeavyTopCartesian::cusp().dims());
        run(HeavyTopCartesian::cusp(), &[], steps(method, h), 0.3, |node| last.copy_from(node));
        let error = distance(&last.state.q[..3], &centre);
        assert!(
            error < least && (last.lambda[2] + force).abs().min((last.lambda[2] - force).abs()) < 1e3 * least,
            "{method:?} {error:e} {:?}",
            last.lambda
        );
    }
    let mut last = Node::new(Skate::new().dims());
    run(Skate::new(), &[], steps(Method::Rk4, 1e-3), 1.0, |node| last.copy_from(node));
    assert!(distance(&last.state.q, &Skate::exact(1.0)) < 1e-10);
}

#[test]
fn loops_stay_closed_and_energy_stays() {
    let problem = SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0);
    let (probe, mut own) = (problem.clone(), problem.clone());
    let before = probe.energy(&probe.start());
    let mut terms = Terms::new(problem.dims(), problem.pattern());
    let (mut open, mut drift) = (0.0_f64, 0.0_f64);
    run(problem, &[2], tolerance(Method::Dop853, 1e-10), 10.0, |node| {
        own.terms(node.state.at(), Stage::Position, &mut terms);
        open = terms.phi.iter().fold(open, |m, x| m.max(x.abs()));
        drift = drift.max((probe.energy(&node.state) / before - 1.0).abs());
    });
    assert!(open < 1e-12 && drift < 1e-7, "{open:e} {drift:e}");
}

#[test]
fn nothing_allocates() {
    let (mut system, start) = minimal(SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0), &[2]);
    let mut run = Integration::new(&mut system, steps(TRAPEZOIDAL, 1e-3), &start).unwrap();
    let info = allocation_counter::measure(|| {
        for _ in 0..100 {
            run.advance(&mut system, 1.0).unwrap();
        }
    });
    assert_eq!(info.count_total, 0);
}

/// A row of four bars with noise in its constraints turns fully: in independent coordinates, and over its flat positions in all.
#[test]
fn flat_positions_are_bridged_in_all_coordinates() {
    for (method, tol, least) in
        [(Method::Dop853, 1e-10, 1e-7), (Method::Radau5, 1e-8, 1e-5), (Method::Bdf { order: None }, 1e-8, 1e-4), (TRAPEZOIDAL, 1e-5, 1e-2)]
    {
        for n in [1, 3] {
            let probe = NFourBar::new(n, 0.0);
            let (mut system, start) = minimal(NFourBar::new(n, 1e-15), &[]);
            let energy = probe.energy(&probe.start());
            let (mut whole, mut drift, mut bridges) = (Node::new(probe.dims()), 0.0_f64, 0);
            let mut run = Integration::new(&mut system, tolerance(method, tol), &start).unwrap();
            loop {
                let progress = run.advance(&mut system, 5.0).unwrap();
                system.whole(run.node(), &mut whole).unwrap();
                drift = drift.max((probe.energy(&whole.state) - energy).abs());
                if progress == Progress::End {
                    break;
                }
                if progress != Progress::Stopped {
                    continue;
                }
                assert!(system.is_singular());
                bridges += 1;
                let mut over = Integration::new(system.inner_mut(), tolerance(Method::Dop853, tol), &whole.state).unwrap();
                while !system.enter(&over.node().state) {
                    assert_eq!(over.advance(system.inner_mut(), 5.0).unwrap(), Progress::Step);
                }
                let behind = system.reduced(&over.node().state);
                run = Integration::new(&mut system, tolerance(method, tol), &behind).unwrap();
            }
            let turns = (probe.angles(&whole.state.q)[0] - NFourBar::exact(n, 5.0)[0]) / std::f64::consts::TAU;
            println!("{method:?} {n}: {drift:e} J, {bridges} bridges, {:e}", turns - turns.round());
            assert!(
                bridges > 1 && drift < least * (4 * n + 1) as f64 && (turns - turns.round()).abs() < least,
                "{method:?} {n}: {drift:e} {turns}"
            );
        }
    }
}
