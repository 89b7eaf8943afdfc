//! All tests of the solvers, in one binary: `cargo test -p grashof-solvers --test all NAME`.

mod allocations;
mod auto;
mod bdf;
mod central_difference;
mod continuous;
mod dop853;
mod events;
mod ida;
mod minimal;
mod newmark;
mod problems;
mod problems_hold;
mod radau5;
