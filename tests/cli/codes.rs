//! Exit codes: expectations, stops on the way, several studies, sweeps, interrupts.

use super::*;

/// The model with more keys in its study `turn`.
fn with(lines: &str) -> String {
    model().replace("    plot: { angles: [phi3], torque: [drive.torque] }\n", &format!("{lines}\n"))
}

#[test]
fn an_expectation_that_is_not_met_ends_with_1() {
    let place = Place::new("expect");
    place.put("met.yaml", &with("    expect: { mean_power: { is: 0 W, within: 1e-6 W }, max(phi3) > 1: { is: 1, within: 0 } }"));
    place.run(&["run", "met.yaml", "--no-plots"]).ends(0);
    place.put("not.yaml", &with("    expect: { swing: { is: 1 rad, relative: 1e-3 } }"));
    let done = place.run(&["run", "not.yaml", "--no-plots"]).ends(1);
    assert!(done.stderr.contains("swing") && done.stderr.contains("not.yaml:27"), "{}", done.stderr);
    // results are there all the same, and the JSON says it
    let report = place.json("results/not/turn.json");
    assert_eq!(report["status"], "done");
    assert_eq!(report["findings"][0]["code"], "expectation");
    assert!(place.0.join("results/not/lengths.csv").is_file(), "the other studies ran");
}

/// What a file expects of its own values is no matter of other ones, unless that is asked for.
#[test]
fn expectations_are_those_of_the_file_s_own_values() {
    let place = Place::new("own-values");
    let lines = "    expect: { swing: { is: 1, within: 1e-3 } }\n    set: { speed: 100 rpm }\n";
    place.put("model.yaml", &with(lines));
    let turn = ["run", "model.yaml", "--study", "turn", "--no-plots"];
    let note = |options: &str| {
        format!("note: what the file expects of its own values is not judged, since `{options} what is computed; `--expect` judges it\n")
    };
    for (change, told) in [
        (&["--set", "l1=14 cm"][..], "--set` changes"),
        (&["--variant", "slow"], "--variant` changes"),
        (&["--set", "l1=14 cm", "--variant", "slow"], "--set` and `--variant` change"),
    ] {
        assert_eq!(place.run(&[&turn[..], change].concat()).ends(0).stderr, note(told));
        assert!(place.json("results/model/turn.json")["findings"].as_array().unwrap().is_empty());
        assert!(place.run(&[&turn[..], change, &["-q"]].concat()).ends(0).stderr.is_empty());
        let judged = place.run(&[&turn[..], change, &["--expect"]].concat()).ends(1).stderr;
        assert!(judged.contains("not 1 rad within 1e-3 rad"), "{judged}");
    }
    let sweep = ["sweep", "model.yaml", "--study", "turn", "--over", "l1=14 cm,15 cm", "--no-plots"];
    assert_eq!(place.run(&sweep).ends(0).stderr, note("--over` changes"));
    place.run(&[&sweep[..], &["--expect"]].concat()).ends(1);
    // what the study sets itself is its own
    let judged = place.run(&turn).ends(1).stderr;
    assert!(judged.contains("not 1 rad within 1e-3 rad") && !judged.contains("note:"), "{judged}");
}

/// Changes are for the studies that are asked for; others may not be able to take them.
#[test]
fn changes_are_judged_for_the_studies_that_are_named() {
    let place = Place::new("named-studies");
    let text = with("").replace("variants:\n", "variants:\n  bare: { drivers: { drive: null }, start: { O.omega: 1 rad/s } }\n");
    assert!(text.contains("bare"), "{text}");
    let free = "  free: { dynamics: { until: 0.1 s, every: 0.1 s }, columns: [phi3] }\n";
    place.put("model.yaml", &format!("{text}{free}"));
    place.run(&["run", "model.yaml", "--study", "free", "--variant", "bare", "--no-plots"]).ends(0);
    assert_eq!(place.json("results/model/free.json")["variants"], serde_json::json!(["bare"]));
    place.run(&["sweep", "model.yaml", "--study", "free", "--variant", "bare", "--over", "l1=14 cm,15 cm", "--no-plots"]).ends(0);
    assert_eq!(place.json("results/model/free-over-l1.json")["variants"], serde_json::json!(["bare"]));
    // all studies are asked for, and some need the driver
    assert!(place.run(&["run", "model.yaml", "--variant", "bare", "--no-plots"]).ends(2).stderr.contains("drive"));
}

/// A formula of what is expected that ends at other values keeps none of their results back.
#[test]
fn what_is_expected_needs_a_value_only_where_it_is_judged() {
    let place = Place::new("expected-formula");
    let lines = "    expect: { swing: { is: asin(l1/15 cm)/asin(1)*swing1, relative: 1 } }";
    let text = with(lines).replace("parameters: {", "parameters: { swing1: 1 rad,");
    place.put("model.yaml", &text);
    let turn = ["run", "model.yaml", "--study", "turn", "--no-plots"];
    place.run(&turn).ends(0);
    let longer = ["--set", "l1=16 cm"];
    place.run(&[&turn[..], &longer].concat()).ends(0);
    let judged = place.run(&[&turn[..], &longer, &["--expect"]].concat()).ends(1).stderr;
    assert!(judged.contains("what `swing` is expected to be is not defined") && judged.contains("asin"), "{judged}");
    // in the file itself it is an error, and in a sweep of the file that of its run
    place.put("model.yaml", &text.replace("asin(l1/15 cm)", "asin(l1/14 cm)"));
    assert!(place.run(&turn).ends(2).stderr.contains("a finite number"));
    place.put("model.yaml", &text.replace(lines, &format!("{lines}\n    sweep: {{ l1: [15 cm, 16 cm] }}")));
    let swept = place.run(&turn).ends(1).stderr;
    assert!(swept.contains("what `swing` is expected to be is not defined"), "{swept}");
}

#[test]
fn what_was_expected_is_told_in_the_units_of_the_model() {
    let place = Place::new("expected-units");
    let text = with("    expect: { swing: { is: 60 deg, within: 0.1 deg } }").replace("space: planar", "space: planar\nunits: [deg]");
    place.put("model.yaml", &text);
    let done = place.run(&["run", "model.yaml", "--study", "turn", "--no-plots"]).ends(1);
    assert!(done.stderr.contains(" deg, not 60 deg within 1e-1 deg"), "{}", done.stderr);
}

#[test]
fn the_same_reason_is_told_once() {
    let place = Place::new("same-reason");
    let text = model().replace("coupler.angle: ~25 deg", "coupler.angle: 60 deg");
    place.put("model.yaml", &text);
    let both = ["run", "model.yaml", "--study", "turn", "--study", "turn-again", "--no-plots"];
    let done = place.run(&both).ends(2);
    assert_eq!(done.stderr.matches("put `~` before").count(), 1, "{}", done.stderr);
    assert!(done.stderr.contains("does not begin for the same reason at model.yaml:"), "{}", done.stderr);
    // each study has its error in the JSON
    let told: serde_json::Value = serde_json::from_str(&place.run(&[&both[..], &["--json"]].concat()).ends(2).stdout).unwrap();
    let each = told.as_array().unwrap();
    assert!(each.len() == 2 && each.iter().all(|study| study["errors"][0]["code"] == "start-cannot-hold"), "{told}");
    // a study that takes a number of one that has failed is named itself
    let taking = "  other:
    take: { wide: turn.swing }
    set: { l3: 0.55 m + 0*wide*1 m }
    kinematics: { over: 1 turn, samples: 24 }
";
    place.put("model.yaml", &(text + taking));
    let done = place.run(&["run", "model.yaml", "--study", "turn", "--study", "other", "--no-plots"]).ends(2);
    assert!(done.stderr.contains("study `other` does not begin for the same reason"), "{}", done.stderr);
}

#[test]
fn a_body_whose_mass_is_forgotten_is_a_finding() {
    let place = Place::new("forgotten-mass");
    let codes = |text: &str, study: &str| -> Vec<String> {
        place.put("model.yaml", text);
        place.run(&["run", "model.yaml", "--study", study, "--no-plots"]).ends(0);
        let report = place.json(&format!("results/model/{study}.json"));
        report["findings"].as_array().unwrap().iter().map(|f| f["code"].as_str().unwrap().to_owned()).collect()
    };
    let without = model().replace("length: l2, mass: 6 kg", "length: l2");
    assert_ne!(without, model());
    assert_eq!(codes(&without, "turn"), ["no-mass"]);
    let report = place.json("results/model/turn.json");
    let message = report["findings"][0]["message"].as_str().unwrap();
    assert!(message.starts_with("`coupler` has no mass, so that its weight and inertia do not count"), "{message}");
    assert_eq!(codes(&model().replace("length: l2, mass: 6 kg", "length: l2, mass: 0"), "turn"), [""; 0]);
    // where forces do not count, nothing is said
    assert_eq!(codes(&without, "turn-again"), [""; 0]);
}

#[test]
fn a_study_that_stops_on_its_way_keeps_its_rows() {
    let place = Place::with_model("stops");
    let done = place.run(&["run", "model.yaml", "--study", "turn", "--set", "l3=10 cm", "-o", "out"]).ends(3);
    assert!(done.stderr.contains("dead point") && done.stderr.contains("model.yaml:"), "{}", done.stderr);
    let report = place.json("out/turn.json");
    assert_eq!(report["status"], "failed");
    assert!(report["findings"].as_array().unwrap().iter().any(|f| f["code"] == "stopped"), "{}", report["findings"]);
    let (_, rows) = csv(&place.text("out/turn.csv"));
    assert!(rows.len() > 2 && rows.len() < 25, "{}", rows.len());
    let theta: Vec<f64> = rows.iter().map(|row| row[0].parse().unwrap()).collect();
    assert!(theta.windows(2).all(|w| w[0] <= w[1]) && theta[0] < 1.5 && theta[theta.len() - 1] > 1.6, "{theta:?}");
}

#[test]
fn the_highest_code_of_several_studies_wins() {
    let place = Place::new("highest");
    // 3 of `turn` over 1 of `turn-again`, which runs although the first stopped
    let text = model().replace(
        "{ over: 1 turn, samples: 12 }\n  lengths",
        "{ over: 0.1 rad, samples: 12 }\n    expect: { max(phi3): { is: 9, within: 1 } }\n  lengths",
    );
    place.put("model.yaml", &text);
    let changed = ["run", "model.yaml", "--set", "l3=10 cm", "--expect", "--no-plots", "--study", "turn-again"];
    place.run(&changed).ends(1);
    place.run(&[&changed[..], &["--study", "turn"]].concat()).ends(3);
    assert!(place.0.join("results/model/turn-again.json").is_file());
}

#[test]
fn a_sweep_fails_only_if_all_its_runs_do() {
    let place = Place::new("sweep");
    let sweep = |values: &str| model().replace("[10 cm, 50 cm, 55 cm, 5 m]", values);
    // dead points and impossible lengths beside a good run: a result
    place.put("some.yaml", &sweep("[5 m, 10 cm, 55 cm]"));
    place.run(&["run", "some.yaml", "--study", "lengths", "--no-plots", "-o", "some"]).ends(0);
    assert_eq!(place.json("some/lengths.json")["status"], "done");
    assert!(!place.files("some").contains(&"lengths-001.csv".to_string()), "a run that never began has no curve");
    // all stop on their way: rows are kept, code 3
    place.put("stop.yaml", &sweep("[10 cm, 11 cm]"));
    place.run(&["run", "stop.yaml", "--study", "lengths", "--no-plots", "-o", "stop"]).ends(3);
    assert_eq!(place.files("stop"), ["lengths-001.csv", "lengths-002.csv", "lengths.csv", "lengths.json"]);
    assert_eq!(place.json("stop/lengths.json")["status"], "failed");
    // none begins: nothing is written
    place.put("none.yaml", &sweep("[5 m, 6 m]"));
    let done = place.run(&["run", "none.yaml", "--study", "lengths", "-o", "none"]).ends(3);
    assert!(done.stderr.contains("none of the 2 runs"), "{}", done.stderr);
    assert!(!place.0.join("none").exists());
}

#[test]
fn what_is_set_beats_the_file_and_not_the_sweep() {
    let place = Place::with_model("set");
    let speed = |arguments: &[&str]| {
        place.run(&[&["run", "model.yaml", "--study", "turn", "--no-plots", "-o", "out"], arguments].concat()).ends(0);
        place.json("out/turn.json")["parameters"]["speed"].as_f64().unwrap()
    };
    assert!((speed(&[]) / (240.0 * std::f64::consts::TAU / 60.0) - 1.0).abs() < 1e-15);
    assert_eq!(speed(&["--variant", "slow"]), std::f64::consts::TAU);
    assert_eq!(speed(&["--variant", "slow", "--set", "speed=3"]), 3.0);
    assert_eq!(speed(&["--set", "speed = 1 turn/s"]), std::f64::consts::TAU);
    assert_eq!(speed(&["--set", "speed=5", "--set", "speed=7"]), 7.0, "the last one wins");
    // a swept parameter: the study is skipped with a note, or refused if it was named
    let done = place.run(&["run", "model.yaml", "--set", "l3=0.5", "--no-plots", "-o", "note"]).ends(0);
    assert!(done.stderr.contains("note: study `lengths` is skipped"), "{}", done.stderr);
    assert_eq!(place.files("note"), ["turn-again.csv", "turn-again.json", "turn.csv", "turn.json"]);
    assert!(place.run(&["run", "model.yaml", "--set", "l3=0.5", "--no-plots", "-o", "note", "-q"]).ends(0).stderr.is_empty());
    place.run(&["run", "model.yaml", "--set", "l3=0.5", "--study", "lengths", "-o", "refused"]).ends(2);
    assert!(!place.0.join("refused").exists());
    // another parameter reaches a sweep
    place.run(&["run", "model.yaml", "--set", "l1=10 cm", "--study", "lengths", "--no-plots", "-o", "other"]).ends(0);
    assert_eq!(place.json("other/lengths.json")["parameters"]["l1"], 0.1);
}

#[test]
fn files_of_an_earlier_run_are_replaced_and_no_others() {
    let place = Place::with_model("stale");
    // names of the user's that results of the study might have, too
    let own = ["notes.txt", "turn.yaml", "turn-photo.png", "turn-sketch.svg", "turn-001.csv", "turn-2024.csv", "turn-A.csv", "turn.mat"];
    fs::create_dir_all(place.0.join("out/inner")).unwrap();
    own.iter().for_each(|name| place.put(&format!("out/{name}"), "own"));
    let kept = || own.iter().for_each(|name| assert_eq!(place.text(&format!("out/{name}")), "own"));
    for plots in [&["--force"][..], &["--no-plots"]] {
        place.run(&[&["run", "model.yaml", "--study", "turn", "-o", "out"], plots].concat()).ends(0);
        kept();
    }
    // one of the name of a result is refused before anything is computed, and after it
    place.put("out/turn-angles.png", "own");
    let before = place.contents_of_files("out");
    let refused = place.run(&["run", "model.yaml", "--study", "turn", "-o", "out"]).ends(2).stderr;
    assert!(refused.contains("out/turn-angles.png: there is a file that no earlier run is recorded to have written"), "{refused}");
    assert!(refused.contains("help: move it away, choose another directory with `-o DIR`, or replace it with `--force`"), "{refused}");
    fs::rename(place.0.join("out/turn-angles.png"), place.0.join("out/turn-mechanism.png")).unwrap();
    place.run(&["run", "model.yaml", "--study", "turn", "-o", "out"]).ends(2);
    fs::rename(place.0.join("out/turn-mechanism.png"), place.0.join("out/turn-angles.png")).unwrap();
    assert_eq!(place.contents_of_files("out"), before);
    // so is a result that somebody has edited since
    let table = place.text("out/turn.csv") + "# a remark\n";
    place.put("out/turn.csv", &table);
    let refused = place.run(&["run", "model.yaml", "--study", "turn", "-o", "out", "--no-plots"]).ends(2).stderr;
    assert!(refused.contains("out/turn.csv: the file there is not as an earlier run has written it"), "{refused}");
    assert_eq!(place.text("out/turn.csv"), table);
    place.run(&["run", "model.yaml", "--study", "turn", "-o", "out", "--force"]).ends(0);
    assert!(
        place.text("out/turn.csv") != table && fs::read(place.0.join("out/turn-angles.png")).unwrap() != b"own",
        "replaced because it was asked for"
    );
    kept();
    assert!(place.0.join("out/inner").is_dir() && place.0.join("out/turn-angles.svg").is_file());
    // figures of an earlier run do not stay beside newer numbers
    place.run(&["run", "model.yaml", "--study", "turn", "-o", "out", "--no-plots"]).ends(0);
    assert!(!place.0.join("out/turn-angles.svg").exists());
    assert!(!place.files("out").iter().any(|name| name.starts_with('.')), "no temporary file stays");
    // a run that cannot begin leaves the earlier results alone
    let before = place.contents_of_files("out");
    place.run(&["run", "model.yaml", "--study", "turn", "-o", "out", "--set", "l3=5"]).ends(2);
    assert_eq!(place.contents_of_files("out"), before);
}

#[test]
fn a_closed_pipe_is_no_panic() {
    let place = Place::with_model("pipe");
    for arguments in [
        &["schema"][..],
        &["completions", "bash"],
        &["--help"],
        &["new", "four-bar", "-"],
        &["check", "model.yaml"],
        &["check", "model.yaml", "--json"],
        &["run", "model.yaml", "--no-plots", "--units"],
        &["run", "model.yaml", "--no-plots", "--json"],
    ] {
        let mut child = place.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let mut stderr = String::new();
        child.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
        let status = child.wait().unwrap();
        assert!(!stderr.contains("panicked"), "{arguments:?}: {stderr}");
        assert_eq!(status.code(), Some(0), "{arguments:?}: {stderr}");
    }
    assert!(place.0.join("results/model/turn.csv").is_file());
    // and errors into a closed pipe
    let mut child = place.command(&["check", "nowhere.yaml"]).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_writes_nothing_and_ends_with_130() {
    use std::time::{Duration, Instant};
    let place = Place::new("interrupt");
    let sweep = "{ from: 50 cm, to: 60 cm, count: 100000 }";
    place.put("model.yaml", &model().replace("[10 cm, 50 cm, 55 cm, 5 m]", sweep));
    let arguments = ["run", "model.yaml", "--study", "turn", "--study", "lengths", "-o", "out", "--no-plots"];
    let mut child = place.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    // the first study is written and runs of the second one are kept: the handler was set long ago
    while !place.0.join("out/lengths.partial").is_file() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    if !killed.is_ok_and(|status| status.success()) {
        let _ = child.kill();
        let _ = child.wait();
        return;
    }
    let interrupted = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if interrupted.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("the interrupt was not heeded");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(status.code(), Some(130));
    assert_eq!(place.files("out"), ["lengths.partial", "turn.csv", "turn.json"], "the interrupted study is not written");
}
