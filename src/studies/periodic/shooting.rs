//! Newton's method on the map of a period (Poincaré's map where the period ends on a surface).
//!
//! With x the independent coordinates, velocities and states at the start of a period, F(x) those at its end, angles modulo a turn,
//! and DF by [`Lap::map`], a step solves (DF − I) δ = x − F(x); on a surface g = const only along it, δ = B y with ∇g·B = 0:
//!
//! ```text
//! (Bᵀ DF B − I) y = Bᵀ(x − F(x)).
//! ```
//!
//! Where no force takes or gives energy, the energy E is the same at both ends: ∇E (DF − I) = 0 at a periodic motion, which is one of
//! a family then (Meyer, Hall & Offin, Introduction to Hamiltonian Dynamical Systems, 2nd ed., section 9.1). The matrix is singular;
//! the shortest of the steps that it leaves is taken, which keeps to the motion of the family that the search began with.
//!
//! The start itself is moved along the motion to where g has its value at the start of the study; the motion stays the same by that.
//! The eigenvalues of DF, or of Bᵀ DF B, are Floquet's multipliers; on a surface the trivial one, along the motion, is not among
//! them (Parker & Chua, Practical Numerical Algorithms for Chaotic Systems, 1989, chapter 5).

use super::lap::{Broken, Lap, Search, tools};
use super::monodromy::{Map, Surface};
use super::rough::Rough;
use super::saltation::rate;
use super::states::{ROUGHNESS, Scale, between, beyond, largest};
use super::timed::timed;
use crate::geometry::Space;
use crate::numerics::eigenvalues::eigenvalues;
use crate::studies::dynamics::phases::Phases;
use grashof_solvers::svd::Svd;
use grashof_solvers::{Span, State, System};
use nalgebra::{Complex, DMatrix, DVector};

/// Most steps.
const MOST: usize = 40;

/// A step below this, in sizes of the motion, is the last one.
const CLOSED: f64 = 1e-11;

/// A step below this counts as the last one where round-off lets no smaller one be.
const NEARLY: f64 = 1e-7;

/// Halvings of a step.
const HALVINGS: usize = 6;

/// Singular values of DF − I below this part of the largest belong to neighbours that are periodic, too.
const NEUTRAL: f64 = 1e-8;

/// In tolerances, how far the ends of a periodic motion may be apart in directions that no step changes, in sizes of the motion.
const OPEN: f64 = 1e3;

/// A periodic motion.
pub(super) struct Orbit<'e, G: Space<S = f64>> {
    /// Its last period.
    pub(super) lap: Lap<'e, G>,
    /// Multipliers, the largest first.
    pub(super) multipliers: Vec<Complex<f64>>,
    /// Directions in which neighbours are periodic, too.
    pub(super) neutral: usize,
    /// Largest difference of the two ends, in sizes of the motion: of the independent coordinates, and of all those in which an
    /// integration can tell it from none.
    pub(super) closure: [f64; 2],
    /// Steps of Newton's method.
    pub(super) steps: usize,
}

/// Why there is no periodic motion.
pub(super) enum Lost {
    /// A period did not come to its end.
    Broken(Broken),
    /// The map has no derivative.
    Rough(Rough),
    /// Newton's method has stopped with this difference of the two ends, in sizes of the motion.
    Apart(f64),
    /// Nothing moves.
    Rests,
}

/// A step of Newton's method.
struct Step {
    /// In sizes of the motion.
    way: DVector<f64>,
    multipliers: Vec<Complex<f64>>,
    /// Directions in which neighbours are periodic, too, which it leaves alone.
    neutral: usize,
}

/// The periodic motion near a state.
pub(super) fn shoot<'e, G: Space<S = f64>>(search: &mut Search<'_>, phases: &'e Phases<G>, guess: &State) -> Result<Orbit<'e, G>, Lost> {
    let tolerance = search.tolerance;
    let mut lap = search.lap(phases, guess, tolerance).map_err(Lost::Broken)?;
    let mut last = f64::INFINITY;
    for steps in 0..MOST {
        let scale = Scale::of(&mut lap);
        if scale.rests() && !timed(&search.model, &phases.mechanism) {
            return Err(Lost::Rests);
        }
        let map = lap.map(search, phases).map_err(Lost::Rough)?;
        let (sizes, reach) = (scale.on(&map.independent), scale.reach(&map.independent, tolerance));
        let missed = miss(phases, &map, &lap);
        let apart = largest(&missed, &sizes);
        let closed = beyond(&missed, &sizes, &reach) == 0.0;
        let Step { way, multipliers, neutral } =
            step(&map, &missed, [&sizes, &scale.of_neighbours(&map.independent)], ROUGHNESS * tolerance).ok_or(Lost::Apart(apart))?;
        let size = way.amax();
        let late = map.surface.as_ref().map_or(0.0, |s| (search.begin - s.value) / s.pace);
        let size = size.max(late.abs() / lap.period());
        if size <= CLOSED || ((size <= NEARLY || closed) && size > 0.25 * last) {
            if neutral > 0 && apart > OPEN * tolerance && !closed {
                return Err(Lost::Apart(apart));
            }
            let all: Vec<usize> = (0..phases.mechanism.nv).collect();
            let every = between(&phases.mechanism, &all, [&lap.start.state, &lap.end.state]);
            let whole = beyond(&every, &scale.on(&all), &scale.reach(&all, tolerance));
            return Ok(Orbit { lap, multipliers, neutral, closure: [apart, whole], steps });
        }
        last = size;
        lap = advance(search, phases, lap, &map, &way, &Ends { sizes, reach, apart })?;
    }
    Err(Lost::Apart(last))
}

/// How far the ends of a lap are apart, and what that is judged by.
struct Ends {
    sizes: Vec<f64>,
    reach: Vec<f64>,
    /// In sizes of the motion.
    apart: f64,
}

/// Ends of a lap: F(x) − x.
fn miss<G: Space<S = f64>>(phases: &Phases<G>, map: &Map, lap: &Lap<'_, G>) -> Vec<f64> {
    between(&phases.mechanism, &map.independent, [&lap.start.state, &lap.end.state])
}

/// The lap from where a step leads to, halved until the ends come nearer.
fn advance<'e, G: Space<S = f64>>(
    search: &mut Search<'_>,
    phases: &'e Phases<G>,
    mut lap: Lap<'e, G>,
    map: &Map,
    y: &DVector<f64>,
    ends: &Ends,
) -> Result<Lap<'e, G>, Lost> {
    let late = map.surface.as_ref().map_or(0.0, |s| (search.begin - s.value) / s.pace);
    let along = rate(&lap.start) * late;
    let mut part = 1.0;
    let Ends { sizes, reach, apart } = ends;
    let mut why = Lost::Apart(*apart);
    for _ in 0..HALVINGS {
        let delta = DVector::from_iterator(y.len(), y.iter().zip(sizes).map(|(y, s)| part * y * s));
        let from = moved(&mut lap, &(&map.basis * delta + &along));
        let next =
            from.map_or(Err(Broken::Stopped("the loops cannot be closed".into())), |from| search.lap(phases, &from, search.tolerance));
        match next {
            Ok(next) => {
                let missed = miss(phases, map, &next);
                let left = largest(&missed, sizes);
                if left <= (1.0 - 0.25 * part) * apart || y.amax() * part <= NEARLY || beyond(&missed, sizes, reach) == 0.0 {
                    return Ok(next);
                }
                why = Lost::Apart(left);
            }
            Err(broken) => why = Lost::Broken(broken),
        }
        part *= 0.5;
    }
    Err(why)
}

/// The start of a lap moved by (δq, δv, δz) and set on the constraints.
fn moved<G: Space<S = f64>>(lap: &mut Lap<'_, G>, delta: &DVector<f64>) -> Option<State> {
    let mut node = lap.start.clone();
    let phase = tools(&mut lap.trajectory);
    let nv = node.state.v.len();
    let delta = delta.as_slice();
    phase.system.retract(Span::at(node.state.t), &mut node.state.q, &delta[..nv]);
    node.state.v.iter_mut().zip(&delta[nv..]).for_each(|(v, d)| *v += d);
    node.state.z.iter_mut().zip(&delta[2 * nv..]).for_each(|(z, d)| *z += d);
    phase.engine.settle(&mut phase.system, &mut node).ok()?;
    Some(node.state)
}

/// Newton's step in sizes of the motion, found in `sizes` of its neighbours; singular values below `zero` count as 0.
fn step(map: &Map, missed: &[f64], [of_motion, sizes]: [&[f64]; 2], zero: f64) -> Option<Step> {
    let m = sizes.len();
    let derivative = DMatrix::from_fn(m, m, |i, j| map.derivative[(i, j)] * sizes[j] / sizes[i]);
    if m == 0 || derivative.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let surface = match &map.surface {
        Some(Surface { normal, .. }) => complement(&DVector::from_fn(m, |i, _| normal[i] * sizes[i])),
        None => DMatrix::identity(m, m),
    };
    let along = surface.transpose() * derivative * &surface;
    let k = along.nrows();
    let right = -surface.transpose() * DVector::from_fn(m, |i, _| missed[i] / sizes[i]);
    if k == 0 {
        return Some(Step { way: DVector::zeros(m), multipliers: Vec::new(), neutral: 0 });
    }
    let mut multipliers: Vec<Complex<f64>> = eigenvalues(&along)?;
    multipliers.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(a.im.total_cmp(&b.im)));
    let svd = Svd::new(&(along - DMatrix::identity(k, k)));
    let least = zero.max(NEUTRAL * svd.largest());
    let y = svd.solve(right.as_slice(), |s| if s > least { 1.0 / s } else { 0.0 });
    let neutral = svd.values.iter().filter(|s| **s <= least).count();
    let mut way = surface * DVector::from_vec(y);
    way.iter_mut().zip(sizes.iter().zip(of_motion)).for_each(|(way, (size, of_motion))| *way *= size / of_motion);
    Some(Step { way, multipliers, neutral })
}

/// Orthonormal columns across a vector (m × m − 1), by Householder's reflection of it to its largest entry's axis.
fn complement(normal: &DVector<f64>) -> DMatrix<f64> {
    let m = normal.len();
    let k = normal.icamax();
    let mut u = normal.normalize();
    u[k] += u[k].signum();
    let reflection = DMatrix::identity(m, m) - &u * u.transpose() * (2.0 / u.norm_squared());
    reflection.remove_column(k)
}
