//! Numbers that a translation has computed beyond what a double holds: a model could not be read back with them.

use super::translation::Translation;
use crate::model::fault::{Fault, Spot};
use serde_yaml::Value;

/// Faults of all values that are not finite, at the nearest element of the file.
pub(super) fn check(translation: &Translation) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (section, entries) in &translation.sections {
        walk(translation, section.as_str().unwrap_or_default().to_owned(), entries, &mut faults);
    }
    faults
}

fn walk(translation: &Translation, path: String, value: &Value, faults: &mut Vec<Fault>) {
    match value {
        Value::Mapping(entries) => {
            entries
                .iter()
                .for_each(|(key, value)| walk(translation, format!("{path}.{}", key.as_str().unwrap_or_default()), value, faults));
        }
        // one fault for a list, whose numbers come from the same element
        value if infinite(value) => faults.push(fault(translation, &path)),
        _ => {}
    }
}

/// Whether a number, the number of a quantity, or one in a list is not finite.
fn infinite(value: &Value) -> bool {
    match value {
        Value::Sequence(items) => items.iter().any(infinite),
        Value::Mapping(entries) => entries.values().any(infinite),
        Value::Number(x) => x.as_f64().is_some_and(|x| !x.is_finite()),
        // a name has no space
        Value::String(text) => ["inf ", "-inf ", "NaN "].iter().any(|head| text.starts_with(head)),
        _ => false,
    }
}

fn fault(translation: &Translation, path: &str) -> Fault {
    let mut near = path;
    let spot = loop {
        match (translation.places.get(near), near.rfind(['.', '['])) {
            (Some(at), _) => break Spot::Bytes(at.clone()),
            (None, Some(end)) => near = &near[..end],
            (None, None) => break Spot::Nowhere,
        }
    };
    let message = format!("`{path}` comes out too large for a number");
    Fault::new("number-too-large", path.to_owned(), message, "lengths, masses and inertias of a robot, in SI units")
        .at(spot)
        .help("look for a number as `1e308` in this element")
}
