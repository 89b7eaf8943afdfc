//! Couplings by expressions that switch: T = f(S) on the side of the switch on which S is, in every kind of study.

mod efforts;
mod turning;

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

/// A function of the way x (m), as text and as it is.
type Law = (&'static str, fn(f64) -> f64);

/// Each with kinks between −3 and 3 and none at the tenths that the tests look at.
const LAWS: [Law; 7] = [
    ("abs(x - 0.05 m)", |x| (x - 0.05).abs()),
    ("clamp(x, -1.05 m, 1.05 m)", |x| x.clamp(-1.05, 1.05)),
    ("if(x < -1.05 m, -1.05 m, if(x < 1.05 m, x, 1.05 m))", |x| x.clamp(-1.05, 1.05)),
    ("if(abs(x) < 1.05 m, x, 1.05 m*sign(x))", |x| x.clamp(-1.05, 1.05)),
    ("max(0.5*x + 0.01 m, min(2*x, 0.17 m))", |x| (0.5 * x + 0.01).max((2.0 * x).min(0.17))),
    ("1 m*linear(x/1 m)", |x| if x < 1.05 { 0.0 } else { (x - 1.05).min(1.0) }),
    // not-a-knot through (−3, 9), (−1, 1), (0.05, 0.0025), (1, 1), (3, 9): the parabola itself
    ("1 m*parabola(x/1 m)", |x| x * x),
];

const TABLES: &str = "
tables:
  linear: { points: [[-4, 0], [1.05, 0], [2.05, 1], [4, 1]] }
  parabola: { points: [[-4, 16], [-1, 1], [0.05, 0.0025], [1, 1], [4, 16]], between: cubic }";

/// Two sliders, T = f(S), with a spring of 100 N/m on T.
fn model(law: &str, more: &str, studies: &str) -> String {
    let law = law.replace('x', "S.position").replace("maS.position", "max");
    let t = if law.contains("if(") { format!("\"T.position - {law}\"") } else { format!("\"T.position - ({law})\"") };
    format!(
        "grashof: 1
name: a piecewise coupling
space: planar
gravity: none{TABLES}
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 2 kg }} }}
joints:
  S: {{ slider: [ground, a.origin], axis: [1, 0] }}
  T: {{ slider: [ground, b.origin], axis: [0, 1] }}
couplings: {{ c: {{ zero: {t} }} }}
springs: {{ k: {{ joint: T, stiffness: 100 N/m }} }}
{more}
studies: {{ {studies} }}
"
    )
}

fn study(text: &str, name: &str) -> Outcome {
    common::study(text, name, Coordinates::Joint)
}

/// Column `k` of a row.
fn entry(outcome: &Outcome, row: usize, k: usize) -> f64 {
    outcome.rows[row][k]
}

#[test]
fn a_start_is_kept_on_its_side_of_the_switch() {
    for (text, law) in LAWS {
        for start in [-2.7, -0.4, 0.3, 2.6] {
            let more = format!("start: {{ S.position: {start} m, S.velocity: 0.1 m/s }}");
            let text = model(text, &more, "d: { dynamics: { until: 1 ms, every: 1 ms }, columns: [S.position, S.velocity, T.position] }");
            let found = study(&text, "d");
            let [s, v, t] = [0, 1, 2].map(|k| entry(&found, 0, k));
            assert!((s - start).abs() < 1e-14 && (v - 0.1).abs() < 1e-14 && (t - law(start)).abs() < 1e-12, "{text}\n{s} {v} {t}");
        }
    }
}

#[test]
fn a_driver_passes_every_switch() {
    for (text, law) in LAWS {
        let more = "drivers: { d: { joint: S, speed: 1 m/s } }\nstart: { S.position: -2.9 m }";
        let text = model(text, more, "k: { kinematics: { over: 5.8 m, samples: 58 }, columns: [S.position, T.position, T.velocity] }");
        let found = study(&text, "k");
        assert!((entry(&found, found.rows.len() - 1, 0) - 2.9).abs() < 1e-12, "{text}");
        for row in &found.rows {
            assert!((row[1] - law(row[0])).abs() < 1e-12, "{text}\n{row:?} {}", law(row[0]));
        }
        // away from switches the velocity is the slope
        for row in found.rows.iter().filter(|row| (row[0] * 10.0 - (row[0] * 10.0).round()).abs() < 1e-9) {
            let slope = (law(row[0] + 1e-6) - law(row[0] - 1e-6)) / 2e-6;
            assert!((row[2] - slope).abs() < 1e-8, "{text}\n{row:?} {slope}");
        }
    }
}

#[test]
fn held_forces_and_vibrations_are_those_of_the_side() {
    for (text, law) in LAWS {
        for place in [-2.7, -0.4, 0.3, 2.6] {
            let slope = (law(place + 1e-6) - law(place - 1e-6)) / 2e-6;
            let bend = (law(place + 1e-4) - 2.0 * law(place) + law(place - 1e-4)) / 1e-8;
            let more = format!("drivers: {{ h: {{ joint: S, position: {place} m }} }}\nstart: {{ S.position: {place} m }}");
            let held = study(&model(text, &more, "rest: { statics: { from: start }, columns: [T.position, h.force] }"), "rest");
            let force = 100.0 * law(place) * slope;
            assert!((entry(&held, 0, 0) - law(place)).abs() < 1e-12 && (entry(&held, 0, 1) - force).abs() < 1e-6, "{text} {place}");
            // M = 1 + 2 f'², K = 100 (f'² + f f'')
            let more = format!("start: {{ S.position: {place} m }}");
            let modes = study(&model(text, &more, "m: { modes: { at: start } }"), "m");
            let list = &modes.lists.iter().find(|l| l.name == "eigenvalues").expect("eigenvalues").values;
            let exact = 100.0 * (slope * slope + law(place) * bend) / (1.0 + 2.0 * slope * slope);
            assert!((list[0] - exact).abs() < 1e-4 * (1.0 + exact.abs()), "{text} {place}: {list:?} {exact}");
        }
    }
}

/// A driver law that switches at the start is on the side of the start.
#[test]
fn a_driver_law_begins_on_its_side() {
    let more = "drivers: { d: { joint: S, position: \"if(t < -1 s, 5 m, 0.1 m + 1 m/s*t)\" } }\nstart: { S.position: 0.1 m }";
    let text = model("abs(x)", more, "k: { kinematics: { over: 1 s, samples: 4 }, columns: [S.position, T.position] }");
    let found = study(&text, "k");
    assert!((entry(&found, 4, 0) - 1.1).abs() < 1e-12 && (entry(&found, 4, 1) - 1.1).abs() < 1e-12);
}
