//! Mass properties of uniform shapes about their centres of mass, and the check that an inertia can belong to a real body.
//!
//! Textbook formulas (e.g. Meriam & Kraige, *Dynamics*, table D/4): bar m l²/12, disc m r²/2, box m (a² + b²)/12,
//! ball 2 m r²/5.

use super::joint::{apply, axis_rotation, transpose, unit};
use crate::geometry::{MassProperties, Space};
use crate::scalar::Scalar;

/// Mass m, centre and figures Ixx, Iyy, Izz, Ixy, Ixz, Iyz about it.
pub(super) fn properties<G: Space>(mass: f64, com: [f64; 3], figures: [f64; 6]) -> MassProperties<G> {
    MassProperties { mass: G::S::constant(mass), com: G::vector(&com), inertia: G::tensor(figures) }
}

/// A bar along x from the origin: length l, width b (y), height h (z).
pub(super) fn bar<G: Space>(m: f64, l: f64, b: f64, h: f64) -> MassProperties<G> {
    properties(m, [0.5 * l, 0.0, 0.0], cuboid(m, [l, b, h]))
}

/// A bar drawn between two points of the body frame.
pub(super) fn bar_between<G: Space>(m: f64, from: [f64; 3], to: [f64; 3], b: f64, h: f64) -> MassProperties<G> {
    let d: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
    let l = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    let middle = std::array::from_fn(|i| 0.5 * (from[i] + to[i]));
    let [xx, yy, zz, ..] = cuboid(m, [l, b, h]);
    // columns of R are the bar's axes: x along the bar, the others by the smallest rotation from the world's
    let r = axis_rotation([1.0, 0.0, 0.0], unit(d));
    let rt = transpose(&r);
    let column = |k: usize| {
        let mut e = [0.0; 3];
        e[k] = 1.0;
        let local = apply(&rt, e);
        apply(&r, [xx * local[0], yy * local[1], zz * local[2]])
    };
    let (x, y, z) = (column(0), column(1), column(2));
    properties(m, middle, [x[0], y[1], z[2], y[0], z[0], z[1]])
}

/// A disc about z.
pub(super) fn disc<G: Space>(m: f64, r: f64, thickness: f64) -> MassProperties<G> {
    let across = m * (3.0 * r * r + thickness * thickness) / 12.0;
    properties(m, [0.0; 3], [across, across, 0.5 * m * r * r, 0.0, 0.0, 0.0])
}

/// A box centred at the origin.
pub(super) fn block<G: Space>(m: f64, size: [f64; 3]) -> MassProperties<G> {
    properties(m, [0.0; 3], cuboid(m, size))
}

/// A ball.
pub(super) fn ball<G: Space>(m: f64, r: f64) -> MassProperties<G> {
    let i = 0.4 * m * r * r;
    properties(m, [0.0; 3], [i, i, i, 0.0, 0.0, 0.0])
}

fn cuboid(m: f64, [a, b, c]: [f64; 3]) -> [f64; 6] {
    let k = m / 12.0;
    [k * (b * b + c * c), k * (a * a + c * c), k * (a * a + b * b), 0.0, 0.0, 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Spatial;

    #[test]
    fn a_drawn_bar_is_the_bar_along_x_turned() {
        let drawn: MassProperties<Spatial<f64>> = bar_between(3.0, [1.0, 0.0, 0.0], [1.0, -2.0, 0.0], 0.1, 0.1);
        let along: MassProperties<Spatial<f64>> = bar(3.0, 2.0, 0.1, 0.1);
        assert!((drawn.inertia[(0, 0)] - along.inertia[(1, 1)]).abs() < 1e-14);
        assert!((drawn.inertia[(1, 1)] - along.inertia[(0, 0)]).abs() < 1e-14);
        assert!((drawn.inertia[(2, 2)] - along.inertia[(2, 2)]).abs() < 1e-14);
        assert!((drawn.com.y + 1.0).abs() < 1e-14);
    }
}
