//! Evaluations allocate nothing once their scratch is made.

use crate::common::{State, mechanism, model};
use allocation_counter::measure;
use grashof::dynamics::Dynamics;
use grashof::geometry::{Planar, Space, Spatial};
use grashof::kinematics::assemble::assemble;
use grashof::kinematics::driven::Driven;
use grashof::mechanism::{Coordinates, Mechanism};
use grashof::model::{Dimensions, Model};
use grashof::studies::common::case::parameters;
use grashof::studies::common::observe::Observer;

fn terms<G: Space<S = f64>>(m: &Mechanism<G>, s: &State) {
    let mut d = Dynamics::new(m);
    let mut r = d.reactions();
    let mut residual = vec![0.0; m.nv];
    let mut q = s.q.clone();
    let mut rate = vec![0.0; m.nq];
    let info = measure(|| {
        d.terms(s.t, &s.q, &s.v, &s.modes);
        d.watch(&s.q, &s.v, &s.modes);
        d.residual(&s.a, &s.lambda, &mut residual);
        d.accelerate(&s.a, &mut r.accelerations);
        d.unbalanced(&s.a, &r.accelerations, &mut residual);
        d.react(&s.a, &s.lambda, &mut r);
        m.retract(&mut q, &s.v);
        m.rate(&q, &s.v, &mut rate);
        assert!(d.kinetic_energy() > 0.0 && d.gravity_energy().is_finite());
        for spring in 0..m.stretches.len() {
            assert!(d.spring_energy(spring, &s.modes).is_finite());
        }
    });
    assert_eq!(info.count_total, 0);
}

#[test]
fn terms_residuals_reactions_and_energies_allocate_nothing() {
    for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
        let planar = mechanism::<Planar<f64>>(include_str!("common/planar.yaml"), coordinates);
        terms(&planar, &State::random(&planar, 1));
        let spatial = mechanism::<Spatial<f64>>(include_str!("common/spatial.yaml"), coordinates);
        terms(&spatial, &State::random(&spatial, 1));
    }
}

fn sample<G: Space<S = f64>>(model: &Model, coordinates: Coordinates) {
    let parameters = parameters(model);
    let (m, start) = assemble::<G>(model, &parameters, coordinates).expect("a start");
    let columns: Vec<_> = model.study.as_ref().expect("a study").columns.iter().map(|c| c.value).collect();
    let mut observer = Observer::new(model, &m, &parameters, &columns);
    let mut out = vec![0.0; columns.len()];
    let mut driven = Driven::new(&m, &start);
    let mut modes = start.modes.clone();
    let info = measure(|| {
        for i in 0..20 {
            driven.position(1e-4 * f64::from(i), &modes).expect("a position");
            driven.rates(&modes);
            driven.forces(&modes);
            let Driven { dynamics, q, v, a, reactions, .. } = &mut driven;
            observer.read(dynamics, [q, v, a], reactions, &modes);
            observer.set_modes(&mut modes);
            observer.columns(&modes, &mut out);
        }
    });
    assert_eq!(info.count_total, 0, "{}", model.name);
    assert!(out.iter().all(|x| x.is_finite()), "{out:?}");
}

#[test]
fn samples_of_a_driven_motion_and_their_columns_allocate_nothing() {
    for (file, study) in [
        ("crank_rocker.yaml", "one-turn"),
        ("quick_return.yaml", "one-turn"),
        ("scotch_yoke.yaml", "one-turn"),
        ("four_bar_spatial.yaml", "one-turn"),
    ] {
        let text = std::fs::read_to_string(format!("{}/models/{file}", env!("CARGO_MANIFEST_DIR"))).unwrap();
        let model = model(&text, Some(study));
        for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
            match model.space {
                Dimensions::Planar => sample::<Planar<f64>>(&model, coordinates),
                Dimensions::Spatial => sample::<Spatial<f64>>(&model, coordinates),
            }
        }
    }
}
