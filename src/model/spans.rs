//! Path → place in the text. Built only when a fault has to be shown: a second reading of the text by `saphyr-parser`,
//! whose events carry positions (serde_yaml forgets them).

use saphyr_parser::{Event, Parser, ScalarStyle};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

/// One step of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step<'p> {
    /// A key of a map.
    Key(&'p str),
    /// An index of a list.
    Index(usize),
}

/// The places of all nodes of a document.
pub(crate) struct Spans {
    nodes: Vec<Node>,
    /// Byte ranges of keys that occur twice in their map: first and second.
    pub(crate) twice: Vec<(Range<usize>, Range<usize>, String)>,
}

/// A node of the document: 0 is the root.
struct Node {
    /// Bytes of the value, quotes included.
    span: Range<usize>,
    /// Bytes of its key, if it is a value of a map.
    key: Option<Range<usize>>,
    style: Option<ScalarStyle>,
    children: Children,
}

enum Children {
    None,
    Map(Vec<(String, usize)>),
    List(Vec<usize>),
}

/// A collection that is being read.
struct Open {
    node: usize,
    /// In a map: the key that waits for its value.
    key: Option<(String, Range<usize>)>,
    /// In a map: the keys so far.
    keys: HashMap<String, Range<usize>>,
}

/// Byte offsets of characters: the parser counts characters.
enum Offsets {
    Ascii(usize),
    Table(Vec<usize>),
}

impl Offsets {
    fn new(text: &str) -> Self {
        if text.is_ascii() {
            Self::Ascii(text.len())
        } else {
            Self::Table(text.char_indices().map(|(i, _)| i).chain([text.len()]).collect())
        }
    }

    fn byte(&self, character: usize) -> usize {
        match self {
            Self::Ascii(length) => character.min(*length),
            Self::Table(table) => table.get(character).or(table.last()).copied().unwrap_or(0),
        }
    }
}

/// Byte offset of the `character`-th character of the text.
pub(crate) fn byte_of(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(i, _)| i)
}

impl Spans {
    /// Reads as far as the text is well formed.
    pub(crate) fn new(text: &str) -> Self {
        let offsets = Offsets::new(text);
        let mut spans = Self { nodes: Vec::new(), twice: Vec::new() };
        let mut open: Vec<Open> = Vec::new();
        let mut parser = Parser::new_from_str(text);
        while let Some(Ok((event, span))) = parser.next_event() {
            let range = offsets.byte(span.start.index())..offsets.byte(span.end.index());
            match event {
                Event::StreamEnd | Event::DocumentEnd => break,
                Event::Scalar(value, style, ..) => spans.scalar(text, &mut open, value, style, range),
                Event::Alias(_) => spans.scalar(text, &mut open, Cow::Borrowed("*"), ScalarStyle::Plain, range),
                Event::MappingStart(..) => spans.begin(&mut open, Children::Map(Vec::new()), range),
                Event::SequenceStart(..) => spans.begin(&mut open, Children::List(Vec::new()), range),
                Event::MappingEnd | Event::SequenceEnd => {
                    if let Some(closed) = open.pop() {
                        let node = &mut spans.nodes[closed.node];
                        node.span.end = range.end.max(node.span.start);
                        let end = trimmed(text, node.span.clone());
                        node.span = end;
                    }
                }
                Event::Nothing | Event::StreamStart | Event::DocumentStart(_) => {}
            }
        }
        // what an error left open reaches to the end of what was read
        for rest in open {
            spans.nodes[rest.node].span = trimmed(text, spans.nodes[rest.node].span.start..text.len());
        }
        spans
    }

    fn begin(&mut self, open: &mut Vec<Open>, children: Children, range: Range<usize>) {
        let node = self.add(open, Node { span: range, key: None, style: None, children });
        open.push(Open { node, key: None, keys: HashMap::new() });
    }

    fn scalar(&mut self, text: &str, open: &mut [Open], value: Cow<'_, str>, style: ScalarStyle, range: Range<usize>) {
        let range = if value.is_empty() && style == ScalarStyle::Plain { range.start..range.start } else { trimmed(text, range) };
        if let Some(parent) = open.last_mut()
            && parent.key.is_none()
            && matches!(self.nodes[parent.node].children, Children::Map(_))
        {
            match parent.keys.get(value.as_ref()) {
                Some(first) => self.twice.push((first.clone(), range.clone(), value.clone().into_owned())),
                None => drop(parent.keys.insert(value.clone().into_owned(), range.clone())),
            }
            parent.key = Some((value.into_owned(), range));
            return;
        }
        self.add(open, Node { span: range, key: None, style: Some(style), children: Children::None });
    }

    /// Enters a value below the innermost open collection.
    fn add(&mut self, open: &mut [Open], mut node: Node) -> usize {
        let index = self.nodes.len();
        if let Some(parent) = open.last_mut() {
            match &mut self.nodes[parent.node].children {
                Children::List(items) => items.push(index),
                Children::Map(entries) => match parent.key.take() {
                    Some((key, range)) => {
                        node.key = Some(range);
                        entries.push((key, index));
                    }
                    // a collection as a key: refused elsewhere, but its value must find a key
                    None => parent.key = Some((String::new(), node.span.clone())),
                },
                Children::None => {}
            }
        }
        self.nodes.push(node);
        index
    }

    /// The node at a path written as `joints.O.revolute[1]`, and whether the whole path was found; else the last node on the way.
    fn find(&self, path: &str) -> (usize, bool) {
        let mut best = (0, 0);
        let found = self.descend(0, path, 0, &mut best);
        found.map_or((best.1, false), |node| (node, true))
    }

    /// Keys may contain dots (`O.angle`), so every key that the rest of the path begins with is tried.
    fn descend(&self, node: usize, rest: &str, depth: usize, best: &mut (usize, usize)) -> Option<usize> {
        if depth >= best.0 {
            *best = (depth, node);
        }
        if rest.is_empty() {
            return Some(node);
        }
        match &self.nodes.get(node)?.children {
            Children::None => None,
            Children::List(items) => {
                let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
                let child = *items.get(index.parse::<usize>().ok()?)?;
                self.descend(child, after.strip_prefix('.').unwrap_or(after), depth + 1, best)
            }
            Children::Map(entries) => {
                for (key, child) in entries {
                    if let Some(after) = rest.strip_prefix(key.as_str()) {
                        let next = if after.is_empty() || after.starts_with('[') { Some(after) } else { after.strip_prefix('.') };
                        if let Some(found) = next.and_then(|next| self.descend(*child, next, depth + 1, best)) {
                            return Some(found);
                        }
                    }
                }
                None
            }
        }
    }

    /// True if the whole path exists.
    pub(crate) fn has(&self, path: &str) -> bool {
        !self.nodes.is_empty() && self.find(path).1
    }

    /// Bytes of the value at a path, or of the nearest key on the way to it.
    pub(crate) fn value(&self, path: &str) -> Option<Range<usize>> {
        let (index, whole) = self.find(path);
        let node = self.nodes.get(index)?;
        // a map of several lines is shown by its key
        match (&node.key, &node.children) {
            (Some(key), Children::Map(_) | Children::List(_)) if !whole => Some(key.clone()),
            (Some(key), _) if node.span.is_empty() => Some(key.clone()),
            _ => Some(node.span.clone()),
        }
    }

    /// Bytes of the key at a path, or of the value if it has none.
    pub(crate) fn key(&self, path: &str) -> Option<Range<usize>> {
        let (index, _) = self.find(path);
        let node = self.nodes.get(index)?;
        node.key.clone().or_else(|| Some(node.span.clone()))
    }

    /// Bytes of a part of a scalar, given as bytes of its value. Block scalars are shown by their key.
    pub(crate) fn within(&self, text: &str, path: &str, value: &str, part: Range<usize>, in_key: bool) -> Option<Range<usize>> {
        let (index, whole) = self.find(path);
        let node = self.nodes.get(index)?;
        let span = if in_key { node.key.clone()? } else { node.span.clone() };
        if !whole || matches!(node.style, Some(ScalarStyle::Literal | ScalarStyle::Folded)) && !in_key {
            return self.key(path);
        }
        let source = text.get(span.clone())?;
        let quote = usize::from(source.starts_with(['"', '\'']));
        let from = align(value, source, quote, part.start.min(value.len()));
        let to = align(value, source, quote, part.end.min(value.len()));
        match (from, to) {
            (Some(from), Some(to)) => Some(span.start + from..span.start + to.max(from)),
            _ => Some(span),
        }
    }
}

/// Offset in `source` (from `start`) of the byte `offset` of `value`: they are equal but for folded lines and escapes.
fn align(value: &str, source: &str, start: usize, offset: usize) -> Option<usize> {
    let mut rest = source.get(start..)?.char_indices().peekable();
    for (i, c) in value.char_indices() {
        if i >= offset {
            break;
        }
        let (_, found) = *rest.peek()?;
        if c == found {
            rest.next();
            if c == '\'' && source.starts_with('\'') {
                rest.next(); // '' is one apostrophe
            }
        } else if c == ' ' && found.is_whitespace() {
            while rest.peek().is_some_and(|(_, c)| c.is_whitespace()) {
                rest.next();
            }
        } else {
            return None;
        }
    }
    Some(start + rest.peek().map_or(source.len() - start, |(i, _)| *i))
}

/// The range without white space and comments' remains at its end.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    match text.get(range.clone()) {
        Some(part) => range.start..range.start + part.trim_end().len(),
        None => range,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, path: &str) -> String {
        let spans = Spans::new(text);
        spans.value(path).and_then(|range| text.get(range)).unwrap_or("?").to_owned()
    }

    #[test]
    fn paths_lead_to_their_text() {
        let text = "a: 1 # ü\nb: { c: [1, x + ü], O.angle: ~33 deg }\nd:\n  e: 'it''s'\n";
        assert_eq!(at(text, "b.c[1]"), "x + ü");
        assert_eq!(at(text, "b.O.angle"), "~33 deg");
        assert_eq!(at(text, "d.e"), "'it''s'");
        assert_eq!(at(text, "b.c"), "[1, x + ü]");
    }

    #[test]
    fn parts_of_scalars_are_found_behind_quotes_and_folds() {
        let text = "a: 'it''s b'\nc: one\n   two\n";
        let spans = Spans::new(text);
        let part = |path, value: &str, range| spans.within(text, path, value, range, false).and_then(|r| text.get(r));
        assert_eq!(part("a", "it's b", 5..6), Some("b"));
        assert_eq!(part("c", "one two", 4..7), Some("two"));
    }

    #[test]
    fn equal_keys_are_found_at_both_places() {
        let spans = Spans::new("a: 1\nb: { x: 1, y: 2, x: 3 }\n");
        assert_eq!(spans.twice, [(10..11, 22..23, "x".to_owned())]);
    }
}
