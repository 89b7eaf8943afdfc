//! Outlines of a mechanism, and which curves are drawn.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Outlines of the mechanism in a few positions, in the plane of the drawing.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Scene {
    /// Bodies: name and points in each position, m.
    pub bodies: Vec<(String, Vec<Vec<[f64; 2]>>)>,
    /// Joints.
    pub joints: Vec<SceneJoint>,
    /// Springs: name and ends in each position.
    pub springs: Vec<(String, Vec<[[f64; 2]; 2]>)>,
    /// Traces of points: name and positions along the motion.
    pub traces: Vec<(String, Vec<[f64; 2]>)>,
}

/// A joint in a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SceneJoint {
    /// Its name.
    pub name: String,
    /// Its kind as in the model file.
    pub kind: Cow<'static, str>,
    /// Whether one of its bodies is the ground.
    pub grounded: bool,
    /// Its place in each position.
    pub at: Vec<[f64; 2]>,
    /// Direction of its axis in each position, for sliding joints.
    pub along: Vec<[f64; 2]>,
}

/// A figure that the study asks for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// Its name; the file is `<study>-<name>.svg`.
    pub name: String,
    /// Names of the curves: columns, or curves that only figures show; in a sweep columns of its table.
    pub show: Vec<String>,
    /// What they are drawn over; the independent variable if none.
    pub over: Option<String>,
    /// Unit of the horizontal axis and its size in SI, if the file asks for one.
    pub unit: Option<(String, f64)>,
    /// Whether it shows numbers of whole runs over a swept parameter.
    pub of_runs: bool,
}
