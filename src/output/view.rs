//! From space to the plane of a picture.

/// The two directions of a picture, and the one towards the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    /// To the right.
    right: [f64; 3],
    /// Upwards.
    above: [f64; 3],
}

impl View {
    /// The x-y plane.
    pub(super) const PLANE: Self = Self { right: [1.0, 0.0, 0.0], above: [0.0, 1.0, 0.0] };

    /// An isometric view, in which `up` points upwards; lengths along the axes are drawn to one scale.
    pub(super) fn isometric(up: [f64; 3]) -> Self {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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
        let second = [up[1] * first[2] - up[2] * first[1], up[2] * first[0] - up[0] * first[2], up[0] * first[1] - up[1] * first[0]];
        let (c, s) = (0.75_f64.sqrt(), 0.5);
        Self {
            right: std::array::from_fn(|i| c * (second[i] - first[i])),
            above: std::array::from_fn(|i| up[i] - s * (first[i] + second[i])),
        }
    }

    /// A place or direction in the picture.
    pub(super) fn flat(&self, p: [f64; 3]) -> [f64; 2] {
        [self.right, self.above].map(|d| d[0] * p[0] + d[1] * p[1] + d[2] * p[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upwards_is_upwards_and_axes_have_one_scale() {
        for up in [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, -2.0]] {
            let view = View::isometric(up);
            let seen = view.flat(up);
            assert!(seen[0].abs() < 1e-12 && seen[1] > 0.0, "{seen:?}");
            for axis in 0..3 {
                let mut e = [0.0; 3];
                e[axis] = 1.0;
                let [x, y] = view.flat(e);
                assert!((x.hypot(y) - 1.0).abs() < 1e-12, "{x} {y}");
            }
        }
    }
}
