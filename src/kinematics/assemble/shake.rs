//! Trial directions that are the same in every run.

/// A fixed sequence in (−1, 1).
pub(super) struct Shake(pub(super) u64);

impl Shake {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
