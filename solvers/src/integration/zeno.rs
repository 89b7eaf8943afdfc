//! Events that pile up: infinitely many in a finite time.

/// Events remembered.
const MANY: usize = 100;

/// Shrinking intervals in a row that count as a pile.
const SHRINKING: usize = 12;

/// Part of the time since the start in which many events are a pile.
pub(super) const PILE: f64 = 1e-6;

/// The last events of a run.
#[derive(Clone, Debug)]
pub struct Zeno {
    times: [f64; MANY],
    count: usize,
    shrinking: usize,
}

impl Default for Zeno {
    fn default() -> Self {
        Self { times: [0.0; MANY], count: 0, shrinking: 0 }
    }
}

impl Zeno {
    /// Takes an event at `t`; true if a hundred have happened in a millionth of the time since `start`, or if a dozen intervals
    /// in a row have shrunk in a ratio, to less than a millionth of that time.
    pub fn pile_up(&mut self, t: f64, start: f64) -> bool {
        let back = |k: usize| self.times[(self.count + MANY - k) % MANY];
        let window = PILE * (t - start).max(1e-9);
        let many = self.count >= MANY && t - back(MANY) < window;
        if self.count >= 2 {
            let (now, before) = (t - back(1), back(1) - back(2));
            self.shrinking = if now < 0.97 * before { self.shrinking + 1 } else { 0 };
        }
        let shrunk = self.shrinking >= SHRINKING && t - back(1) < window;
        self.times[self.count % MANY] = t;
        self.count += 1;
        many || shrunk
    }
}
