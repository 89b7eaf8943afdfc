//! What samples tell of the curve between them: where it could be highest, and by how much it could be higher.

use super::samples::{Samples, bend};

/// Samples within this part of the largest magnitude are level.
const LEVEL: f64 = 1e-13;

/// So many level samples in a row are a dwell.
const DWELL: usize = 5;

/// A place that could be the extreme; `y` is the value times the sign.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    pub(crate) y: f64,
    pub(crate) at: f64,
    pub(crate) piece: usize,
}

/// Largest magnitude of the values that are defined.
pub(crate) fn magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, y| f64::max(m, y.abs()))
}

/// Local maxima of the samples with an upper bound of what the curve can reach there; the ends of pieces and the beginnings of
/// dwells at the top go to `found` as they are. `best` is the greatest of sign · values.
pub(crate) fn peaks(samples: Samples<'_>, values: &[f64], sign: f64, best: f64, found: &mut Vec<Candidate>) -> Vec<(usize, f64)> {
    let top = best - LEVEL * magnitude(values);
    let mut peaks = Vec::new();
    for run in samples.runs() {
        let (x, y) = (&samples.places[run.clone()], &values[run.clone()]);
        let piece = samples.pieces[run.start];
        let itself = |k: usize| Candidate { y: sign * y[k], at: x[k], piece };
        found.extend([0, y.len() - 1].into_iter().filter(|k| !y[*k].is_nan()).map(itself));
        let mut k = 0;
        while k < y.len() {
            let level = y[k..].iter().take_while(|y| sign * **y >= top).count();
            if level >= DWELL {
                found.push(itself(k));
                k += level;
                continue;
            }
            // samples of the same value count once, by the first; an undefined neighbour is lower
            let end = k + level.max(1);
            for i in k..end {
                let rises = i == 0 || y[i - 1].is_nan() || sign * y[i - 1] < sign * y[i];
                let falls = i + 1 == y.len() || y[i + 1].is_nan() || sign * y[i + 1] <= sign * y[i];
                if rises && falls && !y[i].is_nan() {
                    peaks.push((run.start + i, sign * y[i] + 0.5 * bend(x, y, i)));
                }
            }
            k = end;
        }
    }
    peaks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hills_are_local_maxima_and_dwells_are_not() {
        let y = [0.0, 1.0, 0.5, 0.5, 0.7, 0.7, 0.2, 2.0, 2.0, 2.0, 2.0, 2.0, 0.0];
        let x: Vec<f64> = (0..y.len()).map(|k| k as f64).collect();
        let samples = Samples { places: &x, pieces: &[0; 13], values: &y, between: None };
        let mut found = Vec::new();
        let peaks: Vec<usize> = peaks(samples, &y, 1.0, 2.0, &mut found).iter().map(|h| h.0).collect();
        assert_eq!(peaks, [1, 4]);
        // both ends and the beginning of the dwell
        assert_eq!(found.iter().map(|c| c.at).collect::<Vec<_>>(), [0.0, 12.0, 7.0]);
    }
}
