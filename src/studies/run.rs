//! One run of a study of any kind.

use super::common::case::Case;
use super::{driven, dynamics, linearize, modes, periodic, statics};
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::Coordinates;
use crate::model::{Dimensions, Kind, Model, Study};
use crate::results::{Failure, Finding};
use crate::studies::common::outcome::Outcome;

/// Runs a study once, whatever its kind.
///
/// # Errors
/// If it never began: the model has no mechanism, it cannot be assembled, or its drivers do not fit. A motion that stops on its
/// way is an [`Outcome`] with `stopped`. A motion in time asks `stop` between its steps.
pub fn run(case: Case<'_>, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure> {
    run_in(case, Coordinates::Joint, stop)
}

/// [`run`], where a study that its drivers prescribe is computed in given coordinates; all others take those that they name.
///
/// # Errors
/// As there.
pub fn run_in(case: Case<'_>, coordinates: Coordinates, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure> {
    let mut outcome = match case.model.space {
        Dimensions::Planar => in_space::<Planar<f64>>(case, coordinates, stop)?,
        Dimensions::Spatial => in_space::<Spatial<f64>>(case, coordinates, stop)?,
    };
    outcome.certificate.undeclared = case.model.pool.externals_called().iter().filter(|function| !function.is_declared()).count();
    outcome.findings.extend(from_outside(case.model, case.study));
    outcome.findings.extend(forgotten_mass(case.model, case.study));
    Ok(outcome)
}

/// What a reader should know of functions from outside.
fn from_outside(model: &Model, study: &Study) -> Vec<Finding> {
    let finding = |code: &'static str, message: String| Finding { code: code.into(), message, path: study.place.clone() };
    let mut findings = Vec::new();
    for function in model.pool.externals_called() {
        let name = function.name();
        findings
            .push(finding("from-outside", format!("`{name}` is computed outside of the program, which takes longer than an expression")));
        if !function.is_declared() {
            findings.push(finding(
                "unresolved",
                format!("the switches of `{name}`, if it has any, are not declared: none is located, and what depends on one may be wrong"),
            ));
        }
    }
    findings
}

/// Most bodies that a finding names.
const NAMED: usize = 3;

/// That the model says nothing of the mass of bodies whose mass counts in a study.
fn forgotten_mass(model: &Model, study: &Study) -> Option<Finding> {
    let weighs = !model.attractions.is_empty() || model.gravity.iter().any(|&g| model.pool.constant_value(g) != Some(0.0));
    let counts = match study.kind {
        Kind::Kinematics(_) => false,
        Kind::Statics => weighs,
        _ => true,
    };
    let moving = &model.bodies[1..];
    let missing: Vec<String> = moving.iter().filter(|body| !body.mass_is_said()).map(|body| format!("`{}`", body.name)).collect();
    if !counts || missing.is_empty() || !weighs && missing.len() == moving.len() {
        return None;
    }
    let named = missing[..missing.len().min(NAMED)].join(", ");
    let (who, whose) = match missing.len() {
        1 => (format!("{named} has"), "its"),
        n if n > NAMED => (format!("{named} and {} more bodies have", n - NAMED), "their"),
        _ => (format!("{named} have"), "their"),
    };
    Some(Finding {
        code: "no-mass".into(),
        message: format!("{who} no mass, so that {whose} weight and inertia do not count; give `mass`, or `mass: 0` if that is meant"),
        path: study.place.clone(),
    })
}

/// The kinds of studies.
fn in_space<G>(case: Case<'_>, coordinates: Coordinates, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    match &case.study.kind {
        Kind::Kinematics(range) | Kind::Inverse(range) | Kind::Balance { range, .. } => driven::run::<G>(case, range, coordinates),
        Kind::Dynamics(motion) => dynamics::run::<G>(case, motion, stop),
        Kind::Statics => statics::run::<G>(case, stop),
        Kind::Modes(asked) => modes::run::<G>(case, asked, stop),
        Kind::Linearize(asked) => linearize::run::<G>(case, asked, stop),
        Kind::Periodic(asked) => periodic::run::<G>(case, asked, stop),
    }
}
