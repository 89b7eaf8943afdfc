//! `start`: one rule for positions and velocities, exact values and guesses.

use super::decoder::{Decoder, Origin};
use crate::expression::{Dimension, Id, Lowered};
use crate::model::entities::{Start, StartValue};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANGLE, NUMBER, Shape, Size, Want};
use crate::model::keys::keys;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::quantities::Found;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::suggest;
use crate::model::vocabulary::Quantity;
use std::collections::HashMap;

/// What the value of a start is written as.
#[derive(Clone, Copy)]
enum Form {
    /// One value.
    Number(Want),
    /// An axis and an angle.
    Rotation,
    /// Roll, pitch and yaw.
    Angles,
}

impl Form {
    fn words(self) -> &'static str {
        match self {
            Self::Number(_) => "a number, a quantity or an expression",
            Self::Rotation => "`{ axis: [x, y, z], angle: ... }`",
            Self::Angles => "`[roll, pitch, yaw]`",
        }
    }

    /// What to write.
    fn example(self) -> String {
        let of = |value: &str| format!("write one value, such as `{value}`; `~{value}` for a guess");
        match self {
            Self::Number(Want::Of(dimension)) if !dimension.is_angle() => of(&dimension.written("1")),
            Self::Number(_) => of("30 deg"),
            Self::Rotation => "write it as `{ axis: [0, 0, 1], angle: 30 deg }`; `angle: ~30 deg` for a guess".to_owned(),
            Self::Angles => "write it as `[0 deg, 0 deg, 30 deg]`; `[~0 deg, ~0 deg, ~30 deg]` for a guess".to_owned(),
        }
    }
}

keys! {
    /// A rotation.
    pub(crate) ROTATION = RotationKeys "a rotation" [] {
        axis: need Shape::List(&NUMBER, Size::Exactly(3)), "Axis, world frame.";
        angle: need ANGLE, "Angle; `~` in front marks a guess.";
    }
}

impl<'n> Decoder<'n> {
    pub(super) fn start(&mut self) {
        let section = At::ROOT.key("start");
        let mut given: HashMap<Quantity, usize> = HashMap::new();
        let all = self.section("start");
        self.name_space.model.start.reserve_exact(all.len());
        for (path, node) in all {
            let at = section.key(path);
            let Some((quantity, form)) = self.start_quantity(path, &at) else { continue };
            if let Some(&other) = given.get(&quantity) {
                let message = format!("this quantity is given already, in `{}`", self.name_space.model.start[other].place);
                let fault = self.fault("duplicate-start", &at, message, "one value for a quantity");
                fault.spot = Spot::Key;
                fault.help = Some("remove one of the two".to_owned());
                continue;
            }
            let value = match form {
                Form::Number(want) if !node.is_map() && !node.is_list() => {
                    self.start_number(node, &at, want).map(|(id, guess)| (StartValue::Number(id), guess))
                }
                Form::Rotation if node.is_map() => {
                    let keys = RotationKeys::of(node);
                    let axis_at = at.key(keys.axis);
                    let axis = self.vector(keys.axis.node, &axis_at, Dimension::NONE);
                    if let Some(axis) = &axis {
                        self.check(Rule::Direction, axis, &axis_at);
                    }
                    let angle = keys.angle.node.and_then(|angle| self.start_number(angle, &at.key(keys.angle), Want::Angle));
                    axis.zip(angle).map(|(axis, (angle, guess))| (StartValue::Rotation { axis, angle }, guess))
                }
                Form::Angles if node.is_list() => self.start_angles(node, &at),
                form => {
                    let found = if node.is_map() {
                        "a map"
                    } else if node.is_list() {
                        "a list"
                    } else {
                        "one value"
                    };
                    let help = form.example();
                    self.fault("wrong-type", &at, found, form.words()).help = Some(help);
                    None
                }
            };
            if let Some((value, guess)) = value {
                let place = self.place(&at);
                given.insert(quantity, self.name_space.model.start.len());
                self.name_space.model.start.push(Start { name: path.to_owned(), quantity, value, guess, place });
            }
        }
    }

    /// A value, perhaps with `~` in front.
    fn start_number(&mut self, node: Node<'n>, at: &At<'_, 'n>, want: Want) -> Option<(Id, bool)> {
        let text = node.text().unwrap_or_default();
        let Some(rest) = text.strip_prefix('~') else {
            return self.number(Some(node), at, want).map(|id| (id, false));
        };
        let inner = rest.trim_start();
        let offset = text.len() - inner.len();
        let (lowered, _): (Lowered, _) = self.lower(inner, Origin::Value(text, offset), at, Allow::CONSTANT, &mut Local::default())?;
        if !self.fits(&lowered, want, node, None, at) {
            return None;
        }
        self.check(Rule::Finite, &[lowered.id], at);
        Some((lowered.id, true))
    }

    /// Roll, pitch and yaw, all of them guesses or none.
    fn start_angles(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(StartValue, bool)> {
        let items = node.items().iter().enumerate();
        let angles: Vec<Option<(Id, bool)>> =
            items.map(|(i, item)| self.start_number(Node::Plain(item), &at.index(i), Want::Angle)).collect();
        let [Some((roll, guess)), Some((pitch, second)), Some((yaw, third))] = angles[..] else { return None };
        if guess != second || guess != third {
            let message = "a guess beside an exact angle";
            self.fault("wrong-start", at, message, "`~` in front of all three angles, or of none").help =
                Some("an orientation is exact or a guess as a whole".to_owned());
            return None;
        }
        Some((StartValue::RollPitchYaw([roll, pitch, yaw]), guess))
    }

    /// What of a body a start may give, and which of it a wrong word may mean.
    fn of_body_at_start(&self, head: &str, rest: &str) -> Option<(String, Option<String>)> {
        let Some(Entity::Body(_)) = self.name_space.names.get(head) else { return None };
        let known: &[&str] = match self.name_space.components() {
            2 => &["x", "y", "angle", "vx", "vy", "omega"],
            _ => &["x", "y", "z", "rotation", "rpy", "vx", "vy", "vz", "wx", "wy", "wz", "wx_own", "wy_own", "wz_own"],
        };
        if rest.is_empty() || rest.contains('.') {
            return None;
        }
        let near = suggest::nearest(rest, known.iter().copied()).map(|near| format!("did you mean `{head}.{near}`?"));
        let list = suggest::known(known.iter().copied()).unwrap_or_default();
        Some((format!("what a start can give of a body: {list}"), near))
    }

    /// The quantity that a key names, and what its value must be. The fault is reported.
    fn start_quantity(&mut self, path: &str, at: &At<'_, '_>) -> Option<(Quantity, Form)> {
        const EXPECTED: &str = "a position or velocity of a joint or body, as `O.angle`, `S.velocity`, `crank.x`";
        let (head, rest) = path.split_once('.').unwrap_or((path, ""));
        if let Some(Entity::Body(body)) = self.name_space.names.get(head)
            && matches!(rest, "rotation" | "rpy")
        {
            if self.name_space.components() == 2 {
                let fault = self.fault("spatial-only", at, format!("`{rest}` does not exist in the plane"), EXPECTED);
                fault.spot = Spot::Key;
                fault.help = Some(format!("write `{head}.angle`"));
                return None;
            }
            let form = if rest == "rpy" { Form::Angles } else { Form::Rotation };
            return Some((Quantity::Quaternion { body: *body, component: 0, order: 0 }, form));
        }
        let found = match self.name_space.quantity(&mut self.pool, path) {
            Ok(found) => found,
            Err(why) if why.found.is_empty() => return None,
            Err(why) => {
                let (expected, help) = self.of_body_at_start(head, rest).unwrap_or((why.expected, why.help));
                let fault = self.fault("unknown-name", at, why.found, expected);
                fault.spot = Spot::Key;
                fault.help = help;
                return None;
            }
        };
        let refused = |why: String| (why, EXPECTED.to_owned());
        let (message, expected) = match found {
            Found::Leaf(quantity, dimension) => match quantity {
                Quantity::Joint { order: 0 | 1, .. }
                | Quantity::Angle { order: 0 | 1, body: 1.. }
                | Quantity::Spin { order: 1, body: 1.., .. } => {
                    let angle = dimension == Dimension::NONE;
                    return Some((quantity, Form::Number(if angle { Want::Angle } else { Want::Of(dimension) })));
                }
                Quantity::Point { at: point, order: 0 | 1, .. } if point.body > 0 && point.point == 0 => {
                    return Some((quantity, Form::Number(Want::Of(dimension))));
                }
                Quantity::Point { at: point, .. } if point.body > 0 && point.point > 0 => {
                    refused(format!("`{path}` belongs to a point; only a body's origin can be given"))
                }
                Quantity::Point { at: point, .. } if point.body == 0 => refused("the ground does not move".to_owned()),
                Quantity::Angle { body: 0, .. } | Quantity::Spin { body: 0, .. } => refused("the ground does not move".to_owned()),
                Quantity::Joint { .. } | Quantity::Angle { .. } | Quantity::Point { .. } | Quantity::Spin { .. } => {
                    refused(format!("`{path}` is an acceleration"))
                }
                Quantity::State(_) => {
                    let fault = self.fault("wrong-start", at, format!("`{path}` is a first-order state"), EXPECTED);
                    fault.spot = Spot::Key;
                    fault.help = Some(format!("its first value belongs to it: `states: {{ {path}: {{ start: ... }} }}`"));
                    return None;
                }
                _ => refused(format!("`{path}` cannot be given at the start")),
            },
            Found::Made(..) => refused(format!("`{path}` is computed from several quantities")),
        };
        let fault = self.fault("wrong-start", at, message, expected);
        fault.spot = Spot::Key;
        None
    }
}
