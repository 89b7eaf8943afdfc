//! Switches that follow each other within the stability of an explicit scheme: a motion that is drawn along a switch by a stiff force
//! beside it (friction below a small stick speed) is thrown across it by each explicit step, and no sequence of steps between two
//! switches is long enough to be seen to be stiff.

/// Restarts looked at.
const MANY: usize = 8;

/// Mean time between them, in times that an explicit step may be stable.
const STEPS: f64 = 8.0;

/// The last restarts of an explicit scheme.
#[derive(Clone, Debug)]
pub(super) struct Chatter {
    times: [f64; MANY],
    count: usize,
    /// Restarts to wait for before the next trial: twice as many each time.
    wait: usize,
}

impl Default for Chatter {
    fn default() -> Self {
        Self { times: [0.0; MANY], count: 0, wait: MANY }
    }
}

impl Chatter {
    /// Takes a restart at a time; whether enough of them have happened to be worth the spectrum.
    pub(super) fn restarts(&mut self, t: f64) -> bool {
        self.times.rotate_right(1);
        self.times[0] = t;
        self.count += 1;
        self.count >= self.wait
    }

    /// Whether the last restarts lie within explicit steps of the length `stable`; then the count begins anew.
    pub(super) fn within(&mut self, stable: f64) -> bool {
        let within = self.times[0] - self.times[MANY - 1] < STEPS * stable * MANY as f64;
        if within {
            (self.count, self.wait) = (0, 2 * self.wait);
        }
        within
    }
}
