//! A mechanism to evaluate by hand.

use super::error::Error;
use super::evaluator::Evaluator;
use super::force::{Element, Elements, PointMotion, Wrench};
use super::simulation::Simulation;
use super::state::{settle, sized};
use crate::dynamics::{Differentiable, Dynamics};
use crate::geometry::{Planar, Space, Spatial};
use crate::kinematics::assemble::Assembled;
use crate::kinematics::coordinates::coordinates;
use crate::kinematics::undefined::assembled;
use crate::mechanism::Coordinates;
use crate::model::{Dimensions, Model};
use crate::results::{Failure, Unknown};
use crate::studies::common::case::parameters;
use crate::studies::common::observe::Observer;
use crate::studies::dynamics::system::Mechanical;
use grashof_solvers::{Loaded, Scheme, Settings, State, System};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::sync::Arc;

/// A mechanism assembled at its start, with nq coordinates q, nv velocities v and m constraint rows.
///
/// Velocities are the rates of coordinates but for joints that turn about a point: their four coordinates are a quaternion, their three
/// velocities the angular velocity of the second body. SI units and radians.
#[derive(Clone, Debug)]
pub struct Mechanism {
    model: Model,
    of: Of,
    elements: Vec<Element>,
}

/// In the plane or in space.
#[derive(Clone, Debug)]
enum Of {
    Planar(Box<Built<Planar<f64>>>),
    Spatial(Box<Built<Spatial<f64>>>),
}

#[derive(Clone, Debug)]
struct Built<G: Space<S = f64>> {
    mechanism: Differentiable<G>,
    start: Assembled,
}

/// What is the same in the plane and in space.
macro_rules! built {
    ($self:expr, $built:ident => $what:expr) => {
        match &$self.of {
            Of::Planar($built) => $what,
            Of::Spatial($built) => $what,
        }
    };
}

/// The terms of M(q) a + Gᵀλ = f(t, q, v), Φ(t, q) = 0, G v = ν, G a = γ in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms {
    /// M (nv × nv).
    pub mass: DMatrix<f64>,
    /// f (nv): all applied forces and those of Coriolis; what depends on reactions is not in it.
    pub force: DVector<f64>,
    /// Φ (m).
    pub phi: DVector<f64>,
    /// G (m × nv).
    pub g: DMatrix<f64>,
    /// ν (m).
    pub nu: DVector<f64>,
    /// γ (m).
    pub gamma: DVector<f64>,
}

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Place of its origin, m.
    pub position: Vector3<f64>,
    /// Its axes as columns.
    pub rotation: Matrix3<f64>,
}

impl Mechanism {
    pub(super) fn new(model: Model) -> Result<Self, Failure> {
        let of = match model.space {
            Dimensions::Planar => Of::Planar(Box::new(Built::new(&model)?)),
            Dimensions::Spatial => Of::Spatial(Box::new(Built::new(&model)?)),
        };
        Ok(Self { model, of, elements: Vec::new() })
    }

    /// The same with a force law of one's own between points, `rocker.tip` or a body for its origin: `law` takes the time, s, and the
    /// motion of each point, and writes what acts at each. It has to be smooth in the motion; what switches belongs into the model file.
    ///
    /// # Errors
    /// If there is no such point.
    pub fn with_force<L>(mut self, points: &[&str], law: L) -> Result<Self, Error>
    where
        L: Fn(f64, &[PointMotion], &mut [Wrench]) + Send + Sync + 'static,
    {
        let law = Arc::new(law);
        let element = built!(self, b => Element::new(&b.mechanism, points, law))?;
        self.elements.push(element);
        Ok(self)
    }

    /// Names of the coordinates behind the velocities (nv): `O.angle`; parts of a turn are `ball.turn_x`.
    #[must_use]
    pub fn coordinates(&self) -> Vec<String> {
        built!(self, b => coordinates(&self.model, &b.mechanism)).into_iter().map(|c| c.name).collect()
    }

    /// Coordinates and velocities of the start.
    #[must_use]
    pub fn start(&self) -> (Vec<f64>, Vec<f64>) {
        built!(self, b => (b.start.q.clone(), b.start.v.clone()))
    }

    /// Numbers of coordinates, velocities and constraint rows.
    #[must_use]
    pub fn sizes(&self) -> (usize, usize, usize) {
        built!(self, b => (b.mechanism.nq, b.mechanism.nv, b.mechanism.rows.len()))
    }

    /// The terms of the equations of motion in a state.
    ///
    /// # Errors
    /// If q or v have other sizes than those of the mechanism.
    pub fn terms(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Terms, Error> {
        let mut evaluator = self.evaluator();
        let terms = evaluator.terms(t, q, v)?;
        let (_, nv, m) = self.sizes();
        Ok(Terms {
            mass: DMatrix::from_row_slice(nv, nv, &terms.mass.to_dense()),
            force: DVector::from_column_slice(&terms.force),
            phi: DVector::from_column_slice(&terms.phi),
            g: DMatrix::from_row_slice(m, nv, &terms.g.to_dense()),
            nu: DVector::from_column_slice(&terms.nu),
            gamma: DVector::from_column_slice(&terms.gamma),
        })
    }

    /// Accelerations a (nv) and multipliers λ (m) in a state. Friction that depends on reactions is left out.
    ///
    /// # Errors
    /// If q or v have other sizes than those of the mechanism; if mass is missing.
    pub fn accelerations(&self, t: f64, q: &[f64], v: &[f64]) -> Result<(DVector<f64>, DVector<f64>), Error> {
        let mut evaluator = self.evaluator();
        let (a, lambda) = evaluator.accelerations(t, q, v)?;
        Ok((DVector::from_column_slice(a), DVector::from_column_slice(lambda)))
    }

    /// Inverse dynamics: the forces along the velocities (nv) which, added to f, give accelerations `a`: M a + Gᵀλ − f.
    ///
    /// # Errors
    /// If an argument has another size than in the mechanism.
    pub fn inverse(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], lambda: &[f64]) -> Result<DVector<f64>, Error> {
        Ok(DVector::from_column_slice(self.evaluator().inverse(t, q, v, a, lambda)?))
    }

    /// The state on the constraints next to one: coordinates (nq) and velocities (nv), as [`Evaluator::project`].
    ///
    /// # Errors
    /// As there.
    pub fn project(&self, t: f64, q: &[f64], v: &[f64]) -> Result<(DVector<f64>, DVector<f64>), Error> {
        let mut evaluator = self.evaluator();
        let (q, v) = evaluator.project(t, q, v)?;
        Ok((DVector::from_column_slice(q), DVector::from_column_slice(v)))
    }

    /// What evaluates many states in memory that it takes once.
    #[must_use]
    pub fn evaluator(&self) -> Evaluator<'_> {
        let mut system = self.system();
        let begin = self.begin(&mut *system);
        Evaluator::new(system, begin)
    }

    /// Where a body is at a position.
    ///
    /// # Errors
    /// If there is no such body, or q has another size than that of the mechanism.
    pub fn placement(&self, body: &str, q: &[f64]) -> Result<Placement, Error> {
        sized("coordinates", q, self.sizes().0)?;
        let mut placed = Placement { position: Vector3::zeros(), rotation: Matrix3::identity() };
        self.placements(body, q, |at| placed = at)?;
        Ok(placed)
    }

    /// Where a body is at many positions, which follow each other in `q`; `each` is told in their order.
    ///
    /// # Errors
    /// If there is no such body, or q is no multiple of the coordinates of the mechanism.
    pub fn placements(&self, body: &str, q: &[f64], each: impl FnMut(Placement)) -> Result<(), Error> {
        built!(self, b => b.placements(body, q, each))
    }

    /// The motion from the start, to be advanced step by step.
    ///
    /// # Errors
    /// If the mechanism has events, rigid stops or exact friction, which a study of the kind `dynamics` follows; if its start cannot
    /// be made consistent.
    pub fn simulate(&self, settings: Settings) -> Result<Simulation<'_>, Error> {
        self.followed()?;
        let mut system = self.system();
        let begin = self.begin(&mut *system);
        Simulation::new(system, settings, None, begin)
    }

    /// [`Self::simulate`] by a scheme of one's own; `method` of the settings is not looked at.
    ///
    /// # Errors
    /// As there.
    pub fn simulate_by(&self, scheme: Box<dyn Scheme>, settings: Settings) -> Result<Simulation<'_>, Error> {
        self.followed()?;
        let mut system = self.system();
        let begin = self.begin(&mut *system);
        Simulation::new(system, settings, Some(scheme), begin)
    }

    /// The mechanism as the integrators see it: for schemes of one's own.
    #[must_use]
    pub fn system(&self) -> Box<dyn System + '_> {
        built!(self, b => b.system(&self.model, &self.elements))
    }

    /// Whether its motion is that of one mechanism from begin to end.
    fn followed(&self) -> Result<(), Error> {
        let holds = built!(self, b => !b.mechanism.stops.is_empty() || !b.mechanism.contacts.is_empty());
        if !holds && self.model.events.is_empty() {
            return Ok(());
        }
        Err(Error::Refused {
            message: "the mechanism has events, rigid stops or exact friction, which change it on the way".into(),
            help: "run a study of the kind `dynamics`".into(),
        })
    }

    /// The start, settled.
    fn begin(&self, system: &mut dyn System) -> State {
        let mut state = State::new(system.dims());
        built!(self, b => {
            state.q.copy_from_slice(&b.start.q);
            state.v.copy_from_slice(&b.start.v);
            state.z.copy_from_slice(&b.mechanism.state_starts);
            state.modes[..b.start.modes.len()].copy_from_slice(&b.start.modes);
        });
        let mut modes = state.modes.clone();
        settle(system, &mut state, &mut modes);
        state
    }
}

impl<G> Built<G>
where
    G: Space<S = f64>,
{
    fn new(model: &Model) -> Result<Self, Failure> {
        let (mechanism, start) = assembled::<G>(model, &parameters(model), Coordinates::Joint)?;
        Ok(Self { mechanism: Differentiable::new(mechanism), start })
    }

    fn system<'m>(&'m self, model: &Model, elements: &'m [Element]) -> Box<dyn System + 'm> {
        let observer = Observer::new(model, &self.mechanism, &parameters(model), &[]);
        let own = Box::new(Mechanical::new(&self.mechanism, &self.start, observer, Vec::new()));
        if elements.is_empty() {
            return own;
        }
        Box::new(Loaded::new(own, Box::new(Elements::new(&self.mechanism, elements))))
    }

    fn placements(&self, body: &str, q: &[f64], mut each: impl FnMut(Placement)) -> Result<(), Error> {
        let m = &self.mechanism;
        let index = m.bodies.iter().position(|b| b.name == body).ok_or_else(|| {
            Error::Unknown(Unknown { what: "body", name: body.into(), known: m.bodies.iter().map(|b| b.name.clone()).collect() })
        })?;
        let mut dynamics = Dynamics::new(m);
        dynamics.time(0.0, &self.start.modes);
        let mut place = |q: &[f64]| {
            dynamics.position(q, &self.start.modes);
            let pose = dynamics.pose(index);
            each(Placement {
                position: Vector3::from_fn(|axis, _| G::component(pose.p, axis)),
                rotation: Matrix3::from_fn(|i, k| G::entry(pose.r, i, k)),
            });
        };
        if m.nq == 0 {
            place(q);
            return sized("coordinates", q, 0);
        }
        let positions = q.chunks_exact(m.nq);
        sized("coordinates", positions.remainder(), 0)?;
        positions.for_each(place);
        Ok(())
    }
}
