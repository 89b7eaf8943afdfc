//! The pattern of a column of a sparse factor before its numbers are known.

use super::columns::Columns;

/// Step of a row that is no pivot yet.
pub(crate) const FREE: u32 = u32::MAX;

/// The rows of x in L x = a: those that can be reached from the rows of a through columns of L.
///
/// Gilbert & Peierls, SIAM J. Sci. Stat. Comput. 9 (1988) 862-874.
#[derive(Clone, Debug)]
pub(crate) struct Reach {
    /// Search in which each row was last found (n).
    mark: Vec<u32>,
    /// Steps, rising, of the rows that are pivots, and the rows that are none.
    pub(crate) above: Vec<u32>,
    pub(crate) below: Vec<u32>,
    stack: Vec<u32>,
}

impl Reach {
    /// For `rows` rows.
    pub(crate) fn new(rows: usize) -> Self {
        Self { mark: vec![FREE; rows], above: Vec::with_capacity(rows), below: Vec::with_capacity(rows), stack: Vec::with_capacity(rows) }
    }

    /// Forgets all searches.
    pub(crate) fn clear(&mut self) {
        self.mark.fill(FREE);
    }

    /// Whether the search `number` found a row.
    pub(crate) fn holds(&self, number: u32, row: u32) -> bool {
        self.mark[row as usize] == number
    }

    /// The search `number`, a new one, from `rows`; `step` are the steps at which rows became pivots, `lower` the rows of L.
    pub(crate) fn find(&mut self, number: u32, rows: &[usize], step: &[u32], lower: &Columns<u32>) {
        self.above.clear();
        self.below.clear();
        self.stack.clear();
        for &row in rows {
            if std::mem::replace(&mut self.mark[row], number) != number {
                self.stack.push(row as u32);
            }
        }
        while let Some(row) = self.stack.pop() {
            let at = step[row as usize];
            if at == FREE {
                self.below.push(row);
                continue;
            }
            self.above.push(at);
            for &i in &lower.items[lower.range(at as usize)] {
                if std::mem::replace(&mut self.mark[i as usize], number) != number {
                    self.stack.push(i);
                }
            }
        }
        // a column of L reaches later pivots only, so rising steps are an order of elimination
        self.above.sort_unstable();
    }
}
