//! A start on some coordinates, and the anchors of rows that follow from it.

use super::branch::ChangePoint;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::Mechanism;

/// Coordinates, velocities and modes of a start.
pub(super) struct Begun {
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) modes: Vec<i32>,
    pub(super) change: Option<ChangePoint>,
    /// Bodies that nobody has turned and that stand far from how they are drawn, with the angle, rad.
    pub(super) turned: Vec<(usize, f64)>,
}

/// Anchors of drivers, gears, racks and distances without a length, from the found position.
pub(super) fn anchor<G: Space<S = f64>>(mechanism: &mut Mechanism<G>, q: &[f64], modes: &[i32]) {
    let mut dynamics = Dynamics::without_mass(mechanism);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    let offsets: Vec<f64> =
        mechanism.rows.iter().zip(&dynamics.work.phi).map(|(row, phi)| if row.anchored { row.offset + phi } else { row.offset }).collect();
    for (row, offset) in mechanism.rows.iter_mut().zip(offsets) {
        row.offset = offset;
    }
}
