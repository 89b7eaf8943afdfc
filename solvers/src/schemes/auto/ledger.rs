//! What a second of motion costs under either scheme, in counted work.

use crate::engine::{Counts, Engine};

/// Work of a tangent, in evaluations.
const TANGENT: usize = 4;

/// Work of an explicit step: thirteen evaluations and as many factorisations.
const EXPLICIT: f64 = 26.0;

/// Steps of a beginning that are not judged, and steps of a judgement.
const BEGINNING: usize = 6;
const JUDGED: usize = 10;

/// Explicit steps near the border of stability before the first trial of the other scheme.
const PATIENCE: usize = 40;
const LONGEST: usize = 20_000;

/// A change must promise this part of the work at least.
const WORTH: f64 = 0.8;

/// Judgements in a row that end the implicit scheme.
const AGREED: usize = 3;

/// Whether the implicit scheme goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It goes on.
    Stay,
    /// The explicit scheme takes over.
    Leave,
}

/// The accounts of a run.
#[derive(Clone, Debug)]
pub(super) struct Ledger {
    /// Steps since the scheme began or was judged last.
    steps: usize,
    /// Whether the beginning is over.
    begun: bool,
    /// Work and time at the begin of the account.
    mark: (usize, f64),
    /// Work a second of the explicit scheme, when it was left.
    explicit: f64,
    /// Whether the implicit scheme is on trial.
    trial: bool,
    patience: usize,
    /// Explicit steps near the border.
    bound: usize,
    /// Judgements in a row for the explicit scheme.
    against: usize,
}

impl Default for Ledger {
    fn default() -> Self {
        Self { steps: 0, begun: false, mark: (0, 0.0), explicit: f64::INFINITY, trial: true, patience: PATIENCE, bound: 0, against: 0 }
    }
}

/// Evaluations, factorisations and tangents.
fn work(counts: &Counts) -> usize {
    counts.evaluations + counts.factorisations + TANGENT * counts.tangents
}

impl Ledger {
    /// A scheme begins at time t.
    pub(super) fn begin(&mut self, engine: &Engine, t: f64) {
        self.mark = (work(&engine.counts), t);
        (self.steps, self.begun, self.bound, self.against, self.trial) = (0, false, 0, 0, true);
    }

    /// Notes what the explicit scheme costs.
    pub(super) fn note(&mut self, engine: &Engine, t: f64) {
        self.steps += 1;
        if self.steps >= JUDGED {
            self.explicit = self.rate(engine, t);
            self.steps = 0;
        }
    }

    /// Counts an explicit step; true if enough of them were bound by stability to try the other scheme.
    pub(super) fn explicit_step(&mut self, bound: bool) -> bool {
        self.bound = if bound { self.bound + 1 } else { self.bound.saturating_sub(1) };
        self.bound >= self.patience
    }

    /// Whether the implicit scheme is about to be judged, so that the spectral radius should be known.
    pub(super) fn asks(&self) -> bool {
        self.steps + 1 >= if self.begun { JUDGED } else { BEGINNING }
    }

    /// Counts an implicit step that ends at t; `affordable` is the step (s) that the explicit scheme could take.
    pub(super) fn implicit_step(&mut self, engine: &Engine, t: f64, affordable: f64) -> Verdict {
        self.steps += 1;
        if self.steps < if self.begun { JUDGED } else { BEGINNING } {
            return Verdict::Stay;
        }
        self.steps = 0;
        let implicit = self.rate(engine, t);
        if !self.begun {
            self.begun = true;
            return Verdict::Stay;
        }
        if std::mem::take(&mut self.trial) {
            if implicit > self.explicit {
                self.patience = (2 * self.patience).min(LONGEST);
                return Verdict::Leave;
            }
            self.patience = PATIENCE;
        }
        self.against = if EXPLICIT / affordable < WORTH * implicit { self.against + 1 } else { 0 };
        if self.against >= AGREED { Verdict::Leave } else { Verdict::Stay }
    }

    /// Work a second since the mark, which is set anew.
    fn rate(&mut self, engine: &Engine, t: f64) -> f64 {
        let now = (work(&engine.counts), t);
        let (before, start) = std::mem::replace(&mut self.mark, now);
        (now.0 - before) as f64 / (t - start)
    }
}
