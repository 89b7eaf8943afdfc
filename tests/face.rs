//! The face of the library: models with settings, evaluators, motions that are stepped from outside.

use grashof::api::{Evaluator, Placement};
use grashof::results::Column;
use grashof::{Error, Model};
use std::path::Path;

fn model(file: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(file);
    Model::load(path).unwrap_or_else(|e| panic!("{e}"))
}

const PENDULUM: &str = "
grashof: 1
name: pendulum
space: planar
gravity: none
parameters: { length: 1 m, push: 0 N m }
bodies: { rod: { bar: { length: length, mass: 2 kg } } }
joints: { P: { revolute: [ground, rod.start] } }
loads: { torque: { joint: P, torque: push } }
start: { P.angle: -30 deg, P.omega: 0 }
variants: { long: { parameters: { length: 2 m } } }
studies:
  swing: { dynamics: { until: 2 s, every: 0.1 s }, columns: [time, P.angle, P.omega] }
";

fn pendulum() -> Model {
    Model::parse(PENDULUM).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn settings_of_a_model_are_those_of_its_studies() {
    let model = pendulum();
    let set = model.variant("long").unwrap().set(&[("push", "3")]).unwrap();
    let values = |model: &Model| model.parameters().unwrap().into_iter().map(|p| p.value).collect::<Vec<_>>();
    assert_eq!((values(&model), values(&set)), (vec![1.0, 0.0], vec![2.0, 3.0]));
    let own = set.study("swing").unwrap().run().unwrap();
    let asked = model.study("swing").unwrap().variant("long").set("push", "3").run().unwrap();
    assert_eq!(own.table, asked.table);
    // the later value counts
    assert_eq!(values(&set.set(&[("push", "4 N m")]).unwrap()), [2.0, 4.0]);
    assert!(set.mechanism().unwrap().terms(0.0, &[0.0], &[0.0]).unwrap().mass[(0, 0)] > 2.0);
}

#[test]
fn names_that_there_are_not_are_told_from_faults_of_the_file() {
    let model = pendulum();
    let unknown = [model.set(&[("nobody", "1")]), model.variant("nobody")].map(Result::unwrap_err);
    assert!(unknown.iter().all(Error::is_unknown_name), "{unknown:?}");
    assert!(model.study("nobody").err().is_some_and(|e| e.is_unknown_name() && e.help().contains("`swing`")));
    let wrong = model.set(&[("length", "1 kg")]).unwrap_err();
    assert!(!wrong.is_unknown_name(), "{wrong}");
    let misspelt = Model::parse(&PENDULUM.replace("revolute", "revolut")).unwrap().mechanism().unwrap_err();
    assert_eq!((misspelt.is_unknown_name(), misspelt.place()), (false, "joints.P.revolut"));
}

#[test]
fn a_study_is_added() {
    let (model, name) = pendulum().with_study("swing", "{ dynamics: { until: 1 s }, columns: [P.angle] }");
    assert_eq!(name, "swing-2");
    let results = model.study(&name).unwrap().run().unwrap();
    assert_eq!(results.independent.values.last(), Some(&1.0));
    let page = String::from_utf8(model.report(&[&results])).unwrap();
    assert!(page.contains("<title>pendulum</title>"));
}

#[test]
fn an_evaluator_forgets_what_it_has_evaluated() {
    for file in ["crank_rocker.yaml", "stewart_platform.yaml", "heavy_top.yaml", "quarter_car.yaml"] {
        let mechanism = model(file).mechanism().unwrap();
        let (q, v) = mechanism.start();
        let states: Vec<(f64, Vec<f64>, Vec<f64>)> = (0..5)
            .map(|k| {
                let moved = |x: &Vec<f64>, by: f64| x.iter().enumerate().map(|(i, x)| x + by * ((3 * i + k) as f64).sin()).collect();
                (0.1 * k as f64, moved(&q, 1e-3), moved(&v, 0.1))
            })
            .collect();
        let all = |evaluator: &mut Evaluator<'_>, (t, q, v): &(f64, Vec<f64>, Vec<f64>)| {
            let (a, lambda) = evaluator.accelerations(*t, q, v).map(|(a, lambda)| (a.to_vec(), lambda.to_vec())).unwrap();
            let r = evaluator.inverse(*t, q, v, &a, &lambda).unwrap().to_vec();
            let terms = evaluator.position(*t, q).unwrap();
            (a, lambda, r, terms.mass.to_dense(), terms.phi.clone(), terms.g.to_dense())
        };
        let mut evaluator = mechanism.evaluator();
        for state in states.iter().rev() {
            assert_eq!(all(&mut evaluator, state), all(&mut mechanism.evaluator(), state), "{file}");
        }
    }
}

#[test]
fn a_projection_is_on_the_constraints() {
    for file in ["crank_rocker.yaml", "stewart_platform.yaml", "heavy_top.yaml"] {
        let mechanism = model(file).mechanism().unwrap();
        let (q, v) = mechanism.start();
        let moved = |x: &[f64], by: f64| -> Vec<f64> { x.iter().enumerate().map(|(i, x)| x + by * (3.0 * i as f64).sin()).collect() };
        let (q, v) = mechanism.project(0.0, &moved(&q, 1e-3), &moved(&v, 0.1)).unwrap();
        let terms = mechanism.terms(0.0, q.as_slice(), v.as_slice()).unwrap();
        assert!(terms.phi.amax() < 1e-13, "{file}: {}", terms.phi);
        let off = (&terms.g * &v - &terms.nu).amax();
        assert!(off < 1e-12 * (1.0 + v.amax()), "{file}: {off:e}");
    }
    let mechanism = model("crank_rocker.yaml").mechanism().unwrap();
    let (q, v) = mechanism.start();
    assert!(mechanism.project(0.0, &vec![f64::NAN; q.len()], &v).is_err());
}

#[test]
fn placements_are_those_of_each_position() {
    let mechanism = model("stewart_platform.yaml").mechanism().unwrap();
    let (q, _) = mechanism.start();
    let mut many = q.clone();
    many.extend(q.iter().map(|x| 1.01 * x));
    let mut placed: Vec<Placement> = Vec::new();
    mechanism.placements("plate", &many, |at| placed.push(at)).unwrap();
    let each: Vec<_> = many.chunks(q.len()).map(|q| mechanism.placement("plate", q).unwrap()).collect();
    assert_eq!(placed, each);
    assert!(mechanism.placements("plate", &many[1..], |_| {}).is_err());
    assert!(mechanism.placement("nobody", &q).is_err());
}

#[test]
fn a_motion_is_stepped_with_an_input() {
    let model = pendulum();
    let rest = model.stepping("swing").unwrap();
    let mut motion = rest.begin().unwrap();
    motion.advance(0.5, &|| false).unwrap();
    assert_eq!((motion.state().t, motion.columns()[2]), (0.5, 0.0));
    // a torque of 4 N m on 2/3 kg m^2 for half a second
    let pushed = rest.set("push", 4.0).unwrap();
    let mut motion = pushed.begin_at(&motion.reached()).unwrap();
    motion.advance(1.0, &|| false).unwrap();
    assert!((motion.columns()[2] - 3.0).abs() < 1e-7, "{}", motion.columns()[2]);
    assert_eq!(rest.columns(), ["time", "P.angle", "P.omega"]);
    assert!(rest.set("nobody", 1.0).is_err_and(|e| e.is_unknown_name()));
}

#[test]
fn a_stepped_motion_is_that_of_the_study() {
    let model = model("crank_rocker.yaml");
    for (study, tolerance) in [("start-up", 1e-4), ("start-up-exact", 1e-7)] {
        let results = model.study(study).unwrap().run().unwrap();
        let (time, omega) = (results.column("time").unwrap(), results.column("omega").unwrap());
        let stepping = model.stepping(study).unwrap();
        let mut motion = stepping.begin().unwrap();
        for step in 1..=10 {
            motion.advance(0.02 * f64::from(step), &|| false).unwrap();
        }
        let row = (0..time.len()).min_by(|&i, &k| (time[i] - 0.2).abs().total_cmp(&(time[k] - 0.2).abs())).unwrap();
        let off = (motion.columns()[2] / omega[row] - 1.0).abs();
        assert!(off < tolerance, "{study}: {off:e}");
    }
}

#[test]
fn what_cannot_be_stepped_is_refused() {
    let crank = model("crank_rocker.yaml");
    assert!(matches!(crank.stepping("one-turn"), Err(Error::Refused { .. })));
    assert!(crank.stepping("nobody").is_err_and(|e| e.is_unknown_name()));
}

/// A ball that comes to rest on the floor and is thrown up by an event, which turns gravity's part around for a while.
const THROWN: &str = "
grashof: 1
name: thrown
space: planar
gravity: none
parameters: { pull: -10 N }
bodies: { ball: { mass: 1 kg } }
joints: { S: { slider: [ground, ball.origin], axis: [0, 1], limits: { from: 0 m, restitution: 0.5 } } }
loads: { weight: { joint: S, force: pull } }
start: { S.position: 0.21 m }
events:
  throw: { when: time - 1 s, crossing: rising, set: { pull: 12 N } }
  top: { when: S.position - 0.3 m, crossing: rising, set: { pull: -10 N } }
studies: { motion: { dynamics: { until: 3 s, every: 0.1 s }, columns: [S.position, S.velocity, S.stop, time] } }
";

/// A block that a spring drags over a rough floor: it sticks and slides.
const DRAGGED: &str = "
grashof: 1
name: dragged
space: planar
gravity: none
bodies: { block: { mass: 1 kg } }
joints: { S: { slider: [ground, block.origin], axis: [1, 0], friction: { coulomb: 2 N, static: 3 N, stribeck_speed: 0.1 m/s } } }
loads: { spring: { joint: S, force: (40 N/m)*((0.1 m/s)*t - S.position) } }
start: { S.position: 0 m }
studies: { motion: { dynamics: { until: 3 s, every: 0.1 s, tolerance: 1e-10 }, columns: [S.position, S.velocity, time] } }
";

#[test]
fn events_stops_and_friction_are_stepped_as_in_the_study() {
    for text in [THROWN, DRAGGED] {
        let model = Model::parse(text).unwrap();
        let results = model.study("motion").unwrap().run().unwrap();
        let stepping = model.stepping("motion").unwrap();
        let mut motion = stepping.begin().unwrap();
        let time = results.column("time").unwrap();
        for step in 1..=30 {
            let t = 0.1 * f64::from(step);
            motion.advance(t, &|| false).unwrap();
            let row = time.iter().rposition(|x| (x - t).abs() < 1e-9).unwrap();
            for (name, value) in stepping.columns().iter().zip(motion.columns()) {
                let expected = results.column(name).unwrap()[row];
                assert!((value - expected).abs() < 1e-7, "{name} at {t} s: {value} {expected}");
            }
        }
        let happened: Vec<_> = motion.events().iter().map(|event| &event.name).collect();
        assert_eq!(happened, results.events.iter().map(|event| &event.name).collect::<Vec<_>>());
    }
}

#[test]
fn an_input_counts_from_when_it_is_set_and_events_behind_it() {
    let model = Model::parse(THROWN).unwrap();
    let rest = model.stepping("motion").unwrap();
    let mut motion = rest.begin().unwrap();
    motion.advance(0.9, &|| false).unwrap();
    let rests = |columns: &[f64]| columns[0].abs() < 1e-15 && columns[1] == 0.0;
    assert!(rests(&motion.columns()), "{:?}", motion.columns());
    // what presses does not lift what rests, nor does the event afterwards find it moved
    let pressed = rest.set("pull", -20.0).unwrap();
    let mut motion = pressed.begin_at(&motion.reached()).unwrap();
    assert!(rests(&motion.columns()) && motion.columns()[2] == 20.0, "{:?}", motion.columns());
    motion.advance(1.1, &|| false).unwrap();
    // 12 m/s² for a tenth of a second
    assert!((motion.columns()[0] - 0.06).abs() < 1e-9, "{:?}", motion.columns());
    assert_eq!(motion.events().len(), 1);
    // 5 m/s² from there, 1.2 m/s fast
    let slower = pressed.set("pull", 5.0).unwrap();
    let mut motion = slower.begin_at(&motion.reached()).unwrap();
    motion.advance(1.2, &|| false).unwrap();
    assert!((motion.columns()[0] - (0.06 + 0.12 + 0.025)).abs() < 1e-9, "{:?}", motion.columns());
}

#[test]
fn an_event_that_stops_ends_a_stepped_motion() {
    let model = Model::parse(&format!("{PENDULUM}events: {{ low: {{ when: P.angle + 90 deg, action: stop }} }}\n")).unwrap();
    let stepping = model.stepping("swing").unwrap().set("push", -4.0).unwrap();
    let mut motion = stepping.begin().unwrap();
    while !motion.ended() {
        motion.advance(motion.state().t + 0.05, &|| false).unwrap();
    }
    assert!((motion.columns()[1] + std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    assert!(motion.advance(10.0, &|| false).is_err_and(|e| e.to_string().contains("by the event `low`")));
}

#[test]
fn a_sweep_is_computed_in_parts() {
    let model = pendulum();
    let study = || model.study("swing").unwrap().over("length", "1,-1,2,3").over("push", "normal(0, 1)").samples(5, 3);
    let whole = study().run().unwrap();
    let sweep = study().prepare().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((sweep.count(), sweep.parameters()), (20, vec!["length", "push"]));
    for range in [0..20, 0..1, 3..11, 19..20, 7..7] {
        let part = sweep.only(range.clone(), 2, &|| false).unwrap();
        let rows = |column: &Column| column.values[range.clone()].iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(part.runs.len(), range.len());
        for (own, all) in part.table.columns.iter().zip(&whole.table.columns) {
            assert_eq!(own.name, all.name);
            assert_eq!(own.values.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), rows(all));
        }
        assert_eq!(part.table.reasons.as_deref(), whole.table.reasons.as_ref().map(|all| &all[range]));
    }
    let failed = sweep.only(6..7, 1, &|| false).unwrap().findings;
    assert!(failed[0].message.starts_with("run 7 (length = -1 m"), "{failed:?}");
    assert_eq!(sweep.statistics(&whole.table), whole.statistics);
    assert!([20..21, 5..22].into_iter().all(|range| sweep.only(range, 1, &|| false).is_err()));
    assert!(model.study("swing").unwrap().prepare().is_err());
}

#[test]
fn chances_are_mapped_by_the_distributions_of_a_sweep() {
    let model = pendulum();
    let drawn = model.study("swing").unwrap().over("length", "uniform(1 m, 3 m)").over("push", "normal(2, 1)").samples(1, 1);
    let sweep = drawn.prepare().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(sweep.at_chances(&[0.25, 0.5]).unwrap(), [1.5, 2.0]);
    // Φ(1.96) = 0.9750021048517795
    assert!((sweep.at_chances(&[0.5, 0.975_002_104_851_779_5]).unwrap()[1] - 3.96).abs() < 1e-9);
    assert!([&[0.5][..], &[0.0, 0.5], &[0.5, f64::NAN]].into_iter().all(|wrong| sweep.at_chances(wrong).is_err()));
    assert!(model.study("swing").unwrap().over("length", "1,2").prepare().unwrap().at_chances(&[0.5]).is_err());
}

#[test]
fn a_packed_model_is_the_same_elsewhere() {
    let (model, study) = model("arm.yaml").with_study("short", "{ dynamics: { until: 0.1 s }, columns: [energy] }");
    let again = Model::unpack(&model.pack()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((again.pack(), again.studies()), (model.pack(), model.studies()));
    assert_eq!(again.study(&study).unwrap().run().unwrap().table, model.study(&study).unwrap().run().unwrap().table);
    let set = pendulum().variant("long").unwrap().set(&[("push", "3 N m")]).unwrap();
    let values = |model: &Model| model.parameters().unwrap().into_iter().map(|p| p.value).collect::<Vec<_>>();
    assert_eq!(values(&Model::unpack(&set.pack()).unwrap()), values(&set));
    assert!(Model::unpack("{}").is_err());
}
