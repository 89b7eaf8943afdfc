//! The ground and the bodies: shapes, figures, points, attached masses.

use super::decoder::Decoder;
use crate::expression::{Dimension, Id};
use crate::model::bodies::{Attached, Body, Point, PointAt, Shape};
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::suggest;
use crate::model::suggest::clip;
use crate::model::vocabulary::BODY_QUANTITIES;

impl<'n> Decoder<'n> {
    pub(super) fn bodies(&mut self) {
        let mut points = vec![Point::of_shape("origin", PointAt::Origin), Point::of_shape("com", PointAt::Com)];
        self.points(self.root.get("ground"), &At::ROOT.key("ground"), &mut points);
        self.name_space.model.bodies.push(Body {
            name: "ground".to_owned(),
            shape: None,
            mass: None,
            inertia: Vec::new(),
            com: None,
            fictitious: false,
            drawn: Vec::new(),
            points,
            attached: Vec::new(),
            place: "ground".to_owned(),
        });
        let section = At::ROOT.key("bodies");
        for (name, node) in self.section("bodies") {
            let body = self.body(name, node, &section.key(name));
            self.name_space.model.bodies.push(body);
        }
    }

    fn body(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>) -> Body {
        let shape = self.shape(node, at);
        if shape.is_some() {
            for key in ["mass", "inertia", "com"] {
                if node.get(key).is_some() {
                    let kind = ["bar", "disc", "plate", "box", "ball"].into_iter().find(|k| node.get(k).is_some()).unwrap_or("bar");
                    let fault =
                        self.fault("two-kinds", &at.key(key), format!("`{key}` beside `{kind}`"), "a shape or explicit figures, not both");
                    fault.spot = Spot::Key;
                    fault.help = Some(match key {
                        "mass" => format!("write `{kind}: {{ ..., mass: ... }}`, or add mass with `attached`"),
                        _ => format!("remove `{kind}`, or add what is missing with `attached`"),
                    });
                }
            }
        }
        let mut points = vec![Point::of_shape("origin", PointAt::Origin), Point::of_shape("com", PointAt::Com)];
        if node.get("bar").is_some() {
            points.push(Point::of_shape("start", PointAt::Start));
            points.push(Point::of_shape("end", PointAt::End));
        }
        self.points(node.get("points"), &at.key("points"), &mut points);
        let attached = self.attached(name, node, at, &points);
        let fictitious = matches!(node.get("fictitious"), Some(Node::Plain(serde_yaml::Value::Bool(true))));
        let drawn_at = at.key("drawn");
        let drawn = node.get("drawn").map(Node::items).unwrap_or_default().iter().enumerate();
        let drawn =
            drawn.filter_map(|(i, item)| self.space_vector(Some(Node::Plain(item)), &drawn_at.index(i), Dimension::LENGTH)).collect();
        Body {
            name: name.to_owned(),
            shape,
            mass: self.size(node.get("mass"), &at.key("mass"), Dimension::MASS, "the mass"),
            inertia: self.inertia(node.get("inertia"), &at.key("inertia"), if fictitious { Rule::Moments } else { Rule::Inertia }),
            fictitious,
            drawn,
            com: self.space_vector(node.get("com"), &at.key("com"), Dimension::LENGTH),
            points,
            attached,
            place: self.place(at),
        }
    }

    fn shape(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<Shape> {
        if let Some(bar) = node.get("bar") {
            return self.bar(bar, &at.key("bar"));
        }
        for (key, round) in [("disc", true), ("ball", true), ("plate", false), ("box", false)] {
            let Some(inner) = node.get(key) else { continue };
            let here = at.key(key);
            let mass = self.size(inner.get("mass"), &here.key("mass"), Dimension::MASS, "the mass");
            if !round {
                let sizes_at = here.key("size");
                let size = self.space_vector(inner.get("size"), &sizes_at, Dimension::LENGTH)?;
                for (i, id) in size.iter().enumerate() {
                    self.check(Rule::NotNegative("the size"), &[*id], &sizes_at.index(i));
                }
                return Some(Shape::Plate { size, mass });
            }
            let radius = self.size(inner.get("radius"), &here.key("radius"), Dimension::LENGTH, "the radius");
            if key == "ball" {
                return Some(Shape::Ball { radius: radius?, mass });
            }
            let thickness = self.size(inner.get("thickness"), &here.key("thickness"), Dimension::LENGTH, "the thickness");
            return Some(Shape::Disc { radius: radius?, mass, thickness });
        }
        None
    }

    fn bar(&mut self, bar: Node<'n>, at: &At<'_, 'n>) -> Option<Shape> {
        let mass = self.size(bar.get("mass"), &at.key("mass"), Dimension::MASS, "the mass");
        for key in ["width", "height"] {
            if bar.get(key).is_some() && self.name_space.components() == 2 {
                let fault = self.fault("spatial-only", &at.key(key), format!("a planar bar has no `{key}`"), "a key of a planar bar");
                fault.spot = Spot::Key;
                fault.help = Some("remove it: in the plane a bar is a line".to_owned());
            }
        }
        let width = self.size(bar.get("width"), &at.key("width"), Dimension::LENGTH, "the width");
        let height = self.size(bar.get("height"), &at.key("height"), Dimension::LENGTH, "the height");
        if bar.get("from").is_some() || bar.get("to").is_some() {
            for (key, other) in [("from", "to"), ("to", "from")] {
                if bar.get(key).is_none() {
                    let fault = self.fault(
                        "missing-key",
                        at,
                        format!("`{key}` is missing beside `{other}`"),
                        "a bar drawn in place has `from` and `to`",
                    );
                    fault.spot = Spot::Key;
                }
            }
            if bar.get("length").is_some() && bar.get("from").is_none() {
                self.fault("two-kinds", &at.key("length"), "`length` beside `to`", "either `length`, or `from` and `to`").spot = Spot::Key;
            }
            let from = self.space_vector(bar.get("from"), &at.key("from"), Dimension::LENGTH);
            let to = self.space_vector(bar.get("to"), &at.key("to"), Dimension::LENGTH);
            let (from, to) = (from?, to?);
            let both: Vec<Id> = from.iter().chain(&to).copied().collect();
            self.check(Rule::Distinct, &both, at);
            return Some(Shape::BarBetween { from, to, mass, width, height });
        }
        let length = self.size(bar.get("length"), &at.key("length"), Dimension::LENGTH, "the length")?;
        Some(Shape::Bar { length, mass, width, height })
    }

    /// 1 figure, or in space 3 or 6.
    fn inertia(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, rule: Rule) -> Vec<Id> {
        let Some(node) = node else { return Vec::new() };
        if !node.is_list() {
            return self.size(Some(node), at, Dimension::INERTIA, "the inertia").into_iter().collect();
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

    fn points(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, points: &mut Vec<Point>) {
        for (name, value) in node.map(Node::entries).unwrap_or_default() {
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
                let rpy_at = here.key("rpy");
                if value.get("rpy").is_some() && self.name_space.components() == 2 {
                    let fault = self.fault("spatial-only", &rpy_at, "`rpy` does not exist in the plane", "a point `[x, y]`");
                    fault.spot = Spot::Key;
                }
                let position = self.space_vector(value.get("at"), &here.key("at"), Dimension::LENGTH);
                (position, value.get("rpy").and_then(|rpy| self.roll_pitch_yaw(rpy, &rpy_at)))
            } else {
                (self.space_vector(Some(value), &here, Dimension::LENGTH), None)
            };
            // a faulty point exists all the same, so that its users are not blamed
            points.push(Point { name: name.to_owned(), at: position.map_or(PointAt::Origin, PointAt::Given), rpy });
        }
    }

    fn attached(&mut self, body: &str, node: Node<'n>, at: &At<'_, 'n>, points: &[Point]) -> Vec<Attached> {
        let section = at.key("attached");
        let mut attached = Vec::new();
        for (name, inner) in node.get("attached").map(Node::entries).unwrap_or_default() {
            let here = section.key(name);
            let point = inner.get("at").and_then(Node::text).unwrap_or("origin");
            let index = points.iter().position(|p| p.name == point);
            if index.is_none() {
                let list = suggest::known(points.iter().map(|p| p.name.as_str())).unwrap_or_default();
                let help = suggest::nearest(point, points.iter().map(|p| p.name.as_str())).map(|near| format!("did you mean `{near}`?"));
                let fault = self.fault(
                    "unknown-point",
                    &here.key("at"),
                    format!("`{body}` has no point `{}`", clip(point)),
                    format!("one of its points {list}"),
                );
                fault.help = help;
            } else if index == Some(1) {
                self.fault("unknown-point", &here.key("at"), "the centre of mass moves with what is attached", "another point of the body");
            }
            if inner.is_map() && inner.get("mass").is_none() && inner.get("inertia").is_none() {
                self.fault("missing-key", &here, format!("`{name}` has neither `mass` nor `inertia`"), "at least one of the two").spot =
                    Spot::Key;
            }
            attached.push(Attached {
                name: name.to_owned(),
                at: index.unwrap_or(0),
                mass: self.size(inner.get("mass"), &here.key("mass"), Dimension::MASS, "the mass"),
                inertia: self.inertia(inner.get("inertia"), &here.key("inertia"), Rule::Inertia),
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
                    let message = is.unwrap_or_else(|| format!("unknown body `{}`", clip(body)));
                    self.fault("unknown-body", at, message, format!("one of the bodies {list}")).help = near;
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

    /// A number whose dimension depends on its neighbours.
    pub(super) fn of(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>, dimension: Dimension) -> Option<Id> {
        self.number(node.get(key), &at.key(key), Want::Of(dimension))
    }
}
