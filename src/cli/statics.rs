//! `grashof statics`: equilibria of a model that has no study of them.

use super::{Common, adhoc};

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    study: adhoc::Arguments,
}

/// Finds the equilibria.
pub(super) fn statics(arguments: &Arguments, common: &Common) -> u8 {
    adhoc::study(&arguments.study, "statics", |_| "statics: { from: start }".into(), common)
}
