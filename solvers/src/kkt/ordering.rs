//! The order of elimination that keeps a sparse factorisation sparse.

use crate::Sparsity;
use crate::sparsity::SPARSE_COST;
use std::collections::BTreeSet;

/// An order of elimination and what elimination on the diagonal in this order costs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ordering {
    /// The unknown eliminated at each step (n).
    pub order: Vec<usize>,
    /// Entries of L + U, the unit diagonal of L not counted, if every pivot is on the diagonal.
    pub fill: usize,
    /// Multiplications of that factorisation, without the divisions by pivots.
    pub operations: usize,
}

impl Ordering {
    /// Approximate minimum degree on the graph of A + Aᵀ, A square.
    ///
    /// Amestoy, Davis & Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886-905: a quotient graph with element absorption, also the
    /// aggressive kind (section 3.5 there), mass elimination, indistinguishable variables and the approximate external
    /// degree of equation (4.1). Of equal degrees the smaller index goes first, so the order is the same in every run.
    pub fn minimum_degree(pattern: &Sparsity) -> Self {
        Self::first_below(pattern.columns(), pattern)
    }

    /// The same with all unknowns below `first` before the others.
    pub(super) fn first_below(first: usize, pattern: &Sparsity) -> Self {
        let mut graph = Quotient::new(pattern, first);
        let mut result = Self { order: Vec::with_capacity(graph.n), fill: 0, operations: 0 };
        while let Some((.., pivot)) = graph.queue.pop_first() {
            graph.eliminate(pivot);
            let (width, degree) = (graph.members[pivot].len(), graph.boundary_size[pivot]);
            for left in (0..width).rev().map(|k| k + degree) {
                result.fill += 2 * left + 1;
                result.operations += left * left;
            }
            result.order.append(&mut graph.members[pivot]);
        }
        result
    }

    /// Cost of a sparse factorisation of a matrix of this pattern, in multiplications of a dense one.
    pub(super) fn cost(&self, pattern: &Sparsity) -> usize {
        SPARSE_COST * (self.operations + self.fill + pattern.entries())
    }
}

/// The graph that is left after some eliminations; an eliminated node is an *element*, which stands for the clique of its boundary.
struct Quotient {
    n: usize,
    /// Unknowns not eliminated yet.
    left: usize,
    /// Neighbours of each variable that no element connects it to, rising.
    variables: Vec<Vec<usize>>,
    /// Elements next to each variable, in the order of their making.
    elements: Vec<Vec<usize>>,
    /// Variables next to each element.
    boundary: Vec<Vec<usize>>,
    /// Unknowns in each boundary.
    boundary_size: Vec<usize>,
    /// Unknowns that each variable stands for; none once another variable or an element has taken it in.
    members: Vec<Vec<usize>>,
    /// Approximate external degree of each variable, in unknowns.
    degree: Vec<usize>,
    /// Variables by whether they are eliminated after the first ones, by degree, then index.
    queue: BTreeSet<(bool, usize, usize)>,
    /// Unknowns below it are eliminated first.
    first: usize,
    /// Whether an element is still there.
    alive: Vec<bool>,
    /// |L_e \ L_p| of the elements next to the boundary L_p of pivot p, valid where `seen` is p.
    outside: Vec<usize>,
    seen: Vec<usize>,
    /// The last pivot that a variable was found next to.
    near: Vec<usize>,
}

impl Quotient {
    fn new(pattern: &Sparsity, first: usize) -> Self {
        let n = pattern.columns();
        let other = pattern.transposed();
        let variables: Vec<Vec<usize>> = (0..n)
            .map(|j| {
                let mut row: Vec<usize> = pattern.row(j).iter().chain(other.row(j)).copied().filter(|&i| i != j).collect();
                row.sort_unstable();
                row.dedup();
                row
            })
            .collect();
        let degree: Vec<usize> = variables.iter().map(Vec::len).collect();
        Self {
            n,
            left: n,
            queue: degree.iter().zip(0..n).map(|(degree, i)| (i >= first, *degree, i)).collect(),
            first,
            elements: vec![Vec::new(); n],
            boundary: vec![Vec::new(); n],
            boundary_size: vec![0; n],
            members: (0..n).map(|i| vec![i]).collect(),
            alive: vec![false; n],
            outside: vec![0; n],
            seen: vec![usize::MAX; n],
            near: vec![usize::MAX; n],
            variables,
            degree,
        }
    }

    /// Makes variable `p` an element and brings its neighbours up to date.
    fn eliminate(&mut self, p: usize) {
        self.left -= self.members[p].len();
        let boundary = self.take_boundary(p);
        self.alive[p] = true;
        self.boundary_size[p] = self.size(&boundary);
        self.count_outside(p, &boundary);
        for &i in &boundary {
            self.queue.remove(&self.queued(i));
            self.prune(p, i);
        }
        let boundary = self.eliminate_with(p, boundary);
        let size = self.size(&boundary);
        self.boundary_size[p] = size;
        for &i in &boundary {
            self.degree[i] = self.approximate_degree(p, i, size);
        }
        let boundary = self.merge_equal(boundary);
        for &i in &boundary {
            // what a variable has taken in is no neighbour any more
            self.degree[i] = self.degree[i].min(self.left - self.members[i].len());
            self.queue.insert(self.queued(i));
        }
        self.boundary[p] = boundary;
    }

    /// The place of a variable in the queue.
    fn queued(&self, i: usize) -> (bool, usize, usize) {
        (i >= self.first, self.degree[i], i)
    }

    /// Whether two unknowns may be eliminated together: both are of the first ones, or neither is.
    fn alike(&self, i: usize, j: usize) -> bool {
        (i < self.first) == (j < self.first)
    }

    fn size(&self, variables: &[usize]) -> usize {
        variables.iter().map(|&i| self.members[i].len()).sum()
    }

    /// L_p = (A_p ∪ ⋃ L_e) \ {p}, e next to p; these elements are absorbed. Marks its variables in `near`.
    fn take_boundary(&mut self, p: usize) -> Vec<usize> {
        self.near[p] = p;
        let mut boundary = Vec::new();
        let mut lists = vec![std::mem::take(&mut self.variables[p])];
        for e in std::mem::take(&mut self.elements[p]) {
            if std::mem::replace(&mut self.alive[e], false) {
                lists.push(std::mem::take(&mut self.boundary[e]));
            }
        }
        for i in lists.into_iter().flatten() {
            if !self.members[i].is_empty() && self.near[i] != p {
                self.near[i] = p;
                boundary.push(i);
            }
        }
        boundary
    }

    /// |L_e \ L_p| = |L_e| − |L_e ∩ L_p| for all elements e next to a variable of L_p (algorithm 2 of the paper).
    fn count_outside(&mut self, p: usize, boundary: &[usize]) {
        for &i in boundary {
            for &e in &self.elements[i] {
                if self.seen[e] != p {
                    self.seen[e] = p;
                    self.outside[e] = self.boundary_size[e];
                }
                self.outside[e] -= self.members[i].len();
            }
        }
    }

    /// Leaves variable `i` of L_p only what p does not stand for: elements inside L_p are absorbed, neighbours in it dropped.
    fn prune(&mut self, p: usize, i: usize) {
        let (near, members, outside, alive) = (&self.near, &self.members, &self.outside, &mut self.alive);
        self.variables[i].retain(|&j| near[j] != p && !members[j].is_empty());
        self.elements[i].retain(|&e| {
            alive[e] &= outside[e] > 0;
            alive[e]
        });
        self.elements[i].push(p);
    }

    /// Variables that touch nothing but p are eliminated with it, without fill; the rest of the boundary.
    fn eliminate_with(&mut self, p: usize, mut boundary: Vec<usize>) -> Vec<usize> {
        boundary.retain(|&i| {
            let stays = !self.variables[i].is_empty() || self.elements[i].len() > 1 || !self.alike(i, p);
            if !stays {
                let mut taken = std::mem::take(&mut self.members[i]);
                self.left -= taken.len();
                self.members[p].append(&mut taken);
            }
            stays
        });
        boundary
    }

    /// min(n − k, d_i + |L_p \ i|, |A_i \ i| + |L_p \ i| + Σ |L_e \ L_p|), equation (4.1) of the paper.
    fn approximate_degree(&self, p: usize, i: usize, boundary_size: usize) -> usize {
        let own = self.members[i].len();
        let with_p = boundary_size - own;
        let elements: usize = self.elements[i].iter().filter(|&&e| e != p).map(|&e| self.outside[e]).sum();
        let sum = self.size(&self.variables[i]) + with_p + elements;
        sum.min(self.degree[i] + with_p).min(self.left - own)
    }

    /// Joins variables of one boundary that have the same neighbours: they will be eliminated together.
    fn merge_equal(&mut self, mut boundary: Vec<usize>) -> Vec<usize> {
        let key = |i: usize| self.variables[i].iter().chain(&self.elements[i]).fold(0_usize, |s, &x| s.wrapping_add(x));
        let mut keyed: Vec<(usize, usize)> = boundary.iter().map(|&i| (key(i), i)).collect();
        keyed.sort_unstable();
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            for (k, &(_, i)) in group.iter().enumerate() {
                if self.members[i].is_empty() {
                    continue;
                }
                for &(_, j) in &group[k + 1..] {
                    let equal = self.variables[i] == self.variables[j] && self.elements[i] == self.elements[j];
                    if equal && self.alike(i, j) && !self.members[j].is_empty() {
                        let mut taken = std::mem::take(&mut self.members[j]);
                        self.degree[i] = self.degree[i].saturating_sub(taken.len());
                        self.members[i].append(&mut taken);
                    }
                }
            }
        }
        boundary.retain(|&i| !self.members[i].is_empty());
        boundary
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::Noise;

    /// Entries of L + U by elimination on a full pattern.
    fn fill_of(pattern: &Sparsity, order: &[usize]) -> usize {
        let n = order.len();
        let mut full = vec![vec![false; n]; n];
        for (i, j) in pattern.places() {
            full[i][j] = true;
            full[j][i] = true;
        }
        let mut fill = n;
        for (k, &p) in order.iter().enumerate() {
            let next: Vec<usize> = order[k + 1..].iter().copied().filter(|&i| full[i][p]).collect();
            fill += 2 * next.len();
            for &i in &next {
                next.iter().for_each(|&j| full[i][j] = true);
            }
        }
        fill
    }

    fn assert_permutation(order: &[usize]) {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..order.len()));
    }

    #[test]
    fn an_arrow_and_a_tree_get_no_fill() {
        let n = 200;
        let arrow = Sparsity::new(n, n, (0..n).flat_map(|i| [(i, i), (0, i), (i, 0)]));
        let found = Ordering::minimum_degree(&arrow);
        assert_permutation(&found.order);
        assert_eq!((found.fill, found.operations), (3 * n - 2, n - 1));
        // child i of parent i/3, in one triangle only
        let tree = Sparsity::new(n, n, (1..n).map(|i| (i, i / 3)));
        assert_eq!(Ordering::minimum_degree(&tree).fill, 3 * n - 2);
    }

    #[test]
    fn the_count_is_that_of_elimination() {
        let mut noise = Noise(17);
        for (n, density) in [(1, 1.0), (2, 0.5), (30, 0.1), (60, 0.05), (60, 0.2), (120, 0.02), (40, 1.0)] {
            let entries: Vec<_> = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|_| noise.next().abs() < density).collect();
            let pattern = Sparsity::new(n, n, entries);
            let found = Ordering::minimum_degree(&pattern);
            assert_permutation(&found.order);
            assert_eq!(found.fill, fill_of(&pattern, &found.order), "{n} unknowns, density {density}");
            assert_eq!(found, Ordering::minimum_degree(&pattern));
        }
    }

    #[test]
    fn the_first_unknowns_come_first() {
        let mut noise = Noise(4);
        for (n, first) in [(40, 25), (60, 1), (60, 59), (30, 0)] {
            let entries: Vec<_> = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|_| noise.next().abs() < 0.08).collect();
            let pattern = Sparsity::new(n, n, entries);
            let found = Ordering::first_below(first, &pattern);
            assert_permutation(&found.order);
            assert!(found.order[..first].iter().all(|i| *i < first));
            assert_eq!(found.fill, fill_of(&pattern, &found.order));
        }
    }

    #[test]
    fn a_grid_gets_as_little_fill_as_known() {
        // five-point grid: natural order fills 2 m³, minimum degree about 31 n log₂ n / 4 at most
        let m = 24;
        let at = |i: usize, j: usize| i * m + j;
        let entries = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
        let entries = entries.flat_map(|(i, j)| [(at(i, j), at((i + 1).min(m - 1), j)), (at(i, j), at(i, (j + 1).min(m - 1)))]);
        let pattern = Sparsity::new(m * m, m * m, entries);
        let found = Ordering::minimum_degree(&pattern);
        assert_permutation(&found.order);
        assert!(found.fill < 2 * m * m * m / 2, "{}", found.fill);
        assert_eq!(found.fill, fill_of(&pattern, &found.order));
    }

    #[test]
    fn nothing_needs_no_order() {
        assert_eq!(Ordering::minimum_degree(&Sparsity::empty(0, 0)).order, []);
        assert_eq!(Ordering::minimum_degree(&Sparsity::empty(3, 3)).order, [0, 1, 2]);
    }
}
