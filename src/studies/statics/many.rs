//! The equilibrium into which a mechanism of many bodies falls, by sparse matrices on the tree on which these are.
//!
//! It is the one that `bench` finds for few bodies: a start that is in balance stays, else the mechanism sinks, and is pushed off ridges.
//! Newton's method from places all over the motion, and further equilibria, are not tried.

use super::explain::{Names, undefined, verdict};
use super::kinks::{Leaving, Side, decisive};
use super::report::{Report, Told, not_stable, one_equilibrium, without_friction};
use super::rest::{Lost, Position, Rest, Still};
use super::search::Ended;
use super::singular::{of_equilibrium, of_start};
use super::sinking::{Sinking, Stand, of_metric};
use crate::dynamics::Differentiable;
use crate::expression::Id;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::bounded::assembled_for_gauges;
use crate::kinematics::coordinates::Coordinate;
use crate::kinematics::held;
use crate::kinematics::lowest::{Lowest, lowest};
use crate::kinematics::pair::Pair;
use crate::kinematics::pencil::{HeldSparse, POTENTIAL, Way};
use crate::kinematics::undefined::not_finite;
use crate::mechanism::Mechanism;
use crate::results::{Failure, Finding};
use crate::studies::common::case::Case;
use crate::studies::common::indeterminate::open;
use crate::studies::common::observe::Observer;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::sides::weights;
use crate::studies::common::watched::Watched;
use crate::studies::dynamics::system::Mechanical;

/// Bodies from which on equilibria are found by sparse matrices.
const MANY: usize = 100;
/// Part of the stiffness below which an eigenvalue counts as zero, unless forces follow it (`weak.rs`). A row of n bodies has eigenvalues
/// from 1 to about 1/n² of the largest, a truss to 1/n⁴.
const ZERO: f64 = 1e-10;
/// Most motions of which that is asked.
const WEAK: usize = 32;
/// Part of the damping below which its eigenvalues are round-off.
const RESISTS: f64 = 1e-9;
/// By how much a mechanism is pushed off a ridge, rad or sizes, and how often.
const PUSH: f64 = 0.02;
const RIDGES: usize = 8;

/// Runs a study of the kind `statics`; none if the mechanism has few bodies, or what only full matrices know: states, exact friction,
/// friction by reactions, forces without a potential, dampers that drive.
///
/// # Errors
/// If it has no equilibrium.
pub(super) fn run<G>(case: Case<'_>, stop: &dyn Fn() -> bool) -> Result<Option<Outcome>, Failure>
where
    G: Space<S = f64>,
{
    if case.model.bodies.len() <= MANY {
        return Ok(None);
    }
    let (mut mechanism, start) = assembled_for_gauges::<G>(case.model, case.parameters)?;
    if !suits(&mechanism) {
        return Ok(None);
    }
    // independent coordinates are read by gauges that no force needs
    mechanism.active_gauges = mechanism.gauges.len();
    let mechanism = Differentiable::new(mechanism);
    let watched = Watched::of(case.study);
    let mut many = Many::new(case, &mechanism, &start, &watched.ids);
    let Some(settled) = many.settle(&start, stop)? else { return Ok(None) };
    let mut outcome = many.outcome(&watched, &settled)?;
    outcome.findings.extend(open(case, &watched, &mechanism, &start));
    let position = &settled.found.stand.position;
    outcome.findings.extend(of_start(&mechanism, &start, &position.q));
    outcome.findings.extend(of_equilibrium(&mechanism, &start, position, &case.study.place));
    Ok(Some(outcome))
}

/// The equilibrium of a mechanism from its start, for a study of another kind; none as of [`run`].
///
/// # Errors
/// If it has no equilibrium.
pub(crate) fn equilibrium<G>(
    case: Case<'_>,
    mechanism: &Differentiable<G>,
    start: &Assembled,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Still>, Failure>
where
    G: Space<S = f64>,
{
    if case.model.bodies.len() <= MANY || !suits(mechanism) {
        return Ok(None);
    }
    let mut many = Many::new(case, mechanism, start, &[]);
    let Some(Settled { found, .. }) = many.settle(start, stop)? else { return Ok(None) };
    let mut findings = Vec::new();
    if found.negative + found.zero > 0 {
        findings.push(not_stable(case, found.negative > 0, &many.verdict(&found)));
    }
    findings.extend(without_friction(case));
    findings.extend(of_start(mechanism, start, &found.stand.position.q));
    let Position { q, z, mut modes, .. } = found.stand.position;
    modes.truncate(start.modes.len());
    Ok(Some(Still { q, z, modes, findings }))
}

/// Whether a mechanism has nothing that only full matrices know.
fn suits<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> bool {
    mechanism.state_starts.is_empty() && mechanism.contacts.is_empty() && mechanism.pressings.is_empty()
}

/// An equilibrium.
struct Found {
    stand: Stand,
    held: HeldSparse,
    /// Motions that fall, and those that nothing holds.
    negative: usize,
    zero: usize,
    /// The motion that falls most, or is held least (nv); of a stable one none.
    falls: Vec<f64>,
}

/// What a search from the start has come to.
struct Settled {
    begin: Position,
    found: Found,
    /// The ridge on which the mechanism would stay by symmetry alone.
    passed: Option<Found>,
}

/// A mechanism of many bodies, and what is needed to tell its equilibria.
struct Many<'a, 'm, G: Space<S = f64>> {
    case: Case<'a>,
    sinking: Sinking<'m, G>,
    names: Names,
    /// Number of its own modes: rigid stops and events have more of them.
    modes: usize,
}

impl<'a, 'm, G> Many<'a, 'm, G>
where
    G: Space<S = f64>,
{
    fn new(case: Case<'a>, mechanism: &'m Differentiable<G>, start: &Assembled, ids: &[Id]) -> Self {
        let observer = Observer::new(case.model, mechanism, case.parameters, ids);
        let rest = Rest::new(Mechanical::new(mechanism, start, observer, Vec::new()), start.size);
        let names = Names::new(case.model, mechanism, &start.metric);
        let turns = names.all.iter().map(|c| c.turns).collect();
        Self { case, sinking: Sinking::new(rest, &start.q, &start.modes, turns), names, modes: start.modes.len() }
    }

    /// Why the start, or what is next to it, cannot be evaluated.
    fn lost(&self, lost: Lost, start: &Assembled) -> Failure {
        let mechanism = self.sinking.rest.system.dynamics.mechanism;
        undefined(self.case, mechanism, start).unwrap_or_else(|| self.names.lost(lost, &self.case.study.place))
    }

    /// The equilibrium from the start; none if full matrices must be used.
    fn settle(&mut self, start: &Assembled, stop: &dyn Fn() -> bool) -> Result<Option<Settled>, Failure> {
        let begin = match self.sinking.at(&start.q, &start.modes) {
            Ok(begin) => begin,
            Err(lost) => return Err(self.lost(lost, start)),
        };
        let held = self.held(&begin)?;
        if held.pencil.circulation() > POTENTIAL {
            return Ok(None);
        }
        let (found, passed) = match self.search(&begin, start, stop)? {
            Ok(both) => both,
            Err(Ended::Stopped) => return Err(Failure::interrupted()),
            Err(Ended::Lost(lost)) => return Err(self.lost(lost, start)),
            Err(why) => {
                let of: Vec<Coordinate> = held.independent.iter().map(|(coordinate, _)| coordinate.clone()).collect();
                return Err(self.names.unbalanced(&of, &held.unbalanced, self.sinking.rest.size, why, &self.case.study.place));
            }
        };
        if found.held.pencil.circulation() > POTENTIAL || self.drives(&found.stand) {
            return Ok(None);
        }
        if let Some(joint) = self.sinking.rest.beyond(self.case, &found.stand.position) {
            return Err(self.names.beyond(&self.case.model.joints[joint].name, &self.case.study.place));
        }
        Ok(Some(Settled { begin: begin.position, found, passed }))
    }

    /// The equilibrium from the stand of a start, and the ridge before it.
    fn search(
        &mut self,
        begin: &Stand,
        start: &Assembled,
        stop: &dyn Fn() -> bool,
    ) -> Result<Result<(Found, Option<Found>), Ended>, Failure> {
        let ended = self.sinking.settled(begin, start, stop);
        let (stand, stays) = match ended {
            Ok(both) => both,
            Err(why) => return Ok(Err(why)),
        };
        let found = self.judged(stand, stop)?;
        if stays || found.negative == 0 {
            return Ok(Ok((found, None)));
        }
        Ok(Ok(match self.pushed(&found, stop)? {
            Some(below) => (below, Some(found)),
            None => (found, None),
        }))
    }

    /// Where the mechanism falls to from a ridge.
    fn pushed(&mut self, ridge: &Found, stop: &dyn Fn() -> bool) -> Result<Option<Found>, Failure> {
        let (mut stand, mut falls) = (ridge.stand.clone(), ridge.falls.clone());
        for _ in 0..RIDGES {
            // the largest part grows, as of full matrices
            let largest = falls.iter().fold(0.0, |m: f64, x| if x.abs() > m.abs() { *x } else { m });
            let scale = PUSH * largest.signum() / self.sinking.measure(&falls);
            let mut delta: Vec<f64> = falls.iter().map(|x| x * scale).collect();
            let sense = self.sinking.sense(&stand, &delta);
            delta.iter_mut().for_each(|x| *x *= sense);
            let below = self.sinking.moved(&stand, &delta).map_err(Ended::from).and_then(|beside| self.sinking.descend(&beside, stop));
            let Ok(below) = below else { return Ok(None) };
            let found = self.judged(below, stop)?;
            if found.negative == 0 {
                return Ok(Some(found));
            }
            (stand, falls) = (found.stand, found.falls);
        }
        Ok(None)
    }

    /// A stand with its stability; in a kink by its decisive side.
    fn judged(&mut self, stand: Stand, stop: &dyn Fn() -> bool) -> Result<Found, Failure> {
        let mut all = vec![self.judged_by_its_side(stand, stop)?];
        let unit = self.sinking.rest.unit.clone();
        let motions = weights(unit.len()).map(|y| y.iter().zip(&unit).map(|(y, unit)| y * unit).collect());
        for modes in self.sinking.other_sides(&all[0].stand, motions) {
            let mut stand = all[0].stand.clone();
            stand.position.modes = modes;
            all.push(self.judged_by_its_side(stand, stop)?);
        }
        if all.len() == 1 {
            return Ok(all.remove(0));
        }
        let of = |found: &Found| {
            let is_entered = !found.falls.is_empty() && self.sinking.enters(&found.stand, &found.falls);
            Side { negative: found.negative, zero: found.zero, is_entered }
        };
        let chosen = decisive(&all.iter().map(of).collect::<Vec<_>>());
        Ok(all.swap_remove(chosen))
    }

    /// A stand with its stability by its modes.
    fn judged_by_its_side(&mut self, stand: Stand, stop: &dyn Fn() -> bool) -> Result<Found, Failure> {
        let held = self.held(&stand)?;
        let stiff = &held.pencil;
        let mut pencil = of_metric(stiff.stiffness.clone(), stiff.rows.clone(), &stiff.metric, &stiff.row_scale);
        pencil.freedom = stiff.freedom;
        let pair = Pair::new(&pencil);
        let size = pair.size.max(stand.stiffness);
        let below = |part: f64| pair.below(part * size).unwrap_or(0);
        let mut negative = below(-ZERO);
        let mut zero = below(ZERO).saturating_sub(negative);
        let mut falls = Vec::new();
        if negative + zero > 0 {
            let asked = zero > 0 && negative + zero <= WEAK;
            let wanted = if asked { negative + zero } else { 1 };
            let Lowest { values, mut vectors, .. } = lowest(&pencil, wanted, stop).unwrap_or_default();
            let weak = (negative..values.len()).take(if asked { zero } else { 0 });
            let followed: Vec<usize> = weak.filter(|&i| self.sinking.is_followed(&stand, values[i], &vectors[i])).collect();
            zero -= followed.len();
            negative += followed.iter().filter(|&&i| values[i] < 0.0).count();
            // the lowest one that falls, or the first that nothing holds
            let shown = (0..vectors.len()).find(|i| negative > 0 || !followed.contains(i));
            falls = shown.map(|i| vectors.swap_remove(i)).unwrap_or_default();
        }
        if stop() {
            return Err(Failure::interrupted());
        }
        Ok(Found { stand, negative, zero, falls, held })
    }

    /// The linear motion about a stand.
    fn held(&self, stand: &Stand) -> Result<HeldSparse, Failure> {
        let Position { q, z, modes, .. } = &stand.position;
        let pose = held::Pose { q, z, modes: &modes[..self.modes] };
        let mechanism = self.sinking.rest.system.dynamics.mechanism;
        HeldSparse::new(self.case.model, mechanism, pose, &self.sinking.metric).map_err(|_| not_finite(self.case.model, mechanism, pose))
    }

    /// Whether some damper drives: the stiffness alone then does not tell what is stable.
    fn drives(&mut self, stand: &Stand) -> bool {
        let Ok(pencil) = self.sinking.pencil(stand) else { return true };
        let damping = of_metric(self.sinking.rest.tangent.c.clone(), pencil.rows, &pencil.metric, &pencil.row_scale);
        let pair = Pair::new(&damping);
        pair.below(-RESISTS * pair.size) != Some(0)
    }

    /// `stable`, or what falls, or what is not held.
    fn verdict(&self, found: &Found) -> String {
        let way = |c: &Coordinate| if c.turns { 1.0 } else { self.sinking.rest.size };
        let motion = |(c, line): &(Coordinate, Vec<(usize, f64)>)| {
            line.iter().map(|(j, s)| s * found.falls.get(*j).copied().unwrap_or(0.0)).sum::<f64>().abs() / way(c)
        };
        let of = &found.held.independent;
        // of equal ones the first
        let most = (0..of.len()).fold(0, |best, k| if motion(&of[k]) > motion(&of[best]) * (1.0 + 1e-9) { k } else { best });
        verdict(found.negative, found.zero, of.get(most).map_or("", |(c, _)| &c.name))
    }

    /// Values of the independent coordinates of an equilibrium at a position; parts of a quaternion as the turn from `begin`, rad.
    fn values(&mut self, held: &HeldSparse, begin: &Position, position: &Position) -> Vec<f64> {
        let rest = &mut self.sinking.rest;
        rest.show(position);
        let turned = rest.turned(begin, position);
        let value = |way: &Way| match *way {
            Way::Column(v) => self.names.q[v].map_or(turned[v], |q| position.q[q]),
            Way::Gauge(gauge) => rest.system.dynamics.work.readings[gauge].x,
        };
        held.ways.iter().map(value).collect()
    }

    /// All that a study leaves.
    fn outcome(&mut self, watched: &Watched, settled: &Settled) -> Result<Outcome, Failure> {
        let Settled { begin, found, passed } = settled;
        let all: Vec<Told> = [Some(found), passed.as_ref()]
            .into_iter()
            .flatten()
            .map(|one| Told {
                position: one.stand.position.clone(),
                values: self.values(&found.held, begin, &one.stand.position),
                stable: one.negative + one.zero == 0,
                verdict: self.verdict(one),
            })
            .collect();
        let mut findings: Vec<Finding> = without_friction(self.case).collect();
        findings.push(one_equilibrium(self.case));
        let coordinates = found.held.independent.iter().map(|(coordinate, _)| coordinate.clone()).collect();
        let report = Report { case: self.case, rest: &mut self.sinking.rest, coordinates, by_friction: false };
        report.outcome(watched, begin, &all, findings)
    }
}
