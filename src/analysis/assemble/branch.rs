//! Starts in a change point, where branches of the motion cross: the rows lose rank there, and a direction u that they leave is no
//! motion of its own.
//!
//! With l the combinations of rows that vanish, lᵀG = 0, an acceleration exists only where lᵀγ(v) = 0. Along v + z u that is a
//! quadratic equation in z, whose roots are the branches; where rows are redundant everywhere it is 0 = 0. (Lerbet & Hao, Mechanism
//! and Machine Theory 34 (1999) 1055-1069: the tangent cone of second order.)
//!
//! Of two branches counts the one that guessed rates name, else the one whose rates are nearest to zero, as in any start.

use super::close::{Held, System};
use super::explain::short;
use super::norm;
use crate::analysis::least_squares::{Level, left_open};
use crate::geometry::Space;

/// Part by which a branch must be better than the other to be chosen.
const BETTER: f64 = 1e-6;

/// Part of v² below which an equation of second order has no term.
const NOTHING: f64 = 1e-8;

/// How far beside a change point the mechanism is looked at, rad or sizes.
const BESIDE: f64 = 0.02;

/// A start in a change point.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangePoint {
    /// Coordinates a little way along the branch that was taken (nq), where the rows have the rank that they have elsewhere.
    pub beside: Vec<f64>,
    /// Which branches there are, and which was taken.
    pub message: String,
}

impl<G: Space<S = f64>> System<'_, G> {
    /// The velocity on the branch that counts, and the change point with coordinates in this tree, if the position is one.
    pub(super) fn branch(&mut self, q: &[f64], v: &[f64], holds: &Level) -> Option<(Vec<f64>, ChangePoint)> {
        let branches = self.branches(q, v, holds)?;
        let taken = self.choose(q, &branches);
        let told: Vec<String> = branches.iter().map(|branch| self.told(q, branch)).collect();
        let message = format!(
            "the start is a change point: the motion can go on with {}; the first is taken. A guess of a rate names the other, as `{}`",
            [&told[taken], &told[1 - taken]].map(|rates| format!("({rates})")).join(" or with "),
            self.as_guess(q, &branches[1 - taken], &branches[taken])
        );
        let v = branches[taken].clone();
        let beside = self.beside(q, &v)?;
        Some((v, ChangePoint { beside, message }))
    }

    /// Velocities of two branches that cross at the position.
    fn branches(&mut self, q: &[f64], v: &[f64], holds: &Level) -> Option<[Vec<f64>; 2]> {
        let (nv, rows) = (self.metric.len(), self.dynamics.mechanism.rows.len());
        if rows == 0 {
            return None;
        }
        let open = left_open(holds.round_off, &holds.a, &self.metric);
        if open.ncols() != 1 {
            return None;
        }
        // combinations of rows that vanish
        let transposed: Vec<f64> =
            (0..nv).flat_map(|k| (0..rows).map(move |i| (i, k))).map(|(i, k)| holds.a[i * nv + k] / self.metric[k].sqrt()).collect();
        let vanishing = left_open(holds.round_off, &transposed, &vec![1.0; rows]);
        let speed = v.iter().zip(&self.metric).map(|(v, d)| d * v * v).sum::<f64>().sqrt();
        if speed == 0.0 || vanishing.ncols() == 0 {
            return None;
        }
        let at = |z: f64| -> Vec<f64> { v.iter().zip(open.column(0).iter()).map(|(v, u)| v + z * speed * u).collect() };
        let mut defect = |z: f64| {
            let gamma = self.gamma(q, &at(z));
            vanishing.column_iter().map(|l| l.iter().zip(&gamma).map(|(l, g)| l * g).sum::<f64>()).collect::<Vec<f64>>()
        };
        let [middle, plus, minus] = [0.0, 1.0, -1.0].map(&mut defect);
        // of several equations the one that tells most; the others must agree
        let terms = |i: usize| [middle[i], 0.5 * (plus[i] - minus[i]), 0.5 * (plus[i] + minus[i]) - middle[i]];
        let weight = |i: usize| terms(i)[1].abs() + terms(i)[2].abs();
        let most = (0..middle.len()).max_by(|&i, &k| weight(i).total_cmp(&weight(k)))?;
        let [c, b, a] = terms(most);
        let disc = b * b - 4.0 * a * c;
        if a.abs() < NOTHING * speed * speed || disc < NOTHING * weight(most).powi(2) {
            return None;
        }
        // without cancellation: z₁ = h/a, z₂ = c/h with h = −½ (b ± √disc)
        let h = -0.5 * (b + disc.sqrt().copysign(b));
        let roots = [h / a, c / h];
        let holds = |z: f64| {
            (0..middle.len()).all(|i| (terms(i)[0] + z * (terms(i)[1] + z * terms(i)[2])).abs() < 1e-6 * speed * speed * (1.0 + z * z))
        };
        roots.iter().all(|z| holds(*z)).then(|| roots.map(at))
    }

    /// γ in rad and sizes at a velocity.
    fn gamma(&mut self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let modes = self.modes.clone();
        self.dynamics.velocity(v, &modes);
        self.dynamics.watch(q, v, &modes);
        let rows = self.dynamics.mechanism.rows.iter().zip(&self.dynamics.work.gamma);
        rows.map(|(row, gamma)| if row.angular { *gamma } else { gamma / self.size }).collect()
    }

    /// Which of two branches counts.
    fn choose(&self, q: &[f64], branches: &[Vec<f64>; 2]) -> usize {
        let rest = self.rest(q);
        let scores = [&self.guessed_rates(), &rest].map(|level| branches.each_ref().map(|v| norm(&level.missing(v))));
        for [first, second] in scores {
            if (first - second).abs() > BETTER * (first.abs() + second.abs()) + f64::MIN_POSITIVE.sqrt() {
                return usize::from(second < first);
            }
        }
        0
    }

    /// Rates of the joints' first coordinates.
    fn rates_of_joints(&mut self, q: &[f64], v: &[f64]) -> Vec<(String, f64, bool)> {
        let _ = self.gamma(q, v);
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let first = m.joints.iter().filter_map(|joint| Some((joint, *joint.slots.first()?)));
        first.map(|(joint, slot)| (joint.name.clone(), w.readings[slot].rate, m.gauges[slot].turns())).collect()
    }

    fn told(&mut self, q: &[f64], v: &[f64]) -> String {
        let size = norm(v);
        let clean = |x: f64| if x.abs() < 1e-9 * size { 0.0 } else { x };
        let rates = self.rates_of_joints(q, v);
        let told =
            rates.iter().map(|(name, rate, turns)| format!("{name} at {} {}", short(clean(*rate)), if *turns { "rad/s" } else { "m/s" }));
        told.collect::<Vec<_>>().join(", ")
    }

    /// The rate that tells a branch best from the other, as a guess in `start`.
    fn as_guess(&mut self, q: &[f64], branch: &[f64], other: &[f64]) -> String {
        let (ours, theirs) = (self.rates_of_joints(q, branch), self.rates_of_joints(q, other));
        let apart = |k: &usize| (ours[*k].1 - theirs[*k].1).abs();
        let best = (0..ours.len()).max_by(|i, k| apart(i).total_cmp(&apart(k)));
        best.map_or_else(String::new, |k| {
            let (name, rate, turns) = &ours[k];
            let (word, unit) = if *turns { ("omega", "rad/s") } else { ("velocity", "m/s") };
            format!("{name}.{word}: ~{} {unit}", short(*rate))
        })
    }

    /// The position a little way along a velocity, closed again.
    fn beside(&mut self, q: &[f64], v: &[f64]) -> Option<Vec<f64>> {
        let speed = v.iter().zip(&self.metric).map(|(v, d)| v.abs() * d.sqrt()).fold(0.0, f64::max);
        let m = self.dynamics.mechanism;
        self.rows = (0..m.rows.len()).filter(|r| !m.rows[*r].anchored && !m.is_moved(&m.rows[*r])).collect();
        self.held = Held::Nothing;
        let mut beside = q.to_vec();
        m.retract(&mut beside, &v.iter().map(|v| BESIDE * v / speed).collect::<Vec<_>>());
        self.close(&mut beside).then_some(beside)
    }
}
