//! Forces of every kind at rest: motors, states, stops, tables, switches, loads without an energy, friction.

use super::{all_are, findings, list, near, planar, sorted};

const G: f64 = 9.81;

/// A bar of 1 m and 2 kg on a hinge.
const ARM: &str = "bodies: { arm: { bar: { length: 1 m, mass: 2 kg } } }\njoints: { P: { revolute: [ground, arm.start] } }";

/// A mass of 2 kg on a vertical slider.
const LIFT: &str = "bodies: { box: { mass: 2 kg } }\njoints: { S: { slider: [ground, box.origin], axis: [0, 1] } }";

const DOWN: &str = "[0, -9.81 m/s^2]";

#[test]
fn a_motor_has_its_torque_at_rest() {
    let outcome = planar(
        DOWN,
        &format!(
            "{ARM}\ntables: {{ curve: {{ points: [[-10 rad/s, 0.9 N m], [0 rad/s, 0.6 N m], [10 rad/s, 0 N m]] }} }}\nmotors: {{ motor: {{ joint: P, curve: curve, gear: 8 }} }}\nstart: {{ P.angle: -80 deg }}"
        ),
        "torque: last(motor.torque)",
    );
    // 8 · 0.6 N m = m g l/2 cos φ
    near(outcome.scalars[0], 4.8, 1e-14);
    let phi = (4.8 / (2.0 * G * 0.5)).acos();
    near(list(&outcome, "equilibria.P.angle")[0], -phi, 1e-12);
    all_are(&sorted(&outcome, "P.angle"), &[(-phi, 1.0), (phi, 0.0)], 1e-11);
}

#[test]
fn states_come_to_rest_with_the_position() {
    // the state follows the height, and pushes: at rest 100 N/m · y·(1/2) + m g = 0 with its own rate 3 (y/m − 2 level)
    let outcome = planar(
        DOWN,
        &format!(
            "{LIFT}
states:
  level: {{ start: 5, rate: 3 1/s*(S.position/1 m - 2*level) }}
  clock: {{ start: 1 s, rate: 1 + 0*t/1 s }}
loads: {{ push: {{ joint: S, force: -100 N*level }} }}
start: {{ S.position: 1 m }}"
        )
        .replace("3 1/s", "(3/1 s)"),
        "end: last(level), y: last(box.y)",
    );
    let y = -2.0 * G / 50.0;
    near(outcome.scalars[1], y, 1e-12);
    near(outcome.scalars[0], 0.5 * y, 1e-12);
    // a spring that lags behind drives the motion: 2 s² (s + 6) + 300 = 0 has roots with a positive real part (Routh: 6 · 0 < 150)
    assert_eq!(outcome.results, [0.0]);
    let drifting = findings(&outcome, "state-without-rest");
    assert_eq!(drifting, ["the state `clock` does not come to rest, its rate is 1"]);
}

#[test]
fn an_integrating_controller_moves_the_mechanism_until_it_rests() {
    // gravity as 10 m/s² makes 5 N m cos φ; K = −5 N m sin φ, J = 1/3 kg m², d = 2 N m s; J s³ + d s² + (K + kp) s + ki
    let held = |target: f64, kp: f64, ki: f64| {
        planar(
            "[0, -10 m/s^2]",
            &format!(
                "bodies: {{ arm: {{ bar: {{ length: 1 m, mass: 1 kg }} }} }}
joints: {{ P: {{ revolute: [ground, arm.start], damping: 2 N m s/rad }} }}
states:
  clock: {{ start: 0 s, rate: 1 + 0*t/1 s }}
  record: {{ start: 1 rad s, rate: P.angle + 1 rad }}
  z: {{ start: 0 N m, rate: -({ki} N m/s)*(P.angle - ({target} deg)) }}
loads: {{ hold: {{ joint: P, torque: z - ({kp} N m)*(P.angle - ({target} deg)) }} }}
start: {{ P.angle: 60 deg }}"
            ),
            "angle: last(P.angle), push: last(z)",
        )
    };
    for (target, kp, ki, stable) in [(80.0, 30.0, 20.0, 1.0), (80.0, 0.0, 20.0, 0.0), (-80.0, 0.0, 20.0, 1.0), (-80.0, 0.0, 40.0, 0.0)] {
        let outcome = held(target, kp, ki);
        let phi: f64 = target.to_radians();
        near(outcome.scalars[0], phi, 1e-12);
        near(outcome.scalars[1], 5.0 * phi.cos(), 1e-11);
        assert_eq!(outcome.results, [stable], "{target} deg, {kp}, {ki}");
        assert_eq!(list(&outcome, "equilibria.P.angle").len(), 1);
        let drifting = findings(&outcome, "state-without-rest");
        assert_eq!(drifting.len(), 2, "{drifting:?}");
        assert!(drifting.iter().all(|f| f.contains("`clock`") || f.contains("`record`")), "{drifting:?}");
    }
}

#[test]
fn a_controller_alone_finds_the_place_at_which_nothing_acts() {
    // m s³ + (m/τ) s² + k has roots with a positive real part, with and without the leak 1/τ of the integrator
    for leak in ["", " - z/(1 s)"] {
        let outcome = planar(
            "[0, 0]",
            &format!(
                "{LIFT}\nstates: {{ z: {{ start: 3 N, rate: -(4 N/m/s)*(S.position - 0.5 m){leak} }} }}\nloads: {{ push: {{ joint: S, force: z }} }}\nstart: {{ S.position: 2 m }}"
            ),
            "y: last(box.y), push: last(z)",
        );
        near(outcome.scalars[0], 0.5, 1e-12);
        near(outcome.scalars[1], 0.0, 1e-12);
        assert_eq!(outcome.results, [0.0]);
    }
}

#[test]
fn what_falls_rests_on_a_stop() {
    // begins 3 m above the floor where nothing holds it
    let floor = planar(
        DOWN,
        &format!(
            "{}\nstart: {{ S.position: 3 m }}",
            LIFT.replace("axis: [0, 1]", "axis: [0, 1], limits: { from: 0.5 m, stiffness: 4000 N/m, damping: 50 N s/m }")
        ),
        "y: last(box.y)",
    );
    near(floor.scalars[0], 0.5 - 2.0 * G / 4000.0, 1e-12);
    assert_eq!(floor.results, [1.0]);
    // the same by a load with a condition, and a spring by a table
    let by_load = planar(
        DOWN,
        &format!(
            "{LIFT}\nloads: {{ floor: {{ joint: S, force: \"if(S.position < 0.5 m, 4000 N/m*(0.5 m - S.position), 0 N)\" }} }}\nstart: {{ S.position: 3 m }}"
        ),
        "y: last(box.y)",
    );
    near(by_load.scalars[0], 0.5 - 2.0 * G / 4000.0, 1e-12);
    let by_table = planar(
        DOWN,
        &format!(
            "{LIFT}\ntables: {{ bumper: {{ points: [[-20 mm, -400 N], [-10 mm, -10 N], [0 mm, 0 N], [50 mm, 0 N]], beyond: linear }} }}\nsprings: {{ s: {{ joint: S, force: bumper, rest: 1 m }} }}\nstart: {{ S.position: 1.3 m }}"
        ),
        "y: last(box.y)",
    );
    // in the second segment: −10 N − 390 N (x + 10 mm)/(−10 mm) = −m g
    near(by_table.scalars[0], 1.0 - 0.010 - 0.010 * (2.0 * G - 10.0) / 390.0, 1e-12);
}

#[test]
fn a_load_that_follows_has_no_energy() {
    // two rods with torsion springs, a load along the second rod: the straight pose is an equilibrium for every load, and no other is
    let outcome = planar(
        "none",
        "bodies: { a: { bar: { length: 1 m, mass: 1 kg } }, b: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, a.start] }, Q: { revolute: [a.end, b.start] } }
springs: { p: { joint: P, stiffness: 10 N m/rad }, q: { joint: Q, stiffness: 10 N m/rad } }
loads: { push: { at: b.end, force: [-15 N, 0], frame: b } }
start: { P.angle: 10 deg, Q.angle: -20 deg }",
        "",
    );
    near(list(&outcome, "equilibria.P.angle")[0], 0.0, 1e-12);
    near(list(&outcome, "equilibria.Q.angle")[0], 0.0, 1e-12);
    assert_eq!(outcome.results, [1.0]);
    assert_eq!(findings(&outcome, "no-energy").len(), 1);
    // a load of fixed direction has one
    let fixed = planar("none", &format!("{ARM}\nloads: {{ push: {{ at: arm.end, force: [0, 15 N] }} }}\nstart: {{ P.angle: 10 deg }}"), "");
    assert!(findings(&fixed, "no-energy").is_empty());
    near(list(&fixed, "equilibria.P.angle")[0], std::f64::consts::FRAC_PI_2, 1e-12);
}

#[test]
fn friction_and_dampers_hold_nothing() {
    let outcome = planar(
        DOWN,
        "bodies: { arm: { bar: { length: 1 m, mass: 2 kg } } }
joints: { P: { revolute: [ground, arm.start], damping: 30 N m s/rad, friction: { coulomb: 20 N m, stick_speed: 1e-3 rad/s } } }
start: { P.angle: -60 deg }",
        "",
    );
    near(list(&outcome, "equilibria.P.angle")[0], -std::f64::consts::FRAC_PI_2, 1e-12);
    assert_eq!(
        findings(&outcome, "friction"),
        ["the friction of joint `P` holds nothing here: with it the mechanism also rests beside this position"]
    );
}

#[test]
fn what_nothing_holds_is_indifferent() {
    let outcome = planar("none", &format!("{LIFT}\nstart: {{ S.position: 0.3 m }}"), "y: last(box.y)");
    assert_eq!(outcome.scalars[0], 0.3);
    assert_eq!(findings(&outcome, "equilibrium"), ["S.position = 0.3 m: indifferent, nothing holds `S.position`"]);
    assert_eq!(outcome.results, [0.0]);
    // a body that floats between two springs may still turn about their line
    let floating = planar(
        "none",
        "ground: { A: [0, 0], B: [3 m, 0] }
bodies: { ball: { ball: { radius: 10 cm, mass: 1 kg } } }
springs: { a: { between: [ground.A, ball.origin], stiffness: 10 N/m, length: 1 m }, b: { between: [ground.B, ball.origin], stiffness: 20 N/m, length: 1 m } }
start: { ball.x: 2 m, ball.y: 0.1 m }",
        "x: last(ball.x), y: last(ball.y)",
    );
    // 10 (x − 1) = 20 (3 − x − 1)
    near(floating.scalars[0], 5.0 / 3.0, 1e-11);
    near(floating.scalars[1], 0.0, 1e-11);
    assert_eq!(
        findings(&floating, "equilibrium"),
        ["ball.x = 1.66667 m, ball.y = 0 m, ball.angle = 0 deg: indifferent, nothing holds `ball.angle`"]
    );
}

#[test]
fn masses_do_not_matter_where_only_springs_pull() {
    let of = |mass: &str| {
        planar(
            "none",
            &format!(
                "ground: {{ A: [0, 0], B: [2 m, 0.5 m] }}
bodies: {{ a: {{ bar: {{ length: 1 m{mass} }} }}, b: {{ bar: {{ length: 1 m{mass} }} }} }}
joints: {{ P: {{ revolute: [ground.A, a.start] }}, Q: {{ revolute: [a.end, b.start] }} }}
springs: {{ s: {{ between: [b.end, ground.B], stiffness: 100 N/m, length: 0.2 m }}, u: {{ joint: Q, stiffness: 3 N m/rad, rest: 40 deg }} }}
start: {{ P.angle: 20 deg, Q.angle: 30 deg }}"
            ),
            "p: last(P.angle), q: last(Q.angle)",
        )
        .scalars
    };
    let (light, heavy, none) = (of(", mass: 1e-3 kg"), of(", mass: 7 kg"), of(""));
    for i in 0..2 {
        near(light[i], heavy[i], 1e-10);
        near(none[i], heavy[i], 1e-10);
    }
}

/// An inverted pendulum that feedback holds is stable, and one that it drives is not: by the linearised motion.
#[test]
fn stability_with_states_and_velocities_is_that_of_the_motion() {
    // stiffness 20 − 9.81 N m with a damping of 3 N m s behind a lag of 10 ms; then too little stiffness; then damping that drives
    for (gain, damping, stable) in [("20 N m", "3 N m s", 1.0), ("3 N m", "3 N m s", 0.0), ("20 N m", "-1 N m s", 0.0)] {
        let outcome = planar(
            DOWN,
            &format!(
                "{ARM}\nstates: {{ motor: {{ start: 0 N m, rate: \"(-({gain})*(P.angle - 90 deg) - ({damping})*P.omega - motor)/10 ms\" }} }}\nloads: {{ drive: {{ joint: P, torque: motor }} }}\nstart: {{ P.angle: 90 deg }}"
            ),
            "none: 0",
        );
        let upright = sorted(&outcome, "P.angle").into_iter().find(|(angle, _)| (angle - 0.5 * std::f64::consts::PI).abs() < 1e-9);
        assert_eq!(upright.map(|(_, stable)| stable), Some(stable), "{gain}, {damping}: {:?}", outcome.findings);
    }
}

#[test]
fn what_has_no_friction_is_not_held_by_it() {
    // the start is the equilibrium to the last bit
    let text = "bodies: { p: { mass: 1 kg } }\njoints: { P: { slider: [ground, p.origin], axis: [1, 0] } }\nsprings: { s: { joint: P, stiffness: 1 N/m } }\nstart: { P.position: 0 m }";
    let outcome = planar("none", text, "");
    assert_eq!(findings(&outcome, "held-by-friction"), [""; 0]);
    assert_eq!(sorted(&outcome, "P.position"), [(0.0, 1.0)]);
}
