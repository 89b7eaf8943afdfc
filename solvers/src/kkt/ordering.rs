//! The order of elimination that keeps a sparse factorisation sparse.

use crate::Sparsity;
use crate::sparsity::SPARSE_COST;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

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
        let n = pattern.columns();
        let mut result = Self { order: Vec::with_capacity(n), fill: 0, operations: 0 };
        while let Some(pivot) = graph.least() {
            graph.eliminate(pivot);
            let (width, degree) = (std::mem::take(&mut graph.members[pivot]) as usize, graph.boundary_size[pivot] as usize);
            for left in (0..width).rev().map(|k| k + degree) {
                result.fill += 2 * left + 1;
                result.operations += left * left;
            }
            result.order.extend(graph.chain(pivot));
        }
        result
    }

    /// Cost of a sparse factorisation of a matrix of this pattern, in multiplications of a dense one.
    pub(super) fn cost(&self, pattern: &Sparsity) -> usize {
        SPARSE_COST * (self.operations + self.fill + pattern.entries())
    }
}

/// No pivot and no degree.
const NONE: u32 = u32::MAX;

/// The graph that is left after some eliminations; an eliminated node is an *element*, which stands for the clique of its boundary.
///
/// Lists of nodes stand in three arrays for all nodes: that one which a variable touches never grows, as a new element takes the place
/// of the pivot or of an element that it absorbs.
struct Quotient {
    /// Unknowns not eliminated yet.
    left: u32,
    /// What each variable touches: in front the variables that no element connects it to, rising, at the end of its room the elements, the
    /// last one made first.
    touched: Vec<u32>,
    /// Where the room of each variable begins, and the end (n + 1).
    begins: Vec<usize>,
    /// Number of variables and of elements there.
    variables: Vec<u32>,
    elements: Vec<u32>,
    /// Variables next to elements, one element after the other, and where those of each stand.
    boundaries: Vec<u32>,
    boundary: Vec<Range<usize>>,
    /// Unknowns in each boundary.
    boundary_size: Vec<u32>,
    /// Number of unknowns that each variable stands for; 0 once another variable or an element has taken it in.
    members: Vec<u32>,
    /// The unknown after each in the list of those that are eliminated together, and the end of the list that each begins.
    next: Vec<u32>,
    last: Vec<u32>,
    /// Approximate external degree of each variable, in unknowns.
    degree: Vec<u32>,
    /// Variables by whether they are eliminated after the first ones, by degree, then index. One counts where it stands with the degree in
    /// `queued`.
    queue: BinaryHeap<Reverse<(bool, u32, u32)>>,
    queued: Vec<u32>,
    /// Unknowns below it are eliminated first.
    first: usize,
    /// Whether an element is still there.
    alive: Vec<bool>,
    /// |L_e \ L_p| of the elements next to the boundary L_p of pivot p, valid where `seen` is p.
    outside: Vec<u32>,
    seen: Vec<u32>,
    /// The last pivot that a variable was found next to.
    near: Vec<u32>,
    /// Room for `merge_equal`.
    keyed: Vec<(u32, u32)>,
}

impl Quotient {
    fn new(pattern: &Sparsity, first: usize) -> Self {
        let n = pattern.columns();
        // an entry and the one across the diagonal are one neighbour
        let pairs = pattern.places().filter(|(i, j)| i != j).flat_map(|(i, j)| [(i, j), (j, i)]);
        let neighbours = Sparsity::new(n, n, pairs);
        let begins: Vec<usize> = (0..n).map(|i| neighbours.range(i).start).chain([neighbours.entries()]).collect();
        let touched = neighbours.places().map(|(_, j)| j as u32).collect();
        let degree: Vec<u32> = begins.windows(2).map(|ends| (ends[1] - ends[0]) as u32).collect();
        let queue: Vec<_> = degree.iter().zip(0..).map(|(degree, i)| Reverse((i as usize >= first, *degree, i))).collect();
        Self {
            left: n as u32,
            touched,
            begins,
            variables: degree.clone(),
            elements: vec![0; n],
            boundaries: Vec::with_capacity(n),
            boundary: vec![0..0; n],
            boundary_size: vec![0; n],
            members: vec![1; n],
            next: vec![NONE; n],
            last: (0..n as u32).collect(),
            queue: queue.into(),
            queued: degree.clone(),
            degree,
            first,
            alive: vec![false; n],
            outside: vec![0; n],
            seen: vec![NONE; n],
            near: vec![NONE; n],
            keyed: Vec::new(),
        }
    }

    /// Variables that no element connects a variable to.
    fn variables(&self, i: usize) -> &[u32] {
        &self.touched[self.begins[i]..][..self.variables[i] as usize]
    }

    /// Elements next to a variable, the last one made first.
    fn elements(&self, i: usize) -> &[u32] {
        let end = self.begins[i + 1];
        &self.touched[end - self.elements[i] as usize..end]
    }

    /// An unknown and those that follow in its list.
    fn chain(&self, i: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(i), |&i| Some(self.next[i]).filter(|&i| i != NONE).map(|i| i as usize))
    }

    /// Takes the variable of least degree out of the queue.
    fn least(&mut self) -> Option<usize> {
        while let Some(Reverse((_, degree, i))) = self.queue.pop() {
            let i = i as usize;
            if self.queued[i] == degree && self.members[i] > 0 {
                self.queued[i] = NONE;
                return Some(i);
            }
        }
        None
    }

    /// Makes variable `p` an element and brings its neighbours up to date.
    fn eliminate(&mut self, p: usize) {
        self.left -= self.members[p];
        let begin = self.boundaries.len();
        self.take_boundary(p);
        self.alive[p] = true;
        self.count_outside(p, begin);
        for k in begin..self.boundaries.len() {
            self.prune(p, self.boundaries[k] as usize);
        }
        self.eliminate_with(p, begin);
        let size = self.boundaries[begin..].iter().map(|&i| self.members[i as usize]).sum();
        self.boundary_size[p] = size;
        for k in begin..self.boundaries.len() {
            let i = self.boundaries[k] as usize;
            self.degree[i] = self.approximate_degree(p, i, size);
        }
        self.merge_equal(begin);
        for k in begin..self.boundaries.len() {
            let i = self.boundaries[k] as usize;
            // what a variable has taken in is no neighbour any more
            self.degree[i] = self.degree[i].min(self.left - self.members[i]);
            if std::mem::replace(&mut self.queued[i], self.degree[i]) != self.degree[i] {
                self.queue.push(Reverse((i >= self.first, self.degree[i], i as u32)));
            }
        }
        self.boundary[p] = begin..self.boundaries.len();
    }

    /// Whether two unknowns may be eliminated together: both are of the first ones, or neither is.
    fn alike(&self, i: usize, j: usize) -> bool {
        (i < self.first) == (j < self.first)
    }

    /// Has variable `i` or element `i` take in a variable.
    fn take_in(&mut self, i: usize, taken: usize) {
        self.members[i] += std::mem::take(&mut self.members[taken]);
        self.next[self.last[i] as usize] = taken as u32;
        self.last[i] = self.last[taken];
    }

    /// L_p = (A_p ∪ ⋃ L_e) \ {p}, e next to p, at the end of `boundaries`; these elements are absorbed. Marks its variables in `near`.
    fn take_boundary(&mut self, p: usize) {
        self.near[p] = p as u32;
        let (begin, end) = (self.begins[p], self.begins[p + 1]);
        for k in begin..begin + self.variables[p] as usize {
            self.find(p, self.touched[k] as usize);
        }
        for k in (end - self.elements[p] as usize..end).rev() {
            let e = self.touched[k] as usize;
            if std::mem::replace(&mut self.alive[e], false) {
                for k in self.boundary[e].clone() {
                    self.find(p, self.boundaries[k] as usize);
                }
            }
        }
    }

    /// Adds a variable to L_p, if it is one and not there yet.
    fn find(&mut self, p: usize, i: usize) {
        if self.members[i] > 0 && self.near[i] != p as u32 {
            self.near[i] = p as u32;
            self.boundaries.push(i as u32);
        }
    }

    /// |L_e \ L_p| = |L_e| − |L_e ∩ L_p| for all elements e next to a variable of L_p (algorithm 2 of the paper).
    fn count_outside(&mut self, p: usize, begin: usize) {
        for &i in &self.boundaries[begin..] {
            let i = i as usize;
            let end = self.begins[i + 1];
            for &e in &self.touched[end - self.elements[i] as usize..end] {
                let e = e as usize;
                if self.seen[e] != p as u32 {
                    self.seen[e] = p as u32;
                    self.outside[e] = self.boundary_size[e];
                }
                self.outside[e] -= self.members[i];
            }
        }
    }

    /// Leaves variable `i` of L_p only what p does not stand for: elements inside L_p are absorbed, neighbours in it dropped.
    fn prune(&mut self, p: usize, i: usize) {
        let (begin, end) = (self.begins[i], self.begins[i + 1]);
        let mut kept = begin;
        for k in begin..begin + self.variables[i] as usize {
            let j = self.touched[k];
            if self.near[j as usize] != p as u32 && self.members[j as usize] > 0 {
                self.touched[kept] = j;
                kept += 1;
            }
        }
        self.variables[i] = (kept - begin) as u32;
        let mut kept = end;
        for k in (end - self.elements[i] as usize..end).rev() {
            let e = self.touched[k];
            self.alive[e as usize] &= self.outside[e as usize] > 0;
            if self.alive[e as usize] {
                kept -= 1;
                self.touched[kept] = e;
            }
        }
        kept -= 1;
        self.touched[kept] = p as u32;
        self.elements[i] = (end - kept) as u32;
    }

    /// Eliminates variables that touch nothing but p with it, without fill.
    fn eliminate_with(&mut self, p: usize, begin: usize) {
        let mut kept = begin;
        for k in begin..self.boundaries.len() {
            let i = self.boundaries[k] as usize;
            if self.variables[i] > 0 || self.elements[i] > 1 || !self.alike(i, p) {
                self.boundaries[kept] = i as u32;
                kept += 1;
            } else {
                self.left -= self.members[i];
                self.take_in(p, i);
            }
        }
        self.boundaries.truncate(kept);
    }

    /// min(n − k, d_i + |L_p \ i|, |A_i \ i| + |L_p \ i| + Σ |L_e \ L_p|), equation (4.1) of the paper.
    fn approximate_degree(&self, p: usize, i: usize, boundary_size: u32) -> u32 {
        let (own, p) = (self.members[i], p as u32);
        let with_p = boundary_size - own;
        let variables: usize = self.variables(i).iter().map(|&j| self.members[j as usize] as usize).sum();
        let elements: usize = self.elements(i).iter().filter(|&&e| e != p).map(|&e| self.outside[e as usize] as usize).sum();
        let most = (self.degree[i] + with_p).min(self.left - own);
        (variables + elements + with_p as usize).min(most as usize) as u32
    }

    /// Joins variables of the boundary that have the same neighbours: they will be eliminated together.
    fn merge_equal(&mut self, begin: usize) {
        let mut keyed = std::mem::take(&mut self.keyed);
        let key = |i: usize| self.variables(i).iter().chain(self.elements(i)).fold(0_u32, |s, &x| s.wrapping_add(x));
        keyed.extend(self.boundaries[begin..].iter().map(|&i| (key(i as usize), i)));
        keyed.sort_unstable();
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            for (k, &(_, i)) in group.iter().enumerate() {
                let i = i as usize;
                if self.members[i] == 0 {
                    continue;
                }
                for &(_, j) in &group[k + 1..] {
                    let j = j as usize;
                    let equal = self.variables(i) == self.variables(j) && self.elements(i) == self.elements(j);
                    if equal && self.alike(i, j) && self.members[j] > 0 {
                        self.degree[i] = self.degree[i].saturating_sub(self.members[j]);
                        self.take_in(i, j);
                    }
                }
            }
        }
        keyed.clear();
        self.keyed = keyed;
        let mut kept = begin;
        for k in begin..self.boundaries.len() {
            if self.members[self.boundaries[k] as usize] > 0 {
                self.boundaries[kept] = self.boundaries[k];
                kept += 1;
            }
        }
        self.boundaries.truncate(kept);
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
