//! Sweeps over lists of points: parameters whose values stand side by side, one run for each place of the lists.

use super::decoder::Decoder;
use super::outside::{Argument, between_commas};
use super::written::{unit_in, unit_of};
use crate::expression::Id;
use crate::model::fault::At;
use crate::model::fields::{ANY, Field};
use crate::model::fields::{Keys, Shape, Size, Want, may};
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::scope::Local;
use crate::model::study::{Sweep, Values};
use std::ops::Range;

/// `points`, in a `sweep`.
pub(super) const POINTS: Field = may(
    "points",
    Shape::Named(Keys::Reference, "a parameter", &Shape::List(&ANY, Size::AtLeast(1))),
    "Lists of one length: a run for each place of theirs, in the place of one for each combination.",
);

/// What the parameter at a place among others runs through.
fn side_by_side(place: usize, ids: Vec<Id>) -> Values {
    if place == 0 { Values::List(ids) } else { Values::Beside(ids) }
}

impl<'n> Decoder<'n> {
    /// Adds the parameters of a list of points, and gives their number of points.
    pub(super) fn point_list(&mut self, points: Node<'n>, section: &At<'_, 'n>, swept: &mut Vec<Sweep>, local: &mut Local<'n>) -> usize {
        let lists = points.entries();
        let wanted = lists.first().map_or(1, |(_, list)| list.items().len());
        if lists.is_empty() {
            let fault = self.fault("nothing-swept", section, "no parameter has a list", "parameters with lists of one length");
            fault.help = Some("give two, as `{ l1: [10 cm, 12 cm], l3: [50 cm, 55 cm] }`, or remove `points`".to_owned());
        }
        let mut place = 0;
        for (name, list) in &lists {
            let here = section.key(*name);
            let found = list.items().len();
            if found != wanted {
                let expected = format!("{wanted}, as `{}` has: a value of each parameter for each point", lists[0].0);
                let fault = self.fault("uneven-points", &here, format!("{found} values"), expected);
                fault.help = Some("write as many values for each parameter as there are points".to_owned());
            }
            let Some((parameter, want)) = self.swept(name, &here, swept) else { continue };
            let ids: Vec<Option<Id>> =
                list.items().iter().enumerate().map(|(i, item)| self.setting(Node::Plain(item), &here.index(i), want, local)).collect();
            let Some(ids) = ids.into_iter().collect() else { continue };
            swept.push(Sweep { parameter, values: side_by_side(place, ids), place: self.place(&here), unit: unit_in(*list) });
            place += 1;
        }
        wanted
    }

    /// A parameter that is swept at no other place, and what its values are of.
    pub(super) fn swept(&mut self, name: &'n str, here: &At<'_, 'n>, swept: &[Sweep]) -> Option<(usize, Want)> {
        let parameter = self.parameter_named(name, here, true)?;
        if swept.iter().any(|sweep| sweep.parameter == parameter) {
            let fault = self.fault("swept-twice", here, format!("`{name}` is swept already"), "another parameter");
            fault.help = Some("leave this one out".to_owned());
            return None;
        }
        Some((parameter, Want::of(self.name_space.parameters.get(parameter).copied().flatten()?)))
    }

    /// The parameters of a list of points that is given from outside, as `l1,l3` with `10 cm,50 cm; 12 cm,55 cm`; and its number of points.
    pub(super) fn points_outside(
        &mut self,
        parameters: &[(usize, crate::expression::Dimension, &str)],
        value: &str,
        argument: &Argument,
        local: &mut Local<'n>,
    ) -> (Vec<Sweep>, usize) {
        let mut columns: Vec<Vec<Option<Id>>> = vec![Vec::new(); parameters.len()];
        let points = parts(value, ';');
        for (i, point) in points.iter().enumerate() {
            let values = between_commas(&value[point.clone()]);
            if values.len() != parameters.len() {
                let message = format!("point {} has {} values", i + 1, values.len());
                let expected = format!("{}, one for each parameter", parameters.len());
                let fault = self.fault("uneven-points", &At::ROOT, message, expected);
                fault.spot = argument.spot(point.clone());
                fault.help = Some("write `;` between points, and `,` between the values of one".to_owned());
                return (Vec::new(), points.len());
            }
            for ((column, (_, wanted, name)), part) in columns.iter_mut().zip(parameters).zip(values) {
                let part = point.start + part.start..point.start + part.end;
                column.push(self.given(name, value, part, argument, *wanted, Self::over_allow(), local));
            }
        }
        let lists: Option<Vec<Vec<Id>>> = columns.into_iter().map(|column| column.into_iter().collect()).collect();
        let Some(lists) = lists else { return (Vec::new(), points.len()) };
        let mut sweeps = Vec::new();
        let first: Vec<&str> = between_commas(value.split(';').next().unwrap_or_default()).into_iter().map(|part| &value[part]).collect();
        for (place, (ids, (parameter, ..))) in lists.into_iter().zip(parameters).enumerate() {
            if self.pool.inputs_of(&ids).is_empty() {
                self.check_once(Rule::Finite, &ids, &At::ROOT);
            }
            let unit = first.get(place).and_then(|written| unit_of(written));
            sweeps.push(Sweep { parameter: *parameter, values: side_by_side(place, ids), place: String::new(), unit });
        }
        (sweeps, points.len())
    }
}

/// Parts of a text between marks, one of which may stand at its end.
fn parts(text: &str, mark: char) -> Vec<Range<usize>> {
    let whole = text.trim_end().trim_end_matches(mark);
    let mut begin = 0;
    let mut parts: Vec<Range<usize>> =
        whole.match_indices(mark).map(|(i, _)| std::mem::replace(&mut begin, i + mark.len_utf8())..i).collect();
    parts.push(begin..whole.len());
    parts
}
