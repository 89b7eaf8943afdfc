//! Numbers as text.

/// The shortest text that reads back as the same `f64`; empty for what is not a finite number.
///
/// Rust's own shortest digits; exponents only where the plain form would have long rows of zeros. Whole numbers have no `.0`.
#[must_use]
pub fn number(x: f64) -> String {
    let size = x.abs();
    if !x.is_finite() {
        String::new()
    } else if size != 0.0 && !(1e-5..1e16).contains(&size) {
        format!("{x:e}")
    } else {
        format!("{x}")
    }
}

/// The same of six significant digits, for messages.
#[must_use]
pub fn six_digits(x: f64) -> String {
    number(format!("{x:.5e}").parse().unwrap_or(x))
}
