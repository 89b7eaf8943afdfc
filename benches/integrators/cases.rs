//! Motions that the integrators are compared on, each with what must come out at its end.

use grashof::model::{Control, Document, Forward, Integrator, Kind, Model, Selection, Study};
use grashof::studies::common::case::{self, parameters};
use grashof::studies::dynamics;
use grashof::studies::dynamics::Unrecorded;
use std::time::Instant;

/// A step, or a tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Size {
    Tolerance(f64),
    Step(f64),
}

/// A motion with its end.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    /// What it is, for the document.
    pub(crate) about: &'static str,
    model: Model,
    study: Study,
    forward: Forward,
    values: Vec<f64>,
    /// Columns at the end.
    pub(crate) reference: Vec<f64>,
    /// Where they are from.
    pub(crate) source: String,
    /// The longest fixed step that is worth trying, s.
    pub(crate) step: f64,
}

/// One run.
#[derive(Clone, Debug)]
pub(crate) struct Sample {
    /// From the first step to the last, s.
    pub(crate) time: f64,
    /// Largest difference of a column, SI.
    pub(crate) error: f64,
    pub(crate) bare: Unrecorded,
}

impl Case {
    /// The study `study` of a text, with the columns of `columns` alone (all if there are none) and until `until`, s.
    fn of(name: &'static str, about: &'static str, text: &str, study: &str, columns: &[&str], until: f64, step: f64) -> Self {
        let selection = Selection { study: Some(study), ..Selection::default() };
        let read = Document::read(text, name).and_then(|d| d.model(&selection));
        let mut model = read.unwrap_or_else(|report| panic!("{name}: {}", report.render(false)));
        let mut study = model.study.clone().unwrap_or_else(|| panic!("{name} has no study"));
        if !columns.is_empty() {
            study.columns.retain(|c| columns.contains(&c.name.as_str()));
        }
        let Kind::Dynamics(mut forward) = study.kind.clone() else { panic!("{name} is no motion in time") };
        forward.until = model.pool.constant(until);
        let values = parameters(&model);
        Self { name, about, model, study, forward, values, reference: Vec::new(), source: String::new(), step }
    }

    /// Runs it once.
    pub(crate) fn run(&self, by: Integrator, size: Size) -> Sample {
        let mut model = self.model.clone();
        let control = match size {
            Size::Tolerance(x) => Control::Tolerance(Some(model.pool.constant(x))),
            Size::Step(h) => Control::Step(model.pool.constant(h)),
        };
        let forward =
            Forward { integrator: by, control, alpha: None, beta: None, rho: None, order: None, level: None, ..self.forward.clone() };
        let (mut begin, mut time) = (Instant::now(), 0.0);
        let mut timer = |on: bool| if on { begin = Instant::now() } else { time = begin.elapsed().as_secs_f64() };
        let ended = dynamics::unrecorded(case::Case::new(&model, &self.study, &self.values), &forward, &mut timer);
        let bare = ended.unwrap_or_else(|failure| Unrecorded { stopped: Some(failure.reason()), ..Unrecorded::default() });
        let error = bare.columns.iter().zip(&self.reference).map(|(x, r)| (x - r).abs()).fold(0.0, f64::max);
        Sample { time, error: if bare.stopped.is_none() { error } else { f64::NAN }, bare }
    }

    /// The best time of a few runs; short ones are repeated.
    pub(crate) fn best(&self, by: Integrator, size: Size, repeats: usize) -> Sample {
        let mut best = self.run(by, size);
        let mut spent = best.time;
        for _ in 1..repeats {
            if spent > 0.3 || best.bare.stopped.is_some() {
                break;
            }
            let next = self.run(by, size);
            spent += next.time;
            best.time = best.time.min(next.time);
        }
        best
    }

    /// Takes the reference from two families at tight tolerances.
    fn referenced(mut self) -> Self {
        let explicit = self.run(Integrator::Dop853, Size::Tolerance(1e-13));
        let implicit = self.run(Integrator::Radau5, Size::Tolerance(1e-12));
        let off = explicit.bare.columns.iter().zip(&implicit.bare.columns).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        self.source = format!("dop853 at 1e-13, which radau5 at 1e-12 meets to {off:.1e}");
        assert!(off < 1e-6, "{}: {} ({:?}, {:?})", self.name, self.source, explicit.bare.stopped, implicit.bare.stopped);
        self.reference = explicit.bare.columns;
        self
    }

    fn known(mut self, reference: &[f64], source: &str) -> Self {
        (self.reference, self.source) = (reference.to_vec(), source.into());
        self
    }

    /// The crank-rocker from rest under a constant torque.
    pub(crate) fn crank_rocker() -> Self {
        let about = "crank-rocker with its tip mass, from rest, 200 N m on the crank, 4.26 N m s/rad, gravity, 5 s: 29 turns";
        Self::of("crank-rocker", about, CRANK_ROCKER, "motion", &[], 5.0, 1e-3)
            .known(&[179.450848725376, 81.26636095048], "θ and ω after 5 s from the reduced equation in 80-bit arithmetic")
    }

    /// The start of the crank-rocker by its geared motor.
    pub(crate) fn start_up(until: f64) -> Self {
        let about = "crank-rocker started by its geared motor against the tip load";
        Self::of("start-up", about, include_str!("../../models/crank_rocker.yaml"), "start-up-exact", &["theta", "omega"], until, 1e-3)
    }

    pub(crate) fn andrews() -> Self {
        let angles = ["beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"];
        let about = "Andrews' squeezing mechanism, 7 bodies, 3 loops, 30 ms";
        let right = [
            15.81077119515371,
            -15.75637105841184,
            0.0408222401196458,
            -0.5347301163420796,
            0.5244099658799541,
            0.5347301163420796,
            1.048080741041938,
        ];
        Self::of("andrews", about, include_str!("../../models/andrews.yaml"), "squeeze", &angles, 0.03, 1e-5)
            .known(&right, "the seven angles by extrapolation in 40-digit arithmetic")
    }

    /// Springs and dampers with a decay of 0.1 ms beside a swing of a second.
    pub(crate) fn flyball() -> Self {
        let about = "flyball governor in space (IFToMM A05) with springs of 8e5 N/m and dampers of 4e4 N s/m, 1 s; eigenvalues -8117, -20 and ±7.3i 1/s";
        let case = Self::of("flyball", about, FLYBALL, "motion", &[], 1.0, 2e-4).referenced();
        let known = 0.501420922379568;
        assert!((case.reference[0] - known).abs() < 1e-8, "flyball: s(1) = {}, not {known}", case.reference[0]);
        case
    }

    /// Ten point masses on massless links.
    pub(crate) fn chain() -> Self {
        let about = "chain of ten point masses of 1 kg on links of 0.1 m, from the horizontal, 0.5 s";
        Self::of("chain", about, &chain(10), "motion", &[], 0.5, 1e-3).referenced()
    }
}

const CRANK_ROCKER: &str = "\
grashof: 1
name: crank-rocker
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], C: [1 m, 0] }
bodies:
  crank: { bar: { length: 15 cm, mass: 30 kg } }
  coupler: { bar: { length: 1 m, mass: 60 kg } }
  rocker:
    bar: { length: 70 cm, mass: 60 kg }
    points: { B: [55 cm, 0], tip: [70 cm, 0] }
    attached: { load: { at: tip, mass: 90 kg } }
joints:
  O: { revolute: [ground.O, crank.start], damping: 4.26 N m s/rad }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.B] }
  C: { revolute: [ground.C, rocker.start] }
loads: { drive: { joint: O, torque: 200 N m } }
start: { O.angle: 0 deg, O.omega: 0, coupler.angle: ~33 deg, rocker.angle: ~92 deg }
studies:
  motion:
    dynamics: { until: 5 s, tolerance: 1e-8 }
    columns: [O.angle, O.omega]
";

const FLYBALL: &str = "\
grashof: 1
name: flyball governor
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  shaft:
    box: { size: [1 cm, 1 cm, 1 m], mass: 0.3 kg }
    points: { foot: [0, 0, -50 cm], near: [5 cm, 0, 50 cm], far: [-5 cm, 0, 50 cm] }
  slider:
    box: { size: [10 cm, 10 cm, 10 cm], mass: 3 kg }
    points: { near: [5 cm, 0, 0], far: [-5 cm, 0, 0] }
  right:
    bar: { length: 1 m, width: 1 cm, height: 1 cm, mass: 0.3 kg }
    points: { middle: [50 cm, 0, 0] }
    attached: { ball: { at: end, mass: 5 kg } }
  left:
    bar: { length: 1 m, width: 1 cm, height: 1 cm, mass: 0.3 kg }
    points: { middle: [50 cm, 0, 0] }
    attached: { ball: { at: end, mass: 5 kg } }
joints:
  P: { revolute: [ground, shaft.foot], axis: [0, 0, 1] }
  S: { slider: [shaft.foot, slider.origin], axis: [0, 0, 1] }
  R: { revolute: [shaft.near, right.start], axis: [0, 1, 0] }
  L: { revolute: [shaft.far, left.start], axis: [0, 1, 0] }
springs:
  right_strut: { between: [right.middle, slider.near], stiffness: 8e5 N/m, damping: 4e4 N s/m, length: 50 cm }
  left_strut: { between: [left.middle, slider.far], stiffness: 8e5 N/m, damping: 4e4 N s/m, length: 50 cm }
start:
  P.angle: 0 deg
  P.omega: 1 turn/s
  S.position: 50 cm
  S.velocity: 0 m/s
  R.angle: 30 deg
  R.omega: 0 rad/s
  L.angle: 150 deg
  L.omega: 0 rad/s
studies:
  motion:
    dynamics: { until: 1 s, tolerance: 1e-8 }
    columns: [S.position, R.angle, P.omega]
";

/// A hanging chain, drawn along x.
fn chain(links: usize) -> String {
    let (mut bodies, mut joints, mut start, mut columns) = (String::new(), String::new(), String::new(), Vec::new());
    for k in 1..=links {
        bodies += &format!("  b{k}: {{ bar: {{ length: 10 cm }}, attached: {{ m: {{ at: end, mass: 1 kg }} }} }}\n");
        let before = if k == 1 { "ground".into() } else { format!("b{}.end", k - 1) };
        joints += &format!("  J{k}: {{ revolute: [{before}, b{k}.start] }}\n");
        start += &format!("  J{k}.angle: 0 deg\n  J{k}.omega: 0 rad/s\n");
        columns.push(format!("J{k}.angle"));
    }
    format!(
        "grashof: 1\nname: chain\nspace: planar\ngravity: [0, -9.81 m/s^2]\nbodies:\n{bodies}joints:\n{joints}start:\n{start}studies:\n  motion:\n    dynamics: {{ until: 0.5 s, tolerance: 1e-8 }}\n    columns: [{}]\n",
        columns.join(", ")
    )
}
