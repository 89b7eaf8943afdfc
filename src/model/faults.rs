//! What the rules say of a whole model.

use super::fault::Fault;
use super::rules::{Values, broken, not_finite};
use super::study::Take;
use super::vocabulary::Quantity;
use super::whole::Model;
use crate::expression::Id;
use std::sync::Arc;

impl Model {
    /// What the rules of the file, of its values and those of its study, say against values of the parameters.
    pub(crate) fn faults(&self, parameters: &[f64]) -> Vec<Fault> {
        let values = Values { numbers: parameters.to_vec(), unknown: parameters.iter().map(|x| !x.is_finite()).collect() };
        let mut faults = Vec::new();
        for (i, parameter) in self.parameters.iter().enumerate() {
            // one that is computed from another without a value is not told again
            let needs = self.pool.parameters_of(&[parameter.value]);
            let follows = needs.iter().any(|need| values.unknown.get(*need as usize) == Some(&true));
            if let (true, false, Some(x)) = (values.unknown.get(i) == Some(&true), follows, parameters.get(i)) {
                let why = self.pool.cause(parameter.value, parameters, &Arc::from([]));
                faults.push(self.traced(not_finite(parameter, *x, why), &[parameter.value]));
            }
        }
        let broken = broken(&self.checks, (&self.pool, &self.tables), &values, &String::clone);
        faults.extend(broken.into_iter().map(|(check, fault)| self.traced(fault, &check.ids)));
        faults
    }

    /// A fault with the remedy that names the study which a value was taken from, if one was.
    fn traced(&self, fault: Fault, ids: &[Id]) -> Fault {
        match self.taken(ids) {
            Some(Take { name, study, scalar, value, .. }) => {
                let help = format!("`{name}` = {value} is `{scalar}` of study `{study}`: look there");
                fault.help(help)
            }
            None => fault,
        }
    }

    /// A scalar of another study that values are computed from, through parameters that the study itself does not vary.
    fn taken(&self, ids: &[Id]) -> Option<&Take> {
        let study = self.study.as_ref().filter(|study| !study.take.is_empty())?;
        let varied: Vec<usize> = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter)).collect();
        let mut reached = vec![false; self.parameters.len()];
        let mut open = ids.to_vec();
        while let Some(id) = open.pop() {
            for input in self.pool.inputs_of(&[id]) {
                if let Some(Quantity::Taken(k)) = self.inputs.get(input as usize) {
                    return study.take.get(*k);
                }
            }
            for i in self.pool.parameters_of(&[id]).into_iter().map(|i| i as usize) {
                if !varied.contains(&i) && !std::mem::replace(&mut reached[i], true) {
                    open.push(self.parameters[i].value);
                }
            }
        }
        None
    }
}
