//! Differences of states: angles modulo a turn, rotations as vectors; sizes to judge them by.

use super::lap::Lap;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step};
use grashof_solvers::State;
use std::f64::consts::TAU;

/// Places of a period at which its size is looked at.
const LOOKS: usize = 48;

/// Part of the size of the mechanism below which a motion counts as none.
const STILL: f64 = 1e-6;

/// Part of it below which it is none.
const AT_REST: f64 = 1e-9;

/// Part of the largest motion as which any counts where neighbours are compared.
const AT_LEAST: f64 = 0.1;

/// In tolerances of the integration, what the end of a period, or a singular value of its map that is zero, may be wrong by: up to
/// one of them was seen.
pub(super) const ROUGHNESS: f64 = 30.0;

/// δ (nv) with `to` = `from` ⊕ δ; angles about a fixed axis modulo a turn, rotations as vectors, rad, in the frame of v.
pub(super) fn difference<G: Space>(mechanism: &Mechanism<G>, from: &[f64], to: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; mechanism.nv];
    for step in &mechanism.steps {
        match *step {
            Step::Axis { turns, slides, q, v, .. } => {
                let way = to[q] - from[q];
                out[v] = if turns && !slides { way - TAU * (way / TAU).round() } else { way };
            }
            Step::Ball { q, v, .. } => {
                let (a, b) = (&from[q..q + 4], &to[q..q + 4]);
                // a* ∘ b
                let w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
                let x = [
                    a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
                    a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3],
                    a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1],
                ];
                let sine = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
                // q and −q are one rotation; near 0 the vector is twice that of the quaternion
                let factor = if sine > 1e-150 { 2.0 * (sine / w).atan() / sine } else { 2.0 / w };
                (0..3).for_each(|i| out[v + i] = factor * x[i]);
            }
        }
    }
    out
}

/// Moves the angles and counts of half turns of a state back by so many times what they have advanced by from one state to another.
pub(super) fn unwind<G: Space>(mechanism: &Mechanism<G>, [from, to]: [&State; 2], times: usize, state: &mut State) {
    for step in &mechanism.steps {
        if let Step::Axis { turns: true, slides: false, q, .. } = *step {
            state.q[q] -= TAU * ((to.q[q] - from.q[q]) / TAU).round() * times as f64;
        }
    }
    for k in mechanism.switches..mechanism.switches + mechanism.windings {
        state.modes[k] -= (to.modes[k] - from.modes[k]) * times as i32;
    }
}

/// How far coordinates move, and how fast, in a period: what differences are small against.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    /// What the integrator counts errors of q, v and z in.
    units: [Vec<f64>; 3],
    /// q, v and z of a motion as large as the mechanism.
    whole: [Vec<f64>; 3],
    /// The largest motion of all, in parts of the size of the mechanism.
    moves: f64,
}

impl Scale {
    /// Of a lap.
    pub(super) fn of<G: Space<S = f64>>(lap: &mut Lap<'_, G>) -> Self {
        let (breaks, period) = (lap.trajectory.breaks(), lap.period());
        let engine = &super::lap::tools(&mut lap.trajectory).engine;
        let (size, size_z) = (engine.size_v.clone(), engine.size_z.clone());
        let floor = |x: &f64| STILL * x;
        let mut scale = Self {
            q: size.iter().map(floor).collect(),
            v: size.iter().map(|x| floor(x) * TAU / period).collect(),
            z: lap.start.state.z.iter().map(|z| STILL * (1.0 + z.abs())).collect(),
            units: [size.clone(), Vec::new(), Vec::new()],
            whole: [Vec::new(), Vec::new(), Vec::new()],
            moves: 0.0,
        };
        scale.whole = [&scale.q, &scale.v, &scale.z].map(|floor| floor.iter().map(|x| x / STILL).collect());
        let floors = [scale.q.clone(), scale.v.clone(), scale.z.clone()];
        for i in 0..=LOOKS {
            let t = lap.start.state.t + period * i as f64 / LOOKS as f64;
            let piece = breaks.partition_point(|b| *b <= t).clamp(1, breaks.len() - 1) - 1;
            if lap.trajectory.go(t, piece).is_err() {
                continue;
            }
            let state = &lap.trajectory.node.state;
            let way = difference(lap.trajectory.phases[0].system.dynamics.mechanism, &lap.start.state.q, &state.q);
            let from = lap.start.state.z.clone();
            let change: Vec<f64> = state.z.iter().zip(&from).map(|(z, start)| z - start).collect();
            let grow = |to: &mut [f64], from: &[f64]| to.iter_mut().zip(from).for_each(|(s, x)| *s = s.max(x.abs()));
            for ((to, from), floor) in [&mut scale.q, &mut scale.v, &mut scale.z].into_iter().zip([&way, &state.v, &change]).zip(&floors) {
                grow(to, from);
                scale.moves = scale.moves.max(STILL * largest(from, floor));
            }
        }
        scale.units[1] = size.iter().zip(&scale.v).map(|(size, v)| size + v).collect();
        scale.units[2] = size_z.iter().zip(&lap.start.state.z).zip(&scale.z).map(|((size, z), change)| size + z.abs() + change).collect();
        scale
    }

    /// Whether nothing moves but by round-off.
    pub(super) fn rests(&self) -> bool {
        self.moves <= AT_REST
    }

    /// Sizes of (δq, δv, δz) with q and v of the velocities `independent`.
    pub(super) fn on(&self, independent: &[usize]) -> Vec<f64> {
        chosen(independent, [&self.q, &self.v, &self.z])
    }

    /// The sizes in which neighbours of a motion are compared: a coordinate that stands still while others move has neighbours that
    /// move as the others do, so that each counts as at least a part of the largest motion.
    pub(super) fn of_neighbours(&self, independent: &[usize]) -> Vec<f64> {
        let (sizes, [q, v, z]) = (self.on(independent), &self.whole);
        let whole = chosen(independent, [q, v, z]);
        let most = sizes.iter().zip(&whole).fold(0.0, |m, (size, whole)| f64::max(m, size / whole));
        sizes.iter().zip(&whole).map(|(size, whole)| size.max(AT_LEAST * most * whole)).collect()
    }

    /// What an integration at a tolerance leaves undecided of (δq, δv, δz), q and v of the velocities `independent`: a coordinate
    /// that stands still is known no better than by the integrator's own size of it.
    pub(super) fn reach(&self, independent: &[usize], tolerance: f64) -> Vec<f64> {
        let [q, v, z] = &self.units;
        chosen(independent, [q, v, z]).iter().map(|unit| ROUGHNESS * tolerance * unit).collect()
    }
}

/// Numbers of q and v of the velocities `independent`, and all of z.
fn chosen(independent: &[usize], [q, v, z]: [&[f64]; 3]) -> Vec<f64> {
    let of = |x: &[f64]| independent.iter().map(|&i| x[i]).collect::<Vec<_>>();
    [of(q), of(v), z.to_vec()].concat()
}

/// (δq, δv, δz) from one state to another, q and v of the velocities `independent`.
pub(super) fn between<G: Space>(mechanism: &Mechanism<G>, independent: &[usize], [from, to]: [&State; 2]) -> Vec<f64> {
    let way = difference(mechanism, &from.q, &to.q);
    let q = independent.iter().map(|&i| way[i]);
    let v = independent.iter().map(|&i| to.v[i] - from.v[i]);
    q.chain(v).chain(to.z.iter().zip(&from.z).map(|(a, b)| a - b)).collect()
}

/// The largest of some differences in parts of their sizes.
pub(super) fn largest(differences: &[f64], sizes: &[f64]) -> f64 {
    differences.iter().zip(sizes).fold(0.0, |m, (d, s)| if d.is_nan() { f64::INFINITY } else { m.max(d.abs() / s) })
}

/// As [`largest`], of those differences alone that an integration can tell from none.
pub(super) fn beyond(differences: &[f64], sizes: &[f64], reach: &[f64]) -> f64 {
    let seen: Vec<f64> = differences.iter().zip(reach).map(|(d, r)| if d.abs() <= *r { 0.0 } else { *d }).collect();
    largest(&seen, sizes)
}
