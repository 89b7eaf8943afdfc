//! Laws of mechanics on two mechanisms that hold every kind of joint, on the tree (both ways round) and cut, and every kind
//! of force; in any state, whether the constraints hold in it or not. Fixed seeds.

#![allow(clippy::needless_range_loop, reason = "bodies are numbered alike in several arrays")]

mod common;

use common::{Noise, State, accelerate, close, mechanism, react, slope, spin, star_state, twist, vector, wrench};
use grashof::dynamics::{self, Dynamics};
use grashof::geometry::{Force, Motion, Planar, Space, Spatial};
use grashof::mechanism::{Coordinates, EffortLaw, Mechanism, Rotor, StretchOf};
use grashof::scalar::Dual;
use grashof_solvers::{Coloring, Dims, Tangent};

const PLANAR: &str = include_str!("common/planar.yaml");
const SPATIAL: &str = include_str!("common/spatial.yaml");
/// Step of the differences: 4e-21 of the seventh derivative lost, 1e-13 of round-off.
const H: f64 = 4e-4;
/// Of the largest number in a comparison that differences take part in.
const DIFFERENCE: f64 = 1e-10;
const EXACT: f64 = 1e-12;

/// The planar and the spatial mechanism on their trees and on the star tree, three states each.
macro_rules! everywhere {
    ($law:ident) => {
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let (planar, spatial) = (mechanism::<Planar<f64>>(PLANAR, coordinates), mechanism::<Spatial<f64>>(SPATIAL, coordinates));
            for seed in 1..4 {
                $law(&planar, &State::random(&planar, seed));
                $law(&spatial, &State::random(&spatial, seed));
            }
        }
    };
}

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
                half += 0.5 * s.v[i] * d.work.mass[i * n + k] * s.v[k];
                assert_eq!(d.work.mass[i * n + k].to_bits(), d.work.mass[k * n + i].to_bits());
            }
        }
        close("T", &[d.kinetic_energy()], &[half], EXACT);
        let metric = nalgebra::DMatrix::from_row_slice(n, n, &d.work.mass);
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
        let sum = bodies.iter().skip(1).fold(Force::default(), |sum, p| sum + *p);
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
            let column: Vec<f64> = (0..n).map(|i| d.work.mass[i * n + k]).collect();
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
        close("G", &d.work.g, &e.work.g, 1e-13);
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
                    let p = d.point(b, at);
                    out.extend(vector::<G>(if order == 0 { p } else { d.work.twists[b].at(p) }));
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
                let p = d.point(b, at);
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
                d.work.poses.iter().map(|x| G::angle(x.r)).collect::<Vec<_>>()
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
fn power_in_is_the_rate_of_kinetic_energy() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let s = moving(m, s);
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let w = &d.work;
        let mut power: f64 = (1..m.bodies.len()).map(|b| w.applied[b].power(w.twists[b])).sum();
        power += m.efforts.iter().zip(&w.efforts).map(|(e, size)| size * d.extent_rate(e.along)).sum::<f64>();
        power -= product(&w.g, &s.v).iter().zip(&s.lambda).map(|(x, l)| x * l).sum::<f64>();
        let energy = |s: &State| {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            vec![d.kinetic_energy()]
        };
        close("Ṫ", &slope(H, |e| energy(&s.after(m, e))), &[power], 1e-9);
    }
    everywhere!(law);
}

#[test]
fn rate_of_m_less_twice_coriolis_is_skew() {
    // vᵀ(½Ṁ v − C v) = 0 for the forces C v of velocity alone: what M v̇ = f has beyond what rests
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let coriolis = newton_euler(&d, &vec![0.0; m.nv]);
        let work: f64 = coriolis.iter().zip(&s.v).map(|(c, v)| c * v).sum();
        let half = slope(H, |e| {
            let mut next = s.clone();
            m.retract(&mut next.q, &s.v.iter().map(|v| e * v).collect::<Vec<_>>());
            let mut d = Dynamics::new(m);
            next.evaluate(&mut d);
            vec![0.5 * product(&d.work.mass, &s.v).iter().zip(&s.v).map(|(x, v)| x * v).sum::<f64>()]
        });
        close("½ vᵀṀv", &half, &[work], DIFFERENCE);
    }
    everywhere!(law);
}

#[test]
fn gravity_and_springs_take_from_their_energies() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let potential = |s: &State| -> Vec<f64> {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            let mut modes = s.modes.clone();
            let mut all = vec![d.gravity_energy()];
            all.extend((0..m.stretches.len()).map(|i| d.spring_energy(i, &mut modes)));
            all
        };
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let w = &d.work;
        let mut power = vec![0.0];
        for b in 1..m.bodies.len() {
            power[0] -= G::dot(m.gravity, w.twists[b].v * w.inertias[b].m + G::turn(w.twists[b].w, w.inertias[b].h));
        }
        for &effort in &m.spring_efforts {
            let damping = match m.efforts[effort].law {
                EffortLaw::Linear { damping, .. } | EffortLaw::Law { damping, .. } => damping,
                EffortLaw::Drive { .. } | EffortLaw::Friction { .. } => 0.0,
            };
            let rate = d.extent_rate(m.efforts[effort].along);
            power.push(-(w.efforts[effort] + damping * rate) * rate);
        }
        close("V̇", &slope(H, |e| potential(&s.after(m, e))), &power, DIFFERENCE);
    }
    everywhere!(law);
}

#[test]
fn tangents_are_derivatives_of_the_residual() {
    fn law<G, D>(m: &Mechanism<G>, s: &State)
    where
        G: Space<S = f64, Lift<Dual<{ dynamics::LANES }>> = D>,
        D: Space<S = Dual<{ dynamics::LANES }>>,
    {
        let lifted = m.lift::<Dual<{ dynamics::LANES }>>();
        let dims = Dims { q: m.nq, v: m.nv, holonomic: m.rows.len(), ..Dims::default() };
        let mut out = Tangent::new(dims);
        let at = dynamics::Point { t: s.t, q: &s.q, v: &s.v, z: &[], a: &s.a, lambda: &s.lambda, modes: &s.modes };
        dynamics::Linearizer::<D>::new(&lifted).tangents(&at, &mut out);
        let residual = |s: &State| {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            let mut r = vec![0.0; m.nv];
            d.residual(&s.a, &s.lambda, &mut r);
            r
        };
        let n = m.nv;
        for k in 0..n {
            let by_position = slope(H, |e| {
                let (mut next, mut delta) = (s.clone(), vec![0.0; n]);
                delta[k] = e;
                m.retract(&mut next.q, &delta);
                residual(&next)
            });
            let by_velocity = slope(H, |e| {
                let mut next = s.clone();
                next.v[k] += e;
                residual(&next)
            });
            let column = |x: &[f64]| (0..n).map(|i| x[i * n + k]).collect::<Vec<_>>();
            close("K", &column(&out.k), &by_position, 1e-9);
            close("C", &column(&out.c), &by_velocity, 1e-9);
        }
    }
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let (planar, spatial) = (mechanism::<Planar<f64>>(PLANAR, coordinates), mechanism::<Spatial<f64>>(SPATIAL, coordinates));
        law(&planar, &State::random(&planar, 5));
        law(&spatial, &State::random(&spatial, 6));
    }
}

#[test]
fn a_chain_in_cartesian_coordinates_needs_few_colours() {
    let links: String = (0..30).map(|i| format!("  l{i}: {{ bar: {{ length: 1, mass: 1 }} }}\n")).collect();
    let joints: String = (1..30).map(|i| format!("  j{i}: {{ revolute: [l{}.end, l{i}.start] }}\n", i - 1)).collect();
    let text = format!(
        "grashof: 1\nname: chain\nspace: planar\ngravity: [0, -9.81]\nbodies:\n{links}joints:\n  j0: {{ revolute: [ground, l0.start] }}\n{joints}"
    );
    let m = mechanism::<Planar<f64>>(&text, Coordinates::Cartesian);
    let coloring = Coloring::new(&dynamics::pattern(&m));
    assert_eq!(m.nv, 90);
    assert!(coloring.count <= 15, "{} colours", coloring.count);
}

#[test]
fn wrenches_on_every_body_balance() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let s = moving(m, s);
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let r = react(&mut d, &s.a, &s.lambda);
        let w = &d.work;
        let mut on = vec![Force::<G>::default(); m.bodies.len()];
        for (joint, f) in m.joints.iter().zip(&r.joints) {
            on[joint.b.0] += *f;
            on[joint.a.0] -= *f;
        }
        let mut pair = |gauge: usize, size: f64| {
            let g = &m.gauges[gauge];
            on[g.b] += w.readings[gauge].wrench * size;
            on[g.a] -= w.readings[gauge].wrench * size;
        };
        for (drive, size) in m.drives.iter().zip(&r.drives) {
            pair(drive.gauge, *size);
        }
        for (effort, size) in m.efforts.iter().zip(&w.efforts) {
            spread(&d, effort.along, *size, &mut pair);
        }
        for Rotor { gauge, inertia } in &m.rotors {
            pair(*gauge, -inertia * m.gauges[*gauge].acceleration(&w.readings[*gauge], &w.columns, &s.a));
        }
        couplings(&d, &s.lambda, &mut pair);
        let mut total = Force::<G>::default();
        for b in 1..m.bodies.len() {
            let momentum = w.inertias[b] * w.twists[b];
            let inertial = w.inertias[b] * r.accelerations[b] + w.twists[b].cross_force(momentum);
            total += inertial;
            close(&format!("forces on {}", m.bodies[b].name), &wrench(on[b] + w.applied[b]), &wrench(inertial), 1e-10);
        }
        close("shaking", &wrench(r.shaking), &wrench(total), EXACT);
        close("forces on the frame", &wrench(r.frame), &wrench(on[0]), 1e-10);
        // the whole: weight and loads less the rate of momentum are what the frame carries
        let applied = (1..m.bodies.len()).fold(Force::default(), |sum, b| sum + w.applied[b]);
        close("frame = loads − shaking", &wrench(r.frame), &wrench(applied - total), 1e-10);
    }
    everywhere!(law);
}

#[test]
fn shaking_is_the_rate_of_momentum() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let r = react(&mut d, &s.a, &s.lambda);
        let momentum = |s: &State| {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            wrench(d.momentum())
        };
        close("shaking", &slope(H, |e| momentum(&s.after(m, e))), &wrench(r.shaking), 1e-9);
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
            let mut bits: Vec<u64> = [&w.mass, &w.force, &w.phi, &w.g, &w.nu, &w.gamma, &w.efforts, &r.drives]
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
            let mut modes = other.modes.clone();
            for spring in 0..m.stretches.len() {
                let _ = used.spring_energy(spring, &mut modes);
            }
            assert_eq!(modes, other.modes);
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
        let mut modes = s.modes.clone();
        for spring in 0..m.stretches.len() {
            let _ = d.spring_energy(spring, &mut modes);
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
        close("M", &values(&d.work.mass), &e.work.mass, 1e-14);
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
                close(&format!("acceleration of {}", tree.bodies[b].name), &twist(r.accelerations[b]), &twist(o.accelerations[b]), 1e-9);
            }
            for (j, joint) in tree.joints.iter().enumerate() {
                close(&format!("reaction of {}", joint.name), &wrench(r.joints[j]), &wrench(o.joints[j]), 1e-9);
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
    let mass = nalgebra::DMatrix::from_row_slice(n, n, &d.work.mass);
    let mut rhs = nalgebra::DVector::from_column_slice(&d.work.force);
    for (r, l) in s.lambda.iter().enumerate() {
        for k in 0..n {
            rhs[k] -= d.work.g[r * n + k] * l;
        }
    }
    let a = mass.cholesky().expect("M is positive definite").solve(&rhs);
    State { a: a.as_slice().to_vec(), ..s.clone() }
}

/// A x for A of rows as long as x.
fn product(a: &[f64], x: &[f64]) -> Vec<f64> {
    a.chunks_exact(x.len()).map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
}

/// What wrenches on bodies and sizes along rotors' gauges do along each column.
fn project<G: Space<S = f64>>(d: &Dynamics<'_, G>, on: &[Force<G>], along: &[f64]) -> Vec<f64> {
    let m = d.mechanism;
    let mut out = vec![0.0; m.nv];
    for (body, f) in m.bodies.iter().zip(on) {
        for &k in &body.path {
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
    for &k in &d.mechanism.bodies[g.b].path {
        out[k] += wrench.power(d.work.columns[k]);
    }
    for &k in &d.mechanism.bodies[g.a].path {
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

/// A size along a gauge or a function as sizes along gauges.
fn spread<G: Space<S = f64>>(d: &Dynamics<'_, G>, along: StretchOf, size: f64, pair: &mut impl FnMut(usize, f64)) {
    match along {
        StretchOf::Gauge(g) => pair(g, size),
        StretchOf::Function(f) => {
            let function = &d.mechanism.functions[f];
            for (i, g) in function.gauges.iter().enumerate() {
                pair(*g, size * d.work.functions[function.value + 1 + i]);
            }
        }
    }
}

/// Efforts along each column.
fn along_efforts<G: Space<S = f64>>(d: &Dynamics<'_, G>) -> Vec<f64> {
    let mut out = vec![0.0; d.mechanism.nv];
    for (effort, size) in d.mechanism.efforts.iter().zip(&d.work.efforts) {
        spread(d, effort.along, *size, &mut |g, x| pair_along(d, g, x, &mut out));
    }
    out
}

/// −λ of the couplings as pairs along gauges.
fn couplings<G: Space<S = f64>>(d: &Dynamics<'_, G>, lambda: &[f64], pair: &mut impl FnMut(usize, f64)) {
    use grashof::mechanism::{RowKind, RowOwner};
    for (row, l) in d.mechanism.rows.iter().zip(lambda) {
        if row.owner == RowOwner::Coupling {
            match row.kind {
                RowKind::Ratio { first, second, ratio } => {
                    pair(second, -l);
                    pair(first, ratio * l);
                }
                RowKind::Function(f) => spread(d, StretchOf::Function(f), -l, pair),
                RowKind::Gauge(_) | RowKind::Driver { .. } => unreachable!("not of a coupling"),
            }
        }
    }
}

/// Constraint forces −Gᵀλ along each column, by wrenches.
fn along_rows<G: Space<S = f64>>(d: &Dynamics<'_, G>, lambda: &[f64]) -> Vec<f64> {
    use grashof::mechanism::{RowKind, RowOwner};
    let mut out = vec![0.0; d.mechanism.nv];
    let mut pair = |g: usize, x: f64| pair_along(d, g, x, &mut out);
    for (row, l) in d.mechanism.rows.iter().zip(lambda) {
        match row.kind {
            RowKind::Gauge(g) | RowKind::Driver { gauge: g, .. } => pair(g, -l),
            RowKind::Ratio { first, second, ratio } if row.owner != RowOwner::Coupling => {
                pair(second, -l);
                pair(first, ratio * l);
            }
            _ => {}
        }
    }
    couplings(d, lambda, &mut pair);
    out
}

#[test]
fn noise_is_what_it_was() {
    // the states of all tests hang on it
    assert_eq!(Noise(1).vector(2), Noise(1).vector(2));
    assert_ne!(Noise(1).vector(2), Noise(2).vector(2));
}
