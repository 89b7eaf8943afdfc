//! Roots that depend on time alone, found ahead by bounds.
//!
//! An interval of time in which the bounds of a root are positive is passed whole, however fast the root oscillates; any other is
//! halved, from its begin, until it is as narrow as the rounding of time. So the first crossing is proven to be the first.

use super::root::Root;
use crate::expression::{Part, Wanted};
use crate::geometry::Space;
use crate::mechanism::{Leaf, Mechanism, StagedProgram};
use crate::scalar::Interval;
use crate::studies::common::observe::Observer;
use grashof_solvers::{Ahead, At};

/// Evaluations in one search for a crossing.
const MOST: usize = 100_000;

/// A root below this part of what it is the difference of touches zero, and does not cross it.
const TOUCH: f64 = 1e-13;

/// How much a search may grow behind an interval that was passed.
const WIDER: f64 = 2.0;

/// A root of time alone.
#[derive(Clone, Debug)]
pub(super) struct Timed {
    root: usize,
    part: Part,
    /// Mode whose sign the value is taken with: the side of an event.
    side: Option<usize>,
}

/// The roots of a mechanism, its columns and events (outputs of the columns' program) that depend on time alone; `sides` is the
/// mode of the first event.
pub(super) fn timed<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    observer: &Observer<G>,
    roots: &[Root],
    outputs: &[usize],
    sides: usize,
) -> Vec<Timed> {
    let of_program = |p: &StagedProgram| -> Vec<u32> {
        p.fills.iter().filter(|(_, leaf)| *leaf == Leaf::Time).map(|(input, _)| *input as u32).collect()
    };
    let programs = mechanism.programs();
    let times = observer.times();
    let part = |root: &Root| match *root {
        Root::Force { program, k } => programs[program].program.part(Wanted::Switch(k), &of_program(programs[program])),
        Root::Column { k } => observer.program().part(Wanted::Switch(k), &times),
        Root::Event(event) => observer.program().part(Wanted::Output(outputs[event]), &times),
        _ => None,
    };
    let side = |root: &Root| if let Root::Event(event) = *root { Some(sides + event) } else { None };
    let all = roots.iter().enumerate();
    all.filter_map(|(i, root)| Some(Timed { root: i, part: part(root)?, side: side(root) })).collect()
}

impl Timed {
    /// Number of the root.
    pub(super) fn root(&self) -> usize {
        self.root
    }

    fn value(&mut self, t: f64, modes: &[i32]) -> f64 {
        let sign = self.side.map_or(1.0, |side| f64::from(modes[side]));
        sign * self.part.value(t, modes)
    }

    fn bounds(&mut self, from: f64, to: f64, modes: &[i32]) -> (Interval, f64) {
        let (bounds, size) = self.part.bounds(Interval::between(from, to), modes);
        (if self.side.is_some_and(|side| modes[side] < 0) { -bounds } else { bounds }, size)
    }

    /// How long it takes from a zero on until it is known not to be negative, at most to a time; none if it becomes negative.
    fn moment(&mut self, zero: f64, to: f64, unit: f64, modes: &[i32]) -> Option<f64> {
        let mut moment = 4.0 * unit;
        loop {
            let (_, size) = self.bounds(zero, zero + moment, modes);
            // of what has a pole there, its sign counts
            let size = if size.is_finite() { size } else { 0.0 };
            let value = self.value(zero + moment, modes);
            if value < -TOUCH * size {
                return None;
            }
            if value > TOUCH * size || zero + moment >= to {
                return Some(moment);
            }
            moment *= 4.0;
        }
    }

    /// The first crossing in [from, to].
    pub(super) fn ahead(&mut self, from: f64, to: f64, modes: &[i32]) -> Ahead {
        let unit = 2.0 * f64::EPSILON * from.abs().max(to.abs());
        let mut scale: f64 = 0.0;
        let mut a = from;
        if self.value(a, modes) <= 0.0 {
            // just crossed, or about to be
            match self.moment(a, to, unit, modes) {
                None => return Ahead::Crossing(from, self.root),
                Some(moment) => a = (a + moment).min(to),
            }
        }
        let mut width = to - a;
        for _ in 0..MOST {
            if a >= to {
                // zero at the very end: a step may well end there by itself
                let crosses = to > from && self.value(to, modes) <= 0.0 && self.moment(to, 2.0 * to - from, unit, modes).is_none();
                return if crosses { Ahead::Crossing(to, self.root) } else { Ahead::Clear };
            }
            let b = if a + 1.5 * width >= to { to } else { a + width };
            let (bounds, size) = self.bounds(a, b, modes);
            if size.is_finite() {
                scale = scale.max(size);
            }
            let narrow = b - a <= unit;
            if bounds.is_none() || bounds.low > 0.0 {
                (a, width) = (b, WIDER * (b - a));
                continue;
            }
            if narrow || bounds.low >= -TOUCH * scale {
                if self.value(b, modes) < 0.0 && narrow {
                    return Ahead::Crossing(b, self.root);
                }
                if narrow || self.value(b, modes) >= 0.0 {
                    (a, width) = (b, WIDER * (b - a));
                    continue;
                }
            }
            width = 0.5 * (b - a);
        }
        Ahead::Unknown(a, self.root)
    }
}

/// The first of the roots of time alone that leaves its positive side.
pub(super) fn first(all: &mut [Timed], at: At<'_>, to: f64, roots: &[usize]) -> Ahead {
    let mut first = Ahead::Clear;
    let mut end = to;
    for timed in all.iter_mut().filter(|timed| roots.contains(&timed.root)) {
        match timed.ahead(at.t, end, at.modes) {
            Ahead::Clear => {}
            found @ (Ahead::Crossing(t, _) | Ahead::Unknown(t, _)) => {
                if t < end || first == Ahead::Clear {
                    (end, first) = (t, found);
                }
            }
        }
    }
    first
}
