//! A study of many runs: a sweep, kept while it goes on.

use super::super::interrupt::{self, interrupted};
use super::super::kept::{Kept, gather};
use super::super::progress::Progress;
use super::super::shard::Shard;
use super::super::{code, print_error, print_note};
use super::{Finished, Job, Output, units, values};
use grashof::model::{ShownWhat, Study};
use grashof::output::{ReportRuns, ReportStudy, Staging, figures, files, run_files, summary, tables, write_json};
use grashof::results::{self, Results};
use grashof::studies::sweep::{self, Run, said_by, together};
use std::fs;
use std::path::{Path, PathBuf};

/// Most missing runs that are named.
const MOST_NAMED: usize = 12;

impl Job<'_> {
    /// Runs what is not known yet, and writes all.
    pub(super) fn sweep(&self, study: &Study) -> Finished {
        let count = sweep::grid(self.model, study).len();
        let (kept, known) = Kept::open(self.directory, self.study, self.model, count, self.common.force);
        let runs = self.computed(study, &kept, known, &|_| true);
        if interrupted() {
            kept.in_words(count).iter().for_each(|words| print_note(words));
            return Finished::nothing(code::INTERRUPTED);
        }
        let finished = self.finish_sweep(study, runs);
        if finished.ended {
            kept.remove();
        }
        finished
    }

    /// Runs what is not known yet of a shard, and keeps it.
    pub(super) fn shard(&self, study: &Study, shard: Shard) -> Finished {
        let count = sweep::grid(self.model, study).len();
        let (kept, known) = Kept::open(self.directory, &shard.stem(self.study), self.model, count, self.common.force);
        let own = (0..count).filter(|i| shard.has(*i)).count();
        self.computed(study, &kept, known, &|i| shard.has(i));
        if interrupted() {
            kept.in_words(own).iter().for_each(|words| print_note(words));
            return Finished::nothing(code::INTERRUPTED);
        }
        if !kept.end() {
            let what = format!("the runs of shard {shard} of study `{}` cannot be kept in {}", study.name, kept.path().display());
            print_error(&what, "give a directory that can be written, with `-o DIR`");
            return Finished::nothing(code::INPUT);
        }
        if !self.common.quiet {
            print_note(&format!(
                "shard {shard}: {own} of {count} runs are in {}; `grashof gather` writes the results",
                kept.path().display()
            ));
        }
        Finished::nothing(code::DONE)
    }

    /// Writes the results of the runs that shards have kept in the directory of the results and in others.
    pub(super) fn gathered(&self, study: &Study, others: &[PathBuf]) -> Finished {
        let count = sweep::grid(self.model, study).len();
        let mut known: Vec<Option<Run>> = Vec::new();
        known.resize_with(count, || None);
        let (mut whole, mut own) = (Vec::new(), Vec::new());
        for directory in std::iter::once(self.directory).chain(others.iter().map(PathBuf::as_path)) {
            for (path, shard) in shards(directory, self.study) {
                match gather(&path, self.model, &mut known) {
                    Ok(all) => {
                        whole.extend(all.then_some(shard));
                        own.extend((directory == self.directory).then_some(path));
                    }
                    Err(why) => print_note(&format!("note: {} {why}: it is not used", path.display())),
                }
            }
        }
        // what a shard tried and does not hold never began, and is tried again for its reason
        let missing: Vec<usize> = (0..count).filter(|&i| known[i].is_none() && !whole.iter().any(|shard| shard.has(i))).collect();
        if !missing.is_empty() {
            let numbers: Vec<String> = missing.iter().take(MOST_NAMED).map(|i| (i + 1).to_string()).collect();
            let more = if missing.len() > MOST_NAMED { format!(" and {} more", missing.len() - MOST_NAMED) } else { String::new() };
            print_error(
                &format!("study `{}` lacks {} of its {count} runs: {}{more}", study.name, missing.len(), numbers.join(", ")),
                "run the shards that are not there or not finished, as `--shard 2/8`, and name their directories with `--from`",
            );
            return Finished::nothing(code::INPUT);
        }
        let runs = sweep::sweep(self.model, study, self.settings(), known, &|_| true, &|_, _| {});
        if interrupted() {
            return Finished::nothing(code::INTERRUPTED);
        }
        let finished = self.finish_sweep(study, runs);
        if finished.ended {
            own.iter().for_each(|path| _ = fs::remove_file(path));
        }
        finished
    }

    /// The known runs and those that are wanted, which are kept one by one.
    fn computed(&self, study: &Study, kept: &Kept, known: Vec<Option<Run>>, wanted: &dyn Fn(usize) -> bool) -> Vec<Run> {
        let count = (0..known.len()).filter(|i| wanted(*i)).count();
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
        sweep::sweep(self.model, study, self.settings(), known, wanted, &done)
    }

    /// Judges and writes the runs of a sweep.
    fn finish_sweep(&self, study: &Study, runs: Vec<Run>) -> Finished {
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
            return Finished { ended: true, ..Finished::nothing(code::NUMERICAL) };
        }
        let mut code = code::DONE;
        if runs.iter().all(|r| r.result.as_ref().map_or(true, |o| o.stopped.is_some())) {
            let name = &study.name;
            print_error(&format!("no run of study `{name}` finished its range"), "see its last column for the reasons");
            code = code::NUMERICAL;
        }
        let mut staging = Staging::new();
        let mut computed = Vec::new();
        let mut first = None;
        let mut unwritten = None;
        let mut pages = self.report.then(|| ReportRuns::new(runs.len()));
        let (count, failed) = (runs.len(), runs.iter().filter(|run| run.result.is_err()).count());
        let mut missed = Missed::default();
        let results = together(self.model, study, runs, &mut |i, run| {
            missed.take(i, run);
            computed.push(values(run));
            unwritten = unwritten.max(self.add(&mut staging, run_files(self.study, i + 1, run, self.formats)).err());
            if let Some(pages) = &mut pages {
                pages.add(i, run);
            }
            if first.is_none() {
                first = Some(run.clone());
            }
            *run = remaining(study, std::mem::take(run));
        });
        for (place, message) in missed.in_words(&results.runs) {
            code = code.max(self.unmet(&place, message));
        }
        if failed > 0 && !study.expect.is_empty() {
            print_note(&format!(
                "note: {failed} of the {count} runs of study `{}` failed; what the file expects is not judged there",
                study.name
            ));
        }
        unwritten = unwritten.max(self.add(&mut staging, tables(self.study, &results.table, self.formats)).err());
        if let Some(unwritten) = unwritten {
            return Finished::nothing(code.max(unwritten));
        }
        files(self.study, &results).into_iter().for_each(|(name, bytes)| staging.add(name, bytes));
        if let (true, Some(first)) = (self.plots, &first) {
            self.draw(&mut staging, figures(&results), first);
        }
        let page = pages.map(|pages| ReportStudy::of_runs(&results, &study.about, pages));
        let output = Output { table: summary(&results), report: write_json(&results), columns: units(&results), page };
        let finished = self.write(&staging, code, output);
        Finished { computed, ended: finished.output.is_some(), ..finished }
    }
}

/// Expectations that runs of a sweep do not meet: for each of them its place, the first such run with what it says, and how many there are.
#[derive(Default)]
struct Missed(Vec<(String, usize, String, usize)>);

impl Missed {
    /// Takes those of run `i`, counted from 0.
    fn take(&mut self, i: usize, run: &Results) {
        for e in run.expectations.iter().filter(|e| !e.met) {
            match self.0.iter_mut().find(|(place, ..)| *place == e.place) {
                Some((.., count)) => *count += 1,
                None => self.0.push((e.place.clone(), i, e.message.clone(), 1)),
            }
        }
    }

    /// Place and message of each.
    fn in_words(self, runs: &[results::Run]) -> impl Iterator<Item = (String, String)> {
        let told = move |(place, i, message, count): (String, usize, String, usize)| {
            let message = said_by([count, runs.len()], i, &runs[i].label, &message);
            (place, message)
        };
        self.0.into_iter().map(told)
    }
}

/// What is still asked of a run whose files are made: curves for figures, and what the kind gives beside numbers.
fn remaining(study: &Study, run: Results) -> Results {
    let curves = study.plots.iter().any(|plot| plot.all().any(|shown| matches!(shown.what, ShownWhat::Column(_))));
    let Results { stopped, lists, shapes, linear, independent, table, curves: extra, .. } = run;
    let kept = Results { stopped, lists, shapes, linear, ..Results::default() };
    if curves { Results { independent, table, curves: extra, ..kept } } else { kept }
}

/// Files of the shards of a study in a directory, by their names.
fn shards(directory: &Path, stem: &str) -> Vec<(PathBuf, Shard)> {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    let mut found: Vec<(PathBuf, Shard)> =
        entries.filter_map(|entry| Some((entry.path(), Shard::of_file(entry.file_name().to_str()?, stem)?))).collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}
