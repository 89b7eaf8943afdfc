//! Events, end stops, dry friction and states against closed forms.

use super::{certified, doubled, scalar};
use crate::reference::program::{Run, Table, run_text};
use crate::reference::{Verdict, number};
use std::f64::consts::{FRAC_PI_2, PI};

/// Runs a planar model of one study `run`.
fn done(text: &str) -> (Run, Table) {
    let run = run_text(&format!("grashof: 1\nname: test\nspace: planar\n{text}"), &["--no-plots"]).succeeded();
    let table = run.table("run");
    (run, table)
}

/// A mass of 1 kg on a slider along y, with events, thrown or dropped under 10 m/s².
fn ball(start: &str, events: &str, study: &str) -> (Run, Table) {
    done(&format!(
        "gravity: [0, -10 m/s^2]
parameters: {{ e: 0.8, count: 0 }}
bodies: {{ ball: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, ball.origin], axis: [0, 1] }} }}
start: {{ {start} }}
measures: {{ counted: count }}
events:
{events}
studies:
  run:
    dynamics: {study}
    columns: [time, S.position, S.velocity, counted, energy]
"
    ))
}

/// Impacts of a mass that falls from 5 m under 10 m/s²: after 1 s, then each flight takes 2 eⁿ s.
fn impacts(e: f64, until: f64) -> Vec<f64> {
    let mut all = vec![1.0];
    let mut flight = 2.0 * e;
    while all.last().unwrap() + flight < until {
        all.push(all.last().unwrap() + flight);
        flight *= e;
    }
    all
}

/// Every impact stands among the doubled rows, with its speed on both sides.
fn bounces(until: f64) {
    let events = "  knock: { when: S.position, crossing: falling, restitution: { joint: S, e: e } }";
    let study = format!("{{ until: {until} s, every: 20 ms, tolerance: 1e-10 }}");
    let (run, table) = ball("S.position: 5 m, S.velocity: 0 m/s", events, &study);
    let mut verdict = Verdict::default();
    let times = doubled(&table);
    let (sides, v) = (table.sides(), table.column("S.velocity"));
    for (n, right) in impacts(0.8, until).into_iter().enumerate() {
        let found = times.iter().copied().min_by(|a, b| (a - right).abs().total_cmp(&(b - right).abs())).unwrap_or(f64::NAN);
        verdict.close(&format!("impact {n}"), "", found, right, 1e-9);
        let row = (0..sides.len()).find(|i| sides[*i] < 0 && table.rows[*i][0] == found && v[*i] < 0.0);
        let Some(row) = row else { continue };
        let speed = 10.0 * 0.8_f64.powi(i32::try_from(n).unwrap());
        verdict.close(&format!("speed before impact {n}"), "", v[row], -speed, 1e-8);
        verdict.close(&format!("speed after impact {n}"), "", v[row + 1], 0.8 * speed, 1e-8);
    }
    let lowest = table.column("S.position").into_iter().fold(f64::INFINITY, f64::min);
    verdict.close("lowest position", "", lowest, 0.0, 1e-9);
    let count = i32::try_from(impacts(0.8, until).len()).unwrap();
    let taken = 50.0 * (0.8_f64.powi(2 * count) - 1.0);
    verdict.close("energy taken by impacts", "", certified(&run, "run", "work_impacts"), taken, 1e-7);
    verdict.give(&format!("bouncing until {until} s"));
}

#[test]
fn a_mass_bounces_in_time() {
    bounces(2.0);
    bounces(6.0);
    bounces(8.5);
}

#[test]
fn an_event_is_not_missed_between_steps() {
    // thrown up at 5 m/s the mass is above 1.2 m between 0.4 and 0.6 s alone, and no force makes the steps short
    let mut verdict = Verdict::default();
    for height in [1.0_f64, 1.2, 1.24, 1.2499] {
        let events =
            format!("  low: {{ when: S.position - 1.1 m }}\n  high: {{ when: S.position - {height} m, crossing: rising, action: stop }}");
        for control in ["tolerance: 1e-10", "tolerance: 1e-3", "step: 0.35 s, integrator: rk4", "step: 0.5 s, integrator: newmark"] {
            let (_, table) = ball("S.position: 0 m, S.velocity: 5 m/s", &events, &format!("{{ until: 10 s, {control} }}"));
            let end = table.rows.last().unwrap();
            let right = 0.5 - (0.25 - height / 5.0).sqrt();
            verdict.close(&format!("stop at {height} m with {control}"), "its time", end[0], right, 1e-7);
        }
    }
    verdict.give("events inside of steps");
}

#[test]
fn impact_and_new_parameters_at_the_same_event() {
    let events = "  knock: { when: S.position, crossing: falling, restitution: { joint: S, e: 0.8 }, set: { count: count + 1 } }";
    let (_, table) = ball("S.position: 5 m, S.velocity: 0 m/s", events, "{ until: 4 s, every: 20 ms, tolerance: 1e-10 }");
    let counted = table.column("counted");
    assert_eq!(counted.last(), Some(&3.0), "impacts at 1, 2.6 and 3.88 s");
    assert!(table.column("S.position").iter().all(|y| *y > -1e-9));
}

/// The pendulum of the model library: from rest at 90 degrees.
fn pendulum(events: &str, study: &str) -> (Run, Table) {
    done(&format!(
        "gravity: [0, -9.81 m/s^2]
bodies: {{ rod: {{ bar: {{ length: 1 m }}, attached: {{ bob: {{ at: end, mass: 1 kg }} }} }} }}
joints: {{ P: {{ revolute: [ground, rod.start] }} }}
start: {{ P.angle: 180 deg, P.omega: 0 rad/s }}
measures: {{ phi: P.angle - 270 deg }}
events:
{events}
studies:
  run:
    dynamics: {study}
    columns: [time, phi, P.omega, energy]
"
    ))
}

/// 4 K(1/2)/√g.
const PERIOD: f64 = 2.367_841_947_576_237_4;

#[test]
fn a_pendulum_passes_and_turns_in_time() {
    let events = "  bottom: { when: phi }\n  turning: { when: P.omega, crossing: falling, action: record }";
    let (_, table) = pendulum(events, "{ until: 5 s, every: 50 ms, tolerance: 1e-11 }");
    let found = doubled(&table);
    let mut verdict = Verdict::default();
    for quarters in [1.0, 2.0, 3.0, 5.0, 6.0, 7.0] {
        let right = 0.25 * quarters * PERIOD;
        let nearest = found.iter().copied().min_by(|a, b| (a - right).abs().total_cmp(&(b - right).abs())).unwrap_or(f64::NAN);
        verdict.close("passage", format_args!("{quarters} quarters"), nearest, right, 1e-9);
    }
    verdict.give("passages");
}

#[test]
fn a_pendulum_knocks_at_a_wall() {
    let events = "  wall: { when: phi, crossing: rising, restitution: { joint: P, e: 0.5 } }";
    let (_, table) = pendulum(events, "{ until: 2 s, every: 10 ms, tolerance: 1e-11 }");
    let (sides, omega, energy) = (table.sides(), table.column("P.omega"), table.column("energy.total"));
    let mut verdict = Verdict::default();
    let i = sides.iter().position(|s| *s < 0).expect("an impact");
    let speed = (2.0 * 9.81_f64).sqrt();
    verdict.close("time", "the wall", table.rows[i][0], 0.25 * PERIOD, 1e-9);
    verdict.close("rate", "before", omega[i], speed, 1e-9);
    verdict.close("rate", "after", omega[i + 1], -0.5 * speed, 1e-9);
    // afterwards a quarter of the kinetic energy swings to and fro on one side
    verdict.close("energy", "afterwards", energy[i + 2], 9.81 * (0.25 - 1.0), 1e-9);
    let lowest = table.column("phi").into_iter().skip(i + 1).fold(f64::INFINITY, f64::min);
    verdict.close("turning angle", "", lowest, -(1.0_f64 - 0.25).acos(), 1e-3);
    verdict.give("wall");
}

#[test]
fn a_brake_that_an_event_switches_on() {
    let (run, table) = done(
        "gravity: none
parameters: { brake: 0 N m, spin: 10 rad/s }
bodies: { wheel: { inertia: 0.2 kg m^2 } }
joints: { O: { revolute: [ground, wheel.origin] } }
loads: { drag: { joint: O, torque: -brake } }
start: { O.angle: 0 rad, O.omega: spin }
events:
  on: { when: O.angle - 5 rad, crossing: rising, set: { brake: 0.05*O.omega*1 N m s/rad } }
  stand: { when: O.omega, crossing: falling, action: stop }
studies:
  run:
    dynamics: { until: 20 s, every: 0.1 s, tolerance: 1e-10 }
    columns: [time, O.angle, O.omega, energy]
    scalars: { half: first(O.omega < 5 rad/s), end: last(t) }
",
    );
    let mut verdict = Verdict::default();
    // 0.5 N m from 0.5 s on: −2.5 rad/s²
    verdict.close("half the speed", "", scalar(&run, "run", "half"), 2.5, 1e-9);
    verdict.close("end", "", scalar(&run, "run", "end"), 4.5, 1e-9);
    verdict.close("angle", "the end", table.rows.last().unwrap()[1], 25.0, 1e-9);
    verdict.close("work of the brake", "", certified(&run, "run", "work_loads"), -10.0, 1e-9);
    verdict.give("brake");
}

#[test]
fn first_is_where_it_holds_to_round_off() {
    let (run, _) = done(
        "gravity: none
bodies: { mass: { mass: 1 kg } }
joints: { S: { slider: [ground, mass.origin], axis: [1, 0] } }
springs: { spring: { joint: S, stiffness: 25 N/m } }
start: { S.position: 1 m, S.velocity: 0 m/s }
studies:
  run:
    dynamics: { until: 3 s, every: 0.5 s, tolerance: 1e-12 }
    columns: [time, S.position]
    scalars:
      low: first(S.position < 0.5 m)
      fast: first(abs(S.velocity) >= 4 m/s)
      late: first(t > 1.2345 s and S.position > 0 m)
      never: first(S.position > 1.5 m)
",
    );
    let mut verdict = Verdict::default();
    verdict.close("low", "", scalar(&run, "run", "low"), 0.5_f64.acos() / 5.0, 1e-9);
    verdict.close("fast", "", scalar(&run, "run", "fast"), 0.8_f64.asin() / 5.0, 1e-9);
    // cos(5 t) is positive at 1.2345 s
    verdict.close("late", "", scalar(&run, "run", "late"), 1.2345, 1e-9);
    verdict.holds(scalar(&run, "run", "never").is_nan(), "what never holds has no instant");
    verdict.give("first");
}

#[test]
fn an_end_stop_pushes_and_lets_go() {
    let (run, table) = done(
        "gravity: none
bodies: { car: { mass: 2 kg } }
joints: { S: { slider: [ground, car.origin], axis: [1, 0], limits: { to: 10 cm, stiffness: 1000 N/m, damping: 20 N s/m } } }
start: { S.position: 0 m, S.velocity: 1 m/s }
studies:
  run:
    dynamics: { until: 0.5 s, every: 1 ms, tolerance: 1e-11 }
    columns: [time, S.position, S.velocity]
    scalars: { deepest: max(S.position) }
",
    );
    // depth d = v/ωd e^(−a τ) sin(ωd τ); the stop lets go where its force, and so d″, is 0
    let a: f64 = 5.0;
    let wd = (500.0 - a * a).sqrt();
    let leaves = (PI - (2.0 * a * wd / (wd * wd - a * a)).atan()) / wd;
    let rate = |tau: f64| (-a * tau).exp() * ((wd * tau).cos() - a / wd * (wd * tau).sin());
    let turns = (wd / a).atan() / wd;
    let deepest = 0.1 + (-a * turns).exp() * (wd * turns).sin() / wd;
    let mut verdict = Verdict::default();
    verdict.close("speed", "the end", table.rows.last().unwrap()[2], rate(leaves), 1e-8);
    verdict.close("deepest position", "", scalar(&run, "run", "deepest"), deepest, 1e-9);
    for (row, side) in table.rows.iter().zip(table.sides()) {
        let tau = row[0] - 0.1;
        let right = if tau < 0.0 { 1.0 } else { rate(tau.min(leaves)) };
        if side == 0 {
            verdict.close("speed", row[0], row[2], right, 1e-8);
        }
    }
    let times = doubled(&table);
    for right in [0.1, 0.1 + leaves] {
        verdict.holds(times.iter().any(|t| (t - right).abs() < 1e-8), format!("two rows at {right} s: {times:?}"));
    }
    verdict.give("end stop");
}

#[test]
fn dry_friction_brings_to_rest() {
    let (_, table) = done(
        "gravity: none
bodies: { car: { mass: 2 kg } }
joints: { S: { slider: [ground, car.origin], axis: [1, 0], friction: { coulomb: 4 N, stick_speed: 1 mm/s } } }
start: { S.position: 0 m, S.velocity: 1 m/s }
studies:
  run:
    dynamics: { until: 1 s, every: 10 ms, tolerance: 1e-11 }
    columns: [time, S.position, S.velocity, energy.total]
",
    );
    // −2 m/s² down to the stick speed, then an exponential of 0.5 ms
    let (slow, tau) = (1e-3, 2.0 * 1e-3 / 4.0);
    let (t1, x1) = ((1.0 - slow) / 2.0, (1.0 - slow * slow) / 4.0);
    let mut verdict = Verdict::default();
    for row in &table.rows {
        let t = row[0];
        let [x, v] = if t < t1 {
            [t - t * t, 1.0 - 2.0 * t]
        } else {
            let fade = (-(t - t1) / tau).exp();
            [x1 + slow * tau * (1.0 - fade), slow * fade]
        };
        verdict.close("position", t, row[1], x, 1e-9);
        verdict.close("speed", t, row[2], v, 1e-9);
    }
    verdict.give("dry friction");
}

#[test]
fn a_motor_with_an_inductance() {
    let (run, table) = done(
        "gravity: none
parameters: { supply: 12 V, R: 2 ohm, L: 0.4 H, k: 0.05 N m/A, rotor_inertia: 0.001 kg m^2, fan: 0.0005 N m s/rad }
bodies: { rotor: { inertia: rotor_inertia } }
joints: { O: { revolute: [ground, rotor.origin], damping: fan } }
states:
  current: { start: 0 A, rate: (supply - R*current - k*O.omega)/L }
loads: { drive: { joint: O, torque: k*current } }
start: { O.angle: 0 rad, O.omega: 0 rad/s }
measures: { current_rate: rate(current) }
studies:
  run:
    dynamics: { until: 2 s, every: 10 ms, tolerance: 1e-11 }
    columns: [time, O.omega, current, current_rate]
    scalars: { heat: 2 ohm*integral(current^2), peak: max(current) }
",
    );
    // i' = (U − R i − k ω)/L, ω' = (k i − f ω)/J: x = x∞ + e^(μ t)(C cos(ν t) + D sin(ν t))
    let [u, r, l, k, j, f]: [f64; 6] = [12.0, 2.0, 0.4, 0.05, 0.001, 0.0005];
    let (a, b) = (r / l, f / j);
    let mu = -0.5 * (a + b);
    let nu = (a * b + k * k / (l * j) - mu * mu).sqrt();
    let end_current = u * f / (r * f + k * k);
    let end_speed = k * end_current / f;
    // ω(0) = 0, ω'(0) = 0
    let (c, d) = (-end_speed, mu * end_speed / nu);
    let speed = |t: f64| end_speed + (mu * t).exp() * (c * (nu * t).cos() + d * (nu * t).sin());
    let rate = |t: f64| {
        let [cc, dd] = [mu * c + nu * d, mu * d - nu * c];
        (mu * t).exp() * (cc * (nu * t).cos() + dd * (nu * t).sin())
    };
    let current = |t: f64| (j * rate(t) + f * speed(t)) / k;
    let mut verdict = Verdict::default();
    for row in &table.rows {
        verdict.close("speed", row[0], row[1], speed(row[0]), 1e-8);
        verdict.close("current", row[0], row[2], current(row[0]), 1e-9);
        verdict.close("rate of the current", row[0], row[3], (u - r * current(row[0]) - k * speed(row[0])) / l, 1e-8);
    }
    // Simpson's rule on the closed form
    let (n, h) = (20_000, 1e-4);
    let heat: f64 =
        (0..=n).map(|i| f64::from(if i == 0 || i == n { 1 } else { 2 + 2 * (i % 2) }) * r * current(f64::from(i) * h).powi(2)).sum();
    verdict.close("heat", "", scalar(&run, "run", "heat"), heat * h / 3.0, 1e-8);
    verdict.give("motor with an inductance");
}

#[test]
fn a_fall_in_a_quarter_of_a_turn() {
    // an event and a scalar at the same instant, in all coordinates
    for coordinates in ["joint", "cartesian", "minimal"] {
        let study = format!("{{ until: 3 s, tolerance: 1e-11, coordinates: {coordinates} }}");
        let (run, table) = pendulum("  bottom: { when: phi, crossing: rising, action: stop }", &study);
        let end = table.rows.last().unwrap();
        let mut verdict = Verdict::default();
        verdict.close("time", coordinates, end[0], 0.25 * PERIOD, 1e-9);
        verdict.close("angle", coordinates, end[1], 0.0, 1e-9);
        verdict.close("rate", coordinates, end[2], (2.0 * 9.81_f64).sqrt(), 1e-9);
        let largest = number(&run.json("run"), "extrema/P.omega/max/value");
        verdict.close("largest rate", coordinates, largest, (2.0 * 9.81_f64).sqrt(), 1e-9);
        let start = table.rows[0][1];
        verdict.close("start", coordinates, start, -FRAC_PI_2, 1e-12);
        verdict.give("fall");
    }
}

/// A ball that falls on a floor, comes to rest, and is lifted: an event with a restitution is a rigid stop, in every scheme.
#[test]
fn impacts_of_an_event_come_to_rest_as_on_a_rigid_stop() {
    let mut verdict = Verdict::default();
    let schemes = [
        "integrator: dop853",
        "integrator: radau5",
        "integrator: bdf, tolerance: 1e-10",
        "integrator: rk4, step: 0.3 s",
        "integrator: generalized-alpha, tolerance: 1e-6",
        "coordinates: cartesian",
        "coordinates: minimal",
    ];
    let stop = ", limits: { from: 0 m, restitution: 0.2 }";
    let event = "events: { floor: { when: \"2*fall.position\", crossing: falling, restitution: { joint: fall, e: 0.2 } } }";
    for (name, stop, event) in [("event", "", event), ("stop", stop, "")] {
        for scheme in schemes {
            let text = format!(
                "grashof: 1
name: ball
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ ball: {{ mass: 0.5 kg, inertia: 1e-3 kg m^2 }} }}
joints: {{ fall: {{ slider: [ground, ball.origin], axis: [0, 1]{stop} }} }}
loads: {{ lift: {{ joint: fall, force: \"if(t > 1.5 s, 10 N, 0 N)\" }} }}
start: {{ fall.position: 0.5 m, fall.velocity: 0 m/s }}
{event}
studies: {{ run: {{ dynamics: {{ until: 2 s, every: 0.1 s, {scheme} }}, columns: [time, fall.position], scalars: {{ low: min(fall.position), rest: \"value(fall.position, 1.4 s)\", end: last(fall.position) }} }} }}
"
            );
            let run = run_text(&text, &["--no-plots"]).succeeded();
            // half a second of (10 N − 0.5 kg g)/0.5 kg
            let end = 0.5 * (10.0 / 0.5 - 9.81) * 0.25;
            verdict.close("end", format!("{name}, {scheme}"), scalar(&run, "run", "end"), end, 1e-9);
            verdict.close("low", format!("{name}, {scheme}"), scalar(&run, "run", "low"), 0.0, 1e-10);
            verdict.close("rest", format!("{name}, {scheme}"), scalar(&run, "run", "rest"), 0.0, 1e-10);
            if name == "event" {
                let happened = run.json("run")["certificate"]["happened"].as_array().map_or(0, Vec::len);
                // √(2·9.81·0.5) m/s by 0.2 five times is below the speed of rest
                assert_eq!(happened, 6, "{scheme}");
            }
        }
    }
    verdict.give("ball");
}

/// An event happens where its quantity has the value in the columns: energies, momenta and the centre of mass as well, for which
/// inertias must be known in world axes.
#[test]
fn events_by_energies_are_met_where_they_are() {
    let run = |asked: &str, events: &str| {
        done(&format!(
            "gravity: [0, -9.81 m/s^2]
bodies:
  a: {{ mass: 2 kg, inertia: 0.1 kg m^2, com: [0.5, 0], points: {{ end: [1, 0] }} }}
  b: {{ mass: 2 kg, inertia: 0.1 kg m^2, com: [0.5, 0] }}
joints: {{ O: {{ revolute: [ground, a.origin] }}, A: {{ revolute: [a.end, b.origin] }} }}
springs: {{ s: {{ between: [ground, b.com], force: 3 N/m*stretch + 20 N/m^3*stretch^3, length: 1.2 m }} }}
start: {{ O.angle: 0 deg, A.angle: 30 deg }}
events: {{ {events} }}
studies:
  run: {{ dynamics: {{ until: 0.3 s, every: 10 ms, tolerance: 1e-10 }}, columns: [time, {asked}] }}
"
        ))
        .1
    };
    let mut verdict = Verdict::default();
    for asked in ["energy.kinetic", "energy.potential", "s.energy", "momentum.x", "com.vy", "com.x"] {
        let value = run(asked, "").rows.iter().find(|row| (row[0] - 0.17).abs() < 1e-12).unwrap()[1];
        let unit = match asked {
            "momentum.x" => "kg m/s",
            "com.vy" => "m/s",
            "com.x" => "m",
            _ => "J",
        };
        let met = doubled(&run(asked, &format!("there: {{ when: {asked} - ({value} {unit}) }}")));
        let nearest = met.iter().copied().min_by(|x, y| (x - 0.17).abs().total_cmp(&(y - 0.17).abs())).unwrap_or(f64::NAN);
        verdict.close(&format!("event by {asked}"), "s", nearest, 0.17, 1e-8);
    }
    verdict.give("the times of events");
}

#[test]
fn events_of_one_instant_count_each() {
    let (run, table) = done(
        "gravity: none
bodies: { a: { mass: 1 kg }, b: { mass: 1 kg } }
joints: { A: { slider: [ground, a.origin], axis: [1, 0] }, B: { slider: [ground, b.origin], axis: [0, 1] } }
parameters: { n: 1 }
start: { A.velocity: 1 m/s, B.velocity: 1 m/s }
events:
  one: { when: A.position - 1 m, set: { n: n + 1 } }
  other: { when: B.position - 1 m, set: { n: 10*n } }
measures: { counted: n }
studies: { run: { dynamics: { until: 2 s, every: 0.5 s }, columns: [counted], scalars: { end: last(counted) } } }
",
    );
    assert_eq!(scalar(&run, "run", "end"), 20.0);
    assert_eq!(table.rows.last().unwrap().last(), Some(&20.0));
}

#[test]
fn small_states_have_the_digits_of_large_ones() {
    for unit in [1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
        let (run, _) = done(&format!(
            "gravity: none
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
states:
  pumped: {{ start: 0, rate: ({unit}/1 s)*(1 + cos(300 rad/s*t)) }}
  charge: {{ start: {unit}, rate: current/1 s }}
  current: {{ start: 0, rate: -1e4*charge/1 s }}
start: {{ A.velocity: 1 m/s }}
studies: {{ run: {{ dynamics: {{ until: 1 s }}, columns: [pumped], scalars: {{ volume: last(pumped), left: last(charge) }} }} }}
"
        ));
        let exact = [1.0 + 300.0_f64.sin() / 300.0, 100.0_f64.cos()];
        for (name, exact) in ["volume", "left"].iter().zip(exact) {
            let off = scalar(&run, "run", name) / (unit * exact) - 1.0;
            assert!(off.abs() < 1e-5, "{name} in units of {unit:e}: {off:e}");
        }
    }
}

#[test]
fn a_column_may_end_where_an_event_ends_the_motion() {
    for speed in ["1", "0.3", "7"] {
        let (run, table) = done(&format!(
            "gravity: none
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
springs: {{ s: {{ joint: A, stiffness: 1 N/m }} }}
measures: {{ root: sqrt(0.25 - A.position/1 m) }}
start: {{ A.velocity: {speed} m/s }}
events: {{ end: {{ when: A.position - 0.25 m, action: stop }} }}
studies: {{ run: {{ dynamics: {{ until: 5 s, every: 0.01 s }}, columns: [root], scalars: {{ x: last(A.position) }} }} }}
"
        ));
        assert!((scalar(&run, "run", "x") - 0.25).abs() < 1e-9, "{speed}");
        assert!(table.rows.last().unwrap()[0].abs() < 1e-5, "{:?}", table.rows.last());
    }
}
