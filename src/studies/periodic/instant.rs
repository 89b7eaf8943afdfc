//! What a motion meets at one instant, and what becomes of its neighbours there.
//!
//! A neighbour δ meets the surface g_i = 0 later by −∇g_i·δ/ġ_i. Where these times are the same for all neighbours, the surfaces are one,
//! which is crossed by all that happens on it. Otherwise neighbours meet them in different orders, each with a product of saltation matrices
//! of its own, and the map has a derivative where all of them are the same (Ivanov, The stability of periodic solutions of discontinuous
//! systems that intersect several surfaces of discontinuity, J. Appl. Math. Mech. 62, 1998).

use super::lap::{Lap, Search, tools};
use super::rough::Rough;
use super::saltation::{GRAZING, STRUCK, Side, instant, rate};
use crate::geometry::Space;
use crate::studies::dynamics::explain::root_name;
use grashof_solvers::{Node, System};
use nalgebra::{DMatrix, DVector};

/// Part by which times of arrival may differ that are the same: that of differences.
const SAME_TIME: f64 = 1e-8;

/// Part of a neighbour, and of a velocity, by which those behind all surfaces may differ from one order to another.
const SAME: f64 = 1e-6;

/// Switches that a blow or a jump takes to their other side.
const MOST_FOLLOWED: usize = 8;

/// Neighbours behind what is met at the end of a piece of a lap.
pub(super) fn pass<G: Space<S = f64>>(
    lap: &mut Lap<'_, G>,
    search: &Search<'_>,
    piece: usize,
    psi: &DMatrix<f64>,
) -> Result<DMatrix<f64>, Rough> {
    let within = instant(lap.period(), search.tolerance);
    let nodes = sides(lap, piece, within)?;
    let mut side = Side::from(tools(&mut lap.trajectory));
    let [before, after] = &nodes[0];
    let met = side.met([before, after], within);
    // what is met a moment later may as well be met before
    let (mut all, mut behind) = (met.clone(), after);
    for [from, to] in &nodes[1..] {
        let next = side.met([from, to], within);
        if next.iter().any(|root| all.contains(root) || !side.is_near(*root, before, 2.0 * within)) {
            break;
        }
        all.extend(next);
        behind = to;
    }
    let rough = |why: Why, side: &Side<'_, '_, G>, met: &[usize]| match why {
        Why::Touched => Rough::Touched(before.state.t),
        Why::Orders => Rough::Together {
            t: before.state.t,
            met: met.iter().map(|root| root_name(&search.model, side.system, *root)).collect(),
            blows: met.iter().any(|root| side.system.strikes(*root)),
        },
    };
    if all.len() > met.len() {
        side.through(&all, [before, behind], psi, within).map_err(|why| rough(why, &side, &all))?;
    }
    side.through(&met, [before, after], psi, within).map_err(|why| rough(why, &side, &met))
}

/// The nodes before and after the end of a piece of a lap, and of those that end within a time behind it.
fn sides<G: Space<S = f64>>(lap: &mut Lap<'_, G>, piece: usize, within: f64) -> Result<Vec<[Node; 2]>, Rough> {
    let breaks = lap.trajectory.breaks();
    let inner = breaks.iter().take(breaks.len() - 1).copied().enumerate().skip(piece + 1);
    let mut nodes = Vec::new();
    for (next, at) in inner.take_while(|(_, t)| t - breaks[piece + 1] <= within) {
        let mut node = |piece: usize| {
            lap.trajectory.go(at, piece).map_err(|_| Rough::Singular(at))?;
            Ok(lap.trajectory.node.clone())
        };
        nodes.push([node(next - 1)?, node(next)?]);
    }
    Ok(nodes)
}

/// Why neighbours have no linear map.
enum Why {
    /// A surface is only touched.
    Touched,
    /// It depends on the order in which they meet the surfaces.
    Orders,
}

impl<G: Space<S = f64>> Side<'_, '_, G> {
    /// Roots that lead to other modes of forces. What is only counted or recorded leaves the motion as it is, and reactions change their
    /// side without a jump.
    fn changed(&self, [before, after]: [&Node; 2]) -> Vec<usize> {
        let differs = |mode: usize| before.state.modes[mode] != after.state.modes[mode];
        (0..self.system.roots.len()).filter(|root| self.mode(*root).is_some_and(differs)).collect()
    }

    /// Roots that were met between two nodes at one time: as the modes tell, and the stops that were struck, since a rebound leaves its mode.
    /// What a blow or the jump of another switch takes to its other side was not met by the motion itself.
    fn met(&mut self, [before, after]: [&Node; 2], within: f64) -> Vec<usize> {
        let mut met = self.changed([before, after]);
        if !self.jumps([before, after], STRUCK) {
            let taken: Vec<usize> = met.iter().copied().filter(|root| self.is_taken(*root, [before, after], within)).collect();
            met.retain(|root| !taken.contains(root));
            return met;
        }
        met.retain(|root| self.is_near(*root, before, within));
        let stops: Vec<usize> = self.system.pattern().striking.iter().map(|(root, _)| *root).collect();
        let mut struck: Vec<usize> = stops.iter().copied().filter(|root| self.is_near(*root, before, within)).collect();
        if struck.is_empty() && met.is_empty() {
            let gap = |root: usize, side: &mut Self| side.root(root, &mut before.clone()).map_or(f64::INFINITY, |g| g[0].abs());
            let gaps: Vec<f64> = stops.iter().map(|root| gap(*root, self)).collect();
            struck.extend(stops.iter().zip(&gaps).min_by(|a, b| a.1.total_cmp(b.1)).map(|(root, _)| *root));
        }
        met.extend(struck);
        met
    }

    /// Whether a nested root is negative in the modes of what was met with it, and was not about to become so by itself.
    fn is_taken(&mut self, root: usize, [before, after]: [&Node; 2], within: f64) -> bool {
        if !self.system.pattern().nested.contains(&root) || self.is_near(root, before, within) {
            return false;
        }
        let mut others = before.clone();
        for mode in self.changed([before, after]).into_iter().filter(|other| *other != root).filter_map(|other| self.mode(other)) {
            others.state.modes[mode] = after.state.modes[mode];
        }
        let value = |node: &mut Node, side: &mut Self| side.root(root, node).map_or(f64::NAN, |g| g[0]);
        let (own, taken) = (value(&mut before.clone(), self), value(&mut others, self));
        // that of equal operands is zero as long as they are equal
        own >= 0.0 && taken <= 0.0 && taken < own
    }

    /// Neighbours behind roots that were met together.
    fn through(&mut self, met: &[usize], [before, after]: [&Node; 2], psi: &DMatrix<f64>, within: f64) -> Result<DMatrix<f64>, Why> {
        let surfaces = self.surfaces(met, [before, after], psi, within)?;
        match surfaces.len() {
            0 => return Ok(psi.clone()),
            1 => return self.cross(&surfaces[0], [before, after], psi).ok_or(Why::Touched),
            _ => {}
        }
        let mut first: Option<DMatrix<f64>> = None;
        // each comes before each other one
        for turn in 0..surfaces.len() {
            let mut order = surfaces.clone();
            order.rotate_left(turn);
            for _ in 0..2 {
                let behind = self.one_by_one(&order, [before, after], psi)?;
                match &first {
                    Some(first) if !self.same(after, first, &behind) => return Err(Why::Orders),
                    Some(_) => {}
                    None => first = Some(behind),
                }
                order.reverse();
            }
        }
        first.ok_or(Why::Touched)
    }

    /// Roots by the surfaces on which they are: those that all neighbours meet at the same time are on one.
    fn surfaces(&mut self, met: &[usize], [before, after]: [&Node; 2], psi: &DMatrix<f64>, within: f64) -> Result<Vec<Vec<usize>>, Why> {
        if met.len() < 2 {
            return Ok(met.iter().map(|root| vec![*root]).collect());
        }
        let sizes: Vec<f64> = psi.column_iter().map(|x| self.size(before, x.clone_owned().as_slice())).collect();
        let mut surfaces: Vec<(DVector<f64>, Vec<usize>)> = Vec::new();
        for &root in met {
            let (along, pace) = self.approach(root, before, psi).ok_or(Why::Touched)?;
            if pace.abs() <= GRAZING * along.amax() || !pace.is_finite() {
                // harmless if it is a kink
                let behind = self.behind(&[root], met, before, after).ok_or(Why::Touched)?;
                self.cross(&[root], [before, &behind], psi).ok_or(Why::Touched)?;
                continue;
            }
            let late = along / pace;
            let same = |other: &DVector<f64>| {
                let mut all = late.iter().zip(other).zip(&sizes);
                all.all(|((x, y), size)| (x - y).abs() <= SAME_TIME * x.abs().max(y.abs()) || (x - y).abs() <= within * size)
            };
            match surfaces.iter_mut().find(|(other, _)| same(other)) {
                Some((_, roots)) => roots.push(root),
                None => surfaces.push((late, vec![root])),
            }
        }
        Ok(surfaces.into_iter().map(|(_, roots)| roots).collect())
    }

    /// Neighbours behind surfaces that are met in an order; the motion behind them must be the one `after` them.
    fn one_by_one(&mut self, surfaces: &[Vec<usize>], [before, after]: [&Node; 2], psi: &DMatrix<f64>) -> Result<DMatrix<f64>, Why> {
        let (mut node, mut psi) = (before.clone(), psi.clone());
        let met = surfaces.concat();
        for (i, roots) in surfaces.iter().enumerate() {
            let meets = |root: &usize, side: &mut Self| side.pace_of_root(*root, &node).is_some_and(|pace| pace < 0.0);
            if !roots.iter().all(|root| meets(root, self)) {
                return Err(Why::Orders);
            }
            let mut behind = self.behind(roots, &met, &node, after).ok_or(Why::Orders)?;
            if i + 1 == surfaces.len() {
                let (found, right) = (rate(&behind), rate(after));
                let size = right.amax().max(found.amax());
                if self.jumps([after, &behind], SAME) || (found - right).amax() > SAME * size {
                    return Err(Why::Orders);
                }
                behind = after.clone();
            }
            psi = self.cross(roots, [&node, &behind], &psi).ok_or(Why::Touched)?;
            node = behind;
        }
        Ok(psi)
    }

    /// The node behind some of the roots that are `met` between a node and what is `after` all.
    fn behind(&mut self, roots: &[usize], met: &[usize], node: &Node, after: &Node) -> Option<Node> {
        let mut behind = node.clone();
        self.crossed(roots, &mut behind.state)?;
        let take = |mode: Option<usize>, behind: &mut Node| mode.map(|mode| behind.state.modes[mode] = after.state.modes[mode]);
        roots.iter().for_each(|root| {
            take(self.mode(*root), &mut behind);
        });
        // a blow, or a jump, takes other switches to their other side, or onto it
        for _ in 0..MOST_FOLLOWED {
            let others = self.changed([&behind, after]);
            let nested = self.system.pattern().nested.clone();
            let is_beyond =
                |root: &usize| self.root(*root, &mut behind.clone()).is_some_and(|g| g[0] < 0.0 || g[0] == 0.0 && nested.contains(root));
            let Some(root) = others.into_iter().filter(|root| !met.contains(root)).find(is_beyond) else { break };
            take(self.mode(root), &mut behind);
        }
        // reactions press on the sides that are theirs
        let mut pressed = behind.state.clone();
        self.engine.follow_modes(self.system, &mut pressed);
        self.system.dynamics.mechanism.sides().for_each(|mode| behind.state.modes[mode] = pressed.modes[mode]);
        self.engine.accelerate(self.system, &mut behind).ok()?;
        Some(behind)
    }

    /// Whether neighbours behind all are the same, in sizes of the coordinates.
    fn same(&self, node: &Node, one: &DMatrix<f64>, other: &DMatrix<f64>) -> bool {
        one.column_iter().zip(other.column_iter()).all(|(x, y)| {
            let (x, y) = (x.clone_owned(), y.clone_owned());
            self.size(node, (&x - &y).as_slice()) <= SAME * self.size(node, x.as_slice()).max(self.size(node, y.as_slice()))
        })
    }
}
