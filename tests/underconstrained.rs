//! What drivers leave is told by the bodies that move in it.

use grashof::Model;

/// Why the study `s` of a text does not begin, and what to do.
fn refused(text: &str) -> (String, String) {
    let error = Model::parse(text).unwrap_or_else(|e| panic!("{e}")).study("s").unwrap().run().expect_err("a freedom is left");
    (error.to_string().lines().next().unwrap_or_default().to_owned(), error.help())
}

/// A crank and a rocker, whose axes cross, with rods between them; `count` of them, each on pins of its own.
fn linkage(count: usize, ends: [&str; 2]) -> String {
    let (mut bodies, mut joints) = (String::new(), String::new());
    for i in 1..=count {
        bodies += &format!("  rod{i}: {{ bar: {{ length: 35 cm, width: 1 cm, height: 1 cm, mass: 0.8 kg }} }}\n");
        bodies += &format!("  rocker{i}: {{ bar: {{ length: 20 cm, width: 1 cm, height: 1 cm, mass: 0.6 kg }} }}\n");
        joints += &format!("  A{i}: {{ {}: [crank.end, rod{i}.start] }}\n", ends[0]);
        joints += &format!("  B{i}: {{ {}: [rod{i}.end, rocker{i}.end] }}\n", ends[1]);
        joints += &format!("  C{i}: {{ revolute: [ground.C, rocker{i}.start], axis: [1, 0, 0], to: [0, 0, 1] }}\n");
    }
    format!(
        "
grashof: 1
name: linkage
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: {{ O: [0, 0, 0], C: [30 cm, 20 cm, 5 cm] }}
bodies:
  crank: {{ bar: {{ length: 8 cm, width: 1 cm, height: 1 cm, mass: 0.3 kg }} }}
{bodies}
joints:
  O: {{ revolute: [ground.O, crank.start], axis: [0, 0, 1] }}
{joints}
drivers: {{ drive: {{ joint: O, speed: 90 rpm }} }}
start: {{ O.angle: 0 deg }}
studies: {{ s: {{ inverse: {{ over: 10 deg, samples: 4 }} }} }}
"
    )
}

#[test]
fn a_rod_between_balls_can_spin() {
    let (why, help) = refused(&linkage(1, ["spherical"; 2]));
    assert!(why.ends_with("`inverse`; `rod1` can spin about the line from joint `A1` to joint `B1`"), "{why}");
    assert_eq!(help, "make one of `A1` and `B1` a `universal` joint, or take a joint of the kind `distance` in the place of `rod1`");
    let (why, _) = refused(&linkage(2, ["spherical"; 2]));
    for words in ["2 are left undetermined", "; `rod1` can spin", "from joint `A2` to joint `B2`"] {
        assert!(why.contains(words), "{why}");
    }
    assert!(!why.contains("can still move"), "{why}");
    // the remedy is one
    let crossed = linkage(1, ["universal", "spherical"]).replace("rod1.start] }", "rod1.start], axes: [[0, 0, 1], [0, 1, 0]] }");
    Model::parse(&crossed).unwrap().study("s").unwrap().run().unwrap();
}

#[test]
fn a_pendulum_that_hangs_loose_is_named_alone() {
    let text = "
grashof: 1
name: four-bar
space: planar
gravity: none
ground: { O: [0, 0], C: [1 m, 0] }
bodies:
  crank: { bar: { length: 15 cm } }
  coupler: { bar: { length: 1 m } }
  rocker: { bar: { length: 55 cm } }
  bob: { bar: { length: 10 cm } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
  P: { revolute: [rocker.end, bob.start] }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 90 deg, coupler.angle: ~25 deg, rocker.angle: ~90 deg }
studies: { s: { kinematics: { over: 1 turn, samples: 12 } } }
";
    let (why, help) = refused(text);
    assert!(why.ends_with("`kinematics`; body `bob` can still move"), "{why}");
    assert!(help.starts_with("add a driver"), "{help}");
}

#[test]
fn all_that_moves_in_several_motions_is_named() {
    let text = "
grashof: 1
name: chain
space: spatial
gravity: none
bodies:
  base: { bar: { length: 1 m, width: 1 cm, height: 1 cm, mass: 1 kg } }
  upper: { bar: { length: 1 m, width: 1 cm, height: 1 cm, mass: 1 kg } }
  lower: { bar: { length: 1 m, width: 1 cm, height: 1 cm, mass: 1 kg } }
joints:
  O: { revolute: [ground, base.start], axis: [0, 0, 1] }
  P: { spherical: [base.end, upper.start] }
  Q: { spherical: [upper.end, lower.start] }
drivers: { drive: { joint: O, speed: 60 rpm } }
studies: { s: { kinematics: { over: 1 turn, samples: 12 } } }
";
    let (why, _) = refused(text);
    assert!(why.contains("6 are left undetermined"), "{why}");
    assert!(why.ends_with("`kinematics`; bodies `upper` and `lower` can still move"), "{why}");
}
