//! Switches: the places where an expression changes its formula, each with an integer mode.
//!
//! | switch | modes |
//! |---|---|
//! | `a < b`, `a <= b` | 1 true, 0 false |
//! | `a == b`, `a != b` | sign of a − b: −1, 0, 1 |
//! | `abs(a)`, `sign(a)` | sign of a: −1, 0, 1 |
//! | `min(a, b)`, `max(a, b)` | 1 if a ≤ b, else 0 |
//! | `floor(a)`, `ceil(a)`, `round(a)`, `mod(a, b)` | the whole number below a, −a, a + 1/2, a/b; without bound up to ±2³¹ |
//! | table | number of the segment; −1 below, n above the n segments; periodic tables count on without bound |

use super::id::Id;
use super::table::LookupTable;
use crate::scalar::{Interval, Scalar};

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compare {
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`; a pool holds it as `<` of exchanged operands.
    Greater,
    /// `>=`; a pool holds it as `<=` of exchanged operands.
    GreaterEqual,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
}

impl Compare {
    /// Whether the comparison is true in a mode of its switch.
    #[must_use]
    #[inline]
    pub fn holds(self, mode: i32) -> bool {
        match self {
            Self::Equal => mode == 0,
            _ => mode != 0,
        }
    }
}

/// What a switch compares; `I` names an operand (a node in a pool, a register in a program).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Test<I = Id> {
    /// A comparison; never `Greater` or `GreaterEqual`.
    Compare(Compare, I, I),
    /// Sign of an operand, for `abs` and `sign`.
    Sign(I),
    /// Which of two is smaller, for `min` and `max`.
    Order(I, I),
    /// The largest whole number that is not above an operand.
    Whole(I),
    /// Segment of a table.
    Segment {
        /// Number of the table.
        table: u32,
        /// Its argument.
        x: I,
    },
}

/// A place where an expression changes its formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Switch {
    /// What is compared.
    pub test: Test,
    /// As written first, for messages: `phi3 <= load_angle`.
    pub text: String,
}

impl Switch {
    /// In words: as a switch by its text, or, where the text is in words that name something, as these.
    #[must_use]
    pub fn told(&self) -> String {
        if self.text.contains('`') { format!("the {}", self.text) } else { format!("the switch `{}`", self.text) }
    }
}

fn sign(x: f64) -> i32 {
    // not a number counts as unequal and positive, so that a mode exists whatever the value
    if x < 0.0 { -1 } else { i32::from(x != 0.0) }
}

/// The mode of a whole number that is undefined, or beyond ±2³¹.
pub(super) const OUTSIDE: i32 = i32::MIN;

/// The whole number that a mode of [`Test::Whole`] stands for.
#[inline]
pub(super) fn whole(mode: i32) -> f64 {
    if mode == OUTSIDE { f64::NAN } else { f64::from(mode) }
}

fn whole_below(x: f64) -> i32 {
    let below = x.floor();
    if below.abs() < f64::from(i32::MAX) { below as i32 } else { OUTSIDE }
}

impl<I: Copy> Test<I> {
    /// The same test of other operands.
    pub(super) fn map<J>(self, mut f: impl FnMut(I) -> J) -> Test<J> {
        match self {
            Self::Compare(op, a, b) => Test::Compare(op, f(a), f(b)),
            Self::Sign(a) => Test::Sign(f(a)),
            Self::Order(a, b) => Test::Order(f(a), f(b)),
            Self::Whole(a) => Test::Whole(f(a)),
            Self::Segment { table, x } => Test::Segment { table, x: f(x) },
        }
    }

    /// The mode that the operands' values ask for; a tie takes the literal truth.
    pub(super) fn mode(self, value: impl Fn(I) -> f64, tables: &[LookupTable]) -> i32 {
        match self {
            Self::Compare(Compare::Less, a, b) => i32::from(value(a) < value(b)),
            Self::Compare(Compare::LessEqual, a, b) | Self::Order(a, b) => i32::from(value(a) <= value(b)),
            Self::Compare(Compare::Greater, a, b) => i32::from(value(a) > value(b)),
            Self::Compare(Compare::GreaterEqual, a, b) => i32::from(value(a) >= value(b)),
            Self::Compare(Compare::Equal | Compare::NotEqual, a, b) => sign(value(a) - value(b)),
            Self::Sign(a) => sign(value(a)),
            Self::Whole(a) => whole_below(value(a)),
            Self::Segment { table, x } => tables.get(table as usize).map_or(0, |t| t.segment(value(x))),
        }
    }

    /// Distance of the operands from the end of `mode`: positive inside, 0 on the switch, negative outside.
    ///
    /// Where an operand is not a number (a value that an `if` does not take) nothing can be crossed: 1.
    pub(super) fn root(self, mode: i32, value: impl Fn(I) -> f64, tables: &[LookupTable]) -> f64 {
        let two_sided = |x: f64| match mode {
            0 => -x.abs(),
            m if m > 0 => x,
            _ => -x,
        };
        let ordered = |less: f64, more: f64| if mode != 0 { more - less } else { less - more };
        let root = match self {
            Self::Compare(Compare::Less | Compare::LessEqual, a, b) | Self::Order(a, b) => ordered(value(a), value(b)),
            Self::Compare(Compare::Greater | Compare::GreaterEqual, a, b) => ordered(value(b), value(a)),
            Self::Compare(Compare::Equal | Compare::NotEqual, a, b) => two_sided(value(a) - value(b)),
            Self::Sign(a) => two_sided(value(a)),
            // smooth: the product of the distances from both ends; NaN outside
            Self::Whole(a) => {
                let above = value(a) - whole(mode);
                above * (1.0 - above)
            }
            Self::Segment { table, x } => tables.get(table as usize).map_or(1.0, |t| t.inside(value(x), mode)),
        };
        if root.is_nan() { 1.0 } else { root }
    }

    /// Bounds of [`Self::root`] for operands in intervals, and the size of what it is the difference of; no interval where an operand
    /// is undefined throughout.
    pub(super) fn bounds(self, mode: i32, value: impl Fn(I) -> Interval, tables: &[LookupTable]) -> (Interval, f64) {
        let two_sided = |x: Interval| match mode {
            0 if x.holds(0.0) => Interval { low: -x.magnitude(), high: 0.0 },
            m if m > 0 || m == 0 && x.high < 0.0 => x,
            _ => -x,
        };
        let size = |a: Interval, b: Interval| a.magnitude() + b.magnitude();
        let ordered = |less: Interval, more: Interval| (if mode != 0 { more - less } else { less - more }, size(less, more));
        match self {
            Self::Compare(Compare::Less | Compare::LessEqual, a, b) | Self::Order(a, b) => ordered(value(a), value(b)),
            Self::Compare(Compare::Greater | Compare::GreaterEqual, a, b) => ordered(value(b), value(a)),
            Self::Compare(Compare::Equal | Compare::NotEqual, a, b) => {
                let (a, b) = (value(a), value(b));
                (two_sided(a - b), size(a, b))
            }
            Self::Sign(a) => (two_sided(value(a)), value(a).magnitude()),
            Self::Whole(a) => {
                let one = Interval::constant(1.0);
                let above = value(a) - Interval::constant(whole(mode));
                (above * (one - above), value(a).magnitude() + 1.0)
            }
            Self::Segment { table, x } => {
                let x = value(x);
                let table = tables.get(table as usize);
                let none = (Interval::NONE, 0.0);
                table.filter(|_| !x.is_none()).map_or(none, |t| (t.inside_of(x, mode), x.magnitude() + t.span()))
            }
        }
    }

    /// Distances of a table's argument from the lower and the upper end of its segment `mode`; none for other tests.
    pub(super) fn ends(self, mode: i32, value: impl Fn(I) -> f64, tables: &[LookupTable]) -> Option<[f64; 2]> {
        let Self::Segment { table, x } = self else { return None };
        let ends = tables.get(table as usize)?.from_ends(value(x), mode);
        // as above
        Some(ends.map(|d| if d.is_nan() { 1.0 } else { d }))
    }

    /// The mode on the other side of the end of `mode` that is nearest; the one that the value asks for where that lies farther on, as
    /// behind a jump of the operand (`floor(4*mod(x, 1))`, a table of `mod`).
    ///
    /// From the middle mode 0 of a sign it is the side where the value lies, positive on a tie.
    pub(super) fn neighbour(self, mode: i32, value: impl Fn(I) -> f64, tables: &[LookupTable]) -> i32 {
        let across = |x: f64| match mode {
            0 => sign(x) + i32::from(x == 0.0),
            m => -m,
        };
        match self {
            Self::Compare(Compare::Equal | Compare::NotEqual, a, b) => across(value(a) - value(b)),
            Self::Compare(..) | Self::Order(..) => i32::from(mode == 0),
            Self::Sign(a) => across(value(a)),
            Self::Whole(_) if mode == OUTSIDE => mode,
            Self::Whole(a) => {
                let side = if value(a) - whole(mode) < 0.5 { -1.0 } else { 1.0 };
                farther(mode, whole_below(whole(mode) + side), whole_below(value(a)))
            }
            Self::Segment { table, x } => {
                tables.get(table as usize).map_or(mode, |t| farther(mode, t.neighbour(value(x), mode), t.segment(value(x))))
            }
        }
    }
}

/// `asked` if it lies beyond `next` as seen from `mode`, else `next`.
fn farther(mode: i32, next: i32, asked: i32) -> i32 {
    let beyond = if next > mode { asked > next } else { asked < next };
    if beyond && asked != OUTSIDE { asked } else { next }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TESTS: [Test<usize>; 6] = [
        Test::Compare(Compare::Less, 0, 1),
        Test::Compare(Compare::LessEqual, 0, 1),
        Test::Compare(Compare::Equal, 0, 1),
        Test::Compare(Compare::NotEqual, 0, 1),
        Test::Sign(0),
        Test::Order(0, 1),
    ];

    #[test]
    fn roots_are_positive_in_the_mode_that_the_values_ask_for() {
        for test in TESTS {
            for values in [[-2.0, 0.0], [2.0, 0.0]] {
                let value = |i: usize| values[i];
                let mode = test.mode(value, &[]);
                assert_eq!(test.root(mode, value, &[]), 2.0, "{test:?} {values:?}");
                let other = test.neighbour(mode, value, &[]);
                assert_ne!(mode, other);
                assert!(test.root(other, value, &[]) < 0.0);
            }
        }
    }

    #[test]
    fn whole_numbers_are_counted_on_both_sides_of_zero() {
        let test = Test::Whole(0);
        for (x, mode, root, next) in
            [(2.25, 2, 0.1875, 1), (2.75, 2, 0.1875, 3), (-0.25, -1, 0.1875, 0), (-0.75, -1, 0.1875, -2), (3.0, 3, 0.0, 2)]
        {
            assert_eq!((test.mode(|_| x, &[]), test.root(mode, |_| x, &[]), test.neighbour(mode, |_| x, &[])), (mode, root, next), "{x}");
        }
        // behind jumps of the operand
        for (x, mode, next) in [(7.5, 2, 7), (-3.5, 2, -4), (4.0, 2, 4), (f64::NAN, 2, 3), (1e10, 2, 3)] {
            assert_eq!(test.neighbour(mode, |_| x, &[]), next, "{x}");
        }
        // upwards through 3
        assert_eq!((test.root(2, |_| 3.0, &[]), test.neighbour(2, |_| 3.0, &[])), (0.0, 3));
        for x in [f64::NAN, f64::INFINITY, 1e10, -1e10] {
            let mode = test.mode(|_| x, &[]);
            assert!(whole(mode).is_nan() && test.root(mode, |_| x, &[]) == 1.0 && test.neighbour(mode, |_| x, &[]) == mode, "{x}");
        }
    }

    #[test]
    fn a_tie_takes_the_literal_truth() {
        let modes = TESTS.map(|test| test.mode(|_| 0.0, &[]));
        assert_eq!(modes, [0, 1, 0, 0, 0, 1]);
        assert!(!Compare::Less.holds(0) && Compare::LessEqual.holds(1) && Compare::Equal.holds(0) && !Compare::NotEqual.holds(0));
        for (test, mode) in TESTS.into_iter().zip(modes) {
            assert_eq!(test.root(mode, |_| 0.0, &[]), 0.0, "{test:?}");
        }
    }

    #[test]
    fn what_is_no_number_crosses_nothing() {
        for test in TESTS {
            let mode = test.mode(|_| f64::NAN, &[]);
            assert!(test.root(mode, |_| f64::NAN, &[]) > 0.0);
        }
        assert!(!Compare::Equal.holds(TESTS[2].mode(|_| f64::NAN, &[])));
    }
}
