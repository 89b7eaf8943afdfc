//! Whether a step has stayed on its branch.
//!
//! Where two branches of the motion come near each other without a change point, a longer step leads from one straight on to the other
//! (`kinematics/branch.rs`). With G₁ the independent rows and P₁ the motions of the pose before,
//!
//! ```text
//! det | G D^−½    |
//!     | P₁ᵀ D^½   |
//! ```
//!
//! keeps its sign along a branch as long as motions turn by less than a right angle.

use super::pose::Pose;
use super::rest::Rest;
use crate::geometry::Space;
use grashof_solvers::{Lu, Stage, System};

/// A step that leads across a singular position, rad or sizes, behind which branches are not told apart.
pub(super) const ACROSS: f64 = 2e-5;

/// Part of a row that is not in others from which on it is independent of them.
const INDEPENDENT: f64 = 1e-9;

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Whether a pose is on the branch of the one before; taken for granted where rows have another rank.
    pub(super) fn stays(&mut self, from: &Pose, to: &Pose) -> bool {
        let (nv, moves) = (self.zeros.len(), from.basis.ncols());
        if self.terms.phi.is_empty() || moves == 0 || to.basis.ncols() != moves {
            return true;
        }
        let before = self.rows_at(from);
        let chosen = independent(&before, nv);
        if chosen.len() + moves != nv {
            return true;
        }
        let after = self.rows_at(to);
        let root: Vec<f64> = self.system.pattern().metric.iter().map(|d| d.sqrt()).collect();
        let border: Vec<f64> = (0..moves).flat_map(|k| (0..nv).map(move |i| (i, k))).map(|(i, k)| from.basis[(i, k)] * root[i]).collect();
        let sign = |rows: &[f64]| {
            let mut whole: Vec<f64> = chosen.iter().flat_map(|row| &rows[row * nv..(row + 1) * nv]).copied().collect();
            whole.extend(&border);
            let mut lu = Lu::new(nv);
            lu.factor(&whole).ok().map(|()| lu.determinant_sign())
        };
        let [before, after] = [sign(&before), sign(&after)];
        before.zip(after).is_none_or(|(before, after)| before == after)
    }

    /// The rows of the constraints at a pose, times D^−½ (rows × nv, row by row).
    fn rows_at(&mut self, pose: &Pose) -> Vec<f64> {
        self.stand_at(&pose.position);
        self.evaluate(Stage::Position);
        let mut rows = self.terms.g.to_dense();
        let metric = &self.system.pattern().metric;
        rows.chunks_exact_mut(metric.len()).for_each(|row| row.iter_mut().zip(metric).for_each(|(g, d)| *g /= d.sqrt()));
        rows
    }
}

/// Rows (of nv entries) that do not depend on those before them, by Gram and Schmidt.
fn independent(rows: &[f64], nv: usize) -> Vec<usize> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut chosen, mut known) = (Vec::new(), Vec::<Vec<f64>>::new());
    for (index, row) in rows.chunks_exact(nv).enumerate() {
        let mut left = row.to_vec();
        // twice is enough
        for _ in 0..2 {
            for unit in &known {
                let part = dot(&left, unit);
                left.iter_mut().zip(unit).for_each(|(x, u)| *x -= part * u);
            }
        }
        let size = dot(&left, &left).sqrt();
        if size > INDEPENDENT * dot(row, row).sqrt() {
            left.iter_mut().for_each(|x| *x /= size);
            known.push(left);
            chosen.push(index);
        }
    }
    chosen
}
