//! How near a position is to a singular one where rows may be redundant.
//!
//! σ is a singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½. Each redundant row makes one that is zero all along; a position is singular where
//! another one becomes zero as well: the smallest of those that move. So as many vectors are followed as there are redundant rows, and
//! one more. How many are redundant is found at the start; a start in a singular position counts too many of them, until they move.
//!
//! Of very many redundant rows no vectors are followed: their combinations are filtered out of the one that moves.
//!
//! Rows may fall into groups that do not know each other (two linkages in one model, motion in a plane and across it). A vector that was
//! followed in one group never leaves it, so a fresh one is looked at each time, and followed if its value is less.

use crate::engine::Engine;
use crate::rank::Rank;

/// σ up to which a value counts as zero at the start, and above which it has moved: E hides what is smaller, and a state that was not
/// closed exactly has redundant rows that depend on each other no more exactly.
const ZERO: f64 = 1e-4;
const MOVED: f64 = 1e-2;

/// Redundant rows from which on their vectors are not followed.
const MANY: usize = 16;

/// Iterations from vectors that are arbitrary.
const FROM_AFAR: usize = 6;

/// The vectors that belong to the smallest singular values, from place to place.
#[derive(Clone, Debug, Default)]
pub struct Sigma {
    vectors: Vec<f64>,
    values: Vec<f64>,
    rows: usize,
}

impl Sigma {
    /// Room for a system with so many rows: nothing is redundant until [`Sigma::restart`] is told so.
    pub fn new(rows: usize) -> Self {
        let count = rows.min(2);
        Self { vectors: vec![0.0; count * rows], values: vec![1.0; count], rows }
    }

    /// Makes room for the redundant rows that the engine knows of.
    pub fn restart(&mut self, engine: &Engine) {
        let count = if engine.redundant < MANY { self.rows.min(engine.redundant + 2) } else { 2 };
        if count > self.values.len() {
            self.vectors.resize(count * self.rows, 0.0);
            self.values.resize(count, 0.0);
        }
    }

    /// Whether there is a value that moves.
    pub fn moves(&self, engine: &Engine) -> bool {
        engine.redundant < self.rows
    }

    /// The smallest σ that moves, of the rows factored last, by so many iterations; infinite where none does.
    pub fn follow(&mut self, engine: &mut Engine, iterations: usize) -> f64 {
        if !self.moves(engine) {
            return f64::INFINITY;
        }
        if engine.redundant >= MANY {
            return self.follow_one(engine, iterations);
        }
        let (count, rows) = (engine.redundant + 1, self.rows);
        for _ in 1..iterations {
            engine.kkt.smallest_singular_values(&mut self.vectors[..count * rows], &mut self.values[..count]);
        }
        let fresh = rows.min(count + 1);
        self.vectors[count * rows..fresh * rows].fill(0.0);
        engine.kkt.smallest_singular_values(&mut self.vectors[..fresh * rows], &mut self.values[..fresh]);
        if fresh > count && self.values[count] < self.values[count - 1] {
            self.values.swap(count - 1, count);
            let (followed, fresh) = self.vectors.split_at_mut(count * rows);
            followed[(count - 1) * rows..].swap_with_slice(&mut fresh[..rows]);
        }
        while engine.redundant > 0 && self.values[engine.redundant - 1] > MOVED {
            engine.redundant -= 1;
        }
        self.values[engine.redundant]
    }

    /// [`Sigma::follow`] beside very many redundant rows: the vector followed, or a fresh one whose value is less.
    fn follow_one(&mut self, engine: &mut Engine, iterations: usize) -> f64 {
        let rows = self.rows;
        let (followed, others) = self.vectors.split_at_mut(rows);
        let (mut sigma, mut other) = (0.0, 0.0);
        let fresh = &mut others[..rows];
        fresh.fill(0.0);
        for _ in 0..iterations {
            sigma = engine.kkt.smallest_singular_value_that_moves(followed);
            other = engine.kkt.smallest_singular_value_that_moves(fresh);
        }
        if other < sigma {
            followed.copy_from_slice(fresh);
        }
        f64::min(sigma, other)
    }

    /// The combination of rows that belongs to the value that [`Sigma::follow`] has found.
    pub fn row(&self, engine: &Engine) -> &[f64] {
        if engine.redundant >= MANY {
            &self.vectors[..self.rows]
        } else if self.moves(engine) {
            &self.vectors[engine.redundant * self.rows..][..self.rows]
        } else {
            &[]
        }
    }

    /// Counts the redundant rows of the start, whose matrix was factored last; σ there.
    pub fn begin(&mut self, engine: &mut Engine, metric: &[f64], g_scale: &[f64]) -> f64 {
        engine.redundant = 0;
        let mut sigma = self.follow(engine, FROM_AFAR);
        if sigma > ZERO {
            return sigma;
        }
        engine.redundant = self.rows - Rank::new(&engine.terms.g, metric, g_scale, ZERO).rank;
        loop {
            self.restart(engine);
            self.vectors.fill(0.0);
            sigma = self.follow(engine, FROM_AFAR);
            if sigma > ZERO || engine.redundant >= MANY {
                return sigma;
            }
            engine.redundant += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::shape::Shape;
    use crate::{Control, Dims, Pattern};

    /// Two pairs of rows that do not know each other, with the sines of the angles in each, and one of them twice more.
    fn rows(first: f64, second: f64) -> Vec<f64> {
        let cosine = |x: f64| (1.0 - x * x).sqrt();
        let pair = |x: f64| [1.0, 0.0, cosine(x), x];
        let ([a, b, c, d], [e, f, g, h]) = (pair(first), pair(second));
        [[a, b, 0.0, 0.0], [c, d, 0.0, 0.0], [0.0, 0.0, e, f], [0.0, 0.0, g, h], [c, d, 0.0, 0.0], [-a, -b, 0.0, 0.0]].concat()
    }

    /// An engine that has factored rows.
    fn factored(engine: &mut Engine, g: &[f64]) {
        (0..4).for_each(|i| engine.terms.mass.set(i, i, 1.0));
        engine.terms.g.values_mut().copy_from_slice(g);
        engine.factor().unwrap();
    }

    #[test]
    fn what_moves_is_followed_from_group_to_group() {
        let dims = Dims { q: 4, v: 4, holonomic: 6, ..Dims::default() };
        let pattern = Pattern { metric: vec![1.0; 4], g_scale: vec![1.0; 6], ..Pattern::dense(dims) };
        let system = Shape { pattern, dims };
        let mut engine = Engine::new(&system, Control::Tolerance(1e-8));
        let mut weakest = Sigma::new(6);
        factored(&mut engine, &rows(0.5, 0.8));
        weakest.begin(&mut engine, &[1.0; 4], &[1.0; 6]);
        assert_eq!(engine.redundant, 2);
        // the first group alone is weak for long, then the second becomes weaker
        for (first, second) in [(0.3, 0.8); 20].into_iter().chain([(0.3, 0.01); 4]) {
            factored(&mut engine, &rows(first, second));
            let sigma = weakest.follow(&mut engine, 1);
            let least = f64::min(1.5 * first, second);
            assert!(sigma > 0.4 * least && sigma < 2.0 * least, "{first} {second}: {sigma:e}");
        }
    }

    #[test]
    fn a_singular_start_counts_rows_until_they_move() {
        let dims = Dims { q: 4, v: 4, holonomic: 6, ..Dims::default() };
        let pattern = Pattern { metric: vec![1.0; 4], g_scale: vec![1.0; 6], ..Pattern::dense(dims) };
        let system = Shape { pattern, dims };
        let mut engine = Engine::new(&system, Control::Tolerance(1e-8));
        let mut weakest = Sigma::new(6);
        factored(&mut engine, &rows(0.0, 0.8));
        weakest.begin(&mut engine, &[1.0; 4], &[1.0; 6]);
        assert_eq!(engine.redundant, 3);
        for first in [1e-3, 0.1, 0.2] {
            factored(&mut engine, &rows(first, 0.8));
            weakest.follow(&mut engine, 1);
        }
        assert_eq!(engine.redundant, 2);
        factored(&mut engine, &rows(0.01, 0.8));
        assert!((1..4).fold(1.0, |_, _| weakest.follow(&mut engine, 1)) < 0.03);
    }

    #[test]
    fn very_many_redundant_rows_hide_no_singular_position() {
        // each row twenty times, some of them the other way round
        let copies = 20;
        let many = |first: f64, second: f64| -> Vec<f64> {
            let rows = rows(first, second);
            (0..copies).flat_map(|k| rows.iter().map(move |x| if k % 3 == 1 { -x } else { *x }).collect::<Vec<_>>()).collect()
        };
        let count = 6 * copies;
        let dims = Dims { q: 4, v: 4, holonomic: count, ..Dims::default() };
        let pattern = Pattern { metric: vec![1.0; 4], g_scale: vec![1.0; count], ..Pattern::dense(dims) };
        let system = Shape { pattern, dims };
        let mut engine = Engine::new(&system, Control::Tolerance(1e-8));
        let mut weakest = Sigma::new(count);
        factored(&mut engine, &many(0.5, 0.8));
        weakest.begin(&mut engine, &[1.0; 4], &vec![1.0; count]);
        assert_eq!(engine.redundant, count - 4);
        for (first, second) in [(0.3, 0.8); 20].into_iter().chain([(0.3, 0.01); 6]) {
            factored(&mut engine, &many(first, second));
            let sigma = weakest.follow(&mut engine, 1);
            // twenty copies of a row are as one that is √20 times as long
            let least = f64::min(1.5 * first, second) * (copies as f64).sqrt();
            assert!(sigma > 0.4 * least && sigma < 2.0 * least, "{first} {second}: {sigma:e} of {least:e}");
            assert_eq!(weakest.row(&engine).len(), count);
        }
    }
}
