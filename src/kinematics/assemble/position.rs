//! The position of a start: the branch that guesses and exact values name, and on it the place nearest to them and to the drawn pose.

use super::close::{CONVERGED, Held, System};
use super::fault::AssemblyFault;
use super::metric::norm;
use super::nearest::MOST;
use super::rotation;
use super::shake::Shake;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Mechanism, RowKind, RowOwner, Step};
use crate::numerics::least_squares::{Rows, step};
use nalgebra::Matrix3;
use std::f64::consts::{PI, TAU};

/// Part by which another closing must come nearer to the guesses to count.
const NEARER: f64 = 1e-3;

/// Distance from the guesses, rad or sizes, from which on other branches are looked for.
const FAR: f64 = 0.1;

/// Places around the guesses from which other branches are looked for.
const LOOKS: u32 = 8;

/// Places near the guesses, and in mechanisms of up to [`MOST`] coordinates everywhere, from which a position is looked for where none is
/// found at once.
const NEAR: u32 = 8;
const EVERYWHERE: u32 = 24;

/// Coordinates and modes of the start.
///
/// # Errors
/// If constraints or exact values stay open.
pub(super) fn position<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Result<(Vec<f64>, Vec<i32>), AssemblyFault> {
    let mut system = System::new(mechanism);
    let mut q = mechanism.drawn();
    system.name(&mut q);
    system.turn_balls(&mut q);
    system.pull(&mut q);
    let guessed = q.clone();
    let mut closed = system.close(&mut q);
    if let Some(better) = system.by_guesses(&guessed, closed.then_some(&q)) {
        (q, closed) = (better, true);
    }
    // a guess in a singular position (a straight linkage) has no direction to go: look around it
    let mut shake = Shake(1);
    let mut open = (system.gap(&q), q.clone());
    for attempt in 1..=if mechanism.nv > MOST { NEAR } else { NEAR + EVERYWHERE } {
        if closed && system.faces() {
            break;
        }
        let mut trial = guessed.clone();
        let size = if attempt <= NEAR { 0.05 * f64::from(attempt) } else { PI * f64::from(attempt - NEAR) / f64::from(EVERYWHERE) };
        mechanism.retract(&mut trial, &system.shaken(&mut shake, size));
        closed = system.close(&mut trial);
        if closed {
            q = trial;
        } else {
            let gap = system.gap(&trial);
            if gap < (1.0 - NEARER) * open.0 {
                open = (gap, trial);
            }
        }
    }
    if !closed {
        // whom to blame: would it close if the exact values gave way? From where it is open least
        q = open.1;
        system.evaluate(&q);
        let (loops, couplings) = (system.open_loops(), system.open_couplings());
        system.held = Held::Nothing;
        // links in a line may stand where the gap is largest, and have no direction to go
        mechanism.retract(&mut q, &system.shaken(&mut shake, 0.2));
        if system.close(&mut q) {
            system.near_asked(&mut q);
            return Err(system.explain_start((&loops, &couplings)));
        }
        system.evaluate(&q);
        return Err(system.explain());
    }
    if !system.faces() {
        return Err(system.explain_facing());
    }
    system.look_around(&guessed, &mut q);
    let targets = system.targets.clone();
    system.settle(&mut q);
    system.look_nearer(&guessed, &targets, &mut q);
    system.unturn(&guessed, &targets, &mut q);
    system.sharpen(&mut q);
    snap(mechanism, &mut q);
    system.evaluate(&q);
    Ok((q, system.modes))
}

/// Free bodies begin at the orientation that is asked for.
pub(super) fn orient<G: Space<S = f64>>(m: &Mechanism<G>, q: &mut [f64]) {
    for asked in &m.orientations {
        let Some(node) = m.nodes.iter().find(|n| n.body == asked.body && n.parent == 0) else { continue };
        for step in &m.steps[node.steps.clone()] {
            if let Step::Ball { q: k, reversed: false, .. } = step {
                let unit = rotation::quaternion(&Matrix3::from_fn(|i, k| asked.matrix[i][k]));
                q[*k..k + 4].copy_from_slice(&[unit.w, unit.i, unit.j, unit.k]);
            }
        }
    }
}

/// Coordinates that were asked for exactly take the asked bits; the search left them within round-off.
fn snap<G: Space<S = f64>>(mechanism: &Mechanism<G>, q: &mut [f64]) {
    for start in mechanism.starts.iter().filter(|s| !s.guess) {
        let Asked::Gauge { gauge, order: 0 } = start.asked else { continue };
        if let Measured::Coordinate { along, .. } = mechanism.gauges[gauge].measured {
            q[along.q] = start.value;
        }
    }
}

impl<G: Space<S = f64>> System<'_, G> {
    /// Coordinates that are asked for take their values, and whole turns that these ask of others are made at once.
    fn name(&mut self, q: &mut [f64]) {
        let m = self.dynamics.mechanism;
        orient(m, q);
        self.take_named(q);
        let asked = m.starts.iter().filter_map(|s| match s.asked {
            Asked::Gauge { gauge, order: 0 } => Some((gauge, s.value, false)),
            _ => None,
        });
        let held = m.rows.iter().filter_map(|row| match (row.kind, row.owner) {
            (RowKind::Gauge(gauge), RowOwner::Joint(_)) => Some((gauge, row.offset, true)),
            _ => None,
        });
        let angles: Vec<_> = asked.chain(held).filter(|(gauge, ..)| m.gauges[*gauge].measured == Measured::Angle).collect();
        for (gauge, value, held) in angles {
            self.evaluate(q);
            let turns = (value - self.dynamics.work.readings[gauge].x) / TAU;
            // an asked angle that is less than a turn away is reached by the way
            let turns = if held { turns.round() } else { turns.trunc() };
            if turns != 0.0 {
                self.turn(q, gauge, turns);
            }
        }
    }

    /// Adds whole turns of the plane to the outermost hinge that a gauge depends on and nobody named.
    fn turn(&self, q: &mut [f64], gauge: usize, turns: f64) {
        let m = self.dynamics.mechanism;
        for &(column, sign) in m.gauges[gauge].columns.iter().rev() {
            for step in &m.steps {
                if let Step::Axis { u, turns: true, q: k, v, .. } = *step
                    && v == column
                    && self.named[v].is_none()
                {
                    q[k] += turns * sign * TAU * G::spin_component(u, 2).signum();
                    return;
                }
            }
        }
    }

    /// Pulls the drawn position towards all asked values.
    fn pull(&mut self, q: &mut [f64]) {
        for _ in 0..30 {
            self.evaluate(q);
            if norm(&self.missed()) < CONVERGED {
                break;
            }
            let (mut r, mut jacobian) = (Vec::new(), Rows::default());
            self.asked(false, &mut r, Some(&mut jacobian));
            r.iter_mut().for_each(|r| *r = -*r);
            let delta = self.bounded(step(0.0, &jacobian, &r, &self.metric, 1e-12));
            self.dynamics.mechanism.retract(q, &delta);
        }
    }

    /// The position that closes from where guesses held like exact values leave it, if it comes nearer to the guesses than `other`
    /// or there is no other.
    fn by_guesses(&mut self, from: &[f64], other: Option<&Vec<f64>>) -> Option<Vec<f64>> {
        // nothing comes nearer than what meets them
        if !self.guesses() || other.is_some_and(|other| self.miss(other) < CONVERGED) {
            return None;
        }
        let modes = self.modes.clone();
        let mut q = from.to_vec();
        self.held = Held::All;
        if !self.close(&mut q) {
            // a drawn position in which a link points straight away from its place has no direction to go
            let mut trial = from.to_vec();
            let way = self.shaken(&mut Shake(2), 0.2);
            self.dynamics.mechanism.retract(&mut trial, &way);
            if self.close(&mut trial) {
                q = trial;
            }
        }
        self.held = Held::Exact;
        let nearer = self.close(&mut q)
            && self.faces()
            && match other {
                Some(other) => {
                    let (mine, bound) = (self.miss(&q), self.miss(other));
                    self.evaluate(&q);
                    mine < (1.0 - NEARER) * bound - CONVERGED
                }
                None => true,
            };
        if !nearer {
            self.modes = modes;
            if let Some(other) = other {
                self.evaluate(other);
            }
        }
        nearer.then_some(q)
    }

    /// Looks for a branch that meets the guesses where `q` is far from them.
    fn look_around(&mut self, from: &[f64], q: &mut Vec<f64>) {
        if !self.guesses() || self.miss(q) < FAR {
            return;
        }
        let mut shake = Shake(3);
        for look in 0..LOOKS {
            let mut trial = from.to_vec();
            let way = self.shaken(&mut shake, 0.4 * f64::from(look + 1));
            self.dynamics.mechanism.retract(&mut trial, &way);
            if let Some(better) = self.by_guesses(&trial, Some(q)) {
                *q = better;
            }
        }
        self.evaluate(q);
    }

    /// Whether a position is guessed.
    pub(super) fn guesses(&self) -> bool {
        self.guessed() > 0
    }

    /// How many positions are guessed.
    pub(super) fn guessed(&self) -> usize {
        let of_position = |asked| matches!(asked, Asked::Gauge { order: 0, .. } | Asked::Orientation(_));
        self.dynamics.mechanism.starts.iter().filter(|s| s.guess && of_position(s.asked)).count()
    }

    /// How far a position is from all asked values.
    pub(super) fn miss(&mut self, q: &[f64]) -> f64 {
        self.evaluate(q);
        norm(&self.missed())
    }

    /// By how much the position evaluated last misses each asked value.
    pub(super) fn missed(&self) -> Vec<f64> {
        let mut r = Vec::new();
        self.asked(false, &mut r, None);
        r
    }

    /// Size of the residuals that hold, rad and sizes.
    pub(super) fn gap(&mut self, q: &[f64]) -> f64 {
        self.evaluate(q);
        let (mut r, mut jacobian) = (Vec::new(), Rows::default());
        self.hard(&mut r, &mut jacobian);
        norm(&r)
    }

    /// A displacement of at most this size, in rad and sizes.
    pub(super) fn shaken(&self, shake: &mut Shake, size: f64) -> Vec<f64> {
        self.metric.iter().map(|metric| shake.next() * size / metric.sqrt()).collect()
    }
}
