//! The crank-rocker from rest under its motor: `data/motion.json`, and the reduced equation for other parameters.

use super::{doubled, scalar};
use crate::closed_form::crank_rocker::{CrankRocker, Load, Parameters};
use crate::reference::motor;
use crate::reference::program::{Run, Table, model, run, run_text};
use crate::reference::{Verdict, number, series};
use serde_json::Value;
use std::path::Path;

const COLUMNS: [&str; 4] = ["theta", "omega", "motor.angle", "motor.omega"];

fn read() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/motion.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// What the file expects holds for its own parameters alone: exit code 1 is as good as 0.
fn crank_rocker(arguments: &[&str]) -> Run {
    let run = run(&model("crank_rocker.yaml"), &[&["--no-plots"], arguments].concat());
    assert!(run.code <= 1, "exit code {}\n{}", run.code, run.stderr);
    run
}

/// Every `stride`-th row of the even grid of `step` up to 2 s.
fn grid(table: &Table, step: f64, stride: usize) -> Vec<usize> {
    table.on_grid(0.0, step, (2.0 / step).round() as usize).into_iter().step_by(stride).collect()
}

/// Compares a column with a series of the file, which may go on for longer.
fn same(verdict: &mut Verdict, study: &str, table: &Table, rows: &[usize], name: &'static str, file: &Value, path: &str) {
    let right = series(file, name, &format!("{path}/{name}"));
    let column = table.column(name);
    assert!(right.values.len() >= rows.len(), "{path}");
    for (k, (row, right_value)) in rows.iter().zip(&right.values).enumerate() {
        verdict.close(&format!("{study}: {name}"), format_args!("row {k}"), column[*row], *right_value, right.tolerance);
    }
}

#[test]
fn from_rest_to_the_last_kink() {
    let file = read();
    let run = crank_rocker(&["--study", "start-up-exact", "--study", "rigid-joint"]);
    let mut verdict = Verdict::default();
    let table = run.table("start-up-exact");
    let rows = grid(&table, 0.01, 1);
    for name in ["theta", "omega", "alpha"] {
        same(&mut verdict, "start-up-exact", &table, &rows, name, &file, "start_up/geared");
    }
    let table = run.table("rigid-joint");
    let rows = grid(&table, 0.01, 1);
    for name in ["theta", "omega"] {
        same(&mut verdict, "rigid-joint", &table, &rows, name, &file, "start_up/geared_flywheel_27.84");
    }
    let within = number(&file, "startup_time/tolerance");
    for (study, flywheel) in [("start-up-exact", "0"), ("rigid-joint", "27.84")] {
        let right = number(&file, &format!("startup_time/rows_s/75% of starting (recommended), If={flywheel}"));
        verdict.close("startup_time", study, scalar(&run, study, "startup_time"), right, within);
    }
    verdict.give("start-up");
}

#[test]
fn central_differences_give_the_values_of_the_scheme() {
    let file = read();
    let mut verdict = Verdict::default();
    for (case, arguments) in [("geared", &[][..]), ("scaled", &["--variant", "scaled", "--set", "J_rotor=0"])] {
        let run = crank_rocker(&[&["--study", "start-up"], arguments].concat());
        let table = run.table("start-up");
        let rows = grid(&table, 0.001, 10);
        for name in ["theta", "omega"] {
            same(&mut verdict, case, &table, &rows, name, &file, &format!("central_difference/{case}"));
        }
    }
    verdict.give("central differences");
}

#[test]
fn through_an_elastic_shaft() {
    let file = read();
    let mut verdict = Verdict::default();
    let cases: [(&str, &[&str]); 4] = [
        ("geared_k0", &[]),
        ("geared_10k0", &["--set", "k_t=60121.003915"]),
        ("scaled_k0", &["--variant", "scaled", "--set", "J_rotor=0.37"]),
        ("scaled_43.96", &["--variant", "scaled", "--set", "J_rotor=0.37", "--set", "k_t=43.96"]),
    ];
    for (case, arguments) in cases {
        let run = crank_rocker(&[&["--study", "coupling", "--study", "coupling-exact"], arguments].concat());
        for (study, key, step, stride) in [("coupling-exact", "exact", 0.01, 1), ("coupling", "newmark_h1e-3", 0.001, 20)] {
            let table = run.table(study);
            let path = format!("elastic/runs/{case}/{key}");
            let right = file.pointer(&format!("/{path}/values")).and_then(Value::as_array).unwrap();
            let within = number(&file, &format!("{path}/tolerance"));
            let rows = grid(&table, step, stride);
            assert_eq!(rows.len(), right.len(), "{path}");
            for (k, (row, right)) in rows.iter().zip(right).enumerate() {
                for (i, name) in COLUMNS.iter().enumerate() {
                    let found = table.rows[*row][table.index(name)];
                    verdict.close(&format!("{path}: {name}"), format_args!("row {k}"), found, right[i].as_f64().unwrap(), within);
                }
            }
        }
    }
    let run = crank_rocker(&["--study", "coupling", "--study", "stiffness"]);
    let (found, right) = (scalar(&run, "coupling", "k0"), number(&file, "elastic/k0/rod070_IkGeared"));
    verdict.close("k0", "coupling", found, right, 1e-6);
    verdict.give("elastic shaft");
}

#[test]
fn coasting_keeps_its_energy() {
    let file = read();
    let text = std::fs::read_to_string(model("crank_rocker.yaml")).unwrap();
    let (head, tail) = text.split_once("\nvariants:\n").unwrap();
    let variant = "  coast: { drivers: { drive: null }, start: { O.omega: 20 rad/s } }";
    let study = "  coast:\n    variant: [unloaded, coast]\n    dynamics: { until: 1 s, every: 10 ms, tolerance: 1e-10 }\n    columns: [time, theta, omega, energy.total]";
    let run = run_text(&format!("{head}\nvariants:\n{variant}\n{}\n{study}\n", tail.trim_end()), &["--no-plots", "--study", "coast"]);
    let run = run.succeeded();
    let table = run.table("coast");
    let rows = table.on_grid(0.0, 0.01, 100);
    let mut verdict = Verdict::default();
    for name in ["theta", "omega"] {
        same(&mut verdict, "coast", &table, &rows, name, &file, "coast");
    }
    let energy = table.column("energy.total");
    for e in &energy {
        verdict.close("energy", "any time", *e, energy[0], 1e-9 * energy[0]);
    }
    verdict.give("coasting");
}

/// (I(θ) + J) θ″ + ½ I′ θ′² + γ θ′ = M(θ′) + Q(θ), with rotor and crank as one or with a shaft between them.
struct Reduced {
    /// At a crank speed of 1 rad/s, so that driving torques are −Q + ½ I′.
    rocker: CrankRocker,
    gear: f64,
    rotor: f64,
    flywheel: f64,
    viscous: f64,
    shaft: Option<f64>,
}

impl Reduced {
    fn new(p: Parameters) -> Self {
        let gear = 73.0 / 12.0;
        let rocker = CrankRocker::new(Parameters { speed: 1.0, ..p });
        Self { rocker, gear, rotor: gear * gear * 0.37, flywheel: 0.0, viscous: 4.26, shaft: None }
    }

    /// Rates of θ, θ′ and of angle and speed of the rotor.
    fn rates(&self, [theta, omega, phi, psi]: [f64; 4]) -> [f64; 4] {
        let motion = self.rocker.motion(theta);
        // on the rocker's way back, whichever way the crank turns; at rest it is about to turn forward
        let back = motion.phi3 <= self.rocker.p.load_angle && motion.omega3 * omega.signum() <= 0.0;
        let load = if back { Load::On } else { Load::Off };
        let [inertia, slope] = self.rocker.inertia(&motion);
        let q = 0.5 * slope - self.rocker.forces(&motion, load).torque;
        let own = q - self.viscous * omega - 0.5 * slope * omega * omega;
        let drive = |speed: f64| self.gear * motor::torque(self.gear * speed);
        match self.shaft {
            None => {
                let alpha = (own + drive(omega)) / (inertia + self.flywheel + self.rotor);
                [omega, alpha, omega, alpha]
            }
            Some(stiffness) => {
                let twist = stiffness * (phi - theta);
                [omega, (own + twist) / (inertia + self.flywheel), psi, (drive(psi) - twist) / self.rotor]
            }
        }
    }

    /// One classical Runge-Kutta step.
    fn step(&self, y: [f64; 4], h: f64) -> [f64; 4] {
        let along = |k: &[f64; 4], c: f64| std::array::from_fn(|i| y[i] + c * h * k[i]);
        let k1 = self.rates(y);
        let k2 = self.rates(along(&k1, 0.5));
        let k3 = self.rates(along(&k2, 0.5));
        let k4 = self.rates(along(&k3, 1.0));
        std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// States every 10 ms up to 1 s, and when θ′ first reaches 24 rad/s. Steps of 5 µs keep what each kink costs, at most
    /// h²/8 times the jump of θ‴, near 1e-8 rad/s.
    fn run(&self) -> (Vec<[f64; 4]>, Option<f64>) {
        const STEPS: usize = 2000;
        let h = 0.01 / STEPS as f64;
        let mut y = [0.0; 4];
        let (mut states, mut reached) = (vec![y], None);
        for row in 0..100 {
            for k in 0..STEPS {
                let next = self.step(y, h);
                if reached.is_none() && next[1] >= 24.0 {
                    reached = Some((row * STEPS + k) as f64 * h + h * (24.0 - y[1]) / (next[1] - y[1]));
                }
                y = next;
            }
            states.push(y);
        }
        (states, reached)
    }
}

/// Compares the first second of a study with the reduced equation.
fn reduces(study: &str, set: &[&str], reduced: &Reduced) {
    let arguments: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
    let run = crank_rocker(&[&["--study", study], &arguments[..]].concat());
    let table = run.table(study);
    let rows = grid(&table, 0.01, 1);
    let (right, reached) = reduced.run();
    let mut verdict = Verdict::default();
    let names = if reduced.shaft.is_some() { &COLUMNS[..] } else { &COLUMNS[..2] };
    for (k, (row, right)) in rows.iter().zip(&right).enumerate() {
        for (name, right) in names.iter().zip(right) {
            verdict.close(name, format_args!("row {k}"), table.rows[*row][table.index(name)], *right, 1e-6);
        }
    }
    if let (Some(right), None) = (reached, reduced.shaft) {
        verdict.close("startup_time", "", scalar(&run, study, "startup_time"), right, 1e-8);
        verdict.holds(doubled(&table).iter().any(|t| (t - right).abs() < 1e-8), "the instant stands in two rows");
    }
    verdict.give(&format!("{study} {set:?}"));
}

#[test]
fn other_parameters_by_the_reduced_equation() {
    let usual = || Reduced::new(Parameters::default());
    reduces("start-up-exact", &[], &usual());
    reduces("start-up-exact", &["I_f=5", "viscous=12"], &Reduced { flywheel: 5.0, viscous: 12.0, ..usual() });
    reduces("start-up-exact", &["J_rotor=3"], &Reduced { rotor: 3.0, ..usual() });
    reduces("start-up-exact", &["gear=9"], &Reduced { gear: 9.0, rotor: 81.0 * 0.37, ..usual() });
    let p = Parameters { l1: 0.12, l3: 0.62, m_tip: 40.0, load_max: 1500.0, load_angle: -0.1, ..Parameters::default() };
    reduces("start-up-exact", &["l1=12 cm", "l3=62 cm", "m_tip=40", "load_max=1500", "load_angle=-0.1 rad"], &Reduced::new(p));
    reduces(
        "rigid-joint",
        &["I_f=80", "g_earth=1.62"],
        &Reduced { flywheel: 80.0, ..Reduced::new(Parameters { g_earth: 1.62, ..Parameters::default() }) },
    );
}

#[test]
fn other_shafts_by_the_reduced_equation() {
    let usual = || Reduced::new(Parameters::default());
    reduces("coupling-exact", &["k_t=1500", "I_f=10"], &Reduced { shaft: Some(1500.0), flywheel: 10.0, ..usual() });
    let stiff = Reduced { shaft: Some(90_000.0), flywheel: 27.84, rotor: 6.0, ..usual() };
    reduces("coupling-exact", &["k_t=90000", "J_rotor=6"], &stiff);
}
