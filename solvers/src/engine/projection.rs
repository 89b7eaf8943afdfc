//! The shortest ways back to the constraints, by the matrix of the accelerations.

use super::{Engine, Node, Why, largest, reach};
use crate::kkt::ROUND_OFF;
use crate::{Span, Stage, State, System};

/// Steps of Newton's method in a projection.
const PROJECTIONS: usize = 12;

/// Corrections in a row, and the way that is left to round-off.
const REPEATED: usize = 10;
const CLOSED: f64 = 4e-15;

/// A correction below this (in units of size) leaves a residual of its square.
const SQUARE_ENOUGH: f64 = 1e-7;

impl Engine {
    /// Moves a state to the constraints, first q, then v, by the shortest way in the metric M, and evaluates a, λ, ż there.
    ///
    /// # Errors
    /// If the constraints cannot be closed from here, and as [`Engine::accelerations`].
    pub fn settle(&mut self, system: &mut dyn System, node: &mut Node) -> Result<(), Why> {
        self.settle_within(system, node, 0.0)
    }

    /// [`Engine::settle`] behind a step with error control: forces and γ are not evaluated anew after a correction δv of the
    /// velocities below a hundredth of the tolerance. Accelerations then differ by ∂a/∂v δv, so that what the next step makes of
    /// them, h ∂a/∂v δv, is less than the correction itself.
    ///
    /// # Errors
    /// As there.
    pub fn settle_step(&mut self, system: &mut dyn System, node: &mut Node) -> Result<(), Why> {
        let slack = if self.is_fixed() { 0.0 } else { 0.01 * self.tolerance() };
        self.settle_within(system, node, slack)
    }

    fn settle_within(&mut self, system: &mut dyn System, node: &mut Node, slack: f64) -> Result<(), Why> {
        self.project_within(system, &mut node.state, slack)?;
        let Node { state, a, lambda, zdot } = node;
        // the factors are those of this position, and the terms those of this position and velocity
        self.solve(system, state.at(), a, lambda, zdot)
    }

    /// Moves a state to the constraints, without its accelerations.
    ///
    /// # Errors
    /// If the constraints cannot be closed from here, or the KKT matrix is singular.
    pub fn project(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Why> {
        if self.dims.rows() > 0 { self.project_on(system, state, Stage::Velocity).map(drop) } else { Ok(()) }
    }

    /// Moves the coordinates of a state to the constraints, unless they are on them to a part of their size; velocities stay.
    ///
    /// # Errors
    /// As [`Engine::project`].
    pub fn project_coordinates(&mut self, system: &mut dyn System, state: &mut State, part: f64) -> Result<(), Why> {
        if self.dims.holonomic == 0 {
            return Ok(());
        }
        self.evaluate(system, state.at(), Stage::Position);
        if self.position_residual() <= part { Ok(()) } else { self.close(system, state) }
    }

    /// Whether a state is on the constraints to a part of its size; evaluates it.
    pub fn is_near(&mut self, system: &mut dyn System, state: &State, part: f64) -> bool {
        if self.dims.rows() == 0 {
            return true;
        }
        self.evaluate(system, state.at(), Stage::Velocity);
        let speed = state.v.iter().zip(&self.size_v).fold(1.0, |m, (v, s)| f64::max(m, v.abs() / s));
        self.position_residual() <= part && self.velocity_residual(&state.v) <= part * speed
    }

    /// Moves a state to the constraints; leaves terms and factors of the state reached.
    fn project_within(&mut self, system: &mut dyn System, state: &mut State, slack: f64) -> Result<(), Why> {
        // a correction of v is to be expected unless it may be neglected
        let exact = self.dims.rows() > 0 && slack == 0.0;
        let size = self.project_on(system, state, if exact { Stage::Velocity } else { Stage::Dynamics })?;
        if exact || size.is_nan() || size > slack {
            self.evaluate(system, state.at(), Stage::Dynamics);
        }
        Ok(())
    }

    /// Moves a state to the constraints, evaluating it to a stage before velocities are corrected; the largest correction of them in
    /// units of size.
    fn project_on(&mut self, system: &mut dyn System, state: &mut State, stage: Stage) -> Result<f64, Why> {
        // far from zero, positions cannot be closed any better
        let rounded = self.rounding(&state.q);
        if self.dims.holonomic > 0 {
            self.evaluate(system, state.at(), Stage::Position);
            if self.position_residual() > 1e-15 {
                self.close(system, state)?;
            }
        }
        self.evaluate(system, state.at(), stage);
        // in a singular position E leaves a part of each correction to be done
        for _ in 0..REPEATED {
            if self.dims.holonomic == 0 || self.position_residual() <= CLOSED + rounded {
                break;
            }
            self.close(system, state)?;
            self.evaluate(system, state.at(), stage);
        }
        self.factor()?;
        let mut size = 0.0;
        for _ in 0..REPEATED {
            if self.dims.rows() == 0 || !self.velocity_correction(&state.v) {
                break;
            }
            for ((v, d), s) in state.v.iter_mut().zip(&self.delta).zip(&self.size_v) {
                size = f64::max(size, d.abs() / (s + v.abs()));
                *v += d;
            }
        }
        Ok(size)
    }

    /// Newton's method on Φ = 0 from a state that was evaluated last; the factors stay those of the first position.
    fn close(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Why> {
        let mut last = f64::INFINITY;
        for iteration in 0..PROJECTIONS {
            if iteration > 0 {
                self.evaluate(system, state.at(), Stage::Position);
            }
            self.factor()?;
            self.rhs.fill(0.0);
            for (r, phi) in self.rhs.iter_mut().zip(&self.terms.phi) {
                *r = -phi;
            }
            self.kkt.solve(&self.zeros, &self.rhs, &mut self.delta, &mut self.mu);
            system.retract(Span::at(state.t), &mut state.q, &self.delta);
            let size = self.delta.iter().zip(&self.size_v).fold(0.0, |m, (d, s)| f64::max(m, d.abs() / s));
            if size < SQUARE_ENOUGH {
                return Ok(());
            }
            if size.is_nan() || size >= 2.0 * last {
                break;
            }
            last = size;
        }
        let (row, residual) = largest(&self.terms.phi);
        Err(Why::Constraints { row, residual })
    }

    /// The shortest δv with G (v + δv) = ν, into `delta`; false if v is there already.
    fn velocity_correction(&mut self, v: &[f64]) -> bool {
        let mut needed = false;
        let rows = self.terms.g.lines().zip(&self.row_reach);
        for ((r, nu), (row, whole)) in self.rhs.iter_mut().zip(&self.terms.nu).zip(rows) {
            let (mut sum, mut size) = (0.0, 0.0);
            row.with(v, |g, v| {
                sum += g * v;
                size += (g * v).abs();
            });
            *r = nu - sum;
            needed |= r.abs() > 4.0 * f64::EPSILON * (size + nu.abs()) && reach(row, &self.size_v) > ROUND_OFF * whole;
        }
        if needed {
            self.kkt.solve(&self.zeros, &self.rhs, &mut self.delta, &mut self.mu);
        }
        needed
    }

    /// Removes from a velocity (nv) what lies across the constraints, in the metric M, by the terms and factors at hand.
    pub fn tangential(&mut self, x: &mut [f64]) {
        for (r, row) in self.rhs.iter_mut().zip(self.terms.g.lines()) {
            *r = -row.dot(x);
        }
        self.kkt.solve(&self.zeros, &self.rhs, &mut self.delta, &mut self.mu);
        x.iter_mut().zip(&self.delta).for_each(|(x, d)| *x += d);
    }
}
