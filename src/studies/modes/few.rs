//! Modes of a mechanism of few bodies: all of them, by full matrices and several methods.

use super::damped::{Damped, beside, state_matrix};
use super::eigen::{self, Eigen};
use super::free::Free;
use super::report::{BALANCED, DRAWN, Report, Undamped};
use super::rest::held_start;
use super::round_off::{self, OF_WORK, ROUND_OFF, of_work};
use super::{jacobi, lanczos, picture, power};
use crate::dynamics::{Differentiable, Linearizer};
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::beside::state_beside;
use crate::kinematics::coordinates::{Coordinate, coordinates};
use crate::kinematics::crossing::change_point;
use crate::kinematics::held::{Held, Pose};
use crate::kinematics::partition::{preferred, with_mass};
use crate::kinematics::pencil::POTENTIAL;
use crate::kinematics::undefined::{assembled, not_finite};
use crate::mechanism::Coordinates;
use crate::model::{Eigensolver, Modes};
use crate::numerics::eigenvalues::eigenvalues;
use crate::results::{Failure, Finding};
use crate::studies::common::case::Case;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::sides::{self, Difference};
use crate::studies::common::stops::taken_as_free;
use crate::studies::statics::{Still, equilibrium};
use nalgebra::{DMatrix, DVector};

/// Relative difference above which methods disagree.
const AGREE: f64 = 1e-8;

/// Runs a study of modes by full matrices.
///
/// # Errors
/// If the mechanism cannot be assembled, has no equilibrium, or moves without mass.
pub(super) fn run<G>(case: Case<'_>, asked: &Modes, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    let Case { model, study, parameters, .. } = case;
    let (mechanism, start) = assembled::<G>(model, parameters, Coordinates::Joint)?;
    let mechanism = Differentiable::new(mechanism);
    let rest = if asked.at_equilibrium { equilibrium::<G>(case, &mechanism, &start, stop)? } else { held_start(&mechanism, &start) };
    let Still { q, z, modes, mut findings } = rest;
    findings.extend(taken_as_free(model, &mechanism, [&q, &vec![0.0; mechanism.nv]], &modes, start.size));
    findings.extend(change_point(&mechanism, &q, &modes, (&start.metric, start.size), &study.place));
    let pose = Pose { q: &q, z: &z, modes: &modes };
    let held = Held::new(&mechanism, &mut Linearizer::new(&mechanism), pose, &start.metric, &preferred(&mechanism))
        .map_err(|_| not_finite(model, &mechanism, pose))?;
    let all = coordinates(model, &mechanism);
    let own: Vec<Coordinate> = held.partition.independent.iter().map(|&i| all[i].clone()).collect();
    let names: Vec<String> = own.iter().map(|c| c.name.clone()).collect();
    with_mass(&held.mass, &held.partition, &start.metric, &names, &study.place)?;

    let mut report = Report { study, own: &own, lists: Vec::new(), shapes: Vec::new(), findings };
    let ways = DVector::from_iterator(own.len(), own.iter().map(|c| if c.turns { 1.0 } else { start.size }));
    // an equilibrium that was searched for has been judged there
    if !asked.at_equilibrium {
        // what a way of this part of a radian or of the size would change, and this part of what adds up, is round-off
        let rounded = ways.map(|way| OF_WORK * held.acting / way);
        let noise = (&held.round_off * &ways + &held.forces) * BALANCED + rounded;
        report.balance(held.unbalanced.iter().zip(noise.iter().copied()));
    }
    report.findings.extend(other_eigenvalues(case, &mechanism, &start, pose, asked.damped, &held));
    report.findings.extend(one_sided(case, &mechanism, &start, pose, asked.damped, (&held, &ways)));
    let wanted = asked.lowest.unwrap_or(own.len()).min(own.len());
    let potential = held.circulation() <= POTENTIAL;
    let mut drawn: Vec<DVector<f64>> = Vec::new();
    let mut frequencies = Vec::new();
    if potential
        && let Some(found) = undamped(&mut report, &held, &ways, &asked.methods, wanted, stop)
        && !asked.damped
    {
        frequencies = report.frequencies(&found);
        report.lowest(frequencies.len(), own.len());
        drawn = found.into_iter().map(|mode| mode.shape).collect();
    }
    if !potential || asked.damped {
        let a = state_matrix(&held, asked.damped).ok_or_else(too_unlike)?;
        let found = beside(&Free::new(&held, &ways, asked.damped), &a, names.len()).ok_or_else(beyond)?;
        if !potential {
            report.circulates(held.circulation());
        }
        frequencies = report.damped(&found, asked.lowest.unwrap_or(found.len()));
        report.lowest(frequencies.len(), found.len());
        drawn = found.iter().take(frequencies.len()).map(|d: &Damped| d.shape.map(|x| x.re)).collect();
    }
    let close = |phi: &[f64]| held.partition.follow(&DMatrix::from_column_slice(phi.len(), 1, phi)).as_slice().to_vec();
    let scenes = drawn
        .iter()
        .take(if case.drawn { DRAWN } else { 0 })
        .map(|x| picture::picture(case, &mechanism, pose, &(&held.partition.p * x), close))
        .collect();
    Ok(report.outcome(case, &mechanism, &frequencies, held.residual, scenes))
}

/// That other eigenvalues belong to a pose which the constraints cannot tell from this one.
fn other_eigenvalues<G: Space<S = f64>>(
    case: Case<'_>,
    m: &Differentiable<G>,
    start: &Assembled,
    pose: Pose<'_>,
    damped: bool,
    held: &Held,
) -> Option<Finding> {
    let other = state_beside(m, [pose.q, &vec![0.0; m.nv]], pose.modes, &start.metric, start.size)?;
    let pose = Pose { q: &other.q, ..pose };
    let there = Held::new(m, &mut Linearizer::new(m), pose, &start.metric, &held.partition.independent).ok()?;
    if damped {
        let [here, there] = [eigenvalues(&state_matrix(held, true)?)?, eigenvalues(&state_matrix(&there, true)?)?];
        return other.other_eigenvalues([&here, &there], "1/s", |p| p * p, &case.study.place);
    }
    let values = |held: &Held| eigenvalues(&held.mass.clone().cholesky()?.solve(&held.stiffness));
    other.other_eigenvalues([&values(held)?, &values(&there)?], "1/s^2", |x| x, &case.study.place)
}

/// That the pose is in a kink of a law, so that the modes are those of one side; `ways` (n) are 1 rad or the size of the mechanism.
fn one_sided<G: Space<S = f64>>(
    case: Case<'_>,
    m: &Differentiable<G>,
    start: &Assembled,
    pose: Pose<'_>,
    damped: bool,
    (held, ways): (&Held, &DVector<f64>),
) -> Option<Finding> {
    let motions = sides::weights(ways.len()).map(|y| (&held.partition.p * DVector::from_vec(y).component_mul(ways)).as_slice().to_vec());
    let by_ways = |x: &DMatrix<f64>| DMatrix::from_fn(x.nrows(), x.ncols(), |i, j| ways[i] * x[(i, j)] * ways[j]);
    let rest = vec![0.0; m.nv];
    let others = sides::beside(m, [pose.q, &rest, pose.z], pose.modes, &motions);
    others.iter().find_map(|modes| {
        let there = Held::new(m, &mut Linearizer::new(m), Pose { modes, ..pose }, &start.metric, &held.partition.independent).ok()?;
        let stiffness = sides::change([&held.stiffness, &there.stiffness].map(by_ways).each_ref());
        let damping = if damped { sides::change([&held.damping, &there.damping].map(by_ways).each_ref()) } else { 0.0 };
        let jump = (&held.unbalanced - &there.unbalanced).component_mul(ways).amax();
        let size = f64::max(held.forces.dot(ways), there.forces.dot(ways));
        let force = if jump > 0.0 { jump / size } else { 0.0 };
        sides::one_sided(case.model, [pose.modes, modes], Difference { force, slope: stiffness.max(damping) }, &case.study.place)
    })
}

/// Modes by all methods; the first one's. `ways` are 1 rad or the size of the mechanism.
fn undamped(
    report: &mut Report<'_>,
    held: &Held,
    ways: &DVector<f64>,
    methods: &[Eigensolver],
    wanted: usize,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Undamped>> {
    let k = (&held.stiffness + held.stiffness.transpose()) * 0.5;
    let mut first: Option<(Eigensolver, Eigen)> = None;
    for &method in if methods.is_empty() { &[Eigensolver::Library] } else { methods } {
        let found = match method {
            Eigensolver::Library => eigen::library(&k, &held.mass),
            Eigensolver::Jacobi => jacobi::jacobi(&k, &held.mass),
            Eigensolver::Power => power::power(&k, &held.mass),
            Eigensolver::Lanczos => lanczos::full(&k, &held.mass, wanted, stop),
        };
        let Some(found) = found.map(|found| found.lowest(wanted)) else {
            report.finding("not-converged", format!("the method `{}` has not converged", method.name()));
            continue;
        };
        if let Some((other, first)) = &first {
            let size = first.values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let off = |(a, b): (&f64, &f64)| (a - b).abs() > AGREE * a.abs() + ROUND_OFF * size;
            if let Some(i) = first.values.iter().zip(&found.values).position(off) {
                let (a, b, other) = (first.values[i], found.values[i], other.name());
                let message = format!("eigenvalue {} is {a:e} by `{other}` and {b:e} by `{}`", i + 1, method.name());
                report.finding("methods-disagree", message);
            }
        } else {
            report.list("eigenvalues", "1/s^2", found.values.clone());
        }
        if method != Eigensolver::Library || first.is_some() {
            report.list(format!("eigenvalues_{}", method.name()), "1/s^2", found.values.clone());
        }
        match method {
            Eigensolver::Jacobi => report.list("sweeps_jacobi", "", vec![found.iterations as f64]),
            Eigensolver::Power => report.list("steps_power", "", vec![found.iterations as f64]),
            Eigensolver::Lanczos => report.list("steps_lanczos", "", vec![found.iterations as f64]),
            Eigensolver::Library => {}
        }
        first.get_or_insert((method, found));
    }
    let (_, found) = first?;
    let others = round_off::by_others(&found.values);
    let mode = |(&value, x): (&f64, nalgebra::DVectorView<'_, f64>)| {
        let sizes = x.abs();
        let made_of = sizes.dot(&(&held.round_off * &sizes)) + held.forces.component_div(ways).dot(&sizes.component_mul(&sizes));
        let noise = others + ROUND_OFF * made_of + of_work(held.forces.dot(ways) + held.acting, x.iter().zip(ways).map(|(x, way)| x / way));
        Undamped { value, noise, shape: x.into_owned() }
    };
    Some(found.values.iter().zip(found.vectors.column_iter()).map(mode).collect())
}

/// Forces and masses give no eigenvalues in numbers of a computer.
fn beyond() -> Failure {
    Failure::numerical(
        "the eigenvalues cannot be found: a stiffness or damping is too large for the masses that it acts on",
        "look for a value of the wrong unit or sign among springs, dampers and masses",
    )
}

/// The masses leave no digits for the lightest motion.
fn too_unlike() -> Failure {
    Failure::numerical(
        "the masses of the independent motions differ by more than the digits of a number",
        "give every moving body a mass and an inertia that matter",
    )
}
