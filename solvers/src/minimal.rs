//! Minimal coordinates by coordinate partitioning (Wehage & Haug, J. Mech. Des. 104 (1982) 247-255): a system without holonomic
//! rows, made of one with them.
//!
//! Velocities are divided into dependent and independent ones, v = (v_d, v_i), such that G_d is regular:
//!
//! ```text
//! P = [−G_d⁻¹ G_i; I],   v = P v_i + p₀,  p₀ = [G_d⁻¹ ν; 0],   a = P a_i + ṗ,  ṗ = [G_d⁻¹ γ; 0]
//! PᵀM P a_i + (ΨP)ᵀλ = Pᵀ(f − M ṗ),   ΨP a_i = γ_Ψ − Ψ ṗ
//! ```
//!
//! Velocity-level rows Ψ stay rows. Coordinates are all those of the inner system; the part that depends on the others and on time
//! is a guess only, from which every evaluation closes the loops at its own time by Newton's method. So rows may depend on time, and
//! the branch of the linkage is the one nearest to where it was.

use crate::engine::{Node, Why};
use crate::kkt::row_scale;
use crate::{Ahead, At, Block, Common, Dims, Effect, Line, Pattern, Power, Span, Stage, State, System, Tangent, Terms};
use loops::Loops;
use std::cell::RefCell;

mod crossing;
mod loops;

/// Part of the best quality below which the chart is changed, unless the caller knows better.
const POOR: f64 = 0.1;

/// Part that the best quality in a position must have of the best one at the start: below, a singular position is near, where every chart
/// degenerates, and above this many times that it is left behind.
const SINGULAR: f64 = 0.1;
const BEHIND: f64 = 2.0;

/// Part of the quality at the start below which the best one is looked for.
const WATCHED: f64 = 0.3;

/// Why a system has no minimal coordinates of this kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// The velocities asked for depend on each other, or there are more of them than degrees of freedom.
    Dependent,
    /// The loops cannot be closed at the start.
    Open,
}

/// A system in minimal coordinates.
///
/// q is the whole q of the inner system, v its independent velocities, λ the multipliers of its velocity-level rows. The chart (which
/// velocities are independent) stands behind the inner modes in [`State::modes`], so that evaluations stay pure; the last root
/// function but one watches it, and its crossing chooses another one and restarts the scheme. Its quality is the smallest singular value
/// of diag(g_scale)^−½ G_d D_d^−½; see [`Minimal::change_chart_at`].
///
/// In a singular position there are no independent velocities that determine the others. The last root function stops a run near one;
/// the caller goes on with the inner system in whole coordinates, until [`Minimal::enter`] finds the place passed.
///
/// [`retract`](System::retract), [`displace`](System::displace) and the rates are told no modes: they use those of the last
/// evaluation.
///
/// Forces f_λ that depend on the reactions are those of the accelerations that the state has with them: the whole equations are
/// solved at each evaluation, and f_λ counts among the forces here.
///
/// The tangent is approximate: PᵀKP, PᵀCP and so on, without the derivatives of P and ṗ, which would need second and third
/// derivatives of Φ, and with f_λ held. What is missing is of the size of the velocities and of the coefficients of friction, so
/// Newton's method converges like h|v| and like these.
#[derive(Clone, Debug)]
pub struct Minimal<S> {
    loops: RefCell<Loops<S>>,
    dims: Dims,
    inner: Dims,
    pattern: Pattern,
    /// Quality of the chart at the start and of the best one there, and the part of the best one below which the chart is changed.
    quality: f64,
    best: f64,
    poor: f64,
    /// Whether a run was stopped near a singular position.
    singular: bool,
    /// M P (nv × n), and rows or columns of products with P.
    product: Vec<f64>,
    row: Vec<f64>,
}

impl<S: System> Minimal<S> {
    /// Wraps a system that is consistent at `start`; the velocities `independent` are, and the missing ones are chosen by pivoting.
    ///
    /// # Errors
    /// See [`Refused`].
    pub fn new(inner: S, start: &State, independent: &[usize]) -> Result<Self, Refused> {
        let of_inner = inner.dims();
        let mut loops = Loops::new(inner, start, independent).ok_or(Refused::Dependent)?;
        let n = loops.independent.len();
        let dims = Dims { v: n, holonomic: 0, modes: of_inner.modes + n, roots: of_inner.roots + 2, ..of_inner };
        let modes: Vec<i32> = start.modes.iter().copied().chain(loops.independent.iter().map(|&i| i as i32)).collect();
        let v: Vec<f64> = loops.independent.iter().map(|&i| start.v[i]).collect();
        if !loops.reach(At { t: start.t, q: &start.q, v: &v, z: &start.z, modes: &modes, live: &start.live }) {
            return Err(Refused::Open);
        }
        let quality = loops.quality();
        let best = loops.best_quality();
        let product = vec![0.0; of_inner.v * n.max(of_inner.z)];
        let row = vec![0.0; of_inner.v];
        let pattern = Pattern::dense(dims);
        let mut minimal =
            Self { loops: RefCell::new(loops), dims, inner: of_inner, pattern, quality, best, poor: POOR, singular: false, product, row };
        minimal.scale(At { t: start.t, q: &start.q, v: &v, z: &start.z, modes: &modes, live: &start.live });
        Ok(minimal)
    }

    /// Scales of the equations at the start.
    fn scale(&mut self, at: At<'_>) {
        let mut terms = Terms::new(self.dims, &self.pattern);
        self.terms(at, Stage::Position, &mut terms);
        let n = self.dims.v;
        let loops = self.loops.get_mut();
        let inner = loops.inner.pattern();
        let p = &mut self.pattern;
        p.metric = (0..n).map(|i| terms.mass.at(i, i)).map(|m| if m > 0.0 { m } else { 1.0 }).collect();
        p.g_scale = row_scale(&p.g, terms.g.values(), &p.metric);
        p.size_q = inner.size_q.clone();
        p.size_v = loops.independent.iter().map(|&i| inner.size_v[i]).collect();
        p.size_z.clone_from(&inner.size_z);
        let place = |k: usize| loops.independent.iter().position(|i| *i == k);
        p.common = inner.common.iter().map(|common| restricted(common, place)).collect();
        p.power = inner.power;
        p.roots_by_reactions = inner.roots_by_reactions;
        p.striking.clone_from(&inner.striking);
        p.closing = inner.closing.clone();
        p.forceful = inner.forceful.clone();
        p.timed = inner.timed.clone();
        p.observing = inner.observing.clone();
        p.nested = inner.nested.clone();
        p.rough = inner.rough.clone();
        let own = [self.inner.roots, self.inner.roots + 1];
        p.rough.extend(own);
        p.acting = inner.acting.iter().copied().chain(own).collect();
    }

    /// Changes the chart at this part of the quality of the best chart there is, instead of 0.1; not before it has fallen to three
    /// times this part of the quality at the start.
    ///
    /// A chart that degenerates ends in a turning point of its coordinates, and what it leaves as an error of the independent
    /// coordinates reaches the other coordinates divided by its quality, their velocities by its square (measured on a pendulum in x
    /// and y, `newmark` at 1e-5: an error of 5e-3 with 1e-3, of 1e-3 with 0.1). Where every chart is poor, as in a singular position,
    /// none is better, and the chart stays.
    pub fn change_chart_at(&mut self, part: f64) {
        self.poor = part;
    }

    /// Whether a run was stopped near a singular position.
    pub fn is_singular(&self) -> bool {
        self.singular
    }

    /// The best quality at the start, or another one if that is greater: the measure of singular positions. By it the start may be near
    /// one itself.
    pub fn sound(&mut self, other: f64) -> f64 {
        self.singular = self.best < BEHIND * SINGULAR * other;
        self.best = self.best.max(other);
        self.best
    }

    /// Takes the best chart at a state of the inner system; false near a singular position.
    pub fn enter(&mut self, inner: &State) -> bool {
        self.singular = self.loops.get_mut().enter(inner) < BEHIND * SINGULAR * self.best;
        !self.singular
    }

    /// The inner system.
    pub fn inner_mut(&mut self) -> &mut S {
        let loops = self.loops.get_mut();
        loops.forget();
        &mut loops.inner
    }

    /// The independent velocities of the chart used last.
    pub fn independent(&self) -> Vec<usize> {
        self.loops.borrow().independent.clone()
    }

    /// The state in minimal coordinates of a consistent state of the inner system, in the chart used last.
    pub fn reduced(&self, inner: &State) -> State {
        let loops = self.loops.borrow();
        let chart = loops.independent.iter();
        State {
            v: chart.clone().map(|&i| inner.v[i]).collect(),
            modes: inner.modes.iter().copied().chain(chart.map(|&i| i as i32)).collect(),
            ..inner.clone()
        }
    }

    /// The node of the inner system (closed q, all velocities, accelerations and multipliers) of one in minimal coordinates.
    ///
    /// # Errors
    /// If the loops cannot be closed.
    pub fn whole(&mut self, node: &Node, out: &mut Node) -> Result<(), Why> {
        if !self.react(node.state.at(), &node.a, &node.lambda) {
            return Err(Why::Constraints { row: 0, residual: f64::NAN });
        }
        let loops = self.loops.get_mut();
        out.state.copy_from(&loops.state);
        out.state.work.copy_from_slice(&node.state.work);
        out.a.copy_from_slice(&loops.a);
        out.lambda.copy_from_slice(&loops.lambda);
        out.zdot.copy_from_slice(&node.zdot);
        Ok(())
    }

    /// All multipliers of the inner system (m) for the accelerations of the independent velocities and the multipliers of the
    /// velocity-level rows; not numbers where the loops cannot be closed.
    pub fn lambda(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], out: &mut [f64]) {
        if self.react(at, a, lambda) {
            out.copy_from_slice(&self.loops.get_mut().lambda);
        } else {
            out.fill(f64::NAN);
        }
    }

    /// The inner state, its terms, accelerations and multipliers; false where the loops cannot be closed.
    fn react(&mut self, at: At<'_>, a: &[f64], lambda: &[f64]) -> bool {
        let loops = self.loops.get_mut();
        let closed = loops.reach(at);
        if closed {
            loops.evaluate(Stage::Dynamics);
            loops.react(a, lambda);
        }
        closed
    }
}

/// out := Pᵀ X P for X (nv × nv) by way of X P (nv × n).
fn congruent(x: &Block, p: &[f64], n: usize, product: &mut [f64], out: &mut [f64]) {
    let nv = p.len() / n.max(1);
    let product = &mut product[..nv * n];
    for (line, row) in product.chunks_exact_mut(n.max(1)).zip(x.lines()) {
        combine_entries(row.entries(), p, line);
    }
    out.fill(0.0);
    gather(p, n, product, out);
}

/// out := x P for a row x (nv).
fn combine(x: &[f64], p: &[f64], out: &mut [f64]) {
    combine_entries(x.iter().copied().enumerate(), p, out);
}

/// out := x P for the entries of a row x (nv).
fn combine_entries(x: impl Iterator<Item = (usize, f64)>, p: &[f64], out: &mut [f64]) {
    let n = out.len();
    out.fill(0.0);
    for (i, x) in x {
        out.iter_mut().zip(&p[i * n..][..n]).for_each(|(o, p)| *o += x * p);
    }
}

/// out += Pᵀ X for X (nv × columns), columns = out.len()/n.
fn gather(p: &[f64], n: usize, x: &[f64], out: &mut [f64]) {
    let columns = out.len() / n.max(1);
    for (p, line) in p.chunks_exact(n.max(1)).zip(x.chunks_exact(columns.max(1))) {
        for (p, out) in p.iter().zip(out.chunks_exact_mut(columns.max(1))) {
            out.iter_mut().zip(line).for_each(|(o, x)| *o += p * x);
        }
    }
}

/// The product of rows with x.
fn times<'b>(rows: impl Iterator<Item = Line<'b>>, x: &[f64], out: &mut [f64]) {
    out.iter_mut().zip(rows).for_each(|(out, row)| *out = row.dot(x));
}

impl<S: System> System for Minimal<S> {
    fn dims(&self) -> Dims {
        self.dims
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let loops = self.loops.get_mut();
        let (n, h) = (self.dims.v, self.inner.holonomic);
        if !loops.reach(at) {
            out.mass.values_mut().fill(f64::NAN);
            out.force.fill(f64::NAN);
            return;
        }
        if stage > Stage::Position {
            loops.evaluate(stage);
        }
        let inner = &loops.terms;
        congruent(&inner.mass, &loops.p, n, &mut self.product, out.mass.values_mut());
        let psi = inner.g.lines().skip(h);
        for (out, row) in out.g.values_mut().chunks_exact_mut(n.max(1)).zip(psi.clone()) {
            combine_entries(row.entries(), &loops.p, out);
        }
        if stage > Stage::Position {
            times(psi.clone(), &loops.drift, &mut out.nu);
            out.nu.iter_mut().zip(&inner.nu[h..]).for_each(|(x, nu)| *x = nu - *x);
            times(psi, &loops.bend, &mut out.gamma);
            out.gamma.iter_mut().zip(&inner.gamma[h..]).for_each(|(x, gamma)| *x = gamma - *x);
        }
        if stage == Stage::Dynamics {
            times(inner.mass.lines(), &loops.bend, &mut self.row);
            self.row
                .iter_mut()
                .zip(&inner.force)
                .zip(&loops.friction_by_reactions)
                .for_each(|((x, f), friction_of)| *x = f + friction_of - *x);
            combine(&self.row, &loops.p, &mut out.force);
            out.zdot.copy_from_slice(&inner.zdot);
        }
    }

    fn residual(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]) {
        if !self.react(at, a, lambda) {
            return r.fill(f64::NAN);
        }
        let loops = self.loops.get_mut();
        let h = self.inner.holonomic;
        times(loops.terms.mass.lines(), &loops.a, &mut self.row);
        self.row
            .iter_mut()
            .zip(&loops.terms.force)
            .zip(&loops.friction_by_reactions)
            .for_each(|((r, f), friction_of)| *r -= f + friction_of);
        loops.terms.g.lines().skip(h).zip(lambda).for_each(|(row, l)| row.add_to(*l, &mut self.row));
        combine(&self.row, &loops.p, r);
    }

    fn tangent(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], out: &mut Tangent) {
        let closed = self.react(at, a, lambda);
        let (n, nz) = (self.dims.v, self.dims.z);
        let loops = self.loops.get_mut();
        let Loops { inner, state, a, lambda, tangent, p, .. } = loops;
        inner.tangent(state.at(), a, lambda, tangent);
        congruent(&tangent.k, p, n, &mut self.product, out.k.values_mut());
        congruent(&tangent.c, p, n, &mut self.product, out.c.values_mut());
        out.r_z.values_mut().fill(0.0);
        if nz > 0 {
            self.product[..self.inner.v * nz].fill(0.0);
            tangent.r_z.pattern().places().zip(tangent.r_z.values()).for_each(|((i, j), x)| self.product[i * nz + j] = *x);
            gather(p, n, &self.product[..self.inner.v * nz], out.r_z.values_mut());
        }
        for (from, to) in [(&tangent.z_q, &mut out.z_q), (&tangent.z_v, &mut out.z_v)] {
            for (to, from) in to.values_mut().chunks_exact_mut(n.max(1)).zip(from.lines()) {
                combine_entries(from.entries(), p, to);
            }
        }
        out.z_z.take(&tangent.z_z);
        if !closed {
            out.k.values_mut().fill(f64::NAN);
        }
    }

    fn rate(&self, t: f64, q: &[f64], v: &[f64], qdot: &mut [f64]) {
        let loops = &mut *self.loops.borrow_mut();
        loops.velocity(t, q, v);
        loops.inner.rate(t, q, &loops.state.v, qdot);
    }

    fn lift(&self, t: f64, q: &[f64], u: &[f64], change: &mut [f64]) {
        let loops = &mut *self.loops.borrow_mut();
        loops.at_time(t);
        loops.position(q);
        loops.spread(u);
        loops.inner.lift(t, q, &loops.full, change);
    }

    fn second_rate(&self, t: f64, q: &[f64], [v, a]: [&[f64]; 2], qdot: &[f64], scratch: &mut [f64], out: &mut [f64]) {
        let loops = &mut *self.loops.borrow_mut();
        loops.velocity(t, q, v);
        loops.evaluate(Stage::Velocity);
        loops.accelerate(a);
        loops.inner.second_rate(t, q, [&loops.state.v, &loops.a], qdot, scratch, out);
    }

    fn retract(&self, span: Span, q: &mut [f64], delta: &[f64]) {
        self.loops.borrow_mut().retract(span, q, delta);
    }

    fn displace(&self, span: Span, q: &mut [f64], u: &[f64]) {
        self.loops.borrow_mut().displace(span, q, u);
    }

    fn power(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], w: &mut [f64]) {
        if w.is_empty() {
            return;
        }
        let reached = match self.pattern.power {
            Power::Reactions => self.react(at, a, lambda),
            Power::Zero | Power::State => self.loops.get_mut().reach(at),
        };
        if !reached {
            return w.fill(f64::NAN);
        }
        let Loops { inner, state, a, lambda, .. } = self.loops.get_mut();
        inner.power(state.at(), a, lambda, w);
    }

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        let (own, chart) = modes.split_at_mut(self.inner.modes);
        chart.copy_from_slice(&at.modes[self.inner.modes..]);
        own.copy_from_slice(&at.modes[..self.inner.modes]);
        let loops = self.loops.get_mut();
        if !own.is_empty() && loops.reach(at) {
            loops.inner.modes(loops.state.at(), own);
        }
    }

    fn roots(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], g: &mut [f64]) {
        let reactions = self.pattern.roots_by_reactions;
        let closed = if reactions { self.react(at, a, lambda) } else { self.loops.get_mut().reach(at) };
        let loops = self.loops.get_mut();
        let (own, chart) = g.split_at_mut(self.inner.roots);
        if !own.is_empty() {
            loops.inner.roots(loops.state.at(), &loops.a, &loops.lambda, own);
        }
        if !closed {
            chart.copy_from_slice(&[-self.poor, -SINGULAR]);
            return;
        }
        let own = loops.quality();
        let spare = own / self.quality - 3.0 * self.poor;
        if spare > 0.0 && own > WATCHED * self.best {
            chart.copy_from_slice(&[spare, own / self.best - SINGULAR]);
            return;
        }
        let best = loops.best_quality();
        let relative = if best > 0.0 { own / best } else { 1.0 };
        chart.copy_from_slice(&[if spare > 0.0 { spare } else { relative - self.poor }, best.max(own) / self.best - SINGULAR]);
    }

    fn longest(&mut self, at: At<'_>) -> f64 {
        let loops = self.loops.get_mut();
        if loops.reach(at) { loops.inner.longest(loops.state.at()) } else { f64::INFINITY }
    }

    fn ahead(&mut self, at: At<'_>, to: f64, roots: &[usize]) -> Ahead {
        self.loops.get_mut().inner.ahead(At { modes: &at.modes[..self.inner.modes], ..at }, to, roots)
    }

    fn beyond(&self) -> bool {
        self.loops.borrow().inner.beyond()
    }

    fn equal(&mut self, root: usize, state: &mut State) -> Option<Effect> {
        if root >= self.inner.roots {
            return None;
        }
        let loops = self.loops.get_mut();
        loops.reach(state.at());
        let Loops { inner, state: whole, .. } = loops;
        let effect = inner.equal(root, whole)?;
        state.modes[..self.inner.modes].copy_from_slice(&whole.modes);
        Some(effect)
    }

    fn cross(&mut self, root: usize, state: &mut State, row: &mut [f64]) -> Effect {
        let loops = self.loops.get_mut();
        loops.reach(state.at());
        if root > self.inner.roots {
            self.singular = true;
            return Effect::Stop;
        }
        if root == self.inner.roots {
            loops.choose_anew();
            let chart = &mut state.modes[self.inner.modes..];
            chart.iter_mut().zip(&loops.independent).for_each(|(m, &i)| *m = i as i32);
            state.q.copy_from_slice(&loops.state.q);
            state.v.iter_mut().zip(&loops.independent).for_each(|(v, &i)| *v = loops.state.v[i]);
            return Effect::Restart;
        }
        let effect = loops.cross(root, state);
        let (Effect::Impulse { restitution, stops } | Effect::Bounce { restitution, stops }) = effect else { return effect };
        combine(&loops.full, &loops.p, row);
        // row·v has a part that rows which depend on time prescribe; the jump is meant of the whole
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let (free, prescribed) = (dot(row, &state.v), dot(&loops.full, &loops.drift));
        let share = if prescribed == 0.0 { 0.0 } else { prescribed / free };
        let restitution = (1.0 + restitution) * (1.0 + share) - 1.0;
        if matches!(effect, Effect::Bounce { .. }) { Effect::Bounce { restitution, stops } } else { Effect::Impulse { restitution, stops } }
    }
}

/// What the independent velocities have of a common translation, each direction of unit length again.
fn restricted(common: &Common, place: impl Fn(usize) -> Option<usize>) -> Common {
    let mut own: Common = common.iter().filter_map(|(k, along)| Some((place(*k)?, *along))).collect();
    for axis in 0..3 {
        let length = own.iter().map(|(_, along)| along[axis] * along[axis]).sum::<f64>().sqrt();
        if length > 0.0 {
            own.iter_mut().for_each(|(_, along)| along[axis] /= length);
        }
    }
    own
}
