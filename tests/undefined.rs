//! What is undefined stops a study where it happens: with its name, its place in the file, the function and its argument.

use crate::common::model;
use grashof::model::{Document, Selection};
use grashof::results::{Failure, Undefined};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;
use std::f64::consts::{FRAC_PI_2, PI};

fn arm(parts: &str, study: &str) -> String {
    format!(
        "
grashof: 1
name: arm
space: planar
gravity: [0, -9.81 m/s^2]
tables:
  gas: {{ points: [[0.5 m, 10 N], [2 m, 40 N]], beyond: error }}
bodies: {{ arm: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ O: {{ revolute: [ground, arm.start] }} }}
{parts}
studies:
  s:
{study}
"
    )
}

fn result(text: &str) -> Result<Outcome, Failure> {
    let model = model(text, Some("s"));
    let study = model.study.clone().expect("the study");
    run(Case::new(&model, &study, &parameters(&model)), &|| false)
}

/// A run that has stopped at something undefined.
fn stopped(text: &str) -> (Outcome, Undefined) {
    let outcome = result(text).unwrap_or_else(|f| panic!("{}", f.reason()));
    let undefined = outcome.undefined.clone().unwrap_or_else(|| panic!("not stopped: {:?}", outcome.stopped));
    assert_eq!(outcome.stopped.as_ref(), Some(&undefined.message));
    (outcome, undefined)
}

fn refused(text: &str) -> Undefined {
    match result(text) {
        Err(Failure::Undefined(undefined)) => undefined,
        Err(other) => panic!("{}", other.reason()),
        Ok(outcome) => panic!("it ran: {:?}", outcome.stopped),
    }
}

#[track_caller]
fn says(undefined: &Undefined, place: &str, words: &[&str]) {
    assert_eq!(undefined.place, place, "{}", undefined.message);
    for word in words {
        assert!(undefined.message.contains(word), "`{word}` in: {}", undefined.message);
    }
}

const DRIVEN: &str = "drivers: { drive: { joint: O, speed: 30 rpm } }";

#[test]
fn a_force_without_a_value_ends_a_driven_motion_there() {
    let parts = format!("{DRIVEN}\nloads: {{ push: {{ joint: O, torque: 1 N m*sqrt(cos(O.angle)) }} }}");
    for samples in [3, 36, 500] {
        let study = format!(
            "    inverse: {{ over: 1 turn, samples: {samples} }}
    columns: [O.angle, drive]
    scalars: {{ most: max(drive.torque) }}
    expect: {{ most: {{ is: 0, within: 1e9 }} }}"
        );
        let (outcome, undefined) = stopped(&arm(&parts, &study));
        says(&undefined, "loads.push", &["load `push`", "O.angle = ", "sqrt of -"]);
        let last = outcome.places.last().expect("rows");
        assert!((last - FRAC_PI_2).abs() < 1e-12, "{samples}: {last}");
        assert!(outcome.rows.iter().flatten().all(|x| x.is_finite()));
        assert!(outcome.expectations.is_empty(), "what is expected of the whole is not judged");
    }
    // the same motion with a guard is whole
    let guarded = parts.replace("1 N m*sqrt(cos(O.angle))", "\"if(cos(O.angle) > 0, 1 N m*sqrt(cos(O.angle)), 0 N m)\"");
    let outcome = result(&arm(&guarded, "    inverse: { over: 1 turn, samples: 36 }")).expect("a whole turn");
    assert_eq!(outcome.stopped, None);
}

#[test]
fn a_force_without_a_value_ends_a_motion_in_time_there() {
    // the arm falls from 45° below the horizontal through the place where the root ends
    let parts = "loads: { push: { joint: O, torque: 1 N m*sqrt(cos(O.angle)) } }\nstart: { O.angle: -45 deg, O.omega: 0 rad/s }";
    for integrator in ["auto", "dop853"] {
        let study = format!("    dynamics: {{ until: 3 s, every: 0.1 s, integrator: {integrator} }}\n    columns: [time, O.angle]");
        let (outcome, undefined) = stopped(&arm(parts, &study));
        says(&undefined, "loads.push", &["load `push`", "t = 0.", "sqrt of -"]);
        let last = outcome.rows.last().expect("rows")[1];
        assert!((last + FRAC_PI_2).abs() < 1e-5, "{integrator}: {last}");
    }
}

#[test]
fn a_table_names_its_argument_and_its_range() {
    let spring = "springs: { gas: { between: [ground, arm.end], length: 0.7 m, force: gas_force } }";
    let parts = format!("{spring}\n{DRIVEN}");
    let text = arm(&parts, "    inverse: { over: 1 turn, samples: 36 }").replace("  gas: {", "  gas_force: {");
    let undefined = refused(&text);
    let words = ["spring `gas`", "table `gas_force` at 0.3 m, below its range from 0.5 m to 2 m"];
    says(&undefined, "springs.gas", &words);
    for study in ["statics: { from: start }", "modes: { at: start }", "linearize: { at: start }", "dynamics: { until: 1 s }"] {
        let undefined = refused(&text.replace(DRIVEN, "").replace("inverse: { over: 1 turn, samples: 36 }", study));
        says(&undefined, "springs.gas", &words);
    }
}

#[test]
fn a_driver_ends_where_its_law_does() {
    let law = |angle: &str| format!("drivers: {{ drive: {{ joint: O, angle: \"{angle}\" }} }}");
    let motion = "    inverse: { over: 3 s, samples: 30 }\n    columns: [time, O.angle, drive]";
    let (outcome, undefined) = stopped(&arm(&law("sqrt(4 - (t/1 s)^2)^3"), motion));
    says(&undefined, "drivers.drive", &["the motion of driver `drive`"]);
    assert!((outcome.places.last().expect("rows") - 2.0).abs() < 1e-9);
    let undefined = refused(&arm(&law("log(t/1 s - 1)"), motion));
    says(&undefined, "drivers.drive", &["log of -1"]);
    // in time as well, at the end of a table, with the rows before
    let table = "tables: { lift: { points: [[0 s, 0 rad], [1 s, 1 rad], [2 s, 3 rad]], between: cubic, beyond: error } }";
    let text = arm(&law("lift(t)"), "    dynamics: { until: 3 s, every: 0.1 s }\n    columns: [time, O.angle]");
    let old = "tables:\n  gas: { points: [[0.5 m, 10 N], [2 m, 40 N]], beyond: error }";
    for study in ["dynamics: { until: 3 s, every: 0.1 s }", "kinematics: { over: 3 s, samples: 30 }"] {
        let text = text.replace("dynamics: { until: 3 s, every: 0.1 s }", study).replace(old, table);
        let (outcome, undefined) = stopped(&text);
        says(&undefined, "drivers.drive", &["table `lift` at 2 s, where its range from 0 s to 2 s ends"]);
        let last = outcome.rows.last().expect("rows");
        assert!((last[0] - 2.0).abs() < 1e-9 && (last[1] - 3.0).abs() < 1e-9, "{last:?}");
    }
}

#[test]
fn a_column_stops_unless_the_file_says_that_it_may_be_undefined() {
    let parts = format!("{DRIVEN}\nmeasures: {{ root: sqrt(cos(O.angle)), capped: \"max(sqrt(-1 - O.angle), 1)\" }}");
    let study = |rest: &str| arm(&parts, &format!("    inverse: {{ over: 1 turn, samples: 36 }}\n{rest}"));
    let (outcome, undefined) = stopped(&study("    columns: [O.angle, root]"));
    says(&undefined, "measures.root", &["`root`", "O.angle = ", "sqrt of -"]);
    assert!((outcome.places.last().expect("rows") - FRAC_PI_2).abs() < 1e-12);
    says(&refused(&study("    columns: [O.angle, capped]")), "measures.capped", &["sqrt of -1"]);
    // what only a number is taken of is watched as well
    stopped(&study("    columns: [O.angle]\n    scalars: { most: max(root) }"));

    let outcome = result(&study("    columns: [O.angle, root]\n    undefined: [root]\n    scalars: { most: max(root) }")).expect("blank");
    assert_eq!((outcome.stopped.as_ref(), outcome.scalars[0]), (None, 1.0));
    let blank = outcome.rows.iter().filter(|r| r[1].is_nan()).count();
    assert!((17..=18).contains(&blank), "{blank}");
    assert!(outcome.findings.iter().all(|f| f.code != "blank-cells"), "the file says it already");
    // an integral over what is not defined everywhere is told not to exist
    let outcome =
        result(&study("    columns: [O.angle, root]\n    undefined: [root]\n    scalars: { sum: integral(root) }")).expect("blank");
    assert!(outcome.scalars[0].is_nan() && outcome.findings.iter().any(|f| f.code == "undefined-scalar"));
}

/// The root is defined while |x| > 0.003, whatever the mode of `abs` is before it is looked at.
#[test]
fn a_force_that_is_defined_at_the_start_lets_the_motion_begin() {
    let parts = "start: { O.angle: -1 rad, O.omega: 0 rad/s }\nloads: { hold: { joint: O, torque: 1 N m*sqrt(abs(O.angle) - 0.003) } }";
    for integrator in ["dop853", "radau5"] {
        let study = format!("    dynamics: {{ until: 0.01 s, every: 0.01 s, integrator: {integrator} }}\n    columns: [O.alpha]");
        let outcome = result(&arm(parts, &study)).expect("a motion");
        let right = (0.997_f64.sqrt() - 9.81 * 1.0_f64.cos()) / (2.0 / 3.0);
        assert!(outcome.stopped.is_none() && (outcome.rows[0][0] - right).abs() < 1e-9, "{integrator}: {:?}", &outcome.rows[0]);
    }
}

/// Rows and first panels lie farther apart than the places where the root has no value.
#[test]
fn what_is_undefined_between_rows_stops_the_study_as_well() {
    let root = "measures: { root: sqrt(abs(O.angle - 1.03) - 0.0003) }";
    let studies = [
        ("drivers: { drive: { joint: O, speed: 1 rad/s } }\nstart: { O.angle: 0 rad }", "inverse: { over: 2 s, samples: 4 }"),
        (
            "start: { O.angle: 0 rad, O.omega: 1 rad/s }\nloads: { hold: { joint: O, torque: 9.81 N m*cos(O.angle) } }",
            "dynamics: { until: 2 s, every: 0.5 s }",
        ),
    ];
    for (parts, study) in studies {
        for shown in ["columns: [root]", "columns: [O.angle]\n    scalars: { m: mean(root) }"] {
            let (outcome, undefined) = stopped(&arm(&format!("{parts}\n{root}"), &format!("    {study}\n    {shown}")));
            says(&undefined, "measures.root", &["`root`", "sqrt of -"]);
            let end = outcome.places.last().expect("rows");
            assert!((end - 1.0297).abs() < 1e-7, "{study}: {end}");
        }
    }
}

#[test]
fn a_column_stops_every_kind_of_study() {
    let parts = "measures: { root: sqrt(O.angle + 1.2) }\nstart: { O.angle: 0 rad, O.omega: 0 rad/s }";
    let dynamics = "    dynamics: { until: 1 s, every: 0.1 s }\n    columns: [time, O.angle, root]";
    let (outcome, undefined) = stopped(&arm(parts, dynamics));
    says(&undefined, "measures.root", &["t = 0.", "sqrt of -"]);
    let last = outcome.rows.last().expect("rows");
    assert!((last[1] + 1.2).abs() < 1e-12 && last[2] < 1e-6, "{last:?}");
    assert_eq!(result(&arm(parts, &format!("{dynamics}\n    undefined: [root]"))).expect("blank").stopped, None);
    for study in ["statics: { from: start }\n    columns: [root]", "linearize: { at: statics }\n    columns: [root]"] {
        says(&refused(&arm(parts, &format!("    {study}"))), "measures.root", &["sqrt of -0.3707963"]);
    }
    let forced = "loads: { push: { joint: O, torque: 1 N m*sin(2*pi*t/1 s) - 3 N m s*O.omega } }
measures: { root: sqrt(O.angle + pi/2) }
start: { O.angle: -90 deg }";
    let study = "    periodic: { over: t, by: 1 s, of: O.angle }\n    columns: [O.angle, root]";
    says(&refused(&arm(forced, study)), "measures.root", &["sqrt of -"]);
}

#[test]
fn a_number_of_the_study_stops_it_or_is_told_to_be_missing() {
    let study = |numbers: &str| arm(DRIVEN, &format!("    inverse: {{ over: 1 turn, samples: 36 }}\n    {numbers}"));
    let (outcome, undefined) = stopped(&study("scalars: { a: sqrt(min(drive.torque)/1 N/1 m) }"));
    says(&undefined, "studies.s.scalars.a", &["`a`", "sqrt of -9.81"]);
    assert_eq!(outcome.rows.len(), 37);
    let (_, undefined) = stopped(&study("expect: { log(min(O.angle) - 1): { is: 0, within: 9 } }"));
    says(&undefined, "studies.s.expect.log(min(O.angle) - 1)", &["log of -1"]);
    // what never happens has no place, and is told
    let outcome = result(&study("scalars: { never: first(O.angle > 10), far: \"value(O.angle, 9 turn)\" }")).expect("a whole turn");
    assert!(outcome.stopped.is_none() && outcome.scalars.iter().all(|x| x.is_nan()));
    let told: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "undefined-scalar").map(|f| f.message.as_str()).collect();
    assert!(told.len() == 2 && told[0].contains("never holds") && told[1].contains("does not reach"), "{told:?}");
}

#[test]
fn a_constant_without_a_value_is_a_fault_of_the_file() {
    let loads = "loads: { a: { joint: O, torque: 1 N m*log(-2) }, b: { joint: O, torque: \"max(1 N m*sqrt(-3), 1 N m)\" } }";
    let text = arm(loads, "    dynamics: { until: 1 s }");
    let document = Document::read(&text, "test.yaml").unwrap_or_else(|report| panic!("{report:?}"));
    let report = document.model(&Selection { study: Some("s"), ..Selection::default() }).expect_err("a fault of the file");
    let places: Vec<&str> = report.diagnostics.iter().map(|d| d.place.as_str()).collect();
    assert_eq!(places, ["loads.a.torque", "loads.b.torque"]);
}

#[test]
fn what_a_dead_point_leaves_open_stays_blank_and_is_told() {
    let text = "
grashof: 1
name: rocker that cannot turn
space: planar
gravity: none
ground: { O: [0, 0], C: [30 cm, 0] }
bodies:
  crank: { bar: { length: 30 cm } }
  coupler: { bar: { length: 20 cm } }
  rocker: { bar: { length: 25 cm } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 60 deg, coupler.angle: ~10 deg, rocker.angle: ~90 deg }
studies:
  s: { kinematics: { over: 1 turn, samples: 60 }, columns: [O.angle, rocker.omega, rocker.angle, rocker.alpha, coupler.omega] }
";
    let outcome = result(text).expect("a part of the turn");
    assert!(outcome.stopped.is_some_and(|why| why.contains("dead point")) && outcome.undefined.is_none());
    let last = outcome.rows.last().expect("rows");
    assert!(last[1].is_nan() && last[2].is_finite() && last[0] < PI);
    // columns with the same blank rows are told together
    let blank: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "blank-cells").map(|f| f.message.as_str()).collect();
    assert!(
        matches!(blank[..], [one] if one.starts_with("`rocker.omega`, `rocker.alpha`, `coupler.omega` are not defined in 2 of 17 rows")),
        "{blank:?}"
    );
}

#[test]
fn a_switch_on_a_rate_is_followed_up_to_a_dead_point() {
    let text = "
grashof: 1
name: pump whose rod is too short
space: planar
gravity: none
bodies:
  crank: { bar: { length: 30 mm } }
  rod: { bar: { length: 20 mm } }
  piston: { mass: 0.2 kg }
joints:
  O: { revolute: [ground, crank.start] }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, piston.origin] }
  W: { slider: [ground, piston.origin], axis: [1, 0] }
drivers: { drive: { joint: O, speed: 900 rpm } }
start: { O.angle: 0, W.position: ~50 mm }
measures:
  push: \"if(W.velocity > 0, 800 N, 0 N)\"
studies:
  s:
    kinematics: { over: 1 turn, samples: 90 }
    columns: [O.angle, W.position, push]
    scalars:
      far: value(W.position, asin(2/3) - 1e-4 rad)
      near: value(W.position, asin(2/3) - 1e-10 rad)
";
    let outcome = result(text).unwrap_or_else(|f| panic!("{}", f.reason()));
    assert!(outcome.stopped.is_some_and(|why| why.contains("dead point")));
    let [first, last] = [outcome.rows.first(), outcome.rows.last()].map(|row| row.expect("rows"));
    assert!((last[0] - (2.0_f64 / 3.0).asin()).abs() < 1e-9 && first[2].is_nan() && last[2].is_nan());
    // next to the dead point as well: r cos θ + √(l² − r² sin² θ)
    for (found, off) in outcome.scalars.iter().zip([1e-4, 1e-10]) {
        let theta = (2.0_f64 / 3.0).asin() - off;
        let (r, l) = (0.03, 0.02);
        let exact = r * theta.cos() + ((l - r * theta.sin()) * (l + r * theta.sin())).sqrt();
        assert!((found - exact).abs() < 1e-10, "{found} {exact}");
    }
    // outwards on the way back from the other dead point, inwards behind the dead centre
    let pushes: Vec<f64> = outcome.rows.iter().map(|row| row[2]).filter(|x| x.is_finite()).collect();
    assert!(pushes.len() > 15 && pushes[0] == 800.0 && pushes[pushes.len() - 1] == 0.0, "{pushes:?}");
}

#[test]
fn columns_that_nobody_asked_for_stop_nothing() {
    let measure = "measures: { ratio: 1/O.omega }";
    let text = arm(measure, "    statics: { from: start }");
    let asked = arm(measure, "    statics: { from: start }\n    columns: [ratio]");
    let outcome = result(&text).unwrap_or_else(|f| panic!("{}", f.reason()));
    assert!(outcome.stopped.is_none() && outcome.findings.iter().any(|f| f.code == "blank-cells" && f.message.contains("`ratio`")));
    refused(&asked);
}
