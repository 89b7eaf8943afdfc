//! Wheels whose carriers are welded to each other run on each other as on one carrier.

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::results::scene::{Gear, GearKind};

/// Two wheels at (0, 0) and (1, 1), the second on a carrier whose own point (0.5, 0) is there.
fn gears(space: &str, carried: bool, coupling: &str) -> Vec<Gear> {
    let [z, axis] = if space == "spatial" { [", 0", ", axis: [0, 0, 1]"] } else { ["", ""] };
    let (on, housing) = if carried {
        ("housing.P", "  F: { fixed: [stand.Q, housing.P] }\n  G: { fixed: [ground.Q, stand.Q] }\n".to_string())
    } else {
        ("ground.Q", String::new())
    };
    let bodies = if carried {
        format!(
            "  stand: {{ mass: 1 kg, inertia: 1 kg m^2, points: {{ Q: [2 m, 0{z}] }} }}\n  housing: {{ mass: 1 kg, inertia: 1 kg m^2, points: {{ P: [0.5 m, 0{z}] }} }}\n"
        )
    } else {
        String::new()
    };
    let text = format!(
        "grashof: 1
name: housed
space: {space}
gravity: none
ground: {{ O: [0, 0{z}], Q: [1 m, 1 m{z}] }}
bodies:
{bodies}  wheel: {{ mass: 1 kg, inertia: 1 kg m^2 }}
  other: {{ mass: 1 kg, inertia: 1 kg m^2 }}
joints:
{housing}  S: {{ revolute: [ground.O, wheel.origin]{axis} }}
  T: {{ {kind}: [{on}, other.origin]{along} }}
couplings: {{ mesh: {{ {coupling} }} }}
drivers: {{ drive: {{ joint: S, speed: 1 rad/s }} }}
studies: {{ turn: {{ kinematics: {{ over: 0.5 turn, samples: 10 }} }} }}
",
        kind = if coupling.contains("gear") { "revolute" } else { "slider" },
        along = if coupling.contains("gear") { axis.to_string() } else { format!(", axis: [1, 0{z}]") },
    );
    study(&text, "turn", Coordinates::Joint).scenes.remove(0).1.gears
}

#[test]
fn wheels_on_welded_carriers_are_those_on_one() {
    for space in ["planar", "spatial"] {
        for (coupling, kind) in [
            ("gear: [S, T], ratio: -0.5", GearKind::Teeth),
            ("gear: [S, T], ratio: 0.5", GearKind::Belt),
            ("rack: [S, T], radius: 0.2 m", GearKind::Rack),
            ("rope: [S, T], radius: 0.2 m", GearKind::Rope),
        ] {
            let [alone, carried] = [false, true].map(|carried| gears(space, carried, coupling));
            let ([alone], [carried]) = (&alone[..], &carried[..]) else { panic!("{space}, {coupling}: {alone:?} {carried:?}") };
            assert_eq!(carried.kind, kind);
            for (a, b) in [(&alone.a, &carried.a), (&alone.b, &carried.b)] {
                let near = |x: &[f64], y: &[f64]| x.len() == y.len() && x.iter().zip(y).all(|(x, y)| (x - y).abs() < 1e-9);
                assert!(
                    (a.radius - b.radius).abs() < 1e-9 && near(&a.at, &b.at) && near(&a.axis, &b.axis),
                    "{space}, {coupling}: {a:?} {b:?}"
                );
            }
        }
    }
}
