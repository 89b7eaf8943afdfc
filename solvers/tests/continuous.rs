//! Continuous solutions of all schemes between the ends of steps.

use crate::problems::*;
use grashof_solvers::{Control, Engine, Integration, Method, Progress, Settings, Stage};

/// What a state at a part of each step is off the constraints, in units of size and of speed: at 0.75, and most of all.
fn off<P: Problem>(system: &mut P, method: Method, tolerance: f64, end: f64) -> Vec<[f64; 2]> {
    let start = system.start();
    let settings = Settings { method, control: Control::Tolerance(tolerance), ..Settings::default() };
    let mut run = Integration::new(system, settings, &start).unwrap();
    let mut engine = Engine::new(system, Control::Tolerance(1e-8));
    let (mut state, mut all) = (start, Vec::new());
    loop {
        let progress = run.advance(system, end).unwrap();
        let (from, to) = (run.last().state.t, run.node().state.t);
        let dense = run.dense(system).unwrap().clone();
        let mut at = |theta: f64| {
            dense.evaluate(from + theta * (to - from), &mut state);
            engine.evaluate(system, state.at(), Stage::Velocity);
            let speed = state.v.iter().zip(&system.pattern().size_v).fold(1.0, |m, (v, s)| f64::max(m, v.abs() / s));
            engine.position_residual().max(engine.velocity_residual(&state.v) / speed)
        };
        let most = (1..20).map(|k| at(f64::from(k) / 20.0)).fold(0.0, f64::max);
        all.push([at(0.75), most]);
        if progress == Progress::End {
            return all;
        }
    }
}

/// A step that is off the constraints by 0.12 of the tolerance at most at three quarters of it is nowhere off them by half of it: what
/// columns between rows are read by.
#[test]
fn what_a_step_is_off_the_constraints_shows_at_three_quarters_of_it() {
    let methods = [
        Method::Dop853,
        Method::Bdf { order: None },
        Method::Radau5,
        Method::GeneralizedAlpha { rho: 0.8 },
        Method::Hht { alpha: -0.1 },
        Method::Auto,
    ];
    for method in methods {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let steps = off(&mut Pendulum::new(), method, tolerance, 6.0);
            let near: Vec<f64> = steps.iter().filter(|[at, _]| *at <= 0.12 * tolerance).map(|[_, most]| most / tolerance).collect();
            let most = near.iter().copied().fold(0.0, f64::max);
            assert!(near.len() > steps.len() / 5 && most < 0.5, "{method:?} {tolerance:e}: {most}, {} of {}", near.len(), steps.len());
        }
    }
}
