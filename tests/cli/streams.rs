//! What reaches the terminal and the pipe: full discs, control characters, errors as JSON, and files of other kinds.

use super::*;

/// Runs with stdout going to a full disc.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disc_behind_stdout_is_an_error_of_every_command() {
    let place = Place::with_model("full");
    let dynamics = "\
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, rod.start] } }
start: { P.angle: -1 rad }
studies: { swing: { dynamics: { until: 0.1 s, every: 0.01 s }, columns: [rod.angle] } }
";
    place.put("pendulum.yaml", dynamics);
    let urdf = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/urdf/skew.urdf");
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["run", "--help"],
        &["schema"],
        &["completions", "zsh"],
        &["new", "--list"],
        &["new", "four-bar", "-"],
        &["import", urdf],
        &["check", "model.yaml"],
        &["check", "model.yaml", "--json"],
        &["run", "model.yaml", "--study", "turn", "--no-plots"],
        &["run", "model.yaml", "--study", "turn", "--no-plots", "--json", "--force"],
        &["run", "nowhere.yaml", "--json"],
        &["sweep", "model.yaml", "--study", "turn", "--over", "l3=0.5,0.55", "--no-plots"],
        &["modes", "pendulum.yaml", "--no-plots"],
        &["statics", "pendulum.yaml", "--no-plots", "--json"],
        &["compare", "pendulum.yaml", "--study", "swing", "--tolerances", "1e-4", "--no-plots"],
    ] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let done = Done::of(place.command(arguments).stdout(full).output().unwrap()).ends(2);
        let told = "error: cannot write to standard output: No space left on device";
        assert_eq!(done.stderr.matches(told).count(), 1, "{arguments:?}: {}", done.stderr);
    }
    // what was written into files is whole
    assert!(place.0.join("results/model/turn.csv").is_file());
}

#[test]
fn nothing_of_a_file_steers_the_terminal() {
    let place = Place::new("steer");
    let keys = "grashof: 1\nname: \"x\\e[2J\\u202evil\"\nspace: planar\ngravity: none\nabout: \"\\e]0;pwn\\a\"\n";
    place.put("keys.yaml", &format!("{keys}\"foo\\e[2J\": 1\nbodies: {{ \"b\\e[31m\": {{ mass: 1 }} }}\n"));
    place.put(
        "good.yaml",
        &format!("{keys}bodies: {{ b: {{ mass: 1 }} }}\nstudies: {{ s: {{ about: \"\\e[2J\\u009b\", statics: {{ from: start }} }} }}\n"),
    );
    place.put("raw.yaml", "grashof: 1\nname: x\u{9b}2J\nfoo\u{1b}[2J: 1\n");
    for arguments in [
        &["check", "keys.yaml"][..],
        &["check", "good.yaml"],
        &["check", "good.yaml", "--json"],
        &["check", "raw.yaml"],
        &["check", "raw.yaml", "--json"],
        &["run", "good.yaml", "--no-plots"],
        &["run", "keys.yaml", "--json"],
        &["run", "\u{1b}[2Jnowhere.yaml"],
    ] {
        let done = place.run(arguments);
        for text in [&done.stdout, &done.stderr] {
            let steers = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
            assert!(!text.contains(steers), "{arguments:?}: {text:?}");
        }
    }
    // a JSON string is read back as it was
    assert_eq!(place.run(&["check", "good.yaml", "--json"]).json()["name"], "x\u{1b}[2J\u{202e}vil");
}

#[test]
fn errors_are_json_too() {
    let place = Place::with_model("errors");
    place.put("bad.yaml", &model().replace("length: l1", "length: l9"));
    let of = |arguments: &[&str], code: i32| place.run(arguments).ends(code).json();
    for (command, more) in
        [("check", &[][..]), ("sweep", &["--over", "l3=1"]), ("modes", &[]), ("statics", &[]), ("compare", &["--study", "turn"])]
    {
        let found = of(&[&[command, "bad.yaml", "--json"], more].concat(), 2);
        assert_eq!(found["status"], "failed", "{command}");
        let error = &found["errors"][0];
        assert_eq!((error["line"].as_u64(), error["file"].as_str()), (Some(8), Some("bad.yaml")), "{command}: {found}");
        assert!(error["message"].as_str().unwrap().contains("l9") && error["code"].is_string(), "{command}: {found}");
    }
    let found = of(&["run", "bad.yaml", "--json"], 2);
    assert_eq!((found[0]["status"].as_str(), found[0]["errors"][0]["line"].as_u64()), (Some("failed"), Some(8)), "{found}");
    // usage, and files that are not there
    assert!(of(&["check", "nowhere.yaml", "--json"], 2)["errors"][0]["help"].is_string());
    assert!(of(&["run", "nowhere.yaml", "--json"], 2)[0]["errors"][0]["message"].as_str().unwrap().contains("nowhere.yaml"));
    assert!(of(&["run", "model.yaml", "--json", "--no-such"], 2)[0]["errors"][0]["message"].as_str().unwrap().contains("--no-such"));
    // one of several studies: each has its place in the list, with its errors
    let found = of(&["run", "model.yaml", "--json", "--no-plots", "--study", "turn", "--study", "nowhere"], 2);
    assert_eq!((found[0]["study"].as_str(), found[0]["status"].as_str()), (Some("turn"), Some("done")), "{found}");
    assert_eq!((found[1]["study"].as_str(), found[1]["status"].as_str()), (Some("nowhere"), Some("failed")), "{found}");
    // an expectation that is not met stands in the report of its study
    place.put("unmet.yaml", &model().replace("samples: 24 }", "samples: 24 }\n    expect: { swing: { is: 1, within: 1e-3 } }"));
    let found = of(&["run", "unmet.yaml", "--json", "--no-plots", "--study", "turn"], 1);
    assert_eq!((found[0]["study"].as_str(), found[0]["errors"][0]["code"].as_str()), (Some("turn"), Some("expectation")), "{found}");
    assert!(found[0]["scalars"]["swing"].is_number());
}

#[test]
fn a_name_of_dots_names_no_directory() {
    let place = Place::new("dots");
    for name in ["...yaml", "..yaml"] {
        place.put(name, &model());
        let refused = place.run(&["run", name, "--study", "turn", "--no-plots"]).ends(2).stderr;
        assert!(refused.contains("names no directory for results") && refused.contains("-o DIR"), "{refused}");
    }
    assert_eq!(place.files(""), ["...yaml", "..yaml"]);
    place.run(&["run", "...yaml", "--study", "turn", "--no-plots", "-o", "out"]).ends(0);
}

#[test]
fn an_include_shows_nothing_of_other_files() {
    let place = Place::new("secret");
    place.put("secret", "root:x:0:0:hunter2\nmore");
    place.put("secret.xml", "<password>hunter2</password>");
    fs::write(place.0.join("secret.bin"), b"hunter2 \xff\xfe").unwrap();
    for name in ["secret", "secret.xml", "secret.bin"] {
        place.put("model.yaml", &format!("grashof: 1\nname: n\nspace: spatial\ngravity: none\ninclude: {{ urdf: {name} }}\n"));
        for more in [&[][..], &["--json"]] {
            let done = place.run(&[&["check", "model.yaml"], more].concat()).ends(2);
            assert!(!done.stderr.contains("hunter2") && !done.stdout.contains("hunter2"), "{}{}", done.stdout, done.stderr);
            assert!(done.stderr.contains(name), "{}", done.stderr);
        }
    }
}

#[cfg(unix)]
#[test]
fn pipes_and_links_in_the_way_are_left_alone() {
    let place = Place::with_model("pipes");
    let fifo = |name: &str| assert!(Command::new("mkfifo").arg(place.0.join(name)).status().unwrap().success());
    fifo("robot.urdf");
    place.put("robot.yaml", "grashof: 1\nname: n\nspace: spatial\ngravity: none\ninclude: { urdf: robot.urdf }\n");
    assert!(place.run(&["check", "robot.yaml"]).ends(2).stderr.contains("it is no plain file"));
    // where finished runs are kept: a pipe, a link out of the directory, and somebody's own file
    place.put("mine", "own");
    for (out, what) in
        [("pipe", "is no plain file"), ("link", "is no plain file"), ("own", "holds no finished runs"), ("dangling", "is no plain file")]
    {
        fs::create_dir(place.0.join(out)).unwrap();
        let partial = place.0.join(out).join("lengths.partial");
        match out {
            "pipe" => fifo("pipe/lengths.partial"),
            "link" => std::os::unix::fs::symlink(place.0.join("mine"), &partial).unwrap(),
            "dangling" => std::os::unix::fs::symlink(place.0.join("made"), &partial).unwrap(),
            _ => place.put("own/lengths.partial", "own"),
        }
        let done = place.run(&["run", "model.yaml", "--study", "lengths", "--no-plots", "-o", out]).ends(0);
        assert!(done.stderr.contains(&format!("lengths.partial {what}")), "{out}: {}", done.stderr);
        assert!(fs::symlink_metadata(&partial).is_ok(), "{out}");
        assert!(place.0.join(out).join("lengths.csv").is_file());
    }
    assert_eq!((place.text("mine"), place.text("own/lengths.partial")), ("own".into(), "own".into()));
    assert!(!place.0.join("made").exists());
    // a result that is a link is not followed, and replaced itself only if that is asked for
    fs::create_dir(place.0.join("out")).unwrap();
    std::os::unix::fs::symlink(place.0.join("mine"), place.0.join("out/turn.csv")).unwrap();
    let turn = ["run", "model.yaml", "--study", "turn", "--no-plots", "-o", "out"];
    place.run(&turn).ends(2);
    place.run(&[&turn[..], &["--force"]].concat()).ends(0);
    assert_eq!(place.text("mine"), "own");
    assert!(fs::symlink_metadata(place.0.join("out/turn.csv")).unwrap().is_file());
}
