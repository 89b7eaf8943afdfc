//! What every command understands.

use clap::{Args, ValueEnum};
use std::io::IsTerminal;
use std::path::PathBuf;

/// What every command understands.
#[derive(Args, Clone, Debug)]
pub(crate) struct Common {
    /// Directory for results [default: results/<model file without extension>]; with `new`, `import`, `animate`, `schema` and `completions` the
    /// file to write
    #[arg(short, long, global = true, value_name = "PATH")]
    pub(super) output: Option<PathBuf>,
    /// Replace files of the names of results that no earlier run is recorded to have written
    #[arg(long, global = true)]
    pub(super) force: bool,
    /// Set a parameter: a number in SI, or a quantity as "60 cm"
    #[arg(long, global = true, value_name = "NAME=VALUE")]
    pub(super) set: Vec<String>,
    /// Apply a variant of the file, after those of the study
    #[arg(long, global = true, value_name = "V")]
    pub(super) variant: Vec<String>,
    /// Threads for sweeps and figures [default: all processors]
    #[arg(short = 'j', long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Print errors alone on stderr
    #[arg(short, long, global = true)]
    pub(super) quiet: bool,
    /// Tell on stderr what is done
    #[arg(short, long, global = true)]
    pub(super) verbose: bool,
    /// Colours on stderr; NO_COLOR is heeded
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub(super) color: Color,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    Auto,
    Always,
    Never,
}

impl Common {
    /// Whether stderr gets colours.
    pub(crate) fn colored(&self) -> bool {
        match self.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()) && std::io::stderr().is_terminal(),
        }
    }

    /// Number of threads.
    pub(crate) fn threads(&self) -> usize {
        self.threads.map_or_else(grashof::par::processors, usize::from)
    }

    /// Words on the command line that change what studies compute.
    pub(crate) fn changes(&self) -> Option<&'static str> {
        match (self.set.is_empty(), self.variant.is_empty()) {
            (true, true) => None,
            (false, true) => Some("--set"),
            (true, false) => Some("--variant"),
            (false, false) => Some("--set` and `--variant"),
        }
    }
}
