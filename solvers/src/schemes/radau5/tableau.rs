//! Coefficients of Radau IIA with three stages.
//!
//! Hairer & Wanner, Solving ODEs II, 2nd ed.: the method is table IV.5.6; T brings A⁻¹ to the blocks γ̂ and α ± iβ as in (IV.8.4),
//! here with columns of last entry 1, 1, 0; the weights of the estimate are those behind (IV.8.19).

use nalgebra::Complex;

/// √6.
const ROOT: f64 = 2.449_489_742_783_178;

/// Nodes c.
pub(super) const NODES: [f64; 3] = [(4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0];

/// A; its last row are the weights.
pub(super) const A: [[f64; 3]; 3] = [
    [(88.0 - 7.0 * ROOT) / 360.0, (296.0 - 169.0 * ROOT) / 1800.0, (-2.0 + 3.0 * ROOT) / 225.0],
    [(296.0 + 169.0 * ROOT) / 1800.0, (88.0 + 7.0 * ROOT) / 360.0, (-2.0 - 3.0 * ROOT) / 225.0],
    [(16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0],
];

/// γ̂, the real eigenvalue of A⁻¹.
pub(super) const REAL: f64 = 3.637_834_252_744_496;

/// α + iβ, the complex one.
pub(super) const PAIR: Complex<f64> = Complex::new(2.681_082_873_627_752, 3.050_430_199_247_410_6);

/// T: A⁻¹ T = T [γ̂ 0 0; 0 α −β; 0 β α].
pub(super) const T: [[f64; 3]; 3] = [
    [0.094_438_762_488_975_24, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.250_213_122_965_333_3, 0.204_129_352_293_799_93, 0.382_942_112_757_261_9],
    [1.0, 1.0, 0.0],
];

/// T⁻¹.
pub(super) const BACK: [[f64; 3]; 3] = [
    [4.178_718_591_551_905, 0.327_682_820_761_062_4, 0.523_376_445_499_449_5],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605_5, -0.596_039_204_828_224_9],
];

/// Weight of the rate at the begin of the step in the embedded formula of order three: 1/γ̂.
pub(super) const BEGIN: f64 = 1.0 / REAL;

/// Weights of the increments of the stages in the estimate: ŷ₁ − y₁ = h ẏ₀/γ̂ + Σ eᵢ (Yᵢ − y₀).
pub(super) const ERROR: [f64; 3] = [BEGIN / 3.0 * (-13.0 - 7.0 * ROOT), BEGIN / 3.0 * (-13.0 + 7.0 * ROOT), -BEGIN / 3.0];

/// The same for rates, eᵀA: ŷ₁ − y₁ = h (ẏ₀/γ̂ + Σ (eᵀA)ᵢ ẏᵢ).
pub(super) const ERROR_OF_RATES: [f64; 3] = [error_of_rate(0), error_of_rate(1), error_of_rate(2)];

const fn error_of_rate(j: usize) -> f64 {
    ERROR[0] * A[0][j] + ERROR[1] * A[1][j] + ERROR[2] * A[2][j]
}

/// Weights of the three stages in the value at place `x` (in steps) of the parabola through them.
pub(super) fn parabola(x: f64) -> [f64; 3] {
    let [a, b, c] = NODES;
    [(x - b) * (x - c) / ((a - b) * (a - c)), (x - a) * (x - c) / ((b - a) * (b - c)), (x - a) * (x - b) / ((c - a) * (c - b))]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        a.map(|row| [0, 1, 2].map(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
    }

    fn assert_unit(m: [[f64; 3]; 3]) {
        for (i, row) in m.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((x - f64::from(u8::from(i == j))).abs() < 2e-14, "{m:?}");
            }
        }
    }

    #[test]
    fn stages_integrate_parabolas() {
        for (row, c) in A.iter().zip(NODES) {
            for power in 0..3 {
                let sum: f64 = (0..3).map(|j| row[j] * NODES[j].powi(power)).sum();
                assert!((sum - c.powi(power + 1) / f64::from(power + 1)).abs() < 1e-15);
            }
        }
        let sum: f64 = (0..3).map(|j| A[2][j] * NODES[j].powi(4)).sum();
        assert!((sum - 0.2).abs() < 1e-15);
    }

    #[test]
    fn the_transformation_separates_the_blocks() {
        assert_unit(product(T, BACK));
        let blocks = [[REAL, 0.0, 0.0], [0.0, PAIR.re, -PAIR.im], [0.0, PAIR.im, PAIR.re]];
        assert_unit(product(product(product(T, blocks), BACK), A));
    }

    #[test]
    fn the_embedded_formula_has_order_three() {
        let miss = |power: i32| -> f64 {
            let begin = if power == 0 { BEGIN } else { 0.0 };
            begin + (0..3).map(|j| ERROR_OF_RATES[j] * NODES[j].powi(power)).sum::<f64>()
        };
        assert!((0..3).all(|power| miss(power).abs() < 1e-15));
        assert!(miss(3).abs() > 0.02);
    }

    #[test]
    fn parabolas_are_continued() {
        let weights = parabola(1.7);
        for power in 0..3 {
            let sum: f64 = (0..3).map(|j| weights[j] * NODES[j].powi(power)).sum();
            assert!((sum - 1.7_f64.powi(power)).abs() < 1e-13);
        }
    }
}
