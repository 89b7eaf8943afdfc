//! The loop that drives a scheme: try, accept or reject, locate events, bridge singular positions.
//!
//! A root that leaves its positive side is located on the continuous solution, the state there is projected on the
//! constraints, and the scheme starts afresh behind it, so that no step has a kink or jump inside. Both sides of an event are
//! kept for the caller.

use crate::dense_output::Dense;
use crate::engine::blows::Blow;
use crate::engine::{Control, Engine, Node, Why};
use crate::halt::Halt;
use crate::method::Method;
use crate::scheme::Scheme;
use crate::schemes;
use crate::settings::Settings;
use crate::{Sigma, State, System};
use foresight::Foresight;
use resolve::{NODES, Resolver};
pub use zeno::Zeno;

mod attempt;
mod begin;
mod blow;
mod bridge;
mod events;
mod foresee;
mod foresight;
mod land;
mod nested;
mod observed;
mod repeat;
mod resolve;
mod work;
mod zeno;

/// What an advance has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// One more step; the end is not reached.
    Step,
    /// A step that ends at an event; see [`Integration::before`] and [`Integration::crossed`].
    Event,
    /// A step that ends at an event which stops the run.
    Stopped,
    /// A step that ends where it was asked to.
    End,
}

/// Of the rules over a part of a step for work.
const WORK_NODES: usize = 5;

/// Times of bridges that are remembered.
pub const REMEMBERED: usize = 64;

/// Times between events that are remembered.
const GAPS: usize = 4;

/// A step is at most so many times as long as the width to which roots had to be resolved.
const PARTS: f64 = 400.0;

/// A step is at most so many times as long as the longest of the last times between events: a force that is constant between its
/// switches would let it grow without end, and its events are located to a part of it.
const GROWTH: f64 = 1e4;

/// A run in progress: the last step, and all that is needed for the next. Advancing allocates nothing.
pub struct Integration {
    /// Tools and counters.
    pub engine: Engine,
    settings: Settings,
    scheme: Box<dyn Scheme>,
    /// Crosses singular positions, for implicit schemes.
    bridge: Option<Box<dyn Scheme>>,
    /// Time that must be passed and σ that must be reached before the bridge ends.
    bridging: Option<(f64, f64)>,
    bridged: Vec<f64>,
    schemes: Vec<&'static str>,
    sigma: f64,
    /// Largest σ so far: how far from singular this mechanism can be.
    largest_sigma: f64,
    weakest: Sigma,
    /// What was proposed before a step was made again to end behind an early event: the step and the width of `resolved`, s.
    repeated: Option<(f64, Option<f64>)>,
    last: Node,
    node: Node,
    trial: Node,
    before: Node,
    /// The end of a step of which only a part is told yet, and whether it is the end asked for.
    ahead: Node,
    pending: Option<bool>,
    dense: Dense,
    dense_ready: bool,
    /// Length of the last step, of which a part may be told, s.
    length: f64,
    h: f64,
    /// Number of given steps since `origin`.
    turn: usize,
    /// Where given steps began to be counted: the start, or the last event.
    origin: f64,
    start: f64,
    /// Roots that are looked for on the continuous solution.
    looked: Vec<usize>,
    /// Those of them that need not be smooth.
    rough: Vec<usize>,
    /// Roots at the begin of the part of a step in which one was crossed.
    roots: Vec<f64>,
    /// Roots just before what happens at an event.
    instant: Vec<f64>,
    /// Roots at the node before one was crossed, and those that have jumped below zero with the modes since.
    near_side: Vec<f64>,
    jumped: Vec<usize>,
    /// Whether the first step is not looked at yet.
    begins: bool,
    /// Roots at the nodes of a part of a step, and beside them.
    samples: Vec<Vec<f64>>,
    probe: Vec<f64>,
    resolver: Resolver,
    /// Width to which roots had to be resolved last, s; none if a whole step was narrow enough.
    resolved: Option<f64>,
    /// Widest gap between looks at roots, s.
    widest: f64,
    /// For each root the steps for which it is still taken for noise.
    noisy: Vec<usize>,
    unresolved: Option<(usize, f64)>,
    foresight: Foresight,
    /// Times between the last events that changed the motion, s, and the time of the last one, s.
    gaps: [f64; GAPS],
    changed: f64,
    /// Where the present step is asked to end, s.
    goal: f64,
    crossed: Vec<usize>,
    /// Blows of the event at hand.
    blows: Vec<Blow>,
    row: Vec<f64>,
    /// Velocities at the start without those in common (nv).
    relative: Vec<f64>,
    power: Vec<f64>,
    /// Halvings of steps for their work so far.
    halvings: usize,
    work: Vec<f64>,
    zeno: Zeno,
    /// For each root that is only read one more than its crossings, else 0; the last of their events; those that are given up.
    observing: Vec<usize>,
    observed: Zeno,
    given_up: Vec<usize>,
    /// Why there is no motion beyond the node.
    halted: Option<Why>,
    /// The last number that was not finite, or friction without a solution, and when.
    spoiled: Option<(Why, f64)>,
}

impl Integration {
    /// A run of `system` from `start`, which need not be consistent: it is projected, and its modes are taken from the values a
    /// moment later. Roots are looked for while `locate` is set.
    ///
    /// # Errors
    /// If the start cannot be made consistent.
    pub fn new(system: &mut dyn System, settings: Settings, start: &State) -> Result<Self, Halt> {
        let scheme = schemes::new(settings.method, settings, system);
        Self::with_scheme(system, scheme, settings, start)
    }

    /// [`Integration::new`] by a scheme of one's own; `method` of the settings is not looked at.
    ///
    /// # Errors
    /// As there.
    pub fn with_scheme(system: &mut dyn System, scheme: Box<dyn Scheme>, settings: Settings, start: &State) -> Result<Self, Halt> {
        let dims = system.dims();
        let engine = Engine::new(system, settings.control);
        let implicit = scheme.is_implicit() && dims.holonomic > 0;
        let bridge = (implicit && !engine.is_fixed()).then(|| schemes::new(Method::Dop853, settings, system));
        let node = Node { state: start.clone(), ..Node::new(dims) };
        let timed = |root: &usize| system.pattern().timed.contains(root);
        let located = |root: &usize| settings.locate || system.pattern().acting.contains(root);
        let (timed, looked): (Vec<usize>, Vec<usize>) = (0..dims.roots).filter(located).partition(timed);
        let mut run = Self {
            scheme,
            bridge,
            bridging: None,
            bridged: Vec::with_capacity(REMEMBERED),
            schemes: Vec::with_capacity(8),
            sigma: 1.0,
            largest_sigma: 1.0,
            weakest: Sigma::new(dims.rows()),
            engine,
            settings,
            last: node.clone(),
            trial: node.clone(),
            before: node.clone(),
            ahead: node.clone(),
            pending: None,
            node,
            dense: Dense::new(dims),
            dense_ready: false,
            length: 0.0,
            h: 0.0,
            turn: 0,
            origin: start.t,
            start: start.t,
            looked,
            rough: system.pattern().rough.clone(),
            roots: vec![0.0; dims.roots],
            instant: vec![0.0; dims.roots],
            near_side: vec![0.0; dims.roots],
            jumped: Vec::with_capacity(dims.roots),
            begins: true,
            samples: vec![vec![0.0; dims.roots]; NODES + 1],
            probe: vec![0.0; dims.roots],
            resolver: Resolver::new(),
            resolved: None,
            widest: 0.0,
            noisy: vec![0; dims.roots],
            unresolved: None,
            foresight: Foresight::new(timed, dims.modes),
            gaps: [0.0; GAPS],
            changed: start.t,
            goal: start.t,
            crossed: Vec::with_capacity(dims.roots),
            blows: Vec::new(),
            row: vec![0.0; dims.v],
            relative: vec![0.0; dims.v],
            power: vec![0.0; WORK_NODES * dims.work],
            repeated: None,
            halvings: 0,
            work: vec![0.0; dims.work],
            zeno: Zeno::default(),
            observing: (0..dims.roots).map(|root| usize::from(system.pattern().observing.contains(&root))).collect(),
            observed: Zeno::default(),
            given_up: Vec::with_capacity(dims.roots),
            halted: None,
            spoiled: None,
        };
        run.begin(system).map_err(|why| Halt { why, t: start.t, h: 0.0 })?;
        Ok(run)
    }

    /// The state reached, with its accelerations and multipliers; behind an event, the side after it.
    pub fn node(&self) -> &Node {
        &self.node
    }

    /// The begin of the last step.
    pub fn last(&self) -> &Node {
        &self.last
    }

    /// The state before the event at which the last step ended.
    pub fn before(&self) -> &Node {
        &self.before
    }

    /// The state behind the last event, if that is where the run cannot go on.
    pub fn beyond(&self) -> Option<&State> {
        self.halted.is_some().then_some(&self.ahead.state)
    }

    /// Roots that were crossed at the event at which the last step ended.
    pub fn crossed(&self) -> &[usize] {
        &self.crossed
    }

    /// Tells that there is no singular position until `t` (s), whatever is seen of rows that come near one.
    pub fn regular_until(&mut self, t: f64) {
        self.scheme.regular_until(t);
    }

    /// The step proposed next, s.
    pub fn proposed(&self) -> f64 {
        self.h
    }

    /// Widest gap between looks at root functions so far, s: one that is negative for a shorter time may be missed, but for those of
    /// time alone, which are bounded.
    pub fn widest_gap(&self) -> f64 {
        self.widest
    }

    /// The first root that could not be resolved, and when (s): its signs were taken as they were seen.
    pub fn unresolved(&self) -> Option<(usize, f64)> {
        self.unresolved
    }

    /// Times at which singular positions were bridged, s; the first [`REMEMBERED`] of them.
    pub fn bridged(&self) -> &[f64] {
        &self.bridged
    }

    /// Names of the schemes that have stepped, in the order of their first step.
    pub fn schemes(&self) -> &[&'static str] {
        &self.schemes
    }

    /// The scheme at work.
    pub fn scheme_name(&self) -> &'static str {
        self.bridging.map_or_else(|| self.scheme.name(), |_| "bridge")
    }

    /// The continuous solution over the last step (up to the event at which it ended).
    ///
    /// # Errors
    /// If the system cannot be evaluated inside of the step.
    pub fn dense(&mut self, system: &mut dyn System) -> Result<&Dense, Halt> {
        self.interpolate(system).map_err(|why| Halt { why, t: self.last.state.t, h: self.h })?;
        Ok(&self.dense)
    }

    fn interpolate(&mut self, system: &mut dyn System) -> Result<(), Why> {
        if !self.dense_ready {
            let scheme = active(&mut self.scheme, &mut self.bridge, self.bridging.is_some());
            scheme.dense(system, &mut self.engine, &self.last, &self.node, &mut self.dense)?;
            self.dense_ready = true;
        }
        Ok(())
    }

    /// The motion at time `t` (s) inside of the last step: projected on the constraints, with accelerations and multipliers.
    ///
    /// # Errors
    /// If the system cannot be evaluated there.
    pub fn at(&mut self, system: &mut dyn System, t: f64, out: &mut Node) -> Result<(), Halt> {
        self.dense(system)?;
        out.state.modes.copy_from_slice(&self.last.state.modes);
        out.state.live.copy_from_slice(&self.last.state.live);
        self.dense.evaluate(t, &mut out.state);
        if !self.settings.locate {
            self.engine.follow_modes(system, &mut out.state);
        }
        self.engine.settle(system, out).map_err(|why| Halt { why, t, h: self.h })
    }

    /// One step towards `until` (s), which is not passed.
    ///
    /// # Errors
    /// If the run cannot go on; the node is the last good one.
    pub fn advance(&mut self, system: &mut dyn System, until: f64) -> Result<Progress, Halt> {
        let t = self.node.state.t;
        self.step(system, until).map_err(|why| Halt { why, t, h: self.h })
    }

    fn step(&mut self, system: &mut dyn System, until: f64) -> Result<Progress, Why> {
        self.goal = until;
        if self.engine.counts.steps >= self.settings.most_steps {
            return Err(Why::TooManySteps);
        }
        if let Some(why) = self.halted {
            return Err(why);
        }
        let left = until - self.node.state.t;
        // an event may lie so near to the end that no step is left
        if left <= 4.0 * f64::EPSILON * until.abs() {
            return Ok(Progress::End);
        }
        if let Some(ends) = self.pending.take() {
            return self.rest(system, ends);
        }
        let ends = self.attempt(system, until, left)?;
        self.dense_ready = false;
        self.engine.counts.steps += 1;
        let name = self.scheme_name();
        if !self.schemes.contains(&name) {
            self.schemes.push(name);
        }
        std::mem::swap(&mut self.last, &mut self.node);
        std::mem::swap(&mut self.node, &mut self.trial);
        if let Control::Steps([h, other]) = self.settings.control
            && h == other
            && !self.scheme.chooses_steps()
        {
            // multiples of the step, without the sum of its rounding; a step cut short begins a new count
            let multiple = self.origin + self.turn as f64 * h;
            self.node.state.t = multiple;
            if ends && (until - multiple).abs() > 1e-6 * h {
                (self.turn, self.origin) = (0, until);
            }
        }
        if ends {
            self.node.state.t = until;
        }
        self.length = self.node.state.t - self.last.state.t;
        self.end_bridge(system)?;
        self.finish(system, ends)
    }

    /// Looks for roots within the last step, and ends it at the first or where it ends.
    fn finish(&mut self, system: &mut dyn System, ends: bool) -> Result<Progress, Why> {
        match self.crossing(system)? {
            Some((theta, root)) => match self.part_to_repeat(system, theta, root)? {
                Some(part) => self.repeat(system, part),
                None => self.event(system, theta, root, ends),
            },
            None => {
                self.repeated = None;
                if !self.settings.locate {
                    self.march_across(system)?;
                }
                self.follow_given_up(system);
                self.balance(system, false)?;
                Ok(if ends { Progress::End } else { Progress::Step })
            }
        }
    }

    /// The rest of a step in which something was recorded that left the motion as it was.
    fn rest(&mut self, system: &mut dyn System, ends: bool) -> Result<Progress, Why> {
        std::mem::swap(&mut self.last, &mut self.node);
        self.node.copy_from(&self.ahead);
        self.node.state.modes.copy_from_slice(&self.last.state.modes);
        self.node.state.live.copy_from_slice(&self.last.state.live);
        self.finish(system, ends)
    }
}

/// The scheme that steps.
fn active<'a>(scheme: &'a mut Box<dyn Scheme>, bridge: &'a mut Option<Box<dyn Scheme>>, bridging: bool) -> &'a mut dyn Scheme {
    match bridge {
        Some(bridge) if bridging => bridge.as_mut(),
        _ => scheme.as_mut(),
    }
}
