//! One run of a kinematic study: build, assemble, trace, resolve, extremes, functionals, rows, scalars, expectations.

use super::balance;
use super::balance::Unbalanced;
use super::common::case::Case;
use super::common::clock::{Clock, Variable};
use super::common::functional::Functionals;
use super::common::motion::{Lost, Motion};
use super::common::numbers::Sources;
use super::common::observe::Observer;
use super::common::recorder::{Recorded, Recorder};
use super::common::watched::{Watched, in_variable, unresolved};
use super::common::{energies, indeterminate, scene, stops};
use super::full_turn::turns_fully;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::mobility::drivers_fit;
use crate::kinematics::path::{MOST_NODES, NoPath};
use crate::kinematics::undefined::{Gap, assembled};
use crate::mechanism::{Coordinates, Mechanism};
use crate::model::{Kind, Over, Quantity, Range};
use crate::numerics::continuous::Curve;
use crate::numerics::extremum::{Extremes, extrema};
use crate::numerics::resolve::Resolved;
use crate::results::{Certificate, Failure, Finding, six_digits};
use crate::studies::common::outcome::Outcome;

/// Part of the size of a mechanism by which its centre of mass may move when it counts as balanced.
const STILL: f64 = 1e-9;

/// How often a motion is cut where a position could not be reached.
const MOST_CUTS: usize = 8;

/// A study of a motion that its drivers prescribe.
pub(crate) fn run<G: Space<S = f64>>(case: Case<'_>, range: &Range, coordinates: Coordinates) -> Result<Outcome, Failure> {
    let Case { model, study, parameters, .. } = case;
    let (mut mechanism, start) = prepared::<G>(case, coordinates)?;
    let (mut results, mut unbalanced) = (Vec::new(), None);
    if let Kind::Balance { moved, .. } = &study.kind {
        let observer = Observer::new(model, &mechanism, parameters, &[]);
        let mut motion = trace(case, &mechanism, &start, clock(case, &mechanism, &start, range)?, observer, 0)?;
        let refused =
            |message: String, help: &str| Failure::Study { code: "balance", message, place: study.place.clone(), help: help.into() };
        let offsets = balance::balance(&mut motion, moved).map_err(|why| match why {
            Unbalanced::NoLine(message) => refused(message, "name masses that are attached away from the origin of bodies that move"),
            Unbalanced::Lost(Lost { at, gap: Some(gap) }) => {
                Failure::Undefined(gap.explain(model, study, &format!("{} = {at}", independent(case, &mechanism, motion.clock))))
            }
            Unbalanced::Lost(lost) => refused(format!("the motion is lost at {}", lost.at), "start elsewhere, or give a shorter range"),
        })?;
        for (&(body, index), offset) in moved.iter().zip(&offsets.distances) {
            let at = mechanism.bodies[body].attached[index].mass.com;
            let along = at * (1.0 / G::dot(at, at).sqrt());
            mechanism.bodies[body].move_attached(index, along * *offset);
        }
        results = offsets.distances;
        results.push(offsets.residual);
        unbalanced = still_moves(case, offsets.residual, start.size);
    }
    let mut outcome = observe(case, &mechanism, &start, range, results)?;
    outcome.findings.extend(unbalanced);
    Ok(outcome)
}

/// The mechanism at the start of a study whose motion its drivers prescribe.
///
/// # Errors
/// Why the study cannot begin.
pub(crate) fn prepared<G: Space<S = f64>>(case: Case<'_>, coordinates: Coordinates) -> Result<(Mechanism<G>, Assembled), Failure> {
    let Case { model, study, parameters, .. } = case;
    let (mechanism, start) = assembled::<G>(model, parameters, coordinates)?;
    drivers_fit(&mechanism, &start, model, study)?;
    stops::begins(model, &mechanism, &start)?;
    stops::driven(model, &mechanism, study)?;
    Ok((mechanism, start))
}

/// The motion over the range of a clock.
///
/// # Errors
/// Why it cannot begin.
pub(crate) fn trace<'m, G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &'m Mechanism<G>,
    start: &Assembled,
    clock: Clock,
    observer: Observer<G>,
    columns: usize,
) -> Result<Motion<'m, G>, Failure> {
    Motion::trace(mechanism, start, clock, observer, columns).map_err(|why| {
        match why {
            NoPath::SingularStart => Failure::numerical(
                "the motion cannot begin: the start is a singular position (a dead point or change point), where the drivers do not determine the velocities",
                "start elsewhere, or change the lengths",
            ),
            NoPath::TooLong => Failure::numerical(format!("the range asks for more than {MOST_NODES} steps"), "give a shorter range"),
            NoPath::Jump(jump) => Failure::numerical(jump.told("the start"), "begin with the value that the law has just behind the start"),
            NoPath::Undefined(gap) => Failure::Undefined(gap.explain(case.model, case.study, "the start")),
        }
    })
}

/// The independent variable of a range.
pub(crate) fn clock<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    start: &Assembled,
    range: &Range,
) -> Result<Clock, Failure> {
    let fault =
        |message: String, help: &str| Failure::Study { code: "range", message, place: case.study.place_of("over"), help: help.into() };
    match range.over {
        Over::Time(id) => {
            let length = case.value(id);
            if length.is_finite() && length != 0.0 {
                Ok(Clock::of_time(length))
            } else {
                Err(fault(format!("the range is {length} s"), "give a time, as `over: 2 s`"))
            }
        }
        Over::Driver(id) => {
            let length = case.value(id);
            let [drive] = &mechanism.drives[..] else {
                return Err(fault(
                    format!("the range is one of a driver, and the model has {} drivers", mechanism.drives.len()),
                    "give the range as a time, as `over: 2 s`",
                ));
            };
            if !length.is_finite() || length == 0.0 {
                return Err(fault(format!("the range is {length}"), "give a range, as `over: 1 turn`"));
            }
            let mut dynamics = Dynamics::new(mechanism);
            let mut modes = start.modes.clone();
            dynamics.time(0.0, &modes);
            dynamics.position(&start.q, &modes);
            let from = dynamics.work.readings[drive.gauge].x;
            Clock::of_driver(&mut dynamics, &mut modes, drive, from, length)
                .map_err(|e| fault(e.0, "give the range as a time, as `over: 2 s`"))
        }
    }
}

fn observe<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    start: &Assembled,
    range: &Range,
    mut results: Vec<f64>,
) -> Result<Outcome, Failure> {
    let Case { model, study, parameters, .. } = case;
    let watched = Watched::of(study);
    let observer = Observer::new(model, mechanism, parameters, &watched.ids);
    let clock = clock(case, mechanism, start, range)?;
    let mut motion = trace(case, mechanism, start, clock, observer, watched.ids.len())?;
    let name = independent(case, mechanism, clock);
    let unit = clock.unit(mechanism);
    let variable = Variable { name: &name, unit };
    let explain = |gap: &Gap, at: f64| gap.explain(model, study, &variable.at(at));
    let mut undefined = motion.path.gap.take().map(|gap| explain(&gap, clock.value(motion.ends[1])));
    let (mut barrier, mut cuts): (Option<String>, usize) = (None, 0);
    let seen = loop {
        match see(&mut motion, case, &watched, range.samples, variable) {
            Ok(seen) => {
                let margins = &seen.extremes[watched.ids.len()..];
                let Some(found) = stops::barrier(case, variable, &mut motion, &seen.resolved, margins, start.size)? else { break seen };
                if found.at > 0.0 {
                    undefined = None;
                }
                motion.end_at(found.at);
                barrier = barrier.or(Some(found.message));
            }
            Err(Lost { at, gap: None }) => {
                let message = format!("the position at {} could not be reached", variable.at(at));
                cuts += 1;
                if cuts > MOST_CUTS || motion.end_before(at).is_none() {
                    return Err(Failure::numerical(message, "start elsewhere, change the lengths, or give a shorter range"));
                }
                barrier = Some(message);
            }
            Err(Lost { at, gap: Some(gap) }) => {
                let Some(Lost { at, gap: behind }) = motion.end_before(at) else { return Err(Failure::Undefined(explain(&gap, at))) };
                undefined = Some(explain(&behind.unwrap_or(gap), at));
            }
        }
    };
    let Seen { resolved, extremes, rows, functionals, findings: open } = seen;
    let mut findings: Vec<Finding> = start.findings().chain(findings(mechanism, &motion, &name, unit)).collect();
    findings.extend(open);
    if mechanism.rows.len() > mechanism.nv {
        findings.extend(indeterminate::open(case, &watched, mechanism, start));
    }
    findings.extend(jumps(case, &mut motion, &name, unit));
    findings.extend(backwards(case, &motion, &name, unit));
    findings.extend(stops::dwells(study, variable, &mut motion, &resolved));
    findings.extend(stops::carries(study, variable, &mut motion, &resolved, start.size));

    let complete = motion.path.dead == [None, None] && motion.path.jump.is_none();
    let stopped = (!complete && undefined.is_none()).then(|| {
        let at = clock.value(motion.ends[1]);
        if let Some(jump) = &motion.path.jump {
            return jump.told(&variable.at(at));
        }
        if let Some(row) = motion.path.open {
            return format!(
                "{name} cannot go beyond {:.6} {}: the constraints contradict each other there, {} cannot be met with the others; drivers and couplings that hold the same motion must agree at all times, remove one of them",
                at * unit.0,
                unit.1,
                mechanism.name_of_row(row)
            );
        }
        let mover = if mechanism.drives.is_empty() { "coupling" } else { "driver" };
        format!(
            "{}: dead point, the links are in a line there and the {mover} cannot move them on",
            reach(&motion, &name, unit)
        )
    });
    if results.is_empty() && study.results.iter().any(|r| r.name == "turns_fully") {
        let covered = complete && undefined.is_none() && barrier.is_none();
        // a law that jumps does not lead around
        results.push(if motion.path.jump.is_some() { f64::NAN } else { turns_fully(case, mechanism, start, clock, covered) });
    }
    let sources = Sources { case, tables: &mechanism.tables, functionals: &functionals, results: &results, works: &[] };
    let numbers = sources.numbers(undefined.is_none());
    let undefined = undefined.or(numbers.undefined);
    findings.extend(numbers.findings);
    findings.extend(rows.findings());
    let certificate = Certificate { resolved: Some(watched.quality(study, &resolved)), ..certificate(&mut motion, &rows) };
    let Recorded { places, switches, rows, selected_from } = rows.recorded();
    Ok(Outcome {
        stopped: undefined.as_ref().map(|u| u.message.clone()).or(barrier).or(stopped),
        undefined,
        parameters: case.named(),
        independent: name.clone(),
        places,
        switches,
        rows,
        selected_from,
        results,
        scalars: numbers.scalars,
        extremes: watched.columns.iter().map(|&c| extremes[c].map(|e| in_variable(e, clock))).collect(),
        expectations: numbers.expectations,
        findings,
        certificate,
        events: Vec::new(),
        scenes: scene::wanted(case, || scene::of_motion(case, &mut motion)),
        ..Outcome::default()
    })
}

/// What is seen of a motion.
pub(crate) struct Seen<'a> {
    resolved: Resolved,
    extremes: Vec<Option<Extremes>>,
    rows: Recorder<'a>,
    functionals: Vec<f64>,
    findings: Vec<Finding>,
}

/// Resolves a motion: its extremes, rows and functionals.
pub(crate) fn see<'a, G: Space<S = f64>>(
    motion: &mut Motion<'_, G>,
    case: Case<'a>,
    watched: &Watched,
    samples: usize,
    variable: Variable<'a>,
) -> Result<Seen<'a>, Lost> {
    motion.take_floors(case, &watched.ids);
    let mut resolved = motion.resolve()?;
    if motion.end_before_leaps()? {
        resolved = motion.resolve()?;
    }
    motion.all_defined(&resolved)?;
    let (breaks, clock, ends) = (motion.breaks.clone(), motion.clock, motion.ends);
    let extremes = extrema(motion, resolved.samples(), &breaks);
    let mut rows = Recorder::new(case, watched, clock, variable.name, variable);
    motion.rows(samples, &mut rows)?;
    let mut findings = unresolved(case.model, case.study, watched, &resolved, &motion.lost_switches, variable, clock);
    let mut all = Functionals { clock, ends, curve: motion, resolved: &resolved, extremes: &extremes, breaks: &breaks };
    let functionals = all.all(case, &watched.functionals, &mut findings)?;
    findings.extend(motion.driven.dynamics.unresolved_spring().map(|spring| energies::unresolved(case.model, spring)));
    Ok(Seen { resolved, extremes, rows, functionals, findings })
}

fn drives_angle<G: Space>(mechanism: &Mechanism<G>) -> bool {
    mechanism.drives.first().is_some_and(|d| d.turns)
}

/// Name of the independent variable: the first measure that is the driven coordinate, else its path, else `time`.
fn independent<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, clock: Clock) -> String {
    if !clock.is_driver() {
        return "time".into();
    }
    let model = case.model;
    let Some(driver) = model.drivers.first() else { return "time".into() };
    let joint = &model.joints[driver.joint];
    // a body turns as a joint of it on the ground does, but for where that counts from
    let from_drawn = joint.zero.is_none_or(|zero| case.value(zero) == 0.0);
    let turning_body = |q: &Quantity| {
        matches!(q, Quantity::Joint { joint: j, slot: 0, order: 0 } if *j == driver.joint)
            || matches!(q, Quantity::Angle { body, order: 0 } if from_drawn && joint.a.body == 0 && *body == joint.b.body)
    };
    let measure = model.measures.iter().find(|m| {
        model.pool.inputs_of(&[m.value])[..].iter().all(|&i| turning_body(&model.inputs[i as usize]))
            && matches!(model.pool.node(m.value), crate::expression::Node::Input(_))
    });
    let word = if drives_angle(mechanism) { "angle" } else { "position" };
    measure.map_or_else(|| format!("{}.{word}", joint.name), |m| m.name.clone())
}

/// How far the independent variable goes, in words, from its start to the dead points.
fn reach<G: Space<S = f64>>(motion: &Motion<'_, G>, name: &str, (size, unit): (f64, &str)) -> String {
    let (clock, from) = (motion.clock, motion.clock.value(0.0));
    let dead = dead_ends(motion).into_iter().map(|end| clock.value(end));
    let [above, below]: [Option<f64>; 2] = [1.0, -1.0].map(|sense| dead.clone().find(|x| sense * (x - from) > 0.0));
    let [far, near] = [above, below].map(|end| end.map(|x| if clock.is_driver() { x * size } else { x.abs() }));
    match (far, near, clock.is_driver()) {
        (Some(far), Some(near), true) => format!("{name} cannot go beyond {far:.6} {unit} nor below {near:.6} {unit}"),
        (Some(far), Some(near), false) => {
            format!("{name} cannot go beyond {far:.6} {unit}, nor the motion back from its start for more than {near:.6} {unit}")
        }
        (Some(far), None, _) => format!("{name} cannot go beyond {far:.6} {unit}"),
        (None, Some(near), true) => format!("{name} cannot go below {near:.6} {unit}"),
        (None, Some(near), false) => format!("the motion cannot go back from its start for more than {near:.6} {unit}"),
        (None, None, _) => format!("{name} cannot leave its start at {:.6} {unit}", from * size),
    }
}

/// Progress at the dead points: ahead, and back from the start.
fn dead_ends<G: Space<S = f64>>(motion: &Motion<'_, G>) -> Vec<f64> {
    let dead = &motion.path.dead;
    let [ahead, behind] = if motion.clock.end() < 0.0 { [&dead[0], &dead[1]] } else { [&dead[1], &dead[0]] };
    let end = |dead: &Option<_>, side: usize| dead.is_some().then(|| motion.ends[side]);
    [end(ahead, 1), end(behind, 0)].into_iter().flatten().collect()
}

/// What the motion itself shows: change points on the way.
fn findings<G: Space<S = f64>>(mechanism: &Mechanism<G>, motion: &Motion<'_, G>, name: &str, (size, unit): (f64, &str)) -> Vec<Finding> {
    let mut out = Vec::new();
    if mechanism.rows.len() > mechanism.nv {
        out.push(Finding {
            code: "redundant-constraints".into(),
            message: format!(
                "{} constraint rows for {} unknowns: {}; reactions of joints need not be, which a finding `reactions-not-unique` tells of those that a study shows",
                mechanism.rows.len(),
                mechanism.nv,
                if mechanism.pressings.is_empty() {
                    "motions and driver efforts are unique"
                } else {
                    "motions are unique, but not what follows from reactions: friction by a coefficient, and with it driver efforts"
                }
            ),
            path: "joints".into(),
        });
    }
    if motion.path.open.is_none() {
        let (clock, with) = (motion.clock, if motion.clock.end() < 0.0 { -1.0 } else { 1.0 });
        out.extend(dead_ends(motion).into_iter().map(|end| {
            let value = clock.value(end);
            let place = match (clock.is_driver(), value < 0.0) {
                (true, _) => format!("at {name} = {:.6} {unit}", value * size),
                (false, false) => format!("{value:.6} {unit} after the start"),
                (false, true) => format!("{:.6} {unit} before the start", -value),
            };
            let way = if with * end > 0.0 { "on the way of the drivers" } else { "against the way of the drivers" };
            let message = format!("{way} the motion ends at a dead point, {place}");
            Finding { code: "dead-point".into(), message, path: "drivers".into() }
        }));
    }
    out
}

/// That no place of the masses holds the centre of mass still; `residual` is how far it moves, m.
fn still_moves(case: Case<'_>, residual: f64, size: f64) -> Option<Finding> {
    (residual > STILL * size).then(|| Finding {
        code: "not-balanced".into(),
        message: format!(
            "the centre of mass still moves, by {} m at most from its middle: the masses that are moved cannot hold it, only keep it as still as they can",
            six_digits(residual)
        ),
        path: case.study.place.clone(),
    })
}

/// That velocities jump on the way, which takes impulses.
fn jumps<G: Space<S = f64>>(case: Case<'_>, motion: &mut Motion<'_, G>, name: &str, unit: (f64, &str)) -> Option<Finding> {
    let places = motion.jumps();
    let first = places.first()?;
    let others = if places.len() > 1 { format!(" and {} more places", places.len() - 1) } else { String::new() };
    let left_out = if matches!(case.study.kind, Kind::Inverse(_)) { "accelerations and forces" } else { "accelerations" };
    Some(Finding {
        code: "velocity-jump".into(),
        message: format!(
            "velocities jump at {name} = {} {}{others}: a law there has a kink, and {left_out} are impulses, which no row, extreme, mean or integral holds; a law without kinks has none, as a table `between: cubic`",
            six_digits(first * unit.0),
            unit.1
        ),
        path: case.study.place.clone(),
    })
}

/// That a negative range of a driver is followed back in time.
fn backwards<G: Space<S = f64>>(case: Case<'_>, motion: &Motion<'_, G>, name: &str, unit: (f64, &str)) -> Option<Finding> {
    let back = motion.clock.is_driver() && motion.clock.end() < 0.0;
    back.then(|| Finding {
        code: "backwards".into(),
        message: format!(
            "the range is negative: it is followed against the driver, back in time, to {name} = {} {}; a positive one goes the way of the driver",
            six_digits(motion.clock.value(motion.clock.length) * unit.0),
            unit.1
        ),
        path: case.study.place_of("over"),
    })
}

/// Residuals over the rows.
fn certificate<G: Space<S = f64>>(motion: &mut Motion<'_, G>, rows: &Recorder<'_>) -> Certificate {
    let mut certificate =
        Certificate { evaluations: rows.count(), switches: motion.breaks.len().saturating_sub(2), ..Certificate::default() };
    let mut nothing = vec![0.0; Curve::columns(motion)];
    for (s, piece) in rows.some_places(64) {
        if motion.eval(s, piece, &mut nothing).is_err() {
            continue;
        }
        let d = &motion.driven;
        let w = &d.dynamics.work;
        certificate.constraint = w.phi.iter().fold(certificate.constraint, |m, p| m.max(p.abs()));
        // dT/dt = Σ (I A + V×*I V)·V must be the power of what is applied, of efforts and of rows
        let m = d.dynamics.mechanism;
        let (mut change, mut applied, mut size) = (0.0, 0.0, 0.0);
        for node in &m.nodes {
            let twist = w.twists[node.body];
            let inertial = d.dynamics.inertial(node.body, d.reactions.accelerations[node.body]).power(twist);
            let force = w.applied[node.body].power(twist);
            change += inertial;
            applied += force;
            size += inertial.abs() + force.abs();
        }
        for rotor in &m.rotors {
            let r = &w.readings[rotor.gauge];
            change += rotor.inertia * r.rate * m.gauges[rotor.gauge].acceleration(r, &w.columns, &d.a);
        }
        for (effort, e) in m.efforts.iter().zip(&w.efforts) {
            let power = e * d.dynamics.swept(effort.along);
            applied += power;
            size += power.abs();
        }
        // rows that move with time
        for (nu, lambda) in w.nu.iter().zip(&d.lambda) {
            let power = -(lambda * nu);
            applied += power;
            size += power.abs();
        }
        let off = (change - applied).abs() / size;
        if off.is_finite() {
            certificate.power_balance = certificate.power_balance.max(off);
        }
    }
    certificate
}
