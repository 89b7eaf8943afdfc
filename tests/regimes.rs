//! The crank-rocker's steady turn under its motor, flywheels, other speeds and vibrations: `data/regimes.json`, and for other
//! parameters equations written independently.

use crate::closed_form::crank_rocker::{CrankRocker, Load, Parameters};
use crate::reference::motor;
use crate::reference::program::{Run, model, run, run_text};
use crate::reference::{Verdict, number, series};
use nalgebra::{Matrix3, SymmetricEigen};
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;

fn read() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/regimes.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn crank_rocker(studies: &[&str], arguments: &[&str]) -> Run {
    let named: Vec<&str> = studies.iter().flat_map(|s| ["--study", s]).collect();
    run(&model("crank_rocker.yaml"), &[&["--no-plots"], &named[..], arguments].concat()).succeeded()
}

fn scalar(run: &Run, study: &str, name: &str) -> f64 {
    run.json(study)["scalars"][name].as_f64().unwrap_or(f64::NAN)
}

fn list(run: &Run, study: &str, name: &str) -> Vec<f64> {
    let values = run.json(study)["scalars"][name].as_array().cloned().unwrap_or_default();
    values.iter().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect()
}

#[test]
fn steady_turns_with_flywheels() {
    let file = read();
    let run = crank_rocker(&["fluctuation"], &[]);
    let table = run.table("fluctuation");
    let rows = file.pointer("/steady/geared/sweep/values").and_then(Value::as_array).unwrap();
    let mut verdict = Verdict::default();
    for right in rows {
        let flywheel = right["If"].as_f64().unwrap();
        let Some(row) = table.rows.iter().find(|r| r[table.index("I_f")] == flywheel) else {
            verdict.holds(false, format!("no row for a flywheel of {flywheel}"));
            continue;
        };
        for (name, of) in
            [("omega_mean", "mean_time"), ("omega_max", "omega_max"), ("omega_min", "omega_min"), ("delta", "delta"), ("period", "period")]
        {
            let right = right[of].as_f64().unwrap();
            verdict.close(name, flywheel, row[table.index(name)], right, 2e-9 * right.max(1.0));
        }
        let floquet = row[table.index("floquet")];
        verdict.holds(floquet > 0.0 && floquet < 1.0, format!("the multiplier {floquet} of a stable turn"));
    }
    verdict.holds(table.rows.len() == rows.len(), "a row for each flywheel");
    verdict.give("steady turns");
}

#[test]
fn speed_over_the_steady_turn() {
    let file = read();
    let run = crank_rocker(&["fluctuation"], &[]);
    let mut verdict = Verdict::default();
    for (curve, key) in [("fluctuation-001", "omega_of_theta_If0"), ("fluctuation-006", "omega_of_theta_If27.84")] {
        let table = run.table(curve);
        let right = series(&file, "omega", &format!("steady/geared/{key}"));
        let rows = table.on_grid(0.0, TAU / 360.0, 360);
        assert_eq!(rows.len(), right.values.len());
        for (k, (row, right)) in rows.iter().zip(&right.values).enumerate() {
            verdict.close(key, format_args!("{k} degrees"), table.rows[*row][table.index("omega")], *right, 1e-8);
        }
    }
    verdict.give("speed over the turn");
}

#[test]
fn the_flywheel_for_one_percent() {
    let file = read();
    let run = crank_rocker(&["flywheel-size"], &[]);
    let mut verdict = Verdict::default();
    let right = number(&file, "steady/geared/If_for_delta_0.01/values");
    verdict.close("flywheel", "scalars", scalar(&run, "flywheel-size", "flywheel"), right, 1e-6 * right);
    verdict.close("delta", "scalars", scalar(&run, "flywheel-size", "delta"), 0.01, 1e-11);
    let found = run.json("flywheel-size")["parameters"]["I_f"].as_f64().unwrap_or(f64::NAN);
    verdict.close("I_f", "parameters", found, right, 1e-6 * right);
    verdict.give("flywheel for one percent");
}

#[test]
fn other_speeds_by_the_gear() {
    let file = read();
    let run = crank_rocker(&["speeds", "speeds-regime"], &[]);
    let table = run.table("speeds");
    let mut verdict = Verdict::default();
    for (row, case, held) in [(0, "quarter_speed_60rpm", 1.0), (2, "fourfold_speed_960rpm", 0.0)] {
        let found = &table.rows[row];
        for (name, key) in [("load_torque", "mean_load_torque_Nm"), ("breakdown_torque", "breakdown_torque_on_crank_Nm")] {
            let right = number(&file, &format!("other_speeds/{case}/{key}"));
            verdict.close(name, case, found[table.index(name)], right, 1e-8 * right);
        }
        verdict.holds(found[table.index("held")] == held, format!("{case}: held"));
    }
    verdict.holds(table.rows[1][table.index("held")] == 1.0, "the rated speed is held");
    let table = run.table("speeds-regime");
    for (name, key) in [("omega_mean", "mean_time"), ("omega_max", "omega_max"), ("omega_min", "omega_min"), ("delta", "delta")] {
        let right = number(&file, &format!("other_speeds/quarter_speed_60rpm/steady_If0/{key}"));
        verdict.close(name, "a quarter", table.rows[0][table.index(name)], right, 1e-9 * right.max(1.0));
    }
    let slow = table.rows[2][table.index("omega_mean")];
    verdict.holds(slow > 10.0 && slow < 80.0, format!("a regime of {slow} rad/s, far below the nominal 100.5"));
    verdict.give("other speeds");
}

/// The steady turn by the energy E = ½ (I + J) ω² over the angle: dE/dθ = G M(Gω) − γ ω + Q(θ), Q of gravity and load.
struct Turn {
    /// θ, I + J and Q on both ends and in the middle of each step; Q has the value inside of the step.
    steps: Vec<[[f64; 2]; 3]>,
    h: Vec<f64>,
    gear: f64,
    viscous: f64,
}

impl Turn {
    fn new(p: Parameters, gear: f64, viscous: f64, inertia: f64) -> Self {
        const STEPS: usize = 40_000;
        let rocker = CrankRocker::new(Parameters { speed: 1.0, ..p });
        let mut ends = vec![0.0];
        ends.extend(rocker.switches(0.0).into_iter().filter(|s| *s > 0.0));
        ends.push(TAU);
        let (mut steps, mut h) = (Vec::new(), Vec::new());
        for pair in ends.windows(2) {
            let middle = rocker.motion(0.5 * (pair[0] + pair[1]));
            let on = middle.phi3 <= p.load_angle && middle.omega3 <= 0.0;
            let load = if on { Load::On } else { Load::Off };
            let at = |theta: f64| {
                let motion = rocker.motion(theta);
                let [of_links, slope] = rocker.inertia(&motion);
                [of_links + inertia, 0.5 * slope - rocker.forces(&motion, load).torque]
            };
            let count = ((pair[1] - pair[0]) / TAU * STEPS as f64).ceil();
            let width = (pair[1] - pair[0]) / count;
            for k in 0..count as usize {
                let from = pair[0] + k as f64 * width;
                steps.push([at(from), at(from + 0.5 * width), at(from + width)]);
                h.push(width);
            }
        }
        Self { steps, h, gear, viscous }
    }

    /// From E at θ = 0 over one turn: E at the end, the time, the largest and the smallest speed.
    fn over(&self, start: f64) -> [f64; 4] {
        let mut e = start;
        let (mut time, mut most, mut least) = (0.0, 0.0_f64, f64::INFINITY);
        let speed = |e: f64, at: [f64; 2]| (2.0 * e / at[0]).sqrt();
        let rate = |e: f64, at: [f64; 2]| {
            let omega = speed(e, at);
            self.gear * motor::torque(self.gear * omega) - self.viscous * omega + at[1]
        };
        for (at, h) in self.steps.iter().zip(&self.h) {
            let k1 = rate(e, at[0]);
            let k2 = rate(e + 0.5 * h * k1, at[1]);
            let k3 = rate(e + 0.5 * h * k2, at[1]);
            let k4 = rate(e + h * k3, at[2]);
            let next = e + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            let middle = e + h / 8.0 * (2.0 * k1 + k2 + k3);
            time += h / 6.0 * (1.0 / speed(e, at[0]) + 4.0 / speed(middle, at[1]) + 1.0 / speed(next, at[2]));
            let omega = speed(e, at[0]);
            (most, least) = (most.max(omega), least.min(omega));
            e = next;
        }
        [e, time, most, least]
    }

    /// Mean, largest and smallest speed of the regime, and the multiplier of the return map.
    fn regime(&self, guess: f64) -> [f64; 4] {
        let mut e = 0.5 * self.steps[0][0][0] * guess * guess;
        for _ in 0..30 {
            e = self.over(e)[0];
        }
        let mut slope = 0.0;
        for _ in 0..6 {
            let d = 1e-6 * e;
            let back = self.over(e)[0];
            slope = (self.over(e + d)[0] - self.over(e - d)[0]) / (2.0 * d);
            e += (back - e) / (1.0 - slope);
        }
        let [_, period, most, least] = self.over(e);
        [TAU / period, most, least, slope]
    }
}

#[test]
fn other_parameters_by_energy_over_the_angle() {
    let gear = 73.0 / 12.0;
    let usual = Parameters::default();
    let long = Parameters { l1: 0.12, l3: 0.62, m_tip: 40.0, load_max: 1500.0, load_angle: -0.1, ..usual };
    let cases: [(&[&str], Turn); 4] = [
        (&[], Turn::new(usual, gear, 4.26, gear * gear * 0.37)),
        (&["viscous=11", "load_max=5000"], Turn::new(Parameters { load_max: 5000.0, ..usual }, gear, 11.0, gear * gear * 0.37)),
        (&["gear=9", "I_f=12"], Turn::new(usual, 9.0, 4.26, 81.0 * 0.37 + 12.0)),
        (
            &["l1=12 cm", "l3=62 cm", "m_tip=40", "load_max=1500", "load_angle=-0.1 rad", "I_f=3"],
            Turn::new(long, gear, 4.26, gear * gear * 0.37 + 3.0),
        ),
    ];
    let mut verdict = Verdict::default();
    for (set, turn) in cases {
        let flywheel = set.iter().find_map(|s| s.strip_prefix("I_f=")).unwrap_or("0");
        // a study of one run at these parameters
        let text = std::fs::read_to_string(model("crank_rocker.yaml")).unwrap();
        let study = "  regime:\n    variant: motor\n    periodic: { over: theta, by: 1 turn, of: omega }\n";
        let arguments: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
        let run = run_text(&format!("{}\n{study}", text.trim_end()), &[&["--no-plots", "--study", "regime"], &arguments[..]].concat())
            .succeeded();
        let right = turn.regime(1500.0 * TAU / 60.0 / turn.gear);
        for (name, right) in ["omega_mean", "omega_max", "omega_min"].iter().zip(right) {
            // the oracle reads its extremes off its grid
            verdict.close(name, format_args!("{set:?}, {flywheel}"), scalar(&run, "regime", name), right, 2e-6);
        }
        let close = (scalar(&run, "regime", "omega_mean") - right[0]).abs() < 1e-7;
        verdict.holds(close, format!("{set:?}: mean {} {}", scalar(&run, "regime", "omega_mean"), right[0]));
        verdict.close("floquet", format_args!("{set:?}"), scalar(&run, "regime", "floquet"), right[3], 1e-5);
    }
    verdict.give("regimes of other parameters");
}

#[test]
fn vibrations_with_the_absorber() {
    let file = read();
    let run = crank_rocker(&["modes", "modes-no-gravity", "modes-k0"], &[]);
    let mut verdict = Verdict::default();
    let cases = [("modes", "correct_kt43.96"), ("modes-no-gravity", "correct_kt43.96_no_gravity"), ("modes-k0", "correct_kt_k0")];
    for (study, key) in cases {
        let right = file.pointer(&format!("/modes/{key}/lambda")).and_then(Value::as_array).unwrap();
        for name in ["eigenvalues", "eigenvalues_jacobi", "eigenvalues_power"] {
            let found = list(&run, study, name);
            assert_eq!(found.len(), right.len(), "{study}: {name}");
            for (found, right) in found.iter().zip(right) {
                let right = right.as_f64().unwrap();
                verdict.close(name, study, *found, right, 2e-9 * right.abs().max(1.0));
            }
        }
    }
    let (found, right) = (scalar(&run, "modes-k0", "k0"), number(&file, "k0/rod070_Ik0.37"));
    verdict.close("k0", "modes-k0", found, right, 1e-8);
    verdict.give("vibrations");
}

/// Eigenvalues of M = diag(I(0) + I_f, J, m), K of gravity's potential, the shaft k_t and the absorber k = k_t/3 at the radius R.
fn eigenvalues(p: Parameters, [flywheel, rotor, mass, shaft, radius]: [f64; 5]) -> [f64; 3] {
    let rocker = CrankRocker::new(Parameters { speed: 1.0, ..p });
    let gravity = |theta: f64| {
        let motion = rocker.motion(theta);
        0.5 * rocker.inertia(&motion)[1] - rocker.forces(&motion, Load::Off).torque
    };
    // −dQ/dθ by central differences, extrapolated
    let slope = |h: f64| (gravity(-h) - gravity(h)) / (2.0 * h);
    let stiffness = (4.0 * slope(1e-3) - slope(2e-3)) / 3.0;
    let k = shaft / 3.0;
    let stiff = Matrix3::new(stiffness + shaft + k * radius * radius, -shaft, -k * radius, -shaft, shaft, 0.0, -k * radius, 0.0, k);
    let masses = [rocker.inertia(&rocker.motion(0.0))[0] + flywheel, rotor, mass];
    let scaled = Matrix3::from_fn(|i, j| stiff[(i, j)] / (masses[i] * masses[j]).sqrt());
    let mut all: Vec<f64> = SymmetricEigen::new(scaled).eigenvalues.iter().copied().collect();
    all.sort_by(f64::total_cmp);
    [all[0], all[1], all[2]]
}

#[test]
fn vibrations_of_other_parameters() {
    let usual = Parameters::default();
    let cases: [(&[&str], Parameters, [f64; 5]); 3] = [
        (&["k_t=500", "m_x=3"], usual, [27.84, 0.37, 3.0, 500.0, 0.1]),
        (&["I_f=4", "J_rotor=2", "R=0.3"], usual, [4.0, 2.0, 10.0, 43.96, 0.3]),
        (&["l3=0.62", "m_tip=20", "k_t=80"], Parameters { l3: 0.62, m_tip: 20.0, ..usual }, [27.84, 0.37, 10.0, 80.0, 0.1]),
    ];
    let mut verdict = Verdict::default();
    for (set, p, rest) in cases {
        let arguments: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
        let run = crank_rocker(&["modes"], &arguments);
        for (found, right) in list(&run, "modes", "eigenvalues").iter().zip(eigenvalues(p, rest)) {
            verdict.close("eigenvalues", format_args!("{set:?}"), *found, right, 1e-6 * right.abs().max(1.0));
        }
    }
    verdict.give("vibrations of other parameters");
}

#[test]
fn the_operating_point_of_a_uniform_turn() {
    let run = crank_rocker(&["operating-point"], &[]);
    let speed = run.json("operating-point")["parameters"]["speed"].as_f64().unwrap_or(f64::NAN);
    let rocker = CrankRocker::new(Parameters { speed, ..Parameters::default() });
    let gear = 73.0 / 12.0;
    let mean = rocker.work_per_turn() / TAU + 4.26 * speed;
    let mut verdict = Verdict::default();
    verdict.close("torque", "mean and motor", gear * motor::torque(gear * speed), mean, 1e-6);
    verdict.close("surplus", "scalars", scalar(&run, "operating-point", "surplus"), 0.0, 1e-6);
    verdict.give("operating point");
}
