//! Events: what crosses zero, and what happens then.

use super::decoder::Decoder;
use crate::expression::{Dimension, Id};
use crate::model::entities::{CouplingKind, Crossing, Event, Motion, Restitution, SpringOn};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, JOINT_NAME, Keys, NUMBER, Shape, Want};
use crate::model::keys::{Words, keys, words};
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::spans::Step;
use crate::model::vocabulary::Known;

/// Everything that a state has.
const ANYTHING: Allow = Allow { what: "an event", ..Allow::MEASURE };

words! {
    /// What an event does to the run.
    enum Action {
        /// It is noted.
        Record = "record",
        /// The run ends.
        Stop = "stop",
    }
}

keys! {
    /// An event.
    pub(crate) EVENT = EventKeys "an event" [] {
        when: need Shape::Formula("an expression that crosses zero"), "What crosses zero.";
        crossing: may Shape::Word(Crossing::WORDS), "In which direction.";
        action: may Shape::Word(Action::WORDS), "Whether the run goes on.";
        set: may Shape::Named(Keys::Reference, "a parameter", &ANY), "Parameters that change then.";
        restitution: may Shape::Map(&RESTITUTION), "Impact in a joint.";
    }
}

keys! {
    /// Restitution.
    RESTITUTION = RestitutionKeys "restitution" [] {
        joint: need JOINT_NAME, "The joint.";
        e: need NUMBER, "Coefficient of restitution.";
    }
}

impl<'n> Decoder<'n> {
    pub(super) fn events(&mut self) {
        let section = At::ROOT.key("events");
        let fixed = self.checks_so_far();
        for (name, node) in self.section("events") {
            let at = section.key(name);
            let keys = EventKeys::of(node);
            let when = self.crossing(keys.when.node, &at.key(keys.when));
            let set_at = at.key(keys.set);
            let mut set = Vec::new();
            for (parameter, value) in keys.set.entries() {
                let here = set_at.key(parameter);
                let Some(i) = self.parameter_named(parameter, &here, true) else { continue };
                self.changeable(i, &here, fixed);
                let Some(dimension) = self.name_space.parameters.get(i).copied().flatten() else { continue };
                set.extend(self.varying(Some(value), &here, Want::Of(dimension), ANYTHING).map(|id| (i, id)));
            }
            let restitution =
                keys.restitution.node.and_then(|inner| self.restitution(RestitutionKeys::of(inner), &at.key(keys.restitution)));
            let crossing = keys.crossing.word().unwrap_or(Crossing::Both);
            let stop = keys.action.word() == Some(Action::Stop);
            if let Some(when) = when {
                let place = self.place(&at);
                self.name_space.model.events.push(Event { name: name.to_owned(), when, crossing, stop, set, restitution, place });
            }
        }
    }

    /// What crosses zero: something that varies, and no condition, which is 0 or 1 and crosses nothing.
    fn crossing(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>) -> Option<Id> {
        let (lowered, reach) = self.any(node?, at, ANYTHING, &mut Local::default())?;
        if lowered.boolean {
            self.fault("no-crossing", at, "a condition, which is 0 or 1", "an expression that crosses zero").help =
                Some("write the difference of its two sides: `x - 3 m` for `x > 3 m`, and `crossing: rising`".to_owned());
            return None;
        }
        if reach.level == Known::Constant {
            self.fault("no-crossing", at, "an expression that does not vary", "an expression that crosses zero").help =
                Some("use `t` or quantities of the mechanism, as in `pivot.angle - 30 deg`".to_owned());
            return None;
        }
        Some(lowered.id)
    }

    fn restitution(&mut self, keys: RestitutionKeys<'n>, at: &At<'_, 'n>) -> Option<Restitution> {
        let (joint_at, e_at) = (at.key(keys.joint), at.key(keys.e));
        let allow = Allow { what: "a coefficient of restitution", ..Allow::LOAD };
        let e = self.value(keys.e.node, &e_at, Want::Of(Dimension::NONE), allow);
        if let Some((e, reach)) = e
            && reach.level == Known::Constant
        {
            self.check(Rule::Within(0.0, 1.0, "the coefficient of restitution"), &[e], &e_at);
        }
        let (joint, _) = self.driven(keys.joint.node, &joint_at)?;
        if let Some(driver) = self.name_space.model.drivers.iter().find(|driver| driver.joint == joint) {
            let message = format!("this joint is driven by `{}`", driver.name);
            self.fault("wrong-joint", &joint_at, message, "a joint that moves freely").help =
                Some("an impact cannot change a motion that is prescribed: remove the driver or the restitution".to_owned());
        }
        Some(Restitution { joint, e: e?.0 })
    }

    /// Refuses to change a parameter that the mechanism is built of, or that other parameters are computed of. `checks` were
    /// registered before the events: each number that is fixed when the mechanism is built has one.
    fn changeable(&mut self, parameter: usize, at: &At<'_, 'n>, checks: usize) {
        let model = &self.name_space.model;
        let uses = |id: &Id| self.pool.parameters_of(&[*id]).contains(&(parameter as u32));
        let name = &model.parameters[parameter].name;
        let (message, help) = if let Some(other) = model.parameters.iter().find(|p| uses(&p.value)) {
            let help = format!("make `{other}` a measure, which follows the change", other = other.name);
            (format!("the parameter `{}` is computed from `{name}`", other.name), help)
        } else if let Some(place) = self.built_of(&uses, checks) {
            (format!("`{name}` is built into `{place}`"), "give a parameter of its own to what shall change".to_owned())
        } else {
            return;
        };
        let expected = "a parameter that only loads, laws of springs, stops, friction, states, measures and events use";
        let fault = self.fault("fixed-parameter", at, message, expected);
        fault.spot = Spot::Key;
        fault.help = Some(help);
    }

    /// The first place of the mechanism whose value is fixed when it is built and uses something.
    fn built_of(&self, uses: &impl Fn(&Id) -> bool, checks: usize) -> Option<String> {
        let model = &self.name_space.model;
        let fixed = |steps: &[Step<'_>]| {
            let varies = matches!(steps, [Step::Key("loads" | "clutches" | "states" | "start"), ..]);
            !varies && !matches!(steps, [Step::Key("joints"), _, Step::Key("limits" | "friction"), ..])
        };
        if let Some(check) = self.checks[..checks].iter().find(|check| fixed(&check.place) && check.ids.iter().any(uses)) {
            return Some(self.layers.source(&check.place));
        }
        // expressions that vary have no check
        let drivers = model.drivers.iter().filter_map(|d| match &d.motion {
            Motion::Position(id) => Some((id, &d.place)),
            _ => None,
        });
        let couplings = model.couplings.iter().filter_map(|c| match &c.kind {
            CouplingKind::Zero(id) => Some((id, &c.place)),
            _ => None,
        });
        let springs = model.springs.iter().filter_map(|s| match &s.on {
            SpringOn::Stretch(id) => Some((id, &s.place)),
            _ => None,
        });
        drivers.chain(couplings).chain(springs).find(|(id, _)| uses(id)).map(|(_, place)| place.clone())
    }
}
