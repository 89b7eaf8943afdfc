//! The schemes by name, with their parameters.

/// The schemes by name, with their parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Explicit or implicit, as the motion asks.
    Auto,
    /// Newmark 1959: `displacement` is the textbook's β, `velocity` its γ.
    Newmark {
        /// Weight of the new acceleration in the displacement.
        displacement: f64,
        /// Weight of the new acceleration in the velocity.
        velocity: f64,
    },
    /// Hilber, Hughes & Taylor 1977, α in [−1/3, 0].
    Hht {
        /// α.
        alpha: f64,
    },
    /// Chung & Hulbert 1993 in the form of Arnold & Brüls 2007.
    GeneralizedAlpha {
        /// Spectral radius at infinity, 0 to 1.
        rho: f64,
    },
    /// Backward differences, variable order, or the given one with given steps.
    Bdf {
        /// 1 to 5; none: chosen by the error.
        order: Option<usize>,
    },
    /// Radau IIA with three stages (Hairer & Wanner, Solving ODEs II, section IV.8).
    Radau5,
    /// Dormand & Prince's method of order 8 (Hairer, Nørsett & Wanner, Solving ODEs I, section II.5).
    Dop853,
    /// The classical Runge-Kutta method.
    Rk4,
    /// Central differences, implicit in the forces that depend on velocity.
    CentralDifference,
    /// IDA of SUNDIALS, where this build has it: see [`available`](crate::schemes::available).
    Ida,
}
