//! The report of a run: one page with all its studies.

use super::{Common, code, files};
use grashof::kinematics::survey::{Survey, survey};
use grashof::model::Document;
use grashof::output::{Report, ReportModel, Staging};
use grashof::studies::common::case::parameters;
use std::path::Path;

/// Its name. The name of a study has no point, so that no file of a study is called so.
pub(super) const FILE: &str = "report.html";

/// A report without studies.
pub(super) fn begun(document: &Document, common: &Common) -> Report {
    // where it lies is nobody's business to whom the page is sent
    let path = Path::new(document.file()).file_name().and_then(|name| name.to_str()).unwrap_or_default();
    with_model(document, common, path, Report::new)
}

/// What a page has of a model, without studies; none if it has errors.
pub(super) fn model_json(document: &Document, common: &Common) -> Option<serde_json::Value> {
    let sound = files::selection(common, None).is_some_and(|selection| document.model(&selection).is_ok());
    sound.then(|| with_model(document, common, document.file(), |model| model.json()))
}

/// Makes something of what a report says of a model whose file is called `path` there.
fn with_model<T>(document: &Document, common: &Common, path: &str, make: impl FnOnce(&ReportModel<'_>) -> T) -> T {
    let model = files::selection(common, None).and_then(|selection| document.model(&selection).ok());
    let looked = model.as_ref().and_then(|model| survey(model, &parameters(model)).ok());
    let overview = looked.as_ref().map(overview).unwrap_or_default();
    let (name, about) = model.as_ref().map_or((document.file(), ""), |model| (&model.name, &model.about));
    make(&ReportModel { name, path, source: document.text(), about, overview: &overview })
}

/// What is worth knowing of a mechanism at a glance.
fn overview(survey: &Survey) -> Vec<(String, String)> {
    let m = &survey.mobility;
    let mass: f64 = survey.bodies.iter().map(|(_, mass, ..)| mass).sum();
    let mut out = vec![
        ("bodies", survey.bodies.len().to_string()),
        ("joints", survey.joints.len().to_string()),
        ("loops", survey.loops.len().to_string()),
        ("degrees of freedom", m.freedom.to_string()),
        ("left by the drivers", m.left.to_string()),
        ("mass", format!("{} kg", grashof::output::ten_digits(mass))),
    ];
    if !m.redundant.is_empty() {
        out.push(("redundant constraints", m.redundant.len().to_string()));
    }
    if let Some(four_bar) = &survey.grashof {
        out.push(("Grashof class", four_bar.class.to_string()));
    }
    out.into_iter().map(|(label, value)| (label.to_string(), value)).collect()
}

/// Writes a report, or takes away the one of an earlier run if none is wanted; one without studies changes nothing. The code is that of
/// what could not be written.
pub(super) fn written(report: Option<Report>, directory: &Path, common: &Common) -> u8 {
    let mut staging = Staging::new();
    match report {
        Some(report) if report.is_empty() => return code::DONE,
        Some(report) => staging.add(FILE, report.html()),
        None if directory.join(FILE).exists() => {}
        None => return code::DONE,
    }
    match files::commit(&staging, directory, FILE, common) {
        Ok(()) => code::DONE,
        Err(unwritten) => unwritten,
    }
}
