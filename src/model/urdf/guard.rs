//! What is refused before an XML parser sees the text: what could exhaust memory or the stack, and what is not URDF at all.

use crate::model::fault::{Fault, Spot};
use roxmltree::{Document, ParsingOptions};
use std::ops::Range;

/// Largest file, bytes.
const MOST_BYTES: usize = 16 << 20;
/// Deepest nesting of elements. `urdf-rs` parses by recursion and overflows the stack at some ten thousand.
const MOST_DEPTH: usize = 64;
/// Most nodes of a file.
const MOST_NODES: u32 = 2_000_000;

/// The XML tree of a text.
pub(super) fn tree(text: &str) -> Result<Document<'_>, Box<Fault>> {
    if text.len() > MOST_BYTES {
        // a larger one is not read to its end
        let message = format!("the file has more than {MOST_BYTES} bytes");
        let fault = Fault::new("file-too-large", String::new(), message, "at most 16 MiB");
        return Err(Box::new(fault.at(Spot::Nowhere)));
    }
    nesting(text)?;
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let at = offset(text, error.pos());
        let width = text[at..].chars().next().map_or(0, char::len_utf8);
        let message = error.to_string();
        let message = message.split(" at ").next().unwrap_or(&message);
        let fault = Fault::new("xml-syntax", String::new(), format!("this is not XML: {message}"), "XML with every element closed");
        Box::new(fault.at(Spot::Bytes(at..at + width)).help("look for a missing `>`, quote or closing element here or above"))
    })
}

/// Whether a file begins as a URDF does; if not, a model may name it by mistake or malice, and nothing of it is to be shown.
pub(crate) fn is_robot(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let mut rest = text.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
    while let Some((open, close)) = [("<?", "?>"), ("<!--", "-->")].into_iter().find(|(open, _)| rest.starts_with(open)) {
        let Some(end) = rest[open.len()..].find(close) else { return false };
        rest = rest[open.len() + end + close.len()..].trim_start();
    }
    rest.strip_prefix("<robot").is_some_and(|rest| rest.starts_with(|c: char| c.is_whitespace() || c == '>' || c == '/'))
}

/// The byte of a line and column, both counted from 1.
fn offset(text: &str, at: roxmltree::TextPos) -> usize {
    let line_start: usize = text.split_inclusive('\n').take(at.row.saturating_sub(1) as usize).map(str::len).sum();
    let line = &text[line_start..];
    line.char_indices().nth(at.col.saturating_sub(1) as usize).map_or(text.len(), |(i, _)| line_start + i)
}

/// One pass over the markup that counts open elements and refuses document types, which may define entities.
fn nesting(text: &str) -> Result<(), Box<Fault>> {
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(found) = text[at..].find('<') {
        let start = at + found;
        let rest = &text[start..];
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")].into_iter().find(|(open, _)| rest.starts_with(open));
        if let Some((open, close)) = skipped {
            // what is not closed is reported by the parser
            let Some(end) = rest[open.len()..].find(close) else { return Ok(()) };
            at = start + open.len() + end + close.len();
            continue;
        }
        if rest.starts_with("<!") {
            let fault = Fault::new("xml-doctype", String::new(), "a document type", "the element `<robot>`");
            return Err(Box::new(fault.at(Spot::Bytes(start..start + 2)).help("remove it: a URDF needs no entities")));
        }
        let end = tag_end(rest);
        if rest.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !rest[..end].ends_with("/>") {
            depth += 1;
            if depth > MOST_DEPTH {
                let message = format!("elements nested deeper than {MOST_DEPTH}");
                let fault = Fault::new("too-deep", String::new(), message, "a URDF, which needs about five levels");
                return Err(Box::new(fault.at(Spot::Bytes(start..start + end))));
            }
        }
        at = start + end;
    }
    Ok(())
}

/// Bytes of the tag that a text begins with, `>` included, past any `>` in quotes.
fn tag_end(text: &str) -> usize {
    let mut quote = None;
    for (i, c) in text.bytes().enumerate() {
        match (quote, c) {
            (None, b'"' | b'\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            (None, b'>') => return i + 1,
            _ => {}
        }
    }
    text.len()
}

/// Bytes of the opening tag of an element.
pub(super) fn opening(node: roxmltree::Node<'_, '_>) -> Range<usize> {
    let range = node.range();
    let text = node.document().input_text();
    range.start..range.start + tag_end(&text[range])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_is_known_by_its_root() {
        assert!(is_robot(b"\xef\xbb\xbf<?xml version='1.0'?>\n<!-- <a> -->\n<robot name='r'>") && is_robot(b"<robot>"));
        for text in ["root:x:0:0:<robot>", "<secret/><robot/>", "<robots>", "", "<?xml", "<!-- <robot>"] {
            assert!(!is_robot(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn depth_is_counted_past_quotes_and_comments() {
        let deep = |n: usize| format!("{}{}", "<a b='>'>".repeat(n), "</a>".repeat(n));
        assert!(tree(&deep(MOST_DEPTH)).is_ok());
        assert_eq!(tree(&deep(MOST_DEPTH + 1)).map_err(|fault| fault.code).err(), Some("too-deep"));
        assert_eq!(tree(&deep(50_000)).map_err(|fault| fault.code).err(), Some("too-deep"));
        assert!(tree(&format!("<a>{}</a>", "<!-- <a> -->".repeat(100))).is_ok());
        assert!(tree(&format!("<a>{}</a>", "<a/>".repeat(100))).is_ok());
        assert_eq!(tree("<!DOCTYPE a [<!ENTITY b 'c'>]><a/>").map_err(|fault| fault.code).err(), Some("xml-doctype"));
        assert_eq!(tree("<a>\n<b></a>").map_err(|fault| fault.code).err(), Some("xml-syntax"));
    }
}
