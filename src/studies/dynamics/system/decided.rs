//! Velocities that the rows decide wherever the mechanism stands: of what is locked, and of what is driven.
//!
//! Where all that time moves in their rows rests, they are zero. What is computed there has round-off, by which a comparison comes out
//! now so, now otherwise, and in which a column has no end of details. So the evaluator gets the zero itself, and what
//! is locked stands where it was at the start.
//!
//! A velocity is decided if none of the motions that the rows leave has it, in the start and in the positions around it: where the
//! mechanism happens to stand (a rocker at the end of its way) says nothing. What is not small is not rounded: a mechanism may find a
//! position in which the rows decide less.

use crate::dynamics::{Dynamics, Workspace};
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::mechanism::{Mechanism, RowKind, Sets, Step};
use grashof_solvers::Block;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};

/// Part of a motion, in units, below which a velocity has none of it: its round-off.
const NONE: f64 = 1e-11;

/// Largest velocity and displacement, in units (per second), that is taken for round-off; accelerations have more.
const NOISE: f64 = 1e-9;
const NOISE_OF_ACCELERATION: f64 = 1e-6;

/// Directions of motions, in no special relation to each other.
const PHASES: [f64; 2] = [0.0, 2.0];

/// The velocities that rows decide, with what stands in the evaluator.
#[derive(Clone, Debug)]
pub(super) struct Decided {
    groups: Vec<Group>,
    /// 1 for what turns, else the size of the mechanism (nv).
    units: Vec<f64>,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

/// Velocities that rows connect.
#[derive(Clone, Debug, Default)]
struct Group {
    velocities: Vec<usize>,
    /// Coordinates with the velocities of the same joints, and where they stand if nothing moves the group.
    places: Vec<(usize, usize, f64)>,
    /// Drivers of the group: their outputs of the time program.
    drivers: Vec<usize>,
    /// Rows of functions that time moves.
    moved: Vec<usize>,
}

impl Decided {
    /// Those of a mechanism that stands at the start; `scale` is that of its rows.
    pub(super) fn of<G: Space<S = f64>>(dynamics: &Dynamics<'_, G>, start: &Assembled, scale: &[f64]) -> Self {
        let m = dynamics.mechanism;
        let units = m.units(start.size);
        let decided = decided(dynamics, start, scale, &units);
        let groups = if decided.contains(&true) { groups(m, &dynamics.natural(), &start.q, &decided) } else { Vec::new() };
        let empty = groups.is_empty();
        let room = |n: usize| if empty { Vec::new() } else { vec![0.0; n] };
        Self { groups, units, q: room(m.nq), v: room(m.nv), a: room(m.nv) }
    }

    /// Whether a velocity is one of them.
    pub(super) fn has(&self, velocity: usize) -> bool {
        self.groups.iter().any(|group| group.velocities.contains(&velocity))
    }

    /// Coordinates for the evaluator.
    pub(super) fn coordinates<'a>(&'a mut self, q: &'a [f64]) -> &'a [f64] {
        if self.groups.is_empty() {
            return q;
        }
        self.q.copy_from_slice(q);
        for &(k, velocity, place) in self.groups.iter().flat_map(|group| &group.places) {
            if (q[k] - place).abs() <= NOISE * self.units[velocity] {
                self.q[k] = place;
            }
        }
        &self.q
    }

    /// Velocities for the evaluator, in which ν stands.
    pub(super) fn velocities<'a, G: Space<S = f64>>(&'a mut self, work: &Workspace<G>, v: &'a [f64]) -> &'a [f64] {
        let rests = |group: &Group| {
            group.drivers.iter().all(|output| work.motions[output + 1] == 0.0) && group.moved.iter().all(|row| work.nu[*row] == 0.0)
        };
        if rest(&self.groups, &self.units, NOISE, rests, v, &mut self.v) { &self.v } else { v }
    }

    /// Accelerations for the evaluator, in which the velocities stand, with the coordinates and velocities there: all as given but for
    /// what rests.
    pub(super) fn accelerations<'a, G: Space<S = f64>>(&'a mut self, work: &Workspace<G>, [q, v, a]: [&'a [f64]; 3]) -> [&'a [f64]; 3] {
        let rates = &self.v;
        let rests = |group: &Group| {
            group.velocities.iter().all(|k| rates[*k] == 0.0)
                && group.moved.is_empty()
                && group.drivers.iter().all(|output| work.motions[output + 1] == 0.0 && work.motions[output + 2] == 0.0)
        };
        let rested = rest(&self.groups, &self.units, NOISE_OF_ACCELERATION, rests, a, &mut self.a);
        let [q, v] = self.standing(q, v);
        [q, v, if rested { &self.a } else { a }]
    }

    /// The coordinates and velocities that stand in the evaluator: as given but for what rests.
    pub(super) fn standing<'a>(&'a self, q: &'a [f64], v: &'a [f64]) -> [&'a [f64]; 2] {
        if self.groups.is_empty() { [q, v] } else { [&self.q, &self.v] }
    }
}

/// Copies rates (nv) with zeros in the groups that rest, if there are any groups.
fn rest(groups: &[Group], units: &[f64], noise: f64, rests: impl Fn(&Group) -> bool, from: &[f64], to: &mut [f64]) -> bool {
    if groups.is_empty() {
        return false;
    }
    to.copy_from_slice(from);
    for group in groups {
        if rests(group) && group.velocities.iter().all(|k| from[*k].abs() <= noise * units[*k]) {
            group.velocities.iter().for_each(|k| to[*k] = 0.0);
        }
    }
    true
}

/// Whether the rows decide each velocity (nv).
fn decided<G: Space<S = f64>>(dynamics: &Dynamics<'_, G>, start: &Assembled, scale: &[f64], units: &[f64]) -> Vec<bool> {
    let m = dynamics.mechanism;
    let mut decided = vec![!m.rows.is_empty(); m.nv];
    let mut look = |g: &Block| {
        let rank = Rank::new(g, &start.metric, scale, RANK_TOLERANCE);
        for phase in PHASES.into_iter().filter(|_| rank.mobility > 0) {
            let parts: Vec<f64> = (0..rank.mobility).map(|k| (2.4 * k as f64 + phase).cos()).collect();
            let motion = rank.motion(&parts);
            let most = motion.iter().zip(units).fold(0.0, |most, (v, unit)| f64::max(most, v.abs() / unit));
            for ((decided, v), unit) in decided.iter_mut().zip(&motion).zip(units) {
                *decided &= v.abs() <= NONE * most * unit;
            }
        }
        decided.contains(&true)
    };
    if !m.rows.is_empty() && look(&dynamics.work.g) {
        let mut there = dynamics.clone();
        for q in dynamics.around(&start.q, scale, &start.metric) {
            there.position(&q, &start.modes);
            if !look(&there.work.g) {
                break;
            }
        }
    }
    decided
}

/// Groups of decided velocities by the rows, with the sizes `natural` of their entries.
fn groups<G: Space<S = f64>>(m: &Mechanism<G>, natural: &Block, q: &[f64], decided: &[bool]) -> Vec<Group> {
    let lines: Vec<Vec<usize>> = natural.lines().map(|line| line.entries().filter(|(_, x)| *x > 0.0).map(|(k, _)| k).collect()).collect();
    let mut sets = Sets::new(m.nv);
    lines.iter().for_each(|line| line.windows(2).for_each(|pair| sets.join(pair[0], pair[1])));
    let mut groups = vec![Group::default(); m.nv];
    (0..m.nv).filter(|k| decided[*k]).for_each(|k| groups[sets.of(k)].velocities.push(k));
    for (index, (row, line)) in m.rows.iter().zip(&lines).enumerate() {
        let Some(first) = line.first() else { continue };
        let group = &mut groups[sets.of(*first)];
        match row.kind {
            RowKind::Driver { driver, .. } => group.drivers.push(m.drives[driver].output),
            _ if m.is_moved(row) => group.moved.push(index),
            _ => {}
        }
    }
    for step in &m.steps {
        let (i, v, coordinates, velocities) = match *step {
            Step::Axis { q, v, .. } => (q, v, 1, 1),
            Step::Ball { q, v, .. } => (q, v, 4, G::SPIN),
        };
        let group = &mut groups[sets.of(v)];
        if group.moved.is_empty() && group.drivers.is_empty() && decided[v..v + velocities].iter().all(|x| *x) {
            group.places.extend((i..i + coordinates).map(|i| (i, v, q[i])));
        }
    }
    groups.retain(|group| !group.velocities.is_empty());
    groups
}
