//! Maps with known keys, each key declared once: `keys!` makes the table, from which the form is checked and the schema is
//! written, and a struct with a field for each key, by which the decoder reads. A key that no reader reads is a warning of
//! the compiler.

use super::fields::{Field, Shape, Want};
use super::merge::Node;
use serde_yaml::Value;

/// A key of a map, and its value in the map that is read.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'n> {
    /// What was declared.
    pub(crate) field: &'static Field,
    /// The value; `None` if omitted or empty.
    pub(crate) node: Option<Node<'n>>,
}

impl<'n> Entry<'n> {
    /// The value of a field in a map.
    pub(crate) fn of(field: &'static Field, map: Node<'n>) -> Self {
        Self { field, node: map.get(field.key) }
    }

    /// The key.
    pub(crate) fn key(self) -> &'static str {
        self.field.key
    }

    /// Whether the file gives it.
    pub(crate) fn given(self) -> bool {
        self.node.is_some()
    }

    /// What its number is of, as declared.
    pub(crate) fn want(self) -> Want {
        match self.field.shape {
            Shape::Value(want) => want,
            _ => Want::Any,
        }
    }

    /// The text, if it is one.
    pub(crate) fn text(self) -> Option<&'n str> {
        self.node?.text()
    }

    /// The word of a choice, if it is given.
    pub(crate) fn word<W: Words>(self) -> Option<W> {
        W::named(self.text()?)
    }

    /// True if it is given as `true`.
    pub(crate) fn flag(self) -> bool {
        matches!(self.node, Some(Node::Plain(Value::Bool(true))))
    }

    /// A whole number, which was checked to be in its range.
    pub(crate) fn count(self) -> Option<usize> {
        match self.node? {
            Node::Plain(Value::Number(n)) => usize::try_from(n.as_u64()?).ok(),
            _ => None,
        }
    }

    /// Items of a list; empty if it is none.
    pub(crate) fn items(self) -> &'n [Value] {
        self.node.map(Node::items).unwrap_or_default()
    }

    /// Entries of a map with free names, in file order; empty if it is none.
    pub(crate) fn entries(self) -> Vec<(&'n str, Node<'n>)> {
        self.node.map(Node::entries).unwrap_or_default()
    }
}

impl<'n> From<Entry<'n>> for &'n str {
    fn from(entry: Entry<'n>) -> &'n str {
        entry.field.key
    }
}

/// A choice between words of the file.
pub(crate) trait Words: Copy + 'static {
    /// The words, the one that counts if the key is omitted first.
    const WORDS: &'static [&'static str];
    /// What they mean, in the same order.
    const ALL: &'static [Self];

    /// What a word means.
    fn named(word: &str) -> Option<Self> {
        let index = Self::WORDS.iter().position(|known| *known == word)?;
        Self::ALL.get(index).copied()
    }

    /// Its word.
    fn word(self) -> &'static str
    where
        Self: PartialEq,
    {
        Self::ALL.iter().zip(Self::WORDS).find(|(one, _)| **one == self).map_or("", |(_, word)| word)
    }
}

/// Declares a map: its table, and the struct of its entries.
///
/// ```text
/// keys! {
///     /// Where it is used.
///     pub(crate) SPAN = Span "a span of values" [choices] {
///         from: need ANY, "First value.";
///         pin_in_slot("pin-in-slot"): may ENDS, "A key that is no word of Rust, or another one.";
///     }
/// }
/// ```
macro_rules! keys {
    ($(#[$about:meta])* $vis:vis $TABLE:ident = $Keys:ident $what:literal [$($choice:expr),*] {
        $($field:ident $(($key:literal))?: $need:ident $shape:expr, $doc:literal;)*
    }) => {
        $(#[$about])*
        $vis static $TABLE: $crate::model::fields::Record =
            $crate::model::fields::Record { what: $what, choices: &[$($choice),*], fields: $Keys::FIELDS };

        $(#[$about])*
        #[derive(Clone, Copy)]
        $vis struct $Keys<'n> {
            $(#[doc = $doc] pub(crate) $field: $crate::model::keys::Entry<'n>,)*
        }

        impl<'n> $Keys<'n> {
            /// The keys as declared.
            pub(crate) const FIELDS: &'static [$crate::model::fields::Field] = &[$(
                {
                    // a constant of its own, so that what it refers to lives as long as the program
                    const SHAPE: $crate::model::fields::Shape = $shape;
                    $crate::model::fields::$need($crate::model::keys::keys!(@key $field $($key)?), SHAPE, $doc)
                },
            )*];

            /// The entries of a map.
            pub(crate) fn of(map: $crate::model::merge::Node<'n>) -> Self {
                let mut fields = Self::FIELDS.iter();
                let mut next = || $crate::model::keys::Entry::of(fields.next().expect("a field for each entry"), map);
                Self { $($field: next(),)* }
            }
        }
    };
    (@key $field:ident $key:literal) => { $key };
    (@key $field:ident) => { stringify!($field) };
}
pub(crate) use keys;

/// Declares a choice between words: an enum, and its words.
macro_rules! words {
    ($(#[$about:meta])* $vis:vis enum $Name:ident { $($(#[$doc:meta])* $Variant:ident = $word:literal,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $vis enum $Name { $($(#[$doc])* $Variant,)* }

        impl $crate::model::keys::Words for $Name {
            const WORDS: &'static [&'static str] = &[$($word),*];
            const ALL: &'static [Self] = &[$(Self::$Variant),*];
        }
    };
}
pub(crate) use words;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::fields::{ANY, may, need};

    words! {
        /// A side.
        enum Side { /** Left. */ Left = "left", /** Right. */ Right = "right", }
    }

    keys! {
        /// A thing.
        THING = Thing "a thing" [] {
            size: need ANY, "Its size.";
            side: may Shape::Word(Side::WORDS), "Its side.";
            long_name("long-name"): may ANY, "A key that is no word of Rust.";
        }
    }

    #[test]
    fn a_map_is_read_by_its_declared_keys() {
        let value: Value = serde_yaml::from_str("{ size: 3, side: right }").unwrap();
        let thing = Thing::of(Node::Plain(&value));
        assert_eq!((thing.size.count(), thing.side.word()), (Some(3), Some(Side::Right)));
        assert!(thing.size.given() && !thing.long_name.given());
        assert_eq!(
            THING.fields.iter().map(|f| (f.key, f.required)).collect::<Vec<_>>(),
            [("size", true), ("side", false), ("long-name", false)]
        );
        let _ = (need("a", ANY, ""), may("b", ANY, ""), Side::Left);
    }
}
