//! What is drawn moves as the mechanism does: between its frames too, and with its joints closed.

mod gears;
mod held;
mod hidden;
mod order;
mod outlines;
mod stops;
mod welded;

use crate::common::{columns, model, study};
use grashof::mechanism::Coordinates;
use grashof::model::{Document, Selection};
use grashof::results::scene::{ArrowKind, GearKind, LinkKind, Place, Shape, Trace};
use grashof::results::{Results, Scene};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::run::run;
use grashof::studies::sweep::{Drawn, Run, Settings, sweep};

/// A slider-crank over a turn, at rows that are no frames.
const SLIDER_CRANK: &str = "grashof: 1
name: slider-crank
space: planar
gravity: none
ground: { O: [0, 0], W: [0, 0.1 m] }
bodies:
  crank: { bar: { length: 0.3 m } }
  rod: { bar: { length: 1 m }, points: { P: [0.4 m, 0.2 m] } }
  block: {}
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, block.origin] }
  W: { slider: [ground.W, block.origin], axis: [1, 0] }
drivers: { drive: { joint: O, speed: -1 rad/s } }
start: { O.angle: 20 deg, rod.angle: ~0 deg }
studies:
  turn: { kinematics: { over: 1 turn, samples: 97 }, columns: [rod.P.x, rod.P.y, crank.end.x, crank.end.y, block.x, block.y] }
";

/// A chain of two bars that swings freely and turns over.
const PENDULUM: &str = "grashof: 1
name: double-pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { u: { bar: { length: 1 m, mass: 1 kg } }, l: { bar: { length: 0.7 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, u.start] }, Q: { revolute: [u.end, l.start] } }
start: { P.angle: 100 deg, l.angle: 140 deg }
studies: { fall: { dynamics: { until: 2 s, every: 17 ms }, columns: [l.end.x, l.end.y, u.end.x, u.end.y] } }
";

/// A spinning body on a ball, whose quaternion goes round.
const TOP: &str = "grashof: 1
name: top
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies: { top: { disc: { radius: 0.3 m, mass: 1 kg }, points: { foot: [0, 0, -0.5 m], rim: [0.3 m, 0, 0] } } }
joints: { P: { spherical: [ground, top.foot] } }
start: { top.rotation: { axis: [1, 0, 0], angle: 40 deg }, top.wz: 30 rad/s }
studies: { spin: { dynamics: { until: 1 s, every: 13 ms }, columns: [top.rim.x, top.rim.y, top.rim.z, top.x, top.y, top.z] } }
";

/// Size of what is seen, m.
fn size(scene: &Scene) -> f64 {
    let places = scene.joints.iter().flat_map(|joint| [&joint.a, &joint.b]).flat_map(|place| &place.at);
    places.fold(0.1, |size: f64, x| size.max(x.abs()))
}

/// Interpolates the frames at the rows of a study, and compares the points that its columns name.
fn interpolates(text: &str, name: &str) -> Scene {
    let outcome = study(text, name, Coordinates::Joint);
    let (names, (_, scene)) = (columns(text, name), &outcome.scenes[0]);
    let traced = |trace: &Trace| Place { body: trace.body, at: trace.at.clone() };
    let mut compared = 0;
    for (column, of) in names.iter().enumerate() {
        let Some((point, axis)) = of.rsplit_once('.') else { continue };
        let Some(trace) = scene.traces.iter().find(|trace| trace.name == point) else { continue };
        let axis = ["x", "y", "z"].iter().position(|a| *a == axis).expect("an axis");
        for (x, exact) in outcome.places.iter().zip(outcome.rows.column(column)) {
            let found = scene.world(&scene.frames.at(*x, scene.dimensions), &traced(trace))[axis];
            let allowed = scene.frames.error + 1e-9 * size(scene);
            assert!((found - exact).abs() <= allowed, "{name}, {of} at {x}: {found} and {exact}, {allowed:e} allowed");
            compared += 1;
        }
    }
    assert!(compared > 100, "{names:?} {:?}", scene.traces);
    assert!(scene.frames.at.is_sorted_by(|a, b| a < b) && scene.frames.error <= 1e-6 * 2.0, "{}", scene.frames.error);
    joints_are_closed(scene, name);
    scene.clone()
}

/// Points of hinges coincide in every frame, and those of slides lie along the axis.
fn joints_are_closed(scene: &Scene, name: &str) {
    for index in 0..scene.frames.count() {
        let poses = scene.frame(index);
        for joint in &scene.joints {
            let (a, b) = (scene.world(poses, &joint.a), scene.world(poses, &joint.b));
            let mut gap: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
            if let Some([low, high]) = joint.stroke {
                let axis = scene.direction(poses, joint.a.body, &joint.axis);
                let along: f64 = (0..3).map(|i| gap[i] * axis[i]).sum();
                assert!((low - 1e-9..=high + 1e-9).contains(&along), "{name}: {} at {along}, {low} to {high}", joint.name);
                gap = std::array::from_fn(|i| gap[i] - along * axis[i]);
            }
            let gap = gap.iter().map(|x| x * x).sum::<f64>().sqrt();
            let held = !matches!(&*joint.kind, "free" | "point" | "planar");
            assert!(!held || gap <= 1e-8 * size(scene), "{name}, frame {index}: joint {} is open by {gap:e}", joint.name);
        }
    }
}

#[test]
fn frames_of_a_driven_motion_give_the_motion_between_them() {
    let scene = interpolates(SLIDER_CRANK, "turn");
    // the crank turns backwards, and the independent variable rises all the same
    assert!(scene.frames.closed && scene.frames.shown.len() == 6 && scene.frames.shown[0] == scene.frames.count() - 1);
    let slide = scene.joints.iter().find(|joint| joint.name == "W").and_then(|joint| joint.stroke).expect("a stroke");
    assert!(slide[1] - slide[0] > 0.59 && slide[1] - slide[0] < 0.62, "{slide:?}");
    assert!(matches!(&scene.bodies[2].shapes[..], [Shape::Hull { points }] if points.len() == 3));
    assert!(matches!(&scene.bodies[1].shapes[..], [Shape::Bar { .. }]));
}

#[test]
fn frames_of_a_motion_in_time_give_the_motion_between_them() {
    let scene = interpolates(PENDULUM, "fall");
    assert!(!scene.frames.closed && scene.up == [0.0, 1.0, 0.0]);
}

#[test]
fn quaternions_go_round_without_a_jump() {
    let scene = interpolates(TOP, "spin");
    let signs = scene.frames.poses.chunks_exact(7).map(|pose| pose[3]);
    assert!(signs.clone().any(|w| w < 0.0) && signs.clone().any(|w| w > 0.0));
    assert_eq!(scene.up, [0.0, 0.0, 1.0]);
}

/// Of a study of a model of the repository.
fn scenes(file: &str, name: &str) -> Vec<(String, Scene)> {
    scenes_of(&std::fs::read_to_string(format!("models/{file}.yaml")).expect("the model"), name)
}

/// Of a study of a text.
fn scenes_of(text: &str, name: &str) -> Vec<(String, Scene)> {
    let model = model(text, Some(name));
    let study = model.study.clone().expect("the study");
    run(Case::new(&model, &study, &parameters(&model)), &|| false).unwrap_or_else(|f| panic!("{name}: {}", f.reason())).scenes
}

#[test]
fn joints_of_the_models_stay_closed() {
    let all = [
        ("crank_rocker", "one-turn"),
        ("crank_rocker", "modes"),
        ("quick_return", "one-turn"),
        ("andrews", "squeeze"),
        ("heavy_top", "precession"),
    ];
    for (file, name) in all {
        for (_, scene) in scenes(file, name) {
            joints_are_closed(&scene, name);
            assert_eq!(scene.frames.poses.len(), scene.frames.count() * scene.width());
        }
    }
}

#[test]
fn a_motion_that_repeats_itself_in_the_grid_is_not_taken_for_rest() {
    let text = SLIDER_CRANK
        .replace("speed: -1 rad/s", "angle: 20 deg + 10 deg*sin(48*t/(1 s))")
        .replace("over: 1 turn, samples: 97", "over: 6.283185307179586 s, samples: 997");
    let scene = interpolates(&text, "turn");
    assert!(scene.frames.count() > 384, "{}", scene.frames.count());
}

#[test]
fn a_crankshaft_is_bars_about_its_axis_and_its_pins() {
    let (_, scene) = scenes("inline_four", "shaking").remove(0);
    let shaft = scene.bodies.iter().find(|body| body.name == "shaft").expect("the shaft");
    let ends: Vec<_> =
        shaft.shapes.iter().filter_map(|shape| if let Shape::Bar { from, to, .. } = shape { Some([from, to]) } else { None }).collect();
    assert_eq!((ends.len(), shaft.shapes.len()), (5 + 4 * 3, 17));
    // every end is on the axis or as far from it as the crank is long
    let far = ends.iter().flatten().map(|p| p[1].hypot(p[2]));
    assert!(far.clone().all(|r| r < 1e-9 || (r - 0.043).abs() < 1e-9) && far.filter(|r| *r > 0.01).count() == 4 * 4, "{ends:?}");
}

/// A winch in space, seen from the front: x to the right, z upwards.
const WINCH: &str = "grashof: 1
name: winch
space: spatial
gravity: none
ground: { O: [0, 0, 0], W: [-0.1 m, 0, -1 m] }
bodies:
  drum: { disc: { radius: 0.1 m } }
  weight: { mass: 1 kg }
joints:
  S: { revolute: [ground.O, drum], axis: [0, 1, 0], to: [0, 0, 1] }
  W: { slider: [ground.W, weight], axis: [0, 0, 1] }
couplings: { rope: { rope: [S, W], radius: 0.1 m } }
drivers: { drive: { joint: S, speed: 1 rad/s } }
studies: { lift: { kinematics: { over: 0.5 turn, samples: 10 }, view: front } }
";

#[test]
fn ropes_and_racks_are_drawn_in_space() {
    let drawn = |text: &str| {
        let scene = study(text, "lift", Coordinates::Joint).scenes.remove(0).1;
        let gear = scene.gears.first().unwrap_or_else(|| panic!("no gear")).clone();
        (gear, grashof::output::drawing("winch", "lift", "mechanism", &scene).gears.remove(0))
    };
    let near = |p: [f64; 2], x: f64, z: f64| (p[0] - x).hypot(p[1] - z) < 1e-9;
    // the left side of a wheel that turns about y goes upwards
    let (rope, seen) = drawn(WINCH);
    assert_eq!((rope.kind, rope.b.axis), (GearKind::Rope, vec![0.0, 0.0, 1.0]));
    // the axis of the drum is its own z
    assert!((rope.a.axis[2] - 1.0).abs() < 1e-9, "{:?}", rope.a);
    let [from, to] = seen.rope.expect("a rope");
    assert!(near(from, -0.1, 0.0) && near(to, -0.1, -1.0), "{from:?} {to:?}");
    let (rack, seen) = drawn(&WINCH.replace("rope: [S, W]", "rack: [S, W]"));
    assert!(rack.kind == GearKind::Rack && rack.b.axis == [0.0, 0.0, 1.0], "{rack:?}");
    assert!(near(seen.mesh.expect("where they touch"), -0.1, 0.0), "{seen:?}");
    // what slides along the axis of a wheel is no rack
    let skew = WINCH.replace("axis: [0, 0, 1]", "axis: [0, 1, 0]");
    assert!(study(&skew, "lift", Coordinates::Joint).scenes[0].1.gears.is_empty());
    let belt = WINCH
        .replace("weight: { mass: 1 kg }", "wheel: { disc: { radius: 0.3 m } }")
        .replace("slider: [ground.W, weight], axis: [0, 0, 1]", "revolute: [ground.W, wheel], axis: [0, 1, 0], to: [0, 0, 1]");
    let (belt, seen) = drawn(&belt.replace("rope: [S, W], radius: 0.1 m", "gear: [S, W], ratio: 1/3"));
    assert!(belt.kind == GearKind::Belt && seen.belt.len() > 20, "{belt:?}");
    let far = |at: [f64; 2]| seen.belt.iter().map(|p| (p[0] - at[0]).hypot(p[1] - at[1])).fold(f64::INFINITY, f64::min);
    assert!((far([0.0, 0.0]) - 0.1).abs() < 1e-9 && (far([-0.1, -1.0]) - 0.3).abs() < 1e-9, "{seen:?}");
}

#[test]
fn springs_over_one_coordinate_have_a_place() {
    let springs = "springs: { j: { joint: W, stiffness: 5 N/m }, p: { stretch: block.y - 1 cm, stiffness: 5 N/m }, q: { stretch: W.position^2, \
                   stiffness: 1 N/m^3 }, c: { stretch: crank.angle, stiffness: 1 N m/rad }, r: { stretch: rod.angle, stiffness: 1 N m/rad } }";
    let outcome = study(&SLIDER_CRANK.replace("start:", &format!("{springs}\nstart:")), "turn", Coordinates::Joint);
    let scene = &outcome.scenes[0].1;
    let kinds: Vec<_> = scene.links.iter().map(|link| (link.name.as_str(), link.kind)).collect();
    // the rod has no hinge on the ground
    let expected = [("j", LinkKind::Spring), ("p", LinkKind::Spring), ("q", LinkKind::Spring), ("c", LinkKind::Torsion)];
    assert_eq!(kinds, expected);
    for link in &scene.links[..3] {
        let lengths = (0..scene.frames.count()).map(|i| {
            let [a, b] = [&link.a, &link.b].map(|end| scene.world(scene.frame(i), end));
            (b[0] - a[0]).hypot(b[1] - a[1])
        });
        assert!(lengths.fold(f64::INFINITY, f64::min) > 0.01, "{link:?}");
    }
}

#[test]
fn links_say_what_they_are() {
    let text = PENDULUM.replace(
        "start:",
        "springs: { s: { between: [ground.origin, l.end], stiffness: 5 N/m, length: 1 m }, d: { joint: Q, damping: 0.1 N m s/rad } }\nstart:",
    );
    let scene = &study(&text, "fall", Coordinates::Joint).scenes[0].1;
    let kinds: Vec<_> = scene.links.iter().map(|link| (link.name.as_str(), link.kind, link.rest)).collect();
    assert_eq!(kinds, [("s", LinkKind::Spring, Some(1.0))]);
    // what only damps a hinge is its dashpot
    assert_eq!(scene.joints.iter().map(|joint| joint.damped).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn joints_with_damping_are_told() {
    let text = PENDULUM
        .replace("[ground, u.start] }", "[ground, u.start], damping: 0.1 N m s/rad }")
        .replace("l.start] }", "l.start], damping: 0 N m s/rad }");
    let scene = &study(&text, "fall", Coordinates::Joint).scenes[0].1;
    assert_eq!(scene.joints.iter().map(|joint| (joint.name.as_str(), joint.damped)).collect::<Vec<_>>(), [("P", true), ("Q", false)]);
}

#[test]
fn a_study_names_its_paths() {
    let traced = |trace: &str| {
        let text = SLIDER_CRANK.replace("columns: [rod.P.x, rod.P.y, crank.end.x, crank.end.y, block.x, block.y]", trace);
        let scene = study(&text, "turn", Coordinates::Joint).scenes.remove(0).1;
        scene.traces.into_iter().map(|trace| trace.name).collect::<Vec<_>>()
    };
    assert_eq!(traced("trace: [crank.end, block]"), ["crank.end", "block"]);
    assert!(traced("trace: []").is_empty());
    // the crank pin is on a circle and the block on a line
    assert_eq!(traced("columns: [O.angle]"), ["rod.P"]);
}

#[test]
fn a_study_says_where_the_eye_is() {
    let seen =
        |view: &str| study(&TOP.replace("dynamics:", &format!("view: {view}, dynamics:")), "spin", Coordinates::Joint).scenes[0].1.view;
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(seen("top"), Some([-quarter, quarter]));
    let [azimuth, elevation] = seen("[180 deg, 20 deg]").expect("a view");
    assert!((azimuth - 2.0 * quarter).abs() < 1e-15 && (elevation - 20_f64.to_radians()).abs() < 1e-15);
    let planar = SLIDER_CRANK.replace("turn: { ", "turn: { view: front, ");
    let report = Document::read(&planar, "test.yaml").and_then(|d| d.model(&Selection { study: Some("turn"), ..Selection::default() }));
    assert!(report.is_err_and(|report| report.diagnostics[0].code == "spatial-only"));
}

#[test]
fn runs_of_a_sweep_keep_their_scenes_and_name_themselves() {
    let text = SLIDER_CRANK
        .replace("gravity: none", "gravity: none\nparameters: { r: 0.3 m }")
        .replace("crank: { bar: { length: 0.3 m } }", "crank: { bar: { length: r } }");
    let model = model(&text.replace("turn: { ", "turn: { sweep: { r: [0.2 m, 0.3 m] }, "), Some("turn"));
    let asked = model.study.clone().expect("the study");
    let runs = |drawn: Drawn, known: Vec<Option<Run>>| {
        sweep(&model, &asked, Settings { threads: 2, drawn, stop: &|| false }, known, &|_| true, &|_, _| {})
    };
    let of = |runs: &[Run]| runs.iter().map(|run| run.result.as_ref().expect("a run").scenes.clone()).collect::<Vec<_>>();
    let all = of(&runs(Drawn::All, Vec::new()));
    assert_eq!(all.iter().map(|scenes| scenes[0].1.caption.as_str()).collect::<Vec<_>>(), ["r = 0.2 m", "r = 0.3 m"]);
    let undrawn = runs(Drawn::None, Vec::new());
    assert!(of(&undrawn).iter().all(Vec::is_empty));
    // the one drawing of a sweep is the same, also of runs that were kept without
    let first = [all[0].clone(), Vec::new()];
    assert_eq!(of(&runs(Drawn::First, Vec::new())), first);
    assert_eq!(of(&runs(Drawn::First, undrawn.into_iter().map(Some).collect())), first);
}

/// A lever that is turned against a load; `SHOWN` stands for what its study says of its drawing.
const LEVER: &str = "grashof: 1
name: lever
space: planar
gravity: none
bodies: { bar: { bar: { length: 2 m } } }
joints: { O: { revolute: [ground, bar.start] } }
drivers: { turn: { joint: O, speed: 1 rad/s } }
loads:
  across: { at: bar.end, force: [0, -5 N], frame: bar }
  twist: { at: bar.end, torque: -3 N m }
studies: { swing: { SHOWN, inverse: { over: 90 deg, samples: 90 }, columns: [O.fx] } }
";

/// The results of the lever.
fn lever(shown: &str) -> Results {
    results_of(&LEVER.replace("SHOWN", shown), "swing")
}

/// The results of a study of a text: with forces in its scenes.
fn results_of(text: &str, name: &str) -> Results {
    let model = model(text, Some(name));
    let study = model.study.clone().expect("a study");
    let outcome = run(Case::new(&model, &study, &parameters(&model)), &|| false).unwrap_or_else(|f| panic!("{}", f.reason()));
    grashof::studies::common::named::named(&model, &study, outcome)
}

#[test]
fn a_drawing_shows_the_place_that_is_asked_for() {
    let drawn = |shown: &str| {
        let scene = lever(shown).scenes.remove(0).1;
        let drawing = grashof::output::drawing("lever", "swing", "mechanism", &scene);
        let grashof::output::FormKind::Bar { to, .. } = drawing.bodies[1].poses[0][0].kind else { panic!("a bar") };
        (to, drawing.forces[0].along, drawing.bodies[1].poses.len())
    };
    for (shown, angle, more) in [
        ("show: [loads]", 0.0_f64, 0),
        ("at: 40 deg + 10 deg, show: [loads]", 50.0, 1),
        // in the place of the position of 36 degrees
        ("at: 37.123 deg, show: [loads]", 37.123, 0),
        ("at: 90 deg, show: [loads]", 90.0, 0),
    ] {
        let (s, c) = angle.to_radians().sin_cos();
        let (to, force, poses) = drawn(shown);
        assert!((to[0] - 2.0 * c).hypot(to[1] - 2.0 * s) < 1e-5, "{shown}: {to:?}");
        // the place is a frame, so that forces are those there
        assert!((force[0] - 5.0 * s).hypot(force[1] + 5.0 * c) < 1e-9, "{shown}: {force:?}");
        // one that is shown anyway is not drawn twice
        assert_eq!(poses, 6 + more, "{shown}");
    }
    assert!(lever("at: 90 deg").findings.is_empty());
    let beyond = lever("at: 100 deg").findings.remove(0);
    let message = "the drawing shows O.angle = 90 deg, where the motion ends: it has no 100 deg, only 0 deg to 90 deg";
    assert_eq!((&*beyond.code, beyond.message.as_str(), beyond.path.as_str()), ("not-reached", message, "studies.swing.at"));
}

#[test]
fn forces_are_shown_where_they_act_and_in_world_axes() {
    let read = |shown: &str| lever(shown).scenes.remove(0).1;
    assert!(read("about: none").arrows.is_empty());
    let scene = read("show: { loads: 2 kN/m }");
    let [across, twist] = &scene.arrows[..] else { panic!("{:?}", scene.arrows) };
    assert_eq!((across.scale, across.values.len(), twist.values.len()), (Some(2000.0), 2 * scene.frames.count(), scene.frames.count()));
    for (k, at) in scene.frames.at.iter().enumerate() {
        // across the bar, which is turned by now
        let wanted = [5.0 * at.sin(), -5.0 * at.cos()];
        (0..2).for_each(|i| assert!((across.values[2 * k + i] - wanted[i]).abs() < 1e-9, "{at}: {:?}", &across.values[2 * k..]));
        assert_eq!(twist.values[k], -3.0);
    }
    // a bar without mass hands on what acts on it
    let scene = read("show: [reactions]");
    let [hinge] = &scene.arrows[..] else { panic!("{:?}", scene.arrows) };
    let last = hinge.values.len() - 2;
    assert!((hinge.values[0].abs() < 1e-9) && (hinge.values[1] - 5.0).abs() < 1e-9, "{:?}", &hinge.values[..2]);
    assert!((hinge.values[last] + 5.0).abs() < 1e-9 && hinge.values[last + 1].abs() < 1e-9, "{:?}", &hinge.values[last..]);
    assert_eq!(hinge.columns, ["O.fx", "O.fy"]);
}

/// A cantilever carries F at its tip by the moment F l, about the wall and about its own end, whichever body the joint names first.
#[test]
fn moments_of_joints_are_shown_about_their_points() {
    for (space, down) in [("planar", "[0, -50 N]"), ("spatial", "[0, -50 N, 0]")] {
        for joint in ["[ground.W, beam.start]", "[beam.start, ground.W]"] {
            let text = format!(
                "grashof: 1\nname: cantilever\nspace: {space}\ngravity: none\nground: {{ W: {0} }}\nbodies: {{ beam: {{ bar: {{ length: 2 m }} }} }}\njoints: {{ wall: {{ fixed: {joint} }} }}\nloads: {{ tip: {{ at: beam.end, force: {down} }} }}\nstudies: {{ rest: {{ statics: {{ from: start }}, show: [reactions], columns: [wall.m] }} }}\n",
                if space == "planar" { "[1 m, 0]" } else { "[1 m, 0, 0]" }
            );
            let scene = results_of(&text, "rest").scenes.remove(0).1;
            let moment = scene.arrows.iter().find(|arrow| arrow.kind == ArrowKind::Moment).expect(joint);
            let about_z = *moment.values[..scene.dimensions * 2 - 3].last().expect("a value");
            assert!((about_z - 100.0).abs() < 1e-9, "{space} {joint}: {:?}", moment.values);
            assert_eq!(moment.body, 1, "{space} {joint}");
        }
    }
}

#[test]
fn springs_over_points_and_angles_have_places() {
    let text = "grashof: 1
name: springs
space: planar
gravity: none
bodies: { a: { bar: { length: 1 m, mass: 1 kg } }, b: { bar: { length: 1 m, mass: 1 kg } } }
joints: { O: { revolute: [ground, a.start] }, P: { revolute: [ground, b.start] } }
springs:
  shaft: { stretch: b.angle - a.angle, stiffness: 10 N m }
  rope: { stretch: \"hypot(b.end.x - a.end.x, b.end.y - a.end.y) - 10 cm\", stiffness: 10 N/m }
  foot: { stretch: a.end.y, stiffness: 10 N/m }
  odd: { stretch: a.end.y*b.angle, stiffness: 10 N/m }
start: { a.angle: 0 deg, b.angle: 60 deg }
studies: { still: { statics: { from: start } } }
";
    let scene = scenes_of(text, "still").remove(0).1;
    let kinds: Vec<_> = scene.links.iter().map(|link| (link.name.as_str(), link.kind)).collect();
    assert_eq!(kinds, [("shaft", LinkKind::Torsion), ("rope", LinkKind::Spring), ("foot", LinkKind::Spring)]);
    let mut bodies = [scene.links[1].a.body, scene.links[1].b.body];
    bodies.sort_unstable();
    assert_eq!((bodies, &scene.links[1].a.at), ([1, 2], &vec![1.0, 0.0]));
}
