//! The gallery: `cargo run --release --example gallery` in the repository writes docs/gallery.md, with a picture of each model of
//! models/, and the crank-rocker that moves on the first page.

#![allow(clippy::print_stdout, reason = "it is a program of its own")]

use grashof::api::beside;
use grashof::model::{Document, Selection};
use grashof::output::{Film, Pace, Shot, ShotOptions, drawing, moving_svg, render_drawing};
use grashof::results::Results;
use grashof::studies::loader::Loader;
use grashof::studies::sweep::{Drawn, Settings, at, grid, single};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// Where pictures go, as the page names it.
const FIGURES: &str = "figures/gallery";

const HEAD: &str = "# Gallery

The models of `models/`, each by the picture of its first study; `cargo run --release --example gallery` writes this page. Any of them
moves with `grashof animate models/crank_rocker.yaml --study one-turn --duration 4 -o turn.gif`.
";

/// A model with the results of its first study.
struct Shown {
    about: String,
    results: Results,
}

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new("docs");
    fs::create_dir_all(docs.join(FIGURES))?;
    let mut models: Vec<PathBuf> = fs::read_dir("models")?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    models.retain(|path| path.extension().is_some_and(|ending| ending == "yaml"));
    models.sort();
    let mut page = HEAD.to_string();
    for model in &models {
        let shown = shown(model)?;
        let name = model.file_stem().unwrap_or_default().to_string_lossy();
        let Some((scene_name, scene)) = shown.results.scenes.first() else { continue };
        let picture = render_drawing(&drawing(&shown.results.model, "", scene_name, scene))?;
        fs::write(docs.join(format!("{FIGURES}/{name}.svg")), picture.svg)?;
        page += &format!("\n## [{name}](../models/{name}.yaml)\n\n{}\n\n![{}]({FIGURES}/{name}.svg)\n", shown.about, shown.results.model);
        println!("{name}");
    }
    fs::write(docs.join("gallery.md"), page)?;
    let Shown { results, .. } = shown(Path::new("models/crank_rocker.yaml"))?;
    let (name, scene) = &results.scenes[0];
    let shot = Shot::of(&results, scene, &ShotOptions { rate: 25.0, pace: Pace::Duration(4.0), repeats: true })?;
    fs::write(docs.join("figures/crank_rocker/one-turn-moving.svg"), moving_svg(&Film::new(&results.model, "", name, scene, &shot), 800))?;
    Ok(())
}

/// Runs the first study of a model, of a sweep its first run.
fn shown(path: &Path) -> Result<Shown, Box<dyn Error>> {
    let file = path.to_string_lossy();
    let document =
        Document::with_files(&fs::read(path)?, &file, &|included| beside(&file, included)).map_err(|report| format!("{report:?}"))?;
    let names = document.study_names();
    let first = names.first().ok_or("no studies")?;
    let selection = Selection { study: Some(first), ..Selection::default() };
    let model = Loader::new(&document, 1).model(&selection, &|| false).map_err(|why| format!("{why:?}"))?;
    let study = model.study.as_ref().ok_or("no study")?;
    let point = grid(&model, study).swap_remove(0);
    let settings = Settings { threads: 1, drawn: Drawn::First, stop: &|| false };
    let results = single(&model, study, at(&model, study, point, settings, None, &|_, _| {})).map_err(|why| format!("{why:?}"))?;
    // what comes after an empty line, and the sources, are for those who open the file
    let lines = model.about.lines().take_while(|line| !line.trim().is_empty() && !line.starts_with("Source:"));
    Ok(Shown { about: lines.map(str::trim).collect::<Vec<_>>().join(" "), results })
}
