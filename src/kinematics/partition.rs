//! Dependent and independent velocities at a position, G_d δ_d + G_i δ_i = 0 (Wehage & Haug, J. Mech. Des. 104 (1982) 247-255).

use crate::geometry::Space;
use crate::mechanism::{Asked, Measured, Mechanism};
use crate::results::Failure;
use nalgebra::{DMatrix, DVector};

/// Pivot of the scaled rows, and part of the largest pivot, below which a row depends on the others.
const RANK_TOLERANCE: f64 = 1e-8;

/// Part of the largest pivot below which another column is taken, though it comes earlier in the file.
const POOR: f64 = 1e-3;

/// Part of the metric below which a motion moves no mass.
pub(crate) const MASSLESS: f64 = 1e-13;

/// A division of velocities, v = (v_d, v_i), such that G_d has full column rank and as many columns as G has independent rows.
#[derive(Clone, Debug)]
pub struct Partition {
    /// Independent velocities, rising (n).
    pub independent: Vec<usize>,
    /// The others, rising (nv − n).
    pub dependent: Vec<usize>,
    /// P = [−G_d⁺ G_i; I] (nv × n): motions that the rows allow.
    pub p: DMatrix<f64>,
    /// G_d⁺ (dependent × rows), which solves G_d x = y exactly for right-hand sides that agree where rows are redundant.
    inverse: DMatrix<f64>,
}

impl Partition {
    /// Divides the velocities; `preferred` ones are independent as far as the rows leave them so, the others are chosen by
    /// elimination with complete pivoting. G (rows × nv) is scaled by the `metric` D of its velocities (nv) and by the
    /// `row_scale` diag(G D⁻¹ Gᵀ) of its rows, so that units do not choose.
    #[must_use]
    pub fn new(g: &DMatrix<f64>, metric: &[f64], row_scale: &[f64], preferred: &[usize]) -> Self {
        let dependent = pivots(Scaled::new(g, metric, row_scale).g, preferred);
        Self::of(g, metric, row_scale, (0..g.ncols()).filter(|j| !dependent.contains(j)).collect())
    }

    /// The same division at another position, by its G.
    #[must_use]
    pub fn of(g: &DMatrix<f64>, metric: &[f64], row_scale: &[f64], independent: Vec<usize>) -> Self {
        let (rows, nv) = g.shape();
        let dependent: Vec<usize> = (0..nv).filter(|j| !independent.contains(j)).collect();
        let scaled = Scaled::new(g, metric, row_scale);
        let qr = scaled.g.select_columns(&dependent).qr();
        // full column rank: R is regular, R⁻¹Qᵀ is the inverse of least squares
        let mut inverse = qr.r().solve_upper_triangular(&qr.q().transpose()).unwrap_or_else(|| DMatrix::zeros(dependent.len(), rows));
        for (mut line, &j) in inverse.row_iter_mut().zip(&dependent) {
            line.iter_mut().zip(&scaled.row_unit).for_each(|(x, r)| *x *= r * scaled.unit[j]);
        }
        let mut partition = Self { p: DMatrix::zeros(nv, independent.len()), independent, dependent, inverse };
        partition.p = partition.follow(&g.select_columns(&partition.independent));
        for (j, &i) in partition.independent.iter().enumerate() {
            partition.p[(i, j)] = 1.0;
        }
        partition
    }

    /// x (nv × columns) with G x + y = 0 for y (rows × columns) that the rows can meet, its independent part 0.
    #[must_use]
    pub fn follow(&self, y: &DMatrix<f64>) -> DMatrix<f64> {
        let x = &self.inverse * y;
        let mut out = DMatrix::zeros(self.p.nrows(), y.ncols());
        for (line, &d) in x.row_iter().zip(&self.dependent) {
            out.row_mut(d).copy_from(&-line);
        }
        out
    }

    /// λ with G_dᵀλ = f_d (f: nv), of least λᵀ diag(G D⁻¹ Gᵀ) λ where rows are redundant: what the rows must bear so that the
    /// dependent velocities are in balance.
    #[must_use]
    pub fn multipliers(&self, f: &DVector<f64>) -> DVector<f64> {
        self.inverse.transpose() * f.select_rows(&self.dependent)
    }
}

/// diag(G D⁻¹ Gᵀ)^−½ G D^−½ with its factors.
struct Scaled {
    g: DMatrix<f64>,
    row_unit: Vec<f64>,
    unit: Vec<f64>,
}

impl Scaled {
    fn new(g: &DMatrix<f64>, metric: &[f64], row_scale: &[f64]) -> Self {
        let root = |x: &f64| x.sqrt().recip();
        let row_unit: Vec<f64> = row_scale.iter().map(root).collect();
        let unit: Vec<f64> = metric.iter().map(root).collect();
        let scaled = DMatrix::from_fn(g.nrows(), g.ncols(), |i, j| g[(i, j)] * row_unit[i] * unit[j]);
        Self { g: scaled, row_unit, unit }
    }
}

/// Columns that elimination takes, rising: those that are not preferred first, then preferred ones from the last on, unless their pivot is
/// poor.
fn pivots(mut a: DMatrix<f64>, preferred: &[usize]) -> Vec<usize> {
    let (mut rows, mut columns): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    // sound rows have the length 1: what is far shorter is round-off, also if nothing longer is there
    let mut threshold = RANK_TOLERANCE;
    let others: Vec<usize> = (0..a.ncols()).filter(|j| !preferred.contains(j)).collect();
    for (among, least) in [(&others[..], 1.0), (preferred, POOR)] {
        loop {
            let left = |rows: &[usize]| (0..a.nrows()).filter(|i| !rows.contains(i)).collect::<Vec<usize>>();
            let open = left(&rows);
            let best = |j: usize| open.iter().map(|&i| (i, j, a[(i, j)].abs())).max_by(|x, y| x.2.total_cmp(&y.2));
            let places: Vec<(usize, usize, f64)> = among.iter().filter(|j| !columns.contains(j)).filter_map(|&j| best(j)).collect();
            let Some(largest) = places.iter().map(|place| place.2).max_by(f64::total_cmp) else { break };
            if largest <= threshold || largest.is_nan() {
                break;
            }
            let Some(&(i, j, size)) = places.iter().rev().find(|place| place.2 >= least * largest) else { break };
            threshold = f64::max(threshold, RANK_TOLERANCE * size);
            rows.push(i);
            columns.push(j);
            let line = a.row(i) / a[(i, j)];
            for k in left(&rows) {
                let factor = a[(k, j)];
                a.row_mut(k).iter_mut().zip(line.iter()).for_each(|(x, l)| *x -= factor * l);
            }
        }
    }
    columns.sort_unstable();
    columns
}

/// Velocities that are independent by preference: joint coordinates with an exact value in `start`, in its order.
#[must_use]
pub fn preferred<G: Space>(mechanism: &Mechanism<G>) -> Vec<usize> {
    let of = |asked: Asked| match asked {
        Asked::Gauge { gauge, order: 0 } => match mechanism.gauges[gauge].measured {
            Measured::Coordinate { along, .. } => Some(along.v),
            _ => None,
        },
        _ => None,
    };
    mechanism.starts.iter().filter(|s| !s.guess).filter_map(|s| of(s.asked)).collect()
}

/// Refuses a mass matrix PᵀMP (n × n) that is singular on the independent velocities named `names`: beside that of D, the `metric` (nv). A
/// motion that passes by all masses has round-off alone in it, which is not small beside itself.
///
/// # Errors
/// Which motion has no mass.
pub(crate) fn with_mass(mass: &DMatrix<f64>, partition: &Partition, metric: &[f64], names: &[String], place: &str) -> Result<(), Failure> {
    let of_metric = DMatrix::from_fn(partition.p.nrows(), partition.p.ncols(), |i, j| metric[i] * partition.p[(i, j)]);
    let beside = partition.p.transpose() * of_metric;
    if names.is_empty() || (mass - &beside * MASSLESS).cholesky().is_some() {
        return Ok(());
    }
    let least = least_mass(mass, &beside).unwrap_or_else(|| mass.diagonal().imin());
    Err(without_mass(&names[least], place))
}

/// The coordinate that moves most in the motion with the least eigenvalue of M x = μ D x (n × n each).
fn least_mass(mass: &DMatrix<f64>, metric: &DMatrix<f64>) -> Option<usize> {
    let l = metric.clone().cholesky()?.unpack();
    let half = l.solve_lower_triangular(mass)?;
    let standard = l.solve_lower_triangular(&half.transpose())?;
    let eigen = standard.iter().all(|x| x.is_finite()).then(|| standard.symmetric_eigen())?;
    let x = l.tr_solve_lower_triangular(&eigen.eigenvectors.column(eigen.eigenvalues.imin()))?;
    Some(DVector::from_fn(x.len(), |i, _| x[i].abs() * metric[(i, i)].sqrt()).imax())
}

/// That the motion of a coordinate of this name moves no mass.
pub(crate) fn without_mass(name: &str, place: &str) -> Failure {
    Failure::Study {
        code: "singular-mass",
        message: format!("the motion of `{name}` moves no mass, so it has no rate"),
        place: place.into(),
        help: "give every moving body a mass and an inertia, as `{ mass: 1 kg, inertia: 0.01 kg m^2 }`".into(),
    }
}
