//! Why a value of a model is undefined.

use super::coordinates::coordinates;
use super::vocabulary::{Quantity, WORKS};
use super::whole::Model;
use super::words::{why_undefined, with_unit};
use crate::expression::{Cause, Dimension, ExternalFunction};

impl Model {
    /// Why a value is undefined: "sqrt of -0.2", "table `lift` at 0.3 m, below its range from 0.5 m to 2 m".
    #[must_use]
    pub fn why_undefined(&self, cause: Cause) -> String {
        match cause {
            Cause::Table { table, x, range: [from, to] } => {
                let (name, unit) = self.tables.get(table).map_or(("?", Dimension::NONE), |t| (t.name.as_str(), t.x));
                let shown = |x: f64| with_unit(x, unit);
                let range = format!("its range from {} to {}", shown(from), shown(to));
                // what lies beyond an end by round-off lies at the end
                match (x < from && shown(x) != shown(from), x > to && shown(x) != shown(to)) {
                    (true, _) => format!("table `{name}` at {}, below {range}", shown(x)),
                    (_, true) => format!("table `{name}` at {}, above {range}", shown(x)),
                    _ => format!("table `{name}` at {}, where {range} ends", shown(x)),
                }
            }
            Cause::External { function, x } => {
                let name = self.pool.externals().get(function).map_or("?", ExternalFunction::name);
                format!("`{name}`, which comes from outside, with the first argument {}", with_unit(x, Dimension::NONE))
            }
            Cause::Input(input) => match self.inputs.get(input as usize) {
                Some(Quantity::Functional(k)) => {
                    let text = self.study.as_ref().and_then(|s| s.functionals.get(*k)).map_or("a functional", |f| f.text.as_str());
                    format!("`{text}` is not defined")
                }
                Some(quantity) => format!("`{}` is not defined there", self.name_of(*quantity)),
                None => "a rate is not defined there".into(),
            },
            _ => why_undefined(cause),
        }
    }

    /// The name of a quantity in the model file: `crank.angle`, `crate.qx`.
    #[must_use]
    pub fn name_of(&self, quantity: Quantity) -> String {
        let axis = |k: usize| ["x", "y", "z"].get(k).copied().unwrap_or("?");
        let rate = |order: usize| ["", "v", "a"].get(order).copied().unwrap_or("?");
        let body = |k: usize| self.bodies.get(k).map_or("?", |b| b.name.as_str());
        let joint = |k: usize| self.joints.get(k).map_or("?", |j| j.name.as_str());
        let driver = |k: usize| self.drivers.get(k).map_or("?", |d| d.name.as_str());
        let spring = |k: usize| self.springs.get(k).map_or("?", |s| s.name.as_str());
        match quantity {
            Quantity::Time => "t".into(),
            Quantity::Point { at, axis: k, order } => {
                let point = self.bodies.get(at.body).and_then(|b| b.points.get(at.point)).map_or("?", |p| &*p.name);
                let point = if at.point == 0 { String::new() } else { format!(".{point}") };
                format!("{}{point}.{}{}", body(at.body), rate(order), axis(k))
            }
            Quantity::Angle { body: k, order } => format!("{}.{}", body(k), ["angle", "omega", "alpha"].get(order).unwrap_or(&"?")),
            Quantity::Spin { body: k, axis: a, order, own } => {
                format!("{}.{}{}{}", body(k), if order == 1 { "w" } else { "alpha" }, axis(a), if own { "_own" } else { "" })
            }
            Quantity::Quaternion { body: k, component, order } => {
                let name = format!("{}.q{}", body(k), ["w", "x", "y", "z"].get(component).unwrap_or(&"?"));
                (0..order).fold(name, |name, _| format!("rate({name})"))
            }
            Quantity::Joint { joint: k, slot, order } => {
                let names = self.joints.get(k).and_then(|j| coordinates(&j.kind).iter().find(|c| c.slot == slot)).map(|c| c.names);
                format!("{}.{}", joint(k), names.and_then(|n| n.get(order).copied()).unwrap_or("?"))
            }
            Quantity::Force { joint: k, axis: a } => format!("{}.f{}", joint(k), axis(a)),
            Quantity::Moment { joint: k, axis: a } => format!("{}.m{}", joint(k), axis(a)),
            Quantity::Friction { joint: k } => format!("{}.friction", joint(k)),
            Quantity::Stop { joint: k } => format!("{}.stop", joint(k)),
            Quantity::Bristle { joint: k } => format!("{}.bristle", joint(k)),
            Quantity::DriverEffort { driver: k } => format!("{}.{}", driver(k), self.effort_word(k)),
            Quantity::DriverPower { driver: k } => format!("{}.power", driver(k)),
            Quantity::CouplingEffort { coupling: k } => {
                self.couplings.get(k).map_or_else(|| "?".into(), |c| format!("{}.{}", c.name, c.effort_word()))
            }
            Quantity::Stretch { spring: k, order: 0 } => format!("{}.stretch", spring(k)),
            Quantity::Stretch { spring: k, .. } => format!("rate({}.stretch)", spring(k)),
            Quantity::SpringForce { spring: k } => format!("{}.force", spring(k)),
            Quantity::SpringEnergy { spring: k } => format!("{}.energy", spring(k)),
            Quantity::ClutchEffort { clutch: k } => {
                let clutch = self.clutches.get(k);
                let angle = clutch.and_then(|c| coordinates(&self.joints.get(c.joints[1])?.kind).first()).is_none_or(|c| c.angle);
                format!("{}.{}", clutch.map_or("?", |c| c.name.as_str()), if angle { "torque" } else { "force" })
            }
            Quantity::MotorTorque { motor } => format!("{}.torque", self.motors.get(motor).map_or("?", |m| m.name.as_str())),
            Quantity::Com { axis: k, order } => format!("com.{}{}", rate(order), axis(k)),
            Quantity::Kinetic => "energy.kinetic".into(),
            Quantity::Potential => "energy.potential".into(),
            Quantity::Momentum { axis: k } => format!("momentum.{}", axis(k)),
            Quantity::Shaking { axis: k } => format!("shaking.f{}", axis(k)),
            Quantity::ShakingMoment { axis: k } => format!("shaking.m{}", axis(k)),
            Quantity::Frame { axis: k } => format!("frame.f{}", axis(k)),
            Quantity::FrameMoment { axis: k } => format!("frame.m{}", axis(k)),
            Quantity::InertiaEq => "inertia_eq".into(),
            Quantity::InertiaEqSlope => "inertia_eq_slope".into(),
            Quantity::State(k) => self.states.get(k).map_or_else(|| "?".into(), |s| s.name.clone()),
            Quantity::Functional(k) => {
                self.study.as_ref().and_then(|s| s.functionals.get(k)).map_or_else(|| "?".into(), |f| f.text.clone())
            }
            Quantity::Result(k) => self.study.as_ref().and_then(|s| s.results.get(k)).map_or_else(|| "?".into(), |r| r.name.clone()),
            Quantity::Work(k) => WORKS[k].into(),
            Quantity::Taken(k) => self.study.as_ref().and_then(|s| s.take.get(k)).map_or_else(|| "?".into(), |t| t.name.clone()),
        }
    }

    /// `torque` or `force`, what a driver exerts.
    fn effort_word(&self, driver: usize) -> &'static str {
        let kind = self.drivers.get(driver).and_then(|d| self.joints.get(d.joint)).map(|j| &j.kind);
        let angle = kind.and_then(|kind| coordinates(kind).first()).is_none_or(|c| c.angle);
        if angle { "torque" } else { "force" }
    }
}
