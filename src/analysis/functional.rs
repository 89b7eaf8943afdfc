//! Functionals of columns over a whole study: means, integrals, extremes, values, first places.

use super::clock::Clock;
use super::continuous::Curve;
use super::extremum::Extremes;
use super::motion::Rows;
use super::quadrature::integrals;
use crate::model::{FunctionalKind, Model, Study};

/// A sampled motion, for functionals.
pub(super) struct Functionals<'a, C: Curve> {
    pub(super) clock: Clock,
    /// Progress at both ends.
    pub(super) ends: [f64; 2],
    pub(super) curve: &'a mut C,
    pub(super) rows: &'a Rows,
    pub(super) extremes: &'a [Option<Extremes>],
    pub(super) breaks: &'a [f64],
}

impl<C: Curve> Functionals<'_, C> {
    /// The value of each functional of a study; `columns[i]` is the column that functional i is taken of.
    pub(super) fn all(&mut self, model: &Model, study: &Study, parameters: &[f64], columns: &[usize]) -> Result<Vec<f64>, C::Error> {
        let integral = |k: FunctionalKind| matches!(k, FunctionalKind::Mean | FunctionalKind::Integral);
        let mut sums = vec![0.0; self.curve.columns()];
        if study.functionals.iter().any(|f| integral(f.kind)) {
            integrals(self.curve, self.breaks, &mut sums)?;
        }
        let length = self.ends[1] - self.ends[0];
        study
            .functionals
            .iter()
            .zip(columns)
            .map(|(f, &c)| {
                Ok(match f.kind {
                    FunctionalKind::Mean => sums[c] / length,
                    FunctionalKind::Integral => sums[c] * self.clock.direction,
                    FunctionalKind::Max => self.extremes[c].map_or(f64::NAN, |e| e.max.value),
                    FunctionalKind::Min => self.extremes[c].map_or(f64::NAN, |e| e.min.value),
                    FunctionalKind::Last => self.rows.values.last().map_or(f64::NAN, |r| r[c]),
                    FunctionalKind::Value => {
                        let at = f.at.map_or(f64::NAN, |id| model.pool.value(id, parameters));
                        self.value(self.clock.progress(at), c)?
                    }
                    FunctionalKind::First => self.first(c),
                })
            })
            .collect()
    }

    /// The column at a place; behind a switch that stands just there; not defined outside of the range.
    fn value(&mut self, s: f64, column: usize) -> Result<f64, C::Error> {
        let slack = 1e-12 * self.clock.length;
        let [low, high] = self.ends;
        if !(s >= low - slack && s <= high + slack) {
            return Ok(f64::NAN);
        }
        let s = s.clamp(low, high);
        let piece = self.breaks.partition_point(|b| *b <= s).clamp(1, self.breaks.len() - 1) - 1;
        let mut out = vec![0.0; self.curve.columns()];
        self.curve.eval(s, piece, &mut out)?;
        Ok(out[column])
    }

    /// Where a condition first holds: its switches are located, so it is the first row of a piece.
    fn first(&self, column: usize) -> f64 {
        let row = self.rows.values.iter().position(|r| r[column] != 0.0 && !r[column].is_nan());
        row.map_or(f64::NAN, |i| self.clock.value(self.rows.places[i]))
    }
}
