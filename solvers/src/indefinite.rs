//! L D Lᵀ of a sparse symmetric matrix that is not definite: its solutions, and how many of its eigenvalues are negative.
//!
//! By Sylvester's law A = L D Lᵀ has as many as D. Pivots of one and of two columns keep L small (Bunch & Kaufman, Math. Comp. 31 (1977)
//! 163-179), and the next one is that whose lines have the fewest columns together, so that sparse matrices stay so: the order follows the
//! numbers, where that of [`crate::Kkt`] is made once for all matrices of a pattern, and takes all velocities before all rows. A row without a
//! diagonal of its own is taken with a partner, which costs what both meet: sought by its own entries alone, rows of joints came first and
//! chained the bodies together [measured, 3000 bars on a tree of short roads: 6·10⁷ products to a matrix, and 2·10⁶ so].
//!
//! For a pair K x = λ M x on motions with G x = 0, the matrix [K − σM, Gᵀ; G, −E] has a negative eigenvalue for each row of G and for each λ
//! below σ: the count that proves that an iteration has missed none (Bathe, Finite Element Procedures, 2nd edition, section 11.6.4, there
//! without constraints).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Bunch and Kaufman's bound (1 + √17)/8.
const ALPHA: f64 = 0.6404;

/// Part of the largest entry of its row with which a diagonal is a pivot of its own: small enough to leave a choice (Duff & Reid, ACM Trans.
/// Math. Softw. 9 (1983) 302-325).
const ENOUGH: f64 = 0.05;

/// A partner of two columns is the one with the fewest entries among those from this part of the largest on.
const LARGE: f64 = 0.5;

/// The factors of a symmetric matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Indefinite {
    steps: Vec<Step>,
    negative: usize,
}

/// One or two columns that are eliminated together, with what their lines had when they were.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    lines: Vec<(usize, Row)>,
    block: PivotBlock,
}

/// The inverse of a pivot: its diagonal, and what is beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PivotBlock {
    first: f64,
    second: f64,
    beside: f64,
}

impl PivotBlock {
    fn new(lines: &[(usize, Row)]) -> Self {
        match lines {
            [(p, line)] => {
                let d = at(line, *p);
                Self { first: if d == 0.0 { 0.0 } else { d.recip() }, second: 0.0, beside: 0.0 }
            }
            [(p, first), (r, second)] => {
                let (a, b, c) = (at(first, *p), at(first, *r), at(second, *r));
                let determinant = a * c - b * b;
                Self { first: c / determinant, second: a / determinant, beside: -b / determinant }
            }
            _ => Self { first: 0.0, second: 0.0, beside: 0.0 },
        }
    }

    /// Which columns of the pivot a row with these values in them meets: a row that is held by another one, as by [a b; b 0], does not meet
    /// all that hang on that. By what is 0 alone, so that what a row meets in another one, that one meets in it.
    fn reaches(self, [x, y]: [f64; 2]) -> [bool; 2] {
        let (x, y, beside) = (x != 0.0, y != 0.0, self.beside != 0.0);
        [self.first != 0.0 && x || beside && y, beside && x || self.second != 0.0 && y]
    }

    /// The inverse times the values of its columns.
    fn times(self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.first * x + self.beside * y, self.beside * x + self.second * y]
    }
}

impl Indefinite {
    /// Factors a symmetric matrix of order n, given by the entries (row, column, value) of both of its triangles; entries of one place are
    /// added. A pivot of 0 takes no part.
    pub fn new(n: usize, entries: impl IntoIterator<Item = (usize, usize, f64)>) -> Self {
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
        let mut elimination = Elimination::default();
        let mut queue: BinaryHeap<_> = (0..n).map(|i| Reverse((cost(&rows, i), i))).collect();
        let mut done = vec![false; n];
        let mut factors = Self { steps: Vec::new(), negative: 0 };
        while let Some(Reverse((told, i))) = queue.pop() {
            if done[i] {
                continue;
            }
            // a partner may have grown
            let now = cost(&rows, i);
            if now > told {
                queue.push(Reverse((now, i)));
                continue;
            }
            let (pivot, count) = pivot(&rows, i);
            factors.negative += count;
            let lines: Vec<(usize, Row)> = pivot.iter().map(|&p| (p, std::mem::take(&mut rows[p]))).collect();
            pivot.iter().for_each(|&p| done[p] = true);
            let block = PivotBlock::new(&lines);
            for &k in elimination.of(&lines, block, &mut rows) {
                queue.push(Reverse((cost(&rows, k), k)));
            }
            factors.steps.push(Step { lines, block });
        }
        factors
    }

    /// Number of negative eigenvalues.
    #[must_use]
    pub fn negative(&self) -> usize {
        self.negative
    }

    /// Puts the solution with the right-hand side `b` (n) in its place.
    pub fn solve(&self, b: &mut [f64]) {
        for Step { lines, block } in &self.steps {
            let z = block.times(on_pivot(lines, |p, _| b[p]));
            for ((_, line), z) in lines.iter().zip(z) {
                beyond(lines, line).for_each(|(j, x)| b[j] -= x * z);
            }
            lines.iter().zip(z).for_each(|((p, _), z)| b[*p] = z);
        }
        for Step { lines, block } in self.steps.iter().rev() {
            let known = block.times(on_pivot(lines, |_, line| beyond(lines, line).map(|(j, x)| x * b[j]).sum()));
            lines.iter().zip(known).for_each(|((p, _), known)| b[*p] -= known);
        }
    }
}

/// A number for each column of a pivot, 0 for a second one that is not there.
fn on_pivot(lines: &[(usize, Row)], of: impl Fn(usize, &Row) -> f64) -> [f64; 2] {
    let mut out = [0.0; 2];
    out.iter_mut().zip(lines).for_each(|(out, (p, line))| *out = of(*p, line));
    out
}

/// Entries of a line outside of its pivot.
fn beyond<'a>(lines: &'a [(usize, Row)], line: &'a Row) -> impl Iterator<Item = (usize, f64)> + 'a {
    line.iter().copied().filter(move |(j, _)| lines.iter().all(|(p, _)| p != j))
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

/// How many columns the lines of the next pivot of column i have together.
fn cost(rows: &[Row], i: usize) -> usize {
    match pivot(rows, i).0[..] {
        [p, r] => rows[p].len() + rows[r].len() - shared(&rows[p], &rows[r]),
        [p] => rows[p].len(),
        _ => 0,
    }
}

/// How many columns two rows share.
fn shared(first: &Row, second: &Row) -> usize {
    let (mut rest, mut count) = (&second[..], 0);
    for (i, _) in first {
        let skipped = rest.iter().take_while(|(j, _)| j < i).count();
        rest = &rest[skipped..];
        count += usize::from(rest.first().is_some_and(|(j, _)| j == i));
    }
    count
}

/// The next pivot, of column i, its partner or both, and its number of negative eigenvalues.
fn pivot(rows: &[Row], i: usize) -> (Vec<usize>, usize) {
    let (diagonal, most) = (at(&rows[i], i), beside(&rows[i], i));
    let one = |p: usize, x: f64| (vec![p], usize::from(x < 0.0));
    if diagonal.abs() >= ENOUGH * most {
        return one(i, diagonal);
    }
    let large = rows[i].iter().filter(|(j, x)| *j != i && x.abs() >= LARGE * most);
    let Some(&(r, across)) = large.min_by_key(|(j, _)| rows[*j].len()) else { return one(i, diagonal) };
    let (other, others) = (at(&rows[r], r), beside(&rows[r], r));
    if diagonal.abs() * others >= ALPHA * across * across {
        return one(i, diagonal);
    }
    if other.abs() >= ENOUGH * others {
        return one(r, other);
    }
    let count = match diagonal * other - across * across {
        determinant if determinant < 0.0 => 1,
        _ if diagonal + other < 0.0 => 2,
        _ => 0,
    };
    (vec![i, r], count)
}

/// The lines of a pivot while they are taken from other rows: what they need is kept from pivot to pivot.
#[derive(Default)]
struct Elimination {
    /// Columns of the lines outside of the pivot, rising, with the entries of one line or two there.
    across: Vec<(usize, [f64; 2])>,
    /// The same columns, which are the rows that meet the lines.
    met: Vec<usize>,
    row: Row,
}

impl Elimination {
    /// Takes the part of the lines of a pivot from the rows that meet them, and gives those.
    fn of(&mut self, lines: &[(usize, Row)], block: PivotBlock, rows: &mut [Row]) -> &[usize] {
        self.across.clear();
        match lines {
            [(_, line)] => self.across.extend(beyond(lines, line).map(|(j, x)| (j, [x, 0.0]))),
            [(_, first), (_, second)] => self.pair(beyond(lines, first), beyond(lines, second)),
            _ => {}
        }
        self.met.clear();
        self.met.extend(self.across.iter().map(|(j, _)| *j));
        for &(k, own) in &self.across {
            let (factors, reaches) = (block.times(own), block.reaches(own));
            taken(&rows[k], lines, &self.across, (factors, reaches), &mut self.row);
            std::mem::swap(&mut rows[k], &mut self.row);
        }
        &self.met
    }

    /// Both lines of a pivot beside each other.
    fn pair(&mut self, first: impl Iterator<Item = (usize, f64)>, second: impl Iterator<Item = (usize, f64)>) {
        let (mut first, mut second) = (first.peekable(), second.peekable());
        loop {
            let next = match (first.peek(), second.peek()) {
                (Some((i, _)), Some((j, _))) => *i.min(j),
                (Some((i, _)), None) | (None, Some((i, _))) => *i,
                (None, None) => return,
            };
            let x = first.next_if(|(i, _)| *i == next).map_or(0.0, |(_, x)| x);
            let y = second.next_if(|(j, _)| *j == next).map_or(0.0, |(_, y)| y);
            self.across.push((next, [x, y]));
        }
    }
}

/// A row without the columns of a pivot, less `factors` times its lines.
fn taken(row: &Row, lines: &[(usize, Row)], across: &[(usize, [f64; 2])], ([f, g], reaches): ([f64; 2], [bool; 2]), out: &mut Row) {
    let fills = |[u, w]: &[f64; 2]| reaches[0] && *u != 0.0 || reaches[1] && *w != 0.0;
    out.clear();
    out.reserve(row.len() + across.len());
    let mut rest = across;
    for &(i, x) in row.iter().filter(|(i, _)| lines.iter().all(|(p, _)| p != i)) {
        while let [(j, [u, w]), after @ ..] = rest
            && *j < i
        {
            if fills(&[*u, *w]) {
                out.push((*j, -(f * u + g * w)));
            }
            rest = after;
        }
        match rest {
            [(j, [u, w]), after @ ..] if *j == i => {
                out.push((i, x - (f * u + g * w)));
                rest = after;
            }
            _ => out.push((i, x)),
        }
    }
    out.extend(rest.iter().filter(|(_, entries)| fills(entries)).map(|(j, [u, w])| (*j, -(f * u + g * w))));
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
        let all: Vec<(usize, usize, f64)> = entries.map(value).filter(|e: &(usize, usize, f64)| e.2 != 0.0).collect();
        let factors = Indefinite::new(n, all.iter().copied());
        // the solution meets its right-hand side
        let right = noise.vector(n);
        let mut x = right.clone();
        factors.solve(&mut x);
        let mut left = vec![0.0; n];
        all.iter().for_each(|(i, j, a)| left[*i] += a * x[*j]);
        let size = x.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        assert!(left.iter().zip(&right).all(|(l, r)| (l - r).abs() < 1e-9 * size), "{left:?} {right:?}");
        factors.negative()
    }

    #[test]
    fn signs_are_those_of_the_congruent_diagonal() {
        for negative in [0, 1, 7, 19, 20] {
            assert_eq!(counted(20, negative, |_, _, _| true), negative);
            assert_eq!(counted(20, negative, |i, j, _| i - j < 3), negative);
            assert_eq!(counted(20, negative, |_, _, x| x > 0.3), negative);
        }
    }

    /// Blocks in a row, each of which is full and of any sign, joined to the next by rows without a diagonal: as bodies of a chain are by
    /// the rows of joints.
    #[test]
    fn rows_between_blocks_do_not_chain_them_together() {
        let (blocks, size, joined) = (60, 12, 4);
        let (mut noise, mut entries) = (Noise(3), Vec::new());
        let order = blocks * size;
        for block in 0..blocks {
            for i in 0..size {
                for j in 0..=i {
                    let x = noise.next();
                    let (i, j) = (block * size + i, block * size + j);
                    entries.push((i, j, x));
                    if i != j {
                        entries.push((j, i, x));
                    }
                }
            }
        }
        for (joint, row) in (0..blocks - 1).flat_map(|joint| (0..joined).map(move |k| (joint, joint * joined + k))) {
            // all of a block, and a few of the next one
            for i in (0..size).map(|i| joint * size + i).chain((0..joined).map(|i| (joint + 1) * size + i)) {
                let x = noise.next();
                entries.extend([(i, order + row, x), (order + row, i, x)]);
            }
        }
        let rows = (blocks - 1) * joined;
        let factors = Indefinite::new(order + rows, entries.iter().copied());
        assert!(factors.negative() >= rows);
        let longest = factors.steps.iter().flat_map(|step| &step.lines).map(|(_, line)| line.len()).max();
        assert!(longest <= Some(2 * size + 2 * joined), "{longest:?}");
    }

    #[test]
    fn zero_diagonals_take_pivots_of_two_columns() {
        // [A Gᵀ; G 0] with regular rows has one for each of them
        let swap = [(0, 1, 1.0), (1, 0, 1.0)];
        assert_eq!(Indefinite::new(2, swap).negative(), 1);
        let held = [(0, 0, 2.0), (1, 1, -3.0), (0, 2, 1.0), (2, 0, 1.0), (1, 3, 1.0), (3, 1, 1.0)];
        assert_eq!(Indefinite::new(4, held).negative(), 2);
        assert_eq!(Indefinite::new(3, []).negative(), 0);
    }
}
