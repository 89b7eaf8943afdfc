//! Ctrl-C and the request to end: heard within 100 ms whatever is computed, with exit code 130.

use super::*;
use std::process::Child;
use std::time::{Duration, Instant};

/// A hanging chain of so many links, with studies that take long.
fn chain(links: usize) -> String {
    let mut text = String::from("grashof: 1\nname: chain\nspace: planar\ngravity: [0, -9.81 m/s^2]\nparameters: { mass: 1 kg }\nbodies:\n");
    (0..links).for_each(|i| text.push_str(&format!("  b{i}: {{ bar: {{ length: 0.1 m, mass: mass }} }}\n")));
    text.push_str("joints:\n  j0: { revolute: [ground, b0.start] }\n");
    (1..links).for_each(|i| text.push_str(&format!("  j{i}: {{ revolute: [b{}.end, b{i}.start] }}\n", i - 1)));
    text + "start: { j0.angle: -1 rad }
studies:
  swing: { dynamics: { until: 1e6 s, every: 1 s }, columns: [b0.angle] }
  frames: { linearize: { at: start } }
  rest: { statics: { from: start } }
  shapes: { modes: { at: statics, damped: true } }
  laps: { periodic: { over: t, by: 2 s, of: b0.angle } }
  many: { dynamics: { until: 1e3 s, every: 1 s }, columns: [b0.angle], sweep: { mass: [1 kg, 2 kg, 3 kg] } }
  found:
    dynamics: { until: 1e3 s, every: 1 s }
    columns: [b0.angle]
    scalars: { end: last(b0.angle) }
    solve: { vary: mass, between: [1 kg, 2 kg], target: { end: 0 rad } }
"
}

/// Sends a signal to a run that has gone on for a while, and gives the time that it took to end; none if it had ended before.
fn ended(mut child: Child, after: Duration, signal: &str) -> Option<(Duration, Done)> {
    std::thread::sleep(after);
    if child.try_wait().unwrap().is_some() {
        return None;
    }
    let sent = Instant::now();
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    while child.try_wait().unwrap().is_none() {
        if sent.elapsed() > Duration::from_secs(30) {
            child.kill().unwrap();
            panic!("the signal was not heard");
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    Some((sent.elapsed(), Done::of(child.wait_with_output().unwrap())))
}

/// A command hears both signals in time: the best of a few tries counts, since other programs run beside it.
#[track_caller]
fn hears(place: &Place, arguments: &[&str]) {
    for signal in ["-INT", "-TERM"] {
        let mut best = Duration::MAX;
        for tries in 0..12 {
            let child = place.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
            let after = Duration::from_millis(250 >> (tries % 4));
            let Some((took, done)) = ended(child, after, signal) else { continue };
            // before the handler is set a signal ends the program as any other, and one that has its results already ends with them
            if done.code == -1 || done.code == 0 {
                continue;
            }
            assert_eq!(done.code, 130, "{arguments:?}: {}", done.stderr);
            // a watch that got no time to speak does not wait for it
            assert!(done.stderr.contains("interrupted") || took > Duration::from_millis(80), "{arguments:?}: {}", done.stderr);
            best = best.min(took);
            if best < Duration::from_millis(100) {
                break;
            }
        }
        assert!(best < Duration::from_millis(100), "{arguments:?} {signal}: {best:?}");
    }
}

#[test]
fn every_kind_of_study_hears() {
    let place = Place::new("signals");
    place.put("chain.yaml", &chain(60));
    place.put("deep.yaml", &chain(250));
    let driven = model().replace("inverse: { over: 1 turn, samples: 24 }", "inverse: { over: 3000 turn, samples: 900000 }");
    place.put("driven.yaml", &driven.replace("l3: [10 cm, 50 cm, 55 cm, 5 m]", "l3: { from: 50 cm, to: 60 cm, count: 100000 }"));
    assert!(Command::new("mkfifo").arg(place.0.join("fifo.yaml")).status().unwrap().success());
    for (file, study) in [
        ("chain.yaml", "swing"),
        ("chain.yaml", "laps"),
        ("chain.yaml", "many"),
        ("chain.yaml", "found"),
        ("deep.yaml", "frames"),
        ("deep.yaml", "rest"),
        ("deep.yaml", "shapes"),
        ("driven.yaml", "turn"),
        ("driven.yaml", "lengths"),
        ("fifo.yaml", "none"),
    ] {
        hears(&place, &["run", file, "--study", study, "--no-plots", "-o", "out", "--force"]);
    }
    hears(&place, &["modes", "deep.yaml", "-o", "out"]);
    hears(&place, &["statics", "deep.yaml", "-o", "out"]);
    hears(&place, &["compare", "chain.yaml", "--study", "swing", "-o", "out"]);
    hears(&place, &["sweep", "driven.yaml", "--study", "turn", "--over", "l3=0.5,0.55", "-o", "out"]);
}

/// What a motion has come to is kept, and the next run finds nothing in its way.
#[test]
fn a_request_to_end_keeps_the_rows_up_to_there() {
    let place = Place::new("term");
    place.put("chain.yaml", &chain(3));
    for signal in ["-INT", "-TERM"] {
        let arguments = ["run", "chain.yaml", "--study", "swing", "-o", "out", "--json"];
        let child = place.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (_, done) = ended(child, Duration::from_secs(1), signal).expect("a long run");
        assert_eq!(done.code, 130, "{}", done.stderr);
        assert!(done.stderr.contains("interrupted: study `swing` is written up to there"), "{}", done.stderr);
        assert_eq!(place.files("out"), ["swing.csv", "swing.json"]);
        assert!(csv(&place.text("out/swing.csv")).1.len() > 2);
        assert_eq!(done.json()[0]["study"], "swing");
    }
}
