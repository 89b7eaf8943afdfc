//! Expressions as programs: which gauge or rate each input is, derivatives of functions and drivers, and the final assembly.

use super::super::force::{EffortLaw, Leaf, Output, StagedProgram};
use super::super::gauge::Measured;
use super::super::{Function, Mechanism};
use super::builder::Builder;
use crate::expression::{Id, Pool};
use crate::geometry::{Space, basis};
use crate::model::{Dimensions, Model, Quantity};
use std::sync::Arc;

impl<'m, G: Space> Builder<'m, G> {
    pub(super) fn new(model: &'m Model, parameters: &'m [f64]) -> Self {
        let none = || StagedProgram {
            program: Pool::new().program(&[], &[], &Arc::from([])),
            fills: vec![],
            inputs: 0,
            outputs: 0,
            places: vec![],
        };
        let mut builder = Self {
            model,
            parameters,
            planar: model.space == Dimensions::Planar,
            honour_cuts: true,
            mechanism: Mechanism {
                bodies: vec![],
                nodes: vec![],
                groups: vec![],
                group_of: vec![],
                steps: vec![],
                nq: 0,
                nv: 0,
                above: vec![],
                joints: vec![],
                joint_of_node: vec![],
                gauges: vec![],
                active_gauges: 0,
                rows: vec![],
                functions: vec![],
                drives: vec![],
                stretches: vec![],
                starts: vec![],
                orientations: vec![],
                efforts: vec![],
                spring_efforts: vec![],
                motor_efforts: vec![],
                pressings: vec![],
                friction_efforts: vec![],
                bristles: vec![],
                buffers: vec![],
                stops: vec![],
                contacts: vec![],
                clutches: vec![],
                rotors: vec![],
                point_loads: vec![],
                position_program: none(),
                velocity_program: none(),
                time_program: none(),
                force_program: none(),
                spring_laws: vec![],
                state_program: none(),
                state_starts: vec![],
                tables: Arc::from([]),
                gravity: G::Vector::default(),
                switches: 0,
                windings: 0,
            },
            shapes: vec![],
            particles: vec![],
            slots: vec![],
            slot_measures: vec![],
            signs: vec![None; model.bodies.len()],
            pool: model.pool.clone(),
            inputs: model.inputs.clone(),
            tables: Arc::from([]),
            position: vec![],
            velocity: vec![],
            time: vec![],
            force: vec![],
            states: vec![],
            faults: vec![],
        };
        let gravity = builder.triple(&model.gravity, "gravity");
        builder.mechanism.gravity = G::vector(&gravity);
        builder
    }

    /// Makes the gauges that the inputs of programs are read from, so that they count among the active ones.
    pub(super) fn gauges_of_programs(&mut self) {
        let outputs = [&self.position, &self.velocity, &self.time, &self.force, &self.states].map(|of| self.pool.inputs_of(&ids(of)));
        for input in outputs.into_iter().flatten() {
            self.leaf(self.inputs[input as usize]);
        }
    }

    /// Programs and counts; the mechanism is complete.
    pub(super) fn finish(mut self) -> Result<Mechanism<G>, Vec<super::fault::BuildFault>> {
        let outputs = [&self.position, &self.velocity, &self.time, &self.force, &self.states].map(Clone::clone);
        let laws: Vec<_> = self.mechanism.spring_efforts.iter().map(|e| self.alone(self.mechanism.efforts[*e].law)).collect();
        let mut programs = outputs.map(|of| self.program(of)).into_iter();
        if !self.faults.is_empty() {
            return Err(self.faults);
        }
        for slot in [
            &mut self.mechanism.position_program,
            &mut self.mechanism.velocity_program,
            &mut self.mechanism.time_program,
            &mut self.mechanism.force_program,
            &mut self.mechanism.state_program,
        ] {
            if let Some(program) = programs.next() {
                *slot = program;
            }
        }
        self.mechanism.spring_laws =
            laws.into_iter().enumerate().map(|(spring, law)| law.map(|of| self.over_stretch(of, spring))).collect();
        // the drift of a function reads the same input vector, extended by rates: sizes are known only now
        self.mechanism.tables = self.tables;
        self.mechanism.switches = self.pool.switches().len();
        for place in self.mechanism.pressings.iter_mut().flat_map(|p| &mut p.places) {
            if let [_] = place.components[..] {
                place.side = self.mechanism.switches;
                self.mechanism.switches += 1;
            }
        }
        let switches = self.pool.switches();
        let own: Vec<usize> = self.mechanism.contacts.iter().map(|c| c.mode).collect();
        for contact in self.mechanism.contacts.iter_mut().filter(|c| c.friction().is_some()) {
            let same = |i: &usize| !own.contains(i) && switches[*i].test == switches[contact.mode].test;
            contact.follow = (0..switches.len()).filter(same).collect();
        }
        for contact in self.mechanism.contacts.iter_mut().filter(|c| c.friction().is_none()) {
            contact.mode = self.mechanism.switches;
            self.mechanism.switches += 1;
        }
        self.mechanism.group();
        self.mechanism.release_spare_room();
        Ok(self.mechanism)
    }

    /// The force of a spring, and its derivative by time, if a program gives it.
    fn alone(&self, law: EffortLaw<G>) -> Option<Vec<Output>> {
        let EffortLaw::Law { output, timed, .. } = law else { return None };
        let outputs = [Some(output), timed.then_some(output + 2)];
        Some(outputs.into_iter().flatten().map(|k| self.force[k].clone()).collect())
    }

    /// A program whose switches are decided along the stretch of a spring, the others given.
    fn over_stretch(&mut self, outputs: Vec<Output>, spring: usize) -> StagedProgram {
        let staged = self.program(outputs);
        let over = staged.fills.iter().find(|(_, leaf)| *leaf == Leaf::Stretch { spring, order: 0 });
        let program = staged.program.decided_by(over.map_or(u32::MAX, |(input, _)| *input as u32));
        StagedProgram { program, ..staged }
    }

    fn program(&mut self, outputs: Vec<Output>) -> StagedProgram {
        let program = self.pool.program(&ids(&outputs), self.parameters, &self.tables);
        self.undefined_constants(&outputs);
        let mut fills = Vec::new();
        for &input in program.inputs() {
            let quantity = self.inputs[input as usize];
            match self.leaf(quantity) {
                Some(leaf) => fills.push((input as usize, leaf)),
                None => self.not_usable(quantity, &outputs, input),
            }
        }
        StagedProgram {
            program,
            fills,
            inputs: self.inputs.len(),
            outputs: outputs.len(),
            places: outputs.into_iter().map(|o| o.place).collect(),
        }
    }

    /// Faults a quantity that is computed behind the programs, where one of their outputs uses it.
    fn not_usable(&mut self, quantity: Quantity, outputs: &[Output], input: u32) {
        let user = outputs.iter().find(|output| self.pool.inputs_of(&[output.value]).contains(&input));
        let place = user.map_or("loads", |output| &output.place);
        let help = match quantity {
            Quantity::SpringForce { spring } | Quantity::SpringEnergy { spring } => {
                format!("write it by `{}.stretch`, as the law of the spring does", self.model.springs[spring].name)
            }
            _ => "use coordinates or rates of bodies and joints instead".to_owned(),
        };
        let expected = "positions and velocities of bodies and joints, stretches of springs, states";
        self.fault("not-usable", place, format!("`{}` cannot act back on the motion", self.model.name_of(quantity)), expected, Some(help));
    }

    /// Faults outputs that are undefined whatever the motion: they depend on constants alone.
    fn undefined_constants(&mut self, outputs: &[Output]) {
        for output in outputs.iter().filter(|o| self.pool.inputs_of(&[o.value]).is_empty()).cloned().collect::<Vec<_>>() {
            if let Some(cause) = self.pool.cause(output.value, self.parameters, &self.tables) {
                let message = format!("a value is undefined: {}", self.model.why_undefined(cause));
                let help = "give values for which it is defined, or choose between formulas by `if(condition, a, b)`".to_owned();
                self.fault("not-a-number", &output.place, message, "a finite number", Some(help));
            }
        }
    }

    /// Where the value of a quantity comes from while the mechanism is evaluated.
    fn leaf(&mut self, quantity: Quantity) -> Option<Leaf> {
        match quantity {
            Quantity::Time => Some(Leaf::Time),
            Quantity::Stretch { spring, order } if order < 2 => Some(Leaf::Stretch { spring, order }),
            Quantity::Spin { body, axis, order: 1, own } => Some(Leaf::Spin { body, axis, own }),
            Quantity::State(state) => Some(Leaf::State(state)),
            Quantity::Bristle { joint } => self.mechanism.bristles[joint].map(Leaf::State),
            _ => self.gauge_of(quantity).map(|(gauge, order)| Leaf::Gauge { gauge, order }),
        }
    }

    /// The gauge that measures a quantity of position level, and the order of its rate.
    pub(super) fn gauge_of(&mut self, quantity: Quantity) -> Option<(usize, usize)> {
        match quantity {
            Quantity::Joint { joint, slot, order } => self.slot(joint, slot).map(|gauge| (gauge, order)),
            Quantity::Point { at, axis, order } => {
                let (body, pb) = self.at(at);
                let measured = Measured::Slide { pa: G::Vector::default(), n: basis::<G>(axis), pb };
                Some((self.shared_gauge(body, measured), order))
            }
            Quantity::Angle { body, order } => Some((self.shared_gauge(body, Measured::Angle), order)),
            Quantity::Quaternion { body, component, order } => {
                let windings = &mut self.mechanism.windings;
                let sign = *self.signs[body].get_or_insert_with(|| {
                    *windings += 1;
                    *windings - 1
                });
                Some((self.shared_gauge(body, Measured::Quaternion { component, sign }), order))
            }
            _ => None,
        }
    }

    /// A gauge from the ground, made once.
    fn shared_gauge(&mut self, body: usize, measured: Measured<G>) -> usize {
        let found = self.mechanism.gauges.iter().position(|g| g.a == 0 && g.b == body && g.measured == measured && g.shift == 0.0);
        found.unwrap_or_else(|| self.gauge(0, body, measured, 0.0))
    }

    /// The next rate of an expression of time alone.
    pub(super) fn rate_by_time(&mut self, id: Id, place: &str) -> Option<Id> {
        let one = self.pool.constant(1.0);
        let inputs = self.inputs.clone();
        let rate = self.pool.rate(id, &mut |_, input| (inputs.get(input as usize) == Some(&Quantity::Time)).then_some(one));
        if rate.is_err() {
            self.fault(
                "not-of-time",
                place,
                "the motion uses a quantity of the mechanism".into(),
                "an expression of t and parameters",
                None,
            );
        }
        rate.ok()
    }

    /// An expression of gauges and time with its partial derivatives and its second rate at a = 0.
    pub(super) fn function_of(&mut self, id: Id, place: &str) -> Option<usize> {
        let (mut gauges, mut of_gauges, mut time) = (Vec::new(), Vec::new(), None);
        for input in self.pool.inputs_of(&[id]) {
            let quantity = self.inputs[input as usize];
            match self.gauge_of(quantity) {
                Some((gauge, 0)) => {
                    gauges.push(gauge);
                    of_gauges.push(input);
                }
                _ if quantity == Quantity::Time => time = Some(input),
                _ => {
                    let message = format!("the expression uses `{}`", self.model.name_of(quantity));
                    let expected = "`t`, coordinates and quaternions of bodies and coordinates of joints alone";
                    let help = matches!(quantity, Quantity::Com { .. })
                        .then(|| "write it by those of the bodies, as `(m1*a.com.x + m2*b.com.x)/(m1 + m2)`".to_owned());
                    self.fault("not-a-position", place, message, expected, help);
                    return None;
                }
            }
        }
        let value = self.position.len();
        let output = |value: Id| Output { value, place: place.to_owned() };
        self.position.push(output(id));
        for wanted in of_gauges {
            let slope = self.slope(id, wanted)?;
            self.position.push(output(slope));
        }
        let by_time = match time {
            Some(time) => {
                let slope = self.slope(id, time)?;
                self.position.push(output(slope));
                Some(self.position.len() - 1)
            }
            None => None,
        };
        let first = self.rate_of(id)?;
        let second = self.rate_of(first)?;
        self.velocity.push(output(second));
        Some(self.function(Function { gauges, value, by_time, drift: self.velocity.len() - 1 }))
    }

    /// The derivative of an expression by one of its inputs, the others fixed.
    pub(super) fn slope(&mut self, id: Id, wanted: u32) -> Option<Id> {
        let (zero, one) = (self.pool.constant(0.0), self.pool.constant(1.0));
        self.pool.rate(id, &mut |_, input| Some(if input == wanted { one } else { zero })).ok()
    }

    /// Whether time is in an expression.
    pub(super) fn is_timed(&self, id: Id) -> bool {
        self.pool.inputs_of(&[id]).iter().any(|&input| self.inputs[input as usize] == Quantity::Time)
    }

    /// The time rate of an expression of positions, velocities and time.
    fn rate_of(&mut self, id: Id) -> Option<Id> {
        let mut inputs = std::mem::take(&mut self.inputs);
        let rate = self.pool.rate(id, &mut |pool, input| {
            let quantity = *inputs.get(input as usize)?;
            if quantity == Quantity::Time {
                return Some(pool.constant(1.0));
            }
            let next = next_order(quantity)?;
            let index = inputs.iter().position(|q| *q == next).unwrap_or_else(|| {
                inputs.push(next);
                inputs.len() - 1
            });
            Some(pool.input(index as u32))
        });
        self.inputs = inputs;
        rate.ok()
    }
}

/// Values of outputs.
fn ids(outputs: &[Output]) -> Vec<Id> {
    outputs.iter().map(|output| output.value).collect()
}

/// The rate of a quantity of a body or joint.
fn next_order(quantity: Quantity) -> Option<Quantity> {
    Some(match quantity {
        Quantity::Point { at, axis, order } => Quantity::Point { at, axis, order: order + 1 },
        Quantity::Angle { body, order } => Quantity::Angle { body, order: order + 1 },
        Quantity::Quaternion { body, component, order } => Quantity::Quaternion { body, component, order: order + 1 },
        Quantity::Joint { joint, slot, order } => Quantity::Joint { joint, slot, order: order + 1 },
        _ => return None,
    })
}
