//! A mechanism as u̇, ż and y of its independent state and its parameters, for differences.

use crate::dynamics::{Dynamics, Reactions, mass_pattern, row_pattern};
use crate::expression::Id;
use crate::geometry::Space;
use crate::kinematics::partition::Partition;
use crate::kinematics::undefined::Gap;
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::studies::common::observe::Observer;
use grashof_solvers::Kkt;
use grashof_solvers::weakest::weakest;
use nalgebra::{DMatrix, DVector};

/// Steps of closing, and so far closed: m or rad.
const STEPS: usize = 40;
const CLOSED: f64 = 1e-14;

/// A state of the whole mechanism at time 0.
#[derive(Clone, Debug)]
pub(super) struct Whole {
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) z: Vec<f64>,
    pub(super) modes: Vec<i32>,
}

/// What a state leads to.
#[derive(Clone, Debug, Default)]
pub(super) struct Answer {
    /// Accelerations (nv) and multipliers (rows).
    pub(super) a: Vec<f64>,
    pub(super) lambda: Vec<f64>,
    /// u̇ of the independent velocities (n), then ż (nz).
    pub(super) rates: Vec<f64>,
    /// Outputs.
    pub(super) outputs: Vec<f64>,
}

/// A mechanism at given parameters with what its outputs need.
pub(super) struct Probe<'m, G: Space> {
    dynamics: Dynamics<'m, G>,
    observer: Observer<G>,
    reactions: Reactions<G>,
    kkt: Kkt,
    /// σ of the rows in the state that was answered first.
    weakest: Option<f64>,
    metric: &'m [f64],
    /// What has no value in the state that was answered last.
    pub(super) gap: Option<Gap>,
}

impl<'m, G: Space<S = f64>> Probe<'m, G> {
    /// A probe of a mechanism at parameters, with the outputs `ids`; `metric` (nv) is that of the assembled start.
    pub(super) fn new(model: &Model, mechanism: &'m Mechanism<G>, parameters: &[f64], ids: &[Id], metric: &'m [f64]) -> Self {
        let dynamics = Dynamics::new(mechanism);
        Self {
            reactions: dynamics.reactions(),
            observer: Observer::new(model, mechanism, parameters, ids),
            kkt: Kkt::of_blocks(&mass_pattern(mechanism), &row_pattern(mechanism)),
            dynamics,
            weakest: None,
            metric,
            gap: None,
        }
    }

    /// What a consistent state leads to; none if its accelerations are not determined. With `settle` the modes of the outputs'
    /// switches are taken from it.
    pub(super) fn answer(&mut self, at: &mut Whole, independent: &[usize], settle: bool) -> Option<Answer> {
        let m = self.dynamics.mechanism;
        let d = &mut self.dynamics;
        d.work.z.copy_from_slice(&at.z);
        d.terms(0.0, &at.q, &at.v, &at.modes);
        d.rates(&at.modes);
        self.gap = d.undefined(&at.modes).map(Gap::Law);
        let row_scale = d.row_scale(&at.q, &at.modes, self.metric);
        self.kkt.set_scale(self.metric, &row_scale);
        let weakest = *self.weakest.get_or_insert_with(|| weakest(&mut self.kkt, self.metric, &row_scale, &d.work.g));
        self.kkt.set_weakest(weakest);
        self.kkt.factor(d.work.mass.values(), d.work.g.values()).ok()?;
        let mut out = Answer { a: vec![0.0; m.nv], lambda: vec![0.0; m.rows.len()], ..Answer::default() };
        self.kkt.solve(&d.work.force, &d.work.gamma, &mut out.a, &mut out.lambda);
        out.rates = independent.iter().map(|&i| out.a[i]).chain(d.work.zdot.iter().copied()).collect();
        d.react(&out.a, &out.lambda, &mut self.reactions);
        self.observer.read(d, [&at.q, &at.v, &out.a], &self.reactions, &at.modes);
        if settle {
            self.observer.set_modes(&mut at.modes);
        }
        out.outputs = vec![0.0; self.observer.program().outputs()];
        self.observer.columns(&at.modes, &mut out.outputs);
        self.gap = self.gap.take().or_else(|| self.observer.undefined(&at.modes, &out.outputs));
        out.a.iter().all(|a| a.is_finite()).then_some(out)
    }

    /// The consistent state next to a given one whose independent coordinates are moved by x (n) and whose independent velocities are
    /// u (n); none if the constraints do not close.
    pub(super) fn state(&mut self, base: &Whole, partition: &Partition, x: &DVector<f64>, u: &DVector<f64>) -> Option<Whole> {
        let mut at = base.clone();
        let m = self.dynamics.mechanism;
        m.retract(&mut at.q, (&partition.p * x).as_slice());
        self.dynamics.time(0.0, &at.modes);
        let mut size = f64::INFINITY;
        for _ in 0..STEPS {
            self.dynamics.position(&at.q, &at.modes);
            let phi = DMatrix::from_column_slice(m.rows.len(), 1, &self.dynamics.work.phi);
            let left = if phi.is_empty() { 0.0 } else { phi.amax() };
            // round-off does not fall any more
            if left <= CLOSED || (left >= 0.5 * size && left < 1e-11) {
                size = left;
                break;
            }
            size = left;
            m.retract(&mut at.q, partition.follow(&phi).as_slice());
        }
        if size.is_nan() || size > 1e-10 {
            return None;
        }
        self.dynamics.velocity(&vec![0.0; m.nv], &at.modes);
        let w = &self.dynamics.work;
        let g = DMatrix::from_row_slice(m.rows.len(), m.nv, &w.g.to_dense());
        let row_scale = self.dynamics.row_scale(&at.q, &at.modes, self.metric);
        let here = Partition::of(&g, self.metric, &row_scale, partition.independent.clone());
        let nu = DMatrix::from_column_slice(m.rows.len(), 1, &w.nu);
        let v = &here.p * u + here.follow(&-nu);
        at.v.copy_from_slice(v.as_slice());
        Some(at)
    }
}
