//! Names of a URDF as names of a model: letters, digits and `_`, each once, none that means something else.

use super::guard::opening;
use super::notes::Notes;
use super::robot::Robot;
use crate::model::names::{is_name, taken};
use crate::model::vocabulary::BODY_QUANTITIES;
use std::collections::HashSet;

/// Names of the parts of a robot, in the order of the file.
pub(super) struct Names {
    /// Of bodies.
    pub(super) links: Vec<String>,
    /// Of joints.
    pub(super) joints: Vec<String>,
    /// Of the points of the parents where joints sit.
    pub(super) points: Vec<String>,
    used: HashSet<String>,
}

impl Names {
    /// Names for all parts; those that had to change are noted.
    pub(super) fn new(robot: &Robot<'_, '_>, prefix: &str, notes: &mut Notes) -> Self {
        let mut names = Self { links: Vec::new(), joints: Vec::new(), points: Vec::new(), used: HashSet::new() };
        for link in &robot.links {
            let name = names.valid(&link.data.name, prefix, "link");
            note(notes, &format!("{prefix}{}", link.data.name), &name, opening(link.node).start);
            names.links.push(name);
        }
        for joint in &robot.joints {
            let name = names.valid(&joint.data.name, prefix, "joint");
            note(notes, &format!("{prefix}{}", joint.data.name), &name, opening(joint.node).start);
            let bare = name.strip_prefix(prefix).filter(|bare| is_name(bare)).unwrap_or(&name);
            let reserved = BODY_QUANTITIES.contains(&bare) || ["origin", "com", "qz"].contains(&bare);
            names.points.push(if reserved { format!("{bare}_joint") } else { bare.to_owned() });
            names.joints.push(name);
        }
        names
    }

    /// A name that nothing has yet.
    pub(super) fn fresh(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_owned();
        let mut count = 1;
        while !self.used.insert(name.clone()) {
            count += 1;
            name = format!("{wanted}_{count}");
        }
        name
    }

    fn valid(&mut self, name: &str, prefix: &str, kind: &str) -> String {
        let clean = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let mut text: String = format!("{prefix}{name}").chars().map(clean).collect();
        if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            text.insert(0, 'n');
        }
        if taken(&text).is_some() || self.used.contains(&text) {
            text = format!("{text}_{kind}");
        }
        self.fresh(&text)
    }
}

fn note(notes: &mut Notes, old: &str, new: &str, at: usize) {
    if old != new {
        notes.about("names that had to change: {}", format!("`{old}` is `{new}`"), at);
    }
}

/// Whether a single word is read by YAML as the text that it is, also by readers of YAML 1.1.
pub(super) fn plain(word: &str) -> bool {
    const WORDS: [&str; 10] = ["y", "n", "yes", "no", "on", "off", "true", "false", "null", "nan"];
    is_name(word) && !WORDS.contains(&word.to_ascii_lowercase().as_str())
}
