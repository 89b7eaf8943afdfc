//! Friction by bristles (LuGre): Canudas de Wit, Olsson, Åström & Lischinsky, IEEE Trans. Autom. Control 40 (1995) 419-425.

use super::{close, done, drift, last, tried};

/// A block on a level guide that a load pushes or a driver moves.
fn block(friction: &str, pushed: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: block with bristles
space: planar
gravity: [0, -10 m/s^2]
bodies:
  block: {{ mass: 1 kg, inertia: 1e-3 kg m^2 }}
joints:
  W: {{ slider: [ground, block.origin], axis: [1, 0], friction: {{ {friction} }} }}
{pushed}
start: {{ W.position: 0 m }}
studies:
  move: {{ {study}, columns: [time, W.position, W.velocity, W.friction, W.bristle] }}
"
    )
}

/// The values of the paper's section III: F_C = 1 N, F_S = 1.5 N, v_s = 1 mm/s, σ₀ = 1e5 N/m, σ₁ = √1e5 N s/m.
const PAPER: &str = "coulomb: 1 N, static: 1.5 N, stribeck_speed: 1 mm/s, bristle: { stiffness: 1e5 N/m, damping: 316.227766 N s/m }";

/// The same by coefficients, with the weight of 10 N.
const BY_WEIGHT: &str = "coulomb: 0.1, static: 0.15, stribeck_speed: 1 mm/s, bristle: { stiffness: 1e4, damping: 31.6227766 }";

#[test]
fn at_constant_speed_the_friction_is_the_curve_of_stribeck() {
    for friction in [PAPER, BY_WEIGHT] {
        for v in [0.5e-3_f64, 2e-3, -1e-2] {
            let pushed = format!("drivers: {{ drive: {{ joint: W, position: {v} m/s*t }} }}");
            let outcome = done(&block(friction, &pushed, "dynamics: { until: 1 s, tolerance: 1e-9 }"), "move");
            let level = 1.0 + 0.5 * (-(v / 1e-3).powi(2)).exp();
            close(&format!("friction at {v} m/s"), last(&outcome)[3], -level * v.signum(), 1e-6);
            close(&format!("deflection at {v} m/s"), last(&outcome)[4], level * v.signum() / 1e5, 1e-11);
        }
    }
}

#[test]
fn below_the_break_away_the_block_hangs_on_its_bristles() {
    // a step of a small force leaves x = z(1 + O(F/F_S)): at rest σ₀ z = F, and x follows from dz/dx = 1 − z/z_s, z_s = F_S/σ₀
    let force: f64 = 0.01;
    let pushed = format!("loads: {{ push: {{ joint: W, force: {force} N }} }}");
    let outcome = done(&block(PAPER, &pushed, "dynamics: { until: 0.2 s, tolerance: 1e-10 }"), "move");
    close("deflection", last(&outcome)[4], force / 1e5, 1e-12);
    close("stiffness", force / last(&outcome)[1], 1e5, 1.5e3);
    assert!(last(&outcome)[2].abs() < 1e-8);
}

#[test]
fn a_slow_ramp_breaks_away_at_the_static_friction() {
    let pushed = "loads: { push: { joint: W, force: 0.05 N/s*t } }";
    let outcome = done(&block(PAPER, pushed, "dynamics: { until: 32 s, every: 10 ms, tolerance: 1e-8 }"), "move");
    // the largest friction of the way is that of the break-away
    let largest = outcome.extremes[3].as_ref().expect("extremes").min.value;
    close("break-away", largest, -1.5, 0.01);
    assert!(last(&outcome)[2] > 0.05, "it slides: {}", last(&outcome)[2]);
    assert!(drift(&outcome) < 1e-6, "{}", drift(&outcome));
}

#[test]
fn cycles_before_sliding_take_energy() {
    // a driver moves to and fro by less than the break-away needs: each closed loop of friction over place takes work
    let pushed = "drivers: { drive: { joint: W, position: 4e-6 m*sin(20 rad/s*t) } }";
    let period = std::f64::consts::TAU / 20.0;
    let until = 4.0 * period;
    let text = block(PAPER, pushed, &format!("dynamics: {{ until: {until} s, every: 1 ms, tolerance: 1e-10 }}"))
        .replace("  move: {", "  move: { scalars: { taken: -integral(W.friction*W.velocity) },");
    let outcome = done(&text, "move");
    let taken = outcome.scalars[0];
    assert!(taken > 1e-7, "taken: {taken}");
    assert!(super::march(&outcome).dampers < 0.0);
    close("work of the friction", super::march(&outcome).dampers, -taken, 1e-9);
}

#[test]
fn schemes_and_coordinates_agree_on_stick_and_slip() {
    // a spring whose far end is drawn at constant speed: the block sticks and slips (section IV of the paper)
    let pushed = "  F: { slider: [ground, far.origin], axis: [1, 0] }
drivers: { drive: { joint: F, position: 2 mm/s*t } }
springs: { pull: { stretch: W.position - F.position, stiffness: 200 N/m } }";
    let of = |settings: &str| {
        let text = block(PAPER, pushed, &format!("dynamics: {{ until: 6.4 s, every: 0.1 s, {settings} }}"));
        done(&text.replace("joints:", "  far: { mass: 1 kg, inertia: 1e-3 kg m^2 }\njoints:"), "move")
    };
    let reference = of("integrator: radau5, tolerance: 1e-10");
    let moved: Vec<f64> = reference.rows.iter().map(|r| r[2]).collect();
    assert!(moved.iter().any(|v| *v < 1e-5) && moved.iter().any(|v| *v > 3e-3), "it sticks and slips");
    assert!(drift(&reference) < 1e-6, "{}", drift(&reference));
    for settings in ["tolerance: 1e-9", "integrator: bdf, tolerance: 1e-9", "integrator: bdf, tolerance: 1e-9, coordinates: minimal"] {
        close(settings, last(&of(settings))[1], last(&reference)[1], 3e-6);
    }
}

#[test]
fn bristles_have_no_inverse_dynamics() {
    let pushed = "drivers: { drive: { joint: W, position: 1e-3 m*sin(1 rad/s*t) } }";
    let told =
        tried(&block(PAPER, pushed, "inverse: { over: 1 s, samples: 10 }").replace(", W.bristle", ""), "move").expect_err("a refusal");
    assert!(told.reason().contains("bristles of joint `W`"), "{}", told.reason());
}
