//! The linear motion about a held pose in all coordinates, by sparse matrices: for mechanisms of many bodies.
//!
//! Small motions with G x = 0 follow M ẍ + K x = 0, as in `held.rs`. Here the constraints stay beside M and K, so that these keep their
//! pattern, and the mechanism may stand on a tree of short roads, where coordinates of the user's joints are gauges between free bodies.
//! What the pose leaves unbalanced is then held along gauges s(q) by forces h, as it would be on the joint coordinates themselves:
//!
//! ```text
//! Gᵀλ + Sᵀh = f,   S = ∂s/∂q of the independent coordinates,   K = ∂(Gᵀλ + Sᵀh − f)/∂q at fixed λ and h
//! ```

use super::coordinates::{Coordinate, coordinates};
use super::held::{Pose, geodesic};
use super::linear::Singular;
use super::saddle::Saddle;
use crate::dynamics::{Differentiable, Dynamics, Linearizer, Point};
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Mechanism, Row, RowKind, RowOwner, Start};
use crate::model::{Model, coordinates_of};
use grashof_solvers::rank::RANK_TOLERANCE;
use grashof_solvers::{Block, Elimination, Kkt, Sparsity, Tangent};
use std::collections::{HashMap, HashSet};

/// Part of the stiffness that may be circulatory by round-off: forces have a potential.
pub(crate) const POTENTIAL: f64 = 1e-8;
/// Part of what K x is the sum of that is lost to round-off.
const ROUND_OFF: f64 = 1e-11;

/// Part of D beside the rows of multipliers: about the smallest singular value of rows along hundreds of bars. With such a part the system is
/// as well conditioned as its rows, with a larger one as their square (Björck, BIT 7 (1967) 257-278).
const LIGHT: f64 = 1e-6;

/// M ẍ + K x = 0 on motions x (nv) with G x = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Pencil {
    /// M (nv × nv).
    pub mass: Block,
    /// K (nv × nv); symmetric on the motions that G leaves, if forces have a potential.
    pub stiffness: Block,
    /// C (nv × nv), of the forces that velocities change: only damped modes know of it.
    pub damping: Block,
    /// G (rows × nv).
    pub rows: Block,
    /// D, the diagonal of the mass metric (nv).
    pub metric: Vec<f64>,
    /// diag(G D⁻¹ Gᵀ) (rows).
    pub row_scale: Vec<f64>,
    /// For each velocity the sum of the sizes of the forces on it, by a whole way (nv): what K is made of before it cancels.
    pub grain: Vec<f64>,
    /// Number of independent motions.
    pub freedom: usize,
}

impl Pencil {
    /// Asymmetry of K along motions that the rows leave, as part of its size: 0 for forces with a potential.
    #[must_use]
    pub fn circulation(&self) -> f64 {
        self.asymmetry(&self.stiffness)
    }

    /// Asymmetry of a matrix (nv × nv) along motions that the rows leave, as part of its size.
    #[must_use]
    pub fn asymmetry(&self, matrix: &Block) -> f64 {
        let nv = self.metric.len();
        let Some(mut kkt) = self.closing() else { return 0.0 };
        // the part of a force (nv) that accelerates, all masses being D: its work on that motion
        let mut working = |force: &[f64]| {
            let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; self.row_scale.len()]);
            kkt.solve(force, &vec![0.0; self.row_scale.len()], &mut a, &mut lambda);
            a.iter().zip(&self.metric).map(|(a, d)| a * a * d).sum::<f64>().sqrt()
        };
        // a motion in no special direction
        let noise: Vec<f64> = (0..nv).map(|i| (1.0 + (2.39 * (i + 1) as f64).sin()) * self.metric[i].sqrt()).collect();
        let (mut x, mut lambda) = (vec![0.0; nv], vec![0.0; self.row_scale.len()]);
        self.closing().iter_mut().for_each(|kkt| kkt.solve(&noise, &vec![0.0; self.row_scale.len()], &mut x, &mut lambda));
        let mut skew = vec![0.0; nv];
        let (mut straight, mut sizes) = (vec![0.0; nv], vec![0.0; nv]);
        for (i, line) in matrix.lines().enumerate() {
            for (j, k) in line.entries() {
                skew[i] += k * x[j];
                skew[j] -= k * x[i];
                straight[i] += k * x[j];
                sizes[i] += (k * x[j]).abs();
            }
        }
        let off = working(&skew);
        let lost = ROUND_OFF * sizes.iter().zip(&self.metric).map(|(k, d)| k * k / d).sum::<f64>().sqrt();
        if off > lost { off / working(&straight) } else { 0.0 }
    }

    /// The system of the shortest motions in D that close the rows.
    #[must_use]
    pub fn closing(&self) -> Option<Kkt> {
        held_system(&self.rows, &self.metric, &self.row_scale)
    }

    /// The displacement (nv) that closes gaps Φ (rows), by [`Pencil::closing`].
    #[must_use]
    pub fn closed(kkt: &mut Kkt, phi: &[f64]) -> Vec<f64> {
        let nv = kkt.velocities();
        let (mut x, mut lambda) = (vec![0.0; nv], vec![0.0; phi.len()]);
        let gaps: Vec<f64> = phi.iter().map(|phi| -phi).collect();
        kkt.solve(&vec![0.0; nv], &gaps, &mut x, &mut lambda);
        x
    }
}

/// [D Rᵀ; R −E] of rows R with diag(R D⁻¹ Rᵀ), factored.
fn held_system(rows: &Block, metric: &[f64], scale: &[f64]) -> Option<Kkt> {
    let nv = metric.len();
    let mut kkt = Kkt::of_blocks(&Sparsity::new(nv, nv, (0..nv).map(|i| (i, i))), rows.pattern());
    kkt.set_scale(metric, scale);
    kkt.factor(metric, rows.values()).ok()?;
    Some(kkt)
}

/// A held pose of a mechanism of many bodies.
#[derive(Clone, Debug)]
pub struct HeldSparse {
    /// The linear motion about it.
    pub pencil: Pencil,
    /// The independent coordinates, with the row of S of each: columns and their factors.
    pub independent: Vec<(Coordinate, Vec<(usize, f64)>)>,
    /// How each of them is measured.
    pub ways: Vec<Way>,
    /// h: what is unbalanced, N or N m.
    pub unbalanced: Vec<f64>,
    /// Sum of the sizes of all forces over whole ways (1 rad, or the size of the mechanism), and of what such ways change in them, J.
    pub work: f64,
    /// Largest |Φ|, m or rad.
    pub residual: f64,
}

/// A coordinate that may be independent.
struct Candidate {
    coordinate: Coordinate,
    way: Way,
    /// Its place among those to which `start` gives an exact value.
    preferred: Option<usize>,
}

/// How a coordinate is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// It is that of a velocity of the tree.
    Column(usize),
    /// By a gauge.
    Gauge(usize),
}

impl HeldSparse {
    /// The motion about a pose at time 0; `metric` (nv) is that of the assembled start. Independent are the joint coordinates with an
    /// exact value in `start` as far as the rows leave them so, then others in the order of the file.
    ///
    /// # Errors
    /// If forces are not numbers in the pose.
    pub fn new<G>(model: &Model, mechanism: &Mechanism<G>, pose: Pose<'_>, metric: &[f64]) -> Result<Self, Singular>
    where
        G: Space<S = f64>,
    {
        let (rows, nv) = (mechanism.rows.len(), mechanism.nv);
        let mut candidates = of_joints(model, mechanism);
        let mut chosen = independent(mechanism, pose, metric, &candidates)?;
        if chosen.rank < nv {
            candidates.extend(of_columns(model, mechanism, &candidates));
            chosen = independent(mechanism, pose, metric, &candidates)?;
        }
        // gauges before columns: those are rows of the mechanism
        let (gauges, columns): (Vec<usize>, Vec<usize>) =
            chosen.candidates.iter().partition(|&&i| matches!(candidates[i].way, Way::Gauge(_)));
        let order: Vec<usize> = gauges.iter().chain(&columns).copied().collect();
        let held = Rows::new(mechanism, pose, metric, order.iter().map(|&i| candidates[i].way))?;
        let lambda = held.multipliers(metric)?;

        let of_rows = held.mechanism.rows.len();
        let mut modes = pose.modes.to_vec();
        let mut dynamics = Dynamics::without_mass(&held.mechanism);
        dynamics.work.z.copy_from_slice(pose.z);
        let rest = vec![0.0; nv];
        evaluate(&mut dynamics, pose, &rest);
        // joints press to the side that the multipliers say
        for (_, side) in dynamics.pressed(&lambda).filter(|(force, _)| *force < 0.0) {
            modes[side] = if modes[side] < 0 { 1 } else { -1 };
        }
        let at = Point { t: 0.0, q: pose.q, v: &rest, z: pose.z, a: &rest, lambda: &lambda[..of_rows], modes: &modes };
        let mut linearizer = Linearizer::new(&held.mechanism);
        let mut tangent = Tangent::new(&linearizer.pattern(pose.z.len()));
        linearizer.tangents(&at, &mut tangent);
        if !tangent.is_finite() {
            return Err(Singular);
        }
        let mut r: Vec<f64> = held.force.iter().map(|f| -f).collect();
        held.block.lines().zip(&lambda).take(of_rows).for_each(|(line, lambda)| line.add_to(*lambda, &mut r));
        let mut stiffness = tangent.k;
        geodesic(mechanism, &r, |i, j, x| stiffness.set(i, j, stiffness.at(i, j) + x));

        let units = mechanism.units(mechanism.size());
        let mut grain: Vec<f64> = held.force.iter().map(|f| f.abs()).collect();
        held.block.lines().zip(&lambda).for_each(|(line, l)| line.entries().for_each(|(j, g)| grain[j] += (g * l).abs()));
        grain.iter_mut().zip(&units).for_each(|(grain, unit)| *grain /= unit);
        let stiff = stiffness.lines().zip(&units).map(|(line, u)| u * line.entries().map(|(j, k)| k.abs() * units[j]).sum::<f64>());
        let work =
            held.force.iter().zip(&units).map(|(f, u)| f.abs() * u).sum::<f64>() + stiff.sum::<f64>() + dynamics.acting(mechanism.size());
        let mut places = vec![0; candidates.len()];
        order.iter().enumerate().for_each(|(place, &i)| places[i] = rows + place);
        let place = |i: usize| places[i];
        let line = |i: usize| held.block.line(place(i)).entries().collect();
        Ok(Self {
            unbalanced: chosen.candidates.iter().map(|&i| lambda[place(i)]).collect(),
            independent: chosen.candidates.iter().map(|&i| (candidates[i].coordinate.clone(), line(i))).collect(),
            ways: chosen.candidates.iter().map(|&i| candidates[i].way).collect(),
            work,
            residual: held.phi[..rows].iter().fold(0.0, |m, phi| f64::max(m, phi.abs())),
            pencil: Pencil {
                stiffness,
                damping: tangent.c,
                rows: held.block.select_rows(&(0..rows).collect::<Vec<_>>()),
                metric: metric.to_vec(),
                row_scale: held.scale[..rows].to_vec(),
                grain,
                freedom: chosen.candidates.len(),
                mass: held.mass,
            },
        })
    }
}

/// The coordinates of all joints, in the order of the file.
fn of_joints<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>) -> Vec<Candidate> {
    let exact = |s: &&Start| !s.guess;
    let asked = mechanism
        .starts
        .iter()
        .filter(exact)
        .filter_map(|s| if let Asked::Gauge { gauge, order: 0 } = s.asked { Some(gauge) } else { None });
    let asked: HashMap<usize, usize> = asked.enumerate().map(|(place, gauge)| (gauge, place)).collect();
    let mut out = Vec::new();
    for (joint, of) in mechanism.joints.iter().zip(&model.joints) {
        for (slot, &gauge) in joint.slots.iter().enumerate() {
            let Some(named) = coordinates_of(&of.kind).iter().find(|c| c.slot == slot) else { continue };
            let [name, rate] = [0, 1].map(|k| format!("{}.{}", joint.name, named.names[k]));
            let measured = &mechanism.gauges[gauge];
            let way = if let Measured::Coordinate { along, .. } = measured.measured { Way::Column(along.v) } else { Way::Gauge(gauge) };
            let coordinate = Coordinate { name, rate, turns: measured.turns() };
            out.push(Candidate { coordinate, way, preferred: asked.get(&gauge).copied() });
        }
    }
    out
}

/// All velocities that are no coordinates of joints.
fn of_columns<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, known: &[Candidate]) -> Vec<Candidate> {
    let taken: HashSet<usize> = known.iter().filter_map(|c| if let Way::Column(v) = c.way { Some(v) } else { None }).collect();
    let columns = coordinates(model, mechanism).into_iter().enumerate().filter(|(v, _)| !taken.contains(v));
    columns.map(|(v, coordinate)| Candidate { coordinate, way: Way::Column(v), preferred: None }).collect()
}

/// Which candidates are independent beside the rows, rising, and the rank of the rows with all candidates.
struct Independent {
    candidates: Vec<usize>,
    rank: usize,
}

fn independent<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    pose: Pose<'_>,
    metric: &[f64],
    candidates: &[Candidate],
) -> Result<Independent, Singular> {
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    order.sort_by_key(|&i| candidates[i].preferred.unwrap_or(usize::MAX));
    let held = Rows::new(mechanism, pose, metric, order.iter().map(|&i| candidates[i].way))?;
    let rank = Elimination::new(&held.block, &inverse_roots(&held.scale), &inverse_roots(metric), RANK_TOLERANCE);
    let rows = mechanism.rows.len();
    let mut chosen: Vec<usize> = rank.independent.iter().filter(|&&i| i >= rows).map(|&i| order[i - rows]).collect();
    chosen.sort_unstable();
    Ok(Independent { candidates: chosen, rank: rank.independent.len() })
}

/// The rows of a mechanism in a pose, and those of coordinates that are held.
struct Rows<G: Space<S = f64>> {
    /// The mechanism with rows for the coordinates that gauges measure.
    mechanism: Differentiable<G>,
    /// G, then the rows of the coordinates, in their order.
    block: Block,
    /// Their squares by the metric: diag(G D⁻¹ Gᵀ).
    scale: Vec<f64>,
    /// f (nv).
    force: Vec<f64>,
    /// M (nv × nv).
    mass: Block,
    /// Φ of the rows of the mechanism.
    phi: Vec<f64>,
}

impl<G: Space<S = f64>> Rows<G> {
    fn new(mechanism: &Mechanism<G>, pose: Pose<'_>, metric: &[f64], ways: impl Iterator<Item = Way>) -> Result<Self, Singular> {
        let ways: Vec<Way> = ways.collect();
        let mut with = mechanism.clone();
        with.active_gauges = with.gauges.len();
        let rows = mechanism.rows.len();
        for way in &ways {
            if let Way::Gauge(gauge) = *way {
                let (owner, angular) = (RowOwner::Coupling, mechanism.gauges[gauge].turns());
                with.rows.push(Row { kind: RowKind::Gauge(gauge), owner, label: String::new(), offset: 0.0, anchored: false, angular });
            }
        }
        let mut dynamics = Dynamics::new(&with);
        dynamics.work.z.copy_from_slice(pose.z);
        evaluate(&mut dynamics, pose, &vec![0.0; with.nv]);
        dynamics.mass();
        let work = &dynamics.work;
        if !work.force.iter().chain(work.g.values()).all(|x| x.is_finite()) {
            return Err(Singular);
        }
        let natural = dynamics.row_scale(pose.q, pose.modes, metric);
        let mut gauged = rows..with.rows.len();
        let (mut entries, mut scale) = (Vec::new(), natural[..rows].to_vec());
        (0..rows).for_each(|i| entries.extend(work.g.line(i).entries().map(|(j, x)| (i, j, x))));
        for (i, way) in ways.iter().enumerate() {
            match (way, rows + i) {
                (Way::Column(v), i) => {
                    entries.push((i, *v, 1.0));
                    scale.push(metric[*v].recip());
                }
                (Way::Gauge(_), i) => {
                    let Some(row) = gauged.next() else { continue };
                    entries.extend(work.g.line(row).entries().map(|(j, x)| (i, j, x)));
                    scale.push(natural[row]);
                }
            }
        }
        let mut block = Block::new(&Sparsity::new(scale.len(), with.nv, entries.iter().map(|(i, j, _)| (*i, *j))));
        entries.iter().for_each(|(i, j, x)| block.set(*i, *j, *x));
        let (force, mass, phi) = (work.force.clone(), work.mass.clone(), work.phi.clone());
        Ok(Self { mechanism: Differentiable::new(with), block, scale, force, mass, phi })
    }

    /// λ and h with Gᵀλ + Sᵀh = f, of least size where rows are redundant: what holds the mechanism, so that nothing accelerates.
    fn multipliers(&self, metric: &[f64]) -> Result<Vec<f64>, Singular> {
        let scale: Vec<f64> = inverse_roots(metric).into_iter().chain(inverse_roots(&self.scale)).collect();
        let masses = metric.iter().enumerate().map(|(i, d)| (i, i, LIGHT * d));
        Ok(Saddle::new(masses, &self.block, &scale).ok_or(Singular)?.multipliers(&self.force))
    }
}

/// All stages but M at rest at time 0.
fn evaluate<G: Space<S = f64>>(dynamics: &mut Dynamics<'_, G>, pose: Pose<'_>, rest: &[f64]) {
    dynamics.time(0.0, pose.modes);
    dynamics.position(pose.q, pose.modes);
    dynamics.velocity(rest, pose.modes);
    dynamics.forces(pose.modes);
}

fn inverse_roots(x: &[f64]) -> Vec<f64> {
    x.iter().map(|x| x.sqrt().recip()).collect()
}
