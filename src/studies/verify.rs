//! A motion in time computed twice more, and how many digits of its columns stand: `run --verify`.
//!
//! With the same scheme at a tenth of the tolerance (half of a fixed step), and with one of another family. If errors follow the
//! tolerance, the first of two runs at τ and rτ is off by |y − y'|/(1 − r), which is 10/9 of the difference (Richardson). A
//! column counts in units of its largest value, but no less than a thousandth of the largest of its dimension and of what its kind
//! is in this mechanism and motion: the unit of length is the mechanism's size, that of time the shortest in which it moves by that
//! size or a radian, that of mass follows from the largest energy or work of the run. An energy counts in units of that itself. What
//! is zero but for rounding so has no digits to lose. Scalars count likewise; where no column says anything of the motion, the places and
//! angles of all bodies do.

use super::compared::with_motion;
use super::integrators::{self, Steps};
use crate::expression::{Dimension, Id};
use crate::geometry::{Planar, Spatial};
use crate::mechanism::{Coordinates, build};
use crate::model::{Column, Dimensions, Forward, Integrator, Kind, Model, Quantity, Scalar, Study};
use crate::results::{Failure, six_digits};
use crate::studies::common::case::Case;
use crate::studies::common::outcome::Outcome;
use crate::studies::run::run;
use std::ops::Range;

/// Rows of a run that has no output step.
const ROWS: f64 = 400.0;
/// Digits from which on two runs agree.
const ENOUGH: f64 = 1.0;
/// Digits of a double.
const MOST: f64 = 16.0;
/// Differences that are rounding, whatever the column, SI.
const ROUNDING: f64 = 1e-13;
/// Times that are one, in output steps.
const NEAR: f64 = 1e-6;
/// What a column counts at least, of the largest one of its dimension.
const LEAST: f64 = 1e-3;

/// How well a study agrees with another computation of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    /// With what: `tolerance 1e-9`, `radau5`.
    with: String,
    /// Digits of the column that agrees least, at its worst row.
    digits: f64,
    /// Why there are none, if there are none.
    because: Option<String>,
}

/// What is said of a study, and whether it stands.
pub struct Verdict {
    /// In a line.
    pub line: String,
    /// Whether at least a digit stands in both.
    pub agrees: bool,
}

/// Computes the runs of a motion in time again in other ways, from the parameters that each was computed with; none if the study
/// is no such motion, or if it was interrupted.
///
/// # Errors
/// If the run itself does not begin.
pub fn verify(model: &Model, computed: &[Vec<f64>], stop: &dyn Fn() -> bool) -> Result<Option<Verdict>, Failure> {
    let Some(study) = &model.study else { return Ok(None) };
    let Kind::Dynamics(forward) = &study.kind else { return Ok(None) };
    let mut worst: Option<[Verified; 2]> = None;
    for values in computed {
        let found = one(Case::new(model, study, values), forward, stop)?;
        if stop() {
            return Ok(None);
        }
        let Some(found) = found else { continue };
        worst = Some(match worst {
            None => found,
            Some([a, b]) => {
                let [c, d] = found;
                [if c.digits < a.digits { c } else { a }, if d.digits < b.digits { d } else { b }]
            }
        });
    }
    Ok(worst.map(|both| Verdict { line: said(&both, computed.len()), agrees: both.iter().all(|v| v.because.is_none()) }))
}

/// `verify: 7.3 digits against tolerance 1e-9; 0 digits, because ...`
fn said(both: &[Verified], runs: usize) -> String {
    let one = |v: &Verified| match &v.because {
        None => format!("{:.1} digits against {}", v.digits, v.with),
        Some(why) => format!("0 digits, because {why}"),
    };
    let of = if runs > 1 { format!(" (the worst of {runs} runs)") } else { String::new() };
    format!("verify: {}{of}", both.iter().map(one).collect::<Vec<_>>().join("; "))
}

/// One run beside its two others; none if it stops on its way, which is told elsewhere.
fn one(case: Case<'_>, forward: &Forward, stop: &dyn Fn() -> bool) -> Result<Option<[Verified; 2]>, Failure> {
    let Case { study, parameters, .. } = case;
    let mut model = case.model.clone();
    let study = &with_motion(&mut model, study);
    let steps = integrators::steps(&model, forward, parameters);
    let until = model.pool.value(forward.until, parameters);
    let every = forward.every.map_or_else(|| output_step(steps, until), |id| model.pool.value(id, parameters));
    let compute = |model: &mut Model, by: Integrator, steps: Steps| {
        let changed = integrators::changed(model, study, forward, by, steps, Some(every));
        let study = Study { scalars: study.scalars.clone(), functionals: study.functionals.clone(), ..changed };
        run(Case::new(model, &study, parameters).undrawn(), stop)
    };
    let base = compute(&mut model, forward.integrator, steps)?;
    if base.stopped.is_some() {
        return Ok(None);
    }
    let size = match model.space {
        Dimensions::Planar => build::<Planar<f64>>(&model, parameters, Coordinates::Joint).map(|m| m.size()),
        Dimensions::Spatial => build::<Spatial<f64>>(&model, parameters, Coordinates::Joint).map(|m| m.size()),
    };
    let size = size.unwrap_or(1.0);
    let (finer, factor, with) = finer(forward, steps);
    let other = integrators::other(forward.integrator);
    // a fixed step has no tolerance that the other scheme could share
    let tight = match steps {
        Steps::Tolerance(x) => (0.1 * x).max(1e-13),
        Steps::Fixed(_) => 1e-10,
    };
    let others = [(forward.integrator, finer, factor, with), (other, Steps::Tolerance(tight), 1.0, other.name().to_string())];
    let [a, b] = others.map(|(by, steps, factor, with)| {
        let other = compute(&mut model, by, steps);
        Comparison { model: &model, study, base: &base, size, every, events: forward.locate }.verified(other, factor, with)
    });
    Ok(Some([a, b]))
}

/// Rows for a run that has none of its own: about 400, at steps of the integrator if these are fixed.
fn output_step(steps: Steps, until: f64) -> f64 {
    match steps {
        Steps::Fixed(h) => h * (until / (ROWS * h)).ceil().max(1.0),
        Steps::Tolerance(_) => until / ROWS,
    }
}

/// Finer steps of the same scheme, the factor from the difference to the error, and what it is called.
fn finer(forward: &Forward, steps: Steps) -> (Steps, f64, String) {
    match steps {
        Steps::Tolerance(x) => {
            let finer = (0.1 * x).max(1e-14);
            // no tolerance below the smallest one: the difference is what there is
            (Steps::Tolerance(finer), if finer < x { 1.0 / (1.0 - finer / x) } else { 1.0 }, format!("tolerance {}", six_digits(finer)))
        }
        Steps::Fixed(h) => {
            let order = forward.order.unwrap_or(forward.integrator.description().order) as i32;
            (Steps::Fixed(0.5 * h), 1.0 / (1.0 - 0.5f64.powi(order)), format!("a step of {} s", six_digits(0.5 * h)))
        }
    }
}

/// A run that is compared with others of the same study.
struct Comparison<'a> {
    model: &'a Model,
    study: &'a Study,
    base: &'a Outcome,
    /// Size of the mechanism, m.
    size: f64,
    /// Output step, s.
    every: f64,
    /// Whether both locate switches, so that they must find the same.
    events: bool,
}

impl Comparison<'_> {
    fn verified(&self, other: Result<Outcome, Failure>, factor: f64, with: String) -> Verified {
        match self.digits(other, factor, &with) {
            Ok(digits) => Verified { with, digits, because: None },
            Err(why) => Verified { with, digits: 0.0, because: Some(why) },
        }
    }

    /// Digits that agree, or why none do.
    fn digits(&self, other: Result<Outcome, Failure>, factor: f64, with: &str) -> Result<f64, String> {
        let other = other.map_err(|failure| format!("{with} did not begin: {}", failure.reason()))?;
        if let Some(reason) = &other.stopped {
            return Err(format!("{with} stopped on its way: {reason}"));
        }
        if self.events {
            self.same_events(&other, with)?;
        }
        let (scales, least) = self.scales();
        let mut worst = (0.0, 0, 0, 0);
        for (i, k) in self.pairs(&other) {
            for (c, scale) in scales.iter().enumerate() {
                let (x, y) = (self.base.rows[i][c], other.rows[k][c]);
                let off = factor * difference(x, y) / scale;
                if off > worst.0 {
                    worst = (off, i, k, c);
                }
            }
        }
        let (off, i, k, c) = worst;
        let digits = (-off.log10()).min(MOST);
        if digits >= ENOUGH {
            return self.digits_of_scalars(&other, factor, with, least).map(|of_scalars| digits.min(of_scalars));
        }
        let column = &self.study.columns[c];
        let unit = column.dimension.si();
        let value = |x: f64| format!("{} {unit}", six_digits(x)).trim_end().to_string();
        let [x, y] = [self.base.rows[i][c], other.rows[k][c]].map(value);
        Err(format!("`{}` is {x} at t = {:.6} s, and {y} with {with}", column.name, self.base.places[i]))
    }

    /// Digits of the scalars that agree, or why none do; a scalar counts no less than a column of its dimension.
    fn digits_of_scalars(&self, other: &Outcome, factor: f64, with: &str, (units, energy): ([f64; 4], f64)) -> Result<f64, String> {
        let mut digits = MOST;
        for ((scalar, x), y) in self.study.scalars.iter().zip(&self.base.scalars).zip(&other.scalars) {
            let least = LEAST * scalar.dimension.size(units);
            let least = if self.of_energies(scalar) { least.max(energy) } else { least };
            let off = factor * difference(*x, *y) / x.abs().max(least).max(ROUNDING);
            digits = digits.min(-off.log10());
            if digits < ENOUGH {
                let unit = scalar.dimension.si();
                let [x, y] = [*x, *y].map(|x| format!("{} {unit}", six_digits(x)).trim_end().to_string());
                return Err(format!("the scalar `{}` is {x}, and {y} with {with}", scalar.name));
            }
        }
        Ok(digits)
    }

    /// Whether the other run has the same events and switches in the same order.
    fn same_events(&self, other: &Outcome, with: &str) -> Result<(), String> {
        let pairs = self.base.events.iter().zip(&other.events);
        if let Some((k, (a, b))) = pairs.enumerate().find(|(_, (a, b))| a.name != b.name) {
            return Err(format!("event {} is `{}` at t = {:.6} s, and `{}` at t = {:.6} s with {with}", k + 1, a.name, a.at, b.name, b.at));
        }
        let switches = |outcome| pieces(outcome, NEAR * self.every).len().saturating_sub(1);
        for (what, a, b) in [("events", self.base.events.len(), other.events.len()), ("switches", switches(self.base), switches(other))] {
            if a != b {
                return Err(format!("there are {a} {what}, and {b} with {with}"));
            }
        }
        Ok(())
    }

    /// Rows of both runs that belong together: rows of the grid, and both sides of every switch if both runs have them.
    fn pairs(&self, other: &Outcome) -> Vec<(usize, usize)> {
        if !self.events {
            return matched(&self.base.places, &other.places, 0..self.base.places.len(), 0..other.places.len(), self.every);
        }
        let [mine, others] = [self.base, other].map(|outcome| pieces(outcome, NEAR * self.every));
        let inside = mine.into_iter().zip(others).flat_map(|(a, b)| {
            let ends = [(a.start, b.start), (a.end - 1, b.end - 1)];
            let inner = matched(&self.base.places, &other.places, a.start + 1..a.end - 1, b.start + 1..b.end - 1, self.every);
            ends.into_iter().chain(inner)
        });
        inside.collect()
    }

    /// The size of each column; the sizes of m, kg, s and A, and the largest energy.
    fn scales(&self) -> (Vec<f64>, ([f64; 4], f64)) {
        let largest = |c: usize| self.base.rows.iter().map(|r| r[c].abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
        let columns = &self.study.columns;
        let sizes: Vec<f64> = (0..columns.len()).map(largest).collect();
        let energy = self.base.certificate.march.as_ref().map_or(0.0, |m| m.energy_scale);
        let units = self.units(&sizes, energy);
        let least = |c: &Column| {
            let alike = columns.iter().zip(&sizes).filter(|(other, _)| other.dimension == c.dimension).map(|(_, size)| *size);
            let least = LEAST * alike.fold(c.dimension.size(units), f64::max);
            if self.is_energy(c) { least.max(energy) } else { least }
        };
        (columns.iter().zip(&sizes).map(|(c, size)| size.max(least(c)).max(ROUNDING)).collect(), (units, energy))
    }

    /// Sizes of m, kg, s and A in this motion, from the sizes of the columns and the largest energy.
    fn units(&self, sizes: &[f64], energy: f64) -> [f64; 4] {
        let rate = |dimension: Dimension, way: f64| {
            let alike = self.study.columns.iter().zip(sizes).filter(move |(c, _)| c.dimension == dimension);
            alike.map(|(_, size)| size / way).fold(0.0, f64::max)
        };
        let fastest = rate(Dimension::SPEED, self.size).max(rate(Dimension::ANGULAR_SPEED, 1.0));
        let whole = self.base.places.last().copied().unwrap_or(1.0).max(f64::MIN_POSITIVE);
        let time = if fastest > 0.0 { whole.min(fastest.recip()) } else { whole };
        [self.size, energy * time * time / (self.size * self.size), time, 1.0]
    }

    /// Whether a column is made of energies, not of torques, which have the same dimension.
    fn is_energy(&self, column: &Column) -> bool {
        column.dimension == Dimension::ENERGY && self.has_energies(&[column.value])
    }

    /// The same of a scalar.
    fn of_energies(&self, scalar: &Scalar) -> bool {
        let inputs = self.model.pool.inputs_of(&[scalar.value]).into_iter();
        let taken = |i: u32| if let Quantity::Functional(k) = self.model.inputs[i as usize] { self.study.functionals.get(k) } else { None };
        let of: Vec<Id> = inputs.filter_map(taken).map(|functional| functional.of).chain([scalar.value]).collect();
        scalar.dimension == Dimension::ENERGY && self.has_energies(&of)
    }

    fn has_energies(&self, ids: &[Id]) -> bool {
        use Quantity::{Kinetic, Potential, SpringEnergy, Work};
        let energies = |i: u32| matches!(self.model.inputs[i as usize], Kinetic | Potential | SpringEnergy { .. } | Work(_));
        self.model.pool.inputs_of(ids).into_iter().any(energies)
    }
}

/// How far two values are apart, but for rounding; what is defined in one of them alone is a difference, too.
fn difference(x: f64, y: f64) -> f64 {
    let off = (x - y).abs();
    match (x.is_nan(), y.is_nan()) {
        (true, true) => 0.0,
        (false, false) if x == y || off <= ROUNDING => 0.0,
        (false, false) => off,
        _ => f64::INFINITY,
    }
}

/// Rows of each piece between switches that lasts longer than `near`, s: between switches of one instant there is no motion to
/// compare, and which of them comes first is a matter of rounding.
fn pieces(outcome: &Outcome, near: f64) -> Vec<Range<usize>> {
    let begins = std::iter::once(0).chain(outcome.switches.iter().map(|i| i + 1));
    let ends = outcome.switches.iter().map(|i| i + 1).chain([outcome.places.len()]);
    let lasts = |r: &Range<usize>| r.end > r.start && outcome.places[r.end - 1] - outcome.places[r.start] > near;
    begins.zip(ends).map(|(begin, end)| begin..end).filter(lasts).collect()
}

/// Rows at the same times; those of one range alone are left out.
fn matched(a: &[f64], b: &[f64], mine: Range<usize>, others: Range<usize>, every: f64) -> Vec<(usize, usize)> {
    let near = NEAR * every;
    let mut k = others.start;
    let mut out = Vec::new();
    for i in mine {
        while k < others.end && b[k] < a[i] - near {
            k += 1;
        }
        if k < others.end && (b[k] - a[i]).abs() <= near {
            out.push((i, k));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_at_the_same_times_are_paired() {
        let a = [0.0, 0.1, 0.2, 0.25, 0.3];
        let b = [0.0, 0.1, 0.2 + 1e-9, 0.26, 0.3];
        assert_eq!(matched(&a, &b, 0..5, 0..5, 0.1), [(0, 0), (1, 1), (2, 2), (4, 4)]);
        assert_eq!(matched(&a, &b, 2..2, 0..5, 0.1), []);
    }

    #[test]
    fn pieces_lie_between_switches_of_different_instants() {
        let outcome = Outcome { places: vec![0.0, 0.1, 0.1, 0.1 + 1e-12, 0.1 + 1e-12, 0.2], switches: vec![1, 3], ..Outcome::default() };
        assert_eq!(pieces(&outcome, 1e-9), [0..2, 4..6]);
        assert_eq!(pieces(&outcome, 0.0), [0..2, 2..4, 4..6]);
    }

    #[test]
    fn disagreement_is_said_with_its_reason() {
        let good = Verified { with: "tolerance 1e-9".into(), digits: 7.31, because: None };
        let bad = Verified { with: "radau5".into(), digits: 0.0, because: Some("there are 2 events, and 3 with radau5".into()) };
        assert_eq!(
            said(&[good, bad], 1),
            "verify: 7.3 digits against tolerance 1e-9; 0 digits, because there are 2 events, and 3 with radau5"
        );
    }
}
