//! A mechanism as integrators see it: the terms by `dynamics`, and every switch, event and winding as a root.
//!
//! | root | positive | behind it |
//! |---|---|---|
//! | switch of a load, spring, driver, state | inside its mode | the neighbouring mode; the scheme starts afresh |
//! | switch of a coupling | the same | the same, with the velocities behind the corner of its law; a step ends the run |
//! | switch of a column alone | the same | the same mode number, without effect on the motion; given up where it cannot be located |
//! | winding of a cut hinge's angle | within a quarter turn and a half of its centre | the next half turn is counted |
//! | side on which a joint with friction by reactions presses | its force points there | the other side |
//! | rigid stop | before the stop | a blow; a weak one ends in rest on the stop, which ends the phase |
//! | stop just left | beyond its neighbourhood | it is watched exactly again |
//! | stop on which a joint rests | the stop pushes | it is left, which ends the phase |
//! | contact that slides | it slides on | it sticks or turns round, which ends the phase |
//! | contact that sticks | less holds it than may | it slides, which ends the phase |
//! | event of the model | on its present side of zero | the other side; what the event does; an impact is a blow, as of a stop |
//!
//! `modes` hold the switches of all expressions, then the windings, the side of each event, and for each rigid stop whether it was
//! left just now (1): then the motion may go beyond it by as much as rounding asks, until it is clear of it.

mod ahead;
mod blow;
mod contact;
mod corner;
mod decided;
mod direct;
mod evaluate;
mod events;
mod make;
mod power;
mod root;
mod seen;
mod states;
mod sticking;
mod touching;
mod works;

use crate::dynamics::{Differentiable, Dynamics, Linearizer, Point, Reactions};
use crate::geometry::Space;
use crate::mechanism::Leaf;
use crate::studies::common::observe::Observer;
use ahead::Timed;
use decided::Decided;
use direct::Source;
use grashof_solvers::{Ahead, At, Block, Dims, Effect, Friction, Kkt, Pattern, Span, Stage, State, System, Tangent, Terms};
use root::Corners;
pub(crate) use root::{Met, Root, Watched};
use seen::Seen;
pub(super) use works::WORKS;

/// A mechanism with its columns and events.
pub(crate) struct Mechanical<'m, G: Space<S = f64>> {
    pub(crate) dynamics: Dynamics<'m, G>,
    pub(crate) observer: Observer<G>,
    pub(super) reactions: Reactions<G>,
    pub(crate) roots: Vec<Root>,
    /// The mechanism, and its tangents from when they are asked for first.
    mechanism: &'m Differentiable<G>,
    linearizer: Option<Linearizer<'m, G>>,
    dims: Dims,
    pattern: Pattern,
    events: Vec<Watched>,
    /// Roots that depend on time alone.
    timed: Vec<Timed>,
    /// The inputs of the programs of the mechanism, where all roots are decided by the numbers of a state alone.
    direct: Option<Vec<Vec<(usize, Source)>>>,
    /// The inputs of the columns, where the numbers of a state tell them all.
    watched: Option<Vec<(usize, Source)>>,
    /// The own solution, from when it is asked for first.
    kkt: Option<Kkt>,
    /// That where friction depends on reactions, with its terms.
    friction: Option<(Friction, Terms)>,
    /// Size of the mechanism, m.
    pub(super) size: f64,
    /// How near to each rigid stop counts as on it, rad or m.
    near: Vec<f64>,
    /// Stops on which joints have come to rest (true) or which they have left, in the event crossed last.
    rests: Vec<(usize, bool)>,
    /// Events with impacts that were met in the event crossed last, and the one that cannot rest.
    struck: Vec<usize>,
    restless: Option<usize>,
    /// Contacts that stopped or gave way in the event crossed last, and whether a blow must first let go what friction or a stop holds.
    met: Vec<Met>,
    loosened: bool,
    /// What was met at switches of couplings.
    corners: Corners,
    /// Velocities that rows decide wherever the mechanism stands.
    decided: Decided,
    /// The state evaluated last.
    seen: Seen,
    a: Vec<f64>,
    lambda: Vec<f64>,
    /// Modes while energies are asked.
    modes: Vec<i32>,
    inputs: Vec<f64>,
    registers: Vec<f64>,
    /// Roots of one program, and all outputs of the observer.
    scratch: Vec<f64>,
    outputs: Vec<f64>,
}

impl<'m, G> Mechanical<'m, G>
where
    G: Space<S = f64>,
{
    /// What makes exact tangents, itself made when it is asked for first.
    pub(super) fn linearizer(&mut self) -> &mut Linearizer<'m, G> {
        self.linearizer.get_or_insert_with(|| Linearizer::new(self.mechanism))
    }

    /// Whether nothing but windings were crossed, or a chart, whose root stands behind all others.
    pub(super) fn winds_only(&self, crossed: &[usize]) -> bool {
        !crossed.is_empty() && crossed.iter().all(|&root| self.roots.get(root).is_none_or(|root| matches!(root, Root::Winding { .. })))
    }

    /// The gauge whose turns are counted that turns fastest in the state evaluated last, and its rate, rad/s.
    pub(super) fn fastest_turn(&self) -> Option<(usize, f64)> {
        let rate = |root: &Root| {
            if let Root::Winding { gauge, .. } = *root { Some((gauge, self.dynamics.work.readings[gauge].rate.abs())) } else { None }
        };
        self.roots.iter().filter_map(rate).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Modes that the mechanism and its columns know.
    fn own<'a>(&self, modes: &'a [i32]) -> &'a [i32] {
        let m = self.dynamics.mechanism;
        &modes[..m.switches + m.windings]
    }

    /// Gives a switch of a program its neighbouring mode at the state looked at last; the modes before.
    fn take_neighbour(&mut self, program: usize, k: usize, state: &mut State) -> Vec<i32> {
        let before = state.modes.clone();
        let modes = &mut state.modes;
        self.with_program(program, |p, inputs, registers, roots| {
            p.roots(inputs, modes, registers, &mut roots[..p.switches().len()]);
            modes[p.switches()[k] as usize] = p.neighbour(k, modes, registers);
        });
        before
    }

    /// [`System::cross`] for a state beside the surface of a root, where both sides of a law have other values without a jump.
    pub(crate) fn cross_beside(&mut self, root: usize, state: &mut State, row: &mut [f64]) -> Effect {
        match self.roots[root] {
            Root::Force { program, k } if self.is_of_position(program) => {
                self.look(&state.at(), None);
                let before = self.take_neighbour(program, k, state);
                self.turn_corner(&before, state, false)
            }
            _ => self.cross(root, state, row),
        }
    }

    /// Whether a program is that of functions of positions.
    fn is_of_position(&self, program: usize) -> bool {
        let m = self.dynamics.mechanism;
        std::ptr::eq(m.programs()[program], &raw const m.position_program)
    }

    /// Runs a program of the mechanism at the state evaluated last: `run` gets its inputs and registers.
    fn with_program(&mut self, program: usize, run: impl FnOnce(&crate::expression::Program, &[f64], &mut [f64], &mut [f64])) {
        let staged = self.dynamics.mechanism.programs()[program];
        for &(input, leaf) in &staged.fills {
            let held = if let Leaf::Gauge { gauge, order: order @ (0 | 1) } = leaf { self.dynamics.held(gauge, order) } else { None };
            self.inputs[input] = held.unwrap_or_else(|| self.dynamics.leaf(leaf));
        }
        run(&staged.program, &self.inputs, &mut self.registers, &mut self.scratch);
    }
}

impl<G> System for Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    fn dims(&self) -> Dims {
        self.dims
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let there = self.seen.is_in(out.position, &at);
        self.stand(&at, !there);
        if stage >= Stage::Velocity {
            self.velocities(&at);
        }
        if stage >= Stage::Dynamics {
            self.dynamics.forces(at.modes);
            self.seen.loads(&at);
        } else if !there {
            self.dynamics.inertias();
        }
        if !there {
            self.dynamics.mass();
            self.seen.without_rows();
            let w = &mut self.dynamics.work;
            out.phi.copy_from_slice(&w.phi);
            // the same entries are written at every evaluation, the others are zero in both
            out.g.swap_values(&mut w.g);
            out.mass.swap_values(&mut w.mass);
            out.position = self.seen.number();
        }
        let w = &self.dynamics.work;
        if stage >= Stage::Velocity {
            out.nu.copy_from_slice(&w.nu);
            out.gamma.copy_from_slice(&w.gamma);
        }
        if stage >= Stage::Dynamics {
            out.force.copy_from_slice(&w.force);
            if self.dims.z > 0 {
                self.dynamics.rates(at.modes);
                out.zdot.copy_from_slice(&self.dynamics.work.zdot);
            }
        }
    }

    fn residual(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]) {
        self.kinematics(&at);
        self.dynamics.forces(at.modes);
        self.dynamics.mass();
        self.dynamics.residual(a, lambda, r);
    }

    fn reaction_friction(&mut self, at: At<'_>, lambda: &[f64], force: &mut [f64], r_lambda: &mut Block) {
        self.kinematics(&at);
        self.loads(&at);
        self.dynamics.friction(lambda, force, r_lambda);
    }

    fn tangent(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], out: &mut Tangent) {
        let point = Point { t: at.t, q: at.q, v: at.v, z: at.z, a, lambda, modes: at.modes };
        self.linearizer().tangents(&point, out);
        if self.friction.is_some() {
            self.kinematics(&at);
            self.loads(&at);
            self.dynamics.friction_slope(lambda, &mut out.r_lambda);
        }
    }

    fn rate(&self, _: f64, q: &[f64], v: &[f64], qdot: &mut [f64]) {
        self.dynamics.mechanism.rate(q, v, qdot);
    }

    fn retract(&self, _: Span, q: &mut [f64], delta: &[f64]) {
        self.dynamics.mechanism.retract(q, delta);
    }

    fn displace(&self, _: Span, q: &mut [f64], u: &[f64]) {
        self.dynamics.mechanism.displace(q, u);
    }

    fn power(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], w: &mut [f64]) {
        self.powers(&at, lambda, w);
    }

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        modes.copy_from_slice(at.modes);
        let m = self.dynamics.mechanism;
        // what sticks and slides is decided at events alone
        let senses: Vec<i32> = m.contacts.iter().map(|c| at.modes[c.mode]).collect();
        // a function of positions may switch and feed the others: twice settles what depends on it
        for _ in 0..2 {
            let own: &[i32] = modes;
            self.kinematics(&At { modes: own, ..at });
            for program in 0..m.programs().len() {
                self.with_program(program, |p, inputs, registers, _| p.set_modes(inputs, registers, modes));
                m.slide(&senses, modes);
            }
        }
        self.press(&at, modes);
        self.look(&At { modes, ..at }, None);
        self.observer.set_modes(modes);
        m.slide(&senses, modes);
        self.observer.columns(modes, &mut self.outputs);
        self.sides_of_events(modes);
        for root in &self.roots {
            if let Root::Winding { gauge, winding } = *root {
                let half = off_centre(self.dynamics.work.readings[gauge].x, m.gauges[gauge].shift, modes[m.switches + winding]);
                modes[m.switches + winding] += (half / std::f64::consts::PI).round() as i32;
            }
        }
    }

    fn longest(&mut self, at: At<'_>) -> f64 {
        if self.dynamics.mechanism.windings == 0 {
            return f64::INFINITY;
        }
        self.kinematics(&at);
        FOLLOWED / self.fastest_turn().map_or(0.0, |(_, rate)| rate)
    }

    fn roots(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], g: &mut [f64]) {
        if self.direct.is_some() {
            return self.direct_roots(&at, g);
        }
        self.look(&at, Some((a, lambda)));
        let m = self.dynamics.mechanism;
        // whose roots are in the scratch: the programs of the mechanism by number, then that of the columns
        let of_columns = m.programs().len();
        let mut filled = usize::MAX;
        let rests = !self.events.is_empty() && self.rests(at.v);
        if !self.events.is_empty() {
            self.observer.columns(at.modes, &mut self.outputs);
        }
        for (i, g) in g.iter_mut().enumerate() {
            *g = match self.roots[i] {
                Root::Force { program, k } => {
                    if filled != program {
                        self.with_program(program, |p, inputs, registers, roots| {
                            p.roots(inputs, at.modes, registers, &mut roots[..p.switches().len()]);
                        });
                        filled = program;
                    }
                    self.scratch[k]
                }
                Root::Column { k } => {
                    if filled != of_columns {
                        let count = self.observer.program().switches().len();
                        self.observer.roots(at.modes, &mut self.scratch[..count]);
                        filled = of_columns;
                    }
                    self.scratch[k]
                }
                Root::Winding { gauge, winding } => {
                    let off = off_centre(self.dynamics.work.readings[gauge].x, m.gauges[gauge].shift, at.modes[m.switches + winding]);
                    // smooth at the middle, the distance near both ends
                    let end = COUNTED;
                    (end * end - off * off) / (2.0 * end)
                }
                Root::Side { .. } | Root::Stop(_) | Root::Clear(_) | Root::Rest { .. } => self.touch(self.roots[i], &at, a, lambda),
                Root::Slides(_) | Root::Holds { .. } => self.grip(self.roots[i], &at, a, lambda),
                Root::Event(event) => match self.way(event, self.outputs[self.events[event].output], at.modes) {
                    way if way <= 0.0 && rests && !self.pattern.timed.contains(&i) => f64::MIN_POSITIVE,
                    way => way,
                },
            };
        }
    }

    fn ahead(&mut self, at: At<'_>, to: f64, roots: &[usize]) -> Ahead {
        ahead::first(&mut self.timed, at, to, roots)
    }

    fn cross(&mut self, root: usize, state: &mut State, row: &mut [f64]) -> Effect {
        let m = self.dynamics.mechanism;
        self.look(&state.at(), None);
        match self.roots[root] {
            Root::Force { program, k } => {
                let before = self.take_neighbour(program, k, state);
                let effect = if self.is_of_position(program) { self.turn_corner(&before, state, true) } else { Effect::Restart };
                if effect == Effect::Restart && self.turns_back(state) { Effect::Stop } else { effect }
            }
            Root::Column { k } => {
                let count = self.observer.program().switches().len();
                self.observer.roots(&state.modes, &mut self.scratch[..count]);
                let switch = self.observer.program().switches()[k] as usize;
                state.modes[switch] = self.observer.neighbour(k, &state.modes);
                Effect::Record
            }
            Root::Winding { gauge, winding } => {
                let mode = &mut state.modes[m.switches + winding];
                *mode += if off_centre(self.dynamics.work.readings[gauge].x, m.gauges[gauge].shift, *mode) > 0.0 { 1 } else { -1 };
                Effect::Record
            }
            root @ (Root::Side { .. } | Root::Stop(_) | Root::Clear(_) | Root::Rest { .. }) => self.part(root, state, row),
            Root::Slides(contact) => self.meet(contact, 0, state, row),
            Root::Holds { contact, sense, .. } => self.meet(contact, sense, state, row),
            Root::Event(event) => self.cross_event(event, state, row),
        }
    }

    fn beyond(&self) -> bool {
        self.dynamics.work.beyond
    }

    fn equal(&mut self, root: usize, state: &mut State) -> Option<Effect> {
        self.look(&state.at(), None);
        let (switch, mode, effect) = match self.roots[root] {
            Root::Force { program, k } => {
                let mut mode = None;
                self.with_program(program, |p, inputs, registers, roots| {
                    p.roots(inputs, &state.modes, registers, &mut roots[..p.switches().len()]);
                    mode = p.of_equals(k, registers);
                });
                (self.dynamics.mechanism.programs()[program].program.switches()[k] as usize, mode, Effect::Restart)
            }
            Root::Column { k } => {
                let count = self.observer.program().switches().len();
                self.observer.roots(&state.modes, &mut self.scratch[..count]);
                (self.observer.program().switches()[k] as usize, self.observer.of_equals(k), Effect::Record)
            }
            _ => return None,
        };
        // what sticks and slides is decided at events of its own
        let changed = mode.filter(|mode| *mode != state.modes[switch] && !self.dynamics.mechanism.is_of_contact(switch))?;
        state.modes[switch] = changed;
        Some(effect)
    }
}

/// Angle from the centre of the half turn that is counted at which the next one is counted, rad: a little beyond the middle between them.
const COUNTED: f64 = 0.55 * std::f64::consts::PI;
/// Angle that a step may add, rad: with a fifth more the value stays smooth, which it is up to π.
const FOLLOWED: f64 = 0.36 * std::f64::consts::PI;

/// Angle from the centre of the half turn that is counted, rad.
fn off_centre(x: f64, shift: f64, half: i32) -> f64 {
    x - shift - std::f64::consts::PI * f64::from(half)
}
