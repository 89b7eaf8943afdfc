//! Places of impacts: what happens at the zero of an event with a restitution happens as at a rigid stop.

use super::super::Stop;
use super::super::force::StretchOf;
use super::builder::Builder;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::{JointKind, Quantity, REST_SPEED};

/// Part of what the function of an event changes by over a unit of the joint's coordinate below which it counts as zero.
const SAME: f64 = 1e-9;

impl<G: Space> Builder<'_, G> {
    /// Stops along the functions of events with impacts.
    pub(super) fn impacts(&mut self) {
        for (index, event) in self.model.events.iter().enumerate() {
            let Some(restitution) = &event.restitution else { continue };
            let Some(gauge) = self.coordinate(restitution.joint, &event.place) else { continue };
            self.beside_a_stop(index, restitution.joint);
            let positions = self.pool.inputs_of(&[event.when]).iter().all(|input| {
                let quantity = self.inputs[*input as usize];
                matches!(self.gauge_of(quantity), Some((_, 0)))
            });
            let along = if positions { self.function_of(event.when, &event.place).map(StretchOf::Function) } else { None };
            let angular = !matches!(self.model.joints[restitution.joint].kind, JointKind::Slider);
            for sense in [1.0, -1.0] {
                let stop = Stop {
                    joint: restitution.joint,
                    gauge,
                    along,
                    event: Some(index),
                    angular,
                    at: 0.0,
                    sense,
                    restitution: f64::NAN,
                    rest_speed: REST_SPEED,
                };
                self.mechanism.stops.push(stop);
            }
        }
    }

    /// A fault where an event with an impact is met at a rigid stop of its joint: two restitutions for one blow.
    fn beside_a_stop(&mut self, event: usize, joint: usize) {
        let (event, joint_of) = (&self.model.events[event], &self.model.joints[joint]);
        let own = |input: &u32| match self.inputs[*input as usize] {
            Quantity::Joint { joint: of, slot: 0, order: 0 } => of == joint,
            Quantity::Angle { body, order: 0 } => joint_of.a.body == 0 && joint_of.b.body == body,
            _ => false,
        };
        let inputs = self.pool.inputs_of(&[event.when]);
        if inputs.is_empty() || !inputs.iter().all(own) {
            return;
        }
        let stops: Vec<(&str, f64)> = self
            .mechanism
            .stops
            .iter()
            .filter(|stop| stop.joint == joint && stop.event.is_none())
            .map(|stop| (stop.word(), stop.at))
            .collect();
        for (word, at) in stops {
            let [here, beside] = [at, at + 1.0].map(|x| self.value_at(event.when, x));
            if here.abs() <= SAME * (beside - here).abs() {
                let message = format!(
                    "the event `{}` is met at the {word} of joint `{}`, which has a `restitution` of its own",
                    event.name, joint_of.name
                );
                let help = "remove `restitution` here, and the event tells of the hits; or remove that end of `limits`".to_owned();
                self.fault(
                    "two-restitutions",
                    &format!("{}.restitution", event.place),
                    message,
                    "one restitution for the blows at one place",
                    Some(help),
                );
            }
        }
    }

    /// An expression where all of its inputs are x.
    fn value_at(&self, id: Id, x: f64) -> f64 {
        let program = self.pool.program(&[id], self.parameters, &self.tables);
        let inputs = vec![x; self.inputs.len()];
        let mut registers = vec![0.0; program.registers()];
        let mut modes = vec![0; program.switches().iter().max().map_or(0, |last| *last as usize + 1)];
        program.set_modes(&inputs, &mut registers, &mut modes);
        let mut out = [0.0];
        program.eval(&inputs, &modes, &mut registers, &mut out);
        out[0]
    }
}
