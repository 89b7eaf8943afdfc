//! One switch or output of a program that depends on few of its inputs, cut out of it: its value, and bounds of it.

use super::program::{Op, Program, step};
use super::switch::Test;
use super::table::Table;
use crate::scalar::{Interval, Scalar};

/// What is cut out of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The switch that is number k of [`Program::switches`]: its distance from the end of its mode.
    Switch(usize),
    /// The output number k.
    Output(usize),
}

/// The instructions of a program on which one number depends.
#[derive(Clone, Debug)]
pub struct Part {
    program: Program,
    /// The test of a switch with its number among the pool's; none for an output, which is the last register.
    test: Option<(Test<u32>, u32)>,
    numbers: Vec<f64>,
    intervals: Vec<Interval>,
    inputs: (Vec<f64>, Vec<Interval>),
}

impl Program {
    /// What is `wanted` of this program, alone, if it depends on one of the inputs `on`, and on no other, in any modes.
    #[must_use]
    pub fn part(&self, wanted: Wanted, on: &[u32]) -> Option<Part> {
        let test = match wanted {
            Wanted::Switch(k) => Some((self.decisions.get(k)?.test, *self.switches.get(k)?)),
            Wanted::Output(_) => None,
        };
        let mut roots = Vec::new();
        match (wanted, test) {
            (Wanted::Output(k), _) => roots.push(*self.outputs.get(k)?),
            (_, Some((test, _))) => {
                test.map(|register| roots.push(register));
            }
            _ => return None,
        }
        let needed = self.needed(&roots);
        let inputs: Vec<u32> = self.ops.iter().zip(&needed).filter(|(_, n)| n.is_some()).filter_map(|(op, _)| op.input()).collect();
        if inputs.is_empty() || inputs.iter().any(|i| !on.contains(i)) {
            return None;
        }
        let mut program = Program { tables: self.tables.clone(), inputs, ..Program::default() };
        let mut renamed = vec![0; self.registers];
        for (op, register) in self.ops.iter().zip(needed) {
            let Some(register) = register else { continue };
            for offset in 0..op.results() {
                renamed[register + offset] = (program.registers + offset) as u32;
            }
            program.ops.push(op.map(|r| renamed[r as usize]));
            program.registers += op.results();
        }
        program.outputs = roots.iter().map(|r| renamed[*r as usize]).collect();
        let test = test.map(|(test, switch)| (test.map(|r| renamed[r as usize]), switch));
        let most = program.inputs.iter().max().map_or(0, |i| *i as usize + 1);
        Some(Part {
            test,
            numbers: vec![0.0; program.registers],
            intervals: vec![Interval::default(); program.registers],
            inputs: (vec![f64::NAN; most], vec![Interval::NONE; most]),
            program,
        })
    }

    /// The first register of each instruction on which the registers `roots` depend.
    fn needed(&self, roots: &[u32]) -> Vec<Option<usize>> {
        let mut firsts = Vec::with_capacity(self.ops.len());
        let mut next = 0;
        for op in &self.ops {
            firsts.push(next);
            next += op.results();
        }
        let mut wanted = vec![false; next];
        roots.iter().for_each(|r| wanted[*r as usize] = true);
        let mut needed = vec![None; self.ops.len()];
        for (i, op) in self.ops.iter().enumerate().rev() {
            if wanted[firsts[i]..firsts[i] + op.results()].contains(&true) {
                needed[i] = Some(firsts[i]);
                op.map(|r| {
                    wanted[r as usize] = true;
                    r
                });
            }
        }
        needed
    }
}

impl Part {
    /// The value where all its inputs are `x`: of a switch its distance from the end of its mode, of an output itself.
    pub fn value(&mut self, x: f64, modes: &[i32]) -> f64 {
        self.inputs.0.fill(x);
        run(&self.program, &self.inputs.0, modes, &mut self.numbers);
        match self.test {
            Some((test, switch)) => test.root(modes[switch as usize], |i| self.numbers[i as usize], &self.program.tables),
            None => self.program.outputs.first().map_or(f64::NAN, |r| self.numbers[*r as usize]),
        }
    }

    /// Bounds of [`Self::value`] for all x of an interval, and the size of what it is the difference of: a value below its rounding is
    /// as good as zero. No interval where it is undefined throughout.
    pub fn bounds(&mut self, x: Interval, modes: &[i32]) -> (Interval, f64) {
        self.inputs.1.fill(x);
        run(&self.program, &self.inputs.1, modes, &mut self.intervals);
        match self.test {
            Some((test, switch)) => test.bounds(modes[switch as usize], |i| self.intervals[i as usize], &self.program.tables),
            None => self.program.outputs.first().map_or((Interval::NONE, 0.0), |r| {
                let value = self.intervals[*r as usize];
                (value, value.magnitude())
            }),
        }
    }
}

fn run<S: Scalar>(program: &Program, inputs: &[S], modes: &[i32], registers: &mut [S]) {
    let tables: &[Table] = &program.tables;
    let mut k = 0;
    for op in &program.ops {
        k = step(*op, k, inputs, modes, tables, registers);
    }
}

impl Op {
    /// Registers that the instruction fills.
    fn results(self) -> usize {
        if matches!(self, Self::SinCos(_)) { 2 } else { 1 }
    }

    /// The input that it reads.
    fn input(self) -> Option<u32> {
        if let Self::Input(i) = self { Some(i) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Id, Pool};
    use super::*;
    use std::sync::Arc;

    /// sin(50 t + x) < t beside cos(3 t), with t the input 0 and x the input 1.
    fn program() -> (Pool, Program) {
        let mut p = Pool::new();
        let (t, x) = (p.input(0), p.input(1));
        let [fifty, three, third] = [50.0, 3.0, 0.3].map(|c| p.constant(c));
        let mixed = {
            let a = p.mul(fifty, t);
            let a = p.add(a, x);
            p.sin(a)
        };
        let alone = {
            let a = p.mul(three, t);
            let a = p.cos(a);
            p.sub(a, third)
        };
        let outputs: Vec<Id> = vec![p.abs(mixed, "mixed"), p.abs(alone, "alone"), alone];
        let program = p.program(&outputs, &[], &Arc::from([]));
        (p, program)
    }

    #[test]
    fn parts_depend_on_their_inputs_alone_and_have_the_values_of_the_whole() {
        let (_, program) = program();
        assert!(program.part(Wanted::Switch(0), &[0]).is_none() && program.part(Wanted::Output(0), &[0]).is_none());
        let mut switch = program.part(Wanted::Switch(1), &[0]).unwrap();
        let mut output = program.part(Wanted::Output(2), &[0]).unwrap();
        let modes = [1, -1];
        let (mut registers, mut roots, mut outputs) = (vec![0.0; program.registers()], vec![0.0; 2], vec![0.0; 3]);
        for k in 0..20 {
            let t = 0.13 * f64::from(k);
            program.roots(&[t, 0.7], &modes, &mut registers, &mut roots);
            program.eval(&[t, 0.7], &modes, &mut registers, &mut outputs);
            assert_eq!(switch.value(t, &modes), roots[1]);
            assert_eq!(output.value(t, &modes), outputs[2]);
            let (bounds, size) = switch.bounds(Interval::between(t, t + 0.01), &modes);
            assert!(bounds.holds(switch.value(t + 0.004, &modes)) && size >= bounds.magnitude());
            assert!(bounds.high - bounds.low < 0.05);
        }
    }
}
