//! Accelerations and multipliers where forces depend on the reactions.
//!
//! ```text
//! M a + Gᵀλ = f + f_λ(λ),   G a = γ
//! ```
//!
//! by Newton's method with [M Gᵀ + R_λ; G −E], R_λ = −∂f_λ/∂λ, which is not symmetric. The residual is that without E, so that
//! each step is one of iterative refinement as well. Where f_λ is linear in λ, one step solves the equations and the others refine.
//! Redundant rows leave combinations of the multipliers to E, by which friction depends on them: of one with Gᵀu = 0 a step is
//! −uᵀ(γ − G a)/uᵀE u, the round-off of G a over E. So E is a hundred times that of [`kkt`](crate::kkt) here [measured, a spatial
//! four-bar with friction by a coefficient in its four hinges, tilted: with that of `kkt` steps stall at 4e-8 of the multipliers, and
//! positions count as jammed; with this one they end below 1e-10]. The rows of one vector have one E: the sum of the squares of its
//! components is the same along any axes, so that the reactions are the least ones however a mechanism is turned.
//! There need not be a solution: rigid bodies with large coefficients of friction can contradict Coulomb's law (Painlevé 1895).

use crate::matrix::{Blocks, Coefficients, Matrix};
use crate::why::Why;
use crate::{Block, Dims, Pattern, Sparsity, Terms};

/// Writes f_λ (nv) and R_λ (nv × m) of the multipliers (m) that it is given.
pub type ReactionFriction<'a> = dyn FnMut(&[f64], &mut [f64], &mut Block) + 'a;

/// The solver; sized at construction, then free of allocation.
#[derive(Clone, Debug)]
pub struct Friction {
    dims: Dims,
    blocks: Blocks,
    matrix: Matrix<f64>,
    /// R_λ of the factors at hand.
    factored: Vec<f64>,
    /// √D and √diag(G D⁻¹ Gᵀ) (nv + m): a and λ times these are comparable.
    weight: Vec<f64>,
    force: Vec<f64>,
    step: Vec<f64>,
}

/// E in parts of that of the KKT matrix.
const FIRMER: f64 = 100.0;

/// Most steps of Newton's method.
const STEPS: usize = 40;

/// Steps that refine, at least.
const REFINEMENTS: usize = 2;

/// A step of this size, in parts of the solution, is round-off.
const ROUNDED: f64 = 1e-14;

/// A step of this size that does not become smaller is as good as round-off lets it.
const STALLED: f64 = 1e-9;

impl Friction {
    /// A solver for the sizes and patterns of a system; none where no force depends on reactions.
    pub fn of_pattern(dims: Dims, pattern: &Pattern) -> Option<Self> {
        if pattern.r_lambda.entries() == 0 {
            return None;
        }
        let (nv, m) = (dims.v, dims.rows());
        let dims = Dims { z: 0, ..dims };
        let none = Sparsity::empty;
        let bare = Pattern {
            k: none(nv, nv),
            c: none(nv, nv),
            r_z: none(nv, 0),
            z_q: none(0, nv),
            z_v: none(0, nv),
            z_z: none(0, 0),
            g_scale: pattern.vector_scale.iter().map(|scale| FIRMER * scale).collect(),
            ..pattern.clone()
        };
        Some(Self {
            dims,
            blocks: Blocks::new(&bare),
            matrix: Matrix::new(dims, &bare),
            factored: vec![0.0; pattern.r_lambda.entries()],
            weight: pattern.metric.iter().chain(&pattern.vector_scale).map(|x| x.sqrt()).collect(),
            force: vec![0.0; nv],
            step: vec![0.0; nv + m],
        })
    }

    /// f_λ (nv) of the multipliers, by `friction_of`, which also writes R_λ.
    pub fn force(&mut self, lambda: &[f64], friction_of: &mut ReactionFriction<'_>) -> &[f64] {
        friction_of(lambda, &mut self.force, &mut self.blocks.tangent.r_lambda);
        &self.force
    }

    /// Accelerations `a` (nv) and multipliers `lambda` (m) of the terms; what they hold is the first guess.
    ///
    /// # Errors
    /// [`Why::Friction`] if there is no solution near, [`Why::NotFinite`] if a force is not.
    pub fn solve(&mut self, terms: &Terms, friction_of: &mut ReactionFriction<'_>, a: &mut [f64], lambda: &mut [f64]) -> Result<(), Why> {
        let nv = self.dims.v;
        self.blocks.take(terms);
        let (mut last, mut factored) = (f64::INFINITY, false);
        for step in 0..STEPS {
            friction_of(lambda, &mut self.force, &mut self.blocks.tangent.r_lambda);
            self.right_hand_side(terms, a, lambda);
            if let Some(i) = self.step[..nv].iter().position(|r| !r.is_finite()) {
                return Err(Why::NotFinite(i));
            }
            if !factored || self.factored != self.blocks.tangent.r_lambda.values() {
                self.factored.copy_from_slice(self.blocks.tangent.r_lambda.values());
                self.matrix.factor(&self.blocks, Coefficients { q: 0.0, v: 0.0, z: 0.0 }).map_err(|_| Why::Friction)?;
                factored = true;
            }
            self.matrix.solve(&mut self.step);
            let (size, whole) = self.advance(a, lambda);
            if !size.is_finite() {
                return Err(Why::Friction);
            }
            let done = size <= ROUNDED * whole || (size <= STALLED * whole && size > 0.1 * last);
            if size == 0.0 || step >= REFINEMENTS && done {
                return Ok(());
            }
            last = size;
        }
        Err(Why::Friction)
    }

    /// f + f_λ − M a − Gᵀλ and γ − G a.
    fn right_hand_side(&mut self, t: &Terms, a: &[f64], lambda: &[f64]) {
        let (motion, rows) = self.step.split_at_mut(self.dims.v);
        for ((i, r), row) in motion.iter_mut().enumerate().zip(t.mass.lines()) {
            *r = t.force[i] + self.force[i] - row.dot(a);
        }
        for ((r, row), (l, gamma)) in rows.iter_mut().zip(t.g.lines()).zip(lambda.iter().zip(&t.gamma)) {
            row.add_to(-l, motion);
            *r = gamma - row.dot(a);
        }
    }

    /// Adds the step to a and λ; the sizes of the step and of the sum.
    fn advance(&mut self, a: &mut [f64], lambda: &mut [f64]) -> (f64, f64) {
        let (mut size, mut whole) = (0.0, 0.0);
        for ((x, d), w) in a.iter_mut().chain(lambda).zip(&self.step).zip(&self.weight) {
            *x += d;
            size += (w * d).powi(2);
            whole += (w * *x).powi(2);
        }
        (f64::sqrt(size), f64::sqrt(whole))
    }
}
