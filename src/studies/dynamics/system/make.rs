//! A mechanism as a system of the integrators: its roots, its patterns and its scales.

use super::decided::Decided;
use super::root::{Corners, Root};
use super::seen::Seen;
use super::works::{self, WORKS};
use super::{Mechanical, Watched, ahead, direct};
use crate::dynamics::{Differentiable, Dynamics, friction_pattern, tangent_pattern};
use crate::geometry::Space;
use crate::kinematics::assemble::{Assembled, units};
use crate::mechanism::{Measured, Row, RowOwner, Step};
use crate::studies::common::observe::Observer;
use crate::studies::common::stops::PASSED;
use ahead::Timed;
use grashof_solvers::weakest::weakest;
use grashof_solvers::{Dims, Friction, Kkt, Pattern, Sparsity, Terms};

impl<'m, G> Mechanical<'m, G>
where
    G: Space<S = f64>,
{
    /// The system of a mechanism; scales are those of an assembled start.
    pub(crate) fn new(mechanism: &'m Differentiable<G>, start: &Assembled, observer: Observer<G>, events: Vec<Watched>) -> Self {
        let (nv, rows, nz) = (mechanism.nv, mechanism.rows.len(), mechanism.state_starts.len());
        let mut roots = Vec::new();
        let mut seen = Vec::new();
        let of_contact = |switch: u32| mechanism.is_of_contact(switch as usize);
        for (program, staged) in mechanism.programs().iter().enumerate() {
            for (k, switch) in staged.program.switches().iter().enumerate() {
                if !seen.contains(switch) && !of_contact(*switch) {
                    seen.push(*switch);
                    roots.push(Root::Force { program, k });
                }
            }
        }
        for (k, switch) in observer.program().switches().iter().enumerate() {
            if !seen.contains(switch) && !of_contact(*switch) {
                roots.push(Root::Column { k });
            }
        }
        for (gauge, g) in mechanism.gauges.iter().enumerate() {
            if let Measured::Turn { winding, .. } = g.measured {
                roots.push(Root::Winding { gauge, winding });
            }
        }
        roots.extend(mechanism.sides().enumerate().map(|(place, mode)| Root::Side { place, mode }));
        let rests = |row: &Row<G>| if let RowOwner::Stop(stop) = row.owner { Some(stop) } else { None };
        let held: Vec<(usize, usize)> = mechanism.rows.iter().enumerate().filter_map(|(i, row)| Some((i, rests(row)?))).collect();
        for stop in 0..mechanism.stops.len() {
            match held.iter().find(|(_, s)| *s == stop) {
                Some(&(row, _)) => roots.push(Root::Rest { row, stop }),
                None if mechanism.stops[stop].event.is_some() => roots.push(Root::Clear(stop)),
                None => roots.extend([Root::Stop(stop), Root::Clear(stop)]),
            }
        }
        let contacts: Vec<(usize, usize)> = mechanism.held().collect();
        for contact in 0..mechanism.contacts.len() {
            match contacts.iter().find(|(c, _)| *c == contact) {
                Some(&(_, row)) => roots.extend([-1, 1].map(|sense| Root::Holds { contact, row, sense })),
                None => roots.push(Root::Slides(contact)),
            }
        }
        roots.extend((0..events.len()).map(Root::Event));
        let dims = Dims {
            q: mechanism.nq,
            v: nv,
            z: nz,
            holonomic: rows,
            nonholonomic: 0,
            modes: mechanism.switches + mechanism.windings + events.len() + mechanism.stops.len(),
            live: mechanism.contacts.len(),
            roots: roots.len(),
            work: WORKS,
        };
        let mut dynamics = Dynamics::new(mechanism);
        dynamics.time(0.0, &start.modes);
        dynamics.position(&start.q, &start.modes);
        let outputs: Vec<usize> = events.iter().map(|event| event.output).collect();
        let timed = ahead::timed(mechanism, &observer, &roots, &outputs, mechanism.switches + mechanism.windings);
        let g_scale = dynamics.row_scale(&start.q, &start.modes, &start.metric);
        let decided = Decided::of(&dynamics, start, &g_scale);
        let direct = direct::sources(&dynamics, &start.q, &decided, &roots);
        let watched = direct::watched(&dynamics, &start.q, &decided, &observer);
        let block = tangent_pattern(mechanism);
        let size: Vec<f64> = units(mechanism).iter().map(|u| if *u == 0 { 1.0 } else { start.size }).collect();
        let mut size_q = vec![1.0; mechanism.nq];
        for step in &mechanism.steps {
            if let Step::Axis { q, v, .. } = step {
                size_q[*q] = size[*v];
            }
        }
        let near: Vec<f64> = mechanism.stops.iter().map(|s| PASSED * s.size(start.size)).collect();
        let pattern = Pattern {
            mass: dynamics.work.mass.pattern().clone(),
            g: dynamics.work.g.pattern().clone(),
            k: block.clone(),
            c: block,
            r_z: Sparsity::dense(nv, nz),
            r_lambda: friction_pattern(mechanism),
            z_q: Sparsity::dense(nz, nv),
            z_v: Sparsity::dense(nz, nv),
            z_z: Sparsity::dense(nz, nz),
            vector_scale: dynamics.vector_scale(&g_scale),
            g_scale,
            metric: start.metric.clone(),
            size_q,
            size_v: size,
            size_z: vec![1.0; nz],
            common: mechanism.translations(),
            power: works::depends(mechanism),
            roots_by_reactions: observer.switches_by_forces()
                || (!events.is_empty() && observer.needs_forces())
                || mechanism.sides().next().is_some()
                || !held.is_empty()
                || !contacts.is_empty(),
            acting: (0..roots.len()).filter(|&i| roots[i].acts()).collect(),
            striking: Self::striking(mechanism, &roots, &near),
            closing: Self::closing(mechanism, &roots),
            forceful: (0..roots.len()).filter(|&i| roots[i].is_forceful()).collect(),
            timed: timed.iter().map(Timed::root).collect(),
            observing: Self::observing(&observer, &roots, &events),
            nested: (0..roots.len()).filter(|&i| roots[i].is_formula(&events)).collect(),
            rough: Vec::new(),
            weakest: 1.0,
        };
        let weakest = weakest(&mut Kkt::of_pattern(&pattern), &pattern.metric, &pattern.g_scale, &dynamics.work.g);
        let pattern = Pattern { weakest, ..pattern };
        let most = |f: fn(&crate::mechanism::StagedProgram) -> usize| mechanism.programs().iter().map(|p| f(p)).max().unwrap_or(0);
        let switches = most(|p| p.program.switches().len()).max(observer.program().switches().len());
        let mut system = Self {
            reactions: dynamics.reactions(),
            linearizer: None,
            mechanism,
            outputs: vec![0.0; observer.program().outputs()],
            inputs: vec![0.0; most(|p| p.inputs)],
            registers: vec![0.0; most(|p| p.program.registers())],
            scratch: vec![0.0; switches],
            friction: Friction::of_pattern(dims, &pattern).map(|friction| (friction, Terms::new(dims, &pattern))),
            a: vec![0.0; nv],
            lambda: vec![0.0; rows],
            size: start.size,
            modes: mechanism.modes(),
            near,
            decided,
            rests: Vec::with_capacity(2 * mechanism.stops.len()),
            struck: Vec::with_capacity(mechanism.stops.len()),
            restless: None,
            met: Vec::with_capacity(mechanism.contacts.len()),
            loosened: false,
            corners: Corners::default(),
            seen: Seen::nothing(),
            dynamics,
            observer,
            roots,
            dims,
            pattern,
            events,
            timed,
            direct,
            watched,
            kkt: None,
        };
        if nz > 0 {
            // the same behind events, at which parameters and holds change
            system.pattern.size_z = start.state_sizes.get_or_init(|| system.sizes_of_states(start)).clone();
        }
        system
    }
}
