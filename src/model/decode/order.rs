//! An order in which things that need one another can be found.

/// Indices in an order in which every need comes first, and the cycles that were met: each member needs the next, the last
/// one the first. Iterative, because a file may hold a chain of any length.
pub(crate) fn order(needs: &[Vec<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let (mut order, mut cycles) = (Vec::with_capacity(needs.len()), Vec::new());
    let (mut visited, mut on_path) = (vec![false; needs.len()], vec![false; needs.len()]);
    let mut path: Vec<(usize, usize)> = Vec::new();
    for root in 0..needs.len() {
        if visited[root] {
            continue;
        }
        visited[root] = true;
        on_path[root] = true;
        path.push((root, 0));
        while let Some((item, done)) = path.last_mut() {
            let item = *item;
            let Some(need) = needs[item].get(*done).copied() else {
                order.push(item);
                on_path[item] = false;
                path.pop();
                continue;
            };
            *done += 1;
            if on_path[need] {
                cycles.push(path.iter().map(|(i, _)| *i).skip_while(|i| *i != need).collect());
            } else if !visited[need] {
                visited[need] = true;
                on_path[need] = true;
                path.push((need, 0));
            }
        }
    }
    (order, cycles)
}

/// `a` needs `b`, which needs `a`.
pub(crate) fn in_words(cycle: &[usize], name: impl Fn(usize) -> String) -> String {
    let mut names: Vec<String> = cycle.iter().take(8).map(|i| format!("`{}`", name(*i))).collect();
    if cycle.len() > 8 {
        names.push("...".to_owned());
    }
    names.extend(cycle.first().map(|i| format!("`{}`", name(*i))));
    names.join(", which needs ").replacen(", which needs ", " needs ", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needs_come_first_and_cycles_are_told() {
        let (found, cycles) = order(&[vec![1, 2], vec![2], vec![]]);
        assert_eq!((found, cycles.len()), (vec![2, 1, 0], 0));
        let (_, cycles) = order(&[vec![1], vec![2], vec![0]]);
        assert_eq!(cycles, [vec![0, 1, 2]]);
        assert_eq!(in_words(&cycles[0], |i| format!("p{i}")), "`p0` needs `p1`, which needs `p2`, which needs `p0`");
        let chain: Vec<Vec<usize>> = (0..100_000).map(|i| if i < 99_999 { vec![i + 1] } else { vec![] }).collect();
        assert_eq!(order(&chain).0.len(), 100_000);
    }
}
