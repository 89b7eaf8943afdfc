//! `grashof schema`.

use super::{Common, files};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// That of the JSON files of results instead
    #[arg(long)]
    results: bool,
}

/// Prints the JSON Schema of model files, or of results, or writes it to the file of `--output`.
pub(super) fn print(arguments: &Arguments, common: &Common) -> u8 {
    let schema = if arguments.results { grashof::output::results_schema() } else { grashof::model::schema() };
    files::print_or_write(&serde_json::to_string_pretty(&schema).unwrap_or_default(), common)
}
