//! The independent variable of a range: the driver's coordinate or time, and the time that belongs to it.

use super::reach::{Look, NeverThere, reached};
use crate::dynamics::Dynamics;
use crate::expression::Dimension;
use crate::geometry::Space;
use crate::mechanism::{Drive, Mechanism};
use crate::numerics::root::root;
use crate::results::six_digits;
use std::convert::Infallible;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Progress s ≥ 0 along the motion (negative backwards), and what it means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Independent variable at s = 0.
    pub from: f64,
    /// +1 if the independent variable grows along the motion.
    pub direction: f64,
    /// Length of the range.
    pub length: f64,
    /// Output of the time program that is followed; none: the variable is time itself.
    driver: Option<usize>,
    /// s per second, if it is constant.
    speed: Option<f64>,
    /// Time at the end of the range.
    end: f64,
}

/// How values of the independent variable are told.
#[derive(Clone, Copy, Debug)]
pub struct Variable<'a> {
    /// Its name.
    pub name: &'a str,
    /// How much of the unit that it is told in is one of SI, and the unit; empty if it is told as it is.
    pub unit: (f64, &'static str),
}

impl<'a> Variable<'a> {
    /// Of a dimension: an angle in degrees, a length in metres, a time in seconds, anything else as it is.
    pub(crate) fn of(name: &'a str, dimension: Dimension) -> Self {
        let unit = match dimension {
            d if d == Dimension::TIME => (1.0, "s"),
            d if d == Dimension::ANGLE || d == Dimension::LENGTH => coordinate_unit(d == Dimension::ANGLE),
            _ => (1.0, ""),
        };
        Self { name, unit }
    }

    /// A place: `O.angle = 80 deg`.
    #[must_use]
    pub fn at(&self, value: f64) -> String {
        format!("{} = {}", self.name, self.told(value))
    }

    /// A value: `80 deg`.
    #[must_use]
    pub fn told(&self, value: f64) -> String {
        in_unit(value, self.unit)
    }
}

/// An angle in degrees or a length in metres.
pub(crate) fn told_coordinate(value: f64, angular: bool) -> String {
    in_unit(value, coordinate_unit(angular))
}

fn coordinate_unit(angular: bool) -> (f64, &'static str) {
    if angular { (180.0 / std::f64::consts::PI, "deg") } else { (1.0, "m") }
}

fn in_unit(value: f64, (size, unit): (f64, &str)) -> String {
    let gap = if unit.is_empty() { "" } else { " " };
    format!("{}{gap}{unit}", six_digits(value * size))
}

impl Clock {
    /// A range of time.
    #[must_use]
    pub fn of_time(length: f64) -> Self {
        let direction = if length < 0.0 { -1.0 } else { 1.0 };
        Self { from: 0.0, direction, length: length.abs(), driver: None, speed: Some(direction), end: length }
    }

    /// A part of the same range, from its begin.
    #[must_use]
    pub(crate) fn part(self, part: f64) -> Self {
        Self { length: part * self.length, end: part * self.end, ..self }
    }

    /// A range of a driver's coordinate, in the direction in which the driver moves at the start (the other one if the range is
    /// negative), `from` being its coordinate at the start.
    ///
    /// # Errors
    /// If the law stands still at its start, or rests or turns back before the range is done.
    pub fn of_driver<G: Space<S = f64>>(
        dynamics: &mut Dynamics<'_, G>,
        modes: &mut [i32],
        drive: &Drive,
        from: f64,
        length: f64,
    ) -> Result<Self, NeverThere> {
        let output = drive.output;
        let mut law = |t: f64| {
            dynamics.follow_time(t, modes);
            let mut formula = DefaultHasher::new();
            modes.hash(&mut formula);
            Look { motion: [0, 1].map(|k| dynamics.work.motions[output + k]), formula: formula.finish() }
        };
        let backwards = if length < 0.0 { -1.0 } else { 1.0 };
        let length = length.abs();
        let [f0, speed] = law(0.0).motion;
        if drive.steady && speed != 0.0 {
            let end = backwards * length / speed.abs();
            let direction = backwards * speed.signum();
            return Ok(Self { from, direction, length, driver: Some(output), speed: Some(backwards * speed.abs()), end });
        }
        let end = reached(&mut law, backwards, length, |x| told_coordinate(x, drive.turns))?;
        let direction = (law(end).motion[0] - f0).signum();
        Ok(Self { from, direction, length, driver: Some(output), speed: None, end })
    }

    /// Time at the end of the range, s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Whether a driver's coordinate is the independent variable.
    #[must_use]
    pub fn is_driver(&self) -> bool {
        self.driver.is_some()
    }

    /// In what the independent variable of a mechanism is told: how much of it a unit of SI is, and its name.
    pub(crate) fn unit<G: Space>(&self, mechanism: &Mechanism<G>) -> (f64, &'static str) {
        if self.is_driver() { coordinate_unit(mechanism.drives.first().is_some_and(|d| d.turns)) } else { (1.0, "s") }
    }

    /// The independent variable at s.
    #[must_use]
    pub fn value(&self, s: f64) -> f64 {
        // a zero of either sign is zero
        self.from + self.direction * s + 0.0
    }

    /// Progress at a value of the independent variable.
    #[must_use]
    pub fn progress(&self, value: f64) -> f64 {
        (value - self.from) * self.direction
    }

    /// Time at progress s.
    pub fn time<G: Space<S = f64>>(&self, dynamics: &mut Dynamics<'_, G>, modes: &mut [i32], s: f64) -> f64 {
        if let Some(speed) = self.speed {
            return s / speed + 0.0;
        }
        let Some(output) = self.driver else { return s };
        if s >= self.length {
            return self.end;
        }
        let mut gone = |t: f64| {
            dynamics.follow_time(t, modes);
            dynamics.work.motions[output]
        };
        let f0 = gone(0.0);
        let mut miss = |t: f64| Ok::<f64, Infallible>((gone(t) - f0) * self.direction - s);
        let (a, b) = if s < 0.0 { (-self.end, 0.0) } else { (0.0, self.end) };
        let (Ok(fa), Ok(fb)) = (miss(a), miss(b));
        match root(miss, a, b, fa, fb, 0.0) {
            Ok(Some(found)) => found.place(),
            Ok(None) => {
                if fa.abs() < fb.abs() {
                    a
                } else {
                    b
                }
            }
        }
    }
}
