//! Which entries of the blocks of a mechanism can be other than zero.

use crate::geometry::Space;
use crate::mechanism::{Mechanism, RowKind};
use grashof_solvers::Sparsity;

/// Entries that G may have.
pub(super) fn known_by_rows<G: Space>(m: &Mechanism<G>) -> Sparsity {
    let entries = m.rows.iter().enumerate().flat_map(|(row, r)| {
        let gauges: Vec<usize> = match r.kind {
            RowKind::Gauge(gauge) | RowKind::Driver { gauge, .. } => vec![gauge],
            RowKind::Ratio { first, second, .. } => vec![first, second],
            RowKind::Function(f) => m.functions[f].gauges.clone(),
        };
        gauges.into_iter().flat_map(move |g| m.gauges[g].columns.iter().map(move |&(k, _)| (row, k))).collect::<Vec<_>>()
    });
    Sparsity::new(m.rows.len(), m.nv, entries)
}
