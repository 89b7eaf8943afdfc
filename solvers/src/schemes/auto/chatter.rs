//! Switches that follow each other within the stability of an explicit scheme: a motion that is drawn along a switch by a stiff force
//! beside it (friction below a small stick speed) is thrown across it by each explicit step, and no sequence of steps between two
//! switches is long enough to be seen to be stiff.

/// Restarts in a row behind steps that stability bounds.
const MANY: usize = 8;

/// The last restarts of an explicit scheme.
#[derive(Clone, Debug)]
pub(super) struct Chatter {
    count: usize,
    /// Restarts to wait for before the next trial: twice as many each time.
    wait: usize,
}

impl Default for Chatter {
    fn default() -> Self {
        Self { count: 0, wait: MANY }
    }
}

impl Chatter {
    /// Takes a restart behind a step that stability has bound, or not; whether there were enough in a row for a trial, with which the
    /// count begins anew.
    pub(super) fn restarts(&mut self, bound: bool) -> bool {
        self.count = if bound { self.count + 1 } else { 0 };
        let enough = self.count >= self.wait;
        if enough {
            (self.count, self.wait) = (0, 2 * self.wait);
        }
        enough
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_trial_waits_for_twice_as_many_restarts_in_a_row() {
        let mut chatter = Chatter::default();
        let trials: Vec<usize> = (1..=60).filter(|_| chatter.restarts(true)).collect();
        assert_eq!(trials, [8, 24, 56]);
        (0..64).for_each(|k| assert!(!chatter.restarts(k % 10 < 9)));
    }
}
