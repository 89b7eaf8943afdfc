//! Vibrations about a held pose: closed forms, equivalences, the second derivative of energy, and the methods against each other.

mod chains;
mod eigensolvers;
mod many;
mod many_damped;
mod meeting;
mod order;
mod pictures;
mod round_off;
mod sides;

use crate::common;
use crate::common::{assembled, close, slope, study};
use grashof::dynamics::{Differentiable, Dynamics, Linearizer};
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::held::{Held, Pose, settled};
use grashof::kinematics::partition::preferred;
use grashof::mechanism::{Coordinates, Mechanism};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::modes::damped::{damped, state_matrix};
use grashof::studies::modes::eigen::library;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::process::Command;

const G: f64 = 9.81;

fn list<'a>(outcome: &'a Outcome, name: &str) -> &'a [f64] {
    let found = outcome.lists.iter().find(|l| l.name == name);
    found.map_or_else(|| panic!("no list {name} among {:?}", outcome.lists), |l| l.values.as_slice())
}

fn codes(outcome: &Outcome) -> Vec<&str> {
    outcome.findings.iter().map(|f| &*f.code).collect()
}

/// A mechanism in its assembled start, held there.
fn held<S>(text: &str, coordinates: Coordinates) -> (Differentiable<S>, Vec<f64>, Vec<i32>, Held)
where
    S: Space<S = f64>,
{
    let (m, start) = assembled::<S>(text, coordinates);
    let modes = settled(&m, [&start.q, &vec![0.0; m.nv], &m.state_starts], &start.modes);
    let m = Differentiable::new(m);
    let pose = Pose { q: &start.q, z: &m.state_starts, modes: &modes };
    let held = Held::new(&m, &mut Linearizer::new(&m), pose, &start.metric, &preferred(&m)).expect("numbers");
    (m, start.q, modes, held)
}

fn eigenvalues<S>(text: &str, coordinates: Coordinates) -> Vec<f64>
where
    S: Space<S = f64>,
{
    let (.., held) = held::<S>(text, coordinates);
    assert_eq!(held.circulation(), 0.0);
    library(&held.stiffness, &held.mass).expect("masses").values
}

const PENDULUM: &str = "grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81]
bodies: { bob: { bar: { length: 0.7, mass: 2 } } }
joints: { O: { revolute: [ground, bob.start], damping: 0.3 } }
start: { O.angle: -90 deg }
variants:
  up: { start: { O.angle: 90 deg } }
  aside: { start: { O.angle: 0 } }
  free: { gravity: none }
studies:
  down: { modes: {} }
  up: { variant: up, modes: {} }
  aside: { variant: aside, modes: {} }
  free: { variant: free, modes: {} }
  damped: { modes: { damped: true } }
  fallen: { variant: aside, modes: { at: statics } }
  swing: { variant: none, dynamics: { until: 3 s, every: 0.001 s, tolerance: 1e-11 }, columns: [O.angle] }
";

#[test]
fn a_pendulum_swings_falls_and_floats() {
    let text = PENDULUM.replace("variant: none, ", "");
    let right = 1.5 * G / 0.7;
    let down = study(&text, "down", Coordinates::Joint);
    close("down", list(&down, "eigenvalues"), &[right], 1e-14);
    assert!(codes(&down).is_empty(), "{:?}", down.findings);
    let up = study(&text, "up", Coordinates::Joint);
    close("up", list(&up, "eigenvalues"), &[-right], 1e-14);
    assert_eq!(codes(&up), ["unstable"]);
    assert!(up.results[0].is_nan() && up.findings[0].message.contains("grows like exp(4.58491 t/s)"), "{}", up.findings[0].message);
    // at the side the weight is held by a torque that is largest there: no stiffness
    let aside = study(&text, "aside", Coordinates::Joint);
    assert_eq!(codes(&aside), ["unbalanced", "free-motion"]);
    assert!(aside.findings[0].message.contains("`O.angle` -6.867 N m"), "{}", aside.findings[0].message);
    // it falls from there into its rest
    let fallen = study(&text, "fallen", Coordinates::Joint);
    close("fallen", list(&fallen, "eigenvalues"), &[right], 1e-9);
    assert!(!codes(&fallen).contains(&"unbalanced"), "{:?}", fallen.findings);
    let free = study(&text, "free", Coordinates::Joint);
    assert_eq!((codes(&free), free.results[0]), (vec!["free-motion"], 0.0));
}

#[test]
fn a_damped_pendulum_decays_in_time_as_its_eigenvalue_says() {
    let text = PENDULUM.replace("variant: none, ", "");
    let outcome = study(&text, "damped", Coordinates::Joint);
    let inertia = 2.0 * 0.7 * 0.7 / 3.0;
    let (decay, square) = (0.3 / inertia / 2.0, 1.5 * G / 0.7);
    let frequency = (square - decay * decay).sqrt();
    close("Re", list(&outcome, "eigenvalues_real"), &[-decay], 1e-13);
    close("Im", list(&outcome, "eigenvalues_imaginary"), &[frequency], 1e-13);
    close("ζ", list(&outcome, "damping_ratios"), &[decay / square.sqrt()], 1e-13);
    close("frequency", &[outcome.results[0]], &[frequency], 1e-13);
    // let go at 1e-4 rad beside its rest: after each half period the deviation is −exp(−π δ/ω) of what it was
    let text = text.replace("start: { O.angle: -90 deg }", "start: { O.angle: -90 deg + 1e-4 rad }");
    let run = study(&text, "swing", Coordinates::Joint);
    let swing: Vec<f64> = run.rows.iter().map(|r| r[0] + PI / 2.0).collect();
    for half in 1..4 {
        let t = half as f64 * PI / frequency;
        let i = (t / 1e-3) as usize;
        let s = (t - run.places[i]) / 1e-3;
        // a parabola through three rows, next to an extreme
        let (a, b, c) = (swing[i - 1], swing[i], swing[i + 1]);
        let found = b + s * (c - a) / 2.0 + s * s * (c - 2.0 * b + a) / 2.0;
        let right = 1e-4 * (-1.0_f64).powi(half) * (-decay * t).exp();
        assert!((found - right).abs() < 1e-9, "half period {half}: {found:e} and {right:e}");
    }
}

/// A four-bar on a hinge spring of rest `rest`, with a damper, gravity and a spring across.
pub(crate) fn four_bar(spatial: bool, rest: f64) -> String {
    let (space, gravity, zero, axis, size) = if spatial {
        ("spatial", "[0.4, -9.81, 0]", ", 0", ", axis: [0, 0, 1]", ", width: 1e-9, height: 1e-9")
    } else {
        ("planar", "[0.4, -9.81]", "", "", "")
    };
    format!(
        "grashof: 1
name: four-bar
space: {space}
gravity: {gravity}
ground: {{ O: [0, 0{zero}], C: [0.9, 0.1{zero}] }}
bodies:
  crank: {{ bar: {{ length: 0.3, mass: 2{size} }} }}
  coupler: {{ bar: {{ length: 0.8, mass: 3{size} }}, points: {{ p: [0.3, 0.2{zero}] }} }}
  rocker: {{ bar: {{ length: 0.6, mass: 1.5{size} }} }}
joints:
  O: {{ revolute: [ground.O, crank.start]{axis} }}
  A: {{ revolute: [crank.end, coupler.start]{axis} }}
  B: {{ revolute: [coupler.end, rocker.end]{axis} }}
  C: {{ revolute: [ground.C, rocker.start]{axis}, damping: 0.2 }}
springs:
  strut: {{ between: [ground.C, coupler.p], stiffness: 200, length: 0.4, damping: 2 }}
  hinge: {{ joint: O, stiffness: 3, rest: {rest} }}
start: {{ O.angle: 50 deg, A.angle: ~-30 deg, C.angle: ~80 deg }}
"
    )
}

/// The rest of the hinge spring at which the four-bar is in balance in its start.
fn balancing_rest() -> f64 {
    let (.., held) = held::<Planar<f64>>(&four_bar(false, 0.0), Coordinates::Joint);
    -held.unbalanced[0] / 3.0
}

#[test]
fn a_four_bar_in_balance_has_one_frequency_in_all_coordinates() {
    let rest = balancing_rest();
    let right = eigenvalues::<Planar<f64>>(&four_bar(false, rest), Coordinates::Joint);
    let (.., plain) = held::<Planar<f64>>(&four_bar(false, rest), Coordinates::Joint);
    assert!(plain.unbalanced.amax() < 1e-12 * plain.forces.amax() && plain.lambda.amax() > 1.0, "balanced, with forces in its joints");
    close("star tree", &eigenvalues::<Planar<f64>>(&four_bar(false, rest), Coordinates::Cartesian), &right, 1e-10);
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        close("space", &eigenvalues::<Spatial<f64>>(&four_bar(true, rest), coordinates), &right, 1e-9);
        let (.., held) = held::<Spatial<f64>>(&four_bar(true, rest), coordinates);
        let damping = |h: &Held| damped(&state_matrix(h, true).expect("masses"), 1).expect("numbers")[0].value;
        close("μ", &[damping(&held).re, damping(&held).im], &[damping(&plain).re, damping(&plain).im], 1e-9);
    }
}

/// Energy of gravity and springs.
fn potential<S: Space<S = f64>>(m: &Mechanism<S>, q: &[f64], modes: &[i32]) -> f64 {
    let mut d = Dynamics::new(m);
    d.terms(0.0, q, &vec![0.0; m.nv], modes);
    d.gravity_energy() + (0..m.stretches.len()).map(|i| d.spring_energy(i, modes)).sum::<f64>()
}

/// The second derivatives of the energy along independent coordinates, by differences, the loops closed at each place.
fn hessian<S: Space<S = f64>>(m: &Mechanism<S>, q: &[f64], modes: &[i32], held: &Held) -> DMatrix<f64> {
    let n = held.mass.nrows();
    let energy = |x: &DVector<f64>| {
        let mut q = q.to_vec();
        m.retract(&mut q, (&held.partition.p * x).as_slice());
        for _ in 0..40 {
            let mut d = Dynamics::new(m);
            d.time(0.0, modes);
            d.position(&q, modes);
            let phi = DMatrix::from_column_slice(m.rows.len(), 1, &d.work.phi);
            m.retract(&mut q, held.partition.follow(&phi).as_slice());
        }
        potential(m, &q, modes)
    };
    DMatrix::from_fn(n, n, |i, j| {
        let h = 4e-3;
        let along = |e: f64| {
            slope(h, |f| {
                let mut x = DVector::zeros(n);
                x[i] += e;
                x[j] += f;
                vec![energy(&x)]
            })
        };
        slope(h, along)[0]
    })
}

/// Two bodies on balls and a rope, off balance.
const TWO_BALLS: &str = "grashof: 1
name: ball
space: spatial
gravity: [2, -9.81, 3]
ground: { O: [0, 0, 0], P: [0.5, 0.6, 0.1] }
bodies:
  top: { mass: 2, inertia: [0.2, 0.3, 0.15, 0.01, -0.02, 0.03], com: [0.1, 0.05, 0.4], points: { tip: [0.2, 0.1, 0.5] } }
  arm: { mass: 1, inertia: [0.1, 0.05, 0.08], com: [0.3, 0, 0.1], points: { e: [0.6, 0, 0] } }
joints:
  ball: { spherical: [ground.O, top.origin] }
  tip: { spherical: [top.tip, arm.origin] }
springs: { rope: { between: [ground.P, arm.e], stiffness: 40, length: 0.2 } }
";

#[test]
fn stiffness_is_the_second_derivative_of_energy_where_the_pose_is_held() {
    // far from balance: the multipliers of the holding forces make the curvature of the loop
    let (m, q, modes, held1) = held::<Planar<f64>>(&four_bar(false, 4.0), Coordinates::Joint);
    assert!(held1.unbalanced.amax() > 1.0);
    close("one loop", held1.stiffness.as_slice(), hessian(&m, &q, &modes, &held1).as_slice(), 1e-7);
    // turns of a ball do not commute: the second derivative along geodesics is symmetric off balance too
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let (m, q, modes, held) = held::<Spatial<f64>>(TWO_BALLS, coordinates);
        assert!(held.unbalanced.amax() > 1.0, "{}", held.unbalanced);
        assert_eq!(held.circulation(), 0.0, "{coordinates:?}");
        close("two balls", held.stiffness.as_slice(), hessian(&m, &q, &modes, &held).as_slice(), 1e-6);
    }
}

#[test]
fn about_an_equilibrium_that_is_found_the_mechanism_swings_at_its_frequency() {
    let text = four_bar(false, 4.0)
        + "measures: { crank_angle: O.angle }
studies:
  v: { modes: { at: statics } }
  rest: { statics: { from: start }, columns: [O.angle, A.angle, C.angle] }
";
    let outcome = study(&text, "v", Coordinates::Joint);
    assert!(!codes(&outcome).contains(&"unbalanced"), "{:?}", outcome.findings);
    // let go a little beside that rest, it is back after a period
    let rest = &study(&text, "rest", Coordinates::Joint).rows[0];
    let beside = format!("start: {{ O.angle: {} + 1e-4, A.angle: ~{}, C.angle: ~{} }}", rest[0], rest[1], rest[2]);
    let swing = "studies: { swing: { dynamics: { until: 3 s, every: 0.001 s, tolerance: 1e-11 }, columns: [O.angle, O.omega] } }\n";
    let plain = four_bar(false, 4.0).replace("start: { O.angle: 50 deg, A.angle: ~-30 deg, C.angle: ~80 deg }", &beside);
    let run = study(&(plain.replace(", damping: 0.2", "").replace(", damping: 2", "") + swing), "swing", Coordinates::Joint);
    let rates: Vec<f64> = run.rows.iter().map(|r| r[1]).collect();
    let turns: Vec<f64> = (1..rates.len())
        .filter(|&i| rates[i - 1] < 0.0 && rates[i] >= 0.0)
        .map(|i| run.places[i] - 1e-3 * rates[i] / (rates[i] - rates[i - 1]))
        .collect();
    let period = (turns[turns.len() - 1] - turns[0]) / (turns.len() - 1) as f64;
    close("frequency", &[2.0 * PI / period], &[outcome.results[0]], 1e-5);
}

#[test]
fn a_free_body_has_only_free_motions() {
    let text = "grashof: 1\nname: free\nspace: SPACE\ngravity: none\nbodies: { b: { mass: 2, inertia: I } }\nstudies: { v: { modes: { methods: [library, jacobi, power] } } }\n";
    for (space, inertia, n, names) in [
        ("planar", "0.3", 3, vec!["b.x", "b.y", "b.angle"]),
        ("spatial", "[0.3, 0.2, 0.4]", 6, vec!["b.x", "b.y", "b.z", "b.turn_x", "b.turn_y", "b.turn_z"]),
    ] {
        let outcome = study(&text.replace("SPACE", space).replace('I', inertia), "v", Coordinates::Joint);
        assert_eq!(list(&outcome, "eigenvalues"), vec![0.0; n]);
        assert_eq!(list(&outcome, "eigenvalues_power"), vec![0.0; n]);
        assert_eq!(codes(&outcome), vec!["free-motion"; n]);
        assert_eq!(outcome.shapes[0].iter().map(|(n, _)| n.as_str()).collect::<Vec<_>>(), names);
    }
}

#[test]
fn a_motor_with_an_inductance_has_the_eigenvalues_of_its_circuit() {
    let text = "grashof: 1
name: motor
space: planar
gravity: none
bodies: { rotor: { mass: 1, inertia: 0.002 } }
joints: { O: { revolute: [ground, rotor.origin], damping: 0.0005 } }
states: { current: { start: 0 A, rate: (12 V - 2 ohm*current - 0.05 N m/A*O.omega)/(0.4 H) } }
loads: { drive: { joint: O, torque: 0.05 N m/A*current } }
studies: { v: { modes: { damped: true } } }
";
    let outcome = study(text, "v", Coordinates::Joint);
    // s² + (b/J + R/L) s + (b R + k²)/(J L) = 0, and the angle itself
    let (half, product) = ((0.0005 / 0.002 + 2.0 / 0.4) / 2.0, (0.0005 * 2.0 + 0.05 * 0.05) / (0.002 * 0.4));
    let root = f64::sqrt(half * half - product);
    let mut right = vec![0.0, -half + root, -half - root];
    right.sort_by(|a: &f64, b| a.abs().total_cmp(&b.abs()));
    close("μ", list(&outcome, "eigenvalues_real"), &right, 1e-12);
    close("Im μ", list(&outcome, "eigenvalues_imaginary"), &[0.0; 3], 1e-12);
}

#[test]
fn damped_free_motions_are_told_apart() {
    // two masses on a spring between them, and a rotor by itself
    let text = "grashof: 1
name: free
space: planar
gravity: none
bodies: { a: { mass: 1 kg }, b: { mass: 2 kg }, c: { mass: 1 kg, inertia: 0.1 } }
joints:
  A: { slider: [ground, a.origin], axis: [1, 0] }
  B: { slider: [ground, b.origin], axis: [1, 0] }
  C: { revolute: [ground, c.origin], damping: 0.2 }
springs: { s: { stretch: b.x - a.x, stiffness: 50 N/m, damping: 4 N s/m } }
studies: { v: { modes: { damped: true } } }
";
    let outcome = study(text, "v", Coordinates::Joint);
    let free: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "free-motion").map(|f| f.message.as_str()).collect();
    // the masses have a position and a velocity of their own, the rotor comes to rest anywhere
    assert_eq!(free.len(), 3, "{free:?}");
    assert!(free.iter().any(|m| m.contains("of `C.angle`:")), "{free:?}");
    assert!(free.iter().any(|m| m.contains("of `A.position`, `B.position`:")), "{free:?}");
}

#[test]
fn a_state_knows_nothing_of_what_its_rate_does_not_name() {
    // a sensor on one slide drives a motor on another shaft: the two are blocks of a triangle, whose poles are those of each
    let text = "grashof: 1
name: sensor
space: planar
gravity: none
bodies: { a: { mass: 1 kg }, c: { mass: 1 kg, inertia: 0.1 } }
joints:
  A: { slider: [ground, a.origin], axis: [1, 0] }
  C: { revolute: [ground, c.origin], damping: 0.2 }
springs: { s: { joint: A, stiffness: 50 N/m, damping: 4 N s/m }, kc: { joint: C, stiffness: 1.3 } }
states: { y: { start: 0 m, rate: (A.position - y)/0.2 s } }
loads: { f: { joint: C, torque: -3 N*y } }
start: { A.position: 0 m, C.angle: 0 deg }
studies:
  v: { modes: { damped: true } }
  l: { linearize: {} }
";
    let outcome = study(text, "v", Coordinates::Joint);
    close("Re μ", list(&outcome, "eigenvalues_real"), &[-1.0, -5.0, -2.0], 1e-12);
    close("Im μ", list(&outcome, "eigenvalues_imaginary"), &[12f64.sqrt(), 0.0, 46f64.sqrt()], 1e-12);
    let linear = study(text, "l", Coordinates::Joint).linear.expect("matrices");
    let a = &linear.matrices.iter().find(|(name, _)| name == "A").expect("A").1;
    assert_eq!(a.last().map(Vec::as_slice), Some(&[5.0, 0.0, 0.0, 0.0, -5.0][..]));
}

#[test]
fn ziegler_s_column_flutters_where_he_says() {
    // P l/k = 7/2 − √2 (Ziegler, Ing.-Arch. 20 (1952) 49-56; Bolotin, Nonconservative Problems, section 2.1)
    let text = |p: f64| {
        format!(
            "grashof: 1
name: column with a follower load
space: planar
gravity: none
bodies:
  lower: {{ mass: 2, com: [0.5, 0], points: {{ end: [0.5, 0] }} }}
  upper: {{ mass: 1, com: [0.5, 0], points: {{ end: [0.5, 0] }} }}
joints: {{ O: {{ revolute: [ground, lower.origin] }}, A: {{ revolute: [lower.end, upper.origin] }} }}
springs: {{ s: {{ joint: O, stiffness: 30 }}, s2: {{ joint: A, stiffness: 30 }} }}
loads: {{ push: {{ at: upper.end, force: [-{p}, 0], frame: upper }} }}
studies: {{ v: {{ modes: {{ methods: [library, jacobi] }} }} }}
"
        )
    };
    let critical = (3.5 - 2f64.sqrt()) * 30.0 / 0.5;
    let below = study(&text(critical * (1.0 - 1e-6)), "v", Coordinates::Joint);
    assert_eq!(codes(&below), ["circulatory-forces"]);
    close("below", list(&below, "eigenvalues_real"), &[0.0, 0.0], 1e-9);
    let above = study(&text(critical * (1.0 + 1e-6)), "v", Coordinates::Joint);
    assert_eq!(codes(&above), ["circulatory-forces", "unstable"]);
    assert!(list(&above, "eigenvalues_real").iter().any(|x| *x > 1e-4), "{:?}", above.lists);
    assert!(above.lists.iter().all(|l| l.name != "eigenvalues"), "no eigenvalues of symmetric matrices");
    // without a load there is a potential
    assert_eq!(codes(&study(&text(0.0), "v", Coordinates::Joint)), Vec::<&str>::new());
}

#[test]
fn the_crank_rocker_with_its_absorber_has_the_eigenvalues_of_the_assignment() {
    let text = std::fs::read_to_string("models/crank_rocker.yaml").expect("the model");
    for (name, right) in
        [("modes", [-1.266_061_040_96, 1.467_888_952_88, 120.242_130_828]), ("modes-no-gravity", [0.0, 1.470_096_418_18, 120.257_410_345])]
    {
        let outcome = study(&text, name, Coordinates::Joint);
        for list_name in ["eigenvalues", "eigenvalues_jacobi", "eigenvalues_power"] {
            for (found, right) in list(&outcome, list_name).iter().zip(right) {
                assert!((found - right).abs() < 1e-10 * f64::max(1.0, right.abs()) * 10.0, "{name}, {list_name}: {found} and {right}");
            }
        }
    }
}

#[test]
fn what_cannot_vibrate_says_so() {
    let driven = PENDULUM.replace("start: { O.angle: -90 deg }", "start: { O.angle: -90 deg }\ndrivers: { d: { joint: O, speed: 1 rpm } }");
    let outcome = study(&driven.replace("variant: none, ", ""), "down", Coordinates::Joint);
    assert_eq!(codes(&outcome), ["no-freedom"]);
    assert!(outcome.results.iter().all(|x| x.is_nan()) && outcome.scenes.is_empty());
    let text = chains::row(2).replace("b2: { mass: 2 }", "b2: { mass: 0 }");
    for text in [text.clone(), text.replace("[library, jacobi, power]", "[lanczos]")] {
        let model = common::model(&text, Some("v"));
        let study = model.study.clone().expect("the study");
        let parameters = grashof::studies::common::case::parameters(&model);
        let case = grashof::studies::common::case::Case::new(&model, &study, &parameters);
        let failure = grashof::studies::run::run(case, &|| false).expect_err("no mass");
        assert!(failure.reason().contains("the motion of `j2.position` moves no mass"), "{}", failure.reason());
    }
}

#[test]
fn drawings_keep_the_constraints_and_stay_small() {
    let text = four_bar(false, 4.0) + "studies: { v: { modes: {} } }\n";
    let outcome = study(&text, "v", Coordinates::Joint);
    let (name, scene) = &outcome.scenes[0];
    assert_eq!(name, "mode-1");
    let at = |joint: &str, frame: usize| {
        let joint = scene.joints.iter().find(|j| j.name == joint).expect("the joint");
        scene.world(scene.frame(frame), &joint.a)
    };
    assert!(
        scene.frames.closed && scene.frames.shown.len() == 3 && scene.frames.shown[1] == 0 && scene.frames.error < 1e-6,
        "{:?}",
        scene.frames
    );
    let distance = |p: [f64; 3], q: [f64; 3]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let mut moved: f64 = 0.0;
    for frame in 0..scene.frames.count() {
        close("crank", &[distance(at("O", frame), at("A", frame))], &[0.3], 1e-9);
        close("coupler", &[distance(at("A", frame), at("B", frame))], &[0.8], 1e-9);
        close("rocker", &[distance(at("B", frame), at("C", frame))], &[0.6], 1e-9);
        moved = moved.max(distance(at("A", 0), at("A", frame))).max(distance(at("B", 0), at("B", frame)));
    }
    assert!((0.04..0.15).contains(&moved), "{moved}");
}

#[test]
fn the_command_needs_no_study() {
    let directory = std::env::temp_dir().join(format!("grashof-modes-{}", std::process::id()));
    std::fs::create_dir_all(&directory).expect("a directory");
    let file = directory.join("four_bar.yaml");
    std::fs::write(&file, four_bar(false, balancing_rest())).expect("a file");
    let run = |more: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_grashof"))
            .args(["modes", &file.to_string_lossy(), "-o", &directory.to_string_lossy()])
            .args(more)
            .output()
            .expect("the binary runs");
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, out, error) = run(&[]);
    assert_eq!(code, Some(0), "{error}");
    assert!(out.contains("O.angle 1") && out.contains("jacobi") && out.contains("power"), "{out}");
    for name in ["modes.csv", "modes.json", "modes-mode-1.svg", "modes-mode-1.png"] {
        assert!(directory.join(name).exists(), "{name}");
    }
    let (code, out, _) = run(&["--damped", "--json", "--no-plots"]);
    assert_eq!(code, Some(0));
    let json: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert!(json["scalars"]["damping_ratios"][0].as_f64().is_some_and(|x| x > 0.0), "{json}");
    assert!(json["scalars"]["shapes"][0]["O.angle"].as_f64() == Some(1.0), "{json}");
    std::fs::remove_dir_all(&directory).expect("removed");
}
