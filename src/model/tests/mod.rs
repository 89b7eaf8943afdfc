//! Whole files: the drafts decode, variants and settings win in their order, bad files are told what is wrong, and nothing panics.

mod bad;
mod motion;
mod mutations;

use super::*;
use crate::expression::{Dimension, Id};

/// The drafts of the models that the project ships.
pub(super) const FILES: [(&str, &str); 6] = [
    ("andrews", include_str!("files/andrews.yaml")),
    ("bricard", include_str!("files/bricard.yaml")),
    ("crank_rocker", include_str!("files/crank_rocker.yaml")),
    ("pendulum", include_str!("files/pendulum.yaml")),
    ("quick_return", include_str!("files/quick_return.yaml")),
    ("zoo", include_str!("files/zoo.yaml")),
];

fn document(name: &str) -> Document {
    let text = FILES.iter().find(|(file, _)| *file == name).map(|(_, text)| *text).unwrap();
    Document::read(text, name).unwrap()
}

fn model(name: &str, study: &str) -> Model {
    document(name).model(&Selection { study: Some(study), ..Selection::default() }).unwrap_or_else(|report| panic!("{report}"))
}

fn value(model: &Model, id: Id) -> f64 {
    let values: Vec<Id> = model.parameters.iter().map(|p| p.value).collect();
    model.pool.value(id, &model.pool.resolve_parameters(&values))
}

fn parameter(model: &Model, name: &str) -> f64 {
    let parameter = model.parameters.iter().find(|p| p.name == name).unwrap();
    value(model, parameter.value)
}

fn select<'a>(study: Option<&'a str>, variants: &[&str], sets: &[(&str, &str)]) -> Selection<'a> {
    Selection {
        study,
        variants: variants.iter().map(|v| (*v).to_owned()).collect(),
        sets: sets.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect(),
        ..Selection::default()
    }
}

#[test]
fn a_byte_order_mark_is_passed_over() {
    let text = format!("\u{feff}{}", FILES[3].1);
    for document in [Document::read(&text, "marked").unwrap(), Document::from_bytes(text.as_bytes(), "marked").unwrap()] {
        assert_eq!(document.text(), FILES[3].1);
        assert!(!document.check_all(&Selection::default()).failed());
    }
}

#[test]
fn every_study_of_every_draft_decodes() {
    for (name, text) in FILES {
        let document = Document::read(text, name).unwrap();
        let report = document.check_all(&Selection::default());
        assert!(report.diagnostics.is_empty(), "{report}");
        document.model(&Selection::default()).unwrap();
        for study in document.study_names() {
            assert!(model(name, &study).study.is_some());
        }
    }
}

#[test]
fn numbers_are_si_and_names_are_indices() {
    let model = model("crank_rocker", "one-turn");
    assert_eq!(model.space, Dimensions::Planar);
    assert_eq!(parameter(&model, "l1"), 0.15);
    assert!((parameter(&model, "phi3_min") - (-31.8213685_f64).to_radians()).abs() < 1e-8);
    assert_eq!(value(&model, model.gravity[1]), -9.81);
    let names: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["ground", "crank", "coupler", "rocker"]);
    let rocker: Vec<&str> = model.bodies[3].points.iter().map(|p| &*p.name).collect();
    assert_eq!(rocker, ["origin", "com", "start", "end", "B", "tip"]);
    assert_eq!(model.joints[2].b, PointRef { body: 3, point: 4 });
    assert_eq!(model.bodies[3].attached[0].at, 5);
    let table = &model.tables[0];
    assert_eq!((table.points.len(), table.x, table.y), (7, Dimension::ANGULAR_SPEED, Dimension::TORQUE));
    let start: Vec<(&str, bool)> = model.start.iter().map(|s| (s.name.as_str(), s.guess)).collect();
    assert_eq!(start, [("O.angle", false), ("coupler.angle", true), ("rocker.angle", true)]);
}

#[test]
fn columns_expand_as_the_format_says() {
    let model = model("crank_rocker", "one-turn");
    let names: Vec<&str> = model.study.as_ref().unwrap().columns.iter().map(|c| c.name.as_str()).collect();
    let expected = "theta time phi2 phi3 omega2 omega3 alpha2 alpha3 det_J tip_speed tip_acc_tangential tip_acc_centripetal tip_acc \
                    com.x com.y com.vx com.vy com.ax com.ay inertia_eq inertia_eq_slope O.fx O.fy O.f A.fx A.fy A.f B.fx B.fy B.f \
                    C.fx C.fy C.f drive.torque drive.power shaking.fx shaking.fy shaking.f frame.fx frame.fy tip_force";
    assert_eq!(names, expected.split_whitespace().collect::<Vec<_>>());
    // silent: independent variable, time, measures, drivers
    let model = self::model("crank_rocker", "characteristics");
    let study = model.study.unwrap();
    assert!(!study.columns_given);
    assert_eq!((study.columns[0].name.as_str(), study.columns[1].name.as_str()), ("O.angle", "time"));
    assert_eq!(study.columns.last().unwrap().name, "drive.power");
    let model = self::model("bricard", "fall");
    let names: Vec<String> = model.study.unwrap().columns.into_iter().map(|c| c.name).collect();
    assert_eq!(names, ["time", "rod2.end.x", "rod2.end.y", "rod2.end.z", "energy.kinetic", "energy.potential", "energy.total"]);
}

/// Names of a study's results.
fn names(study: &Study) -> Vec<&str> {
    study.results.iter().map(|r| r.name.as_str()).collect()
}

#[test]
fn kinds_results_and_functionals() {
    let balanced = model("crank_rocker", "balanced").study.unwrap();
    assert_eq!(names(&balanced), ["kappa", "lambda", "residual"]);
    assert!(matches!(balanced.kind, Kind::Balance { ref moved, .. } if *moved == [(1, 0), (3, 1)]));
    let lengths = model("crank_rocker", "lengths").study.unwrap();
    assert_eq!(names(&lengths), ["turns_fully"]);
    assert!(matches!(&lengths.sweep[0].values, Values::List(values) if values.len() == 7));
    let turn = model("crank_rocker", "one-turn");
    let study = turn.study.as_ref().unwrap();
    let texts: Vec<&str> = study.functionals.iter().map(|f| f.text.as_str()).collect();
    assert_eq!(texts, ["mean(drive.torque)", "mean(drive.power)", "max(drive.torque)", "value(phi2, 0 deg)"]);
    assert_eq!(study.expect.len(), 3);
    assert!(matches!(model("crank_rocker", "start-up").study.unwrap().kind, Kind::Dynamics(_)));
    let fluctuation = model("crank_rocker", "fluctuation").study.unwrap();
    assert_eq!(names(&fluctuation), ["period", "omega_mean", "omega_max", "omega_min", "floquet"]);
    let plot = &fluctuation.plots[0];
    assert_eq!((plot.show[0].what, plot.over.as_ref().unwrap().what), (ShownWhat::Scalar(0), ShownWhat::Parameter(18)));
}

#[test]
fn taken_scalars_decide_parameters() {
    let model = model("crank_rocker", "coupling");
    let study = model.study.as_ref().unwrap();
    assert_eq!((study.take[0].study.as_str(), study.take[0].scalar.as_str()), ("stiffness", "k0"));
    let k_t = model.parameters.iter().find(|p| p.name == "k_t").unwrap();
    let inputs = model.pool.inputs_of(&[k_t.value]);
    assert_eq!(inputs.iter().map(|i| model.inputs[*i as usize]).collect::<Vec<_>>(), [Quantity::Taken(0)]);
}

#[test]
fn variants_merge_and_settings_win_in_order() {
    let document = document("crank_rocker");
    let get = |selection: &Selection<'_>, name: &str| parameter(&document.model(selection).unwrap_or_else(|r| panic!("{r}")), name);
    // file, study's variant, --variant, set, --set
    assert_eq!(get(&select(Some("speeds"), &[], &[]), "gear"), 73.0 / 12.0);
    assert_eq!(get(&select(Some("stiffness"), &[], &[]), "I_f"), 27.84);
    assert_eq!(get(&select(Some("stiffness"), &[], &[("I_f", "5")]), "I_f"), 5.0);
    assert_eq!(get(&select(None, &[], &[("l3", "60 cm")]), "l3"), 0.6);
    assert_eq!(get(&select(None, &[], &[("l3", "0.6")]), "l3"), 0.6);
    assert_eq!(get(&select(Some("start-up"), &["scaled"], &[]), "gear"), 1.0);
    let model = document.model(&select(None, &["motor", "elastic"], &[("k_t", "1e3 N m/rad")])).unwrap();
    assert_eq!(model.variants, ["motor", "elastic"]);
    assert_eq!(model.set, ["k_t"]);
    assert!(model.drivers.is_empty());
    let motor = &model.motors[0];
    assert_eq!((motor.place.as_str(), model.joints[motor.joint].name.as_str()), ("variants.motor.motors.motor", "S"));
    assert_eq!(value(&model, motor.inertia.unwrap()), 0.0);
    assert!(motor.torque.is_some());
    assert!(matches!(model.springs[0].on, SpringOn::Stretch(_)));
}

#[test]
fn settings_from_outside_are_checked_and_shown() {
    let document = document("crank_rocker");
    let error = |sets: &[(&str, &str)]| document.model(&select(None, &[], sets)).unwrap_err().diagnostics[0].clone();
    let unit = error(&[("l3", "60 s")]);
    assert_eq!((unit.code, unit.file.as_str()), ("wrong-dimension", "command line"));
    assert_eq!(unit.at.as_ref().unwrap().source, "--set l3=60 s");
    assert_eq!((unit.line(), unit.column()), (1, 10));
    let name = error(&[("l_3", "1")]);
    assert_eq!((name.code, name.help.as_deref()), ("unknown-parameter", Some("did you mean `l3`?")));
    assert_eq!(name.at.unwrap().column, 7);
    assert_eq!(error(&[("l3", "1 m +")]).code, "expression");
    assert_eq!(error(&[("m2", "-1")]).code, "negative");
    assert_eq!(error(&[("l1", "l2"), ("l2", "l1")]).code, "cycle");
    // a program in Rust or Python gives arguments of calls, and no options
    let called = |selection: Selection<'_>| {
        let selection = Selection { caller: Caller::Code, ..selection };
        document.model(&selection).unwrap_err().diagnostics[0].clone()
    };
    let shown = |found: &Diagnostic| (found.file.clone(), found.at.as_ref().unwrap().source.clone(), found.column());
    assert_eq!(shown(&called(select(None, &[], &[("l3", "60 s")]))), ("values".into(), "l3=60 s".into(), 4));
    assert_eq!(shown(&called(select(None, &["motr"], &[]))), ("variant".into(), "motr".into(), 1));
    assert_eq!(shown(&called(select(Some("one-trun"), &[], &[]))), ("study".into(), "one-trun".into(), 1));
    let over = |value: &str| vec![("l3".to_owned(), value.to_owned())];
    let drawn = called(Selection { over: over("normal(55 cm, 1 mm)"), ..select(Some("one-turn"), &[], &[]) });
    assert_eq!(
        (shown(&drawn).0.as_str(), drawn.expected.as_str(), drawn.help.as_deref()),
        ("over", "`samples`", Some("add `samples=200`"))
    );
    let span = called(Selection { over: over("0.3..0.8"), ..select(Some("one-turn"), &[], &[]) });
    assert_eq!(span.help.as_deref(), Some("for example `0.3..0.8:11` for `l3`"));
    let report = document.model(&select(Some("one-trun"), &[], &[])).unwrap_err();
    assert_eq!(report.diagnostics[0].help.as_deref(), Some("did you mean `one-turn`?"));
    let report = document.model(&select(None, &["motr"], &[])).unwrap_err();
    assert_eq!(report.diagnostics[0].code, "unknown-variant");
}

#[test]
fn later_phases_add_findings_at_places() {
    let document = document("crank_rocker");
    let at = |place: &str| document.diagnostic("x", place, "m", "e", None);
    assert_eq!(at("bodies.crank.bar.length").at.unwrap().source.trim(), "crank:   { bar: { length: l1, mass: m1 } }");
    assert_eq!(at("joints.O.revolute[1]").column(), 29);
    // `O` is of the file, its damping of a variant
    assert_eq!(at("joints.O.damping").at.unwrap().source.trim(), "joints: { O: { damping: viscous } }");
    assert_eq!(at("start.O.angle").column(), 19);
    assert!(at("nonsense").at.is_some());
}

#[test]
fn space_has_its_own_quantities() {
    let model = model("zoo", "run");
    assert_eq!(model.space, Dimensions::Spatial);
    let rotation = &model.start[1];
    assert_eq!(
        (rotation.name.as_str(), rotation.quantity, rotation.guess),
        ("b.rotation", Quantity::Quaternion { body: 2, component: 0, order: 0 }, true)
    );
    assert!(matches!(rotation.value, StartValue::Rotation { .. }));
    assert_eq!(model.start[3].quantity, Quantity::Joint { joint: 0, slot: 0, order: 0 });
    assert_eq!(model.start[4].quantity, Quantity::Joint { joint: 3, slot: 0, order: 1 });
    let CouplingKind::Zero(zero) = model.couplings[0].kind else { panic!() };
    let inputs: Vec<Quantity> = model.pool.inputs_of(&[zero]).iter().map(|i| model.inputs[*i as usize]).collect();
    let slot = |slot| Quantity::Joint { joint: 0, slot, order: 0 };
    assert!(inputs.len() == 2 && inputs.contains(&slot(0)) && inputs.contains(&slot(1)));
    assert!(matches!(model.springs[0].law, SpringLaw::Force(_)));
    assert_eq!(model.bodies[4].inertia.len(), 6);
}

#[test]
fn many_findings_are_cut_short() {
    let head = FILES.iter().find(|(name, _)| *name == "pendulum").map(|(_, text)| *text).unwrap();
    let many: String = (0..300).map(|i| format!("  p{i}: nobody\n")).collect();
    let report = Document::read(&format!("{head}parameters:\n{many}"), "many").unwrap().check_all(&Selection::default());
    assert_eq!(report.diagnostics.len(), 201);
    assert_eq!(report.diagnostics.last().unwrap().message, "100 more findings are not shown");
    assert!(report.failed());
}

#[test]
fn the_schema_describes_the_tables() {
    let schema = schema();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    assert_eq!(schema["additionalProperties"], false);
    let joint = &schema["properties"]["joints"]["additionalProperties"];
    assert_eq!(joint["oneOf"].as_array().unwrap().len(), 11);
    assert_eq!(joint["properties"]["damping"]["type"], serde_json::json!(["number", "string"]));
    assert!(schema["properties"]["variants"]["additionalProperties"]["properties"].get("studies").is_none());
}
