//! Extremes, means and integrals of a study against those of a dense table of its own formula.

use super::formula::{Formula, Trace, names};
use super::{cases, seeded, tell};
use crate::common::study;
use grashof::mechanism::Coordinates;

const NAMES: usize = 3;
const UNTIL: f64 = 2.0;
/// Switches of a formula.
const SWITCHES: usize = 4;
/// Points of the dense table.
const DENSE: usize = 4000;

/// The values of a formula at equal distances; none if it is undefined or jumps, or hardly varies.
fn table(formula: &Formula, given: &[f64]) -> Option<Vec<f64>> {
    let at = |k: usize| {
        let mut trace = Trace::default();
        let value = formula.value(&[&[UNTIL * k as f64 / DENSE as f64], given].concat(), &mut trace);
        (value.is_finite() && trace.largest < 1e4).then_some(value)
    };
    let values: Option<Vec<f64>> = (0..=DENSE).map(at).collect();
    values.filter(|values| {
        let range = values.iter().fold(f64::MIN, |m, x| m.max(*x)) - values.iter().fold(f64::MAX, |m, x| m.min(*x));
        let step = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
        let turns = values.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
        range > 1e-3 && step < 0.01 * range && turns <= 12
    })
}

#[test]
fn extremes_are_those_of_the_motion_and_not_of_its_samples() {
    let wanted = cases(60);
    let mut dice = seeded(0xE87E_ED5E);
    let mut compared = 0;
    while compared < wanted {
        let given = names(&mut dice, NAMES - 1);
        let formula = Formula::random(&mut dice, NAMES, 4);
        let samples = [1, 7, 60][dice.next(3)];
        // an angle jumps at half a turn: there one side is as good as the other, and a switch of it has the value of the wrong one
        if formula.switches() > SWITCHES || formula.text().contains("atan2") {
            continue;
        }
        let Some(values) = table(&formula, &given) else { continue };
        // a value that the formula has at one end alone, as atan2(x, x) at 0, is none of the motion
        let alone = |a: f64, b: f64, c: f64| (a - b).abs() > 3.0 * (b - c).abs() + 1e-9;
        if alone(values[0], values[1], values[2]) || alone(values[DENSE], values[DENSE - 1], values[DENSE - 2]) {
            continue;
        }
        let text = format!(
            "grashof: 1\nname: extremes\nspace: planar\ngravity: none\nparameters: {{ p1: {}, p2: {} }}\nbodies: {{ block: {{}} }}\n\
             joints: {{ S: {{ slider: [ground, block.origin] }} }}\ndrivers: {{ drive: {{ joint: S, speed: 1 m/s }} }}\n\
             measures:\n  p0: S.position/(1 m)\n  x: {}\n\
             studies:\n  move:\n    kinematics: {{ over: {UNTIL} s, samples: {samples} }}\n    columns: [time, x]\n\
             \x20   scalars: {{ most: max(x), least: min(x), middle: mean(x), area: integral(x) }}\n",
            given[0],
            given[1],
            formula.text()
        );
        let outcome = study(&text, "move", Coordinates::Joint);
        let most = values.iter().fold(f64::MIN, |m, x| m.max(*x));
        let least = values.iter().fold(f64::MAX, |m, x| m.min(*x));
        let inner: f64 = values[1..DENSE].iter().sum();
        let sum = (inner + 0.5 * (values[0] + values[DENSE])) * UNTIL / DENSE as f64;
        // between two points of the table the value can pass their larger one by half of their difference
        let step = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
        let size = 1.0 + most.abs().max(least.abs());
        let [found_most, found_least, mean, integral] = outcome.scalars[..] else { panic!("{:?}", outcome.scalars) };
        let within = |what: &str, found: f64, low: f64, high: f64| {
            assert!(found >= low - 1e-8 * size && found <= high + 1e-8 * size, "{what}: {found} is not within {low} and {high}\n{text}");
        };
        within("max", found_most, most, most + step);
        within("min", found_least, least - step, least);
        // the trapezoidal rule is off by a twelfth of the second differences, by an eighth of that of a kink
        let bend = values.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).fold(0.0, f64::max);
        let off = UNTIL * bend;
        within("integral", integral, sum - off, sum + off);
        within("mean", mean, (sum - off) / UNTIL, (sum + off) / UNTIL);
        compared += 1;
    }
    tell(&format!("extremes: {compared} formulas, four figures each; 0 findings"));
}
