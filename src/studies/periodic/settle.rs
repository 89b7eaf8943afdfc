//! The run before the search: period after period, until two of them are alike.

use super::lap::{Broken, Lap, Search, Section};
use super::states::{Scale, between, largest, unwind};
use crate::geometry::Space;
use crate::studies::dynamics::phases::Phases;
use grashof_solvers::State;

/// Two periods are alike if they differ by less than this part of their size.
const ALIKE: f64 = 0.01;

/// Most periods of a run until two are alike.
const MOST: usize = 1000;

/// How long the run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Until {
    /// Until two periods are alike.
    Alike,
    /// So long, s, and to the end of the period.
    Time(f64),
}

/// Where the run has led.
pub(super) struct Settled {
    /// The state at the begin of a period, time 0, angles as near to those of the start as whole turns allow.
    pub(super) state: State,
    /// Periods that were run.
    pub(super) periods: usize,
    /// Whether no force takes or gives energy in the last of them, so that the motion keeps what the start gives it.
    pub(super) keeps_energy: bool,
}

/// Why the run has led nowhere.
pub(super) enum Unsettled {
    /// A period did not come to its end.
    Broken(Broken),
    /// The periods go on to differ: how much the last two, how much the last from the one before the last, and their times.
    /// Whether no force takes or gives energy in them.
    Restless { one: f64, two: f64, periods: [f64; 2], keeps_energy: bool },
}

/// Runs from a state.
pub(super) fn settle<G: Space<S = f64>>(
    search: &mut Search<'_>,
    phases: &Phases<G>,
    from: &State,
    until: Until,
    tolerance: f64,
) -> Result<Settled, Unsettled> {
    let mut state = from.clone();
    if matches!(search.section, Section::Return(_)) && search.value(phases, from) != 0.0 {
        // to the surface on which periods begin
        state = search.lap(phases, &state, tolerance).map_err(Unsettled::Broken)?.end.state;
    }
    let mut before: Option<Lap<'_, G>> = None;
    let mut differs = f64::INFINITY;
    let mut periods = 0;
    loop {
        let settled = match until {
            Until::Alike => differs < ALIKE,
            Until::Time(time) => state.t >= time,
        };
        if settled {
            if let Some(lap) = &before {
                unwind(&phases.mechanism, [&lap.start.state, &lap.end.state], periods, &mut state);
            }
            state.t = 0.0;
            let keeps_energy = before.as_ref().is_some_and(Lap::keeps_energy);
            return Ok(Settled { state, periods, keeps_energy });
        }
        let mut lap = search.lap(phases, &state, tolerance).map_err(Unsettled::Broken)?;
        periods += 1;
        let all: Vec<usize> = (0..phases.mechanism.nv).collect();
        let sizes = Scale::of(&mut lap).on(&all);
        let apart = |from: &State| largest(&between(&phases.mechanism, &all, [from, &lap.end.state]), &sizes);
        let time = before.as_ref().map_or(f64::INFINITY, |b| (b.period() / lap.period() - 1.0).abs());
        differs = apart(&lap.start.state).max(time);
        if let (Some(b), MOST) = (&before, periods)
            && until == Until::Alike
            && differs >= ALIKE
        {
            let keeps_energy = b.keeps_energy() && lap.keeps_energy();
            let periods = [b.period(), lap.period()];
            return Err(Unsettled::Restless { one: differs, two: apart(&b.start.state), periods, keeps_energy });
        }
        state.clone_from(&lap.end.state);
        before = Some(lap);
    }
}
