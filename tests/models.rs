//! Every shipped model, every template and every whole model on the page of the format runs and meets its own expectations.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A fresh directory for one test.
fn scratch(name: &str) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("grashof-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).expect("a temporary directory");
    directory
}

fn grashof(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_grashof")).current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).output().expect("the binary runs")
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// The model files of a directory, in order.
fn files(directory: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(directory);
    let mut files: Vec<PathBuf> = std::fs::read_dir(root)
        .expect("the directory is there")
        .filter_map(|e| Some(e.ok()?.path()))
        .filter(|p| p.extension().is_some_and(|e| e == "yaml"))
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

#[test]
fn every_shipped_model_runs_and_meets_its_expectations() {
    let out = scratch("models");
    for file in files("models").iter().chain(&files("src/cli/templates")) {
        let output = grashof(&["run", &file.to_string_lossy(), "--no-plots", "-o", &out.to_string_lossy()]);
        assert!(output.status.success(), "{}: {:?}\n{}", file.display(), output.status.code(), text(&output));
    }
    let _ = std::fs::remove_dir_all(out);
}

/// The fenced blocks of a page that are whole models, with the line where each begins.
fn blocks(page: &str) -> Vec<(usize, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(usize, String)> = None;
    for (number, line) in page.lines().enumerate() {
        match (&mut open, line) {
            (None, "```yaml") => open = Some((number + 2, String::new())),
            (Some(_), "```") => blocks.extend(open.take()),
            (Some((_, block)), line) => {
                block.push_str(line);
                block.push('\n');
            }
            _ => {}
        }
    }
    blocks
}

/// Runs the models on a page, of which there are at least so many.
fn models_on_page_run(name: &str, least: usize) {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name)).expect("the page is there");
    let out = scratch(name);
    let blocks = blocks(&page);
    assert!(blocks.len() >= least, "{} blocks", blocks.len());
    for (line, block) in blocks {
        let file = out.join(format!("line-{line}.yaml"));
        std::fs::write(&file, &block).expect("the block can be written");
        let path = file.to_string_lossy();
        let output = grashof(&["run", &path, "--no-plots", "-o", &out.to_string_lossy()]);
        assert!(output.status.success(), "docs/{name}, line {line}: {:?}\n{}\n{block}", output.status.code(), text(&output));
    }
    let _ = std::fs::remove_dir_all(out);
}

#[test]
fn every_model_on_the_page_of_the_format_runs() {
    models_on_page_run("format.md", 26);
}

#[test]
fn the_model_of_the_tutorial_runs() {
    models_on_page_run("tutorial.md", 1);
}
