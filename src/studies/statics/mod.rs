//! Equilibrium: the study kind `statics`.
//!
//! `pose` evaluates a mechanism at rest, `search` finds where it is in balance, `stability` judges that, `others` looks for further
//! equilibria, `words` tells them. Which equilibrium is meant by "from the start" is decided here:
//!
//! 1. A start that is in balance stays where it is, be it stable or not.
//! 2. Else the mechanism sinks from there as in a viscous bath. Where that ends exactly on a ridge, it is pushed off it, along the
//!    motion that falls fastest, and sinks on.
//! 3. If it does not come to rest, as where forces without an energy drive it round and round, Newton's method takes over, first
//!    from the start, then from places all over its motion.
//!
//! Drivers hold the position of time 0; nothing moves, so that damping does not act and motors have their torque at rest. A start that
//! exact friction holds is an equilibrium, with rows that hold what sticks (`grip`); smooth laws of friction do not act.

mod explain;
mod grip;
mod others;
mod pose;
mod search;
mod stability;

use super::common::case::Case;
use super::common::numbers::Sources;
use super::common::observe::Observer;
use super::common::scene::{MECHANISM, Subject};
use super::common::watched::Watched;
use super::dynamics::system::Mechanical;
use crate::dynamics::LANES;
use crate::expression::Id;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::held::settled;
use crate::kinematics::undefined::{assembled, in_state};
use crate::mechanism::{Coordinates, Mechanism};
use crate::model::FunctionalKind;
use crate::numerics::extremum::{Extremes, Extremum};
use crate::results::{Certificate, Failure, Finding, List, Rows, Scene};
use crate::scalar::Dual;
use crate::studies::common::outcome::Outcome;
use explain::{Names, six};
use grip::Gripped;
use pose::{Pose, Rest};
use search::{Ended, Found};

/// A mechanism that stands still at time 0, by itself (Φ(q) = 0 and Gᵀλ = f(q, v = 0, z)) or held.
#[derive(Clone, Debug)]
pub(crate) struct Still {
    /// Coordinates (nq).
    pub(crate) q: Vec<f64>,
    /// First-order states (nz).
    pub(crate) z: Vec<f64>,
    /// Modes of the switches and windings there.
    pub(crate) modes: Vec<i32>,
    /// What a reader should know of it.
    pub(crate) findings: Vec<Finding>,
}

/// The equilibrium into which a mechanism falls from its assembled start, for a study of whatever kind; `lifted` is the same
/// mechanism on dual numbers.
///
/// # Errors
/// If there is none within reach: what stays unbalanced, on which coordinate.
pub(crate) fn equilibrium<G>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    lifted: &Mechanism<G::Lift<Dual<LANES>>>,
    start: &Assembled,
    stop: &dyn Fn() -> bool,
) -> Result<Still, Failure>
where
    G: Space<S = f64>,
    G::Lift<Dual<LANES>>: Space<S = Dual<LANES>>,
{
    let mut bench = Bench::new(case, mechanism, lifted, start, &[]);
    if let Some(Gripped { mechanism, live, pose }) = bench.grip(start) {
        let lifted = mechanism.lift();
        let mut held = Bench::new(case, &mechanism, &lifted, start, &[]);
        held.rest.hold(&live);
        let found = held.settle(start, stop)?.found;
        let findings = held.findings(&found).into_iter().chain(bench.region(&pose)).collect();
        let Pose { q, z, mut modes, .. } = found.pose;
        modes.truncate(start.modes.len());
        return Ok(Still { q, z, modes, findings });
    }
    let Settled { mut found, .. } = bench.settle(start, stop)?;
    found.stability.by_motion(&found.pose, mechanism, lifted, &start.metric);
    let findings = bench.findings(&found);
    let Pose { q, z, mut modes, .. } = found.pose;
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
    G::Lift<Dual<LANES>>: Space<S = Dual<LANES>>,
{
    let (mechanism, start) = assembled::<G>(case.model, case.parameters, Coordinates::Joint)?;
    let lifted = mechanism.lift();
    let watched = Watched::of(case.study);
    let mut bench = Bench::new(case, &mechanism, &lifted, &start, &watched.ids);
    if let Some(Gripped { mechanism, live, pose }) = bench.grip(&start) {
        let lifted = mechanism.lift();
        let mut held = Bench::new(case, &mechanism, &lifted, &start, &watched.ids);
        held.rest.hold(&live);
        held.held = Some(bench.partition(&pose).independent);
        let Settled { begin, found, .. } = held.settle(&start, stop)?;
        let mut outcome = held.outcome(&watched, &begin, &[found])?;
        outcome.findings.extend(bench.region(&pose));
        return Ok(outcome);
    }
    let Settled { begin, found, passed } = bench.settle(&start, stop)?;
    let mut all = vec![found];
    all.extend(passed);
    if all[0].stability.zero == 0 {
        let known: Vec<&Pose> = all.iter().map(|f| &f.pose).collect();
        let further = bench.rest.others(&all[0].pose, &begin, &known, stop).map_err(|_| interrupted())?;
        all.extend(further.into_iter().filter(|f| bench.beyond(&f.pose).is_none()));
    }
    all.iter_mut().for_each(|found| found.stability.by_motion(&found.pose, &mechanism, &lifted, &start.metric));
    bench.outcome(&watched, &begin, &all)
}

/// A search without result: the pose where least is unbalanced, and why it ended.
type Failed = (Pose, Ended);

/// A mechanism on the bench: what is needed to find its equilibria and to tell them.
struct Bench<'a, 'm, G: Space<S = f64>> {
    case: Case<'a>,
    rest: Rest<'m, G, G::Lift<Dual<LANES>>>,
    names: Names,
    /// Coordinates that would be independent if friction held nothing.
    held: Option<Vec<usize>>,
}

/// What a search from the start has come to.
struct Settled {
    /// The start itself.
    begin: Pose,
    found: Found,
    /// The ridge on which the mechanism would stay by symmetry alone.
    passed: Option<Found>,
}

impl<'a, 'm, G> Bench<'a, 'm, G>
where
    G: Space<S = f64>,
    G::Lift<Dual<LANES>>: Space<S = Dual<LANES>>,
{
    fn new(
        case: Case<'a>,
        mechanism: &'m Mechanism<G>,
        lifted: &'m Mechanism<G::Lift<Dual<LANES>>>,
        start: &Assembled,
        ids: &[Id],
    ) -> Self {
        let observer = Observer::new(case.model, mechanism, case.parameters, ids);
        let system = Mechanical::new(mechanism, lifted, start, observer, Vec::new());
        Self { case, rest: Rest::new(system, start.size), names: Names::new(case.model, mechanism, &start.metric), held: None }
    }

    /// The equilibrium from the start.
    fn settle(&mut self, start: &Assembled, stop: &dyn Fn() -> bool) -> Result<Settled, Failure> {
        let states = self.rest.system.dynamics.mechanism.state_starts.clone();
        let begin = match self.rest.at(&start.q, &states, &start.modes) {
            Ok(begin) => begin,
            Err(lost) => {
                let rest = vec![0.0; start.v.len()];
                let mechanism = self.rest.system.dynamics.mechanism;
                let modes = settled(mechanism, [&start.q, &rest, &states], &start.modes);
                let undefined = in_state(self.case.model, mechanism, [&start.q, &rest, &states], &modes, "the start");
                return Err(undefined.map_or_else(|| self.names.lost(lost, &self.case.study.place), Failure::Undefined));
            }
        };
        match self.search(&begin, stop) {
            Ok((found, passed)) => match self.beyond(&found.pose) {
                Some(joint) => Err(self.names.beyond(&self.case.model.joints[joint].name, &self.case.study.place)),
                None => Ok(Settled { begin, found, passed }),
            },
            Err(ended) => match *ended {
                (_, Ended::Stopped) => Err(interrupted()),
                (_, Ended::Lost(lost)) => Err(self.names.lost(lost, &self.case.study.place)),
                (best, why) => {
                    let partition = self.partition(&best);
                    let force = &partition.p.transpose() * &self.rest.net(&best);
                    Err(self.names.unbalanced(&partition.independent, &force, &self.rest.unit, why, &self.case.study.place))
                }
            },
        }
    }

    /// The mechanism held by friction at its start.
    fn grip(&mut self, start: &Assembled) -> Option<Gripped<G>> {
        let states = self.rest.system.dynamics.mechanism.state_starts.clone();
        let begin = self.rest.at(&start.q, &states, &start.modes).ok()?;
        grip::gripped(&mut self.rest, begin)
    }

    /// Where friction holds a mechanism of one degree of freedom around a pose.
    fn region(&mut self, pose: &Pose) -> Option<Finding> {
        let independent = self.partition(pose).independent;
        let names: Vec<&str> = self.rest.system.dynamics.mechanism.contacts.iter().map(|c| c.name.as_str()).collect();
        let what = names.join(" and ");
        let ends = grip::region(&mut self.rest, pose)?;
        let at = |end: &Option<Pose>| {
            let values = end.as_ref().map(|end| self.values(&independent, pose, end));
            values.map(|values| self.names.place(&independent, &values))
        };
        let message = match [at(&ends[0]), at(&ends[1])] {
            [Some(low), Some(high)] => format!("{what}: it rests anywhere from {low} to {high}"),
            [Some(one), None] | [None, Some(one)] => format!("{what}: it rests anywhere beside {one}, on the side of the position found"),
            [None, None] => format!("{what}: it rests wherever it is put"),
        };
        Some(Finding { code: "held-by-friction".into(), message, path: self.case.study.place.clone() })
    }

    /// The equilibrium from a pose, and the ridge before it; else the pose where least is unbalanced, and why.
    fn search(&mut self, begin: &Pose, stop: &dyn Fn() -> bool) -> Result<(Found, Option<Found>), Box<Failed>> {
        let at_begin = |why: Ended| Box::new((begin.clone(), why));
        if self.rest.is_balanced(begin).map_err(at_begin)? {
            let found = self.rest.polish(begin.clone()).and_then(|pose| self.rest.judged(pose));
            return Ok((found.map_err(at_begin)?, None));
        }
        let why = match self.rest.descend(begin, stop) {
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
            let beside = self.rest.moved(&on.pose, delta.as_slice()).ok()?;
            on = self.rest.descend(&beside, stop).ok()?;
            if on.stability.negative == 0 {
                return Some(on);
            }
        }
        None
    }

    /// A joint that lies beyond one of its rigid stops, of which the search knows nothing.
    fn beyond(&mut self, pose: &Pose) -> Option<usize> {
        self.rest.show(pose);
        let d = &self.rest.system.dynamics;
        let value = |id: Option<Id>, none: f64| id.map_or(none, |id| self.case.value(id));
        self.case.model.joints.iter().zip(&d.mechanism.joints).position(|(joint, of)| {
            let (Some(stops), Some(&gauge)) = (&joint.stops, of.slots.first()) else { return false };
            let x = d.work.readings[gauge].x;
            let slack = 1e-9 * (1.0 + x.abs());
            x < value(stops.from, f64::NEG_INFINITY) - slack || x > value(stops.to, f64::INFINITY) + slack
        })
    }

    fn partition(&mut self, pose: &Pose) -> crate::kinematics::partition::Partition {
        self.rest.show(pose);
        self.names.partition(&self.rest.system.dynamics, pose)
    }

    /// What a reader should know of an equilibrium.
    fn findings(&mut self, found: &Found) -> Vec<Finding> {
        let (model, place) = (self.case.model, &self.case.study.place);
        let mut out = Vec::new();
        let mut add = |code: &'static str, message: String, path: &str| out.push(Finding { code: code.into(), message, path: path.into() });
        if !found.stability.is_stable() {
            let code = if found.stability.negative > 0 { "unstable" } else { "indifferent" };
            add(code, format!("the equilibrium is {}", self.names.verdict(found, &self.rest.unit)), place);
        }
        if !found.stability.symmetric {
            let of = match found.stability.of_motion {
                true => "stability is that of the linearised motion",
                false => "stability is that of slow motion, and a flutter is seen by `modes` with `damped: true` alone",
            };
            add("no-energy", format!("the forces have no energy (the tangent stiffness is not symmetric): {of}"), place);
        }
        for (state, rate) in model.states.iter().zip(&found.pose.drift).filter(|(_, rate)| rate.abs() > 1e-9) {
            add("state-without-rest", format!("the state `{}` does not come to rest, its rate is {}", state.name, six(*rate)), "states");
        }
        if self.rest.system.dynamics.mechanism.held().next().is_some() {
            return out;
        }
        if let Some(region) = self.region(&found.pose) {
            out.push(region);
            return out;
        }
        let held = |joint: usize| model.drivers.iter().any(|d| d.joint == joint);
        for (_, joint) in model.joints.iter().enumerate().filter(|(i, j)| j.friction.is_some() && !held(*i)) {
            let message =
                format!("the friction of joint `{}` holds nothing here: with it the mechanism also rests beside this position", joint.name);
            out.push(Finding { code: "friction".into(), message, path: format!("joints.{}.friction", joint.name) });
        }
        out
    }

    /// Values of the independent coordinates; parts of a quaternion as the turn from the begin, rad.
    fn values(&self, independent: &[usize], begin: &Pose, pose: &Pose) -> Vec<f64> {
        let turned = self.rest.turned(begin, pose);
        independent.iter().map(|&k| self.names.q[k].map_or(turned[k], |q| pose.q[q])).collect()
    }

    /// All that a study leaves; `all` begins with the equilibrium from the start.
    fn outcome(&mut self, watched: &Watched, begin: &Pose, all: &[Found]) -> Result<Outcome, Failure> {
        let case = self.case;
        let study = case.study;
        let pose = &all[0].pose;
        let independent = self.held.clone().unwrap_or_else(|| self.partition(pose).independent);
        let stable = |f: &Found| if f.stability.is_stable() { 1.0 } else { 0.0 };
        let places: Vec<Vec<f64>> = all.iter().map(|f| self.values(&independent, begin, &f.pose)).collect();
        let mut lists: Vec<List> = (independent.iter().enumerate())
            .map(|(i, &k)| {
                let unit = if self.names.all[k].turns { "rad" } else { "m" };
                List {
                    name: format!("equilibria.{}", self.names.all[k].name),
                    unit: unit.into(),
                    values: places.iter().map(|p| p[i]).collect(),
                }
            })
            .collect();
        lists.push(List { name: "equilibria.stable".into(), unit: String::new(), values: all.iter().map(stable).collect() });
        let mut findings: Vec<Finding> = Vec::new();
        for (i, (found, values)) in all.iter().zip(&places).enumerate() {
            let code = if i == 0 { "equilibrium" } else { "further-equilibrium" };
            let place = self.names.place(&independent, values) + if self.held.is_some() { ", held by friction" } else { "" };
            let message = format!("{place}: {}", self.names.verdict(found, &self.rest.unit));
            findings.push(Finding { code: code.into(), message, path: study.place.clone() });
        }
        findings.extend(self.findings(&all[0]).into_iter().filter(|f| !["unstable", "indifferent"].contains(&&*f.code)));

        let scenes = self.scenes(begin, all);
        let row = self.row(pose, watched.ids.len())?;
        let functionals: Vec<f64> = (study.functionals.iter().zip(&watched.functionals))
            .map(|(f, &c)| match f.kind {
                FunctionalKind::Integral => 0.0,
                FunctionalKind::First => {
                    if row[c] != 0.0 && !row[c].is_nan() {
                        0.0
                    } else {
                        f64::NAN
                    }
                }
                FunctionalKind::Value if f.at.is_some_and(|id| case.value(id) != 0.0) => f64::NAN,
                _ => row[c],
            })
            .collect();
        let results = vec![stable(&all[0])];
        let tables = &self.rest.system.dynamics.mechanism.tables;
        let numbers = Sources { case, tables, functionals: &functionals, results: &results, works: &[] }.numbers(true);
        findings.extend(numbers.findings);
        let alone = |value: f64| Extremum { value, at: 0.0, piece: 0 };
        let mut shown = Rows::new(watched.columns.len() + watched.shown.len());
        shown.push(watched.columns.iter().chain(&watched.shown).map(|&c| row[c]));
        Ok(Outcome {
            parameters: case.named(),
            independent: "time".into(),
            places: vec![0.0],
            rows: shown,
            lists,
            stopped: numbers.undefined.as_ref().map(|u| u.message.clone()),
            undefined: numbers.undefined,
            scalars: numbers.scalars,
            extremes: watched
                .columns
                .iter()
                .map(|&c| (!row[c].is_nan()).then(|| Extremes { min: alone(row[c]), max: alone(row[c]) }))
                .collect(),
            expectations: numbers.expectations,
            results,
            findings,
            certificate: Certificate { evaluations: 1, constraint: self.rest.open(pose), ..Certificate::default() },
            scenes,
            ..Outcome::default()
        })
    }

    /// All outputs of the observer at a pose.
    fn row(&mut self, pose: &Pose, count: usize) -> Result<Vec<f64>, Failure> {
        self.rest.show(pose);
        let system = &mut self.rest.system;
        let mut modes = pose.modes.clone();
        system.observer.set_modes(&mut modes);
        let mut row = vec![0.0; count];
        system.columns(&modes, &mut row);
        match system.observer.undefined(&modes, &row) {
            Some(gap) => Err(Failure::Undefined(gap.explain(self.case.model, self.case.study, "the equilibrium"))),
            None => Ok(row),
        }
    }

    /// The equilibrium with the start behind it, and all equilibria if there are several.
    fn scenes(&mut self, begin: &Pose, all: &[Found]) -> Vec<(String, Scene)> {
        /// Poses in one drawing.
        const DRAWN: usize = 6;
        if !self.case.drawn {
            return Vec::new();
        }
        let mut bodies = |pose: &Pose| {
            self.rest.show(pose);
            self.rest.system.dynamics.poses()
        };
        let from_start = [bodies(&all[0].pose), bodies(begin)];
        let several: Vec<_> = all.iter().take(DRAWN).map(|f| bodies(&f.pose)).collect();
        let subject = Subject { case: self.case, mechanism: self.rest.system.dynamics.mechanism };
        let mut scenes = vec![(MECHANISM.to_string(), subject.of_poses(&from_start))];
        if several.len() > 1 {
            scenes.push(("equilibria".into(), subject.of_poses(&several)));
        }
        scenes
    }
}

fn interrupted() -> Failure {
    Failure::interrupted()
}
