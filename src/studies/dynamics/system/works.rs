//! Which powers a mechanism has.

use crate::geometry::Space;
use crate::mechanism::{EffortLaw, Mechanism, RowKind, StretchOf};
use grashof_solvers::Power;

/// Powers whose work is integrated: of drivers, of loads and motors, of dampers and friction, of end stops that give way.
pub(in crate::studies::dynamics) const WORKS: usize = 4;

/// What the powers of a mechanism are functions of.
pub(super) fn depends<G: Space<S = f64>>(m: &Mechanism<G>) -> Power {
    let moves = |kind: RowKind| match kind {
        RowKind::Driver { .. } => true,
        RowKind::Function(function) => m.functions[function].by_time.is_some(),
        RowKind::Gauge(_) | RowKind::Ratio { .. } => false,
    };
    let by_reactions = |law: &EffortLaw<G>| matches!(law, EffortLaw::Friction { pressing: Some(_), .. });
    if m.rows.iter().any(|row| moves(row.kind)) || m.efforts.iter().any(|effort| by_reactions(&effort.law)) {
        return Power::Reactions;
    }
    let stores = |law: &EffortLaw<G>| matches!(law, EffortLaw::Linear { damping, .. } if *damping == 0.0);
    let by_time = |of: StretchOf| matches!(of, StretchOf::Function(function) if m.functions[function].by_time.is_some());
    let conserves = m.point_loads.iter().all(|pull| pull.potential.is_some())
        && m.efforts.iter().all(|effort| stores(&effort.law))
        && m.stretches.iter().all(|stretch| stretch.moving.is_none() && !by_time(stretch.of));
    if conserves { Power::Zero } else { Power::State }
}
