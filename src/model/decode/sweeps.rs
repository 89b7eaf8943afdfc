//! Sweeps: parameters that run through values, or whose values are drawn from distributions.

use super::decoder::Decoder;
use super::points::POINTS;
use super::written::unit_in;
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, Keys, MOST_RUNS, Shape, Size, Want, one_of};
use crate::model::keys::{Entry, Words, keys, words};
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::scope::Local;
use crate::model::study::{Samples, Sweep, Values};

/// `sweep`.
pub(super) const SWEEP: Shape = Shape::NamedBut(
    &POINTS,
    Keys::Reference,
    "a parameter",
    &Shape::Either(&[
        Shape::Map(&SPAN),
        Shape::List(&ANY, Size::AtLeast(1)),
        Shape::CountOf("for `samples` and `seed` a whole number", MOST_SEED),
    ]),
);

words! {
    /// How the values of a span are spaced.
    enum Spacing {
        /// Equal differences.
        Linear = "linear",
        /// Equal ratios.
        Log = "log",
    }
}

/// Largest seed.
const MOST_SEED: u64 = u32::MAX as u64;

/// What is expected of a span.
const SPANNED: &str = "`{ from, to, count }`, with `spacing` if need be";

/// A whole number that stands for itself.
fn whole(value: Node<'_>) -> Option<u64> {
    match value {
        Node::Plain(serde_yaml::Value::Number(n)) => n.as_u64(),
        _ => None,
    }
}

keys! {
    /// `sweep`, of one parameter.
    SPAN = SpanKeys "values of a sweep" [one_of(&["from", "normal", "uniform"])] {
        from: may ANY, "First value.";
        to: may ANY, "Last value.";
        count: may Shape::Count(1, MOST_RUNS), "Number of values.";
        spacing: may Shape::Word(Spacing::WORDS), "Equal differences or equal ratios.";
        normal: may Shape::List(&ANY, Size::Exactly(2)), "Drawn from a normal distribution: mean and standard deviation.";
        uniform: may Shape::List(&ANY, Size::Exactly(2)), "Drawn from between two values.";
    }
}

/// The unit in which values are written.
fn written(value: Node<'_>) -> Option<(String, f64)> {
    let keys = SpanKeys::of(value);
    [keys.from, keys.normal, keys.uniform].into_iter().find_map(|entry| entry.node).map_or_else(|| unit_in(value), unit_in)
}

impl<'n> Decoder<'n> {
    /// Swept parameters, and how many points are drawn of those with distributions.
    pub(super) fn sweep(&mut self, sweep: Entry<'n>, at: &At<'_, 'n>, local: &mut Local<'n>) -> (Vec<Sweep>, Option<Samples>) {
        let section = at.key(sweep);
        let mut swept: Vec<Sweep> = Vec::new();
        let [mut samples, mut seed] = [None; 2];
        let mut runs: u64 = 1;
        for (name, value) in sweep.entries() {
            let here = section.key(name);
            if let Some(count) = whole(value) {
                match name {
                    "samples" => samples = Some(count),
                    "seed" => seed = Some(count),
                    _ => {
                        let fault = self.fault("wrong-type", &here, format!("one value, {count}"), "values for a parameter to run through");
                        fault.help = Some(format!("write a list, as `{name}: [1, 2]`, or a span"));
                    }
                }
                continue;
            }
            if name == POINTS.key && value.is_map() {
                runs = runs.saturating_mul(self.point_list(value, &here, &mut swept, local) as u64);
                continue;
            }
            let Some((parameter, want)) = self.swept(name, &here, &swept) else { continue };
            let Some((values, count)) = self.values(value, &here, want, local) else { continue };
            runs = runs.saturating_mul(count as u64);
            swept.push(Sweep { parameter, values, place: self.place(&here), unit: written(value) });
        }
        if sweep.given() && sweep.entries().is_empty() {
            let fault = self.fault("nothing-swept", &section, "no parameter is swept", "parameters with their values");
            fault.help = Some("give one, as `{ k: [1, 2] }`, or remove `sweep`".to_owned());
        }
        let samples = self.samples(&section, &swept, samples, seed);
        runs = runs.saturating_mul(samples.map_or(1, |samples| samples.count as u64));
        if runs > MOST_RUNS {
            self.fault("too-many-runs", &section, format!("a sweep of {runs} runs"), format!("at most {MOST_RUNS} runs")).spot = Spot::Key;
        }
        (swept, samples)
    }

    /// The values of one parameter, and how many of them are not drawn.
    fn values(&mut self, value: Node<'n>, here: &At<'_, 'n>, want: Want, local: &mut Local<'n>) -> Option<(Values, usize)> {
        if value.is_list() {
            let ids: Vec<_> =
                (value.items().iter().enumerate()).map(|(i, item)| self.setting(Node::Plain(item), &here.index(i), want, local)).collect();
            let count = ids.len();
            return Some((Values::List(ids.into_iter().collect::<Option<_>>()?), count));
        }
        let keys = SpanKeys::of(value);
        if let Some(entry) = [keys.normal, keys.uniform].into_iter().find(|entry| entry.given()) {
            let pair = here.key(entry);
            let ids: Vec<_> =
                (entry.items().iter().enumerate()).map(|(i, item)| self.setting(Node::Plain(item), &pair.index(i), want, local)).collect();
            let &[Some(first), Some(second)] = &ids[..] else { return None };
            if !keys.normal.given() {
                return Some((Values::Uniform { from: first, to: second }, 1));
            }
            if self.pool.inputs_of(&[second]).is_empty() {
                self.check_once(Rule::NotNegative("a standard deviation"), &[second], &pair.index(1));
            }
            return Some((Values::Normal { mean: first, deviation: second }, 1));
        }
        let missing: Vec<&str> = [keys.to, keys.count].into_iter().filter(|entry| !entry.given()).map(Entry::key).collect();
        if keys.from.given() && !missing.is_empty() {
            let fault = self.fault("missing-key", here, format!("`{}` is missing beside `from`", missing.join("` and `")), SPANNED);
            (fault.spot, fault.help) = (Spot::Key, Some(format!("add `{}:`", missing[0])));
        }
        let count = keys.count.count()?;
        let log = keys.spacing.word() == Some(Spacing::Log);
        let mut end = |entry: Entry<'n>| self.setting(entry.node?, &here.key(entry), want, local);
        let (from, to) = (end(keys.from), end(keys.to));
        let (from, to) = (from?, to?);
        if log && self.pool.inputs_of(&[from, to]).is_empty() {
            self.check_once(Rule::Ratio, &[from, to], here);
        }
        Some((Values::Span { from, to, count, log }, count))
    }

    /// How many points are drawn: there must be a number of them where parameters have distributions, and nowhere else.
    fn samples(&mut self, section: &At<'_, 'n>, swept: &[Sweep], samples: Option<u64>, seed: Option<u64>) -> Option<Samples> {
        let drawn = swept.iter().any(|sweep| sweep.values.are_drawn());
        match samples {
            Some(count) if drawn && (1..=MOST_RUNS).contains(&count) => {
                return Some(Samples { count: usize::try_from(count).ok()?, seed: seed.unwrap_or(1) });
            }
            Some(count) if drawn => {
                let expected = format!("a whole number from 1 to {MOST_RUNS}");
                self.fault("bad-count", &section.key("samples"), format!("found {count}"), expected).help =
                    Some("write `samples: 200`".into());
            }
            None if drawn => {
                let fault =
                    self.fault("missing-key", section, "values are drawn from distributions, and nothing says how many", "`samples`");
                (fault.spot, fault.help) = (Spot::Key, Some("add `samples: 200`".into()));
            }
            _ => {
                for (key, _) in [("samples", samples), ("seed", seed)].into_iter().filter(|(_, count)| count.is_some()) {
                    let expected = "a parameter with `normal` or `uniform`";
                    let fault = self.fault("nothing-drawn", &section.key(key), "no parameter has a distribution", expected);
                    fault.help = Some("remove it, or give a parameter `{ normal: [mean, deviation] }`".into());
                }
            }
        }
        None
    }
}
