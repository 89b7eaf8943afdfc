//! Sweeps whose values are drawn from distributions: moments against closed forms, and the same runs however they are computed.

use grashof::Model;
use grashof::results::{Results, Statistics};

/// A slider-crank in line with its guide, whose stroke is twice its crank; `{}` stands for its sweep.
const SLIDER_CRANK: &str = "\
grashof: 1
name: slider-crank
space: planar
gravity: none
parameters: { crank: 10 cm, reach: 30 cm }
bodies:
  wheel: { bar: { length: crank } }
  rod: { bar: { length: reach } }
  piston: { mass: 1 kg, inertia: 1e-3 kg m^2 }
joints:
  O: { revolute: [ground, wheel.start] }
  A: { revolute: [wheel.end, rod.start] }
  B: { revolute: [rod.end, piston.origin] }
  S: { slider: [ground, piston], axis: [1, 0] }
drivers: { drive: { joint: O, speed: 1 rad/s } }
start: { O.angle: 10 deg, rod.angle: ~-5 deg, S.position: ~0.4 m }
studies:
  turn:
    kinematics: { over: 1 turn, samples: 24 }
    sweep: {}
    columns: [S.position]
    scalars: { stroke: max(S.position) - min(S.position), far: max(S.position) }
";

fn swept(sweep: &str, threads: usize) -> Results {
    let model = Model::parse(&SLIDER_CRANK.replace("sweep: {}", &format!("sweep: {sweep}"))).unwrap_or_else(|e| panic!("{e}"));
    model.study("turn").unwrap().threads(threads).run().unwrap_or_else(|e| panic!("{e}"))
}

fn of<'r>(results: &'r Results, name: &str) -> &'r Statistics {
    results.statistics.iter().find(|s| s.name == name).unwrap_or_else(|| panic!("no {name}"))
}

fn column<'r>(results: &'r Results, name: &str) -> &'r [f64] {
    &results.table.columns.iter().find(|c| c.name == name).unwrap().values
}

#[test]
fn moments_and_percentiles_are_those_of_the_sum() {
    let found = swept("{ crank: { normal: [10 cm, 1 mm] }, reach: { uniform: [29 cm, 31 cm] }, samples: 512, seed: 3 }", 2);
    assert_eq!(found.runs.len(), 512);
    // twice a normal number
    let stroke = of(&found, "stroke");
    assert!((stroke.mean - 0.2).abs() < 1e-5 && (stroke.deviation - 2e-3).abs() < 2e-5, "{stroke:?}");
    for (x, normal) in stroke.percentiles.into_iter().zip([-1.644853627, -0.67448975, 0.0, 0.67448975, 1.644853627]) {
        assert!((x - 0.2 - 2e-3 * normal).abs() < 5e-5, "{stroke:?}");
    }
    // with another one from between two values: variances add up
    let far = of(&found, "far");
    assert!((far.mean - 0.4).abs() < 2e-5 && (far.deviation - (1e-6 + 4e-4_f64 / 12.0).sqrt()).abs() < 3e-5, "{far:?}");
    assert!(column(&found, "reach").iter().all(|x| (0.29..=0.31).contains(x)));
    // shares of the variance, and slopes
    assert!((stroke.parts[0].slope - 2.0).abs() < 1e-6 && stroke.parts[0].share > 1.0 - 1e-6, "{stroke:?}");
    let share = 1e-6 / (1e-6 + 4e-4 / 12.0);
    assert!((far.parts[0].share - share).abs() < 2e-3 && (far.parts[0].share + far.parts[1].share - 1.0).abs() < 1e-12, "{far:?}");
}

#[test]
fn a_seed_decides_on_the_runs_and_nothing_else_does() {
    let sweep = |seed: u32| format!("{{ crank: {{ normal: [10 cm, 1 mm] }}, samples: 20, seed: {seed} }}");
    let (one, two, other) = (swept(&sweep(1), 1), swept(&sweep(1), 2), swept(&sweep(2), 2));
    assert_eq!(column(&one, "stroke"), column(&two, "stroke"));
    assert_eq!(one.statistics, two.statistics);
    assert!(column(&one, "crank").iter().all(|x| !column(&other, "crank").contains(x)));
    assert_eq!(swept("{ crank: { normal: [10 cm, 1 mm] }, samples: 20 }", 2).statistics, one.statistics);
}

#[test]
fn what_is_drawn_from_outside_is_what_the_file_would_draw() {
    let own = swept("{ crank: { normal: [10 cm, 1 mm] }, reach: { uniform: [0.29, 0.31] }, samples: 12, seed: 5 }", 2);
    let model = Model::parse(&SLIDER_CRANK.replace("    sweep: {}\n", "")).unwrap();
    let study = model.study("turn").unwrap().over("crank", "normal(10 cm, 1 mm)").over("reach", " uniform( 29 cm, 0.31 )").samples(12, 5);
    let outside = study.run().unwrap();
    assert_eq!(own.statistics, outside.statistics);
    assert_eq!(own.table, outside.table);
}

#[test]
fn what_is_drawn_is_the_same_at_each_point_of_the_grid() {
    let found = swept("{ reach: [30 cm, 35 cm], crank: { uniform: [9 cm, 11 cm] }, samples: 16 }", 2);
    let (first, second) = column(&found, "crank").split_at(16);
    assert_eq!(first, second);
    assert!(of(&found, "stroke").parts.is_empty());
    assert!(column(&found, "reach")[..16].iter().all(|x| *x == 0.3) && column(&found, "reach")[16..].iter().all(|x| *x == 0.35));
}
