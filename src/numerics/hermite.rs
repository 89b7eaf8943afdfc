//! Polynomials through values and rates at both ends of an interval.

/// A polynomial of degree five at most, on an interval of length h.
///
/// Predicts a solution between two known states; see [`Hermite::at`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hermite {
    /// Length of the interval.
    h: f64,
    /// Coefficients of powers of s = x/h.
    c: [f64; 6],
}

impl Hermite {
    /// The cubic with value and rate [q, v] at x = 0 and x = h; error |q⁗| h⁴ / 384.
    pub fn cubic(h: f64, [q0, v0]: [f64; 2], [q1, v1]: [f64; 2]) -> Self {
        let (v0, v1, d) = (h * v0, h * v1, q1 - q0);
        Self { h, c: [q0, v0, 3.0 * d - 2.0 * v0 - v1, v0 + v1 - 2.0 * d, 0.0, 0.0] }
    }

    /// The quintic with value and rates [q, v, a] at x = 0 and x = h; error |q⁽⁶⁾| h⁶ / 46080.
    pub fn quintic(h: f64, [q0, v0, a0]: [f64; 3], [q1, v1, a1]: [f64; 3]) -> Self {
        let (v0, v1, a0, a1, d) = (h * v0, h * v1, h * h * a0, h * h * a1, q1 - q0);
        let c3 = 10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
        let c4 = -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
        let c5 = 6.0 * d - 3.0 * (v0 + v1) - 0.5 * (a0 - a1);
        Self { h, c: [q0, v0, 0.5 * a0, c3, c4, c5] }
    }

    /// Value and first two derivatives at x, which may lie outside of the interval.
    pub fn at(&self, x: f64) -> [f64; 3] {
        let s = x / self.h;
        let (mut q, mut v, mut a) = (0.0, 0.0, 0.0);
        for c in self.c.iter().rev() {
            // Horner's scheme, differentiated twice
            a = a * s + 2.0 * v;
            v = v * s + q;
            q = q * s + c;
        }
        [q, v / self.h, a / (self.h * self.h)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_their_degree_are_reproduced() {
        let cubic = |x: f64| [1.0 - x + 2.0 * x.powi(3), -1.0 + 6.0 * x * x, 12.0 * x];
        let quintic = |x: f64| [x.powi(5) - x * x, 5.0 * x.powi(4) - 2.0 * x, 20.0 * x.powi(3) - 2.0];
        let h = 0.4;
        let first = |p: [f64; 3]| [p[0], p[1]];
        let (p, q) = (Hermite::cubic(h, first(cubic(0.0)), first(cubic(h))), Hermite::quintic(h, quintic(0.0), quintic(h)));
        for x in [0.0, 0.1, 0.4, 0.5] {
            for k in 0..3 {
                assert!((p.at(x)[k] - cubic(x)[k]).abs() < 1e-13);
                assert!((q.at(x)[k] - quintic(x)[k]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn errors_are_as_promised() {
        let sine = |x: f64| [x.sin(), x.cos(), -x.sin()];
        let (x0, h) = (0.7, 0.1);
        let q = Hermite::quintic(h, sine(x0), sine(x0 + h));
        let p = Hermite::cubic(h, [sine(x0)[0], sine(x0)[1]], [sine(x0 + h)[0], sine(x0 + h)[1]]);
        let (middle, exact) = (0.5 * h, (x0 + 0.5 * h).sin());
        assert!((q.at(middle)[0] - exact).abs() <= h.powi(6) / 46080.0);
        assert!((p.at(middle)[0] - exact).abs() <= h.powi(4) / 384.0);
    }
}
