//! Explicit steps across a singular position.
//!
//! Let σ, the smallest singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½ that is not zero all along, go through zero at a time t_c. Beside the constraints the
//! equations of index 1 keep σx as it is, x the way of the weak direction, so that ẍ = −2ẋ/(t − t_c): errors of stages, which are
//! of low order, are amplified by h/|t − t_c|, steps must shrink with the distance, and where σ² < E the force in the weak
//! direction is missing: some 1e-9 J were lost in each crossing, whatever the tolerance (measured). On the constraints the motion
//! is smooth, however. So near such a place
//!
//! - each stage is moved onto the constraints by P before its rates are taken. F∘P is another smooth field with the same motion
//!   on the constraints, so the order stays that of the method;
//! - the step is chosen so that t_c falls into the middle of the widest gap between stages, from 1/3 to 3/5: nothing is evaluated
//!   where E counts;
//! - the error counts along the constraints at the end of the step: what lies across is removed by the projection there, and is
//!   mostly the noise ε of Φ, which becomes εσ̇²/σ³ in accelerations of the weak direction.
//!
//! A step that begins or ends beside t_c is the worst: steps become tiny there, and are taken where E counts. So a tight tolerance
//! follows σ from step to step, and ends the steps before t_c away from it.

use crate::engine::{Engine, Node, Why};
use crate::{Dims, Sigma, Span, Stage, System};

/// Middle of the widest gap between the stages, and parts of it where t_c may lie.
const MIDDLE: f64 = 7.0 / 15.0;
const GAP: [f64; 2] = [0.40, 0.53];

/// Steps, ahead or behind, within which a singular position is near.
const REACH: f64 = 2.0;

/// σ below which one is looked for; at zero itself there is no telling when it was passed.
const NEAR: f64 = 0.2;
const UPON: f64 = 1e-4;

/// Tolerance from which on σ is followed at the ends of steps [measured, rows of one to ten four-bars at tolerances from 1e-9 to 1e-12: of 150
/// runs 12 lose more energy than a crank of the same inertia does at that tolerance, up to 64 times, and none loses more than 0.6 of it where
/// σ is followed, with 4 per cent fewer evaluations; above 1e-9 it makes no difference].
const TIGHT: f64 = 1e-9;

/// Distance of the end of a step from t_c, in steps, below which it ends earlier.
const BESIDE: f64 = 0.25;

/// Part of a step over which the change of σ is taken.
const ASIDE: f64 = 1.0 / 16.0;

/// Steps of the inverse iteration for σ.
const ITERATIONS: usize = 3;

/// Rejected steps in a row after which stages are taken as they are.
const PATIENCE: usize = 6;

/// A singular position that is near, and room for what is done there.
#[derive(Debug)]
pub(super) struct Crossing {
    /// A state on the constraints: that of a stage, or the end of the step.
    pub(super) node: Node,
    /// Time at which rank is lost, s.
    place: Option<f64>,
    /// Time until which patience is lost, s.
    beyond: f64,
    rejected: usize,
    /// Time and σ of the last three nodes that were looked at, and of the end of the trial.
    known: [Option<[f64; 2]>; 3],
    trial: Option<[f64; 2]>,
    /// Steps that need not be looked at.
    skipped: usize,
    weakest: Sigma,
    /// Velocities (nv), and rates of positions (nq).
    shift: Vec<f64>,
    lifted: Vec<f64>,
    column: Vec<f64>,
}

impl Crossing {
    /// Room for a system.
    pub(super) fn new(dims: Dims) -> Self {
        Self {
            node: Node::new(dims),
            place: None,
            beyond: f64::NEG_INFINITY,
            rejected: 0,
            known: [None; 3],
            trial: None,
            skipped: 0,
            weakest: Sigma::new(dims.rows()),
            shift: vec![0.0; dims.v],
            lifted: vec![0.0; dims.v],
            column: vec![0.0; dims.q],
        }
    }

    /// Whether a singular position is near.
    pub(super) fn near(&self) -> bool {
        self.place.is_some()
    }

    /// Takes what is met until `t` (s) for no singular position.
    pub(super) fn regular_until(&mut self, t: f64) {
        (self.place, self.beyond, self.rejected) = (None, self.beyond.max(t), 0);
    }

    /// Forgets the past.
    pub(super) fn forget(&mut self, engine: &Engine) {
        self.weakest.restart(engine);
        (self.place, self.beyond, self.rejected) = (None, f64::NEG_INFINITY, 0);
        (self.known, self.trial, self.skipped) = ([None; 3], None, 0);
    }

    /// Looks for a singular position within reach of a step `h` (s) from a node: σ there and a little later. True if one is near.
    ///
    /// # Errors
    /// If the system cannot be evaluated there.
    pub(super) fn look(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64) -> Result<bool, Why> {
        let t = from.state.t;
        if !self.weakest.moves(engine) || t < self.beyond {
            return Ok(false);
        }
        if let Some(place) = self.expected(t) {
            self.place = (place - t < REACH * h).then_some(place);
            return Ok(self.near());
        }
        self.node.copy_from(from);
        let sigma = self.sigma(system, engine)?;
        if !(UPON..=NEAR).contains(&sigma) {
            return Ok(false);
        }
        let aside = ASIDE * h;
        for ((s, v), a) in self.shift.iter_mut().zip(&from.state.v).zip(&from.a) {
            *s = aside * (v + 0.5 * aside * a);
        }
        self.node.state.t += aside;
        let span = Span { end: self.node.state.t, length: aside };
        system.retract(span, &mut self.node.state.q, &self.shift);
        let ahead = self.sigma(system, engine)?;
        let way = aside * sigma / (sigma - ahead);
        self.known = [None, None, Some([t, sigma])];
        self.place = (way.abs() < REACH * h).then_some(t + way);
        Ok(self.near())
    }

    /// σ at the state in hand.
    fn sigma(&mut self, system: &mut dyn System, engine: &mut Engine) -> Result<f64, Why> {
        engine.evaluate(system, self.node.state.at(), Stage::Position);
        engine.factor()?;
        Ok(self.estimate(engine))
    }

    /// σ by the factors at hand.
    fn estimate(&mut self, engine: &mut Engine) -> f64 {
        self.weakest.follow(engine, ITERATIONS)
    }

    /// Time after `t` (s) at which σ becomes zero as the last three values tell, of which the last is that of this node: t(σ) through them,
    /// at zero (inverse interpolation). None where they bend too much to tell.
    fn expected(&self, t: f64) -> Option<f64> {
        let [Some([t0, s0]), Some([t1, s1]), Some([t2, s2])] = self.known else { return None };
        if t2 != t || t < self.beyond || !(UPON..=NEAR).contains(&s2) || s2 >= s1 || s1 >= s0 {
            return None;
        }
        let [d01, d02, d12] = [s0 - s1, s0 - s2, s1 - s2];
        let place = t0 * s1 * s2 / (d01 * d02) - t1 * s0 * s2 / (d01 * d12) + t2 * s0 * s1 / (d02 * d12);
        (place > t).then_some(place)
    }

    /// The step to take at `t` (s) where `h` is the longest that the error allows: across with t_c in the gap, or up to where the
    /// next one can do so. Where t_c is expected and stages are not projected yet, only the end of the step counts.
    pub(super) fn plan(&self, t: f64, h: f64) -> f64 {
        let Some(place) = self.place else {
            let part = self.expected(t).map_or(f64::INFINITY, |place| (place - t) / h);
            return if (part - 1.0).abs() < BESIDE { (part - MIDDLE) * h } else { h };
        };
        let part = (place - t) / h;
        if part <= 0.0 || part >= 1.0 + MIDDLE || (GAP[0]..=GAP[1]).contains(&part) {
            h
        } else if part < GAP[0] {
            part * h / MIDDLE
        } else {
            (part - MIDDLE) * h
        }
    }

    /// A step was rejected for what may be cured by a shorter one `h` (s); returns the one to try.
    pub(super) fn reject(&mut self, t: f64, h: f64) -> f64 {
        self.rejected += 1;
        if self.rejected > PATIENCE
            && let Some(place) = self.place.take()
        {
            self.beyond = place.max(t) + h;
        }
        self.plan(t, h)
    }

    /// Takes the end of a trial whose terms and factors are at hand.
    pub(super) fn arrive(&mut self, engine: &mut Engine, to: &Node) {
        self.node.copy_from(to);
        self.trial = Some([to.state.t, self.estimate(engine)]);
    }

    /// Takes the end of a trial far from singular positions, whose factors are at hand.
    pub(super) fn follow(&mut self, engine: &mut Engine, to: &Node) {
        let followed = !engine.is_fixed() && engine.tolerance() <= TIGHT && self.weakest.moves(engine) && self.skipped == 0;
        self.trial = followed.then(|| [to.state.t, self.weakest.follow(engine, 1)]);
    }

    /// The trial counts; `h` (s) is the step that the error allows next.
    pub(super) fn accept(&mut self, h: f64) {
        self.rejected = 0;
        let Some([t, now]) = self.trial.take() else {
            self.skipped = self.skipped.saturating_sub(1);
            return;
        };
        let before = self.known[2];
        self.known = [self.known[1], before, Some([t, now])];
        let Some(place) = self.place else {
            // σ changes by less than NEAR in a step
            self.skipped = (now / NEAR) as usize / 2;
            return;
        };
        self.place = if t < place {
            let straight = || before.map(|[start, sigma]| t + (t - start) * now / (sigma - now));
            self.expected(t).or_else(straight).filter(|place| *place > t && *place < t + 2.0 * REACH * h)
        } else {
            (t - place < REACH * h).then_some(place)
        };
    }

    /// Removes what lies across the constraints from errors e_q (nq) and e_v (nv) at the end of the trial.
    ///
    /// e_q = N u, and the columns of N(q) are orthogonal, so that u = (NᵀN)⁻¹ Nᵀ e_q goes by columns.
    pub(super) fn along(&mut self, system: &dyn System, engine: &mut Engine, e_q: &mut [f64], e_v: &mut [f64]) {
        engine.tangential(e_v);
        let s = &self.node.state;
        self.shift.fill(0.0);
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        for (j, u) in self.lifted.iter_mut().enumerate() {
            self.shift[j] = 1.0;
            system.lift(s.t, &s.q, &self.shift, &mut self.column);
            self.shift[j] = 0.0;
            *u = dot(&self.column, e_q) / dot(&self.column, &self.column);
        }
        self.shift.copy_from_slice(&self.lifted);
        engine.tangential(&mut self.lifted);
        self.shift.iter_mut().zip(&self.lifted).for_each(|(s, l)| *s = l - *s);
        system.lift(s.t, &s.q, &self.shift, &mut self.column);
        e_q.iter_mut().zip(&self.column).for_each(|(e, c)| *e += c);
    }
}
