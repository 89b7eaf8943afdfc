//! Things that belong together.

/// Sets of the numbers 0 to n − 1 that are joined two by two (Tarjan & van Leeuwen, J. ACM 31 (1984) 245-281: by path halving).
pub(crate) struct Sets {
    above: Vec<usize>,
}

impl Sets {
    /// Each number by itself.
    pub(crate) fn new(n: usize) -> Self {
        Self { above: (0..n).collect() }
    }

    /// The number that stands for the set of another.
    pub(crate) fn of(&mut self, mut k: usize) -> usize {
        while self.above[k] != k {
            self.above[k] = self.above[self.above[k]];
            k = self.above[k];
        }
        k
    }

    /// Makes the sets of two numbers one.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (one, other) = (self.of(a), self.of(b));
        self.above[other] = one;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_belongs_together() {
        let mut sets = Sets::new(6);
        [(0, 1), (3, 4), (1, 4)].into_iter().for_each(|(a, b)| sets.join(a, b));
        let of = [0, 1, 2, 3, 4, 5].map(|k| sets.of(k));
        assert!(of[0] == of[1] && of[1] == of[3] && of[3] == of[4], "{of:?}");
        assert!(of[2] != of[0] && of[5] != of[0] && of[2] != of[5], "{of:?}");
    }
}
