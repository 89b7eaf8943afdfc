//! What every scheme needs of a system: accelerations by one KKT solve, projection on the constraints, error norms, counters.
//!
//! ```text
//! [ M   Gᵀ ] [ a ]   [ f ]        [ M   Gᵀ ] [ δq ]   [  0 ]        [ M   Gᵀ ] [ δv ]   [    0    ]
//! [ G  −E  ] [ λ ] = [ γ ],       [ G  −E  ] [ μ  ] = [ −Φ ],       [ G  −E  ] [ μ  ] = [ ν − G v ]
//! ```
//!
//! The same matrix serves three times: the shortest way back to the constraints is meant in the metric M.

use crate::friction::Friction;
use crate::kkt::{Kkt, ROUND_OFF};
pub(crate) use crate::why::LONGEST_RETRY;
pub use crate::why::{Rejected, Why};
use crate::{At, Common, Dims, Line, Span, Stage, State, System, Terms};

pub mod blows;
mod norm;
mod projection;
#[cfg(test)]
pub(crate) mod shape;

/// A state with what follows from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The state.
    pub state: State,
    /// Accelerations (nv), of the KKT system at this state.
    pub a: Vec<f64>,
    /// Multipliers (m), of the same.
    pub lambda: Vec<f64>,
    /// ż (nz).
    pub zdot: Vec<f64>,
}

impl Node {
    /// A node of zeros.
    pub fn new(dims: Dims) -> Self {
        Self { state: State::new(dims), a: vec![0.0; dims.v], lambda: vec![0.0; dims.rows()], zdot: vec![0.0; dims.z] }
    }

    /// Copies another node of the same sizes without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.state.copy_from(&other.state);
        self.a.copy_from_slice(&other.a);
        self.lambda.copy_from_slice(&other.lambda);
        self.zdot.copy_from_slice(&other.zdot);
    }
}

/// What was spent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: usize,
    /// Rejected trials: error too large, Newton without success.
    pub rejected: usize,
    /// Evaluations of terms or residuals.
    pub evaluations: usize,
    /// Evaluations of tangents.
    pub tangents: usize,
    /// Factorisations of a KKT or Newton matrix.
    pub factorisations: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Events at which a scheme was restarted or that were recorded.
    pub events: usize,
    /// Singular positions that were bridged by explicit steps.
    pub bridges: usize,
    /// Switches that a scheme marched across.
    pub stepped_over: usize,
    /// Root functions that could not be resolved in a part of a step: their signs at its nodes were taken.
    pub unresolved: usize,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected += other.rejected;
        self.evaluations += other.evaluations;
        self.tangents += other.tangents;
        self.factorisations += other.factorisations;
        self.iterations += other.iterations;
        self.events += other.events;
        self.bridges += other.bridges;
        self.stepped_over += other.stepped_over;
        self.unresolved += other.unresolved;
    }
}

/// How the size of a step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// By the local error: tolerance in units of [`Pattern::size_q`](crate::Pattern::size_q).
    Tolerance(f64),
    /// Given steps, s, used in turn: a constant step twice, or two that alternate.
    Steps([f64; 2]),
}

/// Tools of a scheme over one system; sized once, then free of allocation.
#[derive(Clone, Debug)]
pub struct Engine {
    /// Sizes of the system.
    pub dims: Dims,
    /// Terms of the last evaluation.
    pub terms: Terms,
    /// Solver of the KKT matrix factored last.
    pub kkt: Kkt,
    /// Accelerations where forces depend on reactions.
    pub friction: Option<Friction>,
    /// What was spent so far.
    pub counts: Counts,
    /// How steps are chosen.
    pub control: Control,
    /// Sizes of coordinates, from the pattern: errors of q count absolutely.
    pub size_q: Vec<f64>,
    /// Sizes of velocities: errors of v count relative to size + |v|, |v| without what bodies share in a common translation.
    pub size_v: Vec<f64>,
    /// Sizes of states: errors of z count relative to size + |z|.
    pub size_z: Vec<f64>,
    /// Common translations, from the pattern, and which velocities share in one (nv).
    common: Vec<Common>,
    shares: Vec<bool>,
    /// 1/√(G D⁻¹ Gᵀ) of each row (m): Φ times this is a mass-weighted way.
    pub row_unit: Vec<f64>,
    /// Redundant rows, whose σ are zero all along: singular is where one more becomes so.
    pub redundant: usize,
    /// How much Φ changes when the coordinates move by their size, by the scale of each row (m); round-off is 1e-11 of it.
    row_reach: Vec<f64>,
    delta: Vec<f64>,
    mu: Vec<f64>,
    zeros: Vec<f64>,
    rhs: Vec<f64>,
    modes: Vec<i32>,
}

impl Engine {
    /// Tools for a system.
    pub fn new(system: &dyn System, control: Control) -> Self {
        let dims = system.dims();
        let pattern = system.pattern();
        // entries of one size in units of `size_v`: g_scale = Σ (reach/size)²/D
        let inverse: f64 = pattern.metric.iter().zip(&pattern.size_v).map(|(d, s)| (d * s * s).recip()).sum();
        Self {
            dims,
            terms: Terms::new(dims, pattern),
            kkt: Kkt::of_pattern(pattern),
            friction: Friction::of_pattern(dims, pattern),
            counts: Counts::default(),
            control,
            size_q: pattern.size_q.clone(),
            size_v: pattern.size_v.clone(),
            size_z: pattern.size_z.clone(),
            shares: (0..dims.v).map(|k| pattern.common.iter().flatten().any(|(shared, _)| *shared == k)).collect(),
            common: pattern.common.clone(),
            row_unit: pattern.g_scale.iter().map(|g| g.sqrt().recip()).collect(),
            redundant: 0,
            row_reach: pattern.g_scale.iter().map(|g| (g / inverse).sqrt()).collect(),
            delta: vec![0.0; dims.v],
            mu: vec![0.0; dims.rows()],
            zeros: vec![0.0; dims.v],
            rhs: vec![0.0; dims.rows()],
            modes: vec![0; dims.modes],
        }
    }

    /// The tolerance of errors; of a given step, 1e-12: what Newton's method aims at.
    pub fn tolerance(&self) -> f64 {
        match self.control {
            Control::Tolerance(tolerance) => tolerance,
            Control::Steps(_) => 1e-12,
        }
    }

    /// Whether steps are given.
    pub fn is_fixed(&self) -> bool {
        matches!(self.control, Control::Steps(_))
    }

    /// Accelerations, multipliers and ż at a state (index 1).
    ///
    /// # Errors
    /// If the KKT matrix is singular, a force is not finite, or friction by reactions has no solution.
    pub fn accelerations(
        &mut self,
        system: &mut dyn System,
        at: At<'_>,
        a: &mut [f64],
        lambda: &mut [f64],
        zdot: &mut [f64],
    ) -> Result<(), Why> {
        self.evaluate(system, at, Stage::Dynamics);
        self.factor()?;
        self.solve(system, at, a, lambda, zdot)
    }

    /// a, λ and ż by the terms and factors at hand, which are those of `at`.
    fn solve(&mut self, system: &mut dyn System, at: At<'_>, a: &mut [f64], lambda: &mut [f64], zdot: &mut [f64]) -> Result<(), Why> {
        zdot.copy_from_slice(&self.terms.zdot);
        if let Some(friction) = &mut self.friction {
            // the same from any guess: an evaluation knows nothing of those before it
            a.fill(0.0);
            lambda.fill(0.0);
            self.counts.factorisations += 1;
            friction.solve(&self.terms, &mut |l, f, slope| system.reaction_friction(at, l, f, slope), a, lambda)?;
        } else {
            self.kkt.solve(&self.terms.force, &self.terms.gamma, a, lambda);
        }
        match a.iter().chain(&*zdot).position(|x| !x.is_finite()) {
            Some(i) => Err(self.not_finite(i)),
            None => Ok(()),
        }
    }

    /// [`Engine::accelerations`] at the state of a node.
    ///
    /// # Errors
    /// As there.
    pub fn accelerate(&mut self, system: &mut dyn System, node: &mut Node) -> Result<(), Why> {
        let Node { state, a, lambda, zdot } = node;
        self.accelerations(system, state.at(), a, lambda, zdot)
    }

    /// Takes the modes of a state from its values; true if one has changed.
    pub fn follow_modes(&mut self, system: &mut dyn System, state: &mut State) -> bool {
        self.modes.copy_from_slice(&state.modes);
        let at = At { t: state.t, q: &state.q, v: &state.v, z: &state.z, modes: &self.modes, live: &state.live };
        system.modes(at, &mut state.modes);
        self.modes != state.modes
    }

    /// Evaluates terms, and counts.
    pub fn evaluate(&mut self, system: &mut dyn System, at: At<'_>, stage: Stage) {
        self.counts.evaluations += 1;
        system.terms(at, stage, &mut self.terms);
    }

    /// Factors the KKT matrix of the terms evaluated last.
    ///
    /// # Errors
    /// If it is singular or not finite.
    pub fn factor(&mut self) -> Result<(), Why> {
        self.counts.factorisations += 1;
        let Terms { mass, g, .. } = &self.terms;
        self.kkt.factor(mass.values(), g.values()).map_err(|_| {
            match mass.lines().position(|row| row.values.iter().any(|x| !x.is_finite())) {
                Some(i) => Why::NotFinite(i),
                None => Why::Singular,
            }
        })
    }

    fn not_finite(&self, i: usize) -> Why {
        // a force that is not finite spoils every acceleration: name its own equation
        Why::NotFinite(self.terms.force.iter().position(|x| !x.is_finite()).unwrap_or(i))
    }

    /// Largest |Φ| as a way: each row by its unit and the size of its coordinates; of the terms evaluated last.
    pub fn position_residual(&self) -> f64 {
        self.rows_residual(self.terms.phi.iter().copied())
    }

    /// Largest |G v − ν| as a velocity, by the same units, of the terms evaluated last.
    pub fn velocity_residual(&self, v: &[f64]) -> f64 {
        self.rows_residual(self.terms.g.lines().zip(&self.terms.nu).map(|(row, nu)| row.dot(v) - nu))
    }

    fn rows_residual(&self, residuals: impl Iterator<Item = f64>) -> f64 {
        let mut largest = 0.0;
        for (r, (row, whole)) in residuals.zip(self.terms.g.lines().zip(&self.row_reach)) {
            let reach = reach(row, &self.size_v);
            let size = r.abs() / if reach > ROUND_OFF * whole { reach } else { *whole };
            largest = f64::max(largest, size);
        }
        largest
    }

    /// Time derivative ȧ of the accelerations along the motion at a node, by a central difference over ±`reach` s.
    ///
    /// # Errors
    /// As [`Engine::accelerations`].
    pub fn jerk(&mut self, system: &mut dyn System, node: &Node, reach: f64, scratch: &mut Node, out: &mut [f64]) -> Result<(), Why> {
        out.fill(0.0);
        for sign in [-1.0, 1.0] {
            let h = sign * reach;
            scratch.copy_from(node);
            scratch.state.t += h;
            for (i, d) in self.delta.iter_mut().enumerate() {
                *d = h * node.state.v[i] + 0.5 * h * h * node.a[i];
            }
            system.retract(Span { end: scratch.state.t, length: h }, &mut scratch.state.q, &self.delta);
            scratch.state.v.iter_mut().zip(&node.a).for_each(|(v, a)| *v += h * a);
            scratch.state.z.iter_mut().zip(&node.zdot).for_each(|(z, r)| *z += h * r);
            self.accelerate(system, scratch)?;
            out.iter_mut().zip(&scratch.a).for_each(|(j, a)| *j += a / (2.0 * h));
        }
        Ok(())
    }
}

/// |G_i| in units of size: how much Φ changes when the coordinates move by their size.
fn reach(row: Line<'_>, size: &[f64]) -> f64 {
    let mut largest = 0.0;
    row.with(size, |g, s| largest = f64::max(largest, (g * s).abs()));
    largest
}

/// Index and size of the entry that is largest in size.
fn largest(x: &[f64]) -> (usize, f64) {
    x.iter().enumerate().fold((0, 0.0), |best, (i, x)| if x.abs() > best.1 { (i, x.abs()) } else { best })
}
