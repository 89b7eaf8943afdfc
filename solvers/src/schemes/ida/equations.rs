//! The equations of motion as IDA wants them, with their Jacobian.

use super::c::Equations;
use crate::engine::{Engine, Why};
use crate::kkt::REGULARIZATION;
use crate::newton::residual;
use crate::{Block, Dims, Lu, Pattern, Span, Stage, State, System, Tangent};

/// Part of the size of a coordinate by which rows G v − ν are differentiated.
const NUDGE: f64 = 1e-6;

/// Part of the tolerance that the error of a step may take: errors of steps add up.
pub(super) const PART: f64 = 0.2;

/// Round-off keeps Newton's method from less.
const FINEST: f64 = 1e-12;

/// Where q, v, z, λ, μ stand among the unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    dims: Dims,
}

impl Layout {
    /// The layout for sizes.
    pub(super) fn new(dims: Dims) -> Self {
        Self { dims }
    }

    /// Begins of v, z, λ, μ, and the end.
    fn starts(self) -> [usize; 5] {
        let Dims { q, v, z, holonomic, .. } = self.dims;
        let m = self.dims.rows();
        [q, q + v, q + v + z, q + v + z + m, q + v + z + m + holonomic]
    }

    /// Number of unknowns.
    pub(super) fn size(self) -> usize {
        self.starts()[4]
    }

    /// Number of those that are differential: q, v, z.
    pub(super) fn differential(self) -> usize {
        self.starts()[2]
    }

    /// q, v, z, λ, μ.
    pub(super) fn split(self, y: &[f64]) -> [&[f64]; 5] {
        let [v, z, l, m, end] = self.starts();
        [&y[..v], &y[v..z], &y[z..l], &y[l..m], &y[m..end]]
    }

    /// q, v, z, λ, μ.
    pub(super) fn split_mut(self, y: &mut [f64]) -> [&mut [f64]; 5] {
        let [v, z, l, m, _] = self.starts();
        let (y, mu) = y.split_at_mut(m);
        let (y, lambda) = y.split_at_mut(l);
        let (y, zs) = y.split_at_mut(z);
        let (q, vs) = y.split_at_mut(v);
        [q, vs, zs, lambda, mu]
    }
}

/// Room for the evaluations.
#[derive(Clone, Debug)]
pub(super) struct Work {
    /// State of an evaluation; its modes and live parameters are those of the step.
    pub(super) state: State,
    layout: Layout,
    tangent: Tangent,
    /// u = v − D⁻¹Gᵀμ (nv).
    u: Vec<f64>,
    /// N (nq × nv).
    n: Vec<f64>,
    /// (NᵀN)⁻¹Nᵀ (nv × nq): displacements by changes of q.
    inverse: Vec<f64>,
    gram: Lu,
    column: Vec<f64>,
    /// ∂(G v − ν)/∂q along velocities (m × nv), and G v − ν.
    bend: Block,
    rows: Vec<f64>,
    unit: Vec<f64>,
    rate: [Vec<f64>; 2],
}

impl Work {
    /// Room for a system.
    pub(super) fn new(dims: Dims, pattern: &Pattern) -> Self {
        let (nq, nv, m) = (dims.q, dims.v, dims.rows());
        Self {
            state: State::new(dims),
            layout: Layout::new(dims),
            tangent: Tangent::new(pattern),
            u: vec![0.0; nv],
            n: vec![0.0; nq * nv],
            inverse: vec![0.0; nv * nq],
            gram: Lu::new(nv),
            column: vec![0.0; nv],
            bend: Block::full(m, nv),
            rows: vec![0.0; m],
            unit: vec![0.0; nv],
            rate: [vec![0.0; nq], vec![0.0; nq]],
        }
    }
}

/// A system whose equations are lent to IDA for a step.
pub(super) struct Lent<'a> {
    /// The system.
    pub(super) system: &'a mut dyn System,
    /// Its tools.
    pub(super) engine: &'a mut Engine,
    /// Room.
    pub(super) work: &'a mut Work,
    /// Whether modes are taken anew from each state.
    pub(super) follow: bool,
    /// Why an evaluation failed last.
    pub(super) why: Option<Why>,
}

impl Lent<'_> {
    /// Terms at the unknowns, and u = v − D⁻¹Gᵀμ.
    fn evaluate(&mut self, t: f64, y: &[f64]) {
        let [q, v, z, _, mu] = self.work.layout.split(y);
        let Work { state, u, .. } = &mut *self.work;
        state.t = t;
        state.q.copy_from_slice(q);
        state.v.copy_from_slice(v);
        state.z.copy_from_slice(z);
        if self.follow {
            self.engine.follow_modes(self.system, state);
        }
        self.engine.evaluate(self.system, state.at(), Stage::Dynamics);
        u.fill(0.0);
        self.engine.terms.g.lines().zip(mu).for_each(|(row, mu)| row.add_to(*mu, u));
        let metric = &self.system.pattern().metric;
        for ((u, v), d) in u.iter_mut().zip(v).zip(metric) {
            *u = v - *u / d;
        }
    }

    /// G v − ν of the terms evaluated last, into `out`.
    fn velocity_rows(engine: &Engine, v: &[f64], out: &mut [f64]) {
        for ((r, row), nu) in out.iter_mut().zip(engine.terms.g.lines()).zip(&engine.terms.nu) {
            *r = row.dot(v) - nu;
        }
    }

    /// N and (NᵀN)⁻¹Nᵀ at the state; false if N has lost its rank.
    fn kinematics(&mut self) -> bool {
        let Work { state, n, inverse, gram, column, unit, rate, .. } = &mut *self.work;
        let (nq, nv) = (state.q.len(), unit.len());
        for j in 0..nv {
            unit.fill(0.0);
            unit[j] = 1.0;
            self.system.lift(state.t, &state.q, unit, &mut rate[0]);
            (0..nq).for_each(|i| n[i * nv + j] = rate[0][i]);
        }
        let product = gram.matrix_mut();
        for (i, j) in (0..nv).flat_map(|i| (0..nv).map(move |j| (i, j))) {
            product[i * nv + j] = (0..nq).map(|k| n[k * nv + i] * n[k * nv + j]).sum();
        }
        if gram.factor_in_place().is_err() {
            return false;
        }
        for k in 0..nq {
            column.copy_from_slice(&n[k * nv..][..nv]);
            gram.solve(column);
            (0..nv).for_each(|i| inverse[i * nq + k] = column[i]);
        }
        true
    }

    /// ∂(G v − ν)/∂q along each velocity, by differences: the tangent of a system has no constraint rows.
    fn bend(&mut self) {
        let Work { state, bend, rows, unit, .. } = &mut *self.work;
        let (nv, m) = (unit.len(), rows.len());
        if m == 0 {
            return;
        }
        Self::velocity_rows(self.engine, &state.v, rows);
        for j in 0..nv {
            let nudge = NUDGE * self.engine.size_v[j];
            unit.fill(0.0);
            unit[j] = nudge;
            self.system.retract(Span::at(state.t), &mut state.q, unit);
            self.engine.evaluate(self.system, state.at(), Stage::Velocity);
            unit[j] = -nudge;
            self.system.retract(Span::at(state.t), &mut state.q, unit);
            for (i, (row, nu)) in self.engine.terms.g.lines().zip(&self.engine.terms.nu).enumerate() {
                let there = row.dot(&state.v) - nu;
                bend.set(i, j, (there - rows[i]) / nudge);
            }
        }
    }

    /// Columns of q: displacements (NᵀN)⁻¹Nᵀ of the tangent's blocks, and the rate of the coordinates itself.
    fn columns_of_q(&mut self, c: f64, out: &mut [f64]) {
        let Work { state, layout, tangent, u, inverse, bend, rate, .. } = &mut *self.work;
        let (nq, size) = (state.q.len(), layout.size());
        let [here, there] = rate;
        self.system.rate(state.t, &state.q, u, here);
        let blocks = [(&tangent.k, 1.0), (&tangent.z_q, -1.0), (&*bend, 1.0), (&self.engine.terms.g, 1.0)];
        for (j, column) in out.chunks_exact_mut(size).take(nq).enumerate() {
            let (q, nudge) = (state.q[j], NUDGE.sqrt() * self.engine.size_q[j]);
            state.q[j] = q + nudge;
            self.system.rate(state.t, &state.q, u, there);
            state.q[j] = q;
            let [rates, rest @ ..] = layout.split_mut(column);
            for (i, r) in rates.iter_mut().enumerate() {
                *r = f64::from(u8::from(i == j)) * c - (there[i] - here[i]) / nudge;
            }
            for (rows, (block, sign)) in rest.into_iter().zip(blocks) {
                for (r, line) in rows.iter_mut().zip(block.lines()) {
                    *r = sign * line.entries().map(|(k, x)| x * inverse[k * nq + j]).sum::<f64>();
                }
            }
        }
    }

    /// Columns of v, z, λ and μ.
    fn other_columns(&mut self, c: f64, out: &mut [f64]) {
        let Work { state, layout, tangent, n, .. } = &mut *self.work;
        let (nq, nv, nz, size) = (state.q.len(), state.v.len(), state.z.len(), layout.size());
        let (m, [v, z, lambda, mu, _]) = (self.engine.dims.rows(), layout.starts());
        let terms = &self.engine.terms;
        let pattern = self.system.pattern();
        let mut set = |row: usize, column: usize, value: f64| out[column * size + row] = value;
        for j in 0..nv {
            (0..nq).for_each(|i| set(i, v + j, -n[i * nv + j]));
            (0..nv).for_each(|i| set(v + i, v + j, c * terms.mass.at(i, j) + tangent.c.at(i, j)));
            (0..nz).for_each(|i| set(z + i, v + j, -tangent.z_v.at(i, j)));
            (0..m).for_each(|i| set(lambda + i, v + j, terms.g.at(i, j)));
        }
        for j in 0..nz {
            (0..nv).for_each(|i| set(v + i, z + j, tangent.r_z.at(i, j)));
            (0..nz).for_each(|i| set(z + i, z + j, f64::from(u8::from(i == j)) * c - tangent.z_z.at(i, j)));
        }
        for j in 0..m {
            (0..nv).for_each(|i| set(v + i, lambda + j, terms.g.at(j, i) + tangent.r_lambda.at(i, j)));
            set(lambda + j, lambda + j, -REGULARIZATION * pattern.g_scale[j] / c);
        }
        for j in 0..self.engine.dims.holonomic {
            for i in 0..nq {
                let way = terms.g.line(j).entries().map(|(k, g)| n[i * nv + k] * g / pattern.metric[k]).sum();
                set(i, mu + j, way);
            }
            set(mu + j, mu + j, -REGULARIZATION * pattern.g_scale[j] / c);
        }
    }
}

impl Equations for Lent<'_> {
    fn residual(&mut self, t: f64, y: &[f64], rates: &[f64], out: &mut [f64]) -> bool {
        self.evaluate(t, y);
        let layout = self.work.layout;
        let [qdot, vdot, zdot, ..] = layout.split(rates);
        let [_, v, _, lambda, _] = layout.split(y);
        let [r_q, r_v, r_z, r_lambda, r_mu] = layout.split_mut(out);
        let Work { state, u, .. } = &*self.work;
        self.system.rate(state.t, &state.q, u, r_q);
        r_q.iter_mut().zip(qdot).for_each(|(r, rate)| *r = rate - *r);
        residual(self.system, self.engine, state.at(), vdot, lambda, r_v);
        let terms = &self.engine.terms;
        for ((r, rate), g) in r_z.iter_mut().zip(zdot).zip(&terms.zdot) {
            *r = rate - g;
        }
        Self::velocity_rows(self.engine, v, r_lambda);
        r_mu.copy_from_slice(&terms.phi);
        match out.iter().position(|r| !r.is_finite()) {
            Some(i) => {
                let nq = self.engine.dims.q;
                self.why = Some(if i >= nq && i < nq + u.len() { Why::NotFinite(i - nq) } else { Why::Newton });
                false
            }
            None => true,
        }
    }

    fn jacobian(&mut self, t: f64, c: f64, y: &[f64], rates: &[f64], out: &mut [f64]) -> bool {
        self.evaluate(t, y);
        let layout = self.work.layout;
        let ([_, vdot, ..], [_, _, _, lambda, _]) = (layout.split(rates), layout.split(y));
        self.engine.counts.tangents += 1;
        self.system.tangent(self.work.state.at(), vdot, lambda, &mut self.work.tangent);
        if !self.kinematics() {
            self.why = Some(Why::Singular);
            return false;
        }
        out.fill(0.0);
        self.other_columns(c, out);
        self.bend();
        self.columns_of_q(c, out);
        true
    }

    /// Those of [`Engine::norm`] with a part of the tolerance. Its mean is over q, v and z alone: multipliers count for nothing, but a weight must not be 0.
    fn weights(&mut self, y: &[f64], out: &mut [f64]) {
        let layout = self.work.layout;
        let tolerance = (PART * self.engine.tolerance()).max(FINEST);
        let whole = (layout.size() as f64 / layout.differential().max(1) as f64).sqrt() / tolerance;
        let [_, v, z, ..] = layout.split(y);
        let [w_q, w_v, w_z, w_lambda, w_mu] = layout.split_mut(out);
        w_q.iter_mut().zip(&self.engine.size_q).for_each(|(w, size)| *w = whole / size);
        for ((w, size), v) in w_v.iter_mut().zip(&self.engine.size_v).zip(v) {
            *w = whole / (size + v.abs());
        }
        let engine = &self.engine;
        engine.shared(v, |k, speed| w_v[k] = whole / (engine.size_v[k] + speed.abs()));
        w_z.iter_mut().zip(z).zip(&engine.size_z).for_each(|((w, z), size)| *w = whole / (size + z.abs()));
        w_lambda.fill(1e-30);
        w_mu.fill(1e-30);
    }
}
