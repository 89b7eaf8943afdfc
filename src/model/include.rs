//! The section `include`: robots from URDF files as a layer below the file's own sections.

use super::diagnostics::Report;
use super::fault::{At, Fault, Spot};
use super::files::Files;
use super::included::Included;
use super::keys::Entry;
use super::merge::{self, Layers, Node};
use super::names::is_name;
use super::reading;
use super::shape;
use super::urdf::{self, Base, IncludeKeys, Options};
use serde_yaml::{Mapping, Value};

/// Reads the files that a model includes.
///
/// # Errors
/// What is wrong with the section and with the files.
pub(super) fn read(root: &Mapping, file: &str, text: &str, files: &Files<'_>) -> Result<Vec<Included>, Report> {
    let Some(section) = root.get("include") else { return Ok(Vec::new()) };
    let layers = Layers { below: Vec::new(), file: root, patches: Vec::new() };
    let mut faults = shape::check_section(&layers, Node::Plain(section), "include", Node::Merged(&merge::Merged::new(root)));
    let section_at = At::ROOT.key("include");
    let entries: Vec<(&Value, At<'_, '_>)> = match section {
        Value::Sequence(items) => items.iter().enumerate().map(|(i, item)| (item, section_at.index(i))).collect(),
        one => vec![(one, section_at)],
    };
    let mut included: Vec<Included> = Vec::new();
    let mut findings = Vec::new();
    if faults.is_empty() {
        if root.get("space").and_then(Value::as_str) == Some("planar") {
            let fault = Fault::new("spatial-only", "include".to_owned(), "a robot in a planar model", "`space: spatial`");
            faults.push(fault.at(Spot::Key).help("write `space: spatial`"));
        }
        for (entry, at) in &entries {
            match robot(entry, at, files) {
                Ok(robot) => {
                    let prefix = IncludeKeys::of(Node::Plain(entry)).prefix;
                    faults.extend(clash(&included, &robot, &at.key(prefix)));
                    included.push(robot);
                }
                Err(Trouble::Here(fault)) => faults.push(*fault),
                Err(Trouble::There(report)) => findings.extend(report.diagnostics),
            }
        }
    }
    findings.extend(reading::report(file, text, &faults, &[]).diagnostics);
    if findings.is_empty() { Ok(included) } else { Err(Report::new(findings)) }
}

/// Why a file cannot be included.
enum Trouble {
    /// A fault of the model.
    Here(Box<Fault>),
    /// Faults of the file.
    There(Report),
}

fn robot<'e>(entry: &'e Value, at: &At<'_, '_>, files: &Files<'_>) -> Result<Included, Trouble> {
    let place = |entry: Entry<'_>| merge::path(&at.key(entry.key()).steps());
    let keys = IncludeKeys::of(Node::Plain(entry));
    let (name, prefix) = (keys.urdf.text().unwrap_or_default(), keys.prefix.text().unwrap_or_default());
    if !prefix.is_empty() && !is_name(prefix) {
        let fault = Fault::new(
            "bad-name",
            place(keys.prefix),
            format!("`{prefix}` cannot begin a name"),
            "a letter a-z or A-Z, then letters, digits and `_`",
        );
        return Err(Trouble::Here(Box::new(fault.help("for example `left_`"))));
    }
    let (file, bytes) = files(name).map_err(|why| {
        let fault =
            Fault::new("no-file", place(keys.urdf), format!("cannot read `{name}`: {why}"), "a URDF file, by its path from this file");
        Trouble::Here(Box::new(fault.help("check the path")))
    })?;
    let secret = |report: Report| if urdf::is_robot(&bytes) { report } else { report.without_excerpts() };
    let text = reading::text_of(&bytes, &file, bytes.len()).map_err(secret).map_err(Trouble::There)?;
    let base = keys.base.word().unwrap_or(Base::Fixed);
    let plain = |entry: Entry<'e>| if let Some(Node::Plain(value)) = entry.node { Some(value) } else { None };
    let options = Options { prefix, at: plain(keys.at), rpy: plain(keys.rpy), base, stops: keys.stops.flag() };
    match urdf::read(text, &options) {
        Ok(robot) => Ok(Included { text: text.to_owned(), file, robot, place: merge::path(&at.steps()) }),
        Err(faults) => Err(Trouble::There(secret(reading::report(&file, text, &faults, &[])))),
    }
}

/// A name that an earlier file gives, too: the later one would change the earlier robot.
fn clash(earlier: &[Included], robot: &Included, at: &At<'_, '_>) -> Option<Fault> {
    let names = |of: &Included| -> Vec<String> {
        let sections = of.robot.sections.values().filter_map(Value::as_mapping);
        sections.flat_map(|section| section.keys().filter_map(Value::as_str)).map(str::to_owned).collect()
    };
    let taken: std::collections::HashSet<String> = earlier.iter().flat_map(names).collect();
    let twice = names(robot).into_iter().find(|name| taken.contains(name))?;
    let place = merge::path(&at.steps());
    let message = format!("`{twice}` comes from an earlier file, too");
    Some(
        Fault::new("duplicate-name", place, message, "names of its own for every robot")
            .help("give each robot another `prefix`, as `prefix: left_`"),
    )
}
