//! Checks of numbers: what can only be seen when the parameters have values.

use super::decoder::Check;
use super::decoder::Decoder;
use crate::expression::Id;
use crate::model::fault::Fault;
use crate::model::rules::{self, Values};
use std::sync::Arc;

impl<'n> Decoder<'n> {
    /// Numbers of all parameters, with `set` over the file's values. `waiting` are those that a `take` decides.
    pub(crate) fn evaluate(&mut self, set: &[(usize, Id)], waiting: &[usize]) -> Values {
        let mut ids: Vec<Id> = self.name_space.model.parameters.iter().map(|p| p.value).collect();
        for (i, id) in set {
            ids[*i] = *id;
        }
        let mut unknown: Vec<bool> = self.name_space.parameters.iter().map(Option::is_none).collect();
        for i in waiting {
            unknown[*i] = true;
        }
        let order = match self.pool.order_parameters(&ids) {
            Ok(order) => order,
            Err(cycle) => {
                // cycles of the file itself were reported; this one comes from `set`
                if let Some((first, _)) = set.iter().find(|(i, _)| cycle.contains(i)) {
                    let start = cycle.iter().position(|i| i == first).unwrap_or(0);
                    let cycle: Vec<usize> = cycle[start..].iter().chain(&cycle[..start]).copied().collect();
                    let message = super::order::in_words(&cycle, |i| self.name_space.model.parameters[i].name.clone());
                    self.faults.push(Fault::new("cycle", String::new(), message, "parameters that do not need themselves"));
                }
                return Values { numbers: vec![f64::NAN; ids.len()], unknown: vec![true; ids.len()] };
            }
        };
        let mut numbers = vec![f64::NAN; ids.len()];
        for i in order {
            let needs = self.pool.parameters_of(&[ids[i]]);
            unknown[i] |= needs.iter().any(|need| unknown.get(*need as usize) == Some(&true));
            if unknown[i] {
                continue;
            }
            numbers[i] = self.pool.value(ids[i], &numbers);
            if !numbers[i].is_finite() {
                unknown[i] = true;
                let why = self.pool.cause(ids[i], &numbers, &Arc::from([]));
                self.faults.push(rules::not_finite(&self.name_space.model.parameters[i], numbers[i], why));
            }
        }
        Values { numbers, unknown }
    }

    /// Runs all checks from the `from`-th on, with these parameters.
    pub(crate) fn run_checks(&mut self, values: &Values, from: usize) {
        let model = (&self.pool, &self.name_space.model.tables[..]);
        let found = rules::broken(&self.checks[from..], model, values, &|steps| self.layers.source(steps));
        self.faults.extend(found.into_iter().map(|(_, fault)| fault));
    }

    /// Number of checks so far.
    pub(crate) fn checks_so_far(&self) -> usize {
        self.checks.len()
    }

    /// Makes checks from the `from`-th on those of the file's own values: none if these are changed, and none of the runs of a sweep.
    pub(crate) fn check_at_own_values(&mut self, from: usize, changed: bool) {
        self.checks.truncate(if changed { from } else { self.checks.len() });
        self.checks[from..].iter_mut().for_each(|check| check.once = true);
    }

    /// The checks of a study, which are forgotten.
    pub(crate) fn checks_from(&mut self, from: usize) -> Vec<Check<'n>> {
        self.checks.split_off(from)
    }

    /// Checks that go with the model, their places looked up.
    pub(crate) fn kept_checks(&self, checks: &[Check<'n>]) -> Vec<rules::Check> {
        let kept = checks.iter().filter(|check| !check.once);
        kept.map(|c| rules::Check { rule: c.rule, ids: c.ids.clone(), place: self.layers.source(&c.place), once: false }).collect()
    }
}
