//! Whether stability bounds the steps of an explicit scheme (Hairer & Wanner, Solving ODEs II, 2nd ed., section IV.2: h|λ| from
//! two stages at the same time, and how often it must be large).

use crate::System;

/// Length of the interval of stability on the negative real axis.
pub(in crate::schemes) const BORDER: f64 = 6.1;

/// Signals that count as stiffness, and steps in a row without one that end a count.
const SIGNALS: usize = 15;
const CALM: usize = 6;

/// Signals of the past steps.
#[derive(Clone, Debug)]
pub(super) struct Stiffness {
    /// h|λ| of the last step.
    pub(super) product: f64,
    /// 1/size of the coordinates, then of the velocities, then of z.
    unit: Vec<f64>,
    coordinates: usize,
    velocities: usize,
    signals: usize,
    calm: usize,
}

impl Stiffness {
    /// Room for a system.
    pub(super) fn new(system: &dyn System) -> Self {
        let (dims, pattern) = (system.dims(), system.pattern());
        let unit = pattern.size_q.iter().chain(&pattern.size_v).map(|size| size.recip());
        Self {
            product: 0.0,
            unit: unit.chain((0..dims.z).map(|_| 1.0)).collect(),
            coordinates: dims.q,
            velocities: dims.v,
            signals: 0,
            calm: 0,
        }
    }

    /// Begins to count anew.
    pub(super) fn forget(&mut self) {
        (self.product, self.signals, self.calm) = (0.0, 0, 0);
    }

    /// Whether the signals suffice.
    pub(super) fn stiff(&self) -> bool {
        self.signals >= SIGNALS
    }

    /// h|λ| as h|ΔF|/|Δy| from the states y and their rates F of two points at the end of a step.
    ///
    /// Velocities weigh h/6.1 of coordinates: at the border of stability the parts of an oscillation, |Δv| = |λ||Δq|, then
    /// weigh the same, and the quotient is |λ| in every phase.
    pub(super) fn estimate(&mut self, h: f64, [y0, y1]: [&[f64]; 2], [f0, f1]: [&[f64]; 2]) {
        let (mut ways, mut rates) = (0.0, 0.0);
        for (i, ((u, (y0, y1)), (f0, f1))) in self.unit.iter().zip(y0.iter().zip(y1)).zip(f0.iter().zip(f1)).enumerate() {
            let speed = i >= self.coordinates && i < self.coordinates + self.velocities;
            let weight = if speed { u * h / BORDER } else { *u };
            ways += (weight * (y1 - y0)).powi(2);
            rates += (weight * (f1 - f0)).powi(2);
        }
        self.product = if ways > 0.0 { h * (rates / ways).sqrt() } else { 0.0 };
    }

    /// Counts the last estimate.
    pub(super) fn count(&mut self) {
        if self.product > BORDER {
            (self.signals, self.calm) = (self.signals + 1, 0);
        } else {
            self.calm += 1;
            if self.calm >= CALM {
                self.signals = 0;
            }
        }
    }
}
