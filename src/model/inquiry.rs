//! One reading of a file: which variants and studies, in which order, and decoded models shared by all studies with the
//! same variants.

use super::asked::Asked;
use super::decode::{self, Decoder, Outside, Parsed, Scalars, StudyKeys, Taken};
use super::diagnostics::Report;
use super::document::{Document, Selection};
use super::fault::{At, Fault, Spot};
use super::idle;
use super::included::Included;
use super::merge::{self, Layers, Merged, Node};
use super::shape;
use super::stems;
use super::suggest;
use super::whole::Model;
use crate::expression::Id;
use serde_yaml::{Mapping, Value};
use std::collections::{HashMap, HashSet};
use std::sync::LazyLock;

/// Each fault once, with the variants that made it if the file alone does not have it.
fn once<'b>(bases: impl Iterator<Item = (Vec<Fault>, &'b [&'b str])>) -> Vec<Fault> {
    let mut seen = HashSet::new();
    let mut all = Vec::new();
    for (faults, variants) in bases {
        for fault in faults {
            if seen.contains(&fault) {
                continue;
            }
            seen.insert(fault.clone());
            all.push(with_variants(fault, variants));
        }
    }
    all
}

/// Says under which variants a fault stands that is shown at a place outside of them.
fn with_variants(mut fault: Fault, variants: &[&str]) -> Fault {
    if !variants.is_empty() && !fault.place.starts_with("variants.") && !fault.place.starts_with("studies.") {
        let names: Vec<String> = variants.iter().map(|name| format!("`{name}`")).collect();
        let word = if variants.len() == 1 { "variant" } else { "variants" };
        fault.message = format!("{} (with {word} {})", fault.message, names.join(", "));
    }
    fault
}

/// Parameters set from outside, with their values.
type Settings = Vec<(usize, Id)>;

/// One reading: decoded models are shared by all studies with the same variants.
pub(super) struct Inquiry<'d, 's> {
    document: &'d Document,
    selection: &'s Selection<'s>,
    /// Studies to be read, those that others take from first; with their variants.
    studies: Vec<(&'d str, Node<'d>, Vec<&'d str>)>,
    /// Faults of selecting.
    faults: Vec<Fault>,
    /// Syntax trees, handed from decoder to decoder.
    parsed: Parsed,
}

/// Layers and merged map of a list of variants.
struct Base<'d> {
    variants: Vec<&'d str>,
    layers: Layers<'d>,
    merged: Merged<'d>,
}

impl<'d, 's> Inquiry<'d, 's> {
    pub(super) fn new(document: &'d Document, selection: &'s Selection<'s>) -> Self {
        Self { document, selection, studies: Vec::new(), faults: Vec::new(), parsed: Parsed::new() }
    }

    /// The file without variants.
    fn plain(&self) -> Layers<'d> {
        static EMPTY: LazyLock<Mapping> = LazyLock::new(Mapping::new);
        let below = self.document.included.iter().map(Included::sections).collect();
        Layers { below, file: self.document.root.as_mapping().unwrap_or(&EMPTY), patches: Vec::new() }
    }

    /// Faults of form.
    pub(super) fn form(&mut self) -> Vec<Fault> {
        let layers = self.plain();
        let mut faults = shape::check_file(&layers, Node::Plain(&self.document.root));
        if faults.is_empty() {
            faults.extend(idle::idle(layers.file, &layers.below));
            faults.extend(stems::shared(&self.document.named("studies")));
        }
        faults
    }

    /// The patch of a variant; the fault is reported at its place, or where it was asked for from outside.
    fn patch(&mut self, name: &str, at: Option<&At<'_, '_>>) -> Option<(&'d str, &'d Mapping)> {
        let found = self.document.named("variants").into_iter().find(|(known, _)| *known == name);
        match found {
            Some((name, Node::Plain(Value::Mapping(map)))) => Some((name, map)),
            Some(_) => None,
            None => {
                let known = self.document.variant_names();
                let help = suggest::help(name, known.iter().map(String::as_str)).unwrap_or_else(|| suggest::take_or_add(name, "variants"));
                let message = format!("unknown variant `{}`", suggest::clip(name));
                let place = at.map(|at| merge::path(&at.steps())).unwrap_or_default();
                let mut fault = Fault::new("unknown-variant", place, message, "a variant of this file").help(help);
                if at.is_none() {
                    fault.spot = self.selection.caller.given(Asked::Variant, name).end(name.len());
                }
                self.faults.push(fault);
                None
            }
        }
    }

    /// Variants of a study, then those from outside.
    fn variants(&mut self, study: Option<(&'d str, Node<'d>)>) -> Vec<&'d str> {
        let mut names = Vec::new();
        if let Some((study, node)) = study {
            let section = At::ROOT.key("studies");
            let study_at = section.key(study);
            let at = study_at.key("variant");
            match StudyKeys::of(node).variant.node {
                Some(Node::Plain(Value::String(name))) => names.extend(self.patch(name, Some(&at)).map(|(name, _)| name)),
                Some(node) => {
                    for (i, item) in node.items().iter().enumerate() {
                        if let Some(name) = item.as_str() {
                            names.extend(self.patch(name, Some(&at.index(i))).map(|(name, _)| name));
                        }
                    }
                }
                None => {}
            }
        }
        for name in &self.selection.variants {
            names.extend(self.patch(name, None).map(|(name, _)| name));
        }
        names
    }

    /// The studies in an order in which those that are taken from come first; `only`: those and what they need, or all if there
    /// are none.
    fn arrange(&mut self, only: &[&str]) {
        let all: Vec<(&'d str, Node<'d>)> = self.document.named("studies").into_iter().filter(|(_, node)| node.is_map()).collect();
        let index: HashMap<&str, usize> = all.iter().enumerate().map(|(i, (name, _))| (*name, i)).collect();
        let needs: Vec<Vec<usize>> = all
            .iter()
            .map(|(_, node)| {
                let takes = StudyKeys::of(*node).take.entries();
                let studies = takes.iter().filter_map(|(_, value)| value.text()?.split('.').next());
                studies.filter_map(|study| index.get(study).copied()).collect()
            })
            .collect();
        let (order, cycles) = decode::order(&needs);
        for cycle in cycles {
            if let Some(first) = cycle.first() {
                let message = decode::in_words(&cycle, |i| all[i].0.to_owned());
                let place = format!("studies.{}.take", all[*first].0);
                self.faults.push(Fault::new("cycle", place, message, "studies that do not need themselves").at(Spot::Key));
            }
        }
        let mut wanted = vec![only.is_empty(); all.len()];
        let mut open: Vec<usize> = only.iter().filter_map(|name| index.get(name).copied()).collect();
        while let Some(i) = open.pop() {
            if !std::mem::replace(&mut wanted[i], true) {
                open.extend(&needs[i]);
            }
        }
        for i in order.into_iter().filter(|i| wanted[*i]) {
            let variants = self.variants(Some(all[i]));
            self.studies.push((all[i].0, all[i].1, variants));
        }
    }

    fn base(&self, variants: &[&'d str]) -> Base<'d> {
        let mut layers = self.plain();
        for name in variants {
            if let Some((name, Node::Plain(Value::Mapping(map)))) =
                self.document.named("variants").into_iter().find(|(known, _)| known == name)
            {
                layers.patches.push((name, map));
            }
        }
        let merged = layers.merge();
        Base { variants: variants.to_vec(), layers, merged }
    }

    /// Bases for all studies, behind the given ones; for each study the index of its base.
    fn bases(&self, mut bases: Vec<Base<'d>>) -> (Vec<Base<'d>>, Vec<usize>) {
        let mut base_of = Vec::new();
        for (_, _, variants) in &self.studies {
            let index = bases.iter().position(|base| base.variants == *variants).unwrap_or_else(|| {
                bases.push(self.base(variants));
                bases.len() - 1
            });
            base_of.push(index);
        }
        (bases, base_of)
    }

    /// Faults of meaning of the model as it stands and of every study, or of some.
    pub(super) fn meaning(&mut self, only: &[String]) -> Vec<Fault> {
        let plain = self.variants(None);
        self.arrange(&only.iter().map(String::as_str).collect::<Vec<_>>());
        let (bases, base_of) = self.bases(vec![self.base(&plain)]);
        let mut faults = std::mem::take(&mut self.faults);
        let mut scalars: HashMap<&str, Scalars> = HashMap::new();
        let mut decoders: Vec<(Decoder<'_>, Settings)> = Vec::new();
        for base in &bases {
            decoders.push(self.decoder(base));
        }
        let mut parsed = std::mem::take(&mut self.parsed);
        for ((name, node, _), base) in self.studies.iter().zip(base_of) {
            let (decoder, outside) = &mut decoders[base];
            decoder.parsed = parsed;
            let taken = |study: &str| self.taken(&scalars, study);
            let decoded = decoder.study(name, *node, &taken, &self.without_sweep(outside));
            scalars.insert(name, decoded.scalars);
            parsed = std::mem::take(&mut decoder.parsed);
        }
        let decoded = decoders.into_iter().map(|(decoder, _)| decoder.faults);
        faults.extend(once(decoded.zip(&bases).map(|(faults, base)| (faults, &base.variants[..]))));
        faults
    }

    /// What is given from outside, but for sweeps.
    fn without_sweep<'o>(&'o self, set: &'o [(usize, Id)]) -> Outside<'o> {
        let Selection { variants, over, caller, .. } = self.selection;
        let changes = !(set.is_empty() && variants.is_empty() && over.is_empty());
        Outside { caller: *caller, set, over: &[], samples: None, changes, files: &self.document.data }
    }

    /// Scalars of a study, if it was decoded.
    fn taken(&self, scalars: &HashMap<&str, Scalars>, study: &str) -> Taken {
        match scalars.get(study) {
            Some(_) if self.document.study_node(study).is_some_and(|node| StudyKeys::of(node).sweep.given()) => Taken::Swept,
            Some(scalars) => Taken::Known(scalars.clone()),
            None if self.document.study_node(study).is_some() => Taken::Waiting,
            None => Taken::NoStudy,
        }
    }

    /// A decoded model with its form and numbers checked, and the parameters from outside.
    fn decoder<'b>(&mut self, base: &'b Base<'d>) -> (Decoder<'b>, Settings)
    where
        's: 'b,
    {
        let root = Node::Merged(&base.merged);
        let mut form = if base.layers.is_merged() { shape::check_merged(&base.layers, root) } else { Vec::new() };
        let mut decoder = Decoder::new(&base.layers, root, &self.selection.externals, std::mem::take(&mut self.parsed));
        form.append(&mut decoder.faults);
        decoder.faults = form;
        let outside = decoder.outside(&self.selection.sets, self.selection.caller);
        let values = decoder.evaluate(&outside, &[]);
        for fault in &mut decoder.faults {
            if fault.code == "cycle" && fault.place.is_empty() {
                let sets: Vec<String> = self.selection.sets.iter().map(|(name, value)| format!("{name}={value}")).collect();
                fault.spot = self.selection.caller.all(Asked::Value, &sets).whole();
            }
        }
        decoder.run_checks(&values, 0);
        self.parsed = std::mem::take(&mut decoder.parsed);
        (decoder, outside)
    }

    /// The model for one study, or for none.
    pub(super) fn model_for(&mut self, study: Option<&str>) -> Result<Model, Report> {
        match study {
            Some(study) => self.arrange(&[study]),
            None => {
                let variants = self.variants(None);
                self.studies.push(("", Node::Plain(&Value::Null), variants));
            }
        }
        let (bases, base_of) = self.bases(Vec::new());
        let mut faults = std::mem::take(&mut self.faults);
        let mut decoders: Vec<Option<(Decoder<'_>, Settings)>> = bases.iter().map(|base| Some(self.decoder(base))).collect();
        let mut parsed = std::mem::take(&mut self.parsed);
        let mut scalars: HashMap<&str, Scalars> = HashMap::new();
        let mut model = None;
        let last = self.studies.len().saturating_sub(1);
        for (i, ((name, node, _), base)) in self.studies.iter().zip(base_of).enumerate() {
            let taken = |study: &str| self.taken(&scalars, study);
            if i < last {
                if let Some((decoder, outside)) = &mut decoders[base] {
                    decoder.parsed = std::mem::take(&mut parsed);
                    let decoded = decoder.study(name, *node, &taken, &self.without_sweep(outside));
                    scalars.insert(name, decoded.scalars);
                    parsed = std::mem::take(&mut decoder.parsed);
                }
            } else if let Some((mut decoder, outside)) = decoders[base].take() {
                decoder.parsed = std::mem::take(&mut parsed);
                let given = Outside { over: &self.selection.over, samples: self.selection.samples, ..self.without_sweep(&outside) };
                let decoded = node.is_map().then(|| decoder.study(name, *node, &taken, &given));
                faults.extend(once(std::iter::once((std::mem::take(&mut decoder.faults), &bases[base].variants[..]))));
                let mut made = decoder.into_model(decoded.as_ref().map_or(&[], |decoded| &decoded.checks));
                let set = decoded.as_ref().map_or(&outside, |decoded| &decoded.set);
                for (i, value) in set {
                    made.parameters[*i].value = *value;
                }
                made.set = outside.iter().map(|(i, _)| made.parameters[*i].name.clone()).collect();
                made.study = decoded.and_then(|decoded| decoded.study);
                model = Some(made);
            }
        }
        for (decoder, _) in decoders.into_iter().flatten() {
            faults.extend(decoder.faults);
        }
        let failed = faults.iter().any(|fault| !fault.warning);
        match model {
            Some(model) if !failed && (study.is_none() || model.study.is_some()) => {
                Ok(Model { warnings: self.document.report(&faults), ..model })
            }
            _ => Err(self.document.report(&faults)),
        }
    }
}
