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
use crate::kinematics::partition::{MASSLESS, without_mass};
use crate::kinematics::pencil::{HeldSparse, POTENTIAL, Pencil};
use crate::kinematics::undefined::not_finite;
use crate::model::{Eigensolver, Model, Modes};
use crate::results::{Failure, Finding};
use crate::studies::common::case::Case;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::sides::{self, Difference};
use crate::studies::common::stops::taken_as_free;
use crate::studies::statics::{Still, equilibrium_of_many};
use grashof_solvers::{Block, Line};
use nalgebra::{Complex, DMatrix, DVector};

/// Bodies from which on the lowest modes alone are found, by sparse matrices, unless the study says otherwise; and how many.
const MANY: usize = 100;
const LOWEST: usize = 12;
/// |μ| of a free motion, as part of the largest, up to which it is 0: a double one, and so known to half of the digits.
const RIGID: f64 = 1e-7;
/// How far another pose that the constraints cannot tell from one may be off, rad or sizes, where that one is not called nearly singular.
const LOOSE: f64 = 1e-12;
/// The square of the round-off of a vector.
const SQUARED: f64 = 1e-14;
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
    report.findings.extend(one_sided(case, &mechanism, (pose, &start.metric), asked.damped, (&held, &modes, &vectors)));
    let (frequencies, drawn) = if asked.damped {
        let LowestDamped { mut motions, omega, steps: more } = damped_of(pencil, wanted, &modes, stop).ok_or_else(not_found)?;
        steps += more;
        let free: Vec<&Vec<f64>> = modes.iter().zip(&vectors).filter(|(mode, _)| mode.is_free()).map(|(_, x)| x).collect();
        let count = growing(pencil);
        rounded(pencil, &mut motions, omega, &free);
        motions.truncate(wanted);
        if count == Some(0) {
            // where nothing grows, growth is round-off
            motions.iter_mut().for_each(|motion| motion.value.re = motion.value.re.min(0.0));
        }
        let damped = |motion: &DampedMotion| Damped { value: motion.value, shape: by_largest(&shape(independent, &motion.vector)) };
        let found: Vec<Damped> = motions.iter().map(damped).collect();
        let frequencies = report.damped(&found, wanted);
        report.lowest_of(&found, own.len());
        growth(&mut report, count, found.iter().filter(|mode| mode.grows()).count());
        (frequencies, motions.iter().map(|motion| motion.vector.iter().map(|x| x.re).collect()).collect())
    } else {
        let frequencies = report.frequencies(&modes);
        report.lowest(frequencies.len(), own.len());
        (frequencies, vectors)
    };
    report.list("steps_lanczos", "", vec![steps as f64]);
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

/// That the pose is in a kink of a law, so that the modes, with their vectors (nv each), are those of one side: to first order.
fn one_sided<G: Space<S = f64>>(
    case: Case<'_>,
    m: &Differentiable<G>,
    (pose, metric): (Pose<'_>, &[f64]),
    damped: bool,
    (held, modes, vectors): (&HeldSparse, &[Undamped], &[Vec<f64>]),
) -> Option<Finding> {
    let mut closing = held.pencil.closing()?;
    let unit = m.units(m.size());
    let motions = sides::weights(m.nv).map(|weights| {
        let force: Vec<f64> = weights.iter().zip(unit.iter().zip(metric)).map(|(y, (unit, d))| y * unit * d).collect();
        let (zeros, mut x) = (vec![0.0; held.pencil.row_scale.len()], vec![0.0; m.nv]);
        closing.solve(&force, &zeros, &mut x, &mut zeros.clone());
        x
    });
    let along = |matrix: &Block, x: &[f64]| matrix.lines().zip(x).map(|(line, y)| y * along(&line, x)).sum::<f64>();
    let part = |change: f64, size: f64| if change == 0.0 { 0.0 } else { change.abs() / size };
    sides::beside(m, [pose.q, &vec![0.0; m.nv], pose.z], pose.modes, &motions).iter().find_map(|other| {
        let there = HeldSparse::new(case.model, m, Pose { modes: other, ..pose }, metric).ok().filter(|there| there.ways == held.ways)?;
        let slopes = modes.iter().zip(vectors).map(|(mode, x)| {
            let change = |matrix: fn(&Pencil) -> &Block| along(matrix(&there.pencil), x) - along(matrix(&held.pencil), x);
            let [stiffer, resisted] = [change(|p| &p.stiffness), if damped { change(|p| &p.damping) } else { 0.0 }];
            let beside = mode.value.abs().max((mode.value + stiffer).abs()).max(mode.noise);
            let damps = f64::max(along(&held.pencil.damping, x).abs(), along(&there.pencil.damping, x).abs());
            part(stiffer, beside).max(part(resisted, damps.max(beside.sqrt())))
        });
        let slope = slopes.fold(0.0, f64::max);
        let jump = held.unbalanced.iter().zip(&there.unbalanced).zip(&held.independent);
        let jump = jump.map(|((here, there), (c, _))| (here - there).abs() * if c.turns { 1.0 } else { m.size() }).fold(0.0, f64::max);
        let differ = Difference { force: part(jump, held.work.max(there.work)), slope };
        sides::one_sided(case.model, [pose.modes, other], differ, &case.study.place)
    })
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

/// Gives motions of free ones (nv each) the eigenvalue 0, which is double where nothing slows them down; what damps less than round-off does
/// not damp.
fn rounded(pencil: &Pencil, motions: &mut Vec<DampedMotion>, omega: f64, free: &[&Vec<f64>]) {
    let size = motions.iter().fold(omega, |m, motion| m.max(motion.value.norm()));
    let found = motions.iter().take(2 * free.len()).take_while(|motion| motion.value.norm() <= RIGID * size).count();
    let complex = |x: &[f64]| x.iter().map(|x| Complex::from(*x)).collect();
    let all = free.iter().cycle().take(free.len() + going_on(pencil, free));
    motions.splice(..found, all.map(|x| DampedMotion { value: Complex::default(), vector: complex(x) }));
    for value in motions.iter_mut().map(|motion| &mut motion.value).filter(|value| value.re.abs() <= UNDAMPED * value.norm()) {
        value.re = 0.0;
    }
}

/// How many of free motions (nv each) nothing slows down: XᵀCX has no more rank beside its round-off, and beside what the round-off of X has
/// of the largest damping.
fn going_on(pencil: &Pencil, free: &[&Vec<f64>]) -> usize {
    let resisted: Vec<Vec<f64>> = free.iter().map(|x| pencil.damping.lines().map(|line| along(&line, x)).collect()).collect();
    let work = DMatrix::from_fn(free.len(), free.len(), |i, j| free[i].iter().zip(&resisted[j]).map(|(x, f)| x * f).sum::<f64>());
    let made_of = |x: &Vec<f64>| -> f64 {
        pencil.damping.lines().zip(x).map(|(line, y)| y.abs() * line.entries().map(|(j, c)| (c * x[j]).abs()).sum::<f64>()).sum()
    };
    let metric = &pencil.metric;
    let size =
        |(i, line): (usize, Line<'_, f64>)| line.entries().map(|(j, c)| c.abs() / (metric[i] * metric[j]).sqrt()).fold(0.0, f64::max);
    let largest = pencil.damping.lines().enumerate().map(size).fold(0.0, f64::max);
    let noise = ROUND_OFF * free.iter().map(|x| made_of(x)).fold(0.0, f64::max) + SQUARED * largest;
    if free.is_empty() { 0 } else { work.symmetric_eigenvalues().iter().filter(|c| c.abs() <= noise).count() }
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
