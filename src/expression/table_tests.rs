use super::*;
use crate::scalar::Dual;
use std::f64::consts::TAU;

const POINTS: [(f64, f64); 6] = [(-1.0, 2.0), (0.0, 1.0), (0.5, 1.5), (2.0, -1.0), (3.0, 0.0), (4.5, 2.0)];

fn table(between: Between, beyond: Beyond) -> LookupTable {
    LookupTable::new(&POINTS, between, beyond).unwrap()
}

#[test]
fn tables_go_through_their_points() {
    for between in [Between::Linear, Between::Cubic] {
        for beyond in [Beyond::Constant, Beyond::Linear, Beyond::Error, Beyond::Periodic] {
            for (x, y) in POINTS {
                assert!((table(between, beyond).value(x) - y).abs() < 1e-14);
            }
        }
    }
    assert_eq!(table(Between::Linear, Beyond::Constant).value(1.25), 0.25);
}

#[test]
fn neighbouring_pieces_meet_smoothly() {
    for beyond in [Beyond::Constant, Beyond::Periodic] {
        let (linear, cubic) = (table(Between::Linear, beyond), table(Between::Cubic, beyond));
        for segment in 0..4 {
            let x = POINTS[segment as usize + 1].0;
            assert!((linear.eval(x, segment, 0) - linear.eval(x, segment + 1, 0)).abs() < 1e-14);
            for order in 0..3 {
                let (left, right) = (cubic.eval(x, segment, order), cubic.eval(x, segment + 1, order));
                assert!((left - right).abs() < 1e-12, "order {order} at {x}: {left} {right}");
            }
        }
    }
    let periodic = table(Between::Cubic, Beyond::Periodic);
    for order in 0..3 {
        assert!((periodic.eval(4.5, 4, order) - periodic.eval(4.5, 5, order)).abs() < 1e-12);
    }
}

#[test]
fn periodic_tables_repeat() {
    for between in [Between::Linear, Between::Cubic] {
        let t = table(between, Beyond::Periodic);
        for k in -3..4 {
            for x in [-0.9, 0.0, 1.7, 4.4] {
                assert!((t.value(x + 5.5 * f64::from(k)) - t.value(x)).abs() < 1e-13);
                assert_eq!(t.segment(x + 5.5 * f64::from(k)), t.segment(x) + 5 * k);
            }
        }
    }
    for n in [2, 3, 8, 40] {
        let points: Vec<_> = (0..=n).map(|i| TAU * f64::from(i) / f64::from(n)).map(|x| (x, x.cos())).collect();
        let t = LookupTable::new(&points, Between::Cubic, Beyond::Periodic).unwrap();
        for order in 0..3 {
            let wrap = t.eval(TAU, n - 1, order) - t.eval(0.0, 0, order);
            assert!(wrap.abs() < 1e-12, "{n} points, order {order}: {wrap}");
        }
        let error = t.value(1.0) - 1.0_f64.cos();
        assert!(n < 8 || error.abs() < 2.0 / f64::from(n).powi(4) * 10.0, "{error}");
    }
}

#[test]
fn outside_of_the_points() {
    let constant = table(Between::Cubic, Beyond::Constant);
    assert_eq!((constant.value(-5.0), constant.value(9.0), constant.eval(9.0, 5, 1)), (2.0, 2.0, 0.0));
    for between in [Between::Linear, Between::Cubic] {
        let linear = table(between, Beyond::Linear);
        for (x, inner, outer) in [(-1.0, 0, -1), (4.5, 4, 5)] {
            for order in 0..2 {
                assert!((linear.eval(x, inner, order) - linear.eval(x, outer, order)).abs() < 1e-13);
            }
            assert_eq!(linear.eval(x, outer, 2), 0.0);
        }
    }
    let error = table(Between::Linear, Beyond::Error);
    assert!(error.value(4.6).is_nan() && error.eval(-2.0, -1, 1).is_nan() && error.eval(-2.0, -1, 2).is_nan());
    assert!(error.value(4.5) == 2.0 && error.value(-1.0) == 2.0);
}

#[test]
fn dual_numbers_give_the_slope() {
    for between in [Between::Linear, Between::Cubic] {
        let t = table(between, Beyond::Linear);
        for x in [-2.0, -0.3, 0.2, 1.1, 2.5, 4.0, 5.0] {
            let k = t.segment(x);
            for order in 0..3 {
                assert!((t.eval(Dual::<1>::variable(x, 0), k, order).d[0] - t.eval(x, k, order + 1)).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn segments_and_their_ends() {
    for beyond in [Beyond::Constant, Beyond::Periodic] {
        let t = table(Between::Linear, beyond);
        for x in [-7.3, -1.0, -0.5, 0.0, 0.3, 4.5, 4.6, 30.0] {
            let k = t.segment(x);
            let inside = t.inside(x, k);
            assert!(inside >= 0.0, "{x}");
            let next = t.neighbour(x, k);
            assert!(t.inside(x, next) < 0.0 || inside == 0.0, "{x}");
            assert!((next - k).abs() == 1);
        }
    }
    // near an end it is the distance from it
    let t = table(Between::Linear, Beyond::Constant);
    for (k, low) in t.x.iter().enumerate() {
        let inside = t.inside(low + 1e-7, k as i32);
        assert!((inside - 1e-7).abs() < 1e-13, "{low}: {inside}");
    }
    assert_eq!([-1.5, -1.0, 0.0, 4.5, 4.6].map(|x| table(Between::Linear, Beyond::Constant).segment(x)), [-1, 0, 1, 4, 5]);
}

#[test]
fn points_that_make_no_table() {
    let new = |points: &[(f64, f64)], beyond| LookupTable::new(points, Between::Linear, beyond);
    assert_eq!(new(&[(0.0, 1.0)], Beyond::Constant), Err(TableError::TooFew(1)));
    assert_eq!(new(&[(0.0, 1.0), (1.0, 0.0), (1.0, 2.0)], Beyond::Constant), Err(TableError::NotRising(2)));
    assert_eq!(new(&[(0.0, 1.0), (f64::NAN, 0.0)], Beyond::Constant), Err(TableError::NotFinite(1)));
    assert_eq!(new(&[(0.0, 1.0), (1.0, 0.0)], Beyond::Periodic), Err(TableError::EndsDiffer(1.0, 0.0)));
    assert!(TableError::NotRising(2).to_string().contains("point 3"));
}

#[test]
fn no_argument_panics() {
    for beyond in [Beyond::Constant, Beyond::Linear, Beyond::Error, Beyond::Periodic] {
        let t = table(Between::Cubic, beyond);
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300, 1e9] {
            let k = t.segment(x);
            let _ = (t.value(x), t.inside(x, k), t.neighbour(x, k));
        }
        for k in [i32::MIN, i32::MAX] {
            let _ = (t.eval(0.0, k, 9), t.inside(0.0, k), t.neighbour(0.0, k));
        }
    }
}
