//! In which sense joints are driven over a motion: by the laws of drivers, whatever positions are drawn, else by how the joint moves.

use super::joints::on_ground;
use super::turn::step;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::results::Scene;
use crate::results::scene::Joint;
use crate::studies::common::case::Case;

/// Moments at which the law of a driver is looked at.
const LOOKS: u32 = 2000;
/// A rate the other way that is less than this part of the largest one is round-off.
const NO_RATE: f64 = 1e-9;
/// A way back that is less than this part of the way forth is not counted, where a joint is driven by a force.
const NO_WAY: f64 = 1e-3;

/// Tells the joints of a scene in which sense they are driven between two times, s; without times by the frames alone.
pub(super) fn tell<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, times: Option<[f64; 2]>, scene: &mut Scene) {
    let laws = times.map(|times| laws(mechanism, times)).unwrap_or_default();
    let of_driver = |joint: &Joint| {
        let drives = |driver: &crate::model::Driver| mechanism.joints[driver.joint].name == joint.name;
        let driver = case.model.drivers.iter().position(drives)?;
        // counter-clockwise is drawn of what moves, whichever body the model names first
        let other_way = scene.dimensions == 2 && joint.kind == "revolute" && on_ground(mechanism, case.model.drivers[driver].joint);
        laws.get(driver).map(|sense| if other_way { 0.0 - sense } else { *sense })
    };
    // of a cylinder, the second body, it is its rod that is seen to move
    let seen = |joint: &Joint| if joint.telescopes { -1.0 } else { 1.0 };
    let told =
        |joint: &Joint| if joint.driven { seen(joint) * of_driver(joint).unwrap_or_else(|| by_frames(scene, joint)) + 0.0 } else { 0.0 };
    let senses: Vec<f64> = scene.joints.iter().map(told).collect();
    scene.joints.iter_mut().zip(senses).for_each(|(joint, sense)| joint.sense = sense);
}

/// The sense of each driver by the rate that its law has.
fn laws<G: Space<S = f64>>(mechanism: &Mechanism<G>, [from, to]: [f64; 2]) -> Vec<f64> {
    let (mut dynamics, mut modes) = (Dynamics::without_mass(mechanism), mechanism.modes());
    let mut most = vec![[0.0_f64; 2]; mechanism.drives.len()];
    if mechanism.drives.iter().any(|drive| drive.speed.is_none()) {
        // beside even steps, at which a law that repeats itself might have one value
        for k in 0..=LOOKS {
            let part = (f64::from(k) + 0.4 * (f64::from(k) * 0.618_033_988_749_895).fract()) / f64::from(LOOKS);
            dynamics.follow_time(from + (to - from) * part.min(1.0), &mut modes);
            for (drive, [forth, back]) in mechanism.drives.iter().zip(&mut most) {
                let rate = dynamics.work.motions[drive.output + 1];
                (*forth, *back) = (forth.max(rate), back.max(-rate));
            }
        }
    }
    let law = |(drive, [forth, back]): (&crate::mechanism::Drive, [f64; 2])| match drive.speed {
        Some(speed) => sense(speed.max(0.0), (-speed).max(0.0), NO_RATE),
        None => sense(forth, back, NO_RATE),
    };
    mechanism.drives.iter().zip(most).map(law).collect()
}

/// The sense in which a joint moves from frame to frame.
fn by_frames(scene: &Scene, joint: &Joint) -> f64 {
    let slides = matches!(&*joint.kind, "slider" | "cylindrical" | "planar" | "screw" | "pin-in-slot");
    let along = |index: usize| {
        let poses = scene.frame(index);
        let (a, b) = (scene.world(poses, &joint.a), scene.world(poses, &joint.b));
        let axis = scene.direction(poses, joint.a.body, &joint.axis);
        (0..3).map(|i| axis[i] * (b[i] - a[i])).sum::<f64>()
    };
    let change = |k: usize| if slides { along(k) - along(k - 1) } else { step(scene, joint, [k - 1, k]) };
    let changes = (1..scene.frames.count()).map(change).filter(|change| change.is_finite());
    let [forth, back] = changes.fold([0.0, 0.0], |[forth, back], x| [forth + x.max(0.0), back + (-x).max(0.0)]);
    // back in its time a motion that begins at its end goes the other way
    let shown = &scene.frames.shown;
    let ahead = if shown.len() > 1 && shown[1] < shown[0] { -1.0 } else { 1.0 };
    if forth.max(back) > 1e-12 { ahead * sense(forth, back, NO_WAY) } else { 0.0 }
}

/// 1 or −1 where there is hardly anything the other way; 0 for both ways, and for neither.
fn sense(forth: f64, back: f64, none: f64) -> f64 {
    let (most, least) = (forth.max(back), forth.min(back));
    if most > 0.0 && least <= none * most { (forth - back).signum() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_both_ways_has_no_sense() {
        assert_eq!([sense(2.0, 0.0, 1e-9), sense(1e-12, 3.0, 1e-9), sense(1.0, 0.5, 1e-9), sense(0.0, 0.0, 1e-9)], [1.0, -1.0, 0.0, 0.0]);
    }
}
