//! Equilibria in words: coordinates by their names, what falls, what stays unbalanced.

use super::pose::Pose;
use super::rest::Lost;
use super::search::{Ended, Found};
use crate::dynamics::Dynamics;
use crate::expression::Dimension;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::coordinates::{Coordinate, coordinates};
use crate::kinematics::held;
use crate::kinematics::held::settled;
use crate::kinematics::partition::{Partition, preferred};
use crate::kinematics::undefined::{in_state, without_direction};
use crate::mechanism::{Mechanism, Step};
use crate::model::Model;
use crate::results::{Failure, ShownIn, Unsolved, six_digits};
use crate::studies::common::case::Case;
use crate::studies::common::named::shown_in;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// The coordinates of a mechanism by their names, with the choice of independent ones.
pub(super) struct Names {
    pub(super) all: Vec<Coordinate>,
    /// Index in q of each; none for a part of a quaternion.
    pub(super) q: Vec<Option<usize>>,
    preferred: Vec<usize>,
    metric: Vec<f64>,
    /// Whether joints have friction, which does not count.
    has_friction: bool,
    has_stops: bool,
}

impl Names {
    /// Of a mechanism with the metric of its start.
    pub(super) fn new<G: Space<S = f64>>(model: &Model, m: &Mechanism<G>, metric: &[f64]) -> Self {
        let mut in_q = vec![None; m.nv];
        for step in &m.steps {
            if let Step::Axis { q, v, .. } = *step {
                in_q[v] = Some(q);
            }
        }
        Self {
            all: coordinates(model, m),
            q: in_q,
            preferred: preferred(m),
            metric: metric.to_vec(),
            has_friction: model.joints.iter().any(|j| j.friction.is_some()),
            has_stops: !m.stops.is_empty(),
        }
    }

    /// Independent velocities at a pose, which was evaluated last, and the motions P of the others with them.
    pub(super) fn partition<G: Space<S = f64>>(&self, dynamics: &Dynamics<'_, G>, pose: &Pose) -> Partition {
        let m = dynamics.mechanism;
        let g = DMatrix::from_row_slice(m.rows.len(), m.nv, &dynamics.work.g.to_dense());
        Partition::new(&g, &self.metric, &dynamics.row_scale(&pose.position.q, &pose.position.modes, &self.metric), &self.preferred)
    }

    /// The coordinate that a displacement (nv) moves most, lengths by the size.
    pub(super) fn most(&self, delta: &DVector<f64>, unit: &[f64]) -> &str {
        let size = |k: usize| delta[k].abs() / unit[k];
        // of equal ones the first
        let most = (0..delta.len()).fold(0, |best, k| if size(k) > size(best) * (1.0 + 1e-9) { k } else { best });
        self.all.get(most).map_or("", |c| &c.name)
    }

    /// The coordinates of some velocities.
    pub(super) fn coordinates(&self, of: &[usize]) -> Vec<Coordinate> {
        of.iter().map(|&k| self.all[k].clone()).collect()
    }

    /// The failure of a search whose best pose leaves `forces` on the independent coordinates `of` a mechanism of this size, m.
    pub(super) fn unbalanced(&self, of: &[Coordinate], forces: &[f64], size: f64, why: Ended, place: &str) -> Failure {
        let work = |i: usize| forces[i].abs() * if of[i].turns { 1.0 } else { size };
        let most = (0..of.len()).fold(0, |best, i| if work(i) > work(best) { i } else { best });
        let what = match of.get(most) {
            Some(c) => {
                format!("{} {} on `{}` stays unbalanced at best", six_digits(forces[most].abs()), if c.turns { "N m" } else { "N" }, c.name)
            }
            None => "nothing can move".into(),
        };
        let (how, help) = match why {
            Ended::Jump => (
                "the forces jump where the mechanism wants to stay",
                "smooth the jump, as with a `clamp` over a small range in the place of `sign` or of a condition",
            ),
            Ended::Away => (
                "the mechanism moves on and on",
                "hold it, by a joint, a driver, a spring or a stop; or take away the load or the motor in a variant",
            ),
            _ => (
                "no position near the start is in balance",
                "begin elsewhere with `start`, or see with a study of the kind `dynamics` and some damping where it comes to rest",
            ),
        };
        let friction =
            if self.has_friction { "; the friction of joints does not count here, where it may hold: see with `dynamics`" } else { "" };
        let stops = if self.has_stops {
            "; rigid stops do not hold here (`limits` with `restitution`): give them a `stiffness`, or see with `dynamics`"
        } else {
            ""
        };
        unsolved(format!("there is no equilibrium: {how}, {what}{friction}{stops}"), place, help)
    }

    /// The failure of a search that has gone through a rigid stop.
    pub(super) fn beyond(&self, joint: &str, place: &str) -> Failure {
        let message = format!("the mechanism comes to rest on the rigid stop of joint `{joint}`, which `statics` does not know");
        unsolved(message, place, "give `limits` a `stiffness` in the place of `restitution`; or hold the joint in a variant")
    }

    /// The failure of a search that has turned against a one-way clutch.
    pub(super) fn locked(&self, clutch: &str, place: &str) -> Failure {
        let message = format!("the mechanism is held on its way by {clutch}, which `statics` does not know");
        unsolved(message, place, "see with `dynamics` where it stays; or hold the joint, or take the clutch away, in a variant")
    }

    /// Why the start cannot be evaluated.
    pub(super) fn lost(&self, lost: Lost, place: &str) -> Failure {
        let (message, help) = match lost {
            Lost::NotFinite(k) => (
                format!("the force on `{}` is not a number at the start", self.all.get(k).map_or("", |c| &c.name)),
                "look at tables and expressions of loads and springs that act there",
            ),
            Lost::Open => {
                ("the constraints cannot be closed at the start".into(), "look at `grashof check`, which shows the start position")
            }
        };
        unsolved(message, place, help)
    }

    /// `stable`, or what falls, or what is not held; `unit` as in [`Names::most`].
    pub(super) fn verdict(&self, found: &Found, unit: &[f64]) -> String {
        let s = &found.stability;
        verdict(s.negative, s.zero, self.most(&(&found.pose.basis * &s.falls), unit))
    }
}

/// `stable`, or what falls, or what is not held, of so many motions that fall and that nothing holds; most of all along `motion`.
pub(super) fn verdict(negative: usize, zero: usize, motion: &str) -> String {
    match (negative, zero) {
        (0, 0) => "stable".into(),
        (1, _) => format!("unstable, it falls along `{motion}`"),
        (0, 1) => format!("indifferent, nothing holds `{motion}`"),
        (0, n) => format!("indifferent, nothing holds {n} motions, one of them along `{motion}`"),
        (n, _) => format!("unstable, it falls in {n} motions, most of all along `{motion}`"),
    }
}

/// `P.angle = -90 deg, S.position = 0.2 m` of independent coordinates, in the units that the model asks for.
pub(super) fn place(model: &Model, coordinates: &[Coordinate], values: &[f64]) -> String {
    const SHOWN: usize = 4;
    let unit = |dimension, plain: &str, size: f64| shown_in(model, dimension).unwrap_or_else(|| ShownIn { unit: plain.into(), size });
    let (angle, length) = (unit(Dimension::ANGLE, "deg", PI / 180.0), unit(Dimension::LENGTH, "m", 1.0));
    let value = |in_unit: &ShownIn, x: f64| format!("{} {}", six(x / in_unit.size), in_unit.unit);
    let of = |(c, x): (&Coordinate, &f64)| format!("{} = {}", c.name, value(if c.turns { &angle } else { &length }, *x));
    let shown: Vec<String> = coordinates.iter().zip(values).take(SHOWN).map(of).collect();
    let more = if coordinates.len() > SHOWN { ", ..." } else { "" };
    if shown.is_empty() { "no coordinate is free".into() } else { shown.join(", ") + more }
}

/// What is undefined at the start, if something is.
pub(super) fn undefined<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, start: &Assembled) -> Option<Failure> {
    let (rest, states) = (vec![0.0; start.v.len()], &mechanism.state_starts);
    let modes = settled(mechanism, [&start.q, &rest, states], &start.modes);
    let law = in_state(case.model, mechanism, [&start.q, &rest, states], &modes, "the start");
    law.or_else(|| without_direction(case.model, mechanism, held::Pose { q: &start.q, z: states, modes: &modes })).map(Failure::Undefined)
}

fn unsolved(message: String, place: &str, help: &str) -> Failure {
    Failure::Unsolved(Unsolved { message, place: place.into(), help: help.into() })
}

/// Six significant digits; what is round-off of ordinary lengths, angles and forces is 0.
pub(super) fn six(x: f64) -> String {
    let x = if x.abs() < 1e-12 { 0.0 } else { x };
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) { format!("{rounded:e}") } else { format!("{}", rounded + 0.0) }
}
