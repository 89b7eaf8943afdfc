//! Starts from which drivers cannot move: dead points, in words, with the nearest positions from which they can.

use super::close::{Held, System};
use super::explain::short;
use super::fault::AssemblyFault;
use crate::geometry::Space;
use crate::mechanism::{Asked, Mechanism, RowKind};
use crate::numerics::least_squares::left_open;
use nalgebra::DMatrix;

/// How far beside a dead point a start is proposed, rad or sizes.
const BESIDE: f64 = 0.05;

/// What stays in its place moves less than this on such a way, rad or sizes: beside a dead point it moves with the square.
const STAYS: f64 = 1e-9;
const GOLDEN: f64 = 2.4;

impl<G: Space<S = f64>> System<'_, G> {
    /// A start whose rows have their common rank but leave drivers no way.
    pub(super) fn dead_point(&mut self, q: &[f64], missed: &str) -> AssemblyFault {
        let m = self.dynamics.mechanism;
        let driven: Vec<(usize, f64)> = m
            .rows
            .iter()
            .zip(&self.dynamics.work.nu)
            .filter_map(|(row, nu)| if let RowKind::Driver { gauge, .. } = row.kind { Some((gauge, *nu)) } else { None })
            .collect();
        let (a, round_off) = self.scaled(&self.undriven());
        let open = left_open(round_off, &a.to_dense(m.nv), &self.metric);
        if let Some(driver) = self.stuck(q, &open) {
            return AssemblyFault {
                code: "over-constrained",
                message: format!(
                    "{driver} cannot move: the other constraints leave its joint no motion, at the start or beside it: {missed}"
                ),
                place: "drivers".into(),
                help: "drive a joint that can move, or remove constraints of the loop that holds this one".into(),
            };
        }
        if let Some(drivers) = self.of_one_motion(q, &open) {
            return AssemblyFault {
                code: "over-constrained",
                message: format!("{drivers} move the same motion and contradict each other: {missed} at the start"),
                place: "drivers".into(),
                help: "remove one of them, or let them agree at all times".into(),
            };
        }
        let mut sides = Vec::new();
        if open.ncols() == 1 {
            for way in self.both_ways(open.as_slice()) {
                sides.extend(self.beside(q, &way));
            }
        }
        self.place(q);
        let end = match (&driven[..], &sides[..]) {
            ([(gauge, _)], [one, other]) => {
                let here = self.dynamics.work.readings[*gauge].x;
                let moved = [one, other].map(|side| side.driven - here);
                (moved[0] * moved[1] > 0.0).then(|| {
                    let extreme = if moved[0] > 0.0 { "least" } else { "largest" };
                    format!(": there {} has its {extreme} value, {}", name(m, *gauge), value(m, *gauge, here))
                })
            }
            _ => None,
        };
        let mover = if self.dynamics.mechanism.drives.is_empty() { "coupling" } else { "driver" };
        let starts: Vec<&str> = sides.iter().map(|side| side.start.as_str()).filter(|start| !start.is_empty()).collect();
        AssemblyFault {
            code: "dead-point",
            message: format!(
                "the start is a dead point, where the links are in a line and no finite velocity moves the {mover} on: {missed}{}",
                end.unwrap_or_default()
            ),
            place: "start".into(),
            help: match starts[..] {
                [] => "start beside it, by another exact value, or drive another joint".into(),
                [one] => format!("start beside it, as with {one}, or drive another joint"),
                [one, other, ..] => format!("start beside it, as with {one} or with {other}, or drive another joint"),
            },
        }
    }

    /// A little way along a motion (nv), and back.
    fn both_ways(&self, motion: &[f64]) -> [Vec<f64>; 2] {
        let largest = motion.iter().zip(&self.metric).map(|(u, d)| u.abs() * d.sqrt()).fold(f64::MIN_POSITIVE, f64::max);
        [BESIDE, -BESIDE].map(|far| motion.iter().map(|u| u * (far / largest)).collect())
    }

    /// A driver that is to move what stays where it is along all motions that its rows leave `open` (nv each).
    fn stuck(&mut self, q: &[f64], open: &DMatrix<f64>) -> Option<String> {
        let m = self.dynamics.mechanism;
        let driven: Vec<(usize, usize)> = (0..m.rows.len())
            .filter(|&row| self.dynamics.work.nu[row] != 0.0)
            .filter_map(|row| if let RowKind::Driver { gauge, .. } = m.rows[row].kind { Some((row, gauge)) } else { None })
            .collect();
        self.place(q);
        let here: Vec<f64> = driven.iter().map(|&(_, gauge)| self.dynamics.work.readings[gauge].x).collect();
        let mut moved = vec![false; driven.len()];
        // along each of them, and all at once
        let ways = open.column_iter().map(|u| u.iter().copied().collect::<Vec<f64>>());
        for way in ways.chain([all_at_once(open)]) {
            for way in self.both_ways(&way) {
                self.close_along(q, &way)?;
                for ((moved, here), &(_, gauge)) in moved.iter_mut().zip(&here).zip(&driven) {
                    *moved |= (self.dynamics.work.readings[gauge].x - here).abs() * self.gauge_scale(gauge) > STAYS;
                }
            }
        }
        let stuck = driven.iter().zip(moved).find(|(_, moved)| !moved);
        stuck.map(|((row, _), _)| format!("the {}", m.name_of_row(*row)))
    }

    /// Drivers that have no motions of their own among those that their rows leave `open` (nv each), neither at a position nor beside it.
    fn of_one_motion(&mut self, q: &[f64], open: &DMatrix<f64>) -> Option<String> {
        let m = self.dynamics.mechanism;
        let drivers: Vec<usize> = (0..m.rows.len()).filter(|&row| matches!(m.rows[row].kind, RowKind::Driver { .. })).collect();
        // the part of each driver in what they cannot do together
        let shared = |system: &Self, open: &DMatrix<f64>| {
            let (rows, _) = system.scaled(&drivers);
            let along = DMatrix::from_row_slice(drivers.len(), m.nv, &rows.to_dense(m.nv)) * open;
            let own = (&along * along.transpose()).symmetric_eigen();
            let (least, size) = own.eigenvalues.argmin();
            (size <= STAYS * own.eigenvalues.amax()).then(|| own.eigenvectors.column(least).into_owned())
        };
        if drivers.len() < 2 || open.ncols() == 0 {
            return None;
        }
        self.place(q);
        let parts = shared(self, open)?;
        let [way, _] = self.both_ways(&all_at_once(open));
        self.close_along(q, &way)?;
        let (a, round_off) = self.scaled(&self.undriven());
        let beside = left_open(round_off, &a.to_dense(m.nv), &self.metric);
        shared(self, &beside)?;
        let named = drivers.iter().zip(&parts).filter(|(_, part)| part.abs() > 1e-6);
        Some(named.map(|(row, _)| m.name_of_row(*row)).collect::<Vec<_>>().join(" and "))
    }

    /// A change point on none of whose branches drivers and exact rates can be met.
    pub(super) fn blocked(&self, branches: &str) -> AssemblyFault {
        AssemblyFault {
            code: "dead-point",
            message: format!(
                "the start is a change point from which drivers and exact rates lead along none of its branches: {branches} (in parts of the largest)"
            ),
            place: "start".into(),
            help: "start beside it, by another exact value, or drive a joint that moves on the branch".into(),
        }
    }

    /// Closes a position a little way along a motion that drivers are not asked about.
    fn close_along(&mut self, q: &[f64], way: &[f64]) -> Option<()> {
        let undriven = self.undriven();
        let (rows, held) = (std::mem::replace(&mut self.rows, undriven), std::mem::replace(&mut self.held, Held::Nothing));
        let mut at = q.to_vec();
        self.dynamics.mechanism.retract(&mut at, way);
        let closed = self.close(&mut at);
        (self.rows, self.held) = (rows, held);
        closed.then_some(())
    }

    /// A start there, and where it leads the first driver.
    fn beside(&mut self, q: &[f64], way: &[f64]) -> Option<Beside> {
        let m = self.dynamics.mechanism;
        let closed = self.close_along(q, way).is_some();
        let readings = &self.dynamics.work.readings;
        let gauge = m.rows.iter().find_map(|row| if let RowKind::Driver { gauge, .. } = row.kind { Some(gauge) } else { None })?;
        let exact = m.starts.iter().filter(|s| !s.guess).filter_map(|s| match s.asked {
            Asked::Gauge { gauge, order: 0 } => Some(format!("`{}: {}`", s.name, value(m, gauge, readings[gauge].x))),
            _ => None,
        });
        let start = exact.collect::<Vec<_>>().join(", ");
        closed.then(|| Beside { driven: readings[gauge].x, start })
    }
}

/// One motion of all that are `open` (nv each), in no special direction.
fn all_at_once(open: &DMatrix<f64>) -> Vec<f64> {
    open.row_iter().map(|row| row.iter().enumerate().map(|(i, u)| (GOLDEN * i as f64).cos() * u).sum()).collect()
}

/// A position beside a dead point: the driven value, and exact values of `start` as they would be written.
struct Beside {
    driven: f64,
    start: String,
}

/// A driven joint's coordinate.
fn name<G: Space>(m: &Mechanism<G>, gauge: usize) -> String {
    let joint = m.joints.iter().find(|joint| joint.slots.contains(&gauge));
    joint.map_or_else(|| "the driven quantity".into(), |joint| format!("`{}`", joint.name))
}

/// A value of a gauge with its unit.
fn value<G: Space>(m: &Mechanism<G>, gauge: usize, x: f64) -> String {
    if m.gauges[gauge].turns() { format!("{} deg", short(x.to_degrees())) } else { format!("{} m", short(x)) }
}
