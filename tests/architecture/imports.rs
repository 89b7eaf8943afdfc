//! Which file imports from which, and where files import each other in a circle.
//!
//! A path leads to the file of the module in which its item is defined: through `crate`, `self` and any number of `super`, and
//! through what modules export again.

use std::collections::{BTreeMap, BTreeSet};

/// A module: the names from the root of the crate to it.
type Module = Vec<String>;

/// The files that each file imports from.
pub(super) type Imports = BTreeMap<String, BTreeSet<String>>;

/// The module of a file: that of `a/b.rs` and `a/b/mod.rs` is `a::b`.
fn module(file: &str) -> Module {
    let mut names: Module = file.trim_end_matches(".rs").split('/').map(String::from).collect();
    if names.last().is_some_and(|last| last == "mod") || names == ["lib"] || names == ["main"] {
        names.pop();
    }
    names
}

/// The paths of a `use` without its braces.
fn leaves(text: &str) -> Vec<String> {
    let Some(open) = text.find('{') else {
        return vec![text.split(" as ").next().unwrap_or("").split_whitespace().collect()];
    };
    let close = text.rfind('}').unwrap_or(text.len());
    let (head, body) = (text[..open].trim(), &text[open + 1..close]);
    let mut out = Vec::new();
    let (mut depth, mut item) = (0, String::new());
    for c in body.chars().chain([',']) {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            if !item.trim().is_empty() {
                out.extend(leaves(item.trim()).into_iter().map(|leaf| format!("{head}{leaf}")));
            }
            item.clear();
        } else {
            item.push(c);
        }
    }
    out
}

/// The code of a file cut into what its `use` declarations name and the rest.
fn uses(code: &str) -> (Vec<String>, String) {
    let (mut found, mut rest, mut open) = (Vec::new(), String::new(), None::<String>);
    for line in code.lines() {
        let begins = line.trim_start().trim_start_matches("pub").trim_start();
        let begins = if begins.starts_with('(') { begins.split_once(')').map_or(begins, |(_, r)| r.trim_start()) } else { begins };
        match (&mut open, begins.strip_prefix("use ")) {
            (Some(text), _) => text.push_str(line.trim()),
            (None, Some(first)) => open = Some(first.trim().to_string()),
            (None, None) => {
                rest.push_str(line);
                rest.push('\n');
            }
        }
        if open.as_ref().is_some_and(|text| text.ends_with(';')) {
            found.extend(leaves(open.take().unwrap_or_default().trim_end_matches(';')));
        }
    }
    (found, rest)
}

/// Paths in code that begin with one of the words which lead through the crate.
fn inline(code: &str) -> Vec<String> {
    // `pub(in crate::room)` says who may see an item, and imports nothing
    let code = code.replace("pub(in ", "pub(in_");
    let word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let paths = code.split(|c: char| !word(c)).filter(|p| ["crate::", "super::", "self::"].iter().any(|w| p.starts_with(w)));
    paths.map(|p| p.trim_end_matches(':').to_string()).collect()
}

/// What files of a crate import from each other; `code` is without comments and tests.
pub(super) fn imports(code: &[(String, String)]) -> Imports {
    let files: BTreeMap<Module, &str> = code.iter().map(|(file, _)| (module(file), file.as_str())).collect();
    let resolve = |from: &Module, path: &str| -> Option<(Module, Option<String>)> {
        let mut names: Vec<&str> = path.split("::").collect();
        let mut at = match names[0] {
            "crate" => Vec::new(),
            "self" => from.clone(),
            "super" => from[..from.len().saturating_sub(1)].to_vec(),
            first => {
                let child = [from.as_slice(), &[first.to_string()]].concat();
                return files.contains_key(&child).then(|| descend(&files, from.clone(), &names));
            }
        };
        names.remove(0);
        while names.first() == Some(&"super") {
            at.pop();
            names.remove(0);
        }
        Some(descend(&files, at, &names))
    };
    let read: Vec<(Module, &str, Vec<String>, String)> = code
        .iter()
        .map(|(file, text)| {
            let (found, rest) = uses(text);
            (module(file), file.as_str(), found, rest)
        })
        .collect();
    let mut exported: BTreeMap<(Module, String), (Module, Option<String>)> = BTreeMap::new();
    for (own, _, found, _) in &read {
        for path in found {
            if let (Some(target), Some(name)) = (resolve(own, path), path.rsplit("::").next()) {
                exported.insert((own.clone(), name.to_string()), target);
            }
        }
    }
    let defined = |mut target: (Module, Option<String>)| {
        for _ in 0..5 {
            let Some(next) = target.1.clone().and_then(|name| exported.get(&(target.0.clone(), name))) else { break };
            target = next.clone();
        }
        files.get(&target.0).copied()
    };
    let mut out = Imports::new();
    for (own, file, found, rest) in &read {
        let children = files.keys().filter(|m| m.len() == own.len() + 1 && m.starts_with(own)).filter_map(|m| m.last());
        let children = children.filter(|child| rest.contains(&format!(" {child}::")) || rest.contains(&format!("({child}::")));
        let all = found.iter().cloned().chain(inline(rest)).chain(children.map(|child| format!("self::{child}")));
        let targets = all.filter_map(|path| defined(resolve(own, &path)?)).filter(|target| target != file);
        out.insert((*file).to_string(), targets.map(String::from).collect());
    }
    out
}

/// As far along the names as there are modules; the name behind them, if there is one.
fn descend(files: &BTreeMap<Module, &str>, mut at: Module, names: &[&str]) -> (Module, Option<String>) {
    for name in names {
        at.push((*name).to_string());
        if !files.contains_key(&at) {
            return (at[..at.len() - 1].to_vec(), Some((*name).to_string()));
        }
    }
    (at, None)
}

/// Files that reach each other (strongly connected components of more than one).
pub(super) fn circles(imports: &Imports) -> Vec<Vec<String>> {
    let reach: BTreeMap<&str, BTreeSet<&str>> = imports
        .keys()
        .map(|from| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![from.as_str()]);
            while let Some(next) = open.pop().and_then(|at| imports.get(at)) {
                open.extend(next.iter().map(String::as_str).filter(|to| seen.insert(*to)));
            }
            (from.as_str(), seen)
        })
        .collect();
    let mut out: Vec<Vec<String>> = Vec::new();
    for (from, seen) in &reach {
        let circle: Vec<String> =
            seen.iter().filter(|to| reach.get(**to).is_some_and(|back| back.contains(from))).map(|to| (*to).to_string()).collect();
        if circle.len() > 1 && !out.contains(&circle) {
            out.push(circle);
        }
    }
    out
}

#[test]
fn a_circle_is_seen_through_super_and_exports() {
    let file = |name: &str, text: &str| (name.to_string(), text.to_string());
    let code = [
        file("lib.rs", "mod a;\n"),
        file("a/mod.rs", "mod b;\nmod c;\npub use b::{\n    B,\n    other::X,\n};\n"),
        file("a/b.rs", "use super::c::C;\npub struct B;\n"),
        file("a/c.rs", "pub struct C(super::B);\n"),
        file("d.rs", "use crate::a::B as Renamed;\n"),
    ];
    let imports = imports(&code);
    assert_eq!(circles(&imports), [["a/b.rs", "a/c.rs"]]);
    assert_eq!(imports["d.rs"].iter().collect::<Vec<_>>(), ["a/b.rs"]);
}
