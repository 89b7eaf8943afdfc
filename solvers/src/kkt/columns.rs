//! Lists of different lengths, one after the other.

/// Lists of different lengths one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Columns<I> {
    starts: Vec<usize>,
    pub(crate) items: Vec<I>,
}

impl<I> Columns<I> {
    /// No list yet, with room for `columns` lists of `items` together.
    pub(crate) fn with_capacity(columns: usize, items: usize) -> Self {
        let mut starts = Vec::with_capacity(columns + 1);
        starts.push(0);
        Self { starts, items: Vec::with_capacity(items) }
    }

    /// Forgets the lists, not the room.
    pub(crate) fn clear(&mut self) {
        self.starts.truncate(1);
        self.items.clear();
    }

    /// What was pushed to `items` since the last call is a list.
    pub(crate) fn close(&mut self) {
        self.starts.push(self.items.len());
    }

    /// Number of lists.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    #[inline(always)]
    pub(crate) fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }
}
