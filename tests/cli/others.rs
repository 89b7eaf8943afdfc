//! The commands beside `run`: completions, schema, new, check.

use super::*;

#[test]
fn completions_of_all_shells() {
    let place = Place::new("completions");
    for (shell, sign) in [("bash", "complete"), ("zsh", "#compdef"), ("fish", "complete -c grashof")] {
        let script = place.run(&["completions", shell]).ends(0);
        assert!(script.stdout.contains(sign) && script.stdout.contains("check") && script.stderr.is_empty(), "{shell}");
    }
    // a shell that is there reads its script
    for shell in ["bash", "zsh", "fish"] {
        let script = place.run(&["completions", shell]).stdout;
        place.put("script", &script);
        if let Ok(output) = Command::new(shell).arg("-n").arg(place.0.join("script")).output() {
            assert!(output.status.success(), "{shell}: {}", String::from_utf8_lossy(&output.stderr));
        }
    }
}

/// Whether `value` has the form that `schema` asks for, as far as types, keys, lists and alternatives go.
fn fits(schema: &Value, value: &Value, root: &Value) -> Result<(), String> {
    if let Some(to) = schema["$ref"].as_str() {
        let at = to.strip_prefix('#').unwrap_or(to);
        return fits(root.pointer(at).ok_or_else(|| format!("{to} leads nowhere"))?, value, root);
    }
    if let Some(all) = schema["allOf"].as_array() {
        all.iter().try_for_each(|s| fits(s, value, root))?;
    }
    for several in ["anyOf", "oneOf"] {
        if let Some(options) = schema[several].as_array() {
            let found: Vec<_> = options.iter().map(|s| fits(s, value, root)).collect();
            if found.iter().all(Result::is_err) {
                return Err(format!("{value} fits none of {several}: {found:?}"));
            }
        }
    }
    if let Some(one) = schema["enum"].as_array()
        && !one.contains(value)
    {
        return Err(format!("{value} is none of {one:?}"));
    }
    if let Some(constant) = schema.get("const")
        && constant != value
    {
        return Err(format!("{value} is not {constant}"));
    }
    let is = |kind: &str| match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    };
    let kinds: Vec<&str> = match &schema["type"] {
        Value::String(kind) => vec![kind],
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
        _ => vec![],
    };
    if !kinds.is_empty() && !kinds.iter().any(|kind| is(kind)) {
        return Err(format!("{value} is none of {kinds:?}"));
    }
    if let Some(map) = value.as_object() {
        for key in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !map.contains_key(key) {
                return Err(format!("`{key}` is missing"));
            }
        }
        for (key, inner) in map {
            let within = |e: String| format!("{key}: {e}");
            match (schema["properties"].get(key), &schema["additionalProperties"]) {
                (Some(s), _) => fits(s, inner, root).map_err(within)?,
                (None, Value::Bool(false)) if schema.get("patternProperties").is_none() => return Err(format!("`{key}` is not known")),
                (None, s @ Value::Object(_)) => fits(s, inner, root).map_err(within)?,
                _ => {}
            }
        }
    }
    for item in value.as_array().into_iter().flatten() {
        if schema["items"].is_object() {
            fits(&schema["items"], item, root)?;
        }
    }
    Ok(())
}

#[test]
fn the_schema_of_results_fits_what_is_written() {
    let place = Place::new("schema-results");
    let schema = place.run(&["schema", "--results"]).ends(0).json();
    assert!(schema["$schema"].is_string());
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut kinds = BTreeMap::new();
    // motions in time, driven ones, modes, sweeps and solutions, with all that each certifies
    for model in ["slider_crank.yaml", "pendulum.yaml", "truss.yaml", "heavy_top.yaml"] {
        let path = root.join(model);
        let run = place.run(&["run", path.to_str().unwrap(), "--json", "--no-plots", "-o", model]);
        let all = run.ends(0).json();
        for results in all.as_array().unwrap() {
            fits(&schema, results, &schema).unwrap_or_else(|error| panic!("{model}, {}: {error}", results["study"]));
            // what is written is described
            for key in results["certificate"].as_object().unwrap().keys() {
                let known = &schema["properties"]["certificate"]["properties"][key];
                assert!(known.is_object() || key.starts_with("work_"), "{model}: `{key}` is not described");
                *kinds.entry(key.clone()).or_insert(0) += 1;
            }
        }
    }
    assert!(kinds.len() > 15, "{kinds:?}");
    let mut wrong = place.run(&["run", root.join("pendulum.yaml").to_str().unwrap(), "--json", "--no-plots"]).ends(0).json()[0].clone();
    wrong["status"] = "perhaps".into();
    assert!(fits(&schema, &wrong, &schema).is_err());
}

#[test]
fn the_schema_fits_the_models_and_refuses_bad_ones() {
    let place = Place::new("schema");
    let done = place.run(&["schema"]).ends(0);
    let schema = done.json();
    assert!(done.stderr.is_empty() && schema["$schema"].is_string() && schema["properties"]["grashof"].is_object());
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for folder in ["models", "src/cli/templates"] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "yaml") {
                let value: Value = serde_yaml::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
                fits(&schema, &value, &schema).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                count += 1;
            }
        }
    }
    assert!(count >= 6);
    for name in ["misspelt-section", "misspelt-in-body", "misspelt-joint-option", "unknown-space", "missing-gravity", "list-at-top"] {
        let text = fs::read_to_string(root.join(format!("tests/bad/{name}.yaml"))).unwrap();
        let value: Value = serde_yaml::from_str(&text).unwrap();
        assert!(fits(&schema, &value, &schema).is_err(), "{name} fits");
    }
}

#[test]
fn new_models_run() {
    let place = Place::new("new");
    let list = place.run(&["new", "--list"]).ends(0).stdout;
    let kinds: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(kinds, ["four-bar", "slider-crank"]);
    assert!(place.files("").is_empty(), "--list writes nothing");
    for kind in kinds {
        let file = format!("my {kind}.yaml");
        let done = place.run(&["new", kind, &file]).ends(0);
        assert!(done.stdout.is_empty() && done.stderr.contains(&file));
        assert!(place.text(&file).lines().filter(|line| line.contains('#')).count() >= 3, "{kind}: comments");
        let checked = place.run(&["check", &file, "--strict"]).ends(0);
        assert!(checked.stderr.is_empty(), "{}", checked.stderr);
        let run = place.run(&["run", &file]).ends(0);
        assert!(run.stderr.is_empty() && !run.stdout.is_empty(), "{}", run.stderr);
        assert!(place.files(&format!("results/my {kind}")).len() > 4);
        // `-` is stdout
        assert_eq!(place.run(&["new", kind, "-"]).ends(0).stdout, place.text(&file));
    }
    place.run(&["new"]).ends(0);
    assert!(place.text("four_bar.yaml").contains("name: four-bar"));
}

#[test]
fn texts_go_to_the_file_of_output() {
    let place = Place::new("to-file");
    for (arguments, file) in [(&["new", "four-bar"][..], "mine.yaml"), (&["schema"], "s.json"), (&["completions", "bash"], "c.sh")] {
        let printed = place.run(&[arguments, &["-o", "-"]].concat()).ends(0).stdout;
        let done = place.run(&[arguments, &["-o", file]].concat()).ends(0);
        assert!(done.stdout.is_empty() && place.text(file) == printed, "{file}");
        assert!(place.run(&[arguments, &["-o", file]].concat()).ends(2).stderr.contains("--force"), "{file}");
    }
}

#[test]
fn new_never_overwrites() {
    let place = Place::new("overwrite");
    place.put("mine.yaml", "mine");
    place.put("four_bar.yaml", "mine, too");
    for arguments in [&["new", "four-bar", "mine.yaml"][..], &["new", "slider-crank", "mine.yaml"], &["new"]] {
        let done = place.run(arguments).ends(2);
        assert!(done.stderr.contains("error") && done.stderr.contains("help:"), "{}", done.stderr);
    }
    assert_eq!((place.text("mine.yaml").as_str(), place.text("four_bar.yaml").as_str()), ("mine", "mine, too"));
    place.run(&["new", "four-bar", "no/such/place.yaml"]).ends(2);
    place.run(&["new", "five-bar"]).ends(2);
}

const LIFT: &str = "grashof: 1
name: luffing
space: planar
gravity: none
bodies: { arm: { bar: { length: 1 m, mass: 2 kg } } }
joints: { O: { revolute: [ground, arm.start] } }
couplings: { cylinder: { zero: \"sqrt((arm.end.x - 0.2 m)^2 + (arm.end.y + 1 m)^2) - (1.3 m + 0.3 m*sin(2 rad/s*t))\" } }
start: { O.angle: ~20 deg }
";

#[test]
fn check_tells_what_a_model_is() {
    let place = Place::with_model("check");
    let done = place.run(&["check", "model.yaml"]).ends(0);
    for word in [
        "crank",
        "revolute",
        "loop: ground -O- crank -A- coupler -B- rocker -C- ground",
        "degrees of freedom        1",
        "left by the drivers       0",
        "crank-rocker",
        "full turn",
        "O.angle",
        "~",
    ] {
        assert!(done.stdout.contains(word), "{word}\n{}", done.stdout);
    }
    assert!(done.stderr.is_empty() && place.files("").len() == 1, "check writes nothing");
    assert!(place.run(&["check", "model.yaml", "--set", "l3=10 cm"]).ends(0).stdout.contains("rocker-crank"));
    // a coupling that time moves is what a driver is
    place.put("lift.yaml", LIFT);
    let lift = place.run(&["check", "lift.yaml"]).ends(0).stdout;
    assert!(lift.contains("degrees of freedom        1 (without drivers and couplings that time moves; Grübler's count: 1)"), "{lift}");
    assert!(lift.contains("left by the drivers       0"), "{lift}");
    // findings: nothing without --strict, 1 with it
    place.put("loose.yaml", &model().replace("O.angle: 90 deg", "O.angle: 90"));
    let loose = place.run(&["check", "loose.yaml"]).ends(0);
    assert!(loose.stderr.contains("warning") && loose.stdout.contains("findings"), "{}\n{}", loose.stdout, loose.stderr);
    place.run(&["check", "loose.yaml", "--strict"]).ends(1);
    place.run(&["check", "model.yaml", "--strict"]).ends(0);
    assert_eq!(place.run(&["check", "loose.yaml", "--json", "--strict"]).ends(1).json()["findings"].as_array().unwrap().len(), 1);
    // what cannot be assembled is an error of the model
    assert!(place.run(&["check", "model.yaml", "--set", "l3=5"]).ends(2).stderr.contains("cannot be assembled"));
}

/// Masses, lengths and poles keep their digits in machines of a micrometre, and what is round-off beside them is 0.
#[test]
fn small_machines_have_masses_and_poles() {
    let place = Place::new("small");
    let text = "grashof: 1
name: small
space: planar
gravity: none
bodies:
  w: { bar: { length: 1 um, mass: 1e-15 kg } }
joints: { O: { revolute: [ground, w.start] } }
";
    place.put("model.yaml", text);
    let shown = place.run(&["check", "model.yaml"]).ends(0).stdout;
    let bar = shown.lines().find(|line| line.starts_with("  w ")).unwrap();
    assert!(bar.contains(" 1e-15 kg ") && bar.contains("com (5e-7, 0) m") && bar.contains("8.3333333e-29 kg m^2"), "{bar}");
    // √(k/m) of two masses
    let text = "grashof: 1
name: slow and fast
space: planar
gravity: none
bodies: { a: { mass: 1 kg }, b: { mass: 1 kg } }
joints: { A: { slider: [ground, a.origin], axis: [1, 0] }, B: { slider: [ground, b.origin], axis: [1, 0] } }
springs: { s: { joint: A, stiffness: 1e-10 N/m }, u: { joint: B, stiffness: 1e6 N/m } }
studies: { l: { linearize: {} } }
";
    place.put("model.yaml", text);
    let poles = place.run(&["run", "model.yaml", "-o", "out", "--no-plots", "--no-report"]).ends(0).stdout;
    assert!(poles.contains("poles [1/s]: 0 ± 1000 i, 0 ± 0.00001 i"), "{poles}");
}

/// A row of a sweep without a solution says nothing of turns where nothing turns.
#[test]
fn what_slides_has_no_turns() {
    let place = Place::new("slides");
    let text = "grashof: 1
name: slide
space: planar
gravity: none
parameters: { a: 1, b: 2 }
bodies: { m: { mass: 1 kg } }
joints: { S: { slider: [ground, m.origin], axis: [1, 0] } }
drivers: { d: { joint: S, position: 1 m/s*t } }
studies:
  s: { kinematics: { over: 1 s, samples: 2 }, sweep: { b: [1, 30] }, scalars: { y: a^2*last(S.position)/1 m }, solve: { vary: a, between: [0, 3], target: { y: 2*a + b } } }
";
    place.put("model.yaml", text);
    place.run(&["run", "model.yaml", "-o", "out", "--no-plots", "--no-report"]);
    let table = place.text("out/s.csv");
    assert!(table.starts_with("b,a,y,reason\n") && table.lines().count() == 3, "{table}");
}

#[test]
fn check_tells_angles_as_the_user_measures_them() {
    let place = Place::new("check-angles");
    let text = |joint: &str, measures: &str, units: &str| {
        format!(
            "grashof: 1
name: three rockers
space: planar
gravity: none
{units}
ground: {{ P: [0, 0], R: [600 mm, 300 mm] }}
bodies:
  crank: {{ bar: {{ length: 300 mm, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: 300 mm, mass: 1 kg }} }}
  rocker: {{ bar: {{ length: 300 mm, mass: 1 kg }} }}
joints:
  O: {{ revolute: {joint} }}
  A: {{ revolute: [crank.end, coupler.start] }}
  C: {{ revolute: [ground.R, rocker.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
drivers: {{ turn: {{ joint: O, speed: 60 rpm }} }}
measures: {{ {measures} }}
start: {{ crank.angle: 30 deg, coupler.angle: ~33 deg, rocker.angle: ~120 deg }}
studies:
  part: {{ kinematics: {{ over: 10 deg, samples: 2 }} }}
"
        )
    };
    let along = "[ground.P, crank.start]";
    // the line of the pivots stands at 26.565 deg, and the crank goes 63.435 deg to either side of it
    for (joint, measures, units, range) in [
        (along, "", "", "O.angle -36.869898 to 90 deg"),
        (along, "theta: O.angle", "", "theta -36.869898 to 90 deg"),
        (along, "path: crank.end.x, theta: crank.angle", "units: [mm, deg]", "theta -36.869898 to 90 deg"),
        (along, "phi: 90 deg - O.angle", "", "phi 0 to 126.8699 deg"),
        (along, "theta: O.angle", "units: [rad]", "theta -0.64350111 to 1.5707963 rad"),
        ("[crank.start, ground.P]", "", "", "O.angle -90 to 36.869898 deg"),
    ] {
        place.put("model.yaml", &text(joint, measures, units));
        let done = place.run(&["check", "model.yaml"]).ends(0);
        let line = format!("range of the input        {range}");
        assert!(done.stdout.contains(&line), "no `{line}` in:\n{}", done.stdout);
        let start = if units.contains("rad") { "0.52359878 rad" } else { "30 deg" };
        assert!(done.stdout.contains(start), "no `{start}` in:\n{}", done.stdout);
    }
    // a crank that cannot pass the line of the pivots on its far side, or on either
    place.put("model.yaml", &text(along, "", "").replace("crank: { bar: { length: 300 mm", "crank: { bar: { length: 450 mm"));
    let done = place.run(&["check", "model.yaml"]).ends(0);
    let json = place.run(&["check", "model.yaml", "--json"]).ends(0).json();
    assert_eq!(json["grashof"]["input"], "O");
    let ranges = json["grashof"]["angles"].as_array().unwrap().len();
    assert_eq!(done.stdout.contains(" or "), ranges == 2, "{}", done.stdout);
}

/// A finding for whatever would keep a study from its first row, and none where it would run.
#[test]
fn check_begins_the_studies() {
    let place = Place::new("begins");
    let pendulum = "\
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies:
  upper: { bar: { length: 1 m, mass: 1 kg } }
  lower: { bar: { length: 1 m, mass: 1 kg } }
joints:
  P: { revolute: [ground, upper.start] }
  Q: { revolute: [upper.end, lower.start] }
start: { P.angle: 0 deg, Q.angle: 20 deg }
studies:
  swing: { dynamics: { until: 0.1 s, every: 10 ms } }
";
    let four_bar = model();
    let swing = |more: &str| {
        let text = pendulum
            .replace("bodies:", "parameters: { mass: 1 kg }\nbodies:")
            .replace("lower: { bar: { length: 1 m, mass: 1 kg", "lower: { bar: { length: 1 m, mass: mass");
        text.replace("10 ms }", &format!("10 ms }}, {more}"))
    };
    for (name, text, finding, runs) in [
        ("sound", pendulum.to_owned(), "", true),
        ("massless", pendulum.replace("lower: { bar: { length: 1 m, mass: 1 kg } }", "lower: { bar: { length: 1 m } }"), "`lower`", false),
        (
            "forgotten",
            pendulum.replace("  Q: { revolute: [upper.end, lower.start] }\n", "").replace(", Q.angle: 20 deg", ""),
            "`lower`",
            true,
        ),
        ("free", pendulum.replace("  Q: { revolute: [upper.end, lower.start] }\n", "").replace("Q.angle", "lower.angle"), "", true),
        ("loose", four_bar.replace("joints:\n", "  rod: { bar: { length: 1 m } }\njoints:\n"), "`rod`", false),
        ("swept", swing("sweep: { mass: [-1 kg, 1 kg] }"), "", true),
        ("swept-in-vain", swing("sweep: { mass: [-1 kg, -2 kg] }"), "mass = -1", false),
        (
            "solved",
            swing("scalars: { end: last(P.angle) }, solve: { vary: mass, between: [1 kg, 2 kg], target: { end: -1 deg } }"),
            "",
            false,
        ),
        (
            "solved-in-vain",
            swing("scalars: { end: last(P.angle) }, solve: { vary: mass, between: [-2 kg, -1 kg], target: { end: -1 deg } }"),
            "mass = -2",
            false,
        ),
        (
            "undefined",
            pendulum
                .replace("studies:", "measures: { root: sqrt(Q.angle - 1 rad) }\nstudies:")
                .replace("10 ms }", "10 ms }, columns: [root]"),
            "root",
            false,
        ),
        ("weightless", four_bar.replace(", mass: 3 kg", "").replace(", mass: 6 kg", ""), "no body has a mass", true),
    ] {
        let file = format!("{name}.yaml");
        place.put(&file, &text);
        let checked = place.run(&["check", &file, "--strict"]);
        let ran = place.run(&["run", &file, "--no-plots"]);
        assert_eq!(ran.code == 0, runs, "{name}: {}", ran.stderr);
        let found = checked.stdout.split("findings").nth(1).unwrap_or_default().to_owned();
        assert_eq!(checked.code, i32::from(!finding.is_empty()), "{name}: {}\n{}", checked.stdout, checked.stderr);
        assert!(found.contains(finding), "{name}: {found}");
    }
}

/// What numbers are shown in follows from the expression, not from the value.
#[test]
fn units_follow_from_expressions() {
    let place = Place::new("units");
    place.put(
        "arm.yaml",
        "\
grashof: 1
name: arm
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { m: 2 kg, g: 9.81 m/s^2, J: m*1 m^2 }
bodies: { arm: { bar: { length: 1 m, mass: m } } }
joints: { O: { revolute: [ground, arm.start] } }
drivers: { drive: { joint: O, speed: 30 rpm } }
measures: { degrees: O.angle/1 deg, arc: 1 m*O.angle, spin: rate(O.angle), weight: m*g }
studies:
  turn:
    inverse: { over: 1 turn, samples: 36 }
    columns: [O.angle, degrees, arc, spin, weight]
    scalars:
      in_degrees: max(O.angle)/1 deg
      half: max(O.angle)/2
      rate_squared: max(O.omega)^2
      power_over_torque: max(drive.power)/max(drive.torque)
",
    );
    let done = place.run(&["run", "arm.yaml", "--units", "--no-plots"]).ends(0);
    for line in ["O.angle [rad]", "degrees [1]", "arc [m]", "spin [rad/s]", "weight [N]"] {
        assert!(done.stdout.contains(line), "{line}\n{}", done.stdout);
    }
    let words = |name: &str| -> Vec<String> {
        let line = done.stdout.lines().find(|line| line.split_whitespace().next() == Some(name)).unwrap_or_default();
        line.split_whitespace().skip(1).map(str::to_owned).collect()
    };
    assert_eq!(words("in_degrees"), ["360"]);
    assert_eq!(words("half"), ["3.141592654", "rad"]);
    assert_eq!(words("rate_squared"), ["9.869604401", "rad^2/s^2"]);
    assert_eq!(words("power_over_torque"), ["3.141592654", "1/s"]);
}

/// Results are shown in the units that the model asks for; files stay SI.
#[test]
fn results_are_shown_in_the_units_of_the_model() {
    let place = Place::new("shown");
    let text = model().replacen("parameters:", "units: [mm, deg, kN mm, rad/s]\nparameters:", 1);
    place.put("units.yaml", &text);
    place.put("plain.yaml", &model());
    let [shown, plain] = ["units", "plain"].map(|name| {
        let file = format!("{name}.yaml");
        place.run(&["run", &file, "--study", "turn", "-o", name]).ends(0).stdout
    });
    let number = |text: &str, name: &str| -> (f64, String) {
        let line = text.lines().find(|line| line.split_whitespace().next() == Some(name)).unwrap_or_else(|| panic!("{name}\n{text}"));
        let words: Vec<&str> = line.split_whitespace().collect();
        (words[1].parse().unwrap(), words.get(2).map_or(String::new(), |unit| (*unit).to_owned()))
    };
    let (swing, power) = (number(&shown, "swing"), number(&shown, "mean_power"));
    assert_eq!((swing.1.as_str(), power.1.as_str()), ("deg", "W"));
    assert!((swing.0.to_radians() - number(&plain, "swing").0).abs() < 1e-8);
    assert_eq!(power, number(&plain, "mean_power"));
    assert!(shown.contains("from 90 to 450 deg"), "{shown}");
    for file in ["turn.csv", "turn.json"] {
        assert_eq!(place.text(&format!("units/{file}")), place.text(&format!("plain/{file}")), "{file}");
    }
    assert!(place.text("units/turn-torque.svg").contains("in kN mm<"));
    assert!(place.text("plain/turn-torque.svg").contains("in N m<"));
    let runs = place.run(&["run", "units.yaml", "--study", "lengths", "--no-plots", "-o", "units"]).ends(0).stdout;
    assert!(runs.contains("l3 [mm]") && runs.contains("swing [deg]") && runs.contains(" 550 "), "{runs}");
}
