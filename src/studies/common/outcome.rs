//! What one run of a study has come to: numbers in the order in which the study asks for them.

use crate::numerics::extremum::Extremes;
use crate::results::{Certificate, Checked, Finding, Happened, LinearSystem, List, Rows, Scene, Undefined};
use serde::{Deserialize, Serialize};

/// What one run of a study has come to; [`Results`](crate::results::Results) have names to it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Why it stopped on its way, if it did; its rows are kept.
    pub stopped: Option<String>,
    /// What has no value, if that is why.
    #[serde(default)]
    pub undefined: Option<Undefined>,
    /// Values of the parameters, in file order.
    pub parameters: Vec<(String, f64)>,
    /// Name of the independent variable: `theta`, `O.angle` or `time`.
    pub independent: String,
    /// Independent variable of each row.
    pub places: Vec<f64>,
    /// Rows before each located switch; the next row is behind it.
    pub switches: Vec<usize>,
    /// Columns of each row, in the order of `study.columns`, then the curves that only figures show.
    pub rows: Rows,
    /// How many rows these were selected from, where more were computed and passed on.
    #[serde(default)]
    pub selected_from: Option<usize>,
    /// Results of the kind, in the order of `study.results`.
    pub results: Vec<f64>,
    /// Lists that the kind gives, as the eigenvalues of `modes`.
    pub lists: Vec<List>,
    /// Shapes of modes, each by the names of its coordinates.
    pub shapes: Vec<Vec<(String, f64)>>,
    /// Matrices of a linearised motion.
    pub linear: Option<LinearSystem>,
    /// Scalars, in the order of `study.scalars`.
    pub scalars: Vec<f64>,
    /// Extremes of each column over the independent variable; none where a column is not defined.
    pub extremes: Vec<Option<Extremes>>,
    /// Expectations that were checked: text, found, wanted, tolerance, met.
    pub expectations: Vec<Checked>,
    /// What a reader should know.
    pub findings: Vec<Finding>,
    /// Figures of the run that certify it.
    pub certificate: Certificate,
    /// Events of the model in the order in which they happened.
    pub events: Vec<Happened>,
    /// Drawings of the mechanism: the name of each, and what it shows.
    pub scenes: Vec<(String, Scene)>,
}
