//! The ground and the bodies: shapes, figures, points, attached masses.

use super::decoder::Decoder;
use super::drawn::DRAWN;
use crate::expression::{Dimension, Id};
use crate::model::bodies::{self, Attached, Body, Point, PointAt};
use crate::model::fault::{At, Spot};
use crate::model::fields::{FIGURES, Keys, LENGTH, MASS, POSITION, ROLL_PITCH_YAW, Shape, Size, Want, at_most_one, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::suggest;
use crate::model::suggest::clip;
use crate::model::vocabulary::BODY_QUANTITIES;

/// A point, or one with axes of its own.
pub(crate) const PLACED: Shape = Shape::Either(&[POSITION, Shape::Map(&FRAME)]);

keys! {
    /// A body.
    pub(crate) BODY = BodyKeys "a body" [at_most_one(&["bar", "disc", "plate", "box", "ball"])] {
        bar: may Shape::Map(&BAR), "Uniform straight bar from the body's origin along x; has the points `start` and `end`.";
        disc: may Shape::Map(&DISC), "Uniform disc about z, origin in the middle.";
        plate: may Shape::Map(&PLATE), "Uniform plate, origin in the middle.";
        cuboid("box"): may Shape::Map(&PLATE), "Uniform box, origin in the middle.";
        ball: may Shape::Map(&BALL), "Uniform ball, origin in the middle.";
        mass: may MASS, "Mass.";
        inertia: may FIGURES, "Inertia about the centre of mass: a number, `[Ixx, Iyy, Izz]`, or with `Ixy, Ixz, Iyz`.";
        com: may POSITION, "Centre of mass in the body frame.";
        points: may Shape::Named(Keys::Name, "a point", &PLACED), "Points in the body frame.";
        drawn: may DRAWN, "How the body looks in drawings, body frame: points that outline it, a circle, or solids.";
        attached: may Shape::Named(Keys::Name, "an attached mass", &Shape::Map(&ATTACHED)), "Point masses and rotors on the body.";
        fictitious: may Shape::Flag,
            "Allows an inertia that no real body has, as robots from data sheets do; moments below 0 stay refused.";
    }
}

keys! {
    /// A point with axes of its own.
    pub(crate) FRAME = FrameKeys "a point with axes of its own" [] {
        at: need POSITION, "Place in the body frame.";
        rpy: may ROLL_PITCH_YAW, "Spatial: orientation of the point's axes in the body: turned about x, then y, then z.";
    }
}

keys! {
    /// A bar.
    BAR = BarKeys "a bar" [one_of(&["length", "from"])] {
        length: may LENGTH, "Length.";
        from: may POSITION, "Start of a bar drawn in place, world coordinates.";
        to: may POSITION, "End of a bar drawn in place, world coordinates.";
        mass: may MASS, "Mass; 0 if omitted.";
        width: may LENGTH, "In space: size along y; thin if omitted.";
        height: may LENGTH, "In space: size along z; thin if omitted.";
    }
}

keys! {
    /// A disc.
    DISC = DiscKeys "a disc" [] {
        radius: need LENGTH, "Radius.";
        mass: may MASS, "Mass; 0 if omitted.";
        thickness: may LENGTH, "Thickness; thin if omitted.";
    }
}

keys! {
    /// A plate or box.
    PLATE = PlateKeys "a plate or box" [] {
        size: need Shape::List(&LENGTH, Size::Space), "Sizes along the body's axes.";
        mass: may MASS, "Mass; 0 if omitted.";
    }
}

keys! {
    /// A ball.
    BALL = BallKeys "a ball" [] {
        radius: need LENGTH, "Radius.";
        mass: may MASS, "Mass; 0 if omitted.";
    }
}

keys! {
    /// An attached mass.
    ATTACHED = AttachedKeys "an attached mass" [] {
        at: may Shape::Name("a point of the body"), "Point of the body; its origin if omitted.";
        mass: may MASS, "Point mass.";
        inertia: may FIGURES, "Inertia of a rotor about its own centre.";
    }
}

impl<'n> BodyKeys<'n> {
    /// The keys of shapes.
    fn shapes(self) -> [Entry<'n>; 5] {
        [self.bar, self.disc, self.plate, self.cuboid, self.ball]
    }
}

impl<'n> Decoder<'n> {
    pub(super) fn bodies(&mut self) {
        let mut points = vec![Point::of_shape("origin", PointAt::Origin), Point::of_shape("com", PointAt::Com)];
        self.points(self.section("ground"), &At::ROOT.key("ground"), &mut points);
        self.name_space.model.bodies.push(Body {
            name: "ground".to_owned(),
            shape: None,
            mass: None,
            inertia: Vec::new(),
            com: None,
            fictitious: false,
            drawn: Vec::new(),
            circle: None,
            solids: Vec::new(),
            points,
            attached: Vec::new(),
            place: "ground".to_owned(),
        });
        let section = At::ROOT.key("bodies");
        let all = self.section("bodies");
        self.name_space.model.bodies.reserve_exact(all.len());
        for (name, node) in all {
            let body = self.body(name, node, &section.key(name));
            self.name_space.model.bodies.push(body);
        }
    }

    fn body(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Body {
        let keys = BodyKeys::of(node);
        let shape = self.shape(keys, at);
        if shape.is_some() {
            for entry in [keys.mass, keys.inertia, keys.com] {
                if entry.given() {
                    let key = entry.key();
                    let kind = keys.shapes().into_iter().find(|shape| shape.given()).map_or("bar", Entry::key);
                    let fault = self.fault(
                        "two-kinds",
                        &at.key(entry),
                        format!("`{key}` beside `{kind}`"),
                        "a shape or explicit figures, not both",
                    );
                    fault.spot = Spot::Key;
                    fault.help = Some(match key {
                        "mass" => format!("write `{kind}: {{ ..., mass: ... }}`, or add mass with `attached`"),
                        _ => format!("remove `{kind}`, or add what is missing with `attached`"),
                    });
                }
            }
        }
        let mut points = vec![Point::of_shape("origin", PointAt::Origin), Point::of_shape("com", PointAt::Com)];
        if keys.bar.given() {
            points.push(Point::of_shape("start", PointAt::Start));
            points.push(Point::of_shape("end", PointAt::End));
        }
        self.points(keys.points.entries(), &at.key(keys.points), &mut points);
        let attached = self.attached(name, keys.attached, at, &points);
        let fictitious = keys.fictitious.flag();
        let drawn_at = at.key(keys.drawn);
        let drawn = keys.drawn.items().iter().enumerate();
        let drawn =
            drawn.filter_map(|(i, item)| self.space_vector(Some(Node::Plain(item)), &drawn_at.index(i), Dimension::LENGTH)).collect();
        let circle = self.circle(keys.drawn, at);
        let solids = self.solids(keys.drawn, at);
        Body {
            name: name.to_owned(),
            shape,
            mass: self.size(keys.mass, at, "the mass"),
            inertia: self.inertia(keys.inertia, at, if fictitious { Rule::Moments } else { Rule::Inertia }),
            fictitious,
            drawn,
            circle,
            solids,
            com: self.read_vector(keys.com, at, Dimension::LENGTH),
            points,
            attached,
            place: self.place(at),
        }
    }

    fn shape(&mut self, keys: BodyKeys<'n>, at: &At<'_, 'n>) -> Option<bodies::Shape> {
        if let Some(bar) = keys.bar.node {
            return self.bar(BarKeys::of(bar), &at.key(keys.bar));
        }
        if let Some(disc) = keys.disc.node {
            let (disc, here) = (DiscKeys::of(disc), at.key(keys.disc));
            let mass = self.size(disc.mass, &here, "the mass");
            let radius = self.size(disc.radius, &here, "the radius");
            let thickness = self.size(disc.thickness, &here, "the thickness");
            return Some(bodies::Shape::Disc { radius: radius?, mass, thickness });
        }
        if let Some(ball) = keys.ball.node {
            let (ball, here) = (BallKeys::of(ball), at.key(keys.ball));
            let mass = self.size(ball.mass, &here, "the mass");
            let radius = self.size(ball.radius, &here, "the radius");
            return Some(bodies::Shape::Ball { radius: radius?, mass });
        }
        let entry = [keys.plate, keys.cuboid].into_iter().find(|entry| entry.given())?;
        let (plate, here) = (PlateKeys::of(entry.node?), at.key(entry));
        let mass = self.size(plate.mass, &here, "the mass");
        let sizes_at = here.key(plate.size);
        let size = self.space_vector(plate.size.node, &sizes_at, Dimension::LENGTH)?;
        for (i, id) in size.iter().enumerate() {
            self.check(Rule::NotNegative("the size"), &[*id], &sizes_at.index(i));
        }
        Some(bodies::Shape::Plate { size, mass })
    }

    fn bar(&mut self, keys: BarKeys<'n>, at: &At<'_, 'n>) -> Option<bodies::Shape> {
        let mass = self.size(keys.mass, at, "the mass");
        for entry in [keys.width, keys.height] {
            if entry.given() && self.name_space.components() == 2 {
                let key = entry.key();
                let fault = self.fault("spatial-only", &at.key(entry), format!("a planar bar has no `{key}`"), "a key of a planar bar");
                fault.spot = Spot::Key;
                fault.help = Some("remove it: in the plane a bar is a line".to_owned());
            }
        }
        let width = self.size(keys.width, at, "the width");
        let height = self.size(keys.height, at, "the height");
        if keys.from.given() || keys.to.given() {
            for (entry, other) in [(keys.from, keys.to), (keys.to, keys.from)] {
                if !entry.given() {
                    let fault = self.fault(
                        "missing-key",
                        at,
                        format!("`{}` is missing beside `{}`", entry.key(), other.key()),
                        "a bar drawn in place has `from` and `to`",
                    );
                    fault.spot = Spot::Key;
                }
            }
            if keys.length.given() && !keys.from.given() {
                self.fault("two-kinds", &at.key(keys.length), "`length` beside `to`", "either `length`, or `from` and `to`").spot =
                    Spot::Key;
            }
            let from = self.read_vector(keys.from, at, Dimension::LENGTH);
            let to = self.read_vector(keys.to, at, Dimension::LENGTH);
            let (from, to) = (from?, to?);
            let both: Vec<Id> = from.iter().chain(&to).copied().collect();
            self.check(Rule::Distinct, &both, at);
            return Some(bodies::Shape::BarBetween { from, to, mass, width, height });
        }
        let length = self.size(keys.length, at, "the length")?;
        Some(bodies::Shape::Bar { length, mass, width, height })
    }

    /// 1 figure, or in space 3 or 6.
    fn inertia(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, rule: Rule) -> Vec<Id> {
        let Some(node) = entry.node else { return Vec::new() };
        let at = &at.key(entry);
        if !node.is_list() {
            return self.size_as(Some(node), at, Want::Of(Dimension::INERTIA), "the inertia").into_iter().collect();
        }
        let Some(ids) = self.vector(Some(node), at, Dimension::INERTIA) else { return Vec::new() };
        if ids.len() > 1 && self.name_space.components() == 2 {
            let fault =
                self.fault("spatial-only", at, format!("{} moments of inertia in the plane", ids.len()), "one number: the inertia about z");
            fault.help = Some("write `inertia: Izz`".to_owned());
            return Vec::new();
        }
        match ids.len() {
            1 => self.check(Rule::NotNegative("the inertia"), &ids, at),
            3 | 6 => self.check(rule, &ids, at),
            _ => {}
        }
        ids
    }

    fn points(&mut self, entries: Vec<(&'n str, Node<'n>)>, at: &At<'_, 'n>, points: &mut Vec<Point>) {
        for (name, value) in entries {
            let here = at.key(name);
            if points.iter().any(|p| p.name == name) {
                let fault = self.fault("duplicate-name", &here, format!("the point `{name}` exists already"), "another name for the point");
                fault.spot = Spot::Key;
                fault.help = Some("`origin` and `com` always exist, `start` and `end` in a bar".to_owned());
                continue;
            }
            if BODY_QUANTITIES.contains(&name) {
                let fault = self.fault("reserved-name", &here, format!("`{name}` is a quantity of the body"), "another name for the point");
                fault.spot = Spot::Key;
                fault.help = Some(format!("for example `P{name}`"));
            }
            let (position, rpy) = if value.is_map() {
                let keys = FrameKeys::of(value);
                let rpy_at = here.key(keys.rpy);
                if keys.rpy.given() && self.name_space.components() == 2 {
                    let fault = self.fault("spatial-only", &rpy_at, "`rpy` does not exist in the plane", "a point `[x, y]`");
                    fault.spot = Spot::Key;
                }
                let position = self.read_vector(keys.at, &here, Dimension::LENGTH);
                (position, keys.rpy.node.and_then(|rpy| self.roll_pitch_yaw(rpy, &rpy_at)))
            } else {
                (self.space_vector(Some(value), &here, Dimension::LENGTH), None)
            };
            // a faulty point exists all the same, so that its users are not blamed
            points.push(Point { name: name.to_owned().into(), at: position.map_or(PointAt::Origin, PointAt::Given), rpy });
        }
    }

    fn attached(&mut self, body: &str, entry: Entry<'n>, at: &At<'_, 'n>, points: &[Point]) -> Vec<Attached> {
        let section = at.key(entry);
        let mut attached = Vec::new();
        for (name, inner) in entry.entries() {
            let here = section.key(name);
            let keys = AttachedKeys::of(inner);
            let point = keys.at.text().unwrap_or("origin");
            let index = points.iter().position(|p| p.name == point);
            if index.is_none() {
                let list = suggest::known(points.iter().map(|p| &*p.name)).unwrap_or_default();
                let help = suggest::nearest(point, points.iter().map(|p| &*p.name)).map(|near| format!("did you mean `{near}`?"));
                let fault = self.fault(
                    "unknown-point",
                    &here.key(keys.at),
                    format!("`{body}` has no point `{}`", clip(point)),
                    format!("one of its points {list}"),
                );
                fault.help = help;
            } else if index == Some(1) {
                self.fault(
                    "unknown-point",
                    &here.key(keys.at),
                    "the centre of mass moves with what is attached",
                    "another point of the body",
                );
            }
            if inner.is_map() && !keys.mass.given() && !keys.inertia.given() {
                self.fault("missing-key", &here, format!("`{name}` has neither `mass` nor `inertia`"), "at least one of the two").spot =
                    Spot::Key;
            }
            attached.push(Attached {
                name: name.to_owned(),
                at: index.unwrap_or(0),
                mass: self.size(keys.mass, &here, "the mass"),
                inertia: self.inertia(keys.inertia, &here, Rule::Inertia),
                place: self.place(&here),
            });
        }
        attached
    }

    /// The point that a text such as `rocker.tip` names; the fault is reported.
    pub(super) fn point(&mut self, node: Option<Node<'_>>, at: &At<'_, '_>) -> Option<PointRef> {
        let text = node?.text()?;
        let (body, point) = text.split_once('.').unwrap_or((text, "origin"));
        let index = if body == "ground" {
            0
        } else {
            match self.name_space.names.get(body) {
                Some(Entity::Body(i)) => *i,
                other => {
                    let is = other.map(|entity| format!("`{body}` is {}", entity.what()));
                    let mut bodies = vec!["ground"];
                    bodies.extend(self.name_space.known(|entity| matches!(entity, Entity::Body(_))));
                    let rest = &text[body.len()..];
                    let near = suggest::nearest(body, bodies.iter().copied()).map(|near| format!("did you mean `{near}{rest}`?"));
                    let list = suggest::known(bodies.iter().copied()).unwrap_or_default();
                    // a point without its body
                    let mut owners = self.name_space.model.bodies.iter().filter(|b| b.points.iter().any(|p| p.name == text));
                    let owner = match (owners.next(), owners.next()) {
                        (Some(owner), None) => Some(format!("did you mean `{}.{text}`?", owner.name)),
                        _ => None,
                    };
                    // a joint for its point
                    let of_joint = match other {
                        Some(Entity::Joint(joint)) => self.name_space.model.joints.get(*joint).map(|joint| joint.b),
                        _ => None,
                    };
                    let moved = of_joint.and_then(|at| Some((at, self.name_space.model.bodies.get(at.body)?)));
                    let moved =
                        moved.and_then(|(at, body)| Some(format!("write `{}.{}`, its point", body.name, body.points.get(at.point)?.name)));
                    let message = is.unwrap_or_else(|| format!("unknown body `{}`", clip(body)));
                    self.fault("unknown-body", at, message, format!("one of the bodies {list}")).help =
                        Some(owner.or(moved).or(near).unwrap_or_else(|| suggest::take_or_add(body, "bodies")));
                    return None;
                }
            }
        };
        let found = self.name_space.model.bodies.get(index)?;
        match found.points.iter().position(|p| p.name == point) {
            Some(point) => Some(PointRef { body: index, point }),
            None => {
                let why = self.name_space.no_point(index, point, "");
                self.fault("unknown-point", at, why.found, why.expected).help = why.help;
                None
            }
        }
    }
}
