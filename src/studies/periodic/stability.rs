//! What Floquet's multipliers say of a periodic motion.

use crate::results::{Finding, List};
use nalgebra::Complex;

/// Moduli within this of 1 are told as those of a bifurcation.
const NEAR: f64 = 1e-3;

/// Moduli within this of 1 count as 1: the error of the multipliers where they meet.
const NEUTRAL: f64 = 1e-6;

/// What a motion is that keeps its energy.
const FAMILY: &str = "no force takes or gives energy, so that the motion is one of a family, one for every energy, and no regime in which the mechanism settles: amplitude and period are those of the energy that the search began with, and a deviation neither grows nor dies out (a multiplier is 1); another start gives another motion of the family";

/// What a motion is whose neighbours are periodic, too, though forces take and give energy in it.
const NEIGHBOURS: &str = "the motions beside it are periodic, too: in a period of each of them forces give as much as they take, so that the motion is one of a family, and no regime in which the mechanism settles; a deviation neither grows nor dies out (a multiplier is 1)";

/// What chooses among a family in which something advances.
const EVERY_SPEED: &str = "; every speed is a regime, and the mean speed found is that of the motion from the start; what depends on the speed, as damping, would choose one";

/// What chooses among another one.
const BY_START: &str = "; which of them is found the start decides";

/// Which neighbours of a motion are periodic, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Neighbours {
    /// None.
    Apart,
    /// A family, one for every energy: no force takes or gives any.
    Energies,
    /// A family in which forces give as much as they take; whether something advances in it, by itself.
    Balanced { advances: bool },
}

/// The multipliers as lists.
pub(super) fn lists(multipliers: &[Complex<f64>]) -> Vec<List> {
    let list = |part: &str, of: fn(&Complex<f64>) -> f64| List {
        name: format!("multipliers_{part}"),
        values: multipliers.iter().map(of).collect(),
        ..List::default()
    };
    vec![list("real", |m| m.re), list("imaginary", |m| m.im), list("modulus", |m| m.norm())]
}

/// Stability in words.
pub(super) fn finding(multipliers: &[Complex<f64>], neighbours: Neighbours, place: &str) -> Finding {
    let family = match neighbours {
        Neighbours::Apart => None,
        Neighbours::Energies => Some(FAMILY.to_owned()),
        Neighbours::Balanced { advances } => Some(NEIGHBOURS.to_owned() + if advances { EVERY_SPEED } else { BY_START }),
    };
    let largest = multipliers.first().map_or(0.0, |m| m.norm());
    // two multipliers that meet at 1 are apart by the root of the error
    let neutral = if family.is_some() { NEAR } else { NEUTRAL };
    let (code, message) = if largest > 1.0 + neutral {
        let count = multipliers.iter().filter(|m| m.norm() > 1.0 + neutral).count();
        let message = format!(
            "the regime is unstable: {count} of {} multipliers {} outside of the unit circle, the largest has the modulus {largest:.6} ({}); a real mechanism leaves it",
            multipliers.len(),
            if count == 1 { "lies" } else { "lie" },
            lost(multipliers[0])
        );
        ("unstable-regime", message)
    } else if let Some(message) = family {
        return Finding { code: "family-of-motions".into(), message, path: place.to_owned() };
    } else if largest >= 1.0 - NEUTRAL {
        ("neutral-regime", "the regime is neither stable nor unstable: neighbouring motions come no nearer to it".to_owned())
    } else {
        ("stable-regime", format!("the regime is stable: a small deviation shrinks to {largest:.6} of itself in a period, or faster"))
    };
    let near = multipliers.iter().find(|m| (m.norm() - 1.0).abs() < NEAR);
    let near = near.map_or_else(String::new, |m| format!("; a multiplier is close to the unit circle: {}", bifurcation(*m)));
    Finding { code: code.into(), message: message + &near, path: place.to_owned() }
}

/// How a regime with such a multiplier outside of the unit circle has lost its stability.
fn lost(m: Complex<f64>) -> String {
    match m {
        _ if m.im != 0.0 => "a second oscillation grows beside it".into(),
        _ if m.re < 0.0 => "a deviation changes its sign and grows: the period doubles".into(),
        _ => "a deviation grows to one side".into(),
    }
}

/// The bifurcation that a multiplier on the unit circle announces (Kuznetsov, Elements of Applied Bifurcation Theory, chapter 4).
fn bifurcation(m: Complex<f64>) -> &'static str {
    match m {
        _ if m.im.abs() > NEAR => "a second oscillation begins (Neimark-Sacker)",
        _ if m.re < 0.0 => "the period doubles (flip)",
        _ => "two regimes meet, or a family of them begins (fold)",
    }
}
