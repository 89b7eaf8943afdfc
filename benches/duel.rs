//! Grashof's side of the comparison with other codes: `benches/peers/run`.
//!
//! `cargo bench --bench duel -- MODEL SETTING...` runs the study `motion` of a model; a setting is INTEGRATOR:TOLERANCE. One line of JSON a
//! setting: its processor time and the columns at the end. `cost:INTEGRATOR:TOLERANCE` gives set-up, a step and an evaluation instead.

#![allow(clippy::print_stdout, reason = "lines for the program that calls it are what it is for")]

use grashof::model::{Control, Document, Forward, Integrator, Kind, Model, Selection};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::dynamics::{Unrecorded, unrecorded};
use std::time::Instant;

fn main() {
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let Some(path) = words.next() else { return };
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    for setting in words {
        let (cost, by) = setting.strip_prefix("cost:").map_or((false, setting.as_str()), |by| (true, by));
        let (integrator, size) = by.split_once(':').unwrap_or_else(|| panic!("{setting}: write INTEGRATOR:TOLERANCE"));
        let integrator = Integrator::named(integrator).unwrap_or_else(|| panic!("{integrator} is not known"));
        let size: f64 = size.parse().unwrap_or_else(|_| panic!("{size} is no number"));
        let begin = Instant::now();
        let (time, ended) = run(&text, integrator, size);
        let whole = begin.elapsed().as_secs_f64();
        let (seconds, measured) = if cost {
            (whole - time, vec![time / ended.counts.evaluations as f64, time / ended.counts.steps as f64])
        } else {
            (time, if ended.stopped.is_none() { ended.columns } else { Vec::new() })
        };
        println!("{{\"setting\": \"{setting}\", \"seconds\": {seconds:e}, \"measured\": {measured:?}}}");
    }
}

/// Time of the steps, s, and the end.
fn run(text: &str, integrator: Integrator, tolerance: f64) -> (f64, Unrecorded) {
    let selection = Selection { study: Some("motion"), ..Selection::default() };
    let read = Document::read(text, "problem").and_then(|document| document.model(&selection));
    let mut model: Model = read.unwrap_or_else(|report| panic!("{}", report.render(false)));
    let Some(study) = model.study.clone() else { panic!("no study") };
    let Kind::Dynamics(forward) = study.kind.clone() else { panic!("no motion in time") };
    let control = Control::Tolerance(Some(model.pool.constant(tolerance)));
    let forward = Forward { integrator, control, ..forward };
    let values = parameters(&model);
    let (mut begin, mut time) = (Instant::now(), 0.0);
    let mut timer = |on: bool| if on { begin = Instant::now() } else { time = begin.elapsed().as_secs_f64() };
    let ended = unrecorded(Case::new(&model, &study, &values), &forward, &mut timer);
    (time, ended.unwrap_or_else(|failure| Unrecorded { stopped: Some(failure.reason()), ..Unrecorded::default() }))
}
