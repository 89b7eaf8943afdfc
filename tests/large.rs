//! Mechanisms of many bodies, whose equations are kept sparse: a row of four-bars hangs and swings as one pendulum, and chains move alike
//! on trees of long and of short roads.
//!
//! The row has N + 1 rods that turn and N that stay level, each of 1 m and 1 kg: ½ I ω² with I = (N + 1)/3 + N, and −(m g) cos θ with
//! m = (N + 1)/2 + N, so that θ'' = −(m g/I) sin θ.

use crate::common;
use grashof::Model;
use grashof::kinematics::bounded::cheapest;
use grashof::mechanism::Coordinates;
use grashof::results::Results;
use grashof::studies::common::case::parameters;

const GRAVITY: f64 = 9.81;

/// A row of `n` four-bars with a damper in the first hinge, and one study of it.
fn row(n: usize, damping: f64, start: [&str; 2], study: &str) -> Model {
    Model::parse(&text(n, damping, start, study)).unwrap_or_else(|e| panic!("{e}"))
}

fn text(n: usize, damping: f64, [start, speed]: [&str; 2], study: &str) -> String {
    let each = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    format!(
        "
grashof: 1
name: row
space: planar
gravity: [0, -9.81 m/s^2]
ground:
{}bodies:
{}{}joints:
{}{}start:
  A0.angle: {start}
  A0.omega: {speed}
{}{}studies: {{ it: {{ {study} }} }}
",
        each(n + 1, &|i| format!("  G{i}: [{i} m, 0]\n")),
        each(n + 1, &|i| format!("  v{i}: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n")),
        each(n, &|i| format!("  h{i}: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n")),
        each(n + 1, &|i| {
            let damper = if i == 0 { format!(", damping: {damping} N m s/rad") } else { String::new() };
            format!("  A{i}: {{ revolute: [ground.G{i}, v{i}.start]{damper} }}\n")
        }),
        each(n, &|i| { format!("  B{i}: {{ revolute: [v{i}.end, h{i}.start] }}\n  C{i}: {{ revolute: [h{i}.end, v{}.end] }}\n", i + 1) }),
        each(n, &|i| format!("  A{}.angle: ~{start}\n", i + 1)),
        each(n, &|i| format!("  h{i}.angle: ~0 deg\n")),
    )
}

fn run(model: &Model) -> Results {
    let results = model.study("it").unwrap().run().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(results.stopped, None);
    results
}

/// I and m of a row.
fn inertia(n: usize) -> [f64; 2] {
    let n = n as f64;
    [(n + 1.0) / 3.0 + n, (n + 1.0) / 2.0 + n]
}

#[test]
fn a_row_vibrates_as_one_pendulum() {
    for n in [1, 8, 30] {
        let [inertia, moment] = inertia(n);
        let square = moment * GRAVITY / inertia;
        let modes = run(&row(n, 0.0, ["-90 deg", "0"], "modes: {}"));
        let frequencies = modes.list("frequencies").unwrap();
        assert_eq!(frequencies.len(), 1, "{n}");
        assert!((frequencies[0] / square.sqrt() - 1.0).abs() < 1e-9, "{n}: {frequencies:?}");

        let damping = 0.8 * inertia;
        let linear = run(&row(n, damping, ["-90 deg", "0"], "linearize: {}, columns: [A0.angle]"));
        let [real, imaginary] = ["poles_real", "poles_imaginary"].map(|name| linear.list(name).unwrap()[0]);
        assert!((real + 0.4).abs() < 1e-9 && (imaginary.abs() - (square - 0.16).sqrt()).abs() < 1e-9, "{n}: {real} {imaginary}");
    }
}

/// A driven row at a constant speed keeps its kinetic energy, so that the driver carries the weight alone: τ = m g cos θ + d ω. The row of
/// 60 has a sparse G.
#[test]
fn a_driven_row_carries_its_weight_alone() {
    for n in [2, 60] {
        let columns = format!("columns: [A0.angle, crank.torque, A{n}.omega, A{n}.alpha, h{}.vx, h{}.ay]", n - 1, n / 2);
        let text = text(n, 3.0, ["40 deg", "0"], &format!("inverse: {{ over: 25 deg, samples: 5 }}, {columns}"))
            .replace("  A0.omega: 0\n", "")
            + "drivers: { crank: { joint: A0, speed: 2 rad/s } }\n";
        let results = run(&Model::parse(&text).unwrap_or_else(|e| panic!("{e}")));
        let [angle, torque, omega, alpha, vx, ay] = [0, 1, 2, 3, 4, 5].map(|k| results.table.columns[k].values.clone());
        for (k, angle) in angle.iter().enumerate() {
            let right = inertia(n)[1] * GRAVITY * angle.cos() + 3.0 * 2.0;
            assert!((torque[k] / right - 1.0).abs() < 1e-11, "{n}: {} for {right}", torque[k]);
            let motion = [omega[k] - 2.0, alpha[k], vx[k] + 2.0 * angle.sin(), ay[k] + 4.0 * angle.sin()];
            assert!(motion.iter().all(|x| x.abs() < 1e-11), "{n}: {motion:?}");
        }
    }
}

#[test]
fn a_row_rests_where_it_hangs() {
    for n in [1, 8, 20] {
        let results =
            run(&row(n, 0.0, ["-50 deg", "0"], "statics: { from: start }, columns: [A0.angle], scalars: { angle: last(A0.angle) }"));
        let angle = results.scalar("angle").unwrap();
        assert!((angle + std::f64::consts::FRAC_PI_2).abs() < 1e-8, "{n}: {angle}");
    }
}

/// Above some sixty velocities a start is assembled by sparse factorisations.
#[test]
fn a_long_row_starts_as_one_pendulum() {
    let n = 150;
    let speeds = "A0.omega, A150.omega, h75.omega, B75.omega";
    let study = format!("dynamics: {{ until: 1 ms, every: 1 ms, tolerance: 1e-7, integrator: dop853 }}, columns: [{speeds}]");
    let results = run(&row(n, 0.0, ["-20 deg", "3 rad/s"], &study));
    let first: Vec<f64> = results.table.columns.iter().map(|column| column.values[0]).collect();
    let expected = [3.0, 3.0, 0.0, -3.0];
    assert!(first.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-12), "{first:?}");
}

/// With a damper of D = I/s the row moves as a point mass on an arm I/m with a damper of its own inertia a second, by all families of
/// schemes.
#[test]
fn a_row_swings_as_one_pendulum() {
    let study = |scheme: &str| {
        let dynamics = format!("dynamics: {{ until: 1 s, tolerance: 1e-7, integrator: {scheme} }}");
        format!("{dynamics}, columns: [A0.angle], scalars: {{ angle: last(A0.angle) }}")
    };
    for n in [8, 30] {
        let [inertia, moment] = inertia(n);
        let arm = inertia / moment;
        let twin = format!(
            "
grashof: 1
name: twin
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ rod: {{ mass: 1 kg, inertia: 0 kg m^2, com: [{arm} m, 0] }} }}
joints: {{ A0: {{ revolute: [ground, rod.origin], damping: {} N m s/rad }} }}
start: {{ A0.angle: -20 deg, A0.omega: 0 }}
studies: {{ it: {{ {} }} }}
",
            arm * arm,
            study("dop853")
        );
        let expected = run(&Model::parse(&twin).unwrap_or_else(|e| panic!("{e}"))).scalar("angle").unwrap();
        for scheme in ["dop853", "radau5", "bdf", "generalized-alpha"] {
            let results = run(&row(n, inertia, ["-20 deg", "0"], &study(scheme)));
            let found = results.scalar("angle").unwrap();
            assert!((found - expected).abs() < 1e-5, "{n} {scheme}: {found} {expected}");
            let march = results.certificate.march.unwrap();
            assert!(march.energy_drift < 1e-4 * march.energy_scale, "{n} {scheme}: {march:?}");
        }
    }
}

/// A chain of `n` rods with dampers in its joints and a load at its end, and one study of its motion.
fn chain(space: &str, n: usize, settings: &str) -> String {
    let each = |line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let (joint, gravity, load) = match space {
        "planar" => ("revolute", "[0, -9.81 m/s^2]", "[3 N, 20 N]"),
        _ => ("spherical", "[0, 0, -9.81 m/s^2]", "[3 N, 5 N, 20 N]"),
    };
    let spring = if space == "planar" { ", damping: 0.2 N m s/rad" } else { "" };
    format!(
        "
grashof: 1
name: chain
space: {space}
gravity: {gravity}
bodies:
{}joints:
  J0: {{ {joint}: [ground, b0.start] }}
{}loads: {{ pull: {{ force: {load}, at: b{}.end }} }}
studies:
  it:
    dynamics: {{ until: 20 ms, every: 10 ms, tolerance: 1e-9, {settings} }}
    columns: [b0.end, b{}.end, b{}.end, J{}.fx]
",
        each(&|i| {
            let mass = 1.0 + (i % 3) as f64;
            match space {
                "planar" => format!("  b{i}: {{ bar: {{ length: 0.1 m, mass: {mass} kg }} }}\n"),
                _ => format!(
                    "  b{i}: {{ box: {{ size: [0.1 m, 2 cm, 3 cm], mass: {mass} kg }}, points: {{ start: [-5 cm, 0, 0], end: [5 cm, 0, 0] }} }}\n"
                ),
            }
        }),
        each(&|i| if i == 0 { String::new() } else { format!("  J{i}: {{ {joint}: [b{}.end, b{i}.start]{spring} }}\n", i - 1) }),
        n - 1,
        n / 2,
        n - 1,
        n / 2,
    )
}

#[test]
fn chains_move_and_react_alike_on_long_and_short_roads() {
    for (space, n, schemes) in [("planar", 120, ["dop853", "radau5"]), ("spatial", 60, ["dop853", "bdf"])] {
        let chain = |settings: &str| chain(space, n, settings);
        let model = common::model(&chain("integrator: dop853"), Some("it"));
        assert!(matches!(cheapest(&model, &parameters(&model)), Coordinates::Bounded(_)));
        let run = |settings: &str| run(&Model::parse(&chain(settings)).unwrap_or_else(|e| panic!("{e}")));
        let expected = run("integrator: dop853, coordinates: joint");
        for settings in schemes.iter().flat_map(|s| ["auto", "cartesian"].map(|c| format!("integrator: {s}, coordinates: {c}"))) {
            let found = run(&settings);
            assert_eq!(found.table.columns.len(), expected.table.columns.len());
            for (found, expected) in found.table.columns.iter().zip(&expected.table.columns) {
                let size = expected.values.iter().fold(1.0, |m, x| f64::max(m, x.abs()));
                let off = found.values.iter().zip(&expected.values).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
                assert!(off < 1e-6 * size, "{space} {settings}: {} off by {off:e} of {size:e}", found.name);
            }
        }
    }
}

/// In space each four-bar has three redundant rows, and a row of them passes its flat positions as in the plane, where it may branch.
#[test]
fn a_row_in_space_passes_flat_positions_as_in_the_plane() {
    let each = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    let text = |n: usize, space: bool, study: &str| {
        let (dimensions, zero, axis) = if space { ("spatial", ", 0", ", axis: [0, 0, 1]") } else { ("planar", "", "") };
        let bar = format!("{{ bar: {{ length: 1 m, mass: 1 kg{} }} }}", if space { ", width: 1e-9 m, height: 1e-9 m" } else { "" });
        format!(
            "grashof: 1\nname: row\nspace: {dimensions}\ngravity: [0, -9.81{zero}]\nground:\n{}bodies:\n{}{}joints:\n{}{}start:\n  A0.angle: 90 deg\n  A0.omega: -1 rad/s\n{}studies: {{ it: {{ {study} }} }}\n",
            each(n + 1, &|i| format!("  G{i}: [{i}, 0{zero}]\n")),
            each(n + 1, &|i| format!("  v{i}: {bar}\n")),
            each(n, &|i| format!("  h{i}: {bar}\n")),
            each(n + 1, &|i| format!("  A{i}: {{ revolute: [ground.G{i}, v{i}.start]{axis} }}\n")),
            each(n, &|i| {
                let next = i + 1;
                format!("  B{i}: {{ revolute: [v{i}.end, h{i}.start]{axis} }}\n  C{i}: {{ revolute: [h{i}.end, v{next}.end]{axis} }}\n")
            }),
            each(n, &|i| format!("  A{}.angle: ~90 deg\n  B{i}.angle: ~-90 deg\n", i + 1)),
        )
    };
    let angle = |n: usize, space: bool, study: &str| {
        let model = Model::parse(&text(n, space, study)).unwrap_or_else(|e| panic!("{e}"));
        *run(&model).table.columns[0].values.last().unwrap()
    };
    let study = "dynamics: { until: 2 s, every: 1 s, tolerance: 1e-9 }, columns: [A0.angle]";
    let (plane, space) = (angle(8, false, study), angle(8, true, study));
    assert!(plane < -4.5 && (plane - space).abs() < 1e-6, "{plane} and {space}");
    // and very many are set up by sparse factorisations
    let short = "dynamics: { until: 1 ms, every: 1 ms, tolerance: 1e-9 }, columns: [A0.angle]";
    let (plane, space) = (angle(150, false, short), angle(150, true, short));
    assert!((plane - space).abs() < 1e-12, "{plane} and {space}");
}

/// A chain begins where the angles of its bodies say, exact ones and guesses, with hinges either way round and slides between.
#[test]
fn a_long_chain_begins_at_the_angles_that_are_asked_of_its_bodies() {
    let n = 1500;
    let angle = |i: usize| (37 * i % 360) as f64 - 180.0;
    let each = |line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let joint = |i: usize| {
        let before = if i == 0 { "ground".into() } else { format!("b{}.end", i - 1) };
        match i % 5 {
            3 => format!("  J{i}: {{ pin-in-slot: [{before}, b{i}.start], axis: [1, 0] }}\n"),
            2 => format!("  J{i}: {{ revolute: [b{i}.start, {before}] }}\n"),
            _ => format!("  J{i}: {{ revolute: [{before}, b{i}.start] }}\n"),
        }
    };
    let start = |i: usize| format!("  b{i}.angle: {}{} deg\n", if i % 3 == 1 { "" } else { "~" }, angle(i));
    let text = format!(
        "grashof: 1\nname: chain\nspace: planar\ngravity: none\nbodies:\n{}joints:\n{}start:\n{}studies: {{ it: {{ dynamics: {{ until: 1 us, every: 1 us }}, columns: [{}, b{}.end.x, b{}.end.y] }} }}\n",
        each(&|i| format!("  b{i}: {{ bar: {{ length: 0.1 m, mass: 1 kg }} }}\n")),
        each(&joint),
        each(&start),
        (0..n).step_by(100).map(|i| format!("b{i}.angle")).collect::<Vec<_>>().join(", "),
        n - 1,
        n - 1,
    );
    let model = Model::parse(&text).unwrap_or_else(|e| panic!("{e}"));
    let results = run(&model);
    let first = |k: usize| results.table.columns[k].values[0];
    for (k, i) in (0..n).step_by(100).enumerate() {
        assert!((first(k) - angle(i).to_radians()).abs() < 1e-9, "b{i}: {}", first(k).to_degrees());
    }
    let end = |f: &dyn Fn(f64) -> f64| 0.1 * (0..n).map(|i| f(angle(i).to_radians())).sum::<f64>();
    for (k, expected) in [(15, end(&f64::cos)), (16, end(&f64::sin))] {
        assert!((first(k) - expected).abs() < 1e-9, "{} for {expected}", first(k));
    }
}
