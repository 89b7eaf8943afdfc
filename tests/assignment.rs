//! The crank-rocker by the program, against the reference values and against the closed form for other parameters.

mod parameters;

use crate::closed_form::crank_rocker::{COLUMNS, CrankRocker, Load, Parameters};
use crate::reference;
use crate::reference::program::{Run, Table, model, run, run_text};
use crate::reference::{Verdict, number, turning};
use parameters::{load_beside, switched};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, TAU};

const SAMPLES: usize = 3600;

fn crank_rocker(arguments: &[&str]) -> Run {
    run(&model("crank_rocker.yaml"), &[&["--no-plots"], arguments].concat())
}

/// Rows and side of the switches in a table that starts with theta.
fn switches(table: &Table) -> Vec<usize> {
    table.sides().iter().enumerate().filter(|(_, side)| **side < 0).map(|(i, _)| i).collect()
}

#[test]
fn every_column_at_whole_degrees() {
    let file = reference::read();
    let run = crank_rocker(&["--study", "one-turn", "--study", "one-turn-unloaded"]).succeeded();
    for (study, loaded) in [("one-turn", true), ("one-turn-unloaded", false)] {
        let table = run.table(study);
        assert_eq!(table.names, COLUMNS, "{study}: columns");
        let rows = table.on_grid(0.0, TAU / SAMPLES as f64, SAMPLES);
        let mut verdict = Verdict::default();
        for series in reference::crank_rocker(&file, loaded) {
            let column = table.index(series.name);
            for (degree, right) in series.values.iter().enumerate() {
                let found = table.rows[rows[10 * degree]][column];
                verdict.close(series.name, format_args!("{degree} deg"), found, *right, series.tolerance);
            }
        }
        verdict.give(study);
    }
}

#[test]
fn switches_stand_in_two_rows() {
    let file = reference::read();
    let run = crank_rocker(&["--study", "one-turn", "--study", "one-turn-unloaded"]).succeeded();
    let unloaded = run.table("one-turn-unloaded");
    assert_eq!(unloaded.rows.len(), SAMPLES + 1);
    let table = run.table("one-turn");
    assert_eq!(table.rows.len(), SAMPLES + 1 + 8);
    let places = switches(&table);
    let theta: Vec<f64> = places.iter().map(|i| table.rows[*i][0]).collect();
    assert_eq!(theta.len(), 4, "{theta:?}");
    let mut verdict = Verdict::default();
    let right = CrankRocker::new(Parameters::default()).switches(0.0);
    for (found, right) in theta.iter().zip(&right) {
        verdict.close("switch", right, *found, *right, 1e-9);
    }
    verdict.close("start of the load", "", theta[1], number(&file, "load_zone/theta_c_rad"), 1e-9);
    verdict.close("end of the load", "", theta[2], number(&file, "load_zone/theta_e_rad"), 1e-9);
    let columns = ["Ox", "Oy", "Ax", "Ay", "Bx", "By", "Gx", "Gy", "MO"];
    let names = ["O.fx", "O.fy", "A.fx", "A.fy", "B.fx", "B.fy", "C.fx", "C.fy", "drive.torque"];
    for (name, column) in names.iter().zip(columns) {
        for side in 0..2 {
            let right = number(&file, &format!("reactions/with_load/at_theta_e_before_and_after/{column}/{side}"));
            let found = table.rows[places[2] + side][table.index(name)];
            verdict.close(name, if side == 0 { "before" } else { "after" }, found, right, 2e-6);
        }
    }
    let load = table.index("tip_force");
    verdict.close("tip_force", "before its end", table.rows[places[2]][load], 3000.0, 1e-5);
    verdict.close("tip_force", "after its end", table.rows[places[2] + 1][load], 0.0, 0.0);
    // the torque ends continuously
    let torque = table.index("drive.torque");
    verdict.close("torque", "its end", table.rows[places[2]][torque], table.rows[places[2] + 1][torque], 1e-5);
    // what does not depend on forces is the same on both sides
    for i in places {
        for name in &COLUMNS[..21] {
            let k = table.index(name);
            verdict.close(name, "both sides", table.rows[i][k], table.rows[i + 1][k], 1e-12 * table.rows[i][k].abs().max(1.0));
        }
    }
    verdict.give("switches");
}

#[test]
fn extrema_and_their_angles() {
    let file = reference::read();
    let run = crank_rocker(&["--study", "one-turn", "--study", "one-turn-unloaded"]).succeeded();
    for (study, loaded) in [("one-turn", true), ("one-turn-unloaded", false)] {
        let json = run.json(study);
        let p = Parameters { load_max: if loaded { 3000.0 } else { 0.0 }, ..Parameters::default() };
        let rocker = CrankRocker::new(p);
        let mut verdict = Verdict::default();
        for right in reference::extrema(&file, loaded) {
            let found = &json["extrema"][right.column][right.which];
            let (value, at) = (found["value"].as_f64().unwrap_or(f64::NAN), found["at"].as_f64().unwrap_or(f64::NAN));
            let name = format!("{} {}", right.which, right.column);
            verdict.close(&name, "its place", value, right.value, right.tolerance);
            // an extremum may be taken at several angles
            let column = COLUMNS.iter().position(|c| *c == right.column).unwrap();
            let here = rocker.row(at, Load::ByState)[column];
            if (here - right.value).abs() > right.tolerance || (at - right.at).abs() < 0.1 {
                verdict.close(&format!("angle of {name}"), "", at, right.at, 1e-6);
            }
        }
        verdict.give(study);
    }
}

#[test]
fn work_and_power() {
    let file = reference::read();
    let run = crank_rocker(&["--study", "one-turn", "--study", "one-turn-unloaded"]).succeeded();
    let mut verdict = Verdict::default();
    for (study, case) in [("one-turn", "with_load"), ("one-turn-unloaded", "without_load")] {
        let scalars = run.json(study)["scalars"].clone();
        for (name, key) in [("work_per_turn", "work_per_turn_J"), ("mean_torque", "mean_torque_Nm"), ("mean_power", "mean_power_W")] {
            let right = number(&file, &format!("power/{case}/values/{key}"));
            verdict.close(name, study, scalars[name].as_f64().unwrap_or(f64::NAN), right, 1e-7);
        }
    }
    verdict.give("work and power");
}

#[test]
fn shaking_force_both_ways() {
    let run = crank_rocker(&["--study", "one-turn", "--study", "one-turn-unloaded"]).succeeded();
    for study in ["one-turn", "one-turn-unloaded"] {
        let table = run.table(study);
        let at = |name: &str| table.column(name);
        let (fx, fy, size) = (at("shaking.fx"), at("shaking.fy"), at("shaking.f"));
        let (frame_x, frame_y) = (at("frame.fx"), at("frame.fy"));
        let (ox, oy, cx, cy) = (at("O.fx"), at("O.fy"), at("C.fx"), at("C.fy"));
        let (ax, ay) = (at("com.ax"), at("com.ay"));
        let (phi3, load) = (at("phi3"), at("tip_force"));
        let weight = 240.0 * 9.81;
        let mut verdict = Verdict::default();
        for i in 0..table.rows.len() {
            // round-off of forces up to 35 kN
            verdict.close("shaking x", i, fx[i], -frame_x[i] + load[i] * phi3[i].cos(), 1e-9);
            verdict.close("shaking y", i, fy[i], -frame_y[i] - weight - load[i] * phi3[i].sin(), 1e-9);
            verdict.close("m a, x", i, fx[i], 240.0 * ax[i], 1e-9);
            verdict.close("m a, y", i, fy[i], 240.0 * ay[i], 1e-9);
            verdict.close("frame x", i, frame_x[i], -(ox[i] + cx[i]), 1e-9);
            verdict.close("frame y", i, frame_y[i], -(oy[i] + cy[i]), 1e-9);
            verdict.close("size", i, size[i], fx[i].hypot(fy[i]), 1e-9);
        }
        verdict.give(study);
    }
}

#[test]
fn counterweights() {
    let file = reference::read();
    let run = crank_rocker(&["--study", "balanced"]).succeeded();
    let json = run.json("balanced");
    let scalar = |name: &str| json["scalars"][name].as_f64().unwrap_or(f64::NAN);
    let mut verdict = Verdict::default();
    verdict.close("kappa", "", scalar("kappa"), number(&file, "balance/values/l_kappa_for_100kg"), 1e-12);
    verdict.close("lambda", "", scalar("lambda"), number(&file, "balance/values/l_lambda_for_100kg"), 1e-12);
    verdict.close("com_x", "", scalar("com_x"), number(&file, "balance/values/fixed_com_x"), 1e-12);
    verdict.close("com_y", "", scalar("com_y"), 0.0, 1e-12);
    let table = run.table("balanced");
    assert_eq!(table.names[..4], ["theta", "time", "com.x", "com.y"]);
    for (i, (x, y)) in table.column("com.x").into_iter().zip(table.column("com.y")).enumerate() {
        verdict.close("com.x", i, x, 280.0 / 440.0, 1e-12);
        verdict.close("com.y", i, y, 0.0, 1e-12);
    }
    for (i, force) in table.column("shaking.f").into_iter().enumerate() {
        verdict.close("shaking.f", i, force, 0.0, 1e-8);
    }
    verdict.give("balanced");

    // other masses and lengths
    let run = crank_rocker(&["--study", "balanced", "--set", "l1=0.2", "--set", "l_tip=0.3", "--set", "m2=40", "--set", "m3=25 kg"]);
    // the figures that the file expects are those of its own parameters
    assert!(run.code <= 1, "exit code {}\n{}", run.code, run.stderr);
    let p = Parameters { l1: 0.2, l_tip: 0.3, m2: 40.0, m3: 25.0, ..Parameters::default() };
    let ([kappa, lambda], centre) = CrankRocker::new(p).balance(100.0, 100.0);
    let json = run.json("balanced");
    let scalar = |name: &str| json["scalars"][name].as_f64().unwrap_or(f64::NAN);
    let mut verdict = Verdict::default();
    for (name, right) in [("kappa", kappa), ("lambda", lambda), ("com_x", centre[0]), ("com_y", centre[1])] {
        verdict.close(name, "", scalar(name), right, 1e-11);
    }
    verdict.give("other masses");
}

/// One curve of the study `lengths` against the circles.
fn curve(verdict: &mut Verdict, table: &Table, p: Parameters, reach: [f64; 2]) {
    let rocker = CrankRocker::new(p);
    assert_eq!(table.names, ["theta", "phi2", "phi3"]);
    let mut last: Option<[f64; 2]> = None;
    for row in &table.rows {
        let theta = row[0];
        let place = format!("{} deg", theta.to_degrees());
        let mut close = |what: &str, found: f64, right: f64, within: f64| {
            // unwrapped: the start decides the turn, continuity the others
            let turns = if (theta - FRAC_PI_2).abs() < 1e-9 { 0.0 } else { TAU * ((found - right) / TAU).round() };
            verdict.close(&format!("l3 = {}: {what}", p.l3), &place, found, right + turns, within);
        };
        let middle = 0.5 * (reach[0] + reach[1]);
        if p.l3 == p.l1 && p.l2 == p.l {
            // a parallelogram, smooth through its flat positions
            close("phi2", row[1], 0.0, 1e-10);
            close("phi3", row[2], FRAC_PI_2 - theta, 1e-10);
        } else if (theta - reach[0]).abs().min((theta - reach[1]).abs()) < 1e-9 {
            // at a dead point the angles move with the root of theta
            let m = rocker.motion(middle + (theta - middle) * (1.0 - 1e-13));
            close("phi2 at its end", row[1], m.phi2, 1e-5);
            close("phi3 at its end", row[2], m.phi3, 1e-5);
        } else {
            let m = rocker.motion(theta);
            close("phi2", row[1], m.phi2, 1e-10);
            close("phi3", row[2], m.phi3, 1e-10);
        }
        if let Some(before) = last {
            let jump = (row[1] - before[0]).abs().max((row[2] - before[1]).abs());
            verdict.holds(jump < 0.5, format!("l3 = {}: a jump at {place}", p.l3));
        }
        last = Some([row[1], row[2]]);
    }
}

#[test]
fn other_lengths_of_the_rocker() {
    let run = crank_rocker(&["--study", "lengths"]).succeeded();
    let table = run.table("lengths");
    assert_eq!(table.names, ["l3", "turns_fully", "theta_from", "theta_to", "reason"]);
    let lengths = [0.1, 0.15, 0.16, 0.3, 0.55, 0.8, 1.9];
    assert_eq!(table.rows.len(), lengths.len());
    let mut verdict = Verdict::default();
    for (k, l3) in lengths.into_iter().enumerate() {
        let p = Parameters { l3, ..Parameters::default() };
        let limits = CrankRocker::new(p).reach(FRAC_PI_2);
        let row = &table.rows[k];
        let curves = run.table(&format!("lengths-{:03}", k + 1));
        verdict.close("l3", k, row[0], l3, 1e-15);
        let [from, to] = limits.unwrap_or([FRAC_PI_2, FRAC_PI_2 + TAU]);
        verdict.close("turns_fully", l3, row[1], f64::from(u8::from(limits.is_none())), 0.0);
        verdict.close("theta_from", l3, row[2], from, 1e-9);
        verdict.close("theta_to", l3, row[3], to, 1e-9);
        verdict.holds(table.reasons[k].is_empty() == limits.is_none(), format!("l3 = {l3}: reason `{}`", table.reasons[k]));
        let theta = curves.column("theta");
        verdict.close("first row", l3, theta[0], from, 1e-9);
        verdict.close("last row", l3, *theta.last().unwrap(), to, 1e-9);
        verdict.holds(theta.windows(2).all(|w| w[0] < w[1]), format!("l3 = {l3}: angles rise"));
        // on the grid of whole degrees from 90, and one at each end
        let inner = theta.iter().filter(|t| (*t - from).abs() > 1e-9 && (*t - to).abs() > 1e-9);
        for t in inner {
            verdict.close("grid", l3, t.to_degrees(), t.to_degrees().round(), 1e-9);
        }
        let whole = (to.to_degrees() - 1e-9).floor() - (from.to_degrees() + 1e-9).ceil() + 1.0;
        verdict.close("rows", l3, theta.len() as f64, whole + 2.0, 0.0);
        curve(&mut verdict, &curves, p, [from, to]);
    }
    verdict.give("lengths");
}

/// The model with the rates among the columns of `lengths`.
fn lengths_with_rates() -> String {
    let text = std::fs::read_to_string(model("crank_rocker.yaml")).unwrap();
    let old = "columns: [theta, phi2, phi3]\n";
    assert_eq!(text.matches(old).count(), 1);
    text.replace(old, "columns: [theta, phi2, phi3, omega2, omega3, alpha2, alpha3]\n")
}

#[test]
fn rates_are_empty_at_change_points() {
    let run = run_text(&lengths_with_rates(), &["--no-plots", "--study", "lengths"]).succeeded();
    let mut verdict = Verdict::default();
    let speed = Parameters::default().speed;
    let table = run.table("lengths-002");
    for row in &table.rows {
        let degrees = row[0].to_degrees().round();
        if degrees % 180.0 == 0.0 {
            verdict.holds(row[1].is_finite() && row[2].is_finite(), format!("positions at the change point {degrees}"));
            verdict.holds(row[3..].iter().all(|x| x.is_nan()), format!("rates at the change point {degrees}: {:?}", &row[3..]));
        } else {
            // the parallelogram: the rocker turns with the crank, the coupler not at all
            for (k, right) in [(3, 0.0), (4, -speed), (5, 0.0), (6, 0.0)] {
                verdict.close(&table.names[k], degrees, row[k], right, 1e-7);
            }
        }
    }
    // where the crank turns, the rates are those of the closed form
    let table = run.table("lengths-004");
    let rocker = CrankRocker::new(Parameters { l3: 0.3, ..Parameters::default() });
    for row in &table.rows {
        let m = rocker.motion(row[0]);
        for (k, right) in [(3, m.omega2), (4, m.omega3), (5, m.alpha2), (6, m.alpha3)] {
            verdict.close(&table.names[k], row[0], row[k], right, 1e-8);
        }
    }
    verdict.give("rates");
}

#[test]
fn report_of_a_study() {
    let run = crank_rocker(&["--study", "one-turn"]).succeeded();
    let json = run.json("one-turn");
    assert_eq!(json["study"], "one-turn");
    assert_ne!(json["status"], "failed");
    assert!(json["status"].is_string());
    let p = Parameters::default();
    let phi3_min = CrankRocker::new(p).phi3_min;
    let parameters = [
        ("l1", p.l1),
        ("l2", p.l2),
        ("l3", p.l3),
        ("l_tip", p.l_tip),
        ("l", p.l),
        ("m1", p.m1),
        ("m2", p.m2),
        ("m3", p.m3),
        ("m_tip", p.m_tip),
        ("g_earth", p.g_earth),
        ("speed", p.speed),
        ("load_max", p.load_max),
        ("load_angle", p.load_angle),
        ("phi3_min", phi3_min),
    ];
    for (name, right) in parameters {
        let found = json["parameters"][name].as_f64().unwrap_or(f64::NAN);
        assert!((found - right).abs() <= 1e-14 * right.abs(), "{name}: {found}, right {right}");
    }
    for name in ["mean_torque", "mean_power", "work_per_turn"] {
        assert!(json["scalars"][name].is_number(), "{name}");
    }
    for name in COLUMNS {
        for which in ["min", "max"] {
            for key in ["value", "at"] {
                assert!(json["extrema"][name][which][key].is_number(), "{which} {key} of {name}");
            }
        }
    }
    assert!(json["certificate"].is_object());
    assert!(json["findings"].is_array());
}

#[test]
fn a_number_and_a_quantity_from_outside_are_the_same() {
    let csv = |set: &[&str]| {
        let run = crank_rocker(&[&["--study", "one-turn-unloaded"], set].concat());
        std::fs::read(run.directory.join("one-turn-unloaded.csv")).unwrap()
    };
    assert!(csv(&["--set", "l3=0.6"]) == csv(&["--set", "l3=60 cm"]));
}

#[test]
fn reach_of_other_cranks() {
    // the sweep of l3 stands in the file; other parameters come from outside
    let run = crank_rocker(&["--study", "lengths", "--set", "l1=0.25", "--set", "l=0.92"]).succeeded();
    let table = run.table("lengths");
    let mut verdict = Verdict::default();
    for (k, row) in table.rows.iter().enumerate() {
        let p = Parameters { l1: 0.25, l: 0.92, l3: row[0], ..Parameters::default() };
        let ac = (p.l * p.l + p.l1 * p.l1).sqrt();
        if ac > p.l2 + p.l3 || ac < (p.l2 - p.l3).abs() {
            verdict.holds(!table.reasons[k].is_empty(), format!("l3 = {}: no reason", p.l3));
            continue;
        }
        let limits = CrankRocker::new(p).reach(FRAC_PI_2);
        let [from, to] = limits.unwrap_or([FRAC_PI_2, FRAC_PI_2 + TAU]);
        verdict.close("turns_fully", p.l3, row[1], f64::from(u8::from(limits.is_none())), 0.0);
        verdict.close("theta_from", p.l3, row[2], from, 1e-9);
        verdict.close("theta_to", p.l3, row[3], to, 1e-9);
        curve(&mut verdict, &run.table(&format!("lengths-{:03}", k + 1)), p, [from, to]);
    }
    verdict.give("other cranks");
}

#[test]
fn in_space_the_same() {
    let run = run(&model("four_bar_spatial.yaml"), &["--no-plots"]).succeeded();
    let table = run.table("one-turn");
    table.on_grid(0.0, TAU / SAMPLES as f64, SAMPLES);
    let rocker = CrankRocker::new(Parameters::default());
    let mut verdict = Verdict::default();
    let common: Vec<_> = COLUMNS.iter().enumerate().filter(|(_, name)| table.names.iter().any(|n| n == *name)).collect();
    assert!(common.len() >= 28, "{:?}", table.names);
    for (found, side) in table.rows.iter().zip(table.sides()) {
        let load = if side == 0 { Load::ByState } else { load_beside(&rocker, found[0], side) };
        let right = rocker.row(found[0], load);
        for (k, name) in &common {
            // forces up to 35 kN
            let within = if name.contains(".f") || name.starts_with("drive") { 1e-6 } else { 1e-10 * (1.0 + right[*k].abs()) };
            verdict.close(name, found[0].to_degrees(), found[table.index(name)], right[*k], within);
        }
        // nothing leaves the plane, and hinges about z carry no moment
        for name in table.names.iter().filter(|n| n.ends_with('z') || n.ends_with(".mx") || n.ends_with(".my")) {
            verdict.close(name, found[0].to_degrees(), found[table.index(name)], 0.0, 1e-6);
        }
    }
    switched(&mut verdict, &rocker, &table);
    verdict.give("in space");
}
