//! `auto`: explicit steps as long as accuracy bounds them, implicit steps where stability would.

use crate::problems::*;
use allocation_counter::measure;
use grashof_solvers::{Control, Counts, Integration, Method, Node, Progress, Settings};

/// Runs to `end`; the last node, what was spent, and the steps of the implicit scheme.
fn run<P: Problem>(system: &mut P, method: Method, control: Control, end: f64) -> (Node, Counts, usize) {
    let start = system.start();
    let settings = Settings { method, control, ..Settings::default() };
    let mut run = Integration::new(system, settings, &start).unwrap();
    let mut implicit = 0;
    loop {
        let progress = run.advance(system, end).unwrap_or_else(|halt| panic!("{halt:?} after {:?}", run.engine.counts));
        implicit += usize::from(run.scheme_name() == "radau5");
        if progress == Progress::End {
            return (run.node().clone(), run.engine.counts, implicit);
        }
    }
}

/// Largest difference of numbers in pairs.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

fn work(c: &Counts) -> usize {
    c.evaluations + c.factorisations
}

#[test]
fn stiff_springs_are_taken_by_implicit_steps() {
    for (stiffness, damping) in [(1e6, 2e3), (1e8, 2e4), (1e6, 2e1)] {
        for tolerance in [1e-5, 1e-8] {
            let mut system = StiffPair::new(stiffness, damping);
            let control = Control::Tolerance(tolerance);
            let (node, auto, implicit) = run(&mut system, Method::Auto, control, 10.0);
            let (_, explicit, _) = run(&mut system, Method::Dop853, control, 10.0);
            let s = &node.state;
            let error = distance(&[s.q[0], s.q[1], s.v[0], s.v[1]], &system.exact(10.0));
            let case = format!("{stiffness:e} {damping:e} {tolerance:e}: {error:e}, {implicit} implicit of {auto:?}, {explicit:?}");
            assert!(error < 10.0 * tolerance && implicit > 20, "{case}");
            // the lightly damped one swings for a while, where explicit steps are right
            assert!(2 * auto.steps < explicit.steps && 2 * work(&auto) < work(&explicit), "{case}");
            if damping > 1e3 {
                assert!(20 * auto.steps < explicit.steps, "{case}");
            }
        }
    }
}

#[test]
fn smooth_motions_stay_explicit() {
    for tolerance in [1e-5, 1e-8, 1e-11] {
        let control = Control::Tolerance(tolerance);
        let (node, auto, implicit) = run(&mut Andrews::new(), Method::Auto, control, 0.03);
        let (same, explicit, _) = run(&mut Andrews::new(), Method::Dop853, control, 0.03);
        assert!(implicit == 0 && auto == explicit && node == same, "{tolerance:e}: {implicit} {auto:?}");
        assert_eq!(run(&mut Chain::horizontal(10, 0.1), Method::Auto, control, 2.0).2, 0);
        assert_eq!(run(&mut CarAxis::new(), Method::Auto, control, 3.0).2, 0);
    }
}

#[test]
fn given_steps_choose_by_the_spectrum() {
    let mut system = StiffPair::new(1e6, 2e3);
    for (h, implicit) in [(0.05, 20), (1e-4, 0)] {
        let (node, counts, found) = run(&mut system, Method::Auto, Control::Steps([h, h]), 1.0);
        let s = &node.state;
        assert_eq!(found, implicit, "{counts:?}");
        assert!(distance(&[s.q[0], s.q[1], s.v[0], s.v[1]], &system.exact(1.0)) < 1e-9);
    }
}

#[test]
fn changes_of_the_scheme_allocate_nothing() {
    let mut system = StiffPair::new(1e6, 2e3);
    let start = system.start();
    let settings = Settings { method: Method::Auto, control: Control::Tolerance(1e-6), ..Settings::default() };
    let mut run = Integration::new(&mut system, settings, &start).unwrap();
    let mut implicit = 0;
    let info = measure(|| {
        while run.advance(&mut system, 10.0).unwrap() != Progress::End {
            implicit += usize::from(run.scheme_name() == "radau5");
        }
    });
    assert!(implicit > 10 && info.count_total == 0, "{implicit} {info:?}");
}
