//! Straight-line code: the form in which expressions are evaluated, on any scalar.

use super::external::{By, ExternalFunction};
use super::switch::{Compare, Test, whole};
use super::table::LookupTable;
use crate::scalar::Scalar;
use std::sync::Arc;

/// One instruction; operands are registers. Its result goes to the next free register (`SinCos`: two).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    Const(f64),
    Input(u32),
    Neg(u32),
    Add(u32, u32),
    /// a + c
    Shift(u32, f64),
    Sub(u32, u32),
    Mul(u32, u32),
    /// c a
    Scale(u32, f64),
    Div(u32, u32),
    Powi(u32, i32),
    Powf(u32, f64),
    Pow(u32, u32),
    SinCos(u32),
    Tan(u32),
    Asin(u32),
    Acos(u32),
    Atan(u32),
    Atan2(u32, u32),
    Sqrt(u32),
    Exp(u32),
    Ln(u32),
    Log10(u32),
    Sinh(u32),
    Cosh(u32),
    Tanh(u32),
    /// Comparison, switch, both sides.
    Compare(Compare, u32, u32, u32),
    And(u32, u32),
    Or(u32, u32),
    Not(u32),
    /// Condition, value if 1, value if 0.
    If(u32, u32, u32),
    /// Operand times the mode of a switch.
    Signed(u32, u32),
    /// Magnitude of the operand.
    Magnitude(u32),
    /// Operand, the mode of its switch.
    Sign(u32, u32),
    /// Operand, switch: the mode as a number.
    Floor(u32, u32),
    /// Value in modes but 0, value in mode 0, switch; both are defined.
    Select(u32, u32, u32),
    /// The same, whether or not the other one is defined.
    Choose(u32, u32, u32),
    /// The first where the second is defined.
    Where(u32, u32),
    /// Whether a comparison holds in the mode of a switch.
    Holds(Compare, u32),
    /// The mode of a switch.
    Mode(u32),
    /// Table, order, argument, switch.
    Table(u16, u8, u32, u32),
    /// An argument of a call, where the one before it is defined.
    Argument(u32, u32),
    /// External function, its derivative, the last of its arguments, which stand one behind the other.
    Call(u16, By, u32),
}

impl Op {
    /// The same instruction on other registers.
    pub(super) fn map(self, mut f: impl FnMut(u32) -> u32) -> Self {
        match self {
            Self::Const(_) | Self::Input(_) | Self::Holds(..) | Self::Mode(_) => self,
            Self::Neg(a) => Self::Neg(f(a)),
            Self::Add(a, b) => Self::Add(f(a), f(b)),
            Self::Shift(a, c) => Self::Shift(f(a), c),
            Self::Sub(a, b) => Self::Sub(f(a), f(b)),
            Self::Mul(a, b) => Self::Mul(f(a), f(b)),
            Self::Scale(a, c) => Self::Scale(f(a), c),
            Self::Div(a, b) => Self::Div(f(a), f(b)),
            Self::Powi(a, n) => Self::Powi(f(a), n),
            Self::Powf(a, n) => Self::Powf(f(a), n),
            Self::Pow(a, b) => Self::Pow(f(a), f(b)),
            Self::SinCos(a) => Self::SinCos(f(a)),
            Self::Tan(a) => Self::Tan(f(a)),
            Self::Asin(a) => Self::Asin(f(a)),
            Self::Acos(a) => Self::Acos(f(a)),
            Self::Atan(a) => Self::Atan(f(a)),
            Self::Atan2(a, b) => Self::Atan2(f(a), f(b)),
            Self::Sqrt(a) => Self::Sqrt(f(a)),
            Self::Exp(a) => Self::Exp(f(a)),
            Self::Ln(a) => Self::Ln(f(a)),
            Self::Log10(a) => Self::Log10(f(a)),
            Self::Sinh(a) => Self::Sinh(f(a)),
            Self::Cosh(a) => Self::Cosh(f(a)),
            Self::Tanh(a) => Self::Tanh(f(a)),
            Self::Compare(op, switch, a, b) => Self::Compare(op, switch, f(a), f(b)),
            Self::And(a, b) => Self::And(f(a), f(b)),
            Self::Or(a, b) => Self::Or(f(a), f(b)),
            Self::Not(a) => Self::Not(f(a)),
            Self::If(c, a, b) => Self::If(f(c), f(a), f(b)),
            Self::Signed(a, switch) => Self::Signed(f(a), switch),
            Self::Magnitude(a) => Self::Magnitude(f(a)),
            Self::Sign(a, switch) => Self::Sign(f(a), switch),
            Self::Floor(a, switch) => Self::Floor(f(a), switch),
            Self::Select(a, b, switch) => Self::Select(f(a), f(b), switch),
            Self::Choose(a, b, switch) => Self::Choose(f(a), f(b), switch),
            Self::Where(a, b) => Self::Where(f(a), f(b)),
            Self::Table(table, order, x, switch) => Self::Table(table, order, f(x), switch),
            Self::Argument(a, before) => Self::Argument(f(a), f(before)),
            Self::Call(function, by, last) => Self::Call(function, by, f(last)),
        }
    }
}

/// A switch of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Decision {
    /// The mode must be known before this instruction.
    pub(super) before: u32,
    /// Operands are registers.
    pub(super) test: Test<u32>,
}

/// Expressions compiled for evaluation: [`super::Pool::program`] makes them.
///
/// `modes` are indexed by the pool's switch numbers, `inputs` by its input numbers. `registers` is scratch space of
/// [`Self::registers`] numbers. Nothing is allocated.
#[derive(Clone, Debug, Default)]
pub struct Program {
    pub(super) ops: Vec<Op>,
    pub(super) registers: usize,
    pub(super) outputs: Vec<u32>,
    pub(super) inputs: Vec<u32>,
    /// Pool's numbers of the switches, in the order of `decisions`.
    pub(super) switches: Vec<u32>,
    pub(super) decisions: Vec<Decision>,
    pub(super) tables: Arc<[LookupTable]>,
    pub(super) externals: Arc<[ExternalFunction]>,
}

/// Runs one instruction of a program whose result belongs into register `k`; returns the next free register.
#[inline(always)]
pub(super) fn step<S: Scalar>(program: &Program, op: Op, k: usize, inputs: &[S], modes: &[i32], r: &mut [S]) -> usize {
    let at = |i: u32| r[i as usize];
    // conditions are constants that modes decided, so reading their value is no branch on a scalar
    let truth = |i: u32| r[i as usize].value() != 0.0;
    let boolean = |b: bool| S::constant(f64::from(u8::from(b)));
    let mode = |switch: u32| modes[switch as usize];
    let result = match op {
        Op::Const(c) => S::constant(c),
        Op::Input(i) => inputs[i as usize],
        Op::Neg(a) => -at(a),
        Op::Add(a, b) => at(a) + at(b),
        Op::Shift(a, c) => at(a) + S::constant(c),
        Op::Sub(a, b) => at(a) - at(b),
        Op::Mul(a, b) => at(a) * at(b),
        Op::Scale(a, c) => at(a).scale(c),
        // what is infinite is undefined, also where a function of it would be finite
        Op::Div(a, b) => (at(a) / at(b)).where_finite(at(b)),
        Op::Powi(a, n) if n > 0 => at(a).powi(n),
        Op::Powi(a, n) => at(a).powi(n).where_finite(at(a)),
        Op::Powf(a, n) => at(a).powf(n).where_finite(at(a)),
        Op::Pow(a, b) => at(a).pow(at(b)).where_finite(at(a)).where_finite(at(b)),
        Op::SinCos(a) => {
            let (sin, cos) = at(a).sin_cos();
            r[k] = sin;
            r[k + 1] = cos;
            return k + 2;
        }
        Op::Tan(a) => at(a).tan(),
        Op::Asin(a) => at(a).asin(),
        Op::Acos(a) => at(a).acos(),
        Op::Atan(a) => at(a).atan().where_finite(at(a)),
        Op::Atan2(a, b) => (at(a) + S::constant(0.0)).atan2(at(b) + S::constant(0.0)).where_finite(at(a)).where_finite(at(b)),
        Op::Sqrt(a) => at(a).sqrt(),
        Op::Exp(a) => at(a).exp().where_finite(at(a)),
        Op::Ln(a) => at(a).ln(),
        Op::Log10(a) => at(a).log10(),
        Op::Sinh(a) => at(a).sinh(),
        Op::Cosh(a) => at(a).cosh(),
        Op::Tanh(a) => at(a).tanh().where_finite(at(a)),
        Op::Compare(op, switch, a, b) => boolean(op.holds(mode(switch))).where_finite(at(a)).where_finite(at(b)),
        Op::And(a, b) => boolean(truth(a) && truth(b)).where_finite(at(a)).where_finite(at(b)),
        Op::Or(a, b) => boolean(truth(a) || truth(b)).where_finite(at(a)).where_finite(at(b)),
        Op::Not(a) => boolean(!truth(a)).where_finite(at(a)),
        Op::If(c, a, b) => at(if truth(c) { a } else { b }).where_finite(at(c)),
        Op::Signed(a, switch) => at(a).scale(f64::from(mode(switch))),
        // of what is observed alone
        Op::Magnitude(a) => at(a).scale(if at(a).value() < 0.0 { -1.0 } else { 1.0 }),
        Op::Sign(a, switch) => S::constant(f64::from(mode(switch))).where_finite(at(a)),
        Op::Floor(a, switch) => S::constant(whole(mode(switch))).where_finite(at(a)),
        Op::Select(a, b, switch) => at(if mode(switch) != 0 { a } else { b }).where_finite(at(a)).where_finite(at(b)),
        Op::Choose(a, b, switch) => at(if mode(switch) != 0 { a } else { b }),
        Op::Where(a, b) => at(a).where_finite(at(b)),
        Op::Holds(op, switch) => boolean(op.holds(mode(switch))),
        Op::Mode(switch) => S::constant(f64::from(mode(switch))),
        Op::Table(table, order, x, switch) => match program.tables.get(usize::from(table)) {
            Some(table) => table.eval(at(x), mode(switch), order),
            None => S::constant(f64::NAN),
        },
        Op::Argument(a, before) => at(a).where_finite(at(before)),
        Op::Call(function, by, last) => match program.externals.get(usize::from(function)) {
            Some(function) => function.call(&r[last as usize + 1 - function.names().count()..=last as usize], by),
            None => S::constant(f64::NAN),
        },
    };
    r[k] = result;
    k + 1
}

impl Program {
    /// The same for what is observed: |x| is the magnitude of x, also where a place lies beyond the switch of x by rounding. By the mode
    /// it would be below 0 there, and what is divided by it have the wrong sign. It may not be searched for roots, which wants the
    /// formula of one side.
    #[must_use]
    pub fn observed(&self) -> Self {
        let own = |a: u32, switch: u32| {
            let k = self.switches.iter().position(|known| *known == switch);
            k.is_some_and(|k| self.decisions[k].test == Test::Sign(a))
        };
        let observed = |op: &Op| match *op {
            // the rate of |x| has the switch of x
            Op::Signed(a, switch) if own(a, switch) => Op::Magnitude(a),
            op => op,
        };
        Self { ops: self.ops.iter().map(observed).collect(), ..self.clone() }
    }

    /// Number of scratch registers that evaluation needs.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// Number of outputs.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// The inputs that are really used, ascending; the others may hold anything.
    #[must_use]
    pub fn inputs(&self) -> &[u32] {
        &self.inputs
    }

    /// The pool's numbers of the switches in the program, in the order in which they are decided.
    #[must_use]
    pub fn switches(&self) -> &[u32] {
        &self.switches
    }

    /// The outputs at `inputs` in the branch that `modes` select. One that this branch does not define, beyond the switch where it ends,
    /// is that of the branch which the values themselves ask for: √max(0, x) is 0 behind x = 0, whatever the mode; false if there is one.
    pub fn eval<S: Scalar>(&self, inputs: &[S], modes: &[i32], registers: &mut [S], outputs: &mut [S]) -> bool {
        self.run(inputs, modes, registers);
        let mut defined = true;
        for (output, register) in outputs.iter_mut().zip(&self.outputs) {
            *output = registers[*register as usize];
            defined &= output.value().is_finite();
        }
        if !defined && !self.decisions.is_empty() {
            self.define(inputs, modes, registers, outputs);
        }
        defined
    }

    /// The outputs that are not defined, in the modes that the values ask for.
    #[cold]
    fn define<S: Scalar>(&self, inputs: &[S], modes: &[i32], registers: &mut [S], outputs: &mut [S]) {
        let mut own = modes.to_vec();
        let mut k = self.decide(inputs, registers, &mut own);
        for op in &self.ops[self.decisions.last().map_or(0, |last| last.before as usize)..] {
            k = step(self, *op, k, inputs, &own, registers);
        }
        for (output, register) in outputs.iter_mut().zip(&self.outputs).filter(|(output, _)| !output.value().is_finite()) {
            *output = registers[*register as usize];
        }
    }

    fn run<S: Scalar>(&self, inputs: &[S], modes: &[i32], registers: &mut [S]) {
        let registers = &mut registers[..self.registers];
        let mut k = 0;
        for op in &self.ops {
            k = step(self, *op, k, inputs, modes, registers);
        }
    }

    /// Sets the mode of every switch in the program from the values, evaluating as it goes. A value that lies exactly on a
    /// comparison takes the literal truth.
    pub fn set_modes(&self, inputs: &[f64], registers: &mut [f64], modes: &mut [i32]) {
        if !self.decisions.is_empty() {
            self.decide(inputs, registers, modes);
        }
    }

    /// Runs as far as the last switch is decided; the next free register.
    fn decide<S: Scalar>(&self, inputs: &[S], registers: &mut [S], modes: &mut [i32]) -> usize {
        let registers = &mut registers[..self.registers];
        let (mut k, mut done) = (0, 0);
        for (decision, switch) in self.decisions.iter().zip(&self.switches) {
            while done < decision.before as usize {
                k = step(self, self.ops[done], k, inputs, modes, registers);
                done += 1;
            }
            modes[*switch as usize] = decision.test.mode(|i| registers[i as usize].value(), &self.tables);
        }
        k
    }

    /// Distance of each switch of [`Self::switches`] from the end of its present mode: positive inside, 0 on the switch,
    /// negative outside. ±(a − b) for comparisons, min and max; ±x for abs and sign; to the nearest end of a table's segment.
    pub fn roots(&self, inputs: &[f64], modes: &[i32], registers: &mut [f64], roots: &mut [f64]) {
        if self.decisions.is_empty() {
            return;
        }
        self.run(inputs, modes, registers);
        for ((root, decision), switch) in roots.iter_mut().zip(&self.decisions).zip(&self.switches) {
            *root = decision.test.root(modes[*switch as usize], |i| registers[i as usize], &self.tables);
        }
    }

    /// What the switch number `k` of [`Self::switches`] compares with constants: the difference of two operands, or the only one. Where its
    /// mode ends that has a fixed value, whatever the other inputs.
    #[must_use]
    pub fn operand<S: Scalar>(&self, k: usize, inputs: &[S], modes: &[i32], registers: &mut [S]) -> S {
        self.run(inputs, modes, registers);
        let at = |i: u32| registers[i as usize];
        match self.decisions[k].test {
            Test::Compare(_, a, b) | Test::Order(a, b) => at(a) - at(b),
            Test::Sign(a) | Test::Whole(a) | Test::Segment { x: a, .. } => at(a),
        }
    }

    /// Distances from the lower and the upper end of the present segment for switch number `k` of [`Self::switches`], if it is that of
    /// a table; smooth where the nearer of them, which [`Self::roots`] gives, has a kink.
    ///
    /// `registers` are those that [`Self::roots`] left.
    #[must_use]
    pub fn segment_ends(&self, k: usize, modes: &[i32], registers: &[f64]) -> Option<[f64; 2]> {
        self.decisions[k].test.ends(modes[self.switches[k] as usize], |i| registers[i as usize], &self.tables)
    }

    /// The mode behind the switch that is number `k` of [`Self::switches`], across the end of its present mode that is nearest.
    ///
    /// `registers` are those that [`Self::roots`] left at the crossing.
    #[must_use]
    pub fn neighbour(&self, k: usize, modes: &[i32], registers: &[f64]) -> i32 {
        self.decisions[k].test.neighbour(modes[self.switches[k] as usize], |i| registers[i as usize], &self.tables)
    }

    /// The mode of equal operands for switch number `k` of [`Self::switches`], if what it decides jumps there: a comparison, a sign, a whole
    /// number. `registers` are those that [`Self::roots`] left.
    #[must_use]
    pub fn of_equals(&self, k: usize, registers: &[f64]) -> Option<i32> {
        let test = self.decisions[k].test;
        let jumps = matches!(test, Test::Compare(..) | Test::Sign(_) | Test::Whole(_));
        jumps.then(|| test.mode(|i| registers[i as usize], &self.tables))
    }
}

#[cfg(test)]
#[path = "program_tests.rs"]
mod tests;
