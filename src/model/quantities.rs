//! The quantities of a mechanism by their dotted paths: `crank.angle`, `rocker.tip.x`, `O.fx`, `com.vx`.

use super::coordinates::{ANGLE, Coordinate, POSITION, angle, coordinates, length};
use super::entities::Dimensions;
use super::names::Entity;
use super::needs::Needs;
use super::place::PointRef;
use super::suggest;
use super::vocabulary::Quantity;
use super::whole::Model;
use crate::expression::{Dimension, Id, Pool, Symbol, Unknown, unit_hint};
use std::collections::HashMap;

/// A resolved path.
#[derive(Clone, Copy)]
pub(crate) enum Found {
    /// One leaf.
    Leaf(Quantity, Dimension),
    /// An expression of leaves.
    Made(Symbol, Needs),
}

/// Everything that has a name.
pub(crate) struct NameSpace<'a> {
    /// The model as far as it is decoded; its pool is kept apart until the end.
    pub(crate) model: Model,
    /// The one name space.
    pub(crate) names: HashMap<&'a str, Entity>,
    /// The same in file order, for messages.
    pub(crate) listed: Vec<(&'a str, Entity)>,
    /// Names that variants remove, with the section and the variant.
    pub(crate) removed: Vec<(&'a str, &'static str, &'a str)>,
    /// Dimensions of parameters; `None` where the value is faulty.
    pub(crate) parameters: Vec<Option<Dimension>>,
    /// Dimensions of tables.
    pub(crate) tables: Vec<Option<(Dimension, Dimension)>>,
    /// Dimensions of first-order states; `None` where `start` is faulty.
    pub(crate) states: Vec<Option<Dimension>>,
    /// Rates of the states as far as they are lowered.
    pub(crate) rates: Vec<Option<(Id, Needs)>>,
    /// Measures as far as they are lowered.
    pub(crate) measures: Vec<Option<(Symbol, Needs)>>,
    /// Dimension of the stretch of each spring.
    pub(crate) stretches: Vec<Option<Dimension>>,
    /// Joints by their number in the file; `None` where one is faulty. Numbers in the model are the same.
    pub(crate) renumbered: Renumbered,
    /// Number of each input leaf.
    pub(crate) input_of: HashMap<Quantity, u32>,
}

/// Which entities were decoded without faults: index in the file → index in the model.
#[derive(Default)]
pub(crate) struct Renumbered {
    pub(crate) joints: Vec<Option<usize>>,
    pub(crate) drivers: Vec<Option<usize>>,
    pub(crate) couplings: Vec<Option<usize>>,
    pub(crate) springs: Vec<Option<usize>>,
    pub(crate) motors: Vec<Option<usize>>,
    pub(crate) clutches: Vec<Option<usize>>,
}

/// An `Unknown` that is silent: its cause was reported at its own place.
pub(super) fn silent() -> Unknown {
    Unknown { found: String::new(), expected: String::new(), help: None }
}

/// An `Unknown` with these words.
pub(super) fn unknown(found: impl Into<String>, expected: impl Into<String>, help: Option<String>) -> Unknown {
    Unknown { found: found.into(), expected: expected.into(), help }
}

const XYZ: [&str; 3] = ["x", "y", "z"];

/// Behind the name of a rate of rotation that is in the axes of the body.
const OWN: &str = "_own";

impl<'a> NameSpace<'a> {
    /// Names of one kind of things, in file order; not more than a message can use.
    pub(crate) fn known(&self, kind: impl Fn(Entity) -> bool) -> Vec<&'a str> {
        self.listed.iter().filter(|(_, entity)| kind(*entity)).map(|(name, _)| *name).take(suggest::MOST_CANDIDATES).collect()
    }

    /// Components of a vector.
    pub(crate) fn components(&self) -> usize {
        match self.model.space {
            Dimensions::Planar => 2,
            Dimensions::Spatial => 3,
        }
    }

    fn planar(&self) -> bool {
        self.components() == 2
    }

    /// The node of a leaf.
    pub(crate) fn input(&mut self, pool: &mut Pool, quantity: Quantity) -> Id {
        let next = self.model.inputs.len() as u32;
        let number = *self.input_of.entry(quantity).or_insert(next);
        if number == next {
            self.model.inputs.push(quantity);
        }
        pool.input(number)
    }

    fn leaf(&mut self, pool: &mut Pool, quantity: Quantity, dimension: Dimension) -> (Symbol, Needs) {
        (Symbol { id: self.input(pool, quantity), dimension }, Needs::of(quantity))
    }

    /// √(a² + b² + ...) of leaves.
    fn magnitude(&mut self, pool: &mut Pool, leaves: &[Quantity], dimension: Dimension) -> Found {
        let mut sum: Option<Id> = None;
        let mut reach = Needs::CONSTANT;
        for quantity in leaves {
            let leaf = self.input(pool, *quantity);
            let square = pool.powi(leaf, 2);
            sum = Some(sum.map_or(square, |sum| pool.add(sum, square)));
            reach = reach.join(Needs::of(*quantity));
        }
        let sum = sum.unwrap_or_else(|| pool.constant(0.0));
        Found::Made(Symbol { id: pool.sqrt(sum), dimension }, reach)
    }

    /// The symbol of something found.
    pub(crate) fn symbol(&mut self, pool: &mut Pool, found: Found) -> (Symbol, Needs) {
        match found {
            Found::Leaf(quantity, dimension) => self.leaf(pool, quantity, dimension),
            Found::Made(symbol, reach) => (symbol, reach),
        }
    }

    fn axis(&self, name: &str) -> Option<usize> {
        XYZ[..self.components()].iter().position(|axis| *axis == name)
    }

    /// The quantity of a dotted path.
    pub(crate) fn quantity(&mut self, pool: &mut Pool, path: &str) -> Result<Found, Unknown> {
        let (head, rest) = path.split_once('.').map_or((path, ""), |(head, rest)| (head, rest));
        match head {
            "t" | "time" if rest.is_empty() => return Ok(Found::Leaf(Quantity::Time, Dimension::TIME)),
            "com" => return self.com(pool, rest),
            "energy" => return self.energy(pool, rest),
            "momentum" => {
                return match self.axis(rest) {
                    Some(axis) => Ok(Found::Leaf(Quantity::Momentum { axis }, Dimension::MOMENTUM)),
                    None => Err(self.wrong("momentum", rest, &self.axes(&[""]))),
                };
            }
            "shaking" => {
                return self.resultant(pool, "shaking", rest, |axis| Quantity::Shaking { axis }, |axis| Quantity::ShakingMoment { axis });
            }
            "frame" => {
                return self.resultant(pool, "frame", rest, |axis| Quantity::Frame { axis }, |axis| Quantity::FrameMoment { axis });
            }
            "inertia_eq" | "inertia_eq_slope" if rest.is_empty() => return self.inertia_eq(head == "inertia_eq"),
            "ground" => return self.of_body(pool, 0, path, rest),
            _ => {}
        }
        let Some(entity) = self.names.get(head).copied() else {
            return Err(self.nobody(head, path));
        };
        match entity {
            Entity::Body(body) if body < self.model.bodies.len() => self.of_body(pool, body, path, rest),
            Entity::Joint(joint) => match self.renumbered.joints.get(joint).copied().flatten() {
                Some(joint) => self.of_joint(pool, joint, head, rest),
                None => Err(silent()),
            },
            Entity::Driver(driver) => match self.renumbered.drivers.get(driver).copied().flatten() {
                Some(driver) => self.of_driver(driver, head, rest),
                None => Err(silent()),
            },
            Entity::Coupling(coupling) => match self.renumbered.couplings.get(coupling).copied().flatten() {
                Some(coupling) => self.of_coupling(pool, coupling, head, rest),
                None => Err(silent()),
            },
            Entity::Spring(spring) => match self.renumbered.springs.get(spring).copied().flatten() {
                Some(spring) => self.of_spring(spring, head, rest),
                None => Err(silent()),
            },
            Entity::Motor(motor) => match self.renumbered.motors.get(motor).copied().flatten() {
                Some(motor) => self.of_motor(pool, motor, head, rest),
                None => Err(silent()),
            },
            Entity::Clutch(clutch) => match self.renumbered.clutches.get(clutch).copied().flatten() {
                Some(clutch) => self.of_clutch(pool, clutch, head, rest),
                None => Err(silent()),
            },
            Entity::State(state) if rest.is_empty() => match self.states.get(state).copied().flatten() {
                Some(dimension) => Ok(Found::Leaf(Quantity::State(state), dimension)),
                None => Err(silent()),
            },
            Entity::State(_) => Err(unknown(
                format!("`{path}`: `{head}` is a state"),
                "the state's name alone, or `rate(..)` of it",
                Some(format!("write `{head}`")),
            )),
            _ => Err(unknown(
                format!("`{path}`: `{head}` is {}", entity.what()),
                "a quantity of a body, joint, coupling, driver, spring, motor or clutch",
                (!rest.is_empty()).then(|| format!("{} has no quantities", entity.what())),
            )),
        }
    }

    /// An unknown first name.
    pub(crate) fn nobody(&self, head: &str, path: &str) -> Unknown {
        if let Some((_, section, variant)) = self.removed.iter().find(|(name, ..)| *name == head) {
            let help =
                "let the variant remove what names it as well, by `null` in its section, or give that another value there".to_owned();
            return unknown(
                format!("`{path}`: the variant `{variant}` removes `{head}` from `{section}`"),
                "a name of what is left",
                Some(help),
            );
        }
        let known = ["ground", "t", "time", "com", "energy", "shaking", "frame"].into_iter();
        let known = known.chain(self.listed.iter().map(|(name, _)| *name));
        let help = suggest::nearest(head, known).map(|near| {
            let rest = path.get(head.len()..).unwrap_or("");
            format!("did you mean `{near}{rest}`?")
        });
        let found = if head == path { format!("unknown name `{head}`") } else { format!("unknown name `{head}` in `{path}`") };
        let help = help.or_else(|| unit_hint(head).filter(|_| head == path)).unwrap_or_else(|| {
            format!("take a name that is there, or define `{}`, as a parameter, a measure, a driver", suggest::clip(head))
        });
        unknown(found, "a name of this model", Some(help))
    }

    pub(super) fn wrong(&self, owner: &str, rest: &str, known: &[String]) -> Unknown {
        let found = if rest.is_empty() { format!("`{owner}` alone is no quantity") } else { format!("`{owner}` has no `{rest}`") };
        let expected = suggest::known(known.iter().map(String::as_str)).unwrap_or_default();
        let help = suggest::nearest(rest, known.iter().map(String::as_str)).map(|near| format!("did you mean `{owner}.{near}`?"));
        let help = help.or_else(|| rest.is_empty().then(|| known.first().map(|k| format!("for example `{owner}.{k}`"))).flatten());
        unknown(found, format!("one of its quantities {expected}"), help)
    }

    /// `prefix` + `x`, `y`, (`z`) for all prefixes.
    fn axes(&self, prefixes: &[&str]) -> Vec<String> {
        prefixes.iter().flat_map(|p| XYZ[..self.components()].iter().map(move |x| format!("{p}{x}"))).collect()
    }

    fn com(&mut self, pool: &mut Pool, rest: &str) -> Result<Found, Unknown> {
        for (order, prefix) in ["", "v", "a"].into_iter().enumerate() {
            if let Some(axis) = rest.strip_prefix(prefix).and_then(|axis| self.axis(axis)) {
                return Ok(Found::Leaf(Quantity::Com { axis, order }, length(POSITION, 0).dimension(order)));
            }
        }
        let order = match rest {
            "speed" => 1,
            "a" => 2,
            _ => return Err(self.wrong("com", rest, &self.axes(&["", "v", "a"]))),
        };
        let leaves: Vec<Quantity> = (0..self.components()).map(|axis| Quantity::Com { axis, order }).collect();
        Ok(self.magnitude(pool, &leaves, length(POSITION, 0).dimension(order)))
    }

    fn energy(&mut self, pool: &mut Pool, rest: &str) -> Result<Found, Unknown> {
        match rest {
            "kinetic" => Ok(Found::Leaf(Quantity::Kinetic, Dimension::ENERGY)),
            "potential" => Ok(Found::Leaf(Quantity::Potential, Dimension::ENERGY)),
            "total" => {
                let (kinetic, potential) = (self.input(pool, Quantity::Kinetic), self.input(pool, Quantity::Potential));
                let reach = Needs::of(Quantity::Kinetic).join(Needs::of(Quantity::Potential));
                Ok(Found::Made(Symbol { id: pool.add(kinetic, potential), dimension: Dimension::ENERGY }, reach))
            }
            _ => Err(self.wrong("energy", rest, &["kinetic".to_owned(), "potential".to_owned(), "total".to_owned()])),
        }
    }

    /// `fx fy f m`, in space `fx fy fz mx my mz f m`.
    fn resultant(
        &mut self,
        pool: &mut Pool,
        owner: &str,
        rest: &str,
        force: impl Fn(usize) -> Quantity,
        moment: impl Fn(usize) -> Quantity,
    ) -> Result<Found, Unknown> {
        if let Some(axis) = rest.strip_prefix('f').and_then(|axis| self.axis(axis)) {
            return Ok(Found::Leaf(force(axis), Dimension::FORCE));
        }
        if !self.planar()
            && let Some(axis) = rest.strip_prefix('m').and_then(|axis| self.axis(axis))
        {
            return Ok(Found::Leaf(moment(axis), Dimension::TORQUE));
        }
        match rest {
            "f" => {
                let leaves: Vec<Quantity> = (0..self.components()).map(force).collect();
                Ok(self.magnitude(pool, &leaves, Dimension::FORCE))
            }
            // in the plane the moment has a sign
            "m" if self.planar() => Ok(Found::Leaf(moment(2), Dimension::TORQUE)),
            "m" => Ok(self.magnitude(pool, &[moment(0), moment(1), moment(2)], Dimension::TORQUE)),
            _ => {
                let mut known = self.axes(if self.planar() { &["f"] } else { &["f", "m"] });
                known.extend(["f".to_owned(), "m".to_owned()]);
                Err(self.wrong(owner, rest, &known))
            }
        }
    }

    fn inertia_eq(&self, value: bool) -> Result<Found, Unknown> {
        let [driver] = &self.model.drivers[..] else {
            let n = self.model.drivers.len();
            let plural = if n == 1 { "" } else { "s" };
            return Err(unknown(
                format!("this mechanism has {n} driver{plural}"),
                "one driver, by whose rate the inertia is counted",
                None,
            ));
        };
        let angle = self.single(driver.joint).is_none_or(|c| c.angle);
        let dimension = if angle { Dimension::INERTIA } else { Dimension::MASS };
        if value {
            Ok(Found::Leaf(Quantity::InertiaEq, dimension))
        } else {
            let by = if angle { Dimension::NONE } else { Dimension::LENGTH };
            Ok(Found::Leaf(Quantity::InertiaEqSlope, dimension.div(by)))
        }
    }

    /// The one coordinate of a joint that has just one.
    pub(crate) fn single(&self, joint: usize) -> Option<&'static Coordinate> {
        match coordinates(&self.model.joints.get(joint)?.kind) {
            [one] => Some(one),
            _ => None,
        }
    }

    fn of_body(&mut self, pool: &mut Pool, body: usize, path: &str, rest: &str) -> Result<Found, Unknown> {
        let planar = self.planar();
        let head = path.split('.').next().unwrap_or(path).to_owned();
        if let Some((point, quantity)) = rest.split_once('.') {
            let Some(index) = self.model.bodies[body].points.iter().position(|p| p.name == point) else {
                return Err(self.no_point(body, point, &format!(".{quantity}")));
            };
            let owner = format!("{head}.{point}");
            return match self.point(pool, PointRef { body, point: index }, quantity) {
                Some(found) => Ok(found),
                None => Err(self.wrong(&owner, quantity, &self.point_quantities())),
            };
        }
        if let Some(found) = self.point(pool, PointRef { body, point: 0 }, rest) {
            return Ok(found);
        }
        if planar && let Some(order) = ANGLE.iter().position(|name| *name == rest) {
            return Ok(Found::Leaf(Quantity::Angle { body, order }, angle(ANGLE, 0).dimension(order)));
        }
        if !planar {
            let (name, own) = rest.strip_suffix(OWN).map_or((rest, false), |name| (name, true));
            for (order, prefix) in [(1, "w"), (2, "alpha")] {
                if let Some(axis) = name.strip_prefix(prefix).and_then(|axis| self.axis(axis)) {
                    return Ok(Found::Leaf(Quantity::Spin { body, axis, order, own }, angle(ANGLE, 0).dimension(order)));
                }
            }
            if let Some(component) = ["qw", "qx", "qy", "qz"].iter().position(|name| *name == rest) {
                return Ok(Found::Leaf(Quantity::Quaternion { body, component, order: 0 }, Dimension::NONE));
            }
            if ANGLE.contains(&rest) {
                let help = Some(
                    "an angle belongs to a joint, as `J.angle`; a body has `wx wy wz`, `alphax alphay alphaz` and `qw qx qy qz`".to_owned(),
                );
                return Err(unknown(format!("`{head}` has no `{rest}` in space"), "a quantity of a body in space", help));
            }
        }
        let mut known = self.point_quantities();
        if planar {
            known.extend(ANGLE.map(str::to_owned));
        } else {
            known.extend(["qw", "qx", "qy", "qz"].map(str::to_owned));
            known.extend(self.axes(&["w", "alpha"]).into_iter().flat_map(|name| [format!("{name}{OWN}"), name]));
        }
        if self.model.bodies[body].points.iter().any(|p| p.name == rest) {
            return Err(self.wrong(&format!("{head}.{rest}"), "", &self.point_quantities()));
        }
        Err(self.wrong(&head, rest, &known))
    }

    fn point_quantities(&self) -> Vec<String> {
        let mut all = self.axes(&["", "v", "a"]);
        all.extend(["speed".to_owned(), "a".to_owned()]);
        all
    }

    /// A body without that point.
    pub(crate) fn no_point(&self, body: usize, point: &str, rest: &str) -> Unknown {
        let body = &self.model.bodies[body];
        let known = || body.points.iter().map(|p| &*p.name);
        let help = suggest::nearest(point, known()).map(|near| format!("did you mean `{}.{near}{rest}`?", body.name));
        let list = suggest::known(known()).unwrap_or_default();
        unknown(format!("`{}` has no point `{point}`", body.name), format!("one of its points {list}"), help)
    }

    fn point(&mut self, pool: &mut Pool, at: PointRef, quantity: &str) -> Option<Found> {
        for (order, prefix) in ["", "v", "a"].into_iter().enumerate() {
            if let Some(axis) = quantity.strip_prefix(prefix).and_then(|axis| self.axis(axis)) {
                return Some(Found::Leaf(Quantity::Point { at, axis, order }, length(POSITION, 0).dimension(order)));
            }
        }
        let order = match quantity {
            "speed" => 1,
            "a" => 2,
            _ => return None,
        };
        let leaves: Vec<Quantity> = (0..self.components()).map(|axis| Quantity::Point { at, axis, order }).collect();
        Some(self.magnitude(pool, &leaves, length(POSITION, 0).dimension(order)))
    }

    fn of_joint(&mut self, pool: &mut Pool, joint: usize, name: &str, rest: &str) -> Result<Found, Unknown> {
        let all = coordinates(&self.model.joints[joint].kind);
        for coordinate in all {
            if let Some(order) = coordinate.names.iter().position(|name| *name == rest) {
                let quantity = Quantity::Joint { joint, slot: coordinate.slot, order };
                return Ok(Found::Leaf(quantity, coordinate.dimension(order)));
            }
        }
        if let ("stop" | "stop_power", [c], true) = (rest, all, self.model.joints[joint].has_stops()) {
            let stop = Quantity::Stop { joint };
            if rest == "stop" {
                return Ok(Found::Leaf(stop, c.effort()));
            }
            let rate = Quantity::Joint { joint, slot: 0, order: 1 };
            let (force, speed) = (self.input(pool, stop), self.input(pool, rate));
            return Ok(Found::Made(Symbol { id: pool.mul(force, speed), dimension: Dimension::POWER }, Needs::of(stop)));
        }
        if let (Some((quantity, unit)), [c]) = (self.model.joints[joint].friction.as_ref().and_then(|f| f.quantity(joint, rest)), all) {
            let (leaf, reach) = self.leaf(pool, quantity, if unit.is_some() { c.dimension(0) } else { c.effort() });
            return Ok(Found::Made(Symbol { id: unit.map_or(leaf.id, |unit| pool.mul(unit, leaf.id)), ..leaf }, reach));
        }
        let found = self.resultant(pool, name, rest, |axis| Quantity::Force { joint, axis }, |axis| Quantity::Moment { joint, axis });
        found.map_err(|_| {
            let mut known: Vec<String> = all.iter().flat_map(|c| c.names).map(str::to_owned).collect();
            if self.model.joints[joint].has_stops() {
                known.extend(["stop", "stop_power"].map(str::to_owned));
            }
            known.extend(self.axes(if self.planar() { &["f"] } else { &["f", "m"] }));
            known.extend(["f".to_owned(), "m".to_owned()]);
            self.wrong(name, rest, &known)
        })
    }
}

impl NameSpace<'_> {
    /// Whether the path begins with something of the mechanism.
    pub(super) fn known_head(&self, path: &str) -> bool {
        let head = path.split('.').next().unwrap_or(path);
        self.names.contains_key(head)
            || matches!(
                head,
                "t" | "time" | "com" | "energy" | "momentum" | "shaking" | "frame" | "inertia_eq" | "inertia_eq_slope" | "ground"
            )
    }
}
