//! `grashof completions`.

use super::code;
use clap::CommandFactory;
use clap_complete::Shell;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints a completion script.
pub(super) fn print(arguments: &Arguments) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut super::Cli::command(), "grashof", &mut script);
    super::say(String::from_utf8_lossy(&script).trim_end());
    code::DONE
}
