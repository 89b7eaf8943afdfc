//! The sparse factorisation against nalgebra's and against the dense form.

use super::*;
use crate::noise::Noise;
use crate::{Factor, Lu, Number, SparseLu, Sparsity};
use nalgebra::{Complex, ComplexField, DMatrix, DVector};
use std::collections::BTreeMap;

/// Entries by (column, row).
type Entries<T> = BTreeMap<(usize, usize), T>;

/// A number of the field of the test.
trait Random: Number + ComplexField<RealField = f64> {
    fn random(noise: &mut Noise) -> Self;
}

impl Random for f64 {
    fn random(noise: &mut Noise) -> Self {
        noise.next()
    }
}

impl Random for Complex<f64> {
    fn random(noise: &mut Noise) -> Self {
        Complex::new(noise.next(), noise.next())
    }
}

fn pattern<T>(n: usize, entries: &Entries<T>) -> Sparsity {
    Sparsity::new(n, n, entries.keys().map(|&(j, i)| (i, j)))
}

fn values<T: Number>(entries: &Entries<T>) -> Vec<T> {
    entries.values().copied().collect()
}

fn full<T: Random>(n: usize, entries: &Entries<T>) -> DMatrix<T> {
    let mut a = DMatrix::zeros(n, n);
    entries.iter().for_each(|(&(j, i), value)| a[(i, j)] = *value);
    a
}

/// [A Gᵀ; G −E]: `nv` unknowns with a few couplings each, unsymmetric, and `m` rows over a few unknowns each; E = 1e-8.
fn random_kkt<T: Random>(noise: &mut Noise, nv: usize, m: usize) -> Entries<T> {
    let place = |noise: &mut Noise| ((noise.next() + 1.0) * 0.5 * nv as f64) as usize % nv;
    let mut entries = Entries::new();
    for i in 0..nv {
        entries.insert((i, i), T::random(noise) + <T as From<f64>>::from(3.0));
        for _ in 0..2 {
            let j = place(noise);
            if i != j {
                entries.insert((i, j), T::random(noise));
                entries.insert((j, i), T::random(noise));
            }
        }
    }
    for row in nv..nv + m {
        entries.insert((row, row), <T as From<f64>>::from(-1e-8));
        // row k certainly has unknown k, so that the rows are independent
        for j in [row - nv, place(noise), place(noise), place(noise)] {
            let g = T::random(noise) + <T as From<f64>>::from(if j == row - nv { 3.0 } else { 0.0 });
            entries.insert((j, row), g);
            entries.insert((row, j), g);
        }
    }
    entries
}

/// A chain of planar bodies between two joints on the ground: x, y and angle of each body, two rows a joint.
fn chain<T: Random>(noise: &mut Noise, bodies: usize) -> (usize, Entries<T>) {
    let nv = 3 * bodies;
    let real = <T as From<f64>>::from;
    let mut entries = Entries::new();
    for body in 0..bodies {
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let mass = if i == j { 1.0 } else { 0.0 };
            entries.insert((3 * body + j, 3 * body + i), T::random(noise) * real(0.1) + real(mass));
        }
    }
    for joint in 0..=bodies {
        for axis in 0..2 {
            let row = nv + 2 * joint + axis;
            entries.insert((row, row), real(-1e-8));
            for (body, sign) in [(joint.wrapping_sub(1), 1.0), (joint, -1.0)] {
                if body < bodies {
                    let arm = T::random(noise);
                    for (j, g) in [(3 * body + axis, real(sign)), (3 * body + 2, arm)] {
                        entries.insert((j, row), g);
                        entries.insert((row, j), g);
                    }
                }
            }
        }
    }
    (nv + 2 * (bodies + 1), entries)
}

/// |x − y| / |y| for x by the factorisation and y by nalgebra.
fn error<T: Random>(factor: &mut Factor<T>, noise: &mut Noise, entries: &Entries<T>) -> f64 {
    let n = factor.order();
    let b = DVector::from_fn(n, |_, _| T::random(noise));
    let expected = full(n, entries).lu().solve(&b).unwrap();
    let mut x = b.as_slice().to_vec();
    factor.solve(&mut x);
    (DVector::from_vec(x) - &expected).norm() / expected.norm()
}

fn random_systems_agree<T: Random>() {
    let mut noise = Noise(41);
    for (nv, m) in [(20, 10), (30, 25), (60, 30), (100, 80), (250, 150)] {
        let entries: Entries<T> = random_kkt(&mut noise, nv, m);
        let pattern = pattern(nv + m, &entries);
        for mut factor in [Factor::sparse(&pattern), Factor::dense(&pattern), Factor::new(&pattern)] {
            factor.factor(&values(&entries)).unwrap();
            let error = error(&mut factor, &mut noise, &entries);
            assert!(error < 1e-10, "{nv} + {m}: {error:e}");
            // a second solution is not disturbed by the first
            let mut ones = full(nv + m, &entries) * DVector::from_element(nv + m, T::ONE);
            factor.solve(ones.as_mut_slice());
            assert!(ones.iter().all(|x| (*x - T::ONE).abs1() < 1e-10));
        }
    }
}

#[test]
fn random_real_systems_agree_with_nalgebra() {
    random_systems_agree::<f64>();
}

#[test]
fn random_complex_systems_agree_with_nalgebra() {
    random_systems_agree::<Complex<f64>>();
}

fn changed_values_agree<T: Random>() {
    let mut noise = Noise(43);
    let (nv, m) = (80, 60);
    let mut entries: Entries<T> = random_kkt(&mut noise, nv, m);
    let mut factor = Factor::sparse(&pattern(nv + m, &entries));
    factor.factor(&values(&entries)).unwrap();
    let fill = factor.fill();
    for step in 0..10 {
        entries.values_mut().for_each(|x| *x *= T::ONE + T::random(&mut noise) * <T as From<f64>>::from(0.05));
        factor.factor(&values(&entries)).unwrap();
        let error = error(&mut factor, &mut noise, &entries);
        assert!(error < 1e-10, "step {step}: {error:e}");
        assert_eq!(factor.fill(), fill, "pivots were kept");
    }
    // pivots of before vanish: what was small is large now and the other way round
    for round in 0..4 {
        entries.iter_mut().for_each(|(&(j, i), x)| {
            let small = i < nv && j < nv && (i + j + round) % 2 == 0;
            *x = T::random(&mut noise) * <T as From<f64>>::from(if small { 1e-9 } else { 1.0 });
        });
        factor.factor(&values(&entries)).unwrap();
        let a = full(nv + m, &entries);
        let b = DVector::from_fn(nv + m, |_, _| T::random(&mut noise));
        let mut x = b.clone();
        factor.solve(x.as_mut_slice());
        let residual = (&a * &x - &b).norm() / (a.norm() * x.norm());
        assert!(residual < 1e-14, "round {round}: {residual:e}");
    }
}

#[test]
fn changed_real_values_keep_pivots_or_not_and_agree() {
    changed_values_agree::<f64>();
}

#[test]
fn changed_complex_values_keep_pivots_or_not_and_agree() {
    changed_values_agree::<Complex<f64>>();
}

#[test]
fn small_full_systems_agree_with_nalgebra() {
    fn agree<T: Random>(noise: &mut Noise) {
        for n in 1..16 {
            let entries: Entries<T> = (0..n * n).map(|k| ((k / n, k % n), T::random(noise))).collect();
            for mut factor in [Factor::sparse(&Sparsity::dense(n, n)), Factor::dense(&Sparsity::dense(n, n))] {
                factor.factor(&values(&entries)).unwrap();
                assert!(error(&mut factor, noise, &entries) < 1e-10, "order {n}");
                assert_eq!((factor.order(), factor.fill()), (n, n * n));
            }
        }
    }
    agree::<f64>(&mut Noise(59));
    agree::<Complex<f64>>(&mut Noise(61));
}

#[test]
fn growth_under_kept_pivots_is_seen() {
    // in the order of elimination: 1 on the diagonal, −50 below, 1 in the last column: u doubles 5.7 times in every step
    let n = 12;
    let pattern = Sparsity::dense(n, n);
    let order = ordering::Ordering::minimum_degree(&pattern).order;
    let entries = |below: f64| -> Entries<f64> {
        let places = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let value = |i: usize, j: usize| {
            if i > j {
                below
            } else if i == j || j == n - 1 {
                1.0
            } else {
                0.0
            }
        };
        places.map(|(i, j)| ((order[j], order[i]), value(i, j))).collect()
    };
    let mut factor = Factor::sparse(&pattern);
    factor.factor(&values(&entries(-0.1))).unwrap();
    let hard = entries(-50.0);
    factor.factor(&values(&hard)).unwrap();
    let a = full(n, &hard);
    let b = DVector::from_vec(Noise(67).vector(n));
    let mut x = b.clone();
    factor.solve(x.as_mut_slice());
    assert!((&a * &x - &b).norm() < 1e-14 * a.norm() * x.norm());
}

#[test]
fn a_vanishing_pivot_is_replaced() {
    // a full block whose diagonal becomes tiny, beside a number so large that no growth in the block shows
    let places = (0..3).flat_map(|j| (0..3).map(move |i| (i, j)));
    let pattern = Sparsity::new(4, 4, places.chain([(3, 3)]));
    let mut lu = SparseLu::new(&pattern);
    lu.factor(&[4.0, 1.0, 0.0, 1.0, 4.0, 1.0, 0.0, 1.0, 4.0, 1e15]).unwrap();
    for tiny in [0.0, 1e-300, 1e-12] {
        lu.factor(&[tiny, 1.0, 2.0, 3.0, tiny, 1.0, 1.0, 5.0, tiny, 1e15]).unwrap();
        let mut b = [4.0, 6.0, 3.0, 1e15];
        lu.solve(&mut b);
        assert!(b.iter().all(|x| (x - 1.0).abs() < 1e-11), "{b:?}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused_wherever_they_are() {
    // block triangular: an entry above the diagonal that no pivot ever meets
    let pattern = Sparsity::new(2, 2, [(0, 0), (0, 1), (1, 1)]);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..3 {
            let mut values = [1.0; 3];
            values[place] = bad;
            let mut lu = SparseLu::new(&pattern);
            assert!(lu.factor(&values).is_err(), "{bad} at {place}");
            lu.factor(&[1.0; 3]).unwrap();
            assert!(lu.factor(&values).is_err(), "{bad} at {place} with known pivots");
        }
    }
}

#[test]
fn chains_fill_linearly() {
    let mut noise = Noise(47);
    for bodies in [4, 10, 40, 200] {
        let (n, entries) = chain::<f64>(&mut noise, bodies);
        let pattern = pattern(n, &entries);
        let mut factor = Factor::sparse(&pattern);
        factor.factor(&values(&entries)).unwrap();
        let fill = factor.fill();
        assert!(fill < 7 * n, "{n} unknowns: {fill} entries");
        if bodies < 100 {
            let error = error(&mut factor, &mut noise, &entries);
            assert!(error < 1e-10, "{n} unknowns: {error:e}");
        }
    }
}

#[test]
fn arrows_do_not_fill() {
    let n = 300;
    let entries: Entries<f64> = (0..n).flat_map(|i| [((i, i), 4.0), ((0, i), 0.1), ((i, 0), 0.2)]).collect();
    let mut factor = Factor::new(&pattern(n, &entries));
    factor.factor(&values(&entries)).unwrap();
    assert!(matches!(factor, Factor::Sparse(_)));
    assert_eq!(factor.fill(), 3 * n - 2);
    assert!(error(&mut factor, &mut Noise(2), &entries) < 1e-12);
    // a diagonal that is 0.075 of its columns: new pivots would leave it, kept ones stay
    let weak = |&(j, i): &(usize, usize)| match (j, i) {
        (0, _) => 0.003,
        (_, 0) => 0.2,
        _ => 0.015,
    };
    let entries: Entries<f64> = entries.keys().map(|place| (*place, weak(place))).collect();
    let mut fresh = Factor::sparse(&pattern(n, &entries));
    fresh.factor(&values(&entries)).unwrap();
    factor.factor(&values(&entries)).unwrap();
    assert_eq!(factor.fill(), 3 * n - 2);
    assert!(fresh.fill() > factor.fill());
    for mut factor in [factor, fresh] {
        assert!(error(&mut factor, &mut Noise(2), &entries) < 1e-10);
    }
}

#[test]
fn the_form_follows_the_pattern() {
    assert!(matches!(Factor::<f64>::new(&Sparsity::empty(0, 0)), Factor::Dense(_)));
    assert!(matches!(Factor::<f64>::new(&Sparsity::dense(60, 60)), Factor::Dense(_)));
    let diagonal = |n| Sparsity::new(n, n, (0..n).map(|i| (i, i)));
    assert!(matches!(Factor::<f64>::new(&diagonal(DENSE_UP_TO)), Factor::Dense(_)));
    assert!(matches!(Factor::<f64>::new(&diagonal(DENSE_UP_TO + 1)), Factor::Sparse(_)));
}

#[test]
fn what_is_singular_is_refused_and_forgotten() {
    let mut noise = Noise(53);
    let (nv, m) = (30, 20);
    let good: Entries<f64> = random_kkt(&mut noise, nv, m);
    let n = nv + m;
    let pattern = pattern(n, &good);
    for mut factor in [Factor::sparse(&pattern), Factor::dense(&pattern)] {
        for fresh in [true, false] {
            if !fresh {
                factor.factor(&values(&good)).unwrap();
            }
            let zero_column: Entries<f64> = good.iter().map(|(&(j, i), &x)| ((j, i), if j == 7 { 0.0 } else { x })).collect();
            assert!(factor.factor(&values(&zero_column)).is_err());
            assert!(matches!(factor, Factor::Dense(_)) || factor.fill() == 0, "no factorisation is left");
            let zero_row: Entries<f64> = good.iter().map(|(&(j, i), &x)| ((j, i), if i == 7 { 0.0 } else { x })).collect();
            assert!(factor.factor(&values(&zero_row)).is_err());
            for bad in [f64::NAN, f64::INFINITY] {
                for place in [0, 11, good.len() / 2, good.len() - 1] {
                    let mut values = values(&good);
                    values[place] = bad;
                    assert!(factor.factor(&values).is_err(), "{bad} at {place}");
                }
            }
            factor.factor(&values(&good)).unwrap();
            assert!(error(&mut factor, &mut noise, &good) < 1e-10);
        }
    }
}

#[test]
fn what_has_no_entries_to_pivot_on_is_refused() {
    // columns 0 and 1 share their only row
    let pattern = Sparsity::new(3, 3, [(0, 0), (0, 1), (1, 2), (2, 2)]);
    let mut lu = SparseLu::new(&pattern);
    assert!(lu.factor(&[1.0, 2.0, 3.0, 4.0]).is_err());
    let mut b = [1.0; 3];
    lu.solve(&mut b);
    assert!(b.iter().all(|x| x.is_nan()) && lu.fill() == 0);
    assert!(SparseLu::<f64>::new(&Sparsity::empty(2, 2)).factor(&[]).is_err());
    let mut nothing = SparseLu::<f64>::new(&Sparsity::empty(0, 0));
    nothing.factor(&[]).unwrap();
    nothing.solve(&mut []);
}

#[test]
fn permutations_are_solved_exactly() {
    let n = 40;
    let pattern = Sparsity::new(n, n, (0..n).map(|j| ((7 * j + 3) % n, j)));
    let mut lu = SparseLu::new(&pattern);
    for factor in [2.0, 4.0] {
        lu.factor(&vec![factor; n]).unwrap();
        let mut b: Vec<f64> = (0..n).map(|i| i as f64).collect();
        lu.solve(&mut b);
        assert!((0..n).all(|j| b[j] == ((7 * j + 3) % n) as f64 / factor));
        assert_eq!(lu.fill(), n);
    }
}

#[test]
fn rows_in_no_relation_to_columns_are_factored_without_much_fill() {
    // loops in a row: two rows each over the three unknowns of its own and the next one's first, in an order by chance
    let (mut noise, n) = (Noise(17), 120);
    let mut entries = Entries::<f64>::new();
    for row in 0..n {
        // 49 and 120 have no common factor
        let shuffled = row * 49 % n;
        (0..4).map(|k| (2 * (row / 2) + k) % n).for_each(|j| _ = entries.insert((j, shuffled), noise.next()));
        let own = entries.entry((row, shuffled)).or_default();
        *own += own.signum();
    }
    let (pattern, values) = (pattern(n, &entries), values(&entries));
    let mut sparse = SparseLu::of_rows(&pattern).expect("it is sparse");
    let matrix = full(n, &entries);
    let mut dense = Lu::new(n);
    dense.factor(matrix.transpose().as_slice()).unwrap();
    // values that change, so that pivots are kept once
    for factor in [1.0, -2.5] {
        let scaled: Vec<f64> = values.iter().map(|x| factor * x).collect();
        sparse.factor(&scaled).unwrap();
        let b: Vec<f64> = (0..n).map(|_| noise.next()).collect();
        let right = DVector::from_vec(b.clone());
        let (mut x, mut y) = (b.clone(), b);
        sparse.solve(&mut x);
        sparse.solve_transposed(&mut y);
        assert!((&matrix * factor * DVector::from_vec(x) - &right).norm() < 1e-12 * right.norm());
        assert!((matrix.transpose() * factor * DVector::from_vec(y) - &right).norm() < 1e-12 * right.norm());
        let expected = dense.log_determinant() + n as f64 * f64::abs(factor).ln();
        assert!((sparse.log_determinant() - expected).abs() < 1e-10);
        assert!(sparse.pivot_ratio() > 0.0 && sparse.pivot_ratio() <= 1.0);
    }
    assert!(sparse.fill() < 10 * entries.len(), "{} of {}", sparse.fill(), entries.len());
    assert!(SparseLu::<f64>::of_rows(&Sparsity::dense(40, 40)).is_none() && SparseLu::<f64>::of_rows(&Sparsity::empty(3, 3)).is_none());
    let mut unknown = vec![1.0; n];
    SparseLu::of_rows(&pattern).unwrap().solve_transposed(&mut unknown);
    assert!(unknown.iter().all(|x: &f64| x.is_nan()));
}
