//! Reactions that rigid bodies leave open.
//!
//! Where rows depend on each other there are multipliers with
//!
//! ```text
//! Gᵀκ = 0,
//! ```
//!
//! which are in balance by themselves and move nothing: λ + κ is as good as λ. Components of reactions that such κ change are not
//! determined. What a solution has of them depends on the rows, and with them on the coordinates.
//!
//! κ is a random combination of all of them, so that it changes what any of them does. [D, Gᵀ; G, −E] with a right side in no special
//! direction gives λ = (S + E)⁻¹ x, in which they are 1e8 times as large as anything else.

use super::assemble::{Assembled, ChangePoint};
use super::freedom::rows;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, RowOwner};
use grashof_solvers::kkt::Kkt;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};
use grashof_solvers::{Block, Sparsity};

/// Part of the largest change of a force, or of a moment by the size, below which a component stays what it is.
const STAYS: f64 = 1e-4;

/// What redundant rows leave open.
pub(crate) struct Open {
    /// For each joint: which components of its force, and of its moment about its place.
    pub(crate) joints: Vec<[[bool; 3]; 2]>,
    /// Which couplings, in file order.
    pub(crate) couplings: Vec<bool>,
}

/// The reactions that are open at a start; none if no rows are redundant.
pub(crate) fn open_reactions<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled) -> Option<Open> {
    // in a change point rows lose rank that they have everywhere else
    let q = start.change.as_ref().and_then(ChangePoint::beside).unwrap_or(&start.q);
    let (g, scale) = rows(m, q, &start.modes, &start.metric);
    if m.rows.is_empty() || Rank::new(&g, &start.metric, &scale, RANK_TOLERANCE).dependent.is_empty() {
        return None;
    }
    let mut d = Dynamics::without_mass(m);
    d.time(0.0, &start.modes);
    d.position(q, &start.modes);
    d.velocity(&vec![0.0; m.nv], &start.modes);
    let kappa = balanced(&g, &scale, &start.metric)?;
    // with a and all loads at zero reactions are those of κ alone
    let mut reactions = d.reactions();
    d.distribute(&vec![0.0; m.nv], &kappa, &mut reactions);
    let changes: Vec<[[f64; 3]; 2]> = m
        .joints
        .iter()
        .zip(&reactions.joints)
        .map(|(joint, wrench)| {
            let (body, at) = joint.b;
            let moment = wrench.moment_about(d.place(m.group_between(joint.a.0, body), body, at));
            let force = std::array::from_fn(|i| if i < G::VECTOR { G::component(wrench.f, i) } else { 0.0 });
            let axes = if G::SPIN == 1 { 2..3 } else { 0..3 };
            [force, std::array::from_fn(|i| if axes.contains(&i) { G::spin_component(moment, i) / start.size } else { 0.0 })]
        })
        .collect();
    let rows = m.rows.iter().zip(&reactions.rows).filter(|(row, _)| row.owner == RowOwner::Coupling);
    let couplings: Vec<f64> = rows.map(|(row, effort)| if row.angular { effort / start.size } else { *effort }).collect();
    let largest = changes.iter().flatten().flatten().chain(&couplings).fold(0.0, |m, x| f64::max(m, x.abs()));
    let moved = |x: f64| x.abs() > STAYS * largest;
    Some(Open {
        joints: changes.into_iter().map(|change| change.map(|part| part.map(moved))).collect(),
        couplings: couplings.into_iter().map(moved).collect(),
    })
}

/// Multipliers (rows) that are in balance by themselves.
fn balanced(g: &Block, scale: &[f64], metric: &[f64]) -> Option<Vec<f64>> {
    let n = metric.len();
    let mut mass = Block::new(&Sparsity::new(n, n, (0..n).map(|i| (i, i))));
    metric.iter().enumerate().for_each(|(i, x)| mass.set(i, i, *x));
    let mut kkt = Kkt::of_blocks(mass.pattern(), g.pattern()).with_pivots();
    kkt.set_scale(metric, scale);
    kkt.factor(mass.values(), g.values()).ok()?;
    let x: Vec<f64> = scale.iter().enumerate().map(|(i, s)| s.sqrt() * (1.0 + 0.37 * (2.39 * i as f64).sin())).collect();
    let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; scale.len()]);
    kkt.solve(&vec![0.0; n], &x, &mut a, &mut lambda);
    Some(lambda)
}
