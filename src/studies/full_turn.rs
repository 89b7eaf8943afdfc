//! Whether a linkage lets its driver turn fully, which a range of less than a turn does not show.

use super::common::case::Case;
use super::common::clock::Clock;
use super::common::motion::Motion;
use super::common::observe::Observer;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::mechanism::Mechanism;
use std::f64::consts::TAU;

/// Part of a turn that rounding may take.
const ROUNDING: f64 = 1e-9;

/// 1 if the one driver turns fully, 0 if a dead point keeps it from that; not a number where nothing turns, or where the driver's law
/// does not lead so far. `covered`: the range of the clock was.
pub(super) fn turns_fully<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    start: &Assembled,
    clock: Clock,
    covered: bool,
) -> f64 {
    let [drive] = &mechanism.drives[..] else { return f64::NAN };
    if !drive.turns {
        return f64::NAN;
    }
    if !covered {
        return 0.0;
    }
    let mut dynamics = Dynamics::new(mechanism);
    let mut modes = start.modes.clone();
    let mut law = |t: f64| {
        dynamics.follow_time(t, &mut modes);
        dynamics.work.motions[drive.output]
    };
    if (law(clock.end()) - law(0.0)).abs() >= TAU * (1.0 - ROUNDING) {
        return 1.0;
    }
    let turn = TAU.copysign(clock.end());
    let Ok(whole) = Clock::of_driver(&mut dynamics, &mut modes, drive, 0.0, turn) else { return f64::NAN };
    let observer = Observer::new(case.model, mechanism, case.parameters, &[]);
    match Motion::trace(mechanism, start, whole, observer, 0) {
        Ok(motion) if motion.path.gap.is_some() || motion.path.jump.is_some() => f64::NAN,
        Ok(motion) => f64::from(motion.path.dead == [None, None]),
        Err(_) => f64::NAN,
    }
}
