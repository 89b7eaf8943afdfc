//! Joints.

use super::decoder::Decoder;
use super::friction::FRICTION;
use super::stops::LIMITS;
use crate::expression::{Dimension, Id};
use crate::model::coordinates::{Coordinate, coordinates, wanted_of};
use crate::model::entities::{Joint, JointKind};
use crate::model::fault::{At, Spot};
use crate::model::fields::{
    COORDINATE, DAMPING, DIRECTION, ENDS, Field, LENGTH, ROLL_PITCH_YAW, Record, Shape, Size, Want, joined, keys_of, may, one_of,
};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::suggest;
use crate::model::suggest::clip;

keys! {
    /// A joint, beside its kind.
    COMMON = JointKeys "a joint" [] {
        axis: may DIRECTION, "Axis in the first body's frame.";
        to: may DIRECTION, "Spatial: the same axis in the second body's frame; the numbers of `axis` if omitted.";
        rpy: may ROLL_PITCH_YAW,
            "Spatial, instead of `to`: orientation of the second body in the first at 0, turned about x, then y, then z.";
        axes: may Shape::List(&DIRECTION, Size::Exactly(2)), "Universal: axis in the first body's frame, axis in the second's.";
        pitch: may LENGTH, "Screw: advance per turn.";
        length: may LENGTH, "Distance: length of the link; as drawn if omitted.";
        zero: may COORDINATE, "Value of the coordinate where the bodies' axes coincide.";
        damping: may DAMPING, "Viscous damping of the coordinate.";
        friction: may Shape::Map(&FRICTION), "Dry friction.";
        limits: may Shape::Map(&LIMITS), "End stops.";
        cut: may Shape::Flag, "Keep this joint off the spanning tree.";
    }
}

/// A kind of joint, as the format has it.
struct Declared {
    /// Its key: the two points that it connects.
    field: Field,
    /// Whether it exists in the plane, and in space.
    spaces: [bool; 2],
    /// Whether it has an axis in the plane, and in space.
    axis: [bool; 2],
    /// Whether it has one coordinate, with a zero, damping, friction and end stops.
    single: bool,
    /// The key that it alone has.
    own: &'static str,
    /// What it is; `None` if a key of its own is missing or faulty, which was reported then.
    make: for<'n> fn(&mut Decoder<'n>, Given<'_, 'n>) -> Option<JointKind>,
}

/// A joint that is being read.
#[derive(Clone, Copy)]
struct Given<'p, 'n> {
    kind: &'static str,
    keys: JointKeys<'n>,
    at: &'p At<'p, 'n>,
}

impl Declared {
    /// A joint of the plane and of space without axis and coordinate.
    const fn new(key: &'static str, about: &'static str, make: for<'n> fn(&mut Decoder<'n>, Given<'_, 'n>) -> Option<JointKind>) -> Self {
        Self { field: may(key, ENDS, about), spaces: [true; 2], axis: [false; 2], single: false, own: "", make }
    }
}

/// The kinds of joints; the first-named point's body carries the axis.
const KINDS: [Declared; 11] = [
    Declared { axis: [false, true], single: true, ..Declared::new("revolute", "Hinge of two points.", |_, _| Some(JointKind::Revolute)) },
    Declared {
        axis: [true; 2],
        single: true,
        ..Declared::new("slider", "The second's point slides along `axis` of the first; no rotation.", |_, _| Some(JointKind::Slider))
    },
    Declared { axis: [true; 2], single: true, ..Declared::new("prismatic", "The same as `slider`.", |_, _| Some(JointKind::Slider)) },
    Declared {
        spaces: [true, false],
        axis: [true; 2],
        ..Declared::new("pin-in-slot", "Planar: the second's point slides in a slot of the first along `axis`.", |_, _| {
            Some(JointKind::PinInSlot)
        })
    },
    Declared::new("fixed", "Holds two bodies together.", |_, _| Some(JointKind::Fixed)),
    Declared {
        own: "length",
        ..Declared::new("distance", "Massless link: holds the distance of two points.", |decoder, given| {
            Some(JointKind::Distance { length: decoder.size(given.keys.length, given.at, "the length") })
        })
    },
    Declared {
        spaces: [false, true],
        axis: [false, true],
        ..Declared::new("cylindrical", "Spatial: turns about and slides along `axis`.", |_, _| Some(JointKind::Cylindrical))
    },
    Declared {
        spaces: [false, true],
        axis: [false, true],
        ..Declared::new("planar", "Spatial: the second's point moves in the plane normal to `axis`.", |_, _| Some(JointKind::Planar))
    },
    Declared {
        spaces: [false, true],
        axis: [false, true],
        single: true,
        own: "pitch",
        ..Declared::new("screw", "Spatial: turns about `axis` and moves `pitch` a turn.", |decoder, given| {
            decoder.wanted(given.keys.pitch, given, "the advance per turn (m)");
            Some(JointKind::Screw { pitch: decoder.read(given.keys.pitch, given.at)? })
        })
    },
    Declared {
        spaces: [false, true],
        own: "axes",
        ..Declared::new("universal", "Spatial: two crossed hinges, `axes`.", |decoder, given| {
            let axes = given.keys.axes;
            decoder.wanted(axes, given, "the axis in the first body's frame and the axis in the second's");
            let here = given.at.key(axes);
            let [a, b] = axes.items() else { return None };
            let a = decoder.direction(Some(Node::Plain(a)), &here.index(0));
            let b = decoder.direction(Some(Node::Plain(b)), &here.index(1));
            Some(JointKind::Universal { axes: [a?, b?] })
        })
    },
    Declared { spaces: [false, true], ..Declared::new("spherical", "Spatial: ball joint.", |_, _| Some(JointKind::Spherical)) },
];

/// What the kinds declare.
const OF_KINDS: [Field; KINDS.len()] = {
    let mut fields = [KINDS[0].field; KINDS.len()];
    let mut i = 0;
    while i < fields.len() {
        fields[i] = KINDS[i].field;
        i += 1;
    }
    fields
};

/// Their keys.
const NAMES: [&str; KINDS.len()] = keys_of(&OF_KINDS);

/// A joint: the key of one of the kinds, and what all kinds share.
pub(crate) static JOINT: Record = Record {
    what: COMMON.what,
    choices: &[one_of(&NAMES)],
    fields: &joined::<{ KINDS.len() + JointKeys::FIELDS.len() }>(&OF_KINDS, JointKeys::FIELDS),
};

impl<'n> Decoder<'n> {
    pub(super) fn joints(&mut self) {
        let section = At::ROOT.key("joints");
        let all = self.section("joints");
        self.name_space.model.joints.reserve_exact(all.len());
        for (name, node) in all {
            let joint = self.joint(name, node, &section.key(name));
            let index = joint.map(|joint| {
                self.name_space.model.joints.push(joint);
                self.name_space.model.joints.len() - 1
            });
            self.name_space.renumbered.joints.push(index);
        }
    }

    fn joint(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Option<Joint> {
        let keys = JointKeys::of(node);
        let Some(kind) = KINDS.iter().find(|kind| node.get(kind.field.key).is_some()) else {
            // a misspelt kind was reported: its points are read all the same
            let misspelt = node.entries().into_iter().find(|(key, _)| suggest::nearest(key, NAMES).is_some());
            misspelt.and_then(|(key, ends)| self.two_points(ends, &at.key(key)));
            return None;
        };
        let word = kind.field.key;
        let ends = self.ends(Entry::of(&kind.field, node), at);
        let space = usize::from(self.name_space.components() == 3);
        if !kind.spaces[space] {
            let (here, code) = [("planar", "spatial-only"), ("spatial", "planar-only")][space];
            let fault =
                self.fault(code, &at.key(word), format!("`{word}` does not exist in a {here} model"), format!("a joint of a {here} model"));
            fault.spot = Spot::Key;
            let others: Vec<String> = KINDS.iter().filter(|kind| kind.spaces[space]).map(|kind| format!("`{}`", kind.field.key)).collect();
            fault.help = Some(format!("take one of {}, or write `space: {}`", others.join(", "), ["spatial", "planar"][space]));
            return None;
        }
        let declared = kind;
        let kind = (declared.make)(self, Given { kind: word, keys, at })?;
        self.keys_of_kind(declared, keys, at, space);
        let single = match coordinates(&kind) {
            [one] => Some(one),
            _ => None,
        };
        let axis = self.direction(keys.axis.node, &at.key(keys.axis));
        let to = self.direction(keys.to.node, &at.key(keys.to));
        let effort = single.map_or(Dimension::TORQUE, Coordinate::effort);
        let rate = single.map_or(Dimension::ANGULAR_SPEED, |c| c.dimension(1));
        let rpy_at = at.key(keys.rpy);
        if keys.rpy.given() && keys.to.given() {
            let fault = self.fault("two-kinds", &rpy_at, "`rpy` beside `to`", "only one of `to`, `rpy`");
            fault.spot = Spot::Key;
            fault.help = Some("remove one of the two".to_owned());
        }
        let rpy = keys.rpy.node.and_then(|rpy| self.roll_pitch_yaw(rpy, &rpy_at));
        let zero = self.read_as(keys.zero, at, wanted_of(single));
        let damping = self.read_of(keys.damping, at, effort.div(rate));
        self.check_key(Rule::NotNegative("the damping"), damping, at, keys.damping);
        let friction = keys.friction.node.and_then(|inner| self.friction((name, &kind), inner, &at.key(keys.friction), single));
        let limits = keys.limits.node.map(|inner| self.limits(name, inner, &at.key(keys.limits), single));
        let (limit, stops) = limits.unwrap_or_default();
        let cut = keys.cut.flag();
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

    /// The two points of an entry `[a, b]`, which belong to different bodies.
    pub(super) fn ends(&mut self, entry: Entry<'n>, at: &At<'_, 'n>) -> Option<(PointRef, PointRef)> {
        self.two_points(entry.node?, &at.key(entry))
    }

    fn two_points(&mut self, node: Node<'n>, here: &At<'_, 'n>) -> Option<(PointRef, PointRef)> {
        let [a, b] = node.items() else { return None };
        let a = self.point(Some(Node::Plain(a)), &here.index(0));
        let b = self.point(Some(Node::Plain(b)), &here.index(1));
        let (a, b) = (a?, b?);
        if a.body == b.body {
            let name = self.name_space.model.bodies[a.body].name.clone();
            let others = self.name_space.known(|entity| matches!(entity, Entity::Body(_)));
            let other = others.iter().find(|other| **other != name).copied().unwrap_or("ground");
            self.fault("same-body", here, format!("both points belong to `{name}`"), "points of two bodies").help =
                Some(format!("put a point of another body, as of `{other}`, in the place of one of them"));
            return None;
        }
        Some((a, b))
    }

    /// Reports a key of its own that a joint lacks.
    fn wanted(&mut self, entry: Entry<'n>, given: Given<'_, 'n>, expected: &str) {
        if !entry.given() {
            let (word, key) = (given.kind, entry.key());
            let fault = self.fault("missing-key", given.at, format!("`{word}` needs `{key}`"), expected.to_owned());
            fault.spot = Spot::Key;
            fault.help = Some(format!("add `{key}:`"));
        }
    }

    /// Options that the kind does not have.
    fn keys_of_kind(&mut self, kind: &Declared, keys: JointKeys<'n>, at: &At<'_, 'n>, space: usize) {
        let spatial = space == 1;
        let own = |entry: Entry<'n>| kind.own == entry.key();
        let word = kind.field.key;
        for (entry, may, why) in [
            (keys.axis, kind.axis[space], "no axis of its own"),
            (keys.to, spatial && kind.axis[1], "no axis in the second body"),
            (keys.rpy, spatial && !own(keys.length), "no orientation of its own"),
            (keys.axes, own(keys.axes), "not two axes"),
            (keys.pitch, own(keys.pitch), "no pitch"),
            (keys.length, own(keys.length), "no length"),
            (keys.zero, kind.single, "no single coordinate"),
            (keys.damping, kind.single, "no single coordinate"),
            (keys.friction, kind.single, "no single coordinate"),
            (keys.limits, kind.single, "no single coordinate"),
        ] {
            if entry.given() && !may {
                let (key, space) = (entry.key(), ["planar", "spatial"][space]);
                let fault = self.fault(
                    "unknown-key",
                    &at.key(entry),
                    format!("`{key}` in a {space} `{word}`, which has {why}"),
                    format!("an option of `{word}`"),
                );
                fault.spot = Spot::Key;
                let turned = key == "rpy" && space == "planar" && word == "slider";
                let help =
                    if turned { "remove it; the body does not turn there: give its points and `drawn` as they stand" } else { "remove it" };
                fault.help = Some(help.to_owned());
            }
        }
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
                self.fault("unknown-joint", at, message, format!("one of the joints {list}")).help =
                    Some(near.unwrap_or_else(|| suggest::take_or_add(text, "joints")));
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
