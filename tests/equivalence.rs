//! Two roads, one answer: tree coordinates and cartesian ones, any joint cut, the plane and space.

use crate::common;
use crate::common::{columns, study};
use grashof::geometry::Spatial;
use grashof::mechanism::Coordinates;
use grashof::results::Rows;
use grashof::studies::common::outcome::Outcome;
use std::fmt::Write;

/// Of the largest number of a column, or of 1.
const TOLERANCE: f64 = 1e-10;

/// Compares columns of two outcomes; `names` are those of both.
fn same(what: &str, names: &[String], found: &Outcome, right: &Outcome, wanted: impl Fn(&str) -> bool, tolerance: f64) {
    assert_eq!(found.places.len(), right.places.len(), "{what}: rows");
    for (c, name) in names.iter().enumerate().filter(|(_, n)| wanted(n)) {
        let size = right.rows.iter().fold(1.0_f64, |m, r| m.max(r[c].abs()));
        for (i, (f, r)) in found.rows.iter().zip(&right.rows).enumerate() {
            let off = (f[c] - r[c]).abs();
            assert!(off <= tolerance * size, "{what}: {name}, row {i}: {:e} and {:e}, off by {off:e} of {size:e}", f[c], r[c]);
        }
    }
}

/// A single loop of bodies, all drawn in place so that it is closed as drawn, with the given kinds of joints; its first joint is driven.
/// Sums of the joints' freedoms are 7 in space and 4 in the plane, so that one freedom is left and no row is redundant.
fn closed_loop(space: &str, kinds: &[&str], cut: Option<usize>) -> String {
    let planar = space == "planar";
    let place = |i: usize| {
        let x = i as f64;
        let flat = [[0.0, 0.0], [0.2, 0.5], [1.3, 0.9], [1.2, -0.1], [0.7, -0.6], [0.7, 1.3]];
        let p = if planar {
            [flat[i.min(5)][0], flat[i.min(5)][1], 0.0]
        } else {
            [0.3 * x - 0.1 * x * x, 0.9 * (1.1 * x).sin(), 0.2 + 0.5 * (2.3 * x + 0.5).cos()]
        };
        if planar { format!("[{}, {}]", p[0], p[1]) } else { format!("[{}, {}, {}]", p[0], p[1], p[2]) }
    };
    let n = kinds.len() - 1;
    let mut points = vec![String::new(); n + 1];
    let mut joints = String::new();
    for (i, kind) in kinds.iter().enumerate() {
        let (a, b) = (i, (i + 1) % (n + 1));
        // a distance joint spans from a place to another
        let other = if *kind == "distance" { place(i + 7) } else { place(i) };
        write!(points[a], "j{i}: {}, ", place(i)).unwrap();
        write!(points[b], "j{i}: {other}, ").unwrap();
        let name = |body: usize| if body == 0 { format!("ground.j{i}") } else { format!("b{body}.j{i}") };
        // every second joint is named from its far end
        let ends = if i % 2 == 1 && *kind != "pin-in-slot" { [name(b), name(a)] } else { [name(a), name(b)] };
        let x = i as f64;
        let axis = [(x + 0.3).cos(), (1.7 * x + 0.2).sin(), 1.0];
        let more = match *kind {
            "spherical" | "distance" | "fixed" => String::new(),
            "revolute" if planar => String::new(),
            "universal" => format!(", axes: [[{0}, {1}, 1], [{1}, -{0}, 0]]", 0.4 + 0.1 * x, 0.7),
            "screw" => format!(", axis: [{}, {}, {}], pitch: 0.7", axis[0], axis[1], axis[2]),
            _ if planar => format!(", axis: [{}, {}]", axis[0], axis[1]),
            _ => format!(", axis: [{}, {}, {}]", axis[0], axis[1], axis[2]),
        };
        let cut = if cut == Some(i) { ", cut: true" } else { "" };
        writeln!(joints, "  j{i}: {{ {kind}: [{}, {}]{more}{cut} }}", ends[0], ends[1]).unwrap();
    }
    let mut bodies = String::new();
    for (i, points) in points.iter().enumerate().skip(1) {
        let x = i as f64;
        let mass = if planar {
            format!("inertia: {}, com: [{}, 0.1]", 0.1 + 0.02 * x, 0.2 * x)
        } else {
            format!("inertia: [{}, 0.15, 0.12, 0.01, -0.02, 0.005], com: [{}, 0.1, -0.05]", 0.1 + 0.02 * x, 0.2 * x)
        };
        writeln!(bodies, "  b{i}: {{ mass: {}, {mass}, points: {{ {} }} }}", 1.0 + 0.3 * x, points.trim_end_matches(", ")).unwrap();
    }
    let zero = if planar { "[1 N*sin(3*t/(1 s)), -2 N]" } else { "[1 N*sin(3*t/(1 s)), -2 N, 0.5 N]" };
    let law = if kinds[0] == "slider" { "position: 0.1 m*sin(2*t/(1 s))" } else { "angle: 0.12*sin(2*t/(1 s))" };
    let names: Vec<String> = (0..kinds.len()).map(|i| format!("j{i}")).chain((1..=n).map(|i| format!("b{i}.com"))).collect();
    format!(
        "grashof: 1\nname: loop\nspace: {space}\ngravity: {}\nground: {{ {} , far: {} }}\nbodies:\n{bodies}joints:\n{joints}\
         drivers:\n  drive: {{ joint: j0, {law} }}\n\
         loads:\n  push: {{ at: b{n}.com, force: {zero}, frame: b1 }}\n\
         springs:\n  strut: {{ between: [ground.far, b1.com], stiffness: 30 N/m, length: 0.4 m, damping: 1 N s/m }}\n\
         studies:\n  move: {{ inverse: {{ over: 1.5 s, samples: 15 }}, columns: [t, drive, shaking, frame, com, energy, momentum.x, {}] }}\n",
        if planar { "[1, -9.81]" } else { "[1, -9.81, 2]" },
        points[0].trim_end_matches(", "),
        if planar { "[-1, 2]" } else { "[-1, 2, 1]" },
        names.join(", ")
    )
}

const SPATIAL_LOOPS: [&[&str]; 10] = [
    &["revolute", "spherical", "universal", "revolute"],
    &["revolute", "universal", "spherical", "slider"],
    &["revolute", "spherical", "cylindrical", "revolute"],
    &["screw", "spherical", "universal", "revolute"],
    &["revolute", "universal", "spherical", "screw"],
    &["revolute", "universal", "planar", "revolute"],
    &["revolute", "cylindrical", "cylindrical", "cylindrical"],
    &["slider", "universal", "cylindrical", "cylindrical"],
    &["revolute", "distance", "revolute"],
    &["revolute", "spherical", "fixed", "universal", "revolute"],
];

const PLANAR_LOOPS: [&[&str]; 8] = [
    &["revolute", "revolute", "revolute", "revolute"],
    &["revolute", "revolute", "revolute", "slider"],
    &["slider", "revolute", "revolute", "revolute"],
    &["revolute", "pin-in-slot", "revolute"],
    &["revolute", "pin-in-slot", "slider"],
    &["revolute", "distance", "revolute"],
    &["slider", "revolute", "revolute", "slider"],
    &["revolute", "revolute", "fixed", "revolute", "revolute"],
];

fn loops() -> Vec<(&'static str, &'static [&'static str])> {
    SPATIAL_LOOPS.iter().map(|l| ("spatial", *l)).chain(PLANAR_LOOPS.iter().map(|l| ("planar", *l))).collect()
}

#[test]
fn closed_loops_move_and_react_alike_in_all_coordinates() {
    for (space, kinds) in loops() {
        let text = closed_loop(space, kinds, None);
        let names = columns(&text, "move");
        println!("{space} {kinds:?}");
        let (tree, star) = (study(&text, "move", Coordinates::Joint), study(&text, "move", Coordinates::Cartesian));
        same(&kinds.join("-"), &names, &star, &tree, |_| true, TOLERANCE);
        same(&kinds.join("-"), &names, &study(&text, "move", Coordinates::Bounded(1)), &tree, |_| true, TOLERANCE);
        assert!(tree.certificate.constraint < 1e-12 && tree.certificate.power_balance < 1e-10, "{kinds:?}: {:?}", tree.certificate);
        assert!(star.certificate.constraint < 1e-12 && star.certificate.power_balance < 1e-10, "{kinds:?}: {:?}", star.certificate);
    }
}

#[test]
fn any_joint_may_be_cut() {
    for (space, kinds) in loops() {
        let text = closed_loop(space, kinds, None);
        let names = columns(&text, "move");
        let tree = study(&text, "move", Coordinates::Joint);
        for cut in 0..kinds.len() {
            let other = study(&closed_loop(space, kinds, Some(cut)), "move", Coordinates::Joint);
            same(&format!("{} cut at {cut}", kinds.join("-")), &names, &other, &tree, |_| true, TOLERANCE);
        }
    }
}

fn shipped(name: &str) -> String {
    let path = format!("{}/models/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap().replace("samples: 3600", "samples: 72").replace("samples: 360 ", "samples: 72 ")
}

#[test]
fn shipped_planar_models_move_and_react_alike_in_cartesian_coordinates() {
    for (file, name) in [("crank_rocker.yaml", "one-turn"), ("quick_return.yaml", "one-turn"), ("scotch_yoke.yaml", "one-turn")] {
        let text = shipped(file);
        let names = columns(&text, name);
        let tree = study(&text, name, Coordinates::Joint);
        for other in [Coordinates::Bounded(1), Coordinates::Cartesian] {
            same(file, &names, &study(&text, name, other), &tree, |_| true, TOLERANCE);
        }
    }
}

#[test]
fn the_crank_rocker_in_space_is_the_one_in_the_plane() {
    let (plane, space) = (shipped("crank_rocker.yaml"), shipped("four_bar_spatial.yaml"));
    let (left, right) = (columns(&plane, "one-turn"), columns(&space, "one-turn"));
    let in_plane = study(&plane, "one-turn", Coordinates::Joint);
    // hinges of a planar linkage in space carry three redundant rows: forces in the plane and moments about its normal are unique
    for coordinates in [Coordinates::Joint] {
        let in_space = study(&space, "one-turn", coordinates);
        assert_eq!(in_plane.rows.len(), in_space.rows.len());
        let mut compared = 0;
        for (c, name) in left.iter().enumerate() {
            let Some(d) = right.iter().position(|n| n == name) else { continue };
            let size = in_plane.rows.iter().fold(1.0_f64, |m, r| m.max(r[c].abs()));
            for (i, (p, s)) in in_plane.rows.iter().zip(&in_space.rows).enumerate() {
                let off = (p[c] - s[d]).abs();
                assert!(off <= TOLERANCE * size, "{name}, row {i}, {coordinates:?}: {:e} and {:e}, off by {off:e} of {size:e}", p[c], s[d]);
            }
            compared += 1;
        }
        assert!(compared >= 30, "{compared} columns");
    }
}

/// A quick return with masses, a load and a spring: in the plane with a pin in a slot; in space with a block that slides on the lever
/// and turns on the pin.
fn quick_return(space: bool) -> String {
    let z = if space { ", 0" } else { "" };
    let v = |x: &str| format!("[{x}{z}]");
    let hinge = if space { ", axis: [0, 0, 1]" } else { "" };
    let inertia = |i: f64| if space { format!("[0.2, 0.3, {i}]") } else { format!("{i}") };
    let (block, pin) = if space {
        (
            "  block: { mass: 0.7, inertia: [0.1, 0.1, 0.1] }\n".to_string(),
            "  A1: { slider: [swing.start, block.origin], axis: [1, 0, 0] }\n  A: { revolute: [block.origin, wheel.end], axis: [0, 0, 1] }\n".to_string(),
        )
    } else {
        (String::new(), "  A1: { pin-in-slot: [swing.start, wheel.end], axis: [1, 0] }\n".to_string())
    };
    // the block in the plane: its mass goes with the pin, its inertia turns with the lever
    let (at_pin, at_lever) =
        if space { ("", "") } else { (", attached: { block: { at: end, mass: 0.7 } }", ", attached: { turning: { inertia: 0.1 } }") };
    format!(
        "grashof: 1\nname: quick\nspace: {}\ngravity: {}\nground: {{ O1: {}, O2: {}, way: {} }}\nbodies:\n\
         \x20 wheel: {{ points: {{ start: {}, end: {} }}, mass: 3, inertia: {}, com: {}{at_pin} }}\n\
         \x20 swing: {{ points: {{ start: {}, end: {} }}, mass: 5, inertia: {}, com: {}{at_lever} }}\n\
         \x20 link: {{ points: {{ start: {}, end: {} }}, mass: 2, inertia: {}, com: {} }}\n\
         \x20 ram: {{ mass: 7, inertia: {} }}\n{block}joints:\n\
         \x20 O2: {{ revolute: [ground.O2, wheel.start]{hinge}, damping: 0.3 }}\n\
         \x20 O1: {{ revolute: [ground.O1, swing.start]{hinge} }}\n{pin}\
         \x20 B: {{ revolute: [swing.end, link.start]{hinge} }}\n\
         \x20 C: {{ revolute: [link.end, ram.origin]{hinge} }}\n\
         \x20 W: {{ slider: [ground.way, ram.origin], axis: {}, damping: 2 }}\n\
         drivers: {{ drive: {{ joint: O2, speed: 3 rad/s }} }}\n\
         loads: {{ cut: {{ at: ram.origin, force: {}, frame: link }} }}\n\
         springs: {{ back: {{ between: [ground.O1, ram.origin], stiffness: 20 N/m, length: 1 m }} }}\n\
         start: {{ O2.angle: 0 deg, O1.angle: ~67 deg, B.angle: ~104 deg, C.angle: ~-171 deg }}\n\
         studies:\n\
         \x20 turn: {{ inverse: {{ over: 1 turn, samples: 48 }}, columns: [O2.angle, O1.angle, O1.omega, O1.alpha, B.angle, B.alpha, ram.vx, ram.ax, com, drive, \
         shaking, shaking_m, frame.fx, frame.fy, energy, O1.fx, O1.fy, O2.fx, O2.fy, A1.fx, A1.fy, B.fx, B.fy, C.fx, C.fy, W.fy] }}\n\
         measures: {{ shaking_m: {} }}\n",
        if space { "spatial" } else { "planar" },
        v("0.3, -9.81"),
        v("0, 0"),
        v("0, 1.2"),
        v("0, 3.2"),
        v("0, 0"),
        v("0.5, 0"),
        inertia(0.4),
        v("0.2, 0.05"),
        v("0, 0"),
        v("3.2, 0"),
        inertia(0.45),
        v("1.5, -0.1"),
        v("0, 0"),
        v("1.6, 0"),
        inertia(0.35),
        v("0.7, 0.03"),
        inertia(0.4),
        v("1, 0"),
        v("-30, 12"),
        if space { "shaking.mz" } else { "shaking.m" },
    )
}

#[test]
fn a_pin_in_a_slot_is_a_block_that_slides_and_turns() {
    let (plane, space) = (quick_return(false), quick_return(true));
    let in_plane = study(&plane, "turn", Coordinates::Joint);
    let names = columns(&plane, "turn");
    let kept: Vec<usize> = {
        let other = columns(&space, "turn");
        names.iter().map(|n| other.iter().position(|o| o == n).unwrap_or_else(|| panic!("{n} is no column in space"))).collect()
    };
    for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
        let mut in_space = study(&space, "turn", coordinates);
        let mut rows = Rows::new(kept.len());
        in_space.rows.iter().for_each(|row| rows.push(kept.iter().map(|c| row[*c])));
        in_space.rows = rows;
        same("quick return", &names, &in_space, &in_plane, |_| true, TOLERANCE);
    }
}

/// q = q̂ + N(q) u is what an implicit step asks of the coordinates; its closed form against the equation.
#[test]
fn implicit_displacements_solve_their_equation() {
    let m = common::mechanism::<Spatial<f64>>(include_str!("common/spatial.yaml"), Coordinates::Cartesian);
    let mut q = m.drawn();
    let turn: Vec<f64> = (0..m.nv).map(|k| 0.3 * (1.7 * k as f64).sin()).collect();
    m.retract(&mut q, &turn);
    let (before, u): (Vec<f64>, Vec<f64>) = (q.clone(), (0..m.nv).map(|k| 0.4 * (2.3 * k as f64 + 0.5).cos()).collect());
    m.displace(&mut q, &u);
    let mut rate = vec![0.0; m.nq];
    m.rate(&q, &u, &mut rate);
    for ((q, before), rate) in q.iter().zip(&before).zip(&rate) {
        assert!((q - before - rate).abs() < 1e-15, "{q} is not {before} + {rate}");
    }
}

/// The turns of a hinge's angle off the tree are counted, and that is no switch: rows, extremes and places where a condition begins
/// are those of joint coordinates, a switch at a counted half turn among them.
#[test]
fn counted_turns_are_no_switches() {
    let wheel = |settings: &str| {
        format!(
            "grashof: 1
name: wheel
space: spatial
gravity: none
bodies: {{ wheel: {{ mass: 1 kg, inertia: [0.1, 0.1, 0.2] }} }}
joints: {{ O: {{ revolute: [ground.origin, wheel.origin], axis: [0.6, 0, 0.8] }} }}
loads: {{ push: {{ joint: O, torque: 0.2 N*m }} }}
start: {{ O.angle: 0.3 rad, O.omega: 3 rad/s }}
measures: {{ side: sin(O.angle), passed: \"if(O.angle > 7.5*pi*1 rad, 1, 0)\" }}
studies:
  turn:
    dynamics: {{ until: 6 s, {settings} }}
    columns: [O.angle, O.omega, side]
    scalars: {{ lowest: min(side), way: integral(abs(O.omega)), passes: first(passed > 0.5), part: mean(passed) }}
"
        )
    };
    // the inertia about the axis
    let alpha = 0.2 / (0.36 * 0.1 + 0.64 * 0.2);
    let at = |t: f64| 0.3 + 3.0 * t + 0.5 * alpha * t * t;
    let joint = study(&wheel("every: 0.5 s"), "turn", Coordinates::Joint);
    for settings in ["every: 0.5 s, coordinates: cartesian", "every: 0.5 s, coordinates: cartesian, integrator: radau5"] {
        let outcome = study(&wheel(settings), "turn", Coordinates::Joint);
        assert_eq!((outcome.rows.len(), &outcome.switches), (joint.rows.len(), &joint.switches), "{settings}");
        for (t, row) in outcome.places.iter().zip(&outcome.rows) {
            assert!((row[0] - at(*t)).abs() < 1e-6 && (row[2] - at(*t).sin()).abs() < 1e-6, "{settings}, {t}: {row:?}");
        }
        for (found, right) in outcome.scalars.iter().zip(&joint.scalars) {
            assert!((found - right).abs() < 1e-6, "{settings}: {found} {right}");
        }
    }
    // rows at the steps of the scheme alone, angles right on both sides of each half turn
    let steps = study(&wheel("coordinates: cartesian"), "turn", Coordinates::Joint);
    assert_eq!(steps.switches.len(), joint.switches.len());
    // the next half turn is counted three quarters of π from the middle of the last one
    let behind = |row: &[f64]| (row[0] / std::f64::consts::PI - 0.75).rem_euclid(1.0);
    assert!(steps.rows.iter().all(|row| behind(row) > 1e-6 && behind(row) < 1.0 - 1e-6), "a row where a half turn was counted");
}

/// Light bodies that only pass forces on: a thin bar, which has no inertia about itself, that guides a body along a long way in space, and
/// the crank and the rocker of a four-bar whose coupler is up to 1e9 times as heavy.
#[test]
fn rows_of_light_bodies_feel_the_heavy_ones_behind_them() {
    let studies = |columns: &str| {
        let of = |coordinates: &str| {
            format!(
                "  {coordinates}: {{ dynamics: {{ until: 0.5 s, every: 0.1 s, tolerance: 1e-10, coordinates: {coordinates} }}, columns: [{columns}] }}\n"
            )
        };
        format!("studies:\n{}{}", of("joint"), of("cartesian"))
    };
    let guided = format!(
        "grashof: 1
name: sleeve on a thin bar
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  a: {{ bar: {{ length: 0.5 m, mass: 1 kg }} }}
  b: {{ box: {{ size: [0.4 m, 0.2 m, 0.1 m], mass: 1 kg }}, points: {{ start: [-0.2 m, 0, 0] }} }}
joints:
  P: {{ revolute: [ground, a.start], axis: [0, 1, 0.2] }}
  Q: {{ cylindrical: [a.end, b.start], axis: [1, 0.3, 0] }}
start: {{ P.angle: 130 deg, P.omega: 14 rad/s, Q.angle: 20 deg, Q.omega: 19 rad/s, Q.position: 0.05 m, Q.velocity: 0 m/s }}
{}",
        studies("P.angle, P.omega, P.alpha, Q.angle, Q.omega, Q.position, Q.velocity, Q.acceleration")
    );
    let four_bar = |mass: &str| {
        format!(
            "grashof: 1
name: light crank and rocker
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ O: [0, 0], C: [1 m, 0] }}
bodies:
  c: {{ bar: {{ length: 0.3 m, mass: {mass} }} }}
  l: {{ bar: {{ length: 1 m, mass: 1000 kg }} }}
  r: {{ bar: {{ length: 0.7 m, mass: {mass} }} }}
joints:
  O: {{ revolute: [ground.O, c.start] }}
  A: {{ revolute: [c.end, l.start] }}
  B: {{ revolute: [l.end, r.end] }}
  C: {{ revolute: [ground.C, r.start] }}
start: {{ O.angle: 60 deg, O.omega: 5 rad/s, l.angle: ~20 deg, r.angle: ~90 deg }}
{}",
            studies("O.angle, O.omega, O.alpha, A.fx, A.fy, B.fx, B.fy")
        )
    };
    let texts = [guided, four_bar("100 kg"), four_bar("1 kg"), four_bar("1 g"), four_bar("1e-6 kg"), four_bar("0 kg")];
    for (i, text) in texts.iter().enumerate() {
        let [joint, cartesian] = ["joint", "cartesian"].map(|name| study(text, name, Coordinates::Joint));
        same(&format!("model {i}"), &columns(text, "joint"), &cartesian, &joint, |_| true, 1e-8);
    }
}
