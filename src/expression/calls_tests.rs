use super::super::parse;
use super::*;
use crate::expression::external::MOST_ARGUMENTS;
use crate::scalar::{Dual, Scalar};

/// A pool in which `wave` is sin(2 x) y, by its values.
fn pool(wave: ExternalFunction) -> Pool {
    Pool::with_externals(Arc::new([wave]))
}

fn wave() -> ExternalFunction {
    ExternalFunction::new("wave", &["x", "y"], |a| (2.0 * a[0]).sin() * a[1])
}

/// The same as a node.
fn built_in(p: &mut Pool, x: Id, y: Id) -> Id {
    let two = p.constant(2.0);
    let angle = p.mul(two, x);
    let sine = p.sin(angle);
    p.mul(sine, y)
}

fn evaluate<S: Scalar>(p: &Pool, outputs: &[Id], inputs: &[S]) -> Vec<S> {
    let program = p.program(outputs, &[], &Arc::from([]));
    let (mut registers, mut found) = (vec![S::default(); program.registers()], vec![S::default(); outputs.len()]);
    program.eval(inputs, &vec![0; p.switches().len()], &mut registers, &mut found);
    found
}

#[test]
fn values_rates_and_derivatives_are_those_of_the_function() {
    for (function, exact) in
        [(wave(), false), (wave().slope("x", |a| 2.0 * (2.0 * a[0]).cos() * a[1]).slope("y", |a| (2.0 * a[0]).sin()), true)]
    {
        let mut p = pool(function);
        let [x, y] = [p.input(0), p.input(1)];
        let call = p.call(0, &[x, y]);
        let node = built_in(&mut p, x, y);
        // x' = 1, y' = y: rates up to the second, whose derivatives are third ones
        let mut leaf = |p: &mut Pool, i: u32| Some(if i == 0 { p.constant(1.0) } else { p.input(1) });
        let mut outputs = vec![call, node];
        for k in 0..4 {
            let rate = p.rate(outputs[k], &mut leaf).unwrap();
            outputs.push(rate);
        }
        for [x, y] in [[0.3, 0.7], [-41.0, 2.0], [1e-3, -5.0]] {
            let found = evaluate(&p, &outputs, &[Dual { x, d: [1.0, 0.0] }, Dual { x: y, d: [0.0, 1.0] }]);
            for (order, pair) in found.chunks(2).enumerate() {
                // each difference of a difference loses some digits
                let within = [1e-12, 1e-9, 1e-6][order] * if exact { 1e-2 } else { 1.0 };
                let numbers = |d: Dual<2>| [d.x, d.d[0], d.d[1]];
                for (place, (a, b)) in numbers(pair[0]).into_iter().zip(numbers(pair[1])).enumerate() {
                    let within = if place == 0 { within } else { 1e3 * within };
                    assert!((a - b).abs() <= within * (1.0 + b.abs()), "order {order}, {a} and {b} at {x}, {y}");
                }
            }
        }
    }
}

#[test]
fn what_is_undefined_passes_through_a_call_and_is_named() {
    let mut p = pool(ExternalFunction::new("root", &["x", "y"], |a| a[0].sqrt() + a[1]));
    let [x, y] = [p.input(0), p.input(1)];
    let inverse = {
        let one = p.constant(1.0);
        p.div(one, y)
    };
    let call = p.call(0, &[inverse, x]);
    let program = p.program(&[call], &[], &Arc::from([]));
    let cause = |x: f64, y: f64| program.cause(0, &[x, y], &[]);
    assert_eq!(cause(1.0, 4.0), None);
    assert_eq!(cause(1.0, 0.0), Some(super::super::Cause::Zero));
    assert_eq!(cause(1.0, -4.0), Some(super::super::Cause::External { function: 0, x: -0.25 }));
    assert_eq!(cause(f64::NAN, 4.0), Some(super::super::Cause::Input(0)));
    let constant = p.constant(4.0);
    let call = p.call(0, &[constant, constant]);
    assert_eq!(p.value(call, &[]), 6.0);
    assert!(evaluate(&p, &[call], &[0.0])[0] == 6.0);
}

/// Names of one input.
struct Names;

impl Scope for Names {
    fn name(&mut self, pool: &mut Pool, _: &str) -> Result<Symbol, Unknown> {
        Ok(Symbol { id: pool.input(0), dimension: Dimension::LENGTH })
    }
    fn has_value(&self, _: &str) -> bool {
        false
    }
    fn external(&mut self, name: &str) -> Option<u32> {
        (name == "stop").then_some(0)
    }
    fn enter_functional(&mut self, _: &str) -> Result<(), Unknown> {
        Ok(())
    }
    fn functional(&mut self, pool: &mut Pool, _: &str, _: Lowered, _: Option<Lowered>, _: &str) -> Result<Symbol, Unknown> {
        self.name(pool, "")
    }
}

fn lowered(p: &mut Pool, text: &str) -> Result<Lowered, Vec<String>> {
    lower(p, &parse(text).unwrap(), text, &mut Names).map_err(|faults| faults.into_iter().map(|f| f.found).collect())
}

#[test]
fn sides_of_switches_are_arguments_that_modes_decide() {
    let stop = ExternalFunction::new("stop", &["x"], |a| if a[1] != 0.0 { 1e6 * (a[0] - 0.002) } else { 0.0 });
    let mut p = pool(stop.unit("kN").switches(&[("beyond", "x > 2 mm")]));
    let call = lowered(&mut p, "stop(length)").unwrap();
    assert_eq!((call.dimension, call.bare), (Dimension::FORCE, false));
    assert_eq!(p.switches().iter().map(|s| s.text.as_str()).collect::<Vec<_>>(), ["x > 2 mm"]);
    let program = p.program(&[call.id], &[], &Arc::from([]));
    let (mut registers, mut out) = (vec![0.0; program.registers()], [0.0]);
    for (x, mode, force) in [(0.003, 1, 1e6), (0.001, 1, -1e6), (0.003, 0, 0.0)] {
        program.eval(&[x], &[mode], &mut registers, &mut out);
        assert!((out[0] - force).abs() < 1e-6, "{out:?}");
    }
    // a switch has bounds where it depends on one input, what comes from outside has none
    assert!(program.part(super::super::Wanted::Output(0), &[0]).is_none());
    assert!(program.part(super::super::Wanted::Switch(0), &[0]).is_some());
    assert_eq!(lowered(&mut p, "stop(length, 1)"), Err(vec!["2 arguments".to_owned()]));
    assert_eq!(lowered(&mut p, "stop(length^2)").unwrap_err().len(), 1);
}

#[test]
fn faults_of_functions_are_told() {
    let of = |f: ExternalFunction| f.fault().map(|(message, _)| message).unwrap_or_default();
    assert_eq!(of(wave()), "");
    assert!(of(ExternalFunction::new("f", &[], |_| 0.0)).contains("no argument"));
    assert!(of(wave().unit("newtons")).contains("newtons"));
    assert!(of(wave().switches(&[("far", "x >")])).contains("x >"));
    assert!(of(ExternalFunction::new("f", &["x"; MOST_ARGUMENTS + 1], |_| 0.0)).contains("more than"));
}
