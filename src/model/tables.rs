//! The tables of fields: every key of the format, once.

use super::decode::STUDY;

use super::fields::Shape::{Count, Either, Flag, Formula, Later, List, Map, Name, Named, Patch, Text, Value, Word};
use super::fields::{
    ANGLE, ANY, BRISTLE_DAMPING, BRISTLE_STIFFNESS, COORDINATE, DAMPING, DIRECTION, EFFORT, FIGURES, FRICTION_LEVEL, INERTIA, JOINT_NAME,
    LENGTH, MASS, NUMBER, POINT, POSITION, RATE, ROLL_PITCH_YAW, STIFFNESS, TIME, at_most_one, may, need, one_of,
};
use super::fields::{Keys, Shape, Size, Table, Want};
use crate::expression::Dimension as D;

const PLACED: Shape = Either(&[POSITION, Map(&FRAME)]);

/// The whole file.
pub(crate) static FILE: Table = Table {
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

static GRAVITY: Table = Table {
    what: "a field of gravity",
    choices: &[],
    fields: &[need(
        "potential",
        Formula("an expression of the place x, y, z, r"),
        "Potential of gravity, J/kg: the acceleration is minus its gradient.",
    )],
};

/// Keys that a variant may not change.
pub(crate) const NOT_IN_VARIANTS: [&str; 5] = ["grashof", "name", "variants", "studies", "include"];

static INCLUDE: Table = Table {
    what: "an included robot",
    choices: &[],
    fields: &[
        need("urdf", Text, "URDF file, by its path from this file."),
        may("prefix", Text, "In front of every name of the robot; nothing if omitted."),
        may("at", List(&LENGTH, Size::Exactly(3)), "Place of the root in the world; the origin if omitted."),
        may("rpy", ROLL_PITCH_YAW, "Orientation of the root: turned about the world's x, then y, then z."),
        may("base", Word(&["fixed", "free"]), "Whether the root is fixed to the ground."),
        may("stops", Flag, "Make end stops of the position limits."),
    ],
};

const COORDINATE_OR_RATE: Shape = Value(Want::Varies("an angle, a length, or their rate, as the quantity is; `~` in front marks a guess"));

static TABLE: Table = Table {
    what: "a table",
    choices: &[],
    fields: &[
        need("points", List(&List(&ANY, Size::Exactly(2)), Size::AtLeast(2)), "Pairs `[x, y]`, x strictly rising."),
        may("between", Word(&["linear", "cubic"]), "Interpolation."),
        may("beyond", Word(&["constant", "linear", "error", "periodic"]), "Continuation outside of the points."),
    ],
};

static BODY: Table = Table {
    what: "a body",
    choices: &[at_most_one(&["bar", "disc", "plate", "box", "ball"])],
    fields: &[
        may("bar", Map(&BAR), "Uniform straight bar from the body's origin along x; has the points `start` and `end`."),
        may("disc", Map(&DISC), "Uniform disc about z, origin in the middle."),
        may("plate", Map(&PLATE), "Uniform plate, origin in the middle."),
        may("box", Map(&PLATE), "Uniform box, origin in the middle."),
        may("ball", Map(&BALL), "Uniform ball, origin in the middle."),
        may("mass", MASS, "Mass."),
        may("inertia", FIGURES, "Inertia about the centre of mass: a number, `[Ixx, Iyy, Izz]`, or with `Ixy, Ixz, Iyz`."),
        may("com", POSITION, "Centre of mass in the body frame."),
        may("points", Named(Keys::Name, "a point", &PLACED), "Points in the body frame."),
        may("drawn", List(&POSITION, Size::AtLeast(1)), "Points that outline the body in drawings, body frame."),
        may("attached", Named(Keys::Name, "an attached mass", &Map(&ATTACHED)), "Point masses and rotors on the body."),
        may("fictitious", Flag, "Allows an inertia that no real body has, as robots from data sheets do; moments below 0 stay refused."),
    ],
};

static FRAME: Table = Table {
    what: "a point with axes of its own",
    choices: &[],
    fields: &[
        need("at", POSITION, "Place in the body frame."),
        may("rpy", ROLL_PITCH_YAW, "Spatial: how the axes of the point stand in the body: turned about x, then y, then z."),
    ],
};

static BAR: Table = Table {
    what: "a bar",
    choices: &[one_of(&["length", "from"])],
    fields: &[
        may("length", LENGTH, "Length."),
        may("from", POSITION, "Start of a bar drawn in place, world coordinates."),
        may("to", POSITION, "End of a bar drawn in place, world coordinates."),
        may("mass", MASS, "Mass; 0 if omitted."),
        may("width", LENGTH, "In space: size along y; thin if omitted."),
        may("height", LENGTH, "In space: size along z; thin if omitted."),
    ],
};

static DISC: Table = Table {
    what: "a disc",
    choices: &[],
    fields: &[
        need("radius", LENGTH, "Radius."),
        may("mass", MASS, "Mass; 0 if omitted."),
        may("thickness", LENGTH, "Thickness; thin if omitted."),
    ],
};

static PLATE: Table = Table {
    what: "a plate or box",
    choices: &[],
    fields: &[need("size", List(&LENGTH, Size::Space), "Sizes along the body's axes."), may("mass", MASS, "Mass; 0 if omitted.")],
};

static BALL: Table =
    Table { what: "a ball", choices: &[], fields: &[need("radius", LENGTH, "Radius."), may("mass", MASS, "Mass; 0 if omitted.")] };

static ATTACHED: Table = Table {
    what: "an attached mass",
    choices: &[],
    fields: &[
        may("at", Name("a point of the body"), "Point of the body; its origin if omitted."),
        may("mass", MASS, "Point mass."),
        may("inertia", FIGURES, "Inertia of a rotor about its own centre."),
    ],
};

/// The kinds of joints; the first-named point's body carries the axis.
pub(crate) const JOINT_KINDS: [&str; 11] =
    ["revolute", "slider", "prismatic", "pin-in-slot", "fixed", "distance", "cylindrical", "planar", "screw", "universal", "spherical"];
const ENDS: Shape = List(&POINT, Size::Exactly(2));

static JOINT: Table = Table {
    what: "a joint",
    choices: &[one_of(&JOINT_KINDS)],
    fields: &[
        may("revolute", ENDS, "Hinge of two points."),
        may("slider", ENDS, "The second's point slides along `axis` of the first; no rotation."),
        may("prismatic", ENDS, "The same as `slider`."),
        may("pin-in-slot", ENDS, "Planar: the second's point slides in a slot of the first along `axis`."),
        may("fixed", ENDS, "Holds two bodies together."),
        may("distance", ENDS, "Massless link: holds the distance of two points."),
        may("cylindrical", ENDS, "Spatial: turns about and slides along `axis`."),
        may("planar", ENDS, "Spatial: the second's point moves in the plane normal to `axis`."),
        may("screw", ENDS, "Spatial: turns about `axis` and moves `pitch` a turn."),
        may("universal", ENDS, "Spatial: two crossed hinges, `axes`."),
        may("spherical", ENDS, "Spatial: ball joint."),
        may("axis", DIRECTION, "Axis in the first body's frame."),
        may("to", DIRECTION, "Spatial: the same axis in the second body's frame; the numbers of `axis` if omitted."),
        may(
            "rpy",
            ROLL_PITCH_YAW,
            "Spatial, instead of `to`: how the second body stands in the first at 0, turned about x, then y, then z.",
        ),
        may("axes", List(&DIRECTION, Size::Exactly(2)), "Universal: axis in the first body's frame, axis in the second's."),
        may("pitch", LENGTH, "Screw: advance per turn."),
        may("length", LENGTH, "Distance: length of the link; as drawn if omitted."),
        may("zero", COORDINATE, "Value of the coordinate where the bodies' axes coincide."),
        may("damping", DAMPING, "Viscous damping of the coordinate."),
        may("friction", Map(&FRICTION), "Dry friction."),
        may("limits", Map(&LIMITS), "End stops."),
        may("cut", Flag, "Keep this joint off the spanning tree."),
    ],
};

static FRICTION: Table = Table {
    what: "friction",
    choices: &[],
    fields: &[
        need("coulomb", FRICTION_LEVEL, "Torque or force of the friction; a plain number is a coefficient of friction."),
        may("static", FRICTION_LEVEL, "The same at rest, where it is higher; falls to `coulomb` over `stribeck_speed`."),
        may("stribeck_speed", RATE, "Speed over which the friction falls from `static` to `coulomb`."),
        may("stick_speed", RATE, "Friction in proportion to the speed below this one, instead of sticking."),
        may("radius", LENGTH, "Radius of the pin, with a coefficient of friction in a `revolute`."),
        may("length", LENGTH, "Length of the guide, with a coefficient of friction in a `slider`: the moment presses on its ends."),
        may("bristle", Map(&BRISTLE), "Bristles that bend before the joint slides (LuGre), in place of `stick_speed`."),
    ],
};

static BRISTLE: Table = Table {
    what: "a bristle",
    choices: &[],
    fields: &[
        need("stiffness", BRISTLE_STIFFNESS, "Stiffness of the bristles."),
        may("damping", BRISTLE_DAMPING, "Damping of the bristles; 0 if omitted."),
    ],
};

static LIMITS: Table = Table {
    what: "limits",
    choices: &[one_of(&["stiffness", "restitution"])],
    fields: &[
        may("from", COORDINATE, "Lower end."),
        may("to", COORDINATE, "Upper end."),
        may("stiffness", STIFFNESS, "Stiffness of the stop, in N/m or N m/rad."),
        may("damping", DAMPING, "Damping of the stop, which never pulls; 0 if omitted."),
        may("restitution", NUMBER, "Of a rigid stop: speed behind a blow by speed before it, 0 to 1."),
        may("rest_speed", RATE, "A rebound from a rigid stop below this speed counts as rest; 1 mm/s or 1e-3 rad/s if omitted."),
    ],
};

static COUPLING: Table = Table {
    what: "a coupling",
    choices: &[one_of(&["gear", "rack", "zero"])],
    fields: &[
        may("gear", List(&JOINT_NAME, Size::Exactly(2)), "The second joint turns `ratio` times as far as the first."),
        may("rack", List(&JOINT_NAME, Size::Exactly(2)), "The slider moves `radius` times as far as the pinion turns: [pinion, slider]."),
        may("zero", Formula("an expression of positions and `t`"), "An expression of positions and `t` that stays 0."),
        may("ratio", NUMBER, "Of a gear."),
        may("radius", LENGTH, "Of a pinion."),
    ],
};

static DRIVER: Table = Table {
    what: "a driver",
    choices: &[one_of(&["speed", "angle", "position", "rise"])],
    fields: &[
        need("joint", JOINT_NAME, "The driven joint."),
        may(
            "speed",
            Value(Want::Varies("an angular speed (rad/s) or a speed (m/s), as the joint has it")),
            "Constant speed from the start position.",
        ),
        may("angle", ANGLE, "The angle as an expression of t."),
        may("position", LENGTH, "The position as an expression of t."),
        may("rise", Map(&RISE), "A rise from the start position, then rest."),
    ],
};

static RISE: Table = Table {
    what: "a rise",
    choices: &[],
    fields: &[
        need("by", COORDINATE, "How far."),
        need("during", TIME, "How long."),
        need("law", Word(&["cycloidal", "poly5"]), "Law of motion."),
    ],
};

static LOAD: Table = Table {
    what: "a load",
    choices: &[one_of(&["at", "joint"])],
    fields: &[
        may("at", POINT, "The point of a body that it acts on."),
        may("joint", JOINT_NAME, "The joint whose coordinate it acts on: on the second body, reaction on the first."),
        may(
            "force",
            Either(&[Value(Want::Of(D::FORCE)), List(&Value(Want::Of(D::FORCE)), Size::Space)]),
            "Force: a vector at a point, a number on a slider.",
        ),
        may(
            "torque",
            Either(&[Value(Want::Of(D::TORQUE)), List(&Value(Want::Of(D::TORQUE)), Size::Exactly(3))]),
            "Torque: a number in the plane or on a joint, a vector in space.",
        ),
        may(
            "frame",
            Name("a body, a point `body.point` with axes of its own, or `world`"),
            "Body or point whose axes the components are in; `world` if omitted.",
        ),
    ],
};

static SPRING: Table = Table {
    what: "a spring",
    choices: &[one_of(&["between", "joint", "stretch"]), at_most_one(&["stiffness", "force"]), at_most_one(&["length", "rest"])],
    fields: &[
        may("between", ENDS, "The two points that it connects."),
        may("joint", JOINT_NAME, "The joint whose coordinate it acts on."),
        may(
            "stretch",
            Formula("an expression of positions and `t`"),
            "Any expression of positions and `t`; the force is minus the gradient of the energy.",
        ),
        may("stiffness", STIFFNESS, "Force by stretch."),
        may("force", Formula("a table, or an expression of `stretch` and `t`"), "Law of the force, instead of `stiffness`."),
        may("length", LENGTH, "Free length."),
        may("rest", COORDINATE, "Rest angle or rest position."),
        may("damping", DAMPING, "Force by rate of stretch; 0 if omitted."),
        may("preload", EFFORT, "Constant added to the force; 0 if omitted."),
    ],
};

static MOTOR: Table = Table {
    what: "a motor",
    choices: &[],
    fields: &[
        need("joint", JOINT_NAME, "The joint that it turns."),
        may("curve", Name("the name of a table: torque over speed"), "Torque of the motor by its own speed."),
        may("gear", NUMBER, "Turns of the motor per turn of the joint; 1 if omitted."),
        may("inertia", INERTIA, "Inertia of the rotor before the gear; 0 if omitted."),
    ],
};

static CLUTCH: Table = Table {
    what: "a clutch",
    choices: &[one_of(&["joint", "between"]), one_of(&["torque", "force", "one_way"]), at_most_one(&["stick_speed", "one_way"])],
    fields: &[
        may("joint", JOINT_NAME, "A brake: it acts on the coordinate of this joint."),
        may(
            "between",
            List(&JOINT_NAME, Size::Exactly(2)),
            "A clutch: it acts on the coordinate of the second joint less that of the first.",
        ),
        may("torque", Value(Want::Of(D::TORQUE)), "Largest torque, as long as it slips; an expression as of a load."),
        may("force", Value(Want::Of(D::FORCE)), "Largest force between joints that slide; an expression as of a load."),
        may("static", EFFORT, "The same at rest, where it is higher; falls over `stribeck_speed`."),
        may("stribeck_speed", RATE, "Speed over which it falls from `static`."),
        may("stick_speed", RATE, "In proportion to the slip below this one, instead of sticking."),
        may("one_way", Flag, "The slip does not become negative: the first drives the second, which may overrun it."),
    ],
};

static ROTATION: Table = Table {
    what: "a rotation",
    choices: &[],
    fields: &[
        need("axis", List(&NUMBER, Size::Exactly(3)), "Axis, world frame."),
        need("angle", ANGLE, "Angle; `~` in front marks a guess."),
    ],
};

static STATE: Table = Table {
    what: "a state",
    choices: &[],
    fields: &[
        need("rate", Formula("an expression of positions, velocities, t and states"), "Time rate of the state, which it may name."),
        may("start", ANY, "Value at t = 0, 0 if omitted; its unit is that of the state."),
    ],
};

static EVENT: Table = Table {
    what: "an event",
    choices: &[],
    fields: &[
        need("when", Formula("an expression that crosses zero"), "What crosses zero."),
        may("crossing", Word(&["both", "rising", "falling"]), "In which direction."),
        may("action", Word(&["record", "stop"]), "Whether the run goes on."),
        may("set", Named(Keys::Reference, "a parameter", &ANY), "Parameters that change then."),
        may("restitution", Map(&RESTITUTION), "Impact in a joint."),
    ],
};

static RESTITUTION: Table = Table {
    what: "restitution",
    choices: &[],
    fields: &[need("joint", JOINT_NAME, "The joint."), need("e", NUMBER, "Coefficient of restitution.")],
};
