//! Forces between bounds that keep rates of contacts at zero, or stand at a bound: the linear complementarity problem with boxes.
//!
//! Find f and w = A f + b with, for each i, one of
//!
//! ```text
//! low < f < high and w = 0,      f = low and w ≥ 0,      f = high and w ≤ 0.
//! ```
//!
//! A is symmetric and positive semidefinite. Whatever does not fit changes its place at once as long as fewer do not fit than before,
//! else the first that does not fit changes alone, which ends after finitely many changes (Júdice and Pires, Computers & Operations
//! Research 21 (1994) 587-596; Murty, Opsearch 11 (1974) 204-213).

use nalgebra::{DMatrix, DVector};

/// Where a force stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// At its lower bound.
    Low,
    /// Between its bounds.
    Between,
    /// At its upper bound.
    High,
    /// Zero, since others hold the same and do not need it.
    Idle,
}

/// One force: its bounds, its place to begin with, and by how much a force and an acceleration may miss.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounded {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) place: Place,
    pub(crate) force: f64,
    pub(crate) acceleration: f64,
}

/// Times that everything may change at once without fewer misfits.
const PATIENCE: usize = 10;

/// Changes in all: many more than are ever needed, few enough to end.
const MOST_CHANGES: usize = 500;

/// Added to the diagonal of A in parts of it, so that forces of which only the sum is determined share it.
const SHARED: f64 = 1e-7;

/// The forces and their places; none where no places fit.
///
/// Dependent contacts may go round in a circle; a diagonal that is a little larger makes the solution unique.
pub(crate) fn solve(a: &DMatrix<f64>, b: &DVector<f64>, all: &[Bounded]) -> Option<(DVector<f64>, Vec<Place>)> {
    search(a, b, all).or_else(|| {
        let mut unique = a.clone();
        (0..all.len()).for_each(|i| unique[(i, i)] *= 1.0 + SHARED);
        search(&unique, b, all)
    })
}

fn search(a: &DMatrix<f64>, b: &DVector<f64>, all: &[Bounded]) -> Option<(DVector<f64>, Vec<Place>)> {
    let mut places: Vec<Place> = all.iter().map(|x| x.place).collect();
    let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
    for _ in 0..MOST_CHANGES {
        let f = forces(a, b, all, &places)?;
        let w = a * &f + b;
        let changes: Vec<(usize, Place)> = (0..all.len()).filter_map(|i| Some((i, elsewhere(&all[i], places[i], f[i], w[i])?))).collect();
        if changes.is_empty() {
            return Some((f, places));
        }
        if changes.len() < fewest {
            (fewest, patience) = (changes.len(), PATIENCE);
        } else {
            patience = patience.saturating_sub(1);
        }
        let now = if patience > 0 { &changes[..] } else { &changes[..1] };
        now.iter().for_each(|&(i, place)| places[i] = place);
    }
    None
}

/// Where a force goes that does not fit its place.
fn elsewhere(x: &Bounded, place: Place, f: f64, w: f64) -> Option<Place> {
    match place {
        Place::Between if f < x.low - x.force => Some(Place::Low),
        Place::Between if f > x.high + x.force => Some(Place::High),
        Place::Low if w < -x.acceleration => Some(Place::Between),
        Place::High if w > x.acceleration => Some(Place::Between),
        _ => None,
    }
}

/// Forces for given places: those between solve w = 0.
fn forces(a: &DMatrix<f64>, b: &DVector<f64>, all: &[Bounded], places: &[Place]) -> Option<DVector<f64>> {
    let mut f = DVector::from_fn(all.len(), |i, _| match places[i] {
        Place::Low => all[i].low,
        Place::High => all[i].high,
        Place::Between | Place::Idle => 0.0,
    });
    let free: Vec<usize> = (0..all.len()).filter(|i| places[*i] == Place::Between).collect();
    if free.is_empty() {
        return Some(f);
    }
    let right = a * &f + b;
    let share = if split(a, &free).1.is_some() { SHARED } else { 0.0 };
    let block = DMatrix::from_fn(free.len(), free.len(), |i, j| a[(free[i], free[j])] * if i == j { 1.0 + share } else { 1.0 });
    let solved = block.lu().solve(&DVector::from_fn(free.len(), |i, _| -right[free[i]]))?;
    free.iter().zip(solved.iter()).for_each(|(i, x)| f[*i] = *x);
    Some(f)
}

/// Moves forces that depend on each other, with the same w, to zero or, where they are needed, to a bound, until those between are
/// independent, and solves for these without what [`SHARED`] has left. The first of `order` stay between.
pub(crate) fn basic(a: &DMatrix<f64>, b: &DVector<f64>, all: &[Bounded], f: &mut DVector<f64>, places: &mut [Place], order: &[usize]) {
    make_independent(a, all, f, places, order);
    while let Some(exact) = forces(a, b, all, places) {
        *f = exact;
        let beyond = (0..all.len()).find_map(|i| Some((i, elsewhere(&all[i], places[i], f[i], 0.0)?)));
        let Some((i, place)) = beyond else { break };
        places[i] = place;
    }
    return_to_bounds(a, b, all, f, places);
}

/// Moves forces back to the bound at which they began where that does as well: what [`SHARED`] misses may have taken one from there that has
/// just been let go, and its force is nothing but round-off.
fn return_to_bounds(a: &DMatrix<f64>, b: &DVector<f64>, all: &[Bounded], f: &mut DVector<f64>, places: &mut [Place]) {
    for (i, x) in all.iter().enumerate() {
        let bound = if x.place == Place::High { x.high } else { x.low };
        if places[i] != Place::Between || !matches!(x.place, Place::Low | Place::High) || (f[i] - bound).abs() > x.force {
            continue;
        }
        let mut back = places.to_vec();
        back[i] = x.place;
        let Some(forces) = forces(a, b, all, &back) else { continue };
        let w = a * &forces + b;
        if (0..all.len()).all(|k| elsewhere(&all[k], back[k], forces[k], w[k]).is_none()) {
            *f = forces;
            places.copy_from_slice(&back);
        }
    }
}

/// Forces at a bound or idle that those between could take over or give up: what they share is not determined.
pub(crate) fn shared(a: &DMatrix<f64>, places: &[Place]) -> Vec<usize> {
    let free: Vec<usize> = (0..places.len()).filter(|i| places[*i] == Place::Between).collect();
    let with = |i: usize| free.iter().copied().chain([i]).collect::<Vec<usize>>();
    (0..places.len())
        .filter(|&i| places[i] != Place::Between && split(a, &with(i)).1.is_some_and(|(dependent, _)| dependent == i))
        .collect()
}

fn make_independent(a: &DMatrix<f64>, all: &[Bounded], f: &mut DVector<f64>, places: &mut [Place], order: &[usize]) {
    loop {
        let free: Vec<usize> = order.iter().copied().filter(|i| places[*i] == Place::Between).collect();
        let (kept, Some((dependent, by))) = split(a, &free) else { return };
        // A n = 0
        let way: Vec<(usize, f64)> = kept.iter().copied().zip(by.iter().map(|x| -x)).chain([(dependent, 1.0)]).collect();
        let without = |(i, n): &(usize, f64)| f[*i] - f[dependent] * n;
        if all[dependent].low < 0.0 && way.iter().all(|x| all[x.0].low < without(x) && without(x) < all[x.0].high) {
            let idle = f[dependent];
            way.iter().for_each(|(k, n)| f[*k] -= idle * n);
            places[dependent] = Place::Idle;
            continue;
        }
        let end = |sense: f64| {
            let reaches = way.iter().filter(|(_, n)| n.abs() > NOTHING).map(|&(i, n)| {
                let place = if sense * n > 0.0 { Place::High } else { Place::Low };
                let bound = if place == Place::High { all[i].high } else { all[i].low };
                ((bound - f[i]) / n, i, place)
            });
            reaches.min_by(|x, y| x.0.abs().total_cmp(&y.0.abs()))
        };
        let nearest = [end(1.0), end(-1.0)].into_iter().flatten().min_by(|x, y| x.0.abs().total_cmp(&y.0.abs()));
        let Some((length, i, place)) = nearest.filter(|(length, ..)| length.is_finite()) else { return };
        way.iter().for_each(|(k, n)| f[*k] += length * n);
        places[i] = place;
    }
}

/// Part of a unit way that is none.
const NOTHING: f64 = 1e-9;

/// Those of `wanted` (in this order) whose columns of A are independent, up to the first one that is not, with what it is the sum of.
fn split(a: &DMatrix<f64>, wanted: &[usize]) -> (Vec<usize>, Option<(usize, DVector<f64>)>) {
    /// Part of a diagonal entry of A that is left of a dependent one.
    const DEPENDENT: f64 = 1e-9;
    let mut kept: Vec<usize> = Vec::new();
    for &i in wanted {
        let block = DMatrix::from_fn(kept.len(), kept.len(), |r, c| a[(kept[r], kept[c])]);
        let side = DVector::from_fn(kept.len(), |r, _| a[(kept[r], i)]);
        let none = DVector::zeros(kept.len());
        let by = if kept.is_empty() { none } else { block.lu().solve(&side).unwrap_or(none) };
        if a[(i, i)] - by.dot(&side) <= DEPENDENT * a[(i, i)] {
            return (kept, Some((i, by)));
        }
        kept.push(i);
    }
    (kept, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounded(low: f64, high: f64) -> Bounded {
        Bounded { low, high, place: Place::Between, force: 1e-12, acceleration: 1e-12 }
    }

    #[test]
    fn random_problems_obey_their_laws() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        for case in 0..2000 {
            let n = 1 + case % 9;
            let root = DMatrix::from_fn(n, n, |_, _| random());
            let a = &root * root.transpose() + DMatrix::identity(n, n) * 1e-3;
            let b = DVector::from_fn(n, |_, _| 3.0 * random());
            let all: Vec<Bounded> = (0..n).map(|i| if i % 4 == 3 { bounded(0.0, f64::INFINITY) } else { bounded(-0.7, 0.7) }).collect();
            let (f, _) = solve(&a, &b, &all).unwrap_or_else(|| panic!("case {case}"));
            let w = &a * &f + &b;
            for i in 0..n {
                let (low, high) = (f[i] <= all[i].low + 1e-9, f[i] >= all[i].high - 1e-9);
                assert!(f[i] > all[i].low - 1e-9 && f[i] < all[i].high + 1e-9, "case {case}: {f}");
                assert!(w[i].abs() < 1e-8 || low && w[i] > 0.0 || high && w[i] < 0.0, "case {case}: {w}");
            }
        }
    }

    #[test]
    fn two_brakes_on_one_shaft_share_and_one_of_them_is_enough() {
        let a = DMatrix::from_element(2, 2, 1.0);
        let all = [bounded(-2.0, 2.0); 2];
        let (mut f, mut places) = solve(&a, &DVector::from_element(2, -3.0), &all).unwrap();
        assert!((f[0] - 1.5).abs() < 1e-3 && (f[1] - 1.5).abs() < 1e-3 && places == [Place::Between; 2]);
        // the first of the order is held by what the other leaves at its bound
        basic(&a, &DVector::from_element(2, -3.0), &all, &mut f, &mut places, &[1, 0]);
        assert!((f[0] + f[1] - 3.0).abs() < 1e-14 && places.contains(&Place::High) && places.contains(&Place::Between));
        assert_eq!(shared(&a, &places).len(), 1);
        let (mut f, mut places) = solve(&a, &DVector::from_element(2, -1.0), &all).unwrap();
        basic(&a, &DVector::from_element(2, -1.0), &all, &mut f, &mut places, &[1, 0]);
        assert_eq!((f.as_slice(), &places[..], shared(&a, &places)), (&[0.0, 1.0][..], &[Place::Idle, Place::Between][..], vec![0]));
        // one that slides on is not held by the other
        assert!(shared(&DMatrix::identity(2, 2), &places).is_empty());
    }

    #[test]
    fn what_is_let_go_is_not_held_again_by_what_others_share() {
        // a stop and friction on one hinge, and a stop on another one, coupled to it, that is in balance without a force
        let a = DMatrix::from_row_slice(3, 3, &[2.0, 2.0, 1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 3.0]);
        let b = -(&a * DVector::from_vec(vec![0.0, 9.0, 0.0]));
        let stop = |place| Bounded { place, ..bounded(0.0, f64::INFINITY) };
        let all = [bounded(-1.0, 1.0), stop(Place::Between), stop(Place::Low)];
        let (mut f, mut places) = solve(&a, &b, &all).unwrap();
        basic(&a, &b, &all, &mut f, &mut places, &[1, 2, 0]);
        assert_eq!(places[1..], [Place::Between, Place::Low], "{f}");
        // one that presses stays
        let b = -(&a * DVector::from_vec(vec![0.0, 9.0, 1e-6]));
        let (mut f, mut places) = solve(&a, &b, &all).unwrap();
        basic(&a, &b, &all, &mut f, &mut places, &[1, 2, 0]);
        assert_eq!(places[1..], [Place::Between; 2], "{f}");
    }

    #[test]
    fn dependent_forces_move_to_bounds_without_moving_anything_else() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        for case in 0..500 {
            let (n, rank) = (2 + case % 6, 1 + case % 2);
            let root = DMatrix::from_fn(n, rank, |_, _| random());
            let a = &root * root.transpose();
            let all: Vec<Bounded> = (0..n).map(|i| if i % 4 == 3 { bounded(0.0, f64::INFINITY) } else { bounded(-0.7, 0.7) }).collect();
            let inside = DVector::from_fn(n, |i, _| if i % 4 == 3 { 0.3 } else { 0.5 * random() });
            let b = -(&a * &inside);
            let (mut f, mut places) = (inside, vec![Place::Between; n]);
            let order: Vec<usize> = (0..n).rev().collect();
            basic(&a, &b, &all, &mut f, &mut places, &order);
            assert!((&a * &f + &b).amax() < 1e-9, "case {case}");
            assert!(places.iter().filter(|p| **p == Place::Between).count() <= rank, "case {case}: {places:?}");
            for (i, x) in all.iter().enumerate() {
                let at = match places[i] {
                    Place::Low => f[i] - x.low,
                    Place::High => f[i] - x.high,
                    Place::Idle => f[i],
                    Place::Between => 0.0,
                };
                assert!(at.abs() < 1e-9 && f[i] > x.low - 1e-9 && f[i] < x.high + 1e-9, "case {case}: {f} {places:?}");
            }
        }
    }
}
