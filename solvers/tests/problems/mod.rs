//! Mechanical problems with known answers, written by hand as implementations of [`System`](grashof_solvers::System).
//!
//! Each has a consistent start, an energy whose rate is the sum of its powers, exact tangents, and a closed form or the digits of
//! a reference. SI units and radians; planar problems have x to the right and y up.

#![allow(dead_code, unused_imports, reason = "the benchmark uses a part")]

#[macro_use]
mod base;

mod andrews;
mod car_axis;
mod chain;
mod elastic;
mod elliptic;
mod explicit;
mod linear;
mod linkage;
mod linkages;
mod pendulum;
mod quaternion;
mod skate;
mod switched;
mod tops;

pub(crate) use andrews::Andrews;
pub(crate) use base::{Problem, noise};
pub(crate) use car_axis::CarAxis;
pub(crate) use chain::Chain;
pub(crate) use elastic::ElasticPendulum;
pub(crate) use explicit::Explicit;
pub(crate) use linear::{InductanceMotor, StiffPair};
pub(crate) use linkages::{FourBarTwin, NFourBar, RodChain, SliderCrank};
pub(crate) use pendulum::{Pendulum, PendulumAngle};
pub(crate) use skate::Skate;
pub(crate) use switched::{BouncingBall, DryOscillator, KinkedSpring, RecordAt, StopAt, Wavering};
pub(crate) use tops::{FreeBody, HeavyTop, HeavyTopCartesian};

/// One of every kind, for tests that hold for all.
pub(crate) fn all() -> Vec<Box<dyn Problem>> {
    vec![
        Box::new(Pendulum::new()),
        Box::new(PendulumAngle::new()),
        Box::new(CarAxis::new()),
        Box::new(Andrews::new()),
        Box::new(Andrews::iftomm()),
        Box::new(SliderCrank::new(0.1, 0.3, [0.2, 0.5, 1.0], 0.4, 10.0)),
        Box::new(SliderCrank::equal_arms(0.0)),
        Box::new(NFourBar::new(1, 0.0)),
        Box::new(NFourBar::new(6, 0.0)),
        Box::new(FourBarTwin::new(2)),
        Box::new(FreeBody::new()),
        Box::new(HeavyTop::cusp()),
        Box::new(HeavyTop::steady(false)),
        Box::new(HeavyTopCartesian::cusp()),
        Box::new(StiffPair::new(1e6, 2e3)),
        Box::new(ElasticPendulum::new(1e4, 20.0)),
        Box::new(BouncingBall::new(1.0, 0.5)),
        Box::new(DryOscillator::new(1.0)),
        Box::new(KinkedSpring::new(1.0, 9.0)),
        Box::new(StopAt::new(0.5)),
        Box::new(RecordAt::new(0.5)),
        Box::new(InductanceMotor::new()),
        Box::new(Skate::new()),
        Box::new(Chain::horizontal(10, 0.1)),
        Box::new(RodChain::new(7)),
    ]
}
