//! Pitch circles and lines in the picture, in the first position.

use super::Posed;
use crate::output::pose::Gear;
use crate::output::winding::{self, Drum};
use crate::results::scene::{self, GearKind, Shape, Wheel};

/// Radius of the rim of a wheel with inner teeth, as a multiple of that of its pitch circle.
const RIM: f64 = 1.08;

impl Posed<'_> {
    pub(super) fn gears(&self) -> impl Iterator<Item = Gear> {
        let first = self.frames.first().copied();
        self.scene.gears.iter().filter_map(move |gear| Some(self.gear(first?, gear)))
    }

    fn gear(&self, poses: &[f64], gear: &scene::Gear) -> Gear {
        let drum = |wheel: &Wheel| Drum::of(self.scene, poses, wheel);
        let around = |wheel: &Wheel, radius: f64| {
            let mut ring: Vec<[f64; 2]> =
                self.ring(drum(wheel).center, drum(wheel).axis, radius).into_iter().map(|p| self.view.flat(p)).collect();
            ring.extend(ring.first().copied());
            ring
        };
        let circle = |wheel: &Wheel| around(wheel, wheel.radius.abs());
        let (a, b) = (drum(&gear.a).center, drum(&gear.b).center);
        match gear.kind {
            GearKind::Rack => {
                let (line, mesh) = winding::pitch_line(self.scene, poses, gear);
                let (line, mesh) = (Some(line.map(|p| self.view.flat(p))), Some(self.view.flat(mesh)));
                Gear { circles: vec![circle(&gear.a)], line, mesh, ..Gear::default() }
            }
            GearKind::Belt => {
                let belt = winding::belt(&drum(&gear.a), &drum(&gear.b)).into_iter().map(|p| self.view.flat(p)).collect();
                Gear { circles: vec![circle(&gear.a), circle(&gear.b)], belt, ..Gear::default() }
            }
            GearKind::Rope => {
                let along = self.scene.direction(poses, gear.b.body, &gear.b.axis);
                let rope = Some([winding::leaving(&drum(&gear.a), b, along), b].map(|p| self.view.flat(p)));
                Gear { belt: circle(&gear.a), rope, ..Gear::default() }
            }
            GearKind::Teeth => {
                let d: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
                let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
                // a gear within one with inner teeth touches it on the far side
                let reach = if gear.b.radius < 0.0 { -gear.a.radius } else { gear.a.radius.abs() };
                let mesh = self.view.flat(std::array::from_fn(|i| a[i] + reach / length * d[i]));
                // those with teeth have it about these
                let toothed = |wheel: &Wheel| self.scene.bodies[wheel.body].shapes.iter().any(|shape| matches!(shape, Shape::Gear { .. }));
                let inner = [&gear.a, &gear.b].into_iter().filter(|wheel| wheel.radius < 0.0 && !toothed(wheel));
                let rims = inner.map(|wheel| around(wheel, RIM * wheel.radius.abs())).collect();
                Gear { circles: vec![circle(&gear.a), circle(&gear.b)], rims, mesh: Some(mesh), ..Gear::default() }
            }
        }
    }
}
