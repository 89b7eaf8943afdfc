//! The explicit Runge-Kutta method DOP853 of Dormand & Prince on the equations of index 1, with projection after each step.
//!
//! Twelve stages of order 8, an error estimate combined from orders 5 and 3, and a continuous solution of order 7 from three
//! more stages: Hairer, Nørsett & Wanner, Solving ODEs I, 2nd ed., sections II.5 and II.6. Where the steps before tell enough
//! (`past.rs`) the continuous solution is the polynomial through their nodes instead, which takes no evaluation. The error is that of the step before
//! projection; the accelerations behind it are the first stage of the next step. Where an error is too large a singular position
//! may be near: `crossing.rs` says how it is passed.

use super::explicit::{Flow, Row, advance, rows};
use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Engine, LONGEST_RETRY, Node, Rejected, Why};
use crate::scheme::Scheme;
use crate::settings::Settings;
use coefficients::*;
use crossing::Crossing;
use past::Past;
use stiffness::Stiffness;
use work::Work;

pub(super) use stiffness::BORDER;

mod coefficients;
mod crossing;
mod past;
mod stiffness;
#[cfg(test)]
mod tests;
mod work;

/// Stage that begins the next step.
const LAST: usize = 12;

/// A step changes by factors between these; the first is for safety, [`safety`].
const SHRINK: f64 = 0.333;
const GROW: f64 = 6.0;

/// The method with the stages of one step.
pub(super) struct Dop853 {
    flow: Flow,
    /// y at the begin of the step.
    y0: Vec<f64>,
    /// y of a stage; behind a step, of stage 11, which lies at its end.
    y: Vec<f64>,
    /// y at the end of the step, before projection, then after it.
    y1: Vec<f64>,
    /// F of every stage, stage after stage.
    k: Vec<f64>,
    /// Errors of orders 5 and 3 over h.
    e5: Vec<f64>,
    e3: Vec<f64>,
    stiffness: Stiffness,
    crossing: Crossing,
    work: Work,
    past: Past,
    /// Whether the stages of this step are projected.
    projected: bool,
    h: f64,
    factor: f64,
    rejected: bool,
}

impl Dop853 {
    /// Room for a system; where switches are not located, the modes of every stage are taken from its values.
    pub(super) fn new(settings: Settings, system: &dyn System) -> Self {
        let flow = Flow::new(system, !settings.locate);
        let vector = vec![0.0; flow.n];
        Self {
            y0: vector.clone(),
            y: vector.clone(),
            y1: vector.clone(),
            k: vec![0.0; STAGES * flow.n],
            e5: vector.clone(),
            e3: vector,
            stiffness: Stiffness::new(system),
            crossing: Crossing::new(system.dims()),
            work: Work::new(settings, system),
            past: Past::new(flow.n),
            projected: false,
            h: 0.0,
            factor: 1.0,
            rejected: false,
            flow,
        }
    }

    /// Whether stability bounds the steps, not accuracy.
    pub(super) fn stiff(&self) -> bool {
        self.stiffness.stiff()
    }

    /// Estimate of h|λ| in the last step.
    pub(super) fn product(&self) -> f64 {
        self.stiffness.product
    }

    /// Estimate of |λ| in the last step, λ the largest eigenvalue, 1/s.
    pub(super) fn fastest(&self) -> f64 {
        self.stiffness.product / self.h
    }

    /// F of one more stage.
    fn stage<const J: usize>(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        from: &Node,
        (number, row): (usize, &Row<J>),
    ) -> Result<(), Why> {
        let n = self.flow.n;
        advance(self.h, row, &self.k, &self.y0, &mut self.y);
        let rate = &mut self.k[number * n..][..n];
        let t = from.state.t + C[number] * self.h;
        if self.projected {
            return self.flow.settled(system, engine, (&from.state, t), &self.y, &mut self.crossing.node, rate);
        }
        self.flow.rates(system, engine, (t, &from.state.live), &self.y, rate)?;
        if self.work.wants(number) {
            let (at, solved) = self.flow.solved((t, &from.state.live), &self.y, rate);
            self.work.stage(number, system, at, solved);
        }
        Ok(())
    }

    /// The stages of a step behind the first, which is known.
    fn stages(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node) -> Result<(), Why> {
        self.stage(system, engine, from, (1, &A1))?;
        self.stage(system, engine, from, (2, &A2))?;
        self.stage(system, engine, from, (3, &A3))?;
        self.stage(system, engine, from, (4, &A4))?;
        self.stage(system, engine, from, (5, &A5))?;
        self.stage(system, engine, from, (6, &A6))?;
        self.stage(system, engine, from, (7, &A7))?;
        self.stage(system, engine, from, (8, &A8))?;
        self.stage(system, engine, from, (9, &A9))?;
        self.stage(system, engine, from, (10, &A10))?;
        self.stage(system, engine, from, (11, &A11))
    }

    /// y at the end of the step and both errors, in one pass over the stages.
    fn sum(&mut self) {
        let n = self.flow.n;
        let rates = rows(&B, &self.k, n);
        let (y0, y1, e5, e3) = (&self.y0[..n], &mut self.y1[..n], &mut self.e5[..n], &mut self.e3[..n]);
        let [first, eighth, last] = rows(&B3, &self.k, n);
        for i in 0..n {
            let (mut sum, mut error) = (0.0, 0.0);
            for ((rate, (_, b)), (_, e)) in rates.iter().zip(&B).zip(&E5) {
                sum += b * rate[i];
                error += e * rate[i];
            }
            y1[i] = y0[i] + self.h * sum;
            e5[i] = error;
            e3[i] = sum - B3[0].1 * first[i] - B3[1].1 * eighth[i] - B3[2].1 * last[i];
        }
    }

    /// The projected end of a step near a singular position; of the errors, what lies along the constraints there.
    fn arrive(&mut self, system: &mut dyn System, engine: &mut Engine, to: &mut Node) -> Result<(), Why> {
        engine.settle(system, to)?;
        self.crossing.arrive(engine, to);
        let (nq, nv) = (to.state.q.len(), to.state.v.len());
        for e in [&mut self.e5, &mut self.e3] {
            let (e_q, rest) = e.split_at_mut(nq);
            self.crossing.along(system, engine, e_q, &mut rest[..nv]);
        }
        Ok(())
    }

    /// A step that cannot be evaluated.
    fn fails(&mut self, from: &Node, why: Why) -> Rejected {
        Rejected { why, retry: self.crossing.reject(from.state.t, 0.25 * self.h) }
    }

    /// A step whose error is too large: perhaps because of a singular position.
    fn errs(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, error: f64) -> Rejected {
        self.rejected = true;
        let (t, h) = (from.state.t, self.h);
        let shorter = h * if error.is_finite() { self.factor } else { SHRINK };
        let retry = match self.projected {
            true => self.crossing.reject(t, shorter),
            // how long a step may be shows with projected stages
            false => match self.crossing.look(system, engine, from, h) {
                Ok(near) => self.crossing.plan(t, if near { LONGEST_RETRY * h } else { shorter }),
                Err(why) => return self.fails(from, why),
            },
        };
        Rejected { why: Why::Error(error), retry }
    }

    /// The continuous solution from three more stages, in the nested form
    /// y₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(r₄ + θ(r₅ + (1−θ)(r₆ + θ r₇)))))), in powers of θ. Its first three terms are Hermite's cubic
    /// through the projected ends.
    fn more_stages(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, out: &mut Dense) -> Result<(), Why> {
        let n = self.flow.n;
        self.stage(system, engine, from, (13, &A13))?;
        self.stage(system, engine, from, (14, &A14))?;
        self.stage(system, engine, from, (15, &A15))?;
        let h = self.h;
        let (first, last) = (&self.k[..n], &self.k[LAST * n..][..n]);
        for i in 0..n {
            let sum = |row: &Row<12>| h * row.iter().map(|(j, c)| c * self.k[j * n + i]).sum::<f64>();
            let r1 = self.y1[i] - self.y0[i];
            let r2 = h * first[i] - r1;
            let r3 = r1 - h * last[i] - r2;
            let [r4, r5, r6, r7] = [sum(&D4), sum(&D5), sum(&D6), sum(&D7)];
            out.set_entry(i, &powers(self.y0[i], [r1, r2, r3, r4, r5, r6, r7]));
        }
        Ok(())
    }

    /// Takes y and F at the end of the step, projected, and looks at stability.
    fn end(&mut self, system: &dyn System, to: &Node) {
        let (n, s) = (self.flow.n, &to.state);
        self.flow.join([&s.q, &s.v, &s.z], &mut self.y1);
        let (stage, end) = self.k.split_at_mut(LAST * n);
        self.flow.known(system, to, &mut end[..n]);
        self.stiffness.estimate(self.h, [&self.y, &self.y1], [&stage[(LAST - 1) * n..], &end[..n]]);
    }

    /// The error, 1 at the tolerance: h e₅²/√(e₅² + e₃²/100) (equation 10.17 of section II.10).
    fn error(&self, engine: &Engine, from: &Node) -> f64 {
        let norm = |e: &[f64]| {
            let [q, v, z] = self.flow.parts(e);
            engine.norm(&from.state, q, v, z).powi(2)
        };
        combined(self.h, norm(&self.e5), norm(&self.e3))
    }
}

impl Scheme for Dop853 {
    fn restart(&mut self, _: &mut dyn System, engine: &mut Engine, _: &Node, _: f64) -> Result<(), Why> {
        self.rejected = false;
        self.stiffness.forget();
        self.work.forget();
        self.crossing.forget(engine);
        self.past.forget();
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        self.h = h;
        self.projected = self.crossing.near();
        let n = self.flow.n;
        self.flow.begin(system, from, &mut self.y0, &mut self.k[..n]);
        self.work.begin(system, from, self.projected);
        let tried = self.stages(system, engine, from).and_then(|()| {
            self.sum();
            self.flow.state(&from.state, from.state.t + h, &self.y1, &mut to.state);
            if self.projected { self.arrive(system, engine, to) } else { Ok(()) }
        });
        tried.map_err(|why| self.fails(from, why))?;
        if !engine.is_fixed() {
            let error = self.error(engine, from);
            self.factor = (safety(engine.tolerance()) * error.powf(-0.125)).clamp(SHRINK, GROW);
            if error.is_nan() || error > 1.0 {
                return Err(self.errs(system, engine, from, error));
            }
        }
        if !self.projected {
            engine.settle_step(system, to).map_err(|why| self.fails(from, why))?;
            self.crossing.follow(engine, to);
        }
        self.end(system, to);
        Ok(())
    }

    fn completes(&self) -> bool {
        true
    }

    fn accept(&mut self, engine: &mut Engine, _: &Node, to: &Node) -> f64 {
        self.stiffness.count();
        self.work.accept();
        self.past.accept(self.h, [&self.y0, &self.k[..self.flow.n]], self.projected);
        let most = if std::mem::take(&mut self.rejected) { 1.0 } else { GROW };
        if engine.is_fixed() {
            return self.h;
        }
        let next = self.h * self.factor.min(most);
        self.crossing.accept(next);
        self.crossing.plan(to.state.t, next)
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        let n = self.flow.n;
        let end = (&self.y1[..], &self.k[LAST * n..][..n]);
        if let Some((before, nodes)) = self.past.nodes(engine, to, end)
            && out.through_nodes(engine, [&from.state, &to.state], before, nodes) < past::ERROR
        {
            return Ok(());
        }
        out.begin(from.state.t, to.state.t - from.state.t, 8);
        self.more_stages(system, engine, from, out)
    }

    fn work(&self, step: f64, out: &mut [f64]) -> Option<[f64; 2]> {
        self.work.add(step, out)
    }

    fn regular_until(&mut self, t: f64) {
        self.crossing.regular_until(t);
    }

    fn order(&self) -> usize {
        8
    }

    fn name(&self) -> &'static str {
        "dop853"
    }
}

/// Powers of θ of the nested form.
fn powers(y0: f64, [r1, r2, r3, r4, r5, r6, r7]: [f64; 7]) -> [f64; 8] {
    [y0, r1 + r2, r3 + r4 - r2, r5 + r6 - r3 - 2.0 * r4, r4 - 2.0 * r5 - 3.0 * r6 + r7, r5 + 3.0 * r6 - 3.0 * r7, 3.0 * r7 - r6, -r7]
}

/// Part that is taken of the step which the error estimate allows.
///
/// With 0.6 one step in twenty is rejected instead of one in six with 0.8, and errors of the pendulum are 0.1 to 1 times the tolerance
/// instead of 2 to 10 times; the same error of 1e-4 to 1e-8 takes up to 4 per cent fewer evaluations on the crank-rocker, 6 to 15 on
/// Andrews' mechanism and Bricard's, 4 to 40 on one to forty four-bars, and over 2 per cent more at none of these errors [measured, with the
/// 0.8 for tight tolerances]. Where the estimate is round-off that does not fall with the step, steps are up to ten times shorter [measured,
/// two thin bars that come into line within 1e-5 rad]. Tight tolerances ask for 0.8: of 582 runs of rows of four-bars at 1e-9 to 1e-12 10
/// lose more energy with 0.6, up to ten times, than a crank of the same inertia does at that tolerance, since singular positions are looked
/// for where a step is rejected. The 0.9 of `dop853.f` makes two to three times the drift of energy of 0.8 [measured, slider-crank, and
/// pendulum for 1000 s at 1e-11].
fn safety(tolerance: f64) -> f64 {
    let digits = -tolerance.log10();
    (0.6 + 0.1 * (digits - 9.0)).clamp(0.6, 0.8)
}

/// The error from the squares of those of orders 5 and 3; one whose square overflows is infinite, not none.
fn combined(h: f64, five: f64, three: f64) -> f64 {
    let root = (five + 0.01 * three).sqrt();
    if root > 0.0 && root.is_finite() { h * five / root } else { root }
}
