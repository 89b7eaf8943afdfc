//! One switch or output of a program that depends on few of its inputs, cut out of it: its value, and bounds of it.

use super::program::{Op, Program, step};
use super::switch::Test;
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
    /// What is `wanted` of this program, alone, if it depends on one of the inputs `on`, and on no other, in any modes. That it may be
    /// undefined where another input makes an operand of a switch so does not count.
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
        let ops = self.without_guards_by_others(on);
        let needed = self.needed(&ops, &roots);
        let inputs: Vec<u32> = ops.iter().zip(&needed).filter(|(_, n)| n.is_some()).filter_map(|(op, _)| op.input()).collect();
        if inputs.is_empty() || inputs.iter().any(|i| !on.contains(i)) {
            return None;
        }
        // what comes from outside has no bounds
        if ops.iter().zip(&needed).any(|(op, n)| n.is_some() && matches!(op, Op::Call(..))) {
            return None;
        }
        let mut program = Program { tables: self.tables.clone(), inputs, ..Program::default() };
        let mut renamed = vec![0; self.registers];
        for (op, register) in ops.iter().zip(needed) {
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

    /// The pool's numbers of the switches on which some of the outputs depend, also by other switches.
    #[must_use]
    pub fn switches_of(&self, outputs: &[usize]) -> Vec<u32> {
        self.reach(outputs.iter().filter_map(|k| self.outputs.get(*k).copied()).collect()).1
    }

    /// The same with those switches given that do not depend on one of its inputs: [`Self::set_modes`] leaves their modes as they are.
    #[must_use]
    pub fn decided_by(&self, input: u32) -> Self {
        let depends = |k: &usize| {
            let mut wanted = Vec::new();
            self.decisions[*k].test.map(|register| wanted.push(register));
            self.reach(wanted).0.iter().any(|op| op.input() == Some(input))
        };
        let kept: Vec<usize> = (0..self.switches.len()).filter(depends).collect();
        Self {
            switches: kept.iter().map(|k| self.switches[*k]).collect(),
            decisions: kept.iter().map(|k| self.decisions[*k]).collect(),
            ..self.clone()
        }
    }

    /// The instructions that lead to some registers, also by the switches of others, and the pool's numbers of those switches.
    fn reach(&self, mut wanted: Vec<u32>) -> (Vec<Op>, Vec<u32>) {
        let mut found = Vec::new();
        loop {
            let (needed, known) = (self.needed(&self.ops, &wanted), found.len());
            let ops: Vec<Op> = self.ops.iter().zip(needed).filter(|(_, n)| n.is_some()).map(|(op, _)| *op).collect();
            for switch in ops.iter().filter_map(|op| op.switch()) {
                if found.contains(&switch) {
                    continue;
                }
                found.push(switch);
                if let Some(k) = self.switches.iter().position(|known| *known == switch) {
                    self.decisions[k].test.map(|register| wanted.push(register));
                }
            }
            if found.len() == known {
                return (ops, found);
            }
        }
    }

    /// The instructions, those that only ask whether something is defined which depends on other inputs than `on` without it.
    fn without_guards_by_others(&self, on: &[u32]) -> Vec<Op> {
        let mut by_others: Vec<bool> = Vec::with_capacity(self.registers);
        let mut ops = Vec::with_capacity(self.ops.len());
        for &op in &self.ops {
            let op = if op.guards().into_iter().flatten().any(|r| by_others[r as usize]) { op.unguarded() } else { op };
            let mut others = op.input().is_some_and(|i| !on.contains(&i));
            op.map(|r| {
                others |= by_others[r as usize];
                r
            });
            by_others.extend(std::iter::repeat_n(others, op.results()));
            ops.push(op);
        }
        ops
    }

    /// The first register of each instruction on which the registers `roots` depend.
    fn needed(&self, ops: &[Op], roots: &[u32]) -> Vec<Option<usize>> {
        let mut firsts = Vec::with_capacity(ops.len());
        let mut next = 0;
        for op in ops {
            firsts.push(next);
            next += op.results();
        }
        let mut wanted = vec![false; next];
        roots.iter().for_each(|r| wanted[*r as usize] = true);
        let mut needed = vec![None; ops.len()];
        for (i, op) in ops.iter().enumerate().rev() {
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
    let mut k = 0;
    for op in &program.ops {
        k = step(program, *op, k, inputs, modes, registers);
    }
}

impl Op {
    /// Registers that the instruction fills.
    fn results(self) -> usize {
        if matches!(self, Self::SinCos(_)) { 2 } else { 1 }
    }

    /// Operands that only make its result undefined where they are.
    fn guards(self) -> [Option<u32>; 2] {
        match self {
            Self::Compare(_, _, a, b) => [Some(a), Some(b)],
            Self::Sign(a, _) | Self::Where(_, a) => [Some(a), None],
            _ => [None; 2],
        }
    }

    /// The same without them.
    fn unguarded(self) -> Self {
        match self {
            Self::Compare(op, switch, ..) => Self::Holds(op, switch),
            Self::Sign(_, switch) => Self::Mode(switch),
            Self::Where(a, _) => Self::Scale(a, 1.0),
            _ => self,
        }
    }

    /// The switch whose mode it reads.
    fn switch(self) -> Option<u32> {
        match self {
            Self::Compare(_, switch, ..)
            | Self::Signed(_, switch)
            | Self::Sign(_, switch)
            | Self::Floor(_, switch)
            | Self::Select(_, _, switch)
            | Self::Choose(_, _, switch)
            | Self::Holds(_, switch)
            | Self::Mode(switch)
            | Self::Table(_, _, _, switch) => Some(switch),
            _ => None,
        }
    }

    /// The input that it reads.
    fn input(self) -> Option<u32> {
        if let Self::Input(i) = self { Some(i) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Compare, Id, Pool};
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

    /// sin(3 t) where x < 0.5, else cos(3 t): its mode does not change with t.
    #[test]
    fn a_mode_that_others_decide_does_not_keep_a_part_from_being_cut_out() {
        let mut p = Pool::new();
        let (t, x) = (p.input(0), p.input(1));
        let [three, half] = [3.0, 0.5].map(|c| p.constant(c));
        let angle = p.mul(three, t);
        let (sine, cosine) = (p.sin(angle), p.cos(angle));
        let less = p.compare(Compare::Less, x, half, "x < 0.5");
        let output = p.choose(less, sine, cosine);
        let program = p.program(&[output], &[], &Arc::from([]));
        let mut part = program.part(Wanted::Output(0), &[0]).unwrap();
        assert_eq!([1, 0].map(|mode| part.value(0.2, &[mode])), [(3.0_f64 * 0.2).sin(), (3.0_f64 * 0.2).cos()]);
        assert!(part.bounds(Interval::between(0.2, 0.3), &[1]).0.holds(0.75_f64.sin()));
        assert!(program.part(Wanted::Switch(0), &[0]).is_none());
    }

    #[test]
    fn switches_of_an_output_are_those_of_its_conditions_too() {
        let mut p = Pool::new();
        let (x, y) = (p.input(0), p.input(1));
        let (size, other) = (p.abs(x, "x"), p.abs(y, "y"));
        let less = p.compare(Compare::Less, size, other, "less");
        let choice = p.choose(less, x, y);
        let program = p.program(&[choice, other, y], &[], &Arc::from([]));
        let count = |outputs: &[usize]| program.switches_of(outputs).len();
        assert_eq!([count(&[0]), count(&[1]), count(&[2]), count(&[1, 2]), count(&[0, 1])], [3, 1, 0, 1, 3]);
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
