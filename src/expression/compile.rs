//! Nodes → program: parameters become numbers, what follows from numbers is folded, what no output needs is left out.

use super::external::By;
use super::pool::{Id, Node, Pool};
use super::program::{Decision, Op, Program};
use super::switch::{Switch, Test};
use super::table::LookupTable;
use std::collections::HashMap;
use std::sync::Arc;

impl Pool {
    /// The program that computes `outputs` from inputs.
    ///
    /// `tables` are indexed as the pool's table nodes. A switch that only parameters decide is not in the program.
    #[must_use]
    pub fn program(&self, outputs: &[Id], parameters: &[f64], tables: &Arc<[LookupTable]>) -> Program {
        let (folded, outputs) = self.with_numbers(outputs, parameters, tables);
        let mut compiler = Compiler { pool: &folded, program: Program::default(), registers: HashMap::new(), next: 0 };
        for id in folded.reach(&outputs) {
            compiler.node(id);
        }
        let mut program = compiler.finish(&outputs);
        program.tables = Arc::clone(tables);
        program.externals = Arc::clone(&self.externals);
        program
    }

    /// A copy of what `outputs` need with numbers for parameters; switches keep their numbers.
    fn with_numbers(&self, outputs: &[Id], parameters: &[f64], tables: &[LookupTable]) -> (Self, Vec<Id>) {
        let order = self.reach(outputs);
        let mut copy = Self::with_externals(Arc::clone(&self.externals));
        copy.switches = self.switches.iter().map(|s| Switch { test: s.test, text: String::new() }).collect();
        let mut image: HashMap<Id, Id> = HashMap::with_capacity(order.len());
        for id in order {
            let node = self.node(id);
            // operands come first, so their images are known
            let of = |operand: Id| image.get(&operand).copied().unwrap_or(operand);
            if let Some(switch) = node.switch() {
                copy.switches[switch as usize].test = self.switches[switch as usize].test.map(of);
            }
            let new = match node {
                Node::Parameter(i) => copy.constant(parameters.get(i as usize).copied().unwrap_or(f64::NAN)),
                Node::Input(i) if self.given(i).is_some() => copy.constant(self.given(i).unwrap_or(f64::NAN)),
                Node::Table { table, order, x, .. } => {
                    let value = copy.number(of(x)).zip(tables.get(table as usize)).map(|(x, t)| t.eval(x, t.segment(x), order));
                    match value.filter(|y| y.is_finite()) {
                        Some(y) => copy.constant(y),
                        None => copy.simplify(node.map(of)),
                    }
                }
                _ => copy.simplify(node.map(of)),
            };
            image.insert(id, new);
        }
        let outputs = outputs.iter().map(|id| image[id]).collect();
        (copy, outputs)
    }
}

struct Compiler<'a> {
    pool: &'a Pool,
    program: Program,
    /// Where the value of a node is.
    registers: HashMap<Id, u32>,
    next: u32,
}

impl Compiler<'_> {
    fn emit(&mut self, op: Op) -> u32 {
        let register = self.next;
        self.next += 1 + u32::from(matches!(op, Op::SinCos(_)));
        self.program.ops.push(op);
        register
    }

    /// The register of a node; numbers get theirs when an instruction needs them there.
    fn register(&mut self, id: Id) -> u32 {
        if let Some(register) = self.registers.get(&id) {
            return *register;
        }
        // every node but a number was compiled before those that use it
        let value = self.pool.constant_value(id).unwrap_or(f64::NAN);
        let register = self.emit(Op::Const(value));
        self.registers.insert(id, register);
        register
    }

    /// Puts the switch before the next instruction.
    fn decide(&mut self, switch: u32) {
        if self.program.switches.contains(&switch) {
            return;
        }
        let test = self.pool.switches()[switch as usize].test.map(|id| self.register(id));
        self.program.switches.push(switch);
        self.program.decisions.push(Decision { before: self.program.ops.len() as u32, test });
    }

    fn node(&mut self, id: Id) {
        if self.registers.contains_key(&id) {
            return;
        }
        let node = self.pool.node(id);
        if let Some(switch) = node.switch() {
            self.decide(switch);
        }
        let number = |id: Id| self.pool.constant_value(id);
        let op = match node {
            Node::Const(_) | Node::Argument { .. } => return,
            Node::Call { function, by, last } => self.call(function, by, last),
            // a program without parameters: they were replaced by numbers
            Node::Parameter(_) => Op::Const(f64::NAN),
            Node::Input(i) => Op::Input(i),
            Node::Neg(a) => Op::Neg(self.register(a)),
            Node::Add(a, b) => match (number(a), number(b)) {
                (Some(c), _) => Op::Shift(self.register(b), c),
                (_, Some(c)) => Op::Shift(self.register(a), c),
                _ => Op::Add(self.register(a), self.register(b)),
            },
            Node::Sub(a, b) => match number(b) {
                Some(c) => Op::Shift(self.register(a), -c),
                None => Op::Sub(self.register(a), self.register(b)),
            },
            Node::Mul(a, b) => match (number(a), number(b)) {
                (Some(c), _) => Op::Scale(self.register(b), c),
                (_, Some(c)) => Op::Scale(self.register(a), c),
                _ => Op::Mul(self.register(a), self.register(b)),
            },
            Node::Div(a, b) => Op::Div(self.register(a), self.register(b)),
            Node::Pow(a, b) => match number(b) {
                Some(n) => Op::Powf(self.register(a), n),
                None => Op::Pow(self.register(a), self.register(b)),
            },
            Node::Powi(a, n) => Op::Powi(self.register(a), n),
            Node::Sin(a) | Node::Cos(a) => return self.sin_cos(a),
            Node::Tan(a) => Op::Tan(self.register(a)),
            Node::Asin(a) => Op::Asin(self.register(a)),
            Node::Acos(a) => Op::Acos(self.register(a)),
            Node::Atan(a) => Op::Atan(self.register(a)),
            Node::Atan2(a, b) => Op::Atan2(self.register(a), self.register(b)),
            Node::Sqrt(a) => Op::Sqrt(self.register(a)),
            Node::Exp(a) => Op::Exp(self.register(a)),
            Node::Ln(a) => Op::Ln(self.register(a)),
            Node::Log10(a) => Op::Log10(self.register(a)),
            Node::Sinh(a) => Op::Sinh(self.register(a)),
            Node::Cosh(a) => Op::Cosh(self.register(a)),
            Node::Tanh(a) => Op::Tanh(self.register(a)),
            Node::Compare { op, switch } => match self.pool.switches()[switch as usize].test {
                Test::Compare(_, a, b) => Op::Compare(op, switch, self.register(a), self.register(b)),
                _ => Op::Const(f64::NAN),
            },
            Node::Where(a, b) => Op::Where(self.register(a), self.register(b)),
            Node::And(a, b) => Op::And(self.register(a), self.register(b)),
            Node::Or(a, b) => Op::Or(self.register(a), self.register(b)),
            Node::Not(a) => Op::Not(self.register(a)),
            Node::If { condition, then, other } => Op::If(self.register(condition), self.register(then), self.register(other)),
            Node::Abs { a, switch } => {
                let signed = Op::Signed(self.register(a), switch);
                return self.where_tested(id, signed, switch, &[a]);
            }
            Node::Sign { switch } => match self.pool.switches()[switch as usize].test {
                Test::Sign(a) => Op::Sign(self.register(a), switch),
                _ => Op::Const(f64::NAN),
            },
            Node::Floor { a, switch } => Op::Floor(self.register(a), switch),
            Node::Min { a, b, switch } => return self.select(id, [a, b], switch),
            Node::Max { a, b, switch } => return self.select(id, [b, a], switch),
            Node::Table { table, order, x, switch } => match u16::try_from(table) {
                Ok(table) => Op::Table(table, order, self.register(x), switch),
                Err(_) => Op::Const(f64::NAN),
            },
        };
        let register = self.emit(op);
        self.registers.insert(id, register);
    }

    /// One of two values; a rate is selected as what it is the rate of, and undefined where that is.
    fn select(&mut self, id: Id, [a, b]: [Id; 2], switch: u32) {
        let [first, second] = [self.register(a), self.register(b)];
        let whole = matches!(self.pool.switches()[switch as usize].test, Test::Order(x, y) if [x.min(y), x.max(y)] == [a.min(b), a.max(b)]);
        let op = if whole { Op::Select(first, second, switch) } else { Op::Choose(first, second, switch) };
        self.where_tested(id, op, switch, &[a, b]);
    }

    /// The instruction of a node, and that its value is undefined where an operand of its switch is that it does not have itself.
    fn where_tested(&mut self, id: Id, op: Op, switch: u32, own: &[Id]) {
        let mut register = self.emit(op);
        let mut tested = Vec::new();
        let _ = self.pool.switches()[switch as usize].test.map(|operand| tested.push(operand));
        for operand in tested {
            if !own.contains(&operand) && !self.pool.tame[operand.index()] {
                let operand = self.register(operand);
                register = self.emit(Op::Where(register, operand));
            }
        }
        self.registers.insert(id, register);
    }

    /// A call, whose arguments stand in registers one behind the other.
    fn call(&mut self, function: u32, by: By, last: Id) -> Op {
        let arguments: Vec<u32> = self.pool.arguments(last).into_iter().map(|id| self.register(id)).collect();
        let last = arguments.into_iter().fold(None, |before, a| Some(self.emit(Op::Argument(a, before.unwrap_or(a)))));
        match (last, u16::try_from(function)) {
            (Some(last), Ok(function)) => Op::Call(function, by, last),
            _ => Op::Const(f64::NAN),
        }
    }

    /// Sine and cosine of one angle come from one call.
    fn sin_cos(&mut self, a: Id) {
        let angle = self.register(a);
        let register = self.emit(Op::SinCos(angle));
        for (node, register) in [(Node::Sin(a), register), (Node::Cos(a), register + 1)] {
            if let Some(id) = self.pool.index.get(&node) {
                self.registers.insert(*id, register);
            }
        }
    }

    fn finish(mut self, outputs: &[Id]) -> Program {
        self.program.outputs = outputs.iter().map(|id| self.register(*id)).collect();
        let inputs = self.program.ops.iter().filter_map(|op| if let Op::Input(i) = op { Some(*i) } else { None });
        self.program.inputs = inputs.collect();
        self.program.inputs.sort_unstable();
        self.program.registers = self.next as usize;
        self.program
    }
}
