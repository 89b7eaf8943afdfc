//! `grashof new`: commented models that run.

use super::{Common, code, files, print_error, print_note, print_out};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Kind of model; `--list` shows them
    #[arg(default_value = "four-bar")]
    kind: String,
    /// File to write, or that of `--output` [default: the kind with `_`, as four_bar.yaml]; `-` for stdout
    file: Option<PathBuf>,
    /// List the kinds
    #[arg(long)]
    list: bool,
}

/// Kind, what it is, and its text.
const TEMPLATES: [(&str, &str, &str); 2] = [
    ("four-bar", "crank, coupler and rocker, driven at constant speed", include_str!("templates/four_bar.yaml")),
    ("slider-crank", "crank, rod and piston with a gas force", include_str!("templates/slider_crank.yaml")),
];

/// Writes a model.
pub(super) fn new(arguments: &Arguments, common: &Common) -> u8 {
    if arguments.list {
        for (kind, about, _) in TEMPLATES {
            print_out(&format!("{kind:<14} {about}"));
        }
        return code::DONE;
    }
    let Some((kind, _, text)) = TEMPLATES.iter().find(|t| t.0 == arguments.kind) else {
        let known: Vec<&str> = TEMPLATES.iter().map(|t| t.0).collect();
        let help = if arguments.kind.contains(['.', '/']) {
            format!("the kind comes before the file: `grashof new {} {}`", known[0], arguments.kind)
        } else {
            format!("the kinds are {}", known.join(", "))
        };
        print_error(&format!("no model of the kind `{}`", arguments.kind), &help);
        return code::INPUT;
    };
    if let (Some(file), Some(output)) = (&arguments.file, &common.output) {
        let message = format!("two files to write: `{}` and `-o {}`", file.display(), output.display());
        print_error(&message, "name one of them");
        return code::INPUT;
    }
    let file = arguments
        .file
        .clone()
        .or_else(|| common.output.clone())
        .unwrap_or_else(|| PathBuf::from(format!("{}.yaml", kind.replace('-', "_"))));
    if file.as_os_str() == "-" {
        print_out(text.trim_end());
        return code::DONE;
    }
    if !files::write_new(&file, text.as_bytes(), common) {
        return code::INPUT;
    }
    print_note(&format!("wrote {}; now: grashof run {}", file.display(), file.display()));
    code::DONE
}
