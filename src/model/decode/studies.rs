//! Studies: kind, parameters and solve. Sweeps are in `sweeps`, columns and figures are in `columns`, scalars and expectations in `scalars`.

use super::columns::PLOT;
use super::decoder::{Check, Decoder};
use super::frame::Frame;
use super::kinds::{Features, OF_KINDS};
use super::outside::{Outside, retarget};
use super::pictures::{SHOW, TRACE, VIEW};
use super::plots::COLUMN;
use super::scalars::EXPECT;
use super::sweeps::SWEEP;
use crate::expression::{Dimension, Id, Symbol};
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANY, Keys, Record, Shape, Size, Want, joined, keys_of, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::needs::Needs;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Functionals, Local};
use crate::model::study::{Solve, Study, StudyResult, Sweep, Take};
use crate::model::suggest;
use crate::model::suggest::clip;
use crate::model::vocabulary::Quantity;

/// What a study has that others may take.
pub(crate) enum Taken {
    /// There is no such study.
    NoStudy,
    /// It is part of a cycle, which was reported.
    Waiting,
    /// It is a sweep, which has a list of values.
    Swept,
    /// Its scalars.
    Known(Scalars),
}

/// Scalars of a study that others may take: name and dimension, `None` where faulty.
pub(crate) type Scalars = Vec<(String, Option<Dimension>)>;

/// A decoded study, as far as it is sound.
pub(crate) struct Decoded<'n> {
    /// The study; `None` if its kind is faulty.
    pub(crate) study: Option<Study>,
    /// Parameters that it sets.
    pub(crate) set: Vec<(usize, Id)>,
    /// What others may take.
    pub(crate) scalars: Scalars,
    /// What must hold of its own values.
    pub(crate) checks: Vec<Check<'n>>,
}

const VARIANT: Shape = Shape::Name("the name of a variant");

keys! {
    /// A study, beside its kind.
    pub(crate) COMMON = StudyKeys "a study" [] {
        about: may Shape::Text, "What the study is for.";
        variant: may Shape::Either(&[VARIANT, Shape::List(&VARIANT, Size::AtLeast(0))]),
            "Variants, applied in order.";
        set: may Shape::Named(Keys::Reference, "a parameter", &ANY), "Parameters for this study.";
        take: may Shape::Named(Keys::Name, "a scalar of another study", &Shape::Name("a scalar of another study, `STUDY.SCALAR`")),
            "Scalars of other studies.";
        sweep: may SWEEP,
            "Parameters that run through values; several: the grid. `samples` (and `seed`): how many points are drawn from distributions.";
        solve: may Shape::Map(&SOLVE), "A parameter varied until a scalar meets its target.";
        columns: may Shape::List(&COLUMN, Size::AtLeast(1)), "Columns of the CSV, in order.";
        undefined: may Shape::List(&COLUMN, Size::AtLeast(1)), "Columns that may be undefined: their cells are blank there.";
        scalars: may Shape::Named(Keys::Name, "a scalar", &Shape::Formula("an expression of functionals, parameters and scalars")),
            "Numbers of the whole study.";
        plot: may Shape::Named(Keys::Title, "a figure", &Shape::Either(&[Shape::Map(&PLOT), Shape::List(&COLUMN, Size::AtLeast(1))])),
            "Figures.";
        trace: may TRACE, "Points whose paths are drawn; without it those of points that columns name, or of a few that are on no circle.";
        show: may SHOW, "Forces that the drawing shows as arrows: loads, reactions; or each with its scale, a force per length.";
        at: may ANY, "The place of the motion that the drawing shows strongly, with its forces: a value of the independent variable.";
        view: may VIEW, "In space: where the drawing is seen from, a side or azimuth and elevation; isometric if omitted.";
        expect: may Shape::Named(Keys::Reference, "a scalar or an expression", &Shape::Map(&EXPECT)),
            "What must come out; if not, exit code 1.";
    }
}

/// A study: the key of one of the kinds, and what all kinds share.
pub(crate) static STUDY: Record = Record {
    what: COMMON.what,
    choices: &[one_of(&keys_of::<{ OF_KINDS.len() }>(&OF_KINDS))],
    fields: &joined::<{ OF_KINDS.len() + StudyKeys::FIELDS.len() }>(&OF_KINDS, StudyKeys::FIELDS),
};

keys! {
    /// `solve`.
    SOLVE = SolveKeys "a solve" [] {
        vary: need Shape::Name("the name of a parameter"), "The parameter.";
        between: need Shape::List(&ANY, Size::Exactly(2)), "Its bounds.";
        target: need Shape::Named(Keys::Reference, "a scalar", &ANY), "The scalar and its target.";
    }
}

impl<'n> Decoder<'n> {
    /// Decodes a study of the file. `taken` gives the scalars of the studies that it takes from; what `outside` sweeps takes the
    /// place of the study's own sweep.
    pub(crate) fn study(&mut self, name: &'n str, node: Node<'n>, taken: &dyn Fn(&str) -> Taken, outside: &Outside<'_>) -> Decoded<'n> {
        let section = At::ROOT.key("studies");
        let at = section.key(name);
        let mut local = Local::default();
        let keys = StudyKeys::of(node);
        let take = self.take(keys.take, &at, taken, &mut local);
        let mut waiting = Vec::new();
        let set = self.set(keys.set, &at, &mut local, outside.set, &mut waiting);
        let mut all = set.clone();
        all.extend(outside.set.iter().copied());
        let first_check = self.checks_so_far();
        let (word, kind) = self.kind(node, &at);
        let (kind, features) = match kind {
            Some((kind, features)) => (Some(kind), features),
            None => (None, Features::faulty()),
        };
        if !features.columns {
            self.no_columns(keys.columns, word, &at);
        }
        let solved = keys.solve.node.and_then(|solve| SolveKeys::of(solve).vary.text());
        let (own, samples) = self.sweep(keys.sweep, &at, &mut local);
        let over = self.over(outside, solved, &mut local);
        let first = if own.is_empty() { &over } else { &own };
        let swept = first.iter().map(|s| s.parameter).collect();
        let mut frame = Frame { local, word, features, swept, scalars: Vec::new(), results: Vec::new() };
        let result = |(name, dimension): &(String, Dimension)| StudyResult { name: name.clone(), dimension: *dimension };
        let results = frame.features.results.iter().map(result).collect();
        let columns_given = keys.columns.given();
        let columns = self.columns(keys.columns, &at, &mut frame);
        let scalars = self.scalars(keys.scalars, &at, &mut frame);
        let solve = self.solve(keys.solve, &at, &mut frame, &own);
        let mut plots = self.plots(keys.plot, &at, &mut frame, outside.files);
        let (sweep, samples) = if outside.over.is_empty() {
            (own, samples)
        } else {
            retarget(&mut plots, &own, &over);
            let samples = outside.samples.filter(|_| over.iter().any(|sweep| sweep.values.are_drawn()));
            (over, samples)
        };
        let trace = self.trace(keys.trace, &at);
        let view = self.view(keys.view, &at);
        let forces = self.forces(keys.show, &at, &frame);
        let shown_at = self.shown_at(keys.at, &at, &mut frame);
        let first_expected = self.checks_so_far();
        let expect = self.expectations(keys.expect, &at, &mut frame);
        self.check_at_own_values(first_expected, outside.changes);
        let undefined = self.may_be_undefined(keys.undefined, &at, &mut frame, &columns, &plots);
        let before = self.faults.len();
        let values = self.evaluate(&all, &waiting);
        for fault in &mut self.faults[before..] {
            if fault.place.is_empty() {
                fault.place = format!("studies.{name}.set");
            }
        }
        // a study that changes parameters changes what the model's own checks find
        let from = if all.is_empty() && waiting.is_empty() { first_check } else { 0 };
        let before = self.faults.len();
        self.run_checks(&values, from);
        self.blame_over(before, outside);
        if from == 0 {
            // said so that the reader knows which study made it so
            for fault in &mut self.faults[before..] {
                if !fault.place.starts_with("studies.") && fault.help.is_none() {
                    fault.help = Some(format!("the parameters are those of study `{name}`"));
                }
            }
        }
        let checks = self.checks_from(first_check);
        let mut offered: Scalars = frame.features.results.iter().map(|(name, dimension)| (name.clone(), Some(*dimension))).collect();
        for (scalar, symbol) in &frame.local.symbols {
            if !offered.iter().any(|(name, _)| name == scalar) {
                offered.push(((*scalar).to_owned(), symbol.map(|(symbol, _)| symbol.dimension)));
            }
        }
        let functionals = frame.local.functionals.map(|f| f.all).unwrap_or_default();
        let study = kind.map(|kind| Study {
            name: name.to_owned(),
            about: keys.about.text().unwrap_or_default().to_owned(),
            kind,
            sweep,
            samples,
            solve,
            take,
            columns,
            undefined,
            columns_given,
            independent: frame.features.independent,
            scalars,
            results,
            functionals,
            plots,
            trace,
            view,
            shown_at,
            forces,
            expect,
            place: self.place(&at),
        });
        Decoded { study, set: all, scalars: offered, checks }
    }

    /// The rows of some kinds are their own.
    fn no_columns(&mut self, columns: Entry<'n>, kind: &str, at: &At<'_, 'n>) {
        if columns.given() {
            let message = format!("a study of the kind `{kind}` has no columns");
            let fault = self.fault("wrong-key", &at.key(columns), message, "no `columns`: its rows are the modes");
            fault.spot = Spot::Key;
            fault.help = Some("remove `columns`, or use `linearize`, whose columns are the outputs".to_owned());
        }
    }

    fn take(&mut self, take: Entry<'n>, at: &At<'_, 'n>, taken: &dyn Fn(&str) -> Taken, local: &mut Local<'n>) -> Vec<Take> {
        let section = at.key(take);
        let mut takes = Vec::new();
        for (name, value) in take.entries() {
            let here = section.key(name);
            self.free_name(name, &here, "a taken scalar");
            let Some(text) = value.text() else { continue };
            let mut symbol = None;
            let mut dimension = Dimension::NONE;
            if let Some((study, scalar)) = text.split_once('.') {
                match taken(study) {
                    Taken::Waiting => {}
                    Taken::Swept => {
                        let message = format!("`{}` is a sweep and has a list of values", clip(study));
                        self.fault("swept-study", &here, message, "a study of one run, or of a `solve`").help =
                            Some("take it from a study without `sweep`".to_owned());
                    }
                    Taken::NoStudy => {
                        let help = Some("write `STUDY.SCALAR` with a study of this file".to_owned());
                        self.fault("unknown-study", &here, format!("unknown study `{}`", clip(study)), "a study of this file").help = help;
                    }
                    Taken::Known(scalars) => match scalars.iter().find(|(known, _)| known == scalar) {
                        Some((_, Some(known))) => {
                            dimension = *known;
                            let id = self.name_space.input(&mut self.pool, Quantity::Taken(takes.len()));
                            symbol = Some((Symbol { id, dimension }, Needs::CONSTANT));
                        }
                        Some((_, None)) => {}
                        None => {
                            let known: Vec<&str> = scalars.iter().map(|(name, _)| name.as_str()).collect();
                            let list = suggest::known(known.iter().copied()).unwrap_or_else(|| "(there are none)".to_owned());
                            let near = suggest::nearest(scalar, known).map(|near| format!("did you mean `{study}.{near}`?"));
                            let message = format!("`{study}` has no scalar `{}`", clip(scalar));
                            self.fault("unknown-scalar", &here, message, format!("one of its scalars {list}")).help = near;
                        }
                    },
                }
                takes.push(Take { name: name.to_owned(), study: study.to_owned(), scalar: scalar.to_owned(), dimension, value: f64::NAN });
            } else {
                self.fault("wrong-type", &here, format!("found `{}`", clip(text)), "a scalar of another study, `STUDY.SCALAR`");
            }
            local.symbols.push((name, symbol));
        }
        takes
    }

    /// Refuses a local name that means something else in the model.
    pub(super) fn free_name(&mut self, name: &str, at: &At<'_, '_>, what: &str) {
        let why = match self.name_space.names.get(name) {
            Some(entity @ (Entity::Parameter(_) | Entity::State(_) | Entity::Measure(_) | Entity::Table(_))) => {
                Some(format!("the name of {}", entity.what()))
            }
            _ => crate::model::names::taken(name).map(str::to_owned),
        };
        if let Some(why) = why {
            let fault = self.fault("reserved-name", at, format!("`{name}` is {why}"), format!("another name for {what}"));
            fault.spot = Spot::Key;
            fault.help = Some(format!("for example `{name}_1`"));
        }
    }

    fn set(
        &mut self,
        set: Entry<'n>,
        at: &At<'_, 'n>,
        local: &mut Local<'n>,
        outside: &[(usize, Id)],
        waiting: &mut Vec<usize>,
    ) -> Vec<(usize, Id)> {
        let section = at.key(set);
        let mut values = Vec::new();
        for (name, value) in set.entries() {
            let here = section.key(name);
            let Some(i) = self.parameter_named(name, &here, true) else { continue };
            let Some(dimension) = self.name_space.parameters.get(i).copied().flatten() else { continue };
            let allow = Allow { tables: false, what: "`set`", ..Allow::PARAMETER };
            let Some((lowered, _)) = self.any(value, &here, allow, local) else { continue };
            if !self.fits(&lowered, Want::of(dimension), value, None, &here) || outside.iter().any(|(j, _)| *j == i) {
                continue;
            }
            if !self.pool.inputs_of(&[lowered.id]).is_empty() {
                waiting.push(i);
            }
            values.push((i, lowered.id));
        }
        values
    }

    /// A value for a parameter: it may use parameters and taken scalars.
    pub(super) fn setting(&mut self, node: Node<'n>, at: &At<'_, 'n>, want: Want, local: &mut Local<'n>) -> Option<Id> {
        let allow = Allow { what: "a value for a parameter", ..Allow::PARAMETER };
        let (lowered, _) = self.any(node, at, allow, local)?;
        if !self.fits(&lowered, want, node, None, at) {
            return None;
        }
        if self.pool.inputs_of(&[lowered.id]).is_empty() {
            self.check_once(Rule::Finite, &[lowered.id], at);
        }
        Some(lowered.id)
    }

    fn solve(&mut self, solve: Entry<'n>, at: &At<'_, 'n>, frame: &mut Frame<'n>, sweep: &[Sweep]) -> Option<Solve> {
        let keys = SolveKeys::of(solve.node?);
        let here = at.key(solve);
        let name = keys.vary.text()?;
        let vary_at = here.key(keys.vary);
        let parameter = self.parameter_named(name, &vary_at, false)?;
        if sweep.iter().any(|s| s.parameter == parameter) {
            self.fault("swept-and-solved", &vary_at, format!("`{name}` is swept too"), "another parameter");
        }
        let dimension = self.name_space.parameters.get(parameter).copied().flatten()?;
        let between_at = here.key(keys.between);
        let [from_node, to] = keys.between.items() else { return None };
        let from = self.before(Node::Plain(from_node), &between_at.index(0), Want::of(dimension), frame);
        let to = self.before(Node::Plain(to), &between_at.index(1), Want::of(dimension), frame);
        if let (Some(from), Some(to)) = (from, to)
            && self.pool.inputs_of(&[from, to]).is_empty()
        {
            self.check_once(Rule::Differ("bounds"), &[from, to], &between_at);
        }
        let target_at = here.key(keys.target);
        let targets = keys.target.entries();
        let [(scalar, value_node)] = targets[..] else {
            let message = format!("{} targets", targets.len());
            self.fault("wrong-size", &target_at, message, "one scalar and its value, `{ delta: 0.01 }`").spot = Spot::Key;
            return None;
        };
        let scalar_at = target_at.key(scalar);
        let of = match frame.scalar(scalar) {
            Some(dimension) => dimension,
            None => {
                self.unknown_scalar(scalar, &scalar_at, frame);
                return None;
            }
        };
        let value = self.before(value_node, &scalar_at, Want::of(of?), frame);
        let units = [unit_of(Node::Plain(from_node), dimension), unit_of(value_node, of?)];
        Some(Solve { parameter, between: [from?, to?], target: (scalar.to_owned(), value?), units })
    }

    /// A bound or target of `solve`, which is known before a run.
    fn before(&mut self, node: Node<'n>, at: &At<'_, 'n>, want: Want, frame: &mut Frame<'n>) -> Option<Id> {
        let id = self.setting(node, at, want, &mut frame.local)?;
        let taken = |input: &u32| matches!(self.name_space.model.inputs.get(*input as usize), Some(Quantity::Taken(_)));
        if self.pool.inputs_of(&[id]).iter().all(taken) {
            return Some(id);
        }
        self.fault("wrong-level", at, "a number that only a run gives", "an expression of parameters and taken scalars").help =
            Some("make a scalar of the difference, and let its target be 0".to_owned());
        None
    }

    pub(super) fn unknown_scalar(&mut self, name: &str, at: &At<'_, '_>, frame: &Frame<'_>) {
        let known = frame.known_scalars();
        let list = suggest::known(known.iter().copied()).unwrap_or_else(|| "(there are none)".to_owned());
        let near = suggest::nearest(name, known.iter().copied()).map(|near| format!("did you mean `{near}`?"));
        let fault = self.fault("unknown-scalar", at, format!("unknown scalar `{}`", clip(name)), format!("a scalar of this study: {list}"));
        fault.spot = Spot::Key;
        fault.help = near;
    }

    /// Local names and functionals for the scalars of a study.
    pub(super) fn open_functionals(frame: &mut Frame<'_>) {
        frame.local.functionals = Some(Functionals {
            all: Vec::new(),
            independent: frame.features.independent,
            reactions: frame.features.reactions,
            states: frame.features.states,
            kind: frame.word,
        });
    }
}

/// The unit in which a plain quantity of the file is written, with its size in SI.
fn unit_of(node: Node<'_>, dimension: Dimension) -> Option<(String, f64)> {
    let unit = node.text()?.trim().trim_start_matches(|c: char| c.is_ascii_digit() || "+-. ".contains(c));
    let (size, of) = crate::expression::parse_unit(unit)?;
    (of == dimension).then(|| (unit.to_owned(), size))
}

impl Frame<'_> {
    /// Dimension of a scalar or result by its name; the inner `None` where it is faulty.
    pub(super) fn scalar(&self, name: &str) -> Option<Option<Dimension>> {
        self.local
            .symbols
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, symbol)| symbol.map(|(s, _)| s.dimension))
            .or_else(|| self.features.results.iter().find(|(known, _)| known == name).map(|(_, dimension)| Some(*dimension)))
    }

    /// Names of all scalars and results.
    pub(super) fn known_scalars(&self) -> Vec<&str> {
        self.local.symbols.iter().map(|(name, _)| *name).chain(self.features.results.iter().map(|(name, _)| name.as_str())).collect()
    }
}
