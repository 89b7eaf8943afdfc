//! Any parameters against the closed form.

use super::*;

/// Parameters from outside, as the command line says them.
struct Case {
    set: &'static [&'static str],
    p: Parameters,
}

fn cases() -> Vec<Case> {
    let d = Parameters::default();
    let rpm = TAU / 60.0;
    vec![
        Case { set: &["l3=0.6"], p: Parameters { l3: 0.6, ..d } },
        Case { set: &["l3=60 cm", "speed=100 rpm"], p: Parameters { l3: 0.6, speed: 100.0 * rpm, ..d } },
        Case { set: &["speed=10"], p: Parameters { speed: 10.0, ..d } },
        Case { set: &["g_earth=1.62"], p: Parameters { g_earth: 1.62, ..d } },
        Case { set: &["g_earth=0", "load_max=5 kN"], p: Parameters { g_earth: 0.0, load_max: 5000.0, ..d } },
        Case { set: &["l1=0.2", "l_tip=0.3 m", "load_max=1234.5"], p: Parameters { l1: 0.2, l_tip: 0.3, load_max: 1234.5, ..d } },
        Case { set: &["l2=1.25", "l=1.1"], p: Parameters { l2: 1.25, l: 1.1, ..d } },
        Case { set: &["m1=5", "m2=12.5", "m3=80", "m_tip=0"], p: Parameters { m1: 5.0, m2: 12.5, m3: 80.0, m_tip: 0.0, ..d } },
        Case { set: &["load_angle=-25 deg"], p: Parameters { load_angle: (-25.0_f64).to_radians(), ..d } },
        // above the whole swing: the load acts all the way back and begins with a jump
        Case { set: &["load_angle=5 deg"], p: Parameters { load_angle: 5.0_f64.to_radians(), ..d } },
        Case { set: &["load_angle=-0.3", "l3=50 cm"], p: Parameters { load_angle: -0.3, l3: 0.5, ..d } },
        Case { set: &["l_tip=0", "m_tip=200 kg"], p: Parameters { l_tip: 0.0, m_tip: 200.0, ..d } },
        Case {
            set: &["l1=8 cm", "l2=45 cm", "l3=30 cm", "l=40 cm", "l_tip=5 cm", "m_tip=3", "m1=1", "m2=2", "m3=1500 g", "speed=900 rpm"],
            p: Parameters {
                l1: 0.08,
                l2: 0.45,
                l3: 0.3,
                l: 0.4,
                l_tip: 0.05,
                m_tip: 3.0,
                m1: 1.0,
                m2: 2.0,
                m3: 1.5,
                speed: 900.0 * rpm,
                ..d
            },
        },
        Case { set: &["l1=0.4", "l3=0.9", "l2=1.1", "load_max=800"], p: Parameters { l1: 0.4, l3: 0.9, l2: 1.1, load_max: 800.0, ..d } },
    ]
}

/// The load on one side of `theta`, from the state a little beyond.
pub(super) fn load_beside(rocker: &CrankRocker, theta: f64, side: i32) -> Load {
    let m = rocker.motion(theta + 1e-7 * f64::from(side));
    if m.phi3 <= rocker.p.load_angle && m.omega3 <= 0.0 { Load::On } else { Load::Off }
}

#[test]
fn any_parameters_as_the_closed_form() {
    for Case { set, p } in cases() {
        let sets: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
        // the figures that the file expects are those of its own parameters
        let run = crank_rocker(&[&["--study", "one-turn"], sets.as_slice()].concat());
        assert!(run.code <= 1, "{set:?}: exit code {}\n{}", run.code, run.stderr);
        let mut verdict = Verdict::default();
        let rocker = CrankRocker::new(p);
        let table = run.table("one-turn");
        table.on_grid(0.0, TAU / SAMPLES as f64, SAMPLES);
        let right: Vec<_> = table
            .rows
            .iter()
            .zip(table.sides())
            .map(|(row, side)| rocker.row(row[0], if side == 0 { Load::ByState } else { load_beside(&rocker, row[0], side) }))
            .collect();
        let scale: Vec<f64> = (0..COLUMNS.len()).map(|k| right.iter().map(|row| row[k].abs()).fold(1e-300, f64::max)).collect();
        for (found, right) in table.rows.iter().zip(&right) {
            for (k, name) in COLUMNS.iter().enumerate() {
                verdict.close(
                    name,
                    format_args!("{} deg", right[0].to_degrees()),
                    found[k],
                    right[k],
                    1e-9 * right[k].abs() + 1e-12 * scale[k],
                );
            }
        }
        switched(&mut verdict, &rocker, &table);
        extrema(&mut verdict, &rocker, &run.json("one-turn"), &scale);
        scalars(&mut verdict, &rocker, &run.json("one-turn"));
        verdict.give(&format!("{set:?}"));
    }
}

pub(super) fn switched(verdict: &mut Verdict, rocker: &CrankRocker, table: &Table) {
    let right = rocker.switches(0.0);
    let found: Vec<f64> = switches(table).into_iter().map(|i| table.rows[i][0]).collect();
    verdict.holds(found.len() == right.len(), format!("switches {found:?}, right {right:?}"));
    for (found, right) in found.iter().zip(&right) {
        verdict.close("switch", "", *found, *right, 1e-8);
    }
}

fn extrema(verdict: &mut Verdict, rocker: &CrankRocker, json: &Value, scale: &[f64]) {
    let mut ends = vec![0.0];
    ends.extend(rocker.switches(0.0));
    ends.push(TAU);
    let pieces: Vec<[f64; 2]> = ends.windows(2).map(|w| [w[0], w[1]]).collect();
    let loads: Vec<Load> = pieces.iter().map(|[a, b]| load_beside(rocker, 0.5 * (a + b), 0)).collect();
    for (k, column) in COLUMNS.iter().enumerate() {
        let right = turning::extremes(|theta, piece| rocker.row(theta, loads[piece])[k], &pieces);
        for (which, (value, at)) in ["min", "max"].into_iter().zip(right) {
            let found = &json["extrema"][column][which];
            let (found, place) = (found["value"].as_f64().unwrap_or(f64::NAN), found["at"].as_f64().unwrap_or(f64::NAN));
            let name = format!("{which} {column}");
            verdict.close(&name, at, found, value, 1e-9 * value.abs() + 1e-12 * scale[k]);
            if (place - at).abs() <= 1e-6 {
                continue;
            }
            // taken at several angles?
            let there =
                [Load::On, Load::Off].map(|load| (rocker.row(place, load)[k] - value).abs()).into_iter().fold(f64::INFINITY, f64::min);
            let elsewhere = (place - at).abs() > 1e-2 && there <= 1e-11 * scale[k];
            verdict.holds(elsewhere, format!("angle of {name}: found {place}, right {at}, off by {:.3e}", place - at));
        }
    }
}

fn scalars(verdict: &mut Verdict, rocker: &CrankRocker, json: &Value) {
    let work = rocker.work_per_turn();
    let torque = rocker.forces(&rocker.motion(1.0), Load::Off).torque.abs();
    for (name, right) in [("work_per_turn", work), ("mean_torque", work / TAU), ("mean_power", work / TAU * rocker.p.speed)] {
        let found = json["scalars"][name].as_f64().unwrap_or(f64::NAN);
        verdict.close(name, "", found, right, 1e-9 * right.abs() + 1e-11 * (torque + 1.0) * rocker.p.speed.max(1.0));
    }
}
