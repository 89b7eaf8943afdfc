//! Grashof: mechanisms from a text file to motion, forces, vibrations and pictures.
//!
//! A model is a file, or a text, in the language that `docs/format.md` describes; a study of it has results with names:
//!
//! ```
//! let model = grashof::Model::parse(
//!     "
//! grashof: 1
//! name: pendulum
//! space: planar
//! gravity: [0, -9.81 m/s^2]
//! parameters: { length: 1 m }
//! bodies: { rod: { bar: { length: length, mass: 2 kg } } }
//! joints: { P: { revolute: [ground, rod.start] } }
//! start: { P.angle: -30 deg, P.omega: 0 }
//! studies:
//!   swing:
//!     dynamics: { until: 2 s, every: 10 ms }
//!     columns: [time, P.angle, P.fy]
//!     scalars: { largest: max(abs(P.fy)) }
//! ",
//! )?;
//! let results = model.study("swing")?.set("length", "60 cm").run()?;
//! assert_eq!(results.column("P.fy")?.len(), 201);
//! println!("{} N, at most {} N", results.column("P.fy")?[0], results.scalar("largest")?);
//! # Ok::<(), grashof::Error>(())
//! ```
//!
//! [`Model::load`] reads a file with what it includes. [`Study::over`] runs a study for many values of a parameter, [`Study::compare`]
//! computes a motion by several integrators, [`Study::rows_to`] gives rows to a sink as they are computed, which may be a file
//! ([`output::CsvRows`]). Errors have places in the file and remedies. What is computed is plain data ([`Results`]), from which
//! [`output`] makes CSV, JSON, figures and drawings.
//!
//! The mechanism itself can be evaluated by hand, and stepped:
//!
//! ```
//! # let text = "
//! # grashof: 1
//! # name: pendulum
//! # space: planar
//! # gravity: [0, -9.81 m/s^2]
//! # bodies: { rod: { bar: { length: 1 m, mass: 2 kg } } }
//! # joints: { P: { revolute: [ground, rod.start] } }
//! # start: { P.angle: -30 deg, P.omega: 0 }
//! # ";
//! # let model = grashof::Model::parse(text)?;
//! let mechanism = model.mechanism()?;
//! let (q, v) = mechanism.start();
//! let terms = mechanism.terms(0.0, &q, &v)?;
//! let (a, _) = mechanism.accelerations(0.0, &q, &v)?;
//! assert!((&terms.mass * &a - &terms.force).norm() < 1e-12);
//!
//! let mut motion = mechanism.simulate(grashof::solvers::Settings::default())?;
//! for step in 1..=10 {
//!     let state = motion.advance(0.1 * f64::from(step))?;
//!     let tip = mechanism.placement("rod", &state.q)?;
//!     assert!(tip.position.norm() < 1e-12);
//! }
//! # Ok::<(), grashof::Error>(())
//! ```
//!
//! Expressions of a model may call functions of the program, [`api::ExternalFunction`], which [`Model::with_functions`] gives them:
//!
//! ```
//! # let text = "
//! # grashof: 1
//! # name: pendulum
//! # space: planar
//! # gravity: [0, -9.81 m/s^2]
//! # bodies: { rod: { bar: { length: 1 m, mass: 2 kg } } }
//! # joints: { P: { revolute: [ground, rod.start] } }
//! # loads: { air: { joint: P, torque: drag(P.omega) } }
//! # start: { P.angle: -30 deg, P.omega: 0 }
//! # studies: { swing: { dynamics: { until: 1 s }, columns: [P.angle] } }
//! # ";
//! use grashof::api::ExternalFunction;
//! // `torque: drag(P.omega)` in the file
//! let drag = ExternalFunction::new("drag", &["rate"], |x| -0.1 * x[0]).unit("N m").switches(&[]);
//! let results = grashof::Model::parse(text)?.with_functions(vec![drag])?.study("swing")?.run()?;
//! # assert!(results.stopped.is_none());
//! # Ok::<(), grashof::Error>(())
//! ```
//!
//! A force law of one's own is a closure on the motion of points, which [`Mechanism::with_force`] takes. An integrator of one's own is a
//! [`solvers::Scheme`]: [`Mechanism::simulate_by`] steps with it, [`Study::integrator`] brings it into [`Study::compare`]. A system of
//! one's own is a [`solvers::System`]. How the rooms below depend on each other is drawn in `docs/architecture.md`.

pub mod api;
pub mod dynamics;
pub mod expression;
pub mod geometry;
pub mod kinematics;
pub mod mechanism;
pub mod model;
pub mod numerics;
pub mod output;
pub mod par;
pub mod results;
pub mod scalar;
pub mod studies;

/// Integrators and the linear algebra below them.
pub use grashof_solvers as solvers;

pub use api::{Error, Mechanism, Model, Simulation, Study};
pub use results::Results;

/// The section of the README on the library, compiled as it stands there.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
