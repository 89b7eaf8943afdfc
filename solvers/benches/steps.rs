//! What one step of each scheme costs, on systems written by hand: `cargo bench -p grashof-solvers --bench steps`.
//!
//! Steps are given, so that no scheme can choose; a run that has come to its end begins anew, which is part of the cost.

#[path = "../tests/problems/mod.rs"]
#[macro_use]
mod problems;

use divan::Bencher;
use grashof_solvers::{Control, Integration, Method, Settings};
use problems::{Andrews, Chain, Pendulum, Problem};

fn main() {
    divan::main();
}

const SCHEMES: [&str; 8] = ["dop853", "rk4", "bdf", "radau5", "newmark", "hht", "generalized-alpha", "central-difference"];

fn method(name: &str) -> Method {
    match name {
        "rk4" => Method::Rk4,
        "bdf" => Method::Bdf { order: Some(3) },
        "radau5" => Method::Radau5,
        "newmark" => Method::Newmark { displacement: 0.25, velocity: 0.5 },
        "hht" => Method::Hht { alpha: -0.05 },
        "generalized-alpha" => Method::GeneralizedAlpha { rho: 0.8 },
        "central-difference" => Method::CentralDifference,
        _ => Method::Dop853,
    }
}

/// Steps of size `h` (s), again from the start after `end` (s).
fn steps<P: Problem>(bencher: Bencher<'_, '_>, mut system: P, name: &str, h: f64, end: f64) {
    let settings = Settings { method: method(name), control: Control::Steps([h, h]), ..Settings::default() };
    let start = system.start();
    let mut run = Integration::new(&mut system, settings, &start);
    bencher.bench_local(|| {
        if let Ok(present) = &mut run
            && present.node().state.t < end
            && present.advance(&mut system, 2.0 * end).is_ok()
        {
            return;
        }
        run = Integration::new(&mut system, settings, &start);
    });
}

/// One angle, one length: two coordinates and a row.
#[divan::bench(args = SCHEMES)]
fn pendulum(bencher: Bencher<'_, '_>, name: &str) {
    steps(bencher, Pendulum::new(), name, 1e-3, 10.0);
}

/// Seven bodies, three loops: seven coordinates and six rows.
#[divan::bench(args = SCHEMES)]
fn andrews(bencher: Bencher<'_, '_>, name: &str) {
    steps(bencher, Andrews::new(), name, 1e-5, 0.03);
}

/// Ten links in absolute coordinates: thirty coordinates and twenty rows.
#[divan::bench(args = SCHEMES)]
fn chain(bencher: Bencher<'_, '_>, name: &str) {
    steps(bencher, Chain::horizontal(10, 0.1), name, 1e-4, 1.0);
}
