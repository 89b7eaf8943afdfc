//! Start values as gauges.

use super::super::joint::{apply, axis_rotation, dot, transpose, unit};
use super::super::{Asked, Orientation, Start};
use super::builder::Builder;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::{Quantity, StartValue, axis_angle, roll_pitch_yaw};

impl<G: Space> Builder<'_, G> {
    /// The asked start values; after all gauges of rows and forces.
    pub(super) fn starts(&mut self) {
        for index in 0..self.model.start.len() {
            let start = &self.model.start[index];
            let place = start.place.as_str();
            let name = start.name.clone();
            match &start.value {
                StartValue::Rotation { axis, angle } => self.rotation(index, axis, *angle),
                StartValue::RollPitchYaw(angles) => {
                    let matrix = roll_pitch_yaw(angles.map(|angle| self.number(angle, place)));
                    let (axis, angle) = axis_angle(&matrix);
                    self.orientation(index, axis, matrix, angle);
                }
                StartValue::Number(id) => {
                    let value = self.number(*id, place);
                    let asked = match start.quantity {
                        Quantity::Spin { body, axis, order: 1, own } => Some(Asked::Spin { body, axis, own }),
                        quantity => match self.gauge_of(quantity) {
                            Some((gauge, order)) if order < 2 => Some(Asked::Gauge { gauge, order }),
                            _ => None,
                        },
                    };
                    match asked {
                        Some(asked) => {
                            self.mechanism.starts.push(Start { name, asked, value, guess: start.guess, place: start.place.clone() });
                        }
                        None => self.fault(
                            "not-a-start",
                            place,
                            format!("`{name}` cannot be set"),
                            "a position or velocity of a joint or body",
                            Some("for example `O.angle`, `S.position`, `body.x`, `O.omega`".into()),
                        ),
                    }
                }
            }
        }
    }

    /// A rotation about an axis as an orientation.
    fn rotation(&mut self, index: usize, axis: &[Id], angle: Id) {
        let place = self.model.start[index].place.as_str();
        let axis = self.triple(axis, place);
        let angle = self.number(angle, place);
        if dot(axis, axis) == 0.0 {
            self.fault("no-direction", place, "the axis is zero".into(), "a direction", Some("for example `axis: [0, 0, 1]`".into()));
            return;
        }
        // R = T R_z Tᵀ with T taking z to the axis
        let t = axis_rotation([0.0, 0.0, 1.0], unit(axis));
        let (s, c) = angle.sin_cos();
        let column = |k: usize| {
            let mut e = [0.0; 3];
            e[k] = 1.0;
            let [x, y, z] = apply(&transpose(&t), e);
            apply(&t, [c * x - s * y, s * x + c * y, z])
        };
        let columns = [0, 1, 2].map(column);
        let matrix = std::array::from_fn(|i| std::array::from_fn(|k| columns[k][i]));
        self.orientation(index, unit(axis), matrix, angle);
    }

    /// An orientation, with its unit axis and angle.
    fn orientation(&mut self, index: usize, axis: [f64; 3], matrix: [[f64; 3]; 3], angle: f64) {
        let start = &self.model.start[index];
        let Quantity::Quaternion { body, .. } = start.quantity else { return };
        let asked = Asked::Orientation(self.mechanism.orientations.len());
        self.mechanism.orientations.push(Orientation { body, axis, matrix });
        let (name, place) = (start.name.clone(), start.place.clone());
        self.mechanism.starts.push(Start { name, asked, value: angle, guess: start.guess, place });
    }
}
