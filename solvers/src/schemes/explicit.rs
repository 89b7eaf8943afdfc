//! What explicit schemes share: the equations of index 1 as ẏ = F(t, y), and sums over stages.
//!
//! y = (q, v, z) in one row, F = (N(q) v, a, ż) with a from the KKT system. A quaternion is a vector here; its length drifts by
//! the local error, which means nothing since poses are homogeneous of degree 0.

use crate::engine::{Engine, Node, Why};
use crate::{At, Dims, State, System};

/// Coefficients of stages, (stage, coefficient), without the zeros.
pub(super) type Row<const J: usize> = [(usize, f64); J];

/// The right-hand side F with what it needs beside y.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    dims: Dims,
    /// Length of y.
    pub(super) n: usize,
    /// Whether modes are taken anew from each stage.
    follow: bool,
    modes: Vec<i32>,
    before: Vec<i32>,
    lambda: Vec<f64>,
}

impl Flow {
    /// The flow of a system; `follow` takes the modes of every stage from its values.
    pub(super) fn new(system: &dyn System, follow: bool) -> Self {
        let dims = system.dims();
        Self {
            dims,
            n: dims.q + dims.v + dims.z,
            follow: follow && dims.modes > 0,
            modes: vec![0; dims.modes],
            before: vec![0; dims.modes],
            lambda: vec![0.0; dims.rows()],
        }
    }

    /// Begins a step at a node: y and F of it.
    pub(super) fn begin(&mut self, system: &dyn System, node: &Node, y: &mut [f64], rate: &mut [f64]) {
        let s = &node.state;
        self.modes.copy_from_slice(&s.modes);
        self.join([&s.q, &s.v, &s.z], y);
        self.known(system, node, rate);
    }

    /// F at a complete node.
    pub(super) fn known(&self, system: &dyn System, node: &Node, rate: &mut [f64]) {
        let (q, rest) = rate.split_at_mut(self.dims.q);
        let (v, z) = rest.split_at_mut(self.dims.v);
        system.rate(node.state.t, &node.state.q, &node.state.v, q);
        v.copy_from_slice(&node.a);
        z.copy_from_slice(&node.zdot);
    }

    /// F(t, y); `live` are the parameters of the step.
    pub(super) fn rates(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        (t, live): (f64, &[f64]),
        y: &[f64],
        rate: &mut [f64],
    ) -> Result<(), Why> {
        let [q, v, z] = self.parts(y);
        if self.follow {
            std::mem::swap(&mut self.modes, &mut self.before);
            self.modes.copy_from_slice(&self.before);
            system.modes(At { t, q, v, z, modes: &self.before, live }, &mut self.modes);
        }
        let (qdot, rest) = rate.split_at_mut(self.dims.q);
        let (a, zdot) = rest.split_at_mut(self.dims.v);
        // the rates of positions may depend on time, too: they are those of the state evaluated last
        engine.accelerations(system, At { t, q, v, z, modes: &self.modes, live }, a, &mut self.lambda, zdot)?;
        system.rate(t, q, v, qdot);
        Ok(())
    }

    /// The state y at t whose F was evaluated last, with its accelerations and multipliers.
    pub(super) fn solved<'a>(&'a self, (t, live): (f64, &'a [f64]), y: &'a [f64], rate: &'a [f64]) -> (At<'a>, [&'a [f64]; 2]) {
        let [q, v, z] = self.parts(y);
        let [_, a, _] = self.parts(rate);
        (At { t, q, v, z, modes: &self.modes, live }, [a, &self.lambda])
    }

    /// F of the state on the constraints that is nearest to y at t: that state with its accelerations, in `node`. Modes and live
    /// parameters are those of `from`.
    pub(super) fn settled(
        &self,
        system: &mut dyn System,
        engine: &mut Engine,
        (from, t): (&State, f64),
        y: &[f64],
        node: &mut Node,
        rate: &mut [f64],
    ) -> Result<(), Why> {
        self.state(from, t, y, &mut node.state);
        if self.follow {
            engine.follow_modes(system, &mut node.state);
        }
        engine.settle(system, node)?;
        self.known(system, node, rate);
        Ok(())
    }

    /// q, v and z of y.
    pub(super) fn parts<'a>(&self, y: &'a [f64]) -> [&'a [f64]; 3] {
        let (q, rest) = y.split_at(self.dims.q);
        let (v, z) = rest.split_at(self.dims.v);
        [q, v, z]
    }

    /// y of q, v and z.
    pub(super) fn join(&self, parts: [&[f64]; 3], y: &mut [f64]) {
        let mut rest = y;
        for part in parts {
            let (head, tail) = rest.split_at_mut(part.len());
            head.copy_from_slice(part);
            rest = tail;
        }
    }

    /// The state y at t; modes, live and work of `from`.
    pub(super) fn state(&self, from: &State, t: f64, y: &[f64], to: &mut State) {
        let [q, v, z] = self.parts(y);
        to.t = t;
        to.q.copy_from_slice(q);
        to.v.copy_from_slice(v);
        to.z.copy_from_slice(z);
        to.modes.copy_from_slice(&from.modes);
        to.live.copy_from_slice(&from.live);
        to.work.copy_from_slice(&from.work);
    }
}

/// out = y + h Σ c_j k_j over a row, k holding one stage after another; one pass, no branches inside.
#[inline]
pub(super) fn advance<const J: usize>(h: f64, row: &Row<J>, k: &[f64], y: &[f64], out: &mut [f64]) {
    let n = out.len();
    let (rates, y) = (rows(row, k, n), &y[..n]);
    for i in 0..n {
        let mut sum = 0.0;
        for (rate, (_, c)) in rates.iter().zip(row) {
            sum += c * rate[i];
        }
        out[i] = y[i] + h * sum;
    }
}

/// The stages that a row names, n numbers each.
#[inline]
pub(super) fn rows<'a, const J: usize>(row: &Row<J>, k: &'a [f64], n: usize) -> [&'a [f64]; J] {
    row.map(|(j, _)| &k[j * n..][..n])
}
