//! One semantics of undefined values: a tree of syntax walked by the plainest code, against constants that are folded, values of
//! nodes, and programs on plain and on dual numbers.

use super::parser::{Expr, Kind, parse};
use super::*;
use crate::scalar::Dual;
use std::sync::Arc;

/// `x`, `y` are inputs and `p`, `q` parameters; the table `f` has no value outside of [0, 2], `g` keeps its ends.
struct Names;

impl Scope for Names {
    fn name(&mut self, pool: &mut Pool, path: &str) -> Result<Symbol, Unknown> {
        let id = match path {
            "x" => pool.input(0),
            "y" => pool.input(1),
            "p" => pool.parameter(0),
            "q" => pool.parameter(1),
            _ => return Err(Unknown { found: path.to_owned(), expected: String::new(), help: None }),
        };
        Ok(Symbol { id, dimension: Dimension::NONE })
    }
    fn has_value(&self, word: &str) -> bool {
        ["x", "y", "p", "q"].contains(&word)
    }
    fn table(&mut self, name: &str) -> Option<(u32, Dimension, Dimension)> {
        ["f", "g"].iter().position(|n| *n == name).map(|i| (i as u32, Dimension::NONE, Dimension::NONE))
    }
    fn rate(&mut self, pool: &mut Pool, input: u32) -> Option<Id> {
        Some(pool.input(input + 2))
    }
    fn enter_functional(&mut self, name: &str) -> Result<(), Unknown> {
        Err(Unknown { found: name.to_owned(), expected: String::new(), help: None })
    }
    fn functional(&mut self, _: &mut Pool, name: &str, _: Lowered, _: Option<Lowered>, _: &str) -> Result<Symbol, Unknown> {
        Err(Unknown { found: name.to_owned(), expected: String::new(), help: None })
    }
}

const F: [(f64, f64); 3] = [(0.0, 1.0), (1.0, 3.0), (2.0, -1.0)];

fn tables() -> Arc<[LookupTable]> {
    [Beyond::Error, Beyond::Constant].map(|beyond| LookupTable::new(&F, Between::Linear, beyond).unwrap()).into()
}

/// The second evaluator: `None` is undefined. `near` is set where rounding could decide.
struct Walker<'a> {
    names: &'a dyn Fn(&str) -> f64,
    near: bool,
}

impl Walker<'_> {
    fn all(&mut self, of: &[Expr]) -> Option<Vec<f64>> {
        // each of them, so that `near` is known
        let values: Vec<Option<f64>> = of.iter().map(|e| self.walk(e)).collect();
        values.into_iter().collect()
    }

    fn close(&mut self, a: f64, b: f64) {
        self.near |= a != b && (a - b).abs() <= 1e-7 * (1.0 + a.abs() + b.abs());
    }

    fn walk(&mut self, e: &Expr) -> Option<f64> {
        let truth = |b: bool| f64::from(u8::from(b));
        let value = match &e.kind {
            Kind::Number(x) => *x,
            Kind::Path(name) => (self.names)(name),
            Kind::Negate(a) => -self.walk(a)?,
            Kind::Sum(first, rest) | Kind::Product(first, rest) => {
                let sum = matches!(e.kind, Kind::Sum(..));
                let mut value = self.walk(first);
                for (inverse, next) in rest {
                    let next = self.walk(next);
                    value = value.zip(next).and_then(|(a, b)| {
                        self.close(b, 0.0);
                        let value = match (sum, inverse) {
                            (true, false) => a + b,
                            (true, true) => a - b,
                            (false, false) => a * b,
                            (false, true) => a / b,
                        };
                        Some(value).filter(|x| x.is_finite())
                    });
                }
                value?
            }
            Kind::Power(a, b) => {
                let (a, b) = (self.walk(a), self.walk(b));
                let (a, b) = (a?, b?);
                self.close(a, 0.0);
                self.close(b, b.round());
                a.powf(b)
            }
            Kind::Compare(op, a, b) => {
                let (a, b) = (self.walk(a), self.walk(b));
                let (a, b) = (a?, b?);
                self.close(a, b);
                truth(match op {
                    Compare::Less => a < b,
                    Compare::LessEqual => a <= b,
                    Compare::Greater => a > b,
                    Compare::GreaterEqual => a >= b,
                    Compare::Equal => a == b,
                    Compare::NotEqual => a != b,
                })
            }
            Kind::Not(a) => truth(self.walk(a)? == 0.0),
            Kind::And(all) => truth(self.all(all)?.iter().all(|x| *x != 0.0)),
            Kind::Or(all) => truth(self.all(all)?.iter().any(|x| *x != 0.0)),
            Kind::Call(name, _, arguments) if name == "if" => {
                let condition = self.walk(&arguments[0])?;
                self.close(condition, 0.0);
                self.walk(&arguments[if condition != 0.0 { 1 } else { 2 }])?
            }
            Kind::Call(name, _, arguments) => {
                let a = self.all(arguments)?;
                self.call(name, &a)
            }
            Kind::Quantity(..) => return None,
        };
        self.near |= value.abs() > 1e60;
        Some(value).filter(|x| x.is_finite())
    }

    fn call(&mut self, name: &str, a: &[f64]) -> f64 {
        match name {
            "abs" | "sign" | "sqrt" | "log" | "log10" | "atan2" => self.close(a[0], 0.0),
            "asin" | "acos" => self.close(a[0].abs(), 1.0),
            "min" | "max" => self.close(a[0], a[1]),
            "floor" => {
                self.close(a[0], a[0].round());
                self.near |= a[0].abs() > 1e9;
            }
            "f" | "g" => [0.0, 1.0, 2.0].into_iter().for_each(|x| self.close(a[0], x)),
            _ => {}
        }
        match name {
            "sin" => a[0].sin(),
            "cos" => a[0].cos(),
            "tan" => {
                self.close(a[0].cos(), 0.0);
                a[0].tan()
            }
            "asin" => a[0].asin(),
            "acos" => a[0].acos(),
            "atan" => a[0].atan(),
            "exp" => a[0].exp(),
            "log" => a[0].ln(),
            "log10" => a[0].log10(),
            "sinh" => a[0].sinh(),
            "cosh" => a[0].cosh(),
            "tanh" => a[0].tanh(),
            "floor" => a[0].floor(),
            "sqrt" => a[0].sqrt(),
            "abs" => a[0].abs(),
            "sign" => (if a[0] > 0.0 { 1.0 } else { 0.0 }) - (if a[0] < 0.0 { 1.0 } else { 0.0 }),
            "atan2" => (a[0] + 0.0).atan2(a[1] + 0.0),
            "min" => a[0].min(a[1]),
            "max" => a[0].max(a[1]),
            "clamp" => a[0].max(a[1]).min(a[2]),
            "f" | "g" if !(0.0..=2.0).contains(&a[0]) => match name {
                "f" => f64::NAN,
                _ => F[if a[0] < 0.0 { 0 } else { 2 }].1,
            },
            "f" | "g" => {
                let k = usize::from(a[0] >= 1.0);
                F[k].1 + (a[0] - F[k].0) * (F[k + 1].1 - F[k].1)
            }
            _ => panic!("{name}"),
        }
    }
}

/// Random expressions, many of whose parts are undefined somewhere.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    fn leaf(&mut self, names: [&str; 2]) -> String {
        match self.below(5) {
            0 => format!("({})", VALUES[self.below(VALUES.len() as u64) as usize]),
            k => names[k as usize % 2].to_owned(),
        }
    }

    fn text(&mut self, depth: u32, names: [&str; 2]) -> String {
        if depth == 0 || self.below(12) == 0 {
            return self.leaf(names);
        }
        const ONE: [&str; 19] = [
            "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "sqrt", "abs", "sign", "f", "g", "log", "log10", "sinh", "cosh",
            "tanh", "floor",
        ];
        const TWO: [&str; 14] = [" + ", " - ", "*", "/", "^", " < ", " <= ", " > ", " >= ", " == ", " != ", " and ", " or ", "/"];
        let mut part = || self.text(depth - 1, names);
        let (a, b, c) = (part(), part(), part());
        match self.below(12) {
            0..=3 => format!("{}({a})", ONE[self.below(19) as usize]),
            4..=7 => format!("(({a}){}({b}))", TWO[self.below(14) as usize]),
            8 => format!("{}({a}, {b})", ["min", "max", "atan2"][self.below(3) as usize]),
            9 => format!("clamp({a}, {b}, {c})"),
            10 => format!("if({a}, {b}, {c})"),
            _ => format!("({} ({a}))", ["not", "-", "0*", "1*"][self.below(4) as usize]),
        }
    }
}

/// The text with other words for the names `x` and `y`.
fn named(text: &str, x: &str, y: &str) -> String {
    let mut out = String::new();
    for word in text.split_inclusive(|c: char| !c.is_ascii_alphanumeric()) {
        let end = word.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(word.len());
        out += match &word[..end] {
            "x" => x,
            "y" => y,
            other => other,
        };
        out += &word[end..];
    }
    out
}

const VALUES: [f64; 9] = [-2.5, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0, 1.5, 3.0];

fn node(pool: &mut Pool, text: &str) -> Id {
    let expr = parse(text).unwrap();
    lower(pool, &expr, text, &mut Names).unwrap_or_else(|faults| panic!("{text}: {faults:?}")).id
}

/// The value of a program at inputs x, y and their rates, on plain and on dual numbers.
fn run(pool: &Pool, id: Id, parameters: &[f64], inputs: [f64; 4]) -> [f64; 2] {
    let program = pool.program(&[id], parameters, &tables());
    let mut modes = vec![0; pool.switches().len()];
    let (mut plain, mut dual) = ([0.0], [Dual::<2>::default()]);
    let mut registers = vec![f64::NAN; program.registers()];
    program.set_modes(&inputs, &mut registers, &mut modes);
    program.eval(&inputs, &modes, &mut registers, &mut plain);
    let seeded = [0, 1, 2, 3].map(|i| Dual::variable(inputs[i], i % 2));
    program.eval(&seeded, &modes, &mut vec![Dual::default(); program.registers()], &mut dual);
    [plain[0], dual[0].x]
}

#[test]
fn every_way_to_a_value_agrees_on_what_is_undefined() {
    let mut random = Random(2024);
    let (mut compared, mut undefined) = (0, 0);
    for _ in 0..9000 {
        let text = random.text(4, ["x", "y"]);
        if parse(&text).is_err() {
            continue;
        }
        let [x, y] = [0, 1].map(|_| VALUES[random.below(VALUES.len() as u64) as usize]);
        let names = |name: &str| if name == "x" { x } else { y };
        let mut walker = Walker { names: &names, near: false };
        let wanted = walker.walk(&parse(&text).unwrap());
        if walker.near {
            continue;
        }
        let [fixed, literal] = [["p".to_owned(), "q".to_owned()], [format!("({x})"), format!("({y})")]].map(|[x, y]| named(&text, &x, &y));
        // an angle is no condition, and bounds of constants ascend
        let refused = |text: &&String| parse(text).map_or(true, |expr| lower(&mut Pool::new(), &expr, text, &mut Names).is_err());
        if [&text, &fixed, &literal].iter().any(refused) {
            continue;
        }
        let mut pool = Pool::new();
        let [moving, parameter, constant] = [&text, &fixed, &literal].map(|text| node(&mut pool, text));
        let rate = node(&mut pool, &format!("rate({text})"));
        let inputs = [x, y, 0.7, -0.3];
        let [plain, dual] = run(&pool, moving, &[], inputs);
        let [folded, _] = run(&pool, parameter, &[x, y], inputs);
        let found = [
            ("program", plain),
            ("dual", dual),
            ("parameters in a program", folded),
            ("value", pool.values_with_tables(&[parameter], &[x, y], &tables())[0]),
            ("constants", pool.values_with_tables(&[constant], &[], &tables())[0]),
        ];
        for (way, value) in found {
            match wanted {
                None => assert!(!value.is_finite(), "{way}: {value} for undefined {text} at {x}, {y}"),
                Some(w) => assert!((w - value).abs() <= 1e-6 * (1.0 + w.abs()), "{way}: {value} for {w} of {text} at {x}, {y}"),
            }
        }
        if wanted.is_none() {
            undefined += 1;
            assert!(!run(&pool, rate, &[], inputs)[0].is_finite(), "rate of undefined {text} at {x}, {y}");
        }
        compared += 1;
    }
    assert!(compared > 4000 && undefined > 1500, "{compared} {undefined}");
}

#[test]
fn only_an_if_hides_what_is_undefined() {
    let mut pool = Pool::new();
    for text in [
        "max(sqrt(p), 1)",
        "min(sqrt(p), 1)",
        "sign(asin(p))",
        "abs(log(p))",
        "if(log(p) > 0, 1, 2)",
        "if(log(p) > 0, 1, 1)",
        "clamp(sqrt(p), 0.25, 1.5)",
        "sqrt(p) and 0",
        "1 or sqrt(p)",
        "not sqrt(p)",
        "0*sqrt(p)",
        "sqrt(p)^0",
        "atan(1/(p + 2))",
        "exp(log(p + 2))",
        "1/(1/(p + 2))",
        "1 + f(p)",
        "sqrt(p) == sqrt(p)",
        "rate(log(p))",
    ] {
        let id = node(&mut pool, text);
        assert!(pool.values_with_tables(&[id], &[-2.0, 0.0], &tables())[0].is_nan(), "{text}");
        assert!(run(&pool, id, &[-2.0, 0.0], [0.0; 4]).iter().all(|x| !x.is_finite()), "{text}");
    }
    for (text, value) in [("if(p > 0, sqrt(p), 3)", 3.0), ("if(p < 0, 4, f(p))", 4.0), ("max(p, g(p))", 1.0)] {
        let id = node(&mut pool, text);
        assert_eq!(pool.values_with_tables(&[id], &[-2.0, 0.0], &tables()), [value], "{text}");
    }
}
