//! Degrees of freedom at a position, by the rank of the rows, and what to do where drivers are more.

use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Row, RowOwner};
use grashof_solvers::Block;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};

/// Degrees of freedom at a position without drivers.
pub(crate) fn freedom<G: Space<S = f64>>(mechanism: &Mechanism<G>, q: &[f64], modes: &[i32], metric: &[f64]) -> usize {
    undriven(mechanism, &rows(mechanism, q, modes, metric), metric).mobility
}

/// Rank of all rows but those of drivers.
pub(super) fn undriven<G: Space<S = f64>>(mechanism: &Mechanism<G>, of: &(Block, Vec<f64>), metric: &[f64]) -> Rank {
    rank_of(mechanism, of, metric, |row| !matches!(row.owner, RowOwner::Driver(_)))
}

/// Rank of all rows but those that time moves: of drivers, and of couplings with time in them.
pub(super) fn unmoved<G: Space<S = f64>>(mechanism: &Mechanism<G>, of: &(Block, Vec<f64>), metric: &[f64]) -> Rank {
    rank_of(mechanism, of, metric, |row| !mechanism.is_moved(row))
}

fn rank_of<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    (g, scale): &(Block, Vec<f64>),
    metric: &[f64],
    counts: impl Fn(&Row<G>) -> bool,
) -> Rank {
    let rows: Vec<usize> = (0..mechanism.rows.len()).filter(|&i| counts(&mechanism.rows[i])).collect();
    let scale: Vec<f64> = rows.iter().map(|&i| scale[i]).collect();
    Rank::new(&g.select_rows(&rows), metric, &scale, RANK_TOLERANCE)
}

/// G at the start and the scales of its rows, by an evaluator of its own.
pub(super) fn rows<G: Space<S = f64>>(mechanism: &Mechanism<G>, q: &[f64], modes: &[i32], metric: &[f64]) -> (Block, Vec<f64>) {
    let mut dynamics = Dynamics::without_mass(mechanism);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    let scale = dynamics.row_scale(q, modes, metric);
    (dynamics.work.g.clone(), scale)
}

/// What to do where more drivers hold a mechanism than it has freedoms; `coupled` are the names of its couplings.
pub(crate) fn with_fewer_drivers(freedom: usize, coupled: &[String]) -> String {
    match coupled {
        [] if freedom == 0 => "remove a joint, or take one that leaves more motion: the joints hold all bodies where they are".into(),
        [] => "remove drivers until there are as many as degrees of freedom".into(),
        names => format!(
            "remove drivers, or the coupling{} {}, until there are as many drivers as degrees of freedom",
            if names.len() == 1 { "" } else { "s" },
            names.join(", ")
        ),
    }
}
