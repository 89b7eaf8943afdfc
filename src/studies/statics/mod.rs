//! Equilibrium: the study kind `statics`.
//!
//! `rest` is a mechanism that stands still, `pose` what is unbalanced there, `search` finds where it is in balance, `stability` judges
//! that, with `weak` where stiffness is small, `others` looks for further equilibria; `bench` has them all for mechanisms of few bodies;
//! `many` and `sinking` do it by sparse matrices for those of many. `explain` and `report` tell what was found. Which equilibrium is meant
//! by "from the start" is decided here:
//!
//! 1. A start that is in balance stays where it is, be it stable or not.
//! 2. Else the mechanism sinks from there as in a viscous bath. Where that ends exactly on a ridge, it is pushed off it, along the
//!    motion that falls fastest, and sinks on. From a change point it sinks along one of the branches that cross there (`singular`).
//! 3. If it does not come to rest, as where forces without an energy drive it round and round, Newton's method takes over, first
//!    from the start, then from places all over its motion.
//! 4. First-order states follow the position as far as they can. Where one that acts on a force does not rest there, as that of an
//!    integrating controller, position and states are brought to rest together (`states`).
//!
//! Drivers hold the position of time 0; nothing moves, so that damping does not act and motors have their torque at rest. A start that
//! exact friction holds is an equilibrium, with rows that hold what sticks (`grip`); smooth laws of friction do not act.

mod bench;
mod branch;
mod explain;
mod grain;
mod grip;
mod kinks;
mod many;
mod others;
mod pose;
mod report;
mod rest;
mod search;
mod singular;
mod sinking;
mod stability;
mod states;
mod weak;

use super::common::case::Case;
use super::common::watched::Watched;
use crate::dynamics::Differentiable;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::undefined::assembled;
use crate::mechanism::Coordinates;
use crate::results::Failure;
use crate::studies::common::indeterminate::open;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::stops::shared_by_contacts;
use bench::{Bench, Settled};
use grip::Gripped;
pub(crate) use many::equilibrium as equilibrium_of_many;
use others::number_of_places;
use pose::Pose;
use report::one_equilibrium;
use rest::Position;
pub(crate) use rest::Still;
use search::Found;
use singular::{of_equilibrium, of_start};

/// The equilibrium into which a mechanism falls from its assembled start, for a study of whatever kind.
///
/// # Errors
/// If there is none within reach: what stays unbalanced, on which coordinate.
pub(crate) fn equilibrium<G>(
    case: Case<'_>,
    mechanism: &Differentiable<G>,
    start: &Assembled,
    stop: &dyn Fn() -> bool,
) -> Result<Still, Failure>
where
    G: Space<S = f64>,
{
    if let Some(still) = many::equilibrium(case, mechanism, start, stop)? {
        return Ok(still);
    }
    let mut bench = Bench::new(case, mechanism, start, &[]);
    if let Some(Gripped { mechanism, live, pose, senses, open }) = bench.grip(start) {
        let mechanism = Differentiable::new(mechanism);
        let mut held = Bench::new(case, &mechanism, start, &[]);
        held.rest.hold(&live);
        let found = held.settle(&start.sliding(&mechanism, &senses), stop)?.found;
        let shared = held.shared(&mut bench, &found.pose);
        let shared = shared.into_iter().chain(shared_by_contacts(&mechanism, &open));
        let findings = held.findings(&found).into_iter().chain(bench.region(&pose)).chain(shared).collect();
        let Position { q, z, mut modes, .. } = found.pose.position;
        mechanism.slide(&vec![0; senses.len()], &mut modes);
        modes.truncate(start.modes.len());
        return Ok(Still { q, z, modes, findings });
    }
    let Settled { mut found, .. } = bench.settle(start, stop)?;
    found.stability.by_motion(&found.pose, mechanism, &start.metric);
    let findings = bench.findings(&found).into_iter().chain(of_start(mechanism, start, &found.pose.position.q)).collect();
    let Position { q, z, mut modes, .. } = found.pose.position;
    modes.truncate(start.modes.len());
    Ok(Still { q, z, modes, findings })
}

/// Runs a study of the kind `statics`.
///
/// # Errors
/// If it has no equilibrium.
pub(crate) fn run<G>(case: Case<'_>, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    if let Some(outcome) = many::run::<G>(case, stop)? {
        return Ok(outcome);
    }
    let (mechanism, start) = assembled::<G>(case.model, case.parameters, Coordinates::Joint)?;
    let mechanism = Differentiable::new(mechanism);
    let watched = Watched::of(case.study);
    let mut bench = Bench::new(case, &mechanism, &start, &watched.ids);
    if let Some(Gripped { mechanism, live, pose, senses, open: contacts }) = bench.grip(&start) {
        let mechanism = Differentiable::new(mechanism);
        let mut held = Bench::new(case, &mechanism, &start, &watched.ids);
        held.rest.hold(&live);
        held.held = Some(bench.partition(&pose).independent);
        let Settled { begin, found, .. } = held.settle(&start.sliding(&mechanism, &senses), stop)?;
        let shared = held.shared(&mut bench, &found.pose);
        let mut outcome = held.outcome(&watched, &begin, &[found])?;
        outcome.findings.extend(bench.region(&pose));
        outcome.findings.extend(shared);
        outcome.findings.extend(shared_by_contacts(&mechanism, &contacts));
        outcome.findings.extend(open(case, &watched, &mechanism, &start));
        return Ok(outcome);
    }
    let Settled { begin, found, passed } = bench.settle(&start, stop)?;
    let mut all = vec![found];
    all.extend(passed);
    let freedom = all[0].pose.basis.ncols();
    let alone = freedom > 0 && number_of_places(freedom) == 0;
    if all[0].stability.zero == 0 {
        let known: Vec<&Pose> = all.iter().map(|f| &f.pose).collect();
        let further = bench.rest.others(&all[0].pose, &begin, &known, stop).map_err(|_| Failure::interrupted())?;
        // what rests in the first must rest in all others
        let rests = bench.rest.rests(&all[0].pose.position);
        let mut also = |f: &Found| bench.rest.rests(&f.pose.position).iter().zip(&rests).all(|(here, first)| *here || !first);
        let resting: Vec<Found> = further.into_iter().filter(|f| also(f)).collect();
        all.extend(resting.into_iter().filter(|f| bench.rest.beyond(case, &f.pose.position).is_none()));
    }
    all.iter_mut().for_each(|found| found.stability.by_motion(&found.pose, &mechanism, &start.metric));
    let mut outcome = bench.outcome(&watched, &begin, &all)?;
    outcome.findings.extend(alone.then(|| one_equilibrium(case)));
    outcome.findings.extend(of_start(&mechanism, &start, &all[0].pose.position.q));
    outcome.findings.extend(of_equilibrium(&mechanism, &start, &all[0].pose.position, &case.study.place));
    outcome.findings.extend(open(case, &watched, &mechanism, &start));
    Ok(outcome)
}
