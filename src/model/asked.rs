//! The words in which messages speak of what is asked for from outside of a file.

use super::fault::Given;

/// Who asks for a model: messages speak of what it gave as it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Caller {
    /// The program, by options of its command line.
    #[default]
    CommandLine,
    /// A program in Rust or Python, by arguments of a call.
    Code,
}

/// What a caller may ask for.
#[derive(Clone, Copy)]
pub(crate) enum Asked {
    /// A parameter at a value.
    Value,
    /// A parameter that runs through values.
    Over,
    /// A variant.
    Variant,
    /// A study.
    Study,
}

impl Caller {
    /// What was given, as `l3=60 cm` or a name.
    pub(crate) fn given(self, asked: Asked, what: &str) -> Given {
        self.all(asked, &[what.to_owned()])
    }

    /// Several of one sort that were given.
    pub(crate) fn all(self, asked: Asked, what: &[String]) -> Given {
        let (option, argument) = match asked {
            Asked::Value => ("--set", "values"),
            Asked::Over => ("--over", "over"),
            Asked::Variant => ("--variant", "variant"),
            Asked::Study => ("--study", "study"),
        };
        match self {
            Self::CommandLine => {
                let options: Vec<String> = what.iter().map(|what| format!("{option} {what}")).collect();
                Given { source: "command line", text: options.join(" ") }
            }
            Self::Code => Given { source: argument, text: what.join(" ") },
        }
    }

    /// A parameter that runs through values, as it is to be written.
    pub(crate) fn over(self, name: &str, values: &str) -> String {
        match self {
            Self::CommandLine if values.contains(['(', ' ']) => format!("`--over \"{name}={values}\"`"),
            Self::CommandLine => format!("`--over {name}={values}`"),
            Self::Code => format!("`{values}` for `{name}`"),
        }
    }

    /// A parameter with a distribution, in general.
    pub(crate) fn distribution(self) -> &'static str {
        match self {
            Self::CommandLine => "`--over NAME=normal(MEAN, DEVIATION)`",
            Self::Code => "`normal(MEAN, DEVIATION)` for a parameter",
        }
    }

    /// What says how many values are drawn.
    pub(crate) fn samples(self) -> &'static str {
        match self {
            Self::CommandLine => "`--samples`",
            Self::Code => "`samples`",
        }
    }

    /// The same with a number, as it is to be written.
    pub(crate) fn so_many_samples(self, count: usize) -> String {
        match self {
            Self::CommandLine => format!("`--samples {count}`"),
            Self::Code => format!("`samples={count}`"),
        }
    }
}
