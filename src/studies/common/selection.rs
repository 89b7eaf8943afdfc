//! Of the rows of a long run those that a figure needs.

use crate::results::Rows;

/// Rows at switches that are kept in a part beside others.
const SWITCHING: usize = 16;

/// The rows of a run: all of them while they are few, else of parts of equally many rows the first and the last ones, those with the
/// smallest and the largest value of each column, those where a column begins to be undefined, and both sides of switches.
#[derive(Clone, Debug)]
pub(crate) struct Selection {
    width: usize,
    /// Most rows that are kept when a part is full.
    most: usize,
    /// Rows to a part.
    per: usize,
    /// Rows taken.
    count: usize,
    /// Of each kept row its number, its progress, its piece and its values.
    numbers: Vec<usize>,
    progress: Vec<f64>,
    pieces: Vec<usize>,
    values: Vec<f64>,
    /// First kept row of the part that is not full.
    part: usize,
}

impl Selection {
    /// No rows yet, of `width` values; `numbers` is how many numbers are to be kept at most, about.
    pub(crate) fn new(width: usize, numbers: usize) -> Self {
        let of_part = 2 * width + 2;
        Self {
            width,
            most: (numbers / (width + 2)).max(64 * of_part),
            per: 1,
            count: 0,
            numbers: Vec::new(),
            progress: Vec::new(),
            pieces: Vec::new(),
            values: Vec::new(),
            part: 0,
        }
    }

    /// Takes a row.
    pub(crate) fn push(&mut self, progress: f64, piece: usize, values: impl Iterator<Item = f64>) {
        self.numbers.push(self.count);
        self.progress.push(progress);
        self.pieces.push(piece);
        self.values.extend(values);
        self.count += 1;
        if self.per > 1 && self.count.is_multiple_of(self.per) {
            self.regroup(self.part);
            self.part = self.numbers.len();
        }
        if self.part.max(if self.per == 1 { self.numbers.len() } else { 0 }) > self.most {
            while self.numbers.len() > self.most / 2 {
                self.per *= 2;
                self.regroup(0);
            }
            // the last part may not be full yet
            let last = (self.count - 1) / self.per;
            let full = self.count.is_multiple_of(self.per);
            self.part = if full { self.numbers.len() } else { self.numbers.partition_point(|n| n / self.per < last) };
        }
    }

    /// Keeps of the rows from the kept row `from` on those that parts need.
    fn regroup(&mut self, from: usize) {
        let mut kept = from;
        let mut begin = from;
        let mut needed = Vec::new();
        while begin < self.numbers.len() {
            let part = self.numbers[begin] / self.per;
            let end = begin + self.numbers[begin..].partition_point(|n| n / self.per == part);
            self.needed(begin, end, &mut needed);
            for &row in &needed {
                self.numbers[kept] = self.numbers[row];
                self.progress[kept] = self.progress[row];
                self.pieces[kept] = self.pieces[row];
                self.values.copy_within(row * self.width..(row + 1) * self.width, kept * self.width);
                kept += 1;
            }
            begin = end;
        }
        self.numbers.truncate(kept);
        self.progress.truncate(kept);
        self.pieces.truncate(kept);
        self.values.truncate(kept * self.width);
    }

    /// The kept rows of a part that it needs, rising.
    fn needed(&self, begin: usize, end: usize, needed: &mut Vec<usize>) {
        needed.clear();
        needed.extend([begin, end - 1]);
        for column in 0..self.width {
            let at = |row: usize| self.values[row * self.width + column];
            let defined = || (begin..end).filter(|&row| at(row).is_finite());
            needed.extend(defined().min_by(|&a, &b| at(a).total_cmp(&at(b))));
            needed.extend(defined().max_by(|&a, &b| at(a).total_cmp(&at(b))));
            needed.extend((begin..end).find(|&row| !at(row).is_finite()));
        }
        let switches = (begin + 1..end).filter(|&row| self.pieces[row] != self.pieces[row - 1]);
        needed.extend(switches.take(SWITCHING).flat_map(|row| [row - 1, row]));
        needed.sort_unstable();
        needed.dedup();
    }

    /// Number of rows that were taken.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Whether some of them were left out.
    pub(crate) fn is_partial(&self) -> bool {
        self.per > 1
    }

    /// Progress and piece of each kept row.
    pub(crate) fn places(&self) -> impl ExactSizeIterator<Item = (f64, usize)> + '_ {
        self.progress.iter().copied().zip(self.pieces.iter().copied())
    }

    /// The kept rows.
    pub(crate) fn into_rows(self) -> Rows {
        Rows::of(self.width, self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a slow sine with a spike, and of a column that is undefined for a while; pieces change at 70,000.
    fn long(numbers: usize) -> (Selection, usize) {
        let mut selection = Selection::new(2, numbers);
        let mut most = 0;
        for i in 0..200_000 {
            let x = i as f64 * 1e-4;
            let spike = if i == 123_457 { 5.0 } else { x.sin() };
            let gap = if (50_000..50_010).contains(&i) { f64::NAN } else { -x };
            selection.push(x, usize::from(i >= 70_000), [spike, gap].into_iter());
            most = most.max(selection.numbers.len());
        }
        (selection, most)
    }

    #[test]
    fn few_rows_are_all_kept() {
        let (all, _) = long(10_000_000);
        assert!(!all.is_partial());
        assert_eq!((all.count(), all.places().len()), (200_000, 200_000));
        assert_eq!(all.into_rows().len(), 200_000);
    }

    #[test]
    fn of_many_rows_ends_extremes_gaps_and_switches_are_kept_in_bounded_memory() {
        let (some, most) = long(8_000);
        assert!(some.is_partial() && some.count() == 200_000);
        assert!(most <= 2_000 + some.per, "{most}");
        let places: Vec<(f64, usize)> = some.places().collect();
        assert!(places.len() > 400 && places.is_sorted_by(|a, b| a.0 < b.0), "{}", places.len());
        assert_eq!((places[0].0, places[places.len() - 1].0), (0.0, 199_999.0 * 1e-4));
        let switch = places.iter().position(|p| p.1 == 1).unwrap();
        assert_eq!([places[switch - 1].0, places[switch].0], [69_999.0 * 1e-4, 7.0]);
        let rows = some.into_rows();
        let column = |k: usize| rows.column(k).collect::<Vec<_>>();
        assert_eq!(column(0).iter().copied().fold(0.0, f64::max), 5.0);
        assert!(column(1).iter().any(|x| x.is_nan()));
        // between kept rows a straight line is near the sine, but for its spike
        let sines: Vec<(f64, f64)> = places.iter().zip(column(0)).filter(|(_, y)| *y < 2.0).map(|(p, y)| (p.0, y)).collect();
        for pair in sines.windows(2) {
            let x = 0.5 * (pair[0].0 + pair[1].0);
            assert!((x.sin() - 0.5 * (pair[0].1 + pair[1].1)).abs() < 2e-3, "{pair:?}");
        }
    }
}
