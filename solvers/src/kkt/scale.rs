//! Scales of coordinates and constraint rows: taken once, at assembly.

use crate::Sparsity;

/// E is this times diag(G D⁻¹ Gᵀ) (measured: 1e-10 loses energy in singular positions).
pub const REGULARIZATION: f64 = 1e-8;

/// Masses below this part of the largest of their kind count as that part of it; see [`metric`].
const MASS_FLOOR: f64 = 1e-3;

/// The same of the largest of turns and slides together.
const OTHER_KIND: f64 = 1e-5;

/// Rows whose scale is below this part of the largest count as the largest: they happen to vanish in this position.
const ROW_FLOOR: f64 = 1e-12;

/// Entries of a row below this part of their natural size are round-off; see [`natural_row_scale`].
pub const ROUND_OFF: f64 = 1e-11;

/// With what a velocity is compared, the turns of a group and its slides each among themselves: a small number that the velocities of one
/// mechanism share, and of a slide the length that counts as 1 rad, m.
pub type Kind = (usize, Option<f64>);

/// D (nv): the diagonal of M, with a floor at 1e-3 of the largest entry of the same kind, and one at 1e-5 of the largest of its group.
///
/// `masses` are the diagonal of M. A kind without any mass counts as 1, so D = 1 if nothing has mass.
///
/// Where a light body only passes a force on, its rows feel the heavy ones behind it, so that an E by its own mass would be large beside
/// what they feel. [Measured, four-bar in the plane with links of 1 g, 1 t and 1 g: accelerations to 2e-5 with a floor at 1e-6, to 4e-10
/// with one at 1e-3. Rejected: a higher floor, and one floor for mechanisms side by side; flat positions of a four-bar that is lighter by 1e8
/// than what it hangs on then gain energy. Crank and rod of 1e-9 kg and 1e-11 kg that move a block of 1 kg along a slide, at 1e-8: 23 and 99
/// per cent of the energy lost without the second floor, 7e-9 and 1e-8 of it with this one, by `dop853`. Rejected: 1e-4 and more, by which a crank of 5 cm
/// and 0.1 kg at a block of 100 kg loses up to fifty times as much in its flat positions.]
pub fn metric(masses: impl IntoIterator<Item = f64>, kinds: &[Kind]) -> Vec<f64> {
    let masses: Vec<f64> = masses.into_iter().collect();
    let groups = kinds.iter().map(|(group, _)| group + 1).max().unwrap_or(0);
    let turned = |m: f64, length: Option<f64>| length.map_or(m, |length| m * length * length);
    // of turns and of slides, and of both as turns
    let (mut of_kind, mut of_group) = (vec![[0.0_f64; 2]; groups], vec![0.0_f64; groups]);
    for (&m, &(group, length)) in masses.iter().zip(kinds) {
        let (own, all) = (&mut of_kind[group][usize::from(length.is_some())], &mut of_group[group]);
        (*own, *all) = (own.max(m), all.max(turned(m, length)));
    }
    let metric = |(&m, &(group, length)): (&f64, &Kind)| {
        let own = match of_kind[group][usize::from(length.is_some())] {
            largest if largest > 0.0 => m.max(MASS_FLOOR * largest),
            _ => 1.0,
        };
        own.max(OTHER_KIND * of_group[group] / turned(1.0, length))
    };
    masses.iter().zip(kinds).map(metric).collect()
}

/// diag(G D⁻¹ Gᵀ) (m): the inverse of the mass that each constraint row feels; `g` by its pattern (m × nv).
///
/// For rows of which nothing but their entries is known: those that vanish against the largest count as that. If all of them are
/// round-off, that is not seen; see [`natural_row_scale`].
pub fn row_scale(pattern: &Sparsity, g: &[f64], metric: &[f64]) -> Vec<f64> {
    let mut scale = squares(pattern, g, metric);
    let largest = scale.iter().fold(0.0, |m, &x| f64::max(m, x));
    let largest = if largest > 0.0 { largest } else { 1.0 };
    scale.iter_mut().filter(|x| **x < ROW_FLOOR * largest).for_each(|x| *x = largest);
    scale
}

/// The same for rows whose entries have the sizes `natural` (by the same pattern) before they cancel: n·ω + f·v has the size |n||ω| + |f||v|.
///
/// A row that is below 1e-11 of its natural size is round-off and takes the scale of that size, Σ natural²/D: scaled by it, it is
/// nearly 0 and constrains nothing. So each row is judged by itself. A row that happens to vanish in this position is to be given
/// with the entries of another one: E must last when it grows.
pub fn natural_row_scale(pattern: &Sparsity, g: &[f64], natural: &[f64], metric: &[f64]) -> Vec<f64> {
    let scale = |(own, natural): (f64, f64)| if own > ROUND_OFF * ROUND_OFF * natural { own } else { natural };
    let positive = |x: f64| if x > 0.0 { x } else { 1.0 };
    squares(pattern, g, metric).into_iter().zip(squares(pattern, natural, metric)).map(scale).map(positive).collect()
}

/// Σ_j g_ij²/D_j of each row.
fn squares(pattern: &Sparsity, g: &[f64], metric: &[f64]) -> Vec<f64> {
    let row = |i: usize| pattern.row(i).iter().zip(&g[pattern.range(i)]).map(|(j, g)| g * g / metric[*j]).sum();
    (0..pattern.rows()).map(row).collect()
}

/// The power of two nearest to 1/√x: scaling by it rounds nothing.
pub(crate) fn root_inverse(x: f64) -> f64 {
    (-0.5 * x.log2()).round().clamp(-500.0, 500.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_masses_are_raised_within_their_kind() {
        assert_eq!(metric([2.0, 1e-9, 1e-9], &[(0, None), (0, None), (1, None)]), [2.0, 2e-3, 1e-9]);
        assert_eq!(metric([0.0; 2], &[(0, None), (1, None)]), [1.0, 1.0]);
    }

    #[test]
    fn turns_and_slides_of_a_group_are_compared_by_a_length() {
        let slide = Some(0.5);
        let found = metric([1e-9, 4.0, 1e-9, 8.0, 0.0], &[(0, None), (0, slide), (1, slide), (1, None), (2, slide)]);
        let right = [1e-5, 4.0, 32e-5, 8.0, 1.0];
        assert!(found.iter().zip(right).all(|(x, y)| (x - y).abs() < 1e-12 * y), "{found:?}");
    }

    #[test]
    fn rows_feel_the_inverse_mass() {
        assert_eq!(row_scale(&Sparsity::dense(2, 2), &[1.0, 2.0, 0.0, 0.0], &[2.0, 4.0]), [1.5, 1.5]);
        assert_eq!(row_scale(&Sparsity::new(2, 2, [(1, 1)]), &[2.0], &[2.0, 4.0]), [1.0, 1.0]);
        assert_eq!(row_scale(&Sparsity::dense(1, 2), &[0.0, 0.0], &[2.0, 4.0]), [1.0]);
    }

    #[test]
    fn each_row_is_measured_by_itself() {
        let metric = [2.0, 4.0];
        let natural = [1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 0.0, 0.0];
        // a real row, one that is small for good, noise alone, and a row that is nothing
        let g = [0.5, 2.0, 1e-9, 0.0, 1e-16, -3e-17, 0.0, 0.0];
        assert_eq!(natural_row_scale(&Sparsity::dense(4, 2), &g, &natural, &metric), [1.125, 0.5e-18, 1.5, 1.0]);
        assert_eq!(natural_row_scale(&Sparsity::dense(0, 0), &[], &[], &[]), []);
    }

    #[test]
    fn scaling_is_exact() {
        assert_eq!(root_inverse(4.0), 0.5);
        assert_eq!(root_inverse(1e-6), 1024.0);
    }
}
