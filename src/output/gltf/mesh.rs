//! Triangles with the directions in which light leaves them.

/// A place or direction in a body.
pub(super) type V = [f64; 3];

/// Triangles, m.
#[derive(Clone, Debug, Default)]
pub(super) struct Mesh {
    pub(super) positions: Vec<V>,
    /// Unit outward directions, one to each place.
    pub(super) normals: Vec<V>,
    /// Three numbers of places to each triangle, counter-clockwise from outside.
    pub(super) indices: Vec<u32>,
}

impl Mesh {
    pub(super) fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Adds a flat convex face, its corners counter-clockwise from outside.
    pub(super) fn face(&mut self, corners: &[V]) {
        let normal = unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])));
        self.curved(corners, &vec![normal; corners.len()]);
    }

    /// Adds a convex face with a direction to each corner.
    pub(super) fn curved(&mut self, corners: &[V], normals: &[V]) {
        if !corners.iter().chain(normals).flatten().all(|x| x.is_finite()) {
            return;
        }
        let from = self.positions.len() as u32;
        self.positions.extend(corners);
        self.normals.extend(normals);
        for k in 2..corners.len() as u32 {
            self.indices.extend([from, from + k - 1, from + k]);
        }
    }
}

pub(super) fn minus(a: V, b: V) -> V {
    std::array::from_fn(|i| a[i] - b[i])
}

/// a + s b.
pub(super) fn plus(a: V, s: f64, b: V) -> V {
    std::array::from_fn(|i| a[i] + s * b[i])
}

pub(super) fn cross(a: V, b: V) -> V {
    crate::output::view::cross(a, b)
}

pub(super) fn length(a: V) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

pub(super) fn unit(a: V) -> V {
    let size = length(a);
    a.map(|x| x / size)
}
