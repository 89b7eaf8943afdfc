//! Axes of figures, and what they show beside the curves of their study.

use super::decoder::Decoder;
use super::frame::Frame;
use crate::expression::Dimension;
use crate::model::data::{DataFiles, NoTable, Table};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, Shape, Size, Want};
use crate::model::figure::{Beside, Plot, PlotAxis, Shown, ShownWhat};
use crate::model::keys::{Entry, keys};
use crate::model::rules::Rule;
use crate::model::scope::Allow;
use crate::model::suggest;
use crate::model::suggest::clip;

/// What names a column.
pub(super) const COLUMN: Shape = Shape::Name("the name of a measure or a quantity such as `rocker.tip.x`");

keys! {
    /// An axis of a figure.
    pub(super) AXIS = AxisKeys "an axis" [] {
        unit("in"): may Shape::Text, "Its unit.";
        from: may ANY, "Where it begins.";
        to: may ANY, "Where it ends.";
    }
}

keys! {
    /// The axis on the right.
    pub(super) RIGHT = RightKeys "a second axis" [] {
        show: need Shape::List(&COLUMN, Size::AtLeast(1)), "What is drawn over it.";
        unit("in"): may Shape::Text, "Its unit.";
        from: may ANY, "Where it begins.";
        to: may ANY, "Where it ends.";
    }
}

keys! {
    /// Measured data.
    pub(super) DATA = DataKeys "measured data" [] {
        file: need Shape::Text, "A CSV file, by its path from this file: a line of names, then numbers.";
        x: may Shape::Text, "Name of the column along the horizontal axis; the first if omitted.";
        y: may Shape::Text, "Name of the other column; the second if omitted.";
        units("in"): may Shape::List(&Shape::Text, Size::Exactly(2)), "Units of the two columns; SI if omitted.";
        of: may COLUMN, "The shown name whose quantity it is; the first if omitted.";
    }
}

impl<'n> Decoder<'n> {
    /// An axis along which one of some dimensions stands.
    pub(super) fn plot_axis(
        &mut self,
        asked: Entry<'n>,
        at: &At<'_, 'n>,
        dimensions: &[Dimension],
        frame: &mut Frame<'n>,
    ) -> Option<PlotAxis> {
        let keys = AxisKeys::of(asked.node?);
        let here = at.key(asked);
        self.axis([keys.unit, keys.from, keys.to], &here, dimensions, frame)
    }

    /// An axis by its keys `in`, `from` and `to`.
    fn axis(
        &mut self,
        [unit, from, to]: [Entry<'n>; 3],
        here: &At<'_, 'n>,
        dimensions: &[Dimension],
        frame: &mut Frame<'n>,
    ) -> Option<PlotAxis> {
        let mut dimension = None;
        let mut named = None;
        if let Some(text) = unit.text() {
            let (size, of) = self.unit(text, &here.key(unit))?;
            if !dimensions.is_empty() && !dimensions.contains(&of) {
                let message = format!("`{}` is a unit of {}", clip(text), of.name());
                self.fault("wrong-dimension", &here.key(unit), message, dimensions[0].name()).help = Some(suggest::unit_of(dimensions[0]));
                return None;
            }
            (dimension, named) = (Some(of), Some((text.to_owned(), size)));
        }
        let mut ends = [None; 2];
        for (end, entry) in ends.iter_mut().zip([from, to]) {
            let Some(value) = entry.node else { continue };
            let at = here.key(entry);
            let allow = Allow { what: "the end of an axis", ..Allow::PARAMETER };
            let (lowered, _) = self.any(value, &at, allow, &mut frame.local)?;
            // a bare number is in SI, of whatever stands there
            let known = dimension.or_else(|| dimensions.iter().copied().find(|d| *d == lowered.dimension)).or(dimensions.first().copied());
            let wanted = *dimension.get_or_insert(known.unwrap_or(lowered.dimension));
            if !self.fits(&lowered, Want::of(wanted), value, None, &at) {
                return None;
            }
            *end = Some(lowered.id);
        }
        if let [Some(from), Some(to)] = ends
            && self.pool.inputs_of(&[from, to]).is_empty()
        {
            self.check_once(Rule::Differ("ends"), &[from, to], here);
        }
        Some(PlotAxis { dimension: dimension.or(dimensions.first().copied()).unwrap_or_default(), unit: named, ends })
    }

    /// What is drawn over a second axis.
    pub(super) fn plot_right(
        &mut self,
        asked: Entry<'n>,
        at: &At<'_, 'n>,
        left: &[Shown],
        frame: &mut Frame<'n>,
    ) -> Option<(Vec<Shown>, PlotAxis)> {
        let keys = RightKeys::of(asked.node?);
        let here = at.key(asked);
        let list_at = here.key(keys.show);
        let mut show = Vec::new();
        for (i, item) in keys.show.items().iter().enumerate() {
            if let Some(text) = item.as_str() {
                show.extend(self.shown(text, &list_at.index(i), frame));
            }
        }
        let first = show.first()?.dimension;
        let curve = |shown: &Shown| matches!(shown.what, ShownWhat::Column(_));
        for (what, side) in [("on the left", left), ("on the right", &show[..])] {
            if let Some(other) = side.iter().find(|s| s.dimension != side[0].dimension) {
                let message = format!("`{}` and `{}` {what} are different quantities", side[0].name, other.name);
                self.fault("wrong-plot", &list_at, message, "one quantity for each of two axes").help =
                    Some("without `right` quantities stand in panels of their own".to_owned());
                return None;
            }
        }
        if let Some(other) = show.iter().find(|s| left.first().is_some_and(|l| curve(l) != curve(s))) {
            self.fault(
                "wrong-plot",
                &list_at,
                format!("`{}` is not of the kind of those on the left", other.name),
                "only curves, or only scalars",
            );
            return None;
        }
        let axis = self.axis([keys.unit, keys.from, keys.to], &here, &[first], frame)?;
        Some((show, axis))
    }

    /// Other studies of a figure.
    pub(super) fn plot_with(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, study: &At<'_, 'n>) -> Vec<String> {
        let here = at.key(asked);
        let own = self.place(study);
        let known: Vec<String> = self.section("studies").into_iter().map(|(name, _)| name.to_owned()).collect();
        let mut with = Vec::new();
        for (i, item) in asked.items().iter().enumerate() {
            let Some(name) = item.as_str() else { continue };
            if known.iter().any(|known| known == name) && own != format!("studies.{name}") {
                with.push(name.to_owned());
                continue;
            }
            let help = suggest::nearest(name, known.iter().map(String::as_str)).map(|near| format!("did you mean `{near}`?"));
            self.fault("unknown-study", &here.index(i), format!("`{}` is no other study", clip(name)), "another study of this file").help =
                help;
        }
        with
    }

    /// Measured data of a figure, whose horizontal axis is of dimension `across`.
    pub(super) fn measured(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, plot: &Plot, across: Dimension, files: &DataFiles) -> Vec<Beside> {
        let section = at.key(asked);
        let mut all = Vec::new();
        for (label, value) in asked.entries() {
            let here = section.key(label);
            let keys = DataKeys::of(value);
            all.extend(self.data(label, &keys, &here, plot, across, files));
        }
        all
    }

    fn data(
        &mut self,
        label: &str,
        keys: &DataKeys<'n>,
        at: &At<'_, 'n>,
        plot: &Plot,
        across: Dimension,
        files: &DataFiles,
    ) -> Option<Beside> {
        let shown: Vec<&Shown> = plot.show.iter().chain(plot.right.iter().flat_map(|(show, _)| show)).collect();
        let of = match keys.of.text() {
            None => shown.first().copied()?,
            Some(name) => match shown.iter().find(|s| s.name == name) {
                Some(found) => *found,
                None => {
                    self.fault(
                        "wrong-plot",
                        &at.key(keys.of),
                        format!("the figure does not show `{}`", clip(name)),
                        "a name that it shows",
                    );
                    return None;
                }
            },
        };
        let mut sizes = [1.0; 2];
        let units_at = at.key(keys.units);
        for (i, (item, dimension)) in keys.units.items().iter().zip([across, of.dimension]).enumerate() {
            let text = item.as_str()?;
            let (size, found) = self.unit(text, &units_at.index(i))?;
            if found != dimension {
                let message = format!("`{}` is a unit of {}", clip(text), found.name());
                self.fault("wrong-dimension", &units_at.index(i), message, dimension.name()).help = Some(suggest::unit_of(dimension));
                return None;
            }
            sizes[i] = size;
        }
        let path = keys.file.text()?;
        let file_at = at.key(keys.file);
        let table = match files.table(path) {
            Ok(table) => table,
            Err(NoTable::Unread(why)) => {
                self.fault("no-file", &file_at, format!("cannot read `{}`: {why}", clip(path)), "a CSV file, by its path from this file");
                return None;
            }
            Err(NoTable::Wrong(why)) => {
                let expected = "a line of names, then lines of as many numbers";
                self.fault("bad-data", &file_at, format!("`{}` is no table: {why}", clip(path)), expected);
                return None;
            }
        };
        let columns = [(keys.x, 0), (keys.y, 1)].map(|(entry, number)| self.column_of(table, entry, number, at));
        let [Some(x), Some(y)] = columns else { return None };
        let points = table.rows.iter().map(|row| (row[x] * sizes[0], row[y] * sizes[1])).collect();
        Some(Beside { label: label.to_owned(), of: of.name.clone(), points, measured: true })
    }

    /// The number of a column of a table that is named, or that stands at a place.
    fn column_of(&mut self, table: &Table, asked: Entry<'n>, number: usize, at: &At<'_, 'n>) -> Option<usize> {
        let found = match asked.text() {
            Some(name) => table.names.iter().position(|known| known == name),
            None => (number < table.names.len()).then_some(number),
        };
        if found.is_none() {
            let known = suggest::known(table.names.iter().map(String::as_str)).unwrap_or_default();
            let place = if asked.given() { at.key(asked) } else { *at };
            let fault = self.fault("no-column", &place, "the file has no such column", format!("one of its columns {known}"));
            if !asked.given() {
                fault.spot = Spot::Key;
            }
        }
        found
    }
}
