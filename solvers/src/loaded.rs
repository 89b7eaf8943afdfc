//! A system with forces of one's own beside those that it has.

use crate::pattern::Power;
use crate::{Ahead, At, Block, Dims, Effect, Pattern, Span, Sparsity, Stage, State, System, Tangent, Terms};

/// A force law: a function of the state, smooth within the steps of a run, since it tells no switches.
pub trait Force {
    /// Adds its generalised forces to `force` (nv; positive along v). A pure function of `at`.
    fn add(&mut self, at: At<'_>, force: &mut [f64]);
}

/// Derivatives by central differences: steps of this part of a displacement of 1 in the size of a coordinate, or of 1 + |v|. The
/// error of the quotient is of the order of its square, that of rounding 1e-16 by it: both below 1e-10.
const PART: f64 = 1e-5;

/// A [`System`] and forces f_e beside its own: f + f_e in the equations of motion, their power f_e · v as one more work, the last,
/// and their derivatives by central differences in its tangents.
pub struct Loaded<'s> {
    system: Box<dyn System + 's>,
    force: Box<dyn Force + 's>,
    pattern: Pattern,
    dims: Dims,
    /// The tangent of the system without these forces.
    own: Tangent,
    sum: Vec<f64>,
    sides: [Vec<f64>; 2],
    q: Vec<f64>,
    v: Vec<f64>,
}

impl<'s> Loaded<'s> {
    /// The system with these forces.
    #[must_use]
    pub fn new(system: Box<dyn System + 's>, force: Box<dyn Force + 's>) -> Self {
        let inner = system.dims();
        let nv = inner.v;
        let power = if system.pattern().power == Power::Zero { Power::State } else { system.pattern().power };
        let (k, c) = (Sparsity::dense(nv, nv), Sparsity::dense(nv, nv));
        let pattern = Pattern { k, c, power, ..system.pattern().clone() };
        let sides = [vec![0.0; nv], vec![0.0; nv]];
        let dims = Dims { work: inner.work + 1, ..inner };
        let own = Tangent::new(system.pattern());
        Self { system, force, pattern, dims, own, sum: vec![0.0; nv], sides, q: vec![0.0; inner.q], v: vec![0.0; nv] }
    }

    /// f_e at a state, in `sum`.
    fn evaluate(&mut self, at: At<'_>) {
        self.sum.fill(0.0);
        self.force.add(at, &mut self.sum);
    }

    /// Takes (f_e(+) − f_e(−))/(2h) from a column of a matrix of nv rows and columns.
    fn take_slope(&self, column: usize, h: f64, out: &mut Block) {
        for (i, (ahead, behind)) in self.sides[0].iter().zip(&self.sides[1]).enumerate() {
            out.set(i, column, out.at(i, column) - (ahead - behind) / (2.0 * h));
        }
    }
}

impl System for Loaded<'_> {
    fn dims(&self) -> Dims {
        self.dims
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        self.system.terms(at, stage, out);
        if stage >= Stage::Dynamics {
            self.force.add(at, &mut out.force);
        }
    }

    fn residual(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]) {
        self.system.residual(at, a, lambda, r);
        self.evaluate(at);
        r.iter_mut().zip(&self.sum).for_each(|(r, f)| *r -= f);
    }

    fn reaction_friction(&mut self, at: At<'_>, lambda: &[f64], force: &mut [f64], r_lambda: &mut Block) {
        self.system.reaction_friction(at, lambda, force, r_lambda);
    }

    fn tangent(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], out: &mut Tangent) {
        self.system.tangent(at, a, lambda, &mut self.own);
        let Tangent { k, c, r_z, r_lambda, z_q, z_v, z_z } = &self.own;
        let Tangent { k: to_k, c: to_c, r_z: to_r_z, r_lambda: to_r_lambda, z_q: to_z_q, z_v: to_z_v, z_z: to_z_z } = &mut *out;
        let pairs = [(to_k, k), (to_c, c), (to_r_z, r_z), (to_r_lambda, r_lambda), (to_z_q, z_q), (to_z_v, z_v), (to_z_z, z_z)];
        pairs.into_iter().for_each(|(to, own)| to.take(own));
        for column in 0..self.dims.v {
            let h = PART * self.pattern.size_v[column];
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                self.v.fill(0.0);
                self.v[column] = sign * h;
                self.q.copy_from_slice(at.q);
                self.system.retract(Span::at(at.t), &mut self.q, &self.v);
                self.sides[side].fill(0.0);
                self.force.add(At { q: &self.q, ..at }, &mut self.sides[side]);
            }
            self.take_slope(column, h, &mut out.k);
            let h = PART * (self.pattern.size_v[column] + at.v[column].abs());
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                self.v.copy_from_slice(at.v);
                self.v[column] += sign * h;
                self.sides[side].fill(0.0);
                self.force.add(At { v: &self.v, ..at }, &mut self.sides[side]);
            }
            self.take_slope(column, h, &mut out.c);
        }
    }

    fn rate(&self, t: f64, q: &[f64], v: &[f64], qdot: &mut [f64]) {
        self.system.rate(t, q, v, qdot);
    }

    fn lift(&self, t: f64, q: &[f64], u: &[f64], change: &mut [f64]) {
        self.system.lift(t, q, u, change);
    }

    fn second_rate(&self, t: f64, q: &[f64], rates: [&[f64]; 2], qdot: &[f64], scratch: &mut [f64], out: &mut [f64]) {
        self.system.second_rate(t, q, rates, qdot, scratch, out);
    }

    fn retract(&self, span: Span, q: &mut [f64], delta: &[f64]) {
        self.system.retract(span, q, delta);
    }

    fn displace(&self, span: Span, q: &mut [f64], u: &[f64]) {
        self.system.displace(span, q, u);
    }

    fn longest(&mut self, at: At<'_>) -> f64 {
        self.system.longest(at)
    }

    fn power(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], w: &mut [f64]) {
        let Some((last, own)) = w.split_last_mut() else { return };
        self.system.power(at, a, lambda, own);
        self.evaluate(at);
        *last = self.sum.iter().zip(at.v).map(|(f, v)| f * v).sum();
    }

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        self.system.modes(at, modes);
    }

    fn roots(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], g: &mut [f64]) {
        self.system.roots(at, a, lambda, g);
    }

    fn ahead(&mut self, at: At<'_>, to: f64, roots: &[usize]) -> Ahead {
        self.system.ahead(at, to, roots)
    }

    fn beyond(&self) -> bool {
        self.system.beyond()
    }

    fn equal(&mut self, root: usize, state: &mut State) -> Option<Effect> {
        self.system.equal(root, state)
    }

    fn cross(&mut self, root: usize, state: &mut State, row: &mut [f64]) -> Effect {
        // the last work is not the system's own
        let last = state.work.pop();
        let effect = self.system.cross(root, state, row);
        state.work.extend(last);
        effect
    }
}
