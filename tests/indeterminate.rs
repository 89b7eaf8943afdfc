//! Reactions that rigid bodies leave open are told as such, and no others: those that differ between coordinates.

use crate::common::{model, study};
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

/// Names of the reactions of joints.
fn components(joints: &[&str], planar: bool) -> Vec<String> {
    let axes: &[&str] = if planar { &["fx", "fy", "m"] } else { &["fx", "fy", "fz", "mx", "my", "mz"] };
    joints.iter().flat_map(|joint| axes.iter().map(move |axis| format!("{joint}.{axis}"))).collect()
}

fn told(outcome: &Outcome) -> usize {
    outcome.findings.iter().filter(|f| f.code == "reactions-not-unique").count()
}

/// Holds what is told of each component against its values in three studies, and both against what is `open`.
fn holds(text: &str, joints: &[&str], planar: bool, open: &dyn Fn(&str) -> bool) {
    for component in components(joints, planar) {
        let studies: String = ["joint", "cartesian"]
            .map(|c| format!("  {c}: {{ dynamics: {{ until: 1 us, every: 1 us, coordinates: {c} }}, columns: [time, {component}] }}\n"))
            .concat();
        let text = format!("{text}studies:\n{studies}  rest: {{ statics: {{ from: start }}, scalars: {{ of: last({component}) }} }}\n");
        let outcomes = ["joint", "cartesian"].map(|name| study(&text, name, Coordinates::Joint));
        let [a, b] = [&outcomes[0], &outcomes[1]].map(|outcome| outcome.rows[0][1]);
        for outcome in &outcomes {
            assert_eq!(told(outcome), usize::from(open(&component)), "{component}: {:?}\n{text}", outcome.findings);
        }
        if !open(&component) {
            assert!((a - b).abs() < 1e-6 * (1.0 + a.abs()), "{component} is {a} and {b}\n{text}");
        }
    }
}

const HELD: &str = "grashof: 1
name: bar fixed at both ends
space: planar
gravity: [0, -10 m/s^2]
ground: { E: [1, 0] }
bodies: { b: { bar: { length: 1 m, mass: 1 kg }, attached: { w: { at: end, mass: 2 kg } } }, c: { bar: { length: 1 m, mass: 1 kg } } }
joints:
  L: { fixed: [ground, b.start] }
  R: { fixed: [ground.E, b.end] }
  H: { revolute: [b.end, c.start] }
start: { H.angle: 0 deg }
";

#[test]
fn what_a_bar_fixed_at_both_ends_bears_is_open() {
    holds(HELD, &["L", "R", "H"], true, &|component| !component.starts_with('H'));
    let text = format!("{HELD}studies: {{ s: {{ statics: {{ from: start }}, columns: [L.fy, R.m] }} }}\n");
    let outcome = study(&text, "s", Coordinates::Joint);
    assert!(
        outcome.findings.iter().any(|f| f.code == "reactions-not-unique" && f.message.contains("`L.fy`, `R.m`:")),
        "{:?}",
        outcome.findings
    );
}

/// A four-bar in space, its hinges along z; the last of them, or the last two, of another kind.
fn four_bar(last: [&str; 2]) -> String {
    format!(
        "grashof: 1
name: four-bar in space
space: spatial
gravity: [0, -10 m/s^2, -3 m/s^2]
ground: {{ O: [0, 0, 0], C: [30 cm, 0, 0] }}
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: 1 kg, width: 1 cm, height: 2 cm }} }}
  coupler: {{ bar: {{ length: 30 cm, mass: 1 kg, width: 1 cm, height: 2 cm }} }}
  rocker: {{ bar: {{ length: 25 cm, mass: 1 kg, width: 1 cm, height: 2 cm }} }}
joints:
  O: {{ revolute: [ground.O, crank.start], axis: [0, 0, 1] }}
  A: {{ revolute: [crank.end, coupler.start], axis: [0, 0, 1] }}
  B: {{ {}: [coupler.end, rocker.end]{} }}
  C: {{ revolute: [ground.C, rocker.start], axis: [0, 0, 1] }}
start: {{ O.angle: 40 deg, A.angle: ~-10 deg, C.angle: ~70 deg }}
",
        last[0], last[1]
    )
}

#[test]
fn a_planar_four_bar_in_space_leaves_open_what_acts_across_its_plane() {
    let across = |component: &str| ["fz", "mx", "my"].iter().any(|axis| component.ends_with(axis));
    holds(&four_bar(["revolute", ", axis: [0, 0, 1]"]), &["O", "A", "B", "C"], false, &across);
    // with one ball a force across goes around the loop all the same
    let free = four_bar(["spherical", ""]);
    let rows = |text: &str| {
        let text = format!("{text}studies: {{ s: {{ dynamics: {{ until: 1 us }}, columns: [C.fz, O.mx, B.fz] }} }}\n");
        assert!(model(&text, Some("s")).study.is_some());
        told(&study(&text, "s", Coordinates::Joint))
    };
    assert_eq!([rows(&free), rows(&four_bar(["revolute", ", axis: [0, 0, 1]"]))], [1, 1]);
    // a cross and a ball at the ends of the coupler leave the loop free
    let hinge = "A: { revolute: [crank.end, coupler.start], axis: [0, 0, 1] }";
    let cross = "A: { universal: [crank.end, coupler.start], axes: [[0, 0, 1], [0, 1, 0]] }";
    let loose = free.replace(hinge, cross).replace("A.angle: ~-10 deg, ", "");
    assert_eq!(rows(&loose), 0);
}
