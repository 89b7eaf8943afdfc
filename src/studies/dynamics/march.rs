//! One run of an integrator over a mechanism, recorded: steps, events, changes of parameters, energies.

use super::chart::Charted;
use super::contradiction;
use super::course::{After, Course, Lost};
use super::depart::depart;
use super::energy::{Balance, Begins};
use super::explain;
use super::pace::Pace;
use super::phases::Phases;
use super::rows::Rows;
use super::runaway;
use super::setup::Plan;
use super::system::Mechanical;
use super::trajectory::Trajectory;
use super::vanishing;
use super::watch::swept;
use super::way::Way;
use crate::expression::Id;
use crate::geometry::Space;
use crate::kinematics::held::settled;
use crate::kinematics::undefined::in_state;
use crate::model::{Model, Study};
use crate::results::{Certificate, Failure, Finding, Happened, Undefined};
use crate::studies::common::case::Case;
use crate::studies::common::energies;
use crate::studies::common::stops::shared_by_contacts;
use grashof_solvers::{Control, Dense, Dims, Engine, Halt, Integration, Node, Progress, State, System, Why};

/// Parts of a step in minimal coordinates: Hermite's polynomials of fifth order over them are as good as those of the schemes.
const PARTS: usize = 10;

/// Part of a time by which a step may miss the one at which it should end.
const ENDED: f64 = 1e-13;

/// What a run has left.
pub(crate) struct Recorded<'m, G: Space<S = f64>> {
    pub(crate) trajectory: Trajectory<'m, G>,
    pub(crate) stopped: Option<String>,
    /// What has no value, if that has stopped it.
    pub(crate) undefined: Option<Undefined>,
    pub(crate) events: Vec<Happened>,
    pub(crate) certificate: Certificate,
    pub(crate) findings: Vec<Finding>,
}

/// Runs a plan from a state, or from the start; the trajectory has the columns `ids`. `stop` is asked between steps, and rows are taken
/// behind each.
///
/// # Errors
/// If the run did not begin.
pub(crate) fn march<'m, G: Space<S = f64>>(
    case: Case<'_>,
    plan: &Plan,
    ids: &[Id],
    phases: &'m Phases<G>,
    from: Option<&State>,
    (stop, rows): (&dyn Fn() -> bool, Option<&mut Rows<'_>>),
) -> Result<Recorded<'m, G>, Failure> {
    let Case { model, study, parameters, .. } = case;
    let course = Course::new(model, plan, ids, swept(study, parameters), &phases.parameters);
    let first = course.machine(phases);
    let dims = first.dims();
    let mut trajectory = Trajectory::new(&first, ids.len(), !plan.settings.locate);
    let mut flow = Flow {
        model,
        study,
        plan,
        stop,
        trajectory: &mut trajectory,
        rows,
        course,
        balance: Balance::default(),
        findings: Vec::new(),
        pace: Pace::default(),
        sound: 0.0,
        undefined: None,
    };
    let mut state = from.cloned().unwrap_or_else(|| begin(phases, dims));
    let stopped = loop {
        let phase = match flow.course.next(phases, &mut state) {
            Ok(phase) => phase,
            Err(Lost::Failure(failure)) => return Err(failure),
            Err(Lost::Stopped(why)) => break Some(why),
        };
        let system = flow.course.machine(phase);
        flow.trajectory.phase(std::ptr::from_ref(phase).addr(), || flow.course.machine(phase));
        match flow.phase(phase, system, &mut state)? {
            After::Done => break None,
            After::Stopped(why) => break Some(why),
            // other rows, other charts
            After::Changed => flow.sound = 0.0,
        }
    };
    flow.findings.extend(shared_by_contacts(&phases.mechanism, &flow.course.open));
    flow.findings.extend(explain::shared(phases));
    let Flow { course: Course { events, ended, .. }, balance, undefined, findings: mut unresolved, .. } = flow;
    let (certificate, mut findings) = balance.finish(plan, &study.place);
    unresolved.dedup_by(|a, b| a.path == b.path);
    findings.append(&mut unresolved);
    trajectory.finish();
    trajectory.ended_by_event = ended;
    Ok(Recorded { trajectory, stopped, undefined, events, certificate, findings })
}

/// The state at the assembled start.
pub(crate) fn begin<G: Space<S = f64>>(phases: &Phases<G>, dims: Dims) -> State {
    let mut state = State::new(dims);
    state.q.copy_from_slice(&phases.start.q);
    state.v.copy_from_slice(&phases.start.v);
    state.z.copy_from_slice(&phases.mechanism.state_starts);
    // forces may have no value in modes that are not those of the state
    let modes = settled(&phases.mechanism, [&state.q, &state.v, &state.z], &phases.start.modes);
    state.modes[..modes.len()].copy_from_slice(&modes);
    state
}

/// A run in progress.
struct Flow<'a, 'r, 'm, G: Space<S = f64>> {
    model: &'a Model,
    study: &'a Study,
    plan: &'a Plan,
    stop: &'a dyn Fn() -> bool,
    trajectory: &'a mut Trajectory<'m, G>,
    rows: Option<&'a mut Rows<'r>>,
    course: Course<'a>,
    balance: Balance,
    findings: Vec<Finding>,
    pace: Pace,
    /// The best quality of charts so far.
    sound: f64,
    /// What has no value, if that has stopped the run.
    undefined: Option<Undefined>,
}

impl<'m, G: Space<S = f64>> Flow<'_, '_, 'm, G> {
    /// Integrates until the end or until parameters change; `state` is where it begins, and where it has ended.
    fn phase(&mut self, phase: &'m Phases<G>, mut system: Mechanical<'m, G>, state: &mut State) -> Result<After, Failure> {
        let first = self.course.begins == Begins::Run;
        let dims = system.dims();
        let mut inner = Engine::new(&system, Control::Tolerance(1e-8));
        let departure = if first { depart(phase, &mut system, state, self.plan.until) } else { None };
        if let Some(departure) = &departure {
            state.copy_from(&departure.to);
        }
        let mut chart = Charted::new(self.study, self.plan, system, phase, state, &mut self.sound)?;
        let mut run = match chart.run(self.plan, self.plan.settings, state) {
            Ok(run) => run,
            Err(halt) if first => {
                let at = [&state.q[..], &state.v, &state.z];
                let modes = settled(&phase.mechanism, at, &phase.start.modes);
                let undefined = in_state(self.model, &phase.mechanism, at, &modes, "the start");
                return Err(
                    undefined.map_or_else(|| explain::no_start(self.study, &phase.mechanism, &phase.start, &halt), Failure::Undefined)
                );
            }
            Err(halt) => {
                self.undefined = explain::undefined(self.model, self.study, chart.mechanical(), &state.modes, halt.t);
                return Ok(After::Stopped(explain::halt(self.model, &phase.mechanism, chart.mechanical(), self.plan, &halt)));
            }
        };
        let (mut last, mut node) = (Node::new(dims), Node::new(dims));
        let mut dense = Dense::new(dims);
        chart.whole(run.node(), &mut node);
        match &departure {
            Some(departure) => {
                self.balance.begin(chart.mechanical(), &departure.from, self.course.begins);
                departure.record(self.trajectory, chart.mechanical(), &mut inner, &mut dense, &node);
            }
            None => {
                self.trajectory.piece(&node);
                self.balance.begin(chart.mechanical(), &node, self.course.begins);
            }
        }
        // what crosses in the same instant as the event that began this phase
        let at_once = if first { Vec::new() } else { chart.mechanical().flipped(&state.modes, &node.state.modes) };
        if !at_once.is_empty() {
            let at_once = self.course.hits(at_once, node.state.t);
            self.course.note(&at_once, node.state.t);
            state.copy_from(&node.state);
            if self.course.ends_or_sets(&at_once) {
                return Ok(self.course.stopped_by(&mut chart, &node, &at_once));
            }
        }
        let from_start = first && self.plan.fixed_step().is_none() && state.t == 0.0 && state.q == phase.start.q;
        let way = if from_start { Way::of(phase, self.plan.until) } else { Way::default() };
        let ended = loop {
            if (self.stop)() {
                break After::Stopped(format!("interrupted at t = {} s", node.state.t));
            }
            let until = way.prepare(&mut run, node.state.t * (1.0 + ENDED)).unwrap_or(self.plan.until);
            let progress = match run.advance(chart.system(), until) {
                Ok(Progress::End) if until < self.plan.until => Progress::Step,
                Ok(progress) => progress,
                Err(halt) => {
                    self.undefined = self.gap(&mut chart, &run, halt.t);
                    break After::Stopped(self.explain(phase, &mut chart, &mut run, (&node.state, &halt)));
                }
            };
            let happened = matches!(progress, Progress::Event | Progress::Stopped);
            std::mem::swap(&mut last, &mut node);
            chart.whole(if happened { run.before() } else { run.node() }, &mut node);
            if node.state.t <= last.state.t && !happened {
                break After::Done;
            }
            for &root in run.given_up() {
                chart.mechanical().switch_of(root).into_iter().for_each(|switch| self.trajectory.loosen(switch));
            }
            if let Err(halt) = self.record(&mut chart, &mut run, &mut inner, &mut dense, [&last, &node]) {
                break After::Stopped(self.explain(phase, &mut chart, &mut run, (&last.state, &halt)));
            }
            if self.balance.step(chart.mechanical(), &node, self.plan.until)
                && let Some(why) = contradiction::explain(chart.mechanical(), phase.start.size, node.state.t)
            {
                break After::Stopped(why);
            }
            if happened {
                let counted = self.course.happened(&mut chart, &run);
                std::mem::swap(&mut last, &mut node);
                chart.whole(run.node(), &mut node);
                self.balance.jump(chart.mechanical(), [&last, &node], run.crossed());
                // the last roots are those of the coordinates themselves
                let own = run.crossed().iter().all(|root| *root >= chart.mechanical().roots.len());
                if progress == Progress::Stopped && !(own && chart.turns(&node.state, true)) {
                    break self.course.stopped_by(&mut chart, &last, &counted);
                }
                match chart.mechanical().winds_only(run.crossed()) {
                    true => self.trajectory.wind(&node),
                    false => self.trajectory.piece(&node),
                }
            }
            if progress == Progress::Stopped || progress != Progress::End && chart.turns(&node.state, false) {
                self.balance.turn(&run, chart.is_bridge().then_some(node.state.t));
                run = match chart.run(self.plan, self.plan.settings, &node.state) {
                    Ok(run) => run,
                    Err(halt) => break After::Stopped(explain::halt(self.model, &phase.mechanism, chart.mechanical(), self.plan, &halt)),
                };
                chart.whole(run.node(), &mut node);
                self.trajectory.piece(&node);
            }
            if let Some(slow) = self.pace.step([last.state.t, node.state.t], self.trajectory.size(), self.plan) {
                break After::Stopped(slow.explain(self.model, phase, self.plan, &node));
            }
            if let Some(short) = self.pace.crawls()
                && let Some(why) = vanishing::explain(self.model, phase, &node.state, vanishing::part(short))
            {
                break After::Stopped(why);
            }
            if let Some(rows) = &mut self.rows {
                rows.follow(self.trajectory);
            }
            if progress == Progress::End {
                break After::Done;
            }
        };
        self.balance.end(chart.mechanical(), &node, &run, inner.counts);
        if let Some((root, t)) = run.unresolved() {
            self.findings.push(explain::unresolved(self.model, chart.mechanical(), root, t));
        }
        let spring = chart.mechanical().dynamics.unresolved_spring();
        self.findings.extend(spring.map(|spring| energies::unresolved(self.model, spring)));
        state.copy_from(&node.state);
        Ok(ended)
    }

    /// Why a run cannot go on, with the joints and drivers that lock.
    fn explain(&self, phase: &Phases<G>, chart: &mut Charted<'m, G>, run: &mut Integration, (state, halt): (&State, &Halt)) -> String {
        let faster = runaway::faster(self.model, phase, state).filter(|_| self.undefined.is_none());
        if let Some(why) = faster.and_then(|faster| runaway::explain(&faster, halt)) {
            return why;
        }
        if matches!(halt.why, Why::Error(_) | Why::StepSize | Why::Newton | Why::Singular)
            && let Some(why) = vanishing::explain(self.model, phase, state, vanishing::STUCK)
        {
            return why;
        }
        let locked = if chart.is_whole() { explain::locked(&phase.mechanism, halt, &run.dependence(chart.system())) } else { None };
        locked.unwrap_or_else(|| explain::halt(self.model, &phase.mechanism, chart.mechanical(), self.plan, halt))
    }

    /// What has no value where a run cannot go on.
    fn gap(&self, chart: &mut Charted<'m, G>, run: &Integration, t: f64) -> Option<Undefined> {
        let here = explain::undefined(self.model, self.study, chart.mechanical(), &run.node().state.modes, t);
        if here.is_some() {
            return here;
        }
        let beyond = run.beyond().filter(|_| chart.is_whole())?;
        let system = chart.mechanical();
        let dims = system.dims();
        system.observe(&beyond.at(), &vec![0.0; dims.v], &vec![0.0; dims.rows()]);
        explain::undefined(self.model, self.study, system, &beyond.modes, t)
    }

    /// Adds the last step to the trajectory.
    fn record(
        &mut self,
        chart: &mut Charted<'m, G>,
        run: &mut Integration,
        inner: &mut Engine,
        dense: &mut Dense,
        [last, node]: [&Node; 2],
    ) -> Result<(), Halt> {
        let Charted::Minimal { system, bridging: false } = chart else {
            self.trajectory.step(run.dense(chart.system())?, node.state.t, true);
            return Ok(());
        };
        // the continuous solution of the whole is Hermite's over parts of the step, whose ends come from that of the scheme
        let (t, h) = (last.state.t, node.state.t - last.state.t);
        // a step of a few roundings of time has no parts
        let whole = self.plan.fixed_step().is_some() || h < 1e3 * f64::EPSILON * node.state.t;
        let parts = if whole { 1 } else { PARTS };
        if h <= 0.0 {
            // an event at the begin of a step
            return Ok(());
        }
        let [mut reduced, mut from, mut to] = [run.node().clone(), last.clone(), last.clone()];
        for part in 1..=parts {
            let end = part == parts;
            if end {
                to.copy_from(node);
            } else {
                run.at(&mut **system, t + h * part as f64 / parts as f64, &mut reduced)?;
                system.whole(&reduced, &mut to).map_err(|why| Halt { why, t, h })?;
            }
            let made = dense.hermite(system.inner_mut(), inner, &from, &to);
            made.map_err(|why| Halt { why, t, h })?;
            self.trajectory.step(dense, to.state.t, end);
            std::mem::swap(&mut from, &mut to);
        }
        Ok(())
    }
}
