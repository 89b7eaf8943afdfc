//! What rows decide: locked joints and joints that drivers hold have no velocity at all, of whose sign round-off would decide.

use crate::reference::Verdict;
use crate::reference::program::run_text;

const SCHEMES: [&str; 4] = ["dop853", "auto", "radau5", "bdf"];
const COORDINATES: [&str; 3] = ["joint", "cartesian", "minimal"];

/// A triangle of two rods and the ground, from whose top a bob hangs; what `load` says acts on the bob.
fn triangle(load: &str, setting: &str) -> String {
    format!(
        "grashof: 1
name: triangle
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ A: [0, 0], B: [1 m, 0] }}
bodies:
  rod: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  bar: {{ bar: {{ length: 50 cm, mass: 1 kg }} }}
  bob: {{ bar: {{ length: 30 cm, mass: 1 kg }} }}
joints:
  P: {{ revolute: [ground.A, rod.start] }}
  R: {{ revolute: [ground.B, bar.start] }}
  S: {{ revolute: [rod.end, bar.end] }}
  Q: {{ revolute: [rod.end, bob.start] }}
{load}
start: {{ rod.angle: ~30 deg, bar.angle: ~100 deg, Q.angle: 20 deg }}
studies: {{ swing: {{ dynamics: {{ until: 2 s, {setting} }}, columns: [time, P.omega, bar.end.vx, Q.angle, P.alpha] }} }}
"
    )
}

#[test]
fn what_is_locked_has_no_sense_of_motion() {
    let mut verdict = Verdict::default();
    let last = |load: &str, setting: &str| {
        let run = run_text(&triangle(load, setting), &["--no-plots"]).succeeded();
        let events = run.json("swing")["certificate"]["events"].as_f64().unwrap_or(f64::NAN);
        (run.table("swing").rows.last().cloned().unwrap_or_default(), events)
    };
    for scheme in SCHEMES {
        for coordinates in COORDINATES {
            let setting = format!("integrator: {scheme}, tolerance: 1e-9, coordinates: {coordinates}");
            let place = format!("{scheme}, {coordinates}");
            let (without, _) = last("", &setting);
            let (with, events) = last("loads: { push: { joint: Q, torque: 1 N m * sign(P.omega) } }", &setting);
            verdict.close("Q.angle", &place, with[3], without[3], 1e-9);
            for (quantity, k) in [("P.omega", 1), ("bar.end.vx", 2), ("P.alpha", 4)] {
                verdict.close(quantity, &place, with[k], 0.0, 0.0);
            }
            verdict.close("events", &place, events, 0.0, 0.0);
        }
    }
    verdict.give("what_is_locked_has_no_sense_of_motion");
}

/// A slider-crank whose driver moves for a second and rests for the next one; friction by hand at its slider, and a tail that swings.
fn dwell(setting: &str) -> String {
    format!(
        "grashof: 1
name: dwell
space: planar
gravity: none
ground: {{ O: [0, 0] }}
bodies:
  crank: {{ bar: {{ length: 5 cm, mass: 1 kg }} }}
  link: {{ bar: {{ length: 15 cm, mass: 0.6 kg }} }}
  piston: {{ mass: 0.5 kg }}
  tail: {{ bar: {{ length: 10 cm, mass: 0.1 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, link.start] }}
  B: {{ revolute: [link.end, piston.origin] }}
  W: {{ slider: [ground.O, piston.origin], axis: [1, 0] }}
  T: {{ revolute: [piston.origin, tail.start] }}
drivers: {{ drive: {{ joint: O, angle: \"40 deg + 60 deg*(1 - cos(pi*min(t/1 s, 1)))\" }} }}
loads: {{ drag: {{ joint: W, force: \"-50 N*sign(W.velocity)\" }} }}
measures:
  sense: sign(W.velocity)
  there: if(O.angle >= 160 deg, 1, 0)
start: {{ O.angle: 40 deg, link.angle: ~-10 deg, T.angle: 90 deg, T.omega: 0 rad/s }}
studies:
  turn:
    dynamics: {{ until: 2 s, every: 0.1 s, {setting} }}
    columns: [time, sense, there, W.velocity, W.acceleration, B.omega, O.angle]
"
    )
}

#[test]
fn what_a_resting_driver_holds_rests() {
    let mut verdict = Verdict::default();
    for scheme in SCHEMES {
        for coordinates in ["joint", "cartesian"] {
            let setting = format!("integrator: {scheme}, coordinates: {coordinates}");
            let run = run_text(&dwell(&setting), &["--no-plots"]).succeeded();
            for row in run.table("turn").rows.iter().filter(|row| (row[0] - 1.0).abs() > 1e-6 && row[0] > 0.0) {
                let place = format!("{scheme}, {coordinates}, {} s", row[0]);
                let rests = row[0] > 1.0;
                verdict.close("sense", &place, row[1], if rests { 0.0 } else { -1.0 }, 0.0);
                verdict.close("there", &place, row[2], f64::from(u8::from(rests)), 0.0);
                if rests {
                    for (quantity, k) in [("W.velocity", 3), ("W.acceleration", 4), ("B.omega", 5)] {
                        verdict.close(quantity, &place, row[k], 0.0, 0.0);
                    }
                    verdict.close("O.angle", &place, row[6], 160_f64.to_radians(), 1e-15);
                }
            }
        }
    }
    verdict.give("what_a_resting_driver_holds_rests");
}
