//! A study of a model file for a longer coupler, its largest force, and a figure of two columns.
//!
//! `cargo run --release --example plot`, in the directory of the project.

#![allow(clippy::print_stdout, reason = "it is a program of its own")]

use grashof::Model;
use grashof::output::{figures, render_figure};
use grashof::results::Plot;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::load("models/crank_rocker.yaml")?;
    let mut results = model.study("one-turn")?.set("l2", "105 cm").run()?;
    let torque = results.column("drive.torque")?;
    let largest = torque.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    println!("{} rows, largest torque {largest:.1} N m, mean power {:.1} W", torque.len(), results.scalar("mean_power")?);
    let show = vec!["drive.torque".into()];
    results.plots = vec![Plot { name: "torque".into(), show, unit: Some(("deg".into(), 1f64.to_radians())), ..Plot::default() }];
    for (name, figure) in figures(&results) {
        std::fs::write(std::env::temp_dir().join(format!("{name}.svg")), render_figure(&figure)?.svg)?;
    }
    Ok(())
}
