//! The values that can be moved in the page: numbers that stand in the file, and where they were moved to.

use super::look::{Look, of};
use grashof::model::{Literal, Model, Study, replaced};
use grashof::studies::common::case::parameters;
use grashof::studies::sweep::grid;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Literals of a file, and those that were moved.
#[derive(Default)]
pub(super) struct Values {
    literals: Vec<Literal>,
    /// Where values were moved to, by their places.
    moved: BTreeMap<String, f64>,
    /// Ranges that sweeps and searches have, by places and studies, in the units of the file.
    ranges: BTreeMap<String, BTreeMap<String, (f64, f64)>>,
    /// Names of parameters that the command line sets.
    set: Vec<String>,
}

impl Values {
    /// None yet; the command line sets parameters of these names.
    pub(super) fn new(set: Vec<String>) -> Self {
        Self { set, ..Self::default() }
    }

    /// Those of a file that was read anew: what was changed in the file stands as it is there.
    pub(super) fn renew(&mut self, mut literals: Vec<Literal>) {
        literals.retain(|literal| literal.start || !self.set.contains(&literal.name));
        let number = |of: &[Literal], place: &str| of.iter().find(|literal| literal.place == place).map(|literal| literal.number);
        self.moved.retain(|place, to| {
            let now = number(&literals, place);
            now.is_some() && now == number(&self.literals, place) && now != Some(*to)
        });
        let unit = |of: &[Literal], place: &str| of.iter().find(|literal| literal.place == place).map(|literal| literal.unit.clone());
        self.ranges.retain(|place, _| unit(&literals, place) == unit(&self.literals, place));
        self.literals = literals;
    }

    /// Moves a value; false if there is none of this place.
    pub(super) fn place(&mut self, place: &str, to: f64) -> bool {
        let Some(literal) = self.literals.iter().find(|literal| literal.place == place) else { return false };
        if literal.number == to {
            self.moved.remove(place);
        } else {
            self.moved.insert(place.into(), to);
        }
        true
    }

    /// Takes all back, or one alone.
    pub(super) fn back(&mut self, place: Option<&str>) {
        match place {
            Some(place) => drop(self.moved.remove(place)),
            None => self.moved.clear(),
        }
    }

    /// Whether any is moved.
    pub(super) fn are_moved(&self) -> bool {
        !self.moved.is_empty()
    }

    /// A literal of the file.
    pub(super) fn literal(&self, place: &str) -> Option<&Literal> {
        self.literals.iter().find(|literal| literal.place == place)
    }

    /// Where a value was moved to.
    pub(super) fn moved(&self, place: &str) -> Option<f64> {
        self.moved.get(place).copied()
    }

    /// The file with the values that were moved.
    pub(super) fn apply(&self, model: &str, text: &str) -> Look {
        let numbers: Vec<_> = self.literals.iter().filter_map(|literal| Some((literal, self.moved(&literal.place)?))).collect();
        of(model, replaced(text, &numbers).into_bytes())
    }

    /// Notes over which values of parameters a study goes.
    pub(super) fn note(&mut self, model: &Model, study: &Study) {
        self.ranges.values_mut().for_each(|of| _ = of.remove(&study.name));
        let base = parameters(model);
        for (parameter, low, high) in spans(model, study, &base) {
            let place = format!("parameters.{}", model.parameters[parameter].name);
            let now = self.moved(&place).or(self.literal(&place).map(|literal| literal.number));
            // the size of the unit as written, where the number tells it
            let size = now.map_or(f64::NAN, |now| base[parameter] / now);
            let (low, high) = (low / size, high / size);
            if size > 0.0 && low.is_finite() && high.is_finite() && low < high {
                self.ranges.entry(place).or_default().insert(study.name.clone(), (low, high));
            }
        }
    }

    /// What the page has of them.
    pub(super) fn json(&self) -> Value {
        let one = |literal: &Literal| {
            let known = self.ranges.get(&literal.place).and_then(|of| of.values().copied().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))));
            let (low, high) = known.unwrap_or_else(|| range(literal));
            json!({
                "place": literal.place, "name": literal.name, "start": literal.start, "unit": literal.unit,
                "number": literal.number, "value": self.moved(&literal.place).unwrap_or(literal.number), "low": low, "high": high,
            })
        };
        self.literals.iter().map(one).collect()
    }
}

/// Parameters that a study varies, by their numbers, with the least and the greatest value, SI.
fn spans(model: &Model, study: &Study, base: &[f64]) -> Vec<(usize, f64, f64)> {
    let points = if study.sweep.is_empty() { Vec::new() } else { grid(model, study) };
    let swept = study.sweep.iter().enumerate().map(|(k, sweep)| {
        let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[k]), b.max(p[k])));
        (sweep.parameter, low, high)
    });
    let solved = study.solve.iter().map(|solve| {
        let [a, b] = solve.between.map(|id| model.pool.value(id, base));
        (solve.parameter, a.min(b), a.max(b))
    });
    swept.chain(solved).collect()
}

/// From half a value to twice of it; about zero, and for angles of a start, to both sides.
fn range(literal: &Literal) -> (f64, f64) {
    let number = literal.number;
    let side = match (literal.start, literal.unit.as_str()) {
        (true, "deg" | "°") => 90.0,
        (true, "rad") => 1.5,
        (true, "turn") => 0.25,
        _ if number == 0.0 => 1.0,
        _ => return ((0.5 * number).min(2.0 * number), (0.5 * number).max(2.0 * number)),
    };
    (number - side, number + side)
}
