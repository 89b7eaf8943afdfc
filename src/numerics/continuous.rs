//! A solution that can be evaluated anywhere, with its breaks.
//!
//! Integrals ([`quadrature`](super::quadrature)), extremes ([`extremum`](super::extremum)) and places where a condition changes
//! ([`root`](super::root)) are taken on the continuous solution, never on the samples of a plot. No mechanics is known here.

/// A vector of columns along one independent variable that can be evaluated anywhere in [from, to].
///
/// The interval is cut into pieces by breaks: places where a mode switches, a table has a kink, a driver begins. `breaks` is
/// the rising list `from, switches …, to`; piece k lies between breaks k and k + 1, and the columns are smooth on it. At a break
/// the two pieces give the two one-sided values.
pub trait Curve {
    /// Why an evaluation can fail.
    type Error;

    /// Number of columns.
    fn columns(&self) -> usize;

    /// Values of all columns at `x` on the piece number `piece`; a value that is not defined there is NaN.
    fn eval(&mut self, x: f64, piece: usize, out: &mut [f64]) -> Result<(), Self::Error>;

    /// [`Curve::eval`], or nearly the same for less: values to the part of their size that the curve is followed to.
    ///
    /// # Errors
    /// As there.
    fn look(&mut self, x: f64, piece: usize, out: &mut [f64]) -> Result<(), Self::Error> {
        self.eval(x, piece, out)
    }

    /// Where a stretch of a piece is best cut in two, between its ends.
    fn middle(&self, from: f64, to: f64, _piece: usize) -> f64 {
        0.5 * (from + to)
    }

    /// On what width a piece is known to be smooth at a place, as the steps of an integrator tell; 0 if nothing is known.
    fn smooth(&self, _at: f64, _piece: usize) -> f64 {
        0.0
    }

    /// A column that is nowhere larger than this is zero but for round-off, of which nothing is followed.
    fn floor(&self, _column: usize) -> f64 {
        0.0
    }

    /// Whether a place is so near to a singular position that what depends on constraints multiplies the errors of the state.
    fn singular(&mut self, _at: f64, _piece: usize) -> bool {
        false
    }
}

#[cfg(test)]
pub(crate) mod closed {
    //! Curves in closed form, for tests.

    use super::Curve;
    use std::convert::Infallible;

    /// A curve given by a function (x, piece, out), which counts its evaluations.
    pub(in super::super) struct Closed<F> {
        pub(in super::super) columns: usize,
        pub(in super::super) function: F,
        pub(in super::super) evaluations: usize,
    }

    impl<F: FnMut(f64, usize, &mut [f64])> Closed<F> {
        pub(in super::super) fn new(columns: usize, function: F) -> Self {
            Self { columns, function, evaluations: 0 }
        }

        /// Places, pieces and values at `n` equal intervals, with both sides of every break.
        pub(in super::super) fn sampled(&mut self, breaks: &[f64], n: usize) -> (Vec<f64>, Vec<usize>, Vec<f64>) {
            let (from, to) = (breaks[0], breaks[breaks.len() - 1]);
            let grid = |k: usize| from + (to - from) * k as f64 / n as f64;
            let (mut places, mut pieces) = (Vec::new(), Vec::new());
            for (piece, ends) in breaks.windows(2).enumerate() {
                let inner = (0..=n).map(grid).filter(|x| *x > ends[0] && *x < ends[1]);
                let before = places.len();
                places.extend(std::iter::once(ends[0]).chain(inner).chain([ends[1]]));
                pieces.resize(pieces.len() + places.len() - before, piece);
            }
            let mut values = vec![0.0; self.columns * places.len()];
            let mut out = vec![0.0; self.columns];
            for (i, (x, piece)) in places.iter().zip(&pieces).enumerate() {
                (self.function)(*x, *piece, &mut out);
                out.iter().enumerate().for_each(|(c, y)| values[c * places.len() + i] = *y);
            }
            (places, pieces, values)
        }
    }

    impl<F: FnMut(f64, usize, &mut [f64])> Curve for Closed<F> {
        type Error = Infallible;

        fn columns(&self) -> usize {
            self.columns
        }

        fn eval(&mut self, x: f64, piece: usize, out: &mut [f64]) -> Result<(), Infallible> {
            self.evaluations += 1;
            (self.function)(x, piece, out);
            Ok(())
        }
    }
}
