//! Equilibria: closed forms, minima of the energy, equality of coordinates and of spaces, rest in motion, what is told.

mod closed_forms;
mod equivalence;
mod faults;
mod forces;
mod linkages;
mod many;
mod states;
mod weak;

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

/// A study of a text, run to its end.
fn run(text: &str, study: &str) -> Outcome {
    common::study(text, study, Coordinates::Joint)
}

/// The study `rest` of a text.
fn rest(text: &str) -> Outcome {
    run(text, "rest")
}

/// A planar model of a rest of the file, with the study `rest` and its scalars.
fn planar(gravity: &str, entries: &str, scalars: &str) -> Outcome {
    rest(&format!(
        "grashof: 1\nname: test\nspace: planar\ngravity: {gravity}\n{entries}\nstudies:\n  rest: {{ statics: {{ from: start }}, scalars: {{ {scalars} }} }}\n"
    ))
}

/// A list of a study.
fn list<'a>(outcome: &'a Outcome, name: &str) -> &'a [f64] {
    let found = outcome.lists.iter().find(|l| l.name == name);
    found.map_or_else(|| panic!("no list `{name}` in {:?}", outcome.lists), |l| &l.values)
}

/// Equilibria by a coordinate, rising, each with 1 for a stable one.
fn sorted(outcome: &Outcome, coordinate: &str) -> Vec<(f64, f64)> {
    let places = list(outcome, &format!("equilibria.{coordinate}"));
    let mut all: Vec<(f64, f64)> = places.iter().copied().zip(list(outcome, "equilibria.stable").iter().copied()).collect();
    all.sort_by(|x, y| x.0.total_cmp(&y.0));
    all
}

/// Messages of the findings of a code.
fn findings<'a>(outcome: &'a Outcome, code: &str) -> Vec<&'a str> {
    outcome.findings.iter().filter(|f| f.code == code).map(|f| f.message.as_str()).collect()
}

#[track_caller]
fn near(found: f64, wanted: f64, within: f64) {
    assert!((found - wanted).abs() <= within, "{found} is not {wanted} within {within:e}, it is off by {:e}", (found - wanted).abs());
}

/// The equilibria are those wanted, each with its stability.
#[track_caller]
fn all_are(found: &[(f64, f64)], wanted: &[(f64, f64)], within: f64) {
    let same = found.len() == wanted.len() && found.iter().zip(wanted).all(|(f, w)| (f.0 - w.0).abs() <= within && f.1 == w.1);
    assert!(same, "{found:?} is not {wanted:?}");
}

/// A zero of a function between two places with values of opposite signs, by halving.
fn zero(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let left = f(a) > 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if (f(middle) > 0.0) == left { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}

/// All zeros of a function on a grid fine enough to part them.
fn zeros(f: impl Fn(f64) -> f64, a: f64, b: f64, parts: usize) -> Vec<f64> {
    let at = |i: usize| a + (b - a) * i as f64 / parts as f64;
    (0..parts).filter(|&i| (f(at(i)) > 0.0) != (f(at(i + 1)) > 0.0)).map(|i| zero(&f, at(i), at(i + 1))).collect()
}
