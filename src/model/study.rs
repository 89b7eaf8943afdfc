//! What a study asks for.

use super::entities::Place;
use crate::expression::{Dimension, Id};

/// One study: a kind with its own keys, and what is common to all.
#[derive(Clone, Debug)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// Its `about`.
    pub about: String,
    /// What is computed.
    pub kind: Kind,
    /// Swept parameters; several: the grid, last one fastest.
    pub sweep: Vec<Sweep>,
    /// `solve`, read and checked.
    pub solve: Option<Solve>,
    /// `take`: local name, study, scalar.
    pub take: Vec<Take>,
    /// Columns in the order of the CSV; the first is the independent variable if `columns` was silent.
    pub columns: Vec<Column>,
    /// True if the file names the columns.
    pub columns_given: bool,
    /// Scalars in file order; leaves are functionals, results and parameters.
    pub scalars: Vec<Scalar>,
    /// Names of the scalars that the kind itself gives (`turns_fully`; the moved masses and `residual` of a balance).
    pub results: Vec<String>,
    /// Functionals over the whole study that scalars and expectations use.
    pub functionals: Vec<Functional>,
    /// Figures.
    pub plots: Vec<Plot>,
    /// Expectations.
    pub expect: Vec<Expectation>,
    /// Where it stands.
    pub place: Place,
}

/// Kind of a study.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Kind {
    /// Positions, velocities, accelerations over a range.
    Kinematics(Range),
    /// The same with driver efforts and reactions.
    Inverse(Range),
    /// Masses moved until the centre of mass stands still: (body, index in its `attached`).
    Balance { moved: Vec<(usize, usize)>, range: Range },
    /// Read and checked; acts in a later version. The word is the kind's key.
    Later(&'static str),
}

/// Range of a kinematic study.
#[derive(Clone, Debug)]
pub struct Range {
    /// `over`.
    pub over: Over,
    /// Number of equal intervals; one row more.
    pub samples: usize,
}

/// What a range runs over.
#[derive(Clone, Copy, Debug)]
pub enum Over {
    /// The coordinate of the one driver, from its start: rad or m.
    Driver(Id),
    /// Time from 0, s.
    Time(Id),
}

/// A swept parameter.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Index in `Model::parameters`.
    pub parameter: usize,
    /// Its values.
    pub values: Values,
    /// Where it stands.
    pub place: Place,
}

/// Values of a sweep.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Values {
    /// A list.
    List(Vec<Id>),
    /// `count` values from `from` to `to`, equally spaced, or so in the logarithm.
    Span { from: Id, to: Id, count: usize, log: bool },
}

/// `solve`: vary a parameter between two values until scalars meet their targets.
#[derive(Clone, Debug)]
pub struct Solve {
    /// Index in `Model::parameters`.
    pub parameter: usize,
    /// Bounds.
    pub between: [Id; 2],
    /// Scalar name and target.
    pub target: (String, Id),
}

/// `take`: a scalar of another study.
#[derive(Clone, Debug)]
pub struct Take {
    /// Local name.
    pub name: String,
    /// The other study.
    pub study: String,
    /// Its scalar.
    pub scalar: String,
}

/// One column of the results.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its header: `theta`, `O.fx`, `com.x`.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value.
    pub value: Id,
}

/// One named scalar.
#[derive(Clone, Debug)]
pub struct Scalar {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value, an expression of functionals, results, parameters and other scalars.
    pub value: Id,
    /// Where it stands.
    pub place: Place,
}

/// A functional of a column over the whole study.
#[derive(Clone, Debug)]
pub struct Functional {
    /// Which.
    pub kind: FunctionalKind,
    /// What it is taken of (a condition for `first`).
    pub of: Id,
    /// `value(x, at)`: where, in the independent variable.
    pub at: Option<Id>,
    /// As written, for messages: `mean(drive.power)`.
    pub text: String,
    /// Dimension of the result; integrals and `first` carry the dimension of the independent variable.
    pub dimension: Dimension,
}

/// Kinds of functionals: means and integrals are over the independent variable, on the continuous solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionalKind {
    /// ∫ x / range.
    Mean,
    /// ∫ x.
    Integral,
    /// Largest value.
    Max,
    /// Smallest value.
    Min,
    /// Value at the end.
    Last,
    /// Value at a given place.
    Value,
    /// Where a condition first holds.
    First,
}

/// One figure.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Its name; the file is `<study>-<name>.svg`.
    pub name: String,
    /// What is drawn: a column or, in a sweep, a scalar.
    pub show: Vec<Shown>,
    /// What it is drawn over; the independent variable if none.
    pub over: Option<Shown>,
    /// Unit of the horizontal axis, if the file asks for one: its word and factor to SI.
    pub unit: Option<(String, f64)>,
}

/// Something drawn: a column or a scalar by its name.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Its name.
    pub name: String,
    /// What it refers to.
    pub what: ShownWhat,
    /// Its dimension.
    pub dimension: Dimension,
}

/// What a plotted name refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownWhat {
    /// A time-varying expression (in the columns or not).
    Column(Id),
    /// `study.scalars[i]`, one value per run of a sweep.
    Scalar(usize),
    /// `study.results[i]`, one value per run of a sweep.
    Result(usize),
    /// `model.parameters[i]`, swept.
    Parameter(usize),
}

/// `expect:` one scalar or expression with its tolerance.
#[derive(Clone, Debug)]
pub struct Expectation {
    /// As written.
    pub text: String,
    /// The value found.
    pub value: Id,
    /// `is`.
    pub is: Id,
    /// `within`, absolute, or `relative`.
    pub tolerance: Tolerance,
    /// Dimension of the value.
    pub dimension: Dimension,
    /// Where it stands.
    pub place: Place,
}

/// How close an expectation must be met.
#[derive(Clone, Copy, Debug)]
pub enum Tolerance {
    /// |found − is| ≤ this.
    Within(Id),
    /// |found − is| ≤ this · |is|.
    Relative(Id),
}
