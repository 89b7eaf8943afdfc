//! "Did you mean": the nearest known name.

use super::fields::Want;
use crate::expression::Dimension;

pub(crate) use crate::expression::{MOST_CANDIDATES, nearest};

/// What to do about a name that is near to none.
pub(crate) fn take_or_add(word: &str, section: &str) -> String {
    format!("take a name that is there, or add `{}` to `{section}`", clip(word))
}

/// `did you mean `x`?`, or the list of what is known (at most a dozen).
pub(crate) fn help<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str> + Clone) -> Option<String> {
    if let Some(near) = nearest(word, candidates.clone()) {
        return Some(format!("did you mean `{near}`?"));
    }
    known(candidates).map(|list| format!("known: {list}"))
}

/// The names as a list of at most a dozen, or `None` if there is none.
pub(crate) fn known<'c>(candidates: impl IntoIterator<Item = &'c str>) -> Option<String> {
    let names: Vec<&str> = candidates.into_iter().take(MOST_CANDIDATES).collect();
    if names.is_empty() {
        return None;
    }
    let mut list = names.iter().take(12).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    if names.len() > 12 {
        list.push_str(&format!(" and {} more", names.len() - 12));
    }
    Some(list)
}

/// How a value of a dimension is written: with the number of a text that is one quantity, else with 1.
pub(crate) fn in_unit(text: &str, want: Want) -> String {
    let dimension = match want {
        Want::Of(dimension) => dimension,
        Want::Angle => return "give it in rad, or with another unit of angles, such as `30 deg`".to_owned(),
        Want::Varies(words) => return format!("give {words}"),
        Want::Any => return "give it with its unit".to_owned(),
    };
    if dimension.is_angle() {
        return in_unit(text, Want::Angle);
    }
    let (number, rest) = text.trim_start_matches('~').trim().split_once(' ').unwrap_or(("", ""));
    let quantity = number.parse::<f64>().is_ok() && crate::expression::parse_unit(rest.trim()).is_some();
    let number = if quantity { number } else { "1" };
    match dimension.si() {
        si if si.is_empty() => format!("give a number without a unit, such as `{number}`, or divide by what it counts in"),
        si => format!("give it in {si} or another unit of that kind, such as `{}`", dimension.written(number)),
    }
}

/// A unit in which what has a dimension can be shown.
pub(crate) fn unit_of(dimension: Dimension) -> String {
    match dimension.si() {
        si if si.is_empty() => "remove the unit: what is shown is a number".to_owned(),
        si => format!("write `{si}` or another unit of that kind"),
    }
}

/// A text short enough for a message.
pub(crate) fn clip(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    if line.chars().count() > 60 || line.len() < text.trim_end().len() {
        format!("{}...", line.chars().take(57).collect::<String>())
    } else {
        line.to_owned()
    }
}
