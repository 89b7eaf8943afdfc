//! The equations of motion of a mechanism in one state after the other.

use super::error::Error;
use super::state::{settle, sized};
use grashof_solvers::{Control, Engine, Kkt, Stage, State, System, Terms, Why};

/// Evaluates the equations of motion of a [`Mechanism`](super::Mechanism) in one state after the other, in memory that it takes once. The numbers do not
/// depend on what was evaluated before.
///
/// Shapes are those of [`Mechanism::sizes`](super::Mechanism::sizes): nq coordinates, nv velocities, m rows; matrices are written row by row. SI units.
pub struct Evaluator<'m> {
    system: Box<dyn System + 'm>,
    /// The state of the start, whose first-order states and modes each evaluation begins with.
    begin: State,
    state: State,
    terms: Terms,
    kkt: Kkt,
    a: Vec<f64>,
    lambda: Vec<f64>,
    modes: Vec<i32>,
    rest: Vec<f64>,
    /// What projects, made when it is needed first.
    engine: Option<Box<Engine>>,
}

impl<'m> Evaluator<'m> {
    /// Of a mechanism as the integrators see it, with its start.
    pub(super) fn new(system: Box<dyn System + 'm>, begin: State) -> Self {
        let (dims, pattern) = (system.dims(), system.pattern());
        Self {
            terms: Terms::new(dims, pattern),
            kkt: Kkt::of_pattern(pattern),
            a: vec![0.0; dims.v],
            lambda: vec![0.0; dims.rows()],
            modes: begin.modes.clone(),
            rest: vec![0.0; dims.v],
            engine: None,
            state: begin.clone(),
            begin,
            system,
        }
    }

    /// Takes a state, with the modes of its switches.
    fn stand(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), Error> {
        sized("coordinates", q, self.state.q.len())?;
        sized("velocities", v, self.state.v.len())?;
        self.state.copy_from(&self.begin);
        self.state.t = t;
        self.state.q.copy_from_slice(q);
        self.state.v.copy_from_slice(v);
        settle(&mut *self.system, &mut self.state, &mut self.modes);
        Ok(())
    }

    /// The terms of M(q) a + Gᵀλ = f(t, q, v), Φ(t, q) = 0, G v = ν, G a = γ in a state; matrices by their patterns.
    ///
    /// # Errors
    /// If q or v have other sizes than those of the mechanism.
    pub fn terms(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<&Terms, Error> {
        self.stand(t, q, v)?;
        self.system.terms(self.state.at(), Stage::Dynamics, &mut self.terms);
        Ok(&self.terms)
    }

    /// Those of the terms that depend on the position alone: M, Φ and G.
    ///
    /// # Errors
    /// If q has another size than that of the mechanism.
    pub fn position(&mut self, t: f64, q: &[f64]) -> Result<&Terms, Error> {
        let rest = std::mem::take(&mut self.rest);
        let stood = self.stand(t, q, &rest);
        self.rest = rest;
        stood?;
        self.system.terms(self.state.at(), Stage::Position, &mut self.terms);
        Ok(&self.terms)
    }

    /// Accelerations a (nv) and multipliers λ (m) in a state. Friction that depends on reactions is left out.
    ///
    /// # Errors
    /// If q or v have other sizes than those of the mechanism; if mass is missing.
    pub fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(&[f64], &[f64]), Error> {
        self.terms(t, q, v)?;
        let Self { terms, kkt, a, lambda, .. } = self;
        kkt.factor(terms.mass.values(), terms.g.values()).map_err(|_| without_mass("accelerations are"))?;
        kkt.solve(&terms.force, &terms.gamma, a, lambda);
        Ok((a, lambda))
    }

    /// Inverse dynamics: the forces along the velocities (nv) which, added to f, give accelerations `a`: M a + Gᵀλ − f.
    ///
    /// # Errors
    /// If an argument has another size than in the mechanism.
    pub fn inverse(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64], lambda: &[f64]) -> Result<&[f64], Error> {
        self.stand(t, q, v)?;
        sized("accelerations", a, self.a.len())?;
        sized("multipliers", lambda, self.lambda.len())?;
        self.system.residual(self.state.at(), a, lambda, &mut self.a);
        Ok(&self.a)
    }

    /// The state on the constraints next to one, as behind each step of a motion: q (nq) moved to Φ = 0 and v (nv) to G v = ν, each by the
    /// shortest way in the metric M.
    ///
    /// # Errors
    /// If q or v have other sizes than those of the mechanism; if the constraints cannot be closed from there, or mass is missing.
    pub fn project(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(&[f64], &[f64]), Error> {
        self.stand(t, q, v)?;
        let Self { system, state, engine, .. } = self;
        let engine = engine.get_or_insert_with(|| Box::new(Engine::new(&**system, Control::Steps([1.0; 2]))));
        let finite = state.q.iter().chain(&state.v).all(|x| x.is_finite());
        match engine.project(&mut **system, state) {
            Ok(()) if finite => Ok((&state.q, &state.v)),
            Err(Why::Singular) if finite => Err(without_mass("shortest way to the constraints is")),
            _ => Err(Error::Refused {
                message: "the constraints cannot be closed from this state".into(),
                help: "begin nearer to a position that the mechanism can take, as one that `start` or a result gives".into(),
            }),
        }
    }
}

/// That something is not determined by the masses.
fn without_mass(what: &str) -> Error {
    Error::Refused { message: format!("the {what} not determined: mass is missing"), help: "give each body that moves a mass".into() }
}
