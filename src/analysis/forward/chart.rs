//! The coordinates in which a motion is integrated: all of them, or independent ones alone.

use super::eras::Eras;
use super::explain;
use super::setup::Plan;
use super::system::Mechanical;
use crate::analysis::outcome::Failure;
use crate::dynamics::LANES;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, RowOwner};
use crate::model::Study;
use crate::scalar::Dual;
use grashof_solvers::minimal::Minimal;
use grashof_solvers::{Node, State, System};

/// The system that is integrated: with all coordinates, or with independent ones alone.
pub(super) enum Charted<'m, G: Space<S = f64>> {
    Whole(Box<Mechanical<'m, G, G::Lift<Dual<LANES>>>>),
    Minimal(Box<Minimal<Mechanical<'m, G, G::Lift<Dual<LANES>>>>>),
}

impl<'m, G: Space<S = f64>> Charted<'m, G> {
    pub(super) fn system(&mut self) -> &mut dyn System {
        match self {
            Self::Whole(system) => &mut **system,
            Self::Minimal(system) => &mut **system,
        }
    }

    pub(super) fn mechanical(&mut self) -> &mut Mechanical<'m, G, G::Lift<Dual<LANES>>> {
        match self {
            Self::Whole(system) => system,
            Self::Minimal(system) => system.inner_mut(),
        }
    }

    pub(super) fn reduced(&self, state: &State) -> State {
        match self {
            Self::Whole(_) => state.clone(),
            Self::Minimal(system) => system.reduced(state),
        }
    }

    /// The node in all coordinates.
    pub(super) fn whole(&mut self, node: &Node, out: &mut Node) {
        match self {
            Self::Whole(_) => out.copy_from(node),
            Self::Minimal(system) => {
                // what cannot be closed has been refused by the integrator before
                let _ = system.whole(node, out);
            }
        }
    }
}

/// The system in the coordinates of the study; independent are the joint coordinates with an exact value in `start` that no driver
/// moves.
pub(super) fn chart<'m, G: Space<S = f64>>(
    study: &Study,
    plan: &Plan,
    system: Mechanical<'m, G, G::Lift<Dual<LANES>>>,
    era: &Eras<G>,
    state: &State,
) -> Result<Charted<'m, G>, Failure> {
    if !plan.minimal {
        return Ok(Charted::Whole(Box::new(system)));
    }
    explain::charted(study, &era.start, state)?;
    // a joint that rests on a stop may be the one that was asked for: then others are
    let rests = era.mechanism.rows.iter().any(|row| matches!(row.owner, RowOwner::Stop(_)));
    let asked = era.mechanism.starts.iter().filter(|s| !s.guess && !rests);
    let velocity = |gauge: usize| match era.mechanism.gauges[gauge].measured {
        Measured::Coordinate { along, .. } => Some(along.v),
        _ => None,
    };
    let driven = |v: &usize| era.mechanism.drives.iter().any(|d| velocity(d.gauge) == Some(*v));
    let independent: Vec<usize> = asked
        .filter_map(|s| match s.asked {
            Asked::Gauge { gauge, order: 0 } => velocity(gauge).filter(|v| !driven(v)),
            _ => None,
        })
        .collect();
    let minimal = Minimal::new(system, state, &independent);
    minimal.map(|m| Charted::Minimal(Box::new(m))).map_err(|why| explain::no_chart(study, &why))
}
