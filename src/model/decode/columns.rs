//! Columns of a study and figures of them.

use super::decoder::{Decoder, Origin};
use super::frame::Frame;
use super::plots::{AXIS, COLUMN, DATA, RIGHT};
use crate::expression::{Dimension, Id};
use crate::model::data::DataFiles;
use crate::model::entities::Coupling;
use crate::model::fault::At;
use crate::model::fields::{Keys, Shape, Size};
use crate::model::figure::{Plot, Shown, ShownWhat};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::scope::{Allow, Local};
use crate::model::study::Column;
use crate::model::suggest::{self, clip};
use crate::model::vocabulary::Quantity;

keys! {
    /// `plot`, one figure.
    pub(super) PLOT = PlotKeys "a figure" [] {
        show: need Shape::List(&COLUMN, Size::AtLeast(1)), "What is drawn.";
        over: may COLUMN, "What it is drawn over; the independent variable if omitted.";
        unit("in"): may Shape::Text, "Unit of the horizontal axis.";
        x: may Shape::Map(&AXIS), "Unit and range of the horizontal axis.";
        y: may Shape::Map(&AXIS), "Unit and range of the vertical axis of one quantity.";
        right: may Shape::Map(&RIGHT), "What is drawn over a second vertical axis on the right.";
        with: may Shape::List(&Shape::Name("a study of this file"), Size::AtLeast(1)), "Studies whose curves of the same names are drawn, too.";
        data: may Shape::Named(Keys::Title, "measured data", &Shape::Map(&DATA)), "Measured data from files beside the model.";
    }
}

impl<'n> Decoder<'n> {
    fn column_allow(frame: &Frame<'_>) -> Allow {
        Allow { reactions: frame.features.reactions, states: frame.features.states, what: frame.word, ..Allow::MEASURE }
    }

    pub(super) fn columns(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>) -> Vec<Column> {
        let here = at.key(asked);
        let mut columns: Vec<Column> = Vec::new();
        let Some(list) = asked.node else { return self.default_columns(frame) };
        for (i, item) in list.items().iter().enumerate() {
            let Some(text) = item.as_str() else { continue };
            for column in self.expand(text, &here.index(i), frame) {
                if let Some(twin) = columns.iter().find(|c| c.name == column.name) {
                    let message = format!("`{}` is a column already", twin.name);
                    self.fault("duplicate-column", &here.index(i), message, "each column once").help =
                        Some("remove one of the two".to_owned());
                } else {
                    columns.push(column);
                }
            }
        }
        columns
    }

    /// What `undefined` names among the columns and the curves of figures.
    pub(super) fn may_be_undefined(
        &mut self,
        asked: Entry<'n>,
        at: &At<'_, 'n>,
        frame: &mut Frame<'n>,
        columns: &[Column],
        plots: &[Plot],
    ) -> Vec<Id> {
        let here = at.key(asked);
        let shown = plots.iter().flat_map(Plot::all);
        let curves = shown.filter_map(|s| if let ShownWhat::Column(id) = s.what { Some(id) } else { None });
        let known: Vec<Id> = columns.iter().map(|c| c.value).chain(curves).collect();
        let mut ids = Vec::new();
        for (i, item) in asked.items().iter().enumerate() {
            let Some(text) = item.as_str() else { continue };
            for column in self.expand(text, &here.index(i), frame) {
                if known.contains(&column.value) {
                    ids.push(column.value);
                } else {
                    let message = format!("`{}` is no column of the study", column.name);
                    self.fault("no-column", &here.index(i), message, "a column, or a curve of a figure").help =
                        Some("name it in `columns`, too".to_owned());
                }
            }
        }
        ids
    }

    /// Independent variable, time, states, measures, drivers.
    fn default_columns(&mut self, frame: &Frame<'_>) -> Vec<Column> {
        if frame.features.independent.is_none() {
            return Vec::new();
        }
        let mut columns: Vec<Column> = Vec::new();
        if let Some(first) = &frame.features.first
            && let Some(column) = self.quiet(first)
        {
            columns.push(column);
        }
        let time = self.name_space.input(&mut self.pool, Quantity::Time);
        columns.push(Column { name: "time".to_owned(), dimension: Dimension::TIME, value: time });
        let states = if frame.features.states { self.section("states") } else { Vec::new() };
        columns.extend(states.into_iter().filter_map(|(name, _)| self.quiet(name)));
        for (i, (name, _)) in self.section("measures").into_iter().enumerate() {
            if let Some((symbol, reach)) = self.name_space.measures.get(i).copied().flatten()
                && (frame.features.reactions || !reach.reactions)
                && (frame.features.states || !reach.states)
                && columns.iter().all(|c| c.name != name)
            {
                columns.push(Column { name: name.to_owned(), dimension: symbol.dimension, value: symbol.id });
            }
        }
        if frame.features.reactions {
            let drivers: Vec<String> = self.name_space.model.drivers.iter().map(|d| d.name.clone()).collect();
            for name in drivers.iter().flat_map(|driver| self.parts(driver)).collect::<Vec<_>>() {
                columns.extend(self.quiet(&name));
            }
        }
        columns
    }

    /// The column of a path that is known to be sound.
    pub(super) fn quiet(&mut self, path: &str) -> Option<Column> {
        if let Some(Entity::Measure(i)) = self.name_space.names.get(path) {
            let (symbol, _) = self.name_space.measures.get(*i).copied().flatten()?;
            return Some(Column { name: path.to_owned(), dimension: symbol.dimension, value: symbol.id });
        }
        let found = self.name_space.quantity(&mut self.pool, path).ok()?;
        let (symbol, _) = self.name_space.symbol(&mut self.pool, found);
        Some(Column { name: path.to_owned(), dimension: symbol.dimension, value: symbol.id })
    }

    /// The quantities that a name stands for in a list of columns; the name itself if it stands for none.
    fn parts(&self, name: &str) -> Vec<String> {
        let planar = self.name_space.components() == 2;
        let with = |parts: &[&str]| parts.iter().map(|part| format!("{name}.{part}")).collect();
        let single = |name: &str| vec![name.to_owned()];
        match name {
            "com" if planar => return with(&["x", "y", "vx", "vy", "ax", "ay"]),
            "com" => return with(&["x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az"]),
            "shaking" | "frame" if planar => return with(&["fx", "fy", "f"]),
            "shaking" | "frame" => return with(&["fx", "fy", "fz", "f"]),
            "energy" => return with(&["kinetic", "potential", "total"]),
            _ => {}
        }
        let (head, rest) = name.split_once('.').unwrap_or((name, ""));
        match self.name_space.names.get(head) {
            Some(Entity::Joint(_)) if rest.is_empty() && planar => with(&["fx", "fy", "f"]),
            Some(Entity::Joint(_)) if rest.is_empty() => with(&["fx", "fy", "fz", "mx", "my", "mz"]),
            Some(Entity::Driver(i)) if rest.is_empty() => {
                let driver =
                    self.name_space.renumbered.drivers.get(*i).copied().flatten().and_then(|i| self.name_space.model.drivers.get(i));
                let angle = driver.and_then(|d| self.name_space.single(d.joint)).is_none_or(|c| c.angle);
                with(&[if angle { "torque" } else { "force" }, "power"])
            }
            Some(Entity::Coupling(i)) if rest.is_empty() => {
                let couplings = &self.name_space.model.couplings;
                let coupling = self.name_space.renumbered.couplings.get(*i).copied().flatten().and_then(|i| couplings.get(i));
                with(&[coupling.map_or("torque", Coupling::effort_word)])
            }
            entity => {
                let body = match entity {
                    Some(Entity::Body(i)) => self.name_space.model.bodies.get(*i),
                    _ if head == "ground" => self.name_space.model.bodies.first(),
                    _ => None,
                };
                match body {
                    Some(body) if body.points.iter().any(|p| p.name == rest) => with(if planar { &["x", "y"] } else { &["x", "y", "z"] }),
                    _ => single(name),
                }
            }
        }
    }

    /// The columns that a text stands for; faults are reported.
    fn expand(&mut self, text: &str, at: &At<'_, 'n>, frame: &Frame<'n>) -> Vec<Column> {
        match self.parse(text) {
            Ok(expr) if expr.path().is_some() => {}
            Ok(_) => {
                let message = format!("`{}` is an expression", clip(text));
                let fault = self.fault("wrong-column", at, message, "the name of a measure or a quantity such as `rocker.tip.x`");
                fault.help = Some(format!("make it a measure: `measures: {{ name: {} }}`", clip(text)));
                return Vec::new();
            }
            Err(error) => {
                let fault = self.fault(
                    "expression",
                    at,
                    format!("found {}", error.found),
                    "the name of a measure or a quantity such as `rocker.tip.x`",
                );
                fault.help = error.help;
                return Vec::new();
            }
        }
        match self.name_space.names.get(text) {
            Some(Entity::Parameter(i)) if !(frame.features.states && self.name_space.model.event_that_sets(&[*i]).is_some()) => {
                let fault = self.fault("wrong-column", at, format!("`{text}` is a parameter"), "something that varies during the study");
                fault.help = Some("parameters are in the JSON; to plot one, make it a measure".to_owned());
                return Vec::new();
            }
            Some(Entity::Body(_)) => {
                let fault = self.fault("wrong-column", at, format!("`{text}` is a body"), "a quantity or a point of a body");
                fault.help = Some(format!("for example `{text}.origin` or `{text}.x`"));
                return Vec::new();
            }
            _ => {}
        }
        let allow = Self::column_allow(frame);
        let mut columns = Vec::new();
        for name in self.parts(text) {
            let lowered = self.lower(&name, Origin::Value(text, 0), at, allow, &mut Local::default());
            let Some((lowered, _)) = lowered else { break };
            columns.push(Column { name, dimension: lowered.dimension, value: lowered.id });
        }
        columns
    }

    pub(super) fn plots(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>, files: &DataFiles) -> Vec<Plot> {
        let section = at.key(asked);
        let mut plots = Vec::new();
        for (name, value) in asked.entries() {
            let here = section.key(name);
            let faults = self.faults.len();
            let keys = PlotKeys::of(value);
            let (list, list_at) = if value.is_list() { (Some(value), here) } else { (keys.show.node, here.key(keys.show)) };
            let mut show = Vec::new();
            for (i, item) in list.map(Node::items).unwrap_or_default().iter().enumerate() {
                let Some(text) = item.as_str() else { continue };
                show.extend(self.shown(text, &list_at.index(i), frame));
            }
            let over_at = here.key(keys.over);
            let mut over = None;
            if let Some(text) = keys.over.text() {
                let found = self.shown(text, &over_at, frame);
                if found.len() > 1 {
                    let message = format!("`{}` stands for {} quantities", clip(text), found.len());
                    self.fault("wrong-plot", &over_at, message, "one quantity for the horizontal axis").help =
                        Some(format!("for example `{}`", found[0].name));
                }
                over = found.into_iter().next();
            }
            self.alike(&show, over.as_ref(), &list_at, &over_at, frame);
            let axis = match &over {
                Some(over) => Some(over.dimension),
                None if show.iter().any(|s| !matches!(s.what, ShownWhat::Column(_))) => {
                    frame.swept.first().and_then(|i| self.name_space.parameters.get(*i).copied().flatten())
                }
                None => frame.features.independent,
            };
            let unit = self.plot_unit(keys.unit, &here, axis);
            let x = self.plot_axis(keys.x, &here, axis.as_slice(), frame);
            let unit = unit.or_else(|| x.as_ref().and_then(|x| x.unit.clone()));
            let dimensions: Vec<Dimension> = show.iter().map(|s| s.dimension).collect();
            let y = self.plot_axis(keys.y, &here, &dimensions, frame);
            let right = self.plot_right(keys.right, &here, &show, frame);
            let with = self.plot_with(keys.with, &here, at);
            let mut plot = Plot { name: name.to_owned(), show, over, unit, x, y, right, with, beside: Vec::new() };
            if self.faults.len() == faults {
                plot.beside = self.measured(keys.data, &here, &plot, axis.unwrap_or_default(), files);
            }
            plots.push(plot);
        }
        plots
    }

    /// Curves and values of whole runs cannot share a figure.
    fn alike(&mut self, show: &[Shown], over: Option<&Shown>, list_at: &At<'_, 'n>, over_at: &At<'_, 'n>, frame: &Frame<'n>) {
        let curve = |shown: &Shown| matches!(shown.what, ShownWhat::Column(_));
        if let Some(i) = show.iter().position(|s| curve(s) != curve(&show[0])) {
            let message = format!("`{}` and `{}` in one figure: one is a curve, the other one number per run", show[0].name, show[i].name);
            self.fault("wrong-plot", list_at, message, "only curves, or only scalars");
            return;
        }
        let Some(first) = show.first() else { return };
        if let Some(over) = over {
            if curve(first) != curve(over) {
                let message = if curve(over) {
                    format!("`{}` is a curve, `{}` one number per run", over.name, first.name)
                } else {
                    format!("`{}` is one number per run, `{}` a curve", over.name, first.name)
                };
                self.fault("wrong-plot", over_at, message, "a horizontal axis of the same kind");
            }
        } else if !curve(first) && frame.swept.is_empty() {
            let message = format!("`{}` has one value: the study has no `sweep`", first.name);
            self.fault("wrong-plot", list_at, message, "curves, or scalars of a sweep");
        }
    }

    pub(super) fn plot_unit(&mut self, unit: Entry<'n>, at: &At<'_, 'n>, axis: Option<Dimension>) -> Option<(String, f64)> {
        let text = unit.text()?;
        let here = at.key(unit);
        let (factor, dimension) = self.unit(text, &here)?;
        if axis.is_some_and(|axis| axis != dimension) {
            let expected = axis.map(|axis| axis.name()).unwrap_or_default();
            let fault = self.fault("wrong-dimension", &here, format!("`{}` is a unit of {}", clip(text), dimension.name()), expected);
            fault.help = axis.map(suggest::unit_of);
            return None;
        }
        Some((text.to_owned(), factor))
    }

    /// What a name in a figure refers to; several where it stands for several quantities.
    pub(super) fn shown(&mut self, text: &str, at: &At<'_, 'n>, frame: &Frame<'n>) -> Vec<Shown> {
        let one = |what, dimension| vec![Shown { name: text.to_owned(), what, dimension }];
        if let Some(i) = frame.scalars.iter().position(|(name, _)| name == text) {
            return one(ShownWhat::Scalar(i), frame.scalars[i].1);
        }
        if let Some(i) = frame.features.results.iter().position(|(name, _)| name == text) {
            return one(ShownWhat::Result(i), frame.features.results[i].1);
        }
        if frame.local.symbols.iter().any(|(name, symbol)| *name == text && symbol.is_none()) {
            return Vec::new();
        }
        if let Some(Entity::Parameter(i)) = self.name_space.names.get(text) {
            let i = *i;
            if frame.swept.contains(&i) {
                return one(ShownWhat::Parameter(i), self.name_space.parameters.get(i).copied().flatten().unwrap_or_default());
            }
            self.fault("wrong-plot", at, format!("`{text}` is a parameter that is not swept"), "a column, a scalar or a swept parameter");
            return Vec::new();
        }
        self.expand(text, at, frame)
            .into_iter()
            .map(|c| Shown { name: c.name, what: ShownWhat::Column(c.value), dimension: c.dimension })
            .collect()
    }
}
