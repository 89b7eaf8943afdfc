//! A display list as SVG.
//!
//! Written directly: plotters' SVG has whole coordinates only, no dashes, no halo, and sets text by other measures than its
//! bitmaps.

use super::scene::{Anchor, Color, Item, Scene, Stroke, Text};
use super::thin::Point;
use std::fmt::Write;

/// DejaVu's close relatives come next: their letters have the same widths.
const FAMILY: &str = "'DejaVu Sans', 'Bitstream Vera Sans', Verdana, sans-serif";

/// The text of an SVG file.
pub(super) fn write_svg(scene: &Scene) -> String {
    let mut out = head([scene.width, scene.height], scene);
    scene.items.iter().for_each(|item| write_item(&mut out, item, ""));
    out.push_str("</svg>\n");
    out
}

/// What a file begins with, up to the white of the paper; it is shown in a size, pixels.
pub(super) fn head(shown: [f64; 2], scene: &Scene) -> String {
    let ([wide, high], [width, height]) = (shown.map(short), [scene.width, scene.height].map(short));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}\" height=\"{high}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{FAMILY}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>{}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        escaped(&scene.title)
    )
}

/// The element of an item, with elements that stand `within` it.
pub(super) fn write_item(out: &mut String, item: &Item, within: &str) {
    match item {
        Item::Path { points, closed, fill, stroke } => {
            let element = if *closed { "polygon" } else { "polyline" };
            let _ = write!(out, "<{element} points=\"{}\"{}{}", pairs(points), filled(*fill), stroked(*stroke));
            close(out, element, within);
        }
        Item::Circle { at: [x, y], radius, fill, stroke } => {
            let (x, y, radius) = (short(*x), short(*y), short(*radius));
            let _ = write!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"{}{}", filled(*fill), stroked(*stroke));
            close(out, "circle", within);
        }
        Item::Veil { points, color, opacity } => {
            let _ = write!(out, "<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{}\"", pairs(points), hex(*color), short(*opacity));
            close(out, "polygon", within);
        }
        Item::Text(text) => write_text(out, text),
    }
}

fn close(out: &mut String, element: &str, within: &str) {
    let _ = if within.is_empty() { writeln!(out, "/>") } else { writeln!(out, ">{within}</{element}>") };
}

/// Points as the attribute `points` has them.
pub(super) fn pairs(points: &[Point]) -> String {
    let pair = |[x, y]: &Point| format!("{},{}", short(*x), short(*y));
    points.iter().map(pair).collect::<Vec<_>>().join(" ")
}

fn write_text(out: &mut String, text: &Text) {
    let ([x, y], words) = (text.at, escaped(&text.text));
    let (x, y) = (short(x), short(y));
    let anchor = match text.anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let turned = if text.upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
    let place = format!("x=\"{x}\" y=\"{y}\" font-size=\"{}\"{anchor}{turned}", short(text.size));
    if text.halo {
        // A second element under the letters: `paint-order` is not known to all readers.
        let width = short(text.size * 0.28);
        let _ =
            writeln!(out, "<text {place} fill=\"#ffffff\" stroke=\"#ffffff\" stroke-width=\"{width}\" aria-hidden=\"true\">{words}</text>");
    }
    let _ = writeln!(out, "<text {place} fill=\"{}\">{words}</text>", hex(text.color));
}

fn filled(fill: Option<Color>) -> String {
    format!(" fill=\"{}\"", fill.map_or("none".into(), hex))
}

fn stroked(stroke: Option<Stroke>) -> String {
    let Some(stroke) = stroke else { return String::new() };
    let mut text = format!(" stroke=\"{}\" stroke-width=\"{}\"", hex(stroke.color), short(stroke.width));
    if !stroke.dash.is_empty() {
        let lengths: Vec<_> = stroke.dash.iter().map(|length| short(*length)).collect();
        // Round ends would close the gaps of short dashes.
        let _ = write!(text, " stroke-dasharray=\"{}\" stroke-linecap=\"butt\"", lengths.join(" "));
    }
    text
}

pub(super) fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A hundredth of a pixel is more than enough.
pub(super) fn short(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML has no place for control characters, not even escaped.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_numbers_are_short() {
        let mut scene = Scene { width: 100.0, height: 50.0, title: "a < b & \"c\"".into(), items: vec![] };
        scene.text([1.0 / 3.0, -0.001], "x\u{0}<y", 12.0, Anchor::Middle);
        scene.veil(vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]], [0, 0, 255], 0.4);
        let svg = write_svg(&scene);
        assert!(svg.contains("<polygon points=\"0,0 1,0 0,1\" fill=\"#0000ff\" fill-opacity=\"0.4\"/>"), "{svg}");
        assert!(svg.contains("<title>a &lt; b &amp; &quot;c&quot;</title>"));
        assert!(svg.contains("x=\"0.33\" y=\"0\" font-size=\"12\" text-anchor=\"middle\""));
        assert!(svg.contains(">x &lt;y</text>"));
    }
}
