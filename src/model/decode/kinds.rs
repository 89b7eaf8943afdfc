//! The kinds of studies: their keys, their independent variables and results.

use super::checks::Rule;
use super::studies::Offer;
use super::{Decoder, Origin};
use crate::expression::{Dimension, Id};
use crate::model::entities::LoadOn;
use crate::model::fault::{At, Spot};
use crate::model::fields::Want;
use crate::model::merge::Node;
use crate::model::names::Entity;
use crate::model::quantities::Coordinate;
use crate::model::scope::{Allow, Local};
use crate::model::shape::clip;
use crate::model::study::{Eigensolver, Kind, Modes, Over, Periodic, Range};
use crate::model::suggest;
use crate::model::tables::STUDY_KINDS;
use crate::model::vocabulary::Quantity;
use serde_yaml::Value;

/// Frequencies of a `modes` study that have a name: `frequency_1`, ...
const NAMED_MODES: usize = 12;

impl<'n> Decoder<'n> {
    pub(super) fn kind(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(Kind, Offer)> {
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
                Some((kind, Offer { word, independent: Some(independent), first, reactions, states: false, results }))
            }
            "balance" => self.balance(inner, &here),
            "dynamics" => {
                let (independent, results) = (Some(Dimension::TIME), Vec::new());
                let offer = Offer { word, independent, first: None, reactions: true, states: true, results };
                Some((Kind::Dynamics(self.forward(inner, &here)?), offer))
            }
            "periodic" => self.periodic(inner, &here),
            "statics" => {
                let results = vec![("stable".to_owned(), Dimension::NONE)];
                let independent = Some(Dimension::TIME);
                Some((Kind::Statics, Offer { word, independent, first: None, reactions: true, states: true, results }))
            }
            _ => {
                let methods = inner.get("methods").map(Node::items).unwrap_or_default();
                let mut solvers = Vec::new();
                for method in methods.iter().filter_map(Value::as_str) {
                    let solver = match method {
                        "jacobi" => Eigensolver::Jacobi,
                        "power" => Eigensolver::Power,
                        _ => Eigensolver::Library,
                    };
                    if !solvers.contains(&solver) {
                        solvers.push(solver);
                    }
                }
                let modes = Modes {
                    at_equilibrium: inner.get("at").and_then(Node::text) == Some("statics"),
                    damped: matches!(inner.get("damped"), Some(Node::Plain(Value::Bool(true)))),
                    methods: if solvers.is_empty() { vec![Eigensolver::Library] } else { solvers },
                };
                let results = (1..=NAMED_MODES).map(|i| (format!("frequency_{i}"), Dimension::NONE.div(Dimension::TIME))).collect();
                Some((Kind::Modes(modes), Offer { word, independent: None, first: None, reactions: true, states: true, results }))
            }
        }
    }

    /// `periodic: { over, by, of }`.
    fn periodic(&mut self, inner: Node<'n>, here: &At<'_, 'n>) -> Option<(Kind, Offer)> {
        let named = |decoder: &mut Self, key: &'n str| {
            let text = inner.get(key)?.text()?;
            let allow = Allow { what: "a periodic study", ..Allow::MEASURE };
            let (lowered, _) = decoder.lower(text, Origin::Value(text, 0), &here.key(key), allow, &mut Local::default())?;
            Some((text.to_owned(), lowered))
        };
        let (over, of) = (named(self, "over"), named(self, "of"));
        let (over, progress) = over?;
        let by = self.number(inner.get("by"), &here.key("by"), Want::Of(progress.dimension));
        self.check_key(Rule::NotZero("the period"), by, here, "by");
        let (of, quantity) = of?;
        let timed = over == "t" || over == "time";
        let word = of.replace('.', "_");
        let mut results = vec![("period".to_owned(), Dimension::TIME)];
        results.extend(["mean", "max", "min"].map(|which| (format!("{word}_{which}"), quantity.dimension)));
        results.push(("floquet".to_owned(), Dimension::NONE));
        let kind = Kind::Periodic(Periodic { over: (!timed).then_some(progress.id), by: by?, of: quantity.id });
        let first = (!timed).then_some(over);
        let independent = Some(progress.dimension);
        Some((kind, Offer { word: "periodic", independent, first, reactions: true, states: true, results }))
    }

    /// Loads by first-order states are known in motion in time alone.
    fn no_states_in_loads(&mut self, at: &At<'_, 'n>) {
        let model = &self.world.model;
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
        let [driver] = &self.world.model.drivers[..] else {
            let n = self.world.model.drivers.len();
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
        let coordinate: &'static Coordinate = self.world.single(joint)?;
        let dimension = coordinate.dimension(0);
        let want = if coordinate.angle { Want::Angle } else { Want::Of(dimension) };
        if lowered.expect(dimension).is_err() {
            let message = format!("found {}", lowered.dimension.name());
            self.fault("wrong-dimension", &over_at, message, format!("{} of the driver, or a time (s)", want.name()));
            return None;
        }
        self.fits(&lowered, want, over, None, &over_at);
        self.check(Rule::NotZero("the range"), &[lowered.id], &over_at);
        let path = format!("{}.{}", self.world.model.joints[joint].name, coordinate.names[0]);
        Some((Range { over: Over::Driver(lowered.id), samples }, dimension, Some(path)))
    }

    fn balance(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<(Kind, Offer)> {
        let move_at = at.key("move");
        let mut moved = Vec::new();
        let mut results: Vec<(String, Dimension)> = Vec::new();
        let mut sound = true;
        for (i, item) in node.get("move").map(Node::items).unwrap_or_default().iter().enumerate() {
            let here = move_at.index(i);
            let Some(text) = item.as_str() else { continue };
            let (body, mass) = text.split_once('.').unwrap_or((text, ""));
            let index = match self.world.names.get(body) {
                Some(Entity::Body(i)) => {
                    self.world.model.bodies.get(*i).map(|found| (*i, found.attached.iter().position(|a| a.name == mass)))
                }
                _ => None,
            };
            match index {
                Some((b, Some(a))) => {
                    let attached = &self.world.model.bodies[b].attached[a];
                    if attached.at == 0 {
                        let message = format!("`{text}` sits at the body's origin: there is no line to move it along");
                        self.fault("no-line", &here, message, "a mass at another point of its body");
                        sound = false;
                    } else if self.world.model.bodies[b].attached[a].mass.is_none() {
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
                    let known: Vec<String> =
                        self.world.model.bodies.iter().flat_map(|b| b.attached.iter().map(|a| format!("{}.{}", b.name, a.name))).collect();
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
            let offer = Offer { word: "balance", independent: Some(independent), first, reactions: false, states: false, results };
            (Kind::Balance { moved, range }, offer)
        })
    }
}

/// A whole number that the tables have checked.
pub(super) fn count(node: Node<'_>, key: &str) -> Option<usize> {
    match node.get(key)? {
        Node::Plain(Value::Number(n)) => usize::try_from(n.as_u64()?).ok(),
        _ => None,
    }
}
