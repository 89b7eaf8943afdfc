//! Columns: the quantities that expressions name, read from an evaluated mechanism, and the program that turns them into columns.

use crate::dynamics::{Dynamics, Reactions};
use crate::expression::{Cause, Id, Program};
use crate::geometry::{Motion, Space};
use crate::kinematics::undefined::Gap;
use crate::mechanism::{EffortLaw, Leaf, Measured, Mechanism, RowOwner};
use crate::model::{Model, Quantity, Study};

/// A program of columns with the sources of its inputs; its scratch is sized once.
#[derive(Clone, Debug)]
pub struct Observer<G: Space> {
    program: Program,
    /// The program that gives the columns their values.
    seen: Program,
    fills: Vec<(usize, Source<G>)>,
    inputs: Vec<f64>,
    registers: Vec<f64>,
    modes: Vec<i32>,
    /// The expressions, and whether each may be undefined.
    ids: Vec<(Id, bool)>,
    needs: Needs,
}

/// How far a state must be evaluated for a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Needs {
    /// To positions, velocities and states.
    Velocities,
    /// To inertias in world axes and the laws of springs as well: energies and momenta.
    Inertias,
    /// To accelerations, reactions or applied forces.
    Forces,
}

/// Where the value of a quantity is read; everything is resolved to indices and vectors.
#[derive(Clone, Copy, Debug)]
enum Source<G: Space> {
    Time,
    State(usize),
    Point {
        body: usize,
        at: G::Vector,
        axis: usize,
        order: usize,
    },
    Angle {
        body: usize,
        order: usize,
    },
    Spin {
        body: usize,
        axis: usize,
        order: usize,
        own: bool,
    },
    Gauge {
        gauge: usize,
        order: usize,
    },
    Force {
        joint: usize,
        axis: usize,
    },
    Moment {
        joint: usize,
        axis: usize,
    },
    DriverEffort(usize),
    DriverPower(usize),
    /// Torque or force of a row.
    Row(usize),
    Stretch {
        spring: usize,
        order: usize,
    },
    SpringForce(usize),
    SpringEnergy(usize),
    Effort(usize),
    /// By which it slides, and the contact by which it sticks.
    Friction(usize, Option<usize>),
    /// The end stops of a joint: the effort of those that give way, and the rows that hold the joint on rigid ones.
    Stop {
        effort: Option<usize>,
        row: Option<usize>,
    },
    Com {
        axis: usize,
        order: usize,
    },
    Kinetic,
    Potential,
    Momentum(usize),
    Shaking(usize),
    ShakingMoment(usize),
    Frame(usize),
    FrameMoment(usize),
    InertiaEq,
    InertiaEqSlope,
    /// A number known beforehand; NaN: not defined here.
    Given(f64),
}

impl<G: Space<S = f64>> Observer<G> {
    /// The columns `ids` of a model as a program on its mechanism.
    #[must_use]
    pub fn new(model: &Model, mechanism: &Mechanism<G>, parameters: &[f64], ids: &[Id]) -> Self {
        let program = model.pool.program(ids, parameters, &mechanism.tables);
        let fills: Vec<(usize, Source<G>)> =
            program.inputs().iter().map(|&i| (i as usize, source(mechanism, model.inputs[i as usize]))).collect();
        // columns that nobody asked for end no study
        let own = |study: &Study, id: &Id| !study.columns_given && study.columns.iter().any(|column| column.value == *id);
        let may = |id: &Id| model.study.as_ref().is_some_and(|study| study.undefined.contains(id) || own(study, id));
        Self {
            needs: fills.iter().map(|(_, source)| source.needs()).max().unwrap_or(Needs::Velocities),
            ids: ids.iter().map(|id| (*id, may(id))).collect(),
            fills,
            inputs: vec![f64::NAN; model.inputs.len()],
            registers: vec![0.0; program.registers()],
            modes: mechanism.modes(),
            seen: program.observed(),
            program,
        }
    }

    /// Reads all quantities of an evaluated state (q, v, a) with its reactions.
    pub fn read(&mut self, dynamics: &mut Dynamics<'_, G>, [q, v, a]: [&[f64]; 3], reactions: &Reactions<G>, modes: &[i32]) {
        dynamics.watch(q, v, modes);
        self.modes.copy_from_slice(modes);
        for (input, source) in &self.fills {
            self.inputs[*input] = source.read(dynamics, a, reactions, &mut self.modes);
        }
    }

    /// Takes the quantities from elsewhere: inputs of the program with their values.
    pub fn take(&mut self, values: impl Iterator<Item = (usize, f64)>, modes: &[i32]) {
        self.modes.copy_from_slice(modes);
        values.for_each(|(input, value)| self.inputs[input] = value);
    }

    /// The inputs of the program with what the programs of forces read as well; none if it reads anything else.
    #[must_use]
    pub fn leaves(&self) -> Option<Vec<(usize, Leaf)>> {
        let leaf = |source: &Source<G>| match *source {
            Source::Time => Some(Leaf::Time),
            Source::State(state) => Some(Leaf::State(state)),
            Source::Gauge { gauge, order: order @ (0 | 1) } => Some(Leaf::Gauge { gauge, order }),
            _ => None,
        };
        self.fills.iter().map(|(input, source)| Some((*input, leaf(source)?))).collect()
    }

    /// How far a state must be evaluated for all quantities.
    #[must_use]
    pub fn needs(&self) -> Needs {
        self.needs
    }

    /// Whether a quantity needs accelerations, reactions or applied forces.
    #[must_use]
    pub fn needs_forces(&self) -> bool {
        self.needs == Needs::Forces
    }

    /// Whether a switch of the columns does.
    #[must_use]
    pub fn switches_by_forces(&self) -> bool {
        !self.program.switches().is_empty() && self.needs_forces()
    }

    /// Inputs of the program that are time.
    #[must_use]
    pub fn times(&self) -> Vec<u32> {
        self.fills.iter().filter(|(_, source)| matches!(source, Source::Time)).map(|(input, _)| *input as u32).collect()
    }

    /// Sets the modes of the columns' switches from the quantities read last.
    pub fn set_modes(&mut self, modes: &mut [i32]) {
        self.program.set_modes(&self.inputs, &mut self.registers, modes);
    }

    /// Columns from the quantities read last.
    pub fn columns(&mut self, modes: &[i32], out: &mut [f64]) {
        self.seen.eval(&self.inputs, modes, &mut self.registers, out);
    }

    /// The first of the columns `out` that has no value by the fault of its own expression, but for those that may be undefined.
    #[must_use]
    pub fn undefined(&self, modes: &[i32], out: &[f64]) -> Option<Gap> {
        let wrong = out.iter().zip(&self.ids).enumerate().filter(|(_, (x, (_, may)))| !x.is_finite() && !may);
        wrong
            .filter_map(|(k, (_, (id, _)))| match self.seen.cause(k, &self.inputs, modes)? {
                // the quantity itself is not determined there
                Cause::Input(_) => None,
                cause => Some(Gap::Watched(*id, cause)),
            })
            .next()
    }

    /// The program of the columns.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Distances to the switches of the program, in their order.
    pub fn roots(&mut self, modes: &[i32], roots: &mut [f64]) {
        self.program.roots(&self.inputs, modes, &mut self.registers, roots);
    }

    /// Distances to both ends of a table's segment, if switch number `k` is one; after [`Observer::roots`].
    #[must_use]
    pub fn segment_ends(&self, k: usize, modes: &[i32]) -> Option<[f64; 2]> {
        self.program.segment_ends(k, modes, &self.registers)
    }

    /// The mode behind crossing number `k` of the switches; after [`Observer::roots`].
    #[must_use]
    pub fn neighbour(&self, k: usize, modes: &[i32]) -> i32 {
        self.program.neighbour(k, modes, &self.registers)
    }

    /// The mode of equal operands for switch number `k`, if what it decides jumps there; after [`Observer::roots`].
    #[must_use]
    pub fn of_equals(&self, k: usize) -> Option<i32> {
        self.program.of_equals(k, &self.registers)
    }
}

fn source<G: Space<S = f64>>(m: &Mechanism<G>, quantity: Quantity) -> Source<G> {
    match quantity {
        Quantity::Time => Source::Time,
        Quantity::Point { at, axis, order } => Source::Point { body: at.body, at: m.bodies[at.body].points[at.point].1, axis, order },
        Quantity::Angle { body, order } => Source::Angle { body, order },
        Quantity::Spin { body, axis, order, own } => Source::Spin { body, axis, order, own },
        Quantity::Quaternion { body, component, order } => {
            let is = |measured| matches!(measured, Measured::Quaternion { component: k, .. } if k == component);
            match m.gauges.iter().position(|g| g.b == body && is(g.measured)) {
                Some(gauge) => Source::Gauge { gauge, order },
                None => Source::Given(f64::NAN),
            }
        }
        Quantity::Joint { joint, slot, order } => match m.joints[joint].slots.get(slot) {
            Some(&gauge) => Source::Gauge { gauge, order },
            None => Source::Given(f64::NAN),
        },
        Quantity::Force { joint, axis } => Source::Force { joint, axis },
        Quantity::Moment { joint, axis } => Source::Moment { joint, axis },
        Quantity::DriverEffort { driver } => Source::DriverEffort(driver),
        Quantity::DriverPower { driver } => Source::DriverPower(driver),
        Quantity::CouplingEffort { coupling } => {
            let mut rows = (0..m.rows.len()).filter(|&row| m.rows[row].owner == RowOwner::Coupling);
            rows.nth(coupling).map_or(Source::Given(f64::NAN), Source::Row)
        }
        Quantity::Stretch { spring, order } => Source::Stretch { spring, order },
        Quantity::SpringForce { spring } => Source::SpringForce(m.spring_efforts[spring]),
        Quantity::SpringEnergy { spring } => Source::SpringEnergy(spring),
        Quantity::MotorTorque { motor } => match m.motor_efforts[motor] {
            Some(effort) => Source::Effort(effort),
            None => Source::Given(0.0),
        },
        Quantity::Com { axis, order } => Source::Com { axis, order },
        Quantity::Kinetic => Source::Kinetic,
        Quantity::Potential => Source::Potential,
        Quantity::Momentum { axis } => Source::Momentum(axis),
        Quantity::Shaking { axis } => Source::Shaking(axis),
        Quantity::ShakingMoment { axis } => Source::ShakingMoment(axis),
        Quantity::Frame { axis } => Source::Frame(axis),
        Quantity::FrameMoment { axis } => Source::FrameMoment(axis),
        Quantity::InertiaEq => Source::InertiaEq,
        Quantity::InertiaEqSlope => Source::InertiaEqSlope,
        Quantity::State(state) => Source::State(state),
        Quantity::Friction { joint } => match m.friction_efforts[joint] {
            Some(effort) => Source::Friction(effort, m.contact_of(effort)),
            None => Source::Given(f64::NAN),
        },
        Quantity::ClutchEffort { clutch } => Source::Friction(m.clutches[clutch], m.contact_of(m.clutches[clutch])),
        Quantity::Stop { joint } => Source::Stop {
            effort: m.buffers.iter().find(|b| b.joint == joint).map(|b| b.effort),
            row: m
                .rows
                .iter()
                .position(|row| matches!(row.owner, RowOwner::Stop(stop) if m.stops[stop].joint == joint && m.stops[stop].event.is_none())),
        },
        Quantity::Bristle { joint } => m.bristles[joint].map_or(Source::Given(f64::NAN), Source::State),
        Quantity::Functional(_) | Quantity::Result(_) | Quantity::Work(_) | Quantity::Taken(_) => Source::Given(f64::NAN),
    }
}

impl<G: Space<S = f64>> Source<G> {
    fn needs(&self) -> Needs {
        match *self {
            Self::Time | Self::State(_) | Self::Given(_) => Needs::Velocities,
            Self::Point { order, .. }
            | Self::Angle { order, .. }
            | Self::Spin { order, .. }
            | Self::Gauge { order, .. }
            | Self::Stretch { order, .. }
                if order < 2 =>
            {
                Needs::Velocities
            }
            Self::Com { order, .. } if order < 2 => Needs::Inertias,
            Self::Kinetic | Self::Potential | Self::SpringEnergy(_) | Self::Momentum(_) => Needs::Inertias,
            _ => Needs::Forces,
        }
    }

    fn read(&self, d: &mut Dynamics<'_, G>, a: &[f64], r: &Reactions<G>, modes: &mut [i32]) -> f64 {
        let w = &d.work;
        let m = d.mechanism;
        match *self {
            Self::Given(x) => x,
            Self::Time => d.t,
            Self::State(state) => w.z[state],
            Self::Point { body, at, axis, order } => {
                let p = if order == 0 { d.point(body, at) } else { d.place(m.group_of[body], body, at) };
                G::component(trace::<G>(p, w.twists[body], r.accelerations[body], order), axis)
            }
            Self::Angle { body, order } => match order {
                0 => G::angle(w.places[body].r),
                1 => G::spin_component(w.twists[body].w, 2),
                _ => G::spin_component(r.accelerations[body].w, 2),
            },
            Self::Spin { body, axis, order, own } => {
                let spin = if order == 1 { w.twists[body].w } else { r.accelerations[body].w };
                G::spin_component(d.in_axes(body, own, spin), axis)
            }
            Self::Gauge { gauge, order } => d.held(gauge, order).unwrap_or_else(|| gauge_order(d, gauge, order, a)),
            Self::Force { joint, axis } => G::component(r.joints[joint].f, axis),
            Self::Moment { joint, axis } => {
                let (body, at) = m.joints[joint].b;
                let group = m.group_between(m.joints[joint].a.0, body);
                G::spin_component(r.joints[joint].moment_about(d.place(group, body, at)), axis)
            }
            Self::DriverEffort(k) => r.drives[k],
            Self::DriverPower(k) => r.drives[k] * w.readings[m.drives[k].gauge].rate,
            Self::Stretch { spring, order } => match order {
                0 => d.stretch(spring),
                1 => d.stretch_rate(spring),
                _ => d.stretch_acceleration(spring, a),
            },
            Self::Row(row) => r.rows[row],
            Self::SpringForce(effort) => -w.efforts[effort],
            Self::SpringEnergy(spring) => d.spring_energy(spring, modes),
            Self::Friction(effort, contact) => w.efforts[effort] + contact.map_or(0.0, |contact| r.held[contact]),
            Self::Stop { effort, row } => effort.map_or(0.0, |effort| w.efforts[effort]) + row.map_or(0.0, |row| r.rows[row]),
            Self::Effort(effort) => {
                debug_assert!(matches!(m.efforts[effort].law, EffortLaw::Drive { .. }));
                w.efforts[effort]
            }
            Self::Com { axis, order } => {
                let (mass, h) = d.first_moment();
                let x = match order {
                    0 => h,
                    1 => d.momentum().f,
                    _ => r.shaking.f,
                };
                G::component(x, axis) / mass
            }
            Self::Kinetic => d.kinetic_energy(),
            Self::Potential => d.potential_energy(modes),
            Self::Momentum(axis) => G::component(d.momentum().f, axis),
            Self::Shaking(axis) => G::component(r.shaking.f, axis),
            Self::ShakingMoment(axis) => G::spin_component(r.shaking.n, axis),
            Self::Frame(axis) => G::component(r.frame.f, axis),
            Self::FrameMoment(axis) => G::spin_component(r.frame.n, axis),
            Self::InertiaEq => equivalent_inertia(d, a, r).0,
            Self::InertiaEqSlope => equivalent_inertia(d, a, r).1,
        }
    }
}

/// Position, velocity or acceleration of the body-fixed point now at `p`: p̈ = v̇ + ω̇×p + ω×ṗ.
fn trace<G: Space>(p: G::Vector, twist: Motion<G>, acceleration: Motion<G>, order: usize) -> G::Vector {
    match order {
        0 => p,
        1 => twist.at(p),
        _ => acceleration.at(p) + G::turn(twist.w, twist.at(p)),
    }
}

fn gauge_order<G: Space<S = f64>>(d: &Dynamics<'_, G>, gauge: usize, order: usize, a: &[f64]) -> f64 {
    let reading = &d.work.readings[gauge];
    match order {
        0 => reading.x,
        1 => reading.rate,
        _ => d.mechanism.gauges[gauge].acceleration(reading, &d.work.columns, a),
    }
}

/// ω²/|α| of a driver, rad or m, below which it counts as turning round.
const TURNING: f64 = 1e-9;

/// I = 2T/ω² of the one driver, and dI/dx = (2Ṫ/ω² − 4Tα/ω³)/ω with Ṫ the power of the inertial forces.
fn equivalent_inertia<G: Space<S = f64>>(d: &Dynamics<'_, G>, a: &[f64], r: &Reactions<G>) -> (f64, f64) {
    let m = d.mechanism;
    let [drive] = &m.drives[..] else { return (f64::NAN, f64::NAN) };
    let omega = d.work.readings[drive.gauge].rate;
    let alpha = gauge_order(d, drive.gauge, 2, a);
    let energy = d.kinetic_energy();
    let mut rate = 0.0;
    for node in &m.nodes {
        rate += d.inertial(node.body, r.accelerations[node.body]).power(d.work.twists[node.body]);
    }
    for rotor in &m.rotors {
        rate += rotor.inertia * d.work.readings[rotor.gauge].rate * gauge_order(d, rotor.gauge, 2, a);
    }
    let square = omega * omega;
    // where the driver turns round, both parts of the slope grow beyond what their difference keeps
    let slope =
        if square > TURNING * alpha.abs() { (2.0 * rate / square - 4.0 * energy * alpha / (square * omega)) / omega } else { f64::NAN };
    (2.0 * energy / square, slope)
}
