//! A mechanism whose drivers leave no freedom: position, velocity, acceleration and multipliers at any time by Newton's method.

use super::assemble::Assembled;
use crate::dynamics::{Dynamics, Reactions};
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use grashof_solvers::kkt::{Kkt, row_scale};

/// Newton did not reach a position at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotReached;

/// The solver of one driven mechanism; one per thread. Nothing is allocated per solution.
#[derive(Clone, Debug)]
pub struct Driven<'m, G: Space> {
    /// The evaluator, left at the solution found last.
    pub dynamics: Dynamics<'m, G>,
    /// Coordinates of the solution found last (nq).
    pub q: Vec<f64>,
    /// Velocities (nv).
    pub v: Vec<f64>,
    /// Accelerations (nv).
    pub a: Vec<f64>,
    /// Multipliers (rows).
    pub lambda: Vec<f64>,
    /// What follows for bodies and joints.
    pub reactions: Reactions<G>,
    /// Size of the correction that Newton made in all, largest component in units of `unit`.
    pub correction: f64,
    kkt: Kkt,
    /// Diagonal of the mass metric as a matrix (nv × nv).
    metric: Vec<f64>,
    /// 1 for angles, the size of the mechanism for lengths (nv).
    unit: Vec<f64>,
    delta: Vec<f64>,
    rhs: Vec<f64>,
    scratch: Vec<f64>,
    zeros: Vec<f64>,
}

/// Corrections below this are below round-off after one more quadratic step.
const QUADRATIC: f64 = 1e-8;
/// Newton steps before a position counts as not reached.
const STEPS: usize = 12;

impl<'m, G: Space<S = f64>> Driven<'m, G> {
    /// A solver that begins at the assembled start.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism<G>, start: &Assembled) -> Self {
        let (nv, rows) = (mechanism.nv, mechanism.rows.len());
        let mut dynamics = Dynamics::new(mechanism);
        dynamics.time(0.0, &start.modes);
        dynamics.position(&start.q, &start.modes);
        let mut kkt = if rows == nv { Kkt::determinate(nv) } else { Kkt::new(nv, rows) };
        kkt.set_scale(&start.metric, &row_scale(&dynamics.work.g, &start.metric));
        let mut metric = vec![0.0; nv * nv];
        for (i, d) in start.metric.iter().enumerate() {
            metric[i * nv + i] = *d;
        }
        let unit = super::assemble::units(mechanism).iter().map(|u| if *u == 0 { 1.0 } else { start.size }).collect();
        let reactions = dynamics.reactions();
        Self {
            dynamics,
            q: start.q.clone(),
            v: start.v.clone(),
            a: vec![0.0; nv],
            lambda: vec![0.0; rows],
            reactions,
            correction: 0.0,
            kkt,
            metric,
            unit,
            delta: vec![0.0; nv],
            rhs: vec![0.0; rows],
            scratch: vec![0.0; rows],
            zeros: vec![0.0; nv],
        }
    }

    /// Newton's method from `self.q` at time `t`; leaves the factorisation of G at the solution.
    ///
    /// # Errors
    /// If it does not converge, or G is singular on the way.
    pub fn position(&mut self, t: f64, modes: &[i32]) -> Result<(), NotReached> {
        self.dynamics.time(t, modes);
        self.correction = 0.0;
        let mut last = f64::INFINITY;
        for step in 0..STEPS {
            self.dynamics.position(&self.q, modes);
            self.kkt.factor(&self.metric, &self.dynamics.work.g).map_err(|_| NotReached)?;
            if last < QUADRATIC {
                return Ok(());
            }
            for (r, phi) in self.rhs.iter_mut().zip(&self.dynamics.work.phi) {
                *r = -phi;
            }
            self.kkt.solve(&self.zeros, &self.rhs, &mut self.delta, &mut self.scratch);
            let size = self.delta.iter().zip(&self.unit).map(|(d, u)| (d / u).abs()).fold(0.0, f64::max);
            // growing, or turning by more than a quarter: this is not the neighbourhood of a solution
            if !size.is_finite() || size > 1.5 || (step > 2 && size > last) {
                return Err(NotReached);
            }
            self.correction += size;
            self.dynamics.mechanism.retract(&mut self.q, &self.delta);
            last = size;
        }
        Err(NotReached)
    }

    /// Velocities and accelerations at the position found last, with the driver laws of `modes`.
    pub fn rates(&mut self, modes: &[i32]) {
        self.dynamics.velocity(&self.zeros, modes);
        self.rhs.copy_from_slice(&self.dynamics.work.nu);
        self.kkt.solve(&self.zeros, &self.rhs, &mut self.v, &mut self.scratch);
        self.dynamics.velocity(&self.v, modes);
        self.rhs.copy_from_slice(&self.dynamics.work.gamma);
        self.kkt.solve(&self.zeros, &self.rhs, &mut self.a, &mut self.scratch);
    }

    /// Forces, multipliers and reactions for the motion found last.
    pub fn forces(&mut self, modes: &[i32]) {
        self.dynamics.forces(modes);
        self.dynamics.mass();
        let work = &self.dynamics.work;
        if self.kkt.is_determinate() {
            // the factorisation of G stands; only f − M a changes
            self.multipliers();
        } else if self.kkt.factor(&work.mass, &work.g).is_ok() {
            self.rhs.copy_from_slice(&work.gamma);
            self.kkt.solve(&work.force, &self.rhs, &mut self.a, &mut self.lambda);
        }
        self.dynamics.react(&self.a, &self.lambda, &mut self.reactions);
    }

    /// λ = G⁻ᵀ(f − M a) by the factorisation at hand: the solver's mass is the metric, so f is shifted by (D − M) a.
    fn multipliers(&mut self) {
        let nv = self.dynamics.mechanism.nv;
        let work = &self.dynamics.work;
        for i in 0..nv {
            let row = &work.mass[i * nv..(i + 1) * nv];
            let ma: f64 = row.iter().zip(&self.a).map(|(m, a)| m * a).sum();
            self.delta[i] = work.force[i] - ma + self.metric[i * nv + i] * self.a[i];
        }
        self.rhs.copy_from_slice(&work.gamma);
        self.kkt.solve(&self.delta, &self.rhs, &mut self.a, &mut self.lambda);
    }

    /// Ratio of the smallest to the largest pivot of the factorisation: near 0 in a singular position.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.kkt.lu().pivot_ratio()
    }

    /// Largest component of a displacement in units of angles and of the mechanism's size.
    #[must_use]
    pub fn measure(&self, delta: &[f64]) -> f64 {
        delta.iter().zip(&self.unit).map(|(d, u)| (d / u).abs()).fold(0.0, f64::max)
    }
}
