//! A motion that becomes faster without end, as that of a motor without a load: its steps become shorter until they end the run, which
//! looks like a fault of the integrator and is none.

use super::phases::Phases;
use crate::geometry::Space;
use crate::kinematics::coordinates::coordinates;
use crate::mechanism::Step;
use crate::model::Model;
use grashof_solvers::{Halt, State, Why};
use std::f64::consts::TAU;

/// Turns, and sizes of the mechanism, beyond which a coordinate has gone far.
const FAR: [f64; 2] = [30.0, 1e3];

/// Part of the present speed below which the mean speed since the start shows that the motion becomes faster; half of it where the
/// acceleration is constant.
const FASTER: f64 = 0.8;

/// Ratio up to which two coordinates have gone as far.
const ALIKE: f64 = 1.1;

/// The coordinate that has gone farthest and become ever faster since the start, in words; none in a motion that does not.
pub(super) fn faster<G: Space<S = f64>>(model: &Model, phase: &Phases<G>, state: &State) -> Option<String> {
    let (m, start) = (&phase.mechanism, &phase.start);
    let gone = |q: usize| state.q[q] - start.q[q];
    let far = m.steps.iter().filter_map(|step| match *step {
        Step::Axis { turns, slides, q, v, .. } => {
            let far = if turns && !slides { FAR[0] * TAU } else { FAR[1] * start.size };
            let (gone, speed) = (gone(q), state.v[v]);
            let faster = speed * gone > 0.0 && gone.abs() < FASTER * speed.abs() * state.t;
            (faster && gone.abs() > far).then_some((gone.abs() / far, v, turns && !slides))
        }
        Step::Ball { .. } => None,
    });
    // of those that go as far the first one is that of the joint nearer to the ground
    let (_, v, turns) = far.reduce(|most, next| if next.0 > ALIKE * most.0 { next } else { most })?;
    let name = coordinates(model, m).into_iter().nth(v)?.name;
    let (verb, unit) = if turns { ("turns", "rad/s") } else { ("moves", "m/s") };
    Some(format!("`{name}` {verb} with {:.2e} {unit} and has become faster all the time", state.v[v].abs()))
}

/// Why a run ends in which something becomes faster without end; none if the reason is another.
pub(super) fn explain(faster: &str, halt: &Halt) -> Option<String> {
    let what = match halt.why {
        Why::Error(_) | Why::StepSize | Why::Newton => format!("the steps have shrunk to {:.1e} s", halt.h),
        Why::NotFinite(_) => "its numbers have no bound any more".to_owned(),
        Why::TooManySteps => "more steps were taken than are allowed".to_owned(),
        _ => return None,
    };
    Some(format!("at t = {:.6} s {faster}, so that {what}: {HOLD}", halt.t))
}

/// What to do with such a motion.
pub(super) const HOLD: &str = "what drives it goes on without a load that grows with the speed; give it one (a load, `damping`, a motor whose torque falls), or end the run sooner (`until`)";
