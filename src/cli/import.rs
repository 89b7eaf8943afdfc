//! `grashof import`: a URDF as a model file.

use super::{Common, code, files, print_note, print_out};
use grashof::model::{Import, import as import_urdf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// URDF file, or `-` for stdin
    urdf: String,
    /// Put this in front of every name
    #[arg(long, value_name = "P", value_parser = prefix)]
    prefix: Option<String>,
    /// Leave the root free instead of fixing it to the ground
    #[arg(long)]
    free: bool,
    /// Make end stops of the position limits
    #[arg(long)]
    stops: bool,
}

fn prefix(text: &str) -> Result<String, String> {
    let good = text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_');
    if good { Ok(text.to_owned()) } else { Err("a letter, then letters, digits and `_`".to_owned()) }
}

/// Writes a model made of a URDF to stdout, or to the file of `--output`.
pub(super) fn import(arguments: &Arguments, common: &Common) -> u8 {
    let bytes = match files::bytes(&arguments.urdf, grashof::api::MOST_INCLUDED) {
        Ok(bytes) => bytes,
        Err(error) => {
            files::unreadable(&arguments.urdf, &error, "a URDF file", "check the path");
            return code::INPUT;
        }
    };
    let name = if arguments.urdf == "-" { "<stdin>" } else { &arguments.urdf };
    let asked = Import { prefix: arguments.prefix.clone().unwrap_or_default(), free: arguments.free, stops: arguments.stops };
    let imported = match import_urdf(&bytes, name, &asked) {
        Ok(imported) => imported,
        Err(report) => {
            files::print(&report, common);
            return code::INPUT;
        }
    };
    if !common.quiet {
        for (line, note) in &imported.notes {
            print_note(&format!("note: {name}:{line}: {note}"));
        }
    }
    match common.output.as_deref().filter(|file| file.as_os_str() != "-") {
        None => {
            print_out(imported.text.trim_end());
            code::DONE
        }
        Some(file) => {
            if !files::write_new(file, imported.text.as_bytes(), common) {
                return code::INPUT;
            }
            let file = file.display();
            let bare: Vec<String> = imported.bare.iter().map(|body| format!("`{body}`")).collect();
            let first = if bare.is_empty() { String::new() } else { format!("give {} mass and inertia, then ", bare.join(", ")) };
            print_note(&format!("wrote {file}; now: {first}grashof run {file}"));
            code::DONE
        }
    }
}
