//! Applied forces, f and M.
//!
//! With P_b = I_b bias_b + V_b ×* I_b V_b − (applied wrench) summed over all that hangs on column k, f_k = −s_k · P
//! (Newton-Euler), and efforts along gauges add τ ∂x/∂q_k. The mass matrix comes from composite inertias:
//! M_jk = s_j · I^c s_k for every ancestor column j of k (Featherstone 2008, section 6.2), and rotors add J gᵀg.

use super::{Dynamics, Workspace};
use crate::geometry::{Force, Motion, Space};
use crate::mechanism::{EffortLaw, StretchOf};

impl<G: Space> Dynamics<'_, G> {
    /// World inertias, applied wrenches and efforts, those by reactions as if nothing pressed; after [`Dynamics::velocity`].
    pub fn loads(&mut self, modes: &[i32]) {
        let m = self.mechanism;
        if m.force_program.outputs > 0 {
            self.fill(&m.force_program);
            let w = &mut self.work;
            w.beyond |= !m.force_program.program.eval(&w.inputs, modes, &mut w.registers, &mut w.force_outputs);
        }
        self.sides(modes);
        self.inertias();
        self.applied();
        self.efforts();
    }

    /// ż; after [`Dynamics::loads`].
    pub fn rates(&mut self, modes: &[i32]) {
        let program = &self.mechanism.state_program;
        if program.outputs > 0 {
            self.fill(program);
            let w = &mut self.work;
            w.beyond |= !program.program.eval(&w.inputs, modes, &mut w.registers, &mut w.zdot);
        }
    }

    /// [`Dynamics::loads`] and f.
    pub fn forces(&mut self, modes: &[i32]) {
        self.loads(modes);
        let w = &mut self.work;
        for node in &self.mechanism.nodes {
            let b = node.body;
            w.unbalanced[b] = inertial(w, b, w.bias[b]) - w.applied[b];
        }
        let mut force = std::mem::take(&mut self.work.force);
        self.project(None, &mut force);
        self.work.force = force;
    }

    /// f − M a (nv) from the accelerations of the bodies that belong to `a`, without M; after [`Dynamics::loads`].
    pub fn unbalanced(&mut self, a: &[G::S], accelerations: &[Motion<G>], out: &mut [G::S]) {
        self.unbalance(accelerations);
        self.project(Some(a), out);
    }

    /// I A + V ×* I V − applied of each body.
    pub(super) fn unbalance(&mut self, accelerations: &[Motion<G>]) {
        let w = &mut self.work;
        for node in &self.mechanism.nodes {
            let b = node.body;
            w.unbalanced[b] = inertial(w, b, accelerations[b]) - w.applied[b];
        }
    }

    /// −s_k · Σ (unbalanced wrenches of all that hangs on k), and what efforts and rotors put on the coordinates.
    fn project(&mut self, a: Option<&[G::S]>, force: &mut [G::S]) {
        let m = self.mechanism;
        let w = &mut self.work;
        w.sums.copy_from_slice(&w.unbalanced);
        for node in m.nodes.iter().rev() {
            let sum = w.sums[node.body];
            for k in node.columns.clone() {
                force[k] = -sum.power(w.columns[k]);
            }
            if node.parent != 0 {
                w.sums[node.parent] += sum;
            }
        }
        let Workspace { efforts, readings, columns, functions, .. } = w;
        let along_gauge = |gauge: usize, size: G::S, force: &mut [G::S]| {
            m.gauges[gauge].project(&readings[gauge], columns, |k, x| force[k] += size * x);
        };
        for (effort, &size) in m.efforts.iter().zip(efforts.iter()) {
            match effort.along {
                StretchOf::Gauge(i) => along_gauge(i, size, force),
                StretchOf::Function(f) => {
                    let function = &m.functions[f];
                    for (i, &gauge) in function.gauges.iter().enumerate() {
                        along_gauge(gauge, size * functions[function.value + 1 + i], force);
                    }
                }
            }
        }
        for rotor in &m.rotors {
            let reading = &readings[rotor.gauge];
            let acceleration = a.map_or(reading.drift, |a| m.gauges[rotor.gauge].acceleration(reading, columns, a));
            along_gauge(rotor.gauge, -(rotor.inertia * acceleration), force);
        }
    }

    /// Inertias in world axes; after [`Dynamics::position`].
    pub fn inertias(&mut self) {
        let w = &mut self.work;
        for node in &self.mechanism.nodes {
            w.inertias[node.body] = self.mechanism.bodies[node.body].mass.in_world(w.places[node.body]);
        }
    }

    /// Gravity and loads at points as wrenches; after [`Dynamics::inertias`].
    fn applied(&mut self) {
        let m = self.mechanism;
        let w = &mut self.work;
        w.applied[0] = Force::default();
        for node in &m.nodes {
            let b = node.body;
            let inertia = w.inertias[b];
            w.applied[b] = Force { n: G::moment(inertia.h, m.gravity), f: m.gravity * inertia.m };
        }
        for pull in &m.point_loads {
            let frame = w.places[pull.frame].r;
            let axes = pull.axes.map_or(frame, |axes| G::multiply(frame, axes));
            let mut wrench = Force::default();
            if !pull.force.is_empty() {
                let mut f = [G::S::default(); 3];
                for (f, &output) in f.iter_mut().zip(&pull.force) {
                    *f = w.force_outputs[output];
                }
                wrench = Force::at(G::rotate(axes, G::from_components(f)), w.places[pull.body].point(pull.at));
            }
            for (axis, &output) in pull.torque.iter().enumerate() {
                let mut e = [0.0; 3];
                e[if G::SPIN == 1 { 2 } else { axis }] = 1.0;
                wrench.n += G::rotate_spin(axes, G::spin(e)) * w.force_outputs[output];
            }
            w.applied[pull.body] += wrench;
        }
    }

    /// Size of each effort.
    fn efforts(&mut self) {
        for (i, effort) in self.mechanism.efforts.iter().enumerate() {
            let outputs = &self.work.force_outputs;
            let size = match effort.law {
                EffortLaw::Linear { stiffness, rest, damping, preload } => {
                    -(stiffness * (self.extent(effort.along) - rest) + preload) - damping * self.extent_rate(effort.along)
                }
                EffortLaw::Law { spring, output, .. } => -outputs[output] - outputs[output + 1] * self.stretch_rate(spring),
                EffortLaw::Drive { output } | EffortLaw::Friction { output, pressing: None } => outputs[output],
                EffortLaw::Friction { .. } => G::S::default(),
            };
            self.work.efforts[i] = size;
        }
    }

    /// M; after [`Dynamics::inertias`].
    pub fn mass(&mut self) {
        let m = self.mechanism;
        let nv = m.nv;
        let Workspace { composite, inertias, columns, mass, mass_places, mass_roads, readings, .. } = &mut self.work;
        let full = mass.pattern().is_full();
        debug_assert!(full || !mass_places.is_empty(), "an evaluator without M");
        let (mut places, mut roads) = (&mass_places[..], mass_roads.iter());
        composite.copy_from_slice(inertias);
        if !m.rotors.is_empty() {
            // a rotor between two branches adds to entries that no ancestor writes
            mass.values_mut().fill(G::S::default());
        }
        let (pattern, values) = mass.parts_mut();
        for node in m.nodes.iter().rev() {
            let whole = composite[node.body];
            for k in node.columns.clone() {
                let momentum = whole * columns[k];
                let mut road = Some(k).filter(|_| full);
                while let Some(j) = road {
                    road = m.above[j];
                    let x = momentum.power(columns[j]);
                    (values[j * nv + k], values[k * nv + j]) = (x, x);
                }
                if let (false, Some(&length)) = (full, roads.next()) {
                    let (own, others) = places.split_at(length as usize);
                    places = others;
                    for &[j, above, below] in own {
                        let x = momentum.power(columns[j as usize]);
                        (values[above as usize], values[below as usize]) = (x, x);
                    }
                }
            }
            if node.parent != 0 {
                composite[node.parent] += whole;
            }
        }
        for rotor in &m.rotors {
            let (gauge, reading) = (&m.gauges[rotor.gauge], &readings[rotor.gauge]);
            gauge.project(reading, columns, |j, x| {
                gauge.project(reading, columns, |k, y| {
                    pattern.place(j, k).into_iter().for_each(|place| values[place] += rotor.inertia * (x * y));
                });
            });
        }
    }

    /// M a + Gᵀλ − f − f_λ (shapes nv, rows → nv); after [`Dynamics::mass`].
    pub fn residual(&self, a: &[G::S], lambda: &[G::S], r: &mut [G::S]) {
        let w = &self.work;
        for ((r, f), row) in r.iter_mut().zip(&w.force).zip(w.mass.lines()) {
            *r = -*f;
            row.entries().for_each(|(j, m)| *r += m * a[j]);
        }
        self.add_reactions(lambda, r);
    }

    /// Gᵀλ − f − f_λ (rows → nv): the residual without accelerations, which needs no M.
    pub fn imbalance(&self, lambda: &[G::S], r: &mut [G::S]) {
        r.iter_mut().zip(&self.work.force).for_each(|(r, f)| *r = -*f);
        self.add_reactions(lambda, r);
    }

    fn add_reactions(&self, lambda: &[G::S], r: &mut [G::S]) {
        self.work.g.lines().zip(lambda).for_each(|(row, l)| row.add_to(*l, r));
        self.add_friction(lambda, r);
    }
}

/// I A + V ×* I V of a body.
#[inline(always)]
fn inertial<G: Space>(w: &Workspace<G>, body: usize, acceleration: Motion<G>) -> Force<G> {
    w.inertias[body].momentum_rate(acceleration, w.twists[body])
}
