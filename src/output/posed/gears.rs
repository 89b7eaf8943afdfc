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
            return Gear { circles: vec![circle(&gear.a)], line: Some([at(s - half), at(s + half)]), mesh: Some(at(s)), ..Gear::default() };
        }
        if gear.belt {
            let belt = belt(self.view.flat(a), gear.a.radius, self.view.flat(b), gear.b.radius);
            return Gear { circles: vec![circle(&gear.a), circle(&gear.b)], belt, ..Gear::default() };
        }
        let d: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
        // a gear within one with inner teeth touches it on the far side
        let reach = if gear.b.radius < 0.0 { -gear.a.radius } else { gear.a.radius.abs() };
        let mesh = self.view.flat(std::array::from_fn(|i| a[i] + reach / length * d[i]));
        Gear { circles: vec![circle(&gear.a), circle(&gear.b)], mesh: Some(mesh), ..Gear::default() }
    }
}

/// A belt around two wheels that do not touch: their outer tangents, and the arcs between these.
fn belt(a: [f64; 2], ra: f64, b: [f64; 2], rb: f64) -> Vec<[f64; 2]> {
    /// Points of each arc.
    const ARC: usize = 32;
    let d = [b[0] - a[0], b[1] - a[1]];
    let (distance, toward) = (d[0].hypot(d[1]), d[1].atan2(d[0]));
    // the direction of a radius to a tangent, from the line of centres
    let lean = ((ra - rb) / distance).clamp(-1.0, 1.0).acos();
    let arc = |[x, y]: [f64; 2], radius: f64, from: f64, to: f64| {
        (0..=ARC).map(move |k| {
            let (s, c) = (toward + from + (to - from) * k as f64 / ARC as f64).sin_cos();
            [x + radius * c, y + radius * s]
        })
    };
    arc(a, ra, lean, std::f64::consts::TAU - lean).chain(arc(b, rb, -lean, lean)).collect()
}
