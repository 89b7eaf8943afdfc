//! The whole file as a table: its sections, whose keys are declared where they are read.

use super::decode::{BODY, CLUTCH, COUPLING, DRIVER, EVENT, GRAVITY, JOINT, LOAD, MOTOR, PLACED, ROTATION, SPRING, STATE, STUDY, TABLE};
use super::fields::Shape::{Count, Either, Formula, Later, List, Map, Named, Patch, Text, Value, Word};
use super::fields::{ANY, Keys, Record, Shape, Size, Want, may, need};
use super::urdf::INCLUDE;
use crate::expression::Dimension as D;

/// The whole file.
pub(crate) static FILE: Record = Record {
    what: "a model",
    choices: &[],
    fields: &[
        need("grashof", Count(1, 1), "Version of the format: 1."),
        need("name", Text, "Title of the model."),
        may("about", Text, "Source, sketch and expected facts; shown in reports."),
        need("space", Word(&["planar", "spatial"]), "`planar` (x, y) or `spatial`."),
        need(
            "gravity",
            Either(&[Word(&["none"]), List(&Value(Want::Of(D::ACCELERATION)), Size::Space), Map(&GRAVITY)]),
            "Acceleration of gravity, or a field of it, or `none`.",
        ),
        may(
            "units",
            List(&Text, Size::AtLeast(1)),
            "Units in which figures and the terminal show results, one for a dimension: `[mm, deg, kN]`.",
        ),
        may("parameters", Named(Keys::Name, "a parameter", &ANY), "Numbers with names; each can be set from outside."),
        may("tables", Named(Keys::Name, "a table", &Map(&TABLE)), "Functions given by points, called `name(x)`."),
        may("ground", Named(Keys::Name, "a point of the frame", &PLACED), "Points of the frame: `ground.NAME`."),
        need("bodies", Named(Keys::Name, "a body", &Map(&BODY)), "Rigid bodies."),
        may("joints", Named(Keys::Name, "a joint", &Map(&JOINT)), "Connections of two points."),
        may("couplings", Named(Keys::Name, "a coupling", &Map(&COUPLING)), "Relations between coordinates."),
        may("drivers", Named(Keys::Name, "a driver", &Map(&DRIVER)), "Prescribed motions of joints."),
        may("loads", Named(Keys::Name, "a load", &Map(&LOAD)), "Applied forces and torques."),
        may("springs", Named(Keys::Name, "a spring", &Map(&SPRING)), "Springs and dampers."),
        may("motors", Named(Keys::Name, "a motor", &Map(&MOTOR)), "Motors with a torque-speed curve."),
        may("clutches", Named(Keys::Name, "a clutch", &Map(&CLUTCH)), "Clutches, brakes and one-way clutches."),
        may(
            "start",
            Named(
                Keys::Reference,
                "a quantity",
                &Either(&[COORDINATE_OR_RATE, List(&COORDINATE_OR_RATE, Size::Exactly(3)), Map(&ROTATION)]),
            ),
            "Initial values of joint and body quantities: plain values are exact, values with `~` in front are guesses.",
        ),
        may("states", Named(Keys::Name, "a state", &Map(&STATE)), "First-order states: quantities given by their time rate."),
        may(
            "measures",
            Named(Keys::Name, "a measure", &Formula("an expression of t and of quantities of the mechanism")),
            "Expressions with names.",
        ),
        may("events", Named(Keys::Name, "an event", &Map(&EVENT)), "Actions when an expression crosses zero."),
        may("variants", Named(Keys::Title, "a variant", &Patch), "Merge patches (RFC 7386) over the sections above; `null` removes."),
        may("studies", Named(Keys::Title, "a study", &Map(&STUDY)), "What is computed."),
        may(
            "include",
            Either(&[Map(&INCLUDE), List(&Map(&INCLUDE), Size::AtLeast(1))]),
            "Robots from URDF files, below the sections of this file.",
        ),
        may("replicate", Later, "Reserved."),
        may("mirror", Later, "Reserved."),
    ],
};

/// Keys that a variant may not change.
pub(crate) const NOT_IN_VARIANTS: [&str; 5] = ["grashof", "name", "variants", "studies", "include"];

const COORDINATE_OR_RATE: Shape = Value(Want::Varies("an angle, a length, or their rate, as the quantity is; `~` in front marks a guess"));
