//! The loop that drives schemes: ends, steps, continuous output, events.

use crate::problems::*;
use grashof_solvers::{Control, Integration, Method, Node, Progress, Settings, State, System, Why};

#[test]
fn given_steps_reach_their_order() {
    let mut errors = Vec::new();
    for h in [0.01, 0.005] {
        let mut system = Pendulum::new();
        let settings = Settings { method: Method::Rk4, control: Control::Steps([h, h]), ..Settings::default() };
        let start = system.start();
        let mut run = Integration::new(&mut system, settings, &start).unwrap();
        while run.advance(&mut system, 2.0).unwrap() != Progress::End {}
        let exact = Pendulum::exact(2.0);
        let s = &run.node().state;
        assert_eq!(s.t, 2.0);
        errors.push((s.q[0] - exact[0]).abs().max((s.q[1] - exact[1]).abs()).max((s.v[0] - exact[2]).abs()));
    }
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 4.0).abs() < 0.3, "{errors:?} {order}");
}

#[test]
fn the_continuous_solution_is_as_good_as_the_steps() {
    let mut system = Pendulum::new();
    let settings = Settings { method: Method::Rk4, control: Control::Tolerance(1e-9), ..Settings::default() };
    let start = system.start();
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    let mut node = Node::new(system.dims());
    let mut worst: f64 = 0.0;
    loop {
        let end = run.advance(&mut system, 2.0).unwrap() == Progress::End;
        let (a, b) = (run.last().state.t, run.node().state.t);
        for k in 1..10 {
            let t = a + (b - a) * f64::from(k) / 10.0;
            run.at(&mut system, t, &mut node).unwrap();
            let exact = Pendulum::exact(t);
            let s = &node.state;
            worst = worst.max((s.q[0] - exact[0]).abs()).max((s.q[1] - exact[1]).abs()).max((s.v[1] - exact[3]).abs());
        }
        if end {
            break;
        }
    }
    assert!(worst < 1e-6, "{worst}");
}

/// Runs to `until`, calling `seen` at each event with the sides before and behind it.
fn run_with<S: System>(
    system: &mut S,
    settings: Settings,
    start: &State,
    until: f64,
    mut seen: impl FnMut(&Node, &Node),
) -> (Node, Progress) {
    let mut run = Integration::new(system, settings, start).unwrap();
    loop {
        match run.advance(system, until).unwrap() {
            Progress::Step => {}
            Progress::Event => seen(run.before(), run.node()),
            end => return (run.node().clone(), end),
        }
    }
}

#[test]
fn impacts_come_when_they_should() {
    let mut system = BouncingBall::new(1.0, 0.5);
    let start = system.start();
    let settings = Settings { method: Method::Dop853, ..Settings::default() };
    let mut count = 0;
    let mut times = Vec::new();
    let until = 0.5 * (system.impact(4) + system.impact(5));
    let (node, end) = run_with(&mut system, settings, &start, until, |before, after| {
        count += 1;
        times.push(before.state.t);
        assert!((after.state.v[0] + 0.5 * before.state.v[0]).abs() < 1e-12);
    });
    assert_eq!(end, Progress::End);
    let exact: Vec<f64> = (0..times.len()).map(|n| system.impact(n)).collect();
    for (found, exact) in times.iter().zip(&exact) {
        assert!((found - exact).abs() < 1e-10, "{found} {exact}");
    }
    assert!(count >= 4);
    assert!((node.state.q[0] - system.exact(until)[0]).abs() < 1e-9);
}

#[test]
fn impacts_that_pile_up_are_told() {
    let mut system = BouncingBall::new(1.0, 0.5);
    let start = system.start();
    let settings = Settings { method: Method::Dop853, ..Settings::default() };
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    let halt = loop {
        match run.advance(&mut system, 10.0) {
            Ok(Progress::End) => panic!("it went on"),
            Ok(_) => {}
            Err(halt) => break halt,
        }
    };
    assert!(matches!(halt.why, Why::Zeno(_)), "{halt:?}");
    assert!(halt.t < system.zeno() + 1e-6);
}

#[test]
fn order_is_kept_across_a_kink() {
    for (method, order, steps) in [(Method::Rk4, 4.0, [0.08, 0.04, 0.02, 0.01, 0.005]), (Method::Dop853, 8.0, [0.6, 0.4, 0.3, 0.2, 0.15])] {
        // where in a step the kink lies changes the error: a line through several steps
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for h in steps {
            let mut system = KinkedSpring::new(1.0, 9.0);
            let start = system.start();
            let until = 3.3 * system.period();
            let settings = Settings { method, control: Control::Steps([h, h]), ..Settings::default() };
            let mut events = 0;
            let (node, _) = run_with(&mut system, settings, &start, until, |_, _| events += 1);
            assert!(events >= 6);
            let exact = system.exact(until);
            x.push(h.ln());
            y.push((node.state.q[0] - exact[0]).abs().max((node.state.v[0] - exact[1]).abs()).ln());
        }
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let (mx, my) = (mean(&x), mean(&y));
        let slope = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>() / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>();
        assert!(slope > order - 0.8, "{method:?} {slope} {y:?}");
    }
}

#[test]
fn dry_friction_stops_where_it_should() {
    let mut system = DryOscillator::new(1.0);
    let start = system.start();
    let settings = Settings { method: Method::Dop853, control: Control::Tolerance(1e-10), ..Settings::default() };
    let mut times = Vec::new();
    let (node, _) = run_with(&mut system, settings, &start, 30.0, |before, _| times.push(before.state.t));
    for (n, t) in times.iter().enumerate().take(system.swings()) {
        assert!((t - DryOscillator::reversal(n + 1)).abs() < 1e-8, "{n} {t}");
    }
    assert!((node.state.q[0] - system.exact(30.0)[0]).abs() < 1e-8);
    assert_eq!(node.state.v[0], 0.0);
}

#[test]
fn a_stop_ends_the_run_and_a_record_leaves_it_alone() {
    let settings = Settings { method: Method::Dop853, control: Control::Tolerance(1e-10), ..Settings::default() };
    let mut stop = StopAt::new(0.5);
    let start = stop.start();
    let (node, end) = run_with(&mut stop, settings, &start, 10.0, |_, _| {});
    assert_eq!(end, Progress::Stopped);
    assert!((node.state.t - stop.passage(0)).abs() < 1e-9);

    let mut record = RecordAt::new(0.5);
    let start = record.start();
    let mut times = Vec::new();
    let (with, _) = run_with(&mut record, settings, &start, 10.0, |before, _| times.push(before.state.t));
    for (n, t) in times.iter().enumerate() {
        assert!((t - record.passage(n)).abs() < 1e-9, "{n} {t}");
    }
    assert!(times.len() >= 3);
    let (without, _) = run_with(&mut record, Settings { locate: false, ..settings }, &start, 10.0, |_, _| {});
    assert_eq!(with.state.q, without.state.q, "the same steps, to the bit");
}
