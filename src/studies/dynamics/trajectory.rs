//! A motion in time as a curve: the continuous solution of every step, evaluated anywhere.

mod at;

use super::system::Mechanical;
use crate::geometry::Space;
use crate::kinematics::undefined::Gap;
use crate::numerics::continuous::Curve;
use crate::numerics::resolve::{FIRST_PANELS, Resolved};
use crate::studies::common::grain::{Grain, PLACES, ROUND_OFF};
use grashof_solvers::dense_output::Form;
use grashof_solvers::{Control, Dense, Engine, Node, Sigma, Stage, System};

/// Below this smallest singular value of the scaled rows a position is next to singular: errors of the state are multiplied by its
/// inverse in velocities, by the square of that in reactions.
const SINGULAR: f64 = 1e-2;

/// Steps to a first stretch where columns are resolved.
const STEPS_TO_A_STRETCH: usize = 16;

/// One step: polynomials in θ = (t − begin)/h on [begin, end], end ≤ begin + h.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Begin of the polynomials, and where the motion leaves them, s.
    begin: f64,
    end: f64,
    h: f64,
    /// First coefficient, number of coefficients, and what they stand for.
    first: usize,
    count: usize,
    form: Form,
    /// Whether a step of the integrator ends here, not a part of one.
    whole: bool,
    /// Number of its modes.
    modes: usize,
    /// Whether all of it is as near to the constraints as columns need it, once that was asked for.
    near: Option<bool>,
}

/// A stretch of the motion without switches: its parameters. Windings may change on it.
#[derive(Clone, Debug)]
struct Piece {
    phase: usize,
    /// Where contacts are held.
    live: Vec<f64>,
    /// First step and the one behind the last.
    steps: (usize, usize),
    from: f64,
    to: f64,
}

/// A mechanism at the parameters that hold from one change of them to the next, to evaluate states with.
pub(crate) struct PhaseSystem<'m, G: Space<S = f64>> {
    key: usize,
    pub(crate) system: Mechanical<'m, G>,
    pub(crate) engine: Engine,
}

/// A state of the trajectory could not be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Off {
    /// Time, s.
    pub(crate) at: f64,
    /// What has no value there, if that is why.
    pub(crate) gap: Option<Gap>,
}

/// A motion in time.
pub(crate) struct Trajectory<'m, G: Space<S = f64>> {
    pub(crate) phases: Vec<PhaseSystem<'m, G>>,
    /// State, accelerations and multipliers evaluated last.
    pub(crate) node: Node,
    steps: Vec<Step>,
    pieces: Vec<Piece>,
    /// Modes of steps: one list for each piece, and one more for each winding.
    modes: Vec<Vec<i32>>,
    coefficients: Vec<f64>,
    dense: Dense,
    columns: usize,
    out: Vec<f64>,
    /// Whether modes are taken from each state: the integrator has marched across switches.
    follow: bool,
    /// Switches of columns that the integrator has given up, which follow their values, each with the first step in which they do.
    loose: Vec<(usize, usize)>,
    followed: Vec<i32>,
    /// How far a state may be off the constraints where columns are followed between rows, as part of its size.
    pub(crate) near_enough: f64,
    /// Below what each column is zero but for round-off.
    pub(super) floors: Vec<f64>,
    /// Whether an event has ended the motion.
    pub(super) ended_by_event: bool,
    /// The step found last.
    near: usize,
    /// The present phase.
    current: usize,
}

impl<'m, G> Trajectory<'m, G>
where
    G: Space<S = f64>,
{
    /// An empty one of `columns` columns, to be filled from a phase on.
    pub(crate) fn new(first: &Mechanical<'m, G>, columns: usize, follow: bool) -> Self {
        let dims = first.dims();
        let outputs = first.observer.program().outputs();
        Self {
            phases: Vec::new(),
            node: Node::new(dims),
            steps: Vec::new(),
            pieces: Vec::new(),
            modes: Vec::new(),
            coefficients: Vec::new(),
            dense: Dense::new(dims),
            columns,
            out: vec![0.0; outputs],
            follow,
            loose: Vec::new(),
            followed: vec![0; dims.modes],
            near_enough: 0.0,
            floors: Vec::new(),
            ended_by_event: false,
            near: 0,
            current: 0,
        }
    }

    /// Begins a phase of a mechanism by its key, which `make` makes if it is new.
    pub(crate) fn phase(&mut self, key: usize, make: impl FnOnce() -> Mechanical<'m, G>) {
        self.current = self.phases.iter().position(|phase| phase.key == key).unwrap_or_else(|| {
            let system = make();
            let engine = Engine::new(&system, Control::Tolerance(1e-8));
            self.phases.push(PhaseSystem { key, system, engine });
            self.phases.len() - 1
        });
    }

    /// Begins a piece at a node.
    pub(crate) fn piece(&mut self, node: &Node) {
        let (t, n) = (node.state.t, self.steps.len());
        self.modes.push(node.state.modes[..self.node.state.modes.len()].to_vec());
        // an event at the begin of a piece leaves nothing of it
        if self.pieces.last().is_some_and(|p| p.from >= t) {
            self.pieces.pop();
        }
        let live = node.state.live.clone();
        self.pieces.push(Piece { phase: self.current, live, steps: (n, n), from: t, to: t });
    }

    /// Goes on in the present piece behind a node where only the count of an angle's turns changes, which is no switch: the step that
    /// ends there is a part of one.
    pub(crate) fn wind(&mut self, node: &Node) {
        self.modes.push(node.state.modes[..self.node.state.modes.len()].to_vec());
        if let Some(step) = self.steps.last_mut() {
            step.whole = false;
        }
    }

    /// Lets a switch of columns follow its values from the next step on.
    pub(crate) fn loosen(&mut self, switch: usize) {
        if self.loose.iter().all(|(_, known)| *known != switch) {
            self.loose.push((self.steps.len(), switch));
        }
    }

    /// Adds a step of the present piece, or a part of one, which ends at `end` (s).
    pub(crate) fn step(&mut self, dense: &Dense, end: f64, whole: bool) {
        let first = self.coefficients.len();
        let (coefficients, form) = (dense.coefficients(), dense.form);
        self.coefficients.extend_from_slice(coefficients);
        self.steps.push(Step {
            begin: dense.t,
            end,
            h: dense.h,
            first,
            count: coefficients.len(),
            form,
            whole,
            modes: self.modes.len() - 1,
            near: None,
        });
        if let Some(piece) = self.pieces.last_mut() {
            (piece.to, piece.steps.1) = (end, self.steps.len());
        }
    }

    /// Whether no time has passed.
    pub(crate) fn is_empty(&self) -> bool {
        self.steps.iter().all(|s| s.end <= s.begin)
    }

    /// Forgets a last piece in which no step was made.
    pub(crate) fn finish(&mut self) {
        if self.pieces.len() > 1 && self.pieces.last().is_some_and(|p| p.steps.0 == p.steps.1) {
            self.pieces.pop();
        }
    }

    /// Lets the motion end where all is defined last before a time where something is not; what is undefined just behind it, or
    /// nothing if that is so from the start on.
    pub(crate) fn end_before(&mut self, t: f64) -> Option<Off> {
        let from = self.pieces.first()?.from;
        let mut out = vec![0.0; self.columns];
        let mut defined = |trajectory: &mut Self, t: f64| {
            let piece = trajectory.pieces.iter().position(|p| t <= p.to).unwrap_or(0);
            trajectory.columns_at(t, piece, 0.0, &mut out)
        };
        let (mut good, mut bad) = (from, t);
        defined(self, good).ok()?;
        let mut off = Off { at: t, gap: None };
        for _ in 0..60 {
            let middle = 0.5 * (good + bad);
            match defined(self, middle) {
                Ok(()) => good = middle,
                Err(why) => (bad, off) = (middle, why),
            }
        }
        self.end_at(good).then_some(off)
    }

    /// Lets the motion end at a time; whether anything of it is left.
    pub(crate) fn end_at(&mut self, good: f64) -> bool {
        let Some(from) = self.pieces.first().map(|p| p.from) else { return false };
        let last = self.pieces.iter().position(|p| good <= p.to).unwrap_or(0);
        self.pieces.truncate(last + 1);
        let piece = &mut self.pieces[last];
        let (low, high) = piece.steps;
        let step = (low + self.steps[low..high].partition_point(|s| s.end < good)).min(high.saturating_sub(1));
        (piece.to, piece.steps.1) = (good, step + 1);
        self.steps.truncate(step + 1);
        if let Some(step) = self.steps.last_mut() {
            (step.end, step.whole) = (good, true);
        }
        good > from
    }

    /// Bytes in use by steps.
    pub(crate) fn size(&self) -> usize {
        std::mem::size_of_val(&self.coefficients[..]) + std::mem::size_of_val(&self.steps[..])
    }

    /// Times of the begin, of every switch, and of the end.
    pub(crate) fn breaks(&self) -> Vec<f64> {
        let first = self.pieces.first().map_or(0.0, |p| p.from);
        std::iter::once(first).chain(self.pieces.iter().map(|p| p.to)).collect()
    }

    /// Number of pieces.
    pub(crate) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Times of the begin and the end of a piece.
    pub(crate) fn ends(&self, piece: usize) -> [f64; 2] {
        [self.pieces[piece].from, self.pieces[piece].to]
    }

    /// Number of steps of a piece and of parts of them.
    pub(crate) fn steps_of(&self, piece: usize) -> usize {
        let (low, high) = self.pieces[piece].steps;
        high - low
    }

    /// The time at which a step of a piece ends; none for a part of a step that goes on.
    pub(crate) fn end_of_step(&self, piece: usize, step: usize) -> Option<f64> {
        let step = &self.steps[self.pieces[piece].steps.0 + step];
        step.whole.then_some(step.end)
    }

    /// Ends of the steps of a piece, with its begin.
    pub(crate) fn ends_of(&self, piece: usize) -> Vec<f64> {
        let p = &self.pieces[piece];
        std::iter::once(p.from).chain(self.steps[p.steps.0..p.steps.1].iter().filter(|s| s.whole).map(|s| s.end)).collect()
    }

    /// Stretches of each piece to begin with where columns are resolved: some steps each, but no wider than the first panels of any
    /// curve.
    pub(crate) fn stretches(&self) -> Vec<(f64, f64, usize)> {
        let range = self.pieces.last().zip(self.pieces.first()).map_or(0.0, |(last, first)| last.to - first.from);
        let widest = range / FIRST_PANELS as f64;
        let mut all = Vec::new();
        for (piece, p) in self.pieces.iter().enumerate() {
            let (mut from, mut count) = (p.from, 0);
            for (k, step) in self.steps[p.steps.0..p.steps.1].iter().enumerate() {
                count += 1;
                let last = p.steps.0 + k + 1 == p.steps.1;
                let to = if last { p.to } else { step.end };
                if to <= from || !(last || count == STEPS_TO_A_STRETCH || to - from >= widest) {
                    continue;
                }
                let parts = ((to - from) / widest).ceil().clamp(1.0, FIRST_PANELS as f64) as usize;
                let at = |i: usize| if i == parts { to } else { from + (to - from) * i as f64 / parts as f64 };
                all.extend((0..parts).map(|i| (at(i), at(i + 1), piece)));
                (from, count) = (to, 0);
            }
        }
        all
    }

    /// The mechanism of the piece that was evaluated last.
    pub(crate) fn system(&mut self, piece: usize) -> &mut Mechanical<'m, G> {
        let phase = self.pieces.get(piece).map_or(0, |p| p.phase);
        &mut self.phases[phase].system
    }

    /// The state at `t` on a piece as the integrator's continuous solution has it; whether it is the begin or the end of a step,
    /// which is the integrator's own.
    fn take(&mut self, t: f64, piece: usize) -> Result<bool, Off> {
        let off = Off { at: t, gap: None };
        let Some(p) = self.pieces.get(piece) else { return Err(off) };
        let (low, high) = p.steps;
        if low == high {
            return Err(off);
        }
        if !(self.near >= low && self.near < high && self.steps[self.near].begin <= t && t <= self.steps[self.near].end) {
            self.near = (low + self.steps[low..high].partition_point(|s| s.end < t)).min(high - 1);
        }
        let step = self.steps[self.near];
        self.dense.set(step.begin, step.h, step.form, &self.coefficients[step.first..step.first + step.count]);
        self.dense.evaluate(t, &mut self.node.state);
        self.node.state.modes.copy_from_slice(&self.modes[step.modes]);
        self.node.state.live.copy_from_slice(&p.live);
        let PhaseSystem { system, engine, .. } = &mut self.phases[p.phase];
        // phases differ in the rows that hold joints on their stops
        self.node.lambda.resize(system.dims().rows(), 0.0);
        if self.follow {
            engine.follow_modes(system, &mut self.node.state);
        }
        Ok(t == step.begin || t == step.end && (step.end - step.begin - step.h).abs() <= 1e-12 * step.h)
    }

    /// Largest residuals of Φ and of G v − ν at the state evaluated last, in units of size (per second).
    pub(crate) fn residuals(&mut self, piece: usize) -> [f64; 2] {
        let PhaseSystem { system, engine, .. } = &mut self.phases[self.pieces[piece].phase];
        engine.evaluate(system, self.node.state.at(), Stage::Velocity);
        [engine.position_residual(), engine.velocity_residual(&self.node.state.v)]
    }

    /// Sizes of the motion.
    pub(crate) fn grain(&mut self) -> Grain {
        let mut grain = Grain::of(self.phases.first().map_or(1.0, |phase| phase.system.size));
        let breaks = self.breaks();
        let (Some(&from), Some(&to)) = (breaks.first(), breaks.last()) else { return grain };
        for t in PLACES.map(|part| from + part * (to - from)) {
            let piece = breaks.partition_point(|b| *b <= t).clamp(1, self.pieces.len()) - 1;
            if self.take(t, piece).is_ok() {
                let system = &mut self.phases[self.pieces[piece].phase].system;
                let state = self.node.state.at();
                system.kinematics(&state);
                let m = system.dynamics.mechanism;
                grain.take(&mut system.dynamics, state.v, &state.modes[..m.switches + m.windings]);
            }
        }
        grain
    }

    /// Whether a column is open that is no larger than what states off the constraints make of it.
    pub(super) fn looks_too_far(&self, resolved: &Resolved) -> bool {
        let made = |column: usize| self.near_enough / ROUND_OFF * self.floor(column);
        resolved.open.iter().any(|open| open.size <= made(open.column))
    }

    /// All outputs of the observer at the state evaluated last.
    pub(crate) fn outputs(&mut self, piece: usize) -> &[f64] {
        let phase = self.pieces[piece].phase;
        if self.loose.iter().any(|(first, _)| self.near >= *first) {
            let modes = &mut self.node.state.modes;
            self.followed.copy_from_slice(modes);
            self.phases[phase].system.observer.set_modes(&mut self.followed);
            let loose = self.loose.iter().filter(|(first, _)| self.near >= *first);
            loose.for_each(|&(_, switch)| modes[switch] = self.followed[switch]);
        }
        self.phases[phase].system.columns(&self.node.state.modes, &mut self.out);
        &self.out
    }
}

impl<G> Trajectory<'_, G>
where
    G: Space<S = f64>,
{
    /// Columns at `t` on a piece, of a state that is on the constraints, or to a `part` of its size.
    fn columns_at(&mut self, t: f64, piece: usize, part: f64, out: &mut [f64]) -> Result<(), Off> {
        self.glance(t, piece, part)?;
        let n = self.columns;
        out.copy_from_slice(&self.outputs(piece)[..n]);
        let observer = &self.phases[self.pieces[piece].phase].system.observer;
        match observer.undefined(&self.node.state.modes, &self.out) {
            Some(gap) => Err(Off { at: t, gap: Some(gap) }),
            None => Ok(()),
        }
    }

    /// As [`Curve::eval`], but where an expression has no value by its own fault that is an error.
    pub(crate) fn row(&mut self, t: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        self.row_near(t, piece, 0.0, out)
    }

    /// The same of a state that may be off the constraints by a part of its size.
    fn row_near(&mut self, t: f64, piece: usize, part: f64, out: &mut [f64]) -> Result<(), Off> {
        let found = self.columns_at(t, piece, part, out);
        if !matches!(found, Err(Off { gap: Some(_), .. })) {
            return found;
        }
        // a located switch lies on its far side, where the formula of this side may just not be defined any more
        let located = t == self.pieces[piece].to && (piece + 1 < self.pieces.len() || self.ended_by_event);
        let length = self.pieces.last().map_or(0.0, |p| p.to);
        for shift in [1e-15, 1e-13, 1e-11].into_iter().filter(|_| located) {
            if self.columns_at(t - shift * length, piece, part, out).is_ok() {
                return Ok(());
            }
        }
        found
    }

    /// Looks again where resolved columns have no value.
    ///
    /// # Errors
    /// The first place where an expression has none by its own fault.
    pub(crate) fn all_defined(&mut self, resolved: &Resolved) -> Result<(), Off> {
        let mut out = vec![0.0; self.columns];
        resolved.blanks().try_for_each(|(t, piece)| self.row(t, piece, &mut out))
    }
}

impl<G> Curve for Trajectory<'_, G>
where
    G: Space<S = f64>,
{
    type Error = Off;

    fn columns(&self) -> usize {
        self.columns
    }

    fn middle(&self, from: f64, to: f64, piece: usize) -> f64 {
        // steps meet in small kinks, which no polynomial follows
        let (low, high) = self.pieces[piece].steps;
        let steps = &self.steps[low..high];
        let first = steps.partition_point(|s| s.end <= from);
        let inside = &steps[first..first + steps[first..].partition_point(|s| s.end < to)];
        if inside.is_empty() { 0.5 * (from + to) } else { inside[inside.len() / 2].end }
    }

    fn smooth(&self, at: f64, piece: usize) -> f64 {
        let (low, high) = self.pieces[piece].steps;
        let steps = &self.steps[low..high];
        steps.get(steps.partition_point(|s| s.end < at)).map_or(0.0, |s| s.h)
    }

    fn floor(&self, column: usize) -> f64 {
        self.floors.get(column).copied().unwrap_or(0.0)
    }

    fn singular(&mut self, at: f64, piece: usize) -> bool {
        // what is redundant is so all along, in the begin of the piece as well
        if self.go(self.pieces[piece].from, piece).is_err() {
            return true;
        }
        let PhaseSystem { system, engine, .. } = &mut self.phases[self.pieces[piece].phase];
        let (pattern, mut weakest) = (system.pattern(), Sigma::new(self.node.lambda.len()));
        weakest.begin(engine, &pattern.metric, &pattern.g_scale);
        if self.go(at, piece).is_err() {
            return true;
        }
        weakest.follow(&mut self.phases[self.pieces[piece].phase].engine, 4) < SINGULAR
    }

    fn eval(&mut self, t: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        blank(self.row_near(t, piece, 0.0, out), out)
    }

    fn look(&mut self, t: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        blank(self.row_near(t, piece, self.near_enough, out), out)
    }
}

/// What is not defined by its own fault has no value, which is no error.
fn blank(found: Result<(), Off>, out: &mut [f64]) -> Result<(), Off> {
    match found {
        Err(Off { gap: Some(_), .. }) => {
            out.fill(f64::NAN);
            Ok(())
        }
        found => found,
    }
}
