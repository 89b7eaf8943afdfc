//! Blows while other joints rest on their stops, and stops that events move, against closed forms.

use super::{close, done, drift, last, march, tried};

/// Masses of 1 and 2 kg one in the other: the first on the ground, the second on its way up to a stop of the first, which it meets with
/// √80 m/s.
fn tether(stops: &str, settings: &str) -> String {
    let start = "start: { A.position: 0 m, B.position: 0 m, A.velocity: 0 m/s, B.velocity: 10 m/s }";
    format!(
        "grashof: 1
name: tether
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 2 kg }} }}
{stops}
{start}
studies:
  d:
    dynamics: {{ until: 0.3 s, every: 0.1 s, {settings} }}
    columns: [time, a.vy, b.vy, A.position]
"
    )
}

#[test]
fn a_joint_that_rests_is_pulled_off_its_stop_by_a_blow() {
    let v = 80f64.sqrt();
    let met = (10.0 - v) / 10.0;
    for e in [0.0, 0.5, 1.0] {
        let limits = format!(
            "joints:
  A: {{ slider: [ground, a.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: 0.3 }} }}
  B: {{ slider: [a.origin, b.origin], axis: [0, 1], limits: {{ to: 1 m, restitution: {e} }} }}"
        );
        let events = format!(
            "joints:
  A: {{ slider: [ground, a.origin], axis: [0, 1] }}
  B: {{ slider: [a.origin, b.origin], axis: [0, 1] }}
events:
  floor: {{ when: A.position, crossing: falling, restitution: {{ joint: A, e: 0.3 }} }}
  top: {{ when: B.position - 1 m, crossing: rising, restitution: {{ joint: B, e: {e} }} }}"
        );
        for stops in [&limits, &events] {
            for settings in ["tolerance: 1e-10", "tolerance: 1e-10, coordinates: cartesian, integrator: radau5", "coordinates: minimal"] {
                let outcome = done(&tether(stops, settings), "d");
                // momentum is kept, and the rate at which they part is e times that at which they met
                let a = (1.0 + e) * 2.0 * v / 3.0;
                let [t, va, vb, height] = last(&outcome)[..] else { panic!("four columns") };
                let since = t - met;
                let what = format!("e = {e}, {settings}, {stops}");
                close(&format!("a, {what}"), va, a - 10.0 * since, 1e-6);
                close(&format!("b, {what}"), vb, a - e * v - 10.0 * since, 1e-6);
                close(&format!("height, {what}"), height, a * since - 5.0 * since * since, 1e-6);
                let lost = march(&outcome).stops + march(&outcome).impacts;
                close(&format!("lost, {what}"), lost, -(1.0 - e * e) * v * v / 3.0, 1e-5);
                assert!(drift(&outcome) < 1e-8, "{what}: {}", drift(&outcome));
            }
        }
    }
}

/// A block on a stop, or on what an event meets, which another event moves after a second.
fn block(limits: &str, event: &str, lim: &str, set: &str, start: &str) -> String {
    format!(
        "grashof: 1
name: block
space: planar
gravity: [0, -10 m/s^2]
parameters: {{ lim: {lim} }}
bodies: {{ b: {{ mass: 1 kg }} }}
joints: {{ J: {{ slider: [ground, b.origin], axis: [0, 1]{limits} }} }}
start: {{ J.position: {start}, J.velocity: 0 m/s }}
events: {{ e: {{ when: t - 1 s, set: {{ lim: {set} }} }}{event} }}
studies:
  d: {{ dynamics: {{ until: 2 s, every: 0.5 s, tolerance: 1e-10 }}, columns: [time, J.position, J.velocity] }}
"
    )
}

const LIMITS: &str = ", limits: { from: lim, restitution: 0 }";
const EVENT: &str = ", hit: { when: J.position - lim, crossing: falling, restitution: { joint: J, e: 0 } }";

#[test]
fn a_joint_falls_when_its_stop_is_moved_away() {
    for (limits, event) in [(LIMITS, ""), ("", EVENT)] {
        let outcome = done(&block(limits, event, "0 m", "-10 m", "0 m"), "d");
        let [t, x, v] = last(&outcome)[..] else { panic!("three columns") };
        close("time", t, 2.0, 1e-12);
        close("height", x, -5.0, 1e-7);
        close("speed", v, -10.0, 1e-7);
        close("work", march(&outcome).stops + march(&outcome).impacts, 0.0, 1e-9);
    }
}

#[test]
fn a_stop_that_is_set_beyond_its_joint_ends_the_run() {
    // below a joint at rest, and below one that falls
    for (lim, start) in [("0 m", "0 m"), ("-90 m", "0 m")] {
        for (limits, event, word) in
            [(LIMITS, "", "the lower stop of joint `J` has been set to 1.000000 by the event `e`"), ("", EVENT, "`hit`")]
        {
            let outcome = tried(&block(limits, event, lim, "1 m", start), "d").expect("results up to there");
            let stopped = outcome.stopped.clone().unwrap_or_default();
            assert!(stopped.contains("at t = 1.000000 s") && stopped.contains(word), "{stopped}");
            close("end", last(&outcome)[0], 1.0, 1e-9);
        }
    }
}

#[test]
fn events_that_count_the_hits_of_a_stop_take_no_work_from_it() {
    let text = "grashof: 1
name: hits
space: planar
gravity: none
parameters: { count: 0 }
bodies: { b: { mass: 2 kg } }
joints: { J: { slider: [ground, b.origin], axis: [1, 0], limits: { to: 1 m, restitution: 0.5 } } }
start: { J.position: 0 m, J.velocity: 2 m/s }
events: { hit: { when: J.position - 1 m, crossing: rising, set: { count: count + 1 } } }
measures: { hits: count }
studies: { d: { dynamics: { until: 1 s, every: 0.1 s }, columns: [time, hits] } }
";
    let outcome = done(text, "d");
    close("hits", last(&outcome)[1], 1.0, 0.0);
    close("work of the stop", march(&outcome).stops, -0.5 * 2.0 * (4.0 - 1.0), 1e-9);
    close("work of impacts", march(&outcome).impacts, 0.0, 0.0);
}

#[test]
fn a_joint_pressed_against_another_that_rests_comes_to_rest_with_it() {
    // 25 N lift the inner mass of 2 kg against the outer one of 1 kg: 5 N more than it weighs, and 5 N less than both
    for e in [0.0, 0.5] {
        let limits = format!(
            "joints:
  A: {{ slider: [ground, a.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: 0 }} }}
  B: {{ slider: [a.origin, b.origin], axis: [0, 1], limits: {{ to: 1 m, restitution: {e} }} }}
loads: {{ lift: {{ at: b.origin, force: [0, 25 N] }} }}"
        );
        let text = tether(&limits, "tolerance: 1e-8").replace("until: 0.3 s, every: 0.1 s", "until: 20 s, every: 1 s");
        let text =
            text.replace("B.velocity: 10 m/s", "B.velocity: 0 m/s").replace("A.position]", "A.position, B.position, A.stop, B.stop]");
        let outcome = done(&text, "d");
        let [_, va, vb, a, b, ground, inner] = last(&outcome)[..] else { panic!("seven columns") };
        for (what, found, right) in
            [("va", va, 0.0), ("vb", vb, 0.0), ("a", a, 0.0), ("b", b, 1.0), ("ground", ground, 5.0), ("inner", inner, -5.0)]
        {
            close(&format!("{what}, e = {e}"), found, right, 1e-6);
        }
        assert!(march(&outcome).counts.steps < 2000 && drift(&outcome) < 1e-6, "{:?}", march(&outcome));
    }
}
