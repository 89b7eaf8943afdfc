//! What has no value in a study: which law or column it is, where that stands in the file, and why.

use super::assemble::{Assembled, assemble};
use super::held::{Pose, settled};
use crate::dynamics::Dynamics;
use crate::expression::{Cause, Id};
use crate::geometry::Space;
use crate::mechanism::{self, Coordinates, Measured, Mechanism, Stretch, StretchOf, build};
use crate::model::{Model, Study};
use crate::results::{Failure, Undefined};

/// Something without a value at a place of a motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Gap {
    /// A law of a driver, a coupling, a force or a state.
    Law(mechanism::Undefined),
    /// An expression that is watched.
    Watched(Id, Cause),
}

/// What guards a value.
const GUARD: &str = "choose what holds there by `if(condition, a, b)`";

impl Gap {
    /// In words; `at` is where it happens: `t = 0.5 s`.
    pub(crate) fn explain(&self, model: &Model, study: &Study, at: &str) -> Undefined {
        match self {
            Self::Law(law) => of_law(model, law, at),
            Self::Watched(id, cause) => {
                let (name, place) = watched(model, study, *id);
                Undefined {
                    message: format!("{name} is not defined at {at}: {}", model.why_undefined(*cause)),
                    help: format!("{GUARD}; or, if its cells may stay blank there, name it in `undefined` of the study"),
                    place,
                }
            }
        }
    }
}

/// A law of the mechanism without a value, in words.
fn of_law(model: &Model, law: &mechanism::Undefined, at: &str) -> Undefined {
    Undefined {
        message: format!("{} is not defined at {at}: {}", part(&law.place), model.why_undefined(law.cause)),
        place: law.place.clone(),
        help: match law.cause {
            Cause::Table { .. } => {
                "give the table points as far as it is used, say how it goes on with `beyond`, or end the study before".into()
            }
            _ => "use a formula that is defined there and a little beyond, or end the study before".into(),
        },
    }
}

/// The part of a model at a path, in words: "load `push`" at `loads.push`.
fn part(place: &str) -> String {
    let mut keys = place.split('.');
    let (section, name) = (keys.next().unwrap_or_default(), keys.next().unwrap_or_default());
    let word = match section {
        "loads" => "load",
        "springs" => "the law of spring",
        "drivers" => "the motion of driver",
        "couplings" => "coupling",
        "motors" => "the torque of motor",
        "states" => "the rate of state",
        "joints" => "a force on joint",
        _ => return format!("`{place}`"),
    };
    format!("{word} `{name}`")
}

/// What an expression is that a study watches, and its place.
fn watched(model: &Model, study: &Study, id: Id) -> (String, String) {
    let column = study.columns.iter().find(|c| c.value == id).map(|c| c.name.as_str());
    if let Some(measure) = model.measures.iter().find(|m| m.value == id) {
        return (format!("`{}`", measure.name), measure.place.clone());
    }
    if let Some(name) = column {
        return (format!("column `{name}`"), format!("{}.columns", study.place));
    }
    if let Some(functional) = study.functionals.iter().find(|f| f.of == id) {
        return (format!("what `{}` is taken of", functional.text), study.place.clone());
    }
    let event = model
        .events
        .iter()
        .find(|e| e.when == id || e.restitution.as_ref().is_some_and(|r| r.e == id) || e.set.iter().any(|(_, set)| *set == id));
    match event {
        Some(event) => (format!("an expression of event `{}`", event.name), format!("events.{}", event.name)),
        None => ("a curve of a figure".into(), study.place.clone()),
    }
}

/// What is undefined in a state that an analysis has not been able to use; none if that had another reason.
pub(crate) fn in_state<G: Space<S = f64>>(
    model: &Model,
    mechanism: &Mechanism<G>,
    [q, v, z]: [&[f64]; 3],
    modes: &[i32],
    at: &str,
) -> Option<Undefined> {
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.work.z.copy_from_slice(z);
    dynamics.terms(0.0, q, v, modes);
    dynamics.rates(modes);
    dynamics.undefined(modes).map(|law| of_law(model, &law, at))
}

/// That the forces of a mechanism at rest in a pose are no numbers, and why.
pub(crate) fn not_finite<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, pose: Pose<'_>) -> Failure {
    let rest = vec![0.0; mechanism.nv];
    let undefined = in_state(model, mechanism, [pose.q, &rest, pose.z], pose.modes, "the pose");
    let undefined = undefined.or_else(|| without_direction(model, mechanism, pose));
    let unknown = || Failure::numerical("a force in the pose is not a number", "look at tables and expressions of loads");
    undefined.map_or_else(unknown, Failure::Undefined)
}

/// That a spring has no direction, and so no stiffness, in a pose where its ends meet.
pub(crate) fn without_direction<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, pose: Pose<'_>) -> Option<Undefined> {
    let mut dynamics = Dynamics::without_mass(mechanism);
    dynamics.time(0.0, pose.modes);
    dynamics.position(pose.q, pose.modes);
    meeting(model, &dynamics, "in the pose")
}

/// The same in the pose that was evaluated last; `there` says where that is: `at t = 0.5 s`.
pub(crate) fn meeting<G: Space<S = f64>>(model: &Model, dynamics: &Dynamics<'_, G>, there: &str) -> Option<Undefined> {
    let m = dynamics.mechanism;
    let meets = |stretch: &Stretch<G>| match stretch.of {
        StretchOf::Gauge(k) => matches!(m.gauges[k].measured, Measured::Distance { .. }) && dynamics.work.readings[k].x == 0.0,
        StretchOf::Function(_) => false,
    };
    let name = &model.springs.get(m.stretches.iter().position(meets)?)?.name;
    Some(Undefined {
        message: format!("the ends of the spring `{name}` meet {there}: it has no direction there, so that its stiffness is not defined"),
        help: "let its ends be apart there, or give it a coordinate to work along, as `stretch: B.position - A.position`".into(),
        place: format!("springs.{name}"),
    })
}

/// [`assemble`], where it fails because a law has no value told so.
///
/// # Errors
/// As there, and that law.
pub(crate) fn assembled<G: Space<S = f64>>(
    model: &Model,
    parameters: &[f64],
    coordinates: Coordinates,
) -> Result<(Mechanism<G>, Assembled), Failure> {
    assemble::<G>(model, parameters, coordinates).map_err(|failure| {
        let Ok(mechanism) = build::<G>(model, parameters, coordinates) else { return failure };
        let (q, v, z) = (mechanism.drawn(), vec![0.0; mechanism.nv], mechanism.state_starts.clone());
        let modes = settled(&mechanism, [&q, &v, &z], &mechanism.modes());
        let undefined = in_state(model, &mechanism, [&q, &v, &z], &modes, "the start");
        undefined.map_or(failure, Failure::Undefined)
    })
}
