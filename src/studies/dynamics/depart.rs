//! The first step away from a change point, where the rows have lost rank and accelerations are not determined.
//!
//! On a branch the motion is smooth: y' = f(t, y) with y = (q, v, z), q and v on the constraints and a by M a + Gᵀλ = f, G a = γ on the
//! motions that the rows leave beside the change point. Gauss's collocation of order 6 takes one step, whose inner places are all
//! beside it, to where the rows have their common rank; fixed-point iteration solves it. At rest the first acceleration is
//! a = V (VᵀM V)⁻¹ Vᵀf, V the velocities of a branch; where nobody names the branch it is the one with the largest fᵀa, which is
//! nearest to what the forces alone would do (Gauss's principle of least constraint).

use super::phases::Phases;
use super::system::Mechanical;
use super::trajectory::Trajectory;
use crate::geometry::Space;
use crate::kinematics::standing::place;
use crate::numerics::least_squares::{left_open, shortest};
use grashof_solvers::{Dense, Engine, Node, Span, Stage, State, System, Terms};
use nalgebra::{DMatrix, DVector};

/// How far the step leads, rad or sizes.
const REACH: f64 = 4e-2;

/// Part of that below which rounding is too near.
const SMALLEST: f64 = 1e-3;

/// Halvings of the step before switches inside are left to be.
const HALVINGS: usize = 6;

/// Where rounding may end the iteration: next to the change point it is multiplied by the inverse of the distance.
const ROUNDING: f64 = 1e-8;

const SQRT_15: f64 = 3.872_983_346_207_417;

/// Places, weights and matrix of Gauss's collocation (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table 7.4).
const C: [f64; 3] = [0.5 - SQRT_15 / 10.0, 0.5, 0.5 + SQRT_15 / 10.0];
const B: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
const A: [[f64; 3]; 3] = [
    [5.0 / 36.0, 2.0 / 9.0 - SQRT_15 / 15.0, 5.0 / 36.0 - SQRT_15 / 30.0],
    [5.0 / 36.0 + SQRT_15 / 24.0, 2.0 / 9.0, 5.0 / 36.0 - SQRT_15 / 24.0],
    [5.0 / 36.0 + SQRT_15 / 30.0, 2.0 / 9.0 + SQRT_15 / 15.0, 5.0 / 36.0],
];

/// A step away from a change point.
pub(super) struct Departure {
    /// The start, with the acceleration on the branch.
    pub(super) from: Node,
    /// A state on the way, for the continuous solution: from rest half of it is done there.
    pub(super) way: State,
    /// The state behind the step.
    pub(super) to: State,
}

impl Departure {
    /// Adds the step, which ends in the node `to`, to a trajectory.
    pub(super) fn record<'m, G: Space<S = f64>>(
        &self,
        trajectory: &mut Trajectory<'m, G>,
        system: &mut Mechanical<'m, G>,
        engine: &mut Engine,
        dense: &mut Dense,
        to: &Node,
    ) {
        trajectory.piece(&self.from);
        let mut way = to.clone();
        way.state.copy_from(&self.way);
        let nodes = if engine.accelerate(system, &mut way).is_ok() { vec![&self.from, &way, to] } else { vec![&self.from, to] };
        for ends in nodes.windows(2) {
            if dense.hermite(system, engine, ends[0], ends[1]).is_ok() {
                trajectory.step(dense, ends[1].state.t, std::ptr::eq(ends[1], to));
            }
        }
        if self.from.state.modes != to.state.modes {
            trajectory.piece(to);
        }
    }
}

/// Rates of a state: q̇, a, ż and the powers.
struct Rates {
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    work: Vec<f64>,
}

/// The mechanism beside a change point.
struct Beside<'a, 'm, G: Space<S = f64>> {
    system: &'a mut Mechanical<'m, G>,
    terms: Terms,
    /// D and lengths of rows, by which rows are scaled.
    metric: Vec<f64>,
    row: Vec<f64>,
    /// 1 rad or one size for each velocity.
    size: Vec<f64>,
}

/// The step away from the start of a phase, if that is a change point from which something moves.
pub(super) fn depart<'m, G: Space<S = f64>>(
    phase: &Phases<G>,
    system: &mut Mechanical<'m, G>,
    start: &State,
    until: f64,
) -> Option<Departure> {
    let change = phase.start.change.as_ref()?;
    if start.t != 0.0 || system.pattern().roots_by_reactions {
        return None;
    }
    let pattern = system.pattern().clone();
    let row = pattern.g_scale.iter().map(|s| if *s > 0.0 { s.sqrt().recip() } else { 1.0 }).collect();
    let terms = Terms::new(system.dims(), &pattern);
    let mut beside = Beside { system, terms, metric: pattern.metric, row, size: pattern.size_v };
    let moves = phase.mechanism.rows.iter().any(|row| phase.mechanism.is_moved(row)) && change.rests;
    let branches = if change.open { &change.branches[..] } else { &change.branches[..1] };
    // the acceleration of the branch that the forces move most
    let first = branches.iter().map(|branch| beside.first(start, &branch.ways)).max_by(|x, y| x.1.total_cmp(&y.1))?.0;
    let way = &change.branches[0].ways[0];
    let guess = |beside: &mut Beside<'_, 'm, G>, t: f64| -> Vec<f64> {
        if !moves {
            return start.v.iter().zip(&first).map(|(v, a)| t * (v + 0.5 * t * a)).collect();
        }
        let mut modes = start.modes.clone();
        let s = place(&mut beside.system.dynamics, &start.q, way, &mut modes, t);
        way.iter().map(|v| s * v).collect()
    };
    let mut h = beside.reach(until, guess)?;
    for _ in 0..HALVINGS {
        if let Some((begin, to)) = beside.step(start, h, guess) {
            let mut modes = to.modes.clone();
            beside.system.modes(to.at(), &mut modes);
            if modes == to.modes
                && let Some((_, way)) = beside.step(start, h * std::f64::consts::FRAC_1_SQRT_2, guess)
            {
                return Some(Departure { from: begin.node(start, &beside.terms), way, to });
            }
        }
        h *= 0.5;
    }
    None
}

impl<'m, G: Space<S = f64>> Beside<'_, 'm, G> {
    fn evaluate(&mut self, state: &State) {
        self.system.terms(state.at(), Stage::Dynamics, &mut self.terms);
    }

    /// Rows G, scaled, and a right side likewise.
    fn rows(&self, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let nv = self.metric.len().max(1);
        let mut a = self.terms.g.to_dense();
        a.chunks_exact_mut(nv).zip(&self.row).for_each(|(row, s)| row.iter_mut().for_each(|x| *x *= s));
        (a, b.iter().zip(&self.row).map(|(b, s)| b * s).collect())
    }

    /// The shortest x with G x = b.
    fn meet(&self, b: &[f64]) -> Vec<f64> {
        let (a, b) = self.rows(b);
        shortest(&a, &b, &self.metric, 0.0)
    }

    /// a = V y of the motions V (nv × f) with Vᵀ(M a − f) = 0.
    fn pushed(&self, ways: &DMatrix<f64>, given: &[f64]) -> Vec<f64> {
        let nv = self.metric.len();
        let mass = DMatrix::from_row_slice(nv, nv, &self.terms.mass.to_dense());
        let force = DVector::from_column_slice(&self.terms.force) - &mass * DVector::from_column_slice(given);
        let (inertia, push) = (ways.transpose() * &mass * ways, ways.transpose() * force);
        let y = shortest(inertia.transpose().as_slice(), push.as_slice(), &vec![1.0; ways.ncols()], 0.0);
        (ways * DVector::from_vec(y)).as_slice().to_vec()
    }

    /// The acceleration from rest on a branch, and its power with the forces.
    fn first(&mut self, start: &State, ways: &[Vec<f64>]) -> (Vec<f64>, f64) {
        self.evaluate(start);
        let columns: Vec<DVector<f64>> = ways.iter().map(|way| DVector::from_column_slice(way)).collect();
        let a = self.pushed(&DMatrix::from_columns(&columns), &vec![0.0; start.v.len()]);
        let power = a.iter().zip(&self.terms.force).map(|(a, f)| a * f).sum();
        (a, power)
    }

    /// The time in which a displacement comes to its size, at most half the run; none if next to nothing moves.
    fn reach(&mut self, until: f64, guess: impl Fn(&mut Self, f64) -> Vec<f64>) -> Option<f64> {
        let mut far = |t: f64| guess(self, t).iter().zip(&self.size).fold(0.0, |m, (x, size)| f64::max(m, x.abs() / size));
        let (mut low, mut high) = (0.0, 0.5 * until);
        let most = far(high);
        if most < REACH {
            return (most > SMALLEST * REACH).then_some(high);
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if far(middle) < REACH { low = middle } else { high = middle }
        }
        Some(high)
    }

    /// Moves a state to the constraints.
    fn close(&mut self, state: &mut State) {
        for _ in 0..4 {
            self.evaluate(state);
            let open: Vec<f64> = self.terms.phi.iter().map(|phi| -phi).collect();
            let way = self.meet(&open);
            self.system.retract(Span::at(state.t), &mut state.q, &way);
        }
        self.evaluate(state);
        let v = &state.v;
        let open: Vec<f64> = self.terms.g.lines().zip(&self.terms.nu).map(|(row, nu)| nu - row.dot(v)).collect();
        let way = self.meet(&open);
        state.v.iter_mut().zip(way).for_each(|(v, way)| *v += way);
    }

    /// Rates of a state on the constraints, beside the change point.
    fn rates(&mut self, state: &State) -> Rates {
        self.evaluate(state);
        let nv = state.v.len();
        let (rows, _) = self.rows(&[]);
        let given = self.meet(&self.terms.gamma);
        let ways = left_open(0.0, &rows, &self.metric);
        let pushed = if ways.ncols() > 0 { self.pushed(&ways, &given) } else { vec![0.0; nv] };
        let a: Vec<f64> = given.iter().zip(pushed).map(|(a, b)| a + b).collect();
        let mut q = vec![0.0; state.q.len()];
        self.system.rate(state.t, &state.q, &state.v, &mut q);
        // Gᵀλ = f − M a
        let left: Vec<f64> = self.terms.mass.lines().zip(&self.terms.force).map(|(row, f)| f - row.dot(&a)).collect();
        let count = self.terms.phi.len();
        let transposed: Vec<f64> = (0..nv).flat_map(|k| (0..count).map(move |i| (i, k))).map(|(i, k)| self.terms.g.at(i, k)).collect();
        let lambda = shortest(&transposed, &left, &vec![1.0; count], 0.0);
        let mut work = vec![0.0; state.work.len()];
        let z = self.terms.zdot.clone();
        self.system.power(state.at(), &a, &lambda, &mut work);
        Rates { q, v: a, z, work }
    }

    /// One step of length h, and the rates at its inner places.
    fn step(&mut self, start: &State, h: f64, guess: impl Fn(&mut Self, f64) -> Vec<f64>) -> Option<(Inner, State)> {
        let mut inner: Vec<State> = Vec::new();
        for c in C {
            let (mut state, near) = (start.clone(), 1e-3 * c * h);
            let (way, before, behind) = (guess(self, c * h), guess(self, c * h - near), guess(self, c * h + near));
            self.system.retract(Span::at(c * h), &mut state.q, &way);
            state.v = before.iter().zip(behind).map(|(before, behind)| (behind - before) / (2.0 * near)).collect();
            state.t = c * h;
            self.close(&mut state);
            inner.push(state);
        }
        let mut change = f64::INFINITY;
        let mut rates: Vec<Rates> = Vec::new();
        for _ in 0..60 {
            rates = inner.iter().map(|state| self.rates(state)).collect();
            let mut moved: f64 = 0.0;
            for (i, state) in inner.iter_mut().enumerate() {
                let before = [state.q.clone(), state.v.clone()].concat();
                advance(start, h, &A[i], &rates, state);
                self.close(state);
                let now = [&state.q[..], &state.v].concat();
                moved = before.iter().zip(now).fold(moved, |m, (a, b)| m.max((a - b).abs() / (1.0 + a.abs())));
            }
            if !moved.is_finite() {
                return None;
            }
            // rounding ends it
            let done = moved < 1e-15 || moved < ROUNDING && moved >= change;
            change = change.min(moved);
            if done {
                break;
            }
        }
        if change > ROUNDING {
            return None;
        }
        let mut to = start.clone();
        advance(start, h, &B, &rates, &mut to);
        to.t = h;
        self.close(&mut to);
        let sum = |k: usize| rates.iter().zip(B).map(|(rate, b)| h * b * rate.work[k]).sum::<f64>();
        to.work = (0..to.work.len()).map(sum).collect();
        Some((Inner(rates), to))
    }
}

/// Rates at the places of a step.
struct Inner(Vec<Rates>);

impl Inner {
    /// The start with its acceleration, by the polynomial through those inside.
    fn node(&self, start: &State, terms: &Terms) -> Node {
        let weight = |j: usize| (0..3).filter(|i| *i != j).map(|i| C[i] / (C[i] - C[j])).product::<f64>();
        let at = |pick: &dyn Fn(&Rates) -> f64| self.0.iter().enumerate().map(|(j, rates)| weight(j) * pick(rates)).sum();
        Node {
            state: start.clone(),
            a: (0..start.v.len()).map(|k| at(&|r| r.v[k])).collect(),
            lambda: vec![0.0; terms.phi.len()],
            zdot: (0..start.z.len()).map(|k| at(&|r| r.z[k])).collect(),
        }
    }
}

/// state := start + h Σ weights · rates.
fn advance(start: &State, h: f64, weights: &[f64; 3], rates: &[Rates], state: &mut State) {
    let sum = |x: f64, pick: &dyn Fn(&Rates) -> f64| x + rates.iter().zip(weights).map(|(rate, w)| h * w * pick(rate)).sum::<f64>();
    state.q.iter_mut().zip(&start.q).enumerate().for_each(|(k, (q, x))| *q = sum(*x, &|r| r.q[k]));
    state.v.iter_mut().zip(&start.v).enumerate().for_each(|(k, (v, x))| *v = sum(*x, &|r| r.v[k]));
    state.z.iter_mut().zip(&start.z).enumerate().for_each(|(k, (z, x))| *z = sum(*x, &|r| r.z[k]));
}
