//! Scalars and expectations: numbers of a whole study.

use super::decoder::{Decoder, Origin};
use super::frame::Frame;
use super::order::{in_words, order};
use super::values::needs;
use crate::expression::{Dimension, Symbol};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, NUMBER, Want, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::needs::Needs;
use crate::model::scope::Allow;
use crate::model::study::{Expectation, Scalar, Tolerance};
use crate::model::vocabulary::{Quantity, WORKS};

/// Outside of functionals a scalar may use parameters and other numbers of the whole study.
const SCALAR: Allow = Allow { what: "a scalar", ..Allow::CONSTANT };

keys! {
    /// `expect`, of one scalar.
    pub(super) EXPECT = ExpectKeys "an expectation" [one_of(&["within", "relative"])] {
        is: need ANY, "The value.";
        within: may ANY, "Largest absolute difference.";
        relative: may NUMBER, "Largest difference relative to the value.";
    }
}

impl<'n> Decoder<'n> {
    pub(super) fn scalars(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>) -> Vec<Scalar> {
        Self::open_functionals(frame);
        let section = at.key(asked);
        let entries = asked.entries();
        let drafts: Vec<_> = entries.iter().map(|(name, value)| self.draft(Some(*value), &section.key(*name))).collect();
        for (name, _) in &entries {
            let here = section.key(*name);
            self.free_name(name, &here, "a scalar");
            let double =
                frame.local.symbols.iter().any(|(known, _)| known == name) || frame.features.results.iter().any(|(known, _)| known == name);
            if double {
                let message = format!("`{name}` is a scalar of this study already");
                let fault = self.fault("duplicate-name", &here, message, "another name for the scalar");
                fault.spot = Spot::Key;
                fault.help = Some("results of the kind and taken scalars are scalars too".to_owned());
            }
        }
        // results are known first: the names are the decoder's own, so they are looked up by position
        let results: Vec<(String, Dimension)> = frame.features.results.clone();
        for (i, (name, dimension)) in results.iter().enumerate() {
            let id = self.name_space.input(&mut self.pool, Quantity::Result(i));
            frame.results.push((name.clone(), Symbol { id, dimension: *dimension }));
        }
        // names that the file gives come first
        if frame.features.works {
            let names = &self.name_space.names;
            let free = |name: &str| entries.iter().all(|(known, _)| *known != name) && !names.contains_key(name);
            let works: Vec<(usize, &str)> = WORKS.into_iter().enumerate().filter(|(_, name)| free(name)).collect();
            for (i, name) in works {
                let id = self.name_space.input(&mut self.pool, Quantity::Work(i));
                frame.results.push((name.to_owned(), Symbol { id, dimension: Dimension::ENERGY }));
            }
        }
        let find = |name: &str| entries.iter().position(|(known, _)| *known == name);
        let needs: Vec<Vec<usize>> = drafts.iter().map(|draft| needs(draft, find)).collect();
        let (order, cycles) = order(&needs);
        let mut in_cycle = vec![false; entries.len()];
        for cycle in &cycles {
            if let Some(first) = cycle.first() {
                let message = in_words(cycle, |i| entries[i].0.to_owned());
                let fault = self.fault("cycle", &section.key(entries[*first].0), message, "scalars that do not need themselves");
                fault.spot = Spot::Key;
            }
            cycle.iter().for_each(|i| in_cycle[*i] = true);
        }
        let mut found = vec![None; entries.len()];
        for i in order {
            let (name, _) = entries[i];
            let lowered = if in_cycle[i] { None } else { self.finish_scalar(&drafts[i], &section.key(name), frame) };
            // a scalar is a number once the study is done, and may be used by others like a parameter
            let symbol = lowered.map(|symbol| (symbol, Needs::CONSTANT));
            frame.local.symbols.push((name, symbol));
            found[i] = lowered;
        }
        let mut scalars = Vec::new();
        for (i, (name, _)) in entries.iter().enumerate() {
            if let Some(symbol) = found[i] {
                let place = self.place(&section.key(*name));
                frame.scalars.push(((*name).to_owned(), symbol.dimension));
                scalars.push(Scalar { name: (*name).to_owned(), dimension: symbol.dimension, value: symbol.id, place });
            }
        }
        scalars
    }

    fn finish_scalar(&mut self, draft: &super::values::Draft<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>) -> Option<Symbol> {
        let results = std::mem::take(&mut frame.results);
        let lowered = {
            let known = results.iter().map(|(name, symbol)| (name.as_str(), Some((*symbol, Needs::CONSTANT))));
            let mut local = crate::model::scope::Local {
                symbols: frame.local.symbols.iter().copied().chain(known).collect(),
                functionals: frame.local.functionals.take(),
            };
            let lowered = self.finish(draft, at, SCALAR, &mut local);
            frame.local.functionals = local.functionals;
            lowered
        };
        frame.results = results;
        lowered.map(|(lowered, _)| Symbol { id: lowered.id, dimension: lowered.dimension })
    }

    pub(super) fn expectations(&mut self, asked: Entry<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>) -> Vec<Expectation> {
        let section = at.key(asked);
        let mut all = Vec::new();
        for (text, inner) in asked.entries() {
            let here = section.key(text);
            let value = self.expected_value(text, &here, frame);
            let Some((value, dimension)) = value else { continue };
            let want = Want::Of(dimension);
            let keys = ExpectKeys::of(inner);
            let before = self.faults.len();
            let is = self.read_as(keys.is, &here, want);
            self.blame_scalar(before, frame);
            let tolerance = if keys.within.given() {
                self.size_as(keys.within.node, &here.key(keys.within), Want::Of(dimension), "the tolerance").map(Tolerance::Within)
            } else {
                self.size(keys.relative, &here, "the tolerance").map(Tolerance::Relative)
            };
            if let (Some(is), Some(tolerance)) = (is, tolerance) {
                let place = self.place(&here);
                all.push(Expectation { text: text.to_owned(), value, is, tolerance, dimension, place });
            }
        }
        all
    }

    /// Tells of unknown names among the latest faults, which are those of scalars, how scalars are compared.
    fn blame_scalar(&mut self, from: usize, frame: &Frame<'n>) {
        let scalars = || frame.scalars.iter().map(|(name, _)| name).chain(frame.results.iter().map(|(name, _)| name));
        for fault in self.faults[from..].iter_mut().filter(|fault| fault.code == "unknown-name") {
            if let Some(name) = scalars().find(|name| fault.message == format!("unknown name `{name}`")) {
                fault.message = format!("`{name}` is a number of the study");
                "a number of parameters".clone_into(&mut fault.expected);
                fault.help = Some(format!("expect of a difference that it is 0, as `x - {name}: {{ is: 0, within: .. }}`"));
            }
        }
    }

    /// The value that a key of `expect` stands for.
    fn expected_value(&mut self, text: &'n str, at: &At<'_, 'n>, frame: &mut Frame<'n>) -> Option<(crate::expression::Id, Dimension)> {
        let results = std::mem::take(&mut frame.results);
        let lowered = {
            let known = results.iter().map(|(name, symbol)| (name.as_str(), Some((*symbol, Needs::CONSTANT))));
            let mut local = crate::model::scope::Local {
                symbols: frame.local.symbols.iter().copied().chain(known).collect(),
                functionals: frame.local.functionals.take(),
            };
            let allow = Allow { what: "an expectation", ..SCALAR };
            let lowered = self.lower(text, Origin::Key(text), at, allow, &mut local);
            frame.local.functionals = local.functionals;
            lowered
        };
        frame.results = results;
        lowered.map(|(lowered, _)| (lowered.id, lowered.dimension))
    }
}
