//! Rank of sparse rows by elimination.

use crate::Block;
use crate::kkt::columns::Columns;
use crate::kkt::reach::{FREE, Reach};
use std::collections::BTreeMap;

/// A pivot is taken from this part of a row's largest remainder on, from the column with the fewest entries in the rows to come.
const THRESHOLD: f64 = 0.5;

/// The rows of a sparse matrix, each eliminated by the independent ones before it.
///
/// With the rows as columns of B, independent ones are L U with the pivots of L in the columns that they took, and a dependent one is L u.
/// A remainder is never shorter than the distance of its row from those before, so that what counts as dependent is so.
#[derive(Clone, Debug, PartialEq)]
pub struct Elimination {
    /// Independent rows, in the order of their elimination.
    pub independent: Vec<usize>,
    /// Rows that depend on those before them, rising.
    pub dependent: Vec<usize>,
    /// Columns that no row took, rising.
    pub free: Vec<usize>,
    /// Column and pivot of each step.
    pivots: Vec<(usize, f64)>,
    /// L without its unit diagonal, by steps: columns with their factors.
    lower: Vec<Vec<(usize, f64)>>,
    /// U without its diagonal by steps, and u of each dependent row: steps with their factors.
    upper: Vec<Vec<(u32, f64)>>,
    combined: Vec<Vec<(u32, f64)>>,
}

impl Elimination {
    /// Of rows times `scale`: an entry in column j is multiplied by `unit[j]` as well. A row depends on those before if its remainder
    /// has no entry above `tolerance`, or above that part of the row.
    pub fn new(rows: &Block, scale: &[f64], unit: &[f64], tolerance: f64) -> Self {
        Self::in_order(0..scale.len(), rows, scale, unit, tolerance)
    }

    /// The same where no row depends on others, from the last row to the first; none where one does: which one that is would be another.
    ///
    /// Joints come from the ground outwards, as a rule. What a row takes on the outer side then stands in no row behind it, and nothing
    /// fills: in the other direction each row of a long chain may keep something of all those before it.
    pub fn of_independent(rows: &Block, scale: &[f64], unit: &[f64], tolerance: f64) -> Option<Self> {
        Some(Self::in_order((0..scale.len()).rev(), rows, scale, unit, tolerance)).filter(|found| found.dependent.is_empty())
    }

    fn in_order(order: impl Iterator<Item = usize>, rows: &Block, scale: &[f64], unit: &[f64], tolerance: f64) -> Self {
        let n = unit.len();
        let mut counts = vec![0_usize; n];
        rows.lines().for_each(|line| line.columns.iter().for_each(|&j| counts[j] += 1));
        let (mut step, mut reach, mut x) = (vec![FREE; n], Reach::new(n), vec![0.0; n]);
        let mut pattern: Columns<u32> = Columns::with_capacity(n, rows.values().len());
        let mut found = Self {
            independent: Vec::new(),
            dependent: Vec::new(),
            free: Vec::new(),
            pivots: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            combined: Vec::new(),
        };
        for i in order {
            let (line, scale) = (rows.line(i), scale[i]);
            // of the columns left those count that rows to come have
            line.columns.iter().for_each(|&j| counts[j] -= 1);
            reach.find(i as u32, line.columns, &step, &pattern);
            let mut square = 0.0;
            for (j, value) in line.entries() {
                x[j] = value * scale * unit[j];
                square += x[j] * x[j];
            }
            let above = reach.above.iter().map(|&k| {
                let u = std::mem::take(&mut x[found.pivots[k as usize].0]);
                found.lower[k as usize].iter().for_each(|&(j, l)| x[j] -= l * u);
                (k, u)
            });
            let above: Vec<(u32, f64)> = above.collect();
            let largest = reach.below.iter().fold(0.0, |m, &j| f64::max(m, x[j as usize].abs()));
            let remainder = reach.below.iter().map(|&j| (j as usize, std::mem::take(&mut x[j as usize])));
            let remainder: Vec<(usize, f64)> = remainder.collect();
            if largest <= tolerance * f64::max(1.0, square.sqrt()) {
                found.dependent.push(i);
                found.combined.push(above);
                continue;
            }
            let large = remainder.iter().filter(|(_, x)| x.abs() >= THRESHOLD * largest);
            let Some(&(column, pivot)) = large.min_by_key(|(j, _)| (counts[*j], *j)) else { continue };
            step[column] = found.pivots.len() as u32;
            found.pivots.push((column, pivot));
            found.independent.push(i);
            found.upper.push(above);
            let lower = remainder.into_iter().filter(|(j, x)| *j != column && *x != 0.0).map(|(j, x)| (j, x / pivot));
            let lower: Vec<(usize, f64)> = lower.collect();
            pattern.items.extend(lower.iter().map(|(j, _)| *j as u32));
            pattern.close();
            found.lower.push(lower);
        }
        found.free = (0..n).filter(|&j| step[j] == FREE).collect();
        found
    }

    /// The vector (columns) that all scaled rows annihilate with the given values in the free columns, in the units of `unit`.
    pub fn annihilated(&self, free: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.free.len() + self.pivots.len()];
        self.free.iter().zip(free).for_each(|(&j, value)| x[j] = *value);
        // Lᵀ x = 0
        for (&(column, _), lower) in self.pivots.iter().zip(&self.lower).rev() {
            x[column] = -lower.iter().map(|&(j, l)| l * x[j]).sum::<f64>();
        }
        x
    }

    /// The combinations of scaled rows that vanish, one for each dependent row: rows with their factors, that of the row itself 1.
    pub fn vanishing(&self) -> impl Iterator<Item = Vec<(usize, f64)>> + '_ {
        self.dependent.iter().zip(&self.combined).map(|(&row, combined)| {
            // U c = u, from the last step to the first
            let mut left: BTreeMap<u32, f64> = combined.iter().copied().collect();
            let mut out = vec![(row, 1.0)];
            while let Some((step, u)) = left.pop_last() {
                let k = step as usize;
                let c = u / self.pivots[k].1;
                self.upper[k].iter().for_each(|&(j, u)| *left.entry(j).or_default() -= u * c);
                out.push((self.independent[k], -c));
            }
            out
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sparsity;
    use crate::noise::Noise;

    /// A band of rows (n × n + 2), every third followed by a sum of those before it.
    fn band(n: usize) -> Block {
        let mut noise = Noise(9);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for i in 0..n {
            let mut row = vec![0.0; n + 2];
            if i % 3 == 2 {
                for (k, factor) in [(i - 1, 0.7), (i - 2, -1.3)] {
                    let other = rows[k].clone();
                    row.iter_mut().zip(other).for_each(|(x, y)| *x += factor * y);
                }
            } else {
                (0..3).for_each(|k| row[i + k] = noise.next() + if k == 0 { 2.0 } else { 0.0 });
            }
            rows.push(row);
        }
        let entries = rows.iter().enumerate().flat_map(|(i, row)| (0..row.len()).filter(|&j| row[j] != 0.0).map(move |j| (i, j)));
        let mut block = Block::new(&Sparsity::new(n, n + 2, entries.collect::<Vec<_>>()));
        rows.iter().enumerate().for_each(|(i, row)| (0..row.len()).filter(|&j| row[j] != 0.0).for_each(|j| block.set(i, j, row[j])));
        block
    }

    #[test]
    fn later_rows_that_are_combinations_are_named_with_these() {
        let n = 30;
        let rows = band(n);
        let (scale, unit) = (vec![2.0; n], vec![0.5; n + 2]);
        let found = Elimination::new(&rows, &scale, &unit, 1e-10);
        assert_eq!(found.dependent, (2..n).step_by(3).collect::<Vec<_>>());
        assert_eq!((found.independent.len(), found.free.len()), (20, 12));
        for vanishing in found.vanishing() {
            let mut sum = vec![0.0; n + 2];
            vanishing.iter().for_each(|&(i, c)| rows.line(i).add_to(c, &mut sum));
            assert!(vanishing.len() == 3 && vanishing[0].1 == 1.0 && sum.iter().all(|x| x.abs() < 1e-13), "{vanishing:?}");
        }
        let y: Vec<f64> = (0..12).map(|k| f64::from(k).cos()).collect();
        let x = found.annihilated(&y);
        assert!(rows.lines().all(|line| line.dot(&x).abs() < 1e-12));
        assert!(found.free.iter().zip(&y).all(|(&j, y)| x[j] == *y));
    }

    #[test]
    fn a_chain_does_not_fill() {
        // each row decides the place behind, mostly, by the one before and one that stays free
        let n = 200;
        let mut rows = Block::new(&Sparsity::new(n, 2 * n + 1, (0..n).flat_map(|i| (0..3).map(move |k| (i, 2 * i + k)))));
        for i in 0..n {
            [-0.4, 0.4, 1.0].into_iter().enumerate().for_each(|(k, x)| rows.set(i, 2 * i + k, x));
        }
        let (scale, unit) = (vec![1.0; n], vec![1.0; 2 * n + 1]);
        let entries = |found: &Elimination| found.lower.iter().map(Vec::len).sum::<usize>();
        let forwards = Elimination::new(&rows, &scale, &unit, 1e-10);
        let backwards = Elimination::of_independent(&rows, &scale, &unit, 1e-10).unwrap();
        assert_eq!((entries(&forwards), entries(&backwards)), (n * (n + 3) / 2, 2 * n));
        assert_eq!(forwards.free, backwards.free);
        let free: Vec<f64> = (0..=n).map(|k| (k as f64).cos()).collect();
        let [one, other] = [forwards, backwards].map(|found| found.annihilated(&free));
        assert!(one.iter().zip(&other).all(|(x, y)| (x - y).abs() < 1e-14));
        assert!(rows.lines().all(|row| row.dot(&one).abs() < 1e-14));
        // a row that depends on others is named in the order of the rows
        assert_eq!(Elimination::of_independent(&band(6), &[1.0; 6], &[1.0; 8], 1e-10), None);
    }

    #[test]
    fn remainders_are_judged_by_the_tolerance() {
        let mut rows = Block::full(3, 3);
        rows.values_mut().copy_from_slice(&[1.0, 1.0, 0.0, 1.0, 1.0, 1e-9, 0.0, 0.0, 0.0]);
        let found = |tolerance: f64| Elimination::new(&rows, &[1.0; 3], &[1.0; 3], tolerance).dependent;
        assert_eq!((found(1e-8), found(1e-10)), (vec![1, 2], vec![2]));
    }
}
