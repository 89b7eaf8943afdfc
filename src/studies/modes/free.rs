//! Free motions of a held pose: what no force drives back.
//!
//! A place x with a first-order state z stays where it is put if
//!
//! ```text
//! K x + R z = 0,   Z_q x + Z_z z = 0
//! ```
//!
//! Each such (x, 0, z) is an eigenvector of the state matrix with μ = 0. Where nothing slows the motion down, μ = 0 is double and has no second
//! eigenvector, so that numbers give it to half of their digits only: as large as a slow decay beside a stiff spring. Without the places,
//! it is simple: Wielandt's deflation A − n (row p of A) with n_p = 1 (Saad, Numerical Methods for Large Eigenvalue Problems, 2nd edition,
//! section 4.2), whose row and column p are left out.

use super::round_off::{OF_WORK, ROUND_OFF};
use crate::kinematics::held::Held;
use nalgebra::{DMatrix, DVector};

/// Free motions, of a state matrix of (u, u̇, δz) (order 2n + nz).
pub(super) struct Free {
    /// Each with u̇ = 0, and 1 in a state in which the others are 0 (2n + nz).
    pub(super) motions: Vec<DVector<f64>>,
    /// These states.
    pivots: Vec<usize>,
}

impl Free {
    /// Those of a pose where `ways` (n) are 1 rad or the size of the mechanism; without `with_states`, first-order states are held.
    pub(super) fn new(held: &Held, ways: &DVector<f64>, with_states: bool) -> Self {
        let (n, nz) = (held.mass.nrows(), if with_states { held.z_z.nrows() } else { 0 });
        let mut found = Self { motions: Vec::new(), pivots: Vec::new() };
        if n == 0 {
            return found;
        }
        let still = Still::new(held, ways, nz);
        let svd = still.matrix.clone().svd(true, true);
        let (Some(u), Some(v)) = (&svd.u, &svd.v_t) else { return found };
        let is_free = |(i, size): (usize, &f64)| *size <= still.noise(&u.column(i).abs(), &v.row(i).transpose().abs());
        let free = svd.singular_values.iter().enumerate().filter(|(i, size)| is_free((*i, size))).map(|(i, _)| v.row(i).transpose());
        for (pivot, places) in apart(free.collect()) {
            let places = places.component_mul(&still.columns);
            let state = |i: usize| if i < n { i } else { n + i };
            let mut motion = DVector::zeros(2 * n + nz);
            places.iter().enumerate().for_each(|(i, x)| motion[state(i)] = x / places[pivot]);
            found.motions.push(motion);
            found.pivots.push(state(pivot));
        }
        found
    }

    /// A state matrix without its free motions, see above: one row and column less for each.
    pub(super) fn removed(&self, a: &DMatrix<f64>) -> DMatrix<f64> {
        let kept: Vec<usize> = (0..a.nrows()).filter(|i| !self.pivots.contains(i)).collect();
        let along =
            |i: usize, j: usize| -> f64 { self.motions.iter().zip(&self.pivots).map(|(motion, pivot)| motion[i] * a[(*pivot, j)]).sum() };
        DMatrix::from_fn(kept.len(), kept.len(), |i, j| a[(kept[i], kept[j])] - along(kept[i], kept[j]))
    }
}

/// What stands still: [K R; Z_q Z_z], by the square roots of inertias, and with the largest numbers of a first-order state 1.
struct Still {
    matrix: DMatrix<f64>,
    /// The sizes of what its entries are sums of.
    made_of: DMatrix<f64>,
    /// What a unit of each column is (n + nz).
    columns: DVector<f64>,
    /// Round-off of the product of two parts of shapes, for each coordinate (n).
    of_work: DVector<f64>,
}

impl Still {
    fn new(held: &Held, ways: &DVector<f64>, nz: usize) -> Self {
        let n = held.mass.nrows();
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => held.stiffness[(i, j)],
            (true, false) => held.r_z[(i, j - n)],
            (false, true) => held.z_q[(i - n, j)],
            (false, false) => held.z_z[(i - n, j - n)],
        };
        let mut matrix = DMatrix::from_fn(n + nz, n + nz, entry);
        let mut made_of = matrix.abs();
        let own = &held.round_off + DMatrix::from_diagonal(&held.forces.component_div(ways));
        made_of.view_mut((0, 0), (n, n)).copy_from(&own);
        let mut columns = DVector::from_element(n + nz, 1.0);
        for i in 0..n + nz {
            let [row, column] = if i < n {
                [held.mass[(i, i)].sqrt().recip(); 2]
            } else {
                let inverse = |largest: f64| if largest > 0.0 { largest.recip() } else { 1.0 };
                [inverse(matrix.row(i).amax()), inverse(matrix.column(i).amax())]
            };
            for matrix in [&mut matrix, &mut made_of] {
                matrix.row_mut(i).scale_mut(row);
                matrix.column_mut(i).scale_mut(column);
            }
            columns[i] = column;
        }
        let work = OF_WORK * (held.forces.dot(ways) + held.acting);
        let of_work = DVector::from_fn(n, |i, _| work * (columns[i] / ways[i]).powi(2));
        Self { matrix, made_of, columns, of_work }
    }

    /// Round-off of a singular value with these sizes of its left and right vector.
    fn noise(&self, left: &DVector<f64>, right: &DVector<f64>) -> f64 {
        let forces: f64 = self.of_work.iter().zip(left.iter().zip(right)).map(|(work, (x, y))| work * x * y).sum();
        ROUND_OFF * left.dot(&(&self.made_of * right)) + forces
    }
}

/// Vectors of the same space, each with its largest number where the others are 0, as far as there are such places.
fn apart(mut basis: Vec<DVector<f64>>) -> Vec<(usize, DVector<f64>)> {
    let mut pivots: Vec<usize> = Vec::new();
    for k in 0..basis.len() {
        let sizes = basis[k].iter().map(|x| x.abs()).enumerate().filter(|(i, _)| !pivots.contains(i));
        let Some((pivot, _)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        pivots.push(pivot);
        let own = &basis[k] / basis[k][pivot];
        for (_, x) in basis.iter_mut().enumerate().filter(|(other, _)| *other != k) {
            let part = x[pivot];
            *x -= &own * part;
        }
        basis[k] = own;
    }
    pivots.into_iter().zip(basis).collect()
}
