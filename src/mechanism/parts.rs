//! A mechanism and its parts.

use super::step::multiply_quaternion;
use super::{
    Buffer, Contact, ContactLaw, Drive, Effort, Function, Gauge, Group, Joint, Orientation, Outline, PointLoad, Pressing, Rotor, Row,
    RowKind, RowOwner, Solid, StagedProgram, Start, Step, Stop, Stretch, StretchOf,
};
use crate::expression::LookupTable;
use crate::geometry::{MassProperties, Pose, Space};
use crate::scalar::Scalar;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// A body: its mass, its points and where it hangs in the tree.
#[derive(Clone, Debug)]
pub struct Body<G: Space> {
    /// Its name; `ground` for the first.
    pub name: String,
    /// With all that is attached.
    pub mass: MassProperties<G>,
    /// Without what is attached.
    pub bare: MassProperties<G>,
    /// Point masses and rotors.
    pub attached: Vec<Attached<G>>,
    /// Named points in the body frame, m; as in the model.
    pub points: Vec<(Cow<'static, str>, G::Vector)>,
    /// Points that outline it in drawings beside its joints and points, body frame, m.
    pub drawn: Vec<G::Vector>,
    /// Its shape, if the model gives one.
    pub outline: Option<Outline>,
    /// Solids that it is drawn as.
    pub solids: Box<[Solid]>,
    /// The last of the velocity columns that move it; none for what does not move. See [`Mechanism::path`].
    pub column: Option<usize>,
}

/// A mass on a body.
#[derive(Clone, Debug)]
pub struct Attached<G: Space> {
    /// Its name.
    pub name: String,
    /// Mass, place and inertia about its own centre.
    pub mass: MassProperties<G>,
}

/// A body's place in the tree.
#[derive(Clone, Debug)]
pub struct TreeNode<G: Space> {
    /// The body.
    pub body: usize,
    /// Its parent body, earlier in the order.
    pub parent: usize,
    /// Joint frame in the parent.
    pub before: Pose<G>,
    /// Whether `before` has a rotation.
    pub turned: bool,
    /// The joint's moving steps, in `Mechanism::steps`.
    pub steps: Range<usize>,
    /// Body frame in the moved joint frame, if it is another.
    pub after: Option<Pose<G>>,
    /// Velocity columns of the joint.
    pub columns: Range<usize>,
}

/// A mechanism over the space `G`.
#[derive(Clone, Debug)]
pub struct Mechanism<G: Space> {
    /// Bodies in file order; 0 is the ground.
    pub bodies: Vec<Body<G>>,
    /// Moving bodies, parents first.
    pub nodes: Vec<TreeNode<G>>,
    /// Groups of bodies, each with the reference point that moments are taken about; at least one.
    pub groups: Vec<Group<G>>,
    /// Group of each body; 0 for the ground, see [`Mechanism::group_between`].
    pub group_of: Vec<usize>,
    /// Moving steps of all tree joints.
    pub steps: Vec<Step<G>>,
    /// Number of coordinates.
    pub nq: usize,
    /// Number of velocities.
    pub nv: usize,
    /// For each velocity column the next one on the road to the ground; none for the last on it. See [`Mechanism::road`].
    pub above: Vec<Option<usize>>,
    /// Joints in file order.
    pub joints: Vec<Joint<G>>,
    /// The joint that each node carries; none for a body that is free of its own.
    pub joint_of_node: Vec<Option<usize>>,
    /// All gauges; the first `active_gauges` are those that rows and forces need.
    pub gauges: Vec<Gauge<G>>,
    /// See `gauges`.
    pub active_gauges: usize,
    /// Constraint rows.
    pub rows: Vec<Row<G>>,
    /// Relations and stretches given by expressions.
    pub functions: Vec<Function>,
    /// Drivers in file order.
    pub drives: Vec<Drive>,
    /// Springs in file order: what they stretch.
    pub stretches: Vec<Stretch<G>>,
    /// Asked start values.
    pub starts: Vec<Start>,
    /// Orientations of bodies that starts ask for.
    pub orientations: Vec<Orientation>,
    /// Forces along gauges.
    pub efforts: Vec<Effort<G>>,
    /// Which effort is a spring's elastic and damping force: `spring_efforts[spring]`.
    pub spring_efforts: Vec<usize>,
    /// Which effort is a motor's: `motor_efforts[motor]`, if it has a curve.
    pub motor_efforts: Vec<Option<usize>>,
    /// What presses on joints whose friction depends on their reactions.
    pub pressings: Vec<Pressing>,
    /// Which effort is a joint's friction: `friction_efforts[joint]`.
    pub friction_efforts: Vec<Option<usize>>,
    /// Efforts of clutches in file order.
    pub clutches: Vec<usize>,
    /// First-order state of a joint's bristles: `bristles[joint]`.
    pub bristles: Vec<Option<usize>>,
    /// End stops that give way.
    pub buffers: Vec<Buffer>,
    /// Rigid stops.
    pub stops: Vec<Stop>,
    /// Exact friction of joints and clutches, and one-way clutches.
    pub contacts: Vec<Contact>,
    /// Rotors that turn with gauges.
    pub rotors: Vec<Rotor<G>>,
    /// Loads at points.
    pub point_loads: Vec<PointLoad<G>>,
    /// Programs by stage: functions, drifts, drivers, forces.
    pub position_program: StagedProgram,
    /// Drifts of the functions.
    pub velocity_program: StagedProgram,
    /// Laws of time with their first two rates: f, f', f'' of each driver, then rests of springs that move.
    pub time_program: StagedProgram,
    /// Forces of loads, springs with laws and motors.
    pub force_program: StagedProgram,
    /// The law of each spring that has one by a program, alone: F, and ∂F/∂t where time is in it, by the stretch and time.
    pub spring_laws: Vec<Option<StagedProgram>>,
    /// ż of the first-order states.
    pub state_program: StagedProgram,
    /// First-order states at the start.
    pub state_starts: Vec<f64>,
    /// Tables of the model as numbers, shared with the programs of outputs.
    pub tables: Arc<[LookupTable]>,
    /// Gravity, m/s².
    pub gravity: G::Vector,
    /// Number of switches (`modes` begins with them; those of the model's expressions, then the signs of [`Pressed::side`](super::Pressed::side) and what one-way clutches do) and of
    /// winding numbers (they follow).
    pub switches: usize,
    /// Number of winding numbers; the signs of quaternions are counted among them.
    pub windings: usize,
}

impl<G: Space> Mechanism<G> {
    /// Gives back the room that lists which are long in large mechanisms were grown by and do not need.
    pub(super) fn release_spare_room(&mut self) {
        self.bodies.shrink_to_fit();
        self.nodes.shrink_to_fit();
        self.steps.shrink_to_fit();
        self.above.shrink_to_fit();
        self.joints.shrink_to_fit();
        self.gauges.shrink_to_fit();
        self.rows.shrink_to_fit();
        self.starts.shrink_to_fit();
    }

    /// Velocity columns that move what a column moves, from that one on towards the ground, falling.
    pub fn road(&self, from: Option<usize>) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(from, |k| self.above[*k])
    }

    /// Velocity columns that move a body, rising: from the ground on.
    #[must_use]
    pub fn path(&self, body: usize) -> Vec<usize> {
        let mut columns: Vec<usize> = self.road(self.bodies[body].column).collect();
        columns.reverse();
        columns
    }

    /// The coordinates as drawn: zeros, quaternions (1, 0, 0, 0).
    #[must_use]
    pub fn drawn(&self) -> Vec<f64> {
        let mut q = vec![0.0; self.nq];
        for step in &self.steps {
            if let Step::Ball { q: k, .. } = step {
                q[*k] = 1.0;
            }
        }
        q
    }

    /// Its programs by stage: time, position, velocity, forces, states.
    #[must_use]
    pub fn programs(&self) -> [&StagedProgram; 5] {
        [&self.time_program, &self.position_program, &self.velocity_program, &self.force_program, &self.state_program]
    }

    /// Adds a row that holds a joint on a rigid stop.
    pub fn rest(&mut self, stop: usize) {
        let Stop { along, at, angular, .. } = self.stops[stop];
        if let Some(along) = along {
            self.fix(along, at, angular, RowOwner::Stop(stop));
        }
    }

    /// Adds a row that holds a contact; the state says where.
    pub fn hold(&mut self, contact: usize) {
        let Contact { along, angular, .. } = self.contacts[contact];
        self.fix(along, 0.0, angular, RowOwner::Contact(contact));
    }

    fn fix(&mut self, along: StretchOf, at: f64, angular: bool, owner: RowOwner) {
        let kind = match along {
            StretchOf::Gauge(gauge) => RowKind::Gauge(gauge),
            StretchOf::Function(function) => RowKind::Function(function),
        };
        self.rows.push(Row { kind, owner, label: String::new(), offset: G::S::constant(at), anchored: false, angular });
    }

    /// One-way clutches, in file order.
    pub fn one_way(&self) -> impl Iterator<Item = &Contact> {
        self.contacts.iter().filter(|contact| contact.is_one_way())
    }

    /// Sets the senses in which contacts slide, and the switches that follow them: 0 where one of several sticks.
    pub fn slide(&self, senses: &[i32], modes: &mut [i32]) {
        for (contact, sense) in self.contacts.iter().zip(senses) {
            modes[contact.mode] = *sense;
            contact.follow.iter().for_each(|k| modes[*k] = *sense);
        }
        for (contact, _) in self.contacts.iter().zip(senses).filter(|(_, sense)| **sense == 0) {
            contact.follow.iter().for_each(|k| modes[*k] = 0);
        }
    }

    /// Whether a switch stands as a contact does.
    #[must_use]
    pub fn is_of_contact(&self, switch: usize) -> bool {
        self.contacts.iter().any(|c| c.mode == switch || c.follow.contains(&switch))
    }

    /// The contact that an effort belongs to.
    #[must_use]
    pub fn contact_of(&self, effort: usize) -> Option<usize> {
        self.contacts
            .iter()
            .position(|c| matches!(c.law, ContactLaw::Friction { effort: e, .. } | ContactLaw::OneWay { effort: e } if e == effort))
    }

    /// Contacts that rows hold, with their rows.
    pub fn held(&self) -> impl Iterator<Item = (usize, usize)> {
        let contact = |row: &Row<G>| if let RowOwner::Contact(contact) = row.owner { Some(contact) } else { None };
        self.rows.iter().enumerate().filter_map(move |(i, row)| Some((contact(row)?, i)))
    }

    /// The row that holds a gauge by itself, on a rigid stop or sticking; or by a function of it alone, as an event whose impact has come to
    /// rest does.
    #[must_use]
    pub fn holding(&self, gauge: usize) -> Option<&Row<G>> {
        let alone = |row: &Row<G>| match row.kind {
            RowKind::Gauge(held) => held == gauge,
            RowKind::Function(f) => self.functions[f].gauges == [gauge] && self.functions[f].by_time.is_none(),
            RowKind::Driver { .. } | RowKind::Ratio { .. } => false,
        };
        self.rows.iter().rev().take_while(|row| row.holds()).find(|row| alone(row))
    }

    /// The first of the gauges that rows of clutches hold to one rate with `gauge`, and whether a row holds one of them at rest; but for the
    /// row `from`, from which it is looked at. Rows that hold contacts are independent, so that none leads back.
    #[must_use]
    pub fn moving_as_one(&self, gauge: usize, from: Option<usize>) -> (usize, bool) {
        let mut found = (gauge, self.holding(gauge).is_some());
        for (i, row) in self.rows.iter().enumerate().rev().take_while(|(_, row)| row.holds()) {
            let (RowOwner::Contact(_), RowKind::Function(function)) = (row.owner, row.kind) else { continue };
            let &[one, other] = &self.functions[function].gauges[..] else { continue };
            if Some(i) != from && (one == gauge || other == gauge) {
                let (first, rests) = self.moving_as_one(if one == gauge { other } else { one }, Some(i));
                found = (found.0.min(first), found.1 || rests);
            }
        }
        found
    }

    /// Whether a row holds something at a place that time moves: that of a driver, or of a coupling with time in it.
    #[must_use]
    pub fn is_moved(&self, row: &Row<G>) -> bool {
        match row.kind {
            RowKind::Driver { .. } => true,
            RowKind::Function(f) => self.functions[f].by_time.is_some(),
            RowKind::Gauge(_) | RowKind::Ratio { .. } => false,
        }
    }

    /// Modes of the sides on which joints with friction by reactions press; see [`Pressed::side`](super::Pressed::side).
    pub fn sides(&self) -> impl Iterator<Item = usize> {
        self.pressings.iter().flat_map(|p| &p.places).filter(|p| p.components.len() == 1).map(|p| p.side)
    }

    /// Modes before anything is known of the state: all 0.
    #[must_use]
    pub fn modes(&self) -> Vec<i32> {
        vec![0; self.switches + self.windings]
    }

    /// q ⊕ δ: moves the coordinates by a velocity times time, δ in the frame of v (shape nv).
    pub fn retract(&self, q: &mut [f64], delta: &[f64]) {
        for step in &self.steps {
            match step {
                Step::Axis { q: i, v, .. } => q[*i] += delta[*v],
                Step::Ball { q: i, v, .. } => {
                    let w = [delta[*v], delta[v + 1], delta[v + 2]];
                    retract_quaternion(&mut q[*i..i + 4], w);
                }
            }
        }
    }

    /// q̇ = N(q) v (shapes nq, nv).
    pub fn rate(&self, q: &[f64], v: &[f64], qdot: &mut [f64]) {
        for step in &self.steps {
            match step {
                Step::Axis { q: i, v: k, .. } => qdot[*i] = v[*k],
                Step::Ball { q: i, v: k, .. } => {
                    let half = multiply_quaternion([q[*i], q[i + 1], q[i + 2], q[i + 3]], [0.0, v[*k], v[k + 1], v[k + 2]]);
                    for (out, x) in qdot[*i..i + 4].iter_mut().zip(half) {
                        *out = 0.5 * x;
                    }
                }
            }
        }
    }

    /// q := the solution of q = q̂ + N(q) u, q̂ coming in by `q` (nq), u (nv).
    ///
    /// For a quaternion q − ½ q∘(0, u) = q̂, so q = q̂∘(1, u/2)/(1 + |u|²/4), since (1, −u/2)∘(1, u/2) = 1 + |u|²/4.
    pub fn displace(&self, q: &mut [f64], u: &[f64]) {
        for step in &self.steps {
            match step {
                Step::Axis { q: i, v: k, .. } => q[*i] += u[*k],
                Step::Ball { q: i, v: k, .. } => {
                    let half = [0.5 * u[*k], 0.5 * u[k + 1], 0.5 * u[k + 2]];
                    let product = multiply_quaternion([q[*i], q[i + 1], q[i + 2], q[i + 3]], [1.0, half[0], half[1], half[2]]);
                    let size = 1.0 + half.iter().map(|x| x * x).sum::<f64>();
                    q[*i..i + 4].iter_mut().zip(product).for_each(|(q, x)| *q = x / size);
                }
            }
        }
    }

    /// What a constraint row belongs to, in words: "joint `B`, x".
    #[must_use]
    pub fn name_of_row(&self, row: usize) -> String {
        let row = &self.rows[row];
        match row.owner {
            RowOwner::Joint(j) => format!("joint `{}`, {}", self.joints[j].name, row.label),
            RowOwner::Driver(d) => format!("driver `{}`", self.drives[d].name),
            RowOwner::Coupling => format!("coupling `{}`", row.label),
            RowOwner::Contact(c) => self.contacts[c].name.clone(),
            RowOwner::Stop(s) => format!("{} of joint `{}`", self.stops[s].word(), self.joints[self.stops[s].joint].name),
        }
    }

    /// The same mechanism on another scalar, for its equations alone: without names, what only drawings, outputs and energies ask for, and
    /// how it starts.
    #[must_use]
    pub fn lift<D: Scalar>(&self) -> Mechanism<G::Lift<D>> {
        let c = |x: G::S| D::constant(x.value());
        Mechanism {
            bodies: self.bodies.iter().map(Body::lift).collect(),
            nodes: self
                .nodes
                .iter()
                .map(|n| TreeNode {
                    body: n.body,
                    parent: n.parent,
                    before: n.before.lift(),
                    turned: n.turned,
                    steps: n.steps.clone(),
                    after: n.after.map(Pose::lift),
                    columns: n.columns.clone(),
                })
                .collect(),
            groups: self.groups.iter().map(Group::lift).collect(),
            group_of: self.group_of.clone(),
            steps: self.steps.iter().map(Step::lift).collect(),
            nq: self.nq,
            nv: self.nv,
            above: self.above.clone(),
            joints: self.joints.iter().map(Joint::lift).collect(),
            joint_of_node: self.joint_of_node.clone(),
            gauges: self.gauges[..self.active_gauges].iter().map(Gauge::lift).collect(),
            active_gauges: self.active_gauges,
            rows: self.rows.iter().map(|r| r.lift(c)).collect(),
            functions: self.functions.clone(),
            drives: self.drives.clone(),
            stretches: self.stretches.iter().map(|s| s.lift(c)).collect(),
            starts: Vec::new(),
            orientations: Vec::new(),
            efforts: self.efforts.iter().map(|e| e.lift(c)).collect(),
            spring_efforts: self.spring_efforts.clone(),
            motor_efforts: self.motor_efforts.clone(),
            pressings: self.pressings.clone(),
            friction_efforts: self.friction_efforts.clone(),
            clutches: self.clutches.clone(),
            bristles: self.bristles.clone(),
            buffers: self.buffers.clone(),
            stops: self.stops.clone(),
            contacts: self.contacts.clone(),
            rotors: self.rotors.iter().map(|r| Rotor { gauge: r.gauge, inertia: c(r.inertia) }).collect(),
            point_loads: self.point_loads.iter().map(PointLoad::lift).collect(),
            position_program: self.position_program.clone(),
            velocity_program: self.velocity_program.clone(),
            time_program: self.time_program.clone(),
            force_program: self.force_program.clone(),
            spring_laws: Vec::new(),
            state_program: self.state_program.clone(),
            state_starts: self.state_starts.clone(),
            tables: Arc::clone(&self.tables),
            gravity: G::lift_vector::<D>(self.gravity),
            switches: self.switches,
            windings: self.windings,
        }
    }
}

impl<G: Space> Body<G> {
    /// Puts an attached mass elsewhere on the body, `at` in the body frame, m, and sums the mass anew.
    pub fn move_attached(&mut self, index: usize, at: G::Vector) {
        self.attached[index].mass.com = at;
        self.mass = self.attached.iter().fold(self.bare, |sum, a| sum.join(a.mass));
    }

    fn lift<D: Scalar>(&self) -> Body<G::Lift<D>> {
        Body {
            name: String::new(),
            mass: self.mass.lift(),
            bare: self.bare.lift(),
            attached: Vec::new(),
            points: Vec::new(),
            drawn: Vec::new(),
            outline: None,
            solids: Box::default(),
            column: self.column,
        }
    }
}

/// q ∘ exp(w/2): body-frame rotation vector w, rad; the result has the length of q.
fn retract_quaternion(q: &mut [f64], w: [f64; 3]) {
    let half = 0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
    // sin(x)/x to second order near 0
    let k = 0.5 * if half < 1e-6 { 1.0 - half * half / 6.0 } else { half.sin() / half };
    let product = multiply_quaternion([q[0], q[1], q[2], q[3]], [half.cos(), k * w[0], k * w[1], k * w[2]]);
    q.copy_from_slice(&product);
}
