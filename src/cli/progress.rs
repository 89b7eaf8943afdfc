//! Progress on stderr of what takes over half a second.

use super::terminal::escaped;
use grashof::output::RowFiles;
use grashof::results::{Column, Sink};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What is over sooner shows nothing.
const SOON: Duration = Duration::from_millis(500);
/// Parts that a motion is counted in.
const PARTS: u64 = 1000;

/// A bar that shows itself when the work has taken half a second, on a terminal alone.
pub(super) struct Progress {
    bar: ProgressBar,
    begun: Instant,
    wanted: bool,
    shown: AtomicBool,
}

impl Progress {
    /// A bar over `steps` steps of a study.
    pub(super) fn new(study: &str, steps: usize, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}") {
            bar.set_style(style);
        }
        bar.set_message(study.to_string());
        Self { bar, begun: Instant::now(), wanted: !quiet && std::io::stderr().is_terminal(), shown: AtomicBool::new(false) }
    }

    /// A count of steps whose number is not known.
    pub(super) fn open(study: &str, quiet: bool) -> Self {
        let progress = Self::new(study, 0, quiet);
        progress.bar.unset_length();
        if let Ok(style) = ProgressStyle::with_template("{prefix} {spinner} run {pos} {wide_msg}") {
            progress.bar.set_style(style);
        }
        progress.bar.set_prefix(study.to_string());
        progress.bar.set_message(String::new());
        progress
    }

    /// A line for a single run: that it is set up, then how far it has come and how long the rest will take.
    pub(super) fn of_run(study: &str, quiet: bool) -> Self {
        let wanted = !quiet && std::io::stderr().is_terminal();
        let target = if wanted { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{line}") {
            let study = escaped(study).into_owned();
            bar.set_style(style.with_key("line", move |state: &ProgressState, out: &mut dyn Write| {
                // a line that cannot be made shows nothing
                let _ = line(&study, state.elapsed(), state.len().map(|_| state.pos()), out);
            }));
        }
        if wanted {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Self { bar, begun: Instant::now(), wanted, shown: AtomicBool::new(wanted) }
    }

    /// The part of a run that is done, 0 to 1.
    fn reach(&self, part: f64) {
        let part = (part.clamp(0.0, 1.0) * PARTS as f64) as u64;
        if self.bar.position() != part {
            self.bar.set_length(PARTS);
            self.bar.set_position(part);
        }
    }

    /// One step is done, and what came of it.
    pub(super) fn show(&self, what: &str) {
        self.bar.set_message(escaped(what).into_owned());
        self.step();
    }

    /// One step is done.
    pub(super) fn step(&self) {
        let late = self.begun.elapsed() > SOON;
        if self.wanted && late && !self.shown.swap(true, Ordering::Relaxed) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The line of a single run after `elapsed`, of which so many [`PARTS`] are done.
fn line(study: &str, elapsed: Duration, done: Option<u64>, out: &mut dyn Write) -> std::fmt::Result {
    let seconds = elapsed.as_secs_f64();
    match done {
        _ if elapsed < SOON => Ok(()),
        None | Some(0) => write!(out, "{study}: setting up, {seconds:.0} s"),
        Some(done) => {
            let part = done as f64 / PARTS as f64;
            write!(out, "{study}: {:.0} %, {:.0} s left", 100.0 * part, seconds * (1.0 - part) / part)
        }
    }
}

/// Rows on their way to their files, which tell how far a motion has come.
pub(super) struct Counted<'p> {
    /// Where they go.
    pub(super) rows: &'p RowFiles,
    /// What shows it.
    pub(super) progress: &'p Progress,
    /// The end of the motion, if it is known, s.
    pub(super) until: Option<f64>,
}

impl Sink for Counted<'_> {
    fn begin(&self, independent: &Column, columns: &[Column]) {
        self.rows.begin(independent, columns);
    }

    fn row(&self, place: f64, values: &[f64]) {
        if let Some(until) = self.until {
            self.progress.reach(place / until);
        }
        self.rows.row(place, values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_tells_what_it_does_and_how_long_it_takes() {
        let shown = |seconds: f64, done| {
            let mut out = String::new();
            line("fall", Duration::from_secs_f64(seconds), done, &mut out).unwrap();
            out
        };
        assert_eq!(shown(0.4, Some(500)), "");
        assert_eq!(shown(2.0, None), "fall: setting up, 2 s");
        assert_eq!(shown(3.0, Some(250)), "fall: 25 %, 9 s left");
    }
}
