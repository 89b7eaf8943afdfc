//! The start that `check` shows.

use super::*;

/// The lines of `check` below `start`.
fn start(stdout: &str) -> Vec<Vec<&str>> {
    let lines = stdout.lines().skip_while(|line| !line.starts_with("start ")).skip(1);
    lines.take_while(|line| line.starts_with("  ")).map(|line| line.split_whitespace().collect()).collect()
}

#[test]
fn check_shows_the_start_where_nothing_was_asked() {
    let place = Place::new("start");
    let begins = MODEL.find("start:").unwrap();
    let whole = &MODEL[..begins + MODEL[begins..].find('\n').unwrap() + 1];
    let text = |start: &str| whole[..begins].to_owned() + start;
    place.put("silent.yaml", &text("units: [deg]\n"));
    let done = place.run(&["check", "silent.yaml"]).ends(0);
    let lines = start(&done.stdout);
    let names: Vec<&str> = lines.iter().filter(|line| line[1] == "-").map(|line| line[0]).collect();
    assert_eq!(names, ["O.angle", "A.angle", "B.angle", "C.angle"]);
    let report = place.run(&["check", "silent.yaml", "--json"]).ends(0).json();
    for (line, joint) in lines.iter().zip(report["joints"].as_array().unwrap()) {
        let (shown, angle) = (line[2].parse::<f64>().unwrap(), joint["start"]["angle"].as_f64().unwrap());
        assert!((shown.to_radians() - angle).abs() < 1e-7 && line[3] == "deg", "{line:?}, {joint}");
    }
    // the loop is closed there
    let closes = |k: usize| report["joints"][k]["start"]["angle"].as_f64().unwrap();
    let [crank, coupler] = [closes(0), closes(0) + closes(1)];
    let rocker = closes(3);
    assert!((0.15 * crank.cos() + coupler.cos() - 0.55 * rocker.cos() - 1.0).abs() < 1e-9);
    assert!((0.15 * crank.sin() + coupler.sin() - 0.55 * rocker.sin()).abs() < 1e-9);
    // what follows from what was asked is not shown as well
    place.put("asked.yaml", whole);
    let done = place.run(&["check", "asked.yaml"]).ends(0);
    let names: Vec<&str> = start(&done.stdout).iter().map(|line| line[0]).collect();
    assert_eq!(names, ["O.angle", "coupler.angle", "rocker.angle"]);
}

#[test]
fn check_shows_few_of_many_joints() {
    let place = Place::new("many-joints");
    let (mut bodies, mut joints) = (String::new(), String::new());
    for i in 1..=20 {
        bodies += &format!("  b{i}: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n");
        joints +=
            &format!("  J{i}: {{ revolute: [{}, b{i}.start] }}\n", if i == 1 { "ground".to_owned() } else { format!("b{}.end", i - 1) });
    }
    let head = "grashof: 1\nname: chain\nspace: planar\ngravity: none\n";
    place.put("chain.yaml", &format!("{head}bodies:\n{bodies}joints:\n{joints}"));
    let done = place.run(&["check", "chain.yaml"]).ends(0);
    assert_eq!(start(&done.stdout).len(), 13, "{}", done.stdout);
    assert!(done.stdout.contains("  and 8 values of other joints; `--json` has all"), "{}", done.stdout);
}

/// A point mass has no angle, so that the joint that pins it has no coordinate.
#[test]
fn a_point_mass_that_is_pinned_has_no_angle_to_show() {
    let place = Place::new("pinned-mass");
    let joints = "  A: { revolute: [crank.end, coupler.start] }\n";
    assert!(MODEL.contains(joints) && MODEL.contains("bodies:\n"));
    let text = MODEL.replace(joints, &format!("{joints}  W: {{ revolute: [crank.end, weight.origin] }}\n"));
    let text = &text[..text.find("variants:").unwrap()];
    let text = format!("{text}studies: {{ turn: {{ inverse: {{ over: 1 turn, samples: 24 }} }} }}\n");
    place.put("m.yaml", &text.replace("bodies:\n", "bodies:\n  weight: { mass: 2 kg }\n"));
    let report = place.run(&["check", "m.yaml", "--json"]).ends(0).json();
    let pinned = report["joints"].as_array().unwrap().iter().find(|joint| joint["name"] == "W").unwrap();
    assert!(pinned.get("start").is_none_or(|start| start.as_object().unwrap().is_empty()), "{pinned}");
    place.run(&["run", "m.yaml", "--no-plots"]).ends(0);
}
