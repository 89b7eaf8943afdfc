//! What of an eigenvalue is round-off.

/// An eigenvalue below this part of what it is the sum of is round-off: a free motion.
pub(super) const ROUND_OFF: f64 = 1e-12;
/// An eigenvalue below this part of the work of all forces on unit ways, in its mode, is round-off, too: a stiffness may be the product of
/// two numbers that are zero but for round-off.
pub(super) const OF_WORK: f64 = 1e-15;

/// Round-off of eigenvalues beside others, which have parts of the size of round-off in their vectors.
pub(super) fn by_others(values: &[f64]) -> f64 {
    f64::EPSILON * f64::EPSILON * values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Round-off of the eigenvalue of a mode, 1/s², where forces do the work `work`, J, on unit ways: by the parts of its shape in these ways.
pub(super) fn of_work(work: f64, parts: impl Iterator<Item = f64>) -> f64 {
    OF_WORK * work * parts.map(|x| x * x).sum::<f64>()
}
