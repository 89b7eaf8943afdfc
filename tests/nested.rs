//! Switches of what other switches let jump: where one inside of another jumps onto its edge both change at one place, in whatever order they
//! are met.

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

/// A value of the angle of the bar, and its formula in the model.
type Value = (&'static str, fn(f64) -> f64);

fn tooth(x: f64) -> f64 {
    (6.0 * x).sin().rem_euclid(0.7)
}

/// From 0 up to 1 at 0.2, and down to 0 at 0.7.
fn peak(x: f64) -> f64 {
    if x < 0.2 { x / 0.2 } else { (0.7 - x) / 0.5 }
}

const VALUES: [Value; 13] = [
    ("mod(sin(6*A.angle), 0.7)", tooth),
    ("max(mod(sin(6*A.angle), 0.7), 0)", tooth),
    ("abs(mod(sin(6*A.angle), 0.7))", tooth),
    ("mod(mod(sin(6*A.angle), 0.7), 0.7)", tooth),
    ("floor(mod(sin(6*A.angle), 0.7)/0.35)", |x| if tooth(x) < 0.35 { 0.0 } else { 1.0 }),
    ("if(mod(sin(6*A.angle), 0.7) >= 0, 1, 2)", |_| 1.0),
    ("max(abs(sin(6*A.angle)), 0)", |x| (6.0 * x).sin().abs()),
    ("per(mod(sin(6*A.angle), 0.7))", |x| peak(tooth(x))),
    ("saw(mod(sin(6*A.angle), 0.7))", tooth),
    ("max(A.angle - floor(A.angle/0.1 rad)*0.1 rad, 0 rad)/1 rad", |x| x.rem_euclid(0.1)),
    // a jump puts exactly onto its value what is compared with it
    ("abs(if(sign(sin(6*A.angle)) == 1, -0.3, 1))", |x| if (6.0 * x).sin() > 0.0 { 0.3 } else { 1.0 }),
    ("max(if(floor(sin(6*A.angle)/0.6) == 1, sin(6*A.angle), 1), 0.7)", |x| {
        let s = (6.0 * x).sin();
        if s < 0.6 { 1.0 } else { s.max(0.7) }
    }),
    ("floor(if((sin(6*A.angle) > 0.4) == 1, sin(6*A.angle), 0.2)/0.5)", |x| if (6.0 * x).sin() < 0.5 { 0.0 } else { 1.0 }),
];

/// A bar that swings, or is driven, with all values as columns behind its angle; `kind` is that of the study.
fn swinging(load: &str, kind: &str) -> String {
    let driver = if kind.starts_with("dynamics") { "" } else { "drivers: { d: { joint: A, angle: 50 deg*cos(3 rad/s*t) } }\n" };
    let measures: Vec<String> = VALUES.iter().enumerate().map(|(k, (text, _))| format!("z{k}: \"{text}\"")).collect();
    let names: Vec<String> = (0..VALUES.len()).map(|k| format!("z{k}")).collect();
    let (measures, names) = (measures.join(", "), names.join(", "));
    format!(
        "grashof: 1
name: nested switches
space: planar
gravity: [9.81 m/s^2, 0]
tables:
  saw: {{ points: [[0, 0], [0.7, 0.7]], beyond: constant }}
  per: {{ points: [[0, 0], [0.2, 1], [0.7, 0]], beyond: periodic }}
bodies: {{ a: {{ bar: {{ length: 1 m, mass: 1 kg }} }} }}
joints: {{ A: {{ revolute: [ground, a.start] }} }}
start: {{ A.angle: 50 deg, A.omega: 0 rad/s }}
loads: {{ l: {{ joint: A, torque: \"{load}\" }} }}
{driver}measures: {{ {measures} }}
studies: {{ it: {{ {kind}, columns: [A.angle, {names}], scalars: {{ ending: last(A.angle) }} }} }}
"
    )
}

/// Holds the columns to their formulas at every row, on either side of a jump.
fn hold(outcome: &Outcome, what: &str) {
    assert!(outcome.findings.is_empty(), "{what}: {:?}", outcome.findings);
    assert!(outcome.rows.len() > 300, "{what}: {} rows", outcome.rows.len());
    for row in &outcome.rows {
        for (k, (text, value)) in VALUES.iter().enumerate() {
            let found = row[1 + k];
            let fits = [0.0, 1e-7, -1e-7].iter().any(|by| (value(row[0] + by) - found).abs() < 1e-5);
            assert!(fits, "{what}: {text} at {} is {found}, not {}", row[0], value(row[0]));
        }
    }
}

#[test]
fn columns_are_their_formulas_in_every_kind_of_study() {
    for kind in [
        "dynamics: { until: 4 s, every: 10 ms }",
        "dynamics: { until: 4 s, every: 10 ms, tolerance: 1e-5 }",
        "dynamics: { until: 4 s, every: 10 ms, integrator: radau5 }",
        "dynamics: { until: 4 s, every: 10 ms, integrator: bdf }",
        "kinematics: { over: 4 s, samples: 400 }",
        "kinematics: { over: 2.9 s, samples: 400 }",
        "inverse: { over: 4 s, samples: 400 }",
    ] {
        hold(&study(&swinging("0 N m", kind), "it", Coordinates::Joint), kind);
    }
}

#[test]
fn forces_are_those_of_formulas_without_nested_switches() {
    for (nested, plain) in [
        ("-3 N m*floor(mod(sin(6*A.angle), 0.7)/0.35)", "-3 N m*if(mod(sin(6*A.angle), 0.7) < 0.35, 0, 1)"),
        ("-10 N m/rad*max(A.angle - floor(A.angle/0.1 rad)*0.1 rad, 0 rad)", "-10 N m/rad*(A.angle - floor(A.angle/0.1 rad)*0.1 rad)"),
        ("-2 N m*abs(if(sign(sin(6*A.angle)) == 1, -0.3, 1))", "-2 N m*if(sin(6*A.angle) > 0, 0.3, 1)"),
        ("-2 N m*max(abs(sin(6*A.angle)), 0)", "-2 N m*abs(sin(6*A.angle))"),
    ] {
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let [nested_one, plain_one] =
                [nested, plain].map(|load| study(&swinging(load, "dynamics: { until: 4 s, every: 10 ms }"), "it", coordinates));
            hold(&nested_one, nested);
            let off = nested_one.scalars[0] - plain_one.scalars[0];
            assert!(off.abs() < 1e-5, "{nested}: {:?} for {:?}", nested_one.scalars, plain_one.scalars);
        }
    }
}

/// A function of nested switches crosses zero as often, and when, as the same one without them; one that only touches zero does not.
#[test]
fn events_are_those_of_formulas_without_nested_switches() {
    let events = "events:
  n1: { when: floor(z0/0.35) - 0.5 }
  p1: { when: \"if(z0 < 0.35, 0, 1) - 0.5\" }
  n2: { when: \"max(z0, 0) - 0.1\", crossing: rising }
  p2: { when: z0 - 0.1, crossing: rising }
  n3: { when: floor(z0/0.35) - 0.5, crossing: falling }
  p3: { when: \"if(z0 < 0.35, 0, 1) - 0.5\", crossing: falling }
  touches: { when: z0 }
studies:";
    for integrator in ["dop853", "radau5"] {
        let kind = format!("dynamics: {{ until: 4 s, every: 10 ms, integrator: {integrator} }}");
        let outcome = study(&swinging("0 N m", &kind).replace("studies:", events), "it", Coordinates::Joint);
        let times = |name: &str| outcome.events.iter().filter(|event| event.name == name).map(|event| event.at).collect::<Vec<_>>();
        for (nested, plain, least) in [("n1", "p1", 60), ("n2", "p2", 30), ("n3", "p3", 30)] {
            let (found, right) = (times(nested), times(plain));
            assert!(right.len() >= least && found.len() == right.len(), "{integrator}, {nested}: {} for {}", found.len(), right.len());
            assert!(found.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-6), "{integrator}, {nested}");
        }
        assert!(times("touches").is_empty(), "{integrator}: {:?}", times("touches"));
    }
}

/// The integral from 0 to 3 of a function that is constant between `edges`, which rise from 0.
fn of_steps(f: impl Fn(f64) -> f64, edges: impl Iterator<Item = f64>) -> f64 {
    let edges: Vec<f64> = edges.take_while(|edge| *edge < 3.0).chain([3.0]).collect();
    edges.windows(2).map(|pair| f(0.5 * (pair[0] + pair[1])) * (pair[1] - pair[0])).sum()
}

/// Forces that jump with time alone, some of whose switches jump exactly onto zero, and the velocity of 1 kg after 3 s.
#[test]
fn what_jumps_onto_zero_with_time_alone_is_met() {
    let pi = std::f64::consts::PI;
    // cos(2 t + 0.7) is positive before `down`, and behind `up`
    let (down, up) = ((pi / 2.0 - 0.7) / 2.0, (3.0 * pi / 2.0 - 0.7) / 2.0);
    // 3 t² is at the angles where 2 cos is 1, 0 or −1 at these times
    let of_cosine = of_steps(|t| 1.0 + (2.0 * (3.0 * t * t).cos()).floor(), (0..).map(|k| (f64::from(k) * pi / 18.0).sqrt()));
    for (force, right) in [
        ("if(mod(floor(t/1 s), 2) > 0.5, 1 N, 0 N)", 1.0),
        ("if(hypot(if(t < 2 s, 3, 0), if(t < 2 s, 4, 0)) > 2, 1 N, 0 N)", 2.0),
        ("if(hypot(if(t < 1 s, 0, 3), if(t < 1 s, 0, 4)) > 2, 1 N, 0 N)", 2.0),
        ("if(sqrt(2 - min(floor(t/1 s), 2)) > 0.5, 1 N, 0 N)", 2.0),
        ("if((2 - min(floor(t/1 s), 2))^0.5 > 0.5, 1 N, 0 N)", 2.0),
        ("if(log(4 - floor(t/1 s)) > 0.8, 1 N, 0 N)", 2.0),
        // just below 2 from the start on, which shows much later
        ("(1 + floor(2*cos(3*(t/1 s)^2)))*1 N", of_cosine),
        ("abs(if(sign(cos(2 rad/s*t + 0.7)) == 1, -0.3, 1))*1 N", 0.3 * (3.0 - up + down) + (up - down)),
    ] {
        for integrator in ["dop853", "radau5", "bdf"] {
            let text = format!(
                "grashof: 1
name: force that jumps
space: planar
gravity: none
bodies: {{ b: {{ mass: 1 kg }} }}
joints: {{ X: {{ slider: [ground, b.origin], axis: [1, 0] }} }}
loads: {{ push: {{ joint: X, force: \"{force}\" }} }}
start: {{ X.position: 0 m, X.velocity: 0 m/s }}
studies: {{ it: {{ dynamics: {{ until: 3 s, integrator: {integrator} }}, scalars: {{ v: last(X.velocity) }} }} }}
"
            );
            let found = study(&text, "it", Coordinates::Joint).scalars[0];
            assert!((found - right).abs() < 1e-8, "{integrator}: {force}: {found} for {right}");
        }
    }
}

/// A condition that a jump makes true and what the jump lets come to rest makes false again: neither is seen, and both belong to one event.
#[test]
fn what_comes_to_rest_takes_back_within_the_event() {
    let text = "grashof: 1
name: there and back
space: planar
gravity: none
bodies: { b: { mass: 1 kg } }
joints: { X: { slider: [ground, b.origin], axis: [1, 0] } }
measures:
  gate: if(sin(6 rad/m*X.position) > 0.4, 1, 0)
  held: if(gate - if(gate == 1, 1, 0) > 0.5, 5, 2)
loads: { push: { joint: X, force: held*1 N } }
start: { X.position: 0 m, X.velocity: 0 m/s }
studies: { it: { dynamics: { until: 1 s }, columns: [held], scalars: { v: last(X.velocity) } } }
";
    let outcome = study(text, "it", Coordinates::Joint);
    assert!((outcome.scalars[0] - 2.0).abs() < 1e-9, "{:?}", outcome.scalars);
    assert!(outcome.rows.iter().all(|row| row[0] == 2.0), "{:?}", outcome.rows);
    // at asin(0.4)/6 and (π − asin(0.4))/6 m
    assert_eq!(outcome.certificate.march.expect("a motion in time").counts.events, 2);
}
