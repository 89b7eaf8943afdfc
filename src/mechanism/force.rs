//! What pulls and drives: efforts along gauges, loads at points, rotors, drivers, and the programs that give their sizes.

use crate::expression::{Cause, Id, Program};
use crate::geometry::Space;
use crate::scalar::Scalar;

/// Where a program's input comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaf {
    /// Time.
    Time,
    /// Gauge value (order 0), rate (1) or drift (2).
    Gauge {
        /// The gauge.
        gauge: usize,
        /// 0, 1 or 2.
        order: usize,
    },
    /// Stretch of a spring (order 0) or its rate (1).
    Stretch {
        /// The spring.
        spring: usize,
        /// 0 or 1.
        order: usize,
    },
    /// Component of a body's angular velocity.
    Spin {
        /// The body.
        body: usize,
        /// 0 x, 1 y, 2 z.
        axis: usize,
        /// In the axes of the body instead of the world's.
        own: bool,
    },
    /// A first-order state.
    State(usize),
}

/// A program with the sources of its inputs.
#[derive(Clone, Debug)]
pub struct StagedProgram {
    /// The code; its inputs are indexed as in the model.
    pub program: Program,
    /// (input, source) for each input that the code reads.
    pub fills: Vec<(usize, Leaf)>,
    /// Size of the input vector.
    pub inputs: usize,
    /// Number of outputs.
    pub outputs: usize,
    /// What each output belongs to, as a path of keys in the model file.
    pub places: Vec<String>,
}

/// A law of a driver, a coupling, a force or the rate of a state that is undefined.
#[derive(Clone, Debug, PartialEq)]
pub struct Undefined {
    /// What it belongs to, as a path of keys in the model file.
    pub place: String,
    /// Why.
    pub cause: Cause,
}

impl StagedProgram {
    /// Why an output is undefined, if that is the fault of its own expression and not of an input.
    #[must_use]
    pub fn undefined(&self, output: usize, inputs: &[f64], modes: &[i32]) -> Option<Undefined> {
        match self.program.cause(output, inputs, modes)? {
            Cause::Input(_) => None,
            cause => Some(Undefined { place: self.places[output].clone(), cause }),
        }
    }
}

/// An output of a staged program before it is compiled.
#[derive(Clone, Debug)]
pub(super) struct Output {
    /// Its value.
    pub(super) value: Id,
    /// What it belongs to, as a path of keys in the model file.
    pub(super) place: String,
}

/// A driver: its gauge, and the outputs f, f', f'' of the time program.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// The gauge that follows.
    pub gauge: usize,
    /// Its row.
    pub row: usize,
    /// Output of the time program that is f; f' and f'' follow.
    pub output: usize,
    /// The speed if it is constant: f = speed · t needs no program.
    pub speed: Option<f64>,
    /// Whether its speed is the same at all times.
    pub steady: bool,
    /// True if an angle is driven.
    pub turns: bool,
}

/// What a spring stretches: x − rest.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<G: Space> {
    /// What is measured.
    pub of: StretchOf,
    /// Free length or rest angle; 0 if it moves.
    pub rest: G::S,
    /// Output of the time program that is a rest that moves; its first two rates follow.
    pub moving: Option<usize>,
}

/// What a spring or an effort works along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StretchOf {
    /// A gauge.
    Gauge(usize),
    /// A function of gauges.
    Function(usize),
}

/// A force along a gauge or a function of gauges, positive where it drives x up.
#[derive(Clone, Debug)]
pub struct Effort<G: Space> {
    /// What it works along.
    pub along: StretchOf,
    /// Its size.
    pub law: EffortLaw<G>,
}

/// Size of an effort.
#[derive(Clone, Copy, Debug)]
pub enum EffortLaw<G: Space> {
    /// −(k (x − rest) + preload) − d ẋ.
    Linear {
        /// k, N/m or N m/rad.
        stiffness: G::S,
        /// Free length.
        rest: G::S,
        /// d, N s/m or N m s/rad.
        damping: G::S,
        /// Force at zero stretch.
        preload: G::S,
    },
    /// −F − d ṡ: a spring whose force F by the stretch s is given by a program, with what is constant in it.
    Law {
        /// The spring.
        spring: usize,
        /// Output of the force program that is F; d follows, and ∂F/∂t at fixed s if time is in it.
        output: usize,
        /// Whether time is in F.
        timed: bool,
    },
    /// +output: a load or motor on a joint.
    Drive {
        /// Output of the force program.
        output: usize,
    },
    /// Dry friction: +output, or where the joint presses by its reaction, +output · N.
    Friction {
        /// Output of the force program, against the motion: N or N m, or that per newton of the normal force N.
        output: usize,
        /// What makes N, among `Mechanism::pressings`.
        pressing: Option<usize>,
    },
}

/// The normal force N = Σ |n| (N) between the bodies of a joint that is cut: what its rows put on the places where it has friction.
///
/// The rows of a cut joint are forces along unit directions of a triad, and couples about them, so that the components of the force
/// at a place are sums of multipliers with coefficients that do not depend on the position. The force is that on the second body.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressing {
    /// The joint.
    pub joint: usize,
    /// Places where the bodies touch: the one of a pin or a short shoe, the two ends of a guide.
    pub places: Vec<Pressed>,
}

/// The force at one place of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    /// Its components, each a sum over (row, coefficient) of coefficient · λ.
    pub components: Vec<Vec<(usize, f64)>>,
    /// Mode that holds the sign of the only component, −1 or not; with several there is no switch: N is their Euclidean length.
    pub side: usize,
}

/// A rotor that turns with a gauge: ½ J ẋ².
#[derive(Clone, Copy, Debug)]
pub struct Rotor<G: Space> {
    /// The gauge.
    pub gauge: usize,
    /// J, kg m².
    pub inertia: G::S,
}

/// A rigid stop: one end of the way of a joint's coordinate, or one side of the function of an event with impacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The joint whose rate is thrown back.
    pub joint: usize,
    /// The gauge of its coordinate.
    pub gauge: usize,
    /// What ends: that gauge, or the function of an event, if it is one of positions alone; else nothing can rest there.
    pub along: Option<StretchOf>,
    /// The event that it belongs to.
    pub event: Option<usize>,
    /// Whether the coordinate is an angle.
    pub angular: bool,
    /// The end, rad or m; 0 for an event.
    pub at: f64,
    /// 1 at the lower end, −1 at the upper: the sense in which the stop pushes.
    pub sense: f64,
    /// Rate behind a blow by rate before it, 0 to 1; an event knows it only when it happens.
    pub restitution: f64,
    /// A rebound below this rate counts as rest, rad/s or m/s.
    pub rest_speed: f64,
}

impl Stop {
    /// Way that is left to the stop, rad or m; negative beyond it.
    #[must_use]
    pub fn gap(&self, x: f64) -> f64 {
        self.sense * (x - self.at)
    }

    /// What lengths, or angles, count in: 1 rad, or the size of the mechanism, m.
    #[must_use]
    pub fn size(&self, mechanism: f64) -> f64 {
        if self.angular { 1.0 } else { mechanism }
    }

    /// Its name: "lower stop".
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self.event {
            Some(_) => "impact",
            None if self.sense > 0.0 => "lower stop",
            None => "upper stop",
        }
    }
}

/// End stops that give way: ½ k d² where the coordinate is by d beyond an end. Their force is an effort.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer {
    /// The joint.
    pub joint: usize,
    /// The effort.
    pub effort: usize,
    /// The gauge of the coordinate.
    pub gauge: usize,
    /// Each end, rad or m, with the sense in which it pushes: 1 at the lower end, −1 at the upper.
    pub ends: Vec<(f64, f64)>,
    /// k, N m/rad or N/m.
    pub stiffness: f64,
}

impl Buffer {
    /// Energy ½ k d² (J) and its slope by the coordinate, at x.
    #[must_use]
    pub fn energy<S: Scalar>(&self, x: S) -> (S, S) {
        let (mut energy, mut slope) = (S::default(), S::default());
        for &(at, sense) in &self.ends {
            let depth = (S::constant(at) - x).scale(sense);
            if depth.value() > 0.0 {
                energy += (depth * depth).scale(0.5 * self.stiffness);
                slope -= depth.scale(sense * self.stiffness);
            }
        }
        (energy, slope)
    }
}

/// A load at a point of a body.
#[derive(Clone, Debug)]
pub struct PointLoad<G: Space> {
    /// The body.
    pub body: usize,
    /// The point in the body frame, m.
    pub at: G::Vector,
    /// Outputs of the force program: components of the force, then of the torque, in the axes of `frame`; absent ones are 0.
    pub force: Vec<usize>,
    /// Outputs that are the torque: planar z, spatial x, y, z.
    pub torque: Vec<usize>,
    /// The body whose axes the components are in; 0 is the world.
    pub frame: usize,
    /// The axes of the components in that body, if they are not its own.
    pub axes: Option<G::Rotation>,
    /// Output that is the potential energy of the load, J: a field of gravity that has one.
    pub potential: Option<usize>,
}

impl<G: Space> Stretch<G> {
    pub(super) fn lift<D: Scalar>(&self, constant: impl Fn(G::S) -> D) -> Stretch<G::Lift<D>> {
        Stretch { of: self.of, rest: constant(self.rest), moving: self.moving }
    }
}

impl<G: Space> Effort<G> {
    pub(super) fn lift<D: Scalar>(&self, c: impl Fn(G::S) -> D) -> Effort<G::Lift<D>> {
        let law = match self.law {
            EffortLaw::Linear { stiffness, rest, damping, preload } => {
                EffortLaw::Linear { stiffness: c(stiffness), rest: c(rest), damping: c(damping), preload: c(preload) }
            }
            EffortLaw::Law { spring, output, timed } => EffortLaw::Law { spring, output, timed },
            EffortLaw::Drive { output } => EffortLaw::Drive { output },
            EffortLaw::Friction { output, pressing } => EffortLaw::Friction { output, pressing },
        };
        Effort { along: self.along, law }
    }
}

impl<G: Space> PointLoad<G> {
    pub(super) fn lift<D: Scalar>(&self) -> PointLoad<G::Lift<D>> {
        PointLoad {
            body: self.body,
            at: G::lift_vector::<D>(self.at),
            force: self.force.clone(),
            torque: self.torque.clone(),
            frame: self.frame,
            axes: self.axes.map(G::lift_rotation::<D>),
            potential: self.potential,
        }
    }
}
