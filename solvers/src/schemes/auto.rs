//! Explicit or implicit, as the motion asks: DOP853 first, Radau IIA where steps are bound by stability.
//!
//! Switches that follow each other within explicit steps are a sign of stiffness as well (`chatter`).
//!
//! All decisions are made from counted work, never from a clock, so that a run gives the same bits on every machine. A change to
//! the implicit scheme is a trial: if a second of motion then costs more than before, the explicit one comes back, and the next
//! trial waits twice as long. The implicit scheme is left as well when steps within the stability of the explicit one would cost
//! less, and for a while near a singular position, which only explicit steps cross.

use super::dop853::{BORDER, Dop853};
use super::radau5::Radau5;
use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Engine, Node, Rejected, Why};
use crate::scheme::Scheme;
use crate::settings::Settings;
use chatter::Chatter;
use ledger::{Ledger, Verdict};
use singular::Singular;
use spectrum::Spectrum;

mod chatter;
mod ledger;
mod singular;
mod spectrum;

/// Part of the border of stability that a step is thought to reach.
const REACHED: f64 = 0.8;

/// Both schemes, and what decides between them.
pub(super) struct Auto {
    explicit: Dop853,
    implicit: Radau5,
    /// Whether the implicit scheme steps.
    on: bool,
    /// Whether the other scheme is to take the next step.
    change: bool,
    ledger: Ledger,
    spectrum: Spectrum,
    singular: Singular,
    chatter: Chatter,
    failures: usize,
}

impl Auto {
    /// Room for a system.
    pub(super) fn new(settings: Settings, system: &dyn System) -> Self {
        Self {
            explicit: Dop853::new(settings, system),
            implicit: Radau5::new(settings, system),
            on: false,
            change: false,
            ledger: Ledger::default(),
            spectrum: Spectrum::new(system),
            singular: Singular::new(system.dims()),
            chatter: Chatter::default(),
            failures: 0,
        }
    }

    fn active(&mut self) -> &mut dyn Scheme {
        if self.on { &mut self.implicit } else { &mut self.explicit }
    }

    /// Lets the other scheme begin at a node.
    fn hand_over(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> Result<(), Why> {
        (self.on, self.change, self.failures) = (!self.on, false, 0);
        self.active().restart(system, engine, node, h)?;
        self.ledger.begin(engine, node.state.t);
        Ok(())
    }

    /// A step within the stability of the explicit scheme, as far as it is known, s.
    fn stable(&self, h: f64) -> f64 {
        if self.spectrum.radius > 0.0 { h.min(REACHED * BORDER / self.spectrum.radius) } else { h }
    }

    /// An implicit step, complete, and not in a singular position.
    fn implicit_step(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        let complete = self.implicit.completes();
        let tried = self.implicit.attempt(system, engine, from, h, to).and_then(|()| {
            let completed = if complete { Ok(()) } else { engine.accelerate(system, to) };
            completed.map_err(|why| Rejected { why, retry: 0.25 * h })
        });
        let leave = match &tried {
            Ok(()) => self.singular.entered(engine),
            Err(Rejected { why: Why::Error(_), .. }) => false,
            Err(_) => {
                self.failures += 1;
                self.singular.near() || self.failures >= 3
            }
        };
        if leave && !engine.is_fixed() {
            self.singular.hold();
            self.change = true;
            return Err(Rejected { why: Why::Singular, retry: self.stable(0.9 * h) });
        }
        tried
    }

    /// Whether stability bounds the explicit steps, as the last one shows.
    fn bound(&self) -> bool {
        self.explicit.product() > 0.5 * BORDER
    }

    /// What follows from the explicit steps so far.
    fn judge_explicit(&mut self, engine: &mut Engine) {
        let held = self.singular.holds(engine);
        let tired = self.ledger.explicit_step(self.bound());
        if !held && (self.explicit.stiff() || tired) {
            self.spectrum.radius = self.explicit.fastest();
            self.change = true;
        }
    }
}

impl Scheme for Auto {
    fn restart(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> Result<(), Why> {
        self.singular.begin(engine);
        self.change = false;
        if engine.is_fixed() {
            self.on = h * self.spectrum.search(system, engine, node)? > BORDER;
        } else if !self.on && self.chatter.restarts(self.bound()) && !self.singular.holds(engine) {
            self.spectrum.radius = self.explicit.fastest();
            self.change = true;
        }
        self.ledger.begin(engine, node.state.t);
        self.active().restart(system, engine, node, h)
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        let fails = |why| Rejected { why, retry: 0.25 * h };
        if self.change {
            self.hand_over(system, engine, from, h).map_err(fails)?;
        }
        if !self.on {
            return self.explicit.attempt(system, engine, from, h, to);
        }
        if self.ledger.asks() {
            // where a difference reaches to forces without a value the radius stays what it was
            let _ = self.spectrum.improve(system, engine, from);
        }
        self.implicit_step(system, engine, from, h, to)
    }

    fn completes(&self) -> bool {
        true
    }

    fn accept(&mut self, engine: &mut Engine, from: &Node, to: &Node) -> f64 {
        let h = to.state.t - from.state.t;
        let next = self.active().accept(engine, from, to);
        self.failures = 0;
        if engine.is_fixed() {
            return next;
        }
        if !self.on {
            self.ledger.note(engine, to.state.t);
            self.judge_explicit(engine);
            return next;
        }
        let affordable = self.stable(2.0 * h);
        if self.ledger.implicit_step(engine, to.state.t, affordable) == Verdict::Leave {
            self.change = true;
            return self.stable(next);
        }
        next
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        self.active().dense(system, engine, from, to, out)
    }

    fn work(&self, step: f64, out: &mut [f64]) -> Option<[f64; 2]> {
        if self.on { self.implicit.work(step, out) } else { self.explicit.work(step, out) }
    }

    fn regular_until(&mut self, t: f64) {
        self.explicit.regular_until(t);
    }

    fn order(&self) -> usize {
        if self.on { self.implicit.order() } else { self.explicit.order() }
    }

    fn name(&self) -> &'static str {
        if self.on { self.implicit.name() } else { self.explicit.name() }
    }
}
