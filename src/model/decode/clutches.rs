//! Clutches and brakes: friction on a joint or between two joints by a law of its own, and one-way clutches.

use super::decoder::Decoder;
use crate::expression::Dimension;
use crate::model::contacts::{Clutch, ClutchLaw, Sticking};
use crate::model::fault::{At, Spot};
use crate::model::fields::{EFFORT, JOINT_NAME, RATE, Shape, Size, Want, at_most_one, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::needs::Needs;
use crate::model::rules::Rule;
use crate::model::scope::Allow;
use crate::model::vocabulary::Known;

keys! {
    /// A clutch.
    pub(crate) CLUTCH = ClutchKeys "a clutch" [
        one_of(&["joint", "between"]),
        one_of(&["torque", "force", "one_way"]),
        at_most_one(&["stick_speed", "one_way"])
    ] {
        joint: may JOINT_NAME, "A brake: it acts on the coordinate of this joint.";
        between: may Shape::List(&JOINT_NAME, Size::Exactly(2)),
            "A clutch: it acts on the coordinate of the second joint less that of the first.";
        torque: may Shape::Value(Want::Of(Dimension::TORQUE)), "Largest torque, as long as it slips; an expression as of a load.";
        force: may Shape::Value(Want::Of(Dimension::FORCE)), "Largest force between joints that slide; an expression as of a load.";
        highest("static"): may EFFORT, "The same at rest, where it is higher; falls over `stribeck_speed`.";
        stribeck_speed: may RATE, "Speed over which it falls from `static`.";
        stick_speed: may RATE, "In proportion to the slip below this one, instead of sticking.";
        one_way: may Shape::Flag, "The slip does not become negative: the first drives the second, which may overrun it.";
    }
}

impl<'n> Decoder<'n> {
    /// Enters clutches with their joints, so that measures may name them.
    pub(super) fn clutches_by_name(&mut self) {
        let section = At::ROOT.key("clutches");
        for (name, node) in self.section("clutches") {
            let at = section.key(name);
            let index = self.clutched(ClutchKeys::of(node), &at).map(|joints| {
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
    fn clutched(&mut self, keys: ClutchKeys<'n>, at: &At<'_, 'n>) -> Option<[usize; 2]> {
        if keys.joint.given() {
            return self.driven(keys.joint.node, &at.key(keys.joint)).map(|(joint, _)| [joint, joint]);
        }
        let here = at.key(keys.between);
        let [a, b] = keys.between.items() else { return None };
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
            if let Some(law) = self.clutch_law(index, name, ClutchKeys::of(node), &at) {
                self.name_space.model.clutches[index].law = law;
            }
        }
    }

    fn clutch_law(&mut self, index: usize, name: &str, keys: ClutchKeys<'n>, at: &At<'_, 'n>) -> Option<ClutchLaw> {
        let coordinate = self.name_space.single(self.name_space.model.clutches[index].joints[1])?;
        let (largest, other) = if coordinate.angle { (keys.torque, keys.force) } else { (keys.force, keys.torque) };
        if other.given() {
            let verb = if coordinate.angle { "turn" } else { "slide" };
            let message = format!("a `{}` between joints that {verb}", other.key());
            let fault = self.fault("wrong-joint", &at.key(other), message, format!("`{}`", largest.key()));
            fault.spot = Spot::Key;
            fault.help = Some(format!("write `{}:`", largest.key()));
            return None;
        }
        let speed = self.read_of(keys.stribeck_speed, at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), speed, at, keys.stribeck_speed);
        let stick = self.read_of(keys.stick_speed, at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), stick, at, keys.stick_speed);
        for (one, both) in [(keys.highest, keys.stribeck_speed), (keys.stribeck_speed, keys.highest)] {
            let lonely = (!both.given()).then_some("both of them, or none");
            let idle = keys.one_way.given().then_some("`torque` or `force`: a one-way clutch has no friction");
            if let (Some(expected), true) = (lonely.or(idle), one.given()) {
                let fault = self.fault("missing-key", &at.key(one), format!("`{}` alone", one.key()), expected);
                fault.spot = Spot::Key;
                fault.help = Some(format!("add `{}:`, or remove `{}`", both.key(), one.key()));
            }
        }
        if keys.one_way.given() {
            return Some(ClutchLaw::OneWay);
        }
        let want = Want::Of(coordinate.effort());
        let allow = Allow { what: "a clutch", ..Allow::LOAD };
        let largest = self.holding(largest, at, want, allow);
        let at_rest = if keys.highest.given() { self.holding(keys.highest, at, want, allow).map(Some) } else { Some(None) };
        let (largest, at_rest) = (largest?, at_rest?);
        let rate = self.name_space.slip(&mut self.pool, index, 1);
        let level = match (at_rest, speed) {
            (Some(at_rest), Some(speed)) => {
                self.falling(largest, at_rest, (rate, speed), &format!("the Stribeck speed of clutch `{name}`")).0
            }
            _ => largest,
        };
        let (share, sense) = self.share(rate, keys.stick_speed.given(), stick, &format!("clutch `{name}`"));
        let whole = self.pool.mul(level, share);
        let sticking = sense.map(|sense| Sticking { sense, holds: level });
        Some(ClutchLaw::Friction { effort: self.pool.neg(whole), sticking })
    }

    /// The largest torque or force; not negative where it is constant.
    fn holding(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, want: Want, allow: Allow) -> Option<crate::expression::Id> {
        let here = at.key(entry);
        let (id, Needs { level, .. }) = self.value(entry.node, &here, want, allow)?;
        if level == Known::Constant {
            self.check(Rule::NotNegative("what it holds"), &[id], &here);
        }
        Some(id)
    }
}
