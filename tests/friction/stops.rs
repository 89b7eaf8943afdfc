//! Stops of joints: rigid ones that throw back and hold, and those with stiffness, against closed forms.

use super::{close, done, drift, forms, last, march, tried};
use grashof::studies::common::outcome::Outcome;

/// Gravity of these tests, m/s².
const G: f64 = 9.81;

/// A ball over a floor at 0 with a load on it.
fn ball(limits: &str, load: &str, start: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: ball over a floor
space: planar
gravity: [0, -{G} m/s^2]
bodies:
  ball: {{ mass: 0.5 kg, inertia: 1e-4 kg m^2 }}
joints:
  W: {{ slider: [ground, ball.origin], axis: [0, 1], limits: {{ {limits} }} }}
loads:
  lift: {{ joint: W, force: \"{load}\" }}
start: {{ {start} }}
studies:
  fall: {{ {study}, columns: [time, W.position, W.velocity, W.acceleration] }}
"
    )
}

/// Times at which two rows are the two sides of a switch.
fn sides(outcome: &Outcome) -> impl Iterator<Item = f64> + '_ {
    outcome.rows.iter().zip(outcome.rows.iter().skip(1)).filter(|(a, b)| a[0] == b[0]).map(|(a, _)| a[0])
}

/// Height and velocity of a ball dropped from `height` at t, resting from the end of its bounces on.
fn bouncing(height: f64, e: f64, t: f64) -> [f64; 2] {
    let (mut from, mut up) = (-(2.0 * height / G).sqrt(), (2.0 * G * height).sqrt());
    let mut end = -from;
    while end <= t {
        (from, up) = (end, e * up);
        if up < 1e-9 {
            return [0.0, 0.0];
        }
        end += 2.0 * up / G;
    }
    [(t - from) * (up - 0.5 * G * (t - from)), up - G * (t - from)]
}

#[test]
fn a_ball_bounces_at_its_times_and_comes_to_rest() {
    let (height, e) = (0.5, 0.6);
    let fall = (2.0 * height / G).sqrt();
    let rest = fall + 2.0 * fall * e / (1.0 - e);
    for settings in [
        "tolerance: 1e-10",
        "integrator: dop853, tolerance: 1e-10",
        "integrator: radau5, tolerance: 1e-10, coordinates: cartesian",
        "integrator: bdf, tolerance: 1e-9",
        "integrator: rk4, step: 1 ms",
        "integrator: generalized-alpha, rho: 0.8, step: 1 ms",
        "coordinates: minimal, tolerance: 1e-10",
    ] {
        let study = format!("dynamics: {{ until: 2 s, every: 10 ms, {settings} }}");
        let text = ball("from: 0 m, restitution: 0.6, rest_speed: 1e-5 m/s", "0 N", "W.position: 0.5 m", &study);
        let outcome = done(&text, "fall");
        let within = if settings.contains("alpha") { 1e-5 } else { 1e-6 };
        for row in outcome.rows.iter().filter(|r| (r[0] - rest).abs() > 1e-4) {
            let [x, v] = bouncing(height, e, row[0]);
            close(&format!("height at {} s, {settings}", row[0]), row[1], x, within);
            // both sides of a blow stand in the rows
            if (v - row[2]).abs() > 1e-4 {
                let [_, before] = bouncing(height, e, row[0] - 1e-7);
                let [_, after] = bouncing(height, e, row[0] + 1e-7);
                assert!((row[2] - before).abs().min((row[2] - after).abs()) < 1e-4, "v at {} s, {settings}: {}", row[0], row[2]);
            }
        }
        let count = outcome.certificate.switches;
        // blows until the rebound is below rest_speed: e^n √(2 g h) < 1e-5
        let blows = ((1e-5 / (2.0 * G * height).sqrt()).ln() / f64::ln(e)).ceil() as usize;
        assert!((blows..=blows + 4).contains(&count), "{settings}: {count} switches, {blows} blows");
        assert!(last(&outcome)[1..].iter().all(|x| x.abs() < 1e-13), "{settings}: {:?}", last(&outcome));
        close("energy taken by the blows", march(&outcome).stops, -0.5 * G * height, 1e-6);
        assert!(drift(&outcome) < 1e-5, "{settings}: {}", drift(&outcome));
    }
}

#[test]
fn a_resting_ball_stays_until_a_load_lifts_it() {
    // the load k t carries the weight at t = m g/k; from there m x'' = k (t − t₀), x = k (t − t₀)³/(6 m)
    let k: f64 = 10.0;
    let lifts = 0.5 * G / k;
    for settings in ["tolerance: 1e-10", "integrator: radau5, tolerance: 1e-10", "integrator: bdf, tolerance: 1e-9", "coordinates: minimal"]
    {
        let study = format!("dynamics: {{ until: 1.5 s, every: 50 ms, {settings} }}");
        let outcome = done(&ball("from: 0 m, to: 4 m, restitution: 0.3", "10 N/s*t", "W.position: 0 m", &study), "fall");
        for row in &outcome.rows {
            let x = if row[0] < lifts { 0.0 } else { k * (row[0] - lifts).powi(3) / 3.0 };
            close(&format!("height at {} s, {settings}", row[0]), row[1], x, 1e-7);
        }
        assert!(sides(&outcome).any(|t| (t - lifts).abs() < 1e-7), "{settings}: no event");
        assert!(drift(&outcome) < 1e-7, "{settings}: {}", drift(&outcome));
    }
}

#[test]
fn between_two_stops_without_loss_the_motion_has_its_period() {
    // from 0 to L and back at the speed v: 2 L/v; after ten periods where it was
    let text = ball(
        "from: 0 m, to: 1 m, restitution: 1",
        "0.5 kg*9.81 m/s^2",
        "W.position: 0.25 m, W.velocity: 2 m/s",
        "dynamics: { until: 10 s, tolerance: 1e-10 }",
    );
    let outcome = done(&text, "fall");
    close("height", last(&outcome)[1], 0.25, 1e-8);
    close("velocity", last(&outcome)[2], 2.0, 1e-9);
    assert_eq!(outcome.certificate.switches, 20);
}

#[test]
fn a_contact_with_stiffness_lasts_half_a_period() {
    // without gravity: a blow at v on a spring k takes π √(m/k) and gives v back; the deepest place is v √(m/k) deep
    let text = ball(
        "from: 0 m, stiffness: 2000 N/m",
        "0.5 kg*9.81 m/s^2",
        "W.position: 10 cm, W.velocity: -1 m/s",
        "dynamics: { until: 0.2 s, tolerance: 1e-11 }",
    );
    let outcome = done(&text, "fall");
    let sides: Vec<f64> = sides(&outcome).collect();
    close("contact begins", sides[0], 0.1, 1e-9);
    close("contact lasts", sides[1] - sides[0], std::f64::consts::PI * (0.5_f64 / 2000.0).sqrt(), 1e-9);
    close("velocity", last(&outcome)[2], 1.0, 1e-8);
    let deepest = outcome.extremes[1].as_ref().expect("extremes").min.value;
    close("depth", deepest, -(0.5_f64 / 2000.0).sqrt(), 1e-9);
}

#[test]
fn a_slider_crank_strikes_a_stop_and_rests_on_it_in_every_coordinate() {
    let model = |settings: &str| {
        format!(
            "grashof: 1
name: crank on a stop
space: planar
gravity: [0, -{G} m/s^2]
ground: {{ O: [0, 0] }}
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: 0.4 kg }} }}
  rod: {{ bar: {{ length: 30 cm, mass: 0.6 kg }} }}
  piston: {{ mass: 0.5 kg, inertia: 1e-3 kg m^2 }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, rod.start] }}
  B: {{ revolute: [rod.end, piston.origin] }}
  W: {{ slider: [ground.O, piston.origin], axis: [1, 0], limits: {{ from: 25 cm, restitution: 0.4 }} }}
loads:
  push: {{ joint: W, force: \"if(t < 0.8 s, -20 N, 30 N)\" }}
start: {{ O.angle: 60 deg, rod.angle: ~-20 deg, W.position: ~34 cm }}
studies:
  strike: {{ dynamics: {{ until: 1 s, every: 10 ms, tolerance: 1e-9, {settings} }}, columns: [time, O.angle, W.position, O.f] }}
"
        )
    };
    let reference = done(&model("integrator: dop853"), "strike");
    assert!(reference.rows.iter().any(|r| (r[2] - 0.25).abs() < 1e-12), "it rests");
    assert!(reference.rows.iter().any(|r| r[0] > 0.9 && r[2] > 0.35), "it leaves");
    assert!(drift(&reference) < 1e-6, "{}", drift(&reference));
    for settings in ["coordinates: cartesian", "coordinates: minimal", "integrator: radau5", "integrator: bdf"] {
        let other = done(&model(settings), "strike");
        for (found, right) in last(&other).iter().zip(last(&reference)) {
            close(settings, *found, *right, 2e-5 * right.abs().max(1.0));
        }
    }
}

#[test]
fn a_driver_does_not_move_through_a_rigid_stop() {
    let text = ball("from: 0 m, to: 1 m, restitution: 0.5", "0 N", "W.position: 0.5 m", "inverse: { over: 2 s, samples: 50 }")
        .replace("start:", "drivers: { drive: { joint: W, position: \"0.5 m + 0.3 m/s*t\" } }\nstart:");
    let told = tried(&text, "fall").expect("rows").stopped.expect("a reason");
    assert!(told.contains("upper stop at 1 m"), "{told}");
    let beyond = ball("from: 0 m, restitution: 0.5", "0 N", "W.position: -0.1 m", "dynamics: { until: 1 s }");
    let told = tried(&beyond, "fall").expect_err("a refusal");
    assert!(told.reason().contains("beyond the lower stop of joint `W`"), "{}", told.reason());
}

/// Where switches are marched across, stops and events still act: the bounces are those of the closed form.
#[test]
fn stops_hold_where_switches_are_marched_across() {
    for integrator in ["rk4", "newmark", "generalized-alpha", "central-difference"] {
        let study = format!("dynamics: {{ until: 1 s, every: 10 ms, integrator: {integrator}, step: 1 ms, switches: step-over }}");
        let text = ball("from: 0 m, restitution: 0.6, rest_speed: 1e-5 m/s", "0 N", "W.position: 0.5 m", &study);
        for row in &done(&text, "fall").rows {
            let [x, v] = bouncing(0.5, 0.6, row[0]);
            // at a bounce itself either side may be meant
            assert!((row[1] - x).abs() < 1e-8 && ((row[2] - v).abs() < 1e-6 || x < 1e-8), "{integrator}: {row:?} {x} {v}");
        }
    }
}

/// Two sliders that move as one, each over its own floor: both strike at the same instant, and are thrown back once.
#[test]
fn two_stops_at_one_instant_throw_back_once() {
    let text = format!(
        "grashof: 1
name: two stops
space: planar
gravity: [0, -{G} m/s^2]
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 2 kg }} }}
joints:
  S: {{ slider: [ground, a.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: 0.5 }} }}
  T: {{ slider: [ground, b.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: 0.5 }} }}
couplings: {{ g: {{ gear: [S, T], ratio: 1 }} }}
start: {{ S.position: 1 m, T.position: 1 m }}
studies: {{ s: {{ dynamics: {{ until: 0.9 s, every: 0.01 s }}, columns: [time, S.position, T.position] }} }}
"
    );
    for row in &done(&text, "s").rows {
        let [x, _] = bouncing(1.0, 0.5, row[0]);
        assert!((row[1] - x).abs() < 1e-9 && (row[2] - x).abs() < 1e-9, "{row:?} {x}");
    }
}

/// No blow stops what a driver moves: the run ends at the stop and says so.
#[test]
fn a_driver_runs_into_a_stop() {
    let text = "grashof: 1
name: driver into a stop
space: planar
gravity: none
bodies: { b: { mass: 1 kg } }
joints: { S: { slider: [ground, b.origin], axis: [1, 0], limits: { to: 10 cm, restitution: 0.5 } } }
drivers: { d: { joint: S, speed: 0.1 m/s } }
studies: { s: { dynamics: { until: 1.2 s, every: 0.1 s }, columns: [time, S.position] } }
";
    let outcome = tried(text, "s").expect("results up to there");
    let stopped = outcome.stopped.clone().unwrap_or_default();
    assert!(stopped.contains("at t = 1.000000 s the upper stop of joint `S`") && stopped.contains("no blow"), "{stopped}");
    let end = last(&outcome);
    close("time", end[0], 1.0, 1e-9);
    close("place", end[1], 0.1, 1e-10);
}

/// What stops with a stiffness store is potential energy; what their dampers take is work of stops, none of loads or dampers.
#[test]
fn stops_that_give_way_store_energy() {
    for (damping, keeps) in [("0 N s/m", true), ("20 N s/m", false)] {
        let limits = format!("from: 0 m, to: 0.3 m, stiffness: 5 kN/m, damping: {damping}");
        let text = ball(&limits, "0 N", "W.position: 0.2 m, W.velocity: 2 m/s", "dynamics: { until: 1 s, every: 20 ms, tolerance: 1e-10 }")
            .replace("W.acceleration]", "W.acceleration, energy.potential, energy.total]");
        let outcome = done(&text, "fall");
        let start = &outcome.rows[0];
        for row in &outcome.rows {
            let depth = (row[1] - 0.3).max(-row[1]).max(0.0);
            close("potential", row[4], 0.5 * G * row[1] + 0.5 * 5000.0 * depth * depth, 1e-12);
            assert!(row[5] <= start[5] + 1e-8 && (!keeps || row[5] >= start[5] - 1e-8), "{row:?}");
        }
        let march = march(&outcome);
        assert!(march.loads == 0.0 && march.dampers == 0.0 && march.energy_drift < 1e-7, "{march:?}");
        assert_eq!(march.stops < -0.1, !keeps, "{march:?}");
    }
}

#[test]
fn a_ball_rebounds_from_a_hard_spring_in_every_scheme() {
    // a contact of 0.3 ms after each flight of 0.9 s: steps of the flight must not swallow it, nor implicit schemes damp it
    let (g, k): (f64, f64) = (9.81, 1e8);
    let lowest = -(g / k + ((g / k).powi(2) + 2.0 * g / k).sqrt());
    let loose = ["1e-4", "1e-6"].map(|tolerance| (format!("integrator: radau5, tolerance: {tolerance}"), tolerance.parse().unwrap()));
    for (of, tolerance) in forms().filter(|(of, _)| of.contains("tolerance")).chain(loose) {
        let text = format!(
            "grashof: 1
name: ball
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ ball: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, ball.origin], axis: [0, 1], limits: {{ from: 0 m, stiffness: 1e8 N/m }} }} }}
start: {{ S.position: 1 m, S.velocity: 0 m/s }}
studies:
  fall:
    dynamics: {{ until: 10 s, every: 0.5 s, {of} }}
    columns: [time, S.position]
    scalars: {{ low: min(S.position), high: \"value(S.position, 9.9296 s)\", stops: work_stops }}
"
        );
        let outcome = done(&text, "fall");
        let [low, high, stops] = outcome.scalars[..] else { panic!("three scalars") };
        close(&format!("lowest, {of}"), low, lowest, 1e-2 * tolerance.max(1e-6));
        assert!(drift(&outcome) < 1e3 * tolerance.max(1e-8), "{of}: {}", drift(&outcome));
        close(&format!("work of the stop, {of}"), stops, 0.0, 1e-6);
        assert_eq!(outcome.switches.len(), 22, "{of}");
        // eleven flights of 2 √(2/g) and contacts of (π + 2 atan(g/(ω v)))/ω later it is at the top once more
        let (v, w) = ((2.0 * g).sqrt(), k.sqrt());
        let period = 2.0 * v / g + (std::f64::consts::PI + 2.0 * (g / (w * v)).atan()) / w;
        let off = 9.9296 - 11.0 * period;
        close(&format!("at the top, {of}"), high, 1.0 - 0.5 * g * off * off, 2e4 * tolerance);
    }
}

/// A block on a carriage that a load accelerates comes to rest on a stop of the slider that its weight makes rub: the stop carries what both
/// share, the friction holds where the load turns, and the block slides off where it is too strong.
#[test]
fn a_block_rests_on_a_stop_of_the_joint_that_rubs() {
    let text = |inertia: &str, settings: &str| {
        format!(
            "grashof: 1
name: block on a carriage
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ c: {{ mass: 2 kg{inertia} }}, b: {{ mass: 1 kg{inertia} }} }}
joints:
  S: {{ slider: [ground, c.origin], axis: [1, 0] }}
  T: {{ slider: [c.origin, b.origin], axis: [1, 0], friction: {{ coulomb: 0.1 }}, limits: {{ to: 5 cm, restitution: 0.3 }} }}
loads: {{ f: {{ joint: S, force: \"if(t < 0.3 s, -30 N, if(t < 0.4 s, 1.5 N, 6 N))\" }} }}
start: {{ S.position: 0 m, T.position: 4 cm }}
studies:
  d:
    dynamics: {{ until: 0.5 s, every: 10 ms, {settings} }}
    columns: [time, S.velocity, T.position, T.velocity, T.friction, T.stop]
"
        )
    };
    // bodies that do not turn need no inertia
    let settings = ["tolerance: 1e-10", "coordinates: cartesian, tolerance: 1e-10", "integrator: radau5, tolerance: 1e-10"];
    for (inertia, settings) in ["", ", inertia: 1 kg m^2"].into_iter().flat_map(|inertia| settings.map(|settings| (inertia, settings))) {
        let outcome = done(&text(inertia, settings), "d");
        for row in &outcome.rows {
            let &[t, vs, x, v, friction, stop] = row else { panic!("six columns") };
            let what = format!("{row:?}{inertia}, {settings}");
            // at rest beside each other they have 10 m/s² back, then 0.5 m/s²; sliding, the block has what friction gives, 1 m/s²
            let right = match t {
                t if t > 0.1 && t < 0.3 - 1e-9 => [-10.0 * t, 0.05, 0.0, -10.0],
                t if t > 0.3 + 1e-9 && t < 0.4 - 1e-9 => [-3.0 + 0.5 * (t - 0.3), 0.05, 0.0, 0.5],
                t if t > 0.4 + 1e-3 => [-2.95 + 2.5 * (t - 0.4), 0.05 - 0.75 * (t - 0.4).powi(2), -1.5 * (t - 0.4), 1.0],
                _ => continue,
            };
            for (found, right) in [vs, x, v, friction + stop].into_iter().zip(right) {
                close(&what, found, right, 1e-7);
            }
            assert!(stop == 0.0 || t < 0.3 + 1e-9, "{what}");
        }
        assert!(drift(&outcome) < 1e-8, "{inertia}, {settings}: {}", drift(&outcome));
    }
}

/// A driver that reaches a stop ends the study there, with its rows up to it.
#[test]
fn a_driven_motion_ends_where_it_meets_a_stop() {
    for (kind, over) in [("inverse", "90 deg"), ("kinematics", "1 s"), ("kinematics", "-90 deg")] {
        let text = format!(
            "\
grashof: 1
name: past a stop
space: planar
gravity: none
bodies: {{ arm: {{ bar: {{ length: 1 m, mass: 1 kg }} }} }}
joints: {{ J: {{ revolute: [ground, arm.start], limits: {{ from: -80 deg, to: 80 deg, restitution: 0 }} }} }}
drivers: {{ d: {{ joint: J, speed: 90 deg/s }} }}
start: {{ J.angle: 0 deg }}
studies: {{ go: {{ {kind}: {{ over: {over}, samples: 7 }}, columns: [time, J.angle], scalars: {{ end: last(J.angle) }} }} }}
"
        );
        let outcome = tried(&text, "go").expect("rows up to the stop");
        let (sense, word) = if over.starts_with('-') { (-1.0, "lower stop at -80 deg") } else { (1.0, "upper stop at 80 deg") };
        let told = outcome.stopped.as_deref().expect("a reason");
        let place = if over == "1 s" { "at time = 0.888889 s".to_string() } else { format!("at J.angle = {} deg", 80.0 * sense) };
        assert!(told.starts_with(&place) && told.contains(word), "{told}");
        let row = last(&outcome);
        assert!((row[0] - sense * 80.0 / 90.0).abs() < 1e-9 && (row[1].to_degrees() - sense * 80.0).abs() < 1e-7, "{row:?}");
        assert!((outcome.scalars[0].to_degrees() - sense * 80.0).abs() < 1e-7);
    }
    // where it begins at the stop there is no motion
    let text = "\
grashof: 1
name: at a stop
space: planar
gravity: none
bodies: { arm: { bar: { length: 1 m, mass: 1 kg } } }
joints: { J: { revolute: [ground, arm.start], limits: { to: 80 deg, restitution: 0 } } }
drivers: { d: { joint: J, speed: 90 deg/s } }
start: { J.angle: 80 deg }
studies: { go: { kinematics: { over: 10 deg, samples: 7 }, columns: [J.angle] } }
";
    let told = tried(text, "go").expect_err("a refusal").reason();
    assert!(told.starts_with("at J.angle = 80 deg") && told.contains("upper stop at 80 deg"), "{told}");
}
