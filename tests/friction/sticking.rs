//! Exact friction of joints: sticking and sliding against motions that are known in closed form, in all schemes and coordinates.

use super::{close, done, drift, forms, last};

/// A block on a belt, held by a spring from the frame: the belt draws it along until the spring is too strong, it slips back, and
/// sticks again.
fn belt(settings: &str, friction: &str) -> String {
    format!(
        "grashof: 1
name: block on a belt
space: planar
gravity: none
bodies:
  belt: {{ mass: 1 kg, inertia: 1 kg m^2 }}
  block: {{ mass: 2 kg, inertia: 0.01 kg m^2 }}
joints:
  G: {{ slider: [ground, belt.origin], axis: [1, 0] }}
  B: {{ slider: [belt.origin, block.origin], axis: [1, 0], friction: {{ {friction} }} }}
drivers: {{ motor: {{ joint: G, speed: 0.1 m/s }} }}
springs: {{ k: {{ stretch: block.x, stiffness: 50 N/m }} }}
start: {{ block.x: 0 m, block.vx: 0.1 m/s }}
studies:
  run:
    dynamics: {{ until: 6 s, every: 10 ms, {settings} }}
    columns: [time, block.x, block.vx, B.friction, k.force]
"
    )
}

#[test]
fn a_block_on_a_belt_sticks_and_slips_with_its_closed_form_period() {
    // Coulomb with static friction that is gone at once would jump; with equal ones the block rests at the edge, so take the friction
    // constant and let the belt begin against a stretched spring: from then on it sticks until k x = F, and stays at the edge
    let (k, f, v): (f64, f64, f64) = (50.0, 5.0, 0.1);
    let breaks = f / k / v;
    for (of, tolerance) in forms() {
        let outcome = done(&belt(&of, "coulomb: 5 N"), "run");
        // behind the break the block swings about x = F/k with the velocity of the belt: it slips forward of it, and is slower
        let w = (k / 2.0_f64).sqrt();
        let at = |t: f64| {
            if t <= breaks { v * t } else { f / k + v / w * (w * (t - breaks)).sin() }
        };
        // it sticks again once it has the velocity of the belt: after a whole turn of the swing, at x = F/k, where it breaks away
        for row in outcome.rows.iter().filter(|row| row[0] <= breaks + std::f64::consts::TAU / w) {
            close(&format!("x at {}, {of}", row[0]), row[1], at(row[0]), 20.0 * tolerance.max(1e-9));
        }
        let stuck: Vec<&[f64]> = outcome.rows.iter().filter(|row| row[0] < breaks - 1e-6).collect();
        assert!(stuck.len() > 90);
        for row in stuck {
            close(&format!("friction holds, {of}"), row[3], k * v * row[0], 1e-7);
        }
        assert!(drift(&outcome) < 1e-4, "{of}: {}", drift(&outcome));
    }
}

#[test]
fn stick_slip_has_the_period_of_its_closed_form() {
    // static 8 N falls to 4 N at once: slips by a half swing and a bit; the Stribeck speed is far below that of the belt
    let (m, k, fs, fk, v) = (2.0, 50.0, 8.0, 4.0, 0.1);
    let w: f64 = f64::sqrt(k / m);
    let text = belt("tolerance: 1e-10", "coulomb: 4 N, static: 8 N, stribeck_speed: 1e-9 m/s").replace("until: 6 s", "until: 20 s");
    let outcome = done(&text, "run");
    // slip: x − fk/k = A cos(w τ) + v/w sin(w τ), A = (fs − fk)/k, until x' = v again
    let a = (fs - fk) / k;
    let slips = 2.0 * (std::f64::consts::PI - (a * w / v).atan()) / w;
    let sticks = 2.0 * a / v;
    let mut events: Vec<f64> = outcome.switches.iter().map(|i| outcome.places[*i]).collect();
    // six times the Stribeck speed is passed at once
    events.dedup_by(|later, first| *later - *first < 1e-3);
    assert!(events.len() >= 8, "{events:?}");
    for pair in events.chunks_exact(2).skip(1) {
        close("a slip", pair[1] - pair[0], slips, 1e-4);
    }
    for pair in events[1..].chunks_exact(2) {
        close("a stick", pair[1] - pair[0], sticks, 1e-4);
    }
}

/// A block on an incline with a stop below.
fn incline(friction: &str, start: &str, settings: &str) -> String {
    format!(
        "grashof: 1
name: incline
space: planar
gravity: [0, -9.81 m/s^2]
parameters: {{ alpha: 30 deg }}
bodies: {{ block: {{ mass: 2 kg, inertia: 0.01 kg m^2 }} }}
joints:
  W: {{ slider: [ground, block.origin], axis: [cos(alpha), sin(alpha)], friction: {{ {friction} }} }}
start: {{ {start} }}
studies:
  slide: {{ dynamics: {{ until: 1 s, every: 10 ms, {settings} }}, columns: [time, W.position, W.velocity, W.friction, W.f] }}
"
    )
}

#[test]
fn a_block_thrown_up_an_incline_stays_or_slides_back() {
    let (s, c, g) = (0.5, 0.75_f64.sqrt(), 9.81);
    for (of, tolerance) in forms() {
        // 0.7 > tan 30°: it stops and stays, to the last bit at rest
        let up = g * (s + 0.7 * c);
        let stays = done(&incline("coulomb: 0.7", "W.velocity: 3 m/s", &of), "slide");
        close(&format!("where it stays, {of}"), last(&stays)[1], 9.0 / (2.0 * up), tolerance);
        close("at rest", last(&stays)[2], 0.0, 1e-12);
        close("held by", last(&stays)[3], 2.0 * g * s, 1e-9);
        assert_eq!(stays.switches.len(), 1, "{of}");
        // 0.3 < tan 30°: it slides back
        let (up, down) = (g * (s + 0.3 * c), g * (s - 0.3 * c));
        let back = done(&incline("coulomb: 0.3", "W.velocity: 3 m/s", &of), "slide");
        let t = 1.0 - 3.0 / up;
        close(&format!("where it is, {of}"), last(&back)[1], 9.0 / (2.0 * up) - 0.5 * down * t * t, 20.0 * tolerance);
        close("slides down", last(&back)[2], -down * t, 20.0 * tolerance);
    }
    // from rest
    let rest = done(&incline("coulomb: 0.6", "W.velocity: 0 m/s", "tolerance: 1e-9"), "slide");
    assert!(rest.rows.iter().all(|row| row[1].abs() < 1e-15 && row[2].abs() < 1e-15), "it rests where it was put");
    let slides = done(&incline("coulomb: 0.5", "W.velocity: 0 m/s", "tolerance: 1e-10"), "slide");
    close("from rest", last(&slides)[2], -g * (s - 0.5 * c), 1e-9);
}

/// Two blocks on each other, the lower one on a table and drawn by a growing force.
fn stack(settings: &str, rate: f64) -> String {
    format!(
        "grashof: 1
name: two blocks
space: planar
gravity: [0, -10 m/s^2]
bodies:
  low: {{ mass: 3 kg, inertia: 0.01 kg m^2 }}
  high: {{ mass: 1 kg, inertia: 0.01 kg m^2 }}
joints:
  T: {{ slider: [ground, low.origin], axis: [1, 0], friction: {{ coulomb: 0.1 }} }}
  S: {{ slider: [low.origin, high.origin], axis: [1, 0], friction: {{ coulomb: 0.3 }} }}
loads: {{ draw: {{ joint: T, force: {rate} N/s*t }} }}
start: {{ T.velocity: 0 m/s, S.velocity: 0 m/s }}
studies:
  run:
    dynamics: {{ until: 5 s, every: 10 ms, {settings} }}
    columns: [time, T.position, T.velocity, S.position, S.velocity, T.friction, S.friction]
"
    )
}

#[test]
fn two_blocks_move_together_until_the_upper_one_slips() {
    // the table holds 4 N until t = 1 s; both accelerate by (F − 4)/4 until the upper one asks more than 0.3·10 m/s²: F = 16 N
    let rate = 4.0;
    for (of, tolerance) in forms() {
        let outcome = done(&stack(&of, rate), "run");
        for row in &outcome.rows {
            let (t, wide) = (row[0], 50.0 * tolerance);
            if t <= 1.0 - 1e-9 {
                assert!(row[1].abs() < 1e-12 && row[2].abs() < 1e-12, "it rests, {of}");
                close("the table holds", row[5], -rate * t, 1e-9);
            } else if t <= 4.0 - 1e-9 {
                close(&format!("together, {of}"), row[2], 0.5 * (t - 1.0).powi(2), wide);
                close("no slip", row[4], 0.0, 1e-12);
            } else {
                // lower: (F − 4 − 3)/3, upper: 3 m/s²
                let low = 4.5 + (2.0 * (t * t - 16.0) - 7.0 * (t - 4.0)) / 3.0;
                close(&format!("lower, {of}"), row[2], low, wide);
                close(&format!("slip, {of}"), row[4], 4.5 + 3.0 * (t - 4.0) - low, wide);
            }
        }
        assert_eq!(outcome.switches.len(), 2, "{of}");
    }
}

#[test]
fn a_blow_is_not_held_by_friction() {
    // a carriage that friction holds on its own carrier meets a stop with it: the carrier stops, the carriage slides on
    let text = |settings: &str| {
        format!(
            "grashof: 1
name: carriage
space: planar
gravity: none
bodies: {{ carrier: {{ mass: 3 kg, inertia: 1 kg m^2 }}, box: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
joints:
  C: {{ slider: [ground, carrier.origin], axis: [1, 0], limits: {{ to: 1 m, restitution: 0 }} }}
  B: {{ slider: [carrier.origin, box.origin], axis: [1, 0], friction: {{ coulomb: 2 N }} }}
start: {{ C.velocity: 2 m/s, B.velocity: 0 m/s }}
studies:
  run: {{ dynamics: {{ until: 2 s, every: 10 ms, {settings} }}, columns: [time, C.position, C.velocity, B.position, B.velocity] }}
"
        )
    };
    for (of, tolerance) in forms() {
        let outcome = done(&text(&of), "run");
        // pushed on by 2 N the carrier stays on its stop; the box slides with 2 m/s and is braked by 2 m/s²: 1 m
        close(&format!("carrier, {of}"), last(&outcome)[1], 1.0, 10.0 * tolerance);
        close(&format!("box, {of}"), last(&outcome)[3], 1.0, 100.0 * tolerance);
        close(&format!("at rest, {of}"), last(&outcome)[4], 0.0, 1e-9);
    }
}

#[test]
fn what_a_driver_moves_slides_and_its_holding_force_is_open() {
    let text = "grashof: 1
name: driven slide
space: planar
gravity: none
bodies: { slide: { mass: 1 kg, inertia: 1 kg m^2 } }
joints: { S: { slider: [ground, slide.origin], axis: [1, 0], friction: { coulomb: 5 N } } }
drivers: { go: { joint: S, position: \"0.1 m*sin(2 rad/s*t)\" } }
studies: { run: { dynamics: { until: 4 s, every: 10 ms }, columns: [time, S.velocity, S.friction, go.force] } }
";
    let outcome = done(text, "run");
    for row in outcome.rows.iter().filter(|row| row[1].abs() > 1e-6) {
        close("friction", row[2], -5.0 * row[1].signum(), 1e-12);
        close("force", row[3], 5.0 * row[1].signum() - 0.4 * (2.0 * row[0]).sin(), 1e-9);
    }
    assert_eq!(outcome.switches.len(), 3);
}

/// A mass on a spring with friction by a load.
fn rubbed(stiffness: f64, stick: &str, tolerance: &str) -> String {
    format!(
        "grashof: 1
name: mass on a spring with friction by a load
space: planar
gravity: none
parameters: {{ stick: {stick} }}
bodies: {{ m2: {{ mass: 1 kg }} }}
joints: {{ S2: {{ slider: [ground, m2.origin], axis: [1, 0] }} }}
springs: {{ spring: {{ joint: S2, stiffness: {stiffness} N/m, rest: -0.25 m }} }}
measures: {{ R2: 1 N s/m*abs(S2.velocity) + 3 N + 5 N*exp(-2 s/m*abs(S2.velocity)) }}
loads: {{ rub2: {{ joint: S2, force: \"-R2*clamp(S2.velocity/stick, -1, 1)\" }} }}
start: {{ S2.position: 0, S2.velocity: -5 m/s }}
studies:
  run: {{ dynamics: {{ until: 5 s, every: 0.05 s, tolerance: {tolerance} }}, columns: [time, S2.position, S2.velocity] }}
"
    )
}

/// Where a mass stays that exact friction holds instead of a load, m.
fn held(stiffness: f64) -> f64 {
    let exact = rubbed(stiffness, "1 m/s", "1e-8").replace(
        "loads: { rub2: { joint: S2, force: \"-R2*clamp(S2.velocity/stick, -1, 1)\" } }",
        "clutches: { rub2: { joint: S2, force: R2 } }",
    );
    last(&done(&exact, "run"))[1]
}

#[test]
fn the_automatic_choice_does_not_crawl_at_a_small_stick_speed() {
    for stick in ["1e-5 m/s", "1e-6 m/s", "1e-7 m/s", "1e-8 m/s"] {
        let outcome = done(&rubbed(500.0, stick, "1e-8"), "run");
        let counts = &super::march(&outcome).counts;
        assert!(counts.steps < 3000, "stick {stick}: {} steps", counts.steps);
        close(&format!("where it stays, stick {stick}"), last(&outcome)[1], held(500.0), 1e-4);
    }
}

/// A polynomial over a step that is long beside the time in which a stiff force changes swings: what leaves the range of the force and is
/// back in it at the end of the step may never have left it.
#[test]
fn switches_beside_stiff_forces_neither_crawl_nor_pile_up() {
    for stiffness in [330.0, 430.0, 500.0, 1227.0] {
        let stays = held(stiffness);
        for stick in ["1e-6 m/s", "1e-7 m/s", "1e-8 m/s"] {
            for settings in ["1e-6", "1e-7", "1e-8", "1e-9", "1e-6, integrator: radau5", "1e-8, integrator: radau5"] {
                let outcome = done(&rubbed(stiffness, stick, settings), "run");
                let counts = &super::march(&outcome).counts;
                assert!(counts.steps < 3000, "{stiffness} N/m, {stick}, {settings}: {} steps", counts.steps);
                close(&format!("{stiffness} N/m, {stick}, {settings}"), last(&outcome)[1], stays, 1e-4);
            }
        }
    }
}

/// A step far longer than the time in which a force this stiff changes makes stages whose errors overflow.
#[test]
fn steps_whose_errors_overflow_are_rejected() {
    for tolerance in ["1e-6", "1e-7", "1e-8"] {
        let outcome = done(&rubbed(430.0, "1e-5 m/s", tolerance), "run");
        assert!(super::march(&outcome).counts.steps < 3000, "{tolerance}");
        let fastest = outcome.rows.iter().fold(0.0, |most: f64, row| most.max(row[2].abs()));
        // by all the energy that there is at the start
        assert!(fastest < (5.0_f64.powi(2) + 430.0 * 0.25_f64.powi(2)).sqrt(), "{tolerance}: {fastest:e} m/s");
    }
}

#[test]
fn statics_stays_where_friction_holds_and_names_the_region() {
    let text = |angle: f64, mu: f64| {
        format!(
            "grashof: 1
name: pendulum with a stiff pin
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ rod: {{ bar: {{ length: 1 m, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground, rod.start], friction: {{ coulomb: {mu} N m }} }} }}
start: {{ O.angle: {angle} deg }}
studies: {{ rest: {{ statics: {{ from: start }}, columns: [O.angle, O.friction] }} }}
"
        )
    };
    let weight = 9.81 * 0.5;
    let region = (1.0_f64 / weight).asin().to_degrees();
    let told = |outcome: &grashof::studies::common::outcome::Outcome| {
        let finding = outcome.findings.iter().find(|f| f.code == "held-by-friction").expect("a region");
        let numbers: Vec<f64> = finding.message.split_whitespace().filter_map(|w| w.parse().ok()).collect();
        assert_eq!(numbers.len(), 2, "{}", finding.message);
        close("lower end", numbers[0], -90.0 - region, 1e-3);
        close("upper end", numbers[1], -90.0 + region, 1e-3);
    };
    let held = done(&text(-95.0, 1.0), "rest");
    close("where it was put", last(&held)[0], (-95.0_f64).to_radians(), 1e-12);
    close("held by", last(&held)[1], weight * (-95.0_f64).to_radians().cos(), 1e-9);
    told(&held);
    let falls = done(&text(-30.0, 1.0), "rest");
    close("below", last(&falls)[0], -std::f64::consts::FRAC_PI_2, 1e-9);
    told(&falls);
}

#[test]
fn a_dwell_leaves_the_friction_of_a_driven_study_open() {
    let text = "grashof: 1
name: driven slide that waits
space: planar
gravity: none
bodies: { slide: { mass: 1 kg, inertia: 1 kg m^2 } }
joints: { S: { slider: [ground, slide.origin], axis: [1, 0], friction: { coulomb: 5 N } } }
drivers: { go: { joint: S, rise: { by: 0.1 m, during: 1 s, law: cycloidal } } }
studies: { run: { inverse: { over: 2 s, samples: 40 }, columns: [time, S.friction, go.force] } }
";
    let outcome = done(text, "run");
    let finding = outcome.findings.iter().find(|f| f.code == "friction-not-unique").expect("a finding");
    assert!(finding.message.contains("-5.000000 to 5.000000 N"), "{}", finding.message);
    close("in motion", outcome.rows[1][1], -5.0, 1e-12);
}

#[test]
fn the_fall_of_friction_just_before_rest_is_seen_by_long_steps() {
    // on an incline that is too flat to slide on: m v̇ = −g(v) − m g sin α; the fall is passed in less than a thousandth of the time
    let (coulomb, rest, narrow, slope) = (2.0, 6.0, 1e-3, 9.81 * 0.1);
    let friction = |v: f64| coulomb + (rest - coulomb) * (-(v / narrow).powi(2)).exp();
    let parts = 20_000;
    // Simpson's rule, the fall apart
    let time = |from: f64, to: f64| {
        let h = (to - from) / f64::from(parts);
        let f = |k: i32| 1.0 / (friction(from + f64::from(k) * h) + slope);
        (0..parts).step_by(2).map(|k| h / 3.0 * (f(k) + 4.0 * f(k + 1) + f(k + 2))).sum::<f64>()
    };
    let stops = time(0.0, 10.0 * narrow) + time(10.0 * narrow, 2.0);
    for (of, tolerance) in forms().filter(|(of, _)| of.contains("tolerance")) {
        let text = format!(
            "grashof: 1
name: braked
space: planar
gravity: [-0.981 m/s^2, 0]
bodies: {{ block: {{ mass: 1 kg, inertia: 0.01 kg m^2 }} }}
joints:
  S: {{ slider: [ground, block.origin], axis: [1, 0], friction: {{ coulomb: 2 N, static: 6 N, stribeck_speed: 1 mm/s }} }}
start: {{ S.velocity: 2 m/s }}
studies: {{ run: {{ dynamics: {{ until: 1 s, every: 0.5 s, {of} }}, columns: [time, S.velocity] }} }}
"
        );
        let outcome = done(&text, "run");
        let last = outcome.switches.last().map_or(f64::NAN, |i| outcome.places[*i]);
        close(&format!("when it stops, {of}"), last, stops, 20.0 * tolerance);
    }
}

/// A block between two guides in a line, one of which rubs: how the guides share its weight is left open by a redundant row.
#[test]
fn a_motion_under_friction_by_reactions_that_are_not_unique_says_so() {
    let text = |second: &str, joint: &str| {
        format!(
            "grashof: 1
name: two guides
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ c: {{ mass: 1 kg, inertia: 0.01 kg m^2, points: {{ L: [-1 m, 0], R: [1 m, 0] }} }} }}
ground: {{ L: [-1 m, 0], R: [1 m, 0] }}
joints:
  L: {{ {second}: [ground.L, c.L], axis: [1, 0] }}
  R: {{ {joint}: [ground.R, c.R], axis: [1, 0]{} }}
start: {{ c.vx: 1 m/s }}
studies: {{ run: {{ dynamics: {{ until: 0.2 s }}, columns: [time, c.vx] }} }}
",
            if joint == "slider" { ", friction: { coulomb: 0.2 }" } else { "" }
        )
    };
    let told = |text: &str| done(text, "run").findings.iter().any(|f| f.code == "friction-not-unique");
    assert!(told(&text("slider", "slider")));
    assert!(!told(&text("slider", "pin-in-slot")));
}

/// Two motors that a pair of gears joins: only what they do together is determined.
#[test]
fn drivers_that_hold_the_same_motion_say_so() {
    let text = |gear: &str| {
        format!(
            "grashof: 1
name: two motors
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: 1 kg m^2 }}, b: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
ground: {{ A: [0, 0], B: [1 m, 0] }}
joints: {{ A: {{ revolute: [ground.A, a.origin] }}, B: {{ revolute: [ground.B, b.origin] }} }}
{gear}drivers: {{ first: {{ joint: A, speed: 1 rad/s }}, second: {{ joint: B, speed: -1 rad/s }} }}
studies: {{ run: {{ dynamics: {{ until: 0.2 s }}, columns: [time, first.torque] }} }}
"
        )
    };
    let told = |text: &str| done(text, "run").findings.iter().any(|f| f.code == "efforts-not-unique");
    assert!(told(&text("couplings: { pair: { gear: [A, B], ratio: -1 } }\n")));
    assert!(!told(&text("")));
}

/// A block pressed against its stop, or against that of another one geared to it: how friction and the stop share the load is open, in
/// whichever coordinates, with and without an inertia of what does not turn.
#[test]
fn friction_beside_a_rigid_stop_says_so() {
    let text = |joints: [&str; 2], rest: &str, inertia: &str, study: &str| {
        format!(
            "grashof: 1
name: block on a stop
space: planar
gravity: none
bodies: {{ a: {{ mass: 2 kg{inertia} }}, b: {{ mass: 1 kg{inertia} }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0]{} }}
  B: {{ slider: [ground, b.origin], axis: [1, 0]{} }}
couplings: {{ pair: {{ zero: A.position - B.position }} }}
loads: {{ f: {{ joint: A, force: 10 N }} }}
start: {{ {rest} }}
studies: {{ run: {{ {study} }} }}
",
            joints[0], joints[1]
        )
    };
    let (rubs, stops) = (", friction: { coulomb: 3 N }", ", limits: { to: 5 cm, restitution: 0.3 }");
    let both = format!("{rubs}{stops}");
    let told = |text: &str| {
        let outcome = done(text, "run");
        let told = outcome.findings.iter().any(|f| f.code == "friction-not-unique" && f.message.contains("stop"));
        (told, last(&outcome).to_vec())
    };
    for inertia in ["", ", inertia: 1 kg m^2"] {
        for coordinates in ["joint", "cartesian", "minimal"] {
            let study = |columns: &str| format!("dynamics: {{ until: 1 s, coordinates: {coordinates} }}, columns: [{columns}]");
            for (joints, columns) in [([both.as_str(), ""], "A.friction, A.stop"), ([rubs, stops], "A.friction, B.stop")] {
                let (told, row) = told(&text(joints, "A.position: 4 cm", inertia, &study(columns)));
                assert!(told, "{coordinates}, {joints:?}, {inertia}");
                close("together", row.iter().sum::<f64>(), -10.0, 1e-6);
            }
            assert!(!told(&text([stops, ""], "A.position: 4 cm", inertia, &study("A.stop"))).0);
            // friction alone brings it to rest before the stop
            let weak = text([both.as_str(), ""], "A.position: 1 cm, A.velocity: 0.1 m/s", inertia, &study("A.friction"));
            assert!(!told(&weak.replace("force: 10 N", "force: 1 N")).0, "{coordinates}");
        }
        let study = "statics: { from: start }, columns: [A.friction]";
        for joints in [[both.as_str(), ""], [rubs, stops]] {
            let at = |place: &str| text(joints, &format!("A.position: {place}"), inertia, study).replace("force: 10 N", "force: 2 N");
            assert!(told(&at("5 cm")).0, "{joints:?}");
            assert!(!told(&at("4 cm")).0, "{joints:?}");
        }
    }
}
