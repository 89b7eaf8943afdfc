//! What must hold of the numbers of a model. Each value that is read is registered with its rule, and the rules are applied
//! wherever its parameters get values: when a file is read, and when a mechanism is built.

use super::entities;
use super::fault::Fault;
use super::newmark::newmark_fault;
use super::place::Place;
use super::words::why_undefined;
use crate::expression::{Cause, Id, LookupTable, Pool, TableError};

/// What must hold of some values.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rule {
    /// Finite.
    Finite,
    /// Finite and not negative; the words say what it is.
    NotNegative(&'static str),
    /// Finite and positive.
    Positive(&'static str),
    /// Finite and not 0.
    NotZero(&'static str),
    /// Finite and not above a bound; the words say what it is.
    AtMost(f64, &'static str),
    /// Finite and between two bounds, which count; the words say what it is.
    Within(f64, f64, &'static str),
    /// Two values, the first one below the second.
    Rising,
    /// Two values that differ; the word says what they are.
    Differ(&'static str),
    /// Weights alpha and beta of Newmark's scheme that work with constraints at position level.
    ConstrainedNewmark,
    /// Not all zero.
    Direction,
    /// Two points, components one after the other, that differ.
    Distinct,
    /// Principal and mixed moments of inertia of a body that can exist: 3 or 6 figures.
    Inertia,
    /// Principal and mixed moments of inertia whose principal values are not negative: 3 or 6 figures.
    Moments,
    /// Two values of one sign, neither 0.
    Ratio,
    /// Pairs that make the table of this index.
    Table(usize),
}

/// A rule with its values and its place.
#[derive(Clone, Debug)]
pub struct Check<P = Place> {
    pub(crate) rule: Rule,
    pub(crate) ids: Vec<Id>,
    pub(crate) place: P,
    /// Whether the values are taken once, before a study varies parameters: ends of sweeps, bounds of a `solve`.
    pub(crate) once: bool,
}

/// Parameters with numbers.
pub(crate) struct Values {
    /// Values; not a number where unknown or undefined.
    pub(crate) numbers: Vec<f64>,
    /// Which wait for a scalar of another study, or have a fault that was reported.
    pub(crate) unknown: Vec<bool>,
}

/// Which of some checks fail, and how.
pub(crate) fn broken<'c, P>(
    checks: &'c [Check<P>],
    (pool, tables): (&Pool, &[entities::Table]),
    values: &Values,
    place: &dyn Fn(&P) -> String,
) -> Vec<(&'c Check<P>, Fault)> {
    let made = tables_with(pool, tables, &values.numbers);
    let ids: Vec<Id> = checks.iter().flat_map(|check| check.ids.iter().copied()).collect();
    let numbers = pool.values_with_tables(&ids, &values.numbers, &made);
    let any_unknown = values.unknown.contains(&true);
    let mut next = 0;
    let mut found = Vec::new();
    for check in checks {
        let numbers = &numbers[next..next + check.ids.len()];
        next += check.ids.len();
        if any_unknown && pool.parameters_of(&check.ids).iter().any(|i| values.unknown.get(*i as usize) == Some(&true)) {
            continue;
        }
        if let Some(fault) = check.rule.fault(numbers, tables, || place(&check.place)) {
            found.push((check, fault));
        }
    }
    found
}

/// The tables as functions; one that is faulty is replaced by a constant, its fault is found by its check.
fn tables_with(pool: &Pool, tables: &[entities::Table], parameters: &[f64]) -> Vec<LookupTable> {
    let mut made = Vec::with_capacity(tables.len());
    for table in tables {
        let ids: Vec<Id> = table.points.iter().flat_map(|(x, y)| [*x, *y]).collect();
        let numbers = pool.values(&ids, parameters);
        let points: Vec<(f64, f64)> = numbers.chunks(2).map(|p| (p[0], p[1])).collect();
        let table = LookupTable::new(&points, table.between, table.beyond);
        made.extend(table.or_else(|_| LookupTable::new(&[(0.0, 0.0), (1.0, 0.0)], Default::default(), Default::default())));
    }
    made
}

/// The fault of a parameter without a finite value.
pub(crate) fn not_finite(parameter: &entities::Parameter, x: f64, why: Option<Cause>) -> Fault {
    let why = why.map_or_else(|| format!("it is {x}"), why_undefined);
    let message = format!("`{}` has no finite value: {why}", parameter.name);
    Fault::new("not-a-number", parameter.place.clone(), message, "a finite number").help(UNDEFINED)
}

impl Rule {
    /// Whether values are as they must be, for what they alone tell it: not whether they make a table.
    pub(crate) fn allows(self, x: &[f64]) -> bool {
        !matches!(self, Rule::Table(_)) && self.fault(x, &[], String::new).is_none()
    }

    /// What is wrong with some values, at a place that is asked for only then.
    fn fault(self, x: &[f64], tables: &[entities::Table], place: impl Fn() -> String) -> Option<Fault> {
        let fault = |code, message: String, expected: &str| Some(Fault::new(code, place(), message, expected));
        if let Rule::Table(i) = self {
            let points: Vec<(f64, f64)> = x.chunks_exact(2).map(|p| (p[0], p[1])).collect();
            let table = tables.get(i)?;
            let error = LookupTable::new(&points, table.between, table.beyond).err()?;
            let place = match error {
                TableError::NotRising(k) | TableError::NotFinite(k) => format!("{}[{k}]", place()),
                _ => place(),
            };
            if let TableError::EndsDiffer(first, _) = error {
                let fault = Fault::new("bad-table", place, error.to_string(), "a last value that is the first one");
                return Some(fault.help(format!("end it with {first}, or choose another `beyond`")));
            }
            return Some(Fault::new("bad-table", place, error.to_string(), "two or more points, x strictly rising"));
        }
        if let Some(bad) = x.iter().find(|x| !x.is_finite()) {
            return fault("not-a-number", format!("the value is {bad}"), "a finite number").map(|fault| fault.help(UNDEFINED));
        }
        let first = x.first().copied().unwrap_or(0.0);
        match self {
            Rule::AtMost(most, what) if first > most => {
                let expected = format!("at most {most}");
                fault("too-large", format!("{what} is {first}"), &expected).map(|fault| fault.help(VALUE))
            }
            Rule::Within(least, most, what) if !(least..=most).contains(&first) => {
                let expected = format!("a value from {} to {}", short(least), short(most));
                fault("out-of-range", format!("{what} is {first}"), &expected).map(|fault| fault.help(VALUE))
            }
            Rule::Rising if x.len() == 2 && x[0] >= x[1] => {
                fault("not-rising", format!("from {} to {}", x[0], x[1]), "a lower end below the upper one")
                    .map(|fault| fault.help("exchange `from` and `to`, or check the parameters that they are made of"))
            }
            Rule::Differ(what) if x.len() == 2 && x[0] == x[1] => {
                fault("no-range", format!("both {what} are {first}"), "two values that differ").map(|fault| fault.help(VALUE))
            }
            Rule::ConstrainedNewmark => newmark_fault(place(), first, x.get(1).copied().unwrap_or(first)),
            Rule::NotNegative(what) if first < 0.0 => {
                fault("negative", format!("{what} is {first}"), "a value that is not negative").map(|fault| fault.help(SIGN))
            }
            Rule::Positive(what) if first <= 0.0 => {
                fault("not-positive", format!("{what} is {first}"), "a value above 0").map(|fault| fault.help(SIGN))
            }
            Rule::NotZero(what) if first == 0.0 => {
                fault("zero", format!("{what} is 0"), "a value other than 0").map(|fault| fault.help("give the value that is meant"))
            }
            Rule::Direction if x.iter().all(|x| *x == 0.0) => fault("zero-axis", "all components are 0".to_owned(), "a direction")
                .map(|fault| fault.help("give at least one component, as `[1, 0]` or in space `[0, 0, 1]`")),
            Rule::Distinct if x.len().is_multiple_of(2) && x[..x.len() / 2] == x[x.len() / 2..] => {
                fault("zero-length", "both ends are the same point".to_owned(), "two points that differ")
            }
            Rule::Inertia => impossible(x).and_then(|why| {
                fault("impossible-inertia", why, "each principal moment at most the sum of the other two")
                    .map(|fault| fault.help("check the figures, their order `[Ixx, Iyy, Izz]` and that they are about `com`"))
            }),
            Rule::Moments => negative_moment(x).and_then(|why| {
                fault("impossible-inertia", why, "principal moments that are not negative")
                    .map(|fault| fault.help("check the figures and their order `[Ixx, Iyy, Izz]`"))
            }),
            Rule::Ratio if x.contains(&0.0) || x.iter().any(|x| x.signum() != first.signum()) => {
                fault("bad-span", format!("from {} to {}", x[0], x.get(1).copied().unwrap_or(x[0])), "for equal ratios both ends above 0")
            }
            _ => None,
        }
    }
}

/// A bound as a person writes it: a third is `1/3`.
fn short(x: f64) -> String {
    if (3.0 * x).fract() == 0.0 && x.fract() != 0.0 { format!("{}/3", 3.0 * x) } else { x.to_string() }
}

/// The remedy for a value that is no number.
const UNDEFINED: &str = "look for a division by 0, a root or logarithm of a negative number, `asin` or `acos` beyond 1";
/// The remedy for a value that is out of its range.
const VALUE: &str = "check it and the parameters that it is made of";
/// The remedy for a value of the wrong sign.
const SIGN: &str = "check its sign and the parameters that it is made of";

/// Why figures Ixx, Iyy, Izz (, Ixy, Ixz, Iyz) belong to no body: a principal moment is negative, or larger than the sum of
/// the other two (the integrals of y² + z², x² + z², x² + y² cannot be).
pub(crate) fn impossible(x: &[f64]) -> Option<String> {
    let (moments, slack) = principal(x)?;
    if let Some(why) = negative_moment(x) {
        return Some(why);
    }
    if moments[2] > moments[0] + moments[1] + slack {
        return Some(format!(
            "the principal moment {:.6} is larger than the sum of the others, {:.6} and {:.6}",
            moments[2], moments[0], moments[1]
        ));
    }
    None
}

/// Why figures Ixx, Iyy, Izz (, Ixy, Ixz, Iyz) belong to no body even with fictitious masses: a principal moment is negative.
pub(crate) fn negative_moment(x: &[f64]) -> Option<String> {
    let (moments, slack) = principal(x)?;
    let shown = |x: f64| if x.abs() < 1e-3 { format!("{x:.3e}") } else { format!("{x:.6}") };
    (moments[0] < -slack).then(|| format!("a principal moment of inertia is {}", shown(moments[0])))
}

/// Principal moments, ascending, and the slack for round-off in the figures.
fn principal(x: &[f64]) -> Option<([f64; 3], f64)> {
    let (a, b, c) = (*x.first()?, *x.get(1)?, *x.get(2)?);
    let (d, e, f) = (x.get(3).copied().unwrap_or(0.0), x.get(4).copied().unwrap_or(0.0), x.get(5).copied().unwrap_or(0.0));
    let moments = eigenvalues([[a, d, e], [d, b, f], [e, f, c]]);
    Some((moments, 1e-9 * (moments[0].abs() + moments[2].abs())))
}

/// Eigenvalues of a symmetric 3 × 3 matrix, ascending, by Jacobi rotations: plain and unconditionally stable.
fn eigenvalues(mut m: [[f64; 3]; 3]) -> [f64; 3] {
    for _ in 0..50 {
        let off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        if off == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            let r = 3 - p - q;
            let (rp, rq) = (m[r][p], m[r][q]);
            m[p][p] -= t * m[p][q];
            m[q][q] += t * m[p][q];
            m[p][q] = 0.0;
            m[q][p] = 0.0;
            m[r][p] = c * rp - s * rq;
            m[p][r] = m[r][p];
            m[r][q] = s * rp + c * rq;
            m[q][r] = m[r][q];
        }
    }
    let mut values = [m[0][0], m[1][1], m[2][2]];
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_of_a_matrix_with_a_known_spectrum() {
        let [a, b, c] = eigenvalues([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]]);
        let root = 2.0_f64.sqrt();
        assert!((a - (2.0 - root)).abs() < 1e-14 && (b - 2.0).abs() < 1e-14 && (c - (2.0 + root)).abs() < 1e-14);
    }

    #[test]
    fn inertias_that_cannot_be() {
        assert_eq!(impossible(&[1.0, 1.0, 2.0]), None);
        assert!(impossible(&[1.0, 1.0, 2.1]).is_some());
        assert!(impossible(&[1.0, 1.0, -1.0]).is_some());
        assert!(impossible(&[1.0, 1.0, 1.0, 0.9, 0.0, 0.0]).is_some());
        assert_eq!(impossible(&[1.0, 1.0, 1.0, 0.3, 0.0, 0.0]), None);
    }
}
