//! What joints with rigid stops and friction refuse: starts beyond a stop, driven motions into one, motions that jam, bristles
//! without a motion in time.

use super::case::Case;
use super::motion::Motion;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::mechanism::Mechanism;
use crate::model::{Kind, Model, Study};
use crate::numerics::continuous::Curve;
use crate::numerics::extremum::Extremes;
use crate::numerics::resolve::Resolved;
use crate::results::{Failure, Finding};

/// Part of the size of the mechanism (rad for angles) by which a stop may be passed: rounding, and the blows of a motion in time.
pub(crate) const PASSED: f64 = 1e-9;

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
                    "the start is beyond the {} of joint `{}`, at {x:.6} where {:.6} is the end",
                    stop.word(),
                    joint.name,
                    stop.at
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
pub(crate) fn dwells<G: Space<S = f64>>(study: &Study, name: &str, motion: &mut Motion<'_, G>, resolved: &Resolved) -> Vec<Finding> {
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
                "from {name} = {from:.6} to {to:.6} nothing slides and {} may be anything from {:.6} to {most:.6} {unit}: forces are given with 0 in its place",
                contact.name, -most
            ),
            path: contact.place.clone(),
        });
    }
    findings
}

/// Refuses a driven motion that passes a rigid stop or, where forces are asked for, jams by friction.
///
/// `gaps` are the extremes of the gaps of the stops over the motion.
///
/// # Errors
/// With the joint and the place; `name` is the independent variable.
pub(crate) fn passes<G: Space<S = f64>>(
    case: Case<'_>,
    name: &str,
    motion: &mut Motion<'_, G>,
    resolved: &Resolved,
    gaps: &[Option<Extremes>],
    size: f64,
) -> Result<(), Failure> {
    let Case { model, study, .. } = case;
    let mechanism = motion.driven.dynamics.mechanism;
    let joint = |index: usize| model.joints[index].name.as_str();
    for (k, (stop, gap)) in mechanism.stops.iter().zip(gaps).enumerate() {
        let beyond = |gap: f64| gap < -PASSED * stop.size(size);
        let Some(least) = gap.map(|e| e.min).filter(|least| stop.event.is_none() && beyond(least.value)) else { continue };
        // the first place that is known to lie beyond says more than the farthest one
        let known = resolved.samples();
        let first = known.column(motion.columns() - mechanism.stops.len() + k).iter().position(|gap| beyond(*gap));
        let (s, piece) = first.map_or((least.at, least.piece), |i| (known.places[i], known.pieces[i]));
        let reached = motion.solve(s, Some(piece));
        let x = reached.map_or(f64::NAN, |()| motion.driven.dynamics.work.readings[stop.gauge].x);
        let message = format!(
            "at {name} = {:.6} the drivers move joint `{}` to {x:.6}, beyond its {} at {:.6}: a rigid stop does not give way",
            motion.clock.value(s),
            joint(stop.joint),
            stop.word(),
            stop.at
        );
        return Err(Failure::numerical(message, "drive it less far, or give the stop a `stiffness`"));
    }
    if !matches!(study.kind, Kind::Inverse(_)) || mechanism.pressings.is_empty() {
        return Ok(());
    }
    for (&s, &piece) in resolved.places.iter().zip(&resolved.pieces) {
        if motion.solve(s, Some(piece)).is_ok() && motion.driven.jams() {
            let at = motion.clock.value(s);
            let names: Vec<String> = mechanism.pressings.iter().map(|p| format!("`{}`", joint(p.joint))).collect();
            let message = format!(
                "at {name} = {at:.6} no reactions obey the law of friction of {}: the joint jams (Painlevé's paradox)",
                names.join(", ")
            );
            let help = "give a smaller `coulomb`, a longer guide, or drive the motion from the other side";
            return Err(Failure::numerical(message, help));
        }
    }
    Ok(())
}
