//! Velocities at a switch of a coupling: over the corner of a cam, and not over a step.
//!
//! Where a function of positions switches, the rows G v = ν that it makes may jump from G₁, ν₁ to G₂, ν₂. What rigid bodies do there is taken
//! from a corner that is rounded ever less:
//!
//! ```text
//! M dv = Gᵀ dκ,   G v = ν,   G = G₁ + s (G₂ − G₁),   ν = ν₁ + s (ν₂ − ν₁),   0 ≤ s ≤ 1
//! ```
//!
//! so that dv is the shortest change, in the metric M, with G dv = dν − dG v. Its energy changes by ν·dκ, the work of rows that move with
//! time: all others pass the corner without loss, as they do a smooth curve.

use super::Mechanical;
use crate::geometry::Space;
use crate::mechanism::RowKind;
use grashof_solvers::{At, Effect, Kkt, Stage, State, System, Terms};

/// Steps of the classical Runge-Kutta method over a corner.
const STEPS: usize = 64;

/// Part of the largest rate of a row, or of what the fastest motion would give one, by which rows may miss the velocities before where there
/// is no corner.
const SMOOTH: f64 = 1e-12;

/// A jump of a prescribed rate, in radians or sizes of the mechanism per second, that is round-off of a law which comes to rest.
const SLOW: f64 = 1e-9;

/// A jump of a row, in radians or sizes of the mechanism, that is no rounding of the place of the switch.
const STEP: f64 = 1e-9;

/// Rows on both sides of a corner, and the place between.
struct Corner<'a> {
    sides: [&'a Terms; 2],
    /// G at the place looked at, and dν − dG v.
    g: Vec<f64>,
    rhs: Vec<f64>,
    zeros: Vec<f64>,
    multipliers: Vec<f64>,
}

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Leads the velocities of a state over a switch of a function of positions that has taken its new mode; `before` are the modes on the
    /// near side. A step is not passed: the state keeps these; it is one only if the state is on the surface of the switch.
    pub(super) fn turn_corner(&mut self, before: &[i32], state: &mut State, on_surface: bool) -> Effect {
        let m = self.dynamics.mechanism;
        if !m.rows.iter().any(|row| matches!(row.kind, RowKind::Function(_))) {
            return Effect::Restart;
        }
        let [mut near, mut far] = [(); 2].map(|()| Terms::new(self.dims, &self.pattern));
        self.terms(At { modes: before, ..state.at() }, Stage::Velocity, &mut near);
        self.terms(state.at(), Stage::Velocity, &mut far);
        let rows = &m.rows;
        let heights = near.phi.iter().zip(&far.phi).map(|(near, far)| far - near);
        let high = |(i, height): &(usize, f64)| height.abs() > STEP * if rows[*i].angular { 1.0 } else { self.size };
        if let Some(step) = heights.enumerate().find(high).filter(|_| on_surface) {
            self.corners.step = Some(step);
            state.modes.copy_from_slice(before);
            return Effect::Stop;
        }
        let mut corner = Corner::new([&near, &far]);
        let speed = state.v.iter().zip(&self.pattern.size_v).fold(0.0, |m: f64, (v, size)| m.max((v / size).abs()));
        let fast = |row: usize| speed * if rows[row].angular { 1.0 } else { self.size };
        let Some(row) = corner.turns(&state.v, fast) else { return Effect::Restart };
        if let Some((v, work)) = self.over(&mut corner, &state.v) {
            state.v = v;
            let before = self.corners.passed.map_or(0.0, |(_, work)| work);
            self.corners.passed = Some((row, before + work));
        }
        Effect::Restart
    }

    /// Integrates velocities over a corner; them and the work of rows that move with time, or none where the equations are singular.
    fn over(&mut self, corner: &mut Corner<'_>, before: &[f64]) -> Option<(Vec<f64>, f64)> {
        const PARTS: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
        const WEIGHTS: [f64; 4] = [1.0, 2.0, 2.0, 1.0];
        let h = 1.0 / STEPS as f64;
        let (mut v, mut work) = (before.to_vec(), 0.0);
        let (mut rate, mut at) = (vec![0.0; v.len()], v.clone());
        for step in 0..STEPS {
            let (mut sum, mut power) = (vec![0.0; v.len()], 0.0);
            for (part, weight) in PARTS.iter().zip(WEIGHTS) {
                at.iter_mut().zip(&v).zip(&rate).for_each(|((at, v), rate)| *at = v + h * part * rate);
                power += weight * self.rate_within(corner, (step as f64 + part) * h, &at, &mut rate)?;
                sum.iter_mut().zip(&rate).for_each(|(sum, rate)| *sum += weight * rate);
            }
            v.iter_mut().zip(&sum).for_each(|(v, sum)| *v += h / 6.0 * sum);
            work += h / 6.0 * power;
        }
        Some((v, work))
    }

    /// dv/ds and dW/ds at a place of a corner.
    fn rate_within(&mut self, corner: &mut Corner<'_>, s: f64, v: &[f64], rate: &mut [f64]) -> Option<f64> {
        let [near, far] = corner.sides;
        for ((g, near), far) in corner.g.iter_mut().zip(near.g.values()).zip(far.g.values()) {
            *g = near + s * (far - near);
        }
        corner.miss(v);
        let kkt = self.kkt.get_or_insert_with(|| Kkt::of_pattern(&self.pattern));
        kkt.factor(far.mass.values(), &corner.g).ok()?;
        kkt.solve(&corner.zeros, &corner.rhs, rate, &mut corner.multipliers);
        let nu = near.nu.iter().zip(&far.nu).map(|(near, far)| near + s * (far - near));
        // M dv + Gᵀμ = 0: the impulses of the rows are −μ
        Some(-nu.zip(&corner.multipliers).map(|(nu, mu)| nu * mu).sum::<f64>())
    }

    /// The row whose prescribed rate jumps most at a switch between two sides of an event, if one does: that of a driver whose law has a kink.
    pub(crate) fn kinked(&mut self, [before, after]: [&State; 2]) -> Option<usize> {
        if self.dynamics.mechanism.drives.is_empty() || before.modes == after.modes {
            return None;
        }
        let [mut near, mut far] = [(); 2].map(|()| Terms::new(self.dims, &self.pattern));
        self.terms(At { modes: &before.modes, ..after.at() }, Stage::Velocity, &mut near);
        self.terms(after.at(), Stage::Velocity, &mut far);
        let jump = |i: usize| (far.nu[i] - near.nu[i]).abs();
        let row = (0..far.nu.len()).max_by(|i, k| jump(*i).total_cmp(&jump(*k)))?;
        let size = if self.dynamics.mechanism.rows.get(row).is_none_or(|row| row.angular) { 1.0 } else { self.size };
        (jump(row) > (SMOOTH * near.nu[row].abs().max(far.nu[row].abs())).max(SLOW * size)).then_some(row)
    }

    /// The row with a corner that was passed since this was asked last, if one was, and the work of rows that move with time there, J.
    pub(crate) fn take_corner(&mut self) -> Option<(usize, f64)> {
        self.corners.passed.take()
    }

    /// The row with the step that the last crossing has met, if it has met one, and its height in SI units.
    pub(crate) fn step(&self) -> Option<(usize, f64)> {
        self.corners.step
    }
}

impl<'a> Corner<'a> {
    fn new(sides: [&'a Terms; 2]) -> Self {
        let [near, _] = sides;
        let rows = near.nu.len();
        Self { sides, g: near.g.values().to_vec(), rhs: vec![0.0; rows], zeros: vec![0.0; near.force.len()], multipliers: vec![0.0; rows] }
    }

    /// dν − dG v of all rows.
    fn miss(&mut self, v: &[f64]) {
        let [near, far] = self.sides;
        for (i, (near_row, far_row)) in near.g.lines().zip(far.g.lines()).enumerate() {
            self.rhs[i] = (far.nu[i] - near.nu[i]) - (far_row.dot(v) - near_row.dot(v));
        }
    }

    /// The row whose velocity would change most, if one does; `fast` is the rate of a row by the fastest motion.
    fn turns(&mut self, v: &[f64], fast: impl Fn(usize) -> f64) -> Option<usize> {
        self.miss(v);
        let [_, far] = self.sides;
        let size = |i: usize| {
            let mut size = far.nu[i].abs();
            far.g.line(i).with(v, |g, v| size += (g * v).abs());
            size
        };
        let largest = (0..self.rhs.len()).max_by(|i, k| self.rhs[*i].abs().total_cmp(&self.rhs[*k].abs()))?;
        let reach = (0..self.rhs.len()).map(size).fold(fast(largest), f64::max);
        (self.rhs[largest].abs() > SMOOTH * reach).then_some(largest)
    }
}
