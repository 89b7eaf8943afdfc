//! Plain values of nodes, and the order in which parameters are found.

use super::pool::{Id, Node, Pool};
use super::table::LookupTable;

impl Pool {
    /// The value of a node that depends on parameters and constants only; not a number where it needs an input or a table.
    #[must_use]
    pub fn value(&self, id: Id, parameters: &[f64]) -> f64 {
        if let Node::Const(bits) = self.node(id) {
            return f64::from_bits(bits);
        }
        self.values(&[id], parameters)[0]
    }

    /// The values of nodes that depend on parameters and constants only; not a number where one needs an input or a table.
    #[must_use]
    pub fn values(&self, ids: &[Id], parameters: &[f64]) -> Vec<f64> {
        self.values_with_tables(ids, parameters, &[])
    }

    /// As [`Self::values`], with tables.
    #[must_use]
    pub fn values_with_tables(&self, ids: &[Id], parameters: &[f64], tables: &[LookupTable]) -> Vec<f64> {
        let order = self.reach(ids);
        let place = |id: &Id| order.binary_search(id).ok();
        let mut values = vec![f64::NAN; order.len()];
        for (at, id) in order.iter().enumerate() {
            let value = |id: Id| place(&id).map_or(f64::NAN, |at| values[at]);
            let mode = |switch: u32| self.switches[switch as usize].test.mode(value, tables);
            values[at] = self.node_value(self.node(*id), &value, &mode, parameters, tables);
        }
        ids.iter().map(|id| place(id).map_or(f64::NAN, |at| values[at])).collect()
    }

    /// The value of a node from the values of its operands and the modes of switches; undefined as its operands are.
    pub(super) fn node_value(
        &self,
        node: Node,
        value: &dyn Fn(Id) -> f64,
        mode: &dyn Fn(u32) -> i32,
        parameters: &[f64],
        tables: &[LookupTable],
    ) -> f64 {
        let truth = |truth: bool| f64::from(u8::from(truth));
        let result = match node {
            Node::Const(bits) => f64::from_bits(bits),
            Node::Parameter(i) => parameters.get(i as usize).copied().unwrap_or(f64::NAN),
            Node::Input(i) => self.given(i).unwrap_or(f64::NAN),
            Node::Neg(a) => -value(a),
            Node::Add(a, b) => value(a) + value(b),
            Node::Sub(a, b) => value(a) - value(b),
            Node::Mul(a, b) => value(a) * value(b),
            Node::Div(a, b) => value(a) / value(b),
            Node::Pow(a, b) => power(value(a), value(b)),
            Node::Powi(a, n) => value(a).powi(n),
            // both from one call, as programs do it, so that the last digit agrees
            Node::Sin(a) => value(a).sin_cos().0,
            Node::Cos(a) => value(a).sin_cos().1,
            Node::Tan(a) => value(a).tan(),
            Node::Asin(a) => value(a).asin(),
            Node::Acos(a) => value(a).acos(),
            Node::Atan(a) => value(a).atan(),
            // −0 is 0 here: a product whose sign nobody sees does not choose between 0 and a half turn
            Node::Atan2(a, b) => (value(a) + 0.0).atan2(value(b) + 0.0),
            Node::Sqrt(a) => value(a).sqrt(),
            Node::Exp(a) => value(a).exp(),
            Node::Ln(a) => value(a).ln(),
            Node::Log10(a) => value(a).log10(),
            Node::Sinh(a) => value(a).sinh(),
            Node::Cosh(a) => value(a).cosh(),
            Node::Tanh(a) => value(a).tanh(),
            Node::Compare { op, switch } => truth(op.holds(mode(switch))),
            Node::And(a, b) => truth(value(a) != 0.0 && value(b) != 0.0),
            Node::Or(a, b) => truth(value(a) != 0.0 || value(b) != 0.0),
            Node::Not(a) => truth(value(a) == 0.0),
            Node::If { condition, then, other } => value(if value(condition) != 0.0 { then } else { other }),
            Node::Abs { a, switch } => value(a) * f64::from(mode(switch)),
            Node::Sign { switch } => f64::from(mode(switch)),
            Node::Floor { a, .. } => value(a).floor(),
            Node::Min { a, b, switch } => value(if mode(switch) != 0 { a } else { b }),
            Node::Max { a, b, switch } => value(if mode(switch) != 0 { b } else { a }),
            Node::Table { table, order, x, switch } => {
                tables.get(table as usize).map_or(f64::NAN, |t| t.eval(value(x), mode(switch), order))
            }
            Node::Where(a, _) | Node::Argument { value: a, .. } => value(a),
            Node::Call { function, by, last } => {
                let arguments: Vec<f64> = self.arguments(last).into_iter().map(value).collect();
                let defined = arguments.iter().all(|x| x.is_finite());
                self.externals.get(function as usize).filter(|_| defined).map_or(f64::NAN, |f| f.value(&arguments, by))
            }
        };
        if self.all_defined(node, value) { result } else { f64::NAN }
    }

    /// Whether all is defined that the value of a node depends on.
    pub(super) fn all_defined(&self, node: Node, value: &dyn Fn(Id) -> f64) -> bool {
        let mut defined = true;
        let mut look = |id: Id| defined &= value(id).is_finite();
        match node {
            // of the values to choose from only the one that is chosen counts
            Node::If { condition, .. } => look(condition),
            Node::Min { .. } | Node::Max { .. } => {}
            _ => {
                let _ = node.map(|operand| {
                    look(operand);
                    operand
                });
            }
        }
        if let Some(switch) = node.switch() {
            let _ = self.switches[switch as usize].test.map(look);
        }
        defined
    }

    /// An order in which parameters, whose values are expressions of one another, can be found.
    ///
    /// # Errors
    /// A cycle: each parameter in it needs the next, the last one the first.
    pub fn order_parameters(&self, values: &[Id]) -> Result<Vec<usize>, Vec<usize>> {
        let needs: Vec<Vec<u32>> = values.iter().map(|id| self.parameters_of(&[*id])).collect();
        let (mut order, mut visited) = (Vec::with_capacity(values.len()), vec![false; values.len()]);
        // depth-first with an explicit path, for chains of any length: parameter, how many of its needs are done
        let mut path: Vec<(usize, usize)> = Vec::new();
        let mut on_path = vec![false; values.len()];
        for root in 0..values.len() {
            if visited[root] {
                continue;
            }
            path.push((root, 0));
            visited[root] = true;
            on_path[root] = true;
            while let Some((parameter, done)) = path.last_mut() {
                let parameter = *parameter;
                let Some(need) = needs[parameter].get(*done).map(|need| *need as usize) else {
                    order.push(parameter);
                    on_path[parameter] = false;
                    path.pop();
                    continue;
                };
                *done += 1;
                if on_path.get(need) == Some(&true) {
                    return Err(path.iter().map(|(p, _)| *p).skip_while(|p| *p != need).collect());
                }
                if visited.get(need) == Some(&false) {
                    visited[need] = true;
                    on_path[need] = true;
                    path.push((need, 0));
                }
            }
        }
        Ok(order)
    }

    /// The values of all parameters; not a number for those that a cycle leaves without one.
    #[must_use]
    pub fn resolve_parameters(&self, values: &[Id]) -> Vec<f64> {
        let mut found = vec![f64::NAN; values.len()];
        for i in self.order_parameters(values).unwrap_or_default() {
            found[i] = self.value(values[i], &found);
        }
        found
    }
}

/// aⁿ as the pool writes it where n is a number.
fn power(a: f64, n: f64) -> f64 {
    match n {
        2.0 => a * a,
        -1.0 => 1.0 / a,
        0.5 => a.sqrt(),
        n if n.fract() == 0.0 && n.abs() <= 1000.0 => a.powi(n as i32),
        _ => a.powf(n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_found_in_the_order_of_their_needs() {
        let mut p = Pool::new();
        let (b, c) = (p.parameter(1), p.parameter(2));
        let two = p.constant(2.0);
        let values = [p.add(b, c), p.mul(c, two), p.constant(5.0)];
        let order = p.order_parameters(&values).unwrap();
        let place = |i: usize| order.iter().position(|o| *o == i).unwrap();
        assert!(place(2) < place(1) && place(1) < place(0));
        assert_eq!(p.resolve_parameters(&values), [15.0, 10.0, 5.0]);
    }

    #[test]
    fn a_cycle_is_named_in_its_order() {
        let mut p = Pool::new();
        let ids: Vec<Id> = (0..4).map(|i| p.parameter(i)).collect();
        // 0 needs 1, 1 needs 3, 3 needs 1
        let values = [ids[1], ids[3], p.constant(1.0), p.neg(ids[1])];
        assert_eq!(p.order_parameters(&values), Err(vec![1, 3]));
        assert_eq!(p.order_parameters(&[ids[0]]), Err(vec![0]));
        assert!(p.resolve_parameters(&values).iter().all(|x| x.is_nan()));
    }

    #[test]
    fn a_long_chain_of_parameters_needs_no_stack() {
        let mut p = Pool::new();
        let one = p.constant(1.0);
        let n = 2000;
        let values: Vec<Id> = (0..n)
            .map(|i| {
                let next = p.parameter(i + 1);
                if i + 1 == n { one } else { p.add(next, one) }
            })
            .collect();
        assert_eq!(p.resolve_parameters(&values)[0], f64::from(n));
    }

    #[test]
    fn missing_leaves_are_not_a_number() {
        let mut p = Pool::new();
        let ids = [p.input(0), p.parameter(7)];
        assert!(p.values(&ids, &[1.0]).iter().all(|x| x.is_nan()));
    }
}
