//! Rows and hanging chains against their closed forms.

use super::{G, codes, eigenvalues, list};
use crate::common::{close, study};
use grashof::geometry::Planar;
use grashof::mechanism::Coordinates;
use std::f64::consts::PI;

/// n masses in a row, n + 1 springs between two walls.
pub(crate) fn row(n: usize) -> String {
    let mut text = "grashof: 1\nname: row\nspace: planar\ngravity: none\nground: { O: [0, 0] }\n".to_string();
    let each = |f: &dyn Fn(usize) -> String| (1..=n).map(f).collect::<String>();
    text += &format!("bodies:\n{}", each(&|i| format!("  b{i}: {{ mass: 2 }}\n")));
    text += &format!("joints:\n{}", each(&|i| format!("  j{i}: {{ slider: [ground.O, b{i}.origin], axis: [1, 0] }}\n")));
    text += "springs:\n  s0: { joint: j1, stiffness: 50 }\n";
    text += &(1..n).map(|i| format!("  s{i}: {{ stretch: b{}.x - b{i}.x, stiffness: 50 }}\n", i + 1)).collect::<String>();
    text += &format!("  s{n}: {{ joint: j{n}, stiffness: 50 }}\n");
    text + "studies:\n  v: { modes: { methods: [library, jacobi, power] } }\n"
}

#[test]
fn a_row_of_masses_has_the_sines_of_its_closed_form() {
    let n = 9;
    let outcome = study(&row(n), "v", Coordinates::Joint);
    let right: Vec<f64> = (1..=n).map(|j| 4.0 * 25.0 * (j as f64 * PI / (2.0 * (n as f64 + 1.0))).sin().powi(2)).collect();
    for name in ["eigenvalues", "eigenvalues_jacobi", "eigenvalues_power"] {
        close(name, list(&outcome, name), &right, 1e-13);
    }
    close("frequencies", list(&outcome, "frequencies"), &right.iter().map(|x| x.sqrt()).collect::<Vec<_>>(), 1e-13);
    close("frequency_1 …", &outcome.results[..n], list(&outcome, "frequencies"), 0.0);
    assert!(outcome.results[n..].iter().all(|x| x.is_nan()) && outcome.results.len() == 12);
    // mode j at mass i is sin(ijπ/(n + 1)), of unit norm in the masses
    for (j, shape) in outcome.shapes.iter().enumerate() {
        let sines: Vec<f64> = (1..=n).map(|i| (i as f64 * (j + 1) as f64 * PI / (n as f64 + 1.0)).sin()).collect();
        let size = (sines.iter().map(|x| 2.0 * x * x).sum::<f64>()).sqrt();
        let sign = shape.iter().zip(&sines).map(|(a, b)| a.1 * b).sum::<f64>().signum();
        let found: Vec<f64> = shape.iter().map(|(_, x)| sign * x).collect();
        close("shape", &found, &sines.iter().map(|x| x / size).collect::<Vec<_>>(), 1e-11);
        assert_eq!(shape[0].0, "j1.position");
    }
    assert_eq!(codes(&outcome), Vec::<&str>::new());
}

/// n links in a line that hang; all mass at their ends (points), or spread along them.
pub(crate) fn chain(n: usize, length: f64, points: bool) -> String {
    let mut text = "grashof: 1\nname: chain\nspace: planar\ngravity: [0, -9.81]\nground: { O: [0, 0] }\nbodies:\n".to_string();
    for i in 1..=n {
        text += &if points {
            format!("  b{i}: {{ mass: 0.3, com: [{length}, 0], points: {{ start: [0, 0], end: [{length}, 0] }} }}\n")
        } else {
            format!("  b{i}: {{ bar: {{ length: {length}, mass: 0.3 }} }}\n")
        };
    }
    text += "joints:\n  j1: { revolute: [ground.O, b1.start] }\n";
    text += &(2..=n).map(|i| format!("  j{i}: {{ revolute: [b{}.end, b{i}.start] }}\n", i - 1)).collect::<String>();
    text += "start:\n  j1.angle: -90 deg\n";
    text + &(2..=n).map(|i| format!("  j{i}.angle: 0\n")).collect::<String>()
}

/// Zeros of Laguerre's polynomial L_n, by bisection between its signs.
fn laguerre(n: usize) -> Vec<f64> {
    let value = |x: f64| -> f64 {
        let (mut last, mut now) = (0.0, 1.0);
        for k in 0..n {
            let k = k as f64;
            (last, now) = (now, ((2.0 * k + 1.0 - x) * now - k * last) / (k + 1.0));
        }
        now
    };
    let mut zeros = Vec::new();
    let step = 0.01 / n as f64;
    let mut x = 0.0;
    while zeros.len() < n {
        let (mut a, mut b) = (x, x + step);
        if value(a) * value(b) < 0.0 {
            for _ in 0..100 {
                let middle = 0.5 * (a + b);
                if value(a) * value(middle) <= 0.0 { b = middle } else { a = middle }
            }
            zeros.push(0.5 * (a + b));
        }
        x += step;
    }
    zeros
}

#[test]
fn a_chain_of_beads_has_the_zeros_of_laguerre() {
    // L_n(λ l/g) = 0 (D. Bernoulli's chain; Levinson, J. Sound Vib. 49 (1976) 287-291)
    for n in [1, 2, 3, 8] {
        let right: Vec<f64> = laguerre(n).iter().map(|x| x * G / 0.4).collect();
        close("λ", &eigenvalues::<Planar<f64>>(&chain(n, 0.4, true), Coordinates::Joint), &right, 1e-11);
    }
    close(
        "λ, star tree",
        &eigenvalues::<Planar<f64>>(&chain(3, 0.4, true), Coordinates::Cartesian),
        &eigenvalues::<Planar<f64>>(&chain(3, 0.4, true), Coordinates::Joint),
        1e-9,
    );
}

#[test]
fn a_chain_of_many_links_hangs_like_a_rope() {
    // ω² = (j₀,ₖ/2)² g/L of the rope; zeros of J₀: Abramowitz & Stegun, table 9.5
    for (k, zero) in [2.404_825_557_7, 5.520_078_110_3, 8.653_727_912_9].into_iter().enumerate() {
        let rope = zero * zero / 4.0 * G;
        let off = |n: usize| (eigenvalues::<Planar<f64>>(&chain(n, 1.0 / n as f64, false), Coordinates::Joint)[k] / rope - 1.0).abs();
        let (coarse, fine) = (off(10), off(20));
        assert!(fine < 0.003 * ((k + 1) * (k + 1)) as f64 && fine < 0.6 * coarse, "mode {}: {coarse:e} and {fine:e}", k + 1);
    }
}
