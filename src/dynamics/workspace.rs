//! The scratch of one evaluator, grouped by the stage that fills it. Sized once; no evaluation allocates.

use super::patterns::{mass_pattern, row_pattern};
use crate::expression::Integral;
use crate::geometry::{Force, Inertia, Motion, Pose, Quaternion, Space};
use crate::mechanism::{Measured, Mechanism, Reading, StagedProgram};
use crate::scalar::Scalar;
use grashof_solvers::{Block, Sparsity};

/// What evaluations leave behind, for the state that was evaluated last.
#[derive(Clone, Debug)]
pub struct Workspace<G: Space> {
    // ---- time: written by `Dynamics::time`
    /// Laws of time with their first two rates: f, f', f'' of each driver, rests of springs that move.
    pub motions: Vec<G::S>,
    /// ν (rows): f' in the rows of drivers; from `Dynamics::position` on −e_t in those of functions of time; else 0.
    pub nu: Vec<G::S>,

    // ---- position: written by `Dynamics::position`
    /// Reference point of each group in the world: moments, twists and inertias of its bodies are about it.
    pub references: Vec<G::Vector>,
    /// Pose of each body, its place from the reference point of its group; that of the ground is not used.
    pub places: Vec<Pose<G>>,
    /// Unit twist of each velocity column in the world (nv).
    pub columns: Vec<Motion<G>>,
    /// Unit quaternion of each body, if there is a gauge of one; where no row or force needs it written by `Dynamics::watch` alone.
    pub quaternions: Vec<Quaternion<G::S>>,
    /// Those of the frames before and behind the joint of each node.
    pub(super) turned: Vec<[Quaternion<G::S>; 2]>,
    /// Small displacement of each body, in [`Dynamics::nudge`](super::Dynamics::nudge).
    pub(super) moved: Vec<Motion<G>>,
    /// Where each contact is held, rad or m: written by the caller before `position`, if a row holds it.
    pub held: Vec<G::S>,
    /// Gauge readings; `x` and `wrench` from here on.
    pub readings: Vec<Reading<G>>,
    /// Functions and their partial derivatives by gauges and time (outputs of the position program).
    pub functions: Vec<G::S>,
    /// Φ (rows).
    pub phi: Vec<G::S>,
    /// G (rows × nv).
    pub g: Block<G::S>,

    // ---- velocity: written by `Dynamics::velocity`
    /// Twist of each body.
    pub twists: Vec<Motion<G>>,
    /// Acceleration of each body at a = 0: Σ ṡ_k v_k.
    pub bias: Vec<Motion<G>>,
    /// Drifts of the functions.
    pub drifts: Vec<G::S>,
    /// γ (rows).
    pub gamma: Vec<G::S>,

    // ---- dynamics: written by `Dynamics::forces` and `Dynamics::mass`
    /// Inertia of each body.
    pub inertias: Vec<Inertia<G>>,
    /// Inertia of each body with all that hangs on it.
    pub composite: Vec<Inertia<G>>,
    /// Applied wrench of each body: gravity and loads at points.
    pub applied: Vec<Force<G>>,
    /// I A + V ×* I V − applied of each body, at the accelerations given last (bias alone in `forces`).
    pub unbalanced: Vec<Force<G>>,
    /// Size of each effort, along its gauge or function.
    pub efforts: Vec<G::S>,
    /// Signs of the forces at the places where friction by reactions acts.
    pub(super) sides: Vec<f64>,
    /// Outputs of the force program.
    pub force_outputs: Vec<G::S>,
    /// First-order states z (nz): written by the caller before `loads`.
    pub z: Vec<G::S>,
    /// ż (nz).
    pub zdot: Vec<G::S>,
    /// Whether a program had an output that the branch of its modes does not define, so that it is that of another one.
    pub beyond: bool,
    /// Right-hand side f (nv).
    pub force: Vec<G::S>,
    /// Mass matrix M (nv × nv).
    pub mass: Block<G::S>,
    /// What [`Dynamics::mass`](super::Dynamics::mass) writes in it, in its order: the other column, and the places of the entry and the one
    /// across the diagonal; empty where the matrix is full.
    pub(super) mass_places: Vec<[u32; 3]>,
    /// How many of them belong to each column, in that order.
    pub(super) mass_roads: Vec<u32>,
    /// Wrench sums along the tree.
    pub(super) sums: Vec<Force<G>>,

    // ---- scratch of the rows and of the programs
    /// A row of G.
    pub(super) line: Vec<G::S>,
    pub(super) inputs: Vec<G::S>,
    pub(super) registers: Vec<G::S>,
    /// Of the integrals over the laws of springs.
    pub(super) integral: Integral,
    /// A spring whose energy was not resolved.
    pub(super) unresolved_spring: Option<usize>,
}

impl<G: Space> Workspace<G> {
    /// Scratch for a mechanism.
    #[must_use]
    pub fn new(mechanism: &Mechanism<G>) -> Self {
        Self::with(mechanism, &mass_pattern(mechanism))
    }

    /// Scratch of evaluators that are never asked for M.
    #[must_use]
    pub(super) fn without_mass(mechanism: &Mechanism<G>) -> Self {
        Self::with(mechanism, &Sparsity::empty(mechanism.nv, mechanism.nv))
    }

    fn with(mechanism: &Mechanism<G>, of_mass: &Sparsity) -> Self {
        let (bodies, nv, rows) = (mechanism.bodies.len(), mechanism.nv, mechanism.rows.len());
        let zeros = |n: usize| vec![G::S::constant(0.0); n];
        let laws = mechanism.spring_laws.iter().flatten();
        let most = |f: fn(&StagedProgram) -> usize| mechanism.programs().into_iter().chain(laws.clone()).map(f).max().unwrap_or(0);
        let needs_quaternions = mechanism.gauges.iter().any(|g| matches!(g.measured, Measured::Quaternion { .. }));
        let turned = mechanism.nodes.iter().filter(|_| needs_quaternions).map(|node| {
            let after = node.after.map_or_else(Quaternion::identity, |pose| Quaternion::of_rotation::<G>(pose.r));
            [Quaternion::of_rotation::<G>(node.before.r), after]
        });
        let (mass_places, mass_roads) = mass_places(mechanism, of_mass);
        Self {
            motions: zeros(mechanism.time_program.outputs),
            references: vec![G::Vector::default(); mechanism.groups.len()],
            places: vec![Pose::identity(); bodies],
            columns: vec![Motion::default(); nv],
            quaternions: vec![Quaternion::identity(); if needs_quaternions { bodies } else { 0 }],
            turned: turned.collect(),
            moved: vec![Motion::default(); bodies],
            held: zeros(mechanism.contacts.len()),
            readings: vec![Reading::default(); mechanism.gauges.len()],
            functions: zeros(mechanism.position_program.outputs),
            phi: zeros(rows),
            g: Block::new(&row_pattern(mechanism)),
            twists: vec![Motion::default(); bodies],
            bias: vec![Motion::default(); bodies],
            drifts: zeros(mechanism.velocity_program.outputs),
            nu: zeros(rows),
            gamma: zeros(rows),
            inertias: vec![Inertia::default(); bodies],
            composite: vec![Inertia::default(); bodies],
            applied: vec![Force::default(); bodies],
            unbalanced: vec![Force::default(); bodies],
            efforts: zeros(mechanism.efforts.len()),
            sides: vec![1.0; mechanism.pressings.iter().map(|p| p.places.len()).sum()],
            force_outputs: zeros(mechanism.force_program.outputs),
            z: mechanism.state_starts.iter().map(|z| G::S::constant(*z)).collect(),
            zdot: zeros(mechanism.state_starts.len()),
            beyond: false,
            force: zeros(nv),
            mass_places,
            mass_roads,
            mass: Block::new(of_mass),
            sums: vec![Force::default(); bodies],
            line: zeros(nv),
            inputs: zeros(most(|p| p.inputs)),
            registers: zeros(most(|p| p.program.registers())),
            integral: Integral::new(laws.clone().map(|law| &law.program), mechanism.force_program.inputs, mechanism.switches),
            unresolved_spring: None,
        }
    }
}

/// Places in M of each column with those on its road, from the last node to the first, and the number of them for each; none if the
/// matrix is full.
fn mass_places<G: Space>(m: &Mechanism<G>, pattern: &Sparsity) -> (Vec<[u32; 3]>, Vec<u32>) {
    let (mut places, mut roads) = (Vec::new(), Vec::new());
    if pattern.is_full() {
        return (places, roads);
    }
    for k in m.nodes.iter().rev().flat_map(|node| node.columns.clone()) {
        let before = places.len();
        let pair = |j: usize| Some([j, pattern.place(j, k)?, pattern.place(k, j)?].map(|x| x as u32));
        places.extend(m.road(Some(k)).filter_map(pair));
        roads.push((places.len() - before) as u32);
    }
    (places, roads)
}
