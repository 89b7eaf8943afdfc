//! Scales of coordinates and constraint rows: taken once, at assembly.

/// E is this times diag(G D⁻¹ Gᵀ) (measured: 1e-10 loses energy in singular positions).
pub const REGULARIZATION: f64 = 1e-8;

/// Masses below this part of the largest of their unit count as that part of it.
const MASS_FLOOR: f64 = 1e-6;

/// Rows whose scale is below this part of the largest count as the largest: they happen to vanish in this position.
const ROW_FLOOR: f64 = 1e-12;

/// D (nv): the diagonal of M, with a floor at 1e-6 of the largest entry of the same unit.
///
/// `mass` is nv × nv; `unit[i]` names the unit of coordinate i (0 an angle, 1 a length, as the caller likes). A unit without any
/// mass counts as 1, so D = 1 if nothing has mass.
pub fn metric(mass: &[f64], unit: &[u8]) -> Vec<f64> {
    let n = unit.len();
    let diagonal = |i: usize| mass[i * n + i];
    (0..n)
        .map(|i| {
            let largest = (0..n).filter(|&j| unit[j] == unit[i]).fold(0.0, |m, j| f64::max(m, diagonal(j)));
            if largest > 0.0 { diagonal(i).max(MASS_FLOOR * largest) } else { 1.0 }
        })
        .collect()
}

/// diag(G D⁻¹ Gᵀ) (m): the inverse of the mass that each constraint row feels. `g` is m × nv.
pub fn row_scale(g: &[f64], metric: &[f64]) -> Vec<f64> {
    if metric.is_empty() {
        return Vec::new();
    }
    let mut scale: Vec<f64> = g.chunks_exact(metric.len()).map(|row| row.iter().zip(metric).map(|(g, d)| g * g / d).sum()).collect();
    let largest = scale.iter().fold(0.0, |m, &x| f64::max(m, x));
    let largest = if largest > 0.0 { largest } else { 1.0 };
    scale.iter_mut().filter(|x| **x < ROW_FLOOR * largest).for_each(|x| *x = largest);
    scale
}

/// The power of two nearest to 1/√x: scaling by it rounds nothing.
pub(crate) fn root_inverse(x: f64) -> f64 {
    (-0.5 * x.log2()).round().clamp(-500.0, 500.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_masses_are_raised_within_their_unit() {
        let mass = [2.0, 0.1, 0.0, 0.1, 1e-9, 0.0, 0.0, 0.0, 1e-9];
        assert_eq!(metric(&mass, &[0, 0, 1]), [2.0, 2e-6, 1e-9]);
        assert_eq!(metric(&[0.0; 4], &[0, 1]), [1.0, 1.0]);
    }

    #[test]
    fn rows_feel_the_inverse_mass() {
        assert_eq!(row_scale(&[1.0, 2.0, 0.0, 0.0], &[2.0, 4.0]), [1.5, 1.5]);
        assert_eq!(row_scale(&[0.0, 0.0], &[2.0, 4.0]), [1.0]);
    }

    #[test]
    fn scaling_is_exact() {
        assert_eq!(root_inverse(4.0), 0.5);
        assert_eq!(root_inverse(1e-6), 1024.0);
    }
}
