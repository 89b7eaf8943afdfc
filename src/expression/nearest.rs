//! The known word that was probably meant.

/// A generated file may hold tens of thousands of names and as many faults.
pub const MOST_CANDIDATES: usize = 1000;

/// The candidate nearest to `word`, if it is near enough to be a slip of the pen.
#[must_use]
pub fn nearest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    // A name of a megabyte is no slip of the pen, and the distance costs the product of the lengths.
    if word.len() > 64 {
        return None;
    }
    let length = word.chars().count();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates.into_iter().take(MOST_CANDIDATES) {
        let other = candidate.chars().count();
        let allowed = (length.max(other) + 1) / 3;
        if candidate.len() > 64 || length.abs_diff(other) > allowed.max(1) {
            continue;
        }
        let d = if candidate.eq_ignore_ascii_case(word) { 0 } else { distance(word, candidate) };
        // a one-letter name is near to everything
        if d <= allowed.max(1) && (d == 0 || length > 1) && best.is_none_or(|(least, _)| d < least) {
            best = Some((d, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Levenshtein distance with transpositions of neighbours (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![vec![0_usize; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    rows[0] = (0..=b.len()).collect();
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let change = usize::from(a[i - 1] != b[j - 1]);
            let mut d = (rows[i - 1][j] + 1).min(rows[i][j - 1] + 1).min(rows[i - 1][j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                d = d.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = d;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found() {
        assert_eq!(nearest("revolut", ["revolute", "slider"]), Some("revolute"));
        assert_eq!(nearest("crnak", ["crank", "rocker"]), Some("crank"));
        assert_eq!(nearest("tetha", ["time", "theta"]), Some("theta"));
        assert_eq!(nearest("CRANK", ["crank"]), Some("crank"));
        assert_eq!(nearest("x", ["y", "z"]), None);
        assert_eq!(nearest("pivot", ["crank", "rocker"]), None);
    }
}
