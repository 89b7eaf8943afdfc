//! The lowest eigenvalues of a sparse pair with constraints, by Lanczos' method on shifted and inverted matrices.
//!
//! With the shift σ below all eigenvalues, y = op(x) solves
//!
//! ```text
//! [ K − σM  Gᵀ ] [ y ]   [ M x ]
//! [   G     0  ] [ μ ] = [  0  ]
//! ```
//!
//! and has the eigenvalues ν = 1/(λ − σ) on motions with G y = 0, of which those of the lowest λ are largest and found first (Ericsson &
//! Ruhe, Math. Comp. 35 (1980) 1251-1268). Vectors are kept M-orthonormal by two passes against all before them. What is found is proven
//! by a count: the number of eigenvalues below a place, by the signs of the pivots of the shifted matrix (`pair.rs`). Where it says that
//! some are missing, as the others of a multiple one, the iteration begins again beside those found.

use super::orthonormal::{Orthonormal, dot, scaled};
use super::pair::Pair;
use super::pencil::Pencil;
use super::saddle::Saddle;
use grashof_solvers::Kkt;
use nalgebra::DMatrix;

/// The nearest to zero that shifts come, and by how much they do so where low eigenvalues are not told apart.
const NEAREST: f64 = 1e-12;
const NEARER: f64 = 1e-2;
/// Residual of a converged vector, as part of its ν.
const CONVERGED: f64 = 1e-11;
/// What is left of a vector beside those before it when there are no others, as part of the largest ν.
const EXHAUSTED: f64 = 1e-12;
/// Part of an eigenvalue, and of the largest stiffness, within which two are not told apart by the count.
const APART: [f64; 2] = [1e-7, 1e-11];
/// Steps between looks at what has converged, and most rounds.
const LOOK: usize = 5;
const ROUNDS: usize = 60;

/// The lowest eigenvalues of K x = λ M x with G x = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lowest {
    /// Eigenvalues, rising.
    pub values: Vec<f64>,
    /// Their vectors (nv each) with xᵀMx = 1.
    pub vectors: Vec<Vec<f64>>,
    /// Steps of iteration.
    pub steps: usize,
}

/// The `count` lowest eigenvalues, or all if there are fewer; none if the matrices have numbers that are not finite, M is singular on what
/// the rows leave, or the iteration does not converge. `stop` ends it.
#[must_use]
pub fn lowest(pencil: &Pencil, count: usize, stop: &dyn Fn() -> bool) -> Option<Lowest> {
    let count = count.min(pencil.freedom);
    let pair = Pair::new(pencil);
    let mut shift = pair.below_all()?;
    let mut operator = Operator::new(&pair, shift)?;
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    let (mut steps, mut most) = (0, 20 * count + 60);
    for round in 0..ROUNDS {
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let missing = if found.len() < count {
            count - found.len()
        } else {
            let Some(last) = count.checked_sub(1).map(|last| found[last].0).filter(|_| found.len() < pencil.freedom) else { break };
            let place = last - APART[0] * last.abs() - APART[1] * pair.size;
            pair.below(place)?.saturating_sub(found.iter().filter(|(value, _)| *value < place).count())
        };
        if missing == 0 {
            break;
        }
        if round + 1 == ROUNDS || stop() {
            return None;
        }
        let left = pencil.freedom - found.len();
        let new = operator.converged(&found, (missing + 1).min(left), most.min(left), round, &mut steps, stop);
        if new.is_empty() {
            // low eigenvalues are not told apart from so far, or are many
            if -shift > NEAREST * pair.size && pair.below(NEARER * shift)? == 0 {
                shift *= NEARER;
                operator = Operator::new(&pair, shift)?;
            } else {
                most = most.saturating_mul(2);
            }
        }
        found.extend(new);
    }
    found.truncate(count);
    let (values, vectors) = found.into_iter().unzip();
    Some(Lowest { values, vectors, steps })
}

/// A motion (nv) that the rows leave and that moves less than a part of the metric; none if there is no such motion.
#[must_use]
pub fn without_mass(pencil: &Pencil, part: f64) -> Option<Vec<f64>> {
    let pair = Pair::new(pencil);
    let beside = |part: f64| {
        let unit = pencil.metric.iter().enumerate().map(move |(i, d)| (i, i, part * d));
        pair.mass.pattern().places().zip(pair.mass.values()).map(|((i, j), m)| (i, j, *m)).chain(unit)
    };
    if pair.beside_rows(beside(-part)).is_some_and(|found| found.below == 0) {
        return None;
    }
    // the motion that a force in no special direction moves most
    let mut mass = pair.mass.clone();
    pencil.metric.iter().enumerate().for_each(|(i, d)| mass.set(i, i, mass.at(i, i) + part * d));
    let mut kkt = Kkt::of_blocks(mass.pattern(), pencil.rows.pattern());
    kkt.set_scale(&pencil.metric, &pencil.row_scale);
    let mut x = vec![0.0; pencil.metric.len()];
    if kkt.factor(mass.values(), pencil.rows.values()).is_ok() {
        let force: Vec<f64> = pencil.metric.iter().enumerate().map(|(i, d)| d.sqrt() * (1.0 + (2.39 * (i + 1) as f64).sin())).collect();
        let zeros = vec![0.0; pencil.row_scale.len()];
        kkt.solve(&force, &zeros, &mut x, &mut zeros.clone());
    }
    Some(x)
}

/// The shifted and inverted matrices.
struct Operator<'a> {
    pair: &'a Pair<'a>,
    shifted: Saddle,
    /// [D Gᵀ; G −E], if there are rows.
    closing: Option<Kkt>,
    zeros: Vec<f64>,
    lambda: Vec<f64>,
}

impl<'a> Operator<'a> {
    fn new(pair: &'a Pair<'a>, shift: f64) -> Option<Self> {
        let (pencil, rows) = (pair.pencil, pair.pencil.row_scale.len());
        let shifted = pair.factored(shift)?;
        let closing = if rows == 0 { None } else { Some(pencil.closing()?) };
        Some(Self { pair, shifted, closing, zeros: vec![0.0; rows], lambda: vec![0.0; rows] })
    }

    fn mass(&self, x: &[f64]) -> Vec<f64> {
        self.pair.mass.lines().map(|line| line.dot(x)).collect()
    }

    /// op(x) from M x, divided by the size of the stiffness.
    fn apply(&self, mx: &[f64]) -> Vec<f64> {
        self.shifted.solve(mx)
    }

    /// Takes the parts of x along all vectors of a basis away, and gives them; then what the rows do not allow, which grows from step to
    /// step by the cancellation.
    fn clear(&mut self, basis: &Orthonormal, x: &mut [f64]) -> Vec<f64> {
        let along = basis.clear(x);
        if let Some(closing) = &mut self.closing {
            let force: Vec<f64> = x.iter().zip(&self.pair.pencil.metric).map(|(x, d)| x * d).collect();
            closing.solve(&force, &self.zeros, x, &mut self.lambda);
            basis.clear(x);
        }
        along
    }

    /// Up to `wanted` eigenvalues with their vectors, the lowest beside those known, in at most `most` steps: those that have converged.
    fn converged(
        &mut self,
        known: &[(f64, Vec<f64>)],
        wanted: usize,
        most: usize,
        round: usize,
        steps: &mut usize,
        stop: &dyn Fn() -> bool,
    ) -> Vec<(f64, Vec<f64>)> {
        let mut basis = Orthonormal::default();
        known.iter().for_each(|(_, x)| basis.push(x.clone(), self.mass(x)));
        // in no special direction
        let n = self.pair.pencil.metric.len();
        let noise: Vec<f64> = (0..n).map(|i| 1.0 + (2.39 * (i + 1) as f64 * (round + 1) as f64).sin()).collect();
        let mut next = self.apply(&self.mass(&noise));
        self.clear(&basis, &mut next);
        let mut h = DMatrix::<f64>::zeros(0, 0);
        let first = known.len();
        let mut ritz = (Vec::new(), DMatrix::zeros(0, 0));
        for step in 0..most {
            let mx = self.mass(&next);
            let length = dot(&next, &mx).sqrt();
            if !(length > 0.0 && length.is_finite()) {
                break;
            }
            basis.push(scaled(&next, length), scaled(&mx, length));
            *steps += 1;
            next = self.apply(&basis.products[first + step]);
            let along = self.clear(&basis, &mut next);
            h = h.resize(step + 1, step + 1, 0.0);
            h.column_mut(step).copy_from_slice(&along[first..]);
            let beyond = dot(&next, &self.mass(&next)).max(0.0).sqrt();
            let largest = h.amax();
            let ends = beyond <= EXHAUSTED * largest || step + 1 == most || stop();
            if !ends && step % LOOK != LOOK - 1 {
                continue;
            }
            // the part below the diagonal is that above, as op is symmetric in M
            let found = h.map_with_location(|i, j, _| h[(i.min(j), i.max(j))]).symmetric_eigen();
            let mut order: Vec<usize> = (0..=step).collect();
            order.sort_by(|a, b| found.eigenvalues[*b].total_cmp(&found.eigenvalues[*a]));
            let sound = |i: &&usize| beyond * found.eigenvectors[(step, **i)].abs() <= CONVERGED * found.eigenvalues[**i].abs();
            ritz = (order.iter().take(wanted).take_while(sound).copied().collect(), found.eigenvectors);
            if ends || ritz.0.len() >= wanted {
                break;
            }
        }
        let (order, vectors) = ritz;
        order.iter().map(|&i| self.rayleigh(basis.combined(first, vectors.column(i).as_slice()))).collect()
    }

    /// A vector of unit length in M with its quotient xᵀKx.
    fn rayleigh(&self, x: Vec<f64>) -> (f64, Vec<f64>) {
        let x = scaled(&x, dot(&x, &self.mass(&x)).sqrt());
        let kx: Vec<f64> = self.pair.stiffness.lines().map(|line| line.dot(&x)).collect();
        (dot(&x, &kx), x)
    }
}
