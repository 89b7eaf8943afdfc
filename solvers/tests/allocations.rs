//! Nothing allocates after construction.

use allocation_counter::measure;
use grashof_solvers::{Factor, Kkt, Lu, Number, Sparsity};
use nalgebra::Complex;

#[test]
fn factorisations_and_solutions_allocate_nothing() {
    for n in [1, 3, 6, 12, 30] {
        let matrix: Vec<f64> = (0..n * n).map(|k| if k % (n + 1) == 0 { 3.0 } else { 1.0 / (1 + k) as f64 }).collect();
        let (mut b, mut left, mut right) = (vec![1.0; n], vec![0.0; n], vec![0.0; n]);
        let mut lu = Lu::new(n);
        let info = measure(|| {
            lu.factor(&matrix).unwrap();
            lu.solve(&mut b);
            lu.solve_transposed(&mut b);
            assert!(lu.smallest_singular_value(2, &mut left, &mut right) > 0.0);
            assert!(lu.pivot_ratio() > 0.0);
        });
        assert_eq!(info.count_total, 0, "order {n}");

        let mut kkt = Kkt::new(n, n);
        let (metric, scale) = (vec![2.0; n], vec![0.5; n]);
        let (f, gamma, mut a, mut lambda) = (vec![1.0; n], vec![2.0; n], vec![0.0; n], vec![0.0; n]);
        // the first factorisation makes room
        kkt.factor(&matrix, &matrix).unwrap();
        let info = measure(|| {
            kkt.set_scale(&metric, &scale);
            kkt.factor(&matrix, &matrix).unwrap();
            kkt.solve(&f, &gamma, &mut a, &mut lambda);
            kkt.smallest_singular_values(&mut left, &mut [0.0]);
        });
        assert_eq!(info.count_total, 0, "order {n}");
    }
}

/// Factors and solves with a chain of 2 × 2 blocks [2 1; 1 −1e-8] whose neighbours are coupled.
fn factor_chain<T: Number>(unit: T) {
    for n in [4, 12, 40, 200] {
        let entries = (0..n).flat_map(|i: usize| [(i, i), (i, i ^ 1), (i, i.wrapping_sub(2)), (i, i + 2)]);
        let pattern = Sparsity::new(n, n, entries);
        let value = |i: usize, j: usize| match (i == j, i % 2) {
            (true, 0) => 2.0,
            (true, _) => -1e-8,
            _ => {
                if i ^ 1 == j {
                    1.0
                } else {
                    0.1
                }
            }
        };
        let places: Vec<_> = pattern.transposed().places().map(|(j, i)| (i, j)).collect();
        let mut values: Vec<T> = places.iter().map(|&(i, j)| T::from(value(i, j)) * unit).collect();
        for mut factor in [Factor::new(&pattern), Factor::dense(&pattern), Factor::sparse(&pattern)] {
            let mut b = vec![unit; n];
            factor.factor(&values).unwrap();
            let info = measure(|| {
                for step in 1..5 {
                    values.iter_mut().for_each(|x| *x *= T::from(1.0 + 0.1 / step as f64));
                    factor.factor(&values).unwrap();
                    factor.solve(&mut b);
                }
            });
            assert_eq!(info.count_total, 0, "order {n}, {factor:?}");
        }
    }
}

#[test]
fn factorisations_with_known_pivots_allocate_nothing() {
    factor_chain(1.0);
    factor_chain(Complex::new(1.0, 0.5));
}
