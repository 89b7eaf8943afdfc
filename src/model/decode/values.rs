//! Parameters and tables, and the drafts of values that may need one another in any order.

use super::decoder::{Decoder, Origin};
use super::order::{in_words, order};
use super::written::unit_of;
use crate::expression::{self, Dimension, Expr, Kind, Lowered};
use crate::model::entities::{Between, Beyond, Parameter, Table};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, Shape, Size};
use crate::model::keys::{Words, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::needs::Needs;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use serde_yaml::Value;
use std::rc::Rc;

keys! {
    /// A table.
    pub(crate) TABLE = TableKeys "a table" [] {
        points: need Shape::List(&Shape::List(&ANY, Size::Exactly(2)), Size::AtLeast(2)), "Pairs `[x, y]`, x strictly rising.";
        between: may Shape::Word(Between::WORDS), "Interpolation.";
        beyond: may Shape::Word(Beyond::WORDS), "Continuation outside of the points.";
    }
}

impl Words for Between {
    const WORDS: &'static [&'static str] = &["linear", "cubic"];
    const ALL: &'static [Self] = &[Self::Linear, Self::Cubic];
}

impl Words for Beyond {
    const WORDS: &'static [&'static str] = &["constant", "linear", "error", "periodic"];
    const ALL: &'static [Self] = &[Self::Constant, Self::Linear, Self::Error, Self::Periodic];
}

/// A value before it is lowered.
pub(super) enum Draft<'n> {
    /// A number.
    Number(f64),
    /// A parsed expression and its text.
    Parsed(Rc<Expr>, &'n str),
    /// Something that was reported.
    Faulty,
}

impl<'n> Decoder<'n> {
    /// Parses a value; faults of syntax are reported.
    pub(super) fn draft(&mut self, node: Option<Node<'n>>, at: &At<'_, '_>) -> Draft<'n> {
        match node {
            Some(Node::Plain(Value::Number(n))) => match n.as_f64() {
                Some(x) if x.is_finite() => Draft::Number(x),
                _ => Draft::Faulty,
            },
            Some(Node::Plain(Value::String(text))) => match self.parse(text) {
                Ok(expr) => Draft::Parsed(expr, text),
                Err(error) => {
                    let origin = Origin::Value(text, 0);
                    let fault = self.fault("expression", at, format!("found {}", error.found), error.expected);
                    fault.help = error.help;
                    fault.spot = origin.spot(error.at);
                    Draft::Faulty
                }
            },
            _ => Draft::Faulty,
        }
    }

    /// Lowers a draft.
    pub(super) fn finish(&mut self, draft: &Draft<'n>, at: &At<'_, '_>, allow: Allow, local: &mut Local<'_>) -> Option<(Lowered, Needs)> {
        match draft {
            Draft::Number(x) => {
                let id = self.pool.constant(*x);
                Some((Lowered { id, dimension: Dimension::NONE, any: *x == 0.0, bare: true, boolean: false }, Needs::CONSTANT))
            }
            Draft::Parsed(expr, text) => self.lower_parsed(expr, text, Origin::Value(text, 0), at, allow, local),
            Draft::Faulty => None,
        }
    }

    pub(super) fn parameters(&mut self) {
        let section = At::ROOT.key("parameters");
        let entries = self.section("parameters");
        let drafts: Vec<Draft<'n>> = entries.iter().map(|(name, node)| self.draft(Some(*node), &section.key(*name))).collect();
        let find = |name_space: &crate::model::quantities::NameSpace<'_>, name: &str| match name_space.names.get(name) {
            Some(Entity::Parameter(i)) => Some(*i),
            _ => None,
        };
        let needs: Vec<Vec<usize>> = drafts.iter().map(|draft| needs(draft, |name| find(&self.name_space, name))).collect();
        let (order, cycles) = order(&needs);
        self.name_space.parameters = vec![None; entries.len()];
        let zero = self.pool.constant(0.0);
        let mut values = vec![zero; entries.len()];
        let mut in_cycle = vec![false; entries.len()];
        for cycle in &cycles {
            self.cycle(cycle, |i| (entries[i].0.to_owned(), "parameters"));
            cycle.iter().for_each(|i| in_cycle[*i] = true);
        }
        for i in order {
            let at = section.key(entries[i].0);
            if in_cycle[i] {
                continue;
            }
            if let Some((lowered, _)) = self.finish(&drafts[i], &at, Allow::PARAMETER, &mut Local::default()) {
                self.name_space.parameters[i] = Some(lowered.dimension);
                values[i] = lowered.id;
            }
        }
        for (i, (name, node)) in entries.iter().enumerate() {
            let place = self.place(&section.key(*name));
            let dimension = self.name_space.parameters[i].unwrap_or_default();
            let unit = node.text().and_then(unit_of);
            self.name_space.model.parameters.push(Parameter { name: (*name).to_owned(), dimension, value: values[i], unit, place });
        }
    }

    pub(super) fn cycle(&mut self, cycle: &[usize], name: impl Fn(usize) -> (String, &'static str)) {
        let Some(first) = cycle.first() else { return };
        let (entry, section) = name(*first);
        let message = in_words(cycle, |i| name(i).0);
        let at = At::ROOT.key(section);
        let expected = if section == "parameters" { "parameters" } else { "expressions" };
        let fault = self.fault("cycle", &at.key(entry.as_str()), message, format!("{expected} that do not need themselves"));
        fault.spot = Spot::Key;
        fault.help = Some("give one of them a value of its own".to_owned());
    }

    pub(super) fn tables(&mut self) {
        let section = At::ROOT.key("tables");
        for (i, (name, node)) in self.section("tables").into_iter().enumerate() {
            let at = section.key(name);
            let keys = TableKeys::of(node);
            let points_at = at.key(keys.points);
            let mut points = Vec::new();
            let mut sides: [Option<Lowered>; 2] = [None, None];
            let mut sound = true;
            for (k, item) in keys.points.items().iter().enumerate() {
                let item_at = points_at.index(k);
                let mut pair = Vec::new();
                for (side, value) in Node::Plain(item).items().iter().enumerate().take(2) {
                    let here = item_at.index(side);
                    let Some((lowered, _)) = self.any(Node::Plain(value), &here, Allow::PARAMETER, &mut Local::default()) else { continue };
                    // the first value with a unit decides; bare numbers and 0 follow it
                    match sides[side] {
                        Some(first) if !first.any && !first.bare => {
                            if let Err(found) = lowered.expect(first.dimension) {
                                let expected = format!("{}, as above", first.dimension.name());
                                let fraction = Node::Plain(value).text().and_then(expression::meant_fraction);
                                self.fault("wrong-dimension", &here, format!("found {found}"), expected).help = Some(
                                    fraction
                                        .unwrap_or_else(|| format!("give all points of a side one unit, here {}", first.dimension.si())),
                                );
                            }
                        }
                        Some(first) if !lowered.any && !lowered.bare && !first.any && lowered.dimension != first.dimension => {
                            let message = format!("found {}", lowered.dimension.name());
                            self.fault("wrong-dimension", &here, message, "a number, as above").help =
                                Some("give all points of a side their unit".to_owned());
                        }
                        Some(first) if !first.any && (lowered.any || lowered.bare) => {}
                        _ => sides[side] = Some(lowered),
                    }
                    pair.push(lowered.id);
                }
                match pair[..] {
                    [x, y] => points.push((x, y)),
                    _ => sound = false,
                }
            }
            let [x, y] = sides.map(|side| side.map_or(Dimension::NONE, |s| s.dimension));
            self.name_space.tables.push(Some((x, y)));
            let between = keys.between.word().unwrap_or(Between::Linear);
            let beyond = keys.beyond.word().unwrap_or(Beyond::Constant);
            if sound && points.len() >= 2 {
                let ids: Vec<_> = points.iter().flat_map(|(x, y)| [*x, *y]).collect();
                self.check(Rule::Table(i), &ids, &points_at);
            }
            let place = self.place(&at);
            self.name_space.model.tables.push(Table { name: name.to_owned(), points, x, y, between, beyond, place });
        }
    }
}

/// Indices of what a draft names, each once. `find` gives the index of a first name.
pub(super) fn needs(draft: &Draft<'_>, find: impl Fn(&str) -> Option<usize>) -> Vec<usize> {
    named(draft, |head, _| find(head))
}

/// The same, where `find` also learns whether the name stands inside of `rate(..)`.
pub(super) fn named(draft: &Draft<'_>, find: impl Fn(&str, bool) -> Option<usize>) -> Vec<usize> {
    let mut found = Vec::new();
    if let Draft::Parsed(expr, _) = draft {
        paths(expr, false, &mut |path, in_rate| {
            let head = path.split('.').next().unwrap_or(path);
            if let Some(i) = find(head, in_rate)
                && !found.contains(&i)
            {
                found.push(i);
            }
        });
    }
    found
}

/// Every path of an expression, as often as it stands there.
pub(super) fn paths_of(expr: &Expr) -> Vec<String> {
    let mut found = Vec::new();
    paths(expr, false, &mut |path, _| found.push(path.to_owned()));
    found
}

/// Every path of an expression, and whether a rate is taken of it. Its height is bounded by the parser.
fn paths(expr: &Expr, in_rate: bool, f: &mut impl FnMut(&str, bool)) {
    match &expr.kind {
        Kind::Number(_) | Kind::Quantity(..) => {}
        Kind::Path(path) => f(path, in_rate),
        Kind::Call(name, _, all) => all.iter().for_each(|e| paths(e, in_rate || name == "rate", f)),
        Kind::And(all) | Kind::Or(all) => all.iter().for_each(|e| paths(e, in_rate, f)),
        Kind::Negate(a) | Kind::Not(a) => paths(a, in_rate, f),
        Kind::Sum(first, rest) | Kind::Product(first, rest) => {
            paths(first, in_rate, f);
            rest.iter().for_each(|(_, e)| paths(e, in_rate, f));
        }
        Kind::Power(a, b) | Kind::Compare(_, a, b) => {
            paths(a, in_rate, f);
            paths(b, in_rate, f);
        }
    }
}
