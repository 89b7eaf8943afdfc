//! Equilibria that are known in closed form.

use super::{all_are, findings, list, near, planar, sorted, zeros};
use std::f64::consts::{FRAC_PI_2, PI};

const G: f64 = 9.81;

#[test]
fn a_mass_sags_on_its_spring() {
    let outcome = planar(
        "[0, -9.81 m/s^2]",
        "ground: { O: [0, 0] }
bodies: { bob: { mass: 3 kg } }
joints: { S: { slider: [ground.O, bob.origin], axis: [0, 1] } }
springs: { s: { joint: S, stiffness: 170 N/m, rest: -20 cm } }
start: { S.position: 0.1 m }",
        "y: last(bob.y), force: last(s.force), reaction: last(S.f), kinetic: min(energy.kinetic), average: mean(bob.y), whole: integral(bob.y), at: \"value(bob.y, 0 s)\", later: \"value(bob.y, 1 s)\"",
    );
    let y = -0.2 - 3.0 * G / 170.0;
    near(outcome.scalars[0], y, 1e-14);
    near(outcome.scalars[1], -3.0 * G, 1e-12);
    near(outcome.scalars[2], 0.0, 1e-12);
    // one row stands for the whole study
    assert_eq!(outcome.scalars[4], outcome.scalars[0]);
    assert_eq!((outcome.scalars[3], outcome.scalars[5], outcome.scalars[6]), (0.0, 0.0, outcome.scalars[0]));
    assert!(outcome.scalars[7].is_nan());
    assert_eq!((outcome.rows.len(), outcome.places[0], outcome.results[0]), (1, 0.0, 1.0));
    all_are(&sorted(&outcome, "S.position"), &[(y, 1.0)], 1e-14);
}

fn pendulum(angle: &str) -> grashof::studies::common::outcome::Outcome {
    planar(
        "[0, -9.81 m/s^2]",
        &format!(
            "bodies: {{ bob: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ P: {{ revolute: [ground, bob.start] }} }}
start: {{ P.angle: {angle} }}"
        ),
        "pull: last(P.fy), angle: last(P.angle)",
    )
}

#[test]
fn a_pendulum_hangs_or_stands() {
    let falls = pendulum("60 deg");
    assert_eq!(falls.results, [1.0]);
    near(list(&falls, "equilibria.P.angle")[0], -FRAC_PI_2, 1e-14);
    near(falls.scalars[0], 2.0 * G, 1e-12);
    all_are(&sorted(&falls, "P.angle"), &[(-FRAC_PI_2, 1.0), (FRAC_PI_2, 0.0)], 1e-12);
    assert_eq!(findings(&falls, "equilibrium"), ["P.angle = -90 deg: stable"]);
    assert_eq!(findings(&falls, "further-equilibrium"), ["P.angle = 90 deg: unstable, it falls along `P.angle`"]);
    // what stands at the start stays, and the other one is told
    let stands = pendulum("90 deg");
    assert_eq!(stands.results, [0.0]);
    near(stands.scalars[1], FRAC_PI_2, 1e-14);
    assert_eq!(stands.lists[1].values[0], 0.0);
    // the same pose a turn on is the same equilibrium
    assert_eq!(list(&stands, "equilibria.P.angle").len(), 2);
    // beside the top it falls to its side
    near(list(&pendulum("89.9 deg"), "equilibria.P.angle")[0], -FRAC_PI_2, 1e-14);
    near(list(&pendulum("90.1 deg"), "equilibria.P.angle")[0], 1.5 * PI, 1e-13);
}

/// A point mass on a massless rod of 1 m that a torsion spring holds upright; `part` is k/(m g l).
fn inverted(part: f64, start: &str) -> grashof::studies::common::outcome::Outcome {
    planar(
        "[0, -9.81 m/s^2]",
        &format!(
            "bodies: {{ rod: {{ bar: {{ length: 1 m }}, attached: {{ bob: {{ at: end, mass: 1 kg }} }} }} }}
joints: {{ P: {{ revolute: [ground, rod.start], zero: -90 deg }} }}
springs: {{ s: {{ joint: P, stiffness: {k} N m/rad }} }}
start: {{ P.angle: {start} }}",
            k = part * G
        ),
        "",
    )
}

#[test]
fn an_inverted_pendulum_forks() {
    // k θ = m g l sin θ: upright alone for k > m g l, else upright unstable between two stable ones
    all_are(&sorted(&inverted(1.1, "20 deg"), "P.angle"), &[(0.0, 1.0)], 1e-12);
    for theta in [0.3, 1.2, 2.0] {
        let forked = inverted(f64::sin(theta) / theta, "10 deg");
        near(list(&forked, "equilibria.P.angle")[0], theta, 1e-11);
        all_are(&sorted(&forked, "P.angle"), &[(-theta, 1.0), (0.0, 0.0), (theta, 1.0)], 1e-11);
        near(list(&inverted(f64::sin(theta) / theta, "-10 deg"), "equilibria.P.angle")[0], -theta, 1e-11);
    }
    // at the fork itself nothing holds it to first order, and the force grows with the third power: the place is known to its root
    let critical = inverted(1.0, "0 deg");
    assert_eq!(critical.results, [0.0]);
    assert_eq!(findings(&critical, "equilibrium"), ["P.angle = 0 deg: indifferent, nothing holds `P.angle`"]);
    let beside = inverted(1.0, "10 deg");
    near(list(&beside, "equilibria.P.angle")[0], 0.0, 1e-4);
    assert_eq!(beside.results, [0.0]);
}

const TRUSS: &str = "ground: { L: [-1 m, 0], R: [1 m, 0], O: [0, 0] }
bodies: { node: { mass: 1 kg } }
joints: { G: { slider: [ground.O, node.origin], axis: [0, 1] } }
springs:
  left: { between: [ground.L, node.origin], stiffness: 1000 N/m, length: 1.2 m }
  right: { between: [ground.R, node.origin], stiffness: 1000 N/m, length: 1.2 m }";

/// Force of a von Mises truss on its node, upwards, N.
fn truss(y: f64) -> f64 {
    let length = (1.0 + y * y).sqrt();
    -2.0 * 1000.0 * (length - 1.2) * y / length
}

#[test]
fn a_truss_snaps_through() {
    let loaded = |load: f64| {
        planar(
            "none",
            &format!("{TRUSS}\nloads: {{ push: {{ at: node.origin, force: [0, {} N] }} }}\nstart: {{ G.position: 0.7 m }}", -load),
            "",
        )
    };
    let free = 0.44_f64.sqrt();
    all_are(&sorted(&loaded(0.0), "G.position"), &[(-free, 1.0), (0.0, 0.0), (free, 1.0)], 1e-11);
    // the unstable branch in closed form: y = 0.3 carries this load
    let load = truss(0.3);
    let wanted = zeros(|y| truss(y) - load, -2.0, 2.0, 4000);
    assert_eq!(wanted.len(), 3);
    near(wanted[1], 0.3, 1e-12);
    let outcome = loaded(load);
    near(list(&outcome, "equilibria.G.position")[0], wanted[2], 1e-11);
    all_are(&sorted(&outcome, "G.position"), &[(wanted[0], 1.0), (0.3, 0.0), (wanted[2], 1.0)], 1e-11);
    // the limit load stands at L³ = L₀ b²; beyond it the truss falls through
    let top = ((1.2_f64).powf(2.0 / 3.0) - 1.0).sqrt();
    let beyond = 1.01 * truss(top);
    let wanted = zeros(|y| truss(y) - beyond, -2.0, 2.0, 4000);
    assert_eq!(wanted.len(), 1);
    all_are(&sorted(&loaded(beyond), "G.position"), &[(wanted[0], 1.0)], 1e-11);
}

#[test]
fn a_strut_buckles() {
    // two massless links of l = 1 m in a line under a weight, guided, with a torsion spring between them. The energy
    // 2 m g l cos θ + ½ k (2θ)² has no slope at 4 k θ = 2 m g l sin θ
    let outcome = planar(
        "[0, -9.81 m/s^2]",
        "ground: { O: [0, 0] }
bodies:
  lower: { bar: { length: 1 m } }
  upper: { bar: { length: 1 m } }
  cap: { mass: 2 kg }
joints:
  A: { revolute: [ground.O, lower.start], zero: -90 deg }
  B: { revolute: [lower.end, upper.start] }
  C: { revolute: [upper.end, cap.origin] }
  W: { slider: [ground.O, cap.origin], axis: [0, 1] }
springs: { s: { joint: B, stiffness: 4 N m/rad } }
start: { A.angle: 2 deg, B.angle: ~-4 deg, W.position: ~2 m }",
        "",
    );
    let theta = super::zero(|x| 4.0 * 4.0 * x - 2.0 * 2.0 * G * x.sin(), 0.5, 3.0);
    near(list(&outcome, "equilibria.A.angle")[0], theta, 1e-10);
    assert_eq!(outcome.results, [1.0]);
}

#[test]
fn a_ridge_is_left() {
    // energy (x² − 1)² + 5 y²: from x = 0 the mass sinks exactly on the ridge between two valleys
    let outcome = planar(
        "none",
        "bodies: { cart: { mass: 1 kg }, ram: { mass: 2 kg } }
joints: { X: { slider: [ground, cart.origin], axis: [1, 0] }, Y: { slider: [cart.origin, ram.origin], axis: [0, 1] } }
loads:
  valley: { joint: X, force: -4 N/m^3*X.position*(X.position^2 - 1 m^2) }
  floor: { joint: Y, force: -10 N/m*Y.position }
start: { X.position: 0 m, Y.position: 2 m }",
        "",
    );
    near(list(&outcome, "equilibria.X.position")[0], 1.0, 1e-11);
    near(list(&outcome, "equilibria.Y.position")[0], 0.0, 1e-11);
    all_are(&sorted(&outcome, "X.position"), &[(-1.0, 1.0), (0.0, 0.0), (1.0, 1.0)], 1e-10);
}

/// A mass that a spring holds to one side and pushes away to the other, relaxed in its kink: it is stable where both sides hold, whichever of
/// them the law counts the kink to, for one mass and for more than a hundred.
#[test]
fn what_one_side_of_a_kink_pushes_away_is_not_stable() {
    let text = |left: f64, right: f64, bodies: usize| {
        let each = |of: &dyn Fn(usize) -> String| (0..bodies).map(of).collect::<Vec<_>>().join(", ");
        format!(
            "grashof: 1
name: sides
space: planar
gravity: none
tables: {{ kink: {{ points: [[-1 m, {} N], [0 m, 0 N], [1 m, {right} N]], beyond: linear }} }}
bodies: {{ {} }}
joints: {{ {} }}
springs: {{ s: {{ joint: J0, force: kink }}, {} }}
studies: {{ s: {{ statics: {{ from: start }} }} }}
",
            -left,
            each(&|i| format!("a{i}: {{ mass: 1 kg }}")),
            each(&|i| format!("J{i}: {{ slider: [ground, a{i}.origin], axis: [1, 0] }}")),
            each(&|i| format!("t{i}: {{ joint: J{i}, stiffness: {} N/m }}", if i == 0 { 1.0 } else { 7.0 }))
        )
    };
    for bodies in [1, 3, 120] {
        for (left, right, stable) in
            [(100.0, 10.0, true), (100.0, -10.0, false), (-100.0, 10.0, false), (-100.0, -10.0, false), (10.0, 100.0, true)]
        {
            let outcome = crate::common::study(&text(left, right, bodies), "s", grashof::mechanism::Coordinates::Joint);
            let told = &outcome.findings.iter().find(|f| f.code == "equilibrium").expect("a verdict").message;
            let right = if stable { "stable" } else { "unstable, it falls along `J0.position`" };
            assert!(
                outcome.results[0] == f64::from(u8::from(stable)) && told.contains(&format!(": {right}")),
                "{left}, {right}, {bodies}: {told}"
            );
        }
    }
}

/// A weight slides down onto a spring that pushes away on its other side: it comes to rest in the kink, falls through it, and rests on the
/// stop of a spring below; pushed to the side that holds it would stay in the kink for ever.
#[test]
fn what_comes_to_rest_in_a_kink_is_pushed_to_the_side_that_falls() {
    let text = "grashof: 1
name: through a kink
space: planar
gravity: none
tables: { law: { points: [[-2 m, -50 N], [-1 m, 50 N], [0 m, 0 N], [1 m, 10 N]], beyond: linear } }
bodies: { a: { mass: 1 kg } }
joints: { J: { slider: [ground, a.origin], axis: [1, 0] } }
springs: { s: { joint: J, force: law } }
start: { J.position: 0.3 m }
studies: { s: { statics: { from: start }, scalars: { x: last(J.position) } } }
";
    let outcome = crate::common::study(text, "s", grashof::mechanism::Coordinates::Joint);
    near(outcome.scalars[0], -1.5, 1e-9);
    assert_eq!(outcome.results[0], 1.0, "{:?}", outcome.findings);
}
