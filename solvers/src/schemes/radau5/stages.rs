//! The three coupled stages and the simplified Newton iteration that solves them.
//!
//! Unknown are the derivatives aᵢ, żᵢ, the multipliers λᵢ, and at [`Level::Stabilized`] the displacements wᵢ that close the
//! positions of each stage:
//!
//! ```text
//! Vᵢ = v₀ + h Σ aᵢⱼ aⱼ        Zᵢ = z₀ + h Σ aᵢⱼ żⱼ        Qᵢ = q₀ + h Σ aᵢⱼ N(Qⱼ) Vⱼ + N(Qᵢ) wᵢ
//! M aᵢ + Gᵀλᵢ = f,   żᵢ = g,   and the rows of the level, all at stage i
//! ```
//!
//! With ∂Qᵢ ≈ h² Σ (A²)ᵢⱼ δaⱼ, T⁻¹ separates Newton's matrix into one real and one complex block of the common form with
//! c_v = c_z = c, c_q = c², c = h/γ̂ and h/(α + iβ) (Hairer & Wanner, Solving ODEs II, section IV.8). M, G and the tangents are
//! those of the second stage, which lies in the middle of the step: free bodies turn by h|ω| within a step, and that is the rate.
//!
//! The multipliers μ of Gear, Gupta & Leimkuhler enter q̇ = N(v + P μ); with P frozen over the step, h Σ aᵢⱼ P μⱼ = P ηᵢ, any
//! ηᵢ can be reached, and so every stage closes its own positions by a real solution with the right-hand side
//! [0; −Φ − G δqᵢ]: the complex block needs no further unknowns.

use super::tableau::{A, BACK, NODES, PAIR, REAL, T, parabola};
use crate::engine::{Engine, Node, Why};
use crate::matrix::{Blocks, Coefficients, Matrix};
use crate::newton::residual;
use crate::scheme::Level;
use crate::{Block, Dims, Pattern, Span, Stage as Extent, State, System};
use nalgebra::Complex;

/// One stage.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    /// Time, q, v, z.
    pub(super) state: State,
    /// v̇ (nv).
    pub(super) a: Vec<f64>,
    /// ż (nz).
    pub(super) zdot: Vec<f64>,
    /// λ (m).
    pub(super) lambda: Vec<f64>,
    /// What closes the positions (nv).
    pub(super) w: Vec<f64>,
    /// N(q) v (nq).
    rate: Vec<f64>,
    /// Φ and G at the last evaluation; only at `Stabilized`.
    phi: Vec<f64>,
    g: Block,
    /// Newton's step of q (as displacement), v, z.
    step: [Vec<f64>; 3],
}

impl Stage {
    fn new(dims: Dims, pattern: &Pattern) -> Self {
        Self {
            state: State::new(dims),
            a: vec![0.0; dims.v],
            zdot: vec![0.0; dims.z],
            lambda: vec![0.0; dims.rows()],
            w: vec![0.0; dims.v],
            rate: vec![0.0; dims.q],
            phi: vec![0.0; dims.holonomic],
            g: Block::new(&pattern.g),
            step: [vec![0.0; dims.v], vec![0.0; dims.v], vec![0.0; dims.z]],
        }
    }
}

/// The stages of a step, those of the step before, and Newton's matrices.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    pub(super) stage: [Stage; 3],
    past: [Stage; 3],
    /// Size of the step that `past` belongs to.
    past_h: Option<f64>,
    level: Level,
    follow: bool,
    /// Blocks at the last linearisation, and the real matrix: the filter of the error needs both.
    pub(super) blocks: Blocks,
    pub(super) real: Matrix<f64>,
    complex: Matrix<Complex<f64>>,
    /// Step of the factors.
    factored: Option<f64>,
    linearised: bool,
    /// Whether tangents were taken in this solution.
    fresh: bool,
    /// Rate and number of the last iterations.
    pub(super) rate: f64,
    pub(super) iterations: i32,
    x: [Vec<f64>; 3],
    pair: Vec<Complex<f64>>,
    second: Vec<f64>,
    place: Vec<f64>,
    displacement: Vec<f64>,
}

/// Most iterations of a step whose size may change, and of a given step.
const ITERATIONS: i32 = 15;
const ITERATIONS_FIXED: i32 = 50;

/// A last iteration is good enough when what follows it is below this part of the tolerance: what is left adds up over the steps
/// (measured on a pendulum for 10 s at 1e-10: error 18 times the tolerance with 1e-2, 2.6 times with 1e-3).
const CLOSE: f64 = 1e-3;

/// Steps of q and v below this are round-off; given steps aim at 1e-12, and count as round-off below 30 times that.
const ROUND_OFF: f64 = 2e-13;

/// Factors are kept for the next step, too, below this rate; tangents below the second.
const FAST: f64 = 0.02;
const SLOW: f64 = 0.2;

/// Most sweeps over the places of the stages in one iteration; where N is constant, the second changes nothing.
const SWEEPS: usize = 6;

/// Longest extrapolation of the last step, in its size.
const FAR: f64 = 4.0;

impl Stages {
    /// Room for a system.
    pub(super) fn new(level: Level, follow: bool, system: &dyn System) -> Self {
        let dims = system.dims();
        let n = dims.v + dims.z + dims.rows();
        let stage = || [(); 3].map(|()| Stage::new(dims, system.pattern()));
        Self {
            stage: stage(),
            past: stage(),
            past_h: None,
            level,
            follow,
            blocks: Blocks::new(system.pattern()),
            real: Matrix::new(dims, system.pattern()),
            complex: Matrix::new(dims, system.pattern()),
            factored: None,
            linearised: false,
            fresh: false,
            rate: 0.0,
            iterations: 0,
            x: [(); 3].map(|()| vec![0.0; n]),
            pair: vec![Complex::default(); n],
            second: vec![0.0; n],
            place: vec![0.0; dims.q],
            displacement: vec![0.0; dims.v],
        }
    }

    /// Forgets the last step, tangents and factors.
    pub(super) fn forget(&mut self) {
        (self.past_h, self.linearised, self.factored, self.rate) = (None, false, None, 0.0);
    }

    /// Stages of the step accepted last; none after a restart.
    pub(super) fn accepted(&self) -> Option<&[Stage; 3]> {
        self.past_h.map(|_| &self.past)
    }

    /// Keeps the stages of a step of size `h` as the past of the next.
    pub(super) fn accept(&mut self, h: f64) {
        std::mem::swap(&mut self.past, &mut self.stage);
        self.past_h = Some(h);
    }

    /// Whether the next step of the same size would keep the factors.
    pub(super) fn keeps_factors(&self) -> bool {
        self.rate < FAST
    }

    /// Solves the stages of a step.
    ///
    /// # Errors
    /// [`Why::Newton`] if the iteration does not converge with fresh tangents, [`Why::Singular`], [`Why::NotFinite`].
    pub(super) fn solve(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64) -> Result<(), Why> {
        self.fresh = false;
        if self.rate > SLOW {
            self.linearised = false;
        }
        if self.rate > FAST || self.factored != Some(h) {
            self.factored = None;
        }
        // stages that cannot be evaluated take no tangents: a second trial is the last one all the same
        for last in [false, true] {
            self.predict(from, h);
            let tried = self.iterate(system, engine, from, h);
            if tried.is_ok() {
                break;
            }
            (self.linearised, self.factored) = (false, None);
            if self.fresh || last {
                return tried;
            }
        }
        Ok(())
    }

    /// Starts from the parabolas through the derivatives of the last step, or from the derivatives at the begin.
    fn predict(&mut self, from: &Node, h: f64) {
        let ratio = self.past_h.map(|past| h / past).filter(|ratio| *ratio < FAR);
        for (stage, node) in self.stage.iter_mut().zip(NODES) {
            stage.state.copy_from(&from.state);
            stage.w.fill(0.0);
            let Some(ratio) = ratio else {
                stage.a.copy_from_slice(&from.a);
                stage.zdot.copy_from_slice(&from.zdot);
                stage.lambda.copy_from_slice(&from.lambda);
                continue;
            };
            let weights = parabola(1.0 + node * ratio);
            let [p0, p1, p2] = &self.past;
            let extend = |x: &mut [f64], [x0, x1, x2]: [&[f64]; 3]| {
                for (i, x) in x.iter_mut().enumerate() {
                    *x = weights[0] * x0[i] + weights[1] * x1[i] + weights[2] * x2[i];
                }
            };
            extend(&mut stage.a, [&p0.a, &p1.a, &p2.a]);
            extend(&mut stage.zdot, [&p0.zdot, &p1.zdot, &p2.zdot]);
            extend(&mut stage.lambda, [&p0.lambda, &p1.lambda, &p2.lambda]);
        }
    }

    fn iterate(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64) -> Result<(), Why> {
        let most = if engine.is_fixed() { ITERATIONS_FIXED } else { ITERATIONS };
        let (mut first, mut last) = (0.0, f64::INFINITY);
        // the rate of one iteration and the next differ: closing the positions turns G, which only then shows in G v
        let mut rates = [self.rate.max(1e-3), if self.factored.is_some() { self.rate.max(1e-3) } else { 0.5 }];
        self.place(system, from, h);
        for iteration in 0..most {
            self.evaluate(system, engine, h)?;
            engine.counts.iterations += 1;
            self.iterations = iteration + 1;
            self.separate(h);
            self.real.solve(&mut self.x[0]);
            self.complex.solve(&mut self.pair);
            let norm = self.correct(engine, h);
            self.place(system, from, h);
            if !norm.is_finite() {
                return Err(Why::Newton);
            }
            if iteration > 0 {
                rates = [if iteration > 1 { rates[1] } else { rates[0] }, norm / last];
                self.rate = (norm / first).powf(1.0 / f64::from(iteration)).min(1.0);
            } else {
                first = norm;
            }
            let rate = rates[0].max(rates[1]);
            let floor = if engine.is_fixed() { 30.0 } else { f64::max(1e-3, ROUND_OFF / engine.tolerance()) };
            let noise = 2.0 * engine.rounding(&from.state.q) / engine.tolerance();
            let rounded = iteration > 0 && rates[1] > 0.3 && norm < floor || iteration > 1 && rates[1] > 0.5 && norm < noise;
            if rounded || (rate < 1.0 && norm * rate / (1.0 - rate) < CLOSE) || norm == 0.0 {
                if rounded || iteration == 0 {
                    // one iteration has no rate: that of an earlier step would shorten this one and all that follow
                    self.rate = self.rate.min(FAST);
                }
                return Ok(());
            }
            // the rate tells early that the iterations left will not do
            let mean = (rates[0] * rates[1]).sqrt();
            let fails = mean > 0.95 || norm * mean.powi(most - 1 - iteration) / (1.0 - mean) > CLOSE;
            if iteration > 0 && (rates[1] >= 2.0 || iteration > 1 && fails) {
                break;
            }
            last = norm;
        }
        Err(Why::Newton)
    }

    /// t, q, v, z of the stages from their derivatives: v and z by sums, q by sweeps that solve for one stage after the other.
    fn place(&mut self, system: &dyn System, from: &Node, h: f64) {
        for i in 0..3 {
            let mut state = std::mem::take(&mut self.stage[i].state);
            state.t = from.state.t + NODES[i] * h;
            let [s0, s1, s2] = &self.stage;
            let weights = A[i].map(|a| h * a);
            let sum = |x: &mut [f64], begin: &[f64], [x0, x1, x2]: [&[f64]; 3]| {
                for (k, x) in x.iter_mut().enumerate() {
                    *x = begin[k] + weights[0] * x0[k] + weights[1] * x1[k] + weights[2] * x2[k];
                }
            };
            sum(&mut state.v, &from.state.v, [&s0.a, &s1.a, &s2.a]);
            sum(&mut state.z, &from.state.z, [&s0.zdot, &s1.zdot, &s2.zdot]);
            self.stage[i].state = state;
        }
        for stage in &mut self.stage {
            system.rate(stage.state.t, &stage.state.q, &stage.state.v, &mut stage.rate);
        }
        for sweep in 0..SWEEPS {
            let mut moved = false;
            for i in 0..3 {
                moved |= self.sweep(system, from, h, i);
            }
            if sweep > 0 && !moved {
                break;
            }
        }
    }

    /// Q of one stage from the rates of the others; false if it has not changed by more than round-off.
    fn sweep(&mut self, system: &dyn System, from: &Node, h: f64, i: usize) -> bool {
        self.place.copy_from_slice(&from.state.q);
        for (j, stage) in self.stage.iter().enumerate().filter(|(j, _)| *j != i) {
            let weight = h * A[i][j];
            self.place.iter_mut().zip(&stage.rate).for_each(|(q, r)| *q += weight * r);
        }
        let stage = &mut self.stage[i];
        for ((u, v), w) in self.displacement.iter_mut().zip(&stage.state.v).zip(&stage.w) {
            *u = h * A[i][i] * v + w;
        }
        let span = Span { end: stage.state.t, length: h * A[i][i] };
        system.displace(span, &mut self.place, &self.displacement);
        let moved = stage.state.q.iter().zip(&self.place).any(|(q, p)| (q - p).abs() > 4.0 * f64::EPSILON * (1.0 + p.abs()));
        stage.state.q.copy_from_slice(&self.place);
        system.rate(stage.state.t, &stage.state.q, &stage.state.v, &mut stage.rate);
        moved
    }

    /// Right-hand sides of all stages, and the factors where they are not at hand.
    fn evaluate(&mut self, system: &mut dyn System, engine: &mut Engine, h: f64) -> Result<(), Why> {
        for i in 0..3 {
            let stage = &mut self.stage[i];
            if self.follow {
                engine.follow_modes(system, &mut stage.state);
            }
            engine.evaluate(system, stage.state.at(), Extent::Dynamics);
            self.residual(system, engine, i)?;
            if i == 1 && self.factored.is_none() {
                self.factor(system, engine, h)?;
            }
        }
        Ok(())
    }

    /// Right-hand sides of stage i: −r, g − ż, and the rows of the level; keeps Φ and G for the second right-hand side.
    fn residual(&mut self, system: &mut dyn System, engine: &mut Engine, i: usize) -> Result<(), Why> {
        let Dims { v: nv, z: nz, holonomic, .. } = engine.dims;
        let stage = &mut self.stage[i];
        let (r_a, rest) = self.x[i].split_at_mut(nv);
        let (r_z, r_c) = rest.split_at_mut(nz);
        residual(system, engine, stage.state.at(), &stage.a, &stage.lambda, r_a);
        r_a.iter_mut().for_each(|r| *r = -*r);
        if let Some(row) = r_a.iter().position(|r| !r.is_finite()) {
            return Err(Why::NotFinite(row));
        }
        let t = &engine.terms;
        for ((r, zdot), g) in r_z.iter_mut().zip(&stage.zdot).zip(&t.zdot) {
            *r = g - zdot;
        }
        for (k, (r, row)) in r_c.iter_mut().zip(t.g.lines()).enumerate() {
            *r = match self.level {
                Level::Position if k < holonomic => -t.phi[k],
                Level::Acceleration => t.gamma[k] - row.dot(&stage.a),
                _ => t.nu[k] - row.dot(&stage.state.v),
            };
        }
        if self.level == Level::Stabilized {
            stage.phi.copy_from_slice(&t.phi);
            stage.g.values_mut().copy_from_slice(t.g.values());
        }
        Ok(())
    }

    /// Factors both blocks at the second stage, which was evaluated last.
    fn factor(&mut self, system: &mut dyn System, engine: &mut Engine, h: f64) -> Result<(), Why> {
        let stage = &self.stage[1];
        if !self.linearised {
            engine.counts.tangents += 1;
            system.tangent(stage.state.at(), &stage.a, &stage.lambda, &mut self.blocks.tangent);
            (self.linearised, self.fresh) = (true, true);
        }
        self.blocks.take(&engine.terms);
        engine.counts.factorisations += 2;
        let (c, pair) = (h / REAL, Complex::from(h) / PAIR);
        self.real.factor(&self.blocks, Coefficients { q: c * c, v: c, z: c }).map_err(|_| Why::Singular)?;
        self.complex.factor(&self.blocks, Coefficients { q: pair * pair, v: pair, z: pair }).map_err(|_| Why::Singular)?;
        self.factored = Some(h);
        Ok(())
    }

    /// y = T⁻¹ x: the real component into x₀, the others into `pair`; rows are divided by their coefficient, c² of Φ and c of G v.
    fn separate(&mut self, h: f64) {
        let [x0, x1, x2] = &mut self.x;
        for (k, pair) in self.pair.iter_mut().enumerate() {
            let x = [x0[k], x1[k], x2[k]];
            let y = BACK.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
            x0[k] = y[0];
            *pair = Complex::new(y[1], y[2]);
        }
        let stage = &self.stage[0];
        let begin = stage.a.len() + stage.zdot.len();
        let (real, complex) = (REAL / h, PAIR / Complex::from(h));
        for (k, (x, pair)) in x0[begin..].iter_mut().zip(&mut self.pair[begin..]).enumerate() {
            let power = match self.level {
                Level::Acceleration => 0,
                Level::Position if k < stage.phi.len() => 2,
                _ => 1,
            };
            for _ in 0..power {
                *x *= real;
                *pair *= complex;
            }
        }
    }

    /// Applies the solutions of both blocks, closes the positions, and gives the norm of the step.
    fn correct(&mut self, engine: &Engine, h: f64) -> f64 {
        let Dims { v: nv, z: nz, .. } = engine.dims;
        let (real, complex) = (h / REAL, Complex::from(h) / PAIR);
        let mut square = 0.0;
        for (stage, row) in self.stage.iter_mut().zip(T) {
            let back = |y: f64, pair: Complex<f64>| row[0] * y + row[1] * pair.re + row[2] * pair.im;
            let y = |k: usize| (self.x[0][k], self.pair[k]);
            for k in 0..nv {
                let (y, pair) = y(k);
                stage.a[k] += back(y, pair);
                stage.step[1][k] = back(real * y, complex * pair);
                stage.step[0][k] = back(real * real * y, complex * complex * pair);
            }
            for k in 0..nz {
                let (y, pair) = y(nv + k);
                stage.zdot[k] += back(y, pair);
                stage.step[2][k] = back(real * y, complex * pair);
            }
            for (k, lambda) in stage.lambda.iter_mut().enumerate() {
                let (y, pair) = y(nv + nz + k);
                *lambda += back(y, pair);
            }
            if self.level == Level::Stabilized && !stage.phi.is_empty() {
                self.second.fill(0.0);
                for (s, (phi, row)) in self.second[nv + nz..].iter_mut().zip(stage.phi.iter().zip(stage.g.lines())) {
                    *s = -phi - row.dot(&stage.step[0]);
                }
                self.real.solve(&mut self.second);
                stage.w.iter_mut().zip(&self.second).for_each(|(w, d)| *w += d);
                stage.step[0].iter_mut().zip(&self.second).for_each(|(s, d)| *s += d);
            }
            let [d, dv, dz] = &stage.step;
            square += engine.step_norm(&stage.state, d, dv, dz).powi(2);
        }
        (square / 3.0).sqrt()
    }
}
