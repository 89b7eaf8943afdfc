//! The continuous solution over one step: polynomials in θ = (t − t₀)/h for q, v and z.

mod nodes;

use self::nodes::{Places, quintic};
use crate::engine::{Engine, Node, Why};
use crate::{Dims, State, System};

/// Highest degree of polynomials of their own for q, v and z.
pub const DEGREE: usize = 8;

/// Where inside of a step the rate of the quartic θ²(1 − θ)² is largest: ½ − √3/6.
const PLACE: f64 = 0.211_324_865_405_187_1;

/// What the coefficients of a step stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Form {
    /// Powers in use.
    powers: usize,
    /// Whether v is the rate of q, which alone has coefficients.
    rates: bool,
}

/// Polynomials of one step, in powers of θ ∈ [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    /// Begin of the step, s.
    pub t: f64,
    /// Length of the step, s: the polynomials are scaled by it even if the motion leaves them earlier.
    pub h: f64,
    dims: Dims,
    /// What the coefficients stand for.
    pub form: Form,
    /// Coefficients, power after power; each with nq + nv + nz entries, or nq where v is the rate of q.
    coefficients: Vec<f64>,
    scratch: Node,
    rates: Vec<f64>,
}

impl Dense {
    /// Room for the polynomials of a system.
    pub fn new(dims: Dims) -> Self {
        let n = dims.q + dims.v + dims.z;
        Self {
            t: 0.0,
            h: 0.0,
            dims,
            form: Form::default(),
            coefficients: vec![0.0; n * (DEGREE + 1)],
            scratch: Node::new(dims),
            rates: vec![0.0; 5 * dims.q],
        }
    }

    /// Begins polynomials with `powers` coefficients (degree powers − 1, at most [`DEGREE`]) on [t, t + h]; all are zero.
    pub fn begin(&mut self, t: f64, h: f64, powers: usize) {
        (self.t, self.h, self.form) = (t, h, Form { powers: powers.min(DEGREE + 1), rates: false });
        self.coefficients.fill(0.0);
    }

    /// Coefficients of one power: those of q, then v, then z.
    pub fn power_mut(&mut self, power: usize) -> (&mut [f64], &mut [f64], &mut [f64]) {
        let n = self.dims.q + self.dims.v + self.dims.z;
        let (q, rest) = self.coefficients[power * n..(power + 1) * n].split_at_mut(self.dims.q);
        let (v, z) = rest.split_at_mut(self.dims.v);
        (q, v, z)
    }

    /// Sets the coefficients of one entry (those of q count first, then v, then z), power after power.
    pub fn set_entry(&mut self, entry: usize, powers: &[f64]) {
        let n = self.dims.q + self.dims.v + self.dims.z;
        for (row, value) in self.coefficients.chunks_exact_mut(n.max(1)).zip(powers) {
            row[entry] = *value;
        }
    }

    /// Entries of a power.
    fn width(&self) -> usize {
        if self.form.rates { self.dims.q } else { self.dims.q + self.dims.v + self.dims.z }
    }

    /// All coefficients in use, power after power: what a trajectory stores of a step.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..self.width() * self.form.powers]
    }

    /// Takes back what [`Dense::coefficients`] gave, in the form that [`Dense::form`] was.
    pub fn set(&mut self, t: f64, h: f64, form: Form, coefficients: &[f64]) {
        (self.t, self.h, self.form) = (t, h, form);
        self.coefficients[..coefficients.len()].copy_from_slice(coefficients);
    }

    /// t, q, v and z of `state` at time `t`; modes, live and work stay as they are.
    pub fn evaluate(&self, t: f64, state: &mut State) {
        let theta = (t - self.t) / self.h;
        let (nq, nv, n) = (self.dims.q, self.dims.v, self.width());
        state.t = t;
        if self.form.rates {
            for (i, (q, v)) in state.q.iter_mut().zip(&mut state.v).enumerate() {
                let powers = (0..self.form.powers).rev();
                let (value, rate) = powers.fold((0.0, 0.0), |(p, p1), k| (p * theta + self.coefficients[k * n + i], p1 * theta + p));
                (*q, *v) = (value, rate / self.h);
            }
            return;
        }
        let horner = |i: usize| (0..self.form.powers).rev().fold(0.0, |sum, p| sum * theta + self.coefficients[p * n + i]);
        state.q.iter_mut().enumerate().for_each(|(i, x)| *x = horner(i));
        state.v.iter_mut().enumerate().for_each(|(i, x)| *x = horner(nq + i));
        state.z.iter_mut().enumerate().for_each(|(i, x)| *x = horner(nq + nv + i));
    }

    /// The interpolant of any scheme, of fifth order in q, v and z.
    ///
    /// q is Hermite's quintic through q, q̇, q̈ of both ends, with q̈ = N a + Ṅ v; its error is O(h⁶). v and z are first the
    /// cubics through values and rates of both ends; their error θ²(1 − θ)² x⁗h⁴/24 is read off from the rate at one place
    /// inside, which leaves O(h⁵). (The middle would not do: there the rate of that error vanishes.)
    ///
    /// # Errors
    /// If the system cannot be evaluated inside of the step.
    pub fn hermite(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node) -> Result<(), Why> {
        let h = to.state.t - from.state.t;
        self.begin(from.state.t, h, 6);
        self.quintic(system, from, to, h);
        for (x, [x0, r0, x1, r1]) in self.cubics(from, to, h) {
            let d = x1 - x0;
            self.coefficients[x] = x0;
            self.set_power(x, [r0, 3.0 * d - 2.0 * r0 - r1, -2.0 * d + r0 + r1, 0.0]);
        }
        let empty = Node { state: State::default(), a: Vec::new(), lambda: Vec::new(), zdot: Vec::new() };
        let mut inside = std::mem::replace(&mut self.scratch, empty);
        inside.state.copy_from(&from.state);
        self.evaluate(from.state.t + PLACE * h, &mut inside.state);
        let evaluated = engine.accelerate(system, &mut inside);
        let (nq, nv) = (self.dims.q, self.dims.v);
        let n = nq + nv + self.dims.z;
        for x in nq..n {
            let rate = h * if x < nq + nv { inside.a[x - nq] } else { inside.zdot[x - nq - nv] };
            let [c1, c2, c3] = [1, 2, 3].map(|power| self.coefficients[power * n + x]);
            let missing = rate - (c1 + PLACE * (2.0 * c2 + PLACE * 3.0 * c3));
            // the quartic θ² − 2θ³ + θ⁴, whose rate is 2θ(1 − θ)(1 − 2θ)
            let size = missing / (2.0 * PLACE * (1.0 - PLACE) * (1.0 - 2.0 * PLACE));
            for (power, factor) in [(2, 1.0), (3, -2.0), (4, 1.0)] {
                self.coefficients[power * n + x] += factor * size;
            }
        }
        self.scratch = inside;
        evaluated
    }

    /// The interpolant by the steps before, without an evaluation: q by the polynomial of degree 11 through q, q̇ and q̈ at four nodes, v
    /// by its rate; for systems without z in which q̇ = v. The errors are O(h¹²) and O(h¹¹).
    ///
    /// `nodes` are y = (q, v) and ẏ at the begins of the last three steps and at the end of the last, which goes between `ends`; `before`
    /// are the lengths of the others, s. Gives an estimate of its error, 1 at the tolerance: each node before takes a part of what was
    /// left, as the last two show.
    pub(crate) fn through_nodes(&mut self, engine: &Engine, ends: [&State; 2], before: [f64; 2], nodes: [(&[f64], &[f64]); 4]) -> f64 {
        let nq = self.dims.q;
        let ([from, to], [far, near]) = (ends, before);
        let h = to.t - from.t;
        (self.t, self.h, self.form) = (from.t, h, Form { powers: nodes::POWERS, rates: true });
        let places = Places::new([-near / h, -(near + far) / h]);
        for i in 0..nq {
            let begin = nodes[2].0[i];
            // far from zero, differences have more digits
            let jets = nodes.map(|(y, rate)| [y[i] - begin, h * rate[i], h * h * rate[nq + i]]);
            let (mut powers, changes) = places.through(jets);
            powers[0] = begin;
            for (k, [change, of_rate]) in changes.into_iter().enumerate() {
                (self.rates[2 * k * nq + i], self.rates[(2 * k + 1) * nq + i]) = (change, of_rate / h);
            }
            for (row, power) in self.coefficients.chunks_exact_mut(nq).zip(powers) {
                row[i] = power;
            }
        }
        let [near, far] = [0, 2].map(|k| engine.norm(to, &self.rates[k * nq..][..nq], &self.rates[(k + 1) * nq..][..nq], &[]));
        if far < near { far * (far / near) } else { far }
    }

    /// Hermite's quintic of q.
    fn quintic(&mut self, system: &dyn System, from: &Node, to: &Node, h: f64) {
        let nq = self.dims.q;
        let (scratch, rest) = self.rates.split_at_mut(nq);
        let (rate0, rest) = rest.split_at_mut(nq);
        let (rate1, rest) = rest.split_at_mut(nq);
        let (second0, second1) = rest.split_at_mut(nq);
        for (node, rate, second) in [(from, rate0, second0), (to, rate1, second1)] {
            let s = &node.state;
            system.rate(s.t, &s.q, &s.v, rate);
            system.second_rate(s.t, &s.q, [&s.v, &node.a], rate, scratch, second);
        }
        for i in 0..nq {
            let (q0, q1) = (from.state.q[i], to.state.q[i]);
            let (r0, r1) = (h * self.rates[nq + i], h * self.rates[2 * nq + i]);
            let (s0, s1) = (h * h * self.rates[3 * nq + i], h * h * self.rates[4 * nq + i]);
            self.set_entry(i, &quintic([q0, r0, s0], [q1, r1, s1]));
        }
    }

    /// Index among the coefficients, and value and scaled rate at both ends, of each entry of v and z.
    fn cubics<'a>(&self, from: &'a Node, to: &'a Node, h: f64) -> impl Iterator<Item = (usize, [f64; 4])> + use<'a> {
        let (nq, nv) = (self.dims.q, self.dims.v);
        let v = (0..nv).map(move |i| (nq + i, [from.state.v[i], h * from.a[i], to.state.v[i], h * to.a[i]]));
        let z = (0..self.dims.z).map(move |i| (nq + nv + i, [from.state.z[i], h * from.zdot[i], to.state.z[i], h * to.zdot[i]]));
        v.chain(z)
    }

    /// Powers 1 to 4 of one entry.
    fn set_power(&mut self, x: usize, powers: [f64; 4]) {
        let n = self.dims.q + self.dims.v + self.dims.z;
        for (power, value) in powers.into_iter().enumerate() {
            self.coefficients[(power + 1) * n + x] = value;
        }
    }
}
