//! Scales of the constraint rows: each by its own natural size, so that round-off is told from a constraint.
//!
//! An entry of G is W · s with the unit wrench W = (p × f, f) of a gauge and the column s = (ω, −ω × p_k + d) of a velocity,
//!
//! ```text
//! W · s = f · (ω × (p − p_k)) + f · d,      natural size: |f| |ω| (ℓ + ℓ_k) + |f| |d|,
//! ```
//!
//! where the place p, from the reference point, is the sum of what lies between the two, of the size ℓ: it can cancel, its round-off
//! does not. A
//! couple n · ω has |n| |ω|. A second hinge on the axis of the first has entries of about 1e-16 in its rows and a natural size of 1.

use super::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Gauge, Measured, Row, RowKind, RowOwner, Step};
use grashof_solvers::Block;
use grashof_solvers::kkt::natural_row_scale;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};

/// Positions around: the coordinate that moves most does so by 0.4 rad or sizes of the mechanism, one way and the other.
const STEP: f64 = 0.4;
const GOLDEN: f64 = 2.4;
const PHASES: [f64; 2] = [0.0, 2.0];

/// A row whose square is below this part of what it is around happens to vanish here.
const VANISHING: f64 = 1e-2;

/// Sizes of what the gauges are made of at one position.
struct Sizes {
    /// ℓ of each body: the largest distance from the reference point on its road from the ground, m.
    reach: Vec<f64>,
    /// |ω|, |d| and ℓ of each column.
    columns: Vec<[f64; 3]>,
}

impl<G: Space<S = f64>> Dynamics<'_, G> {
    /// The `row_scale` (rows) with its mean for the rows that are components of one vector, the force or the couple of a joint.
    #[must_use]
    pub fn vector_scale(&self, row_scale: &[f64]) -> Vec<f64> {
        let of_one = |a: &Row<G>, b: &Row<G>| matches!(a.owner, RowOwner::Joint(_)) && (a.owner, a.angular) == (b.owner, b.angular);
        let mut scale = row_scale.to_vec();
        let mut first = 0;
        for components in self.mechanism.rows.chunk_by(of_one).map(<[_]>::len) {
            let of_vector = &mut scale[first..first + components];
            let mean = of_vector.iter().sum::<f64>() / components as f64;
            of_vector.fill(mean);
            first += components;
        }
        scale
    }

    /// diag(G D⁻¹ Gᵀ) (rows) at the coordinates `q` (nq) evaluated last, with D (nv) the `metric`: by the natural sizes of the rows,
    /// and for rows that vanish here by their entries in positions around. Allocates.
    #[must_use]
    pub fn row_scale(&self, q: &[f64], modes: &[i32], metric: &[f64]) -> Vec<f64> {
        let m = self.mechanism;
        let mut natural = self.natural();
        let here = &self.work.g;
        // by what rows are made of: one that nearly vanishes here would take the round-off of its other entries for constraints
        let positions = self.around(q, &natural_row_scale(here.pattern(), natural.values(), natural.values(), metric), metric);
        if positions.is_empty() {
            return natural_row_scale(here.pattern(), here.values(), natural.values(), metric);
        }
        let unit = m.units(m.size());
        let mut entries = here.clone();
        entries.values_mut().iter_mut().for_each(|g| *g = g.abs());
        let mut around = self.clone();
        for q in positions {
            around.position(&q, modes);
            grow(natural.values_mut(), around.natural().values());
            grow(entries.values_mut(), around.work.g.values());
        }
        let square = |columns: &[usize], row: &[f64]| columns.iter().zip(row).map(|(k, g)| (g * unit[*k]).powi(2)).sum::<f64>();
        for (i, here) in here.lines().enumerate() {
            let (columns, row) = entries.line_mut(i);
            // by units and not by D: beside the constraints a body that hardly resists a turn would count too much
            if square(columns, here.values) >= VANISHING * square(columns, row) {
                row.copy_from_slice(here.values);
            }
        }
        natural_row_scale(entries.pattern(), entries.values(), natural.values(), metric)
    }

    /// Positions (nq each) around `q`, that evaluated last: far along motions that the rows, of the scale `scale`, leave but for those
    /// that time moves. None if they leave none. Allocates.
    #[must_use]
    pub fn around(&self, q: &[f64], scale: &[f64], metric: &[f64]) -> Vec<Vec<f64>> {
        let m = self.mechanism;
        let passive: Vec<usize> = (0..m.rows.len()).filter(|&row| !m.is_moved(&m.rows[row])).collect();
        if passive.is_empty() {
            return Vec::new();
        }
        let scale: Vec<f64> = passive.iter().map(|&row| scale[row]).collect();
        let rank = Rank::new(&self.work.g.select_rows(&passive), metric, &scale, RANK_TOLERANCE);
        let (n, unit) = (rank.mobility, m.units(m.size()));
        let along = |phase: f64| {
            // in no special direction
            let y: Vec<f64> = (0..n).map(|k| (GOLDEN * k as f64 + phase).cos()).collect();
            let delta = rank.motion(&y);
            let most = delta.iter().zip(&unit).fold(0.0, |m, (d, u): (&f64, &f64)| f64::max(m, d.abs() / u));
            let delta: Vec<f64> = delta.iter().map(|d| STEP * d / most).collect();
            let mut there = q.to_vec();
            m.retract(&mut there, &delta);
            there
        };
        if n == 0 { Vec::new() } else { PHASES.map(along).to_vec() }
    }

    /// Sizes of the entries of G (rows × nv) before they cancel, at the position evaluated last. Allocates.
    #[must_use]
    pub fn natural(&self) -> Block {
        let m = self.mechanism;
        let sizes = self.sizes();
        let mut out = Block::new(self.work.g.pattern());
        let mut line = vec![0.0; m.nv];
        for (i, row) in m.rows.iter().enumerate() {
            let (columns, values) = out.line_mut(i);
            columns.iter().for_each(|k| line[*k] = 0.0);
            let mut add = |gauge: usize, slope: f64| {
                sizes.project(&m.gauges[gauge], self, |k, x| line[k] += slope.abs() * x);
            };
            match row.kind {
                RowKind::Gauge(gauge) | RowKind::Driver { gauge, .. } => add(gauge, 1.0),
                RowKind::Ratio { first, second, ratio } => {
                    add(second, 1.0);
                    add(first, ratio);
                }
                RowKind::Function(f) => {
                    let function = &m.functions[f];
                    let slopes = &self.work.functions[function.value + 1..];
                    function.gauges.iter().zip(slopes).for_each(|(&gauge, &slope)| add(gauge, slope));
                }
            }
            values.iter_mut().zip(columns).for_each(|(value, k)| *value = line[*k]);
        }
        out
    }

    /// Length of each row of [`Dynamics::natural`] times D^−½ (rows), at the position evaluated last. Allocates.
    #[must_use]
    pub fn natural_length(&self, metric: &[f64]) -> Vec<f64> {
        self.natural().lines().map(|row| row.entries().map(|(k, x)| x * x / metric[k]).sum::<f64>().sqrt()).collect()
    }

    fn sizes(&self) -> Sizes {
        let (m, w) = (self.mechanism, &self.work);
        let mut sizes = Sizes { reach: vec![0.0; m.bodies.len()], columns: vec![[0.0; 3]; m.nv] };
        for node in &m.nodes {
            let after = node.after.map_or(0.0, |x| length::<G>(x.p));
            let from = if node.parent == 0 {
                length::<G>(node.before.p - self.reference(node.body))
            } else {
                length::<G>(w.places[node.parent].p) + length::<G>(node.before.p)
            };
            let far = [from, length::<G>(w.places[node.body].p) + after];
            let reach = far.into_iter().fold(sizes.reach[node.parent], f64::max);
            sizes.reach[node.body] = reach;
            for step in &m.steps[node.steps.clone()] {
                match *step {
                    Step::Axis { d, turns, v, .. } => sizes.columns[v] = [f64::from(u8::from(turns)), length::<G>(d), reach],
                    Step::Ball { v, .. } => sizes.columns[v..v + G::SPIN].fill([1.0, 0.0, reach]),
                }
            }
        }
        sizes
    }
}

impl Sizes {
    /// Sizes of ∂ẋ/∂v_k for the columns of a gauge, written by `put(k, size)`.
    fn project<G: Space<S = f64>>(&self, gauge: &Gauge<G>, d: &Dynamics<'_, G>, mut put: impl FnMut(usize, f64)) {
        let (places, group) = (&d.work.places, d.mechanism.group_between(gauge.a, gauge.b));
        let reach = |body: usize, p: G::Vector| match body {
            0 => length::<G>(d.place(group, 0, p)),
            _ => f64::max(self.reach[body], length::<G>(places[body].p) + length::<G>(p)),
        };
        // |n|, |f| and ℓ of the wrench
        let [couple, force, far] = match gauge.measured {
            Measured::Coordinate { along, .. } => return put(along.v, 1.0),
            Measured::Slide { pa, pb, .. } | Measured::Distance { pa, pb } => [0.0, 1.0, f64::max(reach(gauge.a, pa), reach(gauge.b, pb))],
            Measured::Dot { .. } | Measured::Angle => [1.0, 0.0, 0.0],
            Measured::Quaternion { .. } => [0.5, 0.0, 0.0],
            Measured::Turn { e1, e2, f, .. } => {
                // θ̇ is the rate of the part of f in the plane, over its length
                let f = G::rotate(places[gauge.b].r, f);
                let [c, s] = [e1, e2].map(|e| G::dot(f, G::rotate(places[gauge.a].r, e)));
                [c.hypot(s).recip(), 0.0, 0.0]
            }
        };
        for &(k, _) in &gauge.columns {
            let [turns, slides, at] = self.columns[k];
            put(k, couple * turns + force * (turns * (far + at) + slides));
        }
    }
}

/// Each size becomes that of the other entry, if it is a larger number: a function may have none there.
fn grow(sizes: &mut [f64], other: &[f64]) {
    sizes.iter_mut().zip(other).filter(|(_, x)| x.is_finite()).for_each(|(size, x)| *size = size.abs().max(x.abs()));
}

fn length<G: Space<S = f64>>(p: G::Vector) -> f64 {
    G::dot(p, p).sqrt()
}
