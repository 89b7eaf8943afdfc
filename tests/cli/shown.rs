//! Units on the terminal.

use super::doubts::PENDULUM;
use super::*;

#[test]
fn what_has_a_unit_is_told_with_it() {
    let place = Place::with_model("told-units");
    let solve = "    solve: { vary: l3, between: [40 cm, 60 cm], target: { swing: 40 deg } }\n";
    place.put("solve.yaml", &(model() + solve).replace("    sweep: { l3: [10 cm, 50 cm, 55 cm, 5 m] }\n", ""));
    let done = place.run(&["run", "solve.yaml", "--study", "lengths", "--no-plots", "-o", "out"]).ends(0);
    let solved = done.stdout.lines().find(|line| line.contains("solved:")).unwrap();
    assert!(solved.contains(" cm (") && solved.ends_with("swing = 0.6981317008 rad"), "{solved}");
    assert!(done.stdout.contains("13 rows over theta from 1.570796 to 7.853982 rad"), "{}", done.stdout);
    place.put(
        "units.yaml",
        &(model() + solve).replace("    sweep: { l3: [10 cm, 50 cm, 55 cm, 5 m] }\n", "").replace("studies:", "units: [deg]\nstudies:"),
    );
    let done = place.run(&["run", "units.yaml", "--study", "lengths", "--no-plots", "-o", "out"]).ends(0);
    assert!(done.stdout.contains("swing = 40 deg") && done.stdout.contains("from 90 to 450 deg"), "{}", done.stdout);
    place.put("p.yaml", PENDULUM);
    let done = place.run(&["modes", "p.yaml", "--at", "statics", "-o", "modes"]).ends(0);
    let head = done.stdout.lines().find(|line| line.contains("period [s]")).unwrap();
    assert!(head.contains("  cycles [1/s]  period [s]"), "{head}");
}
