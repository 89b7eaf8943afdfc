//! Syntax tree → nodes: names are looked up, dimensions checked, all faults of an expression collected.
//!
//! A bare number (no unit, no name) takes the dimension that its field or table wants, but not that of a neighbour in a sum:
//! `l3 + 0.1` would hide in which unit the 0.1 was thought.

use super::function::{self, Function, Functional, Shape};
use super::parser::{Expr, Kind};
use super::pool::{Id, Node, Pool};
use super::quantity::{near_unit_hint, unit_below, unit_hint};
use super::scope::{Fault, Lowered, Scope, Unknown};
use super::switch::Compare;
use super::unit_text::angle_instead;
use super::units::Dimension;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;

/// The node of an expression, its dimension checked throughout. `text` is what was parsed; switches quote it.
///
/// # Errors
/// Every fault of meaning that could be found at once.
pub fn lower(pool: &mut Pool, expr: &Expr, text: &str, scope: &mut dyn Scope) -> Result<Lowered, Vec<Fault>> {
    let mut lowerer = Lowerer { pool, text, scope, faults: Vec::new(), inputs: HashMap::new() };
    match lowerer.expr(expr) {
        Some(lowered) if lowerer.faults.is_empty() => Ok(lowered),
        _ => Err(lowerer.faults),
    }
}

/// What is expected in the place of a name that is called.
pub const CALLED: &str = "a function or a table";

pub(super) struct Lowerer<'a> {
    pub(super) pool: &'a mut Pool,
    text: &'a str,
    scope: &'a mut dyn Scope,
    faults: Vec<Fault>,
    /// Paths that stand for single inputs, for messages.
    inputs: HashMap<u32, String>,
}

/// An operand with its place; `None` where a fault was found already.
type Operand = (Option<Lowered>, Range<usize>);

impl Lowerer<'_> {
    pub(super) fn fault(&mut self, at: &Range<usize>, found: String, expected: impl Into<String>, help: Option<String>) {
        self.faults.push(Fault { at: at.clone(), found, expected: expected.into(), help, wanted: None });
    }

    fn unknown(&mut self, at: &Range<usize>, unknown: Unknown) {
        self.fault(at, unknown.found, unknown.expected, unknown.help);
    }

    fn slice(&self, at: &Range<usize>) -> &str {
        self.text.get(at.clone()).unwrap_or_default()
    }

    fn made(&self, id: Id, dimension: Dimension, bare: bool) -> Lowered {
        Lowered { id, dimension, any: false, bare, boolean: self.pool.is_condition(id) && self.pool.constant_value(id).is_none() }
    }

    fn operand(&mut self, expr: &Expr) -> Operand {
        (self.expr(expr), expr.at.clone())
    }

    pub(super) fn expr(&mut self, expr: &Expr) -> Option<Lowered> {
        match &expr.kind {
            Kind::Number(x) => {
                let id = self.pool.constant(*x);
                Some(Lowered { any: *x == 0.0, ..self.made(id, Dimension::NONE, true) })
            }
            Kind::Quantity(x, dimension, starred) => {
                self.refuse_double(&expr.at, starred)?;
                let id = self.pool.constant(*x);
                Some(self.made(id, *dimension, false))
            }
            Kind::Path(path) => self.path(path, &expr.at),
            Kind::Negate(a) => {
                let a = self.expr(a)?;
                Some(Lowered { id: self.pool.neg(a.id), boolean: false, ..a })
            }
            Kind::Sum(first, rest) => self.sum(first, rest),
            Kind::Product(first, rest) => self.product(first, rest),
            Kind::Power(base, exponent) => self.power(base, exponent),
            Kind::Compare(op, a, b) => self.compare(*op, a, b, &expr.at),
            Kind::Not(a) => {
                let a = self.condition(a)?;
                let id = self.pool.not(a.id);
                Some(Lowered { id, ..a })
            }
            Kind::And(all) => self.joined(all, Pool::and),
            Kind::Or(all) => self.joined(all, Pool::or),
            Kind::Call(name, name_at, arguments) => self.call(name, name_at, arguments, &expr.at),
        }
    }

    /// Refuses a quantity like `9.81 m/s^2*m` where `m` is a name too: both readings make sense.
    fn refuse_double(&mut self, at: &Range<usize>, starred: &[Range<usize>]) -> Option<()> {
        let Some(word_at) = starred.iter().find(|word| self.scope.has_value(self.slice(word))) else { return Some(()) };
        let (word, behind) = (self.slice(word_at).to_owned(), self.slice(&(word_at.start..at.end)).to_owned());
        let before = self.slice(&(at.start..word_at.start)).trim_end().trim_end_matches('*').trim_end().to_owned();
        let help = Some(format!("write `({before})*{behind}` for the name, `{before}*1 {behind}` for the unit"));
        self.fault(
            word_at,
            format!("`*{word}`, where `{word}` is a unit and a name of this file"),
            format!("`{word}` with one meaning"),
            help,
        );
        None
    }

    fn path(&mut self, path: &str, at: &Range<usize>) -> Option<Lowered> {
        if path == "pi" {
            let id = self.pool.constant(PI);
            return Some(self.made(id, Dimension::NONE, true));
        }
        match self.scope.name(self.pool, path) {
            Ok(symbol) => {
                if let Node::Input(i) = self.pool.node(symbol.id) {
                    self.inputs.insert(i, path.to_owned());
                }
                Some(self.made(symbol.id, symbol.dimension, false))
            }
            Err(mut unknown) => {
                let below = unit_below(self.slice(&(0..at.start)), path).filter(|_| !unknown.found.is_empty());
                unknown.help = below.or(unknown.help).or_else(|| unit_hint(path)).or_else(|| near_unit_hint(path));
                self.unknown(at, unknown);
                None
            }
        }
    }

    /// The one dimension of operands that must agree, whether all are literal zeros, whether all are bare; a fault at each that differs.
    fn agree(&mut self, operands: &[Operand]) -> (Dimension, bool, bool) {
        let known: Vec<(Lowered, &Range<usize>)> = operands.iter().filter_map(|(l, at)| l.map(|l| (l, at))).collect();
        let sized = || known.iter().filter(|(l, _)| !l.any);
        // whoever has a unit or a name decides, so that the bare number is blamed
        let leader = sized().find(|(l, _)| !l.bare).or_else(|| sized().next()).or(known.first());
        let dimension = leader.map_or(Dimension::NONE, |(l, _)| l.dimension);
        let angular = sized().filter(|(l, _)| l.dimension == dimension).map(|(l, _)| l.dimension);
        let dimension = angular.fold(dimension, Dimension::or_angle);
        let (any, bare) = (known.iter().all(|(l, _)| l.any), known.iter().all(|(l, _)| l.bare));
        let wrong: Vec<_> = sized().filter(|(l, _)| l.dimension != dimension).map(|(l, at)| (*l, (*at).clone())).collect();
        for (lowered, at) in wrong {
            let text = self.slice(&at);
            let literal = text.parse::<f64>().is_ok();
            let help = lowered.bare.then(|| {
                let with_unit = if literal { dimension.written(text) } else { format!("({text})*{}", dimension.written("1")) };
                format!("write `{with_unit}`")
            });
            let (found, expected) = (lowered.dimension.name(), dimension.name());
            self.faults.push(Fault { at, found, expected, help, wanted: Some(dimension) });
        }
        (dimension, any, bare)
    }

    fn sum(&mut self, first: &Expr, rest: &[(bool, Expr)]) -> Option<Lowered> {
        let mut operands = vec![self.operand(first)];
        for (_, term) in rest {
            let operand = self.operand(term);
            operands.push(operand);
        }
        let (dimension, any, bare) = self.agree(&operands);
        let mut id = operands[0].0?.id;
        for ((operand, _), (minus, _)) in operands[1..].iter().zip(rest) {
            let term = (*operand)?.id;
            id = if *minus { self.pool.sub(id, term) } else { self.pool.add(id, term) };
        }
        Some(Lowered { any, boolean: false, ..self.made(id, dimension, bare) })
    }

    /// How a quantity of a dimension becomes a number: `t/1 s`.
    fn as_number(&self, at: &Range<usize>, dimension: Dimension) -> String {
        const LONGEST: usize = 30;
        let text = self.slice(at).trim();
        let one_word = text.bytes().all(|c| c.is_ascii_alphanumeric() || b"._".contains(&c));
        let text = match text {
            text if one_word => text.to_owned(),
            text if text.len() > LONGEST => "x".to_owned(),
            text => format!("({text})"),
        };
        format!("divide it by a unit, as `{text}/{}`", dimension.written("1"))
    }

    fn product(&mut self, first: &Expr, rest: &[(bool, Expr)]) -> Option<Lowered> {
        let mut product = self.expr(first);
        for (divide, factor) in rest {
            // every factor is lowered, so that all faults are found
            let factor = self.expr(factor);
            product = product.zip(factor).map(|(a, b)| {
                let bare = a.bare && b.bare;
                if *divide {
                    let id = self.pool.div(a.id, b.id);
                    Lowered { any: a.any, ..self.made(id, a.dimension.div(b.dimension), bare) }
                } else {
                    let id = self.pool.mul(a.id, b.id);
                    Lowered { any: a.any || b.any, ..self.made(id, a.dimension.mul(b.dimension), bare) }
                }
            });
        }
        product.map(|product| Lowered { boolean: false, ..product })
    }

    fn power(&mut self, base: &Expr, exponent: &Expr) -> Option<Lowered> {
        let (base_at, at) = (&base.at, &exponent.at);
        let (base, exponent) = (self.expr(base), self.expr(exponent));
        let exponent = exponent.filter(|n| {
            let plain = n.any || n.dimension == Dimension::NONE;
            if !plain {
                let help = self.as_number(at, n.dimension);
                self.fault(at, n.dimension.name(), "a number as exponent", Some(help));
            }
            plain
        })?;
        let base = base?;
        let dimension = if base.any || base.dimension == Dimension::NONE {
            self.pool.constant_value(exponent.id).and_then(|n| base.dimension.power(n)).unwrap_or(Dimension::NONE)
        } else {
            let name = base.dimension.name();
            let Some(n) = self.pool.constant_value(exponent.id) else {
                let help = Some(format!("divide the base by a {name} first, so that it is a number"));
                self.fault(at, "an exponent that is not a constant".to_owned(), format!("a constant exponent of {name}"), help);
                return None;
            };
            let Some(dimension) = base.dimension.power(n) else {
                self.fault(base_at, name, format!("a quantity whose power {n} has a unit"), None);
                return None;
            };
            dimension
        };
        let id = self.pool.pow(base.id, exponent.id);
        Some(Lowered { boolean: false, ..self.made(id, dimension, base.bare && exponent.bare) })
    }

    fn compare(&mut self, op: Compare, a: &Expr, b: &Expr, at: &Range<usize>) -> Option<Lowered> {
        let operands = [self.operand(a), self.operand(b)];
        let (_, _, bare) = self.agree(&operands);
        let (a, b) = (operands[0].0?, operands[1].0?);
        let text = self.slice(at).to_owned();
        let id = self.pool.compare(op, a.id, b.id, &text);
        Some(Lowered { boolean: true, ..self.made(id, Dimension::NONE, bare) })
    }

    /// An expression as a condition; a number is true unless it is 0.
    fn condition(&mut self, expr: &Expr) -> Option<Lowered> {
        let a = self.expr(expr)?;
        if !a.any && (a.dimension != Dimension::NONE || a.dimension.is_angle()) {
            let help = Some(format!("compare it, as `{} > 0`", self.slice(&expr.at)));
            self.fault(&expr.at, a.dimension.name(), "a condition, as `a > b`", help);
            return None;
        }
        let text = format!("{} != 0", self.slice(&expr.at));
        let id = self.pool.condition(a.id, &text);
        Some(Lowered { id, dimension: Dimension::NONE, any: false, bare: a.bare, boolean: true })
    }

    fn joined(&mut self, all: &[Expr], join: fn(&mut Pool, Id, Id) -> Id) -> Option<Lowered> {
        let mut joined: Option<Option<Lowered>> = None;
        for expr in all {
            let next = self.condition(expr);
            joined = Some(match joined {
                None => next,
                Some(before) => before.zip(next).map(|(a, b)| Lowered { id: join(self.pool, a.id, b.id), bare: a.bare && b.bare, ..a }),
            });
        }
        joined.flatten()
    }

    fn call(&mut self, name: &str, name_at: &Range<usize>, arguments: &[Expr], at: &Range<usize>) -> Option<Lowered> {
        if let Some(functional) = function::functional(name, arguments.len()) {
            return self.functional(functional, name_at, arguments, at);
        }
        if let Some(function) = function::named(name) {
            return self.function(function, arguments, at);
        }
        if let Some((table, x, y)) = self.scope.table(name) {
            return self.table(name, (table, x, y), arguments, at);
        }
        if let Some(number) = self.scope.external(name) {
            return self.external(number, arguments, at);
        }
        // what may stand in a function is known only of a known one
        if function::meant(name).is_none() {
            for argument in arguments {
                self.expr(argument);
            }
        }
        self.fault(name_at, format!("`{name}(..)`"), CALLED, Some(function::remedy(name)));
        None
    }

    /// Faults a call with another number of arguments.
    pub(super) fn counted(&mut self, found: usize, (least, most): (usize, usize), usage: &str, at: &Range<usize>) -> bool {
        let right = (least..=most).contains(&found);
        if !right {
            let plural = if found == 1 { "" } else { "s" };
            self.fault(at, format!("{found} argument{plural}"), format!("`{usage}`"), None);
        }
        right
    }

    fn function(&mut self, function: Function, arguments: &[Expr], at: &Range<usize>) -> Option<Lowered> {
        let is_if = function.shape == Shape::If;
        let mut operands = Vec::with_capacity(arguments.len());
        for (i, argument) in arguments.iter().enumerate() {
            let lowered = if is_if && i == 0 { self.condition(argument) } else { self.expr(argument) };
            operands.push((lowered, argument.at.clone()));
        }
        if !self.counted(arguments.len(), function.count, function.usage, at) {
            return None;
        }
        let (dimension, any, bare) = match function.shape {
            Shape::Number | Shape::Inverse => {
                if let (Some(x), x_at) = &operands[0]
                    && x.expect(Dimension::NONE).is_err()
                {
                    let expected = format!("a number or an angle in `{}`", function.usage);
                    let help = self.as_number(x_at, x.dimension);
                    self.fault(x_at, x.dimension.name(), expected, Some(help));
                    return None;
                }
                if let (Some(x), x_at) = &operands[0]
                    && matches!(function.name, "sin" | "cos" | "tan")
                    && let Err(found) = x.expect(Dimension::ANGLE)
                {
                    let help = angle_instead(self.slice(x_at));
                    self.fault(x_at, found, format!("an angle in `{}`", function.usage), Some(help));
                    return None;
                }
                (Dimension::NONE, false, operands[0].0?.bare)
            }
            Shape::If => {
                let (dimension, any, bare) = self.agree(&operands[1..]);
                (dimension, any, bare && operands[0].0?.bare)
            }
            _ => self.agree(&operands),
        };
        let ids = operands.iter().map(|(operand, _)| operand.map(|o| o.id)).collect::<Option<Vec<Id>>>()?;
        let Some(dimension) = function.dimension(dimension) else {
            self.fault(&operands[0].1, dimension.name(), "a quantity whose square root has a unit", None);
            return None;
        };
        if let ("clamp", &[_, low, high]) = (function.name, &ids[..])
            && let (Some(low), Some(high)) = (self.pool.constant_value(low), self.pool.constant_value(high))
            && low > high
        {
            let found = format!("bounds from {} to {}", self.slice(&operands[1].1), self.slice(&operands[2].1));
            let expected = format!("`{}` with `low` not above `high`", function.usage);
            self.fault(at, found, expected, Some("exchange the bounds".to_owned()));
            return None;
        }
        let text = self.slice(at).to_owned();
        let id = match function.node(self.pool, &ids, &text) {
            Some(id) => id,
            None => {
                // a rate may be defined where what it is the rate of is not: that of log(x) is rate(x)/x
                let rate = self.rate(ids[0], at)?;
                self.pool.where_defined(rate, ids[0])
            }
        };
        let keeps_zero = matches!(function.shape, Shape::Same | Shape::Alike | Shape::If | Shape::Root);
        Some(Lowered { any: any && keeps_zero, ..self.made(id, dimension, bare) })
    }

    fn rate(&mut self, id: Id, at: &Range<usize>) -> Option<Id> {
        let scope = &mut *self.scope;
        match self.pool.rate(id, &mut |pool, input| scope.rate(pool, input)) {
            Ok(rate) => Some(rate),
            Err(input) => {
                let found = self.inputs.get(&input).map_or("a quantity without a rate".to_owned(), |path| format!("`{path}`"));
                let help =
                    Some("positions have rates up to the second, velocities up to the first; forces and results have none".to_owned());
                self.fault(at, found, "a quantity whose rate is known", help);
                None
            }
        }
    }

    fn table(&mut self, name: &str, (table, x, y): (u32, Dimension, Dimension), arguments: &[Expr], at: &Range<usize>) -> Option<Lowered> {
        let operands: Vec<Operand> = arguments.iter().map(|argument| self.operand(argument)).collect();
        if !self.counted(arguments.len(), (1, 1), &format!("{name}(x)"), at) {
            return None;
        }
        let (operand, operand_at) = &operands[0];
        let argument = (*operand)?;
        if let Err(found) = argument.expect(x) {
            let expected = format!("{} as argument of table `{name}`", x.name());
            let help = (x == Dimension::NONE).then(|| self.as_number(operand_at, argument.dimension));
            self.faults.push(Fault { at: operand_at.clone(), found, expected, help, wanted: Some(x) });
            return None;
        }
        let text = self.slice(at).to_owned();
        let id = self.pool.table(table, 0, argument.id, &text);
        Some(self.made(id, y, false))
    }

    fn functional(&mut self, functional: Functional, name_at: &Range<usize>, arguments: &[Expr], at: &Range<usize>) -> Option<Lowered> {
        let Functional { name, count, usage } = functional;
        if let Err(unknown) = self.scope.enter_functional(name) {
            self.unknown(name_at, unknown);
            return None;
        }
        let of = arguments.first().and_then(|of| if name == "first" { self.condition(of) } else { self.expr(of) });
        self.scope.leave_functional();
        let rest: Vec<Option<Lowered>> = arguments.iter().skip(1).map(|argument| self.expr(argument)).collect();
        if !self.counted(arguments.len(), (count, count), usage, at) {
            return None;
        }
        let of = of?;
        let place = match rest.first() {
            Some(place) => Some((*place)?),
            None => None,
        };
        match self.scope.functional(self.pool, name, of, place, self.text.get(at.clone()).unwrap_or_default()) {
            Ok(symbol) => Some(self.made(symbol.id, symbol.dimension, false)),
            Err(unknown) => {
                self.unknown(at, unknown);
                None
            }
        }
    }
}

#[cfg(test)]
#[path = "lower_tests.rs"]
mod tests;
