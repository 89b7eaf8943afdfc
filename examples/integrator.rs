//! An integrator of one's own, the explicit midpoint rule, beside those of the library on a double pendulum.
//!
//! `cargo run --release --example integrator`

#![allow(clippy::print_stdout, reason = "it is a program of its own")]

use grashof::Model;
use grashof::solvers::{Control, Dense, Engine, Method, Node, Rejected, Scheme, Settings, System, Why};

const PENDULUM: &str = "
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, rod.start] }, Q: { revolute: [rod.end, lower.start] } }
start: { P.angle: -30 deg, Q.angle: 20 deg, P.omega: 0, Q.omega: 0 }
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
    let mechanism = Model::parse(PENDULUM)?.mechanism()?;
    let precise = Settings { method: Method::Dop853, control: Control::Tolerance(1e-12), ..Settings::default() };
    let right = mechanism.simulate(precise)?.advance(1.0)?.q.clone();
    let off = |q: &[f64]| q.iter().zip(&right).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()));
    let mut before = f64::NAN;
    println!("step [s]  error of rk4  error of midpoint, and its order");
    for h in [0.02, 0.01, 0.005, 0.0025] {
        let fixed = Settings { method: Method::Rk4, control: Control::Steps([h, h]), ..Settings::default() };
        let rk4 = off(&mechanism.simulate(fixed)?.advance(1.0)?.q);
        let own = Box::new(Midpoint::new(&*mechanism.system()));
        let midpoint = off(&mechanism.simulate_by(own, fixed)?.advance(1.0)?.q);
        println!("{h:<8}  {rk4:<12.2e}  {midpoint:.2e}  {:.2}", (before / midpoint).log2());
        before = midpoint;
    }
    Ok(())
}
