//! Chebyshev interpolation on twelve points, for the neighbourhood of an extremum.

use std::f64::consts::PI;

/// Number of nodes.
pub(crate) const NODES: usize = 12;

/// Coefficients c of p(s) = Σ c_k T_k(s), s in [−1, 1].
pub(crate) type Series = [f64; NODES];

/// The nodes and the transform from values to coefficients.
pub(crate) struct Basis {
    /// T_k at node j.
    cosine: [[f64; NODES]; NODES],
}

impl Basis {
    pub(crate) fn new() -> Self {
        let angle = |j: usize| PI * (NODES - 1 - j) as f64 / NODES as f64 + PI / (2 * NODES) as f64;
        Self { cosine: std::array::from_fn(|k| std::array::from_fn(|j| (k as f64 * angle(j)).cos())) }
    }

    /// The zeros of T_12, rising.
    pub(crate) fn nodes(&self) -> &[f64; NODES] {
        &self.cosine[1]
    }

    /// c_k = (2/n) Σ_j y_j T_k(s_j), half of it for k = 0.
    pub(crate) fn series(&self, values: &[f64; NODES]) -> Series {
        let sum = |k: usize| -> f64 { self.cosine[k].iter().zip(values).map(|(t, y)| t * y).sum() };
        std::array::from_fn(|k| sum(k) * if k == 0 { 1.0 } else { 2.0 } / NODES as f64)
    }
}

/// p(s) by Clenshaw's recurrence.
pub(crate) fn value(series: &[f64], s: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in series[1..].iter().rev() {
        (b1, b2) = (c + 2.0 * s * b1 - b2, b1);
    }
    series[0] + s * b1 - b2
}

/// The series of dp/ds: d_{k−1} = d_{k+1} + 2 k c_k, d_0 halved.
pub(crate) fn derivative(series: &Series) -> Series {
    let mut d = [0.0; NODES];
    for k in (1..NODES).rev() {
        d[k - 1] = 2.0 * k as f64 * series[k] + if k + 1 < NODES { d[k + 1] } else { 0.0 };
    }
    d[0] *= 0.5;
    d
}

/// Calls `found` with the zeros of a series in [−1, 1], rising; two zeros closer than 0.06 can be overlooked.
pub(crate) fn zeros(series: &Series, mut found: impl FnMut(f64)) {
    const STEPS: usize = 32;
    let slope = derivative(series);
    let (mut a, mut fa) = (-1.0, value(series, -1.0));
    for k in 1..=STEPS {
        let b = 2.0 * k as f64 / STEPS as f64 - 1.0;
        let fb = value(series, b);
        if fa == 0.0 {
            found(a);
        } else if fa * fb < 0.0 {
            found(zero_between(series, &slope, (a, fa), (b, fb)));
        }
        (a, fa) = (b, fb);
    }
    if fa == 0.0 {
        found(a);
    }
}

/// Newton's method, kept inside of the bracket by bisection.
fn zero_between(series: &Series, slope: &Series, (mut a, fa): (f64, f64), (mut b, fb): (f64, f64)) -> f64 {
    let mut s = a + (b - a) * fa / (fa - fb);
    for _ in 0..60 {
        let f = value(series, s);
        if f == 0.0 {
            break;
        }
        if (f > 0.0) == (fa > 0.0) {
            a = s
        } else {
            b = s
        }
        let newton = s - f / value(slope, s);
        let next = if newton > a && newton < b { newton } else { 0.5 * (a + b) };
        let step = (next - s).abs();
        s = next;
        if step < 1e-15 {
            break;
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_of_an_analytic_function_and_its_derivative() {
        let basis = Basis::new();
        let series = basis.series(&basis.nodes().map(f64::exp));
        for s in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            assert!((value(&series, s) - f64::exp(s)).abs() < 1e-11);
            assert!((value(&derivative(&series), s) - f64::exp(s)).abs() < 1e-9);
        }
        assert!(basis.nodes().is_sorted());
    }

    #[test]
    fn zeros_of_a_polynomial_in_order() {
        let basis = Basis::new();
        let series = basis.series(&basis.nodes().map(|s| (s + 0.9) * (s - 0.1) * (s - 0.3) * (s - 2.0)));
        let mut found = Vec::new();
        zeros(&series, |s| found.push(s));
        assert_eq!(found.len(), 3);
        for (s, expected) in found.iter().zip([-0.9, 0.1, 0.3]) {
            assert!((s - expected).abs() < 1e-14, "{s}");
        }
    }
}
