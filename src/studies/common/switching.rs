//! How far all expressions of a mechanism and its columns are from their switches.

use super::observe::Observer;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, StagedProgram};

/// The switches that a mechanism's programs and its columns hold, with scratch to evaluate them.
#[derive(Clone, Debug)]
pub struct Switching {
    inputs: Vec<f64>,
    registers: Vec<f64>,
    roots: Vec<f64>,
}

/// One switch as evaluated last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Its number among all switches of the model.
    pub switch: usize,
    /// > 0 inside its present mode.
    pub root: f64,
    /// The mode behind the crossing.
    pub neighbour: i32,
}

impl Switching {
    /// Scratch for a mechanism and its columns.
    #[must_use]
    pub fn new<G: Space<S = f64>>(mechanism: &Mechanism<G>, observer: &Observer<G>) -> Self {
        let programs = mechanism.programs();
        let most = |f: fn(&StagedProgram) -> usize| programs.iter().map(|p| f(p)).max().unwrap_or(0);
        Self {
            inputs: vec![0.0; most(|p| p.inputs)],
            registers: vec![0.0; most(|p| p.program.registers())],
            roots: vec![0.0; most(|p| p.program.switches().len()).max(observer.program().switches().len())],
        }
    }

    /// Every switch with its distance in the present modes at the state evaluated last, each number once but for tables, which have
    /// a distance to either end of their segment; always in the same order.
    pub fn distances<G: Space<S = f64>>(
        &mut self,
        dynamics: &Dynamics<'_, G>,
        observer: &mut Observer<G>,
        modes: &[i32],
        out: &mut Vec<Distance>,
    ) {
        out.clear();
        for program in dynamics.mechanism.programs() {
            if program.program.switches().is_empty() {
                continue;
            }
            self.fill(dynamics, program);
            let switches = program.program.switches();
            program.program.roots(&self.inputs, modes, &mut self.registers, &mut self.roots[..switches.len()]);
            for (k, &switch) in switches.iter().enumerate() {
                let ends = program.program.segment_ends(k, modes, &self.registers);
                let neighbour = program.program.neighbour(k, modes, &self.registers);
                push(out, Distance { switch: switch as usize, root: self.roots[k], neighbour }, modes, ends);
            }
        }
        let count = observer.program().switches().len();
        observer.roots(modes, &mut self.roots[..count]);
        for k in 0..count {
            let switch = observer.program().switches()[k] as usize;
            let distance = Distance { switch, root: self.roots[k], neighbour: observer.neighbour(k, modes) };
            push(out, distance, modes, observer.segment_ends(k, modes));
        }
    }

    fn fill<G: Space<S = f64>>(&mut self, dynamics: &Dynamics<'_, G>, program: &StagedProgram) {
        for &(input, leaf) in &program.fills {
            self.inputs[input] = dynamics.leaf(leaf);
        }
    }
}

fn push(out: &mut Vec<Distance>, distance: Distance, modes: &[i32], ends: Option<[f64; 2]>) {
    if out.iter().any(|d| d.switch == distance.switch) {
        return;
    }
    let Some([low, high]) = ends else { return out.push(distance) };
    let mode = modes[distance.switch];
    out.push(Distance { root: low, neighbour: mode.saturating_sub(1), ..distance });
    out.push(Distance { root: high, neighbour: mode.saturating_add(1), ..distance });
}
