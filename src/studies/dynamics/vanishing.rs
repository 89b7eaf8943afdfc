//! Inertia that vanishes on the way, as that of two thin bars about the line in which they come to lie, or of a massless crank at its dead
//! point.
//!
//! Let θ be the angle between the bars. What turns them both about their line has the inertia I θ², so that its rate is C/θ² with a C that
//! the start gives or that is round-off. In an instant that becomes the shorter the smaller C is, the bars turn by half a turn about their
//! line and θ bounces back: both stand where they would without a C, turned about their own axes. A crank becomes ever faster. Steps shrink
//! with the instant, and where the inertia is round-off they end the run, or none of them goes on. So such a run stops, and tells which
//! motion has no inertia any more.

use super::phases::Phases;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::kinematics::coordinates::coordinates;
use crate::kinematics::saddle::Saddle;
use crate::kinematics::thin::with_those_across;
use crate::model::Model;
use grashof_solvers::State;

/// Part of the least inertia at the start below which a motion counts as one without where a run cannot go on.
pub(super) const STUCK: f64 = 1e-6;
/// The same where short steps follow each other: near round-off, and earlier behind so many of them, since rows add to the noise [measured
/// on two bars that come into line within 2e-6 rad: most schemes bounce back, those that need over 131,072 short steps are stopped].
const ROUND_OFF: f64 = 1e-12;
const EARLIER: f64 = 1e-7;
const MANY: usize = 1 << 17;
/// Decades in which the least inertia at the start is looked for, in parts of that of a coordinate.
const DECADES: i32 = 15;
/// Steps of the inverse iteration for the motion.
const ITERATIONS: usize = 3;
/// Coordinates that take part in it, of the largest.
const TAKES_PART: f64 = 0.3;

/// Part of the least inertia at the start below which a motion counts as one without, where as many `short` steps follow each other.
pub(super) fn part(short: usize) -> f64 {
    if short < MANY { ROUND_OFF } else { EARLIER }
}

/// Which motion has less inertia in a state than this `part` of the least that any has at the start, in words; none where all have more.
pub(super) fn explain<G: Space<S = f64>>(model: &Model, phase: &Phases<G>, state: &State, part: f64) -> Option<String> {
    let (m, start) = (&phase.mechanism, &phase.start);
    let inertias = with_those_across(m, &start.metric);
    let mut dynamics = Dynamics::new(m);
    let row_scale = dynamics.row_scale(&start.q, &start.modes, &start.metric);
    let scale: Vec<f64> = inertias.iter().chain(&row_scale).map(|x| x.sqrt().recip()).collect();
    // signs of the pivots of M − εD, D these inertias, count the motions on the constraints that have less than ε of them
    let mut less = |t: f64, [q, v]: [&[f64]; 2], modes: &[i32], epsilon: f64| {
        dynamics.terms(t, q, v, modes);
        Saddle::of_mass(&dynamics.work.mass, inertias.iter().map(|d| -epsilon * d), &dynamics.work.g, &scale)
    };
    let mut decades = (0..=DECADES).map(|decade| 0.1_f64.powi(decade));
    let least = decades.find(|&all| less(0.0, [&start.q, &start.v], &start.modes, all).is_some_and(|found| found.below == 0))?;
    let now = less(state.t, [&state.q, &state.v], &state.modes[..m.switches + m.windings], part * least)?;
    if now.below == 0 {
        return None;
    }
    let mut motion: Vec<f64> = inertias.iter().enumerate().map(|(i, d)| d.sqrt() * (1.0 + i as f64)).collect();
    for _ in 0..ITERATIONS {
        motion = now.solve(&motion);
        let largest = motion.iter().zip(&inertias).fold(0.0, |m: f64, (x, d)| m.max(x.abs() * d.sqrt()));
        motion.iter_mut().zip(&inertias).for_each(|(x, d)| *x *= d / largest);
    }
    let share = |i: usize| motion[i].abs() / inertias[i].sqrt();
    let largest = (0..motion.len()).map(share).fold(0.0, f64::max);
    let all = coordinates(model, m);
    let takes_part = (0..motion.len()).filter(|&i| share(i) >= TAKES_PART * largest);
    let names: Vec<String> = takes_part.map(|i| format!("`{}`", all[i].name)).take(3).collect();
    let (as_of, thickness) = if G::SPIN == 3 {
        ("thin bars that come into one line, or of a massless crank", ", thin bars a `width` and a `height`")
    } else {
        ("a massless crank", "")
    };
    (!names.is_empty()).then(|| {
        format!(
            "at t = {:.6} s nothing resists a motion of {} any more: it has lost its inertia, as that of {as_of} at its dead point; give every \
             moving body a mass that counts beside the others{thickness}, or end the run before",
            state.t,
            names.join(", ")
        )
    })
}
