//! A mechanism that stands still, for whoever reads its workspace: forces, poses of bodies, what tells equilibria apart.

use crate::expression::Id;
use crate::geometry::Space;
use crate::mechanism::{Measured, Step, StretchOf};
use crate::results::Finding;
use crate::studies::common::case::Case;
use crate::studies::dynamics::system::Mechanical;
use grashof_solvers::{Stage, State, System, Tangent, Terms};
use nalgebra::DVector;

/// Residual of a closed constraint, in units of the mechanism's size.
pub(super) const CLOSED: f64 = 1e-12;

/// Where a mechanism stands at rest, and what holds it.
#[derive(Clone, Debug)]
pub(super) struct Position {
    /// Coordinates (nq).
    pub(super) q: Vec<f64>,
    /// First-order states (nz).
    pub(super) z: Vec<f64>,
    /// ż (nz): not 0 where a state finds no rest.
    pub(super) drift: Vec<f64>,
    /// Modes of switches and windings.
    pub(super) modes: Vec<i32>,
    /// λ (rows).
    pub(super) lambda: Vec<f64>,
}

/// A mechanism that stands still at time 0, by itself (Φ(q) = 0 and Gᵀλ = f(q, v = 0, z)) or held.
#[derive(Clone, Debug)]
pub(crate) struct Still {
    /// Coordinates (nq).
    pub(crate) q: Vec<f64>,
    /// First-order states (nz).
    pub(crate) z: Vec<f64>,
    /// Modes of the switches and windings there.
    pub(crate) modes: Vec<i32>,
    /// What a reader should know of it.
    pub(crate) findings: Vec<Finding>,
}

/// Why there is no pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lost {
    /// The constraints cannot be closed from there.
    Open,
    /// The force on this velocity is not a number.
    NotFinite(usize),
}

/// A mechanism that rests: evaluates positions.
pub(super) struct Rest<'m, G: Space<S = f64>> {
    pub(super) system: Mechanical<'m, G>,
    /// Characteristic length, m.
    pub(super) size: f64,
    /// What counts as a whole way of each velocity: 1 rad, or the size (nv).
    pub(super) unit: Vec<f64>,
    pub(super) state: State,
    pub(super) terms: Terms,
    pub(super) tangent: Tangent,
    /// Velocities and accelerations (nv).
    pub(super) zeros: Vec<f64>,
    /// Whether a descent has led across a change point.
    pub(super) crossed: bool,
}

impl<'m, G> Rest<'m, G>
where
    G: Space<S = f64>,
{
    /// A system of a characteristic length, m.
    pub(super) fn new(system: Mechanical<'m, G>, size: f64) -> Self {
        let dims = system.dims();
        let unit = system.pattern().size_v.clone();
        let (state, terms, tangent) = (State::new(dims), Terms::new(dims, system.pattern()), Tangent::new(system.pattern()));
        Self { size, unit, state, terms, tangent, zeros: vec![0.0; dims.v], crossed: false, system }
    }

    /// Holds contacts where they stand, rad or m.
    pub(super) fn hold(&mut self, live: &[f64]) {
        self.state.live.copy_from_slice(live);
    }

    /// The state at a pose.
    pub(super) fn state(&mut self, position: &Position) -> State {
        self.show(position);
        self.state.clone()
    }

    /// Largest part of a displacement (nv), in radians or sizes.
    pub(super) fn measure(&self, delta: &DVector<f64>) -> f64 {
        delta.iter().zip(&self.unit).fold(0.0, |m, (d, u)| f64::max(m, d.abs() / u))
    }

    /// What tells apart two equilibria: poses of the bodies and stretches of the springs, lengths by the size.
    pub(super) fn signature(&mut self, position: &Position) -> Vec<f64> {
        self.show(position);
        let d = &self.system.dynamics;
        let mut out = Vec::new();
        for p in d.poses() {
            out.extend((0..9).map(|i| G::entry(p.r, i / 3, i % 3)));
            out.extend((0..G::VECTOR).map(|i| G::component(p.p, i) / self.size));
        }
        for stretch in &d.mechanism.stretches {
            let turns = match stretch.of {
                StretchOf::Gauge(g) => match d.mechanism.gauges[g].measured {
                    Measured::Angle | Measured::Turn { .. } => true,
                    Measured::Coordinate { along, .. } => along.turns,
                    _ => false,
                },
                StretchOf::Function(_) => false,
            };
            out.push(d.extent(stretch.of) / if turns { 1.0 } else { self.size });
        }
        out
    }

    /// Takes a position as the state.
    pub(super) fn stand_at(&mut self, position: &Position) {
        self.state.q.copy_from_slice(&position.q);
        self.state.z.copy_from_slice(&position.z);
        self.state.modes.copy_from_slice(&position.modes);
    }

    /// Evaluates a position for whoever reads the workspace: quantities of the columns, outlines.
    pub(super) fn show(&mut self, position: &Position) {
        self.stand_at(position);
        self.system.observe(&self.state.at(), &self.zeros, &position.lambda);
    }

    /// Largest |Φ| at a pose, m or rad.
    pub(super) fn open(&mut self, position: &Position) -> f64 {
        self.show(position);
        self.system.dynamics.work.phi.iter().fold(0.0, |m, p| f64::max(m, p.abs()))
    }

    /// A joint that lies beyond one of its rigid stops, of which the search knows nothing.
    pub(super) fn beyond(&mut self, case: Case<'_>, position: &Position) -> Option<usize> {
        self.show(position);
        let d = &self.system.dynamics;
        let value = |id: Option<Id>, none: f64| id.map_or(none, |id| case.value(id));
        case.model.joints.iter().zip(&d.mechanism.joints).position(|(joint, of)| {
            let (Some(stops), Some(&gauge)) = (&joint.stops, of.slots.first()) else { return false };
            let x = d.work.readings[gauge].x;
            let slack = 1e-9 * (1.0 + x.abs());
            x < value(stops.from, f64::NEG_INFINITY) - slack || x > value(stops.to, f64::INFINITY) + slack
        })
    }

    /// The one-way clutch against which the mechanism has moved from one position to another, by its place among the contacts.
    pub(super) fn back(&mut self, from: &Position, to: &Position) -> Option<usize> {
        let m = self.system.dynamics.mechanism;
        m.one_way().next()?;
        let [before, after] = [from, to].map(|position| {
            self.show(position);
            m.contacts.iter().map(|contact| self.system.dynamics.extent(contact.along)).collect::<Vec<_>>()
        });
        let back = |c: &usize| after[*c] < before[*c] - 1e-9 * m.contacts[*c].unit(self.size).max(before[*c].abs());
        (0..m.contacts.len()).filter(|c| m.contacts[*c].is_one_way()).find(back)
    }

    /// How far the quaternions of a pose are turned from those of another, as rotation vectors in the turned body (nv), rad;
    /// 0 for other velocities.
    pub(super) fn turned(&self, from: &Position, to: &Position) -> Vec<f64> {
        let mut out = vec![0.0; self.unit.len()];
        let quaternion = |q: &[f64]| nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
        for step in &self.system.dynamics.mechanism.steps {
            if let Step::Ball { q, v, .. } = *step {
                let between = quaternion(&from.q[q..]).conjugate() * quaternion(&to.q[q..]);
                let turn = nalgebra::UnitQuaternion::from_quaternion(between).scaled_axis();
                out[v..v + 3].copy_from_slice(turn.as_slice());
            }
        }
        out
    }

    /// Evaluates the terms at the state.
    pub(super) fn evaluate(&mut self, stage: Stage) {
        self.system.terms(self.state.at(), stage, &mut self.terms);
    }

    /// Largest |Φ|, lengths by the size.
    pub(super) fn gap(&self) -> f64 {
        let rows = &self.system.dynamics.mechanism.rows;
        let scaled = self.terms.phi.iter().zip(rows).map(|(p, r)| p.abs() / if r.angular { 1.0 } else { self.size });
        scaled.fold(0.0, |m, x| if x > m || x.is_nan() { x } else { m })
    }

    /// The position of the state evaluated last.
    pub(super) fn position(&self, lambda: Vec<f64>) -> Position {
        let State { q, z, modes, .. } = &self.state;
        Position { q: q.clone(), z: z.clone(), drift: self.terms.zdot.clone(), modes: modes.clone(), lambda }
    }

    /// Takes the modes that the position at hand has.
    pub(super) fn take_modes(&mut self) {
        let mut next = self.state.modes.clone();
        self.system.modes(self.state.at(), &mut next);
        self.state.modes = next;
    }

    /// The first velocity whose force at the state evaluated last is not a number.
    pub(super) fn undefined(&self) -> Option<usize> {
        self.terms.force.iter().position(|f| !f.is_finite())
    }
}

/// √Σ x².
pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
