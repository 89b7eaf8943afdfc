//! The classical Runge-Kutta method of order four on the equations of index 1, with projection after each step.
//!
//! ẏ = F(t, y) with y = (q, v, z), q̇ = N(q) v and a from the KKT system. A quaternion is a vector here; its length drifts by the
//! local error, which means nothing since poses are homogeneous of degree 0. With a tolerance, two half steps tell the error
//! (Richardson; Hairer, Nørsett & Wanner, Solving ODEs I, section II.4).

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Engine, Node, Rejected, Why};
use crate::scheme::Scheme;

/// The classical Runge-Kutta method.
pub(super) struct Rk4 {
    /// Whether the modes of every stage are taken from its values.
    follow: bool,
    stage: Node,
    /// q̇ of a stage (nq) and sums of the rates of q, v, z.
    rate: Vec<f64>,
    sums: [Vec<f64>; 3],
    middle: Node,
    whole: Node,
    errors: [Vec<f64>; 3],
    factor: f64,
    h: f64,
}

impl Rk4 {
    /// Room for a system; `follow` takes the modes of every stage from its values.
    pub(super) fn new(system: &dyn System, follow: bool) -> Self {
        let dims = system.dims();
        let vectors = || [vec![0.0; dims.q], vec![0.0; dims.v], vec![0.0; dims.z]];
        let node = Node::new(dims);
        Self {
            follow: follow && dims.modes > 0,
            stage: node.clone(),
            rate: vec![0.0; dims.q],
            sums: vectors(),
            middle: node.clone(),
            whole: node,
            errors: vectors(),
            factor: 1.0,
            h: 0.0,
        }
    }
}

/// Scratch of one step: the stage, q̇, and the sums of rates; and whether stages take their own modes.
type Scratch<'a> = (&'a mut Node, &'a mut Vec<f64>, &'a mut [Vec<f64>; 3], bool);

/// One step of size h, projected; `to` is complete.
fn step(
    system: &mut dyn System,
    engine: &mut Engine,
    (stage, rate, sums, follow): Scratch<'_>,
    from: &Node,
    h: f64,
    to: &mut Node,
) -> Result<(), Why> {
    stage.copy_from(from);
    sums.iter_mut().for_each(|s| s.fill(0.0));
    for (place, weight) in [(0.5, 1.0 / 6.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 3.0), (0.0, 1.0 / 6.0)] {
        system.rate(stage.state.t, &stage.state.q, &stage.state.v, rate);
        let add = |sum: &mut [f64], rate: &[f64]| sum.iter_mut().zip(rate).for_each(|(s, r)| *s += weight * r);
        add(&mut sums[0], rate);
        add(&mut sums[1], &stage.a);
        add(&mut sums[2], &stage.zdot);
        if place > 0.0 {
            let move_by = |x: &mut [f64], x0: &[f64], rate: &[f64]| {
                for ((x, x0), r) in x.iter_mut().zip(x0).zip(rate) {
                    *x = x0 + place * h * r;
                }
            };
            let s = &mut stage.state;
            move_by(&mut s.q, &from.state.q, rate);
            move_by(&mut s.v, &from.state.v, &stage.a);
            move_by(&mut s.z, &from.state.z, &stage.zdot);
            s.t = from.state.t + place * h;
            if follow {
                engine.follow_modes(system, s);
            }
            engine.accelerate(system, stage)?;
        }
    }
    to.state.copy_from(&from.state);
    to.state.t = from.state.t + h;
    let s = &mut to.state;
    for (x, sum) in [&mut s.q, &mut s.v, &mut s.z].into_iter().zip(&*sums) {
        x.iter_mut().zip(sum).for_each(|(x, s)| *x += h * s);
    }
    engine.settle_step(system, to)
}

impl Scheme for Rk4 {
    fn restart(&mut self, _: &mut dyn System, _: &mut Engine, _: &Node, _: f64) -> Result<(), Why> {
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        let Self { follow, stage, rate, sums, middle, whole, errors, factor, .. } = self;
        let fails = |why| Rejected { why, retry: 0.25 * h };
        self.h = h;
        if engine.is_fixed() {
            return step(system, engine, (stage, rate, sums, *follow), from, h, to).map_err(fails);
        }
        step(system, engine, (stage, rate, sums, *follow), from, h, whole).map_err(fails)?;
        step(system, engine, (stage, rate, sums, *follow), from, 0.5 * h, middle).map_err(fails)?;
        step(system, engine, (stage, rate, sums, *follow), middle, 0.5 * h, to).map_err(fails)?;
        let (x, y) = (&to.state, &whole.state);
        for (e, (x, y)) in errors.iter_mut().zip([(&x.q, &y.q), (&x.v, &y.v), (&x.z, &y.z)]) {
            e.iter_mut().zip(x.iter().zip(y)).for_each(|(e, (x, y))| *e = (x - y) / 15.0);
        }
        let error = engine.norm(&from.state, &errors[0], &errors[1], &errors[2]);
        *factor = (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0);
        if error <= 1.0 { Ok(()) } else { Err(Rejected { why: Why::Error(error), retry: h * factor.min(0.9) }) }
    }

    fn completes(&self) -> bool {
        true
    }

    fn accept(&mut self, engine: &mut Engine, _: &Node, _: &Node) -> f64 {
        if engine.is_fixed() { self.h } else { self.h * self.factor }
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        out.hermite(system, engine, from, to)
    }

    fn order(&self) -> usize {
        4
    }

    fn name(&self) -> &'static str {
        "rk4"
    }
}
