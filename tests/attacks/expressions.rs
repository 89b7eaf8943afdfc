//! Expressions against a second evaluator: as parameters, which are folded to numbers, and as measures over time, with rates.

use super::formula::{Formula, Trace, names};
use super::{cases, seeded, tell};
use crate::common::study;
use grashof::mechanism::Coordinates;
use std::fmt::Write;
use std::panic::catch_unwind;

/// Names of a formula; the first is the time in s.
const NAMES: usize = 4;
/// Formulas of one model.
const BATCH: usize = 8;
/// Instants at which they are evaluated, and their end.
const SAMPLES: usize = 7;
const UNTIL: f64 = 1.4;

/// The value at t, and how far rounding may be off; none where it is undefined or hangs on rounding.
fn at(formula: &Formula, t: f64, given: &[f64]) -> Option<(f64, Trace)> {
    let all: Vec<f64> = [&[t], given].concat();
    let mut trace = Trace::default();
    let value = formula.value(&all, &mut trace);
    (value.is_finite() && trace.largest < 1e5 && trace.gap > 1e-9).then_some((value, trace))
}

/// The rate by differences of two widths, if they agree and no switch is near.
fn slope(formula: &Formula, t: f64, given: &[f64]) -> Option<(f64, f64)> {
    let difference = |h: f64| {
        let (plus, a) = at(formula, t + h, given)?;
        let (minus, b) = at(formula, t - h, given)?;
        (a.gap.min(b.gap) > 1e-2 && a.largest.max(b.largest) < 1e3).then_some((plus - minus) / (2.0 * h))
    };
    let (wide, near) = (difference(2e-4)?, difference(1e-4)?);
    let slope = (4.0 * near - wide) / 3.0;
    let doubt = (near - wide).abs();
    (doubt < 1e-4 * (1.0 + slope.abs())).then_some((slope, 1e-6 * (1.0 + slope.abs()) + doubt))
}

#[test]
fn expressions_are_what_a_second_evaluator_says() {
    let wanted = cases(400);
    let mut dice = seeded(0x5EC0_17D0);
    let (mut formulas, mut values, mut rates, mut tried) = (0, 0, 0, 0);
    while formulas < wanted {
        tried += BATCH;
        let given = names(&mut dice, NAMES - 1);
        let batch: Vec<Formula> = (0..BATCH).map(|_| Formula::random(&mut dice, NAMES, 4)).collect();
        // undefined anywhere on the way, it would rightly stop the study
        let dense = |f: &Formula| (0..=70).all(|k| at(f, UNTIL * f64::from(k) / 70.0, &given).is_some());
        let batch: Vec<Formula> = batch.into_iter().filter(dense).collect();
        let mut measures = String::new();
        for (i, f) in batch.iter().enumerate() {
            writeln!(measures, "  m{i}: {}\n  d{i}: rate(m{i})", f.text()).unwrap();
        }
        let listed: Vec<String> = (0..batch.len()).flat_map(|i| [format!("m{i}"), format!("d{i}")]).collect();
        let fixed: Vec<String> = given.iter().enumerate().map(|(i, x)| format!("p{}: {x}", i + 1)).collect();
        let text = format!(
            "grashof: 1\nname: formulas\nspace: planar\ngravity: none\nparameters: {{ {} }}\nbodies: {{ block: {{}} }}\n\
             joints: {{ S: {{ slider: [ground, block.origin] }} }}\ndrivers: {{ drive: {{ joint: S, speed: 1 m/s }} }}\n\
             measures:\n  p0: S.position/(1 m)\n{measures}studies:\n  move: {{ kinematics: {{ over: {UNTIL} s, samples: {SAMPLES} }}, columns: [time, {}] }}\n",
            fixed.join(", "),
            listed.join(", ")
        );
        if batch.is_empty() {
            continue;
        }
        let outcome = catch_unwind(|| study(&text, "move", Coordinates::Joint)).unwrap_or_else(|_| panic!("it does not run:\n{text}"));
        for row in &outcome.rows {
            for (i, f) in batch.iter().enumerate() {
                let Some((right, trace)) = at(f, row[0], &given) else { continue };
                let (found, rate) = (row[1 + 2 * i], row[2 + 2 * i]);
                let tolerance = 1e-10 * trace.largest;
                assert!((found - right).abs() <= tolerance, "{} at {}: {found}, not {right}\n{text}", f.text(), row[0]);
                values += 1;
                if let Some((right, tolerance)) = slope(f, row[0], &given) {
                    assert!((rate - right).abs() <= tolerance, "rate of {} at {}: {rate}, not {right}\n{text}", f.text(), row[0]);
                    rates += 1;
                }
            }
        }
        formulas += batch.len() as u64;
    }
    tell(&format!("expressions: {formulas} formulas of {tried}, {values} values, {rates} rates; 0 findings"));
    assert!(values > 3 * formulas && rates > formulas, "{values} values and {rates} rates compared");
}
