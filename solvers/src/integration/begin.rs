//! The begin of a run: a consistent node, its modes, the first step.

use super::Integration;
use crate::engine::{Control, Node, Why};
use crate::{Span, System};

/// What counts as a moment later, as part of the time in which the motion changes by something like its size.
pub(super) const MOMENT: f64 = 1e-7;

impl Integration {
    /// The first node, its modes, the first step.
    pub(super) fn begin(&mut self, system: &mut dyn System) -> Result<(), Why> {
        self.engine.settle(system, &mut self.node)?;
        self.relative.copy_from_slice(&self.node.state.v);
        self.engine.shared(&self.node.state.v, |k, speed| self.relative[k] = speed);
        self.choose_modes(system)?;
        self.cross_timed_at_start(system)?;
        let pattern = system.pattern();
        self.sigma = self.weakest.begin(&mut self.engine, &pattern.metric, &pattern.g_scale);
        self.largest_sigma = self.sigma.min(1.0);
        self.h = self.first_step(system)?;
        self.turn = 0;
        self.scheme.restart(system, &mut self.engine, &self.node, self.h)?;
        if let Some(bridge) = &mut self.bridge {
            // makes room for what it needs
            bridge.restart(system, &mut self.engine, &self.node, self.h)?;
        }
        self.last.copy_from(&self.node);
        Ok(())
    }

    /// Modes of a start: from the state a moment later, since a start on a switch belongs to the side to which it moves.
    fn choose_modes(&mut self, system: &mut dyn System) -> Result<(), Why> {
        if self.engine.dims.modes == 0 {
            return Ok(());
        }
        self.engine.follow_modes(system, &mut self.node.state);
        self.engine.accelerate(system, &mut self.node)?;
        for _ in 0..6 {
            let moment = MOMENT * self.moment();
            self.trial.copy_from(&self.node);
            self.drift(system, moment);
            if !self.engine.follow_modes(system, &mut self.trial.state) {
                break;
            }
            self.node.state.modes.copy_from_slice(&self.trial.state.modes);
            self.engine.accelerate(system, &mut self.node)?;
        }
        Ok(())
    }

    /// Moves the trial node by `h` along its velocities and accelerations.
    pub(super) fn drift(&mut self, system: &dyn System, h: f64) {
        let Node { state, a, zdot, .. } = &mut self.trial;
        state.t += h;
        for ((d, v), a) in self.row.iter_mut().zip(&state.v).zip(&*a) {
            *d = h * (v + 0.5 * h * a);
        }
        system.retract(Span { end: state.t, length: h }, &mut state.q, &self.row);
        state.v.iter_mut().zip(&*a).for_each(|(v, a)| *v += h * a);
        state.z.iter_mut().zip(&*zdot).for_each(|(z, r)| *z += h * r);
    }

    /// A time in which the motion changes by something like its size, s.
    pub(super) fn moment(&self) -> f64 {
        let e = &self.engine;
        let v = self.relative.iter().zip(&e.size_v).fold(0.0, |m, (v, s)| f64::max(m, v.abs() / s));
        let a = self.node.a.iter().zip(&e.size_v).fold(0.0, |m, (a, s)| f64::max(m, a.abs() / s));
        let shortest = v.max(a.sqrt());
        if shortest > 0.0 { shortest.recip().min(1.0) } else { 1.0 }
    }

    /// First step by Hairer, Nørsett & Wanner (Solving ODEs I, 2nd ed., section II.4, "starting step size").
    fn first_step(&mut self, system: &mut dyn System) -> Result<f64, Why> {
        if let Control::Steps(steps) = self.settings.control {
            return Ok(steps[0]);
        }
        let mut h0 = 0.01 * self.moment();
        // in its mode a friction that sticks grows far beyond its law: nearer to the start it still has a solution
        for attempt in 0.. {
            self.trial.copy_from(&self.node);
            self.drift(system, h0);
            match self.engine.accelerate(system, &mut self.trial) {
                Ok(()) => break,
                Err(why) if attempt == 8 => return Err(why),
                Err(_) => h0 *= 0.1,
            }
        }
        let (s, e) = (&self.node.state, &self.engine);
        let first = e.step_norm(s, &self.relative, &self.node.a, &self.node.zdot);
        let difference = |x: &[f64], y: &[f64], out: &mut [f64]| out.iter_mut().zip(x.iter().zip(y)).for_each(|(o, (x, y))| *o = x - y);
        difference(&self.trial.a, &self.node.a, &mut self.row);
        self.trial.state.v.iter_mut().zip(&s.v).for_each(|(x, v)| *x -= v);
        self.trial.zdot.iter_mut().zip(&self.node.zdot).for_each(|(x, r)| *x -= r);
        let second = e.step_norm(s, &self.trial.state.v, &self.row, &self.trial.zdot) / h0;
        let largest = first.max(second);
        let h1 = if largest > 1e-15 { (0.01 / largest).powf(1.0 / (self.scheme.order() as f64 + 1.0)) } else { h0 };
        Ok(h1.min(100.0 * h0))
    }
}
