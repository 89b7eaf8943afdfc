//! Laws of forces and reactions: powers, energies, tangents, balances.

use super::*;

#[test]
fn power_in_is_the_rate_of_kinetic_energy() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let s = moving(m, s);
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let w = &d.work;
        let mut power: f64 = (1..m.bodies.len()).map(|b| w.applied[b].power(w.twists[b])).sum();
        power += m.efforts.iter().zip(&w.efforts).map(|(e, size)| size * d.swept(e.along)).sum::<f64>();
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
            let mut all = vec![d.gravity_energy()];
            all.extend((0..m.stretches.len()).map(|i| d.spring_energy(i, &s.modes)));
            all
        };
        let mut d = Dynamics::new(m);
        s.evaluate(&mut d);
        let by_time: Vec<f64> = (0..m.stretches.len()).map(|i| d.spring_power(i, &s.modes)).collect();
        let w = &d.work;
        let mut power = vec![0.0];
        for b in 1..m.bodies.len() {
            power[0] -= G::dot(m.gravity, w.twists[b].v * w.inertias[b].m + G::turn(w.twists[b].w, w.inertias[b].h));
        }
        for (i, &effort) in m.spring_efforts.iter().enumerate() {
            let damping = match m.efforts[effort].law {
                EffortLaw::Linear { damping, .. } => damping,
                EffortLaw::Law { output, .. } => w.force_outputs[output + 1],
                EffortLaw::Drive { .. } | EffortLaw::Friction { .. } => 0.0,
            };
            // what the bodies and time put in, less what damping takes
            power.push(by_time[i] - w.efforts[effort] * d.swept(m.efforts[effort].along) - damping * d.stretch_rate(i).powi(2));
        }
        close("V̇", &slope(H, |e| potential(&s.after(m, e))), &power, DIFFERENCE);
    }
    everywhere!(law);
}

#[test]
fn tangents_are_derivatives_of_the_residual() {
    fn law<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
        let differentiable = dynamics::Differentiable::new(m.clone());
        let at = dynamics::Point { t: s.t, q: &s.q, v: &s.v, z: &[], a: &s.a, lambda: &s.lambda, modes: &s.modes };
        let mut linearizer = dynamics::Linearizer::new(&differentiable);
        let mut out = Tangent::new(&linearizer.pattern(0));
        linearizer.tangents(&at, &mut out);
        let residual = |s: &State| {
            let mut d = Dynamics::new(m);
            s.evaluate(&mut d);
            let mut r = vec![0.0; m.nv];
            d.residual(&s.a, &s.lambda, &mut r);
            r
        };
        let n = m.nv;
        // what a difference quotient of forces of this size is rounded to
        let size = residual(s).iter().fold(0.0, |m: f64, r| m.max(r.abs()));
        let rounding = 4.0 * f64::EPSILON * size / H;
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
            let column = |x: &Block| (0..n).map(|i| x.at(i, k)).collect::<Vec<_>>();
            close("K", &column(&out.k), &by_position, 1e-9 + rounding);
            close("C", &column(&out.c), &by_velocity, 1e-9 + rounding);
        }
    }
    for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
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
    let coloring = Coloring::new(&dynamics::tangent_pattern(&m));
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
            let f = f.about_origin(d.reference(joint.a.0.max(joint.b.0)));
            on[joint.b.0] += f;
            on[joint.a.0] -= f;
        }
        let mut pair = |gauge: usize, size: f64| {
            let g = &m.gauges[gauge];
            let f = (w.readings[gauge].wrench * size).about_origin(d.reference(g.a.max(g.b)));
            on[g.b] += f;
            on[g.a] -= f;
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
            let [inertial, applied] = [inertial, w.applied[b]].map(|f| f.about_origin(d.reference(b)));
            total += inertial;
            close(&format!("forces on {}", m.bodies[b].name), &wrench(on[b] + applied), &wrench(inertial), 1e-10);
        }
        close("shaking", &wrench(r.shaking), &wrench(total), EXACT);
        close("forces on the frame", &wrench(r.frame), &wrench(on[0]), 1e-10);
        // the whole: weight and loads less the rate of momentum are what the frame carries
        let applied = (1..m.bodies.len()).fold(Force::default(), |sum, b| sum + w.applied[b].about_origin(d.reference(b)));
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
pub(super) fn along_efforts<G: Space<S = f64>>(d: &Dynamics<'_, G>) -> Vec<f64> {
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
pub(super) fn along_rows<G: Space<S = f64>>(d: &Dynamics<'_, G>, lambda: &[f64]) -> Vec<f64> {
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
