//! First-order states at rest: what they keep, in which units they are, and the slow motions that they add.

use super::{findings, list, near, planar};

const SLIDE: &str = "bodies: { a: { mass: 1 kg } }\njoints: { S: { slider: [ground, a.origin], axis: [1, 0], damping: 20 N s/m } }";

#[test]
fn sums_that_no_rate_changes_stay_as_they_start() {
    // hot + 3 cold = 160
    let outcome = planar(
        "none",
        &format!(
            "{SLIDE}
springs: {{ k: {{ joint: S, stiffness: 10 N/m }} }}
states:
  hot: {{ start: 100, rate: (cold - hot)/1 s }}
  cold: {{ start: 20, rate: (hot - cold)/3 s }}
loads: {{ f: {{ joint: S, force: 0.1 N*hot }} }}"
        ),
        "x: last(S.position), h: last(hot), c: last(cold)",
    );
    assert!(
        outcome.scalars.iter().zip([0.4, 40.0, 40.0]).all(|(found, wanted)| (found / wanted - 1.0).abs() < 1e-12),
        "{:?}",
        outcome.scalars
    );
    // two integrators of one error: 3 za − 2 zb = −8
    let both = planar(
        "[-10, 0]",
        &format!(
            "{SLIDE}
states:
  za: {{ start: 0 N, rate: -(2 N/s/m)*(S.position - 0.1 m) }}
  zb: {{ start: 4 N, rate: -(3 N/s/m)*(S.position - 0.1 m) }}
loads: {{ f: {{ joint: S, force: za + zb - (20 N/m)*(S.position - 0.1 m) }} }}"
        ),
        "x: last(S.position), a: last(za), b: last(zb)",
    );
    assert!(both.scalars.iter().zip([0.1, 2.4, 7.6]).all(|(found, wanted)| (found / wanted - 1.0).abs() < 1e-11), "{:?}", both.scalars);
    assert_eq!(both.results, [1.0]);
}

#[test]
fn a_state_in_small_units_comes_to_rest() {
    // oil in cubic millimetres: area·x + pressure·dead/bulk with the pressure of 10 N on 10 mm²
    let outcome = planar(
        "[-10, 0]",
        &format!(
            "{SLIDE}
parameters: {{ area: 10 mm^2, bulk: 1 GPa, dead: 1000 mm^3, gain: 5 mm^2/s, wanted: 10 mm }}
states: {{ oil: {{ start: 100 mm^3, rate: gain*(wanted - S.position) }} }}
loads: {{ f: {{ joint: S, force: area*bulk*(oil - area*S.position)/dead }} }}
start: {{ S.position: 9 mm }}"
        ),
        "x: last(S.position), v: last(oil)/1 mm^3",
    );
    near(outcome.scalars[0], 0.01, 1e-14);
    near(outcome.scalars[1], 101.0, 1e-9);
    assert!(findings(&outcome, "state-without-rest").is_empty());
}

#[test]
fn a_slow_motion_that_grows_is_unstable_beside_fast_ones() {
    // 1e-3/s beside 2e4/s
    let coil = |runaway: f64| {
        planar(
            "none",
            &format!(
                "{SLIDE}
springs: {{ k: {{ joint: S, stiffness: 1 kN/m }} }}
states:
  i: {{ start: 0 A, rate: (1 V - (2 ohm)*i - (10 V s/m)*S.velocity)/(1e-4 H) }}
  T: {{ start: 300, rate: {runaway}*(T - 300)/1 s }}
loads: {{ f: {{ joint: S, force: (10 N/A)*i*(1 - 0.004*(T - 300)) }} }}"
            ),
            "x: last(S.position)",
        )
    };
    for (runaway, stable) in [(1e-3, 0.0), (-1e-5, 1.0)] {
        let outcome = coil(runaway);
        near(outcome.scalars[0], 0.005, 1e-14);
        assert_eq!(outcome.results, [stable], "{runaway}");
    }
}

#[test]
fn positions_in_which_a_state_does_not_rest_are_no_equilibria() {
    // a double well at ±1 m; beyond 0.5 m the controller goes on and on
    let outcome = planar(
        "none",
        &format!(
            "{SLIDE}
springs: {{ well: {{ joint: S, force: (4 N/m^3)*stretch^3 - (4 N/m)*stretch }} }}
states: {{ z: {{ start: 0 N, rate: \"-(2 N/s/m)*max(0 m, S.position - 0.5 m)\" }} }}
loads: {{ f: {{ joint: S, force: z }} }}
start: {{ S.position: -0.8 m }}"
        ),
        "x: last(S.position)",
    );
    near(outcome.scalars[0], -1.0, 1e-12);
    assert!(list(&outcome, "equilibria.S.position").iter().all(|x| *x < 0.5), "{:?}", outcome.lists);
}
