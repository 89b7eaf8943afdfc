//! `balance`: attached masses moved until the centre of mass stands still.

use super::contract::{Declared, Features};
use super::range::{OVER, SAMPLES};
use crate::expression::Dimension;
use crate::model::decode::decoder::Decoder;
use crate::model::fault::{At, Spot};
use crate::model::fields::{Shape, Size};
use crate::model::keys::keys;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::study::Kind;
use crate::model::suggest::{self, clip};

keys! {
    /// `balance`.
    TABLE = BalanceKeys "a balance" [] {
        masses("move"): need Shape::List(&Shape::Name("an attached mass `body.mass`"), Size::AtLeast(1)),
            "Attached masses that are moved along the line from the body's origin through their point.";
        over: need OVER, "Range: of the one driver from its start, or a time.";
        samples: need SAMPLES, "Number of equal intervals; one row more.";
    }
}

pub(super) const BALANCE: Declared =
    Declared::new("balance", &TABLE, "Attached masses moved until the centre of mass stands still.", |decoder, node, at| {
        decoder.balance(node, at)
    });

impl<'n> Decoder<'n> {
    fn balance(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(Kind, Features)> {
        let keys = BalanceKeys::of(node);
        let move_at = at.key(keys.masses);
        if !self.name_space.model.attractions.is_empty() {
            let message = "a balance in a field of gravity, where weights depend on the places that are looked for";
            self.fault("gravity-field", at, message, "gravity that is the same everywhere").spot = Spot::Key;
            return None;
        }
        let mut moved = Vec::new();
        let mut results: Vec<(String, Dimension)> = Vec::new();
        let mut sound = true;
        for (i, item) in keys.masses.items().iter().enumerate() {
            let here = move_at.index(i);
            let Some(text) = item.as_str() else { continue };
            let (body, mass) = text.split_once('.').unwrap_or((text, ""));
            let index = match self.name_space.names.get(body) {
                Some(Entity::Body(i)) => {
                    self.name_space.model.bodies.get(*i).map(|found| (*i, found.attached.iter().position(|a| a.name == mass)))
                }
                _ => None,
            };
            match index {
                Some((b, Some(a))) => {
                    let attached = &self.name_space.model.bodies[b].attached[a];
                    if attached.at == 0 {
                        let message = format!("`{text}` sits at the body's origin: there is no line to move it along");
                        self.fault("no-line", &here, message, "a mass at another point of its body");
                        sound = false;
                    } else if self.name_space.model.bodies[b].attached[a].mass.is_none() {
                        self.fault("no-mass", &here, format!("`{text}` has no mass"), "an attached point mass");
                        sound = false;
                    }
                    if results.iter().any(|(name, _)| name == mass) {
                        let message = format!("two moved masses are called `{mass}`");
                        self.fault("duplicate-name", &here, message, "different names: the results are called like the masses");
                    }
                    results.push((mass.to_owned(), Dimension::LENGTH));
                    moved.push((b, a));
                }
                other => {
                    sound = false;
                    let known: Vec<String> = self
                        .name_space
                        .model
                        .bodies
                        .iter()
                        .flat_map(|b| b.attached.iter().map(|a| format!("{}.{}", b.name, a.name)))
                        .collect();
                    let near = suggest::nearest(text, known.iter().map(String::as_str)).map(|near| format!("did you mean `{near}`?"));
                    let list = suggest::known(known.iter().map(String::as_str)).unwrap_or_else(|| "(there are none)".to_owned());
                    let message = match other {
                        Some(_) if mass.is_empty() => format!("`{body}` is a body"),
                        Some(_) => format!("`{body}` has no attached mass `{}`", clip(mass)),
                        None => format!("unknown body `{}`", clip(body)),
                    };
                    self.fault("unknown-mass", &here, message, format!("one of the attached masses {list}")).help = near;
                }
            }
        }
        results.push(("residual".to_owned(), Dimension::LENGTH));
        let (range, features) = self.range(keys.over, keys.samples, at)?;
        sound.then_some((Kind::Balance { moved, range }, Features { results, ..features }))
    }
}
