//! Mechanisms of more than a hundred bodies, whose equilibria are found by sparse matrices.

use super::{findings, list, near, run};
use crate::common::{close, study};
use crate::reference::program::run_text;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use std::f64::consts::FRAC_PI_2;

const G: f64 = 9.81;

/// A chain of `n` bars of 1 m and 1 kg from the ground, with further joints, starts and studies.
fn chain(n: usize, spatial: bool, [ground, joints, start, studies]: [&str; 4]) -> String {
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    let [space, zero, axis] = if spatial { ["spatial", "[0, -9.81, 0]", ", axis: [0, 0, 1]"] } else { ["planar", "[0, -9.81]", ""] };
    format!(
        "grashof: 1\nname: chain\nspace: {space}\ngravity: {zero}\nground: {{ {ground} }}\nbodies:\n{}joints:\n{}{joints}start:\n{start}studies: {{ {studies} }}\n",
        each(&|i| {
            let inertia = if spatial { ", width: 1 cm, height: 1 cm" } else { "" };
            format!("  b{i}: {{ bar: {{ length: 1 m, mass: 1 kg{inertia} }} }}\n")
        }),
        each(&|i| {
            let before = if i == 0 { "ground.O".to_owned() } else { format!("b{}.end", i - 1) };
            format!("  P{i}: {{ revolute: [{before}, b{i}.start]{axis} }}\n")
        }),
    )
}

/// A chain of `n` bars that hangs between two points of one height, 0.7 n m apart; it begins as a V.
fn hung(n: usize, studies: &str) -> String {
    let slope = 0.7_f64.acos().to_degrees();
    let start: String = (0..n)
        .map(|i| {
            let angle = if i == 0 {
                -slope
            } else if i == n / 2 {
                2.0 * slope
            } else {
                0.0
            };
            format!("  P{i}.angle: ~{angle} deg\n")
        })
        .collect();
    let (ground, end) = (format!("O: [0, 0], E: [{} m, 0]", 0.7 * n as f64), format!("  Q: {{ revolute: [b{}.end, ground.E] }}\n", n - 1));
    chain(n, false, [&ground, &end, &start, studies])
}

/// Every bar pulls horizontally by the same H, and its middle carries what hangs below: tan θ_i = (V − (i + ½) m g)/H.
#[test]
fn a_long_chain_hangs_as_its_forces_say() {
    let n = 150;
    let bars = [0, 40, 75, 149];
    let scalars: String = bars.iter().map(|i| format!("a{i}: last(b{i}.angle), ")).collect();
    let outcome =
        run(&hung(n, &format!("it: {{ statics: {{ from: start }}, scalars: {{ {scalars}h: last(P0.fx), v: last(P0.fy) }} }}")), "it");
    assert_eq!(findings(&outcome, "equilibrium").len(), 1);
    assert!(findings(&outcome, "equilibrium")[0].ends_with(": stable"), "{:?}", outcome.findings);
    let [h, v] = [outcome.scalars[4], outcome.scalars[5]];
    // half of the weight on each side
    near(v.abs(), 0.5 * n as f64 * G, 1e-7);
    for (i, angle) in bars.iter().zip(&outcome.scalars) {
        let carried = 0.5 * n as f64 - (*i as f64 + 0.5);
        near(angle.tan(), -carried * G / h.abs(), 1e-9);
    }
    // the ends are where they are held: the horizontal ways of the bars add up
    let span: f64 = (0..n).map(|i| ((0.5 * n as f64 - (i as f64 + 0.5)) * G / h).atan().cos()).sum();
    near(span, 0.7 * n as f64, 1e-6);
}

fn hanging(n: usize, spatial: bool, from: &str) -> Outcome {
    let start = format!("  P0.angle: {from} deg\n") + &(1..n).map(|i| format!("  P{i}.angle: 0\n")).collect::<String>();
    let studies = "it: { statics: { from: start }, scalars: { middle: last(b60.start.x), low: last(b60.start.y), pull: last(P0.fy) } }";
    run(&chain(n, spatial, ["O: [0, 0]", "", &start, studies].map(|x| if spatial && x == "O: [0, 0]" { "O: [0, 0, 0]" } else { x })), "it")
}

#[test]
fn a_long_chain_hangs_straight_in_plane_and_space() {
    let n = 110;
    for spatial in [false, true] {
        let outcome = hanging(n, spatial, "-70");
        assert_eq!(outcome.results, [1.0], "{:?}", outcome.findings);
        near(list(&outcome, "equilibria.P0.angle")[0], -FRAC_PI_2, 1e-9);
        near(list(&outcome, "equilibria.P100.angle")[0], 0.0, 1e-9);
        near(outcome.scalars[0], 0.0, 1e-8);
        near(outcome.scalars[1], -60.0, 1e-9);
        near(outcome.scalars[2].abs(), n as f64 * G, 1e-8);
        assert_eq!(findings(&outcome, "one-equilibrium").len(), 1);
    }
}

#[test]
fn a_long_chain_that_stands_upright_stays_and_falls_in_all_motions() {
    let n = 110;
    let outcome = hanging(n, false, "90");
    assert_eq!(outcome.results, [0.0]);
    near(list(&outcome, "equilibria.P0.angle")[0], FRAC_PI_2, 1e-12);
    let told = findings(&outcome, "equilibrium")[0];
    assert!(told.contains(&format!("unstable, it falls in {n} motions")), "{told}");
}

/// The modes about an equilibrium, on the tree of short roads, and by full matrices on the joints' own, for which a state that nothing reads
/// also finds the equilibrium by full matrices.
#[test]
fn sparse_and_full_matrices_find_one_equilibrium() {
    let n = 102;
    let studies =
        "few: { modes: { at: statics, lowest: 6, methods: [library] } }, many: { modes: { at: statics, lowest: 6, methods: [lanczos] } }";
    let text = hung(n, studies);
    let sparse = study(&text, "many", Coordinates::Joint);
    let joints = study(&text, "few", Coordinates::Joint);
    let full =
        study(&text.replace("\nstart:\n", "\nstates: { idle: { rate: -idle/(1 s), start: 0 } }\nstart:\n"), "few", Coordinates::Joint);
    let of = |outcome: &Outcome| list(outcome, "eigenvalues").to_vec();
    let expected = of(&full);
    assert_eq!(expected.len(), 6);
    for found in [of(&sparse), of(&joints)] {
        found.iter().zip(&expected).for_each(|(x, y)| near(x / y, 1.0, 1e-7));
    }
}

#[test]
fn what_a_long_chain_lacks_is_told() {
    // nothing holds it: it falls and falls
    let n = 110;
    let start: String = (1..n).map(|i| format!("  P{i}.angle: 0\n")).collect();
    let text = chain(n, false, ["O: [0, 0]", "", &start, "it: { statics: { from: start } }"])
        .replace("  P0: { revolute: [ground.O, b0.start] }\n", "");
    let run = run_text(&text, &["--no-plots"]);
    assert_eq!(run.code, 3, "{}", run.stderr);
    for word in ["moves on and on", "stays unbalanced", "hold it"] {
        assert!(run.stderr.contains(word), "no `{word}` in:\n{}", run.stderr);
    }
}

/// What a truss of many bays with a load at its tip carries at its root is the moment of the load: rows come near to dependence along it,
/// and more so where light bars stand beside heavy ones.
#[test]
fn a_long_truss_carries_what_is_put_on_its_tip() {
    for masses in [["1 g", "1 g"], ["1 kg", "1 g"], ["1 kg", "1e-6 kg"]] {
        let text = truss(60, masses);
        let found = study(&text, "s", Coordinates::Joint);
        // lower chord, upper chord, and the diagonal of the first bay
        close(&format!("{masses:?}"), &found.rows[0], &[60.0, 0.0, -59.0, 0.0, -1.0, 1.0], 1e-9);
    }
}

/// A truss of `n` bays from the ground, pinned, of bars whose masses alternate, with 1 N at its tip.
fn truss(n: usize, masses: [&str; 2]) -> String {
    let (mut bodies, mut joints, mut number) = (String::new(), String::new(), 0);
    // the bars that end at the lower and at the upper corner before
    let mut corners = [vec!["ground.B".to_owned()], vec!["ground.T".to_owned()]];
    for bay in 0..n {
        let [near, far] = [bay, bay + 1];
        let bars = [[(near, 0), (far, 0)], [(near, 1), (far, 1)], [(near, 1), (far, 0)], [(far, 1), (far, 0)]];
        let mut ahead = [vec![], vec![]];
        for (k, [from, to]) in bars.into_iter().enumerate() {
            let name = format!("m{}", 4 * bay + k);
            bodies +=
                &format!("  {name}: {{ bar: {{ from: [{}, {}], to: [{}, {}], mass: {} }} }}\n", from.0, from.1, to.0, to.1, masses[k % 2]);
            for ((x, y), end) in [(from, "start"), (to, "end")] {
                let pins = if x == bay { &mut corners[y] } else { &mut ahead[y] };
                if let Some(other) = pins.first() {
                    joints += &format!("  J{number}: {{ revolute: [{other}, {name}.{end}] }}\n");
                    number += 1;
                }
                pins.push(format!("{name}.{end}"));
            }
        }
        corners = ahead;
    }
    format!(
        "grashof: 1\nname: truss\nspace: planar\ngravity: none\nground: {{ B: [0, 0], T: [0, 1] }}\nbodies:\n{bodies}joints:\n{joints}
loads: {{ tip: {{ at: m{}.end, force: [0, -1 N] }} }}
studies: {{ s: {{ statics: {{ from: start }}, columns: [J0.fx, J0.fy, J1.fx, J1.fy, J2.fx, J2.fy] }} }}\n",
        4 * n - 3
    )
}

/// The same chain drawn taut, in `statics` and in the modes about it: the pull grows far beyond the weight, and stiffens it. The lowest
/// frequencies by sparse matrices are those by full ones.
#[test]
fn a_taut_chain_pulls_and_swings_as_its_forces_say() {
    for (n, span) in [(101, 0.999), (200, 0.9999), (200, 0.99999)] {
        // the horizontal pull by bisection, of a chain of 1 kg and 1 m
        let slope = |pull: f64, i: usize| (G / n as f64 * (0.5 * (n - 1) as f64 - i as f64) / pull).atan();
        let reach = |pull: f64| (0..n).map(|i| slope(pull, i).cos()).sum::<f64>() / n as f64;
        let (mut low, mut high) = (1e-3, 1e6);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if reach(middle) < span { low = middle } else { high = middle }
        }
        let pull = 0.5 * (low + high);
        let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
        let text = format!(
            "grashof: 1\nname: taut chain\nspace: planar\ngravity: [0, -9.81]\nground: {{ A: [0, 0], B: [{span} m, 0] }}\nbodies:\n{}joints:\n{}  \
             Q: {{ revolute: [ground.B, b{}.end] }}\nstart:\n{}studies:
  s: {{ statics: {{ from: start }}, columns: [P0.fx, P0.fy, Q.fx] }}
  lowest: {{ modes: {{ at: statics, lowest: 3 }} }}
  full: {{ modes: {{ at: statics, methods: [library] }} }}\n",
            each(&|i| format!("  b{i}: {{ bar: {{ length: {} m, mass: {} kg }} }}\n", 1.0 / n as f64, 1.0 / n as f64)),
            each(&|i| {
                let before = if i == 0 { "ground.A".to_owned() } else { format!("b{}.end", i - 1) };
                format!("  P{i}: {{ revolute: [{before}, b{i}.start] }}\n")
            }),
            n - 1,
            each(&|i| format!("  b{i}.angle: ~{} rad\n", -slope(pull, i))),
        );
        let found = study(&text, "s", Coordinates::Joint);
        close(&format!("{n} bars over {span}"), &found.rows[0], &[-pull, 0.5 * G, pull], 1e-7);
        let [sparse, full] = ["lowest", "full"].map(|name| list(&study(&text, name, Coordinates::Joint), "eigenvalues").to_vec());
        for (sparse, full) in sparse.iter().zip(&full) {
            assert!((sparse / full - 1.0).abs() < 1e-8, "{n} bars over {span}: {sparse} and {full}");
        }
    }
}
