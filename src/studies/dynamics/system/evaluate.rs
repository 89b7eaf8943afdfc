//! A mechanism in a state: what its evaluator is asked for, and nothing that stands in it already.

use super::{Mechanical, Root};
use crate::geometry::Space;
use crate::studies::common::observe::Needs;
use grashof_solvers::At;

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Evaluates positions and velocities of a state.
    pub(crate) fn kinematics(&mut self, at: &At<'_>) {
        self.stand(at, true);
        self.velocities(at);
    }

    /// Evaluates positions of a state, with G if that is asked for; what stands there already is not evaluated again.
    pub(crate) fn stand(&mut self, at: &At<'_>, rows: bool) {
        self.dynamics.work.z.copy_from_slice(at.z);
        if !self.seen.is_placed(at, rows) {
            self.dynamics.work.held.copy_from_slice(at.live);
            self.dynamics.time(at.t, at.modes);
            let q = self.decided.coordinates(at.q);
            self.dynamics.position(q, at.modes);
            self.seen.place(at);
        }
    }

    /// Evaluates velocities of a state whose positions are there.
    pub(super) fn velocities(&mut self, at: &At<'_>) {
        if !self.seen.is_moving(at) {
            let v = self.decided.velocities(&self.dynamics.work, at.v);
            self.dynamics.velocity(v, at.modes);
            self.seen.moves(at);
        }
    }

    /// [`Mechanical::kinematics`] without G.
    pub(super) fn motion(&mut self, at: &At<'_>) {
        self.stand(at, false);
        self.velocities(at);
    }

    /// Evaluates the forces of a state whose positions and velocities are there, for whoever may change them after.
    pub(super) fn loads(&mut self, at: &At<'_>) {
        if !self.seen.takes_loads(at) {
            self.dynamics.loads(at.modes);
        }
    }

    /// Evaluates a state with its accelerations and reads the columns' quantities.
    pub(crate) fn observe(&mut self, at: &At<'_>, a: &[f64], lambda: &[f64]) {
        self.motion(at);
        self.loads(at);
        let own = self.own(at.modes);
        let Self { dynamics, observer, reactions, decided, .. } = self;
        let [q, v, a] = decided.accelerations(&dynamics.work, [at.q, at.v, a]);
        dynamics.react(a, lambda, reactions);
        observer.read(dynamics, [q, v, a], reactions, own);
    }

    /// Columns and event functions at the state observed last.
    pub(crate) fn columns(&mut self, modes: &[i32], out: &mut [f64]) {
        self.observer.columns(modes, out);
    }

    /// Evaluates a state without accelerations and reads the columns' quantities, of which none needs them.
    pub(crate) fn glance(&mut self, at: &At<'_>) {
        self.motion(at);
        if self.observer.needs() == Needs::Inertias {
            self.loads(at);
        }
        self.seen.takes_loads(at);
        let own = self.own(at.modes);
        let Self { dynamics, observer, reactions, decided, a, .. } = self;
        let [q, v] = decided.standing(at.q, at.v);
        observer.read(dynamics, [q, v, a], reactions, own);
    }

    /// [`Mechanical::glance`], which leaves the evaluator where it is if the numbers of the state tell all.
    pub(crate) fn read(&mut self, at: &At<'_>) {
        if !self.reads(at) {
            self.glance(at);
        }
    }

    /// The observer's inputs at a state; accelerations only if they are needed, by an own solution where none are given.
    pub(super) fn look(&mut self, at: &At<'_>, given: Option<(&[f64], &[f64])>) {
        if !self.pattern.roots_by_reactions {
            return self.glance(at);
        }
        if let Some((a, lambda)) = given {
            return self.observe(at, a, lambda);
        }
        self.accelerate(at);
        let (a, lambda) = (std::mem::take(&mut self.a), std::mem::take(&mut self.lambda));
        self.observe(at, &a, &lambda);
        (self.a, self.lambda) = (a, lambda);
    }

    /// Roots that the numbers of a state decide alone.
    pub(super) fn direct_roots(&mut self, at: &At<'_>, g: &mut [f64]) {
        let Self { direct: Some(direct), dynamics, roots, inputs, registers, scratch, .. } = self else { return };
        let mut filled = usize::MAX;
        for (root, g) in roots.iter().zip(g) {
            let Root::Force { program, k } = *root else { continue };
            if filled != program {
                direct[program].iter().for_each(|(input, source)| inputs[*input] = source.of(at));
                let program = &dynamics.mechanism.programs()[program].program;
                program.roots(inputs, at.modes, registers, &mut scratch[..program.switches().len()]);
            }
            filled = program;
            *g = scratch[k];
        }
    }

    /// Reads the columns' quantities from the numbers of a state, if these tell them all; the evaluator stays where it is.
    pub(super) fn reads(&mut self, at: &At<'_>) -> bool {
        let own = self.own(at.modes);
        let Self { watched: Some(watched), observer, .. } = self else { return false };
        observer.take(watched.iter().map(|(input, source)| (*input, source.of(at))), own);
        true
    }
}
