//! `grashof gather`: the results of a sweep whose shards were computed apart.

use super::Common;
use super::run::Wanted;
use super::shard::Part;
use super::sweep::{Asked, Drawn, computed};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// The study; may be left out if the model has only one
    #[arg(long, value_name = "S")]
    study: Option<String>,
    /// Values of a parameter, as the shards were given them
    #[arg(long, value_name = "NAME=VALUES")]
    over: Vec<String>,
    #[command(flatten)]
    drawn: Drawn,
    /// A further directory with shards, beside that of the results (repeatable)
    #[arg(long, value_name = "DIR")]
    from: Vec<PathBuf>,
    #[command(flatten)]
    wanted: Wanted,
}

/// Puts shards together.
pub(super) fn gather(arguments: &Arguments, common: &Common) -> u8 {
    let part = Part::Gathered(arguments.from.clone());
    let (model, study) = (arguments.model.as_str(), arguments.study.as_deref());
    computed(&Asked { model, study, over: &arguments.over, drawn: &arguments.drawn, wanted: &arguments.wanted, part }, common)
}
