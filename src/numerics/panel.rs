//! Panels: stretches of a curve with the values of all columns at fifteen places, which give integrals and an interpolant.
//!
//! The places are Kronrod's. They carry the Gauss-Kronrod rule of 7 and 15 points and crowd towards the ends as those of Chebyshev
//! do, so that the polynomial through them is as good as one of degree 14 can be. They are not equidistant and have no common
//! measure, so that no oscillation vanishes at all of them.

use super::chebyshev;
use super::continuous::Curve;

/// Number of places.
pub(crate) const NODES: usize = 15;

/// Number of the places that Kronrod added to Gauss's, which alternate with them and begin and end.
const FEW: usize = NODES / 2 + 1;

/// Kronrod nodes x ≥ 0 with their weights, and the Gauss weight of every second one.
const RULE: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_67),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

/// A node on [−1, 1] with its Kronrod and Gauss weights.
pub(crate) fn node(j: usize) -> (f64, f64, f64) {
    let (x, kronrod, gauss) = RULE[j.min(NODES - 1 - j)];
    (if j < NODES / 2 { -x } else { x }, kronrod, gauss)
}

/// A stretch (from, to) of one piece of a curve with its values.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) piece: usize,
    /// Values at the nodes (NODES × columns).
    pub(crate) values: Vec<f64>,
}

impl Panel {
    /// Evaluates a curve on a stretch of a piece.
    pub(crate) fn of<C: Curve>(curve: &mut C, from: f64, to: f64, piece: usize) -> Result<Self, C::Error> {
        let columns = curve.columns();
        let mut panel = Self { from, to, piece, values: vec![0.0; NODES * columns] };
        (0..NODES).try_for_each(|j| panel.look(curve, j))?;
        Ok(panel)
    }

    /// As [`Panel::of`] on a stretch where little is to be expected of a curve; whether every second place was enough: there it is
    /// looked at first, and where the polynomial through those leaves out of no column more than `left` (values of a column, its
    /// number) allows, the others are its values.
    pub(crate) fn sparing<C: Curve>(
        curve: &mut C,
        basis: &Basis,
        (from, to, piece): (f64, f64, usize),
        mut left: impl FnMut(&[f64; FEW], usize) -> f64,
    ) -> Result<(Self, bool), C::Error> {
        let columns = curve.columns();
        let mut panel = Self { from, to, piece, values: vec![0.0; NODES * columns] };
        (0..NODES).step_by(2).try_for_each(|j| panel.look(curve, j))?;
        let known = |panel: &Self, column: usize| -> [f64; FEW] { std::array::from_fn(|i| panel.values[2 * i * columns + column]) };
        let enough = (0..columns).all(|column| {
            let values = known(&panel, column);
            basis.few_tail(&values) <= left(&values, column)
        });
        for j in (1..NODES).step_by(2) {
            if !enough {
                panel.look(curve, j)?;
                continue;
            }
            for column in 0..columns {
                panel.values[j * columns + column] = basis.between(&known(&panel, column), j / 2);
            }
        }
        Ok((panel, enough))
    }

    /// Takes the values of a curve at a node.
    fn look<C: Curve>(&mut self, curve: &mut C, j: usize) -> Result<(), C::Error> {
        let columns = curve.columns();
        curve.look(self.place(j), self.piece, &mut self.values[j * columns..(j + 1) * columns])
    }

    pub(crate) fn width(&self) -> f64 {
        self.to - self.from
    }

    /// The place of a node.
    pub(crate) fn place(&self, j: usize) -> f64 {
        0.5 * (self.from + self.to) + 0.5 * self.width() * node(j).0
    }

    /// A place in units of half the width, from the middle.
    pub(crate) fn relative(&self, x: f64) -> f64 {
        (2.0 * x - self.from - self.to) / self.width()
    }

    /// The values of one column.
    pub(crate) fn column(&self, column: usize) -> [f64; NODES] {
        let columns = self.values.len() / NODES;
        std::array::from_fn(|j| self.values[j * columns + column])
    }
}

/// The transform from values at the nodes to Chebyshev coefficients.
pub(crate) struct Basis {
    /// Rows of the inverse of T_k(x_j).
    inverse: [[f64; NODES]; NODES],
    /// The same of every second node, by its last three rows.
    few_inverse: [[f64; FEW]; 3],
    /// The polynomial through values at those nodes, at the nodes between them.
    between: [[f64; FEW]; FEW - 1],
}

impl Basis {
    pub(crate) fn new() -> Self {
        let cosine = nalgebra::SMatrix::<f64, NODES, NODES>::from_fn(|j, k| (k as f64 * node(j).0.acos()).cos());
        // the nodes are distinct, so that the matrix has an inverse
        let inverse = cosine.try_inverse().unwrap_or_else(nalgebra::SMatrix::zeros);
        let few = nalgebra::SMatrix::<f64, FEW, FEW>::from_fn(|i, k| cosine[(2 * i, k)]);
        let few_inverse = few.try_inverse().unwrap_or_else(nalgebra::SMatrix::zeros);
        let at = nalgebra::SMatrix::<f64, { FEW - 1 }, FEW>::from_fn(|i, k| cosine[(2 * i + 1, k)]);
        let between = at * few_inverse;
        Self {
            inverse: std::array::from_fn(|k| std::array::from_fn(|j| inverse[(k, j)])),
            few_inverse: std::array::from_fn(|k| std::array::from_fn(|i| few_inverse[(FEW - 3 + k, i)])),
            between: std::array::from_fn(|i| std::array::from_fn(|k| between[(i, k)])),
        }
    }

    /// The largest of the last three coefficients of the polynomial through values at every second node.
    fn few_tail(&self, values: &[f64; FEW]) -> f64 {
        self.few_inverse.iter().fold(0.0, |m, row| {
            let c: f64 = row.iter().zip(values).map(|(w, y)| w * y).sum();
            // what is not defined leaves out everything
            if c.is_finite() { f64::max(m, c.abs()) } else { f64::INFINITY }
        })
    }

    /// That polynomial at the node number i between them.
    fn between(&self, values: &[f64; FEW], i: usize) -> f64 {
        self.between[i].iter().zip(values).map(|(w, y)| w * y).sum()
    }

    /// Coefficients c of the polynomial Σ c_k T_k through values at the nodes.
    pub(crate) fn series(&self, values: &[f64; NODES]) -> [f64; NODES] {
        std::array::from_fn(|k| self.coefficient(values, k))
    }

    fn coefficient(&self, values: &[f64; NODES], k: usize) -> f64 {
        self.inverse[k].iter().zip(values).map(|(w, y)| w * y).sum()
    }

    /// What the polynomial leaves out: the largest of its last three coefficients, of which one may vanish by symmetry.
    pub(crate) fn tail(&self, values: &[f64; NODES]) -> f64 {
        (NODES - 3..NODES).fold(0.0, |m, k| f64::max(m, self.coefficient(values, k).abs()))
    }

    /// Sum of the coefficients of degree 10 and more: how far a curve that is not resolved yet can be from its values.
    pub(crate) fn rough(&self, values: &[f64; NODES]) -> f64 {
        (10..NODES).map(|k| self.coefficient(values, k).abs()).sum()
    }

    /// The lowest place in (−1, 1) of the polynomial through values, and how low it is there.
    pub(crate) fn dip(&self, values: &[f64; NODES]) -> (f64, f64) {
        const STEPS: i32 = 96;
        let series = self.series(values);
        let at = |s: f64| chebyshev::value(&series, s);
        // as dense towards the ends as the nodes are
        let place = |i: i32| -(std::f64::consts::PI * f64::from(i.clamp(0, STEPS)) / f64::from(STEPS)).cos();
        let lowest = (1..STEPS).min_by(|a, b| at(place(*a)).total_cmp(&at(place(*b)))).unwrap_or(1);
        let (mut low, mut high) = (place(lowest - 1), place(lowest + 1));
        for _ in 0..48 {
            let third = (high - low) / 3.0;
            if at(low + third) < at(high - third) { high -= third } else { low += third }
        }
        let s = 0.5 * (low + high);
        (s, at(s))
    }
}

/// Spread of repeated evaluations of each column around `at`, by third differences over seven places so close together that the
/// curve itself is a parabola (Hamming, Numerical Methods for Scientists and Engineers, 2nd ed., section 6.4).
pub(crate) fn noise<C: Curve>(curve: &mut C, at: f64, step: f64, piece: usize) -> Result<Vec<f64>, C::Error> {
    const PLACES: usize = 7;
    let columns = curve.columns();
    let mut rows = vec![vec![0.0; columns]; PLACES];
    for (i, row) in rows.iter_mut().enumerate() {
        curve.look(at + step * (i as f64 - 3.0), piece, row)?;
    }
    let spread = |c: usize| {
        let mut square = 0.0;
        for w in rows.windows(4) {
            square += (w[3][c] - 3.0 * w[2][c] + 3.0 * w[1][c] - w[0][c]).powi(2);
        }
        // the third difference of noise ε has the variance 20 ε²
        (square / 80.0).sqrt()
    };
    Ok((0..columns).map(spread).collect())
}

#[cfg(test)]
mod tests {
    use super::super::continuous::closed::Closed;
    use super::*;

    #[test]
    fn the_polynomial_goes_through_its_nodes_and_its_tail_tells_what_it_leaves_out() {
        let basis = Basis::new();
        let values = std::array::from_fn(|j| node(j).0.exp());
        let series = basis.series(&values);
        for s in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            assert!((chebyshev::value(&series, s) - s.exp()).abs() < 1e-14);
        }
        // the coefficient of T₁₂ is 2 / (2¹² 12!)
        assert!((basis.tail(&values) - 1e-12).abs() < 0.1e-12, "{:e}", basis.tail(&values));
        // an oscillation far beyond what fifteen places can follow never looks smooth
        for k in 1..400 {
            let fast = std::array::from_fn(|j| (37.0 * f64::from(k) * node(j).0 + 0.4).sin());
            assert!(basis.tail(&fast) > 1e-3, "{k}: {:e}", basis.tail(&fast));
        }
    }

    #[test]
    fn a_dip_between_two_nodes_is_seen() {
        let basis = Basis::new();
        let values = std::array::from_fn(|j| (node(j).0 - 0.1).powi(2) + 0.25);
        let (at, value) = basis.dip(&values);
        assert!((at - 0.1).abs() < 1e-6 && (value - 0.25).abs() < 1e-12, "{at} {value}");
        // between the last node and the end, too
        let (at, value) = basis.dip(&std::array::from_fn(|j| (node(j).0 - 0.996).powi(2) - 1e-9));
        assert!((at - 0.996).abs() < 1e-6 && (value + 1e-9).abs() < 1e-13, "{at} {value}");
    }

    #[test]
    fn noise_is_told_from_motion() {
        let mut k = 0u64;
        let mut curve = Closed::new(2, |x: f64, _, out: &mut [f64]| {
            k = k.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            out[0] = 1e-9 * ((k >> 11) as f64 / (1u64 << 52) as f64 - 1.0);
            out[1] = (5000.0 * x).sin();
        });
        let found = noise(&mut curve, 0.3, 1e-9, 0).unwrap();
        assert!(found[0] > 1e-10 && found[0] < 2e-9 && found[1] < 1e-12, "{found:?}");
    }
}
