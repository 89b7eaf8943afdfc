//! Bad files: code, line and column of each fault. The full texts are pinned by the snapshots of the command line's tests.

use super::super::*;

const BASE: &str = "\
grashof: 1
name: four-bar
space: planar
gravity: [0, -9.81 m/s^2]
parameters:
  l1: 15 cm
  l2: 1 m
  speed: 240 rpm
ground: { O: [0, 0], C: [l2, 0] }
bodies:
  crank: { bar: { length: l1, mass: 3 kg } }
  coupler: { bar: { length: l2, mass: 6 kg } }
  rocker: { bar: { length: 55 cm, mass: 6 kg }, points: { tip: [70 cm, 0] } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: speed } }
start: { O.angle: 0 deg, coupler.angle: ~33 deg, rocker.angle: ~92 deg }
measures:
  theta: crank.angle
  omega: rate(theta)
variants:
  v: { parameters: { l1: 20 cm } }
studies:
  turn:
    inverse: { over: 1 turn, samples: 36 }
    columns: [theta, time, O, drive]
    scalars: { T_mean: mean(drive.torque), double: 2*T_mean }
    expect: { T_mean: { is: 0 N m, within: 10 N m } }
";

/// Every finding of the base file with one text replaced: `code line:column`.
fn findings(from: &str, to: &str) -> Vec<String> {
    assert!(BASE.contains(from), "{from}");
    let text = BASE.replacen(from, to, 1);
    let report = match Document::read(&text, "bad.yaml") {
        Ok(document) => document.check_all(&Selection::default()),
        Err(report) => report,
    };
    for diagnostic in &report.diagnostics {
        let said = format!("{} {}", diagnostic.message, diagnostic.expected);
        assert!(!said.contains('\n') && !said.contains("Some("), "{said}");
        assert!(diagnostic.help.is_some(), "no remedy: {said}");
    }
    report.diagnostics.iter().map(|d| format!("{} {}:{}", d.code, d.line(), d.column())).collect()
}

#[test]
fn the_base_is_sound() {
    assert_eq!(findings("time", "time"), Vec::<String>::new());
}

#[test]
fn form() {
    for (from, to, expected) in [
        ("revolute: [crank.end", "revolut: [crank.end", "unknown-key 16:8"),
        ("revolute: [crank.end, coupler.start]", "damping: 1", "missing-key 16:3"),
        ("joint: O, speed: speed", "joint: O, speed: speed, angle: 1", "two-kinds 19:45"),
        ("space: planar\n", "", "missing-key 1:1"),
        ("space: planar", "space: plane", "unknown-word 3:8"),
        ("name: four-bar", "name: 12", "wrong-type 2:7"),
        ("grashof: 1", "grashof: 2", "bad-count 1:10"),
        ("  l1: 15 cm", "  l1:", "empty-value 6:3"),
        ("  l1: 15 cm", "  l1: .inf", "bad-number 6:7"),
        ("  l1: 15 cm", "  l1: true", "wrong-type 6:7"),
        ("O: [0, 0]", "O: [0, 0, 0]", "wrong-size 9:14"),
        ("length: l1", "length:l1", "missing-space 11:19"),
        ("over: 1 turn", "over: max(1 turn, 2 turn)", "comma-in-braces 28:22"),
        ("[70 cm, 0]", "[max(1 m, 2 m), 0]", "comma-in-braces 13:65"),
        ("measures:", "replicate: 3\nmeasures:", "not-yet 21:1"),
        ("  omega:", "  2omega:", "bad-name 23:3"),
        ("  omega:", "  <<:", "yaml-merge-key 23:3"),
        ("  omega:", "  7:", "bad-name 22:3"),
        ("{ parameters: {", "{ studies: {}, parameters: {", "unknown-key 25:8"),
        ("samples: 36", "samples: 100000000", "bad-count 28:39"),
    ] {
        assert_eq!(findings(from, to), [expected], "{to}");
    }
}

#[test]
fn what_stands_behind_a_fault_is_read_all_the_same() {
    let both = findings("revolute: [crank.end, coupler.start]", "revolut: [crank.end, coupler.begin]");
    assert_eq!(both, ["unknown-key 16:8", "unknown-point 16:29"]);
    assert_eq!(findings("joint: O, speed: speed", "joint: Q, speed: 60 Hz"), ["unknown-joint 19:28", "expression 19:41"]);
}

#[test]
fn names() {
    for (from, to, expected) in [
        ("crank.end", "crnk.end", "unknown-body 16:19"),
        ("crank.end", "crank.ende", "unknown-point 16:19"),
        ("crank.end, coupler.start", "crank.end, crank.start", "same-body 16:18"),
        ("joint: O", "joint: Q", "unknown-joint 19:28"),
        ("length: l1", "length: l_1", "unknown-name 11:27"),
        ("  speed: 240 rpm", "  speed: 240 rpm\n  sin: 3", "reserved-name 9:3"),
        ("  speed: 240 rpm", "  speed: 240 rpm\n  m: 3\n  lever: 2 m/s*m", "expression 10:16"),
        ("  l1: 15 cm\n  l2: 1 m", "  l1: 2*l2\n  l2: l1", "cycle 6:3"),
        ("rate(theta)", "rate(theta) + omega", "cycle 23:3"),
        ("double: 2*T_mean", "double: 2*double", "cycle 30:44"),
        ("double:", "theta:", "reserved-name 30:44"),
        ("    columns", "    variant: w\n    columns", "unknown-variant 29:14"),
        ("    columns", "    set: { l9: 1 }\n    columns", "unknown-parameter 29:12"),
        ("    columns", "    take: { k: turn.double }\n    columns", "cycle 29:5"),
        ("theta, time", "tetha, time", "unknown-name 29:15"),
        ("theta, time", "2*theta, time", "wrong-column 29:15"),
        ("theta, time", "theta, theta, time", "duplicate-column 29:22"),
        ("O.angle: 0 deg", "O.angel: 0 deg", "unknown-name 20:10"),
        ("O.angle: 0 deg", "O.angle: 0 deg, O.alpha: 1", "wrong-start 20:26"),
        ("coupler.angle: ~33 deg", "O.omega: 0, crank.origin.x: 0, crank.x: 0", "duplicate-start 20:57"),
    ] {
        assert_eq!(findings(from, to), [expected], "{to}");
    }
}

#[test]
fn meaning() {
    for (from, to, expected) in [
        ("length: 55 cm", "length: 55 kg", "wrong-dimension 13:28"),
        ("length: l1", "length: l1 + 0.1", "wrong-dimension 11:32"),
        ("  l1: 15 cm", "  l1: 15 cm +* 2", "expression 6:14"),
        ("  l1: 15 cm", "  l1: 015", "expression 6:7"),
        ("  l2: 1 m", "  l2: \"1 m + q\"", "unknown-name 7:14"),
        ("speed: speed", "speed: omega", "wrong-level 19:38"),
        ("speed: speed", "speed: max(speed)", "wrong-level 19:38"),
        ("over: 1 turn", "over: 1 m", "wrong-dimension 28:22"),
        ("rate(theta)", "rate(rate(rate(theta)))", "expression 23:10"),
        ("  l1: 15 cm", "  l1: 1 m*sqrt(-1)", "not-a-number 6:7"),
        ("mass: 3 kg", "mass: -3 kg", "negative 11:37"),
        ("~33 deg", "~33", "bare-angle 20:41"),
        ("mean(drive.torque)", "drive.torque", "varies 30:24"),
        ("is: 0 N m", "is: 1 m", "wrong-dimension 31:29"),
        ("T_mean: { is", "max(drive.torqe): { is", "unknown-name 31:19"),
        ("revolute: [crank.end", "spherical: [crank.end", "spatial-only 16:8"),
        ("measures:", "loads: { f: { at: rocker.tip, force: [O.fx, 0] } }\nmeasures:", "wrong-level 21:39"),
        ("measures:", "tables: { k: { points: [[0, 1], [0, 2]] } }\nmeasures:", "bad-table 21:33"),
        ("    columns", "    set: { l1: -1 m }\n    columns", "negative 11:27"),
        ("    columns", "    sweep: { l1: { from: 0 m, to: 1 m, count: 3, spacing: log } }\n    columns", "bad-span 29:18"),
        ("    columns", "    plot: { a: [double] }\n    columns", "wrong-plot 29:16"),
    ] {
        assert_eq!(findings(from, to), [expected], "{to}");
    }
}

#[test]
fn degrees_without_their_unit_are_asked_for_at_parameters_too() {
    let text = BASE.replacen("  l1: 15 cm", "  l1: 15 cm\n  begin: 97", 1).replacen("O.angle: 0 deg", "O.angle: begin", 1);
    let report = Document::read(&text, "bad.yaml").unwrap().check_all(&Selection::default());
    let all: Vec<(&str, Option<&str>)> = report.diagnostics.iter().map(|d| (d.code, d.help.as_deref())).collect();
    assert_eq!(all, [("bare-angle", Some("if degrees are meant, write `begin: 97 deg` in `parameters`"))], "{report}");
}

#[test]
fn a_fault_is_said_once_however_many_studies_meet_it() {
    let text = BASE.replacen("length: l1", "length: l_1", 1);
    let second = text.clone() + "  again:\n    variant: v\n    kinematics: { over: 1 turn, samples: 36 }\n";
    let report = Document::read(&second, "bad.yaml").unwrap().check_all(&Selection::default());
    assert_eq!(report.diagnostics.len(), 1, "{report}");
}

#[test]
fn what_a_variant_breaks_is_shown_at_the_referrer_with_its_name() {
    let text =
        BASE.replacen("parameters: { l1: 20 cm }", "drivers: { drive: null }", 1).replacen("    columns", "    variant: v\n    columns", 1);
    let report = Document::read(&text, "bad.yaml").unwrap().check_all(&Selection::default());
    let codes: Vec<&str> = report.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(codes, ["no-driver", "unknown-name", "unknown-name"], "{report}");
    assert!(report.diagnostics[1].message.contains("the variant `v` removes `drive` from `drivers`"), "{report}");
    let text =
        BASE.replacen("parameters: { l1: 20 cm }", "joints: { O: null }", 1).replacen("    columns", "    variant: v\n    columns", 1);
    let report = Document::read(&text, "bad.yaml").unwrap().check_all(&Selection::default());
    assert_eq!(report.diagnostics[0].message, "unknown joint `O` (with variant `v`)");
}

#[test]
fn bytes_that_are_no_text_are_refused_at_their_place() {
    let report = Document::from_bytes(b"grashof: 1\nname: \xff\n", "bad.yaml").unwrap_err();
    assert_eq!((report.diagnostics[0].code, report.diagnostics[0].line(), report.diagnostics[0].column()), ("not-utf8", 2, 7));
}

#[test]
fn reports_read_like_those_of_a_compiler() {
    let text = BASE.replacen("crank.end", "crnk.end", 1);
    let report = Document::read(&text, "bad.yaml").unwrap().check_all(&Selection::default());
    let expected = "\
error[unknown-body]: unknown body `crnk`
  --> bad.yaml:16:19
   |
16 |   A: { revolute: [crnk.end, coupler.start] }
   |                   ^^^^^^^^
   |
   = expected: one of the bodies `ground`, `crank`, `coupler`, `rocker`
   = help: did you mean `crank.end`?
";
    assert_eq!(report.render(false), expected);
    assert!(report.render(true).contains("\x1b["));
}
