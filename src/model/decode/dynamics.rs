//! Motion in time: keys, their ranges, and which of them go together.

use super::decoder::Decoder;
use crate::expression::{Dimension, Id};
use crate::model::fault::{At, Spot};
use crate::model::integrator::{Family, INTEGRATORS, Integrator};
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::study::{Chart, Control, Forward, Level};

/// Largest relative tolerance.
const LOOSEST: f64 = 0.1;

impl<'n> Decoder<'n> {
    pub(super) fn forward(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<Forward> {
        let word = |key: &str| node.get(key).and_then(Node::text);
        let integrator = word("integrator").and_then(Integrator::named).unwrap_or(INTEGRATORS[0].integrator);
        let name = integrator.name();
        let until = self.duration(node, "until", at, "the time");
        let every = self.duration(node, "every", at, "the time");
        let control = self.control(node, at);
        self.belong(node, at, name);
        self.step_wanted(node, at, integrator);
        let level = match word("level") {
            Some("stabilized") => Some(Level::Stabilized),
            Some("position") => Some(Level::Position),
            Some("velocity") => Some(Level::Velocity),
            Some("acceleration") => Some(Level::Acceleration),
            _ => None,
        };
        let chart = match word("coordinates") {
            Some("cartesian") => Chart::Cartesian,
            Some("minimal") => Chart::Minimal,
            _ => Chart::Joint,
        };
        if level.is_some() {
            self.level_exists(at, name, integrator, chart);
        }
        let [alpha, beta, rho] = ["alpha", "beta", "rho"].map(|key| self.of(node, key, at, Dimension::NONE));
        self.weights(at, integrator, level, [alpha, beta, rho]);
        let order = super::features::count(node, "order");
        let locate = word("switches") != Some("step-over");
        Some(Forward { until: until?, every, control: control?, integrator, alpha, beta, rho, order, level, chart, locate })
    }

    /// A time above 0.
    fn duration(&mut self, node: Node<'n>, key: &'n str, at: &At<'_, 'n>, what: &'static str) -> Option<Id> {
        let id = self.of(node, key, at, Dimension::TIME);
        self.check_key(Rule::Positive(what), id, at, key);
        id
    }

    fn control(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<Control> {
        if node.get("step").is_some() {
            return self.duration(node, "step", at, "the step").map(Control::Step);
        }
        let tolerance = self.of(node, "tolerance", at, Dimension::NONE);
        self.check_key(Rule::Positive("the tolerance"), tolerance, at, "tolerance");
        self.check_key(Rule::AtMost(LOOSEST, "the tolerance"), tolerance, at, "tolerance");
        Some(Control::Tolerance(tolerance))
    }

    /// Refuses parameters of other integrators.
    fn belong(&mut self, node: Node<'n>, at: &At<'_, 'n>, name: &str) {
        let mut keys: Vec<&'static str> = INTEGRATORS.iter().flat_map(|d| d.keys).copied().collect();
        keys.sort_unstable();
        keys.dedup();
        for key in keys {
            let owners: Vec<&str> = INTEGRATORS.iter().filter(|d| d.keys.contains(&key)).map(|d| d.name).collect();
            if node.get(key).is_none() || owners.contains(&name) {
                continue;
            }
            let list: Vec<String> = owners.iter().map(|owner| format!("`integrator: {owner}`")).collect();
            let here = at.key(key);
            let fault = self.fault("wrong-option", &here, format!("`{key}` with the integrator `{name}`"), list.join(" or "));
            fault.spot = Spot::Key;
            fault.help = Some("remove it, or name that integrator".to_owned());
        }
        let [alpha, beta] = ["alpha", "beta"].map(|key| node.get(key).is_some());
        if name == "newmark" && alpha != beta {
            let (given, other, value) = if alpha { ("alpha", "beta", "1/2") } else { ("beta", "alpha", "1/4") };
            let fault = self.fault("missing-key", &at.key(given), format!("`{given}` without `{other}`"), "both weights, or neither");
            fault.spot = Spot::Key;
            fault.help = Some(format!("add `{other}:`, for example `{other}: {value}`"));
        }
    }

    /// What cannot do without a fixed step.
    fn step_wanted(&mut self, node: Node<'n>, at: &At<'_, 'n>, integrator: Integrator) {
        if node.get("step").is_some() {
            return;
        }
        let mut wants = |key: &'n str, what: &str, help: &str| {
            let fault = self.fault("missing-key", &at.key(key), format!("{what} without a fixed step"), "`step`");
            fault.help = Some(help.to_owned());
        };
        if !integrator.description().tolerance {
            wants(
                "integrator",
                &format!("`{}`", integrator.name()),
                "add `step:`, instead of a tolerance; or use `dop853`, which chooses its steps",
            );
        }
        if node.get("switches").and_then(Node::text) == Some("step-over") {
            wants("switches", "`step-over`", "add `step:`, or locate the switches");
        }
        if node.get("order").is_some() {
            wants("order", "`order`", "add `step:`, or remove `order`: with a tolerance `bdf` chooses it");
        }
    }

    /// Refuses a choice of constraint rows where there is none.
    fn level_exists(&mut self, at: &At<'_, 'n>, name: &str, integrator: Integrator, chart: Chart) {
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
        let fault = self.fault("wrong-option", &at.key("level"), message, expected);
        fault.spot = Spot::Key;
        fault.help = Some("remove `level`".to_owned());
    }

    /// Ranges of the parameters of the Newmark family.
    fn weights(&mut self, at: &At<'_, 'n>, integrator: Integrator, level: Option<Level>, [alpha, beta, rho]: [Option<Id>; 3]) {
        match integrator {
            Integrator::Hht => self.check_key(Rule::Within(-1.0 / 3.0, 0.0, "alpha"), alpha, at, "alpha"),
            Integrator::GeneralizedAlpha => self.check_key(Rule::Within(0.0, 1.0, "rho"), rho, at, "rho"),
            Integrator::Newmark => {
                self.check_key(Rule::NotNegative("alpha"), alpha, at, "alpha");
                self.check_key(Rule::NotNegative("beta"), beta, at, "beta");
                if level == Some(Level::Position) {
                    // silent: the trapezoidal rule
                    let weights = [alpha.unwrap_or_else(|| self.pool.constant(0.25)), beta.unwrap_or_else(|| self.pool.constant(0.5))];
                    self.check(Rule::ConstrainedNewmark, &weights, &at.key("level"));
                }
            }
            _ => {}
        }
    }
}
