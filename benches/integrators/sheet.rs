//! The document of the measurements: tables between two marks of docs/integrators.md, and figures beside it.

use crate::cases::Sample;
use grashof::output::{Axis, Curve, Figure, Scale, render_figure};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const BEGIN: &str = "<!-- begin: written by `cargo bench --bench integrators` -->";
const END: &str = "<!-- end -->";

/// Text that is collected and printed.
#[derive(Default)]
pub(crate) struct Sheet {
    text: String,
    figures: Vec<(String, String)>,
}

/// One line of a work-precision diagram.
pub(crate) struct Series {
    pub(crate) name: &'static str,
    /// Tolerance or step as text, and what came of it.
    pub(crate) samples: Vec<(String, Sample)>,
}

impl Sheet {
    /// Adds a line, and prints it.
    pub(crate) fn line(&mut self, line: &str) {
        println!("{line}");
        let _ = writeln!(self.text, "{line}");
    }

    /// Adds a table.
    pub(crate) fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        self.line(&format!("| {} |", head.join(" | ")));
        self.line(&format!("|---|{}", "---:|".repeat(head.len() - 1)));
        for row in rows {
            self.line(&format!("| {} |", row.join(" | ")));
        }
        self.line("");
    }

    /// Adds the diagram of a case: seven lines can be told apart, and those of Newmark's family lie close to each other.
    pub(crate) fn diagram(&mut self, name: &str, title: &str, series: &[Series]) {
        let mut curves = Vec::new();
        for (unit, of) in [("s", 0), ("", 1)] {
            for s in series.iter().filter(|s| !["newmark", "hht", "ida"].contains(&s.name)) {
                let good = s.samples.iter().filter(|(_, sample)| sample.error > 0.0);
                let points = good.map(|(_, x)| (x.error, [x.time, x.bare.counts.evaluations as f64][of])).collect();
                curves.push(Curve { label: s.name.into(), unit: Some(unit.into()), points, ..Curve::default() });
            }
        }
        let axis = |label: &str| Axis { label: label.into(), scale: Scale::Log, ..Axis::default() };
        let quantities = vec![("s".into(), "time".into()), (String::new(), "evaluations".into())];
        let figure = Figure { title: title.into(), x: axis("error at the end"), y: axis(""), curves, quantities, ..Figure::default() };
        let picture = render_figure(&figure).unwrap_or_else(|e| panic!("{name}: {e}"));
        self.figures.push((name.into(), picture.svg));
        self.line(&format!("![{title}](figures/integrators/{name}.svg)\n"));
    }

    /// Puts the text between the marks of the document, and the figures into their directory.
    pub(crate) fn write(&self) {
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
        let path: PathBuf = docs.join("integrators.md");
        let old = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let (Some(begin), Some(end)) = (old.find(BEGIN), old.find(END)) else { panic!("{} has no marks", path.display()) };
        let new = format!("{}{BEGIN}\n\n{}\n{}", &old[..begin], self.text.trim_end(), &old[end..]);
        fs::write(&path, new.replace("\n<!-- end", "\n\n<!-- end")).unwrap_or_else(|e| panic!("{e}"));
        let figures = docs.join("figures/integrators");
        fs::create_dir_all(&figures).unwrap_or_else(|e| panic!("{e}"));
        for (name, svg) in &self.figures {
            fs::write(figures.join(format!("{name}.svg")), svg).unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

/// A time in a unit that fits.
pub(crate) fn readable(seconds: f64) -> String {
    match seconds {
        s if s.is_nan() => "-".into(),
        s if s < 1e-6 => format!("{:.0} ns", s * 1e9),
        s if s < 1e-3 => format!("{:.1} µs", s * 1e6),
        s if s < 1.0 => format!("{:.2} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}
