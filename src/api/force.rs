//! Force laws of one's own between points of a mechanism.

use super::error::Error;
use crate::dynamics::Dynamics;
use crate::geometry::{self, Space};
use crate::mechanism;
use crate::results::Unknown;
use grashof_solvers::{At, Force};
use nalgebra::{Matrix3, Vector3};
use std::fmt;
use std::sync::Arc;

/// How a point of a body moves, world axes; in the plane z is 0 but for the spin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointMotion {
    /// Its place, m.
    pub position: Vector3<f64>,
    /// Its velocity, m/s.
    pub velocity: Vector3<f64>,
    /// The axes of its body as columns.
    pub rotation: Matrix3<f64>,
    /// Angular velocity of its body, rad/s.
    pub spin: Vector3<f64>,
}

/// What acts at a point, world axes; in the plane only x and y of the force and z of the moment count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force: Vector3<f64>,
    /// Moment, N m.
    pub moment: Vector3<f64>,
}

/// A law: what acts at each of its points at a time, s, by how they move.
pub(super) type Law = dyn Fn(f64, &[PointMotion], &mut [Wrench]) + Send + Sync;

/// A law and its points.
#[derive(Clone)]
pub(super) struct Element {
    /// Body and index in its points.
    points: Vec<(usize, usize)>,
    law: Arc<Law>,
}

impl fmt::Debug for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Element").field("points", &self.points).finish_non_exhaustive()
    }
}

impl Element {
    /// The element between points by their names: `rocker.tip`, or a body for its origin.
    pub(super) fn new<G: Space>(m: &mechanism::Mechanism<G>, points: &[&str], law: Arc<Law>) -> Result<Self, Error> {
        let points = points.iter().map(|name| named(m, name)).collect::<Result<_, _>>()?;
        Ok(Self { points, law })
    }
}

/// Body and point of a name.
fn named<G: Space>(m: &mechanism::Mechanism<G>, name: &str) -> Result<(usize, usize), Error> {
    let (body, point) = name.split_once('.').unwrap_or((name, "origin"));
    let found = m.bodies.iter().position(|b| b.name == body);
    let found = found.and_then(|b| Some((b, m.bodies[b].points.iter().position(|(known, _)| known == point)?)));
    found.ok_or_else(|| {
        let all = m.bodies.iter().flat_map(|b| b.points.iter().map(|(point, _)| format!("{}.{point}", b.name)));
        Unknown { what: "point", name: name.into(), known: all.collect() }.into()
    })
}

/// The elements of a mechanism as forces along its velocities.
pub(super) struct Elements<'m, G: Space<S = f64>> {
    dynamics: Dynamics<'m, G>,
    elements: &'m [Element],
    motions: Vec<PointMotion>,
    wrenches: Vec<Wrench>,
    on_bodies: Vec<geometry::Force<G>>,
}

impl<'m, G: Space<S = f64>> Elements<'m, G> {
    pub(super) fn new(mechanism: &'m mechanism::Mechanism<G>, elements: &'m [Element]) -> Self {
        let on_bodies = vec![geometry::Force::default(); mechanism.bodies.len()];
        Self { dynamics: Dynamics::new(mechanism), elements, motions: Vec::new(), wrenches: Vec::new(), on_bodies }
    }

    fn motion(&self, (body, point): (usize, usize)) -> PointMotion {
        let d = &self.dynamics;
        let at = d.mechanism.bodies[body].points[point].1;
        let (position, pose) = (d.point(body, at), d.pose(body));
        let (velocity, spin) = if body == 0 { Default::default() } else { (d.point_velocity(body, at), d.work.twists[body].w) };
        PointMotion {
            position: Vector3::from_fn(|axis, _| G::component(position, axis)),
            velocity: Vector3::from_fn(|axis, _| G::component(velocity, axis)),
            rotation: Matrix3::from_fn(|i, k| G::entry(pose.r, i, k)),
            spin: Vector3::from_fn(|axis, _| G::spin_component(spin, axis)),
        }
    }
}

impl<G: Space<S = f64>> Force for Elements<'_, G> {
    fn add(&mut self, at: At<'_>, force: &mut [f64]) {
        self.dynamics.work.held.copy_from_slice(at.live);
        self.dynamics.time(at.t, at.modes);
        self.dynamics.position(at.q, at.modes);
        self.dynamics.velocity(at.v, at.modes);
        self.on_bodies.fill(geometry::Force::default());
        for element in self.elements {
            let mut motions = std::mem::take(&mut self.motions);
            motions.clear();
            motions.extend(element.points.iter().map(|&point| self.motion(point)));
            self.motions = motions;
            self.wrenches.clear();
            self.wrenches.resize(element.points.len(), Wrench::default());
            (element.law)(at.t, &self.motions, &mut self.wrenches);
            for (&(body, point), wrench) in element.points.iter().zip(&self.wrenches).filter(|((body, _), _)| *body != 0) {
                let force = G::from_components(wrench.force.into());
                let moment = G::spin(wrench.moment.into());
                self.on_bodies[body] += self.dynamics.wrench(body, self.dynamics.mechanism.bodies[body].points[point].1, force, moment);
            }
        }
        self.dynamics.add_wrenches(&mut self.on_bodies, force);
    }
}
