//! Starts in change points, where branches of the motion cross: which there are, and which one the motion takes.
//!
//! The branches are the parts of the cone of `cone.rs` on which drivers and exact rates can be met. Of several counts the one that
//! guessed rates name; else the one that leads towards guessed positions that the start does not meet; else the one whose rates are
//! nearest to zero, as in any start. At rest a branch has no rates yet: drivers that begin to move lead along it, and where there
//! are none the forces decide when the motion begins.

use super::close::{CONVERGED, Held, System};
use super::cone::{Cone, MOST, Part};
use super::explain::short;
use super::metric::norm;
use super::shake::Shake;
use crate::geometry::Space;
use crate::mechanism::Step;
use crate::numerics::least_squares::{Level, Rows, in_turn};
use grashof_solvers::svd::Svd;
use nalgebra::{DMatrix, DVector};

/// Part by which a branch must be better than the other to be chosen.
const BETTER: f64 = 1e-6;

/// Distance between the places of a curve along a branch, rad or sizes; the first is where the rows have their common rank.
const BESIDE: f64 = 5e-3;

/// Part of a row below which it leaves a branch alone.
const SMALL: f64 = 1e-8;

/// Most branches that are named one by one.
const MOST_NAMED: usize = 8;

/// A start in a change point.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangePoint {
    /// The branches that drivers and exact rates leave; the one that is taken first.
    pub branches: Vec<Branch>,
    /// Whether nothing moves yet.
    pub rests: bool,
    /// Whether nothing in the file says which branch is taken.
    pub open: bool,
    /// What it is, in words.
    message: String,
}

/// A branch of the motion through a change point.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Velocities whose combinations begin it (nv each), along the motion the first.
    pub ways: Vec<Vec<f64>>,
    /// Coordinates (nq) at places along the first of `ways`, where the rows have the rank that they have elsewhere.
    pub curve: Vec<(f64, Vec<f64>)>,
    /// The rates of its joints.
    description: String,
}

impl ChangePoint {
    /// What a reader should know.
    #[must_use]
    pub fn message(&self) -> String {
        match (self.open, self.branches.len()) {
            (true, _) => format!("{}; at rest the forces decide when the motion begins", self.message),
            (false, 1) => self.message.clone(),
            (false, _) => format!("{}; the first is taken", self.message),
        }
    }

    /// Coordinates beside it, on the branch that is taken.
    #[must_use]
    pub fn beside(&self) -> Option<&Vec<f64>> {
        self.branches.first()?.curve.first().map(|(_, q)| q)
    }

    /// The same with coordinates and velocities in another form: `carried` gives both.
    #[must_use]
    pub fn carried(&self, carried: impl Fn(&[f64], &[f64]) -> (Vec<f64>, Vec<f64>), at: &[f64]) -> Self {
        let mut other = self.clone();
        for branch in &mut other.branches {
            branch.ways.iter_mut().for_each(|way| *way = carried(at, way).1);
            let way = vec![0.0; self.branches[0].ways[0].len()];
            branch.curve.iter_mut().for_each(|(_, q)| *q = carried(q, &way).0);
        }
        other
    }
}

impl Branch {
    /// Coordinates (nq) at the place `s` along the branch, by the polynomial through the curve.
    #[must_use]
    pub fn at(&self, s: f64) -> Vec<f64> {
        let mut sum = vec![0.0; self.curve.first().map_or(0, |(_, q)| q.len())];
        for (k, (at, q)) in self.curve.iter().enumerate() {
            let others = self.curve.iter().enumerate().filter(|(i, _)| *i != k);
            let weight: f64 = others.map(|(_, (other, _))| (s - other) / (at - other)).product();
            sum.iter_mut().zip(q).for_each(|(sum, q)| *sum += weight * q);
        }
        sum
    }

    /// How far along it the curve reaches.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.curve.iter().fold(0.0, |m, (s, _)| f64::max(m, s.abs()))
    }
}

/// A branch that may be taken: its velocity, which is its direction where nothing moves yet, and its space.
struct Candidate {
    v: Vec<f64>,
    space: DMatrix<f64>,
}

impl<G: Space<S = f64>> System<'_, G> {
    /// The change point with the velocity on the branch that counts, if the position is one; `levels` are what holds, guesses, rest.
    ///
    /// # Errors
    /// The branches, in words, if there is none on which all that holds can be met.
    pub(super) fn change(&mut self, q: &[f64], v: &[f64], levels: &[Level; 3]) -> Result<Option<(Vec<f64>, ChangePoint)>, String> {
        let Some(cone) = self.cone(q) else { return Ok(None) };
        let parts = cone.parts();
        let coming = self.coming(q);
        self.place(q);
        let mut holds = levels[0].clone();
        for (b, coming) in holds.b.iter_mut().zip(coming.iter().flatten()) {
            *b = *coming;
        }
        let driven = coming.is_some() || norm(v) > 0.0 || levels.iter().any(|level| level.b.iter().any(|b| *b != 0.0));
        let mut candidates: Vec<Candidate> = Vec::new();
        for part in &parts {
            let found = match part {
                Part::Flat(space) if driven => vec![self.on(space, &holds, &levels[1..])],
                Part::Flat(space) => vec![Candidate { v: space.column(0).as_slice().to_vec(), space: space.clone() }],
                Part::Curved => self.on_curved(&cone, v, &holds),
            };
            for one in found {
                let new = candidates.iter().all(|other| norm(&difference(&one.v, &other.v)) > 1e-6 * norm(&one.v));
                if new && meets(&holds, &one.v) {
                    candidates.push(one);
                }
            }
        }
        if candidates.is_empty() && !parts.is_empty() {
            let spaces: Vec<&DMatrix<f64>> = parts.iter().filter_map(|p| if let Part::Flat(s) = p { Some(s) } else { None }).collect();
            let words: Vec<String> =
                spaces.iter().take(MOST_NAMED).map(|space| self.describe(q, space.column(0).as_slice(), true)).collect();
            self.place(q);
            return Err(words.join(", "));
        }
        let rests = coming.is_some() || !driven || candidates.iter().all(|c| norm(&c.v) == 0.0);
        let chosen = self.choose(q, &candidates, &levels[1], rests, coming.is_some());
        let mut branches = Vec::new();
        if let Some(first) = chosen.filter(|&first| first > 0) {
            candidates.swap(0, first);
        }
        for candidate in &candidates {
            let description = self.describe(q, &candidate.v, rests);
            if let Some(curve) = self.curve(q, &candidate.v, coming.is_some().then_some(&holds.b)) {
                let mut ways = vec![candidate.v.clone()];
                if candidate.space.ncols() > 1 {
                    ways = candidate.space.column_iter().map(|way| way.as_slice().to_vec()).collect();
                }
                branches.push(Branch { ways, curve, description });
            }
        }
        let taken = candidates.first().map(|c| c.v.clone());
        let named = candidates.get(1).map(|other| self.as_guess(q, &other.v, &candidates[0].v, rests && coming.is_none()));
        self.place(q);
        let (Some(taken), false) = (taken, branches.is_empty()) else { return Ok(None) };
        if parts.len() < 2 && branches.len() < 2 {
            // no other branch crosses here
            return Ok(None);
        }
        let message = message(&branches, parts.len(), named, rests);
        let v = if rests { vec![0.0; v.len()] } else { taken };
        let open = chosen.is_none() && rests && coming.is_none() && branches.len() > 1;
        Ok(Some((v, ChangePoint { branches, rests, open, message })))
    }

    /// Evaluates a position at the start of time.
    pub(super) fn place(&mut self, q: &[f64]) {
        let (modes, zeros) = (self.modes.clone(), vec![0.0; self.metric.len()]);
        self.dynamics.time(0.0, &modes);
        self.dynamics.position(q, &modes);
        self.dynamics.velocity(&zeros, &modes);
        self.dynamics.watch(q, &zeros, &modes);
    }

    /// The velocity in a space that meets what holds, then the guesses, then rests.
    fn on(&self, space: &DMatrix<f64>, holds: &Level, others: &[Level]) -> Candidate {
        let f = space.ncols();
        let within = |level: &Level| {
            let mut rows = Rows::default();
            let along = |row: &[(usize, f64)], i: usize| row.iter().map(|&(k, a)| a * space[(k, i)]).sum();
            level.rows.lines().for_each(|row| rows.push((0..f).map(|i| (i, along(row, i)))));
            // what vanishes on the branch but for rounding does so
            Level { rows, b: level.b.clone(), round_off: SMALL * level.rows.longest(&self.metric) }
        };
        let levels: Vec<Level> = std::iter::once(holds).chain(others).map(within).collect();
        let y = in_turn(&levels, &vec![1.0; f], vec![0.0; f]);
        Candidate { v: (space * DVector::from_vec(y)).as_slice().to_vec(), space: space.clone() }
    }

    /// Velocities on a curved cone that meet what holds: all of them where they are places, else the one nearest to `v`.
    fn on_curved(&self, cone: &Cone, v: &[f64], holds: &Level) -> Vec<Candidate> {
        let (nv, k) = cone.open.shape();
        let a = DMatrix::from_row_slice(holds.b.len(), nv, &holds.rows.to_dense(nv)) * &cone.open;
        let b = DVector::from_column_slice(&holds.b);
        let first: DVector<f64> = DVector::from_fn(k, |i, _| (0..nv).map(|r| cone.open[(r, i)] * self.metric[r] * v[r]).sum());
        let size = f64::max(first.norm(), 1.0);
        let mut shake = Shake(7);
        let mut found = Vec::new();
        for trial in 0..20 {
            let mut x = first.clone();
            if trial > 0 {
                x.iter_mut().for_each(|x| *x += size * shake.next());
            }
            for _ in 0..30 {
                let (values, slopes) = cone.values(&x);
                let rows =
                    DMatrix::from_fn(
                        a.nrows() + slopes.nrows(),
                        k,
                        |i, j| if i < a.nrows() { a[(i, j)] } else { slopes[(i - a.nrows(), j)] },
                    );
                let open: Vec<f64> = (&b - &a * &x).iter().copied().chain(values.iter().map(|f| -f)).collect();
                let svd = Svd::new(&rows);
                let least = 1e-9 * svd.largest();
                let way = DVector::from_vec(svd.solve(&open, |s| if s > least { 1.0 / s } else { 0.0 }));
                x += &way;
                if way.norm() < 1e-14 * size {
                    let determined = svd.values.iter().filter(|s| **s > least).count() == k;
                    if norm(&open) < 1e-9 * size && x.norm() > 1e-9 * size && (determined || found.is_empty()) {
                        let v = (&cone.open * &x).as_slice().to_vec();
                        found.push(Candidate { space: DMatrix::from_column_slice(nv, 1, &v), v });
                    }
                    break;
                }
            }
        }
        found
    }

    /// Where drivers that stand still at the start move to, as right sides of their rows in parts of the largest; none if some of
    /// them moves already, or there are none.
    fn coming(&mut self, q: &[f64]) -> Option<Vec<f64>> {
        self.place(q);
        let m = self.dynamics.mechanism;
        let of_drivers: Vec<usize> = (0..m.rows.len()).filter(|&r| m.is_moved(&m.rows[r])).collect();
        if of_drivers.is_empty() || of_drivers.iter().any(|&r| self.dynamics.work.nu[r] != 0.0) {
            return None;
        }
        let now = self.dynamics.work.phi.clone();
        (-6..3).find_map(|power| {
            let mut modes = self.modes.clone();
            self.dynamics.follow_time(10_f64.powi(power), &mut modes);
            self.dynamics.position(q, &modes);
            let mut moved = vec![0.0; now.len()];
            of_drivers.iter().for_each(|&r| moved[r] = (now[r] - self.dynamics.work.phi[r]) * self.row_scale(r));
            let largest = moved.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
            (largest > 1e-9).then(|| moved.iter().map(|x| x / largest).collect())
        })
    }

    /// Which branch guesses and rest name; none at rest where nothing does.
    fn choose(&mut self, q: &[f64], candidates: &[Candidate], guessed: &Level, rests: bool, coming: bool) -> Option<usize> {
        let mut scores: Vec<Vec<f64>> = Vec::new();
        if rests {
            // rates that cannot be yet name a direction
            let along = |v: &Vec<f64>| {
                let rates: Vec<f64> = guessed.missing(v).iter().zip(&guessed.b).map(|(missing, b)| b - missing).collect();
                -dot(&rates, &guessed.b) / (norm(&rates) * norm(&guessed.b)).max(f64::MIN_POSITIVE)
            };
            scores.push(candidates.iter().map(|c| along(&c.v)).collect());
        } else {
            scores.push(candidates.iter().map(|c| norm(&guessed.missing(&c.v))).collect());
        }
        if self.guesses() && self.miss(q) > 10.0 * CONVERGED {
            let (mut r, mut jacobian) = (Vec::new(), Rows::default());
            self.asked(false, &mut r, Some(&mut jacobian));
            let towards = |v: &Vec<f64>| {
                let moved: Vec<f64> = jacobian.product(v).collect();
                let part = -dot(&r, &moved) / (norm(&r) * norm(&moved)).max(f64::MIN_POSITIVE);
                // without drivers a branch at rest leads both ways
                if rests && !coming { -part.abs() } else { -part }
            };
            scores.push(candidates.iter().map(|c| towards(&c.v)).collect());
        }
        if !rests || coming {
            self.place(q);
            let rest = self.rest(q);
            scores.push(candidates.iter().map(|c| norm(&rest.missing(&c.v))).collect());
        }
        // each score is asked only among those that the scores before leave
        let mut left: Vec<usize> = (0..candidates.len()).collect();
        let all = left.len();
        for score in scores {
            let best = left.iter().fold(f64::INFINITY, |m, &i| f64::min(m, score[i]));
            let size = left.iter().fold(f64::MIN_POSITIVE.sqrt(), |m, &i| f64::max(m, score[i].abs()));
            left.retain(|&i| score[i] - best <= BETTER * size);
        }
        (left.len() < all || !rests || coming || all == 1).then(|| left.first().copied()).flatten()
    }

    /// Rates of the joints' first coordinates.
    fn rates_of_joints(&mut self, q: &[f64], v: &[f64]) -> Vec<(String, f64, bool)> {
        self.place(q);
        let _ = self.gamma(q, v);
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let first = m.joints.iter().filter_map(|joint| Some((joint, *joint.slots.first()?)));
        first.map(|(joint, slot)| (joint.name.clone(), w.readings[slot].rate, m.gauges[slot].turns())).collect()
    }

    /// The rates of a branch; where nothing moves yet in parts of the largest.
    fn describe(&mut self, q: &[f64], v: &[f64], rests: bool) -> String {
        let rates = self.rates_of_joints(q, v);
        let largest = rates.iter().fold(0.0, |m: f64, (_, rate, _)| if rate.abs() > m.abs() { *rate } else { m });
        let part = if rests && largest != 0.0 { largest } else { 1.0 };
        let clean = |x: f64| if x.abs() < 1e-6 * (largest / part).abs() { 0.0 } else { x };
        let unit = |turns: bool| match (rests, turns) {
            (true, true) => " rad",
            (true, false) => " m",
            (false, true) => " rad/s",
            (false, false) => " m/s",
        };
        let words = rates.iter().map(|(name, rate, turns)| format!("{name} at {}{}", short(clean(rate / part)), unit(*turns)));
        format!("({})", words.collect::<Vec<_>>().join(", "))
    }

    /// What tells a branch best from another, as a guess in `start`: a rate, or a position beside it.
    fn as_guess(&mut self, q: &[f64], branch: &[f64], other: &[f64], position: bool) -> String {
        let (ours, theirs) = (self.rates_of_joints(q, branch), self.rates_of_joints(q, other));
        let (size, others) = (norm(branch), norm(other));
        let apart = |k: &usize| (ours[*k].1 / size - theirs[*k].1 / others).abs();
        let best = (0..ours.len()).max_by(|i, k| apart(i).total_cmp(&apart(k)));
        let Some((k, (name, rate, turns))) = best.map(|k| (k, &ours[k])) else { return String::new() };
        if position {
            let m = self.dynamics.mechanism;
            let slot = m.joints.iter().filter_map(|joint| joint.slots.first()).nth(k);
            let now = slot.map_or(0.0, |&slot| self.dynamics.work.readings[slot].x);
            let (word, unit, far) = if *turns { ("angle", "rad", 0.1) } else { ("position", "m", 0.1 * self.size) };
            return format!("A guess of a position names another, as `{name}.{word}: ~{} {unit}`", short(now + far * rate.signum()));
        }
        let (word, unit) = if *turns { ("omega", "rad/s") } else { ("velocity", "m/s") };
        format!("A guess of a rate names another, as `{name}.{word}: ~{} {unit}`", short(*rate))
    }

    /// Places along a branch, closed: one, or where drivers that stand still lead along it, enough for a polynomial. None if the
    /// branch ends at once.
    fn curve(&mut self, q: &[f64], v: &[f64], coming: Option<&Vec<f64>>) -> Option<Vec<(f64, Vec<f64>)>> {
        let speed = v.iter().zip(&self.metric).map(|(v, d)| v.abs() * d.sqrt()).fold(0.0, f64::max);
        let places: &[i32] = if coming.is_some() { &[1, -1, 2, -2, 3, -3, 4, -4] } else { &[4] };
        let undriven = self.undriven();
        let (rows, held) = (std::mem::replace(&mut self.rows, undriven), std::mem::replace(&mut self.held, Held::Nothing));
        let mut curve = Vec::new();
        for &k in places {
            let s = BESIDE * f64::from(k) / speed;
            let mut at = q.to_vec();
            self.dynamics.mechanism.retract(&mut at, &v.iter().map(|v| v * s).collect::<Vec<_>>());
            if let Some(coming) = coming {
                self.rows = (0..self.dynamics.mechanism.rows.len()).collect();
                self.ahead = coming.iter().map(|x| x * s).collect();
            }
            if self.close(&mut at) && self.near(q, &at, v, s) {
                curve.push((s, at));
            }
        }
        (self.rows, self.held) = (rows, held);
        self.ahead.clear();
        (!curve.is_empty() && (coming.is_none() || curve.len() == places.len())).then_some(curve)
    }

    /// Whether a place lies where a branch leads.
    fn near(&self, q: &[f64], at: &[f64], v: &[f64], s: f64) -> bool {
        let axis = |step: &Step<G>| if let Step::Axis { q, v, .. } = *step { Some((q, v)) } else { None };
        self.dynamics.mechanism.steps.iter().filter_map(axis).all(|(i, k)| {
            let off = (at[i] - q[i] - s * v[k]).abs() * self.metric[k].sqrt();
            off < 0.4 * BESIDE * 4.0
        })
    }
}

/// What a change point is, in words.
fn message(branches: &[Branch], parts: usize, named: Option<String>, rests: bool) -> String {
    let words: Vec<&str> = branches.iter().take(MOST_NAMED).map(|branch| branch.description.as_str()).collect();
    let more = match branches.len() {
        n if n >= MOST => format!(" or with others, {n} at least"),
        n if n > MOST_NAMED => format!(" or with {} others", n - MOST_NAMED),
        _ => String::new(),
    };
    let all = if parts > branches.len() {
        format!(" of {parts} branches, of which drivers and exact rates leave {}", branches.len())
    } else {
        String::new()
    };
    let unit = if rests { ", in parts of the largest" } else { "" };
    let named = named.map_or_else(String::new, |guess| format!(". {guess}"));
    format!("the start is a change point{all}: the motion can go on with {}{more}{unit}{named}", words.join(" or with "))
}

/// Whether a velocity meets what holds.
fn meets(holds: &Level, v: &[f64]) -> bool {
    let scale = 1.0 + holds.b.iter().fold(0.0, |m, b| f64::max(m, b.abs()));
    holds.missing(v).iter().all(|off| off.abs() < 1e-7 * scale)
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
