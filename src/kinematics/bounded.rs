//! The tree on which the system of accelerations costs least.
//!
//! M is full along the road from the ground to a body, so that a chain of n bodies takes n³ operations for its accelerations. With free
//! bodies here and there, whose joints are rows, roads are short and M and G are sparse: n bodies take a multiple of n. What counts
//! is the number of operations of the factorisation, by patterns alone.

use super::assemble::Assembled;
use super::undefined::assembled;
use crate::dynamics::{depths, mass_pattern, row_pattern};
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::{Coordinates, Mechanism, build};
use crate::model::{Dimensions, Model};
use crate::results::Failure;
use grashof_solvers::Kkt;

/// Mechanisms of fewer bodies are not looked at: there each tree costs next to nothing.
const FEW: usize = 16;

/// Of roads with so many columns at most none is worth cutting: the three or six columns and as many rows of a free body cost more.
const SHORT: usize = 4;

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
    let Ok(plain) = build::<G>(model, parameters, Coordinates::Joint) else { return Coordinates::Joint };
    if depths(&plain).into_iter().all(|above| above < SHORT) {
        return Coordinates::Joint;
    }
    let cost = |mechanism: &Mechanism<G>| Kkt::cost(&mass_pattern(mechanism), &row_pattern(mechanism));
    let bounded = DEPTHS.into_iter().map(Coordinates::Bounded).filter_map(|tree| {
        let mechanism = build::<G>(model, parameters, tree).ok()?;
        Some((cost(&mechanism), tree))
    });
    let Some((least, tree)) = bounded.min_by_key(|(cost, _)| *cost) else { return Coordinates::Joint };
    // the pattern of a long road has the square of its length: it is not made where that is seen to be too much
    let at_least = Kkt::least_cost(plain.nv + plain.rows.len(), &depths(&plain));
    if CHEAPER * least <= at_least || CHEAPER * least <= cost(&plain) { tree } else { Coordinates::Joint }
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
