//! The problems meet their references and closed forms when a plain Runge-Kutta method integrates them.

use super::{close, distance, largest};
use crate::problems::*;
use grashof_solvers::State;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// The state at `end` after `steps` steps from the start, with a and λ there.
fn integrated(problem: &mut dyn Problem, end: f64, steps: usize) -> (State, Explicit) {
    let (mut solver, mut state) = (Explicit::new(problem), problem.start());
    solver.run(problem, &mut state, end, steps);
    (state, solver)
}

#[test]
fn pendulums_follow_the_elliptic_functions() {
    let (state, solver) = integrated(&mut Pendulum::new(), 10.0, 40_000);
    let reached = [&state.q[..], &state.v].concat();
    close("at 10 s", &reached, &Pendulum::AT_10, 1e-9);
    close("tension", &solver.lambda, &[Pendulum::exact_lambda(10.0)], 1e-9);
    close("closed form", &Pendulum::exact(10.0), &Pendulum::AT_10, 1e-14);
    let (state, _) = integrated(&mut PendulumAngle::new(), 10.0, 10_000);
    close("angle", &[state.q[0], state.v[0]], &PendulumAngle::exact(10.0), 1e-9);
    let start = PendulumAngle::exact(0.0);
    assert!(distance(&PendulumAngle::exact(Pendulum::PERIOD), &start) < 1e-14 && (start[0] + FRAC_PI_2).abs() < 1e-15);
}

#[test]
fn the_car_axis_meets_its_digits() {
    let (state, solver) = integrated(&mut CarAxis::new(), 3.0, 15_000);
    close("q", &state.q, &CarAxis::Q_3, 1e-8);
    close("v", &state.v, &CarAxis::V_3, 1e-7);
    close("lambda", &solver.lambda, &CarAxis::LAMBDA_3, 1e-7);
}

#[test]
fn the_squeezer_meets_its_digits() {
    let mut problem = Andrews::new();
    let start = problem.start();
    let mut solver = Explicit::new(&mut problem);
    solver.accelerate(&mut problem, start.at());
    close("start", &[solver.a[0], solver.a[1], solver.lambda[0], solver.lambda[1]], &Andrews::AT_START, 1e-12);
    let (state, solver) = integrated(&mut problem, 0.03, 6000);
    close("q", &state.q, &Andrews::Q_03, 1e-8);
    close("v", &state.v, &Andrews::V_03, 1e-7);
    close("lambda", &solver.lambda, &Andrews::LAMBDA_03, 1e-6);
    let (state, _) = integrated(&mut Andrews::iftomm(), 0.05, 10_000);
    close("q of A03", &state.q, &Andrews::IFTOMM_Q_05, 1e-8);
}

#[test]
fn slider_cranks_keep_their_energy_integral() {
    let mut problem = SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0);
    let (state, _) = integrated(&mut problem, 0.5, 5000);
    close("rate", &[state.v[2]], &[problem.rate_at(state.q[2])], 1e-9);
    let mut equal = SliderCrank::equal_arms(0.0);
    for [_, phi, rate, x] in SliderCrank::EQUAL_ARMS {
        close("closed form", &[equal.rate_at(phi), 2.0 * phi.cos()], &[rate, x], 1e-14);
    }
    let (state, _) = integrated(&mut equal, 0.5, 2000);
    close("before 90 degrees", &[state.q[2], state.v[2], state.q[6]], &SliderCrank::EQUAL_ARMS[0][1..], 1e-11);
}

#[test]
fn the_times_of_equal_arms_are_the_quadrature_of_their_rate() {
    let problem = SliderCrank::equal_arms(0.0);
    // ∫ dφ/φ̇ by the trapezoidal rule, which converges geometrically over a period; 45° to 90° by Simpson's
    let time = |phi: f64| 1.0 / problem.rate_at(phi);
    let turn = (0..400).map(|i| time(TAU * i as f64 / 400.0)).sum::<f64>() * TAU / 400.0;
    let (low, h) = (FRAC_PI_4, FRAC_PI_4 / 400.0);
    let weight = |i: usize| if i.is_multiple_of(400) { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    let quarter = (0..=400).map(|i| weight(i) * time(low + h * i as f64)).sum::<f64>() * h / 3.0;
    close("times", &[turn, quarter], &[SliderCrank::EQUAL_ARMS_TURN, SliderCrank::EQUAL_ARMS_TO_90], 1e-12);
}

#[test]
fn four_bars_follow_their_closed_form() {
    for (n, t, tip) in NFourBar::TIPS {
        let (s, c) = NFourBar::exact(n, t)[0].sin_cos();
        assert!(distance(&[s, c], &tip) < 1e-13, "{n}");
    }
    for (n, [turn, first, second]) in NFourBar::TIMES {
        let angles = [turn, first, second].map(|t| NFourBar::exact(n, t)[0]);
        close("angles", &angles, &[TAU, FRAC_PI_2, 1.5 * PI], 1e-14);
        close("turn", &[NFourBar::turn(n)], &[turn], 1e-15);
    }
    for n in [1, 2, 6] {
        let mut problem = NFourBar::new(n, 0.0);
        let (state, _) = integrated(&mut problem, 0.5, 500);
        let [phi, rate] = NFourBar::exact(n, 0.5);
        close("angles", &problem.angles(&state.q), &vec![phi; n + 1], 1e-10);
        close("rate", &[-state.v[2]], &[rate], 1e-10);
        let (state, _) = integrated(&mut FourBarTwin::new(n), 10.0, 10_000);
        close("twin", &[state.q[0], state.v[0]], &NFourBar::exact(n, 10.0), 1e-8);
    }
}

#[test]
fn the_free_body_flips_on_time() {
    let (mut problem, mut solver) = (FreeBody::new(), Explicit::new(&mut FreeBody::new()));
    let mut state = problem.start();
    for (t, omega, q) in FreeBody::OUTPUTS {
        let steps = ((t - state.t) / 5e-3).round() as usize;
        solver.run(&mut problem, &mut state, t, steps);
        assert!(distance(&state.v, &omega) < 1e-7 && distance(&state.q, &q) < 1e-7, "{state:?}");
    }
    let (state, _) = integrated(&mut problem, 0.5 * FreeBody::FLIP, 4000);
    assert!(state.v[1].abs() < 1e-7, "{state:?}");
}

#[test]
fn heavy_tops_nutate_and_press_on_their_pivot() {
    let (mut joint, mut cartesian) = (HeavyTop::cusp(), HeavyTopCartesian::cusp());
    let mut solvers = (Explicit::new(&mut joint), Explicit::new(&mut cartesian));
    let (mut state, mut free) = (joint.start(), cartesian.start());
    for (t, centre, force) in HeavyTop::OUTPUTS {
        let steps = (((t - state.t) / 5e-5).round() as usize).max(1);
        solvers.0.run(&mut joint, &mut state, t, steps);
        solvers.1.run(&mut cartesian, &mut free, t, steps);
        close("joint", &HeavyTop::centre(&state.q), &centre, 1e-7);
        close("cartesian", &free.q[..3], &centre, 1e-7);
        close("force", &[-solvers.1.lambda[2]], &[force], 1e-6);
    }
    let (state, _) = integrated(&mut joint, HeavyTop::NUTATION, 12_000);
    assert!((HeavyTop::centre(&state.q)[2] - 0.15).abs() < 1e-9, "back at the cusp");
    let (state, _) = integrated(&mut joint, 0.5 * HeavyTop::NUTATION, 6000);
    close("lowest", &[HeavyTop::centre(&state.q)[2]], &[0.3 * HeavyTop::LOWEST], 1e-7);
}

#[test]
fn steady_precession_stays_steady() {
    for fast in [false, true] {
        let rate = HeavyTop::PRECESSIONS[usize::from(fast)];
        let (state, _) = integrated(&mut HeavyTop::steady(fast), 0.5, 10_000);
        let (s, c) = (0.5 * rate).sin_cos();
        let radius = 0.3 * 0.75_f64.sqrt();
        close("centre", &HeavyTop::centre(&state.q), &[radius * c, radius * s, 0.15], 1e-7);
        let (state, _) = integrated(&mut HeavyTopCartesian::steady(fast), 0.5, 10_000);
        close("cartesian", &state.q[..3], &[radius * c, radius * s, 0.15], 1e-7);
    }
}

#[test]
fn chains_fall_as_their_references() {
    let mut ten = Chain::horizontal(10, 0.1);
    let (state, solver) = integrated(&mut ten, 0.5, 2000);
    close("angles", &ten.angles(&state.q), &Chain::TEN_ANGLES, 1e-6);
    close("tensions", &[0.1 * solver.lambda[0], 0.1 * solver.lambda[9]], &Chain::TEN_TENSIONS, 1e-6);
    for [t, x, y] in Chain::DOUBLE_TIPS {
        let (state, _) = integrated(&mut Chain::horizontal(2, 1.0), t, (2000.0 * t) as usize);
        close("tip", &state.q[2..], &[x, y], 1e-6);
    }
    let mut rods = RodChain::new(7);
    let energy = rods.energy(&rods.start());
    let (state, _) = integrated(&mut rods, 0.3, 3000);
    assert!((rods.energy(&state) - energy).abs() < 1e-8 && largest(&state.v) > 1.0);
}

#[test]
fn linear_systems_follow_their_exponentials() {
    let mut motor = InductanceMotor::new();
    let (state, _) = integrated(&mut motor, 0.7, 2000);
    close("motor", &[state.q[0], state.v[0], state.z[0]], &motor.exact(0.7), 1e-10);
    close("work", &state.work, &[motor.energy(&state)], 1e-9);
    // both signs of the discriminant
    for (stiffness, damping, t) in [(1e6, 2e3, 0.01), (1e6, 2e3, 1.0), (1e4, 3.0, 0.5)] {
        let mut pair = StiffPair::new(stiffness, damping);
        let (state, _) = integrated(&mut pair, t, 40_000);
        close("pair", &[&state.q[..], &state.v].concat(), &pair.exact(t), 1e-7);
        close("work", &state.work, &[pair.energy(&state) - pair.energy(&pair.start())], 1e-6);
    }
}

#[test]
fn the_skate_draws_a_cycloid() {
    for [t, x, y] in Skate::OUTPUTS {
        close("closed form", &Skate::exact(t)[..2], &[x, y], 1e-14);
        let (state, _) = integrated(&mut Skate::new(), t, 4000);
        close("skate", &state.q, &Skate::exact(t), 1e-10);
    }
}

/// The state at `end` and the times of the events until then.
fn with_events(problem: &mut dyn Problem, end: f64) -> (State, Vec<f64>) {
    let (mut solver, mut state) = (Explicit::new(problem), problem.start());
    let events = solver.run_with_events(problem, &mut state, end, 1e-3);
    (state, events)
}

#[test]
fn the_ball_bounces_towards_its_last_instant() {
    let mut ball = BouncingBall::new(1.0, 0.5);
    let (state, events) = with_events(&mut ball, 1.2);
    close("impacts", &events, &[0, 1, 2].map(|n| ball.impact(n)), 1e-12);
    close("state", &[state.q[0], state.v[0]], &ball.exact(1.2), 1e-10);
    close("limit", &[ball.impact(60)], &[ball.zeno()], 1e-14);
}

#[test]
fn friction_takes_the_same_from_every_half_swing() {
    let mut dry = DryOscillator::new(0.2);
    assert_eq!(dry.swings(), 3);
    for t in [0.1, 0.5, 0.8, 1.5] {
        let (state, events) = with_events(&mut dry, t);
        close("state", &[state.q[0], state.v[0]], &dry.exact(t), 1e-8);
        let reversals = events.len().min(3);
        close("reversals", &events, &(1..=reversals).map(DryOscillator::reversal).collect::<Vec<_>>(), 1e-9);
        close("work", &state.work, &[dry.energy(&state) - dry.energy(&dry.start())], 1e-8);
    }
}

#[test]
fn a_kinked_spring_has_two_half_periods() {
    let mut kinked = KinkedSpring::new(1.0, 9.0);
    let (state, events) = with_events(&mut kinked, 10.0);
    close("state", &[state.q[0], state.v[0]], &kinked.exact(10.0), 1e-9);
    let first = PI / 3.0;
    close(
        "passages",
        &events,
        &[first, kinked.period(), kinked.period() + first, 2.0 * kinked.period(), 2.0 * kinked.period() + first],
        1e-10,
    );
}

#[test]
fn gates_stop_or_note() {
    let (mut stop, mut record) = (StopAt::new(0.5), RecordAt::new(0.5));
    let (state, events) = with_events(&mut stop, 10.0);
    close("stop", &[events[0], state.t, state.q[0]], &[stop.passage(0), stop.passage(0), 0.5], 1e-10);
    let (state, events) = with_events(&mut record, 10.0);
    close("records", &events, &[0, 1, 2, 3].map(|n| record.passage(n)), 1e-10);
    close("state", &state.q, &[10.0_f64.sin()], 1e-9);
}
