//! How many eigenvalues of a symmetric matrix are negative.
//!
//! By Sylvester's law A = L D Lᵀ has as many as D. Pivots of one and of two columns keep L small (Bunch & Kaufman, Math. Comp. 31 (1977)
//! 163-179), and the next one is sought in the row with the fewest entries, so that sparse matrices stay so.
//!
//! For a pair K x = λ M x on motions with G x = 0, the matrix [K − σM, Gᵀ; G, −E] has a negative eigenvalue for each row of G and for each λ
//! below σ: the count that proves that an iteration has missed none (Bathe, Finite Element Procedures, 2nd edition, section 11.6.4, there
//! without constraints).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Bunch and Kaufman's bound (1 + √17)/8.
const ALPHA: f64 = 0.6404;

/// A partner of two columns is the one with the fewest entries among those from this part of the largest on.
const LARGE: f64 = 0.5;

/// Number of negative eigenvalues of a symmetric matrix, given by the entries (row, column, value) of both of its triangles; entries of
/// one place are added.
pub fn negative_eigenvalues(n: usize, entries: impl IntoIterator<Item = (usize, usize, f64)>) -> usize {
    let mut rows: Vec<Row> = vec![Vec::new(); n];
    entries.into_iter().for_each(|(i, j, value)| rows[i].push((j, value)));
    for row in &mut rows {
        row.sort_unstable_by_key(|(j, _)| *j);
        row.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            kept.1 += if same { next.1 } else { 0.0 };
            same
        });
    }
    let mut queue: BinaryHeap<_> = rows.iter().enumerate().map(|(i, row)| Reverse((row.len(), i))).collect();
    let mut done = vec![false; n];
    let mut negative = 0;
    while let Some(Reverse((length, i))) = queue.pop() {
        if done[i] || rows[i].len() != length {
            continue;
        }
        let (pivot, count) = pivot(&rows, i);
        negative += count;
        let lines: Vec<(usize, Row)> = pivot.iter().map(|&p| (p, std::mem::take(&mut rows[p]))).collect();
        pivot.iter().for_each(|&p| done[p] = true);
        for k in eliminated(&lines, &mut rows, &done) {
            queue.push(Reverse((rows[k].len(), k)));
        }
    }
    negative
}

/// Columns with their entries, rising.
type Row = Vec<(usize, f64)>;

fn at(row: &Row, j: usize) -> f64 {
    row.binary_search_by_key(&j, |(j, _)| *j).map_or(0.0, |k| row[k].1)
}

/// The size of the largest entry of row i beside its diagonal.
fn beside(row: &Row, i: usize) -> f64 {
    row.iter().filter(|(j, _)| *j != i).fold(0.0, |m, (_, x)| f64::max(m, x.abs()))
}

/// The next pivot, of column i, its partner or both, and its number of negative eigenvalues.
fn pivot(rows: &[Row], i: usize) -> (Vec<usize>, usize) {
    let (diagonal, most) = (at(&rows[i], i), beside(&rows[i], i));
    let one = |p: usize, x: f64| (vec![p], usize::from(x < 0.0));
    if diagonal.abs() >= ALPHA * most {
        return one(i, diagonal);
    }
    let large = rows[i].iter().filter(|(j, x)| *j != i && x.abs() >= LARGE * most);
    let Some(&(r, across)) = large.min_by_key(|(j, _)| rows[*j].len()) else { return one(i, diagonal) };
    let (other, others) = (at(&rows[r], r), beside(&rows[r], r));
    if diagonal.abs() * others >= ALPHA * across * across {
        return one(i, diagonal);
    }
    if other.abs() >= ALPHA * others {
        return one(r, other);
    }
    let count = match diagonal * other - across * across {
        determinant if determinant < 0.0 => 1,
        _ if diagonal + other < 0.0 => 2,
        _ => 0,
    };
    (vec![i, r], count)
}

/// Takes the part of the lines of a pivot from the rows that meet them, and gives those.
fn eliminated(lines: &[(usize, Row)], rows: &mut [Row], done: &[bool]) -> Vec<usize> {
    // the pivot's inverse times its lines
    let solved: Vec<Row> = match lines {
        [(p, line)] => {
            let d = at(line, *p);
            vec![if d == 0.0 { Row::new() } else { line.iter().map(|(j, x)| (*j, x / d)).collect() }]
        }
        [(p, first), (r, second)] => {
            let (a, b, c) = (at(first, *p), at(first, *r), at(second, *r));
            let determinant = a * c - b * b;
            let combined = |x: f64, y: f64| merged(first, x / determinant, second, y / determinant);
            vec![combined(c, -b), combined(-b, a)]
        }
        _ => Vec::new(),
    };
    let mut met: Vec<usize> = lines.iter().flat_map(|(_, line)| line.iter().map(|(j, _)| *j)).filter(|j| !done[*j]).collect();
    met.sort_unstable();
    met.dedup();
    for &k in &met {
        let factors: Vec<f64> = lines.iter().map(|(p, _)| at(&rows[k], *p)).collect();
        for (factor, solved) in factors.iter().zip(&solved).filter(|(factor, _)| **factor != 0.0) {
            rows[k] = merged(&rows[k], 1.0, solved, -factor);
        }
        rows[k].retain(|(j, _)| !done[*j]);
    }
    met
}

/// x·first + y·second.
fn merged(first: &Row, x: f64, second: &Row, y: f64) -> Row {
    let mut out = Row::with_capacity(first.len() + second.len());
    let (mut a, mut b) = (first.iter().peekable(), second.iter().peekable());
    loop {
        match (a.peek(), b.peek()) {
            (Some((i, u)), Some((j, w))) if i == j => {
                out.push((*i, x * u + y * w));
                a.next();
                b.next();
            }
            (Some((i, u)), other) if other.is_none_or(|(j, _)| i < j) => {
                out.push((*i, x * u));
                a.next();
            }
            (_, Some((j, w))) => {
                out.push((*j, y * w));
                b.next();
            }
            _ => return out,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::Noise;

    /// The count for a matrix of order n with `negative` negative eigenvalues and the entries outside of the diagonal that `fill` keeps in
    /// its factor T.
    fn counted(n: usize, negative: usize, fill: impl Fn(usize, usize, f64) -> bool) -> usize {
        let mut noise = Noise(7);
        // A = T D Tᵀ with a regular T
        let mut t = vec![vec![0.0; n]; n];
        for (i, row) in t.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate().take(i + 1) {
                let value = noise.next();
                *x = if i == j {
                    1.0
                } else if fill(i, j, value) {
                    value
                } else {
                    0.0
                };
            }
        }
        let d = |k: usize| if k < negative { -1.0 - k as f64 } else { 0.5 + k as f64 };
        let entries = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let value = |(i, j): (usize, usize)| (i, j, (0..n).map(|k| t[i][k] * d(k) * t[j][k]).sum());
        negative_eigenvalues(n, entries.map(value).filter(|e: &(usize, usize, f64)| e.2 != 0.0).collect::<Vec<_>>())
    }

    #[test]
    fn signs_are_those_of_the_congruent_diagonal() {
        for negative in [0, 1, 7, 19, 20] {
            assert_eq!(counted(20, negative, |_, _, _| true), negative);
            assert_eq!(counted(20, negative, |i, j, _| i - j < 3), negative);
            assert_eq!(counted(20, negative, |_, _, x| x > 0.3), negative);
        }
    }

    #[test]
    fn zero_diagonals_take_pivots_of_two_columns() {
        // [A Gᵀ; G 0] with regular rows has one for each of them
        let swap = [(0, 1, 1.0), (1, 0, 1.0)];
        assert_eq!(negative_eigenvalues(2, swap), 1);
        let held = [(0, 0, 2.0), (1, 1, -3.0), (0, 2, 1.0), (2, 0, 1.0), (1, 3, 1.0), (3, 1, 1.0)];
        assert_eq!(negative_eigenvalues(4, held), 2);
        assert_eq!(negative_eigenvalues(3, []), 0);
    }
}
