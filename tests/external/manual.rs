//! `docs/verification.md` and its pictures, written from what the comparisons found.

use super::cases::{Comparison, manifest, root};
use grashof::output::{Axis, Curve, Figure, render_figure};
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

pub(crate) fn page() -> PathBuf {
    root().join("docs/verification.md")
}

pub(crate) fn figures() -> PathBuf {
    root().join("docs/figures/verification")
}

/// A picture is worth drawing from this many rows on; shorter results are told by numbers alone.
const ROWS: usize = 3;

pub(crate) fn has_picture(comparison: &Comparison) -> bool {
    comparison.rows >= ROWS
}

/// The worst column of both over the key, and below it their difference in millionths of the largest value.
fn figure(comparison: &Comparison) -> Figure {
    let Comparison { case, points, ours, right, .. } = comparison;
    let column = &case.columns[comparison.worst];
    // a crank may turn backwards
    let (first, last) = points.iter().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p[0]), b.max(p[0])));
    let shown = |key: f64| key >= first - 1e-9 && key <= last + 1e-9;
    // a quaternion may change its sign between rows, so only the rows that are compared can be drawn
    let mine = ours.index(&column.ours);
    let dense = ours.rows.iter().filter(|row| shown(row[0])).map(|row| (row[0], row[mine] * column.factor + column.offset));
    let found: Vec<(f64, f64)> = if column.name.contains(".Q[") { points.iter().map(|p| (p[0], p[1])).collect() } else { dense.collect() };
    // where the reference is much coarser than the motion, a line through it would be wrong: dots
    let sparse = found.len() > 3 * points.len();
    let gap = |x: f64| if sparse { vec![(x, f64::NAN)] } else { Vec::new() };
    let given = points.iter().flat_map(|p| [vec![(p[0], p[2])], gap(p[0])].concat()).collect();
    let scale = if comparison.size > 1e-9 { comparison.size } else { 1.0 };
    let apart = points.iter().map(|p| (p[0], 1e6 * (p[1] - p[2]) / scale)).collect();
    let curve = |label: &str, unit: Option<&str>, points| Curve {
        label: label.to_owned(),
        unit: unit.map(str::to_owned),
        points,
        ..Curve::default()
    };
    Figure {
        title: format!("{}: {}", case.id, column.name),
        x: Axis { label: right.names[0].clone(), ..Axis::default() },
        curves: vec![curve("grashof", None, found), curve("reference", None, given), curve("difference", Some("ppm"), apart)],
        quantities: vec![(String::new(), column.name.clone())],
        ..Figure::default()
    }
}

/// `1.23e-4`.
fn short(x: f64) -> String {
    format!("{x:.1e}")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn summary(all: &[&Comparison]) -> String {
    let mut text = String::new();
    let suites = manifest()["suites"].as_object().unwrap().clone();
    text.push_str("| suite | cases | fewest digits | source | licence |\n|---|---:|---:|---|---|\n");
    for (name, about) in &suites {
        let of: Vec<_> = all.iter().filter(|c| &c.case.suite == name).collect();
        let least = of.iter().map(|c| c.digits.max(c.by_hand.unwrap_or(0.0))).fold(16.0, f64::min);
        let word = |key: &str| about[key].as_str().unwrap_or_default().to_owned();
        writeln!(text, "| {name} | {} | {least:.1} | {} | {} |", of.len(), word("source"), word("licence")).unwrap();
    }
    text
}

fn section(comparison: &Comparison) -> String {
    let Comparison { case, rows, digits, off, size, right, .. } = comparison;
    let worst = &case.columns[comparison.worst];
    let model = case.model.strip_prefix(root()).unwrap().display();
    let names = case.columns.iter().map(|c| format!("`{}`", c.name)).collect::<Vec<_>>().join(", ");
    let mut text = format!("\n### {}\n\n{}. Model: [`{model}`](../{model}), study `{}`.\n\n", case.id, capital(&case.what), case.study);
    writeln!(text, "- Source: {}", right.comment).unwrap();
    writeln!(text, "- Compared: {names}; {rows} {}", if *rows == 1 { "row" } else { "rows" }).unwrap();
    writeln!(text, "- Digits reached: {digits:.1}; worst `{}`, off by {} of {}", worst.name, short(*off), short(*size)).unwrap();
    writeln!(text, "- Digits of the reference: {}", case.digits).unwrap();
    if let (Some(ours), Some(theirs)) = (comparison.by_hand, comparison.reference_by_hand) {
        writeln!(
            text,
            "- By an integration of equations written by hand (`tests/external/hand_equations.py`) the published result has {theirs:.1} \
             digits, and the program's {ours:.1}"
        )
        .unwrap();
    }
    if !case.note.is_empty() {
        writeln!(text, "- {}", case.note).unwrap();
    }
    if has_picture(comparison) {
        write!(text, "\n![{}]({})\n", worst.name, format_args!("figures/verification/{}.svg", case.id)).unwrap();
    }
    text
}

const HEAD: &str = "# Verification

Mechanisms whose motion, forces or rest were published by others, or computed by independent programs with more digits than a double holds: what the program gives beside what is right. Written by `GRASHOF_BLESS=1 cargo test --test all external`; the same test, without the word before it, runs all cases again and fails where one has fewer digits than it must have, or this page states more than there are.

## How it is measured

- The model files are written from the sources of the other programs, or from the definition of the problem; they lie in `tests/external/models` and `models`. The references lie in `tests/external/refs`, one table each, with its source in the first line. `tests/external/cases.json` says which column is compared with which, and how many digits must agree.
- **Digits** are those of the largest difference over all rows: minus the decimal logarithm of that difference by the largest value of the column, or of the vector that the column belongs to. The worst column counts. Columns that are zero throughout are measured absolutely. Sixteen is the most a double can show.
- **Digits of the reference** are what its source says of it: a tolerance, a step, printed digits, or the digits to which two independent computations agree. A reference by a solver at a tolerance of 1e-6 seldom has more than five digits, and in chaotic motions fewer: what is missing there is missing in the reference.
- Where a published result is so loose that it could hide a fault, equations written by hand were integrated by extrapolation (`tests/external/hand_equations.py`), and both are compared with that.
- **Pictures** show the worst column: the program and the reference above; below, their difference in millionths (ppm) of the column's largest value.
- Left out: the slider-crank of the Test Set with its flexible rod, and a skate on a slope, whose constraint is one of velocities alone: there are neither flexible bodies nor such constraints yet. The crank-rocker and the quick return have tests of their own (`tests/assignment.rs`, `tests/quick_return.rs`).

## What agrees

";

/// The page and the pictures, as text.
pub(crate) fn written(all: &[&Comparison]) -> String {
    let mut text = HEAD.to_owned();
    text.push_str(&summary(all));
    text.push_str("\n| case | what | digits | of the reference | worst column |\n|---|---|---:|---|---|\n");
    for c in all {
        let hand = c.by_hand.map_or_else(String::new, |d| format!(" ({d:.1} by hand)"));
        let worst = &c.case.columns[c.worst].name;
        writeln!(
            text,
            "| [{0}](#{1}) | {2} | {3:.1}{hand} | {4} | `{worst}` |",
            c.case.id,
            c.case.id.to_lowercase(),
            c.case.what,
            c.digits,
            c.case.digits
        )
        .unwrap();
    }
    let mut suite = "";
    for c in all {
        if suite != c.case.suite {
            suite = &c.case.suite;
            write!(text, "\n## {suite}\n").unwrap();
        }
        text.push_str(&section(c));
    }
    text
}

/// Writes the page and its pictures anew.
pub(crate) fn write(all: &[&Comparison]) {
    let _ = fs::remove_dir_all(figures());
    fs::create_dir_all(figures()).unwrap();
    for c in all.iter().filter(|c| has_picture(c)) {
        let picture = render_figure(&figure(c)).expect("a picture");
        fs::write(figures().join(format!("{}.svg", c.case.id)), picture.svg).unwrap();
        if let Some(directory) = std::env::var_os("GRASHOF_PNG") {
            fs::write(PathBuf::from(directory).join(format!("{}.png", c.case.id)), picture.png).unwrap();
        }
    }
    fs::write(page(), written(all)).unwrap();
}

/// Cases of the page's table with the digits that it states.
pub(crate) fn stated() -> Vec<(String, f64)> {
    let text = fs::read_to_string(page()).expect("the page is there");
    let row = |line: &str| {
        let name = line.strip_prefix("| [")?.split(']').next()?.to_owned();
        let digits = line.split('|').nth(3)?.split_whitespace().next()?.parse().ok()?;
        Some((name, digits))
    };
    text.lines().filter_map(row).collect()
}
