//! Why a mechanism stays open, in words: which loop, its gap, which joints share it, which exact values are in the way.

use super::close::System;
use super::fault::AssemblyFault;
use super::rotation::orientation;
use crate::geometry::Space;
use crate::mechanism::{Asked, Joint, Mechanism, Row, RowKind, RowOwner, Start, describe_loop};

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
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let mut parts = Vec::new();
        let mut place = String::from("start");
        let mut help = "check lengths and points, or give guesses in `start` that are nearer to an assembly".to_owned();
        for (index, joint) in m.joints.iter().enumerate() {
            let (mut gap, mut tilt) = (0.0_f64, 0.0_f64);
            for (row, phi) in m.rows.iter().zip(&w.phi).filter(|(r, _)| r.owner == RowOwner::Joint(index)) {
                if row.angular { tilt += phi * phi } else { gap += phi * phi }
            }
            if gap.sqrt() > 1e-9 * self.size || tilt.sqrt() > 1e-9 {
                let path = describe_loop(m, joint);
                let shared: Vec<&Joint<G>> = m.joints.iter().filter(|j| path.contains(&format!("-{}-", j.name))).collect();
                let others: Vec<&str> = shared.iter().map(|j| j.name.as_str()).collect();
                let too_long = too_long(m, &shared);
                if let Some((body, _)) = &too_long {
                    help = format!("make `{body}` shorter, or the others longer");
                }
                parts.push(format!(
                    "the loop {path} stays open at joint `{}` by {} mm and {} deg (joints {} share it){}",
                    joint.name,
                    short(gap.sqrt() * 1e3),
                    short(tilt.sqrt().to_degrees()),
                    others.join(", "),
                    too_long.map_or_else(String::new, |(_, words)| words)
                ));
                if place == "start" {
                    place = format!("joints.{}", joint.name);
                }
            }
        }
        for (row, phi) in m.rows.iter().zip(&w.phi) {
            if !row.anchored && !matches!(row.owner, RowOwner::Joint(_)) && phi.abs() > 1e-9 {
                let what = if matches!(row.owner, RowOwner::Coupling) { format!("coupling `{}`", row.label) } else { "a driver".into() };
                parts.push(format!("{what} stays off by {}", short(*phi)));
            }
        }
        AssemblyFault { code: "not-assembled", message: format!("the mechanism cannot be assembled: {}", parts.join("; ")), place, help }
    }

    /// The exact values that keep the mechanism open; evaluated at the nearest position without them.
    pub(super) fn explain_start(&self) -> AssemblyFault {
        let w = &self.dynamics.work;
        let of_position = |asked| matches!(asked, Asked::Gauge { order: 0, .. } | Asked::Orientation(_));
        let exact = |start: &&Start| !start.guess && of_position(start.asked);
        let starts: Vec<&Start> = self.dynamics.mechanism.starts.iter().filter(exact).collect();
        let list = |value: &dyn Fn(&Start) -> f64| -> String {
            starts.iter().map(|s| format!("{} = {}", s.name, short(value(s)))).collect::<Vec<_>>().join(", ")
        };
        let m = self.dynamics.mechanism;
        let found = |start: &Start| match start.asked {
            Asked::Gauge { gauge, .. } => w.readings[gauge].x,
            Asked::Orientation(k) => orientation::<G>(&m.orientations[k], start.value, w.places[m.orientations[k].body].r).0,
            Asked::Spin { .. } => 0.0,
        };
        let one = starts.len() == 1;
        AssemblyFault {
            code: "start-cannot-hold",
            message: format!(
                "no assembly has the exact start value{} {} (SI); one nearby has {}",
                if one { "" } else { "s" },
                list(&|s| s.value),
                list(&found)
            ),
            place: starts.last().map_or_else(|| "start".into(), |s| s.place.clone()),
            help: format!("put `~` before {}, so that it may give way, or check the lengths", if one { "it" } else { "one of them" }),
        }
    }
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
