//! `grashof export`: the mechanism for other programs, as glTF with its motion and as DXF.

use super::interrupt::interrupted;
use super::moving::{Chosen, Fast, Seen, moving};
use super::{Common, code, files, interrupt, print_error};
use grashof::output::{drawing, write_dxf, write_gltf};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    chosen: Chosen,
    #[command(flatten)]
    fast: Fast,
    #[command(flatten)]
    seen: Seen,
    /// Write bodies, joints and their motion as glTF 2.0, to a file that ends in .gltf or .glb
    #[arg(long, value_name = "FILE")]
    gltf: Option<PathBuf>,
    /// Write the drawing of the first position as DXF, to a file that ends in .dxf
    #[arg(long, value_name = "FILE")]
    dxf: Option<PathBuf>,
}

/// Writes a study for other programs.
pub(super) fn export(arguments: &Arguments, common: &Common) -> u8 {
    match exported(arguments, common) {
        Ok(()) => code::DONE,
        Err(code) => code,
    }
}

fn exported(arguments: &Arguments, common: &Common) -> Result<(), u8> {
    let wanted = [(&arguments.gltf, &["gltf", "glb"][..]), (&arguments.dxf, &["dxf"][..])];
    if wanted.iter().all(|(file, _)| file.is_none()) {
        print_error("it is not said what to write", "add `--gltf out.glb`, `--dxf out.dxf`, or both");
        return Err(code::INPUT);
    }
    for (file, endings) in wanted.iter().filter_map(|(file, endings)| Some((file.as_deref()?, endings))) {
        ending(file, endings)?;
        files::may_write(file, common)?;
    }
    if arguments.seen.is_asked() && arguments.dxf.is_none() {
        print_error("`--view` is for a drawing, and glTF is seen from anywhere", "leave `--view` out, or add `--dxf out.dxf`");
        return Err(code::INPUT);
    }
    let mut moving = moving(&arguments.chosen, common)?;
    moving.look(&arguments.seen)?;
    let (results, scene) = (&moving.results, moving.scene());
    let mut made = Vec::new();
    if let Some(file) = &arguments.gltf {
        let shot = moving.shot(&arguments.fast, false, common)?;
        let binary = ends_in(file, "glb");
        made.push((file, write_gltf(&results.model, &results.study, moving.name(), scene, &shot, binary)));
    }
    if let Some(file) = &arguments.dxf {
        made.push((file, write_dxf(&drawing(&results.model, &results.study, moving.name(), scene)).into_bytes()));
    }
    if interrupted() {
        interrupt::print_end("interrupted: nothing is written");
        return Err(code::INTERRUPTED);
    }
    let written = made.iter().all(|(file, bytes)| files::write_new(file, bytes, common));
    if written { Ok(()) } else { Err(code::INPUT) }
}

fn ends_in(file: &Path, ending: &str) -> bool {
    file.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// Refuses a file of another ending; this was reported.
fn ending(file: &Path, known: &[&str]) -> Result<(), u8> {
    if known.iter().any(|ending| ends_in(file, ending)) {
        return Ok(());
    }
    let known: Vec<String> = known.iter().map(|ending| format!(".{ending}")).collect();
    print_error(&format!("the ending of `{}` is not known", file.display()), &format!("name a file that ends in {}", known.join(" or ")));
    Err(code::INPUT)
}
