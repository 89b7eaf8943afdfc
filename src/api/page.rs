//! What a page says of a model.

use crate::kinematics::survey::{Survey, survey};
use crate::model::{Document, Selection};
use crate::output::{ReportModel, ten_digits};
use crate::studies::common::case::parameters;

/// Makes something of what a report says of a model whose file is called `path` there; of a model with errors, or without a selection,
/// that is its text alone.
pub fn told<T>(document: &Document, selection: Option<&Selection<'_>>, path: &str, make: impl FnOnce(&ReportModel<'_>) -> T) -> T {
    let model = selection.and_then(|selection| document.model(selection).ok());
    let looked = model.as_ref().and_then(|model| survey(model, &parameters(model)).ok());
    let mut overview = looked.as_ref().map(overview).unwrap_or_default();
    overview.extend(selection.into_iter().flat_map(changed));
    let (name, about) = model.as_ref().map_or((document.file(), ""), |model| (&model.name, &model.about));
    make(&ReportModel { name, path, source: document.text(), about, overview: &overview })
}

/// What was given from outside of the file instead of what stands there.
fn changed(selection: &Selection<'_>) -> Vec<(String, String)> {
    let variants = selection.variants.iter().map(|name| ("variant".to_string(), name.clone()));
    variants.chain(selection.sets.iter().map(|(name, value)| ("set".into(), format!("{name} = {value}")))).collect()
}

/// What is worth knowing of a mechanism at a glance.
fn overview(survey: &Survey) -> Vec<(String, String)> {
    let m = &survey.mobility;
    let mass: f64 = survey.bodies.iter().map(|(_, mass, ..)| mass).sum();
    // five digits are enough at a glance
    let mass = format!("{mass:.4e}").parse().unwrap_or(mass);
    let mut out = vec![
        ("bodies", survey.bodies.len().to_string()),
        ("joints", survey.joints.len().to_string()),
        ("loops", survey.loops.len().to_string()),
        ("degrees of freedom", m.freedom.to_string()),
        ("left by the drivers", m.left.to_string()),
        ("mass", format!("{} kg", ten_digits(mass))),
    ];
    if !m.redundant.is_empty() {
        out.push(("redundant constraints", m.redundant.len().to_string()));
    }
    if let Some(four_bar) = &survey.grashof {
        out.push(("Grashof class", four_bar.class.to_string()));
    }
    out.into_iter().map(|(label, value)| (label.to_string(), value)).collect()
}
