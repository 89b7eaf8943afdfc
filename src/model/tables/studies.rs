//! The tables of a study.

use super::super::fields::Shape::{Count, Either, Flag, Formula, List, Map, Name, Named, Text, Value, Word};
use super::super::fields::{Keys, Shape, Size, Table, Want};
use super::super::integrator;
use super::shapes::{ANY, NUMBER, TIME, at_most_one, may, need, one_of};

/// Most intervals of a study.
pub(crate) const MOST_SAMPLES: u64 = 10_000_000;
/// Most steps of a continuation.
pub(crate) const MOST_STEPS: u64 = 100_000;
/// Most runs of a sweep.
pub(crate) const MOST_RUNS: u64 = 1_000_000;

/// The kinds of studies.
pub(crate) const STUDY_KINDS: [&str; 8] = ["kinematics", "inverse", "dynamics", "statics", "modes", "linearize", "periodic", "balance"];
const COLUMN: Shape = Name("the name of a measure or a quantity such as `rocker.tip.x`");

pub(crate) static STUDY: Table = Table {
    what: "a study",
    choices: &[one_of(&STUDY_KINDS)],
    fields: &[
        may("kinematics", Map(&RANGE), "Positions, velocities and accelerations over a range."),
        may("inverse", Map(&RANGE), "Kinematics with driver efforts and reactions."),
        may("dynamics", Map(&DYNAMICS), "Motion in time."),
        may("statics", Map(&STATICS), "Equilibrium."),
        may("modes", Map(&MODES), "Eigenvalues and shapes about a pose."),
        may("linearize", Map(&LINEARIZE), "Matrices of the linearised motion about a state."),
        may("periodic", Map(&PERIODIC), "Periodic regime."),
        may("balance", Map(&BALANCE), "Attached masses moved until the centre of mass stands still."),
        may("about", Text, "What the study is for."),
        may(
            "variant",
            Either(&[Name("the name of a variant"), List(&Name("the name of a variant"), Size::AtLeast(0))]),
            "Variants, applied in order.",
        ),
        may("set", Named(Keys::Reference, "a parameter", &ANY), "Parameters for this study."),
        may(
            "take",
            Named(Keys::Name, "a scalar of another study", &Name("a scalar of another study, `STUDY.SCALAR`")),
            "Scalars of other studies.",
        ),
        may(
            "sweep",
            Named(Keys::Reference, "a parameter", &Either(&[Map(&SPAN), List(&ANY, Size::AtLeast(1))])),
            "Parameters that run through values; several: the grid.",
        ),
        may("solve", Map(&SOLVE), "A parameter varied until a scalar meets its target."),
        may("columns", List(&COLUMN, Size::AtLeast(1)), "Columns of the CSV, in order."),
        may("undefined", List(&COLUMN, Size::AtLeast(1)), "Columns that may be undefined: their cells are blank there."),
        may(
            "scalars",
            Named(Keys::Name, "a scalar", &Formula("an expression of functionals, parameters and scalars")),
            "Numbers of the whole study.",
        ),
        may("plot", Named(Keys::Title, "a figure", &Either(&[Map(&PLOT), List(&COLUMN, Size::AtLeast(1))])), "Figures."),
        may("expect", Named(Keys::Reference, "a scalar or an expression", &Map(&EXPECT)), "What must come out; if not, exit code 1."),
    ],
};

static RANGE: Table = Table {
    what: "a range",
    choices: &[],
    fields: &[
        need(
            "over",
            Value(Want::Varies("an angle or a length of the one driver, or a time")),
            "Range: of the one driver from its start, or a time.",
        ),
        need("samples", Count(1, MOST_SAMPLES), "Number of equal intervals; one row more."),
    ],
};

static BALANCE: Table = Table {
    what: "a balance",
    choices: &[],
    fields: &[
        need(
            "move",
            List(&Name("an attached mass `body.mass`"), Size::AtLeast(1)),
            "Attached masses that are moved along the line from the body's origin through their point.",
        ),
        need(
            "over",
            Value(Want::Varies("an angle or a length of the one driver, or a time")),
            "Range: of the one driver from its start, or a time.",
        ),
        need("samples", Count(1, MOST_SAMPLES), "Number of equal intervals; one row more."),
    ],
};

static DYNAMICS: Table = Table {
    what: "a dynamics study",
    choices: &[at_most_one(&["tolerance", "step"])],
    fields: &[
        need("until", TIME, "End of the run."),
        may("every", TIME, "Output step; all steps if omitted."),
        may("tolerance", NUMBER, "Relative tolerance; 1e-8 if omitted."),
        may("step", TIME, "Fixed step, instead of a tolerance."),
        may("integrator", Word(&integrator::NAMES), "Scheme."),
        may("alpha", NUMBER, "Newmark: weight of the acceleration in the displacement. Hht: its alpha, from -1/3 to 0."),
        may("beta", NUMBER, "Newmark: weight of the acceleration in the velocity."),
        may("rho", NUMBER, "Spectral radius at infinity of generalized-alpha."),
        may("order", Count(1, 5), "Fixed order of bdf, with a fixed step."),
        may("level", Word(&["stabilized", "position", "velocity", "acceleration"]), "Constraint rows that are imposed."),
        may("coordinates", Word(&["joint", "cartesian", "minimal"]), "Coordinates."),
        may("switches", Word(&["locate", "step-over"]), "Whether switches are located."),
    ],
};

static STATICS: Table =
    Table { what: "a statics study", choices: &[], fields: &[need("from", Word(&["start"]), "Where the search begins.")] };

static MODES: Table = Table {
    what: "a modes study",
    choices: &[],
    fields: &[
        may("at", Word(&["start", "statics"]), "The pose."),
        may("damped", Flag, "Whether damping counts."),
        may("methods", List(&Word(&["library", "jacobi", "power"]), Size::AtLeast(1)), "Eigensolvers that are compared."),
    ],
};

static LINEARIZE: Table = Table {
    what: "a linearize study",
    choices: &[],
    fields: &[
        may("at", Word(&["start", "statics"]), "The state: the start with its velocities, or the rest in an equilibrium."),
        may("inputs", List(&Name("the name of a parameter"), Size::AtLeast(1)), "Parameters that are inputs."),
        may("write", List(&Word(&["json", "csv", "mat"]), Size::AtLeast(1)), "Files beside the JSON, which always holds the matrices."),
    ],
};

static PERIODIC: Table = Table {
    what: "a periodic study",
    choices: &[one_of(&["by", "through"])],
    fields: &[
        need("over", Name("the name of a measure or quantity, or `t`"), "What advances by one period."),
        may("by", ANY, "By how much."),
        may("through", ANY, "With `over: t`, instead of `by`: an expression; a period ends where it rises through 0 again."),
        need("of", Name("the name of a measure or quantity"), "Whose mean and extremes are found."),
        may("samples", Count(1, MOST_SAMPLES), "Number of equal intervals of the rows; 360 if omitted."),
        may("tolerance", NUMBER, "Relative tolerance; 1e-12 if omitted."),
        may("settle", TIME, "Run before the search; until two periods are alike if omitted, 0: the start is the guess."),
        may("coordinates", Word(&["joint", "cartesian"]), "Coordinates."),
        may("from", Map(&CONTINUED), "A parameter along which the regime is followed to its value in the study."),
    ],
};

static CONTINUED: Table = Table {
    what: "a continuation",
    choices: &[],
    fields: &[
        need("vary", Name("the name of a parameter"), "The parameter."),
        need("at", ANY, "Its value at the begin."),
        may("steps", Count(1, MOST_STEPS), "Number of equal steps; 10 if omitted."),
    ],
};

static SPAN: Table = Table {
    what: "a span of values",
    choices: &[],
    fields: &[
        need("from", ANY, "First value."),
        need("to", ANY, "Last value."),
        need("count", Count(1, MOST_RUNS), "Number of values."),
        may("spacing", Word(&["linear", "log"]), "Equal differences or equal ratios."),
    ],
};

static SOLVE: Table = Table {
    what: "a solve",
    choices: &[],
    fields: &[
        need("vary", Name("the name of a parameter"), "The parameter."),
        need("between", List(&ANY, Size::Exactly(2)), "Its bounds."),
        need("target", Named(Keys::Reference, "a scalar", &ANY), "The scalar and its target."),
    ],
};

static PLOT: Table = Table {
    what: "a figure",
    choices: &[],
    fields: &[
        need("show", List(&COLUMN, Size::AtLeast(1)), "What is drawn."),
        may("over", COLUMN, "What it is drawn over; the independent variable if omitted."),
        may("in", Text, "Unit of the horizontal axis."),
    ],
};

static EXPECT: Table = Table {
    what: "an expectation",
    choices: &[one_of(&["within", "relative"])],
    fields: &[
        need("is", ANY, "The value."),
        may("within", ANY, "Largest absolute difference."),
        may("relative", NUMBER, "Largest difference relative to the value."),
    ],
};
