//! Frames of a scene as a page has them: whole multiples of a small unit, of which differences are kept.
//!
//! Poses of neighbouring frames differ little, and so do their differences. Differences of that order which takes the fewest digits
//! are a few digits long, where the poses themselves need ten.

use crate::results::Scene;
use crate::results::scene::{Arrow, Frames};
use serde::Serialize;

/// Part of the size of a mechanism to which poses are rounded; angles and quaternions in absolute terms.
const PLACE: f64 = 1e-8;
/// Parts of the largest value, for arrows, and of the range, for places of frames.
const ARROW: f64 = 1e-5;
const AT: f64 = 1e-12;
/// Differences of higher orders hold more noise of rounding than motion.
const ORDERS: usize = 6;
/// Half as many frames leave out so much more between them: the fourth power of the distance.
const COARSER: f64 = 16.0;
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

/// Every second frame, until there are about `most` numbers.
pub(super) fn thinned(scene: &mut Scene, most: usize) {
    let width = scene.width().max(1);
    while scene.frames.poses.len() > most && scene.frames.at.len() / 2 >= FEWEST {
        let count = scene.frames.at.len();
        let kept: Vec<usize> = (0..count).filter(|i| i % 2 == 0 || i + 1 == count).collect();
        let chosen = |values: &[f64], width: usize| -> Vec<f64> {
            kept.iter().flat_map(|i| values.iter().skip(i * width).take(width).copied()).collect()
        };
        for arrow in &mut scene.arrows {
            let width = arrow.values.len() / count;
            arrow.values = chosen(&arrow.values, width);
        }
        let frames = &mut scene.frames;
        frames.at = chosen(&frames.at, 1);
        frames.poses = chosen(&frames.poses, width);
        frames.shown.iter_mut().for_each(|i| *i = i.div_ceil(2).min(kept.len() - 1));
        frames.shown.dedup();
        frames.error *= COARSER;
    }
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
        let frames = Frames { poses, at, shown: vec![0, 50, 100], error: 1e-6, closed: false };
        let mut scene = Scene { dimensions: 2, bodies: vec![Default::default(); 2], frames, ..Scene::default() };
        thinned(&mut scene, 160);
        assert_eq!(scene.frames.at.len(), 51);
        assert_eq!((scene.frames.at.last(), scene.frames.poses.len()), (Some(&100.0), 153));
        assert_eq!((scene.frames.shown, scene.frames.error), (vec![0, 25, 50], 16e-6));
    }
}
