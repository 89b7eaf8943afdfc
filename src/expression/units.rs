//! Dimensions and units. Every number of the program is SI; rad = 1, so an angle is a plain number and N m/rad is N m.
//!
//! A dimension remembers how often angle is in it, but only beside plain numbers and time: deg/deg is a number, 2*deg an angle,
//! deg/s an angular speed, and m*rad is m. It is what numbers are shown in; two dimensions that differ in it alone are equal.

use super::nearest::nearest;
use std::f64::consts::{PI, TAU};
use std::hash::{Hash, Hasher};
use std::ops::{Div, Mul};

/// The dimension of a quantity: exponents of m, kg, s and A.
///
/// Counted in halves, so that √m has a dimension too. Products saturate at exponents of ±63, which no mechanics reaches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dimension {
    /// Twice the exponents of m, kg, s and A.
    halves: [i8; 4],
    /// Twice the exponent of rad; 0 beside m, kg and A. It does not count where dimensions are compared, since rad = 1.
    angle: i8,
}

impl PartialEq for Dimension {
    fn eq(&self, other: &Self) -> bool {
        self.halves == other.halves
    }
}

impl Eq for Dimension {}

impl Hash for Dimension {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.halves.hash(state);
    }
}

/// Dimensions that have a name: dimension, its name, its unit as people write it. The first match counts.
const NAMED: [(Dimension, &str, &str); 27] = [
    (Dimension::ANGLE, "angle", "rad"),
    (Dimension::LENGTH, "length", "m"),
    (Dimension::MASS, "mass", "kg"),
    (Dimension::TIME, "time", "s"),
    (Dimension::SPEED, "speed", "m/s"),
    (Dimension::ACCELERATION, "acceleration", "m/s^2"),
    (Dimension::FORCE, "force", "N"),
    (Dimension::TORQUE, "torque", "N m"),
    (Dimension::POWER, "power", "W"),
    (Dimension::INERTIA, "inertia", "kg m^2"),
    (Dimension::ANGULAR_SPEED, "angular speed", "rad/s"),
    (Dimension::ANGULAR_ACCELERATION, "angular acceleration", "rad/s^2"),
    (Dimension::STIFFNESS, "stiffness", "N/m"),
    (Dimension::DAMPING, "damping", "N s/m"),
    (Dimension::ANGULAR_DAMPING, "angular damping", "N m s"),
    (Dimension::AREA, "area", "m^2"),
    (Dimension::VOLUME, "volume", "m^3"),
    (Dimension::DENSITY, "density", "kg/m^3"),
    (Dimension::MOMENTUM, "momentum", "kg m/s"),
    (Dimension::MASS_MOMENT, "mass times length", "kg m"),
    (Dimension::PRESSURE, "pressure", "Pa"),
    (Dimension::CURRENT, "current", "A"),
    (Dimension::VOLTAGE, "voltage", "V"),
    (Dimension::RESISTANCE, "resistance", "ohm"),
    (Dimension::INDUCTANCE, "inductance", "H"),
    (Dimension::TORQUE_CONSTANT, "torque constant", "N m/A"),
    (Dimension::CURVATURE, "curvature", "1/m"),
];

impl Dimension {
    /// A plain number.
    pub const NONE: Self = Self::new(0, 0, 0, 0);
    /// rad, equal to [`Self::NONE`].
    pub const ANGLE: Self = Self { angle: 2, ..Self::NONE };
    /// m.
    pub const LENGTH: Self = Self::new(1, 0, 0, 0);
    /// kg.
    pub const MASS: Self = Self::new(0, 1, 0, 0);
    /// s.
    pub const TIME: Self = Self::new(0, 0, 1, 0);
    /// A.
    pub const CURRENT: Self = Self::new(0, 0, 0, 1);
    /// m/s.
    pub const SPEED: Self = Self::new(1, 0, -1, 0);
    /// m/s².
    pub const ACCELERATION: Self = Self::new(1, 0, -2, 0);
    /// N.
    pub const FORCE: Self = Self::new(1, 1, -2, 0);
    /// N m; also N m/rad.
    pub const TORQUE: Self = Self::new(2, 1, -2, 0);
    /// J = N m.
    pub const ENERGY: Self = Self::TORQUE;
    /// W.
    pub const POWER: Self = Self::new(2, 1, -3, 0);
    /// kg m².
    pub const INERTIA: Self = Self::new(2, 1, 0, 0);
    /// rad/s, equal to 1/s.
    pub const ANGULAR_SPEED: Self = Self { angle: 2, ..Self::new(0, 0, -1, 0) };
    /// rad/s², equal to 1/s².
    pub const ANGULAR_ACCELERATION: Self = Self { angle: 2, ..Self::new(0, 0, -2, 0) };
    /// N/m.
    pub const STIFFNESS: Self = Self::new(0, 1, -2, 0);
    /// N m/rad = N m.
    pub const ANGULAR_STIFFNESS: Self = Self::TORQUE;
    /// N s/m.
    pub const DAMPING: Self = Self::new(0, 1, -1, 0);
    /// N m s.
    pub const ANGULAR_DAMPING: Self = Self::new(2, 1, -1, 0);
    /// m².
    pub const AREA: Self = Self::new(2, 0, 0, 0);
    /// m³.
    pub const VOLUME: Self = Self::new(3, 0, 0, 0);
    /// kg/m³.
    pub const DENSITY: Self = Self::new(-3, 1, 0, 0);
    /// kg m/s.
    pub const MOMENTUM: Self = Self::new(1, 1, -1, 0);
    /// kg m.
    pub const MASS_MOMENT: Self = Self::new(1, 1, 0, 0);
    /// Pa.
    pub const PRESSURE: Self = Self::new(-1, 1, -2, 0);
    /// V.
    pub const VOLTAGE: Self = Self::new(2, 1, -3, -1);
    /// Ω.
    pub const RESISTANCE: Self = Self::new(2, 1, -3, -2);
    /// H.
    pub const INDUCTANCE: Self = Self::new(2, 1, -2, -2);
    /// N m/A = V s.
    pub const TORQUE_CONSTANT: Self = Self::new(2, 1, -2, -1);
    /// 1/m.
    pub const CURVATURE: Self = Self::new(-1, 0, 0, 0);

    /// The dimension m^`m` kg^`kg` s^`s` A^`a`.
    #[must_use]
    pub const fn new(m: i8, kg: i8, s: i8, a: i8) -> Self {
        Self { halves: [m.saturating_mul(2), kg.saturating_mul(2), s.saturating_mul(2), a.saturating_mul(2)], angle: 0 }
    }

    /// The size of a quantity of this dimension where m, kg, s and A have these sizes.
    #[must_use]
    pub fn size(&self, units: [f64; 4]) -> f64 {
        units.iter().zip(self.halves).map(|(unit, half)| unit.powf(0.5 * f64::from(half))).product()
    }

    /// Dimension of a product; `*` does the same.
    #[must_use]
    #[expect(clippy::should_implement_trait, reason = "it is implemented; the method needs no import")]
    pub fn mul(self, other: Self) -> Self {
        let mut halves = self.halves;
        for (a, b) in halves.iter_mut().zip(other.halves) {
            *a = a.saturating_add(b);
        }
        Self::with_angle(halves, self.angle.saturating_add(other.angle))
    }

    /// Angle is kept beside time only.
    fn with_angle(halves: [i8; 4], angle: i8) -> Self {
        let [m, kg, _, a] = halves;
        Self { halves, angle: if (m, kg, a) == (0, 0, 0) { angle } else { 0 } }
    }

    /// Whether this is an angle.
    #[must_use]
    pub fn is_angle(&self) -> bool {
        *self == Self::NONE && self.angle == 2
    }

    /// Whether this is a plain number divided by an angle, as `1/2 turn` is: 1/(2 turn).
    #[must_use]
    pub fn is_per_angle(&self) -> bool {
        *self == Self::NONE && self.angle < 0
    }

    /// Whether a unit of the other may show a number of this dimension: an angle is none of a plain number.
    #[must_use]
    pub fn is_shown_as(&self, other: Self) -> bool {
        *self == other && self.angle == other.angle
    }

    /// The dimension of a sum of both, which are equal: `O.angle + 1` is an angle.
    pub(super) fn or_angle(self, other: Self) -> Self {
        if self.angle == 0 { other } else { self }
    }

    /// Dimension of a quotient; `/` does the same.
    #[must_use]
    #[expect(clippy::should_implement_trait, reason = "it is implemented; the method needs no import")]
    pub fn div(self, other: Self) -> Self {
        self.mul(other.pow(-1))
    }

    /// Dimension of an integer power.
    #[must_use]
    pub fn pow(self, n: i32) -> Self {
        let n = n.clamp(-127, 127);
        let times = |h: i8| (i32::from(h) * n).clamp(-127, 127) as i8;
        Self::with_angle(self.halves.map(times), times(self.angle))
    }

    /// Dimension of a real power; `None` if an exponent would not be a whole number of halves (that of angle is dropped then).
    #[must_use]
    pub fn power(self, n: f64) -> Option<Self> {
        let times = |h: i8| Some(f64::from(h) * n).filter(|h| h.fract() == 0.0 && h.abs() <= 127.0).map(|h| h as i8);
        let mut halves = [0; 4];
        for (to, from) in halves.iter_mut().zip(self.halves) {
            *to = times(from)?;
        }
        Some(Self::with_angle(halves, times(self.angle).unwrap_or(0)))
    }

    /// Dimension of a square root; `None` if an exponent would not be a whole number of halves.
    #[must_use]
    pub fn sqrt(self) -> Option<Self> {
        self.power(0.5)
    }

    /// Text for messages: `length (m)`, `torque (N m)`, `a number`; the unit alone where the dimension has no name.
    #[must_use]
    pub fn name(&self) -> String {
        match self.named() {
            Some((name, unit)) => format!("{name} ({unit})"),
            None if *self == Self::NONE => "a number".to_owned(),
            None => self.si(),
        }
    }

    /// What is measured, in words: `length`, `angular speed`, `number`; empty where the dimension has no name.
    #[must_use]
    pub fn quantity(&self) -> &'static str {
        match self.named() {
            Some((name, _)) => name,
            None if *self == Self::NONE => "number",
            None => "",
        }
    }

    /// Its name and unit, if it has a name.
    fn named(&self) -> Option<(&'static str, &'static str)> {
        let known = NAMED.iter().find(|(dimension, ..)| dimension == self && dimension.angle == self.angle);
        known.map(|(_, name, unit)| (*name, *unit))
    }

    /// The SI unit, short, for axis labels: `N m`, `m/s^2`; empty for a plain number.
    #[must_use]
    pub fn si(&self) -> String {
        if let Some((_, unit)) = self.named() {
            return unit.to_owned();
        }
        let [m, kg, s, a] = self.halves;
        let factors = [("kg", kg), ("m", m), ("rad", self.angle), ("s", s), ("A", a)];
        let power = |(symbol, halves): (&str, i8)| match halves.unsigned_abs() {
            2 => symbol.to_owned(),
            n => format!("{symbol}^{}", f64::from(n) / 2.0),
        };
        let above: Vec<_> = factors.into_iter().filter(|f| f.1 > 0).map(power).collect();
        let below: Vec<_> = factors.into_iter().filter(|f| f.1 < 0).map(|f| format!("/{}", power(f))).collect();
        match (above.is_empty(), below.is_empty()) {
            (true, true) => String::new(),
            (true, false) => format!("1{}", below.concat()),
            _ => above.join(" ") + &below.concat(),
        }
    }

    /// `number` with this dimension's unit, as a model file accepts it: `0.1 m`, `3 m^-1`.
    #[must_use]
    pub fn written(&self, number: &str) -> String {
        let unit = self.si();
        match unit.strip_prefix("1/") {
            _ if unit.is_empty() => number.to_owned(),
            None => format!("{number} {unit}"),
            Some(below) => {
                // no unit can begin with a slash: 1/m^2 is written m^-2
                let (first, rest) = below.split_at(below.find('/').unwrap_or(below.len()));
                let (symbol, n) = first.split_once('^').unwrap_or((first, "1"));
                format!("{number} {symbol}^-{n}{rest}")
            }
        }
    }
}

impl Mul for Dimension {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::mul(self, other)
    }
}

impl Div for Dimension {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::div(self, other)
    }
}

/// m; the inch of 1959.
const INCH: f64 = 0.0254;
/// m.
const FOOT: f64 = 0.3048;
/// kg; the avoirdupois pound of 1959.
const POUND: f64 = 0.453_592_37;
/// m/s²; of the third General Conference on Weights and Measures, 1901.
const STANDARD_GRAVITY: f64 = 9.80665;

/// The unit words of the format, their size in SI and their dimension. `Hz` is none: a turn or a radian?
const UNITS: [(&str, f64, Dimension); 41] = [
    ("m", 1.0, Dimension::LENGTH),
    ("km", 1e3, Dimension::LENGTH),
    ("cm", 1e-2, Dimension::LENGTH),
    ("mm", 1e-3, Dimension::LENGTH),
    ("um", 1e-6, Dimension::LENGTH),
    ("in", INCH, Dimension::LENGTH),
    ("ft", FOOT, Dimension::LENGTH),
    ("kg", 1.0, Dimension::MASS),
    ("g", 1e-3, Dimension::MASS),
    ("lb", POUND, Dimension::MASS),
    ("s", 1.0, Dimension::TIME),
    ("ms", 1e-3, Dimension::TIME),
    ("us", 1e-6, Dimension::TIME),
    ("min", 60.0, Dimension::TIME),
    ("rad", 1.0, Dimension::ANGLE),
    ("mrad", 1e-3, Dimension::ANGLE),
    ("deg", PI / 180.0, Dimension::ANGLE),
    ("turn", TAU, Dimension::ANGLE),
    ("rpm", TAU / 60.0, Dimension::ANGULAR_SPEED),
    ("mph", 0.44704, Dimension::SPEED),
    ("%", 1e-2, Dimension::NONE),
    ("N", 1.0, Dimension::FORCE),
    ("kN", 1e3, Dimension::FORCE),
    ("MN", 1e6, Dimension::FORCE),
    ("lbf", POUND * STANDARD_GRAVITY, Dimension::FORCE),
    ("kgf", STANDARD_GRAVITY, Dimension::FORCE),
    ("J", 1.0, Dimension::ENERGY),
    ("kJ", 1e3, Dimension::ENERGY),
    ("W", 1.0, Dimension::POWER),
    ("kW", 1e3, Dimension::POWER),
    ("hp", 550.0 * FOOT * POUND * STANDARD_GRAVITY, Dimension::POWER),
    ("Pa", 1.0, Dimension::PRESSURE),
    ("kPa", 1e3, Dimension::PRESSURE),
    ("MPa", 1e6, Dimension::PRESSURE),
    ("GPa", 1e9, Dimension::PRESSURE),
    ("bar", 1e5, Dimension::PRESSURE),
    ("psi", POUND * STANDARD_GRAVITY / (INCH * INCH), Dimension::PRESSURE),
    ("V", 1.0, Dimension::VOLTAGE),
    ("A", 1.0, Dimension::CURRENT),
    ("ohm", 1.0, Dimension::RESISTANCE),
    ("H", 1.0, Dimension::INDUCTANCE),
];

/// Size in SI and dimension of one unit word of the format; `None` for any other word.
pub(super) fn unit(word: &str) -> Option<(f64, Dimension)> {
    UNITS.into_iter().find(|(known, ..)| *known == word).map(|(_, size, dimension)| (size, dimension))
}

/// All unit words of the format.
pub(super) fn unit_words() -> impl Iterator<Item = &'static str> {
    UNITS.into_iter().map(|(word, ..)| word)
}

/// The unit that a word of at least three letters probably means: `cms` is `cm`.
pub(super) fn nearest_unit(word: &str) -> Option<&'static str> {
    (word.len() > 2).then(|| nearest(word, unit_words())).flatten()
}

#[cfg(test)]
mod tests {
    use super::super::parser::{Kind, parse};
    use super::super::unit_text::parse_unit;
    use super::*;

    #[test]
    fn named_dimensions_agree_with_their_units() {
        for (dimension, name, text) in NAMED {
            let (size, found) = parse_unit(text.strip_prefix("1/").map_or(text, |_| "m^-1")).expect(name);
            assert_eq!((size, found, found.angle), (1.0, dimension, dimension.angle), "{name}");
            assert_eq!(NAMED.iter().filter(|n| n.0 == dimension).count(), 1, "{name}");
        }
    }

    #[test]
    fn written_quantities_are_read_back() {
        for halves in [[2, 0, 0, 0], [-2, 0, 0, 0], [-4, 0, -6, 0], [4, 2, -2, 0], [2, -2, -4, 2], [10, 0, 0, -2], [0, 0, -6, 0]] {
            let dimension = Dimension { halves, angle: 0 };
            let text = dimension.written("2.5");
            assert_eq!(parse(&text).unwrap().kind, Kind::Quantity(2.5, dimension, vec![]), "{text}");
        }
    }

    #[test]
    fn names_for_messages() {
        assert_eq!(Dimension::LENGTH.name(), "length (m)");
        assert_eq!(Dimension::TORQUE.name(), "torque (N m)");
        assert_eq!(Dimension::NONE.name(), "a number");
        assert_eq!(Dimension::NONE.si(), "");
        assert_eq!(Dimension::TIME.pow(-1).name(), "1/s");
        assert_eq!(Dimension::INERTIA.mul(Dimension::LENGTH).name(), "kg m^3");
        assert_eq!(Dimension::LENGTH.sqrt().unwrap().si(), "m^0.5");
        assert_eq!(Dimension::ANGULAR_DAMPING, Dimension::INERTIA.div(Dimension::TIME));
    }

    #[test]
    fn angle_is_kept_beside_numbers_and_time_only() {
        let (rad, s, m) = (Dimension::ANGLE, Dimension::TIME, Dimension::LENGTH);
        for (dimension, si) in [
            (rad / rad, ""),
            (rad / s, "rad/s"),
            (rad / s / s, "rad/s^2"),
            (rad / s * s, "rad"),
            (rad * s, "rad s"),
            (Dimension::ANGULAR_SPEED.pow(2), "rad^2/s^2"),
            (Dimension::ANGULAR_SPEED.pow(2).sqrt().unwrap(), "rad/s"),
            (s / rad, "s/rad"),
            (rad.sqrt().and_then(Dimension::sqrt).unwrap(), ""),
            (m * rad, "m"),
            (Dimension::MASS * rad, "kg"),
            (Dimension::CURRENT / rad, "A"),
            (m / rad, "m"),
            (m * rad / s, "m/s"),
            (m * rad / m, ""),
            (Dimension::STIFFNESS / Dimension::MASS, "1/s^2"),
        ] {
            assert_eq!(dimension.si(), si);
        }
        // rad = 1
        assert_eq!((rad, rad / s), (Dimension::NONE, s.pow(-1)));
        assert_eq!(parse_unit("N m s/rad").unwrap().1.si(), "N m s");
        assert_eq!(parse_unit("turn/min").unwrap().1.si(), "rad/s");
    }

    #[test]
    fn composite_units() {
        assert_eq!(parse_unit("N m s/rad"), Some((1.0, Dimension::ANGULAR_DAMPING)));
        assert_eq!(parse_unit("N*m*s"), Some((1.0, Dimension::ANGULAR_DAMPING)));
        assert_eq!(parse_unit("N/mm"), Some((1000.0, Dimension::STIFFNESS)));
        assert_eq!(parse_unit("turn/s").unwrap().0, TAU);
        assert_eq!(parse_unit("%"), Some((0.01, Dimension::NONE)));
        for wrong in ["", "N/m s", "Hz", "m + 2 m", "2 m", "(m)", "m^2.5", "/s", "e5 m", "m 3", "k"] {
            assert_eq!(parse_unit(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn customary_units_are_those_of_their_definitions() {
        let si = |unit: &str| parse_unit(unit).unwrap();
        for (text, other) in [("lbf", "lb ft/s^2"), ("kgf", "kg m/s^2"), ("psi", "lbf/in^2"), ("hp", "ft lbf/s"), ("mph", "ft/min")] {
            assert_eq!(si(text).1, si(other).1, "{text}");
        }
        // NIST Special Publication 811, appendix B
        for (text, x) in [("lb", 0.453_592_37), ("lbf", 4.448_222), ("psi", 6894.757), ("hp", 745.6999), ("mph", 0.44704), ("kgf", 9.80665)]
        {
            assert!((si(text).0 / x - 1.0).abs() < 1.2e-7, "{text}: {}", si(text).0);
        }
        assert!((si("hp").0 / (550.0 * si("ft lbf/s").0) - 1.0).abs() < 1e-15);
        assert!((si("mph").0 / (5280.0 / 60.0 * si("ft/min").0) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn exponents_never_overflow() {
        let huge = Dimension::LENGTH.pow(i32::MAX).mul(Dimension::LENGTH.pow(i32::MAX));
        assert!(!huge.div(Dimension::LENGTH.pow(i32::MIN)).name().is_empty());
        assert_eq!(Dimension::LENGTH.power(f64::NAN), None);
        assert_eq!(Dimension::LENGTH.sqrt().and_then(Dimension::sqrt), None);
    }
}
