//! A machine is drawn the same whichever body its joints name first, and springs end where they are measured from.

use super::{results_of, scenes_of};
use grashof::results::Scene;
use grashof::results::scene::{ArrowKind, Joint, LinkKind};

/// A bar and a block, joined as `hinge` and `slide`, with the loads `torque` and `force`.
fn machine(space: &str, [hinge, slide]: [&str; 2], sign: i32) -> String {
    let (axis, along) = if space == "planar" { ("", "axis: [0.6, 0.8]") } else { (", axis: [0, 0.6, 0.8]", "axis: [0.6, 0, 0.8]") };
    let start = if sign > 0 { [20, 0] } else { [-20, 0] };
    format!(
        "grashof: 1
name: order
space: {space}
gravity: {gravity}
bodies: {{ bar: {{ bar: {{ length: 40 cm, mass: 1 kg }} }}, block: {{ mass: 1 kg{inertia} }} }}
joints:
  H: {{ revolute: [{hinge}]{axis}, limits: {{ from: {}, to: {}, stiffness: 1000 N m/rad }} }}
  S: {{ slider: [{slide}], {along}, limits: {{ from: {}, to: {}, stiffness: 10 kN/m }} }}
loads: {{ turning: {{ joint: H, torque: {} N m }}, pushing: {{ joint: S, force: {} N }} }}
start: {{ H.angle: {} deg, S.position: {} m }}
studies:
  run: {{ dynamics: {{ until: 0.2 s, every: 5 ms }}, columns: [bar.end.x, bar.end.y], show: [loads, reactions] }}
  driven: {{ variant: driven, kinematics: {{ over: 1 s, samples: 40 }}, columns: [bar.end.x] }}
variants: {{ driven: {{ loads: null, start: null, drivers: {{ h: {{ joint: H, speed: {} rad/s }}, s: {{ joint: S, speed: {} m/s }} }} }} }}
",
        if sign > 0 { "-30 deg" } else { "-60 deg" },
        if sign > 0 { "60 deg" } else { "30 deg" },
        if sign > 0 { "-30 cm" } else { "-10 cm" },
        if sign > 0 { "10 cm" } else { "30 cm" },
        -2 * sign,
        -5 * sign,
        start[0],
        start[1],
        -0.3 * f64::from(sign),
        -0.2 * f64::from(sign),
        gravity = if space == "planar" { "[0.4, -2]" } else { "[0.4, -2, 1]" },
        inertia = if space == "planar" {
            ", inertia: 0.1 kg m^2, com: [5 cm, 2 cm]"
        } else {
            ", inertia: [0.1 kg m^2, 0.1 kg m^2, 0.1 kg m^2], com: [5 cm, 2 cm, 1 cm]"
        },
    )
}

fn near(what: &str, a: &[f64], b: &[f64], size: f64) {
    assert_eq!(a.len(), b.len(), "{what}");
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-9 * size), "{what}: {a:?}, {b:?}");
}

/// What is seen of a joint in the frames of a scene: the places of both ends, and those at which it stops and turns back; of a hinge in the
/// plane the directions of its stops; and whither it is driven.
fn seen(scene: &Scene, joint: &Joint) -> Vec<f64> {
    let mut all = Vec::new();
    for index in 0..scene.frames.count() {
        let poses = scene.frame(index);
        let (a, b) = (scene.world(poses, &joint.a), scene.world(poses, &joint.b));
        all.extend(a.into_iter().chain(b));
    }
    let axis = scene.direction(scene.frame(0), joint.a.body, &joint.axis);
    let about = if joint.kind == "revolute" && scene.dimensions == 2 { [0.0, 0.0, 1.0] } else { axis };
    let mut ends = [joint.stops.map(Option::unwrap), joint.stroke.unwrap_or_default()].map(|ends| ends.map(|s| about.map(|e| s * e)));
    ends.iter_mut().for_each(|ends| ends.sort_by(|a, b| (a[0] + a[1] + a[2]).total_cmp(&(b[0] + b[1] + b[2]))));
    all.extend(ends.as_flattened().as_flattened());
    all.extend(about.map(|e| joint.sense * e));
    all
}

#[test]
fn the_order_of_the_bodies_of_a_joint_is_not_seen() {
    for space in ["planar", "spatial"] {
        let first = machine(space, ["ground, bar.start", "ground, block.origin"], 1);
        let second = machine(space, ["bar.start, ground", "block.origin, ground"], -1);
        for study in ["run", "driven"] {
            let [one, other] = [&first, &second].map(|text| results_of(text, study).scenes.remove(0).1);
            near(space, &one.frames.poses, &other.frames.poses, 1.0);
            for (a, b) in one.joints.iter().zip(&other.joints) {
                let name = format!("{space} {study} {}", a.name);
                assert_eq!((a.a.body, a.b.body, a.driven, a.on_ground, b.on_ground), (b.a.body, b.b.body, b.driven, false, true), "{name}");
                assert_eq!(a.sense != 0.0, study == "driven", "{name}");
                near(&name, &seen(&one, a), &seen(&other, b), 1.0);
            }
            // a slide has a moment, in space a hinge as well
            let count = 4 + if space == "planar" { 1 } else { 2 };
            assert_eq!(one.arrows.len(), if study == "run" { count } else { 0 });
            for (a, b) in one.arrows.iter().zip(&other.arrows) {
                let name = format!("{space} {}", a.name);
                assert_eq!((a.body, &a.at, a.minus, b.minus), (b.body, &b.at, false, true), "{name}");
                assert!(a.values.iter().any(|x| x.abs() > 1e-3), "{name}: {:?}", a.values);
                let most = a.values.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
                // between rows a moment about a point that moves is a curve, which is drawn as lines
                let within = if a.kind == ArrowKind::Moment { 1e6 } else { 1e3 };
                near(&name, &a.values, &b.values, within * most);
            }
        }
    }
}

/// A block in the plane that a force moves, with a spring over an expression.
fn sprung(stretch: &str, vx: &str) -> String {
    format!(
        "grashof: 1
name: sprung
space: planar
gravity: [0, -9.81 m/s^2]
tables: {{ bump: {{ points: [[3 m, 0 m], [3.3 m, 60 mm], [3.6 m, 60 mm], [3.9 m, 0 m]], between: linear }} }}
bodies: {{ b: {{ disc: {{ radius: 0.3 m, mass: 1 kg }} }} }}
springs: {{ s: {{ stretch: '{stretch}', stiffness: 40 N/m }} }}
start: {{ b.x: 0.2 m, b.y: 0.4 m, b.angle: 0 deg, b.vx: {vx} }}
studies: {{ run: {{ dynamics: {{ until: 0.5 s, every: 5 ms }}, columns: [b.x] }} }}
"
    )
}

#[test]
fn a_spring_over_a_point_ends_where_its_stretch_is_measured_from() {
    let of = |stretch: &str, vx: &str| scenes_of(&sprung(stretch, vx), "run").remove(0).1.links;
    // the distance to a place, less a length or times a factor
    for stretch in ["sqrt((b.x - 1.3 m)^2 + (b.y + 0.7 m)^2) - 0.9 m", "sqrt((b.x - 1.3 m)^2 + (b.y + 0.7 m)^2)"] {
        let links = of(stretch, "0.3 m/s");
        assert_eq!((links.len(), links[0].kind, links[0].a.body, links[0].b.body), (1, LinkKind::Spring, 0, 1), "{stretch}");
        assert!((links[0].a.at[0] - 1.3).abs() < 1e-4 && (links[0].a.at[1] + 0.7).abs() < 1e-4, "{:?}", links[0].a.at);
    }
    // a road, below the wheel where this stays near, and not at all where it rolls away
    let links = of("b.y - 0.3 m - bump(b.x)", "0.3 m/s");
    assert!((links[0].a.at[0] - 0.2).abs() < 1e-9 && links[0].a.at[1] < 0.1, "{:?}", links[0].a.at);
    assert!(of("b.y - 0.3 m - bump(b.x)", "30 m/s").is_empty());
    // a plane, along which the end goes with the point
    let (_, scene) = scenes_of(&sprung("b.y - 0.3 m", "30 m/s"), "run").remove(0);
    assert_eq!(scene.links[0].along, [0.0, 1.0]);
    for index in 0..scene.frames.count() {
        let poses = scene.frame(index);
        let [a, b] = scene.ends(poses, &scene.links[0]);
        assert!((a[0] - poses[0]).abs() < 1e-12 && (a[1] - scene.links[0].a.at[1]).abs() < 1e-12 && b[..2] == poses[..2], "{a:?} {b:?}");
    }
    // a wall aslant
    let links = of("0.6*b.x + 0.8*b.y", "0.3 m/s");
    let way: Vec<f64> = links[0].a.at.iter().zip([0.2, 0.4]).map(|(a, p)| a - p).collect();
    assert!(way[0] < 0.0 && (0.8 * way[0] - 0.6 * way[1]).abs() < 1e-6, "{way:?}");
}
