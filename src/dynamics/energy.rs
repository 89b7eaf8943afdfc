//! Energies, momenta and the centre of mass of the state evaluated last.

use super::Dynamics;
use crate::expression::Integrand;
use crate::geometry::{Force, Motion, Space};
use crate::mechanism::{EffortLaw, Leaf};
use crate::scalar::Scalar;

impl<G: Space> Dynamics<'_, G> {
    /// T = ½ Σ V·I V + ½ Σ J ẋ², J; after [`Dynamics::forces`].
    #[must_use]
    pub fn kinetic_energy(&self) -> G::S {
        let w = &self.work;
        let mut twice = G::S::default();
        for node in &self.mechanism.nodes {
            let v = w.twists[node.body];
            twice += (w.inertias[node.body] * v).power(v);
        }
        for rotor in &self.mechanism.rotors {
            let rate = w.readings[rotor.gauge].rate;
            twice += rotor.inertia * rate * rate;
        }
        twice.scale(0.5)
    }

    /// Potential energy of gravity, J; zero at the world origin.
    #[must_use]
    pub fn gravity_energy(&self) -> G::S {
        let mut sum = G::S::default();
        for node in &self.mechanism.nodes {
            let inertia = self.work.inertias[node.body];
            sum -= G::dot(self.mechanism.gravity, inertia.h + self.reference(node.body) * inertia.m);
        }
        sum
    }

    /// Potential energy of bodies in a field of gravity that has a potential, J.
    fn field_energy(&mut self, modes: &[i32]) -> G::S {
        let m = self.mechanism;
        let mut sum = G::S::default();
        if m.point_loads.iter().any(|pull| pull.potential.is_some()) {
            self.fill(&m.force_program);
            let w = &mut self.work;
            m.force_program.program.eval(&w.inputs, modes, &mut w.registers, &mut w.force_outputs);
            m.point_loads.iter().filter_map(|pull| pull.potential).for_each(|output| sum += w.force_outputs[output]);
        }
        sum
    }

    /// Power of what has a potential among the loads at points, W; after [`Dynamics::loads`].
    #[must_use]
    pub fn field_power(&self) -> G::S {
        let w = &self.work;
        let mut sum = G::S::default();
        for pull in self.mechanism.point_loads.iter().filter(|pull| pull.potential.is_some()) {
            let velocity = w.twists[pull.body].at(w.places[pull.body].point(pull.at));
            for (axis, &output) in pull.force.iter().enumerate() {
                sum += w.force_outputs[output] * G::component(velocity, axis);
            }
        }
        sum
    }

    /// Power of the effort of each end stop that gives way, and the rate of what it stores, W: the rest is that of a damper. After
    /// [`Dynamics::loads`].
    pub fn buffer_powers(&self) -> impl Iterator<Item = [G::S; 2]> {
        self.mechanism.buffers.iter().map(|buffer| {
            let reading = &self.work.readings[buffer.gauge];
            [self.work.efforts[buffer.effort] * reading.rate, buffer.energy(reading.x).1 * reading.rate]
        })
    }

    /// Total mass, kg, and first moment Σ m c, kg m.
    #[must_use]
    pub fn first_moment(&self) -> (G::S, G::Vector) {
        let (mut m, mut h) = (G::S::default(), G::Vector::default());
        for node in &self.mechanism.nodes {
            let inertia = self.work.inertias[node.body];
            m += inertia.m;
            h += inertia.h + self.reference(node.body) * inertia.m;
        }
        (m, h)
    }

    /// Momentum wrench Σ I V: angular about the world origin, linear. kg m²/s, kg m/s.
    #[must_use]
    pub fn momentum(&self) -> Force<G> {
        let mut sum = Force::default();
        for node in &self.mechanism.nodes {
            sum += (self.work.inertias[node.body] * self.work.twists[node.body]).about_origin(self.reference(node.body));
        }
        sum
    }

    /// Rate of the momentum of one body with acceleration `a`: I A + V ×* I V.
    #[must_use]
    pub fn inertial(&self, body: usize, a: Motion<G>) -> Force<G> {
        self.work.inertias[body].momentum_rate(a, self.work.twists[body])
    }
}

impl<G: Space<S = f64>> Dynamics<'_, G> {
    /// Potential energy of gravity, springs and end stops that give way, J.
    #[must_use]
    pub fn potential_energy(&mut self, modes: &[i32]) -> f64 {
        let mut sum = self.gravity_energy() + self.field_energy(modes);
        for spring in 0..self.mechanism.stretches.len() {
            sum += self.spring_energy(spring, modes);
        }
        for buffer in &self.mechanism.buffers {
            sum += buffer.energy(self.work.readings[buffer.gauge].x).0;
        }
        sum
    }

    /// Energy stored in a spring: ½ k s² + F₀ s for a linear one; ∫₀ˢ F ds for a law, at fixed time, to round-off. Switches of time alone
    /// have their `modes` (switches).
    #[must_use]
    pub fn spring_energy(&mut self, spring: usize, modes: &[i32]) -> f64 {
        let m = self.mechanism;
        let s = self.stretch(spring);
        match m.efforts[m.spring_efforts[spring]].law {
            EffortLaw::Linear { stiffness, preload, .. } => 0.5 * stiffness * s * s + preload * s,
            EffortLaw::Law { .. } => self.over_stretch(spring, 0, modes),
            EffortLaw::Drive { .. } | EffortLaw::Friction { .. } => 0.0,
        }
    }

    /// Power that time puts in through a spring, W: its force works on what moves by time alone, and what it stores changes where its
    /// law does, −τ ∂s/∂t + ∂U/∂t, in the `modes` of [`Dynamics::spring_energy`]. After [`Dynamics::loads`].
    #[must_use]
    pub fn spring_power(&mut self, spring: usize, modes: &[i32]) -> f64 {
        let effort = self.mechanism.spring_efforts[spring];
        let by_time = self.extent_by_time(self.mechanism.stretches[spring].of) - self.moving_rest(spring, 1);
        let power = -(self.work.efforts[effort] * by_time);
        match self.mechanism.efforts[effort].law {
            EffortLaw::Law { timed: true, .. } => power + self.over_stretch(spring, 1, modes),
            _ => power,
        }
    }

    /// A spring whose stored energy was not resolved, since its law changes at too many places.
    #[must_use]
    pub fn unresolved_spring(&self) -> Option<usize> {
        self.work.unresolved_spring
    }

    /// ∫₀ˢ of the law of a spring (`output` 0: what it stores, J) or of its derivative by time with what its jumps add (1: W).
    fn over_stretch(&mut self, spring: usize, output: usize, modes: &[i32]) -> f64 {
        let way = self.stretch(spring);
        let Some(law) = self.mechanism.spring_laws.get(spring).and_then(Option::as_ref) else { return 0.0 };
        self.fill(law);
        let of = |leaf: Leaf| law.fills.iter().find(|(_, l)| *l == leaf).map(|(input, _)| *input);
        let (over, time) = (of(Leaf::Stretch { spring, order: 0 }), of(Leaf::Time));
        let mut outputs = [0.0; 2];
        let w = &mut self.work;
        let (inputs, registers) = (w.inputs.as_mut_slice(), w.registers.as_mut_slice());
        let jumping = time.filter(|_| output == 1).map(|time| [0, time]);
        let mut integrand = Integrand { program: &law.program, inputs, registers, outputs: &mut outputs, modes, over, output, jumping };
        w.integral.to(way, &mut integrand).unwrap_or_else(|seen| {
            w.unresolved_spring = Some(spring);
            seen
        })
    }
}
