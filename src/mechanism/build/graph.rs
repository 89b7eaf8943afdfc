//! Joint geometry, the spanning tree and the rows of cut joints.

use super::super::gauge::Measured;
use super::super::joint::{self, Shape};
use super::super::sets::Sets;
use super::super::step::Step;
use super::super::tree::{self, Branch, Edge};
use super::super::{Joint, Row, RowKind, RowOwner, TreeNode};
use super::builder::{Builder, along};
use super::coordinates::Coordinates;
use super::particle::particles;
use crate::expression::Id;
use crate::geometry::{Pose, Space};
use crate::model::{self, JointKind, Quantity, roll_pitch_yaw};
use crate::scalar::Scalar;

impl<G: Space> Builder<'_, G> {
    /// Shapes of joints, tree, nodes and cut rows.
    pub(super) fn graph(&mut self, coordinates: Coordinates) {
        for index in 0..self.model.joints.len() {
            let shape = self.joint_shape(index);
            self.shapes.push(shape);
        }
        if !self.faults.is_empty() {
            return;
        }
        let bodies = self.model.bodies.len();
        self.particles = particles(self.model, self.planar);
        let wanted = self.wanted();
        let edges: Vec<Edge> = (0..self.shapes.len()).map(|j| self.edge(j, wanted[j])).collect();
        let spanned = tree::span(bodies, &edges);
        let (branches, footings) = match coordinates {
            Coordinates::Cartesian => (tree::star(bodies), self.footings(&spanned)),
            Coordinates::Bounded(depth) => (tree::bounded(bodies, &spanned, depth), self.footings(&spanned)),
            Coordinates::Joint => (spanned, vec![[0.0; 3]; bodies]),
        };
        for (index, joint) in self.model.joints.iter().enumerate() {
            let shape = &self.shapes[index];
            self.mechanism.joints.push(Joint {
                name: joint.name.clone(),
                kind: shape.word(),
                a: self.at(joint.a),
                b: self.at(joint.b),
                axis: shape.triad[if self.planar { 0 } else { 2 }],
                second: matches!(shape.kind, JointKind::Universal { .. }).then_some(shape.second),
                drawn: shape.align,
                zero: shape.zero,
                tree: None,
                slots: vec![],
                rows: 0..0,
                freedom: shape.freedom(self.planar),
                facing: shape.facing::<G>(self.planar),
                turns: shape.turns::<G>(self.planar).filter(|_| !self.joins_particle(index)),
            });
        }
        for branch in branches {
            self.node(branch, footings[branch.body]);
        }
        self.mechanism.joint_of_node = vec![None; self.mechanism.nodes.len()];
        for (index, joint) in self.mechanism.joints.iter().enumerate() {
            if let Some((node, _)) = joint.tree {
                self.mechanism.joint_of_node[node] = Some(index);
            }
        }
        for index in 0..self.shapes.len() {
            self.slots.push(vec![]);
            self.slot_measures.push(vec![]);
            self.measures_of_slots(index);
        }
    }

    /// For each body the first place on the ground to which joints lead from it, m, the same for all bodies that joints connect:
    /// coordinates of its own are counted from there, so that they are small wherever the mechanism stands. The origin for bodies
    /// without a road.
    fn footings(&self, spanned: &[Branch]) -> Vec<[f64; 3]> {
        let bodies = self.model.bodies.len();
        let mut sets = Sets::new(bodies);
        self.model.joints.iter().filter(|j| j.a.body != 0 && j.b.body != 0).for_each(|j| sets.join(j.a.body, j.b.body));
        let grounded = spanned.iter().filter(|b| b.parent == 0).filter_map(|b| Some((b.body, b.joint?)));
        let mut first: Vec<(usize, (usize, bool))> = grounded.collect();
        first.sort_by_key(|(_, joint)| std::cmp::Reverse(*joint));
        let mut places = vec![[0.0; 3]; bodies];
        for (body, (j, reversed)) in first {
            places[sets.of(body)] = if reversed { self.shapes[j].pb } else { self.shapes[j].pa };
        }
        (0..bodies).map(|body| places[sets.of(body)]).collect()
    }

    /// Whether each joint carries a driver, a motor or an exact start value.
    fn wanted(&self) -> Vec<bool> {
        let mut wanted = vec![false; self.shapes.len()];
        let (drivers, motors) = (self.model.drivers.iter().map(|d| d.joint), self.model.motors.iter().map(|m| m.joint));
        let starts = self.model.start.iter().filter(|s| !s.guess).filter_map(|s| match s.quantity {
            Quantity::Joint { joint, .. } => Some(joint),
            _ => None,
        });
        drivers.chain(motors).chain(starts).for_each(|joint| wanted[joint] = true);
        wanted
    }

    /// A joint as an edge of the graph. Preferred on the tree: what carries drivers, motors and exact start values, for their
    /// coordinates are then unknowns of the mechanism; then hinges and sliders; last what frees most.
    fn edge(&self, joint: usize, wanted: bool) -> Edge {
        let j = &self.model.joints[joint];
        let freedom = self.shapes[joint].freedom(self.planar);
        let rank = if wanted { 0 } else { 1 + freedom };
        let cut = self.honour_cuts && is_cut(j) || self.joins_particle(joint);
        Edge { a: j.a.body, b: j.b.body, rank: (!cut && self.shapes[joint].spans()).then_some(rank) }
    }

    /// Whether one of the bodies of a joint is a point mass without a rotation.
    fn joins_particle(&self, joint: usize) -> bool {
        let j = &self.model.joints[joint];
        self.particles[j.a.body] || self.particles[j.b.body]
    }

    /// Axes, alignment and sizes of a joint as numbers.
    fn joint_shape(&mut self, index: usize) -> Shape {
        let joint = &self.model.joints[index];
        let place = joint.place.as_str();
        let (pa, pb) = (self.at(joint.a).1, self.at(joint.b).1);
        let numbers = |p: G::Vector| std::array::from_fn(|i| if i < G::VECTOR { G::component(p, i).value() } else { 0.0 });
        let axis = self.direction(joint.axis.as_deref(), if self.planar { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] }, place);
        let in_plane = matches!(joint.kind, JointKind::Planar);
        let mut triad = if in_plane { joint::plane(axis) } else { joint::triad(axis) };
        let (mut align, mut second) = (joint::axis_rotation(axis, axis), axis);
        if self.planar {
            triad = [axis, [-axis[1], axis[0], 0.0], [0.0, 0.0, 1.0]];
        } else if let Some(to) = &joint.to {
            align = joint::axis_rotation(self.direction(Some(to), axis, place), axis);
        } else if let Some(rpy) = &joint.rpy {
            align = roll_pitch_yaw(rpy.map(|angle| self.number(angle, place)));
        }
        if let JointKind::Universal { axes: [first, other] } = &joint.kind {
            let first = self.direction(Some(first), axis, place);
            second = self.direction(Some(other), axis, place);
            triad = joint::triad(first);
            if joint::dot(first, joint::apply(&align, second)).abs() > 1e-9 {
                self.fault(
                    "axes-not-crossed",
                    place,
                    "the two axes of the universal joint are not at right angles".into(),
                    "axes whose scalar product is 0 with both bodies as drawn",
                    Some("make the second axis perpendicular to the first, as `axes: [[0, 0, 1], [1, 0, 0]]`".into()),
                );
            }
        }
        let pitch = match joint.kind {
            JointKind::Screw { pitch } => self.number(pitch, place) / std::f64::consts::TAU,
            _ => 0.0,
        };
        let length = match joint.kind {
            JointKind::Distance { length: Some(length) } => {
                let l = self.number(length, place);
                if l <= 0.0 {
                    self.fault(
                        "no-length",
                        place,
                        format!("the distance is {l} m"),
                        "more than 0 m",
                        Some("a distance of 0 is a `revolute` or `spherical` joint".into()),
                    );
                }
                l
            }
            _ => 0.0,
        };
        let zero = self.optional(joint.zero, place);
        // all above is in the axes of the two points, which coincide where the coordinate is 0 and neither `to` nor `rpy` is given
        let [first, other] = [joint.a, joint.b].map(|point| self.axes_of(point));
        if let Some(axes) = first {
            triad = triad.map(|x| joint::apply(&axes, x));
            align = joint::multiply(&axes, &align);
        }
        if let Some(axes) = other {
            align = joint::multiply(&align, &joint::transpose(&axes));
            second = joint::apply(&axes, second);
        }
        Shape { kind: joint.kind.clone(), pa: numbers(pa), pb: numbers(pb), triad, align, second, pitch, length, zero }
    }

    /// A unit direction.
    pub(super) fn direction(&mut self, ids: Option<&[Id]>, default: [f64; 3], place: &str) -> [f64; 3] {
        let Some(ids) = ids else { return default };
        let d = self.triple(ids, place);
        if joint::dot(d, d) == 0.0 {
            self.fault("no-direction", place, "the axis is zero".into(), "a direction", Some("for example `axis: [1, 0]`".into()));
            return default;
        }
        joint::unit(d)
    }

    /// Adds a body to the tree; a free joint of its own is at `footing` on the ground, m.
    fn node(&mut self, branch: Branch, footing: [f64; 3]) {
        let planar = self.planar;
        let free;
        let (shape, reversed) = match branch.joint {
            Some((j, reversed)) => (&self.shapes[j], reversed),
            None => {
                free = free_shape(footing, self.particles[branch.body]);
                (&free, false)
            }
        };
        let (before, axes, after) = tree::placed::<G>(shape, reversed, planar);
        let m = &mut self.mechanism;
        let (first_step, first_column) = (m.steps.len(), m.nv);
        let mut last = m.bodies[branch.parent].column;
        for axis in axes {
            m.steps.push(Step::new(axis, reversed, m.nq, m.nv));
            let (nq, nv) = axis.sizes();
            for _ in 0..nv {
                m.above.push(last);
                last = Some(m.nv);
                m.nv += 1;
            }
            m.nq += nq;
        }
        m.bodies[branch.body].column = last;
        let after = (after != Pose::identity()).then_some(after);
        m.nodes.push(TreeNode {
            body: branch.body,
            parent: branch.parent,
            before,
            turned: before.r != G::identity(),
            steps: first_step..m.steps.len(),
            after,
            columns: first_column..m.nv,
        });
        if let Some((j, reversed)) = branch.joint {
            m.joints[j].tree = Some((m.nodes.len() - 1, reversed));
        }
    }

    /// What measures the coordinates of a joint: tree coordinates, or gauges between the bodies.
    fn measures_of_slots(&mut self, index: usize) {
        let shape = self.shapes[index].clone();
        let joint = &self.mechanism.joints[index];
        let measures = match joint.tree {
            // a coordinate that would be counted from a body without a rotation
            None if self.joins_particle(index) && shape.spans() => vec![],
            None => {
                let windings = &mut self.mechanism.windings;
                shape.slots::<G>(self.planar, || {
                    *windings += 1;
                    *windings - 1
                })
            }
            Some((node, reversed)) => {
                let pb = joint.b.1;
                let steps = self.mechanism.nodes[node].steps.clone();
                let mut measures: Vec<Measured<G>> = shape
                    .axes(self.planar)
                    .iter()
                    .zip(if reversed { steps.clone().rev().collect::<Vec<_>>() } else { steps.collect() })
                    .filter_map(|(axis, step)| match self.mechanism.steps[step] {
                        Step::Axis { q, v, .. } => Some(Measured::Coordinate { along: along(q, v, axis.turns(), reversed), pb }),
                        Step::Ball { .. } => None,
                    })
                    .collect();
                if matches!(shape.kind, JointKind::Screw { .. }) {
                    measures.truncate(1);
                }
                measures
            }
        };
        self.slots[index] = vec![None; measures.len()];
        self.slot_measures[index] = measures;
    }

    /// Rows of the joints that the tree left over.
    pub(super) fn cut_rows(&mut self) {
        for index in 0..self.shapes.len() {
            if self.mechanism.joints[index].tree.is_some() {
                continue;
            }
            let shape = self.shapes[index].clone();
            let (a, b) = (self.mechanism.joints[index].a.0, self.mechanism.joints[index].b.0);
            let first = self.mechanism.rows.len();
            for asked in shape.rows::<G>(self.planar) {
                let gauge = self.gauge(a, b, asked.measured, 0.0);
                self.row(Row {
                    kind: RowKind::Gauge(gauge),
                    owner: RowOwner::Joint(index),
                    label: asked.label.to_string(),
                    offset: G::S::constant(asked.target),
                    anchored: matches!(shape.kind, JointKind::Distance { length: None }),
                    angular: asked.angular,
                });
            }
            if let (JointKind::Screw { .. }, Some(turn)) = (&shape.kind, self.slot(index, 0)) {
                let v = |x: [f64; 3]| G::vector(&x);
                let advance = Measured::Slide { pa: v(shape.pa), n: v(shape.triad[2]), pb: v(shape.pb) };
                let second = self.gauge(a, b, advance, shape.pitch * shape.zero);
                self.row(Row {
                    kind: RowKind::Ratio { first: turn, second, ratio: shape.pitch },
                    owner: RowOwner::Joint(index),
                    label: "advance".into(),
                    offset: G::S::constant(0.0),
                    anchored: false,
                    angular: false,
                });
            }
            self.mechanism.joints[index].rows = first..self.mechanism.rows.len();
        }
    }
}

/// Whether a joint is kept off the tree: by wish, or because with rows of its own the reaction that presses is a function of their
/// multipliers alone.
pub(super) fn is_cut(joint: &model::Joint) -> bool {
    joint.cut || joint.friction.as_ref().is_some_and(|f| f.pressed.is_some())
}

/// The free joint of a body's own, from a place on the ground.
fn free_shape(pa: [f64; 3], particle: bool) -> Shape {
    let z = [0.0, 0.0, 1.0];
    Shape {
        kind: if particle { JointKind::Particle } else { JointKind::Free },
        pa,
        pb: [0.0; 3],
        triad: joint::triad(z),
        align: joint::axis_rotation(z, z),
        second: z,
        pitch: 0.0,
        length: 0.0,
        zero: 0.0,
    }
}
