//! The one name space of a model: what may be a name, what is taken, who is who.

use super::fault::{At, Fault, Spot};
use super::merge::{Layers, Node};
use crate::expression::{ExternalFunction, is_function};
use serde_yaml::{Mapping, Value};
use std::collections::HashMap;

/// Names that mean something everywhere.
const RESERVED: [&str; 15] = [
    "ground",
    "world",
    "t",
    "time",
    "com",
    "energy",
    "momentum",
    "shaking",
    "frame",
    "inertia_eq",
    "inertia_eq_slope",
    "pi",
    "and",
    "or",
    "not",
];

/// What a name stands for: index in the model's list of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entity {
    External(usize),
    Parameter(usize),
    Table(usize),
    Body(usize),
    Joint(usize),
    Coupling(usize),
    Driver(usize),
    Load(usize),
    Spring(usize),
    Motor(usize),
    Clutch(usize),
    State(usize),
    Measure(usize),
    Event(usize),
}

impl Entity {
    /// With its article, for messages.
    pub(crate) fn what(self) -> &'static str {
        match self {
            Self::External(_) => "a function from outside",
            Self::Parameter(_) => "a parameter",
            Self::Table(_) => "a table",
            Self::Body(_) => "a body",
            Self::Joint(_) => "a joint",
            Self::Coupling(_) => "a coupling",
            Self::Driver(_) => "a driver",
            Self::Load(_) => "a load",
            Self::Spring(_) => "a spring",
            Self::Motor(_) => "a motor",
            Self::Clutch(_) => "a clutch",
            Self::State(_) => "a state",
            Self::Measure(_) => "a measure",
            Self::Event(_) => "an event",
        }
    }
}

/// A section of the file and how its entries are counted.
type Section = (&'static str, fn(usize) -> Entity);

/// The sections whose keys share the name space. Body 0 is the ground.
const SECTIONS: [Section; 13] = [
    ("parameters", Entity::Parameter),
    ("tables", Entity::Table),
    ("bodies", |i| Entity::Body(i + 1)),
    ("joints", Entity::Joint),
    ("couplings", Entity::Coupling),
    ("drivers", Entity::Driver),
    ("loads", Entity::Load),
    ("springs", Entity::Spring),
    ("motors", Entity::Motor),
    ("clutches", Entity::Clutch),
    ("states", Entity::State),
    ("measures", Entity::Measure),
    ("events", Entity::Event),
];

/// Names with what they stand for.
pub(crate) type Names<'n> = (HashMap<&'n str, Entity>, Vec<(&'n str, Entity)>);

/// Every name of a model, to be looked up and in file order, with faults for those that are taken twice or reserved; external functions
/// come first.
pub(crate) fn collect<'n>(root: Node<'n>, layers: &Layers<'_>, externals: &'n [ExternalFunction], faults: &mut Vec<Fault>) -> Names<'n> {
    let mut names: HashMap<&str, (Entity, &str)> = HashMap::new();
    let mut listed = Vec::new();
    for (i, function) in externals.iter().enumerate() {
        names.insert(function.name(), (Entity::External(i), "functions"));
        listed.push((function.name(), Entity::External(i)));
    }
    for (section, entity) in SECTIONS {
        let Some(node) = root.get(section) else { continue };
        let at = At::ROOT.key(section);
        for (i, (name, _)) in node.entries().into_iter().enumerate() {
            let entity = entity(i);
            let place = || layers.source(&at.key(name).steps());
            let article = entity.what();
            // what stands in expressions; a load or a body may be called `floor`
            let in_expressions = matches!(entity, Entity::Parameter(_) | Entity::Table(_) | Entity::State(_) | Entity::Measure(_));
            if let Some(why) = taken(name).filter(|_| in_expressions || RESERVED.contains(&name)) {
                let help = format!("for example `{name}1`");
                faults.push(
                    Fault::new("reserved-name", place(), format!("`{name}` is {why}"), format!("another name for {article}"))
                        .at(Spot::Key)
                        .help(help),
                );
            }
            if let Some((first, where_)) = names.get(name) {
                let message = format!("`{name}` is already the name of {} in `{where_}`", first.what());
                faults.push(
                    Fault::new("duplicate-name", place(), message, "one name for one thing: all sections share their names")
                        .at(Spot::Key)
                        .help("rename one of the two"),
                );
            } else {
                names.insert(name, (entity, section));
                listed.push((name, entity));
            }
        }
    }
    (names.into_iter().map(|(name, (entity, _))| (name, entity)).collect(), listed)
}

/// Names that variants remove, with the section and the variant.
pub(crate) fn removed<'n>(layers: &Layers<'n>) -> Vec<(&'n str, &'static str, &'n str)> {
    let of_patch = |&(variant, patch): &(&'n str, &'n Mapping)| {
        let of_section = move |(section, _): Section| {
            let entries = patch.get(section).and_then(Value::as_mapping).into_iter().flatten();
            let gone = entries.filter(|(_, value)| value.is_null()).filter_map(|(name, _)| name.as_str());
            gone.map(move |name| (name, section, variant)).collect::<Vec<_>>()
        };
        SECTIONS.into_iter().flat_map(of_section).collect::<Vec<_>>()
    };
    layers.patches.iter().flat_map(of_patch).collect()
}

/// Why a name is not free, if it is not.
pub(crate) fn taken(name: &str) -> Option<&'static str> {
    if RESERVED.contains(&name) {
        Some("a reserved word")
    } else if is_function(name) {
        Some("a function")
    } else {
        None
    }
}

/// What is wrong with functions from outside, and the remedy.
pub(crate) fn unfit(externals: &[ExternalFunction]) -> Option<(String, String)> {
    for (i, function) in externals.iter().enumerate() {
        let name = function.name();
        if let Some(other) = std::iter::once(name).chain(function.names()).find(|name| !is_name(name)) {
            let help = "names consist of letters, digits and `_`, and begin with a letter".to_owned();
            return Some((format!("`{other}` is no name for a function or an argument"), help));
        }
        if let Some(why) = taken(name) {
            return Some((format!("`{name}` is {why}"), format!("another name for it, for example `{name}1`")));
        }
        if externals[..i].iter().any(|other| other.name() == name) {
            return Some((format!("there are two functions `{name}`"), "one name for one function".into()));
        }
        let mut names: Vec<&str> = function.names().collect();
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return Some((format!("`{name}` has two arguments or switches `{}`", pair[0]), "one name for one argument".into()));
        }
        if let Some(fault) = function.fault() {
            return Some(fault);
        }
    }
    None
}

/// `[A-Za-z][A-Za-z0-9_]*`
pub(crate) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_')
}

/// A name that may also have `-`.
pub(crate) fn is_title(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_' || c == b'-')
}

/// The name that was probably meant, if it can be repaired.
pub(crate) fn repaired(text: &str, title: bool) -> Option<String> {
    let mut name = String::new();
    for c in text.trim().chars().take(60) {
        match c {
            'ä' | 'á' | 'à' => name.push('a'),
            'ö' | 'ó' => name.push('o'),
            'ü' => name.push('u'),
            'é' | 'è' => name.push('e'),
            c if c.is_ascii_alphanumeric() || c == '_' => name.push(c),
            '-' if title => name.push('-'),
            ' ' | '-' | '.' | '/' => name.push(if title { '-' } else { '_' }),
            _ => {}
        }
    }
    if name.starts_with(|c: char| c.is_ascii_digit()) {
        name.insert(0, 'n');
    }
    is_title(&name).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        assert!(is_name("l_tip2") && !is_name("2l") && !is_name("a-b") && !is_name("") && !is_name("ä"));
        assert!(is_title("one-turn") && !is_title("-x"));
        assert_eq!(repaired("2nd bar", false).as_deref(), Some("n2nd_bar"));
        assert_eq!(repaired("länge", false).as_deref(), Some("lange"));
        assert_eq!(repaired("??", false), None);
    }
}
