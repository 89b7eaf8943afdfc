//! The lowest modes of a mechanism of many bodies, by sparse matrices on the tree on which these are.

use super::damped::{Damped, by_largest};
use super::picture::picture;
use super::report::{BALANCED, DRAWN, Report, Undamped};
use super::rest::held_start;
use super::round_off::{self, ROUND_OFF, of_work};
use crate::dynamics::Differentiable;
use crate::geometry::Space;
use crate::kinematics::beside::{Beside, state_beside};
use crate::kinematics::bounded::assembled_for_gauges;
use crate::kinematics::coordinates::Coordinate;
use crate::kinematics::crossing::change_point;
use crate::kinematics::held::Pose;
use crate::kinematics::lowest::{self, Lowest};
use crate::kinematics::lowest_damped::{DampedMotion, LowestDamped, growing, lowest_damped};
use crate::kinematics::partition::without_mass;
use crate::kinematics::pencil::{HeldSparse, POTENTIAL, Pencil};
use crate::kinematics::undefined::not_finite;
use crate::model::{Eigensolver, Model, Modes};
use crate::results::{Failure, Finding};
use crate::studies::common::case::Case;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::stops::taken_as_free;
use crate::studies::statics::{Still, equilibrium_of_many};
use grashof_solvers::{Block, Line};
use nalgebra::{Complex, DVector};

/// Bodies from which on the lowest modes alone are found, by sparse matrices, unless the study says otherwise; and how many.
const MANY: usize = 100;
const LOWEST: usize = 12;
/// Part of the metric below which a motion moves no mass.
const MASSLESS: f64 = 1e-13;
/// |μ| of a free motion, as part of the largest, up to which it is 0: a double one, and so known to half of the digits.
const RIGID: f64 = 1e-7;
/// How far another pose that the constraints cannot tell from one may be off, rad or sizes, where that one is not called nearly singular.
const LOOSE: f64 = 1e-12;
/// Re μ below this part of |μ| is round-off.
const UNDAMPED: f64 = 1e-10;

/// Whether a study wants the lowest modes by sparse matrices.
pub(super) fn is_asked(model: &Model, asked: &Modes) -> bool {
    match asked.methods[..] {
        [] => model.bodies.len() > MANY,
        [Eigensolver::Lanczos] => true,
        _ => false,
    }
}

/// Runs a study of modes; none if forces have no potential, or if with damping C is not symmetric or there are first-order states.
///
/// # Errors
/// As those of few bodies, and if the iteration does not converge.
pub(super) fn run<G>(case: Case<'_>, asked: &Modes, stop: &dyn Fn() -> bool) -> Result<Option<Outcome>, Failure>
where
    G: Space<S = f64>,
{
    let Case { model, study, parameters, .. } = case;
    let (mechanism, start) = assembled_for_gauges::<G>(model, parameters)?;
    let mechanism = Differentiable::new(mechanism);
    if asked.damped && !mechanism.state_starts.is_empty() {
        return Ok(None);
    }
    let rest = if asked.at_equilibrium {
        let Some(rest) = equilibrium_of_many::<G>(case, &mechanism, &start, stop)? else { return Ok(None) };
        rest
    } else {
        held_start(&mechanism, &start)
    };
    let Still { q, z, modes, mut findings } = rest;
    findings.extend(taken_as_free(model, &mechanism, [&q, &vec![0.0; mechanism.nv]], &modes, start.size));
    findings.extend(change_point(&mechanism, &q, &modes, (&start.metric, start.size), &study.place));
    let pose = Pose { q: &q, z: &z, modes: &modes };
    let held = HeldSparse::new(model, &mechanism, pose, &start.metric).map_err(|_| not_finite(model, &mechanism, pose))?;
    let own: Vec<Coordinate> = held.independent.iter().map(|(c, _)| c.clone()).collect();
    let HeldSparse { pencil, independent, .. } = &held;
    if let Some(x) = lowest::without_mass(pencil, MASSLESS) {
        let name = independent.get(shape(independent, &x).iamax()).map_or("", |(c, _)| &c.name);
        return Err(without_mass(name, &study.place));
    }
    if pencil.circulation() > POTENTIAL || asked.damped && pencil.asymmetry(&pencil.damping) > POTENTIAL {
        return Ok(None);
    }
    let mut report = Report { study, own: &own, lists: Vec::new(), shapes: Vec::new(), findings };
    // an equilibrium that was searched for has been judged there
    if !asked.at_equilibrium {
        let way = |c: &Coordinate| if c.turns { 1.0 } else { start.size };
        report.balance(held.unbalanced.iter().zip(own.iter().map(|c| BALANCED * held.work / way(c))));
    }
    let wanted = asked.lowest.unwrap_or(LOWEST);
    let other = state_beside(&mechanism, [&q, &vec![0.0; mechanism.nv]], &modes, &start.metric, start.size);
    let not_found = || not_found(stop, other.as_ref());
    let Lowest { values, mut vectors, mut steps } = lowest::lowest(pencil, wanted, stop).ok_or_else(not_found)?;
    report.findings.extend(other.as_ref().and_then(|other| {
        let there = HeldSparse::new(model, &mechanism, Pose { q: &other.q, ..pose }, &start.metric).ok()?;
        other_eigenvalues(other, [&held, &there], (&values, &vectors), &study.place)
    }));
    report.list("eigenvalues", "1/s^2", values.clone());
    report.list("eigenvalues_lanczos", "1/s^2", values.clone());
    let others = round_off::by_others(&values);
    let modes: Vec<Undamped> = values.iter().zip(&mut vectors).map(|(&value, x)| mode(&held, start.size, value, x, others)).collect();
    let (frequencies, drawn) = if asked.damped {
        let LowestDamped { mut motions, omega, steps: more } = damped_of(pencil, wanted, &modes, stop).ok_or_else(not_found)?;
        steps += more;
        let free: Vec<&Vec<f64>> = modes.iter().zip(&vectors).filter(|(mode, _)| mode.is_free()).map(|(_, x)| x).collect();
        let count = growing(pencil);
        rounded(&mut motions, omega, &free);
        if count == Some(0) {
            // where nothing grows, growth is round-off
            motions.iter_mut().for_each(|motion| motion.value.re = motion.value.re.min(0.0));
        }
        let damped = |motion: &DampedMotion| Damped { value: motion.value, shape: by_largest(&shape(independent, &motion.vector)) };
        let found: Vec<Damped> = motions.iter().map(damped).collect();
        let frequencies = report.damped(&found, wanted);
        growth(&mut report, count, found.iter().filter(|mode| mode.grows()).count());
        (frequencies, motions.iter().map(|motion| motion.vector.iter().map(|x| x.re).collect()).collect())
    } else {
        (report.frequencies(&modes), vectors)
    };
    report.list("steps_lanczos", "", vec![steps as f64]);
    if own.len() > frequencies.len() {
        let message = format!("these are the {} lowest of {} modes; `lowest` asks for more", frequencies.len(), own.len());
        report.finding("lowest-modes", message);
    }
    let mut closing = pencil.closing();
    let mut close = |phi: &[f64]| closing.as_mut().map_or_else(|| vec![0.0; mechanism.nv], |kkt| Pencil::closed(kkt, phi));
    let scenes = drawn
        .into_iter()
        .take(if case.drawn { DRAWN } else { 0 })
        .map(|x| picture(case, &mechanism, pose, &DVector::from_vec(x), &mut close))
        .collect();
    Ok(Some(report.outcome(case, &mechanism, &frequencies, held.residual, scenes)))
}

/// That other eigenvalues belong to a pose which the constraints cannot tell from this one: of each of these, with its vector x (nv), to
/// first order
///
/// ```text
/// xᵀMx Δλ = xᵀ(ΔK − λ ΔM) x + 2 μᵀΔG x,   K x + Gᵀμ = λ M x
/// ```
fn other_eigenvalues(
    other: &Beside,
    [held, there]: [&HeldSparse; 2],
    (values, vectors): (&[f64], &[Vec<f64>]),
    place: &str,
) -> Option<Finding> {
    if held.ways != there.ways {
        return None;
    }
    let (here, there) = (&held.pencil, &there.pencil);
    let mut closing = here.closing();
    let of = |matrix: &Block, y: &[f64], x: &[f64]| matrix.lines().zip(y).map(|(line, y)| y * along(&line, x)).sum::<f64>();
    let moved = values.iter().zip(vectors).map(|(&value, x)| {
        let borne = here.mass.lines().zip(here.stiffness.lines()).map(|(m, k)| value * along(&m, x) - along(&k, x));
        let (mut a, mut mu) = (vec![0.0; x.len()], vec![0.0; here.row_scale.len()]);
        if let Some(kkt) = &mut closing {
            kkt.solve(&borne.collect::<Vec<f64>>(), &vec![0.0; mu.len()], &mut a, &mut mu);
        }
        let all = |p: &Pencil| of(&p.stiffness, x, x) - value * of(&p.mass, x, x) + 2.0 * of(&p.rows, &mu, x);
        value + (all(there) - all(here)) / of(&here.mass, x, x)
    });
    let complex = |x: f64| Complex::new(x, 0.0);
    let there: Vec<Complex<f64>> = moved.map(complex).collect();
    let here: Vec<Complex<f64>> = values.iter().copied().map(complex).collect();
    other.other_eigenvalues([&here, &there], "1/s^2", |x| x, place)
}

/// A row of a matrix times a vector.
fn along(line: &Line<'_, f64>, x: &[f64]) -> f64 {
    line.entries().map(|(j, k)| k * x[j]).sum()
}

/// A mode by its vector (nv), which is turned so that its largest coordinate is positive; `others` is round-off by the other modes.
fn mode(held: &HeldSparse, size: f64, value: f64, x: &mut [f64], others: f64) -> Undamped {
    let HeldSparse { pencil, independent, .. } = held;
    let mut shape = shape(independent, x);
    let largest = shape.iter().fold(0.0, |m: f64, x| if x.abs() > m.abs() * (1.0 + 1e-9) { *x } else { m });
    if largest < 0.0 {
        shape.neg_mut();
        x.iter_mut().for_each(|x| *x = -*x);
    }
    let line = |(line, xi): (grashof_solvers::Line<'_, f64>, &f64)| xi.abs() * line.entries().map(|(j, k)| (k * x[j]).abs()).sum::<f64>();
    let noise = pencil.stiffness.lines().zip(x.iter()).map(line).sum::<f64>();
    let made_of: f64 = pencil.grain.iter().zip(x.iter()).map(|(grain, x)| grain * x * x).sum();
    let parts = independent.iter().zip(shape.iter()).map(|((c, _), x)| if c.turns { *x } else { x / size });
    let noise = others + ROUND_OFF * (noise + made_of) + of_work(held.work, parts);
    Undamped { value, shape, noise }
}

/// The lowest damped motions beside undamped modes, whose frequencies say where they are to be sought.
fn damped_of(pencil: &Pencil, wanted: usize, modes: &[Undamped], stop: &dyn Fn() -> bool) -> Option<LowestDamped> {
    let held = modes.iter().filter(|mode| !mode.is_free());
    lowest_damped(pencil, wanted, held.map(|mode| mode.value.abs()).min_by(f64::total_cmp), stop)
}

/// Gives motions of free ones (nv each) the eigenvalue 0, which is double where nothing slows them down; what damps less than round-off
/// does not damp.
fn rounded(motions: &mut [DampedMotion], omega: f64, free: &[&Vec<f64>]) {
    let size = motions.iter().fold(omega, |m, motion| m.max(motion.value.norm()));
    let at_rest = motions.iter_mut().take(2 * free.len()).take_while(|motion| motion.value.norm() <= RIGID * size);
    for (motion, x) in at_rest.zip(free.iter().cycle()) {
        *motion = DampedMotion { value: Complex::default(), vector: x.iter().map(|x| Complex::from(*x)).collect() };
    }
    for value in motions.iter_mut().map(|motion| &mut motion.value).filter(|value| value.re.abs() <= UNDAMPED * value.norm()) {
        value.re = 0.0;
    }
}

/// That more motions grow than are listed, or that these cannot be counted.
fn growth(report: &mut Report<'_>, all: Option<usize>, listed: usize) {
    match all {
        Some(all) if all > listed => report.finding(
            "unstable",
            format!("{all} motions leave the pose (as many as the stiffness has negative eigenvalues), {listed} of them are listed; `lowest` asks for more"),
        ),
        Some(_) => {}
        None => report.finding(
            "not-counted",
            "a load or damper drives some motion on instead of slowing it down: motions that grow may lie above these modes; `methods: [library]` lists all".into(),
        ),
    }
}

/// The independent coordinates of a vector (nv).
fn shape<T>(independent: &[(Coordinate, Vec<(usize, f64)>)], x: &[T]) -> DVector<T>
where
    T: nalgebra::Scalar + Copy + std::ops::Mul<f64, Output = T> + std::iter::Sum,
{
    DVector::from_iterator(independent.len(), independent.iter().map(|(_, line)| line.iter().map(|(j, s)| x[*j] * *s).sum()))
}

/// The iteration for the lowest modes has been stopped, or does not converge; `beside` is another pose that the constraints cannot tell from
/// the one at hand.
fn not_found(stop: &dyn Fn() -> bool, beside: Option<&Beside>) -> Failure {
    if stop() {
        return Failure::interrupted();
    }
    if let Some(Beside { far, .. }) = beside.filter(|beside| beside.far > LOOSE) {
        return Failure::numerical(
            format!(
                "the lowest modes cannot be found: so near to a singular position the constraints hold the pose to {far:.0e} rad, or sizes of the mechanism, only"
            ),
            "take a pose farther from the singular one",
        );
    }
    Failure::numerical(
        "the lowest modes cannot be found: the iteration does not converge",
        "look for a stiffness that is too large for the masses that it acts on, ask for other numbers of modes by `lowest`, or for all by `methods: [library]`",
    )
}
