//! Frames of a scene as a page has them: whole multiples of a small unit, of which differences are kept.
//!
//! Poses of neighbouring frames differ little, and so do their differences. Differences of that order which takes the fewest digits
//! are a few digits long, where the poses themselves need ten.

use super::rows::{Allowed, Curves};
use crate::results::Scene;
use crate::results::scene::{Arrow, Frames, interpolate};
use serde::Serialize;

/// Part of the size of a mechanism to which poses are rounded; angles and quaternions in absolute terms.
const PLACE: f64 = 1e-8;
/// Parts of the largest value, for arrows, and of the range, for places of frames.
const ARROW: f64 = 1e-5;
const AT: f64 = 1e-12;
/// Differences of higher orders hold more noise of rounding than motion.
const ORDERS: usize = 6;
/// What thinned frames may be off by, as part of the size, before they are chosen by what interpolation leaves out; and by what then.
const UNSEEN: f64 = 1e-4;
const CHOSEN: f64 = 1e-5;
/// Frames that are left at least.
const FEWEST: usize = 24;

/// Numbers of equal frames as differences.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Differences {
    /// What 1 is, for each number of a frame.
    unit: Vec<f64>,
    /// Order of the differences.
    order: usize,
    /// For each number of a frame its differences from frame to frame; before the first frame there are zeros.
    values: Vec<i64>,
}

impl Differences {
    /// Of numbers frame after frame, which are rounded to `unit`.
    fn of(numbers: &[f64], unit: Vec<f64>) -> Self {
        let width = unit.len().max(1);
        // beyond 2^53 the multiples are not exact
        let whole = |k: usize, unit: f64| {
            let mut values: Vec<i64> = numbers.iter().skip(k).step_by(width).map(|x| (x / unit).round() as i64).collect();
            values.iter_mut().for_each(|x| *x = (*x).clamp(-(1 << 53), 1 << 53));
            values
        };
        let mut values: Vec<Vec<i64>> = unit.iter().enumerate().map(|(k, unit)| whole(k, *unit)).collect();
        let digits = |values: &[Vec<i64>]| values.iter().flatten().map(|x| u64::from(64 - x.unsigned_abs().leading_zeros())).sum::<u64>();
        let (mut best, mut order) = (values.clone(), 0);
        for next in 1..=ORDERS {
            values.iter_mut().for_each(|values| difference(values));
            if digits(&values) < digits(&best) {
                (best, order) = (values.clone(), next);
            }
        }
        Self { unit, order, values: best.concat() }
    }
}

/// Each number less the one before it.
fn difference(values: &mut [i64]) {
    for i in (1..values.len()).rev() {
        values[i] = values[i].wrapping_sub(values[i - 1]);
    }
}

/// The frames of a scene.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Coded {
    /// Places.
    pub(super) at: Differences,
    /// Poses.
    pub(super) poses: Differences,
    /// Values of the arrows.
    pub(super) arrows: Vec<Option<Differences>>,
}

impl Coded {
    /// Of all frames of a scene.
    pub(super) fn of(scene: &Scene) -> Self {
        let Frames { at, poses, .. } = &scene.frames;
        let range = at.last().zip(at.first()).map_or(0.0, |(to, from)| (to - from).abs());
        let arrow = |arrow: &Arrow| {
            (!arrow.values.is_empty())
                .then(|| Differences::of(&arrow.values, vec![ten(ARROW * largest(&arrow.values)); arrow.values.len() / at.len().max(1)]))
        };
        Self {
            at: Differences::of(at, vec![ten(AT * range)]),
            poses: Differences::of(poses, units(scene)),
            arrows: scene.arrows.iter().map(arrow).collect(),
        }
    }
}

/// What the numbers of a frame are rounded to.
fn units(scene: &Scene) -> Vec<f64> {
    let (stride, dimensions) = (scene.stride(), scene.dimensions);
    let length = ten(PLACE * size(scene));
    (0..scene.width()).map(|k| if k % stride < dimensions { length } else { ten(PLACE) }).collect()
}

/// How far places of bodies lie apart, m, from one coordinate to the other.
fn size(scene: &Scene) -> f64 {
    let (stride, dimensions) = (scene.stride(), scene.dimensions);
    let joints = scene.joints.iter().flat_map(|joint| joint.a.at.iter().chain(&joint.b.at).map(|x| x.abs()));
    let reach = joints.fold(0.0, f64::max);
    let ranges = (0..dimensions).map(|axis| {
        let places = scene.frames.poses.chunks_exact(stride).map(|pose| pose[axis]).filter(|x| x.is_finite());
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low > high { 0.0 } else { high - low }
    });
    ranges.fold(reach, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().filter(|x| x.is_finite()).fold(0.0, |most, x| x.abs().max(most))
}

/// The power of ten at or below a number; 1 for zero.
fn ten(x: f64) -> f64 {
    if x > 0.0 && x.is_finite() { format!("1e{}", x.log10().floor() as i32).parse().unwrap_or(1.0) } else { 1.0 }
}

/// About `most` numbers: every second frame, and again; where too much is left out between those, the frames that interpolation asks for.
pub(super) fn thinned(scene: &mut Scene, most: usize) {
    let count = scene.frames.at.len();
    let width = scene.width().max(1);
    let mut kept: Vec<usize> = (0..count).collect();
    while kept.len() * width > most && kept.len() / 2 >= FEWEST {
        let last = kept.len() - 1;
        kept = kept.iter().enumerate().filter(|(i, _)| i % 2 == 0 || *i == last).map(|(_, frame)| *frame).collect();
    }
    if kept.len() == count {
        return;
    }
    let mut off = left_out(scene, &kept);
    if off > UNSEEN * size(scene) {
        kept = chosen(scene, (most / width).max(FEWEST));
        off = left_out(scene, &kept);
    }
    let rows = |values: &[f64], width: usize| -> Vec<f64> {
        kept.iter().flat_map(|i| values.iter().skip(i * width).take(width).copied()).collect()
    };
    for arrow in &mut scene.arrows {
        arrow.values = rows(&arrow.values, arrow.values.len() / count);
    }
    let frames = &mut scene.frames;
    frames.shown.iter_mut().for_each(|i| *i = kept.partition_point(|frame| frame < i).min(kept.len() - 1));
    frames.shown.dedup();
    (frames.at, frames.poses) = (rows(&frames.at, 1), rows(&frames.poses, width));
    frames.error += off;
}

/// What a turn moves at most, m for a rad, or for a number of a quaternion.
fn turned(scene: &Scene) -> f64 {
    size(scene) * if scene.dimensions == 2 { 1.0 } else { 2.0 }
}

/// How far bodies are from where they are drawn at most, m, if some frames alone are kept.
fn left_out(scene: &Scene, kept: &[usize]) -> f64 {
    let (stride, width, dimensions) = (scene.stride(), scene.width(), scene.dimensions);
    let Frames { at, poses, .. } = &scene.frames;
    let places: Vec<f64> = kept.iter().map(|i| at[*i]).collect();
    let nodes: Vec<f64> = kept.iter().flat_map(|i| &poses[i * width..(i + 1) * width]).copied().collect();
    let arm = turned(scene);
    let mut found = vec![0.0; width];
    let mut most: f64 = 0.0;
    for (x, frame) in at.iter().zip(poses.chunks_exact(width.max(1))) {
        interpolate(&places, &nodes, stride, *x, &mut found);
        for (a, b) in found.chunks_exact(stride).zip(frame.chunks_exact(stride)) {
            let gap =
                |range: std::ops::Range<usize>| a[range.clone()].iter().zip(&b[range]).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            most = most.max(gap(0..dimensions) + arm * gap(dimensions..stride));
        }
    }
    most
}

/// About `most` frames, as many as interpolation needs.
fn chosen(scene: &Scene, most: usize) -> Vec<usize> {
    let (stride, width) = (scene.stride(), scene.width());
    let columns: Vec<Vec<f64>> = (0..width).map(|k| scene.frames.poses.iter().skip(k).step_by(width).copied().collect()).collect();
    let off = CHOSEN * size(scene);
    let within = |k: usize| if k % stride < scene.dimensions { off } else { off / turned(scene) };
    let allowed = (0..width).map(|k| Allowed::everywhere(within(k).max(f64::MIN_POSITIVE))).collect();
    let columns = columns.iter().map(Vec::as_slice).collect();
    // twice as many at one go may be more than are wanted
    Curves { x: &scene.frames.at, columns, allowed, switches: &[] }.kept(most / 2).rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the page does it.
    fn read(coded: &Differences) -> Vec<f64> {
        let width = coded.unit.len();
        let count = coded.values.len() / width;
        let mut out = vec![0.0; coded.values.len()];
        for (k, unit) in coded.unit.iter().enumerate() {
            let mut values = coded.values[k * count..(k + 1) * count].to_vec();
            for _ in 0..coded.order {
                for i in 1..count {
                    values[i] += values[i - 1];
                }
            }
            values.iter().enumerate().for_each(|(i, x)| out[i * width + k] = *x as f64 * unit);
        }
        out
    }

    #[test]
    fn differences_of_a_smooth_motion_are_short_and_read_back() {
        let numbers: Vec<f64> = (0..400).flat_map(|i| [(0.05 * f64::from(i)).sin(), 0.05 * f64::from(i)]).collect();
        let coded = Differences::of(&numbers, vec![1e-8, 1e-8]);
        assert!(coded.order > 2, "{}", coded.order);
        assert!(coded.values[10..400].iter().all(|x| x.abs() < 1000));
        let off = read(&coded).iter().zip(&numbers).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.51e-8, "{off}");
    }

    #[test]
    fn units_are_powers_of_ten() {
        assert_eq!([ten(2.5e-8), ten(1e-8), ten(0.0), ten(f64::NAN)], [1e-8, 1e-8, 1.0, 1.0]);
    }

    #[test]
    fn frames_are_halved_with_their_ends_kept() {
        let at: Vec<f64> = (0..=100).map(f64::from).collect();
        let poses = at.iter().flat_map(|x| [*x, 0.0, 0.0]).collect();
        let frames = Frames { poses, at, shown: vec![0, 50, 100], error: 1e-6, ..Frames::default() };
        let mut scene = Scene { dimensions: 2, bodies: vec![Default::default(); 2], frames, ..Scene::default() };
        thinned(&mut scene, 160);
        assert_eq!(scene.frames.at.len(), 51);
        assert_eq!((scene.frames.at.last(), scene.frames.poses.len()), (Some(&100.0), 153));
        assert_eq!(scene.frames.shown, [0, 25, 50]);
        // along a straight line nothing is left out
        assert!((scene.frames.error - 1e-6).abs() < 1e-12, "{}", scene.frames.error);
    }

    #[test]
    fn frames_that_lie_close_beside_a_dead_point_stay() {
        // a body that moves with the root of the way to the end, at frames ever closer to it
        let at: Vec<f64> = (0..2000).map(|i| 1.0 - (1.0 - f64::from(i) / 1999.0).powi(4)).collect();
        let poses: Vec<f64> = at.iter().flat_map(|x| [(1.0 - x).max(0.0).sqrt(), 0.0, 0.0]).collect();
        let frames = Frames { poses: poses.clone(), at: at.clone(), shown: vec![0, 1999], ..Frames::default() };
        let mut scene = Scene { dimensions: 2, bodies: vec![Default::default(); 2], frames, ..Scene::default() };
        thinned(&mut scene, 600);
        let Frames { at: places, poses: nodes, shown, error, .. } = &scene.frames;
        assert!(places.len() < 210 && *error < 1e-4, "{} frames, to within {error}", places.len());
        assert_eq!(shown[..], [0, places.len() - 1]);
        let off = at.iter().zip(poses.chunks_exact(3)).map(|(x, pose)| {
            let mut found = [0.0; 3];
            interpolate(places, nodes, 3, *x, &mut found);
            (found[0] - pose[0]).abs()
        });
        assert!(off.fold(0.0, f64::max) <= error + 1e-15);
    }
}
