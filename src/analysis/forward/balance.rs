//! The certificate of a run: energy balance, residuals of the constraints, work done by the integrator.
//!
//! E(t) − E(0) must be the work of drivers, loads and dampers, integrated beside the motion, and what impacts took at once. What
//! remains is the energy that the integration has made or lost.

use super::march::Begins;
use super::setup::Plan;
use super::system::{Mechanical, WORKS};
use super::trajectory::Trajectory;
use crate::analysis::motion::Rows;
use crate::analysis::outcome::{Certificate, Finding, March};
use crate::dynamics::LANES;
use crate::geometry::Space;
use crate::scalar::Dual;
use grashof_solvers::{Control, Counts, Integration, Node};

/// Energies looked at in the course of a run.
const LOOKS: f64 = 400.0;

/// Energies and counters of a run so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Balance {
    start: f64,
    /// Work before the present era.
    before: [f64; WORKS],
    work: [f64; WORKS],
    impacts: f64,
    drift: f64,
    scale: f64,
    kinetic: f64,
    next: f64,
    counts: Counts,
    bridged: Vec<f64>,
    widest_gap: f64,
    schemes: Vec<&'static str>,
}

/// Kinetic and whole energy at a node, J.
fn energy<G, D>(system: &mut Mechanical<'_, G, D>, node: &Node) -> [f64; 2]
where
    G: Space<S = f64>,
    D: Space<S = Dual<LANES>>,
{
    system.observe(&node.state.at(), &node.a, &node.lambda);
    let d = &mut system.dynamics;
    let kinetic = d.kinetic_energy();
    let mut modes = node.state.modes.clone();
    modes.truncate(d.mechanism.switches + d.mechanism.windings);
    [kinetic, kinetic + d.potential_energy(&mut modes)]
}

impl Balance {
    /// Begins an era at a node; energies that change because parameters do count as done by the event.
    pub(super) fn begin<G, D>(&mut self, system: &mut Mechanical<'_, G, D>, node: &Node, begins: Begins)
    where
        G: Space<S = f64>,
        D: Space<S = Dual<LANES>>,
    {
        let [kinetic, e] = energy(system, node);
        match begins {
            Begins::Run => (self.start, self.kinetic, self.scale) = (e, kinetic, kinetic),
            // the drift so far is not known apart from it, and begins anew
            Begins::Parameters => self.impacts = e - self.start - self.done(),
            Begins::Rests => {}
        }
        self.before = self.work;
        for (before, now) in self.before.iter_mut().zip(&node.state.work) {
            *before -= now;
        }
    }

    /// Work of drivers, loads and dampers so far, J.
    fn done(&self) -> f64 {
        self.work.iter().sum()
    }

    /// Looks at the energy of a node, if it is time to.
    pub(super) fn step<G, D>(&mut self, system: &mut Mechanical<'_, G, D>, node: &Node, until: f64)
    where
        G: Space<S = f64>,
        D: Space<S = Dual<LANES>>,
    {
        let t = node.state.t;
        if t < self.next && t < until {
            return;
        }
        self.next = t + until / LOOKS;
        self.look(system, node);
    }

    fn look<G, D>(&mut self, system: &mut Mechanical<'_, G, D>, node: &Node)
    where
        G: Space<S = f64>,
        D: Space<S = Dual<LANES>>,
    {
        for ((work, before), now) in self.work.iter_mut().zip(&self.before).zip(&node.state.work) {
            *work = before + now;
        }
        let [kinetic, e] = energy(system, node);
        let off = e - self.start - self.done() - self.impacts;
        self.drift = self.drift.max(off.abs());
        let largest = self.work.iter().fold(kinetic.max((e - kinetic - self.start + self.kinetic).abs()), |m, w| m.max(w.abs()));
        self.scale = self.scale.max(largest);
    }

    /// Energy that an impact took, from the sides before and after it.
    pub(super) fn jump<G, D>(&mut self, system: &mut Mechanical<'_, G, D>, [before, after]: [&Node; 2])
    where
        G: Space<S = f64>,
        D: Space<S = Dual<LANES>>,
    {
        if before.state.v != after.state.v {
            let [_, e0] = energy(system, before);
            let [_, e1] = energy(system, after);
            self.impacts += e1 - e0;
        }
    }

    /// Ends an era.
    pub(super) fn end<G, D>(&mut self, system: &mut Mechanical<'_, G, D>, node: &Node, run: &Integration, inner: Counts)
    where
        G: Space<S = f64>,
        D: Space<S = Dual<LANES>>,
    {
        self.look(system, node);
        self.counts += inner;
        self.spent(run);
    }

    /// Goes on from a run to another one, over a bridge that begins at a time, s, or from it.
    pub(super) fn turn(&mut self, run: &Integration, bridge: Option<f64>) {
        self.spent(run);
        self.counts.bridges += usize::from(bridge.is_some());
        self.bridged.extend(bridge);
    }

    /// Counts what a run has spent.
    fn spent(&mut self, run: &Integration) {
        self.counts += run.engine.counts;
        self.bridged.extend(run.bridged());
        self.widest_gap = self.widest_gap.max(run.widest_gap());
        for name in run.schemes() {
            if !self.schemes.contains(name) {
                self.schemes.push(name);
            }
        }
    }

    /// The certificate without the residuals of rows, and what a reader should know.
    pub(super) fn finish(self, plan: &Plan) -> (Certificate, Vec<Finding>) {
        let march = March {
            schemes: self.schemes.join(", "),
            tolerance: match plan.settings.control {
                Control::Tolerance(tolerance) => Some(tolerance),
                Control::Steps(_) => None,
            },
            energy_drift: self.drift,
            energy_scale: self.scale,
            drivers: self.work[0],
            loads: self.work[1],
            dampers: self.work[2],
            impacts: self.impacts,
            widest_gap: self.widest_gap,
            velocity: 0.0,
            counts: self.counts,
        };
        let findings = self.bridged.iter().take(20).map(|t| Finding {
            code: "singular-position",
            message: format!("a singular position was crossed near t = {t:.6} s"),
            path: "joints".into(),
        });
        (Certificate { switches: self.counts.events, march: Some(march), ..Certificate::default() }, findings.collect())
    }
}

/// Largest residuals over the rows of a run.
pub(in crate::analysis) fn residuals<G, D>(trajectory: &mut Trajectory<'_, G, D>, rows: &Rows, mut certificate: Certificate) -> Certificate
where
    G: Space<S = f64>,
    D: Space<S = Dual<LANES>>,
{
    certificate.evaluations = rows.places.len();
    let every = (rows.places.len() / 128).max(1);
    let mut velocity: f64 = 0.0;
    for (&t, &piece) in rows.places.iter().zip(&rows.pieces).step_by(every) {
        if trajectory.go(t, piece).is_err() {
            continue;
        }
        let [q, v] = trajectory.residuals(piece);
        certificate.constraint = certificate.constraint.max(q);
        velocity = velocity.max(v);
    }
    if let Some(march) = &mut certificate.march {
        march.velocity = velocity;
    }
    certificate
}
