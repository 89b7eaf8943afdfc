//! The same elimination as in `dense`, for sizes known to the compiler: arrays instead of slices leave no bounds to check and
//! loops to unroll: about 1.6 times as fast at 6 and at 12 unknowns, no faster at 3 (measured).
//!
//! Tried and slower: updating whole rows against a masked pivot row, a copy of the matrix in local variables.

use super::number::Number;
use super::singular::Singular;

/// Gaussian elimination by rows; see [`super::dense::Lu`] for the contents of the arguments.
#[inline]
pub(super) fn factor<T: Number, const N: usize>(a: &mut [[T; N]; N], inverse: &mut [T; N], swap: &mut [usize; N]) -> Result<(), Singular> {
    for k in 0..N {
        // first the magnitude, then its place by branches: what is predicted right is not waited for
        let mut largest = 0.0;
        for row in &a[k..] {
            largest = if row[k].abs1() > largest { row[k].abs1() } else { largest };
        }
        // a pivot that is zero, infinite or not a number ends here
        if !(largest > 0.0 && largest < f64::INFINITY) {
            return Err(Singular { column: k });
        }
        let mut pivot = k;
        while pivot < N - 1 && a[pivot][k].abs1() != largest {
            pivot += 1;
        }
        swap[k] = pivot;
        let (top, bottom) = a.split_at_mut(k + 1);
        let u = &mut top[k];
        if pivot != k {
            let other = &mut bottom[pivot - k - 1];
            if N < 4 {
                // by elements: rows of three straddle the wide stores before them, and a wide load would wait for those
                u.iter_mut().zip(other).for_each(|(x, y)| std::mem::swap(x, y));
            } else {
                std::mem::swap(u, other);
            }
        }
        inverse[k] = u[k].recip();
        for row in bottom {
            // l_ik = a_ik / u_kk, a_ij −= l_ik u_kj
            let l = row[k] * inverse[k];
            row[k] = l;
            for j in k + 1..N {
                row[j] -= l * u[j];
            }
        }
    }
    Ok(())
}

/// b := U⁻¹ L⁻¹ P b, by columns: every update of a column is independent of the others.
#[inline]
pub(super) fn solve<T: Number, const N: usize>(a: &[[T; N]; N], inverse: &[T; N], swap: &[usize; N], b: &mut [T; N]) {
    for (k, &pivot) in swap.iter().enumerate() {
        if pivot < N {
            b.swap(k, pivot);
        }
    }
    for k in 0..N {
        let x = b[k];
        for i in k + 1..N {
            b[i] -= a[i][k] * x;
        }
    }
    for k in (0..N).rev() {
        let x = b[k] * inverse[k];
        b[k] = x;
        for i in 0..k {
            b[i] -= a[i][k] * x;
        }
    }
}
