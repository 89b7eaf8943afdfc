//! The hand-written closed forms against the reference values.

use crate::closed_form::crank_rocker::{COLUMNS, CrankRocker, Load, Parameters};
use crate::closed_form::plane::{add, size, sub};
use crate::closed_form::quick_return;
use crate::reference;
use crate::reference::{Verdict, number, turning};
use std::f64::consts::TAU;

fn index(name: &str) -> usize {
    COLUMNS.iter().position(|c| *c == name).unwrap_or_else(|| panic!("no column {name}"))
}

#[test]
fn every_column_of_the_crank_rocker() {
    let file = reference::read();
    for loaded in [true, false] {
        let p = Parameters { load_max: if loaded { 3000.0 } else { 0.0 }, ..Parameters::default() };
        let rocker = CrankRocker::new(p);
        let mut verdict = Verdict::default();
        let all = reference::crank_rocker(&file, loaded);
        let mut names: Vec<_> = all.iter().map(|s| s.name).collect();
        names.sort_unstable();
        let mut columns = COLUMNS;
        columns.sort_unstable();
        assert_eq!(names, columns);
        for series in all {
            for (degree, right) in series.values.iter().enumerate() {
                let found = rocker.row((degree as f64).to_radians(), Load::ByState)[index(series.name)];
                verdict.close(series.name, format_args!("{degree} deg"), found, *right, series.tolerance);
            }
        }
        verdict.give(if loaded { "with load" } else { "without load" });
    }
}

#[test]
fn extrema_of_the_crank_rocker() {
    let file = reference::read();
    for loaded in [true, false] {
        let p = Parameters { load_max: if loaded { 3000.0 } else { 0.0 }, ..Parameters::default() };
        let rocker = CrankRocker::new(p);
        let zone = [number(&file, "load_zone/theta_c_rad"), number(&file, "load_zone/theta_e_rad")];
        let pieces = [[0.0, zone[0]], zone, [zone[1], TAU]];
        let load = [Load::Off, Load::On, Load::Off];
        let mut verdict = Verdict::default();
        for right in reference::extrema(&file, loaded) {
            let column = index(right.column);
            let [min, max] = turning::extremes(|theta, piece| rocker.row(theta, load[piece])[column], &pieces);
            let (value, at) = if right.which == "min" { min } else { max };
            let name = format!("{} {}", right.which, right.column);
            verdict.close(&name, "its place", value, right.value, right.tolerance);
            // an extremum may be taken at several angles
            let here = rocker.row(at, Load::ByState)[column];
            if (here - right.value).abs() > 1e-3 * right.value.abs() || (at - right.at).abs() < 0.1 {
                verdict.close(&format!("angle of {name}"), "", at, right.at, 1e-8);
            }
        }
        verdict.give(if loaded { "with load" } else { "without load" });
    }
}

#[test]
fn both_sides_of_the_end_of_the_load() {
    let file = reference::read();
    let rocker = CrankRocker::new(Parameters::default());
    let theta = number(&file, "load_zone/theta_e_rad");
    let mut verdict = Verdict::default();
    for (side, load) in [Load::On, Load::Off].into_iter().enumerate() {
        let row = rocker.row(theta, load);
        let columns = ["Ox", "Oy", "Ax", "Ay", "Bx", "By", "Gx", "Gy", "MO"];
        let names = ["O.fx", "O.fy", "A.fx", "A.fy", "B.fx", "B.fy", "C.fx", "C.fy", "drive.torque"];
        for (name, column) in names.iter().zip(columns) {
            let path = format!("reactions/with_load/at_theta_e_before_and_after/{column}/{side}");
            // the angle has 12 digits
            verdict.close(name, side, row[index(name)], number(&file, &path), 2e-6);
        }
    }
    verdict.give("both sides");
}

#[test]
fn switches_work_balance_and_reach() {
    let file = reference::read();
    let rocker = CrankRocker::new(Parameters::default());
    let mut verdict = Verdict::default();
    let found = rocker.switches(0.0);
    assert_eq!(found.len(), 4);
    let right = [
        number(&file, "extrema/phi3_max/theta_rad"),
        number(&file, "load_zone/theta_c_rad"),
        number(&file, "load_zone/theta_e_rad"),
        325.979_f64.to_radians(),
    ];
    for (k, (found, right)) in found.iter().zip(right).enumerate() {
        verdict.close("switch", k, *found, right, if k == 3 { 1e-5 } else { 1e-11 });
    }
    verdict.close("phi3_min", "", rocker.phi3_min, number(&file, "load_zone/phi3_min_rad"), 1e-12);
    let work = number(&file, "power/with_load/values/work_per_turn_J");
    verdict.close("work", "", rocker.work_per_turn(), work, 1e-7);

    let ([kappa, lambda], centre) = rocker.balance(100.0, 100.0);
    verdict.close("kappa", "", kappa, number(&file, "balance/values/l_kappa_for_100kg"), 1e-12);
    verdict.close("lambda", "", lambda, number(&file, "balance/values/l_lambda_for_100kg"), 1e-12);
    verdict.close("com_x", "", centre[0], number(&file, "balance/values/fixed_com_x"), 1e-12);

    for row in file["singular_l3"]["table"].as_array().unwrap() {
        let l3 = row["l3_m"].as_f64().unwrap();
        let angles: Vec<f64> = row["singular_theta_deg"].as_array().unwrap().iter().map(|a| a.as_f64().unwrap()).collect();
        if l3 == 0.0 || angles.iter().any(|a| a % 180.0 == 0.0) || angles.is_empty() {
            continue;
        }
        let rocker = CrankRocker::new(Parameters { l3, ..Parameters::default() });
        // a start between the first two singular angles, or beyond the only ones
        let start = (0.5 * (angles[0] + angles[1])).to_radians();
        let [below, above] = rocker.reach(start).unwrap();
        verdict.close("reach below", l3, below.to_degrees(), angles[0], 1e-8);
        verdict.close("reach above", l3, above.to_degrees(), angles[1], 1e-8);
    }
    verdict.give("switches, work, balance, reach");
}

#[test]
fn the_laws_hold_for_any_lengths() {
    for (l1, l2, l3, l_tip, l) in [(0.15, 1.0, 0.6, 0.15, 1.0), (0.2, 0.7, 0.5, 0.3, 0.8), (0.1, 0.4, 0.35, 0.0, 0.3)] {
        let p =
            Parameters { l1, l2, l3, l_tip, l, speed: 12.0, m1: 3.0, m2: 5.0, m3: 7.0, m_tip: 2.0, g_earth: 3.7, ..Parameters::default() };
        let rocker = CrankRocker::new(p);
        let mut verdict = Verdict::default();
        for k in 0..360 {
            let theta = f64::from(k).to_radians();
            for load in [Load::On, Load::Off] {
                let row = |theta: f64| rocker.row(theta, load);
                let here = row(theta);
                let of = |name: &str| here[index(name)];
                let rate = |name: &str| p.speed * turning::slope(&|x| row(x)[index(name)], theta, 2e-3);
                for (value, of_rate) in [
                    ("phi2", "omega2"),
                    ("phi3", "omega3"),
                    ("omega2", "alpha2"),
                    ("omega3", "alpha3"),
                    ("com.x", "com.vx"),
                    ("com.vx", "com.ax"),
                    ("com.y", "com.vy"),
                    ("com.vy", "com.ay"),
                ] {
                    verdict.close(of_rate, k, of(of_rate), rate(value), 1e-8 * (1.0 + of(of_rate).abs()));
                }
                verdict.close("slope", k, of("inertia_eq_slope"), rate("inertia_eq") / p.speed, 1e-9);
                // shaking = −frame + weight + tip load
                let (motion, forces) = rocker.sample(theta, load);
                let ground = add(forces.o, forces.c);
                let all = sub(add(ground, rocker.tip_load(&motion, load)), [0.0, rocker.mass() * p.g_earth]);
                let shaking = [of("shaking.fx"), of("shaking.fy")];
                verdict.close("shaking", k, size(sub(all, shaking)), 0.0, 1e-10 * (1.0 + size(ground)));
                // driver power = rate of kinetic and potential energy less the power of the load
                let kinetic = 0.5 * of("inertia_eq_slope") * p.speed.powi(3);
                let potential = rocker.mass() * p.g_earth * of("com.vy");
                let loss = forces.tip_force * rocker.radius * -motion.omega3;
                verdict.close("power", k, of("drive.power"), kinetic + potential + loss, 1e-10 * (1.0 + of("drive.power").abs()));
            }
        }
        verdict.give(&format!("l1 {l1}"));
    }
}

#[test]
fn the_quick_return() {
    let file = reference::read();
    let p = quick_return::Parameters::default();
    let keys = ["theta1", "theta3", "omega1", "omega3", "alpha1", "alpha3", "xC", "vC", "aC"];
    let mut verdict = Verdict::default();
    for (k, key) in keys.into_iter().enumerate() {
        let series = reference::series(&file, quick_return::COLUMNS[k], &format!("quick_return/C_left_of_B/{key}"));
        for (degree, right) in series.values.iter().enumerate() {
            let found = quick_return::row(&p, (degree as f64).to_radians())[k];
            verdict.close(series.name, degree, found, *right, series.tolerance);
        }
        let [min, max] = turning::extremes(|theta, _| quick_return::row(&p, theta)[k], &[[0.0, TAU]]);
        for (which, (value, at)) in [("min", min), ("max", max)] {
            let path = format!("quick_return/C_left_of_B/extrema/{key}_{which}");
            verdict.close(&path, "", value, number(&file, &format!("{path}/values")), 1e-9);
            verdict.close(&path, "angle", at, number(&file, &format!("{path}/theta_rad")), 1e-7);
        }
    }
    verdict.close("time ratio", "", quick_return::time_ratio(&p), number(&file, "quick_return/stroke/time_ratio"), 1e-10);
    verdict.give("quick return");
}
