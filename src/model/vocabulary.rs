//! The quantities that an expression may name, and the derivative, level and dimension of each.

use super::place::PointRef;

/// A leaf of an expression: something that the mechanism, the study or the clock supplies.
///
/// Sizes such as `speed`, `a`, `f` and measures are not leaves: they are lowered to expressions of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Quantity {
    /// Time, s.
    Time,
    /// World coordinate (`order` 0), velocity (1) or acceleration (2) of a body's point; `axis` 0 x, 1 y, 2 z. m, m/s, m/s².
    Point { at: PointRef, axis: usize, order: usize },
    /// Planar angle of a body from +x, counter-clockwise and unwrapped, or its rates. rad, rad/s, rad/s².
    Angle { body: usize, order: usize },
    /// Spatial: component of a body's angular velocity (`order` 1) or acceleration (2), in world axes or in its `own`, rad/s, rad/s².
    Spin { body: usize, axis: usize, order: usize, own: bool },
    /// Spatial: component of a body's unit quaternion (w, x, y, z), or its rates, 1/s, 1/s².
    Quaternion { body: usize, component: usize, order: usize },
    /// The one coordinate of a joint (angle or position, second body relative to first) or its rates; `slot` counts the axes of a joint with several (cylindrical: 0 angle, 1 position).
    Joint { joint: usize, slot: usize, order: usize },
    /// Reaction: force (`axis` 0 to 2) of the first-named body on the second, world axes, at the joint, N.
    Force { joint: usize, axis: usize },
    /// Reaction: moment about the joint's point (of the second body), world axes; planar only `axis` 2. N m.
    Moment { joint: usize, axis: usize },
    /// Torque or force of the end stops of a joint, on the second body along its coordinate, N m or N.
    Stop { joint: usize },
    /// Dry friction of a joint, on the second body along its coordinate, N m or N.
    Friction { joint: usize },
    /// State of the bristles of a joint: their deflection in parts of coulomb/stiffness.
    Bristle { joint: usize },
    /// Torque or force of a driver, on the second body, N m or N.
    DriverEffort { driver: usize },
    /// Power that a driver puts in, W.
    DriverPower { driver: usize },
    /// Torque or force of a coupling, on the second body of its second joint or along its expression, N m or N.
    CouplingEffort { coupling: usize },
    /// Stretch of a spring (`order` 0) or its rate (1) and second rate (2).
    Stretch { spring: usize, order: usize },
    /// Force of a spring, positive pulls together.
    SpringForce { spring: usize },
    /// Energy stored in a spring, J.
    SpringEnergy { spring: usize },
    /// Torque of a motor on its joint, N m.
    MotorTorque { motor: usize },
    /// Torque or force of a clutch, on what belongs to its second joint, N m or N.
    ClutchEffort { clutch: usize },
    /// Centre of mass of all bodies, its velocity and acceleration.
    Com { axis: usize, order: usize },
    /// Kinetic energy, J.
    Kinetic,
    /// Potential energy of gravity and springs, J.
    Potential,
    /// Linear momentum, kg m/s.
    Momentum { axis: usize },
    /// Σ m a, N.
    Shaking { axis: usize },
    /// d/dt of the angular momentum about the world origin, N m; planar only `axis` 2.
    ShakingMoment { axis: usize },
    /// Force of the mechanism on the frame, N.
    Frame { axis: usize },
    /// Moment of the mechanism on the frame about the world origin, N m; planar only `axis` 2.
    FrameMoment { axis: usize },
    /// 2 T/ω² of the one driver, kg m² (or kg).
    InertiaEq,
    /// Derivative of [`Quantity::InertiaEq`] by the driver's coordinate.
    InertiaEqSlope,
    /// A first-order state, `model.states[i]`.
    State(usize),
    /// Only in `scalars` and `expect`: `study.functionals[i]`.
    Functional(usize),
    /// Only in `scalars` and `expect`: a result of the study's kind, by index in `study.results` (`turns_fully`, `kappa`, `residual`).
    Result(usize),
    /// Only in `scalars` and `expect` of motion in time: the work [`WORKS`] of this index, J.
    Work(usize),
    /// Brought by `take:` from another study, by index in `study.take`.
    Taken(usize),
}

/// Works of a motion in time: what has changed the energy of the mechanism.
pub const WORKS: [&str; 5] = ["work_drivers", "work_loads", "work_dampers", "work_stops", "work_impacts"];

/// How far the motion must be known for a quantity to be known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Known {
    /// Needs parameters alone.
    Constant,
    /// Needs t.
    Time,
    /// Needs the position.
    Position,
    /// Needs the velocity.
    Velocity,
    /// Needs accelerations or reactions.
    Acceleration,
    /// Known after a whole study.
    Study,
}

impl Quantity {
    /// What must be known for it to be known.
    #[must_use]
    pub fn level(self) -> Known {
        let by_order = |order| match order {
            0 => Known::Position,
            1 => Known::Velocity,
            _ => Known::Acceleration,
        };
        match self {
            Self::Time => Known::Time,
            Self::Point { order, .. }
            | Self::Angle { order, .. }
            | Self::Spin { order, .. }
            | Self::Quaternion { order, .. }
            | Self::Joint { order, .. }
            | Self::Stretch { order, .. }
            | Self::Com { order, .. } => by_order(order),
            Self::SpringEnergy { .. } | Self::Potential => Known::Position,
            Self::SpringForce { .. }
            | Self::MotorTorque { .. }
            | Self::Kinetic
            | Self::Momentum { .. }
            | Self::InertiaEq
            | Self::Bristle { .. }
            | Self::State(_) => Known::Velocity,
            Self::Shaking { .. } | Self::ShakingMoment { .. } | Self::InertiaEqSlope => Known::Acceleration,
            Self::Force { .. }
            | Self::Moment { .. }
            | Self::Friction { .. }
            | Self::ClutchEffort { .. }
            | Self::Stop { .. }
            | Self::DriverEffort { .. }
            | Self::DriverPower { .. }
            | Self::CouplingEffort { .. }
            | Self::Frame { .. }
            | Self::FrameMoment { .. } => Known::Acceleration,
            Self::Functional(_) | Self::Result(_) | Self::Work(_) | Self::Taken(_) => Known::Study,
        }
    }

    /// Whether it needs the forces that hold constraints and drivers, which a kinematic study does not find.
    #[must_use]
    pub fn is_reaction(self) -> bool {
        matches!(
            self,
            Self::Force { .. }
                | Self::Moment { .. }
                | Self::Friction { .. }
                | Self::ClutchEffort { .. }
                | Self::Stop { .. }
                | Self::DriverEffort { .. }
                | Self::DriverPower { .. }
                | Self::CouplingEffort { .. }
                | Self::Frame { .. }
                | Self::FrameMoment { .. }
        )
    }

    /// Whether springs must be known for it, so that no spring may be measured by it.
    #[must_use]
    pub fn needs_springs(self) -> bool {
        matches!(self, Self::Stretch { .. } | Self::SpringForce { .. } | Self::SpringEnergy { .. } | Self::Potential)
    }

    /// The quantity that is its time rate; `None` where there is none among the quantities (the rate of a state is an
    /// expression, `FirstOrder::rate`).
    #[must_use]
    pub fn rate(self) -> Option<Self> {
        Some(match self {
            Self::Point { at, axis, order: order @ 0..2 } => Self::Point { at, axis, order: order + 1 },
            Self::Angle { body, order: order @ 0..2 } => Self::Angle { body, order: order + 1 },
            // along its own axes too, d(Rᵀω)/dt = Rᵀω̇ − Rᵀ(ω × ω) = Rᵀω̇
            Self::Spin { body, axis, order: 1, own } => Self::Spin { body, axis, order: 2, own },
            Self::Quaternion { body, component, order: order @ 0..2 } => Self::Quaternion { body, component, order: order + 1 },
            Self::Joint { joint, slot, order: order @ 0..2 } => Self::Joint { joint, slot, order: order + 1 },
            Self::Stretch { spring, order: order @ 0..2 } => Self::Stretch { spring, order: order + 1 },
            Self::Com { axis, order: order @ 0..2 } => Self::Com { axis, order: order + 1 },
            Self::Momentum { axis } => Self::Shaking { axis },
            _ => return None,
        })
    }
}

/// Names of quantities of a body, which no point may have.
pub(crate) const BODY_QUANTITIES: [&str; 32] = [
    "x",
    "y",
    "z",
    "vx",
    "vy",
    "vz",
    "ax",
    "ay",
    "az",
    "speed",
    "a",
    "angle",
    "omega",
    "alpha",
    "rotation",
    "rpy",
    "wx",
    "wy",
    "wz",
    "qw",
    "qx",
    "qy",
    "qz",
    "alphax",
    "alphay",
    "alphaz",
    "wx_own",
    "wy_own",
    "wz_own",
    "alphax_own",
    "alphay_own",
    "alphaz_own",
];
