//! The quick return by the program, against the reference values and against the closed form for other parameters.

use crate::closed_form::quick_return::{COLUMNS, Parameters, row, time_ratio};
use crate::reference;
use crate::reference::program::{Run, model, run};
use crate::reference::{Verdict, number, turning};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, TAU};

const SAMPLES: usize = 3600;
const STUDIES: [(&str, f64); 2] = [("one-turn", 0.0), ("one-turn-from-90", FRAC_PI_2)];

fn quick_return(arguments: &[&str]) -> Run {
    run(&model("quick_return.yaml"), &[&["--no-plots"], arguments].concat())
}

#[test]
fn every_column_at_whole_degrees() {
    let file = reference::read();
    let run = quick_return(&[]).succeeded();
    let keys = ["theta1", "theta3", "omega1", "omega3", "alpha1", "alpha3", "xC", "vC", "aC"];
    for (study, start) in STUDIES {
        let table = run.table(study);
        assert_eq!(table.names[..2], ["theta2", "time"]);
        assert_eq!(table.names[2..], COLUMNS);
        let rows = table.on_grid(start, TAU / SAMPLES as f64, SAMPLES);
        let mut verdict = Verdict::default();
        for (name, key) in COLUMNS.iter().zip(keys) {
            let series = reference::series(&file, name, &format!("quick_return/C_left_of_B/{key}"));
            for step in 0..=360 {
                let degree = step + start.to_degrees().round() as usize;
                let found = table.rows[rows[10 * step]][table.index(name)];
                verdict.close(name, format_args!("{degree} deg"), found, series.values[degree % 360], series.tolerance);
            }
        }
        for (step, row) in rows.iter().enumerate() {
            let found = table.rows[*row][1];
            verdict.close("time", step, found, TAU * step as f64 / SAMPLES as f64, 1e-12);
        }
        verdict.give(study);
    }
}

#[test]
fn extrema_stroke_and_time_ratio() {
    let file = reference::read();
    let run = quick_return(&[]).succeeded();
    let keys = ["theta1", "theta3", "omega1", "omega3", "alpha1", "alpha3", "xC", "vC", "aC"];
    for (study, start) in STUDIES {
        let json = run.json(study);
        let mut verdict = Verdict::default();
        for (name, key) in COLUMNS.iter().zip(keys) {
            for which in ["min", "max"] {
                let path = format!("quick_return/C_left_of_B/extrema/{key}_{which}");
                let found = &json["extrema"][name][which];
                let (value, at) = (found["value"].as_f64().unwrap_or(f64::NAN), found["at"].as_f64().unwrap_or(f64::NAN));
                verdict.close(&format!("{which} {name}"), "", value, number(&file, &format!("{path}/values")), 1e-9);
                // modulo a turn
                let off = at - number(&file, &format!("{path}/theta_rad"));
                verdict.close(&format!("angle of {which} {name}"), at, off - TAU * (off / TAU).round(), 0.0, 1e-6);
                verdict.holds((start - 1e-9..=start + TAU + 1e-9).contains(&at), format!("angle of {which} {name}: {at} in the range"));
            }
        }
        verdict.close("stroke", "", json["scalars"]["stroke"].as_f64().unwrap_or(f64::NAN), 80.0 / 3.0, 1e-9);
        let ratio = json["scalars"]["time_ratio"].as_f64().unwrap_or(f64::NAN);
        verdict.close("time_ratio", "", ratio, number(&file, "quick_return/stroke/time_ratio"), 1e-10);
        verdict.give(study);
    }
}

#[test]
fn any_parameters_as_the_closed_form() {
    let d = Parameters::default();
    let cases: [(&[&str], Parameters); 5] = [
        (&["crank=4 m"], Parameters { crank: 4.0, ..d }),
        (&["crank=6", "speed=60 rpm"], Parameters { crank: 6.0, speed: TAU, ..d }),
        (&["centre=15", "lever=34"], Parameters { centre: 15.0, lever: 34.0, ..d }),
        (&["rod=20", "height=31 m"], Parameters { rod: 20.0, height: 31.0, ..d }),
        (
            &["crank=50 mm", "centre=120 mm", "lever=320 mm", "rod=160 mm", "height=320 mm", "speed=12 rad/s"],
            Parameters { crank: 0.05, centre: 0.12, lever: 0.32, rod: 0.16, height: 0.32, speed: 12.0 },
        ),
    ];
    for (set, p) in cases {
        let sets: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
        // the figures that the file expects are those of its own parameters
        let run = quick_return(&sets);
        assert!(run.code <= 1, "{set:?}: exit code {}\n{}", run.code, run.stderr);
        for (study, start) in STUDIES {
            let table = run.table(study);
            table.on_grid(start, TAU / SAMPLES as f64, SAMPLES);
            let right: Vec<_> = table.rows.iter().map(|found| row(&p, found[0])).collect();
            let mut verdict = Verdict::default();
            for (k, name) in COLUMNS.iter().enumerate() {
                let scale = right.iter().map(|r| r[k].abs()).fold(0.0, f64::max);
                for (found, right) in table.rows.iter().zip(&right) {
                    verdict.close(name, found[0].to_degrees(), found[k + 2], right[k], 1e-9 * right[k].abs() + 1e-12 * scale);
                }
                extrema(&mut verdict, &p, k, start, scale, &run.json(study));
            }
            let ratio = run.json(study)["scalars"]["time_ratio"].as_f64().unwrap_or(f64::NAN);
            verdict.close("time_ratio", "", ratio, time_ratio(&p), 1e-9);
            verdict.give(&format!("{study} {set:?}"));
        }
    }
}

fn extrema(verdict: &mut Verdict, p: &Parameters, k: usize, start: f64, scale: f64, json: &Value) {
    let right = turning::extremes(|theta, _| row(p, theta)[k], &[[start, start + TAU]]);
    for (which, (value, at)) in ["min", "max"].into_iter().zip(right) {
        let found = &json["extrema"][COLUMNS[k]][which];
        let (found, place) = (found["value"].as_f64().unwrap_or(f64::NAN), found["at"].as_f64().unwrap_or(f64::NAN));
        let name = format!("{which} {}", COLUMNS[k]);
        verdict.close(&name, at, found, value, 1e-9 * value.abs() + 1e-12 * scale);
        let same = (place - at).abs() <= 1e-6 || ((place - at).abs() > 1e-2 && (row(p, place)[k] - value).abs() <= 1e-11 * scale);
        verdict.holds(same, format!("angle of {name}: found {place}, right {at}, off by {:.3e}", place - at));
    }
}
