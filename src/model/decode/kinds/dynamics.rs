//! `dynamics`: motion in time. Its keys, their ranges, and which of them go together.

use super::contract::{Declared, Features};
use crate::expression::{Dimension, Id};
use crate::model::decode::decoder::Decoder;
use crate::model::fault::{At, Spot};
use crate::model::fields::{NUMBER, Shape, TIME, at_most_one};
use crate::model::integrator::{self, Family, INTEGRATORS, Integrator};
use crate::model::keys::{Entry, Words, keys, words};
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::study::{Chart, Control, Forward, Kind, Level};

/// Largest relative tolerance.
const LOOSEST: f64 = 0.1;

words! {
    /// What a scheme does at a switch.
    enum Switches {
        /// Ends the step there.
        Locate = "locate",
        /// Marches across it.
        StepOver = "step-over",
    }
}

keys! {
    /// `dynamics`.
    TABLE = DynamicsKeys "a dynamics study" [at_most_one(&["tolerance", "step"])] {
        until: need TIME, "End of the run.";
        every: may TIME, "Output step; all steps if omitted.";
        tolerance: may NUMBER, "Relative tolerance; 1e-8 if omitted.";
        step: may TIME, "Fixed step, instead of a tolerance.";
        integrator: may Shape::Word(&integrator::NAMES), "Scheme.";
        alpha: may NUMBER, "Newmark: weight of the acceleration in the displacement. Hht: its alpha, from -1/3 to 0.";
        beta: may NUMBER, "Newmark: weight of the acceleration in the velocity.";
        rho: may NUMBER, "Spectral radius at infinity of generalized-alpha.";
        order: may Shape::Count(1, 5), "Fixed order of bdf, with a fixed step.";
        level: may Shape::Word(Level::WORDS), "Constraint rows that are imposed.";
        coordinates: may Shape::Word(Chart::WORDS), "Coordinates.";
        switches: may Shape::Word(Switches::WORDS), "Whether switches are located.";
    }
}

pub(super) const DYNAMICS: Declared = Declared::new("dynamics", &TABLE, "Motion in time.", |decoder, node, at| {
    let motion = decoder.motion(node, at)?;
    Some((Kind::Dynamics(motion), Features { independent: Some(Dimension::TIME), works: true, ..Features::WHOLE }))
});

impl<'n> Decoder<'n> {
    fn motion(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<Forward> {
        let keys = DynamicsKeys::of(node);
        let integrator = keys.integrator.text().and_then(Integrator::named).unwrap_or(INTEGRATORS[0].integrator);
        let name = integrator.name();
        let until = self.duration(keys.until, at, "the time");
        let every = self.duration(keys.every, at, "the time");
        let control = self.control(keys, at);
        self.belong(node, at, name);
        self.both_weights(keys, at, name);
        self.step_wanted(keys, at, integrator);
        let level = keys.level.word();
        let chart = keys.coordinates.word().unwrap_or(Chart::Auto);
        if level.is_some() {
            self.level_exists(keys.level, at, name, integrator, chart);
        }
        let [alpha, beta, rho] = [keys.alpha, keys.beta, keys.rho].map(|entry| self.read(entry, at));
        self.weights(keys, at, integrator, level, [alpha, beta, rho]);
        let order = keys.order.count();
        let locate = keys.switches.word() != Some(Switches::StepOver);
        Some(Forward { until: until?, every, control: control?, integrator, alpha, beta, rho, order, level, chart, locate })
    }

    /// A time above 0.
    fn duration(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, what: &'static str) -> Option<Id> {
        let id = self.read(entry, at);
        self.check_key(Rule::Positive(what), id, at, entry);
        id
    }

    fn control(&mut self, keys: DynamicsKeys<'n>, at: &At<'_, 'n>) -> Option<Control> {
        if keys.step.given() {
            return self.duration(keys.step, at, "the step").map(Control::Step);
        }
        let tolerance = self.read(keys.tolerance, at);
        self.check_key(Rule::Positive("the tolerance"), tolerance, at, keys.tolerance);
        self.check_key(Rule::AtMost(LOOSEST, "the tolerance"), tolerance, at, keys.tolerance);
        Some(Control::Tolerance(tolerance))
    }

    /// Refuses parameters of other integrators.
    fn belong(&mut self, node: Node<'n>, at: &At<'_, 'n>, name: &str) {
        for field in DynamicsKeys::FIELDS {
            let (entry, key) = (Entry::of(field, node), field.key);
            let owners: Vec<&str> = INTEGRATORS.iter().filter(|d| d.keys.contains(&key)).map(|d| d.name).collect();
            if !entry.given() || owners.is_empty() || owners.contains(&name) {
                continue;
            }
            let list: Vec<String> = owners.iter().map(|owner| format!("`integrator: {owner}`")).collect();
            let here = at.key(entry);
            let fault = self.fault("wrong-option", &here, format!("`{key}` with the integrator `{name}`"), list.join(" or "));
            fault.spot = Spot::Key;
            fault.help = Some("remove it, or name that integrator".to_owned());
        }
    }

    /// Refuses one weight of Newmark's family without the other.
    fn both_weights(&mut self, keys: DynamicsKeys<'n>, at: &At<'_, 'n>, name: &str) {
        let [alpha, beta] = [keys.alpha.given(), keys.beta.given()];
        if name == "newmark" && alpha != beta {
            let (given, other, value) = if alpha { (keys.alpha, keys.beta, "1/2") } else { (keys.beta, keys.alpha, "1/4") };
            let (given, other) = (given.key(), other.key());
            let fault = self.fault("missing-key", &at.key(given), format!("`{given}` without `{other}`"), "both weights, or neither");
            fault.spot = Spot::Key;
            fault.help = Some(format!("add `{other}:`, for example `{other}: {value}`"));
        }
    }

    /// What cannot do without a fixed step.
    fn step_wanted(&mut self, keys: DynamicsKeys<'n>, at: &At<'_, 'n>, integrator: Integrator) {
        if keys.step.given() {
            return;
        }
        let mut wants = |entry: Entry<'n>, what: &str, help: &str| {
            let fault = self.fault("missing-key", &at.key(entry), format!("{what} without a fixed step"), "`step`");
            fault.help = Some(help.to_owned());
        };
        if !integrator.description().tolerance {
            wants(
                keys.integrator,
                &format!("`{}`", integrator.name()),
                "add `step:`, instead of a tolerance; or use `dop853`, which chooses its steps",
            );
        }
        if keys.switches.word() == Some(Switches::StepOver) {
            wants(keys.switches, "`step-over`", "add `step:`, or locate the switches");
        }
        if keys.order.given() {
            wants(keys.order, "`order`", "add `step:`, or remove `order`: with a tolerance `bdf` chooses it");
        }
    }

    /// Refuses a choice of constraint rows where there is none.
    fn level_exists(&mut self, level: Entry<'n>, at: &At<'_, 'n>, name: &str, integrator: Integrator, chart: Chart) {
        let explicit = integrator.description().family == Family::Explicit;
        let (message, expected) = if chart == Chart::Minimal {
            ("`level` with `coordinates: minimal`".to_owned(), "no `level`: independent coordinates leave no constraint rows")
        } else if explicit {
            (
                format!("`level` with `{name}`"),
                "no `level`: an explicit integrator takes accelerations, and projects positions and velocities",
            )
        } else {
            return;
        };
        let fault = self.fault("wrong-option", &at.key(level), message, expected);
        fault.spot = Spot::Key;
        fault.help = Some("remove `level`".to_owned());
    }

    /// Ranges of the parameters of the Newmark family.
    fn weights(
        &mut self,
        keys: DynamicsKeys<'n>,
        at: &At<'_, 'n>,
        integrator: Integrator,
        level: Option<Level>,
        [alpha, beta, rho]: [Option<Id>; 3],
    ) {
        match integrator {
            Integrator::Hht => self.check_key(Rule::Within(-1.0 / 3.0, 0.0, "alpha"), alpha, at, keys.alpha),
            Integrator::GeneralizedAlpha => self.check_key(Rule::Within(0.0, 1.0, "rho"), rho, at, keys.rho),
            Integrator::Newmark => {
                self.check_key(Rule::NotNegative("alpha"), alpha, at, keys.alpha);
                self.check_key(Rule::NotNegative("beta"), beta, at, keys.beta);
                if level == Some(Level::Position) {
                    // omitted: the trapezoidal rule
                    let weights = [alpha.unwrap_or_else(|| self.pool.constant(0.25)), beta.unwrap_or_else(|| self.pool.constant(0.5))];
                    self.check(Rule::ConstrainedNewmark, &weights, &at.key(keys.level));
                }
            }
            _ => {}
        }
    }
}
