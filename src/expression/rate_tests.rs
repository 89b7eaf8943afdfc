use super::super::{Between, Beyond, Compare, LookupTable};
use super::*;
use std::sync::Arc;

/// Values at x, with modes as they are at x₀.
fn values(p: &Pool, ids: &[Id], x0: &[f64], x: &[f64]) -> Vec<f64> {
    let tables: Arc<[LookupTable]> =
        Arc::new([LookupTable::new(&[(0.0, 1.0), (1.0, 3.0), (2.0, 2.0), (4.0, 2.5)], Between::Cubic, Beyond::Constant).unwrap()]);
    let program = p.program(ids, &[1.7], &tables);
    let (mut registers, mut modes) = (vec![0.0; program.registers()], vec![0; p.switches().len()]);
    let mut outputs = vec![0.0; ids.len()];
    program.set_modes(x0, &mut registers, &mut modes);
    program.eval(x, &modes, &mut registers, &mut outputs);
    outputs
}

/// Inputs 0, 1: x, y; 2, 3: their rates; 4, 5: their second rates, which have none.
fn leaf(p: &mut Pool, input: u32) -> Option<Id> {
    (input < 4).then(|| p.input(input + 2))
}

#[test]
fn rates_are_difference_quotients_to_second_order() {
    let mut p = Pool::new();
    let (x, y, k) = (p.input(0), p.input(1), p.parameter(0));
    let (two, tenth) = (p.constant(2.0), p.constant(0.1));
    let less = p.compare(Compare::Less, x, y, "");
    let (product, sum, small) = (p.mul(x, y), p.add(x, y), p.mul(x, tenth));
    let functions = [
        p.neg(x),
        sum,
        p.sub(x, y),
        product,
        p.mul(k, x),
        p.mul(x, x),
        p.div(x, y),
        p.div(two, x),
        p.div(x, k),
        p.powi(x, 3),
        p.powi(x, -2),
        p.pow(x, k),
        p.pow(k, x),
        p.pow(x, y),
        p.sin(product),
        p.cos(sum),
        p.tan(x),
        p.asin(small),
        p.acos(small),
        p.atan(x),
        p.atan2(x, y),
        p.atan2(two, x),
        p.sqrt(sum),
        p.exp(x),
        p.ln(sum),
        p.log10(sum),
        p.sinh(x),
        p.cosh(product),
        p.tanh(product),
        p.hypot(x, y),
        p.floor(sum, ""),
        p.round(product, ""),
        p.modulo(sum, x, ""),
        p.abs(product, ""),
        p.min(product, sum, ""),
        p.max(product, sum, ""),
        p.clamp(product, tenth, sum, ""),
        p.choose(less, product, sum),
        p.table(0, 0, product, ""),
        p.table(0, 1, x, ""),
        p.sign(x, ""),
    ];
    for f in functions {
        let first = p.rate(f, &mut leaf).unwrap();
        let second = p.rate(first, &mut leaf).unwrap();
        // x = 0.8 + 0.7 t + 0.2 t², y = 1.1 − 0.3 t + 0.4 t²
        let at = |t: f64| [0.8 + 0.7 * t + 0.2 * t * t, 1.1 - 0.3 * t + 0.4 * t * t, 0.7 + 0.4 * t, -0.3 + 0.8 * t, 0.4, 0.8];
        for (value, rate) in [(f, first), (first, second)] {
            let h = 1e-5;
            let [above, below] = [h, -h].map(|t| values(&p, &[value], &at(0.0), &at(t))[0]);
            let exact = values(&p, &[rate], &at(0.0), &at(0.0))[0];
            let quotient = (above - below) / (2.0 * h);
            assert!((exact - quotient).abs() < 1e-8 * (1.0 + exact.abs()), "{:?}: {exact} {quotient}", p.node(f));
        }
    }
}

#[test]
fn a_rate_adds_no_switch() {
    let mut p = Pool::new();
    let (x, y) = (p.input(0), p.input(1));
    let low = p.min(x, y, "min(x, y)");
    let kinked = p.abs(low, "abs(..)");
    let bent = p.table(0, 0, kinked, "f(..)");
    let before = p.switches_of(&[bent]);
    let rate = p.rate(bent, &mut leaf).unwrap();
    assert_eq!((p.switches_of(&[rate]), p.switches().len()), (before, 3));
}

#[test]
fn what_does_not_move_has_rate_zero() {
    let mut p = Pool::new();
    let (k, x, y) = (p.parameter(0), p.input(0), p.input(1));
    let zero = p.constant(0.0);
    // no term of a wild slope times zero stays behind
    let wild = p.ln(k);
    let (root, quotient) = (p.sqrt(wild), p.div(k, wild));
    let angle = p.atan2(k, wild);
    let less = p.compare(Compare::Less, x, y, "");
    for id in [k, wild, root, quotient, angle, less, zero] {
        assert_eq!(p.rate(id, &mut leaf), Ok(zero));
    }
}

#[test]
fn an_input_without_rate_is_named() {
    let mut p = Pool::new();
    let (x, force) = (p.input(0), p.input(9));
    let power = p.mul(x, force);
    assert_eq!(p.rate(power, &mut leaf), Err(9));
}
