//! Figures and pictures that move.

use crate::errors::raised;
use grashof::Error;
use grashof::output::{self, Curve, Figure, Film, Pace, Shot, ShotOptions, moving_svg, render_figure};
use grashof::results::{Plot, Results, Unknown};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Figures as dictionaries: those of the study that have these names, or one of columns that have.
pub(crate) fn figures<'py>(py: Python<'py>, mut results: Results, names: &[String], over: Option<String>) -> PyResult<Bound<'py, PyAny>> {
    results.plots = asked(&results, names, over).map_err(|unknown| raised(py, &unknown.into()))?;
    let figures = py.detach(|| output::figures(&results));
    let all = figures.iter().map(|(name, figure)| dictionary(py, name, figure)).collect::<PyResult<Vec<_>>>()?;
    Ok(PyList::new(py, all)?.into_any())
}

/// The figures that are asked for.
fn asked(results: &Results, names: &[String], over: Option<String>) -> Result<Vec<Plot>, Unknown> {
    let plot = |name: &String| results.plots.iter().find(|plot| plot.name == *name).cloned();
    if names.is_empty() {
        return Ok(results.plots.clone());
    }
    // a name may be that of a figure and of a column: with another axis than the figure's it is the column
    if over.is_none()
        && let Some(plots) = names.iter().map(plot).collect::<Option<Vec<_>>>()
    {
        return Ok(plots);
    }
    let in_table = |name: &str| results.table.column(name).is_some();
    let in_runs = |name: &str| results.runs.iter().filter_map(|run| run.results.as_ref()).any(|run| run.column(name).is_ok());
    let of_runs = results.table.reasons.is_some() && names.iter().chain(&over).all(|name| in_table(name));
    for name in names.iter().chain(&over) {
        if !in_table(name) && results.column(name).is_err() && !in_runs(name) {
            return Err(Unknown { what: "figure or column", name: name.clone(), known: known(results) });
        }
    }
    Ok(vec![Plot { name: names.join(", "), show: names.to_vec(), over, of_runs, ..Plot::default() }])
}

/// Names of the figures and columns, of a sweep also the columns of its runs.
fn known(results: &Results) -> Vec<String> {
    let of_run = results.runs.iter().find_map(|run| run.results.as_ref()).map_or(&[][..], |run| &run.table.columns);
    let columns = results.table.columns.iter().chain(of_run).map(|column| &column.name);
    let mut known: Vec<String> = Vec::new();
    for name in results.plots.iter().map(|plot| &plot.name).chain(columns) {
        if !known.contains(name) {
            known.push(name.clone());
        }
    }
    known
}

/// A figure as a dictionary, its curves as arrays.
fn dictionary<'py>(py: Python<'py>, name: &str, figure: &Figure) -> PyResult<Bound<'py, PyDict>> {
    let made = PyDict::new(py);
    made.set_item("name", name)?;
    made.set_item("title", &figure.title)?;
    made.set_item("x", (&figure.x.label, &figure.x.unit))?;
    made.set_item("y", (&figure.y.label, &figure.y.unit))?;
    made.set_item("equal", figure.equal)?;
    made.set_item("breaks", figure.breaks.clone())?;
    let curves = figure.curves.iter().map(|curve| curve_of(py, curve, &figure.y.unit)).collect::<PyResult<Vec<_>>>()?;
    made.set_item("curves", curves)?;
    let styles = figure.styles().into_iter().zip(&figure.curves).map(|((color, dash), curve)| (color, dash, curve.dots));
    made.set_item("styles", styles.collect::<Vec<_>>())?;
    Ok(made)
}

/// Label, unit and points of a curve, n × 2.
fn curve_of<'py>(py: Python<'py>, curve: &Curve, unit: &str) -> PyResult<(String, String, Bound<'py, PyAny>)> {
    let points: Vec<f64> = curve.points.iter().flat_map(|(x, y)| [*x, *y]).collect();
    let points = PyArray1::from_vec(py, points).reshape([curve.points.len(), 2])?.into_any();
    Ok((curve.label.clone(), curve.unit.clone().unwrap_or_else(|| unit.into()), points))
}

/// The SVG text of each figure, by name.
pub(crate) fn figures_svg(results: &Results) -> Result<Vec<(String, String)>, String> {
    let drawn = |(name, figure): (String, Figure)| match render_figure(&figure) {
        Ok(picture) => Ok((name, picture.svg)),
        Err(error) => Err(error.to_string()),
    };
    output::figures(results).into_iter().map(drawn).collect()
}

/// A motion as the text of an SVG that moves.
pub(crate) fn animation(results: &Results, mode: usize, width: usize, rate: f64, pace: Pace) -> Result<String, Error> {
    let refused = |message: String, help: &str| Error::Refused { message, help: help.into() };
    let moving = results.moving();
    let Some(index) = moving.get(mode) else {
        let message = format!("study `{}` has {} drawings that move, and none of number {mode}", results.study, moving.len());
        return Err(refused(message, "take a study of a motion, as `kinematics`, `inverse`, `dynamics`, `periodic` or `modes`"));
    };
    let (name, scene) = &results.scenes[*index];
    let shot = Shot::of(results, scene, &ShotOptions { rate, pace, repeats: true });
    let shot = shot.map_err(|message| refused(message, "show it as a whole with `duration=10`, or with fewer pictures by `rate`"))?;
    Ok(moving_svg(&Film::new(&results.model, &results.study, name, scene, &shot), width))
}
