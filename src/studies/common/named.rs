//! An outcome with names: the [`Results`] of one run.

use super::energies::is_energy;
use super::outcome::Outcome;
use super::scene::{beyond, fill_arrows};
use super::watched::{extra_curves, of_pictures};
use crate::expression::{Dimension, Id, Node, parse_unit};
use crate::model::{self, Kind, Model, Quantity, Shown, ShownWhat, Study};
use crate::results::{By, Column, LinearSystem, Plot, PlotAxis, PlotBeside, PlotRight, Results, Scalar, ShownIn, Table};

/// What one run of a study has come to, with names.
#[must_use]
pub fn named(model: &Model, study: &Study, mut outcome: Outcome) -> Results {
    let columns = study.columns.iter();
    let scalars = scalars(model, study, &outcome);
    let (table, curves) = tables(model, study, &mut outcome);
    let columns_of = |name: &str| table.columns.iter().chain(&curves).find(|c| c.name == name).map(|c| c.values.as_slice());
    outcome.scenes.iter_mut().for_each(|(_, scene)| fill_arrows(study, scene, &outcome.places, &columns_of));
    let unit = shown_in(model, study.independent.unwrap_or(Dimension::NONE));
    for list in &mut outcome.lists {
        list.shown_in = parse_unit(&list.unit).and_then(|(_, dimension)| shown_in(model, dimension));
    }
    outcome.findings.extend(outcome.scenes.first().and_then(|(_, scene)| beyond(study, &outcome.independent, unit, scene)));
    Results {
        model: model.name.clone(),
        study: study.name.clone(),
        kind: study.kind.name().into(),
        variants: model.variants.clone(),
        place: study.place.clone(),
        parameters: parameters(model, outcome.parameters.iter().map(|(_, value)| *value)),
        independent: column(model, &outcome.independent, study.independent.unwrap_or(Dimension::NONE), outcome.places),
        table,
        curves,
        scalars,
        extremes: columns.zip(&outcome.extremes).map(|(c, extremes)| (c.name.clone(), *extremes)).collect(),
        stopped: outcome.stopped,
        undefined: outcome.undefined,
        lists: outcome.lists,
        shapes: outcome.shapes,
        linear: outcome.linear,
        events: outcome.events,
        expectations: outcome.expectations,
        findings: outcome.findings,
        certificate: outcome.certificate,
        solution: None,
        scenes: outcome.scenes,
        plots: plots(model, study),
        statistics: Vec::new(),
        swept: Vec::new(),
        runs: Vec::new(),
    }
}

/// A column of values.
pub(crate) fn column(model: &Model, name: &str, dimension: Dimension, values: Vec<f64>) -> Column {
    let (quantity, unit) = (dimension.quantity().into(), dimension.si());
    Column { name: name.into(), quantity, unit, shown_in: shown_in(model, dimension), values }
}

/// [`column`] of a value of the study.
pub(crate) fn column_of(model: &Model, study: &Study, (name, dimension, value): (&str, Dimension, Id), values: Vec<f64>) -> Column {
    let (quantity, shown_in) = told(model, study, dimension, value);
    Column { quantity, shown_in, ..column(model, name, dimension, values) }
}

/// What a value measures, in words, and the unit to show it in: an energy, whose dimension is that of a torque, in J.
fn told(model: &Model, study: &Study, dimension: Dimension, value: Id) -> (String, Option<ShownIn>) {
    let asked = shown_in(model, dimension);
    if is_energy(model, study, dimension, value) {
        return ("energy".into(), asked.or_else(|| Some(ShownIn { unit: "J".into(), size: 1.0 })));
    }
    (dimension.quantity().into(), asked)
}

/// The unit in which the model asks to show numbers of a dimension.
pub(crate) fn shown_in(model: &Model, dimension: Dimension) -> Option<ShownIn> {
    let asked = model.units.iter().find(|unit| unit.dimension.is_shown_as(dimension))?;
    Some(ShownIn { unit: asked.name.clone(), size: asked.size })
}

/// A named number.
pub(crate) fn scalar(model: &Model, name: &str, dimension: Dimension, value: f64, by: By) -> Scalar {
    let (quantity, unit) = (dimension.quantity().into(), dimension.si());
    Scalar { name: name.into(), quantity, unit, shown_in: shown_in(model, dimension), value, by }
}

/// Parameters by name.
pub(crate) fn parameters(model: &Model, values: impl Iterator<Item = f64>) -> Vec<Scalar> {
    model.parameters.iter().zip(values).map(|(p, x)| parameter(model, p, x)).collect()
}

/// A parameter in the unit that the model asks for, else in that in which the file writes it.
pub(crate) fn parameter(model: &Model, of: &model::Parameter, value: f64) -> Scalar {
    let mut shown = scalar(model, &of.name, of.dimension, value, By::File);
    let written = || of.unit.clone().map(|(unit, size)| ShownIn { unit, size });
    shown.shown_in = shown.shown_in.or_else(written);
    shown
}

/// The figures of a study; the ends of their axes are those for the parameters of the file.
pub(crate) fn plots(model: &Model, study: &Study) -> Vec<Plot> {
    let of_run = |s: &Shown| matches!(s.what, ShownWhat::Column(_));
    let values = super::case::parameters(model);
    let range = |axis: &model::PlotAxis| axis.ends.map(|end| end.map(|id| model.pool.value(id, &values)).filter(|x| x.is_finite()));
    let axis = |axis: &model::PlotAxis| PlotAxis { si: axis.dimension.si(), unit: axis.unit.clone(), range: range(axis) };
    let names = |show: &[Shown]| show.iter().map(|s| s.name.clone()).collect();
    let beside = |curve: &model::Beside| PlotBeside {
        label: curve.label.clone(),
        of: curve.of.clone(),
        x: curve.points.iter().map(|p| p.0).collect(),
        y: curve.points.iter().map(|p| p.1).collect(),
        measured: curve.measured,
    };
    let plot = |p: &model::Plot| Plot {
        name: p.name.clone(),
        show: names(&p.show),
        over: p.over.as_ref().map(|s| s.name.clone()),
        unit: p.unit.clone(),
        of_runs: !p.show.iter().chain(&p.over).all(of_run),
        path: is_path(model, p),
        range: p.x.as_ref().map(range).unwrap_or_default(),
        y: p.y.as_ref().map(axis),
        right: p.right.as_ref().map(|(show, of)| PlotRight { show: names(show), axis: axis(of) }),
        beside: p.beside.iter().map(beside).collect(),
    };
    study.plots.iter().map(plot).collect()
}

/// Whether the axes of a figure are coordinates of one place, a point or the centre of mass.
fn is_path(model: &Model, plot: &model::Plot) -> bool {
    let coordinate = |shown: &Shown| {
        let ShownWhat::Column(id) = shown.what else { return None };
        let Node::Input(input) = model.pool.node(id) else { return None };
        match model.inputs[input as usize] {
            Quantity::Point { at, axis, order: 0 } => Some((Some(at), axis)),
            Quantity::Com { axis, order: 0 } => Some((None, axis)),
            _ => None,
        }
    };
    let Some((place, axis)) = plot.over.as_ref().and_then(coordinate) else { return false };
    plot.show.iter().all(|shown| coordinate(shown).is_some_and(|(own, other)| own == place && other != axis))
}

/// Those taken from other studies, those of the kind that are there, those of the file.
fn scalars(model: &Model, study: &Study, outcome: &Outcome) -> Vec<Scalar> {
    let taken = study.take.iter().map(|t| scalar(model, &t.name, t.dimension, t.value, By::Study));
    // a kind may name results that this mechanism does not have, as the frequency of a mode, or a turn where nothing turns
    let own = |name: &str| outcome.lists.is_empty() && name != "turns_fully";
    let present = study.results.iter().zip(&outcome.results).filter(|(r, value)| own(&r.name) || !value.is_nan());
    let of_kind = present.map(|(r, value)| scalar(model, &r.name, r.dimension, *value, By::Kind));
    let own = study.scalars.iter().zip(&outcome.scalars).map(|(s, value)| {
        let (quantity, shown_in) = told(model, study, s.dimension, s.value);
        Scalar { quantity, shown_in, ..scalar(model, &s.name, s.dimension, *value, By::File) }
    });
    taken.chain(of_kind).chain(own).collect()
}

/// The table of the kind, and the curves that only figures show.
fn tables(model: &Model, study: &Study, outcome: &mut Outcome) -> (Table, Vec<Column>) {
    match study.kind {
        Kind::Modes(_) => return (modes(model, outcome), Vec::new()),
        Kind::Linearize(_) => return (outcome.linear.as_ref().map_or_else(Table::default, state), Vec::new()),
        _ => {}
    }
    // rows are not kept beside their columns
    let rows = std::mem::take(&mut outcome.rows);
    let values = |k: usize| if k < rows.width() { rows.column(k).collect() } else { Vec::new() };
    let columns =
        study.columns.iter().enumerate().map(|(k, c)| column_of(model, study, (&c.name, c.dimension, c.value), values(k))).collect();
    let named = |id| of_pictures(study).find(|s| s.what == ShownWhat::Column(id));
    let extra = extra_curves(study).into_iter().enumerate();
    let curves =
        extra.filter_map(|(k, id)| named(id).map(|s| column_of(model, study, (&s.name, s.dimension, id), values(study.columns.len() + k))));
    let mut curves: Vec<Column> = curves.collect();
    curves.extend(aliases(study, &curves).into_iter().map(|(s, k)| column(model, &s.name, s.dimension, values(k))));
    let (switches, selected_from) = (std::mem::take(&mut outcome.switches), outcome.selected_from);
    (Table { columns, switches, selected_from, reasons: None }, curves)
}

/// What pictures show under another name than that of the column with its values, and where among the rows these are.
fn aliases<'s>(study: &'s Study, curves: &[Column]) -> Vec<(&'s Shown, usize)> {
    let mut found: Vec<(&Shown, usize)> = Vec::new();
    let known = |name: &str| study.columns.iter().any(|c| c.name == name) || curves.iter().any(|c| c.name == name);
    for shown in of_pictures(study) {
        let ShownWhat::Column(id) = shown.what else { continue };
        if known(&shown.name) || found.iter().any(|(other, _)| other.name == shown.name) {
            continue;
        }
        let place = study.columns.iter().map(|c| c.value).chain(extra_curves(study)).position(|value| value == id);
        found.extend(place.map(|place| (shown, place)));
    }
    found
}

/// The outputs in the state of a linearised motion, one row.
fn state(system: &LinearSystem) -> Table {
    let values = system.outputs.iter().zip(&system.values[3]);
    Table {
        columns: values.map(|(name, y)| Column { name: name.clone(), values: vec![*y], ..Column::default() }).collect(),
        ..Table::default()
    }
}

/// A column by its unit.
fn plain(model: &Model, name: &str, unit: &str, values: Vec<f64>) -> Column {
    let shown_in = parse_unit(unit).and_then(|(_, dimension)| shown_in(model, dimension));
    Column { name: name.into(), quantity: String::new(), unit: unit.into(), shown_in, values }
}

/// One row a mode: its numbers, then its shape by coordinates.
fn modes(model: &Model, outcome: &Outcome) -> Table {
    let list = |name: &str| outcome.lists.iter().find(|l| l.name == name).map(|l| &l.values);
    let count = outcome.shapes.len();
    let mut columns = vec![plain(model, "mode", "", (1..=count).map(|i| i as f64).collect())];
    for (name, unit, of) in MODE_NUMBERS {
        // eigenvalues in pairs take the place of those of a mechanism without damping
        if let Some(values) = list(of).filter(|_| of != "eigenvalues" || list("eigenvalues_real").is_none()) {
            columns.push(plain(model, name, unit, (0..count).map(|i| values.get(i).copied().unwrap_or(f64::NAN)).collect()));
        }
    }
    for (k, (name, _)) in outcome.shapes.first().into_iter().flatten().enumerate() {
        let unit = if name.ends_with(".phase") { "rad" } else { "" };
        columns.push(plain(model, name, unit, outcome.shapes.iter().map(|shape| shape.get(k).map_or(f64::NAN, |(_, x)| *x)).collect()));
    }
    Table { columns, ..Table::default() }
}

/// Names and units of the numbers of each mode, with the lists that hold them.
const MODE_NUMBERS: [(&str, &str, &str); 5] = [
    ("eigenvalue_real", "1/s", "eigenvalues_real"),
    ("eigenvalue_imaginary", "1/s", "eigenvalues_imaginary"),
    ("eigenvalue", "1/s^2", "eigenvalues"),
    ("frequency", "rad/s", "frequencies"),
    ("damping_ratio", "", "damping_ratios"),
];
