//! Where an axis has its marks and what they say.

use super::units::superscript;

/// One mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// The value, in shown units.
    pub(super) at: f64,
    /// Its text; empty for a minor line.
    pub(super) label: String,
}

/// Marks at round numbers within `low..=high`, at most `most` of them unless only one would be left, which is no scale; steps of 15, 30,
/// 45, 60, 90... for angles in `degrees`.
pub(super) fn linear(low: f64, high: f64, most: usize, degrees: bool) -> Vec<Tick> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    (most..most + 6).map(|most| marks(low, high, most, degrees)).find(|marks| marks.len() > 1).unwrap_or_default()
}

fn marks(low: f64, high: f64, most: usize, degrees: bool) -> Vec<Tick> {
    let span = high - low;
    let step = if degrees && span >= 60.0 { angle_step(span, most) } else { round_step(span, most) };
    // Multiples of the step by whole numbers: sums of steps would print as 0.30000000000000004.
    let tolerance = 1e-9;
    let (first, last) = ((low / step - tolerance).ceil(), (high / step + tolerance).floor());
    let decimals = usize::try_from(-(step.log10() + 1e-9).floor() as i64).unwrap_or(0);
    // A step of 2.5 needs one decimal more than its size says.
    let decimals = if (step * 10f64.powi(decimals as i32)).fract().abs() > 1e-6 { decimals + 1 } else { decimals };
    (0..=((last - first).max(-1.0) as i64).min(200))
        .map(|index| {
            let at = (first + index as f64) * step;
            Tick { at, label: text(at, decimals, step) }
        })
        .collect()
}

fn text(at: f64, decimals: usize, step: f64) -> String {
    let at = if at.abs() < step * 1e-6 { 0.0 } else { at };
    let plain = if decimals > 8 || at.abs() >= 1e9 { super::scalars::significant(at, 6) } else { format!("{at:.decimals$}") };
    plain.replace('-', "−")
}

/// The smallest step 1, 2, 2.5 or 5 times a power of ten with at most `most` marks.
fn round_step(span: f64, most: usize) -> f64 {
    let least = span / most.max(1) as f64;
    let power = 10f64.powf((least.log10() + 1e-12).floor());
    [1.0, 2.0, 2.5, 5.0].into_iter().map(|m| m * power).find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

fn angle_step(span: f64, most: usize) -> f64 {
    let fits = |step: &f64| span / step < most.max(1) as f64 + 1e-9;
    let turns = (0..12).flat_map(|power| [1.0, 2.0, 5.0].map(|m| 360.0 * m * 10f64.powi(power)));
    [10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0].into_iter().chain(turns).find(fits).unwrap_or(span)
}

/// Marks of a logarithmic axis: labelled decades and light lines between; round numbers where it spans less than a decade or so.
pub(super) fn log(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let (first, last) = ((low.log10() - 1e-9).ceil() as i32, (high.log10() + 1e-9).floor() as i32);
    if last - first < 1 {
        return linear(low, high, most.min(5), false);
    }
    let every = ((last - first) as usize / most.max(1) + 1) as i32;
    // One way of writing for all marks of an axis.
    let plain = first >= -3 && last <= 4;
    let mut ticks = Vec::new();
    for power in first - 1..=last {
        let decade = 10f64.powi(power);
        if power >= first {
            let label = match power {
                _ if (power - first) % every != 0 => String::new(),
                _ if plain => super::number(decade),
                _ => format!("10{}", superscript(power)),
            };
            ticks.push(Tick { at: decade, label });
        }
        if last - first <= 4 {
            let minor = (2..10).map(|m| f64::from(m) * decade).filter(|at| (low..=high).contains(at));
            ticks.extend(minor.map(|at| Tick { at, label: String::new() }));
        }
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &[Tick]) -> Vec<&str> {
        ticks.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn marks_are_round_and_print_round() {
        assert_eq!(labels(&linear(0.0, 0.5, 5, false)), ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(labels(&linear(-1.05, 1.05, 5, false)), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(&linear(0.0, 10.0, 4, false)), ["0.0", "2.5", "5.0", "7.5", "10.0"]);
        assert_eq!(labels(&linear(1e-7, 5e-7, 5, false)).first(), Some(&"0.0000001"));
        assert_eq!(labels(&linear(1.5, 3.4, 1, false)), ["2", "3"], "one mark would be no scale");
        assert!(linear(3.0, 3.0, 5, false).is_empty());
        assert!(linear(f64::NAN, 3.0, 5, false).is_empty());
    }

    #[test]
    fn a_turn_is_marked_in_eighths() {
        let turn = std::f64::consts::TAU * (180.0 / std::f64::consts::PI);
        assert_eq!(labels(&linear(0.0, turn, 9, true)), ["0", "45", "90", "135", "180", "225", "270", "315", "360"]);
        assert_eq!(labels(&linear(0.0, 3600.0, 9, true)), ["0", "720", "1440", "2160", "2880", "3600"]);
    }

    #[test]
    fn decades_are_labelled() {
        let ticks = log(1e-9, 1e-3, 9);
        assert_eq!(labels(&ticks)[..2], ["10⁻⁹", "10⁻⁸"]);
        let ticks = log(0.5, 200.0, 9);
        let major: Vec<_> = ticks.iter().filter(|tick| !tick.label.is_empty()).map(|tick| tick.label.as_str()).collect();
        assert_eq!(major, ["1", "10", "100"]);
        assert!(log(2.0, 3.0, 9).len() > 3, "less than a decade falls back to round numbers");
    }
}
