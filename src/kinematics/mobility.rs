//! Degrees of freedom: the Grübler count, the numerical rank, redundant rows, and the Grashof class of four-bars.

use super::assemble::{Assembled, ChangePoint};
use super::crossing::at_start;
use super::freedom::{rows, undriven, unmoved, with_fewer_drivers};
use super::remaining::remaining;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, RowOwner};
use crate::model::{Kind, Model, Study};
use crate::results::Failure;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};
use std::f64::consts::{PI, TAU};

/// The mobility of a mechanism at its start.
#[derive(Clone, Debug, PartialEq)]
pub struct Mobility {
    /// Freedoms of the bodies minus what the joints and couplings take: Grübler's count, without what time moves.
    pub grubler: i64,
    /// Velocities minus the rank of joints and couplings: the real freedom, without drivers and couplings that time moves.
    pub freedom: usize,
    /// The same with the couplings that time moves, without drivers alone.
    pub undriven: usize,
    /// Freedom left with all of them.
    pub left: usize,
    /// Rank of all rows.
    pub rank: usize,
    /// Rows that depend on others, in words.
    pub redundant: Vec<String>,
}

/// Counts at the assembled start.
#[must_use]
pub fn mobility<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Mobility {
    let crossing = at_start(mechanism, start);
    let q = crossing.as_ref().map_or_else(|| beside(start), |crossing| &crossing.q);
    let rows = rows(mechanism, q, &start.modes, &start.metric);
    let undriven = undriven(mechanism, &rows, &start.metric);
    let moves = mechanism.rows.iter().any(|row| row.owner == RowOwner::Coupling && mechanism.is_moved(row));
    let freedom = if moves { unmoved(mechanism, &rows, &start.metric).mobility } else { undriven.mobility };
    let driven = Rank::new(&rows.0, &start.metric, &rows.1, RANK_TOLERANCE);
    let movers = mechanism.rows.iter().filter(|row| mechanism.is_moved(row)).count();
    Mobility {
        grubler: mechanism.nv as i64 - (mechanism.rows.len() - movers) as i64,
        freedom,
        undriven: undriven.mobility,
        left: driven.mobility,
        rank: driven.rank,
        redundant: driven.dependent.iter().map(|&r| mechanism.name_of_row(r)).collect(),
    }
}

/// Where rows are counted: in a change point they lose rank that they have everywhere else.
fn beside(start: &Assembled) -> &[f64] {
    start.change.as_ref().and_then(ChangePoint::beside).unwrap_or(&start.q)
}

/// Whether the drivers leave no freedom and do not contend for the same one.
pub(crate) fn drivers_fit<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    start: &Assembled,
    model: &Model,
    study: &Study,
) -> Result<(), Failure> {
    let m = mobility(mechanism, start);
    let drivers = mechanism.drives.len();
    if m.undriven < drivers {
        let names: Vec<String> = model.drivers.iter().map(|d| format!("`{}`", d.name)).collect();
        return Err(Failure::Study {
            code: "over-constrained",
            message: format!(
                "{drivers} driver{} ({}) for a mechanism of {} degree{} of freedom{}",
                plural(drivers),
                names.join(", "),
                m.undriven,
                plural(m.undriven),
                if m.undriven < m.freedom { " beside the couplings that time moves" } else { "" }
            ),
            place: "drivers".into(),
            help: with_fewer_drivers(m.undriven, &[]),
        });
    }
    if m.left > 0 {
        let loose = loose(mechanism);
        // what no joint holds moves in any case
        let remaining = loose.is_empty().then(|| {
            let q = beside(start);
            let (g, scale) = rows(mechanism, q, &start.modes, &start.metric);
            remaining(mechanism, q, start, &Rank::new(&g, &start.metric, &scale, RANK_TOLERANCE))
        });
        // the count of the joints is that of the drivers: only this place has more motions
        let in_line = drivers > 0 && loose.is_empty() && i64::try_from(drivers) == Ok(m.grubler);
        let kind = match study.kind {
            Kind::Kinematics(_) => "kinematics",
            Kind::Balance { .. } => "balance",
            _ => "inverse",
        };
        return Err(Failure::Study {
            code: "under-constrained",
            message: format!(
                "the mechanism has {} degree{} of freedom{} and {drivers} driver{}: {} left undetermined for a study of the kind `{kind}`{}{}",
                m.freedom,
                plural(m.freedom),
                match m.freedom - m.undriven {
                    0 => String::new(),
                    moved => format!(", {moved} of which couplings move over time,"),
                },
                plural(drivers),
                if m.left == 1 { "one is".into() } else { format!("{} are", m.left) },
                remaining.as_ref().map_or_else(|| in_no_joint(&loose), |remaining| remaining.words.clone()),
                if in_line {
                    format!("; Grübler's count is {drivers}: where links lie in a line, they can move as they do nowhere else")
                } else {
                    String::new()
                }
            ),
            place: if drivers == 0 { study.place.clone() } else { "drivers".into() },
            help: match (loose.first(), remaining.and_then(|remaining| remaining.help)) {
                _ if in_line => "begin where no links lie in a line; if they do not, add a driver, or a joint".into(),
                (Some(body), _) => format!("give `{body}` a joint, or remove it"),
                (None, Some(help)) => help,
                (None, None) => "add a driver, as `drivers: { drive: { joint: O, speed: 60 rpm } }`, or a joint".into(),
            },
        });
    }
    Ok(())
}

/// Names of the bodies that no joint leads to.
#[must_use]
pub fn loose<G: Space>(mechanism: &Mechanism<G>) -> Vec<&str> {
    let joined = |body: usize| mechanism.joints.iter().any(|j| j.a.0 == body || j.b.0 == body);
    (1..mechanism.bodies.len()).filter(|&b| !joined(b)).map(|b| mechanism.bodies[b].name.as_str()).collect()
}

/// `; body `rod` is in no joint`.
fn in_no_joint(loose: &[&str]) -> String {
    let names: Vec<String> = loose.iter().take(3).map(|name| format!("`{name}`")).collect();
    match loose.len() {
        0 => String::new(),
        1 => format!("; body {} is in no joint", names[0]),
        n => format!("; bodies {}{} are in no joint", names.join(", "), if n > 3 { ", ..." } else { "" }),
    }
}

fn plural(n: usize) -> &'static str {
    if n == 1 { "" } else { "s" }
}

/// Grashof's verdict on a planar four-bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Grashof {
    /// In words: crank-rocker, double-crank, double-rocker, change-point, triple-rocker.
    pub class: &'static str,
    /// Ground, input, coupler and output lengths, m, with the names of their bodies.
    pub links: [(String, f64); 4],
    /// Range of the input angle from the ground line, rad; none if it turns fully.
    pub range: Option<(f64, f64)>,
    /// The joint of the input, by its index.
    pub input: usize,
    /// The ranges of that joint's angle, rad: one through the line of the pivots, or one on either side of it; none if it turns fully.
    pub angles: Vec<[f64; 2]>,
}

impl Grashof {
    /// Counts the turns of the ranges so that they are those next to an angle, rad.
    pub(super) fn near(&mut self, angle: f64) {
        for [from, to] in &mut self.angles {
            let turns = TAU * ((angle - 0.5 * (*from + *to)) / TAU).round();
            (*from, *to) = (*from + turns, *to + turns);
        }
        self.angles.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
}

/// The class of a planar four-bar of revolute joints, its driven link as the input; none for any other mechanism.
#[must_use]
pub fn grashof<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Option<Grashof> {
    let m = mechanism;
    if G::VECTOR != 2 || m.bodies.len() != 4 || m.joints.len() != 4 || m.joints.iter().any(|j| j.kind != "revolute") {
        return None;
    }
    let of = |body: usize| -> Vec<usize> { (0..4).filter(|&j| m.joints[j].a.0 == body || m.joints[j].b.0 == body).collect() };
    if (0..4).any(|b| of(b).len() != 2) {
        return None;
    }
    let point = |joint: usize, body: usize| if m.joints[joint].a.0 == body { m.joints[joint].a.1 } else { m.joints[joint].b.1 };
    let length = |body: usize| {
        let [i, k] = of(body)[..] else { return 0.0 };
        let d = point(i, body) - point(k, body);
        G::dot(d, d).sqrt()
    };
    let other = |joint: usize, body: usize| if m.joints[joint].a.0 == body { m.joints[joint].b.0 } else { m.joints[joint].a.0 };
    let ground = of(0);
    let driven = m.drives.first().and_then(|d| ground.iter().copied().find(|&j| m.joints[j].slots.contains(&d.gauge)));
    let input_joint = driven.unwrap_or(ground[0]);
    let output_joint = ground.iter().copied().find(|j| *j != input_joint)?;
    let (input, output) = (other(input_joint, 0), other(output_joint, 0));
    let coupler = (1..4).find(|b| *b != input && *b != output)?;
    let links = [0, input, coupler, output].map(|b| (m.bodies[b].name.clone(), length(b)));
    let [g, a, b, c] = [links[0].1, links[1].1, links[2].1, links[3].1];
    let sorted = {
        let mut x = [g, a, b, c];
        x.sort_by(f64::total_cmp);
        x
    };
    let excess = sorted[0] + sorted[3] - sorted[1] - sorted[2];
    let scale = 1e-12 * sorted[3];
    let class = if excess.abs() <= scale {
        "change-point"
    } else if excess > 0.0 {
        "triple-rocker (no link turns fully)"
    } else if sorted[0] == a {
        "crank-rocker (the input turns fully)"
    } else if sorted[0] == g {
        "double-crank (drag link)"
    } else if sorted[0] == c {
        "rocker-crank (the output turns fully)"
    } else {
        "double-rocker (the coupler turns fully)"
    };
    // the diagonal from the input's end to the output's pivot must lie in [|b − c|, b + c]
    let cosine = |d: f64| (g * g + a * a - d * d) / (2.0 * g * a);
    let (near, far) = (cosine((b - c).abs()), cosine(b + c));
    let full = near >= 1.0 - 1e-12 && far <= -1.0 + 1e-12;
    let range = (!full).then(|| (near.clamp(-1.0, 1.0).acos(), far.clamp(-1.0, 1.0).acos()));
    // the line of the ground pivots in the world, that of the input in its body
    let between = |body: usize, joints: [usize; 2]| {
        let d = point(joints[1], body) - point(joints[0], body);
        G::component(d, 1).atan2(G::component(d, 0))
    };
    let far_joint = of(input).into_iter().find(|j| *j != input_joint)?;
    let line = between(0, [input_joint, output_joint]) - between(input, [input_joint, far_joint]);
    let sense = if m.joints[input_joint].a.0 == 0 { 1.0 } else { -1.0 };
    let sides = match range {
        None => vec![],
        Some((0.0, far)) => vec![[line - far, line + far]],
        Some((near, far)) if far >= PI => vec![[line + near, line + TAU - near]],
        Some((near, far)) => vec![[line + near, line + far], [line - far, line - near]],
    };
    let angles = sides.into_iter().map(|[a, b]| if sense > 0.0 { [a, b] } else { [-b, -a] }).collect();
    Some(Grashof { class, links, range, input: input_joint, angles })
}
