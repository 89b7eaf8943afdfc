//! From guesses and exact values to a position and velocity that satisfy every constraint.
//!
//! Guesses (`~`) and exact values first pull the drawn position towards themselves, all alike, in the sense of least squares.
//! Then constraints and exact values are closed by Gauss-Newton steps that are shortest in the mass metric (Levenberg's
//! damping where a step does not help): once from there, once from where they close best with guesses held as well, lest
//! coordinates that nobody named push a guess to another branch. What comes nearest to the guesses counts. Velocities follow
//! linearly.

mod explain;
mod guess;

use super::least_squares::{shortest, shortest_beyond};
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Mechanism, Row, RowKind, RowOwner, Step};
use explain::short;
use grashof_solvers::kkt::{ROUND_OFF, metric};
use std::f64::consts::TAU;

/// A consistent start.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembled {
    /// Coordinates (nq).
    pub q: Vec<f64>,
    /// Velocities (nv).
    pub v: Vec<f64>,
    /// Modes: switches of the expressions, then winding numbers.
    pub modes: Vec<i32>,
    /// Characteristic length of the mechanism, m.
    pub size: f64,
    /// Diagonal of the mass metric D at the start (nv).
    pub metric: Vec<f64>,
    /// Asked and found values of `start`.
    pub found: Vec<Found>,
}

/// An asked start value and what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// As written.
    pub name: String,
    /// Asked value.
    pub asked: f64,
    /// Found value.
    pub found: f64,
    /// True if it was a guess.
    pub guess: bool,
    /// Unit of both values.
    pub unit: &'static str,
}

/// Why a mechanism cannot be assembled, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssemblyFault {
    /// Kebab-case kind: `not-assembled`, `start-cannot-hold`, `over-constrained`.
    pub code: &'static str,
    /// What stays open.
    pub message: String,
    /// Path in the model file of what it concerns most.
    pub place: String,
    /// One remedy.
    pub help: String,
}

/// Residuals of the rows that the start must satisfy: constraints, then exact values.
struct System<'a, G: Space<S = f64>> {
    dynamics: Dynamics<'a, G>,
    modes: Vec<i32>,
    /// Rows asked at position level: those not anchored by the start.
    rows: Vec<usize>,
    /// Which start values must hold.
    held: Held,
    size: f64,
}

/// Which values of `start` are rows of a closing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Nothing,
    Exact,
    All,
}

const CONVERGED: f64 = 1e-12;

/// Assembles a mechanism and fixes the anchors of its anchored rows.
///
/// # Errors
/// The loops that stay open with their gaps, or the exact values that no assembly satisfies.
pub fn assemble<G: Space<S = f64>>(mechanism: &mut Mechanism<G>) -> Result<Assembled, AssemblyFault> {
    anchor_distances(mechanism);
    let start = mechanism.drawn();
    let mut system = System::new(mechanism);
    let mut q = start;
    system.orient(&mut q);
    system.dynamics.terms(0.0, &q, &vec![0.0; mechanism.nv], &system.modes);
    let metric = metric(&system.dynamics.work.mass, &units(mechanism));
    system.guess(&mut q, &metric);
    let guessed = q.clone();
    let mut closed = system.close(&mut q, &metric);
    if let Some(better) = system.by_guesses(&guessed, closed.then_some(&q), &metric) {
        (q, closed) = (better, true);
    }
    // a guess in a singular position (a straight linkage) has no direction to go: look around it
    let mut shake = Shake(1);
    for attempt in 0..8 {
        if closed && system.faces() {
            break;
        }
        let mut trial = guessed.clone();
        mechanism.retract(&mut trial, &shake.displacement(mechanism.nv, 0.05 * f64::from(attempt + 1)));
        closed = system.close(&mut trial, &metric);
        if closed {
            q = trial;
        }
    }
    if !closed {
        // whom to blame: would it close if the exact values gave way?
        system.held = Held::Nothing;
        let closes = system.close(&mut q, &metric);
        system.evaluate(&q);
        return Err(if closes { system.explain_start() } else { system.explain() });
    }
    if !system.faces() {
        return Err(system.explain_facing());
    }
    let System { modes, size, .. } = system;
    snap(mechanism, &mut q);
    anchor(mechanism, &q, &modes);
    let (v, found) = velocity(mechanism, &q, &modes, &metric, size)?;
    Ok(Assembled { q, v, modes, size, metric, found })
}

/// Kind of unit of each velocity column: 0 turns, 1 slides.
pub(crate) fn units<G: Space>(mechanism: &Mechanism<G>) -> Vec<u8> {
    let mut unit = vec![0; mechanism.nv];
    for step in &mechanism.steps {
        if let Step::Axis { turns: false, v, .. } = step {
            unit[*v] = 1;
        }
    }
    unit
}

/// Coordinates that were asked for exactly take the asked bits; the search left them within round-off.
fn snap<G: Space<S = f64>>(mechanism: &Mechanism<G>, q: &mut [f64]) {
    for start in mechanism.starts.iter().filter(|s| !s.guess) {
        let Asked::Gauge { gauge, order: 0 } = start.asked else { continue };
        if let Measured::Coordinate { along, .. } = mechanism.gauges[gauge].measured {
            q[along.q] = start.value;
        }
    }
}

/// A distance without a length is held as drawn.
fn anchor_distances<G: Space<S = f64>>(mechanism: &mut Mechanism<G>) {
    let drawn = mechanism.drawn();
    let modes = mechanism.modes();
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.time(0.0, &modes);
    dynamics.position(&drawn, &modes);
    let found: Vec<(usize, f64)> = mechanism
        .rows
        .iter()
        .enumerate()
        .filter_map(|(i, row)| match (row.kind, row.owner) {
            (RowKind::Gauge(g), RowOwner::Joint(_)) if row.anchored => Some((i, dynamics.work.readings[g].x)),
            _ => None,
        })
        .collect();
    for (row, x) in found {
        mechanism.rows[row].offset = x;
        mechanism.rows[row].anchored = false;
    }
}

/// Anchors of drivers, gears and racks from the found position.
fn anchor<G: Space<S = f64>>(mechanism: &mut Mechanism<G>, q: &[f64], modes: &[i32]) {
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    let offsets: Vec<f64> =
        mechanism.rows.iter().zip(&dynamics.work.phi).map(|(row, phi)| if row.anchored { row.offset + phi } else { row.offset }).collect();
    for (row, offset) in mechanism.rows.iter_mut().zip(offsets) {
        row.offset = offset;
    }
}

impl<'a, G: Space<S = f64>> System<'a, G> {
    fn new(mechanism: &'a Mechanism<G>) -> Self {
        let mut dynamics = Dynamics::new(mechanism);
        let mut modes = mechanism.modes();
        dynamics.follow_time(0.0, &mut modes);
        let rows = (0..mechanism.rows.len()).filter(|r| !mechanism.rows[*r].anchored).collect();
        Self { dynamics, modes, rows, held: Held::Exact, size: mechanism.size() }
    }

    fn evaluate(&mut self, q: &[f64]) {
        let zeros = vec![0.0; self.dynamics.mechanism.nv];
        self.dynamics.position(q, &self.modes);
        self.dynamics.follow_position(&mut self.modes);
        self.dynamics.velocity(&zeros, &self.modes);
        self.dynamics.watch(q, &zeros, &self.modes);
        self.wind();
    }

    /// Turns of cut hinges are counted so that angles come nearest to what is asked of them.
    fn wind(&mut self) {
        let m = self.dynamics.mechanism;
        for start in &m.starts {
            let Asked::Gauge { gauge, order: 0 } = start.asked else { continue };
            let Measured::Turn { winding, .. } = m.gauges[gauge].measured else { continue };
            let turns = ((start.value - self.dynamics.work.readings[gauge].x) / TAU).round();
            self.modes[m.switches + winding] += 2 * turns as i32;
            self.dynamics.work.readings[gauge].x += turns * TAU;
        }
    }

    /// Free bodies begin at the orientation that is asked for.
    fn orient(&self, q: &mut [f64]) {
        let m = self.dynamics.mechanism;
        for (body, r) in &m.orientations {
            let Some(node) = m.nodes.iter().find(|n| n.body == *body && n.parent == 0) else { continue };
            for step in &m.steps[node.steps.clone()] {
                if let Step::Ball { q: k, reversed: false, .. } = step {
                    let rotation = nalgebra::Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_fn(|i, k| r[i][k]));
                    let unit = nalgebra::UnitQuaternion::from_rotation_matrix(&rotation);
                    q[*k..k + 4].copy_from_slice(&[unit.w, unit.i, unit.j, unit.k]);
                }
            }
        }
    }

    /// Residual and Jacobian of constraints and exact values.
    fn hard(&self, r: &mut Vec<f64>, jacobian: &mut Vec<f64>) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        r.clear();
        jacobian.clear();
        for &row in &self.rows {
            let scale = if m.rows[row].angular { 1.0 } else { 1.0 / self.size };
            r.push(w.phi[row] * scale);
            jacobian.extend(w.g[row * m.nv..(row + 1) * m.nv].iter().map(|x| x * scale));
        }
        if self.held != Held::Nothing {
            self.asked(self.held == Held::Exact, r, jacobian);
        }
    }

    /// Size of the rows of `hard`, before their entries cancel, in the metric: singular values below 1e-11 of it are round-off.
    fn round_off(&self, metric: &[f64]) -> f64 {
        let m = self.dynamics.mechanism;
        let scale = |row: usize| if m.rows[row].angular { 1.0 } else { 1.0 / self.size };
        let natural = self.dynamics.natural_length(metric);
        ROUND_OFF * self.rows.iter().map(|&row| natural[row] * scale(row)).fold(0.0, f64::max)
    }

    /// Closes constraints and held values; false if they stay open.
    fn close(&mut self, q: &mut Vec<f64>, metric: &[f64]) -> bool {
        let (mut r, mut jacobian) = (Vec::new(), Vec::new());
        let mut damping = 0.0;
        self.evaluate(q);
        self.hard(&mut r, &mut jacobian);
        let mut size = norm(&r);
        for _ in 0..200 {
            if size < CONVERGED {
                // one more step takes the last digits
                let b: Vec<f64> = r.iter().map(|r| -r).collect();
                self.dynamics.mechanism.retract(q, &shortest_beyond(self.round_off(metric), &jacobian, &b, metric, 0.0));
                self.evaluate(q);
                return true;
            }
            let b: Vec<f64> = r.iter().map(|r| -r).collect();
            let delta = self.bounded(shortest_beyond(self.round_off(metric), &jacobian, &b, metric, damping));
            let mut trial = q.clone();
            self.dynamics.mechanism.retract(&mut trial, &delta);
            self.evaluate(&trial);
            let (mut r_trial, mut jacobian_trial) = (Vec::new(), Vec::new());
            self.hard(&mut r_trial, &mut jacobian_trial);
            let size_trial = norm(&r_trial);
            if size_trial < size {
                // a step that gains less than a part in 10⁶ has found the smallest gap
                let stuck = size_trial > size * (1.0 - 1e-6) && size > 1e-6;
                (*q, r, jacobian, size) = (trial, r_trial, jacobian_trial, size_trial);
                damping = if damping > 1e-9 { damping / 10.0 } else { 0.0 };
                if stuck {
                    return false;
                }
            } else {
                damping = if damping == 0.0 { 1e-6 } else { damping * 10.0 };
                if damping > 1e6 {
                    return false;
                }
            }
        }
        false
    }

    /// A step of at most half a radian or half the size of the mechanism beside a common shift of bodies, which may be as far as it likes.
    fn bounded(&self, mut delta: Vec<f64>) -> Vec<f64> {
        let unit = units(self.dynamics.mechanism);
        let left = self.dynamics.mechanism.without_shift(&delta);
        let largest = left.iter().zip(&unit).map(|(d, u)| d.abs() / if *u == 0 { 0.5 } else { 0.5 * self.size }).fold(0.0, f64::max);
        if largest > 1.0 {
            delta.iter_mut().for_each(|d| *d /= largest);
        }
        delta
    }

    /// Whether cut joints keep their axes the right way round.
    fn faces(&self) -> bool {
        self.wrong_way().is_none()
    }

    fn wrong_way(&self) -> Option<usize> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        m.joints.iter().position(|j| {
            j.tree.is_none()
                && j.facing.iter().any(|&(u, f)| G::dot(G::rotate(w.places[j.a.0].r, u), G::rotate(w.places[j.b.0].r, f)) < 0.0)
        })
    }
}

/// Velocities from drivers and exact values; what is left over stays as near as can be to the guesses, else at rest.
fn velocity<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    q: &[f64],
    modes: &[i32],
    metric: &[f64],
    size: f64,
) -> Result<(Vec<f64>, Vec<Found>), AssemblyFault> {
    let m = mechanism;
    let mut dynamics = Dynamics::new(m);
    let zeros = vec![0.0; m.nv];
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    dynamics.velocity(&zeros, modes);
    dynamics.watch(q, &zeros, modes);
    let row_of = |asked: Asked| {
        let mut row = vec![0.0; m.nv];
        match asked {
            Asked::Gauge { gauge, .. } => {
                m.gauges[gauge].project(&dynamics.work.readings[gauge], &dynamics.work.columns, |k, x| row[k] = x);
            }
            Asked::Spin { body, axis } => {
                for &k in &m.bodies[body].path {
                    row[k] = G::spin_component(dynamics.work.columns[k].w, axis);
                }
            }
        }
        row
    };
    let velocity_level = |asked: Asked| matches!(asked, Asked::Gauge { order: 1, .. } | Asked::Spin { .. });
    let wanted = |guess: bool| m.starts.iter().filter(move |s| s.guess == guess && velocity_level(s.asked));
    // guesses first
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for start in wanted(true) {
        a.extend(row_of(start.asked));
        b.push(start.value);
    }
    let mut v = shortest(&a, &b, metric, 0.0);
    // then what must hold, by the shortest change
    let mut a = dynamics.work.g.clone();
    let mut b = dynamics.work.nu.clone();
    for start in wanted(false) {
        a.extend(row_of(start.asked));
        b.push(start.value);
    }
    let missing = |v: &[f64]| -> Vec<f64> {
        b.iter().enumerate().map(|(i, b)| b - a[i * m.nv..(i + 1) * m.nv].iter().zip(v).map(|(a, v)| a * v).sum::<f64>()).collect()
    };
    let round_off = ROUND_OFF * dynamics.natural_length(metric).into_iter().fold(0.0, f64::max);
    for _ in 0..2 {
        let delta = shortest_beyond(round_off, &a, &missing(&v), metric, 0.0);
        v.iter_mut().zip(delta).for_each(|(v, d)| *v += d);
    }
    let scale = 1.0 + b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let off = missing(&v);
    if let Some((i, x)) = off.iter().enumerate().max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()))
        && x.abs() > 1e-7 * scale * (1.0 + size)
    {
        let held = i.checked_sub(m.rows.len()).and_then(|k| wanted(false).nth(k));
        let what = match held {
            Some(s) => format!("the exact start value {} = {} {}", s.name, short(s.value), unit(m, s.asked)),
            None => m.name_of_row(i),
        };
        let missed = format!("missed by {} {}", short(*x), held.map_or_else(|| unit_of_rate(m, i), |s| unit(m, s.asked)));
        let missed = missed.trim_end();
        let start = Assembled { q: q.to_vec(), v, modes: modes.to_vec(), size, metric: metric.to_vec(), found: vec![] };
        let (freedom, drivers) = (super::mobility::mobility(m, &start).freedom, m.drives.len());
        if held.is_none() && freedom < drivers {
            return Err(AssemblyFault {
                code: "over-constrained",
                message: format!(
                    "{drivers} drivers for a mechanism of {freedom} degree{} of freedom: {what} is {missed} at the start",
                    if freedom == 1 { "" } else { "s" }
                ),
                place: "drivers".into(),
                help: "remove drivers until there are as many as degrees of freedom".into(),
            });
        }
        return Err(AssemblyFault {
            code: "start-cannot-hold",
            message: format!("the start velocities contradict each other or the drivers: {what} is {missed}"),
            place: held.map_or_else(|| "start".into(), |s| s.place.clone()),
            help: match held {
                Some(_) => "put `~` before it, or remove it: drivers and other exact values fix it already".into(),
                None => "put `~` before one of the velocities, or remove it".into(),
            },
        });
    }
    dynamics.velocity(&v, modes);
    dynamics.watch(q, &v, modes);
    let found = m
        .starts
        .iter()
        .map(|s| Found {
            name: s.name.clone(),
            asked: s.value,
            found: match s.asked {
                Asked::Gauge { gauge, order: 0 } => dynamics.work.readings[gauge].x,
                Asked::Gauge { gauge, .. } => dynamics.work.readings[gauge].rate,
                Asked::Spin { body, axis } => G::spin_component(dynamics.work.twists[body].w, axis),
            },
            guess: s.guess,
            unit: unit(m, s.asked),
        })
        .collect();
    Ok((v, found))
}

/// Unit of a start value.
fn unit<G: Space>(m: &Mechanism<G>, asked: Asked) -> &'static str {
    match asked {
        Asked::Spin { .. } => "rad/s",
        Asked::Gauge { gauge, order } => match (m.gauges[gauge].turns(), order) {
            (true, 0) => "rad",
            (true, _) => "rad/s",
            (false, 0) => "m",
            (false, _) => "m/s",
        },
    }
}

/// Unit of the rate of a row; none for a coupling by an expression.
fn unit_of_rate<G: Space>(m: &Mechanism<G>, row: usize) -> &'static str {
    match &m.rows[row] {
        Row { kind: RowKind::Function(_), .. } => "",
        Row { angular: true, .. } => "rad/s",
        _ => "m/s",
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A fixed sequence in (−1, 1).
struct Shake(u64);

impl Shake {
    /// A displacement of `nv` parts of at most this size.
    fn displacement(&mut self, nv: usize, size: f64) -> Vec<f64> {
        (0..nv).map(|_| self.next() * size).collect()
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
