//! The kinds of studies: their keys, their independent variables and results.

use super::decoder::{Decoder, Origin};
use super::features::{Features, count};
use crate::expression::{Dimension, Id, Lowered};
use crate::model::coordinates::Coordinate;
use crate::model::entities::LoadOn;
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::rules::Rule;
use crate::model::scope::{Allow, Local};
use crate::model::shape::clip;
use crate::model::study::{Chart, Continued, Eigensolver, Kind, Linearize, Modes, Over, PeriodEnd, Periodic, Progress, Range};
use crate::model::suggest;
use crate::model::tables::STUDY_KINDS;
use crate::model::vocabulary::{Known, Quantity};
use serde_yaml::Value;

/// Frequencies of a `modes` study that have a name: `frequency_1`, ...
const NAMED_MODES: usize = 12;

/// Intervals of the rows of a periodic regime, and steps of a continuation, that are silent.
const ROWS: usize = 360;
const STEPS: usize = 10;

impl<'n> Decoder<'n> {
    pub(super) fn kind(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(Kind, Features)> {
        let word = STUDY_KINDS.into_iter().find(|kind| node.get(kind).is_some())?;
        let inner = node.get(word)?;
        let here = at.key(word);
        match word {
            "kinematics" | "inverse" => {
                let (range, independent, first) = self.range(inner, &here)?;
                if word == "inverse" {
                    self.no_states_in_loads(&here);
                }
                let turns = vec![("turns_fully".to_owned(), Dimension::NONE)];
                let (kind, reactions, results) = match word {
                    "kinematics" => (Kind::Kinematics(range), false, turns),
                    _ => (Kind::Inverse(range), true, Vec::new()),
                };
                Some((kind, Features { word, independent: Some(independent), first, reactions, states: false, results }))
            }
            "balance" => self.balance(inner, &here),
            "dynamics" => {
                let (independent, results) = (Some(Dimension::TIME), Vec::new());
                let features = Features { word, independent, first: None, reactions: true, states: true, results };
                Some((Kind::Dynamics(self.forward(inner, &here)?), features))
            }
            "periodic" => self.periodic(inner, &here),
            "statics" => {
                let results = vec![("stable".to_owned(), Dimension::NONE)];
                let independent = Some(Dimension::TIME);
                Some((Kind::Statics, Features { word, independent, first: None, reactions: true, states: true, results }))
            }
            "linearize" => {
                let kind = Kind::Linearize(self.linearize(inner, &here)?);
                Some((kind, Features { word, independent: None, first: None, reactions: true, states: true, results: Vec::new() }))
            }
            _ => {
                self.no_columns(node, at);
                let results = (1..=NAMED_MODES).map(|i| (format!("frequency_{i}"), Dimension::ANGULAR_SPEED)).collect();
                let features = Features { word, independent: None, first: None, reactions: true, states: true, results };
                Some((Kind::Modes(modes(inner)), features))
            }
        }
    }

    /// `linearize: { at, inputs, write }`.
    fn linearize(&mut self, inner: Node<'n>, here: &At<'_, 'n>) -> Option<Linearize> {
        let section = here.key("inputs");
        let mut inputs = Vec::new();
        let named = inner.get("inputs").map(Node::items).unwrap_or_default();
        for (i, name) in named.iter().enumerate().filter_map(|(i, item)| Some((i, item.as_str()?))) {
            let place = section.index(i);
            let parameter = self.parameter_named(name, &place, false)?;
            if inputs.contains(&parameter) {
                let fault = self.fault("duplicate-name", &place, format!("`{name}` is an input already"), "each input once");
                fault.help = Some("remove one of the two".to_owned());
            }
            inputs.push(parameter);
        }
        let writes = |what: &str| inner.get("write").map(Node::items).unwrap_or_default().iter().any(|item| item.as_str() == Some(what));
        Some(Linearize { at_equilibrium: at_equilibrium(inner), inputs, csv: writes("csv"), mat: writes("mat") })
    }

    /// The table of a `modes` study is that of its modes.
    fn no_columns(&mut self, node: Node<'n>, at: &At<'_, 'n>) {
        if node.get("columns").is_some() {
            let message = "a study of the kind `modes` has no columns";
            let fault = self.fault("wrong-key", &at.key("columns"), message, "no `columns`: its rows are the modes");
            fault.spot = Spot::Key;
            fault.help = Some("remove `columns`, or use `linearize`, whose columns are the outputs".to_owned());
        }
    }

    /// `periodic: { over, by or through, of, ... }`.
    fn periodic(&mut self, inner: Node<'n>, here: &At<'_, 'n>) -> Option<(Kind, Features)> {
        let named = |decoder: &mut Self, key: &'n str, allow: Allow| {
            let text = inner.get(key)?.text()?;
            let (lowered, _) = decoder.lower(text, Origin::Value(text, 0), &here.key(key), allow, &mut Local::default())?;
            Some((text, lowered))
        };
        let study = Allow { what: "a periodic study", ..Allow::MEASURE };
        let over = named(self, "over", Allow { what: "`over`", level: Known::Position, ..study });
        let of = named(self, "of", study);
        let (tolerance, settle, from) = self.search(inner, here);
        let (over, progress) = over?;
        let timed = over == "t" || over == "time";
        let ends = self.period_end(inner, here, &progress, timed);
        let over_at = here.key("over");
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
            samples: count(inner, "samples").unwrap_or(ROWS),
            tolerance,
            settle,
            chart: if inner.get("coordinates").and_then(Node::text) == Some("cartesian") { Chart::Cartesian } else { Chart::Joint },
            from,
        });
        let first = (!timed).then(|| over.to_owned());
        let independent = Some(progress.dimension);
        Some((kind, Features { word: "periodic", independent, first, reactions: true, states: true, results }))
    }

    /// `by` or `through`.
    fn period_end(&mut self, inner: Node<'n>, here: &At<'_, 'n>, over: &Lowered, timed: bool) -> Option<PeriodEnd> {
        if let Some(node) = inner.get("by") {
            let by = self.number(Some(node), &here.key("by"), Want::Of(over.dimension))?;
            let rule = if timed { Rule::Positive("the period") } else { Rule::NotZero("the period") };
            self.check_key(rule, Some(by), here, "by");
            return Some(PeriodEnd::By(by));
        }
        let (node, at) = (inner.get("through")?, here.key("through"));
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
    fn search(&mut self, inner: Node<'n>, here: &At<'_, 'n>) -> (Option<Id>, Option<Id>, Option<Continued>) {
        let of = |decoder: &mut Self, key: &'n str, dimension: Dimension, rule: Rule| {
            let id = decoder.number(Some(inner.get(key)?), &here.key(key), Want::Of(dimension));
            decoder.check_key(rule, id, here, key);
            id
        };
        let tolerance = of(self, "tolerance", Dimension::NONE, Rule::Within(1e-14, 1e-4, "the tolerance"));
        let settle = of(self, "settle", Dimension::TIME, Rule::NotNegative("the time"));
        let from = inner.get("from").and_then(|node| {
            let at = here.key("from");
            let parameter = self.parameter_named(node.get("vary")?.text()?, &at.key("vary"), false)?;
            let dimension = self.name_space.parameters.get(parameter).copied().flatten()?;
            let begin = self.number(node.get("at"), &at.key("at"), Want::Of(dimension))?;
            Some(Continued { parameter, at: begin, steps: count(node, "steps").unwrap_or(STEPS) })
        });
        (tolerance, settle, from)
    }

    /// Loads by first-order states are known in motion in time alone.
    fn no_states_in_loads(&mut self, at: &At<'_, 'n>) {
        let model = &self.name_space.model;
        let state_in = |ids: &[Id]| {
            self.pool.inputs_of(ids).into_iter().find_map(|input| match model.inputs[input as usize] {
                Quantity::State(i) => Some(model.states[i].name.clone()),
                _ => None,
            })
        };
        let found = model.loads.iter().find_map(|load| {
            let state = match &load.on {
                LoadOn::Point { force, torque, .. } => state_in(&[&force[..], &torque[..]].concat()),
                LoadOn::Joint { effort, .. } => state_in(&[*effort]),
            };
            Some((load.name.clone(), state?))
        });
        if let Some((load, state)) = found {
            let message = format!("the load `{load}` needs the state `{state}`");
            let fault = self.fault("wrong-level", at, message, "`inverse` follows no states");
            fault.spot = Spot::Key;
            fault.help = Some("use `dynamics`, which computes motion in time, or remove the load in a variant".to_owned());
        }
    }

    /// `over` and `samples`: range, dimension of the independent variable, its path if it is not the time.
    fn range(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(Range, Dimension, Option<String>)> {
        let samples = count(node, "samples")?;
        let over_at = at.key("over");
        let over = node.get("over")?;
        let (lowered, _) = self.any(over, &over_at, Allow::CONSTANT, &mut Local::default())?;
        if lowered.dimension == Dimension::TIME {
            self.check(Rule::Positive("the time"), &[lowered.id], &over_at);
            return Some((Range { over: Over::Time(lowered.id), samples }, Dimension::TIME, None));
        }
        let [driver] = &self.name_space.model.drivers[..] else {
            let n = self.name_space.model.drivers.len();
            let drivers = self.section("drivers").len();
            // a faulty driver was reported already
            if drivers == n {
                let message = format!("the range of one driver, but the mechanism has {n} drivers");
                let help = if n == 0 { "add a driver, or give a time such as `2 s`" } else { "give a time such as `2 s`" };
                self.fault("no-driver", &over_at, message, "one driver, or a time").help = Some(help.to_owned());
            }
            return None;
        };
        let joint = driver.joint;
        let coordinate: &'static Coordinate = self.name_space.single(joint)?;
        let dimension = coordinate.dimension(0);
        let want = if coordinate.angle { Want::Angle } else { Want::Of(dimension) };
        if lowered.expect(dimension).is_err() {
            let message = format!("found {}", lowered.dimension.name());
            self.fault("wrong-dimension", &over_at, message, format!("{} of the driver, or a time (s)", want.name()));
            return None;
        }
        self.fits(&lowered, want, over, None, &over_at);
        self.check(Rule::NotZero("the range"), &[lowered.id], &over_at);
        let path = format!("{}.{}", self.name_space.model.joints[joint].name, coordinate.names[0]);
        Some((Range { over: Over::Driver(lowered.id), samples }, dimension, Some(path)))
    }

    fn balance(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(Kind, Features)> {
        let move_at = at.key("move");
        if !self.name_space.model.attractions.is_empty() {
            let message = "a balance in a field of gravity, where weights depend on the places that are looked for";
            self.fault("gravity-field", at, message, "gravity that is the same everywhere").spot = Spot::Key;
            return None;
        }
        let mut moved = Vec::new();
        let mut results: Vec<(String, Dimension)> = Vec::new();
        let mut sound = true;
        for (i, item) in node.get("move").map(Node::items).unwrap_or_default().iter().enumerate() {
            let here = move_at.index(i);
            let Some(text) = item.as_str() else { continue };
            let (body, mass) = text.split_once('.').unwrap_or((text, ""));
            let index = match self.name_space.names.get(body) {
                Some(Entity::Body(i)) => {
                    self.name_space.model.bodies.get(*i).map(|found| (*i, found.attached.iter().position(|a| a.name == mass)))
                }
                _ => None,
            };
            match index {
                Some((b, Some(a))) => {
                    let attached = &self.name_space.model.bodies[b].attached[a];
                    if attached.at == 0 {
                        let message = format!("`{text}` sits at the body's origin: there is no line to move it along");
                        self.fault("no-line", &here, message, "a mass at another point of its body");
                        sound = false;
                    } else if self.name_space.model.bodies[b].attached[a].mass.is_none() {
                        self.fault("no-mass", &here, format!("`{text}` has no mass"), "an attached point mass");
                        sound = false;
                    }
                    if results.iter().any(|(name, _)| name == mass) {
                        let message = format!("two moved masses are called `{mass}`");
                        self.fault("duplicate-name", &here, message, "different names: the results are called like the masses");
                    }
                    results.push((mass.to_owned(), Dimension::LENGTH));
                    moved.push((b, a));
                }
                other => {
                    sound = false;
                    let known: Vec<String> = self
                        .name_space
                        .model
                        .bodies
                        .iter()
                        .flat_map(|b| b.attached.iter().map(|a| format!("{}.{}", b.name, a.name)))
                        .collect();
                    let near = suggest::nearest(text, known.iter().map(String::as_str)).map(|near| format!("did you mean `{near}`?"));
                    let list = suggest::known(known.iter().map(String::as_str)).unwrap_or_else(|| "(there are none)".to_owned());
                    let message = match other {
                        Some(_) if mass.is_empty() => format!("`{body}` is a body"),
                        Some(_) => format!("`{body}` has no attached mass `{}`", clip(mass)),
                        None => format!("unknown body `{}`", clip(body)),
                    };
                    self.fault("unknown-mass", &here, message, format!("one of the attached masses {list}")).help = near;
                }
            }
        }
        results.push(("residual".to_owned(), Dimension::LENGTH));
        let (range, independent, first) = self.range(node, at)?;
        sound.then(|| {
            let features = Features { word: "balance", independent: Some(independent), first, reactions: false, states: false, results };
            (Kind::Balance { moved, range }, features)
        })
    }
}

/// `modes: { at, damped, methods }`.
fn modes(inner: Node<'_>) -> Modes {
    let mut methods = Vec::new();
    for method in inner.get("methods").map(Node::items).unwrap_or_default().iter().filter_map(Value::as_str) {
        let solver = match method {
            "jacobi" => Eigensolver::Jacobi,
            "power" => Eigensolver::Power,
            _ => Eigensolver::Library,
        };
        if !methods.contains(&solver) {
            methods.push(solver);
        }
    }
    Modes {
        at_equilibrium: at_equilibrium(inner),
        damped: matches!(inner.get("damped"), Some(Node::Plain(Value::Bool(true)))),
        methods: if methods.is_empty() { vec![Eigensolver::Library] } else { methods },
    }
}

/// `at: statics`.
fn at_equilibrium(inner: Node<'_>) -> bool {
    inner.get("at").and_then(Node::text) == Some("statics")
}
