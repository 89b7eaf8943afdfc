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
//! keeps its sign along a branch as long as motions turn by less than a right angle. A step that changes it is followed again by parts of the
//! way at whose end the determinant would vanish, which come to nothing before a change point alone.

use super::pose::Pose;
use super::rest::Rest;
use crate::geometry::Space;
use grashof_solvers::{Lu, Stage, System};
use nalgebra::DVector;

/// A way to a singular position, rad or sizes, from which on it is that of a change point.
const ACROSS: f64 = 1e-4;

/// Part of that way that a step goes, and steps at most.
const PART: f64 = 0.6;
const STEPS: usize = 60;

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Whether a pose behind a displacement (nv) is on the branch of the one before, or a change point between them leads to it; taken for
    /// granted where rows have another rank.
    pub(super) fn stays(&mut self, from: &Pose, delta: &[f64], to: &Pose) -> bool {
        if self.terms.phi.is_empty() || from.basis.ncols() == 0 || to.basis.ncols() != from.basis.ncols() {
            return true;
        }
        let [Some((side, before)), Some((other, behind))] = [from, to].map(|pose| self.determinant(pose, from)) else { return true };
        if side == other {
            return true;
        }
        let crosses = self.crosses(from, delta, before, behind);
        self.crossed |= crosses;
        crosses
    }

    /// Whether a change point lies on the way along a displacement (nv) from a pose; ln |det| there and behind it.
    fn crosses(&mut self, from: &Pose, delta: &[f64], before: f64, behind: f64) -> bool {
        let whole = self.measure(&DVector::from_column_slice(delta));
        let metric = self.system.pattern().metric.clone();
        let weighted = DVector::from_fn(delta.len(), |k, _| metric[k] * delta[k]);
        let (mut pose, mut value, mut gone) = (from.clone(), before, 0.0);
        let mut left = whole / (1.0 + (behind - before).exp());
        for _ in 0..STEPS {
            if left < ACROSS {
                return true;
            }
            let along = &pose.basis * (pose.basis.transpose() * &weighted);
            let size = self.measure(&along);
            let stride = (PART * left).min(whole);
            if size <= 0.0 || gone > 2.0 * whole {
                return false;
            }
            let Ok(next) = self.moved(&pose, (along * (stride / size)).as_slice()) else { return false };
            let Some((_, there)) = self.determinant(&next, &next) else { return true };
            let falls = (value - there).exp() - 1.0;
            // it turns away before it has vanished
            if falls <= 0.0 {
                return false;
            }
            left = stride / falls;
            gone += stride;
            (pose, value) = (next, there);
        }
        false
    }

    /// The sign and ln |det| of the rows at a pose that are independent in another one, with the motions of that.
    fn determinant(&mut self, pose: &Pose, of: &Pose) -> Option<(f64, f64)> {
        let (nv, rows) = (self.zeros.len(), self.rows_at(pose));
        let metric = &self.system.pattern().metric;
        let mut whole: Vec<f64> = of.independent.iter().flat_map(|row| &rows[row * nv..(row + 1) * nv]).copied().collect();
        of.basis.column_iter().for_each(|motion| whole.extend(motion.iter().zip(metric).map(|(p, d)| p * d.sqrt())));
        let mut lu = Lu::new(nv);
        lu.factor(&whole).ok().map(|()| (lu.determinant_sign(), lu.log_determinant()))
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
