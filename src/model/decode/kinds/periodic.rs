//! `periodic`: the regime in which a mechanism settles.

use super::contract::{Declared, Features};
use super::range::SAMPLES;
use crate::expression::{Dimension, Id, Lowered};
use crate::model::decode::decoder::{Decoder, Origin};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, MOST_STEPS, NUMBER, Shape, TIME, Want, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::study::{Chart, Continued, Kind, PeriodEnd, Periodic, Progress};
use crate::model::vocabulary::Known;

/// Intervals of the rows, and steps of a continuation, if omitted.
const ROWS: usize = 360;
const STEPS: usize = 10;

keys! {
    /// `periodic`.
    TABLE = PeriodicKeys "a periodic study" [one_of(&["by", "through"])] {
        over: need Shape::Name("the name of a measure or quantity, or `t`"), "What advances by one period.";
        by: may ANY, "By how much.";
        through: may ANY, "With `over: t`, instead of `by`: an expression; a period ends where it rises through 0 again.";
        of: need Shape::Name("the name of a measure or quantity"), "Whose mean and extremes are found.";
        samples: may SAMPLES, "Number of equal intervals of the rows; 360 if omitted.";
        tolerance: may NUMBER, "Relative tolerance; 1e-12 if omitted.";
        settle: may TIME, "Run before the search; until two periods are alike if omitted, 0: the start is the guess.";
        coordinates: may Shape::Word(&["joint", "cartesian"]), "Coordinates.";
        from: may Shape::Map(&CONTINUED), "A parameter along which the regime is followed to its value in the study.";
    }
}

keys! {
    /// `from` of a periodic study.
    CONTINUED = ContinuedKeys "a continuation" [] {
        vary: need Shape::Name("the name of a parameter"), "The parameter.";
        at: need ANY, "Its value at the begin.";
        steps: may Shape::Count(1, MOST_STEPS), "Number of equal steps; 10 if omitted.";
    }
}

pub(super) const PERIODIC: Declared =
    Declared::new("periodic", &TABLE, "Periodic regime.", |decoder, node, at| decoder.periodic(PeriodicKeys::of(node), at));

impl<'n> Decoder<'n> {
    fn periodic(&mut self, keys: PeriodicKeys<'n>, here: &At<'_, 'n>) -> Option<(Kind, Features)> {
        let named = |decoder: &mut Self, entry: Entry<'n>, allow: Allow| {
            let text = entry.text()?;
            let (lowered, _) = decoder.lower(text, Origin::Value(text, 0), &here.key(entry), allow, &mut Local::default())?;
            Some((text, lowered))
        };
        let study = Allow { what: "a periodic study", ..Allow::MEASURE };
        let over = named(self, keys.over, Allow { what: "`over`", level: Known::Position, ..study });
        let of = named(self, keys.of, study);
        let (tolerance, settle, from) = self.search(keys, here);
        let (over, progress) = over?;
        let timed = over == "t" || over == "time";
        let ends = self.period_end(keys, here, &progress, timed);
        let over_at = here.key(keys.over);
        let rate = self.lower(&format!("rate({over})"), Origin::Value(over, 0), &over_at, Allow::MEASURE, &mut Local::default())?.0;
        let (of, quantity) = of?;
        let word = of.replace('.', "_");
        let mut results = vec![("period".to_owned(), Dimension::TIME)];
        results.extend(["mean", "max", "min"].map(|which| (format!("{word}_{which}"), quantity.dimension)));
        results.push(("floquet".to_owned(), Dimension::NONE));
        let kind = Kind::Periodic(Periodic {
            over: (!timed).then(|| Progress { name: over.to_owned(), value: progress.id, rate: rate.id }),
            ends: ends?,
            of: quantity.id,
            samples: keys.samples.count().unwrap_or(ROWS),
            tolerance,
            settle,
            chart: keys.coordinates.word().unwrap_or(Chart::Joint),
            from,
        });
        let first = (!timed).then(|| over.to_owned());
        let independent = Some(progress.dimension);
        Some((kind, Features { independent, first, results, ..Features::WHOLE }))
    }

    /// `by` or `through`.
    fn period_end(&mut self, keys: PeriodicKeys<'n>, here: &At<'_, 'n>, over: &Lowered, timed: bool) -> Option<PeriodEnd> {
        if keys.by.given() {
            let by = self.read_as(keys.by, here, Want::Of(over.dimension))?;
            let rule = if timed { Rule::Positive("the period") } else { Rule::NotZero("the period") };
            self.check_key(rule, Some(by), here, keys.by);
            return Some(PeriodEnd::By(by));
        }
        let (node, at) = (keys.through.node?, here.key(keys.through));
        if !timed {
            let fault = self.fault("wrong-key", &at, "a period that ends `through` an expression counts the time", "`over: t`");
            fault.spot = Spot::Key;
            fault.help = Some("write `over: t`, or `by` instead of `through`".to_owned());
            return None;
        }
        let allow = Allow { what: "`through`", level: Known::Velocity, ..Allow::MEASURE };
        Some(PeriodEnd::Through(self.any(node, &at, allow, &mut Local::default())?.0.id))
    }

    /// `tolerance`, `settle` and `from`: how a periodic regime is looked for.
    fn search(&mut self, keys: PeriodicKeys<'n>, here: &At<'_, 'n>) -> (Option<Id>, Option<Id>, Option<Continued>) {
        let tolerance = self.read(keys.tolerance, here);
        self.check_key(Rule::Within(1e-14, 1e-4, "the tolerance"), tolerance, here, keys.tolerance);
        let settle = self.read(keys.settle, here);
        self.check_key(Rule::NotNegative("the time"), settle, here, keys.settle);
        let from = keys.from.node.and_then(|node| self.continued(node, &here.key(keys.from)));
        (tolerance, settle, from)
    }

    fn continued(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<Continued> {
        let keys = ContinuedKeys::of(node);
        let parameter = self.parameter_named(keys.vary.text()?, &at.key(keys.vary), false)?;
        let dimension = self.name_space.parameters.get(parameter).copied().flatten()?;
        let begin = self.read_as(keys.at, at, Want::Of(dimension))?;
        Some(Continued { parameter, at: begin, steps: keys.steps.count().unwrap_or(STEPS) })
    }
}
