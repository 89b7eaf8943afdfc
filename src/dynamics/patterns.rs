//! Which entries of the blocks of a mechanism can be other than zero.

use crate::geometry::Space;
use crate::mechanism::{EffortLaw, Leaf, Mechanism, RowKind, StagedProgram, StretchOf};
use grashof_solvers::Sparsity;

/// Entries that M may have: columns i and k meet if one is behind the other on the tree, or if a rotor turns with both.
#[must_use]
pub fn mass_pattern<G: Space>(m: &Mechanism<G>) -> Sparsity {
    let known: usize = depths(m).iter().map(|depth| 2 * depth + 1).sum();
    if Sparsity::is_nearly_full(m.nv, m.nv, known) {
        return Sparsity::dense(m.nv, m.nv);
    }
    let paths = (0..m.nv).flat_map(|k| m.road(Some(k)).flat_map(move |j| [(j, k), (k, j)]));
    let rotors = m.rotors.iter().map(|rotor| &m.gauges[rotor.gauge].columns);
    let rotors = rotors.flat_map(|columns| columns.iter().flat_map(move |(j, _)| columns.iter().map(move |(k, _)| (*j, *k))));
    Sparsity::new(m.nv, m.nv, paths.chain(rotors)).or_dense()
}

/// For each velocity column the number of others on its road to the ground.
#[must_use]
pub fn depths<G: Space>(m: &Mechanism<G>) -> Vec<usize> {
    let mut depths = Vec::with_capacity(m.nv);
    for above in &m.above {
        depths.push(above.map_or(0, |above| depths[above] + 1));
    }
    depths
}

/// Entries that G may have.
#[must_use]
pub fn row_pattern<G: Space>(m: &Mechanism<G>) -> Sparsity {
    let entries = m.rows.iter().enumerate().flat_map(|(row, r)| {
        let gauges: Vec<usize> = match r.kind {
            RowKind::Gauge(gauge) | RowKind::Driver { gauge, .. } => vec![gauge],
            RowKind::Ratio { first, second, .. } => vec![first, second],
            RowKind::Function(f) => m.functions[f].gauges.clone(),
        };
        gauges.into_iter().flat_map(move |g| m.gauges[g].columns.iter().map(move |&(k, _)| (row, k))).collect::<Vec<_>>()
    });
    Sparsity::new(m.rows.len(), m.nv, entries).or_dense()
}

/// Entries that K and C may have.
#[must_use]
pub fn tangent_pattern<G: Space>(m: &Mechanism<G>) -> Sparsity {
    known_together(m).or_dense()
}

/// Entries that R_λ may have: what a joint with friction moves, by the rows that press on it.
#[must_use]
pub fn friction_pattern<G: Space>(m: &Mechanism<G>) -> Sparsity {
    let mut entries = Vec::new();
    for effort in &m.efforts {
        let (EffortLaw::Friction { pressing: Some(pressing), .. }, StretchOf::Gauge(gauge)) = (effort.law, effort.along) else { continue };
        let rows = m.pressings[pressing].places.iter().flat_map(|p| p.components.iter().flatten());
        entries.extend(rows.flat_map(|&(row, _)| m.gauges[gauge].columns.iter().map(move |&(k, _)| (k, row))));
    }
    Sparsity::new(m.nv, m.rows.len(), entries)
}

/// Columns i and k that one body's path, one gauge or one force law knows both.
pub(super) fn known_together<G: Space>(m: &Mechanism<G>) -> Sparsity {
    let mut groups: Vec<Vec<usize>> = (0..m.bodies.len()).map(|body| m.path(body)).collect();
    groups.extend((0..m.active_gauges).map(|g| of_gauge(m, g)));
    for f in &m.functions {
        groups.push(f.gauges.iter().flat_map(|&g| of_gauge(m, g)).collect());
    }
    // a force given by a program may depend on every input of it and acts on its bodies
    let law = known_by(m, &m.force_program);
    if m.force_program.outputs > 0 {
        for pull in &m.point_loads {
            groups.push([law.clone(), m.path(pull.body), m.path(pull.frame)].concat());
        }
        for effort in &m.efforts {
            groups.push([law.clone(), of_stretch(m, effort.along)].concat());
        }
    }
    Sparsity::of_groups(m.nv, groups.iter().map(Vec::as_slice))
}

/// Columns that a gauge knows.
fn of_gauge<G: Space>(m: &Mechanism<G>, gauge: usize) -> Vec<usize> {
    let g = &m.gauges[gauge];
    [m.path(g.a), m.path(g.b)].concat()
}

/// Columns that a stretch knows.
fn of_stretch<G: Space>(m: &Mechanism<G>, of: StretchOf) -> Vec<usize> {
    match of {
        StretchOf::Gauge(g) => of_gauge(m, g),
        StretchOf::Function(f) => m.functions[f].gauges.iter().flat_map(|&g| of_gauge(m, g)).collect(),
    }
}

/// Columns that a program knows by its inputs.
pub(super) fn known_by<G: Space>(m: &Mechanism<G>, program: &StagedProgram) -> Vec<usize> {
    let mut columns = Vec::new();
    for &(_, leaf) in &program.fills {
        match leaf {
            Leaf::Time | Leaf::State(_) => {}
            Leaf::Gauge { gauge, .. } => columns.extend(of_gauge(m, gauge)),
            Leaf::Stretch { spring, .. } => columns.extend(of_stretch(m, m.stretches[spring].of)),
            Leaf::Spin { body, .. } => columns.extend(m.path(body)),
        }
    }
    columns
}
