//! Laws of drivers and couplings that jump: what they hold would have to get from one place to the other in no time.

use super::driven::Driven;
use super::node::PathPoint;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::RowKind;
use crate::results::six_digits;

/// How far beside a place laws of drivers are looked at, as part of the whole range.
const BESIDE: f64 = 1e-7;

/// Part of its value by which a law that does not jump may differ on two sides by round-off.
const STEADY: f64 = 1e-9;

/// Halvings of a stretch on which a law changes its mode.
const HALVINGS: usize = 80;

/// What a coupling may miss by round-off, rad or sizes.
const MET: f64 = 1e-10;

/// Largest move in which a coupling is looked at, rad or sizes.
const MOVE: f64 = 1e-3;

/// A law that jumps.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// The driver or coupling, as told.
    name: String,
    /// The law of a driver on both sides, or how far off a coupling is there, SI.
    sides: [f64; 2],
    driver: bool,
}

impl Jump {
    /// How high a step of a coupling is, SI.
    pub(crate) fn height(&self) -> f64 {
        self.sides[1] - self.sides[0]
    }

    /// What is told of it; `at` is the place, as `time = 0.5`.
    pub(crate) fn told(&self, at: &str) -> String {
        let (name, [before, after]) = (&self.name, self.sides.map(six_digits));
        if self.driver {
            return format!(
                "the law of the {name} jumps at {at}, from {before} to {after} (SI): what is driven has to get from one place to the other"
            );
        }
        let off = six_digits(self.height());
        format!(
            "what the {name} holds jumps at {at}, by {off} (SI): what is coupled has to get from one place to the other; lead it up a short flank (a table with two points beside each other)"
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
        jumps.then(|| Jump { name: format!("driver `{}`", drive.name), sides: [before, after], driver: true })
    })
}

/// The law of a driver or coupling that jumps just beside a place of a driven motion over `range` (s), if one does.
pub(super) fn jump_beside<G: Space<S = f64>>(driven: &mut Driven<'_, G>, modes: &[i32], last: &PathPoint, range: f64) -> Option<Jump> {
    let mut modes = modes.to_vec();
    jump(&mut driven.dynamics, &mut modes, last.t, range).or_else(|| coupling(driven, &mut modes, last, range))
}

/// As [`jump_beside`] for couplings: what they miss on a straight way along the velocity, on which it grows with the square alone.
fn coupling<G: Space<S = f64>>(driven: &mut Driven<'_, G>, modes: &mut [i32], last: &PathPoint, range: f64) -> Option<Jump> {
    let m = driven.dynamics.mechanism;
    let beside = BESIDE * range.abs();
    let slow = (MOVE / (beside * driven.measure(&last.v))).min(1.0);
    if !slow.is_finite() {
        return None;
    }
    let [far_before, before, after, far_after] = [-2.0, -1.0, 1.0, 2.0].map(|k| {
        let dt = k * beside;
        let mut q = last.q.clone();
        m.retract(&mut q, &last.v.iter().map(|v| slow * v * dt).collect::<Vec<_>>());
        driven.dynamics.follow_time(last.t + dt, modes);
        driven.dynamics.position(&q, modes);
        driven.dynamics.follow_position(modes);
        driven.dynamics.work.phi.clone()
    });
    let unit = driven.row_unit();
    (0..m.rows.len()).filter(|&row| matches!(m.rows[row].kind, RowKind::Function(_))).find_map(|row| {
        let steady = (before[row] - far_before[row]).abs() + (far_after[row] - after[row]).abs();
        let jumps = (after[row] - before[row]).abs() > 1e3 * steady + MET / unit[row];
        jumps.then(|| Jump { name: m.name_of_row(row), sides: [before[row], after[row]], driver: false })
    })
}

/// The coupling that jumps where a driven motion goes over from `modes` to `far` ones at the position evaluated last, if one does.
pub(crate) fn across<G: Space<S = f64>>(driven: &mut Driven<'_, G>, modes: &[i32], far: &[i32]) -> Option<Jump> {
    let m = driven.dynamics.mechanism;
    let q = driven.q.clone();
    let mut beyond = modes.to_vec();
    beyond[..far.len()].copy_from_slice(far);
    let [after, before] = [&beyond[..], modes].map(|modes| {
        driven.dynamics.position(&q, modes);
        driven.dynamics.work.phi.clone()
    });
    let unit = driven.row_unit();
    let couplings = (0..m.rows.len()).filter(|&row| matches!(m.rows[row].kind, RowKind::Function(_)));
    let jumps = |row: &usize| (after[*row] - before[*row]).abs() * unit[*row] > MET;
    couplings.into_iter().find(jumps).map(|row| Jump { name: m.name_of_row(row), sides: [before[row], after[row]], driver: false })
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
            if high == from {
                break;
            }
            (now, from) = (at(dynamics, high), high);
        }
        now = end;
    }
    None
}
