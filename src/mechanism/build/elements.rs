//! Drivers, couplings, springs, loads and motors as rows and efforts along gauges.

use super::super::force::{Output, StretchOf};
use super::super::gauge::Measured;
use super::super::{Buffer, Contact, ContactLaw, Drive, Effort, EffortLaw, Joint, PointLoad, Rotor, Row, RowKind, RowOwner, Stop, Stretch};
use super::builder::Builder;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::{
    Attraction, AttractionLaw, ClutchLaw, CouplingKind, JointKind, Law, LoadOn, Motion, PointRef, Quantity, SpringLaw, SpringOn, Sticking,
};
use crate::scalar::Scalar;

/// The point of a body that is its centre of mass.
const COM: usize = 1;

impl<G: Space> Builder<'_, G> {
    /// Rows: cut joints, couplings, drivers.
    pub(super) fn constraints(&mut self) {
        self.cut_rows();
        for index in 0..self.model.couplings.len() {
            self.coupling(index);
        }
        for index in 0..self.model.drivers.len() {
            self.driver(index);
        }
    }

    /// Forces: springs, joint damping, loads, motors.
    pub(super) fn forces(&mut self) {
        for index in 0..self.model.springs.len() {
            self.spring(index);
        }
        for index in 0..self.model.joints.len() {
            self.joint_damping(index);
            self.joint_contact(index);
        }
        for index in 0..self.model.loads.len() {
            self.load(index);
        }
        for index in 0..self.model.motors.len() {
            self.motor(index);
        }
        for index in 0..self.model.clutches.len() {
            self.clutch(index);
        }
        for attraction in &self.model.attractions {
            self.attraction(attraction);
        }
    }

    /// The gauge of a joint's first coordinate; a fault if it has none.
    pub(super) fn coordinate(&mut self, joint: usize, place: &str) -> Option<usize> {
        let gauge = self.slot(joint, 0);
        if gauge.is_none() {
            let (name, kind) = (&self.model.joints[joint].name, self.shapes[joint].word());
            let message = format!("joint `{name}` is {kind}");
            self.fault("no-coordinate", place, message, "a joint with a coordinate", Some("name a revolute or a slider".into()));
        }
        gauge
    }

    fn coupling(&mut self, index: usize) {
        let coupling = &self.model.couplings[index];
        let place = coupling.place.as_str();
        let row = |kind, anchored, angular| Row {
            kind,
            owner: RowOwner::Coupling,
            label: coupling.name.clone(),
            offset: G::S::constant(0.0),
            anchored,
            angular,
        };
        match &coupling.kind {
            &CouplingKind::Gear { a, b, ratio } => {
                let ratio = self.number(ratio, place);
                if let (Some(first), Some(second)) = (self.coordinate(a, place), self.coordinate(b, place)) {
                    self.row(row(RowKind::Ratio { first, second, ratio }, true, true));
                }
            }
            &CouplingKind::Rack { pinion, slide, radius, .. } => {
                let ratio = self.number(radius, place);
                if let (Some(first), Some(second)) = (self.coordinate(pinion, place), self.coordinate(slide, place)) {
                    self.row(row(RowKind::Ratio { first, second, ratio }, true, false));
                }
            }
            CouplingKind::Zero(id) => {
                if let Some(function) = self.function_of(*id, place) {
                    self.row(row(RowKind::Function(function), false, false));
                }
            }
        }
    }

    fn driver(&mut self, index: usize) {
        let driver = &self.model.drivers[index];
        let place = driver.place.as_str();
        let Some(gauge) = self.coordinate(driver.joint, place) else { return };
        let t = self.input(Quantity::Time);
        let f = match driver.motion {
            Motion::Speed(speed) => self.pool.mul(speed, t),
            Motion::Position(f) => f,
            Motion::Rise { by, during, law } => self.rise(t, by, during, law),
        };
        let Some(output) = self.law_of_time(f, place) else { return };
        let speed = match driver.motion {
            Motion::Speed(speed) => Some(self.number(speed, place)),
            _ => None,
        };
        let rate = self.time[output + 1].value;
        let steady = self.pool.inputs_of(&[rate]).is_empty() && self.pool.switches_of(&[rate]).is_empty();
        let anchored = !matches!(driver.motion, Motion::Position(_));
        let turns = self.mechanism.gauges[gauge].turns();
        self.row(Row {
            kind: RowKind::Driver { gauge, driver: index },
            owner: RowOwner::Driver(index),
            label: String::new(),
            offset: G::S::constant(0.0),
            anchored,
            angular: turns,
        });
        let row = self.mechanism.rows.len() - 1;
        self.mechanism.drives.push(Drive { name: driver.name.clone(), gauge, row, output, speed, steady, turns });
    }

    /// The output of the time program that is an expression of time; its first two rates follow.
    fn law_of_time(&mut self, f: Id, place: &str) -> Option<usize> {
        let output = self.time.len();
        let mut order = f;
        for _ in 0..3 {
            self.time.push(Output { value: order, place: place.to_owned() });
            order = self.rate_by_time(order, place)?;
        }
        Some(output)
    }

    /// by · law(τ), τ = t/during held in [0, 1].
    fn rise(&mut self, t: Id, by: Id, during: Id, law: Law) -> Id {
        let p = &mut self.pool;
        let (zero, one) = (p.constant(0.0), p.constant(1.0));
        let tau = p.div(t, during);
        let tau = p.clamp(tau, zero, one, "rise");
        let shape = match law {
            Law::Cycloidal => {
                let turn = p.constant(std::f64::consts::TAU);
                let angle = p.mul(turn, tau);
                let sine = p.sin(angle);
                let wave = p.div(sine, turn);
                p.sub(tau, wave)
            }
            Law::Poly5 => {
                // ((6τ − 15) τ + 10) τ³
                let (six, fifteen, ten) = (p.constant(6.0), p.constant(15.0), p.constant(10.0));
                let a = p.mul(six, tau);
                let a = p.sub(a, fifteen);
                let a = p.mul(a, tau);
                let a = p.add(a, ten);
                let cube = p.powi(tau, 3);
                p.mul(a, cube)
            }
        };
        p.mul(by, shape)
    }

    /// Refuses a spring between the two points that a joint keeps together: it has no direction, and acts on nothing.
    fn moves_apart(&mut self, spring: &str, [a, b]: [(usize, G::Vector); 2], place: &str) {
        let same = |p: (usize, G::Vector), q: (usize, G::Vector)| p.0 == q.0 && G::dot(p.1 - q.1, p.1 - q.1).value() == 0.0;
        let pins = |joint: &&Joint<G>| {
            matches!(joint.kind, "revolute" | "spherical" | "universal" | "fixed")
                && (same(joint.a, a) && same(joint.b, b) || same(joint.a, b) && same(joint.b, a))
        };
        let Some((joint, kind)) = self.mechanism.joints.iter().find(pins).map(|joint| (joint.name.clone(), joint.kind)) else { return };
        let turning =
            if kind == "revolute" { format!("let it turn with the joint, as `{{ joint: {joint}, .. }}`") } else { "leave it out".into() };
        self.fault(
            "no-way",
            place,
            format!("joint `{joint}` keeps the two points of the spring `{spring}` together"),
            "two points that can move apart",
            Some(format!("take another point, or {turning}")),
        );
    }

    fn spring(&mut self, index: usize) {
        let spring = &self.model.springs[index];
        let place = spring.place.as_str();
        let along = match spring.on {
            SpringOn::Between(a, b) => {
                let ((a, pa), (b, pb)) = (self.at(a), self.at(b));
                self.moves_apart(&spring.name, [(a, pa), (b, pb)], place);
                Some(StretchOf::Gauge(self.gauge(a, b, Measured::Distance { pa, pb }, 0.0)))
            }
            SpringOn::Joint(joint) => self.coordinate(joint, place).map(StretchOf::Gauge),
            SpringOn::Stretch(id) => self.function_of(id, place).map(StretchOf::Function),
        };
        let Some(along) = along else { return };
        let moving = spring.rest.filter(|rest| self.is_timed(*rest));
        let rest = if moving.is_some() { 0.0 } else { self.optional(spring.rest, place) };
        let moving = match moving {
            Some(rest) => {
                let Some(output) = self.law_of_time(rest, place) else { return };
                Some(output)
            }
            None => None,
        };
        let stiffness = if let SpringLaw::Stiffness(id) = spring.law { Some(id) } else { None };
        let varies = [stiffness, spring.damping, spring.preload].into_iter().flatten().any(|id| self.is_timed(id));
        let law = if varies || moving.is_some() || matches!(spring.law, SpringLaw::Force(_)) {
            self.spring_law(index)
        } else {
            let [stiffness, damping, preload] =
                [stiffness, spring.damping, spring.preload].map(|x| G::S::constant(self.optional(x, place)));
            EffortLaw::Linear { stiffness, rest: G::S::constant(rest), damping, preload }
        };
        self.mechanism.stretches.push(Stretch { of: along, rest: G::S::constant(rest), moving });
        self.mechanism.spring_efforts.push(self.mechanism.efforts.len());
        self.mechanism.efforts.push(Effort { along, law });
    }

    /// A spring by a program: its force by the stretch with what is constant in it, its damping, and where time is in the force its
    /// derivative by that.
    fn spring_law(&mut self, index: usize) -> EffortLaw<G> {
        let spring = &self.model.springs[index];
        let zero = self.pool.constant(0.0);
        let force = match spring.law {
            SpringLaw::Force(id) => id,
            SpringLaw::Stiffness(stiffness) => {
                let stretch = self.input(Quantity::Stretch { spring: index, order: 0 });
                self.pool.mul(stiffness, stretch)
            }
            SpringLaw::None => zero,
        };
        let force = self.pool.add(force, spring.preload.unwrap_or(zero));
        let t = self.pool.inputs_of(&[force]).into_iter().find(|&input| self.inputs[input as usize] == Quantity::Time);
        let by_time = t.and_then(|t| self.slope(force, t));
        let output = self.force.len();
        let outputs = [Some(force), Some(spring.damping.unwrap_or(zero)), by_time];
        self.force.extend(outputs.into_iter().flatten().map(|value| Output { value, place: spring.place.clone() }));
        EffortLaw::Law { spring: index, output, timed: by_time.is_some() }
    }

    fn joint_damping(&mut self, index: usize) {
        let joint = &self.model.joints[index];
        let Some(damping) = joint.damping else { return };
        let place = joint.place.as_str();
        let damping = self.number(damping, place);
        let Some(gauge) = self.coordinate(index, place) else { return };
        let zero = G::S::constant(0.0);
        let law = EffortLaw::Linear { stiffness: zero, rest: zero, damping: G::S::constant(damping), preload: zero };
        self.mechanism.efforts.push(Effort { along: StretchOf::Gauge(gauge), law });
    }

    /// End stops and dry friction.
    fn joint_contact(&mut self, index: usize) {
        let joint = &self.model.joints[index];
        if let Some(limit) = &joint.limit
            && let Some(gauge) = self.coordinate(index, &joint.place)
        {
            let place = format!("{}.limits", joint.place);
            let effort = self.drive_effort(gauge, limit.force, &place);
            let ends =
                [(limit.from, 1.0), (limit.to, -1.0)].into_iter().filter_map(|(end, sense)| Some((self.number(end?, &place), sense)));
            let ends = ends.collect();
            let stiffness = self.number(limit.stiffness, &place);
            self.mechanism.buffers.push(Buffer { joint: index, effort, gauge, ends, stiffness });
        }
        if let Some(stops) = joint.stops
            && let Some(gauge) = self.coordinate(index, &joint.place)
        {
            let place = format!("{}.limits", joint.place);
            let [restitution, rest_speed] = [stops.restitution, stops.rest_speed].map(|id| self.number(id, &place));
            let angular = !matches!(joint.kind, JointKind::Slider);
            for (end, sense) in [(stops.from, 1.0), (stops.to, -1.0)] {
                if let Some(end) = end {
                    let at = self.number(end, &place);
                    let along = Some(StretchOf::Gauge(gauge));
                    self.mechanism.stops.push(Stop {
                        joint: index,
                        gauge,
                        along,
                        event: None,
                        angular,
                        at,
                        sense,
                        restitution,
                        rest_speed,
                    });
                }
            }
        }
        let mut effort = None;
        if let Some(friction) = &joint.friction
            && let Some(gauge) = self.coordinate(index, &joint.place)
        {
            let pressing = friction.pressed.map(|by| self.pressing(index, by));
            self.force.push(Output { value: friction.effort, place: format!("{}.friction", joint.place) });
            let law = EffortLaw::Friction { output: self.force.len() - 1, pressing };
            effort = Some(self.mechanism.efforts.len());
            let along = StretchOf::Gauge(gauge);
            self.mechanism.efforts.push(Effort { along, law });
            let name = format!("the friction of joint `{}`", joint.name);
            let angular = !matches!(joint.kind, JointKind::Slider);
            self.sticking((name, &format!("{}.friction", joint.place)), friction.sticking, along, angular, pressing);
        }
        self.mechanism.friction_efforts.push(effort);
    }

    fn clutch(&mut self, index: usize) {
        let clutch = &self.model.clutches[index];
        let (place, [first, second]) = (clutch.place.as_str(), clutch.joints);
        let along = if first == second {
            self.coordinate(first, place).map(StretchOf::Gauge)
        } else {
            self.function_of(clutch.slipped, place).map(StretchOf::Function)
        };
        let Some(along) = along else { return };
        let angular = !matches!(self.model.joints[second].kind, JointKind::Slider);
        let name = format!("clutch `{}`", clutch.name);
        self.mechanism.clutches.push(self.mechanism.efforts.len());
        match clutch.law {
            ClutchLaw::Friction { effort, sticking } => {
                self.force.push(Output { value: effort, place: place.to_owned() });
                let law = EffortLaw::Friction { output: self.force.len() - 1, pressing: None };
                self.mechanism.efforts.push(Effort { along, law });
                self.sticking((name, place), sticking, along, angular, None);
            }
            ClutchLaw::OneWay => {
                let none = G::S::constant(0.0);
                let law = EffortLaw::Linear { stiffness: none, rest: none, damping: none, preload: none };
                self.mechanism.efforts.push(Effort { along, law });
                let effort = self.mechanism.efforts.len() - 1;
                // the mode is given at the end, when the switches are counted
                let (place, law) = (place.to_owned(), ContactLaw::OneWay { effort });
                self.mechanism.contacts.push(Contact { name, place, along, angular, mode: usize::MAX, follow: Vec::new(), law });
            }
        }
    }

    /// What sticks by the friction that was entered last.
    fn sticking(
        &mut self,
        (name, place): (String, &str),
        sticking: Option<Sticking>,
        along: StretchOf,
        angular: bool,
        pressing: Option<usize>,
    ) {
        let Some(Sticking { sense, holds }) = sticking else { return };
        let effort = self.mechanism.efforts.len() - 1;
        self.force.push(Output { value: holds, place: place.to_owned() });
        let law = ContactLaw::Friction { effort, holds: self.force.len() - 1, pressing };
        let (place, mode) = (place.to_owned(), sense as usize);
        self.mechanism.contacts.push(Contact { name, place, along, angular, mode, follow: Vec::new(), law });
    }

    fn load(&mut self, index: usize) {
        let load = &self.model.loads[index];
        match &load.on {
            LoadOn::Point { at, force, torque, frame } => {
                let (body, at) = self.at(*at);
                let mut outputs = |ids: &[Id]| -> Vec<usize> {
                    ids.iter()
                        .map(|id| {
                            self.force.push(Output { value: *id, place: load.place.clone() });
                            self.force.len() - 1
                        })
                        .collect()
                };
                let (force, torque) = (outputs(force), outputs(torque));
                let axes = self.axes_of(*frame).map(|axes| G::rotation(&axes, 0.0));
                self.mechanism.point_loads.push(PointLoad { body, at, force, torque, frame: frame.body, axes, potential: None });
            }
            &LoadOn::Joint { joint, effort } => {
                if let Some(gauge) = self.coordinate(joint, &load.place) {
                    self.drive_effort(gauge, effort, &load.place);
                }
            }
        }
    }

    /// The weight of a body in a field of gravity, m g at its centre of mass.
    fn attraction(&mut self, attraction: &Attraction) {
        let point = PointRef { body: attraction.body, point: COM };
        let (body, at) = self.at(point);
        let mass = self.mechanism.bodies[body].mass.mass.value();
        if mass == 0.0 {
            return;
        }
        let mass = self.pool.constant(mass);
        let output = |builder: &mut Self, per_mass: Id| {
            let value = builder.pool.mul(mass, per_mass);
            builder.force.push(Output { value, place: "gravity".to_owned() });
            builder.force.len() - 1
        };
        let (field, potential) = match &attraction.law {
            AttractionLaw::Field(field) => (field.clone(), None),
            AttractionLaw::Potential(potential) => {
                let slopes = (0..G::VECTOR).filter_map(|axis| self.slope_by(*potential, Quantity::Point { at: point, axis, order: 0 }));
                (slopes.collect::<Vec<_>>().into_iter().map(|slope| self.pool.neg(slope)).collect(), Some(output(self, *potential)))
            }
        };
        let force = field.into_iter().map(|g| output(self, g)).collect();
        self.mechanism.point_loads.push(PointLoad { body, at, force, torque: Vec::new(), frame: 0, axes: None, potential });
    }

    /// The partial derivative of an expression by a quantity.
    fn slope_by(&mut self, id: Id, by: Quantity) -> Option<Id> {
        match self.inputs.iter().position(|quantity| *quantity == by) {
            Some(input) => self.slope(id, input as u32),
            None => Some(self.pool.constant(0.0)),
        }
    }

    fn motor(&mut self, index: usize) {
        let motor = &self.model.motors[index];
        let place = motor.place.as_str();
        let Some(gauge) = self.coordinate(motor.joint, place) else { return };
        let effort = motor.torque.map(|torque| self.drive_effort(gauge, torque, place));
        self.mechanism.motor_efforts.push(effort);
        if let Some(inertia) = motor.inertia {
            let inertia = self.number(inertia, place);
            let gear = motor.gear.map_or(1.0, |g| self.number(g, place));
            self.mechanism.rotors.push(Rotor { gauge, inertia: G::S::constant(gear * gear * inertia) });
        }
    }

    /// First-order states: where they begin, and their rates; those of bristles follow those of the model.
    pub(super) fn states(&mut self) {
        for state in &self.model.states {
            let start = self.number(state.start, &state.place);
            self.mechanism.state_starts.push(start);
            self.states.push(Output { value: state.rate, place: state.place.clone() });
        }
        for joint in &self.model.joints {
            let bristle = joint.friction.as_ref().and_then(|f| f.bristle);
            self.mechanism.bristles.push(bristle.map(|_| self.mechanism.state_starts.len()));
            if let Some(bristle) = bristle {
                self.mechanism.state_starts.push(0.0);
                self.states.push(Output { value: bristle.rate, place: format!("{}.friction", joint.place) });
            }
        }
    }

    fn drive_effort(&mut self, gauge: usize, size: Id, place: &str) -> usize {
        self.force.push(Output { value: size, place: place.to_owned() });
        let law = EffortLaw::Drive { output: self.force.len() - 1 };
        self.mechanism.efforts.push(Effort { along: StretchOf::Gauge(gauge), law });
        self.mechanism.efforts.len() - 1
    }
}
