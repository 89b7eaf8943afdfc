//! Where a driven motion passes change points, and where only comes close to another branch.
//!
//! To an integrator both look alike: rows become dependent. A step that is made to cross a change point, or is just too long, leads straight on
//! to the other branch, and nothing that is seen on it is wrong (`kinematics/branch.rs`). A mechanism whose drivers leave no freedom has a
//! path that is known beforehand, and with it which of the two there is.

use super::phases::Phases;
use crate::geometry::Space;
use crate::kinematics::driven::Driven;
use crate::kinematics::path::Path;
use crate::kinematics::standing::Standing;
use grashof_solvers::Integration;

/// Steps between two nodes that the path needs to keep to its branch.
const PARTS: u32 = 8;

/// What is known of the way of a driven motion.
#[derive(Debug, Default)]
pub(super) struct Way {
    /// Times at which steps beside another branch should end, s; rising.
    ends: Vec<f64>,
    /// Times between which there is a change point each, s; rising.
    crossings: Vec<[f64; 2]>,
    /// Whether there are no others.
    known: bool,
}

impl Way {
    /// That from the start of a phase to `until`, s; nothing where drivers leave a freedom, or rows are redundant.
    pub(super) fn of<G: Space<S = f64>>(phase: &Phases<G>, until: f64) -> Self {
        let (m, start) = (&phase.mechanism, &phase.start);
        if m.rows.len() != m.nv || m.drives.is_empty() {
            return Self::default();
        }
        let mut driven = Driven::new(m, start);
        let mut modes = start.modes.clone();
        // a start whose rows leave a motion has no path, and one that ends, as at a dead point, is told by the run itself
        let Ok(path) = Path::trace(&mut driven, &mut modes, until, Standing::of(start).as_ref()) else { return Self::default() };
        let mut way = Self { known: path.last().is_some_and(|last| last >= until), ..Self::default() };
        for two in path.nodes.windows(2).filter(|two| two[0].t >= 0.0) {
            let (from, to) = (two[0].t, two[1].t);
            if two[1].narrow {
                way.ends.extend((1..=PARTS).map(|k| if k == PARTS { to } else { from + (to - from) * f64::from(k) / f64::from(PARTS) }));
            }
            if two[1].crosses {
                way.crossings.push([from, to]);
            }
        }
        way
    }

    /// Prepares a step of an integration from time `t`, s; when it should end at the latest, if at a time of its own.
    pub(super) fn prepare(&self, run: &mut Integration, t: f64) -> Option<f64> {
        if self.known {
            let next = self.crossings.get(self.crossings.partition_point(|[_, behind]| *behind <= t));
            let until = next.map_or(f64::INFINITY, |[before, _]| *before);
            if until > t {
                run.regular_until(until);
            }
        }
        self.ends.get(self.ends.partition_point(|end| *end <= t)).copied()
    }
}
