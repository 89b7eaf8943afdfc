//! Pitch circles and lines in the picture, in the first position.

use super::Posed;
use crate::output::pose::Gear;
use crate::results::scene::{self, GearKind, Place, Wheel};

/// Radius of the rim of a wheel with inner teeth, as a multiple of that of its pitch circle.
const RIM: f64 = 1.08;

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
        let around = |wheel: &Wheel, radius: f64| {
            let mut ring: Vec<[f64; 2]> = self.ring(center(wheel), axis(wheel), radius).into_iter().map(|p| self.view.flat(p)).collect();
            ring.extend(ring.first().copied());
            ring
        };
        let circle = |wheel: &Wheel| around(wheel, wheel.radius.abs());
        let (a, b) = (center(&gear.a), center(&gear.b));
        match gear.kind {
            GearKind::Rack => {
                let along = self.scene.direction(poses, gear.b.body, &gear.b.axis);
                // the point of the line below the pinion, wherever the rack has gone
                let s: f64 = (0..3).map(|i| along[i] * (a[i] - b[i])).sum();
                let at = |s: f64| self.view.flat(std::array::from_fn(|i| b[i] + s * along[i]));
                let half = 2.0 * gear.a.radius.abs();
                let line = Some([at(s - half), at(s + half)]);
                Gear { circles: vec![circle(&gear.a)], line, mesh: Some(at(s)), ..Gear::default() }
            }
            GearKind::Belt => {
                let belt = belt(self.view.flat(a), gear.a.radius, self.view.flat(b), gear.b.radius);
                Gear { circles: vec![circle(&gear.a), circle(&gear.b)], belt, ..Gear::default() }
            }
            GearKind::Rope => {
                let [x, y, _] = self.scene.direction(poses, gear.b.body, &gear.b.axis);
                let (center, end) = (self.view.flat(a), self.view.flat(b));
                let rope = Some([leaving(center, gear.a.radius, end, [y, -x]), end]);
                Gear { belt: circle(&gear.a), rope, ..Gear::default() }
            }
            GearKind::Teeth => {
                let d: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
                let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
                // a gear within one with inner teeth touches it on the far side
                let reach = if gear.b.radius < 0.0 { -gear.a.radius } else { gear.a.radius.abs() };
                let mesh = self.view.flat(std::array::from_fn(|i| a[i] + reach / length * d[i]));
                let inner = [&gear.a, &gear.b].into_iter().filter(|wheel| wheel.radius < 0.0);
                let rims = inner.map(|wheel| around(wheel, RIM * wheel.radius.abs())).collect();
                Gear { circles: vec![circle(&gear.a), circle(&gear.b)], rims, mesh: Some(mesh), ..Gear::default() }
            }
        }
    }
}

/// Where a rope to `end` leaves a drum: the point at which it touches the drum that lies towards `side`, or the drum's point there if the
/// end is within the drum.
///
/// The radius to it and the line from the centre to the end, at a distance d, have an angle of acos(r/d) between them.
fn leaving(center: [f64; 2], radius: f64, end: [f64; 2], side: [f64; 2]) -> [f64; 2] {
    let d = [end[0] - center[0], end[1] - center[1]];
    let distance = d[0].hypot(d[1]);
    if distance <= radius {
        return [center[0] + radius * side[0], center[1] + radius * side[1]];
    }
    let (toward, lean) = (d[1].atan2(d[0]), (radius / distance).acos());
    let radii = [toward - lean, toward + lean].map(|angle| [angle.cos(), angle.sin()]);
    let facing = radii.map(|[x, y]| x * side[0] + y * side[1]);
    let [x, y] = if facing[0] >= facing[1] { radii[0] } else { radii[1] };
    [center[0] + radius * x, center[1] + radius * y]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rope_leaves_its_drum_along_a_tangent() {
        // below the right side of the drum it hangs straight down
        let at = leaving([1.0, 2.0], 0.5, [1.5, -3.0], [1.0, 0.0]);
        assert!((at[0] - 1.5).hypot(at[1] - 2.0) < 1e-12, "{at:?}");
        // elsewhere the radius stays at right angles to it, on the side that is asked for
        for side in [[1.0, 0.0], [-1.0, 0.0]] {
            let [x, y] = leaving([0.0; 2], 0.5, [0.1, -2.0], side);
            assert!((x * (0.1 - x) + y * (-2.0 - y)).abs() < 1e-12 && x * side[0] > 0.0, "{x} {y}");
        }
        assert_eq!(leaving([0.0; 2], 1.0, [0.2, 0.0], [0.0, 1.0]), [0.0, 1.0]);
    }
}
