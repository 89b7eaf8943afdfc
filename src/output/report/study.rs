//! A study as a page has it: its results without the rows and frames that no curve and no picture needs.

use super::axes::Seen;
use super::poses::{self, Coded};
use super::tables::{OF_RUN, OF_STUDY, RowsShown, Thinned};
use crate::output::json_number;
use crate::output::pose::SymbolKind;
use crate::output::posed::{self, forms::faces_of};
use crate::output::sheet::body_color;
use crate::output::text::modes;
use crate::output::view::level;
use crate::results::scene::{LinkKind, Shape, rim, wheel};
use crate::results::{Extremes, Plot, Results, Scene};
use serde_json::{Value, json};

/// Numbers of tables, and of poses, that the page has of a study, about.
const NUMBERS: usize = 60_000;
const POSES: usize = 60_000;

/// A study as a page has it.
#[derive(Clone, Debug, Default)]
pub struct ReportStudy {
    /// An object of JSON.
    pub(super) text: String,
    /// Whether a mechanism in space is to be drawn.
    pub(super) spatial: bool,
}

/// The runs of a sweep as a page has them, taken one by one so that their rows need not stay in memory.
#[derive(Debug)]
pub struct ReportRuns {
    /// Runs that there will be.
    count: usize,
    /// For each run its label's place, and what the page has of it.
    runs: Vec<(usize, Value)>,
    spatial: bool,
}

impl ReportStudy {
    /// The object of JSON that a page has of it.
    #[must_use]
    pub fn json(&self) -> &str {
        &self.text
    }

    /// Of a study of one run; `about` says what it is for.
    #[must_use]
    pub fn of(results: &Results, about: &str) -> Self {
        let thin = Thinned::of(results, OF_STUDY, &|_| true);
        let scenes = scenes(results, POSES);
        let spatial = is_spatial(&scenes);
        Self { text: with_about(value(results, thin, &scenes), about), spatial }
    }

    /// Of a sweep, with its runs; `about` says what it is for.
    #[must_use]
    pub fn of_runs(results: &Results, about: &str, runs: ReportRuns) -> Self {
        let ReportRuns { runs: taken, spatial, .. } = runs;
        let thin = Thinned {
            table: results.table.clone(),
            independent: results.independent.clone(),
            curves: results.curves.clone(),
            shown: RowsShown::default(),
        };
        let mut study = value(results, thin, &[]);
        let mut all: Vec<Value> =
            results.runs.iter().map(|run| json!({ "label": run.label, "results": null, "solution": run.solution })).collect();
        for (i, results) in taken {
            if let Some(run) = all.get_mut(i) {
                run["results"] = results;
            }
        }
        study["runs"] = all.into();
        Self { text: with_about(study, about), spatial }
    }
}

impl ReportRuns {
    /// Of so many runs.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self { count: count.max(1), runs: Vec::new(), spatial: false }
    }

    /// Takes a run by its number from 0. The first one is taken whole, of the others all columns if there is room, else those that
    /// figures of the study show, else none.
    pub fn add(&mut self, number: usize, results: &Results) {
        let first = self.runs.is_empty();
        let most = |all: usize| if first { usize::MAX } else { all / self.count };
        let plotted = |name: &str| results.plots.iter().filter(|plot| !plot.of_runs).any(|plot| shows(plot, name));
        let mut thin = Thinned::of(results, OF_RUN, &|_| true);
        if thin.count() > most(NUMBERS) {
            thin = Thinned::of(results, OF_RUN, &plotted);
        }
        if thin.count() > most(NUMBERS) {
            thin = Thinned::default();
        }
        let poses = if first { POSES / 4 } else { most(POSES) };
        let mut scenes = scenes(results, poses);
        if !first {
            scenes.retain(|(_, scene)| scene.frames.poses.len() <= poses);
        }
        self.spatial |= is_spatial(&scenes);
        self.runs.push((number, value(results, thin, &scenes)));
    }
}

fn shows(plot: &Plot, name: &str) -> bool {
    let right = plot.right.iter().flat_map(|right| &right.show);
    plot.show.iter().chain(&plot.over).chain(right).any(|shown| shown == name)
}

fn is_spatial(scenes: &[(String, Scene)]) -> bool {
    scenes.iter().any(|(_, scene)| scene.dimensions == 3)
}

/// Drawings with about so many numbers of poses together.
fn scenes(results: &Results, most: usize) -> Vec<(String, Scene)> {
    let mut scenes = results.scenes.clone();
    let share = most / scenes.len().max(1);
    scenes.iter_mut().for_each(|(_, scene)| poses::thinned(scene, share));
    scenes
}

/// Results as JSON.
fn value(results: &Results, thin: Thinned, scenes: &[(String, Scene)]) -> Value {
    let Thinned { independent, table, curves, shown } = thin;
    let page = Results {
        model: results.model.clone(),
        study: results.study.clone(),
        kind: results.kind.clone(),
        variants: results.variants.clone(),
        place: results.place.clone(),
        stopped: results.stopped.clone(),
        undefined: results.undefined.clone(),
        parameters: results.parameters.clone(),
        independent,
        table,
        curves,
        scalars: results.scalars.clone(),
        extremes: extremes(results),
        lists: results.lists.clone(),
        shapes: results.shapes.clone(),
        linear: results.linear.clone(),
        events: results.events.clone(),
        expectations: results.expectations.clone(),
        findings: results.findings.clone(),
        certificate: results.certificate.clone(),
        solution: results.solution.clone(),
        scenes: Vec::new(),
        plots: results.plots.clone(),
        statistics: results.statistics.clone(),
        swept: results.swept.clone(),
        runs: Vec::new(),
    };
    // names and numbers alone cannot fail
    let mut value = json(&page);
    value["scenes"] = scenes.iter().map(|(name, scene)| json!([name, drawing(scene)])).collect();
    value["rows"] = json(&shown);
    // shapes as the terminal tells them
    value["shapes"] = results.shapes.iter().map(|shape| json(&modes::words(shape))).collect();
    whole(&mut value);
    value
}

/// Extremes without what is round-off beside the other numbers of the column.
fn extremes(results: &Results) -> Vec<(String, Option<Extremes>)> {
    let mut extremes = results.extremes.clone();
    for (name, both) in &mut extremes {
        let (Some(column), Some(Extremes { min, max })) = (results.table.column(name), both) else { continue };
        let nothing = Seen::of(results, column).round_off();
        [min, max].into_iter().filter(|one| one.value.abs() <= nothing).for_each(|one| one.value = 0.0);
    }
    extremes
}

/// A scene with its frames as differences.
fn drawing(scene: &Scene) -> Value {
    let Coded { at, poses, arrows } = Coded::of(scene);
    let mut value = json(scene);
    value["frames"]["at"] = json(&at);
    value["frames"]["poses"] = json(&poses);
    for (arrow, values) in value["arrows"].as_array_mut().into_iter().flatten().zip(arrows) {
        arrow["values"] = json(&values);
        arrow.as_object_mut().and_then(|arrow| arrow.remove("from"));
    }
    // what figures make of a scene: the colours of bodies, the faces of hulls in space and from where these are seen, outlines of teeth, and
    // tubes of actuators
    for (index, body) in value["bodies"].as_array_mut().into_iter().flatten().enumerate() {
        let [r, g, b] = body_color(index);
        body["color"] = format!("#{r:02x}{g:02x}{b:02x}").into();
        for (shape, of) in body["shapes"].as_array_mut().into_iter().flatten().zip(&scene.bodies[index].shapes) {
            match (scene.dimensions, of) {
                (3, Shape::Hull { points }) => shape["faces"] = json(&faces_of(points)),
                (2, Shape::Gear { center, radius, teeth, first }) => {
                    // in seven digits
                    let short = |p: [f64; 2]| p.map(|x| format!("{x:.6e}").parse().unwrap_or(x));
                    shape["outline"] =
                        wheel([center[0], center[1]], *radius, *teeth, *first).into_iter().map(|p| json(&short(p))).collect();
                    if *radius < 0.0 {
                        shape["rim"] = json(&rim(*radius, *teeth));
                    }
                }
                _ => {}
            }
        }
    }
    for (link, of) in value["links"].as_array_mut().into_iter().flatten().zip(&scene.links) {
        if of.kind == LinkKind::Actuator {
            link["tube"] = json(&posed::tube(of));
        }
        if let Some(link) = link.as_object_mut().filter(|_| of.along.is_empty()) {
            link.remove("along");
        }
    }
    for (joint, of) in value["joints"].as_array_mut().into_iter().flatten().zip(&scene.joints) {
        if let Some(joint) = joint.as_object_mut().filter(|_| of.second.is_empty()) {
            joint.remove("second");
        }
    }
    signs(&mut value, scene);
    if scene.dimensions == 3 {
        let [up, first, second] = level(scene.up);
        let [azimuth, elevation] = posed::eye(scene);
        value["up"] = json(&up);
        value["view"] = json!({ "level": [first, second], "azimuth": azimuth, "elevation": elevation });
    }
    value
}

/// Adds to joints what figures make of them: the sense of a drive; of a hinge with stops their directions in its first body, in the plane
/// rad, and the angle between them; of a slide how far the body that slides reaches beyond its point, m: to its stops, and back to its
/// dashpot, and whether areas hide it; whether a bearing stands above its hinge, and a slot has a frame.
fn signs(value: &mut Value, scene: &Scene) {
    let Some(first) = scene.frames.at.first() else { return };
    let drawn = posed::at(scene, *first);
    let poses = scene.frame(0);
    for (joint, of) in value["joints"].as_array_mut().into_iter().flatten().zip(&scene.joints) {
        let Some((symbol, placement)) = drawn.joints.iter().find(|s| s.name == of.name).and_then(|s| Some((s, s.poses.first()?))) else {
            continue;
        };
        if of.driven {
            joint["sense"] = json(&placement.sense);
        }
        if placement.beyond.iter().any(|reach| *reach > 0.0) {
            joint["beyond"] = json(&placement.beyond);
        }
        if placement.back > 0.0 {
            joint["back"] = json(&placement.back);
        }
        for (key, holds) in [("above", symbol.above), ("framed", symbol.framed), ("hidden", symbol.hidden), ("upper", placement.upper)] {
            if holds {
                joint[key] = true.into();
            }
        }
        if symbol.kind == SymbolKind::Hinge && placement.stops.iter().any(Option::is_some) {
            joint["swing"] = json(&placement.swing);
            if scene.dimensions == 3 {
                joint["far"] = json(&of.stops.map(|stop| posed::joints::far_at_stop(scene, of, stop?)));
                continue;
            }
            let [x, y, _] = scene.direction(poses, of.a.body, &[1.0]);
            joint["ends"] = json(&placement.stops.map(|stop| stop.map(|[u, v]| v.atan2(u) - y.atan2(x))));
        }
    }
}

/// Whole numbers without `.0`.
fn whole(value: &mut Value) {
    match value {
        Value::Number(number) => {
            if let Some(x) = number.as_f64().filter(|_| number.is_f64()) {
                *value = json_number(x);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(whole),
        Value::Object(entries) => entries.values_mut().for_each(whole),
        _ => {}
    }
}

fn json(value: &impl serde::Serialize) -> Value {
    serde_json::to_value(value).unwrap_or_default()
}

fn with_about(mut value: Value, about: &str) -> String {
    value["about"] = in_one_line(about).into();
    value.to_string()
}

/// A text without its line breaks.
pub(super) fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
