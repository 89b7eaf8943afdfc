//! What is given from outside, by options of the command line or in a call: values of parameters, and sweeps in place of a study's own.

use super::decoder::{Decoder, Origin};
use super::written::unit_of;
use crate::expression::{self, Dimension, Id, Lowered};
use crate::model::asked::{Asked, Caller};
use crate::model::data::DataFiles;
use crate::model::fault::{At, Given, Spot};
use crate::model::fields::MOST_RUNS;
use crate::model::figure::{Plot, ShownWhat};
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::study::{Samples, Sweep, Values};
use crate::model::suggest;
use crate::model::suggest::clip;
use std::ops::Range;

/// What is given for a study.
pub(crate) struct Outside<'o> {
    /// Who gives it.
    pub(crate) caller: Caller,
    /// Parameters with their values.
    pub(crate) set: &'o [(usize, Id)],
    /// Swept parameters with the texts of their values.
    pub(crate) over: &'o [(String, String)],
    /// How many points are drawn from their distributions.
    pub(crate) samples: Option<Samples>,
    /// Whether it changes what the file computes, of which nothing is expected then.
    pub(crate) changes: bool,
    /// Measured data of figures.
    pub(crate) files: &'o DataFiles,
}

/// An argument as it is shown, `--over l3=0.3,0.4`, and where its value begins.
pub(super) struct Argument {
    caller: Caller,
    given: Given,
    value: usize,
}

impl Argument {
    fn new(caller: Caller, asked: Asked, name: &str, value: &str) -> Self {
        let given = caller.given(asked, &format!("{name}={value}"));
        Self { caller, value: given.text.len() - value.len(), given }
    }

    /// Bytes of the value.
    pub(super) fn spot(&self, part: Range<usize>) -> Spot {
        self.given.spot(part.start + self.value..part.end + self.value)
    }

    /// The name of a parameter, which stands so many bytes before the sign `=`.
    fn name(&self, name: &str, behind: usize) -> Spot {
        let end = self.value - 1 - behind;
        self.given.spot(end - name.len()..end)
    }
}

impl<'n> Decoder<'n> {
    /// Parameters given from outside as `NAME`, `VALUE`.
    pub(crate) fn outside(&mut self, sets: &[(String, String)], caller: Caller) -> Vec<(usize, Id)> {
        let mut found: Vec<(usize, Id)> = Vec::new();
        for (name, value) in sets {
            let argument = Argument::new(caller, Asked::Value, name, value);
            let Some((i, wanted)) = self.named_outside(name, argument.name(name, 0)) else { continue };
            let Some(wanted) = wanted else { continue };
            if let Some(id) = self.given(name, value, 0..value.len(), &argument, wanted, Allow::PARAMETER, &mut Local::default()) {
                // what was wrong with the file's value does not matter any more
                found.retain(|(j, _)| *j != i);
                found.push((i, id));
            }
        }
        found
    }

    /// The parameter that an argument names, and its dimension unless the file's value of it is faulty.
    fn named_outside(&mut self, name: &str, spot: Spot) -> Option<(usize, Option<Dimension>)> {
        let before = self.faults.len();
        let found = self.parameter_named(name, &At::ROOT, true);
        for fault in &mut self.faults[before..] {
            fault.spot = spot.clone();
        }
        found.map(|i| (i, self.name_space.parameters.get(i).copied().flatten()))
    }

    /// The value in a part of an argument's text.
    #[allow(clippy::too_many_arguments, reason = "what is read, where it stands, what it may be")]
    pub(super) fn given(
        &mut self,
        name: &str,
        value: &str,
        part: Range<usize>,
        argument: &Argument,
        wanted: Dimension,
        allow: Allow,
        local: &mut Local<'_>,
    ) -> Option<Id> {
        let text = &value[part.clone()];
        let inner = text.trim_start();
        let begin = part.start + text.len() - inner.len();
        let inner = inner.trim_end();
        let origin = Origin::Outside(&argument.given, argument.value + begin);
        let (lowered, _): (Lowered, _) = self.lower(inner, origin, &At::ROOT, allow, local)?;
        match lowered.expect(wanted) {
            Ok(()) => {
                if wanted.is_angle() && inner.parse::<f64>().is_ok_and(|x| x.abs() > std::f64::consts::TAU) {
                    let message = format!("`{name}` is {inner} rad, more than a turn");
                    let fault = self.fault("bare-angle", &At::ROOT, message, "an angle in rad, or with its unit");
                    (fault.spot, fault.warning) = (origin.spot(0..inner.len()), true);
                    fault.help = Some(format!("if degrees are meant, write `{inner} deg`"));
                }
                Some(lowered.id)
            }
            Err(other) => {
                let fault = self.fault("wrong-dimension", &At::ROOT, format!("found {other}"), wanted.name());
                fault.spot = origin.spot(0..inner.len());
                let fraction = expression::meant_fraction(inner);
                fault.help = Some(fraction.unwrap_or_else(|| format!("`{name}` is given in {}", unit_words(wanted))));
                None
            }
        }
    }

    /// Sweeps given from outside.
    pub(super) fn over(&mut self, outside: &Outside<'_>, solved: Option<&str>, local: &mut Local<'n>) -> Vec<Sweep> {
        let mut sweeps: Vec<Sweep> = Vec::new();
        let mut runs: u64 = outside.samples.map_or(1, |samples| samples.count as u64);
        for (names, value) in outside.over {
            let argument = Argument::new(outside.caller, Asked::Over, names, value);
            let Some(parameters) = self.swept_outside(names, &argument, &sweeps, solved) else { continue };
            let (found, count) = match parameters[..] {
                [(parameter, wanted, name)] => {
                    let (values, count) = self.values_outside(name, value, wanted, &argument, outside, local);
                    (
                        values.map(|values| Sweep { parameter, values, place: String::new(), unit: unit_of(value) }).into_iter().collect(),
                        count,
                    )
                }
                _ => self.points_outside(&parameters, value, &argument, local),
            };
            runs = runs.saturating_mul(count as u64);
            if runs > MOST_RUNS {
                let message = format!("a sweep of {runs} runs");
                self.fault("too-many-runs", &At::ROOT, message, format!("at most {MOST_RUNS} runs")).spot = argument.spot(0..value.len());
                break;
            }
            sweeps.extend(found);
        }
        if let (Some(samples), Some((name, value))) = (outside.samples, outside.over.last())
            && outside.over.iter().all(|(_, value)| distribution(value).is_none())
        {
            let fault = self.fault("nothing-drawn", &At::ROOT, "no parameter has a distribution", outside.caller.distribution());
            fault.spot = Argument::new(outside.caller, Asked::Over, name, value).spot(0..value.len());
            fault.help = Some(format!("leave {} out", outside.caller.so_many_samples(samples.count)));
        }
        sweeps
    }

    /// The parameters that an argument names, with commas between several, none of them swept already; with what they are of.
    fn swept_outside<'a>(
        &mut self,
        names: &'a str,
        argument: &Argument,
        sweeps: &[Sweep],
        solved: Option<&str>,
    ) -> Option<Vec<(usize, Dimension, &'a str)>> {
        let mut found: Vec<(usize, Dimension, &str)> = Vec::new();
        for part in between_commas(names) {
            let (name, behind) = (names[part.clone()].trim(), names.len() - part.start - names[part].trim_end().len());
            let (parameter, wanted) = self.named_outside(name, argument.name(name, behind))?;
            let twice = sweeps.iter().any(|s| s.parameter == parameter) || found.iter().any(|(known, ..)| *known == parameter);
            if twice || solved == Some(name) {
                let message = format!("`{name}` {}", if twice { "is swept already" } else { "is what the study solves for" });
                let fault = self.fault("swept-twice", &At::ROOT, message, "another parameter");
                fault.spot = argument.name(name, behind);
                fault.help = Some("leave this one out".to_owned());
                return None;
            }
            found.push((parameter, wanted?, name));
        }
        Some(found)
    }

    /// The values of one parameter, and how many of them are not drawn.
    fn values_outside(
        &mut self,
        name: &str,
        value: &str,
        wanted: Dimension,
        argument: &Argument,
        outside: &Outside<'_>,
        local: &mut Local<'n>,
    ) -> (Option<Values>, usize) {
        match (distribution(value), value.find("..")) {
            (Some(of), _) => {
                self.samples_of(outside, argument, value);
                (self.drawn(name, value, of, argument, wanted, local), 1)
            }
            (None, Some(dots)) => self.span(name, value, dots, argument, wanted, local),
            (None, None) => self.list(name, value, argument, wanted, local),
        }
    }

    /// That nothing says how many values are drawn.
    fn samples_of(&mut self, outside: &Outside<'_>, argument: &Argument, value: &str) {
        if outside.samples.is_none() {
            let message = "values are drawn from a distribution, and nothing says how many";
            let fault = self.fault("missing-samples", &At::ROOT, message, outside.caller.samples());
            fault.spot = argument.spot(0..value.len());
            fault.help = Some(format!("add {}", outside.caller.so_many_samples(200)));
        }
    }

    /// A distribution with its two values.
    fn drawn(
        &mut self,
        name: &str,
        value: &str,
        (normal, inner): (bool, Range<usize>),
        argument: &Argument,
        wanted: Dimension,
        local: &mut Local<'n>,
    ) -> Option<Values> {
        let parts = between_commas(&value[inner.clone()]);
        let [first, second] = &parts[..] else {
            let form = if normal { "normal(MEAN, DEVIATION)" } else { "uniform(FROM, TO)" };
            let fault = self.fault("bad-range", &At::ROOT, format!("a distribution of {} values", parts.len()), form);
            fault.spot = argument.spot(inner);
            fault.help = Some(format!("write two values, as {}", argument.caller.over(name, "normal(1, 0.01)")));
            return None;
        };
        let part = |of: &Range<usize>| of.start + inner.start..of.end + inner.start;
        let [first, second] =
            [part(first), part(second)].map(|part| self.given(name, value, part, argument, wanted, Self::over_allow(), local));
        let (first, second) = (first?, second?);
        if !normal {
            return Some(Values::Uniform { from: first, to: second });
        }
        if self.pool.inputs_of(&[second]).is_empty() {
            self.check_once(Rule::NotNegative("a standard deviation"), &[second], &At::ROOT);
        }
        Some(Values::Normal { mean: first, deviation: second })
    }

    /// `FROM..TO:COUNT`, with `:log` for equal ratios; and how many values it stands for.
    fn span(
        &mut self,
        name: &str,
        value: &str,
        dots: usize,
        argument: &Argument,
        wanted: Dimension,
        local: &mut Local<'n>,
    ) -> (Option<Values>, usize) {
        let mut ends = value[dots..].match_indices(':').map(|(i, _)| dots + i);
        let form = "FROM..TO:COUNT, or FROM..TO:COUNT:log for equal ratios";
        let Some(colon) = ends.next() else {
            let fault = self.fault("bad-range", &At::ROOT, "a range without the number of its values", form);
            fault.spot = argument.spot(0..value.len());
            fault.help = Some(format!("for example {}", argument.caller.over(name, &format!("{value}:11"))));
            return (None, 1);
        };
        let end = ends.next().unwrap_or(value.len());
        let (count_text, spacing) = (value[colon + 1..end].trim(), value.get(end + 1..).map(str::trim));
        let count = count_text.parse::<u64>().ok().filter(|n| (1..=MOST_RUNS).contains(n)).and_then(|n| usize::try_from(n).ok());
        if count.is_none() {
            let message = format!("`{}` is no number of values", clip(count_text));
            let fault = self.fault("bad-range", &At::ROOT, message, format!("a whole number from 1 to {MOST_RUNS}"));
            fault.spot = argument.spot(colon + 1..end);
            fault.help = Some(format!("for example {}", argument.caller.over(name, &format!("{}:11", &value[..colon]))));
        }
        if let Some(word) = spacing.filter(|word| !["log", "linear"].contains(word)) {
            let help = suggest::help(word, ["log", "linear"]);
            let fault = self.fault("bad-range", &At::ROOT, format!("unknown spacing `{}`", clip(word)), "`log` or `linear`");
            (fault.spot, fault.help) = (argument.spot(end + 1..value.len()), help);
            return (None, 1);
        }
        let allow = Self::over_allow();
        let from = self.given(name, value, 0..dots, argument, wanted, allow, local);
        let to = self.given(name, value, dots + 2..colon, argument, wanted, allow, local);
        let (Some(from), Some(to), Some(count)) = (from, to, count) else { return (None, 1) };
        let log = spacing == Some("log");
        if self.pool.inputs_of(&[from, to]).is_empty() {
            self.check_once(if log { Rule::Ratio } else { Rule::Finite }, &[from, to], &At::ROOT);
        }
        (Some(Values::Span { from, to, count, log }), count)
    }

    /// Values with commas between them; and how many.
    fn list(&mut self, name: &str, value: &str, argument: &Argument, wanted: Dimension, local: &mut Local<'n>) -> (Option<Values>, usize) {
        let parts = between_commas(value);
        let count = parts.len();
        let ids: Vec<Option<Id>> =
            parts.into_iter().map(|part| self.given(name, value, part, argument, wanted, Self::over_allow(), local)).collect();
        let ids: Option<Vec<Id>> = ids.into_iter().collect();
        if let Some(ids) = &ids
            && self.pool.inputs_of(ids).is_empty()
        {
            self.check_once(Rule::Finite, ids, &At::ROOT);
        }
        (ids.map(Values::List), count)
    }

    pub(super) fn over_allow() -> Allow {
        Allow { what: "a value for a parameter", ..Allow::PARAMETER }
    }

    /// Shows faults without a place in the file at the arguments that sweep.
    pub(super) fn blame_over(&mut self, from: usize, outside: &Outside<'_>) {
        let over: Vec<String> = outside.over.iter().map(|(name, value)| format!("{name}={value}")).collect();
        let given = outside.caller.all(Asked::Over, &over);
        for fault in self.faults[from..].iter_mut().filter(|fault| fault.place.is_empty() && !over.is_empty()) {
            fault.spot = given.whole();
        }
    }
}

/// Whether a text is a normal distribution or one between two values, and where these stand in it.
fn distribution(text: &str) -> Option<(bool, Range<usize>)> {
    let end = text.trim_end().strip_suffix(')')?.len();
    let begin = text.len() - text.trim_start().len();
    [("normal(", true), ("uniform(", false)]
        .into_iter()
        .find_map(|(word, normal)| text[begin..].starts_with(word).then(|| (normal, begin + word.len()..end)))
}

/// Parts of a text between commas that stand in no parentheses.
pub(super) fn between_commas(text: &str) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let (mut depth, mut begin) = (0_i32, 0);
    for (i, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            b',' if depth <= 0 => {
                parts.push(begin..i);
                begin = i + 1;
            }
            _ => {}
        }
    }
    parts.push(begin..text.len());
    parts
}

/// Figures of numbers of whole runs, drawn for a study's own sweep, over the first parameter of another one.
pub(super) fn retarget(plots: &mut Vec<Plot>, own: &[Sweep], over: &[Sweep]) {
    let first = |sweeps: &[Sweep]| sweeps.first().map(|s| s.parameter);
    let swept = |what: ShownWhat| match what {
        ShownWhat::Parameter(p) => over.iter().any(|s| s.parameter == p),
        _ => true,
    };
    for plot in plots.iter_mut().filter(|plot| plot.show.iter().any(|s| !matches!(s.what, ShownWhat::Column(_)))) {
        plot.show.retain(|s| swept(s.what));
        let gone = plot.over.take_if(|shown| !swept(shown.what)).is_some();
        if gone || plot.over.is_none() && first(own) != first(over) {
            (plot.unit, plot.x) = (None, None);
        }
    }
    plots.retain(|plot| !plot.show.is_empty());
}

fn unit_words(dimension: Dimension) -> String {
    match dimension.si() {
        si if si.is_empty() => "plain numbers".to_owned(),
        si => format!("{si}; a bare number counts as {si}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_in_parentheses_do_not_part() {
        let text = "1, max(2, 3) ,4";
        let parts: Vec<&str> = between_commas(text).into_iter().map(|part| &text[part]).collect();
        assert_eq!(parts, ["1", " max(2, 3) ", "4"]);
        assert_eq!(between_commas("").first(), Some(&(0..0)));
    }
}
