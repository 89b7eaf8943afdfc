//! A scheme that this build does not have.

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Engine, Node, Rejected, Why};
use crate::scheme::Scheme;

/// Refuses each start.
pub(super) struct Absent;

impl Scheme for Absent {
    fn restart(&mut self, _: &mut dyn System, _: &mut Engine, _: &Node, _: f64) -> Result<(), Why> {
        Err(Why::Unavailable)
    }

    fn attempt(&mut self, _: &mut dyn System, _: &mut Engine, _: &Node, h: f64, _: &mut Node) -> Result<(), Rejected> {
        Err(Rejected { why: Why::Unavailable, retry: h })
    }

    fn accept(&mut self, _: &mut Engine, _: &Node, _: &Node) -> f64 {
        0.0
    }

    fn dense(&mut self, _: &mut dyn System, _: &mut Engine, _: &Node, _: &Node, _: &mut Dense) -> Result<(), Why> {
        Err(Why::Unavailable)
    }

    fn order(&self) -> usize {
        1
    }

    fn name(&self) -> &'static str {
        "absent"
    }
}
