//! Nothing allocates after construction.

use allocation_counter::measure;
use grashof_solvers::{Kkt, Lu};

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

        for mut kkt in [Kkt::new(n, n), Kkt::determinate(n)] {
            let (metric, scale) = (vec![2.0; n], vec![0.5; n]);
            let (f, gamma, mut a, mut lambda) = (vec![1.0; n], vec![2.0; n], vec![0.0; n], vec![0.0; n]);
            let info = measure(|| {
                kkt.set_scale(&metric, &scale);
                kkt.factor(&matrix, &matrix).unwrap();
                kkt.solve(&f, &gamma, &mut a, &mut lambda);
                kkt.smallest_singular_value(&mut left);
            });
            assert_eq!(info.count_total, 0, "order {n}");
        }
    }
}
