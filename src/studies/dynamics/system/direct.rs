//! What the numbers of a state tell alone, switches and columns: they need no places of bodies.

use super::Root;
use super::decided::Decided;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Gauge, Leaf, Measured, Step};
use crate::studies::common::observe::Observer;
use grashof_solvers::At;

/// Where an input of a program stands in a state.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Source {
    Time,
    State(usize),
    /// Of the coordinates q.
    Position(Sum),
    /// Of the velocities v.
    Rate(Sum),
}

/// A constant and numbers of a state with their factors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sum {
    constant: f64,
    terms: Vec<(usize, f64)>,
}

impl Sum {
    fn single(k: usize) -> Self {
        Self { constant: 0.0, terms: vec![(k, 1.0)] }
    }

    fn of(&self, x: &[f64]) -> f64 {
        self.terms.iter().fold(self.constant, |sum, (k, factor)| sum + factor * x[*k])
    }
}

impl Source {
    pub(super) fn of(&self, at: &At<'_>) -> f64 {
        match self {
            Self::Time => at.t,
            Self::State(k) => at.z[*k],
            Self::Position(sum) => sum.of(at.q),
            Self::Rate(sum) => sum.of(at.v),
        }
    }
}

/// The inputs of each program of a mechanism with their sources; none unless all roots are switches of programs that read such numbers
/// alone. The mechanism stands at the coordinates `q`.
pub(super) fn sources<G: Space<S = f64>>(
    dynamics: &Dynamics<'_, G>,
    q: &[f64],
    decided: &Decided,
    roots: &[Root],
) -> Option<Vec<Vec<(usize, Source)>>> {
    let programs = dynamics.mechanism.programs();
    let mut sources = vec![Vec::new(); programs.len()];
    for root in roots {
        let Root::Force { program, .. } = *root else { return None };
        if sources[program].is_empty() {
            sources[program] = all(dynamics, q, decided, programs[program].fills.iter().copied())?;
        }
    }
    Some(sources)
}

/// The quantities of an observer with their sources; none unless such numbers tell them all. The mechanism stands at the coordinates `q`.
pub(super) fn watched<G: Space<S = f64>>(
    dynamics: &Dynamics<'_, G>,
    q: &[f64],
    decided: &Decided,
    observer: &Observer<G>,
) -> Option<Vec<(usize, Source)>> {
    // what a stop or friction holds is read as exactly as it is held
    let free = dynamics.mechanism.stops.is_empty() && dynamics.mechanism.contacts.is_empty();
    if free { all(dynamics, q, decided, observer.leaves()?) } else { None }
}

fn all<G>(
    dynamics: &Dynamics<'_, G>,
    q: &[f64],
    decided: &Decided,
    leaves: impl IntoIterator<Item = (usize, Leaf)>,
) -> Option<Vec<(usize, Source)>>
where
    G: Space<S = f64>,
{
    leaves.into_iter().map(|(input, leaf)| Some((input, source(dynamics, q, decided, leaf)?))).collect()
}

fn source<G: Space<S = f64>>(dynamics: &Dynamics<'_, G>, q: &[f64], decided: &Decided, leaf: Leaf) -> Option<Source> {
    match leaf {
        Leaf::Time => Some(Source::Time),
        Leaf::State(k) => Some(Source::State(k)),
        Leaf::Gauge { gauge, order: order @ (0 | 1) } => {
            let measured = &dynamics.mechanism.gauges[gauge];
            let [position, rate] = match measured.measured {
                Measured::Coordinate { along, .. } => [Sum::single(along.q), Sum::single(along.v)],
                // in the plane an angle is a sum of coordinates
                Measured::Angle => angle(dynamics, q, measured, dynamics.work.readings[gauge].x)?,
                _ => return None,
            };
            // what rows decide is read as exactly as they hold it
            let free = !rate.terms.iter().any(|(k, _)| decided.has(*k));
            free.then_some(if order == 0 { Source::Position(position) } else { Source::Rate(rate) })
        }
        Leaf::Gauge { .. } | Leaf::Stretch { .. } | Leaf::Spin { .. } => None,
    }
}

/// The angle between two bodies in the plane and its rate, by the turns of the joints between them.
fn angle<G: Space<S = f64>>(dynamics: &Dynamics<'_, G>, q: &[f64], gauge: &Gauge<G>, x: f64) -> Option<[Sum; 2]> {
    let mut sums = [Sum { constant: x, terms: Vec::new() }, Sum { constant: 0.0, terms: Vec::new() }];
    for &(column, sign) in &gauge.columns {
        let turn = sign * G::spin_component(dynamics.work.columns[column].w, 2);
        if turn == 0.0 {
            continue;
        }
        let coordinate = dynamics.mechanism.steps.iter().find_map(|step| match *step {
            Step::Axis { q, v, .. } if v == column => Some(q),
            _ => None,
        })?;
        sums[0].terms.push((coordinate, turn));
        sums[0].constant -= turn * q[coordinate];
        sums[1].terms.push((column, turn));
    }
    Some(sums)
}

#[cfg(test)]
mod tests {
    use super::super::Mechanical;
    use crate::geometry::Planar;
    use crate::mechanism::Coordinates;
    use crate::model::{Document, Selection};
    use crate::studies::common::case::parameters;
    use crate::studies::common::observe::Observer;
    use crate::studies::dynamics::phases::Phases;
    use grashof_solvers::{State, System};

    #[test]
    fn they_are_the_roots_by_the_places_of_bodies() {
        let text = include_str!("../../../../models/crank_rocker.yaml");
        let selection = Selection { study: Some("start-up-exact"), ..Selection::default() };
        let model = Document::read(text, "crank_rocker.yaml").unwrap().model(&selection).unwrap();
        for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
            let phases = Phases::<Planar<f64>>::new(&model, &parameters(&model), coordinates).unwrap();
            let observer = Observer::new(&model, &phases.mechanism, &phases.parameters, &[]);
            let mut system = Mechanical::new(&phases.mechanism, &phases.start, observer, Vec::new());
            let mut state = State::new(system.dims());
            assert!(state.modes.len() > 2 && system.direct.is_some(), "{coordinates:?}");
            for k in 0..5 {
                let noise = |i: usize| (2.39 * (i + 1) as f64 * f64::from(k + 1)).sin();
                state.q.iter_mut().zip(&phases.start.q).enumerate().for_each(|(i, (q, start))| *q = start + noise(i));
                state.v.iter_mut().enumerate().for_each(|(i, v)| *v = 20.0 * noise(i + 7));
                let (mut found, mut right) = (vec![0.0; system.roots.len()], vec![0.0; system.roots.len()]);
                system.roots(state.at(), &[], &[], &mut found);
                let direct = system.direct.take();
                system.roots(state.at(), &[], &[], &mut right);
                system.direct = direct;
                for (found, right) in found.iter().zip(&right) {
                    assert!((found - right).abs() < 1e-13 * (1.0 + right.abs()), "{coordinates:?}: {found} and {right}");
                }
            }
        }
    }

    #[test]
    fn columns_are_those_by_the_places_of_bodies() {
        let text = include_str!("../../../../models/crank_rocker.yaml");
        let source = text.replacen(
            "studies:",
            "studies:\n  told: { variant: motor, dynamics: { until: 1 s }, columns: [time, O.angle, O.omega, C.angle, B.omega] }",
            1,
        );
        let selection = Selection { study: Some("told"), ..Selection::default() };
        let model = Document::read(&source, "crank_rocker.yaml").unwrap().model(&selection).unwrap();
        let columns: Vec<_> = model.study.as_ref().unwrap().columns.iter().map(|column| column.value).collect();
        for coordinates in [Coordinates::Joint, Coordinates::Bounded(1), Coordinates::Cartesian] {
            let phases = Phases::<Planar<f64>>::new(&model, &parameters(&model), coordinates).unwrap();
            let observer = Observer::new(&model, &phases.mechanism, &phases.parameters, &columns);
            let mut system = Mechanical::new(&phases.mechanism, &phases.start, observer, Vec::new());
            let mut state = State::new(system.dims());
            let [mut found, mut right] = [vec![0.0; columns.len()], vec![0.0; columns.len()]];
            for k in 0..5 {
                let noise = |i: usize| (2.39 * (i + 1) as f64 * f64::from(k + 1)).sin();
                state.t = f64::from(k);
                state.q.iter_mut().zip(&phases.start.q).enumerate().for_each(|(i, (q, start))| *q = start + noise(i));
                state.v.iter_mut().enumerate().for_each(|(i, v)| *v = 20.0 * noise(i + 7));
                assert!(system.reads(&state.at()), "{coordinates:?}");
                system.columns(&state.modes, &mut found);
                system.glance(&state.at());
                system.columns(&state.modes, &mut right);
                for (found, right) in found.iter().zip(&right) {
                    assert!((found - right).abs() < 1e-13 * (1.0 + right.abs()), "{coordinates:?}: {found} and {right}");
                }
            }
        }
    }
}
