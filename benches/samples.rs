//! Times of one evaluation beside those of a crank-rocker written by hand, in one run: `cargo bench --bench samples`.
//!
//! Every kernel runs in short turns, one after the other, for many rounds, so that a machine that slows down for a while slows
//! all of them. The ratios are those of the best turns: they are the ones that nothing else disturbed. Without `--bench` (as in
//! `cargo test --benches`) each kernel is tried once, and results are compared.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

#[path = "closed_form/mod.rs"]
mod closed_form;

use closed_form::crank_rocker::{CrankRocker, Load, Parameters};
use grashof::dynamics::Dynamics;
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::assemble::{Assembled, assemble};
use grashof::kinematics::driven::Driven;
use grashof::mechanism::{Coordinates, Mechanism};
use grashof::model::{Document, Model, Selection};
use grashof::studies::common::case::parameters;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// Samples of one turn: every 0.1 degrees.
const SAMPLES: usize = 3600;
/// Evaluations between two looks at the clock.
const BATCH: usize = 200;

/// Something that is timed: `run` does it once and says how many evaluations that were.
struct Kernel<'a> {
    name: &'static str,
    run: Box<dyn FnMut() -> usize + 'a>,
    /// Seconds per evaluation, one of each round.
    times: Vec<f64>,
}

impl<'a> Kernel<'a> {
    fn new(name: &'static str, run: impl FnMut() -> usize + 'a) -> Self {
        Self { name, run: Box::new(run), times: Vec::new() }
    }

    /// Runs for about `turn` and keeps the time per evaluation.
    fn time(&mut self, turn: Duration) {
        let begin = Instant::now();
        let mut count = 0;
        while count == 0 || begin.elapsed() < turn {
            count += (self.run)();
        }
        self.times.push(begin.elapsed().as_secs_f64() / count as f64);
    }
}

/// Kernel, what it is measured by, and the largest ratio that is allowed.
const LIMITS: [(&str, &str, f64); 3] =
    [("sample, general", "sample, by hand", 6.0), ("terms, Andrews", "sample, by hand", 8.0), ("load and check", "serde_yaml alone", 5.0)];

fn main() {
    let timed = std::env::args().any(|a| a == "--bench");
    let text = read("models/crank_rocker.yaml");
    let spatial_text = read("models/four_bar_spatial.yaml");
    let andrews_text = read("benches/andrews.yaml");

    let model = model_of(&text);
    let (mechanism, start) = assembled::<Planar<f64>>(&model, Coordinates::Joint);
    let (cartesian, cartesian_start) = assembled::<Planar<f64>>(&model, Coordinates::Cartesian);
    let spatial_model = model_of(&spatial_text);
    let (spatial, spatial_start) = assembled::<Spatial<f64>>(&spatial_model, Coordinates::Joint);
    let andrews_model = model_of(&andrews_text);
    let (andrews, andrews_start) = assembled::<Planar<f64>>(&andrews_model, Coordinates::Joint);

    let hand = CrankRocker::new(Parameters::default());
    let mut turn = Turn::new(&mechanism, &start);
    let mut cartesian_turn = Turn::new(&cartesian, &cartesian_start);
    let mut spatial_turn = Turn::new(&spatial, &spatial_start);
    agree(&hand, &mut turn, "joint coordinates");
    agree(&hand, &mut cartesian_turn, "cartesian coordinates");
    agree(&hand, &mut spatial_turn, "space");

    let mut squeezer = Dynamics::new(&andrews);
    let v: Vec<f64> = (0..andrews.nv).map(|k| 1.0 + 0.1 * k as f64).collect();

    let mut k = 0;
    let mut kernels = vec![
        Kernel::new("sample, by hand", || {
            for _ in 0..BATCH {
                k = if k < SAMPLES { k + 1 } else { 1 };
                black_box(hand.sample(black_box(k as f64 * (TAU / SAMPLES as f64)), Load::ByState));
            }
            BATCH
        }),
        Kernel::new("sample, general", || turn.run()),
        Kernel::new("sample, cartesian", || cartesian_turn.run()),
        Kernel::new("sample, space", || spatial_turn.run()),
        Kernel::new("terms, Andrews", || {
            for _ in 0..BATCH {
                squeezer.terms(0.0, black_box(&andrews_start.q), black_box(&v), &andrews_start.modes);
                black_box(&squeezer.work);
            }
            BATCH
        }),
        Kernel::new("serde_yaml alone", || {
            black_box(serde_yaml::from_str::<serde_yaml::Value>(black_box(&text)).is_ok());
            1
        }),
        Kernel::new("load and check", || {
            let document = Document::from_bytes(black_box(text.as_bytes()), "crank_rocker.yaml");
            let report = document.map(|d| d.check_all(&Selection::default()));
            assert!(!report.is_ok_and(|r| black_box(r).failed()));
            1
        }),
        Kernel::new("load one study", || {
            let selection = Selection { study: Some("one-turn"), ..Selection::default() };
            black_box(Document::read(black_box(&text), "crank_rocker.yaml").is_ok_and(|d| d.model(&selection).is_ok()));
            1
        }),
    ];

    let rounds = if timed { 400 } else { 1 };
    let length = if timed { Duration::from_millis(1) } else { Duration::ZERO };
    for _ in 0..rounds {
        for kernel in &mut kernels {
            kernel.time(length);
        }
    }
    if timed {
        report(&kernels);
    }
}

fn report(kernels: &[Kernel<'_>]) {
    let best = |name: &str| {
        let times = kernels.iter().filter(|k| k.name == name).flat_map(|k| &k.times);
        times.copied().fold(f64::INFINITY, f64::min)
    };
    println!("{:<20}{:>12}{:>12}", "", "best", "median");
    for kernel in kernels {
        println!("{:<20}{:>12}{:>12}", kernel.name, readable(best(kernel.name)), readable(median(kernel.times.clone())));
    }
    println!();
    for (name, yardstick, limit) in LIMITS {
        let ratio = best(name) / best(yardstick);
        let verdict = if ratio <= limit { "ok" } else { "TOO SLOW" };
        println!("{name} / {yardstick}: {ratio:.2} (at most {limit}) {verdict}");
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn readable(seconds: f64) -> String {
    if seconds < 1e-6 { format!("{:.1} ns", seconds * 1e9) } else { format!("{:.2} us", seconds * 1e6) }
}

fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn model_of(text: &str) -> Model {
    let selection = Selection::default();
    Document::read(text, "model").and_then(|d| d.model(&selection)).unwrap_or_else(|report| panic!("{}", report.render(false)))
}

fn assembled<G: Space<S = f64>>(model: &Model, coordinates: Coordinates) -> (Mechanism<G>, Assembled) {
    assemble(model, &parameters(model), coordinates).unwrap_or_else(|fault| panic!("{}", fault.reason()))
}

/// One turn of a driven crank, sample by sample: predicted by v h + ½ a h², corrected, then rates, switches, forces, reactions.
struct Turn<'m, G: Space<S = f64>> {
    driven: Driven<'m, G>,
    start: Assembled,
    modes: Vec<i32>,
    step: f64,
    delta: Vec<f64>,
    /// Samples since the start.
    k: usize,
}

impl<'m, G: Space<S = f64>> Turn<'m, G> {
    fn new(mechanism: &'m Mechanism<G>, start: &Assembled) -> Self {
        Self {
            driven: Driven::new(mechanism, start),
            start: start.clone(),
            modes: start.modes.clone(),
            step: TAU / SAMPLES as f64 / Parameters::default().speed,
            delta: vec![0.0; mechanism.nv],
            k: SAMPLES,
        }
    }

    /// Back to the start.
    fn begin(&mut self) {
        self.driven.q.copy_from_slice(&self.start.q);
        self.modes.copy_from_slice(&self.start.modes);
        self.solve(0.0);
    }

    fn solve(&mut self, t: f64) {
        let reached = self.driven.follow(t, &mut self.modes);
        assert!(reached.is_ok(), "not reached at {t} s");
        self.driven.rates(&self.modes);
        let m = self.driven.dynamics.mechanism;
        self.driven.dynamics.switch(&m.force_program, &mut self.modes);
        self.driven.forces(&self.modes);
    }

    /// The next sample, at time `t`.
    fn advance(&mut self, t: f64) {
        let h = self.step;
        for (d, (v, a)) in self.delta.iter_mut().zip(self.driven.v.iter().zip(&self.driven.a)) {
            *d = h * (v + 0.5 * h * a);
        }
        self.driven.dynamics.mechanism.retract(&mut self.driven.q, &self.delta);
        self.solve(t);
    }

    /// Some samples further, from turn to turn.
    fn run(&mut self) -> usize {
        for _ in 0..BATCH {
            self.k = if self.k < SAMPLES { self.k + 1 } else { 0 };
            if self.k == 0 {
                self.begin();
            } else {
                self.advance(self.k as f64 * self.step);
            }
            black_box(&self.driven.reactions);
        }
        BATCH
    }
}

/// The general code and the hand-written one must do the same before they are compared.
fn agree<G: Space<S = f64>>(hand: &CrankRocker, turn: &mut Turn<'_, G>, what: &str) {
    turn.begin();
    for k in 1..SAMPLES {
        let t = k as f64 * turn.step;
        turn.advance(t);
        let (_, forces) = hand.sample(t * hand.p.speed, Load::ByState);
        let found = turn.driven.reactions.drives[0];
        assert!((found - forces.torque).abs() < 1e-6, "{what}, sample {k}: torque {found}, by hand {}", forces.torque);
    }
}
