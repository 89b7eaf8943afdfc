//! `grashof completions`.

use super::{Common, files};
use clap_complete::Shell;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints a completion script for a command line, or writes it to the file of `--output`.
pub(super) fn print(arguments: &Arguments, command: &mut clap::Command, common: &Common) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, command, "grashof", &mut script);
    files::print_or_write(String::from_utf8_lossy(&script).trim_end(), common)
}
