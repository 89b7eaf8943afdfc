//! The continuous solution over a step.
//!
//! Hermite's interpolant of the ends, whose velocities are a cubic and the quartic θ²(1 − θ)² that an acceleration inside asks for, is as
//! accurate as the nodes, but it leans on the accelerations of the KKT system, and stiff forces turn an error δ of q into K δ of them. The
//! collocation polynomial, the cubic through y₀ and the stages, has only order three, yet no rate in it. The first is taken unless
//!
//! - it departs from the second by more than the error of the step can explain (measured on a spring of 1e10 N/m at 1e-6: 0.4 m/s, where
//!   the nodes are good to 4e-8);
//! - or, in velocities and states, its own cubic is nearer to the second than it is itself. Both are wrong by multiples of h⁴v⁗/24, by
//!   θ²(1 − θ)² and θ(1 − θ)²(θ − 0.4), in the middle of the step 0.0625 and 0.0125, so that without stiff forces the cubics are four times
//!   farther from each other than the second is from the quartic, except where v⁗ passes zero and all of them are good. What stiff forces
//!   make of round-off is a quartic that is smaller than the error which is allowed, but moves events in zones that are as narrow (measured
//!   on 60 blocks on a belt with friction by a load, with stick speeds from 1e-7 to 1e-4 m/s at 1e-9 to 1e-5: positions wrong by up to 1e5
//!   tolerances, and by up to 0.4 with this rule, in 13 per cent fewer evaluations; the balance of energy was wrong, and told so, in 55 of
//!   them, and is in none). The position keeps its quintic, which has more digits (measured on a mass and a spring at 1e-10: 9e-12, and
//!   2e-10 by the collocation polynomial).

use super::stages::Stage;
use super::tableau::NODES;
use crate::dense_output::Dense;
use crate::engine::{Engine, Node};
use crate::{Dims, State};

/// Departure that the error of an accepted step explains, in units of that error; and for given steps, in parts of the change of
/// the velocities that is not uniform.
const DEPARTURE: f64 = 2.0;
const DEPARTURE_FIXED: f64 = 0.1;

/// Powers of Hermite's interpolant.
const HERMITE: usize = 6;

/// Scratch of the comparison.
#[derive(Clone, Debug)]
pub(super) struct Continuous {
    middle: State,
    zeros: State,
}

/// The cubic's values at the nodes 0, c₁, c₂, 1.
type Values<'a> = [&'a State; 4];

impl Continuous {
    /// Room for a system.
    pub(super) fn new(dims: Dims) -> Self {
        Self { middle: State::new(dims), zeros: State::new(dims) }
    }

    /// Replaces the interpolant in `out` by the collocation polynomial where the forces are too stiff for it; `allowed` is the
    /// norm of the largest error of an accepted step.
    pub(super) fn choose(&mut self, engine: &Engine, [from, to]: [&Node; 2], stages: &[Stage; 3], allowed: f64, out: &mut Dense) {
        let h = out.h;
        let values = [&from.state, &stages[0].state, &stages[1].state, &to.state];
        out.evaluate(from.state.t + 0.5 * h, &mut self.middle);
        let middle = &mut self.middle;
        for (j, row) in basis().iter().enumerate() {
            let weight = row.iter().rev().fold(0.0, |sum, c| 0.5 * sum + c);
            for (x, y) in [(&mut middle.q, &values[j].q), (&mut middle.v, &values[j].v), (&mut middle.z, &values[j].z)] {
                x.iter_mut().zip(y).for_each(|(x, y)| *x -= weight * y);
            }
        }
        let departure = engine.norm(&from.state, &middle.q, &middle.v, &middle.z);
        let bends = self.bends(engine, &from.state, out);
        let allowed = if engine.is_fixed() {
            let bend = &mut self.middle.v;
            bend.iter_mut().enumerate().for_each(|(i, x)| *x = h * (stages[2].a[i] - stages[0].a[i]));
            DEPARTURE_FIXED * engine.norm(&from.state, &self.zeros.q, bend, &self.zeros.z)
        } else {
            DEPARTURE * allowed
        };
        if departure > allowed {
            cubic(values, out);
        } else if bends {
            velocities(values, out);
        }
    }

    /// Whether the cubic of the interpolant in `out`, without its quartic, is nearer to the collocation polynomial than the interpolant is.
    /// `middle` holds the difference of the two in the middle of the step, and then that of the cubic.
    fn bends(&mut self, engine: &Engine, from: &State, out: &mut Dense) -> bool {
        let State { v, z, .. } = &mut self.middle;
        let with = engine.norm(from, &self.zeros.q, v, z);
        let (_, of_v, of_z) = out.power_mut(4);
        v.iter_mut().zip(of_v).chain(z.iter_mut().zip(of_z)).for_each(|(x, quartic)| *x -= *quartic / 16.0);
        engine.norm(from, &self.zeros.q, v, z) < with
    }
}

/// Writes the cubic through the values.
fn cubic(values: Values<'_>, out: &mut Dense) {
    let (t, h) = (out.t, out.h);
    out.begin(t, h, 4);
    for (value, row) in values.into_iter().zip(basis()) {
        for (power, c) in row.into_iter().enumerate() {
            let (q, v, z) = out.power_mut(power);
            for (x, y) in [(q, &value.q), (v, &value.v), (z, &value.z)] {
                x.iter_mut().zip(y).for_each(|(x, y)| *x += c * y);
            }
        }
    }
}

/// Writes the cubic through the values for v and z alone.
fn velocities(values: Values<'_>, out: &mut Dense) {
    let rows = basis();
    for power in 0..HERMITE {
        let c = rows.map(|row| row.get(power).copied().unwrap_or(0.0));
        let (_, v, z) = out.power_mut(power);
        v.iter_mut().enumerate().for_each(|(i, x)| *x = c.iter().zip(values).map(|(c, value)| c * value.v[i]).sum());
        z.iter_mut().enumerate().for_each(|(i, x)| *x = c.iter().zip(values).map(|(c, value)| c * value.z[i]).sum());
    }
}

/// Coefficients, by power, of Lagrange's polynomials of the nodes 0, c₁, c₂, 1.
fn basis() -> [[f64; 4]; 4] {
    let nodes = [0.0, NODES[0], NODES[1], NODES[2]];
    [0, 1, 2, 3].map(|j| {
        let mut row = [1.0, 0.0, 0.0, 0.0];
        for node in (0..4).filter(|k| *k != j).map(|k| nodes[k]) {
            let scale = (nodes[j] - node).recip();
            // times (θ − node) · scale
            for power in (0..4).rev() {
                let lower = if power > 0 { row[power - 1] } else { 0.0 };
                row[power] = scale * (lower - node * row[power]);
            }
        }
        row
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_one_at_their_node_and_zero_at_the_others() {
        let nodes = [0.0, NODES[0], NODES[1], NODES[2]];
        for (j, row) in basis().iter().enumerate() {
            for (k, node) in nodes.iter().enumerate() {
                let value = row.iter().rev().fold(0.0, |sum, c| sum * node + c);
                assert!((value - f64::from(u8::from(j == k))).abs() < 1e-13, "{j} {k} {value}");
            }
        }
    }
}
