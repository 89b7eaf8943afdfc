//! Springs, dampers, rods, racks, and what of ropes and belts is straight: one thin rod, and one coil, that are placed, turned and
//! stretched.

use super::mesh::{Mesh, V, cross, length, minus};
use super::shapes::Builder;
use crate::output::winding::stretches;
use crate::results::Scene;
use crate::results::scene::LinkKind;

/// Coils of a spring.
const COILS: usize = 8;

/// A link over all frames.
#[derive(Clone, Debug)]
pub(super) struct Moving {
    pub(super) name: String,
    pub(super) places: Vec<V>,
    /// Unit quaternions x, y, z, w.
    pub(super) turns: Vec<[f64; 4]>,
    pub(super) scales: Vec<V>,
    /// Whether it is a coil.
    pub(super) coil: bool,
}

/// What is seen of links and gears.
pub(super) fn moving(scene: &Scene, frames: &[Vec<f64>]) -> Vec<Moving> {
    let about_hinges = |kind| matches!(kind, LinkKind::Torsion | LinkKind::Clutch | LinkKind::Brake);
    let links = scene.links.iter().filter(|link| !about_hinges(link.kind)).map(|link| {
        let ends = frames.iter().map(|poses| scene.ends(poses, link)).collect();
        (link.name.clone(), matches!(link.kind, LinkKind::Spring | LinkKind::SpringDamper), ends)
    });
    let gears = scene.gears.iter().flat_map(|gear| {
        let all: Vec<Vec<[V; 2]>> = frames.iter().map(|poses| stretches(scene, poses, gear)).collect();
        let count = all.first().map_or(0, Vec::len);
        (0..count).map(move |k| (gear.name.clone(), false, all.iter().map(|parts| parts[k]).collect()))
    });
    let all = links.chain(gears).filter(|(_, _, ends): &(_, _, Vec<[V; 2]>)| !ends.is_empty());
    all.filter(|(_, _, ends)| ends.iter().flatten().flatten().all(|x| x.is_finite()))
        .map(|(name, coil, ends)| {
            let mut turns: Vec<[f64; 4]> = Vec::new();
            for [a, b] in &ends {
                let turn = arc([0.0, 0.0, 1.0], minus(*b, *a));
                let back = turns.last().is_some_and(|last| last.iter().zip(turn).map(|(x, y)| x * y).sum::<f64>() < 0.0);
                turns.push(if back { turn.map(|x| -x) } else { turn });
            }
            let scales = ends.iter().map(|[a, b]| [1.0, 1.0, length(minus(*b, *a)).max(1e-9)]).collect();
            Moving { name, places: ends.iter().map(|[a, _]| *a).collect(), turns, scales, coil }
        })
        .collect()
}

/// The rod: 1 m along z.
pub(super) fn unit(builder: &Builder<'_>) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.tube([0.0; 3], [0.0, 0.0, 1.0], builder.thin());
    mesh
}

/// The spring: a coil of 1 m along z about a thin rod.
pub(super) fn unit_coil(builder: &Builder<'_>) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.coil(COILS, 2.6 * builder.thin(), 0.7 * builder.thin());
    mesh.tube([0.0; 3], [0.0, 0.0, 1.0], 0.35 * builder.thin());
    mesh
}

/// The shortest turn from one direction to another: a unit quaternion x, y, z, w.
pub(super) fn arc(from: V, to: V) -> [f64; 4] {
    let (a, b) = (length(from), length(to));
    if a.is_nan() || b.is_nan() || a <= 0.0 || b <= 0.0 {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let (from, to) = (from.map(|x| x / a), to.map(|x| x / b));
    let w = 1.0 + from.iter().zip(to).map(|(x, y)| x * y).sum::<f64>();
    if w < 1e-9 {
        // half a turn about any axis across
        let [u, _] = crate::output::view::across(from);
        return [u[0], u[1], u[2], 0.0];
    }
    let [x, y, z] = cross(from, to);
    let size = (x * x + y * y + z * z + w * w).sqrt();
    [x / size, y / size, z / size, w / size]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_is_turned_to_y() {
        let [x, y, z, w] = arc([0.0, 0.0, 1.0], [0.0, 2.0, 0.0]);
        let half = 0.5_f64.sqrt();
        assert!((x + half).abs() < 1e-12 && y == 0.0 && z == 0.0 && (w - half).abs() < 1e-12);
        let back = arc([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
        assert!((back.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12 && back[2] == 0.0);
        assert_eq!(arc([0.0; 3], [0.0, 1.0, 0.0]), [0.0, 0.0, 0.0, 1.0]);
    }
}
