//! Dry friction of joints with one coordinate, as expressions of the rate and of the state of bristles.

use super::decoder::Decoder;
use crate::expression::{Compare, Dimension, Id};
use crate::model::contacts::{Bristle, Friction, Pressure, Sticking};
use crate::model::coordinates::Coordinate;
use crate::model::entities::JointKind;
use crate::model::fault::{At, Spot};
use crate::model::fields::{BRISTLE_DAMPING, BRISTLE_STIFFNESS, FRICTION_LEVEL, LENGTH, RATE, Shape, Want};
use crate::model::keys::keys;
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::vocabulary::Quantity;

/// Speeds of Stribeck up to which the higher friction at rest counts.
const SEEN: f64 = 6.0;

/// What a friction is measured in, and how much of it resists a motion.
struct Level {
    /// `coulomb` is a plain number.
    coefficient: bool,
    /// Effort, or none of a coefficient.
    dimension: Dimension,
    /// `coulomb`.
    coulomb: Id,
    /// coulomb, or with `static` coulomb + (static − coulomb) exp(−(x'/stribeck_speed)²).
    resists: Id,
}

keys! {
    /// Friction.
    pub(super) FRICTION = FrictionKeys "friction" [] {
        coulomb: need FRICTION_LEVEL, "Torque or force of the friction; a plain number is a coefficient of friction.";
        highest("static"): may FRICTION_LEVEL, "The same at rest, where it is higher; falls to `coulomb` over `stribeck_speed`.";
        stribeck_speed: may RATE, "Speed over which the friction falls from `static` to `coulomb`.";
        stick_speed: may RATE, "Friction in proportion to the speed below this one, instead of sticking.";
        radius: may LENGTH, "Radius of the pin, with a coefficient of friction in a `revolute`.";
        length: may LENGTH, "Length of the guide, with a coefficient of friction in a `slider`: the moment presses on its ends.";
        bristle: may Shape::Map(&BRISTLE), "Bristles that bend before the joint slides (LuGre), in place of `stick_speed`.";
    }
}

keys! {
    /// A bristle.
    BRISTLE = BristleKeys "a bristle" [] {
        stiffness: need BRISTLE_STIFFNESS, "Stiffness of the bristles.";
        damping: may BRISTLE_DAMPING, "Damping of the bristles; 0 if omitted.";
    }
}

impl<'n> Decoder<'n> {
    /// `friction` of the joint that is being read.
    pub(super) fn friction(
        &mut self,
        (name, kind): (&str, &JointKind),
        node: Node<'n>,
        at: &At<'_, 'n>,
        coordinate: Option<&Coordinate>,
    ) -> Option<Friction> {
        let coordinate = coordinate?;
        let keys = FrictionKeys::of(node);
        let stick = self.read_of(keys.stick_speed, at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), stick, at, keys.stick_speed);
        let level = self.level(keys, at, coordinate);
        let (pressed, arm) = self.pressed(kind, keys, at, level.as_ref().map(|l| l.coefficient));
        let level = level?;
        let rate = self.own(1);
        let text = format!("friction of joint `{name}`");
        let mut sense = None;
        let (resists, bristle) = match keys.bristle.node {
            Some(inner) => {
                if keys.stick_speed.given() {
                    let key = at.key(keys.stick_speed);
                    let fault =
                        self.fault("unknown-key", &key, "`stick_speed` beside `bristle`", "one of the two: bristles stick by themselves");
                    fault.spot = Spot::Key;
                    fault.help = Some("remove `stick_speed`".to_owned());
                }
                let (resists, bristle) = self.bristle(name, BristleKeys::of(inner), &at.key(keys.bristle), coordinate, &level)?;
                (resists, Some(bristle))
            }
            None => {
                let share;
                (share, sense) = self.share(rate, keys.stick_speed.given(), stick, &text);
                (self.pool.mul(level.resists, share), None)
            }
        };
        let p = &mut self.pool;
        let mut whole = |resists| arm.map_or(resists, |arm| p.mul(arm, resists));
        let (resists, holds) = (whole(resists), whole(level.resists));
        let sticking = sense.map(|sense| Sticking { sense, holds });
        Some(Friction { effort: p.neg(resists), pressed, sticking, bristle })
    }

    /// `coulomb`, `static`, `stribeck_speed`.
    fn level(&mut self, keys: FrictionKeys<'n>, at: &At<'_, 'n>, coordinate: &Coordinate) -> Option<Level> {
        let here = at.key(keys.coulomb);
        let allow = Allow { what: "friction", ..Allow::CONSTANT };
        let speed = self.read_of(keys.stribeck_speed, at, coordinate.dimension(1));
        self.check_key(Rule::Positive("the speed"), speed, at, keys.stribeck_speed);
        for (one, other) in [(keys.highest, keys.stribeck_speed), (keys.stribeck_speed, keys.highest)] {
            if one.given() && !other.given() {
                let (key, other) = (one.key(), other.key());
                let fault = self.fault("missing-key", at, format!("`{key}` without `{other}`"), "both of them, or none");
                fault.spot = Spot::Key;
                fault.help = Some(format!("add `{other}:`"));
            }
        }
        let (lowered, _) = self.any(keys.coulomb.node?, &here, allow, &mut Local::default())?;
        let coefficient = lowered.dimension == Dimension::NONE;
        if !coefficient && lowered.dimension != coordinate.effort() {
            let expected = format!("{}, or a coefficient of friction (a plain number)", Want::Of(coordinate.effort()).name());
            let written = coordinate.effort().written("1");
            self.fault("wrong-dimension", &here, format!("found {}", lowered.dimension.name()), expected).help =
                Some(format!("give it as `{written}`, or as a number such as `0.2`"));
            return None;
        }
        let what = if coefficient { "the coefficient of friction" } else { "the friction" };
        let rule = if keys.bristle.given() { Rule::Positive(what) } else { Rule::NotNegative(what) };
        self.check(rule, &[lowered.id], &here);
        let dimension = if coefficient { Dimension::NONE } else { coordinate.effort() };
        let highest = self.read_of(keys.highest, at, dimension);
        if lowered.any {
            return None;
        }
        let (coulomb, mut resists) = (lowered.id, lowered.id);
        if let (Some(highest), Some(speed)) = (highest, speed) {
            let rate = self.own(1);
            let above;
            (resists, above) = self.falling(coulomb, highest, (rate, speed), "the Stribeck speed of a joint");
            self.check_key(Rule::NotNegative("`static` less `coulomb`"), Some(above), at, keys.highest);
        }
        Some(Level { coefficient, dimension, coulomb, resists })
    }

    /// coulomb + (static − coulomb) exp(−(x'/speed)²), and static − coulomb. Beyond six times the speed the exponential is below the
    /// rounding and is left out: the switch there keeps steps from passing the whole of it unseen.
    pub(super) fn falling(&mut self, coulomb: Id, highest: Id, (rate, speed): (Id, Id), text: &str) -> (Id, Id) {
        let p = &mut self.pool;
        let above = p.sub(highest, coulomb);
        let part = p.div(rate, speed);
        let square = p.powi(part, 2);
        let exponent = p.neg(square);
        let falling = p.exp(exponent);
        let more = p.mul(above, falling);
        let (zero, end) = (p.constant(0.0), p.constant(SEEN * SEEN));
        let near = p.compare(Compare::Less, square, end, text);
        let more = p.choose(near, more, zero);
        (p.add(coulomb, more), above)
    }

    /// What bears the normal force, and the arm of the friction: `radius` of a pin, `length` of a guide; `coefficient` is known of a
    /// friction that is sound.
    fn pressed(
        &mut self,
        kind: &JointKind,
        keys: FrictionKeys<'n>,
        at: &At<'_, 'n>,
        coefficient: Option<bool>,
    ) -> (Option<Pressure>, Option<Id>) {
        let [radius, length] = [(keys.radius, "the radius"), (keys.length, "the length")].map(|(entry, what)| {
            let id = self.read(entry, at);
            self.check_key(Rule::Positive(what), id, at, entry);
            id
        });
        let Some(coefficient) = coefficient else { return (None, None) };
        let (pin, guide) = (matches!(kind, JointKind::Revolute), matches!(kind, JointKind::Slider));
        for (entry, may, of) in [(keys.radius, pin, "the pin of a `revolute`"), (keys.length, guide, "the guide of a `slider`")] {
            if entry.given() && !(may && coefficient) {
                let key = entry.key();
                let fault = self.fault(
                    "unknown-key",
                    &at.key(entry),
                    format!("`{key}` in this friction"),
                    format!("`{key}` belongs to {of} with a coefficient of friction"),
                );
                fault.spot = Spot::Key;
                fault.help = Some("remove it".to_owned());
            }
        }
        if !coefficient {
            return (None, None);
        }
        if pin && !keys.radius.given() {
            let fault = self.fault(
                "missing-key",
                at,
                "a coefficient of friction in a `revolute` without `radius`",
                "the radius of the pin, at which the friction acts",
            );
            fault.spot = Spot::Key;
            fault.help = Some("add `radius: 5 mm`, or give `coulomb` as a torque, as `2 N m`".to_owned());
        }
        if !pin && !guide {
            let fault = self.fault(
                "wrong-joint",
                &at.key(keys.coulomb),
                "a coefficient of friction in a `screw`",
                "a torque: how the load of a screw presses on its thread depends on its profile",
            );
            fault.help = Some("give `coulomb` a unit, as `coulomb: 2 N m`".to_owned());
        }
        if guide { (Some(Pressure::Guide { length }), None) } else { (Some(Pressure::Pin), radius) }
    }

    /// What is left of the largest friction: clamp(x'/stick_speed, −1, 1), or sign(x') by a switch of its own, which is told.
    pub(super) fn share(&mut self, rate: Id, smooth: bool, stick: Option<Id>, text: &str) -> (Id, Option<u32>) {
        let p = &mut self.pool;
        match stick {
            Some(stick) => {
                let (low, high) = (p.constant(-1.0), p.constant(1.0));
                let slip = p.div(rate, stick);
                (p.clamp(slip, low, high, text), None)
            }
            // a stick speed with a fault of its own
            None if smooth => (p.constant(0.0), None),
            None => {
                let (share, sense) = p.own_sign(rate, text);
                (share, Some(sense))
            }
        }
    }

    /// `bristle: { stiffness, damping }`: with the state y = σ₀ z/F, F being `coulomb` and z the deflection,
    ///
    /// y' = (σ₀/F) (x' − |x'| y F/g),   resists = σ₀ z + σ₁ z' = F y + (F σ₁/σ₀) y'.
    fn bristle(
        &mut self,
        name: &str,
        keys: BristleKeys<'n>,
        at: &At<'_, 'n>,
        coordinate: &Coordinate,
        level: &Level,
    ) -> Option<(Id, Bristle)> {
        let stiffness = self.read_of(keys.stiffness, at, level.dimension.div(coordinate.dimension(0)));
        self.check_key(Rule::Positive("the stiffness"), stiffness, at, keys.stiffness);
        let damping = self.read_of(keys.damping, at, level.dimension.div(coordinate.dimension(1)));
        self.check_key(Rule::NotNegative("the damping"), damping, at, keys.damping);
        let rate = self.own(1);
        let joint = self.name_space.model.joints.len();
        let y = self.name_space.input(&mut self.pool, Quantity::Bristle { joint });
        let p = &mut self.pool;
        let deflection = p.div(level.coulomb, stiffness?);
        let speed = p.abs(rate, &format!("friction of joint `{name}`"));
        let part = p.div(level.coulomb, level.resists);
        let part = p.mul(part, y);
        let back = p.mul(speed, part);
        let net = p.sub(rate, back);
        let bends = p.div(net, deflection);
        let mut resists = p.mul(level.coulomb, y);
        if let Some(damping) = damping {
            let drag = p.mul(damping, net);
            resists = p.add(resists, drag);
        }
        Some((resists, Bristle { rate: bends, deflection }))
    }
}
