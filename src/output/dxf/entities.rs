//! Lines, arcs and text of a DXF file, and the file around them: pairs of a code and a value, each on a line of its own.

use crate::output::thin::Point;
use std::fmt::{Display, Write};

/// What a part of the drawing is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Layer {
    Ground,
    Bodies,
    Joints,
    Links,
    Gears,
    Paths,
    Names,
}

/// Layers with their names and colours, numbers of the fixed palette.
const LAYERS: [(Layer, &str, u8); 7] = [
    (Layer::Ground, "GROUND", 8),
    (Layer::Bodies, "BODIES", 7),
    (Layer::Joints, "JOINTS", 5),
    (Layer::Links, "LINKS", 30),
    (Layer::Gears, "GEARS", 3),
    (Layer::Paths, "PATHS", 1),
    (Layer::Names, "NAMES", 7),
];

/// The parts of a drawing, mm.
#[derive(Clone, Debug, Default)]
pub(super) struct Entities {
    text: String,
    /// The smallest box around all: left and bottom, right and top.
    extent: Option<[Point; 2]>,
}

impl Entities {
    /// A line of several points.
    pub(super) fn path(&mut self, layer: Layer, points: &[Point], closed: bool) {
        if !points.iter().flatten().all(|x| x.is_finite()) {
            return;
        }
        match points {
            [] | [_] => {}
            [a, b] => {
                self.begin("LINE", layer);
                self.point(10, *a);
                self.point(11, *b);
            }
            _ => {
                self.begin("POLYLINE", layer);
                pair(&mut self.text, 66, 1);
                self.text.push_str(" 10\n0.0\n 20\n0.0\n 30\n0.0\n");
                pair(&mut self.text, 70, u8::from(closed));
                for at in points {
                    self.begin("VERTEX", layer);
                    self.point(10, *at);
                }
                self.begin("SEQEND", layer);
            }
        }
    }

    pub(super) fn circle(&mut self, layer: Layer, at: Point, radius: f64) {
        if radius.is_finite() && radius > 0.0 {
            self.begin("CIRCLE", layer);
            self.point(10, at);
            pair(&mut self.text, 40, Number(radius));
        }
    }

    /// An arc from one angle to another, degrees, counter-clockwise.
    pub(super) fn arc(&mut self, layer: Layer, at: Point, radius: f64, ends: [f64; 2]) {
        let [from, to] = ends.map(|angle| angle.rem_euclid(360.0));
        self.begin("ARC", layer);
        self.point(10, at);
        pair(&mut self.text, 40, Number(radius));
        pair(&mut self.text, 50, Number(from));
        pair(&mut self.text, 51, Number(to));
    }

    pub(super) fn text(&mut self, layer: Layer, at: Point, height: f64, text: &str) {
        if text.is_empty() {
            return;
        }
        self.begin("TEXT", layer);
        self.point(10, at);
        pair(&mut self.text, 40, Number(height));
        let mut plain = String::new();
        for c in text.chars() {
            match c {
                ' '..='~' => plain.push(c),
                c if c.is_control() => plain.push(' '),
                c => _ = write!(plain, "\\U+{:04X}", u32::from(c)),
            }
        }
        pair(&mut self.text, 1, plain);
    }

    fn begin(&mut self, kind: &str, layer: Layer) {
        pair(&mut self.text, 0, kind);
        pair(&mut self.text, 8, LAYERS[layer as usize].1);
    }

    fn point(&mut self, code: u8, [x, y]: Point) {
        pair(&mut self.text, code, Number(x));
        pair(&mut self.text, code + 10, Number(y));
        pair(&mut self.text, code + 20, Number(0.0));
        let [low, high] = self.extent.get_or_insert([[x, y], [x, y]]);
        *low = [low[0].min(x), low[1].min(y)];
        *high = [high[0].max(x), high[1].max(y)];
    }

    /// The whole file.
    pub(super) fn file(self) -> String {
        let mut out = String::new();
        section(&mut out, "HEADER", |out| {
            pair(out, 9, "$ACADVER");
            pair(out, 1, "AC1009");
            let [low, high] = self.extent.unwrap_or_default();
            for (name, [x, y]) in [("$EXTMIN", low), ("$EXTMAX", high)] {
                pair(out, 9, name);
                pair(out, 10, Number(x));
                pair(out, 20, Number(y));
                pair(out, 30, Number(0.0));
            }
        });
        section(&mut out, "TABLES", tables);
        section(&mut out, "ENTITIES", |out| out.push_str(&self.text));
        pair(&mut out, 0, "EOF");
        out
    }
}

fn section(out: &mut String, name: &str, fill: impl FnOnce(&mut String)) {
    pair(out, 0, "SECTION");
    pair(out, 2, name);
    fill(out);
    pair(out, 0, "ENDSEC");
}

/// The tables that drawings need: one kind of line, the layers.
fn tables(out: &mut String) {
    let mut table = |name: &str, count: usize, fill: &dyn Fn(&mut String)| {
        pair(out, 0, "TABLE");
        pair(out, 2, name);
        pair(out, 70, count);
        fill(out);
        pair(out, 0, "ENDTAB");
    };
    table("LTYPE", 1, &|out| {
        for (code, value) in [(0, "LTYPE"), (2, "CONTINUOUS"), (70, "0"), (3, "Solid line"), (72, "65"), (73, "0"), (40, "0.0")] {
            pair(out, code, value);
        }
    });
    table("LAYER", LAYERS.len(), &|out| {
        for (_, name, color) in LAYERS {
            pair(out, 0, "LAYER");
            pair(out, 2, name);
            pair(out, 70, 0);
            pair(out, 62, color);
            pair(out, 6, "CONTINUOUS");
        }
    });
}

/// A code, and its value on the next line.
fn pair(out: &mut String, code: u8, value: impl Display) {
    let _ = writeln!(out, "{code:>3}\n{value}");
}

/// A length or angle to a millionth.
struct Number(f64);

impl Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // no negative zero
        let x = (self.0 * 1e6).round() / 1e6 + 0.0;
        write!(f, "{x:.6}")
    }
}
