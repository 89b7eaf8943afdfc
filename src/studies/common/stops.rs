//! What joints with rigid stops and friction refuse: starts beyond a stop, driven motions into one, motions that jam, bristles
//! without a motion in time.

use super::case::Case;
use super::clock::{Variable, told_coordinate};
use super::motion::Motion;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::mechanism::{Contact, Mechanism, Stop};
use crate::model::{Kind, Model, Study};
use crate::numerics::continuous::Curve;
use crate::numerics::extremum::Extremes;
use crate::numerics::resolve::Resolved;
use crate::results::{Failure, Finding};

/// Part of the size of the mechanism (rad for angles) by which a stop may be passed: rounding, and the blows of a motion in time.
pub(crate) const PASSED: f64 = 1e-9;

/// A place within this part of the range of a switch is not judged by one side of it.
const BESIDE: f64 = 1e-7;

/// A part of the range so far from its start is no motion.
const BEGUN: f64 = 1e-7;

/// Refuses a start beyond a rigid stop.
///
/// # Errors
/// With the joint, its value and the stop.
pub(crate) fn begins<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, start: &Assembled) -> Result<(), Failure> {
    if mechanism.stops.is_empty() {
        return Ok(());
    }
    let mut dynamics = crate::dynamics::Dynamics::without_mass(mechanism);
    dynamics.time(0.0, &start.modes);
    dynamics.position(&start.q, &start.modes);
    for stop in mechanism.stops.iter().filter(|stop| stop.event.is_none()) {
        let x = dynamics.work.readings[stop.gauge].x;
        if stop.gap(x) < -PASSED * stop.size(start.size) {
            let joint = &model.joints[stop.joint];
            return Err(Failure::Study {
                code: "beyond-a-stop",
                message: format!(
                    "the start is beyond the {} of joint `{}`, at {} where {} is the end",
                    stop.word(),
                    joint.name,
                    told_coordinate(x, stop.angular),
                    told_coordinate(stop.at, stop.angular)
                ),
                place: format!("{}.limits", joint.place),
                help: "start between the stops, or move them".into(),
            });
        }
    }
    Ok(())
}

/// Refuses what a driven motion cannot have.
///
/// # Errors
/// Inverse dynamics of bristles, whose state only a motion in time knows.
pub(crate) fn driven<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, study: &Study) -> Result<(), Failure> {
    let bristle = mechanism.bristles.iter().position(Option::is_some).filter(|_| matches!(study.kind, Kind::Inverse(_)));
    bristle.map_or(Ok(()), |joint| {
        Err(Failure::Study {
            code: "bristles-in-inverse",
            message: format!("how far the bristles of joint `{}` are bent depends on the motion before", model.joints[joint].name),
            place: study.place.clone(),
            help: "ask for `dynamics`, which can drive the same motion, or give the friction a `stick_speed` instead of `bristle`".into(),
        })
    })
}

/// Where a driven motion stands still and friction may hold by any force up to its largest: nothing tells which.
pub(crate) fn dwells<G: Space<S = f64>>(
    study: &Study,
    variable: Variable<'_>,
    motion: &mut Motion<'_, G>,
    resolved: &Resolved,
) -> Vec<Finding> {
    let mechanism = motion.driven.dynamics.mechanism;
    let mut findings = Vec::new();
    if !matches!(study.kind, Kind::Inverse(_)) {
        return findings;
    }
    for contact in &mechanism.contacts {
        let Some((holds, pressing)) = contact.friction() else { continue };
        let still = |piece: &usize| motion.pieces[*piece][contact.mode] == 0;
        let places: Vec<(f64, usize)> = resolved.places.iter().copied().zip(resolved.pieces.iter().copied()).collect();
        let Some(&(from, piece)) = places.iter().find(|(_, piece)| still(piece)) else { continue };
        let to = places.iter().filter(|(_, p)| *p == piece).fold(from, |to, (s, _)| to.max(*s));
        if to <= from || motion.solve(0.5 * (from + to), Some(piece)).is_err() {
            continue;
        }
        let driven = &motion.driven;
        let normal = pressing.map_or(1.0, |pressing| driven.dynamics.pressing_force(pressing, &driven.lambda));
        let most = driven.dynamics.work.force_outputs[holds] * normal;
        let (from, to) = (motion.clock.value(from), motion.clock.value(to));
        let unit = if contact.angular { "N m" } else { "N" };
        findings.push(Finding {
            code: "friction-not-unique".into(),
            message: format!(
                "from {} to {} nothing slides and {} may be anything from {:.6} to {most:.6} {unit}: forces are given with 0 in its place",
                variable.at(from),
                variable.told(to),
                contact.name,
                -most
            ),
            path: contact.place.clone(),
        });
    }
    findings
}

/// Where the drivers keep both sides of a one-way clutch at one rate, so that it may carry any force in its sense: nothing tells which.
pub(crate) fn carries<G: Space<S = f64>>(
    study: &Study,
    variable: Variable<'_>,
    motion: &mut Motion<'_, G>,
    resolved: &Resolved,
    size: f64,
) -> Vec<Finding> {
    let mechanism = motion.driven.dynamics.mechanism;
    let mut findings = Vec::new();
    if !matches!(study.kind, Kind::Inverse(_)) {
        return findings;
    }
    let known = resolved.samples();
    let first = motion.columns() - mechanism.one_way().count();
    let speed = fastest(motion);
    for (k, clutch) in mechanism.one_way().enumerate() {
        let still = |rate: f64| rate.abs() <= PASSED * clutch.unit(size) * speed;
        let rests = |ends: &[(f64, f64)], motion: &mut Motion<'_, G>| {
            let [(from, before), (to, behind)] = ends else { return false };
            still(*before) && still(*behind) && from < to && still(rate_at(motion, 0.5 * (from + to), clutch))
        };
        let rates: Vec<(f64, f64)> = known.places.iter().copied().zip(known.column(first + k).iter().copied()).collect();
        let Some(begin) = rates.windows(2).position(|ends| rests(ends, motion)) else { continue };
        let more = rates[begin + 1..].windows(2).take_while(|ends| rests(ends, motion)).count();
        let [from, to] = [begin, begin + 1 + more].map(|at| motion.clock.value(rates[at].0));
        findings.push(Finding {
            code: "friction-not-unique".into(),
            message: format!(
                "from {} to {} the drivers keep both sides of {} at one rate, and it may carry anything in its sense: forces are given with 0 in its place",
                variable.at(from),
                variable.told(to),
                clutch.name
            ),
            path: clutch.place.clone(),
        });
    }
    findings
}

/// Contacts at rest whose motion other contacts, stops or drivers hold as well: what each of them carries is open.
pub(crate) fn shared_by_contacts<G: Space<S = f64>>(mechanism: &Mechanism<G>, open: &[usize]) -> Vec<Finding> {
    let contacts = mechanism.contacts.iter().enumerate().filter(|(c, _)| open.contains(c));
    let finding = |(_, contact): (usize, &Contact)| Finding {
        code: "friction-not-unique".into(),
        message: format!(
            "while {} {} is not unique: drivers, a rigid stop or other friction hold the same motion; what is printed is 0 or one of the values, of a stop and of drivers the rest",
            if contact.is_one_way() { "its sides go at one rate" } else { "it sticks" },
            contact.name
        ),
        path: contact.place.clone(),
    };
    contacts.map(finding).collect()
}

/// What a study of small deviations from a state [q, v] takes as free, though it may hold there: rigid stops that joints touch, and one-way
/// clutches that do not run free.
pub(crate) fn taken_as_free<G: Space<S = f64>>(
    model: &Model,
    mechanism: &Mechanism<G>,
    [q, v]: [&[f64]; 2],
    modes: &[i32],
    size: f64,
) -> Vec<Finding> {
    if mechanism.stops.is_empty() && mechanism.one_way().next().is_none() {
        return Vec::new();
    }
    let mut dynamics = crate::dynamics::Dynamics::without_mass(mechanism);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    dynamics.velocity(v, modes);
    let finding = |message: String, path: String| Finding { code: "taken-as-free".into(), message, path };
    let touched = |stop: &&Stop| stop.event.is_none() && stop.gap(dynamics.work.readings[stop.gauge].x) <= PASSED * stop.size(size);
    let stops = mechanism.stops.iter().filter(touched).map(|stop| {
        let joint = &model.joints[stop.joint];
        let message = format!(
            "joint `{}` stands on its {}, which lets it move one way only: it is taken as free to move both ways; where the stop holds it, drive the joint at rest in a variant",
            joint.name,
            stop.word()
        );
        finding(message, format!("{}.limits", joint.place))
    });
    let closed = |contact: &&Contact| dynamics.extent_rate(contact.along) <= PASSED * contact.unit(size);
    let clutches = mechanism.one_way().filter(closed).map(|contact| {
        let message = format!(
            "{} lets its parts turn one way only: it is taken as open; where it holds them, put a driver at rest or a `gear` of ratio 1 in its place in a variant",
            contact.name
        );
        finding(message, contact.place.clone())
    });
    stops.chain(clutches).collect()
}

/// What a driven motion cannot pass.
pub(crate) struct Barrier {
    /// The last place before it, in progress.
    pub(crate) at: f64,
    /// What it is, with its place.
    pub(crate) message: String,
}

/// Where a driven motion first meets a rigid stop, turns against a one-way clutch or, where forces are asked for, jams by friction, on its
/// way from the start.
///
/// `margins` are the extremes of the gaps of the stops and of the rates of one-way clutches over the motion.
///
/// # Errors
/// If that is at the start, so that there is no motion.
pub(crate) fn barrier<G: Space<S = f64>>(
    case: Case<'_>,
    variable: Variable<'_>,
    motion: &mut Motion<'_, G>,
    resolved: &Resolved,
    margins: &[Option<Extremes>],
    size: f64,
) -> Result<Option<Barrier>, Failure> {
    let mechanism = motion.driven.dynamics.mechanism;
    let joint = |index: usize| case.model.joints[index].name.as_str();
    let known = resolved.samples();
    let mut first: Option<(Barrier, &str)> = None;
    let mut offer = |at: f64, message: String, help: &'static str| {
        if first.as_ref().is_none_or(|(first, _)| at.abs() < first.at.abs()) {
            first = Some((Barrier { at, message }, help));
        }
    };
    let (gaps, rates) = margins.split_at(mechanism.stops.len());
    let first_margin = motion.columns() - margins.len();
    for (k, (stop, gap)) in mechanism.stops.iter().zip(gaps).enumerate() {
        let passed = |gap: f64| gap < -PASSED * stop.size(size);
        let Some(least) = gap.map(|e| e.min).filter(|least| stop.event.is_none() && passed(least.value)) else { continue };
        let column = known.column(first_margin + k);
        let beyond = column.iter().zip(known.places).filter(|(gap, _)| passed(**gap)).map(|(_, s)| *s).chain([least.at]);
        let Some([before, behind]) = nearest(beyond, known.places) else { continue };
        // what only touches before it passes has no gap to close
        let limit = if gap_at(motion, before, stop) > 0.0 { 0.0 } else { -PASSED * stop.size(size) };
        let at = last(before, behind, |s| gap_at(motion, s, stop) >= limit);
        let message = format!(
            "at {} the drivers move joint `{}` beyond its {} at {}: a rigid stop does not give way, as one with a `stiffness` does",
            variable.at(motion.clock.value(at)),
            joint(stop.joint),
            stop.word(),
            told_coordinate(stop.at, stop.angular)
        );
        offer(at, message, "drive it less far, or give the stop a `stiffness`");
    }
    let speed = fastest(motion);
    for (k, (clutch, rate)) in mechanism.one_way().zip(rates).enumerate() {
        let back = |rate: f64| rate < -PASSED * clutch.unit(size) * speed;
        let Some(least) = rate.map(|e| e.min).filter(|least| back(least.value)) else { continue };
        let column = known.column(first_margin + gaps.len() + k);
        let turned = column.iter().zip(known.places).filter(|(rate, _)| back(**rate)).map(|(_, s)| *s).chain([least.at]);
        let Some([before, behind]) = nearest(turned, known.places) else { continue };
        let at = last(before, behind, |s| rate_at(motion, s, clutch) >= 0.0);
        let message =
            format!("at {} the drivers turn back against {}, which locks there", variable.at(motion.clock.value(at)), clutch.name);
        offer(at, message, "drive it as the clutch lets it turn, drive one of its sides alone, or take the clutch away in a variant");
    }
    if matches!(case.study.kind, Kind::Inverse(_)) && !mechanism.pressings.is_empty() {
        // where a joint changes its side it presses by nothing, on either
        let range = motion.ends[1] - motion.ends[0];
        let breaks = motion.breaks.clone();
        let changes = |s: f64| breaks.iter().any(|b| (s - b).abs() <= BESIDE * range);
        let places = resolved.places.iter().copied().zip(resolved.pieces.iter().copied()).filter(|(s, _)| !changes(*s));
        let jammed: Vec<f64> = places.filter(|(s, piece)| jams(motion, *s, *piece)).map(|(s, _)| s).collect();
        if let Some([before, behind]) = nearest(jammed.into_iter(), &resolved.places) {
            let at = last(before, behind, |s| !jams(motion, s, motion.piece_at(s)));
            let names: Vec<String> = mechanism.pressings.iter().map(|p| format!("`{}`", joint(p.joint))).collect();
            let message = format!(
                "at {} no reactions obey the law of friction of {}: the joint jams (Painlevé's paradox)",
                variable.at(motion.clock.value(at)),
                names.join(", ")
            );
            offer(at, message, "give a smaller `coulomb`, a longer guide, or drive the motion from the other side");
        }
    }
    match first {
        Some((Barrier { at, message }, help)) if at.abs() <= BEGUN * motion.clock.length => Err(Failure::numerical(message, help)),
        first => Ok(first.map(|(barrier, _)| barrier)),
    }
}

/// The largest velocity of a motion, in units of angles and of the mechanism's size.
fn fastest<G: Space<S = f64>>(motion: &Motion<'_, G>) -> f64 {
    motion.path.nodes.iter().map(|node| motion.driven.measure(&node.v)).fold(0.0, f64::max)
}

/// The known place before the nearest of some on the way from the start, and that one: those ahead count first.
fn nearest(places: impl Iterator<Item = f64>, known: &[f64]) -> Option<[f64; 2]> {
    let order = |a: &f64, b: &f64| (*a < 0.0, a.abs()).partial_cmp(&(*b < 0.0, b.abs())).unwrap_or(std::cmp::Ordering::Equal);
    let behind = places.min_by(order)?;
    let nearer = known.iter().filter(|s| s.signum() == behind.signum() && s.abs() < behind.abs());
    Some([nearer.copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0), behind])
}

/// The last place from one at which a condition holds towards another at which it does not.
fn last(mut before: f64, mut behind: f64, mut holds: impl FnMut(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (before + behind);
        if holds(middle) { before = middle } else { behind = middle }
    }
    before
}

/// How far a stop is; not a number where that is not known.
fn gap_at<G: Space<S = f64>>(motion: &mut Motion<'_, G>, s: f64, stop: &Stop) -> f64 {
    let piece = motion.piece_at(s);
    let reached = motion.solve(s, Some(piece));
    reached.map_or(f64::NAN, |()| stop.gap(motion.driven.dynamics.work.readings[stop.gauge].x))
}

/// How fast a one-way clutch runs free; not a number where that is not known.
fn rate_at<G: Space<S = f64>>(motion: &mut Motion<'_, G>, s: f64, clutch: &Contact) -> f64 {
    let piece = motion.piece_at(s);
    let reached = motion.solve(s, Some(piece));
    reached.map_or(f64::NAN, |()| motion.driven.dynamics.extent_rate(clutch.along))
}

fn jams<G: Space<S = f64>>(motion: &mut Motion<'_, G>, s: f64, piece: usize) -> bool {
    motion.solve(s, Some(piece)).is_ok() && motion.driven.jams()
}
