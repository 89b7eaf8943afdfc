//! Error, order and step of a variable-order method (Shampine & Reichelt 1997, "The MATLAB ODE suite", section 2.3).

use super::history::History;
use crate::engine::{Engine, Node};

/// Errors count this many times. At order 5 steps are a sixth shorter for it; with 1 the error of Andrews' mechanism exceeds a
/// hundred tolerances, and of four-bars the energy drifts more than ten times that of their equation of one freedom (measured).
const CAUTION: f64 = 3.0;

/// Stricter tolerances count as this one: differences of order 5 magnify round-off by 2⁵, and steps that shrink for its sake never
/// end (measured on Andrews' mechanism).
const FLOOR: f64 = 1e-12;

/// Highest order.
pub(super) const ORDER: usize = 5;

/// Caution with a step at the order at hand: an order change must pay more than a change of the step.
pub(super) const SAME: f64 = 1.2;
const LOWER: f64 = 1.3;
const HIGHER: f64 = 1.4;

/// The step by which the error of `order` would meet the tolerance, in units of the present one.
pub(super) fn factor(error: f64, order: usize, caution: f64) -> f64 {
    let factor = (caution * error.powf(1.0 / (order as f64 + 1.0))).recip();
    if factor.is_finite() {
        factor
    } else if error == 0.0 {
        1e3
    } else {
        0.0
    }
}

/// Norm of an error (q, v, z), 1 at the tolerance; without the velocities where they are not controlled (index 3).
pub(super) fn norm(engine: &Engine, at: &Node, error: &mut [f64], velocities: bool) -> f64 {
    let (q, rest) = error.split_at_mut(engine.dims.q);
    let (v, z) = rest.split_at_mut(engine.dims.v);
    if !velocities {
        v.fill(0.0);
    }
    CAUTION * (engine.tolerance() / FLOOR).min(1.0) * engine.norm(&at.state, q, v, z)
}

/// Σ 1/j to j = order: γ of backward differences at constant step.
pub(super) fn gamma(order: usize) -> f64 {
    (1..=order).map(|j| (j as f64).recip()).sum()
}

/// The error that `order` makes at constant step h: the difference of degree order + 1, over order + 1.
fn error_of(engine: &Engine, history: &History, node: &Node, order: usize, h: f64, (out, velocities): (&mut [f64], bool)) -> f64 {
    if order == 0 || order > ORDER || history.count() < order + 2 {
        return f64::INFINITY;
    }
    history.combine(&history.difference(order + 1, h), false, out);
    norm(engine, node, out, velocities) / (order as f64 + 1.0)
}

/// What the next step shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    pub(super) order: usize,
    /// In units of the present step.
    pub(super) factor: f64,
}

/// The order around `order` that allows the longest step, of those within `orders`.
pub(super) fn choose(
    engine: &Engine,
    history: &History,
    node: &Node,
    (order, orders): (usize, [usize; 2]),
    h: f64,
    (out, velocities): (&mut [f64], bool),
) -> Choice {
    let mut best = Choice { order, factor: 0.0 };
    for (candidate, caution) in [(order, SAME), (order - 1, LOWER), (order + 1, HIGHER)] {
        if (orders[0]..=orders[1]).contains(&candidate) {
            let error = error_of(engine, history, node, candidate, h, (out, velocities));
            let factor = factor(error, candidate, caution);
            if factor > best.factor {
                best = Choice { order: candidate, factor };
            }
        }
    }
    best
}
