//! The equilibrium into which a mechanism of few bodies falls, and what is told of it.

use super::explain::{Names, place, six, undefined};
use super::grip::{self, Gripped};
use super::kinks::Leaving;
use super::pose::Pose;
use super::report::{Report, Told, not_stable, without_friction};
use super::rest::{Lost, Position, Rest};
use super::search::{Ended, Found};
use crate::dynamics::Differentiable;
use crate::expression::Id;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::partition::Partition;
use crate::results::{Failure, Finding};
use crate::studies::common::case::Case;
use crate::studies::common::observe::Observer;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::watched::Watched;
use crate::studies::dynamics::system::Mechanical;

/// A search without result: the pose where least is unbalanced, and why it ended.
type Failed = (Pose, Ended);

/// A mechanism on the bench: what is needed to find its equilibria and to tell them.
pub(super) struct Bench<'a, 'm, G: Space<S = f64>> {
    pub(super) case: Case<'a>,
    pub(super) rest: Rest<'m, G>,
    pub(super) names: Names,
    /// Coordinates that would be independent if friction held nothing.
    pub(super) held: Option<Vec<usize>>,
    /// Whether it moves away from the start without end, so that what is found elsewhere is not what it settles in.
    away: bool,
    /// Whether the way from the start leads across a change point.
    crossed: bool,
}

/// What a search from the start has come to.
pub(super) struct Settled {
    /// The start itself.
    pub(super) begin: Pose,
    pub(super) found: Found,
    /// The ridge on which the mechanism would stay by symmetry alone.
    pub(super) passed: Option<Found>,
}

impl<'a, 'm, G> Bench<'a, 'm, G>
where
    G: Space<S = f64>,
{
    pub(super) fn new(case: Case<'a>, mechanism: &'m Differentiable<G>, start: &Assembled, ids: &[Id]) -> Self {
        let observer = Observer::new(case.model, mechanism, case.parameters, ids);
        let system = Mechanical::new(mechanism, start, observer, Vec::new());
        Self {
            case,
            rest: Rest::new(system, start.size),
            names: Names::new(case.model, mechanism, &start.metric),
            held: None,
            away: false,
            crossed: false,
        }
    }

    /// Why the start, or what is next to it, cannot be evaluated.
    fn lost(&self, lost: Lost, start: &Assembled) -> Failure {
        let mechanism = self.rest.system.dynamics.mechanism;
        undefined(self.case, mechanism, start).unwrap_or_else(|| self.names.lost(lost, &self.case.study.place))
    }

    /// The equilibrium from the start.
    pub(super) fn settle(&mut self, start: &Assembled, stop: &dyn Fn() -> bool) -> Result<Settled, Failure> {
        let states = self.rest.system.dynamics.mechanism.state_starts.clone();
        let begin = match self.rest.at(&start.q, &states, &start.modes) {
            Ok(begin) => begin,
            Err(lost) => return Err(self.lost(lost, start)),
        };
        self.rest.crossed = false;
        let mut searched = self.search(&begin, start, stop);
        self.crossed = self.rest.crossed;
        // a state that keeps its value while the position is sought may not let it rest anywhere
        let near = match &searched {
            Ok((found, _)) => Some(&found.pose),
            Err(ended) if ended.1 == Ended::Stopped => None,
            Err(_) => Some(&begin),
        };
        let found = near.and_then(|near| self.rest.with_states(near)).and_then(|pose| self.rest.judged(pose).ok());
        if let Some(found) = found {
            searched = Ok((found, None));
        }
        match searched {
            Ok((found, passed)) => {
                let (model, place) = (self.case.model, &self.case.study.place);
                if let Some(joint) = self.rest.beyond(self.case, &found.pose.position) {
                    return Err(self.names.beyond(&model.joints[joint].name, place));
                }
                if let Some(clutch) = self.rest.back(&begin.position, &found.pose.position) {
                    return Err(self.names.locked(&self.rest.system.dynamics.mechanism.contacts[clutch].name, place));
                }
                Ok(Settled { begin, found, passed })
            }
            Err(ended) => match *ended {
                (_, Ended::Stopped) => Err(Failure::interrupted()),
                (_, Ended::Lost(lost)) => Err(self.lost(lost, start)),
                (best, why) => {
                    let partition = self.partition(&best);
                    let force = &partition.p.transpose() * &self.rest.net(&best);
                    let of = self.names.coordinates(&partition.independent);
                    Err(self.names.unbalanced(&of, force.as_slice(), self.rest.size, why, &self.case.study.place))
                }
            },
        }
    }

    /// The mechanism held by friction at its start.
    pub(super) fn grip(&mut self, start: &Assembled) -> Option<Gripped<G>> {
        let states = self.rest.system.dynamics.mechanism.state_starts.clone();
        let begin = self.rest.at(&start.q, &states, &start.modes).ok()?;
        grip::gripped(&mut self.rest, begin)
    }

    /// Where friction holds a mechanism of one degree of freedom around a pose.
    pub(super) fn region(&mut self, pose: &Pose) -> Option<Finding> {
        let independent = self.partition(pose).independent;
        let names: Vec<&str> = self.rest.system.dynamics.mechanism.contacts.iter().map(|c| c.name.as_str()).collect();
        let what = names.join(" and ");
        let ends = grip::region(&mut self.rest, pose)?;
        let at = |end: &Option<Pose>| {
            let values = end.as_ref().map(|end| self.values(&independent, pose, end));
            values.map(|values| place(self.case.model, &self.names.coordinates(&independent), &values))
        };
        let message = match [at(&ends[0]), at(&ends[1])] {
            [Some(low), Some(high)] => format!("{what}: it rests anywhere from {low} to {high}"),
            [Some(one), None] | [None, Some(one)] => format!("{what}: it rests anywhere beside {one}, on the side of the position found"),
            [None, None] => format!("{what}: it rests wherever it is put"),
        };
        Some(Finding { code: "held-by-friction".into(), message, path: self.case.study.place.clone() })
    }

    /// The equilibrium from the pose of a start, and the ridge before it; else the pose where least is unbalanced, and why.
    fn search(&mut self, begin: &Pose, start: &Assembled, stop: &dyn Fn() -> bool) -> Result<(Found, Option<Found>), Box<Failed>> {
        let at_begin = |why: Ended| Box::new((begin.clone(), why));
        if self.rest.is_balanced(begin).map_err(at_begin)? {
            let found = self.rest.polish(begin.clone()).and_then(|pose| self.rest.judged(pose));
            return Ok((found.map_err(at_begin)?, None));
        }
        let Position { z, modes, .. } = &begin.position;
        let beside = self.rest.along_a_branch(&begin.position, start).and_then(|q| self.rest.at(&q, z, modes).ok());
        let why = match self.rest.descend(beside.as_ref().unwrap_or(begin), stop) {
            Ok(found) if found.stability.negative > 0 => {
                return Ok(match self.pushed(&found, stop) {
                    Some(below) => (below, Some(found)),
                    None => (found, None),
                });
            }
            Ok(found) => return Ok((found, None)),
            Err(Ended::Stopped) => return Err(at_begin(Ended::Stopped)),
            Err(why) => why,
        };
        self.away = why == Ended::Away;
        match self.rest.newton(begin, stop).map_err(at_begin)? {
            Ok(found) => Ok((found, None)),
            Err(best) => match self.rest.anywhere(begin, stop).map_err(at_begin)? {
                Some(found) => Ok((found, None)),
                None => Err(Box::new((best, why))),
            },
        }
    }

    /// Where a mechanism falls to from a ridge.
    fn pushed(&mut self, ridge: &Found, stop: &dyn Fn() -> bool) -> Option<Found> {
        const PUSH: f64 = 0.02;
        const RIDGES: usize = 8;
        let mut on = ridge.clone();
        for _ in 0..RIDGES {
            let mut delta = &on.pose.basis * &on.stability.falls;
            // the largest part grows: the same for every order of the bodies' eigenvectors
            let largest = delta[delta.iamax()];
            delta *= PUSH * largest.signum() / self.rest.measure(&delta);
            delta *= self.rest.sense(&on.pose, delta.as_slice());
            let beside = self.rest.moved(&on.pose, delta.as_slice()).ok()?;
            on = self.rest.descend(&beside, stop).ok()?;
            if on.stability.negative == 0 {
                return Some(on);
            }
        }
        None
    }

    pub(super) fn partition(&mut self, pose: &Pose) -> Partition {
        self.rest.show(&pose.position);
        self.names.partition(&self.rest.system.dynamics, pose)
    }

    /// What a reader should know of an equilibrium.
    pub(super) fn findings(&mut self, found: &Found) -> Vec<Finding> {
        let (model, place) = (self.case.model, &self.case.study.place);
        let mut out = Vec::new();
        if !found.stability.is_stable() {
            out.push(not_stable(self.case, found.stability.negative > 0, &self.names.verdict(found, &self.rest.unit)));
        }
        let mut add = |code: &'static str, message: String, path: &str| out.push(Finding { code: code.into(), message, path: path.into() });
        if !found.stability.symmetric {
            let of = match found.stability.of_motion {
                true => "stability is that of the linearised motion",
                false => "stability is that of slow motion, and a flutter is seen by `modes` with `damped: true` alone",
            };
            add("no-energy", format!("the forces have no energy (the tangent stiffness is not symmetric): {of}"), place);
        }
        if self.away {
            let message = "the mechanism does not come to rest from its start, it moves away without end: what is given is an equilibrium that \
                           Newton's method finds elsewhere, into which it does not fall; start nearer to the one that is meant, or give what \
                           moves away a stop (`limits`)";
            add("does-not-settle", message.into(), place);
        }
        if self.crossed {
            let message = "the way from the start leads across a change point, where branches of the motion cross: what is given lies straight on; \
                           others may be found from a start beyond that point";
            add("crosses-change-point", message.into(), place);
        }
        let rests = self.rest.rests(&found.pose.position);
        for ((state, rate), _) in model.states.iter().zip(&found.pose.position.drift).zip(rests).filter(|(_, rests)| !rests) {
            add("state-without-rest", format!("the state `{}` does not come to rest, its rate is {}", state.name, six(*rate)), "states");
        }
        if self.rest.system.dynamics.mechanism.held().next().is_some() {
            return out;
        }
        match self.region(&found.pose) {
            Some(region) => out.push(region),
            None => out.extend(without_friction(self.case)),
        }
        out
    }

    /// Stops that joints touch where friction holds them, as it does not in `free`: nothing tells how they share what presses on both.
    pub(super) fn shared(&mut self, free: &mut Self, pose: &Pose) -> Vec<Finding> {
        let [held, else_held] = [&mut *self, free].map(|bench| {
            let state = bench.rest.state(&pose.position);
            bench.rest.system.held_on_stops(&state)
        });
        let model = self.case.model;
        let mechanism = self.rest.system.dynamics.mechanism;
        let shared = held.into_iter().filter(|stop| !else_held.contains(stop));
        let finding = |stop: usize| {
            let stop = &mechanism.stops[stop];
            let joint = &model.joints[stop.joint];
            Finding {
                code: "friction-not-unique".into(),
                message: format!(
                    "joint `{}` touches its {} where friction holds it: how they share what presses on both is not determined; what is printed is that the friction alone holds it",
                    joint.name,
                    stop.word()
                ),
                path: joint.place.clone(),
            }
        };
        shared.map(finding).collect()
    }

    /// Values of the independent coordinates; parts of a quaternion as the turn from the begin, rad.
    fn values(&self, independent: &[usize], begin: &Pose, pose: &Pose) -> Vec<f64> {
        let turned = self.rest.turned(&begin.position, &pose.position);
        independent.iter().map(|&k| self.names.q[k].map_or(turned[k], |q| pose.position.q[q])).collect()
    }

    /// All that a study leaves; `all` begins with the equilibrium from the start.
    pub(super) fn outcome(&mut self, watched: &Watched, begin: &Pose, all: &[Found]) -> Result<Outcome, Failure> {
        let independent = self.held.clone().unwrap_or_else(|| self.partition(&all[0].pose).independent);
        let told: Vec<Told> = all
            .iter()
            .map(|found| Told {
                position: found.pose.position.clone(),
                values: self.values(&independent, begin, &found.pose),
                stable: found.stability.is_stable(),
                verdict: self.names.verdict(found, &self.rest.unit),
            })
            .collect();
        let further = self.findings(&all[0]).into_iter().filter(|f| !["unstable", "indifferent"].contains(&&*f.code)).collect();
        let coordinates = self.names.coordinates(&independent);
        let report = Report { case: self.case, rest: &mut self.rest, coordinates, by_friction: self.held.is_some() };
        report.outcome(watched, &begin.position, &told, further)
    }
}
