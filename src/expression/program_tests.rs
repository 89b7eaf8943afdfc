use super::super::{Between, Beyond, Compare, Id, Pool};
use super::*;
use crate::scalar::Dual;

fn tables() -> Arc<[LookupTable]> {
    Arc::new([LookupTable::new(&[(0.0, 1.0), (1.0, 3.0), (2.0, 2.0), (4.0, 2.5)], Between::Cubic, Beyond::Linear).unwrap()])
}

/// Outputs, modes and roots at `inputs`.
fn run(p: &Pool, outputs: &[Id], parameters: &[f64], inputs: &[f64]) -> (Vec<f64>, Vec<i32>, Vec<f64>) {
    let program = p.program(outputs, parameters, &tables());
    let mut registers = vec![f64::NAN; program.registers()];
    let mut modes = vec![9; p.switches().len()];
    let (mut values, mut roots) = (vec![0.0; outputs.len()], vec![0.0; program.switches().len()]);
    program.set_modes(inputs, &mut registers, &mut modes);
    registers.fill(f64::NAN);
    program.eval(inputs, &modes, &mut registers, &mut values);
    program.roots(inputs, &modes, &mut registers, &mut roots);
    (values, modes, roots)
}

/// One of everything, of two leaves.
fn everything(p: &mut Pool, x: Id, y: Id) -> Vec<Id> {
    let (two, half) = (p.constant(2.0), p.constant(0.5));
    let less = p.compare(Compare::Less, x, y, "x < y");
    let equal = p.compare(Compare::Equal, x, half, "x == 0.5");
    let unequal = p.compare(Compare::NotEqual, x, y, "x != y");
    let more = p.compare(Compare::GreaterEqual, x, half, "x >= 0.5");
    let bent = p.table(0, 0, x, "f(x)");
    let undefined = p.ln(x);
    let small = p.mul(x, half);
    vec![
        p.neg(x),
        p.add(x, y),
        p.sub(x, y),
        p.sub(two, x),
        p.mul(x, y),
        p.mul(two, x),
        p.div(x, y),
        p.div(two, x),
        p.powi(x, 3),
        p.powi(x, -2),
        p.pow(x, half),
        p.pow(two, x),
        p.sin(x),
        p.cos(x),
        p.sin(y),
        p.cos(y),
        p.tan(x),
        p.asin(small),
        p.acos(small),
        p.atan(x),
        p.atan2(x, y),
        p.sqrt(x),
        p.exp(x),
        undefined,
        less,
        equal,
        unequal,
        more,
        p.and(less, more),
        p.or(less, equal),
        p.not(more),
        p.choose(less, x, undefined),
        p.abs(x, "abs(x)"),
        p.sign(y, "sign(y)"),
        p.min(x, y, "min(x, y)"),
        p.max(x, y, "max(x, y)"),
        p.clamp(x, half, y, "clamp(x)"),
        p.log10(x),
        p.sinh(x),
        p.cosh(y),
        p.tanh(x),
        p.hypot(x, y),
        p.floor(x, "floor(x)"),
        p.ceil(x, "ceil(x)"),
        p.round(x, "round(x)"),
        p.modulo(y, two, "mod(y, 2)"),
        bent,
        p.table(0, 1, x, "f'"),
        p.table(0, 2, x, "f''"),
    ]
}

#[test]
fn a_program_computes_what_the_pool_computes() {
    let mut p = Pool::new();
    let (x, y) = (p.input(0), p.input(3));
    let moving = everything(&mut p, x, y);
    let (a, b) = (p.parameter(0), p.parameter(1));
    let fixed = everything(&mut p, a, b);
    for (x, y) in [(0.3, 1.2), (1.7, -0.4), (0.5, 0.5), (1.2, 0.5), (0.0, 1.0), (-0.6, 0.2)] {
        let (moved, ..) = run(&p, &moving, &[], &[x, f64::NAN, f64::NAN, y]);
        let (folded, ..) = run(&p, &fixed, &[x, y], &[]);
        let plain = p.values_with_tables(&fixed, &[x, y], &tables());
        assert_eq!(p.program(&fixed, &[x, y], &tables()).switches(), &[] as &[u32]);
        for i in 0..plain.len() {
            let same = |a: f64, b: f64| a == b || (a.is_nan() && b.is_nan());
            assert!(same(plain[i], folded[i]), "{:?} of {x}, {y}: {} {}", p.node(fixed[i]), plain[i], folded[i]);
            assert!(same(plain[i], moved[i]) || (plain[i] - moved[i]).abs() < 1e-14, "{:?}: {} {}", p.node(moving[i]), plain[i], moved[i]);
        }
    }
}

#[test]
fn duals_through_a_program_are_difference_quotients() {
    let mut p = Pool::new();
    let (x, y) = (p.input(0), p.input(1));
    let outputs = everything(&mut p, x, y);
    let program = p.program(&outputs, &[], &tables());
    let at = [0.7, 1.3];
    let (_, modes, _) = run(&p, &outputs, &[], &at);
    let mut duals = vec![Dual::<2>::default(); outputs.len()];
    let inputs = [Dual::variable(at[0], 0), Dual::variable(at[1], 1)];
    program.eval(&inputs, &modes, &mut vec![Dual::default(); program.registers()], &mut duals);
    for direction in 0..2 {
        let [above, below] = [1e-6, -1e-6].map(|h| {
            let mut shifted = at;
            shifted[direction] += h;
            run(&p, &outputs, &[], &shifted).0
        });
        for (i, dual) in duals.iter().enumerate() {
            let quotient = (above[i] - below[i]) / 2e-6;
            assert!(
                (dual.d[direction] - quotient).abs() < 1e-7 * (1.0 + quotient.abs()),
                "{:?}: {} {quotient}",
                p.node(outputs[i]),
                dual.d[direction]
            );
        }
    }
}

#[test]
fn roots_are_positive_in_the_mode_that_was_set() {
    let mut p = Pool::new();
    let (x, y) = (p.input(0), p.input(1));
    let outputs = everything(&mut p, x, y);
    let program = p.program(&outputs, &[], &tables());
    for at in [[0.3, 1.2], [1.7, -0.4], [-0.6, 0.2], [4.4, 9.0]] {
        let (_, mut modes, roots) = run(&p, &outputs, &[], &at);
        assert_eq!(roots.len(), program.switches().len());
        assert!(roots.iter().all(|root| *root > 0.0), "{roots:?}");
        // on the other side of any switch its root is negative, but for segments by the same distance
        let mut registers = vec![0.0; program.registers()];
        let mut again = roots.clone();
        for k in 0..roots.len() {
            let switch = program.switches()[k] as usize;
            program.roots(&at, &modes, &mut registers, &mut again);
            let (before, other) = (modes[switch], program.neighbour(k, &modes, &registers));
            modes[switch] = other;
            program.roots(&at, &modes, &mut registers, &mut again);
            let segment = matches!(p.switches()[switch].test, Test::Segment { .. } | Test::Whole(_));
            let same = (again[k] + roots[k]).abs() < 1e-12;
            assert!(again[k] < 0.0 && (segment || same) && other != before, "{}", p.switches()[switch].text);
            modes[switch] = before;
        }
    }
    let (_, _, roots) = run(&p, &outputs, &[], &[0.5, 0.5]);
    assert!(roots.contains(&0.0) && roots.iter().all(|root| *root >= 0.0));
}

#[test]
fn switches_hold_their_branch_until_modes_are_set() {
    let mut p = Pool::new();
    let (x, zero) = (p.input(0), p.constant(0.0));
    let outputs = [p.abs(x, "abs(x)"), p.max(x, zero, "max(x, 0)")];
    let program = p.program(&outputs, &[], &tables());
    let (mut registers, mut modes, mut values) = (vec![0.0; program.registers()], vec![0; 2], [0.0; 2]);
    program.set_modes(&[1.0], &mut registers, &mut modes);
    program.eval(&[-0.1], &modes, &mut registers, &mut values);
    assert_eq!(values, [-0.1, -0.1]);
}

#[test]
fn what_a_branch_does_not_define_is_that_of_its_values() {
    let mut p = Pool::new();
    let (x, zero, power) = (p.input(0), p.constant(0.0), p.constant(1.5));
    let positive = p.max(x, zero, "max(x, 0)");
    let size = p.abs(x, "abs(x)");
    let outputs = [p.sqrt(positive), p.pow(size, power), p.sqrt(x), size];
    let program = p.program(&outputs, &[], &tables());
    let (mut registers, mut modes, mut values) = (vec![0.0; program.registers()], vec![0; p.switches().len()], [0.0; 4]);
    program.set_modes(&[1.0], &mut registers, &mut modes);
    program.eval(&[-4.0], &modes, &mut registers, &mut values);
    // what is defined stays in its branch, and what is undefined by itself is so
    assert_eq!([values[0], values[1], values[3]], [0.0, 8.0, -4.0]);
    assert!(values[2].is_nan());
    let mut dual = [Dual::<1>::default(); 4];
    program.eval(&[Dual::variable(-4.0, 0)], &modes, &mut vec![Dual::default(); program.registers()], &mut dual);
    assert_eq!((dual[0].x, dual[1].x, dual[1].d[0]), (0.0, 8.0, -3.0));
}

#[test]
fn an_undefined_value_that_is_not_taken_does_no_harm() {
    let mut p = Pool::new();
    let (x, zero) = (p.input(0), p.constant(0.0));
    let ln = p.ln(x);
    let kinked = p.abs(ln, "abs(log(x))");
    let positive = p.compare(Compare::Greater, x, zero, "x > 0");
    let chosen = p.choose(positive, kinked, zero);
    let (values, _, roots) = run(&p, &[chosen], &[], &[-1.0]);
    assert_eq!(values, [0.0]);
    assert!(roots.iter().all(|root| root.is_finite() && *root > 0.0));
    let program = p.program(&[chosen], &[], &tables());
    let mut dual = [Dual::<1>::default()];
    program.eval(&[Dual::variable(-1.0, 0)], &[0, 0], &mut vec![Dual::default(); program.registers()], &mut dual);
    assert_eq!((dual[0].x, dual[0].d[0]), (0.0, 0.0));
}

#[test]
fn parameters_decide_switches_away() {
    let mut p = Pool::new();
    let (x, k, one) = (p.input(0), p.parameter(0), p.constant(1.0));
    let large = p.compare(Compare::Greater, k, one, "k > 1");
    let kinked = p.abs(x, "abs(x)");
    let y = p.choose(large, x, kinked);
    let (off, on) = (p.program(&[y], &[2.0], &tables()), p.program(&[y], &[0.0], &tables()));
    assert_eq!((off.switches(), off.registers()), (&[] as &[u32], 1));
    assert_eq!(on.switches(), [1]);
    assert_eq!((on.inputs(), on.outputs()), (&[0][..], 1));
    let none = p.mul(x, k);
    assert_eq!(p.program(&[none], &[0.0], &tables()).inputs(), &[] as &[u32]);
}

#[test]
fn sine_and_cosine_of_an_angle_are_one_instruction() {
    let mut p = Pool::new();
    let x = p.input(0);
    let (s, c) = (p.sin(x), p.cos(x));
    let program = p.program(&[s, c, s], &[], &tables());
    assert_eq!(program.ops, [Op::Input(0), Op::SinCos(0)]);
    assert!(size_of::<Op>() <= 16);
}

#[test]
fn what_is_observed_has_no_magnitude_below_zero() {
    let mut p = Pool::new();
    let x = p.input(0);
    let size = p.abs(x, "|x|");
    let rate = p.rate(size, &mut |p, _| Some(p.constant(3.0))).unwrap();
    let program = p.program(&[size, rate], &[], &Arc::from([]));
    let (mut registers, mut out) = (vec![0.0; program.registers()], [0.0; 2]);
    // beyond the switch by rounding: the rate stays that of the mode
    program.eval(&[-1e-17], &[1], &mut registers, &mut out);
    assert_eq!(out, [-1e-17, 3.0]);
    program.observed().eval(&[-1e-17], &[1], &mut registers, &mut out);
    assert_eq!(out, [1e-17, 3.0]);
}
