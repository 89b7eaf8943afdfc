//! A progress bar on stderr for what takes over half a second.

use super::terminal::escaped;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

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

    /// One step is done, and what came of it.
    pub(super) fn show(&self, what: &str) {
        self.bar.set_message(escaped(what).into_owned());
        self.step();
    }

    /// One step is done.
    pub(super) fn step(&self) {
        let late = self.begun.elapsed() > Duration::from_millis(500);
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
