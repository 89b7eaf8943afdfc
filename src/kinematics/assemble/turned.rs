//! Bodies in space whose orientation follows from the joints on them alone: of the assemblies that meet the start, the one in which they
//! are turned least from how they are drawn.
//!
//! A closing moves from the drawn pose by short steps, but where places and lengths leave several orientations, as those of a platform on
//! six rods do, it may end at a far one. What holds the drawn orientations as well as everything else, in least squares, begins nearer.

use super::close::{Drawn, Held, System, Target};
use super::metric::norm;
use super::rotation;
use super::rotation::spin;
use super::shake::Shake;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step};
use crate::numerics::least_squares::Rows;
use std::f64::consts::FRAC_PI_4;

/// Joints on a body from which on they decide how it is turned: with less it points from one of them to the other.
const JOINTS: usize = 3;

/// Angle, rad, from which on another assembly may be meant.
const FAR: f64 = FRAC_PI_4;

/// What a guess may be missed by, rad or sizes, to count as met beside how bodies are turned.
const MET: f64 = 0.5;

/// Places around the drawn pose from which an assembly is looked for.
const LOOKS: u32 = 4;

/// Part by which another assembly must be nearer to count.
const NEARER: f64 = 1e-3;

/// Bodies that turn freely but for the joints on them, and whose orientation no start value names.
fn unnamed<G: Space<S = f64>>(m: &Mechanism<G>) -> Vec<usize> {
    let joints = |body: usize| m.joints.iter().filter(|j| j.a.0 == body || j.b.0 == body).count();
    let named = |body: usize| m.orientations.iter().any(|o| o.body == body);
    let turns = |steps: &[Step<G>]| steps.iter().any(|step| matches!(step, Step::Ball { .. }));
    let nodes = m.nodes.iter().filter(|n| turns(&m.steps[n.steps.clone()]));
    nodes.map(|n| n.body).filter(|body| !named(*body) && joints(*body) >= JOINTS).collect()
}

/// The rotation vector (rad) of each body from how it is drawn, at the position evaluated last.
fn turned<G: Space<S = f64>>(dynamics: &Dynamics<'_, G>, drawn: &[Drawn]) -> Vec<f64> {
    let of = |(body, drawn): &Drawn| rotation::vector(&(drawn.transpose() * rotation::matrix::<G>(dynamics.work.places[*body].r)));
    drawn.iter().flat_map(|drawn| of(drawn).iter().copied().collect::<Vec<_>>()).collect()
}

/// The largest angle of rotation vectors, rad.
fn largest(vectors: &[f64]) -> f64 {
    vectors.chunks(3).map(norm).fold(0.0, f64::max)
}

/// Bodies that nobody has turned and that stand turned by a large angle from how they are drawn, with that angle, rad.
pub(super) fn far<G: Space<S = f64>>(m: &Mechanism<G>, q: &[f64], modes: &[i32]) -> Vec<(usize, f64)> {
    let bodies = unnamed(m);
    if bodies.is_empty() {
        return Vec::new();
    }
    let mut dynamics = Dynamics::without_mass(m);
    let drawn = as_drawn(&mut dynamics, &bodies);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    let angles = turned(&dynamics, &drawn);
    let far = bodies.into_iter().zip(angles.chunks(3).map(norm));
    far.filter(|(_, angle)| *angle > FAR).collect()
}

/// That a body stands far from how it is drawn.
pub(super) fn message(body: &str, angle: f64) -> String {
    format!(
        "`start` does not say how body `{body}` is turned, and the joints on it turn it by {:.0} deg from how it is drawn: if another assembly is meant, guess it, as `{body}.rpy: [~0 deg, ~0 deg, ~0 deg]`",
        angle.to_degrees()
    )
}

/// How bodies are drawn.
fn as_drawn<G: Space<S = f64>>(dynamics: &mut Dynamics<'_, G>, bodies: &[usize]) -> Vec<Drawn> {
    let m = dynamics.mechanism;
    let mut modes = m.modes();
    dynamics.follow_time(0.0, &mut modes);
    dynamics.position(&m.drawn(), &modes);
    bodies.iter().map(|&body| (body, rotation::matrix::<G>(dynamics.work.places[body].r))).collect()
}

impl<G: Space<S = f64>> System<'_, G> {
    /// Residual and Jacobian of the orientations that are held as drawn.
    pub(super) fn upright(&self, r: &mut Vec<f64>, jacobian: &mut Rows) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        for (body, drawn) in &self.upright {
            let found = rotation::matrix::<G>(w.places[*body].r);
            let theta = rotation::vector(&(drawn.transpose() * found));
            let slope = rotation::slope(&theta) * found.transpose();
            for i in 0..3 {
                r.push(theta[i]);
                jacobian.push(m.road(m.bodies[*body].column).map(|k| (k, (slope * spin(&w.columns[k]))[i])));
            }
        }
    }

    /// Looks for an assembly in which bodies that nobody has turned stand nearer to how they are drawn than in the closed position `q`, where
    /// one of them is far from that; `from` is where the search began, `targets` what is asked for.
    pub(super) fn unturn(&mut self, from: &[f64], targets: &[Target], q: &mut Vec<f64>) {
        let bodies = unnamed(self.dynamics.mechanism);
        if bodies.is_empty() {
            return;
        }
        let drawn = as_drawn(&mut self.dynamics, &bodies);
        let settled = std::mem::replace(&mut self.targets, targets.to_vec());
        let mut best = (self.miss(q), turned(&self.dynamics, &drawn), q.clone(), settled, self.modes.clone());
        let most = |missed: &[f64]| missed.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let met = MET.max(most(&self.missed()));
        let mut shake = Shake(4);
        for look in 0..LOOKS {
            if largest(&best.1) <= FAR {
                break;
            }
            let mut trial = from.to_vec();
            let way = self.shaken(&mut shake, 0.2 * f64::from(look));
            self.dynamics.mechanism.retract(&mut trial, &way);
            (self.held, self.upright) = (Held::All, drawn.clone());
            self.close(&mut trial);
            (self.held, self.upright) = (Held::Exact, Vec::new());
            if self.close(&mut trial) && self.faces() {
                self.settle(&mut trial);
                let settled = std::mem::replace(&mut self.targets, targets.to_vec());
                let (miss, other) = (self.miss(&trial), turned(&self.dynamics, &drawn));
                if most(&self.missed()) <= met && miss.hypot(norm(&other)) < (1.0 - NEARER) * best.0.hypot(norm(&best.1)) {
                    best = (miss, other, trial, settled, self.modes.clone());
                }
            }
        }
        (*q, self.targets, self.modes) = (best.2, best.3, best.4);
        self.evaluate(q);
    }
}
