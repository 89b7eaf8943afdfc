//! Vectors that are orthonormal in a metric, as Krylov's methods make them one after the other.

/// Orthonormal vectors, with their products by the metric.
#[derive(Clone, Debug, Default)]
pub(super) struct Orthonormal {
    pub(super) vectors: Vec<Vec<f64>>,
    pub(super) products: Vec<Vec<f64>>,
}

impl Orthonormal {
    /// Adds a vector of unit length that is orthogonal to all before it, with its product.
    pub(super) fn push(&mut self, x: Vec<f64>, product: Vec<f64>) {
        self.vectors.push(x);
        self.products.push(product);
    }

    /// Takes the parts along all vectors away, twice, and gives them.
    pub(super) fn clear(&self, x: &mut [f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.vectors.len()];
        for _ in 0..2 {
            for ((v, product), sum) in self.vectors.iter().zip(&self.products).zip(&mut sum) {
                let along = dot(product, x);
                x.iter_mut().zip(v).for_each(|(x, v)| *x -= along * v);
                *sum += along;
            }
        }
        sum
    }

    /// The combination of the vectors from `first` on.
    pub(super) fn combined(&self, first: usize, factors: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.vectors.first().map_or(0, Vec::len)];
        for (v, factor) in self.vectors[first..].iter().zip(factors) {
            out.iter_mut().zip(v).for_each(|(out, v)| *out += factor * v);
        }
        out
    }
}

pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

pub(super) fn scaled(x: &[f64], length: f64) -> Vec<f64> {
    x.iter().map(|x| x / length).collect()
}
