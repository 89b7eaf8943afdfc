//! Outputs of a mechanism's programs that have no value at the state evaluated last.

use super::Dynamics;
use crate::geometry::Space;
use crate::mechanism::Undefined;

impl<G: Space<S = f64>> Dynamics<'_, G> {
    /// The first output without a value by the fault of its own expression, in the order of the stages. One that reads a quantity
    /// which the mechanics leave undefined, as a velocity in a singular position, does not count.
    pub fn undefined(&mut self, modes: &[i32]) -> Option<Undefined> {
        let w = &self.work;
        // most of them are finite, always
        let outputs = [&w.motions, &w.functions, &w.drifts, &w.force_outputs, &w.zdot];
        if outputs.iter().all(|of| of.iter().all(|x| x.is_finite())) {
            return None;
        }
        for (stage, program) in self.mechanism.programs().into_iter().enumerate() {
            let w = &self.work;
            let values = [&w.motions, &w.functions, &w.drifts, &w.force_outputs, &w.zdot][stage];
            let wrong: Vec<usize> = (0..program.outputs).filter(|k| values.get(*k).is_some_and(|x| !x.is_finite())).collect();
            if wrong.is_empty() {
                continue;
            }
            self.fill(program);
            let inputs = &self.work.inputs;
            if let Some(undefined) = wrong.into_iter().find_map(|output| program.undefined(output, inputs, modes)) {
                return Some(undefined);
            }
        }
        None
    }
}
