//! Pictures of modes: arrows from rest to the shape that is drawn strongly.

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::output::{Move, drawing};
use grashof::results::Scene;
use std::f64::consts::PI;

/// A small mass on the rim of the disc.
const RIM: &str = ", points: { rim: [0.1 m, 0, 0] }, attached: { m: { mass: 0.01 kg, at: rim } }";

/// A pendulum and a disc on a torsion spring, which do not know of each other; the pendulum swings slower.
fn two(spatial: bool, attached: &str) -> String {
    let (space, zero, axis, size) = match spatial {
        true => ("spatial", ", 0", ", axis: [0, 0, 1]", ", thickness: 2 cm"),
        false => ("planar", "", "", ""),
    };
    format!(
        "grashof: 1
name: two
space: {space}
gravity: [0, -9.81{zero}]
ground: {{ W: [2 m, 0{zero}] }}
bodies:
  pole: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  rotor: {{ disc: {{ radius: 0.1 m, mass: 1 kg{size} }}{attached} }}
joints:
  A: {{ revolute: [ground, pole.start]{axis} }}
  W: {{ revolute: [ground.W, rotor.origin]{axis} }}
springs: {{ s: {{ joint: W, stiffness: 1 N m/rad, rest: 0 }} }}
start: {{ A.angle: -90 deg, W.angle: 0 }}
studies: {{ it: {{ modes: {{ at: start }} }} }}
"
    )
}

/// The scenes of both modes, the slower one first, and what arrows tell in them.
fn moved(spatial: bool, attached: &str) -> [(Scene, Vec<Move>); 2] {
    let scenes = common::study(&two(spatial, attached), "it", Coordinates::Joint).scenes;
    let mut all = scenes.into_iter().map(|(name, scene)| {
        let moves = drawing("two", "it", &name, &scene).moves;
        (scene, moves)
    });
    [all.next().unwrap(), all.next().unwrap()]
}

/// What is across of two directions.
fn cross([u, v]: [[f64; 2]; 2]) -> f64 {
    u[0] * v[1] - u[1] * v[0]
}

fn near(found: [f64; 2], right: [f64; 2]) {
    assert!((0..2).all(|i| (found[i] - right[i]).abs() < 1e-9), "{found:?} {right:?}");
}

#[test]
fn an_arrow_leads_from_the_tip_of_a_pendulum_at_rest_and_one_goes_round_a_rotor() {
    let [(swing, _), (turn, _)] = moved(false, "");
    for phase in [0.5 * PI, 1.5 * PI] {
        // the angle of a body and what arrows tell where the swing is in this phase
        let at = |scene: &Scene, body: usize| {
            let scene = Scene { at: Some(phase), ..scene.clone() };
            (scene.frames.at(phase, 2)[3 * (body - 1) + 2], drawing("two", "it", "mode", &scene).moves)
        };
        let (angle, moves) = at(&swing, 1);
        let &[Move::Shift { from, to }] = &moves[..] else { panic!("{moves:?}") };
        assert!((angle + 0.5 * PI).abs() > 0.01, "{angle}");
        near(from, [0.0, -1.0]);
        near(to, [angle.cos(), angle.sin()]);
        let (angle, moves) = at(&turn, 2);
        let &[Move::Turn { at, across }] = &moves[..] else { panic!("{moves:?}") };
        near(at, [2.0, 0.0]);
        assert_eq!(cross(across), angle.signum());
    }
}

#[test]
fn arrows_in_space_are_those_of_the_plane_seen_from_elsewhere() {
    let [(_, of_swing), (scene, round)] = moved(true, "");
    assert!(matches!(of_swing[..], [Move::Shift { .. }]), "{of_swing:?}");
    // what goes round goes as a point on its rim does
    let [_, (rim, _)] = moved(true, RIM);
    let quarter = scene.frames.at[scene.frames.shown[0]];
    for phase in [quarter, quarter + PI] {
        let moves = |scene: &Scene| drawing("two", "it", "mode", &Scene { at: Some(phase), ..scene.clone() }).moves;
        let (round, rim) = (moves(&scene), moves(&rim));
        let (&[Move::Turn { at, across }], &[Move::Shift { from, to }]) = (&round[..], &rim[..]) else { panic!("{round:?} {rim:?}") };
        let off = |p: [f64; 2]| [p[0] - at[0], p[1] - at[1]];
        assert_eq!(cross(across).signum(), cross([off(from), off(to)]).signum());
    }
    assert_eq!(round.len(), 1);
}
