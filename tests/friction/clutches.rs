//! Clutches, brakes and one-way clutches against motions that are known in closed form, in all schemes and coordinates.

use super::closed_forms::SCHEMES;
use super::{close, done, drift, forms, last, march, tried};

#[test]
fn a_clutch_brings_two_wheels_to_one_speed_and_slips_again() {
    let text = |settings: &str| {
        format!(
            "grashof: 1
name: clutch
space: planar
gravity: none
ground: {{ A: [0, 0], B: [1 m, 0] }}
bodies: {{ engine: {{ mass: 1 kg, inertia: 2 kg m^2 }}, car: {{ mass: 1 kg, inertia: 6 kg m^2 }} }}
joints: {{ A: {{ revolute: [ground.A, engine.origin] }}, B: {{ revolute: [ground.B, car.origin] }} }}
clutches: {{ main: {{ between: [A, B], torque: \"if(t < 1 s, 0 N m, 30 N m)\" }} }}
loads: {{ hill: {{ joint: B, torque: \"if(t < 4 s, 0 N m, -60 N m)\" }} }}
start: {{ A.omega: 40 rad/s, B.omega: 0 rad/s }}
studies:
  run: {{ dynamics: {{ until: 5 s, every: 10 ms, {settings} }}, columns: [time, A.omega, B.omega, main.torque, main.slip],
    scalars: {{ nearly: \"first(time > 1 s and A.omega - B.omega < 0.1 rad/s)\" }} }}
"
        )
    };
    for (of, tolerance) in forms() {
        let outcome = done(&text(&of), "run");
        // the condition switches in the same instant as the torque
        close("nearly joined", outcome.scalars[0], 1.0 + 39.9 / 20.0, 1e-5);
        // slip 40 falls by 30/2 + 30/6 = 20 rad/s²: joined at 3 s with 10 rad/s; from 4 s on the hill asks 60·2/8 = 15 N m
        for row in &outcome.rows {
            let t = row[0];
            let torque = match t {
                t if t < 1.0 - 1e-9 => 0.0,
                t if t > 1.0 + 1e-9 && t < 3.0 - 1e-6 => 30.0,
                t if t > 3.0 + 1e-6 && t < 4.0 - 1e-9 => 0.0,
                t if t > 4.0 + 1e-9 => 15.0,
                _ => continue,
            };
            close(&format!("torque at {t}, {of}"), row[3], torque, 1e-6);
        }
        close(&format!("speed, {of}"), last(&outcome)[2], 10.0 - 60.0 / 8.0, 100.0 * tolerance);
        close("joined", last(&outcome)[4], 0.0, 1e-12);
    }
}

#[test]
fn a_one_way_clutch_drives_and_is_overrun() {
    let text = |settings: &str| {
        format!(
            "grashof: 1
name: one-way clutch
space: planar
gravity: none
ground: {{ A: [0, 0], B: [1 m, 0] }}
bodies: {{ pedal: {{ mass: 1 kg, inertia: 1 kg m^2 }}, wheel: {{ mass: 1 kg, inertia: 3 kg m^2 }} }}
joints: {{ A: {{ revolute: [ground.A, pedal.origin] }}, B: {{ revolute: [ground.B, wheel.origin] }} }}
clutches: {{ hub: {{ between: [A, B], one_way: true }} }}
loads: {{ foot: {{ joint: A, torque: 8 N m*cos(1 rad/s*t) }} }}
start: {{ A.omega: 0 rad/s, B.omega: 0 rad/s }}
studies:
  run: {{ dynamics: {{ until: 6 s, every: 10 ms, {settings} }}, columns: [time, A.omega, B.omega, hub.torque, hub.slip] }}
"
        )
    };
    for (of, tolerance) in forms() {
        let outcome = done(&text(&of), "run");
        // together with 8/4 sin t until the foot pulls back at π/2, then the wheel turns on with 2 rad/s; the pedal, alone with 8 sin t
        // less what it had, catches up where 2 + 8 (sin t − 1) = 2: at 2π + π/2, behind the end
        for row in &outcome.rows {
            let t = row[0];
            let (pedal, wheel) = if t <= std::f64::consts::FRAC_PI_2 { (2.0 * t.sin(), 2.0 * t.sin()) } else { (8.0 * t.sin() - 6.0, 2.0) };
            close(&format!("pedal at {t}, {of}"), row[1], pedal, 100.0 * tolerance);
            close(&format!("wheel at {t}, {of}"), row[2], wheel, 100.0 * tolerance);
            assert!(row[4] > -1e-8 && row[3] > -1e-8, "{of}: {row:?}");
        }
    }
}

#[test]
fn a_wheel_that_is_hit_against_its_one_way_clutch_stops_at_once() {
    let text = "grashof: 1
name: backstop
space: planar
gravity: none
bodies: { wheel: { mass: 1 kg, inertia: 3 kg m^2 } }
joints: { A: { revolute: [ground, wheel.origin] } }
clutches: { back: { joint: A, one_way: true } }
start: { A.omega: -2 rad/s }
studies: { run: { dynamics: { until: 1 s, every: 0.1 s }, columns: [time, A.omega] } }
";
    assert_eq!(last(&done(text, "run"))[1], 0.0);
}

/// A of 1 kg m² and B of 2 kg m² with a one-way clutch, a stop of B at 0.1 rad.
fn driven_into_a_stop(settings: &str, e: f64, [a, b]: [f64; 2], loads: &str, until: f64) -> String {
    format!(
        "grashof: 1
name: one-way clutch before a stop
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: 1 kg m^2 }}, b: {{ mass: 1 kg, inertia: 2 kg m^2 }} }}
joints: {{ A: {{ revolute: [ground, a.origin] }}, B: {{ revolute: [ground, b.origin], limits: {{ to: 0.1 rad, restitution: {e} }} }} }}
clutches: {{ w: {{ between: [A, B], one_way: true }} }}
{loads}start: {{ A.omega: {a} rad/s, B.omega: {b} rad/s }}
studies:
  d:
    dynamics: {{ until: {until} s, every: 10 ms, {settings} }}
    columns: [time, A.omega, B.omega, w.slip, w.torque, B.stop, energy.kinetic]
"
    )
}

const FORMS: [&str; 4] = [
    "tolerance: 1e-10",
    "coordinates: cartesian, tolerance: 1e-10",
    "coordinates: minimal, tolerance: 1e-10",
    "integrator: radau5, tolerance: 1e-10",
];

/// A closed clutch is a rigid link at a blow that it has to pass on; one that is open closes while the stop is compressed or gives back.
#[test]
fn a_one_way_clutch_passes_on_the_blow_of_a_stop() {
    for settings in FORMS {
        for e in [0.0, 0.4, 1.0] {
            // closed: both are thrown back with e
            let closed = done(&driven_into_a_stop(settings, e, [1.0, 1.0], "", 0.3), "d");
            let what = format!("e = {e}, {settings}");
            for (speed, right) in last(&closed)[1..4].iter().zip([-e, -e, 0.0]) {
                close(&format!("closed, {what}"), *speed, right, 1e-12);
            }
            close(&format!("taken, {what}"), march(&closed).stops, -1.5 * (1.0 - e * e), 1e-12);
            assert!(drift(&closed) < 1e-12, "{what}: {}", drift(&closed));
            // open, at 0.5 rad/s: compressed until both stand, by 2 + 0.5 N m s, of which e comes back on both
            let open = done(&driven_into_a_stop(settings, e, [0.5, 1.0], "", 0.3), "d");
            for (speed, right) in last(&open)[1..4].iter().zip([-2.5 * e / 3.0, -2.5 * e / 3.0, 0.0]) {
                close(&format!("open, {what}"), *speed, right, 1e-12);
            }
            // at −2 rad/s: nothing is passed on
            let idle = done(&driven_into_a_stop(settings, e, [-2.0, 1.0], "", 0.3), "d");
            for (speed, right) in last(&idle)[1..4].iter().zip([-2.0, -e, 2.0 - e]) {
                close(&format!("idle, {what}"), *speed, right, 1e-12);
            }
        }
    }
}

/// What closes at a speed takes that of a plastic blow, which is in the balance.
#[test]
fn the_blow_of_a_one_way_clutch_is_in_the_balance() {
    for settings in FORMS {
        let outcome = done(&driven_into_a_stop(settings, 0.4, [3.0, 0.0], "", 0.3), "d");
        // 3 N m s turn both with 1 rad/s, which the stop throws back
        close(&format!("clutch, {settings}"), march(&outcome).dampers, 0.5 * 3.0 - 0.5 * 9.0, 1e-12);
        close(&format!("stop, {settings}"), march(&outcome).stops, -1.5 * (1.0 - 0.16), 1e-12);
        close(&format!("speed, {settings}"), last(&outcome)[2], -0.4, 1e-12);
        assert!(drift(&outcome) < 1e-12, "{settings}: {}", drift(&outcome));
    }
}

/// A torque on A presses B on its stop through the clutch: blows that die away like those of a ball, rest, and where the torque turns A leaves.
#[test]
fn what_a_one_way_clutch_presses_on_a_stop_comes_to_rest_there() {
    for settings in FORMS {
        let loads = "loads: { p: { joint: A, torque: \"if(t < 1 s, 20 N m, -20 N m)\" } }\n";
        let outcome = done(&driven_into_a_stop(settings, 0.4, [1.0, 1.0], loads, 1.3), "d");
        // together 20/3 rad/s²: hits at v with v² = 1 + 2·0.1·20/3, then flights of 2 e v/(20/3) s, of which each is e times the last
        let v = (1.0_f64 + 4.0 / 3.0).sqrt();
        let rests = (v - 1.0) * 0.15 + 0.3 * v * 0.4 / 0.6;
        for row in outcome.rows.iter() {
            let &[t, a, b, slip, torque, stop, _] = row else { panic!("seven columns") };
            if t > rests + 0.01 && t < 1.0 - 1e-9 {
                for (found, right) in [a, b, slip, torque, stop].into_iter().zip([0.0, 0.0, 0.0, 20.0, -20.0]) {
                    close(&format!("{row:?}, {settings}"), found, right, 1e-9);
                }
            } else if t > 1.0 + 1e-9 {
                close(&format!("A at {t}, {settings}"), a, -20.0 * (t - 1.0), 1e-8);
                close(&format!("B at {t}, {settings}"), b, 0.0, 1e-8);
            }
        }
        assert!(rests < 0.5 && drift(&outcome) < 1e-9, "{settings}: {}", drift(&outcome));
    }
}

/// The slip of a clutch that sticks is 0, in columns and in what is compared with it.
#[test]
fn the_slip_of_a_closed_clutch_is_zero() {
    for (of, tolerance) in forms() {
        let text = format!(
            "grashof: 1
name: load by the slip of a closed clutch
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: 1 kg m^2 }}, b: {{ mass: 1 kg, inertia: 2 kg m^2 }}, c: {{ mass: 1 kg, inertia: 3 kg m^2 }}, d: {{ mass: 1 kg }} }}
joints:
  A: {{ revolute: [ground, a.origin] }}
  B: {{ revolute: [ground, b.origin] }}
  C: {{ revolute: [ground, c.origin] }}
  X: {{ slider: [ground, d.origin], axis: [1, 0] }}
clutches: {{ k: {{ between: [A, B], torque: 10 N m }}, l: {{ between: [C, B], torque: 1 kN m }} }}
loads: {{ p: {{ joint: A, torque: 2 N m }}, w: {{ joint: X, force: \"if(k.slip < 0, 5 N, 1 N) + if(l.slip == 0, 0 N, 100 N)\" }} }}
measures: {{ both: A.omega - C.omega }}
start: {{ A.omega: 10 rad/s, B.omega: 0 rad/s, C.omega: 0 rad/s }}
studies:
  d: {{ dynamics: {{ until: 4 s, every: 0.1 s, {of} }}, columns: [time, k.slip, l.slip, both, X.velocity], scalars: {{ neg: integral(k.slip < 0) }} }}
"
        );
        // −10 rad/s that rise by 10/5 + 8 rad/s²: closed from 1 s on
        let outcome = done(&text, "d");
        close(&format!("slips, {of}"), outcome.scalars[0], 1.0, 100.0 * tolerance);
        close(&format!("load, {of}"), last(&outcome)[4], 5.0 + 3.0, 100.0 * tolerance);
        for row in outcome.rows.iter().filter(|row| row[0] > 1.01) {
            assert_eq!(row[1..4], [0.0; 3], "at {} s, {of}", row[0]);
        }
        assert!(outcome.rows.iter().all(|row| row[2] == 0.0), "{of}");
        let march = march(&outcome);
        assert_eq!(march.counts.unresolved, 0, "{of}");
    }
}

#[test]
fn two_brakes_on_one_shaft_hold_together() {
    let text = "grashof: 1
name: two brakes
space: planar
gravity: none
bodies: { wheel: { mass: 1 kg, inertia: 1 kg m^2 } }
joints: { A: { revolute: [ground, wheel.origin] } }
clutches:
  one: { joint: A, torque: 2 N m }
  other: { joint: A, torque: 3 N m }
loads: { turn: { joint: A, torque: 1 N m/s*t } }
measures: { both: one.torque + other.torque }
start: { A.omega: 0 rad/s }
studies: { run: { dynamics: { until: 7 s, every: 10 ms }, columns: [time, A.omega, both] } }
";
    let outcome = done(text, "run");
    for row in &outcome.rows {
        let t = row[0];
        close("speed", row[1], if t < 5.0 { 0.0 } else { 0.5 * (t - 5.0).powi(2) }, 1e-8);
        close("together", row[2], -t.min(5.0), 1e-6);
    }
    assert!(outcome.findings.iter().any(|f| f.code == "friction-not-unique"));
}

#[test]
fn a_one_way_clutch_whose_sides_drivers_keep_at_one_rate_may_carry_anything() {
    let text = |law: &str, kind: &str| {
        format!(
            "grashof: 1
name: shafts
space: planar
gravity: [0, -9.81]
ground: {{ B: [3, 0] }}
bodies: {{ a: {{ bar: {{ length: 1, mass: 2 }} }}, b: {{ bar: {{ length: 0.8, mass: 1 }} }} }}
joints: {{ A: {{ revolute: [ground, a.start] }}, B: {{ revolute: [ground.B, b.start] }} }}
clutches: {{ c: {{ between: [A, B], one_way: true }} }}
start: {{ A.angle: 0 rad, B.angle: 0 rad }}
drivers: {{ dA: {{ joint: A, angle: 2 rad/s*t }}, dB: {{ joint: B, angle: {law} }} }}
studies: {{ run: {{ {kind}, columns: [c.torque, dA.torque] }} }}
"
        )
    };
    let told_by = |kind: &str, law: &str| {
        let finding = done(&text(law, kind), "run").findings.iter().find(|f| f.code == "friction-not-unique").map(|f| f.message.clone());
        finding.unwrap_or_default()
    };
    let told = |law: &str| told_by("inverse: { over: 2 s, samples: 10 }", law);
    assert_eq!(told("\"2 rad/s*t + 0.1 rad/s^2*t^2\""), "");
    assert!(told("2 rad/s*t").starts_with("from time = 0 s to 2 s the drivers keep both sides"), "{}", told("2 rad/s*t"));
    let half = told("\"if(t < 1 s, 2 rad/s*t, 2 rad/s*t + 0.1 rad/s^2*(t - 1 s)^2)\"");
    assert!(half.starts_with("from time = 0 s to 1 s the drivers"), "{half}");

    let in_time = |law: &str| told_by("dynamics: { until: 2 s, every: 0.2 s }", law);
    assert_eq!(in_time("\"2 rad/s*t + 0.1 rad/s^2*t^2\""), "");
    assert!(in_time("2 rad/s*t").starts_with("while its sides go at one rate"), "{}", in_time("2 rad/s*t"));
}

/// The arm stands by its one-way clutch a rounding away from where it began, until the clutch lets it go.
#[test]
fn implicit_schemes_let_go_what_stands_beside_its_start() {
    let text = |integrator: &str, tolerance: f64| {
        format!(
            "grashof: 1
name: arms
space: planar
gravity: [0, -9.81]
bodies:
  b0: {{ bar: {{ length: 0.4324227252050319, mass: 1.7586612009990488 }} }}
  b1: {{ bar: {{ length: 0.6477176260931972, mass: 1.4238470743500342 }} }}
joints:
  J0: {{ revolute: [ground, b0.start], damping: 0.2311588869536013 }}
  J1: {{ revolute: [b0.end, b1.start] }}
springs: {{ s0: {{ joint: J0, stiffness: 11.270388595324508 }} }}
loads:
  l0: {{ joint: J0, torque: 7.04657958208916*sin(13.898295532682882 rad/s*t + 5.3738706423498375) *1 N m - 1.938892237064148 N m }}
  l1: {{ joint: J1, torque: 5.598162624619551*sin(14.425205029380496 rad/s*t + 1.8339960438800822) *1 N m + 0.7879529678463335 N m }}
clutches:
  c0: {{ joint: J1, torque: 5.934866229174209 N m*(1 + 0.5*sin(7.201825915500017 rad/s*t)) }}
  c1: {{ joint: J0, one_way: true }}
start:
  J0.angle: -0.4583275689227526
  J0.omega: -2.462832175065078
  J1.angle: -0.3258255542664852
  J1.omega: 1.3413803571638212
studies:
  run:
    dynamics: {{ until: 2 s, every: 20 ms, tolerance: {tolerance:e}, integrator: {integrator} }}
    columns: [time, J0.angle, J1.angle]
"
        )
    };
    let end = |integrator: &str, tolerance: f64| last(&done(&text(integrator, tolerance), "run")).to_vec();
    let right = end("dop853", 1e-11);
    for (integrator, tolerance, within) in [("bdf", 1e-9, 1e-5), ("bdf", 1e-8, 1e-4), ("radau5", 1e-8, 1e-5)] {
        let found = end(integrator, tolerance);
        close(integrator, found[1], right[1], within);
        close(integrator, found[2], right[2], within);
    }
}

#[test]
fn a_clutch_says_what_is_wrong_with_it() {
    let text = "grashof: 1
name: wheel
space: planar
gravity: none
bodies: { wheel: { mass: 1 kg, inertia: 3 kg m^2 } }
joints: { A: { revolute: [ground, wheel.origin] } }
drivers: { go: { joint: A, speed: -1 rad/s } }
clutches: { back: { joint: A, one_way: true } }
studies: { run: { dynamics: { until: 1 s, every: 0.1 s }, columns: [time, A.omega] } }
";
    let failure = tried(text, "run").expect_err("a driver turns it the wrong way");
    assert!(failure.reason().contains("clutch `back`"), "{}", failure.reason());
}

#[test]
fn a_brake_shoe_on_a_lever_helps_itself_in_one_sense() {
    // band of 2 kg, lever with F = 10 N at 0.4 m, shoe at b = 0.2 m, its pin c = 0.1 m above the band: N (b ± µ c) = F L
    let (mu, b, c, mass) = (0.5, 0.2, 0.1, 2.0);
    for (speed, settings, tolerance) in SCHEMES.iter().flat_map(|(s, t)| [(1.0, s, t), (-1.0, s, t)]) {
        let text = format!(
            "grashof: 1
name: shoe brake
space: planar
gravity: none
ground: {{ P: [0, {c} m] }}
bodies:
  band: {{ mass: {mass} kg, inertia: 1 kg m^2 }}
  lever: {{ mass: 1e-3 kg, inertia: 1e-5 kg m^2, points: {{ pin: [{b} m, -{c} m], hand: [0.4 m, 0 m] }} }}
  shoe: {{ mass: 1e-3 kg, inertia: 1e-6 kg m^2 }}
joints:
  G: {{ slider: [ground, band.origin], axis: [1, 0] }}
  P: {{ revolute: [ground.P, lever.origin] }}
  E: {{ revolute: [lever.pin, shoe.origin] }}
  S: {{ slider: [band.origin, shoe.origin], axis: [1, 0], friction: {{ coulomb: {mu} }} }}
loads: {{ hand: {{ at: lever.hand, force: [0 N, -10 N] }} }}
start: {{ G.position: 0 m, G.velocity: {speed} m/s }}
studies:
  run: {{ dynamics: {{ until: 0.8 s, every: 10 ms, {settings} }}, columns: [time, G.position, G.velocity, S.f] }}
"
        );
        let normal: f64 = 10.0 * 0.4 / (b + speed * mu * c);
        let stops = mass / (mu * normal);
        let outcome = done(&text, "run");
        let sliding = outcome.rows.iter().find(|row| row[0] > 0.5 * stops).unwrap();
        close(&format!("normal force, {speed} {settings}"), sliding[3].abs(), normal, 1e-6);
        close(&format!("way, {speed} {settings}"), last(&outcome)[1], speed * 0.5 * stops, 50.0 * tolerance);
        close("at rest", last(&outcome)[2], 0.0, 1e-12);
    }
}

#[test]
fn a_rope_on_a_drum_holds_up_to_the_exponential_of_its_angle() {
    // Euler and Eytelwein: the load pulls with up to T e^(µ θ) against the tension T of the spring behind the drum
    let (stiffness, stretch, angle, mu): (f64, f64, f64, f64) = (100.0, 0.1, 3.0 * std::f64::consts::PI, 0.2);
    let text = format!(
        "grashof: 1
name: capstan
space: planar
gravity: none
parameters: {{ mu: {mu}, turn: {angle} rad, stiffness: {stiffness} N/m }}
bodies: {{ rope: {{ mass: 0.5 kg, inertia: 1 kg m^2 }} }}
joints: {{ R: {{ slider: [ground, rope.origin], axis: [1, 0] }} }}
springs: {{ behind: {{ joint: R, stiffness: stiffness, rest: -{stretch} m }} }}
clutches: {{ drum: {{ joint: R, force: \"stiffness*behind.stretch*(exp(mu*turn/1 rad) - 1)\" }} }}
loads: {{ pull: {{ joint: R, force: 20 N/s*t }} }}
start: {{ R.position: 0 m, R.velocity: 0 m/s }}
studies:
  run: {{ dynamics: {{ until: 5 s, tolerance: 1e-10 }}, columns: [time, R.position, R.velocity, behind.force, drum.force] }}
"
    );
    let outcome = done(&text, "run");
    let slips = stiffness * stretch * (mu * angle).exp() / 20.0;
    let first = outcome.switches.first().map(|i| outcome.places[*i]).expect("it slips");
    close("when it slips", first, slips, 1e-7);
    for row in outcome.rows.iter().filter(|row| row[0] < slips - 1e-6) {
        close("it rests", row[1], 0.0, 1e-15);
        close("held", row[4], stiffness * stretch - 20.0 * row[0], 1e-9);
    }
}
