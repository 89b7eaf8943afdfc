//! Slopes by differences whose step is found, for functions of which nothing is known but their values.
//!
//! ```text
//! f′(0) ≈ (45 (f(h) − f(−h)) − 9 (f(2h) − f(−2h)) + (f(3h) − f(−3h)))/(60 h),   error h⁶ f⁽⁷⁾/140
//! ```
//!
//! (Fornberg, Math. Comp. 51 (1988) 699-706, table 1). The step is divided by ten until the slope stays the same, or what it changes by
//! grows again, as by round-off.

/// Steps that are tried, each a tenth of the one before.
const STEPS: usize = 11;
/// Change from one step to the next, as part of the slope, that is none.
const SAME: f64 = 1e-9;
/// Round-off of a difference in units of ε |f|/h.
const ROUNDED: f64 = 16.0;
/// Part of |f| by the longest step up to which a slope that is not known is none.
const NONE: f64 = 1e-8;
/// The same in units of the round-off of f, as which alone an f that is zero is seen.
const SCATTERED: f64 = 1e3;
/// Places, in longest steps, beside which round-off is measured, and how far apart values are for it.
const BESIDE: [f64; 2] = [-0.37, 0.37];
/// See [`BESIDE`].
const APART: f64 = 1e-9;

/// f′(0), each entry by the step at which it changes least, and how much of it may be wrong, as the largest part of an entry; none
/// where f has no value beside 0.
pub(crate) fn slope(longest: f64, mut f: impl FnMut(f64) -> Option<Vec<f64>>) -> Option<(Vec<f64>, f64)> {
    let mut before: Option<Vec<f64>> = None;
    // the best slope of each entry, what it changed by, and that or the round-off with which this is known
    let mut best: Vec<(f64, f64, f64)> = Vec::new();
    let mut none = Vec::new();
    let scatter = scatter(longest, &mut f);
    for k in 0..STEPS {
        let h = longest * 10f64.powi(-(k as i32));
        let Some((now, sizes)) = differences(h, &mut f) else {
            before = None;
            continue;
        };
        let scattered = |i: usize| scatter.get(i).copied().unwrap_or(0.0);
        let rounding =
            sizes.iter().enumerate().map(|(i, size)| ROUNDED * (f64::EPSILON * size).max(scattered(i)) / h).collect::<Vec<f64>>();
        if best.is_empty() {
            none = sizes.iter().enumerate().map(|(i, size)| (NONE * size).max(SCATTERED * scattered(i)) / longest).collect();
            best = now.iter().map(|x| (*x, f64::INFINITY, f64::INFINITY)).collect();
        }
        if let Some(before) = &before {
            for (((best, now), before), rounding) in best.iter_mut().zip(&now).zip(before).zip(&rounding) {
                let change = (now - before).abs();
                // differences that are lost in round-off change by nothing at all
                let seen = change.max(*rounding);
                if seen < best.2 {
                    // where round-off explains the change, the longer step has less of it
                    *best = (if change <= *rounding { *before } else { *now }, change, seen);
                }
            }
            let known = best.iter().zip(&rounding).all(|((x, change, _), rounding)| *change <= SAME * x.abs() + rounding);
            if known {
                break;
            }
        }
        before = Some(now);
    }
    if best.is_empty() {
        return None;
    }
    let part = |((x, change, _), none): (&(f64, f64, f64), &f64)| if *change <= *none { 0.0 } else { change / x.abs() };
    let wrong = best.iter().zip(&none).map(part).fold(0.0, f64::max);
    Some((best.into_iter().map(|(x, ..)| x).collect(), wrong))
}

/// Round-off of each entry of f, beside 0 on either side, where a kink or a jump at 0 takes no part; none where f has no values there.
fn scatter(longest: f64, f: &mut impl FnMut(f64) -> Option<Vec<f64>>) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for beside in BESIDE {
        let rows: Option<Vec<Vec<f64>>> = (-3..=3).map(|k| f((beside + APART * f64::from(k)) * longest)).collect();
        let Some(rows) = rows else { continue };
        let of = |i: usize| {
            // the third difference of noise ε has the variance 20 ε²
            let third = |w: &[Vec<f64>]| w[3][i] - 3.0 * w[2][i] + 3.0 * w[1][i] - w[0][i];
            (rows.windows(4).map(|w| third(w).powi(2)).sum::<f64>() / 80.0).sqrt()
        };
        let here: Vec<f64> = (0..rows[0].len()).map(of).collect();
        found.resize(here.len(), 0.0);
        found.iter_mut().zip(here).filter(|(_, x)| x.is_finite()).for_each(|(most, x)| *most = most.max(x));
    }
    found
}

/// The formula above with a step, and the largest |f| of each entry.
fn differences(h: f64, f: &mut impl FnMut(f64) -> Option<Vec<f64>>) -> Option<(Vec<f64>, Vec<f64>)> {
    let (mut sum, mut size): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (k, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
        let (up, down) = (f(k * h)?, f(-k * h)?);
        sum.resize(up.len(), 0.0);
        size.resize(up.len(), 0.0);
        for (((sum, size), up), down) in sum.iter_mut().zip(&mut size).zip(up).zip(down) {
            *sum += (up - down) * (weight / (60.0 * h));
            *size = size.max(up.abs()).max(down.abs());
        }
    }
    sum.iter().all(|x| x.is_finite()).then_some((sum, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(f: impl Fn(f64) -> f64) -> (f64, f64) {
        let (slope, wrong) = slope(1e-3, |x| Some(vec![f(x)])).unwrap();
        (slope[0], wrong)
    }

    #[test]
    fn the_step_follows_the_function() {
        for (scale, digits) in [(1.0, 1e-11), (1e-2, 1e-10), (1e-3, 1e-9), (1e-4, 1e-9), (1e-6, 1e-8)] {
            let (found, wrong) = of(|x| (0.3 + x / scale).sin());
            let exact = 0.3_f64.cos() / scale;
            assert!((found / exact - 1.0).abs() < digits, "{scale:e}: {found} {exact}");
            assert!(wrong < 1e-6, "{scale:e}: {wrong:e}");
        }
        let (found, _) = of(|x| 1e-12 / (1e-6 - x).powi(2));
        assert!((found / 2e6 - 1.0).abs() < 1e-8, "{found}");
        assert!(of(|x| x * x.abs()).0.abs() < 1e-10);
        assert_eq!(of(|_| 3.0), (0.0, 0.0));
    }

    #[test]
    fn what_is_zero_but_for_round_off_has_a_slope_of_zero() {
        // what cancels, beside what it cancels from
        let (found, wrong) = of(|x| (1.7 + x).sin().powi(2) + (1.7 + x).cos().powi(2) - 1.0);
        assert!(found.abs() < 1e-11 && wrong == 0.0, "{found:e} {wrong:e}");
        // a jump as small as that is one all the same
        assert!(of(|x| if x > 0.0 { 1e-17 } else { 0.0 }).1 > 0.1);
    }

    #[test]
    fn round_off_of_one_entry_does_not_cost_others_their_slope() {
        // where its scatter is not looked for
        let noise = |x: f64| if x.abs() < 2e-4 { 1e-17 * (1e15 * x).sin() } else { 0.0 };
        for rate in [1e-6, 1e-3, 1.0] {
            let beside = [1.0, 1.3, 1.7, 2.9, 4.1];
            let all = |x: f64| [noise(x), rate * x].into_iter().chain(beside.map(|one| one + rate * (one * x).sin() / one)).collect();
            let (found, _) = slope(1e-3, |x| Some(all(x))).unwrap();
            assert!((found[1] / rate - 1.0).abs() < 1e-9, "{rate:e}: {found:?}");
            // the round-off of the longest step
            let near = |x: &f64| (x - rate).abs() < 1e-11;
            assert!(found[2..].iter().all(near), "{rate:e}: {found:?}");
        }
    }

    #[test]
    fn a_function_that_ends_nearby_is_approached() {
        let (found, _) = slope(1e-3, |x| (x.abs() < 1e-4).then(|| vec![x.exp()])).unwrap();
        assert!((found[0] - 1.0).abs() < 1e-10, "{}", found[0]);
        assert!(slope(1e-3, |_| None).is_none());
        // a kink has none
        assert!(of(f64::abs).0.abs() < 1e-9);
        assert!(of(|x| if x > 0.0 { 1.0 } else { 0.0 }).1 > 0.1);
    }
}
