//! `grashof modes`: eigenvalues and shapes of a model that has no study of them.

use super::{Common, adhoc};
use clap::ValueEnum;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    study: adhoc::Arguments,
    /// The pose: that of the start, or the equilibrium that is found from there
    #[arg(long, value_enum, default_value = "start")]
    at: At,
    /// Count damping: complex eigenvalues and damping ratios
    #[arg(long)]
    damped: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum At {
    Start,
    Statics,
}

/// Computes the modes.
pub(super) fn modes(arguments: &Arguments, common: &Common) -> u8 {
    let at = match arguments.at {
        At::Start => "start",
        At::Statics => "statics",
    };
    let methods = "methods: [library, jacobi, power]";
    adhoc::study(&arguments.study, "modes", &format!("modes: {{ at: {at}, damped: {}, {methods} }}", arguments.damped), common)
}
