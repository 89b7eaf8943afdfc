//! `gravity`: the same everywhere, or a field that depends on the place and perhaps on time.
//!
//! A field is lowered once for each body, with the coordinates of its centre of mass in the place of `x`, `y`, `z` and `r`.

use super::decoder::Decoder;
use crate::expression::{Dimension, Id, Symbol};
use crate::model::bodies::{Attraction, AttractionLaw};
use crate::model::fault::{At, Spot};
use crate::model::fields::{Shape, Want};
use crate::model::keys::keys;
use crate::model::merge::Node;
use crate::model::needs::Needs;
use crate::model::place::PointRef;
use crate::model::scope::{Allow, Local};
use crate::model::vocabulary::{Known, Quantity};

/// Names of the place in a field of gravity: coordinates in the world, and the distance from its origin.
const PLACE: [&str; 4] = ["x", "y", "z", "r"];

/// What a field of gravity may name beside its place.
const FIELD: Allow = Allow { level: Known::Time, what: "gravity, beside the place `x`, `y`, `z` and `r`,", ..Allow::CONSTANT };
/// The same of a potential.
const POTENTIAL: Allow = Allow { level: Known::Constant, what: "a potential of gravity, beside the place `x`, `y`, `z` and `r`,", ..FIELD };

keys! {
    /// A field of gravity.
    pub(crate) GRAVITY = FieldKeys "a field of gravity" [] {
        potential: need Shape::Formula("an expression of the place x, y, z, r"),
            "Potential of gravity, J/kg: the acceleration is minus its gradient.";
    }
}

impl<'n> Decoder<'n> {
    pub(super) fn gravity(&mut self) {
        let at = At::ROOT.key("gravity");
        let node = self.root.get("gravity");
        let zero = self.pool.constant(0.0);
        self.name_space.model.gravity = vec![zero; self.name_space.components()];
        let Some(node) = node else { return };
        let keys = FieldKeys::of(node);
        if let Some(potential) = keys.potential.node {
            self.attractions(|decoder, body, local| {
                let want = Dimension::ENERGY.div(Dimension::MASS);
                decoder.in_field(potential, &at.key(keys.potential), want, POTENTIAL, body, local).map(AttractionLaw::Potential)
            });
        } else if node.is_list() && node.items().len() == self.name_space.components() {
            let components = |decoder: &mut Self, body: usize, local: &mut Local<'_>| {
                let items = node.items().iter().enumerate();
                let found =
                    items.map(|(i, item)| decoder.in_field(Node::Plain(item), &at.index(i), Dimension::ACCELERATION, FIELD, body, local));
                found.collect::<Vec<_>>().into_iter().collect::<Option<Vec<Id>>>()
            };
            let Some(first) = components(self, 1, &mut Local::default()) else { return };
            if self.pool.inputs_of(&first).is_empty() {
                for (i, id) in first.iter().enumerate() {
                    self.check(crate::model::rules::Rule::Finite, &[*id], &at.index(i));
                }
                self.name_space.model.gravity = first;
                return;
            }
            self.attractions(|decoder, body, local| components(decoder, body, local).map(AttractionLaw::Field));
        }
    }

    /// The law of each body; faults are reported for the first.
    fn attractions(&mut self, law: impl Fn(&mut Self, usize, &mut Local<'_>) -> Option<AttractionLaw>) {
        for body in 1..self.name_space.model.bodies.len() {
            let Some(law) = law(self, body, &mut Local::default()) else { return };
            self.name_space.model.attractions.push(Attraction { body, law });
        }
    }

    /// A component of gravity, or its potential, at the centre of mass of a body.
    fn in_field(
        &mut self,
        node: Node<'n>,
        at: &At<'_, 'n>,
        want: Dimension,
        allow: Allow,
        body: usize,
        local: &mut Local<'_>,
    ) -> Option<Id> {
        local.symbols = self.place_of(body);
        let named = node.text().and_then(|text| self.parse(text).ok()).map(|expr| super::values::paths_of(&expr)).unwrap_or_default();
        let components = self.name_space.components();
        for name in PLACE.into_iter().filter(|name| named.iter().any(|path| path == name)) {
            if self.name_space.names.contains_key(name) {
                let is = self.name_space.names[name].what();
                let message = format!("`{name}` is the place in gravity, and {is} of this file");
                self.fault("reserved-name", at, message, "one meaning").help = Some(format!("give {is} another name"));
                return None;
            }
            if name == "z" && components == 2 {
                self.fault("spatial-only", at, "`z` does not exist in the plane", "the place `x`, `y`, or `r`").spot = Spot::Value;
                return None;
            }
        }
        let (lowered, _) = self.any(node, at, allow, local)?;
        self.fits(&lowered, Want::Of(want), node, None, at).then_some(lowered.id)
    }

    /// The names of the place, for a body.
    fn place_of(&mut self, body: usize) -> Vec<(&'static str, Option<(Symbol, Needs)>)> {
        let components = self.name_space.components();
        let point = |axis: usize| Quantity::Point { at: PointRef { body, point: 1 }, axis, order: 0 };
        let coordinates: Vec<Id> = (0..components).map(|axis| self.name_space.input(&mut self.pool, point(axis))).collect();
        let squares: Vec<Id> = coordinates.iter().map(|x| self.pool.powi(*x, 2)).collect();
        let sum = squares.into_iter().reduce(|sum, square| self.pool.add(sum, square));
        let distance = sum.map(|sum| self.pool.sqrt(sum));
        let symbol = |id: Id| Some((Symbol { id, dimension: Dimension::LENGTH }, Needs::CONSTANT));
        let names = PLACE[..components].iter().copied().zip(coordinates);
        names.chain(distance.map(|r| (PLACE[3], r))).map(|(name, id)| (name, symbol(id))).collect()
    }
}
