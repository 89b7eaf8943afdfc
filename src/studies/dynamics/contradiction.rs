//! Rows that contradict each other: drivers and couplings that move the same thing, each as time says, may agree at the start and
//! part later.
//!
//! The regularised equations go on all the same, between the two. What tells it is the part of Φ that no displacement takes away,
//! Φ − G G⁺ Φ; beside constraints that drift, or in a singular position, that part is of second order.

use super::system::Mechanical;
use crate::geometry::Space;
use crate::mechanism::RowKind;
use crate::numerics::least_squares::shortest;

/// Residuals, in rad and sizes, up to which a scheme may leave the constraints open.
const OPEN: f64 = 1e-6;

/// Part of the residual that must be out of reach.
const OUT_OF_REACH: f64 = 0.1;

/// Which constraints contradict the others at the state that was observed last, at time `t`, in words; `size` is that of the
/// mechanism, m.
pub(super) fn explain<G>(system: &Mechanical<'_, G>, size: f64, t: f64) -> Option<String>
where
    G: Space<S = f64>,
{
    let (m, w) = (system.dynamics.mechanism, &system.dynamics.work);
    let scale: Vec<f64> = m.rows.iter().map(|row| if row.angular { 1.0 } else { size.recip() }).collect();
    let phi: Vec<f64> = w.phi.iter().zip(&scale).map(|(phi, scale)| phi * scale).collect();
    let open = phi.iter().fold(0.0, |most: f64, phi| most.max(phi.abs()));
    if open.is_nan() || open < OPEN {
        return None;
    }
    let mut g = w.g.to_dense();
    g.chunks_exact_mut(m.nv.max(1)).zip(&scale).for_each(|(row, scale)| row.iter_mut().for_each(|g| *g *= scale));
    let metric: Vec<f64> = m.units(m.size()).iter().map(|unit| 1.0 / (unit * unit)).collect();
    let delta = shortest(&g, &phi, &metric, 0.0);
    let left = phi.iter().zip(g.chunks_exact(m.nv.max(1))).map(|(phi, row)| phi - row.iter().zip(&delta).map(|(g, d)| g * d).sum::<f64>());
    let (row, left) = left.enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    if left.abs() < OPEN.max(OUT_OF_REACH * open) {
        return None;
    }
    let unit = match m.rows[row].kind {
        RowKind::Function(_) => "",
        _ if m.rows[row].angular => " rad",
        _ => " m",
    };
    Some(format!(
        "at t = {t:.6} s the constraints contradict each other: {} is missed by {:.2e}{unit}; drivers and couplings that hold the same motion must agree at all times, remove one of them",
        m.name_of_row(row),
        (left / scale[row]).abs()
    ))
}
