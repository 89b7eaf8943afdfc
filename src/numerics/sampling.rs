//! Points in a cube: Sobol's sequence, and Latin hypercubes beyond its dimensions.
//!
//! A point's place i decides on it, not those before: a part of a design has the points of the whole. Sobol's points are those of Joe and
//! Kuo (SIAM J. Sci. Comput. 30 (2008) 2635-2654), moved by a shift of their digits that the seed decides on, which keeps how evenly they
//! lie (Owen, Monte Carlo theory, methods and examples, section 17.1) and takes the first of them off the corner. In a Latin hypercube
//! (McKay, Beckman & Conover, Technometrics 21 (1979) 239-245) every one of n equal intervals of each dimension holds one of n points.

/// Dimensions of Sobol's sequence.
pub(crate) const SOBOL: usize = DIRECTIONS.len() + 1;

/// Digits of a point.
const DIGITS: usize = 32;

/// Sobol's direction numbers from the second dimension on: the inner coefficients of the primitive polynomial as a binary number, and the
/// first m, as many as its degree (Joe and Kuo, the list `new-joe-kuo-6`).
const DIRECTIONS: [(u32, &[u32]); 31] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
];

/// A design of `count` points in (0, 1)^`dimensions`.
#[derive(Clone, Debug)]
pub(crate) struct Design {
    count: usize,
    seed: u64,
    of: Of,
}

#[derive(Clone, Debug)]
enum Of {
    /// Direction numbers of each dimension.
    Sobol(Vec<[u32; DIGITS]>),
    /// Interval of each point, dimension after dimension.
    Latin(Vec<Vec<u32>>),
}

impl Design {
    /// Sobol's sequence as far as it goes, else a Latin hypercube.
    pub(crate) fn new(count: usize, dimensions: usize, seed: u64) -> Self {
        let of = if dimensions <= SOBOL {
            Of::Sobol((0..dimensions).map(directions).collect())
        } else {
            Of::Latin((0..dimensions).map(|d| permutation(count, mixed(seed, d as u64, u64::MAX))).collect())
        };
        Self { count, seed, of }
    }

    /// The point at a place from 0 on.
    pub(crate) fn point(&self, place: usize) -> Vec<f64> {
        match &self.of {
            Of::Sobol(directions) => directions.iter().enumerate().map(|(d, v)| self.shifted(d, digits(v, place))).collect(),
            Of::Latin(intervals) => intervals.iter().enumerate().map(|(d, of)| self.within(d, place, of[place])).collect(),
        }
    }

    /// Digits moved by the shift of a dimension; what lies behind them is half of the last one, so that no point is 0 or 1.
    fn shifted(&self, dimension: usize, digits: u32) -> f64 {
        let shift = (mixed(self.seed, dimension as u64, 0) >> 32) as u32;
        (f64::from(digits ^ shift) + 0.5) / 2f64.powi(DIGITS as i32)
    }

    /// A place in an interval of a dimension.
    fn within(&self, dimension: usize, place: usize, interval: u32) -> f64 {
        let part = ((mixed(self.seed, dimension as u64, place as u64) >> 11) as f64 + 0.5) / 2f64.powi(53);
        (f64::from(interval) + part) / self.count as f64
    }
}

/// Direction numbers of a dimension from 0 on (Bratley & Fox, Algorithm 659, ACM Trans. Math. Softw. 14 (1988) 88-100).
fn directions(dimension: usize) -> [u32; DIGITS] {
    let mut v = [0; DIGITS];
    let Some((coefficients, first)) = dimension.checked_sub(1).map(|row| DIRECTIONS[row]) else {
        // van der Corput's sequence
        v.iter_mut().enumerate().for_each(|(i, v)| *v = 1 << (DIGITS - 1 - i));
        return v;
    };
    let degree = first.len();
    for i in 0..DIGITS {
        v[i] = if i < degree {
            first[i] << (DIGITS - 1 - i)
        } else {
            let inner = (1..degree).filter(|k| coefficients >> (degree - 1 - k) & 1 == 1);
            inner.fold(v[i - degree] ^ (v[i - degree] >> degree), |sum, k| sum ^ v[i - k])
        };
    }
    v
}

/// The digits of Sobol's point at a place, by its Gray code.
fn digits(directions: &[u32; DIGITS], place: usize) -> u32 {
    let gray = place ^ (place >> 1);
    (0..DIGITS).filter(|i| gray >> i & 1 == 1).fold(0, |sum, i| sum ^ directions[i])
}

/// A permutation of 0 to `count` - 1 (Fisher and Yates).
fn permutation(count: usize, seed: u64) -> Vec<u32> {
    let mut of: Vec<u32> = (0..count as u32).collect();
    for i in (1..count).rev() {
        // by the high half of a product: as even as 64 digits allow
        let k = (u128::from(mixed(seed, i as u64, 1)) * (i as u128 + 1)) >> 64;
        of.swap(i, k as usize);
    }
    of
}

/// A number without pattern that three decide on: SplitMix64 over them (Steele, Lea & Flood, OOPSLA 2014).
fn mixed(seed: u64, a: u64, b: u64) -> u64 {
    [a, b].into_iter().fold(finished(seed), |sum, x| finished(sum ^ finished(x)))
}

fn finished(x: u64) -> u64 {
    let mut z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of `scipy.stats.qmc.Sobol(d, scramble=False)` of SciPy 1.17, dimensions 1, 2, 5, 21 and 32.
    #[test]
    fn the_sequence_is_that_of_joe_and_kuo() {
        for (dimension, expected) in PUBLISHED {
            let v = directions(dimension - 1);
            for (place, x) in PLACES.into_iter().zip(expected) {
                assert_eq!(f64::from(digits(&v, place)) / 2f64.powi(32), x, "dimension {dimension}, point {place}");
            }
        }
    }

    #[test]
    fn every_elementary_interval_of_two_dimensions_holds_one_point() {
        let design = Design::new(64, 2, 5);
        let points: Vec<Vec<f64>> = (0..64).map(|i| design.point(i)).collect();
        for k in 0..=6 {
            let (across, up) = (f64::from(1 << k), f64::from(64 >> k));
            let mut cells: Vec<_> = points.iter().map(|p| ((p[0] * across) as u32, (p[1] * up) as u32)).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 64, "{across} by {up}");
        }
    }

    #[test]
    fn each_interval_of_a_latin_hypercube_holds_one_point() {
        let (count, dimensions) = (37, SOBOL + 3);
        let design = Design::new(count, dimensions, 1);
        for d in 0..dimensions {
            let mut intervals: Vec<usize> = (0..count).map(|i| (design.point(i)[d] * count as f64) as usize).collect();
            intervals.sort_unstable();
            assert!(intervals.into_iter().eq(0..count));
        }
    }

    #[test]
    fn a_seed_decides_on_all_points_and_none_is_on_the_edge() {
        for dimensions in [3, SOBOL + 1] {
            let all = |seed| {
                let design = Design::new(1000, dimensions, seed);
                (0..1000).map(|i| design.point(i)).collect::<Vec<_>>()
            };
            let first: Vec<Vec<f64>> = all(7);
            assert!(first == all(7) && first != all(8));
            assert!(first.iter().flatten().all(|x| *x > 0.0 && *x < 1.0));
            let mean = first.iter().map(|p| p[dimensions - 1]).sum::<f64>() / 1000.0;
            assert!((mean - 0.5).abs() < 2e-3, "{mean}");
        }
    }

    const PLACES: [usize; 5] = [1, 2, 7, 100, 513];
    const PUBLISHED: [(usize, [f64; 5]); 5] = [
        (1, [0.5, 0.75, 0.125, 0.4140625, 0.5029296875]),
        (2, [0.5, 0.25, 0.625, 0.2578125, 0.7509765625]),
        (5, [0.5, 0.75, 0.125, 0.8828125, 0.9580078125]),
        (21, [0.5, 0.25, 0.875, 0.7578125, 0.9541015625]),
        (32, [0.5, 0.25, 0.875, 0.4140625, 0.1708984375]),
    ];
}
