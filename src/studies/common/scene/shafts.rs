//! Shafts with cranks: bodies in space that turn on the ground about one axis and have points beside it at several places along it.
//!
//! A plate around such points, or legs to them, would go through the rods that turn on them. So each of these points is the middle of a pin
//! between two webs, and journals lie along the axis from web to web.

use crate::geometry::Space;
use crate::mechanism::{Mechanism, Outline};
use crate::results::Scene;
use crate::results::scene::{Joint, Shape};

/// Half length of a pin, as part of the distance between neighbours along the axis.
const PIN: f64 = 0.25;
/// Points nearer to the axis are on it, and nearer to each other along it at one place, as part of the size of the body.
const NEAR: f64 = 1e-6;

/// Gives bodies that are shafts with cranks the bars of these in place of the hull of their points. The joints of the scene are there.
pub(super) fn outline_shafts<G: Space>(mechanism: &Mechanism<G>, scene: &mut Scene) {
    if scene.dimensions != 3 || scene.frames.count() == 0 {
        return;
    }
    // a block, beam or solid shows what it is
    let sized = |body: usize| match mechanism.bodies[body].outline {
        _ if !mechanism.bodies[body].solids.is_empty() => true,
        Some(Outline::Bar { width, height, .. }) => width.max(height) > 0.0,
        Some(Outline::Block { .. } | Outline::Ball { .. }) => true,
        Some(Outline::Disc { .. }) | None => false,
    };
    for body in (1..scene.bodies.len()).filter(|body| !sized(*body)) {
        let Some((at, axis)) = bearing(scene, body) else { continue };
        let shapes = &mut scene.bodies[body].shapes;
        let Some(index) = shapes.iter().position(|shape| matches!(shape, Shape::Hull { .. })) else { continue };
        let Shape::Hull { points } = &shapes[index] else { continue };
        let Some(bars) = bars(points, at, axis) else { continue };
        let bars = bars.into_iter().map(|[a, b]| Shape::Bar { from: a.to_vec(), to: b.to_vec(), width: None });
        shapes.splice(index..=index, bars);
    }
}

/// The point and the axis, in the body, of the hinges by which it turns on the ground, if they have one axis.
fn bearing(scene: &Scene, body: usize) -> Option<([f64; 3], [f64; 3])> {
    let sides = |joint: &Joint| [joint.a.body, joint.b.body];
    let hinges = scene.joints.iter().filter(|joint| joint.kind == "revolute" && sides(joint).contains(&0) && sides(joint).contains(&body));
    let of = |joint: &Joint| {
        let poses = scene.frame(0);
        let along = scene.direction(poses, joint.a.body, &joint.axis);
        let own: [f64; 3] = std::array::from_fn(|i| {
            let e: [f64; 3] = std::array::from_fn(|k| f64::from(u8::from(i == k)));
            dot(scene.direction(poses, body, &e), along)
        });
        let at = if joint.a.body == body { &joint.a.at } else { &joint.b.at };
        (std::array::from_fn(|i| at.get(i).copied().unwrap_or(0.0)), own)
    };
    let all: Vec<([f64; 3], [f64; 3])> = hinges.map(of).collect();
    let (at, axis) = *all.first()?;
    let one = |(p, n): &([f64; 3], [f64; 3])| {
        let (d, along) = (minus(*p, at), dot(minus(*p, at), axis));
        dot(*n, axis).abs() > 1.0 - NEAR && dot(d, d) - along * along <= NEAR * dot(d, d).max(f64::MIN_POSITIVE)
    };
    all.iter().all(one).then_some((at, axis))
}

/// Journals, webs and pins; none unless points beside the axis stand at two places along it.
fn bars(points: &[Vec<f64>], at: [f64; 3], axis: [f64; 3]) -> Option<Vec<[[f64; 3]; 2]>> {
    let from = |p: &Vec<f64>| minus(std::array::from_fn(|i| p[i]), at);
    let size = points.iter().map(|p| dot(from(p), from(p)).sqrt()).fold(0.0, f64::max);
    let near = NEAR * size;
    let place = |s: f64| shifted(at, axis, s);
    // places along the axis, with the way from there to a point beside it
    let mut all: Vec<(f64, Option<[f64; 3]>)> = points
        .iter()
        .map(from)
        .map(|d| {
            let (s, out) = (dot(d, axis), shifted(d, axis, -dot(d, axis)));
            (s, (dot(out, out).sqrt() > near).then_some(out))
        })
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let cranks: Vec<(f64, [f64; 3])> = all.iter().filter_map(|(s, out)| Some((*s, (*out)?))).collect();
    let mut stations: Vec<f64> = cranks.iter().map(|(s, _)| *s).collect();
    stations.dedup_by(|a, b| (*a - *b).abs() <= near);
    let spacing = stations.windows(2).map(|pair| pair[1] - pair[0]).reduce(f64::min)?;
    let half = PIN * spacing;
    let mut bars = Vec::new();
    // journals: what of the axis is between the webs, and beyond the last ones as far as a point on it or as a pin is long
    let ends = [all[0].0.min(stations[0] - 2.0 * half), all[all.len() - 1].0.max(stations[stations.len() - 1] + 2.0 * half)];
    let edges: Vec<f64> = std::iter::once(ends[0]).chain(stations.iter().flat_map(|s| [s - half, s + half])).chain([ends[1]]).collect();
    bars.extend(edges.chunks_exact(2).map(|pair| [place(pair[0]), place(pair[1])]));
    for (s, out) in cranks {
        let [low, high] = [s - half, s + half].map(|s| (place(s), shifted(place(s), out, 1.0)));
        bars.extend([[low.0, low.1], [low.1, high.1], [high.1, high.0]]);
    }
    Some(bars)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    shifted(a, b, -1.0)
}

/// a + s b.
fn shifted(a: [f64; 3], b: [f64; 3], s: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + s * b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crankshaft_has_webs_and_leaves_room_for_its_rods() {
        let points = [[-0.3, 0.0, 0.1], [-0.1, 0.0, -0.1], [0.1, 0.0, -0.1], [0.3, 0.0, 0.1], [0.0; 3]].map(|p| p.to_vec());
        let bars = bars(&points, [0.0; 3], [1.0, 0.0, 0.0]).expect("a crankshaft");
        // five journals; a pin and two webs to each crank
        assert_eq!(bars.len(), 5 + 4 * 3);
        assert!(bars[..5].iter().all(|[a, b]| a[0] < b[0] && a[2] == 0.0 && b[2] == 0.0), "{bars:?}");
        for p in &points[..4] {
            let through = |[a, b]: &&[[f64; 3]; 2]| {
                // the middle of the pin, and nothing on the axis beside it
                let within = (a[0].min(b[0])..=a[0].max(b[0])).contains(&p[0]);
                within && a[2] == b[2]
            };
            let found: Vec<_> = bars.iter().filter(through).collect();
            assert!(found.len() == 1 && (found[0][0][2] - p[2]).abs() < 1e-12, "{p:?}: {found:?}");
            // as long as half the distance between neighbours, so that rods have room
            assert!((found[0][1][0] - found[0][0][0] - 0.1).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn points_at_one_place_along_the_axis_are_no_shaft() {
        let points = [[0.0, 0.0, 0.1], [0.0, 0.2, -0.1], [0.0, 0.0, -0.1], [0.3, 0.0, 0.0]].map(|p| p.to_vec());
        assert!(bars(&points, [0.0; 3], [1.0, 0.0, 0.0]).is_none());
    }
}
