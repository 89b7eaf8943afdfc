//! Mechanisms of more than a hundred bodies, whose equilibria are found by sparse matrices.

use super::{findings, list, near, run};
use crate::common::study;
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
