//! Error, time and work of the integrators on four motions, and the price of generality beside an equation written by hand:
//! `cargo bench --bench integrators` writes docs/integrators.md and its figures; `-- ratios`, `-- steps` or `-- diagrams` prints
//! that part alone. Without `--bench` (as in `cargo test --benches`) each part is tried once, short, and nothing is written.
//!
//! Times are those of the steps, without loading and assembling, and the best of several runs. What is compared as a ratio runs
//! in turns, so that a machine that slows down for a while slows both.

#![allow(clippy::print_stdout, reason = "tables are what it is for")]

#[path = "integrators/by_hand.rs"]
mod by_hand;
#[path = "integrators/cases.rs"]
mod cases;
#[path = "closed_form/mod.rs"]
mod closed_form;
#[path = "integrators/sheet.rs"]
mod sheet;

use by_hand::{ByHand, Drive};
use cases::{Case, Size};
use grashof::model::{INTEGRATORS, Integrator};
use grashof::studies::dynamics::is_available;
use grashof_solvers::{Control, Counts, Integration, Method, Progress, Settings, System};
use sheet::{Series, Sheet, readable};
use std::time::Instant;

/// Error at which the general program is compared with the equation by hand.
const ERROR: f64 = 1e-6;
/// Runs that take longer end a series, s.
const LONG: f64 = 1.0;

/// The schemes of this build.
fn schemes() -> impl Iterator<Item = (&'static str, Integrator)> {
    INTEGRATORS.iter().map(|d| (d.name, d.integrator)).filter(|(_, by)| is_available(*by))
}

fn main() {
    let timed = std::env::args().any(|a| a == "--bench");
    let parts: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let wanted = |part: &str| parts.is_empty() || parts.iter().any(|p| p == part);
    let mut sheet = Sheet::default();
    if wanted("ratios") {
        ratios(&mut sheet, timed);
    }
    if wanted("steps") {
        steps(&mut sheet, timed);
    }
    if wanted("diagrams") {
        diagrams(&mut sheet, timed);
    }
    if timed && parts.is_empty() {
        sheet.write();
    }
}

/// What a run by hand came to.
struct Hand {
    time: f64,
    /// θ and ω at the end.
    end: [f64; 2],
    counts: Counts,
}

fn by_hand(drive: Drive, tolerance: f64, until: f64) -> Hand {
    let mut system = ByHand::new(drive);
    let settings = Settings { method: Method::Dop853, control: Control::Tolerance(tolerance), ..Settings::default() };
    let start = system.start();
    let begin = Instant::now();
    let mut run = Integration::new(&mut system as &mut dyn System, settings, &start).unwrap_or_else(|halt| panic!("{halt:?}"));
    while run.advance(&mut system, until).unwrap_or_else(|halt| panic!("{halt:?}")) != Progress::End {}
    let time = begin.elapsed().as_secs_f64();
    let state = &run.node().state;
    Hand { time, end: [state.q[0], state.v[0]], counts: run.engine.counts }
}

/// The loosest tolerance at which the error is small enough, by bisection of its logarithm.
fn loosest(error: impl Fn(f64) -> f64) -> f64 {
    let (mut tight, mut loose) = (-12.0, -3.0);
    for _ in 0..12 {
        let middle = 0.5 * (tight + loose);
        if error(10f64.powf(middle)) <= ERROR { tight = middle } else { loose = middle }
    }
    10f64.powf(tight)
}

/// General program beside the equation by hand.
fn ratios(sheet: &mut Sheet, timed: bool) {
    let rounds = if timed { 150 } else { 1 };
    let case = Case::crank_rocker();
    let right = &case.reference;
    let system = ByHand::new(Drive::Constant(200.0));
    assert!(system.off_closed_form() < 1e-9, "by hand off by {}", system.off_closed_form());
    let until = if timed { 5.0 } else { 0.05 };
    let hand = |tolerance: f64| by_hand(Drive::Constant(200.0), tolerance, until);
    let off = |h: &Hand| (h.end[0] - right[0]).abs().max((h.end[1] - right[1]).abs());
    let (mine, general) = if timed {
        (loosest(|t| off(&hand(t))), loosest(|t| case.run(Integrator::Dop853, Size::Tolerance(t)).error))
    } else {
        (1e-6, 1e-6)
    };
    let mut rows = Vec::new();
    let (mut best_hand, mut best_general) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        best_hand = best_hand.min(hand(mine).time);
        best_general = best_general.min(case.run(Integrator::Dop853, Size::Tolerance(general)).time);
    }
    let (h, g) = (hand(mine), case.run(Integrator::Dop853, Size::Tolerance(general)));
    rows.push(ratio_row("by hand, 5 s", mine, best_hand, off(&h), &h.counts));
    rows.push(ratio_row("crank-rocker, 5 s", general, best_general, g.error, &g.bare.counts));

    let until = if timed { 10.0 } else { 0.2 };
    let geared = Case::start_up(until);
    let (mut hand_time, mut general_time) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        hand_time = hand_time.min(by_hand(Drive::Geared, 1e-8, until).time);
        general_time = general_time.min(geared.run(Integrator::Dop853, Size::Tolerance(1e-8)).time);
    }
    let h = by_hand(Drive::Geared, 1e-8, until);
    let g = geared.run(Integrator::Dop853, Size::Tolerance(1e-8));
    let apart = (g.bare.columns[0] - h.end[0]).abs().max((g.bare.columns[1] - h.end[1]).abs());
    assert!(apart < 1e-4, "start-up: {:?} by hand, {:?}, {:?}", h.end, g.bare.columns, g.bare.stopped);
    rows.push(ratio_row("by hand, start-up 10 s", 1e-8, hand_time, apart, &h.counts));
    rows.push(ratio_row("start-up, 10 s", 1e-8, general_time, apart, &g.bare.counts));

    sheet.line("### Beside an equation written by hand\n");
    sheet.table(&["dop853", "tolerance", "time", "error", "steps", "rejected", "evaluations", "factorisations", "events"], &rows);
    sheet.line(&format!(
        "- crank-rocker at an error of 1e-6 in max(Δθ, Δω): {:.2} times the time of the equation by hand (goal: at most 4)",
        best_general / best_hand
    ));
    sheet.line(&format!(
        "- geared start-up of 10 s at 1e-8 with all events: {:.2} times (goal: at most 6); the two ends differ by {apart:.1e}\n",
        general_time / hand_time
    ));
}

fn ratio_row(name: &str, tolerance: f64, time: f64, error: f64, k: &Counts) -> Vec<String> {
    let counts = [k.steps, k.rejected, k.evaluations, k.factorisations, k.events].map(|n| n.to_string());
    [name.to_string(), format!("{tolerance:.1e}"), readable(time), format!("{error:.1e}")].into_iter().chain(counts).collect()
}

fn second_order(by: Integrator) -> bool {
    matches!(by, Integrator::CentralDifference | Integrator::Newmark | Integrator::Hht | Integrator::GeneralizedAlpha)
}

/// Price of a step of each scheme.
fn steps(sheet: &mut Sheet, timed: bool) {
    sheet.line("### Price of a step\n");
    sheet.line("At a tolerance of 1e-6; schemes of second order with fixed steps, in which Newton's method runs to 1e-12.\n");
    for case in [Case::crank_rocker(), Case::andrews()] {
        let rows: Vec<Vec<String>> = schemes()
            .map(|(name, by)| {
                let size = if second_order(by) { Size::Step(0.1 * case.step) } else { Size::Tolerance(1e-6) };
                let sample = case.best(by, size, if timed { 12 } else { 1 });
                let k = &sample.bare.counts;
                let per = |n: usize| format!("{:.1}", n as f64 / k.steps.max(1) as f64);
                let (steps, evaluations) = (k.steps.max(1) as f64, k.evaluations.max(1) as f64);
                vec![
                    name.to_string(),
                    readable(sample.time / steps),
                    per(k.evaluations),
                    per(k.tangents),
                    per(k.factorisations),
                    readable(sample.time / evaluations),
                    k.steps.to_string(),
                    format!("{:.1e}", sample.error),
                ]
            })
            .collect();
        sheet.line(&format!("{}:\n", case.about));
        let head = ["scheme", "per step", "evaluations", "tangents", "factorisations", "per evaluation", "steps", "error"];
        sheet.table(&head, &rows);
    }
}

/// Sizes of the steps of a scheme on a case.
fn sizes(by: Integrator, case: &Case) -> Vec<Size> {
    let decades = |from: i32, to: i32| (from..=to).map(|k| Size::Tolerance(10f64.powi(-k))).collect();
    match by {
        Integrator::CentralDifference => [1.0, 0.3, 0.1, 0.03, 0.01].map(|k| Size::Step(k * case.step)).to_vec(),
        _ if second_order(by) => decades(2, 7),
        Integrator::Rk4 => decades(3, 10),
        _ => decades(3, 12),
    }
}

/// Work over error for all schemes on all cases.
fn diagrams(sheet: &mut Sheet, timed: bool) {
    sheet.line("### Work over error\n");
    for case in [Case::crank_rocker(), Case::andrews(), Case::flyball(), Case::chain()] {
        let mut series = Vec::new();
        for (name, by) in schemes() {
            let mut samples = Vec::new();
            for size in sizes(by, &case).into_iter().take(if timed { usize::MAX } else { 1 }) {
                let sample = case.best(by, size, if timed { 12 } else { 1 });
                let long = sample.time > LONG;
                let text = match size {
                    Size::Tolerance(x) => format!("{x:.0e}"),
                    Size::Step(x) => format!("{x:.0e} s"),
                };
                samples.push((text, sample));
                if long {
                    break;
                }
            }
            series.push(Series { name, samples });
        }
        sheet.line(&format!("#### {}\n\n{}. Reference: {}.\n", case.name, case.about, case.source));
        sheet.diagram(case.name, &format!("{}: work over error", case.name), &series);
        let rows: Vec<Vec<String>> = series.iter().map(summary).collect();
        sheet.table(&["scheme", "error 1e-4 in", "1e-6", "1e-8", "tightest", "its error", "its time", "its steps", "stopped"], &rows);
    }
}

/// Times at three errors and the most accurate run of a series.
fn summary(series: &Series) -> Vec<String> {
    let good = || series.samples.iter().filter(|(_, s)| s.error.is_finite() && s.bare.stopped.is_none());
    let within = |error: f64| {
        let time = good().filter(|(_, s)| s.error <= error).map(|(_, s)| s.time).fold(f64::INFINITY, f64::min);
        if time.is_finite() { readable(time) } else { "-".into() }
    };
    let best = good().min_by(|a, b| a.1.error.total_cmp(&b.1.error));
    let of = |f: &dyn Fn(&(String, cases::Sample)) -> String| best.map_or("-".to_string(), f);
    let stopped: Vec<&str> = series.samples.iter().filter(|(_, s)| s.bare.stopped.is_some()).map(|(t, _)| t.as_str()).collect();
    vec![
        series.name.to_string(),
        within(1e-4),
        within(1e-6),
        within(1e-8),
        of(&|(t, _)| t.clone()),
        of(&|(_, s)| format!("{:.1e}", s.error)),
        of(&|(_, s)| readable(s.time)),
        of(&|(_, s)| s.bare.counts.steps.to_string()),
        stopped.join(", "),
    ]
}
