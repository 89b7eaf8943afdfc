//! A state of the motion at any time, evaluated as far as it is asked for.

use super::{Off, PhaseSystem, Trajectory};
use crate::geometry::Space;
use grashof_solvers::Node;

/// Where in a step the constraints are asked for all of it, as part of its length: there what the polynomials of the schemes are off
/// them, and its rate, is near to its largest value in most steps (`solvers/tests/continuous.rs` has the others).
const PROBE: f64 = 0.75;

/// How many times nearer than needed to the constraints a step must be there, so that all of it is near enough.
const MARGIN: f64 = 2.5;

impl<G> Trajectory<'_, G>
where
    G: Space<S = f64>,
{
    /// Evaluates the state at `t` on a piece, with its accelerations, multipliers and reactions; inside of steps it is moved to
    /// the constraints.
    pub(crate) fn go(&mut self, t: f64, piece: usize) -> Result<(), Off> {
        let own = self.take(t, piece)?;
        self.accelerate(t, piece, own)
    }

    /// Evaluates the state that was taken at `t` with its accelerations, where it is or moved to the constraints.
    fn accelerate(&mut self, t: f64, piece: usize, stays: bool) -> Result<(), Off> {
        let PhaseSystem { system, engine, .. } = &mut self.phases[self.pieces[piece].phase];
        // next to a singular position a state may not be moved to the constraints: there it counts as it is
        if stays || engine.settle(system, &mut self.node).is_err() {
            self.dense.evaluate(t, &mut self.node.state);
            engine.accelerate(system, &mut self.node).map_err(|_| Off { at: t, gap: None })?;
        }
        let Node { state, a, lambda, .. } = &self.node;
        system.observe(&state.at(), a, lambda);
        Ok(())
    }

    /// Places the bodies as they are at `t` on a piece, on the constraints to a `part` of the size, and nothing else.
    pub(crate) fn place(&mut self, t: f64, piece: usize, part: f64) -> Result<(), Off> {
        let own = self.take(t, piece)?;
        let PhaseSystem { system, engine, .. } = &mut self.phases[self.pieces[piece].phase];
        if !own && engine.project_coordinates(system, &mut self.node.state, part).is_err() {
            self.dense.evaluate(t, &mut self.node.state);
        }
        system.stand(&self.node.state.at(), false);
        Ok(())
    }

    /// As [`Trajectory::go`], but without accelerations where no column needs them. A state that is on the constraints to a `part` of its
    /// size stays where it is.
    pub(super) fn glance(&mut self, t: f64, piece: usize, part: f64) -> Result<(), Off> {
        let phase = self.pieces.get(piece).map_or(0, |p| p.phase);
        let forces = self.phases[phase].system.observer.needs_forces();
        if forces && part == 0.0 {
            return self.go(t, piece);
        }
        let own = self.take(t, piece)?;
        let near = own || part > 0.0 && self.is_near(t, phase, part);
        if forces {
            return self.accelerate(t, piece, near);
        }
        let PhaseSystem { system, engine, .. } = &mut self.phases[phase];
        if !near && engine.project(system, &mut self.node.state).is_err() {
            self.dense.evaluate(t, &mut self.node.state);
        }
        system.read(&self.node.state.at());
        Ok(())
    }

    /// Whether the state that was taken at `t` is on the constraints to a part of its size: it is where all of its step is.
    fn is_near(&mut self, t: f64, phase: usize, part: f64) -> bool {
        let PhaseSystem { system, engine, .. } = &mut self.phases[phase];
        let step = &mut self.steps[self.near];
        let all = *step.near.get_or_insert_with(|| {
            self.dense.evaluate(step.begin + PROBE * (step.end - step.begin), &mut self.node.state);
            let near = engine.is_near(system, &self.node.state, part / MARGIN);
            self.dense.evaluate(t, &mut self.node.state);
            near
        });
        all || engine.is_near(system, &self.node.state, part)
    }
}
