//! Why a run did not begin or did not end, in words: what happened to which joint at what time, and what to try.

use super::massless::massless;
use super::phases::Phases;
use super::setup::Plan;
use super::system::{Mechanical, Met, Root};
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::mobility::mobility;
use crate::kinematics::undefined::{Gap, meeting};
use crate::mechanism::{BuildFault, Mechanism, Stop};
use crate::model::{Model, Parameter, Study};
use crate::results::{Failure, Finding, Happened, Undefined};
use grashof_solvers::minimal::Refused;
use grashof_solvers::{Control, Halt, Why};

/// Why a run has stopped on its way.
pub(super) fn halt<G>(model: &Model, mechanism: &Mechanism<G>, system: &Mechanical<'_, G>, plan: &Plan, halt: &Halt) -> String
where
    G: Space<S = f64>,
{
    let t = halt.t;
    let fixed = matches!(plan.settings.control, Control::Steps(_));
    match halt.why {
        Why::Zeno(root) if matches!(system.roots.get(root), Some(Root::Side { .. })) => {
            format!("at t = {t:.6} s {}", cause(mechanism, &Why::Friction))
        }
        Why::Zeno(root) => format!(
            "at t = {t:.6} s events pile up without end at {}: the motion wants to stay on the switch; give friction as `friction` of a joint or as a clutch, which stick, smooth another switch (a `clamp` over a small range instead of `sign`), or march across it with `integrator: rk4`, a fixed `step` and `switches: step-over`",
            root_name(model, system, root)
        ),
        Why::Unresolved(root) => format!(
            "at t = {t:.6} s it is not known where {} changes next: it oscillates, or stays at its edge, within the rounding of the time; use another unit of time, or give a shorter `until`",
            root_name(model, system, root)
        ),
        Why::Blocked(root) if matches!(system.roots.get(root), Some(Root::Slides(_))) => format!(
            "at t = {t:.6} s {} is driven against the sense in which it locks: drive it the other way, or let it go",
            root_name(model, system, root)
        ),
        Why::Blocked(root) => format!(
            "at t = {t:.6} s {} is reached while drivers or other joints hold the joint to its motion, so that no blow can stop it: end the driver's motion before, or give the stop `stiffness` instead of `restitution`",
            root_name(model, system, root)
        ),
        Why::Error(_) | Why::StepSize => format!(
            "at t = {t:.6} s the step has shrunk to {:.1e} s and the error is still too large: a force grows without bound there, or is rougher than the tolerance allows; look at the motion just before, or try another `tolerance`, smaller or larger",
            halt.h
        ),
        Why::Newton if fixed => {
            format!("at t = {t:.6} s Newton's method does not converge with the step {:.1e} s: give a shorter `step`", halt.h)
        }
        Why::Newton => format!(
            "at t = {t:.6} s Newton's method does not converge even with a step of {:.1e} s: the mechanism locks, a force jumps, or a light body is swept through a dead point there; look at the motion just before, or try `integrator: dop853`",
            halt.h
        ),
        Why::Lost => {
            let joint = system.fastest_turn().and_then(|(gauge, _)| mechanism.joints.iter().find(|joint| joint.slots.contains(&gauge)));
            format!(
                "at t = {t:.6} s joint `{}` turns by more than a fifth of a turn in a step of {:.1e} s, so that its turns cannot be counted: give a shorter `step`, or a `tolerance`",
                joint.map_or("", |joint| &joint.name),
                halt.h
            )
        }
        _ => format!("at t = {t:.6} s {}", cause(mechanism, &halt.why)),
    }
}

/// What has no value in the state that was evaluated last, at a time.
pub(super) fn undefined<G>(model: &Model, study: &Study, system: &mut Mechanical<'_, G>, modes: &[i32], t: f64) -> Option<Undefined>
where
    G: Space<S = f64>,
{
    let at = format!("t = {t:.6} s");
    let law = system.dynamics.undefined(modes).map(|law| Gap::Law(law).explain(model, study, &at));
    law.or_else(|| meeting(model, &system.dynamics, &format!("at {at}")))
}

/// Why a run ends at an event that has set parameters to what no mechanism can have.
pub(super) fn set(model: &Model, events: &[Happened], changed: &[(usize, f64)], t: f64, faults: &[BuildFault]) -> String {
    let happened = |name: &str| events.iter().any(|e| e.at == t && e.name == name);
    let now: Vec<_> = model.events.iter().filter(|e| !e.set.is_empty() && happened(&e.name)).collect();
    let names: Vec<String> = now.iter().map(|e| format!("`{}`", e.name)).collect();
    let theirs = changed.iter().filter(|(i, _)| now.iter().any(|e| e.set.iter().any(|(set, _)| set == i)));
    let values: Vec<String> = theirs.map(|&(i, x)| assigned(&model.parameters[i], x)).collect();
    let (word, verb) = if names.len() == 1 { ("event", "sets") } else { ("events", "set") };
    let faults = Failure::Model(faults.to_vec()).reason();
    format!("at t = {t:.6} s the {word} {} {verb} {}, which cannot be: {faults}", names.join(", "), values.join(", "))
}

/// `c = -5 N m`.
fn assigned(parameter: &Parameter, x: f64) -> String {
    format!("`{}` = {x} {}", parameter.name, parameter.dimension.si()).trim_end().to_string()
}

/// The rows that become dependent where a run has stopped in a nearly singular position; none elsewhere, or if the reason is another.
pub(super) fn locked<G: Space>(mechanism: &Mechanism<G>, halt: &Halt, (sigma, rows): &(f64, Vec<usize>)) -> Option<String> {
    if *sigma >= 0.05
        || sigma.is_nan()
        || rows.is_empty()
        || matches!(halt.why, Why::Zeno(_) | Why::Unresolved(_) | Why::Blocked(_) | Why::NotFinite(_) | Why::Friction | Why::TooManySteps)
    {
        return None;
    }
    let mut names: Vec<String> = Vec::new();
    // a driver among them is what a person looks for
    let drives = mechanism.drives.iter().map(|d| d.row).filter(|row| rows.contains(row));
    for row in drives.chain(rows.iter().copied()) {
        let name = mechanism.name_of_row(row);
        if !names.contains(&name) && names.len() < 3 {
            names.push(name);
        }
    }
    Some(format!(
        "at t = {:.6} s the motion cannot go on: in a nearly singular position (a dead point, or links in a line) {} contradict each other; start elsewhere, change lengths, or end the run before",
        halt.t,
        names.join(" and ")
    ))
}

/// What is wrong with a state.
fn cause<G: Space>(mechanism: &Mechanism<G>, why: &Why) -> String {
    match *why {
        Why::NotFinite(v) => format!("a force on {} is not a number: look at tables and expressions of loads that act there", name_of_velocity(mechanism, v)),
        Why::Friction => format!(
            "the friction of {} has no accelerations that obey its law: with this coefficient the joint jams (Painlevé's paradox); give a smaller `coulomb`, a longer guide, or drive the motion from the other side",
            friction_by_reactions(mechanism)
        ),
        Why::Singular => "the accelerations are not determined: a body that can move has no mass or inertia, or the position is singular; give masses to all moving bodies".into(),
        Why::Constraints { row, residual } => format!(
            "{} cannot be closed, {residual:.1e} remains: the mechanism locks there; check lengths and limits",
            mechanism.name_of_row(row)
        ),
        Why::TooManySteps => "the run has taken more steps than are allowed; ask for a larger `tolerance` or a shorter `until`".into(),
        Why::Error(_) | Why::Newton | Why::StepSize | Why::Zeno(_) | Why::Unresolved(_) | Why::Blocked(_) | Why::Lost | Why::Unavailable => "the state cannot be continued".into(),
    }
}

/// What to do where friction by reactions jams.
pub(super) const LESS_FRICTION: &str = "give a smaller `coulomb`, a longer guide, or drive the motion from the other side";

/// Why contacts cannot be decided.
pub(super) fn jams<G: Space<S = f64>>(phases: &Phases<G>, t: f64) -> String {
    let m = &phases.mechanism;
    format!("at t = {t:.6} s no accelerations obey the laws of friction of {}: it jams (Painlevé's paradox)", names(m, 0..m.contacts.len()))
}

/// Why a run ends where contacts stick and slide without end.
pub(super) fn chatters<G: Space<S = f64>>(phases: &Phases<G>, met: &[Met], t: f64) -> String {
    format!(
        "at t = {t:.6} s {} begins and ceases to stick without end: its force, or what holds it, changes too often; give it a `stick_speed`",
        names(&phases.mechanism, met.iter().map(|met| met.contact))
    )
}

/// Why a run ends where stops and contacts change without end at one time.
pub(super) fn changes(t: f64) -> String {
    format!(
        "at t = {t:.6} s joints on rigid stops, and what sticks, change without end: no place of theirs lasts; give the stops a `stiffness`, or friction a `stick_speed`"
    )
}

/// Why a run ends where events set parameters without end.
pub(super) fn hunts(events: &[Happened], t: f64) -> String {
    let name = events.last().map_or("", |event| &event.name);
    format!(
        "at t = {t:.6} s events pile up without end, the last one is `{name}`: what they set turns the motion back over them at once; give two events with a distance between what they wait for (a hysteresis), or a load that changes smoothly"
    )
}

/// What redundant rows leave open in a motion in time: friction that follows from reactions, and with it the motion; efforts of drivers
/// that hold the same motion.
pub(super) fn shared<G: Space<S = f64>>(phases: &Phases<G>) -> Vec<Finding> {
    let first = phases.first();
    let m: &Mechanism<G> = &first.mechanism;
    let mut findings = Vec::new();
    if m.pressings.is_empty() && m.drives.len() < 2 {
        return findings;
    }
    let mobility = mobility(m, &first.start);
    if !m.pressings.is_empty() && !mobility.redundant.is_empty() {
        findings.push(Finding {
            code: "friction-not-unique".into(),
            message: format!(
                "the friction of {} follows from reactions, and {} redundant constraint row{} may leave open how joints share them: then it, and the motion, is one of several; give a loop a joint that leaves it free (`pin-in-slot`, `spherical`, `universal`), or the friction as a force",
                friction_by_reactions(m),
                mobility.redundant.len(),
                if mobility.redundant.len() == 1 { "" } else { "s" }
            ),
            path: "joints".into(),
        });
    }
    if m.drives.len() > mobility.undriven - mobility.left.min(mobility.undriven) {
        findings.push(Finding {
            code: "efforts-not-unique".into(),
            message: "drivers hold the same motion: only what their efforts do together is determined, single ones are those of least size"
                .into(),
            path: "drivers".into(),
        });
    }
    findings
}

/// Contacts in words.
fn names<G: Space<S = f64>>(mechanism: &Mechanism<G>, contacts: impl Iterator<Item = usize>) -> String {
    let mut names: Vec<&str> = contacts.map(|c| mechanism.contacts[c].name.as_str()).collect();
    names.dedup();
    names.join(" and ")
}

/// The joints with friction by reactions, in words.
fn friction_by_reactions<G: Space>(mechanism: &Mechanism<G>) -> String {
    let names: Vec<String> = mechanism.pressings.iter().map(|p| format!("`{}`", mechanism.joints[p.joint].name)).collect();
    format!("{} {}", if names.len() == 1 { "joint" } else { "joints" }, names.join(", "))
}

/// The body that a velocity moves, in words.
fn name_of_velocity<G: Space>(mechanism: &Mechanism<G>, v: usize) -> String {
    let node = mechanism.nodes.iter().find(|n| n.columns.contains(&v));
    node.map_or_else(|| "the mechanism".into(), |n| format!("body `{}`", mechanism.bodies[n.body].name))
}

/// A root in words.
pub(crate) fn root_name<G>(model: &Model, system: &Mechanical<'_, G>, root: usize) -> String
where
    G: Space<S = f64>,
{
    let m = system.dynamics.mechanism;
    let switch = match system.roots.get(root) {
        Some(&Root::Force { program, k }) => m.programs()[program].program.switches().get(k).copied(),
        Some(&Root::Column { k }) => system.observer.program().switches().get(k).copied(),
        Some(&(Root::Stop(stop) | Root::Clear(stop) | Root::Rest { stop, .. })) => {
            if let Some(event) = m.stops[stop].event {
                return format!("the event `{}`", model.events[event].name);
            }
            return format!("the {} of joint `{}`", m.stops[stop].word(), m.joints[m.stops[stop].joint].name);
        }
        Some(&(Root::Slides(contact) | Root::Holds { contact, .. })) => return m.contacts[contact].name.clone(),
        Some(&Root::Event(event)) => return format!("the event `{}`", model.events[event].name),
        _ => None,
    };
    match switch.and_then(|s| model.pool.switches().get(s as usize)) {
        Some(switch) => switch.told(),
        None => "a switch".into(),
    }
}

/// That the impacts of an event would have to come to rest where nothing can hold the joint.
pub(super) fn restless(model: &Model, event: usize, t: f64) -> String {
    let name = &model.events[event].name;
    format!(
        "at t = {t:.6} s the blows of the event `{name}` have become so weak that its joint would rest there, but its `when` holds more than positions, so that nothing is known of how it rests: write `when` with positions alone, or give the joint `limits` with a `restitution`"
    )
}

/// That the law of a coupling jumps.
pub(super) fn step<G: Space<S = f64>>(mechanism: &Mechanism<G>, row: usize, height: f64, t: f64) -> String {
    format!(
        "at t = {t:.6} s the law of {} jumps, by {:.6e} in SI units: no rigid body follows a step; lead it up a short flank (a table with two points beside each other)",
        mechanism.name_of_row(row),
        height.abs()
    )
}

/// That an event has moved a stop, or what an impact is met at, beyond where its joint stands.
pub(super) fn passed(model: &Model, stop: &Stop, happened: &[Happened], t: f64) -> String {
    let joint = &model.joints[stop.joint].name;
    let by = happened.last().filter(|last| last.at == t).map_or_else(String::new, |last| format!(" by the event `{}`", last.name));
    match stop.event {
        Some(event) => format!(
            "at t = {t:.6} s the `when` of the event `{}` has jumped through zero{by}: that is no impact of joint `{joint}`; set its parameters only as far as the joint stays on its side",
            model.events[event].name
        ),
        None => format!(
            "at t = {t:.6} s the {} of joint `{joint}` has been set to {:.6}{by}, where the joint already is beyond it: a rigid stop does not push it there; set it where the joint stands clear of it, or give it a `stiffness`",
            stop.word(),
            stop.at
        ),
    }
}

/// That a condition changed faster than it could be resolved, first at time `t` (s).
pub(super) fn unresolved<G>(model: &Model, system: &Mechanical<'_, G>, root: usize, t: f64) -> Finding
where
    G: Space<S = f64>,
{
    let name = root_name(model, system, root);
    Finding {
        code: "unresolved-condition".into(),
        message: format!(
            "{name} changes faster than a millionth of a step from t = {t:.6} s on, or is noise: it was followed as seen, and changes back and forth may be missing"
        ),
        path: name,
    }
}

/// Why a run has not begun.
pub(super) fn no_start<G: Space<S = f64>>(study: &Study, mechanism: &Mechanism<G>, start: &Assembled, halt: &Halt) -> Failure {
    if halt.why == Why::Singular
        && let Some(failure) = massless(mechanism, start)
    {
        return failure;
    }
    Failure::Study {
        code: "no-start",
        message: format!("the motion cannot begin: {}", cause(mechanism, &halt.why)),
        place: study.place.clone(),
        help: "look at `grashof check`, which shows the start position and the freedom that is left".into(),
    }
}

/// Why there are no minimal coordinates.
pub(super) fn no_chart(study: &Study, why: &Refused) -> Failure {
    let (message, help) = match why {
        Refused::Dependent => (
            "the joint coordinates with exact values in `start` depend on each other, or are more than the degrees of freedom",
            "keep an exact value for as many joints as there are degrees of freedom, and put `~` before the others",
        ),
        Refused::Open => ("the loops cannot be closed at the start", "look at `grashof check`"),
    };
    Failure::Study { code: "no-minimal-coordinates", message: message.into(), place: study.place_of("coordinates"), help: help.into() }
}
