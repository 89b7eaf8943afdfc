//! Which elements and attributes a URDF has, and whether a file keeps to them.
//!
//! `urdf-rs` passes over what it does not know and drops words that are no numbers, so that a slip of the pen changes the
//! robot in silence. Here every element near to a known one, every missing attribute and every bad number is a fault with
//! its line. What is foreign (`gazebo`, `transmission`, ...) is noted. Source: the XML specification of URDF, wiki.ros.org/urdf/XML.

use super::guard::opening;
use super::notes::Notes;
use crate::model::fault::{Fault, Spot};
use crate::model::suggest;
use crate::model::suggest::clip;
use roxmltree::{Attribute, Node};
use std::ops::Range;

/// What an attribute holds.
#[derive(Clone, Copy, PartialEq)]
enum Holds {
    /// Any text but an empty one.
    Text,
    /// Any text.
    Label,
    /// This many finite numbers.
    Numbers(usize),
    /// This many finite numbers, none negative.
    Sizes(usize),
    /// One number, which may be infinite: no bound.
    Bound,
    /// The size of something at most: one number that is not negative and may be infinite.
    Most,
    /// A word of a list.
    Word(&'static [&'static str]),
}

/// One attribute: its name, what it holds and whether it must be there.
struct Key(&'static str, Holds, bool);

/// One element.
struct Element {
    name: &'static str,
    keys: &'static [Key],
    children: &'static [Child],
    /// Whether just one of the children must be there.
    choice: bool,
}

/// An element inside of another one.
struct Child {
    element: &'static Element,
    required: bool,
    /// Whether it may come more than once.
    many: bool,
}

const fn need(element: &'static Element) -> Child {
    Child { element, required: true, many: false }
}
const fn may(element: &'static Element) -> Child {
    Child { element, required: false, many: false }
}
const fn many(element: &'static Element) -> Child {
    Child { element, required: false, many: true }
}
const fn leaf(name: &'static str, keys: &'static [Key]) -> Element {
    Element { name, keys, children: &[], choice: false }
}

use Holds::{Bound, Label, Most, Numbers, Sizes, Text, Word};

/// Kinds of joints; `spherical` is not in the specification, but `urdf-rs` and several simulators know it.
pub(super) const KINDS: [&str; 7] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];

static ORIGIN: Element = leaf("origin", &[Key("xyz", Numbers(3), false), Key("rpy", Numbers(3), false)]);
static MASS: Element = leaf("mass", &[Key("value", Numbers(1), true)]);
static INERTIA: Element = leaf(
    "inertia",
    &[
        Key("ixx", Numbers(1), true),
        Key("ixy", Numbers(1), true),
        Key("ixz", Numbers(1), true),
        Key("iyy", Numbers(1), true),
        Key("iyz", Numbers(1), true),
        Key("izz", Numbers(1), true),
    ],
);
static INERTIAL: Element = Element { name: "inertial", keys: &[], children: &[may(&ORIGIN), need(&MASS), need(&INERTIA)], choice: false };
static BOX: Element = leaf("box", &[Key("size", Sizes(3), true)]);
static CYLINDER: Element = leaf("cylinder", &[Key("radius", Sizes(1), true), Key("length", Sizes(1), true)]);
static CAPSULE: Element = leaf("capsule", &[Key("radius", Sizes(1), true), Key("length", Sizes(1), true)]);
static SPHERE: Element = leaf("sphere", &[Key("radius", Sizes(1), true)]);
static MESH: Element = leaf("mesh", &[Key("filename", Text, true), Key("scale", Numbers(3), false)]);
static GEOMETRY: Element =
    Element { name: "geometry", keys: &[], children: &[may(&BOX), may(&CYLINDER), may(&CAPSULE), may(&SPHERE), may(&MESH)], choice: true };
static COLOR: Element = leaf("color", &[Key("rgba", Sizes(4), true)]);
static TEXTURE: Element = leaf("texture", &[Key("filename", Label, false)]);
static MATERIAL: Element =
    Element { name: "material", keys: &[Key("name", Label, false)], children: &[may(&COLOR), may(&TEXTURE)], choice: false };
static VISUAL: Element = Element {
    name: "visual",
    keys: &[Key("name", Label, false)],
    children: &[may(&ORIGIN), need(&GEOMETRY), may(&MATERIAL)],
    choice: false,
};
static COLLISION: Element =
    Element { name: "collision", keys: &[Key("name", Label, false)], children: &[may(&ORIGIN), need(&GEOMETRY)], choice: false };
static LINK: Element =
    Element { name: "link", keys: &[Key("name", Text, true)], children: &[may(&INERTIAL), many(&VISUAL), many(&COLLISION)], choice: false };
static PARENT: Element = leaf("parent", &[Key("link", Text, true)]);
static CHILD: Element = leaf("child", &[Key("link", Text, true)]);
static AXIS: Element = leaf("axis", &[Key("xyz", Numbers(3), true)]);
static LIMIT: Element = leaf(
    "limit",
    &[
        Key("lower", Bound, false),
        Key("upper", Bound, false),
        Key("effort", Most, true),
        Key("velocity", Most, true),
        Key("acceleration", Bound, false),
        Key("deceleration", Bound, false),
        Key("jerk", Bound, false),
    ],
);
static DYNAMICS: Element = leaf("dynamics", &[Key("damping", Sizes(1), false), Key("friction", Sizes(1), false)]);
static MIMIC: Element = leaf("mimic", &[Key("joint", Text, true), Key("multiplier", Numbers(1), false), Key("offset", Numbers(1), false)]);
static CALIBRATION: Element = leaf("calibration", &[Key("rising", Numbers(1), false), Key("falling", Numbers(1), false)]);
static SAFETY: Element = leaf(
    "safety_controller",
    &[
        Key("soft_lower_limit", Bound, false),
        Key("soft_upper_limit", Bound, false),
        Key("k_position", Numbers(1), false),
        Key("k_velocity", Numbers(1), true),
    ],
);
static JOINT: Element = Element {
    name: "joint",
    keys: &[Key("name", Text, true), Key("type", Word(&KINDS), true)],
    children: &[
        may(&ORIGIN),
        need(&PARENT),
        need(&CHILD),
        may(&AXIS),
        may(&LIMIT),
        may(&DYNAMICS),
        may(&MIMIC),
        may(&CALIBRATION),
        may(&SAFETY),
    ],
    choice: false,
};
static ROBOT: Element = Element {
    name: "robot",
    keys: &[Key("name", Label, false), Key("version", Label, false)],
    children: &[many(&LINK), many(&JOINT), many(&MATERIAL)],
    choice: false,
};

/// Elements of other programs that stand in URDF files; none of them is taken for a slip of the pen.
const FOREIGN: [&str; 9] = ["gazebo", "transmission", "sensor", "ros2_control", "mujoco", "group", "verbose", "contact", "self_collide"];

/// Elements that are known but mean nothing here.
const UNUSED: [&str; 3] = ["collision", "calibration", "safety_controller"];

/// A walk over a file.
pub(super) struct Walk<'n> {
    /// What was found.
    pub(super) faults: Vec<Fault>,
    /// What is passed over.
    pub(super) notes: &'n mut Notes,
    /// Whether the file says `version="1.2"` or later, where bounds of joints may be missing.
    open_bounds: bool,
}

/// Checks a whole file.
pub(super) fn check(root: Node<'_, '_>, notes: &mut Notes) -> Vec<Fault> {
    let version = root.attribute("version").and_then(|v| v.trim().parse::<f64>().ok()).unwrap_or(1.0);
    let mut walk = Walk { faults: Vec::new(), notes, open_bounds: version >= 1.2 };
    if root.tag_name().name() != "robot" {
        let message = format!("the root element is `<{}>`", clip(root.tag_name().name()));
        walk.fault("not-a-robot", opening(root), message, "`<robot name=\"...\">`").help = Some("name a URDF file".to_owned());
    } else {
        walk.element(root, &ROBOT);
    }
    walk.faults
}

impl Walk<'_> {
    fn fault(&mut self, code: &'static str, at: Range<usize>, message: impl Into<String>, expected: impl Into<String>) -> &mut Fault {
        self.faults.push(Fault::new(code, String::new(), message, expected).at(Spot::Bytes(at)));
        let last = self.faults.len() - 1;
        &mut self.faults[last]
    }

    fn element(&mut self, node: Node<'_, '_>, element: &Element) {
        if UNUSED.contains(&element.name) {
            self.notes.unused(element.name, opening(node).start);
        }
        self.attributes(node, element);
        let mut found: Vec<&'static str> = Vec::new();
        for inner in node.children().filter(Node::is_element) {
            let name = inner.tag_name().name();
            let child = element.children.iter().find(|child| child.element.name == name && inner.tag_name().namespace().is_none());
            match child {
                Some(child) => {
                    if !child.many && found.contains(&child.element.name) {
                        let message = format!("`<{name}>` a second time in `<{}>`", element.name);
                        self.fault("duplicate-element", opening(inner), message, "it once").help = Some("remove one of the two".to_owned());
                    }
                    found.push(child.element.name);
                    self.element(inner, child.element);
                }
                None => self.unknown(inner, element, &mut found),
            }
        }
        for child in element.children.iter().filter(|child| child.required && !found.contains(&child.element.name)) {
            let (name, outer) = (child.element.name, element.name);
            let fault =
                self.fault("missing-element", opening(node), format!("`<{name}>` is missing in `<{outer}>`"), format!("`<{name}>`"));
            fault.help = Some(format!("add `{}`", example(child.element)));
        }
        if element.choice && found.len() != 1 {
            let names: Vec<String> = element.children.iter().map(|child| format!("`<{}>`", child.element.name)).collect();
            let message = if found.is_empty() { "no shape".to_owned() } else { format!("{} shapes", found.len()) };
            let message = format!("{message} in `<{}>`", element.name);
            let fault = self.fault("wrong-shape", opening(node), message, format!("one of {}", names.join(", ")));
            fault.help = Some("give each shape a `<visual>` or `<collision>` of its own".to_owned());
        }
    }

    /// An element that the outer one does not have: a slip of the pen, or something of another program.
    fn unknown(&mut self, node: Node<'_, '_>, outer: &Element, found: &mut Vec<&'static str>) {
        let name = node.tag_name().name();
        if node.tag_name().namespace().is_some_and(|space| space.contains("xacro")) {
            let message = format!("`<xacro:{}>`: this file is xacro, from which a URDF is made", clip(name));
            self.fault("xacro", opening(node), message, "a URDF").help = Some("expand it: `xacro robot.xacro > robot.urdf`".to_owned());
            return;
        }
        let near = suggest::nearest(name, outer.children.iter().map(|child| child.element.name));
        match near.filter(|_| !FOREIGN.contains(&name) && node.tag_name().namespace().is_none()) {
            Some(near) => {
                let message = format!("unknown element `<{}>` in `<{}>`", clip(name), outer.name);
                let names: Vec<String> = outer.children.iter().map(|child| format!("`<{}>`", child.element.name)).collect();
                let fault = self.fault("unknown-element", opening(node), message, format!("one of {}", names.join(", ")));
                fault.help = Some(format!("did you mean `<{near}>`?"));
                found.extend(outer.children.iter().map(|child| child.element.name).find(|known| *known == near));
            }
            None => self.notes.unused(name, opening(node).start),
        }
    }

    fn attributes(&mut self, node: Node<'_, '_>, element: &Element) {
        let mut meant: Vec<&str> = Vec::new();
        for attribute in node.attributes() {
            let name = attribute.name();
            match element.keys.iter().find(|key| key.0 == name) {
                Some(key) => self.value(attribute, key),
                None if name == "quat_xyzw" => {
                    let fault = self.fault("unknown-attribute", attribute.range(), "`quat_xyzw` is not read", "`rpy`, in rad");
                    fault.help = Some("write the orientation as `rpy=\"roll pitch yaw\"`".to_owned());
                }
                None => {
                    let absent = element.keys.iter().map(|key| key.0).filter(|key| !node.has_attribute(*key));
                    if let Some(near) = suggest::nearest(name, absent) {
                        let message = format!("unknown attribute `{}` of `<{}>`", clip(name), element.name);
                        let names: Vec<String> = element.keys.iter().map(|key| format!("`{}`", key.0)).collect();
                        let fault = self.fault("unknown-attribute", attribute.range(), message, format!("one of {}", names.join(", ")));
                        fault.help = Some(format!("did you mean `{near}`?"));
                        meant.push(near);
                    } else {
                        self.notes.unused(&format!("{}/@{name}", element.name), attribute.range().start);
                    }
                }
            }
        }
        for key in element.keys.iter().filter(|key| key.2 && !meant.contains(&key.0) && !node.has_attribute(key.0)) {
            if self.open_bounds && element.name == "limit" {
                continue;
            }
            let message = format!("`{}` is missing in `<{}>`", key.0, element.name);
            self.fault("missing-attribute", opening(node), message, format!("`{}`", key.0)).help = Some(format!("add `{}`", written(key)));
        }
    }

    fn value(&mut self, attribute: Attribute<'_, '_>, key: &Key) {
        let (name, text, at) = (key.0, attribute.value(), attribute.range_value());
        let (count, negative, infinite) = match key.1 {
            Label => return,
            Text => {
                if text.trim().is_empty() {
                    self.fault("empty-attribute", attribute.range(), format!("`{name}` is empty"), "a text").help =
                        Some("write what it is called".to_owned());
                }
                return;
            }
            Word(words) => {
                if !words.contains(&text) {
                    let help = suggest::nearest(text, words.iter().copied()).map(|near| format!("did you mean `{near}`?"));
                    let known = words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
                    self.fault("unknown-word", at, format!("unknown {name} `{}`", clip(text)), format!("one of {known}")).help = help;
                }
                return;
            }
            Numbers(count) => (count, true, false),
            Sizes(count) => (count, false, false),
            Bound => (1, true, true),
            Most => (1, false, true),
        };
        let expected = if count == 1 { "a number".to_owned() } else { format!("{count} numbers with spaces between them") };
        let mut found = 0;
        for word in text.split_whitespace() {
            found += 1;
            let offset = word.as_ptr() as usize - text.as_ptr() as usize;
            // where the file has entities, the value is not the text of the file
            let at = if at.len() == text.len() { at.start + offset..at.start + offset + word.len() } else { at.clone() };
            match word.parse::<f64>() {
                Ok(x) if x.is_nan() || !x.is_finite() && !infinite => {
                    let fault = self.fault("bad-number", at, format!("`{}` in `{name}` is not finite", clip(word)), expected.clone());
                    fault.help = Some("give the number that is meant".to_owned());
                }
                Ok(x) if x < 0.0 && !negative => {
                    let fault = self.fault("negative", at, format!("`{name}` is {x}"), "a value that is not negative");
                    fault.help = Some("check its sign".to_owned());
                }
                Ok(_) => {}
                Err(_) => {
                    let fault = self.fault("bad-number", at, format!("`{}` in `{name}` is not a number", clip(word)), expected.clone());
                    fault.help = Some("write it with a decimal point and without a unit, as `0.1`".to_owned());
                }
            }
        }
        if found != count {
            let words = if found == 1 { "word" } else { "words" };
            let fault = self.fault("wrong-count", at, format!("{found} {words} in `{name}`"), expected);
            fault.help = Some("write as many as are expected".to_owned());
        }
    }
}

/// An attribute as one writes it.
fn written(key: &Key) -> String {
    let value = match key.1 {
        Label | Text | Word(_) => "...".to_owned(),
        Numbers(n) | Sizes(n) => vec!["..."; n].join(" "),
        Bound | Most => "...".to_owned(),
    };
    format!("{}=\"{value}\"", key.0)
}

/// An element as one writes it.
fn example(element: &Element) -> String {
    let keys: Vec<String> = element.keys.iter().filter(|key| key.2).map(|key| format!(" {}", written(key))).collect();
    if element.children.is_empty() { format!("<{}{}/>", element.name, keys.concat()) } else { format!("<{}>...</{0}>", element.name) }
}
