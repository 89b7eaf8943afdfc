//! Position and velocity: poses, columns, gauges and constraint rows, from the root of the tree outwards.
//!
//! A column is the twist s_k = ∂V/∂v_k of its body in the world. Because a joint's axis is carried by what it hangs on,
//! ṡ_k = V × s_k with V the twist before the step, and the acceleration at a = 0 is the sum of ṡ_k v_k along the path
//! (Featherstone 2008, equation 5.7 in world coordinates).

use super::{Dynamics, Workspace};
use crate::geometry::{Motion, Pose, Quaternion, Space};
use crate::mechanism::{Leaf, Placed, Relative, RowKind, StagedProgram, Step, StretchOf};
use crate::scalar::Scalar;

impl<G: Space> Dynamics<'_, G> {
    /// Laws of time with their rates, and ν of the drivers, which is f', at time `t`, s.
    pub fn time(&mut self, t: G::S, modes: &[i32]) {
        let m = self.mechanism;
        let w = &mut self.work;
        self.t = t;
        w.beyond = false;
        if m.drives.iter().any(|d| d.speed.is_none()) || m.stretches.iter().any(|s| s.moving.is_some()) {
            for &(input, _) in &m.time_program.fills {
                w.inputs[input] = t;
            }
            w.beyond = !m.time_program.program.eval(&w.inputs, modes, &mut w.registers, &mut w.motions);
        }
        for drive in &m.drives {
            if let Some(speed) = drive.speed {
                w.motions[drive.output] = t.scale(speed);
                w.motions[drive.output + 1] = G::S::constant(speed);
                w.motions[drive.output + 2] = G::S::default();
            }
            w.nu[drive.row] = w.motions[drive.output + 1];
        }
    }

    /// Poses, columns, gauges, Φ, G and ν at the coordinates `q` (nq); after [`Dynamics::time`].
    pub fn position(&mut self, q: &[G::S], modes: &[i32]) {
        self.place_bodies(q);
        self.placed(q, modes);
    }

    /// The same at `q`, which the small displacement `delta` (nv) has led to from the coordinates evaluated last: everything moves
    /// by its first derivative. The error is the square of `delta`.
    pub fn nudge(&mut self, q: &[G::S], delta: &[G::S], modes: &[i32]) {
        let w = &mut self.work;
        w.moved.fill(Motion::default());
        for node in &self.mechanism.nodes {
            let mut moved = w.moved[node.parent];
            for step in &self.mechanism.steps[node.steps.clone()] {
                match *step {
                    Step::Axis { v: k, .. } => {
                        let column = w.columns[k];
                        w.columns[k] = column + moved.cross(column);
                        moved += column * delta[k];
                    }
                    // three columns, one step: carried by the second body, which the step moves unless it is reversed
                    Step::Ball { v, reversed, .. } => {
                        let turned = (v..v + G::SPIN).fold(moved, |sum, k| sum + w.columns[k] * delta[k]);
                        let carrier = if reversed { moved } else { turned };
                        for column in &mut w.columns[v..v + G::SPIN] {
                            *column += carrier.cross(*column);
                        }
                        moved = turned;
                    }
                }
            }
            w.moved[node.body] = moved;
            let x = &mut w.places[node.body];
            x.p = x.p + moved.at(x.p);
            x.r = G::nudge(x.r, moved.w);
        }
        self.placed(q, modes);
    }

    /// Gauges, functions and rows once bodies are in place.
    fn placed(&mut self, q: &[G::S], modes: &[i32]) {
        let m = self.mechanism;
        if self.needs_quaternions {
            self.quaternions(q);
        }
        let Workspace { places, quaternions, columns, references, readings, .. } = &mut self.work;
        let placed = Placed { places, quaternions, q, columns, windings: &modes[m.switches..] };
        let mut points = Default::default();
        for (gauge, reading) in m.gauges[..self.active].iter().zip(readings) {
            gauge.position(placed, &references[m.group_between(gauge.a, gauge.b)], &mut points, reading);
        }
        self.functions(modes);
        self.rows();
    }

    /// Quaternions of the bodies along the tree, if there is a gauge of one.
    pub(super) fn quaternions(&mut self, q: &[G::S]) {
        let (m, w) = (self.mechanism, &mut self.work);
        if w.quaternions.is_empty() {
            return;
        }
        for (node, [before, after]) in m.nodes.iter().zip(&w.turned) {
            let mut turned = w.quaternions[node.parent].multiply(*before);
            for step in &m.steps[node.steps.clone()] {
                turned = match *step {
                    Step::Axis { u, turns: true, q: i, .. } => turned.multiply(Quaternion::hinge::<G>(u, q[i])),
                    Step::Axis { .. } => turned,
                    Step::Ball { q: i, reversed, .. } => {
                        let turn = Quaternion::unit([q[i], q[i + 1], q[i + 2], q[i + 3]]);
                        turned.multiply(if reversed { turn.inverse() } else { turn })
                    }
                };
            }
            w.quaternions[node.body] = turned.multiply(*after);
        }
    }

    /// Reference points, poses and columns alone.
    fn place_bodies(&mut self, q: &[G::S]) {
        let m = self.mechanism;
        let w = &mut self.work;
        for (group, reference) in m.groups.iter().zip(&mut w.references) {
            *reference = group.reference(q);
        }
        for node in &m.nodes {
            let mut x = if node.parent == 0 {
                // the earliest place for a difference
                Pose { r: node.before.r, p: node.before.p - w.references[m.group_of[node.body]] }
            } else {
                w.places[node.parent].shifted(node.before, node.turned)
            };
            for step in &m.steps[node.steps.clone()] {
                match *step {
                    Step::Axis { u, d, turns, slides, q: i, v } => {
                        let mut column = Motion::default();
                        if turns {
                            column = Motion::about(G::rotate_spin(x.r, u), x.p);
                        }
                        if slides {
                            let d = G::rotate(x.r, d);
                            column.v += d;
                            x.p += d * q[i];
                        }
                        if turns {
                            x.r = G::multiply(x.r, G::hinge(u, q[i]));
                        }
                        w.columns[v] = column;
                    }
                    Step::Ball { q: i, v, reversed } => {
                        let turn = G::quaternion([q[i], q[i + 1], q[i + 2], q[i + 3]]);
                        let after = G::multiply(x.r, if reversed { G::inverse(turn) } else { turn });
                        // ω is in the axes of the joint's second body: those after the step, or before it when reversed
                        let (axes, sign) = if reversed { (x.r, -1.0) } else { (after, 1.0) };
                        for k in 0..G::SPIN {
                            let mut e = [0.0; 3];
                            e[if G::SPIN == 1 { 2 } else { k }] = sign;
                            w.columns[v + k] = Motion::about(G::rotate_spin(axes, G::spin(e)), x.p);
                        }
                        x.r = after;
                    }
                }
            }
            w.places[node.body] = match node.after {
                Some(after) => x * after,
                None => x,
            };
        }
    }

    /// Values and partial derivatives of functions of gauges.
    pub(super) fn functions(&mut self, modes: &[i32]) {
        let program = &self.mechanism.position_program;
        if program.outputs > 0 {
            self.fill(program);
            let w = &mut self.work;
            w.beyond |= !program.program.eval(&w.inputs, modes, &mut w.registers, &mut w.functions);
        }
    }

    /// Φ and G from the gauges, and ν of functions of time; entries outside of the pattern stay 0.
    pub(super) fn rows(&mut self) {
        let m = self.mechanism;
        let Workspace { readings, columns, functions, motions, phi, g: rows, nu, held, line, .. } = &mut self.work;
        let full = rows.pattern().is_full();
        for (index, (row, phi)) in m.rows.iter().zip(phi.iter_mut()).enumerate() {
            let (entries, values) = rows.line_mut(index);
            let g: &mut [G::S] = if full { &mut *values } else { &mut *line };
            let clear = |g: &mut [G::S]| entries.iter().for_each(|k| g[*k] = G::S::default());
            let offset = row.target(held);
            match row.kind {
                RowKind::Gauge(i) => {
                    *phi = readings[i].x - offset;
                    m.gauges[i].project(&readings[i], columns, |k, x| g[k] = x);
                }
                RowKind::Driver { gauge: i, driver } => {
                    *phi = readings[i].x - row.offset - motions[m.drives[driver].output];
                    m.gauges[i].project(&readings[i], columns, |k, x| g[k] = x);
                }
                RowKind::Ratio { first, second, ratio } => {
                    *phi = readings[second].x - row.offset - readings[first].x.scale(ratio);
                    clear(g);
                    m.gauges[second].project(&readings[second], columns, |k, x| g[k] += x);
                    m.gauges[first].project(&readings[first], columns, |k, x| g[k] -= x.scale(ratio));
                }
                RowKind::Function(f) => {
                    let function = &m.functions[f];
                    *phi = functions[function.value] - offset;
                    if let Some(by_time) = function.by_time {
                        nu[index] = -functions[by_time];
                    }
                    clear(g);
                    for (i, &gauge) in function.gauges.iter().enumerate() {
                        let slope = functions[function.value + 1 + i];
                        m.gauges[gauge].project(&readings[gauge], columns, |k, x| g[k] += slope * x);
                    }
                }
            }
            if !full {
                values.iter_mut().zip(entries).for_each(|(value, k)| *value = line[*k]);
            }
        }
    }

    /// Twists, rates and γ at the velocities `v` (nv); after [`Dynamics::position`].
    pub fn velocity(&mut self, v: &[G::S], modes: &[i32]) {
        let m = self.mechanism;
        let w = &mut self.work;
        for node in &m.nodes {
            let (mut twist, mut bias) = (w.twists[node.parent], w.bias[node.parent]);
            for step in &m.steps[node.steps.clone()] {
                let moved = match *step {
                    Step::Axis { v: k, .. } => w.columns[k] * v[k],
                    // three columns, one step: they turn together, so that none carries another
                    Step::Ball { v: k, .. } => (k + 1..k + G::SPIN).fold(w.columns[k] * v[k], |sum, k| sum + w.columns[k] * v[k]),
                };
                bias += twist.cross(moved);
                twist += moved;
            }
            (w.twists[node.body], w.bias[node.body]) = (twist, bias);
        }
        let mut relative = Relative::default();
        for (gauge, reading) in m.gauges[..self.active].iter().zip(&mut w.readings) {
            gauge.velocity(&w.places, [&w.twists, &w.bias], v, &mut relative, reading);
        }
        if m.velocity_program.outputs > 0 {
            self.fill(&m.velocity_program);
            let w = &mut self.work;
            w.beyond |= !m.velocity_program.program.eval(&w.inputs, modes, &mut w.registers, &mut w.drifts);
        }
        let w = &mut self.work;
        for (row, gamma) in m.rows.iter().zip(&mut w.gamma) {
            *gamma = match row.kind {
                RowKind::Gauge(k) => -w.readings[k].drift,
                RowKind::Driver { gauge, driver } => w.motions[m.drives[driver].output + 2] - w.readings[gauge].drift,
                RowKind::Ratio { first, second, ratio } => w.readings[first].drift.scale(ratio) - w.readings[second].drift,
                RowKind::Function(f) => -w.drifts[m.functions[f].drift],
            };
        }
    }

    /// Puts the inputs of a program in their places.
    pub(super) fn fill(&mut self, program: &StagedProgram) {
        for &(input, leaf) in &program.fills {
            self.work.inputs[input] = self.leaf(leaf);
        }
    }

    /// The value of a program's input at the state evaluated last.
    #[must_use]
    pub fn leaf(&self, leaf: Leaf) -> G::S {
        let w = &self.work;
        match leaf {
            Leaf::Time => self.t,
            Leaf::Gauge { gauge, order: 0 } => w.readings[gauge].x,
            Leaf::Gauge { gauge, order: 1 } => w.readings[gauge].rate,
            Leaf::Gauge { gauge, .. } => w.readings[gauge].drift,
            Leaf::Spin { body, axis, own } => G::spin_component(self.in_axes(body, own, w.twists[body].w), axis),
            Leaf::Stretch { spring, order: 0 } => self.stretch(spring),
            Leaf::Stretch { spring, .. } => self.stretch_rate(spring),
            Leaf::State(state) => w.z[state],
        }
    }

    /// A gauge that a row holds, on a rigid stop or sticking: exactly where it is held, or 0 for its rate (`order` 1) and acceleration (2);
    /// one that a driver at rest holds: what its law says; and the rate of one that a clutch holds to others, which is one number for all
    /// of them, so that the slip of the clutch is 0.
    /// What is evaluated there has round-off, by which a comparison would come out now so, now otherwise.
    #[must_use]
    pub fn held(&self, gauge: usize, order: usize) -> Option<G::S> {
        let m = self.mechanism;
        if let Some(row) = m.holding(gauge) {
            return Some(match row.kind {
                _ if order > 0 => G::S::default(),
                // the zero of e: exact for x − c
                RowKind::Function(f) => {
                    let (x, e) = (self.work.readings[gauge].x, self.mechanism.functions[f].value);
                    x - self.work.functions[e] / self.work.functions[e + 1]
                }
                _ => row.target(&self.work.held),
            });
        }
        let motions = &self.work.motions;
        if let Some(drive) = m.drives.iter().find(|drive| drive.gauge == gauge && motions[drive.output + 1].value() == 0.0) {
            let place = if order == 0 { m.rows[drive.row].offset } else { G::S::default() };
            return Some(motions[drive.output + order] + place);
        }
        let (first, rests) = if order == 1 { m.moving_as_one(gauge, None) } else { (gauge, false) };
        if rests { Some(G::S::default()) } else { (first != gauge).then(|| self.work.readings[first].rate) }
    }

    /// An angular velocity or acceleration in the axes of a body, or as it is in those of the world.
    #[must_use]
    pub fn in_axes(&self, body: usize, own: bool, w: G::Spin) -> G::Spin {
        if own { G::rotate_spin(G::inverse(self.work.places[body].r), w) } else { w }
    }

    /// x of a gauge or function.
    #[must_use]
    pub fn extent(&self, of: StretchOf) -> G::S {
        match of {
            StretchOf::Gauge(i) => self.work.readings[i].x,
            StretchOf::Function(f) => self.work.functions[self.mechanism.functions[f].value],
        }
    }

    /// ẋ of a gauge or function.
    #[must_use]
    pub fn extent_rate(&self, of: StretchOf) -> G::S {
        self.swept(of) + self.extent_by_time(of)
    }

    /// ∂x/∂t of a gauge or function, in a fixed position.
    #[must_use]
    pub fn extent_by_time(&self, of: StretchOf) -> G::S {
        let by_time = if let StretchOf::Function(f) = of { self.mechanism.functions[f].by_time } else { None };
        by_time.map_or(G::S::default(), |output| self.work.functions[output])
    }

    /// The rate of a gauge or function by the motion of the bodies alone: what an effort along it works on.
    #[must_use]
    pub fn swept(&self, of: StretchOf) -> G::S {
        match of {
            StretchOf::Gauge(i) => self.work.readings[i].rate,
            StretchOf::Function(f) => {
                let function = &self.mechanism.functions[f];
                let mut rate = G::S::default();
                for (i, &gauge) in function.gauges.iter().enumerate() {
                    rate += self.work.functions[function.value + 1 + i] * self.work.readings[gauge].rate;
                }
                rate
            }
        }
    }

    /// ẍ of a gauge or function from the accelerations a (nv): for a function Σ e_i (ẍ_i − c_i) and its drift.
    #[must_use]
    pub fn extent_acceleration(&self, of: StretchOf, a: &[G::S]) -> G::S {
        let of_gauge = |i: usize| self.mechanism.gauges[i].acceleration(&self.work.readings[i], &self.work.columns, a);
        match of {
            StretchOf::Gauge(i) => of_gauge(i),
            StretchOf::Function(f) => {
                let function = &self.mechanism.functions[f];
                let mut sum = self.work.drifts[function.drift];
                for (i, &gauge) in function.gauges.iter().enumerate() {
                    sum += self.work.functions[function.value + 1 + i] * (of_gauge(gauge) - self.work.readings[gauge].drift);
                }
                sum
            }
        }
    }

    /// Calls with index and entry of ∂ẋ/∂v of a gauge or function; an index may come more than once.
    pub fn extent_gradient(&self, of: StretchOf, mut each: impl FnMut(usize, G::S)) {
        let (m, w) = (self.mechanism, &self.work);
        match of {
            StretchOf::Gauge(i) => m.gauges[i].project(&w.readings[i], &w.columns, each),
            StretchOf::Function(f) => {
                let function = &m.functions[f];
                for (i, &gauge) in function.gauges.iter().enumerate() {
                    let slope = w.functions[function.value + 1 + i];
                    m.gauges[gauge].project(&w.readings[gauge], &w.columns, |k, x| each(k, slope * x));
                }
            }
        }
    }

    /// Stretch x − rest of a spring.
    #[must_use]
    pub fn stretch(&self, spring: usize) -> G::S {
        let stretch = self.mechanism.stretches[spring];
        self.extent(stretch.of) - stretch.rest - self.moving_rest(spring, 0)
    }

    /// Rate of the stretch of a spring.
    #[must_use]
    pub fn stretch_rate(&self, spring: usize) -> G::S {
        self.extent_rate(self.mechanism.stretches[spring].of) - self.moving_rest(spring, 1)
    }

    /// Second rate of the stretch of a spring, from the accelerations a (nv).
    #[must_use]
    pub fn stretch_acceleration(&self, spring: usize, a: &[G::S]) -> G::S {
        self.extent_acceleration(self.mechanism.stretches[spring].of, a) - self.moving_rest(spring, 2)
    }

    /// A rest that moves, or its rate of an order up to 2; 0 of one that does not.
    pub(super) fn moving_rest(&self, spring: usize, order: usize) -> G::S {
        self.mechanism.stretches[spring].moving.map_or(G::S::default(), |output| self.work.motions[output + order])
    }

    /// World position of a point of a body, m.
    #[must_use]
    pub fn point(&self, body: usize, at: G::Vector) -> G::Vector {
        if body == 0 { at } else { self.work.places[body].point(at) + self.reference(body) }
    }

    /// Pose of a body in the world.
    #[must_use]
    pub fn pose(&self, body: usize) -> Pose<G> {
        Pose { r: self.work.places[body].r, p: self.point(body, G::Vector::default()) }
    }

    /// Poses of all bodies in the world.
    #[must_use]
    pub fn poses(&self) -> Vec<Pose<G>> {
        (0..self.mechanism.bodies.len()).map(|body| self.pose(body)).collect()
    }

    /// The point that twists, wrenches and inertias of a body are about, m.
    #[must_use]
    pub fn reference(&self, body: usize) -> G::Vector {
        self.work.references[self.mechanism.group_of[body]]
    }

    /// A point of a body from the reference point of a `group`, which is that of the body unless it is the ground, m.
    #[must_use]
    pub fn place(&self, group: usize, body: usize, at: G::Vector) -> G::Vector {
        if body == 0 { at - self.work.references[group] } else { self.work.places[body].point(at) }
    }

    /// Reads the gauges that no row or force needs (joint coordinates for output); after the velocity stage.
    pub fn watch(&mut self, q: &[G::S], v: &[G::S], modes: &[i32]) {
        let m = self.mechanism;
        self.quaternions(q);
        let Workspace { places, quaternions, columns, references, readings, twists, bias, .. } = &mut self.work;
        let placed = Placed { places, quaternions, q, columns, windings: &modes[m.switches..] };
        let (mut points, mut relative) = (Default::default(), Relative::default());
        for (gauge, reading) in m.gauges.iter().zip(readings).skip(self.active) {
            gauge.position(placed, &references[m.group_between(gauge.a, gauge.b)], &mut points, reading);
            gauge.velocity(places, [twists, bias], v, &mut relative, reading);
        }
    }
}
