//! What a motion in time watches beside its columns: the functions of events, and parameters that vary.

use super::system::Watched;
use crate::expression::Id;
use crate::model::{Model, Study};

/// Parameters that the study itself varies, with their present values.
pub(super) fn swept(study: &Study, parameters: &[f64]) -> Vec<(usize, f64)> {
    let varied = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter));
    varied.map(|p| (p, parameters[p])).collect()
}

/// Columns, then event functions, restitutions and new values of parameters as one list; and the events that watch them.
pub(super) fn watched(model: &Model, ids: &[Id]) -> (Vec<Id>, Vec<Watched>) {
    let mut all = ids.to_vec();
    let mut watched = Vec::new();
    for event in &model.events {
        let output = all.len();
        all.push(event.when);
        let impact = event.restitution.as_ref().map(|r| {
            all.push(r.e);
            all.len() - 1
        });
        watched.push(Watched { output, crossing: event.crossing, stops: event.stop || !event.set.is_empty(), impact });
    }
    for event in &model.events {
        all.extend(event.set.iter().map(|(_, id)| *id));
    }
    (all, watched)
}
