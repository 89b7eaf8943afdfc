//! Friction by reactions: normal forces of multipliers, f_λ and R_λ = −∂f_λ/∂λ.
//!
//! N = Σ |n| over the places where a joint has friction, with n = A λ (`Pressing`), acts on the gauge of the joint with the size
//! output · N, so that f_λ = Σ output N ∂ẋ/∂v and ∂N/∂λ = Σ nᵀA/|n|. Where n has one component, its sign is a mode: N is linear in λ
//! between its switches. Where it has more, |n| is smooth but for n = 0, where its derivative counts as 0.

use super::{Dynamics, Workspace};
use crate::geometry::Space;
use crate::mechanism::{EffortLaw, Pressed, StretchOf};
use crate::scalar::Scalar;
use grashof_solvers::Block;

/// Part of the largest force that counts as none.
const NO_FORCE: f64 = 1e-10;

impl<G: Space> Dynamics<'_, G> {
    /// Takes the signs of normal forces from the modes.
    pub(super) fn sides(&mut self, modes: &[i32]) {
        let places = self.mechanism.pressings.iter().flat_map(|p| &p.places);
        for (side, place) in self.work.sides.iter_mut().zip(places) {
            *side = if place.components.len() == 1 && modes[place.side] < 0 { -1.0 } else { 1.0 };
        }
    }

    /// The normal force N of a pressing, N, of the multipliers `lambda` (rows).
    #[must_use]
    pub fn normal(&self, pressing: usize, lambda: &[G::S]) -> G::S {
        let mut sum = G::S::default();
        for (place, side) in self.places(pressing) {
            sum += size::<G>(place, side, lambda);
        }
        sum
    }

    /// The normal force N of a pressing, N, of the multipliers `lambda` (rows), whatever the sides on which it presses.
    #[must_use]
    pub fn pressing_force(&self, pressing: usize, lambda: &[G::S]) -> G::S {
        let mut sum = G::S::default();
        for place in &self.mechanism.pressings[pressing].places {
            let n = size::<G>(place, 1.0, lambda);
            sum += if n.value() < 0.0 { -n } else { n };
        }
        sum
    }

    /// Places of a pressing with the signs of their forces.
    fn places(&self, pressing: usize) -> impl Iterator<Item = (&Pressed, f64)> {
        let m = self.mechanism;
        let first: usize = m.pressings[..pressing].iter().map(|p| p.places.len()).sum();
        m.pressings[pressing].places.iter().zip(self.work.sides[first..].iter().copied())
    }

    /// Sets the sizes of the efforts that depend on reactions; after [`Dynamics::loads`].
    pub fn apply_friction(&mut self, lambda: &[G::S]) {
        for (i, effort) in self.mechanism.efforts.iter().enumerate() {
            if let EffortLaw::Friction { output, pressing: Some(pressing) } = effort.law {
                self.work.efforts[i] = self.work.force_outputs[output] * self.normal(pressing, lambda);
            }
        }
    }

    /// −f_λ added to `r` (nv).
    pub(super) fn add_friction(&self, lambda: &[G::S], r: &mut [G::S]) {
        let Workspace { readings, columns, force_outputs, .. } = &self.work;
        self.friction_by_reactions(|gauge, output, pressing| {
            let size = force_outputs[output] * self.normal(pressing, lambda);
            self.mechanism.gauges[gauge].project(&readings[gauge], columns, |k, x| r[k] -= size * x);
        });
    }

    /// Calls with gauge, output and pressing of each friction by reactions.
    fn friction_by_reactions(&self, mut each: impl FnMut(usize, usize, usize)) {
        for effort in &self.mechanism.efforts {
            if let (EffortLaw::Friction { output, pressing: Some(pressing) }, StretchOf::Gauge(gauge)) = (effort.law, effort.along) {
                each(gauge, output, pressing);
            }
        }
    }
}

impl<G: Space<S = f64>> Dynamics<'_, G> {
    /// f_λ (nv) of the multipliers `lambda` (rows), and R_λ = −∂f_λ/∂λ (nv × rows); after [`Dynamics::loads`].
    pub fn friction(&self, lambda: &[f64], force: &mut [f64], slope: &mut Block) {
        force.fill(0.0);
        self.add_friction(lambda, force);
        force.iter_mut().for_each(|f| *f = -*f);
        self.friction_slope(lambda, slope);
    }

    /// R_λ = −∂f_λ/∂λ (nv × rows); after [`Dynamics::loads`].
    pub fn friction_slope(&self, lambda: &[f64], slope: &mut Block) {
        slope.values_mut().fill(0.0);
        let Workspace { readings, columns, force_outputs, .. } = &self.work;
        self.friction_by_reactions(|gauge, output, pressing| {
            for (place, side) in self.places(pressing) {
                let whole = size::<G>(place, side, lambda);
                for component in &place.components {
                    let unit = match place.components.len() {
                        1 => side,
                        _ if whole == 0.0 => 0.0,
                        _ => sum::<G>(component, lambda) / whole,
                    };
                    self.mechanism.gauges[gauge].project(&readings[gauge], columns, |k, x| {
                        component.iter().for_each(|&(row, c)| slope.set(k, row, slope.at(k, row) - force_outputs[output] * x * unit * c));
                    });
                }
            }
        });
    }

    /// Force at a place that presses to one side, in the sense in which its mode says that it does, N; and the mode. Not negative where
    /// the mode is right.
    pub fn pressed(&self, lambda: &[f64]) -> impl Iterator<Item = (f64, usize)> {
        let places = self.mechanism.pressings.iter().flat_map(|p| &p.places).zip(&self.work.sides);
        places.filter(|(p, _)| p.components.len() == 1).map(|(p, side)| (size::<G>(p, *side, lambda), p.side))
    }
}

/// Normal force that counts as none, N: below it the side on which a joint presses does not matter, and rounding would change it.
/// It is a part of the largest force, those of inertia by the metric D of the mass matrix.
#[must_use]
pub fn slack(metric: &[f64], a: &[f64], lambda: &[f64]) -> f64 {
    let inertial = a.iter().zip(metric).map(|(a, d)| a.abs() * d);
    NO_FORCE * inertial.chain(lambda.iter().map(|l| l.abs())).fold(0.0, f64::max)
}

/// |n| of a place; with one component its mode says which sign it has.
fn size<G: Space>(place: &Pressed, side: f64, lambda: &[G::S]) -> G::S {
    if let [component] = &place.components[..] {
        return sum::<G>(component, lambda).scale(side);
    }
    let mut square = G::S::default();
    for component in &place.components {
        let n = sum::<G>(component, lambda);
        square += n * n;
    }
    // without a force there is no direction
    if square.value() == 0.0 { G::S::default() } else { square.sqrt() }
}

/// Σ c λ.
fn sum<G: Space>(component: &[(usize, f64)], lambda: &[G::S]) -> G::S {
    let mut sum = G::S::default();
    for &(row, c) in component {
        sum += lambda[row].scale(c);
    }
    sum
}
