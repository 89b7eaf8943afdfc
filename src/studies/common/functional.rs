//! Functionals of columns over a whole study: means, integrals, extremes, values, first places.

use super::case::Case;
use super::clock::Clock;
use crate::model::FunctionalKind;
use crate::numerics::continuous::Curve;
use crate::numerics::extremum::Extremes;
use crate::numerics::quadrature::integrals;
use crate::numerics::resolve::Resolved;
use crate::results::Finding;

/// Integrals that are known less well than this part of that of the magnitude are named.
const UNCERTAIN: f64 = 1e-8;

/// A resolved motion, for functionals.
pub(crate) struct Functionals<'a, C: Curve> {
    pub(crate) clock: Clock,
    /// Progress at both ends.
    pub(crate) ends: [f64; 2],
    pub(crate) curve: &'a mut C,
    pub(crate) resolved: &'a Resolved,
    pub(crate) extremes: &'a [Option<Extremes>],
    pub(crate) breaks: &'a [f64],
}

impl<C: Curve> Functionals<'_, C> {
    /// The value of each functional of a study; `columns[i]` is the column that functional i is taken of.
    pub(crate) fn all(&mut self, case: Case<'_>, columns: &[usize], findings: &mut Vec<Finding>) -> Result<Vec<f64>, C::Error> {
        let integral = |k: FunctionalKind| matches!(k, FunctionalKind::Mean | FunctionalKind::Integral);
        let study = case.study;
        let asked: Vec<usize> = study.functionals.iter().zip(columns).filter(|(f, _)| integral(f.kind)).map(|(_, c)| *c).collect();
        let mut sums = vec![0.0; self.curve.columns()];
        if !asked.is_empty() {
            let noise = self.resolved.noise.iter().enumerate().map(|(c, n)| if asked.contains(&c) { *n } else { f64::INFINITY });
            let quality = integrals(self.curve, &self.resolved.panels, &noise.collect::<Vec<_>>(), &mut sums)?;
            if quality.error > UNCERTAIN {
                findings.push(Finding {
                    code: "integral".into(),
                    message: format!(
                        "a mean or an integral is known to a part {:.0e} of its size only: a quantity varies without end, or has no bound",
                        quality.error
                    ),
                    path: study.place.clone(),
                });
            }
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
                    FunctionalKind::Last => self.resolved.samples().column(c).last().copied().unwrap_or(f64::NAN),
                    FunctionalKind::Value => {
                        let at = f.at.map_or(f64::NAN, |id| case.value(id));
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

    /// Where a condition first holds: its switches are located, so it is the begin of a piece.
    fn first(&self, column: usize) -> f64 {
        let first = self.resolved.samples().column(column).iter().position(|y| *y != 0.0 && !y.is_nan());
        first.map_or(f64::NAN, |i| self.clock.value(self.resolved.places[i]))
    }
}
