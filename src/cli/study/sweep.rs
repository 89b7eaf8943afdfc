//! A study of many runs: a sweep, kept while it goes on.

use super::super::interrupt::{self, interrupted};
use super::super::kept::Kept;
use super::super::progress::Progress;
use super::super::{code, print_error, print_note};
use super::{Finished, Job, Output, units, values};
use grashof::model::Study;
use grashof::output::{Staging, figures, files, summary, write_json};
use grashof::results::Results;
use grashof::studies::sweep::{self, Run, together};

impl Job<'_> {
    /// Runs what is not known yet, and writes all.
    pub(super) fn sweep(&self, study: &Study) -> Finished {
        let count = sweep::grid(self.model, study).len();
        let (kept, known) = Kept::open(self.directory, self.study, self.model, count, self.common.force);
        let there = known.iter().flatten().count();
        if !self.common.quiet {
            if let Some(note) = kept.note() {
                print_note(note);
            }
            if there > 0 {
                print_note(&format!("resumed: {there} of {count} runs were there"));
            }
        }
        let progress = Progress::new(self.study, count, self.common.quiet);
        (0..there).for_each(|_| progress.step());
        let done = |i: usize, run: &Run| {
            // a run that was interrupted on its way is not finished
            if !interrupted() || run.result.as_ref().is_ok_and(|o| o.stopped.is_none()) {
                kept.add(i, run);
            }
            if let Some(words) = kept.in_words(count) {
                interrupt::begins(format!("{words}\ninterrupted: study `{}` is not written", study.name), false);
            }
            progress.step();
        };
        let runs = sweep::sweep(self.model, study, self.common.threads(), known, &interrupted, &done);
        drop(progress);
        if interrupted() {
            kept.in_words(count).iter().for_each(|words| print_note(words));
            return Finished::nothing(code::INTERRUPTED);
        }
        self.finish_sweep(study, &runs, kept)
    }

    /// Judges and writes the runs of a sweep.
    fn finish_sweep(&self, study: &Study, runs: &[Run], kept: Kept) -> Finished {
        // rows that failed for a stated reason are results, unless there is no other
        if runs.iter().all(|r| r.result.is_err()) {
            if let Some(Err(failure)) = runs.first().map(|r| &r.result) {
                self.explain(failure);
            }
            let (count, name) = (runs.len(), &study.name);
            let (what, help) = match count {
                1 => (format!("the one run of study `{name}` did not begin"), "see the reason above"),
                _ => (format!("none of the {count} runs of study `{name}` began"), "see the first reason above"),
            };
            print_error(&what, help);
            kept.remove();
            return Finished::nothing(code::NUMERICAL);
        }
        let mut code = code::DONE;
        if runs.iter().all(|r| r.result.as_ref().map_or(true, |o| o.stopped.is_some())) {
            let name = &study.name;
            print_error(&format!("no run of study `{name}` finished its range"), "see its last column for the reasons");
            code = code::NUMERICAL;
        }
        let results = together(self.model, study, runs);
        let whole = || results.runs.iter().filter_map(|run| run.results.as_ref());
        for run in whole() {
            code = code.max(self.expectations(run));
        }
        let (staging, output) = self.staged(&results);
        let finished = self.write(&staging, code, output);
        if finished.output.is_some() {
            kept.remove();
        }
        Finished { computed: whole().map(values).collect(), ..finished }
    }

    /// The files of a sweep.
    fn staged(&self, results: &Results) -> (Staging, Output) {
        let mut staging = Staging::new();
        files(self.study, results).into_iter().for_each(|(name, bytes)| staging.add(name, bytes));
        let first = results.runs.iter().find_map(|run| run.results.as_ref());
        if let (true, Some(first)) = (self.plots, first) {
            self.draw(&mut staging, figures(results), first);
        }
        (staging, Output { table: summary(results), report: write_json(results), columns: units(results) })
    }
}
