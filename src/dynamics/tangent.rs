//! Exact tangents K = ∂r/∂q and C = ∂r/∂v of the residual r = M a + Gᵀλ − f, by dual numbers.
//!
//! K is the derivative along q ⊕ εδ, δ in the frame of v. Columns whose entries never meet in a row share a direction
//! (Curtis, Powell & Reid 1974), so the cost is the number of colours, not of columns; [`LANES`] directions go in one pass.

use super::Dynamics;
use super::patterns::{friction_pattern, known_by, known_together, tangent_pattern};
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step};
use crate::scalar::{Dual, Scalar};
use grashof_solvers::{Coloring, Dims, Pattern, Sparsity, Tangent};
use std::ops::Deref;
use std::sync::OnceLock;

/// Directions carried in one pass.
pub const LANES: usize = 4;

/// A state with accelerations and multipliers.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Time, s.
    pub t: f64,
    /// Coordinates (nq).
    pub q: &'a [f64],
    /// Velocities (nv).
    pub v: &'a [f64],
    /// First-order states (nz).
    pub z: &'a [f64],
    /// Accelerations (nv).
    pub a: &'a [f64],
    /// Multipliers (rows).
    pub lambda: &'a [f64],
    /// Modes.
    pub modes: &'a [i32],
}

/// Derivatives of the rates of the constraint rows at fixed a; full and row-major (rows × nv), by q along velocities as
/// [`Tangent`] has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowTangent {
    /// ∂(G v − ν)/∂q.
    pub velocity_q: Vec<f64>,
    /// ∂(G a − γ)/∂q.
    pub acceleration_q: Vec<f64>,
    /// ∂(G a − γ)/∂v.
    pub acceleration_v: Vec<f64>,
}

/// A mechanism, and the same on dual numbers from when a tangent is asked for first: explicit schemes never ask.
#[derive(Clone, Debug)]
pub struct Differentiable<G: Space<S = f64>> {
    mechanism: Mechanism<G>,
    lifted: OnceLock<Mechanism<G::Lift<Dual<LANES>>>>,
}

impl<G: Space<S = f64>> Differentiable<G> {
    /// A mechanism whose tangents may be asked for.
    #[must_use]
    pub fn new(mechanism: Mechanism<G>) -> Self {
        Self { mechanism, lifted: OnceLock::new() }
    }

    fn lifted(&self) -> &Mechanism<G::Lift<Dual<LANES>>> {
        self.lifted.get_or_init(|| self.mechanism.lift())
    }
}

impl<G: Space<S = f64>> Deref for Differentiable<G> {
    type Target = Mechanism<G>;

    fn deref(&self) -> &Mechanism<G> {
        &self.mechanism
    }
}

/// Exact tangents of a mechanism; sized once, then free of allocation.
#[derive(Clone, Debug)]
pub struct Linearizer<'m, G: Space<S = f64>> {
    dynamics: Dynamics<'m, G::Lift<Dual<LANES>>>,
    /// Rows that each column of K and C knows, and the places of these entries in the blocks.
    columns: Sparsity,
    places: Vec<usize>,
    /// Columns of each colour, and the step of each column.
    colors: Vec<Vec<usize>>,
    steps: Vec<usize>,
    /// Whether the rates of states know a column: others may share its lane.
    rated: Vec<bool>,
    q: Vec<Dual<LANES>>,
    v: Vec<Dual<LANES>>,
    a: Vec<Dual<LANES>>,
    lambda: Vec<Dual<LANES>>,
    r: Vec<Dual<LANES>>,
}

impl<'m, G: Space<S = f64>> Linearizer<'m, G> {
    /// A linearizer of a mechanism.
    #[must_use]
    pub fn new(mechanism: &'m Differentiable<G>) -> Self {
        let lifted = mechanism.lifted();
        let (nq, nv, nz, rows) = (lifted.nq, lifted.nv, lifted.state_starts.len(), lifted.rows.len());
        let pattern = known_together(lifted);
        let (stored, columns) = (tangent_pattern(lifted), pattern.transposed());
        // the rates of states are further rows: every one may know what their program knows
        let known = known_by(lifted, &lifted.state_program);
        let states = (0..nz).flat_map(|j| known.iter().map(move |&k| (nv + j, k)));
        let coloring = Coloring::new(&Sparsity::new(nv + nz, nv, pattern.places().chain(states)));
        let mut colors = vec![Vec::new(); coloring.count];
        coloring.color.iter().enumerate().for_each(|(k, color)| colors[*color].push(k));
        let mut rated = vec![false; nv];
        known.iter().for_each(|&k| rated[k] = true);
        let mut steps = vec![0; nv];
        for (i, step) in lifted.steps.iter().enumerate() {
            match *step {
                Step::Axis { v, .. } => steps[v] = i,
                Step::Ball { v, .. } => steps[v..v + G::SPIN].fill(i),
            }
        }
        let zeros = |n: usize| vec![Dual::constant(0.0); n];
        Self {
            dynamics: Dynamics::new(lifted),
            places: columns.places().filter_map(|(k, i)| stored.place(i, k)).collect(),
            columns,
            colors,
            steps,
            rated,
            q: zeros(nq),
            v: zeros(nv),
            a: zeros(nv),
            lambda: zeros(rows),
            r: zeros(nv),
        }
    }

    /// The patterns of what [`Linearizer::tangents`] writes, with `nz` states; those of M and G are full.
    #[must_use]
    pub fn pattern(&self, nz: usize) -> Pattern {
        let m = self.dynamics.mechanism;
        let dims = Dims { q: m.nq, v: m.nv, z: nz, holonomic: m.rows.len(), ..Dims::default() };
        let block = tangent_pattern(m);
        Pattern { k: block.clone(), c: block, r_lambda: friction_pattern(m), ..Pattern::dense(dims) }
    }

    /// K, C, ∂r/∂z and the derivatives of ż at a point; `r_lambda` is left as it is, see [`Dynamics::friction_slope`].
    pub fn tangents(&mut self, at: &Point<'_>, out: &mut Tangent) {
        for (lifted, plain) in [(&mut self.a, at.a), (&mut self.lambda, at.lambda)] {
            constants(lifted, plain);
        }
        for first in (0..self.colors.len()).step_by(LANES) {
            self.columns(first, false, at, out);
            self.columns(first, true, at, out);
        }
        for first in (0..at.z.len()).step_by(LANES) {
            self.states(first, at, out);
        }
    }

    /// Columns whose colours are in the lanes from `first` on, by q or by v.
    fn columns(&mut self, first: usize, by_velocity: bool, at: &Point<'_>, out: &mut Tangent) {
        constants(&mut self.q, at.q);
        constants(&mut self.v, at.v);
        for (k, lane) in in_lanes(&self.colors, first) {
            if by_velocity {
                self.v[k].d[lane] = 1.0;
            } else {
                seed(&self.dynamics.mechanism.steps[self.steps[k]], at.q, &mut self.q, [k, lane]);
            }
        }
        constants(&mut self.dynamics.work.z, at.z);
        self.evaluate(at);
        let (target, states) = if by_velocity { (&mut out.c, &mut out.z_v) } else { (&mut out.k, &mut out.z_q) };
        for (k, lane) in in_lanes(&self.colors, first) {
            for (&i, &place) in self.columns.row(k).iter().zip(&self.places[self.columns.range(k)]) {
                target.values_mut()[place] = self.r[i].d[lane];
            }
            for j in 0..at.z.len() {
                states.set(j, k, if self.rated[k] { self.dynamics.work.zdot[j].d[lane] } else { 0.0 });
            }
        }
    }

    /// Derivatives by the states in the lanes from `first` on.
    fn states(&mut self, first: usize, at: &Point<'_>, out: &mut Tangent) {
        constants(&mut self.q, at.q);
        constants(&mut self.v, at.v);
        constants(&mut self.dynamics.work.z, at.z);
        let last = at.z.len().min(first + LANES);
        for j in first..last {
            self.dynamics.work.z[j].d[j - first] = 1.0;
        }
        self.evaluate(at);
        for j in first..last {
            for (i, r) in self.r.iter().enumerate() {
                out.r_z.set(i, j, r.d[j - first]);
            }
            for (i, rate) in self.dynamics.work.zdot.iter().enumerate() {
                out.z_z.set(i, j, rate.d[j - first]);
            }
        }
    }

    /// How the rates of the constraint rows change with the state. Rows know most columns, so each column has a lane of its own.
    pub fn rows(&mut self, at: &Point<'_>) -> RowTangent {
        let (nv, rows) = (at.v.len(), at.lambda.len());
        let mut out =
            RowTangent { velocity_q: vec![0.0; rows * nv], acceleration_q: vec![0.0; rows * nv], acceleration_v: vec![0.0; rows * nv] };
        for (first, by_velocity) in (0..nv).step_by(LANES).flat_map(|first| [(first, false), (first, true)]) {
            constants(&mut self.q, at.q);
            constants(&mut self.v, at.v);
            constants(&mut self.dynamics.work.z, at.z);
            let last = nv.min(first + LANES);
            for k in first..last {
                if by_velocity {
                    self.v[k].d[k - first] = 1.0;
                } else {
                    seed(&self.dynamics.mechanism.steps[self.steps[k]], at.q, &mut self.q, [k, k - first]);
                }
            }
            let Self { dynamics, q, v, .. } = self;
            dynamics.time(Dual::constant(at.t), at.modes);
            dynamics.position(q, at.modes);
            dynamics.velocity(v, at.modes);
            let w = &dynamics.work;
            for (i, row) in w.g.lines().enumerate() {
                let (mut speed, mut acceleration) = (-w.nu[i], -w.gamma[i]);
                for (j, g) in row.entries() {
                    speed += g * v[j];
                    acceleration += g.scale(at.a[j]);
                }
                for k in first..last {
                    if by_velocity {
                        out.acceleration_v[i * nv + k] = acceleration.d[k - first];
                    } else {
                        out.velocity_q[i * nv + k] = speed.d[k - first];
                        out.acceleration_q[i * nv + k] = acceleration.d[k - first];
                    }
                }
            }
        }
        out
    }

    fn evaluate(&mut self, at: &Point<'_>) {
        let Self { dynamics, q, v, a, lambda, r, .. } = self;
        if at.a.iter().all(|a| *a == 0.0) {
            // M is met with accelerations alone
            dynamics.terms_without_mass(Dual::constant(at.t), q, v, at.modes);
            dynamics.imbalance(lambda, r);
        } else {
            dynamics.terms(Dual::constant(at.t), q, v, at.modes);
            dynamics.residual(a, lambda, r);
        }
        dynamics.rates(at.modes);
    }
}

/// Columns whose colours are in the lanes from `first` on, with their lanes.
fn in_lanes(colors: &[Vec<usize>], first: usize) -> impl Iterator<Item = (usize, usize)> {
    let lanes = colors[first..].iter().take(LANES).enumerate();
    lanes.flat_map(|(lane, columns)| columns.iter().map(move |&k| (k, lane)))
}

/// The derivative of q ⊕ ε e_k in a lane, q being moved by a step.
fn seed<D: Space<S = Dual<LANES>>>(step: &Step<D>, plain: &[f64], q: &mut [Dual<LANES>], [k, lane]: [usize; 2]) {
    step.unit_rate(plain, k, |i, x| q[i].d[lane] = x);
}

fn constants(out: &mut [Dual<LANES>], x: &[f64]) {
    out.iter_mut().zip(x).for_each(|(out, x)| *out = Dual::constant(*x));
}
