//! One run of a kinematic study: build, assemble, trace, resolve, extremes, functionals, rows, scalars, expectations.

use super::assemble::Assembled;
use super::balance::Unbalanced;
use super::clock::Clock;
use super::extremum::{Extremes, extrema};
use super::functional::Functionals;
use super::mobility::drivers_fit;
use super::motion::{Lost, Motion, Rows};
use super::numbers::Sources;
use super::observe::Observer;
use super::outcome::{Certificate, Failure, Finding, Outcome};
use super::path::{MOST_NODES, NoPath};
use super::resolve::Resolved;
use super::undefined::{Gap, assembled, blank};
use super::{balance, contact, forward, linearize, modes, periodic, scene, statics};
use crate::dynamics::{Dynamics, LANES};
use crate::expression::Id;
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::{Coordinates, Mechanism};
use crate::model::{Dimensions, Functional, FunctionalKind, Kind, Model, Over, Quantity, Range, ShownWhat, Study};
use crate::scalar::Dual;

/// Runs the study of a model once, at given parameter values (in file order).
///
/// # Errors
/// If it never began: the model has no mechanism, it cannot be assembled, or its drivers do not fit. A motion that stops on its
/// way is an [`Outcome`] with `stopped`. A motion in time asks `stop` between its steps, and takes its coordinates from the study.
pub fn run(
    model: &Model,
    study: &Study,
    parameters: &[f64],
    coordinates: Coordinates,
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Failure> {
    match model.space {
        Dimensions::Planar => run_in::<Planar<f64>>(model, study, parameters, coordinates, stop),
        Dimensions::Spatial => run_in::<Spatial<f64>>(model, study, parameters, coordinates, stop),
    }
}

fn run_in<G>(
    model: &Model,
    study: &Study,
    parameters: &[f64],
    coordinates: Coordinates,
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
    G::Lift<Dual<LANES>>: Space<S = Dual<LANES>>,
{
    match &study.kind {
        Kind::Kinematics(range) | Kind::Inverse(range) | Kind::Balance { range, .. } => {
            driven::<G>(model, study, range, parameters, coordinates)
        }
        Kind::Dynamics(motion) => forward::run::<G>(model, study, motion, parameters, stop),
        Kind::Statics => statics::run::<G>(model, study, parameters, stop),
        Kind::Modes(asked) => modes::run::<G>(model, study, asked, parameters, stop),
        Kind::Linearize(asked) => linearize::run::<G>(model, study, asked, parameters, stop),
        Kind::Periodic(asked) => periodic::run::<G>(model, study, asked, parameters, stop),
    }
}

/// A study of a motion that its drivers prescribe.
fn driven<G: Space<S = f64>>(
    model: &Model,
    study: &Study,
    range: &Range,
    parameters: &[f64],
    coordinates: Coordinates,
) -> Result<Outcome, Failure> {
    let (mut mechanism, start) = prepared::<G>(model, study, parameters, coordinates)?;
    let mut results = Vec::new();
    if let Kind::Balance { moved, .. } = &study.kind {
        let observer = Observer::new(model, &mechanism, parameters, &[]);
        let mut motion =
            trace((model, study), &mechanism, &start, clock(model, &mechanism, &start, range, parameters, study)?, observer, 0)?;
        let refused =
            |message: String, help: &str| Failure::Study { code: "balance", message, place: study.place.clone(), help: help.into() };
        let offsets = balance::balance(&mut motion, moved).map_err(|why| match why {
            Unbalanced::NoLine(message) => refused(message, "name masses that are attached away from the origin of bodies that move"),
            Unbalanced::Lost(Lost { at, gap: Some(gap) }) => {
                Failure::Undefined(gap.told(model, study, &format!("{} = {at}", independent(model, &mechanism, motion.clock))))
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
    }
    observe(model, study, parameters, &mechanism, &start, range, results)
}

/// The mechanism at the start of a study whose motion its drivers prescribe.
///
/// # Errors
/// Why the study cannot begin.
pub(super) fn prepared<G: Space<S = f64>>(
    model: &Model,
    study: &Study,
    parameters: &[f64],
    coordinates: Coordinates,
) -> Result<(Mechanism<G>, Assembled), Failure> {
    let (mechanism, start) = assembled::<G>(model, parameters, coordinates)?;
    drivers_fit(&mechanism, &start, model, study)?;
    contact::begins(model, &mechanism, &start)?;
    contact::driven(model, &mechanism, study)?;
    Ok((mechanism, start))
}

/// The motion over the range of a clock.
///
/// # Errors
/// Why it cannot begin.
pub(super) fn trace<'m, G: Space<S = f64>>(
    (model, study): (&Model, &Study),
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
            NoPath::Undefined(gap) => Failure::Undefined(gap.told(model, study, "the start")),
        }
    })
}

/// The independent variable of a range.
pub(super) fn clock<G: Space<S = f64>>(
    model: &Model,
    mechanism: &Mechanism<G>,
    start: &Assembled,
    range: &Range,
    parameters: &[f64],
    study: &Study,
) -> Result<Clock, Failure> {
    let fault =
        |message: String, help: &str| Failure::Study { code: "range", message, place: format!("{}.over", study.place), help: help.into() };
    match range.over {
        Over::Time(id) => {
            let length = model.pool.value(id, parameters);
            if length.is_finite() && length != 0.0 {
                Ok(Clock::of_time(length))
            } else {
                Err(fault(format!("the range is {length} s"), "give a time, as `over: 2 s`"))
            }
        }
        Over::Driver(id) => {
            let length = model.pool.value(id, parameters);
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
            Clock::of_driver(&mut dynamics, &mut modes, drive.output, from, length)
                .map_err(|e| fault(e.0, "give the range as a time, as `over: 2 s`"))
        }
    }
}

/// The distinct expressions to watch: columns, what functionals are taken of, what only figures show.
pub(super) struct Watched {
    pub(super) ids: Vec<Id>,
    /// Index in `ids` of each functional's argument.
    pub(super) functionals: Vec<usize>,
    /// Index in `ids` of each column.
    pub(super) columns: Vec<usize>,
    /// Index in `ids` of curves that figures show beyond the columns.
    pub(super) shown: Vec<usize>,
}

impl Watched {
    /// The scalars or expectations for which a column is watched, in words.
    fn asked(&self, model: &Model, study: &Study, column: usize) -> String {
        let functional = |&k: &usize| self.functionals[k] == column;
        let takes = |id: Id| {
            let inputs = model.pool.inputs_of(&[id]);
            inputs.iter().any(|&i| matches!(model.inputs[i as usize], Quantity::Functional(k) if functional(&k)))
        };
        let scalars = study.scalars.iter().filter(|s| takes(s.value)).map(|s| format!("`{}`", s.name));
        let names: Vec<String> = scalars.chain(study.expect.iter().filter(|e| takes(e.value)).map(|e| format!("`{}`", e.text))).collect();
        if names.is_empty() { "a figure".into() } else { names.join(", ") }
    }

    pub(super) fn of(study: &Study) -> Self {
        let mut ids: Vec<Id> = Vec::new();
        let mut index = |id: Id| {
            ids.iter().position(|x| *x == id).unwrap_or_else(|| {
                ids.push(id);
                ids.len() - 1
            })
        };
        let columns = study.columns.iter().map(|c| index(c.value)).collect();
        let functionals = study.functionals.iter().map(|f| index(f.of)).collect();
        let shown = extra_curves(study).into_iter().map(&mut index).collect();
        Self { ids, functionals, columns, shown }
    }
}

/// Expressions that only figures show, in the order in which [`Outcome::rows`] carries them behind the columns.
#[must_use]
pub fn extra_curves(study: &Study) -> Vec<Id> {
    let mut extra = Vec::new();
    for shown in study.plots.iter().flat_map(|p| p.show.iter().chain(&p.over)) {
        if let ShownWhat::Column(id) = shown.what
            && study.columns.iter().all(|c| c.value != id)
            && !extra.contains(&id)
        {
            extra.push(id);
        }
    }
    extra
}

fn observe<G: Space<S = f64>>(
    model: &Model,
    study: &Study,
    parameters: &[f64],
    mechanism: &Mechanism<G>,
    start: &Assembled,
    range: &Range,
    mut results: Vec<f64>,
) -> Result<Outcome, Failure> {
    let watched = Watched::of(study);
    let observer = Observer::new(model, mechanism, parameters, &watched.ids);
    let clock = clock(model, mechanism, start, range, parameters, study)?;
    let mut motion = trace((model, study), mechanism, start, clock, observer, watched.ids.len())?;
    let name = independent(model, mechanism, clock);
    let told = |gap: &Gap, at: f64| gap.told(model, study, &format!("{name} = {}", (at * 1e6).round() / 1e6 + 0.0));
    let mut undefined = motion.path.gap.take().map(|gap| told(&gap, clock.value(motion.ends[1])));
    let seen = loop {
        match see(&mut motion, (model, study, parameters), &watched, range.samples, &name) {
            Ok(seen) => break seen,
            Err(Lost { at, gap: None }) => {
                let message = format!("the position at {name} = {at} could not be reached");
                return Err(Failure::numerical(message, "start elsewhere, change the lengths, or give a shorter range"));
            }
            Err(Lost { at, gap: Some(gap) }) => {
                let Some(Lost { at, gap: behind }) = motion.end_before(at) else { return Err(Failure::Undefined(told(&gap, at))) };
                undefined = Some(told(&behind.unwrap_or(gap), at));
            }
        }
    };
    let Seen { resolved, extremes, rows, functionals, findings: open } = seen;
    contact::passes((model, study, &name), &mut motion, &resolved, &extremes[watched.ids.len()..], start.size)?;
    let n = rows.places.len();
    let mut findings: Vec<Finding> = start.findings().chain(findings(mechanism, &motion)).collect();
    findings.extend(open);
    findings.extend(contact::dwells(study, &name, &mut motion, &resolved));

    let complete = motion.path.dead == [None, None];
    let stopped = (!complete && undefined.is_none()).then(|| {
        let at = clock.value(motion.ends[1]);
        if let Some(row) = motion.path.open {
            return format!(
                "{name} cannot go beyond {at:.6}: the constraints contradict each other there, {} cannot be met with the others; drivers and couplings that hold the same motion must agree at all times, remove one of them",
                mechanism.name_of_row(row)
            );
        }
        let mover = if mechanism.drives.is_empty() { "coupling" } else { "driver" };
        let unit = if clock.is_driver() && drives_angle(mechanism) {
            (180.0 / std::f64::consts::PI, "deg")
        } else {
            (1.0, if clock.is_driver() { "m" } else { "s" })
        };
        format!(
            "{name} cannot go beyond {:.6} {} nor below {:.6} {}: dead point, the links are in a line there and the {mover} cannot move them on",
            at.max(clock.value(motion.ends[0])) * unit.0,
            unit.1,
            at.min(clock.value(motion.ends[0])) * unit.0,
            unit.1
        )
    });
    if results.is_empty() && study.results.iter().any(|r| r.name == "turns_fully") {
        results.push(if complete && undefined.is_none() { 1.0 } else { 0.0 });
    }
    let sources = Sources { model, study, parameters, tables: &mechanism.tables, functionals: &functionals, results: &results, works: &[] };
    let numbers = sources.numbers(undefined.is_none());
    let undefined = undefined.or(numbers.undefined);
    let order: Vec<usize> = watched.columns.iter().chain(&watched.shown).copied().collect();
    let places: Vec<f64> = rows.places.iter().map(|s| clock.value(*s)).collect();
    let shown: Vec<Vec<f64>> = rows.values.iter().map(|r| order.iter().map(|&c| r[c]).collect()).collect();
    findings.extend(numbers.findings);
    findings.extend(blank(study, &name, &places, &shown));
    Ok(Outcome {
        stopped: undefined.as_ref().map(|u| u.message.clone()).or(stopped),
        undefined,
        parameters: model.parameters.iter().zip(parameters).map(|(p, x)| (p.name.clone(), *x)).collect(),
        independent: name,
        places,
        switches: (0..n.saturating_sub(1)).filter(|&i| rows.pieces[i] != rows.pieces[i + 1]).collect(),
        rows: shown,
        results,
        scalars: numbers.scalars,
        extremes: watched.columns.iter().map(|&c| extremes[c].map(|e| in_variable(e, clock))).collect(),
        expectations: numbers.expectations,
        findings,
        certificate: Certificate { resolved: Some(resolved.quality()), ..certificate(&mut motion, &rows) },
        events: Vec::new(),
        scenes: vec![(scene::MECHANISM.into(), scene::of_motion(&mut motion))],
        ..Outcome::default()
    })
}

/// What is seen of a motion.
pub(super) struct Seen {
    resolved: Resolved,
    extremes: Vec<Option<Extremes>>,
    rows: Rows,
    functionals: Vec<f64>,
    findings: Vec<Finding>,
}

/// Resolves a motion: its extremes, rows and functionals.
pub(super) fn see<G: Space<S = f64>>(
    motion: &mut Motion<'_, G>,
    (model, study, parameters): (&Model, &Study, &[f64]),
    watched: &Watched,
    samples: usize,
    name: &str,
) -> Result<Seen, Lost> {
    let resolved = motion.resolve()?;
    motion.all_defined(&resolved)?;
    let (breaks, clock, ends) = (motion.breaks.clone(), motion.clock, motion.ends);
    let extremes = extrema(motion, resolved.samples(), &breaks);
    let rows = motion.rows(samples)?;
    let mut findings = unresolved(model, study, watched, &resolved, &motion.lost_switches, name, clock);
    let mut all = Functionals { clock, ends, curve: motion, resolved: &resolved, extremes: &extremes, breaks: &breaks };
    let functionals = all.all(model, study, parameters, &watched.functionals, &mut findings)?;
    Ok(Seen { resolved, extremes, rows, functionals, findings })
}

/// Extremes by the independent variable instead of progress.
pub(super) fn in_variable(mut e: Extremes, clock: Clock) -> Extremes {
    e.min.at = clock.value(e.min.at);
    e.max.at = clock.value(e.max.at);
    e
}

fn drives_angle<G: Space>(mechanism: &Mechanism<G>) -> bool {
    mechanism.drives.first().is_some_and(|d| d.turns)
}

/// Name of the independent variable: the first measure that is the driven coordinate, else its path, else `time`.
fn independent<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, clock: Clock) -> String {
    if !clock.is_driver() {
        return "time".into();
    }
    let Some(driver) = model.drivers.first() else { return "time".into() };
    let joint = &model.joints[driver.joint];
    let turning_body = |q: &Quantity| {
        matches!(q, Quantity::Joint { joint: j, slot: 0, order: 0 } if *j == driver.joint)
            || matches!(q, Quantity::Angle { body, order: 0 } if joint.a.body == 0 && *body == joint.b.body)
    };
    let measure = model.measures.iter().find(|m| {
        model.pool.inputs_of(&[m.value])[..].iter().all(|&i| turning_body(&model.inputs[i as usize]))
            && matches!(model.pool.node(m.value), crate::expression::Node::Input(_))
    });
    let word = if drives_angle(mechanism) { "angle" } else { "position" };
    measure.map_or_else(|| format!("{}.{word}", joint.name), |m| m.name.clone())
}

/// Columns and switches that are not resolved within the effort that they are worth.
pub(super) fn unresolved(
    model: &Model,
    study: &Study,
    watched: &Watched,
    resolved: &Resolved,
    switches: &[(usize, f64)],
    name: &str,
    clock: Clock,
) -> Vec<Finding> {
    let finding = |message: String| Finding { code: "unresolved", message, path: study.place.clone() };
    // a value at a place does not depend on what is between
    let single = |f: &Functional| matches!(f.kind, FunctionalKind::Value | FunctionalKind::Last);
    let counts = |column: usize| {
        watched.columns.iter().chain(&watched.shown).any(|&c| c == column)
            || watched.functionals.iter().zip(&study.functionals).any(|(&c, f)| c == column && !single(f))
    };
    let columns = resolved.open.iter().filter(|open| counts(open.column)).map(|open| {
        let column = study.columns.iter().find(|c| c.value == watched.ids[open.column]).map(|c| format!("column `{}`", c.name));
        let what = column.unwrap_or_else(|| format!("what {} is taken of", watched.asked(model, study, open.column)));
        let at = clock.value(open.at);
        finding(match open.singular {
            true => format!(
                "{what} cannot be computed next to the singular position at {name} = {at:.6}, which multiplies the errors of the state: a straight line was taken there for extremes, means and integrals"
            ),
            false => format!("{what} varies too fast or without bound near {name} = {at:.6}: there its extremes, means and integrals may be wrong"),
        })
    });
    let switches = switches.iter().map(|&(switch, at)| {
        let text = model.pool.switches().get(switch).map_or("a guide's side", |s| s.text.as_str());
        finding(format!("the switch `{text}` changes too often near {name} = {at:.6} to be followed: some of its changes may be missing"))
    });
    columns.chain(switches).collect()
}

/// What the motion itself shows: change points on the way.
fn findings<G: Space<S = f64>>(mechanism: &Mechanism<G>, motion: &Motion<'_, G>) -> Vec<Finding> {
    let mut out = Vec::new();
    if mechanism.rows.len() > mechanism.nv {
        out.push(Finding {
            code: "redundant-constraints",
            message: format!(
                "{} constraint rows for {} unknowns: motions and driver efforts are unique, single reactions may be those of least size",
                mechanism.rows.len(),
                mechanism.nv
            ),
            path: "joints".into(),
        });
    }
    if let (Some(t), None) = (motion.path.dead.iter().flatten().next(), motion.path.open) {
        out.push(Finding {
            code: "dead-point",
            message: format!("the motion ends at a dead point at t = {} s", t.0),
            path: "drivers".into(),
        });
    }
    out
}

/// Residuals over the rows.
fn certificate<G: Space<S = f64>>(motion: &mut Motion<'_, G>, rows: &Rows) -> Certificate {
    let mut certificate =
        Certificate { evaluations: rows.places.len(), switches: motion.breaks.len().saturating_sub(2), ..Certificate::default() };
    let mut nothing = vec![0.0; rows.values.first().map_or(0, Vec::len)];
    let every = (rows.places.len() / 64).max(1);
    for (s, piece) in rows.places.iter().zip(&rows.pieces).step_by(every) {
        use super::continuous::Curve;
        if motion.eval(*s, *piece, &mut nothing).is_err() {
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
