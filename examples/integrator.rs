//! An integrator of one's own, the explicit midpoint rule, compared with those of the library on a double pendulum.
//!
//! `cargo run --release --example integrator`

#![allow(clippy::print_stdout, reason = "it is a program of its own")]

use grashof::Model;
use grashof::solvers::{Dense, Engine, Node, Rejected, Scheme, System, Why};
use std::time::Instant;

const PENDULUM: &str = "
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, rod.start] }, Q: { revolute: [rod.end, lower.start] } }
start: { P.angle: -30 deg, Q.angle: 20 deg, P.omega: 0, Q.omega: 0 }
studies: { swing: { dynamics: { until: 1 s }, columns: [P.angle, Q.angle, P.fx, P.fy] } }
";

/// The explicit midpoint rule: y₊ = y + h F(t + ½h, y + ½h F(t, y)) with y = (q, v, z), order 2, projected on the constraints.
struct Midpoint {
    middle: Node,
    qdot: Vec<f64>,
}

impl Midpoint {
    fn new(system: &dyn System) -> Self {
        Self { middle: Node::new(system.dims()), qdot: vec![0.0; system.dims().q] }
    }
}

/// y + h F, with F from the node `rates`.
fn moved(system: &mut dyn System, from: &Node, rates: &Node, h: f64, qdot: &mut [f64], to: &mut Node) {
    to.state.copy_from(&from.state);
    to.state.t = from.state.t + h;
    system.rate(rates.state.t, &rates.state.q, &rates.state.v, qdot);
    let add = |x: &mut [f64], rate: &[f64]| x.iter_mut().zip(rate).for_each(|(x, r)| *x += h * r);
    add(&mut to.state.q, qdot);
    add(&mut to.state.v, &rates.a);
    add(&mut to.state.z, &rates.zdot);
}

impl Scheme for Midpoint {
    fn restart(&mut self, _: &mut dyn System, _: &mut Engine, _: &Node, _: f64) -> Result<(), Why> {
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        let rejected = |why| Rejected { why, retry: 0.5 * h };
        let Self { middle, qdot } = self;
        moved(system, from, from, 0.5 * h, qdot, middle);
        engine.accelerate(system, middle).map_err(rejected)?;
        moved(system, from, middle, h, qdot, to);
        engine.settle_step(system, to).map_err(rejected)
    }

    fn completes(&self) -> bool {
        true
    }

    fn accept(&mut self, _: &mut Engine, from: &Node, to: &Node) -> f64 {
        to.state.t - from.state.t
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        out.hermite(system, engine, from, to)
    }

    fn order(&self) -> usize {
        2
    }

    fn name(&self) -> &'static str {
        "midpoint"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::parse(PENDULUM)?;
    let begin = Instant::now();
    let swing = model.study("swing")?.integrator("midpoint", |system| Box::new(Midpoint::new(system)));
    let compared = swing.compare_steps(&["midpoint", "rk4", "newmark"], &[0.02, 0.01, 0.005, 0.0025], &|| begin.elapsed().as_secs_f64())?;
    print!("{}", grashof::output::comparison::table(&compared));
    Ok(())
}
