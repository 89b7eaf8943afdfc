//! The polynomial through value, rate and second rate at four nodes, in powers of θ.
//!
//! On the last step, θ ∈ [0, 1], it is Hermite's quintic; each node before adds a polynomial that vanishes at all nodes already met, with
//! its rates: w(θ) c(θ), w = Π (θ − θᵢ)³, where the quadratic c follows from what is left at the new node (Newton's form of
//! Hermite's interpolation: Stoer & Bulirsch, Introduction to Numerical Analysis, section 2.1.5).

/// Number of coefficients.
pub(super) const POWERS: usize = 12;

/// Places inside of the step near to those where what a node adds is steepest.
const STEEP: [f64; 2] = [0.3, 0.8];

/// Value, rate and second rate by θ at a node.
pub(super) type Jet = [f64; 3];

/// What belongs to the places of the nodes alone.
pub(super) struct Places {
    corrections: [Correction; 2],
}

/// One more node.
struct Correction {
    place: f64,
    /// Coefficients of w, and w with its rates at the place.
    weight: [f64; POWERS],
    jet: Jet,
}

impl Places {
    /// The nodes at 0, at 1 and at two places before, the nearer one first.
    pub(super) fn new([near, far]: [f64; 2]) -> Self {
        let mut weight = [0.0; POWERS];
        weight[0] = 1.0;
        for node in [0.0, 0.0, 0.0, 1.0, 1.0, 1.0] {
            weight = times(weight, node);
        }
        let first = Correction::new(near, weight);
        for _ in 0..3 {
            weight = times(weight, near);
        }
        Self { corrections: [first, Correction::new(far, weight)] }
    }

    /// The polynomial through what is at the far and the near node before, at 0 and at 1; and how much the near and then the far node
    /// changes it on [0, 1], in its values and rates.
    pub(super) fn through(&self, [far, near, begin, end]: [Jet; 4]) -> ([f64; POWERS], [[f64; 2]; 2]) {
        let mut powers = [0.0; POWERS];
        powers[..6].copy_from_slice(&quintic(begin, end));
        let mut changes = [[0.0; 2]; 2];
        for ((correction, node), change) in self.corrections.iter().zip([near, far]).zip(&mut changes) {
            let before = STEEP.map(|x| jet(&powers, x));
            correction.add(&mut powers, node);
            for (before, x) in before.iter().zip(STEEP) {
                let after = jet(&powers, x);
                change
                    .iter_mut()
                    .zip(after)
                    .zip(before)
                    .for_each(|((most, after), before)| *most = f64::max(*most, (after - before).abs()));
            }
        }
        // of the round-off nothing is left at the end, by what is flat at the begin
        let at = jet(&powers, 1.0);
        let [off, slope] = [end[0] - at[0], end[1] - at[1]];
        powers[2] += 3.0 * off - slope;
        powers[3] += slope - 2.0 * off;
        (powers, changes)
    }
}

impl Correction {
    fn new(place: f64, weight: [f64; POWERS]) -> Self {
        Self { place, weight, jet: jet(&weight, place) }
    }

    /// Makes a polynomial meet one more node.
    fn add(&self, powers: &mut [f64; POWERS], node: Jet) {
        let (x, [w, w1, w2], at) = (self.place, self.jet, jet(powers, self.place));
        let [left, left1, left2] = [node[0] - at[0], node[1] - at[1], node[2] - at[2]];
        let c = left / w;
        let c1 = (left1 - w1 * c) / w;
        let c2 = (left2 - 2.0 * w1 * c1 - w2 * c) / (2.0 * w);
        let c = [c - x * (c1 - x * c2), c1 - 2.0 * x * c2, c2];
        for (i, w) in self.weight.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            for (sum, c) in powers[i..].iter_mut().zip(c) {
                *sum += w * c;
            }
        }
    }
}

/// p(θ) (θ − x), of which the last power must be zero.
fn times(powers: [f64; POWERS], x: f64) -> [f64; POWERS] {
    std::array::from_fn(|k| if k == 0 { 0.0 } else { powers[k - 1] } - x * powers[k])
}

/// A polynomial with its first and second rate at a place.
fn jet(powers: &[f64; POWERS], x: f64) -> Jet {
    powers.iter().rev().fold([0.0; 3], |[p, p1, p2], c| [p * x + c, p1 * x + p, p2 * x + 2.0 * p1])
}

/// Hermite's quintic, by its powers.
pub(super) fn quintic([q0, r0, s0]: Jet, [q1, r1, s1]: Jet) -> [f64; 6] {
    let d = q1 - q0;
    [
        q0,
        r0,
        0.5 * s0,
        10.0 * d - 6.0 * r0 - 4.0 * r1 - 1.5 * s0 + 0.5 * s1,
        -15.0 * d + 8.0 * r0 + 7.0 * r1 + 1.5 * s0 - s1,
        6.0 * d - 3.0 * (r0 + r1) - 0.5 * (s0 - s1),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_nodes_give_back_a_polynomial_of_degree_eleven() {
        let powers = [0.3, -1.1, 0.7, 2.0, -0.4, 0.9, 1.3, -0.8, 0.5, 0.2, -0.1, 0.05];
        for (near, far) in [(-1.0, -2.0), (-0.5, -1.2), (-2.0, -3.5)] {
            let found = Places::new([near, far]).through([far, near, 0.0, 1.0].map(|x| jet(&powers, x))).0;
            for (found, given) in found.iter().zip(&powers) {
                assert!((found - given).abs() < 1e-10, "{found} {given} with nodes at {near} and {far}");
            }
        }
    }
}
