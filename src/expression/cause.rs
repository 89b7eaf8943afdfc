//! Why a value is undefined: the operation that has no value, with its arguments.

use super::pool::{Id, Pool};
use super::program::{Op, Program};
use super::table::LookupTable;
use std::sync::Arc;

/// The operation that makes a value undefined although its own arguments are defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A function of one argument, by its name in the format.
    Function(&'static str, f64),
    /// A division by 0.
    Zero,
    /// A base and an exponent that have no power.
    Power(f64, f64),
    /// A table that has no value at this argument.
    Table {
        /// Number of the table.
        table: usize,
        /// Its argument.
        x: f64,
        /// Ends of its points.
        range: [f64; 2],
    },
    /// An external function that gave no number.
    External {
        /// Number of the function.
        function: usize,
        /// Its first argument.
        x: f64,
    },
    /// An input that is not defined itself.
    Input(u32),
    /// A number too large to be held.
    TooLarge,
}

impl Program {
    /// Why an output is undefined at `inputs` in the branch that `modes` select; none if it is defined.
    #[must_use]
    pub fn cause(&self, output: usize, inputs: &[f64], modes: &[i32]) -> Option<Cause> {
        let mut registers = vec![f64::NAN; self.registers];
        let mut outputs = vec![f64::NAN; self.outputs.len()];
        self.eval(inputs, modes, &mut registers, &mut outputs);
        // the instruction that has made each register
        let mut made = Vec::with_capacity(self.registers);
        for op in &self.ops {
            made.extend(std::iter::repeat_n(*op, if matches!(op, Op::SinCos(_)) { 2 } else { 1 }));
        }
        let value = |register: u32| registers[register as usize];
        let mut register = *self.outputs.get(output)?;
        if value(register).is_finite() {
            return None;
        }
        // operands stand before what is made of them, so that this ends
        loop {
            let op = made[register as usize];
            match operands(op, modes, value).into_iter().flatten().find(|operand| !value(*operand).is_finite()) {
                Some(operand) => register = operand,
                None => return Some(self.describe(op, value)),
            }
        }
    }

    /// An operation that is undefined at arguments that are defined.
    fn describe(&self, op: Op, value: impl Fn(u32) -> f64) -> Cause {
        match op {
            Op::Input(i) => Cause::Input(i),
            Op::Tan(a) => Cause::Function("tan", value(a)),
            Op::Asin(a) => Cause::Function("asin", value(a)),
            Op::Acos(a) => Cause::Function("acos", value(a)),
            Op::Sqrt(a) => Cause::Function("sqrt", value(a)),
            Op::Exp(a) => Cause::Function("exp", value(a)),
            Op::Ln(a) => Cause::Function("log", value(a)),
            Op::Log10(a) => Cause::Function("log10", value(a)),
            Op::Sinh(a) => Cause::Function("sinh", value(a)),
            Op::Cosh(a) => Cause::Function("cosh", value(a)),
            Op::Div(_, b) if value(b) == 0.0 => Cause::Zero,
            Op::Powi(a, n) if value(a) == 0.0 && n < 0 => Cause::Zero,
            Op::Powf(a, n) => Cause::Power(value(a), n),
            Op::Pow(a, b) => Cause::Power(value(a), value(b)),
            Op::Table(table, _, x, _) => {
                let table = usize::from(table);
                let range = self.tables.get(table).map_or([f64::NAN; 2], |t| [t.x[0], t.x[t.segments()]]);
                Cause::Table { table, x: value(x), range }
            }
            Op::Call(function, _, last) => {
                let function = usize::from(function);
                let count = self.externals.get(function).map_or(1, |f| f.names().count());
                Cause::External { function, x: value(last + 1 - count as u32) }
            }
            _ => Cause::TooLarge,
        }
    }
}

impl Pool {
    /// Why a node that depends on parameters and constants only is undefined; none if it is defined.
    #[must_use]
    pub fn cause(&self, id: Id, parameters: &[f64], tables: &Arc<[LookupTable]>) -> Option<Cause> {
        let program = self.program(&[id], parameters, tables);
        let (mut registers, mut modes) = (vec![0.0; program.registers], vec![0; self.switches().len()]);
        let inputs = vec![f64::NAN; program.inputs().last().map_or(0, |i| *i as usize + 1)];
        program.set_modes(&inputs, &mut registers, &mut modes);
        program.cause(0, &inputs, &modes)
    }
}

/// The operands that the value of an instruction depends on.
fn operands(op: Op, modes: &[i32], value: impl Fn(u32) -> f64) -> [Option<u32>; 2] {
    match op {
        Op::Const(_) | Op::Input(_) | Op::Holds(..) | Op::Mode(_) => [None; 2],
        Op::Neg(a) | Op::Shift(a, _) | Op::Scale(a, _) | Op::Powi(a, _) | Op::Powf(a, _) => [Some(a), None],
        Op::SinCos(a) | Op::Tan(a) | Op::Asin(a) | Op::Acos(a) | Op::Atan(a) | Op::Sqrt(a) | Op::Exp(a) | Op::Ln(a) => [Some(a), None],
        Op::Log10(a) | Op::Sinh(a) | Op::Cosh(a) | Op::Tanh(a) => [Some(a), None],
        Op::Call(_, _, a) | Op::Not(a) | Op::Magnitude(a) | Op::Signed(a, _) | Op::Sign(a, _) | Op::Floor(a, _) | Op::Table(_, _, a, _) => {
            [Some(a), None]
        }
        Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) | Op::Pow(a, b) | Op::Atan2(a, b) => [Some(a), Some(b)],
        Op::Argument(a, b) | Op::Compare(_, _, a, b) | Op::And(a, b) | Op::Or(a, b) | Op::Select(a, b, _) | Op::Where(a, b) => {
            [Some(a), Some(b)]
        }
        Op::If(c, a, b) => [Some(c), Some(if value(c) != 0.0 { a } else { b })],
        Op::Choose(a, b, switch) => [Some(if modes.get(switch as usize).is_some_and(|mode| *mode != 0) { a } else { b }), None],
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Between, Beyond, Compare};
    use super::*;

    fn cause(pool: &Pool, id: Id, x: f64) -> Option<Cause> {
        let tables: Arc<[LookupTable]> = Arc::new([LookupTable::new(&[(1.0, 0.0), (2.0, 1.0)], Between::Linear, Beyond::Error).unwrap()]);
        let program = pool.program(&[id], &[], &tables);
        let (mut registers, mut modes) = (vec![0.0; program.registers()], vec![0; pool.switches().len()]);
        program.set_modes(&[x], &mut registers, &mut modes);
        program.cause(0, &[x], &modes)
    }

    #[test]
    fn the_first_operation_without_a_value_is_named_with_its_argument() {
        let mut p = Pool::new();
        let (x, one) = (p.input(0), p.constant(1.0));
        let root = p.sqrt(x);
        let sum = p.add(root, one);
        let capped = p.max(sum, one, "");
        assert_eq!(cause(&p, capped, -4.0), Some(Cause::Function("sqrt", -4.0)));
        assert_eq!((cause(&p, capped, 4.0), cause(&p, capped, f64::NAN)), (None, Some(Cause::Input(0))));
        let quotient = p.div(one, x);
        let angle = p.atan(quotient);
        assert_eq!(cause(&p, angle, 0.0), Some(Cause::Zero));
        let table = p.table(0, 0, x, "f(x)");
        let places = [0.5, 2.5].map(|x| cause(&p, table, x));
        assert_eq!(places, [0.5, 2.5].map(|x| Some(Cause::Table { table: 0, x, range: [1.0, 2.0] })));
        // what is not taken has no part in it
        let positive = p.compare(Compare::Greater, x, one, "");
        let chosen = p.choose(positive, table, root);
        assert_eq!(cause(&p, chosen, -1.0), Some(Cause::Function("sqrt", -1.0)));
        let half = p.constant(0.3);
        let power = p.pow(x, half);
        assert_eq!(cause(&p, power, -1.0), Some(Cause::Power(-1.0, 0.3)));
        let cubed = p.powi(x, 3);
        assert_eq!(cause(&p, cubed, 1e200), Some(Cause::TooLarge));
    }
}
