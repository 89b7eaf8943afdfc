//! Why a mechanism stays open, in words: which loop, its gap, which joints share it, which exact values are in the way.

use super::AssemblyFault;
use super::close::System;
use super::found::orientation;
use crate::geometry::Space;
use crate::mechanism::{Asked, Mechanism, Row, RowKind, RowOwner, Start, describe_loop};

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
        for (index, joint) in m.joints.iter().enumerate() {
            let (mut gap, mut tilt) = (0.0_f64, 0.0_f64);
            for (row, phi) in m.rows.iter().zip(&w.phi).filter(|(r, _)| r.owner == RowOwner::Joint(index)) {
                if row.angular { tilt += phi * phi } else { gap += phi * phi }
            }
            if gap.sqrt() > 1e-9 * self.size || tilt.sqrt() > 1e-9 {
                let path = describe_loop(m, joint);
                let others: Vec<&str> =
                    m.joints.iter().filter(|j| path.contains(&format!("-{}-", j.name))).map(|j| j.name.as_str()).collect();
                parts.push(format!(
                    "the loop {path} stays open at joint `{}` by {} mm and {} deg (joints {} share it)",
                    joint.name,
                    short(gap.sqrt() * 1e3),
                    short(tilt.sqrt().to_degrees()),
                    others.join(", ")
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
        AssemblyFault {
            code: "not-assembled",
            message: format!("the mechanism cannot be assembled: {}", parts.join("; ")),
            place,
            help: "check lengths and points, or give guesses in `start` that are nearer to an assembly".into(),
        }
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
            Asked::Orientation(k) => orientation::<G>(&m.orientations[k], start.value, w.poses[m.orientations[k].body].r).0,
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
