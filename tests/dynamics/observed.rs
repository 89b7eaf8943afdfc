//! Switches that only outputs read: they neither stop nor slow a motion, whatever they compare.

use super::{certified, scalar};
use crate::reference::Verdict;
use crate::reference::program::run_text;

const INTEGRATORS: [&str; 3] = ["dop853", "bdf", "radau5"];

/// A mass on a spring under gravity, with what its equation of motion lacks: round-off around zero.
const SPRING: &str = "
gravity: [0, -9.81 m/s^2]
bodies: { b: { mass: 2 kg } }
joints: { S: { slider: [ground, b.origin], axis: [0, 1] } }
springs: { k: { joint: S, stiffness: 100 N/m, damping: 1 N s/m } }
measures: { out: \"S.acceleration + 9.81 m/s^2 + (100 N/m*S.position + 1 N s/m*S.velocity)/2 kg\" }
";

/// Two equal bars in step by a gear, with the difference of their speeds.
const GEAR: &str = "
gravity: [0, -9.81 m/s^2]
ground: { A: [0, 0], B: [1 m, 0] }
bodies: { a: { bar: { length: 30 cm, mass: 1 kg } }, b: { bar: { length: 30 cm, mass: 1 kg } } }
joints:
  A: { revolute: [ground.A, a.start], damping: 0.1 N m s/rad }
  B: { revolute: [ground.B, b.start], damping: 0.1 N m s/rad }
couplings: { g: { gear: [A, B], ratio: 1 } }
loads: { m: { joint: A, torque: 2 N m } }
start: { A.angle: 0 deg, A.omega: 0 rad/s }
measures: { out: A.omega - B.omega }
";

/// A screw jack, with two balances that are round-off.
const SCREW: &str = "
gravity: [0, 0, -9.81 m/s^2]
bodies:
  nut: { mass: 100 kg, inertia: [0.02, 0.02, 0.02], com: [0.1, 0, 0] }
joints:
  S: { screw: [ground, nut.origin], axis: [0, 0, 1], pitch: 8 mm, damping: 0.01 N m s/rad }
springs: { tors: { joint: S, stiffness: 1 N m/turn, rest: -20 deg } }
motors: { mo: { joint: S, inertia: 1e-4 kg m^2, gear: 5 } }
loads: { l: { joint: S, torque: 3 N m } }
start: { S.angle: 0 deg, S.omega: 0 rad/s }
measures:
  inertia: \"0.02 kg m^2 + 100 kg*(0.1 m)^2 + 100 kg*(8 mm/1 turn)^2 + 25*1e-4 kg m^2\"
  torque: \"3 N m - 100 kg*9.81 m/s^2*8 mm/1 turn - 1 N m/turn*(S.angle + 20 deg) - 0.01 N m s/rad*S.omega\"
  out: \"abs(S.alpha - torque/inertia)/1 rad/s^2 + abs(S.fz - 100 kg*(9.81 m/s^2 + nut.az))/1 N\"
";

#[test]
fn round_off_in_a_column_neither_stops_nor_slows_a_motion() {
    let mut verdict = Verdict::default();
    for (name, space, model, within) in
        [("spring", "planar", SPRING, 1e-13), ("gear", "planar", GEAR, 1e-13), ("screw", "spatial", SCREW, 1e-11)]
    {
        for integrator in INTEGRATORS {
            let steps = |scalars: &str| {
                let text = format!(
                    "grashof: 1\nname: test\nspace: {space}{model}
studies:
  run:
    dynamics: {{ until: 2 s, every: 20 ms, tolerance: 1e-10, integrator: {integrator} }}
    columns: [time, energy]
{scalars}"
                );
                let run = run_text(&text, &["--no-plots"]).succeeded();
                let told = run.stderr.contains("changes faster than a millionth of a step") || run.stdout.contains("or is noise");
                (certified(&run, "run", "steps"), scalar(&run, "run", "worst"), told)
            };
            let (plain, ..) = steps("");
            let (with, worst, told) = steps("    scalars: { worst: max(abs(out)) }\n");
            let what = format!("{name} by {integrator}");
            verdict.close(&what, "steps", with, plain, 0.05 * plain + 3.0);
            verdict.close(&what, "largest", worst, 0.0, within);
            assert!(told || with == plain, "{what}: not told");
        }
    }
    verdict.give("round-off around zero in columns");
}

#[test]
fn a_switch_that_changes_too_fast_follows_its_values() {
    // some hundred thousand times in the first second
    let text = |study: &str| format!("grashof: 1\nname: test\nspace: planar{SPRING}studies:\n  run:\n{study}");
    let run = run_text(
        &text(
            "    dynamics: { until: 2 s, every: 7 ms, tolerance: 1e-8 }
    columns: [time, S.position, side]\n",
        )
        .replace("measures: {", "measures: { side: \"if(sin(1e7 rad/m*S.position) > 0, 1, -1)\","),
        &["--no-plots"],
    )
    .succeeded();
    assert!(run.stderr.contains("or is noise") || run.stdout.contains("or is noise"), "{}", run.stderr);
    let table = run.table("run");
    let (places, sides) = (table.column("S.position"), table.column("side"));
    // positions are written to rounding, which 1e7 multiplies
    let clear = places.iter().zip(&sides).filter(|(x, _)| (1e7 * **x).sin().abs() > 1e-3);
    let (right, all) = clear.fold((0, 0), |(right, all), (x, side)| (right + usize::from((1e7 * x).sin().signum() == *side), all + 1));
    assert!(right == all && all > 100, "{right} of {all}");
}

#[test]
fn a_parameter_that_an_event_sets_is_a_column() {
    let text = "grashof: 1
name: slide
space: planar
gravity: none
parameters: { push: 1 N }
bodies: { a: { mass: 2 kg } }
joints: { S: { slider: [ground, a.origin], axis: [1, 0] } }
loads: { f: { at: a.origin, force: [push, 0] } }
events: { far: { when: S.position - 10 cm, set: { push: 5 N } } }
studies:
  go:
    dynamics: { until: 1 s, every: 0.1 s }
    columns: [time, push]
    scalars: { early: \"value(push, 0 s)\", late: last(push), impulse: integral(push) }
";
    let run = run_text(text, &["--no-plots"]).succeeded();
    let json = run.json("go");
    let mut verdict = Verdict::default();
    // 10 cm of 0.5 m/s²
    let hit = 0.4_f64.sqrt();
    for (name, right) in [("early", 1.0), ("late", 5.0), ("impulse", 5.0 - 4.0 * hit)] {
        verdict.close(name, "go", json["scalars"][name].as_f64().unwrap_or(f64::NAN), right, 1e-9);
    }
    let beside = |row: &&Vec<f64>| (row[0] - hit).abs() > 1e-9;
    for row in run.table("go").rows.iter().filter(beside) {
        verdict.close("row", "go", row[1], if row[0] < hit { 1.0 } else { 5.0 }, 0.0);
    }
    verdict.give("set parameter");
}
