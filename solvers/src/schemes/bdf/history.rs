//! Past states of a multistep method, and the polynomials through them.
//!
//! Polynomials are combinations y₀ + Σ wᵢ (yᵢ − y₀) of the points themselves, y₀ the newest: the weights of a value sum to one and
//! those of a derivative or difference to zero, and the differences carry less round-off than the values.

use crate::{Dense, Dims};

/// Points kept: order 5 needs six, the error of order 5 and of a raise to it one more.
pub(super) const MOST: usize = 7;

/// Weights of the points, newest first.
pub(super) type Weights = [f64; MOST];

/// The last states y = (q, v, z) with their times, newest first.
pub(super) struct History {
    times: [f64; MOST],
    points: [Vec<f64>; MOST],
    count: usize,
}

impl History {
    /// Room for states of `n` entries.
    pub(super) fn new(n: usize) -> Self {
        Self { times: [0.0; MOST], points: std::array::from_fn(|_| vec![0.0; n]), count: 0 }
    }

    /// Forgets all points.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Points at hand.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Times of the points, newest first.
    pub(super) fn times(&self) -> &[f64] {
        &self.times[..self.count]
    }

    /// Takes back the rounding of the newest time.
    pub(super) fn set_time(&mut self, t: f64) {
        self.times[0] = t;
    }

    /// Adds the newest point; the oldest may fall out.
    pub(super) fn push(&mut self, t: f64, y: [&[f64]; 3]) {
        self.times.rotate_right(1);
        self.points.rotate_right(1);
        self.count = (self.count + 1).min(MOST);
        self.replace(t, y);
    }

    /// Puts a point in the place of the newest.
    pub(super) fn replace(&mut self, t: f64, y: [&[f64]; 3]) {
        self.times[0] = t;
        copy(&mut self.points[0], y);
    }

    /// Adds a point before the oldest; does nothing if there is no room.
    pub(super) fn push_oldest(&mut self, t: f64, y: [&[f64]; 3]) {
        if self.count < MOST {
            self.times[self.count] = t;
            copy(&mut self.points[self.count], y);
            self.count += 1;
        }
    }

    /// Value and derivative by t at `t` of the polynomial through the newest `points`, as weights. `t` is none of their times.
    pub(super) fn lagrange(&self, t: f64, points: usize) -> [Weights; 2] {
        let nodes = &self.times[..points];
        let (mut value, mut rate) = ([0.0; MOST], [0.0; MOST]);
        for (i, ti) in nodes.iter().enumerate() {
            let others = || nodes.iter().enumerate().filter(move |(j, _)| *j != i).map(|(_, tj)| tj);
            value[i] = others().map(|tj| (t - tj) / (ti - tj)).product();
            rate[i] = value[i] * others().map(|tj| (t - tj).recip()).sum::<f64>();
        }
        [value, rate]
    }

    /// hʲ times the derivative of degree j of the polynomial through the newest j + 1 points, as weights: the j-th backward
    /// difference if the points are h apart.
    pub(super) fn difference(&self, j: usize, h: f64) -> Weights {
        let mut weights = [0.0; MOST];
        for (i, w) in weights.iter_mut().enumerate().take(j + 1) {
            // factors paired so that neither product over- nor underflows
            let gaps = (0..=j).filter(|l| *l != i).map(|l| self.times[i] - self.times[l]);
            *w = gaps.zip(1..).map(|(gap, factor)| f64::from(factor) * h / gap).product();
        }
        weights
    }

    /// Σ wᵢ (yᵢ − y₀), plus y₀ if `value`.
    pub(super) fn combine(&self, weights: &Weights, value: bool, out: &mut [f64]) {
        let (newest, older) = self.points.split_at(1);
        if value {
            out.copy_from_slice(&newest[0]);
        } else {
            out.fill(0.0);
        }
        for (w, point) in weights[1..self.count.max(1)].iter().zip(older) {
            if *w != 0.0 {
                for ((x, y), y0) in out.iter_mut().zip(point).zip(&newest[0]) {
                    *x += w * (y - y0);
                }
            }
        }
    }
}

impl History {
    /// The polynomial through the newest `points` over the step [t, t + h] that ends at the newest.
    pub(super) fn polynomial(&self, t: f64, h: f64, points: usize, dims: Dims, out: &mut Dense) {
        let mut nodes = self.times.map(|x| (x - t) / h);
        (nodes[0], nodes[1]) = (1.0, 0.0);
        let basis = basis(&nodes[..points]);
        out.begin(t, h, points);
        for (power, weights) in basis.iter().enumerate().take(points) {
            let (q, v, z) = out.power_mut(power);
            for (w, point) in weights.iter().zip(&self.points).take(points) {
                let (pq, rest) = point.split_at(dims.q);
                let (pv, pz) = rest.split_at(dims.v);
                for (x, y) in [(&mut *q, pq), (&mut *v, pv), (&mut *z, pz)] {
                    x.iter_mut().zip(y).for_each(|(x, y)| *x += w * y);
                }
            }
        }
    }
}

/// The polynomials of degree below `nodes.len()` that are 1 at one node and 0 at the others, in powers: `out[power][node]`.
pub(super) fn basis(nodes: &[f64]) -> [Weights; MOST] {
    let mut out = [[0.0; MOST]; MOST];
    for (i, x) in nodes.iter().enumerate() {
        let mut polynomial = [0.0; MOST];
        polynomial[0] = 1.0;
        for (degree, y) in nodes.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, y)| y).enumerate() {
            for power in (0..=degree).rev() {
                polynomial[power + 1] += polynomial[power] / (x - y);
                polynomial[power] *= -y / (x - y);
            }
        }
        for (row, p) in out.iter_mut().zip(polynomial) {
            row[i] = p;
        }
    }
    out
}

fn copy(point: &mut [f64], parts: [&[f64]; 3]) {
    let all = parts.into_iter().flatten();
    point.iter_mut().zip(all).for_each(|(p, x)| *p = *x);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a polynomial at uneven times.
    fn samples(count: usize, y: impl Fn(f64) -> f64) -> History {
        let mut history = History::new(1);
        for i in 0..count {
            let t = -0.3 * i as f64 - 0.05 * (i * i) as f64;
            history.push_oldest(t, [&[], &[y(t)], &[]]);
        }
        history
    }

    #[test]
    fn polynomials_come_back() {
        let y = |t: f64| 1.0 + t * (2.0 - t * (3.0 - 0.5 * t));
        let history = samples(5, y);
        let (t, mut out) = (0.4, [0.0]);
        let [value, rate] = history.lagrange(t, 4);
        history.combine(&value, true, &mut out);
        assert!((out[0] - y(t)).abs() < 1e-13);
        history.combine(&rate, false, &mut out);
        assert!((out[0] - (2.0 - 6.0 * t + 1.5 * t * t)).abs() < 1e-12);
        history.combine(&history.difference(3, 0.1), false, &mut out);
        assert!((out[0] - 0.003).abs() < 1e-14, "{out:?}");
        history.combine(&history.difference(4, 0.1), false, &mut out);
        assert!(out[0].abs() < 1e-14, "{out:?}");
    }

    #[test]
    fn a_basis_is_one_at_its_node() {
        let nodes = [1.0, 0.0, -0.7, -2.0];
        let basis = basis(&nodes);
        for (i, x) in nodes.iter().enumerate() {
            (0..4).for_each(|j| {
                let value = (0..4).rev().fold(0.0, |sum, power| sum * x + basis[power][j]);
                assert!((value - f64::from(u8::from(i == j))).abs() < 1e-13);
            });
        }
    }

    #[test]
    fn the_newest_point_leads_and_the_oldest_falls_out() {
        let mut history = History::new(1);
        for i in 0..9 {
            history.push(f64::from(i), [&[], &[f64::from(i)], &[]]);
        }
        assert_eq!((history.count(), history.times()[0], history.times()[MOST - 1]), (MOST, 8.0, 2.0));
        history.replace(8.5, [&[], &[0.0], &[]]);
        assert_eq!(history.times()[..2], [8.5, 7.0]);
    }
}
