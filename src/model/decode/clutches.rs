//! Clutches and brakes: friction on a joint or between two joints by a law of its own, and one-way clutches.

use super::decoder::Decoder;
use crate::model::contacts::{Clutch, ClutchLaw, Sticking};
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::needs::Needs;
use crate::model::rules::Rule;
use crate::model::scope::Allow;
use crate::model::vocabulary::Known;

impl<'n> Decoder<'n> {
    /// Enters clutches with their joints, so that measures may name them.
    pub(super) fn clutches_by_name(&mut self) {
        let section = At::ROOT.key("clutches");
        for (name, node) in self.section("clutches") {
            let at = section.key(name);
            let index = self.clutched(node, &at).map(|joints| {
                let place = self.place(&at);
                let (slipped, index) = (self.pool.constant(0.0), self.name_space.model.clutches.len());
                self.name_space.model.clutches.push(Clutch { name: name.to_owned(), joints, slipped, law: ClutchLaw::OneWay, place });
                self.name_space.model.clutches[index].slipped = self.name_space.slip(&mut self.pool, index, 0);
                index
            });
            self.name_space.renumbered.clutches.push(index);
        }
    }

    /// The joints of a clutch.
    fn clutched(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<[usize; 2]> {
        if node.get("joint").is_some() {
            return self.driven(node.get("joint"), &at.key("joint")).map(|(joint, _)| [joint, joint]);
        }
        let here = at.key("between");
        let [a, b] = node.get("between")?.items() else { return None };
        let a = self.driven(Some(Node::Plain(a)), &here.index(0));
        let b = self.driven(Some(Node::Plain(b)), &here.index(1));
        let ((a, of_a), (b, of_b)) = (a?, b?);
        if a == b {
            self.fault("same-joint", &here, "a joint and itself", "two joints, or `joint:` with one").spot = Spot::Value;
            return None;
        }
        if of_a.angle != of_b.angle {
            self.fault("wrong-joint", &here, "one joint turns, the other slides", "two joints that turn, or two that slide");
            return None;
        }
        Some([a, b])
    }

    /// Fills in how clutches hold.
    pub(super) fn clutches(&mut self) {
        let section = At::ROOT.key("clutches");
        for (i, (name, node)) in self.section("clutches").into_iter().enumerate() {
            let at = section.key(name);
            let Some(index) = self.name_space.renumbered.clutches.get(i).copied().flatten() else { continue };
            if let Some(law) = self.clutch_law(index, name, node, &at) {
                self.name_space.model.clutches[index].law = law;
            }
        }
    }

    fn clutch_law(&mut self, index: usize, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Option<ClutchLaw> {
        let coordinate = self.name_space.single(self.name_space.model.clutches[index].joints[1])?;
        let (key, other) = if coordinate.angle { ("torque", "force") } else { ("force", "torque") };
        if node.get(other).is_some() {
            let verb = if coordinate.angle { "turn" } else { "slide" };
            let fault = self.fault("wrong-joint", &at.key(other), format!("a `{other}` between joints that {verb}"), format!("`{key}`"));
            fault.spot = Spot::Key;
            fault.help = Some(format!("write `{key}:`"));
            return None;
        }
        let speed = self.of(node, "stribeck_speed", at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), speed, at, "stribeck_speed");
        let stick = self.of(node, "stick_speed", at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), stick, at, "stick_speed");
        for (one, both) in [("static", "stribeck_speed"), ("stribeck_speed", "static")] {
            let lonely = node.get(both).is_none().then_some("both of them, or none");
            let idle = node.get("one_way").is_some().then_some("`torque` or `force`: a one-way clutch has no friction");
            if let (Some(expected), Some(_)) = (lonely.or(idle), node.get(one)) {
                let fault = self.fault("missing-key", &at.key(one), format!("`{one}` alone"), expected);
                fault.spot = Spot::Key;
                fault.help = Some(format!("add `{both}:`, or remove `{one}`"));
            }
        }
        if node.get("one_way").is_some() {
            return Some(ClutchLaw::OneWay);
        }
        let want = Want::Of(coordinate.effort());
        let allow = Allow { what: "a clutch", ..Allow::LOAD };
        let largest = self.holding(node, key, at, want, allow);
        let at_rest = if node.get("static").is_some() { self.holding(node, "static", at, want, allow).map(Some) } else { Some(None) };
        let (largest, at_rest) = (largest?, at_rest?);
        let rate = self.name_space.slip(&mut self.pool, index, 1);
        let level = match (at_rest, speed) {
            (Some(at_rest), Some(speed)) => {
                self.falling(largest, at_rest, (rate, speed), &format!("the Stribeck speed of clutch `{name}`")).0
            }
            _ => largest,
        };
        let (share, sense) = self.share(rate, node.get("stick_speed").is_some(), stick, &format!("clutch `{name}`"));
        let whole = self.pool.mul(level, share);
        let sticking = sense.map(|sense| Sticking { sense, holds: level });
        Some(ClutchLaw::Friction { effort: self.pool.neg(whole), sticking })
    }

    /// The largest torque or force; not negative where it is constant.
    fn holding(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>, want: Want, allow: Allow) -> Option<crate::expression::Id> {
        let here = at.key(key);
        let (id, Needs { level, .. }) = self.value(node.get(key), &here, want, allow)?;
        if level == Known::Constant {
            self.check(Rule::NotNegative("what it holds"), &[id], &here);
        }
        Some(id)
    }
}
