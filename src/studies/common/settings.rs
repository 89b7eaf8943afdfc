//! How runs of a study are made.

/// Of which runs drawings are wanted, whose frames take time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Of none.
    None,
    /// Of the first one of a sweep that has results, and of a single run.
    First,
    /// Of all.
    All,
}

/// How runs are made.
#[derive(Clone, Copy)]
pub struct Settings<'a> {
    /// Threads for runs that do not depend on each other.
    pub threads: usize,
    /// Of which runs drawings are wanted.
    pub drawn: Drawn,
    /// Whether to end early.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}
