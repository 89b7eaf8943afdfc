//! Radau IIA with three stages: orders, tolerances, stiff forces, singular positions, quaternions, states, long runs.

use crate::problems::*;
use allocation_counter::measure;
use grashof_solvers::{Control, Counts, Integration, Level, Method, Node, Progress, Settings};

const LEVELS: [Level; 4] = [Level::Stabilized, Level::Velocity, Level::Position, Level::Acceleration];

fn settings(control: Control) -> Settings {
    Settings { method: Method::Radau5, control, ..Settings::default() }
}

/// The stabilised scheme with a tolerance.
fn precise(tolerance: f64) -> Settings {
    settings(Control::Tolerance(tolerance))
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

/// Errors at h and h/2 of each kind tell its order to a tenth; steps are constant, or alternate 1 : 1.5.
fn reaches<const N: usize>(name: &str, orders: [f64; N], h: f64, errors: impl Fn([f64; 2]) -> [f64; N]) {
    for ratio in [[1.0, 1.0], [0.8, 1.2]] {
        let (coarse, fine) = (errors(ratio.map(|r| r * h)), errors(ratio.map(|r| 0.5 * r * h)));
        for k in 0..N {
            let found = (coarse[k] / fine[k]).log2();
            assert!((found - orders[k]).abs() < 0.1, "{name} {ratio:?} {k}: {coarse:?} {fine:?} {found}");
        }
    }
}

/// Largest errors over all steps, of several kinds.
fn worst<P: Problem, const N: usize>(system: &mut P, settings: Settings, end: f64, error: impl Fn(&Node) -> [f64; N]) -> [f64; N] {
    let mut worst = [0.0; N];
    run(system, settings, end, |_, node| worst.iter_mut().zip(error(node)).for_each(|(w, e)| *w = f64::max(*w, e)));
    worst
}

/// A spring of 1e9 N/m holds the mass as a rod would: the motion is smooth, whatever the tolerance leaves of the stretch.
#[test]
fn a_stiff_direction_that_turns_is_followed_at_loose_tolerances() {
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let mut pendulum = ElasticPendulum::new(1e9, 1e5);
        let (node, counts) = run(&mut pendulum, precise(tolerance), 2.0, |_, _| {});
        assert!(counts.steps < 1000, "{tolerance:e}: {counts:?}");
        assert!((node.state.q[0].hypot(node.state.q[1]) - 1.0).abs() < tolerance, "{tolerance:e}: {node:?}");
    }
}

#[test]
fn positions_velocities_and_multipliers_reach_their_orders_at_each_level() {
    for level in LEVELS {
        // at index 3 the velocities of the last stage have order 3 (Hairer & Wanner II, section VI.4)
        let of_v = if level == Level::Position { 3.0 } else { 5.0 };
        reaches(&format!("{level:?}"), [5.0, of_v, 5.0], 0.02, |steps| {
            worst(&mut Pendulum::new(), Settings { level, ..settings(Control::Steps(steps)) }, 2.0, |node| {
                let (s, exact) = (&node.state, Pendulum::exact(node.state.t));
                let lambda = (node.lambda[0] - Pendulum::exact_lambda(s.t)).abs();
                [distance(&s.q, &exact[..2]), distance(&s.v, &exact[2..]), lambda]
            })
        });
    }
}

#[test]
fn a_top_on_three_rows_reaches_the_orders_of_its_twin() {
    // over a tenth of a second, against DOP853 on the top without rows
    let settings_of_twin = Settings { method: Method::Dop853, control: Control::Tolerance(1e-13), ..Settings::default() };
    let (twin, _) = run(&mut HeavyTop::cusp(), settings_of_twin, 0.1, |_, _| {});
    let (q, omega) = (&twin.state.q, &twin.state.v);
    let centre = HeavyTop::centre(q);
    reaches("top", [5.0, 5.0], 0.1 / 80.0, |steps| {
        let (node, _) = run(&mut HeavyTop::cusp(), settings(Control::Steps(steps)), 0.1, |_, _| {});
        [distance(&node.state.q, q), distance(&node.state.v, omega)]
    });
    for level in LEVELS {
        let of_v = if level == Level::Position { 3.0 } else { 5.0 };
        reaches(&format!("{level:?}"), [5.0, 5.0, of_v], 0.1 / 80.0, |steps| {
            let settings = Settings { level, ..settings(Control::Steps(steps)) };
            let (node, _) = run(&mut HeavyTopCartesian::cusp(), settings, 0.1, |_, _| {});
            let s = &node.state;
            [distance(&s.q[3..], q), distance(&s.q[..3], &centre), distance(&s.v[3..], omega)]
        });
    }
}

#[test]
fn states_nonholonomic_rows_and_free_bodies_reach_order_5() {
    let motor = InductanceMotor::new();
    reaches("motor", [5.0, 5.0], 0.01, |steps| {
        worst(&mut motor.clone(), settings(Control::Steps(steps)), 0.5, |node| {
            let (s, exact) = (&node.state, motor.exact(node.state.t));
            [distance(&[s.q[0], s.v[0]], &exact[..2]), (s.z[0] - exact[2]).abs()]
        })
    });
    reaches("skate", [5.0], 0.05, |steps| {
        worst(&mut Skate::new(), settings(Control::Steps(steps)), 2.0, |node| [distance(&node.state.q, &Skate::exact(node.state.t))])
    });
    let (t, omega, q) = FreeBody::OUTPUTS[0];
    reaches("body", [5.0, 5.0], 0.25, |steps| {
        let (node, _) = run(&mut FreeBody::new(), settings(Control::Steps(steps)), t, |_, _| {});
        [distance(&node.state.q, &q), distance(&node.state.v, &omega)]
    });
}

/// Errors of runs from 1e-4 to 1e-10 stay within a factor of 100 of the tolerance.
fn follows_the_tolerance(name: &str, error: impl Fn(Settings) -> (f64, Counts)) {
    for digits in 4..=10 {
        let tolerance = 10f64.powi(-digits);
        let (error, counts) = error(precise(tolerance));
        assert!(error < 100.0 * tolerance && error > 0.01 * tolerance, "{name} {tolerance:e}: {error:e} {counts:?}");
    }
}

#[test]
fn errors_follow_the_tolerance() {
    follows_the_tolerance("pendulum", |settings| {
        let (node, counts) = run(&mut Pendulum::new(), settings, 10.0, |_, _| {});
        (distance(&node.state.q, &Pendulum::AT_10[..2]).max(distance(&node.state.v, &Pendulum::AT_10[2..])), counts)
    });
    follows_the_tolerance("Andrews", |settings| {
        let (node, counts) = run(&mut Andrews::new(), settings, 0.03, |_, _| {});
        (distance(&node.state.q, &Andrews::Q_03), counts)
    });
    follows_the_tolerance("car axis", |settings| {
        let (node, counts) = run(&mut CarAxis::new(), settings, 3.0, |_, _| {});
        (distance(&node.state.q, &CarAxis::Q_3).max(distance(&node.state.v, &CarAxis::V_3)), counts)
    });
    follows_the_tolerance("body", |settings| {
        let (t, omega, q) = FreeBody::OUTPUTS[1];
        let (node, counts) = run(&mut FreeBody::new(), settings, t, |_, _| {});
        (distance(&node.state.q, &q).max(distance(&node.state.v, &omega)), counts)
    });
    follows_the_tolerance("skate", |settings| {
        let [t, x, y] = Skate::OUTPUTS[2];
        let (node, counts) = run(&mut Skate::new(), settings, t, |_, _| {});
        (distance(&node.state.q[..2], &[x, y]), counts)
    });
    let stiff = StiffPair::new(1e6, 2e3);
    follows_the_tolerance("stiff", |settings| {
        let (node, counts) = run(&mut stiff.clone(), settings, 10.0, |_, _| {});
        let exact = stiff.exact(10.0);
        (distance(&node.state.q, &exact[..2]).max(distance(&node.state.v, &exact[2..])), counts)
    });
}

#[test]
fn andrews_mechanism_gets_ten_digits() {
    let (node, counts) = run(&mut Andrews::new(), precise(1e-12), 0.03, |_, _| {});
    let relative = |x: &[f64], y: &[f64]| x.iter().zip(y).fold(0.0, |m, (x, y)| f64::max(m, ((x - y) / y).abs()));
    let errors =
        [relative(&node.state.q, &Andrews::Q_03), relative(&node.state.v, &Andrews::V_03), relative(&node.lambda, &Andrews::LAMBDA_03)];
    assert!(errors.iter().all(|e| *e < 1e-10), "{errors:?} {counts:?}");
}

#[test]
fn tops_turn_by_quaternions() {
    for (t, centre, _) in HeavyTop::OUTPUTS {
        let (node, counts) = run(&mut HeavyTop::cusp(), precise(1e-9), t, |_, _| {});
        let (cartesian, _) = run(&mut HeavyTopCartesian::cusp(), precise(1e-9), t, |_, _| {});
        let errors = [distance(&HeavyTop::centre(&node.state.q), &centre), distance(&cartesian.state.q[..3], &centre)];
        assert!(errors.iter().all(|e| *e < 1e-8), "{t}: {errors:?} {counts:?}");
    }
}

#[test]
fn stiff_forces_do_not_ask_for_small_steps() {
    for (stiffness, damping) in [(1e6, 2e3), (1e10, 1e5), (1e10, 1e7)] {
        let mut system = StiffPair::new(stiffness, damping);
        let exact = system.exact(10.0);
        let (node, counts) = run(&mut system, precise(1e-6), 10.0, |_, _| {});
        assert!(distance(&node.state.q, &exact[..2]).max(distance(&node.state.v, &exact[2..])) < 1e-6);
        // 4 or 5 decades of transient, then 1.6 turns
        assert!(counts.steps < 250 && counts.rejected < 10 && counts.tangents < 4, "{counts:?}");
    }
}

/// Largest errors of the continuous solution in q and v at the ends of steps and inside of them, behind t = 0.3 s.
fn continuous<P: Problem>(system: &mut P, control: Control, end: f64, exact: impl Fn(f64) -> Vec<f64>) -> [f64; 2] {
    let start = system.start();
    let nq = start.q.len();
    let mut run = Integration::new(system, settings(control), &start).unwrap();
    let mut state = start.clone();
    let mut worst = [0.0_f64; 2];
    let mut progress = Progress::Step;
    while progress != Progress::End {
        progress = run.advance(system, end).unwrap();
        let (from, to) = (run.last().state.clone(), run.node().state.clone());
        let dense = run.dense(system).unwrap();
        for k in 0..=8 {
            dense.evaluate(from.t + (to.t - from.t) * f64::from(k) / 8.0, &mut state);
            let reference = exact(state.t);
            let error = distance(&state.q, &reference[..nq]).max(distance(&state.v, &reference[nq..]));
            match k {
                0 => assert!(distance(&state.q, &from.q).max(distance(&state.v, &from.v)) < 1e-13),
                8 => assert!(distance(&state.q, &to.q).max(distance(&state.v, &to.v)) < 1e-12),
                _ => {}
            }
            if from.t > 0.3 {
                let place = usize::from(k % 8 != 0);
                worst[place] = worst[place].max(error);
            }
        }
    }
    worst
}

#[test]
fn the_continuous_solution_is_as_good_as_the_nodes() {
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let control = Control::Tolerance(tolerance);
        let [nodes, inside] = continuous(&mut Pendulum::new(), control, 2.0, |t| Pendulum::exact(t).to_vec());
        assert!(inside < 1.1 * nodes, "{tolerance:e}: {nodes:e} {inside:e}");
        // where forces are stiff, only as good as the estimate of the error, which is 0.1 tol^0.8
        for (stiffness, damping) in [(1e6, 2e3), (1e10, 1e5), (1e10, 1e7)] {
            let pair = StiffPair::new(stiffness, damping);
            let [_, inside] = continuous(&mut pair.clone(), control, 10.0, |t| pair.exact(t).to_vec());
            assert!(inside < 0.5 * tolerance.powf(0.8), "{stiffness:e} {damping:e} {tolerance:e}: {inside:e}");
        }
    }
}

#[test]
fn rows_of_four_bars_pass_their_singular_positions() {
    for tolerance in [1e-8, 1e-10] {
        let mut twin = FourBarTwin::new(1);
        let energy = twin.energy(&twin.start());
        let (node, _) = run(&mut twin, precise(tolerance), 10.0, |_, _| {});
        let drift_of_twin = (twin.energy(&node.state) - energy).abs();
        for n in [1, 2, 6, 10] {
            let mut system = NFourBar::new(n, 1e-15);
            let energy = system.energy(&system.start());
            let shape = system.clone();
            let (mut drift, mut skew) = (0.0_f64, 0.0_f64);
            let (node, counts) = run(&mut system, precise(tolerance), 10.0, |system, node| {
                drift = drift.max((system.energy(&node.state) - energy).abs());
                let angles = shape.angles(&node.state.q);
                // implicit steps leave Φ as their iteration does, which says less of the angles near a flat position
                if angles[0].cos().abs() > 0.2 {
                    skew = angles.iter().fold(skew, |m, a| m.max((a - angles[0]).sin().abs()));
                }
            });
            let phi = shape.angles(&node.state.q)[0] - NFourBar::exact(n, 10.0)[0];
            // the twin has the inertia 1, the four-bar (4n + 1)/3
            let of_twin = 10.0 * drift_of_twin * (4 * n + 1) as f64 / 3.0;
            assert!(drift < of_twin && skew < 1e-12, "{n} {tolerance:e}: {drift:e} {of_twin:e} {skew:e} {counts:?}");
            assert!((0.5 * phi).sin().abs() < 1e2 * tolerance, "{n} {tolerance:e}: {phi}");
        }
    }
}

#[test]
fn the_slider_crank_with_equal_arms_keeps_its_branch() {
    for tolerance in [1e-8, 1e-10] {
        let [t, phi, rate, x] = SliderCrank::EQUAL_ARMS[3];
        let mut system = SliderCrank::equal_arms(1e-15);
        let energy = system.energy(&system.start());
        let mut drift = 0.0_f64;
        let (node, counts) = run(&mut system, precise(tolerance), t, |system, node| {
            drift = drift.max((system.energy(&node.state) - energy).abs());
        });
        let s = &node.state;
        assert!(distance(&[s.q[2], s.v[2], s.q[6]], &[phi, rate, x]) < 1e2 * tolerance, "{tolerance:e} {counts:?}");
        assert!(drift < 10.0 * tolerance, "{tolerance:e}: {drift:e} {counts:?}");
        let (node, _) = run(&mut system, precise(tolerance), 10.0, |_, _| {});
        assert!((node.state.q[2] + node.state.q[5]).sin().abs() < 1e-10);
    }
}

#[test]
fn switches_are_located_or_marched_across() {
    let mut system = KinkedSpring::new(1.0, 9.0);
    let exact = system.exact(5.0);
    for (locate, allowed) in [(true, 1e-7), (false, 1e-5)] {
        let (node, counts) = run(&mut system, Settings { locate, ..precise(1e-8) }, 5.0, |_, _| {});
        let error = distance(&[node.state.q[0], node.state.v[0]], &exact);
        assert!(error < allowed && (counts.events > 0) == locate, "{locate}: {error:e} {counts:?}");
    }
}

#[test]
fn energy_is_kept_for_a_thousand_seconds() {
    let mut system = Pendulum::new();
    // released at rest from the horizontal: the energy is that of the speed at the bottom, 9.81 J
    let mut drift = 0.0_f64;
    let (_, counts) = run(&mut system, precise(1e-11), 1000.0, |system, node| drift = drift.max(system.energy(&node.state).abs() / 9.81));
    assert!(drift < 1e-8, "{drift:e} {counts:?}");
}

fn allocates_nothing<P: Problem>(mut system: P, settings: Settings, end: f64) {
    let start = system.start();
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    // the sparse form of the matrices chooses its pivots in the first factorisation
    run.advance(&mut system, end).unwrap();
    let info = measure(|| {
        while run.advance(&mut system, end).unwrap() != Progress::End {
            run.dense(&mut system).unwrap();
        }
    });
    assert_eq!(info.count_total, 0, "{}", system.name());
}

#[test]
fn steps_allocate_nothing() {
    for level in LEVELS {
        allocates_nothing(Pendulum::new(), Settings { level, ..precise(1e-6) }, 1.0);
    }
    allocates_nothing(Andrews::new(), precise(1e-6), 0.01);
    allocates_nothing(HeavyTopCartesian::cusp(), precise(1e-6), 0.05);
    allocates_nothing(InductanceMotor::new(), precise(1e-6), 0.5);
    allocates_nothing(Skate::new(), settings(Control::Steps([0.01, 0.015])), 0.5);
    allocates_nothing(KinkedSpring::new(1.0, 9.0), precise(1e-6), 5.0);
}
