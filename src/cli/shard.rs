//! Parts of a sweep that are computed apart, by other processes or on other machines.

use std::fmt::{self, Display};
use std::path::PathBuf;
use std::str::FromStr;

/// What of a sweep is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// All runs; the results are written.
    Whole,
    /// The runs of one shard, which are kept.
    Shard(Shard),
    /// The runs that shards have kept in these directories; the results are written.
    Gathered(Vec<PathBuf>),
}

/// One of several parts of a sweep: every N-th run from the K-th on, so that runs which take longer and longer are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// Whether it has the run at a place of the sweep, from 0.
    pub(super) fn has(self, run: usize) -> bool {
        run % self.of == self.number - 1
    }

    /// What the name of its file of kept runs begins with, for a study whose files begin with `stem`.
    pub(super) fn stem(self, stem: &str) -> String {
        format!("{stem}.{}-of-{}", self.number, self.of)
    }

    /// The shard whose file of kept runs has a name, if it belongs to that study.
    pub(super) fn of_file(name: &str, stem: &str) -> Option<Self> {
        let part = name.strip_prefix(stem)?.strip_prefix('.')?.strip_suffix(".partial")?;
        part.replace("-of-", "/").parse().ok()
    }
}

impl Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err("write the number of the part and how many there are, as `2/8`".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_runs() {
        let shards: Vec<Shard> = ["1/3", "2/3", "3/3"].iter().map(|text| text.parse().unwrap()).collect();
        assert!((0..20).all(|run| shards.iter().filter(|shard| shard.has(run)).count() == 1));
        assert!(["0/3", "4/3", "1", "a/b", "-1/2", "1/0"].iter().all(|text| text.parse::<Shard>().is_err()));
    }

    #[test]
    fn files_are_told_by_their_names() {
        let shard: Shard = "2/8".parse().unwrap();
        let file = format!("{}.partial", shard.stem("turn-over-l3"));
        assert_eq!(file, "turn-over-l3.2-of-8.partial");
        assert_eq!(Shard::of_file(&file, "turn-over-l3"), Some(shard));
        assert!(["turn", "turn-over-l3.2"].iter().all(|stem| Shard::of_file(&file, stem).is_none()));
        assert_eq!(Shard::of_file("turn-over-l3.partial", "turn-over-l3"), None);
    }
}
