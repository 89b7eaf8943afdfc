//! Calls of external functions: their nodes, their rates, and how they are lowered.

use super::external::{By, ExternalFunction, and_by};
use super::lower::{Lowerer, lower};
use super::parser::{Expr, parse};
use super::pool::{Id, Node, Pool};
use super::scope::{Lowered, Scope, Symbol, Unknown};
use super::units::Dimension;
use std::ops::Range;
use std::sync::Arc;

impl Pool {
    /// A pool whose expressions may call external functions, by their numbers.
    #[must_use]
    pub fn with_externals(externals: Arc<[ExternalFunction]>) -> Self {
        Self { externals, ..Self::default() }
    }

    /// The external functions that nodes call, ascending.
    #[must_use]
    pub fn externals_called(&self) -> Vec<&ExternalFunction> {
        let called = |number: u32| self.nodes.iter().any(|node| matches!(node, Node::Call { function, .. } if *function == number));
        (0..).zip(self.externals.iter()).filter(|(number, _)| called(*number)).map(|(_, function)| function).collect()
    }

    /// The external functions, by their numbers.
    #[must_use]
    pub fn externals(&self) -> &[ExternalFunction] {
        &self.externals
    }

    /// External function number `function` of arguments, the sides of its switches behind them.
    pub fn call(&mut self, function: u32, arguments: &[Id]) -> Id {
        let last = arguments.iter().fold(None, |before, value| Some(self.intern(Node::Argument { value: *value, before })));
        match last {
            Some(last) => self.intern(Node::Call { function, by: By::default(), last }),
            None => self.constant(f64::NAN),
        }
    }

    /// The arguments of a call from its last one.
    pub(super) fn arguments(&self, last: Id) -> Vec<Id> {
        let mut arguments = Vec::new();
        let mut next = Some(last);
        while let Some(Node::Argument { value, before }) = next.map(|id| self.node(id)) {
            arguments.push(value);
            next = before;
        }
        arguments.reverse();
        arguments
    }

    /// Σ (derivative by argument i) · rateᵢ.
    pub(super) fn call_rate(&mut self, (function, by, last): (u32, By, Id), zero: Id, of: impl Fn(Id) -> Id) -> Id {
        let count = self.externals[function as usize].arguments().len();
        let mut rate = zero;
        for (i, argument) in self.arguments(last).into_iter().enumerate().take(count) {
            if of(argument) == zero {
                continue;
            }
            let slope = match and_by(by, i) {
                Some(by) => self.intern(Node::Call { function, by, last }),
                None => self.constant(f64::NAN),
            };
            let part = self.mul(slope, of(argument));
            rate = self.add(rate, part);
        }
        rate
    }
}

impl Lowerer<'_> {
    /// A call of external function `number`.
    pub(super) fn external(&mut self, number: u32, arguments: &[Expr], at: &Range<usize>) -> Option<Lowered> {
        let operands: Vec<Option<Lowered>> = arguments.iter().map(|argument| self.expr(argument)).collect();
        let function = self.pool.externals.get(number as usize)?.clone();
        let count = function.arguments().len();
        if !self.counted(arguments.len(), (count, count), &function.usage(), at) {
            return None;
        }
        let operands = operands.into_iter().collect::<Option<Vec<Lowered>>>()?;
        let mut all: Vec<Id> = operands.iter().map(|operand| operand.id).collect();
        for (_, condition) in function.sides() {
            let mut scope = Arguments { names: function.arguments(), operands: &operands };
            let side = parse(condition).ok().and_then(|expr| match lower(self.pool, &expr, condition, &mut scope) {
                Ok(side) => Some(self.pool.condition(side.id, condition)),
                Err(faults) => {
                    for fault in faults {
                        let found = format!("{} in its switch `{condition}`", fault.found);
                        self.fault(at, found, fault.expected, fault.help);
                    }
                    None
                }
            });
            all.push(side?);
        }
        let value = self.pool.call(number, &all);
        let (size, dimension) = function.size().unwrap_or((1.0, Dimension::NONE));
        let size = self.pool.constant(size);
        let id = self.pool.mul(value, size);
        Some(Lowered { id, dimension, any: false, bare: function.size().is_none(), boolean: false })
    }
}

/// The arguments of a function as its switches see them.
struct Arguments<'a> {
    names: &'a [String],
    operands: &'a [Lowered],
}

impl Scope for Arguments<'_> {
    fn name(&mut self, _: &mut Pool, path: &str) -> Result<Symbol, Unknown> {
        let found = self.names.iter().position(|name| name == path).map(|i| self.operands[i]);
        found.map(|operand| Symbol { id: operand.id, dimension: operand.dimension }).ok_or_else(|| Unknown {
            found: format!("`{path}`"),
            expected: format!("an argument of the function: {}", self.names.join(", ")),
            help: None,
        })
    }

    fn has_value(&self, word: &str) -> bool {
        self.names.iter().any(|name| name == word)
    }

    fn enter_functional(&mut self, name: &str) -> Result<(), Unknown> {
        Err(Unknown { found: format!("`{name}`"), expected: "a comparison of arguments".into(), help: None })
    }

    fn functional(&mut self, _: &mut Pool, name: &str, _: Lowered, _: Option<Lowered>, _: &str) -> Result<Symbol, Unknown> {
        Err(Unknown { found: format!("`{name}`"), expected: "a comparison of arguments".into(), help: None })
    }
}

#[cfg(test)]
#[path = "calls_tests.rs"]
mod tests;
