//! The coordinates of a run: all of them, or independent ones alone, and with these the bridges over singular positions.
//!
//! Where a position is singular there are no independent coordinates. A run that comes near one stops, goes on with all coordinates by
//! explicit steps, which cross (`solvers/src/schemes/dop853/crossing.rs`), and returns to independent ones behind it.

use super::explain;
use super::phases::Phases;
use super::setup::Plan;
use super::system::Mechanical;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Row};
use crate::model::Study;
use crate::results::Failure;
use grashof_solvers::minimal::Minimal;
use grashof_solvers::{Control, Halt, Integration, Method, Node, Settings, State, System};

/// Tolerance of a bridge where steps are given.
const BRIDGE: f64 = 1e-9;

/// The system that is integrated.
pub(super) enum Charted<'m, G: Space<S = f64>> {
    /// With all coordinates.
    Whole(Box<Mechanical<'m, G>>),
    /// With independent ones alone, or with all while a singular position is bridged.
    Minimal { system: Box<Minimal<Mechanical<'m, G>>>, bridging: bool },
}

impl<'m, G: Space<S = f64>> Charted<'m, G> {
    /// The system in the coordinates of a study; independent are the joint coordinates with an exact value in `start` that no driver
    /// moves. `sound` is the best quality of charts so far.
    ///
    /// # Errors
    /// If there are no independent coordinates.
    pub(super) fn new(
        study: &Study,
        plan: &Plan,
        system: Mechanical<'m, G>,
        phase: &Phases<G>,
        state: &State,
        sound: &mut f64,
    ) -> Result<Self, Failure> {
        if !plan.minimal {
            return Ok(Self::Whole(Box::new(system)));
        }
        // a joint that rests on a stop, sticks or stands in a change point may be the one that was asked for: then others are
        let rests = phase.start.change.is_some() || phase.mechanism.rows.iter().any(Row::holds);
        let asked = phase.mechanism.starts.iter().filter(|s| !s.guess && !rests);
        let velocity = |gauge: usize| match phase.mechanism.gauges[gauge].measured {
            Measured::Coordinate { along, .. } => Some(along.v),
            _ => None,
        };
        let driven = |v: &usize| phase.mechanism.drives.iter().any(|d| velocity(d.gauge) == Some(*v));
        let independent: Vec<usize> = asked
            .filter_map(|s| match s.asked {
                Asked::Gauge { gauge, order: 0 } => velocity(gauge).filter(|v| !driven(v)),
                _ => None,
            })
            .collect();
        let mut minimal = Minimal::new(system, state, &independent).map_err(|why| explain::no_chart(study, &why))?;
        *sound = minimal.sound(*sound);
        let bridging = minimal.is_singular();
        Ok(Self::Minimal { system: Box::new(minimal), bridging })
    }

    pub(super) fn system(&mut self) -> &mut dyn System {
        match self {
            Self::Whole(system) => &mut **system,
            Self::Minimal { system, bridging: true } => system.inner_mut(),
            Self::Minimal { system, .. } => &mut **system,
        }
    }

    pub(super) fn mechanical(&mut self) -> &mut Mechanical<'m, G> {
        match self {
            Self::Whole(system) => system,
            Self::Minimal { system, .. } => system.inner_mut(),
        }
    }

    /// Whether all coordinates are integrated.
    pub(super) fn is_whole(&self) -> bool {
        !matches!(self, Self::Minimal { bridging: false, .. })
    }

    /// The node in all coordinates.
    pub(super) fn whole(&mut self, node: &Node, out: &mut Node) {
        match self {
            Self::Minimal { system, bridging: false } => {
                // what cannot be closed has been refused by the integrator before
                let _ = system.whole(node, out);
            }
            _ => out.copy_from(node),
        }
    }

    /// An integration of a plan from a state in all coordinates.
    ///
    /// # Errors
    /// If it cannot begin there.
    pub(super) fn run(&mut self, plan: &Plan, settings: Settings, state: &State) -> Result<Integration, Halt> {
        let begin = |system: &mut dyn System, state: &State| match &plan.integrator {
            Some(own) => {
                let scheme = own.scheme(system);
                Integration::with_scheme(system, scheme, settings, state)
            }
            None => Integration::new(system, settings, state),
        };
        match self {
            Self::Whole(system) => begin(&mut **system, state),
            Self::Minimal { system, bridging: true } => {
                let control = if let Control::Steps(_) = settings.control { Control::Tolerance(BRIDGE) } else { settings.control };
                Integration::new(system.inner_mut(), Settings { method: Method::Dop853, control, ..settings }, state)
            }
            Self::Minimal { system, .. } => {
                let start = system.reduced(state);
                begin(&mut **system, &start)
            }
        }
    }

    /// Whether a bridge begins where a run was stopped, or ends where it was not: another integration goes on from there.
    pub(super) fn turns(&mut self, state: &State, stopped: bool) -> bool {
        let Self::Minimal { system, bridging } = self else { return false };
        let turns = if *bridging { !stopped && system.enter(state) } else { stopped && system.is_singular() };
        *bridging ^= turns;
        turns
    }

    /// Whether a bridge is being made.
    pub(super) fn is_bridge(&self) -> bool {
        matches!(self, Self::Minimal { bridging: true, .. })
    }
}
