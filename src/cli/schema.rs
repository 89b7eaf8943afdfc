//! `grashof schema`.

use super::{code, say};

/// Prints the JSON Schema of model files.
pub(super) fn print() -> u8 {
    say(&serde_json::to_string_pretty(&grashof::model::schema()).unwrap_or_default());
    code::DONE
}
