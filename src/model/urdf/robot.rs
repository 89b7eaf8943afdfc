//! A robot as `urdf-rs` reads it, beside the elements that it stands in, and whether it can exist.

use super::guard::opening;
use super::inertia::{self, Tensor};
use super::notes::Notes;
use crate::model::fault::{Fault, Spot};
use crate::model::rules::{impossible, negative_moment};
use crate::model::suggest;
use crate::model::suggest::clip;
use roxmltree::Node;
use std::collections::HashMap;
use std::ops::Range;
use urdf_rs::JointType;

/// An inertia below this is what a program left of 0, kg m²: a milligram has more at a tenth of a millimetre.
const ROUND_OFF: f64 = 1e-16;

/// A robot whose parts refer to each other.
pub(super) struct Robot<'a, 'i> {
    pub(super) name: String,
    pub(super) links: Vec<Link<'a, 'i>>,
    pub(super) joints: Vec<Joint<'a, 'i>>,
    /// The one link that is the child of no joint.
    pub(super) root: usize,
}

/// A link and its element.
pub(super) struct Link<'a, 'i> {
    pub(super) data: urdf_rs::Link,
    pub(super) node: Node<'a, 'i>,
    /// Inertia in the axes of the link about its centre of mass, kg m².
    pub(super) inertia: Tensor,
    /// Whether no real body has that inertia, though its moments are not negative.
    pub(super) fictitious: bool,
}

/// A joint and its element.
pub(super) struct Joint<'a, 'i> {
    pub(super) data: urdf_rs::Joint,
    pub(super) node: Node<'a, 'i>,
    pub(super) parent: usize,
    pub(super) child: usize,
    /// The joint that it follows.
    pub(super) master: Option<usize>,
}

impl Link<'_, '_> {
    /// True if it has neither mass nor inertia.
    pub(super) fn massless(&self) -> bool {
        self.data.inertial.mass.value == 0.0 && self.inertia.iter().flatten().all(|x| *x == 0.0)
    }
}

impl<'a, 'i> Joint<'a, 'i> {
    /// The element of this name inside of the joint.
    pub(super) fn element(&self, name: &str) -> Option<Node<'a, 'i>> {
        element(self.node, name)
    }

    /// Whether its one coordinate is an angle; `None` if it has not one coordinate.
    pub(super) fn turns(&self) -> Option<bool> {
        match self.data.joint_type {
            JointType::Revolute | JointType::Continuous => Some(true),
            JointType::Prismatic => Some(false),
            JointType::Fixed | JointType::Floating | JointType::Planar | JointType::Spherical => None,
        }
    }

    /// Position limits, infinite where there is none; `None` for a joint that has none at all.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        let bounded = matches!(self.data.joint_type, JointType::Revolute | JointType::Prismatic);
        let (low, high) = (self.data.limit.lower, self.data.limit.upper);
        (bounded && (low.is_finite() || high.is_finite())).then_some((low, high))
    }
}

/// The element of a name inside of another one.
pub(super) fn element<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|inner| inner.has_tag_name(name))
}

/// Reads a file that keeps to the grammar.
pub(super) fn read<'a, 'i>(root: Node<'a, 'i>, notes: &mut Notes) -> Result<Robot<'a, 'i>, Vec<Fault>> {
    let data = urdf_rs::read_from_string(&used(root)).map_err(|error| {
        let fault = Fault::new("urdf", String::new(), format!("this is no URDF: {error}"), "a URDF");
        vec![fault.at(Spot::Bytes(opening(root)))]
    })?;
    let nodes = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
    let mut checks = Checks { faults: Vec::new(), notes };
    let links: Vec<Link<'a, 'i>> = data.links.into_iter().zip(nodes("link")).map(|(data, node)| checks.link(data, node)).collect();
    let by_name = checks.distinct(links.iter().map(|link| (link.data.name.as_str(), link.node)), "link");
    let mut joints = Vec::new();
    for (data, node) in data.joints.into_iter().zip(nodes("joint")) {
        let parent = checks.named(node, "parent", &data.parent.link, &by_name);
        let child = checks.named(node, "child", &data.child.link, &by_name);
        checks.joint(&data, node);
        // an unknown link is a fault already, and the joint is not used
        joints.push(Joint { data, node, parent: parent.unwrap_or(0), child: child.unwrap_or(0), master: None });
    }
    checks.mimics(&mut joints);
    let sound = checks.faults.is_empty();
    let tree = if sound { checks.tree(root, &links, &joints) } else { None };
    match tree {
        Some(tree) if checks.faults.is_empty() => Ok(Robot { name: data.name, links, joints, root: tree }),
        _ => Err(checks.faults),
    }
}

/// The text without what no model uses, so that `urdf-rs` does not stumble over a material without a name.
fn used(root: Node<'_, '_>) -> String {
    let text = root.document().input_text();
    let mut out = String::with_capacity(text.len());
    let mut from = 0;
    for node in root.descendants().filter(Node::is_element) {
        let name = node.tag_name().name();
        let unused = match node.parent_element().map(|parent| parent.tag_name().name()) {
            Some("robot") => !["link", "joint"].contains(&name),
            Some("link") => !["inertial", "visual"].contains(&name),
            Some("visual") => !["origin", "geometry"].contains(&name),
            Some("joint") => ["calibration", "safety_controller"].contains(&name),
            _ => false,
        };
        let range = node.range();
        if unused && range.start >= from {
            out.push_str(&text[from..range.start]);
            from = range.end;
        }
    }
    out.push_str(&text[from..]);
    out
}

/// Checks of meaning.
struct Checks<'n> {
    faults: Vec<Fault>,
    notes: &'n mut Notes,
}

impl Checks<'_> {
    fn fault(&mut self, code: &'static str, at: Range<usize>, message: impl Into<String>, expected: impl Into<String>) -> &mut Fault {
        self.faults.push(Fault::new(code, String::new(), message, expected).at(Spot::Bytes(at)));
        let last = self.faults.len() - 1;
        &mut self.faults[last]
    }

    /// Mass and inertia: none negative; what breaks the triangle inequality is kept and noted.
    fn link<'a, 'i>(&mut self, data: urdf_rs::Link, node: Node<'a, 'i>) -> Link<'a, 'i> {
        let inertial = &data.inertial;
        let mut inertia = inertia::turned(&inertial.inertia, &inertial.origin.rpy);
        let at = |name: &str| element(node, "inertial").and_then(|node| element(node, name)).map_or(opening(node), opening);
        let (mass, name) = (inertial.mass.value, clip(&data.name));
        if mass < 0.0 {
            self.fault("negative", at("mass"), format!("the mass of `{name}` is {mass} kg"), "a mass that is not negative").help =
                Some("check its sign".to_owned());
        }
        let largest = inertia.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        if largest > 0.0 && largest < ROUND_OFF {
            inertia = inertia::Tensor::default();
            self.notes.about("an inertia that is round-off, read as 0: {}", data.name.clone(), at("inertia").start);
        }
        let figures = inertia::figures(&inertia);
        let mut fictitious = false;
        if let Some(why) = negative_moment(&figures) {
            let fault =
                self.fault("impossible-inertia", at("inertia"), format!("{why}, of `{name}`"), "principal moments that are not negative");
            fault.help = Some("check the figures: no rotation of axes makes such a tensor".to_owned());
        } else if let Some(why) = impossible(&figures) {
            fictitious = true;
            self.notes.about("an inertia that no real body has, kept as given: {}", format!("{} ({why})", data.name), at("inertia").start);
        }
        Link { data, node, inertia, fictitious }
    }

    /// Indices by name; a name that is taken is a fault.
    fn distinct<'x, 'a: 'x, 'i: 'a>(&mut self, all: impl Iterator<Item = (&'x str, Node<'a, 'i>)>, what: &str) -> HashMap<String, usize> {
        let mut by_name: HashMap<String, usize> = HashMap::new();
        let mut first: HashMap<&str, Range<usize>> = HashMap::new();
        for (index, (name, node)) in all.enumerate() {
            let at = node.attribute_node("name").map_or(opening(node), |attribute| attribute.range_value());
            if let Some(earlier) = first.get(name) {
                let earlier = earlier.clone();
                let fault = self.fault("duplicate-name", at, format!("a second {what} `{}`", clip(name)), format!("one {what} of a name"));
                fault.help = Some("rename one of the two".to_owned());
                fault.other = Some((earlier, "the first one".to_owned()));
            } else {
                first.insert(name, at);
                by_name.insert(name.to_owned(), index);
            }
        }
        by_name
    }

    /// The link that `<parent>` or `<child>` names.
    fn named(&mut self, joint: Node<'_, '_>, role: &str, link: &str, links: &HashMap<String, usize>) -> Option<usize> {
        if let Some(index) = links.get(link) {
            return Some(*index);
        }
        let at = element(joint, role).and_then(|node| node.attribute_node("link")).map_or(opening(joint), |a| a.range_value());
        let mut known: Vec<&str> = links.keys().map(String::as_str).collect();
        known.sort_unstable();
        let list = suggest::known(known.iter().copied()).unwrap_or_else(|| "(there are none)".to_owned());
        let near = suggest::nearest(link, known);
        let near = near.map_or_else(|| format!("add `<link name=\"{}\"/>`", clip(link)), |near| format!("did you mean `{near}`?"));
        self.fault("unknown-link", at, format!("unknown link `{}`", clip(link)), format!("one of the links {list}")).help = Some(near);
        None
    }

    /// Axis and limits of a joint.
    fn joint(&mut self, data: &urdf_rs::Joint, node: Node<'_, '_>) {
        let name = clip(&data.name);
        let has_axis = matches!(data.joint_type, JointType::Revolute | JointType::Continuous | JointType::Prismatic | JointType::Planar);
        if has_axis && data.axis.xyz.0 == [0.0; 3] {
            let at = element(node, "axis").map_or(opening(node), opening);
            self.fault("zero-axis", at, format!("the axis of `{name}` is zero"), "a direction").help =
                Some("for example `xyz=\"0 0 1\"`".to_owned());
        }
        if !matches!(data.joint_type, JointType::Revolute | JointType::Prismatic) {
            return;
        }
        let Some(limit) = element(node, "limit") else {
            let word = if data.joint_type == JointType::Revolute { "revolute" } else { "prismatic" };
            self.notes.about(
                "joints without the `<limit>` that a URDF gives them, read as free of limits: {}",
                format!("{} ({word})", data.name),
                opening(node).start,
            );
            return;
        };
        let (low, high) = (data.limit.lower, data.limit.upper);
        if low > high {
            self.fault("not-rising", opening(limit), format!("the limits of `{name}` go from {low} to {high}"), "`lower` below `upper`")
                .help = Some("exchange `lower` and `upper`".to_owned());
        } else if low == high {
            self.notes.about("limits that leave no motion, read as a joint that moves: {}", data.name.clone(), opening(limit).start);
        }
    }

    /// Joints that follow others: both have one coordinate, and nobody follows himself.
    fn mimics(&mut self, joints: &mut [Joint<'_, '_>]) {
        let by_name = self.distinct(joints.iter().map(|joint| (joint.data.name.as_str(), joint.node)), "joint");
        for index in 0..joints.len() {
            let Some(mimic) = &joints[index].data.mimic else { continue };
            let node = joints[index].element("mimic").unwrap_or(joints[index].node);
            let at = node.attribute_node("joint").map_or(opening(node), |attribute| attribute.range_value());
            let name = clip(&mimic.joint);
            if joints[index].data.joint_type == JointType::Fixed {
                self.notes.about("`<mimic>` of a fixed joint, not used: {}", joints[index].data.name.clone(), opening(node).start);
                continue;
            }
            match by_name.get(&mimic.joint) {
                None => {
                    let mut known: Vec<&str> = by_name.keys().map(String::as_str).collect();
                    known.sort_unstable();
                    let near = suggest::nearest(&mimic.joint, known.iter().copied());
                    let near =
                        near.map_or("name a joint of this file, or remove `<mimic>`".to_owned(), |near| format!("did you mean `{near}`?"));
                    let list = suggest::known(known).unwrap_or_default();
                    self.fault("unknown-joint", at, format!("unknown joint `{name}`"), format!("one of the joints {list}")).help =
                        Some(near);
                }
                Some(master) if joints[*master].turns().is_none() || joints[index].turns().is_none() => {
                    let without = if joints[*master].turns().is_none() { &joints[*master] } else { &joints[index] };
                    let message = format!("`{}` has no single coordinate", clip(&without.data.name));
                    self.fault("wrong-joint", at, message, "revolute, continuous or prismatic joints").help =
                        Some("remove `<mimic>`".to_owned());
                }
                Some(master) => joints[index].master = Some(*master),
            }
        }
        for index in 0..joints.len() {
            let mut at = joints[index].master;
            for _ in 0..joints.len() {
                at = at.and_then(|master| joints[master].master);
            }
            if at.is_some() {
                // every chain of masters ends, unless it runs in a circle
                let node = joints[index].element("mimic").unwrap_or(joints[index].node);
                let message = format!("`{}` follows itself", clip(&joints[index].data.name));
                self.fault("cycle", opening(node), message, "a joint that moves of its own at the end of the chain").help =
                    Some("remove one `<mimic>` of the circle".to_owned());
            }
        }
    }

    /// The root, if every other link is the child of one joint and hangs on the root.
    fn tree(&mut self, root: Node<'_, '_>, links: &[Link<'_, '_>], joints: &[Joint<'_, '_>]) -> Option<usize> {
        let mut carried: Vec<Option<usize>> = vec![None; links.len()];
        for (index, joint) in joints.iter().enumerate() {
            let at = joint.element("child").map_or(opening(joint.node), opening);
            let name = clip(&links[joint.child].data.name);
            if let Some(first) = carried[joint.child] {
                let earlier = joints[first].element("child").map_or(opening(joints[first].node), opening);
                let fault =
                    self.fault("two-parents", at, format!("`{name}` is the child of two joints"), "a tree: one joint leads to a link");
                fault.help = Some("close loops in a model that includes this file, with `joints`".to_owned());
                fault.other = Some((earlier, "the first one".to_owned()));
            } else {
                carried[joint.child] = Some(index);
            }
        }
        let roots: Vec<usize> = (0..links.len()).filter(|link| carried[*link].is_none()).collect();
        let [one] = roots[..] else {
            if links.is_empty() {
                self.fault("no-links", opening(root), "the robot has no links", "at least one `<link>`").help =
                    Some("add `<link name=\"...\">`".to_owned());
            } else if roots.is_empty() {
                self.fault("cycle", opening(root), "every link is the child of a joint", "one link that is the child of no joint").help =
                    Some("remove the joint that leads to the root".to_owned());
            }
            for pair in roots.windows(2) {
                let (first, other) = (&links[pair[0]], &links[pair[1]]);
                let message = format!("`{}` is the child of no joint, and neither is `{}`", clip(&other.data.name), clip(&first.data.name));
                let fault = self.fault("two-roots", opening(other.node), message, "one root");
                fault.help = Some(format!("join it by a joint, as `<joint type=\"fixed\">` with the child `{}`", clip(&other.data.name)));
                fault.other = Some((opening(first.node), "the other root".to_owned()));
            }
            return None;
        };
        self.connected(one, links, joints);
        Some(one)
    }

    /// What does not hang on the root runs in a circle.
    fn connected(&mut self, root: usize, links: &[Link<'_, '_>], joints: &[Joint<'_, '_>]) {
        let mut reached = vec![false; links.len()];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); links.len()];
        joints.iter().for_each(|joint| children[joint.parent].push(joint.child));
        let mut open = vec![root];
        while let Some(link) = open.pop() {
            if !std::mem::replace(&mut reached[link], true) {
                open.extend(&children[link]);
            }
        }
        if let Some(lost) = joints.iter().find(|joint| !reached[joint.child]) {
            let message = format!("`{}` does not hang on the root `{}`", clip(&links[lost.child].data.name), clip(&links[root].data.name));
            let at = lost.element("parent").map_or(opening(lost.node), opening);
            self.fault("cycle", at, message, "joints that lead from the root to every link").help =
                Some("the joints from here on run in a circle: give one of them another parent".to_owned());
        }
    }
}
