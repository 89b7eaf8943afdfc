//! The velocity of a start: constraints, drivers and exact values hold; then guesses in least squares; what is left over rests.

use super::branch::ChangePoint;
use super::close::System;
use super::explain::{short, unit, unit_of_rate};
use super::fault::AssemblyFault;
use crate::geometry::Space;
use crate::kinematics::freedom::with_fewer_drivers;
use crate::mechanism::{Asked, Mechanism, RowOwner, Start};
use crate::numerics::least_squares::{Level, in_turn};

/// Velocities (nv) at an assembled position, and what it is if branches cross there.
///
/// # Errors
/// If exact values, constraints and drivers contradict each other.
pub(super) fn velocity<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    q: &[f64],
    modes: &[i32],
) -> Result<(Vec<f64>, Option<ChangePoint>), AssemblyFault> {
    let mut system = System::new(mechanism);
    system.modes.copy_from_slice(modes);
    let zeros = vec![0.0; mechanism.nv];
    system.dynamics.time(0.0, modes);
    system.dynamics.position(q, modes);
    system.dynamics.velocity(&zeros, modes);
    system.dynamics.watch(q, &zeros, modes);
    // where all joints are on the tree the shortest velocity is what rests most
    let looped = mechanism.joints.iter().any(|joint| joint.tree.is_none());
    let rest = if looped { system.rest(q) } else { Level::default() };
    let levels = [system.what_holds(), system.guessed_rates(), rest];
    let v = in_turn(&levels, &system.metric, zeros);
    let change = system.change(q, &v, &levels);
    if let Ok(Some((v, point))) = change {
        return Ok((v, Some(point)));
    }
    if let Some(fault) = system.contradiction(q, &v) {
        return Err(fault);
    }
    match change {
        Err(branches) => Err(system.blocked(&branches)),
        Ok(_) => Ok((v, None)),
    }
}

impl<G: Space<S = f64>> System<'_, G> {
    /// The row of a start value of velocity level, its scale and its value.
    fn asked_rate(&self, start: &Start) -> Option<(Vec<(usize, f64)>, f64)> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        match start.asked {
            Asked::Gauge { gauge, order: 1 } => Some((self.slopes(gauge, 1.0), self.gauge_scale(gauge))),
            Asked::Spin { body, axis, own } => {
                let spin = |k: usize| (k, G::spin_component(self.dynamics.in_axes(body, own, w.columns[k].w), axis));
                Some((m.road(m.bodies[body].column).map(spin).collect(), 1.0))
            }
            _ => None,
        }
    }

    /// Rows of constraints and drivers, then exact values of velocity level.
    fn what_holds(&self) -> Level {
        let rows: Vec<usize> = (0..self.dynamics.mechanism.rows.len()).collect();
        let (scaled, round_off) = self.scaled(&rows);
        let b = rows.iter().map(|&r| self.dynamics.work.nu[r] * self.row_scale(r)).collect();
        let mut level = Level { rows: scaled, b, round_off };
        self.rates(false, &mut level);
        level
    }

    /// Rows of guessed rates.
    pub(super) fn guessed_rates(&self) -> Level {
        let mut level = Level::default();
        self.rates(true, &mut level);
        level
    }

    fn rates(&self, guess: bool, level: &mut Level) {
        for start in self.dynamics.mechanism.starts.iter().filter(|s| s.guess == guess) {
            if let Some((row, scale)) = self.asked_rate(start) {
                level.row(row, start.value, scale);
            }
        }
    }

    /// All joints at rest.
    pub(super) fn rest(&self, q: &[f64]) -> Level {
        let (mut r, mut level) = (Vec::new(), Level::default());
        self.joints(q, true, &mut r, &mut level.rows);
        level.b = vec![0.0; r.len()];
        level
    }

    /// What velocities leave open, if anything.
    fn contradiction(&mut self, q: &[f64], v: &[f64]) -> Option<AssemblyFault> {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        let missing = |row: &[(usize, f64)], b: f64| b - row.iter().map(|&(k, a)| a * v[k]).sum::<f64>();
        let exact: Vec<(&Start, Vec<(usize, f64)>)> =
            m.starts.iter().filter(|s| !s.guess).filter_map(|s| Some((s, self.asked_rate(s)?.0))).collect();
        let of_rows = w.g.lines().zip(&w.nu).map(|(row, nu)| nu - row.dot(v));
        let off: Vec<f64> = of_rows.chain(exact.iter().map(|(s, row)| missing(row, s.value))).collect();
        let wanted = w.nu.iter().copied().chain(exact.iter().map(|(s, _)| s.value));
        let scale = 1.0 + wanted.fold(0.0_f64, |m, x| m.max(x.abs()));
        let (i, x) = off.iter().enumerate().max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()))?;
        if x.abs() <= 1e-7 * scale * (1.0 + self.size) {
            return None;
        }
        let held = i.checked_sub(m.rows.len()).and_then(|k| exact.get(k)).map(|(s, _)| *s);
        let what = match held {
            Some(s) => format!("the exact start value {} = {} {}", s.name, short(s.value), unit(m, s.asked)),
            None => m.name_of_row(i),
        };
        let missed = format!("missed by {} {}", short(*x), held.map_or_else(|| unit_of_rate(m, i), |s| unit(m, s.asked)));
        let missed = missed.trim_end();
        let (freedom, drivers) = (self.freedom(q), m.drives.len());
        let moved = m.rows.iter().filter(|row| m.is_moved(row)).count();
        if held.is_none() && freedom < drivers {
            let mut coupled: Vec<String> = Vec::new();
            for row in m.rows.iter().filter(|row| row.owner == RowOwner::Coupling) {
                let name = format!("`{}`", row.label);
                if !coupled.contains(&name) {
                    coupled.push(name);
                }
            }
            return Some(AssemblyFault {
                code: "over-constrained",
                message: format!(
                    "{drivers} driver{} for a mechanism of {freedom} degree{} of freedom: {what} is {missed} at the start",
                    if drivers == 1 { "" } else { "s" },
                    if freedom == 1 { "" } else { "s" }
                ),
                place: "drivers".into(),
                help: with_fewer_drivers(freedom, &coupled),
            });
        }
        if exact.is_empty() && (moved == 1 || moved == drivers) {
            return Some(self.dead_point(q, &format!("{what} is {missed}")));
        }
        Some(AssemblyFault {
            code: "start-cannot-hold",
            message: match (held, exact.is_empty()) {
                (None, true) => format!("drivers and couplings contradict each other in their velocities at the start: {what} is {missed}"),
                _ => format!("the start velocities contradict each other or the drivers: {what} is {missed}"),
            },
            place: held.map_or_else(|| "start".into(), |s| s.place.clone()),
            help: match (held, exact.is_empty()) {
                (Some(_), _) => "put `~` before it, or remove it: drivers and other exact values fix it already".into(),
                (None, true) => "remove one of those that hold the same motion, or let them agree".into(),
                (None, false) => "put `~` before one of the velocities, or remove it".into(),
            },
        })
    }

    /// Degrees of freedom without drivers.
    fn freedom(&self, q: &[f64]) -> usize {
        crate::kinematics::freedom::freedom(self.dynamics.mechanism, q, &self.modes, &self.metric)
    }
}
