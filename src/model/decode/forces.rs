//! Couplings, drivers, motors and loads.

use super::decoder::Decoder;
use crate::expression::{Dimension, Id};
use crate::model::entities::{Coupling, CouplingKind, Driver, Law, Load, LoadOn, Motion, Motor};
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::scope::Allow;
use crate::model::suggest;
use crate::model::suggest::clip;
use crate::model::vocabulary::{Known, Quantity};

impl<'n> Decoder<'n> {
    /// A value that may vary as `allow` says; if it is constant it must be finite.
    pub(super) fn varying(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, want: Want, allow: Allow) -> Option<Id> {
        let (id, reach) = self.value(node, at, want, allow)?;
        if reach.level == Known::Constant {
            self.check(Rule::Finite, &[id], at);
        }
        Some(id)
    }

    /// Refuses a key that does not belong to the kind of an entry.
    fn refuse_keys(&mut self, node: Node<'n>, at: &At<'_, 'n>, keys: &[&'n str], kind: &str) {
        for key in keys {
            if node.get(key).is_some() {
                let fault =
                    self.fault("unknown-key", &at.key(*key), format!("`{key}` beside `{kind}`"), format!("a key that belongs to `{kind}`"));
                fault.spot = Spot::Key;
                fault.help = Some("remove it".to_owned());
            }
        }
    }

    fn missing(&mut self, at: &At<'_, 'n>, key: &str, kind: &str, what: &str) {
        let fault = self.fault("missing-key", at, format!("`{kind}` needs `{key}`"), what.to_owned());
        fault.spot = Spot::Key;
        fault.help = Some(format!("add `{key}:`"));
    }

    pub(super) fn couplings(&mut self) {
        let section = At::ROOT.key("couplings");
        for (name, node) in self.section("couplings") {
            let at = section.key(name);
            if let Some(kind) = self.coupling(node, &at) {
                let place = self.place(&at);
                self.name_space.model.couplings.push(Coupling { name: name.to_owned(), kind, place });
            }
        }
    }

    fn coupling(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<CouplingKind> {
        if let Some(zero) = node.get("zero") {
            self.refuse_keys(node, at, &["ratio", "radius"], "zero");
            let allow = Allow { what: "a coupling", ..Allow::POSITION };
            let here = at.key("zero");
            let (id, reach) = self.value(Some(zero), &here, Want::Any, allow)?;
            if reach.level < Known::Position {
                self.fault(
                    "no-coordinate",
                    &here,
                    "an expression without a quantity of the mechanism",
                    "an expression of positions that stays 0",
                );
            }
            return Some(CouplingKind::Zero(id));
        }
        let (word, wrong) = if node.get("gear").is_some() { ("gear", "radius") } else { ("rack", "ratio") };
        self.refuse_keys(node, at, &[wrong], word);
        let here = at.key(word);
        let [a, b] = node.get(word)?.items() else { return None };
        let a = self.driven(Some(Node::Plain(a)), &here.index(0));
        let b = self.driven(Some(Node::Plain(b)), &here.index(1));
        let value = if word == "gear" {
            if node.get("ratio").is_none() {
                self.missing(at, "ratio", word, "how far the second turns per turn of the first");
            }
            self.of(node, "ratio", at, Dimension::NONE)
        } else {
            if node.get("radius").is_none() {
                self.missing(at, "radius", word, "the radius of the pinion (m)");
            }
            self.of(node, "radius", at, Dimension::LENGTH)
        };
        let ((a, of_a), (b, of_b)) = (a?, b?);
        if a == b {
            self.fault("same-joint", &here, "a joint coupled with itself", "two joints");
            return None;
        }
        if word == "gear" && of_a.angle != of_b.angle {
            self.fault("wrong-joint", &here, "one joint turns, the other slides", "two joints that turn, or two that slide").help =
                Some("use `rack: [pinion, slider]` with `radius`".to_owned());
        }
        if word == "rack" && (!of_a.angle || of_b.angle) {
            self.fault("wrong-joint", &here, "the wrong kinds of joints", "first a joint that turns, then one that slides");
        }
        let value = value?;
        Some(if word == "gear" {
            CouplingKind::Gear { a, b, ratio: value }
        } else {
            CouplingKind::Rack { pinion: a, slide: b, radius: value }
        })
    }

    pub(super) fn drivers(&mut self) {
        let section = At::ROOT.key("drivers");
        for (name, node) in self.section("drivers") {
            let at = section.key(name);
            let driver = self.driver(name, node, &at);
            let index = driver.map(|driver| {
                self.name_space.model.drivers.push(driver);
                self.name_space.model.drivers.len() - 1
            });
            self.name_space.renumbered.drivers.push(index);
        }
    }

    fn driver(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Option<Driver> {
        let Some((joint, coordinate)) = self.driven(node.get("joint"), &at.key("joint")) else {
            // what is wrong with a motion of any kind is told all the same
            for key in ["speed", "angle", "position"] {
                self.value(node.get(key), &at.key(key), Want::Any, Allow::DRIVER);
            }
            return None;
        };
        if let Some(other) = self.name_space.model.drivers.iter().find(|d| d.joint == joint) {
            let message = format!("this joint is driven by `{}` already", other.name);
            self.fault("driven-twice", &at.key("joint"), message, "one driver for a joint").help = Some("remove one of the two".to_owned());
        }
        let motion = if node.get("speed").is_some() {
            Motion::Speed(self.of(node, "speed", at, coordinate.dimension(1))?)
        } else if let Some(rise) = node.get("rise") {
            let here = at.key("rise");
            let by = self.coordinate(rise, "by", &here, Some(coordinate));
            let during = self.of(rise, "during", &here, Dimension::TIME);
            self.check_key(Rule::Positive("the time"), during, &here, "during");
            let law = if rise.get("law").and_then(Node::text) == Some("poly5") { Law::Poly5 } else { Law::Cycloidal };
            Motion::Rise { by: by?, during: during?, law }
        } else {
            let (key, other) = if coordinate.angle { ("angle", "position") } else { ("position", "angle") };
            if node.get(other).is_some() {
                let joint = self.name_space.model.joints[joint].name.clone();
                let message = format!("`{joint}` has no `{other}`");
                let fault = self.fault("wrong-joint", &at.key(other), message, format!("`{key}`: an expression of `t`"));
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{key}:`"));
                return None;
            }
            let want = if coordinate.angle { Want::Angle } else { Want::Of(Dimension::LENGTH) };
            Motion::Position(self.varying(node.get(key), &at.key(key), want, Allow::DRIVER)?)
        };
        Some(Driver { name: name.to_owned(), joint, motion, place: self.place(at) })
    }

    pub(super) fn motors(&mut self) {
        let section = At::ROOT.key("motors");
        for (name, node) in self.section("motors") {
            let at = section.key(name);
            let motor = self.motor(name, node, &at);
            let index = motor.map(|motor| {
                self.name_space.model.motors.push(motor);
                self.name_space.model.motors.len() - 1
            });
            self.name_space.renumbered.motors.push(index);
        }
    }

    fn motor(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Option<Motor> {
        let gear = self.of(node, "gear", at, Dimension::NONE);
        self.check_key(Rule::NotZero("the gear ratio"), gear, at, "gear");
        let inertia = self.size(node.get("inertia"), &at.key("inertia"), Dimension::INERTIA, "the inertia");
        let curve = self.table_named(node.get("curve"), &at.key("curve"));
        let (joint, coordinate) = self.driven(node.get("joint"), &at.key("joint"))?;
        if !coordinate.angle {
            self.fault("wrong-joint", &at.key("joint"), "a joint that slides", "a joint that turns");
            return None;
        }
        let torque = curve.and_then(|table| {
            let (x, y) = self.name_space.tables.get(table).copied().flatten()?;
            if (x, y) != (Dimension::ANGULAR_SPEED, Dimension::TORQUE) {
                let message = format!("a table of {} over {}", y.name(), x.name());
                self.fault("wrong-dimension", &at.key("curve"), message, "torque (N m) over angular speed (rad/s)").help =
                    Some("give its points units: `[[0 rpm, 200 N m], [1500 rpm, 0 N m]]`".to_owned());
                return None;
            }
            let omega = self.name_space.input(&mut self.pool, Quantity::Joint { joint, slot: 0, order: 1 });
            let text = format!("motor `{name}`");
            Some(match gear {
                Some(gear) => {
                    let speed = self.pool.mul(gear, omega);
                    let torque = self.pool.table(table as u32, 0, speed, &text);
                    self.pool.mul(gear, torque)
                }
                None => self.pool.table(table as u32, 0, omega, &text),
            })
        });
        Some(Motor { name: name.to_owned(), joint, torque, gear, inertia, place: self.place(at) })
    }

    fn table_named(&mut self, node: Option<Node<'_>>, at: &At<'_, '_>) -> Option<usize> {
        let text = node?.text()?;
        if let Some(Entity::Table(i)) = self.name_space.names.get(text) {
            return Some(*i);
        }
        let tables = self.name_space.known(|entity| matches!(entity, Entity::Table(_)));
        let near = suggest::nearest(text, tables.iter().copied()).map(|near| format!("did you mean `{near}`?"));
        let list = suggest::known(tables.iter().copied()).unwrap_or_else(|| "(there are none)".to_owned());
        self.fault("unknown-table", at, format!("unknown table `{}`", clip(text)), format!("one of the tables {list}")).help = near;
        None
    }

    pub(super) fn loads(&mut self) {
        let section = At::ROOT.key("loads");
        for (name, node) in self.section("loads") {
            let at = section.key(name);
            if let Some(on) = self.load(node, &at) {
                let place = self.place(&at);
                self.name_space.model.loads.push(Load { name: name.to_owned(), on, place });
            }
        }
    }

    fn load(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<LoadOn> {
        if node.get("joint").is_some() {
            self.refuse_keys(node, at, &["frame"], "joint");
            let (joint, coordinate) = self.driven(node.get("joint"), &at.key("joint"))?;
            let (key, other) = if coordinate.angle { ("torque", "force") } else { ("force", "torque") };
            let verb = if coordinate.angle { "turns" } else { "slides" };
            if node.get(other).is_some() {
                let fault = self.fault("wrong-joint", &at.key(other), format!("a `{other}` on a joint that {verb}"), format!("`{key}`"));
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{key}:`"));
                return None;
            }
            if node.get(key).is_none() {
                self.missing(at, key, "joint", &format!("the {key} on the second body"));
                return None;
            }
            if node.get(key).is_some_and(Node::is_list) {
                self.fault("wrong-type", &at.key(key), "a vector", "one number: it acts along the joint's coordinate");
                return None;
            }
            let effort = self.varying(node.get(key), &at.key(key), Want::Of(coordinate.effort()), Allow::LOAD)?;
            return Some(LoadOn::Joint { joint, effort });
        }
        let point = self.point(node.get("at"), &at.key("at"));
        if node.get("force").is_none() && node.get("torque").is_none() {
            self.fault("missing-key", at, "a load without `force` and `torque`", "at least one of the two").spot = Spot::Key;
        }
        let components = self.name_space.components();
        let force = self.load_vector(node, "force", at, Dimension::FORCE, components);
        let torque = self.load_vector(node, "torque", at, Dimension::TORQUE, if components == 2 { 1 } else { 3 });
        let world = PointRef { body: 0, point: 0 };
        let frame = match node.get("frame").and_then(Node::text) {
            None | Some("world" | "ground") => Some(world),
            Some(_) => self.point(node.get("frame"), &at.key("frame")),
        };
        Some(LoadOn::Point { at: point?, force: force?, torque: torque?, frame: frame? })
    }

    /// Components of a load; empty if the key is missing.
    fn load_vector(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>, dimension: Dimension, components: usize) -> Option<Vec<Id>> {
        let Some(inner) = node.get(key) else { return Some(Vec::new()) };
        let here = at.key(key);
        if components == 1 {
            if inner.is_list() {
                self.fault("wrong-type", &here, "a list", "one number: the torque about z");
                return None;
            }
            return Some(vec![self.varying(Some(inner), &here, Want::Of(dimension), Allow::LOAD)?]);
        }
        if !inner.is_list() || inner.items().len() != components {
            if !inner.is_list() {
                let list = if components == 2 { "[x, y]" } else { "[x, y, z]" };
                self.fault("wrong-type", &here, "one number", format!("a vector `{list}`: at a point a {key} has {components} components"));
            } else if dimension == Dimension::TORQUE {
                self.fault("wrong-size", &here, format!("{} components", inner.items().len()), format!("{components} components"));
            }
            return None;
        }
        let mut ids = Vec::new();
        for (i, item) in inner.items().iter().enumerate() {
            ids.push(self.varying(Some(Node::Plain(item)), &here.index(i), Want::Of(dimension), Allow::LOAD));
        }
        ids.into_iter().collect()
    }

    /// The parameter of a name; the fault is reported, at the key or at the value.
    pub(super) fn parameter_named(&mut self, name: &str, at: &At<'_, '_>, key: bool) -> Option<usize> {
        match self.name_space.names.get(name) {
            Some(Entity::Parameter(i)) => Some(*i),
            other => {
                let is = other.map(|entity| format!("`{name}` is {}", entity.what()));
                let names = self.name_space.known(|entity| matches!(entity, Entity::Parameter(_)));
                let near = suggest::nearest(name, names.iter().copied()).map(|near| format!("did you mean `{near}`?"));
                let list = suggest::known(names.iter().copied()).unwrap_or_else(|| "(there are none)".to_owned());
                let message = is.unwrap_or_else(|| format!("unknown parameter `{}`", clip(name)));
                let fault = self.fault("unknown-parameter", at, message, format!("one of the parameters {list}"));
                fault.help = near;
                if key {
                    fault.spot = Spot::Key;
                }
                None
            }
        }
    }
}
