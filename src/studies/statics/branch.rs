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

/// Part of a row that is not in others from which on it is independent of them.
const INDEPENDENT: f64 = 1e-9;

/// Independent rows of a pose (by number, of nv entries each), with the motions P that are left.
struct Frame {
    chosen: Vec<usize>,
    border: Vec<f64>,
}

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
        let Some(frame) = self.frame(from) else { return true };
        let [Some((side, before)), Some((other, behind))] = [from, to].map(|pose| self.determinant(pose, &frame)) else { return true };
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
            let Some((_, there)) = self.frame(&next).and_then(|frame| self.determinant(&next, &frame)) else { return true };
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

    fn frame(&mut self, pose: &Pose) -> Option<Frame> {
        let nv = self.zeros.len();
        let chosen = independent(&self.rows_at(pose), nv);
        let root: Vec<f64> = self.system.pattern().metric.iter().map(|d| d.sqrt()).collect();
        let moves = pose.basis.ncols();
        let border = (0..moves).flat_map(|k| (0..nv).map(move |i| (i, k))).map(|(i, k)| pose.basis[(i, k)] * root[i]).collect();
        (chosen.len() + moves == nv).then_some(Frame { chosen, border })
    }

    /// The sign and ln |det| of the rows at a pose with the motions of another one.
    fn determinant(&mut self, pose: &Pose, frame: &Frame) -> Option<(f64, f64)> {
        let (nv, rows) = (self.zeros.len(), self.rows_at(pose));
        let mut whole: Vec<f64> = frame.chosen.iter().flat_map(|row| &rows[row * nv..(row + 1) * nv]).copied().collect();
        whole.extend(&frame.border);
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
