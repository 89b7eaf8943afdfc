//! How a run gets on with its steps, and what makes it slow.
//!
//! A run whose steps follow a tolerance may be of no use to anybody: a length in the wrong unit lets a pendulum swing 10¹¹ times, or
//! a stiff damper holds an explicit scheme to steps that never end. After some steps the run tells how many it would need; if these
//! are more than could be kept, it stops and says what is so fast. Fixed steps are as many as the user has asked for.

use super::phases::Phases;
use super::runaway::{HOLD, faster};
use super::setup::Plan;
use crate::dynamics::{Linearizer, Point};
use crate::geometry::Space;
use crate::kinematics::coordinates::coordinates;
use crate::kinematics::linear::Linear;
use crate::kinematics::partition::preferred;
use crate::model::{Family, Model};
use crate::numerics::eigenvalues::measurable;
use crate::studies::modes::damped::damped;
use grashof_solvers::{Control, Node};
use nalgebra::Complex;

/// Bytes that the steps of a run may take.
const MOST_BYTES: usize = 3 << 30;
/// Steps that a run may need.
const MOST: f64 = 1e7;
/// Steps between two looks; the first look is at twice as many.
const LOOK: usize = 100_000;
/// Part of the longest step below which a step is short, and how many of them in a row, a power of two, make a run crawl.
const SHORT: f64 = 1e-3;
const CRAWLS: usize = 1 << 14;
/// Velocities of a mechanism of which the fastest motion is looked for, at most: the work grows with the cube.
const MOST_VELOCITIES: usize = 100;
/// Coordinates that take part in a motion, of the largest.
const PART: f64 = 0.3;

/// The steps of a run so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Pace {
    count: usize,
    /// Where the run began, s.
    begun: Option<f64>,
    /// Where it was at the last look, s.
    last: f64,
    /// The longest step, s, and how many short ones there were in a row.
    longest: f64,
    short: usize,
}

/// Why a run should not go on.
pub(super) enum Slow {
    /// Its steps would be too many: how many there were and how many it would need.
    Steps(usize, f64),
    /// Its steps no longer fit into memory.
    Memory(usize),
}

impl Pace {
    /// Counts a step from `from` to `to`, s, after which all steps take so many bytes.
    pub(super) fn step(&mut self, [from, to]: [f64; 2], bytes: usize, plan: &Plan) -> Option<Slow> {
        let begun = *self.begun.get_or_insert(from);
        self.count += 1;
        // an event has no length
        if to > from {
            self.longest = self.longest.max(to - from);
            self.short = if to - from < SHORT * self.longest { self.short + 1 } else { 0 };
        }
        if bytes > MOST_BYTES {
            return Some(Slow::Memory(self.count));
        }
        if !self.count.is_multiple_of(LOOK) || matches!(plan.settings.control, Control::Steps(_)) {
            return None;
        }
        // what was slow may be over, and what is slow may be short: the faster pace of the two counts
        let ways = [(to - begun) / self.count as f64, (to - self.last) / LOOK as f64];
        self.last = to;
        let needed = self.count as f64 + (plan.until - to) / ways[0].max(ways[1]);
        (self.count >= 2 * LOOK && needed > MOST).then_some(Slow::Steps(self.count, needed))
    }

    /// How many short steps have followed each other where they make the run crawl: told once, and again whenever they have doubled.
    pub(super) fn crawls(&self) -> Option<usize> {
        (self.short >= CRAWLS && self.short.is_power_of_two()).then_some(self.short)
    }
}

impl Slow {
    /// What the run says at a node, and how to go on.
    pub(super) fn explain<G>(&self, model: &Model, phase: &Phases<G>, plan: &Plan, node: &Node) -> String
    where
        G: Space<S = f64>,
    {
        let t = node.state.t;
        let (count, why) = match self {
            Self::Steps(count, needed) => {
                let until = plan.until;
                (count, format!("{count} steps were taken, and to t = {until} s it would be {needed:.0e}, more than {MOST:.0e}"))
            }
            Self::Memory(count) => (count, format!("{count} steps fill the memory that a run may take")),
        };
        if let Some(faster) = faster(model, phase, &node.state) {
            return format!("at t = {t:.3e} s {faster}, so that its steps become ever shorter ({why}): {HOLD}");
        }
        let fastest = fastest(model, phase, node);
        let what = fastest.as_ref().map_or_else(String::new, |(names, value)| format!(": {names} {}", pace_of(*value)));
        let stiff = fastest.is_some_and(|(_, value)| value.re < -value.im.abs());
        let explicit = plan.family == Family::Explicit;
        let how = if stiff && explicit {
            "take `integrator: radau5`, whose steps may be longer than that".to_string()
        } else {
            let reached = t * (MOST / *count as f64).max(1.0);
            format!(
                "see whether lengths, masses and stiffnesses there are in the units that were meant, or end sooner, as with `until: {reached:.0e} s`"
            )
        };
        format!("at t = {t:.3e} s {why}{what}; {how}")
    }
}

/// The period of a motion, or the time in which it settles or grows.
fn pace_of(value: Complex<f64>) -> String {
    if value.im.abs() > value.re.abs() {
        format!("there with a period of {:.1e} s", std::f64::consts::TAU / value.im.abs())
    } else if value.re < 0.0 {
        format!("there, which settles within {:.1e} s", 1.0 / -value.re)
    } else {
        format!("there, which grows within {:.1e} s", 1.0 / value.re)
    }
}

/// The coordinates that move in the fastest motion near a node, and its eigenvalue, 1/s; none if it cannot be told.
fn fastest<G>(model: &Model, phase: &Phases<G>, node: &Node) -> Option<(String, Complex<f64>)>
where
    G: Space<S = f64>,
{
    let (m, s) = (&phase.mechanism, &node.state);
    if m.nv > MOST_VELOCITIES {
        return None;
    }
    let modes = &s.modes[..m.switches + m.windings];
    let at = Point { t: s.t, q: &s.q, v: &s.v, z: &s.z, a: &node.a, lambda: &node.lambda, modes };
    let linear = Linear::new(m, &mut Linearizer::new(&phase.mechanism), &at, &phase.start.metric).ok()?;
    let reduced = linear.reduce(&preferred(m)).ok()?;
    let own = &reduced.partition.independent;
    if !measurable(&reduced.a) {
        return None;
    }
    let found = damped(&reduced.a, own.len())?;
    let motion = found.iter().filter(|motion| motion.value.norm().is_finite()).max_by(|a, b| a.value.norm().total_cmp(&b.value.norm()))?;
    let all = coordinates(model, m);
    let largest = motion.shape.iter().fold(0.0, |max: f64, x| max.max(x.norm()));
    let moves = own.iter().zip(motion.shape.iter()).filter(|(_, x)| x.norm() >= PART * largest);
    let names: Vec<String> = moves.map(|(&i, _)| format!("`{}`", all[i].name)).take(3).collect();
    let verb = if names.len() == 1 { "moves" } else { "move" };
    (!names.is_empty()).then(|| (format!("{} {verb}", names.join(", ")), motion.value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Coordinates;
    use grashof_solvers::Settings;

    /// Steps until a run of 1 s is stopped, of steps of these lengths.
    fn stopped(control: Control, length: impl Fn(usize) -> f64) -> Option<(usize, f64)> {
        let settings = Settings { control, ..Settings::default() };
        let (coordinates, family) = (Coordinates::Joint, Family::Either);
        let plan = Plan { until: 1.0, every: None, settings, coordinates, minimal: false, family, integrator: None };
        let (mut pace, mut t) = (Pace::default(), 0.0);
        for k in 0..2_000_000 {
            let next = t + length(k);
            if let Some(Slow::Steps(count, needed)) = pace.step([t, next], 0, &plan) {
                return Some((count, needed));
            }
            t = next;
        }
        None
    }

    /// Numbers of steps of these lengths behind which a run of 2^16 of them crawls.
    fn crawls(length: impl Fn(usize) -> f64) -> Vec<usize> {
        let (coordinates, family) = (Coordinates::Joint, Family::Either);
        let settings = Settings { control: Control::Tolerance(1e-8), ..Settings::default() };
        let plan = Plan { until: 1.0, every: None, settings, coordinates, minimal: false, family, integrator: None };
        let mut pace = Pace::default();
        let at = |k: usize| {
            pace.step([0.0, length(k)], 0, &plan);
            pace.crawls().map(|_| k)
        };
        (0..1 << 16).filter_map(at).collect()
    }

    #[test]
    fn many_short_steps_in_a_row_are_a_crawl() {
        let first = |k: usize| if k == 0 { 1e-2 } else { 1e-6 };
        assert_eq!(crawls(first), [1 << 14, 1 << 15]);
        // one step is longer again, or all are of one length, as those of a stiff force
        assert_eq!(crawls(|k| if k.is_multiple_of(10_000) { 1e-2 } else { 1e-6 }), [0; 0]);
        assert_eq!(crawls(|_| 1e-6), [0; 0]);
        // an event between two steps is none
        assert_eq!(crawls(|k| if k == 5 { 0.0 } else { first(k) }), [(1 << 14) + 1, (1 << 15) + 1]);
    }

    #[test]
    fn what_is_too_slow_all_the_time_is_stopped() {
        let tolerance = Control::Tolerance(1e-8);
        let (count, needed) = stopped(tolerance, |_| 1e-12).expect("a stop");
        assert!(count == 200_000 && (needed / 1e12 - 1.0).abs() < 1e-3, "{count} {needed}");
        // a million steps are enough for it, or a slow stretch is over, or has only just begun
        assert_eq!(stopped(tolerance, |_| 1e-6), None);
        assert_eq!(stopped(tolerance, |k| if k < 150_000 { 1e-12 } else { 5e-7 }), None);
        assert_eq!(stopped(tolerance, |k| if k < 50_000 { 1e-5 } else { 1e-12 }), None);
        // fixed steps are as many as they are
        assert_eq!(stopped(Control::Steps([1e-12; 2]), |_| 1e-12), None);
    }
}
