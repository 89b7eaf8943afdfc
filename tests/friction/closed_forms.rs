//! Coulomb's law by coefficients, against motions that are known in closed form.

use super::{close, done, drift, last, tried};
use crate::common::model;

/// Gravity of these tests, m/s².
const G: f64 = 9.81;

/// All schemes, those of a given step with it.
pub(crate) const SCHEMES: [(&str, f64); 9] = [
    ("tolerance: 1e-10", 1e-8),
    ("integrator: dop853, tolerance: 1e-10", 1e-8),
    ("integrator: radau5, tolerance: 1e-10", 1e-8),
    ("integrator: bdf, tolerance: 1e-9", 2e-6),
    ("integrator: rk4, step: 1 ms", 1e-8),
    ("integrator: newmark, step: 1 ms", 1e-5),
    ("integrator: generalized-alpha, rho: 0.8, step: 1 ms", 1e-5),
    ("integrator: hht, step: 1 ms", 1e-4),
    ("integrator: central-difference, step: 1 ms", 1e-5),
];

/// A block on an incline of the angle α, its coordinate upwards.
fn incline(friction: &str, start: &str, until: f64, settings: &str) -> String {
    format!(
        "grashof: 1
name: incline
space: planar
gravity: [0, -{G} m/s^2]
parameters: {{ alpha: 30 deg }}
bodies:
  block: {{ mass: 2 kg, inertia: 0.01 kg m^2 }}
joints:
  W: {{ slider: [ground, block.origin], axis: [cos(alpha), sin(alpha)], friction: {{ {friction} }} }}
start: {{ {start} }}
studies:
  slide: {{ dynamics: {{ until: {until} s, every: 10 ms, {settings} }}, columns: [time, W.position, W.velocity, W.friction, W.f] }}
"
    )
}

#[test]
fn a_block_slides_down_and_up_with_the_accelerations_of_coulomb() {
    let (s, c) = (0.5, 0.75_f64.sqrt());
    let mu = 0.2;
    for (settings, tolerance) in SCHEMES {
        for coordinates in ["joint", "cartesian", "minimal"] {
            let of = format!("{settings}, coordinates: {coordinates}");
            let down = done(&incline("coulomb: 0.2", "W.velocity: -1 m/s", 0.1, &of), "slide");
            let a = -G * (s - mu * c);
            close(&format!("v down, {of}"), last(&down)[2], -1.0 + 0.1 * a, tolerance);
            close(&format!("x down, {of}"), last(&down)[1], -0.1 + 0.005 * a, tolerance);
            close("friction", last(&down)[3], mu * 2.0 * G * c, 1e-9);
            close("normal force", last(&down)[4], 2.0 * G * c, 1e-9);
            assert!(drift(&down) < 1e-5, "{of}: {}", drift(&down));
        }
    }
    // upwards the friction adds to gravity
    let up = done(&incline("coulomb: 0.2", "W.velocity: 5 m/s", 0.5, "tolerance: 1e-10"), "slide");
    close("v up", last(&up)[2], 5.0 - 0.5 * G * (s + mu * c), 1e-9);
}

#[test]
fn a_block_that_sticks_creeps_at_the_share_of_the_stick_speed_that_holds_it() {
    // µ N v/v_s = m g sin α with tan 30° < 0.8; from rest v = −v₀ (1 − exp(−µ g cos α t/v_s))
    let (mu, stick) = (0.8, 0.01);
    let creep = stick * (1.0 / 3.0_f64.sqrt()) / mu;
    let rate = mu * G * 0.75_f64.sqrt() / stick;
    let text = incline("coulomb: 0.8, stick_speed: 1 cm/s", "W.velocity: 0 m/s", 0.05, "tolerance: 1e-12");
    let outcome = done(&text, "slide");
    for row in &outcome.rows {
        let decay = (-rate * row[0]).exp();
        close("v", row[2], -creep * (1.0 - decay), 1e-11);
        close("x", row[1], -creep * (row[0] - (1.0 - decay) / rate), 1e-11);
    }
}

#[test]
fn a_block_stops_after_its_time_and_way() {
    let (mu, stick) = (0.3, 1e-3);
    for (settings, _) in &SCHEMES[..4] {
        let text =
            incline("coulomb: 0.3, stick_speed: 1 mm/s", "W.velocity: 2 m/s", 1.2, settings).replace("alpha: 30 deg", "alpha: 0 deg");
        let outcome = done(&text, "slide");
        let way = (4.0 - stick * stick) / (2.0 * mu * G) + stick * stick / (mu * G);
        close(&format!("way, {settings}"), last(&outcome)[1], way, 3e-8);
        // where the clamp is reached the run has an event
        let time = (2.0 - stick) / (mu * G);
        let found = outcome.rows.iter().position(|r| r[2] <= stick * (1.0 + 1e-6)).expect("a stop");
        close(&format!("time, {settings}"), outcome.rows[found][0], time, 3e-8);
        assert!(drift(&outcome) < 1e-7, "{settings}: {}", drift(&outcome));
    }
}

#[test]
fn the_ends_of_a_guide_carry_the_moment_of_a_load_beside_it() {
    // F at b beside the axis: each end carries F b/L, so m a = F (1 − 2 µ b/L)
    for space in ["planar", "spatial"] {
        let (zero, axis, plane) = if space == "planar" { ("", "", "gravity: none") } else { (", 0", ", 0", "gravity: none") };
        let text = format!(
            "grashof: 1
name: drawer
space: {space}
{plane}
bodies:
  drawer: {{ mass: 3 kg, inertia: 0.1 kg m^2, points: {{ handle: [0, 15 cm{zero}] }} }}
joints:
  W: {{ slider: [ground, drawer.origin], axis: [1, 0{axis}], friction: {{ coulomb: 0.25, length: 40 cm }} }}
loads:
  push: {{ at: drawer.handle, force: [6 N, 0 N{zero_n}] }}
start: {{ W.velocity: 0.1 m/s }}
studies:
  open: {{ dynamics: {{ until: 1 s, tolerance: 1e-11 }}, columns: [time, W.position, W.velocity, W.friction] }}
",
            zero_n = if space == "planar" { "" } else { ", 0 N" }
        );
        let outcome = done(&text, "open");
        let friction = 2.0 * 0.25 * 6.0 * 0.15 / 0.4;
        close(&format!("friction, {space}"), last(&outcome)[3], -friction, 1e-9);
        close(&format!("v, {space}"), last(&outcome)[2], 0.1 + (6.0 - friction) / 3.0, 1e-8);
    }
}

/// A rotor of 4 kg and J = 0.05 kg m² about its pin, the centre of mass at `offset` from it.
fn rotor(space: &str, gravity: f64, offset: f64, friction: &str, settings: &str) -> String {
    let (zero, axis) = if space == "planar" { ("", "") } else { (", 0", ", axis: [0, 0, 1]") };
    let own = 0.05 - 4.0 * offset * offset;
    let inertia = if space == "planar" { format!("{own} kg m^2") } else { format!("[0.05 kg m^2, 0.05 kg m^2, {own} kg m^2]") };
    format!(
        "grashof: 1
name: rotor
space: {space}
gravity: [0, -{gravity} m/s^2{zero}]
bodies:
  rotor: {{ mass: 4 kg, com: [{offset} m, 0{zero}], inertia: {inertia} }}
joints:
  O: {{ revolute: [ground, rotor.origin]{axis}, friction: {{ {friction} }} }}
start: {{ O.omega: 20 rad/s }}
studies:
  spin: {{ dynamics: {{ until: 0.5 s, every: 10 ms, {settings} }}, columns: [time, O.angle, O.omega, O.friction] }}
"
    )
}

#[test]
fn a_journal_spins_down_linearly_under_its_weight() {
    // J ω' = −µ r m g
    let slope = 0.1 * 0.02 * 4.0 * G / 0.05;
    for space in ["planar", "spatial"] {
        let outcome = done(&rotor(space, G, 0.0, "coulomb: 0.1, radius: 2 cm", "tolerance: 1e-10"), "spin");
        for row in &outcome.rows {
            close(&format!("omega, {space}"), row[2], 20.0 - slope * row[0], 1e-8);
        }
        assert!(drift(&outcome) < 1e-9, "{space}: {}", drift(&outcome));
    }
}

#[test]
fn an_unbalanced_journal_spins_down_by_its_own_centrifugal_force() {
    // without gravity F = m ρ √(ω⁴ + ω'²), so ω' = −k ω² with k = c/√(1 − c²), c = µ r m ρ/J: ω = ω₀/(1 + k ω₀ t)
    let c = 0.4 * 0.05 * 4.0 * 0.02 / 0.05;
    let k = c / f64::sqrt(1.0 - c * c);
    for (settings, tolerance) in SCHEMES {
        for coordinates in ["joint", "minimal"] {
            let of = format!("{settings}, coordinates: {coordinates}");
            let outcome = done(&rotor("planar", 0.0, 0.02, "coulomb: 0.4, radius: 5 cm", &of), "spin");
            for row in outcome.rows.iter().step_by(10) {
                close(&format!("omega, {of}"), row[2], 20.0 / (1.0 + k * 20.0 * row[0]), 30.0 * tolerance);
            }
        }
    }
}

/// The apparatus of Painlevé and Klein: two sliders on parallel rails joined by a rod, one of them with friction.
fn painleve(mu: f64, study: &str) -> String {
    format!(
        "grashof: 1
name: two sliders and a rod
space: planar
gravity: none
ground: {{ A: [0, 0], B: [0, 20 cm] }}
bodies:
  one: {{ mass: 1 kg, inertia: 1e-3 kg m^2 }}
  two: {{ mass: 1 kg, inertia: 1e-3 kg m^2 }}
joints:
  A: {{ slider: [ground.A, one.origin], axis: [1, 0], friction: {{ coulomb: {mu} }} }}
  B: {{ slider: [ground.B, two.origin], axis: [1, 0] }}
  R: {{ distance: [one.origin, two.origin], length: 25 cm }}
loads:
  brake: {{ at: one.origin, force: [-4 N, 0 N] }}
start: {{ A.position: 0 m, A.velocity: 3 m/s, B.position: ~15 cm }}
studies:
  slide: {{ {study}, columns: [time, A.velocity, A.friction] }}
"
    )
}

#[test]
fn two_sliders_and_a_rod_obey_painleves_formula_and_jam_where_it_has_no_solution() {
    // N = m₂ |a| tan φ with tan φ = 4/3, so (m₁ + m₂ − µ m₂ tan φ) a = P; no a < 0 solves it for µ tan φ > 2
    let dynamics = |settings: &str| format!("dynamics: {{ until: 0.2 s, {settings} }}");
    for (settings, tolerance) in &SCHEMES[..5] {
        let outcome = done(&painleve(0.6, &dynamics(settings)), "slide");
        let a = -4.0 / (2.0 - 0.6 * 4.0 / 3.0);
        close(settings, last(&outcome)[1], 3.0 + 0.2 * a, 10.0 * tolerance);
        close("friction", last(&outcome)[2], 0.6 * 4.0 / 3.0 * a, 1e-6);
    }
    for coordinates in ["joint", "minimal"] {
        let text = painleve(1.6, &dynamics(&format!("coordinates: {coordinates}")));
        let told = match tried(&text, "slide") {
            Err(failure) => failure.reason().to_string(),
            Ok(outcome) => outcome.stopped.expect("a reason"),
        };
        assert!(told.contains("jams") || told.contains("friction"), "{coordinates}: {told}");
    }
}

#[test]
fn a_coefficient_asks_for_what_it_acts_on() {
    // the size of the friction is a function of the rows of the joint alone: it stays off the tree
    let m = model(&incline("coulomb: 0.2", "W.velocity: 0 m/s", 1.0, "tolerance: 1e-8"), Some("slide"));
    assert!(m.joints[0].friction.as_ref().is_some_and(|f| f.pressed.is_some() && f.bristle.is_none()));
}

/// A bar on a rough pin, released at rest where its weight is more than the pin can hold: it swings at once, and comes to rest.
#[test]
fn a_bar_on_a_rough_pin_starts_from_rest() {
    for settings in ["tolerance: 1e-8", "integrator: bdf", "integrator: radau5", "coordinates: minimal", "coordinates: cartesian"] {
        let text = format!(
            "grashof: 1
name: rough pin
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ bar: {{ bar: {{ length: 10 cm, mass: 1 kg }} }} }}
joints: {{ P: {{ revolute: [ground, bar.start], friction: {{ coulomb: 0.3, radius: 1 cm }} }} }}
start: {{ P.angle: -60 deg }}
studies: {{ s: {{ dynamics: {{ until: 20 ms, every: 20 ms, {settings} }}, columns: [time, P.angle, P.omega] }} }}
"
        );
        // at first α = (m g l/2 cos φ − µ r N)/(m l²/3), where N hangs on α itself: radially m g sin φ, across m (g cos φ − α l/2)
        let (m, l, g, mr) = (1.0, 0.1, 9.81, 0.3 * 0.01);
        let (c, s) = (0.5, 0.75_f64.sqrt());
        let mut a = 0.0;
        for _ in 0..50 {
            let n = m * (g * s).hypot(g * c - 0.5 * a * l);
            a = (0.5 * m * g * l * c - mr * n) / (m * l * l / 3.0);
        }
        let outcome = done(&text, "s");
        let speed = -last(&outcome)[2];
        // over 20 ms the angle changes by 0.7 per cent of a radian
        assert!((speed / (a * 0.02) - 1.0).abs() < 0.02, "{settings}: {speed} {}", a * 0.02);
    }
}
