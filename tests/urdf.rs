//! Robots from URDF: what a file says is what the mechanism does, what it cannot mean is refused at its line, and nothing is
//! dropped in silence.
//!
//! `tests/urdf/refused/NAME.urdf` is refused with the text of `NAME.txt` beside it, `tests/urdf/NAME.urdf` becomes `NAME.yaml`.
//! After an intended change: `GRASHOF_BLESS=1 cargo test --test all urdf`, then read the difference.

mod words;

use crate::common::Noise;
use grashof::dynamics::Dynamics;
use grashof::geometry::Spatial;
use grashof::mechanism::{Coordinates, Mechanism, Step, build};
use grashof::model::{Document, Import, Imported, Selection, import};
use grashof::studies::common::case::parameters;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/urdf")
}

fn bytes(name: &str) -> Vec<u8> {
    fs::read(directory().join(name)).unwrap()
}

fn imported(name: &str, asked: &Import) -> Imported {
    import(&bytes(name), name, asked).unwrap_or_else(|report| panic!("{report}"))
}

/// A model that may include the files of `tests/urdf`.
fn document(text: &str) -> Document {
    let files = |name: &str| fs::read(directory().join(name)).map(|bytes| (name.to_owned(), bytes)).map_err(|error| error.to_string());
    Document::with_files(text.as_bytes(), "model.yaml", &files).unwrap_or_else(|report| panic!("{report}"))
}

fn mechanism(document: &Document, coordinates: Coordinates) -> Mechanism<Spatial<f64>> {
    let model = document.model(&Selection::default()).unwrap_or_else(|report| panic!("{report}"));
    build(&model, &parameters(&model), coordinates).unwrap_or_else(|faults| panic!("{faults:?}"))
}

fn import_mechanism(name: &str) -> Mechanism<Spatial<f64>> {
    mechanism(&Document::read(&imported(name, &Import::default()).text, name).unwrap(), Coordinates::Joint)
}

fn grashof(arguments: &[&str], input: &str) -> Output {
    use std::io::Write;
    let mut child = Command::new(env!("CARGO_BIN_EXE_grashof"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

fn scratch(name: &str) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("grashof-urdf-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// The joint or body of a name.
fn index<T>(list: &[T], name: impl Fn(&T) -> &str, wanted: &str) -> usize {
    list.iter().position(|item| name(item) == wanted).unwrap_or_else(|| panic!("no {wanted}"))
}

/// First coordinate of a joint on the tree.
fn coordinate(m: &Mechanism<Spatial<f64>>, joint: &str) -> usize {
    let joint = &m.joints[index(&m.joints, |j| &j.name, joint)];
    first_coordinate(&m.steps[m.nodes[joint.tree.unwrap().0].steps.start])
}

fn first_coordinate(step: &Step<Spatial<f64>>) -> usize {
    match step {
        Step::Axis { q, .. } | Step::Ball { q, .. } => *q,
    }
}

/// An origin of a URDF, after its definition: roll, pitch, yaw about fixed axes.
fn origin(xyz: [f64; 3], [r, p, y]: [f64; 3]) -> Isometry3<f64> {
    let turn = |axis: Vector3<f64>, angle| UnitQuaternion::from_scaled_axis(axis * angle);
    let turned = turn(Vector3::z(), y) * turn(Vector3::y(), p) * turn(Vector3::x(), r);
    Isometry3::from_parts(Translation3::from(Vector3::from(xyz)), turned)
}

fn turned(axis: [f64; 3], angle: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::identity(), UnitQuaternion::from_scaled_axis(Vector3::from(axis).normalize() * angle))
}

fn moved(axis: [f64; 3], by: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(Vector3::from(axis).normalize() * by), UnitQuaternion::identity())
}

/// Asserts that a body stands at a pose, by three of its points.
fn stands(dynamics: &Dynamics<'_, Spatial<f64>>, body: &str, pose: Isometry3<f64>) {
    let body = index(&dynamics.mechanism.bodies, |b| &b.name, body);
    for point in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        let found = dynamics.point(body, nalgebra::SVector::from(point));
        let expected = pose * nalgebra::Point3::from(Vector3::from(point));
        for (x, y) in found.iter().zip(expected.coords.iter()) {
            assert!((x - y).abs() < 1e-14, "{}: {found:?} {expected:?}", dynamics.mechanism.bodies[body].name);
        }
    }
}

#[test]
fn every_kind_of_joint_places_its_link_where_the_definition_does() {
    let m = import_mechanism("kinds.urdf");
    let mut noise = Noise(3);
    for _ in 0..5 {
        let (hinge, wheel, sled) = (noise.next() * 3.0, noise.next() * 9.0, noise.next());
        let mut q = m.drawn();
        (q[coordinate(&m, "hinge")], q[coordinate(&m, "wheel_joint")], q[coordinate(&m, "x")]) = (hinge, wheel, sled);
        let mut dynamics = Dynamics::new(&m);
        dynamics.time(0.0, &m.modes());
        dynamics.position(&q, &m.modes());
        let hinged = origin([0.1, 0.2, 0.3], [0.3, -0.4, 1.2]) * turned([1.0, 2.0, -3.0], hinge);
        let slid = hinged * origin([-0.2, 0.0, 0.1], [std::f64::consts::FRAC_PI_2, 0.0, 2.0]) * moved([0.5, 0.0, 0.5], sled);
        stands(&dynamics, "root", Isometry3::identity());
        stands(&dynamics, "hinged", hinged);
        stands(&dynamics, "wheel", hinged * origin([0.0, 0.0, 0.5], [3.1, 0.2, -2.5]) * turned([0.0, -2.0, 0.0], wheel));
        stands(&dynamics, "sled", slid);
        stands(&dynamics, "welded", slid * origin([0.0, 0.1, 0.0], [-2.2, 1.0, 0.7]));
        stands(&dynamics, "puck", origin([0.0, 0.0, 1.0], [0.0, 0.5, 0.0]));
        stands(&dynamics, "ball", origin([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
    }
    let freedom = |name: &str| m.joints[index(&m.joints, |j| &j.name, name)].freedom;
    assert_eq!(["hinge", "wheel_joint", "x", "weld", "slide", "socket", "mount"].map(freedom), [1, 1, 1, 0, 3, 3, 0]);
    // the floating joint is none: its link is free
    assert!(m.joints.iter().all(|joint| joint.name != "air"));
    assert_eq!(m.nv, 3 + 3 + 3 + 6);
}

/// The star tree measures the joints by cosines and slides instead of coordinates: the same mechanism by other means.
#[test]
fn turned_joints_hold_as_rows_too() {
    let tree = import_mechanism("kinds.urdf");
    let text = imported("kinds.urdf", &Import::default()).text;
    let star = mechanism(&Document::read(&text, "kinds").unwrap(), Coordinates::Cartesian);
    let (mut on_tree, mut cut) = (Dynamics::new(&tree), Dynamics::new(&star));
    let mut q = tree.drawn();
    (q[coordinate(&tree, "hinge")], q[coordinate(&tree, "x")]) = (0.7, 0.2);
    on_tree.time(0.0, &tree.modes());
    on_tree.position(&q, &tree.modes());
    let mut placed = star.drawn();
    for node in &star.nodes {
        let body = node.body;
        let at = |x: [f64; 3]| on_tree.point(body, nalgebra::SVector::from(x));
        let o = at([0.0; 3]);
        let r = Matrix3::from_columns(&[at([1.0, 0.0, 0.0]) - o, at([0.0, 1.0, 0.0]) - o, at([0.0, 0.0, 1.0]) - o]);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&r));
        // a free body: three slides, then a quaternion w, x, y, z
        let first = star.steps[node.steps.start..node.steps.end].iter().map(first_coordinate).min().unwrap();
        for i in 0..3 {
            placed[first + i] = o[i];
            placed[first + 4 + i] = turn.vector()[i];
        }
        placed[first + 3] = turn.w;
    }
    cut.time(0.0, &star.modes());
    cut.position(&placed, &star.modes());
    let worst = cut.work.phi.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(cut.work.phi.len() >= 30 && worst < 1e-14, "{} rows, {worst}", cut.work.phi.len());
}

#[test]
fn inertial_frames_are_turned_into_the_axes_of_the_link() {
    let m = import_mechanism("kinds.urdf");
    let body = &m.bodies[index(&m.bodies, |b| &b.name, "hinged")];
    let r = origin([0.0; 3], [0.4, -0.5, 0.6]).rotation.to_rotation_matrix().into_inner();
    let given = Matrix3::new(0.03, 0.002, -0.001, 0.002, 0.04, 0.003, -0.001, 0.003, 0.05);
    let expected = r * given * r.transpose();
    for (found, expected) in body.mass.inertia.iter().zip(expected.iter()) {
        assert!((found - expected).abs() < 1e-16);
    }
    assert_eq!(body.mass.mass, 2.0);
    assert_eq!(body.mass.com.as_slice(), [0.1, -0.2, 0.3]);
}

/// About a fixed axis u through O: (u·J_O u) q̈ = u·(r × m g), with J_O by Steiner and r the way from O to the centre of mass.
#[test]
fn a_pendulum_about_a_skew_axis_is_the_physical_pendulum() {
    let m = import_mechanism("skew.urdf");
    let u = Vector3::new(2.0, 1.0, 0.5).normalize();
    let d = Vector3::new(0.3, -0.1, -0.4);
    let mass = 2.5;
    let r = origin([0.0; 3], [0.5, 0.6, -0.7]).rotation.to_rotation_matrix().into_inner();
    let inner = r * Matrix3::new(0.02, 0.001, -0.002, 0.001, 0.03, 0.004, -0.002, 0.004, 0.035) * r.transpose();
    let about = inner + mass * (Matrix3::identity() * d.norm_squared() - d * d.transpose());
    let inertia = u.dot(&(about * u));
    let mut dynamics = Dynamics::new(&m);
    for angle in [0.0, 0.4, -1.7, 3.0] {
        dynamics.terms(0.0, &[angle], &[1.3], &m.modes());
        let pose = origin([0.2, 0.1, 1.0], [0.9, -0.8, 0.7]) * turned([2.0, 1.0, 0.5], angle);
        let torque = (pose.rotation * u).dot(&(pose.rotation * d).cross(&Vector3::new(0.0, 0.0, -9.81 * mass)));
        assert!((dynamics.work.mass.at(0, 0) - inertia).abs() < 1e-14);
        assert!((dynamics.work.force[0] - torque).abs() < 1e-13, "{} {torque}", dynamics.work.force[0]);
    }
}

#[test]
fn followers_move_as_their_multipliers_and_offsets_say() {
    let text = "grashof: 1
name: followers
space: spatial
gravity: none
include: { urdf: mimic.urdf }
drivers: { drive: { joint: turn, speed: 1 rad/s } }
start: { turn.angle: 30 deg }
measures:
  back_gap: back.angle - (-0.5*turn.angle + 0.2)
  slide_gap: slide.position - (0.03 m*turn.angle - 0.01 m)
  spin_gap: spin.angle - 40/(1 m)*slide.position
  second_gap: second.position - slide.position
studies:
  turn:
    inverse: { over: 1 s, samples: 20 }
    expect:
      max(back_gap) - min(back_gap): { is: 0, within: 1e-13 }
      max(slide_gap) - min(slide_gap): { is: 0 m, within: 1e-14 m }
      max(spin_gap) - min(spin_gap): { is: 0, within: 1e-12 }
      max(second_gap) - min(second_gap): { is: 0 m, within: 1e-14 m }
      # a gap that stays is none, for this is 0
      'value(abs(back_gap) + abs(slide_gap)/(1 m) + abs(spin_gap) + abs(second_gap)/(1 m), 0.5 s)': { is: 0, within: 1e-12 }
      last(turn.angle): { is: 30 deg + 1 rad, within: 1e-13 }
";
    let directory = scratch("mimic");
    fs::write(directory.join("model.yaml"), text).unwrap();
    fs::write(directory.join("mimic.urdf"), bytes("mimic.urdf")).unwrap();
    let model = directory.join("model.yaml");
    let output = grashof(&["run", &model.to_string_lossy(), "--no-plots", "-o", &directory.to_string_lossy()], "");
    assert!(output.status.success(), "{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let _ = fs::remove_dir_all(directory);
}

/// Two arms of a file, each with its prefix and place, closed to a five-bar linkage by a joint of the model.
#[test]
fn one_file_twice_closed_by_a_joint() {
    let text = "grashof: 1
name: five-bar
space: spatial
gravity: [0, 0, -9.81]
parameters: { distance: 30 cm }
include:
  - { urdf: two_bars.urdf, prefix: left_ }
  - { urdf: two_bars.urdf, prefix: right_, at: [distance, 0, 0] }
joints:
  close: { spherical: [left_end, right_end], cut: true }
start: { left_hip.angle: -110 deg, right_hip.angle: -70 deg, left_knee.angle: ~80 deg, right_knee.angle: ~-80 deg }
studies:
  fall:
    dynamics: { until: 0.3 s, integrator: dop853, tolerance: 1e-9 }
    columns: [time, left_end.x, left_end.z, right_end.x, right_end.z, energy]
    expect:
      max(energy.total) - min(energy.total): { is: 0 J, within: 1e-8 J }
      max(left_end.x - right_end.x) - min(left_end.x - right_end.x): { is: 0 m, within: 1e-9 m }
      max(left_end.z - right_end.z) - min(left_end.z - right_end.z): { is: 0 m, within: 1e-9 m }
      'value(left_end.x - right_end.x, 0.1 s)': { is: 0 m, within: 1e-9 m }
      'value(left_end.z - right_end.z, 0.1 s)': { is: 0 m, within: 1e-9 m }
      # by symmetry the end stays in the middle
      last(left_end.x): { is: distance/2, within: 1e-9 m }
";
    let directory = scratch("twice");
    fs::write(directory.join("model.yaml"), text).unwrap();
    fs::write(directory.join("two_bars.urdf"), bytes("two_bars.urdf")).unwrap();
    let model = directory.join("model.yaml").to_string_lossy().into_owned();
    // a parameter of the model moves the second robot
    for set in ["distance=30 cm", "distance=25 cm"] {
        let output = grashof(&["run", &model, "--no-plots", "--set", set, "-o", &directory.to_string_lossy()], "");
        assert!(output.status.success(), "{set}: {}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    }
    let _ = fs::remove_dir_all(directory);
    let same = text.replace("prefix: right_, ", "prefix: left_, ");
    let files = |name: &str| Ok((name.to_owned(), bytes(name)));
    let refused = Document::with_files(same.as_bytes(), "model.yaml", &files).unwrap_err();
    assert_eq!(refused.diagnostics[0].code, "duplicate-name");
    assert_eq!((refused.diagnostics[0].line(), refused.diagnostics[0].file.as_str()), (8, "model.yaml"));
}

/// Importing and including are one translation: the same numbers to the bit.
#[test]
fn an_import_is_the_model_that_an_include_gives() {
    for name in ["kinds.urdf", "skew.urdf", "two_bars.urdf", "mimic.urdf"] {
        let written = Document::read(&imported(name, &Import { stops: true, ..Import::default() }).text, name).unwrap();
        let text = format!("grashof: 1\nname: n\nspace: spatial\ngravity: [0, 0, -9.81]\ninclude: {{ urdf: {name}, stops: true }}\n");
        let (a, b) = (mechanism(&written, Coordinates::Joint), mechanism(&document(&text), Coordinates::Joint));
        assert_eq!((a.nq, a.nv, a.rows.len()), (b.nq, b.nv, b.rows.len()));
        let (mut x, mut y) = (Dynamics::new(&a), Dynamics::new(&b));
        let mut noise = Noise(5);
        for _ in 0..3 {
            let mut q = a.drawn();
            a.retract(&mut q, &noise.vector(a.nv));
            let v = noise.vector(a.nv);
            x.terms(0.0, &q, &v, &a.modes());
            y.terms(0.0, &q, &v, &b.modes());
            assert_eq!((&x.work.mass, &x.work.force, &x.work.phi), (&y.work.mass, &y.work.force, &y.work.phi));
        }
    }
}

#[test]
fn a_free_base_begins_where_it_is_put() {
    let text = "grashof: 1
name: thrown
space: spatial
gravity: [0, 0, -9.81]
include: { urdf: kinds.urdf, base: free, at: [1 m, 20 cm, -3], rpy: [30 deg, -0.4, 2] }
";
    let m = mechanism(&document(text), Coordinates::Joint);
    let root = index(&m.bodies, |b| &b.name, "root");
    let r = m.orientations.iter().find(|asked| asked.body == root).unwrap().matrix;
    let base = origin([1.0, 0.2, -3.0], [30f64.to_radians(), -0.4, 2.0]);
    let expected = base.rotation.to_rotation_matrix();
    for i in 0..3 {
        for j in 0..3 {
            assert!((r[i][j] - expected[(i, j)]).abs() < 1e-14);
        }
    }
    let at = |name: &str| m.starts.iter().find(|start| start.name == name).unwrap().value;
    assert_eq!(["root.x", "root.y", "root.z"].map(at), [1.0, 0.2, -3.0]);
    // the floating joint's link stands beside the hinged one, in the turned robot
    let hinged = base * origin([0.1, 0.2, 0.3], [0.3, -0.4, 1.2]) * origin([2.0, 0.0, 0.0], [0.0, 0.3, 0.0]);
    for (found, expected) in ["loose.x", "loose.y", "loose.z"].map(at).into_iter().zip(hinged.translation.vector.iter()) {
        assert!((found - expected).abs() < 1e-14);
    }
    assert_eq!(m.nv, 6 + 3 + 3 + 3 + 6);
}

/// The hinge ends at 2 rad; its effort of 5 N m presses it 0.01 rad into the stop, so that 0.004 rad take 2 N m.
#[test]
fn stops_press_back_by_the_effort_at_their_depth() {
    let text = imported("kinds.urdf", &Import { stops: true, ..Import::default() }).text;
    assert!(text.contains("limits: { from: -1 rad, to: 2 rad, stiffness: 500 N m/rad }"), "{text}");
    // without an effort
    assert!(text.contains("limits: { from: 0.1 m, to: 0.4 m, stiffness: 100000 N/m }"), "{text}");
    let directory = scratch("stops");
    let hinge = r#"<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="hinge" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="2" effort="5" velocity="3"/></joint></robot>"#;
    let model = "grashof: 1
name: stop
space: spatial
gravity: none
include: { urdf: hinge.urdf, stops: true }
drivers: { hold: { joint: hinge, angle: 2.004 rad } }
start: { hinge.angle: 2.004 rad }
studies: { hold: { inverse: { over: 1 s, samples: 4 }, expect: { max(hold.torque): { is: 2 N m, within: 1e-9 N m } } } }
";
    fs::write(directory.join("model.yaml"), model).unwrap();
    fs::write(directory.join("hinge.urdf"), hinge).unwrap();
    let output = grashof(&["run", &directory.join("model.yaml").to_string_lossy(), "--no-plots", "-o", &directory.to_string_lossy()], "");
    assert!(output.status.success(), "{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let _ = fs::remove_dir_all(directory);
}

#[test]
fn the_command_writes_a_file_that_runs() {
    let directory = scratch("command");
    let out = directory.join("skew.yaml").to_string_lossy().into_owned();
    let output = grashof(&["import", "tests/urdf/skew.urdf", "-o", &out], "");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());
    // never over somebody's work
    let again = grashof(&["import", "tests/urdf/skew.urdf", "-o", &out], "");
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("cannot write"));
    let run = grashof(&["run", &out, "--no-plots", "-o", &directory.join("results").to_string_lossy()], "");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    // stdin to stdout is the same text but for the file's name
    let text = String::from_utf8(bytes("skew.urdf")).unwrap();
    let piped = grashof(&["import", "-"], &text);
    let written = fs::read_to_string(&out).unwrap();
    assert_eq!(String::from_utf8_lossy(&piped.stdout).replace("<stdin>", "skew.urdf"), written);
    let missing = grashof(&["import", "nowhere.urdf"], "");
    assert_eq!(missing.status.code(), Some(2));
    // remarks go to stderr
    let odd = grashof(&["import", "tests/urdf/odd.urdf"], "");
    assert!(String::from_utf8_lossy(&odd.stderr).contains("note: tests/urdf/odd.urdf:15: `<collision>`, once: not used\n"));
    assert!(grashof(&["import", "tests/urdf/odd.urdf", "--quiet"], "").stderr.is_empty());
    let _ = fs::remove_dir_all(directory);
}

#[test]
fn what_is_not_used_is_listed_by_check_and_counted_by_run() {
    let check = grashof(&["check", "models/arm.yaml", "--json"], "");
    let json: serde_json::Value = serde_json::from_slice(&check.stdout).unwrap();
    let notes: Vec<&str> = json["notes"].as_array().unwrap().iter().filter_map(|note| note.as_str()).collect();
    for part in [
        "`<collision>`, once",
        "`<transmission>`, once",
        "position limits",
        "effort 60 N m",
        "finger.stl",
        "`left-finger` is `left_finger`",
    ] {
        assert!(notes.iter().any(|note| note.starts_with("models/arm.urdf:") && note.contains(part)), "{part}: {notes:?}");
    }
}
