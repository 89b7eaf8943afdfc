//! Laws of drivers that jump: what is driven would have to get from one place to the other in no time.

use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::results::six_digits;

/// How far beside a place laws of drivers are looked at, as part of the whole range.
const BESIDE: f64 = 1e-7;

/// Part of its value by which a law that does not jump may differ on two sides by round-off.
const STEADY: f64 = 1e-9;

/// Halvings of a stretch on which a law changes its mode.
const HALVINGS: usize = 80;

/// A law that jumps.
pub(crate) struct Jump {
    /// The driver.
    driver: String,
    /// Its law on both sides, SI.
    sides: [f64; 2],
}

impl Jump {
    /// What is told of it; `at` is the place, as `time = 0.5`.
    pub(crate) fn told(&self, at: &str) -> String {
        let [before, after] = self.sides.map(six_digits);
        format!(
            "the law of the driver `{}` jumps at {at}, from {before} to {after} (SI): what is driven has to get from one place to the other",
            self.driver
        )
    }
}

/// The law that jumps at time `t` (s) of a motion over `range` (s), if one does.
pub(crate) fn jump<G: Space<S = f64>>(dynamics: &mut Dynamics<'_, G>, modes: &mut [i32], t: f64, range: f64) -> Option<Jump> {
    let beside = BESIDE * range.abs();
    let laws = dynamics.mechanism.drives.iter().filter(|drive| drive.speed.is_none());
    laws.into_iter().find_map(|drive| {
        let [far_before, before, after, far_after] = [-2.0, -1.0, 1.0, 2.0].map(|k| {
            dynamics.follow_time(t + k * beside, modes);
            dynamics.work.motions[drive.output]
        });
        let steady = (before - far_before).abs() + (far_after - after).abs();
        let jumps = (after - before).abs() > 1e3 * steady + STEADY * before.abs().max(after.abs());
        jumps.then(|| Jump { driver: drive.name.clone(), sides: [before, after] })
    })
}

/// The first jump of a law between times that ascend (s), and a time just before it: laws jump where their modes change.
pub(crate) fn first_jump<G: Space<S = f64>>(dynamics: &mut Dynamics<'_, G>, modes: &[i32], times: &[f64]) -> Option<(f64, Jump)> {
    let range = times.last()? - times.first()?;
    if dynamics.mechanism.drives.iter().all(|drive| drive.speed.is_some()) {
        return None;
    }
    let mut modes = modes.to_vec();
    let mut at = |dynamics: &mut Dynamics<'_, G>, t: f64| {
        dynamics.follow_time(t, &mut modes);
        modes.clone()
    };
    let mut now = at(dynamics, *times.first()?);
    for ends in times.windows(2) {
        let (mut from, to) = (ends[0], ends[1]);
        let end = at(dynamics, to);
        while now != end {
            let (mut low, mut high) = (from, to);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if at(dynamics, middle) == now { low = middle } else { high = middle }
            }
            let mut beside = now.clone();
            if let Some(jump) = jump(dynamics, &mut beside, high, range) {
                return Some((low, jump));
            }
            if high <= from {
                break;
            }
            (now, from) = (at(dynamics, high), high);
        }
        now = end;
    }
    None
}
