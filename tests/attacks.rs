//! Standing attacks: inputs made by chance, and laws that must hold for all of them.
//!
//! Each is short here. `GRASHOF_CASES=100000 GRASHOF_SEED=7 cargo test --release --test all -- --nocapture NAME` makes more
//! cases of one of them and tells how many; `GRASHOF_PATIENCE=5` gives seconds to a damaged file. `docs/reliability.md` has what
//! long runs found.

pub(crate) mod dice;
mod expressions;
mod extremes;
mod files;
mod formula;
mod friction;
mod kills;
mod legs;
mod masses;
mod mechanisms;
mod motion;

use dice::Dice;

/// A number of the environment.
fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(otherwise)
}

/// How many cases to make.
fn cases(short: u64) -> u64 {
    setting("GRASHOF_CASES", short)
}

/// Chance of the seed that is asked for, different for each attack.
fn seeded(attack: u64) -> Dice {
    Dice(attack ^ setting("GRASHOF_SEED", 0).wrapping_mul(0x9E37_79B9_7F4A_7C15))
}

/// Evenly in [0, 1).
fn share(dice: &mut Dice) -> f64 {
    dice.next(1 << 30) as f64 / f64::from(1 << 30)
}

/// Evenly between two numbers, to three decimals, so that its text is exact.
fn between(dice: &mut Dice, low: f64, high: f64) -> f64 {
    ((low + share(dice) * (high - low)) * 1e3).round() / 1e3
}

#[expect(clippy::print_stderr, reason = "a count for who tries many by hand")]
fn tell(text: &str) {
    eprintln!("{text}");
}
