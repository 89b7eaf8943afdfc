//! Why a mechanism stays open, in words: which loop, its gap, which joints share it, which exact values are in the way.

use super::close::System;
use super::fault::AssemblyFault;
use super::rotation::orientation;
use crate::geometry::Space;
use crate::mechanism::{Asked, Joint, Mechanism, Row, RowKind, RowOwner, Start, describe_loop};

/// A start value below this, rad or m, is told as 0.
pub(super) const ROUND_OFF: f64 = 1e-12;

impl<G: Space<S = f64>> System<'_, G> {
    pub(super) fn explain_facing(&self) -> AssemblyFault {
        let joint = self.wrong_way().unwrap_or(0);
        let joint = &self.dynamics.mechanism.joints[joint];
        AssemblyFault {
            code: "not-assembled",
            message: format!("joint `{}` can only be closed from this guess with its axes the wrong way round", joint.name),
            place: format!("joints.{}", joint.name),
            help: "give guesses in `start` for the orientations of the bodies in its loop".into(),
        }
    }

    /// The loops and exact values that stay open at the position evaluated last.
    pub(super) fn explain(&self) -> AssemblyFault {
        let loops = self.open_loops();
        let mut parts: Vec<String> = loops.iter().map(OpenLoop::words).collect();
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        for (index, (row, phi)) in m.rows.iter().zip(&w.phi).enumerate() {
            if row.anchored || matches!(row.owner, RowOwner::Joint(_)) || phi.abs() <= 1e-9 {
                continue;
            }
            parts.push(match m.drives.iter().find(|drive| drive.row == index) {
                Some(drive) => {
                    format!("driver `{}` stays off by {}", drive.name, written(phi.abs(), if row.angular { "rad" } else { "m" }))
                }
                None => format!("coupling `{}` stays off by {}", row.label, short(*phi)),
            });
        }
        let long = loops.iter().rev().find_map(|open| open.too_long.as_ref());
        AssemblyFault {
            code: "not-assembled",
            message: format!("the mechanism cannot be assembled: {}", parts.join("; ")),
            place: loops.first().map_or_else(|| "start".to_owned(), |open| format!("joints.{}", open.joint)),
            help: long.map_or_else(
                || "check lengths and points, or give guesses in `start` that are nearer to an assembly".to_owned(),
                |(body, _)| format!("make `{body}` shorter, or the others longer"),
            ),
        }
    }

    /// The loops that stay open at the position evaluated last.
    pub(super) fn open_loops(&self) -> Vec<OpenLoop> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let mut found = Vec::new();
        for (index, joint) in m.joints.iter().enumerate() {
            let (mut gap, mut tilt) = (0.0_f64, 0.0_f64);
            for (row, phi) in m.rows.iter().zip(&w.phi).filter(|(r, _)| r.owner == RowOwner::Joint(index)) {
                if row.angular { tilt += phi * phi } else { gap += phi * phi }
            }
            let (gap, tilt) = (gap.sqrt(), tilt.sqrt());
            if gap > 1e-9 * self.size || tilt > 1e-9 {
                let path = describe_loop(m, joint);
                let shared: Vec<&Joint<G>> = m.joints.iter().filter(|j| path.contains(&format!("-{}-", j.name))).collect();
                let sharers = shared.iter().map(|j| j.name.clone()).collect();
                found.push(OpenLoop { joint: joint.name.clone(), path, sharers, gap, tilt, too_long: too_long(m, &shared) });
            }
        }
        // the widest first
        found.sort_by(|a, b| (b.gap / self.size).hypot(b.tilt).total_cmp(&(a.gap / self.size).hypot(a.tilt)));
        found
    }

    /// Names of the couplings that do not hold at the position evaluated last.
    pub(super) fn open_couplings(&self) -> Vec<String> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let off = m.rows.iter().zip(&w.phi).filter(|(row, phi)| row.owner == RowOwner::Coupling && phi.abs() > 1e-9);
        off.map(|(row, _)| format!("`{}`", row.label)).collect()
    }

    /// The exact values that keep the mechanism open; evaluated at the nearest position without them. `open` are the loops and the
    /// couplings that they leave open.
    pub(super) fn explain_start(&self, (loops, couplings): (&[OpenLoop], &[String])) -> AssemblyFault {
        let w = &self.dynamics.work;
        let of_position = |asked| matches!(asked, Asked::Gauge { order: 0, .. } | Asked::Orientation(_));
        let exact = |start: &&Start| !start.guess && of_position(start.asked);
        let starts: Vec<&Start> = self.dynamics.mechanism.starts.iter().filter(exact).collect();
        let m = self.dynamics.mechanism;
        let list = |value: &dyn Fn(&Start) -> f64| -> String {
            starts.iter().map(|s| format!("{} = {}", s.name, written(value(s), unit(m, s.asked)))).collect::<Vec<_>>().join(", ")
        };
        let found = |start: &Start| {
            let x = match start.asked {
                Asked::Gauge { gauge, .. } => w.readings[gauge].x,
                Asked::Orientation(k) => orientation::<G>(&m.orientations[k], start.value, w.places[m.orientations[k].body].r).0,
                Asked::Spin { .. } => 0.0,
            };
            // round-off of a value that is zero
            if x.abs() < ROUND_OFF { 0.0 } else { x }
        };
        let begins = |gauge: usize| {
            let drives = |row: &&Row<G>| !row.anchored && matches!(row.kind, RowKind::Driver { gauge: own, .. } if own == gauge);
            m.rows.iter().position(|row| drives(&row)).map(|row| m.name_of_row(row))
        };
        let driven = starts.iter().find_map(|start| match start.asked {
            Asked::Gauge { gauge, .. } if (found(start) - start.value).abs() > 1e-9 => Some((*start, begins(gauge)?)),
            _ => None,
        });
        if let Some((start, driver)) = driven {
            let [wanted, own] = [start.value, found(start)].map(|x| written(x, unit(m, start.asked)));
            return AssemblyFault {
                code: "start-cannot-hold",
                message: format!("the law of {driver} begins at {} = {own}, where the start says {wanted}", start.name),
                place: start.place.clone(),
                help: "leave it out of the start, or let the law begin with it".into(),
            };
        }
        let one = starts.len() == 1;
        let all = couplings.join(" and ");
        let (coupling, holds) = if couplings.len() == 1 { ("coupling", "holds") } else { ("couplings", "hold") };
        let open = match (loops.first(), couplings.is_empty()) {
            (Some(open), true) => format!(", with which the loop {} does not close", open.path),
            (Some(open), false) => format!(", with which the loop {} does not close where the {coupling} {all} {holds}", open.path),
            (None, true) => String::new(),
            (None, false) => format!(", with which the {coupling} {all} cannot hold"),
        };
        let checked = match (loops.first(), couplings.is_empty()) {
            (_, false) => format!("check the {coupling} {all}"),
            (Some(_), true) => "check the lengths".to_owned(),
            (None, true) => "remove it: joints, drivers or other values fix it already".to_owned(),
        };
        AssemblyFault {
            code: "start-cannot-hold",
            message: format!(
                "no assembly has the exact start value{} {}{}; one nearby has {}",
                if one { "" } else { "s" },
                list(&|s| s.value),
                open,
                list(&found)
            ),
            place: starts.last().map_or_else(|| "start".into(), |s| s.place.clone()),
            help: format!("put `~` before {}, so that it may give way, or {checked}", if one { "it" } else { "one of them" }),
        }
    }
}

/// A loop that stays open.
pub(super) struct OpenLoop {
    /// The joint at which it does.
    joint: String,
    /// Bodies and joints around it, in words.
    path: String,
    /// Names of the joints that share it.
    sharers: Vec<String>,
    /// By how much, m and rad.
    gap: f64,
    tilt: f64,
    /// A body that is longer than all others together, with the sentence that says so.
    too_long: Option<(String, String)>,
}

impl OpenLoop {
    fn words(&self) -> String {
        format!(
            "the loop {} stays open at joint `{}` by {} mm and {} deg (joints {} share it){}",
            self.path,
            self.joint,
            short(self.gap * 1e3),
            short(self.tilt.to_degrees()),
            self.sharers.join(", "),
            self.too_long.as_ref().map_or("", |(_, words)| words)
        )
    }
}

/// A start value in the units of drawings: degrees, else SI.
fn written(x: f64, unit: &str) -> String {
    if unit == "rad" { format!("{} deg", short(x.to_degrees())) } else { format!("{} {unit}", short(x)) }
}

/// The body of a loop of hinges that is longer between its two than all others together, so that no position closes the loop,
/// with the sentence that says so.
fn too_long<G: Space<S = f64>>(m: &Mechanism<G>, hinges: &[&Joint<G>]) -> Option<(String, String)> {
    if hinges.len() < 2 || !hinges.iter().all(|j| matches!(j.kind, "revolute" | "spherical" | "universal")) {
        return None;
    }
    let end = |j: &Joint<G>, body: usize| [&j.a, &j.b].into_iter().find(|end| end.0 == body).map(|end| end.1);
    let mut bodies: Vec<usize> = hinges.iter().flat_map(|j| [j.a.0, j.b.0]).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let mut lengths = Vec::new();
    for body in bodies {
        let [from, to] = hinges.iter().filter_map(|j| end(j, body)).collect::<Vec<_>>()[..] else { return None };
        let along = to - from;
        lengths.push((m.bodies[body].name.as_str(), G::dot(along, along).sqrt()));
    }
    let total: f64 = lengths.iter().map(|(_, length)| length).sum();
    let (name, longest) = *lengths.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let others: Vec<String> = lengths.iter().filter(|l| l.0 != name).map(|(name, length)| format!("`{name}` {}", short(*length))).collect();
    (longest > (total - longest) * (1.0 + 1e-12)).then(|| {
        let words = format!(
            ": `{name}` is {} m long between its joints, more than the others together, {} = {} m",
            short(longest),
            others.join(" + "),
            short(total - longest)
        );
        (name.to_owned(), words)
    })
}

/// Four significant digits, for sentences.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e6).contains(&x.abs()) {
        let digits = if x == 0.0 { 1 } else { (4 - 1 - x.abs().log10().floor() as i32).clamp(0, 9) as usize };
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
    } else {
        format!("{x:.3e}")
    }
}

/// Unit of a start value.
pub(super) fn unit<G: Space>(m: &Mechanism<G>, asked: Asked) -> &'static str {
    match asked {
        Asked::Spin { .. } => "rad/s",
        Asked::Orientation(_) => "rad",
        Asked::Gauge { gauge, order } => match (m.gauges[gauge].turns(), order) {
            (true, 0) => "rad",
            (true, _) => "rad/s",
            (false, 0) => "m",
            (false, _) => "m/s",
        },
    }
}

/// Unit of the rate of a row; none for a coupling by an expression.
pub(super) fn unit_of_rate<G: Space>(m: &Mechanism<G>, row: usize) -> &'static str {
    match &m.rows[row] {
        Row { kind: RowKind::Function(_), .. } => "",
        Row { angular: true, .. } => "rad/s",
        _ => "m/s",
    }
}
