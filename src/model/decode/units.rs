//! `units`: in which units results are shown.

use super::decoder::Decoder;
use crate::expression::{Dimension, meant_unit, parse_unit};
use crate::model::entities::DisplayUnit;
use crate::model::fault::At;
use crate::model::merge::Node;
use crate::model::suggest::clip;

impl<'n> Decoder<'n> {
    pub(super) fn display_units(&mut self) {
        let at = At::ROOT.key("units");
        let Some(node) = self.root.get("units").filter(|node| node.is_list()) else { return };
        for (i, item) in node.items().iter().enumerate() {
            let Some(name) = Node::Plain(item).text() else { continue };
            let here = at.index(i);
            let Some((size, dimension)) = self.unit(name, &here) else { continue };
            let known = self.name_space.model.units.iter().find(|known| known.dimension.is_shown_as(dimension));
            if let Some(known) = known.map(|known| known.name.clone()) {
                let message = format!("`{}` and `{}` are both units of {}", clip(&known), clip(name), dimension.name());
                self.fault("two-units", &here, message, "one unit for each dimension").help = Some(format!("remove `{}`", clip(name)));
                continue;
            }
            self.name_space.model.units.push(DisplayUnit { name: name.to_owned(), size, dimension });
        }
    }

    /// Size in SI and dimension of a unit.
    pub(super) fn unit(&mut self, text: &str, at: &At<'_, 'n>) -> Option<(f64, Dimension)> {
        let found = parse_unit(text);
        if found.is_none() {
            self.fault("unknown-unit", at, format!("`{}` is no unit", clip(text)), "a unit such as `rpm`, `deg`, `mm`, `N m`").help =
                Some(meant_unit(&clip(text)));
        }
        found
    }
}
