//! What a start leaves open is as near to the drawn pose, and as near to rest, as it can be.

use crate::common::{assembled, close};
use grashof::dynamics::Dynamics;
use grashof::geometry::Planar;
use grashof::kinematics::assemble::Assembled;
use grashof::mechanism::{Coordinates, Mechanism, RowKind};
use std::f64::consts::TAU;

const BARS: &str = "grashof: 1
name: two bars
space: planar
gravity: none
bodies: { upper: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, upper.start] }, Q: { revolute: [upper.end, lower.start] } }
";

const FOUR_BAR: &str = "grashof: 1
name: four-bar
space: planar
gravity: none
ground: { O: [0, 0], C: [30 cm, 0] }
bodies: { crank: { bar: { length: 10 cm } }, coupler: { bar: { length: 30 cm } }, rocker: { bar: { length: 25 cm } } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
";

/// First coordinates and rates of all joints.
fn joints(m: &Mechanism<Planar<f64>>, start: &Assembled) -> Vec<[f64; 2]> {
    let mut d = Dynamics::new(m);
    d.time(0.0, &start.modes);
    d.position(&start.q, &start.modes);
    d.velocity(&start.v, &start.modes);
    d.watch(&start.q, &start.v, &start.modes);
    m.joints.iter().filter_map(|j| j.slots.first()).map(|&slot| [d.work.readings[slot].x, d.work.readings[slot].rate]).collect()
}

#[test]
fn two_bars_share_what_is_asked_of_the_outer_one() {
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let text = format!("{BARS}start: {{ lower.angle: 60 deg, lower.omega: 3 rad/s }}\n");
        let (m, start) = assembled(&text, coordinates);
        close("shares", joints(&m, &start).as_flattened(), &[TAU / 12.0, 1.5, TAU / 12.0, 1.5], 1e-12);
        // one rad counts as much as the size, 1 m: P turns, Q rests, and the energy is that of one stiff bar bent by a right angle
        let text = format!("{BARS}start: {{ P.angle: 0, Q.angle: 90 deg, P.omega: 1 rad/s }}\n");
        let (m, start) = assembled::<Planar<f64>>(&text, coordinates);
        let mut d = Dynamics::new(&m);
        d.terms(0.0, &start.q, &start.v, &start.modes);
        close("energy", &[d.kinetic_energy()], &[5.0 / 6.0], 1e-13);
    }
}

/// Sum of squares of the four angles, whole turns left out, and of their rates.
fn sums(text: &str) -> [f64; 2] {
    let (m, start) = assembled(text, Coordinates::Joint);
    let wrapped = |x: f64| x - TAU * (x / TAU).round();
    joints(&m, &start).iter().fold([0.0; 2], |[x, v], [angle, rate]| [x + wrapped(*angle).powi(2), v + rate * rate])
}

#[test]
fn a_loop_begins_where_no_place_beside_is_nearer_to_the_drawing() {
    let (m, start) = assembled(FOUR_BAR, Coordinates::Joint);
    let [angle, _] = joints(&m, &start)[0];
    let [least, _] = sums(FOUR_BAR);
    let others = &start.q[1..];
    for beside in [-1e-2, -1e-3, 1e-3, 1e-2] {
        let text =
            format!("{FOUR_BAR}start: {{ O.angle: {} rad, A.angle: ~{} rad, C.angle: ~{} rad }}\n", angle + beside, others[0], others[1]);
        let (m, beside) = assembled(&text, Coordinates::Joint);
        let sum: f64 = joints(&m, &beside).iter().map(|[x, _]| x * x).sum();
        assert!(sum > least, "{sum} beside {least}");
    }
}

/// A guess that cannot be met is missed by as little as can be: a rocker of 25 cm on a crank that turns fully swings only so far.
#[test]
fn a_guess_beyond_reach_ends_at_the_edge() {
    let text = format!("{FOUR_BAR}start: {{ rocker.angle: ~150 deg, coupler.angle: ~40 deg, O.angle: ~40 deg }}\n");
    let (_, start) = assembled::<Planar<f64>>(&text, Coordinates::Joint);
    let miss = |start: &Assembled| start.found.iter().filter(|f| f.guess).map(|f| (f.found - f.asked).powi(2)).sum::<f64>();
    let least = miss(&start);
    let crank = start.found[2].found;
    for beside in [-1e-2, 1e-2] {
        let held = text.replace("O.angle: ~40 deg", &format!("O.angle: {} rad", crank + beside));
        let (_, other) = assembled::<Planar<f64>>(&held, Coordinates::Joint);
        let off = miss(&other) + (crank + beside - TAU / 9.0).powi(2);
        assert!(off > least, "{off} beside {least}");
    }
}

/// A distance without a length is the one at the start.
#[test]
fn a_distance_without_a_length_is_that_of_the_start() {
    let text = format!("{BARS}  ground: 0\nstart: {{ P.angle: 90 deg, Q.angle: 90 deg }}\n")
        .replace("  ground: 0\n", "")
        .replace("lower.start] } }", "lower.start] }, D: { distance: [ground, lower.end] } }");
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let (m, _) = assembled::<Planar<f64>>(&text, coordinates);
        let row = m.joints[2].rows.start;
        assert!(matches!(m.rows[row].kind, RowKind::Gauge(_)));
        assert!((m.rows[row].offset - 2f64.sqrt()).abs() < 1e-12, "{}", m.rows[row].offset);
    }
}

/// Whole turns are no way to go: they are made at once, in loops, too.
#[test]
fn starts_after_many_turns() {
    let guess = "coupler.angle: ~56 deg, rocker.angle: ~97 deg";
    let (m, right) = assembled(&format!("{FOUR_BAR}start: {{ O.angle: 20 deg, {guess} }}\n"), Coordinates::Joint);
    let right = joints(&m, &right);
    for turns in [-7.0_f64, 50.0, 1e4] {
        let text = format!("{FOUR_BAR}start: {{ O.angle: 20 deg + {turns} turn, {guess} }}\n");
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let (m, start) = assembled(&text, coordinates);
            let found = joints(&m, &start);
            for (found, right) in found.iter().zip(&right) {
                let off = (found[0] - right[0]).rem_euclid(TAU);
                assert!(off.min(TAU - off) < 1e-10 * (1.0 + turns.abs()), "{turns} turns: {found:?} {right:?}");
            }
            assert!((found[0][0] - right[0][0] - turns * TAU).abs() < 1e-9);
        }
    }
}
