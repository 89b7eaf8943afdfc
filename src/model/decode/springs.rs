//! Springs: what they measure and their laws.

use super::decoder::{Decoder, Origin};
use crate::expression::{Dimension, Id, Symbol};
use crate::model::coordinates::wanted_of;
use crate::model::entities::{Spring, SpringLaw, SpringOn};
use crate::model::fault::{At, Spot};
use crate::model::fields::{COORDINATE, DAMPING, EFFORT, ENDS, JOINT_NAME, LENGTH, STIFFNESS, Shape, Want, at_most_one, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::needs::Needs;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::vocabulary::{Known, Quantity};

/// What the numbers of a spring may use.
const TIMED: Allow = Allow { what: "a spring", ..Allow::DRIVER };

keys! {
    /// A spring.
    pub(crate) SPRING = SpringKeys "a spring" [
        one_of(&["between", "joint", "stretch"]),
        at_most_one(&["stiffness", "force"]),
        at_most_one(&["length", "rest"])
    ] {
        between: may ENDS, "The two points that it connects.";
        joint: may JOINT_NAME, "The joint whose coordinate it acts on.";
        stretch: may Shape::Formula("an expression of positions and `t`"),
            "Any expression of positions and `t`; the force is minus the gradient of the energy.";
        stiffness: may STIFFNESS, "Force by stretch.";
        force: may Shape::Formula("a table, or an expression of `stretch` and `t`"), "Law of the force, instead of `stiffness`.";
        length: may LENGTH, "Free length.";
        rest: may COORDINATE, "Rest angle or rest position.";
        damping: may DAMPING, "Force by rate of stretch; 0 if omitted.";
        preload: may EFFORT, "Constant added to the force; 0 if omitted.";
    }
}

impl<'n> Decoder<'n> {
    /// Enters springs so that measures may name them; what they measure by an expression is filled in with the measures.
    pub(super) fn springs_by_name(&mut self) {
        let section = At::ROOT.key("springs");
        for (name, node) in self.section("springs") {
            let at = section.key(name);
            let keys = SpringKeys::of(node);
            let on = if keys.between.given() {
                self.ends(keys.between, &at).map(|(a, b)| SpringOn::Between(a, b))
            } else if keys.joint.given() {
                self.driven(keys.joint.node, &at.key(keys.joint)).map(|(joint, _)| SpringOn::Joint(joint))
            } else if keys.stretch.given() {
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
            let keys = SpringKeys::of(node);
            let (on, rest, wrong) = match self.name_space.model.springs[index].on {
                SpringOn::Between(..) => (keys.between, keys.length, keys.rest),
                SpringOn::Joint(_) => (keys.joint, keys.rest, keys.length),
                SpringOn::Stretch(_) => (keys.stretch, keys.rest, keys.length),
            };
            if wrong.given() {
                let message = format!("`{}` beside `{}`", wrong.key(), on.key());
                let fault = self.fault("unknown-key", &at.key(wrong), message, format!("`{}`", rest.key()));
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{}:`", rest.key()));
            }
            let force = Dimension::ENERGY.div(stretch);
            let stiffness = force.div(stretch);
            let rest = match self.name_space.model.springs[index].on {
                SpringOn::Between(..) => self.timed(rest, &at, Want::Of(stretch), Rule::NotNegative("the free length")),
                SpringOn::Joint(joint) => {
                    let want = wanted_of(self.name_space.single(joint));
                    self.timed(rest, &at, want, Rule::Finite)
                }
                SpringOn::Stretch(_) => self.timed(rest, &at, Want::Of(stretch), Rule::Finite),
            };
            let damping = self.timed(keys.damping, &at, Want::Of(stiffness.mul(Dimension::TIME)), Rule::NotNegative("the damping"));
            let mut number = |entry: Entry<'n>, dimension| self.timed(entry, &at, Want::Of(dimension), Rule::Finite);
            let preload = number(keys.preload, force);
            let law = if keys.stiffness.given() {
                number(keys.stiffness, stiffness).map(SpringLaw::Stiffness)
            } else if let Some(law) = keys.force.node {
                self.spring_law(index, law, &at.key(keys.force), stretch, force).map(SpringLaw::Force)
            } else {
                if !keys.damping.given() && !keys.preload.given() {
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
    fn timed(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, want: Want, rule: Rule) -> Option<Id> {
        let (id, reach) = self.value(entry.node, &at.key(entry), want, TIMED)?;
        if reach.level == Known::Constant {
            self.check(rule, &[id], &at.key(entry));
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
