//! Legs of platforms made by chance: a start that is drawn closed at the angles that drive it stands there.
//!
//! Hinges that drivers turn far from how they are drawn carry a plate, and a leg goes from the ground to it. The leg is drawn where it
//! has to be, by forward kinematics of the chain: all of its coordinates are 0. In the other assembly of a leg with a universal joint it
//! stands half a turn about its own length off.

use super::dice::Dice;
use super::motion::moved;
use super::{between, cases, seeded, share, tell};
use nalgebra::{Rotation3, Unit, Vector3};
use std::fmt::Write;

fn place(dice: &mut Dice) -> Vector3<f64> {
    Vector3::from_fn(|_, _| between(dice, -0.5, 0.5))
}

fn direction(dice: &mut Dice) -> Unit<Vector3<f64>> {
    loop {
        let v = place(dice);
        if v.norm() > 0.1 {
            return Unit::new_normalize(v);
        }
    }
}

/// Roll, pitch and yaw.
fn angles(r: &Rotation3<f64>) -> String {
    let (roll, pitch, yaw) = r.euler_angles();
    format!("[{roll}, {pitch}, {yaw}]")
}

fn list(v: &Vector3<f64>) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

/// A platform on a chain of driven hinges, with a leg.
fn platform(dice: &mut Dice) -> String {
    let hinges = 2 + dice.next(3);
    let (mut points, mut bodies, mut joints, mut drivers) = (String::new(), String::new(), String::new(), String::new());
    let (mut p, mut r) = (Vector3::zeros(), Rotation3::identity());
    let mut carrier = "ground".to_owned();
    for i in 1..=hinges {
        let (at, axis, angle) = (place(dice), direction(dice), between(dice, -1.5, 1.5));
        let rpy = Rotation3::from_euler_angles(between(dice, -1.0, 1.0), between(dice, -1.0, 1.0), between(dice, -1.0, 1.0));
        if i == 1 {
            write!(points, "j1: {}, ", list(&at)).unwrap();
        } else {
            writeln!(bodies, "  {carrier}: {{ ball: {{ radius: 5 cm, mass: 1 kg }}, points: {{ end: {} }} }}", list(&at)).unwrap();
        }
        let end = if i == 1 { "ground.j1".to_owned() } else { format!("{carrier}.end") };
        writeln!(joints, "  j{i}: {{ revolute: [{end}, b{i}.origin], axis: {}, rpy: {} }}", list(&axis), angles(&rpy)).unwrap();
        writeln!(drivers, "  d{i}: {{ joint: j{i}, angle: {angle} + 0.1 rad/s * t }}").unwrap();
        p += r * at;
        r = r * Rotation3::from_axis_angle(&axis, angle) * rpy;
        carrier = format!("b{i}");
    }
    // the plate is welded to the last link, on either side of the weld
    let (at, rpy) =
        (place(dice), Rotation3::from_euler_angles(between(dice, -3.0, 3.0), between(dice, -1.4, 1.4), between(dice, -3.0, 3.0)));
    writeln!(bodies, "  {carrier}: {{ ball: {{ radius: 5 cm, mass: 1 kg }}, points: {{ end: {} }} }}", list(&at)).unwrap();
    if dice.next(2) == 0 {
        writeln!(joints, "  weld: {{ fixed: [{carrier}.end, plate.origin], rpy: {} }}", angles(&rpy)).unwrap();
    } else {
        writeln!(joints, "  weld: {{ fixed: [plate.origin, {carrier}.end], rpy: {} }}", angles(&rpy.inverse())).unwrap();
    }
    p += r * at;
    r *= rpy;
    let hip = place(dice) - Vector3::z();
    let knee = place(dice);
    let foot = p + r * knee;
    write!(points, "hip: {}", list(&hip)).unwrap();
    writeln!(bodies, "  plate: {{ ball: {{ radius: 5 cm, mass: 1 kg }}, points: {{ knee: {} }} }}", list(&knee)).unwrap();
    // all frames of the leg lie on that of the ground
    let along = foot - hip;
    let across = Unit::new_normalize(along.cross(&direction(dice)));
    let second = Unit::new_normalize(along.cross(&across));
    for (name, mid) in [("lower", hip + 0.3 * along), ("upper", hip + 0.7 * along)] {
        writeln!(
            bodies,
            "  {name}: {{ mass: 1 kg, inertia: [0.02, 0.03, 0.04], com: {}, points: {{ hip: {}, foot: {} }} }}",
            list(&mid),
            list(&hip),
            list(&foot)
        )
        .unwrap();
    }
    let axes = format!("axes: [{}, {}]", list(&across), list(&second));
    let slide = format!("  S: {{ slider: [lower.hip, upper.hip], axis: {} }}\n", list(&along));
    if share(dice) < 0.7 {
        write!(joints, "  K: {{ universal: [ground.hip, lower.hip], {axes} }}\n{slide}  B: {{ spherical: [upper.foot, plate.knee] }}\n")
            .unwrap();
    } else {
        // as the plate stands, the leg's frames are those of the ground
        let seen = format!("axes: [{}, {}], rpy: {}", list(&(r.inverse() * *across)), list(&second), angles(&r.inverse()));
        write!(joints, "  B: {{ spherical: [ground.hip, lower.hip] }}\n{slide}  K: {{ universal: [plate.knee, upper.foot], {seen} }}\n")
            .unwrap();
    }
    format!(
        "grashof: 1\nname: platform\nspace: spatial\ngravity: none\nground: {{ {points} }}\nbodies:\n{bodies}joints:\n{joints}drivers:\n{drivers}\
         studies:\n  move:\n    kinematics: {{ over: 0.01 s, samples: 1 }}\n    columns: [time, K.angle1, K.angle2, S.position]\n"
    )
}

#[test]
fn a_leg_stands_where_it_is_drawn_to_close() {
    let wanted = cases(40);
    let mut dice = seeded(0x1E65);
    let mut findings = Vec::new();
    for case in 0..wanted {
        let text = platform(&mut dice);
        let what = match moved(&text) {
            Ok(outcome) => {
                let off = outcome.rows[0][1..].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                (off > 1e-9).then(|| format!("the leg begins {off:e} off"))
            }
            Err(reason) => Some(reason),
        };
        if let Some(what) = what {
            let path = std::env::temp_dir().join(format!("grashof-leg-{case}.yaml"));
            std::fs::write(&path, &text).unwrap();
            findings.push(format!("case {case}: {what}: {}", path.display()));
        }
    }
    tell(&format!("legs: {wanted} platforms; {} findings", findings.len()));
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
}
