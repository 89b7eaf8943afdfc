//! Gravity that depends on the place and on time.

use super::{Columns, near, refusal};
use grashof::mechanism::Coordinates;
use std::f64::consts::TAU;

fn orbit(space: &str, gravity: &str, settings: &str) -> String {
    let (z, vz) = if space == "planar" { ("", "") } else { ("planet.z: 0 m, ", "planet.vz: 0 m/s, ") };
    format!(
        "
grashof: 1
name: orbit
space: {space}
parameters: {{ mu: 4 m^3/s^2 }}
gravity: {gravity}
bodies: {{ planet: {{ mass: 3 kg }} }}
start: {{ planet.x: 1 m, planet.y: 0 m, {z}planet.vx: 0 m/s, {vz}planet.vy: 2.4 m/s }}
studies:
  orbit:
    dynamics: {{ until: 30 s, {settings} }}
    columns: [time, planet.x, planet.y, planet.vx, planet.vy, energy.kinetic, energy.potential]
    scalars: {{ loads: work_loads, far: \"max(hypot(planet.x, planet.y))\" }}
"
    )
}

/// Kepler's ellipse: a, the period T = 2π √(a³/µ), and the place by his equation.
#[test]
fn a_planet_follows_kepler() {
    let (mu, r, v) = (4.0_f64, 1.0_f64, 2.4_f64);
    let a = 1.0 / (2.0 / r - v * v / mu);
    let e = 1.0 - r / a;
    let n = (mu / a.powi(3)).sqrt();
    let components = |space: &str| if space == "planar" { "[-mu*x/r^3, -mu*y/r^3]" } else { "[-mu*x/r^3, -mu*y/r^3, -mu*z/r^3]" };
    for (space, gravity, settings) in [
        ("planar", components("planar"), "every: 0.1 s, tolerance: 1e-12"),
        ("spatial", components("spatial"), "every: 0.1 s, tolerance: 1e-12"),
        ("planar", "{ potential: -mu/r }", "every: 0.1 s, tolerance: 1e-12"),
        ("spatial", "{ potential: -mu/r }", "every: 0.1 s, tolerance: 1e-12, integrator: radau5"),
        ("planar", "{ potential: \"-mu/hypot(x, y)\" }", "every: 0.1 s, tolerance: 1e-11, coordinates: cartesian"),
    ] {
        let run = Columns::of(&orbit(space, gravity, settings), "orbit", Coordinates::Joint);
        let [x, y] = ["planet.x", "planet.y"].map(|name| run.get(name));
        for (i, t) in run.get("time").into_iter().enumerate() {
            // E − e sin E = n t, from a start that Newton's method does not leave
            let mut anomaly = n * t + e * (n * t).sin();
            for _ in 0..50 {
                anomaly -= (anomaly - e * anomaly.sin() - n * t) / (1.0 - e * anomaly.cos());
            }
            near("x", x[i], a * (anomaly.cos() - e), 1e-6);
            near("y", y[i], a * (1.0 - e * e).sqrt() * anomaly.sin(), 1e-6);
        }
        near("farthest", run.outcome.scalars[1], a * (1.0 + e), 1e-7);
        let [kinetic, potential] = ["energy.kinetic", "energy.potential"].map(|name| run.get(name));
        let last = kinetic.len() - 1;
        if gravity.contains("potential") {
            let distance = (x[last].powi(2) + y[last].powi(2)).sqrt();
            near("potential energy", potential[last], -3.0 * mu / distance, 1e-9);
            near("energy", kinetic[last] + potential[last], kinetic[0] + potential[0], 1e-8);
            near("nothing is work of loads", run.outcome.scalars[0], 0.0, 1e-12);
        } else {
            assert_eq!(potential[last], 0.0, "a field without a potential has no energy");
            near("work of the field", run.outcome.scalars[0], kinetic[last] - kinetic[0], 1e-8);
        }
        assert!(TAU / n < 15.0 && run.march().energy_drift < 1e-8, "several orbits, balanced");
    }
}

/// A field that happens to be the same everywhere, on a mechanism with loops, in all kinds of studies.
#[test]
fn a_field_that_is_the_same_everywhere_is_gravity() {
    let text = |gravity: &str| {
        format!(
            "
grashof: 1
name: four-bar
space: planar
parameters: {{ g: 9.81 m/s^2 }}
gravity: {gravity}
ground: {{ O: [0, 0], C: [30 cm, 0] }}
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: 0.4 kg }}, attached: {{ bolt: {{ at: end, mass: 0.2 kg }} }} }}
  coupler: {{ bar: {{ length: 30 cm, mass: 1.2 kg }} }}
  rocker: {{ mass: 1 kg, com: [10 cm, 3 cm], inertia: 0.01 kg m^2, points: {{ end: [25 cm, 0] }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.origin] }}
start: {{ O.angle: 20 deg, coupler.angle: ~56 deg, rocker.angle: ~97 deg }}
variants: {{ driven: {{ drivers: {{ drive: {{ joint: O, speed: 60 rpm }} }} }} }}
studies:
  falls: {{ dynamics: {{ until: 1 s, every: 0.1 s, tolerance: 1e-11 }}, columns: [O.angle, C.f, B.f, frame.f] }}
  turns: {{ variant: driven, inverse: {{ over: 1 turn, samples: 12 }}, columns: [O.angle, C.f, B.f, frame.f, drive.torque] }}
  rests: {{ statics: {{ from: start }}, columns: [O.angle, C.f, B.f, frame.f] }}
  sways: {{ modes: {{ at: statics }} }}
"
        )
    };
    let plain = text("[0, -g]");
    // 1 to round-off, and a formula of the place all the same
    for gravity in ["[0 m/s^2*x/r, -g*cos(1e-9*y/1 m)]", "{ potential: g*y }"] {
        let field = text(gravity);
        for study in ["falls", "turns", "rests"] {
            let [a, b] = [&plain, &field].map(|text| crate::common::study(text, study, Coordinates::Joint));
            for (a, b) in a.rows.iter().flatten().zip(b.rows.iter().flatten()) {
                near(study, *b, *a, 1e-7 * (1.0 + a.abs()));
            }
        }
        let [a, b] = [&plain, &field].map(|text| crate::common::study(text, "sways", Coordinates::Joint).results[0]);
        near("frequency", b, a, 1e-8 * a);
    }
}

/// A lift that shakes: ÿ = −g (1 + ½ sin 3t).
#[test]
fn gravity_may_depend_on_time() {
    let text = "
grashof: 1
name: lift
space: planar
gravity: [0, \"-9 m/s^2*(1 + 0.5*sin(3 rad/s*t))\"]
bodies: { ball: { ball: { radius: 5 cm, mass: 2 kg } } }
start: { ball.x: 0 m, ball.y: 0 m, ball.angle: 0 deg, ball.vy: 0 m/s }
studies:
  fall: { dynamics: { until: 2 s, every: 0.1 s, tolerance: 1e-12 }, columns: [time, ball.y, ball.vy], scalars: { work: work_loads } }
";
    let run = Columns::of(text, "fall", Coordinates::Joint);
    let v = |t: f64| -9.0 * (t + (1.0 - (3.0 * t).cos()) / 6.0);
    for (i, t) in run.get("time").into_iter().enumerate() {
        near("height", run.get("ball.y")[i], -9.0 * (0.5 * t * t + t / 6.0 - (3.0 * t).sin() / 18.0), 1e-9);
        near("speed", run.get("ball.vy")[i], v(t), 1e-9);
    }
    near("work", run.outcome.scalars[0], v(2.0).powi(2), 1e-8);
}

/// Gravity that ends at a height is a switch like others, and a train through the earth swings as a spring does.
#[test]
fn gravity_may_switch_and_pull_like_a_spring() {
    let text = "
grashof: 1
name: tunnel
space: planar
parameters: { g: 10 m/s^2, R: 5 m }
gravity: [\"if(r < R, -g*x/R, -g*R^2*x/r^3)\", \"if(r < R, -g*y/R, -g*R^2*y/r^3)\"]
bodies: { train: { mass: 1 kg } }
joints: { tunnel: { slider: [ground, train.origin], axis: [1, 0] } }
start: { tunnel.position: 4 m, tunnel.velocity: 0 m/s }
studies:
  swing: { dynamics: { until: 10 s, every: 0.1 s, tolerance: 1e-11 }, columns: [time, tunnel.position] }
  out:
    dynamics: { until: 1.5 s, every: 0.1 s, tolerance: 1e-11 }
    columns: [time, tunnel.position, tunnel.velocity]
";
    let run = Columns::of(text, "swing", Coordinates::Joint);
    let omega = 2.0_f64.sqrt();
    for (i, t) in run.get("time").into_iter().enumerate() {
        near("as a spring", run.get("tunnel.position")[i], 4.0 * (omega * t).cos(), 1e-7);
    }
    // thrown upwards from inside with 12 m/s it leaves the ball: v² = v₀² − ω² (R² − x₀²), then v² falls by 2 g R² (1/R − 1/x)
    let thrown = Columns::of(&text.replace("velocity: 0 m/s", "velocity: 12 m/s"), "out", Coordinates::Joint);
    let at_surface = 144.0 - 2.0 * (25.0 - 16.0);
    for (x, v) in thrown.get("tunnel.position").into_iter().zip(thrown.get("tunnel.velocity")) {
        let right = if x < 5.0 { 144.0 - 2.0 * (x * x - 16.0) } else { at_surface - 2.0 * 250.0 * (1.0 / 5.0 - 1.0 / x) };
        near("v²", v * v, right, 1e-6);
    }
    assert_eq!(thrown.outcome.switches.len(), 1);
}

#[test]
fn fields_name_their_place_and_time_alone() {
    for (gravity, words) in [
        ("[0, -mu*planet.x/1 s]", "is a position"),
        ("[0, \"-mu*z/r^3\"]", "`z` does not exist in the plane"),
        ("[0, -mu*x]", "acceleration"),
        ("{ potential: mu/r*t }", "`t` is no parameter"),
        ("{ potential: mu*x }", "m^2/s^2"),
        ("{ potential: -mu/q }", "unknown name `q`"),
    ] {
        let refused = refusal(&orbit("planar", gravity, "tolerance: 1e-9"), None);
        assert!(refused.contains(words), "{gravity}: {refused}");
    }
    let named = orbit("planar", "[0, -mu/r^2]", "tolerance: 1e-9").replace("mu: 4 m^3/s^2", "mu: 4 m^3/s^2, r: 2 m");
    let refused = refusal(&named, None);
    assert!(refused.contains("`r` is the place in gravity, and a parameter") && refused.contains("another name"), "{refused}");
}
