//! What a study of equilibria leaves, however they were found.

use super::explain::place;
use super::rest::{Position, Rest};
use crate::geometry::Space;
use crate::kinematics::coordinates::Coordinate;
use crate::mechanism::Contact;
use crate::model::FunctionalKind;
use crate::numerics::extremum::{Extremes, Extremum};
use crate::results::{Certificate, Failure, Finding, List, Rows, Scene};
use crate::studies::common::case::Case;
use crate::studies::common::numbers::Sources;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::scene::{MECHANISM, Subject};
use crate::studies::common::watched::Watched;

/// An equilibrium as it is told.
pub(super) struct Told {
    pub(super) position: Position,
    /// Of the independent coordinates.
    pub(super) values: Vec<f64>,
    pub(super) stable: bool,
    /// `stable`, or what falls.
    pub(super) verdict: String,
}

/// What is needed to tell equilibria.
pub(super) struct Report<'r, 'a, 'm, G: Space<S = f64>> {
    pub(super) case: Case<'a>,
    pub(super) rest: &'r mut Rest<'m, G>,
    /// The independent coordinates.
    pub(super) coordinates: Vec<Coordinate>,
    /// Whether friction or a one-way clutch holds the mechanism.
    pub(super) by_friction: bool,
}

impl<G> Report<'_, '_, '_, G>
where
    G: Space<S = f64>,
{
    /// All that a study leaves; `all` begins with the equilibrium from the start, `further` are findings of the search.
    ///
    /// # Errors
    /// If a column is not defined there.
    pub(super) fn outcome(mut self, watched: &Watched, begin: &Position, all: &[Told], further: Vec<Finding>) -> Result<Outcome, Failure> {
        let case = self.case;
        let study = case.study;
        let position = &all[0].position;
        let stable = |told: &Told| if told.stable { 1.0 } else { 0.0 };
        let of_coordinate = |(i, coordinate): (usize, &Coordinate)| List {
            name: format!("equilibria.{}", coordinate.name),
            unit: if coordinate.turns { "rad".into() } else { "m".into() },
            values: all.iter().map(|told| told.values[i]).collect(),
            ..List::default()
        };
        let mut lists: Vec<List> = self.coordinates.iter().enumerate().map(of_coordinate).collect();
        lists.push(List { name: "equilibria.stable".into(), values: all.iter().map(stable).collect(), ..List::default() });
        let mut findings: Vec<Finding> = Vec::new();
        for (i, told) in all.iter().enumerate() {
            let code = if i == 0 { "equilibrium" } else { "further-equilibrium" };
            let contacts = &self.rest.system.dynamics.mechanism.contacts;
            let by = match self.by_friction {
                true if contacts.iter().all(Contact::is_one_way) => ", held by a one-way clutch",
                true => ", held by friction",
                false => "",
            };
            let place = place(case.model, &self.coordinates, &told.values) + by;
            findings.push(Finding { code: code.into(), message: format!("{place}: {}", told.verdict), path: study.place.clone() });
        }
        findings.extend(further);

        let scenes = self.scenes(begin, all);
        let row = self.row(position, watched.ids.len())?;
        let functionals: Vec<f64> = (study.functionals.iter().zip(&watched.functionals))
            .map(|(f, &c)| match f.kind {
                FunctionalKind::Integral => 0.0,
                FunctionalKind::First => {
                    if row[c] != 0.0 && !row[c].is_nan() {
                        0.0
                    } else {
                        f64::NAN
                    }
                }
                FunctionalKind::Value if f.at.is_some_and(|id| case.value(id) != 0.0) => f64::NAN,
                _ => row[c],
            })
            .collect();
        let results = vec![stable(&all[0])];
        let tables = &self.rest.system.dynamics.mechanism.tables;
        let numbers = Sources { case, tables, functionals: &functionals, results: &results, works: &[] }.numbers(true);
        findings.extend(numbers.findings);
        let blank =
            study.columns.iter().zip(&watched.columns).filter(|(column, c)| row[**c].is_nan() && !study.undefined.contains(&column.value));
        findings.extend(blank.map(|(column, _)| Finding {
            code: "blank-cells".into(),
            message: format!("`{}` is not defined at the equilibrium: its cell is blank", column.name),
            path: study.place.clone(),
        }));
        let alone = |value: f64| Extremum { value, at: 0.0, piece: 0 };
        let mut shown = Rows::new(watched.columns.len() + watched.shown.len());
        shown.push(watched.columns.iter().chain(&watched.shown).map(|&c| row[c]));
        Ok(Outcome {
            parameters: case.named(),
            independent: "time".into(),
            places: vec![0.0],
            rows: shown,
            lists,
            stopped: numbers.undefined.as_ref().map(|u| u.message.clone()),
            undefined: numbers.undefined,
            scalars: numbers.scalars,
            extremes: watched
                .columns
                .iter()
                .map(|&c| (!row[c].is_nan()).then(|| Extremes { min: alone(row[c]), max: alone(row[c]) }))
                .collect(),
            expectations: numbers.expectations,
            results,
            findings,
            certificate: Certificate { evaluations: 1, constraint: self.rest.open(position), ..Certificate::default() },
            scenes,
            ..Outcome::default()
        })
    }

    /// All outputs of the observer at a pose.
    fn row(&mut self, position: &Position, count: usize) -> Result<Vec<f64>, Failure> {
        self.rest.show(position);
        let system = &mut self.rest.system;
        let mut modes = position.modes.clone();
        system.observer.set_modes(&mut modes);
        let mut row = vec![0.0; count];
        system.columns(&modes, &mut row);
        match system.observer.undefined(&modes, &row) {
            Some(gap) => Err(Failure::Undefined(gap.explain(self.case.model, self.case.study, "the equilibrium"))),
            None => {
                row.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = f64::NAN);
                Ok(row)
            }
        }
    }

    /// The equilibrium with the start behind it, and all equilibria if there are several.
    fn scenes(&mut self, begin: &Position, all: &[Told]) -> Vec<(String, Scene)> {
        /// Poses in one drawing.
        const DRAWN: usize = 6;
        if !self.case.drawn {
            return Vec::new();
        }
        let mut bodies = |position: &Position| {
            self.rest.show(position);
            self.rest.system.dynamics.poses()
        };
        let from_start = [bodies(&all[0].position), bodies(begin)];
        let several: Vec<_> = all.iter().take(DRAWN).map(|f| bodies(&f.position)).collect();
        let subject = Subject { case: self.case, mechanism: self.rest.system.dynamics.mechanism };
        let mut scenes = vec![(MECHANISM.to_string(), subject.of_poses(&from_start))];
        if several.len() > 1 {
            scenes.push(("equilibria".into(), subject.of_poses(&several)));
        }
        scenes
    }
}

/// That only the equilibrium from the start was looked for.
pub(super) fn one_equilibrium(case: Case<'_>) -> Finding {
    Finding {
        code: "one-equilibrium".into(),
        message: "of a mechanism of many bodies further equilibria are not looked for; others may be found from other values of `start`"
            .into(),
        path: case.study.place.clone(),
    }
}

/// The joints whose friction does not count in an equilibrium.
pub(super) fn without_friction(case: Case<'_>) -> impl Iterator<Item = Finding> {
    let model = case.model;
    let held = |joint: usize| model.drivers.iter().any(|d| d.joint == joint);
    model.joints.iter().enumerate().filter(move |(i, j)| j.friction.is_some() && !held(*i)).map(|(_, joint)| {
        let message =
            format!("the friction of joint `{}` holds nothing here: with it the mechanism also rests beside this position", joint.name);
        Finding { code: "friction".into(), message, path: format!("joints.{}.friction", joint.name) }
    })
}

/// That an equilibrium is not stable.
pub(super) fn not_stable(case: Case<'_>, falls: bool, verdict: &str) -> Finding {
    let code = if falls { "unstable" } else { "indifferent" };
    Finding { code: code.into(), message: format!("the equilibrium is {verdict}"), path: case.study.place.clone() }
}
