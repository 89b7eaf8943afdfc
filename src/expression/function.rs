//! The functions of the format: their names, arguments, dimensions and nodes.

use super::nearest::nearest;
use super::pool::{Id, Pool};
use super::units::Dimension;

/// What a function asks of its arguments and how its dimension follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// A number in, a number out.
    Number,
    /// A number in, an angle out.
    Inverse,
    /// √: any dimension, halved.
    Root,
    /// The dimension of its argument.
    Same,
    /// Any dimension in, a number out.
    Plain,
    /// Two arguments of one dimension, an angle out.
    Angle,
    /// Arguments of one dimension, which is the result's.
    Alike,
    /// Condition, then two values of one dimension.
    If,
    /// Divided by time.
    Rate,
}

/// A function over one evaluation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function {
    pub(super) name: &'static str,
    pub(super) shape: Shape,
    /// Least and greatest number of arguments.
    pub(super) count: (usize, usize),
    /// How it is called, for messages.
    pub(super) usage: &'static str,
}

const fn function(name: &'static str, shape: Shape, count: (usize, usize), usage: &'static str) -> Function {
    Function { name, shape, count, usage }
}

const FUNCTIONS: [Function; 26] = [
    function("sin", Shape::Number, (1, 1), "sin(x)"),
    function("cos", Shape::Number, (1, 1), "cos(x)"),
    function("tan", Shape::Number, (1, 1), "tan(x)"),
    function("asin", Shape::Inverse, (1, 1), "asin(x)"),
    function("acos", Shape::Inverse, (1, 1), "acos(x)"),
    function("atan", Shape::Inverse, (1, 1), "atan(x)"),
    function("exp", Shape::Number, (1, 1), "exp(x)"),
    function("log", Shape::Number, (1, 1), "log(x)"),
    function("log10", Shape::Number, (1, 1), "log10(x)"),
    function("sinh", Shape::Number, (1, 1), "sinh(x)"),
    function("cosh", Shape::Number, (1, 1), "cosh(x)"),
    function("tanh", Shape::Number, (1, 1), "tanh(x)"),
    function("floor", Shape::Number, (1, 1), "floor(x)"),
    function("ceil", Shape::Number, (1, 1), "ceil(x)"),
    function("round", Shape::Number, (1, 1), "round(x)"),
    function("mod", Shape::Alike, (2, 2), "mod(x, y)"),
    function("hypot", Shape::Alike, (2, 2), "hypot(x, y)"),
    function("atan2", Shape::Angle, (2, 2), "atan2(y, x)"),
    function("sqrt", Shape::Root, (1, 1), "sqrt(x)"),
    function("abs", Shape::Same, (1, 1), "abs(x)"),
    function("sign", Shape::Plain, (1, 1), "sign(x)"),
    function("min", Shape::Alike, (2, usize::MAX), "min(a, b)"),
    function("max", Shape::Alike, (2, usize::MAX), "max(a, b)"),
    function("clamp", Shape::Alike, (3, 3), "clamp(x, low, high)"),
    function("if", Shape::If, (3, 3), "if(condition, then, else)"),
    function("rate", Shape::Rate, (1, 1), "rate(x)"),
];

/// A function over a whole study.
#[derive(Clone, Copy, Debug)]
pub(super) struct Functional {
    pub(super) name: &'static str,
    pub(super) count: usize,
    pub(super) usage: &'static str,
}

const FUNCTIONALS: [Functional; 7] = [
    Functional { name: "mean", count: 1, usage: "mean(x)" },
    Functional { name: "integral", count: 1, usage: "integral(x)" },
    Functional { name: "max", count: 1, usage: "max(x)" },
    Functional { name: "min", count: 1, usage: "min(x)" },
    Functional { name: "last", count: 1, usage: "last(x)" },
    Functional { name: "value", count: 2, usage: "value(x, at)" },
    Functional { name: "first", count: 1, usage: "first(condition)" },
];

/// The function of this name.
pub(super) fn named(name: &str) -> Option<Function> {
    FUNCTIONS.into_iter().find(|f| f.name == name)
}

/// The functional that a call is: `min` and `max` are functionals with one argument only.
pub(super) fn functional(name: &str, arguments: usize) -> Option<Functional> {
    FUNCTIONALS.into_iter().find(|f| f.name == name && (arguments == 1 || !matches!(name, "min" | "max")))
}

/// What to write instead of a function that does not exist.
pub(super) fn remedy(name: &str) -> String {
    const OTHERS: [(&str, &str); 20] = [
        ("ln", "the natural logarithm is `log(x)`"),
        ("log1p", "write `log(1 + x)`"),
        ("trunc", "write `sign(x)*floor(abs(x))`"),
        ("fmod", "write `mod(x, y)`, which has the sign of y"),
        ("log2", "write `log(x)/log(2)`"),
        ("pow", "write `a^b`"),
        ("arcsin", "write `asin(x)`"),
        ("arccos", "write `acos(x)`"),
        ("arctan", "write `atan(x)`"),
        ("arctan2", "write `atan2(y, x)`"),
        ("fabs", "write `abs(x)`"),
        ("sgn", "write `sign(x)`"),
        ("der", "write `rate(x)`"),
        ("diff", "write `rate(x)`"),
        ("average", "write `mean(x)`"),
        ("end", "the value at the end is `last(x)`"),
        ("final", "the value at the end is `last(x)`"),
        ("initial", "the value at a place is `value(x, at)`, as `value(x, 0 s)`"),
        ("peak", "write `max(x)`, or `max(abs(x))`"),
        ("where", "write `if(condition, then, else)`"),
    ];
    if let Some((_, text)) = OTHERS.into_iter().find(|(other, _)| *other == name) {
        return (*text).to_owned();
    }
    match meant(name) {
        Some(usage) => format!("did you mean `{usage}`? If a product is meant, write `{name}*(..)`"),
        None => format!("if a product is meant, write `{name}*(..)`"),
    }
}

/// How the function is called that a misspelt name probably means.
pub(super) fn meant(name: &str) -> Option<&'static str> {
    let known = FUNCTIONS.into_iter().map(|f| (f.name, f.usage)).chain(FUNCTIONALS.into_iter().map(|f| (f.name, f.usage)));
    let near = nearest(name, known.clone().map(|(name, _)| name))?;
    known.into_iter().find(|(name, _)| *name == near).map(|(_, usage)| usage)
}

/// Whether expressions have a function or a functional of this name.
#[must_use]
pub fn is_function(name: &str) -> bool {
    named(name).is_some() || FUNCTIONALS.into_iter().any(|f| f.name == name)
}

impl Function {
    /// The node of the function (`rate` has none of its own) of `arguments`, whose number was checked.
    pub(super) fn node(&self, pool: &mut Pool, arguments: &[Id], text: &str) -> Option<Id> {
        Some(match (self.name, arguments) {
            ("sin", [a]) => pool.sin(*a),
            ("cos", [a]) => pool.cos(*a),
            ("tan", [a]) => pool.tan(*a),
            ("asin", [a]) => pool.asin(*a),
            ("acos", [a]) => pool.acos(*a),
            ("atan", [a]) => pool.atan(*a),
            ("exp", [a]) => pool.exp(*a),
            ("log", [a]) => pool.ln(*a),
            ("log10", [a]) => pool.log10(*a),
            ("sinh", [a]) => pool.sinh(*a),
            ("cosh", [a]) => pool.cosh(*a),
            ("tanh", [a]) => pool.tanh(*a),
            ("floor", [a]) => pool.floor(*a, text),
            ("ceil", [a]) => pool.ceil(*a, text),
            ("round", [a]) => pool.round(*a, text),
            ("mod", [a, b]) => pool.modulo(*a, *b, text),
            ("hypot", [a, b]) => pool.hypot(*a, *b),
            ("sqrt", [a]) => pool.sqrt(*a),
            ("abs", [a]) => pool.abs(*a, text),
            ("sign", [a]) => pool.sign(*a, text),
            ("atan2", [y, x]) => pool.atan2(*y, *x),
            ("min", [first, rest @ ..]) => rest.iter().fold(*first, |a, b| pool.min(a, *b, text)),
            ("max", [first, rest @ ..]) => rest.iter().fold(*first, |a, b| pool.max(a, *b, text)),
            ("clamp", [x, low, high]) => pool.clamp(*x, *low, *high, text),
            ("if", [condition, then, other]) => {
                let condition = pool.condition(*condition, text);
                pool.choose(condition, *then, *other)
            }
            _ => return None,
        })
    }

    /// Dimension of the result from that of the arguments (of the one that counts).
    pub(super) fn dimension(&self, of: Dimension) -> Option<Dimension> {
        match self.shape {
            Shape::Number | Shape::Plain => Some(Dimension::NONE),
            Shape::Inverse | Shape::Angle => Some(Dimension::ANGLE),
            Shape::Root => of.sqrt(),
            Shape::Same | Shape::Alike | Shape::If => Some(of),
            Shape::Rate => Some(of.div(Dimension::TIME)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_but_rate_has_a_node() {
        let mut pool = Pool::new();
        let arguments: Vec<Id> = (0..3).map(|i| pool.input(i)).collect();
        for f in FUNCTIONS {
            assert_eq!(f.node(&mut pool, &arguments[..f.count.0], f.usage).is_some(), f.name != "rate", "{}", f.name);
            assert!(f.usage.starts_with(f.name));
        }
    }

    #[test]
    fn one_argument_makes_min_and_max_functionals() {
        assert!(functional("min", 1).is_some() && functional("min", 2).is_none());
        assert!(functional("mean", 2).is_some() && functional("sin", 1).is_none());
    }

    #[test]
    fn remedies() {
        assert!(remedy("k").contains("`k*(..)`"));
        assert!(remedy("Sin").contains("sin(x)"));
        assert!(remedy("maxx").contains("`max(a, b)`") && remedy("tanhh").contains("`tanh(x)`"));
        assert!(remedy("ln").contains("log(x)"));
    }
}
