//! Starts in change points whose branches are surfaces that cannot be named one by one: `check` counts beside them, and they are told.

use crate::common::{model, study};
use grashof::kinematics::survey::{Survey, survey};
use grashof::mechanism::Coordinates;
use grashof::studies::common::case::parameters;

/// Four bars of 1 m between two pivots `apart` m from each other, laid flat: the last one folds back where 2 m are left.
fn five_bar(apart: f64) -> String {
    format!(
        "grashof: 1
name: five-bar
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ A: [0, 0], E: [{apart} m, 0] }}
bodies:
  a: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  b: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  c: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  d: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
joints:
  A: {{ revolute: [ground.A, a.start] }}
  B: {{ revolute: [a.end, b.start] }}
  C: {{ revolute: [b.end, c.start] }}
  D: {{ revolute: [c.end, d.start] }}
  E: {{ revolute: [d.end, ground.E] }}
start: {{ a.angle: 0 deg, b.angle: 0 deg, c.angle: ~0 deg, d.angle: ~{} deg }}
studies:
  fall: {{ dynamics: {{ until: 0.1 s, every: 0.1 s }}, columns: [a.angle] }}
",
        if apart < 3.0 { 180 } else { 0 }
    )
}

fn surveyed(text: &str) -> Survey {
    let model = model(text, None);
    survey(&model, &parameters(&model)).unwrap_or_else(|failure| panic!("{}", failure.reason()))
}

#[test]
fn a_flat_linkage_has_the_freedom_that_it_has_beside() {
    let text = five_bar(2.0);
    let found = surveyed(&text);
    assert_eq!((found.mobility.freedom, found.mobility.left, found.mobility.redundant.len()), (2, 2, 0));
    let words = "leave 3 motions in it, but 2 motions beside it";
    assert!(found.findings.iter().any(|f| f.code == "change-point" && f.message.contains(words)), "{:?}", found.findings);
    let told = study(&text, "fall", Coordinates::Joint).findings;
    assert!(told.iter().any(|f| f.code == "change-point" && f.message.contains(words)), "{told:?}");
    // a little beside
    let beside = text.replace("a.angle: 0 deg", "a.angle: 1 deg");
    assert!(study(&beside, "fall", Coordinates::Joint).findings.iter().all(|f| f.code != "change-point"));
}

/// Bars that reach just from pivot to pivot can only yield a little: no branch leads away.
#[test]
fn a_straight_linkage_without_motions_is_no_change_point() {
    let found = surveyed(&five_bar(4.0));
    assert_eq!((found.mobility.freedom, found.mobility.redundant.len()), (3, 1));
    assert!(found.findings.iter().all(|f| f.code != "change-point"), "{:?}", found.findings);
}

/// The same beside a pendulum that moves freely, and is so long that little counts as closed.
#[test]
fn a_straight_linkage_beside_a_long_pendulum_is_no_change_point() {
    for length in [1.0, 0.3, 0.1, 0.01] {
        let text = format!(
            "grashof: 1
name: straight
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ A: [0, 0], E: [{} m, 0], P: [0, 5 m] }}
bodies:
  a: {{ bar: {{ length: {length} m, mass: 1 kg }} }}
  b: {{ bar: {{ length: {length} m, mass: 1 kg }} }}
  p: {{ bar: {{ length: 20 m, mass: 1 kg }} }}
joints:
  A: {{ revolute: [ground.A, a.start] }}
  B: {{ revolute: [a.end, b.start] }}
  E: {{ revolute: [b.end, ground.E] }}
  P: {{ revolute: [ground.P, p.start] }}
start: {{ a.angle: ~0 deg, b.angle: ~0 deg, P.angle: ~-90 deg }}
",
            2.0 * length
        );
        let found = surveyed(&text);
        assert_eq!(found.mobility.freedom, 2, "{length}");
        assert!(found.findings.iter().all(|f| f.code != "change-point"), "{length}: {:?}", found.findings);
    }
}
