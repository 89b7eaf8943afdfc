//! Inverse dynamics of a robot arm: torques that move its joints along given accelerations.
//!
//! `cargo run --release --example inverse`, in the directory of the project.

#![allow(clippy::print_stdout, reason = "it is a program of its own")]

use grashof::Model;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arm = Model::load("models/arm.yaml")?.mechanism()?;
    let names = arm.coordinates();
    let (q, _) = arm.start();
    let (_, nv, rows) = arm.sizes();
    // at rest: what holds the arm against its weight
    let still = vec![0.0; nv];
    let holding = arm.inverse(0.0, &q, &still, &still, &vec![0.0; rows])?;
    // and what begins to turn its first joint at 1 rad/s²
    let mut a = still.clone();
    a[0] = 1.0;
    let turning = arm.inverse(0.0, &q, &still, &a, &vec![0.0; rows])?;
    for (k, name) in names.iter().enumerate() {
        println!("{name:<16} {:>10.4} N m to hold, {:>10.4} N m to begin to turn", holding[k], turning[k]);
    }
    Ok(())
}
