//! When the law of a driver has gone a length.

/// Why a driver does not get to the end of a range.
#[derive(Clone, Debug, PartialEq)]
pub struct NeverThere(pub String);

/// First time that is looked at, s, the growth from look to look, and the time behind which a law is not followed, s.
const FIRST: f64 = 3e-5;
const GROWTH: f64 = 1.0 + 1.0 / 64.0;
const FARTHEST: f64 = 1e7;

/// Looks between the start and the end for a way back.
const LOOKS: u32 = 2000;

/// Part of the length by which a law may turn back, and by which it may miss the length where it does.
const BACK: f64 = 1e-9;

/// Part of a time behind the end of the length within which a law that has come to rest there is followed to where it rests.
const RESTING: f64 = 1e-3;

/// The time at which a law has gone a length > 0, s, in the sense of time `sense` (1 or −1) from t = 0; `law` gives the coordinate and its speed
/// at a time, `told` a length in words.
///
/// # Errors
/// If it rests at its start, turns back before it has gone so far, or never does.
pub(super) fn reached(
    mut law: impl FnMut(f64) -> [f64; 2],
    sense: f64,
    length: f64,
    told: impl Fn(f64) -> String,
) -> Result<f64, NeverThere> {
    let [from, _] = law(0.0);
    let mut at = |t: f64| {
        let [x, speed] = law(sense * t);
        [x - from, sense * speed]
    };
    let way = match at(FIRST) {
        [0.0, 0.0] => {
            let driver = if sense < 0.0 { "before its start, where a negative range leads, the driver" } else { "the driver" };
            return Err(NeverThere(format!("{driver} stands still at first")));
        }
        [gone, 0.0] => gone.signum(),
        [_, speed] => speed.signum(),
    };
    let (mut low, mut high) = (0.0, FIRST);
    loop {
        let [gone, speed] = at(high);
        if way * gone >= length {
            break;
        }
        if way * speed < 0.0 {
            let turn = between(low, high, |t| way * at(t)[1] < 0.0);
            let most = way * at(turn)[0];
            if most >= length * (1.0 - BACK) {
                high = turn;
                break;
            }
            return Err(NeverThere(format!("the driver turns back after {}", told(most))));
        }
        (low, high) = (high, high * GROWTH);
        if high > FARTHEST {
            return Err(NeverThere(format!("the driver never gets so far, but {} at most", told(way * gone))));
        }
    }
    // where it comes to rest at the length it has gone so far when it rests
    let end = between(low, high, |t| way * at(t)[0] >= length * (1.0 - 4.0 * f64::EPSILON));
    let beyond = end * (1.0 + RESTING);
    let [gone, speed] = at(beyond);
    let end = if speed == 0.0 && (way * gone - length).abs() <= 1e-12 * length { between(end, beyond, |t| at(t)[1] == 0.0) } else { end };
    let mut last = 0.0;
    for i in 1..=LOOKS {
        let gone = way * at(end * f64::from(i) / f64::from(LOOKS))[0];
        if gone < last - BACK * length {
            return Err(NeverThere(format!("the driver turns back after {}", told(last))));
        }
        last = gone;
    }
    Ok(sense * end)
}

/// The first place between two, to round-off, from which on something holds that holds at the second.
fn between(mut low: f64, mut high: f64, mut holds: impl FnMut(f64) -> bool) -> f64 {
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(law: impl Fn(f64) -> [f64; 2], sense: f64, length: f64) -> Result<f64, String> {
        reached(law, sense, length, |x| format!("{x:.6}")).map_err(|never| never.0)
    }

    #[test]
    fn ranges_end_where_the_law_has_gone_so_far() {
        let sine = |t: f64| [t.sin(), t.cos()];
        for length in [0.1, 0.9, 0.99, 0.999, 0.999_99, 0.999_999_99] {
            let end = of(sine, 1.0, length).unwrap();
            assert!((end.sin() - length).abs() < 1e-14 && end < 1.571, "{length}: {end}");
        }
        // at its farthest place the round-off of a sine is that of a time of 1e-8 s
        assert!((of(sine, 1.0, 1.0).unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-7);
        assert_eq!(of(sine, 1.0, 1.0 + 1e-6), Err("the driver turns back after 1.000000".into()));
        let decay = |t: f64| [(-t).exp(), -(-t).exp()];
        assert!((of(decay, 1.0, 0.5).unwrap() - 2_f64.ln()).abs() < 1e-14);
        assert!((of(decay, -1.0, 0.5).unwrap() + 1.5_f64.ln()).abs() < 1e-14);
        assert!(of(decay, 1.0, 1.5).unwrap_err().starts_with("the driver never gets so far"));
    }

    #[test]
    fn a_law_that_comes_to_rest_ends_its_range_there() {
        let rise = |t: f64| {
            let t = t.clamp(0.0, 1.0);
            [t.powi(3) * (10.0 + t * (-15.0 + 6.0 * t)), 30.0 * t * t * (1.0 - t).powi(2)]
        };
        assert!((of(rise, 1.0, 1.0).unwrap() - 1.0).abs() < 1e-15);
        assert!((of(rise, 1.0, 0.5).unwrap() - 0.5).abs() < 1e-14);
        assert!(of(rise, -1.0, 1.0).unwrap_err().starts_with("before its start, where a negative range leads, the driver stands still"));
        let late = |t: f64| [(t - 1.0).max(0.0), if t > 1.0 { 1.0 } else { 0.0 }];
        assert!(of(late, 1.0, 1.0).unwrap_err().starts_with("the driver stands still at first"));
    }
}
