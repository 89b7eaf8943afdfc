//! Simplification of nodes: constants are folded and neutral operands dropped, so that rates and folded parameters leave no
//! dead arithmetic.
//!
//! No rule changes a value, not even where an operand is undefined: 0·x is 0 only if x is defined wherever its leaves are. What is
//! undefined is never folded, so that a message can still name the function and its argument.

use super::pool::{Id, Node, Pool};
use super::switch::Test;

impl Pool {
    /// The node, the same one if it was there before.
    pub(super) fn intern(&mut self, node: Node) -> Id {
        if let Some(id) = self.index.get(&node) {
            return *id;
        }
        let id = Id::at(self.nodes.len());
        self.tame.push(self.is_tame(node));
        self.conditions.push(match node {
            Node::Compare { .. } | Node::And(..) | Node::Or(..) | Node::Not(_) => true,
            Node::If { then, other, .. } => self.is_condition(then) && self.is_condition(other),
            Node::Where(a, _) => self.is_condition(a),
            Node::Const(bits) => [0.0, 1.0].contains(&f64::from_bits(bits)),
            _ => false,
        });
        self.nodes.push(node);
        self.index.insert(node, id);
        id
    }

    fn is_tame(&self, node: Node) -> bool {
        let mut tame = match node {
            Node::Const(bits) => f64::from_bits(bits).is_finite(),
            Node::Powi(_, n) => n >= 0,
            Node::Div(..) | Node::Pow(..) | Node::Tan(_) | Node::Asin(_) | Node::Acos(_) => false,
            Node::Sqrt(_) | Node::Exp(_) | Node::Ln(_) | Node::Table { .. } | Node::Call { .. } => false,
            Node::Log10(_) | Node::Sinh(_) | Node::Cosh(_) | Node::Floor { .. } => false,
            _ => true,
        };
        let _ = node.map(|operand| {
            tame &= self.tame[operand.index()];
            operand
        });
        if let Some(switch) = node.switch() {
            let _ = self.switches[switch as usize].test.map(|operand| tame &= self.tame[operand.index()]);
        }
        tame
    }

    /// The value of a constant node that is defined.
    pub(super) fn number(&self, id: Id) -> Option<f64> {
        self.constant_value(id).filter(|x| x.is_finite())
    }

    pub(super) fn truth(&mut self, truth: bool) -> Id {
        self.constant(f64::from(u8::from(truth)))
    }

    /// The mode of a test whose operands are numbers; tables are not known here.
    pub(super) fn decided(&self, test: Test) -> Option<i32> {
        if matches!(test, Test::Segment { .. }) {
            return None;
        }
        let mut known = true;
        let values = test.map(|id| {
            let value = self.number(id);
            known &= value.is_some();
            value.unwrap_or(0.0)
        });
        known.then(|| values.mode(|x| x, &[]))
    }

    /// The node in its simplest form; its switch, if any, is numbered already.
    pub(super) fn simplify(&mut self, node: Node) -> Id {
        if let Some(x) = self.folded(node) {
            return self.constant(x);
        }
        match node {
            Node::Neg(a) => match self.node(a) {
                Node::Neg(x) => x,
                Node::Sub(x, y) => self.sub(y, x),
                _ => self.intern(node),
            },
            Node::Add(a, b) => self.simple_sum(a, b),
            Node::Sub(a, b) => self.simple_difference(a, b),
            Node::Mul(a, b) => self.simple_product(a, b),
            Node::Div(a, b) => self.simple_quotient(a, b),
            Node::Pow(a, b) => match self.number(b) {
                Some(0.5) => self.sqrt(a),
                Some(n) if n.fract() == 0.0 && n.abs() <= 1000.0 => self.powi(a, n as i32),
                _ => self.intern(node),
            },
            Node::Powi(a, n) => match n {
                0 => {
                    let one = self.constant(1.0);
                    self.where_defined(one, a)
                }
                1 => a,
                2 => self.mul(a, a),
                -1 => {
                    let one = self.constant(1.0);
                    self.div(one, a)
                }
                _ => self.intern(node),
            },
            Node::And(a, b) => match (self.number(a), self.number(b)) {
                (Some(0.0), _) => self.truth_where(false, b),
                (_, Some(0.0)) => self.truth_where(false, a),
                (Some(_), _) => b,
                (_, Some(_)) => a,
                _ if a == b => a,
                _ => self.intern(Node::And(a.min(b), a.max(b))),
            },
            Node::Or(a, b) => match (self.number(a), self.number(b)) {
                (Some(0.0), _) => b,
                (_, Some(0.0)) => a,
                (Some(_), _) => self.truth_where(true, b),
                (_, Some(_)) => self.truth_where(true, a),
                _ if a == b => a,
                _ => self.intern(Node::Or(a.min(b), a.max(b))),
            },
            Node::Not(a) => match self.node(a) {
                Node::Not(x) => x,
                _ => self.intern(node),
            },
            Node::If { condition, then, other } => match self.number(condition) {
                Some(c) if c != 0.0 => then,
                Some(_) => other,
                None if then == other => self.where_defined(then, condition),
                None => self.intern(node),
            },
            Node::Where(a, b) if a == b || self.tame[b.index()] || matches!(self.node(a), Node::Where(_, c) if c == b) => a,
            Node::Compare { op, switch } => match self.decided(self.switches[switch as usize].test) {
                Some(mode) => self.truth(op.holds(mode)),
                None => self.intern(node),
            },
            Node::Sign { switch } => match self.decided(self.switches[switch as usize].test) {
                Some(mode) => self.constant(f64::from(mode)),
                None => self.intern(node),
            },
            Node::Floor { a, .. } => match self.number(a) {
                Some(x) => self.constant(x.floor()),
                None => self.intern(node),
            },
            Node::Abs { a, switch } => match self.decided(self.switches[switch as usize].test) {
                Some(mode) => {
                    let mode = self.constant(f64::from(mode));
                    self.mul(a, mode)
                }
                None if self.constant_value(a) == Some(0.0) => self.where_tested(a, switch),
                None => self.intern(node),
            },
            Node::Min { a, b, switch } => self.selected([b, a], switch, node),
            Node::Max { a, b, switch } => self.selected([a, b], switch, node),
            _ => self.intern(node),
        }
    }

    /// One of `[mode 0, mode 1]` if they are equal or the mode is known.
    fn selected(&mut self, choice: [Id; 2], switch: u32, node: Node) -> Id {
        match self.decided(self.switches[switch as usize].test) {
            Some(mode) => choice[mode as usize & 1],
            None if choice[0] == choice[1] => self.where_tested(choice[0], switch),
            None => self.intern(node),
        }
    }

    fn truth_where(&mut self, truth: bool, defined: Id) -> Id {
        let truth = self.truth(truth);
        self.where_defined(truth, defined)
    }

    /// A node where all that its switch compares is defined.
    fn where_tested(&mut self, mut a: Id, switch: u32) -> Id {
        let mut tested = Vec::new();
        let _ = self.switches[switch as usize].test.map(|operand| tested.push(operand));
        for operand in tested {
            a = self.where_defined(a, operand);
        }
        a
    }

    fn simple_sum(&mut self, a: Id, b: Id) -> Id {
        match (self.node(a), self.node(b)) {
            (_, Node::Neg(y)) => self.sub(a, y),
            (Node::Neg(x), _) => self.sub(b, x),
            _ if self.constant_value(a) == Some(0.0) => b,
            _ if self.constant_value(b) == Some(0.0) => a,
            // exact in floating point, so both orders may share a node
            _ => self.intern(Node::Add(a.min(b), a.max(b))),
        }
    }

    fn simple_difference(&mut self, a: Id, b: Id) -> Id {
        match self.node(b) {
            Node::Neg(y) => self.add(a, y),
            _ if self.constant_value(b) == Some(0.0) => a,
            _ if self.constant_value(a) == Some(0.0) => self.neg(b),
            _ if a == b && self.tame[a.index()] => self.constant(0.0),
            _ => self.intern(Node::Sub(a, b)),
        }
    }

    fn simple_product(&mut self, a: Id, b: Id) -> Id {
        let (a, b) = (a.min(b), a.max(b));
        for (k, x) in [(a, b), (b, a)] {
            match self.constant_value(k) {
                Some(1.0) => return x,
                Some(-1.0) => return self.neg(x),
                Some(0.0) if self.tame[x.index()] => return k,
                Some(c) => {
                    if let Node::Neg(y) = self.node(x) {
                        let c = self.constant(-c);
                        return self.mul(c, y);
                    }
                }
                None => {}
            }
        }
        match (self.node(a), self.node(b)) {
            (Node::Neg(x), Node::Neg(y)) => self.mul(x, y),
            (Node::Neg(x), _) => {
                let product = self.mul(x, b);
                self.neg(product)
            }
            (_, Node::Neg(y)) => {
                let product = self.mul(a, y);
                self.neg(product)
            }
            _ => self.intern(Node::Mul(a, b)),
        }
    }

    fn simple_quotient(&mut self, a: Id, b: Id) -> Id {
        match (self.node(a), self.node(b)) {
            (Node::Neg(x), Node::Neg(y)) => self.div(x, y),
            _ if self.constant_value(b) == Some(1.0) => a,
            _ if self.constant_value(b) == Some(-1.0) => self.neg(a),
            (Node::Neg(x), _) if self.constant_value(b).is_none() => {
                let quotient = self.div(x, b);
                self.neg(quotient)
            }
            _ if self.constant_value(a) == Some(0.0) && self.constant_value(b).is_some_and(|b| b != 0.0 && !b.is_nan()) => a,
            _ => self.intern(Node::Div(a, b)),
        }
    }

    /// The value of a node without switch all of whose operands are numbers, if it is defined.
    fn folded(&self, node: Node) -> Option<f64> {
        // a call finds its arguments by their nodes
        let leaf = matches!(node, Node::Const(_) | Node::Parameter(_) | Node::Input(_) | Node::Argument { .. });
        if leaf || node.switch().is_some() {
            return None;
        }
        let mut known = true;
        let _ = node.map(|operand| {
            known &= self.number(operand).is_some();
            operand
        });
        let value = known.then(|| self.node_value(node, &|id| self.number(id).unwrap_or(f64::NAN), &|_| 0, &[], &[]));
        value.filter(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_operands_vanish() {
        let mut p = Pool::new();
        let (x, y) = (p.input(0), p.input(1));
        let (zero, one, minus) = (p.constant(0.0), p.constant(1.0), p.constant(-1.0));
        assert_eq!(p.constant(-0.0), zero);
        assert_eq!((p.add(x, zero), p.sub(x, zero), p.mul(one, x), p.div(x, one)), (x, x, x, x));
        assert_eq!(p.mul(x, zero), zero);
        let negative = p.neg(x);
        assert_eq!((p.neg(negative), p.mul(x, minus), p.sub(zero, x)), (x, negative, negative));
        let (sum, difference) = (p.add(x, y), p.sub(y, x));
        assert_eq!((p.add(y, x), p.add(y, negative)), (sum, difference));
        assert_eq!(p.sub(x, x), zero);
        assert_eq!((p.powi(x, 1), p.powi(x, 0)), (x, one));
        let two = p.constant(2.0);
        let (square, power) = (p.mul(x, x), p.pow(x, two));
        assert_eq!(square, power);
    }

    #[test]
    fn what_may_be_undefined_is_not_dropped() {
        let mut p = Pool::new();
        let x = p.input(0);
        let zero = p.constant(0.0);
        let wild = p.ln(x);
        assert_ne!(p.mul(zero, wild), zero);
        assert_ne!(p.sub(wild, wild), zero);
        assert_ne!(p.div(zero, x), zero);
    }
}
