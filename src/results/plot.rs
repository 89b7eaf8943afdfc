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
    /// Whether its axes are coordinates of one place: one unit of x is as long as one of y.
    #[serde(default)]
    pub path: bool,
    /// Ends of the horizontal axis, SI, where the file gives them.
    pub range: [Option<f64>; 2],
    /// Unit and range of the vertical axis of one quantity.
    pub y: Option<PlotAxis>,
    /// What is drawn over a second vertical axis on the right.
    pub right: Option<PlotRight>,
    /// Curves that do not come from the study.
    pub beside: Vec<PlotBeside>,
}

/// Unit and range of a vertical axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlotAxis {
    /// SI unit of the quantity that it is for.
    pub si: String,
    /// Its unit and the size of that in SI, if the file asks for one.
    pub unit: Option<(String, f64)>,
    /// Its ends, SI, where the file gives them.
    pub range: [Option<f64>; 2],
}

/// Curves over a second vertical axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlotRight {
    /// Their names.
    pub show: Vec<String>,
    /// The axis.
    pub axis: PlotAxis,
}

/// A curve that does not come from the study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlotBeside {
    /// Its name in the figure.
    pub label: String,
    /// The shown name whose quantity it is.
    pub of: String,
    /// Its points, SI.
    pub x: Vec<f64>,
    /// One for each of `x`, SI; NaN where there is none.
    #[serde(with = "gaps")]
    pub y: Vec<f64>,
    /// Whether it was measured: points without a line.
    pub measured: bool,
}

/// Numbers of which some may be missing: null in text.
mod gaps {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        let some: Vec<Option<f64>> = values.iter().map(|x| x.is_finite().then_some(*x)).collect();
        some.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        let some = Vec::<Option<f64>>::deserialize(deserializer)?;
        Ok(some.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }
}
