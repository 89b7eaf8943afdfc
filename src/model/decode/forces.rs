//! Couplings, drivers, motors and loads.

use super::decoder::Decoder;
use super::values::Draft;
use crate::expression::{Dimension, Id};
use crate::model::coordinates::wanted_of;
use crate::model::entities::{Coupling, CouplingKind, Driver, Law, Load, LoadOn, Motion, Motor};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANGLE, COORDINATE, INERTIA, JOINT_NAME, LENGTH, NUMBER, POINT, Shape, Size, TIME, Want, one_of};
use crate::model::keys::{Entry, Words, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::suggest;
use crate::model::suggest::clip;
use crate::model::vocabulary::{Known, Quantity};

const FORCE: Shape = Shape::Value(Want::Of(Dimension::FORCE));
const TORQUE: Shape = Shape::Value(Want::Of(Dimension::TORQUE));

keys! {
    /// A coupling.
    pub(crate) COUPLING = CouplingKeys "a coupling" [one_of(&["gear", "rack", "rope", "zero"])] {
        gear: may Shape::List(&JOINT_NAME, Size::Exactly(2)), "The second joint turns `ratio` times as far as the first.";
        rack: may Shape::List(&JOINT_NAME, Size::Exactly(2)),
            "The slider moves `radius` times as far as the pinion turns: [pinion, slider].";
        rope: may Shape::List(&JOINT_NAME, Size::Exactly(2)),
            "As `rack`, by a rope that winds on a drum and stays taut: [drum, slider].";
        zero: may Shape::Formula("an expression of positions and `t`"), "An expression of positions and `t` that stays 0.";
        ratio: may NUMBER, "Of a gear.";
        radius: may LENGTH, "Of a pinion or drum.";
    }
}

keys! {
    /// A driver.
    pub(crate) DRIVER = DriverKeys "a driver" [one_of(&["speed", "angle", "position", "rise"])] {
        joint: need JOINT_NAME, "The driven joint.";
        speed: may Shape::Value(Want::Varies("an angular speed (rad/s) or a speed (m/s), as the joint has it")),
            "Constant speed from the start position.";
        angle: may ANGLE, "The angle as an expression of t.";
        position: may LENGTH, "The position as an expression of t.";
        rise: may Shape::Map(&RISE), "A rise from the start position, then rest.";
    }
}

keys! {
    /// A rise.
    RISE = RiseKeys "a rise" [] {
        by: need COORDINATE, "How far.";
        during: need TIME, "How long.";
        law: need Shape::Word(Law::WORDS), "Law of motion.";
    }
}

keys! {
    /// A load.
    pub(crate) LOAD = LoadKeys "a load" [one_of(&["at", "joint"])] {
        at: may POINT, "The point of a body that it acts on.";
        joint: may JOINT_NAME, "The joint whose coordinate it acts on: on the second body, reaction on the first.";
        force: may Shape::Either(&[FORCE, Shape::List(&FORCE, Size::Space)]),
            "Force: a vector at a point, a number on a slider.";
        torque: may Shape::Either(&[TORQUE, Shape::List(&TORQUE, Size::Exactly(3))]),
            "Torque: a number in the plane or on a joint, a vector in space.";
        frame: may Shape::Name("a body, a point `body.point` with axes of its own, or `world`"),
            "Body or point whose axes the components are in; `world` if omitted.";
    }
}

keys! {
    /// A motor.
    pub(crate) MOTOR = MotorKeys "a motor" [] {
        joint: need JOINT_NAME, "The joint that it turns.";
        curve: may Shape::Name("the name of a table: torque over speed"), "Torque of the motor by its own speed.";
        gear: may NUMBER, "Turns of the motor per turn of the joint; 1 if omitted.";
        inertia: may INERTIA, "Inertia of the rotor before the gear; 0 if omitted.";
    }
}

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
    fn refuse_keys(&mut self, at: &At<'_, 'n>, entries: &[Entry<'n>], kind: Entry<'n>) {
        for entry in entries.iter().filter(|entry| entry.given()) {
            let (key, kind) = (entry.key(), kind.key());
            let fault =
                self.fault("unknown-key", &at.key(key), format!("`{key}` beside `{kind}`"), format!("a key that belongs to `{kind}`"));
            fault.spot = Spot::Key;
            fault.help = Some("remove it".to_owned());
        }
    }

    fn missing(&mut self, at: &At<'_, 'n>, entry: Entry<'n>, kind: Entry<'n>, what: &str) {
        let key = entry.key();
        let fault = self.fault("missing-key", at, format!("`{}` needs `{key}`", kind.key()), what.to_owned());
        fault.spot = Spot::Key;
        fault.help = Some(format!("add `{key}:`"));
    }

    /// Enters couplings, so that everything may name them; expressions that stay 0 are filled in with the measures ([`Self::zero`]).
    pub(super) fn couplings(&mut self) {
        let section = At::ROOT.key("couplings");
        for (name, node) in self.section("couplings") {
            let at = section.key(name);
            let zero = CouplingKeys::of(node).zero.given();
            let index = self.coupling(node, &at).map(|(kind, along)| {
                let place = self.place(&at);
                self.name_space.model.couplings.push(Coupling { name: name.to_owned(), kind, along, place });
                self.name_space.model.couplings.len() - 1
            });
            self.name_space.renumbered.couplings.push(index.filter(|_| !zero));
        }
    }

    /// Fills in the expression of the coupling number `file` in the file.
    pub(super) fn zero(&mut self, file: usize, name: &str, draft: &Draft<'n>) {
        let section = At::ROOT.key("couplings");
        let coupling_at = section.key(name);
        let at = coupling_at.key("zero");
        let allow = Allow { what: "a coupling", ..Allow::POSITION };
        let Some((lowered, reach)) = self.finish(draft, &at, allow, &mut Local::default()) else { return };
        if reach.level < Known::Position {
            self.fault(
                "no-coordinate",
                &at,
                "an expression without a quantity of the mechanism",
                "an expression of positions that stays 0",
            );
        }
        let couplings = &mut self.name_space.model.couplings;
        let Some(index) = couplings.iter().position(|coupling| coupling.name == name) else { return };
        (couplings[index].kind, couplings[index].along) = (CouplingKind::Zero(lowered.id), lowered.dimension);
        self.name_space.renumbered.couplings[file] = Some(index);
    }

    /// The kind of a coupling, and the dimension of its second coordinate or of its expression.
    fn coupling(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(CouplingKind, Dimension)> {
        let keys = CouplingKeys::of(node);
        if keys.zero.given() {
            self.refuse_keys(at, &[keys.ratio, keys.radius], keys.zero);
            return Some((CouplingKind::Zero(self.pool.constant(0.0)), Dimension::NONE));
        }
        let gear = keys.gear.given();
        let rope = keys.rope.given();
        let (of, wrong) = if gear { (keys.gear, keys.radius) } else { (if rope { keys.rope } else { keys.rack }, keys.ratio) };
        self.refuse_keys(at, &[wrong], of);
        let here = at.key(of);
        let [a, b] = of.items() else { return None };
        let a = self.driven(Some(Node::Plain(a)), &here.index(0));
        let b = self.driven(Some(Node::Plain(b)), &here.index(1));
        let value = if gear {
            if !keys.ratio.given() {
                self.missing(at, keys.ratio, of, "how far the second turns per turn of the first");
            }
            let ratio = self.read(keys.ratio, at);
            self.check_key(Rule::NotZero("the ratio"), ratio, at, keys.ratio);
            ratio
        } else {
            if !keys.radius.given() {
                self.missing(at, keys.radius, of, if rope { "the radius of the drum (m)" } else { "the radius of the pinion (m)" });
            }
            self.read(keys.radius, at)
        };
        let ((a, of_a), (b, of_b)) = (a?, b?);
        if a == b {
            self.fault("same-joint", &here, "a joint coupled with itself", "two joints");
            return None;
        }
        if gear && of_a.angle != of_b.angle {
            self.fault("wrong-joint", &here, "one joint turns, the other slides", "two joints that turn, or two that slide").help =
                Some("use `rack: [pinion, slider]` with `radius`".to_owned());
        }
        if !gear && (!of_a.angle || of_b.angle) {
            self.fault("wrong-joint", &here, "the wrong kinds of joints", "first a joint that turns, then one that slides");
        }
        let value = value?;
        let kind =
            if gear { CouplingKind::Gear { a, b, ratio: value } } else { CouplingKind::Rack { pinion: a, slide: b, radius: value, rope } };
        Some((kind, of_b.dimension(0)))
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
        let keys = DriverKeys::of(node);
        let Some((joint, coordinate)) = self.driven(keys.joint.node, &at.key(keys.joint)) else {
            // what is wrong with a motion of any kind is told all the same
            for entry in [keys.speed, keys.angle, keys.position] {
                self.value(entry.node, &at.key(entry), Want::Any, Allow::DRIVER);
            }
            return None;
        };
        if let Some(other) = self.name_space.model.drivers.iter().find(|d| d.joint == joint) {
            let message = format!("this joint is driven by `{}` already", other.name);
            self.fault("driven-twice", &at.key(keys.joint), message, "one driver for a joint").help =
                Some("remove one of the two".to_owned());
        }
        let motion = if keys.speed.given() {
            let before = self.faults.len();
            let speed = self.read_of(keys.speed, at, coordinate.dimension(1));
            for fault in self.faults[before..].iter_mut().filter(|fault| fault.message.starts_with("`t` ")) {
                let law = if coordinate.angle { keys.angle.key() } else { keys.position.key() };
                fault.help = Some(format!("`speed` is constant: write `{law}:`, which takes an expression of `t`"));
            }
            Motion::Speed(speed?)
        } else if let Some(rise) = keys.rise.node {
            let (rise, here) = (RiseKeys::of(rise), at.key(keys.rise));
            let by = self.read_as(rise.by, &here, wanted_of(Some(coordinate)));
            let during = self.read(rise.during, &here);
            self.check_key(Rule::Positive("the time"), during, &here, rise.during);
            let law = rise.law.word().unwrap_or(Law::Cycloidal);
            Motion::Rise { by: by?, during: during?, law }
        } else {
            let (value, other) = if coordinate.angle { (keys.angle, keys.position) } else { (keys.position, keys.angle) };
            if other.given() {
                let (key, absent) = (value.key(), other.key());
                let joint = self.name_space.model.joints[joint].name.clone();
                let message = format!("`{joint}` has no `{absent}`");
                let fault = self.fault("wrong-joint", &at.key(other), message, format!("`{key}`: an expression of `t`"));
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{key}:`"));
                return None;
            }
            let want = if coordinate.angle { Want::Angle } else { Want::Of(Dimension::LENGTH) };
            Motion::Position(self.varying(value.node, &at.key(value), want, Allow::DRIVER)?)
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
        let keys = MotorKeys::of(node);
        let gear = self.read(keys.gear, at);
        self.check_key(Rule::NotZero("the gear ratio"), gear, at, keys.gear);
        let inertia = self.size(keys.inertia, at, "the inertia");
        let curve = self.table_named(keys.curve.node, &at.key(keys.curve));
        let (joint, coordinate) = self.driven(keys.joint.node, &at.key(keys.joint))?;
        if !coordinate.angle {
            self.fault("wrong-joint", &at.key(keys.joint), "a joint that slides", "a joint that turns");
            return None;
        }
        let torque = curve.and_then(|table| {
            let (x, y) = self.name_space.tables.get(table).copied().flatten()?;
            if (x, y) != (Dimension::ANGULAR_SPEED, Dimension::TORQUE) {
                let message = format!("a table of {} over {}", y.name(), x.name());
                self.fault("wrong-dimension", &at.key(keys.curve), message, "torque (N m) over angular speed (rad/s)").help =
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
        let keys = LoadKeys::of(node);
        if keys.joint.given() {
            self.refuse_keys(at, &[keys.frame], keys.joint);
            let (joint, coordinate) = self.driven(keys.joint.node, &at.key(keys.joint))?;
            let (effort, other) = if coordinate.angle { (keys.torque, keys.force) } else { (keys.force, keys.torque) };
            let key = effort.key();
            let verb = if coordinate.angle { "turns" } else { "slides" };
            if other.given() {
                let message = format!("a `{}` on a joint that {verb}", other.key());
                let fault = self.fault("wrong-joint", &at.key(other), message, format!("`{key}`"));
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{key}:`"));
                return None;
            }
            if !effort.given() {
                self.missing(at, effort, keys.joint, &format!("the {key} on the second body"));
                return None;
            }
            if effort.node.is_some_and(Node::is_list) {
                self.fault("wrong-type", &at.key(effort), "a vector", "one number: it acts along the joint's coordinate");
                return None;
            }
            let effort = self.varying(effort.node, &at.key(effort), Want::Of(coordinate.effort()), Allow::LOAD)?;
            return Some(LoadOn::Joint { joint, effort });
        }
        let point = self.point(keys.at.node, &at.key(keys.at));
        if !keys.force.given() && !keys.torque.given() {
            self.fault("missing-key", at, "a load without `force` and `torque`", "at least one of the two").spot = Spot::Key;
        }
        let components = self.name_space.components();
        let force = self.load_vector(keys.force, at, Dimension::FORCE, components);
        let torque = self.load_vector(keys.torque, at, Dimension::TORQUE, if components == 2 { 1 } else { 3 });
        let world = PointRef { body: 0, point: 0 };
        let frame = match keys.frame.text() {
            None | Some("world" | "ground") => Some(world),
            Some(_) => self.point(keys.frame.node, &at.key(keys.frame)),
        };
        Some(LoadOn::Point { at: point?, force: force?, torque: torque?, frame: frame? })
    }

    /// Components of a load; empty if the key is missing.
    fn load_vector(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, dimension: Dimension, components: usize) -> Option<Vec<Id>> {
        let Some(inner) = entry.node else { return Some(Vec::new()) };
        let (key, here) = (entry.key(), at.key(entry));
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
                fault.help = Some(near.unwrap_or_else(|| suggest::take_or_add(name, "parameters")));
                if key {
                    fault.spot = Spot::Key;
                }
                None
            }
        }
    }
}
