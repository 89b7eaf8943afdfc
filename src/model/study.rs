//! What a study asks for.

use super::figure::{Plot, ShownForce};
use super::integrator::Integrator;
use super::keys::{Words, words};
use super::place::{Place, PointRef};
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
    /// How many points of the sweep are drawn from the distributions of its parameters, if some have one.
    pub samples: Option<Samples>,
    /// `solve`, read and checked.
    pub solve: Option<Solve>,
    /// `take`: local name, study, scalar.
    pub take: Vec<Take>,
    /// Dimension of the independent variable; `None` if the study has none.
    pub independent: Option<Dimension>,
    /// Columns in the order of the CSV; the first is the independent variable if `columns` was silent.
    pub columns: Vec<Column>,
    /// Columns and curves that may be undefined: their cells are blank there.
    pub undefined: Vec<Id>,
    /// True if the file names the columns.
    pub columns_given: bool,
    /// Scalars in file order; leaves are functionals, results and parameters.
    pub scalars: Vec<Scalar>,
    /// Scalars that the kind itself gives (`turns_fully`; the moved masses and `residual` of a balance).
    pub results: Vec<StudyResult>,
    /// Functionals over the whole study that scalars and expectations use.
    pub functionals: Vec<Functional>,
    /// Figures.
    pub plots: Vec<Plot>,
    /// Points whose paths are drawn; `None` if the file leaves it open.
    pub trace: Option<Vec<PointRef>>,
    /// Where a drawing in space is seen from; `None` for an isometric view.
    pub view: Option<View>,
    /// Value of the independent variable at which drawings show the mechanism strongly; `None` for the begin.
    pub shown_at: Option<Id>,
    /// Forces that drawings show as arrows.
    pub forces: Vec<ShownForce>,
    /// Expectations.
    pub expect: Vec<Expectation>,
    /// Where it stands.
    pub place: Place,
}

impl Study {
    /// Where a key of its kind stands: `studies.turn.kinematics.over`.
    #[must_use]
    pub fn place_of(&self, key: &str) -> Place {
        format!("{}.{}.{key}", self.place, self.kind.name())
    }
}

words! {
    /// A side from which a drawing in space is seen, with `up` upwards (z if that is x, y or z by turns).
    pub enum Side {
        /// Against the second level axis (y): x to the right.
        Front = "front",
        /// Against `up`, from above.
        Top = "top",
        /// Against the first level axis (x): y to the right.
        Right = "side",
    }
}

/// Where a drawing in space is seen from.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum View {
    /// From a side.
    Side(Side),
    /// From an `azimuth` about the upward direction, counted from the first level axis (x), and an `elevation`, rad.
    From { azimuth: Id, elevation: Id },
}

/// A scalar that the kind of a study gives.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyResult {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
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
    /// Motion in time.
    Dynamics(Forward),
    /// Equilibrium, from the start position.
    Statics,
    /// Eigenvalues and shapes about a pose.
    Modes(Modes),
    /// Periodic regime.
    Periodic(Periodic),
    /// The linearised motion about a state.
    Linearize(Linearize),
}

impl Kind {
    /// Its key in the model file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Kinematics(_) => "kinematics",
            Self::Inverse(_) => "inverse",
            Self::Balance { .. } => "balance",
            Self::Dynamics(_) => "dynamics",
            Self::Statics => "statics",
            Self::Modes(_) => "modes",
            Self::Periodic(_) => "periodic",
            Self::Linearize(_) => "linearize",
        }
    }
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

/// Motion in time from the start position: `dynamics`.
#[derive(Clone, Debug)]
pub struct Forward {
    /// End of the run, s.
    pub until: Id,
    /// Output step, s; every step of the integrator if none.
    pub every: Option<Id>,
    /// How the step is chosen.
    pub control: Control,
    /// The scheme.
    pub integrator: Integrator,
    /// `newmark`: weight of the acceleration in the displacement (textbook β); `hht`: its α, in [−1/3, 0].
    pub alpha: Option<Id>,
    /// `newmark`: weight of the acceleration in the velocity (textbook γ). Given if and only if `alpha` is.
    pub beta: Option<Id>,
    /// `generalized-alpha`: spectral radius at infinite frequency, in [0, 1].
    pub rho: Option<Id>,
    /// `bdf` with a fixed step: its order, 1 to 5.
    pub order: Option<usize>,
    /// Which constraint rows are imposed; the scheme's own choice if none.
    pub level: Option<Level>,
    /// Coordinates of the computation.
    pub chart: Chart,
    /// Whether switches are located; else a scheme of fixed step marches across them.
    pub locate: bool,
}

/// Vibrations about a held pose: `modes`.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Whether the pose is an equilibrium that is searched from the start; else the start itself.
    pub at_equilibrium: bool,
    /// Whether damping counts.
    pub damped: bool,
    /// Number of modes, the lowest ones; all if none, of mechanisms of many bodies some.
    pub lowest: Option<usize>,
    /// Eigensolvers, each once; none if that is left to the program.
    pub methods: Vec<Eigensolver>,
}

/// Matrices of the linearised motion about a state: `linearize`.
#[derive(Clone, Debug)]
pub struct Linearize {
    /// Whether the state is the rest in an equilibrium that is searched from the start; else the start itself, with its velocities.
    pub at_equilibrium: bool,
    /// Parameters that are inputs.
    pub inputs: Vec<usize>,
    /// Whether each matrix is written as a CSV file.
    pub csv: bool,
    /// Whether all of them are written as a MAT-file.
    pub mat: bool,
}

words! {
    /// How eigenvalues are found.
    pub enum Eigensolver {
        /// By the linear algebra library.
        Library = "library",
        /// Jacobi's rotations.
        Jacobi = "jacobi",
        /// Inverse iteration with deflation.
        Power = "power",
        /// Lanczos' method on sparse matrices.
        Lanczos = "lanczos",
    }
}

impl Eigensolver {
    /// Its name in the model file.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// The regime in which a mechanism settles: `periodic`.
#[derive(Clone, Debug)]
pub struct Periodic {
    /// What advances by one period; none: the time.
    pub over: Option<Progress>,
    /// Where a period ends.
    pub ends: PeriodEnd,
    /// The quantity whose mean and extremes are found.
    pub of: Id,
    /// Number of equal intervals of the rows; one row more.
    pub samples: usize,
    /// Relative tolerance of the integration; 1e-12 if none.
    pub tolerance: Option<Id>,
    /// Time of the run before the search, s; until two periods are alike if none.
    pub settle: Option<Id>,
    /// Coordinates of the computation: `Joint` or `Cartesian`.
    pub chart: Chart,
    /// A parameter along which the regime is followed.
    pub from: Option<Continued>,
}

/// What advances by one period.
#[derive(Clone, Debug)]
pub struct Progress {
    /// As written: `theta`.
    pub name: String,
    /// Its value, and its rate.
    pub value: Id,
    /// Its time rate.
    pub rate: Id,
}

/// Where a period ends.
#[derive(Clone, Copy, Debug)]
pub enum PeriodEnd {
    /// Behind so much progress, in its unit.
    By(Id),
    /// Where an expression rises through 0 again.
    Through(Id),
}

/// A regime that is followed from one value of a parameter to its own.
#[derive(Clone, Copy, Debug)]
pub struct Continued {
    /// Index in `Model::parameters`.
    pub parameter: usize,
    /// The value to begin with.
    pub at: Id,
    /// Number of equal steps.
    pub steps: usize,
}

/// How the step of an integrator is chosen.
#[derive(Clone, Copy, Debug)]
pub enum Control {
    /// By a relative tolerance, in (0, 0.1]; 1e-8 if none.
    Tolerance(Option<Id>),
    /// Fixed, s.
    Step(Id),
}

words! {
    /// Which constraint rows an integrator imposes.
    pub enum Level {
        /// Positions and velocities (Gear, Gupta and Leimkuhler), index 2.
        Stabilized = "stabilized",
        /// Positions, index 3.
        Position = "position",
        /// Velocities, index 2.
        Velocity = "velocity",
        /// Accelerations, index 1, with projection.
        Acceleration = "acceleration",
    }
}

words! {
    /// Coordinates of motion in time.
    pub enum Chart {
        /// Joint coordinates; where roads over many joints would make that slow, free bodies in between.
        Auto = "auto",
        /// Joint coordinates of a spanning tree, closed loops as rows.
        Joint = "joint",
        /// Every body free, every joint as rows.
        Cartesian = "cartesian",
        /// Independent coordinates alone.
        Minimal = "minimal",
    }
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
    /// The unit in which its first value is written, and the size of that in SI.
    pub unit: Option<(String, f64)>,
}

/// Values of a sweep.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Values {
    /// A list.
    List(Vec<Id>),
    /// A list that stands beside that of the parameter before, of the same length: no combinations of the two.
    Beside(Vec<Id>),
    /// `count` values from `from` to `to`, equally spaced, or so in the logarithm.
    Span { from: Id, to: Id, count: usize, log: bool },
    /// Drawn from a normal distribution.
    Normal { mean: Id, deviation: Id },
    /// Drawn from between two values, all with the same chance.
    Uniform { from: Id, to: Id },
}

impl Values {
    /// The numbers that they are made of.
    #[must_use]
    pub fn ids(&self) -> Vec<Id> {
        match self {
            Self::List(ids) | Self::Beside(ids) => ids.clone(),
            Self::Span { from, to, .. } | Self::Uniform { from, to } => vec![*from, *to],
            Self::Normal { mean, deviation } => vec![*mean, *deviation],
        }
    }

    /// Whether they are drawn.
    #[must_use]
    pub fn are_drawn(&self) -> bool {
        matches!(self, Self::Normal { .. } | Self::Uniform { .. })
    }
}

/// Points that are drawn, all parameters with a distribution at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// How many.
    pub count: usize,
    /// Decides which.
    pub seed: u64,
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
    /// Units in which the file writes the bounds and the target, with their sizes in SI; `None` where it writes none.
    pub units: [Option<(String, f64)>; 2],
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
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value, once [`Model::give`](super::Model::give) has brought it; until then not a number.
    pub value: f64,
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
