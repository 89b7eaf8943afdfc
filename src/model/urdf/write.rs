//! A translated robot as the text of a model.

use super::options::{Base, Options, Translated};
use super::read::read;
use super::translate::shortest;
use crate::model::diagnostics::Report;
use crate::model::reading;
use serde_yaml::{Mapping, Value};
use std::fmt::Write;

/// What is asked of an import.
#[derive(Clone, Debug, Default)]
pub struct Import {
    /// In front of every name; empty, or a name itself.
    pub prefix: String,
    /// The root is free; else it is fixed to the ground.
    pub free: bool,
    /// Position limits become end stops.
    pub stops: bool,
}

/// A model made of a URDF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The model file.
    pub text: String,
    /// What of the URDF it does not use, or not as it stands; each with the line where it is met first.
    pub notes: Vec<(usize, String)>,
    /// Bodies that need a mass before a motion in time can be computed.
    pub bare: Vec<String>,
}

/// A complete model of a URDF: gravity along −z, a study of its fall. `file` is its name for messages.
///
/// # Errors
/// Everything that is wrong with the URDF.
pub fn import(bytes: &[u8], file: &str, asked: &Import) -> Result<Imported, Report> {
    let text = reading::text_of(bytes, file, bytes.len())?;
    let base = if asked.free { Base::Free } else { Base::Fixed };
    let options = Options { prefix: &asked.prefix, base, stops: asked.stops, at: None, rpy: None };
    let robot = read(text, &options).map_err(|faults| reading::report(file, text, &faults, &[]))?;
    let notes = robot.notes.sentences(text, &|_| false);
    Ok(Imported { text: written(&robot, file, &notes), notes, bare: robot.notes.bare() })
}

/// The text of a model.
fn written(robot: &Translated, file: &str, notes: &[(usize, String)]) -> String {
    let mut out = String::from("grashof: 1\n");
    let file = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let _ = writeln!(out, "name: {}", if robot.name.trim().is_empty() { text(one_line(file).as_str()) } else { text(&robot.name) });
    let _ = writeln!(out, "about: |\n  Imported from {} by `grashof import`: bodies are the links, in their frames;", one_line(file));
    let _ = writeln!(out, "  joint coordinates are the joint positions of the URDF.");
    if !notes.is_empty() {
        out.push_str("\n# What the URDF says and this model does not use, or not as it stands:\n");
        for (line, note) in notes {
            let _ = writeln!(out, "#   line {line}: {}", one_line(note));
        }
    }
    out.push_str("\nspace: spatial\ngravity: [0, 0, -9.81 m/s^2]\n");
    for (section, entries) in &robot.sections {
        let (Some(section), Value::Mapping(entries)) = (section.as_str(), entries) else { continue };
        let _ = writeln!(out, "\n{}{section}:", heading(section));
        for (name, value) in entries {
            let Some(name) = name.as_str() else { continue };
            entry(&mut out, robot, section, name, value);
        }
    }
    let columns = columns(&robot.sections);
    let _ = writeln!(out, "\nstudies:\n  fall:\n    dynamics: {{ until: 1 s }}\n    columns: [{}]", columns.join(", "));
    out
}

/// A comment above a section.
fn heading(section: &str) -> &'static str {
    match section {
        "bodies" => "# mass in kg; com, points and drawn in m; inertia [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] about com in kg m^2, body axes\n",
        "joints" => "# axis in the first body's frame; rpy: orientation of the second body in the first at 0, rad\n",
        "couplings" => "# joints that mimic others\n",
        "start" => "# rad and m\n",
        _ => "",
    }
}

/// One entry of a section; a body takes a line for each of its keys.
fn entry(out: &mut String, robot: &Translated, section: &str, name: &str, value: &Value) {
    if let Some(remark) = robot.remarks.get(&format!("{section}.{name}")) {
        let _ = writeln!(out, "  # {}", one_line(remark));
    }
    match value {
        Value::Mapping(map) if section == "bodies" && !map.is_empty() => {
            let _ = writeln!(out, "  {name}:");
            for (key, value) in map {
                let _ = writeln!(out, "    {}: {}", key.as_str().unwrap_or_default(), flow(value));
            }
        }
        value => {
            let _ = writeln!(out, "  {name}: {}", flow(value));
        }
    }
}

/// A value in one line.
fn flow(value: &Value) -> String {
    match value {
        Value::Mapping(map) => format!("{{{}}}", padded(&pairs(map))),
        Value::Sequence(items) => format!("[{}]", items.iter().map(flow).collect::<Vec<_>>().join(", ")),
        Value::String(s) => text(s),
        Value::Bool(b) => b.to_string(),
        Value::Number(n) => n.as_f64().map_or_else(|| n.to_string(), shortest),
        _ => String::new(),
    }
}

fn pairs(map: &Mapping) -> String {
    let pair = |(key, value): (&Value, &Value)| format!("{}: {}", key.as_str().unwrap_or_default(), flow(value));
    map.iter().map(pair).collect::<Vec<_>>().join(", ")
}

fn padded(inner: &str) -> String {
    if inner.is_empty() { String::new() } else { format!(" {inner} ") }
}

/// A text as YAML: in quotes unless every reader takes it for itself.
fn text(s: &str) -> String {
    let plain = s.starts_with(|c: char| c.is_ascii_alphanumeric() || "~(-".contains(c))
        && s.chars().all(|c| c.is_ascii_alphanumeric() || " ._+-*/()^~".contains(c))
        && !s.starts_with("- ")
        && s.trim() == s
        && (s.contains(|c: char| " ./*(".contains(c)) && s.parse::<f64>().is_err() || super::names::plain(s));
    if plain {
        return s.to_owned();
    }
    let quoted = serde_json::Value::from(s).to_string();
    quoted.chars().map(|c| if printable(c) { c.to_string() } else { format!("\\u{:04x}", u32::from(c)) }).collect()
}

/// Whether YAML takes a character as it stands, and not for the end of a line (YAML 1.2.2, section 5.1).
fn printable(c: char) -> bool {
    !c.is_control() && !matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}')
}

/// A text without line ends, for comments.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if printable(c) { c } else { ' ' }).collect()
}

/// Time, coordinates of joints and energies.
fn columns(sections: &Mapping) -> Vec<String> {
    /// A wider table is nothing that one reads.
    const MOST: usize = 40;
    let mut columns = vec!["time".to_owned()];
    if let Some(Value::Mapping(joints)) = sections.get("joints") {
        for (name, joint) in joints {
            let (Some(name), Value::Mapping(joint)) = (name.as_str(), joint) else { continue };
            if joint.contains_key("revolute") {
                columns.push(format!("{name}.angle"));
            } else if joint.contains_key("prismatic") {
                columns.push(format!("{name}.position"));
            }
        }
    }
    columns.truncate(MOST);
    columns.push("energy".to_owned());
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_read_back_as_themselves() {
        for s in [
            "a",
            "a b",
            "yes",
            "on",
            "null",
            "12",
            "1e5",
            "~0.5 rad",
            "a: b",
            "x # y",
            "- a",
            "\"q\"",
            "ä",
            "",
            "a.angle - 2*b.angle",
            "0x1F",
            "~",
            "1:2",
            "0.5",
            "a\u{7f}b\u{1}\u{85}\u{9b}c\u{2028}\u{feff}\u{ffff}\u{1f600}",
        ] {
            let read: Value = serde_yaml::from_str(&format!("k: {}", text(s))).unwrap();
            assert_eq!(read.get("k").and_then(Value::as_str), Some(s), "{}", text(s));
        }
    }

    #[test]
    fn numbers_read_back_to_their_bits() {
        for x in [0.1, 1e-7, 1.5e300, -2.0, 1.0 / 3.0, 5e-324] {
            let read: Value = serde_yaml::from_str(&shortest(x)).unwrap();
            assert_eq!(read.as_f64().map(f64::to_bits), Some(x.to_bits()), "{}", shortest(x));
        }
    }
}
