//! Wheels with teeth, racks, ropes, cylinders: what is drawn of couplings.

use super::scenes;
use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::output::{Drawing, FormKind, drawing};
use grashof::results::Scene;
use grashof::results::scene::{Gear, GearKind, LinkKind, Place, Shape, Wheel};
use std::f64::consts::{PI, TAU};

const GEARS: &str = "grashof: 1
name: gears
space: planar
gravity: none
ground: { O: [0, 0], P: [0.3 m, 0] , W: [0, -0.1 m] }
bodies:
  sun: { disc: { radius: 0.1 m } }
  wheel: { disc: { radius: 0.2 m } }
  arm: { bar: { length: 0.3 m } }
  bar: { plate: { size: [1 m, 0.02 m] } }
joints:
  S: { revolute: [ground.O, sun] }
  Q: { revolute: [ground.P, wheel] }
  W: { slider: [ground.W, bar], axis: [1, 0] }
couplings:
  mesh: { gear: [S, Q], ratio: -0.5 }
  rack: { rack: [S, W], radius: -0.1 m }
drivers: { drive: { joint: S, speed: 1 rad/s } }
studies: { turn: { kinematics: { over: 1 turn, samples: 10 } } }
";

#[test]
fn pitch_circles_follow_from_the_ratio() {
    let text = GEARS.replace("  arm: { bar: { length: 0.3 m } }\n", "");
    let outcome = study(&text, "turn", Coordinates::Joint);
    let scene = &outcome.scenes[0].1;
    let [mesh, rack] = &scene.gears[..] else { panic!("{:?}", scene.gears) };
    assert!((mesh.a.radius - 0.1).abs() < 1e-12 && (mesh.b.radius - 0.2).abs() < 1e-12, "{mesh:?}");
    let touched = scene.world(scene.frame(0), &Place { body: rack.b.body, at: rack.b.at.clone() });
    assert!(rack.kind == GearKind::Rack && (rack.a.radius - 0.1).abs() < 1e-12, "{rack:?}");
    // the lowest point of a wheel that turns counter-clockwise moves to the right: with a radius below 0 the rack moves to the left
    assert!((touched[0]).abs() < 1e-12 && (touched[1] - 0.1).abs() < 1e-12, "{touched:?}");
}

#[test]
fn a_wheel_with_inner_teeth_is_no_disc() {
    let (_, scene) = scenes("planetary_gear", "turn").remove(0);
    let inner = scene.gears.iter().flat_map(|gear| [&gear.a, &gear.b]).find(|wheel| wheel.radius < 0.0).expect("the ring");
    let discs = |body: usize| scene.bodies[body].shapes.iter().filter(|shape| matches!(shape, Shape::Disc { .. })).count();
    assert_eq!((scene.bodies[inner.body].name.as_str(), discs(inner.body)), ("ring", 0));
    // lengths are shown in the unit that the model asks for
    assert_eq!(scene.length.map(|length| (length.unit, length.size)), Some(("mm".into(), 1e-3)));
}

#[test]
fn a_rope_ends_at_what_it_moves() {
    let racked = GEARS.replace("  arm: { bar: { length: 0.3 m } }\n", "");
    let text = racked.replace("rack: { rack: [S, W], radius: -0.1 m }", "rope: { rope: [S, W], radius: -0.1 m }");
    let outcome = study(&text, "turn", Coordinates::Joint);
    let scene = &outcome.scenes[0].1;
    let [_, rope] = &scene.gears[..] else { panic!("{:?}", scene.gears) };
    assert!(rope.kind == GearKind::Rope && (rope.a.radius - 0.1).abs() < 1e-12, "{rope:?}");
    assert_eq!((&rope.b.at, &rope.b.axis), (&vec![0.0, 0.0], &vec![-1.0, 0.0]));
    // it moves as a rack does
    let rack = study(&racked, "turn", Coordinates::Joint);
    assert_eq!(scene.frames, rack.scenes[0].1.frames);
}

/// The number of teeth of a wheel and the direction of its first one in the body.
fn teeth(scene: &Scene, wheel: &Wheel) -> (usize, f64) {
    let of = |shape: &Shape| if let Shape::Gear { teeth, first, .. } = shape { Some((*teeth, *first)) } else { None };
    scene.bodies[wheel.body].shapes.iter().find_map(of).expect("a wheel with teeth")
}

/// Teeth of a wheel from its first one to a direction of the world in a frame.
fn count(scene: &Scene, frame: usize, wheel: &Wheel, direction: f64) -> f64 {
    let (teeth, first) = teeth(scene, wheel);
    let [x, y, _] = scene.direction(scene.frame(frame), wheel.body, &[first.cos(), first.sin()]);
    teeth as f64 * (direction - y.atan2(x)) / TAU
}

fn at(scene: &Scene, frame: usize, wheel: &Wheel) -> [f64; 3] {
    scene.world(scene.frame(frame), &Place { body: wheel.body, at: wheel.at.clone() })
}

/// How far a number of teeth is from a whole one.
fn off(x: f64) -> f64 {
    (x - x.round()).abs()
}

#[test]
fn teeth_meet_gaps_at_every_frame() {
    let (_, scene) = scenes("planetary_gear", "turn").remove(0);
    let numbers: Vec<usize> = ["ring", "sun", "planet1", "planet2", "planet3"]
        .iter()
        .map(|name| {
            let body = scene.bodies.iter().position(|body| body.name == *name).unwrap();
            teeth(&scene, &Wheel { body, ..Wheel::default() }).0
        })
        .collect();
    assert_eq!(numbers, [72, 18, 27, 27, 27]);
    assert_eq!(scene.gears.len(), 4);
    for gear in &scene.gears {
        for frame in 0..scene.frames.count() {
            let (a, b) = (at(&scene, frame, &gear.a), at(&scene, frame, &gear.b));
            let toward = (b[1] - a[1]).atan2(b[0] - a[0]);
            // the ring is the first of its pairs, and is touched on the far side of the planet
            let ring = gear.a.radius < 0.0;
            let u = count(&scene, frame, &gear.a, toward);
            let v = count(&scene, frame, &gear.b, if ring { toward } else { toward + PI });
            let meets = if ring { u - v } else { u + v } - 0.5;
            assert!(off(meets) < 1e-2, "{} at frame {frame}: {meets}", gear.name);
        }
    }
}

/// Holds the law of a rack: at every frame a tooth of its pinion meets a gap. Gives its number of teeth.
fn rack_meshes(scene: &Scene, gear: &Gear) -> usize {
    let (teeth, _) = teeth(scene, &gear.a);
    let Shape::Polygon { points } = &scene.bodies[gear.b.body].shapes[0] else { panic!("{:?}", scene.bodies[gear.b.body]) };
    let radius = gear.a.radius;
    let (pitch, height) = (TAU * radius / teeth as f64, 2.0 * radius / teeth as f64);
    // level racks alone: their tips are a module from the pitch line, on the side of the pinion
    let above = at(scene, 0, &gear.a)[1] > at(scene, 0, &gear.b)[1];
    let tip = gear.b.at[1] + if above { height } else { -height };
    let tips: Vec<f64> =
        points.chunks_exact(4).filter(|tooth| (tooth[1][1] - tip).abs() < 1e-9).map(|t| 0.5 * (t[1][0] + t[2][0])).collect();
    let [low, high] = tips.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    for frame in 0..scene.frames.count() {
        let (pinion, rack) = (at(scene, frame, &gear.a), at(scene, frame, &gear.b));
        let touched = pinion[0] - rack[0] + gear.b.at[0];
        assert!(low < touched && touched < high, "{touched} of {tips:?}");
        // towards the rack; below its pinion teeth are counted along it, above against it
        let (direction, sense) = if above { (-0.5 * PI, 1.0) } else { (0.5 * PI, -1.0) };
        let u = count(scene, frame, &gear.a, direction);
        let v = (touched - tips[0]) / pitch;
        assert!(off(sense * v - u - 0.5) < 1e-6, "{} at frame {frame}: {u} {v}", gear.name);
    }
    tips.len()
}

#[test]
fn racks_have_teeth_as_far_as_their_pinions_come() {
    for text in [below(), GEARS.replace("  arm: { bar: { length: 0.3 m } }\n", "")] {
        let scene = study(&text, "turn", Coordinates::Joint).scenes.remove(0).1;
        // a turn of the pinion and a radius more on each side
        let teeth = rack_meshes(&scene, &scene.gears[1]);
        assert!((22..=24).contains(&teeth), "{teeth}");
    }
}

#[test]
fn two_pinions_share_one_rack() {
    let text = "grashof: 1
name: pinions
space: planar
gravity: none
ground: { O: [0, 0], Q: [20 cm, 0], T: [0, 4 cm], U: [0, -4 cm] }
bodies:
  p1: { disc: { radius: 4 cm, mass: 1 kg } }
  p2: { disc: { radius: 4 cm, mass: 1 kg } }
  top: { plate: { size: [20 cm, 2 cm], mass: 1 kg }, points: { m: [0, -1 cm] } }
  low: { mass: 1 kg }
joints:
  O: { revolute: [ground.O, p1.origin] }
  Q: { revolute: [ground.Q, p2.origin] }
  T: { slider: [ground.T, top.m], axis: [1, 0] }
  U: { slider: [ground.U, low.origin], axis: [1, 0] }
couplings:
  a: { rack: [O, T], radius: -4 cm }
  b: { rack: [O, U], radius: 4 cm }
  c: { rack: [Q, U], radius: 4 cm }
drivers: { drive: { joint: O, angle: 1.5*sin(2 rad/s*t) } }
studies: { run: { kinematics: { over: 3 s, samples: 100 } } }
";
    let (scene, drawing) = drawn(text, "run");
    assert_eq!(scene.gears.len(), 3);
    scene.gears.iter().for_each(|gear| _ = rack_meshes(&scene, gear));
    let low = scene.bodies.iter().find(|body| body.name == "low").unwrap();
    assert_eq!(low.shapes.iter().filter(|shape| matches!(shape, Shape::Polygon { .. })).count(), 1);
    // guides are at the backs of racks
    let upper = |name: &str| drawing.joints.iter().find(|joint| joint.name == name).unwrap().poses[0].upper;
    assert_eq!([upper("T"), upper("U")], [true, false]);
}

const RING: &str = "grashof: 1
name: ring
space: planar
gravity: none
ground: { O: [0, 0] }
bodies:
  ring: { disc: { radius: 10 cm, mass: 1 kg } }
  arm: { bar: { length: 6 cm, mass: 0.2 kg } }
  planet: { disc: { radius: 4 cm, mass: 1 kg } }
joints:
  R: { fixed: [ground.O, ring.origin] }
  O: { revolute: [ground.O, arm.start] }
  P: { revolute: [arm.end, planet.origin] }
couplings: { m: { gear: [O, P], ratio: -2.5 } }
drivers: { drive: { joint: O, speed: 60 rpm } }
studies: { run: { kinematics: { over: 2 turn, samples: 100 } } }
";

#[test]
fn what_is_fixed_to_a_wheel_and_has_its_disc_has_the_teeth() {
    let (scene, _) = drawn(RING, "run");
    let names: Vec<&str> =
        scene.gears.iter().flat_map(|gear| [&gear.a, &gear.b]).map(|wheel| scene.bodies[wheel.body].name.as_str()).collect();
    assert_eq!(names, ["ring", "planet"]);
    let ring = &scene.bodies[1].shapes;
    assert!(matches!(ring[..], [Shape::Gear { teeth: 45, .. }]), "{ring:?}");
}

#[test]
fn a_wheel_hardly_smaller_than_its_ring_has_teeth_that_pass_each_other() {
    let text = RING.replace("length: 6 cm", "length: 0.5 cm").replace("radius: 4 cm", "radius: 9.5 cm").replace("-2.5", "-20/19");
    let (scene, _) = drawn(&text, "run");
    let [ring, planet] = [&scene.gears[0].a, &scene.gears[0].b].map(|wheel| teeth(&scene, wheel).0);
    assert!(ring - planet >= 9 && 19 * ring == 20 * planet, "{ring} {planet}");
}

/// The gears with the rack below its pinion.
fn below() -> String {
    GEARS.replace("  arm: { bar: { length: 0.3 m } }\n", "").replace("radius: -0.1 m", "radius: 0.1 m")
}

/// The drawing of the first scene of a study.
fn drawn(text: &str, name: &str) -> (Scene, Drawing) {
    let scene = study(text, name, Coordinates::Joint).scenes.remove(0).1;
    let drawing = drawing("m", name, "mechanism", &scene);
    (scene, drawing)
}

#[test]
fn figures_have_the_teeth_and_bearings_keep_clear_of_racks() {
    let (_, drawing) = drawn(&below(), "turn");
    let toothed = drawing.bodies.iter().flat_map(|body| &body.poses[0]).filter(|form| matches!(form.kind, FormKind::Gear { .. })).count();
    assert_eq!(toothed, 2);
    let above: Vec<(&str, bool)> = drawing.joints.iter().map(|joint| (joint.name.as_str(), joint.above)).collect();
    assert_eq!(above, [("S", true), ("Q", false), ("W", false)]);
}

const BOOM: &str = "grashof: 1
name: boom
space: planar
gravity: none
ground: { O: [0, 0], P: [0.4 m, -0.3 m] }
bodies: { boom: { bar: { length: 2 m, mass: 80 kg }, points: { eye: [0.9 m, 0] } } }
joints: { O: { revolute: [ground.O, boom.start] } }
couplings: { cylinder: { zero: EXTENT } }
start: { O.angle: ~0 deg }
studies: { lift: { kinematics: { over: 8 s, samples: 20 } } }
";

#[test]
fn a_distance_that_a_coupling_prescribes_is_a_cylinder() {
    let extent = "hypot(boom.eye.x - ground.P.x, boom.eye.y - ground.P.y)";
    for zero in [format!("{extent} - (60 cm + 5 cm/s*t)"), format!("60 cm + 5 cm/s*t - {extent}"), "boom.eye.y - 0.1 m - 0.01 m/s*t".into()]
    {
        let (scene, drawing) = drawn(&BOOM.replace("EXTENT", &format!("\"{zero}\"")), "lift");
        if zero.starts_with("boom") {
            assert!(scene.links.is_empty(), "{:?}", scene.links);
            continue;
        }
        let [link] = &scene.links[..] else { panic!("{zero}: {:?}", scene.links) };
        assert_eq!((link.name.as_str(), link.kind, link.a.body, link.b.body), ("cylinder", LinkKind::Actuator, 0, 1));
        assert!((link.a.at[0] - 0.4).abs() < 1e-4 && (link.a.at[1] + 0.3).abs() < 1e-4 && link.b.at == [0.9, 0.0], "{link:?}");
        assert!((link.rest.unwrap() - 0.6).abs() < 1e-4, "{link:?}");
        // as long at each of its positions
        let link = &drawing.links[0];
        assert_eq!(link.stages, 2);
        let length = |k: usize| {
            let [a, b] = link.poses[k];
            link.cylinder[k] * (b[0] - a[0]).hypot(b[1] - a[1])
        };
        assert!(link.poses.len() > 2 && (0..link.poses.len()).all(|k| (length(k) - 0.51).abs() < 1e-4));
    }
}

#[test]
fn a_distance_that_a_coupling_holds_is_a_rod() {
    // between two bodies in space
    let text = "grashof: 1
name: held
space: spatial
gravity: none
ground: { A: [0, 0, 0], B: [1 m, 0, 0] }
bodies:
  a: { bar: { length: 0.3 m, mass: 1 kg } }
  b: { bar: { length: 0.4 m, mass: 1 kg } }
joints:
  A: { revolute: [ground.A, a.start], axis: [0, 0, 1] }
  B: { revolute: [ground.B, b.start], axis: [0, 0, 1] }
couplings: { rod: { zero: \"sqrt((a.end.x - b.end.x)^2 + (a.end.y - b.end.y)^2 + (a.end.z - b.end.z)^2) - 1.05 m\" } }
drivers: { turn: { joint: A, speed: 1 rad/s } }
start: { A.angle: 80 deg, B.angle: ~80 deg }
studies: { turn: { kinematics: { over: 0.2 s, samples: 5 } } }
";
    let (scene, _) = drawn(text, "turn");
    let [link] = &scene.links[..] else { panic!("{:?}", scene.links) };
    assert_eq!((link.name.as_str(), link.kind, link.rest, link.a.body, link.b.body), ("rod", LinkKind::Rod, None, 1, 2));
}

#[test]
fn a_slot_is_seen_to_be_cut_into_its_body_and_a_dashpot_is_behind_it() {
    let text = |plate: &str| {
        format!(
            "grashof: 1
name: yoke
space: planar
gravity: none
ground: {{ O: [0, 0] }}
bodies:
  crank: {{ bar: {{ length: 0.1 m }} }}
  yoke: {{ {plate}mass: 1 kg }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  W: {{ slider: [ground.O, yoke.origin], axis: [1, 0], damping: 1 N s/m }}
  A: {{ pin-in-slot: [yoke.origin, crank.end], axis: [0, 1] }}
drivers: {{ drive: {{ joint: O, speed: 1 rad/s }} }}
start: {{ O.angle: 0 deg }}
studies: {{ turn: {{ kinematics: {{ over: 1 turn, samples: 12 }} }} }}
"
        )
    };
    for (plate, framed, back) in
        [("", true, 0.0), ("drawn: [[-0.05 m, -0.2 m], [0.03 m, -0.2 m], [0.03 m, 0.2 m], [-0.05 m, 0.2 m]], ", false, 0.05)]
    {
        let (_, drawing) = drawn(&text(plate), "turn");
        let of = |name: &str| drawing.joints.iter().find(|joint| joint.name == name).unwrap();
        assert_eq!((of("A").framed, of("W").poses[0].back), (framed, back));
    }
}

#[test]
fn a_long_stroke_takes_several_tubes() {
    // from 0.1 m to 1.1 m, as a spring of the same length would be seen
    let text = "grashof: 1
name: ram
space: planar
gravity: none
ground: { O: [0, 0], S: [0.1 m, 0] }
bodies: { block: { mass: 1 kg } }
joints: { S: { slider: [ground.S, block.origin], axis: [1, 0] } }
couplings: { c: { zero: \"block.x - (0.1 m + 0.1 m/s*t)\" } }
start: { S.position: ~0 m }
studies: { push: { kinematics: { over: 10 s, samples: 20 } } }
";
    // along a line every place would do as the other end: no distance
    assert!(drawn(text, "push").0.links.is_empty());
    let (scene, _) = drawn(&text.replace("block.x", "hypot(block.x, block.y)"), "push");
    let [link] = &scene.links[..] else { panic!("{:?}", scene.links) };
    assert_eq!((link.kind, link.stages), (LinkKind::Actuator, 6));
}

#[test]
fn stops_of_what_is_round_are_about_its_x_axis() {
    let text = "grashof: 1
name: wheel
space: planar
gravity: none
ground: { O: [0, 0] }
bodies: { wheel: { disc: { radius: 0.2 m, mass: 1 kg } } }
joints: { O: { revolute: [ground.O, wheel.origin], limits: { from: -30 deg, to: 60 deg, restitution: 0.5 } } }
start: { O.angle: 0 deg, O.omega: 1 rad/s }
studies: { turn: { dynamics: { until: 1 s, every: 0.1 s } } }
";
    for text in [text.to_owned(), text.replace("disc: { radius: 0.2 m", "plate: { size: [0.2 m, 0.1 m]")] {
        let placement = drawn(&text, "turn").1.joints[0].poses[0];
        let angles = placement.stops.map(|stop| stop.map(|[x, y]| y.atan2(x).to_degrees().round()));
        assert_eq!(angles, [Some(-30.0), Some(60.0)]);
        assert!((placement.swing.unwrap() - 0.5 * PI).abs() < 1e-12);
    }
}
