//! Why there is no periodic regime, in words: what happened to what at what time, and what to try.

use super::lap::{Broken, Search, Section};
use super::rough::Rough;
use super::settle::{Restless, Settled};
use super::shooting::Lost;
use super::timed::timed;
use crate::geometry::Space;
use crate::model::{ClutchLaw, Friction, Model};
use crate::results::Failure;
use crate::studies::dynamics::phases::Phases;

/// A difference in percent.
fn percent(x: f64) -> String {
    match 100.0 * x {
        percent if !percent.is_finite() => "much".into(),
        percent if percent < 0.01 => format!("{percent:.1e} %"),
        percent => format!("{percent:.3} %"),
    }
}

/// A period that was not completed.
pub(super) fn broken(search: &Search<'_>, why: Broken) -> Failure {
    match why {
        Broken::Failure(failure) => failure,
        Broken::Stopped(message) => Failure::numerical(message, format!("the motion stops there: {LOOK}")),
        Broken::Never { gone, t } => never(search, gone, t),
    }
}

/// What shows a motion that has no regime.
const LOOK: &str = "look at it in a study of the kind `dynamics`";

/// A period whose end was never reached.
fn never(search: &Search<'_>, gone: f64, t: Option<f64>) -> Failure {
    let when = t.map_or_else(|| "however long it runs".to_owned(), |t| format!("up to t = {t:.6} s, where its steps run out"));
    match search.section {
        Section::Time(period) => {
            Failure::numerical(format!("a period of {period} s takes too many steps ({when})"), "ask for a larger `tolerance`")
        }
        Section::Return(_) => Failure::numerical(
            format!("the expression of `through` does not rise through 0 again, {when}: the motion dies out, or runs away from it"),
            LOOK,
        ),
        Section::Advance(_, by) => Failure::numerical(
            format!(
                "`{}` does not advance by a period, {when}: it has gone {gone:.6} of {by:.6}, and stalls, comes to rest or swings to and fro",
                search.over
            ),
            format!("{LOOK}, and give it a stronger drive, less load or a faster start"),
        ),
    }
}

/// A run that has not settled, and of which it is known that a search from its end would not give what is asked for.
pub(super) fn unsettled(search: &Search<'_>, restless: Restless, keeps_energy: bool) -> Option<Failure> {
    let apart = percent(restless.one);
    if keeps_energy {
        return Some(Failure::numerical(
            format!(
                "no force takes or gives energy, so that the motion keeps that of its start and does not settle: the last two periods differ by {apart}. Periodic motions of such a mechanism are a family, one for every energy, and each has a period of its own"
            ),
            match search.section {
                Section::Time(_) => {
                    "let the motion of the start end its own period (`over: t, through: ...`), or search near the start for the motion of the family with this period (`settle: 0 s`)"
                }
                _ => "search near the start with `settle: 0 s`, or look at the motion of the start in a study of the kind `dynamics`",
            },
        ));
    }
    (restless.two < 0.01).then(|| {
        Failure::numerical(
            format!("the motion does not repeat itself after one period of `{}` (it differs by {apart}) but after two", search.over),
            "ask for `by` twice as large",
        )
    })
}

/// A search without success from the end of a run that has not settled.
pub(super) fn still_settling(settled: &Settled, why: Failure) -> Failure {
    match (why, settled.restless) {
        (Failure::Numerical { message, help }, Some(Restless { one, periods: [before, last], .. })) => Failure::numerical(
            format!(
                "the run has not settled after {} periods (it still changes by {} a period; the last two take {before:.6} s and {last:.6} s), and Newton's method finds no regime from there: {message}",
                settled.periods,
                percent(one)
            ),
            help,
        ),
        (other, _) => other,
    }
}

/// A map without derivative.
pub(super) fn rough(search: &Search<'_>, why: Rough) -> Failure {
    match why {
        Rough::Touched(t) => Failure::numerical(
            format!(
                "at t = {t:.6} s of the period the motion only touches a switch or a stop, so that its neighbours differ from each other by more than they are apart: the map of a period has no derivative there"
            ),
            "change a parameter a little, or smooth the switch",
        ),
        Rough::Together { t, met, blows } => Failure::numerical(
            format!(
                "at t = {t:.6} s of the period {} are met at one instant, and neighbours of the motion that meet them one after the other go on in another way: the map of a period has no derivative there",
                met.join(" and ")
            ),
            if blows {
                "change a parameter a little, so that they are met one after the other, or give the stops a `stiffness` instead of a `restitution`"
            } else {
                "change a parameter a little, so that they are met one after the other, or smooth the switches"
            },
        ),
        Rough::Rests => {
            let (held, help) = holding(&search.model);
            let message = format!(
                "a joint {held} in a part of the period, where the motion has fewer degrees of freedom than in the others: the map of a period has no derivative of full rank"
            );
            Failure::numerical(message, help)
        }
        Rough::Singular(t) => Failure::Study {
            code: "singular-mass",
            message: format!(
                "at t = {t:.6} s of the period the motion near the regime is not determined: a body that can move has no mass, or the position is singular"
            ),
            place: search.study.place.clone(),
            help: "give every moving body a mass and an inertia".into(),
        },
    }
}

/// What may hold a joint for a part of a period, and what to put in its place.
fn holding(model: &Model) -> (String, String) {
    let one_way = model.clutches.iter().any(|clutch| clutch.law == ClutchLaw::OneWay);
    let sticks = |friction: &Friction| friction.sticking.is_some();
    let friction = model.joints.iter().any(|joint| joint.friction.as_ref().is_some_and(sticks))
        || model.clutches.iter().any(|clutch| matches!(clutch.law, ClutchLaw::Friction { sticking: Some(_), .. }));
    // events with a restitution are stops as well
    let stops = model.joints.iter().any(|joint| joint.stops.is_some()) || !(friction || one_way);
    let kinds = [
        (stops, "rests on a rigid stop", "give the stop a `stiffness` instead of a `restitution`"),
        (friction, "is held by friction", "give the friction a `stick_speed`"),
        (
            one_way,
            "is held by a one-way clutch",
            "put a damper in the place of the one-way clutch that is strong against its sense alone, as a load `torque: -d*min(0 rad/s, A.omega)`",
        ),
    ];
    let words = |of: fn(&(bool, &'static str, &'static str)) -> &'static str, between: &str| {
        kinds.iter().filter(|kind| kind.0).map(of).collect::<Vec<_>>().join(between)
    };
    (words(|kind| kind.1, ", or "), words(|kind| kind.2, "; "))
}

/// A search without success.
pub(super) fn lost<G: Space<S = f64>>(search: &Search<'_>, phases: &Phases<G>, why: Lost) -> Failure {
    let apart = match why {
        Lost::Broken(why) => return broken(search, why),
        Lost::Rough(why) => return rough(search, why),
        Lost::Rests => {
            return Failure::numerical(
                "the only regime that is found is rest, in which the mechanism stands still: nothing drives it, and its motion dies out, or none of it has such a period",
                "drive it by a load, a motor or a driver; where it rests `statics` tells, how it comes to rest `dynamics`, and its vibrations about rest `modes`",
            );
        }
        Lost::Apart(apart) => apart,
    };
    let hint = match search.section {
        Section::Time(_) if !timed(&search.model, &phases.mechanism) => {
            "nothing in the model depends on time, so that its periods are its own: count them by what advances (`over: theta, by: 1 turn`) or by where they end (`over: t, through: ...`)"
        }
        _ => {
            "there may be no regime of this period near the run: let it run longer (`settle`), begin elsewhere, or follow the regime from a parameter with which it exists (`from`)"
        }
    };
    let message =
        format!("no regime is found: the begin and the end of the period stay {} of the size of the motion apart", percent(apart));
    Failure::numerical(message, hint)
}

/// A failure on the way of a continuation.
pub(super) fn on_the_way(failure: Failure, name: &str, x: f64) -> Failure {
    match failure {
        Failure::Numerical { message, help } => Failure::numerical(format!("followed to {name} = {x}: {message}"), help),
        other => other,
    }
}

/// Time acts on the motion, and the period is counted by what the motion itself does.
pub(super) fn not_driven(search: &Search<'_>) -> Failure {
    Failure::Study {
        code: "forced-period",
        message: format!(
            "time acts on the mechanism (a driver, or an expression of `t`), but `{}` advances as the motion lets it",
            search.over
        ),
        place: search.study.place_of("over"),
        help: "count the period of the forcing, as `over: t, by: 20 ms`".into(),
    }
}

/// What acts in time is not periodic.
pub(super) fn not_repeated(search: &Search<'_>, t: f64, periods: u32) -> Failure {
    let later = if periods == 1 { "one period".to_string() } else { format!("{periods} periods") };
    Failure::Study {
        code: "not-periodic",
        message: format!("what acts on the mechanism at t = {t:.6} s acts in another way {later} later"),
        place: search.study.place_of("over"),
        help: "give the period of drivers and loads, or remove what depends on time in another way".into(),
    }
}

/// The motion comes back, but what acts on it does not, or not all coordinates do.
pub(super) fn not_closed(search: &Search<'_>, apart: f64) -> Failure {
    Failure::Study {
        code: "not-periodic",
        message: format!("after a period the independent coordinates are back, modulo whole turns, but the motion is another: positions or accelerations differ by {}", percent(apart)),
        place: search.study.place.clone(),
        help: "something counts the turns, as a spring on a joint that turns on, or winds up; let it be a function of sin and cos of the angle, or ask for the period after which it is back".into(),
    }
}

/// What advances turns back, so that columns over it do not exist.
pub(super) fn turns_back(search: &Search<'_>, t: f64) -> Failure {
    Failure::Study {
        code: "turns-back",
        message: format!("`{}` turns back at t = {t:.6} s of the period, so columns cannot be given over it", search.over),
        place: search.study.place_of("over"),
        help: "let something else advance, that never turns back; if the period is known, `over: t`, else `over: t` with `through`".into(),
    }
}
