//! `grashof statics`: equilibria of a model that has no study of them.

use super::{Common, adhoc};
use grashof::results::Outcome;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    study: adhoc::Arguments,
}

/// Finds the equilibria.
pub(super) fn statics(arguments: &Arguments, common: &Common) -> u8 {
    adhoc::study(&arguments.study, "statics", "statics: { from: start }", common)
}

/// The findings of a study of equilibria in lines: where it rests, and where else it could.
pub(super) fn summary(outcome: &Outcome) -> String {
    let line = |code: &str| match code {
        "equilibrium" => "at rest",
        "further-equilibrium" => "also in balance",
        _ => "note",
    };
    outcome.findings.iter().map(|f| format!("  {}: {}\n", line(f.code), f.message)).collect()
}
