//! Measures, first-order states, stretches of springs and couplings that are expressions: they may name one another in any order.
//!
//! A state is a leaf: naming it needs nothing, so that its own rate may name it. `rate(..)` of a state is its rate
//! expression, which must be known first. So that there is always an order, the rate of a state may not need the rate of
//! any state.

use super::decoder::Decoder;
use super::order::order;
use super::springs::SpringKeys;
use super::values::{Draft, named, needs};
use crate::expression::{Dimension, Symbol};
use crate::model::entities::{FirstOrder, Measure, SpringOn};
use crate::model::fault::At;
use crate::model::fields::{ANY, Shape};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::vocabulary::Known;
use serde_yaml::Value;

/// The rate of a state may use what a load may.
const RATE: Allow = Allow { what: "the rate of a state", ..Allow::LOAD };

/// Entries that may need one another, in this order: measures, stretches of springs, couplings that stay 0, rates of states.
struct Entries<'n> {
    measures: Vec<(&'n str, Node<'n>)>,
    /// Springs with a `stretch` that is an expression: index in the file, name, and where it stands.
    stretched: Vec<(usize, &'n str, Entry<'n>)>,
    /// Couplings by an expression: index in the file, and name.
    zeros: Vec<(usize, &'n str)>,
    states: Vec<(&'n str, Node<'n>)>,
    drafts: Vec<Draft<'n>>,
}

impl<'n> Entries<'n> {
    /// Number of the rate of the first state.
    fn rates(&self) -> usize {
        self.first_zero() + self.zeros.len()
    }

    /// Number of the first coupling.
    fn first_zero(&self) -> usize {
        self.measures.len() + self.stretched.len()
    }

    /// The number that a name needs; naming a state needs nothing.
    fn find(&self, entity: Entity) -> Option<usize> {
        match entity {
            Entity::Measure(i) => Some(i),
            Entity::Spring(i) => self.stretched.iter().position(|(s, ..)| *s == i).map(|k| self.measures.len() + k),
            Entity::Coupling(i) => self.zeros.iter().position(|(c, _)| *c == i).map(|k| self.first_zero() + k),
            _ => None,
        }
    }

    /// Name and section of an entry.
    fn name(&self, i: usize) -> (&'n str, &'static str) {
        let behind = |first: usize| i.checked_sub(first);
        match (behind(self.measures.len()), behind(self.first_zero()), behind(self.rates())) {
            (.., Some(k)) => (self.states[k].0, "states"),
            (_, Some(k), _) => (self.zeros[k].1, "couplings"),
            (Some(k), ..) => (self.stretched[k].1, "springs"),
            _ => (self.measures[i].0, "measures"),
        }
    }
}

keys! {
    /// A state.
    pub(crate) STATE = StateKeys "a state" [] {
        rate: need Shape::Formula("an expression of positions, velocities, t and states"), "Time rate of the state, which it may name.";
        start: may ANY, "Value at t = 0, 0 if omitted; its unit is that of the state.";
    }
}

impl<'n> Decoder<'n> {
    /// Enters states, so that everything may name them; their rates are filled in with the measures.
    ///
    /// The dimension must be known before the rate, which may name the state: it is that of `start`.
    pub(super) fn states_by_name(&mut self) {
        let section = At::ROOT.key("states");
        for (name, node) in self.section("states") {
            let at = section.key(name);
            let keys = StateKeys::of(node);
            let here = at.key(keys.start);
            let zero = self.pool.constant(0.0);
            let (start, dimension) = match keys.start.node {
                None => (zero, Some(Dimension::NONE)),
                Some(start) => {
                    let allow = Allow { what: "the start of a state", ..Allow::CONSTANT };
                    match self.any(start, &here, allow, &mut Local::default()) {
                        Some((lowered, _)) => {
                            self.check(Rule::Finite, &[lowered.id], &here);
                            (lowered.id, Some(lowered.dimension))
                        }
                        None => (zero, None),
                    }
                }
            };
            self.name_space.states.push(dimension);
            self.name_space.rates.push(None);
            let (dimension, place) = (dimension.unwrap_or_default(), self.place(&at));
            self.name_space.model.states.push(FirstOrder { name: name.to_owned(), dimension, start, rate: zero, place });
        }
    }

    pub(super) fn measures(&mut self) {
        let entries = self.entries();
        self.name_space.measures = vec![None; entries.measures.len()];
        for i in self.arranged(&entries) {
            if i < entries.measures.len() {
                self.measure(&entries, i);
            } else if i < entries.first_zero() {
                self.stretch(&entries, i);
            } else if i < entries.rates() {
                let (file, name) = entries.zeros[i - entries.first_zero()];
                self.zero(file, name, &entries.drafts[i]);
            } else {
                self.state_rate(&entries, i - entries.rates());
            }
        }
        let section = At::ROOT.key("measures");
        for (i, (name, _)) in entries.measures.iter().enumerate() {
            if let Some((symbol, _)) = self.name_space.measures[i] {
                let (name, place) = ((*name).to_owned(), self.place(&section.key(*name)));
                self.name_space.model.measures.push(Measure { name, dimension: symbol.dimension, value: symbol.id, place });
            }
        }
    }

    fn entries(&mut self) -> Entries<'n> {
        let (measures, states) = (self.section("measures"), self.section("states"));
        let sections = ["measures", "springs", "states", "couplings"].map(|key| At::ROOT.key(key));
        let mut drafts: Vec<Draft<'n>> = measures.iter().map(|(name, node)| self.draft(Some(*node), &sections[0].key(*name))).collect();
        let mut stretched = Vec::new();
        for (i, (name, node)) in self.section("springs").into_iter().enumerate() {
            let stretch = SpringKeys::of(node).stretch;
            if stretch.given() {
                drafts.push(self.draft(stretch.node, &sections[1].key(name).key(stretch)));
                stretched.push((i, name, stretch));
            }
        }
        let mut zeros = Vec::new();
        for (i, (name, node)) in self.section("couplings").into_iter().enumerate() {
            if let Some(zero) = node.get("zero") {
                drafts.push(self.draft(Some(zero), &sections[3].key(name).key("zero")));
                zeros.push((i, name));
            }
        }
        for (name, node) in &states {
            let rate = StateKeys::of(*node).rate;
            drafts.push(self.draft(rate.node, &sections[2].key(*name).key(rate)));
        }
        Entries { measures, stretched, zeros, states, drafts }
    }

    /// The entries in an order in which what they need comes first; those that need themselves are reported and left out.
    fn arranged(&mut self, entries: &Entries<'n>) -> Vec<usize> {
        let names = &self.name_space.names;
        let entity = |name: &str| names.get(name).copied();
        let mut all: Vec<Vec<usize>> = entries.drafts.iter().map(|draft| needs(draft, |name| entries.find(entity(name)?))).collect();
        // one more, that stands for the rates of all states
        let (rates, count) = (entries.rates(), all.len());
        if !entries.states.is_empty() {
            let is_state = |name: &str| matches!(entity(name), Some(Entity::State(_))).then_some(0);
            let mut states: Vec<bool> = entries.drafts.iter().map(|draft| !needs(draft, is_state).is_empty()).collect();
            for i in order(&all).0 {
                states[i] |= all[i].iter().any(|need| states[*need]);
            }
            let of_state = |name: &str, in_rate: bool| match (in_rate, entity(name)?) {
                (true, Entity::State(_)) => Some(0),
                (true, entity) => entries.find(entity).filter(|i| states[*i]).map(|_| 0),
                _ => None,
            };
            for (draft, needs) in entries.drafts.iter().zip(&mut all) {
                if !named(draft, of_state).is_empty() {
                    needs.push(count);
                }
            }
            all.push((rates..count).collect());
        }
        let (order, cycles) = order(&all);
        let mut out = vec![false; count + 1];
        out[count] = true;
        for cycle in &cycles {
            match cycle.iter().position(|i| *i == count) {
                Some(k) => {
                    let members: Vec<usize> = cycle[k + 1..].iter().chain(&cycle[..k]).copied().collect();
                    self.rate_in_rate(entries, &members);
                }
                None => self.cycle(cycle, |i| (entries.name(i).0.to_owned(), entries.name(i).1)),
            }
            cycle.iter().for_each(|i| out[*i] = true);
        }
        order.into_iter().filter(|i| !out[*i]).collect()
    }

    /// A state whose rate needs, through the further members, the rate of a state.
    fn rate_in_rate(&mut self, entries: &Entries<'n>, members: &[usize]) {
        let state = members.first().and_then(|first| entries.states.get(first.checked_sub(entries.rates())?));
        let Some(&(name, node)) = state else { return self.cycle(members, |i| (entries.name(i).0.to_owned(), entries.name(i).1)) };
        let through: String = members[1..].iter().take(8).map(|i| format!("`{}`, which needs ", entries.name(*i).0)).collect();
        let section = At::ROOT.key("states");
        let at = section.key(name);
        let message = format!("the rate of `{name}` needs {through}the rate of a state");
        let fault =
            self.fault("cycle", &at.key(StateKeys::of(node).rate), message, "a rate of positions, velocities, states and their measures");
        fault.help = Some("write that rate out, or give it a name among the measures and use it in both".to_owned());
    }

    fn measure(&mut self, entries: &Entries<'n>, i: usize) {
        let section = At::ROOT.key("measures");
        let at = section.key(entries.measures[i].0);
        if let Some((lowered, reach)) = self.finish(&entries.drafts[i], &at, Allow::MEASURE, &mut Local::default()) {
            self.name_space.measures[i] = Some((Symbol { id: lowered.id, dimension: lowered.dimension }, reach));
        }
    }

    fn stretch(&mut self, entries: &Entries<'n>, i: usize) {
        let (file, name, stretch) = entries.stretched[i - entries.measures.len()];
        let section = At::ROOT.key("springs");
        let spring_at = section.key(name);
        let allow = Allow { what: "a spring's `stretch`", ..Allow::POSITION };
        let lowered = self.finish(&entries.drafts[i], &spring_at.key(stretch), allow, &mut Local::default());
        if let (Some((lowered, reach)), Some(index)) = (lowered, self.name_space.renumbered.springs.get(file).copied().flatten()) {
            if reach.level == Known::Constant {
                let message = format!("the stretch of `{name}` never changes");
                let fault = self.fault("constant", &spring_at.key(stretch), message, "an expression of positions");
                fault.help = Some("name what the spring is stretched by, as `stretch: slide.position - 2*wheel.angle*r`".to_owned());
            }
            self.name_space.stretches[index] = Some(lowered.dimension);
            self.name_space.model.springs[index].on = SpringOn::Stretch(lowered.id);
        }
    }

    fn state_rate(&mut self, entries: &Entries<'n>, state: usize) {
        let (name, node) = entries.states[state];
        let Some(dimension) = self.name_space.states[state] else { return };
        let section = At::ROOT.key("states");
        let state_at = section.key(name);
        let at = state_at.key(StateKeys::of(node).rate);
        let before = self.faults.len();
        let draft = &entries.drafts[entries.rates() + state];
        let lowered = self.finish(draft, &at, RATE, &mut Local::default());
        if let Some((lowered, reach)) = lowered {
            let wanted = dimension.div(Dimension::TIME);
            if lowered.expect(wanted).is_ok() {
                self.name_space.rates[state] = Some((lowered.id, reach));
                self.name_space.model.states[state].rate = lowered.id;
                return;
            }
            let expected = match dimension.si() {
                si if si.is_empty() => "the rate of a plain number, in 1/s".to_owned(),
                _ => format!("the rate of {}, in {}", dimension.name(), wanted.si()),
            };
            let fault = self.fault("wrong-dimension", &at, format!("found {}", lowered.dimension.name()), expected);
            let meant = lowered.dimension.mul(Dimension::TIME);
            if plain(node) && meant != Dimension::NONE {
                let unit = meant.si();
                // `0 1/m` is no quantity
                let example = if unit.starts_with('1') { String::new() } else { format!(", here `start: {} {unit}`", first(node)) };
                fault.help = Some(format!("a state has the unit of its `start`: give it one{example}"));
            }
            return;
        }
        self.blame_start(before, entries, state);
    }

    /// Says with faults of dimension in a rate which of the states that it names have no unit.
    fn blame_start(&mut self, before: usize, entries: &Entries<'n>, state: usize) {
        let names = &self.name_space.names;
        let without = needs(&entries.drafts[entries.rates() + state], |name| match names.get(name) {
            Some(Entity::State(i)) if entries.states.get(*i).is_some_and(|(_, node)| plain(*node)) => Some(*i),
            _ => None,
        });
        let Some((name, _)) = without.first().and_then(|i| entries.states.get(*i)) else { return };
        for fault in self.faults[before..].iter_mut().filter(|fault| fault.code == "wrong-dimension" && fault.help.is_none()) {
            fault.help = Some(format!("`{name}` counts as a plain number: a state has the unit of its `start`, as in `start: 0 A`"));
        }
    }
}

/// Whether the start of a state says no unit: it is omitted or a plain number.
fn plain(node: Node<'_>) -> bool {
    first(node).parse::<f64>().is_ok()
}

/// The start of a state as written.
fn first(node: Node<'_>) -> String {
    match StateKeys::of(node).start.node {
        Some(Node::Plain(Value::Number(n))) => n.to_string(),
        Some(start) => start.text().unwrap_or_default().trim().to_owned(),
        None => "0".to_owned(),
    }
}
