//! `grashof completions`.

use super::code;
use clap_complete::Shell;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints a completion script for a command line.
pub(super) fn print(arguments: &Arguments, command: &mut clap::Command) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, command, "grashof", &mut script);
    super::print_out(String::from_utf8_lossy(&script).trim_end());
    code::DONE
}
