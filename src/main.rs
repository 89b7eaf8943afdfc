//! The command line of Grashof.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
