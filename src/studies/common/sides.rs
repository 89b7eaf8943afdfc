//! States in a kink of a law, as a spring that is softer one way than the other: a linear motion about it is that of one of its sides.

use crate::geometry::Space;
use crate::kinematics::held::settled;
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::results::Finding;
use nalgebra::DMatrix;

/// How far a state is shifted, rad or sizes of the mechanism, and 1/s of these: farther than a state at rest is off.
const SHIFT: f64 = 1e-8;
/// Part of a stiffness or damping by which two sides have the same.
const SAME: f64 = 1e-6;

/// Weights of `n` motions in no special relation to each other, none of which is small: all of one sign, and by turns.
#[must_use]
pub(crate) fn weights(n: usize) -> [Vec<f64>; 2] {
    let weight = |i: usize| 1.0 + 0.5 * (2.39 * (i + 1) as f64).sin();
    [(0..n).map(weight).collect(), (0..n).map(|i| if i % 2 == 0 { weight(i) } else { -weight(i) }).collect()]
}

/// The modes of the switches (each set once) a little beside a state (q: nq, v: nv, z: nz) at time 0, along motions (nv each) and rates,
/// where they are others than `modes`.
pub(crate) fn beside<G>(mechanism: &Mechanism<G>, [q, v, z]: [&[f64]; 3], modes: &[i32], motions: &[Vec<f64>]) -> Vec<Vec<i32>>
where
    G: Space<S = f64>,
{
    let mut found: Vec<Vec<i32>> = Vec::new();
    if mechanism.programs().iter().all(|staged| staged.program.switches().is_empty()) {
        return found;
    }
    let unit = mechanism.units(mechanism.size());
    for motion in motions {
        let most = motion.iter().zip(&unit).fold(0.0, |m, (x, u): (&f64, &f64)| f64::max(m, x.abs() / u));
        for shift in [SHIFT / most, -SHIFT / most] {
            let shifted: Vec<f64> = motion.iter().map(|x| shift * x).collect();
            let mut there = q.to_vec();
            mechanism.retract(&mut there, &shifted);
            let moving: Vec<f64> = v.iter().zip(&shifted).map(|(v, x)| v + x).collect();
            for state in [[&there, v, z], [q, &moving, z]] {
                let other = settled(mechanism, state, modes);
                if other != modes && !found.contains(&other) {
                    found.push(other);
                }
            }
        }
    }
    found
}

/// The largest change between two matrices of one kind, as part of their size.
#[must_use]
pub(crate) fn change([here, there]: [&DMatrix<f64>; 2]) -> f64 {
    let size = f64::max(here.amax(), there.amax());
    if size > 0.0 { (here - there).amax() / size } else { 0.0 }
}

/// What two sides of a state differ by, as parts of its size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Difference {
    /// Of forces: a law jumps.
    pub(crate) force: f64,
    /// Of stiffness or damping.
    pub(crate) slope: f64,
}

/// That laws change between two sides of a state, if they differ by more than round-off.
pub(crate) fn one_sided(model: &Model, [here, there]: [&[i32]; 2], differ: Difference, place: &str) -> Option<Finding> {
    let [jumps, bends] = [differ.force, differ.slope].map(|part| part > SAME);
    let changed = model.pool.switches().iter().zip(here.iter().zip(there)).filter(|(_, (here, there))| here != there);
    let mut names: Vec<String> = changed.map(|(switch, _)| switch.told()).collect();
    names.dedup();
    let names = names.join(", ");
    let message = match (jumps, bends) {
        (true, _) => format!(
            "forces jump in this state, by {:.2} % of their size, as {names} changes: what is told holds on one side of it. Take a state a little beside, by an exact `start`",
            100.0 * differ.force
        ),
        (_, true) => format!(
            "the state is in a kink, where {names} changes: what is told holds on one side of it; on the other one stiffness or damping differs by {:.2} % of its size. That of each side is found a little beside, by an exact `start`",
            100.0 * differ.slope
        ),
        _ => return None,
    };
    Some(Finding { code: "one-sided".into(), message, path: place.into() })
}
