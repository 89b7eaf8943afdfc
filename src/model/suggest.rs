//! "Did you mean": the nearest known name.

pub(crate) use crate::expression::{MOST_CANDIDATES, nearest};

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

/// A text short enough for a message.
pub(crate) fn clip(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    if line.chars().count() > 60 || line.len() < text.trim_end().len() {
        format!("{}...", line.chars().take(57).collect::<String>())
    } else {
        line.to_owned()
    }
}
