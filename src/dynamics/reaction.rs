//! Accelerations of bodies and reactions of joints from a and λ.
//!
//! Every constraint and effort is a pair of wrenches in one line, so a joint's reaction is either what its own rows do
//! (−Σ λ W, if it is cut) or what is missing in the balance of all that hangs on it (if it carries the tree):
//! F = Σ (I A + V ×* I V) − Σ (applied wrenches and pairs that cross). It acts on the second body, from the first.

use super::Dynamics;
use crate::geometry::{Force, Motion, Space};
use crate::mechanism::{RowKind, RowOwner, StretchOf};
use crate::scalar::Scalar;

/// What follows from accelerations and multipliers; sized once.
#[derive(Clone, Debug)]
pub struct Reactions<G: Space> {
    /// Acceleration of each body: d/dt of its twist.
    pub accelerations: Vec<Motion<G>>,
    /// Wrench of each joint on its second body by its first, about the reference point of its group.
    pub joints: Vec<Force<G>>,
    /// Σ m a and d/dt of the angular momentum about the world origin.
    pub shaking: Force<G>,
    /// Wrench of the mechanism on the frame, about the world origin: minus all that the frame does to it through joints, springs and
    /// drivers.
    pub frame: Force<G>,
    /// Torque or force of each driver on the second body.
    pub drives: Vec<G::S>,
    /// Torque or force by which each contact is held where it sticks, on the second body; 0 while it slides.
    pub held: Vec<G::S>,
    /// Torque or force of each row along its gauge or function, of a ratio along its second gauge (rows).
    pub rows: Vec<G::S>,
    sums: Vec<Force<G>>,
    /// What belongs to each group, about its reference point.
    of_group: Vec<Force<G>>,
    along: Vec<G::S>,
}

impl<G: Space> Dynamics<'_, G> {
    /// Room for reactions.
    #[must_use]
    pub fn reactions(&self) -> Reactions<G> {
        let m = self.mechanism;
        Reactions {
            accelerations: vec![Motion::default(); m.bodies.len()],
            joints: vec![Force::default(); m.joints.len()],
            shaking: Force::default(),
            frame: Force::default(),
            drives: vec![G::S::default(); m.drives.len()],
            held: vec![G::S::default(); m.contacts.len()],
            rows: vec![G::S::default(); m.rows.len()],
            sums: vec![Force::default(); m.bodies.len()],
            of_group: vec![Force::default(); m.groups.len()],
            along: vec![G::S::default(); m.gauges.len()],
        }
    }

    /// Accelerations, reactions, shaking force and driver efforts for `a` (nv) and `lambda` (rows); after [`Dynamics::loads`].
    pub fn react(&mut self, a: &[G::S], lambda: &[G::S], out: &mut Reactions<G>) {
        self.apply_friction(lambda);
        self.accelerate(a, &mut out.accelerations);
        self.unbalance(&out.accelerations);
        self.distribute(a, lambda, out);
    }

    /// [`Dynamics::react`] without its first steps, which [`Dynamics::apply_friction`], [`Dynamics::accelerate`] and [`Dynamics::unbalanced`] have
    /// done.
    pub fn distribute(&self, a: &[G::S], lambda: &[G::S], out: &mut Reactions<G>) {
        self.pairs(a, lambda, out);
        let (m, w) = (self.mechanism, &self.work);
        // what each body lacks: I A + V ×* I V − applied − pairs on it
        out.of_group.fill(Force::default());
        out.sums[0] = Force::default();
        for node in &m.nodes {
            let lacking = w.unbalanced[node.body];
            out.of_group[m.group_of[node.body]] += lacking + w.applied[node.body];
            out.sums[node.body] = lacking;
        }
        out.shaking = self.about_origin(&out.of_group);
        out.of_group.fill(Force::default());
        for (i, (gauge, &size)) in m.gauges[..self.active].iter().zip(&out.along).enumerate() {
            let pair = w.readings[i].wrench * size;
            out.sums[gauge.b] -= pair;
            out.sums[gauge.a] += pair;
            // a pair that ends on the frame
            let frame = &mut out.of_group[m.group_between(gauge.a, gauge.b)];
            if gauge.a == 0 {
                *frame -= pair;
            }
            if gauge.b == 0 {
                *frame += pair;
            }
        }
        for (index, node) in m.nodes.iter().enumerate().rev() {
            let sum = out.sums[node.body];
            if node.parent != 0 {
                out.sums[node.parent] += sum;
            } else {
                out.of_group[m.group_of[node.body]] -= sum;
            }
            if let Some(joint) = m.joint_of_node[index] {
                let reversed = m.joints[joint].tree.is_some_and(|t| t.1);
                out.joints[joint] = if reversed { -sum } else { sum };
            }
        }
        out.frame = self.about_origin(&out.of_group);
    }

    /// The sum of wrenches that are about the reference points of the groups, about the world origin.
    fn about_origin(&self, of_group: &[Force<G>]) -> Force<G> {
        let about = of_group.iter().zip(&self.work.references);
        about.fold(Force::default(), |sum, (wrench, reference)| sum + wrench.about_origin(*reference))
    }

    /// A_b = Σ s_k a_k + bias.
    pub fn accelerate(&self, a: &[G::S], out: &mut [Motion<G>]) {
        let w = &self.work;
        for node in &self.mechanism.nodes {
            let mut acceleration = out[node.parent] + w.bias[node.body] - w.bias[node.parent];
            for k in node.columns.clone() {
                acceleration += w.columns[k] * a[k];
            }
            out[node.body] = acceleration;
        }
    }

    /// Total size along each gauge, joint rows apart in `joints`; and the driver efforts.
    fn pairs(&self, a: &[G::S], lambda: &[G::S], out: &mut Reactions<G>) {
        let (m, w) = (self.mechanism, &self.work);
        out.along.fill(G::S::default());
        out.joints.fill(Force::default());
        out.held.fill(G::S::default());
        for (index, (row, &l)) in m.rows.iter().zip(lambda).enumerate() {
            match row.kind {
                RowKind::Gauge(i) | RowKind::Driver { gauge: i, .. } => out.along[i] -= l,
                RowKind::Ratio { first, second, ratio } => {
                    out.along[second] -= l;
                    out.along[first] += l.scale(ratio);
                }
                RowKind::Function(f) => {
                    let function = &m.functions[f];
                    for (i, &gauge) in function.gauges.iter().enumerate() {
                        out.along[gauge] -= l * w.functions[function.value + 1 + i];
                    }
                }
            }
            match row.owner {
                RowOwner::Driver(d) => out.drives[d] = -l,
                RowOwner::Joint(j) => match row.kind {
                    RowKind::Gauge(i) => out.joints[j] -= w.readings[i].wrench * l,
                    RowKind::Ratio { first, second, ratio } => {
                        out.joints[j] -= w.readings[second].wrench * l;
                        out.joints[j] += w.readings[first].wrench * l.scale(ratio);
                    }
                    _ => {}
                },
                RowOwner::Contact(c) => out.held[c] = -l,
                RowOwner::Stop(_) | RowOwner::Coupling => {}
            }
            out.rows[index] = -l;
        }
        for (effort, &size) in m.efforts.iter().zip(&w.efforts) {
            match effort.along {
                StretchOf::Gauge(i) => out.along[i] += size,
                StretchOf::Function(f) => {
                    let function = &m.functions[f];
                    for (i, &gauge) in function.gauges.iter().enumerate() {
                        out.along[gauge] += size * w.functions[function.value + 1 + i];
                    }
                }
            }
        }
        for rotor in &m.rotors {
            let acceleration = m.gauges[rotor.gauge].acceleration(&w.readings[rotor.gauge], &w.columns, a);
            out.along[rotor.gauge] -= rotor.inertia * acceleration;
        }
    }
}
