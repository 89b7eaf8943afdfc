//! The linear system next to a state: the study kind `linearize`.
//!
//! x = (independent coordinates, their rates, first-order states), u = parameters, y = the columns of the study. A is exact, by
//! [`Linear::reduce`](crate::kinematics::linear::Linear::reduce). B, C and D are differences (`numerics/slope.rs`), with the loops closed
//! anew at each place, steps of a thousandth or less, and switches kept in their modes. With a parameter the mechanism is built anew; its
//! independent coordinates and velocities stay.

mod probe;

use super::common::case::Case;
use super::common::case::parameters_with;
use super::common::numbers::Sources;
use super::common::scene::{self, Subject};
use super::dynamics::massless::massless;
use super::statics::equilibrium;
use crate::dynamics::{Differentiable, Dynamics, Linearizer, Point};
use crate::expression::Id;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::beside::state_beside;
use crate::kinematics::coordinates::coordinates;
use crate::kinematics::crossing::change_point;
use crate::kinematics::held::{Pose, settled};
use crate::kinematics::linear::{Linear, Reduced};
use crate::kinematics::partition::{Partition, preferred, with_mass};
use crate::kinematics::undefined::{assembled, not_finite};
use crate::mechanism::{Coordinates, Leaf, Mechanism, build_beside};
use crate::model::{Linearize, Study};
use crate::numerics::eigenvalues::eigenvalues;
use crate::numerics::slope::slope;
use crate::results::{Certificate, Failure, Finding, LinearSystem, List, Rows, Scene};
use crate::studies::common::outcome::Outcome;
use crate::studies::common::sides::{self, Difference};
use crate::studies::common::stops::taken_as_free;
use nalgebra::{Complex, DMatrix, DVector};
use probe::{Answer, Probe, Whole};

/// Longest steps of differences, of the value or of 1.
const STEP: f64 = 1e-3;
/// Part of an entry up to which differences may be wrong without a word.
const ROUGH: f64 = 1e-6;

/// Runs a study of the kind `linearize`.
///
/// # Errors
/// If the mechanism cannot be assembled, has no equilibrium, moves without mass, or its loops do not close beside the state.
pub(crate) fn run<G>(case: Case<'_>, asked: &Linearize, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    let Case { model, study, parameters, .. } = case;
    let (mechanism, start) = assembled::<G>(model, parameters, Coordinates::Joint)?;
    without_friction(&mechanism, study)?;
    let mechanism = Differentiable::new(mechanism);
    let mut findings = Vec::new();
    let mut at = if asked.at_equilibrium {
        let rest = equilibrium::<G>(case, &mechanism, &start, stop)?;
        findings = rest.findings;
        Whole { q: rest.q, v: vec![0.0; mechanism.nv], z: rest.z, modes: rest.modes }
    } else {
        findings.extend(start.not_as_meant());
        let z = mechanism.state_starts.clone();
        let modes = settled(&mechanism, [&start.q, &start.v, &z], &start.modes);
        Whole { q: start.q.clone(), v: start.v.clone(), z, modes }
    };
    findings.extend(taken_as_free(model, &mechanism, [&at.q, &at.v], &at.modes, start.size));
    findings.extend(change_point(&mechanism, &at.q, &at.modes, (&start.metric, start.size), &study.place));
    let ids: Vec<Id> = study.columns.iter().map(|c| c.value).collect();
    let scenes = scene::wanted(case, || pose(case, &mechanism, &at));
    let bench = Bench { case, asked, mechanism: &mechanism, start: &start, ids: &ids };
    let names = Names::new(&bench);
    let (base, reduced) = bench.linear(&mut at, &names)?;
    let (system, rough) = bench.system(&at, &base, &reduced, &names)?;
    findings.extend(rough);
    findings.extend(bench.findings(&at, &base, &names, &reduced.partition));
    let poles = eigenvalues(&reduced.a).ok_or_else(|| {
        Failure::numerical(
            "the poles cannot be found: a stiffness or damping is too large for the masses that it acts on",
            "look for a value of the wrong unit or sign among springs, dampers and masses",
        )
    })?;
    findings.extend(bench.other_poles(&at, &reduced, &poles));
    findings.extend(bench.one_sided(&at, &base, &reduced));
    let mut poles: Vec<(f64, f64)> = poles.iter().map(|p| (p.re, p.im)).collect();
    poles.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let list = |name: &str, values: Vec<f64>| List { name: name.into(), unit: "1/s".into(), values, ..List::default() };
    let numbers = Sources { case, tables: &mechanism.tables, functionals: &[], results: &[], works: &[] }.numbers(true);
    findings.extend(numbers.findings);
    let mut rows = Rows::new(base.outputs.len());
    rows.push(base.outputs.iter().copied());
    Ok(Outcome {
        stopped: numbers.undefined.as_ref().map(|u| u.message.clone()),
        undefined: numbers.undefined,
        parameters: case.named(),
        independent: "time".into(),
        places: vec![0.0],
        rows,
        lists: vec![list("poles_real", poles.iter().map(|p| p.0).collect()), list("poles_imaginary", poles.iter().map(|p| p.1).collect())],
        linear: Some(system),
        scalars: numbers.scalars,
        expectations: numbers.expectations,
        extremes: vec![None; study.columns.len()],
        findings,
        certificate: Certificate { evaluations: 1, ..Certificate::default() },
        scenes,
        ..Outcome::default()
    })
}

/// Refuses forces that depend on reactions, which would make the multipliers part of the linear motion.
fn without_friction<G: Space>(mechanism: &Mechanism<G>, study: &Study) -> Result<(), Failure> {
    if mechanism.pressings.is_empty() {
        return Ok(());
    }
    Err(Failure::Study {
        code: "friction",
        message: "`linearize` does not know friction that depends on the reactions of joints".into(),
        place: study.place.clone(),
        help: "remove the coefficients of friction in a variant, or give the joints `damping`".into(),
    })
}

/// The drawing of a state.
fn pose<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, at: &Whole) -> Scene {
    let mut dynamics = Dynamics::without_mass(mechanism);
    dynamics.time(0.0, &at.modes);
    dynamics.position(&at.q, &at.modes);
    Subject { case, mechanism }.of_poses(&[dynamics.poses()])
}

/// Names of the coordinates behind all velocities (nv), of their rates, and whether they turn.
struct Names {
    coordinates: Vec<String>,
    rates: Vec<String>,
}

impl Names {
    fn new<G: Space<S = f64>>(bench: &Bench<'_, G>) -> Self {
        let (coordinates, rates) = coordinates(bench.case.model, bench.mechanism).into_iter().map(|c| (c.name, c.rate)).unzip();
        Self { coordinates, rates }
    }
}

/// What is asked of which mechanism.
struct Bench<'a, G: Space<S = f64>> {
    case: Case<'a>,
    asked: &'a Linearize,
    mechanism: &'a Differentiable<G>,
    start: &'a Assembled,
    ids: &'a [Id],
}

impl<G: Space<S = f64>> Bench<'_, G> {
    /// What the state leads to, and the exact linear motion about it.
    fn linear(&self, at: &mut Whole, names: &Names) -> Result<(Answer, Reduced), Failure> {
        let m = self.mechanism;
        let mut probe = Probe::new(self.case.model, m, self.case.parameters, self.ids, &self.start.metric);
        let undetermined = || {
            massless(m, self.start).unwrap_or_else(|| {
                Failure::numerical(
                    "the accelerations are not determined in the state: the position is singular",
                    "take another state, away from a dead point",
                )
            })
        };
        let answer = probe.answer(at, &[], true);
        if let Some(gap) = &probe.gap {
            return Err(Failure::Undefined(gap.explain(self.case.model, self.case.study, "the state")));
        }
        let answer = answer.ok_or_else(undetermined)?;
        let mut linearizer = Linearizer::new(m);
        let point = Point { t: 0.0, q: &at.q, v: &at.v, z: &at.z, a: &answer.a, lambda: &answer.lambda, modes: &at.modes };
        let linear = Linear::new(m, &mut linearizer, &point, &self.start.metric).map_err(|_| undetermined())?;
        if !linear.tangent.is_finite() {
            return Err(not_finite(self.case.model, m, Pose { q: &at.q, z: &at.z, modes: &at.modes }));
        }
        let partition = linear.partition(&preferred(m));
        let own: Vec<String> = partition.independent.iter().map(|&i| names.coordinates[i].clone()).collect();
        let mass = partition.p.transpose() * &linear.mass * &partition.p;
        with_mass(&mass, &partition, &self.start.metric, &own, &self.case.study.place)?;
        let reduced = linear.reduce(&partition.independent).map_err(|_| undetermined())?;
        let answer = probe.answer(at, &reduced.partition.independent, false).ok_or_else(undetermined)?;
        Ok((answer, reduced))
    }

    /// That other poles belong to a state which the constraints cannot tell from this one.
    fn other_poles(&self, at: &Whole, reduced: &Reduced, poles: &[Complex<f64>]) -> Option<Finding> {
        let m = self.mechanism;
        let beside = state_beside(m, [&at.q, &at.v], &at.modes, &self.start.metric, self.start.size)?;
        let mut there = Whole { q: beside.q.clone(), v: beside.v.clone(), ..at.clone() };
        let mut probe = Probe::new(self.case.model, m, self.case.parameters, self.ids, &self.start.metric);
        let answer = probe.answer(&mut there, &[], false)?;
        let Whole { q, v, z, modes } = &there;
        let point = Point { t: 0.0, q, v, z, a: &answer.a, lambda: &answer.lambda, modes };
        let linear = Linear::new(m, &mut Linearizer::new(m), &point, &self.start.metric).ok()?;
        let others = eigenvalues(&linear.reduce(&reduced.partition.independent).ok()?.a)?;
        beside.other_eigenvalues([poles, &others], "1/s", |p| p * p, &self.case.study.place)
    }

    /// Forces (nv) in a state with modes of its switches.
    fn forces(&self, at: &Whole, modes: &[i32]) -> DVector<f64> {
        let mut dynamics = Dynamics::new(self.mechanism);
        dynamics.work.z.copy_from_slice(&at.z);
        dynamics.terms(0.0, &at.q, &at.v, modes);
        DVector::from_column_slice(&dynamics.work.force)
    }

    /// That the state is in a kink of a law, so that A is that of one side.
    fn one_sided(&self, at: &Whole, base: &Answer, reduced: &Reduced) -> Option<Finding> {
        let (m, p) = (self.mechanism, &reduced.partition.p);
        let unit = m.units(m.size());
        let ways = DVector::from_iterator(p.ncols(), reduced.partition.independent.iter().map(|&i| unit[i]));
        let motions = sides::weights(ways.len()).map(|y| (p * DVector::from_vec(y).component_mul(&ways)).as_slice().to_vec());
        let by_ways = |x: &DMatrix<f64>| DMatrix::from_fn(x.nrows(), x.ncols(), |i, j| ways[i] * x[(i, j)] * ways[j]);
        sides::beside(m, [&at.q, &at.v, &at.z], &at.modes, &motions).iter().find_map(|modes| {
            let point = Point { t: 0.0, q: &at.q, v: &at.v, z: &at.z, a: &base.a, lambda: &base.lambda, modes };
            let linear = Linear::new(m, &mut Linearizer::new(m), &point, &self.start.metric).ok()?;
            let there = linear.reduce(&reduced.partition.independent).ok()?;
            let slopes = [[&reduced.stiffness, &there.stiffness], [&reduced.damping, &there.damping]];
            let slopes = slopes.map(|both| sides::change(both.map(by_ways).each_ref()));
            let rates =
                (2 * ways.len()..reduced.a.nrows()).map(|i| sides::change([&reduced.a, &there.a].map(|a| a.rows(i, 1).into()).each_ref()));
            let slope = slopes.into_iter().chain(rates).fold(0.0, f64::max);
            let [here, there] = [&at.modes, modes].map(|modes| self.forces(at, modes));
            let size = [&here, &there].map(|f| f.iter().zip(&unit).map(|(f, u)| f.abs() * u).sum::<f64>()).into_iter().fold(0.0, f64::max);
            let jump = (p.transpose() * (here - there)).component_mul(&ways).amax();
            let force = if jump > 0.0 { jump / size } else { 0.0 };
            sides::one_sided(self.case.model, [&at.modes, modes], Difference { force, slope }, &self.case.study.place)
        })
    }

    /// A, B, C and D with their names, and that differences have not found them.
    fn system(&self, at: &Whole, base: &Answer, reduced: &Reduced, names: &Names) -> Result<(LinearSystem, Option<Finding>), Failure> {
        let m = self.mechanism;
        let own = &reduced.partition.independent;
        let (n, nz) = (own.len(), at.z.len());
        let all = |of: &[String]| own.iter().map(|&i| of[i].clone()).collect::<Vec<_>>();
        let mut states = all(&names.coordinates);
        states.extend(all(&names.rates));
        states.extend(self.case.model.states.iter().map(|s| s.name.clone()));
        let u: Vec<f64> = own.iter().map(|&i| at.v[i]).collect();
        let x: Vec<f64> = own.iter().map(|&i| coordinate(m, &at.q, i)).chain(u.iter().copied()).chain(at.z.iter().copied()).collect();
        let (b, d, by_inputs) = self.by_inputs(at, &reduced.partition)?;
        let (c, by_state) = self.by_state(at, &reduced.partition)?;
        let rough = f64::max(by_inputs, by_state);
        let finding = (rough > ROUGH).then(|| Finding {
            code: "rough-differences".into(),
            message: format!(
                "entries of B, C or D are uncertain by {:.1e} of their size: a force or a column has a kink or a jump in the state, or changes within a part of an input that differences do not resolve",
                rough
            ),
            path: self.case.study.place.clone(),
        });
        let order = 2 * n + nz;
        // without columns the outputs are the states
        let silent = self.ids.is_empty();
        let (c, d) = if silent { (DMatrix::identity(order, order), DMatrix::zeros(order, self.asked.inputs.len())) } else { (c, d) };
        let outputs = if silent { states.clone() } else { self.case.study.columns.iter().map(|c| c.name.clone()).collect() };
        let y = if silent { x.clone() } else { base.outputs.clone() };
        let matrices = [("A", &reduced.a), ("B", &b), ("C", &c), ("D", &d)].into_iter();
        let mechanical = [("mass", &reduced.mass), ("damping", &reduced.damping), ("stiffness", &reduced.stiffness)];
        let system = LinearSystem {
            coordinates: all(&names.coordinates),
            outputs,
            inputs: self.asked.inputs.iter().map(|&p| self.case.model.parameters[p].name.clone()).collect(),
            values: [x, [u, base.rates.clone()].concat(), self.asked.inputs.iter().map(|&p| self.case.parameters[p]).collect(), y],
            matrices: matrices.chain(mechanical).map(|(name, matrix)| (name.to_string(), rows(matrix))).collect(),
            states,
            csv: self.asked.csv,
            mat: self.asked.mat,
        };
        Ok((system, finding))
    }

    /// C (outputs × states) by differences in x, and how much of an entry may be wrong.
    fn by_state(&self, at: &Whole, partition: &Partition) -> Result<(DMatrix<f64>, f64), Failure> {
        let (n, nz) = (partition.independent.len(), at.z.len());
        let (mut c, mut rough) = (DMatrix::zeros(self.ids.len(), 2 * n + nz), 0.0);
        if self.ids.is_empty() {
            return Ok((c, rough));
        }
        let mut probe = Probe::new(self.case.model, self.mechanism, self.case.parameters, self.ids, &self.start.metric);
        let u = DVector::from_iterator(n, partition.independent.iter().map(|&i| at.v[i]));
        for j in 0..2 * n + nz {
            let size = match j {
                _ if j < n && self.slides(partition.independent[j]) => self.start.size,
                _ if j < 2 * n => 1.0,
                _ => sized(at.z[j - 2 * n]),
            };
            let column = slope(STEP * size, |e| {
                let (mut dx, mut u, mut base) = (DVector::zeros(n), u.clone(), at.clone());
                match j {
                    _ if j < n => dx[j] = e,
                    _ if j < 2 * n => u[j - n] += e,
                    _ => base.z[j - 2 * n] += e,
                }
                let mut next = probe.state(&base, partition, &dx, &u)?;
                Some(probe.answer(&mut next, &partition.independent, false)?.outputs)
            });
            let (column, wrong) = column.ok_or_else(|| self.lost("a state"))?;
            rough = f64::max(rough, wrong);
            c.set_column(j, &DVector::from_vec(column));
        }
        Ok((c, rough))
    }

    /// B (states × inputs) and D (outputs × inputs) by differences in the parameters, and how much of an entry may be wrong.
    fn by_inputs(&self, at: &Whole, partition: &Partition) -> Result<(DMatrix<f64>, DMatrix<f64>, f64), Failure> {
        let (n, nz, inputs) = (partition.independent.len(), at.z.len(), &self.asked.inputs);
        let (mut b, mut d) = (DMatrix::zeros(2 * n + nz, inputs.len()), DMatrix::zeros(self.ids.len(), inputs.len()));
        let mut rough = 0.0;
        let u = DVector::from_iterator(n, partition.independent.iter().map(|&i| at.v[i]));
        for (j, &input) in inputs.iter().enumerate() {
            let column = slope(STEP * sized(self.case.parameters[input]), |e| {
                let parameters = parameters_with(self.case.model, &[(input, self.case.parameters[input] + e)]);
                let mut mechanism = build_beside::<G>(self.case.model, &parameters, Coordinates::Joint).ok()?;
                for (row, before) in mechanism.rows.iter_mut().zip(&self.mechanism.rows) {
                    if row.anchored {
                        (row.offset, row.anchored) = (before.offset, before.anchored);
                    }
                }
                let mut probe = Probe::new(self.case.model, &mechanism, &parameters, self.ids, &self.start.metric);
                let mut next = probe.state(at, partition, &DVector::zeros(n), &u)?;
                let answer = probe.answer(&mut next, &partition.independent, false)?;
                Some([answer.rates, answer.outputs].concat())
            });
            let lost = || self.lost(&format!("the input `{}`", self.case.model.parameters[input].name));
            let (column, wrong) = column.ok_or_else(lost)?;
            let column = DVector::from_vec(column);
            rough = f64::max(rough, wrong);
            b.view_mut((n, j), (n + nz, 1)).copy_from(&column.rows(0, n + nz));
            d.set_column(j, &column.rows(n + nz, self.ids.len()));
        }
        Ok((b, d, rough))
    }

    fn slides(&self, velocity: usize) -> bool {
        crate::kinematics::assemble::units(self.mechanism)[velocity] == 1
    }

    fn lost(&self, what: &str) -> Failure {
        Failure::numerical(
            format!("the mechanism cannot be assembled beside the state in {what}: the position is nearly singular"),
            "take another state, away from a dead point",
        )
    }

    /// That the state does not rest, or that the equations change with time.
    fn findings(&self, at: &Whole, base: &Answer, names: &Names, partition: &Partition) -> Vec<Finding> {
        let mut out = Vec::new();
        let mut add = |code: &'static str, message| out.push(Finding { code: code.into(), message, path: self.case.study.place.clone() });
        let own = &partition.independent;
        let moving = own.iter().filter(|&&i| at.v[i].abs() > 1e-9 || base.a[i].abs() > 1e-6);
        let moving: Vec<String> = moving.map(|&i| format!("`{}`", names.coordinates[i])).collect();
        if !moving.is_empty() {
            let message = format!(
                "the state does not rest in {}: the matrices are those of deviations from its motion, at time 0",
                moving.join(", ")
            );
            add("not-at-rest", message);
        }
        let timed = self.mechanism.programs().iter().any(|p| p.fills.iter().any(|(_, leaf)| matches!(leaf, Leaf::Time)));
        if timed {
            add("depends-on-time", "drivers or forces depend on time: the matrices hold at time 0".into());
        }
        out
    }
}

/// The coordinate behind a velocity; 0 for a turn of a ball, which is measured from the state.
fn coordinate<G: Space>(mechanism: &Mechanism<G>, q: &[f64], velocity: usize) -> f64 {
    let found = mechanism.steps.iter().find_map(|step| match step {
        crate::mechanism::Step::Axis { q, v, .. } if *v == velocity => Some(*q),
        _ => None,
    });
    found.map_or(0.0, |i| q[i])
}

/// The size of a number, 1 for 0.
fn sized(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.abs() }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    // a zero has no sign
    matrix.row_iter().map(|row| row.iter().map(|x| x + 0.0).collect()).collect()
}
