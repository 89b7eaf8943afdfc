//! A robot as sections of a model: one body a link, one joint a joint.
//!
//! Body frames are the link frames of the URDF, joint coordinates its joint positions: with the origin (p, R) of a joint and
//! its axis u in the child, the child stands in the parent at T(p) · exp(R u, q) · R, which is `rpy` and `axis: R u` here.

use super::constant::Constant;
use super::finite;
use super::guard::opening;
use super::inertia::figures;
use super::names::Names;
use super::notes::Notes;
use super::options::{Base, Options};
use super::robot::{Joint, Link, Robot, element};
use super::rotation::{apply, axis_angle, product, roll_pitch_yaw};
use super::translation::Translation;
use crate::model::fault::{Fault, Spot};
use serde_yaml::{Mapping, Value};
use std::collections::HashMap;
use std::ops::Range;
use urdf_rs::{Geometry, JointType};

/// Depth, rad and m, to which the effort of a joint presses it into its stop.
const STOP_DEPTH: [f64; 2] = [0.01, 0.001];
/// Stiffness of the stops of a joint without a limit of its effort, N m/rad and N/m.
const STOP_STIFFNESS: [f64; 2] = [1e3, 1e5];

/// Translates a robot.
pub(super) fn translate(robot: &Robot<'_, '_>, options: &Options<'_>, notes: &mut Notes) -> Result<Translation, Vec<Fault>> {
    let names = Names::new(robot, options.prefix, notes);
    let empty = Translation { sections: Mapping::new(), base: None, places: HashMap::new(), remarks: HashMap::new() };
    let mut work = Work { robot, options, names, notes, out: empty, faults: Vec::new(), start: Mapping::new(), ground: Mapping::new() };
    let mut joints = Mapping::new();
    let points = work.joint_points();
    work.base(&mut joints);
    for index in 0..robot.joints.len() {
        work.joint(index, &points, &mut joints);
    }
    let mut bodies = Mapping::new();
    for index in 0..robot.links.len() {
        let body = work.body(index, &points);
        bodies.insert(work.names.links[index].clone().into(), body.into());
    }
    let couplings = work.mimics();
    work.leaves();
    for (key, section) in [
        ("ground", std::mem::take(&mut work.ground)),
        ("bodies", bodies),
        ("joints", joints),
        ("couplings", couplings),
        ("start", std::mem::take(&mut work.start)),
    ] {
        if !section.is_empty() {
            work.out.sections.insert(key.into(), section.into());
        }
    }
    work.faults.extend(finite::check(&work.out));
    if work.faults.is_empty() { Ok(work.out) } else { Err(work.faults) }
}

/// A translation on its way.
struct Work<'r, 'a, 'i> {
    robot: &'r Robot<'a, 'i>,
    options: &'r Options<'r>,
    names: Names,
    notes: &'r mut Notes,
    out: Translation,
    faults: Vec<Fault>,
    start: Mapping,
    ground: Mapping,
}

/// A number without round-off of a value that is zero.
fn number(x: f64) -> Value {
    Value::from(if x.abs() < 1e-15 { 0.0 } else { x })
}

fn vector(x: [f64; 3]) -> Value {
    Value::Sequence(x.map(number).to_vec())
}

fn quantity(x: f64, unit: &str) -> Value {
    Value::from(format!("{} {unit}", shortest(x)))
}

/// The shortest text that reads back to the same bits.
pub(super) fn shortest(x: f64) -> String {
    let text = format!("{x:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

impl Work<'_, '_, '_> {
    fn place(&mut self, path: String, at: Range<usize>) {
        self.out.places.insert(path, at);
    }

    /// The point of the parent where each joint sits: a name of its own, or none where it is the parent's origin.
    fn joint_points(&self) -> Vec<Option<String>> {
        let robot = self.robot;
        let point = |(index, joint): (usize, &Joint<'_, '_>)| {
            (joint.data.origin.xyz.0 != [0.0; 3] && joint.data.joint_type != JointType::Floating).then(|| self.names.points[index].clone())
        };
        robot.joints.iter().enumerate().map(point).collect()
    }

    /// How the root stands on the ground.
    fn base(&mut self, joints: &mut Mapping) {
        let root = self.names.links[self.robot.root].clone();
        let at = opening(self.robot.links[self.robot.root].node);
        if self.options.base == Base::Free {
            if self.robot.links[self.robot.root].data.name == "world" {
                let fault = Fault::new("fixed-base", String::new(), "the root is `world`, which is the ground", "a root that can be free");
                self.faults.push(fault.at(Spot::Bytes(at)).help("leave out `base: free`"));
                return;
            }
            self.free(self.robot.root, [0.0; 3], roll_pitch_yaw([0.0; 3]));
            return;
        }
        let name = self.names.fresh(&format!("{}mount", self.options.prefix));
        let mut joint = Mapping::new();
        let first = match self.options.at {
            Some(at) => {
                self.ground.insert(name.clone().into(), at.clone());
                format!("ground.{name}")
            }
            None => "ground".to_owned(),
        };
        joint.insert("fixed".into(), Value::Sequence(vec![first.into(), root.into()]));
        if let Some(rpy) = self.options.rpy {
            joint.insert("rpy".into(), rpy.clone());
        }
        self.place(format!("joints.{name}"), at);
        self.out.base = Some(name.clone());
        joints.insert(name.into(), joint.into());
    }

    /// Start values of a link that no joint carries, whose place in the root is known.
    fn free(&mut self, link: usize, p: [f64; 3], r: [[f64; 3]; 3]) {
        let node = self.robot.links[link].node;
        let mut read = |value: Option<&Value>, angle| match value.map_or(Ok([0.0; 3]), |value| Constant { angle }.vector(value)) {
            Ok(x) => x,
            Err(why) => {
                let key = if angle { "rpy" } else { "at" };
                let fault =
                    Fault::new("not-constant", String::new(), format!("`{key}` of a robot with a free link: {why}"), "numbers with units");
                self.faults.push(
                    fault.at(Spot::Bytes(opening(node))).help(format!(
                        "write `{key}` without parameters, or leave it out and give `start` of `{}`",
                        self.names.links[link]
                    )),
                );
                [0.0; 3]
            }
        };
        let (at, turned) = (read(self.options.at, false), roll_pitch_yaw(read(self.options.rpy, true)));
        let moved = apply(&turned, p);
        let name = self.names.links[link].clone();
        for (key, x) in ["x", "y", "z"].into_iter().zip([at[0] + moved[0], at[1] + moved[1], at[2] + moved[2]]) {
            let key = format!("{name}.{key}");
            self.place(format!("start.{key}"), opening(node));
            self.start.insert(key.into(), number(x));
        }
        let (axis, angle) = axis_angle(&product(&turned, &r));
        let mut rotation = Mapping::new();
        rotation.insert("axis".into(), vector(axis));
        rotation.insert("angle".into(), number(angle));
        self.place(format!("start.{name}.rotation"), opening(node));
        self.start.insert(format!("{name}.rotation").into(), rotation.into());
    }

    /// Place of a link in the root with all coordinates 0.
    fn drawn(&self, link: usize) -> ([f64; 3], [[f64; 3]; 3]) {
        let (mut p, mut r) = ([0.0; 3], roll_pitch_yaw([0.0; 3]));
        let mut at = link;
        while let Some(joint) = self.robot.joints.iter().find(|joint| joint.child == at) {
            let origin = &joint.data.origin;
            let turn = roll_pitch_yaw(origin.rpy.0);
            let moved = apply(&turn, p);
            p = std::array::from_fn(|i| moved[i] + origin.xyz.0[i]);
            r = product(&turn, &r);
            at = joint.parent;
        }
        (p, r)
    }

    fn joint(&mut self, index: usize, points: &[Option<String>], joints: &mut Mapping) {
        let joint = &self.robot.joints[index];
        let kind = match joint.data.joint_type {
            JointType::Revolute | JointType::Continuous => "revolute",
            JointType::Prismatic => "prismatic",
            JointType::Fixed => "fixed",
            JointType::Planar => "planar",
            JointType::Spherical => "spherical",
            JointType::Floating => {
                self.unused_dynamics(joint);
                let (p, r) = self.drawn(joint.child);
                let (name, child) = (joint.data.name.clone(), self.names.links[joint.child].clone());
                self.notes.about(
                    "a floating joint is no joint, its link is free: {}",
                    format!("{name} ({child})"),
                    opening(joint.node).start,
                );
                return self.free(joint.child, p, r);
            }
        };
        let name = self.names.joints[index].clone();
        let (parent, child) = (&self.names.links[joint.parent], &self.names.links[joint.child]);
        let first = points[index].as_ref().map_or(parent.clone(), |point| format!("{parent}.{point}"));
        let mut out = Mapping::new();
        out.insert(kind.into(), Value::Sequence(vec![first.into(), child.clone().into()]));
        let rpy = joint.data.origin.rpy.0;
        if !matches!(kind, "fixed" | "spherical") {
            let u = joint.data.axis.xyz.0;
            // the largest component first: squares of large numbers are infinite
            let largest = u.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let u = u.map(|x| x / largest);
            let size = u.iter().map(|x| x * x).sum::<f64>().sqrt();
            out.insert("axis".into(), vector(apply(&roll_pitch_yaw(rpy), u.map(|x| x / size))));
        }
        if rpy != [0.0; 3] {
            out.insert("rpy".into(), Value::Sequence(rpy.map(Value::from).to_vec()));
        }
        let path = format!("joints.{name}");
        self.place(path.clone(), opening(joint.node));
        for (key, tag) in [("axis", "axis"), ("rpy", "origin"), ("damping", "dynamics"), ("friction", "dynamics"), ("limits", "limit")] {
            if let Some(node) = joint.element(tag) {
                self.place(format!("{path}.{key}"), opening(node));
            }
        }
        match joint.turns() {
            Some(turns) => self.dynamics(joint, turns, &mut out),
            None => self.unused_dynamics(joint),
        }
        self.limits(joint, &path, &mut out);
        joints.insert(name.into(), out.into());
    }

    /// Viscous and dry friction.
    fn dynamics(&mut self, joint: &Joint<'_, '_>, turns: bool, out: &mut Mapping) {
        let Some(dynamics) = &joint.data.dynamics else { return };
        if dynamics.damping > 0.0 {
            out.insert("damping".into(), quantity(dynamics.damping, if turns { "N m s/rad" } else { "N s/m" }));
        }
        if dynamics.friction > 0.0 {
            let mut friction = Mapping::new();
            friction.insert("coulomb".into(), quantity(dynamics.friction, if turns { "N m" } else { "N" }));
            out.insert("friction".into(), friction.into());
        }
    }

    fn unused_dynamics(&mut self, joint: &Joint<'_, '_>) {
        if let (Some(dynamics), Some(node)) = (&joint.data.dynamics, joint.element("dynamics"))
            && (dynamics.damping != 0.0 || dynamics.friction != 0.0)
        {
            self.notes.about(
                "`<dynamics>` of a joint without a single coordinate, not used: {}",
                joint.data.name.clone(),
                opening(node).start,
            );
        }
    }

    /// Position limits as stops if asked for; what is not used is remarked.
    fn limits(&mut self, joint: &Joint<'_, '_>, path: &str, out: &mut Mapping) {
        let (Some(node), Some(turns)) = (joint.element("limit"), joint.turns()) else { return };
        let at = opening(node).start;
        let (name, limit) = (&joint.data.name, &joint.data.limit);
        let units = if turns { ["rad", "N m", "rad/s"] } else { ["m", "N", "m/s"] };
        let mut remark = Vec::new();
        if let Some((low, high)) = joint.range() {
            let word = format!("{low} to {high} {}", units[0]);
            if self.options.stops && low == high {
                remark.push(word.clone());
                self.notes.about("position limits with equal ends, of which no stops are made: {}", format!("{name} {word}"), at);
            } else if self.options.stops {
                out.insert("limits".into(), stops(joint, turns, low, high).into());
            } else {
                remark.push(word.clone());
                self.notes.about("position limits that do not act (`stops` makes end stops of them): {}", format!("{name} {word}"), at);
            }
            if low > 0.0 || high < 0.0 {
                self.notes.about(
                    "0 is outside of the limits, where the joint stands unless `start` says otherwise: {}",
                    format!("{name} {word}"),
                    at,
                );
            }
        }
        let (effort, velocity) = (limit.effort, limit.velocity);
        if effort.is_finite() && effort != 0.0 || velocity.is_finite() && velocity != 0.0 {
            let word = format!("effort {effort} {}, velocity {velocity} {}", units[1], units[2]);
            self.notes.about("limits of effort and velocity do not act: {}", format!("{name} {word}"), at);
            remark.push(word);
        }
        if !remark.is_empty() {
            self.out.remarks.insert(path.to_owned(), format!("limits in the URDF: {}", remark.join(", ")));
        }
    }

    /// Mass properties, points of joints, outline.
    fn body(&mut self, index: usize, points: &[Option<String>]) -> Mapping {
        let link = &self.robot.links[index];
        let path = format!("bodies.{}", self.names.links[index]);
        self.place(path.clone(), opening(link.node));
        let mut out = Mapping::new();
        if link.massless() {
            out.insert("mass".into(), 0.into());
        } else {
            self.mass(link, &path, &mut out);
        }
        let mut own = Mapping::new();
        for (joint, point) in self.robot.joints.iter().zip(points).filter(|(joint, _)| joint.parent == index) {
            if let Some(point) = point {
                let at = joint.element("origin").map_or(opening(joint.node), opening);
                self.place(format!("{path}.points.{point}"), at);
                own.insert(point.clone().into(), vector(joint.data.origin.xyz.0));
            }
        }
        if !own.is_empty() {
            out.insert("points".into(), own.into());
        }
        let solids = self.solids(link);
        if !solids.is_empty() {
            out.insert("drawn".into(), Value::Sequence(solids));
        }
        out
    }

    fn mass(&mut self, link: &Link<'_, '_>, path: &str, out: &mut Mapping) {
        let inertial = &link.data.inertial;
        out.insert("mass".into(), quantity(inertial.mass.value, "kg"));
        if inertial.origin.xyz.0 != [0.0; 3] {
            out.insert("com".into(), vector(inertial.origin.xyz.0));
        }
        // figures as small as they are: a zero is exact, and so is the rest
        out.insert("inertia".into(), Value::Sequence(figures(&link.inertia).map(|x| Value::from(x + 0.0)).to_vec()));
        if link.fictitious {
            out.insert("fictitious".into(), true.into());
        }
        let Some(node) = element(link.node, "inertial") else { return };
        for (key, tag) in [("mass", "mass"), ("com", "origin"), ("inertia", "inertia")] {
            if let Some(node) = element(node, tag) {
                self.place(format!("{path}.{key}"), opening(node));
            }
        }
    }

    /// The visual shapes as solids, in the frame of the link.
    fn solids(&mut self, link: &Link<'_, '_>) -> Vec<Value> {
        let mut solids = Vec::new();
        for visual in &link.data.visual {
            let at = opening(element(link.node, "visual").unwrap_or(link.node)).start;
            let origin = (visual.origin.xyz.0, visual.origin.rpy.0);
            match &visual.geometry {
                Geometry::Box { size } => solids.push(solid(&[("box", vector(size.0))], origin)),
                Geometry::Cylinder { radius, length } => solids.push(cylinder(*radius, *length, origin)),
                Geometry::Capsule { radius, length } => {
                    solids.push(cylinder(*radius, *length, origin));
                    let turned = roll_pitch_yaw(origin.1);
                    solids.extend([-0.5, 0.5].map(|end| {
                        let moved = apply(&turned, [0.0, 0.0, end * length]);
                        solid(&[("ball", quantity(*radius, "m"))], (std::array::from_fn(|i| origin.0[i] + moved[i]), [0.0; 3]))
                    }));
                }
                Geometry::Sphere { radius } => solids.push(solid(&[("ball", quantity(*radius, "m"))], (origin.0, [0.0; 3]))),
                Geometry::Mesh { filename, .. } => self.notes.about("meshes that are not drawn: {}", filename.clone(), at),
            }
        }
        solids
    }

    /// q = multiplier · master + offset, as an expression that stays 0.
    fn mimics(&mut self) -> Mapping {
        let mut couplings = Mapping::new();
        for (index, joint) in self.robot.joints.iter().enumerate() {
            let (Some(master), Some(mimic)) = (joint.master, &joint.data.mimic) else { continue };
            let turns = |joint: &Joint<'_, '_>| joint.turns() == Some(true);
            let (own, other) = (turns(joint), turns(&self.robot.joints[master]));
            let (factor, offset) = (mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0));
            let coordinate = |name: &str, turns| format!("{name}.{}", if turns { "angle" } else { "position" });
            let follower = coordinate(&self.names.joints[index], own);
            let leader = coordinate(&self.names.joints[master], other);
            let sign = |x: f64| if x < 0.0 { '+' } else { '-' };
            let size = shortest(factor.abs());
            let moved = match (own, other) {
                (false, true) => format!("({size} m)*{leader}"),
                (true, false) => format!("{size}*({leader}/(1 m))"),
                _ if size == "1" => leader,
                _ => format!("{size}*{leader}"),
            };
            let mut zero = format!("{follower} {} {moved}", sign(factor));
            if offset != 0.0 {
                let unit = if own { "rad" } else { "m" };
                zero = format!("{zero} {} {} {unit}", sign(offset), shortest(offset.abs()));
                // only a guess: what leads may be told to start elsewhere
                self.start.insert(follower.into(), format!("~{} {unit}", shortest(offset)).into());
            }
            let name = self.names.fresh(&format!("{}_mimic", self.names.joints[index]));
            let at = joint.element("mimic").map_or(opening(joint.node), opening);
            self.place(format!("couplings.{name}"), at);
            let mut coupling = Mapping::new();
            coupling.insert("zero".into(), zero.into());
            couplings.insert(name.into(), coupling.into());
        }
        couplings
    }

    /// A link and all that hang on it.
    fn carried(&self, link: usize) -> Vec<usize> {
        let mut found = vec![link];
        let mut next = 0;
        while let Some(&parent) = found.get(next) {
            found.extend(self.robot.joints.iter().filter(|joint| joint.parent == parent).map(|joint| joint.child));
            next += 1;
        }
        found
    }

    /// Links that move and carry nothing with mass: the mass matrix is singular, so that motion in time has no accelerations.
    fn leaves(&mut self) {
        let robot = self.robot;
        let mut heavy: Vec<bool> = robot.links.iter().map(|link| !link.massless()).collect();
        for _ in 0..robot.links.len() {
            let mut changed = false;
            for joint in robot.joints.iter().filter(|joint| joint.data.joint_type != JointType::Floating) {
                changed |= heavy[joint.child] && !std::mem::replace(&mut heavy[joint.parent], true);
            }
            if !changed {
                break;
            }
        }
        for joint in robot.joints.iter().filter(|joint| !heavy[joint.child] && joint.data.joint_type != JointType::Fixed) {
            let name = robot.links[joint.child].data.name.clone();
            let bodies = self.carried(joint.child).into_iter().map(|link| self.names.links[link].clone()).collect();
            self.notes.without_mass(name, bodies, opening(joint.node).start);
        }
    }
}

/// End stops by the position limits.
fn stops(joint: &Joint<'_, '_>, turns: bool, low: f64, high: f64) -> Mapping {
    let effort = joint.data.limit.effort;
    let [which, unit] = if turns { [0, 1] } else { [1, 0] };
    let stiffness = if effort.is_finite() && effort > 0.0 { effort / STOP_DEPTH[which] } else { STOP_STIFFNESS[which] };
    let mut limits = Mapping::new();
    for (key, x) in [("from", low), ("to", high)] {
        if x.is_finite() {
            limits.insert(key.into(), quantity(x, ["m", "rad"][unit]));
        }
    }
    limits.insert("stiffness".into(), quantity(stiffness, ["N/m", "N m/rad"][unit]));
    limits
}

/// A cylinder as it is drawn, about its own z axis, with its middle and its roll, pitch and yaw.
fn cylinder(radius: f64, length: f64, origin: ([f64; 3], [f64; 3])) -> Value {
    solid(&[("cylinder", quantity(radius, "m")), ("length", quantity(length, "m"))], origin)
}

/// A solid as it is drawn, with its middle and its roll, pitch and yaw.
fn solid(sizes: &[(&str, Value)], (at, rpy): ([f64; 3], [f64; 3])) -> Value {
    let mut out = Mapping::new();
    sizes.iter().for_each(|(key, size)| _ = out.insert((*key).into(), size.clone()));
    // a drawing needs no more than a micrometre
    let at = at.map(|x| (x * 1e6).round() / 1e6);
    if at != [0.0; 3] {
        out.insert("at".into(), vector(at));
    }
    if rpy != [0.0; 3] {
        out.insert("rpy".into(), Value::Sequence(rpy.map(|angle| quantity(angle, "rad")).to_vec()));
    }
    out.into()
}
