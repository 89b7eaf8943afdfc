//! The points of a sweep: a grid over the values of its parameters, and points that are drawn from distributions.

use super::common::case::parameters;
use crate::expression::Id;
use crate::model::{Model, Study, Sweep, Values};
use crate::numerics::sampling::Design;
use statrs::distribution::{ContinuousCDF, Normal};

/// The points of a study's sweep: the grid over its parameters, the last one fastest; one empty point if it sweeps nothing. Parameters
/// whose lists stand side by side are one axis of the grid. At each of its points those that are drawn from distributions follow each
/// other, the same at all.
#[must_use]
pub fn grid(model: &Model, study: &Study) -> Vec<Vec<f64>> {
    let base = parameters(model);
    let mut points = vec![vec![]];
    let mut left = &study.sweep[..];
    while !left.is_empty() {
        let beside = left.iter().skip(1).take_while(|sweep| matches!(sweep.values, Values::Beside(_))).count();
        let (axis, rest) = left.split_at(1 + beside);
        let columns: Vec<Vec<f64>> = axis.iter().map(|sweep| values(model, sweep, &base)).collect();
        let places: Vec<Vec<f64>> = (0..columns[0].len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect();
        points = points.iter().flat_map(|point| places.iter().map(move |place| [&point[..], place].concat())).collect();
        left = rest;
    }
    let Some(samples) = study.samples else { return points };
    let design = Design::new(samples.count, drawn(study).len(), samples.seed);
    let draw = |place: usize, mut point: Vec<f64>| {
        put_drawn(model, study, &base, &design.point(place), &mut point);
        point
    };
    points.iter().flat_map(|point| (0..samples.count).map(|place| draw(place, point.clone())).collect::<Vec<_>>()).collect()
}

/// The values of a swept parameter; one that is to be filled, where they are drawn.
fn values(model: &Model, sweep: &Sweep, base: &[f64]) -> Vec<f64> {
    match &sweep.values {
        Values::Normal { .. } | Values::Uniform { .. } => vec![f64::NAN],
        Values::List(ids) | Values::Beside(ids) => model.pool.values(ids, base),
        &Values::Span { from, to, count, log } => {
            let (a, b) = (model.pool.value(from, base), model.pool.value(to, base));
            let at = |i: usize| {
                let s = if count > 1 { i as f64 / (count - 1) as f64 } else { 0.0 };
                match i {
                    0 => a,
                    _ if i + 1 == count => b,
                    _ if log => a * (b / a).powf(s),
                    _ => a + (b - a) * s,
                }
            };
            (0..count).map(at).collect()
        }
    }
}

/// Numbers of the swept parameters that have a distribution.
#[must_use]
pub fn drawn(study: &Study) -> Vec<usize> {
    (0..study.sweep.len()).filter(|k| study.sweep[*k].values.are_drawn()).collect()
}

/// The values of the parameters with a distribution, in their order, below which each of them is with a chance, all strictly between 0
/// and 1.
#[must_use]
pub fn at_chances(model: &Model, study: &Study, chances: &[f64]) -> Vec<f64> {
    let mut point = vec![f64::NAN; study.sweep.len()];
    put_drawn(model, study, &parameters(model), chances, &mut point);
    drawn(study).into_iter().map(|k| point[k]).collect()
}

/// Puts the values of the parameters with a distribution into a point, by their chances.
fn put_drawn(model: &Model, study: &Study, base: &[f64], chances: &[f64], point: &mut [f64]) {
    for (k, u) in drawn(study).into_iter().zip(chances) {
        point[k] = quantile(&study.sweep[k].values, *u, &|id| model.pool.value(id, base));
    }
}

/// The value of a distribution below which it is with the chance u, 0 < u < 1.
fn quantile(values: &Values, u: f64, value: &dyn Fn(Id) -> f64) -> f64 {
    match *values {
        Values::Normal { mean, deviation } => value(mean) + value(deviation) * Normal::standard().inverse_cdf(u),
        Values::Uniform { from, to } => value(from) + (value(to) - value(from)) * u,
        Values::List(_) | Values::Beside(_) | Values::Span { .. } => f64::NAN,
    }
}
