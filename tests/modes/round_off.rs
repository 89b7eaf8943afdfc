//! Stiffnesses that are zero but for round-off: free motions, neither vibrations nor unstable ones; and what is slow, but not free.

use super::{codes, list, study};
use grashof::mechanism::Coordinates;

#[test]
fn a_wheel_on_a_rope_is_free_about_the_vertical() {
    let text = "grashof: 1
name: wheel on a rope
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: { ceiling: [0, 0, 2 m] }
bodies:
  wheel: { mass: 3 kg, inertia: [0.09 kg m^2, 0.09 kg m^2, 0.17 kg m^2], points: { handle: [0, 0, -12 cm] } }
joints:
  rope: { distance: [ground.ceiling, wheel.handle], length: 1 m }
start: { wheel.rpy: [0 deg, 90 deg, 0 deg], wheel.x: 12 cm, wheel.y: 0 m, wheel.z: ~1 m }
studies:
  hanging: { modes: { at: statics } }
  few: { modes: { at: statics, lowest: 3, methods: [lanczos] } }
  held: { modes: {} }
";
    for name in ["hanging", "few", "held"] {
        let outcome = study(text, name, Coordinates::Joint);
        let frequencies = list(&outcome, "frequencies");
        assert_eq!(frequencies.iter().filter(|f| **f == 0.0).count(), 1, "{name}: {frequencies:?}");
        assert_eq!(codes(&outcome).contains(&"unstable"), name == "held", "{name}: {:?}", codes(&outcome));
        assert!(codes(&outcome).contains(&"free-motion"), "{name}: {:?}", codes(&outcome));
    }
}

#[test]
fn a_balanced_lever_is_free_in_any_position() {
    for angle in [0.0, 20.0, 47.0] {
        let text = format!(
            "grashof: 1
name: lever
space: planar
gravity: [0, -9.81]
bodies: {{ b: {{ points: {{ P: [20 cm, 0], Q: [-30 cm, 0] }}, attached: {{ p: {{ at: P, mass: 3 kg }}, q: {{ at: Q, mass: 2 kg }} }} }} }}
joints: {{ J: {{ revolute: [ground, b.origin] }} }}
start: {{ J.angle: {angle} deg }}
studies: {{ plain: {{ modes: {{}} }}, damped: {{ modes: {{ damped: true }} }}, few: {{ modes: {{ methods: [lanczos] }} }} }}
"
        );
        for name in ["plain", "damped", "few"] {
            let found = study(&text, name, Coordinates::Joint);
            let told = codes(&found);
            assert!(told.contains(&"free-motion") && !told.contains(&"unstable"), "{angle} {name}: {:?}", found.findings);
        }
    }
}

/// Three slides in a row, the first with springs and dampers of the ground, the last with springs of the second.
fn slides(first: &str, second: &str, more: &str) -> String {
    format!(
        "grashof: 1
name: slides
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 1 kg }}, c: {{ mass: 1.7 kg }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0] }}
  B: {{ slider: [a.origin, b.origin], axis: [1, 0] }}
  C: {{ slider: [ground, c.origin], axis: [1, 0] }}
springs: {{ p: {{ joint: A, {first} }}, q: {{ joint: B, {second} }}{more} }}
studies: {{ full: {{ modes: {{ damped: true }} }}, sparse: {{ modes: {{ damped: true, methods: [lanczos] }} }} }}
"
    )
}

#[test]
fn a_slow_decay_beside_a_stiff_spring_is_not_free() {
    // of both masses together: 2 s² + 100 s + 1 = 0, but for the stiff spring between them; the third is free
    let text = slides("stiffness: 1 N/m, damping: 100 N s/m", "stiffness: 1e10 N/m", "");
    let slow = (-50.0 + f64::sqrt(50.0 * 50.0 - 2.0)) / 2.0;
    for name in ["full", "sparse"] {
        let outcome = study(&text, name, Coordinates::Joint);
        let real = list(&outcome, "eigenvalues_real");
        assert_eq!(real[..2], [0.0; 2], "{name}: {real:?}");
        assert!((real[2] / slow - 1.0).abs() < 1e-6, "{name}: {real:?}, {slow}");
        let free: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "free-motion").map(|f| f.message.as_str()).collect();
        assert!(free.len() == 2 && free.iter().all(|m| m.contains("of `C.position`:")), "{name}: {free:?}");
    }
}

#[test]
fn what_has_no_damper_is_not_damped() {
    // p holds the first two to the ground or nothing does; a damper between the two of them, or none; the third on its own spring
    let own = ", r: { joint: C, stiffness: 4 N/m }";
    for (first, damper, free, damped) in [(3.0, "", 0, 0), (0.0, "", 2, 0), (0.0, ", damping: 3 N s/m", 2, 1)] {
        let text = slides(&format!("stiffness: {first} N/m"), &format!("stiffness: 1237 N/m{damper}"), own);
        for name in ["full", "sparse"] {
            let outcome = study(&text, name, Coordinates::Joint);
            let [real, imaginary, ratios] = ["eigenvalues_real", "eigenvalues_imaginary", "damping_ratios"].map(|of| list(&outcome, of));
            let at_rest: Vec<usize> = (0..real.len()).filter(|i| real[*i] == 0.0 && imaginary[*i] == 0.0).collect();
            assert_eq!(at_rest, (0..free).collect::<Vec<_>>(), "{name}, {first}: {real:?} {imaginary:?}");
            assert!(at_rest.iter().all(|i| ratios[*i].is_nan()), "{name}: {ratios:?}");
            let moving = &ratios[free..];
            assert_eq!(moving.iter().filter(|ratio| **ratio > 1e-3).count(), damped, "{name}, {first}: {ratios:?}");
            assert_eq!(
                moving.iter().filter(|ratio| **ratio == 0.0 && ratio.is_sign_positive()).count(),
                moving.len() - damped,
                "{ratios:?}"
            );
        }
    }
}

#[test]
fn a_state_that_pushes_back_holds_what_no_spring_holds() {
    // y' = x, and a force of -y and -3x' on 1 kg: s³ + 3 s² + 1 = 0, of which nothing is free; without the force all of it is
    for force in [1.0, 0.0] {
        let text = format!(
            "grashof: 1
name: integral
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0], damping: 3 N s/m }} }}
states: {{ y: {{ start: 0, rate: A.position/(1 m*1 s) }} }}
loads: {{ f: {{ joint: A, force: -{force} N*y }} }}
studies: {{ all: {{ modes: {{ damped: true }} }} }}
"
        );
        let outcome = study(&text, "all", Coordinates::Joint);
        let [real, imaginary] = ["eigenvalues_real", "eigenvalues_imaginary"].map(|of| list(&outcome, of));
        let polynomial = |s: nalgebra::Complex<f64>| s * s * s + s * s * 3.0 + force;
        for (re, im) in real.iter().zip(imaginary) {
            let rest = polynomial(nalgebra::Complex::new(*re, *im));
            assert!(rest.norm() < 1e-12, "{real:?} {imaginary:?}: {rest}");
        }
        assert_eq!(codes(&outcome).contains(&"free-motion"), force == 0.0, "{:?}", outcome.findings);
    }
}
