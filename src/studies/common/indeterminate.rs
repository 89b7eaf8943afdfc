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
    let parts: Vec<(Quantity, [usize; 3])> = asked
        .filter_map(|quantity| match quantity {
            Quantity::Force { joint, axis } => Some((quantity, [joint, 0, axis])),
            Quantity::Moment { joint, axis } => Some((quantity, [joint, 1, axis])),
            _ => None,
        })
        .collect();
    if parts.is_empty() {
        return None;
    }
    let open = open_reactions(m, start)?;
    // in the plane a moment has no axis
    let name = |quantity: Quantity| match quantity {
        Quantity::Moment { joint, .. } if G::SPIN == 1 => format!("`{}.m`", model.joints[joint].name),
        other => format!("`{}`", model.name_of(other)),
    };
    let names: Vec<String> = parts.iter().filter(|(_, [joint, part, axis])| open[*joint][*part][*axis]).map(|(q, _)| name(*q)).collect();
    if names.is_empty() {
        return None;
    }
    let more = names.len().saturating_sub(NAMED);
    let shown = names[..names.len() - more].join(", ");
    Some(Finding {
        code: "reactions-not-unique".into(),
        message: format!(
            "rigid bodies do not determine {shown}{}: redundant constraints leave open how joints share forces, and what is given is one way of many that are in balance, another one in other `coordinates`; give the loop a joint that leaves it free (`pin-in-slot`, `spherical`, `universal`), or a stiff spring in the place of a joint",
            if more == 0 { String::new() } else { format!(" and {more} more") },
        ),
        path: "joints".into(),
    })
}
