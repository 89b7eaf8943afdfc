//! What an integrator asks of a mechanical system.

use crate::{At, Block, Dims, Pattern, Span, State};

/// How much of [`Terms`] is wanted; each stage includes the ones before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Φ, G and M: functions of (t, q).
    Position,
    /// Also ν and γ: functions of (t, q, v).
    Velocity,
    /// Also f and ż: functions of (t, q, v, z).
    Dynamics,
}

/// The terms of the equations of motion at one state; matrices by the patterns of the system.
///
/// Units: a row of M, f and Gᵀλ is a generalised force (N for a slide, N·m for a turn); a row of Φ has its own unit (m or rad),
/// and λ is force per that unit of the row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    /// M (nv × nv), symmetric, positive semi-definite.
    pub mass: Block,
    /// f (nv): applied, elastic, damping and gyroscopic forces; positive along v, so that M a = f where nothing constrains.
    /// What depends on the reactions is not in it, see [`System::reaction_friction`].
    pub force: Vec<f64>,
    /// Φ (holonomic rows).
    pub phi: Vec<f64>,
    /// G (m × nv): ∂Φ̇/∂v, then Ψ. The generalised force of the constraints is −Gᵀλ.
    pub g: Block,
    /// ν (m): G v = ν; −Φ_t, then ψ.
    pub nu: Vec<f64>,
    /// γ (m): G a = γ; minus all of Φ̈ that does not hold a, then the same of the velocity-level rows.
    pub gamma: Vec<f64>,
    /// ż (nz).
    pub zdot: Vec<f64>,
    /// Of which position M, Φ and G are: whoever changes them sets it to 0.
    pub position: Position,
}

/// A number that a system gives to each position of which it evaluates M, Φ and G, and to no other one, so that terms which hold
/// them need not get them again; 0 where a system does not count. Terms of different numbers may be equal.
#[derive(Clone, Copy, Debug, Default)]
pub struct Position(pub u64);

impl PartialEq for Position {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Terms {
    /// Zeros of the sizes and patterns of a system.
    pub fn new(dims: Dims, pattern: &Pattern) -> Self {
        let m = dims.rows();
        Self {
            mass: Block::new(&pattern.mass),
            force: vec![0.0; dims.v],
            phi: vec![0.0; dims.holonomic],
            g: Block::new(&pattern.g),
            nu: vec![0.0; m],
            gamma: vec![0.0; m],
            zdot: vec![0.0; dims.z],
            position: Position::default(),
        }
    }
}

/// Derivatives of the residual r = M a + Gᵀλ − f and of ż, by the patterns of the system.
///
/// A derivative by q is along velocities: K δ = d r(q ⊕ εδ)/dε at ε = 0, so every block by q has nv columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tangent {
    /// K = ∂r/∂q (nv × nv).
    pub k: Block,
    /// C = ∂r/∂v (nv × nv).
    pub c: Block,
    /// ∂r/∂z (nv × nz).
    pub r_z: Block,
    /// ∂r/∂λ − Gᵀ (nv × m): friction that depends on reactions.
    pub r_lambda: Block,
    /// ∂ż/∂q (nz × nv).
    pub z_q: Block,
    /// ∂ż/∂v (nz × nv).
    pub z_v: Block,
    /// ∂ż/∂z (nz × nz).
    pub z_z: Block,
}

impl Tangent {
    /// Whether all derivatives are numbers.
    pub fn is_finite(&self) -> bool {
        let Self { k, c, r_z, r_lambda, z_q, z_v, z_z } = self;
        [k, c, r_z, r_lambda, z_q, z_v, z_z].iter().all(|block| block.values().iter().all(|x| x.is_finite()))
    }

    /// Zeros of the patterns of a system.
    pub fn new(pattern: &Pattern) -> Self {
        Self {
            k: Block::new(&pattern.k),
            c: Block::new(&pattern.c),
            r_z: Block::new(&pattern.r_z),
            r_lambda: Block::new(&pattern.r_lambda),
            z_q: Block::new(&pattern.z_q),
            z_v: Block::new(&pattern.z_v),
            z_z: Block::new(&pattern.z_z),
        }
    }
}

/// What the crossing of a root does to a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// It is only noted.
    Record,
    /// The run ends here.
    Stop,
    /// The right-hand side changes (a mode, a parameter): the scheme starts afresh.
    Restart,
    /// Velocities jump along the row that `cross` wrote: row·v⁺ = −restitution · row·v⁻.
    Impulse {
        /// Coefficient of restitution, 0 (plastic) to 1 (elastic).
        restitution: f64,
        /// Whether the run ends there, too.
        stops: bool,
    },
    /// An [`Effect::Impulse`] against a stop that knows itself when to let the motion rest: blows that follow each other ever faster
    /// end there, and are no pile of events.
    Bounce {
        /// Coefficient of restitution, 0 (plastic) to 1 (elastic).
        restitution: f64,
        /// Whether the run ends there, too.
        stops: bool,
    },
}

/// What is known beforehand of root functions that depend on time alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ahead {
    /// All stay positive.
    Clear,
    /// When the first leaves its positive side (s; just behind it), and its number.
    Crossing(f64, usize),
    /// Positive until then (s), and not known beyond: the number of the root that could not be bounded.
    Unknown(f64, usize),
}

/// A constrained mechanical system, as an integrator sees it.
///
/// Every evaluation is a pure function of its arguments: calls in any order give the same bits. `&mut self` is for workspace
/// only. No method allocates, and none knows the index of the equations, the step or the scheme. Slices have the sizes of
/// [`dims`](Self::dims), blocks the patterns of [`pattern`](Self::pattern), and are overwritten, not added to.
pub trait System {
    /// Sizes; constant.
    fn dims(&self) -> Dims;

    /// Patterns of the blocks and scales of the equations; constant.
    fn pattern(&self) -> &Pattern;

    /// The terms of the equations of motion up to `stage`; what belongs to later stages is left as it is.
    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms);

    /// r = M a + Gᵀλ − f (nv), with the forces that depend on the reactions λ.
    fn residual(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]);

    /// The forces f_λ (nv) that depend on the reactions λ, and −∂f_λ/∂λ (nv × m): r = M a + Gᵀλ − f − f_λ. Asked only where
    /// [`Pattern::r_lambda`] has entries; a system without such forces writes zeros, which is the default.
    fn reaction_friction(&mut self, at: At<'_>, lambda: &[f64], force: &mut [f64], r_lambda: &mut Block) {
        let _ = (at, lambda);
        force.fill(0.0);
        r_lambda.values_mut().fill(0.0);
    }

    /// Derivatives of [`residual`](Self::residual) and of ż.
    fn tangent(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], out: &mut Tangent);

    /// q̇ = N(q) v (nq); where loops are closed inside of a system, the part that time prescribes as well.
    fn rate(&self, t: f64, q: &[f64], v: &[f64], qdot: &mut [f64]);

    /// N(q) u (nq): the change of q along u (nv) at a fixed time. Where nothing is prescribed by time that is the rate, which is the
    /// default.
    fn lift(&self, t: f64, q: &[f64], u: &[f64], change: &mut [f64]) {
        self.rate(t, q, u, change);
    }

    /// q̈ = N a + Ṅ v (nq) at the rates `qdot` that belong to v; `scratch` has nq entries. The default is that of an N which is affine
    /// in q, so that Ṅ v = N(q + q̇) v − N(q) v.
    fn second_rate(&self, t: f64, q: &[f64], [v, a]: [&[f64]; 2], qdot: &[f64], scratch: &mut [f64], out: &mut [f64]) {
        scratch.iter_mut().zip(q).zip(qdot).for_each(|((x, q), r)| *x = q + r);
        self.lift(t, scratch, v, out);
        out.iter_mut().zip(qdot).for_each(|(x, r)| *x -= r);
        self.lift(t, q, a, scratch);
        out.iter_mut().zip(&*scratch).for_each(|(x, r)| *x += r);
    }

    /// q := q ⊕ δ, the motion by the finite displacement δ (nv) in the frame of v, and by what time prescribes over the span; the norm
    /// of a quaternion is kept.
    fn retract(&self, span: Span, q: &mut [f64], delta: &[f64]);

    /// q := the solution of q = q̂ + N(q) u, where `q` comes in as q̂ and u = c_v v (nv), with what time prescribes over the span c_v:
    /// the closed form of an implicit step.
    fn displace(&self, span: Span, q: &mut [f64], u: &[f64]);

    /// Powers (W) whose integrals are the work of the energy balance.
    fn power(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], w: &mut [f64]);

    /// The mode of every switch that belongs to the values at hand; `at.modes` decides on a switch that stands exactly at its edge.
    fn modes(&mut self, at: At<'_>, modes: &mut [i32]);

    /// The longest step, s, from a state or to it in which values that are followed from their last ones, as angles that count turns, are
    /// not lost. A system without such values has none, which is the default.
    fn longest(&mut self, _at: At<'_>) -> f64 {
        f64::INFINITY
    }

    /// Root functions (roots), each positive inside of the present mode.
    fn roots(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], g: &mut [f64]);

    /// Which of `roots`, all of them among [`Pattern::timed`], leaves its positive side first in [`at.t`, `to`], in the modes of `at`; one
    /// that is not positive at the begin counts if it does not become so at once. By bounds, not by looks: no crossing between two is
    /// missed. Asked only where [`Pattern::timed`] has entries; a system without them has nothing to tell, which is the default.
    fn ahead(&mut self, at: At<'_>, to: f64, roots: &[usize]) -> Ahead {
        let _ = (at, to, roots);
        Ahead::Clear
    }

    /// Carries the state over a root that has become negative: flips its own mode, changes its own parameters.
    ///
    /// `row` (nv) receives the direction of an impulse; without one it is left as it is.
    fn cross(&mut self, root: usize, state: &mut State, row: &mut [f64]) -> Effect;

    /// Gives the switch of a root that has become zero and stays so the mode of equal operands, and tells what that does to the run; none
    /// if it has it already. The root of a value that comes to rest on what it is compared with never becomes negative. A system in
    /// which no value rests has nothing to change, which is the default.
    fn equal(&mut self, _root: usize, _state: &mut State) -> Option<Effect> {
        None
    }

    /// Whether the terms evaluated last have a value that their modes do not define, and that is another branch's: there is no smooth
    /// continuation. A system whose branches are defined everywhere has none, which is the default.
    fn beyond(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_object_safe() {
        fn takes(_: Option<&mut dyn System>) {}
        takes(None);
    }

    #[test]
    fn blocks_have_the_sizes_of_their_names() {
        let dims = Dims { q: 4, v: 3, z: 2, holonomic: 1, nonholonomic: 1, ..Dims::default() };
        let pattern = Pattern { r_lambda: crate::Sparsity::dense(3, 2), ..Pattern::dense(dims) };
        let (terms, tangent) = (Terms::new(dims, &pattern), Tangent::new(&pattern));
        assert_eq!((terms.mass.values().len(), terms.g.values().len(), terms.phi.len(), terms.nu.len(), terms.zdot.len()), (9, 6, 1, 2, 2));
        assert_eq!(
            (
                tangent.k.values().len(),
                tangent.r_z.values().len(),
                tangent.r_lambda.values().len(),
                tangent.z_q.values().len(),
                tangent.z_z.values().len()
            ),
            (9, 6, 6, 6, 4)
        );
    }
}
