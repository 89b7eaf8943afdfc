//! Singular positions are passed with and without redundant rows, in all coordinates and schemes; minimal coordinates that are driven, or
//! friction_of, move as joint coordinates do; a damping that is stiff beyond measure is integrated.

use crate::common::{columns, model};
use grashof::mechanism::Coordinates;
use grashof::results::March;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run_in;
use std::fmt::Write;

mod beside;
mod branch;
mod driven;
mod near;
mod passing;
mod rest;
mod told;

/// Integrators with what they need beside a tolerance, the tolerance, and how many tolerances they may be off where a motion does not
/// magnify errors.
const SCHEMES: [(&str, f64, f64); 8] = [
    ("dop853", 1e-8, 50.0),
    ("auto", 1e-8, 50.0),
    ("radau5", 1e-8, 50.0),
    ("bdf", 1e-8, 1000.0),
    ("generalized-alpha, rho: 0.8", 1e-6, 500.0),
    ("hht", 1e-6, 500.0),
    ("newmark", 1e-6, 500.0),
    ("rk4", 1e-6, 1000.0),
];

/// A study, whether it stops on its way or not.
fn run_to_its_end_or_not(text: &str, name: &str) -> Outcome {
    let model = model(text, Some(name));
    let study = model.study.clone().expect("the study");
    run_in(Case::new(&model, &study, &parameters(&model)), Coordinates::Joint, &|| false)
        .unwrap_or_else(|f| panic!("{name}: {}", f.reason()))
}

const CHARTS: [&str; 3] = ["joint", "cartesian", "minimal"];

/// A linkage of bars in a plane, or the same in space with a hinge of five rows in each joint.
struct Linkage {
    /// Name, length and mass of each bar, m and kg.
    bars: Vec<(&'static str, f64, f64)>,
    /// Points of the ground, m.
    ground: Vec<(&'static str, f64)>,
    /// Hinges: name and both points.
    hinges: Vec<(&'static str, &'static str, &'static str)>,
    /// Other entries of the model, which differ between plane and space.
    more: [&'static str; 2],
    start: &'static str,
    gravity: f64,
    torque: f64,
}

impl Linkage {
    /// The model without studies.
    fn text(&self, space: &str) -> String {
        let spatial = space == "spatial";
        let point = |x: f64, y: f64| if spatial { format!("[{x} m, 0, {y} m]") } else { format!("[{x} m, {y} m]") };
        let gravity = if spatial { format!("[0, 0, {} m/s^2]", -self.gravity) } else { format!("[0, {} m/s^2]", -self.gravity) };
        let mut text = format!("grashof: 1\nname: linkage\nspace: {space}\ngravity: {gravity}\nbodies:\n");
        for (name, length, mass) in &self.bars {
            let depth = if spatial { ", width: 10 cm, height: 10 cm" } else { "" };
            // as thick in the plane as in space
            let thick = if spatial { String::new() } else { format!(", inertia: {} kg m^2", mass * (length * length + 0.01) / 12.0) };
            let shape = if spatial {
                format!("bar: {{ length: {length} m{depth}, mass: {mass} kg }}")
            } else {
                let half = 0.5 * length;
                format!("mass: {mass} kg, com: [{half} m, 0], points: {{ start: [0, 0], end: [{length} m, 0] }}{thick}")
            };
            let _ = writeln!(text, "  {name}: {{ {shape} }}");
        }
        text += self.more[usize::from(spatial)];
        let ground: Vec<String> = self.ground.iter().map(|(name, x)| format!("{name}: {}", point(*x, 0.0))).collect();
        let _ = writeln!(text, "ground: {{ {} }}\njoints:", ground.join(", "));
        for (name, a, b) in &self.hinges {
            let axis = if spatial { ", axis: [0, -1, 0]" } else { "" };
            let _ = writeln!(text, "  {name}: {{ revolute: [{a}, {b}]{axis} }}");
        }
        if self.hinges.iter().any(|(_, _, b)| *b == "piston.origin") {
            let axis = if spatial { "[1, 0, 0]" } else { "[1, 0]" };
            let _ = writeln!(text, "  S: {{ slider: [ground.O, piston.origin], axis: {axis} }}");
        }
        let _ = writeln!(text, "loads: {{ turn: {{ joint: O, torque: {} N m }} }}\nstart: {{ {} }}", self.torque, self.start);
        text
    }
}

/// A parallelogram of links of 1 m and a coupler, which turns fully: at rest in its rectangle.
fn parallelogram(coupler: f64) -> Linkage {
    Linkage {
        bars: vec![("a", 1.0, 80.0), ("b", coupler, 80.0), ("c", 1.0, 80.0)],
        ground: vec![("O", 0.0), ("C", coupler)],
        hinges: vec![("O", "ground.O", "a.start"), ("A", "a.end", "b.start"), ("B", "b.end", "c.start"), ("C", "c.end", "ground.C")],
        more: [""; 2],
        start: "O.angle: 90 deg, O.omega: 0, A.angle: ~-90 deg, B.angle: ~-90 deg",
        gravity: 0.0,
        torque: 1000.0,
    }
}

/// Two parallelograms in a row.
fn row() -> Linkage {
    Linkage {
        bars: vec![("a", 1.0, 8.0), ("b", 1.5, 8.0), ("c", 1.0, 8.0), ("d", 1.5, 8.0), ("e", 1.0, 8.0)],
        ground: vec![("O", 0.0), ("C", 1.5), ("E", 3.0)],
        hinges: vec![
            ("O", "ground.O", "a.start"),
            ("A", "a.end", "b.start"),
            ("B", "b.end", "c.start"),
            ("C", "c.end", "ground.C"),
            ("D", "b.end", "d.start"),
            ("F", "d.end", "e.start"),
            ("E", "e.end", "ground.E"),
        ],
        more: [""; 2],
        start: "O.angle: 90 deg, O.omega: 3 rad/s, A.angle: ~-90 deg, B.angle: ~-90 deg",
        gravity: 9.81,
        torque: 0.0,
    }
}

/// Crank and rod of the same length: the slider may stand still in the pivot of the crank.
fn equal_arms() -> Linkage {
    Linkage {
        bars: vec![("a", 1.0, 5.0), ("b", 1.0, 8.0)],
        ground: vec![("O", 0.0)],
        hinges: vec![("O", "ground.O", "a.start"), ("A", "a.end", "b.start"), ("B", "b.end", "piston.origin")],
        more: ["  piston: { mass: 3 kg }\n", "  piston: { mass: 3 kg, inertia: 0.1 kg m^2 }\n"],
        start: "O.angle: 45 deg, O.omega: 1 rad/s, A.angle: ~-90 deg",
        gravity: 0.0,
        torque: 20.0,
    }
}

/// The text with a study `run`.
fn with_study(text: &str, dynamics: &str, columns: &str) -> String {
    format!("{text}studies:\n  run: {{ dynamics: {{ {dynamics} }}, columns: [time, {columns}] }}\n")
}

/// The study `run` of a text, to its end.
#[track_caller]
fn ran(text: &str) -> Outcome {
    let model = model(text, Some("run"));
    let study = model.study.clone().expect("the study");
    let coordinates = if text.contains("cartesian") { Coordinates::Cartesian } else { Coordinates::Joint };
    let outcome = run_in(Case::new(&model, &study, &parameters(&model)), coordinates, &|| false);
    let outcome = outcome.unwrap_or_else(|f| panic!("{}\n{text}", f.reason()));
    assert_eq!(outcome.stopped, None, "{text}");
    outcome
}

/// Columns but the time at the end, and the certificate.
#[track_caller]
fn end(text: &str) -> (Vec<f64>, March) {
    let outcome = ran(text);
    let last = outcome.rows.last().expect("a row");
    let names = columns(text, "run");
    assert_eq!(names[0], "time");
    (last[1..names.len()].to_vec(), outcome.certificate.march.expect("a motion"))
}

#[test]
fn parallel_links_turn_evenly_through_their_flat_positions() {
    for coupler in [1.0, 2.0] {
        let linkage = parallelogram(coupler);
        // the links turn alike and the coupler only shifts: φ̈ = T/(2 (m (l² + w²)/12 + m l²/4) + m l²)
        let rate = 1000.0 / (2.0 * 80.0 * (1.01 / 12.0 + 0.25) + 80.0);
        let right = [std::f64::consts::FRAC_PI_2 + 0.5 * rate * 4.0, rate * 2.0];
        for (scheme, tolerance, off) in SCHEMES {
            for chart in CHARTS {
                for space in ["planar", "spatial"] {
                    let dynamics = format!("until: 2 s, every: 1 s, tolerance: {tolerance:e}, integrator: {scheme}, coordinates: {chart}");
                    let text = with_study(&linkage.text(space), &dynamics, "O.angle, O.omega, C.angle");
                    let (found, march) = end(&text);
                    let error = right.iter().zip(&found).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs() / x));
                    let energy = march.energy_drift / march.energy_scale;
                    let what = format!("{scheme} {chart} {space} {coupler}: {error:e} {energy:e} {:?}", march.counts);
                    println!("{what}");
                    assert!(error < off * tolerance && energy < off * tolerance && march.counts.steps < 10_000, "{what}");
                }
            }
        }
    }
}

#[test]
fn linkages_with_redundant_rows_move_as_their_planar_twins() {
    for (linkage, columns) in [(row(), "O.angle, O.omega, C.angle"), (equal_arms(), "O.angle, O.omega, S.position")] {
        let dynamics = |scheme: &str, tolerance: f64, chart: &str| {
            format!("until: 2 s, every: 1 s, tolerance: {tolerance:e}, integrator: {scheme}, coordinates: {chart}")
        };
        let (right, _) = end(&with_study(&linkage.text("planar"), &dynamics("dop853", 1e-11, "joint"), columns));
        for (scheme, tolerance, off) in SCHEMES {
            for chart in CHARTS {
                for space in ["planar", "spatial"] {
                    let text = with_study(&linkage.text(space), &dynamics(scheme, tolerance, chart), columns);
                    let (found, march) = end(&text);
                    let error = right.iter().zip(&found).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs() / (1.0 + x.abs())));
                    let energy = march.energy_drift / march.energy_scale;
                    let what = format!("{scheme} {chart} {space}: {error:e} {energy:e} {:?}", march.counts);
                    println!("{what}");
                    assert!(error < 5.0 * off * tolerance && energy < off * tolerance, "{what}");
                }
            }
        }
    }
}

#[test]
fn implicit_schemes_bridge_where_rows_are_redundant() {
    for chart in ["joint", "cartesian", "minimal"] {
        let dynamics = format!("until: 1 s, every: 0.5 s, integrator: radau5, coordinates: {chart}");
        let (_, march) = end(&with_study(&row().text("spatial"), &dynamics, "O.angle"));
        assert!(march.counts.bridges > 0, "{chart}: {:?}", march.counts);
    }
    // the combination of rows that becomes weak has no second differences, as a vector that begins evenly has none
    for scheme in ["radau5", "hht"] {
        let dynamics = format!("until: 0.7 s, every: 0.1 s, tolerance: 1e-8, integrator: {scheme}, coordinates: cartesian");
        let (_, march) = end(&with_study(&parallelogram(1.0).text("spatial"), &dynamics, "O.angle"));
        assert!(march.counts.bridges > 0, "{scheme}: {:?}", march.counts);
    }
}

/// A damping of 1e12 N m s/rad at the first of two hinges stops it at once; the other one swings freely.
#[test]
fn a_damping_of_any_size_is_integrated() {
    let text = |damping: &str, scheme: &str, chart: &str| {
        let text = format!(
            "grashof: 1\nname: damped\nspace: planar\ngravity: [0, -9.81 m/s^2]\nbodies:\n  upper: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n\
             \x20 lower: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\njoints:\n  P: {{ revolute: [ground, upper.start]{damping} }}\n\
             \x20 Q: {{ revolute: [upper.end, lower.start] }}\n\
             start: {{ P.angle: 0.2 rad, P.omega: 0 rad/s, Q.angle: 0.3 rad, Q.omega: 1 rad/s }}\n"
        );
        let dynamics = format!("until: 5 s, every: 1 s, integrator: {scheme}, coordinates: {chart}");
        with_study(&text, &dynamics, "P.angle, Q.angle, Q.omega")
    };
    for chart in CHARTS {
        // held instead of damped
        let held = text("", "dop853", chart).replace("start:", "drivers: { hold: { joint: P, angle: 0.2 rad } }\nstart:");
        let (right, _) = end(&held.replace("P.angle: 0.2 rad, P.omega: 0 rad/s, ", ""));
        for damping in ["1e9", "1e12", "1e15"] {
            let (found, march) = end(&text(&format!(", damping: {damping} N m s/rad"), "auto", chart));
            let error = right.iter().zip(&found).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()));
            println!("{chart} {damping}: {error:e} {} {:?}", march.schemes, march.counts);
            assert!(
                error < 1e-5 && march.counts.steps < 1500 && march.schemes.contains("radau5"),
                "{chart} {damping}: {error:e} {march:?}"
            );
        }
    }
}
