//! A system that has dimensions and a pattern alone: what tests make an engine of.

use crate::{At, Dims, Effect, Pattern, Span, Stage, State, System, Tangent, Terms};

pub(crate) struct Shape {
    pub(crate) pattern: Pattern,
    pub(crate) dims: Dims,
}

impl System for Shape {
    fn dims(&self) -> Dims {
        self.dims
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn terms(&mut self, _: At<'_>, _: Stage, _: &mut Terms) {}

    fn residual(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut Tangent) {}

    fn rate(&self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn retract(&self, _: Span, _: &mut [f64], _: &[f64]) {}

    fn displace(&self, _: Span, _: &mut [f64], _: &[f64]) {}

    fn power(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn modes(&mut self, _: At<'_>, _: &mut [i32]) {}

    fn roots(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn cross(&mut self, _: usize, _: &mut State, _: &mut [f64]) -> Effect {
        Effect::Record
    }
}
