//! Mass matrix, bias forces and inverse dynamics of a model at given states, for comparisons with other programs.
//!
//! `terms MODEL.yaml < states.json`: every line of stdin is `{"q": {joint: x, ...}, "v": {...}, "a": {...}}` in SI units, rad
//! and m; joints that are not named are 0. Every line of stdout is `{"joints", "mass", "bias", "effort"}`: names of the joints
//! in the order of the rows, M by rows, the bias forces b = −f at zero acceleration (Coriolis, centrifugal, gravity and what
//! pulls), and the efforts of M a + b, found from the wrenches of the bodies without M. The model must be a tree of joints
//! with one coordinate each.

use grashof::dynamics::Dynamics;
use grashof::geometry::{Motion, Spatial};
use grashof::mechanism::{Coordinates, Mechanism, Step, build};
use grashof::model::{Document, Selection};
use grashof::studies::common::case::parameters;
use serde_json::{Value, json};
use std::error::Error;
use std::io::{BufRead, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("usage: terms MODEL.yaml < states.json")?;
    let document = Document::read(&std::fs::read_to_string(&file)?, &file)?;
    let model = document.model(&Selection::default())?;
    let mechanism = build::<Spatial<f64>>(&model, &parameters(&model), Coordinates::Joint).map_err(|faults| format!("{faults:?}"))?;
    let names = names(&mechanism)?;
    let mut dynamics = Dynamics::new(&mechanism);
    let modes = mechanism.modes();
    let nv = mechanism.nv;
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        let state: Value = serde_json::from_str(&line?)?;
        let read = |key: &str| -> Vec<f64> { names.iter().map(|name| state[key][name].as_f64().unwrap_or(0.0)).collect() };
        let (q, v, a) = (read("q"), read("v"), read("a"));
        dynamics.terms(0.0, &q, &v, &modes);
        let bias: Vec<f64> = dynamics.work.force.iter().map(|f| -f).collect();
        let mut accelerations = vec![Motion::default(); mechanism.bodies.len()];
        dynamics.accelerate(&a, &mut accelerations);
        let mut effort = vec![0.0; nv];
        dynamics.unbalanced(&a, &accelerations, &mut effort);
        let effort: Vec<f64> = effort.iter().map(|x| -x).collect();
        let whole = dynamics.work.mass.to_dense();
        let mass: Vec<&[f64]> = whole.chunks(nv).collect();
        writeln!(out, "{}", json!({ "joints": names, "mass": mass, "bias": bias, "effort": effort }))?;
    }
    Ok(())
}

/// Joints by the coordinate that they carry.
fn names(mechanism: &Mechanism<Spatial<f64>>) -> Result<Vec<String>, String> {
    let mut names = vec![String::new(); mechanism.nv];
    for joint in &mechanism.joints {
        let (node, reversed) = joint.tree.ok_or_else(|| format!("joint `{}` closes a loop", joint.name))?;
        for step in &mechanism.steps[mechanism.nodes[node].steps.clone()] {
            match step {
                Step::Axis { q, v, .. } if q == v && !reversed => names[*v].clone_from(&joint.name),
                _ => return Err(format!("joint `{}` has not one coordinate of its own", joint.name)),
            }
        }
    }
    names.iter().all(|name| !name.is_empty()).then_some(names).ok_or_else(|| "a body is free".to_owned())
}
