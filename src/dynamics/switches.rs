//! Modes of switches taken from values, where no event has decided them.

use super::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Measured, StagedProgram};

impl<G: Space<S = f64>> Dynamics<'_, G> {
    /// Sets the modes of a program's switches from its inputs at the state evaluated last.
    pub fn switch(&mut self, program: &StagedProgram, modes: &mut [i32]) {
        if !program.program.switches().is_empty() {
            self.fill(program);
            program.program.set_modes(&self.work.inputs, &mut self.work.registers, modes);
        }
    }

    /// [`Dynamics::time`] with the modes of driver laws at that time.
    pub fn follow_time(&mut self, t: f64, modes: &mut [i32]) {
        self.t = t;
        self.switch(&self.mechanism.time_program, modes);
        self.time(t, modes);
    }

    /// Takes the signs of quaternions so that w ≥ 0 at the position evaluated last, and evaluates that anew if one changes.
    pub fn take_signs(&mut self, q: &[f64], modes: &mut [i32]) {
        self.quaternions(q);
        let mut changed = false;
        for gauge in &self.mechanism.gauges {
            if let Measured::Quaternion { sign, .. } = gauge.measured {
                let mode = &mut modes[self.mechanism.switches + sign];
                let taken = self.work.quaternions[gauge.b].sign();
                changed |= *mode != taken;
                *mode = taken;
            }
        }
        if changed {
            self.position(q, modes);
        }
    }

    /// Takes the modes of functions of position at the position evaluated last, and evaluates those functions and the rows anew.
    pub fn follow_position(&mut self, modes: &mut [i32]) {
        let program = &self.mechanism.position_program;
        if !program.program.switches().is_empty() {
            self.switch(program, modes);
            self.functions(modes);
            self.rows();
        }
    }
}
