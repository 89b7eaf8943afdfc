//! How set-up, steps and memory grow with the number of links: `cargo bench --bench growth` writes the section of docs/integrators.md and
//! its figures. Without `--bench` the smallest models are run once, and nothing is written.
//!
//! Each model runs in a process of its own, whose largest memory the system tells (Linux); times are the best of three processes.

#![allow(clippy::print_stdout, reason = "tables are what it is for")]

use grashof::model::{Control, Document, Forward, Kind, Selection};
use grashof::output::{Axis, Curve, Figure, Scale, render_figure};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::dynamics;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const BEGIN: &str = "<!-- begin: written by `cargo bench --bench growth` -->";
const END: &str = "<!-- end -->";
const SIZES: [usize; 6] = [10, 30, 100, 300, 1000, 3000];
/// Links from which on exponents are taken.
const LARGE: usize = 30;
const KINDS: [&str; 4] = ["row", "row in space", "chain", "chain in space"];
const SCHEMES: [&str; 2] = ["dop853", "bdf"];

/// What one process measured.
#[derive(Clone, Copy)]
struct Measured {
    /// From the text to the first step, s.
    setup: f64,
    /// A step and an evaluation, s.
    step: f64,
    evaluation: f64,
    /// Largest memory of the process, bytes.
    memory: f64,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    if let [kind, links, scheme] = &arguments[..] {
        let Measured { setup, step, evaluation, memory } = measured(kind, links.parse().unwrap_or(1), scheme);
        println!("{setup:e} {step:e} {evaluation:e} {memory:e}");
        return;
    }
    let timed = std::env::args().any(|a| a == "--bench");
    let sizes = if timed { &SIZES[..] } else { &SIZES[..1] };
    let mut text = String::new();
    let mut figures = Vec::new();
    for scheme in SCHEMES {
        let title = format!("Time of a step over the number of links, {scheme}");
        let _ = writeln!(text, "#### {scheme}\n\n![{title}](figures/integrators/growth-{scheme}.svg)\n");
        let mut curves = Vec::new();
        let _ = writeln!(text, "| | links | set-up | a step | an evaluation | memory for a body |\n|---|---:|---:|---:|---:|---:|");
        for kind in KINDS {
            let all: Vec<Measured> = sizes.iter().map(|&links| best(kind, links, scheme, if timed { 3 } else { 1 })).collect();
            for (&links, m) in sizes.iter().zip(&all) {
                // what the smallest one takes is the program's own
                let bodies = (bodies(kind, links) - bodies(kind, sizes[0])) as f64;
                let memory = if bodies > 0.0 { format!("{:.1} kB", (m.memory - all[0].memory) / bodies / 1e3) } else { "-".into() };
                let times = [m.setup, m.step, m.evaluation].map(readable);
                let _ = writeln!(text, "| {kind} | {links} | {} | {memory} |", times.join(" | "));
            }
            let exponents =
                [|m: &Measured| m.setup, |m: &Measured| m.step, |m: &Measured| m.evaluation].map(|of| exponent(sizes, &all, of));
            let _ = writeln!(text, "| {kind}, exponent from {LARGE} on | | {} | |", exponents.join(" | "));
            let points = sizes.iter().zip(&all).map(|(&n, m)| (n as f64, m.step)).collect();
            curves.push(Curve { label: kind.into(), unit: Some("s".into()), points, ..Curve::default() });
        }
        figures.push((scheme, title, curves));
        text.push('\n');
    }
    print!("{text}");
    if timed {
        write(&text, figures);
    }
}

/// The slope of logarithms between the first large size and the last.
fn exponent(sizes: &[usize], all: &[Measured], of: impl Fn(&Measured) -> f64) -> String {
    let known = sizes.iter().zip(all).filter(|(n, _)| **n >= LARGE);
    let known: Vec<(f64, f64)> = known.map(|(n, m)| ((*n as f64).ln(), of(m).ln())).collect();
    match known[..] {
        [(a, x), .., (b, y)] => format!("{:.2}", (y - x) / (b - a)),
        _ => "-".into(),
    }
}

/// The best times of some processes.
fn best(kind: &str, links: usize, scheme: &str, rounds: usize) -> Measured {
    let program = std::env::current_exe().unwrap_or_else(|e| panic!("{e}"));
    let one = || {
        let output = Command::new(&program).args([kind, &links.to_string(), scheme]).output().unwrap_or_else(|e| panic!("{e}"));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let numbers: Vec<f64> = said.split_whitespace().filter_map(|x| x.parse().ok()).collect();
        let [setup, step, evaluation, memory] = numbers[..] else {
            panic!("{kind} of {links}, {scheme}: {said}{}", String::from_utf8_lossy(&output.stderr))
        };
        Measured { setup, step, evaluation, memory }
    };
    (1..rounds).fold(one(), |best, _| {
        let next = one();
        Measured {
            setup: best.setup.min(next.setup),
            step: best.step.min(next.step),
            evaluation: best.evaluation.min(next.evaluation),
            memory: best.memory.min(next.memory),
        }
    })
}

/// Runs a model in this process.
fn measured(kind: &str, links: usize, scheme: &str) -> Measured {
    let begin = Instant::now();
    let text = model(kind, links, scheme);
    let selection = Selection { study: Some("it"), ..Selection::default() };
    let read = Document::read(&text, "growth").and_then(|d| d.model(&selection));
    let mut model = read.unwrap_or_else(|report| panic!("{}", report.render(false)));
    let study = model.study.clone().unwrap_or_else(|| panic!("no study"));
    let Kind::Dynamics(forward) = study.kind.clone() else { panic!("no motion in time") };
    let forward = Forward { control: Control::Tolerance(Some(model.pool.constant(1e-6))), ..forward };
    let values = parameters(&model);
    let (mut setup, mut from, mut steps) = (0.0, begin, 0.0);
    let mut timer = |on: bool| {
        if on {
            (setup, from) = (begin.elapsed().as_secs_f64(), Instant::now());
        } else {
            steps = from.elapsed().as_secs_f64();
        }
    };
    let run = dynamics::unrecorded(Case::new(&model, &study, &values), &forward, &mut timer);
    let counts = run.unwrap_or_else(|failure| panic!("{}", failure.reason())).counts;
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse::<f64>().ok());
    Measured {
        setup,
        step: steps / counts.steps.max(1) as f64,
        evaluation: steps / counts.evaluations.max(1) as f64,
        memory: 1024.0 * peak.unwrap_or(f64::NAN),
    }
}

/// Moving bodies of a model.
fn bodies(kind: &str, links: usize) -> usize {
    if kind.starts_with("row") { 2 * links + 1 } else { links }
}

/// N four-bars in a row, each of which has the second upright of the one before as its first; or a chain of N rods that falls from level.
fn model(kind: &str, n: usize, scheme: &str) -> String {
    let space = kind.ends_with("space");
    let (dimensions, zero, section) = if space { ("spatial", ", 0 m", ", width: 5 cm, height: 5 cm") } else { ("planar", "", "") };
    let axis = |i: usize| match (space, kind.starts_with("row") || i.is_multiple_of(2)) {
        (false, _) => "",
        (true, true) => ", axis: [0, 0, 1]",
        (true, false) => ", axis: [0, 1, 0]",
    };
    let mut out = format!("grashof: 1\nname: growth\nspace: {dimensions}\ngravity: [0, -9.81 m/s^2{}]\n", if space { ", 0" } else { "" });
    let each = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    if kind.starts_with("row") {
        let bar = format!("{{ bar: {{ length: 1 m, mass: 1 kg{section} }} }}");
        out += &format!("ground:\n{}", each(n + 1, &|i| format!("  G{i}: [{i} m, 0 m{zero}]\n")));
        out += &format!("bodies:\n{}", each(n + 1, &|i| format!("  v{i}: {bar}\n")));
        out += &each(n, &|i| format!("  h{i}: {bar}\n"));
        out += &format!("joints:\n{}", each(n + 1, &|i| format!("  A{i}: {{ revolute: [ground.G{i}, v{i}.start]{} }}\n", axis(i))));
        out += &each(n, &|i| {
            let axis = axis(i);
            let next = i + 1;
            format!("  B{i}: {{ revolute: [v{i}.end, h{i}.start]{axis} }}\n  C{i}: {{ revolute: [h{i}.end, v{next}.end]{axis} }}\n")
        });
        out += "start:\n  A0.angle: 90 deg\n  A0.omega: 1 rad/s\n";
        out += &each(n, &|i| format!("  A{}.angle: ~90 deg\n  B{i}.angle: ~-90 deg\n", i + 1));
        out += &format!("studies: {{ it: {{ dynamics: {{ until: 0.1 s, integrator: {scheme} }}, columns: [A0.angle] }} }}\n");
    } else {
        out += &format!("bodies:\n{}", each(n, &|i| format!("  b{i}: {{ bar: {{ length: 0.1 m, mass: 1 kg{section} }} }}\n")));
        out += &format!("joints:\n  J0: {{ revolute: [ground, b0.start]{} }}\n", axis(0));
        out += &(1..n).map(|i| format!("  J{i}: {{ revolute: [b{}.end, b{i}.start]{} }}\n", i - 1, axis(i))).collect::<String>();
        out += &format!("start:\n{}", each(n, &|i| format!("  J{i}.angle: 0 deg\n  J{i}.omega: 0 rad/s\n")));
        out += &format!("studies: {{ it: {{ dynamics: {{ until: 10 ms, integrator: {scheme} }}, columns: [J0.angle] }} }}\n");
    }
    out
}

/// Puts the tables between the marks of the document, and the figures beside it.
fn write(text: &str, figures: Vec<(&str, String, Vec<Curve>)>) {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let axis = |label: &str, unit: &str| Axis { label: label.into(), unit: unit.into(), scale: Scale::Log, ..Axis::default() };
    for (scheme, title, curves) in figures {
        let figure = Figure { title, x: axis("links", ""), y: axis("a step", "s"), curves, ..Figure::default() };
        let picture = render_figure(&figure).unwrap_or_else(|e| panic!("{e}"));
        std::fs::write(docs.join(format!("figures/integrators/growth-{scheme}.svg")), picture.svg).unwrap_or_else(|e| panic!("{e}"));
    }
    let path = docs.join("integrators.md");
    let old = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let Some(begin) = old.find(BEGIN) else { panic!("{} has no marks", path.display()) };
    let Some(end) = old[begin..].find(END) else { panic!("{} has no marks", path.display()) };
    let new = format!("{}{BEGIN}\n\n{}\n\n{}", &old[..begin], text.trim_end(), &old[begin + end..]);
    std::fs::write(&path, new).unwrap_or_else(|e| panic!("{e}"));
}

/// A time in a unit that fits.
fn readable(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.1} µs", s * 1e6),
        s if s < 1.0 => format!("{:.2} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}
