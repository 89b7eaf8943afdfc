//! The certificate of a run: energy balance, residuals of the constraints, work done by the integrator.
//!
//! E(t) − E(0) must be the work of drivers, loads and dampers, integrated beside the motion, and what impacts took at once. What
//! remains is the energy that the integration has made or lost.

use super::setup::Plan;
use super::system::{Mechanical, Root, WORKS};
use super::trajectory::Trajectory;
use crate::geometry::Space;
use crate::results::{Certificate, Finding, March};
use grashof_solvers::{Control, Counts, Integration, Node, System};

/// What a phase begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Begins {
    /// The run.
    Run,
    /// Other parameters.
    Parameters,
    /// Other stops on which joints rest.
    Rests,
}

/// Energies looked at in the course of a run.
const LOOKS: f64 = 400.0;

/// Part of the energy scale that the balance may lack, in tolerances, and its ends.
const TOLERANCES: f64 = 1e4;
const LEAST: f64 = 1e-7;
const MOST: f64 = 1e-2;
/// Roundings of the largest energy that it may lack.
const ROUNDING: f64 = 1e5;

/// Energies and counters of a run so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Balance {
    start: f64,
    /// Work before the present phase.
    before: [f64; WORKS],
    work: [f64; WORKS],
    impacts: f64,
    /// What blows at rigid end stops took.
    blows: f64,
    /// What drivers did at once: by impulses at blows and where their law has a kink, and where the law or the rest of a spring jumps with time.
    kinks: f64,
    /// What one-way clutches took that blows have closed.
    closings: f64,
    /// Kinks of couplings and drivers: the first that was passed, and how many there were.
    kinked: Option<(Kinked, usize)>,
    drift: f64,
    scale: f64,
    /// Largest |E|: what round-off is a part of.
    largest: f64,
    /// Kinetic energy of all mass at one size of the mechanism per second.
    unit: f64,
    kinetic: f64,
    next: f64,
    counts: Counts,
    bridged: Vec<f64>,
    widest_gap: f64,
    schemes: Vec<&'static str>,
}

/// Where velocities have jumped by a law.
#[derive(Clone, Debug)]
struct Kinked {
    /// When, s.
    t: f64,
    /// Whose law it is, and whether that of a coupling.
    of: String,
    coupling: bool,
}

/// Kinetic and whole energy at a node, J.
fn energy<G>(system: &mut Mechanical<'_, G>, node: &Node) -> [f64; 2]
where
    G: Space<S = f64>,
{
    system.observe(&node.state.at(), &node.a, &node.lambda);
    let d = &mut system.dynamics;
    let kinetic = d.kinetic_energy();
    let mut modes = node.state.modes.clone();
    modes.truncate(d.mechanism.switches + d.mechanism.windings);
    [kinetic, kinetic + d.potential_energy(&modes)]
}

/// What springs store more in the modes behind a switch than in those before it: their laws or rests jump with time there.
fn switched<G>(system: &mut Mechanical<'_, G>, [before, after]: [&Node; 2]) -> f64
where
    G: Space<S = f64>,
{
    let m = system.dynamics.mechanism;
    let changed = |switch: &u32| before.state.modes[*switch as usize] != after.state.modes[*switch as usize];
    let programs = [&m.time_program, &m.force_program].map(|staged| staged.program.switches());
    if m.stretches.is_empty() || !programs.into_iter().flatten().any(changed) {
        return 0.0;
    }
    let mut state = before.state.clone();
    let [stored, more] = [before, after].map(|side| {
        state.modes[..m.switches].copy_from_slice(&side.state.modes[..m.switches]);
        system.observe(&state.at(), &before.a, &before.lambda);
        (0..m.stretches.len()).map(|spring| system.dynamics.spring_energy(spring, &state.modes)).sum::<f64>()
    });
    system.observe(&after.state.at(), &after.a, &after.lambda);
    more - stored
}

impl Balance {
    /// Begins a phase at a node; energies that change because parameters do count as done by the event.
    pub(super) fn begin<G>(&mut self, system: &mut Mechanical<'_, G>, node: &Node, begins: Begins)
    where
        G: Space<S = f64>,
    {
        let [kinetic, e] = energy(system, node);
        match begins {
            Begins::Run => {
                let (mass, _) = system.dynamics.first_moment();
                self.unit = 0.5 * mass * system.dynamics.mechanism.size().powi(2);
                (self.start, self.kinetic, self.scale) = (e, kinetic, kinetic);
            }
            // the drift so far is not known apart from it, and begins anew
            Begins::Parameters => self.impacts = e - self.start - self.done() - self.blows - self.kinks - self.closings,
            Begins::Rests => {}
        }
        self.before = self.work;
        for (before, now) in self.before.iter_mut().zip(&node.state.work) {
            *before -= now;
        }
    }

    /// Work of drivers, loads, dampers and end stops that give way so far, J.
    fn done(&self) -> f64 {
        self.work.iter().sum()
    }

    /// Looks at the energy of a node, if it is time to; whether it has, which leaves the system at the node.
    pub(super) fn step<G>(&mut self, system: &mut Mechanical<'_, G>, node: &Node, until: f64) -> bool
    where
        G: Space<S = f64>,
    {
        let t = node.state.t;
        if t < self.next && t < until {
            return false;
        }
        self.next = t + until / LOOKS;
        self.look(system, node);
        true
    }

    fn look<G>(&mut self, system: &mut Mechanical<'_, G>, node: &Node)
    where
        G: Space<S = f64>,
    {
        for ((work, before), now) in self.work.iter_mut().zip(&self.before).zip(&node.state.work) {
            *work = before + now;
        }
        let [kinetic, e] = energy(system, node);
        let off = e - self.start - self.done() - self.impacts - self.blows - self.kinks - self.closings;
        self.largest = self.largest.max(e.abs());
        self.drift = self.drift.max(off.abs());
        let largest = self.work.iter().fold(kinetic.max((e - kinetic - self.start + self.kinetic).abs()), |m, w| m.max(w.abs()));
        self.scale = self.scale.max(largest);
    }

    /// Energy that a blow took, from the sides before and after it; `crossed` are the roots that were met: end stops, or events.
    pub(super) fn jump<G>(&mut self, system: &mut Mechanical<'_, G>, [before, after]: [&Node; 2], crossed: &[usize])
    where
        G: Space<S = f64>,
    {
        let switched = switched(system, [before, after]);
        self.kinks += switched;
        if before.state.v != after.state.v {
            let [_, e0] = energy(system, before);
            let e1 = energy(system, after)[1] - switched;
            let corner = system.take_corner();
            if let Some(row) = corner.map(|(row, _)| row).or_else(|| system.kinked([&before.state, &after.state])) {
                let of = || system.dynamics.mechanism.name_of_row(row);
                self.kinked.get_or_insert_with(|| (Kinked { t: before.state.t, of: of(), coupling: corner.is_some() }, 0)).1 += 1;
            }
            let driven = corner.map_or_else(|| system.driven_work([&before.state, &after.state], crossed), |(_, work)| work);
            let own = || crossed.iter().filter(|root| **root < system.roots.len());
            let impacts = own().any(|&root| matches!(system.roots[root], Root::Event(_)) && system.strikes(root));
            let stops = own().any(|&root| matches!(system.roots[root], Root::Stop(_)));
            let closes = own().any(|root| system.pattern().closing.contains(root));
            self.kinks += driven;
            match (impacts, stops) {
                (true, _) => self.impacts += e1 - e0 - driven,
                // a clutch that takes part has no slip while it carries
                (false, true) => self.blows += e1 - e0 - driven,
                (false, false) if closes => self.closings += e1 - e0 - driven,
                // the law of a driver or a coupling has a kink; else it is the drift of a correction
                (false, false) => {}
            }
        }
    }

    /// Ends a phase.
    pub(super) fn end<G>(&mut self, system: &mut Mechanical<'_, G>, node: &Node, run: &Integration, inner: Counts)
    where
        G: Space<S = f64>,
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

    /// The certificate without the residuals of rows, and what a reader should know of the study at `place`.
    pub(super) fn finish(self, plan: &Plan, place: &str) -> (Certificate, Vec<Finding>) {
        let march = March {
            schemes: self.schemes.join(", "),
            tolerance: match plan.settings.control {
                Control::Tolerance(tolerance) => Some(tolerance),
                Control::Steps(_) => None,
            },
            energy_drift: self.drift,
            energy_scale: self.scale,
            drivers: self.work[0] + self.kinks,
            loads: self.work[1],
            dampers: self.work[2] + self.closings,
            stops: self.work[3] + self.blows,
            impacts: self.impacts,
            widest_gap: self.widest_gap,
            velocity: 0.0,
            counts: self.counts,
        };
        let doubt = unbalanced(&march, [self.largest, self.unit], place);
        let kinked = self.kinked.map(|(first, count)| passed_kinks(&first, count, place));
        let crossed = passed_singular(&self.bridged, march.counts.bridges);
        let findings = doubt.into_iter().chain(kinked).chain(crossed).collect();
        (Certificate { switches: self.counts.events, march: Some(march), ..Certificate::default() }, findings)
    }
}

/// Times that a finding names.
const NAMED: usize = 3;

/// That `count` singular positions were crossed, near the `times` (s), of which the first ones are known.
fn passed_singular(times: &[f64], count: usize) -> Option<Finding> {
    let named: Vec<String> = times.iter().take(NAMED).map(|t| format!("{t:.6} s")).collect();
    let message = match (count, count.saturating_sub(named.len())) {
        (0, _) => return None,
        (1, _) => format!("a singular position was crossed near t = {}", named.join("")),
        (_, 0) => format!("singular positions were crossed near t = {}", named.join(", ")),
        (_, others) => format!("singular positions were crossed near t = {} and {others} times more", named.join(", ")),
    };
    Some(Finding { code: "singular-position".into(), message, path: "joints".into() })
}

/// That velocities have jumped at kinks of couplings and drivers.
fn passed_kinks(Kinked { t, of, coupling }: &Kinked, count: usize, place: &str) -> Finding {
    let others = match count {
        1 => String::new(),
        2 => " and once more".into(),
        _ => format!(" and {} more times", count - 1),
    };
    let how = if *coupling { "they go on as over a corner that is rounded, without loss" } else { "they go on as it says" };
    Finding {
        code: "velocity-jump".into(),
        message: format!(
            "velocities jump at t = {t:.6} s{others}: the law of {of} has a kink; {how}, and the forces there are impulses, which no row, extreme, mean or integral holds; a law without kinks has none, as a table `between: cubic`"
        ),
        path: place.into(),
    }
}

/// That the balance of energy lacks more than the tolerance explains, or with a fixed step more than a part that shows.
///
/// Speeds are wrong by a part of themselves and of the size s of the mechanism a second, whichever is larger, so that a slow motion
/// with the energy E may lack m v δv ~ δ √(E ½ m s²/s²).
fn unbalanced(march: &March, [largest, unit]: [f64; 2], place: &str) -> Option<Finding> {
    let (part, help) = match march.tolerance {
        Some(tolerance) => ((TOLERANCES * tolerance).clamp(LEAST, MOST), "ask for a smaller `tolerance`"),
        None => (MOST, "take a shorter `step`, or a scheme of higher order"),
    };
    let slow = if march.tolerance.is_some() { (march.energy_scale * unit).sqrt() } else { 0.0 };
    let allowed = f64::max(part * march.energy_scale.max(slow), ROUNDING * f64::EPSILON * largest);
    (march.energy_drift > allowed).then(|| Finding {
        code: "energy".into(),
        message: format!(
            "the balance of energy lacks {:.2e} J, {:.1e} of the {:.3e} J that move (more than {:.1e} of them is not explained by {}): {help}, and compare with another integrator by `--verify`",
            march.energy_drift,
            march.energy_drift / march.energy_scale,
            march.energy_scale,
            part,
            march.tolerance.map_or("a step that is short enough".to_owned(), |t| format!("a tolerance of {t:.0e}")),
        ),
        path: place.to_owned(),
    })
}

/// Part of the size, or of 1 rad, by which constraints may be open whatever the tolerance.
const OPEN: f64 = 1e-6;

/// That constraints are open by more than the tolerance explains, in a mechanism of a `size`, m: what was integrated is then no motion of it.
pub(crate) fn open(certificate: &Certificate, size: f64, place: &str) -> Option<Finding> {
    let tolerance = certificate.march.as_ref()?.tolerance;
    let allowed = tolerance.map_or(MOST, |tolerance| (TOLERANCES * tolerance).clamp(OPEN, MOST)) * size.max(1.0);
    (certificate.constraint > allowed).then(|| Finding {
        code: "open-constraints".into(),
        message: format!(
            "constraints are open by {:.2e} m or rad, more than the tolerance explains: what was integrated is no motion of the mechanism; start farther from singular positions, or take another integrator or other `coordinates`",
            certificate.constraint
        ),
        path: place.to_owned(),
    })
}

/// Rows at which residuals are taken, about.
pub(crate) const SAMPLES: usize = 128;

/// Largest residuals over rows of a run: how many rows it has, and time and piece of some of them.
pub(crate) fn residuals<G>(
    trajectory: &mut Trajectory<'_, G>,
    (count, rows): (usize, impl Iterator<Item = (f64, usize)>),
    mut certificate: Certificate,
) -> Certificate
where
    G: Space<S = f64>,
{
    certificate.evaluations = count;
    let mut velocity: f64 = 0.0;
    for (t, piece) in rows {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_constraints_are_told_beyond_the_tolerance() {
        let told = |tolerance: f64, constraint: f64, size: f64| {
            let march = March { tolerance: Some(tolerance), ..March::default() };
            open(&Certificate { constraint, march: Some(march), ..Certificate::default() }, size, "studies.it").is_some()
        };
        assert!(told(1e-8, 0.2, 1.0) && told(1e-12, 1e-5, 1.0) && !told(1e-8, 1e-5, 1.0) && !told(1e-12, 1e-7, 1.0));
        // by parts of a large mechanism, and at most a hundredth of it
        assert!(!told(1e-8, 5e-3, 100.0) && told(1e-2, 2.0, 100.0));
    }

    #[test]
    fn singular_positions_are_one_note() {
        let told = |times: &[f64], count| passed_singular(times, count).map(|found| found.message);
        assert_eq!(told(&[], 0), None);
        assert_eq!(told(&[0.5], 1).unwrap(), "a singular position was crossed near t = 0.500000 s");
        assert_eq!(told(&[0.5, 1.0], 2).unwrap(), "singular positions were crossed near t = 0.500000 s, 1.000000 s");
        let many = "singular positions were crossed near t = 0.500000 s, 1.000000 s, 1.500000 s and 7 times more";
        assert_eq!(told(&[0.5, 1.0, 1.5, 2.0], 10).unwrap(), many);
    }
}
