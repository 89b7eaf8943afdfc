//! A model on its way from the file, and what all parts of the decoder do.

use crate::expression::{self, Dimension, Expr, ExternalFunction, Id, Lowered, Pool, SyntaxError};
use crate::model::diagnostics::Report;
use crate::model::entities::Dimensions;
use crate::model::fault::{At, Fault, Given, Spot};
use crate::model::fields::Want;
use crate::model::keys::Entry;
use crate::model::merge::{Layers, Node};
use crate::model::names::{self, Entity};
use crate::model::needs::Needs;
use crate::model::quantities::{NameSpace, Renumbered};
use crate::model::rules::{self, Rule};
use crate::model::scope::{Allow, Local, View};
use crate::model::spans::Step;
use crate::model::suggest::{self, clip};
use crate::model::whole::Model;
use serde_yaml::Value;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// A model on its way from the file.
pub(crate) struct Decoder<'n> {
    pub(super) layers: &'n Layers<'n>,
    pub(super) root: Node<'n>,
    pub(crate) pool: Pool,
    pub(crate) name_space: NameSpace<'n>,
    pub(crate) faults: Vec<Fault>,
    pub(super) checks: Vec<Check<'n>>,
    /// Expressions parsed so far: the same texts come again in every variant and study.
    pub(crate) parsed: Parsed,
}

/// A rule with its values and the steps to its place.
pub(crate) type Check<'n> = rules::Check<Vec<Step<'n>>>;

/// Syntax trees by their text.
pub(crate) type Parsed = HashMap<String, Rc<Expr>>;

/// Where the text of an expression comes from, so that a fault in it is shown at its own characters.
#[derive(Clone, Copy)]
pub(crate) enum Origin<'t> {
    /// A value of the file; the expression begins at a byte of it.
    Value(&'t str, usize),
    /// A key of the file.
    Key(&'t str),
    /// A text given from outside; the expression begins at a byte of it.
    Outside(&'t Given, usize),
}

impl Origin<'_> {
    pub(super) fn spot(self, at: std::ops::Range<usize>) -> Spot {
        match self {
            Self::Value(full, offset) => Spot::Within(full.to_owned(), at.start + offset..at.end + offset),
            Self::Key(full) => Spot::WithinKey(full.to_owned(), at),
            Self::Outside(given, offset) => given.spot(at.start + offset..at.end + offset),
        }
    }
}

impl<'n> Decoder<'n> {
    /// Decodes a merged model with all but its studies.
    pub(crate) fn new(layers: &'n Layers<'n>, root: Node<'n>, externals: &'n Arc<[ExternalFunction]>, parsed: Parsed) -> Self {
        let text = |key: &str| root.get(key).and_then(Node::text).unwrap_or_default().to_owned();
        let space = if root.get("space").and_then(Node::text) == Some("spatial") { Dimensions::Spatial } else { Dimensions::Planar };
        let mut faults = Vec::new();
        let (names, listed) = names::collect(root, layers, externals, &mut faults);
        let model = Model {
            name: text("name"),
            about: text("about"),
            space,
            units: Vec::new(),
            pool: Pool::new(),
            inputs: Vec::new(),
            parameters: Vec::new(),
            tables: Vec::new(),
            gravity: Vec::new(),
            attractions: Vec::new(),
            bodies: Vec::new(),
            joints: Vec::new(),
            couplings: Vec::new(),
            drivers: Vec::new(),
            loads: Vec::new(),
            springs: Vec::new(),
            motors: Vec::new(),
            clutches: Vec::new(),
            states: Vec::new(),
            measures: Vec::new(),
            events: Vec::new(),
            start: Vec::new(),
            study: None,
            variants: layers.patches.iter().map(|(name, _)| (*name).to_owned()).collect(),
            set: Vec::new(),
            warnings: Report::default(),
            checks: Vec::new(),
        };
        let name_space = NameSpace {
            model,
            names,
            listed,
            removed: names::removed(layers),
            parameters: Vec::new(),
            tables: Vec::new(),
            states: Vec::new(),
            rates: Vec::new(),
            measures: Vec::new(),
            stretches: Vec::new(),
            renumbered: Renumbered::default(),
            input_of: HashMap::new(),
        };
        let pool = Pool::with_externals(Arc::clone(externals));
        let mut decoder = Self { layers, root, pool, name_space, faults, checks: Vec::new(), parsed };
        decoder.display_units();
        decoder.parameters();
        decoder.tables();
        decoder.bodies();
        decoder.gravity();
        decoder.joints();
        // drivers and motors need no measure, measures may need them
        decoder.drivers();
        decoder.motors();
        decoder.springs_by_name();
        decoder.clutches_by_name();
        decoder.couplings();
        decoder.states_by_name();
        decoder.measures();
        decoder.springs();
        decoder.loads();
        decoder.clutches();
        decoder.start();
        decoder.events();
        decoder
    }

    /// Entries of a section, with their places.
    pub(super) fn section(&self, key: &str) -> Vec<(&'n str, Node<'n>)> {
        self.root.get(key).map(Node::entries).unwrap_or_default()
    }

    pub(super) fn place(&self, at: &At<'_, '_>) -> String {
        self.layers.source(&at.steps())
    }

    pub(super) fn fault(
        &mut self,
        code: &'static str,
        at: &At<'_, '_>,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) -> &mut Fault {
        let place = self.place(at);
        self.faults.push(Fault::new(code, place, message, expected));
        let last = self.faults.len() - 1;
        &mut self.faults[last]
    }

    pub(super) fn check(&mut self, rule: Rule, ids: &[Id], at: &At<'_, 'n>) {
        self.register(rule, ids, at, false);
    }

    /// A check of values that are taken before a study varies parameters.
    pub(super) fn check_once(&mut self, rule: Rule, ids: &[Id], at: &At<'_, 'n>) {
        self.register(rule, ids, at, true);
    }

    /// Keeps a check, but for one that constants pass: they pass it with all parameters.
    fn register(&mut self, rule: Rule, ids: &[Id], at: &At<'_, 'n>, once: bool) {
        let mut numbers = [0.0; 6];
        let mut constants = ids.iter().map_while(|&id| self.pool.constant_value(id));
        let count = numbers.iter_mut().zip(&mut constants).map(|(number, x)| *number = x).count();
        if count < ids.len() || !rule.allows(&numbers[..count]) {
            self.checks.push(Check { rule, ids: ids.to_vec(), place: at.steps(), once });
        }
    }

    /// The syntax tree of a text.
    pub(super) fn parse(&mut self, text: &str) -> Result<Rc<Expr>, SyntaxError> {
        if let Some(expr) = self.parsed.get(text) {
            return Ok(Rc::clone(expr));
        }
        let expr = Rc::new(expression::parse(text)?);
        self.parsed.insert(text.to_owned(), Rc::clone(&expr));
        Ok(expr)
    }

    /// Parses and lowers a text; faults are shown inside of it.
    pub(super) fn lower(
        &mut self,
        text: &str,
        origin: Origin<'_>,
        at: &At<'_, '_>,
        allow: Allow,
        local: &mut Local<'_>,
    ) -> Option<(Lowered, Needs)> {
        match self.parse(text) {
            Ok(expr) => self.lower_parsed(&expr, text, origin, at, allow, local),
            Err(error) => {
                let place = self.place(at);
                let fault = Fault::new("expression", place, format!("found {}", error.found), error.expected);
                self.faults.push(fault.maybe_help(error.help).at(origin.spot(error.at)));
                None
            }
        }
    }

    pub(super) fn lower_parsed(
        &mut self,
        expr: &Expr,
        text: &str,
        origin: Origin<'_>,
        at: &At<'_, '_>,
        allow: Allow,
        local: &mut Local<'_>,
    ) -> Option<(Lowered, Needs)> {
        let mut view = View {
            name_space: &mut self.name_space,
            local,
            allow,
            reach: Needs::CONSTANT,
            codes: Vec::new(),
            refused_call: None,
            outside: None,
        };
        let result = expression::lower(&mut self.pool, expr, text, &mut view);
        let (reach, codes, refused_call) = (view.reach, view.codes, view.refused_call);
        match result {
            Ok(lowered) => {
                // `rate` raises the level of what it is taken of
                let forbidden = reach.level > allow.level || reach.reactions && !allow.reactions;
                if forbidden && reach.level < crate::model::vocabulary::Known::Study {
                    let words = if reach.level == crate::model::vocabulary::Known::Acceleration { "an acceleration" } else { "a velocity" };
                    let place = self.place(at);
                    let fault = Fault::new("wrong-level", place, format!("this rate is {words}"), format!("{} may not use it", allow.what))
                        .help(allow.instead());
                    self.faults.push(fault.at(origin.spot(0..text.len())));
                    return None;
                }
                Some((lowered, reach))
            }
            Err(faults) => {
                let place = self.place(at);
                for fault in faults.into_iter().filter(|fault| !fault.found.is_empty()) {
                    let code = codes.iter().find(|(found, _)| *found == fault.found).map(|(_, code)| *code);
                    let refused = refused_call.filter(|_| fault.expected == expression::CALLED);
                    let made = if let Some(refused) = refused {
                        Fault::new(
                            "wrong-level",
                            place.clone(),
                            format!("found {}", fault.found),
                            format!("{} may not call {refused}", allow.what),
                        )
                    } else {
                        // what the scope refused is a sentence, what lowering refused a thing
                        let message = if code.is_some() { fault.found } else { format!("found {}", fault.found) };
                        let form =
                            ["`", "a function", "a quantity whose", "a constant"].iter().any(|start| fault.expected.starts_with(start));
                        let code = code.unwrap_or(if form { "expression" } else { "wrong-dimension" });
                        let slice = text.get(fault.at.clone()).unwrap_or_default();
                        let help = fault.help.or_else(|| {
                            let wanted = fault.wanted?;
                            self.unit_missing(slice, wanted).or_else(|| self.parameters_in(slice))
                        });
                        let mut made = Fault::new(code, place.clone(), message, fault.expected).maybe_help(help);
                        made.otherwise = fault.wanted.map(|wanted| suggest::in_unit(slice, Want::Of(wanted)));
                        made
                    };
                    self.faults.push(made.at(origin.spot(fault.at)));
                }
                None
            }
        }
    }

    /// A number, a quantity or an expression of any dimension.
    pub(super) fn any(&mut self, node: Node<'_>, at: &At<'_, '_>, allow: Allow, local: &mut Local<'_>) -> Option<(Lowered, Needs)> {
        match node {
            Node::Plain(Value::Number(n)) => {
                let x = n.as_f64().filter(|x| x.is_finite())?;
                let id = self.pool.constant(x);
                let lowered = Lowered { id, dimension: Dimension::NONE, any: x == 0.0, bare: true, boolean: false };
                Some((lowered, Needs::CONSTANT))
            }
            Node::Plain(Value::String(text)) => self.lower(text, Origin::Value(text, 0), at, allow, local),
            _ => None,
        }
    }

    /// Whether a value fits what is wanted; the fault is reported.
    pub(super) fn fits(&mut self, lowered: &Lowered, want: Want, node: Node<'_>, origin: Option<Origin<'_>>, at: &At<'_, '_>) -> bool {
        let dimension = match want {
            Want::Of(dimension) => dimension,
            Want::Angle => Dimension::ANGLE,
            Want::Varies(_) | Want::Any => return true,
        };
        if let Err(found) = lowered.expect(dimension) {
            let place = self.place(at);
            let text = node.text().unwrap_or_default();
            let mut fault = Fault::new("wrong-dimension", place, format!("found {found}"), want.name());
            if let Some(help) = self.unit_missing(text, dimension).or_else(|| expression::meant_fraction(text)) {
                fault.help = Some(help);
            } else if lowered.dimension.is_per_angle() {
                fault.help = Some(expression::angle_instead(text));
            } else if lowered.dimension == Dimension::NONE {
                fault.help = Some(format!("give it a unit: {}", dimension.si()));
            } else {
                fault.help = self.unit_or_name(text).or_else(|| self.parameters_in(text));
                fault.otherwise = Some(suggest::in_unit(text, want));
            }
            if let Some(origin) = origin {
                fault.spot = origin.spot(0..text.len());
            }
            self.faults.push(fault);
            return false;
        }
        let turns = |x: Option<f64>| x.filter(|x| want == Want::Angle && x.abs() > std::f64::consts::TAU);
        if let Node::Plain(Value::String(name)) = node
            && let Some(number) = turns(self.bare_parameter(name.trim_start_matches('~').trim()).and_then(|text| text.parse().ok()))
        {
            let (place, name) = (self.place(at), name.trim_start_matches('~').trim());
            self.faults.push(
                Fault::new("bare-angle", place, format!("`{name}` is {number} rad, more than a turn"), "an angle in rad, or with its unit")
                    .help(format!("if degrees are meant, write `{name}: {number} deg` in `parameters`"))
                    .warn(),
            );
        }
        if lowered.bare && turns(self.pool.constant_value(lowered.id)).is_some() {
            let place = self.place(at);
            let text = match node {
                Node::Plain(Value::Number(n)) => n.to_string(),
                _ => clip(node.text().unwrap_or_default()),
            };
            self.faults.push(
                Fault::new("bare-angle", place, format!("{text} rad is more than a turn"), "an angle in rad, or with its unit")
                    .help(format!("if degrees are meant, write `{} deg`", text.trim_start_matches('~')))
                    .warn(),
            );
        }
        true
    }

    /// What to write for a name that became a unit, since it stands directly behind a number.
    pub(super) fn unit_or_name(&self, text: &str) -> Option<String> {
        let (number, word) = text.trim().split_once(' ')?;
        let named = matches!(self.name_space.names.get(word), Some(Entity::Parameter(_)));
        let unit = named && number.parse::<f64>().is_ok() && expression::parse_unit(word).is_some();
        unit.then(|| format!("`{word}` directly after a number is the unit; for the parameter write `{number}*{word}`"))
    }

    /// The value of a parameter that is a plain number without a unit, as it is written.
    fn bare_parameter(&self, name: &str) -> Option<String> {
        let Some(Entity::Parameter(i)) = self.name_space.names.get(name).copied() else { return None };
        match self.section("parameters").get(i)?.1 {
            Node::Plain(Value::Number(n)) => Some(n.to_string()),
            Node::Plain(Value::String(text)) if text.trim().parse::<f64>().is_ok() => Some(text.trim().to_owned()),
            _ => None,
        }
    }

    /// Where a unit is missing: at the definition of the parameter that a text names, if that is a plain number.
    pub(super) fn unit_missing(&self, text: &str, wanted: Dimension) -> Option<String> {
        let value = self.bare_parameter(text.trim())?;
        let written = wanted.written(&value);
        (written != value)
            .then(|| format!("`{0}` is given as a plain number: write `{0}: {written}`, or another unit, in `parameters`", text.trim()))
    }

    /// The units of the parameters that a text is made of, whose dimension is not what was meant; of a single one how it is set.
    pub(super) fn parameters_in(&self, text: &str) -> Option<String> {
        let mut told: Vec<(&str, usize, String)> = Vec::new();
        for name in text.split(|c: char| !(c.is_alphanumeric() || "_.".contains(c))) {
            let Some(Entity::Parameter(i)) = self.name_space.names.get(name).copied() else {
                // other quantities may be to blame as well
                let other = self.name_space.names.contains_key(name) || name.starts_with(char::is_alphabetic) && name.contains('.');
                if other { return None } else { continue }
            };
            let Some(Some(dimension)) = self.name_space.parameters.get(i) else { continue };
            if told.iter().all(|(_, known, _)| *known != i) {
                told.push((name, i, dimension.si()));
            }
        }
        let unit = |si: &str| if si.is_empty() { "without a unit".to_owned() } else { format!("in {si}") };
        if let [(name, i, si)] = &told[..]
            && let Some(set) = self.section("parameters").get(*i).and_then(|(_, node)| node.text())
        {
            return Some(format!("`{name}` is {} by `{name}: {}` in `parameters`", unit(si), clip(set)));
        }
        let all: Vec<String> = told.iter().map(|(name, _, si)| format!("`{name}` is {}", unit(si))).collect();
        (!all.is_empty()).then(|| format!("by `parameters` {}", all.join(", ")))
    }

    /// A value of a wanted dimension that may use what `allow` says.
    pub(super) fn value(&mut self, node: Option<Node<'_>>, at: &At<'_, '_>, want: Want, allow: Allow) -> Option<(Id, Needs)> {
        let node = node?;
        let (lowered, reach) = self.any(node, at, allow, &mut Local::default())?;
        self.fits(&lowered, want, node, None, at).then_some((lowered.id, reach))
    }

    /// A value of parameters that must be finite.
    pub(super) fn number(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, want: Want) -> Option<Id> {
        let (id, _) = self.value(node, at, want, Allow::CONSTANT)?;
        self.check(Rule::Finite, &[id], at);
        Some(id)
    }

    /// The number of an entry, of what was declared for it.
    pub(super) fn read(&mut self, entry: Entry<'n>, at: &At<'_, 'n>) -> Option<Id> {
        self.read_as(entry, at, entry.want())
    }

    /// The number of an entry whose dimension depends on its neighbours.
    pub(super) fn read_of(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, dimension: Dimension) -> Option<Id> {
        self.read_as(entry, at, Want::Of(dimension))
    }

    /// The same, where it may be an angle.
    pub(super) fn read_as(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, want: Want) -> Option<Id> {
        self.number(entry.node, &at.key(entry), want)
    }

    /// A value of parameters that may not be negative; the words say what it is.
    pub(super) fn size(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, what: &'static str) -> Option<Id> {
        self.size_as(entry.node, &at.key(entry), entry.want(), what)
    }

    /// The same at any place.
    pub(super) fn size_as(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, want: Want, what: &'static str) -> Option<Id> {
        let (id, _) = self.value(node, at, want, Allow::CONSTANT)?;
        self.check(Rule::NotNegative(what), &[id], at);
        Some(id)
    }

    /// A vector of an entry, with as many components as the space has.
    pub(super) fn read_vector(&mut self, entry: Entry<'n>, at: &At<'_, 'n>, dimension: Dimension) -> Option<Vec<Id>> {
        self.space_vector(entry.node, &at.key(entry), dimension)
    }

    /// A list of values of parameters.
    pub(super) fn vector(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, want: Dimension) -> Option<Vec<Id>> {
        let items = node.filter(|node| node.is_list())?.items();
        let mut ids = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            ids.push(self.number(Some(Node::Plain(item)), &at.index(i), Want::Of(want)));
        }
        ids.into_iter().collect()
    }

    /// A vector with as many components as the space has.
    pub(super) fn space_vector(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>, want: Dimension) -> Option<Vec<Id>> {
        let components = self.name_space.components();
        self.vector(node, at, want).filter(|ids| ids.len() == components)
    }

    /// A direction: a vector that is not zero.
    pub(super) fn direction(&mut self, node: Option<Node<'n>>, at: &At<'_, 'n>) -> Option<Vec<Id>> {
        let ids = self.space_vector(node, at, Dimension::NONE)?;
        self.check(Rule::Direction, &ids, at);
        Some(ids)
    }

    /// The finished model, with the checks of its study beside its own.
    pub(crate) fn into_model(self, of_study: &[Check<'n>]) -> Model {
        let mut checks = self.kept_checks(&self.checks);
        checks.extend(self.kept_checks(of_study));
        let mut model = self.name_space.model;
        model.checks = checks;
        model.pool = self.pool;
        model.release_spare_room();
        model
    }
}
