//! Clutches, brakes, springs between the turning of two hinges, and cylinders, in the scene and as signs.

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::output::{Link, LinkKind as Sign};
use grashof::results::scene::{ArrowKind, LinkKind};

/// Two wheels, the second at `at`, with what is between them; the link in the scene, and as it is drawn.
fn drawn(at: &str, between: &str, slides: bool) -> (grashof::results::scene::Link, Link) {
    let (first, rate) = if slides {
        ("slider: [ground.A, left.origin], axis: [1, 0]", "velocity: 0 m/s")
    } else {
        ("revolute: [ground.A, left.origin]", "omega: 0 rad/s")
    };
    let text = format!(
        "grashof: 1
name: held
space: planar
gravity: none
ground: {{ A: [0, 0], B: {at} }}
bodies: {{ left: {{ disc: {{ radius: 20 cm, mass: 1 kg }} }}, right: {{ disc: {{ radius: 20 cm, mass: 1 kg }} }} }}
joints: {{ A: {{ {first} }}, B: {{ revolute: [right.origin, ground.B] }} }}
{between}
start: {{ A.{rate}, B.omega: 0 rad/s }}
studies: {{ it: {{ dynamics: {{ until: 10 ms, every: 10 ms }}, columns: [time] }} }}
"
    );
    let (_, scene) = study(&text, "it", Coordinates::Joint).scenes.remove(0);
    let sign = grashof::output::drawing("held", "it", "mechanism", &scene).links.remove(0);
    (scene.links[0].clone(), sign)
}

#[test]
fn clutches_brakes_and_shafts_have_a_place() {
    let clutch = "clutches: { it: { between: [A, B], torque: 1 N m } }";
    let shaft = "springs: { it: { stretch: A.angle + B.angle, stiffness: 1 N m/rad } }";
    for (at, between, kind, sign) in [
        ("[1 m, 0]", clutch, LinkKind::Clutch, Sign::Clutch),
        ("[0, 0]", clutch, LinkKind::Clutch, Sign::Clutch),
        ("[1 m, 0]", shaft, LinkKind::Shaft, Sign::Shaft),
        ("[0, 0]", shaft, LinkKind::Torsion, Sign::Torsion),
    ] {
        let (link, seen) = drawn(at, between, false);
        assert_eq!((link.kind, seen.kind), (kind, sign));
        // both ends are on what turns, whichever body the model names first
        assert_eq!((link.a.body, link.b.body), (1, 2));
        let [[from, _], [to, _]] = seen.poses[0];
        assert_eq!((from, to), (0.0, if at == "[0, 0]" { 0.0 } else { 1.0 }));
    }
    let (brake, seen) = drawn("[1 m, 0]", "clutches: { it: { joint: A, torque: 1 N m } }", false);
    assert_eq!((brake.kind, seen.kind, seen.poses[0]), (LinkKind::Brake, Sign::Brake, [[0.0; 2]; 2]));
    // along the slide, so that its direction is seen
    let (shoe, seen) = drawn("[1 m, 0]", "clutches: { it: { joint: A, force: 1 N } }", true);
    let [from, to] = seen.poses[0];
    assert!(shoe.kind == LinkKind::Brake && from[0] < -0.01 && from[1] == 0.0 && to == [0.0; 2], "{from:?} {to:?}");
}

/// What a cylinder does to the body that it moves is drawn with the reactions: with them and the weight it is m a.
#[test]
fn the_force_of_a_cylinder_is_an_arrow_along_it() {
    for zero in ["{} - (1.3 m + 0.3 m*sin(2 rad/s*t))", "1.3 m + 0.3 m*sin(2 rad/s*t) - {}"] {
        let zero = zero.replace("{}", "sqrt((arm.end.x - 0.2 m)^2 + (arm.end.y + 1 m)^2)");
        let text = format!(
            "grashof: 1
name: luffing
space: planar
gravity: [0, -9.81]
bodies: {{ arm: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ O: {{ revolute: [ground, arm.start] }} }}
couplings: {{ cylinder: {{ zero: \"{zero}\" }} }}
start: {{ O.angle: ~20 deg }}
studies:
  it:
    inverse: {{ over: 2 s, samples: 24 }}
    columns: [time, O.fx, O.fy, com.ax, com.ay, cylinder.force]
    show: [reactions]
"
        );
        let results = super::results_of(&text, "it");
        let (_, scene) = &results.scenes[0];
        let column = |name: &str, row: usize| results.table.column(name).expect(name).values[row];
        let arrow = scene.arrows.iter().find(|arrow| arrow.name == "cylinder").expect("an arrow");
        assert_eq!((arrow.kind, arrow.body), (ArrowKind::Reaction, 1));
        let mut compared = 0;
        for row in 0..results.independent.values.len() {
            let t = column("time", row);
            let Some(index) = scene.frames.at.iter().position(|at| (at - t).abs() < 1e-9) else { continue };
            let force = &arrow.values[2 * index..2 * index + 2];
            let weight = 2.0 * 9.81;
            let off = [
                column("O.fx", row) + force[0] - 2.0 * column("com.ax", row),
                column("O.fy", row) + force[1] - weight - 2.0 * column("com.ay", row),
            ];
            assert!(off.iter().all(|x| x.abs() < 1e-5), "{zero} at {t}: {off:?}");
            assert!((force[0].hypot(force[1]) - column("cylinder.force", row).abs()).abs() < 1e-9);
            compared += 1;
        }
        assert!(compared > 5, "{compared} of {:?}", scene.frames.at);
    }
}
