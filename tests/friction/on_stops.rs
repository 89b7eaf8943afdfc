//! What rests on stops beside friction and one-way clutches is decided together: by balances of forces, and by the laws of contact.

use super::{close, done, last, march};

const COORDINATES: [&str; 3] = ["joint", "cartesian", "minimal"];

/// A ball in a box that friction holds, on the box's stop; loads in N, and the restitution of the stop.
fn box_and_ball([push, load, rise]: [f64; 3], restitution: f64, coordinates: &str) -> String {
    format!(
        "grashof: 1
name: ball in a box
space: planar
gravity: none
bodies: {{ box: {{ mass: 2 kg }}, ball: {{ mass: 1 kg }} }}
joints:
  B: {{ slider: [ground, box.origin], axis: [1, 0], friction: {{ coulomb: 3 N }} }}
  R: {{ slider: [box.origin, ball.origin], axis: [1, 0], limits: {{ to: 0.5 m, restitution: {restitution} }} }}
loads:
  push: {{ at: box.origin, force: [{push} N, 0] }}
  load: {{ at: ball.origin, force: [{load} N + {rise} N/s*t, 0] }}
start: {{ B.position: 0 m, B.velocity: 0 m/s, R.position: 0.5 m, R.velocity: 0 m/s }}
studies:
  d:
    dynamics: {{ until: 2 s, every: 50 ms, tolerance: 1e-10, coordinates: {coordinates} }}
    columns: [time, B.friction, R.stop, B.acceleration, B.position, B.velocity]
"
    )
}

#[test]
fn friction_holds_what_rests_on_a_stop_of_what_it_holds() {
    for coordinates in COORDINATES {
        let outcome = done(&box_and_ball([2.0, 0.05, 0.0], 0.0, coordinates), "d");
        assert!(outcome.findings.is_empty() && outcome.rows.len() == 41, "{:?}", outcome.findings);
        for row in outcome.rows.iter() {
            for (name, found, right) in [("friction", row[1], -2.05), ("stop", row[2], -0.05), ("acceleration", row[3], 0.0)] {
                close(name, found, right, 1e-12);
            }
        }
    }
}

#[test]
fn a_load_that_rises_moves_both_once_friction_is_overcome() {
    for restitution in [0.0, 0.5, 1.0] {
        for coordinates in COORDINATES {
            // 1 N and 2 N/s t from 1 s on are more than 3 N: (3 kg) a = 2 N/s (t - 1 s)
            let outcome = done(&box_and_ball([1.0, 0.0, 2.0], restitution, coordinates), "d");
            let row = last(&outcome);
            close("position", row[4], 1.0 / 9.0, 1e-9);
            close("velocity", row[5], 1.0 / 3.0, 1e-9);
            close("stop", row[2], -(4.0 - 2.0 / 3.0), 1e-8);
        }
    }
}

#[test]
fn a_pendulum_on_a_stop_of_a_cart_that_friction_holds() {
    for (push, torque) in [(-20.0, -0.01), (-20.0, -0.0003), (20.0, -0.01)] {
        let text = format!(
            "grashof: 1
name: pendulum on a stop of its cart
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ cart: {{ mass: 5 kg }}, bob: {{ bar: {{ length: 0.5 m, mass: 1 kg }} }} }}
joints:
  C: {{ slider: [ground, cart.origin], axis: [1, 0], friction: {{ coulomb: 30 N }} }}
  P: {{ revolute: [cart.origin, bob.start], limits: {{ from: -90 deg, restitution: 0 }} }}
loads: {{ push: {{ joint: C, force: {push} N }}, hold: {{ joint: P, torque: {torque} N m }} }}
start: {{ C.position: 0 m, P.angle: -90 deg }}
studies: {{ d: {{ dynamics: {{ until: 2 s, every: 50 ms }}, columns: [C.friction, P.stop, C.acceleration] }} }}
"
        );
        let outcome = done(&text, "d");
        for row in outcome.rows.iter() {
            close("friction", row[0], -push, 1e-10);
            close("stop", row[1], -torque, 1e-10);
            close("acceleration", row[2], 0.0, 1e-12);
        }
    }
}

#[test]
fn a_one_way_clutch_rests_on_a_stop() {
    for coordinates in COORDINATES {
        for integrator in ["dop853", "radau5", "bdf"] {
            let text = format!(
                "grashof: 1
name: clutch against a stop
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 3 kg }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0] }}
  B: {{ slider: [ground, b.origin], axis: [1, 0], limits: {{ from: 0 m, restitution: 0 }} }}
clutches: {{ W: {{ between: [B, A], one_way: true }} }}
loads: {{ fa: {{ joint: A, force: -3 N }}, fb: {{ joint: B, force: 2 N }} }}
start: {{ A.position: 0 m, B.position: 0 m, A.velocity: 0 m/s, B.velocity: 0 m/s }}
studies:
  d:
    dynamics: {{ until: 1 s, every: 0.1 s, integrator: {integrator}, coordinates: {coordinates} }}
    columns: [A.acceleration, B.acceleration, B.stop, W.force]
"
            );
            let outcome = done(&text, "d");
            for row in outcome.rows.iter() {
                for (found, right) in row.iter().zip([0.0, 0.0, 1.0, 3.0]) {
                    close(integrator, *found, right, 1e-12);
                }
            }
        }
    }
}

#[test]
fn a_stop_takes_over_what_friction_cannot_hold() {
    // a clutch that carries to one side, a mass on a stop, one with friction 3 N, and a load that rises to 4 N
    let text = "grashof: 1
name: two masses on a one-way link
space: planar
gravity: none
bodies: { a: { mass: 1 kg }, b: { mass: 2 kg } }
joints:
  A: { slider: [ground, a.origin], axis: [1, 0], limits: { from: 0 m, restitution: 0 } }
  B: { slider: [ground, b.origin], axis: [1, 0], friction: { coulomb: 3 N } }
clutches: { W: { between: [A, B], one_way: true } }
loads: { f: { joint: B, force: -2 N*t/1 s } }
start: { A.position: 0 m, A.velocity: 0 m/s, B.position: 0.2 m, B.velocity: 0 m/s }
studies:
  d: { dynamics: { until: 2 s, every: 50 ms }, columns: [A.position, B.position, A.stop, B.friction, W.force] }
";
    let outcome = done(text, "d");
    for row in outcome.rows.iter() {
        close("a", row[0], 0.0, 1e-8);
        close("b", row[1], 0.2, 1e-8);
    }
    let row = last(&outcome);
    close("stop and friction", row[2] + row[3], 4.0, 1e-9);
    assert!(row[2] >= 1.0 - 1e-9 && row[3] <= 3.0 + 1e-9, "{row:?}");
}

#[test]
fn weak_blows_against_what_friction_holds_come_to_rest() {
    let text = "grashof: 1
name: weak blows
space: planar
gravity: none
bodies: { a: { mass: 1.879 kg }, b: { mass: 1.404 kg } }
joints:
  A: { slider: [ground, a.origin], axis: [1, 0], friction: { coulomb: 3.054 N }, limits: { from: -0.34 m, to: 0.456 m, restitution: 1 } }
  B: { slider: [a.origin, b.origin], axis: [1, 0], limits: { from: -0.499 m, to: 0.542 m, restitution: 1 } }
springs:
  s: { stretch: a.x, rest: 0.033 m, stiffness: 21.389 N/m, damping: 0.299 N s/m }
  r: { stretch: b.x, rest: 0.078 m, stiffness: 13.787 N/m, damping: 0.23 N s/m }
loads:
  f: { at: a.origin, force: [5.55 N*sin(1.356/1 s*t + 4.413) - 0.214 N, 0] }
  g: { at: b.origin, force: [3.348 N*sin(7.637/1 s*t + 1.208) - 1.469 N, 0] }
start: { A.position: -0.34 m, A.velocity: 0 m/s, B.position: 0.542 m, B.velocity: 0 m/s }
studies: { d: { dynamics: { until: 2 s, every: 50 ms, tolerance: 1e-9 }, columns: [A.position, B.position] } }
";
    let outcome = done(text, "d");
    assert!(march(&outcome).energy_drift < 1e-6 && outcome.switches.len() < 40, "{} switches", outcome.switches.len());
}

/// Random numbers of a seed, between 0 and 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// Masses in rows, each with friction and a stop, let go from rest: what is told of the first instant obeys the laws of contact.
#[test]
fn rows_of_masses_on_stops_obey_the_laws_of_contact() {
    let mut seed = 7;
    for _ in 0..120 {
        let mut text = [(); 3].map(|()| String::new());
        let (mut start, mut columns, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..3 {
            let mut between = |low: f64, high: f64| low + (high - low) * random(&mut seed);
            let (mass, force, cap) = (between(0.5, 3.0), between(-3.0, 3.0), between(0.05, 4.0));
            let base = (i > 0 && between(0.0, 1.0) < 0.7).then(|| i - 1);
            let lower = between(0.0, 1.0) < 0.5;
            // a third of the stops are far away
            let touched = between(0.0, 1.0) < 0.67;
            let at = if touched {
                0.0
            } else if lower {
                -1.0
            } else {
                1.0
            };
            let (end, on) = (if lower { "from" } else { "to" }, base.map_or("ground".to_owned(), |base: usize| format!("b{base}.origin")));
            text[0] += &format!("  b{i}: {{ mass: {mass} kg }}\n");
            let (friction, limits) = (format!("friction: {{ coulomb: {cap} N }}"), format!("limits: {{ {end}: {at} m, restitution: 0 }}"));
            text[1] += &format!("  J{i}: {{ slider: [{on}, b{i}.origin], axis: [1, 0], {friction}, {limits} }}\n");
            text[2] += &format!("  f{i}: {{ at: b{i}.origin, force: [{force} N, 0] }}\n");
            start.push(format!("J{i}.position: 0 m, J{i}.velocity: 0 m/s"));
            columns.push(format!("b{i}.ax, J{i}.acceleration, J{i}.friction, J{i}.stop"));
            bodies.push((mass, force, cap, base, if lower { 1.0 } else { -1.0 }, touched));
        }
        let ([masses, joints, loads], start, columns) = (text, start.join(", "), columns.join(", "));
        let outcome = done(
            &format!(
                "grashof: 1
name: masses on stops
space: planar
gravity: none
bodies:
{masses}joints:
{joints}loads:
{loads}start: {{ {start} }}
studies:
  d: {{ dynamics: {{ until: 20 ms, every: 10 ms }}, columns: [{columns}] }}
"
            ),
            "d",
        );
        let row = &outcome.rows[0];
        let exerted = |i: usize| row[4 * i + 2] + row[4 * i + 3];
        for (i, &(mass, force, cap, _, sense, touched)) in bodies.iter().enumerate() {
            let [a, relative, friction, stop] = [0, 1, 2, 3].map(|k| row[4 * i + k]);
            let on_others: f64 = (0..3).filter(|k| bodies[*k].3 == Some(i)).map(exerted).sum();
            close("balance of forces", mass * a, force + exerted(i) - on_others, 1e-9);
            assert!(sense * stop >= 0.0 && (touched || stop == 0.0), "a stop pulls: {joints}{loads}");
            assert!(!touched || sense * relative > -1e-9, "a mass moves into its stop: {joints}{loads}");
            assert!(stop.abs() < 1e-9 || relative.abs() < 1e-9, "a stop pushes from afar: {joints}{loads}");
            assert!(friction.abs() <= cap * (1.0 + 1e-9), "too much friction: {joints}{loads}");
            let slides = relative.abs() > 1e-9;
            assert!(!slides || (friction + cap * relative.signum()).abs() < 1e-9, "friction pushes along: {joints}{loads}");
        }
    }
}

/// Two hinges: A with friction, B pressed on its rigid stop until a load grows over it.
fn arm(friction: &str, load: &str, start: &str, settings: &str) -> String {
    format!(
        "grashof: 1
name: arm
space: planar
gravity: [3 m/s^2, 0]
parameters: {{ c: {load} N m/s }}
bodies:
  a: {{ mass: 1 kg, com: [-0.3 m, 0], inertia: 0.1 kg m^2, points: {{ P: [-0.5 m, -0.5 m] }} }}
  b: {{ mass: 1 kg, com: [0.3 m, 0.3 m], inertia: 0.1 kg m^2 }}
joints:
  A: {{ revolute: [ground, a.origin], limits: {{ from: 0 rad, restitution: 0 }}{friction} }}
  B: {{ revolute: [a.P, b.origin], limits: {{ from: 0 rad, restitution: 0 }} }}
loads: {{ l: {{ joint: B, torque: -5 N m + c*t }}, k: {{ joint: A, torque: -10 N m }} }}
start: {{ A.angle: {start}, B.angle: 0 rad }}
studies:
  d:
    dynamics: {{ until: 0.8 s, every: 0.1 s, tolerance: 1e-10, {settings} }}
    columns: [time, A.angle, B.angle, B.omega]
"
    )
}

#[test]
fn friction_of_what_a_stop_holds_keeps_no_other_joint_on_its_own_stop() {
    // A stands on its stop all the time, with friction or without it, and B lifts off where its stop carries nothing
    let mut lifted = 0;
    for load in ["8.1", "9.25", "10", "11.3", "12"] {
        let [rough, smooth] =
            [", friction: { coulomb: 1 N m }", ""].map(|friction| last(&done(&arm(friction, load, "0 rad", ""), "d")).to_vec());
        for (rough, smooth) in rough.iter().zip(&smooth) {
            assert!((rough - smooth).abs() < 1e-7, "{load}: {rough} {smooth}");
        }
        lifted += usize::from(smooth[2] > 1e-3);
    }
    assert!(lifted >= 4, "{lifted}");
}

#[test]
fn friction_of_what_slides_keeps_no_other_joint_on_its_stop() {
    // A slides clear of its stop, in coordinates in which round-off is another one
    for load in ["9.1", "10", "11.7"] {
        let of =
            |settings: &str| last(&done(&arm(", friction: { coulomb: 1 N m }", load, "1.2 rad, A.omega: 3 rad/s", settings), "d")).to_vec();
        let (joint, cartesian) = (of(""), of("coordinates: cartesian"));
        for (joint, cartesian) in joint.iter().zip(&cartesian) {
            assert!((joint - cartesian).abs() < 1e-6, "{load}: {joint} {cartesian}");
        }
        assert!(joint[2] > 1e-3, "{load}: {joint:?}");
    }
}
