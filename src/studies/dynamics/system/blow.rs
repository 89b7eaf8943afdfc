//! What holds a mechanism at a blow. Drivers go on, there and where their law has a kink, so that their impulses work; stops on which
//! joints rest can only push.

use super::{Mechanical, Root};
use crate::geometry::Space;
use crate::mechanism::StretchOf;
use grashof_solvers::{At, Kkt, Power, Stage, State, System, Terms};
use nalgebra::{DMatrix, DVector};

/// Part of the largest impulse above which a stop that rests pulls.
const PULLED: f64 = 1e-9;

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Work of the rows that move with time, J, while the velocities jump from one state to another of the same position; `crossed` are
    /// the roots that were met.
    ///
    /// ```text
    /// M Δv = Σ p W + Gᵀκ,   work = ½ κ·(ν before + ν after)
    /// ```
    ///
    /// with the unit forces W of the stops and one-way clutches that were met. They are told from the rows by y, which the rows leave:
    /// M y + Gᵀμ = W, G y = 0, so that yᵀM Δv = Σ p yᵀW.
    pub(crate) fn driven_work(&mut self, [before, after]: [&State; 2], crossed: &[usize]) -> f64 {
        // powers depend on reactions where rows move with time
        if self.pattern.power != Power::Reactions {
            return 0.0;
        }
        let mut terms = Terms::new(self.dims, &self.pattern);
        self.terms(before.at(), Stage::Velocity, &mut terms);
        let nu_before = terms.nu.clone();
        self.terms(after.at(), Stage::Velocity, &mut terms);
        if nu_before.iter().chain(&terms.nu).all(|nu| *nu == 0.0) {
            return 0.0;
        }
        let kkt = self.kkt.get_or_insert_with(|| Kkt::of_pattern(&self.pattern));
        if kkt.factor(terms.mass.values(), terms.g.values()).is_err() {
            return 0.0;
        }
        let jump: Vec<f64> = after.v.iter().zip(&before.v).map(|(after, before)| after - before).collect();
        let mut rest: Vec<f64> = terms.mass.lines().map(|line| line.dot(&jump)).collect();
        let unit_forces: Vec<Vec<f64>> = self.met(crossed).into_iter().map(|along| self.gradient(along)).collect();
        let free: Vec<Vec<f64>> = unit_forces.iter().map(|w| self.response(w).a).collect();
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let n = free.len();
        if n > 0 {
            let sizes = DMatrix::from_fn(n, n, |i, k| dot(&free[i], &unit_forces[k]));
            let wanted = DVector::from_fn(n, |i, _| dot(&free[i], &rest));
            let Ok(impulses) = sizes.svd(true, true).solve(&wanted, f64::EPSILON) else { return 0.0 };
            for (w, p) in unit_forces.iter().zip(&impulses) {
                rest.iter_mut().zip(w).for_each(|(rest, w)| *rest -= p * w);
            }
        }
        let kappa = self.response(&rest).lambda;
        0.5 * kappa.iter().zip(nu_before.iter().zip(&terms.nu)).map(|(k, (before, after))| k * (before + after)).sum::<f64>()
    }

    /// Stops on which joints rest that would have to pull while an impulse along a unit force (nv) strikes in a state: in M x + Gᵀκ = w,
    /// G x = 0 their impulses are κ.
    pub(super) fn pulled(&mut self, at: &At<'_>, force: &[f64]) -> Vec<usize> {
        let resting = |root: &Root| if let Root::Rest { row, stop } = *root { Some((row, stop)) } else { None };
        let rests: Vec<(usize, usize)> = self.roots.iter().filter_map(resting).collect();
        if rests.is_empty() {
            return Vec::new();
        }
        if !self.factored(at) {
            return Vec::new();
        }
        let kappa = self.response(force).lambda;
        let most = kappa.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let stops = &self.dynamics.mechanism.stops;
        rests.into_iter().filter(|&(row, stop)| stops[stop].sense * kappa[row] > PULLED * most).map(|(_, stop)| stop).collect()
    }

    /// What the stops and one-way clutches that were met act along, each once.
    fn met(&self, crossed: &[usize]) -> Vec<StretchOf> {
        let m = self.dynamics.mechanism;
        let mut all = Vec::new();
        for root in crossed.iter().filter_map(|root| self.roots.get(*root)) {
            let along = match *root {
                Root::Stop(stop) => Some(StretchOf::Gauge(m.stops[stop].gauge)),
                Root::Event(event) => m.stops.iter().find(|stop| stop.event == Some(event)).map(|stop| StretchOf::Gauge(stop.gauge)),
                Root::Slides(contact) if m.contacts[contact].is_one_way() => Some(m.contacts[contact].along),
                _ => None,
            };
            all.extend(along.filter(|along| !all.contains(along)));
        }
        all
    }
}
