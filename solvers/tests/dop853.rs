//! The explicit schemes `dop853` and `rk4`: orders, tolerances, singular positions, quaternions, states, long runs.

use crate::problems::*;
use allocation_counter::measure;
use grashof_solvers::{Control, Counts, Integration, Method, Node, Progress, Settings, State, System};

fn settings(method: Method, control: Control) -> Settings {
    Settings { method, control, ..Settings::default() }
}

/// DOP853 with a tolerance.
fn precise(tolerance: f64) -> Settings {
    settings(Method::Dop853, Control::Tolerance(tolerance))
}

/// Runs to `end`, showing every node.
fn run<P: Problem>(system: &mut P, settings: Settings, end: f64, mut look: impl FnMut(&P, &Node)) -> (Node, Counts) {
    let start = system.start();
    let mut run = Integration::new(system, settings, &start).unwrap();
    loop {
        let progress = run.advance(system, end).unwrap_or_else(|halt| panic!("{halt:?} after {:?}", run.engine.counts));
        look(system, run.node());
        if progress == Progress::End {
            return (run.node().clone(), run.engine.counts);
        }
    }
}

/// Largest difference of numbers in pairs.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

/// Largest errors of the pendulum in q, v and λ over all steps of 2 s; steps of h in the given ratio.
fn pendulum_errors(method: Method, ratio: [f64; 2], h: f64) -> [f64; 3] {
    let mut worst = [0.0; 3];
    run(&mut Pendulum::new(), settings(method, Control::Steps(ratio.map(|r| r * h))), 2.0, |_, node| {
        let exact = Pendulum::exact(node.state.t);
        let lambda = [Pendulum::exact_lambda(node.state.t)];
        let errors = [distance(&node.state.q, &exact[..2]), distance(&node.state.v, &exact[2..]), distance(&node.lambda, &lambda)];
        worst.iter_mut().zip(errors).for_each(|(w, e)| *w = f64::max(*w, e));
    });
    worst
}

/// The order between h and h/2 in q, v and λ is at least `order` less a tenth of it.
fn reaches_order(method: Method, order: f64, h: f64) {
    for ratio in [[1.0, 1.0], [0.8, 1.2]] {
        let (coarse, fine) = (pendulum_errors(method, ratio, h), pendulum_errors(method, ratio, 0.5 * h));
        for (c, f) in coarse.iter().zip(fine) {
            let found = (c / f).log2();
            assert!(found > 0.9 * order && found < 1.25 * order, "{method:?} {ratio:?}: {coarse:?} {fine:?}");
        }
    }
}

#[test]
fn orders_are_8_and_4_in_positions_velocities_and_multipliers() {
    reaches_order(Method::Dop853, 8.0, 0.1);
    reaches_order(Method::Rk4, 4.0, 0.01);
}

#[test]
fn work_comes_with_the_stages() {
    let mut motor = InductanceMotor::new();
    let [(node, with), (_, without)] = [true, false].map(|balance| run(&mut motor, Settings { balance, ..precise(1e-9) }, 0.7, |_, _| {}));
    // no place inside of a step is evaluated for it
    assert_eq!(with.evaluations, without.evaluations);
    assert!((node.state.work[0] - motor.energy(&node.state)).abs() < 1e-8 * motor.energy(&node.state), "{:?}", node.state.work);
    // powers that the steps do not resolve are integrated along the continuous solution
    let coarse = Settings { balance: true, ..settings(Method::Dop853, Control::Steps([0.05, 0.05])) };
    let (node, counts) = run(&mut motor, coarse, 0.7, |_, _| {});
    let along = Settings { balance: false, ..coarse };
    assert!(counts.evaluations > run(&mut motor, along, 0.7, |_, _| {}).1.evaluations);
    assert!((node.state.work[0] - motor.energy(&node.state)).abs() < 1e-4 * motor.energy(&node.state), "{:?}", node.state.work);
}

/// Error of the continuous solution over all steps, in q and v.
fn dense_error(h: f64) -> [f64; 2] {
    let mut system = Pendulum::new();
    let start = system.start();
    let mut run = Integration::new(&mut system, settings(Method::Dop853, Control::Steps([h, h])), &start).unwrap();
    let mut state = start.clone();
    let mut worst = [0.0_f64; 2];
    while run.advance(&mut system, 2.0).unwrap() != Progress::End {
        let (from, to) = (run.last().state.clone(), run.node().state.clone());
        let dense = run.dense(&mut system).unwrap();
        for (theta, end) in [(0.0, &from), (1.0, &to)] {
            dense.evaluate(from.t + theta * (to.t - from.t), &mut state);
            assert!(distance(&state.q, &end.q).max(0.1 * distance(&state.v, &end.v)) < 4e-16);
        }
        for k in 1..8 {
            dense.evaluate(from.t + h * f64::from(k) / 8.0, &mut state);
            let exact = Pendulum::exact(state.t);
            worst = [worst[0].max(distance(&state.q, &exact[..2])), worst[1].max(distance(&state.v, &exact[2..]))];
        }
    }
    worst
}

#[test]
fn the_continuous_solution_is_of_order_7_and_meets_both_ends() {
    let (coarse, fine) = (dense_error(0.1), dense_error(0.05));
    for (c, f) in coarse.iter().zip(fine) {
        assert!((c / f).log2() > 6.5, "{coarse:?} {fine:?}");
    }
}

/// Largest errors in q and v at the ends of steps and inside of them, and what the motion took; `look` inside.
fn errors_inside(tolerance: f64, look: bool) -> ([[f64; 2]; 2], Counts) {
    let mut system = Pendulum::new();
    let start = system.start();
    let mut run = Integration::new(&mut system, settings(Method::Dop853, Control::Tolerance(tolerance)), &start).unwrap();
    let mut state = start.clone();
    let mut worst = [[0.0_f64; 2]; 2];
    let mut compare = |state: &State, place: usize| {
        let exact = Pendulum::exact(state.t);
        let off = [distance(&state.q, &exact[..2]), distance(&state.v, &exact[2..])];
        worst[place] = [worst[place][0].max(off[0]), worst[place][1].max(off[1])];
    };
    while run.advance(&mut system, 6.0).unwrap() != Progress::End {
        let (from, to) = (run.last().state.t, run.node().state.t);
        compare(&run.node().state, 0);
        for k in 1..if look { 8 } else { 1 } {
            run.dense(&mut system).unwrap().evaluate(from + (to - from) * f64::from(k) / 8.0, &mut state);
            compare(&state, 1);
        }
    }
    let counts = run.engine.counts;
    (worst, counts)
}

#[test]
fn the_continuous_solution_costs_little_and_is_as_good_as_the_nodes() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let ([nodes, inside], counts) = errors_inside(tolerance, true);
        for (inside, nodes) in inside.iter().zip(nodes) {
            // where the nodes are far better than what is asked, that is enough
            assert!(*inside < 1.6 * nodes.max(0.3 * tolerance), "{tolerance:e}: {inside:e} {nodes:e}");
        }
        // steps without two of about their length before them, as the first, take three more stages; of those at 1e-4, five to a
        // swing, so do others that are too long for the polynomial
        let more = counts.evaluations - errors_inside(tolerance, false).1.evaluations;
        let few = if tolerance > 1e-5 { 2 * counts.steps } else { 9 + counts.steps / 10 };
        assert!(more <= few, "{tolerance:e}: {more} evaluations in {} steps", counts.steps);
    }
}

/// Error of Andrews' mechanism at the end in its seven angles.
fn andrews(tolerance: f64) -> (f64, Counts) {
    let (node, counts) = run(&mut Andrews::new(), precise(tolerance), 0.03, |_, _| {});
    (distance(&node.state.q, &Andrews::Q_03), counts)
}

/// An error and a tolerance that belong together.
fn follows(error: f64, tolerance: f64, what: &str) {
    assert!(error < 100.0 * tolerance && error > 0.01 * tolerance, "{what} {tolerance:e}: {error:e}");
}

#[test]
fn andrews_mechanism_gets_ten_digits_and_follows_the_tolerance() {
    for digits in 4..=10 {
        let tolerance = 10f64.powi(-digits);
        follows(andrews(tolerance).0, tolerance, "Andrews");
    }
    let (error, counts) = andrews(1e-13);
    assert!(error < 1e-11 && counts.steps < 400, "{error:e} {counts:?}");
}

/// Error of the pendulum at 10 s in the units of the tolerance: velocities count relative to 1 + |v|.
fn pendulum(tolerance: f64) -> f64 {
    let (node, _) = run(&mut Pendulum::new(), precise(tolerance), 10.0, |_, _| {});
    let (s, exact) = (&node.state, Pendulum::AT_10);
    (0..2).fold(distance(&s.q, &exact[..2]), |m, i| m.max((s.v[i] - exact[2 + i]).abs() / (1.0 + exact[2 + i].abs())))
}

#[test]
fn errors_follow_the_tolerance() {
    for digits in 4..=10 {
        let tolerance = 10f64.powi(-digits);
        follows(pendulum(tolerance), tolerance, "pendulum");
        let (node, _) = run(&mut CarAxis::new(), precise(tolerance), 3.0, |_, _| {});
        follows(distance(&node.state.q, &CarAxis::Q_3), tolerance, "car axis");
    }
}

/// A method of order 4 makes more than its tolerance of each of many steps, but the ratio stays.
#[test]
fn errors_of_order_4_follow_the_tolerance() {
    let ratio = |digits: i32| {
        let tolerance = 10f64.powi(-digits);
        let (node, _) = run(&mut Andrews::new(), settings(Method::Rk4, Control::Tolerance(tolerance)), 0.03, |_, _| {});
        distance(&node.state.q, &Andrews::Q_03) / tolerance
    };
    let ratios: Vec<f64> = (3..=8).map(ratio).collect();
    let (least, most) = ratios.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), r| (l.min(*r), m.max(*r)));
    assert!(most < 1000.0 && most < 100.0 * least, "{ratios:?}");
}

/// Ten seconds of a row of four bars with noise in its constraints, 10 singular positions or so: the largest change of energy (J)
/// and the largest angle between links, within |cos φ| < 0.1 times 10 |cos φ|.
fn four_bars(n: usize, tolerance: f64) -> [f64; 2] {
    let mut system = NFourBar::new(n, 1e-15);
    let energy = system.energy(&system.start());
    let (mut drift, mut skew) = (0.0_f64, 0.0_f64);
    let (node, _) = run(&mut system, precise(tolerance), 10.0, |system, node| {
        drift = drift.max((system.energy(&node.state) - energy).abs());
        // round-off of Φ leaves the angle between links open by itself over |cos φ|
        let angles = system.angles(&node.state.q);
        let cosine = (10.0 * angles[0].cos().abs()).min(1.0);
        skew = angles.iter().fold(skew, |m, a| m.max((a - angles[0]).abs() * cosine));
    });
    let turns = (system.angles(&node.state.q)[0] - NFourBar::exact(n, 10.0)[0]) / std::f64::consts::TAU;
    assert!((turns - turns.round()).abs() < 100.0 * tolerance.max(1e-11), "{n}: {turns}");
    [drift, skew]
}

#[test]
fn rows_of_four_bars_pass_their_singular_positions() {
    for (n, energy) in [(1, 1e-11), (2, 1e-10), (6, 1e-9), (10, 1e-9)] {
        let [drift, skew] = four_bars(n, 1e-12);
        assert!(drift < energy && skew < 1e-12, "{n}: {drift:e} J, {skew:e}");
    }
    // the tight ones are many: whether a step ends beside a singular position is by chance
    let tight = (0..25).map(|k| (10f64.powf(-9.0 - 0.125 * f64::from(k)), 1.0));
    for (tolerance, times) in [(1e-8, 10.0)].into_iter().chain(tight) {
        for n in [1, 2, 3, 4, 6, 10] {
            let mut twin = FourBarTwin::new(n);
            let energy = twin.energy(&twin.start());
            let mut of_twin = 0.0_f64;
            run(&mut twin, precise(tolerance), 10.0, |twin, node| of_twin = of_twin.max((twin.energy(&node.state) - energy).abs()));
            let [drift, skew] = four_bars(n, tolerance);
            // the twin has the inertia 1, the row of four-bars (4n + 1)/3
            let allowed = times * of_twin * (4 * n + 1) as f64 / 3.0;
            assert!(drift < allowed && skew < 1e-12, "{n} {tolerance:e}: {drift:e} J, at most {allowed:e}, {skew:e}");
        }
    }
}

/// Across a singular position a step is as long as elsewhere: neither the approach nor what follows takes it in small pieces.
#[test]
fn singular_positions_cost_few_steps() {
    let spent = |p: &mut dyn System, start: &State| {
        let mut run = Integration::new(p, precise(1e-12), start).unwrap();
        while run.advance(p, 10.0).unwrap() != Progress::End {}
        run.engine.counts
    };
    for n in [1, 6] {
        let (mut system, mut twin) = (NFourBar::new(n, 1e-15), FourBarTwin::new(n));
        let (start, of_twin) = (system.start(), twin.start());
        let (counts, of_twin) = (spent(&mut system, &start), spent(&mut twin, &of_twin));
        assert!(counts.steps < 2 * of_twin.steps && counts.rejected < 30, "{counts:?} {of_twin:?}");
    }
}

#[test]
fn the_slider_crank_with_equal_arms_keeps_its_branch() {
    let mut system = SliderCrank::equal_arms(1e-15);
    let [t, phi, rate, x] = SliderCrank::EQUAL_ARMS[3];
    let (node, _) = run(&mut system, precise(1e-12), t, |_, _| {});
    let s = &node.state;
    assert!(distance(&[s.q[2], s.v[2], s.q[6]], &[phi, rate, x]) < 1e-8);
    // the energy, 1.2 J, is that of the motion alone
    for (tolerance, allowed) in [(1e-8, 1e-6), (1e-10, 1e-8), (1e-12, 1e-10)] {
        let mut system = SliderCrank::equal_arms(1e-15);
        let energy = system.energy(&system.start());
        let (mut drift, mut skew) = (0.0_f64, 0.0_f64);
        run(&mut system, precise(tolerance), 10.0, |system, node| {
            drift = drift.max((system.energy(&node.state) - energy).abs());
            let q = &node.state.q;
            skew = skew.max((q[2] + q[5]).sin().abs() * (10.0 * q[2].cos().abs()).min(1.0));
        });
        assert!(drift < allowed && skew < 1e-12, "{tolerance:e}: {drift:e} J, {skew:e}");
    }
}

#[test]
fn tops_and_free_bodies_turn_by_quaternions() {
    for (t, centre, _) in HeavyTop::OUTPUTS {
        if t > 0.0 {
            let (node, _) = run(&mut HeavyTop::cusp(), precise(1e-12), t, |_, _| {});
            assert!(distance(&HeavyTop::centre(&node.state.q), &centre) < 1e-9);
            let (node, _) = run(&mut HeavyTopCartesian::cusp(), precise(1e-12), t, |_, _| {});
            assert!(distance(&node.state.q[..3], &centre) < 1e-9);
        }
    }
    for (t, omega, q) in FreeBody::OUTPUTS {
        let (node, _) = run(&mut FreeBody::new(), precise(1e-12), t, |_, _| {});
        let length = node.state.q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let unit: Vec<f64> = node.state.q.iter().map(|x| x / length).collect();
        assert!(distance(&node.state.v, &omega).max(distance(&unit, &q)) < 1e-8);
    }
}

#[test]
fn states_and_nonholonomic_rows_are_integrated() {
    let mut motor = InductanceMotor::new();
    let (node, _) = run(&mut motor, precise(1e-12), 2.0, |_, _| {});
    let s = &node.state;
    assert!(distance(&[s.q[0], s.v[0], s.z[0]], &motor.exact(2.0)) < 1e-10);
    let mut worst = 0.0_f64;
    run(&mut Skate::new(), precise(1e-12), 5.0, |_, node| {
        worst = worst.max(distance(&node.state.q, &Skate::exact(node.state.t)));
    });
    assert!(worst < 1e-10, "{worst:e}");
}

/// Largest change of energy in a thousand seconds at 1e-11.
fn drift<P: Problem>(mut system: P) -> f64 {
    let energy = system.energy(&system.start());
    let mut drift = 0.0_f64;
    run(&mut system, precise(1e-11), 1000.0, |system, node| drift = drift.max((system.energy(&node.state) - energy).abs()));
    drift
}

#[test]
fn energy_is_kept_for_a_thousand_seconds() {
    // the pendulum's kinetic energy reaches 9.81 J
    let found = drift(Pendulum::new()) / 9.81;
    assert!(found < 1e-8, "pendulum: {found:e}");
    let system = SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 1.0);
    let energy = system.energy(&system.start());
    let found = drift(system) / energy;
    assert!(found < 1e-8, "slider-crank: {found:e}");
}

#[test]
fn steps_allocate_nothing() {
    for method in [Method::Dop853, Method::Rk4, Method::Auto] {
        let mut system = Andrews::new();
        let start = system.start();
        let mut run = Integration::new(&mut system, settings(method, Control::Tolerance(1e-6)), &start).unwrap();
        let mut inside = Node::new(system.dims());
        let info = measure(|| {
            while run.advance(&mut system, 0.003).unwrap() != Progress::End {
                let middle = 0.5 * (run.last().state.t + run.node().state.t);
                run.at(&mut system, middle, &mut inside).unwrap();
            }
        });
        assert_eq!(info.count_total, 0, "{method:?}");
    }
}
