//! Constructors of nodes, each in its simplest form. Those with a switch take the text by which messages call it.

use super::pool::{Id, Node, Pool};
use super::switch::{Compare, Switch, Test};

impl Pool {
    /// The number `x`.
    pub fn constant(&mut self, x: f64) -> Id {
        self.intern(Node::Const(if x == 0.0 { 0.0_f64 } else { x }.to_bits()))
    }

    /// Parameter `i`.
    pub fn parameter(&mut self, i: u32) -> Id {
        self.intern(Node::Parameter(i))
    }

    /// Input `i`.
    pub fn input(&mut self, i: u32) -> Id {
        self.intern(Node::Input(i))
    }

    /// −a.
    pub fn neg(&mut self, a: Id) -> Id {
        self.simplify(Node::Neg(a))
    }

    /// a + b.
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Add(a, b))
    }

    /// a − b.
    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Sub(a, b))
    }

    /// a b.
    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Mul(a, b))
    }

    /// a / b.
    pub fn div(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Div(a, b))
    }

    /// aᵇ.
    pub fn pow(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Pow(a, b))
    }

    /// aⁿ.
    pub fn powi(&mut self, a: Id, n: i32) -> Id {
        self.simplify(Node::Powi(a, n))
    }

    /// sin a.
    pub fn sin(&mut self, a: Id) -> Id {
        self.simplify(Node::Sin(a))
    }

    /// cos a.
    pub fn cos(&mut self, a: Id) -> Id {
        self.simplify(Node::Cos(a))
    }

    /// tan a.
    pub fn tan(&mut self, a: Id) -> Id {
        self.simplify(Node::Tan(a))
    }

    /// asin a.
    pub fn asin(&mut self, a: Id) -> Id {
        self.simplify(Node::Asin(a))
    }

    /// acos a.
    pub fn acos(&mut self, a: Id) -> Id {
        self.simplify(Node::Acos(a))
    }

    /// atan a.
    pub fn atan(&mut self, a: Id) -> Id {
        self.simplify(Node::Atan(a))
    }

    /// Angle of the point (`x`, `y`), in (−π, π].
    pub fn atan2(&mut self, y: Id, x: Id) -> Id {
        self.simplify(Node::Atan2(y, x))
    }

    /// √a.
    pub fn sqrt(&mut self, a: Id) -> Id {
        self.simplify(Node::Sqrt(a))
    }

    /// eᵃ.
    pub fn exp(&mut self, a: Id) -> Id {
        self.simplify(Node::Exp(a))
    }

    /// ln a.
    pub fn ln(&mut self, a: Id) -> Id {
        self.simplify(Node::Ln(a))
    }

    /// Logarithm of a to the base 10.
    pub fn log10(&mut self, a: Id) -> Id {
        self.simplify(Node::Log10(a))
    }

    /// sinh a.
    pub fn sinh(&mut self, a: Id) -> Id {
        self.simplify(Node::Sinh(a))
    }

    /// cosh a.
    pub fn cosh(&mut self, a: Id) -> Id {
        self.simplify(Node::Cosh(a))
    }

    /// tanh a.
    pub fn tanh(&mut self, a: Id) -> Id {
        self.simplify(Node::Tanh(a))
    }

    /// √(a² + b²).
    pub fn hypot(&mut self, a: Id, b: Id) -> Id {
        let (aa, bb) = (self.mul(a, a), self.mul(b, b));
        let square = self.add(aa, bb);
        self.sqrt(square)
    }

    /// The number x as a condition: x ≠ 0. Conditions stay as they are.
    pub fn condition(&mut self, x: Id, text: &str) -> Id {
        if self.is_condition(x) {
            return x;
        }
        let zero = self.constant(0.0);
        self.compare(Compare::NotEqual, x, zero, text)
    }

    /// Whether `a op b`; `text` is how messages call the switch.
    pub fn compare(&mut self, op: Compare, a: Id, b: Id, text: &str) -> Id {
        let (op, a, b) = match op {
            Compare::Greater => (Compare::Less, b, a),
            Compare::GreaterEqual => (Compare::LessEqual, b, a),
            op => (op, a, b),
        };
        let test = Test::Compare(op, a, b);
        match self.decided(test) {
            Some(mode) => self.truth(op.holds(mode)),
            None => {
                let switch = self.switch(test, text);
                self.intern(Node::Compare { op, switch })
            }
        }
    }

    /// Both conditions.
    pub fn and(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::And(a, b))
    }

    /// One of the conditions.
    pub fn or(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Or(a, b))
    }

    /// The condition is false.
    pub fn not(&mut self, a: Id) -> Id {
        self.simplify(Node::Not(a))
    }

    /// `then` if the condition is 1, else `other`, which may be undefined meanwhile.
    pub fn choose(&mut self, condition: Id, then: Id, other: Id) -> Id {
        self.simplify(Node::If { condition, then, other })
    }

    /// a where b is defined.
    pub fn where_defined(&mut self, a: Id, b: Id) -> Id {
        self.simplify(Node::Where(a, b))
    }

    /// |a|.
    pub fn abs(&mut self, a: Id, text: &str) -> Id {
        match self.number(a) {
            Some(x) => self.constant(x.abs()),
            None => {
                let switch = self.switch(Test::Sign(a), text);
                self.intern(Node::Abs { a, switch })
            }
        }
    }

    /// −1, 0 or 1.
    pub fn sign(&mut self, a: Id, text: &str) -> Id {
        match self.decided(Test::Sign(a)) {
            Some(mode) => self.constant(f64::from(mode)),
            None => {
                let switch = self.switch(Test::Sign(a), text);
                self.intern(Node::Sign { switch })
            }
        }
    }

    /// The largest whole number that is not above a.
    pub fn floor(&mut self, a: Id, text: &str) -> Id {
        match self.number(a) {
            Some(x) => self.constant(x.floor()),
            None => {
                let switch = self.switch(Test::Whole(a), text);
                self.intern(Node::Floor { a, switch })
            }
        }
    }

    /// The smallest whole number that is not below a.
    pub fn ceil(&mut self, a: Id, text: &str) -> Id {
        let down = self.neg(a);
        let below = self.floor(down, text);
        self.neg(below)
    }

    /// The whole number nearest to a; halves go up.
    pub fn round(&mut self, a: Id, text: &str) -> Id {
        let half = self.constant(0.5);
        let raised = self.add(a, half);
        self.floor(raised, text)
    }

    /// What is left of a after whole multiples of b, from 0 to b: a − b floor(a/b).
    pub fn modulo(&mut self, a: Id, b: Id, text: &str) -> Id {
        let quotient = self.div(a, b);
        let count = self.floor(quotient, text);
        let whole = self.mul(b, count);
        self.sub(a, whole)
    }

    /// The smaller one.
    pub fn min(&mut self, a: Id, b: Id, text: &str) -> Id {
        let (a, b) = (a.min(b), a.max(b));
        match self.decided(Test::Order(a, b)) {
            Some(mode) => [b, a][mode as usize & 1],
            None => {
                let switch = self.switch(Test::Order(a, b), text);
                self.simplify(Node::Min { a, b, switch })
            }
        }
    }

    /// The larger one.
    pub fn max(&mut self, a: Id, b: Id, text: &str) -> Id {
        let (a, b) = (a.min(b), a.max(b));
        match self.decided(Test::Order(a, b)) {
            Some(mode) => [a, b][mode as usize & 1],
            None => {
                let switch = self.switch(Test::Order(a, b), text);
                self.simplify(Node::Max { a, b, switch })
            }
        }
    }

    /// min(max(x, low), high).
    pub fn clamp(&mut self, x: Id, low: Id, high: Id, text: &str) -> Id {
        let raised = self.max(x, low, text);
        self.min(raised, high, text)
    }

    /// Table number `table` at x, or its derivative of order `order`.
    pub fn table(&mut self, table: u32, order: u8, x: Id, text: &str) -> Id {
        let switch = self.switch(Test::Segment { table, x }, text);
        self.intern(Node::Table { table, order, x, switch })
    }

    /// The number of the switch that tests this, new if it is the first.
    /// The sign of `a` by a switch of its own, and the number of the switch: its mode may differ from that of other signs of `a`.
    pub fn own_sign(&mut self, a: Id, text: &str) -> (Id, u32) {
        let switch = self.switches.len() as u32;
        self.switches.push(Switch { test: Test::Sign(a), text: text.to_owned() });
        (self.intern(Node::Sign { switch }), switch)
    }

    fn switch(&mut self, test: Test, text: &str) -> u32 {
        let next = self.switches.len() as u32;
        let number = *self.switch_index.entry(test).or_insert(next);
        if number == next {
            self.switches.push(Switch { test, text: text.to_owned() });
        }
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_fold() {
        let mut p = Pool::new();
        let (x, y) = (p.input(0), p.input(1));
        let (zero, one, three) = (p.constant(0.0), p.constant(1.0), p.constant(3.0));
        let c = p.compare(Compare::Less, x, y, "x < y");
        for (a, b, and, or) in
            [(c, one, c, one), (one, c, c, one), (c, zero, zero, c), (zero, c, zero, c), (c, c, c, c), (one, zero, zero, one)]
        {
            assert_eq!((p.and(a, b), p.or(a, b)), (and, or));
        }
        let not = p.not(c);
        assert_eq!((p.not(not), p.not(one)), (c, zero));
        assert_eq!((p.choose(one, x, y), p.choose(zero, x, y), p.choose(c, x, x)), (x, y, x));
        assert_eq!((p.condition(c, ""), p.condition(three, "")), (c, one));
        assert_eq!(p.compare(Compare::GreaterEqual, three, one, ""), one);
        assert_eq!((p.min(three, one, ""), p.max(three, one, ""), p.sign(three, "")), (one, three, one));
        assert_eq!(p.switches().len(), 1);
    }
}
