//! Drivers that come to rest: `kinematics` and `inverse` go on behind the end of their laws, however long, with the peaks of the laws
//! and without impulses.

use crate::reference::Verdict;
use crate::reference::program::run_text;

/// Laws with their largest speeds in units of the mean one, and whether velocities are continuous at the ends.
const LAWS: [(&str, f64); 2] = [("poly5", 1.875), ("cycloidal", 2.0)];

#[test]
fn a_rise_is_followed_by_rest() {
    let mut verdict = Verdict::default();
    for (law, peak) in LAWS {
        for (by, during) in [(60.0, 0.5), (5.0, 0.3), (170.0, 0.9), (30.0, 0.05)] {
            for over in [1.0, 2.0, 4.1] {
                let text = format!(
                    "grashof: 1
name: arm
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ arm: {{ bar: {{ length: 40 cm, mass: 1 kg }} }} }}
joints: {{ D: {{ revolute: [ground, arm.start] }} }}
drivers: {{ lift: {{ joint: D, rise: {{ by: {by} deg, during: {during} s, law: {law} }} }} }}
studies:
  s:
    inverse: {{ over: {over} s, samples: 40 }}
    columns: [time, D.angle, D.omega, lift.torque]
    scalars: {{ end: last(D.angle), peak: max(D.omega), torque: last(lift.torque) }}
"
                );
                let place = format!("{law} by {by} deg in {during} s over {over} s");
                let run = run_text(&text, &["--no-plots"]).succeeded();
                let json = run.json("s");
                let scalar = |name: &str| json["scalars"][name].as_f64().unwrap_or(f64::NAN);
                let angle = f64::to_radians(by);
                verdict.close("end", &place, scalar("end"), angle, 1e-12);
                verdict.close("peak", &place, scalar("peak"), peak * angle / during, 1e-9 * angle / during);
                verdict.close("torque", &place, scalar("torque"), 9.81 * 0.2 * angle.cos(), 1e-9);
                let findings = json["findings"].as_array().map_or(0, Vec::len);
                verdict.close("findings", &place, findings as f64, 0.0, 0.0);
            }
        }
    }
    verdict.give("rises");
}

#[test]
fn a_law_far_beyond_its_switch_does_not_matter() {
    // behind t = 0.5 s the first branch would be at 25 m at the end
    let text = "grashof: 1
name: law
space: planar
gravity: none
bodies: { a: { mass: 2 kg } }
joints: { S: { slider: [ground, a.origin], axis: [1, 0] } }
drivers: { x: { joint: S, position: \"0.3 m*max(0, 0.5 - t/1 s)^3\" } }
studies: { s: { inverse: { over: 7 s, samples: 40 }, columns: [time, S.position], scalars: { sum: integral(S.position) } } }
";
    let run = run_text(text, &["--no-plots"]).succeeded();
    let mut verdict = Verdict::default();
    let sum = run.json("s")["scalars"]["sum"].as_f64().unwrap_or(f64::NAN);
    verdict.close("integral", "S.position", sum, 0.3 * 0.5_f64.powi(4) / 4.0, 1e-12);
    verdict.give("law");
}

/// A law of a driver, and the same by hand, m by s.
type Law = (&'static str, fn(f64) -> f64);

/// A slide that a law drives over a range of its own.
fn over_a_law(law: &str) -> String {
    format!(
        "grashof: 1
name: law
space: planar
gravity: none
bodies: {{ a: {{ mass: 2 kg }} }}
joints: {{ S: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
drivers: {{ x: {{ joint: S, position: \"{law}\" }} }}
studies: {{ s: {{ inverse: {{ over: 2.5 m, samples: 50 }}, columns: [S.position, time] }} }}
"
    )
}

#[test]
fn a_range_of_a_driver_follows_its_law() {
    // each begins with 1 m/s and without acceleration, and is so again after 1 s
    let laws: [Law; 3] = [
        ("1 m/s*t", |t| t),
        ("1 m/s*t + 0.2 m*sin(pi*t/1 s)^3", |t| t + 0.2 * (std::f64::consts::PI * t).sin().powi(3)),
        ("if(t < 2 s, 1 m/s*t, 2 m + 2 m/s*(t - 2 s))", |t| t.max(2.0 * t - 2.0)),
    ];
    let mut verdict = Verdict::default();
    for (law, x) in laws {
        let table = run_text(&over_a_law(law), &["--no-plots"]).succeeded().table("s");
        verdict.close("end", law, table.rows.last().expect("rows")[0], 2.5, 1e-13);
        for row in &table.rows {
            verdict.close("law", law, row[0], x(row[1]), 1e-12);
        }
    }
    verdict.give("range of a law");
    let rests = run_text(&over_a_law("if(t < 2 s, 1 m/s*t, 2 m)"), &["--no-plots"]);
    assert_eq!(rests.code, 2, "{}", rests.stdout);
    for part in ["the driver never gets so far, but 2 m at most", "over: 2.5 m"] {
        assert!(rests.stderr.contains(part), "{part}: {}", rests.stderr);
    }
    // a rise, a rest and a rise, straight and smooth: at the rest the coordinate tells no time
    for law in [
        "max(0, min(t/1 s, 1))*1 m + max(0, t/1 s - 1.5)*1 m",
        "if(t < 1 s, 1 m/s*t*(2 - t/1 s), if(t < 2 s, 1 m, 1 m + 1 m*(t/1 s - 2)^2))",
    ] {
        let rests = run_text(&over_a_law(law), &["--no-plots"]);
        assert!(rests.code == 2 && rests.stderr.contains("the driver rests on its way, after 1 m"), "{law}: {}", rests.stderr);
        let over_time = over_a_law(law).replace("2.5 m", "4 s");
        let end = run_text(&over_time, &["--no-plots"]).succeeded().table("s").rows.last().expect("rows")[1];
        assert!(end == 4.0, "{law}: {end}");
    }
}
