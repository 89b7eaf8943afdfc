//! Laws that are defined on their own side of a switch alone, as a root of `max(0, x)`: motions in time go to the switch and on behind
//! it, where a step looks beyond it, too. Closed forms, in every scheme.

use super::scalar;
use crate::reference::Verdict;
use crate::reference::program::run_text;

/// Schemes, and what they reach.
const SCHEMES: [(&str, f64); 6] = [
    ("integrator: dop853, tolerance: 1e-9", 1e-7),
    ("integrator: auto", 1e-6),
    ("integrator: radau5", 1e-6),
    ("integrator: bdf, tolerance: 1e-9", 1e-6),
    ("integrator: newmark, step: 0.2 ms", 1e-5),
    ("integrator: rk4, step: 0.5 ms, switches: step-over", 1e-4),
];

/// Whether a scheme asks for the slope of a force, which a root has none of where it ends.
fn is_implicit(scheme: &str) -> bool {
    ["radau5", "bdf", "newmark"].iter().any(|name| scheme.contains(name))
}

/// A block of 1 kg on a slide, and what else there is.
fn block(rest: &str) -> String {
    format!(
        "grashof: 1
name: block
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
{rest}
"
    )
}

#[test]
fn impulses_of_laws_that_end() {
    let mut verdict = Verdict::default();
    let laws = [
        ("sqrt(max(0, 0.5 - t/1 s))", 0.5_f64.powf(1.5) / 1.5),
        ("max(0, t/1 s - 0.3)^1.5", 0.7_f64.powf(2.5) / 2.5),
        ("if(t > 0.3 s, (t/1 s - 0.3)^1.5, 0)", 0.7_f64.powf(2.5) / 2.5),
        ("abs(t/1 s - 0.5)^1.5", 2.0 * 0.5_f64.powf(2.5) / 2.5),
        ("acos(clamp(t/0.5 s, 0, 1))/1 rad", 0.5),
        ("max(0, 1 - t/0.4 s)*log(max(1e-6, 1 - t/0.4 s))", -0.1),
    ];
    for (scheme, within) in SCHEMES {
        for (law, impulse) in laws {
            if is_implicit(scheme) && (law.contains("sqrt") || law.contains("acos")) {
                continue;
            }
            let rest = format!(
                "loads: {{ f: {{ joint: S, force: \"1 N*{law}\" }} }}
studies: {{ run: {{ dynamics: {{ until: 1 s, {scheme} }}, columns: [time, S.velocity], scalars: {{ v: last(S.velocity) }} }} }}"
            );
            let run = run_text(&block(&rest), &["--no-plots"]).succeeded();
            verdict.close("v", format!("{law}, {scheme}"), scalar(&run, "run", "v"), impulse, within);
        }
    }
    verdict.give("beyond");
}

/// A mass that falls on a stiff floor: with switches stepped over `rk4` is the classical scheme, each stage on its own branch.
#[test]
fn stages_that_step_over_a_switch_take_their_own_branch() {
    let (h, steps) = (2e-3, 1000);
    let rate = |[x, v]: [f64; 2]| [v, (-1e4 * x).max(0.0) - 9.81];
    let after = |[x, v]: [f64; 2], [dx, dv]: [f64; 2], h: f64| [x + h * dx, v + h * dv];
    let mut y = [0.1, 0.0];
    for _ in 0..steps {
        let k1 = rate(y);
        let k2 = rate(after(y, k1, 0.5 * h));
        let k3 = rate(after(y, k2, 0.5 * h));
        let k4 = rate(after(y, k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    let mut verdict = Verdict::default();
    for law in ["max(0 N, -1e4 N/m*S.position)", "if(S.position > 0 m, 0 N, -1e4 N/m*S.position)"] {
        let rest = format!(
            "loads: {{ floor: {{ joint: S, force: \"{law}\" }}, weight: {{ joint: S, force: -9.81 N }} }}
start: {{ S.position: 0.1 m }}
studies:
  run:
    dynamics: {{ until: 2 s, integrator: rk4, step: 2 ms, switches: step-over }}
    columns: [time, S.position, S.velocity]
    scalars: {{ x: last(S.position), v: last(S.velocity) }}"
        );
        let run = run_text(&block(&rest), &["--no-plots"]).succeeded();
        verdict.close("x", law, scalar(&run, "run", "x"), y[0], 1e-9);
        verdict.close("v", law, scalar(&run, "run", "v"), y[1], 1e-7);
    }
    verdict.give("step over");
}

#[test]
fn a_ball_leaves_a_floor_that_gives_way_as_hertz_says() {
    let (k, h, g): (f64, f64, f64) = (1e6, 0.1, 9.81);
    // m g (h + d) = k d^2.5/2.5, and the speed is largest where k d^1.5 = m g
    let depth = (0..60).fold(1e-2_f64, |d, _| (2.5 * g * (h + d) / k).powf(0.4));
    let at = (g / k).powf(2.0 / 3.0);
    let speed = (2.0 * g * (h + at) - 2.0 * k * at.powf(2.5) / 2.5).sqrt();
    let mut verdict = Verdict::default();
    for (scheme, within) in SCHEMES {
        let rest = format!(
            "loads: {{ floor: {{ joint: S, force: \"1e6 N*max(0, -S.position/1 m)^1.5\" }}, weight: {{ joint: S, force: -9.81 N }} }}
start: {{ S.position: 0.1 m }}
studies: {{ run: {{ dynamics: {{ until: 0.25 s, {scheme} }}, columns: [time, S.position, S.velocity],
  scalars: {{ d: min(S.position), v: max(S.velocity), end: last(S.velocity), push: \"mean(max(0, -S.position/1 m)^1.5)\" }} }} }}"
        );
        let run = run_text(&block(&rest), &["--no-plots"]).succeeded();
        verdict.close("depth", scheme, scalar(&run, "run", "d"), -depth, within);
        verdict.close("speed", scheme, scalar(&run, "run", "v"), speed, 20.0 * within);
        // what the floor gives in all turns the fall round: its mean over the time is known by the speed at the end
        let impulse = scalar(&run, "run", "push") * k * 0.25;
        verdict.close("impulse", scheme, impulse, scalar(&run, "run", "end") + g * 0.25, 20.0 * within);
    }
    verdict.give("hertz");
}

#[test]
fn a_tank_runs_empty() {
    let mut verdict = Verdict::default();
    for (scheme, within) in SCHEMES {
        if is_implicit(scheme) {
            continue;
        }
        let rest = format!(
            "states: {{ h: {{ start: 1, rate: \"-2*sqrt(max(0, h))/1 s\" }} }}
loads: {{ f: {{ joint: S, force: 1 N*h }} }}
studies: {{ run: {{ dynamics: {{ until: 1.5 s, {scheme} }}, columns: [time, h, S.velocity], scalars: {{ level: last(h), v: last(S.velocity) }} }} }}"
        );
        let run = run_text(&block(&rest), &["--no-plots"]).succeeded();
        verdict.close("h", scheme, scalar(&run, "run", "level"), 0.0, within);
        verdict.close("v", scheme, scalar(&run, "run", "v"), 1.0 / 3.0, within);
    }
    verdict.give("tank");
}
