//! Names of files of results that two studies, or two figures of one, would share.

use super::decode::StudyKeys;
use super::fault::{Fault, Spot};
use super::merge::Node;
use std::collections::HashMap;

/// The drawing of every study.
const DRAWING: &str = "mechanism";

/// Matrices of a linearised motion, each a table.
const MATRICES: [&str; 4] = ["A", "B", "C", "D"];

/// Faults of studies and figures whose files have one name.
pub(super) fn shared(studies: &[(&str, Node<'_>)]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut pictures: HashMap<String, &str> = HashMap::new();
    for (study, _) in studies {
        pictures.insert(format!("{study}-{DRAWING}"), study);
    }
    for (study, node) in studies {
        for (figure, _) in StudyKeys::of(*node).plot.entries() {
            let file = format!("{study}-{figure}");
            let mode = figure.strip_prefix("mode-").filter(|_| node.get("modes").is_some()).is_some_and(number);
            let other = if mode { Some(*study) } else { pictures.insert(file.clone(), study) };
            if let Some(other) = other {
                let of = if other == *study { "a drawing of the study".to_owned() } else { format!("a figure of the study `{other}`") };
                let message = format!("the file of this figure, `{file}.svg`, is that of {of}");
                faults.push(fault(format!("studies.{study}.plot.{figure}"), message, "another name for the figure"));
            }
        }
        for (other, by) in studies {
            let table = study.strip_prefix(other).and_then(|rest| rest.strip_prefix('-')).is_some_and(|rest| {
                let run = StudyKeys::of(*by).sweep.given() && number(rest) && rest.len() >= 3;
                run || by.get("linearize").is_some() && MATRICES.contains(&rest)
            });
            if table {
                let message = format!("the file of this study, `{study}.csv`, is one of the study `{other}`");
                faults.push(fault(format!("studies.{study}"), message, "another name for the study"));
            }
        }
    }
    faults
}

/// Whether a text numbers a run or a mode.
fn number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit())
}

fn fault(place: String, message: String, expected: &str) -> Fault {
    Fault::new("same-file", place, message, expected).at(Spot::Key).help("rename one of the two")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_yaml::{Mapping, Value};

    #[test]
    fn files_of_one_name_are_found() {
        let file = "{a: {sweep: {k: [1]}}, a-001: {}, a-1: {}, b: {plot: {mechanism: [x], c-d: [x], mode-1: [x]}}, b-c: {plot: {d: [x]}}, \
                    c: {modes: {}, plot: {mode-2: [x], mode: [x]}}, l: {linearize: {}}, l-A: {}, l-E: {}}";
        let map: Mapping = serde_yaml::from_str(file).unwrap();
        let studies: Vec<(&str, Node<'_>)> =
            map.iter().map(|(name, study): (&Value, _)| (name.as_str().unwrap(), Node::Plain(study))).collect();
        let places: Vec<String> = shared(&studies).into_iter().map(|fault| fault.place).collect();
        assert_eq!(places, ["studies.a-001", "studies.b.plot.mechanism", "studies.b-c.plot.d", "studies.c.plot.mode-2", "studies.l-A"]);
    }
}
