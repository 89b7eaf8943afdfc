//! Jacobi's elliptic functions by the arithmetic-geometric mean (Abramowitz & Stegun, 16.4 and 17.6); by the
//! complementary parameter m₁ = 1 − m in (0, 1], which keeps its digits where m is close to 1.

use std::f64::consts::FRAC_PI_2;

/// Halvings of the amplitude: c below 1e-16 for every m that a problem here has.
const STEPS: usize = 8;

/// a and c of each step of the mean of 1 and √m₁.
fn mean(m1: f64) -> [(f64, f64); STEPS] {
    let mut table = [(1.0, (1.0 - m1).sqrt()); STEPS];
    let mut b = m1.sqrt();
    for n in 1..STEPS {
        let a = table[n - 1].0;
        table[n] = (0.5 * (a + b), 0.5 * (a - b));
        b = (a * b).sqrt();
    }
    table
}

/// The complete integral of the first kind, K(m).
pub(crate) fn k(m1: f64) -> f64 {
    FRAC_PI_2 / mean(m1)[STEPS - 1].0
}

/// The amplitude am(u | m), continuous and growing with u (16.4.3).
pub(crate) fn am(u: f64, m1: f64) -> f64 {
    let table = mean(m1);
    let mut phi = (1u32 << (STEPS - 1)) as f64 * table[STEPS - 1].0 * u;
    for (a, c) in table[1..].iter().rev() {
        phi = 0.5 * (phi + (c / a * phi.sin()).asin());
    }
    phi
}

/// sn, cn and dn of (u | m).
pub(crate) fn jacobi(u: f64, m1: f64) -> [f64; 3] {
    let (sn, cn) = am(u, m1).sin_cos();
    [sn, cn, (cn * cn + m1 * sn * sn).sqrt()]
}
