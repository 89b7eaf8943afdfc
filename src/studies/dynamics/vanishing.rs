//! Inertia that vanishes on the way, as that of two thin bars about the line in which they come to lie, or of a massless crank at its dead
//! point.
//!
//! Let θ be the angle between the bars. What turns them both about their line has the inertia I θ², so that its rate is C/θ² with a small C
//! that is round-off, and its acceleration −2θ̇C/θ³: steps shrink with θ, and where θ² comes near to round-off they end the run, or none of
//! them goes on. A model says nothing of such an instant, so the run stops and tells which motion it is.

use super::phases::Phases;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::kinematics::coordinates::coordinates;
use crate::kinematics::saddle::Saddle;
use crate::kinematics::thin::with_those_across;
use crate::model::Model;
use grashof_solvers::State;

/// Part of the inertia of a coordinate at the start, or of a thin body across its axis, below which a motion has none.
const NONE: f64 = 1e-9;
/// Steps of the inverse iteration for the motion.
const ITERATIONS: usize = 3;
/// Coordinates that take part in it, of the largest.
const PART: f64 = 0.3;

/// Which motion has less inertia in a state than at the start, so little that it counts as none, in words; none where all of them have some.
pub(super) fn explain<G: Space<S = f64>>(model: &Model, phase: &Phases<G>, state: &State) -> Option<String> {
    let (m, start) = (&phase.mechanism, &phase.start);
    let inertias = with_those_across(m, &start.metric);
    let mut dynamics = Dynamics::new(m);
    let row_scale = dynamics.row_scale(&start.q, &start.modes, &start.metric);
    let scale: Vec<f64> = inertias.iter().chain(&row_scale).map(|x| x.sqrt().recip()).collect();
    // signs of the pivots of M − εD, D these inertias, count the motions on the constraints that have less than ε of them
    let mut free = |t: f64, [q, v]: [&[f64]; 2], modes: &[i32]| {
        dynamics.terms(t, q, v, modes);
        let work = &dynamics.work;
        let mass = work.mass.lines().enumerate().flat_map(|(i, line)| line.entries().map(move |(j, x)| (i, j, x)).collect::<Vec<_>>());
        let less = inertias.iter().enumerate().map(|(i, d)| (i, i, -NONE * d));
        Saddle::new(mass.chain(less), &work.g, &scale)
    };
    let before = free(0.0, [&start.q, &start.v], &start.modes)?.below;
    let now = free(state.t, [&state.q, &state.v], &state.modes[..m.switches + m.windings])?;
    if now.below <= before {
        return None;
    }
    let mut motion: Vec<f64> = inertias.iter().enumerate().map(|(i, d)| d.sqrt() * (1.0 + i as f64)).collect();
    for _ in 0..ITERATIONS {
        motion = now.solve(&motion);
        let largest = motion.iter().zip(&inertias).fold(0.0, |m: f64, (x, d)| m.max(x.abs() * d.sqrt()));
        motion.iter_mut().zip(&inertias).for_each(|(x, d)| *x *= d / largest);
    }
    let part = |i: usize| motion[i].abs() / inertias[i].sqrt();
    let largest = (0..motion.len()).map(part).fold(0.0, f64::max);
    let all = coordinates(model, m);
    let names: Vec<String> =
        (0..motion.len()).filter(|&i| part(i) >= PART * largest).map(|i| format!("`{}`", all[i].name)).take(3).collect();
    (!names.is_empty()).then(|| {
        format!(
            "at t = {:.6} s a motion of {} has lost its inertia: a massless body comes to a dead point there, or thin bars into one line, about \
             which nothing resists that they turn; give every moving body a mass, and bars of space a `width` and a `height`, or end the run \
             before",
            state.t,
            names.join(", ")
        )
    })
}
