//! What a name in an expression stands for, and whether it may stand there.

use super::names::Entity;
use super::needs::Needs;
use super::quantities::{NameSpace, silent, unknown};
use super::suggest;
use super::vocabulary::{Known, Quantity};
use crate::expression::{Dimension, Id, Lowered, Pool, Scope, Symbol, Unknown};

/// What may be named in a field.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allow {
    /// Highest level.
    pub(crate) level: Known,
    /// Whether tables and external functions may be called.
    pub(crate) tables: bool,
    /// Whether reactions may be named.
    pub(crate) reactions: bool,
    /// Whether quantities of springs may be named.
    pub(crate) springs: bool,
    /// Whether first-order states may be named, where velocities may be.
    pub(crate) states: bool,
    /// The field, for messages: `a load`.
    pub(crate) what: &'static str,
}

impl Allow {
    /// What stands for a quantity that is not known yet.
    pub(crate) fn instead(&self) -> String {
        match self.level {
            Known::Constant => "write a number or a quantity, or a parameter from `parameters`",
            Known::Time if self.what == Self::DRIVER.what => {
                "write it as a function of `t`; one joint follows another by a coupling (`couplings`)"
            }
            Known::Time => "write it as a function of `t`; forces that depend on the motion are `loads`",
            Known::Position => "write it by positions alone: angles, places, stretches",
            Known::Velocity => "write it by positions and velocities",
            Known::Acceleration | Known::Study => "take it in `scalars`, or from another study by `take`",
        }
        .to_owned()
    }

    /// Parameters only.
    pub(crate) const PARAMETER: Self =
        Self { level: Known::Constant, tables: false, reactions: false, springs: false, states: true, what: "a parameter" };
    /// Parameters and tables.
    pub(crate) const CONSTANT: Self = Self { tables: true, what: "this value", ..Self::PARAMETER };
    /// `t`, parameters and tables.
    pub(crate) const DRIVER: Self = Self { level: Known::Time, what: "a driver", ..Self::CONSTANT };
    /// Positions, without those of springs.
    pub(crate) const POSITION: Self = Self { level: Known::Position, what: "this expression", ..Self::CONSTANT };
    /// Positions and velocities.
    pub(crate) const LOAD: Self = Self { level: Known::Velocity, springs: true, what: "a load", ..Self::CONSTANT };
    /// Everything that a state has.
    pub(crate) const MEASURE: Self =
        Self { level: Known::Acceleration, reactions: true, springs: true, what: "a measure", ..Self::CONSTANT };
}

/// Names that only one study knows.
#[derive(Default)]
pub(crate) struct Local<'s> {
    /// Name, node, reach; `None` for one whose own fault was reported.
    pub(crate) symbols: Vec<(&'s str, Option<(Symbol, Needs)>)>,
    /// Functionals of the study so far; `None` where none are allowed.
    pub(crate) functionals: Option<Functionals>,
}

/// Functionals over a study.
#[derive(Default)]
pub(crate) struct Functionals {
    /// Those found so far.
    pub(crate) all: Vec<super::study::Functional>,
    /// Dimension of the independent variable; `None` if the study has none.
    pub(crate) independent: Option<Dimension>,
    /// Whether the study finds reactions.
    pub(crate) reactions: bool,
    /// Whether the study follows first-order states.
    pub(crate) states: bool,
    /// The study's kind, for messages.
    pub(crate) kind: &'static str,
}

/// The names as one field sees them.
pub(crate) struct View<'v, 'a, 's> {
    pub(crate) name_space: &'v mut NameSpace<'a>,
    pub(crate) local: &'v mut Local<'s>,
    pub(crate) allow: Allow,
    /// What the expression needs, so far.
    pub(crate) reach: Needs,
    /// Codes of the refusals, found again by their text.
    pub(crate) codes: Vec<(String, &'static str)>,
    /// A table was called where none may be.
    pub(crate) refused_call: Option<&'static str>,
    /// What is allowed and was needed outside of the functional that is being lowered.
    pub(crate) outside: Option<(Allow, Needs)>,
}

impl View<'_, '_, '_> {
    fn refuse(&mut self, code: &'static str, why: Unknown) -> Unknown {
        self.codes.push((why.found.clone(), code));
        why
    }

    /// Whether a path begins with something that has a name, but is not decoded yet.
    fn undecoded(&self, path: &str) -> bool {
        let (renumbered, head) = (&self.name_space.renumbered, path.split('.').next().unwrap_or(path));
        match self.name_space.names.get(head) {
            Some(Entity::Driver(i)) => *i >= renumbered.drivers.len(),
            Some(Entity::Coupling(i)) => *i >= renumbered.couplings.len(),
            Some(Entity::Motor(i)) => *i >= renumbered.motors.len(),
            Some(Entity::Clutch(i)) => *i >= renumbered.clutches.len(),
            Some(Entity::Spring(i)) => *i >= renumbered.springs.len(),
            Some(Entity::State(i)) => *i >= self.name_space.states.len(),
            _ => false,
        }
    }

    /// Whether what is read is a scalar, outside of its functionals.
    fn in_scalar(&self) -> bool {
        self.local.functionals.is_some() && self.outside.is_none()
    }

    /// A constant, unless it is a scalar's and an event changes it during the study.
    fn admit_constant(&mut self, pool: &Pool, path: &str, symbol: Symbol) -> Result<Symbol, Unknown> {
        if !self.in_scalar() || !self.local.functionals.as_ref().is_some_and(|of| of.states) {
            return Ok(symbol);
        }
        let used: Vec<usize> = pool.parameters_of(&[symbol.id]).into_iter().map(|parameter| parameter as usize).collect();
        let Some(event) = self.name_space.model.event_that_sets(&used) else { return Ok(symbol) };
        let found = format!("`{path}` changes during the study, by the event `{}`", event.name);
        let help = Some(format!("take one number of it: `last({path})`, `max({path})`, or `value({path}, 0 s)` at the start"));
        Err(self.refuse("varies", unknown(found, "one number for the whole study", help)))
    }

    fn admit(&mut self, path: &str, (symbol, reach): (Symbol, Needs)) -> Result<Symbol, Unknown> {
        let allow = self.allow;
        let in_scalar = self.in_scalar();
        if reach.level > allow.level {
            let is = match reach.level {
                Known::Constant | Known::Time => format!("`{path}` varies in time"),
                Known::Position => format!("`{path}` is a position"),
                Known::Velocity if reach.states => format!("`{path}` is a first-order state, or needs one"),
                Known::Velocity => format!("`{path}` is a velocity, or needs one"),
                Known::Acceleration if reach.reactions => format!("`{path}` is a reaction, or needs one"),
                Known::Acceleration => format!("`{path}` is an acceleration, or needs one"),
                Known::Study => format!("`{path}` is known only after the study"),
            };
            if in_scalar && reach.level < Known::Study {
                let help = Some(format!("take one number of it: `mean({path})`, `max({path})`, `last({path})`, `value({path}, at)`"));
                return Err(
                    self.refuse("varies", unknown(format!("`{path}` varies during the study"), "one number for the whole study", help))
                );
            }
            let may = match allow.level {
                Known::Constant => "parameters",
                Known::Time => "`t` and parameters",
                Known::Position => "positions, `t` and parameters",
                Known::Velocity => "positions, velocities, `t` and parameters",
                _ => "quantities of the mechanism, `t` and parameters",
            };
            let what = allow.what;
            let by_friction = reach.reactions && allow.level == Known::Velocity;
            let help = if by_friction { "reactions enter forces through joint `friction` alone".to_owned() } else { allow.instead() };
            return Err(self.refuse("wrong-level", unknown(is, format!("{what} may use only {may}"), Some(help))));
        }
        if reach.reactions && !allow.reactions {
            let help = Some("use `inverse`, which finds forces too".to_owned());
            return Err(self.refuse(
                "wrong-level",
                unknown(format!("`{path}` is a reaction, or needs one"), format!("{} finds no forces", allow.what), help),
            ));
        }
        if reach.states && !allow.states {
            let help = Some("use `dynamics`, which computes motion in time".to_owned());
            return Err(self.refuse(
                "wrong-level",
                unknown(format!("`{path}` is a first-order state, or needs one"), format!("{} follows no states", allow.what), help),
            ));
        }
        if reach.springs && !allow.springs {
            let expected = format!("{} may not use springs or their energy, which depend on it", allow.what);
            return Err(self.refuse("wrong-level", unknown(format!("`{path}` needs the springs"), expected, Some(allow.instead()))));
        }
        self.reach = self.reach.join(reach);
        Ok(symbol)
    }
}

impl Scope for View<'_, '_, '_> {
    fn name(&mut self, pool: &mut Pool, path: &str) -> Result<Symbol, Unknown> {
        if let Some((_, symbol)) = self.local.symbols.iter().find(|(name, _)| *name == path) {
            return match *symbol {
                Some(symbol) => self.admit(path, symbol),
                None => Err(silent()),
            };
        }
        match self.name_space.names.get(path).copied() {
            Some(Entity::Parameter(i)) => {
                return match self.name_space.parameters.get(i).copied().flatten() {
                    Some(dimension) => {
                        let symbol = Symbol { id: pool.parameter(i as u32), dimension };
                        self.admit_constant(pool, path, symbol)
                    }
                    None => Err(silent()),
                };
            }
            Some(Entity::Measure(i)) => {
                return match self.name_space.measures.get(i).copied().flatten() {
                    Some(measure) => {
                        let symbol = self.admit(path, measure)?;
                        self.admit_constant(pool, path, symbol)
                    }
                    // before the measures are lowered only parameters may be named
                    None if self.allow.level <= Known::Time => {
                        let may = if self.allow.level == Known::Time { "`t` and parameters" } else { "parameters" };
                        let expected = format!("{} may use only {may}", self.allow.what);
                        Err(self.refuse("wrong-level", unknown(format!("`{path}` is a measure"), expected, Some(self.allow.instead()))))
                    }
                    None => Err(silent()),
                };
            }
            Some(Entity::Table(_)) => {
                let help = Some(format!("write `{path}(x)`"));
                return Err(self.refuse("unknown-name", unknown(format!("`{path}` is a table"), "a quantity", help)));
            }
            _ => {}
        }
        // inside of a parameter nothing of the mechanism is known yet
        if self.allow.level == Known::Constant && self.local.functionals.is_none() && self.name_space.known_head(path) {
            let expected = format!("{} may use only parameters", self.allow.what);
            return Err(self.refuse("wrong-level", unknown(format!("`{path}` is no parameter"), expected, Some(self.allow.instead()))));
        }
        // what is decoded after the drivers is no function of time
        if self.allow.level <= Known::Time && self.undecoded(path) {
            let expected = format!("{} may use only `t` and parameters", self.allow.what);
            return Err(self
                .refuse("wrong-level", unknown(format!("`{path}` is known only with the motion"), expected, Some(self.allow.instead()))));
        }
        match self.name_space.quantity(pool, path) {
            Ok(found) => {
                let found = self.name_space.symbol(pool, found);
                self.admit(path, found)
            }
            Err(mut why) => {
                if why.help.is_none() && !path.contains('.') && why.found.starts_with("unknown name") {
                    let local = self.local.symbols.iter().map(|(name, _)| *name);
                    why.help = suggest::nearest(path, local).map(|near| format!("did you mean `{near}`?"));
                }
                Err(self.refuse("unknown-name", why))
            }
        }
    }

    fn has_value(&self, word: &str) -> bool {
        matches!(self.name_space.names.get(word), Some(Entity::Parameter(_) | Entity::State(_) | Entity::Measure(_)))
            || self.local.symbols.iter().any(|(name, _)| *name == word)
    }

    fn table(&mut self, name: &str) -> Option<(u32, Dimension, Dimension)> {
        let Some(Entity::Table(i)) = self.name_space.names.get(name).copied() else { return None };
        if !self.allow.tables {
            self.refused_call = Some("a table");
            return None;
        }
        let (x, y) = self.name_space.tables.get(i).copied().flatten().unwrap_or((Dimension::NONE, Dimension::NONE));
        Some((i as u32, x, y))
    }

    fn external(&mut self, name: &str) -> Option<u32> {
        let Some(Entity::External(i)) = self.name_space.names.get(name).copied() else { return None };
        if !self.allow.tables {
            self.refused_call = Some("a function from outside");
            return None;
        }
        Some(i as u32)
    }

    fn rate(&mut self, pool: &mut Pool, input: u32) -> Option<Id> {
        let quantity = *self.name_space.model.inputs.get(input as usize)?;
        if quantity == Quantity::Time {
            return Some(pool.constant(1.0));
        }
        if let Quantity::State(i) = quantity {
            // of one whose own fault was reported anything will do
            let (rate, reach) = self.name_space.rates.get(i).copied().flatten().unwrap_or((pool.constant(0.0), Needs::CONSTANT));
            self.reach = self.reach.join(reach);
            return Some(rate);
        }
        let rate = quantity.rate()?;
        self.reach = self.reach.join(Needs::of(rate));
        Some(self.name_space.input(pool, rate))
    }

    fn enter_functional(&mut self, name: &str) -> Result<(), Unknown> {
        let Some(functionals) = &self.local.functionals else {
            let help = Some(match name {
                "max" | "min" => format!("`{name}(a, b)` of two values needs two"),
                _ => format!("write `{name}(..)` in `scalars` of a study; another study has it by `take`"),
            });
            let why = unknown(
                format!("`{name}(..)` is taken of a whole study"),
                "it can be used only in `scalars`, and in `expect` on the left of the colon",
                help,
            );
            return Err(self.refuse("wrong-level", why));
        };
        if self.outside.is_some() {
            return Err(self.refuse("wrong-level", unknown(format!("`{name}(..)` inside of another"), "an expression of the moment", None)));
        }
        if functionals.independent.is_none() {
            let expected = "a study with an independent variable: `kinematics`, `inverse`, `dynamics`, `periodic`";
            let found = format!("`{name}(..)` in a `{}` study", functionals.kind);
            return Err(self.refuse("wrong-level", unknown(found, expected, None)));
        }
        let inside = Allow { reactions: functionals.reactions, states: functionals.states, what: functionals.kind, ..Allow::MEASURE };
        self.outside = Some((self.allow, self.reach));
        self.allow = inside;
        Ok(())
    }

    fn leave_functional(&mut self) {
        if let Some((allow, reach)) = self.outside.take() {
            self.allow = allow;
            self.reach = reach.join(Needs { level: Known::Study, ..Needs::CONSTANT });
        }
    }

    fn functional(&mut self, pool: &mut Pool, name: &str, of: Lowered, at: Option<Lowered>, text: &str) -> Result<Symbol, Unknown> {
        use super::study::{Functional, FunctionalKind as Kind};
        let Some(functionals) = &mut self.local.functionals else { return Err(silent()) };
        let independent = functionals.independent.unwrap_or(Dimension::NONE);
        let (kind, dimension) = match name {
            "mean" => (Kind::Mean, of.dimension),
            "integral" => (Kind::Integral, of.dimension.mul(independent)),
            "max" => (Kind::Max, of.dimension),
            "min" => (Kind::Min, of.dimension),
            "last" => (Kind::Last, of.dimension),
            "value" => (Kind::Value, of.dimension),
            _ => (Kind::First, independent),
        };
        let whole =
            |i: u32| matches!(self.name_space.model.inputs[i as usize], Quantity::Functional(_) | Quantity::Result(_) | Quantity::Work(_));
        if pool.inputs_of(&[of.id]).into_iter().any(whole) {
            let found = format!("`{name}(..)` of a number of the whole study, which is known only at its end");
            let help = "bring it by `take:` from another study, or write it outside".to_owned();
            return Err(self.refuse("wrong-level", unknown(found, "an expression of the moment", Some(help))));
        }
        if let Some(at) = at {
            if let Err(found) = at.expect(independent) {
                let expected = format!("a place of the independent variable: {}", independent.name());
                return Err(self.refuse("wrong-dimension", unknown(format!("found {found} as a place"), expected, None)));
            }
            if !pool.inputs_of(&[at.id]).is_empty() {
                return Err(self.refuse("varies", unknown("this place varies or is a result", "a number or parameters as place", None)));
            }
        }
        let at = at.map(|at| at.id);
        let same = |f: &Functional| f.kind == kind && f.of == of.id && f.at == at;
        let number = functionals.all.iter().position(same).unwrap_or_else(|| {
            functionals.all.push(Functional { kind, of: of.id, at, text: text.to_owned(), dimension });
            functionals.all.len() - 1
        });
        Ok(Symbol { id: self.name_space.input(pool, Quantity::Functional(number)), dimension })
    }
}
