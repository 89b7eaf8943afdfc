//! The lowest eigenvalues of a damped motion by sparse matrices, by Arnoldi's method on shifted and inverted matrices.
//!
//! Motions exp(μt) x that the rows leave, M ẍ + C ẋ + K x + Gᵀλ = 0 with G x = 0, have the positions u = x and the rates w = μ x. With a
//! real shift σ, (u, w) ↦ (u', w') with w' = u + σ u' and
//!
//! ```text
//! [ K + σC + σ²M  Gᵀ ] [ u' ]   [ −M w − (C + σM) u ]
//! [      G        0  ] [ λ  ] = [         0         ]
//! ```
//!
//! has the eigenvalues ν = 1/(μ − σ), of which those of the lowest |μ| are largest and found first (Tisseur & Meerbergen, SIAM Review 43
//! (2001) 235-286). Symmetric C and K are asked for, so that the factors are those of undamped modes. What has converged is a space that
//! the map keeps; the next round looks beside it, and rounds end when one has found nothing lower. So a multiple eigenvalue is found as
//! often as it is there.

use super::orthonormal::{Orthonormal, dot, scaled};
use super::pair::Pair;
use super::pencil::Pencil;
use super::saddle::Saddle;
use crate::numerics::eigenvalues::{eigenvalues, eigenvector, of_each_pair};
use grashof_solvers::{Block, Kkt};
use nalgebra::{Complex, DMatrix};

/// The shift as part of the lowest frequency where free motions ask for one.
const BESIDE: f64 = 1e-3;
/// Residual of a converged vector, as part of its ν; it may grow to the second where round-off allows no less. Values are better, as they
/// are refined with it.
const CONVERGED: [f64; 2] = [1e-10, 1e-7];
/// What is left of a vector beside others when it is no other one.
const SAME: f64 = 1e-6;
/// What is left of a vector beside those before it when there are no others, as part of the largest ν.
const EXHAUSTED: f64 = 1e-11;
/// Part of |μ| within which two are equal.
const EQUAL: f64 = 1e-7;
/// Part of the largest damping or stiffness below which an eigenvalue is round-off.
const ROUND_OFF: f64 = 1e-10;
/// Newton's steps to the root of a motion, how far it may be from the value found, and how far from its double, both as parts.
const REFINEMENTS: usize = 4;
const NEAR: f64 = 1e-3;
const APART: f64 = 1e-3;
/// Part of what xᵀKx is the sum of that is round-off.
const CANCELLED: f64 = 1e-14;
/// Steps between looks at what has converged, and most rounds.
const LOOK: usize = 10;
const ROUNDS: usize = 60;

/// A motion exp(μt) x.
#[derive(Clone, Debug, PartialEq)]
pub struct DampedMotion {
    /// μ, 1/s; of a pair the one with the positive imaginary part.
    pub value: Complex<f64>,
    /// x (nv).
    pub vector: Vec<Complex<f64>>,
}

/// The lowest eigenvalues by |μ|.
#[derive(Clone, Debug, PartialEq)]
pub struct LowestDamped {
    /// By rising |μ|.
    pub motions: Vec<DampedMotion>,
    /// A frequency of the mechanism, rad/s.
    pub omega: f64,
    /// Steps of iteration.
    pub steps: usize,
}

/// The `count` motions of the lowest |μ|, one of each pair, or all if there are fewer; none if the iteration does not converge. `lowest` is
/// the size of the undamped eigenvalue next to zero, 1/s², if one is known that is none of a free motion. `stop` ends it.
#[must_use]
pub fn lowest_damped(pencil: &Pencil, count: usize, lowest: Option<f64>, stop: &dyn Fn() -> bool) -> Option<LowestDamped> {
    let all = 2 * pencil.freedom;
    let pair = Pair::new(pencil);
    let omega = lowest.map_or(BESIDE * pair.size.sqrt(), f64::sqrt);
    let free = pair.below(ROUND_OFF * pair.size)? > pair.below(-ROUND_OFF * pair.size)?;
    let mut map = Inverted::new(&pair, omega, if free { BESIDE * omega } else { 0.0 })?;
    let mut space = Orthonormal::default();
    let (mut steps, mut most, mut residual) = (0, 8 * count + 40, CONVERGED[0]);
    for round in 0..ROUNDS {
        let motions = map.motions(&space)?;
        let place = count.checked_sub(1).map_or(0.0, |last| motions.get(last).map_or(f64::INFINITY, |m| m.value.norm()));
        if space.vectors.len() >= all || count == 0 {
            return Some(LowestDamped { motions: motions.into_iter().take(count).collect(), omega, steps });
        }
        if stop() {
            return None;
        }
        let missing = count.saturating_sub(motions.len());
        let left = all - space.vectors.len();
        let wanted = Wanted { count: missing.max(1), residual, most: most.min(left), round, is_all: most >= left };
        let new = map.converged(&space, &wanted, &mut steps, stop);
        if new.is_empty() {
            most = most.saturating_mul(2);
            residual = f64::min(10.0 * residual, CONVERGED[1]);
            continue;
        }
        let before = space.vectors.len();
        new.into_iter().for_each(|x| map.add(&mut space, x));
        let found = map.motions(&space)?;
        let lower = |motions: &[DampedMotion]| motions.iter().filter(|m| m.value.norm() < place * (1.0 - EQUAL)).count();
        if missing == 0 && space.vectors.len() > before && lower(&found) == lower(&motions) {
            return Some(LowestDamped { motions: motions.into_iter().take(count).collect(), omega, steps });
        }
    }
    None
}

/// How many motions grow where dampers only take energy: as many as K has negative eigenvalues (Kelvin, Tait and Chetaev; Merkin,
/// Introduction to the Theory of Stability, section 6.4). None if C has negative eigenvalues, as of a load that drives what moves.
#[must_use]
pub fn growing(pencil: &Pencil) -> Option<usize> {
    let pair = Pair::new(pencil);
    let damping = halves(&pencil.damping);
    let size = damping.iter().map(|(i, j, c)| c.abs() / (pencil.metric[*i] * pencil.metric[*j]).sqrt()).fold(0.0, f64::max);
    let unit = pencil.metric.iter().enumerate().map(|(i, d)| (i, i, ROUND_OFF * d));
    let takes = || pair.beside_rows(damping.iter().map(|(i, j, c)| (*i, *j, c / size)).chain(unit)).is_some_and(|found| found.below == 0);
    if size == 0.0 || takes() { pair.below(-ROUND_OFF * pair.size) } else { None }
}

/// The entries of the symmetric part of a matrix.
fn halves(matrix: &Block) -> Vec<(usize, usize, f64)> {
    let of = |(i, line): (usize, grashof_solvers::Line<'_, f64>)| -> Vec<(usize, usize, f64)> {
        line.entries().flat_map(|(j, c)| [(i, j, 0.5 * c), (j, i, 0.5 * c)]).collect()
    };
    matrix.lines().enumerate().flat_map(of).collect()
}

/// The map of positions and rates; rates are divided by a frequency, so that both are displacements.
struct Inverted<'a> {
    pencil: &'a Pencil,
    /// The symmetric part of C, M, and the symmetric part of K.
    damping: Vec<(usize, usize, f64)>,
    mass: &'a Block,
    stiffness: &'a Block,
    shifted: Saddle,
    /// [D Gᵀ; G −E], if there are rows.
    closing: Option<Kkt>,
    /// Frequency of the scale, and shift, 1/s.
    omega: f64,
    shift: f64,
    /// What the shifted matrix is divided by, 1/s².
    size: f64,
}

impl<'a> Inverted<'a> {
    fn new(pair: &'a Pair<'a>, omega: f64, shift: f64) -> Option<Self> {
        let pencil = pair.pencil;
        let damping = halves(&pencil.damping);
        let stiff = pair.shifted(-shift * shift).zip(pair.mass.pattern().places()).map(|(x, (i, j))| (i, j, x));
        let damped = damping.iter().map(|(i, j, c)| (*i, *j, shift * c / pair.size));
        let shifted = pair.beside_rows(stiff.chain(damped))?;
        let closing = if pencil.row_scale.is_empty() { None } else { Some(pencil.closing()?) };
        Some(Self { pencil, damping, mass: &pair.mass, stiffness: &pair.stiffness, shifted, closing, omega, shift, size: pair.size })
    }

    /// (u', w') of (u, w).
    fn apply(&self, x: &[f64]) -> Vec<f64> {
        let (u, w) = x.split_at(x.len() / 2);
        let with = |u: &f64, w: &f64| -(self.omega * w + self.shift * u);
        let moved: Vec<f64> = u.iter().zip(w).map(|(u, w)| with(u, w)).collect();
        let mut force: Vec<f64> = self.mass.lines().map(|line| line.dot(&moved)).collect();
        self.damping.iter().for_each(|(i, j, c)| force[*i] -= c * u[*j]);
        let mut out: Vec<f64> = self.shifted.solve(&force).iter().map(|x| x / self.size).collect();
        let rates: Vec<f64> = u.iter().zip(&out).map(|(u, next)| (u + self.shift * next) / self.omega).collect();
        out.extend(rates);
        out
    }

    /// D u, D w.
    fn metric(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(self.pencil.metric.iter().cycle()).map(|(x, d)| x * d).collect()
    }

    /// Takes the parts along all vectors of a basis away, and gives them; then what the rows do not allow.
    fn clear(&mut self, basis: &Orthonormal, x: &mut [f64]) -> Vec<f64> {
        let along = basis.clear(x);
        let force = self.metric(x);
        if let Some(closing) = &mut self.closing {
            let zeros = vec![0.0; self.pencil.row_scale.len()];
            let (nv, mut lambda) = (self.pencil.metric.len(), zeros.clone());
            for (x, force) in x.chunks_exact_mut(nv).zip(force.chunks_exact(nv)) {
                closing.solve(force, &zeros, x, &mut lambda);
            }
            basis.clear(x);
        }
        along
    }

    /// Adds a vector to a space, if it is not in it.
    fn add(&mut self, space: &mut Orthonormal, mut x: Vec<f64>) {
        let whole = dot(&x, &self.metric(&x)).sqrt();
        self.clear(space, &mut x);
        let length = dot(&x, &self.metric(&x)).sqrt();
        if length > SAME * whole {
            let x = scaled(&x, length);
            let product = self.metric(&x);
            space.push(x, product);
        }
    }

    /// Motions of the largest |ν| beside a space that the map keeps: of each that has converged, real and imaginary part of the vector.
    fn converged(&mut self, space: &Orthonormal, wanted: &Wanted, steps: &mut usize, stop: &dyn Fn() -> bool) -> Vec<Vec<f64>> {
        let mut basis = space.clone();
        let first = space.vectors.len();
        // in no special direction
        let noise = |i: usize| 1.0 + (2.39 * (i + 1) as f64 * (wanted.round + 1) as f64).sin();
        let start: Vec<f64> = (0..2 * self.pencil.metric.len()).map(noise).collect();
        let mut next = self.apply(&start);
        self.clear(&basis, &mut next);
        let mut h = DMatrix::<f64>::zeros(0, 0);
        let mut found = Vec::new();
        let mut length = dot(&next, &self.metric(&next)).sqrt();
        for step in 0..wanted.most {
            if !(length > 0.0 && length.is_finite()) {
                break;
            }
            let x = scaled(&next, length);
            let product = self.metric(&x);
            next = self.apply(&x);
            basis.push(x, product);
            *steps += 1;
            let along = self.clear(&basis, &mut next);
            h = h.resize(step + 1, step + 1, 0.0);
            h.column_mut(step).copy_from_slice(&along[first..]);
            if step > 0 {
                h[(step, step - 1)] = length;
            }
            length = dot(&next, &self.metric(&next)).sqrt();
            let last = step + 1 == wanted.most;
            let ends = length <= EXHAUSTED * h.amax() || last || stop();
            if ends || step % LOOK == LOOK - 1 {
                // beyond all motions there is only round-off
                let beyond = if last && wanted.is_all { 0.0 } else { length };
                found = sound(&h, beyond, wanted);
                if ends || found.len() >= wanted.count {
                    break;
                }
            }
        }
        let real = |y: &[Complex<f64>], part: &dyn Fn(&Complex<f64>) -> f64| basis.combined(first, &y.iter().map(part).collect::<Vec<_>>());
        let parts = |y: &[Complex<f64>], value: Complex<f64>| {
            let mut parts = vec![real(y, &|y| y.re)];
            if value.im != 0.0 {
                parts.push(real(y, &|y| y.im));
            }
            parts
        };
        found.into_iter().flat_map(|(value, y)| parts(&y, value)).collect()
    }

    /// The motions of a space that the map keeps, by rising |μ|; none if it has no eigenvalues.
    fn motions(&self, space: &Orthonormal) -> Option<Vec<DampedMotion>> {
        let n = space.vectors.len();
        let images: Vec<Vec<f64>> = space.vectors.iter().map(|x| self.apply(x)).collect();
        let t = DMatrix::from_fn(n, n, |i, j| dot(&space.products[i], &images[j]));
        let nv = self.pencil.metric.len();
        let motion = |(i, nu): (usize, Complex<f64>)| {
            let y = eigenvector(&t, nu, i);
            let [re, im] = [0, 1].map(|part| {
                let factors: Vec<f64> = y.iter().map(|y| if part == 0 { y.re } else { y.im }).collect();
                space.combined(0, &factors)
            });
            let vector: Vec<Complex<f64>> = re[..nv].iter().zip(&im).map(|(re, im)| Complex::new(*re, *im)).collect();
            DampedMotion { value: self.refined(nu.inv() + self.shift, &vector), vector }
        };
        let mut motions: Vec<DampedMotion> =
            of_each_pair(eigenvalues(&t)?).into_iter().map(|nu| nu.conj()).enumerate().map(motion).collect();
        motions.sort_by(|a, b| a.value.norm().total_cmp(&b.value.norm()).then(a.value.re.total_cmp(&b.value.re)));
        Some(motions)
    }

    /// The root of xᵀ(μ²M + μC + K)x next to a value. As the matrices are symmetric it does not change with x to first order (Lancaster,
    /// Lambda-Matrices and Vibrating Systems, section 6.3), unless two roots meet; then the value stays.
    fn refined(&self, value: Complex<f64>, x: &[Complex<f64>]) -> Complex<f64> {
        let along =
            |block: &Block| -> Complex<f64> { block.pattern().places().zip(block.values()).map(|((i, j), k)| x[i] * x[j] * *k).sum() };
        let (m, k) = (along(self.mass), along(self.stiffness));
        let c: Complex<f64> = self.damping.iter().map(|(i, j, c)| x[*i] * x[*j] * *c).sum();
        // of a free motion it is what rounding has left: that goes on, or is slowed down as a whole
        let sizes = self.stiffness.pattern().places().zip(self.stiffness.values());
        let made_of: f64 = sizes.map(|((i, j), k)| x[i].norm() * x[j].norm() * k.abs()).sum();
        if k.norm() <= CANCELLED * made_of {
            let slowed = -c / m;
            return if (value - slowed).norm() < value.norm() { slowed } else { Complex::default() };
        }
        let slope = value * m * 2.0 + c;
        let size = (value * m * 2.0).norm() + c.norm();
        let mut root = value;
        for _ in 0..REFINEMENTS {
            root -= ((root * m + c) * root + k) / (root * m * 2.0 + c);
        }
        let near = (root - value).norm() <= NEAR * value.norm();
        if slope.norm() > APART * size && near { root } else { value }
    }
}

/// What a round of the iteration looks for.
struct Wanted {
    /// Motions, and what may be left of one, as part of its ν.
    count: usize,
    residual: f64,
    /// Most steps, and whether these are all that there are beside the space.
    most: usize,
    is_all: bool,
    /// Number of the round.
    round: usize,
}

/// The eigenvalues of the largest |ν| of Hessenberg's matrix that are wanted, as far as they have converged one after the other: one of
/// each pair, with its vector; `beyond` is what the next step of the iteration would add below the matrix.
fn sound(h: &DMatrix<f64>, beyond: f64, wanted: &Wanted) -> Vec<(Complex<f64>, Vec<Complex<f64>>)> {
    let Some(values) = eigenvalues(h) else { return Vec::new() };
    let mut values = of_each_pair(values);
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    let pairs = values.into_iter().take(wanted.count).enumerate().map(|(i, nu)| (nu, eigenvector(h, nu, i).as_slice().to_vec()));
    pairs.take_while(|(nu, y)| y.last().is_some_and(|last| beyond * last.norm() <= wanted.residual * nu.norm())).collect()
}
