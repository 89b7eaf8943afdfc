//! The family of Newmark: `newmark`, `hht` and `generalized-alpha`, one recursion with parameters.
//!
//! ```text
//! (1 − α_m) b₁ + α_m b₀ = (1 − α_f) a₁ + α_f a₀
//! q₁ = q₀ ⊕ (h v₀ + h² (½ − β) b₀ + h² β b₁ + w)
//! v₁ = v₀ + h (1 − γ) b₀ + h γ b₁
//! ```
//!
//! with the equations of motion and the rows of the [`Level`] at the end of the step (Newmark, J. Eng. Mech. Div. 85 (1959)
//! 67-94; Hilber, Hughes & Taylor 1977; Chung & Hulbert, J. Appl. Mech. 60 (1993) 371-375; Arnold & Brüls, Multibody Syst. Dyn.
//! 18 (2007) 185-202). First-order states follow the second and third line with ż in the place of a, as generalized-alpha
//! does for first-order systems (Jansen, Whiting & Hulbert, Comput. Methods Appl. Mech. Eng. 190 (2000) 305-319): of order 2, and
//! stable for every step if α_m ≤ α_f ≤ ½, under the same conditions as the motion.
//!
//! The auxiliary b belongs to the time t + θh, θ = α_m − α_f. So it begins as a + θhȧ and moves by θ(h_new − h_old)ȧ when the
//! step changes; without that q and v fall to order 1.
//!
//! At [`Level::Position`] the rows decide b along themselves: with steps of h the recursion holds Φ = 0 by velocities that are off
//! G v = ν by −C h²ȧ_N, C = β + θ/2 − 1/6, ȧ_N the part of ȧ along M⁻¹Gᵀ. This part moves with h² in the same way; left where it is,
//! it comes back as an error of order h in b after each change of the step (measured: errors up to seven times as large at steps of
//! 1 : 1.5).
//!
//! With a tolerance, the local error, of order h³, is held to 10 tol^(3/2): then the error of the run, of order h², is
//! proportional to the tolerance (Söderlind & Wang, J. Comput. Appl. Math. 185 (2006) 225-243, "tolerance proportionality"), and
//! Newton's method is that much more exact.

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Control, Engine, Node, Rejected, Why};
use crate::matrix::Coefficients;
use crate::newton::{Implicit, Newton, Place, Unknown};
use crate::scheme::{Level, Scheme};
use crate::settings::Settings;

/// The parameters of a member of the family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parameters {
    name: &'static str,
    alpha_m: f64,
    alpha_f: f64,
    /// Weight of b₁ in the displacement.
    beta: f64,
    /// Weight of b₁ in the velocity.
    gamma: f64,
}

impl Parameters {
    /// Newmark with the textbook's β and γ.
    pub(super) fn newmark(beta: f64, gamma: f64) -> Self {
        Self { name: "newmark", alpha_m: 0.0, alpha_f: 0.0, beta, gamma }
    }

    /// Hilber, Hughes & Taylor, α in [−1/3, 0]: γ = ½ − α, β = ¼(1 − α)².
    pub(super) fn hht(alpha: f64) -> Self {
        Self { name: "hht", alpha_m: 0.0, alpha_f: -alpha, beta: 0.25 * (1.0 - alpha).powi(2), gamma: 0.5 - alpha }
    }

    /// Chung & Hulbert with the spectral radius ρ at infinity, of least dissipation of what is slow.
    pub(super) fn generalized_alpha(rho: f64) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 + alpha_f - alpha_m;
        Self { name: "generalized-alpha", alpha_m, alpha_f, beta: 0.25 * (gamma + 0.5).powi(2), gamma }
    }

    /// θ: b belongs to t + θh.
    fn theta(self) -> f64 {
        self.alpha_m - self.alpha_f
    }

    /// db₁/da₁.
    fn slope(self) -> f64 {
        (1.0 - self.alpha_f) / (1.0 - self.alpha_m)
    }

    /// Local errors as multiples of h³ȧ in q, of h²ȧ and of h³ä in v.
    ///
    /// b = a + θhȧ + κh²ä solves the first line with κ = θ(α_m − ½); the other two follow by Taylor's series. With α = 0, β = ¼
    /// and γ = ½ these are the 1/12 of the trapezoidal rule.
    fn errors(self) -> [f64; 3] {
        let theta = self.theta();
        let kappa = theta * (self.alpha_m - 0.5);
        [self.beta + 0.5 * theta - 1.0 / 6.0, theta + self.gamma - 0.5, kappa + theta * self.gamma + 0.5 * self.gamma - 1.0 / 6.0]
    }
}

/// A quantity that is integrated: a of v, ż of z.
#[derive(Clone, Debug)]
struct Auxiliary {
    /// The rate at the last node, of the scheme's own equations.
    rate: Vec<f64>,
    /// b at the last node, for the step `Newmark::belongs`.
    b: Vec<f64>,
    /// b₀ of the step being tried.
    now: Vec<f64>,
    /// What b₁ is without a₁.
    constant: Vec<f64>,
    /// Derivative of the rate by time.
    slope: Vec<f64>,
}

impl Auxiliary {
    fn new(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Self { rate: zeros(), b: zeros(), now: zeros(), constant: zeros(), slope: zeros() }
    }

    /// Begins at a node with the given rate.
    fn begin(&mut self, rate: &[f64]) {
        self.rate.copy_from_slice(rate);
        self.b.copy_from_slice(rate);
        self.slope.fill(0.0);
    }

    /// b₀ shifted by `shift` (s) along the slope, the known part of b₁, and that of x₁ = x₀ + h(1 − γ)b₀ + hγb₁ into `hat`.
    fn prepare(&mut self, p: Parameters, shift: f64, h: f64, x: &[f64], hat: &mut [f64]) {
        for i in 0..x.len() {
            self.now[i] = self.b[i] + shift * self.slope[i];
            self.constant[i] = (p.alpha_f * self.rate[i] - p.alpha_m * self.now[i]) / (1.0 - p.alpha_m);
            hat[i] = x[i] + h * ((1.0 - p.gamma) * self.now[i] + p.gamma * self.constant[i]);
        }
    }

    /// A guess of the rate after `h`.
    fn predict(&self, h: f64, rate: &mut [f64]) {
        for ((r, r0), slope) in rate.iter_mut().zip(&self.rate).zip(&self.slope) {
            *r = r0 + h * slope;
        }
    }

    /// Takes the rate found at the end of the step and the rates reported at both ends.
    fn accept(&mut self, p: Parameters, h: f64, own: &[f64], from: &[f64], to: &[f64]) {
        self.rate.copy_from_slice(own);
        for i in 0..own.len() {
            self.b[i] = p.slope() * own[i] + self.constant[i];
            self.slope[i] = (to[i] - from[i]) / h;
        }
    }
}

/// A scheme of the family.
pub(super) struct Newmark {
    parameters: Parameters,
    level: Level,
    follow: bool,
    newton: Newton,
    x: Unknown,
    motion: Auxiliary,
    states: Auxiliary,
    /// The step to which b belongs, s: 0 for a rate as it is.
    belongs: f64,
    /// How far before the last node the slopes are taken, s.
    before: f64,
    /// d̂, v̂, ẑ of the step being tried.
    hats: [Vec<f64>; 3],
    /// Errors of q, v and z.
    errors: [Vec<f64>; 3],
    h: f64,
    factor: f64,
    /// ȧ_N (nv), and G ȧ and multipliers (m) on the way to it.
    normal: Vec<f64>,
    rows: Vec<f64>,
    mu: Vec<f64>,
    scratch: Node,
}

/// Place of the evaluations for ȧ at a start, in steps.
const REACH: f64 = 0.02;

/// A step is kept unless it may grow by this factor: the factors of Newton's matrix serve on.
const WORTH: f64 = 1.2;

impl Newmark {
    /// Room for a system.
    pub(super) fn new(parameters: Parameters, settings: Settings, system: &dyn System) -> Self {
        let dims = system.dims();
        let vectors = || [vec![0.0; dims.v], vec![0.0; dims.v], vec![0.0; dims.z]];
        Self {
            parameters,
            level: settings.level,
            follow: !settings.locate,
            newton: Newton::new(system),
            x: Unknown::new(dims),
            motion: Auxiliary::new(dims.v),
            states: Auxiliary::new(dims.z),
            belongs: 0.0,
            before: 0.0,
            hats: vectors(),
            errors: vectors(),
            h: 0.0,
            factor: 1.0,
            normal: vec![0.0; dims.v],
            rows: vec![0.0; dims.rows()],
            mu: vec![0.0; dims.rows()],
            scratch: Node::new(dims),
        }
    }

    /// ȧ_N of the slope, with the factors of the KKT matrix and the G evaluated last, which belong to about this position.
    fn split(&mut self, engine: &mut Engine) {
        let holonomic = engine.dims.holonomic;
        if self.level != Level::Position || holonomic == 0 {
            return;
        }
        self.rows.fill(0.0);
        for (r, g) in self.rows.iter_mut().zip(engine.terms.g.lines()).take(holonomic) {
            *r = g.dot(&self.motion.slope);
        }
        self.hats[0].fill(0.0);
        engine.kkt.solve(&self.hats[0], &self.rows, &mut self.normal, &mut self.mu);
    }

    /// d̂, v̂, ẑ and the guesses of the unknowns.
    fn prepare(&mut self, from: &Node, h: f64) {
        let p = self.parameters;
        let shift = p.theta() * (h - self.belongs);
        let [d, v, z] = &mut self.hats;
        self.motion.prepare(p, shift, h, &from.state.v, v);
        self.states.prepare(p, shift, h, &from.state.z, z);
        let off = p.errors()[0] * (self.belongs * self.belongs - h * h);
        for (i, d) in d.iter_mut().enumerate() {
            let b = (0.5 - p.beta) * self.motion.now[i] + p.beta * self.motion.constant[i];
            let shift = off * self.normal[i];
            v[i] += shift;
            *d = h * (from.state.v[i] + shift + h * b);
        }
        self.motion.predict(h, &mut self.x.a);
        self.states.predict(h, &mut self.x.zdot);
        self.x.lambda.copy_from_slice(&from.lambda);
        self.x.w.fill(0.0);
    }

    /// Solves the step and completes the node at its end.
    fn solve(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Why> {
        self.prepare(from, h);
        let p = self.parameters;
        let c = Coefficients { q: h * h * p.beta * p.slope(), v: h * p.gamma * p.slope(), z: h * p.gamma * p.slope() };
        let [d, v, z] = &self.hats;
        let (level, follow) = (self.level, self.follow);
        let stage = Implicit { t: from.state.t + h, span: h, q: &from.state.q, d, v, z, c, place: Place::Retract, level, follow };
        to.state.copy_from(&from.state);
        self.newton.solve(system, engine, &stage, &mut self.x, &mut to.state)?;
        if self.level == Level::Acceleration {
            engine.settle(system, to)?;
        } else {
            engine.accelerate(system, to)?;
        }
        // the loop counts what was marched across
        to.state.modes.copy_from_slice(&from.state.modes);
        Ok(())
    }

    /// The local error, 1 at the tolerance: of the rates that are reported at both ends, so that no multiplier of a level enters.
    fn error(&mut self, engine: &Engine, from: &Node, to: &Node, h: f64) -> f64 {
        let [c_q, first, second] = self.parameters.errors();
        let [e_q, e_v, e_z] = &mut self.errors;
        let middle = 0.5 * h + self.before;
        // h²ȧ and h³ä of a rate, by differences
        let rises = |x0: f64, x1: f64, slope: f64| (h * (x1 - x0), h * h * (x1 - x0 - h * slope) / middle);
        for (i, slope) in self.motion.slope.iter().enumerate() {
            let (rise, bend) = rises(from.a[i], to.a[i], *slope);
            e_q[i] = c_q * h * rise;
            e_v[i] = first * rise + second * bend;
        }
        for (i, slope) in self.states.slope.iter().enumerate() {
            let (rise, bend) = rises(from.zdot[i], to.zdot[i], *slope);
            e_z[i] = first * rise + second * bend;
        }
        engine.step_norm(&from.state, e_q, e_v, e_z)
    }

    /// The same as far as it is known before the step: of q by ȧ.
    fn expected(&mut self, engine: &Engine, from: &Node, h: f64) -> f64 {
        let [c_q, ..] = self.parameters.errors();
        let [e_q, e_v, e_z] = &mut self.errors;
        e_q.iter_mut().zip(&self.motion.slope).for_each(|(e, slope)| *e = c_q * h.powi(3) * slope);
        e_v.fill(0.0);
        e_z.fill(0.0);
        engine.step_norm(&from.state, e_q, e_v, e_z)
    }

    /// A step, and whether its error is small enough.
    fn try_step(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        self.h = h;
        let fixed = engine.is_fixed();
        if !fixed && self.before == 0.0 {
            // the guess of a first step comes from a scheme of another order
            let error = self.expected(engine, from, h);
            if error > 8.0 {
                return Err(Rejected { why: Why::Error(error), retry: h * 0.85 * error.powf(-1.0 / 3.0) });
            }
        }
        self.solve(system, engine, from, h, to).map_err(|why| Rejected { why, retry: 0.3 * h })?;
        if fixed {
            return Ok(());
        }
        let error = self.error(engine, from, to, h);
        self.factor = factor(error);
        if error <= 1.0 { Ok(()) } else { Err(Rejected { why: Why::Error(error), retry: h * self.factor.min(0.8) }) }
    }
}

/// The tolerance of a step for the tolerance of a run.
fn local(tolerance: f64) -> f64 {
    tolerance * (10.0 * tolerance.sqrt()).min(1.0)
}

/// Factor of the step for a local error of order h³.
fn factor(error: f64) -> f64 {
    (0.85 * error.max(1e-6).powf(-1.0 / 3.0)).clamp(0.1, 4.0)
}

impl Scheme for Newmark {
    fn restart(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> Result<(), Why> {
        self.newton.forget();
        self.motion.begin(&node.a);
        self.states.begin(&node.zdot);
        (self.belongs, self.before) = (0.0, 0.0);
        let reach = REACH * h;
        engine.jerk(system, node, reach, &mut self.scratch, &mut self.motion.slope)?;
        // the scratch is left at the time t + reach
        for ((slope, x1), x0) in self.states.slope.iter_mut().zip(&self.scratch.zdot).zip(&node.zdot) {
            *slope = (x1 - x0) / reach;
        }
        self.split(engine);
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        let control = engine.control;
        if let Control::Tolerance(tolerance) = control {
            engine.control = Control::Tolerance(local(tolerance));
        }
        let tried = self.try_step(system, engine, from, h, to);
        engine.control = control;
        tried
    }

    fn completes(&self) -> bool {
        true
    }

    fn accept(&mut self, engine: &mut Engine, from: &Node, to: &Node) -> f64 {
        let (p, h) = (self.parameters, self.h);
        self.motion.accept(p, h, &self.x.a, &from.a, &to.a);
        self.states.accept(p, h, &self.x.zdot, &from.zdot, &to.zdot);
        (self.belongs, self.before) = (h, 0.5 * h);
        self.split(engine);
        if engine.is_fixed() || (1.0..WORTH).contains(&self.factor) { h } else { h * self.factor }
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        out.hermite(system, engine, from, to)
    }

    fn is_implicit(&self) -> bool {
        true
    }

    fn order(&self) -> usize {
        2
    }

    fn name(&self) -> &'static str {
        self.parameters.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_of_second_order_and_stable() {
        let members = [0.0, 0.3, 0.8, 1.0].map(Parameters::generalized_alpha).into_iter();
        for p in members.chain([-1.0 / 3.0, -0.1, 0.0].map(Parameters::hht)).chain([Parameters::newmark(0.25, 0.5)]) {
            let [_, first, _] = p.errors();
            assert!(first.abs() < 1e-15, "{p:?}");
            assert!(p.alpha_m <= p.alpha_f && p.alpha_f <= 0.5 && p.beta >= 0.25 + 0.5 * (p.alpha_f - p.alpha_m) - 1e-15, "{p:?}");
        }
        let trapezoidal = Parameters::newmark(0.25, 0.5).errors();
        assert!((trapezoidal[0] - 1.0 / 12.0).abs() < 1e-15 && (trapezoidal[2] - 1.0 / 12.0).abs() < 1e-15);
        let same = |a: Parameters, b: Parameters| assert!((a.beta - b.beta).abs() + (a.gamma - b.gamma).abs() < 1e-15);
        same(Parameters::hht(0.0), Parameters::newmark(0.25, 0.5));
        same(Parameters::generalized_alpha(1.0), Parameters::newmark(0.25, 0.5));
    }
}
