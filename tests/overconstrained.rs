//! Mechanisms that move although their count of freedoms forbids it, in any direction of space: the rows of what is redundant are
//! round-off, and constrain nothing; small rows that are none do.

use crate::common::{Noise, State, columns, mechanism, model};
use grashof::dynamics::Dynamics;
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::survey::{Survey, survey};
use grashof::mechanism::Coordinates;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run_in;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Bodies 0 (the ground) to n in a row of joints; places and axes as drawn, m, in axes common to all bodies.
#[derive(Clone, Debug)]
struct Linkage {
    joints: Vec<Joint>,
    /// Centres of the moving bodies.
    centres: Vec<Vector3<f64>>,
    /// Entries of the model beside them.
    more: String,
}

#[derive(Clone, Debug)]
struct Joint {
    bodies: [usize; 2],
    kind: &'static str,
    place: Vector3<f64>,
    axis: Vector3<f64>,
}

impl Joint {
    fn new(bodies: [usize; 2], kind: &'static str, place: Vector3<f64>, axis: Vector3<f64>) -> Self {
        Self { bodies, kind, place, axis }
    }
}

impl Linkage {
    fn new(joints: Vec<Joint>, centres: Vec<Vector3<f64>>) -> Self {
        Self { joints, centres, more: String::new() }
    }

    fn with(mut self, more: &str) -> Self {
        self.more += more;
        self
    }

    /// Turned by a rotation and moved, then all lengths multiplied.
    fn placed(mut self, r: Rotation3<f64>, by: Vector3<f64>, size: f64) -> Self {
        for joint in &mut self.joints {
            (joint.place, joint.axis) = (size * (r * joint.place + by), r * joint.axis);
        }
        self.centres.iter_mut().for_each(|c| *c = size * (r * *c + by));
        self
    }

    /// Somewhere in space, by a seed; every third one keeps its origin.
    fn anywhere(self, seed: u64) -> Self {
        let mut noise = Noise(seed + 1);
        let [w, i, j, k] = [(); 4].map(|()| noise.next());
        let r = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k)).to_rotation_matrix();
        let by = if seed.is_multiple_of(3) { Vector3::zeros() } else { Vector3::from_fn(|_, _| noise.next()) };
        self.placed(r, by, 1.0)
    }

    /// The same with another kind of some joints.
    fn kinds(mut self, kinds: &[(usize, &'static str)]) -> Self {
        kinds.iter().for_each(|&(joint, kind)| self.joints[joint].kind = kind);
        self
    }

    fn text(&self, unit: &str) -> String {
        let per = if unit == "mm" { 1e3 } else { 1.0 };
        let vector = |v: Vector3<f64>| format!("[{:?} {unit}, {:?} {unit}, {:?} {unit}]", per * v.x, per * v.y, per * v.z);
        let name = |body: usize| if body == 0 { "ground".to_string() } else { format!("b{body}") };
        let points = |body: usize| {
            let on = self.joints.iter().enumerate().filter(|(_, j)| j.bodies.contains(&body));
            on.map(|(i, j)| format!("p{i}: {}", vector(j.place))).collect::<Vec<_>>().join(", ")
        };
        let mut text =
            format!("grashof: 1\nname: linkage\nspace: spatial\ngravity: [0, 0, -9.81 m/s^2]\nground: {{ {} }}\nbodies:\n", points(0));
        for (i, c) in self.centres.iter().enumerate() {
            let b = i + 1;
            let inertia = format!("[{}, {}, {}, 0.01, -0.02, 0.005]", 0.11 + 0.02 * b as f64, 0.15, 0.12);
            let mass = format!("mass: {}, com: {}, inertia: {inertia}", 1.0 + 0.3 * b as f64, vector(*c));
            writeln!(text, "  b{b}: {{ {mass}, points: {{ {} }} }}", points(b)).unwrap();
        }
        text += "joints:\n";
        for (i, j) in self.joints.iter().enumerate() {
            let [a, b] = j.bodies.map(name);
            let axis =
                if j.kind == "spherical" { String::new() } else { format!(", axis: [{:?}, {:?}, {:?}]", j.axis.x, j.axis.y, j.axis.z) };
            writeln!(text, "  j{i}: {{ {}: [{a}.p{i}, {b}.p{i}]{axis} }}", j.kind).unwrap();
        }
        let reactions: Vec<String> = (0..self.joints.len()).map(|i| format!("j{i}.f, j{i}.m")).collect();
        let x = self.coordinate();
        let all = format!("time, {x}, com, frame, frame.mx, frame.my, frame.mz, {}", reactions.join(", "));
        text += &self.more;
        let fall = |more: &str| format!("dynamics: {{ until: 0.4 s, every: 40 ms{more} }}, columns: [{all}]");
        writeln!(text, "studies:").unwrap();
        for (name, more) in [
            ("fall", ", tolerance: 1e-10"),
            ("minimal", ", coordinates: minimal, tolerance: 1e-10"),
            ("implicit", ", integrator: radau5, tolerance: 1e-11"),
            ("multistep", ", integrator: bdf, tolerance: 1e-11"),
            ("steps", ", integrator: generalized-alpha, step: 2 ms"),
        ] {
            writeln!(text, "  {name}: {{ {} }}", fall(more)).unwrap();
        }
        writeln!(text, "  rest: {{ statics: {{ from: start }}, columns: [{all}] }}").unwrap();
        writeln!(text, "  modes: {{ modes: {{ at: statics }} }}").unwrap();
        writeln!(text, "  about: {{ linearize: {{ at: start }} }}").unwrap();
        writeln!(text, "  move: {{ inverse: {{ over: 1 s, samples: 10 }}, columns: [{all}] }}").unwrap();
        text
    }

    /// The coordinate of the first joint.
    fn coordinate(&self) -> &'static str {
        if self.joints[0].kind == "slider" { "j0.position" } else { "j0.angle" }
    }

    fn mass(&self) -> f64 {
        (1..=self.centres.len()).map(|b| 1.0 + 0.3 * b as f64).sum()
    }
}

/// What the first joint has in tests of falling: a spring, so that there is a rest near the start.
const SPRING: &str = "springs: { s: { joint: j0, stiffness: 30, rest: 0.2 } }\n";
/// What it has in tests of driven motion.
fn driver(linkage: &Linkage) -> String {
    let law = if linkage.coordinate() == "j0.position" { "position: 0.1 m*sin(2*t/(1 s))" } else { "angle: 0.2*sin(2*t/(1 s))" };
    format!("drivers: {{ drive: {{ joint: j0, {law} }} }}\n")
}

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

/// A door on hinges that lie on one axis.
fn door(hinges: usize) -> Linkage {
    let hinge = |i: usize| Joint::new([0, 1], "revolute", v(0.3, 0.2, 0.1 + 0.7 * i as f64), v(0.0, 0.0, 1.0));
    Linkage::new((0..hinges).map(hinge).collect(), vec![v(0.8, 0.3, 0.9)])
}

/// A box on slides that are parallel.
fn drawer(slides: usize) -> Linkage {
    let slide = |i: usize| Joint::new([0, 1], "slider", v(0.1, 0.4 * i as f64, 0.2), v(1.0, 0.0, 0.0));
    Linkage::new((0..slides).map(slide).collect(), vec![v(0.3, 0.2, -0.1)])
}

/// A closed loop of four revolutes.
fn loop_of(places: [Vector3<f64>; 4], axes: [Vector3<f64>; 4]) -> Linkage {
    let joint = |i: usize| Joint::new([i, (i + 1) % 4], "revolute", places[i], axes[i]);
    let centre = |i: usize| 0.5 * (places[i] + places[i + 1]) + v(0.03, 0.05, -0.04);
    Linkage::new((0..4).map(joint).collect(), (0..3).map(centre).collect())
}

/// A four-bar in a plane: parallel axes, joints at different heights.
fn planar() -> Linkage {
    loop_of([v(0.0, 0.0, 0.1), v(0.2, 0.5, -0.1), v(1.1, 0.8, 0.3), v(1.0, -0.1, 0.0)], [v(0.0, 0.0, 1.0); 4])
}

/// A four-bar on a sphere: axes that meet in the origin.
fn spherical() -> Linkage {
    let axes = [v(0.1, 0.0, 1.0), v(0.5, 0.2, 0.9), v(0.6, 1.0, 0.7), v(-0.2, 0.9, 0.5)].map(|a: Vector3<f64>| a.normalize());
    loop_of([0.7 * axes[0], 0.9 * axes[1], 0.8 * axes[2], 1.1 * axes[3]], axes)
}

/// Bennett's linkage: opposite links alike, sin α/a = sin β/b, tan(θ₁/2) tan(θ₂/2) = sin((β + α)/2)/sin((β − α)/2)
/// (G. T. Bennett, Engineering 76 (1903) 777-778; in Denavit and Hartenberg's frames).
fn bennett() -> Linkage {
    let (a, alpha, beta) = (0.5_f64, 0.6_f64, 1.3_f64);
    let b = a * beta.sin() / alpha.sin();
    let first = 1.1_f64;
    let second = 2.0 * ((0.5 * (beta + alpha)).sin() / (0.5 * (beta - alpha)).sin() / (0.5 * first).tan()).atan();
    let turn = |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(angle * axis);
    let (mut r, mut p) = (Rotation3::identity(), Vector3::zeros());
    let (mut places, mut axes) = (Vec::new(), Vec::new());
    for (theta, length, twist) in [(first, a, alpha), (second, b, beta), (TAU - first, a, alpha), (TAU - second, b, beta)] {
        places.push(p);
        axes.push(r * Vector3::z());
        r *= turn(Vector3::z(), theta);
        p += r * (length * Vector3::x());
        r *= turn(Vector3::x(), twist);
    }
    assert!(p.norm() < 1e-14 && r.angle() < 1e-7, "the loop closes: {p}, {}", r.angle());
    loop_of([places[0], places[1], places[2], places[3]], [axes[0], axes[1], axes[2], axes[3]])
}

/// The linkages with a twin of the same motion that has no redundant rows, and their numbers of redundant rows.
fn linkages() -> Vec<(&'static str, Linkage, Linkage, usize)> {
    let twin = |l: Linkage| l.kinds(&[(2, "cylindrical"), (3, "spherical")]);
    vec![
        ("door on two hinges", door(2), door(1), 5),
        ("door on three hinges", door(3), door(1), 10),
        ("drawer", drawer(2), drawer(1), 5),
        ("drawer on three slides", drawer(3), drawer(1), 10),
        ("planar four-bar", planar(), twin(planar()), 3),
        ("spherical four-bar", spherical(), twin(spherical()), 3),
        ("Bennett's linkage", bennett(), twin(bennett()), 3),
    ]
}

fn surveyed(text: &str) -> Survey {
    let model = model(text, None);
    survey(&model, &parameters(&model)).unwrap_or_else(|f| panic!("{}", f.reason()))
}

/// A study of a text, run to its end.
#[track_caller]
fn study(text: &str, name: &str, coordinates: Coordinates) -> Outcome {
    let model = model(text, Some(name));
    let study = model.study.clone().expect("the study");
    let outcome = run_in(Case::new(&model, &study, &parameters(&model)), coordinates, &|| false);
    let outcome = outcome.unwrap_or_else(|f| panic!("{name}: {}\n{text}", f.reason()));
    assert_eq!(outcome.stopped, None, "{name} stopped\n{text}");
    outcome
}

/// A column of a study by its name.
fn column(text: &str, name: &str, outcome: &Outcome, of: &str) -> Vec<f64> {
    let c = columns(text, of).iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name} in {:?}", columns(text, of)));
    outcome.rows.iter().map(|r| r[c]).collect()
}

#[track_caller]
fn near(what: &str, found: &[f64], right: &[f64], tolerance: f64) {
    assert_eq!(found.len(), right.len(), "{what}: rows");
    let size = right.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    let off = found.iter().zip(right).fold(0.0, |m: f64, (f, r)| if (f - r).abs() <= m { m } else { (f - r).abs() });
    assert!(off <= tolerance * size, "{what}: off by {off:e} of {size:e}\n found {found:?}\n right {right:?}");
}

/// Motion and what acts on the frame are those of a twin, the reactions are finite and balance the motion.
fn alike(what: &str, linkage: &Linkage, text: &str, found: &Outcome, twin: (&str, &Outcome), of: &str, tolerance: f64) {
    for name in [linkage.coordinate(), "com.x", "com.y", "com.z", "frame.fx", "frame.fy", "frame.fz", "frame.mx", "frame.my", "frame.mz"] {
        let right = column(twin.0, name, twin.1, of);
        near(&format!("{what}, {of}, {name}"), &column(text, name, found, of), &right, tolerance);
    }
    // what the frame feels is the weight less the inertia
    for (axis, g) in [("x", 0.0), ("y", 0.0), ("z", -9.81)] {
        let a = if of == "rest" { vec![0.0; found.rows.len()] } else { column(text, &format!("com.a{axis}"), found, of) };
        let right: Vec<f64> = a.iter().map(|a| linkage.mass() * (g - a)).collect();
        near(&format!("{what}, {of}, balance along {axis}"), &column(text, &format!("frame.f{axis}"), found, of), &right, 1e-9);
    }
    for joint in 0..linkage.joints.len() {
        for size in ["f", "m"] {
            let sizes = column(text, &format!("j{joint}.{size}"), found, of);
            assert!(sizes.iter().all(|x| *x < 1e4), "{what}, {of}: j{joint}.{size} is {sizes:?}");
        }
    }
}

#[test]
fn they_have_the_freedom_that_they_have() {
    for seed in 0..6 {
        for (what, linkage, _, redundant) in linkages() {
            let linkage = linkage.anywhere(seed);
            for unit in ["m", "mm"] {
                for (size, place) in [(1.0, 1.0), (1e-3, 1.0), (1e3, 1.0), (1.0, 1e3)] {
                    let linkage = linkage.clone().placed(Rotation3::identity(), v(place - 1.0, 0.0, place - 1.0), size);
                    let free = surveyed(&linkage.text(unit)).mobility;
                    let at = format!("{what}, seed {seed}, {unit}, {size}, {place}: {free:?}");
                    assert_eq!((free.freedom, free.left, free.redundant.len()), (1, 1, redundant), "{at}");
                    let driven = surveyed(&linkage.clone().with(&driver(&linkage)).text(unit)).mobility;
                    assert_eq!((driven.freedom, driven.left, driven.redundant.len()), (1, 0, redundant), "{at}: {driven:?}");
                }
            }
        }
    }
}

#[test]
fn they_fall_like_their_twins_without_redundant_rows() {
    for seed in 0..3 {
        for (what, linkage, twin, _) in linkages() {
            let of = |l: &Linkage| l.clone().with(SPRING).anywhere(seed);
            let (linkage, twin) = (of(&linkage), of(&twin));
            let (text, twin) = (linkage.text("m"), twin.text("m"));
            // beside its path Bennett's linkage is a structure, and E bears what the stages of a step are off it
            let within = if what.starts_with("Bennett") { 100.0 } else { 1.0 };
            let what = format!("{what}, seed {seed}");
            let right = study(&twin, "fall", Coordinates::Joint);
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                let found = study(&text, "fall", coordinates);
                alike(&what, &linkage, &text, &found, (&twin, &right), "fall", within * 1e-8);
                let march = found.certificate.march.clone().expect("a motion");
                assert!(march.energy_drift < within * 1e-8 && march.velocity < 1e-10, "{what}: {march:?}");
            }
            for (scheme, tolerance) in [("minimal", 1e-8), ("implicit", 1e-7), ("multistep", 1e-6), ("steps", 1e-6)] {
                let (found, right) = (study(&text, scheme, Coordinates::Joint), study(&twin, scheme, Coordinates::Joint));
                alike(&what, &linkage, &text, &found, (&twin, &right), scheme, within * tolerance);
            }
        }
    }
}

#[test]
fn they_rest_and_vibrate_like_their_twins() {
    for seed in 0..3 {
        for (what, linkage, twin, _) in linkages() {
            let of = |l: &Linkage| l.clone().with(SPRING).anywhere(seed);
            let (linkage, twin) = (of(&linkage), of(&twin));
            let (text, twin) = (linkage.text("m"), twin.text("m"));
            let what = format!("{what}, seed {seed}");
            let right = study(&twin, "rest", Coordinates::Joint);
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                alike(&what, &linkage, &text, &study(&text, "rest", coordinates), (&twin, &right), "rest", 1e-7);
            }
            let modes =
                |text: &str| study(text, "modes", Coordinates::Joint).lists.into_iter().find(|l| l.name == "eigenvalues").expect("a list");
            near(&what, &modes(&text).values, &modes(&twin).values, 1e-7);
            let linear = |text: &str| study(text, "about", Coordinates::Joint).linear.expect("a system");
            let (found, right) = (linear(&text), linear(&twin));
            assert_eq!(found.states, right.states, "{what}");
            near(&what, &found.matrices[0].1.concat(), &right.matrices[0].1.concat(), 1e-7);
        }
    }
}

#[test]
fn they_are_driven_like_their_twins() {
    for seed in 0..3 {
        for (what, linkage, twin, _) in linkages() {
            let of = |l: &Linkage| l.clone().with(&driver(l)).anywhere(seed);
            let (linkage, twin) = (of(&linkage), of(&twin));
            let (text, twin) = (linkage.text("m"), twin.text("m"));
            let what = format!("{what}, seed {seed}");
            let right = study(&twin, "move", Coordinates::Joint);
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                let found = study(&text, "move", coordinates);
                alike(&what, &linkage, &text, &found, (&twin, &right), "move", 1e-9);
                assert!(found.certificate.constraint < 1e-12 && found.certificate.power_balance < 1e-9, "{what}: {:?}", found.certificate);
            }
            // driven in time, too
            let right = study(&twin, "fall", Coordinates::Joint);
            alike(&what, &linkage, &text, &study(&text, "fall", Coordinates::Joint), (&twin, &right), "fall", 1e-8);
        }
    }
}

#[test]
fn entries_are_no_larger_than_their_natural_sizes() {
    fn check<G: Space<S = f64>>(text: &str) {
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let m = mechanism::<G>(text, coordinates);
            let mut d = Dynamics::new(&m);
            for seed in 0..10 {
                State::random(&m, seed).evaluate(&mut d);
                let natural = d.natural();
                for ((i, _), (g, natural)) in natural.pattern().places().zip(d.work.g.values().iter().zip(natural.values())) {
                    let row = m.name_of_row(i);
                    assert!(g.abs() <= natural * (1.0 + 1e-12), "{row}: {g:e} {natural:e}");
                    assert!(*natural < 1e3 * g.abs().max(1.0), "{row}: {g:e} {natural:e}");
                }
            }
        }
    }
    check::<Planar<f64>>(include_str!("common/planar.yaml"));
    check::<Spatial<f64>>(include_str!("common/spatial.yaml"));
}

#[test]
fn small_rows_that_are_no_round_off_hold() {
    // hinges that are not quite in line lock a door
    for seed in 0..3 {
        for (size, off) in [(1.0, 1e-3), (1.0, 1e-6), (1.0, 1e-7), (1e-2, 1e-6), (1e3, 1e-3)] {
            let mut door = door(2).with("start: { j0.omega: ~1 rad/s }\n");
            door.joints[1].place.x += off / size;
            let text = door.placed(Rotation3::identity(), Vector3::zeros(), size).anywhere(seed).text("mm");
            let free = surveyed(&text).mobility;
            assert_eq!((free.freedom, free.redundant.len()), (0, 4), "{size} {off}: {free:?}");
            // round-off of a place is as much of an angle as the hinges are off: where that is small no tolerance below it is met
            for of in if off / size < 1e-3 { &["fall"][..] } else { &["fall", "implicit", "multistep"] } {
                let angle = column(&text, "j0.angle", &study(&text, of, Coordinates::Joint), of);
                assert!(angle.iter().all(|a| a.abs() < 1e-8), "{size} {off}, {of}: {angle:?}");
            }
        }
    }
}

#[test]
fn a_crank_as_short_as_a_micrometre_drives() {
    for seed in 0..3 {
        let [p, q] = [v(0.0, 0.0, 1e-3), v(11e-3, 8e-3, 3e-3)];
        let crank = loop_of([p, p + v(1e-6, 0.0, 0.0), q, v(10e-3, -1e-3, 0.0)], [v(0.0, 0.0, 1.0); 4]);
        let driver = "drivers: { drive: { joint: j0, speed: 60 rpm } }\n";
        let text = crank.with(driver).anywhere(seed).text("mm").replace("com, frame", "j3.angle, com, frame");
        assert_eq!(surveyed(&text).mobility.freedom, 1);
        let rocker = column(&text, "j3.angle", &study(&text, "move", Coordinates::Joint), "move");
        let range = rocker.iter().fold(f64::MIN, |m, x| m.max(*x)) - rocker.iter().fold(f64::MAX, |m, x| m.min(*x));
        // the rocker of length c swings by the throw of the crank across the coupler: 2 r/(c sin of the angle between them)
        let (coupler, arm): (Vector3<f64>, Vector3<f64>) = (v(11e-3, 8e-3, 0.0), v(1e-3, 9e-3, 0.0));
        let right = 2e-6 * coupler.norm() / coupler.cross(&arm).norm();
        assert!((range / right - 1.0).abs() < 0.06, "{range:e} {right:e}");
    }
}

/// A parallelogram that turns fully, started at an angle from its flat position.
fn parallelogram(from: f64) -> String {
    format!(
        "grashof: 1\nname: parallelogram\nspace: planar\ngravity: [0, -9.81 m/s^2]\nground: {{ A0: [0, 0], A1: [1 m, 0] }}\nbodies:\n\
         \x20 left: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n  coupler: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n\
         \x20 right: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\njoints:\n  A0: {{ revolute: [ground.A0, left.start] }}\n\
         \x20 B0: {{ revolute: [left.end, coupler.start] }}\n  B1: {{ revolute: [coupler.end, right.end] }}\n\
         \x20 A1: {{ revolute: [ground.A1, right.start] }}\n\
         start: {{ A0.angle: {from:?} rad, coupler.angle: ~0, right.angle: ~{from:?} rad, A0.omega: -4 rad/s }}\n\
         studies:\n  fall: {{ dynamics: {{ until: 10 s, every: 10 ms, tolerance: 1e-10 }}, columns: [time, left.omega] }}\n"
    )
}

#[test]
fn a_start_near_a_singular_position_keeps_its_energy() {
    for from in [0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1] {
        let text = parallelogram(from);
        if from >= 1e-6 {
            assert_eq!(surveyed(&text).mobility.freedom, 1, "{from}");
        }
        let march = study(&text, "fall", Coordinates::Joint).certificate.march.expect("a motion");
        println!("{from:e}: {:e}", march.energy_drift);
        assert!(march.energy_drift < 1e-6, "{from:e}: {march:?}");
    }
}
