//! The report of a run: one page with all its studies.

use super::{Common, code, files};
use grashof::api::told;
use grashof::model::Document;
use grashof::output::{Report, ReportFault, ReportModel, Staging};
use serde_json::Value;
use std::path::Path;

/// Its name. The name of a study has no point, so that no file of a study is called so.
pub(super) const FILE: &str = "report.html";

/// A report without studies.
pub(super) fn begun(document: &Document, common: &Common) -> Report {
    // where it lies is nobody's business to whom the page is sent
    let path = Path::new(document.file()).file_name().and_then(|name| name.to_str()).unwrap_or_default();
    with_model(document, common, path, Report::new)
}

/// Lists a study without results, with what it is for and the errors that were printed.
pub(super) fn add_failed(report: &mut Report, study: &str, about: &str, errors: &[Value]) {
    let text = |error: &Value, key: &str| error[key].as_str().unwrap_or_default().to_string();
    let fault = |error: &Value| ReportFault { message: text(error, "message"), place: text(error, "path"), help: text(error, "help") };
    report.add_failed(study, about, &errors.iter().map(fault).collect::<Vec<_>>());
}

/// What a page has of a model, without studies; none if it has errors.
pub(super) fn model_json(document: &Document, common: &Common) -> Option<serde_json::Value> {
    let sound = files::selection(common, None).is_some_and(|selection| document.model(&selection).is_ok());
    sound.then(|| with_model(document, common, document.file(), |model| model.json()))
}

/// Makes something of what a report says of a model whose file is called `path` there.
fn with_model<T>(document: &Document, common: &Common, path: &str, make: impl FnOnce(&ReportModel<'_>) -> T) -> T {
    told(document, files::selection(common, None).as_ref(), path, make)
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
