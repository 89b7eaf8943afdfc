//! `grashof modes`: eigenvalues and shapes of a model that has no study of them.

use super::{Common, adhoc};
use clap::ValueEnum;

/// Bodies from which on methods for full matrices are not compared.
const MANY: usize = 50;

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
    /// Number of modes, the lowest ones; all if omitted, of 100 bodies and more 12
    #[arg(long, value_name = "K")]
    lowest: Option<u32>,
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
    let lowest = arguments.lowest.map_or(String::new(), |count| format!(", lowest: {count}"));
    let study = |bodies: usize| {
        // many bodies have sparse matrices, for which the program has one method
        let methods = if bodies < MANY { ", methods: [library, jacobi, power]" } else { "" };
        format!("modes: {{ at: {at}, damped: {}{lowest}{methods} }}", arguments.damped)
    };
    adhoc::study(&arguments.study, "modes", study, common)
}
