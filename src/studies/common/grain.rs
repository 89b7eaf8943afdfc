//! Below what a column of a motion is zero but for round-off: by its dimension, and by the energies, lengths and rates of the motion.
//!
//! Forces that balance each other, the place of a centre of mass that stands still: what is computed of them is the round-off of what
//! they are the sum of, which no polynomial follows and which has no extremes to speak of.

use crate::dynamics::Dynamics;
use crate::expression::{Dimension, Id};
use crate::geometry::Space;
use crate::model::{Model, Study};

/// Part of the size of a motion's quantities that round-off reaches.
pub(crate) const ROUND_OFF: f64 = 5e-14;

/// Where a motion is looked at, as parts of its range.
pub(crate) const PLACES: [f64; 8] = [0.06, 0.19, 0.31, 0.44, 0.57, 0.69, 0.82, 0.94];

/// The place, from the least, whose size is that of the motion: the largest may be those of a singular position.
const TYPICAL: f64 = 0.75;

/// Sizes of a motion at places of it.
#[derive(Clone, Debug)]
pub(crate) struct Grain {
    /// Size of the mechanism, m.
    length: f64,
    /// Kinetic energy and the work of forces on ways of 1 rad or the size, J.
    energies: Vec<f64>,
    /// Fastest turn, or speed by the size, rad/s.
    rates: Vec<f64>,
}

impl Grain {
    /// That of a mechanism of a size, m, before anything is known of its motion.
    pub(crate) fn of(length: f64) -> Self {
        Self { length, energies: Vec::new(), rates: Vec::new() }
    }

    /// Takes the state whose positions and velocities `v` (nv) were evaluated last, with the modes of its forces.
    pub(crate) fn take<G: Space<S = f64>>(&mut self, dynamics: &mut Dynamics<'_, G>, v: &[f64], modes: &[i32]) {
        dynamics.forces(modes);
        let units = dynamics.mechanism.units(self.length);
        let work = dynamics.work.force.iter().zip(&units).map(|(f, unit)| (f * unit).abs()).sum::<f64>();
        self.energies.push(dynamics.kinetic_energy() + work);
        self.rates.push(v.iter().zip(&units).fold(0.0, |most, (v, unit)| f64::max(most, v.abs() / unit)));
    }

    /// Below what each of the watched expressions `ids` is zero, in its unit: 0 where its dimension is not known. At rest the rate
    /// counts that turns 1 rad in the whole `time`, s.
    pub(crate) fn floors(self, model: &Model, study: &Study, ids: &[Id], time: f64) -> Vec<f64> {
        let Self { length, energies, rates } = self;
        let (energy, rate) = (typical(energies), f64::max(typical(rates), time.abs().recip()));
        let units = |current: f64| [length, energy / (rate * length).powi(2), rate.recip(), current];
        let floor = |id: &Id| {
            let columns = study.columns.iter().map(|c| (c.value, c.dimension));
            let mut known = columns.chain(model.measures.iter().map(|m| (m.value, m.dimension)));
            let dimension: Dimension = known.find(|(value, _)| value == id)?.1;
            let [size, doubled] = [1.0, 2.0].map(|current| dimension.size(units(current)));
            // no size of a current is known
            (size == doubled && size.is_finite()).then_some(ROUND_OFF * size)
        };
        ids.iter().map(|id| floor(id).unwrap_or(0.0)).collect()
    }
}

/// A size that is not one of a few places.
fn typical(mut sizes: Vec<f64>) -> f64 {
    sizes.retain(|size| size.is_finite());
    sizes.sort_by(f64::total_cmp);
    sizes.get((TYPICAL * sizes.len() as f64) as usize).copied().unwrap_or(0.0)
}
