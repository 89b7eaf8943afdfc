//! Lengths that stand for a whole mechanism: in their parts counts what has a length, and 1 rad counts as much as one of them.
//!
//! Both are made of lengths of bodies and of distances between places on the ground, and of nothing that is only read: where the
//! origin of the world is, what coordinates a run has and what is asked of its start change neither.

use super::sets::Sets;
use super::{Measured, Mechanism, Row, RowKind, Step, StretchOf};
use crate::geometry::Space;

impl<G: Space<S = f64>> Mechanism<G> {
    /// Characteristic length of motions, m: the farthest named point of any body from its own origin, or of two places on the ground
    /// where joints, springs and others that act between points hold bodies that such ones connect; 1 without any.
    #[must_use]
    pub fn size(&self) -> f64 {
        let lines: Vec<usize> = self.working().filter(|&i| matches!(self.gauges[i].measured, Measured::Distance { .. })).collect();
        self.length(&lines)
    }

    /// Characteristic length of starts, m: as [`Mechanism::size`], of bodies and joints alone, since forces have no part in a start.
    #[must_use]
    pub fn start_size(&self) -> f64 {
        self.length(&[])
    }

    /// What counts as a whole way of each velocity (nv): 1 rad, or a size, m.
    #[must_use]
    pub fn units(&self, size: f64) -> Vec<f64> {
        let mut units = vec![1.0; self.nv];
        for step in &self.steps {
            if let Step::Axis { turns: false, v, .. } = step {
                units[*v] = size;
            }
        }
        units
    }

    /// For each velocity (nv) a number that it shares with those of bodies that joints and rows connect, other than by the ground, and for
    /// slides the `size`, m, which counts as 1 rad.
    #[must_use]
    pub fn kinds(&self, size: f64) -> Vec<(usize, Option<f64>)> {
        let mut sets = self.connected(self.nodes.iter().map(|n| (n.parent, n.body)));
        for row in &self.rows {
            let mut bodies = self.gauges_of(row).into_iter().flat_map(|i| [self.gauges[i].a, self.gauges[i].b]).filter(|body| *body != 0);
            if let Some(first) = bodies.next() {
                bodies.for_each(|body| sets.join(first, body));
            }
        }
        let mut kinds = vec![(0, None); self.nv];
        for node in &self.nodes {
            let group = sets.of(node.body);
            for step in &self.steps[node.steps.clone()] {
                match *step {
                    Step::Axis { turns, v, .. } => kinds[v] = (group, (!turns).then_some(size)),
                    Step::Ball { v, .. } => kinds[v..v + G::SPIN].fill((group, None)),
                }
            }
        }
        kinds
    }

    /// The largest length of bodies, and of the ground between places that joints and the distances `lines` hold.
    fn length(&self, lines: &[usize]) -> f64 {
        let points = self.bodies[1..].iter().flat_map(|b| &b.points).map(|(_, p)| G::dot(*p, *p).sqrt());
        let mut held = self.footings(lines);
        held.sort_by_key(|(group, _)| *group);
        let apart = held.chunk_by(|a, b| a.0 == b.0).map(|held| farthest::<G>(&held.iter().map(|(_, p)| *p).collect::<Vec<_>>()));
        let reach = points.chain(apart).fold(0.0, f64::max);
        if reach > 0.0 { reach } else { 1.0 }
    }

    /// Places on the ground where joints and the distances `lines` hold bodies, each with a number that bodies that such ones connect
    /// have in common.
    fn footings(&self, lines: &[usize]) -> Vec<(usize, G::Vector)> {
        let distance = |&i: &usize| match self.gauges[i].measured {
            Measured::Distance { pa, pb } => Some(((self.gauges[i].a, pa), (self.gauges[i].b, pb))),
            _ => None,
        };
        let ends = || self.joints.iter().map(|j| (j.a, (j.b.0, j.b.1))).chain(lines.iter().filter_map(distance));
        let mut sets = self.connected(ends().map(|(a, b)| (a.0, b.0)));
        let feet = ends().flat_map(|(a, b)| [(a, b), (b, a)]).filter(|(foot, other)| foot.0 == 0 && other.0 != 0);
        feet.map(|(foot, other)| (sets.of(other.0), foot.1)).collect()
    }

    /// Bodies that pairs of them connect, other than by the ground.
    pub(super) fn connected(&self, pairs: impl Iterator<Item = (usize, usize)>) -> Sets {
        let mut sets = Sets::new(self.bodies.len());
        pairs.filter(|&(a, b)| a != 0 && b != 0).for_each(|(a, b)| sets.join(a, b));
        sets
    }

    /// Gauges that a row holds or moves.
    fn gauges_of(&self, row: &Row<G>) -> Vec<usize> {
        match row.kind {
            RowKind::Gauge(i) | RowKind::Driver { gauge: i, .. } => vec![i],
            RowKind::Ratio { first, second, .. } => vec![first, second],
            RowKind::Function(f) => self.functions[f].gauges.clone(),
        }
    }

    /// Gauges that rows hold or move.
    pub(super) fn constrained(&self) -> impl Iterator<Item = usize> {
        self.rows.iter().flat_map(|row| self.gauges_of(row))
    }

    /// Gauges that something works on: rows, efforts, springs and stops.
    fn working(&self) -> impl Iterator<Item = usize> {
        let pulled = self.efforts.iter().map(|e| e.along).chain(self.stretches.iter().map(|s| s.of)).flat_map(|of| match of {
            StretchOf::Gauge(i) => vec![i],
            StretchOf::Function(f) => self.functions[f].gauges.clone(),
        });
        self.constrained().chain(pulled).chain(self.stops.iter().map(|s| s.gauge))
    }
}

/// The largest distance between two of some places, m.
///
/// With R the largest distance from any place and D one between two of them, both of the farthest two are at least D − R from that place: of
/// a long row only few are compared.
fn farthest<G: Space<S = f64>>(places: &[G::Vector]) -> f64 {
    let Some(&from) = places.first() else { return 0.0 };
    let length = |p: G::Vector| G::dot(p, p).sqrt();
    let count = places.len() as f64;
    let middle = places.iter().fold(from, |sum, p| sum + (*p - from) * count.recip());
    let end = |from: G::Vector| places.iter().copied().max_by(|p, q| length(*p - from).total_cmp(&length(*q - from))).unwrap_or(from);
    let first = end(middle);
    let (reach, found) = (length(first - middle), length(end(first) - first));
    let outer: Vec<G::Vector> = places.iter().copied().filter(|p| length(*p - middle) >= (found - reach) * (1.0 - 1e-12)).collect();
    let apart = outer.iter().enumerate().flat_map(|(i, p)| outer[i + 1..].iter().map(|q| length(*q - *p)));
    apart.fold(found, f64::max)
}
