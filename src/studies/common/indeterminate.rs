//! That a study tells reactions which rigid bodies do not determine.

use super::case::Case;
use super::watched::Watched;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::indeterminate::open_reactions;
use crate::mechanism::Mechanism;
use crate::model::Quantity;
use crate::results::Finding;

/// Most components that are named.
const NAMED: usize = 4;

/// What a study watches of open reactions, in a finding.
pub(crate) fn open<G: Space<S = f64>>(case: Case<'_>, watched: &Watched, m: &Mechanism<G>, start: &Assembled) -> Option<Finding> {
    let model = case.model;
    let inputs = model.pool.inputs_of(&watched.ids);
    let asked = inputs.iter().map(|&i| model.inputs[i as usize]);
    let is_part = |q: &Quantity| matches!(q, Quantity::Force { .. } | Quantity::Moment { .. } | Quantity::CouplingEffort { .. });
    let parts: Vec<Quantity> = asked.filter(is_part).collect();
    if parts.is_empty() {
        return None;
    }
    let open = open_reactions(m, start)?;
    let is_open = |quantity: &&Quantity| match **quantity {
        Quantity::Force { joint, axis } => open.joints[joint][0][axis],
        Quantity::Moment { joint, axis } => open.joints[joint][1][axis],
        Quantity::CouplingEffort { coupling } => open.couplings.get(coupling) == Some(&true),
        _ => false,
    };
    // in the plane a moment has no axis
    let name = |quantity: Quantity| match quantity {
        Quantity::Moment { joint, .. } if G::SPIN == 1 => format!("`{}.m`", model.joints[joint].name),
        other => format!("`{}`", model.name_of(other)),
    };
    let names: Vec<String> = parts.iter().filter(is_open).map(|quantity| name(*quantity)).collect();
    if names.is_empty() {
        return None;
    }
    let more = names.len().saturating_sub(NAMED);
    let shown = names[..names.len() - more].join(", ");
    Some(Finding {
        code: "reactions-not-unique".into(),
        message: format!(
            "rigid bodies do not determine {shown}{}: redundant constraints, which `grashof check` names, leave open how joints share forces, and what is given is one way of many that are in balance, another one in other `coordinates`; give the loop a joint that leaves it free (`pin-in-slot`, `spherical`, `universal`), or a stiff spring in the place of a joint, or remove a coupling that is one too many",
            if more == 0 { String::new() } else { format!(" and {more} more") },
        ),
        path: "joints".into(),
    })
}
