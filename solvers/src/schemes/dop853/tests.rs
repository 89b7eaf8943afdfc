//! The order conditions (Hairer, Nørsett & Wanner, Solving ODEs I, section II.2): Σ b_i Φ_i(t) = 1/γ(t) for every rooted tree t
//! up to the order.

use super::*;

/// A rooted tree: its order, its density γ, and Φ_i of every stage.
struct Tree {
    order: usize,
    gamma: f64,
    phi: [f64; STAGES],
}

/// A as a matrix; the row of stage 12 is that of the weights.
fn matrix() -> [[f64; STAGES]; STAGES] {
    let rows: [&[(usize, f64)]; 15] = [&A1, &A2, &A3, &A4, &A5, &A6, &A7, &A8, &A9, &A10, &A11, &B, &A13, &A14, &A15];
    let mut a = [[0.0; STAGES]; STAGES];
    for (i, row) in rows.iter().enumerate() {
        row.iter().for_each(|&(j, x)| a[i + 1][j] = x);
    }
    a
}

/// All rooted trees up to order 8: 1, 1, 2, 4, 9, 20, 48, 115.
fn trees() -> Vec<Tree> {
    let a = matrix();
    let mut all = vec![Tree { order: 1, gamma: 1.0, phi: [1.0; STAGES] }];
    for order in 2..=8 {
        let mut new = Vec::new();
        branches(&all, &a, (order, order - 1, 0), 1.0, [1.0; STAGES], &mut new);
        all.extend(new);
    }
    all
}

/// Adds to a root further branches with `left` nodes together, from the tree number `first` on.
fn branches(
    all: &[Tree],
    a: &[[f64; STAGES]; STAGES],
    (order, left, first): (usize, usize, usize),
    gamma: f64,
    phi: [f64; STAGES],
    out: &mut Vec<Tree>,
) {
    if left == 0 {
        out.push(Tree { order, gamma: gamma * order as f64, phi });
        return;
    }
    for (number, branch) in all.iter().enumerate().skip(first).filter(|(_, tree)| tree.order <= left) {
        let mut more = phi;
        for (x, row) in more.iter_mut().zip(a) {
            *x *= row.iter().zip(&branch.phi).map(|(a, p)| a * p).sum::<f64>();
        }
        branches(all, a, (order, left - branch.order, number), gamma * branch.gamma, more, out);
    }
}

/// Σ b_i Φ_i(t).
fn weight(row: &[(usize, f64)], tree: &Tree) -> f64 {
    row.iter().map(|&(i, b)| b * tree.phi[i]).sum()
}

#[test]
fn the_method_is_of_order_8_and_the_errors_of_orders_5_and_3() {
    let trees = trees();
    let count = |order| trees.iter().filter(|tree| tree.order == order).count();
    assert_eq!([1, 2, 3, 4, 5, 6, 7, 8].map(count), [1, 1, 2, 4, 9, 20, 48, 115]);
    for tree in &trees {
        assert!((weight(&B, tree) - tree.gamma.recip()).abs() < 2e-14, "order {}", tree.order);
        if tree.order <= 5 {
            assert!(weight(&E5, tree).abs() < 2e-14, "order {}", tree.order);
        }
        if tree.order <= 3 {
            assert!((weight(&B3, tree) - tree.gamma.recip()).abs() < 2e-14, "order {}", tree.order);
        }
    }
    let fails =
        |row: &[(usize, f64)], order, rest: f64| trees.iter().any(|t| t.order == order && (weight(row, t) - rest / t.gamma).abs() > 1e-4);
    assert!(fails(&E5, 6, 0.0) && fails(&B3, 4, 1.0));
}

#[test]
fn stages_lie_at_their_places() {
    for (row, c) in matrix().iter().zip(C) {
        assert!((row.iter().sum::<f64>() - c).abs() < 1e-14, "{c}");
    }
}

#[test]
fn the_continuous_solution_is_of_order_7() {
    for tree in trees().iter().filter(|tree| tree.order <= 7) {
        let [d4, d5, d6, d7] = [&D4, &D5, &D6, &D7].map(|row| weight(row, tree));
        let end = weight(&B, tree);
        let (first, last) = (tree.phi[0], tree.phi[LAST]);
        let powers = powers(0.0, [end, first - end, 2.0 * end - first - last, d4, d5, d6, d7]);
        for theta in [0.1, 0.3, 0.5, 0.77, 1.0_f64] {
            let value = powers.iter().rev().fold(0.0, |sum, p| sum * theta + p);
            let exact = theta.powi(tree.order as i32) / tree.gamma;
            assert!((value - exact).abs() < 1e-13, "order {}, {theta}: {value} for {exact}", tree.order);
        }
    }
}

#[test]
fn errors_that_overflow_are_not_taken_for_none() {
    assert_eq!(combined(1e-3, 0.0, 0.0), 0.0);
    assert!((combined(2.0, 4.0, 900.0) - 2.0 * 4.0 / 13.0_f64.sqrt()).abs() < 1e-15);
    for squares in [[1e300, f64::INFINITY], [f64::INFINITY, 1.0], [f64::INFINITY; 2]] {
        assert_eq!(combined(1e-300, squares[0], squares[1]), f64::INFINITY);
    }
    assert!(combined(1.0, f64::NAN, 1.0).is_nan() && combined(1.0, 1.0, f64::NAN).is_nan());
}
