//! Pitch circles and lines in the picture, in the first position.

use super::Posed;
use crate::output::pose::Gear;
use crate::results::scene::{self, Place, Wheel};

impl Posed<'_> {
    pub(super) fn gears(&self) -> impl Iterator<Item = Gear> {
        let first = self.frames.first().copied();
        self.scene.gears.iter().filter_map(move |gear| Some(self.gear(first?, gear)))
    }

    fn gear(&self, poses: &[f64], gear: &scene::Gear) -> Gear {
        let center = |wheel: &Wheel| self.scene.world(poses, &Place { body: wheel.body, at: wheel.at.clone() });
        let axis = |wheel: &Wheel| {
            if wheel.axis.len() == 3 { self.scene.direction(poses, wheel.body, &wheel.axis) } else { [0.0, 0.0, 1.0] }
        };
        let circle = |wheel: &Wheel| {
            let mut ring: Vec<[f64; 2]> =
                self.ring(center(wheel), axis(wheel), wheel.radius.abs()).into_iter().map(|p| self.view.flat(p)).collect();
            ring.extend(ring.first().copied());
            ring
        };
        let (a, b) = (center(&gear.a), center(&gear.b));
        if gear.rack {
            let along = self.scene.direction(poses, gear.b.body, &gear.b.axis);
            // the point of the line below the pinion, wherever the rack has gone
            let s: f64 = (0..3).map(|i| along[i] * (a[i] - b[i])).sum();
            let at = |s: f64| self.view.flat(std::array::from_fn(|i| b[i] + s * along[i]));
            let half = 2.0 * gear.a.radius.abs();
            return Gear { circles: vec![circle(&gear.a)], line: Some([at(s - half), at(s + half)]), mesh: Some(at(s)) };
        }
        let d: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
        // a gear within one with inner teeth touches it on the far side
        let reach = if gear.b.radius < 0.0 { -gear.a.radius } else { gear.a.radius.abs() };
        let mesh = self.view.flat(std::array::from_fn(|i| a[i] + reach / length * d[i]));
        Gear { circles: vec![circle(&gear.a), circle(&gear.b)], line: None, mesh: Some(mesh) }
    }
}
