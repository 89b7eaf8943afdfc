//! Stiffness that is small beside the largest one, of few bodies and of more than a hundred: forces and stability.

use super::{findings, near, run};

/// `n` masses on springs of a stiffness and a pendulum, which starts at an angle.
fn beside_stiff(n: usize, stiffness: &str, angle: &str) -> String {
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    format!(
        "grashof: 1\nname: soft and stiff\nspace: planar\ngravity: [0, -9.81]\nground: {{ O: [0, 0] }}\nbodies:\n  rod: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n{}joints:\n  P: {{ revolute: [ground.O, rod.start] }}\n{}springs:\n{}start: {{ P.angle: {angle} }}\nstudies: {{ rest: {{ statics: {{ from: start }} }} }}\n",
        each(&|i| format!("  m{i}: {{ mass: 1 kg }}\n")),
        each(&|i| format!("  S{i}: {{ slider: [ground.O, m{i}.origin], axis: [1, 0] }}\n")),
        each(&|i| format!("  s{i}: {{ joint: S{i}, stiffness: {stiffness} }}\n")),
    )
}

#[test]
fn a_pendulum_is_stable_or_not_beside_stiff_springs() {
    for (n, stiffness) in [(2, "1e10 N/m"), (110, "1e12 N/m")] {
        let of = |angle: &str| {
            let outcome = run(&beside_stiff(n, stiffness, angle), "rest");
            findings(&outcome, "equilibrium")[0].rsplit(": ").next().map(str::to_owned)
        };
        assert_eq!(of("-90 deg").as_deref(), Some("stable"), "{n}");
        assert_eq!(of("90 deg").as_deref(), Some("unstable, it falls along `P.angle`"), "{n}");
    }
}

/// A truss of `n` bays between point masses, of springs of 1e8 N/m, with 1 N at its tip.
fn truss(n: usize) -> String {
    let (mut bodies, mut springs, mut start, mut number) = (String::new(), String::new(), String::new(), 0);
    let name = |x: usize, y: usize| if x == 0 { format!("ground.C{y}") } else { format!("p{x}_{y}.origin") };
    for x in 1..=n {
        for y in [0, 1] {
            bodies += &format!("  p{x}_{y}: {{ mass: 1 kg }}\n");
            start += &format!("  p{x}_{y}.x: {x} m\n  p{x}_{y}.y: {y} m\n");
        }
        for ([a, b], [c, d]) in [([x - 1, 0], [x, 0]), ([x - 1, 1], [x, 1]), ([x - 1, 1], [x, 0]), ([x, 0], [x, 1])] {
            let length = ((c - a) as f64).hypot(d as f64 - b as f64);
            springs += &format!("  s{number}: {{ between: [{}, {}], stiffness: 1e8 N/m, length: {length} m }}\n", name(a, b), name(c, d));
            number += 1;
        }
    }
    format!(
        "grashof: 1\nname: truss\nspace: planar\ngravity: none\nground: {{ C0: [0, 0], C1: [0, 1] }}\nbodies:\n{bodies}springs:\n{springs}start:\n{start}loads: {{ tip: {{ at: p{n}_0.origin, force: [0, -1 N] }} }}\nstudies: {{ rest: {{ statics: {{ from: start }}, scalars: {{ low: last(s0.force), high: last(s1.force) }} }} }}\n"
    )
}

#[test]
fn a_truss_of_springs_is_stable_and_carries_the_moment_of_its_load() {
    for n in [40, 60] {
        let outcome = run(&truss(n), "rest");
        assert!(findings(&outcome, "equilibrium")[0].ends_with(": stable"), "{:?}", outcome.findings);
        // chords of the first bay; lengths change by some 1e-7
        let [low, high] = [outcome.scalars[0].abs(), outcome.scalars[1].abs()];
        near(low / n as f64, 1.0, 1e-6);
        near(high / (n - 1) as f64, 1.0, 1e-6);
    }
}

/// `n` levers on which two weights are in balance in any position.
fn levers(n: usize, angle: f64) -> String {
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    format!(
        "grashof: 1\nname: levers\nspace: planar\ngravity: [0, -9.81]\nbodies:\n{}joints:\n{}start:\n{}studies: {{ rest: {{ statics: {{ from: start }} }} }}\n",
        each(&|i| format!(
            "  b{i}: {{ points: {{ P: [20 cm, 0], Q: [-30 cm, 0] }}, attached: {{ p: {{ at: P, mass: 3 kg }}, q: {{ at: Q, mass: 2 kg }} }} }}\n"
        )),
        each(&|i| format!("  J{i}: {{ revolute: [ground, b{i}.origin] }}\n")),
        each(&|i| format!("  J{i}.angle: {} deg\n", angle + i as f64)),
    )
}

#[test]
fn a_balanced_lever_is_indifferent_in_any_position() {
    for n in [1, 120] {
        for angle in [0.0, 20.0, 47.0] {
            let outcome = run(&levers(n, angle), "rest");
            let told = findings(&outcome, "equilibrium")[0].to_owned();
            assert!(told.contains(": indifferent"), "{n} at {angle}: {told}");
        }
    }
}

/// A force of 0.3 N on a spring of 1 N/m beside four of 1e10 N/m, and rest without any force.
#[test]
fn a_soft_spring_is_drawn_as_far_as_its_force_says() {
    let text = |load: &str| {
        let each = |f: &dyn Fn(usize) -> String| (0..5).map(f).collect::<String>();
        format!(
            "grashof: 1\nname: soft\nspace: planar\ngravity: none\nbodies:\n{}joints:\n{}springs:\n{}loads: {{ pull: {{ joint: S0, force: {load} }} }}\nstudies: {{ rest: {{ statics: {{ from: start }}, scalars: {{ x: last(S0.position) }} }} }}\n",
            each(&|i| format!("  m{i}: {{ mass: 1 kg }}\n")),
            each(&|i| format!("  S{i}: {{ slider: [ground, m{i}.origin], axis: [1, 0] }}\n")),
            each(&|i| format!("  s{i}: {{ joint: S{i}, stiffness: {} N/m }}\n", if i == 0 { "1" } else { "1e10" })),
        )
    };
    for (load, x) in [("0.3 N", 0.3), ("0 N", 0.0)] {
        let outcome = run(&text(load), "rest");
        near(outcome.scalars[0], x, 1e-9);
        assert!(findings(&outcome, "equilibrium")[0].ends_with(": stable"), "{load}: {:?}", outcome.findings);
    }
}
