//! Motion in time: the study kind `dynamics`.
//!
//! `system` shows a mechanism to the integrators, `march` runs one of them and records, `trajectory` is the motion as a curve,
//! `setup` translates what the study asks for, `explain` says in words why a run stopped. Here is the whole: rows, functionals, certificate.

mod chart;
mod contradiction;
mod course;
mod depart;
pub(crate) mod energy;
pub(crate) mod explain;
pub(crate) mod march;
pub(crate) mod massless;
mod pace;
pub(crate) mod phases;
pub(crate) mod rows;
mod runaway;
pub(crate) mod setup;
pub(crate) mod stepping;
pub(crate) mod system;
pub(crate) mod trajectory;
mod unrecorded;
mod vanishing;
mod watch;
mod way;

pub use setup::{is_available, method};
pub use unrecorded::Unrecorded;

use super::common::case::Case;
use super::common::clock::{Clock, Variable};
use super::common::functional::Functionals;
use super::common::indeterminate;
use super::common::numbers::Sources;
use super::common::recorder::{Recorded as Kept, Recorder};
use super::common::scene::{self, Span, Subject};
use super::common::watched::{Watched, in_variable, unresolved};
use crate::expression::Dimension;
use crate::geometry::{Planar, Pose, Space, Spatial};
use crate::kinematics::beside::other_beginning;
use crate::kinematics::crossing::begins_in_change_point;
use crate::kinematics::laws::first_jump;
use crate::kinematics::undefined::Gap;
use crate::model::{Dimensions, Forward, Study, WORKS};
use crate::numerics::extremum::{Extremes, extrema};
use crate::numerics::resolve;
use crate::results::{Certificate, Failure, Finding, Resolution};
use crate::studies::common::outcome::Outcome;
use energy::SAMPLES;
use march::Recorded;
use phases::Phases;
use rows::Rows;
use trajectory::{Off, Trajectory};

/// Most numbers in the rows of a run: 4 GB of them.
const MOST_NUMBERS: f64 = 5e8;

/// Runs a dynamic study; `stop` is asked between steps, and ends the run where it is.
///
/// # Errors
/// If it never began.
pub(crate) fn run<G>(case: Case<'_>, forward: &Forward, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    let Case { model, study, parameters, .. } = case;
    let plan = setup::plan(case, forward)?;
    let watched = Watched::of(study);
    let phases = Phases::<G>::new(model, parameters, plan.coordinates)?;
    check_rows(study, &plan, watched.ids.len().max(1))?;
    let clock = Clock::of_time(plan.until);
    let rows = || Rows::new(Recorder::new(case, &watched, clock, "time", Variable::of("t", Dimension::TIME)), plan.every);
    let mut taken = rows();
    let Recorded { mut trajectory, mut stopped, mut undefined, mut events, mut certificate, mut findings } =
        march::march(case, &plan, &watched.ids, &phases, None, (stop, Some(&mut taken)))?;

    if let (Some(reason), true) = (&stopped, trajectory.is_empty()) {
        return Err(match undefined {
            Some(undefined) => Failure::Undefined(undefined),
            None => Failure::numerical(reason.clone(), "the motion stops before its first row: look at the start with `grashof check`"),
        });
    }
    let times: Vec<f64> = (0..trajectory.pieces()).flat_map(|piece| trajectory.ends_of(piece)).collect();
    let modes = trajectory.node.state.modes.clone();
    if let Some((before, jump)) = first_jump(&mut trajectory.system(0).dynamics, &modes, &times) {
        let reason = jump.told(&format!("time = {before:.6}"));
        if before <= times[0] {
            return Err(Failure::numerical(reason, "begin with the value that the law has just behind the start"));
        }
        // once more up to there: works, energies and findings of what lies behind it are none of this motion
        taken = rows();
        let plan = setup::Plan { until: before, ..plan.clone() };
        let again = march::march(case, &plan, &watched.ids, &phases, None, (stop, Some(&mut taken)))?;
        let interrupted = again.stopped.is_some();
        Recorded { trajectory, events, certificate, findings, stopped, undefined } = again;
        if !interrupted {
            stopped = Some(reason);
        }
    }
    let seen = loop {
        match see(&mut trajectory, case, &watched, &plan, taken) {
            Ok(seen) => break seen,
            Err(Off { at, gap: None }) => {
                return Err(Failure::numerical(
                    format!("the state at t = {at} s could not be evaluated"),
                    "the position is nearly singular there: end the run before, or start elsewhere",
                ));
            }
            Err(Off { at, gap: Some(gap) }) => {
                let explain = |gap: &Gap, at: f64| gap.explain(model, study, &format!("t = {at:.6} s"));
                let Some(Off { at, gap: behind }) = trajectory.end_before(at) else { return Err(Failure::Undefined(explain(&gap, at))) };
                undefined = Some(explain(&behind.unwrap_or(gap), at));
                taken = rows();
            }
        }
    };
    let Seen { breaks, rows, extremes, functionals, resolution, findings: open } = seen;
    findings.extend(open);
    let (from, to) = (breaks[0], breaks[breaks.len() - 1]);
    events.retain(|e| e.at <= to);
    let stopped = undefined.as_ref().map(|u| u.message.clone()).or(stopped);
    let tables = &phases.first().mechanism.tables;
    let works = certificate.march.as_ref().map_or([f64::NAN; WORKS.len()], |march| march.works().map(|(_, work)| work));
    let numbers = Sources { case, tables, functionals: &functionals, results: &[], works: &works }.numbers(stopped.is_none());
    let undefined = undefined.or(numbers.undefined);
    let stopped = stopped.or_else(|| undefined.as_ref().map(|u| u.message.clone()));
    let certificate = Certificate {
        resolved: Some(resolution),
        ..energy::residuals(&mut trajectory, (rows.count(), rows.some_places(SAMPLES)), certificate)
    };
    findings.extend(energy::open(&certificate, phases.first().mechanism.size(), &case.study.place));
    findings.extend(numbers.findings);
    findings.extend(rows.findings());
    findings.extend(indeterminate::open(case, &watched, &phases.first().mechanism, &phases.first().start));
    findings.extend(begins_in_change_point(&phases.first().mechanism, &phases.first().start));
    findings.extend(other_beginning(&phases.first().mechanism, &phases.first().start, setup::resolution(plan.settings.control)));
    let Kept { places, switches, rows, selected_from } = rows.recorded();
    let span = Span { ends: [from, to], times: Some([from, to]), ..Span::default() };
    let subject = Subject { case, mechanism: &phases.first().mechanism };
    let scenes = scene::wanted(case, || subject.over(span, &mut |t| Some((t, pose(&mut trajectory, &breaks, t)?))));
    Ok(Outcome {
        stopped,
        undefined,
        parameters: case.named(),
        independent: "time".into(),
        switches,
        rows,
        selected_from,
        places,
        results: Vec::new(),
        scalars: numbers.scalars,
        extremes: watched.columns.iter().map(|&c| extremes[c].map(|e| in_variable(e, clock))).collect(),
        expectations: numbers.expectations,
        findings: phases.start.findings().chain(findings).collect(),
        certificate,
        events,
        scenes,
        ..Outcome::default()
    })
}

/// Integrates a dynamic study without recording anything but its end; see [`Unrecorded`].
///
/// # Errors
/// If it never began.
pub fn unrecorded(case: Case<'_>, forward: &Forward, timer: &mut dyn FnMut(bool)) -> Result<Unrecorded, Failure> {
    fn in_space<G>(case: Case<'_>, forward: &Forward, timer: &mut dyn FnMut(bool)) -> Result<Unrecorded, Failure>
    where
        G: Space<S = f64>,
    {
        let plan = setup::plan(case, forward)?;
        let phases = Phases::<G>::new(case.model, case.parameters, plan.coordinates)?;
        let ids: Vec<_> = case.study.columns.iter().map(|c| c.value).collect();
        unrecorded::unrecorded(case, &plan, &ids, &phases, timer)
    }
    match case.model.space {
        Dimensions::Planar => in_space::<Planar<f64>>(case, forward, timer),
        Dimensions::Spatial => in_space::<Spatial<f64>>(case, forward, timer),
    }
}

/// Part of what columns are resolved to by which a state between rows may be off the constraints: nearer ones need not be moved there.
const NEAR: f64 = 0.03;

/// Part of the size by which a pose of a picture may be off the constraints: a hundredth of what frames leave out.
const PLACED: f64 = 1e-8;

/// A motion seen over time.
struct Seen<'a> {
    breaks: Vec<f64>,
    rows: Recorder<'a>,
    extremes: Vec<Option<Extremes>>,
    functionals: Vec<f64>,
    findings: Vec<Finding>,
    resolution: Resolution,
}

/// Rows, extremes and functionals of a motion.
fn see<'a, G>(
    trajectory: &mut Trajectory<'_, G>,
    case: Case<'a>,
    watched: &Watched,
    plan: &setup::Plan,
    rows: Rows<'a>,
) -> Result<Seen<'a>, Off>
where
    G: Space<S = f64>,
{
    let breaks = trajectory.breaks();
    let (Some(&from), Some(&to)) = (breaks.first(), breaks.last()) else { return Err(Off { at: 0.0, gap: None }) };
    let stretches = trajectory.stretches();
    let resolution = setup::resolution(plan.settings.control);
    trajectory.near_enough = NEAR * resolution;
    trajectory.floors = trajectory.grain().floors(case.model, case.study, &watched.ids, to - from);
    let mut resolved = resolve::on(trajectory, &stretches, &breaks, resolution)?;
    if trajectory.looks_too_far(&resolved) {
        trajectory.near_enough = 0.0;
        resolved = resolve::on(trajectory, &stretches, &breaks, resolution)?;
    }
    trajectory.all_defined(&resolved)?;
    let extremes = extrema(trajectory, resolved.samples(), &breaks);
    let clock = Clock::of_time(plan.until);
    let recorder = rows.finish(trajectory)?;
    let mut findings = unresolved(case.model, case.study, watched, &resolved, &[], Variable::of("time", Dimension::TIME), clock);
    let mut functionals =
        Functionals { clock, ends: [from, to], curve: trajectory, resolved: &resolved, extremes: &extremes, breaks: &breaks };
    let functionals = functionals.all(case, &watched.functionals, &mut findings)?;
    Ok(Seen { breaks, rows: recorder, extremes, functionals, findings, resolution: watched.quality(case.study, &resolved) })
}

/// Poses of the bodies at a time, for pictures.
pub(crate) fn pose<G>(trajectory: &mut Trajectory<'_, G>, breaks: &[f64], t: f64) -> Option<Vec<Pose<G>>>
where
    G: Space<S = f64>,
{
    let piece = breaks.partition_point(|b| *b <= t).clamp(1, breaks.len() - 1) - 1;
    trajectory.place(t, piece, PLACED).ok()?;
    Some(trajectory.system(piece).dynamics.poses())
}

/// Refuses more rows than fit in memory.
fn check_rows(study: &Study, plan: &setup::Plan, columns: usize) -> Result<(), Failure> {
    let step = plan.every.or(plan.fixed_step());
    let rows = step.map_or(0.0, |step| plan.until / step);
    if rows * columns as f64 <= MOST_NUMBERS {
        return Ok(());
    }
    let key = if plan.every.is_some() { "every" } else { "step" };
    Err(Failure::Study {
        code: "too-many-rows",
        message: format!("the study asks for {rows:.3e} rows of {columns} numbers"),
        place: study.place_of(key),
        help: format!("ask for a longer output step, as `every: {}`", plan.until / 1000.0),
    })
}
