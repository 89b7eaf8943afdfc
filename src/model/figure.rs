//! Figures of a study, and the forces that its drawing shows.

use super::keys::words;
use crate::expression::{Dimension, Id};

/// One figure.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// Its name; the file is `<study>-<name>.svg`.
    pub name: String,
    /// What is drawn: a column or, in a sweep, a scalar.
    pub show: Vec<Shown>,
    /// What it is drawn over; the independent variable if none.
    pub over: Option<Shown>,
    /// Unit of the horizontal axis, if the file asks for one: its word and factor to SI.
    pub unit: Option<(String, f64)>,
    /// Range of the horizontal axis.
    pub x: Option<PlotAxis>,
    /// Unit and range of the vertical axis of one quantity.
    pub y: Option<PlotAxis>,
    /// What is drawn over a second vertical axis on the right.
    pub right: Option<(Vec<Shown>, PlotAxis)>,
    /// Other studies whose curves of the same names are drawn, too.
    pub with: Vec<String>,
    /// Curves beside those of the study: measured ones, and those of other studies once they are computed.
    pub beside: Vec<Beside>,
}

impl Plot {
    /// All that it shows of its study.
    pub fn all(&self) -> impl Iterator<Item = &Shown> + Clone {
        self.show.iter().chain(&self.over).chain(self.right.iter().flat_map(|(show, _)| show))
    }
}

/// Unit and range of an axis.
#[derive(Clone, Debug, Default)]
pub struct PlotAxis {
    /// What stands along it.
    pub dimension: Dimension,
    /// Its unit, if the file asks for one: its word and factor to SI.
    pub unit: Option<(String, f64)>,
    /// Where it begins, and where it ends, if the file says so.
    pub ends: [Option<Id>; 2],
}

/// A curve that does not come from the study.
#[derive(Clone, Debug, Default)]
pub struct Beside {
    /// Its name in the figure.
    pub label: String,
    /// The shown name whose quantity it is.
    pub of: String,
    /// Its points, SI.
    pub points: Vec<(f64, f64)>,
    /// Whether it was measured: points without a line.
    pub measured: bool,
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

words! {
    /// Forces that a drawing shows as arrows.
    pub enum ForceKind {
        /// Those of the section `loads`.
        Loads = "loads",
        /// Those that joints transmit.
        Reactions = "reactions",
    }
}

/// A force that drawings show as an arrow.
#[derive(Clone, Debug)]
pub struct ShownForce {
    /// Name of the load or joint.
    pub name: String,
    /// What it is.
    pub on: ForceOn,
    /// Its components, in the order of the axes in which it is given; behind those of a moment those of the force that goes with it.
    pub components: Vec<Shown>,
    /// Force per length of its arrow, N/m; `None` for one that suits the picture.
    pub scale: Option<Id>,
}

/// What a force in a drawing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceOn {
    /// `model.loads[i]`: its force.
    Load(usize),
    /// `model.loads[i]`: its torque.
    Torque(usize),
    /// `model.joints[i]`: its force on the second body, in world axes.
    Reaction(usize),
    /// `model.joints[i]`: its moment on the second body, in world axes.
    Moment(usize),
    /// `model.couplings[i]`: its force along the line between the two points whose distance it prescribes.
    Coupling(usize),
}
