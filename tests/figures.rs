//! Figures: their axes, and what they show beside the curves of their study.

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::model::{Document, Report, Selection};
use grashof::output::{
    Drawing, Figure, Film, FormKind, Pace, Shot, ShotOptions, Width, drawing, figures, moving_svg, render_drawing, render_figure,
};
use grashof::results::{By, Column, Results, Scene};
use grashof::studies::common::named::named;
use grashof::studies::loader::{Loader, NotLoaded};
use grashof::studies::sweep::{Drawn, Settings, at, single};

const PRESS: &str = "grashof: 1
name: press
space: planar
gravity: none
ground: { O: [0, 0] }
bodies: { crank: { bar: { length: 4 cm, mass: 1 kg } }, rod: { bar: { length: 16 cm, mass: 1 kg } }, ram: {} }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, ram.origin] }
  W: { slider: [ground.O, ram.origin], axis: [0, -1] }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 90 deg, rod.angle: ~-90 deg }
measures: { depth: W.position - 12 cm, rise: depth }
variants: { fast: { drivers: { drive: { speed: 120 rpm } } } }
studies:
  slow:
    inverse: { over: 1 turn, samples: 36 }
    columns: [depth, W.velocity]
    plot: { stroke: PLOT }
  fast: { variant: fast, inverse: { over: 1 turn, samples: 36 }, columns: [depth, W.velocity] }
";

/// The text with a figure, read with files beside it.
fn document(plot: &str) -> Result<Document, Report> {
    let files = |path: &str| match path {
        "lift.csv" => Ok((path.to_owned(), b"angle;lift\n90;0\n270;80\n".to_vec())),
        "bare.csv" => Ok((path.to_owned(), b"90;0\n270;80\n".to_vec())),
        _ => Err("there is no such file".to_owned()),
    };
    Document::with_files(PRESS.replace("PLOT", plot).as_bytes(), "press.yaml", &files)
}

fn results(plot: &str) -> Results {
    let document = document(plot).expect("a model");
    let selection = Selection { study: Some("slow"), ..Selection::default() };
    let model = Loader::new(&document, 1).drawn(&selection, &|| false).unwrap_or_else(|why| panic!("{why:?}"));
    let study = model.study.as_ref().expect("a study");
    let settings = Settings { threads: 1, drawn: Drawn::None, stop: &|| false };
    single(&model, study, at(&model, study, Vec::new(), settings, None, &|_, _| {})).unwrap_or_else(|failure| panic!("{failure:?}"))
}

fn figure(plot: &str) -> Figure {
    let (_, figure) = figures(&results(plot)).remove(0);
    render_figure(&figure).expect("a picture");
    figure
}

#[test]
fn axes_have_the_units_and_ends_that_are_asked_for() {
    let figure = figure(
        "{ show: [depth], x: { in: deg, from: 0 deg, to: 360 deg }, y: { in: mm, to: 100 mm }, right: { show: [W.velocity], in: mm/s } }",
    );
    assert_eq!((figure.x.unit.as_str(), figure.x.range), ("deg", [Some(0.0), Some(360.0)]));
    assert_eq!(figure.ranges, [("mm".to_owned(), [None, Some(100.0)])]);
    assert_eq!(figure.right.as_ref().map(|axis| (axis.label.as_str(), axis.unit.as_str())), Some(("W.velocity", "mm/s")));
    let [depth, velocity] = &figure.curves[..] else { panic!("two curves") };
    let most = depth.points.iter().map(|p| p.1).fold(0.0, f64::max);
    assert!((most - 80.0).abs() < 1e-6 && !depth.right && velocity.right, "{most}");
}

#[test]
fn axes_have_one_scale_where_they_are_coordinates_of_one_place() {
    // rows of lengths over lengths all the same
    for (plot, path) in [
        ("{ show: [crank.end.y], over: crank.end.x }", true),
        ("{ show: [com.y], over: com.x }", true),
        ("{ show: [depth], over: crank.end.x }", false),
        ("{ show: [rod.end.y], over: crank.end.x }", false),
    ] {
        assert_eq!(figure(plot).equal, path, "{plot}");
    }
}

#[test]
fn other_studies_and_measured_data_stand_beside() {
    let figure = figure("{ show: [depth], with: [fast], data: { measured: { file: lift.csv, x: angle, y: lift, in: [deg, mm] } } }");
    let labels: Vec<&str> = figure.curves.iter().map(|curve| curve.label.as_str()).collect();
    assert_eq!(labels, ["depth", "measured", "depth, fast"]);
    assert_eq!(figure.curves.iter().map(|curve| curve.dots).collect::<Vec<_>>(), [false, true, false]);
    // in the unit of the curve whose quantity it is
    assert!((figure.curves[1].points[1].0 - 270.0).abs() < 1e-9 && (figure.curves[1].points[1].1 - 0.08).abs() < 1e-12);
    assert_eq!(figure.curves[2].points.len(), 37);
}

#[test]
fn a_second_name_of_a_column_is_drawn() {
    let figure = figure("{ show: [rise], over: W.velocity }");
    assert_eq!((figure.curves.len(), figure.curves[0].points.len()), (1, 37));
}

#[test]
fn faults_of_figures_have_their_places() {
    let code = |plot: &str| {
        let document = document(plot).expect("a model");
        match Loader::new(&document, 1).drawn(&Selection { study: Some("slow"), ..Selection::default() }, &|| false) {
            Err(NotLoaded::Wrong(report)) => (report.diagnostics[0].code.to_owned(), report.diagnostics[0].line()),
            other => panic!("{plot}: {:?}", other.map(|_| ())),
        }
    };
    let wanted = [
        ("{ show: [depth], y: { in: deg } }", "wrong-dimension"),
        ("{ show: [depth], y: { from: 1 mm, to: 1 mm } }", "equal"),
        ("{ show: [depth], x: { from: 1 mm } }", "wrong-dimension"),
        ("{ show: [depth, W.velocity], right: { show: [drive.torque] } }", "wrong-plot"),
        ("{ show: [depth], with: [slow] }", "unknown-study"),
        ("{ show: [drive.torque], with: [fast] }", "no-column"),
        ("{ show: [depth], data: { m: { file: lost.csv } } }", "no-file"),
        ("{ show: [depth], data: { m: { file: bare.csv } } }", "bad-data"),
        ("{ show: [depth], data: { m: { file: lift.csv, y: force } } }", "no-column"),
        ("{ show: [depth], data: { m: { file: lift.csv, in: [mm, mm] } } }", "wrong-dimension"),
        ("{ show: [depth], data: { m: { file: lift.csv, of: rise } } }", "wrong-plot"),
    ];
    for (plot, wanted) in wanted {
        let (found, line) = code(plot);
        assert_eq!(line, 20, "{plot}: {found}");
        assert!(found == wanted || wanted == "equal", "{plot}: {found}");
    }
}

#[test]
fn energies_are_no_torques() {
    let text = "grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { bar: { bar: { length: 1 m, mass: 1 kg } } }
joints: { J: { revolute: [ground, bar.start] } }
loads: { push: { joint: J, torque: 1 N m } }
start: { J.angle: 0 deg, J.omega: 0 }
measures: { load: 1 N m, lost: energy.total - energy.kinetic, half: J.angle/2, more: 2*energy.kinetic - 1 J, per_angle: energy.kinetic/J.angle, per_half: energy.total/half, part: energy.total*J.angle/half }
studies:
  swing:
    dynamics: { until: 0.1 s }
    columns: [time, energy.kinetic, lost, load, J.m, more, per_angle, per_half, part]
    undefined: [per_angle, per_half, part]
    scalars: { most: max(energy.total), done: work_loads, largest: max(load), put_in: integral(load*J.omega), by_angle: max(energy.total)/max(abs(half)), of_mean: sqrt(mean(energy.total)*work_loads) }
";
    let model = common::model(text, Some("swing"));
    let study = model.study.clone().expect("the study");
    let results = named(&model, &study, common::study(text, "swing", Coordinates::Joint));
    let told = |quantity: &str, unit: &str| format!("{quantity} in {unit}");
    let columns: Vec<String> = results.table.columns.iter().map(|c| told(&c.quantity, c.shown().0)).collect();
    assert_eq!(
        columns,
        [
            "time in s",
            "energy in J",
            "energy in J",
            "torque in N m",
            "torque in N m",
            "energy in J",
            "torque in N m",
            "torque in N m",
            "energy in J"
        ]
    );
    let scalars: Vec<String> = results
        .scalars
        .iter()
        .filter(|s| s.by == By::File)
        .map(|s| told(&s.quantity, s.shown_in.as_ref().map_or(&s.unit, |u| &u.unit)))
        .collect();
    assert_eq!(scalars, ["energy in J", "energy in J", "torque in N m", "energy in J", "torque in N m", "energy in J"]);
}

/// The scene and the drawing of a study.
fn drawn(text: &str, name: &str) -> (Scene, Drawing) {
    let scene = common::study(text, name, Coordinates::Joint).scenes.remove(0).1;
    let drawing = drawing("m", name, "mechanism", &scene);
    (scene, drawing)
}

#[test]
fn the_arrow_of_a_driver_has_the_sense_of_its_rate() {
    let crank = |driver: &str, spatial: bool| {
        let space = if spatial { "spatial" } else { "planar" };
        format!(
            "grashof: 1
name: crank
space: {space}
gravity: none
bodies: {{ crank: {{ bar: {{ length: 6 cm, mass: 1 kg }} }} }}
joints: {{ A: {{ revolute: [ground, crank.start]{} }} }}
drivers: {{ drive: {{ joint: A, {driver} }} }}
studies:
  one: {{ kinematics: {{ over: 1 turn, samples: 20 }} }}
  three: {{ kinematics: {{ over: 3 turn, samples: 20 }} }}
  five: {{ kinematics: {{ over: 5 turn, samples: 20 }} }}
  seconds: {{ dynamics: {{ until: 5 s, every: 0.5 s }} }}
  times: {{ kinematics: {{ over: 5 s, samples: 20 }} }}
",
            if spatial { ", axis: [0, 0, 1]" } else { "" }
        )
    };
    let sense = |text: &str, name: &str| drawn(text, name).1.joints[0].poses[0].sense;
    for spatial in [false, true] {
        for (rpm, sign) in [(60, 1.0), (-60, -1.0), (-6000, -1.0)] {
            let text = crank(&format!("speed: {rpm} rpm"), spatial);
            for name in ["one", "three", "five", "seconds", "times"] {
                assert_eq!(sense(&text, name), sign, "{rpm} rpm, {name}, {spatial}");
            }
        }
    }
    // both ways, only forth, forth after a rest
    for (law, sign) in [
        ("angle: \"1 rad*sin(3 rad/s*t)\"", 0.0),
        ("angle: \"3 rad/s*t + 1 rad*sin(3 rad/s*t)\"", 1.0),
        ("rise: { by: -90 deg, during: 2 s, law: poly5 }", -1.0),
    ] {
        assert_eq!(sense(&crank(law, false), "times"), sign, "{law}");
    }
}

#[test]
fn paths_of_fast_points_are_the_arcs_that_they_run_through() {
    let wheel = |until: &str| {
        format!(
            "grashof: 1
name: wheel
space: planar
gravity: none
bodies: {{ wheel: {{ disc: {{ radius: 9 cm, mass: 1 kg }}, points: {{ rim: [9 cm, 0] }} }} }}
joints: {{ O: {{ revolute: [ground, wheel.origin] }} }}
start: {{ O.omega: 3000 rpm }}
studies: {{ spin: {{ dynamics: {{ until: {until}, every: {until} }}, columns: [wheel.rim] }} }}
"
        )
    };
    let (scene, drawing) = drawn(&wheel("0.5 s"), "spin");
    let middle = |ends: &[[f64; 2]]| (0.5 * (ends[0][0] + ends[1][0])).hypot(0.5 * (ends[0][1] + ends[1][1]));
    assert!(drawing.traces[0].points.windows(2).all(|ends| middle(ends) > 0.09 * 0.999), "{} places", drawing.traces[0].points.len());
    // in pictures that move, too
    let shot = |scene: &Scene, rate: f64| {
        let asked = ShotOptions { rate, pace: Pace::Duration(2.0), repeats: false };
        let independent = Column { name: "time".into(), unit: "s".into(), ..Column::default() };
        Shot::of(&Results { independent, ..Results::default() }, scene, &asked).expect("a shot")
    };
    let paths = |text: &str| {
        let (scene, _) = drawn(text, "spin");
        let shot = shot(&scene, 10.0);
        let svg = moving_svg(&Film::new("wheel", "spin", "mechanism", &scene, &shot), 400);
        let count = |line: &str| line.split("points=\"").nth(1).and_then(|of| of.split('"').next()).map_or(0, |of| of.split(' ').count());
        svg.lines().filter(|line| line.starts_with("<polyline stroke-dasharray")).map(count).collect::<Vec<_>>()
    };
    assert!(scene.traces.len() == 1 && paths(&wheel("0.5 s")).iter().all(|count| *count > 2500), "{:?}", paths(&wheel("0.5 s")));
    // 5000 turns would fill the picture
    assert!(drawn(&wheel("100 s"), "spin").1.traces.is_empty() && paths(&wheel("100 s")).is_empty());
}

#[test]
fn pale_positions_cover_the_cycle_of_the_mechanism() {
    // a crank that turns once while what drives it turns three and a third times
    let text = |turns: f64| {
        format!(
            "grashof: 1
name: geared crank
space: planar
gravity: none
ground: {{ M: [-26 cm, 0], W: [0, 0], R: [0, 0] }}
bodies:
  pinion: {{ disc: {{ radius: 6 cm, mass: 2 kg }} }}
  crank: {{ disc: {{ radius: 20 cm, mass: 20 kg }}, points: {{ pin: [9 cm, 0] }} }}
  rod: {{ bar: {{ length: 40 cm, mass: 1 kg }} }}
  ram: {{ mass: 1 kg }}
joints:
  M: {{ revolute: [ground.M, pinion.origin] }}
  W: {{ revolute: [ground.W, crank.origin] }}
  A: {{ revolute: [crank.pin, rod.start] }}
  B: {{ revolute: [rod.end, ram.origin] }}
  G: {{ slider: [ground.R, ram.origin], axis: [1, 0] }}
couplings: {{ mesh: {{ gear: [M, W], ratio: -6/20 }} }}
drivers: {{ motor: {{ joint: M, speed: 200 rpm }} }}
start: {{ W.angle: 0 deg, rod.angle: ~0 deg }}
studies:
  turns: {{ kinematics: {{ over: {turns} turn, samples: 50 }} }}
"
        )
    };
    for turns in [2.0, 10.0 / 3.0, 10.0, 12.0] {
        let scene = drawn(&text(turns), "turns").0;
        let of = |index: usize| scene.frame(index)[5].abs().to_degrees();
        let shown: Vec<f64> = scene.frames.shown.iter().map(|index| of(*index) - of(scene.frames.shown[0])).map(f64::abs).collect();
        // the whole of what is less than a cycle, else one
        let whole = if turns == 2.0 { 216.0 * 6.0 / 5.0 } else { 360.0 };
        assert!(
            shown.len() == 6 && shown.iter().enumerate().all(|(k, at)| (at - whole * k as f64 / 6.0).abs() < 6.0),
            "{turns}: {shown:?}"
        );
    }
}

#[test]
fn torques_in_space_turn_about_their_axes() {
    let text = "grashof: 1
name: torques
space: spatial
gravity: none
bodies: { a: { ball: { radius: 5 cm, mass: 1 kg } } }
joints: { O: { spherical: [ground, a.origin] } }
loads: { tx: { at: a.origin, torque: [1 N m, 0, 0] }, tz: { at: a.origin, torque: [0, 0, -4 N m] } }
studies: { go: { dynamics: { until: 1 ms, every: 1 ms }, show: [loads], view: top } }
";
    let model = common::model(text, Some("go"));
    let study = model.study.clone().expect("a study");
    let settings = Settings { threads: 1, drawn: Drawn::All, stop: &|| false };
    let results = single(&model, &study, at(&model, &study, Vec::new(), settings, None, &|_, _| {})).unwrap_or_else(|f| panic!("{f:?}"));
    let forces = drawing("m", "go", "mechanism", &results.scenes[0].1).forces;
    // from above what turns about x is seen as a line, what turns about z as a circle, clockwise where that points down
    let area = |k: usize| forces[k].across[0][0] * forces[k].across[1][1] - forces[k].across[0][1] * forces[k].across[1][0];
    assert_eq!(forces.iter().map(|f| f.turning).collect::<Vec<_>>(), [Some(1.0), Some(4.0)]);
    assert!(area(0).abs() < 1e-9 && (area(1) + 1.0).abs() < 1e-9, "{} {}", area(0), area(1));
}

#[test]
fn a_guide_ends_with_the_body_that_carries_it() {
    let text = "grashof: 1
name: rail
space: planar
gravity: none
bodies: { rail: { bar: { length: 70 cm, mass: 12 kg } }, carriage: { mass: 6 kg, inertia: 1 kg m^2 } }
joints: { C: { revolute: [ground, rail.start] }, S: { slider: [rail.start, carriage.origin], axis: [1, 0] } }
drivers: { pump: { joint: S, rise: { by: 48 cm, during: 8 s, law: poly5 } }, hold: { joint: C, angle: 0 deg } }
start: { S.position: 20 cm }
studies: { lift: { kinematics: { over: 8 s, samples: 20 } } }
";
    let drawing = drawn(text, "lift").1;
    let slide = drawing.joints.iter().find(|joint| joint.name == "S").expect("the slide").poses[0];
    let (Some([from, to]), Some(([start, end], true))) = (slide.way, slide.carrier) else { panic!("{slide:?}") };
    assert!((to[0] - from[0] - 0.48).abs() < 1e-9 && start == [0.0; 2] && (end[0] - 0.7).abs() < 1e-12, "{slide:?}");
    // width, begin and end of the strokes; the guide is the widest of all
    let svg = render_drawing(&drawing).expect("a picture").svg;
    let after = |line: &str, name: &str| line.split(name).nth(1).map(|rest| rest.split('"').next().unwrap_or_default().to_owned());
    let stroke = |line: &str| {
        let points = after(line, "points=\"")?;
        let x: Vec<f64> = points.split(' ').filter_map(|point| point.split(',').next()?.parse().ok()).collect();
        Some((after(line, "stroke-width=\"")?.parse::<f64>().ok()?, x[0], *x.get(1)?))
    };
    let strokes = svg.lines().filter_map(stroke);
    let reach = |(width, _, end): (f64, f64, f64)| end + 0.5 * width;
    let guide = strokes.clone().max_by(|a, b| a.0.total_cmp(&b.0)).expect("strokes");
    let rail = strokes.filter(|(width, ..)| *width > 10.0).min_by(|a, b| a.1.total_cmp(&b.1)).expect("the rail");
    assert!(guide.0 > rail.0 && (reach(guide) - reach(rail)).abs() < 4.0, "{guide:?}, {rail:?}: {svg}");
}

/// At whatever ends of cylinder and rod the model names it: the slide is at the mouth of the cylinder, and its way is what of the rod passes there.
#[test]
fn a_rod_slides_in_the_mouth_of_its_cylinder() {
    for (slider, position) in
        [("[barrel.start, rod.start]", "20 cm"), ("[barrel.start, rod.end]", "90 cm"), ("[barrel.end, rod.start]", "-50 cm")]
    {
        let text = format!(
            "grashof: 1
name: cylinder
space: planar
gravity: none
bodies: {{ barrel: {{ bar: {{ length: 70 cm, mass: 12 kg }} }}, rod: {{ bar: {{ length: 70 cm, mass: 6 kg }} }} }}
joints: {{ C: {{ revolute: [ground, barrel.start] }}, S: {{ slider: {slider}, axis: [1, 0] }} }}
drivers: {{ pump: {{ joint: S, rise: {{ by: 45 cm, during: 8 s, law: poly5 }} }}, hold: {{ joint: C, angle: 0 deg }} }}
start: {{ S.position: {position} }}
studies: {{ lift: {{ kinematics: {{ over: 8 s, samples: 20 }} }} }}
"
        );
        let drawing = drawn(&text, "lift").1;
        let slide = drawing.joints.iter().find(|joint| joint.name == "S").expect("the slide").poses[0];
        let mouth = slide.at[0];
        let (Some([from, to]), Some((ends, true))) = (slide.way, slide.carrier) else { panic!("{slide:?}") };
        assert!(slide.at[1].abs() < 1e-12 && ((from[0] - to[0]).abs() - 0.45).abs() < 1e-9, "{slider}: {slide:?}");
        assert!((mouth - 0.7).abs() < 1e-12, "{slider}: {slide:?}");
        let [low, high] = [ends[0][0].min(ends[1][0]), ends[0][0].max(ends[1][0])];
        assert!((low - 0.2).abs() < 1e-12 && (high - 0.9).abs() < 1e-12, "{slider}: {slide:?}");
        assert!([from, to].iter().all(|end| (low - 1e-9..=high + 1e-9).contains(&end[0])), "{slider}: {slide:?}");
    }
}

/// Its rod is thinner and lies in it, wherever the model begins with one of them and however that stands.
#[test]
fn a_cylinder_is_seen_around_its_rod() {
    for angle in ["0 deg", "37 deg", "131 deg"] {
        let text = format!(
            "grashof: 1
name: cylinder
space: planar
gravity: none
bodies:
  rod: {{ mass: 6 kg, inertia: 1 kg m^2, drawn: [[-0.7 m, 0], [0, 0]] }}
  barrel: {{ bar: {{ length: 70 cm, mass: 12 kg }} }}
joints: {{ C: {{ revolute: [ground, barrel.start] }}, S: {{ slider: [barrel.start, rod.origin], axis: [1, 0] }} }}
drivers: {{ pump: {{ joint: S, rise: {{ by: 45 cm, during: 8 s, law: poly5 }} }}, hold: {{ joint: C, angle: {angle} }} }}
start: {{ S.position: 90 cm }}
studies: {{ lift: {{ kinematics: {{ over: 8 s, samples: 20 }} }} }}
"
        );
        let drawing = drawn(&text, "lift").1;
        let form = |name: &str| drawing.bodies.iter().find(|body| body.name == name).expect("a body").poses[0][0].clone();
        let width = |name: &str| if let FormKind::Bar { width, .. } = form(name).kind { Some(width) } else { None };
        assert_eq!([width("barrel"), width("rod")], [Some(Width::Drawn(0)), Some(Width::Drawn(1))], "{angle}");
        assert!(form("barrel").depth > form("rod").depth && form("rod").depth == 0.0, "{angle}");
        // the arrow of what drives it shows where the rod goes
        let slide = drawing.joints.iter().find(|joint| joint.name == "S").expect("the slide").poses[0];
        let (sin, cos) = angle.trim_end_matches(" deg").parse::<f64>().expect("an angle").to_radians().sin_cos();
        let ahead = slide.along[0] * cos + slide.along[1] * sin;
        assert!(slide.sense * ahead > 0.99, "{angle}: {slide:?}");
    }
}

/// However a leg leans towards the eye, its rod ends behind its cylinder, not in front of it.
#[test]
fn a_cylinder_in_space_hides_what_of_its_rod_is_in_it() {
    for (turned, view) in [("0 deg", "top"), ("180 deg", "top"), ("90 deg", "[60 deg, 20 deg]"), ("-90 deg", "[60 deg, 20 deg]")] {
        let text = format!(
            "grashof: 1
name: leg
space: spatial
gravity: none
bodies:
  cylinder: {{ mass: 1 kg, inertia: 1 kg m^2, drawn: [[0, 0, 0], [0, 0, 0.9 m]] }}
  rod: {{ mass: 1 kg, inertia: 1 kg m^2, drawn: [[0, 0, -0.6 m], [0, 0, 0]] }}
joints:
  C: {{ fixed: [ground, cylinder.origin], rpy: [0, {turned}, 0] }}
  S: {{ slider: [cylinder.origin, rod.origin], axis: [0, 0, 1] }}
drivers: {{ pump: {{ joint: S, rise: {{ by: 20 cm, during: 8 s, law: poly5 }} }} }}
start: {{ S.position: 1.2 m }}
studies: {{ lift: {{ kinematics: {{ over: 8 s, samples: 20 }}, view: {view} }} }}
"
        );
        let drawing = drawn(&text, "lift").1;
        let depth = |name: &str| drawing.bodies.iter().find(|body| body.name == name).expect("a body").poses[0][0].depth;
        assert!(depth("cylinder") > depth("rod"), "{turned} {view}: {} {}", depth("cylinder"), depth("rod"));
    }
}

#[test]
fn no_outline_hides_a_bearing() {
    // on the disc itself, on another body with an outline, and behind a body that only passes
    let passing = "other: { drawn: [[-1 m, -1 m], [1 m, -1 m], [1 m, 1 m], [-1 m, 1 m]], mass: 1 kg, inertia: 1 kg m^2 }";
    let disc = "wheel: { disc: { radius: 20 cm, mass: 2 kg } }";
    let outline = "wheel: { drawn: [[-1 m, -1 m], [1 m, -1 m], [1 m, 1 m], [-1 m, 1 m]], mass: 1 kg, inertia: 1 kg m^2 }";
    let bar = "wheel: { bar: { length: 2 m, mass: 1 kg } }";
    for bodies in [disc.to_owned(), outline.to_owned(), format!("{disc}, {passing}"), format!("{bar}, {passing}")] {
        let more = if bodies.contains("other") { "W: { slider: [ground, other.origin], axis: [1, 0] }" } else { "" };
        let point = if bodies.contains("bar") { "start" } else { "origin" };
        let text = format!(
            "grashof: 1
name: wheel
space: planar
gravity: none
bodies: {{ {bodies} }}
joints: {{ O: {{ revolute: [ground, wheel.{point}] }}, {more} }}
start: {{ O.omega: 1 rad/s }}
studies: {{ go: {{ dynamics: {{ until: 1 s, every: 0.5 s }} }} }}
"
        );
        let svg = render_drawing(&drawn(&text, "go").1).expect("a picture").svg;
        let lines: Vec<&str> = svg.lines().collect();
        // the last disc or area, and no sign
        let value = |line: &str, key: &str| line.split(&format!(" {key}=\"")).nth(1).and_then(|of| of.split('"').next()).map(str::to_owned);
        let wide = |line: &&str| {
            let corners = value(line, "points").filter(|_| line.starts_with("<polygon")).unwrap_or_default();
            let numbers: Vec<f64> = corners.split([' ', ',']).filter_map(|x| x.parse().ok()).collect();
            let span = |k: usize| {
                let of = numbers.iter().skip(k).step_by(2);
                of.clone().copied().fold(f64::NEG_INFINITY, f64::max) - of.copied().fold(f64::INFINITY, f64::min)
            };
            let radius = value(line, "r").filter(|_| line.starts_with("<circle")).and_then(|r| r.parse::<f64>().ok());
            radius.is_some_and(|r| r > 40.0) || (span(0) > 100.0 && span(1) > 100.0)
        };
        let outline = lines.iter().rposition(wide).expect("an outline");
        let bearing = lines.iter().position(|line| line.contains("#eeeeee")).expect("a bearing");
        assert!(bearing > outline, "{bodies}: {bearing}, {outline}: {svg}");
    }
}
