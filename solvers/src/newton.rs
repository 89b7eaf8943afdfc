//! Newton's method for one implicit stage: all single-stage schemes are a predictor and coefficients.
//!
//! Unknown are a, ż, λ and a displacement w. With v = v̂ + c_v a, z = ẑ + c_z ż and q placed by one of
//!
//! ```text
//! q = q̂ ⊕ (d̂ + c_q a + w)              Retract: the Newmark family, one-step increments on the group
//! q = q̂ + N(q) (c_v v + w)             Displace: multistep, q a vector; c_q = c_v²
//! ```
//!
//! the equations are M a + Gᵀλ = f, ż = g and the constraint rows of the [`Level`]:
//! −Φ/c_q, (ν − G v)/c_v or γ − G a as right-hand side of G Δa, so that one matrix serves all. At `Stabilized`, G Δa closes the
//! velocities, and w closes the positions by a second right-hand side on the same factors (Gear, Gupta & Leimkuhler 1985,
//! with the multiplier μ of Gᵀμ in the rates of q):
//!
//! ```text
//! [ M̂  Gᵀ ] [ Δw ]   [          0         ]
//! [ G  −E ] [ μ  ] = [ −Φ − c_q G Δa ].
//! ```
//!
//! Without the term in Δa the iteration diverges closer than about half a step to a singular position (measured).
//! Convergence is tested on the step in q, v and z; a raw Δλ would amplify round-off by 1/h².

use crate::engine::{Engine, Why};
use crate::matrix::{Blocks, Coefficients, Matrix};
use crate::scheme::Level;
use crate::{At, Dims, Span, Stage, State, System};

/// How displacements act on q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// q = q̂ ⊕ (d̂ + c_q a + w).
    Retract,
    /// q = q̂ + N(q)(c_v v + w).
    Displace,
}

/// The equations of one stage. Slices: q̂ (nq), d̂ and v̂ (nv), ẑ (nz).
#[derive(Clone, Copy, Debug)]
pub struct Implicit<'a> {
    /// Time of the stage, s.
    pub t: f64,
    /// Time between q̂ and q, s: c_v of [`Place::Displace`].
    pub span: f64,
    /// q̂.
    pub q: &'a [f64],
    /// d̂; not read by [`Place::Displace`].
    pub d: &'a [f64],
    /// v̂.
    pub v: &'a [f64],
    /// ẑ.
    pub z: &'a [f64],
    /// c_q, c_v, c_z.
    pub c: Coefficients<f64>,
    /// How q is placed.
    pub place: Place,
    /// Which rows are imposed.
    pub level: Level,
    /// Whether the modes are taken anew from the state in each iteration (marching across switches).
    pub follow: bool,
}

/// The unknowns: predictions when they come in, the solution when they go out.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// a (nv).
    pub a: Vec<f64>,
    /// ż (nz).
    pub zdot: Vec<f64>,
    /// λ (m).
    pub lambda: Vec<f64>,
    /// w (nv): what closes the positions at [`Level::Stabilized`], else 0.
    pub w: Vec<f64>,
}

impl Unknown {
    /// Zeros of the right sizes.
    pub fn new(dims: Dims) -> Self {
        Self { a: vec![0.0; dims.v], zdot: vec![0.0; dims.z], lambda: vec![0.0; dims.rows()], w: vec![0.0; dims.v] }
    }

    /// Copies another one without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.a.copy_from_slice(&other.a);
        self.zdot.copy_from_slice(&other.zdot);
        self.lambda.copy_from_slice(&other.lambda);
        self.w.copy_from_slice(&other.w);
    }
}

/// The iteration with its factors, which outlive a step.
#[derive(Clone, Debug)]
pub struct Newton {
    /// Blocks at the last linearisation.
    pub blocks: Blocks,
    /// The factored matrix.
    pub matrix: Matrix<f64>,
    /// Coefficients of the factors; none before the first factorisation or after the blocks have changed.
    factored: Option<Coefficients<f64>>,
    /// Whether the tangents belong to the present neighbourhood.
    fresh: bool,
    /// Whether there are any.
    linearised: bool,
    /// Rate of the last iteration that converged.
    rate: f64,
    /// The best rate that is believed without being measured. Multistep methods need 0.3: their differences magnify what a first
    /// step leaves (measured: with 1e-3 up to thirteen times the steps).
    pub trust: f64,
    /// The rate that a first step is trusted with: it grows while it is not measured, since the factors get older.
    believed: f64,
    x: Vec<f64>,
    second: Vec<f64>,
    step_q: Vec<f64>,
    step_v: Vec<f64>,
    step_z: Vec<f64>,
    kept: Unknown,
}

/// Most iterations with one set of factors.
const ITERATIONS: usize = 8;

/// A last step is good enough when what follows it is below this part of the tolerance.
const CLOSE: f64 = 0.02;

/// Steps below this, in units of size, may be round-off at strict tolerances: shorter steps in time do not make them smaller.
const ROUNDED: f64 = 1e-12;

/// A rate above this asks for new tangents in the next step.
const SLOW: f64 = 0.25;

impl Newton {
    /// Room for a system.
    pub fn new(system: &dyn System) -> Self {
        let dims = system.dims();
        let n = dims.v + dims.z + dims.rows();
        Self {
            blocks: Blocks::new(system.pattern()),
            matrix: Matrix::new(dims, system.pattern()),
            factored: None,
            fresh: false,
            linearised: false,
            rate: 0.0,
            trust: 1e-3,
            believed: 0.0,
            x: vec![0.0; n],
            second: vec![0.0; n],
            step_q: vec![0.0; dims.v],
            step_v: vec![0.0; dims.v],
            step_z: vec![0.0; dims.z],
            kept: Unknown::new(dims),
        }
    }

    /// Forgets tangents and factors: the neighbourhood has changed (an event, a restart).
    pub fn forget(&mut self) {
        (self.linearised, self.factored) = (false, None);
    }

    /// Solves a stage. `x` holds predictions; `state` receives t, q, v, z (its modes and live parameters are read).
    ///
    /// # Errors
    /// [`Why::Newton`] if the iteration does not converge with fresh tangents, [`Why::Singular`], [`Why::NotFinite`].
    pub fn solve(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        stage: &Implicit<'_>,
        x: &mut Unknown,
        state: &mut State,
    ) -> Result<(), Why> {
        self.fresh = false;
        if self.rate > SLOW {
            self.forget();
        }
        self.kept.copy_from(x);
        let tried = self.iterate(system, engine, stage, x, state);
        if tried.is_ok() || self.fresh {
            return tried;
        }
        self.forget();
        x.copy_from(&self.kept);
        self.iterate(system, engine, stage, x, state)
    }

    fn iterate(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        stage: &Implicit<'_>,
        x: &mut Unknown,
        state: &mut State,
    ) -> Result<(), Why> {
        let mut last = f64::INFINITY;
        // as in Hairer & Wanner, Solving ODEs II, section IV.8: a rate that is not measured again tends to 1
        self.believed = if self.factored == Some(stage.c) { self.believed.max(self.trust).powf(0.8) } else { 0.5 };
        let mut rate = self.believed;
        // given steps start far from what they aim at
        let most = if engine.is_fixed() { 3 * ITERATIONS } else { ITERATIONS };
        for iteration in 0..most {
            place(system, engine, stage, x, state, &mut self.step_q);
            if stage.follow {
                engine.follow_modes(system, state);
            }
            engine.counts.iterations += 1;
            engine.evaluate(system, state.at(), Stage::Dynamics);
            self.residual(system, engine, stage, x, state)?;
            self.refactor(system, engine, stage.c, state.at(), x)?;
            self.correct(engine, stage);
            x.w.iter_mut().zip(&self.second).for_each(|(w, d)| *w += d);
            self.step_q.iter_mut().zip(&self.second).for_each(|(s, d)| *s += d);
            let norm = engine.step_norm(state, &self.step_q, &self.step_v, &self.step_z);
            if !norm.is_finite() {
                return Err(Why::Newton);
            }
            x.a.iter_mut().zip(&self.x).for_each(|(a, d)| *a += d);
            x.zdot.iter_mut().zip(&self.x[engine.dims.v..]).for_each(|(z, d)| *z += d);
            x.lambda.iter_mut().zip(&self.x[engine.dims.v + engine.dims.z..]).for_each(|(l, d)| *l += d);
            if iteration > 0 {
                rate = norm / last;
                self.rate = rate.min(1.0);
                self.believed = self.rate;
            }
            // round-off: given steps aim at 1e-12, which a step of this size can no longer better
            let noise = noise(engine, stage, state) / engine.tolerance();
            let rounded =
                (iteration > 0 && rate > 0.3 && norm < if engine.is_fixed() { 30.0 } else { (ROUNDED / engine.tolerance()).max(1e-3) })
                    || (iteration > 1 && rate > 0.5 && norm < f64::max(0.05, noise));
            if rounded || (rate < 1.0 && norm * rate / (1.0 - rate) < CLOSE) || norm == 0.0 {
                place(system, engine, stage, x, state, &mut self.step_q);
                return Ok(());
            }
            if iteration > 0 && rate >= 2.0 || iteration > 1 && rate > 0.9 {
                break;
            }
            last = norm;
        }
        Err(Why::Newton)
    }

    /// Right-hand sides of the dynamic equations, of ż, and of the rows.
    fn residual(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        stage: &Implicit<'_>,
        x: &Unknown,
        state: &State,
    ) -> Result<(), Why> {
        let Dims { v: nv, z: nz, holonomic, .. } = engine.dims;
        let (r_a, rest) = self.x.split_at_mut(nv);
        let (r_z, r_c) = rest.split_at_mut(nz);
        residual(system, engine, state.at(), &x.a, &x.lambda, r_a);
        r_a.iter_mut().for_each(|r| *r = -*r);
        if let Some(i) = r_a.iter().position(|r| !r.is_finite()) {
            return Err(Why::NotFinite(i));
        }
        for ((r, zdot), g) in r_z.iter_mut().zip(&x.zdot).zip(&engine.terms.zdot) {
            *r = g - zdot;
        }
        let t = &engine.terms;
        for (i, (r, row)) in r_c.iter_mut().zip(t.g.lines()).enumerate() {
            *r = match stage.level {
                Level::Position if i < holonomic => -t.phi[i] / stage.c.q,
                Level::Acceleration => t.gamma[i] - row.dot(&x.a),
                _ => (t.nu[i] - row.dot(&state.v)) / stage.c.v,
            };
        }
        Ok(())
    }

    /// Keeps the factors while they converge fast with the same coefficients; takes M and G, which are at hand, and when
    /// nothing else helps the tangents anew.
    fn refactor(&mut self, system: &mut dyn System, engine: &mut Engine, c: Coefficients<f64>, at: At<'_>, x: &Unknown) -> Result<(), Why> {
        if self.factored == Some(c) {
            return Ok(());
        }
        if !self.linearised {
            engine.counts.tangents += 1;
            system.tangent(at, &x.a, &x.lambda, &mut self.blocks.tangent);
            (self.linearised, self.fresh) = (true, true);
        }
        self.blocks.take(&engine.terms);
        engine.counts.factorisations += 1;
        self.matrix.factor(&self.blocks, c).map_err(|_| Why::Singular)?;
        self.factored = Some(c);
        Ok(())
    }

    /// Turns right-hand sides into steps: `x` holds Δa, Δż, Δλ, `second` begins with Δw (0 but at `Stabilized`), and `step_q`,
    /// `step_v`, `step_z` are what Δa and Δż move.
    fn correct(&mut self, engine: &Engine, stage: &Implicit<'_>) {
        let Dims { v: nv, z: nz, holonomic, .. } = engine.dims;
        self.matrix.solve(&mut self.x);
        let c = stage.c;
        for i in 0..nv {
            (self.step_q[i], self.step_v[i]) = (c.q * self.x[i], c.v * self.x[i]);
        }
        self.step_z.iter_mut().zip(&self.x[nv..]).for_each(|(s, d)| *s = c.z * d);
        if stage.level == Level::Stabilized && holonomic > 0 {
            self.second.fill(0.0);
            let t = &engine.terms;
            let rows = t.phi.iter().zip(t.g.lines());
            for (r, (phi, row)) in self.second[nv + nz..].iter_mut().zip(rows) {
                *r = -phi - row.dot(&self.step_q);
            }
            self.matrix.solve(&mut self.second);
        }
    }
}

/// What the rounding of q leaves: in q itself, by what it is in units of size, and where positions determine velocities in v,
/// 2ε |q| c_v/c_q.
fn noise(engine: &Engine, stage: &Implicit<'_>, state: &State) -> f64 {
    let largest = state.q.iter().fold(0.0, |m, q| f64::max(m, q.abs()));
    let of_v = if stage.level == Level::Position { 2.0 * f64::EPSILON * largest * stage.c.v / stage.c.q } else { 0.0 };
    of_v.max(2.0 * engine.rounding(&state.q))
}

/// r = M a + Gᵀλ − f − f_λ of the terms evaluated last at `at`.
pub fn residual(system: &mut dyn System, engine: &mut Engine, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]) {
    let t = &engine.terms;
    r.fill(0.0);
    t.g.lines().zip(lambda).for_each(|(row, l)| row.add_to(*l, r));
    for ((r, row), f) in r.iter_mut().zip(t.mass.lines()).zip(&t.force) {
        *r = row.dot(a) + *r - f;
    }
    if let Some(friction) = &mut engine.friction {
        let force = friction.force(lambda, &mut |l, f, slope| system.reaction_friction(at, l, f, slope));
        r.iter_mut().zip(force).for_each(|(r, f)| *r -= f);
    }
}

/// t, q, v and z of a stage from its unknowns.
fn place(system: &dyn System, engine: &Engine, stage: &Implicit<'_>, x: &Unknown, state: &mut State, d: &mut [f64]) {
    debug_assert_eq!(engine.dims.v, d.len());
    state.t = stage.t;
    for ((v, hat), a) in state.v.iter_mut().zip(stage.v).zip(&x.a) {
        *v = hat + stage.c.v * a;
    }
    for ((z, hat), r) in state.z.iter_mut().zip(stage.z).zip(&x.zdot) {
        *z = hat + stage.c.z * r;
    }
    state.q.copy_from_slice(stage.q);
    let span = Span { end: stage.t, length: stage.span };
    match stage.place {
        Place::Retract => {
            for (i, d) in d.iter_mut().enumerate() {
                *d = stage.d[i] + stage.c.q * x.a[i] + x.w[i];
            }
            system.retract(span, &mut state.q, d);
        }
        Place::Displace => {
            for (i, d) in d.iter_mut().enumerate() {
                *d = stage.c.v * state.v[i] + x.w[i];
            }
            system.displace(span, &mut state.q, d);
        }
    }
}
