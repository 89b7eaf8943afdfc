//! What is said of a `solve`.

use super::search::Zero;
use super::task::{Task, Trial};
use crate::expression::Dimension;
use crate::model::{in_unit, with_unit};
use crate::numerics::root::Root;
use crate::results::{Finding, Unsolved};

/// A solution whose residual is above this part of the target and of the change over the first bracket is said to be coarse.
const COARSE: f64 = 1e-6;

/// A search that has ended.
pub(super) struct Explain<'a> {
    pub(super) task: &'a Task<'a>,
    /// All runs, by place.
    pub(super) log: Vec<Trial>,
    /// The parameter at a place.
    pub(super) place: &'a dyn Fn(f64) -> f64,
}

impl Explain<'_> {
    /// Why no value of the parameter meets the target.
    pub(super) fn missed(&self, jump: Option<Root>, gap: Option<[f64; 2]>) -> Unsolved {
        let [parameter, scalar] = self.names();
        let runs = self.log.len();
        let unsolved = |message: String, help: &str| Unsolved {
            message: format!("{message} ({runs} runs)"),
            place: format!("{}.solve", self.task.study.place),
            help: help.into(),
        };
        if let Some(jump) = jump {
            let [before, after] = [jump.before, jump.after].map(|x| self.scalar(x));
            let at = self.at(jump.after);
            let message = format!("`{scalar}` jumps over its target {} at `{parameter}` = {at}, from {before} to {after}", self.target());
            return unsolved(message, "choose a target that the scalar takes, or bounds on one side of the jump");
        }
        if let Some(gap) = gap {
            let [from, to] = gap.map(|x| self.at(x));
            let why = self.failed().find(|run| (gap[0].min(gap[1])..=gap[0].max(gap[1])).contains(&run.x)).and_then(|run| run.why.clone());
            let message = format!(
                "`{scalar}` passes its target {} where no run can be computed, for `{parameter}` from {from} to {to}: {}",
                self.target(),
                why.unwrap_or_default()
            );
            return unsolved(message, "choose bounds or a target on one side");
        }
        if let Some(same) = self.constant() {
            let message = format!(
                "`{scalar}` does not meet its target {}: it is {} for all values of `{parameter}` that were tried{}",
                self.target(),
                self.with_unit(same),
                self.reasons()
            );
            return unsolved(message, "vary a parameter on which the scalar depends, or give other bounds in `between`");
        }
        let ends: Vec<String> = [self.log.first(), self.log.last()].into_iter().flatten().map(|run| self.describe(run)).collect();
        let off = |run: &&Trial| (run.scalar - run.target).abs();
        let nearest = self.log.iter().filter(|run| run.why.is_none()).min_by(|a, b| off(a).total_cmp(&off(b)));
        let nearest = nearest
            .filter(|run| run.x > 0.0 && run.x < 1.0)
            .map_or_else(String::new, |run| format!("; it comes nearest with {}", self.describe(run)));
        let message =
            format!("`{scalar}` does not meet its target {}: it is {}{nearest}{}", self.target(), ends.join(" and "), self.reasons());
        unsolved(message, "give other bounds in `between`, or a target that the scalar reaches")
    }

    /// What a reader of a solution should know.
    pub(super) fn findings(&self, zero: &Zero) -> Vec<Finding> {
        let [parameter, scalar] = self.names();
        let path = format!("{}.solve", self.task.study.place);
        let finding = |code: &'static str, message| Finding { code: code.into(), message, path: path.clone() };
        let mut found = Vec::new();
        if !zero.others.is_empty() && self.constant().is_none() {
            let place = |[a, b]: &[f64; 2]| {
                if a == b { format!("at {}", self.at(*a)) } else { format!("between {} and {}", self.at(*a), self.at(*b)) }
            };
            let others: Vec<String> = zero.others.iter().map(place).collect();
            let message = format!(
                "`{scalar}` meets its target for several values of `{parameter}`; {} is the first, and others lie {}",
                self.at(zero.at),
                others.join(", ")
            );
            found.push(finding("solve-several", message));
        }
        let failed = self.failed().count();
        if failed > 0 {
            found.push(finding("solve-failed-runs", format!("{failed} of {} runs gave no value{}", self.log.len(), self.reasons())));
        }
        let target = self.log.iter().find(|run| run.x == zero.at).map_or(0.0, |run| run.target);
        let off = zero.value.abs();
        if off > COARSE * zero.scale.max(target.abs()) {
            let message = format!("`{scalar}` is met to {off:.1e} only: it jumps there, or is noisy");
            found.push(finding("solve-coarse", message));
        } else if target != 0.0 && off > COARSE * target.abs() {
            let message = format!(
                "`{scalar}` misses its target by {off:.1e}: `between` spans so much that nearer values of `{parameter}` are not looked at; give nearer bounds"
            );
            found.push(finding("solve-coarse", message));
        }
        if self.constant().is_some() {
            let message = format!("`{scalar}` is the same for all values of `{parameter}` that were tried: does it depend on it?");
            found.push(finding("solve-constant", message));
        }
        found
    }

    /// The value of the scalar, if it is the same in three runs and more, and in all that have one.
    fn constant(&self) -> Option<f64> {
        let values: Vec<f64> = self.log.iter().filter(|run| run.why.is_none()).map(|run| run.scalar).collect();
        (values.len() >= 3 && values.iter().all(|value| *value == values[0])).then(|| values[0])
    }

    /// Names of parameter and scalar.
    fn names(&self) -> [&str; 2] {
        [&self.task.model.parameters[self.task.solve.parameter].name, &self.task.solve.target.0]
    }

    /// The target, of the first run that has one.
    fn target(&self) -> String {
        self.log.iter().map(|run| run.target).find(|x| !x.is_nan()).map_or_else(String::new, |x| self.with_unit(x))
    }

    fn dimension(&self) -> Dimension {
        let (study, name) = (self.task.study, &self.task.solve.target.0);
        let own = study.scalars.iter().find(|s| s.name == *name).map(|s| s.dimension);
        own.or_else(|| study.results.iter().find(|r| r.name == *name).map(|r| r.dimension)).unwrap_or(Dimension::NONE)
    }

    /// The scalar with its unit.
    fn with_unit(&self, x: f64) -> String {
        in_own_unit(x, self.dimension(), &self.task.solve.units[1])
    }

    /// The parameter at a place, with its unit.
    fn at(&self, x: f64) -> String {
        in_own_unit((self.place)(x), self.task.model.parameters[self.task.solve.parameter].dimension, &self.task.solve.units[0])
    }

    /// The scalar of the run at a place.
    fn scalar(&self, x: f64) -> String {
        let scalar = self.log.iter().find(|run| run.x == x).map_or(f64::NAN, |run| run.scalar);
        self.with_unit(scalar)
    }

    /// `0.3 at 1 kg m^2`.
    fn describe(&self, run: &Trial) -> String {
        let scalar = if run.why.is_some() { "unknown".into() } else { self.with_unit(run.scalar) };
        format!("{scalar} at {}", self.at(run.x))
    }

    fn failed(&self) -> impl Iterator<Item = &Trial> {
        self.log.iter().filter(|run| run.why.is_some())
    }

    /// Why runs have no value: the first reason, and where.
    fn reasons(&self) -> String {
        let Some(first) = self.failed().next() else { return String::new() };
        format!("; at {}: {}", self.at(first.x), first.why.as_deref().unwrap_or_default())
    }
}

/// A number with its unit, that of the file if it has one.
fn in_own_unit(x: f64, dimension: Dimension, own: &Option<(String, f64)>) -> String {
    own.as_ref().map_or_else(|| with_unit(x, dimension), |(unit, size)| in_unit(x / size, unit))
}
