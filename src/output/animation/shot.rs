//! When the pictures of a motion are taken.

use crate::output::units::pretty;
use crate::results::{Results, Scene};

/// Seconds that a motion without time takes.
const WHOLE: f64 = 4.0;
/// Pictures at most.
const MOST: f64 = 20_000.0;

/// How fast a motion is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// As a multiple of the speed that it has; a motion without time takes 4 s at speed 1.
    Speed(f64),
    /// All of it in so many seconds.
    Duration(f64),
}

/// What is asked of a shot.
#[derive(Clone, Copy, Debug)]
pub struct ShotOptions {
    /// Pictures a second.
    pub rate: f64,
    /// How fast.
    pub pace: Pace,
    /// Whether it begins again at its end.
    pub repeats: bool,
}

/// Even steps of time, and where the motion is at each of them.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The independent variable in each picture. In a motion that returns and repeats the end is left out: it is the first again.
    pub at: Vec<f64>,
    /// What each picture is told to be of: the time of the motion, or where it has none its independent variable; empty of modes.
    pub readings: Vec<String>,
    /// Pictures a second.
    pub rate: f64,
    /// How long all of it is shown, s: whole pictures.
    pub seconds: f64,
    /// How long it takes at the speed that is asked for, s.
    pub exact: f64,
    /// Whether it begins again at its end.
    pub repeats: bool,
    /// Even steps from its beginning to its end.
    pub(super) steps: usize,
    clock: Clock,
    scale: Option<Scale>,
}

impl Shot {
    /// The pictures of a scene of a study.
    ///
    /// # Errors
    /// How many pictures it would take, if these are too many, or that it has none.
    pub fn of(results: &Results, scene: &Scene, asked: &ShotOptions) -> Result<Self, String> {
        let (Some(low), Some(high)) = (scene.frames.at.first(), scene.frames.at.last()) else { return Err("there is no motion".into()) };
        let clock = Clock::of(results, *low, *high);
        let seconds = match asked.pace {
            Pace::Speed(speed) => clock.span() / speed,
            Pace::Duration(seconds) => seconds,
        };
        let steps = (seconds * asked.rate).round().max(1.0);
        if steps.is_nan() || steps > MOST {
            return Err(format!("the motion takes {seconds:.4} s as it is shown, which are {steps} pictures and more than {MOST}"));
        }
        let steps = steps as usize;
        let count = if scene.frames.closed && asked.repeats { steps } else { steps + 1 };
        let parts: Vec<f64> = (0..count).map(|k| k as f64 / steps as f64).collect();
        let scale = Scale::of(results, &clock);
        let readings = scale.iter().flat_map(|scale| parts.iter().map(|part| scale.reading(&clock, *part))).collect();
        let at = parts.iter().map(|part| clock.place(*part)).collect();
        let (rate, seconds, exact) = (asked.rate, steps as f64 / asked.rate, seconds);
        Ok(Self { at, readings, rate, seconds, exact, repeats: asked.repeats, steps, clock, scale })
    }

    /// Whether its time is that of the motion; else all of it is gone through evenly.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        self.clock.real
    }

    /// Keys for whoever interpolates between them: the even steps, and as many between two of these as keep every way from key to key below
    /// `most`. Of each the part of the whole, 0 to 1, and the independent variable there; `way` measures from one value of that to another.
    pub(crate) fn keys(&self, most: f64, way: impl Fn(f64, f64) -> f64) -> Vec<(f64, f64)> {
        let part = |k: usize| k as f64 / self.steps as f64;
        let mut out = vec![(0.0, self.clock.place(0.0))];
        for k in 0..self.steps {
            let [from, to] = [part(k), part(k + 1)];
            let pieces = (way(self.clock.place(from), self.clock.place(to)) / most).ceil().max(1.0);
            let all = (1..=pieces as usize).map(|j| if j as f64 == pieces { to } else { from + j as f64 / pieces * (to - from) });
            out.extend(all.map(|part| (part, self.clock.place(part))));
        }
        out
    }

    /// What so many even steps are told to be of; shape steps + 1, or none.
    pub(super) fn readings(&self, steps: usize) -> Vec<String> {
        let at = |scale| (0..=steps).map(move |k| Scale::reading(scale, &self.clock, k as f64 / steps as f64));
        self.scale.iter().flat_map(at).collect()
    }

    /// The independent variable at so many even steps, from the beginning to the end; shape steps + 1.
    pub(super) fn places(&self, steps: usize) -> Vec<f64> {
        (0..=steps).map(|k| self.clock.place(k as f64 / steps as f64)).collect()
    }
}

/// Time over the independent variable, both as nodes in the order in which they are gone through.
#[derive(Clone, Debug)]
struct Clock {
    at: Vec<f64>,
    time: Vec<f64>,
    /// Whether the time is that of the motion.
    real: bool,
}

impl Clock {
    /// The clock of a motion over a range of its independent variable.
    fn of(results: &Results, low: f64, high: f64) -> Self {
        let independent = &results.independent;
        let known = if results.kind == "modes" {
            None
        } else if independent.unit == "s" {
            Some((vec![low, high], vec![low, high]))
        } else {
            let time = results.table.column("time").filter(|column| column.unit == "s");
            time.and_then(|time| nodes(&independent.values, &time.values))
        };
        if let Some((at, time)) = known {
            return Self { at, time, real: true };
        }
        let falls = results.kind != "modes" && independent.values.last() < independent.values.first();
        Self { at: if falls { vec![high, low] } else { vec![low, high] }, time: vec![0.0, WHOLE], real: false }
    }

    /// How long it takes, s.
    fn span(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// The time at a part of the whole, 0 to 1.
    fn time(&self, part: f64) -> f64 {
        self.time[0] + part * self.span()
    }

    /// The independent variable there.
    fn place(&self, part: f64) -> f64 {
        let t = self.time(part);
        let k = self.time.partition_point(|node| *node <= t).clamp(1, self.time.len() - 1);
        let s = (t - self.time[k - 1]) / (self.time[k] - self.time[k - 1]);
        self.at[k - 1] + s.clamp(0.0, 1.0) * (self.at[k] - self.at[k - 1])
    }
}

/// How the place in a motion is told.
#[derive(Clone, Debug)]
struct Scale {
    /// The independent variable, `crank.angle = `; nothing before a time.
    head: String,
    unit: String,
    /// Its unit in SI.
    size: f64,
    /// Digits behind the point: those that the largest value needs.
    digits: usize,
}

impl Scale {
    /// That of the time of a motion, else of its independent variable; none of modes.
    fn of(results: &Results, clock: &Clock) -> Option<Self> {
        let independent = &results.independent;
        let (head, (unit, size)) = match clock.real {
            true => (String::new(), ("s", 1.0)),
            false if results.kind == "modes" || independent.name.is_empty() => return None,
            // as in figures
            false if independent.shown_in.is_none() && independent.unit == "rad" => {
                (format!("{} = ", independent.name), ("deg", 1f64.to_radians()))
            }
            false => (format!("{} = ", independent.name), independent.shown()),
        };
        let ends = if clock.real { &clock.time } else { &clock.at };
        let largest = ends.iter().fold(0.0, |most, x| f64::max(most, (x / size).abs()));
        let digits = (2.0 - largest.max(1e-9).log10().floor()).clamp(0.0, 9.0) as usize;
        Some(Self { head, unit: pretty(unit), size, digits })
    }

    fn reading(&self, clock: &Clock, part: f64) -> String {
        let value = if clock.real { clock.time(part) } else { clock.place(part) };
        format!("{}{:.*} {}", self.head, self.digits, value / self.size, self.unit).trim_end().to_owned()
    }
}

/// Rows at which time rises and the independent variable goes on in one sense; none if these are less than half of them.
fn nodes(at: &[f64], time: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let sense = if at.last() < at.first() { -1.0 } else { 1.0 };
    let (mut x, mut t): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (place, moment) in at.iter().zip(time).filter(|(place, moment)| place.is_finite() && moment.is_finite()) {
        let on = |(x, t): (&f64, &f64)| sense * (place - x) > 0.0 && moment > t;
        if x.last().zip(t.last()).is_none_or(on) {
            x.push(*place);
            t.push(*moment);
        }
    }
    (x.len() >= 2 && 2 * x.len() >= at.len()).then_some((x, t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::scene::Frames;
    use crate::results::{Column, Table};

    fn motion(at: &[f64], time: Option<&[f64]>, closed: bool) -> (Results, Scene) {
        let column = |name: &str, unit: &str, values: &[f64]| Column {
            name: name.into(),
            unit: unit.into(),
            values: values.to_vec(),
            ..Column::default()
        };
        let columns = time.map(|time| column("time", "s", time)).into_iter().collect();
        let results =
            Results { independent: column("theta", "rad", at), table: Table { columns, ..Table::default() }, ..Results::default() };
        let frames = Frames { at: vec![0.0, 3.0, 6.0], closed, ..Frames::default() };
        (results, Scene { dimensions: 2, frames, ..Scene::default() })
    }

    fn shot(of: &(Results, Scene), pace: Pace, repeats: bool) -> Shot {
        Shot::of(&of.0, &of.1, &ShotOptions { rate: 10.0, pace, repeats }).unwrap()
    }

    #[test]
    fn a_turn_that_repeats_ends_before_its_first_picture() {
        let turn = motion(&[0.0, 6.0], None, true);
        let (again, once) = (shot(&turn, Pace::Duration(2.0), true), shot(&turn, Pace::Duration(2.0), false));
        assert_eq!((again.at.len(), once.at.len()), (20, 21));
        assert_eq!((again.at[10], once.at[20]), (3.0, 6.0));
        assert_eq!(again.readings.first().map(String::as_str), Some("theta = 0 deg"));
    }

    #[test]
    fn time_is_that_of_the_motion() {
        // the second half takes three times as long
        let turn = motion(&[0.0, 3.0, 6.0], Some(&[0.0, 1.0, 4.0]), true);
        let shown = shot(&turn, Pace::Speed(2.0), false);
        assert_eq!((shown.seconds, shown.at.len()), (2.0, 21));
        assert_eq!([0, 20].map(|k| shown.readings[k].as_str()), ["0.00 s", "4.00 s"]);
        assert!((shown.at[5] - 3.0).abs() < 1e-12 && (shown.at[10] - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_motion_may_go_down_its_variable() {
        let back = motion(&[6.0, 0.0], Some(&[0.0, 2.0]), false);
        let shown = shot(&back, Pace::Speed(1.0), true);
        assert_eq!((shown.at[0], shown.at[20]), (6.0, 0.0));
    }

    #[test]
    fn too_many_pictures_are_refused() {
        let (results, scene) = motion(&[0.0, 6.0], None, true);
        let asked = ShotOptions { rate: 30.0, pace: Pace::Duration(1e9), repeats: true };
        assert!(Shot::of(&results, &scene, &asked).unwrap_err().contains("pictures"));
    }
}
