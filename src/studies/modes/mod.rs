//! Vibrations about a held pose: the study kind `modes`.
//!
//! `held` makes M, C and K of a pose; `eigen`, `jacobi` and `power` solve K x = λ M x, `damped` the state matrix; `picture` draws. Here
//! is the whole: the pose, what the methods say of each other, lists, shapes and findings.

pub mod damped;
pub mod eigen;
pub mod jacobi;
mod picture;
pub mod power;

use super::common::case::Case;
use super::common::numbers::Sources;
use super::statics::{Still, equilibrium};
use crate::dynamics::{LANES, Linearizer};
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::coordinates::{Coordinate, coordinates};
use crate::kinematics::held::{Held, Pose, settled};
use crate::kinematics::partition::{preferred, with_mass};
use crate::kinematics::undefined::{assembled, in_state};
use crate::mechanism::{Coordinates, Mechanism};
use crate::model::{Eigensolver, Modes, Study};
use crate::results::{Certificate, Failure, Finding, List};
use crate::scalar::Dual;
use crate::studies::common::outcome::Outcome;
use damped::{Damped, damped, state_matrix};
use eigen::Eigen;
use nalgebra::{DMatrix, DVector};

/// An eigenvalue below this part of what it is the sum of is round-off: a free motion.
const ROUND_OFF: f64 = 1e-12;
/// Relative difference above which methods disagree.
const AGREE: f64 = 1e-8;
/// Unbalanced forces below this part of what they are made of are round-off.
const BALANCED: f64 = 1e-8;
/// Asymmetry of K, relative, above which forces have no potential.
const POTENTIAL: f64 = 1e-8;
/// |μ| below this part of the largest is 0, which is double for a free motion and so known to half of the digits.
const RIGID: f64 = 1e-7;
/// Re μ above this part of |μ| is growth.
const GROWS: f64 = 1e-8;
/// Modes that are drawn.
const DRAWN: usize = 12;
/// Parts of a shape that count in words, of the largest one.
const PART: f64 = 0.3;

/// The start as it would stand if it were held, with the modes that its forces have there.
pub(crate) fn held_start<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Still {
    let z = mechanism.state_starts.clone();
    let modes = settled(mechanism, [&start.q, &vec![0.0; mechanism.nv], &z], &start.modes);
    Still { q: start.q.clone(), z, modes, findings: Vec::new() }
}

/// Runs a study of modes.
///
/// # Errors
/// If the mechanism cannot be assembled, has no equilibrium, or moves without mass.
pub(crate) fn run<G>(case: Case<'_>, asked: &Modes, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
    G::Lift<Dual<LANES>>: Space<S = Dual<LANES>>,
{
    let Case { model, study, parameters, .. } = case;
    let (mechanism, start) = assembled::<G>(model, parameters, Coordinates::Joint)?;
    let lifted = mechanism.lift();
    let rest =
        if asked.at_equilibrium { equilibrium::<G>(case, &mechanism, &lifted, &start, stop)? } else { held_start(&mechanism, &start) };
    let Still { q, z, modes, findings } = rest;
    let pose = Pose { q: &q, z: &z, modes: &modes };
    let held = Held::new(&mechanism, &mut Linearizer::new(&lifted), pose, &start.metric, &preferred(&mechanism)).map_err(|_| {
        let undefined = in_state(model, &mechanism, [pose.q, &vec![0.0; mechanism.nv], pose.z], pose.modes, "the pose");
        let unknown = || Failure::numerical("a force in the pose is not a number", "look at tables and expressions of loads");
        undefined.map_or_else(unknown, Failure::Undefined)
    })?;
    let all = coordinates(model, &mechanism);
    let own: Vec<Coordinate> = held.partition.independent.iter().map(|&i| all[i].clone()).collect();
    let names: Vec<String> = own.iter().map(|c| c.name.clone()).collect();
    with_mass(&held.mass, &names, &study.place)?;

    let mut report = Report { study, names: &names, lists: Vec::new(), shapes: Vec::new(), findings };
    // an equilibrium that was searched for has been judged there
    if !asked.at_equilibrium {
        report.balance(&held, &own, start.size);
    }
    let potential = held.circulation() <= POTENTIAL;
    let mut drawn: Vec<DVector<f64>> = Vec::new();
    let mut frequencies = Vec::new();
    if potential
        && let Some(found) = report.undamped(&held, &asked.methods)
        && !asked.damped
    {
        frequencies = report.frequencies(&held, &found);
        drawn = (0..names.len()).map(|i| found.vectors.column(i).into_owned()).collect();
    }
    if !potential || asked.damped {
        let a = state_matrix(&held, asked.damped).ok_or_else(too_unlike)?;
        let found = damped(&a, names.len()).ok_or_else(beyond)?;
        if !potential {
            report.circulates(&held);
        }
        frequencies = report.damped(&found);
        drawn = found.iter().map(|d| d.shape.map(|x| x.re)).collect();
    }
    let scenes = drawn.iter().take(DRAWN).enumerate();
    let scenes = scenes.map(|(i, x)| (format!("mode-{}", i + 1), picture::picture(&mechanism, &held, pose, x))).collect();
    let results: Vec<f64> = (0..study.results.len()).map(|i| frequencies.get(i).copied().unwrap_or(f64::NAN)).collect();
    let numbers = Sources { case, tables: &mechanism.tables, functionals: &[], results: &results, works: &[] }.numbers(true);
    report.findings.extend(numbers.findings);
    Ok(Outcome {
        stopped: numbers.undefined.as_ref().map(|u| u.message.clone()),
        undefined: numbers.undefined,
        parameters: case.named(),
        scalars: numbers.scalars,
        expectations: numbers.expectations,
        results,
        lists: report.lists,
        shapes: report.shapes,
        findings: report.findings,
        certificate: Certificate { evaluations: 1, constraint: held.residual, ..Certificate::default() },
        scenes,
        ..Outcome::default()
    })
}

/// What a study says, as it is found.
struct Report<'a> {
    study: &'a Study,
    /// Independent coordinates.
    names: &'a [String],
    lists: Vec<List>,
    shapes: Vec<Vec<(String, f64)>>,
    findings: Vec<Finding>,
}

impl Report<'_> {
    fn list(&mut self, name: impl Into<String>, unit: &str, values: Vec<f64>) {
        self.lists.push(List { name: name.into(), unit: unit.into(), values });
    }

    fn finding(&mut self, code: &'static str, message: String) {
        self.findings.push(Finding { code: code.into(), message, path: self.study.place.clone() });
    }

    /// Which coordinates are held by a force, and that there is nothing to move; `size` is that of the mechanism, m.
    fn balance(&mut self, held: &Held, own: &[Coordinate], size: f64) {
        if own.is_empty() {
            self.finding("no-freedom", "joints and drivers leave no motion, so there are no modes".into());
        }
        // what a way of this part of a radian or of the size would change, and this part of what adds up, is round-off
        let ways = DVector::from_iterator(own.len(), own.iter().map(|c| if c.turns { 1.0 } else { size }));
        let noise = (&held.round_off * ways + &held.forces) * BALANCED;
        let unit = |c: &Coordinate| if c.turns { "N m" } else { "N" };
        let held_by: Vec<String> = own
            .iter()
            .zip(held.unbalanced.iter().zip(noise.iter()))
            .filter(|(_, (f, noise))| f.abs() > **noise)
            .map(|(c, (f, _))| format!("`{}` {} {}", c.name, short(*f), unit(c)))
            .collect();
        if !held_by.is_empty() {
            let message = format!(
                "the pose is no equilibrium: it is held against {}; negative eigenvalues are rates at which motions leave it, not vibrations, and all of them depend on which coordinates are held",
                held_by.join(", ")
            );
            self.finding("unbalanced", message);
        }
    }

    /// Eigenvalues by all methods; the first one's.
    fn undamped(&mut self, held: &Held, methods: &[Eigensolver]) -> Option<Eigen> {
        let k = (&held.stiffness + held.stiffness.transpose()) * 0.5;
        let mut first: Option<(Eigensolver, Eigen)> = None;
        for &method in methods {
            let Some(found) = solve(method, &k, &held.mass) else {
                self.finding("not-converged", format!("the method `{}` has not converged", word(method)));
                continue;
            };
            if let Some((other, first)) = &first {
                let size = first.values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let off = |(a, b): (&f64, &f64)| (a - b).abs() > AGREE * a.abs() + ROUND_OFF * size;
                if let Some(i) = first.values.iter().zip(&found.values).position(off) {
                    let (a, b, other) = (first.values[i], found.values[i], word(*other));
                    let message = format!("eigenvalue {} is {a:e} by `{other}` and {b:e} by `{}`", i + 1, word(method));
                    self.finding("methods-disagree", message);
                }
                self.list(format!("eigenvalues_{}", word(method)), "1/s^2", found.values.clone());
            } else {
                self.list("eigenvalues", "1/s^2", found.values.clone());
                if method != Eigensolver::Library {
                    self.list(format!("eigenvalues_{}", word(method)), "1/s^2", found.values.clone());
                }
            }
            match method {
                Eigensolver::Jacobi => self.list("sweeps_jacobi", "", vec![found.iterations as f64]),
                Eigensolver::Power => self.list("steps_power", "", vec![found.iterations as f64]),
                Eigensolver::Library => {}
            }
            first.get_or_insert((method, found));
        }
        first.map(|(_, found)| found)
    }

    /// Frequencies and shapes of undamped modes, with what their signs mean: √λ, NaN for λ < 0, 0 for a free motion.
    fn frequencies(&mut self, held: &Held, found: &Eigen) -> Vec<f64> {
        let mut frequencies = Vec::new();
        for (i, &lambda) in found.values.iter().enumerate() {
            let x = found.vectors.column(i);
            let noise = ROUND_OFF * x.abs().dot(&(&held.round_off * x.abs()));
            let free = lambda.abs() <= noise;
            self.shapes.push(self.names.iter().cloned().zip(x.iter().copied()).collect());
            if free {
                self.finding(
                    "free-motion",
                    format!("mode {} is a free motion of {}: nothing drives it back", i + 1, parts(self.names, &x.abs())),
                );
            } else if lambda < 0.0 {
                let rate = (-lambda).sqrt();
                let message = format!(
                    "mode {} is unstable, {}: it grows like exp({} t/s), by e in {} s",
                    i + 1,
                    parts(self.names, &x.abs()),
                    short(rate),
                    short(rate.recip())
                );
                self.finding("unstable", message);
            }
            frequencies.push(if free { 0.0 } else { lambda.sqrt() });
        }
        self.list("frequencies", "rad/s", frequencies.clone());
        frequencies
    }

    /// That forces have no potential.
    fn circulates(&mut self, held: &Held) {
        let message = format!(
            "forces in the pose have no potential (K is unsymmetric by {:.1e} of its size, as by a load that follows its body): the modes are those of the state matrix, and methods for symmetric matrices are left out",
            held.circulation()
        );
        self.finding("circulatory-forces", message);
    }

    /// Lists and shapes of damped modes, with what grows; their frequencies |Im μ|.
    fn damped(&mut self, found: &[Damped]) -> Vec<f64> {
        let each = |f: &dyn Fn(&Damped) -> f64| -> Vec<f64> { found.iter().map(f).collect() };
        let size = found.iter().fold(0.0_f64, |m, d| m.max(d.value.norm()));
        let frequencies = each(&|d| d.value.im);
        self.list("eigenvalues_real", "1/s", each(&|d| d.value.re));
        self.list("eigenvalues_imaginary", "1/s", each(&|d| d.value.im));
        self.list("damping_ratios", "", each(&Damped::ratio));
        self.list("frequencies", "rad/s", frequencies.clone());
        for (i, mode) in found.iter().enumerate() {
            let amplitudes = mode.shape.map(|x| x.norm());
            let named = |name: &String, x: &nalgebra::Complex<f64>| [(name.clone(), x.norm()), (format!("{name}.phase"), x.arg())];
            self.shapes.push(self.names.iter().zip(mode.shape.iter()).flat_map(|(n, x)| named(n, x)).collect());
            if mode.value.norm() <= RIGID * size {
                let message = format!("mode {} is a free motion of {}: nothing drives it back", i + 1, parts(self.names, &amplitudes));
                self.finding("free-motion", message);
            } else if mode.value.re > GROWS * mode.value.norm() {
                let message = format!(
                    "mode {} is unstable, {}: it grows like exp({} t/s)",
                    i + 1,
                    parts(self.names, &amplitudes),
                    short(mode.value.re)
                );
                self.finding("unstable", message);
            }
        }
        frequencies
    }
}

fn solve(method: Eigensolver, k: &DMatrix<f64>, m: &DMatrix<f64>) -> Option<Eigen> {
    match method {
        Eigensolver::Library => eigen::library(k, m),
        Eigensolver::Jacobi => jacobi::jacobi(k, m),
        Eigensolver::Power => power::power(k, m),
    }
}

fn word(method: Eigensolver) -> &'static str {
    match method {
        Eigensolver::Library => "library",
        Eigensolver::Jacobi => "jacobi",
        Eigensolver::Power => "power",
    }
}

/// The coordinates that move most in a shape, the largest first.
fn parts(names: &[String], sizes: &DVector<f64>) -> String {
    let largest = sizes.amax();
    let mut order: Vec<usize> = (0..names.len()).filter(|&i| sizes[i] >= PART * largest).collect();
    order.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
    let shown: Vec<String> = order.iter().take(3).map(|&i| format!("`{}`", names[i])).collect();
    let more = if order.len() > 3 { " and others" } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// Six significant digits.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    format!("{rounded}")
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
