//! Who may know whom, read from the `use` lines and paths of the sources, and the size of files.

mod imports;

use imports::{circles, imports};
use std::fs;
use std::path::{Path, PathBuf};

/// Files with the rooms that they may know; the first prefix that fits decides. Rooms a file lies in are always known to it.
const MAY_KNOW: &[(&str, &[&str])] = &[
    ("scalar", &[]),
    ("geometry", &["scalar"]),
    ("expression", &["scalar"]),
    ("model", &["expression", "scalar"]),
    ("mechanism/build", &["geometry", "scalar", "expression", "model"]),
    ("mechanism/joint.rs", &["geometry", "scalar", "model::JointKind"]),
    ("mechanism/force.rs", &["geometry", "scalar", "expression"]),
    ("mechanism/parts.rs", &["geometry", "scalar", "expression"]),
    ("mechanism", &["geometry", "scalar"]),
    ("dynamics", &["mechanism", "geometry", "scalar", "expression::Integral", "expression::Integrand"]),
    ("numerics", &[]),
    ("results", &["mechanism::BuildFault", "model::WORKS", "expression::nearest", "numerics::extremum", "numerics::resolve::Resolution"]),
    ("kinematics", &["numerics", "dynamics", "mechanism", "geometry", "scalar", "expression", "model", "results"]),
    ("studies", &["numerics", "kinematics", "dynamics", "mechanism", "geometry", "scalar", "expression", "model", "results", "par"]),
    ("output", &["results", "par"]),
    ("par.rs", &[]),
    ("api", &["studies", "results", "kinematics", "dynamics", "mechanism", "geometry", "scalar", "model", "output", "par"]),
];

/// What only the commands may do.
const ONLY_IN_CLI: &[&str] = &["println!", "eprintln!", "print!(", "eprint!(", "process::exit", "std::time", "SystemTime", "Instant::now"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Rust files below a directory: path from there and text.
fn sources(directory: &Path) -> Vec<(String, String)> {
    fn walk(directory: &Path, out: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, out);
            } else if path.extension().is_some_and(|e| e == "rs") {
                out.push(path);
            }
        }
    }
    let mut paths = Vec::new();
    walk(directory, &mut paths);
    paths.sort();
    let name = |p: &PathBuf| p.strip_prefix(directory).unwrap().to_str().unwrap().replace('\\', "/");
    paths.iter().map(|p| (name(p), fs::read_to_string(p).unwrap())).collect()
}

/// The text without comments, and without what is compiled only for tests.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or("");
    text.lines().map(|l| l.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// Paths behind every `crate::` (in the library) or `grashof::` (in the commands); lists in braces one by one.
fn known(code: &str, origin: &str) -> Vec<String> {
    let mut out = Vec::new();
    for (at, _) in code.match_indices(origin) {
        let rest = &code[at + origin.len()..];
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        if let Some(list) = rest.strip_prefix('{') {
            let mut depth = 1;
            let mut item = String::new();
            for c in list.chars() {
                depth += i32::from(c == '{') - i32::from(c == '}');
                if depth == 0 || (depth == 1 && c == ',') {
                    out.push(item.trim().to_string());
                    item.clear();
                    if depth == 0 {
                        break;
                    }
                } else {
                    item.push(c);
                }
            }
        } else {
            out.push(rest.chars().take_while(|c| c.is_alphanumeric() || "_:".contains(*c)).collect());
        }
    }
    out.retain(|x| !x.is_empty());
    out
}

fn within(path: &str, rooms: &[&str]) -> bool {
    rooms.iter().any(|room| path == *room || path.strip_prefix(room).is_some_and(|rest| rest.starts_with("::")))
}

#[test]
fn a_room_knows_only_the_rooms_below_it() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for (file, text) in sources(&root().join("src")) {
        if file == "lib.rs" || file == "main.rs" || file.starts_with("cli/") {
            continue;
        }
        let Some((_, rooms)) = MAY_KNOW.iter().find(|(prefix, _)| file.starts_with(prefix)) else {
            wrong.push(format!("{file} belongs to no room"));
            continue;
        };
        let own = file.split(['/', '.']).next().unwrap();
        for path in known(&code(&text), "crate::") {
            seen += 1;
            if !within(&path, &[own]) && !within(&path, rooms) {
                wrong.push(format!("src/{file} knows `{path}`"));
            }
        }
        let solvers = known(&code(&text), "grashof_solvers::");
        if !solvers.is_empty() && !["dynamics", "numerics", "kinematics", "studies", "results", "api"].contains(&own) {
            wrong.push(format!("src/{file} knows the solvers"));
        }
    }
    assert!(seen > 50, "{seen} paths were read");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_import_each_other_in_no_circle() {
    let mut wrong = Vec::new();
    for directory in ["src", "solvers/src"] {
        let code: Vec<(String, String)> = sources(&root().join(directory)).into_iter().map(|(file, text)| (file, code(&text))).collect();
        let found = circles(&imports(&code)).into_iter();
        wrong.extend(found.map(|circle| format!("{directory}: {}", circle.join(", "))));
    }
    assert!(wrong.is_empty(), "{} circles:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn the_solvers_know_no_mechanics() {
    for (file, text) in sources(&root().join("solvers/src")) {
        assert!(known(&code(&text), "grashof::").is_empty(), "solvers/src/{file}");
    }
    let manifest = fs::read_to_string(root().join("solvers/Cargo.toml")).unwrap();
    assert!(!manifest.contains("grashof ="), "the solvers depend on the mechanics");
}

#[test]
fn only_commands_print_read_clocks_or_exit() {
    let mut wrong = Vec::new();
    for (directory, name) in [(root().join("src"), "src"), (root().join("solvers/src"), "solvers/src")] {
        for (file, text) in sources(&directory) {
            if name == "src" && (file.starts_with("cli/") || file == "main.rs") {
                continue;
            }
            let code = code(&text);
            wrong.extend(ONLY_IN_CLI.iter().filter(|word| code.contains(**word)).map(|word| format!("{name}/{file}: {word}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn threads_live_in_one_file() {
    for (file, text) in sources(&root().join("src")) {
        let allowed = file == "par.rs" || file.starts_with("cli/");
        assert!(allowed || !code(&text).contains("thread::"), "src/{file}");
    }
}

#[test]
fn no_file_is_longer_than_500_lines() {
    let long: Vec<String> = [root().join("src"), root().join("solvers/src")]
        .iter()
        .flat_map(|d| sources(d))
        .filter(|(_, text)| text.lines().count() > 500)
        .map(|(file, text)| format!("{file}: {}", text.lines().count()))
        .collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn the_reader_of_paths_sees_lists() {
    let code = "use crate::{model::{A, B}, par};\nuse crate::geometry::Space;\nlet x = crate::scalar::f(); notcrate::x";
    assert_eq!(known(code, "crate::"), ["model::{A, B}", "par", "geometry::Space", "scalar::f"]);
    assert!(within("model::{A, B}", &["model"]) && !within("models::A", &["model"]) && within("model::JointKind", &["model::JointKind"]));
}
