//! What a mechanism is before anything moves: masses, topology, freedom, start.

use super::assemble::Found;
use super::crossing::begins_in_change_point;
use super::held::settled;
use super::mobility::{Grashof, Mobility, grashof, loose, mobility};
use super::undefined::{assembled, in_state};
use crate::dynamics::Dynamics;
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::{Coordinates, describe_loop};
use crate::model::{Dimensions, LoadOn, Model, Quantity, SpringOn, StartValue, coordinates_of};
use crate::results::{Failure, Finding};
use crate::scalar::Scalar;

/// A mechanism looked over at its start.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Bodies: name, mass in kg, centre of mass in the body frame in m, inertia about it in kg m² (Ixx, Iyy, Izz; planar Izz alone).
    pub bodies: Vec<(String, f64, Vec<f64>, Vec<f64>)>,
    /// Joints: name, kind, first body, second body, and whether it carries the tree (else it is cut and closes a loop).
    pub joints: Vec<(String, &'static str, String, String, bool)>,
    /// Loops that cut joints close, as paths of names.
    pub loops: Vec<String>,
    /// Coordinates, velocities and constraint rows.
    pub sizes: (usize, usize, usize),
    /// Freedom and rank.
    pub mobility: Mobility,
    /// The class of a four-bar.
    pub grashof: Option<Grashof>,
    /// Start asked and found.
    pub start: Vec<Found>,
    /// Where all joints stand at the start: the joint, by its index, the name of its coordinate, its value and unit.
    pub stands: Vec<(usize, &'static str, f64, &'static str)>,
    /// Bodies that no joint leads to and nothing else of the model names.
    pub forgotten: Vec<String>,
    /// Distances without a length, by the names of their joints: those at the start, m.
    pub lengths: Vec<(String, f64)>,
    /// What the start is, if it is a special one.
    pub findings: Vec<Finding>,
}

/// Looks a model over at given parameters.
///
/// # Errors
/// If it has no mechanism or cannot be assembled.
pub fn survey(model: &Model, parameters: &[f64]) -> Result<Survey, Failure> {
    match model.space {
        Dimensions::Planar => survey_in::<Planar<f64>>(model, parameters),
        Dimensions::Spatial => survey_in::<Spatial<f64>>(model, parameters),
    }
}

fn survey_in<G: Space<S = f64>>(model: &Model, parameters: &[f64]) -> Result<Survey, Failure> {
    let (mechanism, start) = assembled::<G>(model, parameters, Coordinates::Joint)?;
    let state = [&start.q[..], &start.v, &mechanism.state_starts];
    let modes = settled(&mechanism, state, &start.modes);
    if let Some(undefined) = in_state(model, &mechanism, state, &modes, "the start") {
        return Err(Failure::Undefined(undefined));
    }
    let m = &mechanism;
    let diagonal = |tensor: G::Tensor| -> Vec<f64> {
        let axes: &[usize] = if G::SPIN == 1 { &[2] } else { &[0, 1, 2] };
        let along = |&k: &usize| {
            let mut e = [0.0; 3];
            e[k] = 1.0;
            G::spin_component(G::apply(tensor, G::spin(e)), k).value()
        };
        axes.iter().map(along).collect()
    };
    let name = |b: usize| m.bodies[b].name.clone();
    let mut dynamics = Dynamics::new(m);
    dynamics.time(0.0, &modes);
    dynamics.position(&start.q, &modes);
    dynamics.velocity(&start.v, &modes);
    dynamics.watch(&start.q, &start.v, &modes);
    Ok(Survey {
        bodies: m
            .bodies
            .iter()
            .skip(1)
            .map(|b| {
                let com = (0..G::VECTOR).map(|i| G::component(b.mass.com, i)).collect();
                (b.name.clone(), b.mass.mass, com, diagonal(b.mass.inertia))
            })
            .collect(),
        joints: m.joints.iter().map(|j| (j.name.clone(), j.kind, name(j.a.0), name(j.b.0), j.tree.is_some())).collect(),
        loops: m.joints.iter().filter(|j| j.tree.is_none()).map(|j| describe_loop(m, j)).collect(),
        sizes: (m.nq, m.nv, m.rows.len()),
        mobility: mobility(m, &start),
        grashof: grashof(m).map(|mut found| {
            found.near(dynamics.work.readings[m.joints[found.input].slots[0]].x);
            found
        }),
        lengths: m
            .joints
            .iter()
            .filter_map(|j| Some((j.name.clone(), m.rows[j.rows.clone()].iter().find(|row| row.anchored)?.offset)))
            .collect(),
        findings: start.findings().chain(begins_in_change_point(m, &start)).collect(),
        stands: model
            .joints
            .iter()
            .enumerate()
            .flat_map(|(i, joint)| coordinates_of(&joint.kind).iter().map(move |coordinate| (i, coordinate)))
            // a point mass that is pinned has no angle
            .filter_map(|(i, c)| {
                let slot = *m.joints[i].slots.get(c.slot)?;
                Some((i, c.names[0], dynamics.work.readings[slot].x, if c.angle { "rad" } else { "m" }))
            })
            .collect(),
        start: start.found,
        forgotten: loose(m).into_iter().filter(|name| !is_named(model, name)).map(str::to_owned).collect(),
    })
}

/// Whether a start value, a load or a spring names a body: then it is meant to be free.
fn is_named(model: &Model, name: &str) -> bool {
    let is = |body: usize| model.bodies[body].name == name;
    let start = model.start.iter().any(|s| match s.quantity {
        Quantity::Point { at, .. } => is(at.body),
        Quantity::Angle { body, .. } | Quantity::Spin { body, .. } | Quantity::Quaternion { body, .. } => is(body),
        _ => matches!(s.value, StartValue::Rotation { .. }) && s.name.split('.').next() == Some(name),
    });
    let load = model.loads.iter().any(|l| matches!(&l.on, LoadOn::Point { at, .. } if is(at.body)));
    let spring = model.springs.iter().any(|s| matches!(&s.on, SpringOn::Between(a, b) if is(a.body) || is(b.body)));
    start || load || spring
}
