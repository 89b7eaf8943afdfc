//! The run before the search: period after period, until two of them are alike.

use super::lap::{Broken, Lap, Search, Section};
use super::saltation::instant;
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
    /// What the last periods differ by, where no two of them are alike.
    pub(super) restless: Option<Restless>,
}

/// Periods that go on to differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Restless {
    /// How much the last differs from the one before it.
    pub(super) one: f64,
    /// How much its end differs from the begin of the one before it.
    pub(super) two: f64,
    /// Times of the last two, s.
    pub(super) periods: [f64; 2],
}

/// Runs from a state.
///
/// # Errors
/// Where a period does not come to its end.
pub(super) fn settle<G: Space<S = f64>>(
    search: &mut Search<'_>,
    phases: &Phases<G>,
    from: &State,
    until: Until,
    tolerance: f64,
) -> Result<Settled, Broken> {
    let mut state = from.clone();
    if matches!(search.section, Section::Return(_)) && search.value(phases, from) != 0.0 {
        // to the surface on which periods begin
        state = search.lap(phases, &state, tolerance)?.end.state;
    }
    let mut before: Option<Lap<'_, G>> = None;
    let mut differs = f64::INFINITY;
    let mut restless = None;
    let mut keeps_energy = false;
    let mut periods = 0;
    loop {
        let settled = match until {
            Until::Alike => differs < ALIKE || restless.is_some(),
            Until::Time(time) => state.t >= time,
        };
        if settled {
            if let Some(lap) = &before {
                unwind(&phases.mechanism, [&lap.start.state, &lap.end.state], periods, &mut state);
                state.t = 0.0;
                search.take_modes(phases, &mut state, instant(lap.period(), search.tolerance));
            }
            state.t = 0.0;
            return Ok(Settled { state, periods, keeps_energy, restless });
        }
        let mut lap = search.lap(phases, &state, tolerance)?;
        periods += 1;
        let all: Vec<usize> = (0..phases.mechanism.nv).collect();
        let sizes = Scale::of(&mut lap).on(&all);
        let apart = |from: &State| largest(&between(&phases.mechanism, &all, [from, &lap.end.state]), &sizes);
        let time = before.as_ref().map_or(f64::INFINITY, |b| (b.period() / lap.period() - 1.0).abs());
        differs = apart(&lap.start.state).max(time);
        keeps_energy = lap.keeps_energy();
        if let (Some(b), MOST) = (&before, periods)
            && until == Until::Alike
            && differs >= ALIKE
        {
            keeps_energy &= b.keeps_energy();
            restless = Some(Restless { one: differs, two: apart(&b.start.state), periods: [b.period(), lap.period()] });
        }
        state.clone_from(&lap.end.state);
        before = Some(lap);
    }
}
