//! Cylinders and the rods that slide in them.

use crate::results::Scene;

/// Cylinders, one in the other, that are told apart.
pub(super) const MOST: u32 = 4;

/// For each body of a scene how many cylinders are around it, and rods within it, one in the other.
pub(super) fn stages(scene: &Scene) -> Vec<[u32; 2]> {
    let slides: Vec<[usize; 2]> = scene.joints.iter().filter(|joint| joint.telescopes).map(|joint| [joint.a.body, joint.b.body]).collect();
    let turned: Vec<[usize; 2]> = slides.iter().map(|[rod, cylinder]| [*cylinder, *rod]).collect();
    (0..scene.bodies.len()).map(|body| [&slides, &turned].map(|pairs| behind(pairs, body, 0))).collect()
}

/// For each body of a scene the cylinder in which it slides.
pub(super) fn cylinders(scene: &Scene) -> Vec<Option<usize>> {
    let mut around = vec![None; scene.bodies.len()];
    for joint in scene.joints.iter().filter(|joint| joint.telescopes) {
        around[joint.a.body] = Some(joint.b.body);
    }
    around
}

/// How many bodies stand behind one, of pairs of a body and the next one, beside those that are known.
fn behind(pairs: &[[usize; 2]], body: usize, known: u32) -> u32 {
    let next = pairs.iter().filter(|pair| pair[0] == body && known < MOST);
    next.map(|pair| behind(pairs, pair[1], known + 1)).max().unwrap_or(known)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::scene::{Body, Joint, Place};

    #[test]
    fn stages_are_counted_from_both_ends_and_circles_end() {
        let slide = |[rod, cylinder]: [usize; 2]| Joint {
            a: Place { body: rod, at: vec![0.0; 2] },
            b: Place { body: cylinder, at: vec![0.0; 2] },
            telescopes: true,
            ..Joint::default()
        };
        let of = |pairs: &[[usize; 2]]| {
            stages(&Scene { bodies: vec![Body::default(); 4], joints: pairs.iter().copied().map(slide).collect(), ..Scene::default() })
        };
        assert_eq!(of(&[[3, 2], [2, 1]]), [[0, 0], [0, 2], [1, 1], [2, 0]]);
        assert_eq!(of(&[]), [[0, 0]; 4]);
        assert!(of(&[[1, 2], [2, 1]])[1][0] <= MOST);
    }
}
