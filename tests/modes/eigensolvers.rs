//! Four roads to the eigenvalues of a pair, one answer.

use crate::common::Noise;
use grashof::studies::modes::eigen::{Eigen, library};
use grashof::studies::modes::jacobi::jacobi;
use grashof::studies::modes::lanczos::full;
use grashof::studies::modes::power::power;
use nalgebra::{DMatrix, DVector};

/// A pair with these eigenvalues, its mass matrix of condition 1e4.
fn pair(values: &[f64], noise: &mut Noise) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = values.len();
    let q = DMatrix::from_vec(n, n, noise.vector(n * n)).qr().q();
    let sizes = DVector::from_fn(n, |_, _| 10f64.powf(2.0 * noise.next()));
    let l = DMatrix::from_fn(n, n, |i, j| {
        if j < i {
            0.3 * noise.next() * sizes[i]
        } else if i == j {
            sizes[i]
        } else {
            0.0
        }
    });
    let s = &q * DMatrix::from_diagonal(&DVector::from_column_slice(values)) * q.transpose();
    let (m, k) = (&l * l.transpose(), &l * s * l.transpose());
    ((&k + k.transpose()) * 0.5, (&m + m.transpose()) * 0.5)
}

#[test]
fn four_methods_agree_on_negative_zero_double_and_distant_eigenvalues() {
    let mut noise = Noise(11);
    let cases: [&[f64]; 6] = [
        &[-3.0, 0.0, 0.0, 1.0, 2.0, 2.0, 50.0],
        &[-1e6, -1.0, 1e-3, 1.0, 1e6],
        &[1.0, 1.0 + 1e-9, 1.0 + 2e-9, 4.0],
        &[5.0],
        &[-2.0, -2.0, -2.0],
        &[0.0, 0.0],
    ];
    for values in cases {
        for _ in 0..4 {
            let (k, m) = pair(values, &mut noise);
            let size = values.iter().fold(1e-300, |m: f64, x| m.max(x.abs()));
            let lanczos = full(&k, &m, values.len(), &|| false);
            for (name, found) in [("library", library(&k, &m)), ("jacobi", jacobi(&k, &m)), ("power", power(&k, &m)), ("lanczos", lanczos)]
            {
                let Eigen { values: found, vectors, iterations } = found.unwrap_or_else(|| panic!("{name} does not converge: {values:?}"));
                let off = found.iter().zip(values).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
                assert!(off <= 2e-10 * size, "{name}: {found:?} for {values:?}, {iterations} iterations");
                let gram = vectors.transpose() * &m * &vectors;
                assert!((gram - DMatrix::identity(values.len(), values.len())).amax() < 1e-9, "{name}: vectors are M-orthonormal");
                let left = &k * &vectors - &m * &vectors * DMatrix::from_diagonal(&DVector::from_column_slice(&found));
                assert!(left.amax() <= 1e-8 * size * m.amax(), "{name}: K x = λ M x, off by {:e}", left.amax());
            }
        }
    }
    assert!(library(&DMatrix::identity(2, 2), &DMatrix::zeros(2, 2)).is_none());
    assert!(power(&DMatrix::identity(2, 2), &DMatrix::zeros(2, 2)).is_none());
}
