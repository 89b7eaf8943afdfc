//! What a study leaves: tables of named columns, scalars, extremes, events, findings, drawings; names and numbers, SI.
//!
//! Tables on a disc, reports and figures are made of this and of nothing else.

mod bends;
mod certificate;
mod compared;
mod failure;
mod finding;
mod number;
mod plot;
mod rows;
pub mod scene;
mod statistics;
mod swept;
mod table;
mod unknown;

pub use crate::numerics::extremum::{Extremes, Extremum};
pub use crate::numerics::resolve::Resolution;
pub use bends::{bends, largest};
pub use certificate::{Certificate, March};
pub use compared::{Compared, ComparedRun, References};
pub use failure::{Failure, Undefined, Unsolved};
pub use finding::{Checked, Finding, Happened};
pub use number::{number, six_digits};
pub use plot::{Plot, PlotAxis, PlotBeside, PlotRight};
pub use rows::{Rows, Sink};
pub use scene::Scene;
pub use statistics::{PERCENTAGES, Part, Statistics};
pub use swept::{Family, Swept, SweptBy};
pub use table::{Column, ShownIn, Table};
pub use unknown::Unknown;

use serde::{Deserialize, Serialize};

/// What a study has come to.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Results {
    /// Title of the model.
    pub model: String,
    /// Name of the study.
    pub study: String,
    /// Its kind: `dynamics`.
    pub kind: String,
    /// Variants of the model that it was run with, in the order in which they change it.
    #[serde(default)]
    pub variants: Vec<String>,
    /// Path of the study in the file.
    pub place: String,
    /// Why it stopped on its way, if it did; what was computed up to there is kept.
    pub stopped: Option<String>,
    /// What has no value, if that is why.
    pub undefined: Option<Undefined>,
    /// Values of the parameters, in file order.
    pub parameters: Vec<Scalar>,
    /// The independent variable of each row.
    pub independent: Column,
    /// The rows; of a sweep a row for each run.
    pub table: Table,
    /// Curves that only figures show.
    pub curves: Vec<Column>,
    /// Scalars: those taken from other studies, those of the kind, those of the file.
    pub scalars: Vec<Scalar>,
    /// Extremes of each column over the independent variable; none where a column has no value.
    pub extremes: Vec<(String, Option<Extremes>)>,
    /// Lists that the kind gives, as the eigenvalues of `modes`.
    pub lists: Vec<List>,
    /// Shapes of modes, each by the names of its coordinates.
    pub shapes: Vec<Vec<(String, f64)>>,
    /// Matrices of a linearised motion.
    pub linear: Option<LinearSystem>,
    /// Events of the model in the order in which they happened.
    pub events: Vec<Happened>,
    /// Expectations that were judged.
    pub expectations: Vec<Checked>,
    /// What a reader should know.
    pub findings: Vec<Finding>,
    /// How far to trust it.
    pub certificate: Certificate,
    /// What certifies the solution of a `solve`.
    pub solution: Option<Solution>,
    /// Drawings of the mechanism: the name of each, and what it shows.
    pub scenes: Vec<(String, Scene)>,
    /// Figures that the study asks for.
    pub plots: Vec<Plot>,
    /// How the numbers of a sweep whose values are drawn are distributed over its runs.
    pub statistics: Vec<Statistics>,
    /// The parameters of a sweep.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub swept: Vec<Swept>,
    /// The runs of a sweep.
    pub runs: Vec<Run>,
}

/// A run of a sweep.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Run {
    /// The swept values: `l3 = 0.3 m`.
    pub label: String,
    /// What it has come to; none if it did not begin. If drawings of all runs are too large, those of the first run are kept.
    pub results: Option<Box<Results>>,
    /// What certifies its solution, if it solves.
    pub solution: Option<Solution>,
}

/// A named number.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    /// Its name.
    pub name: String,
    /// What is measured, in words.
    pub quantity: String,
    /// The SI unit; empty for a number.
    pub unit: String,
    /// The unit to show it in, if the model asks for one.
    pub shown_in: Option<ShownIn>,
    /// The value, SI.
    pub value: f64,
    /// Who gives it.
    pub by: By,
}

impl Scalar {
    /// The value in the unit to show it in, and that unit.
    #[must_use]
    pub fn shown(&self) -> (f64, &str) {
        match &self.shown_in {
            // 0.3 m are 300 mm, not 299.99999999999994
            Some(asked) => (significant(self.value / asked.size), &asked.unit),
            None => (self.value, &self.unit),
        }
    }
}

/// Fifteen significant digits of a number.
fn significant(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}

/// Who gives a scalar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// The file, by an expression.
    #[default]
    File,
    /// The kind of the study.
    Kind,
    /// Another study, by `take`.
    Study,
}

/// A value of a parameter for which a scalar meets its target.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Solution {
    /// The parameter with its value.
    pub parameter: Scalar,
    /// Name of the scalar.
    pub of: String,
    /// The scalar there.
    pub found: f64,
    /// Its target there.
    pub target: f64,
    /// Values between which the scalar crosses its target.
    pub bracket: [f64; 2],
    /// Runs that were made.
    pub runs: usize,
    /// What a reader should know of it.
    pub findings: Vec<Finding>,
}

/// A named list of numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct List {
    /// Its name: `eigenvalues`.
    pub name: String,
    /// Its unit, SI; empty if it has none.
    pub unit: String,
    /// The unit to show them in, if the model asks for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shown_in: Option<ShownIn>,
    /// The numbers, SI.
    pub values: Vec<f64>,
}

/// A linearised motion in the plain form ẋ = A x + B u, y = C x + D u of deviations from a state, and in the form of
/// mechanics M ü + C u̇ + K u on the independent coordinates; matrices as lists of rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinearSystem {
    /// Names of the independent coordinates.
    pub coordinates: Vec<String>,
    /// Names of x: coordinates, their rates, first-order states.
    pub states: Vec<String>,
    /// Names of u.
    pub inputs: Vec<String>,
    /// Names of y.
    pub outputs: Vec<String>,
    /// Values of x, ẋ, u and y in the state.
    pub values: [Vec<f64>; 4],
    /// Names and values of the matrices: A, B, C, D, then `mass`, `damping` and `stiffness`.
    pub matrices: Vec<(String, Vec<Vec<f64>>)>,
    /// Whether the study asks for a CSV file of each matrix.
    pub csv: bool,
    /// Whether it asks for a MAT-file.
    pub mat: bool,
}

impl LinearSystem {
    /// What `values` are of.
    pub const VALUES: [&'static str; 4] = ["x", "rates", "u", "y"];

    /// Its lists of names.
    #[must_use]
    pub fn names(&self) -> [(&'static str, &[String]); 4] {
        [("coordinates", &self.coordinates), ("states", &self.states), ("inputs", &self.inputs), ("outputs", &self.outputs)]
    }

    /// Names of the columns of a matrix.
    #[must_use]
    pub fn columns(&self, matrix: &str) -> &[String] {
        match matrix {
            "A" | "C" => &self.states,
            "B" | "D" => &self.inputs,
            _ => &self.coordinates,
        }
    }
}

impl Results {
    /// The values of a column, SI, by its name.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn column(&self, name: &str) -> Result<&[f64], Unknown> {
        let mut columns = self.table.columns.iter().chain(&self.curves);
        let known = || self.table.columns.iter().map(|column| column.name.clone()).collect();
        let found = columns.find(|column| column.name == name).map(|column| column.values.as_slice());
        found.ok_or_else(|| Unknown { what: "column", name: name.into(), known: known() })
    }

    /// A scalar, SI, by its name.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn scalar(&self, name: &str) -> Result<f64, Unknown> {
        let known = || self.scalars.iter().map(|scalar| scalar.name.clone()).collect();
        let found = self.scalars.iter().find(|scalar| scalar.name == name).map(|scalar| scalar.value);
        found.ok_or_else(|| Unknown { what: "scalar", name: name.into(), known: known() })
    }

    /// The runs of a sweep as curves over a column of its table, by default the first parameter: one for each combination of the other
    /// parameters. With them, whether there are points alone and no lines between them, since values are drawn or come from a list
    /// of points.
    #[must_use]
    pub fn families(&self, over: Option<&str>) -> (Vec<Family>, bool) {
        swept::families(&self.table, &self.swept, over)
    }

    /// The values of a list by its name, if the kind gives it.
    #[must_use]
    pub fn list(&self, name: &str) -> Option<&[f64]> {
        self.lists.iter().find(|list| list.name == name).map(|list| list.values.as_slice())
    }

    /// Which of the drawings move: the motion, or each mode.
    #[must_use]
    pub fn moving(&self) -> Vec<usize> {
        let rests = ["statics", "linearize"].contains(&self.kind.as_str());
        (0..self.scenes.len()).filter(|index| self.scenes[*index].1.frames.count() > 1 && !rests).collect()
    }

    /// The extremes of a column by its name; none if it has no value.
    #[must_use]
    pub fn extremes(&self, name: &str) -> Option<Extremes> {
        self.extremes.iter().find(|(column, _)| column == name).and_then(|(_, extremes)| *extremes)
    }
}
