//! Text → `serde_yaml::Value`, with a guard in front: what could blow up, or means something else to another reader of
//! YAML, is refused with its place before anything is built.

use super::fault::{Fault, Spot};
use super::spans::{Spans, byte_of};
use saphyr_parser::{Event, Parser, ScalarStyle};
use serde_yaml::{Mapping, Value};

/// Largest file, bytes.
pub(crate) const MOST_BYTES: usize = 8 << 20;
/// Most digits of an integer that serde_yaml reads.
const MOST_DIGITS: usize = 19;
/// Deepest nesting of maps and lists.
pub(crate) const MOST_DEPTH: usize = 64;

/// The map of a file.
pub(crate) fn read(text: &str) -> Result<Mapping, Vec<Fault>> {
    guard(text).map_err(|fault| vec![*fault])?;
    match serde_yaml::from_str::<Value>(text) {
        Ok(Value::Mapping(map)) => Ok(map),
        Ok(Value::Null) => Err(vec![empty()]),
        Ok(_) => Err(vec![
            Fault::new("not-a-model", String::new(), "the file holds no map of keys and values", "a model, beginning with `grashof: 1`")
                .at(Spot::Bytes(first_word(text))),
        ]),
        Err(error) => Err(translate(text, &error)),
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

/// One linear pass over the events of an exact YAML parser. serde_yaml needs 14 s for 50 000 nested braces and all memory
/// for aliases [measured], so that neither may reach it.
fn guard(text: &str) -> Result<(), Box<Fault>> {
    let refuse = |code, character: usize, width: usize, message: String, expected: &str, help: &str| {
        let start = byte_of(text, character);
        let end = byte_of(text, character + width);
        let mut fault = Fault::new(code, String::new(), message, expected).at(Spot::Bytes(start..end));
        if !help.is_empty() {
            fault = fault.help(help);
        }
        Err(Box::new(fault))
    };
    if text.len() > MOST_BYTES {
        let message = format!("the file has more than {MOST_BYTES} bytes");
        return refuse("file-too-large", 0, 0, message, "at most 8 MiB", "");
    }
    if let Some(at) = text.find('\0') {
        let message = "the file holds a zero byte".to_owned();
        return refuse("yaml-syntax", text[..at].chars().count(), 1, message, "a text file", "save it as UTF-8, without zero bytes");
    }
    let directive = first_word(text);
    if text[directive.clone()].starts_with('%') {
        let fault = Fault::new("yaml-directive", String::new(), "a YAML directive", "the first key, `grashof: 1`");
        return Err(Box::new(fault.at(Spot::Bytes(directive)).help("remove the line")));
    }
    let (mut depth, mut documents) = (0_usize, 0_usize);
    let mut parser = Parser::new_from_str(text);
    loop {
        let (event, span) = match parser.next_event() {
            None => return Ok(()),
            Some(Ok(next)) => next,
            Some(Err(error)) => return Err(Box::new(syntax(text, error.info(), byte_of(text, error.marker().index())))),
        };
        let (start, width) = (span.start.index(), span.end.index().saturating_sub(span.start.index()));
        let (anchor, tag) = match &event {
            Event::StreamEnd => return if documents == 0 { Err(Box::new(empty())) } else { Ok(()) },
            Event::DocumentStart(_) => {
                documents += 1;
                if documents > 1 {
                    let help = "remove the line `---` and what follows, or write two files";
                    return refuse("two-documents", start, 3, "a second document begins here".to_owned(), "one model in a file", help);
                }
                continue;
            }
            Event::Alias(_) => {
                return Err(Box::new(marked(text, byte_of(text, start))));
            }
            Event::Scalar(word, ScalarStyle::Plain, ..) if vanishes(word) => {
                let spot = Spot::Bytes(byte_of(text, start)..byte_of(text, start + width));
                let fault = Fault::new("expression", String::new(), format!("found `{word}`"), "a number such as `0.5`, `12` or `1e-3`");
                return Err(Box::new(fault.at(spot).help("the size of a number lies between 1e-308 and 1e308")));
            }
            Event::Scalar(_, _, anchor, tag) => (*anchor, tag.is_some()),
            Event::SequenceStart(anchor, tag) | Event::MappingStart(anchor, tag) => {
                depth += 1;
                if depth > MOST_DEPTH {
                    let message = format!("maps and lists nested deeper than {MOST_DEPTH}");
                    return refuse("too-deep", start, 1, message, "a model, which needs about six levels", "");
                }
                (*anchor, tag.is_some())
            }
            Event::SequenceEnd | Event::MappingEnd => {
                depth = depth.saturating_sub(1);
                continue;
            }
            _ => continue,
        };
        if anchor > 0 || tag {
            let begin = byte_of(text, start);
            let sign = if tag { '!' } else { '&' };
            // a collection's span begins behind its properties: look back for the sign
            let reach = byte_of(text, start + width.max(1));
            let at = text[begin..reach].find(sign).map(|i| begin + i).or_else(|| text[..begin].rfind(sign)).unwrap_or(begin);
            return Err(Box::new(marked(text, at)));
        }
    }
}

/// Whether a number is so small that it would be read as 0.
fn vanishes(word: &str) -> bool {
    let mantissa = word.split(['e', 'E']).next().unwrap_or(word);
    word.contains(['e', 'E']) && mantissa.bytes().any(|c| matches!(c, b'1'..=b'9')) && word.parse::<f64>() == Ok(0.0)
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

/// What serde_yaml refuses although the guard let it pass.
fn translate(text: &str, error: &serde_yaml::Error) -> Vec<Fault> {
    let twice = Spans::new(text).twice;
    if !twice.is_empty() {
        // serde_yaml gives the place of the map, not of the key
        return twice
            .into_iter()
            .map(|(first, second, key)| {
                let mut fault = Fault::new("duplicate-key", String::new(), format!("`{key}` appears here twice"), "each key once")
                    .at(Spot::Bytes(second))
                    .help("rename or remove one of the two");
                fault.other = Some((first, "first here".to_owned()));
                fault
            })
            .collect();
    }
    let at = error.location().map_or(0, |place| {
        let start = text.split_inclusive('\n').take(place.line().saturating_sub(1)).map(str::len).sum::<usize>().min(text.len());
        start + byte_of(&text[start..], place.column().saturating_sub(1))
    });
    let digits = text[at..].chars().take_while(|c| c.is_ascii_digit() || *c == '-').count();
    if digits > MOST_DIGITS {
        return vec![
            Fault::new("bad-number", String::new(), "an integer of more than 19 digits", "a number such as `0.5`, `12` or `1e-3`")
                .at(Spot::Bytes(at..at + digits))
                .help("write it with an exponent"),
        ];
    }
    let message = error.to_string();
    let info = message.split(" at line").next().unwrap_or(&message);
    vec![syntax(text, info, at)]
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
