//! The model of a selection, and everything that is wrong with a file.

use super::diagnostics::Report;
use super::document::{Document, Selection};
use super::fault::{Fault, Spot};
use super::inquiry::Inquiry;
use super::whole::Model;
use crate::expression::CALLED;
use std::collections::HashSet;

impl Document {
    /// The model for a selection: variants merged, everything decoded and checked, the study too if one is named.
    ///
    /// # Errors
    /// Everything that is wrong with it. Warnings alone are no error; [`Self::check_all`] shows them.
    pub fn model(&self, selection: &Selection<'_>) -> Result<Model, Report> {
        let mut inquiry = Inquiry::new(self, selection);
        let mut faults = inquiry.form();
        if faults.is_empty() {
            match selection.study {
                Some(name) if self.study_node(name).is_none() => faults.push(self.unknown_study(name, selection.caller)),
                Some(name) => return inquiry.model_for(Some(name)),
                None => return inquiry.model_for(None),
            }
        }
        Err(self.report(&faults))
    }

    /// Everything that is wrong with the file: its form, the model as it stands, and the model of every study with the study.
    /// Each finding once.
    #[must_use]
    pub fn check_all(&self, selection: &Selection<'_>) -> Report {
        self.check_studies(selection, &[])
    }

    /// As [`Self::check_all`], of some studies and what they take from others; without any, of all.
    #[must_use]
    pub fn check_studies(&self, selection: &Selection<'_>, studies: &[String]) -> Report {
        let mut inquiry = Inquiry::new(self, selection);
        let mut faults = inquiry.form();
        let meaning = inquiry.meaning(studies);
        // what follows from a fault of form is not said again; a misspelt key says nothing against its value
        let headless = faults.iter().any(|fault| fault.code == "unknown-key" && !fault.place.contains('.'));
        let form: HashSet<String> = faults.iter().filter(|fault| fault.code != "unknown-key").map(Fault::cause).collect();
        let consequence = |fault: &Fault| {
            // the names of a section whose own name is misspelt are unknown, and what it holds is not there
            headless && (fault.code.starts_with("unknown-") || fault.code == "no-driver" || fault.expected == CALLED)
                || fault.spot != Spot::Key && (form.contains(&fault.cause()) || form.contains(&fault.place))
        };
        faults.extend(meaning.into_iter().filter(|fault| !consequence(fault)));
        self.report(&faults)
    }
}
