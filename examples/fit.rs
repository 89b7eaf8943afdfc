//! A damping is fitted to measured amplitudes of a pendulum, by golden section.
//!
//! `cargo run --release --example fit`

#![allow(clippy::print_stdout, reason = "it is a program of its own")]

use grashof::Model;

const PENDULUM: &str = "
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { damping: 0.01 N m s/rad }
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, rod.start], damping: damping } }
start: { P.angle: -60 deg, P.omega: 0 }
studies: { swing: { dynamics: { until: 5 s, every: 0.5 s }, columns: [time, P.angle] } }
";

/// Angles that were measured every half second, rad; made with 0.05 N m s/rad and rounded to a thousandth.
const MEASURED: [f64; 11] = [-1.047, -1.718, -1.969, -1.195, -1.430, -2.004, -1.435, -1.253, -1.894, -1.665, -1.213];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::parse(PENDULUM)?;
    let distance = |damping: f64| -> Result<f64, grashof::Error> {
        let results = model.study("swing")?.set("damping", &damping.to_string()).run()?;
        Ok(results.column("P.angle")?.iter().zip(MEASURED).map(|(x, y)| (x - y).powi(2)).sum())
    };
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.0, 0.2);
    while high - low > 1e-6 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if distance(a)? < distance(b)? { high = b } else { low = a }
    }
    println!("damping {:.4} N m s/rad, off by {:.1e} rad", low, (distance(low)? / MEASURED.len() as f64).sqrt());
    Ok(())
}
