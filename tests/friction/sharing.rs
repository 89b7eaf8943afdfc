//! Several contacts that hold one motion at rest: what they hold together, and what each of them is said to carry.

use super::{close, done, last};

/// A bar of 1 m and 2 kg that a bearing and a brake hold level: its weight asks for 10 N m.
fn braked(bearing: f64, brake: f64, load: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: parking brake beside the friction of a bearing
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ A: {{ revolute: [ground, a.start], friction: {{ coulomb: {bearing} N m }} }} }}
clutches: {{ brake: {{ joint: A, torque: {brake} N m }} }}
loads: {{ push: {{ joint: A, torque: {load} }} }}
start: {{ A.angle: 0 deg }}
studies: {{ rest: {{ {study}, columns: [A.angle, A.friction, brake.torque] }} }}
"
    )
}

#[test]
fn what_two_contacts_hold_together_stays_where_it_is_put() {
    let statics = "statics: { from: start }";
    for (bearing, brake) in [(6.0, 6.0), (6.0, 4.5), (1.0, 9.5), (100.0, 0.1), (0.1, 100.0)] {
        for study in [statics, "dynamics: { until: 1 s }"] {
            let outcome = done(&braked(bearing, brake, "0 N m", study), "rest");
            let [angle, friction, torque] = *last(&outcome) else { panic!("three columns") };
            let what = format!("{bearing} and {brake} N m, {study}");
            close(&what, angle, 0.0, 1e-12);
            close(&what, friction + torque, 10.0, 1e-8);
            assert!(friction.abs() <= bearing + 1e-8 && torque.abs() <= brake + 1e-8, "{what}: {friction} and {torque}");
            assert!(outcome.findings.iter().any(|f| f.code == "friction-not-unique"), "{what}");
        }
    }
    // one that is not needed carries nothing
    let outcome = done(&braked(6.0, 6.0, "9.5 N m", statics), "rest");
    close("one is enough", last(&outcome)[1].abs().min(last(&outcome)[2].abs()), 0.0, 1e-12);
    // 9.9 N m are too little
    for study in [statics, "dynamics: { until: 1 s }"] {
        let outcome = done(&braked(5.0, 4.9, "0 N m", study), "rest");
        assert!(last(&outcome)[0] < -0.01, "{study}");
    }
}

/// A ladder whose ends slide on the floor and on the wall against constant friction F and H rests up to cos θ (W/2 − H) = F sin θ.
#[test]
fn the_region_of_a_ladder_is_that_of_both_frictions() {
    let text = |floor: f64, wall: f64| {
        format!(
            "grashof: 1
name: ladder
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ foot: {{ mass: 0 }}, head: {{ mass: 0 }}, ladder: {{ bar: {{ length: 4 m, mass: 20 kg }} }} }}
joints:
  F: {{ slider: [ground, foot.origin], axis: [1, 0], friction: {{ coulomb: {floor} N }} }}
  H: {{ slider: [ground, head.origin], axis: [0, 1], friction: {{ coulomb: {wall} N }} }}
  a: {{ revolute: [foot.origin, ladder.start] }}
  b: {{ revolute: [head.origin, ladder.end] }}
start: {{ F.position: -1.5 m, H.position: ~3.7 m, ladder.angle: ~68 deg }}
studies: {{ rest: {{ statics: {{ from: start }}, columns: [F.position, F.friction, H.friction] }} }}
"
        )
    };
    for (floor, wall) in [(60.0_f64, 0.001_f64), (60.0, 60.0), (25.0, 40.0), (200.0, 5.0)] {
        let outcome = done(&text(floor, wall), "rest");
        let tells = |f: &&grashof::results::Finding| f.code == "held-by-friction";
        let message = &outcome.findings.iter().find(tells).unwrap_or_else(|| panic!("{floor} and {wall}: no region")).message;
        let ends: Vec<f64> = message.split(" m").filter_map(|part| part.rsplit("= ").next()?.trim().parse().ok()).collect();
        assert!(ends.len() == 2, "{message}");
        close(&format!("{floor} and {wall}"), last(&outcome)[0], -1.5, 1e-9);
        assert!(last(&outcome)[1].abs() <= floor * (1.0 + 1e-8) && last(&outcome)[2].abs() <= wall * (1.0 + 1e-8));
        for x in ends {
            let angle = (x.abs() / 4.0).acos();
            close(&format!("{floor} and {wall}: {message}"), angle.cos() * (100.0 - wall), floor * angle.sin(), 1e-3);
        }
    }
}

/// Discs on one shaft: their inertias, kg m², the torques on them and their speeds at the start; clutches in words.
fn discs(inertias: &[f64], torques: &[&str], speeds: &[f64], clutches: &str) -> String {
    let names = &["A", "B", "C", "D"][..inertias.len()];
    let each = |of: &dyn Fn(usize, &str) -> String| names.iter().enumerate().map(|(k, name)| of(k, name)).collect::<Vec<_>>().join(", ");
    format!(
        "grashof: 1
name: discs
space: planar
gravity: none
bodies: {{ {} }}
joints: {{ {} }}
clutches: {{ {clutches} }}
loads: {{ {} }}
start: {{ {} }}
studies:
  it:
    dynamics: {{ until: 6 s, every: 0.1 s }}
    columns: [{}]
",
        each(&|k, name| format!("{}: {{ mass: 1 kg, inertia: {} kg m^2 }}", name.to_lowercase(), inertias[k])),
        each(&|_, name| format!("{name}: {{ revolute: [ground.origin, {}.origin] }}", name.to_lowercase())),
        each(&|k, name| format!("on_{name}: {{ joint: {name}, torque: \"{}\" }}", torques[k])),
        each(&|k, name| format!("{name}.angle: 0 rad, {name}.omega: {} rad/s", speeds[k])),
        each(&|_, name| format!("{name}.omega")),
    )
}

/// Where one-way clutches beside each other open at the same instant, what they share with friction clutches, or with each other, does not
/// close those again that carry nothing: the motion is that without the clutches that are not needed.
#[test]
fn one_way_clutches_open_beside_what_shares_their_load() {
    let (one, other, third) =
        ("c0: { between: [A, B], one_way: true }", "c1: { between: [A, B], one_way: true }", ", c2: { between: [A, B], torque: 2 N m }");
    let needed = "c1: { between: [A, C], one_way: true }, c2: { between: [B, D], one_way: true }, c3: { between: [A, B], one_way: true }";
    let (fourth, none) = ("c0: { between: [A, D], one_way: true }", "0 N m");
    let cases = [
        (
            [2.0, 2.0].to_vec(),
            ["10 N m*cos(2 rad/s*t)", none].to_vec(),
            [1.0, 1.0].to_vec(),
            [format!("{one}, {other}{third}"), format!("{one}{third}")],
        ),
        (
            [1.0, 2.0].to_vec(),
            ["10 N m*sin(2 rad/s*t)", "3 N m*cos(2 rad/s*t)"].to_vec(),
            [0.0, 1.0].to_vec(),
            [format!("{one}, {other}{third}"), format!("{one}{third}")],
        ),
        (
            [2.0, 2.0, 1.0, 2.0].to_vec(),
            ["1 N m*sin(1 rad/s*t)", none, none, "1 N m*cos(2 rad/s*t)"].to_vec(),
            [1.0; 4].to_vec(),
            [format!("{fourth}, {needed}"), needed.to_owned()],
        ),
    ];
    for (inertias, torques, speeds, clutches) in cases {
        let [all, needed] = clutches.map(|clutches| done(&discs(&inertias, &torques, &speeds, &clutches), "it"));
        let slips = all.rows.iter().map(|row| row[1] - row[0]).fold(0.0, f64::max);
        assert!(slips > 0.1, "a clutch opens: {slips}");
        for (name, (found, right)) in ["A", "B", "C", "D"].iter().zip(last(&all).iter().zip(last(&needed))) {
            close(name, *found, *right, 1e-6);
        }
    }
}

/// Rates of a driven mechanism are known from its constraints, better than the continuous solution of an implicit scheme is: friction reverses
/// once all the same.
#[test]
fn friction_of_a_driven_linkage_reverses_by_all_integrators() {
    let linkage = |coordinates: &str, integrator: &str, tolerance: &str| {
        format!(
            "grashof: 1
name: friction at a reversal
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ O: [0, 0], C: [0.3229 m, 0.02 m] }}
bodies:
  crank: {{ bar: {{ length: 0.0742 m, mass: 0.87 kg }} }}
  coupler: {{ bar: {{ length: 0.2699 m, mass: 0.742 kg }} }}
  rocker: {{ bar: {{ length: 0.2984 m, mass: 0.769 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end], friction: {{ coulomb: 0.2 N m, static: 0.4 N m, stribeck_speed: 0.5 rad/s }} }}
  C: {{ revolute: [ground.C, rocker.start] }}
drivers: {{ d: {{ joint: O, angle: 4.208 rad/s*t + 0.144 rad*sin(4.104 rad/s*t) }} }}
start: {{ coupler.angle: ~54.3 deg, rocker.angle: ~100 deg }}
studies:
  it:
    dynamics: {{ until: 1.5 s, every: 50 ms, tolerance: {tolerance}, coordinates: {coordinates}, integrator: {integrator} }}
    scalars: {{ w: integral(d.power) }}
"
        )
    };
    let right = done(&linkage("joint", "dop853", "1e-12"), "it").scalars[0];
    for (coordinates, tolerance) in
        [("joint", "1e-8"), ("joint", "1e-10"), ("cartesian", "1e-8"), ("cartesian", "1e-10"), ("minimal", "1e-9")]
    {
        for integrator in ["radau5", "bdf"] {
            let found = done(&linkage(coordinates, integrator, tolerance), "it").scalars[0];
            close(coordinates, found, right, 1e-5);
        }
    }
}
