//! Shapes of bodies.

use serde::{Deserialize, Serialize};

/// A shape in the frame of its body, m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Shape {
    /// A straight bar between two ends; `width` if the model gives one.
    Bar { from: Vec<f64>, to: Vec<f64>, width: Option<f64> },
    /// A rounded plate around joints and points of the body; in space legs from their middle to each of them.
    Hull { points: Vec<Vec<f64>> },
    /// A true outline, closed: a plate or box in the plane, an outline that the model gives.
    Polygon { points: Vec<Vec<f64>> },
    /// A disc; in space with the unit `axis` of its turning, and its `thickness` if it has one.
    Disc { center: Vec<f64>, radius: f64, axis: Option<Vec<f64>>, thickness: Option<f64> },
    /// A wheel with teeth in the plane: the radius of its pitch circle, negative with inner teeth, and the direction of its `first` tooth in the
    /// body, rad. `output/` and the page draw involutes of 20°.
    Gear { center: Vec<f64>, radius: f64, teeth: usize, first: f64 },
    /// A box along the axes of the body.
    Box { center: Vec<f64>, size: Vec<f64> },
    /// A round bar.
    Cylinder { from: Vec<f64>, to: Vec<f64>, radius: f64 },
    /// A ball.
    Sphere { center: Vec<f64>, radius: f64 },
    /// A point mass, kg; areas of circles with these radii are as the masses of the mechanism.
    Mass { at: Vec<f64>, mass: f64, radius: f64 },
}
