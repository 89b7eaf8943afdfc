//! Positions in which branches of the motion cross: there rows lose rank that they have beside them.

use super::freedom::rows;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::results::Finding;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};
use grashof_solvers::{Kkt, Sparsity};

/// How far beside a position rows are looked at, rad or sizes of the mechanism.
const BESIDE: f64 = 0.02;

/// Steps of Newton's method onto the constraints, and Φ, rad or sizes, with which it has come there.
const STEPS: usize = 12;
const CLOSED: f64 = 1e-11;

/// Directions of motions, in no special relation to each other.
const PHASES: [f64; 3] = [0.3, 1.7, 2.9];

/// That a position at rest is a change point, where the linear motion about it is that of no branch; `metric` is D (nv), `size` that of the
/// mechanism, m.
pub(crate) fn change_point<G>(m: &Mechanism<G>, q: &[f64], modes: &[i32], (metric, size): (&[f64], f64), place: &str) -> Option<Finding>
where
    G: Space<S = f64>,
{
    let [here, beside] = freedoms(m, q, modes, metric, size)?;
    let word = |n: usize| if n == 1 { "1 motion".to_string() } else { format!("{n} motions") };
    Some(Finding {
        code: "in-change-point".into(),
        message: format!(
            "the position is a change point, where branches of the motion cross: the constraints leave {} in it, but {} beside it. Stiffnesses, eigenvalues and stability are told for all of them together, which is the motion of no branch; those of a branch are found a little beside, from `start` with an exact value of 0.01 rad or more off",
            word(here),
            word(beside)
        ),
        path: place.into(),
    })
}

/// The degrees of freedom at a closed position and beside it, if there they are fewer.
fn freedoms<G: Space<S = f64>>(m: &Mechanism<G>, q: &[f64], modes: &[i32], metric: &[f64], size: f64) -> Option<[usize; 2]> {
    if m.rows.is_empty() {
        return None;
    }
    let (g, scale) = rows(m, q, modes, metric);
    let rank = Rank::new(&g, metric, &scale, RANK_TOLERANCE);
    if rank.dependent.is_empty() {
        return None;
    }
    let diagonal = Sparsity::new(m.nv, m.nv, (0..m.nv).map(|i| (i, i)));
    let mut kkt = Kkt::of_blocks(&diagonal, g.pattern());
    kkt.set_scale(metric, &scale);
    let mut dynamics = Dynamics::without_mass(m);
    dynamics.time(0.0, modes);
    let units = m.units(size);
    let row_unit: Vec<f64> = m.rows.iter().map(|row| if row.angular { 1.0 } else { size.recip() }).collect();
    let (zeros, mut delta, mut mu) = (vec![0.0; m.nv], vec![0.0; m.nv], vec![0.0; m.rows.len()]);
    let mut least = rank.mobility;
    for phase in PHASES {
        let parts: Vec<f64> = (0..rank.mobility).map(|k| (2.4 * k as f64 + phase).cos()).collect();
        let way = rank.motion(&parts);
        let most = way.iter().zip(&units).fold(0.0, |most, (v, unit)| f64::max(most, v.abs() / unit));
        let way: Vec<f64> = way.iter().map(|v| BESIDE * v / most).collect();
        let mut there = q.to_vec();
        m.retract(&mut there, &way);
        for _ in 0..STEPS {
            dynamics.position(&there, modes);
            let open = dynamics.work.phi.iter().zip(&row_unit).fold(0.0, |most, (phi, unit)| f64::max(most, phi.abs() * unit));
            if open <= CLOSED {
                let scale = dynamics.row_scale(&there, modes, metric);
                least = least.min(Rank::new(&dynamics.work.g, metric, &scale, RANK_TOLERANCE).mobility);
                break;
            }
            if kkt.factor(metric, dynamics.work.g.values()).is_err() {
                break;
            }
            let gamma: Vec<f64> = dynamics.work.phi.iter().map(|phi| -phi).collect();
            kkt.solve(&zeros, &gamma, &mut delta, &mut mu);
            m.retract(&mut there, &delta);
        }
    }
    (least < rank.mobility).then_some([rank.mobility, least])
}
