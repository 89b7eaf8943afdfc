//! What springs store by laws of several pieces, against closed forms.

use crate::common::{State, close, mechanism, study};
use allocation_counter::measure;
use grashof::dynamics::Dynamics;
use grashof::geometry::Planar;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

/// A mass of 1 kg on a slider, with a spring by a law of `stretch`.
fn slide(law: &str, more: &str) -> String {
    format!(
        "grashof: 1
name: slide
space: planar
gravity: none
tables:
  gap: {{ points: [[-10 mm, -1000 N], [-9.9 mm, 0 N], [9.9 mm, 0 N], [10 mm, 1000 N]], beyond: linear }}
  detent: {{ points: [[0 mm, 0 N], [10 mm, 1 N], [20 mm, 0 N], [30 mm, -1 N], [40 mm, 0 N]], beyond: periodic }}
  tyre: {{ points: [[-100 mm, -15 kN], [0 mm, 0 N], [100 mm, 0 N]], beyond: linear }}
  cubic: {{ points: [[-50 mm, -3 N], [-7 mm, 1 N], [2 mm, -1 N], [11 mm, 4 N], [60 mm, 5 N]], between: cubic, beyond: constant }}
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
springs: {{ k: {{ joint: A, force: \"{law}\" }} }}
{more}"
    )
}

/// Energies and forces of the spring at some places, m.
fn energies(law: &str, places: &[f64]) -> Vec<[f64; 2]> {
    let m = mechanism::<Planar<f64>>(&slide(law, ""), Coordinates::Joint);
    let mut d = Dynamics::new(&m);
    let mut at = |x: f64| {
        let mut s = State::random(&m, 1);
        (s.q[0], s.v[0]) = (x, 0.0);
        // modes of the place
        d.terms(s.t, &s.q, &s.v, &s.modes);
        d.switch(&m.force_program, &mut s.modes);
        d.terms(s.t, &s.q, &s.v, &s.modes);
        let mut energy = f64::NAN;
        let before = d.work.force_outputs.clone();
        let info = measure(|| energy = d.spring_energy(0, &s.modes));
        assert_eq!(info.count_total, 0, "an energy allocates");
        assert_eq!(d.work.force_outputs, before);
        assert_eq!(d.unresolved_spring(), None, "{law} at {x}");
        [energy, -d.work.efforts[m.spring_efforts[0]]]
    };
    places.iter().map(|x| at(*x)).collect()
}

/// Holds energies to a closed form, by parts of the largest.
fn hold(law: &str, reach: f64, within: f64, right: impl Fn(f64) -> f64) {
    let places: Vec<f64> = (-40..=40).map(|i| reach * f64::from(i) / 40.0).collect();
    let largest = places.iter().fold(0.0, |m, x| f64::max(m, right(*x).abs()));
    for (x, [found, _]) in places.iter().zip(energies(law, &places)) {
        let off = (found - right(*x)).abs();
        assert!(off <= within * largest, "{law} at {x}: {found:e} for {:e}", right(*x));
    }
}

#[test]
fn laws_of_several_pieces_store_what_their_closed_forms_say() {
    // 1000 N to 0.1 mm
    hold("gap(stretch)", 0.02, 1e-13, |x| 0.5e7 * (x.abs() - 9.9e-3).max(0.0).powi(2));
    hold("if(stretch > 3 mm, 1e4 N/m*(stretch - 3 mm), 0 N)", 0.02, 1e-13, |x| 0.5e4 * (x - 3e-3).max(0.0).powi(2));
    hold("1e4 N/m*max(stretch - 3 mm, min(stretch + 1 mm, 0 mm))", 0.02, 1e-13, |x| {
        0.5e4 * ((x - 3e-3).max(0.0).powi(2) + (x + 1e-3).min(0.0).powi(2))
    });
    // jumps
    hold("if(stretch > 1.234 m, 30 N, if(stretch < -5 cm, -2 N, 0 N))", 20.0, 1e-13, |x| {
        30.0 * (x - 1.234).max(0.0) + 2.0 * (-0.05 - x).max(0.0)
    });
    // a narrow window, told by a magnitude and by a square
    for inside in ["abs(stretch - 7 mm) < 0.1 mm", "(stretch/1 mm - 7)^2 < 0.01"] {
        // the window's ends are known to the rounding of the way, 2e-16 m of 0.2 mm
        hold(&format!("if({inside}, 5 N, 0 N)"), 1.0, 5e-12, |x| 5.0 * (x - 6.9e-3).clamp(0.0, 2e-4));
    }
    hold("mod(stretch, 1 mm)*1 N/mm", 0.1, 1e-12, |x| {
        let part = x * 1e3 - (x * 1e3).floor();
        0.5e-3 * ((x * 1e3).floor() + part * part)
    });
    // of time alone
    hold("if(t > -1e6 s, 5 N, 0 N)", 0.1, 1e-15, |x| 5.0 * x);
    // a root, and a kink that no switch tells but by its magnitude
    hold("1 N*sqrt(abs(stretch)/1 m)", 0.1, 1e-13, |x| x.signum() * x.abs().powf(1.5) / 1.5);
}

#[test]
fn a_detent_stores_the_same_after_any_number_of_turns() {
    let right = |x: f64| {
        let part = (x / 0.04 - (x / 0.04).floor()) * 40.0;
        let energy = match part {
            p if p < 10.0 => 0.05 * p * p,
            p if p < 30.0 => 10.0 - 0.05 * (20.0 - p).powi(2),
            p => 0.05 * (40.0 - p).powi(2),
        };
        energy * 1e-3
    };
    hold("detent(stretch)", 0.06, 1e-12, right);
    hold("detent(stretch)", 40.0 * 0.04 * 1.01, 1e-11, right);
}

#[test]
fn a_cubic_table_stores_the_sum_over_its_segments() {
    // Gauss's rule of two points is exact between knots
    let knots = [0.0, 2e-3, 11e-3, 60e-3];
    let (offset, mut right) = ((1.0_f64 / 3.0).sqrt(), 0.0);
    let mut places = Vec::new();
    for pair in knots.windows(2) {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        places.extend([middle - half * offset, middle + half * offset]);
    }
    places.push(0.1);
    let found = energies("cubic(stretch)", &places);
    for (pair, at) in knots.windows(2).zip(found.chunks(2)) {
        right += 0.5 * (pair[1] - pair[0]) * (at[0][1] + at[1][1]);
    }
    right += 5.0 * 0.04;
    let last = found.last().unwrap()[0];
    assert!((last - right).abs() < 1e-14, "{last} for {right}");
}

/// Next to where a law vanishes its values are nothing but the round-off of what it takes from each other.
#[test]
fn round_off_of_a_law_is_not_taken_for_kinks() {
    let places: Vec<f64> = (1..40).flat_map(|k| [1.0, -1.0].map(|sign| sign * 0.7_f64 * 10_f64.powf(-0.5 * f64::from(k)))).collect();
    for law in ["tyre", "1 kN * (cos(stretch / 1 m) - 1)"] {
        for (x, [found, _]) in places.iter().zip(energies(law, &places)) {
            let right = if law.starts_with("1 kN") {
                // −F is the force that pulls together
                1e3 * (x.sin() - x)
            } else if *x < 0.0 {
                0.5 * 150e3 * x * x
            } else {
                0.0
            };
            let rounding = if law.starts_with("1 kN") { 1e3 } else { 15e3 } * 1e-15 * x.abs();
            assert!((found - right).abs() <= 1e-12 * right.abs() + 4.0 * rounding, "{law} at {x:e}: {found:e} for {right:e}");
        }
    }
}

#[test]
fn smooth_laws_store_to_rounding() {
    hold("100 N/m*stretch + 1e3 N/m^3*stretch^3", 0.5, 1e-15, |x| 50.0 * x * x + 250.0 * x.powi(4));
    // softens within a fiftieth of the way
    let soft = |x: f64| 10.0 * 0.02 * (x / 0.02).cosh().ln();
    hold("10 N*tanh(stretch/2 cm)", 1.0, 1e-14, soft);
    hold("1 N*sin(stretch/1 mm)", 0.2, 1e-13, |x| 1e-3 * (1.0 - (x * 1e3).cos()));
}

/// The study `run` of a mass that flies at 4 m/s.
fn flight(law: &str, study_keys: &str) -> Outcome {
    let more = format!(
        "start: {{ A.position: 0 mm, A.velocity: 4 m/s }}
studies:
  run:
    {study_keys}
    columns: [A.position, energy]
    scalars: {{ lost: max(energy.total) - min(energy.total) }}
"
    );
    study(&slide(law, &more), "run", Coordinates::Joint)
}

#[test]
fn a_mass_on_a_spring_with_play_keeps_its_energy() {
    let outcome = flight("gap(stretch)", "dynamics: { until: 20 ms, tolerance: 1e-12 }");
    let march = outcome.certificate.march.as_ref().unwrap();
    assert!(outcome.scalars[0] < 1e-10 && march.energy_drift < 1e-10, "{:e} {:e}", outcome.scalars[0], march.energy_drift);
    assert!(outcome.findings.is_empty(), "{:?}", outcome.findings);
}

#[test]
fn a_jump_of_a_law_that_time_moves_does_work() {
    // the force rises by 300 N at a place that moves at 0.5 m/s, and by 20 N at one that swings
    let law = "100 N/m*stretch + if(stretch > 2 cm + 0.5 m/s*t, 300 N, 0 N) + if(stretch > 2 cm + 1 cm*sin(40 rad/s*t), 20 N, 0 N)";
    let outcome = flight(law, "dynamics: { until: 0.4 s, tolerance: 1e-11 }");
    let march = outcome.certificate.march.as_ref().unwrap();
    assert!(march.drivers.abs() > 0.1, "{}", march.drivers);
    assert!(march.energy_drift < 1e-8, "{:e} of {:e}", march.energy_drift, march.energy_scale);
}

#[test]
fn a_law_that_jumps_at_an_instant_does_work_at_once() {
    // in each the spring holds another energy behind 0.5 s at the same stretch
    let springs = [
        "force: \"20 N/m*stretch + if(t > 0.5 s, 5 N, 0 N)\"",
        "force: \"if(t > 0.5 s, 20 N/m*stretch, 60 N/m*stretch) + if(t > 0.7 s and stretch > 1 cm, 3 N, 0 N)\"",
        "stiffness: 20 N/m, rest: \"if(t > 0.5 s, 3 cm, 0 m)\"",
        "stiffness: \"if(t > 0.5 s, 20 N/m, 60 N/m)\", preload: \"if(t > 0.7 s, 1 N, 0 N)\"",
    ];
    for spring in springs {
        let text = format!(
            "grashof: 1
name: slide
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
springs: {{ k: {{ joint: A, {spring} }} }}
start: {{ A.position: 0.4 m }}
studies:
  run:
    dynamics: {{ until: 1.2 s, every: 0.1 s, tolerance: 1e-11 }}
    columns: [A.position, A.velocity, k.energy, energy.total]
    scalars: {{ most: max(k.energy) }}
"
        );
        let outcome = study(&text, "run", Coordinates::Joint);
        let march = outcome.certificate.march.as_ref().unwrap();
        assert!(march.energy_drift < 1e-8, "{spring}: {:e} of {:e}", march.energy_drift, march.energy_scale);
        let (first, last) = (&outcome.rows[0], outcome.rows.iter().last().unwrap());
        close(spring, &[last[3] - first[3]], &[march.drivers], 1e-8);
        // both rows of the instant: at the same place and speed, with another energy
        let at = *outcome.switches.iter().find(|row| (outcome.places[**row] - 0.5).abs() < 1e-9).unwrap();
        let [before, behind] = [0, 1].map(|side| &outcome.rows[at + side]);
        close(spring, &[before[0], before[1]], &[behind[0], behind[1]], 1e-12);
        assert!((before[2] - behind[2]).abs() > 0.01, "{spring}: {before:?} {behind:?}");
        let unchanged = (0..=at).all(|row| (outcome.rows[row][3] - first[3]).abs() < 1e-8);
        assert!(unchanged, "{spring}");
    }
}

#[test]
fn a_law_of_more_pieces_than_are_followed_is_told() {
    let more = "drivers: { d: { joint: A, speed: 1 m/s } }
start: { A.position: 1 m }
studies: { run: { inverse: { over: 1 um, samples: 2 }, columns: [A.position, k.energy] } }
";
    let outcome = study(&slide("mod(stretch, 1e-4 m)*1 N/mm", more), "run", Coordinates::Joint);
    let told: Vec<&str> = outcome.findings.iter().map(|f| f.message.as_str()).filter(|m| m.contains("spring `k`")).collect();
    assert_eq!(told.len(), 1, "{:?}", outcome.findings);
    assert!(told[0].contains("more kinks and jumps than are followed"), "{}", told[0]);
}
