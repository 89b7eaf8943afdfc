//! Reproducible pseudo-random numbers for tests.

/// A linear congruential generator (Knuth, MMIX).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    /// A number in [−1, 1).
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// `n` numbers in [−1, 1).
    pub(crate) fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}
