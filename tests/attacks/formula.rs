//! Formulas made by chance, with their text and a value of their own: a second evaluator that shares nothing with the first.

use super::dice::Dice;
use super::{between, share};

/// A formula. Names are `p0`, `p1`, ..; its text has no more parentheses than the grammar needs.
pub(crate) enum Formula {
    Number(f64),
    Name(usize),
    Minus(Box<Formula>),
    /// `+`, `-`, `*`, `/` or `^`.
    Binary(char, Box<[Formula; 2]>),
    Call(&'static str, Vec<Formula>),
    /// `if(a OP b, c, d)`.
    If(&'static str, Box<[Formula; 4]>),
}
use Formula::{Binary, Call, If, Minus, Name, Number};

/// What an evaluation went through.
#[derive(Clone, Copy)]
pub(crate) struct Trace {
    /// The largest number on the way: a measure of what rounding may do.
    pub(crate) largest: f64,
    /// How near a switch came to switching.
    pub(crate) gap: f64,
}

impl Default for Trace {
    fn default() -> Self {
        Self { largest: 1.0, gap: f64::INFINITY }
    }
}

const UNARY: [&str; 9] = ["sin", "cos", "atan", "sqrt", "exp", "log", "abs", "asin", "tan"];

impl Formula {
    /// A formula of a depth over `names` names.
    pub(crate) fn random(dice: &mut Dice, names: usize, depth: usize) -> Self {
        let part = |dice: &mut Dice| Self::random(dice, names, depth - 1);
        if depth == 0 || dice.next(8) == 0 {
            return if dice.next(3) > 0 { Name(dice.next(names)) } else { Number(between(dice, 0.0, 3.0)) };
        }
        match dice.next(16) {
            0 => Minus(Box::new(part(dice))),
            kind @ 1..=8 => {
                let sign = ['+', '-', '*', '/', '+', '-', '*', '*'][kind - 1];
                Binary(sign, Box::new([part(dice), part(dice)]))
            }
            9 => Binary('^', Box::new([part(dice), Number(f64::from(dice.next(4) as u32))])),
            10 => Call(["min", "max"][dice.next(2)], (0..2 + dice.next(2)).map(|_| part(dice)).collect()),
            11 => {
                let low = between(dice, -2.0, 0.0);
                let negative = if low < 0.0 { Minus(Box::new(Number(-low))) } else { Number(low) };
                Call("clamp", vec![part(dice), negative, Number(between(dice, 0.5, 2.0))])
            }
            12 => If(["<", "<=", ">", ">="][dice.next(4)], Box::new([part(dice), part(dice), part(dice), part(dice)])),
            13 => Call("atan2", vec![part(dice), part(dice)]),
            _ => Call(UNARY[dice.next(UNARY.len())], vec![part(dice)]),
        }
    }

    /// How many switches it has.
    pub(crate) fn switches(&self) -> usize {
        match self {
            Number(_) | Name(_) => 0,
            Minus(a) => a.switches(),
            Binary(_, ab) => ab.iter().map(Self::switches).sum(),
            Call(name, of) => {
                let own = match *name {
                    "abs" => 1,
                    "clamp" => 2,
                    "min" | "max" => of.len() - 1,
                    _ => 0,
                };
                own + of.iter().map(Self::switches).sum::<usize>()
            }
            If(_, of) => 1 + of.iter().map(Self::switches).sum::<usize>(),
        }
    }

    /// How tightly its outermost operator binds: sum 1, product 2, sign 3, power 4, atom 5.
    fn binding(&self) -> u8 {
        match self {
            Binary('+' | '-', _) => 1,
            Binary('*' | '/', _) => 2,
            Minus(_) => 3,
            Binary(..) => 4,
            Number(_) | Name(_) | Call(..) | If(..) => 5,
        }
    }

    /// Its text where something around it binds with at least `least`.
    fn inside(&self, least: u8) -> String {
        if self.binding() < least { format!("({})", self.text()) } else { self.text() }
    }

    pub(crate) fn text(&self) -> String {
        match self {
            Number(x) => format!("{x}"),
            Name(i) => format!("p{i}"),
            Minus(a) => format!("-{}", a.inside(4)),
            Binary('^', ab) => format!("{}^{}", ab[0].inside(5), ab[1].inside(4)),
            Binary(sign, ab) => format!("{} {sign} {}", ab[0].inside(self.binding()), ab[1].inside(self.binding() + 1)),
            Call(name, of) => format!("{name}({})", of.iter().map(Self::text).collect::<Vec<_>>().join(", ")),
            If(sign, of) => format!("if({} {sign} {}, {}, {})", of[0].text(), of[1].text(), of[2].text(), of[3].text()),
        }
    }

    /// Its value; NaN where it is undefined, or infinite on the way.
    pub(crate) fn value(&self, names: &[f64], trace: &mut Trace) -> f64 {
        let value = match self {
            Number(x) => *x,
            Name(i) => names[*i],
            Minus(a) => -a.value(names, trace),
            Binary(sign, ab) => {
                let (a, b) = (ab[0].value(names, trace), ab[1].value(names, trace));
                match sign {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    '/' => a / b,
                    // NaN to the power of 0 is 1 for IEEE 754, and undefined here
                    _ if a.is_nan() => a,
                    _ => a.powf(b),
                }
            }
            Call(name, of) => {
                let of: Vec<f64> = of.iter().map(|f| f.value(names, trace)).collect();
                call(name, &of, trace)
            }
            If(sign, of) => {
                let (a, b) = (of[0].value(names, trace), of[1].value(names, trace));
                trace.gap = trace.gap.min((a - b).abs());
                let holds = match *sign {
                    "<" => a < b,
                    "<=" => a <= b,
                    ">" => a > b,
                    _ => a >= b,
                };
                if a.is_nan() || b.is_nan() { f64::NAN } else { of[if holds { 2 } else { 3 }].value(names, trace) }
            }
        };
        trace.largest = trace.largest.max(value.abs());
        if value.is_finite() { value } else { f64::NAN }
    }
}

fn call(name: &str, of: &[f64], trace: &mut Trace) -> f64 {
    if of.iter().any(|x| x.is_nan()) {
        return f64::NAN;
    }
    let x = of[0];
    let mut near = |gap: f64| trace.gap = trace.gap.min(gap.abs());
    match name {
        "sin" => x.sin(),
        "cos" => x.cos(),
        "tan" => x.tan(),
        "asin" => {
            near(1.0 - x.abs());
            x.asin()
        }
        "atan" => x.atan(),
        "atan2" => {
            // it jumps where the direction passes that of the negative axis
            near(if of[1] < 0.0 { x } else { x.hypot(of[1]) });
            x.atan2(of[1])
        }
        "sqrt" => {
            near(x);
            x.sqrt()
        }
        "exp" => x.exp(),
        "log" => {
            near(x);
            x.ln()
        }
        "abs" => {
            near(x);
            x.abs()
        }
        "clamp" => {
            near(x - of[1]);
            near(x - of[2]);
            x.clamp(of[1], of[2])
        }
        _ => {
            for (i, a) in of.iter().enumerate() {
                of[i + 1..].iter().for_each(|b| near(a - b));
            }
            of.iter().copied().fold(x, if name == "min" { f64::min } else { f64::max })
        }
    }
}

/// Values of names.
pub(crate) fn names(dice: &mut Dice, count: usize) -> Vec<f64> {
    (0..count).map(|_| if share(dice) < 0.5 { between(dice, -3.0, 3.0) } else { between(dice, 0.1, 1.5) }).collect()
}
