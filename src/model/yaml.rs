//! Text → `serde_yaml::Value` in one pass over the events of an exact YAML parser: what could blow up, or means something else
//! to another reader of YAML, is refused with its place as soon as it is read.

use super::commas;
use super::fault::{Fault, Spot};
use super::spans::{Spans, byte_of};
use saphyr_parser::{Event, Parser, ScalarStyle};
use serde_yaml::{Mapping, Number, Value};

/// Largest file, bytes.
pub(crate) const MOST_BYTES: usize = 8 << 20;
/// Most digits of an integer.
const MOST_DIGITS: usize = 19;
/// Deepest nesting of maps and lists.
pub(crate) const MOST_DEPTH: usize = 64;

/// The map of a file.
pub(crate) fn read(text: &str) -> Result<Mapping, Vec<Fault>> {
    match value(text)? {
        Value::Mapping(map) => Ok(map),
        Value::Null => Err(vec![empty()]),
        _ => Err(vec![
            Fault::new("not-a-model", String::new(), "the file holds no map of keys and values", "a model, beginning with `grashof: 1`")
                .at(Spot::Bytes(first_word(text))),
        ]),
    }
}

fn empty() -> Fault {
    Fault::new("empty-file", String::new(), "the file is empty", "a model, beginning with `grashof: 1`")
        .help("begin with a model that runs: `grashof new four-bar`")
        .at(Spot::Bytes(0..0))
}

/// Bytes of the first line that says something.
fn first_word(text: &str) -> std::ops::Range<usize> {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim();
        if !trimmed.is_empty() && !trimmed.starts_with('#') {
            let from = start + (line.len() - line.trim_start().len());
            return from..from + trimmed.len();
        }
        start += line.len();
    }
    0..0
}

/// The value of a text. One reading serves for the refusals and for the value: serde_yaml's own reader needs 14 s for 50 000
/// nested braces and all memory for aliases [measured], and as much time again for a text that is in order.
fn value(text: &str) -> Result<Value, Vec<Fault>> {
    bounded(text)?;
    let at = |character: usize, width: usize| Spot::Bytes(byte_of(text, character)..byte_of(text, character + width));
    let mut documents = 0_usize;
    let mut tree = Tree::default();
    let mut parser = Parser::new_from_str(text);
    while let Some(next) = parser.next_event() {
        let (event, span) = next.map_err(|error| vec![syntax(text, error.info(), byte_of(text, error.marker().index()))])?;
        let (start, width) = (span.start.index(), span.end.index().saturating_sub(span.start.index()));
        if let Event::Scalar(_, _, anchor, tag) | Event::SequenceStart(anchor, tag) | Event::MappingStart(anchor, tag) = &event
            && (*anchor > 0 || tag.is_some())
        {
            return Err(vec![marked(text, sign_of(text, start, width, if tag.is_some() { '!' } else { '&' }))]);
        }
        match event {
            Event::DocumentStart(_) => {
                documents += 1;
                if documents > 1 {
                    let fault = Fault::new("two-documents", String::new(), "a second document begins here", "one model in a file");
                    return Err(vec![fault.at(at(start, 3)).help("remove the line `---` and what follows, or write two files")]);
                }
            }
            Event::Alias(_) => return Err(vec![marked(text, byte_of(text, start))]),
            Event::Scalar(word, ScalarStyle::Plain, ..) => {
                let value = plain(&word).map_err(|fault| vec![fault.at(at(start, width))])?;
                tree.add(value);
            }
            // the parser's own texts have room to spare
            Event::Scalar(word, ..) => tree.add(Value::String((*word).to_owned())),
            Event::SequenceStart(..) => tree.begin(Value::Sequence(Vec::new())),
            Event::MappingStart(..) => tree.begin(Value::Mapping(Mapping::new())),
            Event::SequenceEnd | Event::MappingEnd => tree.end(),
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => {}
        }
        if tree.open.len() > MOST_DEPTH {
            let message = format!("maps and lists nested deeper than {MOST_DEPTH}");
            let fault = Fault::new("too-deep", String::new(), message, "a model, which needs about six levels");
            return Err(vec![fault.at(at(start, 1))]);
        }
        if tree.twice {
            return Err(twice(text, at(start, width)));
        }
    }
    if documents == 0 { Err(vec![empty()]) } else { Ok(tree.root) }
}

/// What is refused before a text is read.
fn bounded(text: &str) -> Result<(), Vec<Fault>> {
    if text.len() > MOST_BYTES {
        let message = format!("the file has more than {MOST_BYTES} bytes");
        return Err(vec![Fault::new("file-too-large", String::new(), message, "at most 8 MiB").at(Spot::Bytes(0..0))]);
    }
    if let Some(at) = text.find('\0') {
        let fault = Fault::new("yaml-syntax", String::new(), "the file holds a zero byte", "a text file");
        return Err(vec![fault.at(Spot::Bytes(at..at + 1)).help("save it as UTF-8, without zero bytes")]);
    }
    let directive = first_word(text);
    if text[directive.clone()].starts_with('%') {
        let fault = Fault::new("yaml-directive", String::new(), "a YAML directive", "the first key, `grashof: 1`");
        return Err(vec![fault.at(Spot::Bytes(directive)).help("remove the line")]);
    }
    Ok(())
}

/// The value that is being read: the collections that are open, each with the key that waits for its value.
#[derive(Default)]
struct Tree {
    root: Value,
    open: Vec<(Value, Option<Value>)>,
    /// Whether a map has got a key that it had.
    twice: bool,
}

impl Tree {
    fn begin(&mut self, collection: Value) {
        self.open.push((collection, None));
    }

    fn end(&mut self) {
        if let Some((mut closed, _)) = self.open.pop() {
            // most have one entry or two and are made with room for four
            match &mut closed {
                Value::Mapping(map) => map.shrink_to_fit(),
                Value::Sequence(items) => items.shrink_to_fit(),
                _ => {}
            }
            self.add(closed);
        }
    }

    fn add(&mut self, value: Value) {
        match self.open.last_mut() {
            None => self.root = value,
            Some((Value::Sequence(items), _)) => items.push(value),
            Some((Value::Mapping(map), key)) => match key.take() {
                None => {
                    self.twice |= map.contains_key(&value);
                    *key = Some(value);
                }
                Some(key) => drop(map.insert(key, value)),
            },
            Some(_) => {}
        }
    }
}

/// The value of a scalar without quotes, by the core schema of YAML 1.2.
fn plain(word: &str) -> Result<Value, Box<Fault>> {
    let refused = |code, message: String, help: &str| {
        Err(Box::new(Fault::new(code, String::new(), message, "a number such as `0.5`, `12` or `1e-3`").help(help)))
    };
    match word {
        "" | "~" | "null" | "Null" | "NULL" => return Ok(Value::Null),
        "true" | "True" | "TRUE" => return Ok(Value::Bool(true)),
        "false" | "False" | "FALSE" => return Ok(Value::Bool(false)),
        _ => {}
    }
    if !word.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
        return Ok(Value::String(word.to_owned()));
    }
    if vanishes(word) {
        return refused("expression", format!("found `{word}`"), "the size of a number lies between 1e-308 and 1e308");
    }
    let digits = word.strip_prefix(['+', '-']).unwrap_or(word);
    match word.parse::<Number>() {
        Ok(read) => Ok(Value::Number(read)),
        Err(_) if digits.len() > MOST_DIGITS && !digits.starts_with('0') && digits.bytes().all(|c| c.is_ascii_digit()) => {
            refused("bad-number", format!("an integer of more than {MOST_DIGITS} digits"), "write it with an exponent")
        }
        Err(_) => Ok(Value::String(word.to_owned())),
    }
}

/// Whether a number is so small that it would be read as 0.
fn vanishes(word: &str) -> bool {
    let mantissa = word.split(['e', 'E']).next().unwrap_or(word);
    word.contains(['e', 'E']) && mantissa.bytes().any(|c| matches!(c, b'1'..=b'9')) && word.parse::<f64>() == Ok(0.0)
}

/// Byte of the sign `!` or `&` in front of a value that begins at a character: the span of a collection begins behind its properties.
fn sign_of(text: &str, start: usize, width: usize, sign: char) -> usize {
    let begin = byte_of(text, start);
    let reach = byte_of(text, start + width.max(1));
    text[begin..reach].find(sign).map(|i| begin + i).or_else(|| text[..begin].rfind(sign)).unwrap_or(begin)
}

/// A value that begins with a sign that YAML keeps for itself.
fn marked(text: &str, at: usize) -> Fault {
    let rest = &text[at..];
    let word: String = rest.chars().take_while(|c| !c.is_whitespace() && !",]}".contains(*c)).take(40).collect();
    let line_end = rest.find(['\n', '#']).unwrap_or(rest.len());
    let sign = rest.chars().next().unwrap_or(' ');
    let (what, code) = match sign {
        '*' => ("an alias", "yaml-alias"),
        '&' => ("an anchor", "yaml-anchor"),
        '!' => ("a tag", "yaml-tag"),
        '|' | '>' => ("a block of text", "yaml-syntax"),
        _ => ("a sign that YAML reserves", "yaml-syntax"),
    };
    let help = match sign {
        '*' | '&' => "to use a value twice make it a parameter; to change a model use `variants`".to_owned(),
        '|' | '>' => "to compare, begin with the left side: `omega > 3`".to_owned(),
        _ => format!("if it is text, write it in quotes: {:?}", rest[..line_end].trim_end_matches([' ', '}', ']', ','])),
    };
    Fault::new(code, String::new(), format!("`{word}`: {what}"), format!("a value; it cannot begin with `{sign}`"))
        .at(Spot::Bytes(at..at + word.len()))
        .help(help)
}

/// An error of the YAML parser in the words of this program.
fn syntax(text: &str, info: &str, at: usize) -> Fault {
    let rest = &text[at..];
    let first = rest.chars().next();
    if let Some(sign) = first
        && "*&!|>%@`".contains(sign)
        && !info.contains("indent")
    {
        return marked(text, at);
    }
    let width = first.map_or(0, char::len_utf8);
    let fault = |expected: &str| {
        let message = format!("this is not YAML: {}", info.trim_start_matches("while ").trim());
        Fault::new("yaml-syntax", String::new(), message, expected).at(Spot::Bytes(at..at + width))
    };
    if info.contains("recursion limit") {
        let mut fault = fault("at most 64 levels");
        (fault.code, fault.message) = ("too-deep", "lists or maps are nested too deeply".to_owned());
        return fault.help("look for brackets that are not closed");
    }
    let line_start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let line = text[line_start..].lines().next().unwrap_or("");
    if info.contains("tab") || line.trim_start_matches(' ').starts_with('\t') {
        let mut fault = fault("spaces in front of a key");
        fault.message = "a tab in front of the text".to_owned();
        // the parser may stop a line too early
        let mut start = line_start;
        for line in text[line_start..].split_inclusive('\n') {
            let spaces = line.len() - line.trim_start_matches(' ').len();
            if line[spaces..].starts_with('\t') {
                fault.spot = Spot::Bytes(start + spaces..start + spaces + 1);
                break;
            }
            start += line.len();
        }
        return fault.help("indent with spaces");
    }
    if let Some(fault) = glued(text, line_start) {
        return fault;
    }
    if let Some(at) = line.find("~[").or_else(|| line.find("~{")).map(|i| line_start + i) {
        let mut fault = fault("`~` in front of a value; a list has it in front of each of them");
        fault.message = "`~` in front of a list or a map".to_owned();
        fault.spot = Spot::Bytes(at..at + 1);
        return fault.help("write `[~0 deg, ~0 deg, ~0 deg]`, or for a rotation `{ axis: [0, 0, 1], angle: ~30 deg }`");
    }
    if info.contains("mapping values are not allowed") {
        return fault("one `key: value` in a line, or a map in braces `{ key: value, key: value }`")
            .help("a colon followed by a space begins a value; put text with a colon in quotes");
    }
    if info.contains("quoted scalar") {
        return fault("a quote that closes the text").help("add the missing quote");
    }
    if first.is_none() || info.contains("',' or") || info.contains("bracket") || info.contains("indicator") || info.contains("flow") {
        return fault("lists `[a, b]` and maps `{ a: 1, b: 2 }` with all brackets closed")
            .help("look for a missing bracket, brace or comma here or above");
    }
    if info.contains("expected key") || info.contains("indent") || info.contains("block") {
        return fault("keys of one map in one column").help("line the key up with its neighbours");
    }
    fault("YAML: `key: value` in lines, deeper levels indented")
}

/// A key without a space behind its colon in the line of an error or in the last one above it that has words: the reader of
/// YAML takes it for text, and stumbles over what follows.
fn glued(text: &str, line_start: usize) -> Option<Fault> {
    let above = text[..line_start].trim_end().rfind('\n').map_or(0, |i| i + 1);
    [line_start, above].into_iter().find_map(|start| {
        let line = text[start..].lines().next().unwrap_or("");
        let (indent, inner) = (line.len() - line.trim_start().len(), line.trim_start());
        let (key, value) = inner.split_once(':')?;
        let glued = super::names::is_title(key) && value.starts_with(|c: char| c.is_ascii_alphanumeric() || "[{-.\"'~".contains(c));
        let at = start + indent;
        glued.then(|| {
            Fault::new("yaml-syntax", String::new(), format!("no space after the colon of `{key}:`"), "`key: value`, with a space")
                .at(Spot::Bytes(at..at + key.len() + 1))
                .help(format!("write `{key}: {}`", super::suggest::clip(value.split(" #").next().unwrap_or(value).trim_end())))
        })
    })
}

/// All keys that stand twice in their map; the first of them was found at `at`.
fn twice(text: &str, at: Spot) -> Vec<Fault> {
    let fault = |key: &str, at: Spot| {
        let message = if key.is_empty() { "this key appears here twice".to_owned() } else { format!("`{key}` appears here twice") };
        Fault::new("duplicate-key", String::new(), message, "each key once").at(at).help("rename or remove one of the two")
    };
    let found = Spans::new(text).twice;
    if found.is_empty() {
        // the same number, written in two ways
        return vec![fault("", at)];
    }
    let mut faults = Vec::new();
    let mut cut = Vec::new();
    for (first, second, key) in found {
        // `{ a: max(x, 1), b: max(y, 1) }` has the key `1)` twice
        if commas::ends_a_call(&key) {
            cut.extend([first, second]);
            continue;
        }
        let mut fault = fault(&key, Spot::Bytes(second));
        fault.other = Some((first, "first here".to_owned()));
        faults.push(fault);
    }
    cut.sort_by_key(|place| place.start);
    cut.dedup();
    faults.extend(cut.into_iter().map(|place| commas::comma_before(text, place)));
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(text: &str) -> &'static str {
        read(text).map_or_else(|faults| faults[0].code, |_| "read")
    }

    #[test]
    fn what_means_something_else_to_others_is_refused() {
        for (text, expected) in [
            ("", "empty-file"),
            ("# nothing\n", "empty-file"),
            ("- a\n", "not-a-model"),
            ("a: 1\n---\nb: 2\n", "two-documents"),
            ("a: &x 1\nb: *x\n", "yaml-anchor"),
            ("b: *x\n", "yaml-alias"),
            ("b: { c: !t [1] }\n", "yaml-tag"),
            ("b: @x\n", "yaml-syntax"),
            ("b: > 3\n", "yaml-syntax"),
            ("%YAML 1.2\n---\na: 1\n", "yaml-directive"),
            ("a: 1\nb: 2\na: 3\n", "duplicate-key"),
            ("1: b\n0x1: c\n", "duplicate-key"),
            ("a: 99999999999999999999\n", "bad-number"),
            ("a: [1, 2\nb: 3\n", "yaml-syntax"),
            ("a: \0\n", "yaml-syntax"),
            ("a: b\n", "read"),
            ("p:\n  a:1 m\n  b: 2\n", "yaml-syntax"),
        ] {
            assert_eq!(code(text), expected, "{text:?}");
        }
    }

    #[test]
    fn values_are_those_of_serde_yaml() {
        let words = "0 -0 +0 00 07 0.5 .5 5. -.5 +.5 1e3 1E-3 1e+3 1e 12 -12 +12 +-1 -+1 --1 0x1F -0x1f +0x1f 0o17 0o8 0b101 0b2 1_000 \
            1,5 1:30 2001-01-01 .inf -.inf +.inf .Inf .nan .NaN nan inf -inf infinity NaN 1e999 -1e999 18446744073709551615 \
            9223372036854775808 -9223372036854775808 null Null NULL nUll ~ ~5 true True TRUE tRue false yes no on off y n - -a . .. ... \
            1.5.2 1m 3 deg +a 0.1e-5 1e-300 00.5 -007 0x -0x 0xg e3 E3 - 1 é";
        let single = words.split(' ').filter(|word| !word.is_empty() && !matches!(*word, "-" | "..."));
        for text in single.map(|word| format!("k: {word}")).chain([
            "k:".to_owned(),
            "k: ''\nl: '12'\nm: \"1\\te\"\nn: [a, 1, ~, 'b''c', [], {}]\n".to_owned(),
            "1: a\ntrue: b\n~: c\n2.5: d\n? [a, b]\n: e\n".to_owned(),
            "k: |\n  12\n  b\nl: >-\n  a\n  b\n\n  c\n".to_owned(),
            "k: a b\n  c # d\nl:\n- 1\n- - 2\n  - 3\n- m: 4\n  n:\n    o: 5\n".to_owned(),
            "k: { a, b: 1, 'c':2, d: }\n".to_owned(),
        ]) {
            let oracle: Value = serde_yaml::from_str(&text).unwrap();
            assert_eq!(value(&text).unwrap(), oracle, "{text}");
        }
    }

    #[test]
    fn models_are_read_as_by_serde_yaml() {
        let models = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
        let mut count = 0;
        for entry in std::fs::read_dir(models).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|end| end == "yaml") {
                let text = std::fs::read_to_string(&path).unwrap();
                assert_eq!(read(&text).unwrap(), serde_yaml::from_str::<Mapping>(&text).unwrap(), "{}", path.display());
                count += 1;
            }
        }
        assert!(count > 20, "{count}");
    }

    #[test]
    fn a_missing_space_is_shown_where_it_is_missing() {
        for (text, glued) in [
            ("p:\n  a:1 m\n  b: 2\n", "a:"),
            ("p:\n  a: 1 m\n\n  bb:[1, 2]\n\nq: 3\n", "bb:"),
            ("p:\n  a: 1 m\n  b:2 m # two\n\nq:\n  c: 3\n", "b:"),
        ] {
            let fault = &read(text).unwrap_err()[0];
            let Spot::Bytes(at) = &fault.spot else { panic!("{fault:?}") };
            assert_eq!(&text[at.clone()], glued, "{fault:?}");
            assert!(fault.help.as_ref().is_some_and(|help| help.starts_with(&format!("write `{glued} "))), "{fault:?}");
        }
    }

    #[test]
    fn depth_and_size_are_bounded() {
        let nested = |n: usize| format!("a: {}{}", "[".repeat(n), "]".repeat(n));
        assert_eq!(code(&nested(63)), "read");
        assert_eq!(code(&nested(64)), "too-deep");
        assert_eq!(code(&format!("a: {}", "{a: ".repeat(50_000))), "too-deep");
        assert_eq!(code(&format!("a: {}", "x".repeat(MOST_BYTES))), "file-too-large");
    }
}
