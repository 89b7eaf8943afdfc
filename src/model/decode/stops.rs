//! End stops and dry friction of joints with one coordinate, as expressions of the coordinate and its rate.

use super::Decoder;
use super::checks::Rule;
use crate::expression::{Compare, Dimension, Id};
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::quantities::Coordinate;
use crate::model::scope::{Allow, Local};
use crate::model::vocabulary::Quantity;

/// Below this rate a joint sticks, rad/s or m/s, if its friction does not say another.
const STICK_SPEED: f64 = 1e-3;

/// Friction of a joint.
#[derive(Default)]
pub(super) struct Friction {
    /// `Joint::friction_force`.
    pub(super) force: Option<Id>,
    /// `Joint::friction_coefficient`.
    pub(super) coefficient: Option<(Id, Option<Id>)>,
}

impl<'n> Decoder<'n> {
    /// The coordinate (order 0) or rate (order 1) of the joint that is being read.
    fn own(&mut self, order: usize) -> Id {
        let joint = self.world.model.joints.len();
        self.world.input(&mut self.pool, Quantity::Joint { joint, slot: 0, order })
    }

    /// `limits: { from, to, stiffness, damping }` as a force on the second body. A stop pushes and never pulls:
    ///
    /// x < from: max(0, k (from − x) − c x'); x > to: min(0, k (to − x) − c x'); else 0.
    pub(super) fn limits(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>, coordinate: Option<&Coordinate>) -> Option<Id> {
        let from = self.coordinate(node, "from", at, coordinate);
        let to = self.coordinate(node, "to", at, coordinate);
        if node.get("from").is_none() && node.get("to").is_none() {
            let fault = self.fault("missing-key", at, "limits without an end", "`from` or `to`");
            fault.spot = Spot::Key;
            fault.help = Some("add `from:`, `to:` or both".to_owned());
        }
        if let (Some(from), Some(to)) = (from, to) {
            self.check(Rule::Rising, &[from, to], at);
        }
        let coordinate = coordinate?;
        let stiffness = coordinate.effort().div(coordinate.dimension(0));
        let stiffness = self.of(node, "stiffness", at, stiffness);
        self.check_key(Rule::Positive("the stiffness"), stiffness, at, "stiffness");
        let damping = self.of(node, "damping", at, coordinate.effort().div(coordinate.dimension(1)));
        self.check_key(Rule::NotNegative("the damping"), damping, at, "damping");
        let stiffness = stiffness?;
        let (x, zero) = (self.own(0), self.pool.constant(0.0));
        let drag = damping.map(|c| {
            let rate = self.own(1);
            self.pool.mul(c, rate)
        });
        let mut force = zero;
        for (end, upper) in [(to, true), (from, false)] {
            let Some(end) = end else { continue };
            let p = &mut self.pool;
            let text = format!("{} stop of joint `{name}`", if upper { "upper" } else { "lower" });
            let depth = p.sub(end, x);
            let mut push = p.mul(stiffness, depth);
            if let Some(drag) = drag {
                push = p.sub(push, drag);
                push = if upper { p.min(push, zero, &text) } else { p.max(push, zero, &text) };
            }
            let beyond = p.compare(if upper { Compare::Greater } else { Compare::Less }, x, end, &text);
            force = p.choose(beyond, push, force);
        }
        (force != zero).then_some(force)
    }

    /// `friction: { coulomb, stick_speed }`: a torque or force of a given size, or a coefficient.
    pub(super) fn friction(&mut self, name: &str, node: Node<'n>, at: &At<'_, 'n>, coordinate: Option<&Coordinate>) -> Friction {
        let none = Friction::default();
        let here = at.key("coulomb");
        let Some(coordinate) = coordinate else { return none };
        let stick = self.of(node, "stick_speed", at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), stick, at, "stick_speed");
        let Some(value) = node.get("coulomb") else { return none };
        let allow = Allow { what: "friction", ..Allow::CONSTANT };
        let Some((lowered, _)) = self.any(value, &here, allow, &mut Local::default()) else { return none };
        let coefficient = lowered.dimension == Dimension::NONE;
        if !coefficient && lowered.dimension != coordinate.effort() {
            let expected = format!("{}, or a coefficient of friction (a plain number)", Want::Of(coordinate.effort()).name());
            self.fault("wrong-dimension", &here, format!("found {}", lowered.dimension.name()), expected);
            return none;
        }
        let what = if coefficient { "the coefficient of friction" } else { "the friction" };
        self.check(Rule::NotNegative(what), &[lowered.id], &here);
        if lowered.any {
            return none;
        }
        if coefficient {
            return Friction { coefficient: Some((lowered.id, stick)), ..none };
        }
        let rate = self.own(1);
        let p = &mut self.pool;
        let stick = stick.unwrap_or_else(|| p.constant(STICK_SPEED));
        let (low, high) = (p.constant(-1.0), p.constant(1.0));
        let slip = p.div(rate, stick);
        let share = p.clamp(slip, low, high, &format!("friction of joint `{name}`"));
        let drag = p.mul(lowered.id, share);
        Friction { force: Some(p.neg(drag)), ..none }
    }
}
