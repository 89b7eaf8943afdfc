//! What other programs add to the library: force laws and integrators of their own.

use crate::common::model;
use allocation_counter::measure;
use grashof::api::{PointMotion, Wrench};
use grashof::output::{CsvRows, summary, write_csv};
use grashof::results::{Column, Results, Sink};
use grashof::solvers::{Control, Level, Method, Settings, Span, Stage, State, Tangent, Terms, schemes};
use grashof::studies::common::case::{Case, Streamed, parameters};
use grashof::studies::common::named::named;
use grashof::studies::run::run;
use grashof::{Mechanism, Model};
use nalgebra::Vector3;
use std::path::Path;
use std::sync::Mutex;

/// The tip of the second bar held by a spring with a damper.
const SPRING: &str = "springs: { s: { between: [ground.post, lower.end], stiffness: 30 N/m, length: 0.5 m, damping: 2 N s/m } }";

/// Two bars that hang on each other, with more sections.
fn bars(space: &str, more: &str) -> Mechanism {
    let (gravity, post, axis) = match space {
        "planar" => ("[0, -9.81 m/s^2]", "[1.2 m, 0.4 m]", ""),
        _ => ("[0, -9.81 m/s^2, 0]", "[1.2 m, 0.4 m, 0.3 m]", ", axis: [0, 0, 1]"),
    };
    let second = if space == "planar" { "{ revolute: [upper.end, lower.start] }" } else { "{ spherical: [upper.end, lower.start] }" };
    let start = if space == "planar" { "Q.angle: 20 deg, Q.omega: 0" } else { "lower.rotation: { axis: [1, 1, 0], angle: 20 deg }" };
    let text = format!(
        "
grashof: 1
name: bars
space: {space}
gravity: {gravity}
ground: {{ post: {post} }}
bodies: {{ upper: {{ bar: {{ length: 1 m, mass: 1 kg, width: 5 cm, height: 5 cm }} }}, lower: {{ bar: {{ length: 1 m, mass: 2 kg, width: 5 cm, height: 5 cm }} }} }}
joints: {{ P: {{ revolute: [ground, upper.start]{axis} }}, Q: {second} }}
start: {{ P.angle: -30 deg, P.omega: 0, {start} }}
{more}
"
    );
    let text = if space == "planar" { text.replace(", width: 5 cm, height: 5 cm", "") } else { text };
    Model::parse(&text).unwrap_or_else(|e| panic!("{e}")).mechanism().unwrap_or_else(|e| panic!("{e}"))
}

/// The same spring as a law.
fn spring(_: f64, points: &[PointMotion], out: &mut [Wrench]) {
    let (d, v) = (points[1].position - points[0].position, points[1].velocity - points[0].velocity);
    let along = d.normalize();
    let pull = 30.0 * (d.norm() - 0.5) + 2.0 * along.dot(&v);
    (out[0].force, out[1].force) = (pull * along, -pull * along);
}

#[test]
fn a_force_law_from_outside_is_that_of_the_file() {
    for space in ["planar", "spatial"] {
        let file = bars(space, SPRING);
        let own = bars(space, "").with_force(&["ground.post", "lower.end"], spring).unwrap();
        let (q, v) = file.start();
        let v: Vec<f64> = v.iter().enumerate().map(|(i, _)| 0.3 + 0.2 * i as f64).collect();
        let [a, b] = [&file, &own].map(|m| m.accelerations(0.0, &q, &v).unwrap().0);
        assert!((&a - &b).norm() < 1e-12 * a.norm(), "{space}: {a} {b}");
        for (method, tolerance) in [(Method::Dop853, 1e-10), (Method::Radau5, 1e-10), (Method::GeneralizedAlpha { rho: 0.8 }, 1e-6)] {
            let settings = Settings { method, control: Control::Tolerance(tolerance), balance: true, ..Settings::default() };
            let mut runs = [&file, &own].map(|m| m.simulate(settings).unwrap());
            let [x, y] = runs.each_mut().map(|run| run.advance(1.0).unwrap().clone());
            let off = x.q.iter().zip(&y.q).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
            assert!(off < 30.0 * tolerance, "{space} {method:?}: {off:e}");
            // the derivatives by differences serve as well as the exact ones
            let [exact, differences] = runs.map(|run| run.counts().steps);
            assert!(differences <= exact + exact / 10 + 2, "{space} {method:?}: {differences} steps for {exact}");
        }
    }
}

#[test]
fn its_power_is_the_change_of_energy() {
    // a constant couple and a force that turns with the body: the energy is that of their work alone
    let mechanism = bars("spatial", "")
        .with_force(&["lower.end"], |_, points, out| {
            out[0].moment = Vector3::new(0.1, 0.2, -0.3);
            out[0].force = points[0].rotation * Vector3::new(0.0, 1.0, 2.0) - 0.5 * points[0].spin;
        })
        .unwrap();
    let energy = |t: f64, q: &[f64], v: &[f64]| {
        let terms = mechanism.terms(t, q, v).unwrap();
        let v = nalgebra::DVector::from_column_slice(v);
        let height = |body: &str| {
            let p = mechanism.placement(body, q).unwrap();
            (p.position + p.rotation * Vector3::new(0.5, 0.0, 0.0)).y
        };
        0.5 * v.dot(&(&terms.mass * &v)) + 9.81 * (height("upper") + 2.0 * height("lower"))
    };
    let settings = Settings { method: Method::Dop853, control: Control::Tolerance(1e-12), balance: true, ..Settings::default() };
    let mut run = mechanism.simulate(settings).unwrap();
    let (q, v) = mechanism.start();
    let begin = energy(0.0, &q, &v);
    let end = run.advance(1.0).unwrap().clone();
    let work: f64 = end.work.iter().sum();
    assert!(work.abs() > 0.1, "{work}");
    let off = energy(1.0, &end.q, &end.v) - begin - work;
    assert!(off.abs() < 1e-9, "{off:e} J of {work} J");
}

#[test]
fn forces_and_moments_are_those_of_a_load_of_the_file() {
    for (space, load, force, moment) in [
        ("planar", "{ at: lower.end, force: [1 N, -2 N], torque: 0.7 N m }", [1.0, -2.0, 0.0], [0.0, 0.0, 0.7]),
        ("spatial", "{ at: lower.end, force: [1 N, -2 N, 3 N], torque: [0.5 N m, -0.4 N m, 0.7 N m] }", [1.0, -2.0, 3.0], [0.5, -0.4, 0.7]),
    ] {
        let file = bars(space, &format!("loads: {{ push: {load} }}"));
        let own = bars(space, "").with_force(&["lower.end"], move |_, _, out| {
            out[0] = Wrench { force: force.into(), moment: moment.into() };
        });
        let (q, v) = file.start();
        let [a, b] = [&file, &own.unwrap()].map(|m| m.accelerations(0.0, &q, &v).unwrap().0);
        assert!((&a - &b).norm() < 1e-12 * a.norm(), "{space}: {a} {b}");
    }
}

#[test]
fn tangents_are_the_differences_of_residuals() {
    let mechanism = bars("spatial", "").with_force(&["ground.post", "lower.end"], spring).unwrap();
    let mut system = mechanism.system();
    let dims = system.dims();
    let (q, _) = mechanism.start();
    let v: Vec<f64> = (0..dims.v).map(|i| 0.3 - 0.4 * i as f64).collect();
    let a: Vec<f64> = (0..dims.v).map(|i| 1.0 + i as f64).collect();
    let lambda = vec![0.5; dims.rows()];
    let state = State { q, v, ..State::new(dims) };
    let mut tangent = Tangent::new(system.pattern());
    system.tangent(state.at(), &a, &lambda, &mut tangent);
    let h = 1e-5;
    for j in 0..dims.v {
        let [mut k, mut c] = [[vec![0.0; dims.v], vec![0.0; dims.v]], [vec![0.0; dims.v], vec![0.0; dims.v]]];
        for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
            let mut moved = state.clone();
            let delta: Vec<f64> = (0..dims.v).map(|i| if i == j { sign * h } else { 0.0 }).collect();
            system.retract(Span::at(0.0), &mut moved.q, &delta);
            system.residual(moved.at(), &a, &lambda, &mut k[side]);
            let mut faster = state.clone();
            faster.v[j] += sign * h;
            system.residual(faster.at(), &a, &lambda, &mut c[side]);
        }
        for i in 0..dims.v {
            for (what, sides, got) in [("k", &k, tangent.k.at(i, j)), ("c", &c, tangent.c.at(i, j))] {
                let expected = (sides[0][i] - sides[1][i]) / (2.0 * h);
                assert!((got - expected).abs() < 1e-7 * (1.0 + expected.abs()), "{what}[{i}, {j}]: {got} for {expected}");
            }
        }
    }
}

#[test]
fn forces_from_outside_allocate_nothing() {
    let mechanism = bars("spatial", "").with_force(&["ground.post", "lower.end"], spring).unwrap();
    let mut system = mechanism.system();
    let dims = system.dims();
    let state = State { q: mechanism.start().0, ..State::new(dims) };
    let (mut terms, mut tangent, mut work) = (Terms::new(dims, system.pattern()), Tangent::new(system.pattern()), vec![0.0; dims.work]);
    let (a, lambda) = (vec![0.0; dims.v], vec![0.0; dims.rows()]);
    let mut evaluate = || {
        system.terms(state.at(), Stage::Dynamics, &mut terms);
        system.tangent(state.at(), &a, &lambda, &mut tangent);
        system.power(state.at(), &a, &lambda, &mut work);
    };
    // scratch is made by the first evaluation
    evaluate();
    assert_eq!(measure(evaluate).count_total, 0);
}

#[test]
fn terms_that_hold_a_position_are_those_of_terms_that_hold_nothing() {
    // two evaluators of one mechanism write into the same terms, in any order of stages and states
    let mechanism = bars("spatial", "");
    let [mut one, mut other, mut fresh] = [0; 3].map(|_| mechanism.system());
    let dims = one.dims();
    let state = |k: usize| {
        let mut state = State { q: mechanism.start().0, ..State::new(dims) };
        state.q.iter_mut().enumerate().for_each(|(i, q)| *q += 0.1 * ((7 * i + 3 * (k / 2)) as f64).sin());
        state.v.iter_mut().enumerate().for_each(|(i, v)| *v = ((5 * i + k) as f64).cos());
        state
    };
    let mut terms = Terms::new(dims, one.pattern());
    for (k, stage) in [Stage::Position, Stage::Velocity, Stage::Dynamics, Stage::Dynamics].into_iter().cycle().take(60).enumerate() {
        let system = if k % 5 == 3 { &mut other } else { &mut one };
        let now = state(k / 3);
        system.terms(now.at(), stage, &mut terms);
        let mut expected = Terms::new(dims, fresh.pattern());
        fresh.terms(now.at(), stage, &mut expected);
        assert_eq!((&terms.mass, &terms.g, &terms.phi), (&expected.mass, &expected.g, &expected.phi), "{k}");
        if stage == Stage::Dynamics {
            assert_eq!(terms, expected, "{k}");
        }
    }
    // an evaluator that stands where it stood does not take what another one has written for its own
    let [here, there] = [state(0), state(2)];
    let mut others = Terms::new(dims, other.pattern());
    other.terms(here.at(), Stage::Dynamics, &mut others);
    one.terms(there.at(), Stage::Dynamics, &mut terms);
    other.terms(here.at(), Stage::Dynamics, &mut terms);
    assert_ne!(terms.mass, Terms::new(dims, other.pattern()).mass);
    assert_eq!(terms, others);
}

#[test]
fn a_point_that_is_not_there_is_named() {
    let error = bars("planar", "").with_force(&["lower.tip"], spring).unwrap_err();
    assert!(error.to_string().contains("lower.tip"), "{error}");
}

const SWING: &str = "
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, rod.start] }, Q: { revolute: [rod.end, lower.start] } }
start: { P.angle: -30 deg, Q.angle: 20 deg, P.omega: 0, Q.omega: 0 }
studies:
  swing: { dynamics: { until: 1 s }, columns: [P.angle, Q.angle, P.fx] }
";

#[test]
fn an_integrator_from_outside_is_compared_as_those_of_the_library() {
    let model = Model::parse(SWING).unwrap();
    // schemes of the library under other names: the same steps, the same digits
    let own = |method: Method| {
        move |system: &dyn grashof::solvers::System| {
            let control = Control::Steps([0.01, 0.01]);
            schemes::new(method, Settings { method, control, level: Level::Stabilized, ..Settings::default() }, system)
        }
    };
    let study = model.study("swing").unwrap();
    let newmark = Method::Newmark { displacement: 0.25, velocity: 0.5 };
    let study = study.integrator("mine", own(Method::Rk4)).integrator("ours", own(newmark));
    let compared = study.compare_steps(&["rk4", "mine", "newmark", "ours"], &[0.01], &|| 0.0).unwrap();
    let rows = &compared.rows;
    assert_eq!(rows.iter().map(|r| r.integrator.as_str()).collect::<Vec<_>>(), ["rk4", "mine", "newmark", "ours"]);
    for pair in rows.chunks(2) {
        assert!(pair.iter().all(|r| r.reason.is_empty()), "{pair:?}");
        assert!(pair[0].error > 0.0 && pair[0].error == pair[1].error, "{pair:?}");
        assert_eq!(pair[0].counts, pair[1].counts);
    }
    let error = study.compare(&["yours"], &[1e-6], &|| 0.0).unwrap_err().to_string();
    assert!(error.contains("yours"), "{error}");
}

/// Keeps what it gets.
#[derive(Default)]
struct Kept(Mutex<(Vec<String>, Vec<Vec<f64>>)>);

impl Sink for Kept {
    fn begin(&self, independent: &Column, columns: &[Column]) {
        let names = std::iter::once(independent).chain(columns).map(|c| format!("{} [{}]", c.name, c.unit)).collect();
        *self.0.lock().unwrap() = (names, Vec::new());
    }

    fn row(&self, place: f64, values: &[f64]) {
        self.0.lock().unwrap().1.push(std::iter::once(place).chain(values.iter().copied()).collect());
    }
}

#[test]
fn a_sink_gets_the_rows_of_the_table() {
    let turn = "
grashof: 1
name: crank
space: planar
gravity: none
bodies: { crank: { bar: { length: 1 m, mass: 1 kg } } }
joints: { O: { revolute: [ground, crank.start] } }
drivers: { drive: { joint: O, speed: 3 rad/s } }
studies: { turn: { inverse: { over: 1 turn, samples: 36 }, columns: [O.angle, O.fx, shape] } }
measures:
  shape: if(crank.end.x > 0, 1, 2)
";
    for (text, name, least) in [(SWING, "swing", 10), (turn, "turn", 39)] {
        let model = Model::parse(text).unwrap_or_else(|e| panic!("{e}"));
        let table = model.study(name).unwrap().run().unwrap_or_else(|e| panic!("{e}"));
        let kept = Kept::default();
        let results = model.study(name).unwrap().rows_to(&kept).run().unwrap();
        assert_eq!((results.table.rows(), results.independent.values.len()), (0, 0));
        assert_eq!(results.extremes, table.extremes);
        assert_eq!(results.certificate.constraint, table.certificate.constraint);
        let (names, rows) = kept.0.into_inner().unwrap();
        let unit = |c: &Column| format!("{} [{}]", c.name, c.unit);
        assert_eq!(names, std::iter::once(&table.independent).chain(&table.table.columns).map(unit).collect::<Vec<_>>());
        assert!(rows.len() >= least && rows.len() == table.table.rows(), "{}", rows.len());
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(row[0], table.independent.values[i]);
            assert!(row[1..].iter().copied().eq(table.table.row(i)));
        }
    }
}

#[test]
fn rows_go_to_a_file_as_the_table_does() {
    let model = Model::parse(SWING).unwrap_or_else(|e| panic!("{e}"));
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rows_go_to_a_file");
    std::fs::create_dir_all(&directory).unwrap();
    let path = directory.join("swing.csv");
    let left = || std::fs::read_dir(&directory).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>();
    let table = model.study("swing").unwrap().run().unwrap().table;
    for finished in [true, false] {
        let file = CsvRows::create(&path).unwrap();
        model.study("swing").unwrap().rows_to(&file).run().unwrap();
        if finished {
            file.finish().unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), write_csv(&table));
            assert_eq!(left(), ["swing.csv"]);
            std::fs::remove_file(&path).unwrap();
        } else {
            assert_eq!(left(), [".swing.csv.new"]);
            drop(file);
            assert!(left().is_empty());
        }
    }
    let nowhere = CsvRows::create(&directory.join("nowhere/swing.csv")).unwrap_err();
    assert!(nowhere.to_string().contains("nowhere/swing.csv"), "{nowhere}");
}

#[test]
fn rows_that_are_streamed_leave_those_that_figures_need() {
    let model = model(&SWING.replace("until: 1 s", "until: 1 s, every: 0.1 ms"), Some("swing"));
    let study = model.study.as_ref().unwrap();
    let all = named(&model, study, run(Case::new(&model, study, &parameters(&model)), &|| false).unwrap());
    let kept = Kept::default();
    let rows = Some(Streamed { sink: &kept, keep: 3_000 });
    let some = named(&model, study, run(Case { rows, ..Case::new(&model, study, &parameters(&model)) }, &|| false).unwrap());
    assert_eq!(kept.0.into_inner().unwrap().1.len(), all.table.rows());
    assert_eq!((some.table.selected_from, all.table.selected_from), (Some(all.table.rows()), None));
    assert!(some.table.rows() < all.table.rows() / 5, "{} of {}", some.table.rows(), all.table.rows());
    // rows of the motion, among them those with its extremes, and the same numbers in everything else
    let row = |r: &Results, i: usize| r.table.row(i).collect::<Vec<f64>>();
    for i in 0..some.table.rows() {
        let k = all.independent.values.iter().position(|t| *t == some.independent.values[i]).unwrap();
        assert_eq!(row(&some, i), row(&all, k));
    }
    for (few, many) in some.table.columns.iter().zip(&all.table.columns) {
        let ends = |values: &[f64]| [f64::min, f64::max].map(|best| values.iter().copied().reduce(best));
        assert_eq!(ends(&few.values), ends(&many.values), "{}", few.name);
    }
    assert_eq!((&some.extremes, &some.scalars, some.certificate.evaluations), (&all.extremes, &all.scalars, all.certificate.evaluations));
    assert!(summary(&some).contains(&format!("{} rows", all.table.rows())), "{}", summary(&some));
}

#[test]
fn rows_go_out_while_the_motion_runs() {
    let model = Model::parse(SWING).unwrap_or_else(|e| panic!("{e}"));
    let whole = model.study("swing").unwrap().run().unwrap();
    let kept = Kept::default();
    let rows = || kept.0.lock().unwrap().1.len();
    let results = model.study("swing").unwrap().rows_to(&kept).stop_if(|| rows() >= 5).run().unwrap();
    assert!(results.stopped.is_some_and(|why| why.contains("interrupted")));
    let kept = kept.0.into_inner().unwrap().1;
    assert!(kept.len() >= 5 && kept.len() < whole.table.rows() / 2, "{} of {}", kept.len(), whole.table.rows());
    // all but the last, which is where the motion was ended
    for (row, place) in kept[..kept.len() - 1].iter().zip(&whole.independent.values) {
        assert_eq!(row[0], *place);
    }
}

/// A slide pressed on its guide by the force alone: its friction is that of the force, whichever side it presses on.
#[test]
fn friction_by_reactions_sees_forces_from_outside() {
    let slide = |more: &str| {
        let text = format!(
            "
grashof: 1
name: slide
space: planar
gravity: none
bodies: {{ block: {{ mass: 2 kg, inertia: 0.1 kg m^2 }} }}
joints: {{ S: {{ slider: [ground, block.origin], axis: [1, 0], friction: {{ coulomb: 0.4, stick_speed: 1e-3 m/s, length: 10 cm }} }} }}
start: {{ S.position: 0 m, S.velocity: 3 m/s }}
{more}
"
        );
        Model::parse(&text).unwrap_or_else(|e| panic!("{e}")).mechanism().unwrap_or_else(|e| panic!("{e}"))
    };
    for press in [-20.0, 20.0] {
        let file = slide(&format!("loads: {{ push: {{ at: block.origin, force: [0 N, {press} N] }} }}"));
        let own = slide("").with_force(&["block"], move |_, _, out| out[0].force.y = press).unwrap();
        for method in [Method::Dop853, Method::Radau5] {
            let settings = Settings { method, control: Control::Tolerance(1e-10), balance: true, ..Settings::default() };
            let [x, y] = [&file, &own].map(|m| m.simulate(settings).unwrap().advance(0.5).unwrap().clone());
            // a = -0.4 * 20 N / 2 kg
            assert!((x.v[0] - 1.0).abs() < 1e-8, "{method:?} {press}: {} m/s", x.v[0]);
            assert!((x.v[0] - y.v[0]).abs() < 1e-8, "{method:?} {press}: {} {} m/s", x.v[0], y.v[0]);
        }
    }
}
