//! The search for equilibria of many bodies: the descent of `search` with the rows beside the stiffness, so that matrices stay sparse.
//!
//! ```text
//! [ K + σB  Gᵀ ] [ δ ]   [ f − Gᵀλ ]
//! [   G     0  ] [ μ ] = [    0    ],      q ← q ⊕ δ
//! ```
//!
//! λ leaves least unbalanced, |f − Gᵀλ| in B⁻¹, and B is the metric in which rows are closed as well, so that K is the second derivative
//! of the energy on the way. σ ≥ 0 is so large that K + σB is positive on motions with Gδ = 0, which the signs of the
//! pivots of this matrix say (`kinematics/pair.rs`), and that δ is no longer than a radius. K is taken symmetric: forces have a potential.
//! The bath B resists the turning of each body by its largest inertia, about any axis, and slides hardly, so that λ carries the weights, as
//! it does at rest. About its own axis a slender bar would hardly be resisted: K couples that turn with the others where forces are
//! unbalanced, and σ would have to outweigh it [130 bars on spherical joints: 1e-4 rad a step, measured].

use super::rest::{CLOSED, Lost, Position, Rest};
use super::search::{AWAY, CLOSE, Ended, FLOOR, LONGEST, NEAR, ROUND_OFF, STEPS};
use crate::dynamics::Dynamics;
use crate::geometry::{Pose, Space};
use crate::kinematics::assemble::Assembled;
use crate::kinematics::pair::Pair;
use crate::kinematics::pencil::Pencil;
use crate::kinematics::saddle::Saddle;
use crate::mechanism::Mechanism;
use grashof_solvers::kkt::row_scale;
use grashof_solvers::{Block, Kkt, Span, Sparsity, Stage, System};

/// Steps in which constraints are closed.
const CLOSING: usize = 40;
/// Most solutions for the multipliers of a position.
const HOLDING: usize = 8;
/// Part of D that is added to the bath, with which it resists slides.
const SLIDES: f64 = 1e-6;
/// The first σ that is tried where none was needed before, as part of the size of K.
const SOME: f64 = 1e-3;
/// Ways in rad or extents after which a mechanism that cannot go on has run away.
const FAR: f64 = 10.0;
/// By how much σ falls between steps at most.
const FALL: f64 = 30.0;

/// A position with what is unbalanced there.
#[derive(Clone, Debug)]
pub(super) struct Stand {
    pub(super) position: Position,
    /// f − Gᵀλ (nv).
    pub(super) net: Vec<f64>,
    /// Size of the unbalanced force in D⁻¹, and what it is made of before it cancels.
    pub(super) force: f64,
    pub(super) grain: f64,
    /// A stiffness of the order of those that act, before they cancel.
    pub(super) stiffness: f64,
}

/// A mechanism of many bodies that rests.
pub(super) struct Sinking<'m, G: Space<S = f64>> {
    pub(super) rest: Rest<'m, G>,
    pub(super) metric: Vec<f64>,
    row_scale: Vec<f64>,
    /// A whole way of each velocity: 1 rad, or the extent of the mechanism (nv); and which of them turn.
    way: Vec<f64>,
    turns: Vec<bool>,
    /// B (nv × nv).
    bath: Block,
    /// [B Gᵀ; G −E].
    closing: Kkt,
}

impl<'m, G> Sinking<'m, G>
where
    G: Space<S = f64>,
{
    /// A mechanism with the coordinates and modes of its start, and which of its velocities turn.
    pub(super) fn new(rest: Rest<'m, G>, q: &[f64], modes: &[i32], turns: Vec<bool>) -> Self {
        let pattern = rest.system.pattern();
        let (metric, row_scale) = (pattern.metric.clone(), pattern.g_scale.clone());
        let Bath { bath, extent } = bath(rest.system.dynamics.mechanism, q, modes, &metric);
        let closing = Kkt::of_blocks(bath.pattern(), &pattern.g);
        let way = turns.iter().map(|turns| if *turns { 1.0 } else { extent.max(rest.size) }).collect();
        Self { rest, metric, row_scale, way, turns, bath, closing }
    }

    /// The position nearest to given coordinates and modes, without first-order states.
    pub(super) fn at(&mut self, q: &[f64], modes: &[i32]) -> Result<Stand, Lost> {
        self.rest.state.q.copy_from_slice(q);
        self.rest.state.modes[..modes.len()].copy_from_slice(modes);
        self.close()?;
        self.rest.take_modes();
        self.rest.evaluate(Stage::Dynamics);
        if let Some(k) = self.rest.undefined() {
            return Err(Lost::NotFinite(k));
        }
        let rows = self.row_scale.len();
        let (mut pull, mut lambda) = (vec![0.0; self.metric.len()], vec![0.0; rows]);
        self.closing.set_exact(true);
        let solved = self.factor().map(|()| self.hold(&mut pull, &mut lambda));
        self.closing.set_exact(false);
        solved?;
        let net: Vec<f64> = self.bath.lines().map(|line| line.dot(&pull)).collect();
        let force = net.iter().zip(&self.metric).map(|(f, d)| f * f / d).sum::<f64>().sqrt();
        let (grain, stiffness) = self.rest.sizes();
        Ok(Stand { position: self.rest.position(lambda), net, force, grain, stiffness })
    }

    /// The multipliers (m) that leave least unbalanced, and the pull B⁻¹(f − Gᵀλ) (nv) of the rest, by the factors at hand.
    ///
    /// What is left is formed anew after each solution, so that multipliers are exact to round-off over σ, not over σ².
    fn hold(&mut self, pull: &mut [f64], lambda: &mut [f64]) {
        let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let terms = &self.rest.terms;
        let (zeros, mut part) = (vec![0.0; lambda.len()], vec![0.0; lambda.len()]);
        let mut last = f64::INFINITY;
        for _ in 0..HOLDING {
            let mut left = terms.force.clone();
            terms.g.lines().zip(&*lambda).for_each(|(line, lambda)| line.add_to(-lambda, &mut left));
            self.closing.solve(&left, &zeros, pull, &mut part);
            lambda.iter_mut().zip(&part).for_each(|(lambda, part)| *lambda += part);
            let size = largest(&part);
            if size >= 0.5 * last || size <= f64::EPSILON * largest(lambda) {
                break;
            }
            last = size;
        }
    }

    /// The position behind a displacement (nv).
    pub(super) fn moved(&mut self, from: &Stand, delta: &[f64]) -> Result<Stand, Lost> {
        let mut q = from.position.q.clone();
        self.rest.system.retract(Span::at(self.rest.state.t), &mut q, delta);
        self.at(&q, &from.position.modes)
    }

    /// The linear motion about a stand, with B in the place of M; a floor in K keeps motions that nothing holds where they are.
    pub(super) fn pencil(&mut self, stand: &Stand) -> Result<Pencil, Lost> {
        let rest = &mut self.rest;
        rest.stand_at(&stand.position);
        rest.evaluate(Stage::Position);
        rest.system.tangent(rest.state.at(), &rest.zeros, &stand.position.lambda, &mut rest.tangent);
        let (k, metric) = (&rest.tangent.k, &self.metric);
        // an entry without bound belongs to a force that is none
        if !k.values().iter().all(|k| k.is_finite()) {
            return Err(Lost::NotFinite(0));
        }
        let sizes = k.pattern().places().zip(k.values()).map(|((i, j), k)| k.abs() / (metric[i] * metric[j]).sqrt());
        let floor = FLOOR * sizes.fold(0.0, f64::max);
        let nv = metric.len();
        let mut stiffness = Block::new(&Sparsity::new(nv, nv, k.pattern().places().chain((0..nv).map(|i| (i, i)))));
        stiffness.take(k);
        (0..nv).for_each(|i| stiffness.set(i, i, stiffness.at(i, i) + floor * metric[i]));
        let pencil = of_metric(stiffness, rest.terms.g.clone(), metric, &self.row_scale);
        Ok(Pencil { mass: self.bath.clone(), ..pencil })
    }

    /// The equilibrium from the stand of a start, and whether that is the stand itself.
    pub(super) fn settled(&mut self, begin: &Stand, start: &Assembled, stop: &dyn Fn() -> bool) -> Result<(Stand, bool), Ended> {
        let pencil = self.pencil(begin)?;
        if self.is_balanced(begin, &Pair::new(&pencil)) {
            return Ok((self.polish(begin.clone())?, true));
        }
        let beside = self.rest.along_a_branch(&begin.position, start).and_then(|q| self.at(&q, &start.modes).ok());
        Ok((self.descend(beside.as_ref().unwrap_or(begin), stop)?, false))
    }

    /// The way to the equilibrium of the linearised forces is within round-off of the position.
    fn is_balanced(&mut self, stand: &Stand, pair: &Pair<'_>) -> bool {
        stand.force <= ROUND_OFF * stand.grain || self.newton(stand, pair).is_some_and(|delta| self.measure(&delta) <= CLOSE)
    }

    /// Where the mechanism settles.
    pub(super) fn descend(&mut self, from: &Stand, stop: &dyn Fn() -> bool) -> Result<Stand, Ended> {
        let mut stand = from.clone();
        let (mut radius, mut way, mut last) = (0.1, 0.0, 0.0);
        for _ in 0..STEPS {
            if stop() {
                return Err(Ended::Stopped);
            }
            if stand.force <= ROUND_OFF * stand.grain {
                return self.polish(stand);
            }
            let pencil = self.pencil(&stand)?;
            let pair = Pair::new(&pencil);
            let (delta, sigma) = self.step(&stand, &pair, radius, last, stop)?;
            last = sigma;
            let length = self.measure(&delta);
            // on a ridge σ stays above 0, and the steps become short slowly
            if length <= CLOSE && sigma == 0.0 || length <= NEAR && self.is_balanced(&stand, &pair) {
                return self.polish(stand);
            }
            match self.tried(&stand, &pencil, &delta) {
                Some((next, ratio)) if ratio > 0.1 => {
                    way += length;
                    if way > AWAY {
                        return Err(Ended::Away);
                    }
                    stand = next;
                    if ratio < 0.25 {
                        radius = 0.5 * length;
                    } else if ratio > 0.75 && sigma > 0.0 {
                        radius = radius.max(2.0 * length);
                    }
                }
                _ => radius = 0.25 * length.min(radius),
            }
            if radius < 1e-13 {
                // far away rows cannot be closed to the digits of coordinates
                return Err(if way > FAR { Ended::Away } else { Ended::Jump });
            }
        }
        Err(if way > 0.25 * LONGEST * STEPS as f64 { Ended::Away } else { Ended::Stuck })
    }

    /// The implicit step within a radius, and its σ; `last` is that of the step before.
    fn step(&mut self, stand: &Stand, pair: &Pair<'_>, radius: f64, last: f64, stop: &dyn Fn() -> bool) -> Result<(Vec<f64>, f64), Ended> {
        let mut sigma = if last > 1e-6 * pair.size { last / FALL } else { 0.0 };
        while !stop() && sigma.is_finite() {
            let shifted = pair.factored(-sigma).ok_or(Ended::Lost(Lost::NotFinite(0)))?;
            if shifted.below == 0 {
                let delta = solved(&shifted, pair, stand);
                if self.reach(&delta, radius) <= 1.0 {
                    return Ok((delta, sigma));
                }
            }
            sigma = if sigma == 0.0 { SOME * pair.size } else { 3.0 * sigma };
        }
        Err(if stop() { Ended::Stopped } else { Ended::Stuck })
    }

    /// The position behind a step, and the work of the forces on it by that of the model.
    fn tried(&mut self, stand: &Stand, pencil: &Pencil, delta: &[f64]) -> Option<(Stand, f64)> {
        let next = self.moved(stand, delta).ok()?;
        let along = |force: &[f64]| force.iter().zip(delta).map(|(f, x)| f * x).sum::<f64>();
        let curvature: f64 = pencil.stiffness.lines().zip(delta).map(|(line, x)| x * line.dot(delta)).sum();
        let work = 0.5 * (along(&stand.net) + along(&next.net));
        let ratio = work / (along(&stand.net) - 0.5 * curvature);
        Some((next, ratio))
    }

    /// Newton steps as long as they halve what is unbalanced.
    fn polish(&mut self, mut stand: Stand) -> Result<Stand, Ended> {
        for _ in 0..8 {
            let pencil = self.pencil(&stand)?;
            let Some(delta) = self.newton(&stand, &Pair::new(&pencil)) else { break };
            match self.moved(&stand, &delta) {
                Ok(next) if next.force <= 0.5 * stand.force => stand = next,
                _ => break,
            }
        }
        Ok(stand)
    }

    /// The way to the equilibrium of the linearised forces (nv).
    fn newton(&self, stand: &Stand, pair: &Pair<'_>) -> Option<Vec<f64>> {
        let delta = solved(&pair.factored(0.0)?, pair, stand);
        delta.iter().all(|x| x.is_finite()).then_some(delta)
    }

    /// Largest part of a displacement (nv), in radians or extents of the mechanism.
    pub(super) fn measure(&self, delta: &[f64]) -> f64 {
        delta.iter().zip(&self.way).fold(0.0, |m, (d, u)| f64::max(m, d.abs() / u))
    }

    /// Length of a step by the radius; turns never more than a part of a radian, so that no branch is jumped over.
    fn reach(&self, delta: &[f64], radius: f64) -> f64 {
        delta.iter().zip(&self.way).zip(&self.turns).fold(0.0, |m, ((d, way), turns)| {
            let longest = if *turns { radius.min(LONGEST) } else { radius };
            f64::max(m, d.abs() / (way * longest))
        })
    }

    /// Moves the coordinates to the constraints, by the shortest way in the bath.
    fn close(&mut self) -> Result<(), Lost> {
        if self.row_scale.is_empty() {
            return Ok(());
        }
        let nv = self.metric.len();
        let mut last = f64::INFINITY;
        for _ in 0..CLOSING {
            self.rest.evaluate(Stage::Position);
            let gap = self.rest.gap();
            if gap >= last || gap.is_nan() {
                // at round-off, or never
                break;
            }
            last = gap;
            if gap <= 0.01 * CLOSED {
                // near zero a gap may shrink for ever, far below the round-off of what it is the difference of
                break;
            }
            self.factor()?;
            let wanted: Vec<f64> = self.rest.terms.phi.iter().map(|p| -p).collect();
            let (mut delta, mut lambda) = (vec![0.0; nv], vec![0.0; wanted.len()]);
            self.closing.solve(&vec![0.0; nv], &wanted, &mut delta, &mut lambda);
            let rest = &mut self.rest;
            rest.system.retract(Span::at(rest.state.t), &mut rest.state.q, &delta);
        }
        if last <= CLOSED { Ok(()) } else { Err(Lost::Open) }
    }

    /// Factors the system that closes the rows evaluated last.
    fn factor(&mut self) -> Result<(), Lost> {
        let (bath, g) = (&self.bath, &self.rest.terms.g);
        let diagonal: Vec<f64> = (0..self.metric.len()).map(|i| bath.at(i, i)).collect();
        self.closing.set_scale(&diagonal, &row_scale(g.pattern(), g.values(), &diagonal));
        self.closing.factor(bath.values(), g.values()).map_err(|_| Lost::Open)
    }
}

/// What a mechanism sinks in.
struct Bath {
    /// B: M of the bodies with their largest inertias alone, and a part of D.
    bath: Block,
    /// The farthest that a body is from the first, m.
    extent: f64,
}

fn bath<G: Space<S = f64>>(mechanism: &Mechanism<G>, q: &[f64], modes: &[i32], metric: &[f64]) -> Bath {
    let mut turning = mechanism.clone();
    for body in &mut turning.bodies {
        let about = |axis: usize| {
            let unit = G::spin([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 }));
            G::spin_component(G::apply(body.mass.inertia, unit), axis)
        };
        let largest = [0, 1, 2].map(about).into_iter().fold(0.0, f64::max);
        body.mass.mass = 0.0;
        body.mass.inertia = G::tensor([largest, largest, largest, 0.0, 0.0, 0.0]);
    }
    let mut dynamics = Dynamics::new(&turning);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    dynamics.inertias();
    dynamics.mass();
    let mut bath = dynamics.work.mass.clone();
    metric.iter().enumerate().for_each(|(i, d)| bath.set(i, i, bath.at(i, i) + SLIDES * d));
    let poses = dynamics.poses();
    let far = |p: &Pose<G>| poses.first().map_or(0.0, |first| G::dot(p.p - first.p, p.p - first.p).sqrt());
    let extent = poses.iter().map(far).fold(0.0, f64::max);
    Bath { bath, extent }
}

/// A pencil with the metric D (nv) in the place of M.
pub(super) fn of_metric(stiffness: Block, rows: Block, metric: &[f64], row_scale: &[f64]) -> Pencil {
    let nv = metric.len();
    let mut mass = Block::new(&Sparsity::new(nv, nv, (0..nv).map(|i| (i, i))));
    mass.values_mut().copy_from_slice(metric);
    let damping = Block::new(&Sparsity::new(nv, nv, []));
    let (metric, row_scale, grain) = (metric.to_vec(), row_scale.to_vec(), vec![0.0; nv]);
    Pencil { mass, stiffness, damping, rows, metric, row_scale, grain, freedom: nv }
}

/// The step by a factored matrix.
fn solved(shifted: &Saddle, pair: &Pair<'_>, stand: &Stand) -> Vec<f64> {
    shifted.solve(&stand.net.iter().map(|f| f / pair.size).collect::<Vec<f64>>())
}
