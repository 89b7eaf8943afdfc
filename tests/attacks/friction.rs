//! Exact friction made by chance: schemes and coordinates must not matter to what sticks and what slides.

use super::dice::Dice;
use super::motion::{apart, moved};
use super::{between, cases, seeded, tell};
use std::fmt::Write;

/// The first is what the others are compared with, to so much of each column.
const FORMS: [(&str, &str, f64); 6] = [
    ("dop853", "integrator: dop853, tolerance: 1e-11", 0.0),
    ("auto", "integrator: auto, tolerance: 1e-10", 1e-4),
    ("cartesian", "integrator: dop853, tolerance: 1e-11, coordinates: cartesian", 1e-4),
    ("minimal", "integrator: dop853, tolerance: 1e-11, coordinates: minimal", 1e-4),
    ("radau5", "integrator: radau5, tolerance: 1e-10", 1e-4),
    ("bdf", "integrator: bdf, tolerance: 1e-9", 1e-2),
];

/// Friction of a joint whose forces or torques are about `size`.
fn friction(dice: &mut Dice, revolute: bool, size: f64) -> String {
    let unit = if revolute { "N m" } else { "N" };
    let coulomb = between(dice, 0.1 * size, size);
    match dice.next(4) {
        0 => {
            let speed = between(dice, 0.01, 0.2);
            let speed_unit = if revolute { "rad/s" } else { "m/s" };
            let more = (coulomb * between(dice, 1.1, 2.0) * 1e3).round() / 1e3;
            format!(", friction: {{ coulomb: {coulomb} {unit}, static: {more} {unit}, stribeck_speed: {speed} {speed_unit} }}")
        }
        1 => {
            let radius = if revolute { format!(", radius: {} m", between(dice, 0.01, 0.1)) } else { String::new() };
            format!(", friction: {{ coulomb: {}{radius} }}", between(dice, 0.05, 0.3))
        }
        2 => String::new(),
        _ => format!(", friction: {{ coulomb: {coulomb} {unit} }}"),
    }
}

/// An open chain of slides and hinges, held by a spring and shaken.
fn chain(dice: &mut Dice) -> String {
    let count = 2 + dice.next(3);
    let (mut bodies, mut joints, mut loads, mut shown) = (String::new(), String::new(), String::new(), String::new());
    for i in 1..=count {
        let parent = if i == 1 { "ground.o".to_owned() } else { format!("b{}.end", i - 1) };
        let revolute = dice.next(2) == 0;
        let friction = friction(dice, revolute, if revolute { 2.0 } else { 6.0 });
        let (kind, unit, size) = if revolute { ("revolute", "N m", 3.0) } else { ("slider", "N", 10.0) };
        let axis = if revolute { String::new() } else { format!(", axis: [{}, {}]", between(dice, 0.3, 1.0), between(dice, -0.8, 0.8)) };
        writeln!(joints, "  j{i}: {{ {kind}: [{parent}, b{i}.origin]{axis}{friction} }}").unwrap();
        let (mass, inertia) = (between(dice, 0.5, 3.0), between(dice, 0.05, 0.5));
        let end = [between(dice, 0.2, 0.8), between(dice, -0.4, 0.4)];
        let com = [between(dice, 0.0, 0.4), between(dice, -0.2, 0.2)];
        writeln!(bodies, "  b{i}: {{ mass: {mass}, inertia: {inertia}, com: {com:?}, points: {{ end: {end:?} }} }}").unwrap();
        if dice.next(3) > 0 {
            let (amplitude, rate, phase) = (between(dice, 0.2 * size, size), between(dice, 2.0, 9.0), between(dice, 0.0, 3.0));
            let key = if revolute { "torque" } else { "force" };
            writeln!(loads, "  l{i}: {{ joint: j{i}, {key}: \"{amplitude} {unit}*sin({rate} rad/s*t + {phase} rad)\" }}").unwrap();
        }
        write!(shown, ", b{i}.com.x, b{i}.com.y").unwrap();
    }
    let loads = if loads.is_empty() { String::new() } else { format!("loads:\n{loads}") };
    let (stiffness, damping) = (between(dice, 10.0, 80.0), between(dice, 0.0, 1.0));
    format!(
        "grashof: 1\nname: chance\nspace: planar\ngravity: [0, -9.81]\nground: {{ o: [0, 0], post: [0.5, 1.5] }}\n\
         bodies:\n{bodies}joints:\n{joints}{loads}\
         springs:\n  s: {{ between: [ground.post, b{count}.end], stiffness: {stiffness}, length: 0.5, damping: {damping} }}\n\
         studies:\n  move:\n    dynamics: {{ until: 2 s, every: 0.1 s, SETTINGS }}\n    columns: [time{shown}]\n"
    )
}

/// A four-bar with friction in its joints, a torque on its crank, and a brake or one-way clutch there.
fn four_bar(dice: &mut Dice) -> String {
    let mut mass = || format!("mass: {}, inertia: {}", between(dice, 0.3, 2.0), between(dice, 0.02, 0.3));
    let (crank, rod, rocker) = (mass(), mass(), mass());
    let lengths = [between(dice, 0.25, 0.4), between(dice, 0.9, 1.2), between(dice, 0.7, 0.9)];
    let mut joints = String::new();
    for (name, points) in
        [("O", "ground.O, crank.origin"), ("A", "crank.end, rod.origin"), ("B", "rod.end, rocker.end"), ("C", "ground.C, rocker.origin")]
    {
        writeln!(joints, "  {name}: {{ revolute: [{points}]{} }}", friction(dice, true, 1.5)).unwrap();
    }
    let clutch = match dice.next(3) {
        0 => format!("{{ joint: O, torque: \"if(t > {} s, {} N m, 0 N m)\" }}", between(dice, 0.3, 1.0), between(dice, 3.0, 15.0)),
        1 => format!("{{ joint: C, torque: {} N m }}", between(dice, 0.5, 3.0)),
        _ => "{ joint: O, one_way: true }".to_owned(),
    };
    let (amplitude, rate, constant) = (between(dice, 2.0, 12.0), between(dice, 1.5, 8.0), between(dice, -3.0, 3.0));
    let (start, speed) = (between(dice, 0.3, 2.5), between(dice, 0.0, 4.0));
    format!(
        "grashof: 1\nname: chance\nspace: planar\ngravity: [0, -9.81]\nground: {{ O: [0, 0], C: [1, 0] }}\nbodies:\n  \
         crank: {{ {crank}, com: [{}, 0], points: {{ end: [{}, 0] }} }}\n  rod: {{ {rod}, com: [{}, 0.05], points: {{ end: [{}, 0] }} }}\n  \
         rocker: {{ {rocker}, com: [{}, 0], points: {{ end: [{}, 0] }} }}\njoints:\n{joints}\
         clutches:\n  k: {clutch}\n\
         loads:\n  l: {{ joint: O, torque: \"{constant} N m + {amplitude} N m*sin({rate} rad/s*t)\" }}\n\
         start: {{ O.angle: {start}, O.omega: {speed}, rod.angle: ~0.3, rocker.angle: ~1.4 }}\n\
         studies:\n  move:\n    dynamics: {{ until: 2 s, every: 0.1 s, SETTINGS }}\n    columns: [time, rod.com.x, rod.com.y, rocker.end.x]\n",
        lengths[0] / 2.0,
        lengths[0],
        lengths[1] / 2.0,
        lengths[1],
        lengths[2] / 2.0,
        lengths[2],
    )
}

#[test]
fn what_sticks_is_the_same_in_all_schemes_and_coordinates() {
    let wanted = cases(12);
    let mut dice = seeded(0x571C_C10A);
    let (mut ran, mut refused, mut findings, mut worst) = (0, 0, Vec::new(), 0.0_f64);
    for case in 0..wanted {
        let text = if case % 2 == 0 { chain(&mut dice) } else { four_bar(&mut dice) };
        let motions: Vec<_> = FORMS.iter().map(|(_, settings, _)| moved(&text.replace("SETTINGS", settings))).collect();
        let mut find = |what: String, settings: &str| {
            let path = std::env::temp_dir().join(format!("grashof-friction-{case}.yaml"));
            std::fs::write(&path, text.replace("SETTINGS", settings)).unwrap();
            findings.push(format!("case {case}: {what}: {}", path.display()));
        };
        match &motions[0] {
            Ok(_) => ran += 1,
            Err(reason) if reason.contains("jam") => refused += 1,
            Err(reason) => find(reason.clone(), FORMS[0].1),
        }
        for ((name, settings, tolerance), motion) in FORMS.iter().zip(&motions).skip(1) {
            match (&motions[0], motion) {
                (Ok(a), Ok(b)) => {
                    let off = apart(a, b, 0.1);
                    if *name != "bdf" {
                        worst = worst.max(off);
                    }
                    if off > *tolerance {
                        find(format!("{name} is off by {off:e}"), settings);
                    }
                }
                (Err(_), Err(_)) => {}
                (Ok(_), Err(reason)) => find(format!("{name} alone does not run: {reason}"), settings),
                (Err(_), Ok(_)) => find(format!("{name} runs, the first does not"), settings),
            }
        }
    }
    let figures = format!("{wanted} cases: {ran} ran, {refused} jam in all forms; largest difference {worst:.1e}");
    tell(&format!("friction: {figures}; {} findings", findings.len()));
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
    assert!(ran * 10 > wanted * 8, "{ran} of {wanted} ran");
}
