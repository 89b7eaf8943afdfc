//! Extrema and pieces of a closed-form curve over an angle, found without the program.

/// The root of `f` in [a, b], where it changes its sign, by bisection to the last bit.
pub(crate) fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let sign = f(a).is_sign_negative();
    for _ in 0..100 {
        let middle = 0.5 * (a + b);
        if f(middle).is_sign_negative() == sign {
            a = middle;
        } else {
            b = middle;
        }
    }
    0.5 * (a + b)
}

/// f' by differences of the eighth order.
pub(crate) fn slope(f: &impl Fn(f64) -> f64, x: f64, step: f64) -> f64 {
    let pair = |k: f64| f(x + k * step) - f(x - k * step);
    (pair(1.0) * 4.0 / 5.0 - pair(2.0) / 5.0 + pair(3.0) * 4.0 / 105.0 - pair(4.0) / 280.0) / step
}

/// Steps of the differences, rad: wide to be quiet, then narrow to see sharp bends.
const STEPS: [f64; 4] = [2e-3, 3e-4, 5e-5, 8e-6];

/// Smallest and largest value of `f(x, piece)` over all pieces [a, b], with their first places. `f` must go on smoothly a little beyond
/// the ends of its piece.
pub(crate) fn extremes(f: impl Fn(f64, usize) -> f64, pieces: &[[f64; 2]]) -> [(f64, f64); 2] {
    let mut found = [(f64::INFINITY, f64::NAN), (f64::NEG_INFINITY, f64::NAN)];
    // of two that are equal but for round-off the first stays
    let mut put = |value: f64, at: f64| {
        let least = 1e-12 * value.abs();
        if value + least < found[0].0 {
            found[0] = (value, at);
        }
        if value - least > found[1].0 {
            found[1] = (value, at);
        }
    };
    for (piece, &[a, b]) in pieces.iter().enumerate() {
        let f = |x: f64| f(x, piece);
        let count = (((b - a) / 5e-3).ceil() as usize).max(8);
        let at = |k: usize| a + (b - a) * k as f64 / count as f64;
        put(f(a), a);
        let mut left = slope(&f, a, STEPS[0]);
        for k in 1..=count {
            let right = slope(&f, at(k), STEPS[0]);
            if (left < 0.0) != (right < 0.0) {
                let mut x = root(|x| slope(&f, x, STEPS[0]), at(k - 1), at(k));
                for step in &STEPS[1..] {
                    let ends = [(x - 10.0 * step).max(a), (x + 10.0 * step).min(b)];
                    let [low, high] = ends.map(|x| slope(&f, x, *step));
                    if (low < 0.0) != (high < 0.0) {
                        x = root(|x| slope(&f, x, *step), ends[0], ends[1]);
                    }
                }
                put(f(x), x);
            }
            left = right;
        }
        put(f(b), b);
    }
    found
}
