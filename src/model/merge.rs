//! Variants: RFC 7386 merge patches. Nothing is copied but the maps that a patch touches, and every merged place leads
//! back to the layer that it came from.

use super::spans::Step;
use serde_yaml::{Mapping, Value};
use std::fmt::Write;

/// A value as a reader sees it: of the file, or merged.
#[derive(Clone, Copy)]
pub(crate) enum Node<'n> {
    /// As it stands in the file.
    Plain(&'n Value),
    /// A map with patches applied.
    Merged(&'n Merged<'n>),
}

/// A map that patches have touched.
#[derive(Default)]
pub(crate) struct Merged<'a> {
    entries: Vec<(&'a str, Part<'a>)>,
}

/// A value of a merged map.
enum Part<'a> {
    Plain(&'a Value),
    Merged(Merged<'a>),
}

impl<'a> Part<'a> {
    fn node(&self) -> Node<'_> {
        match self {
            Part::Plain(value) => Node::Plain(value),
            Part::Merged(map) => Node::Merged(map),
        }
    }
}

impl<'a> Merged<'a> {
    /// A map as it stands. Keys that are not text are left out: they are reported where the shape is checked.
    pub(crate) fn new(map: &'a Mapping) -> Self {
        Self { entries: map.iter().filter_map(|(key, value)| Some((key.as_str()?, Part::Plain(value)))).collect() }
    }

    /// Applies a patch: `null` removes, maps are merged, everything else replaces.
    pub(crate) fn patch(&mut self, patch: &'a Mapping) {
        for (key, value) in patch {
            let Some(key) = key.as_str() else { continue };
            let here = self.entries.iter().position(|(name, _)| *name == key);
            match (value, here) {
                (Value::Null, Some(i)) => {
                    self.entries.remove(i);
                }
                (Value::Null, None) => {}
                (Value::Mapping(inner), Some(i)) => {
                    let part = &mut self.entries[i].1;
                    if let Part::Plain(Value::Mapping(map)) = part {
                        *part = Part::Merged(Merged::new(map));
                    }
                    match part {
                        Part::Merged(map) => map.patch(inner),
                        // a map takes the place of something else; its own nulls vanish
                        Part::Plain(_) => *part = Part::Merged(Merged::from_patch(inner)),
                    }
                }
                (Value::Mapping(inner), None) => self.entries.push((key, Part::Merged(Merged::from_patch(inner)))),
                (_, Some(i)) => self.entries[i].1 = Part::Plain(value),
                (_, None) => self.entries.push((key, Part::Plain(value))),
            }
        }
    }

    fn from_patch(patch: &'a Mapping) -> Self {
        let mut map = Self::default();
        map.patch(patch);
        map
    }
}

impl<'n> Node<'n> {
    /// The value of a key; `None` also for an empty value.
    pub(crate) fn get(self, key: &str) -> Option<Node<'n>> {
        let node = match self {
            Node::Plain(Value::Mapping(map)) => Node::Plain(map.get(key)?),
            Node::Plain(_) => return None,
            Node::Merged(map) => map.entries.iter().find(|(name, _)| *name == key)?.1.node(),
        };
        (!matches!(node, Node::Plain(Value::Null))).then_some(node)
    }

    /// Entries with a text as key, in file order; empty if this is no map.
    pub(crate) fn entries(self) -> Vec<(&'n str, Node<'n>)> {
        match self {
            Node::Plain(Value::Mapping(map)) => map.iter().filter_map(|(key, value)| Some((key.as_str()?, Node::Plain(value)))).collect(),
            Node::Plain(_) => Vec::new(),
            Node::Merged(map) => map.entries.iter().map(|(key, part)| (*key, part.node())).collect(),
        }
    }

    /// Items of a list; empty if this is none.
    pub(crate) fn items(self) -> &'n [Value] {
        match self {
            Node::Plain(Value::Sequence(items)) => items,
            _ => &[],
        }
    }

    /// The text, if it is one.
    pub(crate) fn text(self) -> Option<&'n str> {
        match self {
            Node::Plain(value) => value.as_str(),
            Node::Merged(_) => None,
        }
    }

    /// True for a map.
    pub(crate) fn is_map(self) -> bool {
        matches!(self, Node::Merged(_) | Node::Plain(Value::Mapping(_)))
    }

    /// True for a list.
    pub(crate) fn is_list(self) -> bool {
        matches!(self, Node::Plain(Value::Sequence(_)))
    }
}

/// What a model is merged of: where each merged value stands.
pub(crate) struct Layers<'a> {
    /// Sections of included files, below the file.
    pub(crate) below: Vec<&'a Mapping>,
    /// The file.
    pub(crate) file: &'a Mapping,
    /// Variants in order: name and patch.
    pub(crate) patches: Vec<(&'a str, &'a Mapping)>,
}

impl<'a> Layers<'a> {
    /// The merged file.
    pub(crate) fn merge(&self) -> Merged<'a> {
        let mut merged = Merged::default();
        match self.below[..] {
            [] => merged = Merged::new(self.file),
            // the file changes what it includes as a variant changes the file
            _ => self.below.iter().chain([&self.file]).for_each(|layer| merged.patch(layer)),
        }
        for (_, patch) in &self.patches {
            merged.patch(patch);
        }
        merged
    }

    /// Whether the model is more than the file alone.
    pub(crate) fn is_merged(&self) -> bool {
        !self.below.is_empty() || !self.patches.is_empty()
    }

    /// The layers from above, each with the head of its paths.
    fn all(&self) -> impl Iterator<Item = (String, &'a Mapping)> {
        let patches = self.patches.iter().rev().map(|(name, map)| (format!("variants.{name}."), *map));
        let below = self.below.iter().enumerate().rev().map(|(index, map)| (head(index), *map));
        patches.chain([(String::new(), self.file)]).chain(below)
    }

    /// Path in its layer of a merged path: of a value in the last layer that gives it, of a map in the layer that began it.
    pub(crate) fn source(&self, steps: &[Step<'_>]) -> String {
        if !self.is_merged() {
            return path(steps);
        }
        let mut head: Option<String> = None;
        for (name, map) in self.all() {
            match follow(map, steps) {
                Follow::Reached(value) => {
                    if head.is_none() || value.is_mapping() {
                        head = Some(name);
                    }
                    if !value.is_mapping() {
                        break;
                    }
                }
                // what lies below was removed or replaced here
                Follow::Cut => break,
                Follow::Absent => {}
            }
        }
        format!("{}{}", head.unwrap_or_default(), path(steps))
    }
}

enum Follow<'v> {
    Reached(&'v Value),
    /// A `null` or something that is no map stands on the way.
    Cut,
    Absent,
}

fn follow<'v>(map: &'v Mapping, steps: &[Step<'_>]) -> Follow<'v> {
    let mut steps = steps.iter();
    let Some(Step::Key(first)) = steps.next() else { return Follow::Absent };
    let Some(mut value) = map.get(*first) else { return Follow::Absent };
    for step in steps {
        let next = match (step, value) {
            (_, Value::Null) => return Follow::Cut,
            (Step::Key(key), Value::Mapping(map)) => map.get(*key),
            (Step::Index(i), Value::Sequence(items)) => items.get(*i),
            _ => return Follow::Cut,
        };
        match next {
            Some(next) => value = next,
            None => return Follow::Absent,
        }
    }
    if value.is_null() { Follow::Cut } else { Follow::Reached(value) }
}

/// A path as text: `joints.O.revolute[1]`.
pub(crate) fn path(steps: &[Step<'_>]) -> String {
    let length = steps.iter().map(|step| if let Step::Key(key) = step { key.len() + 1 } else { 4 }).sum();
    let mut text = String::with_capacity(length);
    for step in steps {
        match step {
            Step::Key(key) => {
                if !text.is_empty() {
                    text.push('.');
                }
                text.push_str(key);
            }
            // writing to a text cannot fail
            Step::Index(i) => drop(write!(text, "[{i}]")),
        }
    }
    text
}

/// Head of the places in the included file of this index: `urdf[0].bodies.link1`.
pub(crate) fn head(index: usize) -> String {
    format!("urdf[{index}].")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of RFC 7386, appendix A, that have a map as target.
    #[test]
    fn patches_are_those_of_rfc_7386() {
        for (target, patch, result) in [
            ("{a: b}", "{a: c}", "{a: c}"),
            ("{a: b}", "{b: c}", "{a: b, b: c}"),
            ("{a: b}", "{a: null}", "{}"),
            ("{a: b, b: c}", "{a: null}", "{b: c}"),
            ("{a: [b]}", "{a: c}", "{a: c}"),
            ("{a: c}", "{a: [b]}", "{a: [b]}"),
            ("{a: {b: c}}", "{a: {b: d, c: null}}", "{a: {b: d}}"),
            ("{a: [{b: c}]}", "{a: [1]}", "{a: [1]}"),
            ("{a: foo}", "{a: {b: c}}", "{a: {b: c}}"),
            ("{}", "{a: {bb: {ccc: null}}}", "{a: {bb: {}}}"),
        ] {
            let [target, patch, result]: [Mapping; 3] = [target, patch, result].map(|t| serde_yaml::from_str(t).unwrap());
            let mut merged = Merged::new(&target);
            merged.patch(&patch);
            assert_eq!(plain(Node::Merged(&merged)), Value::Mapping(result));
        }
    }

    fn plain(node: Node<'_>) -> Value {
        match node {
            Node::Plain(value) => value.clone(),
            merged => Value::Mapping(merged.entries().into_iter().map(|(k, v)| (Value::from(k), plain(v))).collect()),
        }
    }

    #[test]
    fn places_lead_to_the_layer_that_gave_the_value() {
        let file: Mapping = serde_yaml::from_str("{a: {x: 1, y: 2}, b: {z: 1}}").unwrap();
        let one: Mapping = serde_yaml::from_str("{a: {x: 5}, b: null}").unwrap();
        let two: Mapping = serde_yaml::from_str("{b: {w: [1, 2]}}").unwrap();
        let layers = Layers { below: vec![], file: &file, patches: vec![("one", &one), ("two", &two)] };
        let source = |steps: &[Step<'_>]| layers.source(steps);
        assert_eq!(source(&[Step::Key("a"), Step::Key("x")]), "variants.one.a.x");
        assert_eq!(source(&[Step::Key("a"), Step::Key("y")]), "a.y");
        assert_eq!(source(&[Step::Key("a")]), "a");
        assert_eq!(source(&[Step::Key("b")]), "variants.two.b");
        assert_eq!(source(&[Step::Key("b"), Step::Key("w"), Step::Index(1)]), "variants.two.b.w[1]");
    }
}
