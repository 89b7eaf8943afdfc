//! What a study leaves: columns, scalars, extremes, findings; names and numbers, ready for output.

use crate::mechanism::BuildFault;
use crate::model::WORKS;
use crate::numerics::extremum::Extremes;
pub use crate::numerics::resolve::Resolution;
use grashof_solvers::Counts;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// A word of the program: a code, a kind.
pub type Word = &'static str;

/// Result of one run of a study.
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
    pub rows: Vec<Vec<f64>>,
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
}

/// A named list of numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct List {
    /// Its name: `eigenvalues`.
    pub name: String,
    /// Its unit, SI; empty if it has none.
    pub unit: String,
    /// The numbers.
    pub values: Vec<f64>,
}

/// One checked expectation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checked {
    /// As written.
    pub text: String,
    /// What was found.
    pub found: f64,
    /// What was wanted.
    pub wanted: f64,
    /// Allowed difference.
    pub tolerance: f64,
    /// Whether it is met.
    pub met: bool,
    /// Path in the file.
    pub place: String,
}

/// Something worth knowing that is not an error.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// Kebab-case kind.
    #[serde(deserialize_with = "word")]
    pub code: Word,
    /// In words.
    pub message: String,
    /// Path in the file.
    pub path: String,
}

/// An event of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Happened {
    /// Its name.
    pub name: String,
    /// When, s.
    pub at: f64,
}

/// What certifies a motion in time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct March {
    /// Schemes that stepped: `dop853`, `dop853, radau5`.
    pub schemes: String,
    /// Tolerance; none with a fixed step.
    pub tolerance: Option<f64>,
    /// Largest |E − E(0) − work|, J.
    pub energy_drift: f64,
    /// Largest of kinetic energy, change of potential energy and works, J.
    pub energy_scale: f64,
    /// Work of drivers, J.
    pub drivers: f64,
    /// Work of loads and motors, J.
    pub loads: f64,
    /// Work of dampers, J.
    pub dampers: f64,
    /// Work of end stops beside what they store, J: damping of those that give way, blows at rigid ones.
    pub stops: f64,
    /// Energy that events have given or taken at once, J.
    pub impacts: f64,
    /// Widest gap between looks at the conditions that depend on the motion, s; 0 where there are none.
    pub widest_gap: f64,
    /// Largest residual of the velocity constraints over the rows, in units of size per second.
    pub velocity: f64,
    /// What was spent.
    #[serde(with = "CountsFields")]
    pub counts: Counts,
}

impl March {
    /// The works by [`WORKS`], J.
    #[must_use]
    pub fn works(&self) -> [f64; WORKS.len()] {
        [self.drivers, self.loads, self.dampers, self.stops, self.impacts]
    }
}

/// How well the rows satisfy the equations.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Certificate {
    /// Positions solved.
    pub evaluations: usize,
    /// Located switches.
    pub switches: usize,
    /// Largest |Φ| over the rows, m or rad.
    pub constraint: f64,
    /// Largest |driver power + power of applied forces − dT/dt| over the rows, relative to the largest of its terms.
    pub power_balance: f64,
    /// How far columns are resolved between their rows.
    pub resolved: Option<Resolution>,
    /// More of a motion in time.
    pub march: Option<March>,
}

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
    #[serde(deserialize_with = "word")]
    pub kind: Word,
    /// Whether one of its bodies is the ground.
    pub grounded: bool,
    /// Its place in each position.
    pub at: Vec<[f64; 2]>,
    /// Direction of its axis in each position, for sliding joints.
    pub along: Vec<[f64; 2]>,
}

/// Why a run has no result.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Failure {
    /// The model has no mechanism at these parameters.
    Model(Vec<BuildFault>),
    /// The study asks for what the mechanism cannot give: freedom left over, too many drivers; with the path in the file.
    Study { code: &'static str, message: String, place: String, help: String },
    /// Something has no value where it is needed from the start on.
    Undefined(Undefined),
    /// It did not begin or end for a numerical reason.
    Numerical { message: String, help: String },
    /// No value of the parameter that is varied meets the target.
    Unsolved(Unsolved),
}

/// Why a `solve` has no solution, with the path in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unsolved {
    /// What was found.
    pub message: String,
    /// Path in the file.
    pub place: String,
    /// One remedy.
    pub help: String,
}

/// What has no value in a study, with the path in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Undefined {
    /// What, where and why.
    pub message: String,
    /// Path in the file.
    pub place: String,
    /// One remedy.
    pub help: String,
}

impl Failure {
    /// A numerical reason, with one remedy.
    pub(crate) fn numerical(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Numerical { message: message.into(), help: help.into() }
    }

    /// It was ended from outside.
    pub(crate) fn interrupted() -> Self {
        Self::numerical("interrupted", "")
    }

    /// In one sentence, as the `reason` of a sweep's row.
    #[must_use]
    pub fn reason(&self) -> String {
        match self {
            Self::Model(faults) => {
                let told = |f: &BuildFault| match f.place.as_str() {
                    "" => f.message.clone(),
                    place => format!("`{place}`: {}", f.message),
                };
                faults.iter().map(told).collect::<Vec<_>>().join("; ")
            }
            Self::Undefined(Undefined { message, .. })
            | Self::Study { message, .. }
            | Self::Numerical { message, .. }
            | Self::Unsolved(Unsolved { message, .. }) => message.clone(),
        }
    }
}

/// Fields of [`Counts`], which the solvers keep free of formats.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Counts")]
struct CountsFields {
    steps: usize,
    rejected: usize,
    evaluations: usize,
    tangents: usize,
    factorisations: usize,
    iterations: usize,
    events: usize,
    bridges: usize,
    stepped_over: usize,
    unresolved: usize,
}

/// A word that was written once: the same one again, kept as long as the program runs. There are few of them.
fn word<'de, D: Deserializer<'de>>(from: D) -> Result<Word, D::Error> {
    static KNOWN: Mutex<BTreeSet<Word>> = Mutex::new(BTreeSet::new());
    let text = String::deserialize(from)?;
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(known.get(text.as_str()).copied().unwrap_or_else(|| {
        let word: Word = text.leak();
        known.insert(word);
        word
    }))
}
