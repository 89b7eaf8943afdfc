//! The pose of the start as one that is held.

use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::held::settled;
use crate::mechanism::Mechanism;
use crate::studies::statics::Still;

/// The start as it would stand if it were held, with the modes that its forces have there.
pub(super) fn held_start<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Still {
    let z = mechanism.state_starts.clone();
    let modes = settled(mechanism, [&start.q, &vec![0.0; mechanism.nv], &z], &start.modes);
    Still { q: start.q.clone(), z, modes, findings: start.not_as_meant().collect() }
}
