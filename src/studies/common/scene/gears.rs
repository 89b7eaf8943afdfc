//! Pitch circles of gears and racks, which the model does not give: they follow from the ratio and the distance of the axes.
//!
//! With both hinges on one carrier, at a distance d, and wheels that turn relative to it by φ_b = ρ φ_a: teeth that run on each other
//! turn outer gears against each other, ρ < 0, r_a + r_b = d; one with inner teeth turns like the other, ρ > 0, |r_a − r_b| = d; in
//! both |ρ| = r_a/r_b. Wheels that turn alike and whose outlines stand apart are joined by a belt, r_a = ρ r_b.

use super::places::numbers;
use crate::geometry::Space;
use crate::mechanism::{Joint, Mechanism, Outline, RowKind, RowOwner};
use crate::results::Scene;
use crate::results::scene::{Gear, Wheel};

/// The gears of a mechanism whose circles can be told. The frames of the scene are there.
pub(super) fn gears<G: Space<S = f64>>(mechanism: &Mechanism<G>, scene: &Scene) -> Vec<Gear> {
    let rows = mechanism.rows.iter().filter(|row| row.owner == RowOwner::Coupling);
    rows.filter_map(|row| {
        let RowKind::Ratio { first, second, ratio } = row.kind else { return None };
        let of_gauge = |gauge: usize| mechanism.joints.iter().find(|joint| joint.slots.first() == Some(&gauge));
        let (first, second) = (of_gauge(first)?, of_gauge(second)?);
        match (first.kind, second.kind) {
            ("revolute", "revolute") => pair(mechanism, &row.label, first, second, ratio),
            ("revolute", "slider") => rack(&row.label, first, second, ratio, scene),
            _ => None,
        }
    })
    .collect()
}

/// A wheel on its hinge: its side of the joint and that of the carrier, and 1 if the wheel is the second body.
struct Hung<G: Space> {
    wheel: (usize, G::Vector),
    carrier: (usize, G::Vector),
    sign: f64,
}

impl<G: Space<S = f64>> Hung<G> {
    /// The wheel of a hinge whose other body is the carrier.
    fn on(joint: &Joint<G>, carrier: usize) -> Option<Self> {
        match carrier {
            _ if joint.a.0 == carrier => Some(Self { wheel: joint.b, carrier: joint.a, sign: 1.0 }),
            _ if joint.b.0 == carrier => Some(Self { wheel: joint.a, carrier: joint.b, sign: -1.0 }),
            _ => None,
        }
    }

    /// Its pitch circle; hinges have the same numbers of their axis in both bodies, or nearly none.
    fn circle(&self, joint: &Joint<G>, radius: f64) -> Wheel {
        let axis = if G::VECTOR == 3 { joint.axis.to_vec() } else { Vec::new() };
        Wheel { body: self.wheel.0, at: numbers::<G>(self.wheel.1), radius, axis }
    }
}

/// Two gears.
fn pair<G: Space<S = f64>>(mechanism: &Mechanism<G>, name: &str, first: &Joint<G>, second: &Joint<G>, ratio: f64) -> Option<Gear> {
    let carrier = [first.a.0, first.b.0].into_iter().find(|body| *body == second.a.0 || *body == second.b.0)?;
    let (a, b) = (Hung::on(first, carrier)?, Hung::on(second, carrier)?);
    // in space the axes of both are told in the carrier only if it is the first body of both
    let facing = if G::VECTOR == 3 { (0..3).map(|i| first.axis[i] * second.axis[i]).sum::<f64>() } else { 1.0 };
    if facing.abs() < 1.0 - 1e-6 {
        return None;
    }
    let apart = b.carrier.1 - a.carrier.1;
    let along = if G::VECTOR == 3 { G::dot(apart, G::vector(&first.axis)) } else { 0.0 };
    let distance = (G::dot(apart, apart) - along * along).max(0.0).sqrt();
    let turned = ratio * a.sign * b.sign * facing.signum();
    let reaches = [a.wheel, b.wheel].map(|(body, hinge)| reach(mechanism, body, hinge));
    if let Some([ra, rb]) = belted(turned, distance, reaches) {
        return Some(Gear { name: name.into(), a: a.circle(first, ra), b: b.circle(second, rb), rack: false, belt: true });
    }
    let [ra, rb] = radii(turned, distance)?;
    Some(Gear { name: name.into(), a: a.circle(first, ra), b: b.circle(second, rb), rack: false, belt: false })
}

/// How far the outline of a wheel reaches from its hinge, m; 0 if it has none.
fn reach<G: Space<S = f64>>(mechanism: &Mechanism<G>, body: usize, hinge: G::Vector) -> f64 {
    let body = &mechanism.bodies[body];
    let round = match body.outline {
        Some(Outline::Disc { radius, .. }) => radius,
        _ => 0.0,
    };
    body.drawn.iter().map(|at| G::dot(*at - hinge, *at - hinge).sqrt()).fold(round, f64::max)
}

/// Radii of two wheels under a belt, within their outlines: wheels that turn alike, of which neither is within the other.
fn belted(ratio: f64, distance: f64, [a, b]: [f64; 2]) -> Option<[f64; 2]> {
    let apart = ratio > 0.0 && a > 0.0 && b > 0.0 && a + b < distance;
    let rb = b.min(a / ratio);
    (apart && rb > 0.0 && rb.is_finite()).then_some([ratio * rb, rb])
}

/// Radii of two gears, the one with inner teeth negative.
fn radii(ratio: f64, distance: f64) -> Option<[f64; 2]> {
    let size = ratio.abs();
    let usable = |r: f64| (r > 0.0 && r.is_finite() && distance > 0.0).then_some(r);
    if ratio < 0.0 {
        let rb = usable(distance / (1.0 + size))?;
        return Some([size * rb, rb]);
    }
    let rb = usable(distance / (size - 1.0).abs())?;
    // that with inner teeth is the larger one
    Some(if size > 1.0 { [-size * rb, rb] } else { [size * rb, -rb] })
}

/// A pinion and its rack: the line that the pinion touches at −r n, with n a quarter turn ahead of the slide.
fn rack<G: Space<S = f64>>(name: &str, pinion: &Joint<G>, slide: &Joint<G>, radius: f64, scene: &Scene) -> Option<Gear> {
    let carrier = [pinion.a.0, pinion.b.0].into_iter().find(|body| *body == slide.a.0 || *body == slide.b.0)?;
    let (wheel, moved) = (Hung::on(pinion, carrier)?, Hung::on(slide, carrier)?);
    if G::VECTOR == 3 || scene.frames.count() == 0 {
        return None;
    }
    let poses = scene.frame(0);
    let axis = scene.direction(poses, slide.a.0, &slide.axis[..2]);
    let signed = radius * wheel.sign * moved.sign;
    let center = scene.world(poses, &super::places::place::<G>(wheel.wheel));
    // a point at c moves by φ z × c: that is r φ u for c = −r z × u
    let touched = [center[0] + signed * axis[1], center[1] - signed * axis[0], 0.0];
    let origin = scene.world(poses, &super::places::place::<G>((moved.wheel.0, G::Vector::default())));
    let [ex, ey] = [[1.0, 0.0], [0.0, 1.0]].map(|e| scene.direction(poses, moved.wheel.0, &e));
    let own = |v: [f64; 3]| vec![ex[0] * v[0] + ex[1] * v[1], ey[0] * v[0] + ey[1] * v[1]];
    let line = Wheel { body: moved.wheel.0, at: own(std::array::from_fn(|i| touched[i] - origin[i])), radius: 0.0, axis: own(axis) };
    Some(Gear { name: name.into(), a: wheel.circle(pinion, radius.abs()), b: line, rack: true, belt: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_fit_the_distance_and_the_ratio() {
        assert_eq!(radii(-2.0, 3.0), Some([2.0, 1.0]));
        assert_eq!(radii(3.0, 4.0), Some([-6.0, 2.0]));
        assert_eq!(radii(0.5, 1.0), Some([1.0, -2.0]));
        assert_eq!(radii(1.0, 1.0), None);
        assert_eq!(radii(-1.0, 0.0), None);
        // a belt: the smaller wheel turns four times as fast
        assert_eq!(belted(0.25, 0.5, [0.05, 0.16]), Some([0.04, 0.16]));
        assert_eq!((belted(0.25, 0.1, [0.04, 0.16]), belted(-1.0, 1.0, [0.1, 0.1]), belted(1.0, 1.0, [0.0, 0.1])), (None, None, None));
    }
}
