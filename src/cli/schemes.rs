//! Integrators by their words, and studies with another one.

use grashof::model::{Control, Forward, Integrator, Kind, Model, Study};

/// The words of the model file.
const WORDS: [(&str, Integrator); 10] = [
    ("auto", Integrator::Auto),
    ("newmark", Integrator::Newmark),
    ("hht", Integrator::Hht),
    ("generalized-alpha", Integrator::GeneralizedAlpha),
    ("bdf", Integrator::Bdf),
    ("radau5", Integrator::Radau5),
    ("dop853", Integrator::Dop853),
    ("rk4", Integrator::Rk4),
    ("central-difference", Integrator::CentralDifference),
    ("ida", Integrator::Ida),
];

/// The word of an integrator.
pub(super) fn word(integrator: Integrator) -> &'static str {
    WORDS.iter().find(|(_, known)| *known == integrator).map_or("", |(word, _)| word)
}

/// The integrator of a word.
pub(super) fn named(word: &str) -> Option<Integrator> {
    WORDS.iter().find(|(known, _)| *known == word).map(|(_, integrator)| *integrator)
}

/// All words, for a message.
pub(super) fn words() -> String {
    WORDS.map(|(word, _)| format!("`{word}`")).join(", ")
}

/// Whether it takes accelerations and projects; `auto` begins so.
pub(super) fn is_explicit(integrator: Integrator) -> bool {
    matches!(integrator, Integrator::Auto | Integrator::Dop853 | Integrator::Rk4 | Integrator::CentralDifference)
}

/// An accurate scheme of another family: Radau IIA for explicit ones, Dormand and Prince for all others.
pub(super) fn witness(integrator: Integrator) -> Integrator {
    if is_explicit(integrator) { Integrator::Radau5 } else { Integrator::Dop853 }
}

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Steps {
    /// By a relative tolerance.
    Tolerance(f64),
    /// Fixed, s.
    Fixed(f64),
}

impl Steps {
    /// The number, whichever it is.
    pub(super) fn size(self) -> f64 {
        match self {
            Self::Tolerance(x) | Self::Fixed(x) => x,
        }
    }
}

/// A study by another integrator or with other steps, with rows every so many seconds; its numbers are added to the model's pool.
///
/// Parameters and constraint rows that belong to the study's own integrator are kept for that one alone, `order` and marching
/// across switches where steps are fixed.
pub(super) fn changed(model: &mut Model, study: &Study, forward: &Forward, by: Integrator, steps: Steps, every: Option<f64>) -> Study {
    let own = by == forward.integrator;
    let kept = |id| if own { id } else { None };
    let fixed = matches!(steps, Steps::Fixed(_));
    let control = match steps {
        Steps::Tolerance(x) => Control::Tolerance(Some(model.pool.constant(x))),
        Steps::Fixed(h) => Control::Step(model.pool.constant(h)),
    };
    let kind = Kind::Dynamics(Forward {
        until: forward.until,
        every: every.map(|x| model.pool.constant(x)).or(forward.every),
        control,
        integrator: by,
        alpha: kept(forward.alpha),
        beta: kept(forward.beta),
        rho: kept(forward.rho),
        order: if own && fixed { forward.order } else { None },
        level: if own || !is_explicit(by) { forward.level } else { None },
        chart: forward.chart,
        locate: forward.locate || !fixed,
    });
    // what is compared are columns alone
    let (scalars, functionals, plots, expect) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    Study { kind, scalars, functionals, plots, expect, ..study.clone() }
}

/// The steps of a study as it stands.
pub(super) fn steps(model: &Model, forward: &Forward, parameters: &[f64]) -> Steps {
    match forward.control {
        Control::Tolerance(id) => Steps::Tolerance(id.map_or(1e-8, |id| model.pool.value(id, parameters))),
        Control::Step(id) => Steps::Fixed(model.pool.value(id, parameters)),
    }
}
