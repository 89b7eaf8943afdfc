//! Figures of a study and the drawing of its mechanism, as data for the renderer.

use grashof::expression::Dimension;
use grashof::model::{Model, Plot, Shown, ShownWhat, Study};
use grashof::output::{Axis, Curve, Drawing, Figure, Link, LinkKind, Outline, Placement, Scale, Symbol, SymbolKind, Trace};
use grashof::results::{Outcome, Scene};
use grashof::studies::common::watched::extra_curves;
use grashof::studies::sweep::Run;

/// Switches that are marked by lines in a figure, at most.
const MOST_MARKED: usize = 16;

/// Figures of curves: one curve for each shown column of each run, runs told apart by their labels.
pub(super) fn figures(model: &Model, study: &Study, runs: &[(Option<String>, &Outcome)]) -> Vec<(String, Figure)> {
    study
        .plots
        .iter()
        .filter(|p| p.show.iter().chain(&p.over).all(|s| matches!(s.what, ShownWhat::Column(_))))
        .map(|plot| (plot.name.clone(), figure(model, study, plot, runs)))
        .collect()
}

fn figure(model: &Model, study: &Study, plot: &Plot, runs: &[(Option<String>, &Outcome)]) -> Figure {
    let mut curves = Vec::new();
    let several = runs.len() > 1;
    for (label, outcome) in runs {
        let x = match &plot.over {
            Some(over) => column(study, outcome, over),
            None => outcome.places.clone(),
        };
        for shown in &plot.show {
            let y = column(study, outcome, shown);
            let name = match label {
                Some(label) if several && plot.show.len() > 1 => format!("{}, {label}", shown.name),
                Some(label) if several => label.clone(),
                _ => shown.name.clone(),
            };
            let points = joined(&x, &y, &outcome.switches, plot.over.is_some());
            curves.push(Curve { label: name, unit: Some(shown.dimension.si()), points });
        }
    }
    let (x, factor) = axis(
        plot,
        match (&plot.over, runs.first()) {
            (Some(over), _) => (over.name.clone(), over.dimension.si()),
            (None, Some((_, outcome))) => (outcome.independent.clone(), study.independent.map_or_else(String::new, |d| d.si())),
            (None, None) => (String::new(), String::new()),
        },
    );
    scale_x(&mut curves, factor);
    // lines at switches help where there is one run with a few; many would cover the curves
    let breaks = match (&plot.over, runs) {
        (None, [(_, outcome)]) if outcome.switches.len() <= MOST_MARKED => {
            outcome.switches.iter().map(|&i| outcome.places[i] / factor).collect()
        }
        _ => vec![],
    };
    let same_plane = plot.over.is_some() && plot.show.iter().chain(&plot.over).all(|s| s.dimension == Dimension::LENGTH);
    let y = if several && plot.show.len() == 1 {
        Axis { label: plot.show[0].name.clone(), unit: plot.show[0].dimension.si(), ..Axis::default() }
    } else {
        Axis::default()
    };
    Figure { title: title(model, study, plot), x, y, curves, breaks, equal: same_plane, ..Figure::default() }
}

/// Points of a curve; where a path in the plane jumps at a switch, the line is broken.
fn joined(x: &[f64], y: &[f64], switches: &[usize], path: bool) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(x.len());
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        points.push((*x, *y));
        if path && switches.contains(&i) {
            points.push((f64::NAN, f64::NAN));
        }
    }
    points
}

/// Figures of scalars over a swept parameter: one curve for each shown scalar.
pub(super) fn sweep_figures(model: &Model, study: &Study, runs: &[Run]) -> Vec<(String, Figure)> {
    let mut out = Vec::new();
    for plot in &study.plots {
        if plot.show.iter().any(|s| matches!(s.what, ShownWhat::Column(_))) {
            continue;
        }
        let value = |shown: &Shown, run: &Run| -> f64 {
            let outcome = run.result.as_ref().ok();
            match shown.what {
                ShownWhat::Scalar(i) => outcome.and_then(|o| o.scalars.get(i).copied()).unwrap_or(f64::NAN),
                ShownWhat::Result(i) => outcome.and_then(|o| o.results.get(i).copied()).unwrap_or(f64::NAN),
                ShownWhat::Parameter(p) => {
                    study.sweep.iter().position(|s| s.parameter == p).and_then(|k| run.at.get(k).copied()).unwrap_or(f64::NAN)
                }
                ShownWhat::Column(_) => f64::NAN,
            }
        };
        let first = study.sweep.first().map(|s| s.parameter);
        let over = plot.over.clone().or_else(|| {
            let p = &model.parameters[first?];
            Some(Shown { name: p.name.clone(), what: ShownWhat::Parameter(first?), dimension: p.dimension })
        });
        let Some(over) = over else { continue };
        let (x, factor) = axis(plot, (over.name.clone(), over.dimension.si()));
        let mut curves: Vec<Curve> = plot
            .show
            .iter()
            .map(|s| Curve {
                label: s.name.clone(),
                unit: Some(s.dimension.si()),
                points: runs.iter().map(|r| (value(&over, r), value(s, r))).collect(),
            })
            .collect();
        scale_x(&mut curves, factor);
        out.push((plot.name.clone(), Figure { title: title(model, study, plot), x, curves, ..Figure::default() }));
    }
    out
}

fn title(model: &Model, study: &Study, plot: &Plot) -> String {
    format!("{}, {}: {}", model.name, study.name, plot.name.replace('_', " "))
}

/// The horizontal axis and the factor that its values are divided by.
fn axis(plot: &Plot, (label, unit): (String, String)) -> (Axis, f64) {
    match &plot.unit {
        Some((word, factor)) => (Axis { label, unit: word.clone(), scale: Scale::Linear }, *factor),
        None => (Axis { label, unit, scale: Scale::Linear }, 1.0),
    }
}

fn scale_x(curves: &mut [Curve], factor: f64) {
    for point in curves.iter_mut().flat_map(|c| &mut c.points) {
        point.0 /= factor;
    }
}

/// Values of a column along a run.
fn column(study: &Study, outcome: &Outcome, shown: &Shown) -> Vec<f64> {
    let ShownWhat::Column(id) = shown.what else { return vec![] };
    let index = study
        .columns
        .iter()
        .position(|c| c.value == id)
        .or_else(|| extra_curves(study).iter().position(|e| *e == id).map(|i| study.columns.len() + i));
    index.map_or_else(Vec::new, |i| outcome.rows.iter().map(|r| r[i]).collect())
}

/// The drawing of a scene of a study; that of the mechanism itself is titled by the model alone.
pub(super) fn drawing(model: &Model, study: &str, name: &str, scene: &Scene) -> Drawing {
    let kind = |word: &str| match word {
        "slider" | "cylindrical" | "planar" | "screw" => Some(SymbolKind::Slide),
        "pin-in-slot" => Some(SymbolKind::Slot),
        "spherical" | "universal" => Some(SymbolKind::Ball),
        "fixed" => Some(SymbolKind::Weld),
        "free" | "distance" => None,
        _ => Some(SymbolKind::Hinge),
    };
    let joints = scene.joints.iter().filter_map(|j| {
        let poses = j.at.iter().zip(&j.along).map(|(at, along)| Placement { at: *at, along: *along, way: None }).collect();
        Some(Symbol { name: j.name.clone(), kind: kind(j.kind)?, grounded: j.grounded, poses })
    });
    Drawing {
        title: if name == "mechanism" { model.name.clone() } else { format!("{}, {study}: {}", model.name, name.replace('-', " ")) },
        bodies: scene.bodies.iter().map(|(name, poses)| Outline { name: name.clone(), poses: poses.clone() }).collect(),
        joints: joints.collect(),
        links: scene
            .springs
            .iter()
            .map(|(name, poses)| Link { name: name.clone(), kind: LinkKind::Spring, poses: poses.clone() })
            .collect(),
        traces: scene.traces.iter().map(|(name, points)| Trace { name: name.clone(), points: points.clone() }).collect(),
    }
}
