//! Periodic regimes: multipliers against closed forms and against differences of the map of a period, regimes against closed forms
//! and long runs, failures in words.

mod conservative;
mod crank_rocker;
mod faults;
mod jumps;
mod linear;
mod nonlinear;
mod steady;
mod switches;
mod together;

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

const PERIOD: usize = 0;
const MEAN: usize = 1;
const MAX: usize = 2;
const MIN: usize = 3;
const FLOQUET: usize = 4;

/// The regime of a text's study `regime`.
fn regime(text: &str) -> Outcome {
    study(text, "regime", Coordinates::Joint)
}

/// A list of an outcome.
fn list<'o>(outcome: &'o Outcome, name: &str) -> &'o [f64] {
    outcome.lists.iter().find(|l| l.name == name).map_or(&[], |l| &l.values)
}

/// The multipliers (re, im), the largest first.
fn multipliers(outcome: &Outcome) -> Vec<[f64; 2]> {
    list(outcome, "multipliers_real").iter().zip(list(outcome, "multipliers_imaginary")).map(|(re, im)| [*re, *im]).collect()
}

/// The last row of a text's study `lap`.
fn end(text: &str) -> Vec<f64> {
    study(text, "lap", Coordinates::Joint).rows.last().expect("a row").to_vec()
}

/// The derivative of a map at x (columns: by each of x), by differences of fourth order with steps h.
fn derivative(map: impl Fn(&[f64]) -> Vec<f64>, x: &[f64], h: &[f64]) -> nalgebra::DMatrix<f64> {
    let columns: Vec<Vec<f64>> = (0..x.len())
        .map(|j| {
            let mut sum = vec![0.0; x.len()];
            for (part, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                let mut moved = x.to_vec();
                moved[j] += part * h[j];
                sum.iter_mut().zip(map(&moved)).for_each(|(s, y)| *s += weight * y / (12.0 * h[j]));
            }
            sum
        })
        .collect();
    nalgebra::DMatrix::from_fn(x.len(), x.len(), |i, j| columns[j][i])
}

/// The multipliers of a regime are the eigenvalues of a matrix, in any order.
fn same_multipliers(found: &Outcome, matrix: &nalgebra::DMatrix<f64>, within: f64) {
    let found = multipliers(found);
    let mut right: Vec<_> = matrix.complex_eigenvalues().iter().map(|m| [m.re, m.im]).collect();
    assert_eq!(found.len(), right.len());
    for m in &found {
        let distance = |r: &[f64; 2]| (m[0] - r[0]).hypot(m[1] - r[1]);
        let (i, nearest) = right.iter().enumerate().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1))).expect("one is left");
        assert!(distance(nearest) <= within, "multiplier {m:?} among {right:?}: {:e} apart", distance(nearest));
        right.remove(i);
    }
}

#[track_caller]
fn near(what: &str, found: f64, right: f64, within: f64) {
    assert!((found - right).abs() <= within, "{what}: {found}, not {right}; {:e} apart", (found - right).abs());
}

/// The regime has a finding with this code.
#[track_caller]
fn told(outcome: &Outcome, code: &str) {
    assert!(outcome.findings.iter().any(|f| f.code == code), "no `{code}` among {:?}", outcome.findings);
}
