//! End stops of joints with one coordinate: with stiffness, as an expression of the coordinate and its rate, or rigid.

use super::decoder::Decoder;
use crate::expression::{Compare, Id};
use crate::model::contacts::{Limit, Stops};
use crate::model::coordinates::Coordinate;
use crate::model::coordinates::wanted_of;
use crate::model::fault::{At, Spot};
use crate::model::fields::{COORDINATE, DAMPING, NUMBER, RATE, STIFFNESS, one_of};
use crate::model::keys::keys;
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::vocabulary::Quantity;

/// A rebound below this rate counts as rest, rad/s or m/s, if the limits do not say another.
pub(crate) const REST_SPEED: f64 = 1e-3;

keys! {
    /// Limits.
    pub(super) LIMITS = LimitsKeys "limits" [one_of(&["stiffness", "restitution"])] {
        from: may COORDINATE, "Lower end.";
        to: may COORDINATE, "Upper end.";
        stiffness: may STIFFNESS, "Stiffness of the stop, in N/m or N m/rad.";
        damping: may DAMPING, "Damping of the stop, which never pulls; 0 if omitted.";
        restitution: may NUMBER, "Of a rigid stop: speed after an impact by speed before it, 0 to 1.";
        rest_speed: may RATE, "A rebound from a rigid stop below this speed counts as rest; 1 mm/s or 1e-3 rad/s if omitted.";
    }
}

impl<'n> Decoder<'n> {
    /// The coordinate (order 0) or rate (order 1) of the joint that is being read.
    pub(super) fn own(&mut self, order: usize) -> Id {
        let joint = self.name_space.model.joints.len();
        self.name_space.input(&mut self.pool, Quantity::Joint { joint, slot: 0, order })
    }

    /// `limits: { from, to, .. }`: stops with stiffness as a force on the second body, or rigid ones.
    pub(super) fn limits(
        &mut self,
        name: &str,
        node: Node<'n>,
        at: &At<'_, 'n>,
        coordinate: Option<&Coordinate>,
    ) -> (Option<Limit>, Option<Stops>) {
        let keys = LimitsKeys::of(node);
        let from = self.read_as(keys.from, at, wanted_of(coordinate));
        let to = self.read_as(keys.to, at, wanted_of(coordinate));
        if !keys.from.given() && !keys.to.given() {
            let fault = self.fault("missing-key", at, "limits without an end", "`from` or `to`");
            fault.spot = Spot::Key;
            fault.help = Some("add `from:`, `to:` or both".to_owned());
        }
        if let (Some(from), Some(to)) = (from, to) {
            self.check(Rule::Rising, &[from, to], at);
        }
        let Some(coordinate) = coordinate else { return (None, None) };
        if keys.restitution.given() {
            return (None, self.rigid([from, to], keys, at, coordinate));
        }
        if keys.rest_speed.given() {
            let fault = self.fault(
                "unknown-key",
                &at.key(keys.rest_speed),
                "`rest_speed` beside `stiffness`",
                "an option of rigid stops, which have a `restitution`",
            );
            fault.spot = Spot::Key;
            fault.help = Some("remove it".to_owned());
        }
        (self.buffer(name, [from, to], keys, at, coordinate), None)
    }

    /// `restitution`, `rest_speed`.
    fn rigid(&mut self, [from, to]: [Option<Id>; 2], keys: LimitsKeys<'n>, at: &At<'_, 'n>, coordinate: &Coordinate) -> Option<Stops> {
        if keys.damping.given() {
            let fault =
                self.fault("unknown-key", &at.key(keys.damping), "`damping` beside `restitution`", "an option of stops with `stiffness`");
            fault.spot = Spot::Key;
            fault.help = Some("remove it: a blow loses energy by its `restitution`".to_owned());
        }
        let restitution = self.read(keys.restitution, at);
        self.check_key(Rule::Within(0.0, 1.0, "the restitution"), restitution, at, keys.restitution);
        let rest = self.read_of(keys.rest_speed, at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), rest, at, keys.rest_speed);
        let rest_speed = rest.unwrap_or_else(|| self.pool.constant(REST_SPEED));
        Some(Stops { from, to, restitution: restitution?, rest_speed })
    }

    /// `stiffness`, `damping`. A stop pushes and never pulls:
    ///
    /// x < from: max(0, k (from − x) − c x'); x > to: min(0, k (to − x) − c x'); else 0.
    fn buffer(
        &mut self,
        name: &str,
        [from, to]: [Option<Id>; 2],
        keys: LimitsKeys<'n>,
        at: &At<'_, 'n>,
        coordinate: &Coordinate,
    ) -> Option<Limit> {
        let stiffness = coordinate.effort().div(coordinate.dimension(0));
        let stiffness = self.read_of(keys.stiffness, at, stiffness);
        self.check_key(Rule::Positive("the stiffness"), stiffness, at, keys.stiffness);
        let damping = self.read_of(keys.damping, at, coordinate.effort().div(coordinate.dimension(1)));
        self.check_key(Rule::NotNegative("the damping"), damping, at, keys.damping);
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
        (force != zero).then_some(Limit { force, from, to, stiffness })
    }
}
