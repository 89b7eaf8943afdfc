//! The exact dead point: where the driver's time turns back along the path.
//!
//! Near a dead point every rate by time grows without bound, but along one of the coordinates, p, the path (q(p), t(p)) is
//! smooth, and the dead point is where dt/dp = 0. Position and tangent at a given p come from the constraints with t as an
//! unknown: [G, −ν; e_k, 0] [δq; δt] = [−Φ; p − p₀] (Keller 1977, bordered by a coordinate instead of the arc length).

use super::driven::Driven;
use super::node::PathPoint;
use crate::geometry::Space;
use crate::mechanism::Step;
use crate::numerics::least_squares::shortest;

/// Time and coordinates of the dead point ahead of `last`; none if the search does not settle.
pub(crate) fn fold<G: Space<S = f64>>(
    driven: &mut Driven<'_, G>,
    modes: &[i32],
    last: &PathPoint,
    direction: f64,
) -> Option<(f64, Vec<f64>)> {
    let m = driven.dynamics.mechanism;
    // the coordinate that moves fastest carries the path
    let (k, speed) = m
        .steps
        .iter()
        .filter_map(|s| match s {
            Step::Axis { v, .. } => Some((*v, last.v[*v])),
            Step::Ball { .. } => None,
        })
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let mut along = Along { driven, modes, k, q: last.q.clone(), t: last.t, p: 0.0 };
    // secant on dt/dp, beginning at p = 0 with the slope 1/v
    let (mut p0, mut s0) = (0.0, along.slope(0.0)?);
    let mut p1 = 1e-3 * speed.signum() * direction;
    let mut s1 = along.slope(p1)?;
    for _ in 0..40 {
        if s1 == s0 {
            break;
        }
        let p = p1 - s1 * (p1 - p0) / (s1 - s0);
        if !p.is_finite() || p.abs() > 0.5 {
            return None;
        }
        (p0, s0) = (p1, s1);
        s1 = along.slope(p)?;
        p1 = p;
        if (p1 - p0).abs() < 1e-14 {
            break;
        }
    }
    // the dead point lies ahead, and no farther than the last step could have seen
    ((along.t - last.t) * direction >= -1e-9).then_some((along.t, along.q))
}

/// The path by one coordinate.
struct Along<'a, 'm, G: Space> {
    driven: &'a mut Driven<'m, G>,
    modes: &'a [i32],
    k: usize,
    q: Vec<f64>,
    t: f64,
    p: f64,
}

impl<G: Space<S = f64>> Along<'_, '_, G> {
    /// Moves to the displacement `p` and returns dt/dp there.
    fn slope(&mut self, p: f64) -> Option<f64> {
        let m = self.driven.dynamics.mechanism;
        let n = m.nv + 1;
        let zeros = vec![0.0; m.nv];
        let metric = vec![1.0; n];
        for step in 0..30 {
            let d = &mut self.driven.dynamics;
            d.time(self.t, self.modes);
            d.position(&self.q, self.modes);
            d.velocity(&zeros, self.modes);
            let mut a = vec![0.0; (m.rows.len() + 1) * n];
            for row in 0..m.rows.len() {
                d.work.g.line(row).entries().for_each(|(k, g)| a[row * n + k] = g);
                a[row * n + m.nv] = -d.work.nu[row];
            }
            a[m.rows.len() * n + self.k] = 1.0;
            let mut b: Vec<f64> = d.work.phi.iter().map(|x| -x).collect();
            b.push(p - self.p);
            let x = shortest(&a, &b, &metric, 0.0);
            let size = x.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
            if !size.is_finite() || size > 3.0 {
                return None;
            }
            if size < 1e-15 || step == 29 {
                b.fill(0.0);
                b[m.rows.len()] = 1.0;
                return shortest(&a, &b, &metric, 0.0).last().copied();
            }
            m.retract(&mut self.q, &x[..m.nv]);
            self.t += x[m.nv];
            self.p += x[self.k];
        }
        None
    }
}
