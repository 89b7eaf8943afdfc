//! Exact time derivatives by the chain rule.
//!
//! Modes do not change while a rate is taken: the rate of a selection is the selection of the rates by the same switch.

use super::pool::{Id, Node, Pool};
use std::collections::HashMap;
use std::f64::consts::LN_10;

impl Pool {
    /// The time derivative of a node; `leaf` gives the node that is the rate of an input.
    ///
    /// # Errors
    /// An input for which `leaf` gives none.
    pub fn rate(&mut self, id: Id, leaf: &mut dyn FnMut(&mut Self, u32) -> Option<Id>) -> Result<Id, u32> {
        let zero = self.constant(0.0);
        let mut rates: HashMap<Id, Id> = HashMap::new();
        for id in self.reach(&[id]) {
            let node = self.node(id);
            let rate = match node {
                Node::Input(i) => leaf(self, i).ok_or(i)?,
                _ => {
                    let of = |operand: Id| rates.get(&operand).copied().unwrap_or(zero);
                    self.chain_rule(id, node, zero, of)
                }
            };
            rates.insert(id, rate);
        }
        Ok(rates.get(&id).copied().unwrap_or(zero))
    }

    /// Rate of a node from the rates of its operands.
    fn chain_rule(&mut self, id: Id, node: Node, zero: Id, of: impl Fn(Id) -> Id) -> Id {
        match node {
            Node::Const(_) | Node::Parameter(_) | Node::Input(_) => zero,
            Node::Compare { .. } | Node::And(..) | Node::Or(..) | Node::Not(_) | Node::Sign { .. } | Node::Floor { .. } => zero,
            // of a call its arguments themselves count
            Node::Argument { .. } => zero,
            Node::Call { function, by, last } => self.call_rate((function, by, last), zero, of),
            Node::Neg(a) => self.neg(of(a)),
            Node::Add(a, b) => self.add(of(a), of(b)),
            Node::Sub(a, b) => self.sub(of(a), of(b)),
            Node::Mul(a, b) if a == b => {
                // (a²)' = 2 a a'
                let two = self.constant(2.0);
                let slope = self.mul(two, a);
                self.scaled(slope, of(a), zero)
            }
            Node::Mul(a, b) => {
                let (left, right) = (self.scaled(b, of(a), zero), self.scaled(a, of(b), zero));
                self.add(left, right)
            }
            Node::Div(a, b) => {
                // (a/b)' = (a' − (a/b) b')/b
                let drop = self.scaled(id, of(b), zero);
                let top = self.sub(of(a), drop);
                if top == zero { zero } else { self.div(top, b) }
            }
            Node::Pow(a, b) => self.power_rule(id, a, b, zero, of),
            Node::Powi(a, n) => {
                // (aⁿ)' = n aⁿ⁻¹ a'
                let (n, power) = (self.constant(f64::from(n)), self.powi(a, n - 1));
                let slope = self.mul(n, power);
                self.scaled(slope, of(a), zero)
            }
            Node::Atan2(y, x) => {
                // atan2(y, x)' = (x y' − y x')/(x² + y²)
                let (left, right) = (self.scaled(x, of(y), zero), self.scaled(y, of(x), zero));
                let top = self.sub(left, right);
                if top == zero {
                    return zero;
                }
                let (xx, yy) = (self.mul(x, x), self.mul(y, y));
                let square = self.add(xx, yy);
                self.div(top, square)
            }
            Node::Where(a, b) => self.where_defined(of(a), b),
            Node::If { condition, then, other } => self.choose(condition, of(then), of(other)),
            Node::Abs { a, switch } => self.simplify(Node::Abs { a: of(a), switch }),
            Node::Min { a, b, switch } => self.simplify(Node::Min { a: of(a), b: of(b), switch }),
            Node::Max { a, b, switch } => self.simplify(Node::Max { a: of(a), b: of(b), switch }),
            Node::Table { table, order, x, switch } => {
                let slope = self.simplify(Node::Table { table, order: order.saturating_add(1), x, switch });
                self.scaled(slope, of(x), zero)
            }
            Node::Sin(a)
            | Node::Cos(a)
            | Node::Tan(a)
            | Node::Asin(a)
            | Node::Acos(a)
            | Node::Atan(a)
            | Node::Sqrt(a)
            | Node::Exp(a)
            | Node::Ln(a)
            | Node::Log10(a)
            | Node::Sinh(a)
            | Node::Cosh(a)
            | Node::Tanh(a) => {
                if of(a) == zero {
                    zero
                } else {
                    self.function_rule(id, node, of(a))
                }
            }
        }
    }

    /// slope · rate; a rate that is zero makes no product, however wild the slope.
    fn scaled(&mut self, slope: Id, rate: Id, zero: Id) -> Id {
        if rate == zero { zero } else { self.mul(slope, rate) }
    }

    fn power_rule(&mut self, id: Id, a: Id, b: Id, zero: Id, of: impl Fn(Id) -> Id) -> Id {
        let mut rate = zero;
        if of(a) != zero {
            // b aᵇ⁻¹ a'
            let one = self.constant(1.0);
            let less = self.sub(b, one);
            let power = self.pow(a, less);
            let slope = self.mul(b, power);
            rate = self.mul(slope, of(a));
        }
        if of(b) != zero {
            // aᵇ ln a b'
            let ln = self.ln(a);
            let slope = self.mul(id, ln);
            let part = self.mul(slope, of(b));
            rate = self.add(rate, part);
        }
        rate
    }

    /// Rate of a function of one operand whose rate is `rate`; `id` is the function itself.
    fn function_rule(&mut self, id: Id, node: Node, rate: Id) -> Id {
        let one = self.constant(1.0);
        match node {
            Node::Sin(a) => {
                let slope = self.cos(a);
                self.mul(slope, rate)
            }
            Node::Cos(a) => {
                let sin = self.sin(a);
                let product = self.mul(sin, rate);
                self.neg(product)
            }
            Node::Tan(_) => {
                // 1 + tan²
                let square = self.mul(id, id);
                let slope = self.add(one, square);
                self.mul(slope, rate)
            }
            Node::Asin(a) | Node::Acos(a) => {
                // ±1/√(1 − a²)
                let square = self.mul(a, a);
                let rest = self.sub(one, square);
                let root = self.sqrt(rest);
                let quotient = self.div(rate, root);
                if matches!(node, Node::Asin(_)) { quotient } else { self.neg(quotient) }
            }
            Node::Atan(a) => {
                let square = self.mul(a, a);
                let below = self.add(one, square);
                self.div(rate, below)
            }
            Node::Sqrt(_) => {
                let two = self.constant(2.0);
                let below = self.mul(two, id);
                self.div(rate, below)
            }
            Node::Exp(_) => self.mul(id, rate),
            Node::Ln(a) => self.div(rate, a),
            Node::Log10(a) => {
                let ten = self.constant(LN_10);
                let below = self.mul(ten, a);
                self.div(rate, below)
            }
            Node::Sinh(a) => {
                let slope = self.cosh(a);
                self.mul(slope, rate)
            }
            Node::Cosh(a) => {
                let slope = self.sinh(a);
                self.mul(slope, rate)
            }
            Node::Tanh(a) => {
                // 1/cosh²; 1 − tanh² would cancel where the slope is small
                let cosh = self.cosh(a);
                let below = self.mul(cosh, cosh);
                self.div(rate, below)
            }
            _ => rate,
        }
    }
}

#[cfg(test)]
#[path = "rate_tests.rs"]
mod tests;
