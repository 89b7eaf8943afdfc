//! The words in which the format describes itself: shapes of values, fields and tables of fields.
//!
//! The reader (`shape`), the schema and the messages are made from the same tables (`keys`, `tables`), so that they cannot disagree.

use crate::expression::Dimension;

/// What a number is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Want {
    /// A quantity of this dimension.
    Of(Dimension),
    /// An angle: a plain number, but a bare one over a turn is suspect.
    Angle,
    /// Depends on its neighbours; the words say how.
    Varies(&'static str),
    /// Any dimension.
    Any,
}

impl Want {
    /// A value for something that has this dimension.
    pub(crate) fn of(dimension: Dimension) -> Self {
        if dimension.is_angle() { Self::Angle } else { Self::Of(dimension) }
    }

    /// For messages and the schema: `length (m)`.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Of(dimension) if dimension == Dimension::NONE && !dimension.is_angle() => "plain number".to_owned(),
            Self::Of(dimension) => dimension.name(),
            Self::Angle => "angle (rad)".to_owned(),
            Self::Varies(words) => words.to_owned(),
            Self::Any => "any quantity".to_owned(),
        }
    }

    /// For messages: " such as `15 cm`", in the unit of the dimension.
    fn example(self) -> String {
        match self {
            Self::Of(dimension) if dimension == Dimension::LENGTH => " such as `15 cm`".to_owned(),
            Self::Of(dimension) if dimension == Dimension::NONE => String::new(),
            Self::Of(dimension) => format!(" such as `2 {}`", dimension.si()),
            Self::Angle => " such as `30 deg`".to_owned(),
            Self::Varies(_) | Self::Any => " such as `15 cm`".to_owned(),
        }
    }
}

/// How many items a list has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Size {
    /// At least this many.
    AtLeast(usize),
    /// Just this many.
    Exactly(usize),
    /// 2 in the plane, 3 in space.
    Space,
    /// One of these.
    OneOf(&'static [usize]),
}

/// What the keys of a map with free names are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keys {
    /// A new name: `[A-Za-z][A-Za-z0-9_]*`.
    Name,
    /// A new name of a study or variant, which may also have `-`.
    Title,
    /// Something that exists already, or an expression: checked when it is decoded.
    Reference,
}

/// The shape of a value.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    /// A number, a quantity or an expression.
    Value(Want),
    /// A condition or expression of any dimension; never a bare number in the examples, but one is accepted.
    Formula(&'static str),
    /// Any text.
    Text,
    /// One of these words; the first is the default if the field is optional.
    Word(&'static [&'static str]),
    /// `true` or `false`.
    Flag,
    /// A whole number in a range.
    Count(u64, u64),
    /// A whole number up to a bound; the words say of what.
    CountOf(&'static str, u64),
    /// A name of something; the words say of what.
    Name(&'static str),
    /// A list.
    List(&'static Shape, Size),
    /// A map with known keys.
    Map(&'static Record),
    /// A map with free keys; the words name one entry.
    Named(Keys, &'static str, &'static Shape),
    /// The same but for one key with a shape of its own, if its value is a map.
    NamedBut(&'static Field, Keys, &'static str, &'static Shape),
    /// One of several shapes, told apart by being a map, a list or a scalar.
    Either(&'static [Shape]),
    /// A variant: a merge patch of the file's sections.
    Patch,
    /// Reserved for later.
    Later,
}

/// One key of a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// The key.
    pub(crate) key: &'static str,
    /// The shape of its value.
    pub(crate) shape: Shape,
    /// Whether it must be there.
    pub(crate) required: bool,
    /// One line for the schema and for messages.
    pub(crate) doc: &'static str,
}

/// Keys that exclude each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// The keys.
    pub(crate) keys: &'static [&'static str],
    /// Whether one of them must be there.
    pub(crate) required: bool,
}

/// A map with known keys.
#[derive(Debug)]
pub(crate) struct Record {
    /// What it describes, with its article: `a joint`.
    pub(crate) what: &'static str,
    /// Its keys.
    pub(crate) fields: &'static [Field],
    /// Keys that exclude each other: "one kind per entry".
    pub(crate) choices: &'static [Choice],
}

impl Record {
    /// The field of a key.
    pub(crate) fn field(&self, key: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.key == key)
    }
}

impl Shape {
    /// For messages: what is expected here.
    pub(crate) fn expected(&self) -> String {
        match self {
            Self::Value(want) => format!("{}: a number, a quantity{}, or an expression", want.name(), want.example()),
            Self::Formula(words) => (*words).to_owned(),
            Self::Text => "text".to_owned(),
            Self::Word(words) => format!("one of {}", words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ")),
            Self::Flag => "`true` or `false`".to_owned(),
            Self::Count(least, most) if least == most => format!("the number {least}"),
            Self::Count(least, most) => format!("a whole number from {least} to {most}"),
            Self::CountOf(words, _) => (*words).to_owned(),
            Self::Name(words) => (*words).to_owned(),
            Self::List(item, size) => match size {
                Size::AtLeast(_) => format!("a list `[ , ]` of: {}", item.expected()),
                Size::Exactly(n) => format!("a list of {n} items: {}", item.expected()),
                Size::Space => format!("a vector `[x, y]` (in space `[x, y, z]`) of: {}", item.expected()),
                Size::OneOf(sizes) => {
                    let sizes: Vec<String> = sizes.iter().map(ToString::to_string).collect();
                    format!("a list of {} items: {}", sizes.join(" or "), item.expected())
                }
            },
            Self::Map(table) => {
                let keys: Vec<String> = table.fields.iter().take(8).map(|f| format!("`{}`", f.key)).collect();
                let more = if table.fields.len() > 8 { ", ..." } else { "" };
                format!("{}: a map `{{ key: value }}` with the keys {}{more}", table.what, keys.join(", "))
            }
            Self::Named(_, what, _) | Self::NamedBut(_, _, what, _) => format!("a map `{{ name: ... }}`, one entry for {what}"),
            Self::Either(shapes) => shapes.iter().map(Shape::expected).collect::<Vec<_>>().join("; or "),
            Self::Patch => "a map of sections with what changes".to_owned(),
            Self::Later => "nothing yet".to_owned(),
        }
    }
}

/// The fields of one list and of another behind it; N is their number.
pub(crate) const fn joined<const N: usize>(first: &[Field], second: &[Field]) -> [Field; N] {
    let mut fields = [first[0]; N];
    let mut i = 0;
    while i < N {
        fields[i] = if i < first.len() { first[i] } else { second[i - first.len()] };
        i += 1;
    }
    fields
}

/// The keys of fields.
pub(crate) const fn keys_of<const N: usize>(fields: &[Field; N]) -> [&'static str; N] {
    let mut keys = [""; N];
    let mut i = 0;
    while i < N {
        keys[i] = fields[i].key;
        i += 1;
    }
    keys
}

/// Most intervals of a study.
pub(crate) const MOST_SAMPLES: u64 = 10_000_000;
/// Most steps of a continuation.
pub(crate) const MOST_STEPS: u64 = 100_000;
/// Most runs of a sweep.
pub(crate) const MOST_RUNS: u64 = 1_000_000;

pub(crate) const fn need(key: &'static str, shape: Shape, doc: &'static str) -> Field {
    Field { key, shape, required: true, doc }
}
pub(crate) const fn may(key: &'static str, shape: Shape, doc: &'static str) -> Field {
    Field { key, shape, required: false, doc }
}
pub(crate) const fn one_of(keys: &'static [&'static str]) -> Choice {
    Choice { keys, required: true }
}
pub(crate) const fn at_most_one(keys: &'static [&'static str]) -> Choice {
    Choice { keys, required: false }
}

pub(crate) const LENGTH: Shape = Shape::Value(Want::Of(Dimension::LENGTH));
pub(crate) const MASS: Shape = Shape::Value(Want::Of(Dimension::MASS));
pub(crate) const INERTIA: Shape = Shape::Value(Want::Of(Dimension::INERTIA));
pub(crate) const TIME: Shape = Shape::Value(Want::Of(Dimension::TIME));
pub(crate) const NUMBER: Shape = Shape::Value(Want::Of(Dimension::NONE));
pub(crate) const ANGLE: Shape = Shape::Value(Want::Angle);
pub(crate) const ANY: Shape = Shape::Value(Want::Any);
/// Angle or length, as the joint has it.
pub(crate) const COORDINATE: Shape = Shape::Value(Want::Varies("an angle (rad) or a length (m), as the joint has it"));
pub(crate) const EFFORT: Shape = Shape::Value(Want::Varies("a torque (N m) or a force (N), as the joint has it"));
pub(crate) const STIFFNESS: Shape = Shape::Value(Want::Varies("a stiffness: N/m, or N m/rad for an angle"));
pub(crate) const DAMPING: Shape = Shape::Value(Want::Varies("a damping: N s/m, or N m s/rad for an angle"));
pub(crate) const RATE: Shape = Shape::Value(Want::Varies("a speed (m/s) or an angular speed (rad/s)"));
pub(crate) const FRICTION_LEVEL: Shape =
    Shape::Value(Want::Varies("a torque (N m) or a force (N), as the joint has it, or a coefficient of friction"));
pub(crate) const BRISTLE_STIFFNESS: Shape =
    Shape::Value(Want::Varies("a stiffness: N/m or N m/rad; with a coefficient of friction 1/m, or a plain number"));
pub(crate) const BRISTLE_DAMPING: Shape =
    Shape::Value(Want::Varies("a damping: N s/m or N m s/rad; with a coefficient of friction s/m, or s"));
pub(crate) const ROLL_PITCH_YAW: Shape = Shape::List(&ANGLE, Size::Exactly(3));
pub(crate) const POSITION: Shape = Shape::List(&LENGTH, Size::Space);
pub(crate) const DIRECTION: Shape = Shape::List(&NUMBER, Size::Space);
pub(crate) const POINT: Shape = Shape::Name("a point `body.point`, or a body for its origin");
/// The two points that something connects.
pub(crate) const ENDS: Shape = Shape::List(&POINT, Size::Exactly(2));
pub(crate) const JOINT_NAME: Shape = Shape::Name("the name of a joint");
pub(crate) const FIGURES: Shape = Shape::Either(&[INERTIA, Shape::List(&INERTIA, Size::OneOf(&[1, 3, 6]))]);
