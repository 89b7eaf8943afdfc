//! The lowest modes by sparse matrices: those of full ones, in all coordinates, and those of closed forms.

use super::chains::{chain, row};
use super::{TWO_BALLS, codes, four_bar, held, list};
use crate::common::{assembled, close, model, study};
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::held::{Pose, settled};
use grashof::kinematics::lowest::lowest;
use grashof::kinematics::pencil::HeldSparse;
use grashof::mechanism::Coordinates;
use grashof::studies::modes::eigen::library;
use std::f64::consts::PI;

/// A mechanism in its assembled start, held there, with sparse matrices.
pub(super) fn sparse<S>(text: &str, coordinates: Coordinates) -> HeldSparse
where
    S: Space<S = f64>,
{
    let (m, start) = assembled::<S>(text, coordinates);
    let modes = settled(&m, [&start.q, &vec![0.0; m.nv], &m.state_starts], &start.modes);
    let pose = Pose { q: &start.q, z: &m.state_starts, modes: &modes };
    HeldSparse::new(&model(text, None), &m, pose, &start.metric).expect("numbers")
}

/// All eigenvalues, holding forces and names by full and by sparse matrices, off balance.
fn agree<S>(text: &str, all: &[Coordinates], tolerance: f64)
where
    S: Space<S = f64>,
{
    let (.., full) = held::<S>(text, Coordinates::Joint);
    let right = library(&full.stiffness, &full.mass).expect("masses").values;
    for &coordinates in all {
        let held = sparse::<S>(text, coordinates);
        assert_eq!(held.pencil.circulation(), 0.0, "{coordinates:?}");
        assert_eq!(held.pencil.freedom, right.len(), "{coordinates:?}");
        let found = lowest(&held.pencil, right.len(), &|| false).expect("convergence");
        close(&format!("λ, {coordinates:?}"), &found.values, &right, tolerance);
        close(&format!("h, {coordinates:?}"), &held.unbalanced, full.unbalanced.as_slice(), tolerance);
    }
}

#[test]
fn a_pose_off_balance_has_the_eigenvalues_of_joint_coordinates_in_all() {
    use Coordinates::{Bounded, Cartesian, Joint};
    let all = [Joint, Bounded(1), Bounded(2), Cartesian];
    agree::<Planar<f64>>(&four_bar(false, 4.0), &all, 1e-9);
    agree::<Spatial<f64>>(&four_bar(true, 4.0), &all, 1e-8);
    // stretched out to a side: all joints are held
    let bent = chain(7, 0.4, false).replace("j3.angle: 0", "j3.angle: 70 deg").replace("j1.angle: -90 deg", "j1.angle: 20 deg");
    agree::<Planar<f64>>(&bent, &all, 1e-9);
    // turns of balls do not commute: the curvature of their coordinates counts
    agree::<Spatial<f64>>(TWO_BALLS, &[Joint], 1e-9);
}

#[test]
fn a_long_row_has_the_lowest_sines() {
    let n = 300;
    let text = row(n).replace("modes: { methods: [library, jacobi, power] }", "modes: { lowest: 7 }");
    let outcome = study(&text, "v", Coordinates::Joint);
    let right: Vec<f64> = (1..=7).map(|j| 4.0 * 25.0 * (j as f64 * PI / (2.0 * (n as f64 + 1.0))).sin().powi(2)).collect();
    close("λ", list(&outcome, "eigenvalues"), &right, 1e-9);
    for (j, shape) in outcome.shapes.iter().enumerate() {
        let sines: Vec<f64> = (1..=n).map(|i| (i as f64 * (j + 1) as f64 * PI / (n as f64 + 1.0)).sin()).collect();
        let size = (sines.iter().map(|x| 2.0 * x * x).sum::<f64>()).sqrt();
        let sign = shape.iter().zip(&sines).map(|(a, b)| a.1 * b).sum::<f64>().signum();
        let found: Vec<f64> = shape.iter().map(|(_, x)| sign * x).collect();
        close("shape", &found, &sines.iter().map(|x| x / size).collect::<Vec<_>>(), 1e-8);
    }
    assert_eq!(codes(&outcome), ["lowest-modes"]);
}

#[test]
fn a_long_chain_hangs_as_a_rope_does() {
    // on a tree of short roads; ω² = (j₀,ₖ/2)² g/L of the rope
    let n = 400;
    let outcome =
        study(&format!("{}studies: {{ v: {{ modes: {{ lowest: 3 }} }} }}\n", chain(n, 1.0 / n as f64, false)), "v", Coordinates::Joint);
    let zeros = [2.404_825_557_7, 5.520_078_110_3, 8.653_727_912_9];
    let rope: Vec<f64> = zeros.iter().map(|z| z * z / 4.0 * super::G).collect();
    close("λ", list(&outcome, "eigenvalues"), &rope, 2e-4);
    assert_eq!(codes(&outcome), ["lowest-modes"]);
}

#[test]
fn each_of_many_equal_modes_is_found() {
    // pendulums of two kinds beside each other, some of them upside down
    let n = 60;
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    let text = format!(
        "grashof: 1\nname: pendulums\nspace: planar\ngravity: [0, -9.81]\nground: {{ O: [0, 0] }}\nbodies:\n{}joints:\n{}start:\n{}studies: {{ v: {{ modes: {{ lowest: 40, methods: [lanczos] }} }} }}\n",
        each(&|i| format!("  b{i}: {{ bar: {{ length: {}, mass: 2 }} }}\n", if i % 2 == 0 { 0.5 } else { 2.0 })),
        each(&|i| format!("  j{i}: {{ revolute: [ground.O, b{i}.start] }}\n")),
        each(&|i| format!("  j{i}.angle: {} deg\n", if i % 10 == 9 { 90 } else { -90 })),
    );
    let outcome = study(&text, "v", Coordinates::Joint);
    let [slow, fast] = [2.0, 0.5].map(|length| 1.5 * super::G / length);
    let right: Vec<f64> = [vec![-slow; 6], vec![slow; 24], vec![fast; 10]].concat();
    close("λ", list(&outcome, "eigenvalues"), &right, 1e-10);
    assert_eq!(codes(&outcome).iter().filter(|code| **code == "unstable").count(), 6);
}

#[test]
fn a_long_chain_that_is_held_level_has_free_motions() {
    // gravity does not change with small turns about the level: K is round-off
    let n = 150;
    let text = format!("{}studies: {{ v: {{ modes: {{ lowest: 5 }} }} }}\n", chain(n, 0.1, false).replace("-90 deg", "0"));
    let outcome = study(&text, "v", Coordinates::Joint);
    assert_eq!(list(&outcome, "frequencies"), [0.0; 5]);
    let found = codes(&outcome);
    assert_eq!((found[0], &found[1..6], found[6]), ("unbalanced", &["free-motion"; 5][..], "lowest-modes"));
}
