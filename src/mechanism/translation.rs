//! Common translations: directions in which all bodies of a group may be shifted together without anything that acts being changed.
//!
//! What moves with a constant velocity moves as what stands still does: a cart on a long rail, a body that is thrown, a chain in
//! free fall. A group has such directions if each of its joints on the ground slides along them, and nothing measured between the
//! group and the ground sees them but what a driver moves: a driver that moves by f(t) + u t is one in a frame that moves.

use super::grouping::slides;
use super::{EffortLaw, Gauge, Leaf, Measured, Mechanism, RowKind, StretchOf};
use crate::geometry::Space;

/// Parts of a unit direction below which it counts as a combination of others.
const DEPENDENT: f64 = 1e-9;

impl<G: Space<S = f64>> Mechanism<G> {
    /// For each group with such directions, the velocity columns that move along them, with their components along up to three
    /// orthogonal directions, of unit length each over all columns.
    #[must_use]
    pub fn translations(&self) -> Vec<Vec<(usize, [f64; 3])>> {
        self.translations_past(&self.acting(), &self.group_of)
    }

    /// What is left of a displacement (nv) without a common one of each group, as if nothing but its joints on the ground held it.
    #[must_use]
    pub fn without_shift(&self, delta: &[f64]) -> Vec<f64> {
        let mut left = delta.to_vec();
        let branches = self.nodes.iter().map(|n| (n.parent, n.body));
        let rows = self.constrained().map(|i| (self.gauges[i].a, self.gauges[i].b));
        let mut sets = self.connected(branches.chain(rows));
        // what only springs connect is no group here, since they have no part in a start
        let group_of: Vec<usize> = (0..self.bodies.len()).map(|body| sets.of(body)).collect();
        for common in self.translations_past(&[], &group_of) {
            for axis in 0..3 {
                let sum: f64 = common.iter().map(|(k, along)| along[axis] * delta[*k]).sum();
                common.iter().for_each(|(k, along)| left[*k] -= along[axis] * sum);
            }
        }
        left
    }

    /// By groups with a number for each body.
    fn translations_past(&self, acting: &[usize], group_of: &[usize]) -> Vec<Vec<(usize, [f64; 3])>> {
        let of_group = |group: usize| {
            let roots = self.roots(group, group_of);
            let free = self.free_directions(&roots, |gauge| group_of[gauge.a.max(gauge.b)] == group, acting)?;
            let length = (roots.len() as f64).sqrt();
            let columns = roots.iter().flatten();
            Some(columns.map(|(v, along)| (*v, std::array::from_fn(|i| free.get(i).map_or(0.0, |u| dot(*u, *along) / length)))).collect())
        };
        let mut groups: Vec<usize> = self.nodes.iter().filter(|n| n.parent == 0).map(|n| group_of[n.body]).collect();
        groups.sort_unstable();
        groups.dedup();
        groups.into_iter().filter_map(of_group).collect()
    }

    /// For each joint of a group on the ground: the columns of its plain slides with their directions in the world.
    fn roots(&self, group: usize, group_of: &[usize]) -> Vec<Vec<(usize, [f64; 3])>> {
        let roots = self.nodes.iter().filter(|n| n.parent == 0 && group_of[n.body] == group);
        let plain = roots.map(|n| slides(&self.steps[n.steps.clone()], n.before.r).into_iter().filter(|s| !s.turns));
        plain.map(|slides| slides.map(|s| (s.v, components::<G>(s.along))).collect()).collect()
    }

    /// Orthogonal unit directions in which nothing holds a group with its joints on the ground; none if there are none.
    fn free_directions(
        &self,
        roots: &[Vec<(usize, [f64; 3])>],
        of_group: impl Fn(&Gauge<G>) -> bool,
        acting: &[usize],
    ) -> Option<Vec<[f64; 3]>> {
        let mut held: Vec<[f64; 3]> =
            roots.iter().flat_map(|slides| complement::<G>(&slides.iter().map(|(_, d)| *d).collect::<Vec<_>>())).collect();
        for &i in acting {
            let gauge = &self.gauges[i];
            if gauge.a != 0 && gauge.b != 0 || !of_group(gauge) {
                continue;
            }
            match gauge.measured {
                Measured::Coordinate { along, .. } => held.extend(roots.iter().flatten().filter(|(v, _)| *v == along.v).map(|(_, d)| *d)),
                Measured::Slide { n, .. } if gauge.a == 0 => held.push(components::<G>(n)),
                Measured::Slide { .. } | Measured::Distance { .. } => return None,
                Measured::Dot { .. } | Measured::Angle | Measured::Turn { .. } | Measured::Quaternion { .. } => {}
            }
        }
        let free = complement::<G>(&held);
        if roots.is_empty() || free.is_empty() { None } else { Some(free) }
    }

    /// Gauges that something reads or works on, but for those that drivers alone move.
    fn acting(&self) -> Vec<usize> {
        let mut gauges = Vec::new();
        let mut functions = Vec::new();
        for row in &self.rows {
            match row.kind {
                RowKind::Gauge(i) => gauges.push(i),
                RowKind::Ratio { first, second, .. } => gauges.extend([first, second]),
                RowKind::Function(f) => functions.push(f),
                RowKind::Driver { .. } => {}
            }
        }
        // a load works along its gauge without reading it
        let reads = |law: EffortLaw<G>| matches!(law, EffortLaw::Linear { .. } | EffortLaw::Law { .. });
        let efforts = self.efforts.iter().filter(|e| reads(e.law)).map(|e| e.along);
        let stretched = efforts.chain(self.stretches.iter().map(|s| s.of));
        for of in stretched {
            match of {
                StretchOf::Gauge(i) => gauges.push(i),
                StretchOf::Function(f) => functions.push(f),
            }
        }
        gauges.extend(functions.iter().flat_map(|f| &self.functions[*f].gauges));
        gauges.extend(self.rotors.iter().map(|r| r.gauge));
        gauges.extend(self.stops.iter().map(|s| s.gauge));
        let programs = self.programs();
        let fills = programs.iter().flat_map(|p| &p.fills);
        gauges.extend(fills.filter_map(|(_, leaf)| if let Leaf::Gauge { gauge, .. } = leaf { Some(*gauge) } else { None }));
        gauges
    }
}

/// Orthogonal unit directions of the space at right angles to all of some directions.
fn complement<G: Space>(directions: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut basis: Vec<[f64; 3]> = Vec::new();
    let axes: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|k| if i == k { 1.0 } else { 0.0 }));
    let mut free = Vec::new();
    for (i, d) in directions.iter().chain(&axes[..G::VECTOR]).enumerate() {
        let mut rest = *d;
        // twice is enough
        for b in basis.iter().chain(&basis) {
            let along = dot(rest, *b);
            rest.iter_mut().zip(b).for_each(|(x, b)| *x -= along * b);
        }
        let length = dot(rest, rest).sqrt();
        if length > DEPENDENT {
            let unit = rest.map(|x| x / length);
            basis.push(unit);
            if i >= directions.len() {
                free.push(unit);
            }
        }
    }
    free
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn components<G: Space<S = f64>>(v: G::Vector) -> [f64; 3] {
    std::array::from_fn(|i| if i < G::VECTOR { G::component(v, i) } else { 0.0 })
}
