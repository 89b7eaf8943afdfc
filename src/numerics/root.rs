//! Places where a condition changes.

use super::samples::bend;

/// A change of sign, held between two places with nothing but round-off (or the tolerance) between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Last place found on the side of the start, where the function still has the sign it starts with.
    pub before: f64,
    /// First place found beyond, where it is zero, of the other sign, or undefined.
    pub after: f64,
    /// Value at `before`.
    pub f_before: f64,
    /// Value at `after`.
    pub f_after: f64,
}

impl Root {
    /// The end with the smaller residual.
    pub fn place(&self) -> f64 {
        if self.f_before.abs() < self.f_after.abs() { self.before } else { self.after }
    }
}

/// More than bisection from the largest to the smallest number that is not denormal would need, were it ever so slow.
const MOST_ITERATIONS: usize = 200;

/// The change of sign of `f` between a and b (in either order), where f(a) = `fa` and f(b) = `fb`.
///
/// None if fb has the sign of fa, or fa is NaN. A zero or NaN met on the way counts as the other side. Ends when before and
/// after are closer than `tolerance` plus a few units of round-off of their place and of b − a. Inverse quadratic interpolation
/// where it can be trusted, else bisection: Chandrupatla, Adv. Eng. Software 28 (1997) 145-149.
pub fn root<E>(mut f: impl FnMut(f64) -> Result<f64, E>, a: f64, b: f64, fa: f64, fb: f64, tolerance: f64) -> Result<Option<Root>, E> {
    if fa == 0.0 {
        return Ok(Some(Root { before: a, after: a, f_before: fa, f_after: fa }));
    }
    let sign = fa.signum();
    let starting = |f: f64| sign * f > 0.0;
    if !starting(fa) || starting(fb) {
        return Ok(None);
    }
    let round_off = f64::EPSILON * (b - a).abs();
    // (x1, f1): the newest; (x2, f2): the other end; (x3, f3): the one before
    let (mut x1, mut f1, mut x2, mut f2) = (b, fb, a, fa);
    let mut t = 0.5;
    for _ in 0..MOST_ITERATIONS {
        let x = x1 + t * (x2 - x1);
        if x == x1 && t == 0.5 || x == x2 {
            break;
        }
        let fx = f(x)?;
        let (x3, f3);
        if starting(fx) == starting(f1) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, fx);
        let nearest = if f1.abs() < f2.abs() { x1 } else { x2 };
        let least = (f64::EPSILON * nearest.abs()).max(round_off) + 0.5 * tolerance;
        let limit = least / (x2 - x1).abs();
        if limit > 0.5 {
            break;
        }
        let (xi, phi) = ((x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2));
        t = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        } else {
            0.5
        };
        t = if t.is_finite() { t.clamp(limit, 1.0 - limit) } else { 0.5 };
    }
    let ((before, f_before), (after, f_after)) = if starting(f1) { ((x1, f1), (x2, f2)) } else { ((x2, f2), (x1, f1)) };
    Ok(Some(Root { before, after, f_before, f_after }))
}

/// The first change of sign of `f` along samples (`places` rising, `values` = f there), and which sample it follows.
///
/// A dip through zero and back between two samples is found as well, where the bend of the samples shows that there could be one.
/// A function that only touches zero has no change of sign. Samples that are NaN end the search: nothing is known beyond.
pub fn first<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    places: &[f64],
    values: &[f64],
    tolerance: f64,
) -> Result<Option<(usize, Root)>, E> {
    let known = values.iter().position(|y| y.is_nan()).unwrap_or(values.len()).min(places.len());
    let (x, y) = (&places[..known], &values[..known]);
    let Some(start) = y.iter().position(|y| *y != 0.0) else { return Ok(None) };
    let sign = y[start].signum();
    for i in start..known {
        let (left, right) = (i.saturating_sub(1).max(start), (i + 1).min(known - 1));
        let low = |k: usize| sign * y[i] <= sign * y[k];
        if low(left)
            && low(right)
            && sign * y[i] - 0.5 * bend(x, y, i) < 0.0
            && let Some((at, value)) = dip(|x| Ok(sign * f(x)?), x[left], x[right])?
        {
            let found = root(&mut f, x[left], at, y[left], sign * value, tolerance)?;
            let after = if found.is_some_and(|r| r.before >= x[i]) { i } else { left };
            return Ok(found.map(|root| (after, root)));
        }
        if i + 1 < known && sign * y[i + 1] <= 0.0 {
            return Ok(root(&mut f, x[i], x[i + 1], y[i], y[i + 1], tolerance)?.map(|root| (i, root)));
        }
    }
    Ok(None)
}

/// A place in (a, b) where `f`, positive at both ends, is not positive; looked for at the minimum by golden sections.
fn dip<E>(mut f: impl FnMut(f64) -> Result<f64, E>, mut a: f64, mut b: f64) -> Result<Option<(f64, f64)>, E> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut x1, mut x2) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut f1, mut f2) = (f(x1)?, f(x2)?);
    // 40 sections: width 4e-9 of the first, where the minimum is flat to 1e-17
    for _ in 0..40 {
        if f1 <= 0.0 {
            return Ok(Some((x1, f1)));
        }
        if f2 <= 0.0 {
            return Ok(Some((x2, f2)));
        }
        if f1 < f2 {
            (b, x2, f2) = (x2, x1, f1);
            x1 = b - GOLDEN * (b - a);
            f1 = f(x1)?;
        } else {
            (a, x1, f1) = (x1, x2, f2);
            x2 = a + GOLDEN * (b - a);
            f2 = f(x2)?;
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn find(f: impl Fn(f64) -> f64, a: f64, b: f64) -> (Root, usize) {
        let mut count = 0;
        let counted = |x: f64| {
            count += 1;
            Ok::<f64, Infallible>(f(x))
        };
        let root = root(counted, a, b, f(a), f(b), 0.0).unwrap().unwrap();
        let ulp = f64::EPSILON * root.after.abs().max((b - a).abs());
        assert!((root.after - root.before).abs() <= 2.0 * ulp, "{root:?}");
        assert!(f(a) * root.f_before > 0.0 && f(a) * root.f_after <= 0.0, "{root:?}");
        (root, count)
    }

    #[test]
    fn smooth_roots_are_found_to_round_off_from_both_sides() {
        for (a, b) in [(0.0, 3.0), (3.0, 0.0)] {
            let (root, count) = find(|x| x.cos() - 0.3, a, b);
            assert!((root.place() - 0.3f64.acos()).abs() < 1e-15);
            assert!((root.before < root.after) == (a < b));
            assert!(count < 12, "{count} evaluations");
        }
    }

    #[test]
    fn bad_functions_take_no_more_than_bisection_and_a_little() {
        for f in [
            (|x: f64| (x - 0.4).powi(9)) as fn(f64) -> f64,
            |x| (x - 0.4).signum() - 0.5,
            |x| x - 1e-300,
            |x| x.powi(3),
            |x| {
                if x > 0.4 { 1e-12 } else { -1e12 }
            },
        ] {
            let (_, count) = find(f, -1.0, 1.7);
            assert!(count < 170, "{count} evaluations");
        }
    }

    #[test]
    fn exact_zeros_belong_to_the_far_side() {
        let (root, _) = find(|x| x - 1.0, 0.0, 2.0);
        assert_eq!(root.after, 1.0);
        let zero = |_: f64| Ok::<f64, Infallible>(0.0);
        assert_eq!(super::root(zero, 1.0, 2.0, 0.0, 1.0, 0.0).unwrap().unwrap().before, 1.0);
        assert_eq!(super::root(zero, 1.0, 2.0, 1.0, 1.0, 0.0).unwrap(), None);
        assert_eq!(super::root(zero, 1.0, 2.0, f64::NAN, 1.0, 0.0).unwrap(), None);
    }

    #[test]
    fn tolerance_saves_work() {
        let f = |x: f64| Ok::<f64, Infallible>(x.exp() - 2.0);
        let root = root(f, 0.0, 2.0, -1.0, 2f64.exp() - 2.0, 1e-6).unwrap().unwrap();
        assert!(root.after - root.before <= 1e-6 && root.before < 2f64.ln() && root.after >= 2f64.ln());
    }

    fn first_of(f: impl Fn(f64) -> f64, n: usize) -> Option<(usize, Root)> {
        let places: Vec<f64> = (0..=n).map(|k| k as f64 / n as f64).collect();
        let values: Vec<f64> = places.iter().map(|x| f(*x)).collect();
        first(|x| Ok::<f64, Infallible>(f(x)), &places, &values, 0.0).unwrap()
    }

    #[test]
    fn the_first_of_several_changes_is_found() {
        let (sample, root) = first_of(|x| (10.0 * x).cos(), 100).unwrap();
        assert!((root.place() - 0.05 * std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(sample, 15);
        assert_eq!(first_of(|x| 1.0 + x, 10), None);
        assert_eq!(first_of(|_| 0.0, 10), None);
        assert_eq!(first_of(|x| if x < 0.2 { 1.0 } else { f64::NAN }, 10), None);
    }

    #[test]
    fn a_dip_between_two_samples_is_found() {
        let (middle, depth) = (0.437, 1e-6);
        for sign in [1.0, -1.0] {
            let (sample, root) = first_of(|x| sign * ((x - middle) * (x - middle) - depth), 50).unwrap();
            assert!((root.before - (middle - 1e-3)).abs() < 1e-12, "{root:?}");
            assert_eq!(sample, 21);
        }
        // it only touches
        assert_eq!(first_of(|x| (x - middle) * (x - middle) + 1e-12, 50), None);
        // in the first and in the last interval
        assert!(first_of(|x| (x - 0.004) * (x - 0.006), 50).is_some());
        assert!(first_of(|x| (x - 0.994) * (x - 0.996), 50).is_some());
    }
}
