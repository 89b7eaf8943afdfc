//! Hash-consed expression nodes: the same expression is the same [`Id`], and has the same switches.
//!
//! Operands always stand before the nodes that use them, so ascending order of ids is an order of evaluation.

use super::external::{By, ExternalFunction};
pub(super) use super::id::Id;
use super::switch::{Compare, Switch, Test};
use std::collections::{BinaryHeap, HashMap};
use std::sync::Arc;

/// What a node computes. Conditions have the value 1 (true) or 0.
///
/// A value that is not finite is undefined, and so is every node that it is an operand of, operands of its switch included; an `If`
/// depends on its condition and on the value that it takes alone.
///
/// A node with a switch selects by the switch's mode, never by its operands: the rate of `min(a, b)` is a `Min` of the
/// rates of a and b with the switch of a and b.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A number, by its bits ([`Pool::constant_value`]).
    Const(u64),
    /// Parameter i.
    Parameter(u32),
    /// Input i.
    Input(u32),
    /// −a
    Neg(Id),
    /// a + b
    Add(Id, Id),
    /// a − b
    Sub(Id, Id),
    /// a b
    Mul(Id, Id),
    /// a / b
    Div(Id, Id),
    /// aᵇ
    Pow(Id, Id),
    /// aⁿ
    Powi(Id, i32),
    /// sin a
    Sin(Id),
    /// cos a
    Cos(Id),
    /// tan a
    Tan(Id),
    /// asin a
    Asin(Id),
    /// acos a
    Acos(Id),
    /// atan a
    Atan(Id),
    /// Angle of the point (x, y) = (b, a).
    Atan2(Id, Id),
    /// √a
    Sqrt(Id),
    /// eᵃ
    Exp(Id),
    /// ln a
    Ln(Id),
    /// Logarithm to the base 10.
    Log10(Id),
    /// sinh a
    Sinh(Id),
    /// cosh a
    Cosh(Id),
    /// tanh a
    Tanh(Id),
    /// Whether the comparison holds in the mode of `switch`.
    Compare {
        /// One of `Less`, `LessEqual`, `Equal`, `NotEqual`.
        op: Compare,
        /// Its switch, which names the operands.
        switch: u32,
    },
    /// Both conditions.
    And(Id, Id),
    /// One of the conditions.
    Or(Id, Id),
    /// The condition is false.
    Not(Id),
    /// Selects by a condition; the value not taken may be undefined.
    If {
        /// 0 or 1.
        condition: Id,
        /// Value if 1.
        then: Id,
        /// Value if 0.
        other: Id,
    },
    /// a times the mode (−1, 0, 1) of `switch`.
    Abs {
        /// The operand.
        a: Id,
        /// A [`Test::Sign`].
        switch: u32,
    },
    /// The mode of `switch`.
    Sign {
        /// A [`Test::Sign`].
        switch: u32,
    },
    /// The largest whole number that is not above a: the mode of `switch`, not a number where that is `OUTSIDE`.
    Floor {
        /// The operand.
        a: Id,
        /// A [`Test::Whole`].
        switch: u32,
    },
    /// a in mode 1, b in mode 0.
    Min {
        /// First operand.
        a: Id,
        /// Second operand.
        b: Id,
        /// A [`Test::Order`].
        switch: u32,
    },
    /// b in mode 1, a in mode 0.
    Max {
        /// First operand.
        a: Id,
        /// Second operand.
        b: Id,
        /// A [`Test::Order`].
        switch: u32,
    },
    /// Derivative of order `order` of a table at x, in the segment that is the mode of `switch`.
    Table {
        /// Number of the table.
        table: u32,
        /// 0 for the value.
        order: u8,
        /// Argument.
        x: Id,
        /// A [`Test::Segment`].
        switch: u32,
    },
    /// a where b is defined.
    Where(Id, Id),
    /// An argument of a call, where those before it are defined.
    Argument {
        /// The argument.
        value: Id,
        /// The one before it.
        before: Option<Id>,
    },
    /// An external function, or a derivative of it.
    Call {
        /// Number of the function.
        function: u32,
        /// By which arguments it is differentiated.
        by: By,
        /// Its last argument.
        last: Id,
    },
}

impl Node {
    /// The switch of a node that has one.
    #[must_use]
    pub fn switch(self) -> Option<u32> {
        match self {
            Self::Compare { switch, .. }
            | Self::Abs { switch, .. }
            | Self::Sign { switch }
            | Self::Floor { switch, .. }
            | Self::Min { switch, .. }
            | Self::Max { switch, .. }
            | Self::Table { switch, .. } => Some(switch),
            _ => None,
        }
    }

    /// The same node with operands replaced by `f`; its switch stays.
    pub(super) fn map(self, mut f: impl FnMut(Id) -> Id) -> Self {
        match self {
            Self::Const(_) | Self::Parameter(_) | Self::Input(_) | Self::Compare { .. } | Self::Sign { .. } => self,
            Self::Neg(a) => Self::Neg(f(a)),
            Self::Add(a, b) => Self::Add(f(a), f(b)),
            Self::Sub(a, b) => Self::Sub(f(a), f(b)),
            Self::Mul(a, b) => Self::Mul(f(a), f(b)),
            Self::Div(a, b) => Self::Div(f(a), f(b)),
            Self::Pow(a, b) => Self::Pow(f(a), f(b)),
            Self::Powi(a, n) => Self::Powi(f(a), n),
            Self::Sin(a) => Self::Sin(f(a)),
            Self::Cos(a) => Self::Cos(f(a)),
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
            Self::And(a, b) => Self::And(f(a), f(b)),
            Self::Or(a, b) => Self::Or(f(a), f(b)),
            Self::Where(a, b) => Self::Where(f(a), f(b)),
            Self::Not(a) => Self::Not(f(a)),
            Self::If { condition, then, other } => Self::If { condition: f(condition), then: f(then), other: f(other) },
            Self::Abs { a, switch } => Self::Abs { a: f(a), switch },
            Self::Floor { a, switch } => Self::Floor { a: f(a), switch },
            Self::Min { a, b, switch } => Self::Min { a: f(a), b: f(b), switch },
            Self::Max { a, b, switch } => Self::Max { a: f(a), b: f(b), switch },
            Self::Table { table, order, x, switch } => Self::Table { table, order, x: f(x), switch },
            Self::Argument { value, before } => Self::Argument { value: f(value), before: before.map(f) },
            Self::Call { function, by, last } => Self::Call { function, by, last: f(last) },
        }
    }
}

/// A store of expressions.
#[derive(Clone, Debug, Default)]
pub struct Pool {
    pub(super) nodes: Vec<Node>,
    pub(super) index: HashMap<Node, Id>,
    /// Whether a node is finite wherever its leaves are; then zero times it is zero.
    pub(super) tame: Vec<bool>,
    /// Whether a node is 0 or 1 whatever its leaves.
    pub(super) conditions: Vec<bool>,
    pub(super) switches: Vec<Switch>,
    pub(super) switch_index: HashMap<Test, u32>,
    /// Inputs that are numbers known beforehand.
    pub(super) given: Vec<(u32, f64)>,
    /// Functions that calls name by their numbers.
    pub(super) externals: Arc<[ExternalFunction]>,
}

impl Pool {
    /// An empty pool.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// What a node computes.
    #[must_use]
    pub fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    /// All nodes, in the order of their ids.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are no nodes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The value of a constant node.
    #[must_use]
    pub fn constant_value(&self, id: Id) -> Option<f64> {
        match self.node(id) {
            Node::Const(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Makes an input a number: values and programs see it as a constant from now on.
    pub fn give(&mut self, input: u32, value: f64) {
        self.given.retain(|(known, _)| *known != input);
        self.given.push((input, value));
    }

    /// The number that an input was given.
    pub(super) fn given(&self, input: u32) -> Option<f64> {
        self.given.iter().find(|(known, _)| *known == input).map(|(_, value)| *value)
    }

    /// Every switch; a node's `switch` and a program's modes count in this list.
    #[must_use]
    pub fn switches(&self) -> &[Switch] {
        &self.switches
    }

    /// Whether the value is a condition: 0 or 1 whatever its leaves.
    #[must_use]
    pub fn is_condition(&self, id: Id) -> bool {
        self.conditions[id.index()]
    }

    /// The nodes that a node is computed from, those of its switch included.
    pub(super) fn operands(&self, id: Id, mut f: impl FnMut(Id)) {
        let node = self.node(id);
        let _ = node.map(|operand| {
            f(operand);
            operand
        });
        if let Some(switch) = node.switch() {
            let _ = self.switches[switch as usize].test.map(f);
        }
    }

    /// Everything that `ids` are computed from, themselves included, in order of evaluation.
    #[must_use]
    pub fn reach(&self, ids: &[Id]) -> Vec<Id> {
        // operands have smaller ids: downwards from the largest, what is met more than once comes in a row
        let mut left: BinaryHeap<Id> = ids.iter().copied().collect();
        let mut all = Vec::new();
        while let Some(id) = left.pop() {
            if all.last() != Some(&id) {
                self.operands(id, |operand| left.push(operand));
                all.push(id);
            }
        }
        all.reverse();
        all
    }

    fn leaves(&self, ids: &[Id], pick: impl Fn(Node) -> Option<u32>) -> Vec<u32> {
        let mut all: Vec<u32> = self.reach(ids).into_iter().filter_map(|id| pick(self.node(id))).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Inputs that the nodes depend on, ascending.
    #[must_use]
    pub fn inputs_of(&self, ids: &[Id]) -> Vec<u32> {
        self.leaves(ids, |node| if let Node::Input(i) = node { Some(i) } else { None })
    }

    /// Parameters that the nodes depend on, ascending.
    #[must_use]
    pub fn parameters_of(&self, ids: &[Id]) -> Vec<u32> {
        self.leaves(ids, |node| if let Node::Parameter(i) = node { Some(i) } else { None })
    }

    /// Switches that the nodes depend on, ascending.
    #[must_use]
    pub fn switches_of(&self, ids: &[Id]) -> Vec<u32> {
        self.leaves(ids, Node::switch)
    }

    /// Tables that the nodes depend on, ascending.
    #[must_use]
    pub fn tables_of(&self, ids: &[Id]) -> Vec<u32> {
        self.leaves(ids, |node| if let Node::Table { table, .. } = node { Some(table) } else { None })
    }
}

#[cfg(test)]
#[path = "pool_tests.rs"]
mod tests;
