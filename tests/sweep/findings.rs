//! What runs find goes into what is said of the sweep.

use grashof::Model;

/// A rocker that turns back within the range: what is divided by its rate has no bound there.
const POLES: &str = "
grashof: 1
name: poles
space: planar
gravity: none
parameters: { l3: 55 cm }
ground: { O: [0, 0], C: [1 m, 0] }
bodies:
  crank: { bar: { length: 15 cm } }
  coupler: { bar: { length: 1 m } }
  rocker: { bar: { length: l3 } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 90 deg, coupler.angle: ~25 deg, rocker.angle: ~90 deg }
measures: { advantage: abs(crank.omega)/abs(rocker.omega) }
studies:
  turn:
    kinematics: { over: 1 turn, samples: 48 }
    columns: [O.angle, advantage]
    scalars: { most: max(advantage) }
";

#[test]
fn findings_of_runs_are_told_once() {
    let results = Model::parse(POLES).unwrap().study("turn").unwrap().over("l3", "50 cm, 55 cm, 60 cm").run().unwrap();
    let told: Vec<&str> = results.findings.iter().filter(|f| f.code == "unresolved").map(|f| &*f.message).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("in 3 of 3 runs, the first of them run 1 (l3 = 50 cm): column `advantage` varies too fast"), "{}", told[0]);
}

#[test]
fn an_absolute_value_is_not_below_zero_where_its_switch_is() {
    let in_time =
        POLES.to_owned() + "  motion:\n    dynamics: { until: 1 s, every: 20 ms }\n    columns: [advantage]\n    undefined: [advantage]\n";
    for study in ["turn", "motion"] {
        let results = Model::parse(&in_time).unwrap().study(study).unwrap().run().unwrap();
        let values = results.column("advantage").unwrap();
        assert!(values.iter().all(|x| *x > 0.0), "{study}: {values:?}");
        assert!(values.iter().any(|x| *x > 1e9), "{study}");
    }
}

#[test]
fn a_sweep_that_changes_nothing_is_told() {
    let text = POLES.replace("parameters: { l3: 55 cm }", "parameters: { l3: 55 cm, spare: 1 m }");
    let text = text.replace("most: max(advantage)", "far: max(rocker.angle), near: min(rocker.angle)");
    let model = Model::parse(&text).unwrap();
    let told = |parameter: &str, values: &str| {
        let results = model.study("turn").unwrap().over(parameter, values).run().unwrap();
        results.findings.iter().find(|f| f.code == "sweep-constant").map(|f| f.message.to_string())
    };
    assert_eq!(told("spare", "1 m, 2 m, 3 m").as_deref(), Some("all scalars are the same in all 3 runs: does anything depend on `spare`?"));
    assert_eq!(told("spare", "1 m, 2 m"), None);
    assert_eq!(told("l3", "50 cm, 55 cm, 60 cm"), None);
}

#[test]
fn values_made_of_another_swept_parameter_are_told() {
    let text = POLES.replace("parameters: { l3: 55 cm }", "parameters: { l3: 55 cm, twice: 2*l3, spare: 1 m }");
    let model = Model::parse(&text).unwrap();
    let told = |first: (&str, &str), second: (&str, &str)| {
        let results = model.study("turn").unwrap().over(first.0, first.1).over(second.0, second.1).run().unwrap();
        results.findings.iter().filter(|f| f.code == "sweep-of-file").map(|f| f.message.to_string()).collect::<Vec<_>>()
    };
    // at once, and through a parameter
    for values in ["l3, 2*l3", "1 m, twice"] {
        let found = told(("l3", "50 cm, 55 cm"), ("spare", values));
        assert!(found.len() == 1 && found[0].starts_with("values of `spare` are made of `l3` as the file has it"), "{found:?}");
    }
    // its own value, and one that is not swept
    assert!(told(("l3", "l3, 1.01*l3"), ("spare", "1 m, 2 m")).is_empty());
    assert!(told(("l3", "spare/2, 55 cm"), ("twice", "1 m, 2 m")).is_empty());
}
