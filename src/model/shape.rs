//! The generic reader: walks a value along the tables of fields and collects every fault of form. What passes here has the
//! right keys and the right kinds of values; their meaning is checked where they are decoded.

use super::commas::{comma, decimal, open_parenthesis, rejoin};
use super::fault::{At, Fault, Spot};
use super::fields::{Field, Keys, Record, Shape, Size, Want};
use super::merge::{Layers, Node};
use super::misplaced;
use super::suggest::{self, clip};
use super::tables::{FILE, NOT_IN_VARIANTS};
use crate::expression::Dimension;
use serde_yaml::Value;
use std::cmp::Reverse;

/// A walk along the tables.
pub(crate) struct Shapes<'a> {
    /// Where merged values come from.
    pub(crate) layers: &'a Layers<'a>,
    /// Components of a vector; `None` if the file does not say.
    pub(crate) components: Option<usize>,
    /// True inside of a patch: nothing is required and `null` removes.
    pub(crate) patch: bool,
    /// True if the sections of the file are a patch over what it includes.
    over: bool,
    /// What was found.
    pub(crate) faults: Vec<Fault>,
}

impl Shapes<'_> {
    fn place(&self, at: &At<'_, '_>) -> String {
        self.layers.source(&at.steps())
    }

    fn fault(&mut self, code: &'static str, at: &At<'_, '_>, message: impl Into<String>, expected: impl Into<String>) -> &mut Fault {
        let place = self.place(at);
        self.faults.push(Fault::new(code, place, message, expected));
        let last = self.faults.len() - 1;
        &mut self.faults[last]
    }

    fn wrong_type(&mut self, node: Node<'_>, at: &At<'_, '_>, expected: &Shape) {
        let found = describe(node);
        let help = match (expected, node) {
            (Shape::Text, Node::Plain(Value::Number(n))) => Some(format!("write it in quotes: \"{n}\"")),
            (Shape::Flag, Node::Plain(Value::String(s))) if matches!(s.as_str(), "yes" | "on") => Some("write `true`".to_owned()),
            (Shape::Flag, Node::Plain(Value::String(s))) if matches!(s.as_str(), "no" | "off") => Some("write `false`".to_owned()),
            (Shape::Map(table), Node::Plain(Value::Number(n))) => with_its_key(table, &n.to_string()),
            (Shape::Map(table), Node::Plain(Value::String(s))) => with_its_key(table, &clip(s)),
            (Shape::Value(_), node) if node.is_list() => Some("write one value, without brackets".to_owned()),
            (shape, Node::Plain(Value::Number(n))) => self.as_vector(&n.to_string(), shape),
            (shape, Node::Plain(Value::String(text))) => self.as_vector(text, shape),
            _ => None,
        };
        self.fault("wrong-type", at, format!("found {found}"), expected.expected()).help = help;
    }

    /// What to write for one value in the place of a vector: along the first axis, an acceleration (of gravity) down.
    fn as_vector(&self, value: &str, expected: &Shape) -> Option<String> {
        let of = |shape: &Shape| match shape {
            Shape::List(Shape::Value(want), Size::Space) => Some(*want),
            _ => None,
        };
        let want = match expected {
            Shape::Either(shapes) => shapes.iter().find_map(of),
            shape => of(shape),
        }?;
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == value.trim()).filter(|_| want == Want::Of(Dimension::NONE));
        if let (Some(n), Some(axis)) = (self.components, axis)
            && axis < n
        {
            let unit: Vec<&str> = (0..n).map(|i| if i == axis { "1" } else { "0" }).collect();
            return Some(format!("write `[{}]`", unit.join(", ")));
        }
        let size = value.trim().trim_start_matches(['-', '+']).trim_start();
        let number = size.starts_with(|c: char| c.is_ascii_digit() || c == '.');
        let zeros = if self.components == Some(3) { "0, 0" } else { "0" };
        let vector = match want {
            Want::Of(dimension) if dimension == Dimension::ACCELERATION => format!("[{zeros}, -{}]", clip(size)),
            _ => format!("[{}, {zeros}]", clip(value.trim())),
        };
        number.then(|| format!("give its components, such as `{vector}`"))
    }

    /// Checks `node` against `shape`; `outer` says what is expected where the shape is one of several.
    pub(crate) fn check(&mut self, node: Node<'_>, shape: &Shape, at: &At<'_, '_>) {
        self.check_as(node, shape, at, shape);
    }

    fn check_as(&mut self, node: Node<'_>, shape: &Shape, at: &At<'_, '_>, outer: &Shape) {
        if let Node::Plain(Value::Null) = node {
            if !self.patch {
                let help = "give a value, or remove the key";
                self.fault("empty-value", at, "no value", outer.expected()).help = Some(help.to_owned());
                if let Some(fault) = self.faults.last_mut() {
                    fault.spot = Spot::Key;
                }
            }
            return;
        }
        match (shape, node) {
            (Shape::Either(shapes), _) => {
                let fits = |shape: &&Shape| match shape {
                    Shape::Map(_) | Shape::Named(..) | Shape::NamedBut(..) | Shape::Patch => node.is_map(),
                    Shape::List(..) => node.is_list(),
                    _ => !node.is_map() && !node.is_list(),
                };
                match shapes.iter().filter(fits).min_by_key(|shape| Reverse(likeness(node, shape))) {
                    Some(fitting) => self.check_as(node, fitting, at, outer),
                    None => self.wrong_type(node, at, outer),
                }
            }
            (Shape::Later, _) => {
                let fault = self.fault("not-yet", at, "this key is reserved for a later version", "");
                fault.spot = Spot::Key;
                fault.help = Some("remove it".to_owned());
            }
            (Shape::Value(_) | Shape::Formula(_), Node::Plain(Value::Number(n))) => {
                if !n.as_f64().is_some_and(f64::is_finite) {
                    let help = "a value is a finite number; leave out what has none".to_owned();
                    self.fault("bad-number", at, "not a finite number", outer.expected()).help = Some(help);
                }
            }
            (Shape::Value(_) | Shape::Formula(_), Node::Plain(Value::String(_))) => {}
            (Shape::Text | Shape::Name(_), Node::Plain(Value::String(_))) => {}
            (Shape::Word(words), Node::Plain(Value::String(word))) => {
                if !words.contains(&word.as_str()) {
                    let help = suggest::nearest(word, words.iter().copied()).map(|near| format!("did you mean `{near}`?"));
                    let help = help.or_else(|| self.as_vector(word, outer));
                    self.fault("unknown-word", at, format!("`{}` is not known here", clip(word)), outer.expected()).help = help;
                }
            }
            (Shape::Flag, Node::Plain(Value::Bool(_))) => {}
            (Shape::Count(least, most), Node::Plain(Value::Number(n))) => {
                if !n.as_u64().is_some_and(|n| (*least..=*most).contains(&n)) {
                    let help = match (*least, *most) {
                        (1, 1) => "this version reads models of version 1: write `grashof: 1`".to_owned(),
                        (least, most) => format!("write a whole number from {least} to {most}"),
                    };
                    self.fault("bad-count", at, format!("found {n}"), outer.expected()).help = Some(help);
                }
            }
            (Shape::CountOf(_, most), Node::Plain(Value::Number(n))) => {
                if n.as_u64().is_none_or(|n| n > *most) {
                    self.fault("bad-count", at, format!("found {n}"), outer.expected()).help =
                        Some(format!("write a whole number up to {most}"));
                }
            }
            (Shape::List(item, size), Node::Plain(Value::Sequence(items))) => self.list(items, item, *size, at, outer),
            (Shape::Map(table), _) if node.is_map() => self.map(node, table, at),
            (Shape::Named(keys, what, inner), _) if node.is_map() => self.named(node, *keys, (what, inner), None, at),
            (Shape::NamedBut(but, keys, what, inner), _) if node.is_map() => self.named(node, *keys, (what, inner), Some(but), at),
            (Shape::Patch, Node::Plain(Value::Mapping(_))) => self.variant(node, at),
            _ => self.wrong_type(node, at, outer),
        }
    }

    fn list(&mut self, items: &[Value], item: &Shape, size: Size, at: &At<'_, '_>, outer: &Shape) {
        if let Some(i) = items.iter().position(open_parenthesis)
            && let Some(joined) = rejoin(&items[i], items[i + 1..].iter())
        {
            let place = self.place(&at.index(i));
            self.faults.push(comma(place, &joined, None));
            return;
        }
        let right = match size {
            Size::AtLeast(n) => items.len() >= n,
            Size::Exactly(n) => items.len() == n,
            Size::Space => self.components.is_none_or(|n| items.len() == n),
            Size::OneOf(sizes) => sizes.contains(&items.len()),
        };
        if !right {
            let expected = match (size, self.components) {
                (Size::Space, Some(2)) => "2 components `[x, y]`: the model is planar".to_owned(),
                (Size::Space, Some(3)) => "3 components `[x, y, z]`: the model is spatial".to_owned(),
                _ => outer.expected(),
            };
            let n = items.len();
            let fault = self.fault("wrong-size", at, format!("a list of {n} item{}", if n == 1 { "" } else { "s" }), expected);
            fault.help = Some("write as many items as are expected, with a comma between them".to_owned());
        }
        // an empty value in a list is never "remove"
        let patch = std::mem::replace(&mut self.patch, false);
        for (i, value) in items.iter().enumerate() {
            self.check(Node::Plain(value), item, &at.index(i));
        }
        self.patch = patch;
    }

    /// Faults of keys as such; true if the entry is to be read no further.
    fn strange_key(&mut self, key: &Value, value: Node<'_>, at: &At<'_, '_>) -> bool {
        let empty = matches!(value, Node::Plain(Value::Null));
        let Some(text) = key.as_str() else {
            let found = describe(Node::Plain(key));
            self.fault("bad-name", at, format!("a key that is {found}"), "a name as key").help =
                Some("write it in quotes, or rename it".to_owned());
            return true;
        };
        if text == "<<" {
            let fault = self.fault("yaml-merge-key", &at.key(text), "a merge key", "keys of the format");
            fault.spot = Spot::Key;
            fault.help = Some("write the keys out, or use `variants`".to_owned());
            return true;
        }
        if empty && let Some((name, rest)) = text.split_once(':') {
            let help = format!("write `{name}: {rest}`");
            let fault = self.fault("missing-space", &at.key(text), "a colon without a space after it", "`key: value`");
            fault.spot = Spot::Key;
            fault.help = Some(help);
            return true;
        }
        false
    }

    /// Values that a comma has cut: their indices and those of the pieces.
    fn commas(&mut self, node: Node<'_>, at: &At<'_, '_>) -> Vec<usize> {
        let Node::Plain(Value::Mapping(map)) = node else { return Vec::new() };
        let mut cut = Vec::new();
        let next = map.iter().skip(1).map(Some).chain([None]);
        for (i, ((key, value), next)) in map.iter().zip(next).enumerate() {
            let Some(name) = key.as_str() else { continue };
            if let Some(number) = decimal(value, next) {
                let help = format!("write `{name}: {number}`");
                self.fault("comma-in-braces", &at.key(name), "a comma in a number", "a decimal point").help = Some(help);
                cut.extend([i, i + 1]);
            }
            if !open_parenthesis(value) {
                continue;
            }
            let pieces = map.iter().skip(i + 1).take_while(|(_, value)| value.is_null()).map(|(key, _)| key);
            if let Some(joined) = rejoin(value, pieces) {
                let place = self.place(&at.key(name));
                self.faults.push(comma(place, &joined, Some(name)));
                cut.push(i);
                cut.extend((i + 1..map.len()).zip(map.iter().skip(i + 1)).take_while(|(_, (_, v))| v.is_null()).map(|(j, _)| j));
            }
        }
        cut
    }

    fn map(&mut self, node: Node<'_>, table: &'static Record, at: &At<'_, '_>) {
        let cut = self.commas(node, at);
        let mut unknown: Vec<Option<&'static str>> = Vec::new();
        if let Node::Plain(Value::Mapping(map)) = node {
            // `length:l1` is meant as `length`
            let glued = map.iter().filter(|(_, value)| value.is_null()).filter_map(|(key, _)| key.as_str()?.split_once(':'));
            unknown.extend(glued.map(|(name, _)| table.field(name).map(|f| f.key)));
        }
        let mut present: Vec<&'static str> = Vec::new();
        // the fault of the first key that is like none of the table
        let mut strange: Option<usize> = None;
        self.each(node, at, &cut, |shapes, key, value| {
            let here = at.key(key);
            match table.field(key) {
                Some(field) => {
                    present.push(field.key);
                    let before = shapes.patch;
                    shapes.patch |= shapes.over && std::ptr::eq(table, &FILE) && !NOT_IN_VARIANTS.contains(&field.key);
                    shapes.check(value, &field.shape, &here);
                    shapes.patch = before;
                }
                None => {
                    let near = suggest::nearest(key, table.fields.iter().map(|f| f.key));
                    let here_is = |field: &Field| node.get(field.key).is_some();
                    let elsewhere = misplaced::help(key, table, near.is_some(), &here_is);
                    let near = near.filter(|_| elsewhere.is_none());
                    unknown.push(near.and_then(|near| table.field(near)).map(|f| f.key));
                    let is_strange = near.is_none() && elsewhere.is_none();
                    let own = || suggest::help(key, table.fields.iter().map(|f| f.key).filter(|k| near.is_none() || Some(*k) == near));
                    let help = elsewhere.or_else(own);
                    let expected = format!("a key of {}", table.what);
                    let fault = shapes.fault("unknown-key", &here, format!("unknown key `{}`", clip(key)), expected);
                    fault.spot = Spot::Key;
                    fault.help = help;
                    if is_strange {
                        strange.get_or_insert(shapes.faults.len() - 1);
                    }
                }
            }
        });
        if self.patch {
            return;
        }
        let meant = |key: &str| unknown.iter().flatten().any(|near| *near == key) || !cut.is_empty();
        let included = |key: &str| self.over && key == "bodies" && std::ptr::eq(table, &FILE);
        let missing: Vec<_> =
            table.fields.iter().filter(|f| f.required && !present.contains(&f.key) && !meant(f.key) && !included(f.key)).collect();
        // a strange key where one is missing: one mistake; a section of the file stands for itself
        let mut strange = strange.filter(|_| !std::ptr::eq(table, &FILE));
        let alone = missing.len() == 1;
        for field in missing {
            if let Some(strange) = strange.take_if(|_| alone) {
                let fault = &mut self.faults[strange];
                fault.expected = format!("`{}`, which is missing in {}", field.key, table.what);
                fault.help = Some(format!("write `{}:` in its place {}", field.key, lower_first(field.doc)));
                continue;
            }
            let fault = self.fault("missing-key", at, format!("`{}` is missing in {}", field.key, table.what), field.shape.expected());
            fault.spot = Spot::Key;
            fault.help = Some(format!("add `{}:` {}", field.key, lower_first(field.doc)));
        }
        for choice in table.choices {
            let found: Vec<&str> = present.iter().copied().filter(|key| choice.keys.contains(key)).collect();
            let list = || suggest::known(choice.keys.iter().copied()).unwrap_or_default();
            let lacks = found.is_empty() && choice.required && !choice.keys.iter().any(|key| meant(key));
            if let Some(strange) = strange.take_if(|_| lacks) {
                let fault = &mut self.faults[strange];
                fault.expected = format!("one of {}, of which {} needs one", list(), table.what);
                fault.help = choice.keys.first().map(|key| format!("write one of them in its place, for example `{key}: ...`"));
            } else if lacks {
                let fault = self.fault("missing-key", at, format!("{} needs one more key", table.what), format!("one of {}", list()));
                fault.spot = Spot::Key;
                fault.help = choice.keys.first().map(|key| format!("add one of them, for example `{key}: ...`"));
            }
            if let [first, second, ..] = found[..] {
                let fault =
                    self.fault("two-kinds", &at.key(second), format!("`{second}` beside `{first}`"), format!("only one of {}", list()));
                fault.spot = Spot::Key;
                fault.help = Some("remove one of the two".to_owned());
            }
        }
    }

    fn named(&mut self, node: Node<'_>, keys: Keys, (what, inner): (&str, &Shape), but: Option<&Field>, at: &At<'_, '_>) {
        let cut = self.commas(node, at);
        self.each(node, at, &cut, |shapes, key, value| {
            let here = at.key(key);
            let good = match keys {
                Keys::Name => super::names::is_name(key),
                Keys::Title => super::names::is_title(key),
                Keys::Reference => true,
            };
            if !good {
                let dash = if keys == Keys::Title { ", `_` and `-`" } else { " and `_`" };
                let expected = format!("a name: a letter a-z or A-Z, then letters, digits{dash}");
                let help = super::names::repaired(key, keys == Keys::Title);
                let fault = shapes.fault("bad-name", &here, format!("`{}` cannot be the name of {what}", clip(key)), expected);
                fault.spot = Spot::Key;
                fault.help = help.map(|name| format!("for example `{name}`"));
            }
            if keys == Keys::Title && key.len() > LONGEST_TITLE {
                let expected = format!("at most {LONGEST_TITLE} characters: files of results begin with it");
                let fault = shapes.fault("bad-name", &here, format!("a name of {} characters", key.len()), expected);
                fault.spot = Spot::Key;
                fault.help = Some("give it a short name, and say the rest in `about`".to_owned());
            }
            let own = but.filter(|field| field.key == key && value.is_map());
            shapes.check(value, own.map_or(inner, |field| &field.shape), &here);
        });
    }

    /// Every entry with a sound key.
    fn each<'n>(&mut self, node: Node<'n>, at: &At<'_, '_>, cut: &[usize], mut f: impl FnMut(&mut Self, &'n str, Node<'n>)) {
        if let Node::Plain(Value::Mapping(map)) = node {
            for (i, (key, value)) in map.iter().enumerate() {
                if !cut.contains(&i)
                    && !self.strange_key(key, Node::Plain(value), at)
                    && let Some(key) = key.as_str()
                {
                    f(self, key, Node::Plain(value));
                }
            }
        } else {
            // keys of merged maps were looked at in the file and in the patch
            for (key, value) in node.entries() {
                f(self, key, value);
            }
        }
    }

    /// A patch: the same tables, nothing required.
    fn variant(&mut self, node: Node<'_>, at: &At<'_, '_>) {
        self.patch = true;
        let cut = self.commas(node, at);
        self.each(node, at, &cut, |shapes, key, value| {
            let here = at.key(key);
            match FILE.field(key).filter(|field| !NOT_IN_VARIANTS.contains(&field.key)) {
                Some(field) => shapes.check(value, &field.shape, &here),
                None => {
                    let keys = FILE.fields.iter().map(|f| f.key).filter(|key| !NOT_IN_VARIANTS.contains(key));
                    let near = || suggest::nearest(key, keys).map(|near| format!("did you mean `{near}`?"));
                    let (message, help) = match (key, FILE.field(key)) {
                        ("include", _) => (
                            "a variant cannot change `include`: files are read before variants are laid over them".into(),
                            Some("change bodies, joints and parameters of the robot in the variant, or write a second file with the other `include`".into()),
                        ),
                        ("studies", _) => (
                            "a variant cannot change `studies`".into(),
                            Some("write a second study beside the first, which may name the variant by `variant:`".into()),
                        ),
                        (_, Some(_)) => (format!("a variant cannot change `{key}`"), near()),
                        (_, None) => (format!("unknown section `{}`", clip(key)), near()),
                    };
                    let fault =
                        shapes.fault("unknown-key", &here, message, "a section of the file, such as `parameters`, `bodies`, `start`");
                    fault.spot = Spot::Key;
                    fault.help = help;
                }
            }
        });
        self.patch = false;
    }
}

/// What a value is, for messages.
pub(crate) fn describe(node: Node<'_>) -> String {
    match node {
        Node::Merged(_) | Node::Plain(Value::Mapping(_)) => "a map".to_owned(),
        Node::Plain(Value::Sequence(_)) => "a list".to_owned(),
        Node::Plain(Value::Null) => "nothing".to_owned(),
        Node::Plain(Value::Bool(b)) => format!("`{b}`"),
        Node::Plain(Value::Number(n)) => format!("the number {n}"),
        Node::Plain(Value::String(s)) => format!("the text `{}`", clip(s)),
        Node::Plain(Value::Tagged(_)) => "a tagged value".to_owned(),
    }
}

/// Longest name of what files are named after: two of them make the name of a figure.
const LONGEST_TITLE: usize = 100;

/// A value in the place of a map: under the one key that the map needs, beside the first of those of which it needs one.
fn with_its_key(table: &Record, value: &str) -> Option<String> {
    let mut required = table.fields.iter().filter(|field| field.required);
    let key = required.next().filter(|field| matches!(field.shape, Shape::Value(_)))?.key;
    let others: Vec<String> =
        table.choices.iter().filter(|choice| choice.required).map(|choice| format!(", {}: ...", choice.keys[0])).collect();
    required.next().is_none().then(|| format!("write `{{ {key}: {value}{} }}`", others.concat()))
}

fn lower_first(text: &str) -> String {
    let mut chars = text.trim_end_matches('.').chars();
    match chars.next() {
        Some(first) if !first.is_ascii_uppercase() || chars.clone().next().is_some_and(|c| c.is_uppercase()) => {
            format!("({first}{})", chars.as_str())
        }
        Some(first) => format!("({}{})", first.to_lowercase(), chars.as_str()),
        None => String::new(),
    }
}

/// All faults of form of a file: its own sections, its variants and its studies.
pub(crate) fn check_file(layers: &Layers<'_>, root: Node<'_>) -> Vec<Fault> {
    let mut shapes = shapes(layers, root);
    shapes.map(root, &FILE, &At::ROOT);
    shapes.faults
}

/// Faults of form of one section of a file.
pub(crate) fn check_section(layers: &Layers<'_>, section: Node<'_>, key: &str, root: Node<'_>) -> Vec<Fault> {
    let mut shapes = shapes(layers, root);
    if let Some(field) = FILE.field(key) {
        shapes.check(section, &field.shape, &At::ROOT.key(key));
    }
    shapes.faults
}

/// All faults of form of a merged model: what a variant left incomplete or made double.
pub(crate) fn check_merged(layers: &Layers<'_>, root: Node<'_>) -> Vec<Fault> {
    let mut shapes = shapes(layers, root);
    for field in FILE.fields.iter().filter(|field| !NOT_IN_VARIANTS.contains(&field.key)) {
        match root.get(field.key) {
            Some(node) => shapes.check(node, &field.shape, &At::ROOT.key(field.key)),
            None if field.required => {
                shapes.fault("missing-key", &At::ROOT, format!("no `{}` is left", field.key), field.shape.expected());
            }
            None => {}
        }
    }
    shapes.faults
}

fn shapes<'l>(layers: &'l Layers<'l>, root: Node<'_>) -> Shapes<'l> {
    let components = components(root.get("space").and_then(Node::text));
    Shapes { layers, components, patch: false, over: !layers.below.is_empty(), faults: Vec::new() }
}

fn components(space: Option<&str>) -> Option<usize> {
    match space {
        Some("planar") => Some(2),
        Some("spatial") => Some(3),
        _ => None,
    }
}

/// How many keys of a map are those of a table, and if none is, how many are like them.
fn likeness(node: Node<'_>, shape: &Shape) -> (usize, usize) {
    let Shape::Map(table) = shape else { return (0, 0) };
    let count = |of: &dyn Fn(&str) -> bool| node.entries().iter().filter(|(key, _)| node.get(key).is_some() && of(key)).count();
    match count(&|key| table.field(key).is_some()) {
        0 => (0, count(&|key| suggest::nearest(key, table.fields.iter().map(|field| field.key)).is_some())),
        known => (known, 0),
    }
}
