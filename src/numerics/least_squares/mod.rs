//! Least-squares solves at assembly, where rows may be redundant or contradict each other: by singular values where these cost next to
//! nothing, else by sparse factorisations.

mod dense;
mod redundant;
mod rows;
mod sparse;

pub(crate) use dense::{left_open, shortest, shortest_beyond};
pub(crate) use redundant::Redundant;
pub(crate) use rows::{Level, Rows};

use dense::FEW;
use nalgebra::DMatrix;
use sparse::{Group, Slack};

/// Weight of the length of x beside rows that need not determine it, in parts of the square of their longest.
const SHORT: f64 = 1e-12;

/// What rows may miss, in parts of 1 and of the largest right side, where they count as met.
const MET: f64 = 1e-9;

/// The shortest x (in the metric, Σ dᵢ xᵢ²) that makes |A x − b|² + μ (its size)² least, where singular values of A D^−½ up to
/// `round_off` are nothing else. With μ = 0 it is the pseudo-inverse in the metric; μ > 0 is Levenberg's damping.
#[must_use]
pub(crate) fn step(round_off: f64, rows: &Rows, b: &[f64], metric: &[f64], damping: f64) -> Vec<f64> {
    if metric.len() > FEW {
        let slack = if damping > 0.0 { Slack::Some(damping) } else { Slack::None { round_off } };
        if let Some(x) = sparse::solve(&[Group { rows, b, slack }], metric, 1.0) {
            return x;
        }
    }
    shortest_beyond(round_off, &rows.to_dense(metric.len()), b, metric, damping)
}

/// x + δ with the shortest δ (in the metric) that makes |A x − b|² least for the first level, among those for the second, and so on; once
/// more from there, which takes the last digits.
#[must_use]
pub(crate) fn in_turn(levels: &[Level], metric: &[f64], x: Vec<f64>) -> Vec<f64> {
    if metric.len() > FEW
        && let Some(x) = sparsely_in_turn(levels, metric, &x)
    {
        return x;
    }
    let x = dense::in_turn(levels, metric, x);
    dense::in_turn(levels, metric, x)
}

/// The same where the rows of all levels but the last can be met together; none where they cannot.
fn sparsely_in_turn(levels: &[Level], metric: &[f64], x: &[f64]) -> Option<Vec<f64>> {
    if levels.iter().flat_map(|level| level.missing(x)).all(|b| b == 0.0) {
        return Some(x.to_vec());
    }
    let last = levels.iter().rposition(|level| !level.rows.is_empty())?;
    let groups = levels[..=last].iter().enumerate().map(|(k, level)| {
        let slack = if k == last && k > 0 { Slack::Some(1.0) } else { Slack::None { round_off: level.round_off } };
        Group { rows: &level.rows, b: &level.b, slack }
    });
    let groups: Vec<Group> = groups.collect();
    let weight = if last > 0 { SHORT } else { 1.0 };
    let mut saddle = sparse::Saddle::new(&groups, metric, weight)?;
    let mut closer = |x: &[f64]| -> Option<Vec<f64>> {
        let missing: Vec<f64> = levels[..=last].iter().flat_map(|level| level.missing(x)).collect();
        let delta = saddle.solve(&[], &missing);
        delta.iter().all(|x| x.is_finite()).then(|| x.iter().zip(&delta).map(|(x, delta)| x + delta).collect())
    };
    let x = closer(x).and_then(|x| closer(&x))?;
    let holds = |level: &Level| {
        let scale = 1.0 + level.b.iter().fold(0.0, |m, b| f64::max(m, b.abs()));
        level.missing(&x).iter().all(|off| off.abs() <= MET * scale)
    };
    levels[..usize::max(last, 1)].iter().all(holds).then_some(x)
}

/// Whether all singular values of A D^−½ are above `least`, and far above what rounding leaves.
#[must_use]
pub(crate) fn are_independent(rows: &Rows, metric: &[f64], least: f64) -> bool {
    let clear = f64::max(dense::CLEAR * rows.longest(metric), 10.0 * least);
    if metric.len() > FEW {
        return rows.len() <= metric.len() && sparse::least_singular_value(rows, metric) > 2.0 * clear;
    }
    dense::are_independent(&scaled(rows, metric), least)
}

/// Whether all singular values of A D^−½ are above a part of the largest.
#[must_use]
pub(crate) fn are_above(rows: &Rows, metric: &[f64], part: f64) -> bool {
    if rows.is_empty() {
        return true;
    }
    if metric.len() > FEW {
        return rows.len() <= metric.len() && sparse::least_singular_value(rows, metric) > 2.0 * part * rows.most(metric);
    }
    dense::are_above(&scaled(rows, metric), part)
}

/// A D^−½ as a full matrix.
#[must_use]
pub(crate) fn scaled(rows: &Rows, metric: &[f64]) -> DMatrix<f64> {
    dense::scaled(&rows.to_dense(metric.len()), metric)
}

/// Gauss-Newton's steps towards the least |r| among the motions that rows leave.
pub(crate) struct Within<'r> {
    hold: &'r Rows,
    round_off: f64,
    slopes: &'r Rows,
    /// −r.
    right: Vec<f64>,
    metric: &'r [f64],
    dense: Option<dense::Within>,
}

impl<'r> Within<'r> {
    /// For the residual r with its slopes and the rows that must hold, of which singular values up to `round_off` are nothing else.
    pub(crate) fn new(hold: &'r Rows, round_off: f64, slopes: &'r Rows, r: &[f64], metric: &'r [f64]) -> Self {
        let n = metric.len();
        let dense = (n <= FEW).then(|| dense::Within::new(&hold.to_dense(n), round_off, &slopes.to_dense(n), metric));
        Self { hold, round_off, slopes, right: r.iter().map(|r| -r).collect(), metric, dense }
    }

    /// Length of the slope of ½ |r|² along the motions, in the metric.
    pub(crate) fn slope(&self) -> f64 {
        if let Some(dense) = &self.dense {
            return dense.slope(&self.right);
        }
        let mut force = vec![0.0; self.metric.len()];
        for (line, b) in self.slopes.lines().zip(&self.right) {
            line.iter().for_each(|&(j, a)| force[j] += a * b);
        }
        let hold = Group { rows: self.hold, b: &[], slack: Slack::None { round_off: self.round_off } };
        let along = sparse::Saddle::new(&[hold], self.metric, 1.0).map(|mut saddle| saddle.solve(&force, &[]));
        along.map_or(f64::INFINITY, |x| x.iter().zip(self.metric).map(|(x, d)| x * x * d).sum::<f64>().sqrt())
    }

    /// The shortest step that makes |r|² + μ (its size)² least; none where that is not determined.
    pub(crate) fn step(&self, damping: f64) -> Option<Vec<f64>> {
        if let Some(dense) = &self.dense {
            return Some(dense.step(&self.right, damping));
        }
        let still = vec![0.0; self.hold.len()];
        let hold = Group { rows: self.hold, b: &still, slack: Slack::None { round_off: self.round_off } };
        let near = Group { rows: self.slopes, b: &self.right, slack: Slack::Some(1.0) };
        sparse::solve(&[hold, near], self.metric, damping.max(SHORT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = FEW + 16;

    /// A band of rows of no special rule, over columns of several sizes.
    fn band(rows: usize) -> (Rows, Vec<f64>) {
        let mut band = Rows::default();
        for i in 0..rows {
            band.push((i..i + 4).map(|j| (j, ((3 * i + 7 * j * j + i * j) as f64).sin())));
        }
        (band, (0..N).map(|k| 10f64.powi(k as i32 % 3 - 1)).collect())
    }

    fn near(x: &[f64], y: &[f64], part: f64) {
        let size = y.iter().fold(0.0, |m, y| f64::max(m, y.abs()));
        assert!(x.iter().zip(y).all(|(x, y)| (x - y).abs() < part * size), "{x:?}\n{y:?}");
    }

    #[test]
    fn sparse_steps_are_those_of_singular_values() {
        let (mut rows, metric) = band(40);
        let mut b: Vec<f64> = (0..40).map(|i| f64::from(i).cos()).collect();
        // a row twice, and one that is made of two
        let sum = rows.line(5).iter().chain(rows.line(6)).copied().collect::<Vec<_>>();
        rows.push(rows.line(3).to_vec());
        rows.push(sum);
        b.extend([b[3], b[5] + b[6]]);
        for damping in [0.0, 1e-4] {
            // damping counts in parts of the longest row there, of the largest singular value here
            let parts = rows.longest(&metric) / grashof_solvers::svd::Svd::new(&scaled(&rows, &metric)).largest();
            let dense = shortest_beyond(0.0, &rows.to_dense(N), &b, &metric, damping * parts * parts);
            near(&step(0.0, &rows, &b, &metric, damping), &dense, 1e-11);
        }
    }

    #[test]
    fn sparse_levels_are_met_in_turn() {
        let (rows, metric) = band(60);
        let level = |from: usize, to: usize| {
            let mut level = Level::default();
            (from..to).for_each(|i| level.row(rows.line(i).to_vec(), i as f64 - 3.0, 1.0));
            level
        };
        let mut rest = Level::default();
        (0..N).for_each(|j| rest.row([(j, 1.0 + j as f64 / 50.0), ((j + 1) % N, 0.1)], 0.0, 1.0));
        let start = vec![0.1; N];
        for levels in [vec![level(0, 30), level(30, 60), rest.clone()], vec![level(0, 30), Level::default(), rest], vec![level(0, 30)]] {
            let sparse = sparsely_in_turn(&levels, &metric, &start).unwrap();
            near(&sparse, &dense::in_turn(&levels, &metric, start.clone()), 1e-10);
        }
        // guesses that contradict what holds are for the singular values
        let mut guess = Level::default();
        guess.row(rows.line(4).to_vec(), 9.0, 1.0);
        assert!(sparsely_in_turn(&[level(0, 30), guess, level(40, 41)], &metric, &start).is_none());
    }

    #[test]
    fn sparse_dependence_is_seen() {
        let (mut rows, metric) = band(60);
        assert!(are_independent(&rows, &metric, 0.0) && are_above(&rows, &metric, 1e-5));
        assert!(dense::are_independent(&scaled(&rows, &metric), 0.0) && dense::are_above(&scaled(&rows, &metric), 1e-5));
        // next to a combination of two
        let sum = rows.line(20).iter().chain(rows.line(22)).copied().chain([(30, 1e-8)]).collect::<Vec<_>>();
        rows.push(sum);
        assert!(!are_independent(&rows, &metric, 0.0) && !are_above(&rows, &metric, 1e-5));
    }

    #[test]
    fn sparse_steps_stay_within_what_rows_leave() {
        let (hold, metric) = band(40);
        let mut slopes = Rows::default();
        (0..N).for_each(|j| slopes.push([(j, 1.0), ((j + 5) % N, 0.3)]));
        let r: Vec<f64> = (0..N).map(|k| (k as f64).sin()).collect();
        let sparse = Within::new(&hold, 0.0, &slopes, &r, &metric);
        let dense = Within {
            dense: Some(dense::Within::new(&hold.to_dense(N), 0.0, &slopes.to_dense(N), &metric)),
            ..Within::new(&hold, 0.0, &slopes, &r, &metric)
        };
        assert!((sparse.slope() - dense.slope()).abs() < 1e-9 * dense.slope());
        near(&sparse.step(0.0).unwrap(), &dense.step(0.0).unwrap(), 1e-9);
    }
}
