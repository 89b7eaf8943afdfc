//! Springs: what they measure and their laws.

use super::decoder::{Decoder, Origin};
use super::joints::wanted_of;
use crate::expression::{Dimension, Id, Symbol};
use crate::model::entities::{Spring, SpringLaw, SpringOn};
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::needs::Needs;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::vocabulary::{Known, Quantity};

/// What the numbers of a spring may use.
const TIMED: Allow = Allow { what: "a spring", ..Allow::DRIVER };

impl<'n> Decoder<'n> {
    /// Enters springs so that measures may name them; what they measure by an expression is filled in with the measures.
    pub(super) fn springs_by_name(&mut self) {
        let section = At::ROOT.key("springs");
        for (name, node) in self.section("springs") {
            let at = section.key(name);
            let on = if node.get("between").is_some() {
                self.ends(node, "between", &at).map(|(a, b)| SpringOn::Between(a, b))
            } else if node.get("joint").is_some() {
                self.driven(node.get("joint"), &at.key("joint")).map(|(joint, _)| SpringOn::Joint(joint))
            } else if node.get("stretch").is_some() {
                Some(SpringOn::Stretch(self.pool.constant(0.0)))
            } else {
                None
            };
            let index = on.map(|on| {
                self.name_space.stretches.push(self.name_space.stretch_dimension(&on));
                let place = self.place(&at);
                let (rest, law, damping, preload) = (None, SpringLaw::None, None, None);
                self.name_space.model.springs.push(Spring { name: name.to_owned(), on, rest, law, damping, preload, place });
                self.name_space.model.springs.len() - 1
            });
            self.name_space.renumbered.springs.push(index);
        }
    }

    pub(super) fn springs(&mut self) {
        let section = At::ROOT.key("springs");
        for (i, (name, node)) in self.section("springs").into_iter().enumerate() {
            let at = section.key(name);
            let Some(index) = self.name_space.renumbered.springs.get(i).copied().flatten() else { continue };
            let Some(stretch) = self.name_space.stretches.get(index).copied().flatten() else { continue };
            let (word, rest, wrong) = match self.name_space.model.springs[index].on {
                SpringOn::Between(..) => ("between", "length", "rest"),
                SpringOn::Joint(_) => ("joint", "rest", "length"),
                SpringOn::Stretch(_) => ("stretch", "rest", "length"),
            };
            if node.get(wrong).is_some() {
                let fault = self.fault("unknown-key", &at.key(wrong), format!("`{wrong}` beside `{word}`"), format!("`{rest}`"));
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{rest}:`"));
            }
            let force = Dimension::ENERGY.div(stretch);
            let stiffness = force.div(stretch);
            let rest = match self.name_space.model.springs[index].on {
                SpringOn::Between(..) => self.timed(node, rest, &at, Want::Of(stretch), Rule::NotNegative("the free length")),
                SpringOn::Joint(joint) => {
                    let want = wanted_of(self.name_space.single(joint));
                    self.timed(node, rest, &at, want, Rule::Finite)
                }
                SpringOn::Stretch(_) => self.timed(node, rest, &at, Want::Of(stretch), Rule::Finite),
            };
            let mut number = |key: &'n str, dimension| self.timed(node, key, &at, Want::Of(dimension), Rule::Finite);
            let damping = number("damping", stiffness.mul(Dimension::TIME));
            let preload = number("preload", force);
            let law = if node.get("stiffness").is_some() {
                number("stiffness", stiffness).map(SpringLaw::Stiffness)
            } else if let Some(law) = node.get("force") {
                self.spring_law(index, law, &at.key("force"), stretch, force).map(SpringLaw::Force)
            } else {
                if node.get("damping").is_none() && node.get("preload").is_none() {
                    self.fault("missing-key", &at, "a spring without a law", "`stiffness`, `force`, `damping` or `preload`").spot =
                        Spot::Key;
                }
                None
            };
            let spring = &mut self.name_space.model.springs[index];
            (spring.rest, spring.damping, spring.preload) = (rest, damping, preload);
            spring.law = law.unwrap_or(SpringLaw::None);
        }
    }

    /// A number of a spring, which may change with time; the rule is for one that does not.
    fn timed(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>, want: Want, rule: Rule) -> Option<Id> {
        let (id, reach) = self.value(node.get(key), &at.key(key), want, TIMED)?;
        if reach.level == Known::Constant {
            self.check(rule, &[id], &at.key(key));
        }
        Some(id)
    }

    /// A table by its name, or an expression of `stretch` and `t`.
    fn spring_law(&mut self, spring: usize, node: Node<'n>, at: &At<'_, 'n>, stretch: Dimension, force: Dimension) -> Option<Id> {
        let id = self.name_space.input(&mut self.pool, Quantity::Stretch { spring, order: 0 });
        let symbol = Symbol { id, dimension: stretch };
        let mut local = Local { symbols: vec![("stretch", Some((symbol, Needs::CONSTANT)))], functionals: None };
        let allow = Allow { what: "a law of `stretch`", ..TIMED };
        let table = node.text().filter(|text| matches!(self.name_space.names.get(text), Some(Entity::Table(_))));
        let (lowered, _) = match table {
            Some(table) => self.lower(&format!("{table}(stretch)"), Origin::Value(table, 0), at, allow, &mut local)?,
            None => self.any(node, at, allow, &mut local)?,
        };
        self.fits(&lowered, Want::Of(force), node, None, at).then_some(lowered.id)
    }
}
