//! `grashof schema`.

use super::{code, print_out};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// That of the JSON files of results instead
    #[arg(long)]
    results: bool,
}

/// Prints the JSON Schema of model files, or of results.
pub(super) fn print(arguments: &Arguments) -> u8 {
    let schema = if arguments.results { grashof::output::results_schema() } else { grashof::model::schema() };
    print_out(&serde_json::to_string_pretty(&schema).unwrap_or_default());
    code::DONE
}
