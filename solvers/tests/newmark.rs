//! The family of Newmark: orders at every level, error control, energy, singular positions.

use crate::problems::*;
use grashof_solvers::{Control, Integration, Level, Method, Node, Progress, Settings, System};

const LEVELS: [Level; 4] = [Level::Position, Level::Velocity, Level::Stabilized, Level::Acceleration];
const TRAPEZOIDAL: Method = Method::Newmark { displacement: 0.25, velocity: 0.5 };
const HHT: Method = Method::Hht { alpha: -0.1 };
const GENERALIZED: Method = Method::GeneralizedAlpha { rho: 0.8 };

/// Runs to `until` and hands every node to `see`.
fn run(system: &mut dyn Problem, settings: Settings, until: f64, mut see: impl FnMut(&Node)) -> Integration {
    let start = system.start();
    let system: &mut dyn System = system;
    let mut run = Integration::new(system, settings, &start).unwrap();
    loop {
        let progress = run.advance(system, until).unwrap();
        see(run.node());
        if progress == Progress::End {
            return run;
        }
    }
}

/// The exact q, v and λ at a time.
type Exact = dyn Fn(f64) -> [Vec<f64>; 3];

/// Orders of q, v and λ in the maximum norm over all steps, from two runs whose steps are h and h/2, in the ratio 1 : `ratio`.
fn orders(mut system: impl Problem, method: Method, level: Level, h: f64, ratio: f64, until: f64, exact: &Exact) -> [f64; 3] {
    let errors = [h, 0.5 * h].map(|h| {
        let settings = Settings { method, level, control: Control::Steps([h, ratio * h]), ..Settings::default() };
        let mut worst = [0.0_f64; 3];
        run(&mut system, settings, until, |node| {
            let exact = exact(node.state.t);
            for ((worst, x), exact) in worst.iter_mut().zip([&node.state.q, &node.state.v, &node.lambda]).zip(&exact) {
                x.iter().zip(exact).for_each(|(x, y)| *worst = worst.max((x - y).abs()));
            }
        });
        worst
    });
    [0, 1, 2].map(|i| (errors[0][i] / errors[1][i]).log2())
}

fn pendulum(t: f64) -> [Vec<f64>; 3] {
    let x = Pendulum::exact(t);
    [x[..2].to_vec(), x[2..].to_vec(), vec![Pendulum::exact_lambda(t)]]
}

/// Largest error of the mass centre of the heavy top at 0.1, 0.2 and 0.3 s.
fn top(method: Method, level: Level, h: f64, cartesian: bool) -> f64 {
    let settings = Settings { method, level, control: Control::Steps([h, h]), ..Settings::default() };
    let mut worst = 0.0_f64;
    let (mut a, mut b) = (HeavyTop::cusp(), HeavyTopCartesian::cusp());
    let system: &mut dyn Problem = if cartesian { &mut b } else { &mut a };
    run(system, settings, 0.3, |node| {
        for (t, exact, _) in HeavyTop::OUTPUTS {
            if (t - node.state.t).abs() < 1e-9 {
                let x = if cartesian { [node.state.q[0], node.state.q[1], node.state.q[2]] } else { HeavyTop::centre(&node.state.q) };
                x.iter().zip(exact).for_each(|(x, y)| worst = worst.max((x - y).abs()));
            }
        }
    });
    worst
}

/// Largest error of ω of the free body at 5 and 10 s.
fn free(method: Method, level: Level, h: f64) -> f64 {
    let settings = Settings { method, level, control: Control::Steps([h, h]), ..Settings::default() };
    let mut worst = 0.0_f64;
    run(&mut FreeBody::new(), settings, 10.0, |node| {
        for (t, omega, q) in FreeBody::OUTPUTS {
            if (t - node.state.t).abs() < 1e-9 {
                node.state.v.iter().zip(omega).for_each(|(x, y)| worst = worst.max((x - y).abs()));
                let along: f64 = node.state.q.iter().zip(q).map(|(x, y)| x * y).sum();
                node.state.q.iter().zip(q).for_each(|(x, y)| worst = worst.max((x * along.signum() - y).abs()));
            }
        }
    });
    worst
}

/// Members of the family and the levels at which they may be used.
fn members() -> impl Iterator<Item = (Method, Level)> {
    [HHT, GENERALIZED, Method::GeneralizedAlpha { rho: 0.0 }, TRAPEZOIDAL]
        .into_iter()
        .flat_map(|method| LEVELS.map(|level| (method, level)))
        .filter(|&(method, level)| method != TRAPEZOIDAL || level != Level::Position)
}

#[test]
fn all_levels_are_of_second_order() {
    for (method, level) in members() {
        for ratio in [1.0, 1.5] {
            let orders = orders(Pendulum::new(), method, level, 0.001, ratio, 2.0, &pendulum);
            assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.1), "{method:?} {level:?} {ratio} {orders:?}");
        }
    }
}

#[test]
fn minimal_coordinates_allow_all_weights() {
    let exact = |t: f64| {
        let [q, v] = PendulumAngle::exact(t);
        [vec![q], vec![v], vec![]]
    };
    for displacement in [0.25, 1.0 / 6.0] {
        for ratio in [1.0, 1.5] {
            let method = Method::Newmark { displacement, velocity: 0.5 };
            let orders = orders(PendulumAngle::new(), method, Level::Stabilized, 0.004, ratio, 2.0, &exact);
            assert!(orders[..2].iter().all(|o| (o - 2.0).abs() < 0.1), "{displacement} {ratio} {orders:?}");
        }
    }
    // without damping this is Numerov's formula for q, of fourth order
    let method = Method::Newmark { displacement: 1.0 / 12.0, velocity: 0.5 };
    let order = orders(PendulumAngle::new(), method, Level::Stabilized, 0.008, 1.0, 2.0, &exact)[0];
    assert!((order - 4.0).abs() < 0.1, "{order}");
}

#[test]
fn blades_and_first_order_states_are_of_second_order() {
    let skate = |t: f64| [Skate::exact(t).to_vec(), vec![], vec![]];
    let motor = InductanceMotor::new();
    let motor = move |t: f64| {
        let x = motor.exact(t);
        [vec![x[0]], vec![x[1]], vec![]]
    };
    for (method, level) in members() {
        for ratio in [1.0, 1.5] {
            let order = orders(Skate::new(), method, level, 0.01, ratio, 2.0, &skate)[0];
            assert!((order - 2.0).abs() < 0.1, "{method:?} {level:?} {ratio} {order}");
        }
        let found = orders(InductanceMotor::new(), method, level, 0.004, 1.5, 1.0, &motor);
        assert!(found[..2].iter().all(|o| (o - 2.0).abs() < 0.1), "{method:?} {found:?}");
    }
}

#[test]
fn attitudes_are_of_second_order() {
    for (method, level) in members() {
        let order = |error: &dyn Fn(f64) -> f64, h: f64| (error(h) / error(0.5 * h)).log2();
        let found = [
            order(&|h| top(method, level, h, false), 4e-4),
            order(&|h| top(method, level, h, true), 4e-4),
            order(&|h| free(method, level, h), 0.01),
        ];
        assert!(found.iter().all(|o| (o - 2.0).abs() < 0.1), "{method:?} {level:?} {found:?}");
    }
}

#[test]
fn the_error_follows_the_tolerance() {
    for (method, level) in members() {
        for tolerance in [1e-3, 1e-4, 1e-5] {
            let settings = Settings { method, level, control: Control::Tolerance(tolerance), ..Settings::default() };
            let run = run(&mut Andrews::new(), settings, 0.03, |_| {});
            let error = run.node().state.q.iter().zip(Andrews::Q_03).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()));
            assert!((0.02..50.0).contains(&(error / tolerance)), "{method:?} {level:?} {tolerance:e} {error:e}");
            assert_eq!(run.engine.counts.bridges, 0, "another scheme has stepped: {method:?} {level:?}");
        }
    }
}

#[test]
fn the_error_follows_a_small_tolerance() {
    let smallest = Method::GeneralizedAlpha { rho: 0.0 };
    for (method, level) in
        [(GENERALIZED, Level::Stabilized), (HHT, Level::Position), (smallest, Level::Position), (TRAPEZOIDAL, Level::Velocity)]
    {
        let settings = Settings { method, level, control: Control::Tolerance(1e-6), ..Settings::default() };
        let run = run(&mut Andrews::new(), settings, 0.03, |_| {});
        let error = run.node().state.q.iter().zip(Andrews::Q_03).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()));
        assert!((0.02e-6..50e-6).contains(&error), "{method:?} {level:?} {error:e} {:?}", run.engine.counts);
        assert_eq!(run.engine.counts.bridges, 0, "another scheme has stepped: {method:?} {level:?}");
    }
}

/// A row of four-bars beside its twin: the drift of the energy is at most ten times that of the twin, and the error of the angle,
/// which that drift makes in time, at most thirty times.
fn crosses(n: usize, method: Method, tolerance: f64, end: f64) {
    let settings = Settings { method, control: Control::Tolerance(tolerance), ..Settings::default() };
    let probe = NFourBar::new(n, 0.0);
    let before = probe.energy(&probe.start());
    let (mut drift, mut apart) = (0.0_f64, 0.0_f64);
    let ended = run(&mut NFourBar::new(n, 1e-15), settings, end, |node| {
        drift = drift.max((probe.energy(&node.state) - before).abs());
        let angles = probe.angles(&node.state.q);
        apart = angles.iter().fold(apart, |m, x| m.max((x - angles[0]).abs() * x.cos().abs()));
    });
    let angle = (probe.angles(&ended.node().state.q)[0] - NFourBar::exact(n, end)[0]).abs();
    let mut twin = FourBarTwin::new(n);
    let (mut of_twin, before, see) = (0.0_f64, twin.energy(&twin.start()), twin.clone());
    let by_twin = run(&mut twin, settings, end, |node| of_twin = of_twin.max((see.energy(&node.state) - before).abs()));
    let by_twin = (by_twin.node().state.q[0] - NFourBar::exact(n, end)[0]).abs();
    // the twin has the inertia 1, the row of four-bars (4n + 1)/3
    let of_twin = of_twin * (4 * n + 1) as f64 / 3.0;
    let message = format!("{n} {method:?} {tolerance:e}: {drift:e} {of_twin:e} {angle:e} {by_twin:e} {apart:e} {:?}", ended.engine.counts);
    assert!(drift < 10.0 * of_twin && angle < 30.0 * by_twin && apart < 1e-3 * tolerance.max(1e-9), "{message}");
}

#[test]
fn singular_positions_are_crossed() {
    for n in [1, 2, 6, 10] {
        for method in [GENERALIZED, HHT, TRAPEZOIDAL] {
            crosses(n, method, 1e-5, 2.5 * NFourBar::turn(n));
        }
    }
}

#[test]
fn one_four_bar_is_crossed_at_1e_8_and_1e_10() {
    crosses(1, GENERALIZED, 1e-8, 10.0);
    crosses(1, GENERALIZED, 1e-10, 10.0);
}

#[test]
fn two_and_six_four_bars_are_crossed_at_1e_8() {
    crosses(2, GENERALIZED, 1e-8, 10.0);
    crosses(6, GENERALIZED, 1e-8, 10.0);
}

#[test]
fn ten_four_bars_are_crossed_at_1e_8() {
    crosses(10, GENERALIZED, 1e-8, 10.0);
}

/// A method of order 2 makes a million steps in 10 s at 1e-10: rows of many four-bars cross their flat positions twice there, and ten times
/// at 1e-8.
#[test]
fn two_four_bars_are_crossed_at_1e_10() {
    crosses(2, GENERALIZED, 1e-10, 10.0);
}

#[test]
fn six_four_bars_are_crossed_at_1e_10() {
    crosses(6, GENERALIZED, 1e-10, 2.5);
}

#[test]
fn ten_four_bars_are_crossed_at_1e_10() {
    crosses(10, GENERALIZED, 1e-10, 2.5);
}

#[test]
fn equal_arms_keep_their_branch() {
    for method in [GENERALIZED, HHT, TRAPEZOIDAL] {
        let settings = Settings { method, control: Control::Tolerance(1e-5), ..Settings::default() };
        let run = run(&mut SliderCrank::equal_arms(1e-15), settings, 5.0, |_| {});
        let [_, phi, rate, x] = SliderCrank::EQUAL_ARMS[3];
        let s = &run.node().state;
        let error = [s.q[2] - phi, s.v[2] - rate, s.q[6] - x].iter().fold(0.0, |m, e| f64::max(m, e.abs()));
        assert!(error < 1e-3, "{method:?} {error:e} {:?}", run.engine.counts);
    }
}

#[test]
fn stiff_parts_decay() {
    let mut system = StiffPair::new(1e8, 1e3);
    let exact = system.exact(10.0);
    for method in [GENERALIZED, HHT] {
        let settings = Settings { method, control: Control::Steps([0.01, 0.01]), ..Settings::default() };
        let run = run(&mut system, settings, 10.0, |_| {});
        let s = &run.node().state;
        assert!((s.q[0] + s.q[1] - exact[0] - exact[1]).abs() < 1e-3 && (s.q[0] - s.q[1]).abs() < 1e-6, "{method:?} {s:?}");
    }
}

#[test]
fn energy_stays_with_the_trapezoidal_rule() {
    let mut system = SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0);
    let probe = system.clone();
    let before = probe.energy(&probe.start());
    let settings = Settings { method: TRAPEZOIDAL, control: Control::Steps([2e-3, 2e-3]), ..Settings::default() };
    let (mut early, mut late) = (0.0_f64, 0.0_f64);
    run(&mut system, settings, 100.0, |node| {
        let drift = (probe.energy(&node.state) / before - 1.0).abs();
        if node.state.t < 10.0 { early = early.max(drift) } else { late = late.max(drift) }
    });
    assert!(early < 5e-3 && late < 1.02 * early, "{early:e} {late:e}");
}

#[test]
fn kinks_are_located_or_marched_across() {
    let period = |locate: bool, control: Control| {
        let mut system = KinkedSpring::new(1.0, 9.0);
        let settings = Settings { method: GENERALIZED, control, locate, ..Settings::default() };
        let (start, probe) = (system.start(), KinkedSpring::new(1.0, 9.0));
        let run = run(&mut system, settings, 20.0, |_| {});
        let energy = probe.energy(&run.node().state) / probe.energy(&start) - 1.0;
        (energy.abs(), run.engine.counts)
    };
    let (located, counts) = period(true, Control::Tolerance(1e-5));
    assert!(located < 1e-3 && counts.events > 5, "{located:e} {counts:?}");
    let (marched, counts) = period(false, Control::Steps([1e-3, 1e-3]));
    assert!(marched < 1e-2 && counts.stepped_over > 5, "{marched:e} {counts:?}");
}

#[test]
fn steps_allocate_nothing() {
    for control in [Control::Steps([1e-3, 1.5e-3]), Control::Tolerance(1e-5)] {
        for (method, level) in members() {
            let mut system = SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0);
            let settings = Settings { method, level, control, ..Settings::default() };
            let start = system.start();
            let mut run = Integration::new(&mut system, settings, &start).unwrap();
            // the sparse factors choose their pivots once
            run.advance(&mut system, 10.0).unwrap();
            let info = allocation_counter::measure(|| {
                for _ in 0..50 {
                    run.advance(&mut system, 10.0).unwrap();
                }
            });
            assert_eq!(info.count_total, 0, "{method:?} {level:?} {control:?}");
        }
    }
}
