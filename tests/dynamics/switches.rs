//! Switches that come many in a step: conditions of time and of the motion against closed forms, in every scheme.

use super::scalar;
use crate::reference::Verdict;
use crate::reference::program::run_text;
use std::f64::consts::{PI, TAU};

/// Schemes that control their error, and one with a step that is long beside the switches.
const SCHEMES: [&str; 6] = [
    "integrator: dop853",
    "integrator: auto, tolerance: 1e-4",
    "integrator: radau5",
    "integrator: bdf, tolerance: 1e-6",
    "integrator: generalized-alpha, tolerance: 1e-5",
    "integrator: rk4, step: 0.1 s",
];

/// A wheel of 20 kg m² that turns at 50 rad/s, with what else is given.
fn wheel(rest: &str) -> String {
    format!(
        "grashof: 1
name: wheel
space: planar
gravity: none
bodies: {{ wheel: {{ mass: 30 kg, inertia: 20 kg m^2 }} }}
joints: {{ O: {{ revolute: [ground, wheel.origin] }} }}
start: {{ O.angle: 0 deg, O.omega: 50 rad/s }}
{rest}
"
    )
}

/// A brake of 6 N m in the first half of each turn: parabolas and straight lines, one after the other.
fn braked(until: f64) -> f64 {
    let (mut t, mut omega, slowing) = (0.0, 50.0, 6.0 / 20.0);
    loop {
        let after = f64::sqrt(omega * omega - 2.0 * slowing * PI);
        let braking = (omega - after) / slowing;
        if t + braking >= until {
            return omega - slowing * (until - t);
        }
        t += braking + PI / after;
        omega = after;
        if t >= until {
            return omega;
        }
    }
}

#[test]
fn a_brake_that_acts_in_half_of_each_turn() {
    let mut verdict = Verdict::default();
    for scheme in SCHEMES {
        let rest = format!(
            "loads: {{ brake: {{ joint: O, torque: \"if(sin(O.angle) > 0, -6 N m, 0 N m)\" }} }}
studies: {{ run: {{ dynamics: {{ until: 10 s, {scheme} }}, columns: [time, O.omega] }} }}"
        );
        let table = run_text(&wheel(&rest), &["--no-plots"]).succeeded().table("run");
        let found = table.rows.last().map_or(f64::NAN, |row| row[1]);
        verdict.close("O.omega", scheme, found, braked(10.0), 1e-7);
    }
    verdict.give("brake");
}

#[test]
fn short_pulses_in_each_turn_are_all_met() {
    let mut verdict = Verdict::default();
    for scheme in SCHEMES {
        // 0.0283 and 0.09 rad of each turn; 7 and 40 switches a turn; a narrow lobe of a cam
        let rest = format!(
            "tables: {{ cam: {{ points: [[0 deg, 0], [10 deg, 0], [12 deg, 1], [15 deg, 0], [360 deg, 0]], beyond: periodic }} }}
studies:
  run:
    dynamics: {{ until: {} s, every: 1 s, {scheme} }}
    columns: [time, O.angle]
    scalars: {{ narrow: \"mean(cos(O.angle - 1) > 0.9999)\", fast: \"mean(sin(20*O.angle) > 0.3)\", lobe: mean(cam(O.angle)), area: \"mean(abs(sin(3.5*O.angle)))\" }}",
            4.0 * TAU / 5.0 * 0.5
        );
        // 20 turns
        let found = run_text(&wheel(&rest), &["--no-plots"]).succeeded();
        let expected = [
            ("narrow", 2.0 * f64::acos(0.9999) / TAU),
            ("fast", (PI - 2.0 * f64::asin(0.3)) / TAU),
            ("lobe", 2.5 / 360.0),
            ("area", 2.0 / PI),
        ];
        for (name, expected) in expected {
            verdict.close(name, scheme, scalar(&found, "run", name), expected, 1e-8);
        }
    }
    verdict.give("pulses");
}

/// A condition that is met for 9e-5 rad of each turn alone, with nothing else that asks for close looks.
#[test]
fn a_hair_of_each_turn_is_met() {
    let mut verdict = Verdict::default();
    for scheme in SCHEMES {
        let rest = format!(
            "studies:
  run:
    dynamics: {{ until: {} s, every: 1 s, {scheme} }}
    columns: [time, O.angle]
    scalars: {{ hair: \"mean(cos(O.angle - 1) > 1 - 1e-9)\" }}",
            0.4 * TAU
        );
        let found = run_text(&wheel(&rest), &["--no-plots"]).succeeded();
        verdict.close("hair", scheme, scalar(&found, "run", "hair"), 2.0 * f64::acos(1.0 - 1e-9) / TAU, 1e-9);
    }
    verdict.give("hair");
}

/// A force of 1 N while sin(ω t + φ) > c acts for a known time, however many switches lie in a step.
#[test]
fn square_waves_of_time_are_bounded() {
    let mut verdict = Verdict::default();
    for (omega, phase, level) in [(50.0, 0.3, 0.0), (0.0, 0.3, 0.0), (1000.0, 1.0, 0.9), (333.3, 2.0, -0.999), (5.0, 0.0, 0.999_999)] {
        // from asin c to π − asin c in each turn, which begins before the turn where c < 0
        let (on, off) = (f64::asin(level), PI - f64::asin(level));
        let part = |x: f64| x.clamp(on.max(0.0), off) - on.max(0.0) + (x - TAU - on).max(0.0);
        let held = |x: f64| (x / TAU).floor() * (off - on) + part(x.rem_euclid(TAU));
        let expected = if omega == 0.0 { 1.0 } else { (held(phase + omega) - held(phase)) / omega };
        for scheme in SCHEMES {
            let text = format!(
                "grashof: 1
name: square wave
space: planar
gravity: none
bodies: {{ mass: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
joints: {{ P: {{ slider: [ground, mass.origin], axis: [1, 0] }} }}
loads: {{ f: {{ joint: P, force: \"if(sin({omega} rad/s*t + {phase}) > {level}, 1 N, 0 N)\" }} }}
start: {{ P.velocity: 0 m/s }}
studies: {{ run: {{ dynamics: {{ until: 1 s, {scheme} }}, columns: [time, P.velocity] }} }}
"
            );
            let table = run_text(&text, &["--no-plots"]).succeeded().table("run");
            let found = table.rows.last().map_or(f64::NAN, |row| row[1]);
            verdict.close(&format!("{omega} rad/s"), scheme, found, expected, 1e-9);
        }
    }
    verdict.give("square waves");
}

/// A smooth force far from everything else that acts: where nothing acts an error allows any step, but not one beyond it.
#[test]
fn a_smooth_force_behind_a_long_flight_is_met() {
    let mut verdict = Verdict::default();
    for place in [1.0, 5.0] {
        for width in [0.02, 0.05, 0.1] {
            // those that evaluate many places in a step
            for scheme in &SCHEMES[..3] {
                let text = format!(
                    "grashof: 1
name: flight
space: planar
gravity: none
bodies: {{ b: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, b.origin], axis: [1, 0] }} }}
loads: {{ f: {{ joint: S, force: \"-{} N*exp(-((S.position - {place} m)/{width} m)^2)\" }} }}
start: {{ S.position: 0 m, S.velocity: 3 m/s }}
studies: {{ run: {{ dynamics: {{ until: 2.5 s, {scheme} }}, columns: [time, S.velocity] }} }}
",
                    2.0 / width
                );
                let table = run_text(&text, &["--no-plots"]).succeeded().table("run");
                let found = table.rows.last().map_or(f64::NAN, |row| row[1]);
                // what the force takes: the area below it, all but a part 1e-12
                let right = f64::sqrt(9.0 - 4.0 * PI.sqrt());
                verdict.close(&format!("velocity behind {width} m at {place} m"), scheme, found, right, 2e-3);
            }
        }
    }
    verdict.give("flight");
}

/// A table that rests at 0 and 1, and what asks whether it does: a force (1 N on 1 kg), a rate of a state, scalars.
const PULSE: &str = "grashof: 1
name: pulse
space: planar
gravity: none
tables: { pulse: { points: [[0 s, 0], [1 s, 0], [2 s, 1], [3 s, 1], [4 s, 0], [5 s, 0]] } }
bodies: { c: { mass: 1 kg } }
joints: { S: { slider: [ground, c.origin], axis: [1, 0] } }
loads: { push: { joint: S, force: \"if(pulse(t) > 0, 1 N, 0 N)\" } }
states: { full: { start: 0 s, rate: \"if(pulse(t) >= 1, 1, 0)\" } }
";

#[test]
fn values_rest_on_what_they_are_compared_with() {
    let mut verdict = Verdict::default();
    let scalars = [
        ("v", "last(S.velocity)", 3.0),
        ("state", "last(full)", 1.0),
        ("up", "integral(pulse(t) >= 1)", 1.0),
        ("below", "integral(pulse(t) < 1)", 4.0),
        ("zero", "integral(pulse(t) == 0)", 2.0),
        ("other", "integral(pulse(t) != 0)", 3.0),
        ("of_first", "first(pulse(t) >= 1)", 2.0),
        ("of_sign", "integral(sign(pulse(t)))", 3.0),
        ("of_floor", "integral(floor(pulse(t)))", 1.0),
        ("of_ceil", "integral(ceil(pulse(t)))", 3.0),
        ("of_round", "integral(round(pulse(t)/2))", 1.0),
        ("of_mod", "integral(mod(pulse(t), 1))", 1.0),
        ("clamped", "integral(max(sin(t/1 s), 0) > 0)", PI),
    ];
    let list: Vec<String> = scalars.iter().map(|(name, formula, _)| format!("{name}: \"{formula}\"")).collect();
    for scheme in SCHEMES {
        let text = format!(
            "{PULSE}studies: {{ run: {{ dynamics: {{ until: 5 s, {scheme} }}, columns: [time, S.velocity], scalars: {{ {} }} }} }}\n",
            list.join(", ")
        );
        let run = run_text(&text, &["--no-plots"]).succeeded();
        for (name, formula, right) in scalars {
            verdict.close(formula, scheme, scalar(&run, "run", name), right, 1e-9);
        }
    }
    verdict.give("pulse");
}

/// A damper of 30 N s/m that acts while a buffer of 1 kN/m is pressed, by its depth: half a period of a damped vibration.
#[test]
fn a_force_ends_where_a_clamped_depth_comes_to_zero() {
    let mut verdict = Verdict::default();
    let free = f64::sqrt(1000.0 - 15.0 * 15.0);
    let right = f64::exp(-15.0 * PI / free);
    for scheme in &SCHEMES[..5] {
        let text = format!(
            "grashof: 1
name: buffer
space: planar
gravity: none
bodies: {{ c: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, c.origin], axis: [1, 0] }} }}
start: {{ S.position: 0.1 m, S.velocity: -1 m/s }}
measures: {{ depth: \"max(-S.position, 0 m)\" }}
loads: {{ buffer: {{ joint: S, force: \"1 kN/m*depth - if(depth > 0 m, 30 N s/m, 0 N s/m)*S.velocity\" }} }}
studies: {{ run: {{ dynamics: {{ until: 0.5 s, {scheme} }}, columns: [time, S.velocity], scalars: {{ v: last(S.velocity) }} }} }}
"
        );
        let run = run_text(&text, &["--no-plots"]).succeeded();
        verdict.close("v", scheme, scalar(&run, "run", "v"), right, 1e-4);
    }
    verdict.give("buffer");
}

/// A ball that has fallen on a rigid stop, and a block that has come to rest by friction: what asks for their rates has none.
#[test]
fn what_a_stop_or_friction_holds_has_no_rate() {
    let mut verdict = Verdict::default();
    let fallen = "gravity: [0, -10 m/s^2]
joints: { S: { slider: [ground, c.origin], axis: [0, 1], limits: { from: 0 m, restitution: 0 } }, X: { slider: [ground, d.origin], axis: [1, 0] } }
start: { S.position: 1 m }
";
    let stuck = "gravity: [0, -10 m/s^2]
joints: { S: { slider: [ground, c.origin], axis: [-1, 0], friction: { coulomb: 5 N } }, X: { slider: [ground, d.origin], axis: [1, 0] } }
start: { S.position: 0 m, S.velocity: -1 m/s }
";
    for (moves, until_rest) in [(fallen, f64::sqrt(0.2)), (stuck, 0.2)] {
        for scheme in SCHEMES {
            let text = format!(
                "grashof: 1
name: at rest
space: planar
bodies: {{ c: {{ mass: 1 kg }}, d: {{ mass: 1 kg }} }}
{moves}loads: {{ push: {{ joint: X, force: \"if(S.velocity > 0, 5 N, 1 N)\" }} }}
studies:
  run:
    dynamics: {{ until: 2 s, {scheme} }}
    columns: [time, S.velocity]
    scalars: {{ up: integral(S.velocity > 0), down: integral(S.velocity < 0), moving: integral(S.velocity != 0), x: last(X.velocity), a: \"value(S.acceleration, 1.5 s)\" }}
"
            );
            let run = run_text(&text, &["--no-plots"]).succeeded();
            for (name, right) in [("up", 0.0), ("down", until_rest), ("moving", until_rest), ("x", 2.0), ("a", 0.0)] {
                verdict.close(name, scheme, scalar(&run, "run", name), right, 1e-4);
            }
        }
    }
    verdict.give("at rest");
}

/// Work of 6 N m times how many fifths of a turn have passed since it began, from 0 to an angle.
fn stairs(angle: f64) -> f64 {
    let (turns, fifth) = ((angle / TAU).floor(), TAU / 5.0);
    let whole = ((angle - turns * TAU) / fifth).floor();
    let begun = whole * (whole - 1.0) / 2.0 + whole * ((angle - turns * TAU) / fifth - whole);
    6.0 * fifth * (10.0 * turns + begun)
}

/// Tables and whole numbers of what jumps back at the end of a cycle, over the time and over the angle.
#[test]
fn cycles_that_begin_anew_take_the_switches_inside_of_them_along() {
    let mut verdict = Verdict::default();
    for scheme in SCHEMES {
        let rest = |torque: &str, until: f64| {
            format!(
                "tables: {{ cycle: {{ points: [[0 s, 0 N m], [0.25 s, 8 N m], [0.5 s, 4 N m], [1 s, 2 N m]] }} }}
loads: {{ push: {{ joint: O, torque: \"{torque}\" }} }}
studies: {{ run: {{ dynamics: {{ until: {until} s, {scheme} }}, columns: [O.angle, O.omega] }} }}"
            )
        };
        // torque times time of a cycle of 1 s: 12 and 4 N m s; until, and past, the end of one
        for (torque, until, turned) in [
            ("6 N m*floor(5*mod(t, 1 s)/1 s)", 10.0, 120.0),
            ("6 N m*floor(5*mod(t, 1 s)/1 s)", 10.5, 122.4),
            ("cycle(mod(t, 1 s))", 10.0, 40.0),
            ("cycle(mod(t + 0.25 s, 1 s))", 10.75, 43.0),
        ] {
            let found = run_text(&wheel(&rest(torque, until)), &["--no-plots"]).succeeded().table("run");
            let omega = found.rows.last().map_or(f64::NAN, |row| row[1]);
            verdict.close("O.omega", format!("{scheme}, {torque}, until {until} s"), omega, 50.0 + turned / 20.0, 1e-7);
        }
        let found = run_text(&wheel(&rest("6 N m*floor(5*mod(O.angle, 1 turn)/1 turn)", 2.0)), &["--no-plots"]).succeeded().table("run");
        for row in &found.rows {
            let right = (2500.0 + 2.0 * stairs(row[0]) / 20.0).sqrt();
            verdict.close("O.omega over the angle", format!("{scheme}, {} rad", row[0]), row[1], right, 1e-7);
        }
    }
    verdict.give("cycles");
}

/// A start just before a switch of time has the side before it.
#[test]
fn a_switch_of_time_just_behind_the_start() {
    let mut verdict = Verdict::default();
    for late in ["0 s", "1e-15 s", "1e-12 s", "1e-9 s", "1e-6 s"] {
        let rest = format!(
            "loads: {{ push: {{ joint: O, torque: 6 N m*sign(t - {late}) }} }}
studies: {{ run: {{ dynamics: {{ until: 1 s, integrator: dop853 }}, columns: [O.omega] }} }}"
        );
        let found = run_text(&wheel(&rest), &["--no-plots"]).succeeded().table("run");
        verdict.close("O.omega", late, found.rows.last().map_or(f64::NAN, |row| row[0]), 50.3, 1e-6);
    }
    verdict.give("starts just before a switch");
}
