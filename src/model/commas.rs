//! Commas that YAML takes for the end of a value: in calls of functions, and in the place of a decimal point.

use super::fault::{Fault, Spot};
use serde_yaml::Value;
use std::ops::Range;

/// The sign of an expression that a comma has cut.
pub(super) fn open_parenthesis(value: &Value) -> bool {
    value.as_str().is_some_and(|text| balance(text) > 0)
}

fn balance(text: &str) -> i64 {
    text.bytes().map(|c| i64::from(c == b'(') - i64::from(c == b')')).sum()
}

/// The expression that was meant: pieces are joined until the parentheses close.
pub(super) fn rejoin<'v>(first: &Value, pieces: impl Iterator<Item = &'v Value>) -> Option<String> {
    let mut text = first.as_str()?.to_owned();
    for piece in pieces {
        text.push_str(", ");
        match piece {
            Value::String(s) => text.push_str(s),
            Value::Number(n) => text.push_str(&n.to_string()),
            _ => return None,
        }
        match balance(&text) {
            0 => return Some(text),
            n if n < 0 => return None,
            _ => {}
        }
    }
    None
}

pub(super) fn comma(place: String, joined: &str, key: Option<&str>) -> Fault {
    let repaired = match key {
        Some(key) => format!("write `{key}: \"{joined}\"`, or give it a line of its own"),
        None => format!("write \"{joined}\""),
    };
    Fault::new(
        "comma-in-braces",
        place,
        "inside of `{ }` and `[ ]` a comma ends the value",
        "an expression with commas in quotes or on its own line",
    )
    .help(repaired)
}

/// Whether a key closes a parenthesis that it has not opened: the rest of a call that a comma has cut.
pub(super) fn ends_a_call(key: &str) -> bool {
    balance(key) < 0
}

/// The fault at such a key, by the text around it.
pub(super) fn comma_before(text: &str, key: Range<usize>) -> Fault {
    let mut open = 0;
    let mut call = text[..key.end].char_indices().rev().filter_map(|(at, c)| {
        open += i64::from(c == '(') - i64::from(c == ')');
        (c == '(' && open >= 0).then_some(at)
    });
    let before = call.next().map_or("", |at| &text[..at]);
    let entry = before.rsplit(['{', ',', '\n']).next().and_then(|entry| entry.split_once(": "));
    let fault = match entry {
        Some((name, begin)) => {
            let value = &text[before.len() - begin.len()..];
            let ends = value.bytes().scan(0, |open, c| {
                *open += i64::from(c == b'(') - i64::from(c == b')');
                Some(c == b')' && *open == 0)
            });
            let length = ends.take_while(|end| !end).count() + 1;
            comma(String::new(), value[..length.min(value.len())].trim(), Some(name.trim()))
        }
        None => comma(String::new(), "", None).help("put the expression in quotes, or give it a line of its own"),
    };
    fault.at(Spot::Bytes(key))
}

/// The number with a decimal point that a comma has cut in a map in braces: `v: 3,5 m/s` is an entry 3 and a key `5 m/s` without a value.
pub(super) fn decimal(value: &Value, next: Option<(&Value, &Value)>) -> Option<String> {
    let (behind, Value::Null) = next? else { return None };
    let whole = match value {
        Value::Number(n) => n.to_string(),
        Value::String(text) => text.trim().to_owned(),
        _ => return None,
    };
    let behind = match behind {
        Value::Number(n) => n.to_string(),
        Value::String(text) => text.clone(),
        _ => return None,
    };
    let digits = whole.trim_start_matches(['~', '-']);
    let is_number = !digits.is_empty() && digits.bytes().all(|c| c.is_ascii_digit());
    (is_number && behind.starts_with(|c: char| c.is_ascii_digit())).then(|| format!("{whole}.{behind}"))
}
