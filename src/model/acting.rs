//! Quantities of what acts on a mechanism: drivers, couplings, springs, motors, clutches.

use super::entities::{CouplingKind, SpringOn};
use super::needs::Needs;
use super::quantities::{Found, NameSpace, silent};
use super::vocabulary::Quantity;
use crate::expression::{Dimension, Id, Pool, Symbol, Unknown};

impl NameSpace<'_> {
    pub(super) fn of_driver(&self, driver: usize, name: &str, rest: &str) -> Result<Found, Unknown> {
        let angle = self.single(self.model.drivers[driver].joint).is_none_or(|c| c.angle);
        match (rest, angle) {
            ("torque", true) => Ok(Found::Leaf(Quantity::DriverEffort { driver }, Dimension::TORQUE)),
            ("force", false) => Ok(Found::Leaf(Quantity::DriverEffort { driver }, Dimension::FORCE)),
            ("power", _) => Ok(Found::Leaf(Quantity::DriverPower { driver }, Dimension::POWER)),
            _ => Err(self.wrong(name, rest, &[if angle { "torque" } else { "force" }.to_owned(), "power".to_owned()])),
        }
    }

    pub(super) fn of_spring(&self, spring: usize, name: &str, rest: &str) -> Result<Found, Unknown> {
        let Some(stretch) = self.stretches.get(spring).copied().flatten() else { return Err(silent()) };
        match rest {
            "stretch" => Ok(Found::Leaf(Quantity::Stretch { spring, order: 0 }, stretch)),
            "force" => Ok(Found::Leaf(Quantity::SpringForce { spring }, Dimension::ENERGY.div(stretch))),
            "energy" => Ok(Found::Leaf(Quantity::SpringEnergy { spring }, Dimension::ENERGY)),
            _ => Err(self.wrong(name, rest, &["stretch".to_owned(), "force".to_owned(), "energy".to_owned()])),
        }
    }

    pub(super) fn of_motor(&mut self, pool: &mut Pool, motor: usize, name: &str, rest: &str) -> Result<Found, Unknown> {
        let joint = self.model.motors[motor].joint;
        let coordinate = |order| Quantity::Joint { joint, slot: 0, order };
        match rest {
            "angle" => Ok(Found::Leaf(coordinate(0), Dimension::ANGLE)),
            "omega" => Ok(Found::Leaf(coordinate(1), Dimension::ANGULAR_SPEED)),
            "torque" => Ok(Found::Leaf(Quantity::MotorTorque { motor }, Dimension::TORQUE)),
            "power" => {
                let (torque, omega) = (self.input(pool, Quantity::MotorTorque { motor }), self.input(pool, coordinate(1)));
                let reach = Needs::of(Quantity::MotorTorque { motor });
                Ok(Found::Made(Symbol { id: pool.mul(torque, omega), dimension: Dimension::POWER }, reach))
            }
            _ => Err(self.wrong(name, rest, &["angle", "omega", "torque", "power"].map(str::to_owned))),
        }
    }

    pub(super) fn of_clutch(&mut self, pool: &mut Pool, clutch: usize, name: &str, rest: &str) -> Result<Found, Unknown> {
        let joint = self.model.clutches[clutch].joints[1];
        let Some(coordinate) = self.single(joint) else { return Err(silent()) };
        let effort = if coordinate.angle { "torque" } else { "force" };
        match rest {
            "slip" => {
                let rate = self.slip(pool, clutch, 1);
                Ok(Found::Made(
                    Symbol { id: rate, dimension: coordinate.dimension(1) },
                    Needs::of(Quantity::Joint { joint, slot: 0, order: 1 }),
                ))
            }
            _ if rest == effort => Ok(Found::Leaf(Quantity::ClutchEffort { clutch }, coordinate.effort())),
            _ => Err(self.wrong(name, rest, &["slip".to_owned(), effort.to_owned()])),
        }
    }

    /// What a coupling exerts along its second coordinate or its expression, and what it carries over to the former.
    pub(super) fn of_coupling(&mut self, pool: &mut Pool, coupling: usize, name: &str, rest: &str) -> Result<Found, Unknown> {
        let (along, effort) = (self.model.couplings[coupling].along, self.model.couplings[coupling].effort_word());
        let second = match self.model.couplings[coupling].kind {
            CouplingKind::Gear { b, .. } => Some(b),
            CouplingKind::Rack { slide, .. } => Some(slide),
            CouplingKind::Zero(_) => None,
        };
        let quantity = Quantity::CouplingEffort { coupling };
        match (rest, second) {
            ("power", Some(joint)) => {
                let (effort, rate) = (self.input(pool, quantity), self.input(pool, Quantity::Joint { joint, slot: 0, order: 1 }));
                Ok(Found::Made(Symbol { id: pool.mul(effort, rate), dimension: Dimension::POWER }, Needs::of(quantity)))
            }
            _ if rest == effort => Ok(Found::Leaf(quantity, Dimension::ENERGY.div(along))),
            _ => Err(self.wrong(name, rest, &[effort, "power"].map(str::to_owned)[..if second.is_some() { 2 } else { 1 }])),
        }
    }

    /// The coordinate of a clutch (`order` 0) or its rate (1).
    pub(crate) fn slip(&mut self, pool: &mut Pool, clutch: usize, order: usize) -> Id {
        let [first, second] = self.model.clutches[clutch].joints;
        let mut of = |joint| self.input(pool, Quantity::Joint { joint, slot: 0, order });
        let second_one = of(second);
        if first == second {
            return second_one;
        }
        let first_one = of(first);
        pool.sub(second_one, first_one)
    }

    /// Dimension of a spring's stretch, from what it measures; a general expression brings its own.
    pub(crate) fn stretch_dimension(&self, on: &SpringOn) -> Option<Dimension> {
        match on {
            SpringOn::Between(..) => Some(Dimension::LENGTH),
            SpringOn::Joint(joint) => self.single(*joint).map(|c| c.dimension(0)),
            SpringOn::Stretch(_) => None,
        }
    }
}
