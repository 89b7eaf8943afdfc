//! `kinematics` and `inverse`: motion over a range that drivers prescribe.

use super::contract::{Declared, Features};
use crate::expression::{self, Dimension, Id};
use crate::model::coordinates::{self, Coordinate};
use crate::model::decode::decoder::Decoder;
use crate::model::entities::LoadOn;
use crate::model::fault::{At, Spot};
use crate::model::fields::{MOST_SAMPLES, Shape, Want};
use crate::model::keys::{Entry, keys};
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::study::{Kind, Over, Range};
use crate::model::vocabulary::Quantity;

/// What `over` takes.
pub(super) const OVER: Shape = Shape::Value(Want::Varies("an angle or a length of the one driver, or a time"));
/// What `samples` takes.
pub(super) const SAMPLES: Shape = Shape::Count(1, MOST_SAMPLES);

keys! {
    /// `kinematics` and `inverse`.
    TABLE = RangeKeys "a range" [] {
        over: need OVER, "Range: of the one driver from its start, or a time.";
        samples: need SAMPLES, "Number of equal intervals; one row more.";
    }
}

pub(super) const KINEMATICS: Declared =
    Declared::new("kinematics", &TABLE, "Positions, velocities and accelerations over a range.", |decoder, node, at| {
        let keys = RangeKeys::of(node);
        let (range, features) = decoder.range(keys.over, keys.samples, at)?;
        let results = vec![("turns_fully".to_owned(), Dimension::NONE)];
        Some((Kind::Kinematics(range), Features { results, ..features }))
    });

pub(super) const INVERSE: Declared =
    Declared::new("inverse", &TABLE, "Kinematics with driver efforts and reactions.", |decoder, node, at| {
        let keys = RangeKeys::of(node);
        let range = decoder.range(keys.over, keys.samples, at);
        decoder.no_states_in_loads(at);
        let (range, features) = range?;
        Some((Kind::Inverse(range), Features { reactions: true, ..features }))
    });

impl<'n> Decoder<'n> {
    /// `over` and `samples`: the range, and what a study over it offers without reactions.
    pub(super) fn range(&mut self, over: Entry<'n>, samples: Entry<'n>, at: &At<'_, 'n>) -> Option<(Range, Features)> {
        let offers =
            |independent, first| Features { independent: Some(independent), first, reactions: false, states: false, ..Features::WHOLE };
        let samples = samples.count()?;
        let over_at = at.key(over);
        let over = over.node?;
        let before = self.faults.len();
        let Some((lowered, _)) = self.any(over, &over_at, Allow { what: "`over`", ..Allow::CONSTANT }, &mut Local::default()) else {
            for fault in self.faults.iter_mut().skip(before).filter(|fault| fault.code == "wrong-level") {
                let help =
                    "it is how far the driven coordinate goes on from its start, such as `1 turn`, or a time; `start` says from where";
                fault.help = Some(help.to_owned());
            }
            return None;
        };
        if lowered.dimension == Dimension::TIME {
            self.check(Rule::Positive("the time"), &[lowered.id], &over_at);
            return Some((Range { over: Over::Time(lowered.id), samples }, offers(Dimension::TIME, None)));
        }
        let [driver] = &self.name_space.model.drivers[..] else {
            let n = self.name_space.model.drivers.len();
            let all = &self.name_space.model.drivers;
            let twice = all.iter().enumerate().any(|(i, driver)| all[..i].iter().any(|other| other.joint == driver.joint));
            // a faulty driver was reported already, and so were two of one joint
            if self.section("drivers").len() == n && !twice {
                let message = format!("the range of one driver, but the mechanism has {n} driver{}", if n == 1 { "" } else { "s" });
                let freedom = self.freedom_by_count();
                let help = match n {
                    0 => "add a driver, or give a time such as `2 s`".to_owned(),
                    _ if freedom < n => format!(
                        "remove drivers: by Grübler's count the joints leave {freedom} degree{} of freedom",
                        if freedom == 1 { "" } else { "s" }
                    ),
                    _ => "give a time such as `2 s`".to_owned(),
                };
                self.fault("no-driver", &over_at, message, "one driver, or a time").help = Some(help);
            }
            return None;
        };
        let joint = driver.joint;
        let coordinate: &'static Coordinate = self.name_space.single(joint)?;
        let dimension = coordinate.dimension(0);
        let want = if coordinate.angle { Want::Angle } else { Want::Of(dimension) };
        if let Err(found) = lowered.expect(dimension) {
            let message = format!("found {found}");
            let of = if coordinate.angle { "such as `1 turn`" } else { "such as `10 cm`" };
            self.fault("wrong-dimension", &over_at, message, format!("{} of the driver, or a time (s)", want.name())).help = Some(
                over.text()
                    .and_then(expression::meant_fraction)
                    .unwrap_or_else(|| format!("say how far the driver goes, {of}, or for how long, such as `2 s`")),
            );
            return None;
        }
        self.fits(&lowered, want, over, None, &over_at);
        self.check(Rule::NotZero("the range"), &[lowered.id], &over_at);
        let path = format!("{}.{}", self.name_space.model.joints[joint].name, coordinate.names[0]);
        Some((Range { over: Over::Driver(lowered.id), samples }, offers(dimension, Some(path))))
    }

    /// Freedoms of the bodies less what joints and couplings take; less than the true number where some of those are redundant.
    fn freedom_by_count(&self) -> usize {
        let model = &self.name_space.model;
        let whole = if self.name_space.components() == 2 { 3 } else { 6 };
        let taken: usize = model.joints.iter().map(|joint| whole - coordinates::freedom(&joint.kind, whole)).sum();
        (whole * (model.bodies.len() - 1)).saturating_sub(taken + model.couplings.len())
    }

    /// Loads by first-order states are known in motion in time alone.
    fn no_states_in_loads(&mut self, at: &At<'_, 'n>) {
        let model = &self.name_space.model;
        let state_in = |ids: &[Id]| {
            self.pool.inputs_of(ids).into_iter().find_map(|input| match model.inputs[input as usize] {
                Quantity::State(i) => Some(model.states[i].name.clone()),
                _ => None,
            })
        };
        let found = model.loads.iter().find_map(|load| {
            let state = match &load.on {
                LoadOn::Point { force, torque, .. } => state_in(&[&force[..], &torque[..]].concat()),
                LoadOn::Joint { effort, .. } => state_in(&[*effort]),
            };
            Some((load.name.clone(), state?))
        });
        if let Some((load, state)) = found {
            let message = format!("the load `{load}` needs the state `{state}`");
            let fault = self.fault("wrong-level", at, message, "`inverse` follows no states");
            fault.spot = Spot::Key;
            fault.help = Some("use `dynamics`, which computes motion in time, or remove the load in a variant".to_owned());
        }
    }
}
