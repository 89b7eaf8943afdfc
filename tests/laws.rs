//! Laws of mechanics on two mechanisms that hold every kind of joint, on the tree (both ways round) and cut, and every kind
//! of force; in any state, whether the constraints hold in it or not. Fixed seeds.

#![allow(clippy::needless_range_loop, reason = "bodies are numbered alike in several arrays")]

use crate::common::{Noise, State, accelerate, close, mechanism, react, slope, spin, star_state, twist, vector, wrench};
use forces::{along_efforts, along_rows};
use grashof::dynamics::{self, Dynamics};
use grashof::geometry::{Force, Motion, Planar, Space, Spatial};
use grashof::mechanism::{Coordinates, EffortLaw, Mechanism, Rotor, StretchOf};
use grashof::scalar::Dual;
use grashof_solvers::{Block, Coloring, Tangent};

const PLANAR: &str = include_str!("common/planar.yaml");
const SPATIAL: &str = include_str!("common/spatial.yaml");
/// Step of the differences: 4e-21 of the seventh derivative lost, 1e-13 of round-off.
const H: f64 = 4e-4;
/// Of the largest number in a comparison that differences take part in.
const DIFFERENCE: f64 = 1e-10;
const EXACT: f64 = 1e-12;

/// The planar and the spatial mechanism on their trees, on trees of short roads and on the star tree, three states each.
macro_rules! everywhere {
    ($law:ident) => {
        for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
            let (planar, spatial) = (mechanism::<Planar<f64>>(PLANAR, coordinates), mechanism::<Spatial<f64>>(SPATIAL, coordinates));
            for seed in 1..4 {
                $law(&planar, &State::random(&planar, seed));
                $law(&spatial, &State::random(&spatial, seed));
            }
        }
    };
}

mod forces;

#[test]
fn every_kind_of_joint_is_there_on_the_tree_both_ways_round_and_cut() {
    fn check<G: Space<S = f64>>(m: &Mechanism<G>, kinds: &[&str]) {
        for kind in kinds {
            let of = |f: &dyn Fn(&grashof::mechanism::Joint<G>) -> bool| m.joints.iter().any(|j| j.kind == *kind && f(j));
            assert!(of(&|j| j.tree.is_some_and(|t| !t.1)), "{kind} on the tree");
            assert!(of(&|j| j.tree.is_some_and(|t| t.1)), "{kind} reversed on the tree");
            assert!(of(&|j| j.tree.is_none()), "{kind} cut");
        }
        for j in &m.joints {
            assert_eq!(j.tree.is_some(), !(j.name.starts_with("cut") || j.name == "rod"), "{}", j.name);
        }
        assert!(m.joint_of_node.iter().any(Option::is_none), "a free body");
        assert!(m.rotors.len() == 2 && m.functions.len() >= 3 && m.drives.len() == 3);
    }
    check(&mechanism::<Planar<f64>>(PLANAR, Coordinates::Joint), &["revolute", "slider", "pin-in-slot", "fixed"]);
    let all = ["revolute", "slider", "cylindrical", "planar", "screw", "universal", "spherical", "fixed"];
    check(&mechanism::<Spatial<f64>>(SPATIAL, Coordinates::Joint), &all);
}

#[test]
fn kinetic_energy_is_half_v_m_v_and_m_is_symmetric() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let n = m.nv;
        let mut half = 0.0;
        for i in 0..n {
            for k in 0..n {
                half += 0.5 * s.v[i] * d.work.mass.at(i, k) * s.v[k];
                assert_eq!(d.work.mass.at(i, k).to_bits(), d.work.mass.at(k, i).to_bits());
            }
        }
        close("T", &[d.kinetic_energy()], &[half], EXACT);
        let metric = nalgebra::DMatrix::from_row_slice(n, n, &d.work.mass.to_dense());
        assert!(metric.cholesky().is_some(), "M is positive definite");
    }
    everywhere!(law);
}

#[test]
fn momentum_projected_on_the_columns_is_m_v() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let bodies = (0..m.bodies.len()).map(|b| d.work.inertias[b] * d.work.twists[b]).collect::<Vec<_>>();
        let rotors = m.rotors.iter().map(|r| r.inertia * d.work.readings[r.gauge].rate).collect::<Vec<_>>();
        close("M v", &product(&d.work.mass, &s.v), &project(&d, &bodies, &rotors), EXACT);
        let sum = bodies.iter().enumerate().skip(1).fold(Force::default(), |sum, (b, p)| sum + p.about_origin(d.reference(b)));
        close("momentum", &wrench(d.momentum()), &wrench(sum), EXACT);
    }
    everywhere!(law);
}

#[test]
fn columns_of_m_are_what_unit_accelerations_cost() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let n = m.nv;
        let zero = vec![0.0; n];
        let rest = newton_euler(&d, &zero);
        for k in 0..n {
            let mut e = zero.clone();
            e[k] = 1.0;
            let cost: Vec<f64> = newton_euler(&d, &e).iter().zip(&rest).map(|(x, y)| x - y).collect();
            let column: Vec<f64> = (0..n).map(|i| d.work.mass.at(i, k)).collect();
            close("column of M", &column, &cost, EXACT);
        }
    }
    everywhere!(law);
}

#[test]
fn the_residual_is_newton_and_euler_for_each_body() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let mut r = vec![0.0; m.nv];
        d.residual(&s.a, &s.lambda, &mut r);
        // the same by wrenches: inertial forces less loads, efforts and constraint forces
        let mut balance = newton_euler(&d, &s.a);
        let applied = project(&d, &d.work.applied, &[]);
        let (efforts, rows) = (along_efforts(&d), along_rows(&d, &s.lambda));
        for (k, balance) in balance.iter_mut().enumerate() {
            *balance -= applied[k] + efforts[k] + rows[k];
        }
        close("M a + Gᵀλ − f", &r, &balance, EXACT);
    }
    everywhere!(law);
}

#[test]
fn what_is_unbalanced_is_f_less_m_a() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let right: Vec<f64> = d.work.force.iter().zip(product(&d.work.mass, &s.a)).map(|(f, x)| f - x).collect();
        let (mut accelerations, mut out) = (vec![Motion::default(); m.bodies.len()], vec![0.0; m.nv]);
        d.accelerate(&s.a, &mut accelerations);
        d.unbalanced(&s.a, &accelerations, &mut out);
        close("f − M a", &out, &right, EXACT);
    }
    everywhere!(law);
}

#[test]
fn a_nudge_is_a_small_move() {
    // bodies, gauges and rows follow to the square of the displacement
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let delta: Vec<f64> = s.v.iter().map(|v| 1e-8 * v).collect();
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let mut q = s.q.clone();
        m.retract(&mut q, &delta);
        d.nudge(&q, &delta, &s.modes);
        let mut e = Dynamics::new(m);
        e.time(s.t, &s.modes);
        e.position(&q, &s.modes);
        close("Φ", &d.work.phi, &e.work.phi, 1e-13);
        close("G", d.work.g.values(), e.work.g.values(), 1e-13);
    }
    everywhere!(law);
}

#[test]
fn velocities_and_accelerations_of_points_are_rates() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        let points = |s: &State, order: usize| -> Vec<f64> {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            let mut out = Vec::new();
            for (b, body) in m.bodies.iter().enumerate() {
                for at in body.points.iter().map(|p| p.1).chain([G::vector(&[0.3, 0.7, -0.5])]) {
                    out.extend(vector::<G>(if order == 0 { d.point(b, at) } else { d.work.twists[b].at(d.place(m.group_of[b], b, at)) }));
                }
                if order == 1 {
                    out.extend(spin::<G>(d.work.twists[b].w));
                } else {
                    out.extend((0..G::SPIN).map(|_| 0.0));
                }
            }
            out
        };
        s.evaluate(&mut d);
        let mut accelerations = vec![Motion::default(); m.bodies.len()];
        d.accelerate(&s.a, &mut accelerations);
        let (mut rates, mut seconds) = (Vec::new(), Vec::new());
        for (b, body) in m.bodies.iter().enumerate() {
            let (v, a) = (d.work.twists[b], accelerations[b]);
            for at in body.points.iter().map(|p| p.1).chain([G::vector(&[0.3, 0.7, -0.5])]) {
                let p = d.place(m.group_of[b], b, at);
                rates.extend(vector::<G>(v.at(p)));
                seconds.extend(vector::<G>(a.at(p) + G::turn(v.w, v.at(p))));
            }
            rates.extend((0..G::SPIN).map(|_| 0.0));
            seconds.extend(spin::<G>(a.w));
        }
        close("ṗ", &slope(H, |e| points(&s.after(m, e), 0)), &rates, DIFFERENCE);
        close("p̈", &slope(H, |e| points(&s.after(m, e), 1)), &seconds, DIFFERENCE);
        // angles of bodies are not wrapped, and turn with ω
        if G::SPIN == 1 {
            let angles = |s: &State| {
                let mut d = Dynamics::new(m);
                s.evaluate(&mut d);
                d.poses().iter().map(|x| G::angle(x.r)).collect::<Vec<_>>()
            };
            let omega: Vec<f64> = d.work.twists.iter().map(|v| G::spin_component(v.w, 2)).collect();
            close("ω", &slope(H, |e| angles(&s.after(m, e))), &omega, DIFFERENCE);
        }
    }
    everywhere!(law);
}

#[test]
fn coordinates_change_at_the_rate_n_v() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut rate = vec![0.0; m.nq];
        m.rate(&s.q, &s.v, &mut rate);
        close("q̇", &slope(H, |e| s.after(m, e).q), &rate, DIFFERENCE);
    }
    everywhere!(law);
}

#[test]
fn readings_of_gauges_have_their_rates_and_accelerations() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let read = |s: &State, order: usize| -> Vec<f64> {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            d.work.readings.iter().map(|r| if order == 0 { r.x } else { r.rate }).collect()
        };
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let accelerations: Vec<f64> =
            m.gauges.iter().zip(&d.work.readings).map(|(g, r)| g.acceleration(r, &d.work.columns, &s.a)).collect();
        close("ẋ", &slope(H, |e| read(&s.after(m, e), 0)), &read(s, 1), DIFFERENCE);
        close("ẍ", &slope(H, |e| read(&s.after(m, e), 1)), &accelerations, 1e-9);
        // the wrench of a gauge does the work of its rate
        let power: Vec<f64> =
            m.gauges.iter().zip(&d.work.readings).map(|(g, r)| r.wrench.power(d.work.twists[g.b] - d.work.twists[g.a])).collect();
        close("W·V", &power, &read(s, 1), EXACT);
    }
    everywhere!(law);
}

#[test]
fn g_v_less_nu_is_the_rate_of_phi() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let phi = |s: &State| {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            d.work.phi
        };
        let rate: Vec<f64> = product(&d.work.g, &s.v).iter().zip(&d.work.nu).map(|(x, y)| x - y).collect();
        close("G v − ν", &rate, &slope(H, |e| phi(&s.after(m, e))), DIFFERENCE);
    }
    everywhere!(law);
}

#[test]
fn g_a_less_gamma_is_the_rate_of_g_v_less_nu() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let rate = |s: &State| {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            product(&d.work.g, &s.v).iter().zip(&d.work.nu).map(|(x, y)| x - y).collect::<Vec<f64>>()
        };
        let second: Vec<f64> = product(&d.work.g, &s.a).iter().zip(&d.work.gamma).map(|(x, y)| x - y).collect();
        close("G a − γ", &second, &slope(H, |e| rate(&s.after(m, e))), 1e-9);
    }
    everywhere!(law);
}

#[test]
fn evaluations_in_any_order_give_the_same_bits() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let all = |d: &mut Dynamics<'_, G>, s: &State| {
            s.evaluate(d);
            let r = react(d, &s.a, &s.lambda);
            let w = &d.work;
            let mut bits: Vec<u64> = [w.mass.values(), &w.force, &w.phi, w.g.values(), &w.nu, &w.gamma, &w.efforts, &r.drives]
                .into_iter()
                .flatten()
                .map(|x| x.to_bits())
                .collect();
            bits.extend(r.joints.iter().flat_map(|f| wrench(*f)).map(f64::to_bits));
            bits.extend(r.accelerations.iter().flat_map(|a| twist(*a)).map(f64::to_bits));
            bits
        };
        let fresh = all(&mut Dynamics::new(m), s);
        let mut used = Dynamics::new(m);
        for seed in 20..23 {
            let other = State { t: 1.7, ..State::random(m, seed) };
            all(&mut used, &other);
            for spring in 0..m.stretches.len() {
                let _ = used.spring_energy(spring, &s.modes);
            }
        }
        assert!(all(&mut used, s) == fresh, "an evaluator remembers");
    }
    everywhere!(law);
}

#[test]
fn the_energy_of_a_spring_may_be_asked_between_two_readings() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let before = d.work.clone();
        for spring in 0..m.stretches.len() {
            let _ = d.spring_energy(spring, &s.modes);
        }
        assert_eq!((d.work.force_outputs, d.work.efforts, d.work.force), (before.force_outputs, before.efforts, before.force));
    }
    everywhere!(law);
}

#[test]
fn poses_do_not_depend_on_the_length_of_a_quaternion() {
    let m = mechanism::<Spatial<f64>>(SPATIAL, Coordinates::Cartesian);
    let s = State::random(&m, 9);
    let mut long = s.clone();
    for step in &m.steps {
        if let grashof::mechanism::Step::Ball { q, .. } = step {
            long.q[*q..q + 4].iter_mut().for_each(|x| *x *= 2.0);
        }
    }
    let (mut d, mut e) = (Dynamics::new(&m), Dynamics::new(&m));
    s.evaluate(&mut d);
    long.evaluate(&mut e);
    assert_eq!((d.work.phi, d.work.g, d.work.force, d.work.mass), (e.work.phi, e.work.g, e.work.force, e.work.mass));
}

#[test]
fn lifted_numbers_are_the_same_numbers() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let lifted = m.lift::<Dual<1>>();
        let mut d = Dynamics::new(&lifted);
        let c = |x: &[f64]| x.iter().map(|x| <Dual<1> as grashof::scalar::Scalar>::constant(*x)).collect::<Vec<_>>();
        d.terms(grashof::scalar::Scalar::constant(s.t), &c(&s.q), &c(&s.v), &s.modes);
        let mut e = Dynamics::new(m);
        s.evaluate(&mut e);
        let values = |x: &[Dual<1>]| x.iter().map(|x| x.x).collect::<Vec<_>>();
        close("f", &values(&d.work.force), &e.work.force, 1e-14);
        close("M", &values(d.work.mass.values()), e.work.mass.values(), 1e-14);
        close("γ", &values(&d.work.gamma), &e.work.gamma, 1e-14);
    }
    everywhere!(law);
}

#[test]
fn an_open_mechanism_falls_alike_on_every_tree() {
    // without the cut joints, couplings and drivers both trees have the same motions: same accelerations, same reactions
    fn law<G: Space<S = f64>>(text: &str) {
        let open: String = text
            .lines()
            .filter(|l| !l.starts_with("  cut_") && !l.starts_with("  rod:") && !l.starts_with("  rotor:"))
            .filter(|l| {
                !["  mesh", "  rack", "  any", "  law", "  spun", "  raised", "  press", "  twist_cut", "couplings", "drivers"]
                    .iter()
                    .any(|k| l.starts_with(k))
            })
            .map(|l| format!("{l}\n"))
            .collect();
        let (tree, star) = (mechanism::<G>(&open, Coordinates::Joint), mechanism::<G>(&open, Coordinates::Cartesian));
        assert!(tree.rows.is_empty() && star.nv > tree.nv);
        for seed in 1..4 {
            let s = State::random(&tree, seed);
            let mut d = Dynamics::new(&tree);
            s.evaluate(&mut d);
            let (a, lambda) = accelerate(&d);
            let r = react(&mut d, &a, &lambda);
            let (q, v) = star_state(&star, &d);
            let mut e = Dynamics::new(&star);
            let at = State { q, v, modes: star.modes(), ..s.clone() };
            at.evaluate(&mut e);
            close("Φ", &e.work.phi, &vec![0.0; e.work.phi.len()], 1e-13);
            let rate: Vec<f64> = product(&e.work.g, &at.v);
            close("G v", &rate, &vec![0.0; rate.len()], 1e-12);
            let (a, lambda) = accelerate(&e);
            let o = react(&mut e, &a, &lambda);
            for b in 1..tree.bodies.len() {
                let at_origin = |a: Motion<G>, reference: G::Vector| twist(Motion::<G> { w: a.w, v: a.at(-reference) });
                let (x, y) = (at_origin(r.accelerations[b], d.reference(b)), at_origin(o.accelerations[b], e.reference(b)));
                close(&format!("acceleration of {}", tree.bodies[b].name), &x, &y, 1e-9);
            }
            for (j, joint) in tree.joints.iter().enumerate() {
                let body = joint.a.0.max(joint.b.0);
                let (x, y) = (r.joints[j].about_origin(d.reference(body)), o.joints[j].about_origin(e.reference(body)));
                close(&format!("reaction of {}", joint.name), &wrench(x), &wrench(y), 1e-9);
                for (x, y) in joint.slots.iter().zip(&star.joints[j].slots) {
                    let (x, y) = (d.work.readings[*x], e.work.readings[*y]);
                    close(&format!("coordinate of {}", joint.name), &[x.x, x.rate], &[y.x, y.rate], 1e-11);
                }
            }
            close("frame", &wrench(r.frame), &wrench(o.frame), 1e-9);
        }
    }
    law::<Planar<f64>>(PLANAR);
    law::<Spatial<f64>>(SPATIAL);
}

/// The state with the accelerations that its forces and its λ give it.
fn moving<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) -> State {
    let mut d = Dynamics::new(m);
    s.evaluate(&mut d);
    let n = m.nv;
    let mass = nalgebra::DMatrix::from_row_slice(n, n, &d.work.mass.to_dense());
    let mut rhs = nalgebra::DVector::from_column_slice(&d.work.force);
    for (r, l) in s.lambda.iter().enumerate() {
        for k in 0..n {
            rhs[k] -= d.work.g.at(r, k) * l;
        }
    }
    let a = mass.cholesky().expect("M is positive definite").solve(&rhs);
    State { a: a.as_slice().to_vec(), ..s.clone() }
}

/// A x.
fn product(a: &Block, x: &[f64]) -> Vec<f64> {
    a.lines().map(|row| row.dot(x)).collect()
}

/// What wrenches on bodies and sizes along rotors' gauges do along each column.
fn project<G: Space<S = f64>>(d: &Dynamics<'_, G>, on: &[Force<G>], along: &[f64]) -> Vec<f64> {
    let m = d.mechanism;
    let mut out = vec![0.0; m.nv];
    for (body, f) in on.iter().enumerate() {
        for k in m.path(body) {
            out[k] += f.power(d.work.columns[k]);
        }
    }
    for (rotor, size) in m.rotors.iter().zip(along) {
        pair_along(d, rotor.gauge, *size, &mut out);
    }
    out
}

/// A pair of wrenches of a gauge along each column, by the twists of both bodies.
fn pair_along<G: Space<S = f64>>(d: &Dynamics<'_, G>, gauge: usize, size: f64, out: &mut [f64]) {
    let (g, wrench) = (&d.mechanism.gauges[gauge], d.work.readings[gauge].wrench * size);
    for k in d.mechanism.path(g.b) {
        out[k] += wrench.power(d.work.columns[k]);
    }
    for k in d.mechanism.path(g.a) {
        out[k] -= wrench.power(d.work.columns[k]);
    }
}

/// Inertial forces of bodies and rotors along each column.
fn newton_euler<G: Space<S = f64>>(d: &Dynamics<'_, G>, a: &[f64]) -> Vec<f64> {
    let m = d.mechanism;
    let mut accelerations = vec![Motion::default(); m.bodies.len()];
    d.accelerate(a, &mut accelerations);
    let inertial: Vec<Force<G>> =
        (0..m.bodies.len()).map(|b| if b == 0 { Force::default() } else { d.inertial(b, accelerations[b]) }).collect();
    let rotors: Vec<f64> =
        m.rotors.iter().map(|r| r.inertia * m.gauges[r.gauge].acceleration(&d.work.readings[r.gauge], &d.work.columns, a)).collect();
    project(d, &inertial, &rotors)
}

#[test]
fn noise_is_what_it_was() {
    // the states of all tests hang on it
    assert_eq!(Noise(1).vector(2), Noise(1).vector(2));
    assert_ne!(Noise(1).vector(2), Noise(2).vector(2));
}
