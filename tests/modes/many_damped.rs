//! The lowest damped modes by sparse matrices: those of full ones, in all coordinates, and those of closed forms.

use super::chains::{chain, row};
use super::many::sparse;
use super::{codes, four_bar, held, list};
use crate::common::{close, study};
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::lowest_damped::{LowestDamped, growing, lowest_damped};
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use grashof::studies::modes::damped::{damped, state_matrix};
use nalgebra::Complex;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// μ of x″ + c x′ + λ x = 0, one of a pair.
fn roots(c: f64, lambda: f64) -> Vec<Complex<f64>> {
    let inside = 0.25 * c * c - lambda;
    if inside < 0.0 {
        return vec![Complex::new(-0.5 * c, (-inside).sqrt())];
    }
    let far = -0.5 * c - inside.sqrt();
    vec![Complex::from(lambda / far), Complex::from(far)]
}

/// The `count` lowest of many eigenvalues.
fn lowest(mut all: Vec<Complex<f64>>, count: usize) -> Vec<Complex<f64>> {
    all.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    all.truncate(count);
    all
}

fn same(what: &str, found: &[Complex<f64>], right: &[Complex<f64>], tolerance: f64) {
    assert_eq!(found.len(), right.len(), "{what}: {found:?}");
    for (found, right) in found.iter().zip(right) {
        assert!((found - right).norm() <= tolerance * right.norm(), "{what}: {found} and {right}");
    }
}

fn of_study(outcome: &Outcome) -> Vec<Complex<f64>> {
    let [re, im] = ["eigenvalues_real", "eigenvalues_imaginary"].map(|name| list(outcome, name));
    re.iter().zip(im).map(|(re, im)| Complex::new(*re, *im)).collect()
}

#[test]
fn a_long_row_with_dampers_has_the_roots_of_its_sines() {
    // C = αM + βK: the lowest motions creep, the others swing
    let (n, alpha, beta) = (300, 0.2, 0.01);
    let text = row(n)
        .replace("axis: [1, 0] }", &format!("axis: [1, 0], damping: {} }}", 2.0 * alpha))
        .replace("stiffness: 50 }", &format!("stiffness: 50, damping: {} }}", 50.0 * beta))
        .replace("modes: { methods: [library, jacobi, power] }", "modes: { damped: true, lowest: 9 }");
    let outcome = study(&text, "v", Coordinates::Joint);
    let all = (1..=n).flat_map(|j| {
        let lambda = 4.0 * 25.0 * (j as f64 * PI / (2.0 * (n as f64 + 1.0))).sin().powi(2);
        roots(alpha + beta * lambda, lambda)
    });
    same("μ", &of_study(&outcome), &lowest(all.collect(), 9), 1e-9);
    assert_eq!(codes(&outcome), ["lowest-modes"]);
    let sines: Vec<f64> = (1..=n).map(|i| (i as f64 * PI / (n as f64 + 1.0)).sin()).collect();
    let found: Vec<f64> = outcome.shapes[0].iter().filter(|(name, _)| !name.ends_with(".phase")).map(|(_, x)| *x).collect();
    let largest = sines.iter().copied().fold(0.0, f64::max);
    close("shape", &found, &sines.iter().map(|x| x / largest).collect::<Vec<_>>(), 1e-8);
}

/// The lowest by full and by sparse matrices, off balance.
fn agree<S>(text: &str, all: &[Coordinates], count: usize, tolerance: f64)
where
    S: Space<S = f64>,
{
    let (.., full) = held::<S>(text, Coordinates::Joint);
    let right = damped(&state_matrix(&full, true).expect("masses"), full.mass.nrows()).expect("numbers");
    let right: Vec<Complex<f64>> = right.iter().take(count).map(|mode| mode.value).collect();
    for &coordinates in all {
        let held = sparse::<S>(text, coordinates);
        assert!(held.pencil.asymmetry(&held.pencil.damping) < 1e-12, "{coordinates:?}");
        let LowestDamped { motions, .. } = lowest_damped(&held.pencil, count, Some(10.0), &|| false).expect("convergence");
        same(&format!("{coordinates:?}"), &motions.iter().map(|m| m.value).collect::<Vec<_>>(), &right, tolerance);
    }
}

#[test]
fn a_pose_off_balance_has_the_damped_modes_of_joint_coordinates_in_all() {
    use Coordinates::{Bounded, Cartesian, Joint};
    let mut bent = chain(24, 0.4, false).replace("j3.angle: 0", "j3.angle: 30 deg").replace("j1.angle: -90 deg", "j1.angle: -80 deg");
    for (i, damping) in [(2, 0.3), (5, 20.0), (7, 0.01), (20, 0.05)] {
        let joint = format!("b{i}.start]");
        bent = bent.replace(&joint, &format!("{joint}, damping: {damping}"));
    }
    agree::<Planar<f64>>(&bent, &[Joint, Bounded(2), Bounded(4), Cartesian], 8, 1e-8);
    for spatial in [false, true] {
        let loops = four_bar(spatial, 4.0).replace("revolute: [ground.O, crank.start]", "revolute: [ground.O, crank.start], damping: 0.7");
        assert!(loops.contains("damping"), "{loops}");
        if spatial {
            agree::<Spatial<f64>>(&loops, &[Joint, Bounded(1), Cartesian], 1, 1e-8);
        } else {
            agree::<Planar<f64>>(&loops, &[Joint, Bounded(1), Cartesian], 1, 1e-9);
        }
    }
}

#[test]
fn each_of_many_equal_damped_modes_is_found() {
    // pendulums beside each other, some of them upside down: μ² + c/J μ + λ = 0
    let n = 40;
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    let text = format!(
        "grashof: 1\nname: pendulums\nspace: planar\ngravity: [0, -9.81]\nground: {{ O: [0, 0] }}\nbodies:\n{}joints:\n{}start:\n{}studies: {{ v: {{ modes: {{ damped: true, lowest: 30, methods: [lanczos] }} }} }}\n",
        each(&|i| format!("  b{i}: {{ bar: {{ length: {}, mass: 3 }} }}\n", if i % 2 == 0 { 2 } else { 1 })),
        each(&|i| format!("  j{i}: {{ revolute: [ground.O, b{i}.start], damping: {} }}\n", if i % 2 == 0 { 2.0 } else { 8.0 })),
        each(&|i| format!("  j{i}.angle: {} deg\n", if i % 10 == 9 { 90 } else { -90 })),
    );
    let outcome = study(&text, "v", Coordinates::Joint);
    let all = (0..n).flat_map(|i| {
        let sign = if i % 10 == 9 { -1.0 } else { 1.0 };
        if i % 2 == 0 { roots(0.5, sign * 1.5 * super::G / 2.0) } else { roots(8.0, sign * 1.5 * super::G) }
    });
    let right = lowest(all.collect(), 30);
    same("μ", &of_study(&outcome), &right, 1e-9);
    // four motions leave the pose, whatever is listed of them
    assert_eq!(codes(&outcome).iter().filter(|code| **code == "unstable").count(), right.iter().filter(|mu| mu.re > 0.0).count());
}

#[test]
fn a_free_row_has_motions_without_a_rate() {
    // no walls: the whole moves on, and comes to rest where dampers lead to the ground
    for (alpha, right) in [(0.0, 0.0), (0.3, -0.3)] {
        let n = 120;
        let text = row(n)
            .replace("  s0: { joint: j1, stiffness: 50 }\n", "")
            .replace(&format!("  s{n}: {{ joint: j{n}, stiffness: 50 }}\n"), "")
            .replace("axis: [1, 0] }", &format!("axis: [1, 0], damping: {} }}", 2.0 * alpha))
            .replace("modes: { methods: [library, jacobi, power] }", "modes: { damped: true, lowest: 6 }");
        let outcome = study(&text, "v", Coordinates::Joint);
        let found = of_study(&outcome);
        let swing = |j: usize| roots(alpha, 4.0 * 25.0 * (j as f64 * PI / (2.0 * n as f64)).sin().powi(2));
        let all: Vec<Complex<f64>> = (1..n).flat_map(swing).collect();
        let size = found.iter().map(|mu| mu.norm()).fold(0.0, f64::max);
        assert!(found[0].norm() < 1e-7 * size, "{found:?}");
        if right == 0.0 {
            assert!(found[1].norm() < 1e-7 * size, "{found:?}");
            same("μ", &found[2..], &lowest(all, 4), 1e-8);
        } else {
            same("μ", &found[1..], &lowest([all, vec![Complex::from(right)]].concat(), 5), 1e-8);
        }
        assert!(!codes(&outcome).contains(&"unstable"), "{:?}", outcome.findings);
    }
}

#[test]
fn what_drives_is_not_counted() {
    // a negative damper gives energy: motions may grow anywhere above those that are listed
    let text = |damping: f64| row(120).replacen("axis: [1, 0] }", &format!("axis: [1, 0], damping: {damping} }}"), 1);
    assert_eq!(growing(&sparse::<Planar<f64>>(&text(3.0), Coordinates::Joint).pencil), Some(0));
    assert_eq!(growing(&sparse::<Planar<f64>>(&row(120), Coordinates::Joint).pencil), Some(0));
    let driven = text(0.0).replace("studies:", "loads: { push: { at: b7.origin, force: [3 N s/m*b7.vx, 0] } }\nstudies:");
    assert_eq!(growing(&sparse::<Planar<f64>>(&driven, Coordinates::Joint).pencil), None);
}

/// Bars of 1 kg and 0.1 g in turn, drawn taut between two points, with a damper from one of them to a place.
fn taut(n: usize, span: f64, damping: f64) -> String {
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    // a parabola of this length
    let sag = (0.375 * (1.0 - span)).sqrt();
    format!(
        "grashof: 1\nname: taut chain\nspace: planar\ngravity: [0, -9.81]\nground: {{ A: [0, 0], B: [{span} m, 0] }}\nbodies:\n{}joints:\n{}  Q: {{ revolute: [ground.B, b{}.end] }}\nsprings: {{ d: {{ between: [ground.A, b{}.end], damping: {damping} N s/m }} }}\nstart:\n{}studies:
  undamped: {{ modes: {{ at: statics, lowest: 4 }} }}
  many: {{ modes: {{ at: statics, damped: true, lowest: 4 }} }}
  full: {{ modes: {{ at: statics, damped: true, methods: [library] }} }}\n",
        each(&|i| format!("  b{i}: {{ bar: {{ length: {} m, mass: {} }} }}\n", 1.0 / n as f64, ["1 kg", "0.1 g"][i % 2])),
        each(&|i| {
            let before = if i == 0 { "ground.A".to_owned() } else { format!("b{}.end", i - 1) };
            format!("  P{i}: {{ revolute: [{before}, b{i}.start] }}\n")
        }),
        n - 1,
        n / 2,
        each(&|i| format!("  b{i}.angle: ~{} rad\n", 4.0 * sag * ((2 * i + 1) as f64 / n as f64 - 1.0))),
    )
}

/// Decays far below the frequencies, and none at all.
#[test]
fn a_taut_chain_of_light_and_heavy_bars_decays_as_its_damper_says() {
    // drawn so taut that values without refinement are 1e-7 off
    let still = taut(110, 0.9999, 0.0);
    let frequencies = list(&study(&still, "undamped", Coordinates::Joint), "frequencies").to_vec();
    let undamped: Vec<Complex<f64>> = frequencies.iter().map(|omega| Complex::new(0.0, *omega)).collect();
    let outcome = study(&still, "many", Coordinates::Joint);
    same("no damping", &of_study(&outcome), &undamped, 1e-9);
    assert!(of_study(&outcome).iter().all(|mu| mu.re == 0.0), "{:?}", of_study(&outcome));
    assert_eq!(codes(&outcome), ["lowest-modes"]);
    let damped = taut(110, 0.999, 1e3);
    let [many, full] = ["many", "full"].map(|name| of_study(&study(&damped, name, Coordinates::Joint)));
    same("damped", &many, &full[..4], 1e-7);
    many.iter().zip(&full).for_each(|(x, y)| assert!((x.re / y.re - 1.0).abs() < 1e-4, "{x} and {y}"));
}

/// A hanging truss of `n` bays that a pin holds, of bars of 1 kg and 1 g in turn, with a damper at its lower end.
fn truss_pendulum(n: usize) -> String {
    let (mut bodies, mut joints, mut pins, mut number) =
        (String::new(), String::new(), BTreeMap::from([((0, 0), "ground.O".to_owned())]), 0);
    let bays = (0..n).flat_map(|x| [[(x, 0), (x + 1, 0)], [(x, 1), (x + 1, 1)], [(x, 1), (x + 1, 0)], [(x + 1, 1), (x + 1, 0)]]);
    for (k, ends) in std::iter::once([(0, 0), (0, 1)]).chain(bays).enumerate() {
        let place = |(x, y): (usize, usize)| format!("[{}, -{x}]", 0.5 * y as f64);
        bodies += &format!("  m{k}: {{ bar: {{ from: {}, to: {}, mass: {} }} }}\n", place(ends[0]), place(ends[1]), ["1 g", "1 kg"][k % 2]);
        for (corner, end) in ends.into_iter().zip(["start", "end"]) {
            let point = format!("m{k}.{end}");
            match pins.get(&corner) {
                Some(first) => {
                    joints += &format!("  J{number}: {{ revolute: [{first}, {point}] }}\n");
                    number += 1;
                }
                None => drop(pins.insert(corner, point)),
            }
        }
    }
    format!(
        "grashof: 1\nname: truss pendulum\nspace: planar\ngravity: [0, -9.81]\nground: {{ O: [0, 0], P: [1, -{n}] }}\nbodies:\n{bodies}joints:\n{joints}springs: {{ d: {{ between: [ground.P, {}], damping: 1 N s/m }} }}\nstudies:
  many: {{ modes: {{ at: statics, damped: true, lowest: 4 }} }}
  full: {{ modes: {{ at: statics, damped: true, methods: [library] }} }}\n",
        pins[&(n, 0)]
    )
}

/// More is wanted than there is, and rows of light and heavy bars leave round-off beside it.
#[test]
fn a_truss_that_is_a_pendulum_has_one_pair() {
    let text = truss_pendulum(27);
    let [many, full] = ["many", "full"].map(|name| of_study(&study(&text, name, Coordinates::Joint)));
    same("pendulum", &many, &full, 1e-8);
    assert_eq!(many.len(), 1);
    assert!((many[0].re / full[0].re - 1.0).abs() < 1e-6, "{many:?} and {full:?}");
}

/// A free row that a small damper to the ground slows down: as a whole by c over all masses.
#[test]
fn a_free_row_with_a_small_damper_comes_to_rest_slowly() {
    let n = 110;
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    let text = format!(
        "grashof: 1\nname: free row\nspace: planar\ngravity: none\nbodies:\n{}joints:\n{}springs:\n{}studies: {{ v: {{ modes: {{ damped: true, lowest: 3 }} }} }}\n",
        each(&|i| format!("  b{i}: {{ mass: 1 kg }}\n")),
        each(&|i| format!(
            "  j{i}: {{ slider: [ground, b{i}.origin], axis: [1, 0]{} }}\n",
            if i == 0 { ", damping: 0.001 N s/m" } else { "" }
        )),
        each(&|i| if i == 0 { String::new() } else { format!("  s{i}: {{ stretch: b{i}.x - b{}.x, stiffness: 1e6 N/m }}\n", i - 1) }),
    );
    let outcome = study(&text, "v", Coordinates::Joint);
    let found = of_study(&outcome);
    assert_eq!(found[0], Complex::default(), "{found:?}");
    assert!((found[1].re * n as f64 / -1e-3 - 1.0).abs() < 1e-6 && found[1].im == 0.0, "{found:?}");
    assert!(!codes(&outcome).contains(&"unstable"), "{:?}", outcome.findings);
}
