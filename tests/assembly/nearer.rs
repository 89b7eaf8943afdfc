//! Of several assemblies that meet the start, the one nearest to the drawn pose is taken.

use crate::common::{Noise, assembled};
use grashof::dynamics::Dynamics;
use grashof::geometry::Planar;
use grashof::mechanism::Coordinates;
use std::f64::consts::TAU;

use super::apart;

/// A point of the plane.
type Point = [f64; 2];

/// The angle of the line from `a` to `b`.
fn angle(a: Point, b: Point) -> f64 {
    (b[1] - a[1]).atan2(b[0] - a[0])
}

/// The point at a distance and angle from another.
fn at(from: Point, length: f64, angle: f64) -> Point {
    [from[0] + length * angle.cos(), from[1] + length * angle.sin()]
}

/// The two points at distances `ra` from `a` and `rb` from `b`, if the circles meet well.
fn meet(a: Point, ra: f64, b: Point, rb: f64) -> Option<[Point; 2]> {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let d = dx.hypot(dy);
    let along = (d * d + ra * ra - rb * rb) / (2.0 * d);
    let up = ra * ra - along * along;
    (up > 0.01 * ra * ra).then(|| {
        [1.0, -1.0].map(|side| {
            let up = side * up.sqrt();
            [a[0] + (along * dx - up * dy) / d, a[1] + (along * dy + up * dx) / d]
        })
    })
}

/// How far hinges are from where they are drawn, whole turns aside.
fn distance(hinges: &[f64]) -> f64 {
    hinges.iter().map(|x| apart(*x, 0.0).powi(2)).sum::<f64>().sqrt()
}

/// Holds the hinges against the nearest of some assemblies; whether it is nearer than the others by a hundredth.
fn hold(text: &str, mut assemblies: Vec<Vec<f64>>) -> bool {
    assemblies.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    if distance(&assemblies[0]) > 0.99 * distance(&assemblies[1]) {
        return false;
    }
    let (m, start) = assembled::<Planar<f64>>(text, Coordinates::Joint);
    let mut d = Dynamics::new(&m);
    d.terms(0.0, &start.q, &start.v, &start.modes);
    d.watch(&start.q, &start.v, &start.modes);
    let found: Vec<f64> = m.joints.iter().map(|joint| d.work.readings[joint.slots[0]].x).collect();
    assert_eq!(found.len(), assemblies[0].len());
    assert!(found.iter().all(|x| x.abs() < 1.5 * TAU), "whole turns in {found:?} in\n{text}");
    let off = found.iter().zip(&assemblies[0]).map(|(x, right)| apart(*x, *right).abs()).fold(0.0, f64::max);
    assert!(off < 1e-9, "{found:?} for {assemblies:?} in\n{text}");
    true
}

/// A four-bar of lengths on a base of 300 mm, with more bodies, joints and a start.
fn four_bar([l1, l2, l3]: [f64; 3], bodies: &str, joints: &str, start: &str) -> String {
    format!(
        "grashof: 1
name: four-bar
space: planar
gravity: none
ground: {{ O: [0, 0], C: [300 mm, 0], D: [400 mm, 150 mm] }}
bodies:
  crank: {{ bar: {{ length: {l1} m }} }}
  coupler: {{ bar: {{ length: {l2} m }} }}
  rocker: {{ bar: {{ length: {l3} m }} }}
{bodies}joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
{joints}start: {{ {start} }}
"
    )
}

/// Hinges O, A, B, C of a four-bar.
fn hinges(o: Point, a: Point, b: Point, c: Point) -> Vec<f64> {
    let [crank, coupler, rocker] = [angle(o, a), angle(a, b), angle(c, b)];
    vec![crank, coupler - crank, rocker - coupler, rocker]
}

const O: Point = [0.0, 0.0];
const C: Point = [0.3, 0.0];
const D: Point = [0.4, 0.15];

#[test]
fn a_four_bar_stands_on_the_nearer_assembly() {
    let mut noise = Noise(3);
    let mut between = move |low: f64, high: f64| low + (high - low) * 0.5 * (noise.next() + 1.0);
    let mut held = 0;
    for case in 0..200 {
        let [l1, l2, l3] = [between(0.05, 0.3), between(0.2, 0.4), between(0.15, 0.4)];
        let given = between(-0.5 * TAU, 0.5 * TAU);
        let (name, ends) = if case % 2 == 0 {
            let a = at(O, l1, given);
            ("O.angle", meet(a, l2, C, l3).map(|both| both.map(|b| hinges(O, a, b, C))))
        } else {
            let b = at(C, l3, given);
            ("rocker.angle", meet(O, l1, b, l2).map(|both| both.map(|a| hinges(O, a, b, C))))
        };
        let Some(ends) = ends else { continue };
        // a guess of the crank is met as well, and chooses no assembly
        for guess in if case % 2 == 0 { &["", "~"][..] } else { &[""] } {
            let text = four_bar([l1, l2, l3], "", "", &format!("{name}: {guess}{given} rad"));
            held += usize::from(hold(&text, ends.to_vec()));
        }
    }
    assert!(held > 120, "{held}");
}

/// Two more bars from the end of the rocker to the ground: four assemblies.
#[test]
fn a_linkage_of_two_loops_stands_on_the_nearest_of_its_assemblies() {
    let mut noise = Noise(5);
    let mut between = move |low: f64, high: f64| low + (high - low) * 0.5 * (noise.next() + 1.0);
    let mut held = 0;
    for _ in 0..60 {
        let [l1, l2, l3] = [between(0.05, 0.3), between(0.2, 0.4), between(0.15, 0.4)];
        let [l4, l5] = [between(0.2, 0.5), between(0.2, 0.5)];
        let given = between(-0.5 * TAU, 0.5 * TAU);
        let a = at(O, l1, given);
        let Some(both) = meet(a, l2, C, l3) else { continue };
        let mut all = Vec::new();
        for b in both {
            for e in meet(b, l4, D, l5).into_iter().flatten() {
                let [rocker, link, lever] = [angle(C, b), angle(b, e), angle(D, e)];
                all.push([hinges(O, a, b, C), vec![link - rocker, lever - link, lever]].concat());
            }
        }
        if all.len() < 2 {
            continue;
        }
        let bodies = format!("  link: {{ bar: {{ length: {l4} m }} }}\n  lever: {{ bar: {{ length: {l5} m }} }}\n");
        let joints = "  E: { revolute: [rocker.end, link.start] }
  F: { revolute: [link.end, lever.end] }
  G: { revolute: [ground.D, lever.start] }
";
        let text = four_bar([l1, l2, l3], &bodies, joints, &format!("O.angle: {given} rad"));
        held += usize::from(hold(&text, all));
    }
    assert!(held > 20, "{held}");
}
