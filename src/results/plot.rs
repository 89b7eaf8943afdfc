//! Which curves a figure shows.

use serde::{Deserialize, Serialize};

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
