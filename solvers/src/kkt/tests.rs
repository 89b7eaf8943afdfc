//! The forms of the KKT system against each other and against nalgebra.

use super::*;
use crate::noise::Noise;
use nalgebra::{DMatrix, DVector};

/// A random positive definite matrix, row-major.
fn mass(noise: &mut Noise, n: usize) -> Vec<f64> {
    let a = DMatrix::from_row_slice(n, n, &noise.vector(n * n));
    (&a * a.transpose() + DMatrix::identity(n, n)).as_slice().to_vec()
}

/// D of a mass matrix of one unit, row-major.
fn metric_of(mass: &[f64], nv: usize) -> Vec<f64> {
    metric(mass.iter().step_by(nv + 1).copied(), &vec![(0, None); nv])
}

/// max |x − y|.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

fn largest(x: &[f64]) -> f64 {
    distance(x, &vec![0.0; x.len()])
}

#[test]
fn general_solution_fulfils_both_rows() {
    let mut noise = Noise(11);
    for (nv, m) in [(1, 0), (3, 2), (6, 5), (10, 3), (12, 12), (4, 0), (0, 0)] {
        let (mass, g) = (mass(&mut noise, nv), noise.vector(m * nv));
        let (f, gamma) = (noise.vector(nv), noise.vector(m));
        let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; m]);
        let mut kkt = Kkt::new(nv, m);
        kkt.scale(&mass, &g, &vec![(0, None); nv]);
        kkt.factor(&mass, &g).unwrap();
        kkt.solve(&f, &gamma, &mut a, &mut lambda);
        let (mut r, mut s) = (f.clone(), gamma.clone());
        for i in 0..nv {
            r[i] -= (0..nv).map(|j| mass[i * nv + j] * a[j]).sum::<f64>();
            r[i] -= (0..m).map(|j| g[j * nv + i] * lambda[j]).sum::<f64>();
        }
        for i in 0..m {
            s[i] -= (0..nv).map(|j| g[i * nv + j] * a[j]).sum::<f64>();
        }
        assert!(largest(&r) < 1e-12 * (1.0 + largest(&lambda)) && largest(&s) < 1e-12, "{nv}, {m}: {r:?} {s:?}");
    }
}

#[test]
fn every_form_gives_the_same_solution() {
    let mut noise = Noise(5);
    for (nv, m) in [(1, 1), (3, 2), (6, 4), (8, 4), (12, 8), (30, 20)] {
        for _ in 0..10 {
            let (mass, g) = (mass(&mut noise, nv), noise.vector(m * nv));
            let (f, gamma) = (noise.vector(nv), noise.vector(m));
            let mut quasi = Kkt::new(nv, m);
            quasi.scale(&mass, &g, &vec![(0, None); nv]);
            let mut pivoted = quasi.clone();
            let pattern = Sparsity::dense(m, nv);
            let mut sparse = Kkt::of_blocks(&Sparsity::dense(nv, nv), &pattern);
            let metric = metric_of(&mass, nv);
            sparse.set_scale(&metric, &row_scale(&pattern, &g, &metric));
            let mut results = Vec::new();
            for (kkt, pivot) in [(&mut quasi, false), (&mut pivoted, true), (&mut sparse, false)] {
                let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; m]);
                kkt.factor(&mass, &g).unwrap();
                assert!(kkt.definite);
                if pivot {
                    kkt.eliminate(&mass, &g).unwrap();
                }
                kkt.solve(&f, &gamma, &mut a, &mut lambda);
                results.push((a, lambda));
            }
            let (a, lambda) = &results[0];
            for (b, mu) in &results[1..] {
                assert!(distance(a, b) < 1e-10 * (1.0 + largest(a)) && distance(lambda, mu) < 1e-8 * (1.0 + largest(lambda)));
            }
        }
    }
}

#[test]
fn a_sparse_pattern_is_factored_as_one() {
    // a chain: every row knows two neighbours
    let n = 40;
    let mut noise = Noise(8);
    let mut mass = vec![0.0; n * n];
    (0..n).for_each(|i| mass[i * n + i] = 1.0 + noise.next().abs());
    let mut g = vec![0.0; (n - 1) * n];
    for i in 0..n - 1 {
        (g[i * n + i], g[i * n + i + 1]) = (1.0 + noise.next().abs(), -1.0);
    }
    let entries = (0..n - 1).flat_map(|i| [(i, i), (i, i + 1)]);
    let (of_mass, of_g) = (Sparsity::new(n, n, (0..n).map(|i| (i, i))), Sparsity::new(n - 1, n, entries));
    let values = |pattern: &Sparsity, dense: &[f64]| pattern.places().map(|(i, j)| dense[i * n + j]).collect::<Vec<_>>();
    let (sparse_mass, sparse_g) = (values(&of_mass, &mass), values(&of_g, &g));
    let metric = metric_of(&mass, n);
    let dims = crate::Dims { q: n, v: n, holonomic: n - 1, ..Default::default() };
    let pattern = Pattern { g_scale: row_scale(&of_g, &sparse_g, &metric), mass: of_mass, g: of_g, metric, ..Pattern::dense(dims) };
    let (mut sparse, mut dense) = (Kkt::of_pattern(&pattern), Kkt::new(n, n - 1));
    // elimination with pivots in the same pattern
    let mut pivoted = sparse.clone();
    dense.set_scale(&pattern.metric, &pattern.g_scale);
    pivoted.set_scale(&pattern.metric, &pattern.g_scale);
    let (f, gamma) = (noise.vector(n), noise.vector(n - 1));
    let mut results = Vec::new();
    for (kkt, mass, g, pivot) in
        [(&mut sparse, &sparse_mass, &sparse_g, false), (&mut dense, &mass, &g, false), (&mut pivoted, &sparse_mass, &sparse_g, true)]
    {
        let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; n - 1]);
        kkt.factor(mass, g).unwrap();
        if pivot {
            kkt.eliminate(mass, g).unwrap();
        }
        kkt.solve(&f, &gamma, &mut a, &mut lambda);
        results.push((a, lambda));
    }
    assert!(matches!((&sparse.form, &dense.form), (Some(Form::Sparse(_)), Some(Form::Full(_)))));
    for (a, lambda) in &results[1..] {
        assert!(distance(&results[0].0, a) < 1e-11 * (1.0 + largest(a)));
        assert!(distance(&results[0].1, lambda) < 1e-9 * (1.0 + largest(lambda)));
    }
}

#[test]
fn four_redundant_rows_of_ten_change_no_acceleration() {
    let mut noise = Noise(23);
    let (nv, m, rank) = (12, 10, 6);
    for trial in 0..20 {
        let mass = mass(&mut noise, nv);
        // six independent rows; four combinations of them, in the middle
        let base = DMatrix::from_row_slice(rank, nv, &noise.vector(rank * nv));
        let mix = DMatrix::from_row_slice(m, rank, &noise.vector(m * rank));
        let g = &mix * &base;
        let gamma = &mix * DVector::from_vec(noise.vector(rank));
        let f = DVector::from_vec(noise.vector(nv));
        let g_rows = g.transpose().as_slice().to_vec();
        // γ with noise: bit-symmetric data hides failures
        let noisy: Vec<f64> = gamma.iter().map(|x| x + 1e-15 * noise.next()).collect();

        let mut kkt = Kkt::new(nv, m);
        kkt.scale(&mass, &g_rows, &vec![(0, None); nv]);
        kkt.factor(&mass, &g_rows).unwrap();
        let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; m]);
        kkt.solve(f.as_slice(), &noisy, &mut a, &mut lambda);

        // least squares: a from the particular solution plus the null space of G
        let m_matrix = DMatrix::from_row_slice(nv, nv, &mass);
        let svd = base.clone().svd(true, true);
        let particular = svd.solve(&(mix.clone().svd(true, true).solve(&gamma, 1e-10).unwrap()), 1e-10).unwrap();
        let v_t = svd.v_t.as_ref().unwrap();
        let projector = DMatrix::identity(nv, nv) - v_t.transpose() * v_t;
        let reduced = &projector * &m_matrix * &projector;
        let y = reduced.svd(true, true).solve(&(&projector * (&f - &m_matrix * &particular)), 1e-10).unwrap();
        let expected = &particular + &projector * y;
        assert!(distance(&a, expected.as_slice()) < 1e-12 * (1.0 + largest(&a)), "trial {trial}: {:e}", distance(&a, expected.as_slice()));

        // λ of least λᵀEλ: λ = E^−½ (Gᵀ E^−½)⁺ (f − M a)
        let e = row_scale(&Sparsity::dense(m, nv), &g_rows, &metric_of(&mass, nv));
        let root = DMatrix::from_diagonal(&DVector::from_iterator(m, e.iter().map(|e| e.sqrt().recip())));
        let rhs = &f - &m_matrix * &expected;
        let least = &root * (g.transpose() * &root).svd(true, true).solve(&rhs, 1e-10).unwrap();
        assert!(distance(&lambda, least.as_slice()) < 1e-6 * (1.0 + largest(&lambda)), "trial {trial}");
    }
}

#[test]
fn units_do_not_change_the_solution() {
    // the same system with lengths in µm: rows and coordinates scaled by six decades
    let mut noise = Noise(31);
    let (nv, m) = (6, 4);
    let (mass, g, f, gamma) = (mass(&mut noise, nv), noise.vector(m * nv), noise.vector(nv), noise.vector(m));
    let kinds = |size| [None, None, None, Some(size), Some(size), Some(size)].map(|length| (0, length));
    let mut kkt = Kkt::new(nv, m);
    kkt.scale(&mass, &g, &kinds(1.0));
    kkt.factor(&mass, &g).unwrap();
    let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; m]);
    kkt.solve(&f, &gamma, &mut a, &mut lambda);

    let c: Vec<f64> = kinds(1e6).iter().map(|(_, length)| length.unwrap_or(1.0)).collect();
    let mass: Vec<f64> = (0..nv * nv).map(|k| mass[k] / (c[k / nv] * c[k % nv])).collect();
    let g: Vec<f64> = (0..m * nv).map(|k| 1e6 * g[k] / c[k % nv]).collect();
    let f: Vec<f64> = f.iter().zip(&c).map(|(f, c)| f / c).collect();
    let gamma: Vec<f64> = gamma.iter().map(|x| 1e6 * x).collect();
    kkt.scale(&mass, &g, &kinds(1e6));
    kkt.factor(&mass, &g).unwrap();
    let (mut b, mut mu) = (vec![0.0; nv], vec![0.0; m]);
    kkt.solve(&f, &gamma, &mut b, &mut mu);
    b.iter_mut().zip(&c).for_each(|(b, c)| *b /= c);
    mu.iter_mut().for_each(|x| *x *= 1e6);
    assert!(distance(&a, &b) < 1e-12 * largest(&a) && distance(&lambda, &mu) < 1e-10 * largest(&lambda));
}

#[test]
fn nearness_to_a_singular_position_is_estimated() {
    // two rows that become parallel
    for angle in [1.0_f64, 0.3, 0.03, 0.003] {
        let g = [1.0, 0.0, 0.0, angle.cos(), angle.sin(), 0.0];
        let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let sigma = DMatrix::from_row_slice(2, 3, &g).singular_values().min();
        let mut kkt = Kkt::new(3, 2);
        kkt.scale(&mass, &g, &[(0, None); 3]);
        kkt.factor(&mass, &g).unwrap();
        let (mut row, mut estimate) = ([0.0; 2], [0.0]);
        (0..2).for_each(|_| kkt.smallest_singular_values(&mut row, &mut estimate));
        let [estimate] = estimate;
        assert!(estimate / sigma > 0.99 && estimate / sigma < 2.0, "{estimate:e} for {sigma:e}");
    }
}

#[test]
fn redundant_rows_do_not_hide_a_singular_position() {
    // two rows that become parallel, and three combinations of them
    for angle in [1.0_f64, 0.3, 0.03, 0.003] {
        let rows = [[1.0, 0.0, 0.0], [angle.cos(), angle.sin(), 0.0]];
        let combined = |a: f64, b: f64| [0, 1, 2].map(|j| a * rows[0][j] + b * rows[1][j]);
        let g = [combined(0.6, 0.0), rows[0], combined(0.3, -0.8), rows[1], combined(-0.5, 0.5)].concat();
        let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let mut kkt = Kkt::new(3, 5);
        kkt.set_scale(&[1.0; 3], &[1.0; 5]);
        kkt.factor(&mass, &g).unwrap();
        let mut exact = crate::svd::Svd::new(&DMatrix::from_row_slice(5, 3, &g)).values;
        exact.sort_by(f64::total_cmp);
        let (mut vectors, mut sigma) = ([0.0; 20], [0.0; 4]);
        (0..4).for_each(|_| kkt.smallest_singular_values(&mut vectors, &mut sigma));
        assert!(sigma[..3].iter().all(|x| *x < 1e-6) && (sigma[3] / exact[exact.len() - 2] - 1.0).abs() < 1e-2, "{sigma:?} {exact:?}");
    }
}

#[test]
fn a_singular_position_and_a_massless_freedom_are_told_apart() {
    let (mass, g) = ([1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 1.0, 0.0]);
    let mut kkt = Kkt::new(2, 2);
    kkt.factor(&mass, &g).unwrap();
    let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
    kkt.solve(&[1.0, 1.0], &[0.0, 0.0], &mut a, &mut lambda);
    assert!(distance(&a, &[0.0, 1.0]) < 1e-15 && distance(&lambda, &[0.5, 0.5]) < 1e-8);
    // a mass that no row holds is missing; one that a row holds is not missed
    assert!(Kkt::new(2, 1).factor(&[1.0, 0.0, 0.0, 0.0], &[1.0, 0.0]).is_err());
    let mut held = Kkt::new(2, 1);
    held.factor(&[1.0, 0.0, 0.0, 0.0], &[0.0, 1.0]).unwrap();
    let mut lambda = [0.0];
    held.solve(&[1.0, 2.0], &[3.0], &mut a, &mut lambda);
    assert!(distance(&a, &[1.0, 3.0]) < 1e-12 && (lambda[0] - 2.0).abs() < 1e-7);
}

#[test]
fn no_order_of_a_tree_costs_less_than_its_roads() {
    let mut seed = 3u64;
    let mut chance = |most: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % most.max(1)
    };
    for (n, reach) in [(5, 1), (40, 1), (80, 1), (80, 3), (120, 10), (200, 200)] {
        // each column hangs on one of those before it
        let above: Vec<Option<usize>> = (0..n).map(|k: usize| (k > 0).then(|| k - 1 - chance(k.min(reach)))).collect();
        let road = |k: usize| std::iter::successors(Some(k), |k| above[*k]);
        let depths: Vec<usize> = (0..n).map(|k| road(k).count() - 1).collect();
        let mass = Sparsity::new(n, n, (0..n).flat_map(|k| road(k).flat_map(move |j| [(j, k), (k, j)])));
        for rows in [0, 7] {
            let g = Sparsity::new(rows, n, (0..rows).map(|i| (i, 11 * i % n)));
            let (cost, least) = (Kkt::cost(&mass, &g), Kkt::least_cost(n + rows, &depths));
            assert!(least <= cost, "{n} {reach} {rows}: {least} of {cost}");
            // and it is no empty bound
            assert!(4 * least >= cost || least < 1000, "{n} {reach} {rows}: {least} of {cost}");
        }
    }
}

/// Two rows that are nearly parallel, with and without a redundant one: the force across them is not lost, unless the position counts as
/// singular.
#[test]
fn nearly_dependent_rows_hold_to_round_off() {
    let mut noise = Noise(41);
    let nv = 6;
    for trial in 0..40 {
        let angle = if trial < 20 { 1e-4 } else { 1e-6 };
        let mass = mass(&mut noise, nv);
        let [first, across, other] = std::array::from_fn(|_| DVector::from_vec(noise.vector(nv)));
        let mut rows = vec![first.clone(), &first + angle * across, other.clone()];
        if trial % 2 == 1 {
            rows.push(first - other);
        }
        let m = rows.len();
        let g: Vec<f64> = rows.iter().flat_map(|row| row.iter().copied()).collect();
        let (g_matrix, m_matrix) = (DMatrix::from_row_slice(m, nv, &g), DMatrix::from_row_slice(nv, nv, &mass));
        let mut lambda = DVector::from_vec(noise.vector(m));
        lambda[0] += 1e4;
        lambda[1] -= 1e4;
        let a = DVector::from_vec(noise.vector(nv));
        let held = g_matrix.transpose() * lambda;
        let (f, gamma) = (&m_matrix * &a + &held, &g_matrix * &a);

        let mut kkt = Kkt::new(nv, m);
        kkt.scale(&mass, &g, &vec![(0, None); nv]);
        let off = |a_found: &[f64], lambda: &[f64]| {
            let force = g_matrix.transpose() * DVector::from_column_slice(lambda);
            distance(a_found, a.as_slice()).max(distance(force.as_slice(), held.as_slice()))
        };
        let (mut found, mut by) = (vec![0.0; nv], vec![0.0; m]);
        let (_, sigma) = kkt.weakest(&metric_of(&mass, nv), &g);
        let mut solved = |weakest: f64| {
            kkt.set_weakest(weakest);
            kkt.factor(&mass, &g).unwrap();
            kkt.solve(f.as_slice(), gamma.as_slice(), &mut found, &mut by);
            off(&found, &by)
        };
        let refined = solved(1.0);
        assert!(refined > 1e-4, "trial {trial}: {refined:e}");
        if trial < 20 {
            let off = solved(sigma);
            assert!(off < 1e-6, "trial {trial}: {off:e} of {refined:e}, σ = {sigma:e}");
        } else {
            // of a start that is far from a singular position this is one
            assert_eq!(solved(0.9e-2), refined, "trial {trial}");
        }
    }
}

/// An inertia that has grown by up to 1e8 since assembly: rows that act on it are met, and none of them counts as dependent for that.
#[test]
fn rows_feel_inertias_that_have_grown() {
    let mut noise = Noise(17);
    for (nv, m) in [(2, 1), (4, 2), (12, 5), (40, 12)] {
        for growth in [1e3, 1e5, 1e8] {
            let mut mass = mass(&mut noise, nv);
            // one row acts on the first coordinate alone, and none of the others on it
            let mut g = noise.vector(m * nv);
            g[1..nv].fill(0.0);
            g.chunks_exact_mut(nv).skip(1).for_each(|row| row[0] = 0.0);
            let mut kkt = Kkt::new(nv, m);
            kkt.scale(&mass, &g, &vec![(0, None); nv]);
            let mut vectors = vec![0.0; m];
            let mut weakest = |kkt: &mut Kkt| {
                let mut sigma = [0.0];
                (0..8).for_each(|_| kkt.smallest_singular_values(&mut vectors, &mut sigma));
                sigma[0]
            };
            kkt.factor(&mass, &g).unwrap();
            let before = weakest(&mut kkt);

            let (own, untouched) = (mass[0], kkt.clone());
            mass[0] *= growth;
            let (f, gamma) = (noise.vector(nv), noise.vector(m));
            let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; m]);
            kkt.factor(&mass, &g).unwrap();
            kkt.solve(&f, &gamma, &mut a, &mut lambda);
            let rows = g.chunks_exact(nv).map(|row| row.iter().zip(&a).map(|(g, a)| g * a).sum::<f64>());
            let open = rows.zip(&gamma).map(|(row, gamma)| (row - gamma).abs()).fold(0.0, f64::max);
            assert!(open < 1e-11, "{nv}, {m}, {growth:e}: {open:e}");
            let now = weakest(&mut kkt);
            // what was done on the way is forgotten
            for shrunk in [30.0, 1.0] {
                mass[0] = own * shrunk;
                let solved = |kkt: &mut Kkt| {
                    let (mut a, mut lambda) = (vec![0.0; nv], vec![0.0; m]);
                    kkt.factor(&mass, &g).unwrap();
                    kkt.solve(&f, &gamma, &mut a, &mut lambda);
                    (a, lambda)
                };
                assert_eq!(solved(&mut kkt), solved(&mut untouched.clone()), "{nv}, {m}, {growth:e}, {shrunk}");
            }
            assert!(now > 0.05 * before, "{nv}, {m}, {growth:e}: {now:e}, before {before:e}");
        }
    }
}
