//! Poses of all bodies at places of a motion, and between them.

use serde::{Deserialize, Serialize};

/// Frames that interpolation looks at.
const NODES: usize = 4;

/// Where the bodies are along a motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Frames {
    /// Independent variable of each frame, rising, SI.
    pub at: Vec<f64>,
    /// Poses, frame after frame and body after body without the ground. Plane: x, y, m, and the angle, rad, not wrapped. Space: x, y, z
    /// and a unit quaternion w, x, y, z, whose sign does not jump.
    pub poses: Vec<f64>,
    /// Frames that a still picture shows, the first one strongly.
    pub shown: Vec<usize>,
    /// Of a swing the frame at rest: arrows in a still picture tell what has moved from there to the first that it shows.
    #[serde(default)]
    pub rest: Option<usize>,
    /// What [`interpolate`] leaves out at most, m.
    pub error: f64,
    /// Whether the last frame is the first one again.
    pub closed: bool,
}

impl Frames {
    /// Number of frames.
    #[must_use]
    pub fn count(&self) -> usize {
        self.at.len()
    }

    /// Poses at a value of the independent variable by [`interpolate`]; beyond the ends those of the ends. Shape as one frame.
    #[must_use]
    pub fn at(&self, x: f64, dimensions: usize) -> Vec<f64> {
        let width = if self.at.is_empty() { 0 } else { self.poses.len() / self.at.len() };
        let mut out = vec![0.0; width];
        let ends = [self.at.first(), self.at.last()].map(|end| end.copied().unwrap_or(x));
        interpolate(&self.at, &self.poses, stride(dimensions), x.clamp(ends[0], ends[1]), &mut out);
        out
    }
}

/// Numbers of the pose of one body.
pub(super) fn stride(dimensions: usize) -> usize {
    if dimensions == 2 { 3 } else { 7 }
}

/// Poses at x by Lagrange's polynomial through the four frames around it (fewer if there are fewer), quaternions made unit again.
///
/// `at` are rising places (n), `poses` the frames (n · width) of bodies with `stride` numbers each, `out` the result (width).
pub fn interpolate(at: &[f64], poses: &[f64], stride: usize, x: f64, out: &mut [f64]) {
    out.fill(0.0);
    let (n, width) = (at.len(), out.len());
    let above = at.partition_point(|place| *place <= x);
    let first = above.saturating_sub(NODES / 2).min(n.saturating_sub(NODES));
    let nodes = first..(first + NODES).min(n);
    for k in nodes.clone() {
        let weight: f64 = nodes.clone().filter(|i| *i != k).map(|i| (x - at[i]) / (at[k] - at[i])).product();
        if weight != 0.0 {
            out.iter_mut().zip(&poses[k * width..(k + 1) * width]).for_each(|(sum, p)| *sum += weight * p);
        }
    }
    if stride == 7 {
        for pose in out.chunks_exact_mut(stride) {
            let length = pose[3..].iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 0.0 {
                pose[3..].iter_mut().for_each(|x| *x /= length);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_met() {
        let at: Vec<f64> = (0..6).map(f64::from).collect();
        let cubic = |x: f64| 1.0 + x * (2.0 - x * (0.5 - 0.1 * x));
        let frames = Frames { poses: at.iter().flat_map(|x| [cubic(*x), 0.0, *x]).collect(), at, ..Frames::default() };
        for x in [0.0, 0.3, 2.5, 4.9, 5.0] {
            let pose = frames.at(x, 2);
            assert!((pose[0] - cubic(x)).abs() < 1e-12 && (pose[2] - x).abs() < 1e-12, "{pose:?}");
        }
        assert_eq!(frames.at(9.0, 2), frames.at(5.0, 2));
    }

    #[test]
    fn few_frames_and_none_will_do() {
        let one = Frames { at: vec![1.0], poses: vec![3.0, 4.0, 5.0], ..Frames::default() };
        assert_eq!(one.at(7.0, 2), [3.0, 4.0, 5.0]);
        assert!(Frames::default().at(0.0, 3).is_empty());
    }
}
