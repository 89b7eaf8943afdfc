//! What a command line says and probably does not mean.

use super::*;

pub(super) const PENDULUM: &str = "\
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { begin: 20 deg, long: 1 m }
bodies: { bob: { bar: { length: long, mass: 1 kg } } }
joints: { P: { revolute: [ground, bob.start] } }
start: { P.angle: begin }
studies: { swing: { dynamics: { until: 0.1 s }, scalars: { end: last(P.angle) } } }
";

#[test]
fn degrees_without_their_unit_are_asked_for_wherever_they_are_given() {
    let place = Place::new("bare-angles");
    place.put("p.yaml", PENDULUM);
    for (command, given, told) in [
        ("check", &["--set", "begin=45"][..], 1),
        ("run", &["--set", "begin=45", "-o", "run"], 1),
        ("modes", &["--set", "begin=45", "-o", "modes"], 1),
        ("statics", &["--set", "begin=45", "-o", "statics"], 1),
        ("compare", &["--set", "begin=45", "-o", "compare", "--no-plots", "--integrators", "dop853", "--tolerances", "1e-6"], 1),
        ("sweep", &["--over", "begin=30,45", "-o", "list"], 2),
        ("sweep", &["--over", "begin=0 deg,45", "-o", "one"], 1),
        ("sweep", &["--over", "begin=0..45:2", "-o", "range"], 1),
        ("sweep", &["--over", "begin=normal(45, 1)", "--samples", "2", "-o", "drawn"], 1),
        ("sweep", &["--over", "long,begin=1 m,45; 2 m,10 deg", "-o", "points"], 1),
        ("sweep", &["--over", "long=1 m,2 m", "--set", "begin=45", "-o", "beside"], 1),
        ("sweep", &["--over", "begin=30,45", "-o", "quiet", "-q"], 0),
        ("sweep", &["--over", "begin=1,2", "-o", "radians"], 0),
    ] {
        let done = place.run(&[&[command, "p.yaml"], given].concat()).ends(0);
        let count = done.stderr.lines().filter(|line| line.starts_with("warning[bare-angle]")).count();
        assert_eq!(count, told, "{command} {given:?}\n{}", done.stderr);
    }
    let done = place.run(&["sweep", "p.yaml", "--over", "begin=10 deg,45", "-o", "place"]).ends(0);
    for line in ["`begin` is 45 rad, more than a turn", "--over begin=10 deg,45", "if degrees are meant, write `45 deg`"] {
        assert!(done.stderr.contains(line), "{line}\n{}", done.stderr);
    }
}
