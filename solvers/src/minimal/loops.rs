//! The loops of a mechanism: which velocities are independent, how the others follow, how positions are closed.

use crate::{At, Block, Dims, Friction, Kkt, Lu, Span, Sparsity, Stage, State, System, Tangent, Terms};

/// Most Newton steps of a closing.
const CLOSINGS: usize = 12;

/// A correction below this (in units of size) is left: the position is closed to round-off.
const CLOSED: f64 = 1e-13;

/// A correction below this (in units of size) leaves a residual of its square.
const SQUARE_ENOUGH: f64 = 1e-8;

/// Sweeps of a displacement where N is not constant, and the change that needs no further one.
const SWEEPS: usize = 6;
const SWEPT: f64 = 1e-13;

/// Pivot of the scaled rows, and part of the largest pivot, below which a row depends on the others.
const RANK_TOLERANCE: f64 = 1e-8;

/// A system with what follows from its independent velocities; sized once, then free of allocation.
#[derive(Clone, Debug)]
pub(super) struct Loops<S> {
    pub(super) inner: S,
    pub(super) dims: Dims,
    /// Independent rows of Φ (r).
    rows: Vec<usize>,
    pub(super) independent: Vec<usize>,
    dependent: Vec<usize>,
    /// Rows and dependent velocities that were put aside.
    kept: [Vec<usize>; 2],
    /// Columns that elimination has taken.
    taken: Vec<bool>,
    /// Scaled rows of G for elimination (holonomic × nv).
    work: Vec<f64>,
    /// 1/√ of the scale of rows (m) and of the metric (nv).
    row_unit: Vec<f64>,
    unit: Vec<f64>,
    size: Vec<f64>,
    /// The inner state: closed q, v = P v_i + p₀.
    pub(super) state: State,
    /// The guess of which `state.q` is the closed position.
    guess: Vec<f64>,
    /// q̂ of a displacement, and where its last sweep has come to (nq).
    hat: Vec<f64>,
    before: Vec<f64>,
    /// Whether G, its factors and P belong to `guess` at `state.t`.
    known: bool,
    /// Terms of the inner system.
    pub(super) terms: Terms,
    pub(super) tangent: Tangent,
    /// P (nv × n).
    pub(super) p: Vec<f64>,
    /// p₀, ṗ and a = P a_i + ṗ (nv).
    pub(super) drift: Vec<f64>,
    pub(super) bend: Vec<f64>,
    pub(super) a: Vec<f64>,
    /// Inner multipliers (m).
    pub(super) lambda: Vec<f64>,
    /// Of the scaled G_d (r × r).
    lu: Lu,
    /// Serves where rows are redundant.
    kkt: Kkt,
    /// Entries of the holonomic rows of G.
    loop_entries: usize,
    /// The whole accelerations and multipliers where forces depend on reactions, and these forces f_λ (nv; else zeros).
    friction: Option<Friction>,
    pub(super) friction_by_reactions: Vec<f64>,
    whole: (Vec<f64>, Vec<f64>),
    rhs: Vec<f64>,
    left: Vec<f64>,
    zeros: Vec<f64>,
    pub(super) full: Vec<f64>,
}

impl<S: System> Loops<S> {
    /// Loops of a system at a position, with independent velocities of which some are given; none if these do not do.
    pub(super) fn new(mut inner: S, start: &State, given: &[usize]) -> Option<Self> {
        let dims = inner.dims();
        let root = |x: &f64| x.sqrt().recip();
        let (pattern, nv) = (inner.pattern(), dims.v);
        let row_unit = pattern.g_scale.iter().map(root).collect();
        let unit = pattern.metric.iter().map(root).collect();
        let size = pattern.size_v.clone();
        let friction = Friction::of_pattern(dims, pattern);
        let holonomic = Sparsity::new(dims.holonomic, nv, pattern.g.places());
        let loop_entries = holonomic.entries();
        let mut kkt = Kkt::of_blocks(&pattern.mass, &holonomic);
        kkt.set_scale(&pattern.metric, &pattern.g_scale[..dims.holonomic]);
        let mut terms = Terms::new(dims, pattern);
        let tangent = Tangent::new(pattern);
        inner.terms(start.at(), Stage::Velocity, &mut terms);
        let mut loops = Self {
            inner,
            dims,
            rows: Vec::new(),
            independent: Vec::new(),
            dependent: Vec::new(),
            kept: [Vec::with_capacity(dims.holonomic), Vec::with_capacity(nv)],
            taken: vec![false; nv],
            work: vec![0.0; dims.holonomic * nv],
            row_unit,
            unit,
            size,
            state: start.clone(),
            guess: start.q.clone(),
            hat: start.q.clone(),
            before: start.q.clone(),
            known: false,
            terms,
            tangent,
            p: Vec::new(),
            drift: vec![0.0; nv],
            bend: vec![0.0; nv],
            a: vec![0.0; nv],
            lambda: vec![0.0; dims.rows()],
            lu: Lu::new(0),
            kkt,
            loop_entries,
            friction,
            friction_by_reactions: vec![0.0; nv],
            whole: (vec![0.0; nv], vec![0.0; dims.rows()]),
            rhs: vec![0.0; nv],
            left: vec![0.0; nv],
            zeros: vec![0.0; nv],
            full: vec![0.0; nv],
        };
        let most = loops.choose(&[], dims.holonomic);
        if loops.choose(given, dims.holonomic) < most || given.iter().any(|&i| i >= nv) {
            return None;
        }
        loops.rows.sort_unstable();
        loops.lu = Lu::new(loops.rows.len());
        loops.p = vec![0.0; nv * loops.independent.len()];
        Some(loops)
    }

    /// Chooses dependent columns of G by elimination with complete pivoting, none of those `kept`; the number of rows that have
    /// a pivot. At most `most` rows are taken; the first time these become the rows of the loops.
    fn choose(&mut self, kept: &[usize], most: usize) -> usize {
        let (nv, h) = (self.dims.v, self.dims.holonomic);
        self.work.fill(0.0);
        for (i, row) in self.terms.g.lines().take(h).enumerate() {
            row.entries().for_each(|(j, g)| self.work[i * nv + j] = g * self.row_unit[i] * self.unit[j]);
        }
        self.taken.fill(false);
        self.rows.clear();
        self.dependent.clear();
        // sound rows have the length 1: what is far shorter is round-off, also if nothing longer is there
        let mut threshold = RANK_TOLERANCE;
        while self.rows.len() < most {
            let free = |j: &usize| !self.taken[*j] && !kept.contains(j);
            let places = (0..h).filter(|i| !self.rows.contains(i)).flat_map(|i| (0..nv).filter(free).map(move |j| (i, j)));
            let Some((i, j)) = places.max_by(|a, b| self.work[a.0 * nv + a.1].abs().total_cmp(&self.work[b.0 * nv + b.1].abs())) else {
                break;
            };
            let pivot = self.work[i * nv + j];
            if pivot.abs() <= threshold || pivot.is_nan() {
                break;
            }
            threshold = f64::max(threshold, RANK_TOLERANCE * pivot.abs());
            self.taken[j] = true;
            self.rows.push(i);
            self.dependent.push(j);
            for other in (0..h).filter(|k| !self.rows.contains(k)) {
                let factor = self.work[other * nv + j] / pivot;
                for k in 0..nv {
                    self.work[other * nv + k] -= factor * self.work[i * nv + k];
                }
            }
        }
        self.dependent.sort_unstable();
        self.independent.clear();
        self.independent.extend((0..nv).filter(|j| !self.taken[*j]));
        self.rows.len()
    }

    /// Chooses independent velocities anew at the position closed last; leaves them as they are where rank is lost.
    pub(super) fn choose_anew(&mut self) {
        self.keep();
        if self.choose(&[], self.lu.order()) < self.lu.order() {
            self.restore();
        }
        self.rows.sort_unstable();
        self.known = false;
    }

    /// Quality of the chart that would be chosen anew at the position closed last; 0 where rank is lost.
    pub(super) fn best_quality(&mut self) -> f64 {
        self.keep();
        let full = self.choose(&[], self.lu.order()) == self.lu.order();
        let best = if full && self.factor() { self.quality() } else { 0.0 };
        self.restore();
        self.factor();
        best
    }

    /// Takes the best chart at a state of the inner system; its quality, 0 where rank is lost.
    pub(super) fn enter(&mut self, inner: &State) -> f64 {
        self.state.copy_from(inner);
        self.inner.terms(self.state.at(), Stage::Velocity, &mut self.terms);
        self.choose_anew();
        if self.factor() { self.quality() } else { 0.0 }
    }

    /// Puts the present choice aside.
    fn keep(&mut self) {
        let [rows, dependent] = &mut self.kept;
        rows.clone_from(&self.rows);
        dependent.clone_from(&self.dependent);
    }

    /// Takes the choice that was put aside.
    fn restore(&mut self) {
        let [rows, dependent] = &self.kept;
        self.rows.clone_from(rows);
        self.dependent.clone_from(dependent);
        self.independent.clear();
        self.independent.extend((0..self.dims.v).filter(|j| !self.dependent.contains(j)));
    }

    /// Closes anew at the next evaluation: the inner system may have changed.
    pub(super) fn forget(&mut self) {
        self.known = false;
    }

    /// Takes a time; modes and parameters stay those of the last evaluation.
    pub(super) fn at_time(&mut self, t: f64) {
        if self.state.t != t {
            self.state.t = t;
            self.known = false;
        }
    }

    /// Takes time, modes and parameters of a state, and its chart from the last modes.
    pub(super) fn take(&mut self, at: At<'_>) {
        let (modes, chart) = at.modes.split_at(self.dims.modes);
        let same = self.state.t == at.t && self.state.live == at.live && self.state.modes == modes;
        if !same {
            self.known = false;
            self.state.t = at.t;
            self.state.live.copy_from_slice(at.live);
            self.state.modes.copy_from_slice(modes);
        }
        if !self.independent.iter().map(|&i| i as i32).eq(chart.iter().copied()) {
            self.known = false;
            self.independent.clear();
            self.independent.extend(chart.iter().map(|&i| i as usize));
            self.dependent.clear();
            self.dependent.extend((0..self.dims.v).filter(|j| !self.independent.contains(j)));
        }
        self.state.z.copy_from_slice(at.z);
    }

    /// Closes a position at the time taken last, with G_d, P and p₀ there; false if it cannot be closed.
    pub(super) fn position(&mut self, q: &[f64]) -> bool {
        if self.known && self.guess == q {
            return true;
        }
        self.guess.copy_from_slice(q);
        self.state.q.copy_from_slice(q);
        self.known = self.close();
        if self.known {
            self.span();
        }
        self.known
    }

    /// Newton's method on Φ = 0 with the dependent velocities, from `state.q`.
    fn close(&mut self) -> bool {
        let (mut last, mut done) = (f64::INFINITY, false);
        for _ in 0..CLOSINGS {
            let s = &self.state;
            let at = At { t: s.t, q: &s.q, v: &self.zeros, z: &s.z, modes: &s.modes, live: &s.live };
            self.inner.terms(at, Stage::Velocity, &mut self.terms);
            if !self.factor() {
                return false;
            }
            if done {
                return true;
            }
            for (r, &row) in self.rhs.iter_mut().zip(&self.rows) {
                *r = -self.terms.phi[row];
            }
            self.solve();
            self.full.fill(0.0);
            let mut size = 0.0;
            for (x, &j) in self.rhs.iter().zip(&self.dependent) {
                self.full[j] = *x;
                size = f64::max(size, x.abs() / self.size[j]);
            }
            if size < CLOSED {
                return true;
            }
            if size >= 2.0 * last || !size.is_finite() {
                return false;
            }
            self.inner.retract(Span::at(self.state.t), &mut self.state.q, &self.full);
            (last, done) = (size, size < SQUARE_ENOUGH);
        }
        false
    }

    /// Factors the scaled G_d.
    fn factor(&mut self) -> bool {
        let r = self.rows.len();
        let matrix = self.lu.matrix_mut();
        for (i, &row) in self.rows.iter().enumerate() {
            for (j, &column) in self.dependent.iter().enumerate() {
                matrix[i * r + j] = self.terms.g.at(row, column) * self.row_unit[row] * self.unit[column];
            }
        }
        r == 0 || self.lu.factor_in_place().is_ok()
    }

    /// rhs := G_d⁻¹ rhs, by rows in, by dependent velocities out.
    fn solve(&mut self) {
        let r = self.rows.len();
        self.rhs.iter_mut().zip(&self.rows).for_each(|(x, &i)| *x *= self.row_unit[i]);
        self.lu.solve(&mut self.rhs[..r]);
        self.rhs.iter_mut().zip(&self.dependent).for_each(|(x, &j)| *x *= self.unit[j]);
    }

    /// P = [−G_d⁻¹ G_i; I] and p₀ = [G_d⁻¹ ν; 0].
    fn span(&mut self) {
        let n = self.independent.len();
        for k in 0..n {
            let column = self.independent[k];
            for (r, &row) in self.rhs.iter_mut().zip(&self.rows) {
                *r = -self.terms.g.at(row, column);
            }
            self.solve();
            for (x, &j) in self.rhs.iter().zip(&self.dependent) {
                self.p[j * n + k] = *x;
            }
            for (other, &i) in self.independent.iter().enumerate() {
                self.p[i * n + k] = f64::from(u8::from(other == k));
            }
        }
        self.rhs.iter_mut().zip(&self.rows).for_each(|(r, &row)| *r = self.terms.nu[row]);
        self.solve();
        self.drift.fill(0.0);
        self.rhs.iter().zip(&self.dependent).for_each(|(x, &j)| self.drift[j] = *x);
    }

    /// The state of the inner system: v = P v_i + p₀ after [`Loops::take`] and [`Loops::position`]; false if it cannot be closed.
    pub(super) fn reach(&mut self, at: At<'_>) -> bool {
        self.take(at);
        self.velocity(at.t, at.q, at.v)
    }

    /// v = P v_i + p₀ at a closed position; false if it cannot be closed.
    pub(super) fn velocity(&mut self, t: f64, q: &[f64], v: &[f64]) -> bool {
        self.at_time(t);
        let closed = self.position(q);
        self.spread(v);
        self.state.v.iter_mut().zip(&self.full).zip(&self.drift).for_each(|((v, x), p)| *v = x + p);
        closed
    }

    /// a = P a_i + ṗ after [`Loops::evaluate`].
    pub(super) fn accelerate(&mut self, a: &[f64]) {
        self.spread(a);
        self.a.iter_mut().zip(&self.full).zip(&self.bend).for_each(|((a, x), p)| *a = x + p);
    }

    /// P x into `full`.
    pub(super) fn spread(&mut self, x: &[f64]) {
        for (y, row) in self.full.iter_mut().zip(self.p.chunks_exact(x.len().max(1))) {
            *y = row.iter().zip(x).map(|(p, x)| p * x).sum();
        }
        if x.is_empty() {
            self.full.fill(0.0);
        }
    }

    /// Terms of the inner system at [`Loops::reach`], ṗ = [G_d⁻¹ γ; 0], and with the dynamics f_λ; not numbers where friction by
    /// reactions has no solution.
    pub(super) fn evaluate(&mut self, stage: Stage) {
        self.inner.terms(self.state.at(), stage, &mut self.terms);
        self.rhs.iter_mut().zip(&self.rows).for_each(|(r, &row)| *r = self.terms.gamma[row]);
        self.solve();
        self.bend.fill(0.0);
        self.rhs.iter().zip(&self.dependent).for_each(|(x, &j)| self.bend[j] = *x);
        if stage == Stage::Dynamics {
            self.reaction_friction();
        }
    }

    /// f_λ of the accelerations and multipliers that the state has.
    fn reaction_friction(&mut self) {
        let Self { inner, state, terms, friction, friction_by_reactions, whole: (a, lambda), .. } = self;
        let Some(friction) = friction else { return };
        a.fill(0.0);
        lambda.fill(0.0);
        let friction_of = &mut |l: &[f64], f: &mut [f64], slope: &mut Block| inner.reaction_friction(state.at(), l, f, slope);
        match friction.solve(terms, friction_of, a, lambda) {
            Ok(()) => friction_by_reactions.copy_from_slice(friction.force(lambda, friction_of)),
            Err(_) => friction_by_reactions.fill(f64::NAN),
        }
    }

    /// a = P a_i + ṗ and the inner multipliers that carry it, given those of the velocity-level rows; after
    /// [`Loops::evaluate`] of the dynamics.
    ///
    /// Gᵀλ = f − M a has one solution with the independent rows, and where others are redundant that of least λᵀEλ.
    pub(super) fn react(&mut self, a: &[f64], lambda: &[f64]) {
        let h = self.dims.holonomic;
        self.accelerate(a);
        let rows = self.terms.mass.lines().zip(&self.terms.force);
        for ((r, (row, f)), friction_of) in self.full.iter_mut().zip(rows).zip(&self.friction_by_reactions) {
            *r = f + friction_of - row.dot(&self.a);
        }
        self.terms.g.lines().skip(h).zip(lambda).for_each(|(row, l)| row.add_to(-l, &mut self.full));
        self.lambda[h..].copy_from_slice(lambda);
        if self.rows.len() == h {
            self.rhs.iter_mut().zip(&self.dependent).for_each(|(x, &j)| *x = self.full[j] * self.unit[j]);
            self.lu.solve_transposed(&mut self.rhs[..h]);
            for (l, (x, unit)) in self.lambda.iter_mut().zip(self.rhs[..h].iter().zip(&self.row_unit)) {
                *l = x * unit;
            }
        } else if self.kkt.factor(self.terms.mass.values(), &self.terms.g.values()[..self.loop_entries]).is_ok() {
            self.work[..h].fill(0.0);
            self.kkt.solve(&self.full, &self.work[..h], &mut self.left, &mut self.lambda[..h]);
        } else {
            self.lambda.fill(f64::NAN);
        }
    }

    /// The smallest singular value of the scaled G_d at the position closed last.
    pub(super) fn quality(&mut self) -> f64 {
        let r = self.rows.len();
        if r == 0 {
            return 1.0;
        }
        self.left[..r].fill(0.0);
        self.lu.smallest_singular_value(3, &mut self.left[..r], &mut self.rhs[..r])
    }

    /// P δ + p₀ · length at the position closed last, into `full`.
    fn way(&mut self, delta: &[f64], length: f64) {
        self.spread(delta);
        self.full.iter_mut().zip(&self.drift).for_each(|(x, p)| *x += length * p);
    }

    /// q := what closes from it; false if nothing does.
    fn closed(&mut self, q: &mut [f64]) -> bool {
        let closed = self.position(q);
        if closed {
            q.copy_from_slice(&self.state.q);
            self.guess.copy_from_slice(q);
        }
        closed
    }

    /// q := what closes from q ⊕ (P δ + p₀ · length), at the end of the span.
    pub(super) fn retract(&mut self, span: Span, q: &mut [f64], delta: &[f64]) {
        self.at_time(span.end);
        self.position(q);
        self.way(delta, span.length);
        self.inner.retract(span, q, &self.full);
        self.closed(q);
    }

    /// q := what closes from the solution of q = q̂ + N(q) (P u + p₀ · length), at the end of the span, with P and p₀ there: a closing
    /// moves the independent ones of three turns about a point with the dependent ones, so it must have nothing to do in the end.
    pub(super) fn displace(&mut self, span: Span, q: &mut [f64], u: &[f64]) {
        self.at_time(span.end);
        self.hat.copy_from_slice(q);
        self.position(q);
        for _ in 0..if self.dims.q > self.dims.v { SWEEPS } else { 1 } {
            self.way(u, span.length);
            self.before.copy_from_slice(q);
            q.copy_from_slice(&self.hat);
            self.inner.displace(span, q, &self.full);
            if !self.closed(q) || self.before.iter().zip(&*q).all(|(b, q)| (b - q).abs() <= SWEPT * (1.0 + q.abs())) {
                return;
            }
        }
    }
}
