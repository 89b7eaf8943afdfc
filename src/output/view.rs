//! From space to the plane of a picture.

/// Elevation of the isometric view, in which the three axes are drawn to one scale, rad: sin ε = 1/√3.
const ISOMETRIC: f64 = 0.615_479_708_670_387_3;

/// The two directions of a picture, and the one towards the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    /// To the right.
    right: [f64; 3],
    /// Upwards.
    above: [f64; 3],
    /// Unit direction towards the eye.
    toward: [f64; 3],
}

impl View {
    /// The x-y plane.
    pub(super) const PLANE: Self = Self { right: [1.0, 0.0, 0.0], above: [0.0, 1.0, 0.0], toward: [0.0, 0.0, 1.0] };

    /// Azimuth and elevation of the isometric view, rad.
    pub(super) const ISOMETRIC: [f64; 2] = [std::f64::consts::FRAC_PI_4, ISOMETRIC];

    /// An isometric view, in which `up` points upwards; lengths along the axes are drawn as they are.
    pub(super) fn isometric(up: [f64; 3]) -> Self {
        let View { right, above, toward } = Self::from(up, Self::ISOMETRIC[0], Self::ISOMETRIC[1]);
        // an axis is seen under acos √(2/3)
        let stretch = 1.5_f64.sqrt();
        Self { right: right.map(|x| x * stretch), above: above.map(|x| x * stretch), toward }
    }

    /// The view of an eye at an azimuth from the first level axis (x, with z upwards) about `up`, and an elevation, rad.
    pub(super) fn from(up: [f64; 3], azimuth: f64, elevation: f64) -> Self {
        let [up, first, second] = level(up);
        let ((sa, ca), (se, ce)) = (azimuth.sin_cos(), elevation.sin_cos());
        let level: [f64; 3] = std::array::from_fn(|i| ca * first[i] + sa * second[i]);
        Self {
            right: std::array::from_fn(|i| ca * second[i] - sa * first[i]),
            above: std::array::from_fn(|i| ce * up[i] - se * level[i]),
            toward: std::array::from_fn(|i| ce * level[i] + se * up[i]),
        }
    }

    /// A place or direction in the picture.
    pub(super) fn flat(&self, p: [f64; 3]) -> [f64; 2] {
        [dot(self.right, p), dot(self.above, p)]
    }

    /// How near a place is to the eye, m.
    pub(super) fn depth(&self, p: [f64; 3]) -> f64 {
        dot(self.toward, p)
    }

    /// Two unit directions across an axis, counter-clockwise about it, of which the one at an angle from the first to the second is that
    /// towards the eye: what goes round is seen on its near side. Any two where the axis points to the eye.
    pub(super) fn facing(&self, axis: [f64; 3], angle: f64) -> [[f64; 3]; 2] {
        let [u, v] = across(axis);
        let (x, y) = (self.depth(u), self.depth(v));
        if x.hypot(y) < 0.1 {
            return [u, v];
        }
        let (s, c) = (y.atan2(x) - angle).sin_cos();
        [std::array::from_fn(|i| c * u[i] + s * v[i]), std::array::from_fn(|i| c * v[i] - s * u[i])]
    }

    /// Length in the picture of what is 1 m long across the line of sight, m.
    pub(super) fn stretch(&self) -> f64 {
        dot(self.right, self.right).sqrt()
    }
}

/// The unit direction upwards, and two level ones from which azimuths are counted, counter-clockwise seen from above.
pub(super) fn level(up: [f64; 3]) -> [[f64; 3]; 3] {
    let length = dot(up, up).sqrt();
    let up = up.map(|x| x / length);
    // of x, y, z that which follows the one nearest to up
    let nearest = (0..3).fold(2, |best, i| if up[i].abs() > up[best].abs() + 1e-9 { i } else { best });
    let mut first = [0.0; 3];
    first[(nearest + 1) % 3] = 1.0;
    let height = dot(first, up);
    let first: [f64; 3] = std::array::from_fn(|i| first[i] - height * up[i]);
    let size = dot(first, first).sqrt();
    let first = first.map(|x| x / size);
    [up, first, cross(up, first)]
}

/// a · b.
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Two unit directions at right angles to an axis and to each other, counter-clockwise about it.
pub(super) fn across(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let length = dot(axis, axis).sqrt();
    if length.is_nan() || length <= 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    }
    let axis = axis.map(|x| x / length);
    let least = (0..3).fold(0, |best, i| if axis[i].abs() < axis[best].abs() - 1e-9 { i } else { best });
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let first = cross(e, axis);
    let size = dot(first, first).sqrt();
    let first = first.map(|x| x / size);
    [first, cross(axis, first)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upwards_is_upwards_and_axes_have_one_scale() {
        for up in [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, -2.0]] {
            let view = View::isometric(up);
            let seen = view.flat(up);
            assert!(seen[0].abs() < 1e-12 && seen[1] > 0.0 && view.depth(up) > 0.0, "{seen:?}");
            for axis in 0..3 {
                let mut e = [0.0; 3];
                e[axis] = 1.0;
                let [x, y] = view.flat(e);
                assert!((x.hypot(y) - 1.0).abs() < 1e-12, "{x} {y}");
            }
        }
    }

    #[test]
    fn the_front_shows_x_to_the_right_and_z_upwards() {
        let view = View::from([0.0, 0.0, 1.0], -std::f64::consts::FRAC_PI_2, 0.0);
        let [x, z] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]].map(|e| view.flat(e));
        assert!((x[0] - 1.0).abs() < 1e-12 && x[1].abs() < 1e-12 && (z[1] - 1.0).abs() < 1e-12, "{x:?} {z:?}");
        assert!((view.depth([0.0, -1.0, 0.0]) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_goes_round_is_seen_on_its_near_side() {
        // from the front and from behind, edge-on: the near side is in the direction of the eye
        for azimuth in [-0.25, 0.25, 0.1] {
            let view = View::from([0.0, 0.0, 1.0], azimuth * std::f64::consts::TAU, 0.0);
            let (s, c) = 0.75_f64.sin_cos();
            let [u, v] = view.facing([2.0, 0.0, 0.0], 0.75);
            let near: [f64; 3] = std::array::from_fn(|i| c * u[i] + s * v[i]);
            assert!(near[1].abs() > 1.0 - 1e-12 && view.depth(near) > 0.5, "{near:?}");
            assert!((dot(cross(u, v), [1.0, 0.0, 0.0]) - 1.0).abs() < 1e-12, "{u:?} {v:?}");
        }
    }

    #[test]
    fn directions_across_an_axis_turn_about_it() {
        for axis in [[0.0, 0.0, 2.0], [1.0, -1.0, 0.5]] {
            let [a, b] = across(axis);
            assert!(dot(a, axis).abs() < 1e-12 && dot(b, axis).abs() < 1e-12 && dot(cross(a, b), axis) > 0.0);
        }
    }
}
