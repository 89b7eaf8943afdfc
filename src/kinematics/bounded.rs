//! The tree on which the system of accelerations costs least.
//!
//! M is full along the road from the ground to a body, so that a chain of n bodies takes n³ operations for its accelerations. With free
//! bodies here and there, whose joints are rows, roads are short and M and G are sparse: n bodies take a multiple of n. What counts
//! is the number of operations of the factorisation, by patterns alone.

use super::assemble::Assembled;
use super::undefined::assembled;
use crate::dynamics::{mass_pattern, row_pattern};
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::{Coordinates, Mechanism, build};
use crate::model::{Dimensions, Model};
use crate::results::Failure;
use grashof_solvers::Kkt;

/// Mechanisms of fewer bodies are not looked at: there each tree costs next to nothing.
const FEW: usize = 16;

/// Lengths of roads that are tried.
const DEPTHS: [usize; 5] = [2, 4, 6, 8, 16];

/// A bounded tree must be so many times cheaper: it brings rows that have to be kept closed.
const CHEAPER: usize = 4;

/// Joint coordinates, on a bounded tree where that is much cheaper.
#[must_use]
pub fn cheapest(model: &Model, parameters: &[f64]) -> Coordinates {
    match model.space {
        _ if model.bodies.len() < FEW => Coordinates::Joint,
        Dimensions::Planar => among::<Planar<f64>>(model, parameters),
        Dimensions::Spatial => among::<Spatial<f64>>(model, parameters),
    }
}

fn among<G: Space<S = f64>>(model: &Model, parameters: &[f64]) -> Coordinates {
    let cost = |coordinates: Coordinates| {
        let mechanism = build::<G>(model, parameters, coordinates).ok()?;
        Some(Kkt::cost(&mass_pattern(&mechanism), &row_pattern(&mechanism)))
    };
    let plain = cost(Coordinates::Joint);
    let bounded = DEPTHS.into_iter().map(Coordinates::Bounded).filter_map(|tree| Some((cost(tree)?, tree)));
    match (plain, bounded.min_by_key(|(cost, _)| *cost)) {
        (Some(plain), Some((cost, tree))) if CHEAPER * cost <= plain => tree,
        _ => Coordinates::Joint,
    }
}

/// The mechanism on the cheapest tree on which all coordinates of joints are measured by gauges, along which a force can hold them; with
/// its start.
///
/// # Errors
/// If it cannot be assembled.
pub(crate) fn assembled_for_gauges<G: Space<S = f64>>(model: &Model, parameters: &[f64]) -> Result<(Mechanism<G>, Assembled), Failure> {
    let tree = cheapest(model, parameters);
    let (mechanism, start) = assembled::<G>(model, parameters, tree)?;
    let measured = mechanism.joints.iter().all(|joint| joint.tree.is_some() || joint.slots.len() == joint.freedom);
    if measured { Ok((mechanism, start)) } else { assembled::<G>(model, parameters, Coordinates::Joint) }
}
