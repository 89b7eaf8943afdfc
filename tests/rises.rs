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
