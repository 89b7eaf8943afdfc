//! A = L D Lᵀ of a sparse quasi-definite matrix, made for many matrices of one pattern.
//!
//! As in [`super::definite`] no pivot is sought: all velocities are eliminated first, then the rows of constraints, each in the order of minimum
//! degree, so that D is positive in the first part and negative in the second (Vanderbei 1995). A row that came before one of its velocities
//! would have little but E for a pivot.
//!
//! Where a product of the elimination belongs is known beforehand, so that a factorisation is one walk along a list.

use super::Blocks;
use super::columns::Columns;
use super::definite::{MASSLESS, refines};
use super::ordering::Ordering;
use crate::Sparsity;
use crate::sparsity::SPARSE_COST;

/// The factors with the scaled matrix; sized once, then free of allocation. Indices of rows and columns are steps of the elimination.
#[derive(Clone, Debug)]
pub(super) struct Quasi {
    /// The unknown eliminated at each step (n): velocities (nv), then rows.
    order: Vec<u32>,
    nv: usize,
    /// Where entries of M and of G come from and go to.
    sources: [Vec<Source>; 2],
    /// Products of the scales of row and column of each of these.
    products: [Vec<f64>; 2],
    /// Scaled [M Gᵀ; G 0] to the right of its diagonal by rows, and the diagonal.
    columns: Columns<u32>,
    plain: Vec<f64>,
    diagonal: Vec<f64>,
    /// Lᵀ to the right of its diagonal by rows; 1/D.
    upper: Columns<u32>,
    values: Vec<f64>,
    inverse: Vec<f64>,
    /// Where each product of two entries of a row of Lᵀ belongs in `values`, in the order in which they come.
    targets: Vec<u32>,
    /// A row (the longest), a solution, and a residual or correction (n).
    row: Vec<f64>,
    x: Vec<f64>,
    r: Vec<f64>,
}

/// An entry of M or G.
#[derive(Clone, Copy, Debug)]
struct Source {
    /// Its place in the values of the block.
    from: u32,
    /// Its step if it is on the diagonal, else its place in `plain`.
    plain: u32,
    /// Its place in `values`; none on the diagonal.
    factor: Option<u32>,
}

/// Cost of the factorisation in its order, in multiplications of that of a full matrix, and that order.
pub(super) fn ordered(nv: usize, whole: &Sparsity) -> (usize, Ordering) {
    let ordering = Ordering::first_below(nv, whole);
    let beside = (ordering.fill - ordering.order.len()) / 2;
    (SPARSE_COST * ((ordering.operations + beside) / 2 + 2 * beside + whole.entries() / 2), ordering)
}

impl Quasi {
    /// Room for the factors of M and G with the given patterns, `whole` that of [M Gᵀ; G −E], in the order of [`ordered`].
    pub(super) fn new(blocks: &Blocks, whole: &Sparsity, ordering: &Ordering) -> Self {
        let (n, nv) = (blocks.order(), blocks.velocities());
        let [mass, g] = &blocks.0;
        let mut step = vec![0; n];
        ordering.order.iter().enumerate().for_each(|(k, &i)| step[i] = k);
        let columns = beside(n, whole.places().map(|(i, j)| (step[i], step[j])));
        let upper = filled(n, &columns);
        let mut sources = [Vec::new(), Vec::new()];
        for (block, shift, out) in [(mass, 0, 0), (g, nv, 1)] {
            for (from, (i, j)) in block.places().enumerate() {
                let (a, b) = (step[shift + i], step[j]);
                // of M, which is symmetric, one triangle
                if out == 0 && a > b {
                    continue;
                }
                let (a, b) = (a.min(b), a.max(b));
                let (plain, factor) = match a == b {
                    true => (Some(a), None),
                    false => (place(&columns, a, b), place(&upper, a, b)),
                };
                let Some(plain) = plain else { continue };
                sources[out].push(Source { from: from as u32, plain: plain as u32, factor: factor.map(|f| f as u32) });
            }
        }
        let longest = (0..n).map(|k| upper.range(k).len()).max().unwrap_or(0);
        Self {
            order: ordering.order.iter().map(|i| *i as u32).collect(),
            nv,
            products: [0, 1].map(|block| vec![1.0; sources[block].len()]),
            sources,
            plain: vec![0.0; columns.items.len()],
            diagonal: vec![0.0; n],
            targets: targets(&upper),
            values: vec![0.0; upper.items.len()],
            inverse: vec![0.0; n],
            row: vec![0.0; longest],
            x: vec![0.0; n],
            r: vec![0.0; n],
            columns,
            upper,
        }
    }

    /// Takes the scales of the unknowns (n) for the patterns of M and G.
    pub(super) fn set_scale(&mut self, blocks: &Blocks, scale: &[f64]) {
        for (block, shift) in [(0, 0), (1, self.nv)] {
            let places: Vec<_> = blocks.0[block].places().collect();
            for (product, source) in self.products[block].iter_mut().zip(&self.sources[block]) {
                let (i, j) = places[source.from as usize];
                *product = scale[shift + i] * scale[j];
            }
        }
    }

    /// Factors M and G, given by the values of their patterns, with the scaled E (m).
    ///
    /// False if M is nearly singular, or a number is not finite.
    pub(super) fn factor(&mut self, blocks: [&[f64]; 2], e: &[f64]) -> bool {
        self.values.fill(0.0);
        for ((sources, products), values) in self.sources.iter().zip(&self.products).zip(blocks) {
            for (source, product) in sources.iter().zip(products) {
                let x = values[source.from as usize] * product;
                match source.factor {
                    Some(place) => (self.plain[source.plain as usize], self.values[place as usize]) = (x, x),
                    None => self.diagonal[source.plain as usize] = x,
                }
            }
        }
        let (of_mass, of_rows) = self.inverse.split_at_mut(self.nv);
        of_mass.copy_from_slice(&self.diagonal[..self.nv]);
        of_rows.iter_mut().zip(&self.order[self.nv..]).for_each(|(d, &i)| *d = -e[i as usize - self.nv]);
        self.eliminate()
    }

    /// L and 1/D in the place of the matrix and of its diagonal.
    fn eliminate(&mut self) -> bool {
        let mut targets = self.targets.iter();
        for k in 0..self.order.len() {
            let d = self.inverse[k];
            let sound = if k < self.nv { d > MASSLESS && d < f64::INFINITY } else { d < 0.0 && d > f64::NEG_INFINITY };
            if !sound {
                return false;
            }
            let inverse = d.recip();
            self.inverse[k] = inverse;
            let range = self.upper.range(k);
            let row = &mut self.row[..range.len()];
            row.copy_from_slice(&self.values[range.clone()]);
            for (a, &step) in self.upper.items[range.clone()].iter().enumerate() {
                // l_jk = u_kj / d_k, a_ji −= l_jk u_ki
                let l = row[a] * inverse;
                self.inverse[step as usize] -= l * row[a];
                let rest = &row[a + 1..];
                for (u, &target) in rest.iter().zip(targets.as_slice()) {
                    self.values[target as usize] -= l * u;
                }
                targets = targets.as_slice()[rest.len()..].iter();
                self.values[range.start + a] = l;
            }
        }
        true
    }

    /// b := A⁻¹ b (n), with as many `refinements` against the matrix without E (m) as the residual asks for.
    pub(super) fn solve(&mut self, e: &[f64], b: &mut [f64], refinements: usize) {
        for (x, &i) in self.x.iter_mut().zip(&self.order) {
            *x = b[i as usize];
        }
        substitute(&self.upper, [&self.values, &self.inverse], &mut self.x, 0);
        if refinements > 0 {
            // what E has done, all at once: the residual of this solution is −Eλ
            self.r[..self.nv].fill(0.0);
            for ((r, x), &i) in self.r.iter_mut().zip(&self.x).zip(&self.order).skip(self.nv) {
                *r = -e[i as usize - self.nv] * x;
            }
            self.correct(self.nv);
        }
        for _ in 1..refinements {
            self.r.iter_mut().zip(&self.order).for_each(|(r, &i)| *r = b[i as usize]);
            self.subtract_product();
            if !refines(&self.r, &self.x) {
                break;
            }
            self.correct(0);
        }
        for (x, &i) in self.x.iter().zip(&self.order) {
            b[i as usize] = *x;
        }
    }

    /// x += A⁻¹ r, where r is zero in all steps below `first`.
    fn correct(&mut self, first: usize) {
        substitute(&self.upper, [&self.values, &self.inverse], &mut self.r, first);
        self.x.iter_mut().zip(&self.r).for_each(|(x, r)| *x += r);
    }

    /// r −= [M Gᵀ; G 0] x.
    fn subtract_product(&mut self) {
        let (x, r) = (&self.x[..], &mut self.r[..]);
        for k in 0..x.len() {
            let range = self.columns.range(k);
            let mut sum = self.diagonal[k] * x[k];
            for (&j, a) in self.columns.items[range.clone()].iter().zip(&self.plain[range]) {
                sum += a * x[j as usize];
                r[j as usize] -= a * x[k];
            }
            r[k] -= sum;
        }
    }
}

/// x := L⁻ᵀ D⁻¹ L⁻¹ x, where x is zero in all steps below `first`.
fn substitute(upper: &Columns<u32>, [values, inverse]: [&[f64]; 2], x: &mut [f64], first: usize) {
    for k in first..x.len() {
        let (range, y) = (upper.range(k), x[k]);
        for (&j, l) in upper.items[range.clone()].iter().zip(&values[range]) {
            x[j as usize] -= l * y;
        }
    }
    for k in (0..x.len()).rev() {
        let range = upper.range(k);
        let mut sum = x[k] * inverse[k];
        for (&j, l) in upper.items[range.clone()].iter().zip(&values[range]) {
            sum -= l * x[j as usize];
        }
        x[k] = sum;
    }
}

/// Columns to the right of the diagonal of each row of a symmetric pattern, rising.
fn beside(n: usize, places: impl Iterator<Item = (usize, usize)>) -> Columns<u32> {
    let mut above: Vec<_> = places.filter(|(i, j)| i < j).collect();
    above.sort_unstable();
    let mut rows = above.into_iter().peekable();
    let mut columns = Columns::with_capacity(n, rows.len());
    for k in 0..n {
        while let Some((_, j)) = rows.next_if(|(i, _)| *i == k) {
            columns.items.push(j as u32);
        }
        columns.close();
    }
    columns
}

/// The same with what elimination fills: a row passes its columns on to the row of the first of them.
fn filled(n: usize, columns: &Columns<u32>) -> Columns<u32> {
    let mut upper = Columns::with_capacity(n, columns.items.len());
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); n];
    for k in 0..n {
        let own = columns.items[columns.range(k)].iter().copied();
        let from = children[k].iter().flat_map(|&c| upper.range(c)).map(|place: usize| upper.items[place]).filter(|j| *j as usize > k);
        let mut row: Vec<u32> = own.chain(from).collect();
        row.sort_unstable();
        row.dedup();
        if let Some(&first) = row.first() {
            children[first as usize].push(k);
        }
        upper.items.append(&mut row);
        upper.close();
    }
    upper
}

/// Place of the entry (i, j), i < j, in a list of rows.
fn place(rows: &Columns<u32>, i: usize, j: usize) -> Option<usize> {
    let range = rows.range(i);
    rows.items[range.clone()].binary_search(&(j as u32)).ok().map(|k| range.start + k)
}

/// Where the products of each row with itself belong.
fn targets(upper: &Columns<u32>) -> Vec<u32> {
    let mut targets = Vec::new();
    for k in 0..upper.count() {
        let row = &upper.items[upper.range(k)];
        for (a, &i) in row.iter().enumerate() {
            // both rise: one walk along row i
            let mut places = upper.range(i as usize);
            for &j in &row[a + 1..] {
                targets.extend(places.find(|&place| upper.items[place] == j).map(|place| place as u32));
            }
        }
    }
    targets
}
