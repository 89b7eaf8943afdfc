//! Joints.

use super::decoder::Decoder;
use crate::expression::{Dimension, Id};
use crate::model::coordinates::{Coordinate, coordinates};
use crate::model::entities::{Joint, JointKind};
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::suggest;
use crate::model::suggest::clip;
use crate::model::tables::JOINT_KINDS;

/// Kinds that exist only in space, and those that exist only in the plane.
const SPATIAL: [&str; 5] = ["cylindrical", "planar", "screw", "universal", "spherical"];
const PLANAR: [&str; 1] = ["pin-in-slot"];

impl<'n> Decoder<'n> {
    pub(super) fn joints(&mut self) {
        let section = At::ROOT.key("joints");
        for (name, node) in self.section("joints") {
            let joint = self.joint(name, node, &section.key(name));
            let index = joint.map(|joint| {
                self.name_space.model.joints.push(joint);
                self.name_space.model.joints.len() - 1
            });
            self.name_space.renumbered.joints.push(index);
        }
    }

    fn joint(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Option<Joint> {
        let Some(word) = JOINT_KINDS.into_iter().find(|kind| node.get(kind).is_some()) else {
            // a misspelt kind was told: its points are read all the same
            let misspelt = node.entries().into_iter().find(|(key, _)| suggest::nearest(key, JOINT_KINDS).is_some());
            misspelt.and_then(|(key, _)| self.ends(node, key, at));
            return None;
        };
        let ends = self.ends(node, word, at);
        let planar = self.name_space.components() == 2;
        let (wrong, here) = if planar { (SPATIAL.contains(&word), "planar") } else { (PLANAR.contains(&word), "spatial") };
        if wrong {
            let code = if planar { "spatial-only" } else { "planar-only" };
            let fault =
                self.fault(code, &at.key(word), format!("`{word}` does not exist in a {here} model"), format!("a joint of a {here} model"));
            fault.spot = Spot::Key;
            return None;
        }
        let kind = self.joint_kind(word, node, at)?;
        self.keys_of_kind(word, node, at, planar);
        let single = match coordinates(&kind) {
            [one] => Some(one),
            _ => None,
        };
        let axis = self.direction(node.get("axis"), &at.key("axis"));
        let to = self.direction(node.get("to"), &at.key("to"));
        let effort = single.map_or(Dimension::TORQUE, Coordinate::effort);
        let rate = single.map_or(Dimension::ANGULAR_SPEED, |c| c.dimension(1));
        let rpy_at = at.key("rpy");
        if node.get("rpy").is_some() && node.get("to").is_some() {
            let fault = self.fault("two-kinds", &rpy_at, "`rpy` beside `to`", "only one of `to`, `rpy`");
            fault.spot = Spot::Key;
            fault.help = Some("remove one of the two".to_owned());
        }
        let rpy = node.get("rpy").and_then(|rpy| self.roll_pitch_yaw(rpy, &rpy_at));
        let zero = self.coordinate(node, "zero", at, single);
        let damping = self.of(node, "damping", at, effort.div(rate));
        let friction = node.get("friction").and_then(|inner| self.friction((name, &kind), inner, &at.key("friction"), single));
        let limits = node.get("limits").map(|inner| self.limits(name, inner, &at.key("limits"), single));
        let (limit, stops) = limits.unwrap_or_default();
        let cut = matches!(node.get("cut"), Some(Node::Plain(serde_yaml::Value::Bool(true))));
        let (a, b) = ends?;
        let (name, place) = (name.to_owned(), self.place(at));
        Some(Joint { name, kind, a, b, axis, to, rpy, zero, damping, limit, friction, stops, cut, place })
    }

    /// `rpy`: three angles.
    pub(super) fn roll_pitch_yaw(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<[Id; 3]> {
        let items = node.items().iter().enumerate();
        let angles: Vec<Option<Id>> = items.map(|(i, item)| self.number(Some(Node::Plain(item)), &at.index(i), Want::Angle)).collect();
        match angles[..] {
            [Some(roll), Some(pitch), Some(yaw)] => Some([roll, pitch, yaw]),
            _ => None,
        }
    }

    /// The two points of `key: [a, b]`, which belong to different bodies.
    pub(super) fn ends(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>) -> Option<(PointRef, PointRef)> {
        let here = at.key(key);
        let items = node.get(key)?.items();
        let [a, b] = items else { return None };
        let a = self.point(Some(Node::Plain(a)), &here.index(0));
        let b = self.point(Some(Node::Plain(b)), &here.index(1));
        let (a, b) = (a?, b?);
        if a.body == b.body {
            let name = self.name_space.model.bodies[a.body].name.clone();
            self.fault("same-body", &here, format!("both points belong to `{name}`"), "points of two bodies");
            return None;
        }
        Some((a, b))
    }

    fn joint_kind(&mut self, word: &'static str, node: Node<'n>, at: &At<'_, 'n>) -> Option<JointKind> {
        let missing = |decoder: &mut Self, key: &str, expected: &str| {
            let fault = decoder.fault("missing-key", at, format!("`{word}` needs `{key}`"), expected.to_owned());
            fault.spot = Spot::Key;
            fault.help = Some(format!("add `{key}:`"));
        };
        Some(match word {
            "revolute" => JointKind::Revolute,
            "slider" | "prismatic" => JointKind::Slider,
            "pin-in-slot" => JointKind::PinInSlot,
            "fixed" => JointKind::Fixed,
            "distance" => {
                let length = self.size(node.get("length"), &at.key("length"), Dimension::LENGTH, "the length");
                JointKind::Distance { length }
            }
            "cylindrical" => JointKind::Cylindrical,
            "planar" => JointKind::Planar,
            "spherical" => JointKind::Spherical,
            "screw" => {
                if node.get("pitch").is_none() {
                    missing(self, "pitch", "the advance per turn (m)");
                }
                JointKind::Screw { pitch: self.of(node, "pitch", at, Dimension::LENGTH)? }
            }
            "universal" => {
                let Some(axes) = node.get("axes") else {
                    missing(self, "axes", "the axis in the first body's frame and the axis in the second's");
                    return None;
                };
                let here = at.key("axes");
                let [a, b] = axes.items() else { return None };
                let a = self.direction(Some(Node::Plain(a)), &here.index(0));
                let b = self.direction(Some(Node::Plain(b)), &here.index(1));
                JointKind::Universal { axes: [a?, b?] }
            }
            _ => return None,
        })
    }

    /// Options that the kind does not have.
    fn keys_of_kind(&mut self, word: &str, node: Node<'n>, at: &At<'_, 'n>, planar: bool) {
        let sliding = matches!(word, "slider" | "prismatic" | "pin-in-slot");
        let single = matches!(word, "revolute" | "slider" | "prismatic" | "screw");
        for (key, may, why) in [
            ("axis", sliding || !planar && matches!(word, "revolute" | "cylindrical" | "planar" | "screw"), "no axis of its own"),
            ("to", !planar && (sliding || matches!(word, "revolute" | "cylindrical" | "planar" | "screw")), "no axis in the second body"),
            ("rpy", !planar && word != "distance", "no orientation of its own"),
            ("axes", word == "universal", "not two axes"),
            ("pitch", word == "screw", "no pitch"),
            ("length", word == "distance", "no length"),
            ("zero", single, "no single coordinate"),
            ("damping", single, "no single coordinate"),
            ("friction", single, "no single coordinate"),
            ("limits", single, "no single coordinate"),
        ] {
            if node.get(key).is_some() && !may {
                let space = if planar { "planar" } else { "spatial" };
                let fault = self.fault(
                    "unknown-key",
                    &at.key(key),
                    format!("`{key}` in a {space} `{word}`, which has {why}"),
                    format!("an option of `{word}`"),
                );
                fault.spot = Spot::Key;
                fault.help = Some("remove it".to_owned());
            }
        }
    }

    /// A value of a joint's coordinate: an angle or a length.
    pub(super) fn coordinate(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>, coordinate: Option<&Coordinate>) -> Option<Id> {
        self.number(node.get(key), &at.key(key), wanted_of(coordinate))
    }

    /// The joint that a text names, by its index in the model; the fault is reported.
    pub(super) fn joint_named(&mut self, node: Option<Node<'_>>, at: &At<'_, '_>) -> Option<usize> {
        let text = node?.text()?;
        match self.name_space.names.get(text) {
            Some(Entity::Joint(i)) => self.name_space.renumbered.joints.get(*i).copied().flatten(),
            other => {
                let is = other.map(|entity| format!("`{text}` is {}", entity.what()));
                let joints = self.name_space.known(|entity| matches!(entity, Entity::Joint(_)));
                let near = suggest::nearest(text, joints.iter().copied()).map(|near| format!("did you mean `{near}`?"));
                let list = suggest::known(joints.iter().copied()).unwrap_or_else(|| "(there are none)".to_owned());
                let message = is.unwrap_or_else(|| format!("unknown joint `{}`", clip(text)));
                self.fault("unknown-joint", at, message, format!("one of the joints {list}")).help = near;
                None
            }
        }
    }

    /// The joint that a text names and its one coordinate; the fault is reported.
    pub(super) fn driven(&mut self, node: Option<Node<'_>>, at: &At<'_, '_>) -> Option<(usize, &'static Coordinate)> {
        let joint = self.joint_named(node, at)?;
        match self.name_space.single(joint) {
            Some(coordinate) => Some((joint, coordinate)),
            None => {
                let name = self.name_space.model.joints[joint].name.clone();
                self.fault(
                    "wrong-joint",
                    at,
                    format!("`{name}` has no single coordinate"),
                    "a joint with one coordinate: `revolute`, `slider` or `screw`",
                );
                None
            }
        }
    }

    /// Registers that values of a rule hold at a key.
    pub(super) fn check_key(&mut self, rule: Rule, id: Option<Id>, at: &At<'_, 'n>, key: impl Into<&'n str>) {
        if let Some(id) = id {
            self.check(rule, &[id], &at.key(key));
        }
    }
}

/// What a value of a coordinate must be.
pub(super) fn wanted_of(coordinate: Option<&Coordinate>) -> Want {
    match coordinate {
        Some(c) if !c.angle => Want::Of(Dimension::LENGTH),
        _ => Want::Angle,
    }
}
