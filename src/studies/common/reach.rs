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

/// Part of a range over which a law has to rest.
const STILL: f64 = 1e-9;

/// Part of a time behind the end of the length within which a law that has come to rest there is followed to where it rests.
const RESTING: f64 = 1e-3;

/// A law at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// The coordinate and its speed.
    pub(super) motion: [f64; 2],
    /// A number of the formula that it has there: where two differ, there is a switch between them.
    pub(super) formula: u64,
}

/// The time at which a law has gone a length > 0, s, in the sense of time `sense` (1 or −1) from t = 0; `told` gives a length in words.
///
/// # Errors
/// If it rests at its start or on its way, where its coordinate tells no time, turns back before it has gone so far, or never does.
pub(super) fn reached(mut law: impl FnMut(f64) -> Look, sense: f64, length: f64, told: impl Fn(f64) -> String) -> Result<f64, NeverThere> {
    let [from, _] = law(0.0).motion;
    let mut at = |t: f64| {
        let [x, speed] = law(sense * t).motion;
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
    if let Some(rest) = rest(|t| law(sense * t), end) {
        let gone = (law(sense * rest).motion[0] - from).abs();
        return Err(NeverThere(format!("the driver rests on its way, after {}", told(gone))));
    }
    Ok(sense * end)
}

/// A time before `end` at which a law rests.
fn rest(mut law: impl FnMut(f64) -> Look, end: f64) -> Option<f64> {
    let rests = |law: &mut dyn FnMut(f64) -> Look, t: f64| [0.0, STILL * end].iter().all(|later| law(t + later).motion[1] == 0.0);
    let look = |i: u32| end * f64::from(i) / f64::from(LOOKS);
    if let Some(t) = (1..LOOKS).map(look).find(|t| rests(&mut law, *t)) {
        return Some(t);
    }
    // shorter rests lie between two switches
    let mut open: Vec<[f64; 2]> = (0..LOOKS).map(|i| [look(i), look(i + 1)]).collect();
    while let Some([a, b]) = open.pop() {
        if b - a <= STILL * end || law(a).formula == law(b).formula {
            continue;
        }
        let middle = 0.5 * (a + b);
        if rests(&mut law, middle) {
            return Some(middle);
        }
        open.extend([[a, middle], [middle, b]]);
    }
    None
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
        of_pieces(|t| (law(t), 0), sense, length)
    }

    fn of_pieces(law: impl Fn(f64) -> ([f64; 2], u64), sense: f64, length: f64) -> Result<f64, String> {
        let look = |t: f64| {
            let (motion, formula) = law(t);
            Look { motion, formula }
        };
        reached(look, sense, length, |x| format!("{x:.6}")).map_err(|never| never.0)
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

    #[test]
    fn a_law_that_rests_on_its_way_has_no_range_beyond() {
        // up to 1, a rest of so long, and on
        for rest in [1.0, 1e-2, 1e-5, 1e-7] {
            let law = |t: f64| match t {
                t if t < 1.0 => ([t, 1.0], 0),
                t if t < 1.0 + rest => ([1.0, 0.0], 1),
                t => ([t - rest, 1.0], 2),
            };
            assert_eq!(of_pieces(law, 1.0, 1.7), Err("the driver rests on its way, after 1.000000".into()), "{rest}");
            let back = |t: f64| {
                let ([x, speed], formula) = law(-t);
                ([x, -speed], formula)
            };
            assert_eq!(of_pieces(back, -1.0, 1.7), Err("the driver rests on its way, after 1.000000".into()), "{rest}");
            assert!((of_pieces(law, 1.0, 0.9).unwrap() - 0.9).abs() < 1e-14);
            assert!((of_pieces(law, 1.0, 1.0).unwrap() - 1.0).abs() < 1e-14);
        }
        // without speed for an instant, it goes on
        let through = |t: f64| [(t - 1.0).powi(3) + 1.0, 3.0 * (t - 1.0).powi(2)];
        assert!((of(through, 1.0, 2.0).unwrap() - 2.0).abs() < 1e-14);
    }
}
