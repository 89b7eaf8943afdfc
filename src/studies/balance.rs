//! Balancing: how far attached masses must stand from their bodies' origins for the centre of mass to stand still.
//!
//! The centre of mass is linear in the distances d_j: M c = Σ m_i c_i + Σ m_j (o_j + d_j u_j), u_j the direction of the line in
//! the world. The distances that make Σ |c − mean c|² over the motion least solve a small linear least-squares problem.

use super::common::motion::{Lost, Motion};
use crate::geometry::Space;
use crate::numerics::continuous::Curve;
use crate::numerics::least_squares::shortest;
use crate::numerics::panel::{NODES, node};

/// A balanced mechanism.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Balanced {
    /// Signed distances from the bodies' origins, m.
    pub distances: Vec<f64>,
    /// Largest distance of the centre of mass from its mean, m.
    pub residual: f64,
}

/// Why a motion is not balanced.
pub(crate) enum Unbalanced {
    /// A mass has no line, in words.
    NoLine(String),
    /// The motion is lost on its way.
    Lost(Lost),
}

/// Balances a motion by moving masses (body, index in its `attached`) along the lines from the bodies' origins through them.
///
/// # Errors
/// If a mass has no line, or the motion is lost on its way.
pub(crate) fn balance<G: Space<S = f64>>(motion: &mut Motion<'_, G>, moved: &[(usize, usize)]) -> Result<Balanced, Unbalanced> {
    let mechanism = motion.driven.dynamics.mechanism;
    let mut lines = Vec::new();
    for &(body, index) in moved {
        let attached = &mechanism.bodies[body].attached[index];
        let length = G::dot(attached.mass.com, attached.mass.com).sqrt();
        if length == 0.0 {
            return Err(Unbalanced::NoLine(format!(
                "`{}` is attached at the origin of `{}`: no line to move along",
                attached.name, mechanism.bodies[body].name
            )));
        }
        lines.push((body, attached.mass.mass, attached.mass.com * (1.0 / length), length));
    }
    let resolved = motion.resolve().map_err(Unbalanced::Lost)?;
    let dimensions = G::VECTOR;
    // per place and direction: the centre of mass without offsets, and what each distance adds
    let (mut fixed, mut gains, mut weights) = (Vec::new(), Vec::new(), Vec::new());
    let mut nothing = vec![0.0; motion.columns()];
    for (panel, j) in resolved.panels.iter().flat_map(|p| (0..NODES).map(move |j| (p, j))) {
        motion.row(panel.place(j), panel.piece, &mut nothing).map_err(Unbalanced::Lost)?;
        weights.push(0.5 * panel.width() * node(j).1);
        let work = &motion.driven.dynamics.work;
        let (mass, mut h) = motion.driven.dynamics.first_moment();
        let directions: Vec<G::Vector> = lines.iter().map(|&(body, m, u, _)| G::rotate(work.places[body].r, u) * m).collect();
        for (d, (_, _, _, length)) in directions.iter().zip(&lines) {
            h += *d * -*length;
        }
        for axis in 0..dimensions {
            fixed.push(G::component(h, axis) / mass);
            gains.extend(directions.iter().map(|d| G::component(*d, axis) / mass));
        }
    }
    let n = lines.len();
    center(&mut fixed, &weights);
    center(&mut gains, &weights);
    // Gauss's sum of squares over the motion: each place counts by its weight in the integral
    let root = |row: usize| weights[row / dimensions].sqrt();
    let a: Vec<f64> = gains.iter().enumerate().map(|(i, g)| g * root(i / n.max(1))).collect();
    let b: Vec<f64> = fixed.iter().enumerate().map(|(row, x)| -x * root(row)).collect();
    let distances = shortest(&a, &b, &vec![1.0; n], 0.0);
    let off = |place: usize| -> f64 {
        (place * dimensions..(place + 1) * dimensions)
            .map(|i| (fixed[i] + gains[i * n..(i + 1) * n].iter().zip(&distances).map(|(g, d)| g * d).sum::<f64>()).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let residual = (0..weights.len()).map(off).fold(0.0, f64::max);
    Ok(Balanced { distances, residual })
}

/// Takes the weighted mean over the places from each column.
fn center(values: &mut [f64], weights: &[f64]) {
    let stride = values.len() / weights.len().max(1);
    let whole: f64 = weights.iter().sum();
    for column in 0..stride {
        let mean = weights.iter().enumerate().map(|(r, w)| w * values[r * stride + column]).sum::<f64>() / whole;
        for r in 0..weights.len() {
            values[r * stride + column] -= mean;
        }
    }
}
