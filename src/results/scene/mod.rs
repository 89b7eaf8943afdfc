//! What is drawn of a mechanism: its bodies with their shapes, what connects them, and where they are along the motion.
//!
//! Pictures, pages and animations are made of this and of nothing else. Places are in the frame of the body that carries them, with 2
//! or 3 numbers as the scene has dimensions, m; body 0 is the ground.

mod frames;
mod named;
mod parts;
mod shape;
mod teeth;

pub use frames::{Frames, interpolate};
pub use parts::{Arrow, ArrowKind, Body, Gear, GearKind, Joint, Link, LinkKind, Place, Trace, Wheel};
pub use shape::Shape;
pub(crate) use teeth::{rack, rim, wheel};

use crate::results::ShownIn;
use serde::{Deserialize, Serialize};

/// A mechanism as it is drawn, and its motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Numbers of a place: 2 or 3.
    pub dimensions: usize,
    /// Unit direction that is upwards in a picture: y in the plane; in space against gravity, or z without it.
    pub up: [f64; 3],
    /// What a title says beside the names of model and study: the run of a sweep, the frequency of a mode; may be empty.
    pub caption: String,
    /// The unit to show lengths in, if the model asks for one.
    pub length: Option<ShownIn>,
    /// The same of forces.
    #[serde(default)]
    pub force: Option<ShownIn>,
    /// The same of torques.
    #[serde(default)]
    pub torque: Option<ShownIn>,
    /// Azimuth and elevation of the eye, rad, if the study asks for them.
    pub view: Option<[f64; 2]>,
    /// Value of the independent variable at which a still picture shows it strongly, if the study asks for one, or the start of a motion that
    /// is followed both ways; else that is the first of the frames that are shown.
    pub at: Option<f64>,
    /// Bodies; the first is the ground.
    pub bodies: Vec<Body>,
    /// Joints; those of the kind `distance` are links.
    pub joints: Vec<Joint>,
    /// Springs, dampers and massless rods.
    pub links: Vec<Link>,
    /// Pairs of gears, racks with their pinions, wheels under a belt, ropes on their drums.
    pub gears: Vec<Gear>,
    /// Forces and torques.
    pub arrows: Vec<Arrow>,
    /// Points whose paths are drawn.
    pub traces: Vec<Trace>,
    /// Where the bodies are.
    pub frames: Frames,
}

impl Scene {
    /// Numbers of the pose of one body: x, y, angle in the plane; x, y, z and a unit quaternion w, x, y, z in space.
    #[must_use]
    pub fn stride(&self) -> usize {
        frames::stride(self.dimensions)
    }

    /// Numbers of a frame: the poses of all bodies but the ground.
    #[must_use]
    pub fn width(&self) -> usize {
        self.bodies.len().saturating_sub(1) * self.stride()
    }

    /// The poses of a frame; shape (bodies − 1) · stride.
    #[must_use]
    pub fn frame(&self, index: usize) -> &[f64] {
        let width = self.width();
        self.frames.poses.get(index * width..(index + 1) * width).unwrap_or_default()
    }

    /// Where a place on a body is in the world, m, with the bodies as in `poses`; 2 numbers in the plane, the third is 0.
    #[must_use]
    pub fn world(&self, poses: &[f64], place: &Place) -> [f64; 3] {
        let turned = self.direction(poses, place.body, &place.at);
        if place.body == 0 {
            return turned;
        }
        let from = (place.body - 1) * self.stride();
        let origin = |i: usize| if i < self.dimensions { poses.get(from + i).copied().unwrap_or(f64::NAN) } else { 0.0 };
        std::array::from_fn(|i| turned[i] + origin(i))
    }

    /// Where the ends of a link are in the world, m, with the bodies as in `poses`.
    #[must_use]
    pub fn ends(&self, poses: &[f64], link: &Link) -> [[f64; 3]; 2] {
        let [a, b] = [&link.a, &link.b].map(|end| self.world(poses, end));
        let along: [f64; 3] = std::array::from_fn(|i| link.along.get(i).copied().unwrap_or(0.0));
        let way: f64 = (0..3).map(|i| along[i] * (b[i] - a[i])).sum();
        [if link.along.is_empty() { a } else { std::array::from_fn(|i| b[i] - way * along[i]) }, b]
    }

    /// A direction fixed in a body in the axes of the world, with the bodies as in `poses`.
    #[must_use]
    pub fn direction(&self, poses: &[f64], body: usize, along: &[f64]) -> [f64; 3] {
        let v: [f64; 3] = std::array::from_fn(|i| along.get(i).copied().unwrap_or(0.0));
        let Some(before) = body.checked_sub(1) else { return v };
        let Some(pose) = poses.get(before * self.stride()..(before + 1) * self.stride()) else { return [f64::NAN; 3] };
        if let [_, _, angle] = *pose {
            let (s, c) = angle.sin_cos();
            return [c * v[0] - s * v[1], s * v[0] + c * v[1], 0.0];
        }
        rotated([pose[3], pose[4], pose[5], pose[6]], v)
    }
}

/// v turned by a unit quaternion: v + 2 u × (u × v + w v), u its vector part.
fn rotated([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let u = [x, y, z];
    let cross = |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let inner = cross(u, v);
    let outer = cross(u, std::array::from_fn(|i| inner[i] + w * v[i]));
    std::array::from_fn(|i| v[i] + 2.0 * outer[i])
}
