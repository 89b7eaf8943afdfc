//! Text → checked program: numbers with units, names, functions and switches, compiled once and evaluated on any scalar.
//!
//! [`parse`] gives a syntax tree with byte spans; [`lower`] resolves names through a [`Scope`], checks dimensions and puts
//! hash-consed nodes into a [`Pool`]; [`Pool::program`] extracts a straight-line [`Program`] with parameters folded to
//! numbers. Every switch (comparison, `abs`, `sign`, `min`, `max`, `clamp`, table segment) has a number and an integer
//! *mode*; a program never branches on a value: it selects by mode. This module knows no mechanics and no file format.

mod calls;
mod cause;
mod compile;
mod construct;
mod evaluate;
mod external;
mod function;
mod id;
mod integral;
mod lexer;
mod lower;
mod nearest;
mod parser;
mod part;
mod pool;
mod program;
mod quantity;
mod rate;
mod scope;
mod simplify;
mod spline;
mod switch;
mod syntax;
mod table;
mod unit_text;
mod units;

pub use cause::Cause;
pub use external::ExternalFunction;
pub use function::is_function;
pub use id::Id;
pub use integral::{Integral, Integrand};
pub use lower::{CALLED, lower};
pub use nearest::{MOST_CANDIDATES, nearest};
pub use parser::{Expr, Kind, parse};
pub use part::{Part, Wanted};
pub use pool::{Node, Pool};
pub use program::Program;
pub(crate) use quantity::unit_hint;
pub use scope::{Fault, Lowered, Scope, Symbol, Unknown};
pub use switch::{Compare, Switch, Test};
pub use syntax::SyntaxError;
pub use table::{Between, Beyond, LookupTable, TableError};
pub use unit_text::{angle_instead, meant_fraction, meant_unit, parse_unit};
pub use units::Dimension;

#[cfg(test)]
mod undefined_tests;
