//! Closed chains: minima of an energy that is written by hand, redundant rows, what a driver holds.

use super::{all_are, list, near, planar, rest, run, sorted, zeros};

/// Lengths of the four-bar, m, masses, kg, and its spring.
const LENGTHS: [f64; 4] = [0.3, 0.5, 0.45, 0.6];
const MASSES: [f64; 3] = [1.0, 2.0, 1.5];
const G: f64 = 9.81;

/// The rest of a file with the linkage; `joint` may change one of its joints.
fn four_bar(stiffness: f64, cut: [&str; 4], start: &str) -> String {
    let [m1, m2, m3] = MASSES;
    let [l1, l2, l3, l4] = LENGTHS;
    let [o, a, b, c] = cut;
    format!(
        "ground: {{ O: [0, 0], C: [{l4} m, 0], post: [-0.2 m, 0.5 m] }}
bodies:
  crank: {{ bar: {{ length: {l1} m, mass: {m1} kg }} }}
  coupler: {{ bar: {{ length: {l2} m, mass: {m2} kg }} }}
  rocker: {{ bar: {{ length: {l3} m, mass: {m3} kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start]{o} }}
  A: {{ revolute: [crank.end, coupler.start]{a} }}
  B: {{ revolute: [coupler.end, rocker.end]{b} }}
  C: {{ revolute: [ground.C, rocker.start]{c} }}
springs: {{ s: {{ between: [ground.post, crank.end], stiffness: {stiffness} N/m, length: 0.2 m }} }}
start: {{ {start} }}"
    )
}

const START: &str = "O.angle: 60 deg, coupler.angle: ~30 deg, rocker.angle: ~80 deg";

/// The energy of the open branch by the angle of the crank, from the circles of coupler and rocker.
fn energy(theta: f64, stiffness: f64) -> f64 {
    let [a, b, c, d] = LENGTHS;
    let pin = [a * theta.cos(), a * theta.sin()];
    let across = [d - pin[0], -pin[1]];
    let distance = across[0].hypot(across[1]);
    let along = (b * b - c * c + distance * distance) / (2.0 * distance);
    let height = (b * b - along * along).sqrt();
    let unit = [across[0] / distance, across[1] / distance];
    let far = [pin[0] + along * unit[0] - height * unit[1], pin[1] + along * unit[1] + height * unit[0]];
    let weights = MASSES[0] * 0.5 * pin[1] + MASSES[1] * 0.5 * (pin[1] + far[1]) + MASSES[2] * 0.5 * far[1];
    let stretch = (pin[0] + 0.2).hypot(pin[1] - 0.5) - 0.2;
    G * weights + 0.5 * stiffness * stretch * stretch
}

/// dV/dθ by a central difference of fourth order.
fn slope(theta: f64, stiffness: f64) -> f64 {
    let h = 1e-3;
    let v = |k: f64| energy(theta + k * h, stiffness);
    (8.0 * (v(1.0) - v(-1.0)) - (v(2.0) - v(-2.0))) / (12.0 * h)
}

#[test]
fn a_four_bar_rests_where_its_energy_does() {
    for stiffness in [0.0, 40.0, 300.0] {
        // the crank turns fully: shortest and longest link are less than the other two
        let places = zeros(|x| slope(x, stiffness), -3.0, 3.28, 2000);
        assert!(places.len() >= 2, "{places:?}");
        let minimum = |x: f64| slope(x + 1e-4, stiffness) > 0.0;
        let outcome = planar("[0, -9.81 m/s^2]", &four_bar(stiffness, [""; 4], START), "");
        assert_eq!(outcome.results, [1.0]);
        // downhill from the start
        let from = 60_f64.to_radians();
        let down = places.iter().copied().filter(|x| minimum(*x)).min_by(|x, y| {
            let way = |x: f64| (-(x - from) * slope(from, stiffness).signum()).rem_euclid(std::f64::consts::TAU);
            way(*x).total_cmp(&way(*y))
        });
        // the place a turn away is the same
        let within = |x: f64| (x + 3.0).rem_euclid(std::f64::consts::TAU) - 3.0;
        near(within(list(&outcome, "equilibria.O.angle")[0]), down.unwrap(), 1e-8);
        // and all of them
        let mut found: Vec<(f64, f64)> = sorted(&outcome, "O.angle").into_iter().map(|(x, s)| (within(x), s)).collect();
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        let wanted: Vec<(f64, f64)> = places.iter().map(|x| (*x, if minimum(*x) { 1.0 } else { 0.0 })).collect();
        all_are(&found, &wanted, 1e-8);
    }
}

#[test]
fn the_place_of_the_cut_does_not_matter() {
    let cut = ", cut: true";
    let of = |cuts: [&str; 4]| {
        // where every body is free, the crank's angle is a column
        let outcome = planar(
            "[0, -9.81 m/s^2]",
            &four_bar(40.0, cuts, START),
            "angle: last(crank.angle), force: last(B.f), far: last(coupler.end.y)",
        );
        (outcome.scalars, outcome.results)
    };
    let (usual, stable) = of([""; 4]);
    for cuts in [[cut, "", "", ""], ["", cut, "", ""], ["", "", "", cut], [cut, cut, cut, cut]] {
        let (found, also) = of(cuts);
        assert_eq!(also, stable);
        usual.iter().zip(&found).for_each(|(x, y)| near(*y, *x, 1e-9));
    }
}

#[test]
fn redundant_rockers_share_the_load() {
    // a table on two or three equal parallel rockers with a torsion spring in one: m g a cos θ = k (θ0 − θ), twice
    let table = |third: &str, joints: &str| {
        planar(
            "[0, -9.81 m/s^2]",
            &format!(
                "ground: {{ A: [0, 0], B: [1 m, 0], C: [2 m, 0] }}
bodies:
  one: {{ bar: {{ length: 0.4 m }} }}
  two: {{ bar: {{ length: 0.4 m }} }}
{third}  table: {{ mass: 5 kg, com: [1 m, 0], points: {{ A: [0, 0], B: [1 m, 0], C: [2 m, 0] }} }}
joints:
  A: {{ revolute: [ground.A, one.start] }}
  B: {{ revolute: [ground.B, two.start] }}
  P: {{ revolute: [one.end, table.A] }}
  Q: {{ revolute: [two.end, table.B] }}
{joints}springs: {{ s: {{ joint: A, stiffness: 30 N m/rad, rest: 120 deg }} }}
start: {{ A.angle: 80 deg, table.angle: ~0 deg, B.angle: ~80 deg }}"
            ),
            "angle: last(A.angle), fy: last(A.fy) + last(B.fy)",
        )
    };
    let theta = super::zero(|x| 5.0 * G * 0.4 * x.cos() - 30.0 * (120_f64.to_radians() - x), 0.0, 3.0);
    let two = table("", "");
    near(two.scalars[0], theta, 1e-10);
    near(two.scalars[1], 5.0 * G, 1e-8);
    let three = table(
        "  three: { bar: { length: 0.4 m } }\n",
        "  C: { revolute: [ground.C, three.start] }\n  R: { revolute: [three.end, table.C] }\n",
    );
    near(three.scalars[0], theta, 1e-9);
    assert_eq!((two.results[0], three.results[0]), (1.0, 1.0));
}

#[test]
fn a_driver_holds_its_position() {
    let outcome = planar(
        "[0, -9.81 m/s^2]",
        "bodies:
  arm: { bar: { length: 2 m, mass: 3 kg } }
  bob: { bar: { length: 1 m, mass: 1 kg } }
joints: { O: { revolute: [ground, arm.start] }, P: { revolute: [arm.end, bob.start] } }
drivers: { drive: { joint: O, speed: 120 rpm } }
start: { O.angle: 30 deg, P.angle: 10 deg }",
        "torque: last(drive.torque), power: last(drive.power), angle: last(O.angle), hang: last(bob.angle)",
    );
    let c = 30_f64.to_radians();
    near(outcome.scalars[0], (3.0 + 2.0) * G * c.cos(), 1e-11);
    assert_eq!(outcome.scalars[1], 0.0);
    near(outcome.scalars[2], c, 1e-15);
    near(outcome.scalars[3], -std::f64::consts::FRAC_PI_2, 1e-12);
    assert_eq!(outcome.lists.len(), 2);
}

#[test]
fn a_mechanism_that_cannot_move_rests() {
    let of = |rest_of_file: &str| planar("[0, -9.81 m/s^2]", rest_of_file, "force: last(W.fy)");
    // nothing moves at all
    let fixed = of("bodies: { block: { mass: 2 kg } }\njoints: { W: { fixed: [ground, block.origin] } }");
    assert_eq!(fixed.results, [1.0]);
    near(fixed.scalars[0], 2.0 * G, 1e-12);
    // one driver takes the one freedom
    let held = of("bodies: { arm: { bar: { length: 1 m, mass: 2 kg } } }
joints: { W: { revolute: [ground, arm.start] } }
drivers: { drive: { joint: W, speed: 1 rpm } }");
    assert_eq!(held.results, [1.0]);
    near(held.scalars[0], 2.0 * G, 1e-12);
    assert_eq!(held.lists.len(), 1);
}

#[test]
fn rest_is_rest_in_motion() {
    // what is found is an equilibrium of the equations of motion: there a run stays, and leaves an unstable one
    let with = |start: &str, study: &str| {
        format!(
            "grashof: 1\nname: test\nspace: planar\ngravity: [0, -9.81 m/s^2]\n{}\nstudies: {{ rest: {{ {study} }} }}\n",
            four_bar(40.0, [""; 4], start)
        )
    };
    let found = rest(&with(START, "statics: { from: start }"));
    for (&angle, &stable) in list(&found, "equilibria.O.angle").iter().zip(list(&found, "equilibria.stable")) {
        for (beside, leaves) in [(0.0, false), (1e-4, stable == 0.0)] {
            let start = format!("O.angle: {} rad, O.omega: 0 rad/s, coupler.angle: ~30 deg, rocker.angle: ~80 deg", angle + beside);
            let moved =
                run(&with(&start, "dynamics: { until: 2 s, tolerance: 1e-10 }, scalars: { way: max(O.angle) - min(O.angle) }"), "rest");
            let way = moved.scalars[0];
            assert_eq!(way > 0.1, leaves, "{angle} {beside}: {way}");
            assert!(leaves || way <= 1e-7 + 2.5 * beside, "{angle} {beside}: {way}");
        }
    }
}

#[test]
fn no_path_is_drawn_through_equilibria() {
    let outcome = run(
        "grashof: 1
name: two pendulums
space: planar
gravity: [0, -9.81 m/s^2]
bodies:
  a: { bar: { length: 1 m, mass: 1 kg } }
  b: { bar: { length: 1 m, mass: 1 kg } }
joints:
  A: { revolute: [ground, a.start] }
  B: { revolute: [a.end, b.start] }
start: { A.angle: -80 deg, B.angle: 10 deg }
studies: { rest: { statics: { from: start }, columns: [b.end.x, b.end.y], trace: [b.end] } }
",
        "rest",
    );
    let equilibria = &outcome.scenes.iter().find(|(name, _)| name == "equilibria").unwrap().1;
    assert_eq!((equilibria.frames.count(), equilibria.traces.len()), (4, 0));
}
