//! Random mechanisms begin alike in all coordinates and with any joint cut: poses, twists, energy, exact values and guesses.

use crate::common::{Noise, assembled, close, spin, vector};
use grashof::dynamics::Dynamics;
use grashof::geometry::{Planar, Pose, Space, Spatial, basis};
use grashof::kinematics::assemble::Assembled;
use grashof::mechanism::{Coordinates, Mechanism};
use std::f64::consts::PI;

/// A random mechanism: joint sections without a cut, and the rest of the file.
#[derive(Clone)]
struct Random {
    head: String,
    joints: Vec<String>,
    start: String,
}

impl Random {
    /// The text with the joint `cut` kept off the tree.
    fn text(&self, cut: Option<usize>) -> String {
        let joints: String = self
            .joints
            .iter()
            .enumerate()
            .map(|(k, joint)| if cut == Some(k) { joint.replace(" }\n", ", cut: true }\n") } else { joint.clone() })
            .collect();
        format!("{}joints:\n{joints}start:\n{}", self.head, self.start)
    }
}

fn list(noise: &mut Noise, n: usize) -> String {
    let numbers: Vec<String> = (0..n).map(|_| noise.next().to_string()).collect();
    format!("[{}]", numbers.join(", "))
}

/// A number from 0 to n − 1.
fn index(noise: &mut Noise, n: usize) -> usize {
    ((0.5 * (noise.next() + 1.0) * n as f64) as usize).min(n - 1)
}

/// Kinds with the coordinates that a start can give of them.
const PLANAR: [(&str, &[&str]); 3] = [("revolute", &["angle"]), ("slider", &["position"]), ("fixed", &[])];
const SPATIAL: [(&str, &[&str]); 8] = [
    ("revolute", &["angle"]),
    ("slider", &["position"]),
    ("cylindrical", &["angle", "position"]),
    ("planar", &["x", "y", "angle"]),
    ("screw", &["angle"]),
    ("universal", &["angle1", "angle2"]),
    ("spherical", &[]),
    ("fixed", &[]),
];

/// The rate of a coordinate.
fn rate(coordinate: &str) -> String {
    match coordinate {
        "position" => "velocity".into(),
        "x" | "y" => format!("v{coordinate}"),
        angle => angle.replace("angle", "omega"),
    }
}

/// A tree of bodies with random joints; some coordinates and rates are given, exactly or guessed.
fn tree(planar: bool, seed: u64) -> Random {
    let mut noise = Noise(seed);
    let n = if planar { 2 } else { 3 };
    let bodies = 2 + index(&mut noise, 3);
    let mut head = format!(
        "grashof: 1\nname: random\nspace: {}\ngravity: none\nground: {{ P: {} }}\nbodies:\n",
        if planar { "planar" } else { "spatial" },
        list(&mut noise, n)
    );
    let (mut joints, mut start) = (Vec::new(), String::new());
    for b in 0..bodies {
        let inertia = if planar { "0.3" } else { "[0.3, 0.4, 0.5]" };
        let [p, q, com] = [0; 3].map(|_| list(&mut noise, n));
        head += &format!("  b{b}: {{ mass: 2, com: {com}, inertia: {inertia}, points: {{ P: {p}, Q: {q} }} }}\n");
        let (kind, coordinates) = if planar { PLANAR[index(&mut noise, 3)] } else { SPATIAL[index(&mut noise, 8)] };
        let parent = index(&mut noise, b + 1);
        let parent = if parent == 0 { "ground".to_string() } else { format!("b{}", parent - 1) };
        // either body may be named first
        let ends = if noise.next() > 0.0 { format!("[{parent}.P, b{b}.Q]") } else { format!("[b{b}.Q, {parent}.P]") };
        let mut joint = format!("  j{b}: {{ {kind}: {ends}");
        match kind {
            "universal" => joint += ", axes: [[0, 0.6, 0.8], [1, 0, 0]]",
            "screw" => joint += &format!(", pitch: 0.2, axis: {}", list(&mut noise, n)),
            "spherical" | "fixed" => {}
            "revolute" if planar => {}
            _ => joint += &format!(", axis: {}", list(&mut noise, n)),
        }
        if !planar && kind != "universal" && noise.next() > -0.5 {
            let angles: Vec<String> = (0..3).map(|_| (PI * noise.next()).to_string()).collect();
            joint += &format!(", rpy: [{}]", angles.join(", "));
        }
        joints.push(joint + " }\n");
        for coordinate in coordinates {
            let sign = if noise.next() > 0.0 { "" } else { "~" };
            if noise.next() > -0.2 {
                start += &format!("  j{b}.{coordinate}: {sign}{}\n", 4.0 * noise.next());
            }
            if noise.next() > 0.2 && !matches!(*coordinate, "x" | "y") {
                start += &format!("  j{b}.{}: {sign}{}\n", rate(coordinate), noise.next());
            }
        }
    }
    if start.is_empty() {
        start = "  b0.vx: ~0.3\n".into();
    }
    Random { head, joints, start }
}

/// Positions, axes and twists of all bodies, and the kinetic energy.
fn state<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled) -> Vec<f64> {
    let mut d = Dynamics::new(m);
    d.terms(0.0, &start.q, &start.v, &start.modes);
    let mut out = vec![d.kinetic_energy()];
    for ((body, place), twist) in d.work.places.iter().enumerate().zip(&d.work.twists) {
        let pose = d.pose(body);
        out.extend(vector::<G>(pose.p));
        (0..G::VECTOR).for_each(|k| out.extend(vector::<G>(G::rotate(pose.r, basis::<G>(k)))));
        out.extend(spin::<G>(twist.w));
        out.extend(vector::<G>(twist.at(place.p)));
    }
    out
}

/// All ways to set up a mechanism begin alike, and meet what is asked of them.
fn alike<G: Space<S = f64>>(random: &Random, what: &str) {
    let (m, start) = assembled::<G>(&random.text(None), Coordinates::Joint);
    let right = state(&m, &start);
    let cuts = (0..random.joints.len()).map(Some).map(|cut| (cut, Coordinates::Joint));
    for (cut, coordinates) in [(None, Coordinates::Cartesian), (None, Coordinates::Bounded(2))].into_iter().chain(cuts) {
        let (other, begun) = assembled::<G>(&random.text(cut), coordinates);
        let what = format!("{what} with {cut:?} cut in {coordinates:?} coordinates\n{}", random.text(cut));
        close(&what, &state(&other, &begun), &right, 1e-11);
        let values = |start: &Assembled| start.found.iter().map(|f| f.found).collect::<Vec<f64>>();
        close(&what, &values(&begun), &values(&start), 1e-11);
        let mut d = Dynamics::new(&other);
        d.time(0.0, &begun.modes);
        d.position(&begun.q, &begun.modes);
        close(&what, &d.work.phi, &vec![0.0; other.rows.len()], 1e-11);
    }
    // forces have no part in a start, but for what the search for the nearest position leaves: the root of round-off
    let last = m.bodies.len() - 2;
    let springs = format!(
        "springs: {{ S: {{ between: [b{last}.P, b0.Q], stiffness: 1 }}, T: {{ between: [b{last}.P, ground.P], stiffness: 1 }} }}\n"
    );
    let pulled = Random { head: random.head.replacen("bodies:\n", &format!("{springs}bodies:\n"), 1), ..random.clone() };
    let (other, begun) = assembled::<G>(&pulled.text(None), Coordinates::Joint);
    close(&format!("{what} with springs"), &state(&other, &begun), &right, 1e-6);
    for found in &start.found {
        let off = if found.guess { 0.0 } else { found.found - found.asked };
        assert!(off.abs() < 1e-11, "{what}: {found:?}");
    }
}

#[test]
fn open_mechanisms_begin_alike() {
    for seed in 0..60 {
        alike::<Planar<f64>>(&tree(true, seed), &format!("planar tree {seed}"));
        alike::<Spatial<f64>>(&tree(false, seed), &format!("spatial tree {seed}"));
    }
}

/// The mechanism with one loop more: the point Q of the last body meets a point of the ground where it is at a random pose.
fn looped<G: Space<S = f64>>(mut random: Random, seed: u64) -> Option<Random> {
    let mut noise = Noise(seed + 1000);
    let (m, _) = assembled::<G>(&random.text(None), Coordinates::Joint);
    let mut q = m.drawn();
    m.retract(&mut q, &noise.vector(m.nv).iter().map(|x| 0.6 * x).collect::<Vec<_>>());
    let mut d = Dynamics::new(&m);
    d.position(&q, &m.modes());
    let last = m.bodies.len() - 1;
    let at: Vec<String> =
        vector::<G>(d.point(last, m.bodies[last].points.iter().find(|(n, _)| n == "P")?.1)).iter().map(ToString::to_string).collect();
    random.head = random.head.replace("ground: {", &format!("ground: {{ Z: [{}],", at.join(", ")));
    let kind = match (G::VECTOR, seed % 2) {
        (_, 0) => "distance: [ground.Z, bN.P], length: 0.7",
        (2, _) => "revolute: [ground.Z, bN.P]",
        _ => "spherical: [ground.Z, bN.P]",
    };
    random.joints.push(format!("  z: {{ {} }}\n", kind.replace('N', &(last - 1).to_string())));
    // the loop is to be closed by what is open: nothing is exact
    random.start = random.start.replace(": ~", ": ").replace(": ", ": ~");
    Some(random)
}

#[test]
fn closed_mechanisms_begin_alike() {
    let mut closed = 0;
    for seed in 0..60 {
        if let Some(random) = looped::<Planar<f64>>(tree(true, seed), seed)
            && assembles::<Planar<f64>>(&random)
        {
            alike::<Planar<f64>>(&random, &format!("planar loop {seed}"));
            closed += 1;
        }
        if let Some(random) = looped::<Spatial<f64>>(tree(false, seed), seed)
            && assembles::<Spatial<f64>>(&random)
        {
            alike::<Spatial<f64>>(&random, &format!("spatial loop {seed}"));
            closed += 1;
        }
    }
    assert!(closed > 80, "{closed} of 120");
}

/// Whether a mechanism has a start at all; some random loops cannot be closed.
fn assembles<G: Space<S = f64>>(random: &Random) -> bool {
    let model = crate::common::model(&random.text(None), None);
    grashof::kinematics::assemble::assemble::<G>(&model, &grashof::studies::common::case::parameters(&model), Coordinates::Joint).is_ok()
}

/// Guesses of all coordinates of a pose on the constraints are met.
#[test]
fn guesses_that_can_be_met_are_met() {
    let mut met = 0;
    for seed in 0..60 {
        let Some(mut random) = looped::<Spatial<f64>>(tree(false, seed), seed) else { continue };
        if !assembles::<Spatial<f64>>(&random) {
            continue;
        }
        // somewhere on the constraints, where the random guesses lead to
        let (m, start) = assembled::<Spatial<f64>>(&random.text(None), Coordinates::Joint);
        let mut d = Dynamics::new(&m);
        d.time(0.0, &start.modes);
        d.position(&start.q, &start.modes);
        d.velocity(&start.v, &start.modes);
        d.watch(&start.q, &start.v, &start.modes);
        let mut asked = String::new();
        for (joint, of) in m.joints.iter().zip(random.joints.iter()) {
            let kind = SPATIAL.iter().find(|(kind, _)| of.contains(&format!("{kind}:")));
            for (coordinate, &slot) in kind.map_or(&[][..], |(_, c)| c).iter().zip(&joint.slots) {
                asked += &format!("  {}.{coordinate}: ~{}\n", joint.name, d.work.readings[slot].x);
            }
        }
        if asked.is_empty() {
            continue;
        }
        random.start = asked;
        // a loop that is refused with its axes the wrong way round passes no guess over in silence
        if !assembles::<Spatial<f64>>(&random) {
            continue;
        }
        let (_, start) = assembled::<Spatial<f64>>(&random.text(None), Coordinates::Joint);
        for found in &start.found {
            assert!((found.found - found.asked).abs() < 1e-9, "loop {seed}: {found:?}\n{}", random.text(None));
        }
        met += 1;
    }
    assert!(met > 30, "{met}");
}

/// A rotation about any axis by any angle is the one that is asked for, on a free body and on a ball joint, in all coordinates.
#[test]
fn an_exact_rotation_is_that_rotation() {
    let mut noise = Noise(5);
    for _ in 0..40 {
        let (axis, angle) = (noise.vector(3), PI * noise.next());
        for joint in ["", "joints: { J: { revolute: [ground, a.origin] }, K: { spherical: [a.origin, b.origin] } }\n"] {
            let text = format!(
                "grashof: 1\nname: turned\nspace: spatial\ngravity: none\nbodies: {{ a: {{ mass: 1, inertia: [1, 1, 1] }}, b: {{ mass: 1, inertia: [1, 1, 1] }} }}\n{joint}start: {{ b.rotation: {{ axis: {axis:?}, angle: {angle} rad }} }}\n"
            );
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                let (m, start) = assembled::<Spatial<f64>>(&text, coordinates);
                let mut d = Dynamics::new(&m);
                d.position(&start.q, &start.modes);
                let Pose { r, .. } = d.pose(2);
                let axis = nalgebra::Unit::new_normalize(nalgebra::Vector3::from_column_slice(&axis));
                let right = nalgebra::Rotation3::from_axis_angle(&axis, angle);
                for (i, k) in (0..3).flat_map(|i| (0..3).map(move |k| (i, k))) {
                    assert!((Spatial::<f64>::entry(r, i, k) - right[(i, k)]).abs() < 1e-12, "{angle} about {axis:?}\n{text}");
                }
                let [about, beside] = &start.found[..] else { panic!("{:?}", start.found) };
                assert!((about.found - angle).abs() < 1e-12 && beside.found < 1e-12, "{:?}", start.found);
            }
        }
    }
}
