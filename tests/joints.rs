//! Joints, drivers and couplings against closed forms, and classic mechanisms against reference numbers (`reference/README.md`).

use crate::common;
use crate::common::{close, columns, study};
use grashof::mechanism::Coordinates;
use grashof::results::scene::LinkKind;
use grashof::studies::common::outcome::Outcome;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

mod axes;

const ALL: [Coordinates; 3] = [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian];

/// A column of an outcome.
fn column(text: &str, name: &str, study: &str, outcome: &Outcome) -> Vec<f64> {
    let c = columns(text, study).iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name}"));
    outcome.rows.iter().map(|r| r[c]).collect()
}

/// Compares a column with a function of another one.
#[track_caller]
fn follows(text: &str, outcome: &Outcome, name: &str, of: &str, tolerance: f64, right: impl Fn(f64) -> f64) {
    let right: Vec<f64> = column(text, of, "move", outcome).into_iter().map(right).collect();
    close(name, &column(text, name, "move", outcome), &right, tolerance);
}

fn reference(name: &str) -> Value {
    let path = format!("{}/tests/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A decimal string or a number.
fn number(value: &Value) -> f64 {
    value.as_f64().or_else(|| value.as_str()?.parse().ok()).unwrap_or_else(|| panic!("{value} is no number"))
}

/// The column of a study with a row at each reference time, and the reference.
#[track_caller]
fn agrees(text: &str, outcome: &Outcome, file: &Value, name: &str, right: impl Fn(&Value) -> f64, tolerance: f64) {
    let (t, x) = (column(text, "time", "move", outcome), column(text, name, "move", outcome));
    let mut compared = 0;
    let size = file["outputs"].as_array().unwrap().iter().map(|o| right(o).abs()).fold(1.0, f64::max);
    for output in file["outputs"].as_array().unwrap() {
        let at = number(&output["t"]);
        // rounded in the file
        let Some(row) = t.iter().position(|t| (t - at).abs() < 1e-5) else { continue };
        let off = (x[row] - right(output)).abs();
        assert!(off <= tolerance * size, "{name} at {at}: found {:e}, right is {:e}", x[row], right(output));
        compared += 1;
    }
    assert!(compared > 3, "{name}: {compared} rows compared");
}

fn spatial(body: &str) -> String {
    format!("grashof: 1\nname: closed-form\nspace: spatial\ngravity: none\n{body}")
}

#[test]
fn a_universal_joint_turns_so_that_tan_out_is_cos_beta_tan_in() {
    // two shafts that meet at the origin, the second at β to the first; the output's angle from the normal of both shafts
    let beta = 0.5_f64;
    let (s, c) = beta.sin_cos();
    let text = spatial(&format!(
        "bodies:\n  input: {{ mass: 1, inertia: 0.1 }}\n  output: {{ mass: 1, inertia: 0.2 }}\n\
         joints:\n  I: {{ revolute: [ground, input.origin], axis: [1, 0, 0] }}\n\
         \x20 X: {{ universal: [input.origin, output.origin], axes: [[0, 1, 0], [{}, 0, {c}]] }}\n\
         \x20 O: {{ revolute: [ground, output.origin], axis: [{c}, 0, {s}] }}\n\
         drivers:\n  drive: {{ joint: I, speed: 2 rad/s }}\n\
         studies:\n  move: {{ inverse: {{ over: 1 turn, samples: 36 }}, columns: [I.angle, O.angle, O.omega, O.alpha, drive, X.angle1, X.angle2] }}\n",
        -s
    ));
    for coordinates in ALL {
        let o = study(&text, "move", coordinates);
        // the input's cross pin, y, stands normal to both shafts at 0: tan(out) = cos β tan(in)
        follows(&text, &o, "O.angle", "I.angle", 1e-11, |t| {
            let out = (c * t.sin()).atan2(t.cos());
            out + TAU * ((t - out) / TAU).round()
        });
        let rate = |t: f64| c / (1.0 - (s * t.sin()).powi(2));
        follows(&text, &o, "O.omega", "I.angle", 1e-11, |t| 2.0 * rate(t));
        // torque of a massive output alone: J α ω_out/ω_in
        let alpha = column(&text, "O.alpha", "move", &o);
        let omega = column(&text, "O.omega", "move", &o);
        let right: Vec<f64> = alpha.iter().zip(&omega).map(|(a, w)| 0.2 * a * w / 2.0).collect();
        close("torque", &column(&text, "drive.torque", "move", &o), &right, 1e-10);
    }
}

#[test]
fn a_screw_advances_by_its_pitch_each_turn() {
    let text = spatial(
        "bodies:\n  nut: { mass: 3, inertia: 0.4 }\n\
         joints:\n  S: { screw: [ground, nut.origin], axis: [1, 2, 2], pitch: 6 mm }\n\
         drivers:\n  drive: { joint: S, angle: 3*(t/(1 s))^2 }\n\
         loads:\n  push: { at: nut.origin, force: [10 N, 20 N, 20 N] }\n\
         studies:\n  move: { inverse: { over: 4 s, samples: 20 }, columns: [S.angle, nut.origin, nut.wx, drive] }\n",
    );
    for coordinates in ALL {
        let o = study(&text, "move", coordinates);
        let lead = 0.006 / TAU;
        follows(&text, &o, "nut.origin.x", "S.angle", 1e-12, |a| lead * a / 3.0);
        follows(&text, &o, "nut.origin.z", "S.angle", 1e-12, |a| lead * a * 2.0 / 3.0);
        // torque: (J + m lead²) α − F lead
        follows(&text, &o, "drive.torque", "S.angle", 1e-11, |_| (0.4 + 3.0 * lead * lead) * 6.0 - 30.0 * lead);
    }
}

#[test]
fn rises_end_at_rest_without_acceleration() {
    for law in ["cycloidal", "poly5"] {
        let text = format!(
            "grashof: 1\nname: rise\nspace: planar\ngravity: none\nbodies:\n  arm: {{ bar: {{ length: 1, mass: 3 }} }}\n\
             joints:\n  O: {{ revolute: [ground, arm.start] }}\n\
             drivers:\n  drive: {{ joint: O, rise: {{ by: 30 deg, during: 0.2 s, law: {law} }} }}\nstart: {{ O.angle: 10 deg }}\n\
             studies:\n  move: {{ inverse: {{ over: 0.3 s, samples: 30 }}, columns: [time, O.angle, O.omega, O.alpha, drive] }}\n"
        );
        let by = PI / 6.0;
        let o = study(&text, "move", Coordinates::Joint);
        let tau = |t: f64| (t / 0.2).clamp(0.0, 1.0);
        let cycloidal = law == "cycloidal";
        let angle = |t: f64| {
            let x = tau(t);
            by * if cycloidal { x - (TAU * x).sin() / TAU } else { x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x) } + PI / 18.0
        };
        let omega = |t: f64| {
            let x = tau(t);
            by / 0.2 * if cycloidal { 1.0 - (TAU * x).cos() } else { 30.0 * x * x * (1.0 - x).powi(2) }
        };
        let alpha = |t: f64| {
            let x = tau(t);
            by / 0.04 * if cycloidal { TAU * (TAU * x).sin() } else { 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) }
        };
        follows(&text, &o, "O.angle", "time", 1e-13, angle);
        follows(&text, &o, "O.omega", "time", 1e-12, omega);
        follows(&text, &o, "O.alpha", "time", 1e-12, alpha);
        follows(&text, &o, "drive.torque", "time", 1e-12, alpha);
        let last = o.rows.last().unwrap();
        close("end", &last[1..4], &[4.0 * PI / 18.0, 0.0, 0.0], 1e-13);
    }
}

#[test]
fn gears_turn_and_racks_slide_in_their_ratio_from_the_start() {
    let text = "grashof: 1\nname: train\nspace: planar\ngravity: none\nground: { P: [0.3, 0], Q: [1, 0] }\n\
         bodies:\n  one: { mass: 1, inertia: 0.1 }\n  two: { mass: 1, inertia: 0.3 }\n  bar: { mass: 4, inertia: 1 }\n\
         joints:\n  A: { revolute: [ground, one.origin] }\n  B: { revolute: [two.origin, ground.P] }\n  C: { slider: [ground.Q, bar.origin], axis: [0, 1] }\n\
         couplings:\n  mesh: { gear: [A, B], ratio: -2.5 }\n  rack: { rack: [B, C], radius: 0.2 }\n\
         drivers:\n  drive: { joint: A, angle: 0.4 + (t/(1 s))^2 }\n\
         start: { B.angle: 1, C.position: 0.3 }\n\
         studies:\n  move: { inverse: { over: 2 s, samples: 20 }, columns: [A.angle, B.angle, C.position, C.acceleration, two.angle, drive, A, B, C] }\n";
    for coordinates in ALL {
        let o = study(text, "move", coordinates);
        follows(text, &o, "B.angle", "A.angle", 1e-12, |a| 1.0 - 2.5 * (a - 0.4));
        follows(text, &o, "C.position", "A.angle", 1e-12, |a| 0.3 - 0.5 * (a - 0.4));
        // B turns the ground against the second wheel
        follows(text, &o, "two.angle", "A.angle", 1e-12, |a| 2.5 * (a - 0.4) - 1.0);
        follows(text, &o, "drive.torque", "A.angle", 1e-12, |_| 2.0 * (0.1 + 0.3 * 6.25 + 4.0 * 0.25));
    }
}

/// A linkage of bars with revolute joints from a reference file, driven at its crank, with rows at the reference times.
fn linkage(file: &Value, guesses: &str, over: &str, samples: usize) -> String {
    let vector = |v: &Value| format!("[{}, {}]", number(&v[0]), number(&v[1]));
    let points = |v: &Value| v.as_object().unwrap().iter().map(|(n, p)| format!("{n}: {}", vector(p))).collect::<Vec<_>>().join(", ");
    let name = |n: &str| if n == "ground" { n.to_string() } else { format!("body_{n}") };
    let mut text = format!(
        "grashof: 1\nname: linkage\nspace: planar\ngravity: {}\nground: {{ {} }}\nbodies:\n",
        vector(&file["gravity"]),
        points(&file["ground_points"])
    );
    for (n, b) in file["bodies"].as_object().unwrap() {
        writeln!(
            text,
            "  {}: {{ mass: {}, inertia: {}, com: {}, points: {{ {} }} }}",
            name(n),
            number(&b["mass"]),
            number(&b["inertia_com"]),
            vector(&b["com"]),
            points(&b["points"])
        )
        .unwrap();
    }
    text.push_str("joints:\n");
    let crank = file["crank"].as_str().unwrap();
    let mut drive = String::new();
    let mut shown = Vec::new();
    for (i, j) in file["joints"].as_array().unwrap().iter().enumerate() {
        let [point, a, b] = [0, 1, 2].map(|k| j[k].as_str().unwrap());
        let (a, b) = if b == "ground" { (b, a) } else { (a, b) };
        writeln!(text, "  J{i}: {{ revolute: [{}.{point}, {}.{point}] }}", name(a), name(b)).unwrap();
        if a == "ground" && b == crank {
            drive = format!("J{i}");
        }
        shown.push(format!("J{i}"));
    }
    for (n, b) in file["bodies"].as_object().unwrap() {
        shown.extend(b["points"].as_object().unwrap().keys().map(|p| format!("{}.{p}", name(n))));
    }
    write!(
        text,
        "drivers:\n  drive: {{ joint: {drive}, speed: {} rad/s }}\nstart: {{ {drive}.angle: {}, {guesses} }}\n\
         studies:\n  move: {{ inverse: {{ over: {over}, samples: {samples} }}, columns: [time, drive, {}] }}\n",
        number(&file["crank_rate"]),
        number(&file["crank_angle0"]),
        shown.join(", ")
    )
    .unwrap();
    text
}

/// Guesses of the angles of a linkage's bodies, from the reference positions of their points at the start.
fn guesses(file: &Value) -> String {
    let at = &file["outputs"][0];
    let place = |p: &str| if file["ground_points"][p].is_array() { &file["ground_points"][p] } else { &at[p] };
    let mut out = Vec::new();
    for (n, b) in file["bodies"].as_object().unwrap() {
        let names: Vec<&String> = b["points"].as_object().unwrap().keys().collect();
        let (p, q) = (place(names[0]), place(names[1]));
        if !p.is_array() || !q.is_array() || n == file["crank"].as_str().unwrap() {
            continue;
        }
        let angle = (number(&q[1]) - number(&p[1])).atan2(number(&q[0]) - number(&p[0]));
        out.push(format!("body_{n}.angle: ~{angle:.2}"));
    }
    out.join(", ")
}

/// Every point and the torque of a linkage at the reference times.
fn check_linkage(name: &str, over: &str, samples: usize, extra: &str) -> (String, Outcome) {
    let file = reference(name);
    let guessed = [guesses(&file), extra.to_string()].into_iter().filter(|x| !x.is_empty()).collect::<Vec<_>>().join(", ");
    let text = linkage(&file, &guessed, over, samples);
    let mut last = None;
    for coordinates in ALL {
        let o = study(&text, "move", coordinates);
        let turn = |x: &Value| number(x);
        agrees(&text, &o, &file, "drive.torque", |r| turn(&r["torque"]), 1e-10);
        for (n, b) in file["bodies"].as_object().unwrap() {
            for p in b["points"].as_object().unwrap().keys() {
                if file["outputs"][0][p].is_array() {
                    agrees(&text, &o, &file, &format!("body_{n}.{p}.x"), |r| number(&r[p][0]), 1e-11);
                    agrees(&text, &o, &file, &format!("body_{n}.{p}.y"), |r| number(&r[p][1]), 1e-11);
                }
            }
        }
        last = Some(o);
    }
    (text, last.unwrap())
}

#[test]
fn peaucelliers_inversor_draws_a_straight_line() {
    // B is the mirror image of A about the line from O to P
    let a = &reference("peaucellier")["outputs"][0]["A"];
    let [ax, ay] = [number(&a[0]), number(&a[1])];
    let turned = -1.0 - ay.atan2(ax);
    let (bx, by) = (turned.cos(), turned.sin());
    let toward = |x: f64, y: f64| (y - by).atan2(x - bx);
    let (c, p) = ([0.375 + 0.375 * 1.0_f64.cos(), -0.375 * 1.0_f64.sin()], [1.0, -0.5_f64.tan()]);
    let extra = format!("body_OB.angle: ~{turned}, body_BC.angle: ~{}, body_BP.angle: ~{}", toward(c[0], c[1]), toward(p[0], p[1]));
    let (text, o) = check_linkage("peaucellier", "2 s", 40, &extra);
    let x = column(&text, "body_AP.P.x", "move", &o);
    close("x of P", &x, &vec![1.0; x.len()], 1e-12);
    let t = column(&text, "time", "move", &o);
    let right: Vec<f64> = t.iter().map(|t| (0.5 * (t - 1.0)).tan()).collect();
    close("y of P", &column(&text, "body_AP.P.y", "move", &o), &right, 1e-12);
}

#[test]
fn chebyshevs_lambda_linkage_walks_nearly_straight() {
    let (text, o) = check_linkage("chebyshev_lambda", "1 turn", 8, "");
    for (row, x) in [(2, 4.0), (4, 2.0), (6, 0.0)] {
        close(
            "P",
            &[column(&text, "body_coupler.P.x", "move", &o)[row], column(&text, "body_coupler.P.y", "move", &o)[row]],
            &[x, 4.0],
            1e-12,
        );
    }
}

#[test]
fn theo_jansens_leg_takes_a_step() {
    let (text, o) = check_linkage("theo_jansen", "1 turn", 8, "");
    let foot = ["x", "y"].map(|c| column(&text, &format!("body_foot.S.{c}"), "move", &o));
    for c in foot {
        close("the path of the foot closes", &[c[8]], &[c[0]], 1e-12);
    }
}

#[test]
fn a_slider_crank_is_that_of_the_books() {
    let file = reference("slider_crank");
    let text = "grashof: 1\nname: slider-crank\nspace: planar\ngravity: none\n\
         bodies:\n  crank: { bar: { length: 0.1, mass: 0.2 } }\n  rod: { bar: { length: 0.3, mass: 0.5 } }\n  piston: { mass: 1, inertia: 0 }\n\
         joints:\n  O: { revolute: [ground, crank.start] }\n  A: { revolute: [crank.end, rod.start] }\n  B: { revolute: [rod.end, piston.origin] }\n  W: { slider: [ground, piston.origin] }\n\
         drivers: { drive: { joint: O, speed: 10 rad/s } }\nstart: { O.angle: 0, rod.angle: ~0.0, W.position: ~0.4 }\n\
         studies:\n  move: { inverse: { over: 1 turn, samples: 12 }, columns: [time, piston.x, piston.vx, piston.ax, B, W, drive] }\n";
    for coordinates in ALL {
        let o = study(text, "move", coordinates);
        for (name, key) in [
            ("piston.x", "x"),
            ("piston.vx", "xd"),
            ("piston.ax", "xdd"),
            ("drive.torque", "torque"),
            ("B.fx", "rod_on_slider_x"),
            ("W.fy", "guide_on_slider_y"),
        ] {
            agrees(text, &o, &file, name, |r| number(&r[key]), 1e-12);
        }
    }
}

#[test]
fn whitworths_quick_return_is_that_of_the_books() {
    let file = reference("whitworth");
    let text = "grashof: 1\nname: whitworth\nspace: planar\ngravity: none\nground: { Q: [0, -0.2] }\n\
         bodies:\n  crank: { bar: { length: 0.1, mass: 0.5 } }\n  lever: { bar: { length: 0.5, mass: 2 } }\n\
         joints:\n  O: { revolute: [ground, crank.start] }\n  Q: { revolute: [ground.Q, lever.start] }\n  A: { pin-in-slot: [lever.start, crank.end], axis: [1, 0] }\n\
         drivers: { drive: { joint: O, speed: 1 turn/s } }\nstart: { O.angle: 0, Q.angle: ~1.1 }\n\
         measures: { normal: A.fx*sin(lever.angle) - A.fy*cos(lever.angle) }\n\
         studies:\n  move: { inverse: { over: 1 turn, samples: 12 }, columns: [time, lever.angle, lever.omega, drive, normal] }\n";
    for coordinates in ALL {
        let o = study(text, "move", coordinates);
        agrees(text, &o, &file, "lever.angle", |r| number(&r["lever_angle"]), 1e-12);
        agrees(text, &o, &file, "lever.omega", |r| number(&r["lever_rate"]), 1e-12);
        agrees(text, &o, &file, "drive.torque", |r| number(&r["torque"]), 1e-12);
        agrees(text, &o, &file, "normal", |r| number(&r["pin_force"]), 1e-12);
    }
}

#[test]
fn an_ackermann_trapezoid_steers() {
    let file = reference("ackermann");
    let arm = number(&file["parameters"]["arm_angle"]);
    let (x, y) = (-0.15 * arm.cos(), 0.15 * arm.sin());
    let text = format!(
        "grashof: 1\nname: ackermann\nspace: planar\ngravity: none\nground: {{ L: [0, 0.7], R: [0, -0.7] }}\n\
         bodies:\n  left: {{ points: {{ e: [{x}, {}] }} }}\n  right: {{ points: {{ e: [{x}, {y}] }} }}\n\
         joints:\n  L: {{ revolute: [ground.L, left.origin] }}\n  R: {{ revolute: [ground.R, right.origin] }}\n  rod: {{ distance: [left.e, right.e], length: {} }}\n\
         drivers: {{ drive: {{ joint: L, speed: 5 deg/s }} }}\nstart: {{ L.angle: 0, R.angle: ~0.0, left.y: ~0.7 m, right.y: ~-0.7 m }}\n\
         studies:\n  move: {{ kinematics: {{ over: 35 deg, samples: 7 }}, columns: [L.angle, R.angle] }}\n",
        -y,
        number(&file["parameters"]["tie_rod"])
    );
    for coordinates in ALL {
        let o = study(&text, "move", coordinates);
        let right: Vec<f64> = file["outputs"].as_array().unwrap().iter().map(|r| number(&r["outer_deg"]).to_radians()).collect();
        let found = column(&text, "R.angle", "move", &o);
        close("outer", &found, &right[..found.len()], 1e-13);
    }
}

#[test]
fn a_scissor_lift_needs_n_w_cot_a() {
    let file = reference("scissor_lift");
    let mut bodies = String::from("  foot: {}\n  platform: {}\n  roller: {}\n");
    let mut joints = String::from(
        "  way: { slider: [ground, foot.origin] }\n  J0: { revolute: [ground, r1.start] }\n  F: { revolute: [foot.origin, l1.start] }\n",
    );
    let mut start = String::from("way.position: 0.95 m");
    for i in 1..=3 {
        write!(bodies, "  r{i}: {{ bar: {{ length: 1 }}, points: {{ mid: [0.5, 0] }} }}\n  l{i}: {{ bar: {{ length: 1 }}, points: {{ mid: [0.5, 0] }} }}\n").unwrap();
        writeln!(joints, "  M{i}: {{ revolute: [r{i}.mid, l{i}.mid] }}").unwrap();
        write!(start, ", r{i}.angle: ~0.3, l{i}.angle: ~2.84").unwrap();
        if i < 3 {
            // the right bar ends on the right, where the next left-going bar begins
            write!(joints, "  E{i}: {{ revolute: [r{i}.end, l{}.start] }}\n  G{i}: {{ revolute: [l{i}.end, r{}.start] }}\n", i + 1, i + 1)
                .unwrap();
        }
    }
    joints.push_str("  T: { revolute: [l3.end, platform.origin] }\n  rail: { slider: [platform.origin, roller.origin] }\n  U: { revolute: [r3.end, roller.origin] }\n");
    let text = format!(
        "grashof: 1\nname: scissor\nspace: planar\ngravity: none\nbodies:\n{bodies}joints:\n{joints}\
         drivers: {{ drive: {{ joint: way, speed: -0.05 m/s }} }}\nloads: {{ weight: {{ at: platform.origin, force: [0, -1000 N] }} }}\n\
         start: {{ {start} }}\n\
         studies:\n  move: {{ inverse: {{ over: 9 s, samples: 9 }}, columns: [way.position, platform.y, drive] }}\n"
    );
    // the closed form of the file
    for r in file["outputs"].as_array().unwrap() {
        let w = number(&r["base_width"]);
        let a = w.acos();
        close("the reference", &[3.0 * a.sin(), 3000.0 / a.tan()], &[number(&r["height"]), number(&r["actuator_force"])], 1e-13);
    }
    for coordinates in ALL {
        let o = study(&text, "move", coordinates);
        follows(&text, &o, "platform.y", "way.position", 1e-12, |w| 3.0 * w.acos().sin());
        follows(&text, &o, "drive.force", "way.position", 1e-10, |w| -3000.0 / w.acos().tan());
    }
}

#[test]
fn a_sarrus_linkage_lifts_its_plate_straight() {
    let file = reference("sarrus");
    let text = "grashof: 1\nname: sarrus\nspace: spatial\ngravity: [0, 0, -9.81]\nground: { A: [1, 0, 0], B: [0, 1, 0] }\n\
         bodies:\n  a1: { bar: { length: 1, mass: 1 } }\n  a2: { bar: { length: 1, mass: 1 } }\n  b1: { bar: { length: 1, mass: 1 } }\n  b2: { bar: { length: 1, mass: 1 } }\n\
         \x20 plate: { mass: 2, inertia: [0.1, 0.1, 0.1], points: { A: [1, 0, 0], B: [0, 1, 0] } }\n\
         joints:\n  A1: { revolute: [ground.A, a1.start], axis: [0, -1, 0] }\n  A2: { revolute: [a1.end, a2.start], axis: [0, -1, 0] }\n  A3: { revolute: [plate.A, a2.end], axis: [0, -1, 0] }\n\
         \x20 B1: { revolute: [ground.B, b1.start], axis: [1, 0, 0], to: [0, -1, 0] }\n  B2: { revolute: [b1.end, b2.start], axis: [0, -1, 0] }\n  B3: { revolute: [plate.B, b2.end], axis: [1, 0, 0], to: [0, -1, 0] }\n\
         drivers: { drive: { joint: A1, angle: 1.0471975511965976 - 0.3*(t/(1 s)) } }\n\
         start: { A2.angle: ~60 deg, A3.angle: ~2.09, B1.angle: ~60 deg, B2.angle: ~60 deg, B3.angle: ~2.09, plate.z: ~1.7 m }\n\
         studies:\n  move: { inverse: { over: 2 s, samples: 20 }, columns: [time, A1.angle, A1.omega, plate.origin, plate.vz, plate.wx, plate.wy, plate.wz, drive, energy] }\n";
    for cut in ["none", "A2", "B1", "B3"] {
        let text = &text.replace(&format!("  {cut}: {{ revolute"), &format!("  {cut}: {{ cut: true, revolute"));
        let o = study(text, "move", Coordinates::Joint);
        follows(text, &o, "plate.origin.x", "time", 1e-10, |_| 0.0);
        follows(text, &o, "plate.origin.y", "time", 1e-10, |_| 0.0);
        follows(text, &o, "plate.origin.z", "A1.angle", 1e-10, |a| 2.0 * a.sin());
        for spin in ["plate.wx", "plate.wy", "plate.wz"] {
            follows(text, &o, spin, "time", 1e-10, |_| 0.0);
        }
        // T = ½ M(a) ȧ² and the torque M a'' + ½ M' ȧ² + V' of the file's closed form
        let m = |a: f64| 2.0 / 3.0 + 2.0 * (0.25 * a.sin().powi(2) + 2.25 * a.cos().powi(2) + 1.0 / 12.0) + 8.0 * a.cos().powi(2);
        follows(text, &o, "energy.kinetic", "A1.angle", 1e-10, |a| 0.5 * m(a) * 0.09);
        let slope = |a: f64| 2.0 * (0.5 - 4.5) * a.sin() * a.cos() - 16.0 * a.sin() * a.cos();
        follows(text, &o, "drive.torque", "A1.angle", 1e-9, |a| 0.5 * slope(a) * 0.09 + 9.81 * 8.0 * a.cos());
        // heights of the reference at its angles
        for r in file["outputs"].as_array().unwrap() {
            close("height", &[2.0 * number(&r["angle"]).sin()], &[number(&r["height"])], 1e-14);
        }
    }
}

#[test]
fn a_bennett_linkage_moves_though_it_should_not() {
    let file = reference("bennett");
    let (sa, ca) = (PI / 6.0).sin_cos();
    let b = 2.0_f64.sqrt();
    let half = 0.5 * b;
    // chain Rz(θ1) Tx(1) Rx(30°) Rz(θ2) Tx(√2) Rx(45°) Rz(θ3) Tx(1) Rx(30°) Rz(θ4) from joint 1; links begin at their joints, x along
    let text = format!(
        "grashof: 1\nname: bennett\nspace: spatial\ngravity: none\nground: {{ P: [{half}, 0, 0], Q: [-{half}, 0, 0] }}\n\
         bodies:\n  one: {{ bar: {{ length: 1, mass: 1, width: 0.05, height: 0.05 }} }}\n  two: {{ bar: {{ length: {b}, mass: {b}, width: 0.05, height: 0.05 }} }}\n  three: {{ bar: {{ length: 1, mass: 1, width: 0.05, height: 0.05 }} }}\n\
         joints:\n  A: {{ revolute: [ground.P, one.start], axis: [0, -{h}, {h}], to: [0, 0, 1] }}\n\
         \x20 B: {{ revolute: [one.end, two.start], axis: [0, -{sa}, {ca}], to: [0, 0, 1] }}\n\
         \x20 C: {{ revolute: [two.end, three.start], axis: [0, -{h}, {h}], to: [0, 0, 1] }}\n\
         \x20 D: {{ revolute: [three.end, ground.Q], axis: [0, -{sa}, {ca}], to: [0, 0, 1] }}\n\
         drivers: {{ drive: {{ joint: A, speed: 1 rad/s }} }}\n\
         start: {{ A.angle: 60 deg, B.angle: ~2.89, C.angle: ~-60 deg, D.angle: ~-2.89 }}\n\
         studies:\n  move: {{ inverse: {{ over: 1.6 s, samples: 32 }}, columns: [time, A.angle, B.angle, C.angle, D.angle, two.com, energy] }}\n",
        h = 0.5_f64.sqrt(),
    );
    let k = 4.663_902_460_147_014;
    // one joint after another cut: cartesian coordinates would need guesses of all bodies
    for cut in ["none", "B", "C", "D"] {
        let text = text.replace(&format!("  {cut}: {{ revolute"), &format!("  {cut}: {{ cut: true, revolute"));
        let o = study(&text, "move", Coordinates::Joint);
        follows(&text, &o, "B.angle", "A.angle", 1e-10, |a| 2.0 * (k / (0.5 * a).tan()).atan());
        follows(&text, &o, "C.angle", "A.angle", 1e-10, |a| -a);
        follows(&text, &o, "D.angle", "A.angle", 1e-10, |a| -2.0 * (k / (0.5 * a).tan()).atan());
        close(
            "kinetic energy at the start",
            &[column(&text, "energy.kinetic", "move", &o)[0]],
            &[number(&file["facts"]["kinetic_energy"])],
            1e-10,
        );
    }
}

/// A massless link is drawn like a bar between two pins.
#[test]
fn links_of_fixed_distance_are_drawn() {
    let text = "grashof: 1
name: swing
space: planar
gravity: [0, -9.81 m/s^2]
ground: { A: [0, 1 m], B: [1 m, 1 m] }
bodies: { seat: { bar: { length: 1 m, mass: 1 kg } } }
joints:
  L: { distance: [ground.A, seat.start], length: 0.5 m }
  R: { distance: [ground.B, seat.end], length: 0.5 m }
start: { seat.angle: ~0 deg, seat.x: ~0.4 m, seat.y: ~0.6 m }
studies: { s: { dynamics: { until: 0.1 s, every: 0.1 s }, columns: [time] } }
";
    let outcome = common::study(text, "s", Coordinates::Joint);
    let (_, scene) = &outcome.scenes[0];
    for name in ["L", "R"] {
        let link = scene.links.iter().find(|link| link.name == name && link.kind == LinkKind::Rod).expect("the link");
        for index in 0..scene.frames.count() {
            let [a, b] = [&link.a, &link.b].map(|end| scene.world(scene.frame(index), end));
            assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 0.5).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
    assert!(scene.joints.is_empty());
}
