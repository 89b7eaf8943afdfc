//! What goes wrong, as errors.

use crate::mechanism::BuildFault;
use crate::model::{Diagnostic, Document, Report};
use crate::results::{Failure, Undefined, Unknown, Unsolved};
use crate::studies::loader::NotLoaded;
use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;

/// Why there is no model, no study or no result.
#[derive(Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Error {
    /// A file cannot be read.
    Read { path: PathBuf, cause: std::io::Error },
    /// The file, or what is asked of it, is wrong: all faults, each with code, place and remedy.
    Wrong(Report),
    /// There is nothing of a name.
    Unknown(Unknown),
    /// A study has no result.
    Failed { study: String, failure: Box<Failure>, report: Report },
    /// What the mechanism cannot give, and a remedy.
    Refused { message: String, help: String },
}

impl Error {
    /// A failure of a study, with its places in the file.
    pub(super) fn failed(document: &Document, study: &str, failure: Failure) -> Self {
        let report = explained(document, study, &failure);
        Self::Failed { study: study.into(), failure: Box::new(failure), report }
    }

    /// Why a study could not be loaded.
    pub(super) fn not_loaded(document: &Document, why: NotLoaded) -> Self {
        match why {
            NotLoaded::Wrong(report) => Self::Wrong(report),
            NotLoaded::Failed { study, failure } => Self::failed(document, &study, failure),
            NotLoaded::Stopped { study, of, reason } => Self::Refused {
                message: format!("study `{study}` takes a scalar of `{of}`, which stopped on its way: {reason}"),
                help: "see to that study first".into(),
            },
        }
    }

    /// All faults with their places in the file, where there are some.
    #[must_use]
    pub fn report(&self) -> Option<&Report> {
        match self {
            Self::Wrong(report) | Self::Failed { report, .. } => Some(report),
            _ => None,
        }
    }

    /// Path of keys of the first fault in the file, as `joints.O.revolute[1]`; empty if there is none.
    #[must_use]
    pub fn place(&self) -> &str {
        self.first().map_or("", |d| &d.place)
    }

    /// What to do about it; empty if nothing is known.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::Refused { help, .. } => help.clone(),
            Self::Unknown(unknown) => unknown.help(),
            _ => self.first().and_then(|d| d.help.clone()).unwrap_or_default(),
        }
    }

    /// Whether it is a name that there is not: in the call, or among the parameters and variants that were asked for from outside of
    /// the file.
    #[must_use]
    pub fn is_unknown_name(&self) -> bool {
        let outside = |d: &Diagnostic| d.code.starts_with("unknown-") && d.place.is_empty();
        match self {
            Self::Unknown(_) => true,
            Self::Wrong(report) => !report.diagnostics.is_empty() && report.diagnostics.iter().all(outside),
            _ => false,
        }
    }

    fn first(&self) -> Option<&Diagnostic> {
        self.report().and_then(|report| report.diagnostics.first())
    }

    /// The kind of the first fault, a word to search for.
    #[must_use]
    pub fn code(&self) -> Cow<'_, str> {
        match self {
            Self::Read { .. } => "unreadable".into(),
            Self::Unknown(_) => "unknown".into(),
            Self::Refused { .. } => "refused".into(),
            Self::Wrong(_) | Self::Failed { .. } => self.first().map_or("unknown".into(), |d| d.code.into()),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, cause } => write!(f, "cannot read `{}`: {}", path.display(), super::files::why(cause)),
            Self::Wrong(report) | Self::Failed { report, .. } => f.write_str(report.render(false).trim_end()),
            Self::Unknown(unknown) => unknown.fmt(f),
            Self::Refused { message, help } => write!(f, "{message}; {help}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read { cause, .. } => Some(cause),
            Self::Failed { failure, .. } => Some(failure.as_ref()),
            Self::Unknown(unknown) => Some(unknown),
            Self::Wrong(_) | Self::Refused { .. } => None,
        }
    }
}

impl From<Unknown> for Error {
    fn from(unknown: Unknown) -> Self {
        Self::Unknown(unknown)
    }
}

/// Why a study has no result, with its places in the file; `study` is empty outside of studies.
#[must_use]
pub fn explained(document: &Document, study: &str, failure: &Failure) -> Report {
    let of_study = |message: &str| if study.is_empty() { message.to_string() } else { format!("study `{study}`: {message}") };
    let one = |code: &'static str, place: &str, message: String, help: &str| {
        vec![document.diagnostic(code, place, message, "", Some(help.to_string()))]
    };
    Report::new(match failure {
        Failure::Model(faults) => {
            let at = |f: &BuildFault| document.diagnostic(f.code, &f.place, f.message.clone(), f.expected.clone(), f.help.clone());
            faults.iter().map(at).collect()
        }
        Failure::Study { code, message, place, help } => one(code, place, message.clone(), help),
        Failure::Unsolved(Unsolved { message, place, help }) => one("unsolved", place, of_study(message), help),
        Failure::Undefined(Undefined { message, place, help }) => one("undefined", place, of_study(message), help),
        Failure::Numerical { message, help } => one("numerical", &format!("studies.{study}"), of_study(message), help),
    })
}
