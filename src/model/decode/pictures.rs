//! What a study says of its drawing: points whose paths are drawn, forces that are shown, at which place of the motion, and where the eye is.

use super::decoder::Decoder;
use super::frame::Frame;
use crate::expression::{Dimension, Id};
use crate::model::entities::{CouplingKind, LoadOn};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANGLE, POINT, Shape, Size, Want};
use crate::model::figure::{ForceKind, ForceOn, Shown, ShownForce, ShownWhat};
use crate::model::keys::{Entry, Words, keys};
use crate::model::merge::Node;
use crate::model::place::PointRef;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::study::{Side, View};
use crate::model::vocabulary::Quantity;

/// What `trace` takes.
pub(super) const TRACE: Shape = Shape::List(&POINT, Size::AtLeast(0));
/// What `view` takes.
pub(super) const VIEW: Shape = Shape::Either(&[Shape::Word(Side::WORDS), Shape::List(&ANGLE, Size::Exactly(2))]);

/// What `show` takes.
pub(super) const SHOW: Shape = Shape::Either(&[Shape::Map(&SCALES), Shape::List(&Shape::Word(ForceKind::WORDS), Size::AtLeast(1))]);

keys! {
    /// `show`, with scales.
    SCALES = ScaleKeys "forces in a drawing" [] {
        loads: may Shape::Value(Want::Of(Dimension::STIFFNESS)), "Loads, with the force per length of an arrow.";
        reactions: may Shape::Value(Want::Of(Dimension::STIFFNESS)), "Reactions of joints, with the force per length of an arrow.";
    }
}

impl<'n> Decoder<'n> {
    /// Forces that drawings show, if the study asks for them.
    pub(super) fn forces(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, frame: &Frame<'n>) -> Vec<ShownForce> {
        let here = at.key(asked);
        let Some(node) = asked.node else { return Vec::new() };
        if !frame.features.columns {
            let message = format!("a study of the kind `{}` has no forces to show", frame.word);
            let fault = self.fault("wrong-key", &here, message, "no `show`");
            fault.spot = Spot::Key;
            fault.help = Some("remove it".to_owned());
            return Vec::new();
        }
        let mut forces = Vec::new();
        if node.is_list() {
            for (i, item) in asked.items().iter().enumerate() {
                if let Some(kind) = item.as_str().and_then(ForceKind::named) {
                    forces.extend(self.forces_of(kind, None, &here.index(i), frame));
                }
            }
            return forces;
        }
        let keys = ScaleKeys::of(node);
        for (kind, entry) in [(ForceKind::Loads, keys.loads), (ForceKind::Reactions, keys.reactions)] {
            let Some(value) = entry.node else { continue };
            let at = here.key(entry);
            let allow = Allow { what: "a scale", ..Allow::PARAMETER };
            let Some((lowered, _)) = self.any(value, &at, allow, &mut Local::default()) else { continue };
            if self.fits(&lowered, Want::Of(Dimension::STIFFNESS), value, None, &at) {
                self.check(Rule::Positive("the scale"), &[lowered.id], &at);
                forces.extend(self.forces_of(kind, Some(lowered.id), &at, frame));
            }
        }
        forces
    }

    fn forces_of(&mut self, kind: ForceKind, scale: Option<Id>, at: &At<'_, 'n>, frame: &Frame<'n>) -> Vec<ShownForce> {
        match kind {
            ForceKind::Loads => self.shown_loads(scale, frame),
            ForceKind::Reactions if frame.features.reactions => self.shown_reactions(scale),
            ForceKind::Reactions => {
                let message = format!("a study of the kind `{}` finds no reactions", frame.word);
                self.fault("no-reactions", at, message, "a study that finds reactions").help =
                    Some("use `inverse`, `dynamics` or `statics`".to_owned());
                Vec::new()
            }
        }
    }

    /// Loads, but those that need states which the study does not follow.
    fn shown_loads(&mut self, scale: Option<Id>, frame: &Frame<'n>) -> Vec<ShownForce> {
        let mut forces = Vec::new();
        for (index, load) in self.name_space.model.loads.clone().into_iter().enumerate() {
            let (force, torque) = match load.on {
                LoadOn::Point { force, torque, .. } => (force, torque),
                LoadOn::Joint { joint, effort } if self.name_space.single(joint).is_some_and(|c| c.angle) => (Vec::new(), vec![effort]),
                LoadOn::Joint { effort, .. } => (vec![effort], Vec::new()),
            };
            for (ids, on, letter, dimension) in
                [(force, ForceOn::Load(index), 'f', Dimension::FORCE), (torque, ForceOn::Torque(index), 'm', Dimension::TORQUE)]
            {
                let inputs = self.pool.inputs_of(&ids);
                let of_state = |input: &u32| matches!(self.name_space.model.inputs.get(*input as usize), Some(Quantity::State { .. }));
                if ids.is_empty() || !frame.features.states && inputs.iter().any(of_state) {
                    continue;
                }
                let axes = if ids.len() == 1 { ["", "", ""] } else { ["x", "y", "z"] };
                let component = |(id, axis): (Id, &str)| Shown {
                    name: format!("{}.{letter}{axis}", load.name),
                    what: ShownWhat::Column(id),
                    dimension,
                };
                let components = ids.into_iter().zip(axes).map(component).collect();
                forces.push(ShownForce { name: load.name.clone(), on, components, scale });
            }
        }
        forces
    }

    /// Forces and moments of all joints that transmit them.
    fn shown_reactions(&mut self, scale: Option<Id>) -> Vec<ShownForce> {
        let planar = self.name_space.components() == 2;
        let forces = &["fx", "fy", "fz"][..self.name_space.components()];
        let moments: &[&str] = if planar { &["m"] } else { &["mx", "my", "mz"] };
        let joints: Vec<(String, bool)> =
            self.name_space.model.joints.iter().map(|joint| (joint.name.clone(), joint.kind.transmits_moment(planar))).collect();
        let mut shown = Vec::new();
        for (index, (name, has_moment)) in joints.into_iter().enumerate() {
            // a moment may be asked for about another point, which its force tells
            let turning = has_moment.then(|| (ForceOn::Moment(index), [moments, forces].concat()));
            for (on, axes) in [(ForceOn::Reaction(index), forces.to_vec())].into_iter().chain(turning) {
                let components: Option<Vec<Shown>> = axes
                    .iter()
                    .map(|axis| {
                        let column = self.quiet(&format!("{name}.{axis}"))?;
                        Some(Shown { name: column.name, what: ShownWhat::Column(column.value), dimension: column.dimension })
                    })
                    .collect();
                shown.extend(components.map(|components| ShownForce { name: name.clone(), on, components, scale }));
            }
        }
        shown.extend(self.shown_distances(scale));
        shown
    }

    /// Forces of couplings of the positions of points, in the direction of a length: of those that prescribe a distance.
    fn shown_distances(&mut self, scale: Option<Id>) -> Vec<ShownForce> {
        let model = &self.name_space.model;
        let of_points = |id: Id| {
            let inputs = self.pool.inputs_of(&[id]);
            inputs.iter().all(|input| matches!(model.inputs[*input as usize], Quantity::Point { order: 0, .. } | Quantity::Time))
        };
        let distances = model.couplings.iter().enumerate().filter(|(_, coupling)| match coupling.kind {
            CouplingKind::Zero(id) => coupling.along == Dimension::LENGTH && of_points(id),
            _ => false,
        });
        let distances: Vec<(usize, String)> = distances.map(|(index, coupling)| (index, coupling.name.clone())).collect();
        let shown = distances.into_iter().filter_map(|(index, name)| {
            let column = self.quiet(&format!("{name}.force"))?;
            let components = vec![Shown { name: column.name, what: ShownWhat::Column(column.value), dimension: column.dimension }];
            Some(ShownForce { name, on: ForceOn::Coupling(index), components, scale })
        });
        shown.collect()
    }

    /// Points whose paths are drawn, if the study names them.
    pub(super) fn trace(&mut self, asked: Entry<'n>, at: &At<'_, 'n>) -> Option<Vec<PointRef>> {
        let here = at.key(asked);
        asked.node?;
        let mut points = Vec::new();
        for (i, item) in asked.items().iter().enumerate() {
            let at = here.index(i);
            match self.point(Some(Node::Plain(item)), &at) {
                Some(point) if point.body == 0 => {
                    let help = "name a point of a body, as `rocker.tip`".to_owned();
                    self.fault("fixed-point", &at, "a point of the ground has no path", "a point of a moving body").help = Some(help);
                }
                point => points.extend(point),
            }
        }
        Some(points)
    }

    /// The place of the motion that the drawing shows strongly, if the study names one.
    pub(super) fn shown_at(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>) -> Option<Id> {
        let here = at.key(asked);
        let node = asked.node?;
        let Some(dimension) = frame.features.independent.filter(|_| frame.features.moves) else {
            let message = format!("a study of the kind `{}` has no motion of which a place could be shown", frame.word);
            let fault = self.fault("wrong-key", &here, message, "no `at`");
            fault.spot = Spot::Key;
            fault.help = Some("remove it".to_owned());
            return None;
        };
        self.setting(node, &here, Want::of(dimension), &mut frame.local)
    }

    /// Where the eye is, if the study says so.
    pub(super) fn view(&mut self, asked: Entry<'n>, at: &At<'_, 'n>) -> Option<View> {
        let here = at.key(asked);
        let node = asked.node?;
        if self.name_space.components() == 2 {
            let fault = self.fault("spatial-only", &here, "a drawing in the plane has one view", "a key of a planar study");
            fault.spot = Spot::Key;
            fault.help = Some("remove it".to_owned());
            return None;
        }
        if let Some(side) = asked.word::<Side>() {
            return Some(View::Side(side));
        }
        let angles = self.vector(Some(node), &here, Dimension::ANGLE)?;
        let [azimuth, elevation] = angles[..] else { return None };
        Some(View::From { azimuth, elevation })
    }
}
